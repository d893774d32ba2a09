#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# docker/Dockerfile without an engine: what make needs gets into the build, and the packages of what the program is linked with into the
# image. tests/machine/image.sh builds and uses it.
. "$(dirname "$0")/../support/tap.sh"

# The patterns of .dockerignore that matter here are names of the top folder.
wanted=$(sed -n 's/^dist_doc_DATA = //p' "$SOURCES/doc/doc.am")
kept_out=
for path in bootstrap configure.ac docker/easeoff.service sql src tests web $wanted; do
  while read -r pattern; do
    # shellcheck disable=SC2254
    case ${path%%/*} in $pattern) kept_out="$kept_out $path" ;; esac
  done <"$SOURCES/.dockerignore"
done
[ -n "$wanted" ] && [ -z "$kept_out" ]
result $? "the build has what make needs:$kept_out"

if command -v dpkg >/dev/null && command -v objdump >/dev/null && command -v ldd >/dev/null; then
  missing=
  for library in $(objdump -p "$EASEOFF" | awk '$1 == "NEEDED" { print $2 }'); do
    # A sanitizer's and the compiler's own libraries are none of the image's program.
    case $library in libasan* | libubsan* | libtsan* | libgcc_s* | libstdc++* | ld-linux*) continue ;; esac
    file=$(realpath "$(ldd "$EASEOFF" | awk -v library="$library" '$1 == library { print $3 }')")
    package=$( (dpkg -S "$file" || dpkg -S "${file#/usr}" || dpkg -S "/usr$file") 2>/dev/null | cut -d: -f1)
    case $package in
    libc6) ;;
    *) tr -s ' ' '\n' <"$SOURCES/docker/Dockerfile" | grep -qxF "$package" || missing="$missing $library($package)" ;;
    esac
  done
  [ -z "$missing" ]
  result $? "the image has every library that the program is linked with:$missing"
fi
echo "1..$count"
exit $failed

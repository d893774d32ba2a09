#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The core as an installed library: header, archive and pkg-config file out of `make install`, the example built against them alone.
. "$(dirname "$0")/../support/tap.sh"
build=$(dirname "$EASEOFF") cc=${CC:-cc}
command -v pkg-config >/dev/null || {
  echo "1..0 # SKIP pkg-config is not there"
  exit 0
}
prefix=$(sed -n 's/^prefix = //p' "$build/Makefile")
make -s -C "$build" install-includeHEADERS install-nodist_pkgconfigDATA install-exec-hook DESTDIR="$folder" MAKEFLAGS= >"$folder/out" 2>"$folder/err"
result $? "the library is installed"
tree=$folder$prefix
config() { PKG_CONFIG_PATH=$tree/lib/pkgconfig pkg-config --define-variable=libdir="$tree/lib" --define-variable=includedir="$tree/include" "$@" easeoff; }
[ "$(config --modversion)" = "$("$EASEOFF" --version | awk '{ print $2 }')" ]
result $? "its version is the program's"
cp "$SOURCES/doc/examples/transmission-error.c" "$folder"
# shellcheck disable=SC2046
$cc -Wall -Wextra -Werror "$folder/transmission-error.c" $(config --cflags --libs) -o "$folder/transmission-error" >"$folder/out" 2>"$folder/err"
result $? "the example is built against the installed tree"
"$EASEOFF" example paper-case-a | sed 's/"body": "ring"/"body": "sector"/; s/"layers": 28/"layers": 6/; s/"flank_rows": 10/"flank_rows": 4/
  s/"fillet_elements": 18/"fillet_elements": 6/; s/"sector_teeth": 5/"sector_teeth": 3/; s/"positions": 64/"positions": 32/; s/"te_harmonics": 16/"te_harmonics": 12/' \
  >"$folder/design.json"
"$folder/transmission-error" "$folder/design.json" >"$folder/out" 2>"$folder/err"
result $? "the example prepares its gear"
[ "$(grep -c '^[0-9.]* -*[0-9.]*$' "$folder/out")" -eq 96 ]
result $? "the example prints its transmission error at each position of three load cases"
mv "$folder/out" "$folder/library"
"$EASEOFF" analyze "$folder/design.json" --no-cache --json >"$folder/result" 2>"$folder/err"
printf '[%s]' "$(sed -n 's/^0.0000 //p' "$folder/library" | tr '\n' ',' | sed 's/,$//')" >"$folder/first"
verdict=$("$numbers" "$folder/result" '/load_cases/*/lte/pair_um/0' "$folder/first" "" 5.1e-6)
result $? "the example has the numbers of the terminal, um: $verdict"
echo '{"gear_pair": {"pinion_teeth": 17}}' >"$folder/wrong.json"
"$folder/transmission-error" "$folder/wrong.json" >"$folder/out" 2>"$folder/err"
[ $? -eq 1 ] && grep -q '^/gear_pair/gear_teeth: ' "$folder/err"
result $? "the example names what is wrong at its key"
if command -v g++ >/dev/null; then
  echo '#include <easeoff.h>' >"$folder/header.cpp"
  # shellcheck disable=SC2046
  g++ -Wall -Wextra -Werror -fsyntax-only $(config --cflags) "$folder/header.cpp" >"$folder/out" 2>"$folder/err"
  result $? "C++ takes the header"
fi
nm -g --defined-only "$tree/lib/libeaseoff.a" 2>/dev/null | awk 'NF == 3 { print $3 }' | grep -vE '^(eo_|easeoff_)' | sort -u >"$folder/out"
[ ! -s "$folder/out" ] && nm "$tree/lib/libeaseoff.a" 2>/dev/null | grep -q " T easeoff_new$"
result $? "every name of the archive begins with eo_ or easeoff_"
echo "1..$count"
exit $failed

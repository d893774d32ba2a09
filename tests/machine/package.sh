#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian packages: built from a copy of the tree, looked over by lintian, unpacked into a folder of their own and used from there.
# Skipped with a word where Debian's tools are not installed (debhelper, dpkg-dev, lintian, autoconf-archive). Minutes.
#
#   tests/machine/package.sh [FOLDER]      FOLDER keeps the packages
set -eu

here=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d "${TMPDIR-/tmp}/package.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' INT TERM

say() { printf 'package: %s\n' "$*"; }

fail() {
  say "NOT $*"
  exit 1
}

for tool in dh dpkg-buildpackage lintian autoreconf; do
  command -v "$tool" >/dev/null || {
    say "SKIP: $tool is not installed"
    exit 0
  }
done

# What git knows, as it stands; without git the tree, less what a build leaves.
copy_tree() {
  mkdir "$scratch/easeoff"
  if git -C "$here" rev-parse --git-dir >/dev/null 2>&1; then
    (cd "$here" && git ls-files -z | tar --null -T - -cf -) | tar -C "$scratch/easeoff" -xf -
  else
    tar -C "$here" --exclude='./build*' --exclude=./node_modules --exclude='./*.tar.xz' -cf - . | tar -C "$scratch/easeoff" -xf -
  fi
}

build() {
  started=$(date +%s)
  (cd "$scratch/easeoff" && DEB_BUILD_OPTIONS="parallel=$(nproc)" dpkg-buildpackage -b -us -uc) >"$scratch/build.log" 2>&1 || {
    tail -n 30 "$scratch/build.log"
    fail "built"
  }
  say "built in $(($(date +%s) - started)) s:$(cd "$scratch" && for file in *.deb; do printf ' %s' "${file%%_*}"; done)"
}

check_lintian() {
  lintian --allow-root --fail-on error,warning "$scratch"/*.changes >"$scratch/lintian.log" 2>&1 || {
    cat "$scratch/lintian.log"
    fail "silent: lintian"
  }
  [ ! -s "$scratch/lintian.log" ] || {
    cat "$scratch/lintian.log"
    fail "silent: lintian"
  }
  say "lintian has nothing to say"
}

check_use() {
  root=$scratch/root
  for file in "$scratch"/*.deb; do
    case $file in *-dbgsym_*) ;; *) dpkg-deb -x "$file" "$root" ;; esac
  done
  said=$("$root/usr/bin/easeoff" --version) || fail "run"
  version=$(sed -n 's/^AC_INIT(\[easeoff\], \[\([^]]*\)\].*/\1/p' "$here/configure.ac")
  case $said in *"$version"*) ;; *) fail "version $version: $said" ;; esac
  "$root/usr/bin/easeoff" example single | "$root/usr/bin/easeoff" design - >/dev/null || fail "a design"
  man=$root/usr/share/man/man1/easeoff.1.gz
  gzip -dc "$man" | grep -q '^\.TH' || fail "a man page"
  grep -q '^ExecStart=/usr/bin/easeoff serve' "$root"/usr/lib/systemd/system/easeoff.service "$root"/lib/systemd/system/easeoff.service \
    2>/dev/null || fail "a unit file"
  for file in usr/share/bash-completion/completions/easeoff usr/include/easeoff.h usr/share/doc/easeoff/guide.md; do
    [ -s "$root/$file" ] || fail "$file"
  done
  page="without the page (no npm)"
  [ ! -f "$root/usr/share/easeoff/web/index.html" ] || page="with the page"
  say "$said; man page, unit, completion, header, manuals; $page"
}

copy_tree
build
check_lintian
check_use
[ -z "${1-}" ] || cp "$scratch"/*.deb "$1"
say "all is well"

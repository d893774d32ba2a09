#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Reads the whole source with tools that find what compilers and tests do not: clang-format, clang-tidy, cppcheck, shellcheck, eslint, tsc,
# codespell, links, the manual pages, and the licence line of each file. Called by `make lint`; a tool that is not installed is named and passed over.
#   SOURCES  the source's folder      FLAGS  the compiler's flags      MODULES  the page's work folder      MANUAL  the manual pages
#   JOBS  processes at a time
: "${SOURCES:=.}" "${FLAGS:=-Isrc}" "${MODULES:=$SOURCES/web}" "${MANUAL:=doc/manual}" "${JOBS:=2}"
cd "$SOURCES" || exit 99
count=0 failed=0
found=$(mktemp) list=$(mktemp) || exit 99
trap 'rm -f "$found" "$list"' EXIT

# What the repository, or the tarball, has of these names, into $list.
files() # NAME...
{
  git ls-files -- "$@" >"$list" 2>/dev/null ||
    for name in "$@"; do find . -path "*${name#\*}"; done >"$list"
}

# reads TOOL WHAT COMMAND...: the files of $list; not ok when it finds anything
reads() {
  tool=$1 what=$2
  shift 2
  count=$((count + 1))
  if ! command -v "$tool" >/dev/null; then
    echo "ok $count - $what # SKIP $tool is not installed"
  elif xargs "$@" <"$list" >"$found" 2>&1; then
    echo "ok $count - $what"
  else
    failed=1
    sed 's/^/# /' "$found"
    echo "not ok $count - $what"
  fi
}

files '*.c' '*.h' '*.cpp'
reads clang-format 'one layout of the C files' clang-format --dry-run -Werror
# shellcheck disable=SC2086
files 'src/*.c'
reads clang-tidy 'clang-tidy has nothing to say' -P "$JOBS" -n 8 sh -c 'clang-tidy --quiet "$@" -- $0 2>/dev/null' "$FLAGS"
files 'src/*.c'
reads cppcheck 'cppcheck has nothing to say' -n 400 cppcheck -j "$JOBS" --quiet --std=c11 --error-exitcode=1 \
  --enable=warning,portability --inline-suppr --library=tests/lint.cfg --suppress=missingIncludeSystem -U__has_include -Isrc
files '*.sh' bootstrap .ci/run
reads shellcheck 'shellcheck has nothing to say' shellcheck -x -S warning
eslint=$MODULES/node_modules/eslint/bin/eslint.js
tsc=$MODULES/node_modules/typescript/bin/tsc
node=node
[ -f "$eslint" ] || node="npm's library"
echo web/src tests/browser web/build.mjs web/manual.mjs >"$list"
reads "$node" 'eslint has nothing to say' node "$eslint" -c "$MODULES/eslint.config.js"
echo "$MODULES/tsconfig.json" >"$list"
reads "$node" 'the types of the page agree with its code' node "$tsc" --noEmit --strict -p
files '*.md' '*.c' '*.h' '*.sh' '*.py' '*.js' '*.mjs' '*.css' '*.html' '*.am'
reads codespell 'no word is misspelt' codespell -q 3 -I tests/lint.words
files '*.md'
reads python3 'every link inside leads somewhere' python3 tests/doc/links.py
find "$MANUAL" -name '*.1' >"$list"
# shellcheck disable=SC2016
reads groff 'the manual pages are well formed' sh -c '! groff -man -ww -Tutf8 -z "$@" 2>&1 | grep .' sh
files '*.c' '*.h' '*.cpp' '*.sh' '*.py' '*.js' '*.mjs' '*.am' 'sql/*.sql' 'web/src/*.html' 'docker/*'
reads grep 'each file states its licence' sh -c '! grep -L "SPDX-License-Identifier: GPL-3.0-or-later" "$@" | grep .' sh
echo "1..$count"
exit $failed

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Prints which part of the lines of each folder of src/ the tests have run, from the counts that a build with --enable-coverage leaves.
# Called by `make coverage` in the folder of the build, before the tests (clear) and after them (report).
#   SOURCES  the source's folder
: "${SOURCES:=..}"
if [ -z "$(find src -name '*.gcno' | head -n 1)" ]; then
  echo "coverage: nothing is counted in this build; configure one with --enable-coverage" >&2
  exit 1
fi

# Of each source file: its name, its lines, those that were run. A header is counted in each file that includes it: the best count stands.
counts()
{
  if command -v gcovr >/dev/null; then
    gcovr --root "$SOURCES" --object-directory . --csv | awk -F, 'NR > 1 { print $1, $2, $3 }'
  else
    find src -name '*.gcno' -exec gcov --no-output {} + 2>/dev/null |
      awk -F"[':% ]+" '/^File/ { file = $2 } /^Lines executed/ && file { print file, $5, int($3 * $5 / 100 + .5); file = "" }'
  fi
}

case $1 in
clear) find . -name '*.gcda' -exec rm -f {} + ;;
report)
  counts | awk '
    match($1, /src\/[a-z]+\//) {
      name = substr($1, RSTART)
      if (!(name in lines) || $3 > run[name]) { lines[name] = $2; run[name] = $3 }
    }
    END {
      for (name in lines) {
        split(name, part, "/")
        total[part[2]] += lines[name]; covered[part[2]] += run[name]
        all += lines[name]; done += run[name]
      }
      for (folder in total)
        printf "%-14s %6d of %6d lines  %5.1f %%\n", folder, covered[folder], total[folder], 100 * covered[folder] / total[folder] | "sort"
      close("sort")
      printf "%-14s %6d of %6d lines  %5.1f %%\n", "src", done, all, all ? 100 * done / all : 0
    }'
  ;;
esac

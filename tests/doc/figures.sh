#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The figures of the manuals that need no finite elements, drawn again and compared with those that are kept (doc/figures.py).
. "$(dirname "$0")/../support/tap.sh"
command -v python3 >/dev/null || {
  echo "1..0 # SKIP python3 is not there"
  exit 0
}
python3 "$SOURCES/doc/figures.py" "$EASEOFF" "$folder" quick >"$folder/out" 2>"$folder/err"
result $? "the figures are drawn"
for figure in "$folder"/*.svg; do
  # places are written to a tenth of a point, so another processor may round one differently
  python3 - "$figure" "$SOURCES/doc/figures/$(basename "$figure")" >"$folder/out" 2>"$folder/err" <<'END'
import re, sys
number = r"-?\d+\.?\d*"
drawn, kept = (open(path, encoding="utf-8").read() for path in sys.argv[1:])
assert re.sub(number, "0", drawn) == re.sub(number, "0", kept), "other shapes or words"
off = [(a, b) for a, b in zip(re.findall(number, drawn), re.findall(number, kept)) if abs(float(a) - float(b)) > 0.11]
assert not off, f"other numbers: {off[:5]}"
END
  result $? "$(basename "$figure") is what make figures writes"
done
used=$(cat "$SOURCES"/README.md "$SOURCES"/doc/*.md "$SOURCES"/doc/theory/*.md | grep -oE 'figures/[a-z-]+\.svg' | sort -u | sed 's/.*\///')
kept=$(cd "$SOURCES/doc/figures" && ls ./*.svg | sed 's/.*\///')
[ "$used" = "$kept" ]
result $? "every figure is shown, and every one shown is there"
echo "1..$count"
exit $failed

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Recordings in the shapes that rigs write, each with a known answer: the right number, or a question. A refusal names what
# is open; a wrong number never comes out.
. "$(dirname "$0")/../support/tap.sh"

"$EASEOFF" verify "$CASES/rig-public/cases.json" >"$folder/out" 2>&1
result $? "recordings of known shapes are right or questioned: $(tail -n 1 "$folder/out")"
"$EASEOFF" verify "$CASES/rig-public/speeds.json" >"$folder/out" 2>&1
result $? "recordings at speeds that change are right or questioned: $(tail -n 1 "$folder/out")"
"$EASEOFF" verify "$CASES/rig-held-out/cases.json" >"$folder/out" 2>&1
result $? "recordings of shapes nobody had tried are right or questioned: $(tail -n 1 "$folder/out")"
"$EASEOFF" example paper >"$folder/design.json"

measure() # PATTERN WHAT ARGUMENT...
{
  pattern=$1 what=$2
  shift 2
  "$EASEOFF" measure "$folder/design.json" "$@" --no-prediction >"$folder/out" 2>&1
  grep -q -e "$pattern" "$folder/out"
  result $? "$what: $(grep -e RMS -e layout "$folder/out" | head -n 1)"
}

shapes=$CASES/rig-public
measure 'RMS 2\.2[12]' "two files that state when they began" "$shapes/pair-start-times-pinion.csv.gz" \
  --gear "$shapes/pair-start-times-gear.csv.gz"
measure 'square wave' "square waves ask for their lines" "$shapes/words-square-waves.csv.gz"
measure 'rows per line' "and are too coarse with them" "$shapes/words-square-waves.csv.gz" --layout '{"lines": 360}'
measure 'RMS 2\.2[12]' "a torque beside the angles" "$shapes/words-torque-changes.csv.gz" --torque 828

echo "1..$count"
exit $failed

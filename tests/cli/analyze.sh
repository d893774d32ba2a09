#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# easeoff analyze from outside: every example, the result document's names, files, the same bytes again, exit status, bad input.
. "$(dirname "$0")/../support/tap.sh"
: "${CHECK_RESULT:=tests/support/check-result}"
unset EASEOFF_DATA XDG_CACHE_HOME
HOME=$folder/home
export HOME
mkdir "$HOME"

expect() # STATUS WHAT COMMAND...
{
  wanted=$1 what=$2
  shift 2
  "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  [ "$status" -eq "$wanted" ] && { [ "$wanted" -ne 0 ] || [ ! -s "$folder/err" ]; }
  result $? "$what: the program ends with $status, expected $wanted"
}

says() # TEXT: on the only line of standard error
{
  [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$1" "$folder/err"
  result $? "$what: the program says \"$1\" on one line"
}

holds() # TEXT FILE
{
  grep -q -e "$1" "$2"
  result $? "$what: $(basename "$2") holds \"$1\""
}

# A coarse finite-element model: these tests are about the program, not about its accuracy.
coarse()
{
  "$EASEOFF" example "$1" | sed 's/"layers": 28/"layers": 6/; s/"flank_rows": 10/"flank_rows": 6/; s/"fillet_elements": 18/"fillet_elements": 8/
    s/"sector_teeth": 5/"sector_teeth": 3/; s/"positions": 64/"positions": 32/; s/"cells_per_line": null/"cells_per_line": 16/' >"$folder/$1.json"
}

timeless() { sed '/"timing_ms"/,$d' "$1"; }
# A resolved design states everything.
stated() { sed '/^  "assumed": \[/,/^  \],/d'; }

for name in paper paper-case-a paper-case-b narrow shifted single; do
  coarse $name
  expect 0 "$name --json" "$EASEOFF" analyze "$folder/$name.json" --json
  ends=2
  [ $name = single ] && ends=1
  "$CHECK_RESULT" $ends <"$folder/out" >"$folder/err"
  result $? "$name has every name that is relied on"
  mv "$folder/out" "$folder/$name.out"
done
timeless "$folder/paper-case-b.out" >"$folder/cold"
[ "$(find "$HOME/.cache/easeoff/flexibility" -name '*.flex' | wc -l)" -eq 4 ]
result $? "four gear pairs are kept under ~/.cache"

expect 0 "a second run" "$EASEOFF" analyze "$folder/paper-case-b.json" --json
timeless "$folder/out" | cmp -s - "$folder/cold"
result $? "a second run gives the same bytes"
expect 0 "a run without the cache" "$EASEOFF" analyze "$folder/paper-case-b.json" --json --no-cache
timeless "$folder/out" | cmp -s - "$folder/cold"
result $? "a run without the cache gives the same bytes"
expect 0 "a run with a fresh cache" "$EASEOFF" analyze "$folder/paper-case-b.json" --json --data "$folder/data"
timeless "$folder/out" | cmp -s - "$folder/cold"
result $? "a run with a fresh cache gives the same bytes"
expect 0 "a design from standard input" sh -c "cat '$folder/paper-case-b.json' | '$EASEOFF' analyze - --json"
timeless "$folder/out" | cmp -s - "$folder/cold"
result $? "a design from standard input gives the same bytes"
# The document's own design is a design again, and the same one.
sed -n '/^  "design": {/,/^  },/p' "$folder/paper-case-b.out" | sed '1s/.*/{/; $s/.*/}/' >"$folder/resolved.json"
expect 0 "the resolved design" "$EASEOFF" analyze "$folder/resolved.json" --json
stated <"$folder/cold" >"$folder/cold.stated"
timeless "$folder/out" | stated | cmp -s - "$folder/cold.stated"
result $? "the resolved design gives the same bytes, but for what it states"
for file in "$folder"/data/flexibility/*.flex; do head -c 1000 "$file" >"$file.short" && mv "$file.short" "$file"; done
expect 0 "a damaged cache" "$EASEOFF" analyze "$folder/paper-case-b.json" --json --data "$folder/data"
holds "A damaged cache file was thrown away" "$folder/out"
sed '/"warnings"/,$d' "$folder/out" >"$folder/again"
sed '/"warnings"/,$d' "$folder/cold" | cmp -s - "$folder/again"
result $? "a damaged cache gives the same numbers, and a note"
export EASEOFF_DATA="$folder/environment"
expect 0 "a cache named by the environment" "$EASEOFF" analyze "$folder/paper.json" --json
[ "$(find "$folder/environment/flexibility" -name '*.flex' | wc -l)" -eq 1 ]
result $? "a cache that the environment names is used"
EASEOFF_DATA=$folder/paper.json/below
expect 0 "a cache that cannot be made" "$EASEOFF" analyze "$folder/paper.json" --json
holds 'The cache' "$folder/out"
unset EASEOFF_DATA

expect 0 "the summary" "$EASEOFF" analyze "$folder/paper-case-a.json"
for text in 'eps_alpha 1.438, eps_beta 1.187' '828 N m, 2000 rpm, share 0.5: converged' 'peak-to-peak loaded TE  um ' 'root stress' 'fitness' 'Time, ms'; do
  holds "$text" "$folder/out"
done
printf '{"gear_pair":{"pinion_teeth":17,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55},
  "resolution":{"layers":6,"flank_rows":6,"fillet_elements":8,"sector_teeth":3},"load_cases":[{"torque_Nm":828,"speed_rpm":2000,"share":3}]}' >"$folder/short.json"
expect 0 "a design of five keys" "$EASEOFF" analyze "$folder/short.json"
holds 'summed to 3' "$folder/out"

expect 0 "--csv" "$EASEOFF" analyze "$folder/paper-case-b.json" --csv "$folder/csv"
[ ! -s "$folder/out" ] && [ "$(find "$folder/csv" -type f | wc -l)" -eq 21 ]
result $? "--csv writes 21 files and prints nothing"
holds '^position,lte_pair_um,lte_left_um,lte_right_um,' "$folder/csv/case-2-curves.csv"
holds '^mesh_order,lte_pair_um,left_deflection_um,' "$folder/csv/case-3-orders.csv"
holds '^s_mm,eta_mm,pressure_MPa,unloaded_clearance_um' "$folder/csv/case-1-pattern-right.csv"
[ "$(wc -l <"$folder/csv/case-1-curves.csv")" -eq 33 ] && [ "$(wc -l <"$folder/csv/case-1-pattern-left.csv")" -eq 826 ]
result $? "the files have one line per mesh position and per point of the pattern"
[ "$(awk -F, 'NR > 1 && NF != n { bad = 1 } { n = NF } END { print bad + 0 }' "$folder/csv/case-1-vibration.csv")" -eq 0 ]
result $? "the lines have as many cells as headings"
expect 0 "a pair with one end" "$EASEOFF" analyze "$folder/single.json" --csv "$folder/csv1"
[ ! -e "$folder/csv1/case-1-pattern-right.csv" ] && ! grep -q right "$folder/csv1/case-1-curves.csv"
result $? "one end has no files or columns of a right end"
expect 0 "--csv and --json" "$EASEOFF" analyze "$folder/paper-case-b.json" --json --csv "$folder/csv"
timeless "$folder/out" | cmp -s - "$folder/cold"
result $? "--csv and --json give the document too"

touch "$folder/file"
expect 2 "a folder that cannot be made" "$EASEOFF" analyze "$folder/paper.json" --csv "$folder/none/below"
says 'cannot be made'
expect 2 "a file in the place of the folder" "$EASEOFF" analyze "$folder/paper.json" --csv "$folder/file"
says 'cannot be written'
mkdir "$folder/taken" && mkdir "$folder/taken/unloaded.csv"
expect 2 "a file that cannot be replaced" "$EASEOFF" analyze "$folder/paper.json" --csv "$folder/taken"
says 'cannot be replaced'
[ -z "$(find "$folder/taken" -name '*.part')" ]
result $? "a file that cannot be replaced leaves nothing half-written"
if [ -w /dev/full ]; then
  expect 2 "a full disk" sh -c "'$EASEOFF' analyze '$folder/paper.json' --json >/dev/full"
  says 'No space left'
fi

expect 1 "no design" "$EASEOFF" analyze
says 'an argument is missing'
expect 1 "a missing file" "$EASEOFF" analyze "$folder/none.json"
says 'cannot be opened'
expect 1 "an unknown option" "$EASEOFF" analyze "$folder/paper.json" --cvs "$folder/csv"
says '--cvs'
expect 1 "--csv without a folder" "$EASEOFF" analyze "$folder/paper.json" --csv
says 'incomplete option'
bad() # WHAT SED-EXPRESSION MESSAGE
{
  sed "$2" "$folder/paper.json" >"$folder/bad.json"
  expect 1 "$1" "$EASEOFF" analyze "$folder/bad.json"
  says "$3"
}
bad "no face" 's/"face_width_mm": 55/"face_width_mm": 0/' '/gear_pair/face_width_mm: 0 is outside'
bad "no overlap" 's/"helix_angle_deg": 24/"helix_angle_deg": 0/; s/"pinion_teeth": 17/"pinion_teeth": 20/; s/"addendum_coefficient": 1,/"addendum_coefficient": 0.5,/' 'contact ratio'
bad "undercut" 's/"pinion_teeth": 17/"pinion_teeth": 9/' 'undercut'
bad "no backlash" 's/"backlash_um": 100/"backlash_um": -1/' '/gear_pair/backlash_um'
bad "no speed" '0,/"speed_rpm": 2000/s//"speed_rpm": 0/' '/load_cases/0/speed_rpm: 0 is outside'
bad "no load cases" '/"load_cases"/,/\]/c "load_cases": [],' '/load_cases'
bad "negative stiffness" 's/"pinion_bearing_stiffness_N_per_um": 800/"pinion_bearing_stiffness_N_per_um": -800/' '/supports/pinion_bearing_stiffness_N_per_um: -800 is outside'
bad "a text for a number" 's/"pinion_teeth": 17/"pinion_teeth": "17"/' 'Must be a number'
bad "not a number" 's/"pinion_teeth": 17/"pinion_teeth": NaN/' 'Line '
bad "too fine" 's/"cells_per_line": 16/"cells_per_line": 400/; s/"positions": 32/"positions": 1024/' '/resolution/cells_per_line: 400 cells'
bad "too wide" 's/"face_width_mm": 55/"face_width_mm": 5000/' '/gear_pair/face_width_mm: .* contact lines'
bad "no harmonics" 's/"harmonics": 24/"harmonics": 0/' '/resolution/harmonics: 0 is outside'

# A stop in the middle of a preparation.
"$EASEOFF" example paper >"$folder/fine.json"
"$EASEOFF" analyze "$folder/fine.json" --json --data "$folder/stopped" >"$folder/out" 2>"$folder/err" &
process=$!
waited=0 # until it catches SIGTERM (bit 14), then into the preparation
until grep -qE '^SigCgt:.*[4-7c-f][0-9a-f]{3}$' "/proc/$process/status" 2>/dev/null || [ $waited -ge 100 ]; do
  sleep 0.1
  waited=$((waited + 1))
done
sleep 0.4
kill -TERM $process
wait $process
status=$?
[ $status -eq 2 ] && [ ! -s "$folder/out" ]
result $? "a program that is stopped ends with $status and prints nothing"
says 'Stopped'
[ -z "$(find "$folder/stopped" -name '*.part' -o -name '*.flex')" ]
result $? "a program that is stopped keeps nothing half-written"

echo "1..$count"
exit $failed

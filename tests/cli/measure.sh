#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# easeoff rig, verify and measure from outside: recordings of a simulated pair, whole and faulty, and what is made of them.
. "$(dirname "$0")/../support/tap.sh"

design=$folder/design.json
coarse='"resolution": {"positions": 16, "cells_per_line": 8, "sector_teeth": 3, "neighbour_coupling": false, "layers": 8, "flank_rows": 4, "fillet_elements": 6, "harmonics": 12, "te_harmonics": 8}'
flank='{"tip_relief_um": 14, "tip_relief_start_mm": 1.6, "root_relief_um": 17, "root_relief_start_mm": 3.5, "lead_crowning_um": 12}'
cat >"$design" <<END
{"version": 1, "gear_pair": {"pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55, "groove_width_mm": 50},
 "modification": {"pinion": {"left": $flank, "right": $flank}}, $coarse}
END

rig() # FILE OPTIONS...
{
  file=$1
  shift
  "$EASEOFF" rig --design "$design" --data "$folder/data" -o "$folder/$file" --truth "$folder/$file.json" --turns 45 --sample-rate-Hz 12000 "$@" \
    >"$folder/out" 2>"$folder/err"
}

measure() { "$EASEOFF" measure "$design" --data "$folder/data" "$@" >"$folder/out" 2>"$folder/err"; }

# Each recording comes back to its truth, or is refused with the finding that its fault deserves.
recording() # WHAT OPTIONS...
{
  what=$1
  shift
  rig r.csv --torque 828 --speed 2000 "$@" && "$EASEOFF" verify "$folder/r.csv.json" >"$folder/out" 2>"$folder/err"
  result $? "a recording is measured, $what: $(sed -n 's/^  files: r.csv  *\([0-9]*\) .*/\1/p' "$folder/out") numbers"
}
recording "angles in degrees"
recording "wrapped radians without a heading" --radians yes --wrapped yes --heading none
recording "semicolons and decimal commas below a block of remarks" --separator semicolon --decimal-comma yes --heading block --carriage-return yes --byte-order-mark yes
recording "tabs and a row of units" --separator tab --heading units-row
recording "raw tracks" --output sine-cosine --pinion-lines 150 --gear-lines 150
recording "counts" --output counts --interpolation 1024 --pinion-lines 9000 --gear-lines 18000
recording "pulse times" --output pulses --pinion-lines 1024 --gear-lines 2500 --noise-urad 0
recording "jitter of both channels" --jitter-us 2
recording "a speed that drifts and swings" --speed-drift 0.01 --speed-swing 0.002 --speed-swing-turns 90
recording "a coupling that swings once per turn" --speed-swing 0.03 --speed-swing-turns 1
recording "a run-up" --speed-drift 1.2 --sample-rate-Hz 30000
recording "two steady states" --speed-step 0.15
recording "rests, and a run-up to a steady state" --rest-before-s 0.1 --rest-after-s 0.1 --run-up-turns 6 --sample-rate-Hz 24000
recording "there and back" --turn-back yes
recording "a clock for each encoder" --gear-sample-rate-Hz 17000 --gear-delay-us 30
recording "counts from an index pulse on" --output counts --interpolation 1024 --index-pulse yes
recording "a wheel with missing teeth" --output pulses --pinion-lines 1024 --gear-lines 2500 --gear-missing-teeth 2 --noise-urad 0
recording "torque and speed beside" --torque-column yes --torque-change 0.4 --speed-column yes
recording "fault swapped" --fault swapped
# With sanitizers one fault is enough here: tests/unit/measurement/test-measurement has all of them from the same generator.
[ "${SANITIZED-}" ] ||
  for fault in reversed radians radians-gear "dropped --fault-size 40" "dropped-silent --fault-size 3" nan spike "time --fault-size 10" teeth slip constant stuck; do
    # shellcheck disable=SC2086 # its words
    recording "fault $fault" --fault $fault
  done
recording "fault saturated" --fault saturated --output sine-cosine --pinion-lines 150 --gear-lines 150

# The same settings give the same bytes; another seed gives others.
rig one.csv --torque 828 --speed 2000 --turns 2 && rig two.csv --torque 828 --speed 2000 --turns 2 && cmp -s "$folder/one.csv" "$folder/two.csv"
result $? "a second recording has the same bytes"
rig two.csv --torque 828 --speed 2000 --turns 2 --seed 2 && ! cmp -s "$folder/one.csv" "$folder/two.csv"
result $? "a recording of another seed has other bytes"

# ---- measured and predicted ----

for torque in 414 828; do
  rig "plain$torque.csv" --torque $torque --speed 2000 --unmodified yes --seed $torque && rig "relieved$torque.csv" --torque $torque --speed 2000
  result $? "recordings at $torque N m are made"
done
cat >"$folder/list.json" <<END
{"measurements": [{"file": "plain414.csv", "label": "unmodified", "torque_Nm": 414}, {"file": "relieved414.csv", "torque_Nm": 414},
  {"file": "plain828.csv", "label": "unmodified", "torque_Nm": 828}, {"file": "relieved828.csv", "torque_Nm": 828}]}
END
measure --list "$folder/list.json" --json --csv "$folder/table.csv"
result $? "four recordings are measured"
verdict=$("$numbers" "$folder/out" /comparison/measurements/measured_rms_m_per_s2 "$folder/out" /comparison/measurements/predicted_rms_m_per_s2 0.005 relative 2>&1)
result $? "the RMS is as predicted: $verdict"
verdict=$("$numbers" "$folder/out" /comparison/reductions/\*/measured_percent "$folder/out" /comparison/reductions/\*/predicted_percent 1.5 2>&1)
result $? "the reductions are as predicted: $verdict"
verdict=$("$numbers" "$folder/out" /measurements/\*/result/rms_m_per_s2/value "$folder/out" /comparison/measurements/measured_rms_m_per_s2 0 2>&1)
result $? "the RMS is the same in both places: $verdict"
verdict=$("$numbers" "$folder/out" /comparison/details/2/te/measured_um "$folder/out" /comparison/details/2/te/predicted_um 0.05 2>&1)
result $? "the curves lie on each other: $verdict"
[ "$(wc -l <"$folder/table.csv")" -eq 5 ] && [ "$(awk -F, '{ print NF }' "$folder/table.csv" | sort -u)" = 11 ]
result $? "the CSV has a heading and four lines"
measure --list "$folder/list.json"
grep -q "the modification takes" "$folder/out" && grep -q "relieved828.csv, orders" "$folder/out"
result $? "the table for people has every recording"
measure "$folder/relieved828.csv" "$folder/plain828.csv" --torque 828 --harmonics 3 --no-prediction --json
[ $? -eq 0 ] && grep -q '"comparison": null' "$folder/out" && [ "$("$numbers" "$folder/out" /measurements/\*/result/mesh/order | tr ',' '\n' | wc -l)" -eq 6 ]
result $? "two recordings alone have three orders each"

# Inputs that nobody knows: the rig has other bearings than the design says.
sed 's/"modification"/"supports": {"pinion_bearing_stiffness_N_per_um": 500}, "modification"/' "$design" >"$folder/rig.json"
for speed in 1500 2500; do
  "$EASEOFF" rig --design "$folder/rig.json" --data "$folder/data" --torque 828 --speed $speed -o "$folder/s$speed.csv" --sample-rate-Hz 12000 2>"$folder/err"
  result $? "a rig with softer bearings is recorded at $speed rpm"
done
measure "$folder/s1500.csv" "$folder/s2500.csv" --torque 828 --json --update '{"unknowns": {"pinion_bearing_stiffness_N_per_um": [200, 2000]}, "model_error": 0.01}' --apply "$folder/found.json"
"$numbers" "$folder/out" /update/unknowns/\*/confidence_95 2>/dev/null | tr -d '[] ' | tr ',' '\n' | awk 'NR == 1 { low = $1 } NR == 2 { high = $1 } END { exit !(low < 500 && high > 500 && high - low < 100) }'
result $? "the stiffness of its bearings is found: $("$numbers" "$folder/out" /update/unknowns/\*/value 2>/dev/null)"
verdict=$("$numbers" "$folder/found.json" /supports/pinion_bearing_stiffness_N_per_um "$folder/out" /update/unknowns/\*/value 1e-9 relative 2>&1)
result $? "the stiffness that was found is applied: $verdict"

# ---- wrong input ----

refuses() # TEXT ARGUMENTS...
{
  text=$1
  shift
  "$EASEOFF" "$@" >"$folder/out" 2>"$folder/err"
  [ $? -eq 1 ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$text" "$folder/err"
  result $? "the program refuses $* and says $text"
}
refuses "needs --design FILE" rig -o x.csv
refuses "/turns: -1 is outside" rig --design "$design" -o "$folder/x.csv" --turns=-1
refuses "/fault: \"drunk\"" rig --design "$design" -o "$folder/x.csv" --fault drunk
refuses "/sample_rate_Hz" rig --design "$design" -o "$folder/x.csv" --sample-rate-Hz fast
refuses "decimal comma needs" rig --design "$design" -o "$folder/x.csv" --decimal-comma yes
refuses "unknown or incomplete option" rig --design "$design" -o "$folder/x.csv" --turn 5
[ ! -e "$folder/x.csv" ]
result $? "a refused recording writes nothing"
measure "$folder/none.csv"
[ $? -eq 2 ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q "could not be opened" "$folder/err"
result $? "a file that is not there is refused"
refuses "Between 1 and" measure "$design"
refuses "/layout/lines" measure "$design" "$folder/one.csv" --layout '{"lines": -5}'
refuses "/layout/colums: Unknown key" measure "$design" "$folder/one.csv" --layout '{"colums": {}}'
refuses "has no column \"nix\"" measure "$design" "$folder/one.csv" --layout '{"columns": {"pinion": "nix"}}'
refuses "/label: \"best\"" measure "$design" "$folder/one.csv" --label best
refuses "/torque_Nm: 0 is outside" measure "$design" "$folder/one.csv" --torque 0
refuses "unknowns/colour" measure "$design" "$folder/one.csv" --update '{"unknowns": {"colour": [1, 2]}}'
refuses "/to_s: Must be after" measure "$design" "$folder/one.csv" --from 3 --to 2
refuses "/part: 99 is outside" measure "$design" "$folder/one.csv" --part 99

# A row of a list is read as strictly as an upload, and a fault names the row and the key.
row() # KEYS TEXT
{
  printf '{"measurements": [{"file": "one.csv"}, {"file": "one.csv", %s}]}' "$1" >"$folder/rows.json"
  refuses "$2" measure "$design" --list "$folder/rows.json"
}
row '"torque_Nm": -828' "/measurements/1/torque_Nm: -828 is outside"
row '"speed_rpm": "2000"' "/measurements/1/speed_rpm: Must be a number"
row '"lable": "unmodified"' "/measurements/1/lable: Unknown key"
row '"from_s": 3, "to_s": 2' "/measurements/1/to_s: Must be after"
echo '{"measurements": [{"label": "modified"}]}' >"$folder/rows.json"
refuses "/measurements/0/file" measure "$design" --list "$folder/rows.json"
echo '{"measurements": [{"file": "one.csv"}], "torque_Nm": 828}' >"$folder/rows.json"
refuses "/torque_Nm: Unknown key" measure "$design" --list "$folder/rows.json" --torque 828
echo '{"measurements": [{"file": "relieved828.csv", "harmonics": 3}, {"file": "plain828.csv", "label": "unmodified"}]}' >"$folder/rows.json"
measure --list "$folder/rows.json" --torque 828 --harmonics 2 --no-prediction --json
[ $? -eq 0 ] && [ "$("$numbers" "$folder/out" /measurements/\*/result/mesh/order | tr ',' '\n' | wc -l)" -eq 5 ]
result $? "a row of its own harmonics, another as the options say"
"$EASEOFF" measure --help | grep -q "^  run_up .*left out" && "$EASEOFF" rig --help | grep -q "^  gear_delay_us .*default 0"
result $? "the help of measure and rig prints their tables"
refuses "goes with --update" measure "$design" "$folder/one.csv" --apply x.json
refuses "Unknown key\|not JSON\|expected\|JSON" measure "$design" "$folder/one.csv" --layout '{"lines" 5}'
measure "$folder/one.csv" --no-prediction
[ $? -eq 1 ] && grep -q "No result" "$folder/out" && grep -q "refused: The recording covers" "$folder/out"
result $? "two turns are refused, with the reason"
printf 'a,b,c\n1,2\n' >"$folder/bad.csv"
measure "$folder/bad.csv"
[ $? -eq 1 ] && [ "$(wc -l <"$folder/err")" -eq 1 ]
result $? "a file that is no recording is refused: $(cat "$folder/err")"

echo "1..$count"
exit $failed

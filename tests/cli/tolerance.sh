#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# easeoff tolerance from outside, on the paper pair at a coarse resolution.
. "$(dirname "$0")/../support/tap.sh"

write_design() # BLOCK: with this block "tolerance"
{
  cat >"$folder/design.json" <<EOF
{"name": "coarse", "gear_pair": {"pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55, "groove_width_mm": 50},
 "load_cases": [{"torque_Nm": 828, "speed_rpm": 2000}],
 "modification": {"pinion": {"left": {"tip_relief_um": 14, "tip_relief_start_mm": 1.6}, "right": {"tip_relief_um": 14, "tip_relief_start_mm": 1.6}}},
 "tolerance": $1,
 "resolution": {"positions": 16, "cells_per_line": 12, "body": "sector", "sector_teeth": 3, "layers": 10, "flank_rows": 6, "fillet_elements": 8, "te_harmonics": 5, "harmonics": 8}}
EOF
}

tolerance() # ARGUMENTS...: output in $folder/out
{
  "$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" "$@" >"$folder/out" 2>"$folder/err"
  result $? "easeoff tolerance $* succeeds"
}

refuses() # TEXT BLOCK: on one line of standard error
{
  write_design "$2"
  "$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" >"$folder/out" 2>"$folder/err"
  [ $? -eq 1 ] && [ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$1" "$folder/err"
  result $? "easeoff tolerance is refused with $1"
}

same() # FILE FILE WHAT
{
  cmp -s "$1" "$2"
  result $? "$3"
}

# near WHAT PLACE FILE PLACE TOLERANCE [KIND [FACTOR]]: see json-numbers.c.
near()
{
  what=$1
  shift
  verdict=$("$numbers" "$folder/out" "$@" 2>&1)
  result $? "$what: $verdict"
}

# With sanitizers fewer ranks and ends go through the same code.
some_ranks="1 2 3" ends="KILL-0 KILL-2 TERM-0"
[ ! "${SANITIZED-}" ] || some_ranks=3 ends=KILL-2

# ---- linear response: apex offsets displace the mean transmission error by tan(beta_b)/2 um per um ----

write_design '{"vibration": false, "inputs": [{"key": "alignment.pinion_apex_offset_um", "sigma": 12}, {"key": "alignment.gear_apex_offset_um", "sigma": 9}]}'
tolerance --pairs 256 --json
# nominal + z tan(beta_b)/2 sqrt(12^2 + 9^2): 95 % lies 5.102461 um above the median; 4 standard errors of 256 pairs are 1.6 um
median=$("$numbers" "$folder/out" /outputs/3/percentiles/4/value | tr -d "[] ")
awk "BEGIN { printf \"[%.9f]\", $median + 5.102461 }" >"$folder/expected"
near "the 95 % percentile of a normal" /outputs/3/percentiles/7/value "$folder/expected" "" 0.25 absolute
echo "[3.102076]" >"$folder/expected"
near "standard deviation of a normal output" /outputs/3/std "$folder/expected" "" 0.02 relative
echo "[1]" >"$folder/expected"
near "R2 of a linear response" /outputs/3/R2 "$folder/expected" "" 1e-6 absolute
echo "[0.64]" >"$folder/expected"
near "the pinion's share of the variance" /outputs/3/influences/0/first "$folder/expected" "" 0.005 absolute
echo "[0]" >"$folder/expected"
near "the swing does not change" /outputs/0/std "$folder/expected" "" 1e-4 absolute

# ---- the same bytes for threads and after a stop ----

write_design '{"preset": "iso_class", "class": 5, "centre_distance": true, "limits": [{"output": "peak_to_peak_um", "at_most": 1.2}]}'
tolerance --pairs 24 --json --threads 1 --worst "$folder/worst.json"
cp "$folder/out" "$folder/one.json"
tolerance --pairs 24 --json --threads 3
same "$folder/out" "$folder/one.json" "3 threads give the same bytes"
cp "$folder/design.json" "$folder/first.json"
write_design '{"centre_distance": true, "root_stress": true}'
tolerance --pairs 8 --json --threads 1
cp "$folder/out" "$folder/rooted.json"
tolerance --pairs 8 --json --threads 3
same "$folder/out" "$folder/rooted.json" "root stress at many centre distances: 3 threads give the same bytes"
"$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" --pairs 8 >"$folder/out" 2>"$folder/err"
grep -q "^note: The centre distance is drawn in steps of 2.88 um" "$folder/out"
result $? "the analysis says in which steps the distance is drawn"
cp "$folder/first.json" "$folder/design.json"
tolerance --pairs 24 --json --keep "$folder/pairs"
# as a kill leaves it: a row cut off in its middle
head -n 12 "$folder/pairs" >"$folder/cut"
sed -n 13p "$folder/pairs" | cut -c 1-40 | tr -d '\n' >>"$folder/cut"
tolerance --pairs 24 --json --keep "$folder/cut"
same "$folder/out" "$folder/one.json" "an analysis after a stop gives the same bytes"
[ "$(grep -c ';$' "$folder/cut")" -eq 24 ]
result $? "the file has every pair once"
tolerance --pairs 24 --json --keep "$folder/cut"
same "$folder/out" "$folder/one.json" "an analysis from its file alone gives the same bytes"

# ---- coarse first: most pairs on a coarse grid, those that decide in full ----

write_design '{"preset": "iso_class", "class": 5, "method": "coarse_first", "limits": [{"output": "rms_m_per_s2", "at_most": 40}]}'
tolerance --pairs 200 --json --threads 1 --keep "$folder/first" --csv "$folder/first.csv"
cp "$folder/out" "$folder/first.json"
tolerance --pairs 200 --json --threads 3
same "$folder/out" "$folder/first.json" "coarse first: 3 threads give the same bytes"
full=$("$numbers" "$folder/out" /full_pairs | tr -d "[] ")
[ "$full" -ge 64 ] && [ "$full" -lt 200 ] && [ "$(grep -c ';$' "$folder/first")" -eq "$full" ] && [ "$(wc -l <"$folder/first.csv")" -eq $((full + 1)) ]
result $? "$full of 200 pairs are in full, and each has a row and a line"
head -n 40 "$folder/first" >"$folder/cut"
tolerance --pairs 200 --json --keep "$folder/cut"
same "$folder/out" "$folder/first.json" "coarse first: an analysis after a stop gives the same bytes"
"$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" --pairs 200 >"$folder/out" 2>"$folder/err"
grep -q "note: $full of 200 pairs were computed in full" "$folder/out"
result $? "the analysis says how many pairs are in full"
write_design '{"preset": "iso_class", "class": 5, "method": "full", "limits": [{"output": "rms_m_per_s2", "at_most": 40}]}'
tolerance --pairs 200 --json --keep "$folder/first"
[ "$(grep -c ';$' "$folder/first")" -eq 200 ]
result $? "an analysis in full goes on from the pairs of the coarse one, to all 200"
cp "$folder/out" "$folder/all.json"
cp "$folder/first.json" "$folder/out"
near "95 % of the swing" /outputs/0/percentiles/7/value "$folder/all.json" /outputs/0/percentiles/7/value 0.02 relative
near "median of the swing" /outputs/0/percentiles/4/value "$folder/all.json" /outputs/0/percentiles/4/value 0.02 relative
near "95 % of the RMS acceleration" /outputs/15/percentiles/7/value "$folder/all.json" /outputs/15/percentiles/7/value 0.02 relative
near "the yield" /yields/1/fraction "$folder/all.json" /yields/1/fraction 0.02 absolute
near "the worst pair" /worst/pair "$folder/all.json" /worst/pair 0 absolute
write_design '{"preset": "iso_class", "class": 5, "centre_distance": true, "limits": [{"output": "peak_to_peak_um", "at_most": 1.2}]}'

# ---- a stop: what is there is said ----

stopped() # WORDS METHOD PAIRS ENOUGH: stopped when so many pairs are kept
{
  write_design "{\"preset\": \"iso_class\", \"class\": 5, \"method\": \"$2\"}"
  rm -f "$folder/stopped"
  "$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" --pairs "$3" --json --threads 1 --keep "$folder/stopped" >"$folder/out" 2>"$folder/err" &
  looks=0
  while [ $looks -lt 6000 ] && [ "$(cat "$folder/stopped" 2>/dev/null | grep -c ';$')" -lt "$4" ]; do
    sleep 0.01
    looks=$((looks + 1))
  done
  kill -s TERM $!
  wait $!
  result $? "a stop of $2 is no failure"
  grep -q "Stopped. The same command goes on from here." "$folder/err" && grep -q "$1" "$folder/out"
  result $? "and its result says $1"
}

stopped 'Stopped: these are the first [0-9]* of the 100000 pairs' full 100000 20
pairs=$("$numbers" "$folder/out" /pairs | tr -d "[] ")
[ "$pairs" -ge 10 ] && [ "$pairs" -lt 100000 ]
result $? "of $pairs pairs"
cp "$folder/out" "$folder/stopped.json"
tolerance --pairs "$pairs" --json
near "the 95 % percentile is that of as many pairs" /outputs/0/percentiles/7/value "$folder/stopped.json" /outputs/0/percentiles/7/value 0 absolute
stopped 'Stopped when [0-9]* of 2000 pairs had been computed in full, all of them coarsely' coarse_first 2000 12
pairs=$("$numbers" "$folder/out" /pairs | tr -d "[] ")
[ "$pairs" -eq 2000 ]
result $? "of all $pairs pairs, most of them coarse"

# ---- teeth of its own for every pair: shaft orders grow with the eccentricity, the same bytes ----

write_design '{"vibration": false, "single_teeth": true, "inputs": [{"key": "pitch.*.tolerance_share", "sigma": 0}, {"key": "pitch.gear.eccentricity_um", "distribution": "half_normal", "sigma": 2}]}, "pitch": {"positions_per_cycle": 4}'
tolerance --pairs 8 --json --csv "$folder/teeth.csv"
echo "[1]" >"$folder/expected"
near "R2 of the gear's shaft order" /outputs/17/R2 "$folder/expected" "" 1e-6 absolute
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
  NR > 1 { ratio = $at["load_cases.1.gear_order_um"] / $at["pitch.gear.eccentricity_um"]; if (ratio < 0.99 || ratio > 1 || $at["load_cases.1.pinion_order_um"] > 1e-6) bad++ }
  END { exit bad || NR != 9 }' "$folder/teeth.csv"
result $? "the order of the gear is the eccentricity, less what 44 teeth average"
toothed='"preset": "iso_class", "class": 5, "vibration": false'
write_design "{$toothed, \"single_teeth\": true}, \"pitch\": {\"positions_per_cycle\": 4}"
tolerance --pairs 4 --json --threads 1 --worst "$folder/toothed.json" --keep "$folder/teeth"
cp "$folder/out" "$folder/teeth.json"
head -n 3 "$folder/teeth" >"$folder/cut"
tolerance --pairs 4 --json --threads 3 --keep "$folder/cut"
same "$folder/out" "$folder/teeth.json" "single teeth: 3 threads after a stop give the same bytes"
write_design "{$toothed}, \"pitch\": {\"positions_per_cycle\": 4}"
tolerance --pairs 4 --single-teeth
grep -q '[0-9] \.\. open' "$folder/out" && ! grep -qw nan "$folder/out"
result $? "the analysis tells of an interval that few pairs leave open"
tolerance --pairs 4 --json --single-teeth
same "$folder/out" "$folder/teeth.json" "single teeth by the option give the same bytes"
"$EASEOFF" analyze "$folder/toothed.json" --json --data "$folder/data" >"$folder/out" 2>"$folder/err"
"$numbers" "$folder/teeth.json" /outputs/15/histogram/largest >"$folder/expected"
near "the worst pair has these teeth" /pitch/load_cases/0/lte/peak_to_peak_um "$folder/expected" "" 1e-6 relative
# root stress: the largest of any tooth of the worst pair is what an analysis of these teeth finds
write_design '{"preset": "iso_class", "class": 5, "vibration": false, "root_stress": true, "single_teeth": true, "limits": [{"output": "tooth_root_stress_MPa", "at_most": 1}]}, "pitch": {"positions_per_cycle": 4}'
tolerance --pairs 2 --json --worst "$folder/toothed.json" --csv "$folder/stressed.csv"
awk -F, '{ sub(/\r$/, "") }
  NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
  NR > 1 { stress = $at["load_cases.1.tooth_root_stress_MPa"]; if (stress > most) most = stress; if (stress < $at["load_cases.1.root_stress_MPa"] * 0.9) bad++ }
  END { printf "[%.9f]\n", most; exit bad || NR != 3 }' "$folder/stressed.csv" >"$folder/expected"
result $? "every pair has a root stress of its teeth, of the size of that of the cycle"
"$EASEOFF" analyze "$folder/toothed.json" --json --data "$folder/data" >"$folder/out" 2>"$folder/err"
"$numbers" "$folder/out" /pitch/load_cases/0/largest/root_stress/pinion/stress_MPa >"$folder/pinion"
"$numbers" "$folder/out" /pitch/load_cases/0/largest/root_stress/gear/stress_MPa >"$folder/gear"
cat "$folder/pinion" "$folder/gear" | tr -d '[] ' | sort -g | tail -n 1 | sed 's/.*/[&]/' >"$folder/larger"
cp "$folder/larger" "$folder/out"
near "the worst pair's teeth have this root stress" "" "$folder/expected" "" 1e-6 relative
write_design '{"preset": "iso_class", "class": 5, "centre_distance": true, "limits": [{"output": "peak_to_peak_um", "at_most": 1.2}]}'

# ---- and for MPI ranks, where mpirun is ----

# pid of a rank; empty: it is not there yet
rank()
{
  for comm in $(grep -lx easeoff /proc/[0-9]*/comm 2>/dev/null); do
    process=${comm%/comm}
    variables=$(tr '\0' '\n' 2>/dev/null <"$process/environ") || continue
    case $variables in *"EASEOFF_TEST=$folder"*) ;; *) continue ;; esac
    case $variables in *"OMPI_COMM_WORLD_RANK=$1"*) echo "${process#/proc/}" && return ;; esac
  done 2>/dev/null
}

ranked() # RANKS ARGUMENTS...: output in $folder/out
{
  ranks=$1
  shift
  mpirun --oversubscribe -n "$ranks" "$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" "$@" >"$folder/out" 2>"$folder/err"
}

kept() # rows of a run on ranks, 0 before it begins
{
  cat "$folder/ranked" 2>/dev/null | grep -c ';$'
}

if command -v mpirun >/dev/null && [ -e "$(dirname "$EASEOFF")/easeoff-mpi.so" ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 EASEOFF_TEST="$folder"
  tolerance --pairs 24 --csv "$folder/one.csv"
  for ranks in $some_ranks; do
    ranked $ranks --pairs 24 --json --csv "$folder/ranks.csv"
    same "$folder/out" "$folder/one.json" "the same bytes with $ranks ranks"
    same "$folder/ranks.csv" "$folder/one.csv" "and the same lines"
  done
  write_design '{"preset": "iso_class", "class": 5, "method": "coarse_first", "limits": [{"output": "rms_m_per_s2", "at_most": 40}]}'
  ranked 3 --pairs 200 --json
  same "$folder/out" "$folder/first.json" "coarse first: 3 ranks give the same bytes"
  write_design '{"preset": "iso_class", "class": 5, "centre_distance": true, "limits": [{"output": "peak_to_peak_um", "at_most": 1.2}]}'
  write_design "{$toothed, \"single_teeth\": true}, \"pitch\": {\"positions_per_cycle\": 4}"
  ranked 2 --pairs 4 --json
  same "$folder/out" "$folder/teeth.json" "single teeth: 2 ranks give the same bytes"
  write_design '{"preset": "iso_class", "class": 5, "centre_distance": true, "limits": [{"output": "peak_to_peak_um", "at_most": 1.2}]}'
  ranked 2 --pairs 24 --json --threads 2 --cache "$folder/node"
  same "$folder/out" "$folder/one.json" "threads of a rank with a folder of pairs of its own give the same bytes"
  [ -n "$(ls "$folder/node")" ]
  result $? "the folder of pairs of its own has the pair"
  tolerance --pairs 400 --json
  cp "$folder/out" "$folder/many.json"
  for end in $ends; do
    victim=${end#*-}
    rm -f "$folder/ranked"
    ranked 3 --pairs 400 --json --keep "$folder/ranked" &
    pid='' found=0 looks=0
    while [ $looks -lt 400 ] && [ "$found" -lt 10 ]; do
      [ -n "$pid" ] || pid=$(rank $victim)
      found=$(kept)
      looks=$((looks + 1))
    done
    [ -z "$pid" ] || kill -s "${end%-*}" "$pid" 2>/dev/null
    wait
    found=$(kept)
    [ "$found" -ge 10 ] && [ "$found" -lt 400 ]
    result $? "SIG${end%-*} to rank $victim after $found of 400 pairs ends the run"
    [ "${end%-*}" = KILL ] || grep -q "Stopped. The same command goes on from here." "$folder/err"
    result $? "a signal that ends the run leaves a word where there is one"
    ranked 3 --pairs 400 --json --keep "$folder/ranked"
    same "$folder/out" "$folder/many.json" "the start after a signal goes on with the same bytes"
    [ "$(kept)" -eq 400 ]
    result $? "the file has every pair once after a signal"
  done
else
  count=$((count + 1))
  echo "ok $count - MPI ranks # SKIP no mpirun, or built without MPI"
fi

write_design '{"preset": "iso_class", "class": 6}'
"$EASEOFF" tolerance "$folder/design.json" --data "$folder/data" --pairs 24 --keep "$folder/cut" >"$folder/out" 2>"$folder/err"
[ $? -eq 1 ] && grep -q "no pairs of this design" "$folder/err"
result $? "a file of another scatter is refused"

# ---- the worst pair opens as a design ----

"$EASEOFF" analyze "$folder/worst.json" --json --data "$folder/data" >"$folder/out" 2>"$folder/err"
result $? "the worst pair is a design"
"$numbers" "$folder/one.json" /outputs/0/histogram/largest >"$folder/expected"
near "with the largest swing" /load_cases/0/lte/peak_to_peak_um "$folder/expected" "" 1e-6 relative

write_design '{"vibration": false, "inputs": [{"key": "compliance_factor", "sigma": 0.1}]}'
tolerance --pairs 8
grep -q "note: The worst pair has the compliance_factor [01][.0-9]*, which no design states" "$folder/out"
result $? "a compliance that the worst pair's design does not have is told"

# ---- measured teeth in place of the design's ----

write_design '{}, "pitch": {"positions_per_cycle": 8, "gear_tooth": 5, "pinion": {"tolerance_class": 5}}'
awk 'BEGIN { print "member,end,flank,tooth,index_um"; for (i = 0; i < 17; i++) printf "pinion,left,drive,%d,%d\n", i, i * 3 % 7 }' >"$folder/teeth.csv"
"$EASEOFF" analyze "$folder/design.json" --pitch "$folder/teeth.csv" --json --data "$folder/data" >"$folder/out" 2>"$folder/err"
result $? "a table of measured teeth is taken"
grep -q '"gear_tooth": 5\b' "$folder/out" && grep -q '"positions_per_cycle": 8\b' "$folder/out" && ! grep -q '"tolerance_class": 5' "$folder/out"
result $? "the pair is put together and looked at as its design says"
grep -q "With 8 positions of a mesh cycle the vibration of single teeth has 3 harmonics" "$folder/out"
result $? "positions that are too few for the vibration are told"

# ---- people and tables ----

write_design '{}'
tolerance --pairs 8 --no-vibration --csv "$folder/pairs.csv"
grep -q "class 5 of ISO 1328-1:2013 is taken" "$folder/out" && grep -q "Worst pair" "$folder/out"
result $? "the table for people says what was assumed"
[ "$(wc -l <"$folder/pairs.csv")" -eq 9 ] && [ "$(awk -F, '{ print NF }' "$folder/pairs.csv" | sort -u | wc -l)" -eq 1 ]
result $? "the CSV has a heading and a line for each pair"

refuses "there is no such number" '{"inputs": [{"key": "modification.pinion.left.profil_slope_um", "sigma": 1}]}'
refuses "another gear pair is prepared anew" '{"inputs": [{"key": "gear_pair.normal_module_mm", "sigma": 1}]}'
refuses "single_teeth" '{"inputs": [{"key": "pitch.gear.eccentricity_um", "sigma": 1}]}'
refuses "number of the hunting period" '{"limits": [{"output": "tooth_load_N", "at_most": 1}]}'
refuses '"root_stress": true' '{"limits": [{"output": "root_stress_MPa", "at_most": 1e6}]}'
refuses '"vibration": true' '{"vibration": false, "limits": [{"output": "rms_m_per_s2", "at_most": 1e6}]}'
refuses "alignment.centre_distance_deviation_um" '{"inputs": [{"key": "gear_pair.centre_distance_mm", "sigma": 0.01}]}'
refuses "not stated" '{"inputs": [{"key": "modification.pinion.left.tip_relief_diameter_mm", "sigma": 1}]}'
refuses "no output \"peak\"" '{"pairs": 1, "limits": [{"output": "peak", "at_most": 1}]}'
refuses "no load case 2" '{"pairs": 1, "limits": [{"output": "peak_to_peak_um", "load_case": 2, "at_most": 1}]}'
refuses "alone cannot keep a sum" '{"inputs": [{"key": "alignment.gear_apex_offset_um", "distribution": "fixed_sum", "group": "a", "sigma": 1}]}'
refuses "every input has values" '{"preset": "as_measured", "inputs": [{"key": "alignment.gear_apex_offset_um", "sigma": 1}]}'
refuses "edge_load_share, K_Hbeta, K_Halpha, impact_N, rms_m_per_s2, dynamic_factor, contact_loss" '{"limits": [{"output": "peak", "at_most": 1}]}'
refuses "tooth_pressure_MPa, period_rms_m_per_s2, tooth_root_stress_MPa.$" '{"single_teeth": true, "root_stress": true, "limits": [{"output": "peak", "at_most": 1}]}'
refuses "compliance_factor: nothing scatters: state sigma" '{"inputs": [{"key": "compliance_factor"}]}'
refuses "nothing scatters: state sigma, of a uniform distribution low and high" '{"inputs": [{"key": "speed_factor", "distribution": "uniform"}]}'
refuses "tolerance/inputs/0/sigma.*\"uniform\" does not use sigma" '{"inputs": [{"key": "speed_factor", "distribution": "uniform", "low": -0.1, "high": 0.1, "sigma": 0.1}]}'
refuses "tolerance/inputs/0/low.*\"normal\" does not use low" '{"inputs": [{"key": "speed_factor", "sigma": 0.1, "low": -0.1}]}'
refuses "tolerance/inputs/0/values.*values are missing: state the measured deviations" '{"inputs": [{"key": "speed_factor", "distribution": "values"}]}'
refuses "ISO 1328-1:2013 has the tolerance classes 1 .. 11. Grade 12 is one of the edition of 1995" '{"preset": "iso_class", "class": 12}'
refuses "low is above high: 1 is to be the largest" '{"inputs": [{"key": "speed_factor", "distribution": "uniform", "low": 1, "high": 0}]}'

echo "1..$count"
exit $failed

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# easeoff sweep from outside, on the paper pair, case A, at a coarse resolution.
. "$(dirname "$0")/../support/tap.sh"

design=$folder/design.json
sweep() # ARGUMENTS...: output in $folder/out
{
  "$EASEOFF" sweep "$design" --data "$folder/data" "$@" >"$folder/out" 2>"$folder/err"
  result $? "easeoff sweep $* succeeds"
}

refuses() # TEXT ARGUMENTS...: on one line of standard error
{
  text=$1
  shift
  "$EASEOFF" sweep "$@" >"$folder/out" 2>"$folder/err"
  [ $? -eq 1 ] && [ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$text" "$folder/err"
  result $? "easeoff sweep $* is refused with $text"
}

# near WHAT PLACE FILE PLACE TOLERANCE [KIND [FACTOR]]: see json-numbers.c.
near()
{
  what=$1
  shift
  verdict=$("$numbers" "$folder/out" "$@" 2>&1)
  result $? "$what: $verdict"
}

same() # FILE FILE WHAT
{
  cmp -s "$1" "$2"
  result $? "$3"
}

column() { "$numbers" "$folder/out" "$1" | tr -d '[] ' | tr ',' '\n'; }

ascends() # WHAT PLACE
{
  column "$2" | awk 'NR > 1 && $1 <= last { bad = 1 } { last = $1 } END { exit bad || NR < 3 }'
  result $? "$1 ascends"
}

coarse='"resolution": {"positions": 32, "cells_per_line": 16, "sector_teeth": 3, "neighbour_coupling": false, "layers": 14, "flank_rows": 6, "fillet_elements": 8}'
write_design() # MORE KEYS
{
  crowning='"lead_crowning_um": 12.23'
  flank='{"tip_relief_um": 14, "tip_relief_start_mm": 1.6, "root_relief_um": 17, "root_relief_start_mm": 3.5, '$crowning'}'
  cat >"$design" <<END
{"version": 1, "gear_pair": {"pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55, "groove_width_mm": 50},
 $1 "modification": {"pinion": {"left": $flank, "right": $flank}}, $coarse}
END
}
write_design ""

# With sanitizers fewer points and threads go through the same code.
torques=14 several="1 2 5"
[ ! "${SANITIZED-}" ] || torques=4 several=2

# ---- torque: the same numbers as one evaluation ----

sweep --torque 621:1035:3 --json
cp "$folder/out" "$folder/torque.json"
"$EASEOFF" analyze "$design" --data "$folder/data" --json >"$folder/analysis.json" 2>"$folder/err"
result $? "the analysis beside the sweep succeeds"
near "torques are those of the load cases" /torque_Nm "$folder/analysis.json" '/load_cases/*/torque_Nm' 1e-12 relative
near "speed of the case with the largest share" /speed_rpm "$folder/analysis.json" /load_cases/1/speed_rpm 1e-12 relative
near "PPLTE of each torque, um" /modified/by_torque/peak_to_peak_um "$folder/analysis.json" '/load_cases/*/lte/peak_to_peak_um' 1e-6 relative
near "mean LTE of each torque, um" /modified/by_torque/mean_um "$folder/analysis.json" '/load_cases/*/lte/mean_um' 1e-8 relative
near "largest pressure of each torque, MPa" /modified/by_torque/left/max_pressure_MPa "$folder/analysis.json" '/load_cases/*/contact/max_pressure_MPa/left' 1e-5 relative
for end in left right; do
  near "impact of the $end end, N" "/modified/points/$end/impact_force_N" "$folder/analysis.json" "/load_cases/*/impact/$end/general_force_N" 1e-5 relative
  near "RMS of the $end end, m/s2" "/modified/points/$end/rms_m_per_s2/normal" "$folder/analysis.json" "/load_cases/*/vibration/$end/rms_m_per_s2/normal" 1e-3 relative
done
for reading in normal transverse rotational; do
  near "RMS of the pair, $reading" "/modified/points/rms_m_per_s2/$reading" "$folder/analysis.json" "/load_cases/*/vibration/rms_m_per_s2/$reading" 1e-3 relative
done
near "PPLTE of the unmodified pair, um" /unmodified/by_torque/peak_to_peak_um "$folder/analysis.json" '/objectives/unmodified/load_cases/*/peak_to_peak_um' 1e-6 relative
near "RMS of the unmodified pair, m/s2" /unmodified/points/rms_m_per_s2/normal "$folder/analysis.json" '/objectives/unmodified/load_cases/*/rms_m_per_s2' 1e-3 relative

sweep --torque 50:2000:$torques --json
ascends "the mean LTE" /modified/by_torque/mean_um
ascends "unmodified mean LTE" /unmodified/by_torque/mean_um
ascends "tangent stiffness" /modified/by_torque/left/tangent_stiffness_N_per_um
ascends "the largest pressure" /modified/by_torque/left/max_pressure_MPa
ascends "the torsional eigenfrequency, which the mesh makes," '/eigenfrequencies/frequency_Hz/*/5'

# ---- speed ----

sweep --speed 500:5000:10 --json
cp "$folder/out" "$folder/speed.json"
ascends "impact with speed" /modified/points/left/impact_force_N
column /modified/points/left/impact_force_N | awk '{ f[NR] = $1 } END { r = f[8] / f[4]; exit !(r > 2 && r < 2.1) }' # v grows like the speed, the Hertz part stiffens
result $? "twice the speed gives a little more than twice the impact"
near "the first torque's transmission error has nothing to do with speed" /modified/by_torque/peak_to_peak_um "$folder/torque.json" /modified/by_torque/peak_to_peak_um/1 1e-9 relative
near "RMS at 2000 rpm, as in the torque sweep, m/s2" /modified/points/rms_m_per_s2/normal/3 "$folder/torque.json" /modified/points/rms_m_per_s2/normal/1 1e-9 relative
near "impact at 2000 rpm, as in the torque sweep, N" /modified/points/right/impact_force_N/3 "$folder/torque.json" /modified/points/right/impact_force_N/1 1e-9 relative
grep -q '"down": null' "$folder/out"
result $? "both directions are the same in full contact"
for key in frequency_Hz order speed_rpm; do column "/crossings/$key" >"$folder/$key"; done
paste "$folder/frequency_Hz" "$folder/order" "$folder/speed_rpm" |
  awk '{ e = 60 * $1 / (17 * $2) / $3 - 1; if (e * e > 1e-18 || $3 < 500 || $3 > 5000) bad = 1 } END { exit bad || NR < 20 }'
result $? "an order line meets a mode where order * teeth * speed is its frequency"

# ---- another number in place of the torque ----

sweep --vary 'modification.pinion.*.tip_relief_um=10:18:3' --json
cp "$folder/out" "$folder/vary.json"
near "the values of the number" /vary/values "$folder/vary.json" /vary/values 0
[ "$(column /vary/values | tr '\n' ' ')" = "10 14 18 " ] && [ "$(column /torque_Nm | tr '\n' ' ')" = "828 828 828 " ]
result $? "a varied number has a step for each value, at the torque of the case with the largest share"
near "the design's own value is the design" /modified/by_torque/peak_to_peak_um/1 "$folder/torque.json" /modified/by_torque/peak_to_peak_um/1 1e-9 relative
near "RMS at the own value of the design, m/s2" /modified/points/rms_m_per_s2/normal/1 "$folder/torque.json" /modified/points/rms_m_per_s2/normal/1 1e-9 relative
near "PPLTE of the unmodified pair at each value, um" /unmodified/by_torque/peak_to_peak_um/2 "$folder/torque.json" /unmodified/by_torque/peak_to_peak_um/1 1e-9 relative
sweep --vary 'modification.pinion.*.tip_relief_um=10:18:3' --speed 1000:2000:2 --csv "$folder/vary.csv"
[ "$(head -1 "$folder/vary.csv" | cut -d, -f1-3)" = "modification.pinion.*.tip_relief_um,torque_Nm,speed_rpm" ] && [ "$(wc -l <"$folder/vary.csv")" -eq 7 ]
result $? "a varied number is a column of the CSV"
for end in left right; do
  grid='"grid": {"u_mm": [-5, 0, 5], "y_mm": [-27, 0, 27], "delta_um": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]'
  sed "s/\"$end\": {/&$grid}, /" "$design" >"$folder/with-grid" && mv "$folder/with-grid" "$design"
done
sweep --vary 'modification.pinion.*.grid_um.3.0=0:8:3' --json
cp "$folder/out" "$folder/vary.json"
near "a flat grid is none" /modified/by_torque/peak_to_peak_um/0 "$folder/torque.json" /modified/by_torque/peak_to_peak_um/1 1e-5 relative
near "the unmodified pair goes without any of it" /unmodified/by_torque/peak_to_peak_um/2 "$folder/torque.json" /unmodified/by_torque/peak_to_peak_um/1 1e-6 relative
sed 's/, \[0, 0, 0\]\]/, [8, 8, 8]], "kind": "designed"/g' "$design" >"$folder/grid.json"
"$EASEOFF" analyze "$folder/grid.json" --data "$folder/data" --json >"$folder/analysis.json" 2>"$folder/err"
result $? "the design of a step has the last of its grids"
near "PPLTE of the design with the last grid, um" /modified/by_torque/peak_to_peak_um/2 "$folder/analysis.json" /load_cases/1/lte/peak_to_peak_um 1e-6 relative
near "PPLTE of its unmodified pair, um" /unmodified/by_torque/peak_to_peak_um/2 "$folder/analysis.json" /objectives/unmodified/load_cases/1/peak_to_peak_um 1e-6 relative
refuses "another gear pair: a study varies it" "$design" --vary gear_pair.helix_angle_deg=24:25:2
refuses "is not KEY=FIRST:LAST:POINTS" "$design" --vary alignment.coupling_thrust_N
refuses "not both at once" "$design" --torque 600:700:2 --vary alignment.coupling_thrust_N=0:100:2
refuses "ranges of their own" "$design" --vary 'load_cases.*.torque_Nm=600:700:2'
refuses "no number" "$design" --vary modification.pinion.left.relief_shape=1:2:2
write_design ""

# ---- map, threads ----

sweep --torque 621:1035:3 --speed 500:5000:10 --json
cp "$folder/out" "$folder/map.json"
column /modified/points/rms_m_per_s2/normal | sed -n 11,20p | tr '\n' ',' | sed 's/.*/[&]/; s/,\]/]/' >"$folder/row"
cp "$folder/speed.json" "$folder/out"
near "the map's second row is the speed sweep" /modified/points/rms_m_per_s2/normal "$folder/row" "" 1e-9 relative
for threads in $several; do
  sweep --torque 621:1035:3 --speed 500:5000:10 --json --threads $threads
  same "$folder/out" "$folder/map.json" "$threads threads give the same bytes"
done
sweep --torque 621:1035:3 --speed 500:5000:10 --csv "$folder/map.csv"
[ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/map.csv")" -eq 31 ] && [ "$(awk -F, '{ print NF }' "$folder/map.csv" | sort -u | wc -l)" -eq 1 ]
result $? "the CSV has a heading and 30 lines"
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "rms_normal_m_per_s2") at = i } NR > 11 && NR < 22 { print $at }' "$folder/map.csv" | tr '\n' ',' | sed 's/.*/[&]/; s/,\]/]/' >"$folder/row"
cp "$folder/speed.json" "$folder/out"
near "RMS in the CSV, m/s2" /modified/points/rms_m_per_s2/normal "$folder/row" "" 1e-9 relative
sweep --torque 621:1035:3
grep -q "converged" "$folder/out" && grep -q "Eigenfrequencies at 828 N m" "$folder/out" && [ "$(grep -c '^ *[0-9.]* *2000 ' "$folder/out")" -eq 3 ]
result $? "the table for people has every step"

# ---- contact loss: less damping ----

write_design '"supports": {"mesh_damping_ratio": 0.02},'
sweep --torque 100 --speed 8400:9000:13 --json --threads 2
cp "$folder/out" "$folder/loss.json"
grep -q '"contact_lost"' "$folder/out"
result $? "teeth separate near the torsional resonance"
column /modified/points/rms_m_per_s2/normal >"$folder/up"
column /modified/down/rms_m_per_s2/normal >"$folder/down"
column /modified/points/left/contact_loss >"$folder/loss"
# The large period-one state of the balance, 600 m/s2 and more, is unstable here: it is left for the motion it leads to.
paste "$folder/up" "$folder/down" | awk '{ d = ($2 - $1) / $1; if (d * d < 1e-8) same++; if ($1 > 590 || $2 > 590) large++ }
  END { exit !(same >= 11 && !large) }'
result $? "unstable states are left: up and down end in the same motion, but where two are stable"
paste "$folder/up" "$folder/loss" | awk '$2 > 0 { if (!seen++) first = $1 } END { exit !(seen > 5) }'
result $? "contact loss is a share of the cycle"
if [ ! "${SANITIZED-}" ]; then
  sweep --torque 100 --speed 8400:9000:13 --json --threads 1
  same "$folder/out" "$folder/loss.json" "one thread gives the same bytes"
fi

# ---- one end; extremes; wrong input ----

cat >"$folder/single.json" <<END
{"version": 1, "gear_pair": {"ends": 1, "pinion_teeth": 23, "gear_teeth": 37, "normal_module_mm": 4, "helix_angle_deg": 12, "face_width_mm": 30}, $coarse}
END
"$EASEOFF" sweep "$folder/single.json" --torque 50:200:3 --speed 1000:2000:2 --json --data "$folder/data" >"$folder/out" 2>"$folder/err"
result $? "a pair with one end is swept"
! grep -q '"right": {$' "$folder/out" && ! grep -q '"right": {.*rms' "$folder/out"
result $? "a pair with one end has no right end"
"$numbers" "$folder/out" /unmodified/points/rms_m_per_s2/normal >"$folder/expected"
near "an unmodified design is the unmodified pair" /modified/points/rms_m_per_s2/normal "$folder/expected" "" 0
write_design ""
sweep --torque 0.001:1e8:3 --speed 0.1:1e6:2 --json
! grep -q -i 'nan\|inf' "$folder/out" && grep -q '"not_converged"' "$folder/out"
result $? "what cannot be solved is an outcome, not a number"

refuses "/torque_Nm: The range ends at 1, below its start 5" "$design" --torque 5:1:3
refuses "/torque_Nm: One point cannot reach" "$design" --torque 1:5:1
refuses "/torque_Nm: 3 points need a range" "$design" --torque 5:5:3
refuses "/torque_Nm/from: 0 is outside" "$design" --torque 0:5:3
refuses "/torque_Nm/from: -5 is outside" "$design" --torque=-5:5:3
refuses "/speed_rpm/to: 2000000 is outside" "$design" --speed 1:2e6:4
refuses "/speed_rpm/points: 2001 is outside" "$design" --speed 1:2000:2001
refuses "/torque_Nm/points: 2.5 is not a whole number" "$design" --torque 1:2:2.5
refuses "/torque_Nm/points: 0 is outside" "$design" --torque 1:2:0
refuses "more than the 20000 points" "$design" --torque 1:2000:2000 --speed 1:2000:2000
for wrong in a:3:4 1:2:3:4 nan:2:2 1::2 1e400:2:2 : "" 1:2:; do
  refuses "is not FIRST:LAST:POINTS" "$design" --torque "$wrong"
done
refuses "needs a range of torques, of another number, of speeds" "$design"
refuses "outside 1 .. 256" "$design" --torque 5 --threads 0
refuses "outside 1 .. 256" "$design" --torque 5 --threads 2x
refuses "unknown or incomplete option --torque" "$design" --torque
refuses "an argument is missing" --torque 1:2:3
refuses "cannot be opened" "$folder/none.json" --torque 1:2:3
sweep --torque 5:5:1 --speed 1000:1000:1
"$EASEOFF" sweep "$design" --torque 5 --csv "$folder/none/sweep.csv" --data "$folder/data" >"$folder/out" 2>"$folder/err"
[ $? -eq 2 ] && [ "$(wc -l <"$folder/err")" -eq 1 ]
result $? "a folder that is not there is a failure to write"

echo "1..$count"
exit $failed

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every stage alone, from outside: its numbers against the reference cases, and what it says to wrong input.
. "$(dirname "$0")/../support/stages.sh"
reference=$CASES/contact.json evaluations=$CASES/evaluation.json

refuses() # STATUS NAME INPUT TEXT: on one line of standard error
{
  printf '%s' "$3" | "$EASEOFF" stage "$2" - >"$folder/out" 2>"$folder/err"
  [ $? -eq "$1" ] && [ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$4" "$folder/err"
  result $? "the stage $2 refuses its input and says $4"
}

column() { "$numbers" "$reference" "$1"; }

# The paper's pair, and case A on both ends: lead crowning at the face ends from its coefficient per mm.
gear='"pinion_teeth":17,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55,"groove_width_mm":50,"gear_bore_mm":90'
pair='"gear_pair":{'$gear'}'
crowning=$(awk 'BEGIN { x = 27.5 / cos(24 * atan2(0, -1) / 180); printf "%.15g", 1.35e-5 * x * x * 1e3 }')
flank='{"tip_relief_um":14,"tip_relief_start_mm":1.6,"root_relief_um":17,"root_relief_start_mm":3.5,"lead_crowning_um":'$crowning'}'
case_a='"modification":{"pinion":{"left":'$flank',"right":'$flank'}}'
aligned='"alignment":{"shaft_angle_error_in_plane_deg":0}'
closed='"kernel":{"closed_form":{"compliance_um_per_N":0.0015,"length_mm":12,"centre_mm":-0.8,"linear_per_mm":0.02,"quadratic_per_mm2":0.004}}'
coarse='"sector_teeth":3,"neighbour_coupling":false,"layers":14,"flank_rows":6,"fillet_elements":8'

# ---- gear ----

stage geometry "{$pair}"
while read -r key name factor; do
  near "$key" "/$key" "$reference" "/macro/output/$name" 1e-9 relative "$factor"
done <<KEYS
transverse_module_mm mt 1
base_radius_mm/0 rb1 1
base_radius_mm/1 rb2 1
tip_radius_mm/0 ra1 1
root_radius_mm/1 rf2 1
centre_distance_mm a 1
transverse_base_pitch_mm pbt 1
path_start_mm sA 1
path_end_mm sE 1
transverse_contact_ratio eps_a 1
overlap_ratio eps_b 1
rack_factor ku 1
base_helix_angle_deg bb 57.29577951308232
KEYS
near "form radii of both members, mm" /form_radius_mm "$reference" /macro/fillet_form_radius 1e-8 relative

stage modification "{$pair,$case_a,\"s_mm\":$(column '/modification/points/*/0'),\"eta_mm\":$(column '/modification/points/*/1')}"
near "delta of case A, um" /delta_um "$reference" /modification/delta_um/A 1e-6
near "lead crowning coefficient a_l" /lead_crowning_per_um "$reference" /modification/mods/A/a_l 1e-12 relative 1e-3
stage modification "{$pair,$case_a,\"member\":\"gear\",\"u_mm\":[-5,0,5]}"
prints '"delta_um": \[0, 0, 0\]'

stage surface "{$pair,$case_a,\"u_mm\":$(column '/exact_surface_A/points/*/u'),\"v_mm\":$(column '/exact_surface_A/points/*/v')}"
for axis in 0:x 1:y 2:z; do
  near "surface point, ${axis#*:}, mm" "/position_${axis#*:}_mm" "$reference" "/exact_surface_A/points/*/x/${axis%:*}" 1e-8
  near "surface normal, ${axis#*:}" "/normal_${axis#*:}" "$reference" "/exact_surface_A/points/*/n/${axis%:*}" 1e-8
done
stage surface "{$pair,\"s_mm\":[-10,0,10],\"eta_mm\":[-27.5,3,20]}"
echo '[-27.5,3,20]' >"$folder/expected"
near "eta is the axial coordinate" /position_z_mm "$folder/expected" "" 1e-12

# ---- unloaded ----

stage gap "{$pair,$case_a,$aligned,\"phase_mm\":$(column /slice_gap_A/c)}"
near "slice gap of case A, um" /slice_gap_um "$reference" /slice_gap_A/exact_um 0.002
before=$("$numbers" "$reference" '/impact/corner_gap_unmod/*/before_A_mm' | tr -d '[]' | tr ',' '\n' |
  awk '{ printf "%s%.12f", (NR > 1 ? "," : ""), -14.564310930974557 - $1 }')
stage gap "{$pair,$aligned,\"s_mm\":[$before],\"eta_mm\":[0,0,0,0,0]}"
near "gap of the gear's tip corner before A, um" /gap_um "$reference" '/impact/corner_gap_unmod/*/gap_um' 1e-3
stage gap "{$pair,\"alignment\":{\"shaft_angle_error_in_plane_deg\":0.1},\"s_mm\":[0,0],\"eta_mm\":[-52.5,27.5],\"end\":\"right\"}"
awk 'BEGIN { r = atan2(0, -1) / 180; kappa = 0.1 * r; alpha = 21.723080 * r; beta = 22.470483 * r
  printf "[0,%.9f]", -kappa * sin(alpha) * cos(beta) * 80e3 }' >"$folder/expected"
near "misalignment about the middle of the groove, um" /gap_um "$folder/expected" "" 1e-4

tca='"phase_mm":'$(column /unloaded_tca/0/phase)',"end":"right"'
crossing='"alignment":{"shaft_angle_error_in_plane_deg":0,"shaft_angle_error_out_of_plane_deg":'$(awk 'BEGIN { printf "%.15g", 0.1 / 60 }')'}'
stage tca "{$pair,$case_a,$crossing,$tca,\"pivot\":\"mid_face\"}"
near "exact transmission error, um" '/phases/*/exact/transmission_error_um' "$reference" /unloaded_tca/0/TE_exact_um 1e-3 level
near "transmission error by the smallest gap, um" '/phases/*/minimum_gap/transmission_error_um' "$reference" /unloaded_tca/0/TE_mingap_um 0.04 level
near "contact path of the exact contact, s, mm" '/phases/*/exact/s_mm' "$reference" /unloaded_tca/0/s 0.02
near "contact path of the exact contact, eta, mm" '/phases/*/exact/eta_mm' "$reference" /unloaded_tca/0/eta 0.1
echo '[0]' >"$folder/expected"
near "difference between the two forms, um" /largest_difference_um "$folder/expected" "" 0.04
prints '"touch": "point"'
stage tca "{$pair,$tca}"
prints '"touch": "edge", *$'

# ---- loaded ----

row='/ltca_synthetic/cases/0/rows/*'
loaded='"pivot":"mid_face","torque_Nm":[828],"resolution":{"cells_per_line":60,"tip_edge_contact":false},"phase_mm":'$(column "$row/c")
stage contact "{$pair,$aligned,$closed,$loaded,\"points\":true}"
for end in 0:left 1:right; do
  place=/loads/0/${end#*:}
  near "Z, ${end#*:}, um" "$place/approach_um" "$reference" "$row/Z_um/${end%:*}" 1e-5 relative
  near "largest line load, N/mm" "$place/line_load_N_per_mm" "$reference" "$row/qmax/${end%:*}" 1e-5 relative
  near "load of pair 0, N" "$place/pairs/2/load_N" "$reference" "$row/share_N/${end%:*}/0" 2e-5 relative
  near "load of pair -1, N" "$place/pairs/1/load_N" "$reference" "$row/share_N/${end%:*}/-1" 2e-5 relative
done
awk 'BEGIN { printf "[%.9f]", 828e3 / (2 * 51.861854090581396 * cos(0.39218390684663407)) }' >"$folder/expected"
near "force of one end under half the torque, N" /loads/0/force_N "$folder/expected" "" 1e-9 relative

# Every point obeys the law of contact: gaps close where load is, and no load is negative. Sum over one position is the force.
"$numbers" "$folder/out" /loads/0/left/points/position | tr -d '[]' | tr ',' '\n' >"$folder/position"
for key in line_load_N_per_mm length_mm s_mm eta_mm pair; do
  "$numbers" "$folder/out" "/loads/0/left/points/$key" | tr -d '[]' | tr ',' '\n' >"$folder/$key"
done
paste "$folder/position" "$folder/line_load_N_per_mm" "$folder/length_mm" |
  awk '$2 < 0 { bad = 1 } { sum[$1] += $2 * $3 } END { for (j in sum) if (sum[j] - 8638.6196 > 1e-3 || 8638.6196 - sum[j] > 1e-3) bad = 1; exit bad }'
result $? "point loads are not negative and sum to the force"

stage contact "{$pair,$closed,\"alignment\":{\"shaft_angle_error_in_plane_deg\":0.02,\"pinion_axial\":\"fixed\"},\"torque_Nm\":[828],\"pivot\":\"mid_face\",\"resolution\":{\"positions\":16,\"te_harmonics\":8}}"
"$numbers" "$folder/out" /loads/0/left/approach_um >"$folder/expected"
near "approach of a fixed pinion, the same for both ends, um" /loads/0/right/approach_um "$folder/expected" "" 1e-3
stage contact "{$pair,$closed,\"alignment\":{\"shaft_angle_error_in_plane_deg\":0.02,\"pinion_axial\":\"floating\"},\"force_N\":[8000,4000],\"resolution\":{\"positions\":16,\"te_harmonics\":8}}"
echo '[8000,8000,8000,8000,8000,8000,8000,8000,8000,8000,8000,8000,8000,8000,8000,8000]' >"$folder/expected"
near "load of a floating pinion, the same for both ends, N" /loads/0/right/load_N "$folder/expected" "" 1e-9 relative
stage contact "{\"gear_pair\":{\"ends\":1,\"pinion_teeth\":20,\"gear_teeth\":30,\"normal_module_mm\":3,\"helix_angle_deg\":0,\"face_width_mm\":20},$closed,\"torque_Nm\":[100]}"
prints '"right": null'

stage impact "{$pair,$aligned,$closed,\"approach_um\":[7],\"resolution\":{\"positions\":16,\"te_harmonics\":8}}"
near "effective mass of the impact, kg" /effective_mass_kg "$reference" /impact/m_eff_t 1e-6 relative 1e3
near "phase of first touch, mm" /loads/0/right/phase_mm "$reference" /impact/cases/0/c 0.002
near "place of first touch on the face, mm" /loads/0/right/eta_mm "$reference" /impact/cases/0/eta 1e-6
near "radius of first touch on the pinion, mm" /loads/0/right/pinion_radius_mm "$reference" /impact/cases/0/pinion_radius 1e-4
near "closing speed of first touch, mm/s" /loads/0/right/speed_mm_per_s "$reference" /impact/cases/0/closing_speed_mm_s 1e-4 relative
prints '"off_line": true'

stage hertz "{\"relative_radius_mm\":$(column /macro/rho_n/0.0 | tr -d '[]'),\"depth_mm\":$(column /macro/h_depth/0.0),\"line_load_N_per_mm\":$(column /hertz/q)}"
near "approach in the pitch point, um" /approach_um "$reference" '/hertz/delta_um/*/1' 1e-6 relative
stage iso6336 "{$pair,\"torque_Nm\":828}"
near "ISO 6336-1 mesh stiffness, N/(mm um)" /stiffness/mesh_alpha_N_per_mm_um "$reference" /iso6336_1/cgamma 1e-9 relative
near "ISO 6336-3 root stress, MPa" /pinion_root/stress_MPa "$reference" /iso6336_3_pinion_828/sigmaF0 1e-9 relative

# ---- finite elements, coarse ----

elements='"resolution":{'$coarse'}'
stage flexibility "{$pair,$elements,\"cache_directory\":\"$folder/cache\",\"s_mm\":$(column '/fe_bulk/pinion/*/s')}"
near "bulk deflection of the pinion, um" '/rows/*/pinion_um' "$reference" '/fe_bulk/pinion/*/d' 0.06 relative
for i in 0 1 2 3 4; do
  near "bulk deflection of the gear in the same rows, um" "/rows/$((4 - i))/gear_um" "$reference" "/fe_bulk/gear/$i/d" 0.06 relative
done
prints '"from_cache": false'
cp "$folder/out" "$folder/first"
stage flexibility "{$pair,$elements,\"cache_directory\":\"$folder/cache\",\"s_mm\":$(column '/fe_bulk/pinion/*/s')}"
near "deflection read from the cache, um" '/rows/*/gear_um' "$folder/first" '/rows/*/gear_um' 0
prints '"from_cache": true'
points='"points":[{"s_mm":2,"eta_mm":-5,"force_N":1000},{"s_mm":-3,"eta_mm":10},{"pair":1,"s_mm":2,"eta_mm":0}]'
stage flexibility "{$pair,$elements,\"cache_directory\":\"$folder/cache\",$points,\"mesh\":{\"file\":\"$folder/mesh.inp\",\"member\":\"gear\",\"row\":2}}"
cp "$folder/out" "$folder/first"
[ "$(grep -c '^\*' "$folder/mesh.inp")" -ge 10 ] && grep -q 'TYPE=C3D8I' "$folder/mesh.inp"
result $? "the stage writes the mesh"
points='"points":[{"s_mm":2,"eta_mm":-5},{"s_mm":-3,"eta_mm":10,"force_N":1000},{"pair":1,"s_mm":2,"eta_mm":0}]'
stage flexibility "{$pair,$elements,\"cache_directory\":\"$folder/cache\",$points}"
near "Maxwell and Betti: load and place exchanged" /pinion_point_um/0 "$folder/first" /pinion_point_um/1 1e-12 relative
echo '[0]' >"$folder/expected"
near "deflection of the next pair without coupling, um" /gear_point_um/2 "$folder/expected" "" 0
refuses 2 flexibility "{$pair,$elements,\"mesh\":{\"file\":\"$folder/none/mesh.inp\"}}" "none/mesh.inp"

# The root of one tooth at one phase, with loads from the contact, and with the same loads stated point by point.
mesh=$pair,$aligned,'"torque_Nm":[828],"kernel":{"cache_directory":"'$folder/cache'"},"resolution":{'$coarse',"cells_per_line":12,"tip_edge_contact":false},"phase_mm":[4.792024]'
stage contact "{$mesh,\"points\":true}"
for key in line_load_N_per_mm length_mm s_mm eta_mm pair; do
  "$numbers" "$folder/out" "/loads/0/left/points/$key" | tr -d '[]' | tr ',' '\n' >"$folder/$key"
done
loads=$(paste "$folder/pair" "$folder/s_mm" "$folder/eta_mm" "$folder/line_load_N_per_mm" "$folder/length_mm" |
  awk '{ printf "%s{\"pair\":%d,\"s_mm\":%s,\"eta_mm\":%s,\"force_N\":%.17g}", (NR > 1 ? "," : ""), $1, $2, $3, $4 * $5 }')
stage root-stress "{$mesh}"
cp "$folder/out" "$folder/first"
stage root-stress "{$pair,\"kernel\":{\"cache_directory\":\"$folder/cache\"},$elements,\"points\":[$loads]}"
for member in pinion gear; do
  tooth=$("$numbers" "$folder/first" /loads/0/left/$member/phase | tr -d '[]' | tr ',' '\n' | awk '$1 > 0 && $1 < 1 { print NR - 1 }')
  near "root stress of the $member, MPa" "/points/$member/max_MPa" "$folder/first" "/loads/0/left/$member/history_MPa/$tooth" 0.005 relative
done
"$numbers" "$folder/out" /points/pinion/face_stress_MPa | tr -d '[]' | tr ',' '\n' | sort -g | tail -1 | awk '{ print "[" $1 "]" }' >"$folder/expected"
near "largest root stress, that over the face, MPa" /points/pinion/max_MPa "$folder/expected" "" 1e-9 relative

# ---- objectives ----

cat >"$folder/objective" <<'INPUT'
{"load_cases":[{"speed_rpm":2000,"torque_Nm":621,"share":0.2},{"speed_rpm":2000,"torque_Nm":828,"share":0.5},{"speed_rpm":2000,"torque_Nm":1035,"share":0.3}],
"values":[{"peak_to_peak_um":1,"impact_N":500,"rms_m_per_s2":20},{"peak_to_peak_um":2,"impact_N":600,"rms_m_per_s2":30,"root_stress_MPa":60},
{"peak_to_peak_um":3,"impact_N":700,"rms_m_per_s2":40}],
"unmodified":[{"peak_to_peak_um":2,"impact_N":1000,"rms_m_per_s2":50},{"peak_to_peak_um":4,"impact_N":1200,"rms_m_per_s2":60},
{"peak_to_peak_um":6,"impact_N":1400,"rms_m_per_s2":80}],
"objective":{"weights":[0.4,0.2,0.4],"constraints":{"root_stress_MPa":50}}}
INPUT
stage objective "$(cat "$folder/objective")"
# By hand: f1 = (0.2 1 + 0.5 2 + 0.3 3)/3, f2 = (0.2 500 + 0.5 600 + 0.3 700)/3, f3 = (0.2 20 + 0.5 30 + 0.3 40)/3; unmodified 1.4, 406.667, 21.333;
# J = 0.4 0.5 + 0.2 0.5 + 0.4 31/64; violation 60/50 - 1; fitness 1/J - 10 violation.
awk 'BEGIN { j = 0.3 + 0.4 * 31 / 64; printf "{\"f\":[%.15g,%.15g,%.15g],\"J\":%.15g,\"fitness\":%.15g}", 2.1 / 3, 610 / 3, 31 / 3, j, 1 / j - 2 }' >"$folder/expected"
near "objective f1, um" /objectives/f1_um "$folder/expected" /f/0 1e-12 relative
near "objective f2, N" /objectives/f2_N "$folder/expected" /f/1 1e-12 relative
near "objective f3, m/s2" /objectives/f3_m_per_s2 "$folder/expected" /f/2 1e-12 relative
near "objective J" /objectives/J "$folder/expected" /J 1e-12 relative
near "fitness of the design" /objectives/fitness "$folder/expected" /fitness 1e-12 relative

damping='"supports":{"pinion_bearing_stiffness_N_per_um":800,"gear_bearing_stiffness_N_per_um":1000,"gear_axial_stiffness_left_N_per_um":200,"gear_axial_stiffness_right_N_per_um":200,"mesh_damping_stiffness_N_per_um":1100,"torsional_coupling":"off"}'
stage evaluation "{$pair,$aligned,$closed,$damping,\"load_cases\":[{\"torque_Nm\":828,\"speed_rpm\":2000}],\"resolution\":{\"tip_edge_contact\":false,\"te_harmonics\":10}}"
near "PPLTE of S01, um" /load_cases/0/values/peak_to_peak_um "$evaluations" /cases/2/out/PPLTE_um 1e-3 relative
near "mean transmission error of S01, um" /load_cases/0/mean_um "$evaluations" /cases/2/out/LTE_mean_um 1e-3 relative
near "impact of S01, N" /load_cases/0/values/impact_N "$evaluations" /cases/2/out/F_gen_N 1e-3 relative
near "RMS of S01, normal, m/s2" /load_cases/0/rms_normal_m_per_s2 "$evaluations" /cases/2/out/rms_n 1e-3 relative
near "RMS of S01, transverse, m/s2" /load_cases/0/rms_transverse_m_per_s2 "$evaluations" /cases/2/out/rms_t 1e-3 relative
near "RMS of S01, rotational, m/s2" /load_cases/0/rms_rotational_m_per_s2 "$evaluations" /cases/2/out/rms_rot 1e-3 relative
near "mean tangent stiffness, N/um" /load_cases/0/left/mean_tangent_N_per_um "$evaluations" /cases/2/ends/kt/0 1e-3 relative
grep -q '"id": "S01"' "$evaluations"
result $? "the reference of these numbers is case S01"
"$EASEOFF" example paper-case-a | sed '1s/{/{'"$closed"',/' >"$folder/design.json"
"$EASEOFF" stage evaluation "$folder/design.json" >"$folder/out" 2>"$folder/err"
result $? "the stage takes a whole design as its input"
one=$("$EASEOFF" stage evaluation "$folder/design.json" | cksum)
[ "$one" = "$(cksum <"$folder/out")" ]
result $? "a second run gives the same bytes"

# ---- wrong input ----

valid() # NAME: what follows the gear pair
{
  case $1 in
  modification | surface) echo '"s_mm":[0]' ;;
  gap | tca) echo '"phase_mm":[0]' ;;
  flexibility) echo "$elements" ;;
  contact | impact) echo "$closed,\"torque_Nm\":[828]" ;;
  root-stress) echo "$elements,\"torque_Nm\":[828]" ;;
  iso6336) echo '"torque_Nm":828' ;;
  evaluation) echo "$closed,\"load_cases\":[{\"torque_Nm\":828,\"speed_rpm\":2000}]" ;;
  esac
}
for name in modification surface gap tca flexibility contact impact root-stress iso6336 evaluation; do
  rest=$(valid $name)
  refuses 1 $name "{$pair,$rest,\"frobnicate\":1}" "/frobnicate: Unknown key"
  refuses 1 $name "{\"gear_pair\":{$(echo "$gear" | sed 's/"pinion_teeth":17/"pinion_teeth":"17"/')},$rest}" "/gear_pair/pinion_teeth: Must be a number, not a string"
  refuses 1 $name "{\"gear_pair\":{$(echo "$gear" | sed 's/"face_width_mm":55/"face_width_mm":0/')},$rest}" "/gear_pair/face_width_mm: 0 is outside"
  refuses 1 $name "{\"gear_pair\":{$(echo "$gear" | sed 's/"pinion_teeth":17/"tip_alteration_coefficient":0,"pinion_teeth":9/')},$rest}" "undercut"
done
for name in modification surface gap tca contact impact evaluation; do
  refuses 1 $name "{$pair,$(valid $name),\"modification\":{\"pinion\":{\"left\":{\"tip_relief_um\":10,\"tip_relief_start_mm\":9}}}}" \
    "/modification/pinion/left/tip_relief_start_mm: 9 mm is not inside"
done
refuses 1 hertz '{"relative_radius_mm":16,"depth_mm":[5,-5],"line_load_N_per_mm":[1]}' "/depth_mm/1: -5 is outside"
refuses 1 modification "{$pair}" "/s_mm: At least one place"
refuses 1 modification "{$pair,\"s_mm\":[1],\"u_mm\":[1]}" "/u_mm: .*not by both"
refuses 1 modification "{$pair,\"s_mm\":[1,2],\"eta_mm\":[1]}" "/eta_mm: 1 entries, but 2 in s_mm"
refuses 1 surface "{$pair,\"u_mm\":[1]}" "/v_mm: 0 entries, but 1 in u_mm"
refuses 1 gap "{$pair,\"s_mm\":[1]}" "/eta_mm: 0 entries"
refuses 1 gap "{\"gear_pair\":{\"ends\":1,$gear},\"end\":\"right\"}" "/end: The pair has one end"
refuses 1 tca "{$pair}" "/phase_mm: This key is required"
refuses 1 tca "{$pair,\"phase_mm\":[1e308]}" "/phase_mm/0: 1e+308 is outside"
refuses 1 contact "{$pair,$closed}" "/torque_Nm: At least one load"
refuses 1 contact "{$pair,$closed,\"torque_Nm\":[1],\"force_N\":[1]}" "/force_N: .*not by both"
refuses 1 contact "{$pair,$closed,\"torque_Nm\":[0]}" "/torque_Nm/0: 0 is outside"
refuses 1 contact "{$pair,$closed,\"torque_Nm\":[1],\"phase_mm\":[1,0]}" "/phase_mm: The phases must increase"
refuses 1 contact "{$pair,$closed,\"torque_Nm\":[1],\"phase_mm\":[0,19.2]}" "/phase_mm: .* within one base pitch"
refuses 1 contact "{$pair,\"kernel\":{\"closed_form\":{\"length_mm\":1}},\"torque_Nm\":[1]}" "/kernel/closed_form/compliance_um_per_N: This key is required"
refuses 1 contact "{$pair,$closed,\"torque_Nm\":[1],\"phase_mm\":[0],\"alignment\":{\"stagger\":0.5}}" "/alignment/stagger"
refuses 1 impact "{$pair,$closed,\"approach_um\":[1,2]}" "/approach_um: 2 entries"
refuses 1 impact "{$pair,$closed,\"approach_um\":[1],\"torque_Nm\":[1]}" "/approach_um: .*either"
refuses 1 impact "{$pair,$closed,\"torque_Nm\":[1],\"speed_rpm\":0}" "/speed_rpm: 0 is outside"
refuses 1 root-stress "{$pair,$closed,\"torque_Nm\":[1]}" "/kernel/closed_form"
refuses 1 root-stress "{$pair,\"points\":[{\"s_mm\":0,\"eta_mm\":0,\"force_N\":1}],\"torque_Nm\":[1]}" "/points: .*not by both"
refuses 1 root-stress "{$pair,\"points\":[{\"s_mm\":0,\"eta_mm\":0}]}" "/points/0/force_N: This key is required"
refuses 1 flexibility "{$pair,\"resolution\":{\"sector_teeth\":4}}" "/resolution/sector_teeth"
refuses 1 flexibility "{$pair,$elements,\"mesh\":{\"member\":\"gear\"}}" "/mesh/file: This key is required"
refuses 1 flexibility "{$pair,$elements,\"mesh\":{\"file\":\"$folder/x\",\"row\":7}}" "/mesh/row: The flank has rows 0 to 6"
refuses 1 objective "$(sed 's/"rms_m_per_s2":20/"rms_m_per_s2":-20/' "$folder/objective")" "/values/0/rms_m_per_s2: -20 is outside"
refuses 1 objective "$(sed 's/,"rms_m_per_s2":20//' "$folder/objective")" "/values/0/rms_m_per_s2: This key is required"
refuses 1 objective "$(sed 's/,{"speed_rpm":2000,"torque_Nm":1035,"share":0.3}//' "$folder/objective")" "/values: 3 rows, but 2 load cases"
refuses 1 objective "$(sed 's/,"share":0.3//' "$folder/objective")" "/load_cases: Either every load case"
refuses 1 evaluation "{$pair,$closed}" "/load_cases: This key is required"
refuses 1 evaluation "{$pair,$closed,\"load_cases\":[]}" "/load_cases: 0 entries"
refuses 1 evaluation "{$pair,$closed,\"load_cases\":[{\"torque_Nm\":1,\"speed_rpm\":1}],\"root_stress\":true}" "/root_stress"

for name in $("$EASEOFF" stage | cut -d' ' -f1); do
  "$EASEOFF" stage "$name" --help >"$folder/out" 2>"$folder/err"
  result $? "the stage $name has its help"
  prints "^usage: easeoff stage $name INPUT.json"
  prints "^Output:"
done

echo "1..$count"
exit $failed

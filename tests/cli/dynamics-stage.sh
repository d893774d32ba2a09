#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The stages dynamics and sdof from outside: the reference cases put together by hand, parameters derived from a gear pair, wrong input.
. "$(dirname "$0")/../support/stages.sh"
reference=$CASES/dynamics.json

refuses() # NAME INPUT TEXT: on one line of standard error
{
  printf '%s' "$2" | "$EASEOFF" stage "$1" - >"$folder/out" 2>"$folder/err"
  [ $? -eq 1 ] && [ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$3" "$folder/err"
  result $? "the stage $1 refuses its input and says $3"
}

scaled() # PLACE FACTOR: numbers of the reference as an array
{
  "$numbers" "$reference" "$1" | tr -d '[] ' | tr ',' '\n' | awk -v f="$2" '{ printf "%s%.15g", (NR > 1 ? "," : "["), $1 * f } END { printf "]" }'
}

one() { scaled "$1" "${2:-1}" | tr -d '[]'; }

# ---- the reference cases, parameters in SI ----

parameters='"params":{'
for key in Rp Rg beta mp mg Ip Ig kpy kgy kg1z kg2z kpz kgz cpy cgy cg1z cg2z cpz cgz cm tau eps_z; do
  parameters=$parameters'"'$key'":'$(one "/dynamics/0/params/$key")','
done
parameters=${parameters%,}'}'
fourier='"law":{"kind":"fourier","mean_N_per_um":'$(one /law_K1/k0 1e-6)',"cosine_N_per_um":'$(scaled /law_K1/a 1e-6)',"sine_N_per_um":'$(scaled /law_K1/b 1e-6)'}'
running='"torque_Nm":828,"speed_rpm":2000,"pinion_teeth":17,"damping_in_contact_only":false'

stage dynamics "{$parameters,$fourier,$running,\"harmonics\":40}"
prints '"outcome": "converged"'
for key in normal:rms_n transverse:rms_t rotational:rms_rot; do
  near "RMS ${key%:*}, m/s2" "/rms_m_per_s2/${key%:*}" "$reference" "/dynamics/0/expected/${key#*:}" 1e-4 relative
done
near "RMS of the mean of both ends, m/s2" /rms_pair_m_per_s2/normal_of_mean "$reference" /dynamics/0/expected/rms_meanLR 1e-4 relative
near "mean deflection of the left end, um" /deflection_mean_um "$reference" /dynamics/0/expected/X_mean 1e-5 relative 1e6
near "mean force, N" /mesh_force_mean_N "$reference" /dynamics/0/expected/F_mean 1e-5 relative
near "largest force, N" /mesh_force_max_N "$reference" /dynamics/0/expected/F_max 3e-4 relative
near "accelerations of the freedoms" /freedom_rms "$reference" /dynamics/0/expected/dof_acc_rms 2e-4 relative
near "first harmonic of the left end, um" /left/deflection_real_um/0 "$reference" /dynamics/0/expected/X_harm_left/0/0 1e-4 relative 1e6
near "first harmonic of the right end, imaginary part, um" /right/deflection_imaginary_um/0 "$reference" /dynamics/0/expected/X_harm_right/0/1 1e-3 relative 1e6
near "largest multiplier of the motion" /largest_multiplier "$reference" /dynamics/0/expected/max_floquet 1e-3 relative
near "eigenfrequencies of the pair, Hz" /eigenfrequencies_Hz "$reference" /eigen/0/freq_hz 1e-6 relative
near "damping ratios of the pair" /damping_ratios "$reference" /eigen/0/damping_ratio 2e-5 relative
"$numbers" "$folder/out" /power_supplied_W >"$folder/expected"
near "power that is dissipated, W" /power_dissipated_W "$folder/expected" "" 1e-6 relative
cp "$folder/out" "$folder/first"
stage dynamics "{$parameters,$fourier,$running,\"harmonics\":40,\"solver\":\"time_integration\"}"
near "RMS by time integration, m/s2" /rms_m_per_s2/normal "$folder/first" /rms_m_per_s2/normal 1e-4 relative
near "the state of time integration has the same multiplier" /largest_multiplier "$reference" /dynamics/0/expected/max_floquet 1e-3 relative

stage dynamics "{$parameters,$fourier,$running,\"harmonics\":96,\"impact\":{\"mode\":\"paper\",\"force_N\":[300,300],\"duration\":[0.1,0.1]}}"
near "RMS with impacts, m/s2" /rms_m_per_s2/normal "$reference" /dynamics/1/expected/rms_n 1e-4 relative

rows=
for i in 0 1 2 3 4 5 6 7 8 9 10 11 12 13; do
  rows=$rows'{"load_N":'$(one /table_T1/P/$i)',"Z_um":'$(scaled "/table_T1/Z/$i" 1e6)'},'
done
stage dynamics "{$parameters,\"law\":{\"kind\":\"table\",\"te_harmonics\":16,\"rows\":[${rows%,}]},$running,\"harmonics\":60}"
near "RMS under the table law" /rms_m_per_s2/normal "$reference" /dynamics/2/expected/rms_n 1e-4 relative

# ---- parameters of a gear pair; laws by columns ----

pair='"gear_pair":{"pinion_teeth":17,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55,"groove_width_mm":50,"gear_bore_mm":90}'
rig='"supports":{"pinion_bearing_stiffness_N_per_um":800,"gear_bearing_stiffness_N_per_um":1000,"gear_axial_stiffness_left_N_per_um":200,"gear_axial_stiffness_right_N_per_um":200}'
derived='"torque_Nm":828,"speed_rpm":2000'
stage dynamics "{$pair,$rig,$fourier,$derived}"
for key in Rp Rg beta mp mg Ip Ig kpz kgz cpy cgy cg1z cpz cgz; do
  near "$key of the paper pair" "/params/$key" "$reference" "/defaults/$key" 2e-4 relative
done

# A constant approach under a constant stiffness: no vibration, and the deflection is where the approach is. Tangent and secant agree.
flat='"Z_um":[7,7,7,7,7,7,7,7]'
stage dynamics "{$pair,\"law\":{\"kind\":\"tangent\",$flat,\"kt_N_per_um\":[1200,1200,1200,1200,1200,1200,1200,1200]},$derived}"
echo '[7,7]' >"$folder/expected"
near "deflection of a constant law, um" /deflection_mean_um "$folder/expected" "" 1e-9 relative
echo '[0,0]' >"$folder/expected"
near "vibration under a constant law, m/s2" /rms_m_per_s2/normal "$folder/expected" "" 1e-9
near "contact loss under a constant law" /contact_loss "$folder/expected" "" 0
stage dynamics "{$pair,\"law\":{\"kind\":\"secant\",$flat,\"datum_um\":2},$derived}"
echo '[1727.723918,1727.723918]' >"$folder/expected" # 8638.61959 N over 5 um
near "secant stiffness of the law, N/um" /mean_stiffness_N_per_um "$folder/expected" "" 1e-6 relative

# A staggered right end repeats the left one later; a prescribed float of the pinion loads the ends in opposite senses.
wavy='"law":{"kind":"tangent","Z_um":[7,7.2,7.3,7.2,7,6.8,6.7,6.8],"kt_N_per_um":[1200,1210,1220,1210,1200,1190,1180,1190],"te_harmonics":2}'
stage dynamics "{$pair,$wavy,$derived,\"stagger\":0.5}"
"$numbers" "$folder/out" /left/acceleration_m_per_s2 >"$folder/expected"
near "amplitudes of both ends are the same" /right/acceleration_m_per_s2 "$folder/expected" "" 1e-9
"$numbers" "$folder/out" /left/deflection_real_um/0 >"$folder/expected"
near "the first harmonic has the other sign" /right/deflection_real_um/0 "$folder/expected" "" 1e-6 relative -1
stage dynamics "{$pair,\"law\":{\"kind\":\"tangent\",$flat,\"kt_N_per_um\":[1200,1200,1200,1200,1200,1200,1200,1200]},$derived,\"axial_float_cosine_um\":[1]}"
"$numbers" "$folder/out" /left/deflection_real_um/0 >"$folder/expected"
near "a float loads the ends in turn" /right/deflection_real_um/0 "$folder/expected" "" 1e-9 relative -1
! grep -q '"normal": \[0, 0\]' "$folder/out"
result $? "a float makes the ends vibrate"

# One end; two different ends.
stage dynamics "{\"gear_pair\":{\"ends\":1,\"pinion_teeth\":20,\"gear_teeth\":30,\"normal_module_mm\":3,\"helix_angle_deg\":10,\"face_width_mm\":30},$wavy,$derived}"
prints '"right": null'
stage dynamics "{$pair,$wavy,\"law_right\":{\"kind\":\"tangent\",$flat,\"kt_N_per_um\":[1200,1200,1200,1200,1200,1200,1200,1200]},$derived}"
near "different ends are coupled through the groove" /params/kt_p "$reference" /torsional_coupling/kt_p 1e-3 relative

refuses dynamics "{$fourier,$running}" "Either params or gear_pair is needed"
refuses dynamics "{$pair,$parameters,$fourier,$running}" "not by both"
refuses dynamics "{$parameters,$fourier,\"torque_Nm\":828,\"speed_rpm\":2000}" "/pinion_teeth"
refuses dynamics "{$pair,$fourier,\"torque_Nm\":828,\"speed_rpm\":0}" "/speed_rpm: 0 is outside"
refuses dynamics "{$pair,$fourier,\"torque_Nm\":0,\"speed_rpm\":10}" "/torque_Nm: 0 is outside"
refuses dynamics "{$pair,$fourier,$derived,\"harmonics\":0}" "/harmonics: 0 is outside"
refuses dynamics "{$pair,\"law\":{$flat},$derived}" "/law/kt_N_per_um: Z_um and kt_N_per_um must be equally long"
refuses dynamics "{$pair,\"law\":{},$derived}" "/law/Z_um"
refuses dynamics "{$pair,\"law\":{\"kind\":\"fourier\"},$derived}" "/law/mean_N_per_um"
refuses dynamics "{$pair,\"law\":{\"kind\":\"table\",\"rows\":[]},$derived}" "/law/rows"
refuses dynamics "{$pair,\"law\":{\"kind\":\"fourier\",\"mean_N_per_um\":100,\"cosine_N_per_um\":[150]},$derived}" "positive"
refuses dynamics "{$pair,\"law\":{\"kind\":\"secant\",\"Z_um\":[7,1],\"datum_um\":2},$derived}" "."
refuses dynamics "$(printf '%s' "{$parameters,$fourier,$running}" | sed 's/"mp":[0-9.]*/"mp":0/')" "/params/mp: 0 is outside"
refuses dynamics "$(printf '%s' "{$parameters,$fourier,$running}" | sed 's/"kpy":[0-9.]*/"kpy":-1/')" "/params/kpy: -1 is outside"
refuses dynamics "{$pair,$fourier,$derived,\"impact\":{\"force_N\":[1,1]}}" "/impact/duration"

# ---- one degree of freedom ----

sdof='"damping_ratio":0.05,"mean_force":0.1,"alternating_force":0.05'
i=0
for start in low high low; do
  stage sdof "{$sdof,\"frequency\":$(one "/sdof/cases/$i/W"),\"start\":\"$start\",\"folds\":{}}"
  for key in mean rms peak_to_peak:pp amplitude/0:h1 largest_multiplier:max_floquet; do
    near "${key%:*} from the $start start" "/${key%:*}" "$reference" "/sdof/cases/$i/expected/${key#*:}" 1e-4 relative
  done
  near "contact loss from the $start start" /contact_loss "$reference" "/sdof/cases/$i/expected/contact_loss_fraction" 1e-3
  i=$((i + 1))
done
near "frequency where an upward sweep loses contact" /folds/contact_lost "$reference" /sdof/folds/A/up 2e-3
near "frequency where a downward sweep falls back" /folds/jump_down/0 "$reference" /sdof/folds/A/down 2e-3
# F_h W^2 = F_m |1 - W^2 + 2 i z W|: a quadratic in W^2.
awk 'BEGIN { z = 0.05; r = 0.5; a = r * r - 1; b = 2 - 4 * z * z; d = sqrt(b * b + 4 * a)
  printf "[%.12f,%.12f]", sqrt((-b + d) / (2 * a)), sqrt((-b - d) / (2 * a)) }' >"$folder/expected"
near "grazing frequencies of the oscillator" /grazing "$folder/expected" "" 1e-9 relative
stage sdof "{$sdof,\"frequency\":0.78,\"start\":\"state\",\"state\":$(scaled /sdof/cases/1/x0 1)}"
near "RMS from the state on the upper branch" /rms "$reference" /sdof/cases/1/expected/rms 1e-4 relative
prints '"folds": null'
refuses sdof "{$sdof}" "/frequency: This key is required"
refuses sdof '{"damping_ratio":-1,"mean_force":0.1,"frequency":1}' "/damping_ratio: -1 is outside"
refuses sdof "{$sdof,\"frequency\":1,\"folds\":{\"from\":2,\"to\":1}}" "/folds"

echo "1..$count"
exit $failed

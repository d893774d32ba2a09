#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The reference cases of the dynamics and of the optimizer through `easeoff verify`: every number within tolerance, wrong ones
# noticed, other files of the same kinds read.
. "$(dirname "$0")/../support/tap.sh"

verify() # STATUS WHAT FILE...
{
  wanted=$1 what=$2
  shift 2
  "$EASEOFF" verify "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  [ "$status" -eq "$wanted" ]
  result $? "$what: the program ends with $status, expected $wanted"
}

prints() # PATTERN
{
  grep -q -e "$1" "$folder/out"
  result $? "$what: the program prints $1"
}

checks() # LEAST: at least so many numbers are compared, each with a verdict in the document
{
  passed=$(grep -c '"pass": true' "$folder/out")
  [ "$passed" -ge "$1" ]
  result $? "$what: $passed numbers are within tolerance, at least $1 expected"
}

changed() # FILE FROM TO: a copy with one change, which must have taken place
{
  sed "$2" "$CASES/$1" >"$folder/$1"
  ! cmp -s "$CASES/$1" "$folder/$1"
  result $? "$1 is changed by $2"
}

refuses() # POINTER SENTENCE FILE: one line for each fault, no verdict on numbers
{
  verify 1 "$2" "$3"
  grep -q -e "^easeoff: .*$3: $1: $2" "$folder/err" && ! grep -q "within tolerance" "$folder/out"
  result $? "the program refuses the file at $1: $2"
}

verify 0 "dynamics" --json "$CASES/dynamics.json"
checks 260
verify 0 "optimizer" --json "$CASES/optimizer.json"
checks 250
verify 0 "both, for people" "$CASES/dynamics.json" "$CASES/optimizer.json"
prints "K1-828-impact-paper .* pass"
prints "SDOF-A-0.78-hi .* pass"
prints "sdof  *2 *folds.A.up .* pass"
prints "runs\[0\] .* pass"
prints "All [0-9]* checks are within tolerance"
[ "$(grep -c 'note:' "$folder/out")" -eq 0 ]
result $? "every key of the files is read"

verify 0 "flanks as made, pitch, coast flanks, apex offsets, unequal halves" --json "$CASES/deviations.json"
checks 2400
changed deviations.json 's/"twist_um":4.0/"twist_um":4.4/'
verify 1 "another twist" "$folder/deviations.json"
prints "N2 .* FAIL"
changed deviations.json 's/"flank_used":"coast"/"flank_used":"drive"/'
verify 1 "the other flank" "$folder/deviations.json"
prints "C1 .* FAIL"
changed deviations.json 's/"pinion_um":\[4.533/"pinion_um":[4.733/'
verify 1 "another tooth" "$folder/deviations.json"
prints "P3 .* FAIL"

verify 0 "gears as made, their statistics, closed forms" --json "$CASES/tolerance.json"
checks 1200
if [ ! "${SANITIZED-}" ]; then # the same code again, the longest here
  changed tolerance.json 's/"std":0.47972/"std":0.48012/'
  verify 1 "another standard deviation" "$folder/tolerance.json"
  prints "MC-H1 .* FAIL"
fi

verify 0 "encoder" --json "$CASES/encoder.json"
checks 28
verify 0 "encoder, for people" "$CASES/encoder.json"
prints "enc1_clean_unwrapped_deg.csv .* pass"
[ "$(grep -c 'note:' "$folder/out")" -eq 0 ]
result $? "every key of encoder.json is read"
cp "$CASES/enc1_clean_unwrapped_deg.csv" "$folder"
changed encoder.json 's/"rms_mesh_lines_H8": 24.64585/"rms_mesh_lines_H8": 24.71/'
verify 1 "a wrong RMS of a recording" "$folder/encoder.json"
changed encoder.json 's/"expected_findings": \[\]/"expected_findings": ["swapped"]/'
verify 1 "a finding that is not there" "$folder/encoder.json"
prints "finding swapped .*FAIL (1)"
awk -F, -v OFS=, 'NR > 1 { t = $2; $2 = $3; $3 = t } { print }' "$CASES/enc1_clean_unwrapped_deg.csv" >"$folder/enc1_clean_unwrapped_deg.csv"
verify 0 "channels swapped, said and set right" "$folder/encoder.json"

verify 0 "rating" --json "$CASES/rating.json"
checks 800
changed rating.json 's/"printed": 1.092,/"printed": 1.094,/'
verify 1 "a wrong dynamic factor" "$folder/rating.json"
prints "kv-nrel3 .*K_V.*FAIL (1)"
changed rating.json '0,/"quantity": "backlash"/ s/"quantity": "backlash"/"quantity": "micropitting"/'
refuses /rows/[0-9]*/quantity 'The quantity "micropitting" is not computed here' "$folder/rating.json"
changed rating.json '0,/"A_sn_mm"/ s/"A_sn_mm"/"A_sm_mm"/'
refuses /rows/[0-9]*/inputs/A_sm_mm "This key is not known here" "$folder/rating.json"

# An RMS that is off by 3e-4 is noticed, in both kinds of output.
changed dynamics.json 's/"rms_meanLR": 18.703694/"rms_meanLR": 18.71/'
verify 1 "a wrong RMS" "$folder/dynamics.json"
prints "K1-828 .*rms_meanLR.*FAIL (1)"
prints "^1 of "
changed optimizer.json 's/0.5660471698879699/0.5660471698879/'
verify 1 "a wrong draw" "$folder/optimizer.json"
prints "rng\[0\].*u01.*FAIL (1)"

# A case that cannot be computed fails alone, with its reason; what cannot be understood refuses the file, with its pointer.
changed dynamics.json '0,/"kpy": 800000000.0/! {0,/"kpy": 800000000.0/ s/"kpy": 800000000.0/"kpy": -1/}'
verify 1 "a spring that pushes" "$folder/dynamics.json"
prints "K1-828 .*computed at all.*FAIL"
prints "K1-828 could not be computed: "
prints "T1-828 .* pass"
changed dynamics.json '0,/"law": "K1"/ s/"law": "K1"/"law": "K99"/'
refuses /dynamics/0/law "There is no law_K99 and no table_K99 in the file" "$folder/dynamics.json"
changed optimizer.json 's/"fitness": "1\/(1+sum((x-c)^2)), c=\[0.3,0.6,0.45\]"/"fitnes": "1"/'
refuses /runs/0 'The key "fitness" is missing' "$folder/optimizer.json"
refuses /runs/0/fitnes "This key is not known here" "$folder/optimizer.json"
verify 1 "a refused file as a document" --json "$folder/optimizer.json"
prints '"pointer": "/runs/0/fitnes"'
prints '"pass": false'

# Another file of the kind, one end and no responses. Expected: m w^2 = k for the axial motions, the eigenvalues of the 4 by 4
# rest from numpy, and |1/(1 - W^2 + 2 i z W)| W^2.
cat >"$folder/single.json" <<'END'
{"kind": "dynamics", "source": "another",
 "sdof": {"cases": [{"id": "linear", "z": 0.05, "Fm": 10, "Fh": 1, "e": 0, "W": 0.5,
   "expected": {"mean": 11, "h1": 0.3326, "contact_loss_fraction": 0}}]},
 "eigen": [{"id": "one end", "km": [4e8], "params": {"ends": 1, "beta": 0, "Rp": 0.05, "Rg": 0.1, "mp": 5, "mg": 20, "Ip": 0.006, "Ig": 0.1,
   "kpy": 1e9, "kgy": 1e9, "kg1z": 1e8, "kg2z": 1e8, "kpz": 1e8, "kgz": 1e8, "cpy": 0, "cgy": 0, "cg1z": 0, "cg2z": 0, "cpz": 0, "cgz": 0, "cm": 0},
   "zero_modes": 1, "freq_hz": [355.881272, 711.762543, 1052.93839, 1745.31818, 3153.68302]}]}
END
verify 0 "another file" "$folder/single.json"
prints "linear  *3 .* pass"
prints "one end  *7 .* pass"
prints "checks: sdof 3, eigen 7"

# Whole gear bodies: a part of ring.json on a coarser mesh (`make check-slow` has all of it); nothing is read loosely.
cat >"$folder/ring.json" <<'END'
{"kind": "ring", "mesh": "14 layers, 8 rows on the active flank, 8 elements along the root",
 "macro": {"z": [17, 44], "mn": 6, "alpha_n_deg": 20, "beta_deg": 24, "ha": 1, "c": 0.25, "rho_f": 0.38, "x": [0, 0], "b": 55, "E": 206000, "nu": 0.3},
 "tolerances": {"line compliance of the tooth itself, mid face, rel": 0.02, "the same, face ends, rel": 0.03,
  "between teeth, rel of the largest value of that distance": 0.02, "harmonic parts, rel": 0.03, "mean LTE, k, k_tan, c, rel": 0.015,
  "PPLTE (32 positions)": "max(0.03 um, 6 %)", "PPLTE of the list of pairs (16 positions)": "max(0.06 um, 10 %)", "share": 0.01,
  "root stress, rel (9 root elements; ratios between supports 0.01)": 0.05},
 "points": {"points": [[-0.8, 0.0], [-0.8, 20.0]], "pinion_floating": {"1": [[0.10346, 0.13085], [0.04639, 0.22997]]}},
 "line": {"pinion": {"floating": {"tip": [0.059637, 0.077877, 0.046583], "coupling_mid_pitch": {"-1": 0.0043595, "1": 0.0047757},
  "part_of_harmonic_0_and_1_in_C_full_mid_pitch": {"0": 0.0018619, "1": 0.0057895}}}}}
END
verify 0 "whole bodies" "$folder/ring.json"
prints "points  *[0-9]* .* pass"
prints "line  *[0-9]* .* pass"
wrong() # FROM TO: what is said of a file with one change
{
  sed "$1" "$folder/ring.json" >"$folder/wrong.json"
  ! cmp -s "$folder/ring.json" "$folder/wrong.json"
  result $? "ring.json is changed by $1"
  verify "$2" "ring.json with $1" "$folder/wrong.json"
  grep -q -e "$3" "$folder/out" "$folder/err"
  result $? "the program says $3"
}
wrong 's/"0": 0.0018619/"0": 0.0028619/' 1 "line .*mid_pitch.0 .*FAIL (1)"
wrong 's/"mesh"/"mehs"/' 1 '/mehs: This block is not known'
wrong 's/pinion_floating/pinion_float3d/' 1 'does not have the support "float3d"'
wrong 's/"tip"/"tipp"/' 1 '/line/pinion/floating/tipp: This key is not known'
wrong 's/"share": 0.01/"share": "0.01"/' 1 '/tolerances/share: A number is expected'

echo "1..$count"
exit $failed

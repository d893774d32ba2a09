#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# easeoff design from outside: a terse design completed, what is assumed, what is said at its field, what is refused.
. "$(dirname "$0")/../support/tap.sh"

expect() # STATUS WHAT COMMAND...
{
  wanted=$1 what=$2
  shift 2
  "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  [ "$status" -eq "$wanted" ]
  result $? "$what: the program ends with $status, expected $wanted"
}

prints() # PATTERN
{
  grep -q -e "$1" "$folder/out"
  result $? "$what: the program prints $1"
}

says() # PATTERN: the one line on standard error
{
  grep -q -e "$1" "$folder/err" && [ ! -s "$folder/out" ]
  result $? "$what: the program says $1"
}

design() # FURTHER KEYS OF THE PAIR: a spur pair
{
  cat >"$folder/design.json" <<END
{"gear_pair": {"ends": 1, "pinion_teeth": 21, "gear_teeth": 53, "helix_angle_deg": 0, "face_width_mm": 50.8, $1},
 "load_cases": [{"power_kW": 20, "speed_rpm": 1500}]}
END
}

design '"normal_diametral_pitch_per_inch": 4'
expect 0 "a terse design" "$EASEOFF" design "$folder/design.json"
prints 'normal_module_mm  *6.35 '
prints 'centre_distance_mm  *234.95 '
prints '^assumed: not stated by the design'
prints '/gear_pair/backlash_um .*ISO/TR 10064-2'
prints '/alignment/shaft_angle_error_in_plane_deg  *0  *deg  *aligned'
prints '/supports/pinion_bearing_stiffness_N_per_um .*per metre of bearing seat'
prints '/modification/gear/left  *unmodified'
prints 'span_mm  *[0-9]'
! grep -q '/optimization\|/gear_pair/normal_module_mm' "$folder/out"
result $? "the list of assumptions has neither what is stated in another way nor what an analysis does not use"
expect 0 "a design in inches" "$EASEOFF" design "$folder/design.json" --units inch
prints 'centre_distance_in  *9.25  *in'
expect 0 "a design as a document in inches" "$EASEOFF" design "$folder/design.json" --units inch --json
prints '"centre_distance_in": 9.25,'
design '"normal_diametral_pitch_per_inch": 4, "gear_bore_in": 1.5'
expect 0 "a length in inches" "$EASEOFF" design "$folder/design.json" --complete
prints '"gear_bore_mm": 38.1'
design '"normal_diametral_pitch_per_inch": 4, "gear_bore_in": 1.5, "gear_bore_mm": 38'
expect 1 "a length in inches beside the same in mm" "$EASEOFF" design "$folder/design.json"
says 'gear_bore_in says the same as gear_bore_mm'
design '"normal_diametral_pitch_per_inch": 4, "gear_bore_in": 70'
expect 1 "a fault at a key in inches" "$EASEOFF" design "$folder/design.json"
says '/gear_pair/gear_bore_in'
design '"normal_diametral_pitch_per_inch": 4, "gear_bore_mm": 1778'
expect 1 "a fault where inches are asked for" "$EASEOFF" design "$folder/design.json" --units inch
says 'bore of 70 in'
design '"normal_diametral_pitch_per_inch": 4'
expect 1 "a design in furlongs" "$EASEOFF" design "$folder/design.json" --units furlong
expect 0 "a design as a document" "$EASEOFF" design "$folder/design.json" --json
prints '"assumed": \['
prints '"dimensions": {'
expect 0 "the completed design" "$EASEOFF" design "$folder/design.json" --complete
prints '"torque_Nm": 127.32395'
mv "$folder/out" "$folder/complete.json"
expect 0 "the completed design once more" "$EASEOFF" design "$folder/complete.json" --complete
cmp -s "$folder/out" "$folder/complete.json"
result $? "the completed design is complete"

# What can work is said at its field, with number and remedy; what cannot is refused there.
design '"normal_module_mm": 6.35, "centre_distance_mm": 238, "pinion_profile_shift": 0, "gear_profile_shift": 0'
expect 0 "a distance beyond the shifts" "$EASEOFF" design "$folder/design.json" --json
prints '"key": "/gear_pair/centre_distance_mm"'
prints 'profile shifts that sum to 0.5'
design '"normal_module_mm": 6.35, "centre_distance_mm": 238'
expect 0 "shifts of the distance" "$EASEOFF" design "$folder/design.json" --json
prints '"gear_profile_shift": 0.5'
design '"normal_module_mm": 6.35, "pinion_profile_shift": -0.4'
expect 0 "undercut below the active profile" "$EASEOFF" design "$folder/design.json"
prints 'undercut up to the radius .* From a profile shift of'
design '"normal_module_mm": 6.35, "centre_distance_mm": 233, "pinion_profile_shift": 0, "gear_profile_shift": 0'
expect 1 "a distance that jams" "$EASEOFF" design "$folder/design.json"
says '/gear_pair/centre_distance_mm: .* not positive: the teeth would jam'
design '"normal_module_mm": 6.35, "planets": 3'
expect 1 "a pair with planets" "$EASEOFF" design "$folder/design.json"
says '/gear_pair/planets: Planetary stages are not modelled'
expect 1 "an internal gear" sh -c "sed 's/53/-53/; s/, \"planets\": 3//' '$folder/design.json' | '$EASEOFF' design -"
says '/gear_pair/gear_teeth: -53 is outside 4 .. 2000. Internal gears'
expect 1 "a helix angle below 0" sh -c "sed 's/deg\": 0/deg\": -30/; s/, \"planets\": 3//' '$folder/design.json' | '$EASEOFF' design -"
says '/gear_pair/helix_angle_deg: -30 is outside .* gear_pair.hand'
printf '{"gear_pair": {"pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55}}' >"$folder/no-load.json"
expect 1 "a design without a load" "$EASEOFF" design "$folder/no-load.json"
says '/load_cases: This key is required'

# Settings of a search stop nothing but a search; the paper's pair with another module is still a pair.
"$EASEOFF" example paper | sed 's/"normal_module_mm": 6/"normal_module_mm": 5/' >"$folder/five.json"
expect 0 "the paper's pair with module 5" "$EASEOFF" design "$folder/five.json" --json
prints '"key": "/optimization/bounds/tip_relief_start_mm"'
expect 1 "a search with these bounds" "$EASEOFF" optimize "$folder/five.json" --data "$folder/data"
says '/optimization/bounds/tip_relief_start_mm: The bounds 0.3 .. 4.5 mm must increase'

# Version 1: its defaults, with a note.
printf '{"version": 1, %s' "$(cut -c2- "$folder/no-load.json")" >"$folder/first.json"
expect 0 "an older document" "$EASEOFF" design "$folder/first.json" --json
prints '"torque_Nm": 828'
prints 'is of version 1, whose defaults stand for what it leaves out'

# Without the variables that keep the libraries' threads away it starts itself again with them, so it has one thread while it reads.
mkfifo "$folder/pipe"
env -u OPENBLAS_NUM_THREADS -u OMP_THREAD_LIMIT "$EASEOFF" design "$folder/pipe" >"$folder/out" 2>"$folder/err" &
exec 3>"$folder/pipe"
set -- "/proc/$!/task"/*
tr '\0' '\n' <"/proc/$!/environ" | grep -qx OPENBLAS_NUM_THREADS=1 && [ $# -eq 1 ]
result $? "the program starts no thread but its own: $#"
exec 3>&-
wait

echo "1..$count"
exit $failed

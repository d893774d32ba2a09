#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The program from outside: exit status, one-line errors, output that is whole or missing.
. "$(dirname "$0")/../support/tap.sh"

# expect STATUS WHAT COMMAND...: the exit status, and what the two outputs must look like for it.
expect()
{
  wanted=$1 what=$2
  shift 2
  "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  good=1
  lines=$(wc -l <"$folder/err")
  if [ "$status" -eq "$wanted" ]; then
    if [ "$wanted" -eq 0 ]; then [ "$lines" -eq 0 ] && good=0; else [ "$lines" -ge 1 ] && good=0; fi
  fi
  result $good "$what: the program ends with $status, expected $wanted"
}

says() # TEXT: in the last command's standard error, on its only line
{
  [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$1" "$folder/err"
  result $? "$what: the program says \"$1\" on one line"
}

prints() # TEXT
{
  grep -q -e "$1" "$folder/out"
  result $? "$what: the program prints \"$1\""
}

with_input() # TEXT COMMAND...
{
  text=$1
  shift
  printf '%s' "$text" | "$@"
}

pair='"gear_pair":{"pinion_teeth":17,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55}'

expect 1 "a call without a command" "$EASEOFF"
says "a command is missing"
expect 1 "an unknown command" "$EASEOFF" frobnicate
says '"frobnicate"'
expect 0 "--help" "$EASEOFF" --help
prints "easeoff stage"
expect 0 "--version" "$EASEOFF" --version
prints '^easeoff [0-9]'
for command in example stage verify; do
  expect 0 "$command --help" "$EASEOFF" $command --help
  prints "usage: easeoff $command"
  expect 1 "$command --nonsense" "$EASEOFF" $command --nonsense
  says "nonsense"
done

expect 0 "the list of examples" "$EASEOFF" example
for name in $("$EASEOFF" example | cut -d' ' -f1); do
  expect 0 "example $name" "$EASEOFF" example "$name"
  prints '"gear_pair"'
  cp "$folder/out" "$folder/$name.json"
  expect 0 "the geometry of example $name" "$EASEOFF" stage geometry "$folder/$name.json"
  prints '"transverse_contact_ratio"'
done
[ -s "$folder/paper-case-b.json" ] && [ -s "$folder/narrow.json" ] && [ -s "$folder/shifted.json" ] && [ -s "$folder/single.json" ]
result $? "the expected examples are there"
expect 1 "an unknown example" "$EASEOFF" example nothing
says '"nothing"'
expect 1 "two examples at once" "$EASEOFF" example paper paper
says "too many"

expect 0 "the list of stages" "$EASEOFF" stage
for name in $("$EASEOFF" stage | cut -d' ' -f1); do
  expect 0 "stage $name --help" "$EASEOFF" stage "$name" --help
  prints "^Output"
  expect 1 "stage $name without input" "$EASEOFF" stage "$name"
  says "missing"
done
expect 1 "an unknown stage" "$EASEOFF" stage nothing "$folder/paper.json"
says '"nothing"'

expect 0 "a pair from standard input" with_input "{$pair}" "$EASEOFF" stage geometry -
prints '"centre_distance_mm": 200.31843896660'
expect 0 "the stage of ISO 6336" with_input "{$pair,\"torque_Nm\":828}" "$EASEOFF" stage iso6336 -
prints '"stress_MPa": 49.7341566'
expect 0 "the stage of Hertz" with_input '{"relative_radius_mm":16.12867283833958,"depth_mm":[4.962547388247722,5.061266958175089],"line_load_N_per_mm":[1,300]}' "$EASEOFF" stage hertz -
prints '"approach_um": \[0.0359852745965[0-9]*, 5.983439605768'

expect 1 "a missing file" "$EASEOFF" stage geometry "$folder/none.json"
says "cannot be opened"
expect 1 "a folder" "$EASEOFF" stage geometry "$folder"
expect 1 "an empty file" "$EASEOFF" stage geometry /dev/null
says "Line 1"
expect 1 "a syntax error" with_input '{"gear_pair": {
"pinion_teeth": 17,,' "$EASEOFF" stage geometry -
says "Line 2, column 20"
expect 1 "a duplicate key" with_input '{"gear_pair":{"ends":2,"ends":1}}' "$EASEOFF" stage geometry -
says "duplicate object key"
expect 1 "an unknown key" with_input "{$pair,\"gear_pear\":1}" "$EASEOFF" stage geometry -
says '/gear_pear: Unknown key; did you mean "gear_pair"'
expect 1 "a key in the wrong place" with_input "{$pair,\"pinion_teeth\":17}" "$EASEOFF" stage geometry -
says '/pinion_teeth: Unknown key in .*; it stands at gear_pair/pinion_teeth'
expect 1 "a string for a number" with_input '{"gear_pair":{"pinion_teeth":"17","gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55}}' "$EASEOFF" stage geometry -
says '/gear_pair/pinion_teeth: Must be a number, not a string'
expect 1 "a number of 1e999" with_input '{"gear_pair":{"pinion_teeth":1e999}}' "$EASEOFF" stage geometry -
says 'overflow'
expect 1 "a module of 1e308" with_input '{"gear_pair":{"pinion_teeth":17,"gear_teeth":44,"normal_module_mm":1e308,"helix_angle_deg":24,"face_width_mm":55}}' "$EASEOFF" stage geometry -
says '/gear_pair/normal_module_mm: 1e+308 is outside 0.1 .. 100 mm'
expect 1 "a face width of 0" with_input '{"gear_pair":{"pinion_teeth":17,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":0}}' "$EASEOFF" stage geometry -
says '/gear_pair/face_width_mm: 0 is outside'
expect 0 "an undercut pinion, whose gear is shortened" with_input '{"gear_pair":{"pinion_teeth":9,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55}}' "$EASEOFF" stage geometry -
prints '"form_radius_mm": \[27.5528805'
expect 1 "an undercut pinion and a gear that is not" with_input '{"gear_pair":{"pinion_teeth":9,"gear_teeth":44,"normal_module_mm":6,"helix_angle_deg":24,"face_width_mm":55,"tip_alteration_coefficient":0}}' "$EASEOFF" stage geometry -
says '/gear_pair/pinion_profile_shift: .*undercut'
expect 1 "a document with several faults" with_input '{"gear_pair":{"pinion_teeth":1,"x":1}}' "$EASEOFF" stage geometry -
[ "$(wc -l <"$folder/err")" -eq 6 ]
result $? "six faults have one line each"
head -c 10485760 /dev/zero | tr '\0' '[' >"$folder/brackets.json"
expect 1 "10 MB of brackets" "$EASEOFF" stage geometry "$folder/brackets.json"
says "brackets within brackets"
printf '{"gear_pair": "\342\202' >"$folder/utf8.json"
expect 1 "truncated UTF-8" "$EASEOFF" stage geometry "$folder/utf8.json"
says "Line 1"

# The blocks that prepare gears are computed by verify/chain; here they are commentary.
sed 's/"load_distribution_closed_form"/"reference_distribution"/; s/"integer_overlap"/"reference_overlap"/' \
  "$CASES/standards.json" >"$folder/standards.json"
expect 0 "verify standards" "$EASEOFF" verify "$folder/standards.json"
prints "within tolerance"
expect 0 "verify --json" "$EASEOFF" verify --json "$folder/standards.json"
prints '"pass": true'
sed 's/"c_prime": 13.832/"c_prime": 13.862/' "$folder/standards.json" >"$folder/wrong.json"
expect 1 "a number out of tolerance" sh -c "\"$EASEOFF\" verify \"$folder/wrong.json\"; status=\$?; echo >&2; exit \$status"
prints "FAIL (1)"
prints "1 of [0-9]* checks are out of tolerance"
expect 1 "an unknown kind" with_input '{"kind":"gears"}' "$EASEOFF" verify -
says '"gears" is not a kind'
expect 1 "a file without a kind" with_input '{}' "$EASEOFF" verify -
expect 1 "verify without a file" "$EASEOFF" verify
expect 1 "a block that cannot be computed" sh -c "echo '{\"kind\":\"standards\",\"fzg_x\":{\"z\":[16,24],\"mn_mm\":4.5,\"a_mm\":80,\"r_a_mm\":[41,59],\"p_b_mm\":13}}' | \"$EASEOFF\" verify -; status=\$?; echo >&2; exit \$status"
prints "could not be computed"

if [ -w /dev/full ]; then
  for arguments in "example paper" "--help" "--version" "stage geometry $folder/paper.json" "verify $folder/standards.json"; do
    expect 2 "$arguments on a full disk" sh -c "\"$EASEOFF\" $arguments >/dev/full"
    says "No space left"
  done
fi
expect 2 "a closed output" sh -c "\"$EASEOFF\" example paper >&-"
says "cannot be written"
one=$("$EASEOFF" stage iso6336 "$folder/shifted.json" | cksum)
two=$("$EASEOFF" stage iso6336 "$folder/shifted.json" | cksum)
[ "$one" = "$two" ]
result $? "a second run gives the same bytes"

echo "1..$count"
exit $failed

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Files of other programs in and out, from outside: reference cases, what is told, hostile files.
. "$(dirname "$0")/../support/tap.sh"

files=$CASES/exchange

run() # STATUS WHAT COMMAND...
{
  wanted=$1 what=$2
  shift 2
  "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  [ "$status" -eq "$wanted" ]
  result $? "$what: the program ends with $status, expected $wanted"
}

says() # TEXT
{
  grep -qF -e "$1" "$folder/err"
  result $? "$what: the program says \"$1\""
}

prints() # TEXT
{
  grep -qF -e "$1" "$folder/out"
  result $? "$what: the program prints \"$1\""
}

# Every case: pairs, design, what is assumed, refused and not used, faults.
run 0 "the reference cases" "$EASEOFF" verify "$files/cases.json"
prints "checks are within tolerance"
mkdir "$folder/changed"
cp "$files"/* "$folder/changed"
sed 's/"tip_relief_start_mm": 1.45/"tip_relief_start_mm": 1.450001/' "$files/cases.json" >"$folder/changed/cases.json"
run 1 "a wrong start of relief" "$EASEOFF" verify "$folder/changed/cases.json"
prints "FAIL (1)"
sed 's/"gear_casing 2"/"gear_casing 3"/' "$files/cases.json" >"$folder/changed/cases.json"
run 1 "a wrong name of what is not used" "$EASEOFF" verify "$folder/changed/cases.json"

# A model becomes a design that can be analysed as it is.
run 0 "a model of one pair" "$EASEOFF" import "$files/paper-case-b-1.7.rexs" -o "$folder/design.json"
says "not used: gear_casing 2"
run 0 "the imported design" "$EASEOFF" export "$folder/design.json" --format design
prints '"tip_relief_start_mm": 1.31'
run 0 "a model through a pipe" "$EASEOFF" import - <"$files/paper-case-b-2.0.0.rexsj"
prints '"pinion_teeth": 17'

# Several pairs: listed, chosen by number; what does not exist is refused.
run 1 "several pairs without a choice" "$EASEOFF" import "$files/two-stage-1.5.rexs"
says "pair 2: stages 22 and 23"
says "double helical"
says "choose one by its number (--pair N)"
run 0 "a pair by its number" "$EASEOFF" import "$files/two-stage-1.5.rexs" --pair 3
prints '"pinion_teeth": 47'
run 1 "a pair that is not there" "$EASEOFF" import "$files/two-stage-1.5.rexs" --pair 4
says "There is no pair 4"
run 1 "a pair that is no number" "$EASEOFF" import "$files/two-stage-1.5.rexs" --pair two
run 1 "a flank that is none" "$EASEOFF" import "$files/spur-1.0.rexs" --flank middle
run 0 "amounts in the transverse section" "$EASEOFF" import "$files/paper-case-b-1.7.rexs" --transverse
says "turned to the normal"
prints '"tip_relief_um": 12.0' # 13 um cos(beta_b), beta_b = 22.47 deg

# Faults: all at once, each with its place.
run 1 "a model with many faults" "$EASEOFF" import "$files/errors-1.6.rexs"
says 'line 268, column 7: cylindrical_gear 11: normal_module states the unit "inch"'
says "helix_angel"
sed 's/role="left"/role="left_flank"/' "$files/paper-case-b-1.7.rexs" >"$folder/role.rexs"
run 1 "a misspelt role, with which a flank would have no relief" "$EASEOFF" import "$folder/role.rexs"
says "line 20, column 5: Relation 5 (flank) names component 41 as left_flank, and none as left; its roles are: gear, left, right."
sed 's/ref id="41" role="left"/ref id="11" role="left"/' "$files/paper-case-b-1.7.rexs" >"$folder/swapped.rexs"
run 1 "a gear where a flank is needed" "$EASEOFF" import "$folder/swapped.rexs"
says "names component 11, of type cylindrical_gear, as left; what stands there is: cylindrical_gear_flank."
sed 's/type="reference"/type="references"/' "$files/paper-case-b-1.7.rexs" >"$folder/relation.rexs"
run 0 "a misspelt relation" "$EASEOFF" import "$folder/relation.rexs"
says "not used: tip_relief 81, which no relation that is read holds"
sed 's/type="flank"/type="flanks"/' "$files/paper-case-b-1.7.rexs" >"$folder/relation.rexs"
run 0 "a misspelt relation of flanks" "$EASEOFF" import "$folder/relation.rexs"
says "not used: cylindrical_gear_flank 41, which no relation that is read holds"
run 1 "a model that is cut off" "$EASEOFF" import "$files/not-xml.rexs"
says "line 4, column 1: The XML is not well-formed"
run 1 "a document type" "$EASEOFF" import "$files/entity.rexs"
says "document type"
run 1 "a document type in a workbook" "$EASEOFF" import "$files/entity.xlsx"
says "A part of the workbook has a document type"
run 0 "an OpenDocument spreadsheet" "$EASEOFF" import "$files/pair.ods"
prints '"normal_module_mm": 4.5'
prints '"tip_relief_um": 12.5'
run 1 "faults as a document" "$EASEOFF" import "$files/errors-1.6.rexs" --json
prints '"kind": "not_a_boolean"'
prints '"design": null'

# Out and in again: models, tables, several designs in one table.
for format in rexs rexs-json rexs-zip rexs-2.0.0 rexs-2.0.0-json table table-comma table-rows workbook; do
  run 0 "export as $format" "$EASEOFF" export "$folder/design.json" --format "$format" -o "$folder/file"
  run 0 "import of $format" "$EASEOFF" import "$folder/file" -o "$folder/back.json"
  "$EASEOFF" export "$folder/design.json" --format design >"$folder/one"
  "$EASEOFF" export "$folder/back.json" --format design >"$folder/two"
  cmp -s "$folder/one" "$folder/two"
  result $? "$format brings back the same design"
done
# A grid of a hundred and fifty numbers in one cell of a sheet; spur teeth on two ends.
awk 'BEGIN { printf "{\"gear_pair\":{\"ends\":2,\"pinion_teeth\":23,\"gear_teeth\":61,\"normal_module_mm\":4,"
  printf "\"helix_angle_deg\":0,\"face_width_mm\":40,\"groove_width_mm\":20},\"load_cases\":[{\"torque_Nm\":300,\"speed_rpm\":1500}],"
  printf "\"modification\":{\"pinion\":{\"left\":{\"grid\":{\"u_mm\":["
  for (i = 0; i < 10; i++) printf "%s%d", i ? "," : "", i - 5
  printf "],\"y_mm\":["
  for (k = 0; k < 15; k++) printf "%s%d", k ? "," : "", k * 2 - 14
  printf "],\"delta_um\":["
  for (i = 0; i < 10; i++)
    for (k = 0; k < 15; k++) printf "%s%.15g%s", k ? "," : i ? ",[" : "[", sin(i * 15 + k), k == 14 ? "]" : ""
  print "]}}}}}" }' >"$folder/grid.json"
run 0 "a spur pair with two ends and a grid" "$EASEOFF" export "$folder/grid.json" --format design
cp "$folder/out" "$folder/one"
for format in rexs rexs-json table table-rows workbook; do
  "$EASEOFF" export "$folder/grid.json" --format "$format" -o "$folder/file"
  run 0 "import of $format with a grid" "$EASEOFF" import "$folder/file" -o "$folder/back.json"
  "$EASEOFF" export "$folder/back.json" --format design >"$folder/two"
  cmp -s "$folder/one" "$folder/two"
  result $? "$format brings back the same design with a grid"
done
"$EASEOFF" example single >"$folder/single.json"
run 0 "two designs in one table" "$EASEOFF" export "$folder/design.json" "$folder/single.json" --format table -o "$folder/two.csv"
run 0 "the second of them" "$EASEOFF" import "$folder/two.csv" --pair 2
prints '"ends": 1'
run 1 "two designs in one model" "$EASEOFF" export "$folder/design.json" "$folder/single.json" --format rexs
says "takes one design"
run 0 "what exists in place of GDE" "$EASEOFF" export --help
prints "GDE"
prints "(-x, all mirrored, where the pinion turns clockwise"
run 0 "a tooth for CAD" "$EASEOFF" export "$folder/design.json" --format step-gear
prints "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"
test ! -s "$folder/err"
result $? "an exported tooth leaves nothing to say about it"
echo '{"gear_pair": {"pinion_teeth": 23, "gear_teeth": 61, "normal_module_mm": 5, "helix_angle_deg": 26, "face_width_mm": 60},
  "load_cases": [{"torque_Nm": 500, "speed_rpm": 1500}], "modification": {"pinion": {"left": {"root_relief_um": 400,
  "root_relief_start_mm": 3.5, "root_relief_shape": "exponent", "root_relief_exponent": 1.2}}}}' >"$folder/folded.json"
run 0 "a flank that its relief folds" "$EASEOFF" export "$folder/folded.json" --format step-pinion
says "drive flank of the left end, where reliefs fold it: up to "

# Drawing data of a pair: symbols, units, values to six digits and more.
run 0 "dimensions as a table" "$EASEOFF" export "$folder/single.json" --format dimensions
prints "member,quantity,symbol,unit,at,value,note"
prints "pinion,reference diameter,d,mm,,97.24933335," # 31 * 3 mm / cos(17 deg)
for symbol in s_n,mm s_c,mm W_k,mm M_dK,mm M_dR,mm d_Ff,mm A_sn,um; do
  prints ",$symbol,upper allowance,"
  prints ",$symbol,lower allowance,"
done
for symbol in j_bn j_wt j_r; do
  prints ",$symbol,um,smallest,"
done
run 0 "ISO 1328-1 as a table" "$EASEOFF" export "$folder/single.json" --format tolerances
prints "pinion,ISO 1328-1:"
prints ",f_Halpha,"
run 0 "points in inches" "$EASEOFF" export "$folder/single.json" --format topography --units inch
prints "member,end,radius_in,roll_angle_deg,face_in,modification_thou,flank"
run 1 "a model in inches" "$EASEOFF" export "$folder/single.json" --format rexs --units inch
says "--units inch is for tables of columns"
run 1 "dimensions have no rows to choose" "$EASEOFF" export "$folder/single.json" --format dimensions --rows 5
says "has no rows and columns"

# A member beside its mate's middle.
sed 's/\(u_coordinate_on_shaft" unit="mm">\)61/\160.5/; s/60\.5\.0/60.5/' "$files/single-shifted-1.6.rexs" >"$folder/beside.rexs"
run 0 "a member off its mate's middle" "$EASEOFF" import "$folder/beside.rexs"
says "cylindrical_gear 11, 44 mm: it stands out 0.5 mm to the left and 1.5 mm to the right of the common 42 mm"

# Where only one end of a pair is off, the other has nothing that stands out.
"$EASEOFF" example paper >"$folder/paper.json"
"$EASEOFF" export "$folder/paper.json" --format rexs | awk '/<component id="12"/ { on = 1 } on && /u_coordinate_on_shaft/ { match($0, />[0-9.]+/)
  $0 = substr($0, 1, RSTART) (substr($0, RSTART + 1, RLENGTH - 1) + 0.05) substr($0, RSTART + RLENGTH); on = 0 } { print }' |
  sed '/custom_easeoff_design/d' >"$folder/gap.rexs"
run 0 "a groove that is wider on one shaft" "$EASEOFF" import "$folder/gap.rexs"
says "it stands out 0 mm to the left and 0.05 mm to the right"
! grep -q "0 mm to the left and 0 mm to the right" "$folder/err"
result $? "a gear that does not stand out is not refused"

# Hostile files: a sentence, at once.
deep=$(printf '<model version="1.7">'; seq 1 200 | sed 's/.*/<a>/' | tr -d '\n')
printf '%s' "$deep" >"$folder/deep.rexs"
run 1 "elements without end" "$EASEOFF" import "$folder/deep.rexs"
says "more than 16 deep"
awk 'BEGIN { print "<model version=\"1.7\"><components><component id=\"1\" type=\"gear_unit\">"; for (i = 0; i < 200001; i++) print "<attribute id=\"a\"/>" }' >"$folder/many.rexs"
run 1 "attributes without end" "$EASEOFF" import "$folder/many.rexs"
says "more than 200000 attributes"
printf '{"model":{"version":"1.7","components":[{"id":1e99}]}}' >"$folder/id.rexsj"
run 1 "an id without end" "$EASEOFF" import "$folder/id.rexsj"
printf '{"model":{"version":"1.7","relations":[{"id":1,"type":"stage","refs":[{"id":5,"role":"stage"}]}]}}' >"$folder/lost.rexsj"
run 1 "a relation to nothing" "$EASEOFF" import "$folder/lost.rexsj"
says "/model/relations/0: Relation 1 (stage) names component 5 as stage"
run 1 "a file that is not there" "$EASEOFF" import "$folder/nothing.rexs"
printf '' >"$folder/empty.rexs"
run 1 "an empty file" "$EASEOFF" import "$folder/empty.rexs"

echo "1..$count"
exit $failed

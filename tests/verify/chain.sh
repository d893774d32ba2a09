#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The reference cases of the whole chain through `easeoff verify`: standards, contact, CalculiX, evaluation.
: "${EASEOFF:=./easeoff}" "${CASES:=tests/cases}"
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
count=0 failed=0

result() # status, what
{
  count=$((count + 1))
  if [ "$1" -eq 0 ]; then echo "ok $count - $2"; else
    failed=1
    echo "not ok $count - $2"
    sed 's/^/# /' "$folder/out" "$folder/err" | head -40
  fi
}

for kind in standards contact calculix evaluation; do
  "$EASEOFF" verify "$CASES/$kind.json" >"$folder/out" 2>"$folder/err"
  result $? "$kind has every number within its tolerance"
done

# A wrong expectation is noticed, and a file of another gear pair runs unchanged.
sed 's/"PPLTE_um": 0.631383/"PPLTE_um": 0.66/' "$CASES/evaluation.json" >"$folder/evaluation.json"
! cmp -s "$CASES/evaluation.json" "$folder/evaluation.json"
result $? "evaluation.json is changed"
"$EASEOFF" verify "$folder/evaluation.json" >"$folder/out" 2>"$folder/err"
[ $? -eq 1 ] && grep -q 'S01 .*FAIL' "$folder/out"
result $? "a wrong PPLTE is noticed"

# So is a wrong root stress of one pair of teeth, and a place of the face where it is not.
for change in 's/50.3908,/60.3908,/' '/50.3908,/{n;s/9.1667/-22.9/}'; do
  sed "$change" "$CASES/calculix.json" >"$folder/calculix.json"
  ! cmp -s "$CASES/calculix.json" "$folder/calculix.json"
  result $? "calculix.json is changed by $change"
  "$EASEOFF" verify "$folder/calculix.json" >"$folder/out" 2>"$folder/err"
  [ $? -eq 1 ] && grep -q 'root_pinion_MPa_at_prescribed_Z.2.396.*FAIL' "$folder/out"
  result $? "the change by $change is noticed"
done

echo "1..$count"
exit $failed

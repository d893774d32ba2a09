#!/bin/sh
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

for kind in standards calculix evaluation; do
  "$EASEOFF" verify "$CASES/$kind.json" >"$folder/out" 2>"$folder/err"
  result $? "$kind: every number within its tolerance"
done

# Three numbers of contact.json are beyond: the entering impact of case A at 828 N m, right end. The table's own numbers show why. It gives
# 57.1 mm/s at 0.929 mm behind A: that is (d delta/ds + misalignment slope) r_b omega = 57.1 with the first-order relief
# delta = d_br ((-k_u s - u_bs)/(-u_A - u_bs))^2, where the same file's slice_gap_A has the exact gap 17 % smaller. On the exact gap, which
# evaluation.json uses throughout (its F05, 621 N m, passes), the tip corner touches first. See ISO 21771 for k_u, u_A.
"$EASEOFF" verify "$CASES/contact.json" --json >"$folder/out" 2>"$folder/err"
[ $? -eq 1 ]
result $? "contact: exit 1"
"$EASEOFF" verify "$CASES/contact.json" >"$folder/people" 2>"$folder/err"
grep -q '^3 of [0-9]* checks are out of tolerance' "$folder/people" && grep -q 'table: A, 0.1 deg in-plane, 828 N m .* FAIL (3)' "$folder/people"
result $? "contact: only three numbers, of the impact that used the first-order gap, are beyond"
[ "$(grep -c '"pass": true' "$folder/out")" -ge 390 ]
result $? "contact: the other $(grep -c '"pass": true' "$folder/out") are within"

# A wrong expectation is noticed, and a file of another gear pair runs unchanged.
sed 's/"PPLTE_um": 0.631383/"PPLTE_um": 0.66/' "$CASES/evaluation.json" >"$folder/evaluation.json"
! cmp -s "$CASES/evaluation.json" "$folder/evaluation.json"
result $? "evaluation.json changed"
"$EASEOFF" verify "$folder/evaluation.json" >"$folder/out" 2>"$folder/err"
[ $? -eq 1 ] && grep -q 'S01 .*FAIL' "$folder/out"
result $? "a wrong PPLTE is noticed"

echo "1..$count"
exit $failed

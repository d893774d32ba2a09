# What the tests of the stages share, read by them: result, stage, near, prints. EASEOFF: the program, CASES: the reference cases.
: "${EASEOFF:=./easeoff}" "${CASES:=tests/cases}"
numbers=$(dirname "$EASEOFF")/tests/json-numbers
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
count=0 failed=0

result() # condition-status, what
{
  count=$((count + 1))
  if [ "$1" -eq 0 ]; then echo "ok $count - $2"; else
    failed=1
    echo "not ok $count - $2"
    sed 's/^/# /' "$folder/err" | head -3
  fi
}

stage() # NAME INPUT: output in $folder/out
{
  printf '%s' "$2" | "$EASEOFF" stage "$1" - >"$folder/out" 2>"$folder/err"
  result $? "stage $1"
}

# near WHAT PLACE FILE PLACE TOLERANCE [KIND [FACTOR]]: see json-numbers.c.
near()
{
  what=$1
  shift
  verdict=$("$numbers" "$folder/out" "$@" 2>&1)
  result $? "$what: $verdict"
}

prints() # TEXT
{
  grep -q -e "$1" "$folder/out"
  result $? "prints $1"
}

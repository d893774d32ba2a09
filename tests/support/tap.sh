# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2034 # its readers use these variables
# What tests in shell share, read by them: EASEOFF, the program; CASES, the reference cases; numbers, json-numbers.c; a folder that goes with the
# test; result, which counts. A test ends with: echo "1..$count"; exit $failed
: "${EASEOFF:=./easeoff}" "${CASES:=tests/cases}"
numbers=$(dirname "$EASEOFF")/tests/support/json-numbers
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
count=0 failed=0

result() # condition-status, what
{
  count=$((count + 1))
  if [ "$1" -eq 0 ]; then echo "ok $count - $2"; else
    failed=1
    echo "not ok $count - $2"
    cat "$folder/err" "$folder/out" 2>/dev/null | sed 's/^/# /' | head -20
  fi
}

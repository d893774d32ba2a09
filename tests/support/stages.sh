# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# What the tests of the stages share, read by them: stage, near, prints, and tap.sh.
. "$(dirname "$0")/../support/tap.sh"

stage() # NAME INPUT: output in $folder/out
{
  printf '%s' "$2" | "$EASEOFF" stage "$1" - >"$folder/out" 2>"$folder/err"
  result $? "the stage $1 takes its input"
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
  result $? "the stage prints $1"
}

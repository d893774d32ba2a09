#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# optimize and history from outside: exit status, one-line errors, folders that cannot be written, full disks, files that are wrong.
. "$(dirname "$0")/../support/tap.sh"
mounted=
trap '[ -z "$mounted" ] || umount "$mounted"; chmod -R u+w "$folder"; rm -rf "$folder"' EXIT

expect() # STATUS WHAT COMMAND...
{
  wanted=$1 what=$2
  shift 2
  "$@" >"$folder/out" 2>"$folder/err"
  status=$?
  good=1
  lines=$(wc -l <"$folder/err")
  if [ "$status" -eq "$wanted" ]; then
    if [ "$wanted" -eq 0 ]; then [ "$lines" -eq 0 ] && good=0; else [ "$lines" -eq 1 ] && good=0; fi
  fi
  result $good "$what: the program ends with $status, expected $wanted; $(head -c 150 "$folder/err")"
}

says() # TEXT
{
  grep -q -e "$1" "$folder/err"
  result $? "$what: the program says \"$1\""
}

prints() # TEXT
{
  grep -q -e "$1" "$folder/out"
  result $? "$what: the program prints \"$1\""
}

skip() # WHAT
{
  count=$((count + 1))
  echo "ok $count - $1 # SKIP not possible here"
}

cat >"$folder/design.json" <<'DESIGN'
{ "version": 1, "name": "coarse", "gear_pair": { "pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55 },
  "alignment": { "shaft_angle_error_in_plane_deg": 0.1 }, "load_cases": [ { "torque_Nm": 828 } ],
  "optimization": { "true_evaluations": 40 },
  "resolution": { "positions": 16, "cells_per_line": 6, "sector_teeth": 3, "neighbour_coupling": false, "layers": 6, "flank_rows": 4,
    "fillet_elements": 6, "harmonics": 6, "te_harmonics": 6 } }
DESIGN
data="$folder/data"

expect 0 "a search" "$EASEOFF" optimize "$folder/design.json" --data "$data"
prints "pinion/both/tip_relief_um"
prints "40 true evaluations of 40 individuals"
cp "$folder/out" "$folder/first"
expect 0 "the same search once more" "$EASEOFF" optimize "$folder/design.json" --data "$data" --threads 1
prints "taken up, 0 evaluations computed"
expect 0 "the search as a document" "$EASEOFF" optimize - --data "$data" --json <"$folder/design.json"
prints '"pfc_percent": 100'
expect 0 "the list of searches" "$EASEOFF" history list --data "$data"
prints "credibility-ga *done *40"
expect 0 "the list of searches as a document" "$EASEOFF" history list --data "$data" --json
prints '"true_evaluations": 40'
expect 0 "a search that is shown" "$EASEOFF" history show 1 --data "$data"
grep -v -e '^Job' "$folder/out" >"$folder/a"
grep -v -e '^Job' "$folder/first" >"$folder/b"
cmp -s "$folder/a" "$folder/b"
result $? "the stored result shows what was printed"
expect 0 "the rows of a search" "$EASEOFF" history export 1 --data "$data"
[ "$(wc -l <"$folder/out")" -eq 42 ]
result $? "the CSV of the rows has a heading and 41 rows"
expect 0 "the path of a search" "$EASEOFF" history export --job 1 --data "$data"
[ "$(grep -c computed "$folder/out")" -eq 40 ]
result $? "the path of the search has 40 steps"
expect 0 "another algorithm" "$EASEOFF" optimize "$folder/design.json" --data "$data" --algorithm fpga --budget 60 --fresh
prints "^fpga: 60 true evaluations of"
expect 0 "pruning" "$EASEOFF" history prune --data "$data"
prints "^0 true rows and [1-9][0-9]* predictions removed"

expect 1 "an unknown algorithm" "$EASEOFF" optimize "$folder/design.json" --data "$data" --algorithm luck
says '"luck" is no algorithm'
expect 1 "a budget of nothing" "$EASEOFF" optimize "$folder/design.json" --data "$data" --budget 0
says '"0"'
expect 1 "threads in words" "$EASEOFF" optimize "$folder/design.json" --data "$data" --threads two
expect 1 "a job that is not there" "$EASEOFF" history show 99 --data "$data"
says "no job 99"
expect 1 "a problem that is not there" "$EASEOFF" history export 99 --data "$data"
expect 1 "a word for a number" "$EASEOFF" history show best --data "$data"
expect 1 "history without an action" "$EASEOFF" history
expect 1 "an unknown action" "$EASEOFF" history forget --data "$data"
expect 1 "a folder without a history" "$EASEOFF" history list --data "$folder/none"
says "no history"
[ ! -e "$folder/none" ]
result $? "a folder without a history is not made"
sed 's/"true_evaluations"/"bounds": { "tip_relief_um": [20, 10] }, "true_evaluations"/' "$folder/design.json" >"$folder/bad.json"
expect 1 "bounds that fall" "$EASEOFF" optimize "$folder/bad.json" --data "$data"
says "/optimization/bounds/tip_relief_um"
sed 's/"true_evaluations"/"bounds": { "tip_relief_start_mm": [1, 5.5] }, "true_evaluations"/' "$folder/design.json" >"$folder/bad.json"
expect 1 "bounds outside the flank" "$EASEOFF" optimize "$folder/bad.json" --data "$data"
says "/optimization/bounds/tip_relief_start_mm"

# Ctrl-C keeps the history and prints the best so far
sed 's/40 }/100000 }/' "$folder/design.json" >"$folder/long.json"
"$EASEOFF" optimize "$folder/long.json" --data "$data" --restart >"$folder/out" 2>"$folder/err" &
child=$!
sleep 2
kill -TERM $child # a background job of a script ignores SIGINT
wait $child
status=$?
[ $status -eq 0 ] && grep -q "stopped: cancelled" "$folder/out"
result $? "an interrupt ends with $status and the best so far"
expect 0 "the list after an interrupt" "$EASEOFF" history list --data "$data"
prints "credibility-ga *cancelled"

# a folder that cannot be written: root may write everywhere, so try as nobody
mkdir "$folder/closed"
cp "$data/easeoff.db" "$folder/closed/"
cp -r "$data/flexibility" "$folder/closed/"
chmod 755 "$folder"
chmod -R a+rX "$folder/closed"
chmod 555 "$folder/closed"
chmod 444 "$folder/closed/easeoff.db"
as_nobody=
if [ "$(id -u)" = 0 ]; then
  as_nobody="setpriv --reuid=65534 --regid=65534 --clear-groups"
  $as_nobody test -r "$folder/design.json" -a -x "$EASEOFF" 2>/dev/null || as_nobody=none
fi
if [ "$as_nobody" != none ]; then
  expect 2 "optimize in a folder that cannot be written" $as_nobody "$EASEOFF" optimize "$folder/design.json" --data "$folder/closed"
  says "cannot be written"
  expect 0 "the list in a folder that cannot be written" $as_nobody "$EASEOFF" history list --data "$folder/closed"
  prints "credibility-ga"
  expect 2 "pruning in a folder that cannot be written" $as_nobody "$EASEOFF" history prune --data "$folder/closed"
else
  skip "a folder that cannot be written"
fi

# files that are wrong
mkdir "$folder/wrong"
printf 'This is no database, and it is long enough to have been one once upon a time.........................' >"$folder/wrong/easeoff.db"
expect 2 "a file that is no database" "$EASEOFF" optimize "$folder/design.json" --data "$folder/wrong"
says "damaged"
cp "$data/easeoff.db" "$folder/wrong/easeoff.db"
printf '\000\000\000\143' | dd of="$folder/wrong/easeoff.db" bs=1 seek=60 conv=notrunc 2>/dev/null
expect 2 "a page whose check sum is another's" "$EASEOFF" optimize "$folder/design.json" --data "$folder/wrong"
says "damaged"
head -c 20000 "$data/easeoff.db" >"$folder/wrong/easeoff.db"
expect 2 "half a database" "$EASEOFF" optimize "$folder/design.json" --data "$folder/wrong"
expect 2 "half a database" "$EASEOFF" history list --data "$folder/wrong"

# a full disk: what was saved is kept, and is used when there is room again; the tables alone take 1 MB while they are made
mkdir "$folder/small"
if mount -t tmpfs -o size=2m none "$folder/small" 2>/dev/null; then
  mounted="$folder/small"
  full="$folder/small"
  limit=
else
  full="$folder/small"
  limit=4096 # blocks of 512 bytes
fi
fill()
{
  if [ -z "$limit" ]; then "$@"; else (trap '' XFSZ; ulimit -f "$limit"; exec "$@"); fi
}
sed 's/40 }/3000, "algorithm": "ga" }/' "$folder/design.json" >"$folder/many.json"
ln -s "$data/flexibility" "$full/flexibility"
expect 2 "a full disk" fill "$EASEOFF" optimize "$folder/many.json" --data "$full"
says "what was saved before is kept"
expect 0 "the history on a full disk" "$EASEOFF" history list --data "$full" --json
prints '"interrupted"'
rows=$(sed -n 's/.*"evaluations": \([0-9]*\),.*/\1/p' "$folder/out" | head -n 1)
[ "${rows:-0}" -gt 20 ]
result $? "the $rows rows are kept"
rm -f "$folder/wrong"/easeoff.db*
cp "$full"/easeoff.db* "$folder/wrong/"
sed "s/3000/$((rows + 20))/" "$folder/many.json" >"$folder/more.json"
expect 0 "a search with room again" "$EASEOFF" optimize "$folder/more.json" --data "$folder/wrong" --fresh
prints "$((rows - 1)) of them known from the history"

# two processes on one folder
mkdir "$folder/shared"
ln -s "$data/flexibility" "$folder/shared/flexibility"
sed 's/40 }/150 }/' "$folder/design.json" >"$folder/two.json"
"$EASEOFF" optimize "$folder/two.json" --data "$folder/shared" --fresh >"$folder/one" 2>"$folder/err" &
child=$!
"$EASEOFF" optimize "$folder/two.json" --data "$folder/shared" --fresh >"$folder/two" 2>>"$folder/err"
status=$?
wait $child || status=$?
grep -v -e '^Job' -e ' true evaluations' "$folder/one" >"$folder/a"
grep -v -e '^Job' -e ' true evaluations' "$folder/two" >"$folder/b"
[ $status -eq 0 ] && cmp -s "$folder/a" "$folder/b" && [ ! -s "$folder/err" ]
result $? "two processes on one folder give the same result"
"$EASEOFF" history export 1 --data "$folder/shared" >"$folder/out" 2>"$folder/err"
[ "$(wc -l <"$folder/out")" -eq 152 ]
result $? "two processes on one folder have each row once"

echo "1..$count"
exit $failed

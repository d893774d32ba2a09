#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# easeoff study from outside, on coarse pairs: what varies, the table, rows used again, a kill in the middle, and the same bytes from any number of
# threads and of MPI ranks (where mpirun is). Patterns with * are the program's, not the shell's.
. "${SOURCES:-.}/tests/support/tap.sh"
set -f
data=$folder/data
design=$folder/design.json

cat >"$design" <<'DESIGN'
{ "name": "coarse", "gear_pair": { "pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55 },
  "alignment": { "shaft_angle_error_in_plane_deg": 0.1 }, "load_cases": [ { "torque_Nm": 828, "speed_rpm": 2000 }, { "torque_Nm": 600, "speed_rpm": 2000 } ],
  "optimization": { "true_evaluations": 30 },
  "resolution": { "positions": 16, "cells_per_line": 6, "sector_teeth": 3, "neighbour_coupling": false, "layers": 6, "flank_rows": 4,
    "fillet_elements": 6, "harmonics": 6, "te_harmonics": 6 } }
DESIGN

study() # ARGUMENTS...: output in $folder/out
{
  "$EASEOFF" study "$@" >"$folder/out" 2>"$folder/err"
  result $? "easeoff study $* succeeds"
}

refuses() # TEXT ARGUMENTS...: on one line of standard error
{
  text=$1
  shift
  "$EASEOFF" study "$@" >"$folder/out" 2>"$folder/err"
  [ $? -eq 1 ] && [ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/err")" -eq 1 ] && grep -q -e "$text" "$folder/err"
  result $? "easeoff study $* is refused with $text"
}

prints() # TEXT
{
  grep -q -e "$1" "$folder/out"
  result $? "the study prints \"$1\""
}

same() # FILE FILE WHAT
{
  cmp "$1" "$2" >"$folder/err" 2>&1
  result $? "$3"
}

cell() # FILE ROW COLUMN-NAME
{
  awk -F, -v row="$2" -v name="$3" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } $1 == row && NR > 1 { print $at }' "$1"
}

# What varies.
relief='modification.pinion.*.tip_relief_um' crowning='modification.pinion.both.lead_crowning_um'
study "$design" --data "$data" --vary "$relief=0:20:3" --vary "$crowning=0,12" --csv "$folder/a.csv"
prints "6 of 6 variants, 0 known before, 6 computed now, 0 refused, 0 not converged"
[ "$(cut -d, -f 1-3 "$folder/a.csv" | tr '\n' ' ')" = "variant,$relief,$crowning 0,0,0 1,0,12 2,10,0 3,10,12 4,20,0 5,20,12 " ]
result $? "a full factorial varies the last key fastest"

# A row is what analyze says of its design.
ends='"left": { "tip_relief_um": 10, "lead_crowning_um": 12 }, "right": { "tip_relief_um": 10, "lead_crowning_um": 12 }'
sed "s/\"optimization\"/\"modification\": { \"pinion\": { $ends } }, \"optimization\"/" "$design" >"$folder/row.json"
"$EASEOFF" analyze "$folder/row.json" --data "$data" --json >"$folder/analysis" 2>"$folder/err"
for key in f1_um f2_N f3_m_per_s2 J; do
  [ "$(sed -n "s/.*\"$key\": \([-0-9.e+]*\),*/\1/p" "$folder/analysis" | head -n 1)" = "$(cell "$folder/a.csv" 3 objectives.$key)" ]
  result $? "$key of a row is that of the analysis"
done

# Rows of studies, and of searches, are used again.
study "$design" --data "$data" --vary "$relief=0:20:3" --vary "$crowning=0,6,12" --csv "$folder/b.csv"
prints "9 of 9 variants, 6 known before, 3 computed now"
[ "$(cell "$folder/b.csv" 5 objectives.J)" = "$(cell "$folder/a.csv" 3 objectives.J)" ]
result $? "a row that was known is the same in another study"
study "$design" --data "$data" --vary "$relief=0:20:3" --vary "$crowning=0,6,12" --csv "$folder/b2.csv"
prints "taken up): 9 of 9 variants, 6 known before, 0 computed now"
same "$folder/b.csv" "$folder/b2.csv" "the same study once more gives its table again"
"$EASEOFF" history list --data "$data" >"$folder/out" 2>"$folder/err"
grep -q "^ *1 .* 9 " "$folder/out"
result $? "the history of searches has the rows"
"$EASEOFF" optimize "$design" --data "$folder/search" >"$folder/out" 2>"$folder/err"
"$EASEOFF" history export 1 --data "$folder/search" >"$folder/rows" 2>"$folder/err"
awk -F, 'NR == 1 { split("pinion/left/lead_crowning_um pinion/left/tip_relief_um pinion/left/tip_relief_start_mm pinion/left/root_relief_um pinion/left/root_relief_start_mm", key, " ")
  for (k = 1; k <= 5; k++) for (i = 1; i <= NF; i++) if ($i == key[k]) at[k] = i
  print "modification.pinion.*.lead_crowning_um,modification.pinion.*.tip_relief_um,modification.pinion.*.tip_relief_start_mm,modification.pinion.*.root_relief_um,modification.pinion.*.root_relief_start_mm" }
  NR > 2 { print $at[1] "," $at[2] "," $at[3] "," $at[4] "," $at[5] }' "$folder/rows" >"$folder/table.csv"
study "$design" --data "$folder/search" --table "$folder/table.csv" --csv "$folder/found.csv"
prints "30 of 30 variants, 30 known before, 0 computed now"
cp -r "$folder/data/flexibility" "$folder/flexibility"
study "$design" --data "$folder/fresh" --cache "$folder/flexibility" --table "$folder/table.csv" --csv "$folder/computed.csv"
prints "30 of 30 variants, 0 known before, 30 computed now"
same "$folder/found.csv" "$folder/computed.csv" "rows of a search are, to the last digit, what the study computes"

# The table.
study --job 2 --data "$data" --filter 'objectives.J<0.9, outcome=converged' --sort objectives.J --descending
[ "$(awk 'NR > 1 && $7 >= 0.9' "$folder/out" | wc -l)" -eq 0 ] && [ "$(tail -n +2 "$folder/out" | wc -l)" -gt 1 ]
result $? "the table is filtered"
study --job 2 --data "$data" --sort objectives.J --csv -
[ "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "objectives.J") at = i } NR > 1 { print $at }' "$folder/out" | sort -g | tr '\n' ' ')" = \
  "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "objectives.J") at = i } NR > 1 { print $at }' "$folder/out" | tr '\n' ' ')" ]
result $? "the table is sorted"
study --job 2 --data "$data" --json --limit 2
prints '"fits": 9'
prints '"next": "2"'
study "$design" --list-columns
prints "load_cases.2.lte.peak_to_peak_um  *um"
refuses '/filter: "J" is neither' --job 2 --data "$data" --filter 'J<1'
refuses '/columns: "objective.J" fits no number' "$design" --data "$data" --vary T=1,2 --columns objective.J
refuses '/vary/0: "gear_pair.teeth" is of which member' "$design" --data "$data" --vary gear_pair.teeth=17,18
refuses '/vary/0: "tooth" is neither' "$design" --data "$data" --vary tooth=17,18
refuses '/vary/0: .* takes whole numbers' "$design" --data "$data" --vary gear_pair.pinion_teeth=17.5:18:2

# Other pairs, other words, a design that cannot be.
study "$design" --data "$data" --vary gear_pair.pinion_teeth=16,17 --vary alignment.pinion_axial=floating,fixed --vary 'load_cases.1.torque_Nm [kNm]=0.5,1' \
  --vary 'gear_pair.helix_angle_deg=24,80' --columns 'geometry.*,objectives.J' --csv "$folder/c.csv"
prints "16 of 16 variants, 0 known before, 16 computed now, 8 refused"
grep -q '^1,16,floating,0.5,80,.*,refused,.*helix_angle_deg' "$folder/c.csv"
result $? "a variant that cannot be is a row with its reason"
[ "$(cell "$folder/c.csv" 0 geometry.pinion_teeth)$(cell "$folder/c.csv" 8 geometry.pinion_teeth)" = 1617 ]
result $? "each row is of its own pair"

# Rows of several folders.
"$EASEOFF" history import "$folder/search" --data "$folder/merged" >"$folder/out" 2>"$folder/err"
prints "1 problems, 31 evaluations and 30 rows of studies added"
"$EASEOFF" history import "$data" --data "$folder/merged" >"$folder/out" 2>"$folder/err"
prints "evaluations and 25 rows of studies added"
"$EASEOFF" history import "$data" --data "$folder/merged" >"$folder/out" 2>"$folder/err"
prints "0 problems, 0 evaluations and 0 rows of studies added"
study "$design" --data "$folder/merged" --table "$folder/table.csv" --csv "$folder/merged.csv"
prints "30 of 30 variants, 30 known before, 0 computed now"
same "$folder/found.csv" "$folder/merged.csv" "what was imported is what was found"

# Before it begins.
study "$design" --data "$folder/none" --dry-run --vary gear_pair.pinion_teeth=16,17,18 --vary T=1:1000:1000
prints "3000 variants of 3 gear pairs"
[ ! -e "$folder/none/easeoff.db" ]
result $? "a dry run makes no database"

# Samples, and the same bytes for any number of threads and ranks, killed and gone on with or not; with sanitizers fewer of them go through
# the same code.
some_threads="1 2 4" some_ranks="1 2 4 8" victims="0 2"
[ ! "${SANITIZED-}" ] || some_threads=2 some_ranks=3 victims=2
many="$relief=0:30 --vary $crowning=0:20 --vary load_cases.*.torque_Nm=500:1000 --sampling sobol --samples 100"
cp -r "$data" "$folder/pairs"
rm -f "$folder/pairs/easeoff.db"*

run() # NAME COMMAND...: a data folder of its own, with the pair
{
  name=$1
  shift
  rm -rf "${folder:?}/run"
  mkdir "$folder/run"
  # shellcheck disable=SC2086
  "$@" "$EASEOFF" study "$design" --data "$folder/run" --cache "$folder/pairs/flexibility" --vary $many --csv "$folder/$name.csv" >"$folder/out" 2>"$folder/err"
}

run one env && run two env EASEOFF_TEST=2
same "$folder/one.csv" "$folder/two.csv" "a study of samples repeats"
for threads in $some_threads; do
  rm -rf "${folder:?}/run"
  # shellcheck disable=SC2086
  study "$design" --data "$folder/run" --cache "$folder/pairs/flexibility" --vary $many --threads $threads --csv "$folder/threads.csv"
  same "$folder/one.csv" "$folder/threads.csv" "$threads threads give the same bytes"
done

# pid of a rank; empty: it is not there yet
rank()
{
  set +f
  for comm in $(grep -lx easeoff /proc/[0-9]*/comm 2>/dev/null); do
    process=${comm%/comm}
    variables=$(tr '\0' '\n' 2>/dev/null <"$process/environ") || continue
    case $variables in *"EASEOFF_TEST=$folder"*) ;; *) continue ;; esac
    case $variables in *"OMPI_COMM_WORLD_RANK=$1"*) echo "${process#/proc/}" && return ;; esac
  done 2>/dev/null
}

rows()
{
  "$EASEOFF" study --job 1 --data "$folder/run" --csv - 2>/dev/null | wc -l
}

if command -v mpirun >/dev/null && [ -e "$(dirname "$EASEOFF")/easeoff-mpi.so" ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 EASEOFF_TEST="$folder"
  for ranks in $some_ranks; do
    run ranks mpirun --oversubscribe -n $ranks
    same "$folder/one.csv" "$folder/ranks.csv" "$ranks ranks give the same bytes"
  done
  many="$many --columns *"
  run one mpirun --oversubscribe -n 2
  for victim in $victims; do
    run killed mpirun --oversubscribe -n 4 &
    pid='' found=0 looks=0
    while [ $looks -lt 200 ] && [ "$found" -lt 15 ]; do
      [ -n "$pid" ] || pid=$(rank $victim)
      found=$(rows)
      looks=$((looks + 1))
    done
    [ -z "$pid" ] || kill -9 "$pid" 2>/dev/null
    wait
    found=$(rows)
    [ "$found" -ge 15 ] && [ "$found" -lt 101 ]
    result $? "rank $victim is killed after $((found - 1)) of 100 rows, and the run ends"
    # shellcheck disable=SC2086
    mpirun --oversubscribe -n 3 "$EASEOFF" study "$design" --data "$folder/run" --cache "$folder/pairs/flexibility" --vary $many --csv "$folder/resumed.csv" \
      >"$folder/out" 2>"$folder/err"
    prints "taken up): 100 of 100 variants, 0 known before, $((101 - found)) computed now"
    same "$folder/one.csv" "$folder/resumed.csv" "the start after a kill goes on with the same bytes"
  done
  "$EASEOFF" optimize "$design" --data "$folder/alone" --cache "$folder/pairs/flexibility" --json 2>"$folder/err" | sed '/"timing_ms"/,/}/d; /"run"/,/}/d' >"$folder/alone.json"
  mpirun --oversubscribe -n 3 "$EASEOFF" optimize "$design" --data "$folder/ranked" --cache "$folder/pairs/flexibility" --json 2>"$folder/err" |
    sed '/"timing_ms"/,/}/d; /"run"/,/}/d' >"$folder/ranked.json"
  [ -s "$folder/alone.json" ]
  same "$folder/alone.json" "$folder/ranked.json" "a search gives the same document with 3 ranks"
else
  count=$((count + 1))
  echo "ok $count - MPI ranks # SKIP no mpirun, or built without MPI"
fi

echo "1..$count"
exit $failed

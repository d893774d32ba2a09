#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A study over two hosts that are network namespaces of this machine (root, iproute2, Open MPI): messages by TCP between them, each with a folder of
# prepared pairs of its own; the table is that of one process. EASEOFF: the program, with easeoff-mpi.so beside it.
set -eu
: "${EASEOFF:=./easeoff}"
EASEOFF=$(realpath "$EASEOFF")
folder=$(mktemp -d)
one=eo-one-$$ two=eo-two-$$
end() {
  ip netns del "$one" 2>/dev/null || true
  ip netns del "$two" 2>/dev/null || true
  rm -rf "$folder"
}
trap end EXIT
ip netns add "$one"
ip netns add "$two"
ip link add "e1-$$" type veth peer name "e2-$$"
ip link set "e1-$$" netns "$one"
ip link set "e2-$$" netns "$two"
ip netns exec "$one" ip addr add 10.99.0.1/24 dev "e1-$$"
ip netns exec "$two" ip addr add 10.99.0.2/24 dev "e2-$$"
ip netns exec "$one" ip link set lo up
ip netns exec "$one" ip link set "e1-$$" up
ip netns exec "$two" ip link set lo up
ip netns exec "$two" ip link set "e2-$$" up

# in place of ssh: HOST COMMAND...
cat >"$folder/agent" <<AGENT
#!/bin/sh
host=\$1
shift
[ "\$host" = 10.99.0.2 ] && exec ip netns exec $two unshare -u sh -c "hostname two; \$*"
exec ip netns exec $one sh -c "\$*"
AGENT
chmod +x "$folder/agent"
printf '10.99.0.1 slots=2\n10.99.0.2 slots=2\n' >"$folder/hosts"
cat >"$folder/design.json" <<'DESIGN'
{ "gear_pair": { "pinion_teeth": 17, "gear_teeth": 44, "normal_module_mm": 6, "helix_angle_deg": 24, "face_width_mm": 55 },
  "load_cases": [ { "torque_Nm": 828, "speed_rpm": 2000 } ],
  "resolution": { "positions": 16, "cells_per_line": 6, "sector_teeth": 3, "neighbour_coupling": false, "layers": 6, "flank_rows": 4,
    "fillet_elements": 6, "harmonics": 6, "te_harmonics": 6 } }
DESIGN
study="$EASEOFF study $folder/design.json --vary modification.pinion.both.tip_relief_um=0:30 --vary T=500:1000 --sampling sobol --samples 60"
cat >"$folder/run" <<RUN
hostname one
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
exec mpirun --hostfile $folder/hosts --mca plm_rsh_agent $folder/agent --mca btl tcp,self --mca btl_tcp_if_include 10.99.0.0/24 \
  --mca oob_tcp_if_include 10.99.0.0/24 --map-by node --bind-to none -n 4 sh -c 'exec $study --data $folder/data --cache $folder/cache-\$(hostname) --csv $folder/two.csv'
RUN
timeout 120 ip netns exec "$one" unshare -u sh "$folder/run"
$study --data "$folder/alone" --csv "$folder/one.csv" >/dev/null
cmp "$folder/one.csv" "$folder/two.csv"
for host in one two; do
  [ "$(find "$folder/cache-$host" -name '*.flex' | wc -l)" = 1 ] || { echo "host $host prepared no pair" && exit 1; }
done
echo "the same bytes over two hosts, a pair prepared on each"

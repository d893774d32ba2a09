#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The image of docker/Dockerfile, built and used as its users do: an unprivileged user, a read-only root, no capabilities, a volume. It
# analyses, keeps its designs and jobs over stop and start, asks for its token, tells its health, its version and what it is made of, and
# ends when told. By hand; needs docker or podman, some gigabytes and ten minutes.
#
#   tests/machine/image.sh [image|compose|all]      compose takes port 8080
#
# IMAGE_ENGINE    docker or podman, with options before the command (default: the one that is there and answers)
# IMAGE_COMPOSE   the command that reads compose files (default: the engine's; podman-compose is one)
# IMAGE_BUILD     options for the engine's build
# IMAGE_RUN       options for the engine's run
# IMAGE_BASE      folder with a Debian 12 (debootstrap --variant=minbase, with what a site needs laid over it) that takes the place of
#                 debian:12 and debian:12-slim where their registry cannot be reached
# IMAGE_BASE_ENV  NAME=VALUE ... in that base, of a site as well
# IMAGE_KEEP      keep the image at the end
#
# Inside a machine without systemd, with both kinds of control groups and limits of its own (podman 4.3, runc 1.1):
#   IMAGE_ENGINE="podman --runtime runc" IMAGE_BUILD="--isolation chroot --network host"
#   IMAGE_RUN="--network host --no-healthcheck --ulimit nofile=20000:20000 --ulimit nproc=4096:4096"
# for compose the same runtime and limits by a file of podman's, $CONTAINERS_CONF:
#   [containers] default_ulimits = ["nofile=20000:20000", "nproc=4096:4096"]   [engine] runtime = "runc"
set -eu

what=${1-all}
here=$(cd "$(dirname "$0")/../.." && pwd)
# The command line of docker may be there without its daemon.
find_engine() {
  for candidate in docker podman; do
    ! $candidate info >/dev/null 2>&1 || {
      echo "$candidate"
      return
    }
  done
  echo "image: neither docker nor podman answers" >&2
  exit 1
}
engine=${IMAGE_ENGINE-$(find_engine)}
compose=${IMAGE_COMPOSE-$engine compose}
name=easeoff-check-$$
version=$(sh "$here/bootstrap" version)
image=$name:$version
scratch=$(mktemp -d "${TMPDIR-/tmp}/image.XXXXXX")
export BUILDAH_FORMAT=docker # for podman, whose own format has no health check
confined="--read-only --cap-drop ALL --security-opt no-new-privileges"

say() { printf 'image: %s\n' "$*"; }

fail() {
  say "NOT $*"
  $engine logs --tail 20 "$name" 2>&1 || true
  exit 1
}

leave() {
  status=$?
  {
    [ ! -f "$scratch/composed" ] || $compose -p "$name" -f "$here/docker/compose.yaml" down -v
    [ ! -f "$scratch/composed" ] || $engine network rm "${name}_default"
    [ ! -f "$scratch/composed" ] || $engine rmi "$name-easeoff" "${name}_easeoff"
    $engine rm -f -v "$name"
    $engine volume rm "$name"
    [ -n "${IMAGE_KEEP-}" ] || $engine rmi "$image"
    [ -z "${IMAGE_BASE-}" ] || $engine rmi docker.io/library/debian:12 docker.io/library/debian:12-slim
  } >/dev/null 2>&1 || true
  rm -rf "$scratch"
  exit "$status"
}
trap leave EXIT
trap 'exit 1' INT TERM

import_base() {
  for variable in ${IMAGE_BASE_ENV-}; do
    set -- "$@" -c "ENV $variable"
  done
  for tag in 12 12-slim; do
    tar -C "$IMAGE_BASE" -c . | $engine import -c 'CMD ["bash"]' "$@" - "docker.io/library/debian:$tag" >"$scratch/import.log" 2>&1 || {
      cat "$scratch/import.log"
      fail "imported"
    }
  done
}

build_image() {
  started=$(date +%s)
  # shellcheck disable=SC2086
  $engine build ${IMAGE_BUILD-} -t "$image" -f "$here/docker/Dockerfile" "$here" >"$scratch/build.log" 2>&1 || {
    tail -n 30 "$scratch/build.log"
    fail "built"
  }
  say "built in $(($(date +%s) - started)) s, $(($($engine image inspect -f '{{.Size}}' "$image") / 1000000)) MB"
}

# start [option of the engine's run ... --] [option of easeoff serve ...]
start() {
  options=
  while [ "${1-}" != -- ]; do
    options="$options $1"
    shift
  done
  shift
  began=$(date +%s%N)
  # shellcheck disable=SC2086
  $engine run -d --name "$name" $confined ${IMAGE_RUN-} -p 127.0.0.1::8080 -v "$name:/data" $options "$image" "$@" >/dev/null
  wait_for_health
}

# The address is the engine's choice, and another one after every start; port 8080 in the host's own network.
wait_for_health() {
  for _ in $(seq 300); do
    url=$($engine port "$name" 8080/tcp 2>/dev/null | head -n 1) || true
    url=http://${url:-127.0.0.1:8080}
    if curl -fs "$url/api/v1/health" >"$scratch/health"; then
      say "answers $((($(date +%s%N) - began) / 1000000)) ms after its start"
      return
    fi
    sleep 0.1
  done
  fail "answering"
}

check_stop() {
  began=$(date +%s%N)
  $engine stop -t 30 "$name" >/dev/null
  code=$($engine inspect -f '{{.State.ExitCode}}' "$name")
  [ "$code" = 0 ] || fail "stopped with 0 but $code"
  say "$1 stopped in $((($(date +%s%N) - began) / 1000000)) ms, exit status 0"
}

remove() { $engine rm -f "$name" >/dev/null; }

# expect STATUS PATH [option of curl ...]
expect() {
  status=$1 path=$2
  shift 2
  got=$(curl -s -o "$scratch/answer" -w '%{http_code}' "$@" "$url$path")
  [ "$got" = "$status" ] || fail "$status but $got: $path $(head -c 400 "$scratch/answer")"
}

check_refusal() {
  # shellcheck disable=SC2086
  if $engine run --rm $confined ${IMAGE_RUN-} "$image" >"$scratch/refusal" 2>&1; then fail "refused without a token"; fi
  grep -q 'give a token' "$scratch/refusal" || fail "refused with the reason: $(cat "$scratch/refusal")"
  say "refuses to serve anyone unless told"
}

# The tag, the program and the bill of materials name one version; the bill names what the program cannot do without.
check_contents() {
  # shellcheck disable=SC2086
  run_in="$engine run --rm $confined ${IMAGE_RUN-} --entrypoint"
  [ "$($run_in easeoff "$image" --version)" = "easeoff $version" ] || fail "easeoff $version: $($run_in easeoff "$image" --version)"
  $run_in cat "$image" /usr/share/doc/easeoff/easeoff.spdx.json >"$scratch/bill" || fail "a bill of materials"
  for word in "easeoff-$version" libgsl27 libcholmod3 libopenblas0-pthread libsundials-cvode6 libsqlite3-0 libmicrohttpd12 uplot; do
    grep -q "\"name\": \"$word\"" "$scratch/bill" || fail "$word in the bill of materials"
  done
  say "easeoff $version; its bill of materials names $(grep -c versionInfo "$scratch/bill") packages"
}

check_confinement() {
  state=$($engine exec "$name" cat /proc/1/status)
  for line in 'Name:easeoff' 'Uid:10001' 'Gid:10001' 'CapEff:0000000000000000' 'CapBnd:0000000000000000' 'NoNewPrivs:1'; do
    printf '%s\n' "$state" | tr -d ' \t' | grep -q "^$line" || fail "$line"
  done
  if $engine exec "$name" touch /usr/written 2>/dev/null; then fail "read-only"; fi
  say "uid 10001, no capabilities, no new ones, read-only root"
}

# The image's own command.
read_health_command() { command=$($engine image inspect -f '{{index .Config.Healthcheck.Test 3}}' "$image"); }

check_health_command() {
  read_health_command
  $engine exec "$name" bash -c "$command" || fail "healthy"
  say "tells its health"
}

# Before a server runs, which it would find in the host's own network.
check_no_health() {
  read_health_command
  status=0
  # shellcheck disable=SC2086
  $engine run --rm $confined ${IMAGE_RUN-} --entrypoint bash "$image" -c "$command" 2>"$scratch/unhealthy" || status=$?
  [ "$status" = 1 ] || fail "unhealthy without a server, but $status: $(cat "$scratch/unhealthy")"
  say "is not healthy without a server"
}

# analyse DESIGN: into the answer, however long the gear pair takes to prepare.
analyse() {
  for _ in $(seq 10); do
    got=$(curl -s -o "$scratch/answer" -w '%{http_code}' -H 'Prefer: wait=60' -H 'Content-Type: application/json' --data-binary "@$1" \
      "$url/api/v1/analyze")
    [ "$got" = 202 ] || break
  done
  [ "$got" = 200 ] || fail "analysed but $got: $(head -c 400 "$scratch/answer")"
  grep -q '"outcome":"converged"' "$scratch/answer" || fail "converged"
}

# refuse FILE WORDS: a recording about whose contents the reader complains with these words.
refuse() {
  expect 422 /api/v1/measurements -F design=1 -F label=unmodified -F torque_Nm=828 -F "file=@$here/tests/fuzz/reader/$1"
  grep -q "$2" "$scratch/answer" || fail "read: $1 $(head -c 400 "$scratch/answer")"
}

check_use() {
  curl -fs "$url/" | grep -q '<title>Easeoff' || fail "the page"
  expect 200 /doc/
  expect 200 /api/v1/health/ready
  expect 200 /api/v1/examples/paper
  cp "$scratch/answer" "$scratch/paper.json"
  began=$(date +%s%N)
  analyse "$scratch/paper.json"
  say "the page, and the paper's pair prepared and analysed in $((($(date +%s%N) - began) / 1000000)) ms"
  expect 201 /api/v1/designs -H 'Content-Type: application/json' --data-binary "@$scratch/paper.json"
  # Complaints about the contents come from the process that reads such files.
  refuse version73.mat 'has 1 column that may hold'
  refuse compressed.mat 'has only 24 rows'
  say "reads MATLAB and HDF5 files"
}

without_times() { sed 's/"timing_ms":{[^}]*}//'; }

# A pair that is nobody's: ordered, analysed, kept.
check_own_pair() {
  expect 200 /api/v1/examples/narrow
  sed 's/"pinion_teeth":23/"pinion_teeth":25/; s/"gear_teeth":67/"gear_teeth":62/' "$scratch/answer" >"$scratch/own.json"
  ! cmp -s "$scratch/answer" "$scratch/own.json" || fail "a pair of 25 and 62 teeth"
  analyse "$scratch/own.json"
  without_times <"$scratch/answer" >"$scratch/own-analysis"
  expect 201 /api/v1/designs -H 'Content-Type: application/json' --data-binary "@$scratch/own.json"
  own=$(sed 's/^{"id":\([0-9]*\).*/\1/' "$scratch/answer")
  expect 200 "/api/v1/designs/$own"
  cp "$scratch/answer" "$scratch/own-design"
  say "a pair of 25 and 62 teeth analysed and kept"
}

check_own_pair_stays() {
  expect 200 "/api/v1/designs/$own"
  cmp -s "$scratch/answer" "$scratch/own-design" || fail "the design kept over stop and start"
  analyse "$scratch/own.json"
  without_times <"$scratch/answer" | cmp -s - "$scratch/own-analysis" || fail "the same analysis after stop and start"
  say "its design and its analysis are the same after stop and start"
}

# job ID PATTERN: waits until its document has the pattern.
job() {
  for _ in $(seq 3000); do
    curl -fs "$url/api/v1/jobs/$1" >"$scratch/job" || true
    ! grep -q "$2" "$scratch/job" || return 0
    sleep 0.1
  done
  fail "a job that comes to $2: $(head -c 400 "$scratch/job")"
}

check_jobs_stay() {
  { printf '{"kind":"optimize","design":' && sed 's/"true_evaluations":null/"true_evaluations":400/' "$scratch/paper.json" && printf '}'; } >"$scratch/order"
  expect 202 /api/v1/jobs -H 'Content-Type: application/json' --data-binary "@$scratch/order"
  id=$(sed 's/^{"id":\([0-9]*\).*/\1/' "$scratch/answer")
  job "$id" '"progress":{[^}]*"true_evaluations":[1-9]'
  grep -q '"state":"running"' "$scratch/job" || fail "stopped in the middle of a job"
  check_stop "in the middle of a job, it"
  began=$(date +%s%N)
  $engine start "$name" >/dev/null
  wait_for_health
  job "$id" '"state":"done"'
  grep -q '"attempts":2' "$scratch/job" || fail "a second attempt"
  say "the job went on after the next start and is done"
}

check_token() {
  start -e EASEOFF_TOKEN=a-word-of-the-check --
  expect 401 /api/v1/examples
  expect 200 /api/v1/examples -H 'Authorization: Bearer a-word-of-the-check'
  check_health_command
  check_stop "with a token, it"
  remove
  say "asks for its token"
}

try_image() {
  build_image
  check_contents
  check_refusal
  check_no_health
  start -- --allow-anyone
  check_confinement
  check_health_command
  check_use
  check_own_pair
  check_jobs_stay
  check_own_pair_stays
  check_stop "idle, it"
  remove
  check_token
}

try_compose() {
  : >"$scratch/composed"
  $compose -p "$name" -f "$here/docker/compose.yaml" up -d --build >"$scratch/compose.log" 2>&1 || {
    tail -n 30 "$scratch/compose.log"
    fail "up"
  }
  url=http://127.0.0.1:8080
  composed=$($engine ps -q --filter "label=com.docker.compose.project=$name")
  for _ in $(seq 60); do
    # podman has systemd ask, where there is one
    case $engine in *podman*) $engine healthcheck run "$composed" >/dev/null 2>&1 || true ;; esac
    health=$($engine inspect -f '{{.State.Health.Status}}' "$composed")
    [ "$health" = starting ] || break
    sleep 1
  done
  [ "$health" = healthy ] || fail "healthy but $health"
  curl -fs "$url/" | grep -q '<title>Easeoff' || fail "the page"
  $compose -p "$name" -f "$here/docker/compose.yaml" stop >/dev/null 2>&1
  code=$($engine inspect -f '{{.State.ExitCode}}' "$composed")
  [ "$code" = 0 ] || fail "stopped with 0 but $code"
  say "compose: up, healthy by its own account, serves, stops with exit status 0"
}

case $what in
image | compose | all) ;;
*)
  say "image, compose or all"
  exit 1
  ;;
esac
[ -z "${IMAGE_BASE-}" ] || import_base
[ "$what" = compose ] || try_image
[ "$what" = image ] || try_compose
say "all is well"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A fresh Debian 12 with nothing but a clone of this repository, in a chroot: ./bootstrap serve answers on /health with the page, a stranger's
# tour (the commands of README.md and doc/guide.md, and the robust flank by Python of doc/api.md) runs at full resolution, ./bootstrap check
# is green. By hand and as root; needs debootstrap, some gigabytes and most of an hour.
#
#   tests/machine/fresh-machine.sh [serve|tour|check|all]      tour: after serve
#
# FRESH_DIR       where the machine stands (default: a new folder beside $TMPDIR's files); it is removed at the end unless FRESH_KEEP is set
# FRESH_MIRROR    Debian mirror (default: the one debootstrap knows)
# FRESH_OVERLAY   folder laid over the machine's root: what a site needs for apt and npm. Where its connections carry a certificate of its own:
#                 etc/ssl/certs/ca-certificates.crt and usr/local/share/ca-certificates/ of a machine that works there, root/.npmrc with
#                 cafile=/etc/ssl/certs/ca-certificates.crt, etc/apt/sources.list.d/ and etc/apt/apt.conf.d/
# FRESH_ENV       NAME=VALUE ... for the commands inside, of a site as well: NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt
# FRESH_PATIENCE  seconds for ./bootstrap serve to answer, packages and build included (default 1800; a busy machine needs more)
set -eu

what=${1-all}
here=$(cd "$(dirname "$0")/../.." && pwd)
machine=${FRESH_DIR-$(mktemp -d "${TMPDIR-/tmp}/fresh.XXXXXX")}
root=$machine/root
server=

say() { printf 'fresh machine: %s\n' "$*"; }

inside() {
  # shellcheck disable=SC2086
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 ${FRESH_ENV-} chroot "$root" "$@"
}

leave() {
  status=$?
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  for place in dev/pts dev/shm dev sys proc; do
    umount "$root/$place" 2>/dev/null || true
  done
  if [ -n "${FRESH_KEEP-}" ]; then say "kept in $machine"; else rm -rf --one-file-system "$machine"; fi
  exit "$status"
}
trap leave EXIT
trap 'exit 1' INT TERM

build_machine() {
  [ -x "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$root" ${FRESH_MIRROR:+"$FRESH_MIRROR"} >"$machine/debootstrap.log"
  [ -z "${FRESH_OVERLAY-}" ] || cp -a "$FRESH_OVERLAY/." "$root/"
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  mount -t proc proc "$root/proc"
  mount -t sysfs sys "$root/sys"
  mount --bind /dev "$root/dev"
  mount -t devpts devpts "$root/dev/pts"
  mount -t tmpfs tmpfs "$root/dev/shm"
  rm -rf "$root/root/easeoff"
  git clone -q "$here" "$root/root/easeoff"
}

# The page's own words when it stands: a line with its URL.
try_serve() {
  started=$(date +%s)
  rm -f "$root/root/serve.pid"
  inside sh -c 'cd && echo $$ >serve.pid && cd easeoff && exec ./bootstrap serve --listen 127.0.0.1:0' >"$machine/serve.log" 2>&1 &
  job=$!
  until [ -s "$root/root/serve.pid" ]; do sleep 0.1; done
  server=$(cat "$root/root/serve.pid") # the job is the shell around it, which a signal ends alone
  patience=${FRESH_PATIENCE-1800} url=
  for _ in $(seq "$patience"); do
    url=$(sed -n 's#.*\(http://127\.0\.0\.1:[0-9]*\).*#\1#p' "$machine/serve.log" | head -n 1)
    [ -z "$url" ] || break
    kill -0 "$server" 2>/dev/null || { tail -n 20 "$machine/serve.log"; return 1; }
    sleep 1
  done
  [ -n "$url" ] || { tail -n 20 "$machine/serve.log"; say "NOT an address within $patience s"; return 1; }
  curl -fsS "$url/api/v1/health"
  curl -fsS "$url/" | grep -q '<title>Easeoff' || {
    say "NOT the page: npm could not fetch its libraries? FRESH_OVERLAY lays a site's certificates over the machine"
    return 1
  }
  say "./bootstrap serve answered after $(($(date +%s) - started)) s"
  kill "$server"
  wait "$job" || true
  server=
}

# The blocks of shell of a text, one file each.
blocks_of() {
  awk -v folder="$2" '/^```sh$/ { n++; on = 1; next } /^```$/ { on = 0 } on { print > sprintf("%s/%02d.sh", folder, n) }' "$1"
}

try_tour() {
  whole=$(date +%s)
  inside sh -c 'command -v python3 >/dev/null || { apt-get update -qq && apt-get install -y -qq --no-install-recommends python3; } >/dev/null 2>&1'
  for text in README.md doc/guide.md; do
    place=$root/root/tour/$(basename "$text" .md)
    mkdir -p "$place/blocks"
    blocks_of "$root/root/easeoff/$text" "$place/blocks"
    for block in "$place"/blocks/*.sh; do
      started=$(date +%s)
      inside sh -c "cd ${place#"$root"} && PATH=/root/easeoff/build:\$PATH && export PATH && exec sh -e ${block#"$root"}" >"$block.out" 2>&1 || {
        tail -n 20 "$block.out"
        say "NOT $text: $(head -n 1 "$block")"
        return 1
      }
      say "$(($(date +%s) - started)) s: $text: $(head -n 1 "$block" | cut -c 1-90)"
    done
  done
  started=$(date +%s)
  inside sh -c 'cd /root/tour/README && PATH=/root/easeoff/build:$PATH && export PATH
    easeoff serve --listen 127.0.0.1:0 --quiet >serve.out & server=$!
    until grep -q http serve.out; do kill -0 $server || exit 1; sleep 0.1; done
    PYTHONPATH=/root/easeoff/clients/python python3 /root/easeoff/clients/python/examples/robust_flank.py own.json "$(sed "s/.* //; s#/\$##" serve.out)"
    status=$?; kill $server; exit $status' >"$machine/robust.log" 2>&1 || { tail -n 20 "$machine/robust.log"; return 1; }
  tail -n 3 "$machine/robust.log"
  say "$(($(date +%s) - started)) s: a robust flank by Python; the tour took $(($(date +%s) - whole)) s"
}

try_check() {
  started=$(date +%s)
  inside sh -c 'cd && cd easeoff && ./bootstrap check' >"$machine/check.log" 2>&1 || { tail -n 40 "$machine/check.log"; return 1; }
  tail -n 1 "$machine/check.log"
  say "./bootstrap check was green after $(($(date +%s) - started)) s"
}

build_machine
case $what in
serve) try_serve ;;
tour)
  try_serve
  try_tour
  ;;
check) try_check ;;
all)
  try_serve
  try_tour
  try_check
  ;;
*)
  say "serve, tour, check or all"
  exit 1
  ;;
esac

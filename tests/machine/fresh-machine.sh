#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A fresh Debian 12 with nothing but a clone of this repository, in a chroot: ./bootstrap serve answers on /health, ./bootstrap check is
# green. By hand and as root; needs debootstrap, some gigabytes and most of an hour.
#
#   tests/machine/fresh-machine.sh [serve|check|all]
#
# FRESH_DIR       where the machine stands (default: a new folder beside $TMPDIR's files); it is removed at the end unless FRESH_KEEP is set
# FRESH_MIRROR    Debian mirror (default: the one debootstrap knows)
# FRESH_OVERLAY   folder laid over the machine's root: apt sources, certificates, npm settings of a site
# FRESH_ENV       NAME=VALUE ... for the commands inside, of a site as well
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
  inside sh -c 'cd && cd easeoff && exec ./bootstrap serve --listen 127.0.0.1:0' >"$machine/serve.log" 2>&1 &
  server=$!
  for _ in $(seq 1800); do
    url=$(sed -n 's#.*\(http://127\.0\.0\.1:[0-9]*\).*#\1#p' "$machine/serve.log" | head -n 1)
    [ -z "$url" ] || break
    kill -0 "$server" 2>/dev/null || { tail -n 20 "$machine/serve.log"; return 1; }
    sleep 1
  done
  curl -fsS "$url/api/v1/health"
  curl -fsS "$url/" | grep -q '<title>Easeoff'
  say "./bootstrap serve answered after $(($(date +%s) - started)) s"
  kill "$server"
  wait "$server" || true
  server=
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
check) try_check ;;
all)
  try_serve
  try_check
  ;;
*)
  say "serve, check or all"
  exit 1
  ;;
esac

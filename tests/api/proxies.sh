#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# docker/nginx.conf and docker/Caddyfile with a server behind them, where nginx or Caddy is installed.
if ! command -v python3 >/dev/null; then
  echo "1..0 # SKIP python3 is not there"
  exit 0
fi
exec python3 "$SOURCES/tests/api/proxies.py"

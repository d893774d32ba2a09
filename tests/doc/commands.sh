#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every command of the manuals, run in the order of the text: see commands.py.
command -v python3 >/dev/null && command -v curl >/dev/null || {
  echo "1..0 # SKIP python3 and curl are needed"
  exit 0
}
PYTHONDONTWRITEBYTECODE=1 exec python3 "$SOURCES/tests/doc/commands.py"

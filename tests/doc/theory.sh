#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The theory manual against the source and the program: see theory.py.
command -v python3 >/dev/null || {
  echo "1..0 # SKIP python3 is not there"
  exit 0
}
PYTHONDONTWRITEBYTECODE=1 exec python3 "$SOURCES/tests/doc/theory.py"

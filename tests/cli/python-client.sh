#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Python client against this program: clients/python/tests as TAP.
command -v python3 >/dev/null || {
  echo "1..0 # SKIP python3 is not there"
  exit 0
}
out=$(PYTHONDONTWRITEBYTECODE=1 python3 "$SOURCES/clients/python/tests/test_client.py" 2>&1) || true
printf '%s\n' "$out" | awk '
  /^test_.*\.\.\. / { count++; name = $1; gsub("_", " ", name); print ($NF == "ok" ? "ok " : "not ok ") count " - client: " name; next }
  { print "# " $0 }
  END { if (!count) { count = 1; print "not ok 1 - client: the tests could not be run" } print "1.." count }'

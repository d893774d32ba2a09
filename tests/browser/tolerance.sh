#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Tolerance view in a real browser against a real server: pairs that a job draws.
if [ -z "$NODE" ] || [ ! -f "$PAGE/index.html" ]; then
  echo "1..0 # SKIP the page is not built here"
  exit 0
fi
if [ -z "$CHROMIUM" ]; then
  echo "1..0 # SKIP no Chromium"
  exit 0
fi
exec "$NODE" "$SOURCES/tests/browser/tolerance.mjs"

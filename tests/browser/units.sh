#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The page in inches and thousandths in a real browser against a real server: every length that it shows and saves is the one in mm by 25.4.
if [ -z "$NODE" ] || [ ! -f "$PAGE/index.html" ]; then
  echo "1..0 # SKIP the page is not built here"
  exit 0
fi
if [ -z "$CHROMIUM" ]; then
  echo "1..0 # SKIP no Chromium"
  exit 0
fi
exec "$NODE" "$SOURCES/tests/browser/units.mjs"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that are dropped on the page, in a real browser against a real server.
if [ -z "$NODE" ] || [ ! -f "$PAGE/index.html" ]; then
  echo "1..0 # SKIP the page is not built here"
  exit 0
fi
if [ -z "$CHROMIUM" ]; then
  echo "1..0 # SKIP no Chromium"
  exit 0
fi
exec "$NODE" "$SOURCES/tests/browser/files.mjs"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The page's modules that need no browser.
if [ -z "$NODE" ]; then
  echo "1..0 # SKIP no node"
  exit 0
fi
exec "$NODE" "$SOURCES/tests/browser/modules.mjs"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The types in the page's comments agree with its code.
if [ ! -f "$MODULES/node_modules/typescript/bin/tsc" ] || [ -z "$NODE" ]; then
  echo "1..0 # SKIP the page is not built here"
  exit 0
fi
echo "1..1"
if out=$("$NODE" "$MODULES/node_modules/typescript/bin/tsc" --noEmit --strict -p "$MODULES/tsconfig.json"); then
  echo "ok 1 - types"
else
  echo "$out" | sed 's/^/# /'
  echo "not ok 1 - types"
  exit 1
fi

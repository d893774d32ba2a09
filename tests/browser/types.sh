#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The page's code agrees with its types, and those of the API are what the program says of itself (web/types.mjs): a key that is renamed or
# may be null is found here. Values by pointer and attributes of elements alone are anything.
if [ ! -f "$MODULES/node_modules/typescript/bin/tsc" ] || [ -z "$NODE" ]; then
  echo "1..0 # SKIP the page is not built here"
  exit 0
fi
echo "1..2"
failed=0
if out=$("$NODE" "$MODULES/node_modules/typescript/bin/tsc" --noEmit --strict -p "$MODULES/tsconfig.json"); then
  echo "ok 1 - types"
else
  echo "$out" | sed 's/^/# /'
  echo "not ok 1 - types"
  failed=1
fi
if out=$(grep -rnE "[{<,] *any\b|\bany(\[\]|>|})" "$SOURCES/web/src" --include='*.js' | grep -vE "base/(dom|pointer)\.js:"); then
  echo "$out" | sed 's/^/# /'
  echo "not ok 2 - no answer and no request is anything"
  failed=1
else
  echo "ok 2 - no answer and no request is anything"
fi
exit $failed

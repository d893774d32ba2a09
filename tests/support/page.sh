# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# What tests of the page in a browser share, read by them: runs the .mjs that is named like the test, or says why it cannot.
skip() # why
{
  echo "1..0 # SKIP $1"
  exit 0
}
if [ -z "$NODE" ] || [ ! -f "$PAGE/index.html" ]; then skip 'the page is not built here'; fi
[ -n "$CHROMIUM" ] || skip 'no Chromium'
exec "$NODE" "${0%.sh}.mjs"

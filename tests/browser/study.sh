#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Study view in a real browser against a real server: from what varies to a variant that is opened. EASEOFF_STUDY=DIR:JOB looks at a study that
# is there in place of one of its own, and says how long its longest task took.
if [ -z "$NODE" ] || [ ! -f "$PAGE/index.html" ]; then
  echo "1..0 # SKIP the page is not built here"
  exit 0
fi
if [ -z "$CHROMIUM" ]; then
  echo "1..0 # SKIP no Chromium"
  exit 0
fi
exec "$NODE" "$SOURCES/tests/browser/study.mjs"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Study view in a real browser against a real server: from what varies to a variant that is opened. EASEOFF_STUDY=DIR:JOB looks at a study that
# is there in place of one of its own, and says how long its longest task took.
. "$(dirname "$0")/../support/page.sh"

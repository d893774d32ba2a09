#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The Tolerance view in a real browser against a real server: pairs that a job draws.
. "$(dirname "$0")/../support/page.sh"

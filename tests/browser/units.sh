#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The page in inches and thousandths in a real browser against a real server: every length that it shows and saves is the one in mm by 25.4.
. "$(dirname "$0")/../support/page.sh"

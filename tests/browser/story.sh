#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A day of a designer in a real browser against a real server.
. "$(dirname "$0")/../support/page.sh"

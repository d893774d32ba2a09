#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that are dropped on the page, in a real browser against a real server.
. "$(dirname "$0")/../support/page.sh"

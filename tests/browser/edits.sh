#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# One edit of a field, of a sample of them, in a real browser against a real server.
. "$(dirname "$0")/../support/page.sh"

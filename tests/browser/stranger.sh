#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A stranger with a gear of their own, on every size of screen, in a real browser against a real server.
. "$(dirname "$0")/../support/page.sh"

#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What fingers press on a phone, in a real browser against a real server.
. "$(dirname "$0")/../support/page.sh"

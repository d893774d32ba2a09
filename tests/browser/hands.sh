#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What hands do to the page, in a real browser against a real server.
. "$(dirname "$0")/../support/page.sh"

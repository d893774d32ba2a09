#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The corpus of the fuzzer, replayed.
exec ./tests/fuzz/fuzz-http "${SOURCES:-.}"/tests/fuzz/http/*

#!/bin/sh
# The corpus of the fuzzer, replayed.
exec ./tests/fuzz/fuzz-http "${SOURCES:-.}"/tests/fuzz/http/*

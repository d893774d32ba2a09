#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The property of tests/unit/evaluation/history on every processor that this one can stand for: each version of our own kernel, with the matrix
# library's kernels of such a processor.
. "${SOURCES:-.}/tests/support/tap.sh"
: "${HISTORY:=$(dirname "$EASEOFF")/tests/unit/evaluation/history}"

# features taken from the processor, kernels of OpenBLAS, the version of ours that must have run
check()
{
  GLIBC_TUNABLES=glibc.cpu.hwcaps=$1 OPENBLAS_CORETYPE=$2 "$HISTORY" "$folder" >"$folder/out" 2>"$folder/err"
  status=$?
  grep -q "^# version $3 of" "$folder/out" || status=1
  grep -v '^ok' "$folder/out" >>"$folder/err"
  : >"$folder/out"
  result $status "nothing depends on what was asked before: version $3, OpenBLAS for ${2:-this processor}"
}

has()
{
  grep -m 1 '^flags' /proc/cpuinfo | grep -qw "$1"
}

if has avx512f && has avx512dq && has avx512vl && has avx2 && has fma; then
  check "" "" avx512
fi
if has avx2 && has fma; then
  check "-AVX512F" Haswell avx2
fi
[ "$(uname -m)" != x86_64 ] || check "-AVX512F,-AVX2" Prescott plain

echo "1..$count"
exit $failed

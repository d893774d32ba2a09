#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The tour's list of one evaluation in src/README.md is the list of calls in src/evaluation/order.c: the same names in the same order.
: "${SOURCES:=.}"
code=$(sed -n '/^static enum eo_code follow_order/,/^}/p' "$SOURCES/src/evaluation/order.c" |
  grep -oE '\beo_(evaluator|end|reuse|roots)_[a-z_]+' | grep -v '^eo_end_step$')
tour=$(sed -n '/^    eo_evaluator_run /,/^    eo_evaluator_combine /p' "$SOURCES/src/README.md" |
  sed -n 's/^      *\(eo_[a-z_]*\) .*/\1/p')

if [ -n "$code" ] && [ "$code" = "$tour" ]; then
  echo "ok 1 - the tour lists the calls of one evaluation: $(echo "$code" | wc -l) of them"
else
  echo "not ok 1 - the tour lists the calls of one evaluation"
  printf '%s\n' "order.c:" "$code" "src/README.md:" "$tour" | sed 's/^/# /'
  failed=1
fi
echo "1..1"
exit ${failed:-0}

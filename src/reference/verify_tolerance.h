/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reference cases of gears as made: samples with their statistics, and closed forms. */
#ifndef EASEOFF_REFERENCE_VERIFY_TOLERANCE_H
#define EASEOFF_REFERENCE_VERIFY_TOLERANCE_H

#include "reference/tolerance_bench.h"

enum eo_code eo_verify_tolerance(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* One case whose distribution is known. context: struct eo_tolerance_bench. */
enum eo_code eo_verify_tolerance_analytic(void *context, struct eo_case *item, struct eo_error *error);

/* One of them whose response is written out. */
enum eo_code eo_verify_tolerance_response(struct eo_verification *verification, struct eo_case *item,
                                          struct eo_error *error);

/* A response written out in the file, "2 + 3 x1 - 2 x2", "x1^2 + x2^2", "sin x1 + 7 sin^2 x2"; text behind it is not
   read. Value at x; *inputs (may be NULL): the largest index of an x. NaN: it cannot be read. */
double eo_response_value(const char *text, const double *x, int *inputs);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorting in place, ascending. */
#ifndef EASEOFF_BASE_SORT_H
#define EASEOFF_BASE_SORT_H

#include <stdint.h>

void eo_sort_numbers(int64_t n, double *value); /* none may be NaN */
void eo_sort_integers(int64_t n, int *value);

#endif

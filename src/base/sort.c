/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/sort.h"

#include <stdlib.h>

static int compare_numbers(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static int compare_integers(const void *a, const void *b)
{
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

void eo_sort_numbers(int64_t n, double *value)
{
  qsort(value, (size_t)n, sizeof *value, compare_numbers);
}

void eo_sort_integers(int64_t n, int *value)
{
  qsort(value, (size_t)n, sizeof *value, compare_integers);
}

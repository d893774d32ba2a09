/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files that verify samples of gears as made share. */
#ifndef EASEOFF_REFERENCE_VERIFY_TOLERANCE_PRIVATE_H
#define EASEOFF_REFERENCE_VERIFY_TOLERANCE_PRIVATE_H

#include "reference/verify_tolerance.h"

enum { EO_TOLERANCE_COLUMNS = EO_BENCH_INPUTS + EO_BENCH_OUTPUTS };

/* A case with its listed rows, column by column, and the outputs computed anew. */
struct eo_tolerance_trial {
  struct eo_tolerance_bench *bench;
  struct eo_verification *v;
  struct eo_case *item, *statistics;
  int inputs, columns, rows;
  const char *name[EO_TOLERANCE_COLUMNS];
  int output[EO_TOLERANCE_COLUMNS]; /* of EO_BENCH_...; -1: an input */
  double *input;                    /* [rows][inputs] */
  double *listed;                   /* [columns][rows] */
  double *computed;                 /* [columns][rows] */
  struct eo_case *tolerance;
};

/* Statistics of the listed rows, of the rows computed here and of samples drawn here: mean, percentiles, regression,
   correlations, yield. */
enum eo_code eo_verify_tolerance_statistics(struct eo_tolerance_trial *trial, struct eo_error *error);

#endif

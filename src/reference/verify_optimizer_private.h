/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two files that verify the optimizer share: the run, its comparisons, lists of numbers. */
#ifndef EASEOFF_REFERENCE_VERIFY_OPTIMIZER_PRIVATE_H
#define EASEOFF_REFERENCE_VERIFY_OPTIMIZER_PRIVATE_H

#include "reference/verify.h"

enum { EO_OPTIMIZER_MOST_ROWS = 100000 };

struct eo_optimizer_verifier {
  struct eo_case *file;
  struct eo_verification *v;
  double usual;    /* relative tolerance of the file */
  double relative; /* of the case under work */
};

/* A case: its tolerance. */
void eo_optimizer_case_begin(struct eo_optimizer_verifier *verifier, struct eo_case *item);

/* To the tolerance in force; a 0 to the same part of 1, the size of the unit cube and of a credibility. */
void eo_optimizer_case_compare(const struct eo_optimizer_verifier *verifier, struct eo_case *expected, double value);
void eo_optimizer_case_compare_list(const struct eo_optimizer_verifier *verifier, struct eo_case *expected, int count,
                                    const double *value);

/* A list of numbers, or of rows of numbers of equal length; freed by the caller. NULL with a fault. *columns is 1 for a
   flat one. */
double *eo_optimizer_case_numbers(struct eo_case *list, int *rows, int *columns);

/* Whether the object chooses the other word; the usual one stands for none. */
bool eo_optimizer_case_chooses(struct eo_case *object, const char *key, const char *usual, const char *other);

/* verify_prediction.c: blocks of a file; context: a struct eo_optimizer_verifier. */
eo_verify_function eo_verify_histories, eo_verify_predict, eo_verify_redundancy, eo_verify_decay, eo_verify_clean_up;

#endif

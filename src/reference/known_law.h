/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is known of the distribution of one number, against a sample of it. */
#ifndef EASEOFF_REFERENCE_KNOWN_LAW_H
#define EASEOFF_REFERENCE_KNOWN_LAW_H

#include "reference/verify_tolerance.h"

/* A sample of one response beside what is known of it. */
struct eo_known_law {
  struct eo_verification *v;
  int points;
  const double *value; /* [points] */
  double resolution;   /* beside what the sample leaves open */
};

extern const double eo_index_tolerance; /* of Sobol indices of a surface, as the files have it */

/* block: an object with mean, std and percentiles. Errors: memory. */
enum eo_code eo_verify_law(const struct eo_known_law *known, struct eo_case *block, struct eo_error *error);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What each part of the reproduction calls: the names of the variants, and progress. */
#include "reproduction/reproduction_private.h"

const char *const eo_reproduction_variant[VARIANTS + 1] = {
    "unmodified", "Table 3, case A", "Table 3, case B", "our optimum, case A", "our optimum, case B", NULL};

enum eo_code eo_reproduction_report(const struct reproduction *reproduction, const char *what, double fraction,
                                    struct eo_error *error)
{
  if (eo_progress_report(reproduction->plan->progress, what, fraction))
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  return EO_OK;
}

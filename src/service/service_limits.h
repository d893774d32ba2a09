/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What jobs may take of the machine and what is kept, as whoever runs the service says: one table for the configuration
   file, options and --help. */
#ifndef EASEOFF_SERVICE_SERVICE_LIMITS_H
#define EASEOFF_SERVICE_SERVICE_LIMITS_H

#include "format/table.h"

struct eo_service_limits {
  int queued_jobs, waiting_questions, prepared_pairs, attempts;
  double pair_memory_MB, pair_minutes; /* NaN: derived */
  double cache_GB;
  int kept_jobs, kept_preparations;
  double kept_predictions_days;
};

extern const struct eo_table eo_service_limits_table;

#endif

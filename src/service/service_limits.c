/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/service_limits.h"

static const struct eo_field fields[] = {
    EO_INTEGER(struct eo_service_limits, queued_jobs, "queued_jobs", 1, 100000, 100, "jobs of one kind that wait"),
    EO_INTEGER(struct eo_service_limits, waiting_questions, "waiting_questions", 1, 10000, 64,
               "analyses that wait; sweeps and work on measurements as many each"),
    EO_INTEGER(struct eo_service_limits, prepared_pairs, "prepared_pairs", 1, 1000, 4, "gear pairs kept in memory"),
    EO_INTEGER(struct eo_service_limits, attempts, "attempts", 1, 1000, 3,
               "times that a job is begun again after the process ended in the middle of it"),
    EO_NUMBER_DERIVED(struct eo_service_limits, pair_memory_MB, "pair_memory_MB", NULL, 64, 1e7,
                      "half of the machine's memory",
                      "for preparing a gear pair; one that is estimated above it is refused, one that takes more ends"),
    EO_NUMBER(struct eo_service_limits, pair_minutes, "pair_minutes", NULL, 0.01, 1e5, 60,
              "processor time for preparing a gear pair; as with memory"),
    EO_NUMBER(struct eo_service_limits, cache_GB, "cache_GB", NULL, 0, 1e6, 10,
              "prepared pairs kept on disk; beyond it those go that were not used for longest"),
    EO_INTEGER(struct eo_service_limits, kept_preparations, "kept_preparations", 0, 100000, 20,
               "preparations that have ended and stay in the list of jobs"),
    EO_INTEGER(struct eo_service_limits, kept_jobs, "kept_jobs", 0, 1000000, 0,
               "optimizations that have ended and stay, the newest; 0: all. Their evaluations stay in any case"),
    EO_NUMBER(struct eo_service_limits, kept_predictions_days, "kept_predictions_days", NULL, 0, 1e5, 0,
              "after which predicted fitness values of jobs that have ended go; 0: never"),
};
const struct eo_table eo_service_limits_table = EO_TABLE("limits of work", struct eo_service_limits, fields);

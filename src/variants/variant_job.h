/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study as a queued job. */
#ifndef EASEOFF_VARIANTS_VARIANT_JOB_H
#define EASEOFF_VARIANTS_VARIANT_JOB_H

#include "study/job_document.h"
#include "variants/variant_study.h"

/* Runs the study of a queued job. Errors: of eo_variant_study_run(); EO_ERROR_INPUT where the job is no study. */
enum eo_code eo_variant_job_run(struct eo_store *store, int64_t job, struct eo_crew *crew, eo_variant_watch *watch,
                                void *context, struct eo_variant_result *result, struct eo_error *error);

/* Takes over what a study reports, for whoever looks at its job: true evaluations are rows that have a result,
   individuals all of them. */
void eo_variant_job_follow(struct eo_job_live *live, const struct eo_variant_report *report);
void eo_variant_job_conclude(struct eo_job_live *live, const struct eo_variant_result *result);

#endif

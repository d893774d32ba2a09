/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the service computes from stored measurements and a prepared gear pair: comparison, the fit of unknown inputs, a
   synthetic recording. Each is a struct eo_work for eo_service_compute(), which owns its data. */
#ifndef EASEOFF_SERVICE_RIG_TASKS_H
#define EASEOFF_SERVICE_RIG_TASKS_H

#include "base/hash.h"
#include "document/rig_answer.h"
#include "document/rig_document.h"
#include "service/service.h"

/* What of a pair a recording is measured with: measurements of another one are left out of comparisons. */
void eo_rig_pair_hash(const struct eo_geometry *geometry, char hash[EO_HASH_LENGTH + 1]);

/* Measurements on their way into a computation. */
struct eo_rig_points {
  int count;
  struct eo_rig_point {
    int64_t id;
    char *summary;
    char pair[EO_HASH_LENGTH + 1];
  } * point; /* owned */
};
/* Errors: memory, EO_ERROR_INPUT beyond EO_MOST_MEASURED. */
enum eo_code eo_rig_points_add(struct eo_rig_points *points, int64_t id, const char *summary, const char *pair,
                               struct eo_error *error);
void eo_rig_points_done(struct eo_rig_points *points);

/* The functions below take points over, and fill work (unless there is no memory: then they release what they took).
   Their answers are the documents of document/rig_answer.h.

   Comparison; CSV: its table. */
enum eo_code eo_rig_comparison(struct eo_work *work, struct eo_rig_points *points, bool csv, struct eo_error *error);

/* Fit. given: the design as it was given, JSON; copied. */
enum eo_code eo_rig_fit(struct eo_work *work, struct eo_rig_points *points, const struct eo_update_settings *settings,
                        const char *given, struct eo_error *error);

/* Synthetic recording, as text. request: complete (eo_rig_complete()). Errors when it runs:
   EO_ERROR_INPUT for more than EO_RIG_MOST_ROWS rows. */
#define EO_RIG_MOST_ROWS 1000000
enum eo_code eo_rig_recording(struct eo_work *work, const struct eo_rig_request *request, struct eo_error *error);

#endif

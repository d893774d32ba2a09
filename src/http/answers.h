/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outlines of small answers, which schemas.h describes. Those of files that need the description of the API stand in
   answers.c, the others beside what writes them. */
#ifndef EASEOFF_HTTP_ANSWERS_H
#define EASEOFF_HTTP_ANSWERS_H

#include "document/examples.h"
#include "format/outline.h"
#include "http/storage_watch.h"

struct eo_health {
  int failing; /* 0 or 1 */
  const char *program;
  double uptime, free_megabytes;
  struct eo_queue_length {
    int64_t queued, running;
  } jobs;
  enum eo_storage_state database;
  json_t *warnings;
};
extern const struct eo_outline eo_outline_health, eo_outline_live; /* of a struct eo_health */

/* What a page makes its forms of; taken over. */
struct eo_form {
  json_t *design, *sweep, *fit;
};
extern const struct eo_outline eo_outline_form;

extern const struct eo_outline eo_outline_session;       /* session_routes.c */
extern const struct eo_outline eo_outline_exports;       /* export_routes.c */
extern const struct eo_outline eo_outline_check;         /* analysis_routes.c */
extern const struct eo_outline eo_outline_listed_design; /* stored_design.c: of a struct eo_stored_design */
extern const struct eo_outline eo_outline_stored_design;
extern const struct eo_outline eo_outline_stored; /* stored_measurement.c: what is known of its storage alone, */
extern const struct eo_outline eo_outline_stored_measurement, eo_outline_listed_measurement; /* and what was measured */
extern const struct eo_outline eo_outline_measurements;                                      /* measurement_routes.c */
extern const struct eo_outline eo_outline_designs;                                           /* design_routes.c */
extern const struct eo_outline eo_outline_jobs;                                              /* job_routes.c */
extern const struct eo_outline eo_outline_job_files;                                         /* reproduction_routes.c */

struct eo_listed_examples {
  json_t *items;
};
extern const struct eo_outline eo_outline_example; /* of a struct eo_example */
extern const struct eo_outline eo_outline_examples;

/* What is being prepared; job: taken over. */
struct eo_preparing {
  json_t *job;
};
extern const struct eo_outline eo_outline_preparing; /* job_reply.c */

#endif

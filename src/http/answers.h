/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outlines of small answers, each beside what writes it; schemas.h describes them. */
#ifndef EASEOFF_HTTP_ANSWERS_H
#define EASEOFF_HTTP_ANSWERS_H

#include "format/outline.h"

extern const struct eo_outline eo_outline_health, eo_outline_live; /* health_routes.c */
extern const struct eo_outline eo_outline_session;                 /* session_routes.c */
extern const struct eo_outline eo_outline_examples;                /* documents.c */
extern const struct eo_outline eo_outline_exports;                 /* export_routes.c */
extern const struct eo_outline eo_outline_check;                   /* analysis_routes.c */
extern const struct eo_outline eo_outline_listed_design;           /* stored_design.c: of a struct eo_stored_design */
extern const struct eo_outline eo_outline_stored_design;
extern const struct eo_outline eo_outline_designs;   /* design_routes.c */
extern const struct eo_outline eo_outline_jobs;      /* job_routes.c */
extern const struct eo_outline eo_outline_job_files; /* reproduction_routes.c */

/* What is being prepared; job: taken over. */
struct eo_preparing {
  json_t *job;
};
extern const struct eo_outline eo_outline_preparing; /* job_reply.c */

#endif

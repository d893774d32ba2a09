/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a process that works on a job of a server's queue (--work N) notes of it in the table, and learns from there. */
#ifndef EASEOFF_APP_WORK_NOTE_H
#define EASEOFF_APP_WORK_NOTE_H

#include "app/watch.h"
#include "store/queue.h"
#include "study/job_document.h"

struct eo_work_note {
  struct eo_store *store;
  int64_t job; /* 0: none, a terminal works for itself */
  struct eo_job_live live;
  double noted; /* ms */
  bool stop;    /* somebody asked for it, by the job's row */
};

/* Tells how far it is, now and then, and whether it shall stop. note->live was brought up to date. */
bool eo_work_note_shall_stop(struct eo_work_note *note, const struct eo_watch *watch);

/* The end of it: what is known, and an error as the job's. code: EO_OK, or that of the error. */
void eo_work_note_end(struct eo_work_note *note, enum eo_code code, const struct eo_error *error);

#endif

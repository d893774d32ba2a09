/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/work_note.h"

#include "base/clock.h"

enum { NOTE_MS = 400 };

/* A table that cannot be written at the moment is written the next time. */
static void note_progress(struct eo_work_note *note)
{
  struct eo_text text = {0};
  eo_job_live_write(&note->live, &text);
  if (!text.failed)
    eo_queue_note(note->store, note->job, text.data, NULL);
  eo_text_done(&text);
}

bool eo_work_note_shall_stop(struct eo_work_note *note, const struct eo_watch *watch)
{
  double now = eo_clock_milliseconds();
  if (!note->job || now - note->noted < NOTE_MS)
    return watch->stopped || note->stop;
  note->noted = now;
  note_progress(note);
  bool stop = false;
  if (!eo_store_job_shall_stop(note->store, note->job, &stop, NULL))
    note->stop = note->stop || stop;
  return watch->stopped || note->stop;
}

void eo_work_note_end(struct eo_work_note *note, enum eo_code code, const struct eo_error *error)
{
  struct eo_text fault = {0};
  if (note->job && !code)
    note_progress(note);
  else if (note->job) {
    eo_job_error_write(error, &fault);
    eo_queue_end(note->store, note->job, EO_JOB_FAILED, fault.failed ? NULL : fault.data, NULL, NULL);
  }
  eo_text_done(&fault);
  eo_job_live_done(&note->live);
}

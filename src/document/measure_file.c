/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/measure_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/layout_document.h"
#include "recording/reader.h"

struct work {
  struct eo_recording *recording;
  struct eo_notes notes;
  struct eo_layout_request layout;
  struct eo_tracks tracks;
  struct eo_measurement measurement;
  struct eo_faults faults;
};

/* A pointer into the layout becomes one into the request. */
static enum eo_code below_layout(enum eo_code code, struct eo_error *error)
{
  if (code == EO_ERROR_INPUT && error && *error->pointer) {
    char pointer[sizeof error->pointer];
    snprintf(pointer, sizeof pointer, "%s", error->pointer);
    snprintf(error->pointer, sizeof error->pointer, "/layout%.150s", pointer);
  }
  return code;
}

/* What the readers noted is part of why nothing came of a file: a channel that was left out may be an encoder's. */
static enum eo_code with_notes(enum eo_code code, const struct eo_notes *notes, int count, struct eo_error *error)
{
  size_t used = code == EO_ERROR_INPUT && error ? strlen(error->text) : sizeof error->text;
  for (int i = 0; i < count && used + strlen(notes->text[i]) + 2 <= sizeof error->text; i++)
    used += (size_t)sprintf(error->text + used, " %s", notes->text[i]);
  return code;
}

static enum eo_code read_recordings(struct work *work, const struct eo_measure_request *request,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  const struct eo_reader_options options = {
      .spool_directory = request->spool_directory, .seconds = request->seconds, .progress = progress};
  struct eo_recording *both[2] = {NULL, NULL};
  enum eo_code code = eo_reader_read(request->path, &options, &both[0], &work->notes, error);
  if (!code && request->gear_path) {
    code = eo_reader_read(request->gear_path, &options, &both[1], &work->notes, error);
    if (!code)
      code = below_layout(eo_layout_combine(both[0], both[1], &work->layout.choice, request->spool_directory,
                                            &work->recording, &work->notes, error),
                          error);
    work->layout.choice.time = work->layout.choice.gear_time = NULL; /* each file has its own now */
    eo_recording_free(both[0]);
    eo_recording_free(both[1]);
  } else {
    work->recording = both[0];
  }
  return code;
}

static enum eo_code measure(struct work *work, const struct eo_measure_request *request,
                            const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_measurement_settings settings = {.stated_speed = request->stated_speed,
                                             .spool_directory = request->spool_directory,
                                             .transmission = {.harmonics = request->harmonics}};
  settings.stated_torque = request->torque;
  settings.transmission.part = request->part;
  const bool stated = request->stated_speed > 0;
  struct eo_layout_pair pair = {
      .speed = {stated ? request->stated_speed : request->speed[0], stated ? request->stated_speed : request->speed[1]},
      .stated = stated};
  for (int i = 0; i < 2; i++) {
    pair.teeth[i] = request->geometry->teeth[i];
    settings.expected_speed[i] = request->speed[i];
    settings.transmission.teeth[i] = request->geometry->teeth[i];
    settings.transmission.base_radius[i] = request->geometry->base_radius[i];
  }
  eo_layout_decode(request->layout, &work->layout, &work->faults);
  EO_TRY(below_layout(eo_faults_first(&work->faults, error), error));
  enum eo_code code = read_recordings(work, request, progress, error);
  int read = work->notes.count;
  if (!code)
    code = below_layout(eo_layout_find(&work->recording, &work->layout.choice, &pair, request->spool_directory,
                                       &work->tracks, &work->notes, error),
                        error);
  EO_TRY(with_notes(code, &work->notes, read, error));
  return eo_measurement_run(&work->measurement, work->recording, &work->tracks, &settings, progress, error);
}

static enum eo_code tell(const struct work *work, const struct eo_measure_request *request, json_t **document,
                         struct eo_text *summary, struct eo_measured *outcome, struct eo_error *error)
{
  double torque = request->torque > 0 ? request->torque : work->measurement.load.pinion_torque;
  const char *slash = strrchr(request->path, '/'), *name = request->name ? request->name
                                                           : slash       ? slash + 1
                                                                         : request->path;
  json_t *layout = eo_layout_encode(&work->tracks);
  const struct eo_measurement_label label = {.file = name,
                                             .unmodified = request->unmodified,
                                             .torque = torque,
                                             .end = request->end,
                                             .notes = &work->notes,
                                             .layout = layout};
  *document = layout ? eo_measurement_encode(&work->measurement, &label) : NULL;
  if (*document && summary)
    eo_measurement_summary(&work->measurement, &label, summary);
  json_decref(layout);
  if (!*document)
    return eo_error_memory(error);
  if (outcome) {
    memset(outcome, 0, sizeof *outcome);
    if (!work->measurement.refused)
      eo_measured_take(outcome, &work->measurement.transmission, &work->measurement.findings);
    snprintf(outcome->name, sizeof outcome->name, "%s", name);
    outcome->unmodified = request->unmodified;
    outcome->torque = torque;
    outcome->end = request->end;
  }
  return EO_OK;
}

enum eo_code eo_measure_file(const struct eo_measure_request *request, const struct eo_progress *progress,
                             json_t **document, struct eo_text *summary, struct eo_measured *outcome,
                             struct eo_error *error)
{
  struct work *work = calloc(1, sizeof *work);
  if (!work)
    return eo_error_memory(error);
  enum eo_code code = measure(work, request, progress, error);
  if (!code)
    code = tell(work, request, document, summary, outcome, error);
  eo_measurement_done(&work->measurement);
  eo_recording_free(work->recording);
  free(work);
  return code;
}

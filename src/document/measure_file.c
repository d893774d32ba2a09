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

static enum eo_code read_recordings(struct work *w, const struct eo_measure_request *r,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  const struct eo_reader_options options = {
      .spool_directory = r->spool_directory, .seconds = r->seconds, .progress = progress};
  struct eo_recording *both[2] = {NULL, NULL};
  enum eo_code code = eo_reader_read(r->path, &options, &both[0], &w->notes, error);
  if (!code && r->gear_path) {
    code = eo_reader_read(r->gear_path, &options, &both[1], &w->notes, error);
    if (!code)
      code = below_layout(
          eo_layout_combine(both[0], both[1], &w->layout.choice, r->spool_directory, &w->recording, &w->notes, error),
          error);
    w->layout.choice.time = w->layout.choice.gear_time = NULL; /* each file has its own now */
    eo_recording_free(both[0]);
    eo_recording_free(both[1]);
  } else {
    w->recording = both[0];
  }
  return code;
}

static enum eo_code measure(struct work *w, const struct eo_measure_request *r, const struct eo_progress *progress,
                            struct eo_error *error)
{
  struct eo_measurement_settings settings = {.stated_speed = r->stated_speed,
                                             .spool_directory = r->spool_directory,
                                             .transmission = {.harmonics = r->harmonics}};
  settings.stated_torque = r->torque;
  settings.transmission.part = r->part;
  struct eo_layout_pair pair = {.speed = {r->speed[0], r->speed[1]}};
  for (int i = 0; i < 2; i++) {
    pair.teeth[i] = r->geometry->teeth[i];
    settings.expected_speed[i] = r->speed[i];
    settings.transmission.teeth[i] = r->geometry->teeth[i];
    settings.transmission.base_radius[i] = r->geometry->base_radius[i];
  }
  eo_layout_decode(r->layout, &w->layout, &w->faults);
  enum eo_code code = below_layout(eo_faults_first(&w->faults, error), error);
  if (!code)
    code = read_recordings(w, r, progress, error);
  if (!code)
    code = below_layout(
        eo_layout_find(&w->recording, &w->layout.choice, &pair, r->spool_directory, &w->tracks, &w->notes, error),
        error);
  if (!code)
    code = eo_measurement_run(&w->measurement, w->recording, &w->tracks, &settings, progress, error);
  return code;
}

static enum eo_code tell(const struct work *w, const struct eo_measure_request *r, json_t **document,
                         struct eo_text *summary, struct eo_measured *outcome, struct eo_error *error)
{
  double torque = r->torque > 0 ? r->torque : w->measurement.load.pinion_torque;
  const char *slash = strrchr(r->path, '/'), *name = r->name ? r->name : slash ? slash + 1 : r->path;
  json_t *layout = eo_layout_encode(&w->tracks);
  const struct eo_measurement_label label = {
      .file = name, .unmodified = r->unmodified, .torque = torque, .end = r->end, .notes = &w->notes, .layout = layout};
  *document = layout ? eo_measurement_encode(&w->measurement, &label) : NULL;
  if (*document && summary)
    eo_measurement_summary(&w->measurement, &label, summary);
  json_decref(layout);
  if (!*document)
    return eo_error_memory(error);
  if (outcome) {
    memset(outcome, 0, sizeof *outcome);
    if (!w->measurement.refused)
      eo_measured_take(outcome, &w->measurement.transmission, &w->measurement.findings);
    snprintf(outcome->name, sizeof outcome->name, "%s", name);
    outcome->unmodified = r->unmodified;
    outcome->torque = torque;
    outcome->end = r->end;
  }
  return EO_OK;
}

enum eo_code eo_measure_file(const struct eo_measure_request *request, const struct eo_progress *progress,
                             json_t **document, struct eo_text *summary, struct eo_measured *outcome,
                             struct eo_error *error)
{
  struct work *w = calloc(1, sizeof *w);
  if (!w)
    return eo_error_memory(error);
  enum eo_code code = measure(w, request, progress, error);
  if (!code)
    code = tell(w, request, document, summary, outcome, error);
  eo_measurement_done(&w->measurement);
  eo_recording_free(w->recording);
  free(w);
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One rig file to its measurement document: read, lay out, measure, encode. The terminal and the service call this. */
#ifndef EASEOFF_DOCUMENT_MEASURE_FILE_H
#define EASEOFF_DOCUMENT_MEASURE_FILE_H

#include "document/measurement_document.h"
#include "gear/geometry.h"

struct eo_measure_request {
  const char *path,
      *gear_path;   /* the recording; gear_path: the other encoder's of the same run, NULL when one file holds both */
  const char *name; /* for people; NULL: the path without folders */
  bool unmodified;
  double torque;       /* N m; NaN: not known, that of a column of the recording counts */
  double stated_speed; /* rad/s; NaN: not known */
  double speed[2];     /* of the pinion in the load cases of the design, lowest and highest, rad/s; 0: not known */
  int end;
  int harmonics; /* 0: 8 */
  struct eo_part_choice part;
  const json_t *layout; /* borrowed; NULL: guessed */
  const struct eo_geometry *geometry;
  const char *spool_directory; /* NULL: recordings beyond EO_RECORDING_MEMORY are refused */
  double seconds;              /* see struct eo_reader_options; 0: its own */
};

/* *document: new. summary may be NULL: what people read is added to it. *outcome (may be NULL): what a comparison
   needs; its harmonics are 0 when the recording was refused. Errors: EO_ERROR_INPUT of the file (line or byte) or the
   layout (pointer below /layout), files, memory, cancelled. */
enum eo_code eo_measure_file(const struct eo_measure_request *request, const struct eo_progress *progress,
                             json_t **document, struct eo_text *summary, struct eo_measured *outcome,
                             struct eo_error *error);

#endif

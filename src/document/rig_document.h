/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The synthetic rig: what it is asked for, and its recording as a text file. */
#ifndef EASEOFF_DOCUMENT_RIG_DOCUMENT_H
#define EASEOFF_DOCUMENT_RIG_DOCUMENT_H

#include <stdio.h>

#include <jansson.h>

#include "format/table.h"
#include "gear/geometry.h"
#include "measurement/prediction.h"
#include "measurement/synthetic.h"

enum eo_rig_separator { EO_RIG_COMMA, EO_RIG_SEMICOLON, EO_RIG_TAB, EO_RIG_BLANK };
enum eo_rig_heading { EO_RIG_NAMES, EO_RIG_UNITS_ROW, EO_RIG_BLOCK, EO_RIG_BARE };

struct eo_rig_request {
  double torque, speed; /* of the pinion; NaN: of the load case with the largest share */
  int end;              /* where the encoders sit */
  bool unmodified;
  int harmonics; /* mesh orders of the response that are in the recording */
  struct eo_synthetic synthetic;
  double fault_row, fault_size; /* whole numbers */
  bool shows_torque;
  double shown_torque_change;
  enum eo_rig_separator separator;
  enum eo_rig_heading heading;
  bool decimal_comma, byte_order_mark, carriage_return;
};
extern const struct eo_table eo_rig_table;

/* Torque and speed that were not said, of the load case with the largest share. Errors: EO_ERROR_INPUT (settings that
   contradict each other). */
enum eo_code eo_rig_complete(struct eo_rig_request *request, const struct eo_design *design, struct eo_error *error);

/* What the design does at the torque and speed of a complete request. Errors: those of eo_prediction_run();
   EO_ERROR_INPUT (no periodic vibration there). */
enum eo_code eo_rig_predict(const struct eo_rig_request *request, const struct eo_pair *pair,
                            const struct eo_design *design, struct eo_rig_prediction *prediction,
                            struct eo_error *error);

/* The pair and the response into request->synthetic. */
void eo_rig_set_pair(struct eo_rig_request *request, const struct eo_geometry *geometry,
                     const struct eo_supports *supports, const struct eo_rig_prediction *prediction);

/* Writes the recording; fine for recordings larger than memory. Errors: EO_ERROR_FILE. */
enum eo_code eo_rig_write(const struct eo_rig_request *request, const struct eo_progress *progress, FILE *stream,
                          struct eo_error *error);

/* A case file of kind "encoder" for `easeoff verify`: the truth of the recording in `file`. New; NULL without memory.
 */
json_t *eo_rig_truth(const struct eo_rig_request *request, const char *file);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a recording as people state it, in JSON; every key may be left out and is then guessed:
     { "kind": "angles" | "sine-cosine" | "pulses", "unit": "deg" | "rad" | "turn" | "count", "time": COLUMN | "none" |
   [PINION'S, GEAR'S], "time_unit": "s" | "ms" | "us" | "ns" | "min" | "d" | seconds, "columns": { "pinion": COLUMN |
   [SINE, COSINE], "gear": the same }, "sample_rate_Hz": 20000, "lines": 18000 | [pinion, gear] } A COLUMN is a name or
   a number from 1. */
#ifndef EASEOFF_DOCUMENT_LAYOUT_DOCUMENT_H
#define EASEOFF_DOCUMENT_LAYOUT_DOCUMENT_H

#include <jansson.h>

#include "format/faults.h"
#include "format/outline.h"
#include "format/table.h"
#include "recording/layout.h"

struct eo_layout_request {
  struct eo_layout_choice choice;
  char time[2][EO_RECORDING_NAME];      /* what the names of choice point to: [member] */
  char column[2][2][EO_RECORDING_NAME]; /* [member] */
};
extern const struct eo_table eo_asked_layout_table;

/* Fills *request, which must stay where it is while choice is used; NULL or null: everything is guessed. Unknown keys
   are faults. */
void eo_layout_decode(const json_t *document, struct eo_layout_request *request, struct eo_faults *faults);

extern const struct eo_outline eo_layout_outline;

/* What was found, with column numbers; a layout that gives the same tracks again. New; NULL without memory. */
json_t *eo_layout_encode(const struct eo_tracks *tracks);

#endif

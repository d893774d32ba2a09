/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Deviations of single teeth in the design document: the object `pitch`, with arrays, or the text of a table as a
   measuring machine writes it. */
#ifndef EASEOFF_DOCUMENT_PITCH_DOCUMENT_H
#define EASEOFF_DOCUMENT_PITCH_DOCUMENT_H

#include <jansson.h>

#include "design/design.h"
#include "format/faults.h"
#include "format/table.h"

extern const struct eo_table eo_pitch_table;

/* A number of a member by its key (eccentricity_um), and where it stands in struct eo_pitch_member; NULL: none. */
const struct eo_field *eo_pitch_member_number(const char *key, size_t *offset);

/* Reads the object (NULL or null: teeth are alike); faults with their place. *pitch is made anew. */
void eo_pitch_decode(const json_t *object, const struct eo_gear_pair *pair, struct eo_pitch *pitch,
                     struct eo_faults *faults);

/* New object; null where nothing is stated; NULL without memory. */
json_t *eo_pitch_encode(const struct eo_pitch *pitch, int ends);

/* A table of teeth as text: a row of headings, among them "tooth" and one of "index_um" and "single_um" (single pitch
   deviations f_i = F_i - F_i-1, which add up to 0 round the gear, and are added up from tooth 0 on); further ones are
   "profile_slope_um", "helix_slope_um", "profile_crowning_um", "lead_crowning_um" and, in a table of more than one
   flank, "member", "end" and "flank". Teeth are counted from 0 or from 1, each once; commas, semicolons or tabs
   separate, decimal commas where semicolons or tabs do; lines that begin with # are left out. Puts arrays into an
   object like `pitch` (whole) or like one of its flanks; faults name line and column. Errors: EO_ERROR_INPUT, memory.
 */
enum eo_code eo_pitch_from_text(const char *text, bool whole, json_t *object, struct eo_error *error);

#endif

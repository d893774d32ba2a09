/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two files of a result's hunting period share. */
#ifndef EASEOFF_DOCUMENT_RESULT_PITCH_PRIVATE_H
#define EASEOFF_DOCUMENT_RESULT_PITCH_PRIVATE_H

#include "document/result_private.h"

/* What is written of each end, by others. */
struct eo_pitch_ends {
  bool two;
  json_t *end[2];
};
#define EO_PITCH_END_ROWS(outline_)                                                                     \
  EO_KEY("left", "object", "left end", .outline = outline_, EO_AT(struct eo_pitch_ends, end[EO_LEFT])), \
      EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = outline_,                  \
             EO_AT(struct eo_pitch_ends, end[EO_RIGHT]), EO_IF(struct eo_pitch_ends, two))

extern const struct eo_outline eo_outline_pitch_case;

/* New; NULL without memory. */
json_t *eo_result_pitch_case(const struct eo_result_source *source, int load_case);

#endif

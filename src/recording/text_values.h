/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the cells of a row are worth. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_VALUES_H
#define EASEOFF_RECORDING_TEXT_VALUES_H

#include "recording/text_cell.h"
#include "recording/text_format.h"

/* Dates and times of the rows so far. */
struct eo_text_moments {
  bool based[EO_TEXT_CELLS];    /* [cells] of moments: day and before are known */
  int64_t day[EO_TEXT_CELLS];   /* from whose beginning moments are counted */
  double before[EO_TEXT_CELLS]; /* s, the moment of the row before */
};

/* The value of place c of a row that was split into cells: as the place's content says, moments in s from the beginning
   of the first row's day, which becomes the epoch of the place's clock. NaN where the cell holds none. */
enum eo_cell_kind eo_text_value(struct eo_text_format *format, struct eo_text_moments *moments,
                                const struct eo_cell *cells, int c, double *value);

#endif

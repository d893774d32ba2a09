/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows in which each value has its name before it: "t=0.5,pinion=12.3", "A:123 B:456", "08:59:30.5 -> angle: 12.3 deg".
   Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_NAMED_H
#define EASEOFF_RECORDING_TEXT_NAMED_H

#include "recording/text_cell.h"

#include <stdint.h>

/* As eo_text_next_cell(): a value and its name, whatever parts it from the next, or a word or number that has none,
   without the brackets around it. comma: a comma between digits is a decimal one; else it parts cells before the first
   name, and behind a name belongs to the value, so that nothing is cut at a decimal comma. */
bool eo_text_named_cell(const char **at, const char *end, bool comma, struct eo_cell *cell);

/* A number that stands for a cell's name; 0: it has none. */
uint64_t eo_text_name_key(const struct eo_cell *cell);

#endif

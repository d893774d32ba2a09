/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The distribution that a row of the block `tolerance` states, and how it is said in words. */
#ifndef EASEOFF_DOCUMENT_SCATTER_DISTRIBUTION_H
#define EASEOFF_DOCUMENT_SCATTER_DISTRIBUTION_H

#include "base/error.h"
#include "tolerance/scatter.h"
#include "tolerance/tolerance_settings.h"

/* "KEY: why" at a key of the row; pointer: the row in the document, or whatever else brought it, which is pointed at
   itself. */
enum eo_code eo_scatter_refuse_row(const struct eo_scatter_row *row, const char *pointer, const char *key,
                                   const char *why, struct eo_error *error);

/* input->deviation, and the group that it belongs to. EO_ERROR_INPUT: what is missing, contradicts, or is not used by
   the distribution. */
enum eo_code eo_scatter_set_distribution(struct eo_scatter_input *input, const struct eo_tolerance_settings *settings,
                                         const struct eo_scatter_row *row, const char *pointer, struct eo_error *error);

/* Whether a draw can differ from the nominal value. */
bool eo_scatter_moves(const struct eo_distribution *deviation);

/* In words, "normal, sigma 3.25, cut at 2.5 sigma". */
void eo_scatter_words(const struct eo_scatter_input *input, char *text, size_t size);

#endif

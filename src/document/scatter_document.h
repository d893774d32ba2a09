/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a design's block `tolerance` to inputs that scatter: keys looked up in the field tables, presets put into
   numbers. */
#ifndef EASEOFF_DOCUMENT_SCATTER_DOCUMENT_H
#define EASEOFF_DOCUMENT_SCATTER_DOCUMENT_H

#include "document/design_document.h"
#include "tolerance/scatter.h"

/* Inputs of a complete design, settled, of struct eo_design. assume_class: a block without preset and inputs means
   class 5 of ISO 1328-1:2013, and *assumed (may be NULL) says so. Errors: EO_ERROR_INPUT with the place in the block
   (no such key, what is no number of the evaluation, limits of the standard), memory. */
enum eo_code eo_scatter_of_design(struct eo_scatter *scatter, const struct eo_design *design, bool assume_class,
                                  bool *assumed, struct eo_error *error);

/* Draws the pairs of a robust objective into design->drawn; none are drawn where it asks for none. Errors: as above,
   and too many inputs. */
enum eo_code eo_scatter_draw_pairs(struct eo_design *design, struct eo_error *error);

/* Pairs first .. first + pairs - 1 of `points` in the sequence of the block, into design->drawn, whatever the objective
   asks for. Errors: the same. */
enum eo_code eo_scatter_draw_range(struct eo_design *design, int first, int pairs, int points, struct eo_error *error);

#endif

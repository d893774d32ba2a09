/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Single teeth among what scatters: numbers of the block `pitch`, seeds, whether their hunting period can be computed.
 */
#ifndef EASEOFF_DOCUMENT_SCATTER_TEETH_H
#define EASEOFF_DOCUMENT_SCATTER_TEETH_H

#include "design/design.h"
#include "format/table.h"
#include "tolerance/scatter.h"

/* A number of a member's teeth. */
struct eo_tooth_number {
  char key[EO_SCATTER_NAME]; /* "pitch.pinion.eccentricity_um" */
  const struct eo_field *field;
  size_t offset; /* in struct eo_design */
};

/* Whether a name behind "pitch." means one of the member; `*` stands for both. */
bool eo_scatter_find_tooth_number(const char *name, int member, struct eo_tooth_number *number);

/* Which teeth a pair has: behind all other inputs, so that what is drawn for these stays. Errors: EO_ERROR_INPUT (too
   many inputs). */
enum eo_code eo_scatter_add_seeds(struct eo_scatter *scatter, struct eo_error *error);

/* toothed: the design with its teeth stated. EO_ERROR_INPUT with the key, of this block where the class is its. */
enum eo_code eo_scatter_check_teeth(const struct eo_design *design, const struct eo_design *toothed,
                                    struct eo_error *error);

#endif

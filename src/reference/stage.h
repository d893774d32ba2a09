/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stage of the chain alone, with explicit input: a pair of structs with field tables, and the function between
   them. */
#ifndef EASEOFF_REFERENCE_STAGE_H
#define EASEOFF_REFERENCE_STAGE_H

#include "base/error.h"
#include "format/table.h"

struct eo_stage {
  const char *name;
  const char *summary; /* one line */
  const struct eo_table *input, *output;
  bool has_design; /* the input struct starts with a struct eo_design; what the input table leaves out of it has its
                      default */
  /* Both structs belong to the caller; *output is zeroed before. Series in *output are allocated with malloc() and
     freed by the caller, also after an error. */
  enum eo_code (*run)(const void *input, void *output, struct eo_error *error);
};

extern const struct eo_stage eo_stage_geometry, eo_stage_modification, eo_stage_surface, eo_stage_gap, eo_stage_tca,
    eo_stage_flexibility, eo_stage_hertz, eo_stage_contact, eo_stage_impact, eo_stage_root_stress, eo_stage_iso6336,
    eo_stage_dynamics, eo_stage_sdof, eo_stage_objective, eo_stage_evaluation;

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file of kind `contact` and what its blocks share. */
#ifndef EASEOFF_REFERENCE_CONTACT_CASE_H
#define EASEOFF_REFERENCE_CONTACT_CASE_H

#include "evaluation/evaluator.h"
#include "reference/case_pair.h"

/* A pair prepared for one design, and its evaluator. */
struct eo_contact_rig {
  struct eo_design design;
  struct eo_pair *pair;
  struct eo_evaluator *evaluator;
};

/* Pair and evaluator of rig->design. eo_contact_rig_done() also after an error: of eo_pair_new(), memory. */
enum eo_code eo_contact_rig_prepare(struct eo_contact_rig *rig, const struct eo_pair_options *options,
                                    struct eo_error *error);
void eo_contact_rig_done(struct eo_contact_rig *rig);

struct eo_contact_case {
  struct eo_case *file, *mods; /* mods: modification.mods, may be NULL */
  struct eo_verification *v;
  struct eo_design design; /* of macro.input */
  struct eo_geometry geometry;
  enum eo_tilt_rule tilt_rule;  /* what the file's conventions say */
  struct eo_contact_rig sector; /* with finite elements, prepared when first wanted */
};

/* Reads macro.input and every modification, so that none passes with a misspelt key. Errors: what the geometry refuses;
   faults of the file. */
enum eo_code eo_contact_case_init(struct eo_contact_case *contact_case, struct eo_case *file,
                                  struct eo_verification *verification, struct eo_error *error);

void eo_contact_case_done(struct eo_contact_case *contact_case);

/* The modification of that name in the file. where: of the fault when there is none. */
void eo_contact_case_modification(struct eo_contact_case *contact_case, const char *name, struct eo_case *where,
                                  struct eo_flank_modification *flank);

/* Both flanks of the pinion: what a case names by "left" and "right", by "mod", or by the first word of its "case" or
   "name". */
void eo_contact_case_modify(struct eo_contact_case *contact_case, struct eo_case *item, struct eo_design *design);

/* [left, right] of a case, where it has the key. */
void eo_contact_case_ends(struct eo_contact_case *contact_case, struct eo_case *item, const char *key,
                          const double value[2], double relative, double absolute);

#endif

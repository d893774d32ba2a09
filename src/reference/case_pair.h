/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the contact, CalculiX and evaluation cases share: gear pairs, modifications and closed-form compliances in the
   case files' words (mm, N, rad; "z", "mn", "alpha_n_deg" ...). What cannot be understood is a fault of the file. */
#ifndef EASEOFF_REFERENCE_CASE_PAIR_H
#define EASEOFF_REFERENCE_CASE_PAIR_H

#include "contact/corner.h"
#include "flexibility/closed_form.h"
#include "design/design.h"
#include "gear/geometry.h"
#include "reference/verify.h"

extern const char *const eo_case_end_name[4]; /* left, right, single: the one end of a pair that has one; then NULL */

/* A design with the defaults of everything the block does not say, aligned, without modification, with one load case.
   Angles in degrees, with or without "_deg". */
void eo_case_design(struct eo_case *input, struct eo_design *design);

/* Compares every member of the block with the geometry: mt, at, bb, r1, ... in lengths of 1/scale metres (1e3: mm). */
void eo_case_check_geometry(struct eo_verification *verification, struct eo_case *output,
                            const struct eo_geometry *geometry, double scale, double relative);

/* d_tr, d_br, a_m, a_l per mm or with _um and per um; u_ts, u_bs in mm. NULL: none. */
void eo_case_modification(struct eo_case *block, const struct eo_gear_pair *pair, struct eo_flank_modification *flank);

/* The modification called `name` among mods; unmod, unmodified and none need not be there. where: of the fault. */
void eo_case_named_modification(struct eo_case *mods, const char *name, struct eo_case *where,
                                const struct eo_gear_pair *pair, struct eo_flank_modification *flank);

/* A block's "crossing" and "inplane", rad, or words like "0.1 deg in-plane", "none"; NULL: aligned. */
void eo_case_misalignment(struct eo_case *value, struct eo_alignment *alignment);

/* How a file takes shaft angle errors and relief: by its words in "defaults" and "conventions" (a sum "+ misalignment"
   or a "misalignment slope" is the short form on the path, "at the pinion radius of the corner" the short form at tip
   corners), unless "tip_corner_convention" there says "rotation" or "radius", which it must then; a rotation when
   nothing is said. */
enum eo_tilt_rule eo_case_tilt_rule(struct eo_case *file);

/* The kernel written out as text: "C(i,j) = 1.5e-6*exp(-|eta_i-eta_j|/12)*f(s_i)f(s_j) mm/N ...; f =
   1+0.02|s+0.8|+0.004(s+0.8)^2". */
void eo_case_closed_form(struct eo_case *text, struct eo_closed_form *form);

/* The number before a phrase ("60 equal cells per line") in words of the file, or the fallback. */
int eo_case_count(struct eo_case *object, const char *key, const char *phrase, int fallback);

/* A text that begins with "on" or "off". */
bool eo_case_on(struct eo_case *object, const char *key, bool missing);

/* A key that is a number: "-14.0": {...}. */
double eo_case_key_number(const struct eo_case *value);

#endif

/* What the contact, CalculiX and evaluation cases share: gear pairs, modifications and closed-form compliances in the
   case files' words (mm, N, rad; "z", "mn", "alpha_n_deg" ...). */
#ifndef EASEOFF_REFERENCE_CASE_PAIR_H
#define EASEOFF_REFERENCE_CASE_PAIR_H

#include <jansson.h>

#include "reference/verify.h"
#include "flexibility/closed_form.h"
#include "design/design.h"

/* A design with the defaults of everything the block does not say, aligned, without modification, with one load case.
   Angles in degrees, with or without "_deg". Errors: EO_ERROR_INPUT when the block lacks a number. */
enum eo_code eo_case_design(const json_t *input, struct eo_design *design, struct eo_error *error);

/* d_tr, d_br, a_m, a_l per mm or with _um and per um; u_ts, u_bs in mm. NULL: none. */
void eo_case_modification(const json_t *block, const struct eo_gear_pair *pair, struct eo_flank_modification *flank);

/* A block's "crossing" and "inplane", rad, or words like "0.1 deg in-plane". */
void eo_case_misalignment(const json_t *value, struct eo_alignment *alignment);

/* The kernel written out as text: "C(i,j) = 1.5e-6*exp(-|eta_i-eta_j|/12)*f(s_i)f(s_j) mm/N ...; f =
   1+0.02|s+0.8|+0.004(s+0.8)^2". False when it is not of that form. */
bool eo_case_closed_form(const char *text, struct eo_closed_form *form);

/* The number before a phrase ("60 equal cells per line"), or the fallback. */
int eo_case_count(const char *text, const char *phrase, int fallback);

#endif

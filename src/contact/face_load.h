/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the load of one end lies over the face and among the tooth pairs: the load distribution factors that a contact
   analysis gives instead of the formulae of ISO 6336-1. Of the nominal flanks as they are meshed: deviations that the
   gap field does not hold are not in it. */
#ifndef EASEOFF_CONTACT_FACE_LOAD_H
#define EASEOFF_CONTACT_FACE_LOAD_H

#include "contact/loaded.h"

enum { EO_FACE_SLICES = 32 };

struct eo_face_load {
  double eta[EO_FACE_SLICES];  /* middles of equal slices of the face, m */
  double load[EO_FACE_SLICES]; /* normal force per face width, all pairs together, mean over the mesh cycle, N/m */
  /* K_Hbeta = w_max/w_m of `load` (ISO 6336-1 7.2.1): averaged over the mesh cycle before the largest is taken, so that
     the sharing between pairs is not in it. */
  double face_factor;
  /* K_Halpha (8.1): the largest load of one pair over the one it has where the load lies evenly along all contact
     lines. At least 1: less would only mean that the sharing is better than even. */
  double share_factor;
  /* The largest line load anywhere over the mean of all contact lines over the mesh cycle: face and sharing at once. */
  double line_factor;
};

/* Zeros and factors NaN where the end carries nothing. */
void eo_face_load_find(struct eo_face_load *face, const struct eo_contact_grid *grid, const struct eo_loaded_end *end);

#endif

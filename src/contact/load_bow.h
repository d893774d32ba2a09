/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The approach Z of one mesh position of an end as a curve over its load, from its solution and from Z at the loads
   about it. */
#ifndef EASEOFF_CONTACT_LOAD_BOW_H
#define EASEOFF_CONTACT_LOAD_BOW_H

#include "contact/loaded.h"

/* Nodes at the neighbouring loads and at the load itself: x, the change of the load as a share of it, Z, m, and dZ/dx.
 */
struct eo_load_bow {
  double x[EO_LOADED_NEARBY + 1], z[EO_LOADED_NEARBY + 1], slope[EO_LOADED_NEARBY + 1];
};

/* Of position j of a result that was solved with the loads about it. */
void eo_load_bow_init(struct eo_load_bow *bow, const struct eo_loaded_end *loaded, int j);

/* Z, m: cubic between the nodes (Hermite), along the tangents beyond. Grows with x. */
double eo_load_bow_at(const struct eo_load_bow *bow, double x);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unloaded contact of one pair of teeth: two independent forms that must agree.
   (a) Litvin's: two exact surfaces touch where positions and normals coincide; five equations (Litvin and Fuentes 2004,
   chapter 9). (b) The smallest gap of the gap field along the potential contact line. */
#ifndef EASEOFF_CONTACT_UNLOADED_H
#define EASEOFF_CONTACT_UNLOADED_H

#include "contact/field.h"

enum eo_touch {
  EO_TOUCH_POINT, /* inside the flank */
  EO_TOUCH_EDGE,  /* at the end of the face or of the path of contact: no common tangent plane */
  EO_TOUCH_NONE,  /* the pair is not in mesh at this phase */
};

struct eo_unloaded {
  enum eo_touch touch;
  double
      transmission_error; /* of the gear, transverse along the line of action, m: 0 conjugate, negative when it lags */
  double path, eta;       /* s and eta of the contact, m */
  double residual;        /* (a): largest residual of the five equations, relative to m and to 1 */
};

/* (b) phase[n]: c of the pair, m. */
void eo_unloaded_minimum(const struct eo_gap_field *field, int n, const double *phase, struct eo_unloaded *result);

/* Shaft angle errors of the gear axis about a pivot on it; see eo_gap_field_init(). */
struct eo_shaft_errors {
  double in_plane, out_of_plane; /* rad, as one end sees them: kappa, gamma times -1 (left) or +1 (right) */
  double pivot;                  /* eta of the pivot, m */
};

/* (a) Exact surfaces, with the errors as rigid rotations. field: of the same end, for the seeds. Errors: memory. */
enum eo_code eo_unloaded_exact(const struct eo_gap_field *field, const struct eo_shaft_errors *errors, int n,
                               const double *phase, struct eo_unloaded *result, struct eo_error *error);

#endif

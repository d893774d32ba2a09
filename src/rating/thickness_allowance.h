/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tooth thickness allowances by DIN 3967:1978: a series of the upper allowance (a .. h) and a series of the tolerance
   (21 .. 30), as in "cd25". The rows cd and c with 25 are checked at 11 places of published reports; the others are
   from one table, unchecked. */
#ifndef EASEOFF_RATING_THICKNESS_ALLOWANCE_H
#define EASEOFF_RATING_THICKNESS_ALLOWANCE_H

#include "base/error.h"

/* Normal section, at the reference cylinder, m; both <= 0 and upper >= lower. */
struct eo_thickness_allowance {
  double upper; /* A_sne: thickest tooth */
  double lower; /* A_sni = A_sne - T_sn */
};

/* series "a" .. "h", tolerance 21 .. 30, reference diameter above 0 up to 10000 mm. EO_ERROR_INPUT otherwise. */
enum eo_code eo_thickness_allowance(struct eo_thickness_allowance *allowance, const char *series, int tolerance,
                                    double reference_diameter, struct eo_error *error);

#endif

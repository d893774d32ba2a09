/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Line contact of two elastic bodies: Hertz's closed forms, and the local approach of two gear teeth. SI units; both
   bodies of the same material. */
#ifndef EASEOFF_CONTACT_HERTZ_H
#define EASEOFF_CONTACT_HERTZ_H

/* Half width b = sqrt(4 q rho / (pi E*)) and largest pressure p = 2 q / (pi b) of two cylinders of relative radius rho
   under the line load q (N/m); 1/E* = 2 (1 - nu^2)/E (Hertz 1882; Johnson, Contact Mechanics, 1985, (4.43), (4.45)). */
double eo_hertz_half_width(double line_load, double relative_radius, double youngs_modulus, double poissons_ratio);
double eo_hertz_pressure(double line_load, double relative_radius, double youngs_modulus, double poissons_ratio);

/* Approach of two tooth centre surfaces at a line contact (Weber and Banaschek 1953), without bending:
     delta = 2 (1 - nu^2)/(pi E) q [ln(4 h_p h_g / b^2) - nu/(1 - nu)],  b the half width above.
   With b^2 proportional to q this is delta = slope q (constant - ln q). */
struct eo_local_law {
  double slope;    /* 2 (1 - nu^2)/(pi E), m2/N */
  double constant; /* with q in N/m */
};

/* depth: from the flank to the tooth centre surface along the normal, [member], m. */
void eo_local_law_init(struct eo_local_law *law, double youngs_modulus, double poissons_ratio, double relative_radius,
                       const double depth[2]);

/* delta(q), m, and d delta / d q, m2/N, for q >= 0 (delta(0) = 0; the derivative there is infinite). */
double eo_local_law_approach(const struct eo_local_law *law, double line_load);
double eo_local_law_derivative(const struct eo_local_law *law, double line_load);

/* q at which the approach is delta >= 0, to rounding. The law has a maximum where the contact is as wide as the tooth
   is deep; beyond it, the line load of the maximum. */
double eo_local_law_load(const struct eo_local_law *law, double approach);

#endif

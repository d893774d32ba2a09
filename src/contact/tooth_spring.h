/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one pair of teeth carries at one position of the mesh cycle, over its own approach: a monotone cubic through a
   few knots, straight behind the last. */
#ifndef EASEOFF_CONTACT_TOOTH_SPRING_H
#define EASEOFF_CONTACT_TOOTH_SPRING_H

enum { EO_TOOTH_KNOTS = 5 };

struct eo_tooth_spring {
  int knots; /* 0: there is none */
  double
      approach[EO_TOOTH_KNOTS]; /* its own, less what the other pairs bend it, m; the first where it begins to carry */
  double load[EO_TOOTH_KNOTS], slope[EO_TOOTH_KNOTS], pressure[EO_TOOTH_KNOTS]; /* N, N/m, Pa */
  double most;                                                                  /* largest load seen, N */
  const double *off[2]; /* [member]: [teeth] what a tooth adds to its gap, m; NULL; borrowed */
};

/* One knot more; nothing where it is not beyond the last in both. At most EO_TOOTH_KNOTS. */
void eo_tooth_spring_add(struct eo_tooth_spring *spring, double approach, double load, double pressure);

/* Slopes of the knots there are, two at least. */
void eo_tooth_spring_settle(struct eo_tooth_spring *spring);

/* Load at an approach, N, and stiffness there, N/m: 0 before it begins to carry. */
double eo_tooth_spring_carry(const struct eo_tooth_spring *spring, double approach, double *stiffness);

/* Largest pressure at a load: its square is straight between knots. */
double eo_tooth_spring_pressure(const struct eo_tooth_spring *spring, double load);

#endif

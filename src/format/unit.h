/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of the document. Inside the program everything is SI; a key's suffix names the unit outside. */
#ifndef EASEOFF_FORMAT_UNIT_H
#define EASEOFF_FORMAT_UNIT_H

#include <stdbool.h>

struct eo_unit {
  const char *suffix; /* how a key of this unit ends, without the underscore */
  const char *symbol; /* for people */
  double factor;      /* SI value = document value * factor, or / factor when divide is set */
  bool divide;        /* powers of ten below one: dividing by an exact 10^n rounds once, multiplying by 10^-n twice */
};

extern const struct eo_unit eo_unit_mm, eo_unit_um, eo_unit_nm, eo_unit_deg, eo_unit_rpm, eo_unit_Nm, eo_unit_N,
    eo_unit_MPa, eo_unit_GPa, eo_unit_N_per_um, eo_unit_N_per_mm, eo_unit_N_per_mm_um, eo_unit_um_mm_per_N,
    eo_unit_Nm_per_rad, eo_unit_kg, eo_unit_kg_m2, eo_unit_kg_per_m3, eo_unit_um_per_N, eo_unit_per_mm, eo_unit_per_mm2,
    eo_unit_per_um, eo_unit_per_inch, eo_unit_kW, eo_unit_mm_per_s, eo_unit_m_per_s2, eo_unit_ms, eo_unit_Hz, eo_unit_h,
    eo_unit_m_per_s, eo_unit_mm2_per_s, eo_unit_per_GPa, eo_unit_C, eo_unit_K, eo_unit_W, eo_unit_HV, eo_unit_W_per_m_K,
    eo_unit_J_per_kg_K, eo_unit_urad, eo_unit_sqrt_MPa;

/* Document -> SI. unit NULL: dimensionless, the value itself. */
double eo_unit_in(const struct eo_unit *unit, double value);

/* SI -> document by the factor alone, and of that so many digits: what people and pages read. */
double eo_unit_near(const struct eo_unit *unit, double value);
double eo_unit_round(const struct eo_unit *unit, double value, int digits);

/* SI -> document: the shortest decimal whose eo_unit_in() is the same double. Not every double is the image of one;
   those that are not give the value whose image is nearest, so that in(out(x)) differs from x by one rounding at most
   and in(out(in(out(x)))) == in(out(x)) always. */
double eo_unit_out(const struct eo_unit *unit, double value);

#endif

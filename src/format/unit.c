/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/unit.h"

#include <math.h>
#include <stddef.h>

#include "format/digits.h"

const struct eo_unit eo_unit_mm = {"mm", "mm", 1e3, true};
const struct eo_unit eo_unit_um = {"um", "um", 1e6, true};
const struct eo_unit eo_unit_nm = {"nm", "nm", 1e9, true};
const struct eo_unit eo_unit_deg = {"deg", "deg", M_PI / 180, false};
const struct eo_unit eo_unit_rpm = {"rpm", "rpm", M_PI / 30, false};
const struct eo_unit eo_unit_Nm = {"Nm", "N m", 1, false};
const struct eo_unit eo_unit_N = {"N", "N", 1, false};
const struct eo_unit eo_unit_MPa = {"MPa", "MPa", 1e6, false};
const struct eo_unit eo_unit_GPa = {"GPa", "GPa", 1e9, false};
const struct eo_unit eo_unit_N_per_um = {"N_per_um", "N/um", 1e6, false};
const struct eo_unit eo_unit_N_per_mm = {"N_per_mm", "N/mm", 1e3, false};
const struct eo_unit eo_unit_N_per_mm_um = {"N_per_mm_um", "N/(mm um)", 1e9, false};
const struct eo_unit eo_unit_um_mm_per_N = {"um_mm_per_N", "um mm/N", 1e9, true};
const struct eo_unit eo_unit_um_per_N = {"um_per_N", "um/N", 1e6, true};
const struct eo_unit eo_unit_Nm_per_rad = {"Nm_per_rad", "N m/rad", 1, false};
const struct eo_unit eo_unit_kg = {"kg", "kg", 1, false};
const struct eo_unit eo_unit_kg_m2 = {"kg_m2", "kg m2", 1, false};
const struct eo_unit eo_unit_kg_per_m3 = {"kg_per_m3", "kg/m3", 1, false};
const struct eo_unit eo_unit_per_mm = {"per_mm", "1/mm", 1e3, false};
const struct eo_unit eo_unit_per_inch = {"per_inch", "1/in", 0.0254, true};
const struct eo_unit eo_unit_kW = {"kW", "kW", 1e3, false};
const struct eo_unit eo_unit_per_mm2 = {"per_mm2", "1/mm2", 1e6, false};
const struct eo_unit eo_unit_per_um = {"per_um", "1/um", 1e6, false};
const struct eo_unit eo_unit_mm_per_s = {"mm_per_s", "mm/s", 1e3, true};
const struct eo_unit eo_unit_m_per_s2 = {"m_per_s2", "m/s2", 1, false};
const struct eo_unit eo_unit_ms = {"ms", "ms", 1e3, true};
const struct eo_unit eo_unit_h = {"h", "h", 3600, false};
const struct eo_unit eo_unit_m_per_s = {"m_per_s", "m/s", 1, false};
const struct eo_unit eo_unit_mm2_per_s = {"mm2_per_s", "mm2/s", 1e6, true};
const struct eo_unit eo_unit_per_GPa = {"per_GPa", "1/GPa", 1e9, true};
const struct eo_unit eo_unit_C = {"C", "deg C", 1, false};
const struct eo_unit eo_unit_K = {"K", "K", 1, false};
const struct eo_unit eo_unit_W = {"W", "W", 1, false};
const struct eo_unit eo_unit_HV = {"HV", "HV", 1, false};
const struct eo_unit eo_unit_W_per_m_K = {"W_per_m_K", "W/(m K)", 1, false};
const struct eo_unit eo_unit_J_per_kg_K = {"J_per_kg_K", "J/(kg K)", 1, false};
const struct eo_unit eo_unit_urad = {"urad", "urad", 1e6, true};
const struct eo_unit eo_unit_sqrt_MPa = {"sqrt_MPa", "MPa^0.5", 1e3, false};
const struct eo_unit eo_unit_Hz = {"Hz", "Hz", 1, false};

double eo_unit_in(const struct eo_unit *unit, double value)
{
  if (!unit)
    return value;
  return unit->divide ? value / unit->factor : value * unit->factor;
}

double eo_unit_near(const struct eo_unit *unit, double value)
{
  if (!unit)
    return value;
  return unit->divide ? value * unit->factor : value / unit->factor;
}

double eo_unit_round(const struct eo_unit *unit, double value, int digits)
{
  double outside = eo_unit_near(unit, value);
  return isfinite(outside) ? eo_digits_round(outside, digits) : outside;
}

/* The decimal of fewest digits near guess that is read back as value; false when there is none. */
static bool find_decimal(const struct eo_unit *unit, double value, double guess, double *found)
{
  for (int digits = 13; digits <= 17; digits++) {
    *found = eo_digits_round(guess, digits);
    if (eo_unit_in(unit, *found) == value)
      return true;
  }
  double below = guess, above = guess;
  for (int i = 0; i < 3; i++) {
    below = nextafter(below, -INFINITY);
    above = nextafter(above, INFINITY);
    *found = eo_unit_in(unit, below) == value ? below : above;
    if (eo_unit_in(unit, *found) == value)
      return true;
  }
  return false;
}

double eo_unit_out(const struct eo_unit *unit, double value)
{
  if (!unit || unit->factor == 1 || !isfinite(value) || value == 0)
    return value;
  double guess = eo_unit_near(unit, value), found;
  if (!find_decimal(unit, value, guess, &found) && !find_decimal(unit, eo_unit_in(unit, guess), guess, &found))
    return guess;
  return found;
}

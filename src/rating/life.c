/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/life.h"

#include <math.h>

/* ISO 6336-2 table 2. */
struct eo_life_line eo_life_flank(enum eo_rating_material material, bool some_pitting, double long_life)
{
  switch (material) {
  case EO_NITRIDED_NITRIDING_STEEL:
  case EO_NITRIDED_THROUGH_STEEL:
    return (struct eo_life_line){3, {1e5, 2e6, 1e10}, {1.3, 1, long_life}};
  case EO_NITROCARBURISED:
    return (struct eo_life_line){3, {1e5, 2e6, 1e10}, {1.1, 1, long_life}};
  default:
    break;
  }
  if (some_pitting)
    return (struct eo_life_line){4, {6e5, 1e7, 1e9, 1e10}, {1.6, 1.3, 1, long_life}};
  return (struct eo_life_line){3, {1e5, 5e7, 1e10}, {1.6, 1, long_life}};
}

/* ISO 6336-3 table 1. */
struct eo_life_line eo_life_root(enum eo_rating_material material, double long_life)
{
  switch (material) {
  case EO_NITRIDED_NITRIDING_STEEL:
  case EO_NITRIDED_THROUGH_STEEL:
    return (struct eo_life_line){3, {1e3, 3e6, 1e10}, {1.6, 1, long_life}};
  case EO_NITROCARBURISED:
    return (struct eo_life_line){3, {1e3, 3e6, 1e10}, {1.1, 1, long_life}};
  case EO_CASE_HARDENED:
  case EO_FLAME_HARDENED:
    return (struct eo_life_line){3, {1e3, 3e6, 1e10}, {2.5, 1, long_life}};
  default:
    return (struct eo_life_line){3, {1e4, 3e6, 1e10}, {2.5, 1, long_life}};
  }
}

/* Slope of log factor over log cycles between the points i and i + 1. */
static double slope(const struct eo_life_line *line, int i)
{
  return log(line->factor[i + 1] / line->factor[i]) / log(line->cycles[i + 1] / line->cycles[i]);
}

double eo_life_factor(const struct eo_life_line *line, double cycles)
{
  int last = line->count - 1, i = 0;
  if (!(cycles > line->cycles[0]))
    return isnan(cycles) ? NAN : line->factor[0];
  if (cycles >= line->cycles[last])
    return line->factor[last];
  while (cycles > line->cycles[i + 1])
    i++;
  return line->factor[i] * pow(cycles / line->cycles[i], slope(line, i));
}

double eo_life_cycles(const struct eo_life_line *line, double stress_ratio)
{
  int piece = 0;
  while (piece < line->count - 2 && stress_ratio < line->factor[piece + 1])
    piece++;
  double exponent = slope(line, piece);
  if (exponent == 0)
    return stress_ratio > line->factor[piece] ? line->cycles[piece] : INFINITY;
  return line->cycles[piece] * pow(stress_ratio / line->factor[piece], 1 / exponent);
}

/* The knee is the point with factor 1. */
double eo_life_share(const struct eo_life_line *line, double cycles)
{
  int knee = 0;
  while (knee < line->count - 1 && line->factor[knee] > 1)
    knee++;
  double share = log(cycles / line->cycles[0]) / log(line->cycles[knee] / line->cycles[0]);
  return fmin(fmax(share, 0), 1);
}

/* Sum of n_i/N_i at the stresses times a safety (ISO 6336-6). */
static double damage_at(const struct eo_life_line *line, int count, const double *stress_ratio, const double *cycles,
                        double safety)
{
  double sum = 0;
  for (int i = 0; i < count; i++)
    if (stress_ratio[i] > 0)
      sum += cycles[i] / eo_life_cycles(line, safety * stress_ratio[i]);
  return sum;
}

double eo_life_damage(const struct eo_life_line *line, int count, const double *stress_ratio, const double *cycles)
{
  return damage_at(line, count, stress_ratio, cycles, 1);
}

double eo_life_class_stress(double stress, double torque, double factor, double other_torque, double other_factor)
{
  return stress * sqrt(other_torque * other_factor / (torque * factor));
}

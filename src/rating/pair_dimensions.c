/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/pair_dimensions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

double eo_centre_distance_allowance(double centre_distance)
{
  /* ISO 286-1 table 1, grade IT7: nominal sizes up to, mm, and the tolerance, um. */
  static const struct {
    short size, tolerance;
  } row[] = {{3, 10},   {6, 12},    {10, 15},    {18, 18},    {30, 21},    {50, 25},    {80, 30},
             {120, 35}, {180, 40},  {250, 46},   {315, 52},   {400, 57},   {500, 63},   {630, 70},
             {800, 80}, {1000, 90}, {1250, 105}, {1600, 125}, {2000, 150}, {2500, 175}, {3150, 210}};
  enum { ROWS = sizeof row / sizeof *row };
  for (int i = 0; i < ROWS; i++)
    if (1e3 * centre_distance <= row[i].size)
      return 0.5e-6 * row[i].tolerance;
  return 0.5e-6 * row[ROWS - 1].tolerance * centre_distance / (1e-3 * row[ROWS - 1].size);
}

static struct eo_tooth tooth_of(const struct eo_geometry *geometry, int i, double allowance)
{
  return (struct eo_tooth){.teeth = geometry->teeth[i],
                           .normal_module = geometry->normal_module,
                           .normal_pressure_angle = geometry->normal_pressure_angle,
                           .helix_angle = geometry->helix_angle,
                           .profile_shift = geometry->profile_shift[i],
                           .thickness_allowance = allowance,
                           .dedendum_coefficient = geometry->dedendum[i] / geometry->normal_module,
                           .fillet_radius_coefficient = geometry->fillet_radius[i] / geometry->normal_module};
}

/* The flanks can be spanned where a caliper's anvils find room: half a module beside the contact. */
static void set_span(struct eo_member_dimensions *dimensions, const struct eo_geometry *geometry, int i, int wanted)
{
  struct eo_tooth middle = tooth_of(geometry, i,
                                    (dimensions->allowance[EO_UPPER] + dimensions->allowance[EO_LOWER]) / 2);
  struct eo_error error;
  double anvil = geometry->normal_module / 2;
  dimensions->teeth_spanned = wanted;
  if (wanted ? eo_tooth_span_check(&middle, wanted, dimensions->form_diameter[EO_LOWER], dimensions->tip_diameter,
                                   geometry->member_width[i], anvil, &error)
             : eo_tooth_span_choose(&middle, dimensions->form_diameter[EO_LOWER], dimensions->tip_diameter,
                                    geometry->member_width[i], anvil, &dimensions->teeth_spanned, &error)) {
    dimensions->teeth_spanned = 0;
    snprintf(dimensions->span_reason, sizeof dimensions->span_reason, "%.190s", error.text);
  }
  for (int k = 0; k < EO_MEASURED; k++) {
    struct eo_tooth tooth = tooth_of(geometry, i, dimensions->allowance[k]);
    dimensions->span[k] = dimensions->teeth_spanned ? eo_tooth_span(&tooth, dimensions->teeth_spanned) : NAN;
  }
}

static void set_balls(struct eo_member_dimensions *dimensions, const struct eo_geometry *geometry, int i, double wanted)
{
  struct eo_tooth middle = tooth_of(geometry, i,
                                    (dimensions->allowance[EO_UPPER] + dimensions->allowance[EO_LOWER]) / 2);
  struct eo_error error;
  dimensions->ball = wanted;
  if (isnan(wanted) ? eo_tooth_ball_choose(&middle, dimensions->form_diameter[EO_LOWER], dimensions->tip_diameter,
                                           &dimensions->ball, &error)
                    : eo_tooth_ball_check(&middle, wanted, dimensions->form_diameter[EO_LOWER],
                                          dimensions->tip_diameter, &error)) {
    dimensions->ball = NAN;
    snprintf(dimensions->ball_reason, sizeof dimensions->ball_reason, "%.190s", error.text);
  }
  for (int k = 0; k < EO_MEASURED; k++) {
    struct eo_tooth tooth = tooth_of(geometry, i, dimensions->allowance[k]);
    struct eo_ball_dimension ball = {.over_one = NAN, .over_two = NAN, .over_pins = NAN};
    if (!isnan(dimensions->ball) && eo_tooth_over_balls(&tooth, dimensions->ball, &ball, &error))
      ball = (struct eo_ball_dimension){.over_one = NAN, .over_two = NAN, .over_pins = NAN};
    dimensions->over_one_ball[k] = ball.over_one;
    dimensions->over_two_balls[k] = ball.over_two;
    dimensions->over_pins[k] = ball.over_pins;
  }
}

static void set_member(struct eo_member_dimensions *dimensions, const struct eo_gear_pair *pair,
                       const struct eo_geometry *geometry, int i)
{
  const double *allowance = pair->thickness_allowance[i];
  memset(dimensions, 0, sizeof *dimensions);
  dimensions->reference_diameter = 2 * geometry->reference_radius[i];
  dimensions->base_diameter = 2 * geometry->base_radius[i];
  dimensions->tip_diameter = 2 * geometry->tip_radius[i];
  dimensions->active_start_diameter = 2 * geometry->start_radius[i];
  dimensions->allowance[EO_UPPER] = allowance[0];
  dimensions->allowance[EO_LOWER] = allowance[1];
  for (int k = 0; k < EO_MEASURED; k++) {
    struct eo_tooth tooth = tooth_of(geometry, i, dimensions->allowance[k]);
    dimensions->root_diameter[k] = eo_tooth_root_diameter(&tooth);
    dimensions->form_diameter[k] = eo_tooth_form_diameter(&tooth, NULL);
    dimensions->generating_shift[k] = eo_tooth_generating_shift(&tooth);
    dimensions->normal_thickness[k] = eo_tooth_normal_thickness(&tooth);
    dimensions->chord[k] = eo_tooth_chord(&tooth, dimensions->tip_diameter);
  }
  struct eo_tooth nominal = tooth_of(geometry, i, 0);
  dimensions->tip_thickness = eo_tooth_normal_thickness_at(&nominal, dimensions->tip_diameter);
  set_span(dimensions, geometry, i, pair->teeth_spanned[i]);
  set_balls(dimensions, geometry, i, pair->measuring_ball[i]);
}

/* NaN where the flanks of so thinned teeth never touch on both sides. */
static void set_backlash(struct eo_backlash *backlash, const struct eo_geometry *geometry, double pinion, double gear,
                         double distance)
{
  struct eo_error error;
  const struct eo_backlash_input input = {.teeth = {geometry->teeth[0], geometry->teeth[1]},
                                          .normal_module = geometry->normal_module,
                                          .normal_pressure_angle = geometry->normal_pressure_angle,
                                          .helix_angle = geometry->helix_angle,
                                          .profile_shift = {geometry->profile_shift[0], geometry->profile_shift[1]},
                                          .centre_distance = geometry->centre_distance,
                                          .allowance = {pinion, gear},
                                          .centre_distance_allowance = distance};
  if (eo_backlash(backlash, &input, &error))
    *backlash = (struct eo_backlash){NAN, NAN, NAN, NAN, NAN, NAN};
}

void eo_pair_dimensions_init(struct eo_pair_dimensions *dimensions, const struct eo_gear_pair *pair,
                             const struct eo_geometry *geometry)
{
  const double(*allowance)[2] = pair->thickness_allowance, distance = pair->centre_distance_allowance;
  dimensions->centre_distance_allowance = distance;
  for (int i = 0; i < 2; i++)
    set_member(&dimensions->member[i], pair, geometry, i);
  set_backlash(&dimensions->smallest, geometry, allowance[0][0], allowance[1][0], -distance);
  set_backlash(&dimensions->mean, geometry, (allowance[0][0] + allowance[0][1]) / 2,
               (allowance[1][0] + allowance[1][1]) / 2, 0);
  set_backlash(&dimensions->largest, geometry, allowance[0][1], allowance[1][1], distance);
}

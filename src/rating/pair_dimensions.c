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

static struct eo_tooth tooth_of(const struct eo_geometry *g, int i, double allowance)
{
  return (struct eo_tooth){.teeth = g->teeth[i],
                           .normal_module = g->normal_module,
                           .normal_pressure_angle = g->normal_pressure_angle,
                           .helix_angle = g->helix_angle,
                           .profile_shift = g->profile_shift[i],
                           .thickness_allowance = allowance,
                           .dedendum_coefficient = g->dedendum[i] / g->normal_module,
                           .fillet_radius_coefficient = g->fillet_radius[i] / g->normal_module};
}

/* The flanks can be spanned where a caliper's anvils find room: half a module beside the contact. */
static void set_span(struct eo_member_dimensions *m, const struct eo_geometry *g, int i, int wanted)
{
  struct eo_tooth middle = tooth_of(g, i, (m->allowance[EO_UPPER] + m->allowance[EO_LOWER]) / 2);
  struct eo_error error;
  double anvil = g->normal_module / 2;
  m->teeth_spanned = wanted;
  if (wanted ? eo_tooth_span_check(&middle, wanted, m->form_diameter[EO_LOWER], m->tip_diameter, g->member_width[i],
                                   anvil, &error)
             : eo_tooth_span_choose(&middle, m->form_diameter[EO_LOWER], m->tip_diameter, g->member_width[i], anvil,
                                    &m->teeth_spanned, &error)) {
    m->teeth_spanned = 0;
    snprintf(m->span_reason, sizeof m->span_reason, "%.190s", error.text);
  }
  for (int k = 0; k < EO_MEASURED; k++) {
    struct eo_tooth tooth = tooth_of(g, i, m->allowance[k]);
    m->span[k] = m->teeth_spanned ? eo_tooth_span(&tooth, m->teeth_spanned) : NAN;
  }
}

static void set_balls(struct eo_member_dimensions *m, const struct eo_geometry *g, int i, double wanted)
{
  struct eo_tooth middle = tooth_of(g, i, (m->allowance[EO_UPPER] + m->allowance[EO_LOWER]) / 2);
  struct eo_error error;
  m->ball = wanted;
  if (isnan(wanted) ? eo_tooth_ball_choose(&middle, m->form_diameter[EO_LOWER], m->tip_diameter, &m->ball, &error)
                    : eo_tooth_ball_check(&middle, wanted, m->form_diameter[EO_LOWER], m->tip_diameter, &error)) {
    m->ball = NAN;
    snprintf(m->ball_reason, sizeof m->ball_reason, "%.190s", error.text);
  }
  for (int k = 0; k < EO_MEASURED; k++) {
    struct eo_tooth tooth = tooth_of(g, i, m->allowance[k]);
    struct eo_ball_dimension ball = {.over_one = NAN, .over_two = NAN, .over_pins = NAN};
    if (!isnan(m->ball) && eo_tooth_over_balls(&tooth, m->ball, &ball, &error))
      ball = (struct eo_ball_dimension){.over_one = NAN, .over_two = NAN, .over_pins = NAN};
    m->over_one_ball[k] = ball.over_one;
    m->over_two_balls[k] = ball.over_two;
    m->over_pins[k] = ball.over_pins;
  }
}

static void set_member(struct eo_member_dimensions *m, const struct eo_gear_pair *pair, const struct eo_geometry *g,
                       int i)
{
  const double *allowance = pair->thickness_allowance[i];
  memset(m, 0, sizeof *m);
  m->reference_diameter = 2 * g->reference_radius[i];
  m->base_diameter = 2 * g->base_radius[i];
  m->tip_diameter = 2 * g->tip_radius[i];
  m->active_start_diameter = 2 * g->start_radius[i];
  m->allowance[EO_UPPER] = allowance[0];
  m->allowance[EO_LOWER] = allowance[1];
  for (int k = 0; k < EO_MEASURED; k++) {
    struct eo_tooth tooth = tooth_of(g, i, m->allowance[k]);
    m->root_diameter[k] = eo_tooth_root_diameter(&tooth);
    m->form_diameter[k] = eo_tooth_form_diameter(&tooth, NULL);
    m->generating_shift[k] = eo_tooth_generating_shift(&tooth);
    m->normal_thickness[k] = eo_tooth_normal_thickness(&tooth);
    m->chord[k] = eo_tooth_chord(&tooth, m->tip_diameter);
  }
  struct eo_tooth nominal = tooth_of(g, i, 0);
  m->tip_thickness = eo_tooth_normal_thickness_at(&nominal, m->tip_diameter);
  set_span(m, g, i, pair->teeth_spanned[i]);
  set_balls(m, g, i, pair->measuring_ball[i]);
}

/* NaN where the flanks of so thinned teeth never touch on both sides. */
static void set_backlash(struct eo_backlash *backlash, const struct eo_geometry *g, double pinion, double gear,
                         double distance)
{
  struct eo_error error;
  const struct eo_backlash_input input = {.teeth = {g->teeth[0], g->teeth[1]},
                                          .normal_module = g->normal_module,
                                          .normal_pressure_angle = g->normal_pressure_angle,
                                          .helix_angle = g->helix_angle,
                                          .profile_shift = {g->profile_shift[0], g->profile_shift[1]},
                                          .centre_distance = g->centre_distance,
                                          .allowance = {pinion, gear},
                                          .centre_distance_allowance = distance};
  if (eo_backlash(backlash, &input, &error))
    *backlash = (struct eo_backlash){NAN, NAN, NAN, NAN, NAN, NAN};
}

void eo_pair_dimensions_init(struct eo_pair_dimensions *dimensions, const struct eo_gear_pair *pair,
                             const struct eo_geometry *g)
{
  const double(*allowance)[2] = pair->thickness_allowance, distance = pair->centre_distance_allowance;
  dimensions->centre_distance_allowance = distance;
  for (int i = 0; i < 2; i++)
    set_member(&dimensions->member[i], pair, g, i);
  set_backlash(&dimensions->smallest, g, allowance[0][0], allowance[1][0], -distance);
  set_backlash(&dimensions->mean, g, (allowance[0][0] + allowance[0][1]) / 2, (allowance[1][0] + allowance[1][1]) / 2,
               0);
  set_backlash(&dimensions->largest, g, allowance[0][1], allowance[1][1], distance);
}

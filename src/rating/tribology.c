/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/tribology.h"

#include <math.h>

#include "contact/hertz.h"

/* ASTM D341 without its correction for thin oils. */
double eo_walther_viscosity(double viscosity_40, double viscosity_100, double temperature)
{
  const double zero = 273.15, low = log(40 + zero), high = log(100 + zero);
  double at_40 = log(log(1e6 * viscosity_40 + 0.7)), at_100 = log(log(1e6 * viscosity_100 + 0.7));
  double value = at_40 + (at_100 - at_40) * (log(temperature + zero) - low) / (high - low); /* theory (T3) */
  return 1e-6 * (exp(exp(value)) - 0.7);
}

/* R_q = 1.25 R_a of a surface with normally distributed heights, R_a = R_z/6. */
static double height_of(double peak_to_valley)
{
  return 1.25 * peak_to_valley / 6;
}

void eo_tribology_state_init(struct eo_tribology_state *state, const struct eo_geometry *geometry,
                             const struct eo_material *material, const struct eo_rating_settings *rating,
                             double pinion_speed)
{
  const struct eo_lubricant *oil = &rating->lubricant;
  const struct eo_rating_member *member = rating->member;
  *state = (struct eo_tribology_state){
      .geometry = geometry,
      .speed = {pinion_speed, pinion_speed * geometry->teeth[0] / geometry->teeth[1]},
      .viscosity = oil->density * eo_walther_viscosity(oil->viscosity_40, oil->viscosity_100, oil->tooth_temperature),
      .pressure_viscosity = oil->pressure_viscosity,
      .friction = oil->friction,
      .tooth_temperature = oil->tooth_temperature,
      .youngs_modulus = eo_material_contact_modulus(material),
      .poissons_ratio = material->poissons_ratio,
      .thermal_contact = eo_material_is_one(material)
                             ? sqrt(rating->thermal_conductivity * material->density * rating->specific_heat)
                             : (sqrt(material->density) + sqrt(eo_material_of(material, EO_GEAR).density)) / 2 *
                                   sqrt(rating->thermal_conductivity * rating->specific_heat),
      .roughness = hypot(height_of(member[0].flank_roughness), height_of(member[1].flank_roughness))};
}

/* Blok: 1.11 mu q |v_1 - v_2|/(B_M (sqrt v_1 + sqrt v_2) sqrt(2 b_H)). */
static double flash_of(const struct eo_tribology_state *state, const double velocity[2], double line_load,
                       double radius)
{
  const double semi_elliptic = 1.11;
  double half = eo_hertz_half_width(line_load, radius, state->youngs_modulus, state->poissons_ratio);
  double carried = state->thermal_contact * (sqrt(fmax(velocity[0], 0)) + sqrt(fmax(velocity[1], 0)));
  /* theory (T1) */
  return semi_elliptic * state->friction * line_load * fabs(velocity[0] - velocity[1]) / (carried * sqrt(2 * half));
}

/* Dowson and Higginson: h_min/R = 2.65 G^0.54 U^0.7/W^0.13, G = alpha E', U = eta u/(E' R), W = q/(E' R),
   u = (v_1 + v_2)/2, E' = E/(1 - nu^2). */
static double film_of(const struct eo_tribology_state *state, const double velocity[2], double line_load, double radius)
{
  double modulus = state->youngs_modulus / (1 - state->poissons_ratio * state->poissons_ratio),
         scale = modulus * radius;
  double rolling = (velocity[0] + velocity[1]) / 2;
  /* theory (T2) */
  return radius * 2.65 * pow(state->pressure_viscosity * modulus, 0.54) * pow(state->viscosity * rolling / scale, 0.7) /
         pow(line_load / scale, 0.13);
}

struct eo_tribology_point eo_tribology_at(const struct eo_tribology_state *state, double s, double line_load)
{
  const struct eo_geometry *geometry = state->geometry;
  const double velocity[2] = {state->speed[0] * (geometry->tangent_length[0] + s),
                              state->speed[1] * (geometry->tangent_length[1] - s)};
  double radius = eo_geometry_relative_radius(geometry, s);
  struct eo_tribology_point point = {.sliding = velocity[0] - velocity[1],
                                     .flash = flash_of(state, velocity, line_load, radius),
                                     .film = film_of(state, velocity, line_load, radius)};
  point.film_ratio = point.film / state->roughness;
  return point;
}

static void add_position(struct eo_tribology *sum, const struct eo_tribology_state *state,
                         const struct eo_contact_position *position, const double *line_load)
{
  for (int i = 0; i < position->points; i++) {
    double q = line_load[i];
    if (!(q > 0))
      continue;
    struct eo_tribology_point at = eo_tribology_at(state, position->path[i], q);
    sum->power_loss += state->friction * q * position->length[i] * fabs(at.sliding);
    if (position->kind[i] != EO_POINT_LINE)
      continue;
    sum->sliding = fmax(sum->sliding, fabs(at.sliding));
    sum->flash = fmax(sum->flash, at.flash);
    sum->film = fmin(sum->film, at.film);
    sum->film_ratio = fmin(sum->film_ratio, at.film_ratio);
  }
}

void eo_tribology_find(struct eo_tribology *tribology, const struct eo_tribology_state *state,
                       const struct eo_contact_grid *grid, const struct eo_loaded_end *end)
{
  struct eo_tribology sum = {.film = INFINITY, .film_ratio = INFINITY};
  for (int j = 0; j < grid->positions; j++)
    add_position(&sum, state, &grid->position[j], end->line_load + grid->position[j].first);
  sum.power_loss /= grid->positions;
  sum.contact_temperature = state->tooth_temperature + sum.flash;
  *tribology = sum;
}

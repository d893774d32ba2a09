/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/design_rating.h"
#include "numerics/periodic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_design_rating_new(struct eo_design_rating **result, int most_cases, struct eo_error *error)
{
  struct eo_design_rating *rating = calloc(1, sizeof *rating);
  if (rating)
    rating->load_case = calloc((size_t)most_cases, sizeof *rating->load_case);
  if (!rating || !rating->load_case) {
    eo_design_rating_free(rating);
    return eo_error_memory(error);
  }
  rating->most_cases = most_cases;
  *result = rating;
  return EO_OK;
}

void eo_design_rating_free(struct eo_design_rating *rating)
{
  if (!rating)
    return;
  free(rating->load_case);
  free(rating);
}

/* C_a: what is relieved where contact begins and where it ends, the smaller of the two; each the sum of one member's
   tip relief and the root relief of its mate (ISO 6336-1 6.5.9). */
static double tip_relief(const struct eo_design *design)
{
  double least = INFINITY;
  for (int end = 0; end < design->gear_pair.ends; end++)
    for (int m = 0; m < 2; m++)
      least = fmin(least,
                   design->modification.flank[m][end].tip_relief + design->modification.flank[1 - m][end].root_relief);
  return least;
}

static struct eo_rating_input input_of(const struct eo_pair *whole, const struct eo_design *design, int end)
{
  const struct eo_pair *pair = eo_pair_half(whole, end);
  const struct eo_shafts *shafts = &design->shafts;
  const double *bearing = shafts->bearing_position[EO_PINION];
  return (struct eo_rating_input){.geometry = &pair->geometry,
                                  .pair = &design->gear_pair,
                                  .material = &design->material,
                                  .rating = &design->rating,
                                  .thickness_allowance = {design->gear_pair.thickness_allowance[EO_PINION][0],
                                                          design->gear_pair.thickness_allowance[EO_GEAR][0]},
                                  .tip_relief = tip_relief(design),
                                  .bearing_span = bearing[EO_RIGHT] - bearing[EO_LEFT],
                                  .bearing_offset = fabs(bearing[EO_RIGHT] + bearing[EO_LEFT]) / 2,
                                  .shaft_diameter = shafts->shaft_diameter[EO_PINION]};
}

/* The design with the helix slope deviation of each end more on the pinion's flanks, one way or the other; transverse,
   over the face width, + takes off where the teeth meet first. */
static void lean(struct eo_design *leaning, const struct eo_design *design, const struct eo_pair *pair,
                 const struct eo_rating_basis basis[2], double way)
{
  *leaning = *design;
  for (int end = 0; end < design->gear_pair.ends; end++) {
    double deviation = way * basis[end].mesh_deviation,
           normal = cos(eo_pair_half(pair, end)->geometry.base_helix_angle);
    leaning->modification.flank[EO_PINION][end].helix_slope += deviation * normal;
    leaning->modification.coast[EO_PINION][end].helix_slope -= deviation * normal;
  }
}

static enum eo_code lean_both_ways(struct eo_design_rating *rating, struct eo_evaluator *evaluator,
                                   const struct eo_design *design, const struct eo_scenario *scenario,
                                   struct eo_design *leaning, struct eo_error *error)
{
  for (int side = 0; side < 2; side++) {
    const struct eo_evaluation *evaluation;
    lean(leaning, design, eo_evaluator_pair(evaluator), rating->basis, side ? -1 : 1);
    EO_TRY(eo_evaluator_contact_at(evaluator, leaning, scenario, &evaluation, error));
    for (int k = 0; k < evaluation->cases; k++)
      for (int end = 0; end < evaluation->ends; end++)
        rating->load_case[k].face[end].leaning[side] = evaluation->load_case[k].end[end].face.face_factor;
  }
  return EO_OK;
}

enum eo_code eo_design_rating_lean(struct eo_design_rating *rating, struct eo_evaluator *evaluator,
                                   const struct eo_design *design, const struct eo_scenario *scenario,
                                   struct eo_error *error)
{
  rating->rated = true;
  for (int end = 0; end < 2 && rating->rated; end++) {
    struct eo_rating_input input = input_of(eo_evaluator_pair(evaluator), design, end);
    rating->rated = !eo_rating_basis_init(&rating->basis[end], &input, &rating->reason);
  }
  if (!rating->rated)
    return EO_OK;
  struct eo_design *leaning = malloc(sizeof *leaning);
  enum eo_code code = leaning ? lean_both_ways(rating, evaluator, design, scenario, leaning, error)
                              : eo_error_memory(error);
  free(leaning);
  return code;
}

/* Hours that the load case states, else its share of the required life. */
static double time_of(const struct eo_rating_settings *settings, const struct eo_load_case *load_case)
{
  const double hour = 3600;
  return load_case->hours > 0 ? load_case->hours * hour : settings->required_life * load_case->share;
}

/* NaN where it was not computed. */
static double root_stress(const struct eo_end_result *end, int member)
{
  return end->root[member].maximum > 0 ? end->root[member].maximum : NAN;
}

static enum eo_code rate_end(struct eo_design_rating *rating, const struct eo_case_result *case_result, int k, int end,
                             struct eo_error *error)
{
  const struct eo_rating_basis *basis = &rating->basis[end];
  const struct eo_rating_settings *settings = basis->input.rating;
  struct eo_face_factors *face = &rating->load_case[k].face[end];
  bool periodic = case_result->vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
  const struct eo_rating_load load = {
      .torque = case_result->load_case.torque * (rating->ends == 1 ? 1 : rating->share[end]),
      .speed = case_result->load_case.speed,
      .time = time_of(settings, &case_result->load_case),
      .side = case_result->load_case.flank == EO_COAST_FLANK,
      .sharing = rating->load_case[k].sharing[end],
      .dynamic = periodic ? case_result->vibration.dynamic_factor[end] : NAN,
      .face = face->worse,
      .share = case_result->end[end].face.share_factor,
      .pressure = case_result->end[end].max_pressure,
      .root = {root_stress(&case_result->end[end], EO_PINION), root_stress(&case_result->end[end], EO_GEAR)}};
  return eo_rated_case_find(&rating->load_case[k].end[end], basis, &load, error);
}

/* The distribution of one end, its share of the load, and its tribology: what needs no standard. */
static void describe_end(struct eo_design_rating *rating, const struct eo_pair *pair, const struct eo_design *design,
                         const struct eo_case_result *case_result, int k, int end)
{
  struct eo_case_rating *case_rating = &rating->load_case[k];
  struct eo_face_factors *face = &case_rating->face[end];
  struct eo_tribology_state state;
  face->nominal = case_result->end[end].face.face_factor;
  if (!rating->rated)
    face->leaning[0] = face->leaning[1] = NAN;
  face->worse = rating->rated ? fmax(face->leaning[0], face->leaning[1]) : NAN;
  case_rating->sharing[end] = eo_periodic_mean(pair->grid->positions, case_result->end[end].loaded.load) /
                              case_result->even_force[end];
  eo_tribology_state_init(&state, &pair->geometry, &design->material, &design->rating, case_result->load_case.speed);
  eo_tribology_find(&case_rating->tribology[end], &state, eo_pair_half(pair, end)->grid, &case_result->end[end].loaded);
}

static void decide(struct eo_design_rating *rating)
{
  rating->flank_safety = rating->root_safety = rating->flank_static = rating->root_static = rating->life = INFINITY;
  for (int end = 0; end < rating->ends; end++)
    for (int m = 0; m < 2; m++) {
      const struct eo_rated_side *flank = &rating->end[end].flank[m], *root = &rating->end[end].root[m];
      rating->flank_safety = fmin(rating->flank_safety, flank->safety);
      rating->root_safety = fmin(rating->root_safety, root->safety);
      rating->flank_static = fmin(rating->flank_static, flank->static_safety);
      rating->root_static = fmin(rating->root_static, root->static_safety);
      rating->life = fmin(rating->life, fmin(flank->life_at_least, root->life_at_least));
    }
}

static void find_spectra(struct eo_design_rating *rating)
{
  struct eo_rated_case cases[EO_MAX_LOAD_CASES];
  for (int end = 0; end < rating->ends; end++) {
    for (int k = 0; k < rating->cases; k++)
      cases[k] = rating->load_case[k].end[end];
    eo_rated_spectrum_find(&rating->end[end], &rating->basis[end], rating->cases, cases);
  }
  decide(rating);
}

void eo_design_rating_find(struct eo_design_rating *rating, const struct eo_pair *pair, const struct eo_design *design,
                           const struct eo_evaluation *evaluation)
{
  rating->ends = evaluation->ends;
  memcpy(rating->share, eo_pair_double_helix(pair).share, sizeof rating->share);
  rating->cases = evaluation->cases;
  for (int end = 0; end < 2; end++)
    rating->basis[end].input = input_of(pair, design, end);
  rating->flank_safety = rating->root_safety = rating->flank_static = rating->root_static = rating->life = NAN;
  rating->film_ratio = INFINITY;
  rating->contact_temperature = -INFINITY;
  rating->time = 0;
  for (int k = 0; k < rating->cases; k++)
    rating->time += time_of(&design->rating, &evaluation->load_case[k].load_case);
  for (int k = 0; k < rating->cases; k++)
    for (int end = 0; end < rating->ends; end++) {
      const struct eo_case_result *case_result = &evaluation->load_case[k];
      const struct eo_tribology *tribology = &rating->load_case[k].tribology[end];
      describe_end(rating, pair, design, case_result, k, end);
      rating->film_ratio = fmin(rating->film_ratio, tribology->film_ratio);
      rating->contact_temperature = fmax(rating->contact_temperature, tribology->contact_temperature);
      rating->rated = rating->rated && !rate_end(rating, case_result, k, end, &rating->reason);
    }
  if (rating->rated)
    find_spectra(rating);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sliding, flash temperature and film of a result: figures of every end, maps over the flank. */
#include <math.h>

#include "document/result_private.h"

#define OF_END(member) EO_AT(struct eo_tribology, member)
static const struct eo_outline_row figure_rows[] = {
    EO_KEY("max_sliding_m_per_s", "number?", "largest sliding speed where there is load", .unit = &eo_unit_m_per_s,
           OF_END(sliding)),
    EO_KEY("max_flash_K", "number?", "largest flash temperature above the teeth, after Blok", .unit = &eo_unit_K,
           OF_END(flash)),
    EO_KEY("max_contact_temperature_C", "number?", "teeth and largest flash", .unit = &eo_unit_C,
           OF_END(contact_temperature)),
    EO_KEY("min_film_um", "number?", "least film thickness, after Dowson and Higginson", .unit = &eo_unit_um,
           OF_END(film)),
    EO_KEY("min_film_ratio", "number?", "least specific film thickness: over R_q of both flanks, 1.25 R_z/6 each",
           OF_END(film_ratio)),
    EO_KEY("power_loss_W", "number?", "friction of the mesh of this end, mean over the mesh cycle", .unit = &eo_unit_W,
           OF_END(power_loss)),
};

/* One end with its maps. */
struct tribology_end {
  struct eo_tribology figures;
  struct eo_series flash, film;
};

static const struct eo_outline figures = EO_OUTLINE(NULL, figure_rows);
static const struct eo_outline_row end_rows[] = {
    {.outline = &figures, EO_AT(struct tribology_end, figures)},
    EO_KEY("flash_K", "[[number?]]?",
           "over the flank, a row for every s_mm, a number for every eta_mm; null where nothing touches, and without "
           "maps",
           .unit = &eo_unit_K, EO_AT(struct tribology_end, flash)),
    EO_KEY("film_um", "[[number?]]?", "film thickness, the same", .unit = &eo_unit_um,
           EO_AT(struct tribology_end, film)),
};
static const struct eo_outline tribology_end = EO_OUTLINE("TribologyEnd", end_rows);

static json_t *encode_end(const struct eo_result_source *source, const struct eo_case_result *case_result,
                          const struct eo_tribology *found, int end, const struct eo_tribology_state *state)
{
  enum { POINTS = EO_PATTERN_ROWS * EO_PATTERN_COLUMNS };
  const struct eo_contact_grid *grid = eo_pair_half(source->pair, end)->grid;
  struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  double flash[POINTS], film[POINTS];
  bool wanted = eo_result_has(source, EO_RESULT_NO_TRIBOLOGY | EO_RESULT_NO_MAPS, case_result);
  eo_contact_pattern_load(pattern, grid, &case_result->end[end].loaded);
  for (int i = 0; i < POINTS && wanted; i++) {
    double load = eo_contact_pattern_line_load(pattern, grid, i);
    struct eo_tribology_point point = eo_tribology_at(state, pattern->path[i / EO_PATTERN_COLUMNS], load);
    flash[i] = load > 0 ? point.flash : NAN;
    film[i] = load > 0 ? point.film : NAN;
  }
  const struct tribology_end view = {*found, eo_result_map(source, wanted ? flash : NULL),
                                     eo_result_map(source, wanted ? film : NULL)};
  return eo_outline_encode(&tribology_end, &view);
}

/* One load case. */
struct tribology_case {
  bool two;
  double torque, speed, viscosity, roughness, loss, efficiency;
  struct eo_series sliding;
  json_t *end[2];
};

#define OF_CASE(member) EO_AT(struct tribology_case, member)
static const struct eo_outline_row case_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm, OF_CASE(torque)),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm, OF_CASE(speed)),
    EO_KEY("oil_viscosity_mPa_s", "number", "dynamic, at the temperature of the teeth", OF_CASE(viscosity)),
    EO_KEY("roughness_um", "number", "R_q of both flanks together, which film ratios are over", .unit = &eo_unit_um,
           OF_CASE(roughness)),
    EO_KEY("sliding_m_per_s", "[number]", "pinion's flank less the gear's, over s_mm", .unit = &eo_unit_m_per_s,
           OF_CASE(sliding)),
    EO_KEY("power_loss_W", "number?", "friction of all ends", .unit = &eo_unit_W, OF_CASE(loss)),
    EO_KEY("efficiency", "number?",
           "of the mesh alone: 1 - loss over power; bearings, churning and seals are not in it", OF_CASE(efficiency)),
    EO_KEY("left", "object", "left end", .outline = &tribology_end, OF_CASE(end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &tribology_end, OF_CASE(end[EO_RIGHT]),
           EO_IF(struct tribology_case, two)),
};
static const struct eo_outline tribology_case = EO_OUTLINE("TribologyLoadCase", case_rows);

static json_t *encode_case(const struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  const struct eo_case_rating *rating = &source->analysis->rating->load_case[k];
  struct eo_tribology_state state;
  double sliding[EO_PATTERN_ROWS], loss = 0;
  eo_tribology_state_init(&state, &source->pair->geometry, &source->design->material, &source->design->rating,
                          case_result->load_case.speed);
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    sliding[i] = eo_tribology_at(&state, source->pattern->path[i], 1).sliding;
  for (int end = 0; end < source->ends; end++)
    loss += rating->tribology[end].power_loss;
  struct tribology_case view = {.two = source->ends == 2,
                                .torque = case_result->load_case.torque,
                                .speed = case_result->load_case.speed,
                                .viscosity = 1e3 * state.viscosity,
                                .roughness = state.roughness,
                                .loss = loss,
                                .efficiency = 1 - loss / (case_result->load_case.torque * case_result->load_case.speed),
                                .sliding = eo_series_of(EO_PATTERN_ROWS, sliding, EO_DIGITS_CURVE)};
  for (int end = 0; end < source->ends; end++)
    view.end[end] = encode_end(source, case_result, &rating->tribology[end], end, &state);
  return eo_outline_encode(&tribology_case, &view);
}

static const char *const methods[] = {
    "flash temperature: Blok 1937, two equal bodies, semi-elliptic heat source",
    "film thickness: Dowson and Higginson 1966, line contact, isothermal, fully flooded, oil as warm as the teeth",
    "viscosity over temperature: Walther, ASTM D341",
    "friction: the coefficient that is stated, the same everywhere",
    "no safety against scuffing or micropitting: ISO/TS 6336-20, -21 and -22 are not public and are not followed",
    NULL};

struct tribology {
  bool uneven;
  struct eo_series path, eta;
  json_t *methods, *right_eta, *cases;
};

#define OF_TRIBOLOGY(member) EO_AT(struct tribology, member)
static const struct eo_outline_row tribology_rows[] = {
    EO_KEY("methods", "[text]", "formulae with their sources", OF_TRIBOLOGY(methods)),
    EO_KEY("s_mm", "[number]", "roll along the line of action from the pitch point: rows of the maps",
           .unit = &eo_unit_mm, OF_TRIBOLOGY(path)),
    EO_KEY("eta_mm", "[number]", "place along the face from its middle: columns of the maps", .unit = &eo_unit_mm,
           OF_TRIBOLOGY(eta)),
    EO_KEY("right_eta_mm", "[number]", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN,
           OF_TRIBOLOGY(right_eta), EO_IF(struct tribology, uneven)),
    EO_KEY("load_cases", "[object]", "in the order of the design", .outline = &tribology_case, OF_TRIBOLOGY(cases)),
};
const struct eo_outline eo_outline_tribology = EO_OUTLINE("Tribology", tribology_rows);

json_t *eo_result_tribology(const struct eo_result_source *source)
{
  if (!(source->analysis->want & EO_WANT_RATING))
    return json_null();
  struct eo_object sources = eo_list_open(), cases = eo_list_open();
  for (int i = 0; methods[i]; i++)
    eo_list_add(&sources, json_string(methods[i]));
  for (int k = 0; k < source->evaluation->cases; k++)
    eo_list_add(&cases, encode_case(source, k));
  const struct tribology view = {
      .uneven = source->pair->right,
      .path = eo_series_of(EO_PATTERN_ROWS, source->pattern->path, EO_DIGITS_CURVE),
      .eta = eo_series_of(EO_PATTERN_COLUMNS, source->pattern->eta, EO_DIGITS_CURVE),
      .methods = eo_object_close(&sources),
      .right_eta = eo_result_right_face(source, EO_PATTERN_COLUMNS, source->pattern->eta),
      .cases = eo_object_close(&cases),
  };
  return eo_outline_encode(&eo_outline_tribology, &view);
}

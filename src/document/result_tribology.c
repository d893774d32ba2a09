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
  const struct eo_result_source *source;
  const struct eo_case_result *load_case;
  int end;
  struct eo_tribology_state state;
};

static json_t *write_map(const struct tribology_end *end, double (*value)(const struct eo_tribology_point *),
                         const struct eo_unit *unit)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(end->source, end->end);
  double map[EO_PATTERN_ROWS * EO_PATTERN_COLUMNS];
  if (!eo_result_has(end->source, EO_RESULT_NO_TRIBOLOGY | EO_RESULT_NO_MAPS, end->load_case))
    return json_null();
  for (int i = 0; i < EO_PATTERN_ROWS * EO_PATTERN_COLUMNS; i++) {
    double q = eo_contact_pattern_line_load(pattern, eo_pair_half(end->source->pair, end->end)->grid, i);
    struct eo_tribology_point point = eo_tribology_at(&end->state, pattern->path[i / EO_PATTERN_COLUMNS], q);
    map[i] = q > 0 ? value(&point) : NAN;
  }
  return eo_result_map(end->source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, map, unit);
}

static double flash_of(const struct eo_tribology_point *point)
{
  return point->flash;
}

static double film_of(const struct eo_tribology_point *point)
{
  return point->film;
}

static json_t *write_flash(const void *source)
{
  return write_map(source, flash_of, &eo_unit_K);
}

static json_t *write_film(const void *source)
{
  return write_map(source, film_of, &eo_unit_um);
}

static const struct eo_outline figures = EO_OUTLINE(NULL, figure_rows);
static const struct eo_outline_row end_rows[] = {
    {.outline = &figures, EO_AT(struct tribology_end, figures)},
    EO_KEY("flash_K", "[[number?]]?",
           "over the flank, a row for every s_mm, a number for every eta_mm; null where nothing touches, and without "
           "maps",
           .unit = &eo_unit_K, .write = write_flash),
    EO_KEY("film_um", "[[number?]]?", "film thickness, the same", .unit = &eo_unit_um, .write = write_film),
};
static const struct eo_outline tribology_end = EO_OUTLINE("TribologyEnd", end_rows);

static const struct eo_outline_row case_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("oil_viscosity_mPa_s", "number", "dynamic, at the temperature of the teeth"),
    EO_KEY("roughness_um", "number", "R_q of both flanks together, which film ratios are over", .unit = &eo_unit_um),
    EO_KEY("sliding_m_per_s", "[number]", "pinion's flank less the gear's, over s_mm", .unit = &eo_unit_m_per_s),
    EO_KEY("power_loss_W", "number?", "friction of all ends", .unit = &eo_unit_W),
    EO_KEY("efficiency", "number?",
           "of the mesh alone: 1 - loss over power; bearings, churning and seals are not in it"),
    EO_KEY("left", "object", "left end", .outline = &tribology_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &tribology_end),
};
static const struct eo_outline tribology_case = EO_OUTLINE("TribologyLoadCase", case_rows);

static json_t *encode_end(const struct eo_result_source *source, const struct eo_case_result *case_result, int k,
                          int end, const struct eo_tribology_state *state)
{
  const struct tribology_end view = {.figures = source->analysis->rating->load_case[k].tribology[end],
                                     .source = source,
                                     .load_case = case_result,
                                     .end = end,
                                     .state = *state};
  eo_contact_pattern_load(eo_result_pattern(source, end), eo_pair_half(source->pair, end)->grid,
                          &case_result->end[end].loaded);
  return eo_outline_encode(&tribology_end, &view);
}

static json_t *encode_case(const struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  const struct eo_case_rating *rating = &source->analysis->rating->load_case[k];
  struct eo_tribology_state state;
  double sliding[EO_PATTERN_ROWS], loss = 0;
  struct eo_object object = eo_object_open_as(&tribology_case);
  eo_tribology_state_init(&state, &source->pair->geometry, &source->design->material, &source->design->rating,
                          case_result->load_case.speed);
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    sliding[i] = eo_tribology_at(&state, source->pattern->path[i], 1).sliding;
  for (int end = 0; end < source->ends; end++)
    loss += rating->tribology[end].power_loss;
  eo_object_put_number(&object, "torque_Nm", case_result->load_case.torque);
  eo_object_put_number(&object, "speed_rpm", case_result->load_case.speed);
  eo_object_put_number(&object, "oil_viscosity_mPa_s", 1e3 * state.viscosity);
  eo_object_put_number(&object, "roughness_um", state.roughness);
  eo_object_put(&object, "sliding_m_per_s",
                eo_json_reals(EO_PATTERN_ROWS, sliding, 1, &eo_unit_m_per_s, EO_DIGITS_CURVE));
  eo_object_put_number(&object, "power_loss_W", loss);
  eo_object_put_number(&object, "efficiency",
                       1 - loss / (case_result->load_case.torque * case_result->load_case.speed));
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_end(source, case_result, k, end, &state));
  return eo_object_close(&object);
}

static const char *const methods[] = {
    "flash temperature: Blok 1937, two equal bodies, semi-elliptic heat source",
    "film thickness: Dowson and Higginson 1966, line contact, isothermal, fully flooded, oil as warm as the teeth",
    "viscosity over temperature: Walther, ASTM D341",
    "friction: the coefficient that is stated, the same everywhere",
    "no safety against scuffing or micropitting: ISO/TS 6336-20, -21 and -22 are not public and are not followed",
    NULL};

static const struct eo_outline_row tribology_rows[] = {
    EO_KEY("methods", "[text]", "formulae with their sources"),
    EO_KEY("s_mm", "[number]", "roll along the line of action from the pitch point: rows of the maps",
           .unit = &eo_unit_mm),
    EO_KEY("eta_mm", "[number]", "place along the face from its middle: columns of the maps", .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
    EO_KEY("load_cases", "[object]", "in the order of the design", .outline = &tribology_case),
};
const struct eo_outline eo_outline_tribology = EO_OUTLINE("Tribology", tribology_rows);

json_t *eo_result_tribology(const struct eo_result_source *source)
{
  if (!(source->analysis->want & EO_WANT_RATING))
    return json_null();
  struct eo_object object = eo_object_open_as(&eo_outline_tribology);
  json_t *sources = json_array(), *cases = json_array();
  for (int i = 0; methods[i]; i++)
    object.failed = object.failed || json_array_append_new(sources, json_string(methods[i])) != 0;
  eo_object_put(&object, "methods", sources);
  eo_object_put(&object, "s_mm",
                eo_json_reals(EO_PATTERN_ROWS, source->pattern->path, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  eo_object_put(&object, "eta_mm",
                eo_json_reals(EO_PATTERN_COLUMNS, source->pattern->eta, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  eo_result_put_right_face(&object, "right_eta_mm", source, EO_PATTERN_COLUMNS, source->pattern->eta, true);
  for (int k = 0; k < source->evaluation->cases; k++)
    object.failed = object.failed || json_array_append_new(cases, encode_case(source, k)) != 0;
  eo_object_put(&object, "load_cases", cases);
  return eo_object_close(&object);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What touches where: unloaded contact, loaded contact of a load case, what elastic bodies open of it. */
#include <math.h>
#include <stdlib.h>

#include "document/result_private.h"
#include "numerics/periodic.h"

static const struct eo_outline_row unloaded_end_rows[] = {
    EO_KEY("te_um", "[number?]?", "unloaded transmission error, over the positions", .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_um", "number?", "of the end", .unit = &eo_unit_um),
    EO_KEY("smallest_gap_um", "number?", "smallest gap anywhere on the flank", .unit = &eo_unit_um),
    EO_KEY("clearance_um", "[[number?]]?",
           "gap that the mesh cycle leaves, a row for every s_mm, a number for every eta_mm; null without maps",
           .unit = &eo_unit_um),
    EO_KEY("marked_share", "number?", "share of the flank closer than the marking thickness"),
};
static const struct eo_outline unloaded_end = EO_OUTLINE("UnloadedContactEnd", unloaded_end_rows);

static json_t *encode_unloaded_end(struct eo_result_source *source, int end)
{
  const struct eo_end_result *end_result = &source->evaluation->load_case[0].end[end];
  struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  struct eo_object object = eo_object_open_as(&unloaded_end);
  int marked = 0, points = EO_PATTERN_ROWS * EO_PATTERN_COLUMNS;
  eo_contact_pattern_unload(pattern, eo_evaluator_field(source->analysis->evaluator, 0, end), end_result->unloaded);
  for (int i = 0; i < points; i++)
    marked += pattern->clearance[i] < source->design->resolution.marking_thickness;
  bool curves = eo_result_has(source, EO_RESULT_NO_UNLOADED, NULL);
  eo_object_put(&object, "te_um",
                curves ? eo_result_end_column(source, end, end_result->unloaded, 1 / source->normal, &eo_unit_um)
                       : json_null());
  eo_object_put_number(&object, "peak_to_peak_um",
                       eo_periodic_swing(source->positions, end_result->unloaded) / source->normal);
  eo_object_put_number(&object, "smallest_gap_um", end_result->datum);
  eo_object_put(&object, "clearance_um",
                curves ? eo_result_map(source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, pattern->clearance, &eo_unit_um)
                       : json_null());
  eo_object_put_number(&object, "marked_share", (double)marked / points);
  return eo_object_close(&object);
}

static const struct eo_outline_row place_rows[] = {
    EO_KEY("s_mm", "[number]?",
           "roll along the line of action from the pitch point, + towards the pinion's tip: rows of the maps",
           .unit = &eo_unit_mm),
    EO_KEY("eta_mm", "[number]?",
           "place along the face from its middle, + on the side that meets first: columns of the maps",
           .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]?", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
};
static const struct eo_outline places = EO_OUTLINE("Places", place_rows);

static void put_places(struct eo_object *object, const struct eo_result_source *source, bool wanted)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(source, EO_LEFT);
  eo_object_put(object, "s_mm",
                wanted ? eo_json_reals(EO_PATTERN_ROWS, pattern->path, 1, &eo_unit_mm, EO_DIGITS_CURVE) : json_null());
  eo_object_put(object, "eta_mm",
                wanted ? eo_json_reals(EO_PATTERN_COLUMNS, pattern->eta, 1, &eo_unit_mm, EO_DIGITS_CURVE)
                       : json_null());
  eo_result_put_right_face(object, "right_eta_mm", source, EO_PATTERN_COLUMNS, pattern->eta, wanted);
}

static json_t *encode_unloaded_pair(struct eo_result_source *source, double *peak)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[0];
  int n = source->positions, last = source->ends - 1;
  for (int j = 0; j < n; j++)
    source->scratch[j] =
        (case_result->end[0].unloaded[j] + case_result->end[last].unloaded[(j + n - source->lag) % n]) / 2;
  *peak = eo_periodic_swing(n, source->scratch) / source->normal;
  return eo_json_column(n, source->scratch, 1 / source->normal, &eo_unit_um, source->digits);
}

static const struct eo_outline_row unloaded_rows[] = {
    EO_KEY("position", "[number]?", "phase of the mesh cycle, 0..1"),
    EO_KEY("pair_te_um", "[number?]?", "unloaded transmission error of the pair, over the positions",
           .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_um", "number?", "of the pair", .unit = &eo_unit_um),
    EO_KEY("marking_thickness_um", "number", "of the marking compound, as the design states it", .unit = &eo_unit_um),
    {.outline = &places},
    EO_KEY("left", "object", "left end", .outline = &unloaded_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &unloaded_end),
};
const struct eo_outline eo_outline_unloaded = EO_OUTLINE("UnloadedContact", unloaded_rows);

json_t *eo_result_unloaded(struct eo_result_source *source)
{
  struct eo_object object = eo_object_open_as(&eo_outline_unloaded);
  double peak;
  bool curves = eo_result_has(source, EO_RESULT_NO_UNLOADED, NULL);
  json_t *of_pair = encode_unloaded_pair(source, &peak);
  eo_object_put(&object, "position", curves ? eo_result_position(source) : json_null());
  eo_object_put(&object, "pair_te_um", curves ? json_incref(of_pair) : json_null());
  json_decref(of_pair);
  eo_object_put_number(&object, "peak_to_peak_um", peak);
  eo_object_put_number(&object, "marking_thickness_um", source->design->resolution.marking_thickness);
  put_places(&object, source, curves);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_unloaded_end(source, end));
  return eo_object_close(&object);
}

static json_t *encode_share(struct eo_result_source *source, int end, const struct eo_loaded_end *loaded, int first,
                            int pairs)
{
  json_t *rows = json_array();
  double *share = malloc(sizeof *share * (size_t)source->positions);
  bool failed = !rows || !share;
  for (int i = 0; i < pairs && !failed; i++) {
    eo_contact_pair_share(eo_pair_half(source->pair, end)->grid, loaded, first + i, share);
    failed = json_array_append_new(rows, eo_result_end_column(source, end, share, 1, NULL)) != 0;
  }
  free(share);
  if (!failed)
    return rows;
  json_decref(rows);
  return NULL;
}

static const struct eo_outline_row share_rows[] = {
    EO_KEY("tooth_pair", "[integer]", "numbers of the tooth pairs that can touch: rows of the shares"),
    EO_KEY("left", "[[number?]]", "share of the end's load, a row for every tooth pair, over the positions"),
    EO_KEY("right", "[[number?]]", "the same, right end", .when = EO_TWO_ENDS),
};
static const struct eo_outline shares = EO_OUTLINE("LoadShare", share_rows);

static json_t *encode_shares(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  struct eo_object object = eo_object_open_as(&shares);
  int range[2], right[2];
  json_t *pairs = json_array();
  eo_contact_grid_pairs(source->pair->grid, range);
  eo_contact_grid_pairs(eo_pair_half(source->pair, EO_RIGHT)->grid, right);
  range[0] = right[0] < range[0] ? right[0] : range[0];
  range[1] = right[1] > range[1] ? right[1] : range[1];
  for (int pair = range[0]; pair <= range[1]; pair++)
    object.failed = object.failed || json_array_append_new(pairs, json_integer(pair)) != 0;
  eo_object_put(&object, "tooth_pair", pairs);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end],
                  encode_share(source, end, &case_result->end[end].loaded, range[0], range[1] - range[0] + 1));
  return eo_object_close(&object);
}

static const struct eo_outline_row pattern_end_rows[] = {
    EO_KEY("pressure_MPa", "[[number?]]?",
           "largest contact pressure of the mesh cycle, a row for every s_mm, a number for every eta_mm; null without "
           "maps",
           .unit = &eo_unit_MPa),
    EO_KEY("gear_tip_edge_MPa", "[number?]?", "the same at the gear's tip edge, over eta_mm (nominal)",
           .unit = &eo_unit_MPa),
    EO_KEY("pinion_tip_edge_MPa", "[number?]?", "the same at the pinion's tip edge, over eta_mm (nominal)",
           .unit = &eo_unit_MPa),
};
static const struct eo_outline pattern_end = EO_OUTLINE("ContactPatternEnd", pattern_end_rows);

static json_t *encode_pattern_end(const struct eo_result_source *source, int end, bool wanted)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  struct eo_object object = eo_object_open_as(&pattern_end);
  eo_object_put(&object, "pressure_MPa",
                wanted ? eo_result_map(source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, pattern->pressure, &eo_unit_MPa)
                       : json_null());
  for (int edge = 0; edge < 2; edge++)
    eo_object_put(&object, edge ? "pinion_tip_edge_MPa" : "gear_tip_edge_MPa",
                  wanted ? eo_json_reals(EO_PATTERN_COLUMNS, pattern->edge[edge], 1, &eo_unit_MPa, EO_DIGITS_MAP)
                         : json_null());
  return eo_object_close(&object);
}

static const struct eo_outline_row pattern_rows[] = {
    {.outline = &places},
    EO_KEY("left", "object", "left end", .outline = &pattern_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &pattern_end),
};
static const struct eo_outline contact_pattern = EO_OUTLINE("ContactPattern", pattern_rows);

static json_t *encode_pattern(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  bool wanted = eo_result_has(source, EO_RESULT_NO_PATTERN, case_result);
  struct eo_object object = eo_object_open_as(&contact_pattern);
  put_places(&object, source, wanted);
  for (int end = 0; end < source->ends; end++) {
    struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
    eo_contact_pattern_load(pattern, eo_pair_half(source->pair, end)->grid, &case_result->end[end].loaded);
    source->edge_pressure[k][end] = 0;
    for (int edge = 0; edge < 2; edge++)
      for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
        source->edge_pressure[k][end] = fmax(source->edge_pressure[k][end], pattern->edge[edge][j]);
    eo_object_put(&object, eo_result_end[end], encode_pattern_end(source, end, wanted));
  }
  return eo_object_close(&object);
}

double eo_result_mean_load(const struct eo_result_source *source, const struct eo_case_result *case_result, int end)
{
  return eo_periodic_mean(source->positions, case_result->end[end].loaded.load);
}

/* One number per end. */
struct of_ends {
  double end[2];
  bool two;
};

static bool has_right(const void *source)
{
  return ((const struct of_ends *)source)->two;
}

#define EACH_END(variable, name, unit_)                                                          \
  static const struct eo_outline_row variable##_rows[] = {                                       \
      EO_KEY("left", "number?", "left end", .unit = unit_, EO_AT(struct of_ends, end[EO_LEFT])), \
      EO_KEY("right", "number?", "right end", .unit = unit_, .when = EO_TWO_ENDS,                \
             EO_AT(struct of_ends, end[EO_RIGHT]), .there = has_right)};                         \
  static const struct eo_outline variable = EO_OUTLINE(name, variable##_rows)
EACH_END(force_ends, "ForceOfEnds", &eo_unit_N);
EACH_END(pressure_ends, "PressureOfEnds", &eo_unit_MPa);
EACH_END(line_load_ends, "LineLoadOfEnds", &eo_unit_N_per_mm);
EACH_END(share_ends, "ShareOfEnds", NULL);

/* What a load case says about its contact. */
struct contact {
  struct eo_result_source *source;
  const struct eo_case_result *load_case;
  struct of_ends load, pressure, line_load, edge_share, edge_pressure;
  json_t *pattern; /* owned */
};

static json_t *write_shares(const void *source)
{
  const struct contact *contact = source;
  return eo_result_has(contact->source, EO_RESULT_NO_SHARES, contact->load_case)
             ? encode_shares(contact->source, contact->load_case)
             : json_null();
}

static json_t *write_pattern(const void *source)
{
  return json_incref(((const struct contact *)source)->pattern);
}

static json_t *write_face_load(const void *source)
{
  const struct contact *contact = source;
  return eo_result_face_load(contact->source, contact->load_case);
}

static const struct eo_outline_row contact_rows[] = {
    EO_KEY("mean_load_N", "object", "normal force that an end carries, mean over the mesh cycle",
           .outline = &force_ends, EO_AT(struct contact, load)),
    EO_KEY("max_pressure_MPa", "object", "largest contact pressure of the mesh cycle, tip edges included",
           .outline = &pressure_ends, EO_AT(struct contact, pressure)),
    EO_KEY("max_line_load_N_per_mm", "object", "largest load per length of contact line", .outline = &line_load_ends,
           EO_AT(struct contact, line_load)),
    EO_KEY("edge_load_share", "object", "largest share of the load on tip edges", .outline = &share_ends,
           EO_AT(struct contact, edge_share)),
    EO_KEY("edge_pressure_MPa", "object", "largest pressure of the tip edges (nominal)", .outline = &pressure_ends,
           EO_AT(struct contact, edge_pressure)),
    EO_KEY("face_load", "object", "load over the face, load distribution factors", .outline = &eo_outline_face_load,
           .write = write_face_load),
    EO_KEY("load_share", "object?", "shares of the tooth pairs; null when left out", .outline = &shares,
           .write = write_shares),
    EO_KEY("pattern", "object", "contact pattern", .outline = &contact_pattern, .write = write_pattern),
};
const struct eo_outline eo_outline_contact = EO_OUTLINE("LoadedContact", contact_rows);

json_t *eo_result_contact(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  struct contact contact = {.source = source, .load_case = case_result, .pattern = encode_pattern(source, k)};
  struct of_ends *const ends[] = {&contact.load, &contact.pressure, &contact.line_load, &contact.edge_share,
                                  &contact.edge_pressure};
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++)
    ends[i]->two = source->ends == 2;
  for (int end = 0; end < source->ends; end++) {
    contact.load.end[end] = eo_result_mean_load(source, case_result, end);
    contact.pressure.end[end] = case_result->end[end].max_pressure;
    contact.line_load.end[end] = case_result->end[end].max_line_load;
    contact.edge_share.end[end] = case_result->end[end].edge_share;
    contact.edge_pressure.end[end] = source->edge_pressure[k][end];
  }
  json_t *document = eo_outline_encode(&eo_outline_contact, &contact);
  json_decref(contact.pattern);
  return document;
}

static const struct eo_outline_row body_rows[] = {
    EO_KEY("eta_mm", "[number]", "place along the face from its middle, + on the side that meets first",
           .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
    EO_KEY("left_um", "[number?]", "normal gap that the bodies open, mean over the mesh cycle, over eta_mm, left end",
           .unit = &eo_unit_um),
    EO_KEY("right_um", "[number?]", "the same, right end", .unit = &eo_unit_um, .when = EO_TWO_ENDS),
    EO_KEY("most_iterations", "integer", "between contact and bodies, at the worst position"),
};
const struct eo_outline eo_outline_bodies = EO_OUTLINE("BodyDeflection", body_rows);

json_t *eo_result_bodies(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  double eta[EO_DEFLECTION_NODES];
  struct eo_object object = eo_object_open_as(&eo_outline_bodies);
  for (int i = 0; i < EO_DEFLECTION_NODES; i++)
    eta[i] = source->pair->geometry.face_width * ((double)i / (EO_DEFLECTION_NODES - 1) - 0.5);
  eo_object_put(&object, "eta_mm", eo_json_reals(EO_DEFLECTION_NODES, eta, 1, &eo_unit_mm, source->digits));
  eo_result_put_right_face(&object, "right_eta_mm", source, EO_DEFLECTION_NODES, eta, true);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(
        &object, end ? "right_um" : "left_um",
        eo_json_reals(EO_DEFLECTION_NODES, case_result->end[end].deflection.part[0], 1, &eo_unit_um, source->digits));
  eo_object_put(&object, "most_iterations", json_integer(case_result->body_iterations));
  return eo_object_close(&object);
}

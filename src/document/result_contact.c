/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What touches where: unloaded contact, loaded contact of a load case, what elastic bodies open of it. */
#include <math.h>
#include <stdlib.h>

#include "document/result_private.h"
#include "numerics/periodic.h"

/* What an end says about its unloaded contact. */
struct unloaded_end {
  struct eo_series te, clearance;
  double swing, gap, marked;
};

#define OF_UNLOADED_END(member) EO_AT(struct unloaded_end, member)
static const struct eo_outline_row unloaded_end_rows[] = {
    EO_KEY("te_um", "[number?]?", "unloaded transmission error, over the positions", .unit = &eo_unit_um,
           OF_UNLOADED_END(te)),
    EO_KEY("peak_to_peak_um", "number?", "of the end", .unit = &eo_unit_um, OF_UNLOADED_END(swing)),
    EO_KEY("smallest_gap_um", "number?", "smallest gap anywhere on the flank", .unit = &eo_unit_um,
           OF_UNLOADED_END(gap)),
    EO_KEY("clearance_um", "[[number?]]?",
           "gap that the mesh cycle leaves, a row for every s_mm, a number for every eta_mm; null without maps",
           .unit = &eo_unit_um, OF_UNLOADED_END(clearance)),
    EO_KEY("marked_share", "number?", "share of the flank closer than the marking thickness", OF_UNLOADED_END(marked)),
};
static const struct eo_outline unloaded_end = EO_OUTLINE("UnloadedContactEnd", unloaded_end_rows);

static json_t *encode_unloaded_end(struct eo_result_source *source, int end)
{
  const struct eo_end_result *end_result = &source->evaluation->load_case[0].end[end];
  struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  bool curves = eo_result_has(source, EO_RESULT_NO_UNLOADED, NULL);
  int marked = 0, points = EO_PATTERN_ROWS * EO_PATTERN_COLUMNS;
  eo_contact_pattern_unload(pattern, eo_evaluator_field(source->analysis->evaluator, 0, end), end_result->unloaded);
  for (int i = 0; i < points; i++)
    marked += pattern->clearance[i] < source->design->resolution.marking_thickness;
  const struct unloaded_end view = {
      .te = eo_result_curve(source, end, curves ? end_result->unloaded : NULL, 1 / eo_result_normal(source, end)),
      .swing = eo_periodic_swing(source->positions, end_result->unloaded) / eo_result_normal(source, end),
      .gap = end_result->datum,
      .clearance = eo_result_map(source, curves ? pattern->clearance : NULL),
      .marked = (double)marked / points,
  };
  return eo_outline_encode(&unloaded_end, &view);
}

/* Where the points of maps over the flank lie. */
struct places {
  bool uneven;
  struct eo_series path, eta;
  json_t *right_eta;
};

static const struct eo_outline_row place_rows[] = {
    EO_KEY("s_mm", "[number]?",
           "roll along the line of action from the pitch point, + towards the pinion's tip: rows of the maps",
           .unit = &eo_unit_mm, EO_AT(struct places, path)),
    EO_KEY("eta_mm", "[number]?",
           "place along the face from its middle, + on the side that meets first: columns of the maps",
           .unit = &eo_unit_mm, EO_AT(struct places, eta)),
    EO_KEY("right_eta_mm", "[number]?", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN,
           EO_AT(struct places, right_eta), EO_IF(struct places, uneven)),
};
static const struct eo_outline places = EO_OUTLINE("Places", place_rows);

static struct places find_places(const struct eo_result_source *source, bool wanted)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(source, EO_LEFT);
  const double *eta = wanted ? pattern->eta : NULL;
  return (struct places){
      .uneven = source->pair->right,
      .path = eo_series_of(EO_PATTERN_ROWS, wanted ? pattern->path : NULL, EO_DIGITS_CURVE | source->ready),
      .eta = eo_series_of(EO_PATTERN_COLUMNS, eta, EO_DIGITS_CURVE | source->ready),
      .right_eta = eo_result_right_face(source, EO_PATTERN_COLUMNS, eta),
  };
}

/* What a design says about its unloaded contact. */
struct unloaded {
  bool two;
  json_t *position, *end[2];
  struct eo_series pair;
  double swing, marking;
  struct places places;
};

#define OF_UNLOADED(member) EO_AT(struct unloaded, member)
static const struct eo_outline_row unloaded_rows[] = {
    EO_KEY("position", "[number]?", "phase of the mesh cycle, 0..1", OF_UNLOADED(position)),
    EO_KEY("pair_te_um", "[number?]?", "unloaded transmission error of the pair, over the positions",
           .unit = &eo_unit_um, OF_UNLOADED(pair)),
    EO_KEY("peak_to_peak_um", "number?", "of the pair", .unit = &eo_unit_um, OF_UNLOADED(swing)),
    EO_KEY("marking_thickness_um", "number", "of the marking compound, as the design states it", .unit = &eo_unit_um,
           OF_UNLOADED(marking)),
    {.outline = &places, OF_UNLOADED(places)},
    EO_KEY("left", "object", "left end", .outline = &unloaded_end, OF_UNLOADED(end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &unloaded_end, OF_UNLOADED(end[EO_RIGHT]),
           EO_IF(struct unloaded, two)),
};
const struct eo_outline eo_outline_unloaded = EO_OUTLINE("UnloadedContact", unloaded_rows);

json_t *eo_result_unloaded(struct eo_result_source *source)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[0];
  int n = source->positions, last = source->ends - 1;
  bool curves = eo_result_has(source, EO_RESULT_NO_UNLOADED, NULL);
  struct unloaded view = {.two = source->ends == 2,
                          .position = curves ? eo_result_position(source) : json_null(),
                          .marking = source->design->resolution.marking_thickness,
                          .places = find_places(source, curves)};
  for (int end = 0; end < source->ends; end++)
    view.end[end] = encode_unloaded_end(source, end);
  for (int j = 0; j < n; j++)
    source->scratch[j] =
        (eo_result_weight(source, EO_LEFT) * case_result->end[0].unloaded[j] +
         eo_result_weight(source, EO_RIGHT) * case_result->end[last].unloaded[(j + n - source->lag) % n]) /
        2;
  view.pair = eo_result_curve(source, EO_LEFT, curves ? source->scratch : NULL, 1 / source->normal);
  view.swing = eo_periodic_swing(n, source->scratch) / source->normal;
  return eo_outline_encode(&eo_outline_unloaded, &view);
}

/* Shares of the tooth pairs of both ends. */
struct shares {
  bool two;
  json_t *pairs;
  struct eo_series end[2];
};

static const struct eo_outline_row share_rows[] = {
    EO_KEY("tooth_pair", "[integer]", "numbers of the tooth pairs that can touch: rows of the shares",
           EO_AT(struct shares, pairs)),
    EO_KEY("left", "[[number?]]", "share of the end's load, a row for every tooth pair, over the positions",
           EO_AT(struct shares, end[EO_LEFT])),
    EO_KEY("right", "[[number?]]", "the same, right end", .when = EO_TWO_ENDS, EO_AT(struct shares, end[EO_RIGHT]),
           EO_IF(struct shares, two)),
};
static const struct eo_outline shares = EO_OUTLINE("LoadShare", share_rows);

static json_t *list_pairs(const int range[2])
{
  struct eo_object pairs = eo_list_open();
  for (int pair = range[0]; pair <= range[1]; pair++)
    eo_list_add(&pairs, json_integer(pair));
  return eo_object_close(&pairs);
}

static json_t *encode_shares(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  int range[2], right[2], n = source->positions;
  eo_contact_grid_pairs(source->pair->grid, range);
  eo_contact_grid_pairs(eo_pair_half(source->pair, EO_RIGHT)->grid, right);
  range[0] = right[0] < range[0] ? right[0] : range[0];
  range[1] = right[1] > range[1] ? right[1] : range[1];
  int pairs = range[1] - range[0] + 1;
  double *share = malloc(sizeof *share * 2 * (size_t)pairs * (size_t)n);
  if (!share)
    return NULL;
  struct shares view = {.two = source->ends == 2, .pairs = list_pairs(range)};
  for (int end = 0; end < source->ends; end++) {
    double *rows = share + (size_t)end * (size_t)pairs * (size_t)n;
    for (int i = 0; i < pairs; i++)
      eo_contact_pair_share(eo_pair_half(source->pair, end)->grid, &case_result->end[end].loaded, range[0] + i,
                            rows + (size_t)i * (size_t)n);
    view.end[end] = eo_result_curve(source, end, rows, 1);
    view.end[end].rows = pairs;
  }
  json_t *encoded = eo_outline_encode(&shares, &view);
  free(share);
  return encoded;
}

/* The pattern of an end. */
struct pattern_end {
  struct eo_series pressure, edge[2];
};

static const struct eo_outline_row pattern_end_rows[] = {
    EO_KEY("pressure_MPa", "[[number?]]?",
           "largest contact pressure of the mesh cycle, a row for every s_mm, a number for every eta_mm; null without "
           "maps",
           .unit = &eo_unit_MPa, EO_AT(struct pattern_end, pressure)),
    EO_KEY("gear_tip_edge_MPa", "[number?]?", "the same at the gear's tip edge, over eta_mm (nominal)",
           .unit = &eo_unit_MPa, EO_AT(struct pattern_end, edge[0])),
    EO_KEY("pinion_tip_edge_MPa", "[number?]?", "the same at the pinion's tip edge, over eta_mm (nominal)",
           .unit = &eo_unit_MPa, EO_AT(struct pattern_end, edge[1])),
};
static const struct eo_outline pattern_end = EO_OUTLINE("ContactPatternEnd", pattern_end_rows);

static json_t *encode_pattern_end(const struct eo_result_source *source, int end, bool wanted)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  struct pattern_end view = {.pressure = eo_result_map(source, wanted ? pattern->pressure : NULL)};
  for (int edge = 0; edge < 2; edge++)
    view.edge[edge] = eo_series_of(EO_PATTERN_COLUMNS, wanted ? pattern->edge[edge] : NULL,
                                   EO_DIGITS_MAP | source->ready);
  return eo_outline_encode(&pattern_end, &view);
}

struct pattern {
  bool two;
  struct places places;
  json_t *end[2];
};

static const struct eo_outline_row pattern_rows[] = {
    {.outline = &places, EO_AT(struct pattern, places)},
    EO_KEY("left", "object", "left end", .outline = &pattern_end, EO_AT(struct pattern, end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &pattern_end,
           EO_AT(struct pattern, end[EO_RIGHT]), EO_IF(struct pattern, two)),
};
static const struct eo_outline contact_pattern = EO_OUTLINE("ContactPattern", pattern_rows);

static json_t *encode_pattern(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  bool wanted = eo_result_has(source, EO_RESULT_NO_PATTERN, case_result);
  struct pattern view = {.two = source->ends == 2, .places = find_places(source, wanted)};
  for (int end = 0; end < source->ends; end++) {
    struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
    eo_contact_pattern_load(pattern, eo_pair_half(source->pair, end)->grid, &case_result->end[end].loaded);
    source->edge_pressure[k][end] = 0;
    for (int edge = 0; edge < 2; edge++)
      for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
        source->edge_pressure[k][end] = fmax(source->edge_pressure[k][end], pattern->edge[edge][j]);
    view.end[end] = encode_pattern_end(source, end, wanted);
  }
  return eo_outline_encode(&contact_pattern, &view);
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

#define EACH_END(variable, name, unit_)                                                          \
  static const struct eo_outline_row variable##_rows[] = {                                       \
      EO_KEY("left", "number?", "left end", .unit = unit_, EO_AT(struct of_ends, end[EO_LEFT])), \
      EO_KEY("right", "number?", "right end", .unit = unit_, .when = EO_TWO_ENDS,                \
             EO_AT(struct of_ends, end[EO_RIGHT]), EO_IF(struct of_ends, two))};                 \
  static const struct eo_outline variable = EO_OUTLINE(name, variable##_rows)
EACH_END(force_ends, "ForceOfEnds", &eo_unit_N);
EACH_END(pressure_ends, "PressureOfEnds", &eo_unit_MPa);
EACH_END(line_load_ends, "LineLoadOfEnds", &eo_unit_N_per_mm);
EACH_END(share_ends, "ShareOfEnds", NULL);

/* What a load case says about its contact. */
struct contact {
  struct of_ends load, pressure, line_load, edge_share, edge_pressure;
  json_t *face_load, *shares, *pattern;
};

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
           EO_AT(struct contact, face_load)),
    EO_KEY("load_share", "object?", "shares of the tooth pairs; null when left out", .outline = &shares,
           EO_AT(struct contact, shares)),
    EO_KEY("pattern", "object", "contact pattern", .outline = &contact_pattern, EO_AT(struct contact, pattern)),
};
const struct eo_outline eo_outline_contact = EO_OUTLINE("LoadedContact", contact_rows);

json_t *eo_result_contact(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  bool whole = eo_result_has(source, EO_RESULT_NO_SHARES, case_result);
  struct contact contact = {.pattern = encode_pattern(source, k),
                            .face_load = eo_result_face_load(source, case_result),
                            .shares = whole ? encode_shares(source, case_result) : json_null()};
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
  return eo_outline_encode(&eo_outline_contact, &contact);
}

/* What elastic bodies of a load case open. */
struct bodies {
  bool two, uneven;
  struct eo_series eta, end[2];
  json_t *right_eta;
  int iterations;
};

#define OF_BODIES(member) EO_AT(struct bodies, member)
static const struct eo_outline_row body_rows[] = {
    EO_KEY("eta_mm", "[number]", "place along the face from its middle, + on the side that meets first",
           .unit = &eo_unit_mm, OF_BODIES(eta)),
    EO_KEY("right_eta_mm", "[number]", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN,
           OF_BODIES(right_eta), EO_IF(struct bodies, uneven)),
    EO_KEY("left_um", "[number?]", "normal gap that the bodies open, mean over the mesh cycle, over eta_mm, left end",
           .unit = &eo_unit_um, OF_BODIES(end[EO_LEFT])),
    EO_KEY("right_um", "[number?]", "the same, right end", .unit = &eo_unit_um, .when = EO_TWO_ENDS,
           OF_BODIES(end[EO_RIGHT]), EO_IF(struct bodies, two)),
    EO_KEY("most_iterations", "integer", "between contact and bodies, at the worst position", OF_BODIES(iterations)),
};
const struct eo_outline eo_outline_bodies = EO_OUTLINE("BodyDeflection", body_rows);

json_t *eo_result_bodies(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  enum { NODES = EO_DEFLECTION_NODES };
  double eta[NODES];
  for (int i = 0; i < NODES; i++)
    eta[i] = source->pair->geometry.face_width * ((double)i / (NODES - 1) - 0.5);
  struct bodies view = {.two = source->ends == 2,
                        .uneven = source->pair->right,
                        .eta = eo_series_of(NODES, eta, source->digits),
                        .right_eta = eo_result_right_face(source, NODES, eta),
                        .iterations = case_result->body_iterations};
  for (int end = 0; end < source->ends; end++)
    view.end[end] = eo_series_of(NODES, case_result->end[end].deflection.part[0], source->digits);
  return eo_outline_encode(&eo_outline_bodies, &view);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/design_document.h"

#include "document/scatter_document.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "format/inch.h"
#include "format/json.h"
#include "document/assumption.h"
#include "document/design_migration.h"
#include "document/flank_grid_document.h"
#include "document/pitch_document.h"
#include "document/search_space.h"
#include "evaluation/evaluator.h"
#include "evaluation/objective_terms.h"
#include "design/check.h"
#include "gear/names.h"

static void add_warning(struct eo_warnings *warnings, const char *key, const char *format, va_list arguments)
{
  int most = (int)(sizeof warnings->text / sizeof warnings->text[0]);
  if (!warnings || warnings->count >= most)
    return;
  int i = warnings->count++;
  snprintf(warnings->key[i], sizeof warnings->key[i], "%s", key);
  vsnprintf(warnings->text[i], sizeof warnings->text[i], format, arguments);
}

void eo_warnings_add(struct eo_warnings *warnings, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  add_warning(warnings, "", format, arguments);
  va_end(arguments);
}

void eo_warnings_at(struct eo_warnings *warnings, const char *key, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  add_warning(warnings, key, format, arguments);
  va_end(arguments);
}

/* A pair with one end has no right flanks. */
static void drop_right_end(const json_t *document, struct eo_design *design, struct eo_warnings *warnings)
{
  const json_t *modification = json_object_get(document, "modification");
  for (int i = 0; i < 2 && design->gear_pair.ends == 1; i++) {
    const json_t *right = json_object_get(json_object_get(modification, eo_member_name[i]), "right");
    if (right)
      eo_warnings_add(warnings,
                      "The modification of the %s's right end is ignored: the pair has one end, the left one.",
                      eo_member_name[i]);
    eo_table_defaults(&eo_flank_modification_table, &design->modification.flank[i][EO_RIGHT]);
    eo_table_defaults(&eo_flank_modification_table, &design->modification.coast[i][EO_RIGHT]);
  }
}

/* A key that stands beside the one that says the same in another measure. */
static void check_twice(const json_t *object, const struct eo_path *path, const char *deg, const char *um,
                        double face_width, struct eo_faults *faults)
{
  const json_t *angle = json_object_get(object, deg), *deviation = json_object_get(object, um);
  struct eo_path place = {path, um, 0};
  if (!json_is_number(angle) || !json_is_number(deviation))
    return;
  double stated = json_number_value(angle),
         follows = eo_unit_out(&eo_unit_deg, atan(eo_unit_in(&eo_unit_um, json_number_value(deviation)) / face_width));
  if (fabs(stated - follows) > 1e-9 + 1e-6 * fabs(stated))
    eo_faults_at(faults, &place, "This is %.9g deg over the face width, but %s says %.9g: state one of them.", follows,
                 deg, stated);
}

static void check_alignment(const json_t *alignment, const struct eo_path *path, double face_width,
                            struct eo_faults *faults)
{
  check_twice(alignment, path, "shaft_angle_error_in_plane_deg", "shaft_angle_error_in_plane_um", face_width, faults);
  check_twice(alignment, path, "shaft_angle_error_out_of_plane_deg", "shaft_angle_error_out_of_plane_um", face_width,
              faults);
}

static void check_alignments(const json_t *document, const struct eo_design *design, struct eo_faults *faults)
{
  struct eo_path path = {NULL, "alignment", 0}, list = {NULL, "load_cases", 0};
  double face_width = design->gear_pair.face_width;
  const json_t *row;
  size_t i;
  check_alignment(json_object_get(document, "alignment"), &path, face_width, faults);
  json_array_foreach(json_object_get(document, "load_cases"), i, row)
  {
    struct eo_path of_row = {&list, NULL, (int)i}, of_alignment = {&of_row, "alignment", 0};
    check_alignment(json_object_get(row, "alignment"), &of_alignment, face_width, faults);
  }
}

/* A search that varies the slope by its earlier name varies twice as much by its present one; which variables are
   numbers of a grid. */
static void migrate_variables(struct eo_optimization *optimization)
{
  int last = 0, helix = 0;
  for (; eo_variable_parameters[last + 1]; last++)
    helix = strcmp(eo_variable_parameters[last], "helix_slope_um") == 0 ? last : helix;
  for (int i = 0; i < optimization->listed; i++) {
    struct eo_listed_variable *variable = &optimization->list[i];
    variable->of_grid = strcmp(eo_variable_parameters[variable->parameter], EO_GRID_PARAMETER) == 0;
    if (variable->parameter == last) {
      variable->parameter = helix;
      variable->bounds.low *= 2;
      variable->bounds.high *= 2;
    }
  }
}

/* Hand, rotation and apex: two of them say the third. */
static void check_rotation(const json_t *document, const struct eo_design *design, struct eo_faults *faults)
{
  struct eo_path block = {NULL, "alignment", 0}, place = {&block, "pinion_rotation", 0};
  const char *apex = json_string_value(eo_json_find(document, "alignment/apex"));
  struct eo_gear_pair pair = design->gear_pair;
  struct eo_alignment alignment = design->alignment;
  if (!apex || !*design->gear_pair.hand || !*design->alignment.pinion_rotation)
    return;
  eo_design_settle_rotation(&pair, &alignment);
  if (alignment.apex != design->alignment.apex)
    eo_faults_at(faults, &place,
                 "A pinion whose left half is %s-handed and that turns %s has its apex %s, but alignment.apex says %s: "
                 "leave one of the three out.",
                 design->gear_pair.hand, design->alignment.pinion_rotation,
                 alignment.apex == EO_APEX_LEADING ? "leading" : "trailing", apex);
}

/* Says which keys of an earlier form were read as what. */
static void note_migrations(const json_t *document, struct eo_warnings *warnings)
{
  const char *member, *end;
  json_t *ends, *flank;
  bool found = false;
  json_object_foreach(json_object_get(document, "modification"), member, ends) json_object_foreach(ends, end, flank)
      found |= json_object_get(flank, "lead_slope_um") != NULL;
  if (found)
    eo_warnings_add(warnings, "lead_slope_um was read as twice its value in helix_slope_um (C_Hbeta, over the face "
                              "width): the same flank.");
}

static bool decode_current(const json_t *document, struct eo_design *design, struct eo_warnings *warnings,
                           struct eo_faults *faults)
{
  struct eo_design read;
  int before = faults->count;
  memset(&read, 0, sizeof read);
  eo_table_decode(&eo_design_table, document, NULL, &read, faults);
  if (faults->count == before)
    eo_load_cases_settle(json_object_get(document, "load_cases"), read.load_case, read.load_cases, warnings, faults);
  if (faults->count == before)
    check_alignments(document, &read, faults);
  if (faults->count == before)
    check_rotation(document, &read, faults);
  if (faults->count == before)
    eo_flank_grids_decode(json_object_get(document, "modification"), read.gear_pair.ends, &read.grids, faults);
  if (faults->count == before)
    eo_pitch_decode(json_object_get(document, "pitch"), &read.gear_pair, &read.pitch, faults);
  if (faults->count != before)
    return false;
  drop_right_end(document, &read, warnings);
  migrate_variables(&read.optimization);
  note_migrations(document, warnings);
  eo_assumptions_note(document, &read);
  *design = read;
  return true;
}

bool eo_design_decode(const json_t *document, struct eo_design *design, struct eo_warnings *warnings,
                      struct eo_faults *faults)
{
  json_t *metric = eo_inch_is_used(document) ? eo_inch_to_mm(document, faults) : json_incref((json_t *)document);
  if (faults->count || !metric) {
    if (!metric)
      eo_faults_memory(faults);
    json_decref(metric);
    return false;
  }
  json_t *current = eo_design_migrate(metric, warnings);
  json_decref(metric);
  bool good = current && decode_current(current, design, warnings, faults);
  if (!current)
    eo_faults_memory(faults);
  json_decref(current);
  for (int i = 0; i < faults->count && i < EO_MAX_FAULTS; i++)
    eo_inch_place(document, &faults->fault[i]);
  return good;
}

/* With the numbers that stand in place of a grid's. */
static void encode_grids(const struct eo_design *design, json_t *modification, bool *failed)
{
  struct eo_flank_grids *laid = eo_modification_has_nodes(&design->modification) ? malloc(sizeof *laid) : NULL;
  if (laid) {
    const char *member, *end;
    json_t *ends, *flank;
    *laid = design->grids;
    eo_modification_lay_nodes(&design->modification, laid);
    json_object_foreach(modification, member, ends) json_object_foreach(ends, end, flank)
    {
      json_object_del(flank, "grid_nodes");
      json_object_del(json_object_get(flank, "coast"), "grid_nodes");
    }
  } else
    *failed = *failed || eo_modification_has_nodes(&design->modification);
  eo_flank_grids_encode(laid ? laid : &design->grids, design->gear_pair.ends, modification, failed);
  free(laid);
}

json_t *eo_design_encode(const struct eo_design *design)
{
  json_t *document = eo_table_encode(&eo_design_table, design),
         *modification = json_object_get(document, "modification");
  bool failed = false;
  if (document)
    encode_grids(design, modification, &failed);
  if (document && design->pitch.stated)
    eo_json_put(document, "pitch", eo_pitch_encode(&design->pitch, design->gear_pair.ends), &failed);
  if (failed) {
    json_decref(document);
    return NULL;
  }
  if (design->gear_pair.ends == 1) {
    json_object_del(json_object_get(modification, "pinion"), "right");
    json_object_del(json_object_get(modification, "gear"), "right");
  }
  return document;
}

void eo_design_write(const struct eo_design *design, struct eo_text *text)
{
  eo_json_write_new(text, eo_design_encode(design), EO_JSON_COMPACT);
}

static enum eo_code decode(const json_t *document, struct eo_design *design, struct eo_warnings *warnings,
                           struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults)
    return eo_error_memory(error);
  enum eo_code code = eo_design_decode(document, design, warnings, faults) ? EO_OK : eo_faults_first(faults, error);
  free(faults);
  return code;
}

enum eo_code eo_design_read(const char *text, size_t size, struct eo_design *design, struct eo_geometry *geometry,
                            struct eo_warnings *warnings, struct eo_error *error)
{
  json_t *document = eo_json_parse(text, size, error);
  if (!document)
    return error->code;
  enum eo_code code = decode(document, design, warnings, error);
  json_decref(document);
  EO_TRY(code);
  EO_TRY(eo_design_complete(design, geometry, error));
  eo_design_note_findings(design, geometry, warnings);
  return EO_OK;
}

enum eo_code eo_design_complete(struct eo_design *design, struct eo_geometry *geometry, struct eo_error *error)
{
  struct eo_design complete = *design;
  struct eo_geometry made;
  EO_TRY(eo_design_settle(&complete, error));
  EO_TRY(eo_geometry_init(&made, &complete.gear_pair, error));
  eo_design_resolve(&complete, &made);
  eo_table_round_to_document(&eo_design_table, &complete);
  EO_TRY(eo_geometry_init(&made, &complete.gear_pair, error));
  EO_TRY(eo_design_check(&complete, &made, error));
  EO_TRY(eo_scatter_draw_pairs(&complete, error));
  EO_TRY(eo_objective_check(&complete, error));
  *design = complete;
  *geometry = made;
  return EO_OK;
}

/* Of a block that is the caller's own. */
static void drop_unused(json_t *block, const char *key)
{
  const json_t *value = json_object_get(block, key);
  if (json_is_null(value) || json_is_false(value) || (json_is_number(value) && json_number_value(value) == 0))
    json_object_del(block, key);
}

/* Without keys that came later and are not used: a design of before them stays the same one. New; NULL without memory.
 */
static json_t *without_unused(const json_t *document)
{
  static const struct {
    const char *block, *key;
  } later[] = {{"gear_pair", "right_helix_angle_deg"},
               {"alignment", "centre_distance_deviation_um"},
               {"tolerance", "centre_distance"}};
  json_t *whole = json_copy((json_t *)document);
  bool failed = !whole;
  for (size_t i = 0; i < sizeof later / sizeof *later && !failed; i++) {
    const json_t *given = json_object_get(document, later[i].block);
    json_t *own = json_copy((json_t *)given);
    drop_unused(own, later[i].key);
    failed = given && json_object_set_new(whole, later[i].block, own) != 0;
  }
  if (!failed)
    return whole;
  json_decref(whole);
  return NULL;
}

enum eo_code eo_design_hash_document(const json_t *document, char hex[EO_HASH_LENGTH + 1], struct eo_error *error)
{
  struct eo_text text = {0};
  json_t *used = without_unused(document);
  document = used;
  if (document)
    eo_json_write(&text, document, EO_JSON_CANONICAL);
  enum eo_code code = !document || text.failed ? eo_error_memory(error) : EO_OK;
  if (!code)
    eo_hash_hex(text.data, text.size, hex);
  eo_text_done(&text);
  json_decref(used);
  return code;
}

enum eo_code eo_design_hash(const struct eo_design *design, char hex[EO_HASH_LENGTH + 1], struct eo_error *error)
{
  json_t *document = eo_design_encode(design);
  enum eo_code code = eo_design_hash_document(document, hex, error);
  json_decref(document);
  return code;
}

/* The hand turns pictures and files round, and no number of an evaluation. */
static void drop_hand(json_t *document)
{
  json_object_del(json_object_get(document, "gear_pair"), "hand");
}

enum eo_code eo_design_evaluation_hash_document(const json_t *document, char hex[EO_HASH_LENGTH + 1],
                                                struct eo_error *error)
{
  static const char *const without[] = {"version",   "name",      "rating",       "pitch",
                                        "tolerance", "objective", "optimization", NULL};
  json_t *part = json_copy((json_t *)document), *pair = json_copy(json_object_get(part, "gear_pair"));
  bool failed = json_object_set_new(part, "gear_pair", pair) != 0;
  for (int i = 0; without[i] && !failed; i++)
    json_object_del(part, without[i]);
  drop_hand(part);
  enum eo_code code = eo_design_hash_document(failed ? NULL : part, hex, error);
  json_decref(part);
  return code;
}

/* Scenarios, root stress: what of the objective decides which values a row has. */
static json_t *encode_wants(const struct eo_design *design)
{
  json_t *wants = json_object();
  bool failed = !wants;
  if (design->objective.robust != EO_ROBUST_OFF && design->drawn.pairs > 0) {
    json_t *tolerance = eo_table_encode(&eo_tolerance_table, &design->tolerance);
    drop_unused(tolerance, "centre_distance");
    eo_json_put(wants, "tolerance", tolerance, &failed);
    eo_json_put(wants, "scatter_pairs", json_integer(design->drawn.pairs), &failed);
    if (design->drawn.first > 0)
      eo_json_put(wants, "first_pairs", json_integer(design->drawn.first), &failed);
  } else if (design->objective.robust != EO_ROBUST_OFF && design->objective.scenarios > 0) {
    json_t *objective = eo_table_encode(&eo_objective_table, &design->objective);
    eo_json_put(wants, "scenarios", json_incref(json_object_get(objective, "scenarios")), &failed);
    json_decref(objective);
  }
  if (eo_objective_wants_rating(&design->objective))
    eo_json_put(wants, "rating", eo_table_encode(&eo_rating_table, &design->rating), &failed);
  if (eo_design_scenarios(design) > eo_design_states(design))
    eo_json_put(wants, "nominal", json_true(), &failed);
  if (eo_objective_wants_scalars(&design->objective))
    eo_json_put(wants, "scalars", json_true(), &failed);
  eo_json_put(wants, "root_stress", json_boolean(eo_objective_wants_root(&design->objective)), &failed);
  eo_json_put(wants, "evaluator", json_integer(EO_EVALUATOR_VERSION), &failed);
  if (!failed)
    return wants;
  json_decref(wants);
  return NULL;
}

/* What a grid is called says which row the others relate to, not what a row is. */
static void drop_kinds(json_t *grids)
{
  const char *member, *end;
  json_t *ends, *flank;
  json_object_foreach(grids, member, ends) json_object_foreach(ends, end, flank)
  {
    json_object_del(json_object_get(flank, "grid"), "kind");
    json_object_del(json_object_get(json_object_get(flank, "coast"), "grid"), "kind");
  }
}

static json_t *encode_problem(const struct eo_design *design)
{
  static const char *const without[] = {"version", "name",      "modification", "rating",
                                        "pitch",   "tolerance", "objective",    "optimization"};
  json_t *whole = eo_design_encode(design), *document = whole ? without_unused(whole) : NULL, *load_case;
  bool failed = !document;
  json_decref(whole);
  size_t i;
  for (i = 0; i < sizeof without / sizeof without[0]; i++)
    json_object_del(document, without[i]);
  drop_hand(document);
  json_object_del(json_object_get(document, "resolution"), "marking_thickness_um");
  if (!eo_objective_wants_rating(&design->objective)) /* a damage sum asks how long each load lasts */
    json_array_foreach(json_object_get(document, "load_cases"), i, load_case) json_object_del(load_case, "share");
  eo_json_put(document, "wants", encode_wants(design), &failed);
  if (design->grids.used > 0 && !failed) { /* what no row varies */
    json_t *grids = json_object();
    eo_flank_grids_encode(&design->grids, design->gear_pair.ends, grids, &failed);
    drop_kinds(grids);
    eo_json_put(document, "grids", grids, &failed);
  }
  if (!failed)
    return document;
  json_decref(document);
  return NULL;
}

enum eo_code eo_design_problem(const struct eo_design *design, struct eo_text *spec, char hex[EO_HASH_LENGTH + 1],
                               struct eo_error *error)
{
  json_t *document = encode_problem(design);
  size_t before = spec->size;
  if (document)
    eo_json_write(spec, document, EO_JSON_CANONICAL);
  enum eo_code code = !document || spec->failed ? eo_error_memory(error) : EO_OK;
  if (!code)
    eo_hash_hex(spec->data + before, spec->size - before, hex);
  json_decref(document);
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/search_space.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "format/json.h"
#include "design/check.h"
#include "gear/names.h"

static bool is_node(const struct eo_study_variable *variable)
{
  return variable->field == &eo_grid_number_field;
}

static const struct eo_field *flank_field(const char *key)
{
  if (strcmp(key, EO_GRID_PARAMETER) == 0)
    return &eo_grid_number_field;
  for (int i = 0; i < eo_flank_modification_table.count; i++)
    if (strcmp(eo_flank_modification_table.field[i].key, key) == 0)
      return &eo_flank_modification_table.field[i];
  return NULL;
}

/* The paper's five come first among eo_variable_parameters. */
enum { PRESET = 5 };

static struct eo_range preset_bounds(const struct eo_optimization *optimization, const char *key)
{
  const struct {
    const char *key;
    struct eo_range range;
  } preset[PRESET] = {{"tip_relief_um", optimization->tip_relief},
                      {"root_relief_um", optimization->root_relief},
                      {"tip_relief_start_mm", optimization->tip_relief_start},
                      {"root_relief_start_mm", optimization->root_relief_start},
                      {"lead_crowning_um", optimization->lead_crowning}};
  for (int i = 0; i < PRESET; i++)
    if (strcmp(preset[i].key, key) == 0) {
      const struct eo_unit *unit = flank_field(key)->unit;
      return (struct eo_range){eo_unit_out(unit, preset[i].range.low), eo_unit_out(unit, preset[i].range.high)};
    }
  return (struct eo_range){NAN, NAN};
}

static void add_preset(struct eo_study_space *space, const struct eo_optimization *optimization, int end)
{
  for (int i = 0; i < PRESET; i++) {
    const char *key = eo_variable_parameters[i];
    struct eo_range bounds = preset_bounds(optimization, key);
    space->variable[space->count++] = (struct eo_study_variable){
        .member = EO_PINION, .end = end, .field = flank_field(key), .low = bounds.low, .high = bounds.high};
  }
}

/* Which relief a variable starts, EO_ROOT_SIDE or EO_TIP_SIDE, and by what; -1: none. The rack coordinate is way 0. */
static int start_of(const struct eo_field *field, int *way)
{
  if (field == &eo_grid_number_field)
    return -1;
  for (int side = 0; side < 2; side++) {
    size_t rack = side == EO_TIP_SIDE ? offsetof(struct eo_flank_modification, tip_relief_start)
                                      : offsetof(struct eo_flank_modification, root_relief_start),
           place = offsetof(struct eo_flank_modification, place) + (size_t)side * sizeof(struct eo_relief_place);
    *way = field->offset == rack ? 0 : (int)((field->offset - place) / sizeof(double)) + 1;
    if (field->offset == rack || (field->offset >= place && field->offset < place + sizeof(struct eo_relief_place)))
      return side;
  }
  return -1;
}

static struct eo_flank_modification *flank_of(struct eo_modification *modification, int side, int member, int end)
{
  return side == EO_DRIVE_FLANK ? &modification->flank[member][end] : &modification->coast[member][end];
}

static bool covers(const struct eo_study_variable *variable, int side, int end)
{
  return (variable->end == end || variable->end == EO_BOTH_ENDS) &&
         (variable->side == side || variable->side == EO_BOTH_FLANKS);
}

static bool overlap(const struct eo_study_variable *a, const struct eo_study_variable *b)
{
  int unused, start = start_of(a->field, &unused);
  bool same = a->field == b->field || (start >= 0 && start == start_of(b->field, &unused));
  if (is_node(a) && is_node(b))
    same = (a->row == b->row || a->row == 0 || b->row == 0) &&
           (a->column == b->column || a->column == 0 || b->column == 0);
  return same && a->member == b->member && (a->end == b->end || a->end == EO_BOTH_ENDS || b->end == EO_BOTH_ENDS) &&
         (a->side == b->side || a->side == EO_BOTH_FLANKS || b->side == EO_BOTH_FLANKS);
}

static enum eo_code fault(const char *pointer_format, int i, struct eo_error *error, const char *text, double a,
                          double b)
{
  char pointer[80];
  snprintf(pointer, sizeof pointer, pointer_format, i);
  return eo_error_set(error, EO_ERROR_INPUT, pointer, text, a, b);
}

static enum eo_code outside(int i, const struct eo_field *field, struct eo_error *error)
{
  char pointer[80];
  snprintf(pointer, sizeof pointer, "/optimization/variable_list/%d/bounds", i);
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "The bounds must increase and stay inside %.6g .. %.6g%s%s.",
                      field->low, field->high, field->unit ? " " : "", field->unit ? field->unit->symbol : "");
}

/* Every flank that it covers has a grid. */
static bool has_grids(const struct eo_study_variable *variable, const struct eo_design *design)
{
  bool has = true;
  for (int side = 0; side < 2; side++)
    for (int end = 0; end < design->gear_pair.ends; end++)
      has = has && (!covers(variable, side, end) || design->grids.place[side][variable->member][end].u_knots > 0);
  return has;
}

/* Every grid that it covers has such knots, and may vary. */
static enum eo_code check_knots(const struct eo_study_variable *variable, const struct eo_design *design, int i,
                                struct eo_error *error)
{
  for (int at = 0; at < 4; at++) {
    const struct eo_grid_place *place = &design->grids.place[at / 2][variable->member][at % 2];
    if (!covers(variable, at / 2, at % 2) || !is_node(variable) || place->u_knots == 0)
      continue;
    if (place->kind == EO_GRID_MEASURED)
      return fault("/optimization/variable_list/%d/parameter", i, error,
                   "The grid is stated as measured, and what is measured does not vary: its kind is \"designed\" where "
                   "the search may change it.",
                   0, 0);
    if (variable->row > place->u_knots)
      return fault("/optimization/variable_list/%d/row", i, error, "Row %.0f: the grid has %.0f rows (places u).",
                   variable->row, place->u_knots);
    if (variable->column > place->y_knots)
      return fault("/optimization/variable_list/%d/column", i, error,
                   "Column %.0f: the grid has %.0f columns (places y).", variable->column, place->y_knots);
  }
  return EO_OK;
}

/* One list row, made a variable; the field's own range holds as everywhere. */
static enum eo_code add_listed(struct eo_study_space *space, const struct eo_design *design, int i,
                               struct eo_error *error)
{
  const struct eo_listed_variable *row = &design->optimization.list[i];
  const struct eo_field *field = flank_field(eo_variable_parameters[row->parameter]);
  struct eo_range bounds = isnan(row->bounds.low) ? preset_bounds(&design->optimization, field->key) : row->bounds;
  int end = row->end == EO_BOTH_ENDS && design->gear_pair.ends == 1 ? EO_LEFT : row->end;
  if (end == EO_RIGHT && design->gear_pair.ends == 1)
    return fault("/optimization/variable_list/%d/end", i, error, "The pair has one end, the left one.", 0, 0);
  if (isnan(bounds.low))
    return fault("/optimization/variable_list/%d/bounds", i, error,
                 "This parameter has no bounds of its own: state them.", 0, 0);
  if (!(bounds.low < bounds.high) || bounds.low < field->low || bounds.high > field->high)
    return outside(i, field, error);
  struct eo_study_variable variable = {row->member, end,         row->flank, field,
                                       bounds.low,  bounds.high, row->row,   row->column};
  if (!is_node(&variable) && (row->row != 0 || row->column != 0))
    return fault(row->row ? "/optimization/variable_list/%d/row" : "/optimization/variable_list/%d/column", i, error,
                 "Rows and columns are those of a grid: parameter " EO_GRID_PARAMETER " varies its numbers.", 0, 0);
  bool of_grid = is_node(&variable) || field->offset == offsetof(struct eo_flank_modification, grid_gain);
  if (of_grid && !has_grids(&variable, design))
    return fault("/optimization/variable_list/%d/parameter", i, error,
                 "A flank that this variable covers has no grid: state one there.", 0, 0);
  EO_TRY(check_knots(&variable, design, i, error));
  for (int j = 0; j < space->count; j++)
    if (overlap(&variable, &space->variable[j]))
      return fault("/optimization/variable_list/%d", i, error, "This parameter is a variable already.", 0, 0);
  space->variable[space->count++] = variable;
  return EO_OK;
}

static void set_number(struct eo_flank_modification *flank, const struct eo_study_variable *variable, double value)
{
  if (is_node(variable))
    eo_modification_set_node(flank, variable->row, variable->column, value);
  else
    *(double *)(void *)((char *)flank + variable->field->offset) = value;
}

/* NaN: a number of the grid that is not stated. */
static double number_at(const struct eo_flank_modification *flank, const struct eo_study_variable *variable)
{
  const double *node = is_node(variable) ? eo_modification_node(flank, variable->row, variable->column) : NULL;
  if (is_node(variable))
    return node ? *node : NAN;
  return *(const double *)(const void *)((const char *)flank + variable->field->offset);
}

/* A start that varies takes the place of the one that is stated, in whichever way. */
static void clear_start(struct eo_flank_modification *flank, const struct eo_field *field)
{
  int way, side = start_of(field, &way);
  if (side < 0)
    return;
  *(side == EO_TIP_SIDE ? &flank->tip_relief_start : &flank->root_relief_start) = 0;
  flank->place[side] = (struct eo_relief_place){NAN, NAN, NAN, NAN};
}

static void set_value(const struct eo_study_variable *variable, struct eo_modification *modification, double value)
{
  for (int side = 0; side < 2; side++)
    for (int end = 0; end < 2; end++)
      if (covers(variable, side, end)) {
        struct eo_flank_modification *flank = flank_of(modification, side, variable->member, end);
        clear_start(flank, variable->field);
        set_number(flank, variable, value);
      }
}

/* Of the first flank that it covers. */
static double value_of(const struct eo_study_variable *variable, const struct eo_modification *modification)
{
  const struct eo_flank_modification *flank = variable->side == EO_COAST_FLANK ? modification->coast[variable->member]
                                                                               : modification->flank[variable->member];
  return number_at(&flank[variable->end == EO_RIGHT], variable);
}

/* Whether a flank comes nearer to an impossible one as the number falls: lengths of reliefs, and starts of root reliefs
   from the axis. */
static bool is_tight_when_low(const struct eo_study_variable *variable)
{
  int way, side = start_of(variable->field, &way);
  if (side >= 0 && way > 0)
    return side == EO_ROOT_SIDE ||
           variable->field->offset == offsetof(struct eo_flank_modification, place[EO_TIP_SIDE].length);
  return !is_node(variable) && strstr(variable->field->key, "_length_mm") != NULL;
}

/* Both extremes must be flanks: everything at its upper bound, and the same with the shortest end reliefs. */
static enum eo_code check_extremes(const struct eo_study_space *space, const struct eo_design *design,
                                   const struct eo_geometry *geometry, struct eo_error *error)
{
  struct eo_design extreme = *design;
  enum eo_code code = EO_OK;
  for (int shortest = 0; shortest < 2 && !code; shortest++) {
    struct eo_error found;
    for (int i = 0; i < space->count; i++) {
      const struct eo_study_variable *variable = &space->variable[i];
      set_value(
          variable, &extreme.modification,
          eo_unit_in(variable->field->unit, shortest && is_tight_when_low(variable) ? variable->low : variable->high));
    }
    if (eo_modification_check(&extreme, geometry, &found))
      code = eo_error_set(error, EO_ERROR_INPUT, "/optimization/variable_list",
                          "The bounds allow impossible flanks, %.100s: %.200s", found.pointer, found.text);
  }
  return code;
}

enum eo_code eo_study_space_init(struct eo_study_space *result, const struct eo_design *design,
                                 const struct eo_geometry *geometry, struct eo_error *error)
{
  const struct eo_optimization *optimization = &design->optimization;
  struct eo_study_space space = {0};
  enum eo_code code = eo_design_check_search(design, geometry, error);
  if (code)
    return code;
  if (optimization->variables == EO_VARIABLES_SHARED)
    add_preset(&space, optimization, design->gear_pair.ends == 2 ? EO_BOTH_ENDS : EO_LEFT);
  for (int end = 0; end < design->gear_pair.ends && optimization->variables == EO_VARIABLES_PER_END; end++)
    add_preset(&space, optimization, end);
  for (int i = 0; i < optimization->listed && !code; i++)
    code = add_listed(&space, design, i, error);
  if (!code)
    code = check_extremes(&space, design, geometry, error);
  if (!code)
    *result = space;
  return code;
}

int eo_study_space_blocks(const struct eo_study_space *space, int *block)
{
  int known[EO_MAX_LISTED], blocks = 0;
  for (int i = 0; i < space->count; i++) {
    int b = 0;
    while (b < blocks && known[b] != space->variable[i].end)
      b++;
    if (b == blocks)
      known[blocks++] = space->variable[i].end;
    block[i] = b;
  }
  return blocks;
}

void eo_study_space_apply(const struct eo_study_space *space, const struct eo_modification *base, const double *x,
                          struct eo_modification *modification)
{
  *modification = *base;
  for (int i = 0; i < space->count; i++) {
    const struct eo_study_variable *variable = &space->variable[i];
    double value = fmin(fmax(variable->low + x[i] * (variable->high - variable->low), variable->low), variable->high);
    set_value(variable, modification, eo_unit_in(variable->field->unit, value));
  }
}

/* Whether all flanks that the variable covers have one value. */
static bool is_tied(const struct eo_study_variable *variable, const struct eo_modification *modification)
{
  double value = value_of(variable, modification);
  bool same = true;
  for (int side = 0; side < 2; side++)
    for (int end = 0; end < 2; end++) {
      const struct eo_flank_modification(*flank)[2] = side == EO_DRIVE_FLANK ? modification->flank
                                                                             : modification->coast;
      same = same && (!covers(variable, side, end) || number_at(&flank[variable->member][end], variable) == value);
    }
  return same;
}

/* Puts back what the base has in place of the variable. */
static void restore(const struct eo_study_variable *variable, const struct eo_modification *base,
                    struct eo_modification *rest)
{
  int way, start = start_of(variable->field, &way);
  for (int side = 0; side < 2; side++)
    for (int end = 0; end < 2; end++) {
      const struct eo_flank_modification *from = side == EO_DRIVE_FLANK ? &base->flank[variable->member][end]
                                                                        : &base->coast[variable->member][end];
      struct eo_flank_modification *to = flank_of(rest, side, variable->member, end);
      if (!covers(variable, side, end))
        continue;
      if (is_node(variable) && !eo_modification_node(from, variable->row, variable->column))
        eo_modification_drop_node(to, variable->row, variable->column);
      else
        set_number(to, variable, number_at(from, variable));
      if (start == EO_TIP_SIDE)
        to->tip_relief_start = from->tip_relief_start;
      if (start == EO_ROOT_SIDE)
        to->root_relief_start = from->root_relief_start;
      if (start >= 0)
        to->place[start] = from->place[start];
    }
}

bool eo_study_space_locate(const struct eo_study_space *space, const struct eo_modification *base,
                           const struct eo_modification *modification, double *x)
{
  struct eo_modification rest = *modification;
  for (int i = 0; i < space->count; i++) {
    const struct eo_study_variable *variable = &space->variable[i];
    x[i] = (eo_study_variable_value(variable, modification) - variable->low) / (variable->high - variable->low);
    if (!(x[i] > -1e-12 && x[i] < 1 + 1e-12) || !is_tied(variable, modification))
      return false;
    x[i] = fmin(fmax(x[i], 0), 1);
    restore(variable, base, &rest);
  }
  for (int i = 0; i < 4; i++)
    if (!eo_modification_equal(&rest.flank[i / 2][i % 2], &base->flank[i / 2][i % 2]) ||
        !eo_modification_equal(&rest.coast[i / 2][i % 2], &base->coast[i / 2][i % 2]))
      return false;
  return true;
}

double eo_study_variable_value(const struct eo_study_variable *variable, const struct eo_modification *modification)
{
  return eo_unit_out(variable->field->unit, value_of(variable, modification));
}

static void name_knot(int row, int column, char knot[40])
{
  char of_row[12] = "*", of_column[12] = "*";
  if (row)
    snprintf(of_row, sizeof of_row, "%d", row);
  if (column)
    snprintf(of_column, sizeof of_column, "%d", column);
  snprintf(knot, 40, "[u%s y%s]", of_row, of_column);
}

const char *const eo_variable_end_name[4] = {"left", "right", "both", NULL};

void eo_study_variable_name(const struct eo_study_variable *variable, char *name, size_t size)
{
  static const char *const flank[3] = {"", "coast/", "drive+coast/"};
  char knot[40] = "";
  if (is_node(variable))
    name_knot(variable->row, variable->column, knot);
  snprintf(name, size, "%s/%s/%s%s%s", eo_member_name[variable->member], eo_variable_end_name[variable->end],
           flank[variable->side], variable->field->key, knot);
}

void eo_study_space_hash(const struct eo_study_space *space, char hex[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  for (int i = 0; i < space->count; i++) {
    char name[80];
    eo_study_variable_name(&space->variable[i], name, sizeof name);
    eo_hash_add_text(&hash, "variable", name);
    eo_hash_add_number(&hash, "low", space->variable[i].low);
    eo_hash_add_number(&hash, "high", space->variable[i].high);
  }
  eo_hash_finish(&hash, hex);
}

/* A number at its default, or 0 where that stands for it. */
static bool is_as_meant(const char *key, const json_t *value, const json_t *standard)
{
  bool stands = json_is_null(json_object_get(standard, key)) || strstr(key, "_exponent");
  return json_equal(value, json_object_get(standard, key)) || (stands && json_number_value(value) == 0);
}

/* What differs from the standard, a flank with its defaults as a document; NULL without memory. */
static json_t *encode_flank(const struct eo_flank_modification *flank, const json_t *standard)
{
  json_t *object = standard ? eo_table_encode(&eo_flank_modification_table, flank) : NULL, *value;
  const char *key;
  void *next;
  if (object)
    json_object_foreach_safe(object, next, key, value) if (is_as_meant(key, value, standard))
        json_object_del(object, key);
  return object;
}

static json_t *encode_standard_flank(void)
{
  struct eo_flank_modification standard;
  eo_table_defaults(&eo_flank_modification_table, &standard);
  return eo_table_encode(&eo_flank_modification_table, &standard);
}

static void put_unless_empty(json_t *object, const char *key, json_t *value, bool *failed)
{
  if (value && json_object_size(value) == 0)
    json_decref(value);
  else
    eo_json_put(object, key, value, failed);
}

enum eo_code eo_modification_write(const struct eo_modification *modification, int ends, struct eo_text *text,
                                   struct eo_error *error)
{
  json_t *document = json_object(), *standard = encode_standard_flank();
  bool failed = !document || !standard;
  for (int i = 0; i < 2; i++) {
    json_t *member = json_object();
    failed |= !member;
    for (int end = 0; end < ends; end++) {
      json_t *flank = encode_flank(&modification->flank[i][end], standard);
      failed |= !flank;
      put_unless_empty(flank, "coast", encode_flank(&modification->coast[i][end], standard), &failed);
      put_unless_empty(member, eo_end_name[end], flank, &failed);
    }
    put_unless_empty(document, eo_member_name[i], member, &failed);
  }
  if (!failed)
    eo_json_write(text, document, EO_JSON_CANONICAL);
  json_decref(document);
  json_decref(standard);
  return failed || text->failed ? eo_error_memory(error) : EO_OK;
}

static void name_nodes(json_t *flank)
{
  json_t *nodes = json_object_get(flank, "grid_nodes"), *node;
  size_t i;
  json_array_foreach(nodes, i, node)
  {
    char knot[40], key[80];
    name_knot((int)json_integer_value(json_object_get(node, "row")),
              (int)json_integer_value(json_object_get(node, "column")), knot);
    snprintf(key, sizeof key, EO_GRID_PARAMETER "%s", knot);
    json_object_set(flank, key, json_object_get(node, "delta_um"));
  }
  json_object_del(flank, "grid_nodes");
}

static void name_all_nodes(json_t *modification)
{
  const char *member, *end;
  json_t *ends, *flank;
  json_object_foreach(modification, member, ends) json_object_foreach(ends, end, flank)
  {
    name_nodes(flank);
    name_nodes(json_object_get(flank, "coast"));
  }
}

static void collect_columns(const json_t *value, const char *path, json_t *columns)
{
  const char *key;
  json_t *inner;
  json_object_foreach((json_t *)value, key, inner)
  {
    char longer[200];
    snprintf(longer, sizeof longer, "%.120s%s%.70s", path, *path ? "/" : "", key);
    if (json_is_object(inner))
      collect_columns(inner, longer, columns);
    else
      json_object_set_new(columns, longer, json_true());
  }
}

json_t *eo_modification_columns(const json_t *rows)
{
  json_t *columns = json_object(), *row;
  size_t i;
  json_array_foreach((json_t *)rows, i, row)
  {
    json_t *modification = json_object_get(row, "modification");
    name_all_nodes(modification);
    collect_columns(modification, "", columns);
  }
  return columns;
}

enum eo_code eo_modification_read(const char *text, struct eo_modification *modification, struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = faults ? eo_json_parse(text, strlen(text), error) : NULL;
  enum eo_code code = faults ? EO_ERROR_INPUT : eo_error_memory(error);
  if (document) {
    memset(modification, 0, sizeof *modification);
    eo_table_decode(&eo_modification_terms_table, document, NULL, modification, faults);
    code = eo_faults_first(faults, error);
  }
  json_decref(document);
  free(faults);
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/search_space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "format/json.h"
#include "design/check.h"

static const struct eo_field *flank_field(const char *key)
{
  for (int i = 0; i < eo_flank_modification_table.count; i++)
    if (strcmp(eo_flank_modification_table.field[i].key, key) == 0)
      return &eo_flank_modification_table.field[i];
  return NULL;
}

/* The paper's five, in the order of eo_variable_parameters. */
enum { PRESET = 5 };

static struct eo_range preset_bounds(const struct eo_optimization *o, int parameter)
{
  const struct eo_range range[PRESET] = {o->tip_relief, o->root_relief, o->tip_relief_start, o->root_relief_start,
                                         o->lead_crowning};
  const struct eo_field *field = flank_field(eo_variable_parameters[parameter]);
  if (parameter >= PRESET)
    return (struct eo_range){NAN, NAN};
  return (struct eo_range){eo_unit_out(field->unit, range[parameter].low),
                           eo_unit_out(field->unit, range[parameter].high)};
}

static void add_preset(struct eo_study_space *space, const struct eo_optimization *o, int end)
{
  for (int i = 0; i < PRESET; i++) {
    struct eo_range bounds = preset_bounds(o, i);
    space->variable[space->count++] = (struct eo_study_variable){EO_PINION, end, flank_field(eo_variable_parameters[i]),
                                                                 bounds.low, bounds.high};
  }
}

static enum eo_code fault(const char *pointer_format, int i, struct eo_error *error, const char *text, double a,
                          double b)
{
  char pointer[80];
  snprintf(pointer, sizeof pointer, pointer_format, i);
  return eo_error_set(error, EO_ERROR_INPUT, pointer, text, a, b);
}

/* One list row, made a variable; the field's own range holds as everywhere. */
static enum eo_code add_listed(struct eo_study_space *space, const struct eo_design *design, int i,
                               struct eo_error *error)
{
  const struct eo_listed_variable *row = &design->optimization.list[i];
  const struct eo_field *field = flank_field(eo_variable_parameters[row->parameter]);
  struct eo_range bounds = isnan(row->bounds.low) ? preset_bounds(&design->optimization, row->parameter) : row->bounds;
  int end = row->end == EO_BOTH_ENDS && design->gear_pair.ends == 1 ? EO_LEFT : row->end;
  if (end == EO_RIGHT && design->gear_pair.ends == 1)
    return fault("/optimization/variable_list/%d/end", i, error, "The pair has one end, the left one.", 0, 0);
  if (isnan(bounds.low))
    return fault("/optimization/variable_list/%d/bounds", i, error,
                 "This parameter has no bounds of its own: state them.", 0, 0);
  if (!(bounds.low < bounds.high) || bounds.low < field->low || bounds.high > field->high)
    return fault("/optimization/variable_list/%d/bounds", i, error,
                 "The bounds must increase and stay inside %.6g .. %.6g.", field->low, field->high);
  for (int j = 0; j < space->count; j++) {
    const struct eo_study_variable *other = &space->variable[j];
    if (other->field == field && other->member == row->member &&
        (other->end == end || other->end == EO_BOTH_ENDS || end == EO_BOTH_ENDS))
      return fault("/optimization/variable_list/%d", i, error, "This parameter is a variable already.", 0, 0);
  }
  space->variable[space->count++] = (struct eo_study_variable){row->member, end, field, bounds.low, bounds.high};
  return EO_OK;
}

static void set_value(const struct eo_study_variable *v, struct eo_modification *modification, double value)
{
  for (int end = 0; end < 2; end++)
    if (v->end == end || v->end == EO_BOTH_ENDS)
      *(double *)(void *)((char *)&modification->flank[v->member][end] + v->field->offset) = value;
}

static double value_at(const struct eo_study_variable *v, const struct eo_modification *modification, int end)
{
  return *(const double *)(const void *)((const char *)&modification->flank[v->member][end] + v->field->offset);
}

static bool is_length(const struct eo_study_variable *v)
{
  return v->field == flank_field("leading_end_relief_length_mm") ||
         v->field == flank_field("trailing_end_relief_length_mm");
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
      const struct eo_study_variable *v = &space->variable[i];
      set_value(v, &extreme.modification, eo_unit_in(v->field->unit, shortest && is_length(v) ? v->low : v->high));
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
  const struct eo_optimization *o = &design->optimization;
  struct eo_study_space space = {0};
  enum eo_code code = eo_design_check_search(design, geometry, error);
  if (code)
    return code;
  if (o->variables == EO_VARIABLES_SHARED)
    add_preset(&space, o, design->gear_pair.ends == 2 ? EO_BOTH_ENDS : EO_LEFT);
  for (int end = 0; end < design->gear_pair.ends && o->variables == EO_VARIABLES_PER_END; end++)
    add_preset(&space, o, end);
  for (int i = 0; i < o->listed && !code; i++)
    code = add_listed(&space, design, i, error);
  if (!code)
    code = check_extremes(&space, design, geometry, error);
  if (!code)
    *result = space;
  return code;
}

void eo_study_space_apply(const struct eo_study_space *space, const struct eo_modification *base, const double *x,
                          struct eo_modification *modification)
{
  *modification = *base;
  for (int i = 0; i < space->count; i++) {
    const struct eo_study_variable *v = &space->variable[i];
    double value = fmin(fmax(v->low + x[i] * (v->high - v->low), v->low), v->high);
    set_value(v, modification, eo_unit_in(v->field->unit, value));
  }
}

static bool same_flank(const struct eo_flank_modification *a, const struct eo_flank_modification *b)
{
  for (int i = 0; i < eo_flank_modification_table.count; i++) {
    const struct eo_field *field = &eo_flank_modification_table.field[i];
    if (field->kind == EO_FIELD_NUMBER && *(const double *)(const void *)((const char *)a + field->offset) !=
                                              *(const double *)(const void *)((const char *)b + field->offset))
      return false;
  }
  return a->shape == b->shape;
}

bool eo_study_space_locate(const struct eo_study_space *space, const struct eo_modification *base,
                           const struct eo_modification *modification, double *x)
{
  struct eo_modification rest = *modification;
  for (int i = 0; i < space->count; i++) {
    const struct eo_study_variable *v = &space->variable[i];
    x[i] = (eo_study_variable_value(v, modification) - v->low) / (v->high - v->low);
    if (!(x[i] > -1e-12 && x[i] < 1 + 1e-12) ||
        (v->end == EO_BOTH_ENDS && value_at(v, modification, 0) != value_at(v, modification, 1)))
      return false;
    x[i] = fmin(fmax(x[i], 0), 1);
    for (int end = 0; end < 2; end++)
      if (v->end == end || v->end == EO_BOTH_ENDS)
        *(double *)(void *)((char *)&rest.flank[v->member][end] + v->field->offset) = value_at(v, base, end);
  }
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < 2; end++)
      if (!same_flank(&rest.flank[member][end], &base->flank[member][end]))
        return false;
  return true;
}

double eo_study_variable_value(const struct eo_study_variable *v, const struct eo_modification *modification)
{
  return eo_unit_out(v->field->unit, value_at(v, modification, v->end == EO_RIGHT));
}

void eo_study_variable_name(const struct eo_study_variable *v, char *name, size_t size)
{
  static const char *const member[2] = {"pinion", "gear"}, *const end[3] = {"left", "right", "both"};
  snprintf(name, size, "%s/%s/%s", member[v->member], end[v->end], v->field->key);
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

/* What differs from the defaults of a flank; NULL without memory. */
static json_t *encode_flank(const struct eo_flank_modification *flank)
{
  struct eo_flank_modification standard;
  eo_table_defaults(&eo_flank_modification_table, &standard);
  json_t *object = eo_table_encode(&eo_flank_modification_table, flank),
         *other = eo_table_encode(&eo_flank_modification_table, &standard), *value;
  const char *key;
  void *next;
  if (object && other)
    json_object_foreach_safe(object, next, key, value) if (json_equal(value, json_object_get(other, key)))
        json_object_del(object, key);
  if (!other) {
    json_decref(object);
    object = NULL;
  }
  json_decref(other);
  return object;
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
  static const char *const member_name[2] = {"pinion", "gear"}, *const end_name[2] = {"left", "right"};
  json_t *document = json_object();
  bool failed = !document;
  for (int i = 0; i < 2; i++) {
    json_t *member = json_object();
    failed |= !member;
    for (int end = 0; end < ends; end++)
      put_unless_empty(member, end_name[end], encode_flank(&modification->flank[i][end]), &failed);
    put_unless_empty(document, member_name[i], member, &failed);
  }
  if (!failed)
    eo_json_write(text, document, EO_JSON_CANONICAL);
  json_decref(document);
  return failed || text->failed ? eo_error_memory(error) : EO_OK;
}

enum eo_code eo_modification_read(const char *text, struct eo_modification *modification, struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = faults ? eo_json_parse(text, strlen(text), error) : NULL;
  enum eo_code code = faults ? EO_ERROR_INPUT : eo_error_memory(error);
  if (document) {
    memset(modification, 0, sizeof *modification);
    eo_table_decode(&eo_modification_table, document, NULL, modification, faults);
    code = eo_faults_first(faults, error);
  }
  json_decref(document);
  free(faults);
  return code;
}

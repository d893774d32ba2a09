/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/cells.h"
#include "format/json.h"
#include "variants/variant_axis.h"

static void read_base(struct eo_variant_plan *plan, const json_t *design, struct eo_faults *faults)
{
  struct eo_error error;
  int before = faults->count;
  plan->base = json_deep_copy(design);
  plan->design = calloc(1, sizeof *plan->design);
  if (!plan->base || !plan->design)
    eo_faults_memory(faults);
  else if (eo_design_decode(design, plan->design, NULL, faults) &&
           eo_design_complete(plan->design, &plan->geometry, &error))
    eo_faults_add(faults, error.pointer, "%s", error.text);
  for (int i = before; i < faults->count && i < EO_MAX_FAULTS; i++) {
    char pointer[sizeof faults->fault[i].pointer + 8];
    snprintf(pointer, sizeof pointer, "/design%s", faults->fault[i].pointer);
    snprintf(faults->fault[i].pointer, sizeof faults->fault[i].pointer, "%.*s",
             (int)sizeof faults->fault[i].pointer - 1, pointer);
  }
}

static void read_axes(struct eo_variant_plan *plan, const struct eo_study_order *order, struct eo_faults *faults)
{
  char pointer[40];
  for (int i = 0; i < order->axes; i++) {
    snprintf(pointer, sizeof pointer, "/vary/%d", i);
    eo_variant_axis_name(&plan->axis[i], order->axis[i].key, plan->design, pointer, faults);
    eo_variant_axis_fill(&plan->axis[i], &order->axis[i], plan->sampling, pointer, faults);
  }
  plan->axes = order->axes;
}

/* Rows of a table; a cell without a value leaves the design as it is. */
static void read_rows(struct eo_variant_plan *plan, const struct eo_cells *cells, struct eo_faults *faults)
{
  for (int row = 1; row < cells->rows; row++) {
    json_t *values = json_array();
    bool empty = true;
    for (int i = 0; i < plan->axes; i++) {
      const char *cell = eo_cells_at(cells, row, i);
      json_t *value = *cell ? eo_variant_axis_read(&plan->axis[i], cell) : json_null();
      empty = empty && !*cell;
      if (!value)
        eo_faults_add(faults, "/table", "Line %d, column %d: \"%.60s\" is no value of %.100s.", row + 1, i + 1, cell,
                      plan->axis[i].path[0]);
      json_array_append_new(values, value ? value : json_null());
    }
    if (empty)
      json_decref(values);
    else
      json_array_append_new(plan->table, values);
  }
  if (!json_array_size(plan->table) && !faults->count)
    eo_faults_add(faults, "/table", "The table has no row.");
}

static void read_table(struct eo_variant_plan *plan, const char *text, struct eo_faults *faults)
{
  struct eo_cells cells;
  struct eo_error error;
  if (eo_cells_read(&cells, text, strlen(text), &error)) {
    eo_faults_add(faults, "/table", "%s", error.text);
    return;
  }
  plan->table = json_array();
  if (cells.columns > EO_STUDY_AXES)
    eo_faults_add(faults, "/table", "%d columns are more than %d.", cells.columns, EO_STUDY_AXES);
  for (int i = 0; i < cells.columns && i < EO_STUDY_AXES; i++) {
    eo_variant_axis_name(&plan->axis[i], eo_cells_at(&cells, 0, i), plan->design, "/table", faults);
    plan->axes++;
  }
  if (!faults->count)
    read_rows(plan, &cells, faults);
  eo_cells_done(&cells);
}

static void count_rows(struct eo_variant_plan *plan, struct eo_faults *faults)
{
  struct eo_error error;
  double rows = plan->sampling == EO_STUDY_FACTORIAL ? 1 : plan->samples;
  for (int i = 0; i < plan->axes && plan->sampling == EO_STUDY_FACTORIAL && !plan->table; i++)
    rows *= eo_variant_axis_count(&plan->axis[i]);
  if (plan->table)
    rows = (double)json_array_size(plan->table);
  if (rows > EO_STUDY_MOST_ROWS)
    eo_faults_add(faults, "", "%.0f variants are more than %d.", rows, EO_STUDY_MOST_ROWS);
  else
    plan->rows = (int)rows;
  if (plan->table || plan->sampling == EO_STUDY_FACTORIAL || faults->count)
    return;
  enum eo_sampling sampling = plan->sampling == EO_STUDY_SOBOL ? EO_SAMPLING_SOBOL : EO_SAMPLING_LATIN;
  if (eo_sampler_new(&plan->sampler, sampling, plan->axes, plan->rows, plan->seed, &error))
    eo_faults_add(faults, "/sampling", "%s", error.text);
}

static bool hash_document(const json_t *document, const char *kind, char hash[EO_HASH_LENGTH + 1])
{
  struct eo_text text = {0};
  eo_text_add(&text, kind);
  eo_json_write(&text, document, EO_JSON_CANONICAL);
  bool good = document && !text.failed;
  if (good)
    eo_hash_hex(text.data, text.size, hash);
  eo_text_done(&text);
  return good;
}

/* Of the numbers and the kind of a grid, which belong to the problem of a search, not to a row of it. */
static bool is_of_grid(const char *path)
{
  return strstr(path, ".grid.") || strstr(path, ".grid_nodes.") || strstr(path, "." EO_GRID_PARAMETER ".");
}

static bool varies_grids(const struct eo_variant_plan *plan)
{
  bool varies = false;
  for (int i = 0; i < plan->axes; i++)
    for (int k = 0; k < plan->axis[i].paths; k++)
      varies = varies || is_of_grid(plan->axis[i].path[k]);
  return varies;
}

/* What a hash is of: which grids are designed, which the variables of a search may say, counts too. Where grids vary,
   the hash is not what it was while rows of the history without these grids were taken for them. */
static void name_hash(const struct eo_variant_plan *plan, const char *what, char name[32])
{
  const struct eo_grid_place *grid = &plan->design->grids.place[0][0][0];
  int designed = 0;
  for (int i = 0; i < 8; i++)
    designed |= (grid[i].u_knots > 0 && grid[i].kind == EO_GRID_DESIGNED) << i;
  snprintf(name, 32, "%s", what);
  if (designed)
    snprintf(name + strlen(what), 32 - strlen(what), ", designed %d", designed);
  if (varies_grids(plan))
    snprintf(name + strlen(name), 32 - strlen(name), ", grids");
}

/* Names and what a search is told change no number. */
static bool find_hashes(struct eo_variant_plan *plan, const json_t *document)
{
  json_t *study = json_copy((json_t *)document), *base = json_copy(plan->base);
  char of_design[32], of_study[32];
  json_object_del(base, "name");
  json_object_del(base, "optimization");
  json_object_del(study, "name");
  json_object_set(study, "design", base);
  json_object_set_new(study, "columns", json_string(plan->columns));
  name_hash(plan, "design", of_design);
  name_hash(plan, "study", of_study);
  bool good = hash_document(base, of_design, plan->design_hash) && hash_document(study, of_study, plan->study_hash);
  json_decref(study);
  json_decref(base);
  return good;
}

static void note_kind(struct eo_variant_plan *plan)
{
  plan->of_modification = !varies_grids(plan);
  for (int i = 0; i < plan->axes; i++)
    for (int k = 0; k < plan->axis[i].paths; k++)
      if (strncmp(plan->axis[i].path[k], "modification.", 13) != 0)
        plan->of_modification = false;
}

bool eo_variant_plan_init(struct eo_variant_plan *plan, const json_t *document, struct eo_faults *faults)
{
  struct eo_study_order *order = malloc(sizeof *order);
  const char *table = NULL;
  memset(plan, 0, sizeof *plan);
  if (!order) {
    eo_faults_memory(faults);
    return false;
  }
  if (eo_study_order_decode(document, order, &table, faults)) {
    plan->sampling = (enum eo_study_sampling)order->sampling;
    plan->samples = order->samples;
    plan->seed = order->seed;
    snprintf(plan->columns, sizeof plan->columns, "%s", order->columns);
    read_base(plan, order->design, faults);
    snprintf(plan->name, sizeof plan->name, "%s", *order->name ? order->name : plan->design ? plan->design->name : "");
    if (!faults->count && table)
      read_table(plan, table, faults);
    else if (!faults->count)
      read_axes(plan, order, faults);
    if (!faults->count)
      count_rows(plan, faults);
    if (!faults->count && !find_hashes(plan, document))
      eo_faults_memory(faults);
    note_kind(plan);
  }
  eo_study_order_done(order);
  free(order);
  return !faults->count;
}

void eo_variant_plan_done(struct eo_variant_plan *plan)
{
  for (int i = 0; i < EO_STUDY_AXES; i++)
    eo_variant_axis_done(&plan->axis[i]);
  eo_sampler_free(plan->sampler);
  json_decref(plan->base);
  json_decref(plan->table);
  free(plan->design);
  memset(plan, 0, sizeof *plan);
}

json_t *eo_variant_plan_encode(const json_t *document, const struct eo_variant_plan *plan)
{
  json_t *copy = json_copy((json_t *)document);
  if (!copy || json_object_set_new(copy, "columns", json_string(plan->columns)) ||
      json_object_set_new(copy, "name", json_string(plan->name))) {
    json_decref(copy);
    return NULL;
  }
  return copy;
}

/* Rows: */

json_t *eo_variant_values(const struct eo_variant_plan *plan, int row)
{
  if (plan->table)
    return json_incref(json_array_get(plan->table, (size_t)row));
  json_t *values = json_array();
  int rest = row, size = plan->rows;
  double u[EO_STUDY_AXES];
  if (plan->sampler)
    eo_sampler_at(plan->sampler, row, u);
  for (int i = 0; i < plan->axes && values; i++) {
    const struct eo_variant_axis *axis = &plan->axis[i];
    json_t *value;
    if (plan->sampling == EO_STUDY_FACTORIAL) { /* the last one varies fastest */
      size /= eo_variant_axis_count(axis);
      value = eo_variant_axis_level(axis, rest / size);
      rest %= size;
    } else
      value = eo_variant_axis_at(axis, u[i]);
    if (json_array_append_new(values, value) != 0) {
      json_decref(values);
      values = NULL;
    }
  }
  return values;
}

/* What stands at a path of the base: borrowed, NULL: nothing is stated. */
static const json_t *stated_at(const json_t *base, const char *path)
{
  const json_t *at = base;
  for (const char *part = path; *part && at;) {
    char key[EO_KEY_PATH];
    size_t length = strcspn(part, ".");
    snprintf(key, sizeof key, "%.*s", (int)length, part);
    at = json_is_array(at) ? json_array_get(at, strtoul(key, NULL, 10) - 1) : json_object_get(at, key);
    part += length + (part[length] == '.');
  }
  return at;
}

static json_t *in_unit(const struct eo_variant_axis *axis, const json_t *value)
{
  if (axis->factor == 1 || !json_is_number(value))
    return json_incref((json_t *)value);
  return json_real(json_number_value(value) * axis->factor);
}

/* 10 and 10.0 are one number. */
static bool is_same(const json_t *one, const json_t *other)
{
  if (json_is_number(one) && json_is_number(other))
    return json_number_value(one) == json_number_value(other);
  return json_equal((json_t *)one, (json_t *)other);
}

/* What a variant states otherwise than the base, by path; sorted by the writer of canonical JSON. */
static json_t *find_changes(const struct eo_variant_plan *plan, const json_t *values)
{
  json_t *changes = json_object();
  for (int i = 0; i < plan->axes; i++) {
    const struct eo_variant_axis *axis = &plan->axis[i];
    const json_t *value = json_array_get(values, (size_t)i);
    if (json_is_null(value))
      continue;
    json_t *own = in_unit(axis, value);
    for (int k = 0; k < axis->paths && own; k++)
      if (!is_same(own, stated_at(plan->base, axis->path[k])))
        json_object_set(changes, axis->path[k], own);
    json_decref(own);
  }
  return changes;
}

enum eo_code eo_variant_hash(const struct eo_variant_plan *plan, const json_t *values, char hash[EO_HASH_LENGTH + 1],
                             struct eo_error *error)
{
  json_t *changes = find_changes(plan, values);
  bool good = hash_document(changes, plan->design_hash, hash);
  json_decref(changes);
  return good ? EO_OK : eo_error_memory(error);
}

struct place {
  uint64_t pair; /* of the values that a pair depends on */
  int row, first;
};

static int by_pair(const void *one, const void *other)
{
  const struct place *a = one, *b = other;
  return a->pair != b->pair ? (a->pair < b->pair ? -1 : 1) : a->row - b->row;
}

static int by_first(const void *one, const void *other)
{
  const struct place *a = one, *b = other;
  return a->first != b->first ? a->first - b->first : a->row - b->row;
}

/* FNV-1a: rows that meet by chance only stand beside each other. */
static uint64_t pair_of(const struct eo_variant_plan *plan, int row)
{
  uint64_t hash = UINT64_C(14695981039346656037);
  json_t *values = eo_variant_values(plan, row);
  for (int i = 0; i < plan->axes; i++) {
    if (!plan->axis[i].of_pair)
      continue;
    char *text = json_dumps(json_array_get(values, (size_t)i), JSON_ENCODE_ANY | JSON_COMPACT);
    for (const char *c = text ? text : ""; *c; c++)
      hash = (hash ^ (unsigned char)*c) * UINT64_C(1099511628211);
    hash = (hash ^ 0xff) * UINT64_C(1099511628211);
    free(text);
  }
  json_decref(values);
  return hash;
}

enum eo_code eo_variant_sort(const struct eo_variant_plan *plan, int *order, int *pairs, struct eo_error *error)
{
  bool several = false;
  for (int i = 0; i < plan->axes; i++)
    several = several || plan->axis[i].of_pair;
  *pairs = 1;
  for (int i = 0; i < plan->rows; i++)
    order[i] = i;
  if (!several)
    return EO_OK;
  struct place *place = malloc(sizeof *place * (size_t)plan->rows);
  if (!place)
    return eo_error_memory(error);
  for (int i = 0; i < plan->rows; i++)
    place[i] = (struct place){.pair = pair_of(plan, i), .row = i};
  qsort(place, (size_t)plan->rows, sizeof *place, by_pair);
  for (int i = 0, first = 0; i < plan->rows; i++) {
    first = i && place[i].pair == place[i - 1].pair ? first : place[i].row;
    place[i].first = first;
    *pairs += i && place[i].pair != place[i - 1].pair;
  }
  qsort(place, (size_t)plan->rows, sizeof *place, by_first);
  for (int i = 0; i < plan->rows; i++)
    order[i] = place[i].row;
  free(place);
  return EO_OK;
}

/* The design of a variant, as it would have been stated; NULL without memory, or where the design has no place for a
   value. A value null leaves the design as it is. */
static json_t *variant_document(const json_t *base, const struct eo_variant_axis *axis, int axes, const json_t *values)
{
  json_t *document = json_deep_copy(base);
  for (int i = 0; i < axes && document; i++) {
    const json_t *value = json_array_get(values, (size_t)i);
    if (json_is_null(value))
      continue;
    for (int k = 0; k < axis[i].paths; k++)
      if (eo_design_key_set(document, axis[i].path[k], in_unit(&axis[i], value)) != EO_OK) {
        json_decref(document);
        return NULL;
      }
  }
  return document;
}

static enum eo_code read_design(const json_t *document, struct eo_design *design, struct eo_geometry *geometry,
                                struct eo_faults *faults, struct eo_error *error)
{
  if (!faults)
    return eo_error_memory(error);
  if (!document)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The design has no place for what varies.");
  if (!eo_design_decode(document, design, NULL, faults))
    return eo_faults_first(faults, error);
  return eo_design_complete(design, geometry, error);
}

enum eo_code eo_variant_design(const json_t *base, const struct eo_variant_axis *axis, int axes, const json_t *values,
                               struct eo_design *design, struct eo_geometry *geometry, struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = variant_document(base, axis, axes, values);
  enum eo_code code = read_design(document, design, geometry, faults, error);
  json_decref(document);
  free(faults);
  return code;
}

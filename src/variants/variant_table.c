/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "format/object.h"
#include "format/outline.h"
#include "format/text_table.h"
#include "store/queue.h"
#include "variants/variant_query.h"
#include "variants/variant_study.h"

static enum eo_code read_study(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct eo_variant_table *table = context;
  if (job->kind != EO_JOB_STUDY)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld is no study.", (long long)job->id);
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = eo_json_parse(job->spec, strlen(job->spec), error);
  enum eo_code code = faults && document ? EO_OK : eo_error_memory(error);
  if (!code && !eo_variant_plan_init(&table->plan, document, faults))
    code = eo_faults_first(faults, error);
  if (!code)
    code = eo_variant_scalars(&table->plan, &table->scalars, error);
  json_decref(document);
  free(faults);
  return code;
}

static enum eo_code open_study(struct eo_variant_table *table, struct eo_store *store, struct eo_error *error)
{
  enum eo_job_outcome outcome;
  EO_TRY(eo_queue_find(store, table->job, read_study, table, &outcome, error));
  return outcome == EO_JOB_OUTCOME_DONE
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %lld.", (long long)table->job);
}

/* Rows as they are found: */

struct pick {
  int variant;
  double key;
};

struct search {
  struct eo_variant_table *table;
  struct eo_variant_conditions conditions;
  struct pick *pick; /* [capacity], owned */
  int count, capacity;
};

static enum eo_code look_at(void *context, const struct eo_stored_variant *row, struct eo_error *error)
{
  struct search *search = context;
  search->table->done++;
  if (!eo_variant_fits(search->table, &search->conditions, row))
    return EO_OK;
  if (search->count == search->capacity) {
    int capacity = 2 * search->capacity + 256;
    struct pick *more = realloc(search->pick, sizeof *more * (size_t)capacity);
    if (!more)
      return eo_error_memory(error);
    search->pick = more;
    search->capacity = capacity;
  }
  search->pick[search->count++] = (struct pick){row->ordinal,
                                                eo_variant_number(search->table, &search->conditions.sort, row)};
  return EO_OK;
}

/* What has no number comes last either way; equals stay in the order of the study. */
static int compare(const struct pick *a, const struct pick *b, double sign)
{
  if (isnan(a->key) || isnan(b->key))
    return isnan(a->key) && isnan(b->key) ? a->variant - b->variant : isnan(a->key) ? 1 : -1;
  if (a->key != b->key)
    return sign * a->key < sign * b->key ? -1 : 1;
  return a->variant - b->variant;
}

static int ascending(const void *a, const void *b)
{
  return compare(a, b, 1);
}

static int descending(const void *a, const void *b)
{
  return compare(a, b, -1);
}

static enum eo_code take_page(struct search *search, const struct eo_variant_query *query, struct eo_error *error)
{
  struct eo_variant_table *table = search->table;
  int left = search->count - query->first;
  table->fits = search->count;
  table->count = left < 0 ? 0 : query->most >= 0 && left > query->most ? query->most : left;
  table->variant = malloc(sizeof *table->variant * ((size_t)table->count + 1));
  if (!table->variant)
    return eo_error_memory(error);
  qsort(search->pick, (size_t)search->count, sizeof *search->pick, query->descending ? descending : ascending);
  for (int i = 0; i < table->count; i++)
    table->variant[i] = search->pick[query->first + i].variant;
  return EO_OK;
}

/* Without them a row is found in a tenth of the time. */
static bool needs_numbers(const struct eo_variant_conditions *conditions)
{
  bool needed = conditions->sort.kind == EO_NAME_COLUMN;
  for (int i = 0; i < conditions->count; i++)
    needed = needed || conditions->condition[i].name.kind == EO_NAME_COLUMN;
  return needed;
}

enum eo_code eo_variant_table_init(struct eo_variant_table *table, struct eo_store *store, int64_t job,
                                   const struct eo_variant_query *query, struct eo_error *error)
{
  struct search search = {.table = table};
  memset(table, 0, sizeof *table);
  table->job = job;
  EO_TRY(open_study(table, store, error));
  EO_TRY(eo_variant_query_read(table, query, &search.conditions, error));
  enum eo_code code = eo_store_each_variant(
      store, job, -1, needs_numbers(&search.conditions) ? table->scalars.count : -1, look_at, &search, error);
  if (!code)
    code = take_page(&search, query, error);
  free(search.pick);
  return code;
}

void eo_variant_table_done(struct eo_variant_table *table)
{
  eo_variant_plan_done(&table->plan);
  eo_scalars_done(&table->scalars);
  free(table->variant);
  memset(table, 0, sizeof *table);
}

typedef enum eo_code visit_row(void *context, const struct eo_stored_variant *row, const json_t *values,
                               struct eo_error *error);

struct walk {
  const struct eo_variant_table *table;
  visit_row *visit;
  void *context;
};

static enum eo_code hand_over(void *context, const struct eo_stored_variant *row, struct eo_error *error)
{
  const struct walk *walk = context;
  json_t *values = eo_variant_values(&walk->table->plan, row->ordinal);
  enum eo_code code = values ? walk->visit(walk->context, row, values, error) : eo_error_memory(error);
  json_decref(values);
  return code;
}

static enum eo_code each_row(const struct eo_variant_table *table, struct eo_store *store, visit_row *visit,
                             void *context, struct eo_error *error)
{
  struct walk walk = {table, visit, context};
  for (int i = 0; i < table->count; i++)
    EO_TRY(eo_store_each_variant(store, table->job, table->variant[i], table->scalars.count, hand_over, &walk, error));
  return EO_OK;
}

/* JSON: */

struct written_key {
  const char *name, *unit;
  json_t *paths;
};
static const struct eo_outline_row key_rows[] = {
    EO_KEY("name", "text", "as it was asked for", EO_AT(struct written_key, name)),
    EO_KEY("unit", "text", "of its values; empty without", EO_AT(struct written_key, unit)),
    EO_KEY("paths", "[text]", "of the design that take the value", EO_AT(struct written_key, paths)),
};
static const struct eo_outline key_outline = EO_OUTLINE("StudyKey", key_rows);

static const struct eo_outline_row column_rows[] = {
    EO_KEY("name", "text", "path in the result document", EO_AT(struct eo_result_number, name)),
    EO_KEY("unit", "text", "of its numbers; empty without", EO_AT(struct eo_result_number, unit)),
    EO_KEY("help", "text", "what it is", EO_AT(struct eo_result_number, help)),
};
static const struct eo_outline column_outline = EO_OUTLINE("StudyColumn", column_rows);

struct written_row {
  struct eo_stored_variant row;
  json_t *values;
  struct eo_series numbers;
};
#define OF_ROW(member) EO_AT(struct written_row, member)
static const struct eo_outline_row item_rows[] = {
    EO_KEY("variant", "integer", "its number, from 0", OF_ROW(row.ordinal)),
    EO_KEY("outcome", "word", "refused: such a design cannot be, `reason` says why", .words = eo_store_outcomes,
           OF_ROW(row.outcome)),
    EO_KEY("reason", "text", "empty when it converged", OF_ROW(row.reason)),
    EO_KEY("values", "[number|text|flag?]", "of the keys; null: as the design has it", OF_ROW(values)),
    EO_KEY("numbers", "[number?]", "of the columns", OF_ROW(numbers)),
};
static const struct eo_outline item_outline = EO_OUTLINE("StudyRow", item_rows);

struct written_table {
  struct eo_variant_table table;
  json_t *keys, *items, *next;
};
#define OF_TABLE(member) EO_AT(struct written_table, member)
static const struct eo_outline_row table_rows[] = {
    EO_KEY("job", "integer", "number of the study's job", OF_TABLE(table.job)),
    EO_KEY("name", "text", "for people", OF_TABLE(table.plan.name)),
    EO_KEY("keys", "[object]", "what varies", .outline = &key_outline, OF_TABLE(keys)),
    EO_KEY("columns", "[object]", "what is kept of each result", .outline = &column_outline,
           EO_ROWS_AT(struct written_table, table.scalars.scalar, table.scalars.count)),
    EO_KEY("variants", "integer", "of the study", OF_TABLE(table.plan.rows)),
    EO_KEY("done", "integer", "of them that have a row", OF_TABLE(table.done)),
    EO_KEY("fits", "integer", "of them that the filter lets pass", OF_TABLE(table.fits)),
    EO_KEY("items", "[object]", "a page of these", .outline = &item_outline, OF_TABLE(items)),
    EO_KEY("next", "text?", "cursor of the next page; null: there is none", OF_TABLE(next)),
};
const struct eo_outline eo_variant_table_outline = EO_OUTLINE("StudyTable", table_rows);

static const char *unit_of(const struct eo_variant_axis *axis)
{
  return axis->field->unit && !strchr(axis->name, '[') ? axis->field->unit->symbol : "";
}

static json_t *encode_keys(const struct eo_variant_plan *plan)
{
  struct eo_object keys = eo_list_open();
  for (int i = 0; i < plan->axes; i++) {
    const struct eo_variant_axis *axis = &plan->axis[i];
    struct eo_object paths = eo_list_open();
    for (int k = 0; k < axis->paths; k++)
      eo_list_add(&paths, json_string(axis->path[k]));
    const struct written_key key = {axis->name, unit_of(axis), eo_object_close(&paths)};
    eo_list_add(&keys, eo_outline_encode(&key_outline, &key));
  }
  return eo_object_close(&keys);
}

static const struct eo_outline_row columns_rows[] = {
    EO_KEY("items", "[object]", "in the order of the result document", .outline = &column_outline,
           EO_ROWS_AT(struct eo_scalars, scalar, count)),
};
const struct eo_outline eo_variant_columns_outline = EO_OUTLINE("StudyColumns", columns_rows);

json_t *eo_variant_columns_encode(const struct eo_scalars *scalars)
{
  return eo_outline_encode(&eo_variant_columns_outline, scalars);
}

static enum eo_code add_item(void *context, const struct eo_stored_variant *row, const json_t *values,
                             struct eo_error *error)
{
  json_t *items = context;
  const struct written_row view = {*row, json_incref((json_t *)values), eo_series_of(row->numbers, row->number, 0)};
  json_t *item = eo_outline_encode(&item_outline, &view);
  return item && json_array_append_new(items, item) == 0 ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_variant_table_encode(const struct eo_variant_table *table, struct eo_store *store,
                                     const struct eo_variant_query *query, json_t **document, struct eo_error *error)
{
  json_t *items = json_array();
  int next = query->first + table->count;
  enum eo_code code = items ? each_row(table, store, add_item, items, error) : eo_error_memory(error);
  if (code) {
    json_decref(items);
    return code;
  }
  const struct written_table view = {*table, encode_keys(&table->plan), items,
                                     next < table->fits ? json_sprintf("%d", next) : json_null()};
  *document = eo_outline_encode(&eo_variant_table_outline, &view);
  return *document ? EO_OK : eo_error_memory(error);
}

/* Text: */

static void put_value(struct eo_text_table *sheet, const json_t *value, int digits)
{
  if (json_is_number(value))
    eo_text_table_number(sheet, json_number_value(value), NULL, digits);
  else if (json_is_boolean(value))
    eo_text_table_string(sheet, json_is_true(value) ? "true" : "false");
  else
    eo_text_table_string(sheet, json_is_string(value) ? json_string_value(value) : "");
}

struct sheet {
  struct eo_text_table table;
  int columns, digits; /* columns: of the result that are shown */
};

static enum eo_code add_line(void *context, const struct eo_stored_variant *row, const json_t *values,
                             struct eo_error *error)
{
  struct sheet *sheet = context;
  char number[16];
  snprintf(number, sizeof number, "%d", row->ordinal);
  eo_text_table_string(&sheet->table, number);
  for (size_t i = 0; i < json_array_size(values); i++)
    put_value(&sheet->table, json_array_get(values, i), sheet->digits);
  for (int i = 0; i < sheet->columns; i++)
    eo_text_table_number(&sheet->table, row->number[i], NULL, sheet->digits);
  eo_text_table_string(&sheet->table, eo_store_outcome_name(row->outcome));
  eo_text_table_string(&sheet->table, row->reason);
  return sheet->table.failed ? eo_error_memory(error) : EO_OK;
}

static enum eo_code fill_sheet(const struct eo_variant_table *table, struct eo_store *store, struct sheet *sheet,
                               const char **headings, struct eo_error *error)
{
  int axes = table->plan.axes;
  headings[0] = "variant";
  headings[axes + sheet->columns + 1] = "outcome";
  headings[axes + sheet->columns + 2] = "reason";
  eo_text_table_init(&sheet->table, axes + sheet->columns + 3, headings);
  return each_row(table, store, add_line, sheet, error);
}

enum eo_code eo_variant_table_csv(const struct eo_variant_table *table, struct eo_store *store, struct eo_text *text,
                                  struct eo_error *error)
{
  struct sheet sheet = {.columns = table->scalars.count};
  const char **headings = calloc((size_t)table->plan.axes + (size_t)table->scalars.count + 3, sizeof *headings);
  if (!headings)
    return eo_error_memory(error);
  for (int i = 0; i < table->plan.axes; i++)
    headings[i + 1] = table->plan.axis[i].name;
  for (int i = 0; i < table->scalars.count; i++)
    headings[table->plan.axes + 1 + i] = table->scalars.scalar[i].name;
  enum eo_code code = fill_sheet(table, store, &sheet, headings, error);
  if (!code)
    eo_text_table_csv(&sheet.table, text);
  eo_text_table_done(&sheet.table);
  free(headings);
  return code || !text->failed ? code : eo_error_memory(error);
}

/* The end of a name, with the load case it belongs to: "lte.peak_to_peak_um", "2 impact_N". */
static void shorten(const char *name, char *target, size_t size)
{
  const char *last = strrchr(name, '.'), *load_case = strstr(name, "load_cases.");
  const char *digits = load_case ? load_case + strlen("load_cases.") : "";
  snprintf(target, size, "%.*s%s%s", (int)strcspn(digits, "."), digits, load_case ? " " : "", last ? last + 1 : name);
}

enum eo_code eo_variant_table_print(const struct eo_variant_table *table, struct eo_store *store, struct eo_text *text,
                                    struct eo_error *error)
{
  enum { DIGITS = 5, MOST = 8 };
  int shown = table->scalars.count < MOST ? table->scalars.count : MOST, axes = table->plan.axes;
  struct sheet sheet = {.columns = shown, .digits = DIGITS};
  const char **headings = calloc((size_t)axes + (size_t)shown + 3, sizeof *headings);
  char(*name)[EO_SCALAR_NAME + 400] = calloc((size_t)axes + (size_t)shown, sizeof *name);
  bool room = headings && name;
  for (int i = 0; i < axes + shown && room; i++) {
    shorten(i < axes ? table->plan.axis[i].name : table->scalars.scalar[i - axes].name, name[i], sizeof *name);
    headings[i + 1] = name[i];
  }
  enum eo_code code = room ? fill_sheet(table, store, &sheet, headings, error) : eo_error_memory(error);
  if (!code)
    eo_text_table_print(&sheet.table, 0, text);
  if (!code && shown < table->scalars.count)
    eo_text_print(text, "%d columns more with --csv or --json.\n", table->scalars.count - shown);
  eo_text_table_done(&sheet.table);
  free(headings);
  free(name);
  return code || !text->failed ? code : eo_error_memory(error);
}

enum eo_code eo_variant_table_design(struct eo_store *store, int64_t job, int variant, struct eo_design *design,
                                     struct eo_error *error)
{
  struct eo_variant_table table;
  struct eo_geometry geometry;
  memset(&table, 0, sizeof table);
  table.job = job;
  enum eo_code code = open_study(&table, store, error);
  if (!code && (variant < 0 || variant >= table.plan.rows))
    code = eo_error_set(error, EO_ERROR_INPUT, "", "Study %lld has the variants 0 to %d.", (long long)job,
                        table.plan.rows - 1);
  if (!code) {
    json_t *values = eo_variant_values(&table.plan, variant);
    code = eo_variant_design(table.plan.base, table.plan.axis, table.plan.axes, values, design, &geometry, error);
    json_decref(values);
  }
  eo_variant_table_done(&table);
  return code;
}

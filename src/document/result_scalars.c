/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/result_scalars.h"

#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "design/design_grids.h"
#include "document/result_private.h"

#define EACH "objectives.load_cases.*."
const char eo_scalars_usual[] =
    "objectives.f1_um,objectives.f2_N,objectives.f3_m_per_s2,objectives.J,objectives.fitness,"
    "objectives.violation," EACH "peak_to_peak_um," EACH "impact_N," EACH "rms_m_per_s2," EACH
    "contact_pressure_MPa," EACH "edge_load_share," EACH "contact_loss";

/* Parts of the document that hold results. */
static const char *const parts[] = {"geometry", "unloaded_contact", "load_cases", "objectives", "rating", "tribology"};

struct listing {
  struct eo_scalars *scalars;
  const char *patterns;
  int cases, ends, capacity;
  bool failed, root;
};

/* Whether a name fits pattern number `index`; *there false: there are fewer. */
static bool fits(const char *patterns, int index, const char *name, bool *there, char pattern[EO_SCALAR_NAME])
{
  const char *at = patterns;
  for (int i = 0; i < index && at; i++) {
    at = strchr(at, ',');
    at = at ? at + 1 : NULL;
  }
  *there = at && *at;
  if (!*there)
    return false;
  while (*at == ' ')
    at++;
  snprintf(pattern, EO_SCALAR_NAME, "%.*s", (int)strcspn(at, ", "), at);
  return name && fnmatch(pattern, name, 0) == 0;
}

static void add(struct listing *list, const char *name, const char *unit, const char *help)
{
  struct eo_scalars *scalars = list->scalars;
  char pattern[EO_SCALAR_NAME];
  bool there = true, found = false;
  for (int i = 0; there && !found; i++)
    found = fits(list->patterns, i, name, &there, pattern);
  if (!found)
    return;
  if (scalars->count == list->capacity) {
    int capacity = 2 * list->capacity + 64;
    struct eo_result_number *more = realloc(scalars->scalar, sizeof *more * (size_t)capacity);
    list->failed = list->failed || !more;
    if (!more)
      return;
    scalars->scalar = more;
    list->capacity = capacity;
  }
  struct eo_result_number *scalar = &scalars->scalar[scalars->count++];
  snprintf(scalar->name, sizeof scalar->name, "%s", name);
  scalar->unit = unit;
  scalar->help = help;
}

static void join(char name[EO_SCALAR_NAME], const char *prefix, const char *key)
{
  snprintf(name, EO_SCALAR_NAME, "%s%s%s", prefix, *prefix ? "." : "", key);
}

static void list_table(struct listing *list, const char *prefix, const struct eo_table *table)
{
  char name[EO_SCALAR_NAME], member[EO_SCALAR_NAME + 16];
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    const char *unit = field->unit ? field->unit->symbol : "";
    join(name, prefix, field->key);
    if (field->kind == EO_FIELD_NUMBER || field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_FLAG)
      add(list, name, unit, field->help);
    for (int k = 0; field->kind == EO_FIELD_NUMBERS && k < field->count; k++) {
      snprintf(member, sizeof member, "%s.%d", name, k + 1);
      add(list, member, unit, field->help);
    }
    if (field->kind == EO_FIELD_OBJECT)
      list_table(list, name, field->table);
  }
}

static bool is_number(const char *shape)
{
  static const char *const shapes[] = {"number", "number?", "integer", "integer?", "flag", "flag?"};
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    if (strcmp(shape, shapes[i]) == 0)
      return true;
  return false;
}

static bool is_part(const char *key)
{
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    if (strcmp(key, parts[i]) == 0)
      return true;
  return false;
}

static void list_outline(struct listing *list, const char *prefix, const struct eo_outline *outline);

static void list_row(struct listing *list, const char *prefix, const struct eo_outline_row *row)
{
  char name[EO_SCALAR_NAME], member[EO_SCALAR_NAME + 16];
  join(name, prefix, row->key);
  if (list->ends < 2 && strcmp(row->key, "right") == 0)
    return;
  if (is_number(row->shape))
    add(list, name, row->unit ? row->unit->symbol : "", row->help);
  else if (strncmp(row->shape, "object", 6) == 0 && row->outline)
    list_outline(list, name, row->outline);
  else if (strncmp(row->shape, "object", 6) == 0 && row->table)
    list_table(list, name, row->table);
  else if (strcmp(row->shape, "[object]") == 0 && strcmp(row->key, "load_cases") == 0)
    for (int k = 0; k < list->cases; k++) {
      snprintf(member, sizeof member, "%s.%d", name, k + 1);
      list_outline(list, member, row->outline);
    }
}

static void list_outline(struct listing *list, const char *prefix, const struct eo_outline *outline)
{
  const struct eo_outline_row *row;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++)
    if (*prefix || is_part(row->key))
      list_row(list, prefix, row);
}

/* A pattern that fits nothing is a misspelt one. */
static enum eo_code check_patterns(const struct eo_scalars *scalars, const char *patterns, struct eo_error *error)
{
  char pattern[EO_SCALAR_NAME];
  bool there = true;
  for (int i = 0; there; i++) {
    bool found = false;
    fits(patterns, i, NULL, &there, pattern);
    for (int k = 0; there && k < scalars->count && !found; k++)
      found = fits(patterns, i, scalars->scalar[k].name, &there, pattern);
    if (there && !found)
      return eo_error_set(error, EO_ERROR_INPUT, "/columns",
                          "\"%.100s\" fits no number of the result; easeoff study --list-columns lists them.", pattern);
  }
  return EO_OK;
}

static void find_needs(struct eo_scalars *scalars, const char *patterns)
{
  scalars->objectives = true;
  scalars->want = strstr(patterns, "root_stress") ? EO_WANT_ROOT : 0;
  for (int i = 0; i < scalars->count; i++) {
    const char *name = scalars->scalar[i].name;
    if (strncmp(name, "objectives.", 11) != 0)
      scalars->objectives = false;
    if (strncmp(name, "rating.", 7) == 0 || strncmp(name, "tribology.", 10) == 0)
      scalars->want |= EO_WANT_RATING;
    if (strncmp(name, "load_cases.", 11) == 0 && strstr(name, ".root_stress."))
      scalars->want |= EO_WANT_ROOT;
  }
}

enum eo_code eo_scalars_init(struct eo_scalars *scalars, const char *patterns, int cases, int ends,
                             struct eo_error *error)
{
  struct listing list = {.scalars = scalars, .patterns = patterns, .cases = cases, .ends = ends};
  *scalars = (struct eo_scalars){0};
  list_outline(&list, "", &eo_result_outline);
  enum eo_code code = list.failed ? eo_error_memory(error) : check_patterns(scalars, patterns, error);
  if (!code && !scalars->count)
    code = eo_error_set(error, EO_ERROR_INPUT, "/columns", "No number of the result was chosen.");
  find_needs(scalars, patterns);
  if (code)
    eo_scalars_done(scalars);
  return code;
}

void eo_scalars_done(struct eo_scalars *scalars)
{
  free(scalars->scalar);
  *scalars = (struct eo_scalars){0};
}

/* The number at a name; a flag is 0 or 1. */
static double read_at(const json_t *document, const char *name)
{
  const json_t *at = document;
  for (const char *part = name; *part && at;) {
    char key[EO_SCALAR_NAME];
    size_t length = strcspn(part, ".");
    snprintf(key, sizeof key, "%.*s", (int)length, part);
    at = json_is_array(at) ? json_array_get(at, strtoul(key, NULL, 10) - 1) : json_object_get(at, key);
    part += length + (part[length] == '.');
  }
  return json_is_number(at) ? json_number_value(at) : json_is_boolean(at) ? json_is_true(at) : NAN;
}

static json_t *encode_objectives(const struct eo_analysis *analysis, const struct eo_design *design)
{
  struct eo_result_source source;
  json_t *document = NULL;
  if (eo_result_source_init(&source, analysis, design, 0))
    document = json_pack("{s:o}", "objectives", eo_result_objectives(&source));
  eo_result_source_done(&source);
  return document;
}

static enum eo_code read_all(const struct eo_scalars *scalars, json_t *document, double *value, struct eo_error *error)
{
  if (!document)
    return eo_error_memory(error);
  for (int i = 0; i < scalars->count; i++)
    value[i] = read_at(document, scalars->scalar[i].name);
  json_decref(document);
  return EO_OK;
}

enum eo_code eo_scalars_read(const struct eo_scalars *scalars, const struct eo_analysis *analysis,
                             const struct eo_design *design, double *value, struct eo_error *error)
{
  enum { SHORT = (EO_RESULT_FIRST_PART << EO_RESULT_PARTS) - 1 }; /* everything long is left out */
  return read_all(scalars,
                  scalars->objectives ? encode_objectives(analysis, design)
                                      : eo_result_encode_part(analysis, design, NULL, SHORT),
                  value, error);
}

enum eo_code eo_scalars_of_raw(const struct eo_scalars *scalars, const struct eo_design *design,
                               const struct eo_geometry *geometry, const struct eo_objective_case *raw,
                               const struct eo_objective_case *unmodified, double *value, struct eo_error *error)
{
  struct eo_design *bare = malloc(sizeof *bare);
  size_t cases = (size_t)design->load_cases;
  struct eo_objective_case *copy = malloc(2 * sizeof *copy * cases); /* unmodified, then as designed */
  if (!bare || !copy) {
    free(bare);
    free(copy);
    return eo_error_memory(error);
  }
  *bare = *design;
  bare->modification = eo_design_unmodified(design);
  memcpy(copy, unmodified, sizeof *copy * cases);
  memcpy(copy + cases, raw, sizeof *copy * cases);
  struct eo_analysis analysis = {.cases = design->load_cases, .scenarios = 1, .unmodified = copy};
  const struct eo_evaluation evaluation = {.cases = design->load_cases, .objective = copy + cases};
  eo_evaluator_combine(design, geometry, raw, unmodified, &analysis.value);
  eo_evaluator_combine(bare, geometry, unmodified, unmodified, &analysis.unmodified_value);
  const struct eo_result_source source = {.analysis = &analysis, .evaluation = &evaluation, .design = design};
  enum eo_code code = read_all(scalars, json_pack("{s:o}", "objectives", eo_result_objectives(&source)), value, error);
  free(copy);
  free(bare);
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/rexs_export.h"
#include "exchange/rexs_read.h"
#include "exchange/rexs_schema.h"
#include "format/json.h"

json_t *eo_rexs_part(struct eo_rexs_import *import, json_t *document, const char *key)
{
  json_t *part = json_object_get(document, key);
  if (!part && json_object_set_new(document, key, part = json_object()) != 0) {
    import->out->failed = true;
    return NULL;
  }
  return part;
}

bool eo_rexs_put(struct eo_rexs_import *import, const struct eo_table *table, json_t *object, const char *key,
                 double value)
{
  if (!isfinite(value) || !eo_import_has_key(table, key))
    return false;
  bool whole = false;
  for (int i = 0; i < table->count; i++)
    whole = whole || (strcmp(table->field[i].key, key) == 0 && table->field[i].kind == EO_FIELD_INTEGER);
  json_t *number = whole ? eo_json_whole(value) : json_real(value);
  import->out->failed = json_object_set_new(object, key, number) != 0 || import->out->failed;
  return true;
}

bool eo_rexs_put_word(struct eo_rexs_import *import, const struct eo_table *table, json_t *object, const char *key,
                      const char *word)
{
  if (!eo_import_has_key(table, key))
    return false;
  import->out->failed = json_object_set_new(object, key, json_string(word)) != 0 || import->out->failed;
  return true;
}

const char *eo_rexs_name(const struct eo_rexs_component *component, char name[80])
{
  snprintf(name, 80, "%.60s %d", eo_rexs_type_today(component->type), component->id);
  return name;
}

/* Faults of the model: */

static void put_place(struct eo_import *out, struct eo_import_fault *fault, const struct eo_rexs_model *model,
                      const struct eo_rexs_fault *found)
{
  char pointer[100];
  const struct eo_rexs_place *place = found->attribute   ? &found->attribute->place
                                      : found->component ? &found->component->place
                                                         : &found->relation->place;
  if (!model->json) {
    fault->line = place->line;
    fault->column = place->column;
    return;
  }
  if (found->attribute)
    snprintf(pointer, sizeof pointer, "/model/components/%d/attributes/%d", found->component->place.index,
             place->index);
  else
    snprintf(pointer, sizeof pointer, "/model/%s/%d", found->component ? "components" : "relations", place->index);
  fault->pointer = eo_import_text(out, pointer);
}

/* The first component of a relation, which is what it is about: the gear of a flank relation, the stage of a stage. */
static const struct eo_rexs_component *subject_of(const struct eo_rexs_model *model,
                                                  const struct eo_rexs_relation *relation, int *missing)
{
  const struct eo_rexs_component *subject = NULL;
  for (int i = 0; i < relation->count; i++) {
    const struct eo_rexs_component *component = eo_rexs_find(model, relation->reference[i].id);
    if (!component)
      *missing = relation->reference[i].id;
    else if (!subject)
      subject = component;
  }
  return subject;
}

static void put_component(struct eo_import *out, struct eo_import_fault *fault,
                          const struct eo_rexs_component *component)
{
  fault->of_component = true;
  fault->component = component->id;
  fault->component_type = eo_import_text(out, component->type);
}

static void put_relation(struct eo_import *out, struct eo_import_fault *fault, const struct eo_rexs_model *model,
                         const struct eo_rexs_relation *relation)
{
  char name[80], of[120];
  fault->of_component = true;
  const struct eo_rexs_component *subject = subject_of(model, relation, &fault->component);
  snprintf(of, sizeof of, "%.30s of %.80s", relation->type, subject ? eo_rexs_name(subject, name) : "nothing");
  fault->relation = eo_import_text(out, of);
}

struct telling {
  struct eo_import *out;
  const struct eo_rexs_model *model;
};

static void tell(void *context, const struct eo_rexs_fault *found)
{
  const struct telling *telling = context;
  struct eo_import *out = telling->out;
  char name[80];
  if (!found->severe) {
    eo_import_say(out, out->notes, "%s: %s: %s", found->kind,
                  found->component ? eo_rexs_name(found->component, name) : found->relation->type, found->text);
    return;
  }
  struct eo_import_fault *fault = eo_import_fault(out, found->kind, "%s%s%s",
                                                  found->component ? eo_rexs_name(found->component, name) : "",
                                                  found->component ? ": " : "", found->text);
  if (!fault)
    return;
  if (found->component)
    put_component(out, fault, found->component);
  if (found->attribute)
    fault->attribute = eo_import_text(out, found->attribute->id);
  if (found->relation)
    put_relation(out, fault, telling->model, found->relation);
  put_place(out, fault, telling->model, found);
}

/* What might be a misspelt name of an attribute that is missing. */
static void name_unknown(struct eo_import *out, const struct eo_rexs_component *component)
{
  char name[80];
  for (int i = 0; i < component->count; i++) {
    const struct eo_rexs_rule *rule = eo_rexs_rule_of(component->attribute[i].id);
    if (!rule || !eo_rexs_rule_on(rule, component->type))
      eo_import_say(out, out->notes, "unknown_attribute: %s: %s (line %d) is no attribute that Easeoff reads.",
                    eo_rexs_name(component, name), component->attribute[i].id, component->attribute[i].place.line);
  }
}

/* A gear without one of these has no geometry. */
static void demand_attributes(struct eo_import *out, const struct eo_rexs_model *model,
                              const struct eo_rexs_component *gear)
{
  static const char *const needed[] = {"number_of_teeth", "normal_module", "helix_angle_reference_diameter",
                                       "face_width"};
  char name[80];
  for (size_t i = 0; i < sizeof needed / sizeof *needed; i++) {
    bool there = eo_rexs_attribute(gear, needed[i]) ||
                 (strcmp(needed[i], "normal_module") == 0 && eo_rexs_attribute(gear, "transverse_module"));
    struct eo_import_fault *fault = there ? NULL
                                          : eo_import_fault(out, "missing_attribute",
                                                            "%s has no %s, and a design needs it.",
                                                            eo_rexs_name(gear, name), needed[i]);
    if (!fault)
      continue;
    put_component(out, fault, gear);
    fault->attribute = eo_import_text(out, needed[i]);
    put_place(out, fault, model, &(struct eo_rexs_fault){.component = gear});
    name_unknown(out, gear);
  }
}

/* What can be chosen: */

static void put_ids(struct eo_import_pair *listed, const struct eo_rexs_train *train, const struct eo_rexs_pair *pair)
{
  listed->ends = listed->stages = pair->ends;
  for (int end = 0; end < pair->ends; end++) {
    const struct eo_rexs_mesh *mesh = &train->mesh[pair->mesh[end]];
    listed->pinion[end] = mesh->wheel[pair->driver].gear->id;
    listed->gear[end] = mesh->wheel[!pair->driver].gear->id;
    listed->stage[end] = mesh->stage->id;
  }
}

static void list_pairs(struct eo_import *out, const struct eo_rexs_train *train)
{
  for (int i = 0; i < train->pairs; i++) {
    const struct eo_rexs_pair *pair = &train->pair[i];
    const struct eo_rexs_mesh *mesh = &train->mesh[pair->mesh[0]];
    struct eo_import_pair *listed = eo_import_list(out);
    if (!listed)
      return;
    char label[sizeof listed->label], name[61];
    eo_text_clean(name, sizeof name, mesh->stage->name);
    int n = snprintf(label, sizeof label, pair->ends == 2 ? "stages %d and %d" : "stage %d", mesh->stage->id,
                     train->mesh[pair->mesh[pair->ends - 1]].stage->id);
    snprintf(label + n, sizeof label - (size_t)n, ": %.0f and %.0f teeth, module %.6g mm%s%s",
             fmax(0, mesh->wheel[pair->driver].teeth), fmax(0, mesh->wheel[!pair->driver].teeth), mesh->wheel[0].module,
             *name ? ", " : "", name);
    eo_text_clean(listed->label, sizeof listed->label, label);
    put_ids(listed, train, pair);
    listed->importable = !*pair->why;
    eo_text_clean(listed->remark, sizeof listed->remark, *pair->why ? pair->why : pair->remark);
  }
}

static const struct eo_rexs_pair *choose(struct eo_import *out, const struct eo_rexs_train *train, int wanted)
{
  if (!train->pairs) {
    eo_import_fault(out, "no_pair", "The model has no cylindrical stage with two gears, so there is no pair to read.");
    return NULL;
  }
  if (!wanted && train->pairs > 1) {
    eo_import_fault(out, "choice_needed", "The model has %d pairs; choose one by its number (--pair N).", train->pairs);
    return NULL;
  }
  if (wanted < 0 || wanted > train->pairs) {
    eo_import_fault(out, "no_such_pair", "There is no pair %d; the model has 1 to %d.", wanted, train->pairs);
    return NULL;
  }
  const struct eo_rexs_pair *pair = &train->pair[wanted ? wanted - 1 : 0];
  if (*pair->why) {
    eo_import_fault(out, "not_importable", "The pair cannot be read: %s.", pair->why);
    return NULL;
  }
  out->taken = (int)(pair - train->pair) + 1;
  return pair;
}

/* The pair: */

static void gather_wheels(struct eo_rexs_import *import)
{
  for (int end = 0; end < import->pair->ends; end++)
    for (int member = 0; member < 2; member++)
      import->wheel[member][end] = import->train->mesh[import->pair->mesh[end]]
                                       .wheel[member == EO_PINION ? import->pair->driver : !import->pair->driver];
}

static const struct eo_rexs_component *first_of(const struct eo_rexs_model *model, const char *type)
{
  for (int i = 0; i < model->components; i++)
    if (eo_rexs_is(&model->component[i], type))
      return &model->component[i];
  return NULL;
}

static void read_name(struct eo_rexs_import *import, json_t *design)
{
  const struct eo_rexs_component *unit = first_of(import->model, "gear_unit");
  const struct eo_rexs_attribute *model_name = eo_rexs_attribute(unit, "model_name");
  const char *name = unit && *unit->name ? unit->name : model_name ? model_name->text : "";
  char clean[EO_NAME_LENGTH];
  eo_text_clean(clean, sizeof clean, name);
  if (*clean)
    import->out->failed = json_object_set_new(design, "name", json_string(clean)) != 0 || import->out->failed;
}

static void read_pair(struct eo_rexs_import *import)
{
  struct eo_import *out = import->out;
  for (int end = 0; end < import->pair->ends; end++)
    for (int member = 0; member < 2; member++)
      demand_attributes(out, import->model, import->train->mesh[import->pair->mesh[end]].wheel[member].gear);
  if (out->faults)
    return;
  gather_wheels(import);
  if (!import->pair->driver_stated)
    eo_import_say(out, out->assumed, "gear_1 of the stage drives: neither is_driving_gear nor a torque says which");
  json_t *design = json_object();
  out->design = design;
  read_name(import, design);
  if (!eo_rexs_read_gear_pair(import, design) || !eo_rexs_find_rotation(import))
    return;
  eo_rexs_read_hand(import, design);
  eo_rexs_read_bodies(import, design);
  eo_rexs_read_loads(import, design);
  eo_rexs_read_modification(import, design);
  eo_rexs_name_unused(import);
}

/* A file of Easeoff's own carries the design it was made of. It holds where the model still says what that design says:
   where the design, written again and read as any model, gives what this file gives. */
static bool alike(const json_t *a, const json_t *b)
{
  const double same = 1e-9;
  const char *key;
  json_t *value;
  size_t i;
  if (json_is_number(a) && json_is_number(b)) {
    double x = json_number_value(a), y = json_number_value(b);
    return fabs(x - y) <= same * fmax(1, fabs(x));
  }
  if (json_typeof(a) != json_typeof(b) || json_object_size(a) != json_object_size(b) ||
      json_array_size(a) != json_array_size(b))
    return false;
  json_object_foreach((json_t *)a, key, value)
  {
    const json_t *other = json_object_get(b, key);
    if (!other || !alike(value, other))
      return false;
  }
  json_array_foreach(a, i, value) if (!alike(value, json_array_get(b, i))) return false;
  return json_is_object(a) || json_is_array(a) || json_equal(a, b);
}

static json_t *carried_design(const struct eo_rexs_model *model)
{
  struct eo_error error;
  for (int i = 0; i < model->components; i++) {
    const struct eo_rexs_attribute *attribute = eo_rexs_attribute(&model->component[i], "custom_easeoff_design");
    if (attribute)
      return eo_json_parse(attribute->text, strlen(attribute->text), &error);
  }
  return NULL;
}

static void read_model(struct eo_import *out, const struct eo_rexs_model *model,
                       const struct eo_import_options *options);

/* What a model of the design would be read as; false: it can no longer be read or completed. */
static bool read_again(const json_t *carried, struct eo_import *again)
{
  struct eo_design *design = calloc(1, sizeof *design);
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_rexs_model *model = calloc(1, sizeof *model);
  struct eo_geometry geometry;
  struct eo_error error;
  const struct eo_import_options options = {0};
  bool good = design && faults && model && eo_import_begin(again) && eo_design_decode(carried, design, NULL, faults) &&
              !eo_design_complete(design, &geometry, &error);
  if (good) {
    eo_rexs_export(design, &geometry, EO_REXS_EXPORT_VERSION, true, model);
    again->failed = again->failed || model->failed;
    if (!again->failed)
      read_model(again, model, &options);
    good = !again->failed && again->design && !again->faults;
  }
  again->failed = again->failed || !design || !faults || !model;
  if (model)
    eo_rexs_done(model);
  free(model);
  free(design);
  free(faults);
  return good;
}

static void take_carried_design(struct eo_import *out, const struct eo_rexs_model *model)
{
  json_t *carried = out->design && !out->faults ? carried_design(model) : NULL;
  struct eo_import again = {0};
  if (!carried)
    return;
  if (read_again(carried, &again) && alike(out->design, again.design)) {
    json_decref(out->design);
    out->design = json_incref(carried);
    json_array_clear(out->assumed);
    json_array_clear(out->refused);
    eo_import_say(out, out->notes,
                  "The file carries the design that it was made of and still says the same: that design "
                  "was taken, whole.");
  } else if (!again.failed)
    eo_import_say(out, out->notes,
                  "The file carries an Easeoff design, but its model says something else by now: the "
                  "model was read.");
  out->failed = out->failed || again.failed;
  eo_import_done(&again);
  json_decref(carried);
}

static void read_model(struct eo_import *out, const struct eo_rexs_model *model,
                       const struct eo_import_options *options)
{
  struct telling telling = {out, model};
  struct eo_error error;
  struct eo_rexs_train *train = calloc(1, sizeof *train);
  struct eo_rexs_import *import = calloc(1, sizeof *import);
  snprintf(out->format, sizeof out->format, "REXS %.20s (%s)", model->version, model->json ? "JSON" : "XML");
  if (!eo_rexs_version(model->version))
    eo_import_say(out, out->notes, "The version \"%.20s\" of REXS is not known; the file is read as 1.7.",
                  model->version);
  out->failed = !eo_rexs_check(model, tell, &telling) || out->failed || !train || !import;
  if (!out->failed && !eo_rexs_train_find(train, model, &error))
    eo_import_fault(out, "too_large", "%s", error.text);
  else if (!out->failed && out->faults) {
    for (int i = 0; i < train->meshes; i++)
      for (int k = 0; k < 2; k++)
        demand_attributes(out, model, train->mesh[i].wheel[k].gear);
  } else if (!out->failed) {
    list_pairs(out, train);
    import->out = out;
    import->options = options;
    import->model = model;
    import->train = train;
    import->pair = choose(out, train, options->pair);
    if (import->pair)
      read_pair(import);
  }
  free(train);
  free(import);
}

void eo_import_rexs(struct eo_import *out, const char *bytes, size_t size, const struct eo_import_options *options)
{
  struct eo_rexs_model *model = calloc(1, sizeof *model);
  struct eo_rexs_problem problem;
  if (!model)
    out->failed = true;
  else if (eo_rexs_read(model, bytes, size, &problem)) {
    read_model(out, model, options);
    take_carried_design(out, model);
  } else if (problem.error.code == EO_ERROR_MEMORY)
    out->failed = true;
  else {
    snprintf(out->format, sizeof out->format, "REXS");
    struct eo_import_fault *fault = eo_import_fault(out, problem.kind, "%s", problem.error.text);
    if (fault) {
      fault->line = problem.line;
      fault->column = problem.column;
    }
  }
  if (model)
    eo_rexs_done(model);
  free(model);
}

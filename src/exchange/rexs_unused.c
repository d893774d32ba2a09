/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of a model no part of the import reads, by name: components of other kinds, attributes beside those that a
   design has keys for. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/rexs_import.h"
#include "exchange/rexs_schema.h"

/* Kinds of components that the import reads where they belong to the pair. */
static const char *const read_types[] = {
    "gear_unit",
    "shaft",
    "shaft_section",
    "external_load",
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
    "coupling",
    "switchable_coupling",
    "cylindrical_stage",
    "cylindrical_stage_gear_data",
    "cylindrical_gear",
    "cylindrical_gear_flank",
    "cylindrical_gear_manufacturing_settings",
    "rack_shaped_tool",
    "material",
    "gear_body",
    "tip_relief",
    "root_relief",
    "profile_crowning",
    "profile_slope",
    "profile_twist",
    "helix_crowning",
    "helix_slope",
    "end_relief_datum_face",
    "end_relief_non_datum_face",
    "triangular_tip_relief",
    "triangular_root_relief",
    "topographical_modification",
    NULL,
};

static bool is_read(const char *type)
{
  for (int i = 0; read_types[i]; i++)
    if (strcmp(read_types[i], eo_rexs_type_today(type)) == 0)
      return true;
  return false;
}

static void mark(bool *here, const struct eo_rexs_model *model, const struct eo_rexs_component *component)
{
  if (component)
    here[component - model->component] = true;
}

/* Relations of other kinds tie nothing together for the import: with a misspelt one a relief belongs nowhere. */
static bool is_read_in(const struct eo_rexs_relation *relation)
{
  return eo_rexs_role_after(relation->type, NULL) != NULL;
}

/* What a relation ties to something of the pair; parts of a shaft but not the gears of other stages on it. */
static void mark_tied(const struct eo_rexs_import *import, bool *here, const struct eo_rexs_relation *relation)
{
  const struct eo_rexs_model *model = import->model;
  const struct eo_rexs_component *first = relation->count ? eo_rexs_find(model, relation->reference[0].id) : NULL;
  bool assembly = strcmp(relation->type, "assembly") == 0, side = strcmp(relation->type, "side") == 0;
  bool tied = first && here[first - model->component];
  if (strcmp(relation->type, "stage") == 0 || strcmp(relation->type, "stage_gear_data") == 0 || !is_read_in(relation))
    return;
  if (side) /* the shaft inside decides */
    first = eo_rexs_find(model, eo_rexs_role(relation, "inner_part"));
  tied = first && here[first - model->component] && !eo_rexs_is(first, "gear_unit");
  for (int i = 0; i < relation->count && tied; i++) {
    const struct eo_rexs_component *part = eo_rexs_find(model, relation->reference[i].id);
    bool elsewhere = eo_rexs_is(part, "cylindrical_gear") || eo_rexs_is(part, "shaft");
    if (part && !((assembly || side) && elsewhere))
      mark(here, model, part);
  }
}

static void mark_pair(const struct eo_rexs_import *import, bool *here)
{
  const struct eo_rexs_model *model = import->model;
  for (int end = 0; end < import->pair->ends; end++) {
    mark(here, model, import->train->mesh[import->pair->mesh[end]].stage);
    for (int member = 0; member < 2; member++) {
      const struct eo_rexs_wheel *wheel = &import->wheel[member][end];
      mark(here, model, wheel->gear);
      mark(here, model, wheel->data);
      mark(here, model, wheel->flank[0]);
      mark(here, model, wheel->flank[1]);
      mark(here, model, wheel->shaft < 0 ? NULL : import->train->shaft[wheel->shaft]);
    }
  }
  for (int i = 0; i < model->components; i++)
    if (eo_rexs_is(&model->component[i], "gear_unit"))
      here[i] = true;
  for (int round = 0; round < 2; round++) /* flanks, then what stands at them */
    for (int i = 0; i < model->relations; i++)
      mark_tied(import, here, &model->relation[i]);
}

/* Attributes that the schema table has are read, or say nothing about a design; those that a part refuses it names. */
static void name_attributes(const struct eo_rexs_import *import, const struct eo_rexs_component *component)
{
  char name[80];
  for (int i = 0; i < component->count; i++) {
    const struct eo_rexs_attribute *attribute = &component->attribute[i];
    const struct eo_rexs_rule *rule = eo_rexs_rule_of(attribute->id);
    if (!rule || !eo_rexs_rule_on(rule, component->type))
      eo_import_say(import->out, import->out->not_used, "%s of %s", attribute->id, eo_rexs_name(component, name));
  }
}

/* A flank that refers to its reliefs, or is the workpiece of a step, is not held by that: a gear must have it. */
static void mark_held(bool *held, const struct eo_rexs_model *model)
{
  for (int i = 0; i < model->relations; i++) {
    const struct eo_rexs_relation *relation = &model->relation[i];
    for (int k = 0; k < relation->count && is_read_in(relation); k++) {
      const struct eo_rexs_reference *reference = &relation->reference[k];
      if (strcmp(reference->role, "origin") != 0 && strcmp(reference->role, "workpiece") != 0)
        mark(held, model, eo_rexs_find(model, reference->id));
    }
  }
}

static void name_unused(struct eo_rexs_import *import, const bool *here, const bool *held)
{
  const struct eo_rexs_model *model = import->model;
  char name[80];
  int elsewhere = 0;
  for (int i = 0; i < model->components; i++) {
    const struct eo_rexs_component *component = &model->component[i];
    if (!is_read(component->type))
      eo_import_say(import->out, import->out->not_used, "%s", eo_rexs_name(component, name));
    else if (here[i])
      name_attributes(import, component);
    else if (held[i])
      elsewhere++;
    else
      eo_import_say(import->out, import->out->not_used, "%s, which no relation that is read holds",
                    eo_rexs_name(component, name));
  }
  if (elsewhere)
    eo_import_say(import->out, import->out->notes, "%d components belong to other pairs or shafts.", elsewhere);
}

void eo_rexs_name_unused(struct eo_rexs_import *import)
{
  size_t components = (size_t)import->model->components;
  bool *here = calloc(2 * components + 1, sizeof *here);
  if (!here) {
    import->out->failed = true;
    return;
  }
  mark_pair(import, here);
  mark_held(here + components, import->model);
  name_unused(import, here, here + components);
  free(here);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A model against the schema. What an import never reads may be as it likes. */
#include "exchange/rexs_schema.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void teller(void *context, const struct eo_rexs_fault *fault);

struct check {
  const struct eo_rexs_model *model;
  int version;
  teller *tell;
  void *context;
  int *id; /* of all components, sorted */
};

__attribute__((format(printf, 7, 8))) static void tell(const struct check *check, const char *kind, bool severe,
                                                       const struct eo_rexs_component *component,
                                                       const struct eo_rexs_attribute *attribute,
                                                       const struct eo_rexs_relation *relation, const char *format, ...)
{
  struct eo_rexs_fault fault = {kind, component, attribute, relation, "", severe};
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(fault.text, sizeof fault.text, format, arguments);
  va_end(arguments);
  check->tell(check->context, &fault);
}

static void check_range(const struct check *check, const struct eo_rexs_rule *rule,
                        const struct eo_rexs_component *component, const struct eo_rexs_attribute *attribute,
                        double value)
{
  if (value < rule->low || (rule->above && value == rule->low) || value > rule->high)
    tell(check, "out_of_range", false, component, attribute, NULL, "%s is %.6g; REXS allows %s%.6g to %.6g.",
         attribute->id, value, rule->above ? "above " : "", rule->low, rule->high);
}

static void check_number(const struct check *check, const struct eo_rexs_rule *rule,
                         const struct eo_rexs_component *component, const struct eo_rexs_attribute *attribute)
{
  double value = eo_rexs_number(attribute->text);
  if (attribute->shape != EO_REXS_SCALAR || isnan(value))
    tell(check, "not_a_number", true, component, attribute, NULL, "%s is \"%.40s\"; a number is needed.", attribute->id,
         attribute->text);
  else if (rule->type != EO_REXS_NUMBER && value != floor(value))
    tell(check, "not_a_whole_number", true, component, attribute, NULL, "%s is %.40s; a whole number is needed.",
         attribute->id, attribute->text);
  else
    check_range(check, rule, component, attribute, value);
}

static void check_value(const struct check *check, const struct eo_rexs_rule *rule,
                        const struct eo_rexs_component *component, const struct eo_rexs_attribute *attribute)
{
  switch (rule->type) {
  case EO_REXS_NUMBER:
  case EO_REXS_WHOLE:
  case EO_REXS_COMPONENT:
    check_number(check, rule, component, attribute);
    break;
  case EO_REXS_FLAG:
    if (!eo_rexs_is_in("true false", attribute->text))
      tell(check, "not_a_boolean", true, component, attribute, NULL, "%s is \"%.40s\"; true or false is needed.",
           attribute->id, attribute->text);
    break;
  case EO_REXS_WORD:
    if (!eo_rexs_is_in(rule->words, attribute->text))
      tell(check, "unknown_value", true, component, attribute, NULL, "%s is \"%.40s\"; it is one of: %s.",
           attribute->id, attribute->text, rule->words);
    break;
  case EO_REXS_NUMBERS:
    if (attribute->shape == EO_REXS_SCALAR)
      tell(check, "not_an_array", true, component, attribute, NULL, "%s is \"%.40s\"; an array of numbers is needed.",
           attribute->id, attribute->text);
    for (int i = 0; i < attribute->count; i++)
      if (isnan(attribute->value[i])) {
        tell(check, "not_a_number", true, component, attribute, NULL, "Value %d of %s is no number.", i + 1,
             attribute->id);
        break;
      }
    break;
  case EO_REXS_STRING:
    break;
  }
}

static void check_unit(const struct check *check, const struct eo_rexs_rule *rule,
                       const struct eo_rexs_component *component, const struct eo_rexs_attribute *attribute)
{
  if (rule->beside) /* vectors state mm in some files and none in others, and mean the same */
    return;
  switch (eo_rexs_unit_judge(rule->unit, attribute->unit, check->version)) {
  case EO_REXS_UNIT_RIGHT:
    break;
  case EO_REXS_UNIT_SPELT:
    tell(check, "unit_spelling", false, component, attribute, NULL,
         "The unit of %s is written \"%.20s\"; this version writes \"%s\". It was taken as that.", attribute->id,
         attribute->unit, eo_rexs_unit_in(rule->unit, check->version));
    break;
  case EO_REXS_UNIT_WRONG:
    tell(check, "wrong_unit", true, component, attribute, NULL,
         "%s states the unit \"%.20s\"; in REXS it is always \"%s\", so one of value and unit is wrong.", attribute->id,
         attribute->unit, eo_rexs_unit_in(rule->unit, check->version));
    break;
  case EO_REXS_UNIT_UNKNOWN:
    tell(check, "unknown_unit", true, component, attribute, NULL,
         "%s states the unit \"%.20s\", which REXS does not know; it is "
         "always \"%s\".",
         attribute->id, attribute->unit, eo_rexs_unit_in(rule->unit, check->version));
    break;
  }
}

/* Some programs write every attribute, and leave those empty that the model does not state. */
static bool is_empty(const struct eo_rexs_rule *rule, const struct eo_rexs_attribute *attribute)
{
  return rule->type != EO_REXS_STRING && attribute->shape == EO_REXS_SCALAR && !*attribute->text;
}

static void check_component(const struct check *check, const struct eo_rexs_component *component)
{
  if (!eo_rexs_type_known(component->type))
    tell(check, "unknown_component_type", false, component, NULL, NULL,
         "\"%.60s\" is no type of component in any version "
         "of REXS.",
         component->type);
  for (int i = 0; i < component->count; i++) {
    const struct eo_rexs_attribute *attribute = &component->attribute[i];
    const struct eo_rexs_rule *rule = eo_rexs_rule_of(attribute->id);
    if (!rule || !eo_rexs_rule_on(rule, component->type))
      continue;
    if (is_empty(rule, attribute)) {
      tell(check, "no_value", false, component, attribute, NULL, "%s has no value; it was taken as not stated.",
           attribute->id);
      continue;
    }
    check_unit(check, rule, component, attribute);
    check_value(check, rule, component, attribute);
  }
}

static int compare(const void *a, const void *b)
{
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

static bool exists(const struct check *check, int id)
{
  return bsearch(&id, check->id, (size_t)check->model->components, sizeof id, compare) != NULL;
}

/* A role of a relation that nothing stands in: a reference with an unknown role may be meant for it. */
static const char *free_role(const struct eo_rexs_relation *relation)
{
  const char *role = NULL;
  while ((role = eo_rexs_role_after(relation->type, role)))
    if (!eo_rexs_role(relation, role))
      return role;
  return NULL;
}

static void name_roles(char *text, size_t size, const char *relation)
{
  size_t used = 0;
  const char *role = NULL;
  *text = 0;
  while ((role = eo_rexs_role_after(relation, role)) && used < size)
    used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "", role);
}

/* A component with a misspelt role is as if it were not there, and a flank that is not there is one without relief. */
static void check_role(const struct check *check, const struct eo_rexs_relation *relation,
                       const struct eo_rexs_reference *reference, const struct eo_rexs_component *component)
{
  char roles[120];
  const char *types, *missing;
  switch (eo_rexs_role_judge(relation->type, reference->role, component->type, &types)) {
  case EO_REXS_ROLE_RIGHT:
  case EO_REXS_ROLE_OPEN:
    break;
  case EO_REXS_ROLE_UNKNOWN:
    missing = free_role(relation);
    name_roles(roles, sizeof roles, relation->type);
    tell(check, "unknown_role", missing != NULL, NULL, NULL, relation,
         "Relation %d (%.40s) names component %d as %.30s%s%s; its roles are: %s.", relation->id, relation->type,
         reference->id, reference->role, missing ? ", and none as " : "", missing ? missing : "", roles);
    break;
  case EO_REXS_ROLE_WRONG:
    tell(check, "wrong_component", true, NULL, NULL, relation,
         "Relation %d (%.40s) names component %d, of type %.40s, as %.30s; what stands there is: %s.", relation->id,
         relation->type, reference->id, component->type, reference->role, types);
    break;
  }
}

static void check_relation(const struct check *check, const struct eo_rexs_relation *relation)
{
  for (int i = 0; i < relation->count; i++) {
    const struct eo_rexs_reference *reference = &relation->reference[i];
    if (exists(check, reference->id))
      check_role(check, relation, reference, eo_rexs_find(check->model, reference->id));
    else
      tell(check, "missing_reference", true, NULL, NULL, relation,
           "Relation %d (%.40s) names component %d as %.30s, and there is none of this id.", relation->id,
           relation->type, reference->id, reference->role);
  }
}

bool eo_rexs_check(const struct eo_rexs_model *model, teller *teller_, void *context)
{
  struct check check = {model, eo_rexs_version(model->version), teller_, context, NULL};
  check.id = malloc((size_t)(model->components + 1) * sizeof *check.id);
  if (!check.id)
    return false;
  for (int i = 0; i < model->components; i++)
    check.id[i] = model->component[i].id;
  qsort(check.id, (size_t)model->components, sizeof *check.id, compare);
  for (int i = 1; i < model->components; i++)
    if ((i < 2 || check.id[i - 2] != check.id[i]) && check.id[i] == check.id[i - 1])
      tell(&check, "duplicate_id", true, eo_rexs_find(model, check.id[i]), NULL, NULL,
           "Two components have the id %d, so relations to it can mean either.", check.id[i]);
  for (int i = 0; i < model->relations; i++)
    check_relation(&check, &model->relation[i]);
  for (int i = 0; i < model->components; i++)
    check_component(&check, &model->component[i]);
  for (int i = 0; i < model->load_cases; i++)
    for (int k = 0; k < model->load_case[i].count; k++)
      check_component(&check, &model->load_case[i].component[k]);
  free(check.id);
  return true;
}

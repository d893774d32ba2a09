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

__attribute__((format(printf, 7, 8))) static void tell(const struct check *c, const char *kind, bool severe,
                                                       const struct eo_rexs_component *component,
                                                       const struct eo_rexs_attribute *attribute,
                                                       const struct eo_rexs_relation *relation, const char *format, ...)
{
  struct eo_rexs_fault fault = {kind, component, attribute, relation, "", severe};
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(fault.text, sizeof fault.text, format, arguments);
  va_end(arguments);
  c->tell(c->context, &fault);
}

static bool is_word(const char *words, const char *word)
{
  size_t length = strlen(word);
  for (const char *at = words; length && (at = strstr(at, word)); at += length)
    if ((at == words || at[-1] == ' ') && (at[length] == ' ' || !at[length]))
      return true;
  return false;
}

static void check_range(const struct check *c, const struct eo_rexs_rule *rule,
                        const struct eo_rexs_component *component, const struct eo_rexs_attribute *a, double value)
{
  if (value < rule->low || (rule->above && value == rule->low) || value > rule->high)
    tell(c, "out_of_range", false, component, a, NULL, "%s is %.6g; REXS allows %s%.6g to %.6g.", a->id, value,
         rule->above ? "above " : "", rule->low, rule->high);
}

static void check_number(const struct check *c, const struct eo_rexs_rule *rule,
                         const struct eo_rexs_component *component, const struct eo_rexs_attribute *a)
{
  double value = eo_rexs_number(a->text);
  if (a->shape != EO_REXS_SCALAR || isnan(value))
    tell(c, "not_a_number", true, component, a, NULL, "%s is \"%.40s\"; a number is needed.", a->id, a->text);
  else if (rule->type != EO_REXS_NUMBER && value != floor(value))
    tell(c, "not_a_whole_number", true, component, a, NULL, "%s is %.40s; a whole number is needed.", a->id, a->text);
  else
    check_range(c, rule, component, a, value);
}

static void check_value(const struct check *c, const struct eo_rexs_rule *rule,
                        const struct eo_rexs_component *component, const struct eo_rexs_attribute *a)
{
  switch (rule->type) {
  case EO_REXS_NUMBER:
  case EO_REXS_WHOLE:
  case EO_REXS_COMPONENT:
    check_number(c, rule, component, a);
    break;
  case EO_REXS_FLAG:
    if (!is_word("true false", a->text))
      tell(c, "not_a_boolean", true, component, a, NULL, "%s is \"%.40s\"; true or false is needed.", a->id, a->text);
    break;
  case EO_REXS_WORD:
    if (!is_word(rule->words, a->text))
      tell(c, "unknown_value", true, component, a, NULL, "%s is \"%.40s\"; it is one of: %s.", a->id, a->text,
           rule->words);
    break;
  case EO_REXS_NUMBERS:
    if (a->shape == EO_REXS_SCALAR)
      tell(c, "not_an_array", true, component, a, NULL, "%s is \"%.40s\"; an array of numbers is needed.", a->id,
           a->text);
    for (int i = 0; i < a->count; i++)
      if (isnan(a->value[i])) {
        tell(c, "not_a_number", true, component, a, NULL, "Value %d of %s is no number.", i + 1, a->id);
        break;
      }
    break;
  case EO_REXS_STRING:
    break;
  }
}

static void check_unit(const struct check *c, const struct eo_rexs_rule *rule,
                       const struct eo_rexs_component *component, const struct eo_rexs_attribute *a)
{
  if (rule->beside) /* vectors state mm in some files and none in others, and mean the same */
    return;
  switch (eo_rexs_unit_judge(rule->unit, a->unit, c->version)) {
  case EO_REXS_UNIT_RIGHT:
    break;
  case EO_REXS_UNIT_SPELT:
    tell(c, "unit_spelling", false, component, a, NULL,
         "The unit of %s is written \"%.20s\"; this version writes \"%s\". It was taken as that.", a->id, a->unit,
         eo_rexs_unit_in(rule->unit, c->version));
    break;
  case EO_REXS_UNIT_WRONG:
    tell(c, "wrong_unit", true, component, a, NULL,
         "%s states the unit \"%.20s\"; in REXS it is always \"%s\", so one of value and unit is wrong.", a->id,
         a->unit, eo_rexs_unit_in(rule->unit, c->version));
    break;
  case EO_REXS_UNIT_UNKNOWN:
    tell(c, "unknown_unit", true, component, a, NULL,
         "%s states the unit \"%.20s\", which REXS does not know; it is "
         "always \"%s\".",
         a->id, a->unit, eo_rexs_unit_in(rule->unit, c->version));
    break;
  }
}

static void check_component(const struct check *c, const struct eo_rexs_component *component)
{
  if (!eo_rexs_type_known(component->type))
    tell(c, "unknown_component_type", false, component, NULL, NULL,
         "\"%.60s\" is no type of component in any version "
         "of REXS.",
         component->type);
  for (int i = 0; i < component->count; i++) {
    const struct eo_rexs_attribute *a = &component->attribute[i];
    const struct eo_rexs_rule *rule = eo_rexs_rule_of(a->id);
    if (!rule || !eo_rexs_rule_on(rule, component->type))
      continue;
    check_unit(c, rule, component, a);
    check_value(c, rule, component, a);
  }
}

static int compare(const void *a, const void *b)
{
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

static bool exists(const struct check *c, int id)
{
  return bsearch(&id, c->id, (size_t)c->model->components, sizeof id, compare) != NULL;
}

static void check_relation(const struct check *c, const struct eo_rexs_relation *relation)
{
  for (int i = 0; i < relation->count; i++)
    if (!exists(c, relation->reference[i].id))
      tell(c, "missing_reference", true, NULL, NULL, relation,
           "Relation %d (%.40s) names component %d as %.30s, and there is none of this id.", relation->id,
           relation->type, relation->reference[i].id, relation->reference[i].role);
}

void eo_rexs_check(const struct eo_rexs_model *model, teller *teller_, void *context)
{
  struct check c = {model, eo_rexs_version(model->version), teller_, context, NULL};
  c.id = malloc((size_t)(model->components + 1) * sizeof *c.id);
  if (!c.id)
    return;
  for (int i = 0; i < model->components; i++)
    c.id[i] = model->component[i].id;
  qsort(c.id, (size_t)model->components, sizeof *c.id, compare);
  for (int i = 1; i < model->components; i++)
    if ((i < 2 || c.id[i - 2] != c.id[i]) && c.id[i] == c.id[i - 1])
      tell(&c, "duplicate_id", true, eo_rexs_find(model, c.id[i]), NULL, NULL,
           "Two components have the id %d, so relations to it can mean either.", c.id[i]);
  for (int i = 0; i < model->relations; i++)
    check_relation(&c, &model->relation[i]);
  for (int i = 0; i < model->components; i++)
    check_component(&c, &model->component[i]);
  for (int i = 0; i < model->load_cases; i++)
    for (int k = 0; k < model->load_case[i].count; k++)
      check_component(&c, &model->load_case[i].component[k]);
  free(c.id);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_schema.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/rexs_rules.h"

int eo_rexs_version(const char *version)
{
  if (strcmp(version, "2.0.0") == 0 || strcmp(version, "2.0") == 0)
    return 200;
  if (strncmp(version, "1.", 2) == 0 && version[2] >= '0' && version[2] <= '7' && !version[3])
    return 100 + version[2] - '0';
  return 0;
}

bool eo_rexs_is_in(const char *list, const char *word)
{
  size_t length = strlen(word);
  for (const char *at = list; length && (at = strstr(at, word)); at += length)
    if ((at == list || at[-1] == ' ') && (at[length] == ' ' || !at[length]))
      return true;
  return false;
}

const struct eo_rexs_rule *eo_rexs_rule_of(const char *attribute)
{
  const char *today = eo_rexs_attribute_today(attribute);
  for (int i = 0; i < eo_rexs_rule_count; i++)
    if (strcmp(eo_rexs_rules[i].id, today) == 0)
      return &eo_rexs_rules[i];
  return NULL;
}

bool eo_rexs_rule_on(const struct eo_rexs_rule *rule, const char *type)
{
  return eo_rexs_is_in(rule->on, eo_rexs_type_today(type));
}

static const char *today(const struct eo_rexs_renamed *names, const char *name)
{
  for (; names->today; names++)
    if (strcmp(names->before, name) == 0)
      return names->today;
  return name;
}

static const char *in_version(const struct eo_rexs_renamed *names, const char *name, int version)
{
  for (; names->today; names++)
    if (strcmp(names->today, name) == 0 && version <= names->until)
      return names->before;
  return name;
}

const char *eo_rexs_type_today(const char *type)
{
  return today(eo_rexs_renamed_types, type);
}

const char *eo_rexs_attribute_today(const char *attribute)
{
  return today(eo_rexs_renamed_attributes, attribute);
}

const char *eo_rexs_type_in(const char *type, int version)
{
  return in_version(eo_rexs_renamed_types, type, version);
}

const char *eo_rexs_attribute_in(const char *attribute, int version)
{
  return in_version(eo_rexs_renamed_attributes, attribute, version);
}

bool eo_rexs_type_known(const char *type)
{
  for (int i = 0; eo_rexs_types[i]; i++)
    if (strcmp(eo_rexs_types[i], type) == 0)
      return true;
  return false;
}

/* Names that mean the same, as fold() leaves them: first what stands for all. */
static const char *const synonyms[][4] = {
    {"deg", "°", "degree", "degrees"}, {"none", "", "-", "1"}, {"MPa", "N/mm2"},
    {"1/min", "rpm", "U/min"},         {"kg/dm3", "g/cm3"},    {"%", "percent"},
};
enum { SYNONYMS = sizeof synonyms / sizeof synonyms[0], UNIT = 40 };

/* What is written in more than one way: a product with a sign, a blank or neither, a power with ^ or raised. */
static const struct {
  const char *written, *plain;
} signs[] = {{" ", ""}, {"*", ""}, {"·", ""}, {"^", ""}, {"²", "2"}, {"³", "3"}, {"⁻", "-"}, {"¹", "1"}};
enum { SIGNS = sizeof signs / sizeof signs[0] };

/* A unit in one spelling: "N*m" and "N m" are "Nm", "min^-1" and "1 / min" are "1/min". */
static void fold(const char *unit, char folded[UNIT])
{
  static const char inverse[] = "-1";
  char text[UNIT];
  size_t used = 0;
  for (const char *at = unit; *at && used + 1 < UNIT;) {
    int i = 0;
    while (i < SIGNS && strncmp(at, signs[i].written, strlen(signs[i].written)) != 0)
      i++;
    if (i == SIGNS)
      text[used++] = *at++;
    else {
      at += strlen(signs[i].written);
      if (*signs[i].plain)
        text[used++] = *signs[i].plain;
    }
  }
  text[used] = '\0';
  bool inverted = used > strlen(inverse) && strcmp(text + used - strlen(inverse), inverse) == 0 && !strchr(text, '/');
  if (inverted)
    text[used - strlen(inverse)] = '\0';
  snprintf(folded, UNIT, "%s%.*s", inverted ? "1/" : "", UNIT - 3, text);
  for (int i = 0; i < SYNONYMS; i++)
    for (int k = 0; k < 4 && synonyms[i][k]; k++)
      if (strcmp(synonyms[i][k], folded) == 0)
        snprintf(folded, UNIT, "%s", synonyms[i][0]);
}

static bool is_same_unit(const char *a, const char *b)
{
  char folded[2][UNIT];
  fold(a, folded[0]);
  fold(b, folded[1]);
  return strcmp(folded[0], folded[1]) == 0;
}

const char *eo_rexs_unit_in(const char *unit, int version)
{
  char folded[UNIT];
  fold(unit, folded);
  if (strcmp(folded, "deg") == 0)
    return version < 104 ? "°" : "deg";
  if (strcmp(folded, "MPa") == 0)
    return version < 200 ? "N / mm^2" : "MPa";
  return *unit ? unit : "none";
}

/* The unit of stress is written in its old and its new way in files of every version. */
static bool is_usual(const char *unit, const char *given, int version)
{
  return !*given || strcmp(eo_rexs_unit_in(unit, version), given) == 0 || strcmp(given, "MPa") == 0 ||
         strcmp(given, "N / mm^2") == 0;
}

enum eo_rexs_unit_verdict eo_rexs_unit_judge(const char *unit, const char *given, int version)
{
  if (is_same_unit(unit, given))
    return is_usual(unit, given, version) ? EO_REXS_UNIT_RIGHT : EO_REXS_UNIT_SPELT;
  for (int i = 0; eo_rexs_units[i]; i++)
    if (is_same_unit(eo_rexs_units[i], given) || !*given)
      return EO_REXS_UNIT_WRONG;
  return EO_REXS_UNIT_UNKNOWN;
}

/* True for the types that the table of roles knows: of others it cannot say where they stand. */
static bool stands_in_a_role(const char *type)
{
  for (const struct eo_rexs_relation_role *row = eo_rexs_roles; row->relation; row++)
    if (eo_rexs_is_in(row->types, type))
      return true;
  return false;
}

enum eo_rexs_role_verdict eo_rexs_role_judge(const char *relation, const char *role, const char *type,
                                             const char **types)
{
  bool known = false;
  const char *name = eo_rexs_type_today(type);
  for (const struct eo_rexs_relation_role *row = eo_rexs_roles; row->relation; row++) {
    if (strcmp(row->relation, relation) != 0)
      continue;
    known = true;
    if (strcmp(row->role, role) != 0)
      continue;
    *types = row->types;
    if (eo_rexs_is_in(row->types, name))
      return EO_REXS_ROLE_RIGHT;
    return row->others || !stands_in_a_role(name) ? EO_REXS_ROLE_OPEN : EO_REXS_ROLE_WRONG;
  }
  return known ? EO_REXS_ROLE_UNKNOWN : EO_REXS_ROLE_OPEN;
}

const char *eo_rexs_role_after(const char *relation, const char *role)
{
  bool found = !role;
  for (const struct eo_rexs_relation_role *row = eo_rexs_roles; row->relation; row++) {
    if (strcmp(row->relation, relation) != 0)
      continue;
    if (found)
      return row->role;
    found = strcmp(row->role, role) == 0;
  }
  return NULL;
}

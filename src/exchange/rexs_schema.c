/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_schema.h"

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

/* Spellings that mean the same: first what 1.7 has, then the others. */
static const char *const spellings[][3] = {
    {"deg", "°", "degree"},      {"none", "", NULL},  {"MPa", "N / mm^2", NULL},
    {"1 / min", "1/min", "rpm"}, {"N m", "Nm", NULL},
};
enum { SPELLINGS = sizeof spellings / sizeof spellings[0] };

static const char *plain_unit(const char *unit)
{
  for (int i = 0; i < SPELLINGS; i++)
    for (int k = 0; k < 3 && spellings[i][k]; k++)
      if (strcmp(spellings[i][k], unit) == 0)
        return spellings[i][0];
  return unit;
}

const char *eo_rexs_unit_in(const char *unit, int version)
{
  const char *plain = plain_unit(unit);
  if (strcmp(plain, "deg") == 0 && version < 104)
    return "°";
  if (strcmp(plain, "MPa") == 0 && version < 200)
    return "N / mm^2";
  return plain;
}

enum eo_rexs_unit_verdict eo_rexs_unit_judge(const char *unit, const char *given, int version)
{
  if (strcmp(plain_unit(unit), plain_unit(given)) == 0) {
    bool free = !*given || strcmp(plain_unit(unit), "MPa") == 0;
    return free || strcmp(eo_rexs_unit_in(unit, version), given) == 0 ? EO_REXS_UNIT_RIGHT : EO_REXS_UNIT_SPELT;
  }
  for (int i = 0; eo_rexs_units[i]; i++)
    if (strcmp(eo_rexs_units[i], given) == 0 || !*given)
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

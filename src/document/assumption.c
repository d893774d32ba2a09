/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/assumption.h"

#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "format/object.h"
#include "gear/names.h"

struct assumption {
  const char *key, *rule;
  json_t *value;
};

static const struct eo_outline_row assumption_rows[] = {
    EO_KEY("key", "text", "JSON pointer of the key that was not stated", EO_AT(struct assumption, key)),
    EO_KEY("value", "number|flag|text|[number]|{any}?",
           "what was taken, as the document says it; null: it follows from each load case",
           EO_AT(struct assumption, value)),
    EO_KEY("rule", "text", "by which rule, or from where", EO_AT(struct assumption, rule)),
};
const struct eo_outline eo_outline_assumption = EO_OUTLINE("Assumption", assumption_rows);

/* The groups whose keys an analysis or a rating uses; what lies deeper in one of them is a group of its own. */
static const struct group {
  const char *key;
  const struct eo_table *table;
  size_t offset;
} groups[] = {
    {"gear_pair", &eo_gear_pair_table, offsetof(struct eo_design, gear_pair)},
    {"material", &eo_material_table, offsetof(struct eo_design, material)},
    {"alignment", &eo_alignment_table, offsetof(struct eo_design, alignment)},
    {"supports", &eo_supports_table, offsetof(struct eo_design, supports)},
    {"shafts", &eo_shafts_table, offsetof(struct eo_design, shafts)},
    {"resolution", &eo_resolution_table, offsetof(struct eo_design, resolution)},
    {"rating", &eo_rating_table, offsetof(struct eo_design, rating)},
    {"rating/pinion", &eo_rating_member_table, offsetof(struct eo_design, rating.member[EO_PINION])},
    {"rating/gear", &eo_rating_member_table, offsetof(struct eo_design, rating.member[EO_GEAR])},
    {"rating/lubricant", &eo_lubricant_table, offsetof(struct eo_design, rating.lubricant)},
};
enum { GROUPS = sizeof groups / sizeof *groups, MODIFICATION_BITS = 4, WORD = 64 };

/* Numbers of the bits that belong to no table: each flank, then the shares. */
enum { FLANK_BIT = EO_STATED_WORDS * WORD - MODIFICATION_BITS - 1, SHARE_BIT = EO_STATED_WORDS * WORD - 1 };

static void set_bit(struct eo_design *design, int bit, bool stated)
{
  uint64_t mask = (uint64_t)1 << bit % WORD;
  if (stated)
    design->stated[bit / WORD] |= mask;
  else
    design->stated[bit / WORD] &= ~mask;
}

static bool bit_of(const struct eo_design *design, int bit)
{
  return design->stated[bit / WORD] >> bit % WORD & 1;
}

static bool is_there(const json_t *object, const char *key)
{
  const json_t *value = json_object_get(object, key);
  return value && !json_is_null(value);
}

/* The key itself, or an entry beside it that states the same. */
static bool is_stated(const struct eo_table *table, const struct eo_field *field, const json_t *object)
{
  bool stated = is_there(object, field->key) || (field->alias && is_there(object, field->alias));
  for (int i = 0; i < table->count && !stated; i++) {
    const struct eo_field *other = &table->field[i];
    stated = other->states && strcmp(other->states, field->key) == 0 && is_there(object, other->key);
  }
  return stated;
}

static void note_flanks(const json_t *document, struct eo_design *design)
{
  const json_t *modification = json_object_get(document, "modification");
  for (int i = 0; i < 2; i++)
    for (int end = 0; end < 2; end++)
      set_bit(design, FLANK_BIT + 2 * i + end,
              is_there(json_object_get(modification, eo_member_name[i]), eo_end_name[end]));
}

void eo_assumptions_note(const json_t *document, struct eo_design *design)
{
  int bit = 0;
  for (int g = 0; g < GROUPS; g++) {
    const struct eo_table *table = groups[g].table;
    for (int i = 0; i < table->count; i++)
      set_bit(design, bit++, is_stated(table, &table->field[i], eo_json_find(document, groups[g].key)));
  }
  note_flanks(document, design);
  const json_t *first = json_array_get(json_object_get(document, "load_cases"), 0);
  set_bit(design, SHARE_BIT, design->load_cases == 1 || is_there(first, "share") || is_there(first, "hours"));
}

static void add(json_t *list, const char *key, json_t *value, const char *rule, bool *failed)
{
  const struct assumption view = {key, rule, value};
  *failed = json_array_append_new(list, eo_outline_encode(&eo_outline_assumption, &view)) != 0 || *failed;
}

static const char *rule_of(const struct eo_field *field)
{
  return field->derived ? field->derived : field->basis ? field->basis : "the program's default";
}

/* Nothing is assumed where nothing is taken (the groove of a pair with one end, balls that the dimensions choose), but
   for the mesh damping, which follows from each load case. */
static bool is_listed(const struct eo_field *field, const json_t *value)
{
  return !(field->flags & (EO_FIELD_ENTRY | EO_FIELD_REQUIRED)) && field->kind != EO_FIELD_OBJECT &&
         (!json_is_null(value) || strcmp(field->key, "mesh_damping_stiffness_N_per_um") == 0);
}

static void add_group(json_t *list, const struct eo_design *design, const struct group *group, int bit, bool *failed)
{
  const struct eo_table *table = group->table;
  json_t *encoded = eo_table_encode(table, (const char *)design + group->offset);
  *failed = *failed || !encoded;
  for (int i = 0; i < table->count && !*failed; i++) {
    const struct eo_field *field = &table->field[i];
    char key[128];
    json_t *value = json_object_get(encoded, field->key);
    if (!is_listed(field, value) || bit_of(design, bit + i))
      continue;
    snprintf(key, sizeof key, "/%.40s/%.80s", group->key, field->key);
    add(list, key, json_incref(value), rule_of(field), failed);
  }
  json_decref(encoded);
}

static void add_flanks(json_t *list, const struct eo_design *design, bool *failed)
{
  for (int i = 0; i < 2; i++)
    for (int end = 0; end < design->gear_pair.ends; end++) {
      char key[64];
      snprintf(key, sizeof key, "/modification/%s/%s", eo_member_name[i], eo_end_name[end]);
      if (!bit_of(design, FLANK_BIT + 2 * i + end))
        add(list, key, json_object(), "unmodified", failed);
    }
}

/* Coast flanks that a load case needs. */
static void add_coast_flanks(json_t *list, const struct eo_design *design, bool *failed)
{
  bool needed = false;
  for (int k = 0; k < design->load_cases; k++)
    needed = needed || design->load_case[k].flank == EO_COAST_FLANK;
  for (int i = 0; i < 2 && needed; i++)
    for (int end = 0; end < design->gear_pair.ends; end++) {
      char key[64];
      snprintf(key, sizeof key, "/modification/%s/%s/coast", eo_member_name[i], eo_end_name[end]);
      if (eo_modification_is_none(&design->modification.coast[i][end]) &&
          design->grids.place[EO_COAST_FLANK][i][end].u_knots == 0)
        add(list, key, json_object(), "unmodified", failed);
    }
}

/* Shafts that are rigid are nobody's assumption. */
static bool is_used(const struct eo_design *design, const struct group *group)
{
  return group->table != &eo_shafts_table || design->shafts.enabled;
}

bool eo_assumptions_cover(const struct eo_design *design, const char *pointer)
{
  for (int g = 0; g < GROUPS; g++) {
    size_t length = strlen(groups[g].key);
    if (is_used(design, &groups[g]) && strncmp(pointer + 1, groups[g].key, length) == 0 && pointer[length + 1] == '/')
      return true;
  }
  return false;
}

json_t *eo_assumptions_encode(const struct eo_design *design, bool rating)
{
  json_t *list = json_array();
  bool failed = !list;
  for (int g = 0, bit = 0; g < GROUPS && !failed; bit += groups[g++].table->count)
    if (is_used(design, &groups[g]) && (rating || strncmp(groups[g].key, "rating", 6) != 0))
      add_group(list, design, &groups[g], bit, &failed);
  if (!failed && !bit_of(design, SHARE_BIT))
    add(list, "/load_cases/*/share", json_real(1. / design->load_cases), "equal, as no load case states its share",
        &failed);
  if (!failed)
    add_flanks(list, design, &failed);
  if (!failed)
    add_coast_flanks(list, design, &failed);
  if (!failed)
    return list;
  json_decref(list);
  return NULL;
}

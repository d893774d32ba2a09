/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/design_keys.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "gear/names.h"

/* Symbols of ISO 21771, ISO 53, ISO 1328-1 and ISO 6336, as tables spell them. %: both ends. */
static const struct {
  const char *symbol, *key;
  enum eo_key_doubt doubt;
} symbols[] = {
    {"z", "gear_pair.teeth", EO_KEY_SURE},
    {"m_n", "gear_pair.normal_module_mm", EO_KEY_USUAL},
    {"mn", "gear_pair.normal_module_mm", EO_KEY_USUAL},
    {"alpha_n", "gear_pair.normal_pressure_angle_deg", EO_KEY_USUAL},
    {"beta", "gear_pair.helix_angle_deg", EO_KEY_USUAL},
    {"hand", "gear_pair.hand", EO_KEY_SURE},
    {"b", "gear_pair.face_width_mm", EO_KEY_USUAL},
    {"x", "gear_pair.profile_shift", EO_KEY_SURE},
    {"a", "gear_pair.centre_distance_mm", EO_KEY_USUAL},
    {"a_w", "gear_pair.centre_distance_mm", EO_KEY_USUAL},
    {"d_a", "gear_pair.tip_diameter_mm", EO_KEY_USUAL},
    {"d_i", "gear_pair.bore_mm", EO_KEY_USUAL},
    {"h_aP*", "gear_pair.addendum_coefficient", EO_KEY_SURE},
    {"h_fP*", "gear_pair.dedendum_coefficient", EO_KEY_SURE},
    {"rho_fP*", "gear_pair.fillet_radius_coefficient", EO_KEY_SURE},
    {"j_bn", "gear_pair.backlash_um", EO_KEY_DOUBT},
    {"C_a", "modification.%.tip_relief_um", EO_KEY_DOUBT},
    {"Ca", "modification.%.tip_relief_um", EO_KEY_DOUBT},
    {"C_f", "modification.%.root_relief_um", EO_KEY_DOUBT},
    {"Cf", "modification.%.root_relief_um", EO_KEY_DOUBT},
    {"C_b", "modification.%.lead_crowning_um", EO_KEY_DOUBT},
    {"Cb", "modification.%.lead_crowning_um", EO_KEY_DOUBT},
    {"C_beta", "modification.%.lead_crowning_um", EO_KEY_DOUBT},
    {"C_alpha", "modification.%.profile_crowning_um", EO_KEY_DOUBT},
    {"C_Ha", "modification.%.profile_slope_um", EO_KEY_DOUBT},
    {"C_Halpha", "modification.%.profile_slope_um", EO_KEY_DOUBT},
    {"C_Hb", "modification.%.helix_slope_um", EO_KEY_DOUBT},
    {"C_Hbeta", "modification.%.helix_slope_um", EO_KEY_DOUBT},
    {"S_alpha", "modification.%.twist_um", EO_KEY_DOUBT},
    {"d_Ca", "modification.%.tip_relief_diameter_mm", EO_KEY_USUAL},
    {"d_Cf", "modification.%.root_relief_diameter_mm", EO_KEY_USUAL},
    {"T", "load_cases.1.torque_Nm", EO_KEY_USUAL},
    {"n", "load_cases.1.speed_rpm", EO_KEY_USUAL},
    {"E", "material.youngs_modulus_GPa", EO_KEY_USUAL},
    {"nu", "material.poissons_ratio", EO_KEY_SURE},
};

bool eo_design_key_is_derived(const char *name)
{
  static const char *const derived[] = {"d",        "d_f", "d_b",           "d_w",          "m_t",           "alpha_t",
                                        "alpha_wt", "u",   "epsilon_alpha", "epsilon_beta", "epsilon_gamma", "s_n",
                                        "W_k",      "M_dK"};
  for (size_t i = 0; i < sizeof derived / sizeof *derived; i++)
    if (strcmp(derived[i], name) == 0)
      return true;
  return false;
}

static const struct eo_field *field_in(const struct eo_table *table, const char *key, size_t length)
{
  for (int i = 0; table && i < table->count; i++)
    if (strncmp(table->field[i].key, key, length) == 0 && !table->field[i].key[length])
      return &table->field[i];
  return NULL;
}

/* "FLANK.grid_um.ROW.COLUMN", a number of a flank's grid (0: of all rows, of all columns): the flank's length in path
   and the two; false: the path is of another kind. */
static bool grid_number(const char *path, size_t *flank, int knot[2])
{
  static const char mark[] = "." EO_GRID_PARAMETER ".";
  const char *at = strstr(path, mark);
  int end = 0;
  if (!at || sscanf(at + strlen(mark), "%4d.%4d%n", &knot[0], &knot[1], &end) < 2 || at[strlen(mark) + (size_t)end] ||
      knot[0] < 0 || knot[1] < 0)
    return false;
  *flank = (size_t)(at - path);
  return true;
}

static const struct eo_field *field_at(const char *path);

/* Of a flank that there is: one with a list of numbers in place of its grid's. */
static const struct eo_field *grid_field(const char *path, size_t flank)
{
  char nodes[EO_KEY_PATH + 24];
  snprintf(nodes, sizeof nodes, "%.*s.grid_nodes.1.delta_um", (int)flank, path);
  return field_at(nodes) ? &eo_grid_number_field : NULL;
}

/* The field of a leaf, or NULL. A row of a list is its number from 1. */
static const struct eo_field *field_at(const char *path)
{
  size_t flank;
  int knot[2];
  if (grid_number(path, &flank, knot))
    return grid_field(path, flank);
  const struct eo_table *table = &eo_design_table;
  const struct eo_field *field = NULL;
  for (const char *at = path; *at;) {
    size_t length = strcspn(at, ".");
    if (field && field->kind == EO_FIELD_LIST) {
      char *end;
      long row = strtol(at, &end, 10);
      if (*at < '1' || *at > '9' || end != at + length || row > field->count) /* one spelling of each row */
        return NULL;
      table = field->table;
      field = NULL;
    } else {
      field = field_in(table, at, length);
      if (!field)
        return NULL;
      table = field->kind == EO_FIELD_OBJECT || field->kind == EO_FIELD_LIST ? field->table : NULL;
    }
    at += length + (at[length] == '.');
    if (!*at && at[-1] == '.')
      return NULL;
  }
  return field && field->kind != EO_FIELD_OBJECT ? field : NULL;
}

/* "A.B" for the member: A.MEMBER_B, or A.MEMBER.B behind the first part. */
static bool member_path(const char *name, int member, char path[EO_KEY_PATH])
{
  const char *last = strrchr(name, '.'), *first = strchr(name, '.');
  if (!last)
    return false;
  snprintf(path, EO_KEY_PATH, "%.*s.%s_%s", (int)(last - name), name, eo_member_name[member], last + 1);
  if (field_at(path))
    return true;
  snprintf(path, EO_KEY_PATH, "%.*s.%s.%s", (int)(first - name), name, eo_member_name[member], first + 1);
  return field_at(path) != NULL;
}

static bool find_path(struct eo_design_key *key, const char *name, int member)
{
  char *path = key->path[key->paths];
  const struct eo_field *field = field_at(name);
  if (field)
    snprintf(path, EO_KEY_PATH, "%s", name);
  else if (member_path(name, member, path)) {
    key->of_member = true;
    field = field_at(path);
  } else
    return false;
  key->field = key->field ? key->field : field;
  key->paths++;
  return true;
}

static bool find_symbol(struct eo_design_key *key, const char *pattern, int member, int ends)
{
  char name[EO_KEY_PATH];
  const char *mark = strchr(pattern, '%');
  if (!mark)
    return find_path(key, pattern, member);
  for (int end = 0; end < ends; end++) {
    snprintf(name, sizeof name, "%.*s%s%s", (int)(mark - pattern), pattern, eo_end_name[end], mark + 1);
    if (!find_path(key, name, member))
      return false;
  }
  return true;
}

bool eo_design_key_find(struct eo_design_key *key, const char *name, int member, int ends)
{
  memset(key, 0, sizeof *key);
  key->factor = 1;
  if (strlen(name) >= EO_KEY_PATH - 10)
    return false;
  for (size_t i = 0; i < sizeof symbols / sizeof *symbols; i++)
    if (strcmp(symbols[i].symbol, name) == 0) {
      key->doubt = symbols[i].doubt;
      if (find_symbol(key, symbols[i].key, member, ends))
        return true;
      /* what a design of this version says as half of it, at the face end */
      if (strcmp(symbols[i].key, "modification.%.helix_slope_um") != 0)
        return false;
      key->factor = 0.5;
      return find_symbol(key, "modification.%.lead_slope_um", member, ends);
    }
  return find_path(key, name, member);
}

void eo_design_key_name(const char *path, char name[EO_KEY_PATH], int *member)
{
  char other[EO_KEY_PATH];
  *member = -1;
  snprintf(name, EO_KEY_PATH, "%s", path);
  for (int i = 0; i < 2; i++) {
    char part[12], twin[12];
    snprintf(part, sizeof part, ".%s", eo_member_name[i]);
    snprintf(twin, sizeof twin, ".%s", eo_member_name[!i]);
    const char *at = strstr(path, part);
    size_t length = strlen(part);
    if (!at || (at[length] != '.' && at[length] != '_'))
      continue;
    snprintf(other, sizeof other, "%.*s%s%s", (int)(at - path), path, twin, at + length);
    if (!field_at(other))
      continue;
    snprintf(other, sizeof other, "%.*s.%s", (int)(at - path), path, at + length + 1);
    if (field_at(other)) /* the common key of both members */
      continue;
    snprintf(name, EO_KEY_PATH, "%s", other);
    *member = i;
    return;
  }
}

const char *eo_design_key_unit(const struct eo_field *field)
{
  return field->unit ? field->unit->suffix : "";
}

/* Units that a cell may state, by kind: the size of each in the first of its kind. */
static const struct {
  const char *name;
  int kind;
  double size;
} units[] = {
    {"mm", 1, 1},           {"um", 1, 1e-3},     {"µm", 1, 1e-3},       {"mum", 1, 1e-3},    {"m", 1, 1000},
    {"inch", 1, 25.4},      {"in", 1, 25.4},     {"deg", 2, 1},         {"°", 2, 1},         {"degree", 2, 1},
    {"rad", 2, 180 / M_PI}, {"Nm", 3, 1},        {"N m", 3, 1},         {"kNm", 3, 1000},    {"rpm", 4, 1},
    {"1/min", 4, 1},        {"1 / min", 4, 1},   {"min-1", 4, 1},       {"GPa", 5, 1},       {"MPa", 5, 1e-3},
    {"N/mm2", 5, 1e-3},     {"N/mm^2", 5, 1e-3}, {"N / mm^2", 5, 1e-3}, {"kg_per_m3", 6, 1}, {"kg/m3", 6, 1},
    {"kg/dm3", 6, 1000},    {"per_mm", 7, 1},    {"1/mm", 7, 1},
};

static int unit_index(const char *name)
{
  for (int i = 0; i < (int)(sizeof units / sizeof *units); i++)
    if (strcmp(units[i].name, name) == 0)
      return i;
  return -1;
}

bool eo_design_key_convert(const struct eo_field *field, const char *unit, double *value)
{
  const char *own = eo_design_key_unit(field);
  int from = unit_index(unit), to = unit_index(own);
  if (strcmp(unit, own) == 0 ||
      (!*own && (strcmp(unit, "-") == 0 || strcmp(unit, "1") == 0 || strcmp(unit, "none") == 0)))
    return true;
  if (from < 0 || to < 0 || units[from].kind != units[to].kind)
    return false;
  if (units[from].size >= units[to].size)
    *value *= units[from].size / units[to].size;
  else
    *value /= units[to].size / units[from].size; /* by a whole number where one is there: rounds once */
  return true;
}

/* What stands below an object's key or in a list's row, made where nothing does; NULL: no memory, or neither an object
   nor a list stands there. */
static json_t *step_into(json_t *at, const char *part, bool list_next)
{
  if (json_is_array(at)) {
    size_t row = strtoul(part, NULL, 10);
    while (row >= 1 && row <= 1000 && json_array_size(at) < row)
      if (json_array_append_new(at, json_object()) != 0)
        break;
    return json_array_get(at, row - 1);
  }
  if (!json_object_get(at, part))
    json_object_set_new(at, part, list_next ? json_array() : json_object());
  return json_object_get(at, part);
}

/* Along the parts of path[0 .. length), behind which another one follows. */
static json_t *walk(json_t *at, const char *path, size_t length)
{
  char part[EO_KEY_PATH];
  for (size_t from = 0; from < length && at;) {
    size_t size = strcspn(path + from, ".");
    snprintf(part, sizeof part, "%.*s", (int)size, path + from);
    from += size + 1;
    at = step_into(at, part, path[from] >= '1' && path[from] <= '9');
  }
  return at;
}

/* What stands in the list for the same number gives way; what comes later is laid on what was there. */
static bool set_grid_number(json_t *design, const char *path, size_t flank, const int knot[2], json_t *value)
{
  json_t *at = walk(design, path, flank), *nodes, *node;
  size_t i;
  if (json_is_object(at) && !json_object_get(at, "grid_nodes"))
    json_object_set_new(at, "grid_nodes", json_array());
  nodes = json_object_get(at, "grid_nodes");
  json_array_foreach(nodes, i, node)
  {
    if (json_integer_value(json_object_get(node, "row")) == knot[0] &&
        json_integer_value(json_object_get(node, "column")) == knot[1])
      json_array_remove(nodes, i--);
  }
  return json_array_append_new(nodes,
                               json_pack("{s:i, s:i, s:o}", "row", knot[0], "column", knot[1], "delta_um", value)) == 0;
}

/* Something on the way to the value is there already, and nothing can stand below it. */
static bool is_blocked(const json_t *at, const char *path)
{
  char part[EO_KEY_PATH];
  for (size_t size; path[size = strcspn(path, ".")]; path += size + 1) {
    snprintf(part, sizeof part, "%.*s", (int)size, path);
    const json_t *next = json_is_array(at) ? json_array_get(at, strtoul(part, NULL, 10) - 1)
                                           : json_object_get(at, part);
    if (!next)
      return false;
    if (!json_is_array(next) && !json_is_object(next))
      return true;
    at = next;
  }
  return !json_is_object(at);
}

enum eo_code eo_design_key_set(json_t *design, const char *path, json_t *value)
{
  size_t flank;
  int knot[2];
  bool set, of_grid = grid_number(path, &flank, knot);
  char list[EO_KEY_PATH + 16];
  snprintf(list, sizeof list, "%.*s.grid_nodes.1.row", of_grid ? (int)flank : 0, path);
  if (is_blocked(design, of_grid ? list : path)) {
    json_decref(value);
    return EO_ERROR_INPUT;
  }
  if (of_grid)
    set = set_grid_number(design, path, flank, knot, value);
  else {
    const char *last = strrchr(path, '.');
    json_t *at = walk(design, path, last ? (size_t)(last - path) : 0);
    set = json_object_set_new(at, last ? last + 1 : path, value) == 0;
  }
  return set ? EO_OK : EO_ERROR_MEMORY;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/sweep_steps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "design/pair_identity.h"
#include "format/json.h"
#include "variants/variant_axis.h"

static bool starts_with(const char *text, const char *start)
{
  return strncmp(text, start, strlen(start)) == 0;
}

static bool ends_with(const char *text, const char *end)
{
  size_t length = strlen(text), size = strlen(end);
  return length >= size && strcmp(text + length - size, end) == 0;
}

/* What the curves of a sweep hang on, on a pair that is prepared. */
static bool is_shown(const char *path)
{
  static const char *const group[] = {"modification.", "alignment.", "supports.", "shafts.", "load_cases."};
  bool shown = false;
  for (size_t i = 0; i < sizeof group / sizeof *group; i++)
    shown = shown || starts_with(path, group[i]);
  return shown;
}

static bool has_range(const char *path)
{
  return starts_with(path, "load_cases.") &&
         (ends_with(path, ".torque_Nm") || ends_with(path, ".speed_rpm") || ends_with(path, ".power_kW"));
}

static enum eo_code check_axis(const struct eo_variant_axis *axis, struct eo_error *error)
{
  enum eo_field_kind kind = axis->field->kind;
  if (kind != EO_FIELD_NUMBER && kind != EO_FIELD_INTEGER)
    return eo_error_set(error, EO_ERROR_INPUT, "/vary/key", "%.100s is no number.", axis->path[0]);
  for (int k = 0; k < axis->paths; k++) {
    const char *path = axis->path[k];
    if (axis->of_pair)
      return eo_error_set(error, EO_ERROR_INPUT, "/vary/key",
                          "Each value of %.100s is another gear pair: a study varies it.", path);
    if (has_range(path))
      return eo_error_set(error, EO_ERROR_INPUT, "/vary/key",
                          "%.100s: torques and speeds are ranges of their own, torque_Nm and speed_rpm.", path);
    if (!is_shown(path))
      return eo_error_set(error, EO_ERROR_INPUT, "/vary/key", "No curve of a sweep depends on %.100s.", path);
  }
  return EO_OK;
}

static enum eo_code find_axis(struct eo_variant_axis *axis, const char *key, const struct eo_design *design,
                              struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults)
    return eo_error_memory(error);
  eo_variant_axis_name(axis, key, design, "/vary/key", faults);
  enum eo_code code = faults->count ? eo_faults_first(faults, error) : EO_OK;
  free(faults);
  return code ? code : check_axis(axis, error);
}

static bool same_pair(const struct eo_design *one, const struct eo_design *other)
{
  const struct eo_pair_identity a = eo_pair_identity_of_design(one), b = eo_pair_identity_of_design(other);
  return eo_pair_identity_equal(&a, &b);
}

static enum eo_code make_step(const struct eo_variant_axis *axis, const json_t *base, const struct eo_design *design,
                              double value, struct eo_design *step, struct eo_error *error)
{
  struct eo_geometry geometry;
  struct eo_error found;
  char cell[40];
  snprintf(cell, sizeof cell, "%.17g", value);
  json_t *number = eo_variant_axis_read(axis, cell), *values = number ? json_pack("[o]", number) : NULL;
  if (!values)
    return eo_error_memory(error);
  enum eo_code code = eo_variant_design(base, axis, 1, values, step, &geometry, &found);
  json_decref(values);
  if (code)
    return eo_error_set(error, code, found.pointer, "With %.9g of %.100s: %.300s", value, axis->path[0], found.text);
  return same_pair(step, design)
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "",
                            "With %.9g of %.100s it is another gear pair: a study varies that.", value, axis->path[0]);
}

enum eo_code eo_sweep_steps_check(const struct eo_sweep_axes *axes, const struct eo_design *design,
                                  struct eo_error *error)
{
  struct eo_variant_axis axis = {0};
  if (axes->steps == 0)
    return EO_OK;
  enum eo_code code = find_axis(&axis, axes->key, design, error);
  eo_variant_axis_done(&axis);
  return code;
}

enum eo_code eo_sweep_steps_take(struct eo_sweep_axes *axes, const json_t *base, struct eo_error *error)
{
  if (axes->steps == 0)
    return EO_OK;
  axes->base = json_dumps(base, JSON_COMPACT);
  return axes->base ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_sweep_steps_init(struct eo_sweep_axes *axes, const struct eo_design *design, struct eo_error *error)
{
  struct eo_variant_axis axis = {0};
  if (axes->steps == 0)
    return EO_OK;
  json_t *base = eo_json_parse(axes->base, strlen(axes->base), error);
  axes->step = malloc((size_t)axes->steps * sizeof *axes->step);
  enum eo_code code = base ? EO_OK : error->code;
  if (!code)
    code = axes->step ? find_axis(&axis, axes->key, design, error) : eo_error_memory(error);
  for (int k = 0; k < axes->steps && !code; k++)
    code = make_step(&axis, base, design, axes->value[k], &axes->step[k], error);
  eo_variant_axis_done(&axis);
  json_decref(base);
  return code;
}

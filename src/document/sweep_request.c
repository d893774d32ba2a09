/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a sweep is asked for. */
#include "document/sweep_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS                                                                                                  \
  EO_INTEGER_DERIVED(struct eo_sweep_range, points, "points", 1, EO_SWEEP_MOST_STEPS, "both ends of the range", \
                     "how many, equally spaced, ends included")

static const struct eo_field torque[] = {
    EO_NUMBER_DERIVED(struct eo_sweep_range, from, "from", NULL, 1e-3, 1e8, "of the load case with the largest share",
                      "first torque, N m, on the pinion"),
    EO_NUMBER_DERIVED(struct eo_sweep_range, to, "to", NULL, 1e-3, 1e8, "from", "last torque, N m"),
    POINTS,
};
const struct eo_table eo_sweep_torque_table = EO_TABLE("a range of torques", struct eo_sweep_range, torque);

static const struct eo_field speed[] = {
    EO_NUMBER_DERIVED(struct eo_sweep_range, from, "from", NULL, 0.1, 1e6, "of the load case with the largest share",
                      "first speed of the pinion, rpm"),
    EO_NUMBER_DERIVED(struct eo_sweep_range, to, "to", NULL, 0.1, 1e6, "from", "last speed, rpm"),
    POINTS,
};
const struct eo_table eo_sweep_speed_table = EO_TABLE("a range of speeds", struct eo_sweep_range, speed);

static const struct eo_field vary_fields[] = {
    EO_TEXT_DERIVED(struct eo_sweep_vary, key, "key", 1, "none",
                    "of a design, as a study names it: modification.pinion.*.tip_relief_um, "
                    "modification.pinion.left.grid_um.3.4, alignment.coupling_thrust_N, ..."),
    EO_NUMBER_DERIVED(struct eo_sweep_vary, range.from, "from", NULL, -1e9, 1e9, "none",
                      "first value, in the key's unit"),
    EO_NUMBER_DERIVED(struct eo_sweep_vary, range.to, "to", NULL, -1e9, 1e9, "from", "last value"),
    EO_INTEGER_DERIVED(struct eo_sweep_vary, range.points, "points", 1, EO_SWEEP_MOST_VALUES, "both ends of the range",
                       "how many, equally spaced, ends included"),
};
const struct eo_table eo_sweep_vary_table = EO_TABLE("a number that varies", struct eo_sweep_vary, vary_fields);

static const struct eo_field request[] = {
    EO_OBJECT(struct eo_sweep_request, torque, "torque_Nm", &eo_sweep_torque_table,
              "torques; without them that of the load case with the largest share"),
    EO_OBJECT(struct eo_sweep_request, speed, "speed_rpm", &eo_sweep_speed_table,
              "speeds; without them that of the load case with the largest share"),
    EO_OBJECT(struct eo_sweep_request, vary, "vary", &eo_sweep_vary_table,
              "a number of the design in place of the torque; any that leaves the gear pair as it is"),
};
const struct eo_table eo_sweep_request_table = EO_TABLE("a sweep", struct eo_sweep_request, request);

static enum eo_code check_range(const struct eo_sweep_range *range, const char *pointer, struct eo_error *error)
{
  double to = isnan(range->to) ? range->from : range->to;
  if (to < range->from)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "The range ends at %.9g, below its start %.9g.", to,
                        range->from);
  if (to > range->from && range->points == 1)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "One point cannot reach from %.9g to %.9g.", range->from, to);
  if (to == range->from && range->points > 1)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "%d points need a range, not the one value %.9g.",
                        range->points, to);
  return EO_OK;
}

static enum eo_code make_axis(const struct eo_sweep_range *range, const struct eo_unit *unit, const char *pointer,
                              int *count, double **value, struct eo_error *error)
{
  *count = 0;
  if (isnan(range->from) && (!isnan(range->to) || range->points))
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "The range has no start: \"from\" is missing.");
  if (isnan(range->from))
    return EO_OK;
  EO_TRY(check_range(range, pointer, error));
  double to = isnan(range->to) ? range->from : range->to;
  int points = range->points ? range->points : to > range->from ? 2 : 1;
  *value = malloc((size_t)points * sizeof **value);
  if (!*value)
    return eo_error_memory(error);
  for (int i = 0; i < points; i++)
    (*value)[i] = eo_unit_in(unit, i == points - 1 ? to : range->from + (to - range->from) * i / (points - 1));
  *count = points;
  return EO_OK;
}

static enum eo_code make_steps(struct eo_sweep_axes *axes, const struct eo_sweep_vary *vary, struct eo_error *error)
{
  EO_TRY(make_axis(&vary->range, NULL, "/vary", &axes->steps, &axes->value, error));
  if (axes->steps && !*vary->key)
    return eo_error_set(error, EO_ERROR_INPUT, "/vary/key", "A range of which number? The key is missing.");
  if (!axes->steps && *vary->key)
    return eo_error_set(error, EO_ERROR_INPUT, "/vary/from", "The range of %.100s is missing.", vary->key);
  if (axes->steps && axes->torques)
    return eo_error_set(error, EO_ERROR_INPUT, "/torque_Nm",
                        "A sweep varies the torque or another number, not both at once: a study does.");
  memcpy(axes->key, vary->key, sizeof axes->key);
  return EO_OK;
}

static enum eo_code make_axes(struct eo_sweep_axes *axes, const struct eo_sweep_request *asked, struct eo_error *error)
{
  EO_TRY(make_axis(&asked->torque, &eo_unit_Nm, "/torque_Nm", &axes->torques, &axes->torque, error));
  EO_TRY(make_axis(&asked->speed, &eo_unit_rpm, "/speed_rpm", &axes->speeds, &axes->speed, error));
  EO_TRY(make_steps(axes, &asked->vary, error));
  int first = axes->torques > 0 ? axes->torques : axes->steps;
  if (!first && !axes->speeds)
    return eo_error_set(
        error, EO_ERROR_INPUT, "",
        "A sweep needs a range of torques, of another number, of speeds, or of speeds and one of them.");
  if (first > 0 && axes->speeds > EO_SWEEP_MOST_POINTS / first)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "%d %s at %d speeds are more than the %d points that a sweep may have.", first,
                        axes->torques > 0 ? "torques" : "values", axes->speeds, EO_SWEEP_MOST_POINTS);
  return EO_OK;
}

enum eo_code eo_sweep_axes_init(struct eo_sweep_axes *axes, const struct eo_sweep_request *asked,
                                struct eo_error *error)
{
  *axes = (struct eo_sweep_axes){0};
  enum eo_code code = make_axes(axes, asked, error);
  if (code)
    eo_sweep_axes_done(axes);
  return code;
}

void eo_sweep_axes_done(struct eo_sweep_axes *axes)
{
  free(axes->torque);
  free(axes->speed);
  free(axes->value);
  free(axes->base);
  free(axes->step);
  *axes = (struct eo_sweep_axes){0};
}

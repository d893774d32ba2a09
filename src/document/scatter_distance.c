/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/scatter_distance.h"

#include <math.h>
#include <stdio.h>

#include "document/scatter_distribution.h"
#include "gear/geometry.h"

/* Where a normal distribution without a cut counts as ended, in sigma: one pair in 16 000 lies beyond. */
static const double FAR = 4;

struct eo_scatter_row eo_scatter_distance_row(const struct eo_design *design)
{
  int sigmas = design->tolerance.preset == EO_SCATTER_GROUND ? 3 : 2;
  return (struct eo_scatter_row){.key = "alignment.centre_distance_deviation_um",
                                 .kind = EO_SCATTER_NORMAL,
                                 .sigma = 1e6 * design->gear_pair.centre_distance_allowance / sigmas,
                                 .cut = sigmas};
}

/* Least and largest deviation that is drawn. */
static void find_ends(const struct eo_scatter_input *input, double end[2])
{
  const struct eo_distribution *deviation = &input->deviation;
  double far = fmin(deviation->cut, FAR) * deviation->sigma;
  end[0] = deviation->mean - (deviation->kind == EO_DISTRIBUTION_HALF_NORMAL ? 0 : far);
  end[1] = deviation->mean + far;
  if (deviation->kind == EO_DISTRIBUTION_UNIFORM) {
    end[0] = deviation->low;
    end[1] = deviation->high;
  }
  if (deviation->kind != EO_DISTRIBUTION_LIST)
    return;
  end[0] = end[1] = input->value[0];
  for (int i = 1; i < input->values; i++) {
    end[0] = fmin(end[0], input->value[i]);
    end[1] = fmax(end[1], input->value[i]);
  }
}

/* The two gears can be assembled at both ends. */
static enum eo_code check_ends(const struct eo_scatter_input *input, const struct eo_design *design,
                               const double end[2], const struct eo_scatter_row *row, const char *pointer,
                               struct eo_error *error)
{
  struct eo_geometry drawn;
  EO_TRY(eo_geometry_init(&drawn, &design->gear_pair, error));
  for (int i = 0; i < 2; i++) {
    struct eo_geometry apart = drawn;
    struct eo_error found;
    if (eo_geometry_set_apart(&apart, &design->gear_pair, (input->nominal + end[i]) * input->unit, &found))
      return eo_scatter_refuse_row(row, pointer, "key", found.text, error);
  }
  return EO_OK;
}

enum eo_code eo_scatter_settle_distance(struct eo_scatter_input *input, const struct eo_design *design,
                                        const struct eo_scatter_row *row, const char *pointer, struct eo_error *error)
{
  double end[2];
  if (input->fixed_sum > 0)
    return eo_scatter_refuse_row(row, pointer, "distribution",
                                 "a distance that is drawn in steps keeps no sum: choose \"normal\".", error);
  find_ends(input, end);
  bool few = input->deviation.kind == EO_DISTRIBUTION_LIST && input->values <= EO_SCATTER_DISTANCE_STEPS;
  /* theory (A15) */
  input->step = few ? 0 : (end[1] - end[0]) / EO_SCATTER_DISTANCE_STEPS;
  return check_ends(input, design, end, row, pointer, error);
}

double eo_scatter_distance_step(const struct eo_scatter *scatter)
{
  double step = 0;
  for (int i = 0; i < scatter->inputs; i++)
    step = fmax(step, scatter->input[i].step);
  return step;
}

/* A grid is mostly the compliance between all points of a position in single precision, on some six lines at once. */
double eo_scatter_distance_memory(const struct eo_scatter *scatter, const struct eo_design *design)
{
  static const double LINES = 6;
  const struct eo_resolution *resolution = &design->resolution;
  double points = LINES * resolution->cells_per_line, grids = 0;
  for (int i = 0; i < scatter->inputs; i++)
    if (scatter->input[i].target == EO_TARGET_MEMBER && scatter->input[i].offset == EO_SCATTER_DISTANCE)
      grids = fmin(design->tolerance.pairs, EO_SCATTER_DISTANCE_STEPS + 3);
  return grids * (eo_gear_pair_is_uneven(&design->gear_pair) ? 2 : 1) * sizeof(float) * resolution->positions * points *
         points;
}

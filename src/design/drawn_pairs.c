/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/drawn_pairs.h"

#include <math.h>
#include <string.h>

#include "design/design.h"
#include "tolerance/scatter.h"

static double *place(struct eo_design *design, size_t offset)
{
  return (double *)(void *)((char *)design + offset);
}

void eo_drawn_pair_apply(const struct eo_design *design, int pair, struct eo_design *made, struct eo_scenario *scenario)
{
  const struct eo_drawn_pairs *drawn = &design->drawn;
  memcpy(made, design, sizeof *made);
  *scenario = (struct eo_scenario){NAN, NAN, 1, 1};
  for (int i = 0; i < drawn->inputs; i++) {
    const struct eo_drawn_input *input = &drawn->input[i];
    double deviation = drawn->deviation[pair][i];
    if (input->target == EO_TARGET_COMPLIANCE)
      scenario->compliance += deviation;
    else if (input->target == EO_TARGET_SPEED)
      scenario->speed += deviation;
    else {
      double *value = place(made, input->offset);
      if (input->low != 0 || *value > 0)
        *value = fmin(fmax(*value + deviation, input->low), input->high);
    }
  }
}

int eo_design_states(const struct eo_design *design)
{
  const struct eo_drawn_pairs *drawn = &design->drawn;
  if (design->objective.robust == EO_ROBUST_OFF)
    return 1;
  if (drawn->pairs > 0)
    return drawn->first > 0 ? drawn->first : drawn->pairs;
  return design->objective.scenarios > 0 ? design->objective.scenarios : 1;
}

int eo_design_scenarios(const struct eo_design *design)
{
  int states = eo_design_states(design);
  bool nominal = design->optimization.front == EO_FRONT_NOMINAL_AND_ROBUST &&
                 design->optimization.search.algorithm == EO_NSGA2 && states > 1;
  return states + nominal;
}

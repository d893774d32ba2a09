/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed and torque through the train: each mesh turns both by its ratio and reverses their sign, couplings pass both;
   where a shaft drives more than one pair, nothing in the model says how they share, so the torque is not known beyond.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "exchange/rexs_train.h"

const struct eo_rexs_attribute *eo_rexs_vary(const struct eo_rexs_model *model, int load_case,
                                             const struct eo_rexs_component *component, const char *attribute)
{
  if (load_case >= 0 && component)
    for (int i = 0; i < model->load_case[load_case].count; i++) {
      const struct eo_rexs_component *varying = &model->load_case[load_case].component[i];
      const struct eo_rexs_attribute *found = varying->id == component->id ? eo_rexs_attribute(varying, attribute)
                                                                           : NULL;
      if (found)
        return found;
    }
  return eo_rexs_attribute(component, attribute);
}

static double vary(const struct eo_rexs_train *train, int load_case, const struct eo_rexs_component *component,
                   const char *attribute)
{
  const struct eo_rexs_attribute *rexs_attribute = eo_rexs_vary(train->model, load_case, component, attribute);
  return rexs_attribute && rexs_attribute->shape == EO_REXS_SCALAR ? eo_rexs_number(rexs_attribute->text) : NAN;
}

/* +1, -1: the direction of a shaft's u axis against that of another. */
static double direction(const struct eo_rexs_train *train, int a, int b)
{
  double axis[2][3], origin[3];
  eo_rexs_axis(train->shaft[a], axis[0], origin);
  eo_rexs_axis(train->shaft[b], axis[1], origin);
  return axis[0][0] * axis[1][0] + axis[0][1] * axis[1][1] + axis[0][2] * axis[1][2] < 0 ? -1 : 1;
}

/* The shafts of a pair, and by how much a speed changes from the first to the second; torque by the inverse. */
static bool ratio_of(const struct eo_rexs_train *train, const struct eo_rexs_pair *pair, int shaft[2], double *ratio)
{
  const struct eo_rexs_mesh *mesh = &train->mesh[pair->mesh[0]];
  shaft[0] = mesh->wheel[0].shaft;
  shaft[1] = mesh->wheel[1].shaft;
  if (shaft[0] < 0 || shaft[1] < 0 || !(mesh->wheel[0].teeth > 0) || !(mesh->wheel[1].teeth > 0))
    return false;
  *ratio = -mesh->wheel[0].teeth / mesh->wheel[1].teeth * direction(train, shaft[0], shaft[1]);
  return true;
}

/* Number `n` of the shafts coupled to one; -1 after the last. */
static int coupled(const struct eo_rexs_train *train, int shaft, int n)
{
  for (int i = 0; i < train->couplings; i++) {
    const int *both = train->coupling[i];
    if ((both[0] == shaft || both[1] == shaft) && n-- == 0)
      return both[0] == shaft ? both[1] : both[0];
  }
  return -1;
}

static void spread_speed(const struct eo_rexs_train *train, struct eo_rexs_flow *flow)
{
  for (bool more = true; more;) {
    more = false;
    for (int i = 0; i < train->pairs; i++) {
      int shaft[2];
      double ratio;
      if (!ratio_of(train, &train->pair[i], shaft, &ratio) ||
          isnan(flow->speed[shaft[0]]) == isnan(flow->speed[shaft[1]]))
        continue;
      more = true;
      if (isnan(flow->speed[shaft[1]]))
        flow->speed[shaft[1]] = flow->speed[shaft[0]] * ratio;
      else
        flow->speed[shaft[0]] = flow->speed[shaft[1]] / ratio;
    }
    for (int i = 0; i < train->shafts; i++)
      for (int n = 0, to; !isnan(flow->speed[i]) && (to = coupled(train, i, n)) >= 0; n++)
        if (isnan(flow->speed[to])) {
          flow->speed[to] = flow->speed[i] * direction(train, i, to);
          more = true;
        }
  }
}

static void find_speeds(const struct eo_rexs_train *train, int load_case, struct eo_rexs_flow *flow)
{
  for (int i = 0; i < train->shafts; i++)
    flow->speed[i] = vary(train, load_case, train->shaft[i], "rotational_speed");
  for (int i = 0; i < train->meshes; i++)
    for (int k = 0; k < 2; k++) {
      const struct eo_rexs_wheel *wheel = &train->mesh[i].wheel[k];
      if (wheel->shaft >= 0 && isnan(flow->speed[wheel->shaft]))
        flow->speed[wheel->shaft] = vary(train, load_case, wheel->gear, "rotational_speed");
    }
  spread_speed(train, flow);
}

/* Torque that a load puts in, N m, with its sign; NaN: none. */
static double load_torque(const struct eo_rexs_train *train, int load_case, const struct eo_rexs_component *load,
                          double speed)
{
  double torque = vary(train, load_case, load, "torque_around_u_axis"), power = vary(train, load_case, load, "power");
  if (isnan(torque) || torque == 0)
    torque = power != 0 && speed != 0 ? 30 / M_PI * 1000 * power / speed : NAN;
  return torque;
}

static bool some_load_defines(const struct eo_rexs_train *train)
{
  for (int i = 0; i < train->loads; i++)
    if (eo_rexs_flag(train->load[i].component, "defines_torque"))
      return true;
  return false;
}

/* The shaft that torque enters; -1: none, or more than one. */
static int find_source(const struct eo_rexs_train *train, int load_case, struct eo_rexs_flow *flow)
{
  bool defined = some_load_defines(train);
  int source = -1;
  for (int i = 0; i < train->loads; i++) {
    int shaft = train->load[i].shaft;
    if (defined && !eo_rexs_flag(train->load[i].component, "defines_torque"))
      continue;
    double torque = load_torque(train, load_case, train->load[i].component, flow->speed[shaft]);
    if (isnan(torque) || torque * flow->speed[shaft] < 0) /* against the rotation: where it leaves */
      continue;
    if (source >= 0 && source != shaft) {
      snprintf(flow->why, sizeof flow->why, "torque enters at more than one shaft (%d and %d)",
               train->shaft[source]->id, train->shaft[shaft]->id);
      return -1;
    }
    flow->torque[shaft] = (source == shaft ? flow->torque[shaft] : 0) + torque;
    source = shaft;
  }
  if (source < 0)
    snprintf(flow->why, sizeof flow->why, "no external load states a torque, or a power with a speed");
  return source;
}

static void pass(struct eo_rexs_flow *flow, int to, double torque, int *order)
{
  flow->torque[to] = torque;
  flow->reached[to] = ++*order;
}

/* From one shaft to all it drives. */
static bool pass_on(const struct eo_rexs_train *train, struct eo_rexs_flow *flow, int from, int *order)
{
  bool passed = false;
  int driven = -1;
  double torque = NAN;
  for (int n = 0, to; (to = coupled(train, from, n)) >= 0; n++)
    if (!flow->reached[to]) {
      pass(flow, to, flow->torque[from] * direction(train, from, to), order);
      passed = true;
    }
  for (int i = 0; i < train->pairs; i++) {
    int shaft[2];
    double ratio;
    if (!ratio_of(train, &train->pair[i], shaft, &ratio) || (shaft[0] != from && shaft[1] != from))
      continue;
    int to = shaft[0] == from ? shaft[1] : shaft[0];
    if (flow->reached[to])
      continue;
    bool branch = driven >= 0;
    driven = to;
    torque = branch ? NAN : flow->torque[from] / (shaft[0] == from ? ratio : 1 / ratio);
    if (branch)
      snprintf(flow->why, sizeof flow->why,
               "shaft %d drives more than one pair, and the file does not say how they "
               "share its torque",
               train->shaft[from]->id);
  }
  if (driven >= 0 && !isnan(torque)) {
    pass(flow, driven, torque, order);
    passed = true;
  }
  return passed;
}

void eo_rexs_flow_find(const struct eo_rexs_train *train, int load_case, struct eo_rexs_flow *flow)
{
  int order = 0;
  memset(flow, 0, sizeof *flow);
  for (int i = 0; i < train->shafts; i++)
    flow->torque[i] = NAN;
  find_speeds(train, load_case, flow);
  int source = find_source(train, load_case, flow);
  if (source < 0)
    return;
  flow->reached[source] = ++order;
  for (bool more = true; more;) {
    more = false;
    for (int i = 0; i < train->shafts; i++)
      more = (flow->reached[i] && pass_on(train, flow, i, &order)) || more;
  }
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The duty cycle of a pair: what arrives at its driver in each load case. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/rexs_import.h"

struct state {
  double torque, speed; /* of the driver, about x, N m, 1/min; NaN: not stated */
  double share, hours;  /* NaN: not stated */
  char why[160];
};

static struct state state_of(const struct eo_rexs_import *import, struct eo_rexs_flow *flow, int load_case)
{
  const struct eo_rexs_wheel *driver = &import->wheel[EO_PINION][EO_LEFT], *driven = &import->wheel[EO_GEAR][EO_LEFT];
  struct state state = {NAN, NAN, NAN, NAN, ""};
  double axis[3], x[3], origin[3];
  if (driver->shaft < 0)
    return state;
  eo_rexs_flow_find(import->train, load_case, flow);
  int first = import->train->mesh[import->pair->mesh[0]].wheel[0].shaft;
  eo_rexs_axis(first < 0 ? NULL : import->train->shaft[first], x, origin);
  eo_rexs_axis(import->train->shaft[driver->shaft], axis, origin);
  double forward = axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2] < 0 ? -1 : 1;
  state.torque = forward * flow->torque[driver->shaft];
  state.speed = forward * flow->speed[driver->shaft];
  if (isnan(state.torque) && driven->shaft >= 0) /* the file's driver is driven by its own torque path */
    state.torque = import->rotation * fabs(flow->torque[driven->shaft]) * driver->teeth / driven->teeth;
  snprintf(state.why, sizeof state.why, "%s", flow->why);
  for (int i = 0; i < import->model->components; i++) {
    const struct eo_rexs_component *unit = &import->model->component[i];
    if (!eo_rexs_is(unit, "gear_unit"))
      continue;
    const struct eo_rexs_attribute *share = eo_rexs_vary(import->model, load_case, unit, "operating_time_fraction"),
                                   *hours = eo_rexs_vary(import->model, load_case, unit, "operating_time");
    state.share = share ? eo_rexs_number(share->text) / 100 : NAN;
    state.hours = hours ? eo_rexs_number(hours->text) : NAN;
    break;
  }
  return state;
}

/* A duty cycle in hours says its shares as well. */
static void settle_shares(struct state *state, int count)
{
  double sum = 0;
  bool all = true;
  for (int i = 0; i < count; i++) {
    all = all && !isnan(state[i].hours);
    sum += state[i].hours;
  }
  for (int i = 0; i < count && all && sum > 0; i++)
    if (isnan(state[i].share))
      state[i].share = state[i].hours / sum;
}

static void put_load_case(struct eo_rexs_import *import, json_t *list, const struct state *state, bool with_share,
                          bool astern)
{
  json_t *row = json_object();
  eo_rexs_put(import, &eo_load_case_table, row, "torque_Nm", fabs(state->torque));
  if (isnan(state->speed) || state->speed == 0)
    eo_import_say(import->out, import->out->notes, "The file states no speed of the load cases: add speed_rpm.");
  else
    eo_rexs_put(import, &eo_load_case_table, row, "speed_rpm", fabs(state->speed));
  if (with_share)
    eo_rexs_put(import, &eo_load_case_table, row, "share", state->share);
  if (astern)
    eo_rexs_put_word(import, &eo_load_case_table, row, "direction", "astern");
  import->out->failed = json_array_append_new(list, row) != 0 || import->out->failed;
}

void eo_rexs_read_loads(struct eo_rexs_import *import, json_t *design)
{
  struct eo_import *out = import->out;
  int count = import->model->load_cases ? import->model->load_cases : 1, kept = 0, with_share = 0;
  struct state *state = calloc((size_t)count, sizeof *state);
  struct eo_rexs_flow *flow = malloc(sizeof *flow);
  json_t *list = json_array();
  bool astern_known = eo_import_has_key(&eo_load_case_table, "direction");
  out->failed = out->failed || !state || !flow || !list;
  for (int i = 0; i < count && !out->failed; i++)
    state[i] = state_of(import, flow, import->model->load_cases ? i : -1);
  for (int i = 0; i < count && !out->failed; i++) {
    int number = import->model->load_cases ? import->model->load_case[i].id : 0;
    bool astern = state[i].torque * import->rotation < 0;
    if (isnan(state[i].torque))
      eo_import_say(out, out->notes, "Load case %d has no torque at the pair: %s.", number,
                    *state[i].why ? state[i].why : "it reaches neither shaft of it");
    else if (state[i].torque == 0 || (astern && !astern_known) || kept == EO_MAX_LOAD_CASES)
      eo_import_say(out, out->notes, "Load case %d is left out: %s.", number,
                    state[i].torque == 0 ? "its torque is 0"
                    : astern             ? "it loads the other flank than the pair's"
                                         : "a design has at most 64 load cases");
    else
      state[kept++] = state[i];
  }
  if (!out->failed)
    settle_shares(state, kept);
  for (int i = 0; i < kept; i++)
    with_share += !isnan(state[i].share);
  if (with_share && with_share < kept)
    eo_import_say(out, out->assumed, "equal shares of the load cases: not all of them state theirs");
  for (int i = 0; i < kept && !out->failed; i++)
    put_load_case(import, list, &state[i], with_share == kept, state[i].torque * import->rotation < 0);
  if (kept)
    json_object_set(design, "load_cases", list);
  else
    eo_import_say(out, out->notes, "The file states no load for the pair: add load_cases.");
  json_decref(list);
  free(state);
  free(flow);
}

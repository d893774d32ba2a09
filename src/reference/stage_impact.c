/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include "reference/stage.h"
#include "reference/stage_mesh.h"
#include "contact/impact.h"

struct input {
  struct eo_stage_mesh_input mesh;
  struct eo_numbers approach;
  double speed, inertia[2];
  int stations;
};

static const struct eo_field input[] = {
    EO_STAGE_MESH(struct input),
    EO_SERIES(struct input, approach, "approach_um", &eo_unit_um, 1024, -1e4, 1e4, 0,
              "instead of loads: Z of every end, normal, one value or one per phase"),
    EO_NUMBER(struct input, speed, "speed_rpm", &eo_unit_rpm, 0.1, 1e6, 2000, "of the pinion"),
    EO_NUMBER_DERIVED(struct input, inertia[EO_PINION], "pinion_inertia_kg_m2", &eo_unit_kg_m2, 1e-12, 1e8,
                      "solid disc of the pitch cylinder", "of one end"),
    EO_NUMBER_DERIVED(struct input, inertia[EO_GEAR], "gear_inertia_kg_m2", &eo_unit_kg_m2, 1e-12, 1e8,
                      "solid disc of the pitch cylinder", "of one end"),
    EO_INTEGER(struct input, stations, "stations", 0, 10000, 0,
               "the touch is looked for at so many places over the face; 0 or 1: anywhere"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

struct end_output {
  struct eo_impact impact;
  double lead;
};

static const struct eo_field end_output[] = {
    EO_FLAG(struct end_output, impact.touched, "touched", 0, "false: the incoming pair never touches"),
    EO_FLAG(struct end_output, impact.off_line, "off_line", 0,
            "first touch before the path of contact, with the tip corner"),
    EO_OUT(struct end_output, impact.phase, "phase_mm", &eo_unit_mm, "c of the incoming pair at first touch"),
    EO_OUT(struct end_output, impact.eta, "eta_mm", &eo_unit_mm, "of the touch"),
    EO_OUT(struct end_output, impact.path, "s_mm", &eo_unit_mm, "of the touch"),
    EO_OUT(struct end_output, lead, "lead_mm", &eo_unit_mm, "of the touch before the start of the path of contact"),
    EO_OUT(struct end_output, impact.pinion_radius, "pinion_radius_mm", &eo_unit_mm, "of the touch"),
    EO_OUT(struct end_output, impact.speed, "speed_mm_per_s", &eo_unit_mm_per_s, "closing, normal"),
    EO_OUT(struct end_output, impact.compliance, "compliance_um_per_N", &eo_unit_um_per_N,
           "q_s of the patch, bulk and Hertz"),
    EO_OUT(struct end_output, impact.force, "general_force_N", &eo_unit_N, "F_s = v sqrt(m_e / q_s)"),
    EO_OUT(struct end_output, impact.classical, "force_N", &eo_unit_N, "the same when off_line, else 0"),
    EO_OUT(struct end_output, impact.duration, "duration_ms", &eo_unit_ms, "of the half sine"),
    EO_OUT(struct end_output, impact.start, "start", NULL, "of the pulse, phase of the mesh cycle"),
};
static const struct eo_table end_table = EO_TABLE("an end", struct end_output, end_output);

struct load_output {
  double force, torque;
  struct end_output left, right;
  int two;
};

static const struct eo_field load_output[] = {
    EO_OUT(struct load_output, force, "force_N", &eo_unit_N, "normal, per end; null when approach_um was given"),
    EO_OUT(struct load_output, torque, "torque_Nm", &eo_unit_Nm, "on the pinion shaft; likewise"),
    EO_OBJECT(struct load_output, left, "left", &end_table, "left end"),
    EO_OPTIONAL(struct load_output, right, two, "right", &end_table, "the pair has one end", "right end"),
};
static const struct eo_table load_table = EO_TABLE("a load", struct load_output, load_output);

struct output {
  double mass;
  int loads;
  struct load_output load[EO_STAGE_LOADS];
};

static const struct eo_field output[] = {
    EO_OUT(struct output, mass, "effective_mass_kg", &eo_unit_kg, "m_e along the flank normal"),
    EO_LIST(struct output, load, loads, "loads", &load_table, 0, EO_STAGE_LOADS, "one row per load"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

/* Z is either computed, or given once for all phases or for each. */
static enum eo_code set_approach(struct eo_stage_mesh *mesh, const struct eo_numbers *approach, struct eo_error *error)
{
  int positions = mesh->pair->grid->positions;
  if (approach->count != 1 && approach->count != positions)
    return eo_error_set(error, EO_ERROR_INPUT, "/approach_um",
                        "%d entries: one is needed, or one for each of %d phases.", approach->count, positions);
  for (int end = 0; end < mesh->design.gear_pair.ends; end++)
    for (int j = 0; j < positions; j++)
      mesh->end[end].approach[j] = approach->value[approach->count == 1 ? 0 : j];
  return EO_OK;
}

static struct end_output find_end(const struct eo_stage_mesh *mesh, int end, double speed)
{
  const struct eo_pair *pair = mesh->pair;
  struct end_output found = {.lead = NAN};
  eo_impact_find(&found.impact, pair->grid, &mesh->field[end], pair->kernel, &pair->impact, mesh->end[end].approach,
                 speed, mesh->factor);
  if (found.impact.touched)
    found.lead = pair->geometry.path_start - found.impact.path;
  return found;
}

static void find_load(struct load_output *out, const struct eo_stage_mesh *mesh, double speed)
{
  out->two = mesh->design.gear_pair.ends == 2;
  out->left = find_end(mesh, EO_LEFT, speed);
  if (out->two)
    out->right = find_end(mesh, EO_RIGHT, speed);
}

static enum eo_code open_mesh(struct eo_stage_mesh *mesh, const struct input *given, struct output *found,
                              struct eo_error *error)
{
  if (given->mesh.phase.count)
    return eo_error_set(error, EO_ERROR_INPUT, "/phase_mm",
                        "The impact needs equal steps over the whole cycle: leave this key out.");
  enum eo_code code = eo_stage_mesh_init(mesh, &given->mesh, error);
  if (code)
    return code;
  mesh->pair->impact.stations = given->stations;
  for (int i = 0; i < 2; i++)
    if (!isnan(given->inertia[i]))
      mesh->pair->impact.inertia[i] = given->inertia[i];
  found->mass = eo_impact_mass(&mesh->pair->geometry, mesh->pair->impact.inertia);
  return EO_OK;
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_stage_mesh mesh = {0};
  bool stated = given->approach.count > 0;
  if (stated && (given->mesh.torque.count || given->mesh.force.count))
    return eo_error_set(error, EO_ERROR_INPUT, "/approach_um", "The approach follows from the loads: give either.");
  int loads = stated ? 1 : eo_stage_mesh_loads(&given->mesh, error);
  enum eo_code code = loads ? open_mesh(&mesh, given, found, error) : EO_ERROR_INPUT;
  if (!code && stated)
    code = set_approach(&mesh, &given->approach, error);
  for (int k = 0; k < loads && !code; k++) {
    struct load_output *load = &found->load[k];
    load->force = load->torque = NAN;
    if (!stated) {
      load->force = eo_stage_mesh_force(&mesh, &given->mesh, k, &load->torque);
      eo_stage_mesh_solve(&mesh, load->force);
    }
    find_load(load, &mesh, given->speed);
    found->loads = k + 1;
  }
  eo_stage_mesh_done(&mesh);
  return code;
}

const struct eo_stage eo_stage_impact = {
    "impact", "entering impact of the incoming pair of teeth", &input_table, &output_table, true, run};

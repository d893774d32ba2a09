/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage_mesh.h"
#include "design/resolution.h"

#include <math.h>

static const struct eo_field closed_form[] = {
    EO_NUMBER_REQUIRED(struct eo_closed_form, compliance, "compliance_um_per_N", &eo_unit_um_per_N, 1e-12, 1e6, "c"),
    EO_NUMBER_REQUIRED(struct eo_closed_form, length, "length_mm", &eo_unit_mm, 1e-3, 1e6,
                       "l: over which a deflection fades along the face"),
    EO_NUMBER(struct eo_closed_form, centre, "centre_mm", &eo_unit_mm, -1e3, 1e3, 0, "s_0"),
    EO_NUMBER(struct eo_closed_form, linear, "linear_per_mm", &eo_unit_per_mm, 0, 1e3, 0, "f_1"),
    EO_NUMBER(struct eo_closed_form, quadratic, "quadratic_per_mm2", &eo_unit_per_mm2, 0, 1e3, 0, "f_2"),
};
static const struct eo_table closed_form_table = EO_TABLE("closed_form", struct eo_closed_form, closed_form);

static const struct eo_field kernel[] = {
    EO_OPTIONAL(struct eo_stage_kernel, form, closed, "closed_form", &closed_form_table,
                "finite elements as resolution says",
                "both members together: c exp(-|eta_i - eta_j|/l) f(s_i) f(s_j) on the same pair, else 0; f = 1 + f_1 "
                "|s - s_0| + f_2 (s - s_0)^2"),
    EO_TEXT(struct eo_stage_kernel, cache_directory, "cache_directory",
            "where finite elements are kept for the next run; empty: nowhere"),
};
const struct eo_table eo_stage_kernel_table = EO_TABLE("kernel", struct eo_stage_kernel, kernel);

struct eo_pair_options eo_stage_pair_options(const struct eo_stage_kernel *stage_kernel, enum eo_stage_pivot pivot)
{
  struct eo_pair_options options = {.cache_directory = *stage_kernel->cache_directory ? stage_kernel->cache_directory
                                                                                      : NULL,
                                    .own_pivots = pivot == EO_PIVOT_MID_FACE};
  if (stage_kernel->closed)
    options.kernel = (struct eo_kernel){.evaluate = eo_closed_form_kernel, .context = &stage_kernel->form};
  return options;
}

enum eo_code eo_stage_prepare(const struct eo_design *given, const struct eo_stage_kernel *stage_kernel,
                              struct eo_flexibility **flexibility, struct eo_error *error)
{
  struct eo_design design = *given;
  struct eo_geometry geometry;
  enum eo_code code = eo_stage_complete(&design, &geometry, EO_LEFT, error);
  if (code)
    return code;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design.resolution);
  return eo_flexibility_prepare(&geometry, &design.gear_pair, &design.material, &settings,
                                *stage_kernel->cache_directory ? stage_kernel->cache_directory : NULL, NULL,
                                flexibility, error);
}

/* Phases must lie within one cycle for the curves over it to mean anything. */
static enum eo_code check_phases(const struct eo_numbers *phase, const struct eo_design *design,
                                 const struct eo_geometry *geometry, struct eo_error *error)
{
  for (int i = 1; i < phase->count; i++)
    if (phase->value[i] <= phase->value[i - 1] || phase->value[i] - phase->value[0] >= geometry->transverse_base_pitch)
      return eo_error_set(error, EO_ERROR_INPUT, "/phase_mm",
                          "The phases must increase and stay within one base pitch of %.9g mm.",
                          1e3 * geometry->transverse_base_pitch);
  if (phase->count && design->alignment.stagger > 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/alignment/stagger",
                        "A stagger needs equal steps over the whole cycle: leave phase_mm out.");
  return EO_OK;
}

static enum eo_code make_pair(struct eo_stage_mesh *mesh, const struct eo_stage_mesh_input *input,
                              struct eo_error *error)
{
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&mesh->design.resolution);
  struct eo_pair_options options = eo_stage_pair_options(&input->kernel, input->pivot);
  grid.edge_cells = input->edge_cells;
  grid.edge_reach = input->edge_reach;
  options.grid = &grid;
  if (input->phase.count) {
    grid.positions = input->phase.count;
    options.phase = input->phase.value;
  }
  return eo_pair_new(&mesh->pair, &mesh->design, &options, NULL, error);
}

static enum eo_code set_end(struct eo_stage_mesh *mesh, int end, struct eo_error *error)
{
  const struct eo_design *design = &mesh->design;
  eo_gap_field_init(&mesh->field[end], &mesh->pair->geometry, &design->modification.flank[EO_PINION][end],
                    &design->modification.flank[EO_GEAR][end], end, design->alignment.shaft_angle_in_plane,
                    design->alignment.shaft_angle_out_of_plane, mesh->pair->pivot[end], mesh->pair->grid->corner);
  enum eo_code code = eo_loaded_gaps_init(&mesh->gaps[end], mesh->pair->grid, error);
  if (code)
    return code;
  eo_loaded_gaps_set(&mesh->gaps[end], mesh->pair->grid, &mesh->field[end]);
  return eo_loaded_end_init(&mesh->end[end], mesh->pair->grid, error);
}

enum eo_code eo_stage_mesh_init(struct eo_stage_mesh *mesh, const struct eo_stage_mesh_input *input,
                                struct eo_error *error)
{
  struct eo_geometry geometry;
  *mesh = (struct eo_stage_mesh){.design = input->design, .factor = input->compliance_factor};
  EO_TRY(eo_stage_complete(&mesh->design, &geometry, EO_LEFT, error));
  EO_TRY(check_phases(&input->phase, &mesh->design, &geometry, error));
  EO_TRY(make_pair(mesh, input, error));
  for (int end = 0; end < mesh->design.gear_pair.ends; end++)
    EO_TRY(set_end(mesh, end, error));
  EO_TRY(eo_loaded_workspace_new(&mesh->workspace, mesh->pair->grid, error));
  mesh->stagger = (int)lround(mesh->design.alignment.stagger * mesh->pair->grid->positions) %
                  mesh->pair->grid->positions;
  return EO_OK;
}

void eo_stage_mesh_done(struct eo_stage_mesh *mesh)
{
  for (int end = 0; end < 2; end++) {
    eo_loaded_end_done(&mesh->end[end]);
    eo_loaded_gaps_done(&mesh->gaps[end]);
  }
  eo_loaded_workspace_free(mesh->workspace);
  eo_pair_free(mesh->pair);
}

int eo_stage_mesh_loads(const struct eo_stage_mesh_input *input, struct eo_error *error)
{
  if (input->torque.count && input->force.count)
    eo_error_set(error, EO_ERROR_INPUT, "/force_N", "Loads are given by torque_Nm or by force_N, not by both.");
  else if (!input->torque.count && !input->force.count)
    eo_error_set(error, EO_ERROR_INPUT, "/torque_Nm", "At least one load is needed, in torque_Nm or force_N.");
  else
    return input->torque.count + input->force.count;
  return 0;
}

double eo_stage_mesh_force(const struct eo_stage_mesh *mesh, const struct eo_stage_mesh_input *input, int k,
                           double *torque)
{
  double arm = mesh->design.gear_pair.ends * mesh->pair->geometry.base_radius[EO_PINION] *
               cos(mesh->pair->geometry.base_helix_angle);
  double force = input->torque.count ? input->torque.value[k] / arm : input->force.value[k];
  *torque = force * arm;
  return force;
}

void eo_stage_mesh_solve(struct eo_stage_mesh *mesh, double force)
{
  const struct eo_alignment *alignment = &mesh->design.alignment;
  double lean = sin(mesh->pair->geometry.base_helix_angle);
  const struct eo_loaded_half half[2] = {{mesh->workspace, mesh->pair->grid, &mesh->gaps[EO_LEFT]},
                                         {mesh->workspace, mesh->pair->grid, &mesh->gaps[EO_RIGHT]}};
  struct eo_axial_hold hold = {
      .stiffness = eo_alignment_axial_stiffness(alignment),
      .play = alignment->pinion_axial == EO_AXIAL_STOPS ? lean * alignment->pinion_axial_clearance : 0};
  for (int end = 0; end < mesh->design.gear_pair.ends; end++)
    eo_loaded_solve(mesh->workspace, mesh->pair->grid, &mesh->gaps[end], mesh->factor, 1, &force, &mesh->end[end]);
  if (mesh->design.gear_pair.ends == 2 && alignment->pinion_axial != EO_AXIAL_FLOATING)
    eo_loaded_balance(half, mesh->factor, &hold, mesh->stagger, force, mesh->end);
}

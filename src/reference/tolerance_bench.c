/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/tolerance_bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/resolution.h"
#include "evaluation/meeting_field.h"
#include "gear/names.h"
#include "reference/case_pair.h"
#include "reference/verify_deviations.h"
#include "tolerance/pair_sampler.h"

static const char *const output_name[EO_BENCH_OUTPUTS] = {
    "PPLTE_um",       "LTE_mean_um",           "max_pressure_MPa",       "PPLTE_left_um",
    "PPLTE_right_um", "max_pressure_left_MPa", "max_pressure_right_MPa", "float_mean_um",
    "unloaded_TE_um"};

const char *eo_bench_output_name(int output)
{
  return output_name[output];
}

int eo_bench_output_find(const char *name)
{
  for (int i = 0; i < EO_BENCH_OUTPUTS; i++)
    if (strcmp(name, output_name[i]) == 0)
      return i;
  return -1;
}

/* Terms of a flank; T of the files is a quarter of S_alpha. */
static const struct {
  const char *key;
  size_t offset;
  double unit;
} terms[] = {
    {"profile_slope_um", offsetof(struct eo_flank_modification, profile_slope), 1e-6},
    {"helix_slope_um", offsetof(struct eo_flank_modification, helix_slope), 1e-6},
    {"lead_crowning_um", offsetof(struct eo_flank_modification, lead_crowning), 1e-6},
    {"barrel_um", offsetof(struct eo_flank_modification, profile_barrel), 1e-6},
    {"twist_um", offsetof(struct eo_flank_modification, twist), 4e-6},
    {"tip_relief_um", offsetof(struct eo_flank_modification, tip_relief), 1e-6},
    {"root_relief_um", offsetof(struct eo_flank_modification, root_relief), 1e-6},
    {"tip_start_mm", offsetof(struct eo_flank_modification, tip_relief_start), 1e-3},
    {"root_start_mm", offsetof(struct eo_flank_modification, root_relief_start), 1e-3},
};

/* "left.pinion.profile_slope_um" */
static bool find_flank(const struct eo_tolerance_bench *bench, const char *name, struct eo_bench_input *input)
{
  const struct eo_design *none = &bench->nominal;
  for (int end = 0; end < 3; end++)
    for (int member = 0; member < 2; member++)
      for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        char key[96];
        snprintf(key, sizeof key, "%s.%s.%s", eo_case_end_name[end], eo_member_name[member], terms[i].key);
        if (strcmp(name, key) != 0 || (end == 2) != (bench->ends == 1))
          continue;
        const struct eo_flank_modification *flank = bench->flank == EO_COAST_FLANK
                                                        ? &none->modification.coast[member][end % 2]
                                                        : &none->modification.flank[member][end % 2];
        input->offset = (size_t)((const char *)flank - (const char *)none) + terms[i].offset;
        input->unit = terms[i].unit;
        input->end = end % 2;
        return true;
      }
  return false;
}

static bool find_input(const struct eo_tolerance_bench *bench, const char *name, struct eo_bench_input *input)
{
  static const struct {
    const char *key;
    size_t offset;
    double unit;
    int index;
  } all[] = {
      {"shaft_error_deg.inplane", offsetof(struct eo_design, alignment.shaft_angle_in_plane), M_PI / 180, -1},
      {"shaft_error_deg.crossing", offsetof(struct eo_design, alignment.shaft_angle_out_of_plane), M_PI / 180, -1},
      {"apex_offset_um.pinion", offsetof(struct eo_design, alignment.apex_offset[EO_PINION]), 1e-6, -1},
      {"apex_offset_um.gear", offsetof(struct eo_design, alignment.apex_offset[EO_GEAR]), 1e-6, -1},
      {"pitch.pinion_um (all teeth)", 0, 1e-6, EO_PINION},
      {"pitch.gear_um (all teeth)", 0, 1e-6, EO_GEAR},
  };
  *input = (struct eo_bench_input){.name = name, .index = -1, .end = -1};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (strcmp(name, all[i].key) == 0) {
      input->offset = all[i].offset;
      input->unit = all[i].unit;
      input->index = all[i].index;
      return true;
    }
  return find_flank(bench, name, input);
}

/* A distribution in the file's words. */
static struct eo_distribution read_distribution(struct eo_case *object)
{
  static const char *const types[] = {"normal", "uniform", NULL};
  struct eo_distribution distribution = {.cut = INFINITY};
  distribution.kind = eo_case_need(object, "type") ? eo_case_choice(object, "type", types, 0) : 0;
  if (distribution.kind == EO_DISTRIBUTION_UNIFORM) {
    distribution.low = eo_case_number(object, "min");
    distribution.high = eo_case_number(object, "max");
    return distribution;
  }
  distribution.mean = eo_case_number(object, "mean");
  distribution.sigma = eo_case_number(object, "sigma");
  distribution.cut = eo_case_number_or(object, "truncated_at_sigma", INFINITY);
  return distribution;
}

void eo_bench_read_inputs(struct eo_tolerance_bench *bench, struct eo_case *variables)
{
  bench->inputs = 0;
  if (eo_case_size(variables) < 1 || eo_case_size(variables) > EO_BENCH_INPUTS)
    eo_case_fault(variables, "1 to %d variables are expected here.", EO_BENCH_INPUTS);
  for (int i = 0; i < eo_case_size(variables) && !eo_case_faulty(variables); i++) {
    struct eo_case *row = eo_case_at(variables, i);
    const char *name = eo_case_word(row, "name");
    struct eo_bench_input *input = &bench->input[bench->inputs];
    if (name && !find_input(bench, name, input))
      eo_case_fault(eo_case_find(row, "name"), "There is no input of this name.");
    input->distribution = read_distribution(eo_case_need(row, "distribution"));
    bench->inputs++;
  }
}

static void drop(struct eo_tolerance_bench *bench)
{
  for (int end = 0; end < 2; end++) {
    eo_loaded_gaps_done(&bench->gaps[end]);
    eo_loaded_end_done(&bench->loaded[end]);
    bench->gaps[end] = (struct eo_loaded_gaps){0};
    bench->loaded[end] = (struct eo_loaded_end){0};
  }
  eo_loaded_workspace_free(bench->workspace);
  eo_pair_free(bench->pair);
  bench->workspace = NULL;
  bench->pair = NULL;
}

void eo_bench_done(struct eo_tolerance_bench *bench)
{
  drop(bench);
}

static enum eo_code prepare(struct eo_tolerance_bench *bench, const char *name, int flexibility, struct eo_error *error)
{
  struct eo_design own = bench->nominal;
  struct eo_geometry geometry;
  if (bench->pair && strcmp(bench->pair_name, name) == 0 && bench->flexibility == flexibility)
    return EO_OK;
  drop(bench);
  EO_TRY(eo_geometry_init(&geometry, &own.gear_pair, error));
  eo_design_resolve(&own, &geometry);
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&own.resolution);
  grid.partial_cells = false; /* the references load a cell by its middle */
  struct eo_pair_options options = {.grid = &grid, .own_pivots = true, .tilt_rule = eo_case_tilt_rule(bench->file)};
  if (flexibility == 0)
    options.kernel = (struct eo_kernel){eo_closed_form_kernel, &bench->form};
  bench->pair_name = name;
  bench->flexibility = flexibility;
  EO_TRY(eo_pair_new(&bench->pair, &own, &options, NULL, error));
  for (int end = 0; end < 2; end++) {
    EO_TRY(eo_loaded_gaps_init(&bench->gaps[end], bench->pair->grid, error));
    EO_TRY(eo_loaded_end_init(&bench->loaded[end], bench->pair->grid, error));
  }
  return eo_loaded_workspace_new(&bench->workspace, bench->pair->grid, error);
}

static void read_flanks(struct eo_tolerance_bench *bench, struct eo_case *flanks)
{
  struct eo_modification *modification = &bench->nominal.modification;
  for (int end = 0; end < bench->ends; end++) {
    struct eo_case *of_end = flanks ? eo_case_find(flanks, eo_case_end_name[bench->ends == 1 ? 2 : end]) : NULL;
    if (flanks && !of_end)
      eo_case_fault(flanks, "The flanks of every end are expected here.");
    if (eo_case_find(eo_case_find(of_end, "pinion"), "grid") || eo_case_find(eo_case_find(of_end, "gear"), "grid"))
      eo_case_fault(of_end, "Flanks of this kind of file have terms by name, no grids.");
    for (int member = 0; member < 2; member++)
      eo_case_flank(eo_case_find(of_end, eo_member_name[member]), bench->flank, member, end,
                    bench->flank == EO_COAST_FLANK ? &modification->coast[member][end]
                                                   : &modification->flank[member][end],
                    &bench->nominal.grids);
  }
}

enum eo_code eo_bench_read(struct eo_tolerance_bench *bench, struct eo_case *item, struct eo_case *nominal,
                           struct eo_error *error)
{
  static const char *const ways[] = {"floating", "fixed", "spring", "single", NULL};
  static const char *const flexibilities[] = {"closed_form", "fe", NULL};
  struct eo_case *name = eo_case_need(item, "pair"), *errors = eo_case_find(nominal, "shaft_error_deg");
  struct eo_case *pair = eo_case_is_text(name) ? eo_case_find(eo_case_need(bench->file, "pairs"), eo_case_text(name))
                                               : NULL;
  if (!pair) {
    eo_case_fault(name ? name : item, "There is no such pair.");
    return EO_OK;
  }
  eo_case_deviation_pair(pair, &bench->nominal);
  bench->ends = bench->nominal.gear_pair.ends;
  bench->torque = eo_case_number(item, "T_Nm");
  bench->flank = eo_case_choice(item, "flank_used", eo_flank_side_name, 0) == 1 ? EO_COAST_FLANK : EO_DRIVE_FLANK;
  int way = eo_case_need(item, "pinion_axial") ? eo_case_choice(item, "pinion_axial", ways, 0) : 0;
  bench->hold = (struct eo_axial_hold){.stiffness = way == 1   ? INFINITY
                                                    : way == 2 ? eo_case_number(item, "pinion_axial_stiffness_N_per_m")
                                                               : 0};
  bench->nominal.alignment.shaft_angle_in_plane = eo_case_number_or(errors, "inplane", 0) * M_PI / 180;
  bench->nominal.alignment.shaft_angle_out_of_plane = eo_case_number_or(errors, "crossing", 0) * M_PI / 180;
  read_flanks(bench, eo_case_need(nominal, "flanks"));
  int flexibility = eo_case_choice(item, "flexibility", flexibilities, 0);
  return eo_case_faulty(item) ? EO_OK : prepare(bench, eo_case_text(name), flexibility, error);
}

/* Smallest gap over all lines, in the mean over a few positions of the mesh cycle: the approach at first contact. */
static double first_contact(const struct eo_pair *pair, const struct eo_gap_field *field)
{
  enum { POSITIONS = 8 };
  const struct eo_geometry *geometry = &pair->geometry;
  double pitch = geometry->transverse_base_pitch, mean = 0, at;
  double reach = fabs(geometry->path_start) + fabs(geometry->path_end) +
                 geometry->face_width * tan(geometry->base_helix_angle);
  int lines = (int)ceil(reach / pitch);
  for (int j = 0; j < POSITIONS; j++) {
    double least = INFINITY;
    for (int k = -lines; k <= lines; k++)
      least = fmin(least, eo_gap_field_line_minimum(field, (j / (double)POSITIONS + k) * pitch, false, &at));
    mean += least / POSITIONS;
  }
  return mean;
}

/* Index deviations common to all teeth close the gap by F cos(alpha_t) cos(beta_b), reference angle. */
static double index_gap(const struct eo_geometry *geometry, const double index[2])
{
  return -(index[EO_PINION] + index[EO_GEAR]) * cos(geometry->transverse_pressure_angle) *
         cos(geometry->base_helix_angle);
}

static void set_fields(struct eo_tolerance_bench *bench, const struct eo_design *design, const double index[2],
                       struct eo_gap_field field[2])
{
  const struct eo_flank_spline *const none[2] = {NULL, NULL};
  struct eo_running running = {.flank = bench->flank,
                               .inwards = bench->flank == EO_COAST_FLANK,
                               .in_plane = design->alignment.shaft_angle_in_plane,
                               .out_of_plane = design->alignment.shaft_angle_out_of_plane};
  for (int end = 0; end < bench->ends; end++) {
    eo_meeting_field_init(&field[end], bench->pair, design, none, &running, end);
    field[end].offset += index_gap(&bench->pair->geometry, index);
  }
}

static double largest_pressure(const struct eo_contact_grid *grid, const struct eo_loaded_end *end)
{
  double largest = 0;
  for (int j = 0; j < grid->positions; j++)
    for (int i = 0; i < grid->position[j].points; i++)
      largest = fmax(
          largest, eo_loaded_pressure(grid, end->line_load[grid->position[j].first + i], grid->position[j].radius[i]));
  return largest;
}

static double swing(int n, const double *left, const double *right)
{
  double low = INFINITY, high = -INFINITY;
  for (int j = 0; j < n; j++) {
    low = fmin(low, (left[j] + right[j]) / 2);
    high = fmax(high, (left[j] + right[j]) / 2);
  }
  return high - low;
}

static void summarise(const struct eo_tolerance_bench *bench, double *output)
{
  const struct eo_contact_grid *grid = bench->pair->grid;
  double normal = cos(grid->geometry.base_helix_angle), lean = sin(grid->geometry.base_helix_angle);
  const struct eo_loaded_end *left = &bench->loaded[0], *right = &bench->loaded[bench->ends - 1];
  int n = grid->positions;
  output[EO_BENCH_MEAN] = output[EO_BENCH_FLOAT] = 0;
  for (int j = 0; j < n; j++) {
    output[EO_BENCH_MEAN] += 1e6 * (left->approach[j] + right->approach[j]) / (2 * normal * n);
    output[EO_BENCH_FLOAT] += 1e6 * (left->approach[j] - right->approach[j]) / (2 * lean * n);
  }
  output[EO_BENCH_PPLTE] = 1e6 * swing(n, left->approach, right->approach) / normal;
  output[EO_BENCH_PPLTE_LEFT] = 1e6 * swing(n, left->approach, left->approach) / normal;
  output[EO_BENCH_PPLTE_RIGHT] = 1e6 * swing(n, right->approach, right->approach) / normal;
  output[EO_BENCH_PRESSURE_LEFT] = 1e-6 * largest_pressure(grid, left);
  output[EO_BENCH_PRESSURE_RIGHT] = 1e-6 * largest_pressure(grid, right);
  output[EO_BENCH_PRESSURE] = fmax(output[EO_BENCH_PRESSURE_LEFT], output[EO_BENCH_PRESSURE_RIGHT]);
}

/* The loaded contact of both ends. */
static bool solve(struct eo_tolerance_bench *bench, const struct eo_gap_field field[2])
{
  const struct eo_geometry *geometry = &bench->pair->geometry;
  double force = bench->torque / (bench->ends * geometry->base_radius[EO_PINION] * cos(geometry->base_helix_angle));
  struct eo_loaded_half half[2] = {{0}};
  int failures = 0;
  for (int end = 0; end < bench->ends; end++) {
    eo_loaded_gaps_set(&bench->gaps[end], bench->pair->grid, &field[end]);
    half[end] = (struct eo_loaded_half){bench->workspace, bench->pair->grid, &bench->gaps[end]};
    eo_loaded_solve(bench->workspace, bench->pair->grid, &bench->gaps[end], 1, 1, &force, &bench->loaded[end]);
  }
  if (bench->ends == 2)
    eo_loaded_balance(half, 1, &bench->hold, 0, force, bench->loaded);
  for (int end = 0; end < bench->ends; end++)
    failures += bench->loaded[end].failures;
  return failures == 0;
}

static void put_number(struct eo_design *design, size_t offset, double si)
{
  memcpy((char *)design + offset, &si, sizeof si);
}

bool eo_bench_evaluate(struct eo_tolerance_bench *bench, const double *value, double *output)
{
  struct eo_design design = bench->nominal;
  struct eo_gap_field field[2];
  double index[2] = {0};
  for (int i = 0; i < bench->inputs && value; i++) {
    const struct eo_bench_input *input = &bench->input[i];
    if (input->index >= 0)
      index[input->index] = value[i] * input->unit;
    else
      put_number(&design, input->offset, value[i] * input->unit);
  }
  set_fields(bench, &design, index, field);
  output[EO_BENCH_UNLOADED] = 0;
  for (int end = 0; end < bench->ends; end++)
    output[EO_BENCH_UNLOADED] += 1e6 * first_contact(bench->pair, &field[end]) /
                                 (bench->ends * cos(bench->pair->geometry.base_helix_angle));
  if (!(bench->torque > 0))
    return true;
  bool converged = solve(bench, field);
  summarise(bench, output);
  return converged;
}

enum eo_code eo_bench_draw(const struct eo_bench_input *input, int inputs, int points, double *value,
                           struct eo_error *error)
{
  enum { SEED = 1 };
  struct eo_sampler *sampler;
  EO_TRY(eo_sampler_new(&sampler, EO_SAMPLING_SOBOL, inputs, points, SEED, error));
  for (int point = 0; point < points; point++) {
    double *row = value + (size_t)point * (size_t)inputs;
    eo_sampler_at(sampler, point, row);
    for (int i = 0; i < inputs; i++)
      row[i] = eo_distribution_quantile(&input[i].distribution, row[i]);
  }
  eo_sampler_free(sampler);
  return EO_OK;
}

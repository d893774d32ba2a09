/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "numerics/periodic.h"
#include "reference/stage.h"
#include "reference/stage_mesh.h"

enum { MOST_PAIRS = 64 };

struct input {
  struct eo_stage_mesh_input mesh;
  bool points;
};

static const struct eo_field input[] = {
    EO_STAGE_MESH(struct input),
    EO_FLAG(struct input, points, "points", 0, "also every point of the contact lines with its gap and load"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

struct pair_output {
  int pair;
  struct eo_numbers load;
};

static const struct eo_field pair_output[] = {
    EO_INTEGER(struct pair_output, pair, "pair", -1e6, 1e6, 0, "pair k meets at c + k base pitches"),
    EO_OUT_SERIES(struct pair_output, load, "load_N", &eo_unit_N, "normal, at each phase"),
};
static const struct eo_table pair_table = EO_TABLE("a tooth pair", struct pair_output, pair_output);

enum { POSITION, PAIR, S, ETA, POINT_GAP, LENGTH, POINT_LOAD, POINT_PRESSURE, POINT_COLUMNS };
struct points_output {
  struct eo_numbers column[POINT_COLUMNS];
};

static const struct eo_field points_output[] = {
    EO_OUT_SERIES(struct points_output, column[POSITION], "position", NULL, "index of the phase, from 0"),
    EO_OUT_SERIES(struct points_output, column[PAIR], "pair", NULL, "tooth pair"),
    EO_OUT_SERIES(struct points_output, column[S], "s_mm", &eo_unit_mm,
                  "on the plane of action; beyond the path of contact at a tip edge"),
    EO_OUT_SERIES(struct points_output, column[ETA], "eta_mm", &eo_unit_mm, "axial"),
    EO_OUT_SERIES(struct points_output, column[POINT_GAP], "gap_um", &eo_unit_um, "before any load, normal"),
    EO_OUT_SERIES(struct points_output, column[LENGTH], "length_mm", &eo_unit_mm, "of its piece of the contact line"),
    EO_OUT_SERIES(struct points_output, column[POINT_LOAD], "line_load_N_per_mm", &eo_unit_N_per_mm,
                  "load per length of contact line"),
    EO_OUT_SERIES(struct points_output, column[POINT_PRESSURE], "pressure_MPa", &eo_unit_MPa, "largest Hertz pressure"),
};
static const struct eo_table points_table = EO_TABLE("points", struct points_output, points_output);

enum { UNLOADED, APPROACH, STIFFNESS, TANGENT, LOAD, LINE_LOAD, PRESSURE, EDGE, END_COLUMNS };
struct end_output {
  double datum, line_load, pressure, edge_share, peak_to_peak;
  int failures;
  struct eo_numbers column[END_COLUMNS];
  int pairs;
  struct pair_output pair[MOST_PAIRS];
  int has_points;
  struct points_output points;
};

static const struct eo_field end_output[] = {
    EO_OUT(struct end_output, datum, "datum_um", &eo_unit_um, "smallest gap anywhere on the active flank, normal"),
    EO_OUT(struct end_output, peak_to_peak, "peak_to_peak_um", &eo_unit_um,
           "of this end's transmission error alone, transverse, over the phases given"),
    EO_OUT(struct end_output, line_load, "max_line_load_N_per_mm", &eo_unit_N_per_mm, "over all phases"),
    EO_OUT(struct end_output, pressure, "max_pressure_MPa", &eo_unit_MPa, "over all phases, Hertz"),
    EO_OUT(struct end_output, edge_share, "max_edge_share", NULL, "largest part of the load on tip edges"),
    EO_INTEGER(struct end_output, failures, "not_converged", 0, 1e6, 0, "phases without a solution"),
    EO_OUT_SERIES(struct end_output, column[UNLOADED], "unloaded_um", &eo_unit_um,
                  "Z_0: approach at first contact, normal"),
    EO_OUT_SERIES(struct end_output, column[APPROACH], "approach_um", &eo_unit_um,
                  "Z, normal; the transmission error is Z / cos(beta_b)"),
    EO_OUT_SERIES(struct end_output, column[STIFFNESS], "stiffness_N_per_um", &eo_unit_N_per_um,
                  "k = P / (Z - Z_0), normal"),
    EO_OUT_SERIES(struct end_output, column[TANGENT], "tangent_N_per_um", &eo_unit_N_per_um, "k_tan = dP/dZ, normal"),
    EO_OUT_SERIES(struct end_output, column[LOAD], "load_N", &eo_unit_N, "P of the end, normal"),
    EO_OUT_SERIES(struct end_output, column[LINE_LOAD], "line_load_N_per_mm", &eo_unit_N_per_mm, "largest on any line"),
    EO_OUT_SERIES(struct end_output, column[PRESSURE], "pressure_MPa", &eo_unit_MPa, "largest Hertz pressure"),
    EO_OUT_SERIES(struct end_output, column[EDGE], "edge_share", NULL, "part of the load on tip edges"),
    EO_LIST(struct end_output, pair, pairs, "pairs", &pair_table, 0, MOST_PAIRS, "how the pairs share the load"),
    EO_OPTIONAL(struct end_output, points, has_points, "points", &points_table, "not asked for",
                "every point, line by line"),
};
static const struct eo_table end_table = EO_TABLE("an end", struct end_output, end_output);

struct load_output {
  double force, torque, mean, peak_to_peak, float_mean;
  struct eo_numbers transmission;
  struct end_output left, right;
  int two;
};

static const struct eo_field load_output[] = {
    EO_OUT(struct load_output, force, "force_N", &eo_unit_N, "normal, mean of the ends"),
    EO_OUT(struct load_output, torque, "torque_Nm", &eo_unit_Nm, "on the pinion shaft"),
    EO_OUT(struct load_output, mean, "mean_um", &eo_unit_um,
           "of the pair's loaded transmission error, transverse, over the phases given"),
    EO_OUT(struct load_output, peak_to_peak, "peak_to_peak_um", &eo_unit_um, "of the same"),
    EO_OUT(struct load_output, float_mean, "axial_float_um", &eo_unit_um,
           "mean axial displacement of the pinion, (Z_left - Z_right) / (2 sin beta_b)"),
    EO_OUT_SERIES(struct load_output, transmission, "transmission_error_um", &eo_unit_um,
                  "of the pair: mean of the ends, transverse"),
    EO_OBJECT(struct load_output, left, "left", &end_table, "left end"),
    EO_OPTIONAL(struct load_output, right, two, "right", &end_table, "the pair has one end", "right end"),
};
static const struct eo_table load_table = EO_TABLE("a load", struct load_output, load_output);

struct output {
  struct eo_numbers phase;
  int loads;
  struct load_output load[EO_STAGE_LOADS];
};

static const struct eo_field output[] = {
    EO_OUT_SERIES(struct output, phase, "phase_mm", &eo_unit_mm, "c of pair 0 at mid face"),
    EO_LIST(struct output, load, loads, "loads", &load_table, 0, EO_STAGE_LOADS, "one row per load"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static void pair_range(const struct eo_contact_grid *grid, int range[2])
{
  range[0] = range[1] = grid->position[0].line[0].pair;
  for (int j = 0; j < grid->positions; j++)
    for (int l = 0; l < grid->position[j].lines; l++) {
      int pair = grid->position[j].line[l].pair;
      range[0] = pair < range[0] ? pair : range[0];
      range[1] = pair > range[1] ? pair : range[1];
    }
}

static enum eo_code read_pairs(struct end_output *out, const struct eo_contact_grid *grid, const double *line_load,
                               struct eo_error *error)
{
  int range[2];
  pair_range(grid, range);
  if (range[1] - range[0] >= MOST_PAIRS)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/face_width_mm", "More than %d pairs of teeth are in mesh.",
                        (int)MOST_PAIRS);
  out->pairs = range[1] - range[0] + 1;
  for (int k = 0; k < out->pairs; k++) {
    out->pair[k].pair = range[0] + k;
    enum eo_code code = eo_stage_columns(1, &out->pair[k].load, grid->positions, error);
    if (code)
      return code;
  }
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    for (int i = 0; i < position->points; i++)
      out->pair[position->point[i].pair - range[0]].load.value[j] += line_load[position->first + i] *
                                                                     position->length[i];
  }
  return EO_OK;
}

static enum eo_code read_points(struct points_output *out, const struct eo_contact_grid *grid, const double *gap,
                                const double *line_load, struct eo_error *error)
{
  enum eo_code code = eo_stage_columns(POINT_COLUMNS, out->column, grid->points, error);
  for (int j = 0; j < grid->positions && !code; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    for (int i = 0; i < position->points; i++) {
      double q = line_load[position->first + i];
      const double row[POINT_COLUMNS] = {j,
                                         position->point[i].pair,
                                         position->path[i],
                                         position->point[i].eta,
                                         gap[position->first + i],
                                         position->length[i],
                                         q,
                                         q > 0 ? eo_loaded_pressure(grid, q, position->radius[i]) : 0};
      for (int k = 0; k < POINT_COLUMNS; k++)
        out->column[k].value[position->first + i] = row[k];
    }
  }
  return code;
}

static void read_position(struct end_output *out, const struct eo_contact_grid *grid, const struct eo_loaded_end *end,
                          int j)
{
  const struct eo_contact_position *position = &grid->position[j];
  double line_load = 0, pressure = 0, edge = 0;
  for (int i = 0; i < position->points; i++) {
    double q = end->line_load[position->first + i];
    line_load = fmax(line_load, q);
    pressure = fmax(pressure, q > 0 ? eo_loaded_pressure(grid, q, position->radius[i]) : 0);
    edge += position->kind[i] == EO_POINT_LINE ? 0 : q * position->length[i] / end->load[j];
  }
  out->column[LINE_LOAD].value[j] = line_load;
  out->column[PRESSURE].value[j] = pressure;
  out->column[EDGE].value[j] = edge;
  out->line_load = fmax(out->line_load, line_load);
  out->pressure = fmax(out->pressure, pressure);
  out->edge_share = fmax(out->edge_share, edge);
}

static enum eo_code read_end(struct end_output *out, const struct eo_stage_mesh *mesh, int side, bool points,
                             struct eo_error *error)
{
  const struct eo_contact_grid *grid = mesh->pair->grid;
  const struct eo_loaded_end *end = &mesh->end[side];
  enum eo_code code = eo_stage_columns(END_COLUMNS, out->column, grid->positions, error);
  if (!code)
    code = read_pairs(out, grid, end->line_load, error);
  if (!code && points)
    code = read_points(&out->points, grid, mesh->gaps[side].gap, end->line_load, error);
  if (code)
    return code;
  out->has_points = points;
  out->datum = eo_gap_field_datum(&mesh->field[side]);
  out->failures = end->failures;
  for (int j = 0; j < grid->positions; j++) {
    out->column[UNLOADED].value[j] = mesh->gaps[side].unloaded[j];
    out->column[APPROACH].value[j] = end->approach[j];
    out->column[TANGENT].value[j] = end->tangent[j];
    out->column[LOAD].value[j] = end->load[j];
    out->column[STIFFNESS].value[j] = end->load[j] / (end->approach[j] - mesh->gaps[side].unloaded[j]);
    read_position(out, grid, end, j);
  }
  out->peak_to_peak = eo_periodic_swing(grid->positions, end->approach) / cos(grid->geometry.base_helix_angle);
  return EO_OK;
}

static void read_transmission(struct load_output *out, const struct eo_stage_mesh *mesh)
{
  double normal = cos(mesh->pair->geometry.base_helix_angle), lean = sin(mesh->pair->geometry.base_helix_angle);
  int n = mesh->pair->grid->positions, last = mesh->design.gear_pair.ends - 1;
  for (int j = 0; j < n; j++) {
    double left = mesh->end[EO_LEFT].approach[j], right = mesh->end[last].approach[(j + n - mesh->stagger) % n];
    out->transmission.value[j] = (left + right) / 2 / normal;
    out->mean += out->transmission.value[j] / n;
    out->float_mean += lean > 0 ? (left - right) / (2 * lean) / n : 0;
  }
  out->peak_to_peak = eo_periodic_swing(n, out->transmission.value);
}

static enum eo_code solve_load(struct load_output *out, struct eo_stage_mesh *mesh, const struct input *given, int k,
                               struct eo_error *error)
{
  out->force = eo_stage_mesh_force(mesh, &given->mesh, k, &out->torque);
  eo_stage_mesh_solve(mesh, out->force);
  EO_TRY(eo_stage_columns(1, &out->transmission, mesh->pair->grid->positions, error));
  EO_TRY(read_end(&out->left, mesh, EO_LEFT, given->points, error));
  out->two = mesh->design.gear_pair.ends == 2;
  if (out->two)
    EO_TRY(read_end(&out->right, mesh, EO_RIGHT, given->points, error));
  read_transmission(out, mesh);
  return EO_OK;
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_stage_mesh mesh = {0};
  int loads = eo_stage_mesh_loads(&given->mesh, error);
  enum eo_code code = loads ? eo_stage_mesh_init(&mesh, &given->mesh, error) : EO_ERROR_INPUT;
  if (!code)
    code = eo_stage_columns(1, &found->phase, mesh.pair->grid->positions, error);
  for (int j = 0; !code && j < mesh.pair->grid->positions; j++)
    found->phase.value[j] = mesh.pair->grid->position[j].phase;
  for (int k = 0; k < loads && !code; k++) {
    found->loads = k + 1;
    code = solve_load(&found->load[k], &mesh, given, k, error);
  }
  eo_stage_mesh_done(&mesh);
  return code;
}

const struct eo_stage eo_stage_contact = {
    "contact", "loaded contact of both ends over the mesh cycle", &input_table, &output_table, true, run};

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include "reference/stage.h"
#include "reference/stage_mesh.h"
#include "contact/root.h"

enum { MOST_POINTS = 2000 };

struct point_input {
  int pair;
  double s, eta, force;
};

static const struct eo_field point_input[] = {
    EO_INTEGER(struct point_input, pair, "pair", -1000, 1000, 0,
               "tooth pair; those next to the tooth asked for count with neighbour_coupling"),
    EO_NUMBER_REQUIRED(struct point_input, s, "s_mm", &eo_unit_mm, -1e3, 1e3, "on the flank, path coordinate"),
    EO_NUMBER_REQUIRED(struct point_input, eta, "eta_mm", &eo_unit_mm, -5e3, 5e3,
                       "axial from mid face, + on the side that meets first"),
    EO_NUMBER_REQUIRED(struct point_input, force, "force_N", &eo_unit_N, 0, 1e9, "normal to the flank"),
};
static const struct eo_table point_table = EO_TABLE("a point load", struct point_input, point_input);

struct input {
  struct eo_stage_mesh_input mesh;
  int tooth, points;
  struct point_input point[MOST_POINTS];
};

static const struct eo_field input[] = {
    EO_STAGE_MESH(struct input),
    EO_LIST(struct input, point, points, "points", &point_table, 0, MOST_POINTS,
            "instead of torque_Nm or force_N: loads on the flanks"),
    EO_INTEGER(struct input, tooth, "tooth", -1000, 1000, 0, "of the loads in points: tooth whose root is asked for"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

enum { PHASE, STRESS, ARC, ALONG, ETA, ACROSS, COLUMNS };
struct member_output {
  double maximum, arc, eta;
  struct eo_numbers column[COLUMNS];
};

#define PLACE_FIELDS                                                        \
  EO_OUT(struct member_output, maximum, "max_MPa", &eo_unit_MPa,            \
         "largest principal stress on the root of the loaded side"),        \
      EO_OUT(struct member_output, arc, "arc_mm", &eo_unit_mm,              \
             "where: along the root from the start of the active profile"), \
      EO_OUT(struct member_output, eta, "eta_mm", &eo_unit_mm, "where: axial from mid face")

static const struct eo_field history_output[] = {
    PLACE_FIELDS,
    EO_OUT_SERIES(struct member_output, column[PHASE], "phase", NULL, "c of the tooth's pair in base pitches"),
    EO_OUT_SERIES(struct member_output, column[STRESS], "history_MPa", &eo_unit_MPa,
                  "largest on the root at that phase"),
};
static const struct eo_table history_table = EO_TABLE("a member's root through its mesh", struct member_output,
                                                      history_output);

static const struct eo_field field_output[] = {
    PLACE_FIELDS,
    EO_OUT_SERIES(struct member_output, column[ARC], "profile_arc_mm", &eo_unit_mm,
                  "along the root at that face position"),
    EO_OUT_SERIES(struct member_output, column[ALONG], "profile_stress_MPa", &eo_unit_MPa,
                  "larger principal stress there"),
    EO_OUT_SERIES(struct member_output, column[ETA], "face_eta_mm", &eo_unit_mm,
                  "over the face at that place of the root"),
    EO_OUT_SERIES(struct member_output, column[ACROSS], "face_stress_MPa", &eo_unit_MPa,
                  "larger principal stress there"),
};
static const struct eo_table field_table = EO_TABLE("a member's root", struct member_output, field_output);

struct end_output {
  struct member_output member[2];
};

static const struct eo_field end_output[] = {
    EO_OBJECT(struct end_output, member[EO_PINION], "pinion", &history_table, "the pinion"),
    EO_OBJECT(struct end_output, member[EO_GEAR], "gear", &history_table, "the gear"),
};
static const struct eo_table end_table = EO_TABLE("an end", struct end_output, end_output);

struct load_output {
  double force, torque;
  struct end_output left, right;
  int two;
};

static const struct eo_field load_output[] = {
    EO_OUT(struct load_output, force, "force_N", &eo_unit_N, "normal, mean of the ends"),
    EO_OUT(struct load_output, torque, "torque_Nm", &eo_unit_Nm, "on the pinion shaft"),
    EO_OBJECT(struct load_output, left, "left", &end_table, "left end"),
    EO_OPTIONAL(struct load_output, right, two, "right", &end_table, "the pair has one end", "right end"),
};
static const struct eo_table load_table = EO_TABLE("a load", struct load_output, load_output);

struct output {
  int by_points, loads;
  struct member_output member[2];
  struct load_output load[EO_STAGE_LOADS];
};

static const struct eo_field points_output[] = {
    EO_OBJECT(struct output, member[EO_PINION], "pinion", &field_table, "the pinion"),
    EO_OBJECT(struct output, member[EO_GEAR], "gear", &field_table, "the gear"),
};
static const struct eo_table points_output_table = EO_TABLE("under points", struct output, points_output);

static const struct eo_field output[] = {
    {.key = "points",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_NULLABLE,
     .count_offset = offsetof(struct output, by_points),
     .table = &points_output_table,
     .derived = "none were given",
     .help = "stress under the loads in points"},
    EO_LIST(struct output, load, loads, "loads", &load_table, 0, EO_STAGE_LOADS,
            "one row per load: the root of one tooth through its whole mesh"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code read_field(struct member_output *out, const struct eo_root *root, const struct eo_root_place *place,
                               const double *stress, struct eo_error *error)
{
  int across = root->layers + 1;
  enum eo_code code = eo_stage_columns(2, &out->column[ARC], root->points, error);
  if (!code)
    code = eo_stage_columns(2, &out->column[ETA], across, error);
  if (code)
    return code;
  out->maximum = place->stress;
  out->arc = place->arc;
  out->eta = place->eta;
  for (int i = 0; i < root->points; i++) {
    out->column[ARC].value[i] = root->arc[i];
    out->column[ALONG].value[i] = eo_stress_principal(stress + (i * across + place->layer) * EO_STRESSES);
  }
  for (int l = 0; l < across; l++) {
    out->column[ETA].value[l] = root->width * ((double)l / root->layers - 0.5);
    out->column[ACROSS].value[l] = eo_stress_principal(stress + (place->point * across + l) * EO_STRESSES);
  }
  return EO_OK;
}

static enum eo_code stress_member(struct member_output *out, const struct eo_flexibility *flexibility, int member,
                                  const struct input *given, const struct eo_flank_point *point, const double *force,
                                  struct eo_error *error)
{
  struct eo_root root = eo_flexibility_root(flexibility, member);
  struct eo_root_place place;
  double *stress = malloc(sizeof *stress * (size_t)(root.points * (root.layers + 1) * EO_STRESSES));
  if (!stress)
    return eo_error_memory(error);
  eo_root_find_largest(flexibility, member, given->tooth, given->points, point, force, stress, &place);
  enum eo_code code = read_field(out, &root, &place, stress, error);
  free(stress);
  return code;
}

static enum eo_code run_points(const struct input *given, struct output *found, struct eo_error *error)
{
  struct eo_flexibility *flexibility = NULL;
  struct eo_flank_point *point = calloc(MOST_POINTS, sizeof *point);
  double *force = calloc(MOST_POINTS, sizeof *force);
  enum eo_code code = point && force ? eo_stage_prepare(&given->mesh.design, &given->mesh.kernel, &flexibility, error)
                                     : eo_error_memory(error);
  for (int i = 0; i < given->points && !code; i++) {
    const struct point_input *row = &given->point[i];
    point[i] = (struct eo_flank_point){row->pair, {row->s, row->s}, row->eta};
    force[i] = row->force;
  }
  found->by_points = !code;
  for (int member = 0; member < 2 && !code; member++)
    code = stress_member(&found->member[member], flexibility, member, given, point, force, error);
  eo_flexibility_free(flexibility);
  free(force);
  free(point);
  return code;
}

static enum eo_code compute_history(struct eo_root_history *history, struct eo_root_loads *loads,
                                    struct eo_root_workspace **workspace, const struct eo_stage_mesh *mesh, int member,
                                    int end, struct eo_error *error)
{
  const struct eo_pair *pair = mesh->pair;
  struct eo_root root = eo_flexibility_root(pair->flexibility, member);
  EO_TRY(eo_root_workspace_new(workspace, pair->root, 1, error));
  EO_TRY(eo_root_loads_init(loads, pair->root, 1, error));
  EO_TRY(eo_root_history_init(history, pair->grid, error));
  eo_root_loads_find(loads, pair->root, &mesh->end[end]);
  eo_root_history_compute(history, *workspace, &root, member, loads);
  return EO_OK;
}

static enum eo_code read_history(struct member_output *out, const struct eo_stage_mesh *mesh, int member, int end,
                                 struct eo_error *error)
{
  struct eo_root_workspace *workspace = NULL;
  struct eo_root_loads loads = {0};
  struct eo_root_history history = {0};
  enum eo_code code = compute_history(&history, &loads, &workspace, mesh, member, end, error);
  eo_root_loads_done(&loads);
  eo_root_workspace_free(workspace);
  EO_TRY(code);
  out->maximum = history.maximum;
  out->arc = history.arc;
  out->eta = history.eta;
  code = eo_stage_copy(&out->column[PHASE], history.phases, history.phase, error);
  if (!code)
    code = eo_stage_copy(&out->column[STRESS], history.phases, history.stress, error);
  eo_root_history_done(&history);
  return code;
}

static enum eo_code run_load(struct load_output *out, struct eo_stage_mesh *mesh, const struct input *given, int k,
                             struct eo_error *error)
{
  enum eo_code code = EO_OK;
  out->force = eo_stage_mesh_force(mesh, &given->mesh, k, &out->torque);
  out->two = mesh->design.gear_pair.ends == 2;
  eo_stage_mesh_solve(mesh, out->force);
  for (int end = 0; end < mesh->design.gear_pair.ends; end++)
    for (int member = 0; member < 2 && !code; member++)
      code = read_history(&(end == EO_LEFT ? &out->left : &out->right)->member[member], mesh, member, end, error);
  return code;
}

static enum eo_code run_loads(const struct input *given, struct output *found, struct eo_error *error)
{
  struct eo_stage_mesh mesh = {0};
  int loads = eo_stage_mesh_loads(&given->mesh, error);
  enum eo_code code = loads ? eo_stage_mesh_init(&mesh, &given->mesh, error) : EO_ERROR_INPUT;
  for (int k = 0; k < loads && !code; k++) {
    found->loads = k + 1;
    code = run_load(&found->load[k], &mesh, given, k, error);
  }
  eo_stage_mesh_done(&mesh);
  return code;
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  if (given->mesh.kernel.closed)
    return eo_error_set(error, EO_ERROR_INPUT, "/kernel/closed_form",
                        "A closed form knows no roots: finite elements are needed.");
  if (!given->points)
    return run_loads(given, out, error);
  if (given->mesh.torque.count || given->mesh.force.count)
    return eo_error_set(error, EO_ERROR_INPUT, "/points",
                        "Loads are given by points or by torque_Nm and force_N, not by both.");
  return run_points(given, out, error);
}

const struct eo_stage eo_stage_root_stress = {
    "root-stress", "root bending stress under given loads or through the mesh", &input_table, &output_table, true, run};

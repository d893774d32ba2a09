/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/model.h"

#include <math.h>
#include <string.h>

#include "numerics/dense.h"

enum { MAX_ELEMENTS = 24 };

/* Adds k e e' and c e e' to the matrices. */
static void add_element(struct eo_dynamics_model *model, const double *e, double k, double c)
{
  int n = model->freedoms;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      model->stiffness[i * n + j] += k * e[i] * e[j]; /* theory (D2) */
      model->damping[i * n + j] += c * e[i] * e[j];
    }
}

/* Directions of relative motion that meet a spring, kept for the zero modes; those of rigid springs apart. */
struct elements {
  int n, rigid;
  double e[MAX_ELEMENTS][EO_MAX_FREEDOMS];
  double constraint[MAX_ELEMENTS][EO_MAX_FREEDOMS];
};

/* A spring and damper along e. */
static void put_element(struct eo_dynamics_model *model, struct elements *all, const double *e, double k, double c)
{
  if (k == 0)
    return;
  if (isinf(k)) {
    memcpy(all->constraint[all->rigid++], e, sizeof *all->constraint);
    return;
  }
  memcpy(all->e[all->n++], e, sizeof *all->e);
  add_element(model, e, k, c);
}

static void join(struct eo_dynamics_model *model, struct elements *all, int plus, int minus, double k, double c)
{
  double e[EO_MAX_FREEDOMS] = {0};
  e[plus] = 1;
  if (minus >= 0)
    e[minus] = -1;
  put_element(model, all, e, k, c);
}

/* k_a from the mean axial motion of the pinion to ground. */
static void hold_pinion(struct eo_dynamics_model *model, struct elements *all)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  double e[EO_MAX_FREEDOMS] = {0};
  for (int end = 0; end < parameters->ends; end++)
    e[eo_dynamics_freedom(parameters->ends, EO_PINION, end, EO_MOTION_Z)] = 1.0 / parameters->ends;
  put_element(model, all, e, parameters->pinion_axial_stiffness, parameters->pinion_axial_damping);
}

/* Of the torque by which an end turns, so that groove and screw mode bear none of it at rest: theory (F11). */
static double torque_share(const struct eo_dynamics_parameters *parameters, int end)
{
  return parameters->ends == 1 ? 1 : eo_dynamics_double_helix(parameters).share[end];
}

static void join_machines(struct eo_dynamics_model *model, struct elements *all)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  for (int member = 0; member < 2; member++) {
    double e[EO_MAX_FREEDOMS] = {0};
    if (model->machine[member] < 0)
      continue;
    e[model->machine[member]] = 1;
    for (int end = 0; end < parameters->ends; end++)
      e[eo_dynamics_freedom(parameters->ends, member, end, EO_MOTION_ROTATION)] = -torque_share(parameters, end);
    put_element(model, all, e, parameters->machine_stiffness[member], parameters->machine_damping[member]);
  }
}

static void add_supports(struct eo_dynamics_model *model, struct elements *all)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  int ends = parameters->ends;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < ends; end++)
      join(model, all, eo_dynamics_freedom(ends, member, end, EO_MOTION_Y), -1, parameters->bearing_stiffness[member],
           parameters->bearing_damping[member]);
  for (int end = 0; end < ends; end++)
    join(model, all, eo_dynamics_freedom(ends, EO_GEAR, end, EO_MOTION_Z), -1, parameters->gear_axial_stiffness[end],
         parameters->gear_axial_damping[end]);
  hold_pinion(model, all);
  join_machines(model, all);
  if (ends == 1) {
    join(model, all, eo_dynamics_freedom(1, EO_PINION, 0, EO_MOTION_Z), -1, parameters->groove_axial_stiffness[0],
         parameters->groove_axial_damping[0]);
    return;
  }
  for (int member = 0; member < 2; member++) {
    join(model, all, eo_dynamics_freedom(2, member, 0, EO_MOTION_Z), eo_dynamics_freedom(2, member, 1, EO_MOTION_Z),
         parameters->groove_axial_stiffness[member], parameters->groove_axial_damping[member]);
    join(model, all, eo_dynamics_freedom(2, member, 0, EO_MOTION_ROTATION),
         eo_dynamics_freedom(2, member, 1, EO_MOTION_ROTATION), parameters->groove_torsional_stiffness[member],
         parameters->groove_torsional_damping[member]);
  }
}

static void set_readings(struct eo_dynamics_model *model)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  for (int end = 0; end < parameters->ends; end++) {
    double helix = eo_dynamics_base_helix_angle(parameters, end), c = cos(helix), s = sin(helix);
    double hand = end == 0 ? s : -s;
    for (int member = 0; member < 2; member++) {
      double sign = member == EO_PINION ? 1 : -1;
      int y = eo_dynamics_freedom(parameters->ends, member, end, EO_MOTION_Y);
      int z = eo_dynamics_freedom(parameters->ends, member, end, EO_MOTION_Z);
      int rotation = eo_dynamics_freedom(parameters->ends, member, end, EO_MOTION_ROTATION);
      double radius = parameters->base_radius[member];
      model->reading[EO_READING_NORMAL][end][y] = sign * c; /* theory (D1) */
      model->reading[EO_READING_NORMAL][end][z] = sign * hand;
      model->reading[EO_READING_NORMAL][end][rotation] = sign * c * radius;
      model->reading[EO_READING_TRANSVERSE][end][y] = sign;
      model->reading[EO_READING_TRANSVERSE][end][rotation] = sign * radius;
      model->reading[EO_READING_ROTATIONAL][end][rotation] = sign * radius;
      model->theta_impact[end][rotation] = sign * radius;
    }
  }
}

/* Takes the components along `count` orthonormal vectors out of v, twice for the sake of roundoff; returns what is left
   of it. */
static double orthogonalise(int n, double *v, int count, double (*vector)[EO_MAX_FREEDOMS])
{
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < count; k++) {
      double along = eo_dot(n, v, vector[k]);
      for (int i = 0; i < n; i++)
        v[i] -= along * vector[k][i];
    }
  return sqrt(eo_dot(n, v, v));
}

/* Extends `count` orthonormal vectors by those of the candidates that are independent of them, the clearest first
   (Gram-Schmidt with pivoting). The candidates are unit vectors, so the threshold is a matter of geometry and not of
   stiffness. */
static int extend(int n, int count, double (*vector)[EO_MAX_FREEDOMS], int candidates,
                  double (*candidate)[EO_MAX_FREEDOMS])
{
  const double independent = 1e-9;
  for (;;) {
    int best = -1;
    double largest = independent;
    for (int c = 0; c < candidates; c++) {
      double left = orthogonalise(n, candidate[c], count, vector);
      if (left > largest) {
        largest = left;
        best = c;
      }
    }
    if (best < 0 || count == n)
      return count;
    for (int i = 0; i < n; i++)
      vector[count][i] = candidate[best][i] / largest;
    count++;
  }
}

/* Directions in coordinates scaled by sqrt(m), as unit vectors. */
static void scale_directions(const struct eo_dynamics_model *model, int count, double (*direction)[EO_MAX_FREEDOMS])
{
  int n = model->freedoms;
  for (int c = 0; c < count; c++) {
    for (int i = 0; i < n; i++)
      direction[c][i] /= sqrt(model->mass[i]);
    double length = sqrt(eo_dot(n, direction[c], direction[c]));
    for (int i = 0; i < n; i++)
      direction[c][i] /= length;
  }
}

/* In coordinates scaled by sqrt(m) the motions there are stand at right angles to the directions of rigid springs, and
   the zero modes to all element directions besides. */
static void split_motions(struct eo_dynamics_model *model, struct elements *all)
{
  int n = model->freedoms;
  double vector[EO_MAX_FREEDOMS][EO_MAX_FREEDOMS] = {0};
  scale_directions(model, all->rigid, all->constraint);
  scale_directions(model, all->n, all->e);
  int held = extend(n, 0, vector, all->rigid, all->constraint);
  int known = extend(n, held, vector, all->n, all->e), rank = known - held;
  double unit[EO_MAX_FREEDOMS][EO_MAX_FREEDOMS] = {0};
  for (int i = 0; i < n; i++)
    unit[i][i] = 1;
  extend(n, known, vector, n, unit);
  model->constraints = held;
  model->zero_modes = n - known;
  model->oscillator.n = rank;
  for (int i = 0; i < n; i++)
    for (int k = held; k < n; k++) {
      double value = vector[k][i] / sqrt(model->mass[i]);
      if (k < known)
        model->basis[i * rank + k - held] = value;
      else
        model->zero[i * model->zero_modes + k - known] = value;
    }
}

/* reduced[n] = basis' full[freedoms] */
static void project(const struct eo_dynamics_model *model, const double *full, double *reduced)
{
  int n = model->oscillator.n;
  for (int k = 0; k < n; k++) {
    reduced[k] = 0;
    for (int i = 0; i < model->freedoms; i++)
      reduced[k] += model->basis[i * n + k] * full[i];
  }
}

/* reduced[n][n] = basis' full basis, symmetric to the last bit */
static void project_matrix(const struct eo_dynamics_model *model, const double *full, double *reduced)
{
  int n = model->oscillator.n, f = model->freedoms;
  for (int k = 0; k < n; k++) {
    double column[EO_MAX_FREEDOMS], image[EO_MAX_FREEDOMS];
    for (int i = 0; i < f; i++)
      column[i] = model->basis[i * n + k];
    for (int i = 0; i < f; i++)
      image[i] = eo_dot(f, full + i * f, column);
    for (int l = 0; l <= k; l++) {
      double sum = 0;
      for (int i = 0; i < f; i++)
        sum += model->basis[i * n + l] * image[i];
      reduced[k * n + l] = reduced[l * n + k] = sum;
    }
  }
}

/* Stiffness added while condensing where no bearing gives it a size, N/m: that of a mesh; its value cancels. */
static const double rigid_shift = 1e9;

static void reduce(struct eo_dynamics_model *model)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  struct eo_oscillator *oscillator = &model->oscillator;
  oscillator->ends = parameters->ends;
  oscillator->shift = isfinite(parameters->bearing_stiffness[EO_PINION]) ? parameters->bearing_stiffness[EO_PINION]
                                                                         : rigid_shift;
  oscillator->symmetric = parameters->ends == 2 &&
                          eo_dynamics_base_helix_angle(parameters, EO_RIGHT) == parameters->base_helix_angle &&
                          parameters->gear_axial_stiffness[0] == parameters->gear_axial_stiffness[1] &&
                          parameters->gear_axial_damping[0] == parameters->gear_axial_damping[1];
  project_matrix(model, model->stiffness, oscillator->stiffness);
  project_matrix(model, model->damping, oscillator->damping);
  for (int end = 0; end < parameters->ends; end++)
    project(model, model->reading[EO_READING_NORMAL][end], oscillator->mesh[end]);
}

/* Mass or, of the rotation, inertia of an end. */
static double mass_of(const struct eo_dynamics_parameters *parameters, int member, int end, int motion)
{
  bool rotation = motion == EO_MOTION_ROTATION;
  double right = rotation ? parameters->right_inertia[member] : parameters->right_mass[member];
  if (end == EO_RIGHT && right > 0)
    return right;
  return rotation ? parameters->inertia[member] : parameters->mass[member];
}

enum eo_code eo_dynamics_model_init(struct eo_dynamics_model *model, const struct eo_dynamics_parameters *parameters,
                                    struct eo_error *error)
{
  enum eo_code code = eo_dynamics_parameters_check(parameters, error);
  if (code)
    return code;
  *model = (struct eo_dynamics_model){.parameters = *parameters, .freedoms = 6 * parameters->ends, .machine = {-1, -1}};
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < parameters->ends; end++)
      for (int motion = EO_MOTION_Y; motion <= EO_MOTION_ROTATION; motion++)
        model->mass[eo_dynamics_freedom(parameters->ends, member, end, motion)] = mass_of(parameters, member, end,
                                                                                          motion);
  for (int member = 0; member < 2; member++)
    if (parameters->machine_inertia[member] > 0) {
      model->machine[member] = model->freedoms;
      model->mass[model->freedoms++] = parameters->machine_inertia[member];
    }
  struct elements all = {0};
  add_supports(model, &all);
  set_readings(model);
  for (int end = 0; end < parameters->ends; end++)
    memcpy(all.e[all.n++], model->reading[EO_READING_NORMAL][end], sizeof *all.e);
  split_motions(model, &all);
  reduce(model);
  return EO_OK;
}

/* Where the torque comes in and goes out: at the machine, or at the ends, by equal parts or, of unequal helices, by
   those that balance the thrusts. */
static void set_torque(const struct eo_dynamics_model *model, int member, double torque, double *load)
{
  int ends = model->parameters.ends;
  if (model->machine[member] >= 0)
    load[model->machine[member]] = torque;
  else
    for (int end = 0; end < ends; end++)
      load[eo_dynamics_freedom(ends, member, end, EO_MOTION_ROTATION)] = torque * torque_share(&model->parameters, end);
}

void eo_dynamics_model_load(struct eo_dynamics_model *model, double torque, enum eo_impact_in_dynamics impact)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  int ends = parameters->ends;
  double load[EO_MAX_FREEDOMS] = {0};
  set_torque(model, EO_PINION, torque, load);
  set_torque(model, EO_GEAR, -torque * parameters->base_radius[EO_GEAR] / parameters->base_radius[EO_PINION], load);
  for (int end = 0; end < ends; end++) {
    struct eo_oscillator *oscillator = &model->oscillator;
    if (impact == EO_IMPACT_PAPER)
      project(model, model->theta_impact[end], oscillator->pulse[end]);
    else
      for (int k = 0; k < oscillator->n; k++)
        oscillator->pulse[end][k] = impact == EO_IMPACT_NONE
                                        ? 0
                                        : oscillator->mesh[end][k] / cos(eo_dynamics_base_helix_angle(parameters, end));
  }
  project(model, load, model->oscillator.load);
  model->zero_mode_load = 0;
  for (int z = 0; z < model->zero_modes; z++) {
    double work = 0, motion = 0;
    for (int i = 0; i < model->freedoms; i++) {
      work += model->zero[i * model->zero_modes + z] * load[i];
      motion += pow(model->zero[i * model->zero_modes + z], 2);
    }
    double size = sqrt(eo_dot(model->freedoms, load, load) * motion);
    model->zero_mode_load = fmax(model->zero_mode_load, size > 0 ? fabs(work) / size : 0);
  }
}

double eo_dynamics_model_impact_drift(const struct eo_dynamics_model *model, const double mean[2])
{
  double square = 0;
  for (int z = 0; z < model->zero_modes; z++) {
    double work = 0;
    for (int end = 0; end < model->parameters.ends; end++)
      for (int i = 0; i < model->freedoms; i++)
        work += model->zero[i * model->zero_modes + z] * model->theta_impact[end][i] * mean[end];
    square += work * work;
  }
  return sqrt(square);
}

/* dX'/dr of both ends, which their helices have in common when the pair rolls. */
static void level_meshes(const struct eo_dynamics_model *model, double mesh[2][EO_MAX_COORDINATES])
{
  const struct eo_double_helix helix = eo_dynamics_double_helix(&model->parameters);
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < model->oscillator.n; i++)
      mesh[end][i] = model->oscillator.mesh[end][i] * helix.scale[end];
}

static bool is_held(const struct eo_dynamics_model *model, double lean)
{
  return model->oscillator.ends == 2 && lean != 0 && model->parameters.pinion_axial_stiffness != 0 &&
         model->zero_modes <= 1;
}

/* H = mesh' (K + shift mesh mesh')^-1 mesh is (S + shift)^-1 and S = s [1 -1; -1 1], since both ends together roll
   freely: (1, -1) H (1, -1)' = 2 / (2 s + shift). Of unequal helices with X' in place of X. */
double eo_dynamics_model_axial_stiffness(const struct eo_dynamics_model *model)
{
  const struct eo_oscillator *oscillator = &model->oscillator;
  const struct eo_double_helix helix = eo_dynamics_double_helix(&model->parameters);
  double lean = eo_double_helix_lean(&helix) / 2;
  if (!is_held(model, lean))
    return 0;
  int n = oscillator->n, pivot[EO_MAX_COORDINATES];
  double k[EO_MAX_COORDINATES * EO_MAX_COORDINATES], apart[EO_MAX_COORDINATES], response[EO_MAX_COORDINATES],
      mesh[2][EO_MAX_COORDINATES];
  level_meshes(model, mesh);
  memcpy(k, oscillator->stiffness, sizeof k);
  for (int i = 0; i < n; i++) {
    response[i] = apart[i] = mesh[0][i] - mesh[1][i];
    for (int j = 0; j < n; j++)
      for (int end = 0; end < 2; end++)
        k[i * n + j] += oscillator->shift * mesh[end][i] * mesh[end][j];
  }
  if (eo_dense_solve(n, k, pivot, 1, response))
    return 0;
  double soft = oscillator->shift * eo_dot(n, apart, response) / 2; /* 1 / (1 + 2 s / shift) */
  const double none = 1e-12;
  return soft < none ? INFINITY : 2 * lean * lean * oscillator->shift * (1 / soft - 1);
}

/* K r = load - mesh forces, with X'_L + X'_R held at 0 by a spring that bears nothing: the forces do no work when the
   pair rolls. */
double eo_dynamics_model_axial_rest(struct eo_dynamics_model *model)
{
  struct eo_oscillator *oscillator = &model->oscillator;
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  const struct eo_double_helix helix = eo_dynamics_double_helix(parameters);
  if (!is_held(model, eo_double_helix_lean(&helix)) || helix.scale[EO_RIGHT] == 1)
    return 0;
  int n = oscillator->n, pivot[EO_MAX_COORDINATES];
  double k[EO_MAX_COORDINATES * EO_MAX_COORDINATES], rest[EO_MAX_COORDINATES], mesh[2][EO_MAX_COORDINATES],
      torque = 2 * parameters->base_radius[EO_PINION] * cos(parameters->base_helix_angle);
  level_meshes(model, mesh);
  eo_dynamics_model_load(model, torque, EO_IMPACT_NONE);
  memcpy(k, oscillator->stiffness, sizeof k);
  for (int i = 0; i < n; i++) {
    rest[i] = oscillator->load[i];
    for (int end = 0; end < 2; end++)
      rest[i] -= oscillator->mesh[end][i] * eo_double_helix_load(&helix, end, 1);
    for (int j = 0; j < n; j++)
      k[i * n + j] += oscillator->shift * (mesh[0][i] + mesh[1][i]) * (mesh[0][j] + mesh[1][j]);
  }
  return eo_dense_solve(n, k, pivot, 1, rest) ? 0
                                              : eo_dot(n, mesh[0], rest) - eo_dot(n, mesh[1], rest); /* theory (F13) */
}

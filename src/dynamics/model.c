#include "dynamics/model.h"

#include <math.h>
#include <string.h>

enum { MAX_ELEMENTS = 16 };

/* Adds k e e' and c e e' to the matrices. */
static void add_element(struct eo_dynamics_model *m, const double *e, double k, double c)
{
  int n = m->freedoms;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      m->stiffness[i * n + j] += k * e[i] * e[j];
      m->damping[i * n + j] += c * e[i] * e[j];
    }
}

/* Directions of relative motion that meet a spring, kept for the zero modes. */
struct elements {
  int n;
  double e[MAX_ELEMENTS][EO_MAX_FREEDOMS];
};

static void join(struct eo_dynamics_model *m, struct elements *all, int plus, int minus, double k, double c)
{
  if (k == 0)
    return;
  double *e = all->e[all->n++];
  e[plus] = 1;
  if (minus >= 0)
    e[minus] = -1;
  add_element(m, e, k, c);
}

static void add_supports(struct eo_dynamics_model *m, struct elements *all)
{
  const struct eo_dynamics_parameters *p = &m->parameters;
  int ends = p->ends;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < ends; end++)
      join(m, all, eo_dynamics_freedom(ends, member, end, EO_MOTION_Y), -1, p->bearing_stiffness[member],
           p->bearing_damping[member]);
  for (int end = 0; end < ends; end++)
    join(m, all, eo_dynamics_freedom(ends, EO_GEAR, end, EO_MOTION_Z), -1, p->gear_axial_stiffness[end],
         p->gear_axial_damping[end]);
  if (ends == 1) {
    join(m, all, eo_dynamics_freedom(1, EO_PINION, 0, EO_MOTION_Z), -1, p->groove_axial_stiffness[0],
         p->groove_axial_damping[0]);
    return;
  }
  for (int member = 0; member < 2; member++) {
    join(m, all, eo_dynamics_freedom(2, member, 0, EO_MOTION_Z), eo_dynamics_freedom(2, member, 1, EO_MOTION_Z),
         p->groove_axial_stiffness[member], p->groove_axial_damping[member]);
    join(m, all, eo_dynamics_freedom(2, member, 0, EO_MOTION_ROTATION),
         eo_dynamics_freedom(2, member, 1, EO_MOTION_ROTATION), p->groove_torsional_stiffness[member],
         p->groove_torsional_damping[member]);
  }
}

static void set_readings(struct eo_dynamics_model *m)
{
  const struct eo_dynamics_parameters *p = &m->parameters;
  double c = cos(p->base_helix_angle), s = sin(p->base_helix_angle);
  for (int end = 0; end < p->ends; end++) {
    double hand = end == 0 ? s : -s;
    for (int member = 0; member < 2; member++) {
      double sign = member == EO_PINION ? 1 : -1;
      int y = eo_dynamics_freedom(p->ends, member, end, EO_MOTION_Y);
      int z = eo_dynamics_freedom(p->ends, member, end, EO_MOTION_Z);
      int rotation = eo_dynamics_freedom(p->ends, member, end, EO_MOTION_ROTATION);
      double radius = p->base_radius[member];
      m->reading[EO_READING_NORMAL][end][y] = sign * c;
      m->reading[EO_READING_NORMAL][end][z] = sign * hand;
      m->reading[EO_READING_NORMAL][end][rotation] = sign * c * radius;
      m->reading[EO_READING_TRANSVERSE][end][y] = sign;
      m->reading[EO_READING_TRANSVERSE][end][rotation] = sign * radius;
      m->reading[EO_READING_ROTATIONAL][end][rotation] = sign * radius;
      m->theta_impact[end][rotation] = sign * radius;
    }
  }
}

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* Takes the components along `count` orthonormal vectors out of v, twice for the sake of roundoff; returns what is left
   of it. */
static double orthogonalise(int n, double *v, int count, double (*vector)[EO_MAX_FREEDOMS])
{
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < count; k++) {
      double along = dot(n, v, vector[k]);
      for (int i = 0; i < n; i++)
        v[i] -= along * vector[k][i];
    }
  return sqrt(dot(n, v, v));
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

/* In coordinates scaled by sqrt(m) the zero modes are the orthogonal complement of all element directions. */
static void split_motions(struct eo_dynamics_model *m, const struct elements *all)
{
  int n = m->freedoms, candidates = all->n;
  double candidate[MAX_ELEMENTS][EO_MAX_FREEDOMS] = {0}, vector[EO_MAX_FREEDOMS][EO_MAX_FREEDOMS] = {0};
  for (int c = 0; c < candidates; c++) {
    for (int i = 0; i < n; i++)
      candidate[c][i] = all->e[c][i] / sqrt(m->mass[i]);
    double length = sqrt(dot(n, candidate[c], candidate[c]));
    for (int i = 0; i < n; i++)
      candidate[c][i] /= length;
  }
  int rank = extend(n, 0, vector, candidates, candidate);
  double unit[EO_MAX_FREEDOMS][EO_MAX_FREEDOMS] = {0};
  for (int i = 0; i < n; i++)
    unit[i][i] = 1;
  extend(n, rank, vector, n, unit);
  m->zero_modes = n - rank;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      double value = vector[k][i] / sqrt(m->mass[i]);
      if (k < rank)
        m->basis[i * rank + k] = value;
      else
        m->zero[i * m->zero_modes + k - rank] = value;
    }
}

/* reduced[n] = basis' full[freedoms] */
static void project(const struct eo_dynamics_model *m, const double *full, double *reduced)
{
  int n = m->oscillator.n;
  for (int k = 0; k < n; k++) {
    reduced[k] = 0;
    for (int i = 0; i < m->freedoms; i++)
      reduced[k] += m->basis[i * n + k] * full[i];
  }
}

/* reduced[n][n] = basis' full basis, symmetric to the last bit */
static void project_matrix(const struct eo_dynamics_model *m, const double *full, double *reduced)
{
  int n = m->oscillator.n, f = m->freedoms;
  for (int k = 0; k < n; k++) {
    double column[EO_MAX_FREEDOMS], image[EO_MAX_FREEDOMS];
    for (int i = 0; i < f; i++)
      column[i] = m->basis[i * n + k];
    for (int i = 0; i < f; i++)
      image[i] = dot(f, full + i * f, column);
    for (int l = 0; l <= k; l++) {
      double sum = 0;
      for (int i = 0; i < f; i++)
        sum += m->basis[i * n + l] * image[i];
      reduced[k * n + l] = reduced[l * n + k] = sum;
    }
  }
}

static void reduce(struct eo_dynamics_model *m)
{
  const struct eo_dynamics_parameters *p = &m->parameters;
  struct eo_oscillator *o = &m->oscillator;
  o->n = m->freedoms - m->zero_modes;
  o->ends = p->ends;
  o->shift = p->bearing_stiffness[EO_PINION];
  o->symmetric = p->ends == 2 && p->gear_axial_stiffness[0] == p->gear_axial_stiffness[1] &&
                 p->gear_axial_damping[0] == p->gear_axial_damping[1];
  project_matrix(m, m->stiffness, o->stiffness);
  project_matrix(m, m->damping, o->damping);
  for (int end = 0; end < p->ends; end++)
    project(m, m->reading[EO_READING_NORMAL][end], o->mesh[end]);
}

enum eo_code eo_dynamics_model_init(struct eo_dynamics_model *model, const struct eo_dynamics_parameters *parameters,
                                    struct eo_error *error)
{
  enum eo_code code = eo_dynamics_parameters_check(parameters, error);
  if (code)
    return code;
  *model = (struct eo_dynamics_model){.parameters = *parameters, .freedoms = 6 * parameters->ends};
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < parameters->ends; end++)
      for (int motion = EO_MOTION_Y; motion <= EO_MOTION_ROTATION; motion++)
        model->mass[eo_dynamics_freedom(parameters->ends, member, end, motion)] = motion == EO_MOTION_ROTATION
                                                                                      ? parameters->inertia[member]
                                                                                      : parameters->mass[member];
  struct elements all = {0};
  add_supports(model, &all);
  set_readings(model);
  for (int end = 0; end < parameters->ends; end++)
    memcpy(all.e[all.n++], model->reading[EO_READING_NORMAL][end], sizeof *all.e);
  split_motions(model, &all);
  reduce(model);
  return EO_OK;
}

void eo_dynamics_model_load(struct eo_dynamics_model *model, double torque, enum eo_impact_in_dynamics impact)
{
  const struct eo_dynamics_parameters *p = &model->parameters;
  int ends = p->ends;
  double load[EO_MAX_FREEDOMS] = {0};
  for (int end = 0; end < ends; end++) {
    load[eo_dynamics_freedom(ends, EO_PINION, end, EO_MOTION_ROTATION)] = torque / ends;
    load[eo_dynamics_freedom(ends, EO_GEAR, end, EO_MOTION_ROTATION)] = -torque / ends * p->base_radius[EO_GEAR] /
                                                                        p->base_radius[EO_PINION];
    struct eo_oscillator *o = &model->oscillator;
    if (impact == EO_IMPACT_PAPER)
      project(model, model->theta_impact[end], o->pulse[end]);
    else
      for (int k = 0; k < o->n; k++)
        o->pulse[end][k] = impact == EO_IMPACT_NONE ? 0 : o->mesh[end][k] / cos(p->base_helix_angle);
  }
  project(model, load, model->oscillator.load);
  model->zero_mode_load = 0;
  for (int z = 0; z < model->zero_modes; z++) {
    double work = 0, motion = 0;
    for (int i = 0; i < model->freedoms; i++) {
      work += model->zero[i * model->zero_modes + z] * load[i];
      motion += pow(model->zero[i * model->zero_modes + z], 2);
    }
    double size = sqrt(dot(model->freedoms, load, load) * motion);
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

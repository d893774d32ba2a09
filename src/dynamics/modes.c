/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/model.h"
#include "numerics/dense.h"

static int by_size(const void *a, const void *b)
{
  const double complex *p = a, *q = b;
  double x = cabs(*p), y = cabs(*q);
  if (fabs(x - y) > 1e-9 * (x + y))
    return x < y ? -1 : 1;
  return (cimag(*p) > cimag(*q)) - (cimag(*p) < cimag(*q));
}

/* Poles of the first-order form [0 1; -K -C]. */
static int find_poles(int n, const double *stiffness, const double *damping, double complex *pole)
{
  double a[4 * EO_MAX_FREEDOMS * EO_MAX_FREEDOMS] = {0};
  int size = 2 * n;
  for (int i = 0; i < n; i++) {
    a[i * size + n + i] = 1;
    for (int j = 0; j < n; j++) {
      a[(n + i) * size + j] = -stiffness[i * n + j];
      a[(n + i) * size + n + j] = -damping[i * n + j];
    }
  }
  int failed = eo_dense_eigenvalues(size, a, pole);
  if (!failed)
    qsort(pole, size, sizeof *pole, by_size);
  return failed;
}

static void set_shapes(const struct eo_dynamics_model *model, const double *vector, struct eo_dynamics_modes *modes)
{
  int n = modes->n;
  for (int mode = 0; mode < n; mode++)
    eo_dense_multiply(model->freedoms, n, model->basis, vector + mode * n, modes->shape[mode]);
}

enum eo_code eo_dynamics_model_modes(const struct eo_dynamics_model *model, const double mesh_stiffness[2],
                                     struct eo_dynamics_modes *modes, struct eo_error *error)
{
  const struct eo_oscillator *oscillator = &model->oscillator;
  int n = oscillator->n;
  double k[EO_MAX_COORDINATES * EO_MAX_COORDINATES], c[EO_MAX_COORDINATES * EO_MAX_COORDINATES],
      square[EO_MAX_COORDINATES];
  memcpy(k, oscillator->stiffness, sizeof k);
  memcpy(c, oscillator->damping, sizeof c);
  for (int end = 0; end < oscillator->ends; end++) {
    if (!(mesh_stiffness[end] > 0 && isfinite(mesh_stiffness[end])))
      return eo_error_set(error, EO_ERROR_INPUT, "", "Eigenfrequencies need a positive mesh stiffness, not %g N/m.",
                          mesh_stiffness[end]);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        k[i * n + j] += mesh_stiffness[end] * oscillator->mesh[end][i] * oscillator->mesh[end][j];
        c[i * n + j] += model->parameters.mesh_damping * oscillator->mesh[end][i] * oscillator->mesh[end][j];
      }
  }
  struct eo_dynamics_modes found = {.n = n, .zero_modes = model->zero_modes};
  if (find_poles(n, k, c, found.pole) || eo_dense_symmetric_eigen(n, k, square))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The eigenvalues of the model could not be found.");
  for (int mode = 0; mode < n; mode++) {
    found.frequency[mode] = sqrt(fmax(square[mode], 0)) / (2 * M_PI);
    const double complex *pair = found.pole + 2 * mode;
    double size = sqrt(cabs(pair[0]) * cabs(pair[1]));
    found.damping_ratio[mode] = size > 0 ? -creal(pair[0] + pair[1]) / (2 * size) : 0;
  }
  set_shapes(model, k, &found);
  *modes = found;
  return EO_OK;
}

/* M^-1 (matrix + sum k g g') */
static void full_matrix(const struct eo_dynamics_model *model, const double *matrix, const double mesh[2], double *full)
{
  int n = model->freedoms;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      full[i * n + j] = matrix[i * n + j];
      for (int end = 0; end < model->parameters.ends; end++)
        full[i * n + j] += mesh[end] * model->reading[EO_READING_NORMAL][end][i] *
                           model->reading[EO_READING_NORMAL][end][j];
      full[i * n + j] /= model->mass[i];
    }
}

enum eo_code eo_dynamics_model_printed_pole(const struct eo_dynamics_model *model, const double mesh_stiffness[2],
                                            double complex *pole, struct eo_error *error)
{
  const struct eo_dynamics_parameters *parameters = &model->parameters;
  if (parameters->ends != 2)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The printed signs concern the groove between two ends.");
  double k[EO_MAX_FREEDOMS * EO_MAX_FREEDOMS], c[EO_MAX_FREEDOMS * EO_MAX_FREEDOMS];
  double complex all[2 * EO_MAX_FREEDOMS];
  const double damping[2] = {parameters->mesh_damping, parameters->mesh_damping};
  int n = model->freedoms, zp1 = eo_dynamics_freedom(2, EO_PINION, 0, EO_MOTION_Z),
      zp2 = eo_dynamics_freedom(2, EO_PINION, 1, EO_MOTION_Z), zg1 = eo_dynamics_freedom(2, EO_GEAR, 0, EO_MOTION_Z),
      zg2 = eo_dynamics_freedom(2, EO_GEAR, 1, EO_MOTION_Z);
  full_matrix(model, model->stiffness, mesh_stiffness, k);
  full_matrix(model, model->damping, damping, c);
  k[zp2 * n + zp1] += 2 * parameters->groove_axial_stiffness[EO_PINION] / parameters->mass[EO_PINION];
  c[zp2 * n + zp1] += 2 * parameters->groove_axial_damping[EO_PINION] / parameters->mass[EO_PINION];
  c[zg2 * n + zg2] -= 2 * parameters->groove_axial_damping[EO_GEAR] / parameters->mass[EO_GEAR];
  c[zg2 * n + zg1] += 2 * parameters->groove_axial_damping[EO_GEAR] / parameters->mass[EO_GEAR];
  if (find_poles(n, k, c, all))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The poles of the printed equations could not be found.");
  *pole = all[0];
  for (int i = 1; i < 2 * n; i++)
    if (creal(all[i]) > creal(*pole) || (creal(all[i]) == creal(*pole) && cimag(all[i]) > cimag(*pole)))
      *pole = all[i];
  return EO_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dense solves, eigenvalues, Fourier series and the differential equation solver on problems with known answers. */
#include <string.h>

#include "support/tap.h"
#include "numerics/dense.h"
#include "numerics/fourier.h"
#include "numerics/ode.h"

static void solves(void)
{
  double a[9] = {0, 2, 1, 1, 1, 0, 3, 0, 1}, b[6] = {7, 3, 6, 1, 0, 0};
  int pivot[3];
  ok(!eo_dense_solve(3, a, pivot, 2, b), "a row-major system with two right-hand sides is solved");
  double x[3] = {b[0], b[1], b[2]};
  close_to(2 * x[1] + x[2], 7, 1e-14, "first equation of the solution");
  close_to(x[0] + x[1], 3, 1e-14, "second equation of the solution");
  close_to(3 * x[0] + x[2], 6, 1e-14, "third equation of the solution");
  close_to(2 * b[4] + b[5], 1, 1e-14, "first equation of the second right-hand side");
  double singular[4] = {1, 2, 2, 4}, c[2] = {1, 1};
  ok(eo_dense_solve(2, singular, pivot, 1, c) != 0, "a singular matrix is noticed");
  double complex m[4] = {1 + I, 2, 3, 4 - I}, d[2] = {1, I};
  eo_dense_complex_solve(2, m, pivot, 1, d);
  close_to(cabs((1 + I) * d[0] + 2 * d[1] - 1), 0, 1e-14, "residual of the first complex equation");
  close_to(cabs(3 * d[0] + (4 - I) * d[1] - I), 0, 1e-14, "residual of the second complex equation");
}

static void products(void)
{
  const double a[6] = {1, 2, 3, 4, 5, 6}, x[3] = {1, 0, -1}, u[2] = {1, 10};
  double y[2], z[3];
  eo_dense_multiply(2, 3, a, x, y);
  ok(y[0] == -2 && y[1] == -2, "a matrix times a vector is right");
  eo_dense_multiply_transposed(2, 3, a, u, z);
  ok(z[0] == 41 && z[1] == 52 && z[2] == 63, "a transposed matrix times a vector is right");
}

static void eigenvalues(void)
{
  double a[4] = {2, 1, 1, 2}, value[2], rotation[4] = {0, -3, 3, 0};
  double complex pole[2];
  ok(!eo_dense_symmetric_eigen(2, a, value), "symmetric eigenvalues are found");
  close_to(value[0], 1, 1e-14, "smaller eigenvalue of the symmetric matrix");
  close_to(value[1], 3, 1e-14, "larger eigenvalue of the symmetric matrix");
  close_to(fabs(a[2] + a[3]), sqrt(2), 1e-14, "ratio of the second row's eigenvector");
  ok(!eo_dense_eigenvalues(2, rotation, pole), "general eigenvalues are found");
  close_to(fabs(cimag(pole[0])), 3, 1e-14, "imaginary part of a rotation's eigenvalue");
}

static void fourier(void)
{
  double sample[16], series[17], basis[17], sum = 0;
  for (int i = 0; i < 16; i++) {
    double a = 2 * M_PI * i / 16;
    sample[i] = 0.5 + 2 * cos(a) - 3 * sin(5 * a) + 0.25 * cos(8 * a);
  }
  eo_fourier_series(16, sample, 8, series);
  close_to(series[0], 0.5, 1e-14, "mean of the Fourier series");
  close_to(series[1], 2, 1e-14, "first cosine of the Fourier series");
  close_to(series[10], -3, 1e-14, "fifth sine of the Fourier series");
  close_to(series[15], 0.25, 1e-14, "Nyquist term of the Fourier series");
  close_to(series[16], 0, 0, "sine of the Nyquist term");
  double phase = 0.3137, a = 2 * M_PI * phase;
  close_to(eo_fourier_value(8, series, phase), 0.5 + 2 * cos(a) - 3 * sin(5 * a) + 0.25 * cos(8 * a), 1e-13,
           "value of the Fourier series between samples");
  eo_fourier_basis(8, phase, basis);
  for (int i = 0; i < 17; i++)
    sum += basis[i] * series[i];
  close_to(sum, eo_fourier_value(8, series, phase), 1e-13, "product of basis and series");
  static double many[3000], two[5];
  for (int i = 0; i < 3000; i++)
    many[i] = sin(2 * M_PI * 2 * i / 3000);
  eo_fourier_series(3000, many, 2, two);
  close_to(two[4], 1, 1e-12, "coefficient of more samples than the table of sines holds");
}

struct spring {
  double damping;
};

static int spring_slope(void *context, double t, const double *y, double *slope)
{
  (void)t;
  slope[0] = y[1];
  slope[1] = -y[0] - ((struct spring *)context)->damping * y[1];
  return 0;
}

static int spring_jacobian(void *context, double t, const double *y, double *jacobian)
{
  (void)t, (void)y;
  jacobian[1] = 1;
  jacobian[2] = -1;
  jacobian[3] = -((struct spring *)context)->damping;
  return 0;
}

static int gives_up(void *context, double t, const double *y, double *slope)
{
  (void)context, (void)y;
  slope[0] = 1;
  return t > 0.5 ? -1 : 0;
}

static void differential_equation(void)
{
  struct eo_ode *ode = NULL;
  struct eo_error error = {0};
  struct spring spring = {0.2};
  const double tolerance[2] = {1e-14, 1e-14}, start[2] = {1, 0}, none[2] = {0, 0};
  double y[2], w = sqrt(1 - 0.01);
  struct eo_ode_problem problem = {spring_slope, spring_jacobian, &spring, 1e-10, tolerance, 0};
  ok(!eo_ode_new(&ode, 2, NULL), "a solver of differential equations is made");
  for (int round = 0; round < 2; round++) {
    problem.jacobian = round ? NULL : spring_jacobian;
    ok(!eo_ode_start(ode, &problem, 0, start, NULL) && !eo_ode_advance(ode, 20, y, NULL),
       "the solver of differential equations runs");
    close_to(y[0], exp(-2) * (cos(20 * w) + 0.1 / w * sin(20 * w)), 1e-9, "damped oscillation against its closed form");
  }
  ok(eo_ode_steps(ode) > 50, "the damped oscillation takes %ld steps", eo_ode_steps(ode));
  problem.absolute_tolerance = none;
  int refused = eo_ode_start(ode, &problem, 0, start, &error) == EO_ERROR_NUMERIC;
  ok(refused, "an equation that cannot be evaluated is refused: %s", error.text);
  eo_ode_free(ode);
  ode = NULL;
  problem = (struct eo_ode_problem){gives_up, NULL, NULL, 1e-6, tolerance, 0};
  eo_ode_new(&ode, 1, NULL);
  eo_ode_start(ode, &problem, 0, start, NULL);
  refused = eo_ode_advance(ode, 1, y, &error) == EO_ERROR_NUMERIC;
  ok(refused, "a time that runs back is refused: %s", error.text);
  eo_ode_free(ode);
  ode = NULL;
  ok(eo_ode_new(&ode, 0, &error) == EO_ERROR_NUMERIC && !ode, "a solver of no unknowns is refused");
  eo_ode_free(NULL);
}

int main(void)
{
  solves();
  products();
  eigenvalues();
  fourier();
  differential_equation();
  return tap_done();
}

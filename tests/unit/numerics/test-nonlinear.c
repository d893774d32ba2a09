/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nonlinear solver on systems whose solutions are known in closed form. */
#include <string.h>

#include "numerics/nonlinear.h"
#include "support/tap.h"

/* Rosenbrock's valley as a system: 10 (y - x^2) = 0, 1 - x = 0; solution (1, 1). */
static int rosenbrock(void *context, const double *x, double *r)
{
  ++*(int *)context;
  r[0] = 10 * (x[1] - x[0] * x[0]);
  r[1] = 1 - x[0];
  return 0;
}

static int rosenbrock_jacobian(void *context, const double *x, double *j)
{
  (void)context;
  j[0] = -20 * x[0];
  j[1] = 10;
  j[2] = -1;
  return 0;
}

/* Powell's badly scaled system: 1e4 x y = 1, exp(-x) + exp(-y) = 1.0001; x 1.0981593e-5, y 9.1061467 (More, Garbow,
   Hillstrom 1981, problem 3). */
static int powell(void *context, const double *x, double *r)
{
  (void)context;
  r[0] = 1e4 * x[0] * x[1] - 1;
  r[1] = exp(-x[0]) + exp(-x[1]) - 1.0001;
  return 0;
}

/* x^2 + 1 = 0 has no real solution. */
static int rootless(void *context, const double *x, double *r)
{
  (void)context;
  r[0] = x[0] * x[0] + 1;
  return 0;
}

/* log x = 1 from far away: Newton's first step leaves the domain and must be shortened. */
static int logarithm(void *context, const double *x, double *r)
{
  (void)context;
  if (x[0] <= 0)
    return 1;
  r[0] = log(x[0]) - 1;
  return 0;
}

static int gives_up(void *context, const double *x, double *r)
{
  (void)context;
  r[0] = x[0];
  return x[0] < 5 ? -1 : 0;
}

static int flat(void *context, const double *x, double *r)
{
  (void)context, (void)x;
  r[0] = 1;
  r[1] = 1;
  return 0;
}

static const struct eo_nonlinear_options usual = {
    .residual_tolerance = 1e-12, .step_tolerance = 1e-14, .max_iterations = 100};

static struct eo_nonlinear_report solve(int n, eo_nonlinear_residual *residual, double *x)
{
  struct eo_nonlinear *w = NULL;
  struct eo_nonlinear_report report = {0};
  struct eo_nonlinear_problem problem = {residual, NULL, NULL};
  int failed = eo_nonlinear_new(&w, n, NULL) || eo_nonlinear_solve(w, &problem, &usual, x, &report, NULL);
  ok(!failed, "workspace and options of %d unknowns are accepted", n);
  eo_nonlinear_free(w);
  return report;
}

static void one_workspace_many_solves(void)
{
  struct eo_nonlinear *w = NULL;
  struct eo_nonlinear_report report;
  int calls = 0;
  struct eo_nonlinear_problem problem = {rosenbrock, rosenbrock_jacobian, &calls};
  eo_nonlinear_new(&w, 2, NULL);
  double x[2] = {-1.2, 1};
  eo_nonlinear_solve(w, &problem, &usual, x, &report, NULL);
  ok(report.outcome == EO_NONLINEAR_CONVERGED && report.iterations > 0, "Rosenbrock converges in %d iterations",
     report.iterations);
  close_to(x[0], 1, 1e-12, "x of Rosenbrock's minimum");
  close_to(x[1], 1, 1e-12, "y of Rosenbrock's minimum");
  ok(report.evaluations == calls, "the %d evaluations of a solution are counted", calls);
  double again[2] = {x[0], x[1]};
  eo_nonlinear_solve(w, &problem, &usual, again, &report, NULL);
  ok(report.outcome == EO_NONLINEAR_CONVERGED && report.iterations == 0, "a guess that is a solution is accepted");
  ok(!memcmp(x, again, sizeof x), "a guess that is a solution comes back unchanged");
  problem.jacobian = NULL;
  double differences[2] = {-1.2, 1};
  eo_nonlinear_solve(w, &problem, &usual, differences, &report, NULL);
  ok(report.outcome == EO_NONLINEAR_CONVERGED, "differences instead of the analytic Jacobian converge as well");
  close_to(differences[1], 1, 1e-9, "y of Rosenbrock's minimum by differences");
  eo_nonlinear_free(w);
}

static void outcomes(void)
{
  double valley[2] = {0, 1};
  struct eo_nonlinear_report report = solve(2, powell, valley);
  ok(report.outcome == EO_NONLINEAR_CONVERGED, "Powell's badly scaled system converges in %d iterations",
     report.iterations);
  near(valley[0], 1.0981593e-5, 1e-7, "x of Powell's solution");
  near(valley[1], 9.1061467, 1e-7, "y of Powell's solution");
  double x = 3;
  report = solve(1, rootless, &x);
  ok(report.outcome == EO_NONLINEAR_STALLED && report.residual >= 1,
     "an equation without a solution is an outcome, residual %g", report.residual);
  x = 20;
  report = solve(1, logarithm, &x);
  ok(report.outcome == EO_NONLINEAR_CONVERGED, "steps out of the logarithm's domain are shortened");
  near(x, exp(1), 1e-11, "root of ln x - 1, e");
  x = 10;
  ok(solve(1, gives_up, &x).outcome == EO_NONLINEAR_FAILED, "a function that gives up fails");
  double two[2] = {1, 2};
  ok(solve(2, flat, two).outcome != EO_NONLINEAR_CONVERGED, "a singular matrix does not converge");
}

static void bad_input(void)
{
  struct eo_nonlinear *w = NULL;
  struct eo_error error = {0};
  int refused = eo_nonlinear_new(&w, 0, &error) == EO_ERROR_NUMERIC && !w;
  ok(refused, "a system of no unknowns is refused: %s", error.text);
  eo_nonlinear_new(&w, 1, NULL);
  struct eo_nonlinear_problem problem = {rootless, NULL, NULL};
  struct eo_nonlinear_options options = usual;
  struct eo_nonlinear_report report;
  double x = 1, scale = 0;
  options.residual_tolerance = 0;
  refused = eo_nonlinear_solve(w, &problem, &options, &x, &report, &error) == EO_ERROR_NUMERIC;
  ok(refused, "a tolerance that cannot be is refused: %s", error.text);
  options = usual;
  options.x_scale = &scale;
  refused = eo_nonlinear_solve(w, &problem, &options, &x, &report, &error) == EO_ERROR_NUMERIC;
  ok(refused, "options that cannot be are refused: %s", error.text);
  eo_nonlinear_free(w);
  eo_nonlinear_free(NULL);
}

int main(void)
{
  one_workspace_many_solves();
  outcomes();
  bad_input();
  return tap_done();
}

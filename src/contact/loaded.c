#include "contact/loaded.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the local law and its inverse ----
   delta = K q (L - ln q). With x = L - ln q and t = L - ln(delta/K): x - ln x = t, x > 1 (q below the law's turning point), q = delta/(K x),
   dq/ddelta = 1/(K (x - 1)). x(t) is one universal function, tabulated with its slope x/(x - 1). */

enum { LAW_NODES = 4096 };
static const double LAW_LOW = 1.02, LAW_HIGH = 84.0;

static double law_root(double t)
{
  double x = t + log(t) + 0.5;
  for (int i = 0; i < 60; i++) {
    double step = (x - log(x) - t) / (1 - 1 / x);
    x = fmax(x - step, 1 + (x - 1) / 8);
    if (fabs(step) < 1e-15 * x)
      break;
  }
  return x;
}

struct eo_loaded_workspace {
  double (*law)[2];                /* [LAW_NODES]: x and step * dx/dt at t = LAW_LOW + i step */
  double law_step;
  int (*assemble)(const struct eo_contact_position *, const double *rate, double *matrix);
  double *load, *rate, *gap;       /* [most_points]: p, dp/dg, scaled gaps */
  double *mode, *trial;            /* [most_rank + 1]: a and Z */
  double *residual, *step, *tangent; /* [most_rank + 1] */
  double *matrix;                  /* [stride + 4][stride + 4] */
};

static double law_inverse(const struct eo_loaded_workspace *ws, double t)
{
  double u = (t - LAW_LOW) / ws->law_step;
  if (!(u >= 0 && u < LAW_NODES - 1))
    return law_root(fmax(t, 1 + 1e-9));
  int i = (int)u;
  double r = u - i, l = 1 - r, difference = ws->law[i + 1][0] - ws->law[i][0];
  double a = ws->law[i][1] - difference, b = difference - ws->law[i + 1][1];
  return ws->law[i][0] * l + ws->law[i + 1][0] * r + r * l * (a * l + b * r);
}

/* ---- matrix of the Newton step: I + sum rate f f', bordered by Z; lower triangle, row-major, leading dimension stride + 4 ---- */

static inline __attribute__((always_inline)) void add_four(int stride, const double *const f[4], const double w[4], double *matrix)
{
  int ld = stride + 4;
  for (int j = 0; j < stride; j++) {
    double t0 = w[0] * f[0][j], t1 = w[1] * f[1][j], t2 = w[2] * f[2][j], t3 = w[3] * f[3][j], *row = matrix + (size_t)j * (size_t)ld;
    int end = (j / 4 + 1) * 4;
    for (int k = 0; k < end; k++)
      row[k] += t0 * f[0][k] + t1 * f[1][k] + t2 * f[2][k] + t3 * f[3][k];
  }
  double *last = matrix + (size_t)stride * (size_t)ld;
  for (int k = 0; k < stride; k++)
    last[k] -= w[0] * f[0][k] + w[1] * f[1][k] + w[2] * f[2][k] + w[3] * f[3][k];
  last[stride] += w[0] + w[1] + w[2] + w[3];
}

static inline __attribute__((always_inline)) int assemble_body(const struct eo_contact_position *p, const double *rate, double *matrix)
{
  int stride = p->stride, ld = stride + 4, filled = 0;
  const double *f[4];
  double w[4];
  memset(matrix, 0, sizeof *matrix * (size_t)ld * (size_t)(stride + 1));
  for (int j = 0; j < stride; j++)
    matrix[(size_t)j * (size_t)(ld + 1)] = 1;
  for (int i = 0; i < p->points; i++) {
    if (rate[i] <= 0)
      continue;
    f[filled] = p->factor + (size_t)i * (size_t)stride;
    w[filled++] = rate[i];
    if (filled == 4) {
      add_four(stride, f, w, matrix);
      filled = 0;
    }
  }
  if (filled) {
    for (int i = filled; i < 4; i++) {
      f[i] = f[0];
      w[i] = 0;
    }
    add_four(stride, f, w, matrix);
  }
  return stride + 1;
}

static int assemble_plain(const struct eo_contact_position *p, const double *rate, double *matrix)
{
  return assemble_body(p, rate, matrix);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) static int assemble_avx2(const struct eo_contact_position *p, const double *rate, double *matrix)
{
  return assemble_body(p, rate, matrix);
}
#endif

/* ---- one position ---- */

/* The problem of one position in units of the unscaled compliance: gaps and approach are divided by the compliance factor. */
struct problem {
  const struct eo_contact_position *position;
  const double *gap; /* [points] */
  double scale;      /* K */
  double force;      /* P */
};

/* Loads and their rates at (a, Z); residual of the rank + 1 equations. */
static void evaluate(struct eo_loaded_workspace *ws, const struct problem *problem, const double *mode)
{
  const struct eo_contact_position *p = problem->position;
  int stride = p->stride;
  double approach = mode[stride], sum = 0;
  memcpy(ws->residual, mode, sizeof *mode * (size_t)stride);
  for (int i = 0; i < p->points; i++) {
    const double *f = p->factor + (size_t)i * (size_t)stride;
    double bend[4] = {0};
    for (int k = 0; k < stride; k += 4)
      for (int l = 0; l < 4; l++)
        bend[l] += f[k + l] * mode[k + l];
    double local = approach - problem->gap[i] - ((bend[0] + bend[1]) + (bend[2] + bend[3]));
    ws->load[i] = ws->rate[i] = 0;
    if (local <= 0)
      continue;
    double scaled = local / problem->scale, x = law_inverse(ws, p->law[i] - log(scaled));
    double load = p->length[i] * scaled / x;
    ws->load[i] = load;
    ws->rate[i] = p->length[i] / (problem->scale * (x - 1));
    sum += load;
    for (int k = 0; k < stride; k++)
      ws->residual[k] -= load * f[k];
  }
  ws->residual[stride] = sum - problem->force;
}

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

static bool factorise(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  ws->assemble(p, ws->rate, ws->matrix);
  return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', p->stride + 1, ws->matrix, p->stride + 4) == 0;
}

static void back_solve(const struct eo_loaded_workspace *ws, const struct eo_contact_position *p, double *vector)
{
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'U', p->stride + 1, 1, ws->matrix, p->stride + 4, vector, p->stride + 1);
}

/* Raises Z until the loads at a = 0 carry P: a start from nowhere, with every point that matters in contact. */
static void start_cold(struct eo_loaded_workspace *ws, const struct problem *problem, double *mode)
{
  int stride = problem->position->stride;
  double lowest = INFINITY, rise = 1e-6;
  for (int i = 0; i < problem->position->points; i++)
    lowest = fmin(lowest, problem->gap[i]);
  memset(mode, 0, sizeof *mode * (size_t)stride);
  for (int i = 0; i < 60; i++, rise *= 1.5) {
    mode[stride] = lowest + rise;
    evaluate(ws, problem, mode);
    if (ws->residual[stride] > 0)
      break;
  }
}

/* Newton on the convex function of (a, Z) from ws->mode. A step that passes the minimum along its own line is cut back.
   Leaves the loads, the factored matrix and (a, Z) of the solution; returns whether it converged. */
static bool newton(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { STEPS = 60, CUTS = 30 };
  const struct eo_contact_position *p = problem->position;
  int n = p->stride + 1;
  evaluate(ws, problem, ws->mode);
  for (int i = 0; i < STEPS; i++) {
    if (!factorise(ws, p)) {
      start_cold(ws, problem, ws->mode);
      if (!factorise(ws, p))
        return false;
    }
    for (int k = 0; k < n; k++)
      ws->step[k] = -ws->residual[k];
    back_solve(ws, p, ws->step);
    double slope = dot(n, ws->residual, ws->step), length = 1, approach_step = ws->step[n - 1];
    bool small = fabs(approach_step) < 2e-11 && fabs(ws->residual[n - 1]) < 1e-5 * problem->force;
    for (int cut = 0; cut < CUTS; cut++) {
      for (int k = 0; k < n; k++)
        ws->trial[k] = ws->mode[k] + length * ws->step[k];
      evaluate(ws, problem, ws->trial);
      double there = dot(n, ws->residual, ws->step);
      if (there <= 0 || there < -0.5 * slope)
        break;
      length *= fmax(0.1, slope / (slope - there));
    }
    memcpy(ws->mode, ws->trial, sizeof *ws->mode * (size_t)n);
    if (small)
      return true;
  }
  return false;
}

/* d(a, Z)/dP and the tangent stiffness from the last factorisation (one Newton step old: its error is of the second order). */
static double tangent_of(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  int n = p->stride + 1;
  memset(ws->tangent, 0, sizeof *ws->tangent * (size_t)n);
  ws->tangent[n - 1] = 1;
  back_solve(ws, p, ws->tangent);
  return 1 / ws->tangent[n - 1];
}

static const struct eo_contact_line *same_line(const struct eo_contact_position *p, const struct eo_contact_line *line)
{
  for (int i = 0; i < p->lines; i++)
    if (p->line[i].pair == line->pair && p->line[i].kind == line->kind && p->line[i].cells == line->cells)
      return &p->line[i];
  return NULL;
}

/* Start from the neighbouring position: the same line loads on the same lines, scaled to carry P. */
static void start_from(struct eo_loaded_workspace *ws, const struct eo_contact_position *from, const double *line_load, double approach,
                       const struct problem *problem)
{
  const struct eo_contact_position *p = problem->position;
  double sum = 0;
  memset(ws->load, 0, sizeof *ws->load * (size_t)p->points);
  for (int l = 0; l < p->lines; l++) {
    const struct eo_contact_line *line = &p->line[l], *old = same_line(from, line);
    for (int i = 0; old && i < line->cells; i++)
      sum += ws->load[line->first + i] = line_load[old->first + i] * p->length[line->first + i];
  }
  memset(ws->mode, 0, sizeof *ws->mode * (size_t)p->stride);
  for (int i = 0; sum > 0 && i < p->points; i++)
    for (int k = 0; ws->load[i] > 0 && k < p->stride; k++)
      ws->mode[k] += ws->load[i] * problem->force / sum * p->factor[(size_t)i * (size_t)p->stride + (size_t)k];
  ws->mode[p->stride] = approach;
  if (sum <= 0)
    start_cold(ws, problem, ws->mode);
}

/* Solves from ws->mode and writes position j of the result. */
static void solve_position(struct eo_loaded_workspace *ws, const struct problem *problem, int j, double factor, struct eo_loaded_end *result)
{
  const struct eo_contact_position *p = problem->position;
  bool converged = newton(ws, problem);
  if (!converged) {
    start_cold(ws, problem, ws->mode);
    converged = newton(ws, problem);
  }
  result->failures += !converged;
  result->load[j] = problem->force;
  result->tangent[j] = tangent_of(ws, p) / factor;
  result->approach[j] = ws->mode[p->stride] * factor;
  for (int i = 0; i < p->points; i++)
    result->line_load[p->first + i] = ws->load[i] / p->length[i];
}

static const double *scaled_gaps(struct eo_loaded_workspace *ws, const struct eo_contact_position *p, const double *gap, double factor)
{
  if (factor == 1)
    return gap + p->first;
  for (int i = 0; i < p->points; i++)
    ws->gap[i] = gap[p->first + i] / factor;
  return ws->gap;
}

void eo_loaded_solve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const struct eo_loaded_gaps *gaps,
                     double compliance_factor, int loads, const double *load, struct eo_loaded_end *result)
{
  for (int l = 0; l < loads; l++)
    result[l].failures = 0;
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    struct problem problem = {p, scaled_gaps(ws, p, gaps->gap, compliance_factor), grid->compliance_scale, load[0]};
    if (j == 0)
      start_cold(ws, &problem, ws->mode);
    else
      start_from(ws, &grid->position[j - 1], result[0].line_load + grid->position[j - 1].first, result[0].approach[j - 1] / compliance_factor,
                 &problem);
    for (int l = 0; l < loads; l++) {
      problem.force = load[l];
      for (int k = 0; l > 0 && k <= p->stride; k++) /* along the tangent from the load before */
        ws->mode[k] += (load[l] - load[l - 1]) * ws->tangent[k];
      solve_position(ws, &problem, j, compliance_factor, &result[l]);
    }
  }
}

/* ---- axially held pinion ---- */

static void resolve_end(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const struct eo_loaded_gaps *gaps, double factor,
                        int j, double force, struct eo_loaded_end *end)
{
  const struct eo_contact_position *p = &grid->position[j];
  struct problem problem = {p, scaled_gaps(ws, p, gaps->gap, factor), grid->compliance_scale, force};
  start_from(ws, p, end->line_load + p->first, end->approach[j] / factor, &problem);
  solve_position(ws, &problem, j, factor, end);
}

void eo_loaded_balance(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const struct eo_loaded_gaps gaps[2],
                       double compliance_factor, double stiffness, int stagger, double load, struct eo_loaded_end result[2])
{
  enum { STEPS = 40 };
  double lean = sin(grid->geometry.base_helix_angle), soft = isinf(stiffness) ? 0 : 4 * lean * lean / stiffness;
  if (stiffness <= 0 || lean == 0)
    return;
  for (int j = 0; j < grid->positions; j++) {
    int other = (j + grid->positions - stagger % grid->positions) % grid->positions;
    double shift = 0; /* P_L = P + shift, P_R = P - shift; equilibrium of the pinion along its axis: Z_L - Z_R + shift 4 sin^2/k = 0 */
    for (int i = 0; i < STEPS; i++) {
      double miss = result[0].approach[j] - result[1].approach[other] + soft * shift;
      double rate = 1 / result[0].tangent[j] + 1 / result[1].tangent[other] + soft;
      double next = fmax(-0.999 * load, fmin(0.999 * load, shift - miss / rate));
      if (fabs(next - shift) < 1e-7 * load)
        break;
      shift = next;
      resolve_end(ws, grid, &gaps[0], compliance_factor, j, load + shift, &result[0]);
      resolve_end(ws, grid, &gaps[1], compliance_factor, other, load - shift, &result[1]);
    }
  }
}

/* ---- storage ---- */

enum eo_code eo_loaded_workspace_new(struct eo_loaded_workspace **result, const struct eo_contact_grid *grid, struct eo_error *error)
{
  struct eo_loaded_workspace *ws = calloc(1, sizeof *ws);
  if (!ws)
    return eo_error_memory(error);
  size_t points = (size_t)grid->most_points, modes = (size_t)grid->most_rank + 8;
  ws->law = malloc(sizeof *ws->law * LAW_NODES);
  ws->load = malloc(sizeof(double) * (3 * points + 5 * modes + modes * modes));
  if (!ws->law || !ws->load) {
    eo_loaded_workspace_free(ws);
    return eo_error_memory(error);
  }
  ws->rate = ws->load + points;
  ws->gap = ws->rate + points;
  ws->mode = ws->gap + points;
  ws->trial = ws->mode + modes;
  ws->residual = ws->trial + modes;
  ws->step = ws->residual + modes;
  ws->tangent = ws->step + modes;
  ws->matrix = ws->tangent + modes;
  ws->law_step = (LAW_HIGH - LAW_LOW) / (LAW_NODES - 1);
  for (int i = 0; i < LAW_NODES; i++) {
    double x = law_root(LAW_LOW + i * ws->law_step);
    ws->law[i][0] = x;
    ws->law[i][1] = ws->law_step * x / (x - 1);
  }
  ws->assemble = assemble_plain;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    ws->assemble = assemble_avx2;
#endif
  *result = ws;
  return EO_OK;
}

void eo_loaded_workspace_free(struct eo_loaded_workspace *ws)
{
  if (!ws)
    return;
  free(ws->law);
  free(ws->load);
  free(ws);
}

enum eo_code eo_loaded_gaps_init(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid, struct eo_error *error)
{
  gaps->gap = calloc((size_t)grid->points, sizeof(double));
  gaps->unloaded = calloc((size_t)grid->positions, sizeof(double));
  if (gaps->gap && gaps->unloaded)
    return EO_OK;
  eo_loaded_gaps_done(gaps);
  return eo_error_memory(error);
}

void eo_loaded_gaps_done(struct eo_loaded_gaps *gaps)
{
  free(gaps->gap);
  free(gaps->unloaded);
  gaps->gap = gaps->unloaded = NULL;
}

void eo_loaded_gaps_set(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid, const struct eo_gap_field *field)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    bool edges = false;
    int hint = 0;
    for (int i = 0; i < p->points; i++)
      gaps->gap[p->first + i] = eo_gap_field_at(field, p->path[i], p->point[i].eta, NULL, NULL, &hint);
    gaps->unloaded[j] = INFINITY;
    for (int l = 0; l < p->lines; l++)
      edges |= p->line[l].kind != EO_POINT_LINE;
    for (int l = 0; l < p->lines; l++) {
      double c = p->phase + p->line[l].pair * grid->geometry.transverse_base_pitch;
      gaps->unloaded[j] = fmin(gaps->unloaded[j], eo_gap_field_line_minimum(field, c, edges, NULL));
    }
  }
}

enum eo_code eo_loaded_end_init(struct eo_loaded_end *end, const struct eo_contact_grid *grid, struct eo_error *error)
{
  size_t n = (size_t)grid->positions;
  *end = (struct eo_loaded_end){.load = calloc(n, sizeof(double)), .approach = calloc(n, sizeof(double)),
    .tangent = calloc(n, sizeof(double)), .line_load = calloc((size_t)grid->points, sizeof(double))};
  if (end->load && end->approach && end->tangent && end->line_load)
    return EO_OK;
  eo_loaded_end_done(end);
  return eo_error_memory(error);
}

void eo_loaded_end_done(struct eo_loaded_end *end)
{
  free(end->load);
  free(end->approach);
  free(end->tangent);
  free(end->line_load);
  *end = (struct eo_loaded_end){0};
}

double eo_loaded_pressure(const struct eo_contact_grid *grid, double line_load, double radius)
{
  /* p = sqrt(q E* / (pi rho)) with 1/E* = 2 (1 - nu^2)/E = pi K */
  return sqrt(line_load / (M_PI * M_PI * grid->compliance_scale * radius));
}

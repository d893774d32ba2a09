#include "contact/loaded-internal.h"

#include <math.h>
#include <string.h>

/* ---- one position ---- */

/* The problem of one position in units of the unscaled compliance: gaps and approach are divided by the compliance
   factor. */
struct problem {
  const struct eo_contact_position *position;
  const double *gap; /* [points] */
  double scale;      /* K */
  double force;      /* P */
};

/* Loads and their rates at (a, Z), with the deflection that a makes in ws->bend; residual of the rank + 1 equations. */
static void load_points(struct eo_loaded_workspace *ws, const struct problem *problem, const double *mode)
{
  const struct eo_contact_position *p = problem->position;
  int stride = p->stride;
  double approach = mode[stride], sum = 0;
  for (int i = 0; i < p->points; i++) {
    double local = ws->local[i] = approach - problem->gap[i] - ws->bend[i] - ws->correction[i], spread = ws->spread[i],
           share = 1;
    ws->load[i] = ws->rate[i] = 0;
    if (local <= -spread)
      continue;
    if (local < spread) {
      share = (local + spread) / (2 * spread);
      local = share * share * spread;
    }
    double scaled = local / problem->scale, t = p->law[i] - log(scaled);
    if (t > EO_LOCAL_INVERSE_LOW) {
      double x = eo_local_inverse_at(&ws->inverse, t);
      ws->load[i] = p->length[i] * scaled / x;
      ws->rate[i] = share * p->length[i] / (problem->scale * (x - 1));
    } else {
      ws->load[i] = p->length[i] * (scaled - exp(p->law[i] - EO_LOCAL_INVERSE_STRAIGHT)) /
                    (EO_LOCAL_INVERSE_STRAIGHT - 1);
      ws->rate[i] = share * p->length[i] / (problem->scale * (EO_LOCAL_INVERSE_STRAIGHT - 1));
    }
    sum += ws->load[i];
  }
  memcpy(ws->residual, mode, sizeof *mode * (size_t)stride);
  ws->gram->gather(p->points, stride, p->factor, ws->load, ws->residual);
  ws->residual[stride] = sum - problem->force;
}

static void bend(struct eo_loaded_workspace *ws, const struct eo_contact_position *p, const double *mode)
{
  ws->gram->apply(p->points, p->stride, p->factor, mode, ws->bend);
}

static void evaluate(struct eo_loaded_workspace *ws, const struct problem *problem, const double *mode)
{
  bend(ws, problem->position, mode);
  load_points(ws, problem, mode);
}

static inline double larger(double a, double b)
{
  return a > b ? a : b;
}

/* Half the change of the local approach over each cell, from its neighbours on the line; returns its largest change. */
static double spread_cells(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  double change = 0;
  for (int l = 0; l < p->lines; l++) {
    int first = p->line[l].first, last = first + p->line[l].cells - 1;
    for (int i = first; i <= last; i++) {
      int a = i > first ? i - 1 : i, b = i < last ? i + 1 : i;
      double half = b - a == 2 ? 0.25 : 0.5, spread = fabs(ws->local[b] - ws->local[a]) * half,
             moved = fabs(spread - ws->spread[i]);
      if (fabs(ws->local[i]) < larger(spread, ws->spread[i]))
        change = larger(change, moved);
      ws->spread[i] = spread;
    }
  }
  return change;
}

/* A first guess: as if the teeth did not bend. */
static void spread_gaps(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  memset(ws->spread, 0, sizeof *ws->spread * (size_t)problem->position->points);
  memcpy(ws->local, problem->gap, sizeof *ws->local * (size_t)problem->position->points);
  if (ws->partial)
    spread_cells(ws, problem->position);
}

/* Deflection of the present loads by the part of the compliance that the modes leave out; returns its largest change.
 */
static double correct(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  double change = 0;
  ws->gram->blend(p->points, p->remainder_stride, p->remainder, ws->load, ws->blend);
  for (int i = 0; i < p->points; i++) {
    change = larger(change, fabs((double)ws->blend[i] - ws->correction[i]));
    ws->correction[i] = (double)ws->blend[i];
  }
  if (ws->partial)
    change = fmax(change, 0.02 * spread_cells(ws, p));
  return change;
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
  ws->gram->assemble(p->points, p->stride, p->factor, ws->rate, ws->packed, ws->matrix);
  return ws->gram->factor(p->stride + 1, p->stride, ws->matrix);
}

/* Raises Z until the loads at a = 0 carry P: a start from nowhere, with every point that matters in contact. */
static void start_cold(struct eo_loaded_workspace *ws, const struct problem *problem, double *mode)
{
  int stride = problem->position->stride;
  double lowest = INFINITY, rise = 1e-6;
  for (int i = 0; i < problem->position->points; i++)
    lowest = fmin(lowest, problem->gap[i]);
  memset(mode, 0, sizeof *mode * (size_t)stride);
  memset(ws->correction, 0, sizeof *ws->correction * (size_t)problem->position->points);
  spread_gaps(ws, problem);
  for (int i = 0; i < 60; i++, rise *= 1.5) {
    mode[stride] = lowest + rise;
    evaluate(ws, problem, mode);
    if (ws->residual[stride] > 0)
      break;
  }
}

/* One step along ws->step from ws->mode; a step that passes the minimum along its own line is cut back, but for steps
   so small (below a nanometre) that rounding would decide. */
static void advance(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { CUTS = 30 };
  static const double SMALL = 1e-13;
  int n = problem->position->stride + 1;
  double slope = dot(n, ws->residual, ws->step), length = 1;
  for (int cut = 0; cut < CUTS; cut++) {
    for (int k = 0; k < n; k++)
      ws->trial[k] = ws->mode[k] + length * ws->step[k];
    evaluate(ws, problem, ws->trial);
    double there = dot(n, ws->residual, ws->step);
    if (there <= 0 || there < -0.5 * slope || fabs(there) < SMALL * problem->force)
      break;
    length *= fmax(0.1, slope / (slope - there));
  }
  memcpy(ws->mode, ws->trial, sizeof *ws->mode * (size_t)n);
}

static void newton_step(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  int n = p->stride + 1;
  for (int k = 0; k < n; k++)
    ws->step[k] = -ws->residual[k];
  ws->gram->solve(n, p->stride, ws->matrix, ws->step);
}

/* The steps that end Newton, with the matrix of the last one: they also take in the correction of the compliance and
   the partial cells, until nothing moves by more than a thousandth of a nanometre and the loads add up to P. The
   deflection by the modes is there already. */
static bool polish(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { STEPS = 32, RENEW = 8 };
  static const double DONE = 1e-12, BALANCE = 5e-10;
  const struct eo_contact_position *p = problem->position;
  bool settled = false;
  for (int i = 0; i < STEPS; i++) {
    double change = correct(ws, p);
    load_points(ws, problem, ws->mode);
    if (i % RENEW == RENEW - 1 && !factorise(ws, p))
      return false;
    newton_step(ws, p);
    settled = change < DONE && fabs(ws->step[p->stride]) < DONE;
    if (settled && fabs(ws->residual[p->stride]) < BALANCE * problem->force)
      return true;
    for (int k = 0; k <= p->stride; k++)
      ws->mode[k] += ws->step[k];
    bend(ws, p, ws->mode);
  }
  load_points(ws, problem, ws->mode);
  return settled;
}

/* Newton on the convex function of (a, Z) from ws->mode. Leaves the loads, the factored matrix and (a, Z) of the
   solution; returns whether it converged. */
static bool newton(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { STEPS = 60 };
  static const double NEAR = 3e-9;
  const struct eo_contact_position *p = problem->position;
  evaluate(ws, problem, ws->mode);
  for (int i = 0; i < STEPS; i++) {
    if (!factorise(ws, p)) {
      start_cold(ws, problem, ws->mode);
      if (!factorise(ws, p))
        return false;
    }
    newton_step(ws, p);
    advance(ws, problem);
    if (fabs(ws->step[p->stride]) < NEAR && fabs(ws->residual[p->stride]) < 1e-3 * problem->force)
      return polish(ws, problem);
    correct(ws, p);
    load_points(ws, problem, ws->mode);
  }
  return false;
}

/* d(a, Z)/dP, unscaled, from the last factorisation: some nanometres of approach from the solution. */
static void follow_load(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  int n = p->stride + 1;
  memset(ws->tangent, 0, sizeof *ws->tangent * (size_t)n);
  ws->tangent[n - 1] = 1;
  ws->gram->solve(n, p->stride, ws->matrix, ws->tangent);
}

/* dZ/dP = the least value of dp'(C + diag(dg/dp))dp over load changes dp that sum to 1. With dp from the last
   factorisation but the rates of the solution it is right to the square of what dp is wrong. Overwrites the loads. */
static double tangent_compliance(struct eo_loaded_workspace *ws, const struct eo_contact_position *p)
{
  double sum = 0, square = 0, *change = ws->load, *mode = ws->trial;
  follow_load(ws, p);
  bend(ws, p, ws->tangent);
  for (int i = 0; i < p->points; i++) {
    double local = ws->tangent[p->stride] - ws->bend[i];
    change[i] = ws->rate[i] * local;
    square += change[i] * local;
    sum += change[i];
  }
  memset(mode, 0, sizeof *mode * (size_t)p->stride);
  ws->gram->gather(p->points, p->stride, p->factor, change, mode);
  ws->gram->blend(p->points, p->remainder_stride, p->remainder, change, ws->blend);
  square += dot(p->stride, mode, mode);
  for (int i = 0; i < p->points; i++)
    square += change[i] * (double)ws->blend[i];
  return square / (sum * sum);
}

static const struct eo_contact_line *same_line(const struct eo_contact_position *p, const struct eo_contact_line *line)
{
  for (int i = 0; i < p->lines; i++)
    if (p->line[i].pair == line->pair && p->line[i].kind == line->kind && p->line[i].cells == line->cells)
      return &p->line[i];
  return NULL;
}

/* Start from the neighbouring position: the same line loads on the same lines, scaled to carry P. */
static void start_from(struct eo_loaded_workspace *ws, const struct eo_contact_position *from, const double *line_load,
                       double approach, const struct problem *problem)
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
    ws->load[i] *= problem->force / sum;
  ws->gram->gather(p->points, p->stride, p->factor, ws->load, ws->mode);
  for (int k = 0; k < p->stride; k++)
    ws->mode[k] = -ws->mode[k];
  ws->mode[p->stride] = approach;
  spread_gaps(ws, problem);
  correct(ws, p);
  if (sum <= 0)
    start_cold(ws, problem, ws->mode);
}

/* The long way when Newton fails: from a load so high that every point touches, down in steps along the tangent. */
static bool descend(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { TRIES = 6, STEPS = 400 };
  int n = problem->position->stride + 1;
  for (int start = 2; start < TRIES; start++) {
    struct problem high = *problem;
    high.force *= pow(10, start);
    start_cold(ws, &high, ws->mode);
    double factor = 2;
    for (int i = 0; i < STEPS && newton(ws, &high); i++) {
      if (high.force == problem->force)
        return true;
      double next = fmax(problem->force, high.force / factor);
      follow_load(ws, problem->position);
      for (int k = 0; k < n; k++)
        ws->mode[k] += (next - high.force) * ws->tangent[k];
      high.force = next;
    }
  }
  return false;
}

/* Solves from ws->mode and writes position j of the result. */
static void solve_position(struct eo_loaded_workspace *ws, const struct problem *problem, int j, double factor,
                           struct eo_loaded_end *result)
{
  const struct eo_contact_position *p = problem->position;
  bool converged = newton(ws, problem) || descend(ws, problem);
  result->failures += !converged;
  result->load[j] = problem->force;
  result->approach[j] = ws->mode[p->stride] * factor;
  for (int i = 0; i < p->points; i++)
    result->line_load[p->first + i] = ws->load[i] / p->length[i];
  result->tangent[j] = 1 / (tangent_compliance(ws, p) * factor);
}

static const double *scaled_gaps(struct eo_loaded_workspace *ws, const struct eo_contact_position *p, const double *gap,
                                 double factor)
{
  if (factor == 1)
    return gap + p->first;
  for (int i = 0; i < p->points; i++)
    ws->gap[i] = gap[p->first + i] / factor;
  return ws->gap;
}

void eo_loaded_solve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid,
                     const struct eo_loaded_gaps *gaps, double compliance_factor, int loads, const double *load,
                     struct eo_loaded_end *result)
{
  for (int l = 0; l < loads; l++)
    result[l].failures = 0;
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    struct problem problem = {p, scaled_gaps(ws, p, gaps->gap, compliance_factor), grid->compliance_scale, load[0]};
    if (j == 0)
      start_cold(ws, &problem, ws->mode);
    else
      start_from(ws, &grid->position[j - 1], result[0].line_load + grid->position[j - 1].first,
                 result[0].approach[j - 1] / compliance_factor, &problem);
    bool sound = true;
    for (int l = 0; l < loads; l++) {
      int failures = result[l].failures;
      problem.force = load[l];
      for (int k = 0; l > 0 && sound && k <= p->stride; k++) /* along the tangent from the load before */
        ws->mode[k] += (load[l] - load[l - 1]) * ws->tangent[k];
      if (!sound)
        start_cold(ws, &problem, ws->mode);
      solve_position(ws, &problem, j, compliance_factor, &result[l]);
      sound = result[l].failures == failures;
    }
  }
}

/* ---- one position again ---- */

void eo_loaded_resolve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const double *gap,
                       double factor, int j, double load, struct eo_loaded_end *result)
{
  const struct eo_contact_position *p = &grid->position[j];
  struct problem problem = {p, scaled_gaps(ws, p, gap, factor), grid->compliance_scale, load};
  start_from(ws, p, result->line_load + p->first, result->approach[j] / factor, &problem);
  solve_position(ws, &problem, j, factor, result);
}

double eo_loaded_response(struct eo_loaded_workspace *ws, const struct eo_contact_position *p, double factor,
                          const double *change, double *load_change)
{
  int stride = p->stride;
  double *mode = change ? ws->step : ws->tangent;
  if (change) {
    memset(mode, 0, sizeof *mode * (size_t)(stride + EO_GRAM_LANE));
    for (int i = 0; i < p->points; i++) {
      ws->load[i] = ws->rate[i] * change[i] / factor;
      mode[stride] += ws->load[i];
    }
    ws->gram->gather(p->points, stride, p->factor, ws->load, mode);
    ws->gram->solve(stride + 1, stride, ws->matrix, mode);
  }
  bend(ws, p, mode);
  for (int i = 0; i < p->points; i++)
    load_change[i] = ws->rate[i] * (mode[stride] - ws->bend[i] - (change ? change[i] / factor : 0));
  return mode[stride] * factor;
}

/* ---- axially held pinion ---- */

/* Position j of an end that carries nothing. */
static void release_end(const struct eo_contact_grid *grid, int j, double approach, struct eo_loaded_end *end)
{
  const struct eo_contact_position *p = &grid->position[j];
  end->load[j] = end->tangent[j] = 0;
  end->approach[j] = approach;
  memset(end->line_load + p->first, 0, sizeof *end->line_load * (size_t)p->points);
}

static double least_gap(const struct eo_contact_grid *grid, const struct eo_loaded_gaps *gaps, int j)
{
  const struct eo_contact_position *p = &grid->position[j];
  double least = INFINITY;
  for (int i = 0; i < p->points; i++)
    least = fmin(least, gaps->gap[p->first + i]);
  return least;
}

/* One mesh position of both ends: P_L = P + shift, P_R = P - shift. Equilibrium of the pinion along its axis,
   Z_L - Z_R + shift 4 sin^2(beta_b)/k = 0, grows with the shift: Newton, kept between the shifts already known to be
   too small and too large. When even the whole load does not bring the other end into contact, that end carries
   nothing. */
static bool balance_position(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid,
                             const struct eo_loaded_gaps gaps[2], double factor, double soft, const int at[2],
                             double load, struct eo_loaded_end result[2])
{
  enum { STEPS = 60 };
  double shift = 0, bound[2] = {-load, load};
  bool tried[2] = {false, false};
  for (int i = 0; i < STEPS; i++) {
    double miss = result[0].approach[at[0]] - result[1].approach[at[1]] + soft * shift;
    double rate = 1 / result[0].tangent[at[0]] + 1 / result[1].tangent[at[1]] + soft, next = shift - miss / rate;
    int up = miss < 0, heavy = up ? EO_LEFT : EO_RIGHT, light = 1 - heavy;
    bound[1 - up] = shift;
    if (fabs(next - shift) < 1e-9 * load)
      return true;
    if (!(next > bound[0] && next < bound[1])) {
      if (fabs(bound[up]) == load && !tried[up]) {
        tried[up] = true;
        eo_loaded_resolve(ws, grid, gaps[heavy].gap, factor, at[heavy], 2 * load, &result[heavy]);
        double approach = result[heavy].approach[at[heavy]] + soft * load;
        if (approach <= least_gap(grid, &gaps[light], at[light])) {
          release_end(grid, at[light], approach, &result[light]);
          return true;
        }
      }
      next = (shift + bound[up]) / 2;
    }
    shift = next;
    eo_loaded_resolve(ws, grid, gaps[EO_LEFT].gap, factor, at[EO_LEFT], load + shift, &result[EO_LEFT]);
    eo_loaded_resolve(ws, grid, gaps[EO_RIGHT].gap, factor, at[EO_RIGHT], load - shift, &result[EO_RIGHT]);
  }
  return false;
}

void eo_loaded_balance(struct eo_loaded_workspace *workspace, const struct eo_contact_grid *grid,
                       const struct eo_loaded_gaps gaps[2], double compliance_factor, double stiffness, int stagger,
                       double load, struct eo_loaded_end result[2])
{
  double lean = sin(grid->geometry.base_helix_angle), soft = isinf(stiffness) ? 0 : 4 * lean * lean / stiffness;
  if (stiffness <= 0 || lean == 0)
    return;
  for (int j = 0; j < grid->positions; j++) {
    int at[2] = {j, (j + grid->positions - stagger % grid->positions) % grid->positions};
    result[EO_LEFT].failures += !balance_position(workspace, grid, gaps, compliance_factor, soft, at, load, result);
  }
}

/* ---- gaps and pressure ---- */

void eo_loaded_first_contact(const struct eo_contact_grid *grid, const struct eo_gap_field *field, double *unloaded)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    bool edges = false;
    unloaded[j] = INFINITY;
    for (int l = 0; l < p->lines; l++)
      edges |= p->line[l].kind != EO_POINT_LINE;
    for (int l = 0; l < p->lines; l++) {
      bool seen = false;
      for (int m = 0; m < l; m++)
        seen |= p->line[m].pair == p->line[l].pair;
      double c = p->phase + p->line[l].pair * grid->geometry.transverse_base_pitch;
      if (!seen)
        unloaded[j] = fmin(unloaded[j], eo_gap_field_line_minimum(field, c, edges, NULL));
    }
  }
}

void eo_loaded_gaps_set(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                        const struct eo_gap_field *field)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    for (int i = 0; i < p->points; i++)
      gaps->gap[p->first + i] = eo_gap_field_at(field, p->path[i], p->point[i].eta, NULL, NULL);
  }
  eo_loaded_first_contact(grid, field, gaps->unloaded);
}

double eo_loaded_pressure(const struct eo_contact_grid *grid, double line_load, double radius)
{
  /* p = sqrt(q E* / (pi rho)) with 1/E* = 2 (1 - nu^2)/E = pi K */
  return sqrt(line_load / (M_PI * M_PI * grid->compliance_scale * radius));
}

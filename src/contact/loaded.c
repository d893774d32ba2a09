/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/loaded_private.h"

#include <math.h>
#include <string.h>

/* The problem of one position in units of the unscaled compliance: gaps and approach are divided by the compliance
   factor. */
struct problem {
  const struct eo_contact_position *position;
  const double *gap; /* [points] */
  double force;      /* P */
};

/* Loads and their rates at (a, Z), with the deflection that a makes in ws->bend; residual of the rank + 1 equations. */
static void load_points(struct eo_loaded_workspace *ws, const struct problem *problem, const double *mode)
{
  const struct eo_contact_position *position = problem->position;
  double approach = mode[position->rank], sum = 0;
  for (int i = 0; i < position->points; i++) {
    /* theory (C1) */
    double local = ws->local[i] = approach - problem->gap[i] - ws->bend[i] - ws->correction[i], spread = ws->spread[i],
           share = 1;
    ws->load[i] = ws->rate[i] = 0;
    if (local <= -spread)
      continue;
    if (local < spread) {
      share = (local + spread) / (2 * spread); /* theory (C5) */
      local = share * share * spread;
    }
    double slope, carried = eo_local_inverse_at(&ws->inverse, local * position->per_depth[i], &slope);
    ws->load[i] = position->strength[i] * carried;
    ws->rate[i] = share * slope * position->strength[i] * position->per_depth[i];
    sum += ws->load[i];
  }
  memcpy(ws->residual, mode, sizeof *mode * (size_t)position->rank);
  ws->gram->gather(position->points, position->rank, position->stride, position->factor, ws->load, ws->residual);
  ws->residual[position->rank] = sum - problem->force;
}

static void bend(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, const double *mode)
{
  ws->gram->apply(position->points, position->rank, position->stride, position->factor, mode, ws->bend);
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

/* Notes half the change of the local approach over a cell; returns how much that is news, for cells that the end of the
   contact may lie in. */
static inline double spread_cell(struct eo_loaded_workspace *ws, int i, double spread)
{
  double before = ws->spread[i], moved = fabs(spread - before);
  ws->spread[i] = spread;
  return fabs(ws->local[i]) < larger(spread, before) ? moved : 0;
}

/* Half the change of the local approach over each cell, from its neighbours on the line; returns its largest change. */
static double spread_cells(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double change = 0;
  for (int l = 0; l < position->lines; l++) {
    int first = position->line[l].first, last = first + position->line[l].cells - 1;
    const double *local = ws->local;
    if (first == last) {
      change = larger(change, spread_cell(ws, first, 0));
      continue;
    }
    change = larger(change, spread_cell(ws, first, 0.5 * fabs(local[first + 1] - local[first])));
    for (int i = first + 1; i < last; i++)
      change = larger(change, spread_cell(ws, i, 0.25 * fabs(local[i + 1] - local[i - 1])));
    change = larger(change, spread_cell(ws, last, 0.5 * fabs(local[last] - local[last - 1])));
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
static double blend(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double change = 0;
  ws->gram->blend(position->points, position->remainder_stride, position->remainder, ws->load, ws->blend);
  for (int i = 0; i < position->points; i++) {
    change = larger(change, fabs((double)ws->blend[i] - ws->correction[i]));
    ws->correction[i] = (double)ws->blend[i];
  }
  return change;
}

/* The same, and how far cells reach into contact. */
static double correct(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double change = blend(ws, position);
  if (ws->partial)
    change = fmax(change, 0.02 * spread_cells(ws, position));
  return change;
}

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

static bool factorise(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  ws->gram->assemble(position->points, position->rank, position->stride, position->factor, ws->rate, ws->packed,
                     ws->matrix);
  return ws->gram->invert(position->rank + 1, ws->matrix);
}

/* Raises Z until the loads at a = 0 carry P: a start from nowhere, with every point that matters in contact. */
static void start_cold(struct eo_loaded_workspace *ws, const struct problem *problem, double *mode)
{
  int rank = problem->position->rank;
  double lowest = INFINITY, rise = 1e-6;
  for (int i = 0; i < problem->position->points; i++)
    lowest = fmin(lowest, problem->gap[i]);
  memset(mode, 0, sizeof *mode * (size_t)rank);
  memset(ws->correction, 0, sizeof *ws->correction * (size_t)problem->position->points);
  spread_gaps(ws, problem);
  for (int i = 0; i < 60; i++, rise *= 1.5) {
    mode[rank] = lowest + rise;
    evaluate(ws, problem, mode);
    if (ws->residual[rank] > 0)
      break;
  }
}

/* One step along ws->step from ws->mode; a step that passes the minimum along its own line is cut back, but for steps
   so small (below a nanometre) that rounding would decide. */
static void advance(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { CUTS = 30 };
  static const double SMALL = 1e-13;
  int n = problem->position->rank + 1;
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

static void newton_step(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  ws->gram->solve(position->rank + 1, ws->matrix, ws->residual, ws->step);
  for (int k = 0; k <= position->rank; k++)
    ws->step[k] = -ws->step[k];
}

static void take_step(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  for (int k = 0; k <= position->rank; k++)
    ws->mode[k] += ws->step[k];
  bend(ws, position, ws->mode);
}

/* How far a step goes, m: sqrt(r'H^-1 r dZ/dP), the approach that stores as much energy; at least that of the step. */
static double step_length(const struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double energy = -dot(position->rank + 1, ws->step, ws->residual),
         compliance = -(double)ws->matrix[position->rank * (eo_gram_width(position->rank) + 1)];
  return sqrt(larger(0, energy) * compliance);
}

/* Makes loads that all but carry P carry it. */
static void balance(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  const struct eo_contact_position *position = problem->position;
  double factor = problem->force / (problem->force + ws->residual[position->rank]);
  for (int i = 0; i < position->points; i++)
    ws->load[i] *= factor;
}

/* The steps that end Newton, with the matrix of the last one: they also take in the correction of the compliance and
   the partial cells, until all that is still to come, moved / (1 - moved / before) of a geometric series, is less than
   a thousandth of a nanometre and the loads add up to P but for what such a movement makes of them. Correction and
   cells follow one step behind and take up a tenth of it or less (LAG); before: the length of the step that led here,
   whose deflection by the modes is there already. */
static bool polish(struct eo_loaded_workspace *ws, const struct problem *problem, double before)
{
  enum { STEPS = 32, RENEW = 8 };
  static const double DONE = 1e-12, BALANCED = 2e-8, LAG = 0.1;
  const struct eo_contact_position *position = problem->position;
  bool settled = false;
  for (int i = 0; i < STEPS; i++) {
    double change = correct(ws, position);
    load_points(ws, problem, ws->mode);
    if (i % RENEW == RENEW - 1 && !factorise(ws, position))
      return false;
    newton_step(ws, position);
    double moved = larger(change, step_length(ws, position));
    settled = LAG * before < DONE && moved < before && moved * before < DONE * (before - moved);
    before = moved;
    if (settled && fabs(ws->residual[position->rank]) < BALANCED * problem->force) {
      balance(ws, problem);
      return true;
    }
    take_step(ws, position);
  }
  load_points(ws, problem, ws->mode);
  return settled;
}

/* Newton on the convex function of (a, Z) from ws->mode, with its deflection in ws->bend. Leaves the loads, the inverse
   of the last matrix and (a, Z) of the solution; returns whether it converged. From a step that is short enough on, the
   matrix stays as it is. */
static bool newton(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { STEPS = 60 };
  static const double NEAR = 3e-8, HALFWAY = 0.1; /* m, of P: a matrix from so near halves an error or better */
  const struct eo_contact_position *position = problem->position;
  load_points(ws, problem, ws->mode);
  for (int i = 0; i < STEPS; i++) {
    if (!factorise(ws, position)) {
      start_cold(ws, problem, ws->mode);
      if (!factorise(ws, position))
        return false;
    }
    newton_step(ws, position);
    if (fabs(ws->step[position->rank]) < NEAR && fabs(ws->residual[position->rank]) < HALFWAY * problem->force) {
      double length = step_length(ws, position);
      take_step(ws, position);
      if (polish(ws, problem, length))
        return true;
    } else {
      advance(ws, problem);
    }
    correct(ws, position);
    load_points(ws, problem, ws->mode);
  }
  return false;
}

/* d(a, Z)/dP, unscaled, from the last factorisation: some nanometres of approach from the solution. */
static void follow_load(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  memset(ws->trial, 0, sizeof *ws->trial * (size_t)position->rank);
  ws->trial[position->rank] = 1;
  ws->gram->solve(position->rank + 1, ws->matrix, ws->trial, ws->tangent);
}

/* Load changes dp = W (dZ - F da - rest) of the last tangent, whose F da is in ws->bend, into ws->load; returns their
   sum. */
static double change_loads(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double sum = 0;
  for (int i = 0; i < position->points; i++)
    sum += ws->load[i] = ws->rate[i] * (ws->tangent[position->rank] - ws->bend[i] - ws->correction[i]);
  return sum;
}

/* One step towards the tangent at the rates of the solution, with the last matrix, from what its equations leave over:
   da - F'dp and sum dp - 1. */
static void correct_tangent(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double sum = change_loads(ws, position);
  memcpy(ws->residual, ws->tangent, sizeof *ws->residual * (size_t)position->rank);
  ws->gram->gather(position->points, position->rank, position->stride, position->factor, ws->load, ws->residual);
  ws->residual[position->rank] = sum - 1;
  newton_step(ws, position);
  for (int k = 0; k <= position->rank; k++)
    ws->tangent[k] += ws->step[k];
  bend(ws, position, ws->tangent);
}

/* dZ/dP = the least value of dp'(C + diag(dg/dp))dp over load changes dp that sum to 1, and so right to the square of
   what dp is wrong. dp: from the last matrix, then corrected once for the rates of the solution and for what the modes
   leave of the compliance. Overwrites the loads and the correction. */
static double tangent_compliance(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double square = 0, *mode = ws->trial;
  follow_load(ws, position);
  bend(ws, position, ws->tangent);
  memset(ws->correction, 0, sizeof *ws->correction * (size_t)position->points);
  change_loads(ws, position);
  blend(ws, position);
  correct_tangent(ws, position);
  double sum = change_loads(ws, position);
  for (int i = 0; i < position->points; i++)
    square += ws->load[i] * (ws->tangent[position->rank] - ws->bend[i] - ws->correction[i]);
  memset(mode, 0, sizeof *mode * (size_t)position->rank);
  ws->gram->gather(position->points, position->rank, position->stride, position->factor, ws->load, mode);
  blend(ws, position);
  square += dot(position->rank, mode, mode);
  for (int i = 0; i < position->points; i++)
    square += ws->load[i] * ws->correction[i];
  return square / (sum * sum); /* theory (C4) */
}

static const struct eo_contact_line *same_line(const struct eo_contact_position *position,
                                               const struct eo_contact_line *line)
{
  for (int i = 0; i < position->lines; i++)
    if (position->line[i].pair == line->pair && position->line[i].kind == line->kind &&
        position->line[i].cells == line->cells)
      return &position->line[i];
  return NULL;
}

/* Start from the line loads that ws->load holds, scaled to carry P, and an approach. */
static void start_from(struct eo_loaded_workspace *ws, double approach, const struct problem *problem)
{
  const struct eo_contact_position *position = problem->position;
  double sum = 0;
  for (int i = 0; i < position->points; i++)
    sum += ws->load[i];
  if (!(sum > 0) || !isfinite(sum) || !isfinite(approach)) {
    start_cold(ws, problem, ws->mode);
    return;
  }
  for (int i = 0; i < position->points; i++)
    ws->load[i] *= problem->force / sum;
  memset(ws->mode, 0, sizeof *ws->mode * (size_t)position->rank);
  ws->gram->gather(position->points, position->rank, position->stride, position->factor, ws->load, ws->mode);
  for (int k = 0; k < position->rank; k++)
    ws->mode[k] = -ws->mode[k];
  ws->mode[position->rank] = approach;
  bend(ws, position, ws->mode);
  blend(ws, position);
  memset(ws->spread, 0, sizeof *ws->spread * (size_t)position->points);
  for (int i = 0; i < position->points; i++)
    ws->local[i] = approach - problem->gap[i] - ws->bend[i] - ws->correction[i];
  if (ws->partial)
    spread_cells(ws, position);
}

/* What a line carries at a position, known->line_load or zero where it is not there. */
static const double *carried_by(const struct eo_contact_position *position, const struct eo_contact_line *line,
                                const struct eo_loaded_end *known)
{
  const struct eo_contact_line *same = same_line(position, line);
  return same ? known->line_load + position->first + same->first : NULL;
}

/* Start from up to three positions before: what their lines carry goes on as it did, q = 3 q1 - 3 q2 + q3. */
static void start_from_before(struct eo_loaded_workspace *ws, int j, const struct eo_loaded_end *known, double factor,
                              const struct problem *problem)
{
  const struct eo_contact_position *position = problem->position;
  const double *z = known->approach + j - 1;
  double approach = j > 2 ? 3 * z[0] - 3 * z[-1] + z[-2] : j > 1 ? 2 * z[0] - z[-1] : z[0];
  memset(ws->load, 0, sizeof *ws->load * (size_t)position->points);
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    const double *q[3];
    for (int back = 0; back < 3; back++)
      q[back] = back < j ? carried_by(position - 1 - back, line, known) : NULL;
    double *load = ws->load + line->first;
    for (int i = 0; q[0] && i < line->cells; i++) {
      double next = q[1] && q[2] ? 3 * (q[0][i] - q[1][i]) + q[2][i] : q[1] ? 2 * q[0][i] - q[1][i] : q[0][i];
      load[i] = larger(0, next) * position->length[line->first + i];
    }
  }
  start_from(ws, approach / factor, problem);
}

/* The long way when Newton fails: from a load so high that every point touches, down in steps along the tangent. */
static bool descend(struct eo_loaded_workspace *ws, const struct problem *problem)
{
  enum { TRIES = 6, STEPS = 400 };
  int n = problem->position->rank + 1;
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
      bend(ws, problem->position, ws->mode);
      high.force = next;
    }
  }
  return false;
}

/* Solves from ws->mode and writes position j of the result. */
static void solve_position(struct eo_loaded_workspace *ws, const struct problem *problem, int j, double factor,
                           struct eo_loaded_end *result)
{
  const struct eo_contact_position *position = problem->position;
  bool converged = newton(ws, problem) || descend(ws, problem);
  result->failures += !converged;
  result->load[j] = problem->force;
  result->approach[j] = ws->mode[position->rank] * factor;
  for (int i = 0; i < position->points; i++)
    result->line_load[position->first + i] = ws->load[i] / position->length[i];
  result->tangent[j] = 1 / (tangent_compliance(ws, position) * factor);
}

static const double *scaled_gaps(struct eo_loaded_workspace *ws, const struct eo_contact_position *position,
                                 const double *gap, double factor)
{
  if (factor == 1)
    return gap + position->first;
  for (int i = 0; i < position->points; i++)
    ws->gap[i] = gap[position->first + i] / factor;
  return ws->gap;
}

void eo_loaded_solve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid,
                     const struct eo_loaded_gaps *gaps, double compliance_factor, int loads, const double *load,
                     struct eo_loaded_end *result)
{
  for (int l = 0; l < loads; l++)
    result[l].failures = 0;
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    struct problem problem = {position, scaled_gaps(ws, position, gaps->gap, compliance_factor), load[0]};
    for (int l = 0; l < loads; l++) {
      problem.force = load[l];
      if (j == 0)
        start_cold(ws, &problem, ws->mode);
      else
        start_from_before(ws, j, &result[l], compliance_factor, &problem);
      solve_position(ws, &problem, j, compliance_factor, &result[l]);
    }
  }
}

void eo_loaded_resolve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const double *gap,
                       double factor, int j, double load, struct eo_loaded_end *result)
{
  const struct eo_contact_position *position = &grid->position[j];
  struct problem problem = {position, scaled_gaps(ws, position, gap, factor), load};
  for (int i = 0; i < position->points; i++)
    ws->load[i] = result->line_load[position->first + i] * position->length[i];
  start_from(ws, result->approach[j] / factor, &problem);
  solve_position(ws, &problem, j, factor, result);
}

void eo_loaded_prepare_response(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  if (!factorise(ws, position))
    memset(ws->matrix, 0, sizeof *ws->matrix * (size_t)(position->rank + 1) * (size_t)eo_gram_width(position->rank));
  follow_load(ws, position);
}

double eo_loaded_response(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, double factor,
                          const double *change, double *load_change)
{
  int rank = position->rank;
  double *mode = change ? ws->step : ws->tangent, *load = ws->trial;
  if (change) {
    memset(load, 0, sizeof *load * (size_t)(rank + 1));
    for (int i = 0; i < position->points; i++) {
      ws->load[i] = ws->rate[i] * change[i] / factor;
      load[rank] += ws->load[i];
    }
    ws->gram->gather(position->points, rank, position->stride, position->factor, ws->load, load);
    ws->gram->solve(rank + 1, ws->matrix, load, mode);
  }
  bend(ws, position, mode);
  for (int i = 0; i < position->points; i++)
    load_change[i] = ws->rate[i] * (mode[rank] - ws->bend[i] - (change ? change[i] / factor : 0));
  return mode[rank] * factor;
}

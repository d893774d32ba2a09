/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/loaded_private.h"

#include <math.h>
#include <string.h>

void eo_loaded_carry(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, const double *mode,
                     double force)
{
  const struct eo_line_law law = {(const double(*)[2])ws->inverse.node, position->per_depth, position->strength};
  double sum = ws->gram->carry(position->points, &law, ws->local, ws->spread, ws->load, ws->rate);
  memcpy(ws->residual, mode, sizeof *mode * (size_t)position->rank);
  ws->gram->gather(position->points, position->rank, position->stride, position->factor, ws->load, ws->residual);
  ws->residual[position->rank] = sum - force;
}

/* Loads and their rates at (a, Z), with the deflection that a makes in ws->bend; residual of the rank + 1 equations. */
static void load_points(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, const double *mode)
{
  const struct eo_contact_position *position = problem->position;
  double approach = mode[position->rank];
  for (int i = 0; i < position->points; i++) /* theory (C1) */
    ws->local[i] = approach - problem->gap[i] - ws->bend[i] - ws->correction[i];
  eo_loaded_carry(ws, position, mode, problem->force);
}

void eo_loaded_bend(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, const double *mode)
{
  ws->gram->apply(position->points, position->rank, position->stride, position->factor, mode, ws->bend);
}

static void evaluate(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, const double *mode)
{
  eo_loaded_bend(ws, problem->position, mode);
  load_points(ws, problem, mode);
}

/* Notes half the change of the local approach over a cell; returns how much that is news, for cells that the end of the
   contact may lie in. */
static inline double spread_cell(struct eo_loaded_workspace *ws, int i, double spread)
{
  double before = ws->spread[i], moved = fabs(spread - before);
  ws->spread[i] = spread;
  return fabs(ws->local[i]) < eo_loaded_larger(spread, before) ? moved : 0;
}

/* Half the change of the local approach over each cell, from its neighbours on the line; returns its largest change. */
double eo_loaded_spread_cells(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double change = 0;
  for (int l = 0; l < position->lines; l++) {
    int first = position->line[l].first, last = first + position->line[l].cells - 1;
    const double *local = ws->local;
    if (first == last) {
      change = eo_loaded_larger(change, spread_cell(ws, first, 0));
      continue;
    }
    change = eo_loaded_larger(change, spread_cell(ws, first, 0.5 * fabs(local[first + 1] - local[first])));
    for (int i = first + 1; i < last; i++)
      change = eo_loaded_larger(change, spread_cell(ws, i, 0.25 * fabs(local[i + 1] - local[i - 1])));
    change = eo_loaded_larger(change, spread_cell(ws, last, 0.5 * fabs(local[last] - local[last - 1])));
  }
  return change;
}

/* A first guess: as if the teeth did not bend. */
static void spread_gaps(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem)
{
  memset(ws->spread, 0, sizeof *ws->spread * (size_t)problem->position->points);
  memcpy(ws->local, problem->gap, sizeof *ws->local * (size_t)problem->position->points);
  if (ws->partial)
    eo_loaded_spread_cells(ws, problem->position);
}

/* Deflection of the present loads by the part of the compliance that the modes leave out; returns its largest change.
 */
double eo_loaded_blend(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double change = 0;
  ws->gram->blend(position->points, position->remainder_stride, position->remainder, ws->load, ws->blend);
  for (int i = 0; i < position->points; i++) {
    change = eo_loaded_larger(change, fabs((double)ws->blend[i] - ws->correction[i]));
    ws->correction[i] = (double)ws->blend[i];
  }
  return change;
}

/* The same, and how far cells reach into contact: a change of that moves the loads of those at the edge of contact
   alone, and counts a fiftieth of a deflection. */
static double correct(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  static const double OF_SPREAD = 0.02;
  double change = eo_loaded_blend(ws, position);
  if (ws->partial)
    change = fmax(change, OF_SPREAD * eo_loaded_spread_cells(ws, position));
  return change;
}

bool eo_loaded_factorise(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  ws->gram->assemble(position->points, position->rank, position->stride, position->factor, ws->rate, ws->packed,
                     ws->matrix);
  return ws->gram->invert(position->rank + 1, ws->matrix);
}

/* Raises Z until the loads at a = 0 carry P: a start from nowhere, with every point that matters in contact. */
static void start_cold(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, double *mode)
{
  enum { RISES = 60 };
  static const double FIRST = 1e-6, FACTOR = 1.5; /* m, from one rise to the next */
  int rank = problem->position->rank;
  double lowest = INFINITY, rise = FIRST;
  for (int i = 0; i < problem->position->points; i++)
    lowest = fmin(lowest, problem->gap[i]);
  memset(mode, 0, sizeof *mode * (size_t)rank);
  memset(ws->correction, 0, sizeof *ws->correction * (size_t)problem->position->points);
  spread_gaps(ws, problem);
  for (int i = 0; i < RISES; i++, rise *= FACTOR) {
    mode[rank] = lowest + rise;
    evaluate(ws, problem, mode);
    if (ws->residual[rank] > 0)
      break;
  }
}

/* One step along ws->step from ws->mode; a step that passes the minimum along its own line is cut back, but for steps
   so small (below a nanometre) that rounding would decide. */
static void advance(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem)
{
  enum { CUTS = 30 };
  static const double SMALL = 1e-13;  /* of the load: rounding */
  static const double PASSED = 0.5;   /* of the slope at the start: as far beyond the minimum a step may end */
  static const double SHORTEST = 0.1; /* of a step: the secant of a slope that jumps may ask for next to nothing */
  int n = problem->position->rank + 1;
  double slope = eo_dot(n, ws->residual, ws->step), length = 1;
  for (int cut = 0; cut < CUTS; cut++) {
    for (int k = 0; k < n; k++)
      ws->trial[k] = ws->mode[k] + length * ws->step[k];
    evaluate(ws, problem, ws->trial);
    double there = eo_dot(n, ws->residual, ws->step);
    if (there <= 0 || there < -PASSED * slope || fabs(there) < SMALL * problem->force)
      break;
    length *= fmax(SHORTEST, slope / (slope - there));
  }
  memcpy(ws->mode, ws->trial, sizeof *ws->mode * (size_t)n);
}

void eo_loaded_newton_step(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  ws->gram->solve(position->rank + 1, ws->matrix, ws->residual, ws->step);
  for (int k = 0; k <= position->rank; k++)
    ws->step[k] = -ws->step[k];
}

static void take_step(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  for (int k = 0; k <= position->rank; k++)
    ws->mode[k] += ws->step[k];
  eo_loaded_bend(ws, position, ws->mode);
}

/* How far a step goes, m: sqrt(r'H^-1 r dZ/dP), the approach that stores as much energy; at least that of the step. */
double eo_loaded_step_length(const struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double energy = -eo_dot(position->rank + 1, ws->step, ws->residual),
         compliance = -(double)ws->matrix[position->rank * (eo_gram_width(position->rank) + 1)];
  return sqrt(eo_loaded_larger(0, energy) * compliance);
}

/* Makes loads that all but carry P carry it. */
static void balance(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem)
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
static bool polish(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, double before)
{
  enum { STEPS = 32, RENEW = 8 };
  static const double BALANCED = 2e4 /* 1/m */, LAG = 0.1;
  const double done = problem->within;
  const struct eo_contact_position *position = problem->position;
  bool settled = false;
  for (int i = 0; i < STEPS; i++) {
    double change = correct(ws, position);
    load_points(ws, problem, ws->mode);
    if (i % RENEW == RENEW - 1 && !eo_loaded_factorise(ws, position))
      return false;
    eo_loaded_newton_step(ws, position);
    double moved = eo_loaded_larger(change, eo_loaded_step_length(ws, position));
    settled = LAG * before < done && moved < before && moved * before < done * (before - moved);
    before = moved;
    if (settled && fabs(ws->residual[position->rank]) < BALANCED * done * problem->force) {
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
bool eo_loaded_newton(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem)
{
  enum { STEPS = 60 };
  static const double NEAR = 3e-8, HALFWAY = 0.1; /* m, of P: a matrix from so near halves an error or better */
  const struct eo_contact_position *position = problem->position;
  load_points(ws, problem, ws->mode);
  for (int i = 0; i < STEPS; i++) {
    if (!eo_loaded_factorise(ws, position)) {
      start_cold(ws, problem, ws->mode);
      if (!eo_loaded_factorise(ws, position))
        return false;
    }
    eo_loaded_newton_step(ws, position);
    if (fabs(ws->step[position->rank]) < NEAR && fabs(ws->residual[position->rank]) < HALFWAY * problem->force) {
      double length = eo_loaded_step_length(ws, position);
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

/* Start from the line loads that ws->load holds, scaled to carry P, and an approach. */
static void start_from(struct eo_loaded_workspace *ws, double approach, const struct eo_loaded_problem *problem)
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
  eo_loaded_bend(ws, position, ws->mode);
  eo_loaded_blend(ws, position);
  memset(ws->spread, 0, sizeof *ws->spread * (size_t)position->points);
  for (int i = 0; i < position->points; i++)
    ws->local[i] = approach - problem->gap[i] - ws->bend[i] - ws->correction[i];
  if (ws->partial)
    eo_loaded_spread_cells(ws, position);
}

/* What a line carries at a position, known->line_load or zero where it is not there. */
static const double *carried_by(const struct eo_contact_position *position, const struct eo_contact_line *line,
                                const struct eo_loaded_end *known)
{
  const struct eo_contact_line *same = eo_contact_same_line(position, line);
  return same ? known->line_load + position->first + same->first : NULL;
}

/* Start from up to three positions before: what their lines carry goes on as it did, q = 3 q1 - 3 q2 + q3. */
static void start_from_before(struct eo_loaded_workspace *ws, int j, const struct eo_loaded_end *known, double factor,
                              const struct eo_loaded_problem *problem)
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
      load[i] = eo_loaded_larger(0, next) * position->length[line->first + i];
    }
  }
  start_from(ws, approach / factor, problem);
}

/* The long way when Newton fails: from a load so high that every point touches, down in steps along the tangent. */
static bool descend(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem)
{
  enum { TRIES = 6, STEPS = 400 };
  int n = problem->position->rank + 1;
  for (int start = 2; start < TRIES; start++) {
    struct eo_loaded_problem high = *problem;
    high.force *= pow(10, start);
    start_cold(ws, &high, ws->mode);
    double factor = 2;
    for (int i = 0; i < STEPS && eo_loaded_newton(ws, &high); i++) {
      if (high.force == problem->force)
        return true;
      double next = fmax(problem->force, high.force / factor);
      eo_loaded_follow(ws, problem->position);
      for (int k = 0; k < n; k++)
        ws->mode[k] += (next - high.force) * ws->tangent[k];
      eo_loaded_bend(ws, problem->position, ws->mode);
      high.force = next;
    }
  }
  return false;
}

/* Solves from ws->mode and writes position j of the result. */
static void solve_position(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, int j,
                           double factor, struct eo_loaded_end *result)
{
  const struct eo_contact_position *position = problem->position;
  bool converged = eo_loaded_newton(ws, problem) || descend(ws, problem);
  result->failures += !converged;
  result->load[j] = problem->force;
  result->approach[j] = ws->mode[position->rank] * factor;
  for (int i = 0; i < position->points; i++)
    result->line_load[position->first + i] = ws->load[i] / position->length[i];
  result->tangent[j] = 1 / (eo_loaded_tangent(ws, position) * factor);
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
    struct eo_loaded_problem problem = {position, scaled_gaps(ws, position, gaps->gap, compliance_factor), load[0],
                                        EO_LOADED_WITHIN};
    for (int l = 0; l < loads; l++) {
      problem.force = load[l];
      if (j == 0)
        start_cold(ws, &problem, ws->mode);
      else
        start_from_before(ws, j, &result[l], compliance_factor, &problem);
      solve_position(ws, &problem, j, compliance_factor, &result[l]);
      if (result[l].around)
        eo_loaded_go_around(ws, &problem, compliance_factor, result[l].nearby + j * EO_LOADED_NEARBY);
    }
  }
}

/* Solves position j again, from the result it has there. */
static struct eo_loaded_problem resolve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid,
                                        const double *gap, double factor, int j, double load, double within,
                                        struct eo_loaded_end *result)
{
  const struct eo_contact_position *position = &grid->position[j];
  struct eo_loaded_problem problem = {position, scaled_gaps(ws, position, gap, factor), load, within};
  for (int i = 0; i < position->points; i++)
    ws->load[i] = result->line_load[position->first + i] * position->length[i];
  start_from(ws, result->approach[j] / factor, &problem);
  solve_position(ws, &problem, j, factor, result);
  return problem;
}

void eo_loaded_resolve(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const double *gap,
                       double factor, int j, double load, struct eo_loaded_end *result)
{
  resolve(ws, grid, gap, factor, j, load, EO_LOADED_WITHIN, result);
}

void eo_loaded_resolve_within(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const double *gap,
                              double factor, int j, double load, double within, struct eo_loaded_end *result)
{
  resolve(ws, grid, gap, factor, j, load, within, result);
}

void eo_loaded_find_nearby(struct eo_loaded_workspace *ws, const struct eo_contact_grid *grid, const double *gap,
                           double factor, struct eo_loaded_end *result)
{
  for (int j = 0; j < grid->positions; j++) {
    struct eo_loaded_problem problem = resolve(ws, grid, gap, factor, j, result->load[j], EO_LOADED_WITHIN, result);
    eo_loaded_go_around(ws, &problem, factor, result->nearby + j * EO_LOADED_NEARBY);
  }
}

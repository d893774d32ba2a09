/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a solved position of loaded contact answers to changes of its load and of its gaps. */
#include "contact/loaded_private.h"

#include <math.h>
#include <string.h>

void eo_loaded_follow(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
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
  eo_loaded_newton_step(ws, position);
  for (int k = 0; k <= position->rank; k++)
    ws->tangent[k] += ws->step[k];
  eo_loaded_bend(ws, position, ws->tangent);
}

/* dZ/dP = the least value of dp'(C + diag(dg/dp))dp over load changes dp that sum to 1, and so right to the square of
   what dp is wrong. dp: from the last matrix, then corrected once for the rates of the solution and for what the modes
   leave of the compliance. Overwrites the loads and the correction. */
double eo_loaded_tangent(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  double square = 0, *mode = ws->trial;
  eo_loaded_follow(ws, position);
  eo_loaded_bend(ws, position, ws->tangent);
  memset(ws->correction, 0, sizeof *ws->correction * (size_t)position->points);
  change_loads(ws, position);
  eo_loaded_blend(ws, position);
  correct_tangent(ws, position);
  double sum = change_loads(ws, position);
  for (int i = 0; i < position->points; i++)
    square += ws->load[i] * (ws->tangent[position->rank] - ws->bend[i] - ws->correction[i]);
  memset(mode, 0, sizeof *mode * (size_t)position->rank);
  ws->gram->gather(position->points, position->rank, position->stride, position->factor, ws->load, mode);
  eo_loaded_blend(ws, position);
  square += eo_dot(position->rank, mode, mode);
  for (int i = 0; i < position->points; i++)
    square += ws->load[i] * ws->correction[i];
  return square / (sum * sum); /* theory (C4) */
}

/* As the tangent left them, theory (P8). */
void eo_loaded_last_shares(const struct eo_loaded_workspace *ws, const struct eo_contact_position *position,
                           double *share)
{
  double sum = 0;
  for (int i = 0; i < position->points; i++)
    sum += ws->load[i];
  for (int i = 0; i < position->points; i++)
    share[i] = ws->load[i] / sum;
}

void eo_loaded_last_reach(const struct eo_loaded_workspace *ws, const struct eo_contact_position *position,
                          double compliance_factor, double *reach)
{
  for (int i = 0; i < position->points; i++)
    reach[i] = compliance_factor * (ws->local[i] + ws->spread[i]);
}

/* Keeps the solution as the point from which neighbouring loads are reached, with its rates over the load. */
static void keep_course(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  int rank = position->rank;
  double sum = 0;
  for (int i = 0; i < position->points; i++) {
    ws->course[1][i] = ws->tangent[rank] - ws->bend[i] - ws->correction[i];
    sum += ws->rate[i] * ws->course[1][i];
  }
  for (int i = 0; i < position->points; i++) {
    ws->course[0][i] = ws->local[i];
    ws->course[1][i] /= sum;
    ws->course[2][i] = 0;
  }
  for (int k = 0; k <= rank; k++) {
    ws->modal_course[0][k] = ws->mode[k];
    ws->modal_course[1][k] = ws->tangent[k] / sum;
    ws->modal_course[2][k] = 0;
  }
}

/* Where the course leads when the load changes. */
static void go_along(int n, double *const course[3], double change, double *value)
{
  for (int i = 0; i < n; i++)
    value[i] = course[0][i] + change * (course[1][i] + change * course[2][i]);
}

/* Bends it so that it meets a solution at another load. */
static void bend_course(int n, double *const course[3], double change, const double *value)
{
  for (int i = 0; i < n; i++)
    course[2][i] = ((value[i] - course[0][i]) / change - course[1][i]) / change;
}

/* Newton from where the course leads, with the last matrix unless a step leaves more than SLOW of the one before. The
   approach is right to ERROR, m, but for the correction of the compliance, which stays as the course has it: some
   nanometres where a line comes into contact between the loads. */
static bool reach(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, double force)
{
  enum { STEPS = 16 };
  static const double ERROR = 3e-10, SLOW = 0.3;
  double before = 0;
  bool renew = false;
  for (int i = 0; i < STEPS; i++) {
    if (ws->partial)
      eo_loaded_spread_cells(ws, position);
    eo_loaded_carry(ws, position, ws->mode, force);
    if (renew && !eo_loaded_factorise(ws, position))
      return false;
    eo_loaded_newton_step(ws, position);
    for (int k = 0; k <= position->rank; k++)
      ws->mode[k] += ws->step[k];
    double moved = eo_loaded_step_length(ws, position), shrinks = i == 0 ? SLOW : moved / before;
    if (shrinks < 1 && moved * shrinks < ERROR)
      return true;
    renew = shrinks > SLOW;
    before = moved;
    eo_loaded_bend(ws, position, ws->step);
    for (int j = 0; j < position->points; j++)
      ws->local[j] += ws->step[position->rank] - ws->bend[j];
  }
  return false;
}

/* The long way: from the solution itself, as any other load. */
static void start_over(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem)
{
  const struct eo_contact_position *position = problem->position;
  memcpy(ws->mode, ws->modal_course[0], sizeof *ws->mode * (size_t)(position->rank + 1));
  memset(ws->correction, 0, sizeof *ws->correction * (size_t)position->points);
  eo_loaded_bend(ws, position, ws->mode);
  eo_loaded_newton(ws, problem);
}

void eo_loaded_go_around(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, double factor,
                         double *nearby)
{
  static const int ORDER[EO_LOADED_NEARBY] = {1, 0, 2, 3}; /* outwards on either side */
  const struct eo_contact_position *position = problem->position;
  int n = position->rank + 1;
  keep_course(ws, position);
  for (int i = 0; i < EO_LOADED_NEARBY; i++) {
    int node = ORDER[i];
    double change = (EO_LOADED_NEARBY_SHARE[node] - 1) * problem->force;
    struct eo_loaded_problem there = {position, problem->gap, problem->force + change, problem->within};
    go_along(n, ws->modal_course, change, ws->mode);
    go_along(position->points, ws->course, change, ws->local);
    if (!reach(ws, position, there.force))
      start_over(ws, &there);
    nearby[node] = ws->mode[position->rank] * factor;
    bend_course(n, ws->modal_course, change, ws->mode);
    bend_course(position->points, ws->course, change, ws->local);
  }
}

void eo_loaded_prepare_response(struct eo_loaded_workspace *ws, const struct eo_contact_position *position)
{
  if (!eo_loaded_factorise(ws, position))
    memset(ws->matrix, 0, sizeof *ws->matrix * (size_t)(position->rank + 1) * (size_t)eo_gram_width(position->rank));
  eo_loaded_follow(ws, position);
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
  eo_loaded_bend(ws, position, mode);
  for (int i = 0; i < position->points; i++)
    load_change[i] = ws->rate[i] * (mode[rank] - ws->bend[i] - (change ? change[i] / factor : 0));
  return mode[rank] * factor;
}

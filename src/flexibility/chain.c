/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/chain_private.h"

#include "numerics/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void fill_fields(struct eo_chain_work *work)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face;
  for (size_t i = 0; i < n && tooth->floating; i++) {
    work->field[i] = creal(tooth->rigid[0][i]);
    work->field[n + i] = creal(tooth->rigid[1][i]);
    work->field[2 * n + i] = -cimag(tooth->rigid[1][i]);
  }
}

static enum eo_code make_single(struct eo_chain_work *work, struct eo_error *error)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, row = 2 * n;
  struct eo_chain *single = &work->single;
  enum eo_code code = eo_chain_init(single, n, error);
  if (code)
    return code;
  single->teeth = 1;
  for (size_t j = 0; j < n; j++) {
    memcpy(single->left + j * n, tooth->stiffness + j * row, n * sizeof(double));
    memcpy(single->right + j * n, tooth->stiffness + (n + j) * row + n, n * sizeof(double));
    memcpy(single->across + j * n, tooth->stiffness + (n + j) * row, n * sizeof(double));
  }
  for (size_t a = 0; a < EO_CHAIN_PATTERNS; a++)
    for (size_t i = 0; i < n; i++)
      single->body[0][a * n + i] = tooth->weight[i] * work->field[a * n + i];
  return EO_OK;
}

static enum eo_code copy_chain(const struct eo_chain *chain, size_t n, struct eo_chain *out, struct eo_error *error)
{
  EO_TRY(eo_chain_init(out, n, error));
  memcpy(out->left, chain->left, n * n * sizeof(double));
  memcpy(out->right, chain->right, n * n * sizeof(double));
  memcpy(out->across, chain->across, n * n * sizeof(double));
  memcpy(out->body[0], chain->body[0], EO_CHAIN_PATTERNS * n * sizeof(double));
  memcpy(out->body[1], chain->body[1], EO_CHAIN_PATTERNS * n * sizeof(double));
  memcpy(out->moved, chain->moved, sizeof out->moved);
  out->teeth = chain->teeth;
  return EO_OK;
}

/* A chain of so many teeth by doubling. */
static enum eo_code make_middle(struct eo_chain_work *work, int teeth, struct eo_chain *out, struct eo_error *error)
{
  struct eo_chain power = {0}, next = {0};
  enum eo_code code = EO_OK;
  *out = (struct eo_chain){0};
  for (int left = teeth; left && !code; left >>= 1) {
    const struct eo_chain *chain = power.teeth ? &power : &work->single;
    if (left & 1 && out->teeth) {
      code = eo_chain_merge(work, out, chain, &next, NULL, error);
      eo_chain_done(out);
      *out = next;
    } else if (left & 1) {
      code = copy_chain(chain, (size_t)work->tooth->face, out, error);
    }
    if (left > 1 && !code) {
      code = eo_chain_merge(work, chain, chain, &next, NULL, error);
      eo_chain_done(&power);
      power = next;
    }
  }
  eo_chain_done(&power);
  return code;
}

/* Adds teeth D .. 1 before and -D .. -1 behind, one by one, and keeps how to find the faces between them. */
static enum eo_code add_near_teeth(struct eo_chain_work *work, int reach, struct eo_chain *chain,
                                   struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int t = reach; t >= 1 && !code; t--)
    for (int leading = 1; leading >= 0 && !code; leading--) {
      struct eo_chain_join *join = &work->join[work->joins];
      struct eo_chain next = {0};
      *join = (struct eo_chain_join){.first = t, .leading = leading};
      code = leading ? eo_chain_merge(work, &work->single, chain, &next, join, error)
                     : eo_chain_merge(work, chain, &work->single, &next, join, error);
      join->across = chain->across;
      chain->across = NULL;
      work->joins++;
      eo_chain_done(chain);
      *chain = next;
    }
  return code;
}

/* Steps of merging: doublings, additions, near teeth. */
static int count_steps(int teeth, int reach)
{
  int steps = 2 * reach;
  for (int left = teeth; left > 1; left >>= 1)
    steps += 1 + (left & 1);
  return steps;
}

double eo_chain_cost(const struct eo_ring_tooth *tooth, int reach)
{
  double n = tooth->face, m = tooth->flank, cube = n * n * n;
  int middle = tooth->teeth - 1 - 2 * reach;
  if (middle < 1)
    return INFINITY;
  return (count_steps(middle, reach) * 19.0 / 3 + 8.0 / 3) * cube + (8 + 12 * reach) * n * n * m;
}

/* Chains of single teeth, of those far away, of all but tooth 0; then the ring is closed. */
static enum eo_code solve(struct eo_chain_work *work, struct eo_chain *chain, struct eo_ring_motion *motion,
                          struct eo_error *error)
{
  const int middle = work->tooth->teeth - 1 - 2 * motion->reach;
  work->steps = count_steps(middle, motion->reach);
  work->field = calloc(EO_CHAIN_PATTERNS * (size_t)work->tooth->face, sizeof *work->field);
  work->join = calloc(2 * (size_t)motion->reach + 1, sizeof *work->join);
  if (!work->field || !work->join)
    return eo_error_memory(error);
  fill_fields(work);
  EO_TRY(make_single(work, error));
  EO_TRY(make_middle(work, middle, chain, error));
  EO_TRY(add_near_teeth(work, motion->reach, chain, error));
  return eo_chain_close(work, chain, motion, error);
}

enum eo_code eo_chain_solve(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth,
                            const struct eo_progress *progress, const char *what, double first, double last,
                            struct eo_error *error)
{
  struct eo_chain_work work = {.tooth = tooth, .progress = progress, .what = what, .first = first, .last = last};
  struct eo_chain chain = {0};
  eo_threads_limit();
  enum eo_code code = solve(&work, &chain, motion, error);
  eo_chain_done(&chain);
  eo_chain_done(&work.single);
  for (int i = 0; i < work.joins; i++) {
    free(work.join[i].factor);
    free(work.join[i].across);
    free(work.join[i].body);
  }
  free(work.join);
  free(work.field);
  return code;
}

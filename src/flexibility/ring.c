/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/ring.h"

#include "base/parallel.h"
#include "flexibility/chain.h"
#include "numerics/hermitian.h"
#include "numerics/threads.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Threads beyond these only cost memory: a harmonic of the default mesh takes 20 MB and 0.1 s. */
enum { MOST_THREADS = 8 };

/* One thread's room. */
struct room {
  double complex *matrix; /* [face][face] by columns */
  double complex *motion; /* [flank][face] */
};

struct job {
  const struct eo_ring_tooth *tooth;
  struct eo_ring_motion *motion;
  struct room room[MOST_THREADS];
  int harmonic; /* the batch's first */
};

enum eo_code eo_ring_tooth_init(struct eo_ring_tooth *tooth, int teeth, int inner, int flank, int face, bool floating,
                                struct eo_error *error)
{
  size_t n = (size_t)face, o = (size_t)inner, m = (size_t)flank;
  *tooth = (struct eo_ring_tooth){.teeth = teeth, .inner = inner, .flank = flank, .face = face, .floating = floating};
  tooth->compliance = malloc(sizeof *tooth->compliance * m * o);
  tooth->influence = malloc(sizeof *tooth->influence * o * 2 * n);
  tooth->stiffness = malloc(sizeof *tooth->stiffness * 4 * n * n);
  tooth->weight = calloc(n, sizeof *tooth->weight);
  bool complete = tooth->compliance && tooth->influence && tooth->stiffness && tooth->weight;
  for (int k = 0; k < EO_RING_RIGID; k++) {
    tooth->rigid[k] = calloc(n, sizeof *tooth->rigid[k]);
    tooth->rigid_flank[k] = calloc(m, sizeof *tooth->rigid_flank[k]);
    complete = complete && tooth->rigid[k] && tooth->rigid_flank[k];
  }
  if (complete)
    return EO_OK;
  eo_ring_tooth_done(tooth);
  return eo_error_memory(error);
}

void eo_ring_tooth_done(struct eo_ring_tooth *tooth)
{
  if (!tooth)
    return;
  free(tooth->compliance);
  free(tooth->influence);
  free(tooth->stiffness);
  free(tooth->weight);
  for (int k = 0; k < EO_RING_RIGID; k++) {
    free(tooth->rigid[k]);
    free(tooth->rigid_flank[k]);
  }
  *tooth = (struct eo_ring_tooth){0};
}

/* Turns the pairs x, y of a vector counterclockwise: components in a frame that is turned clockwise. */
static void turn_pairs(int face, const int *direction, double angle, double *value, size_t step)
{
  double c = cos(angle), s = sin(angle);
  for (int i = 0; i < face; i++) {
    if (direction[i] != 0)
      continue;
    double *x = value + (size_t)i * step, *y = x + step, kept = *x;
    *x = c * kept - s * *y;
    *y = s * kept + c * *y;
  }
}

void eo_ring_tooth_turn(struct eo_ring_tooth *tooth, const int *direction)
{
  double alpha = 2 * M_PI / tooth->teeth;
  size_t n = (size_t)tooth->face, row = 2 * n;
  for (int j = 0; j < tooth->inner; j++)
    turn_pairs(tooth->face, direction, alpha, tooth->influence + (size_t)j * row + n, 1);
  for (size_t i = 0; i < row; i++)
    turn_pairs(tooth->face, direction, alpha, tooth->stiffness + i * row + n, 1);
  for (size_t j = 0; j < row; j++)
    turn_pairs(tooth->face, direction, alpha, tooth->stiffness + n * row + j, row);
}

enum eo_code eo_ring_motion_init(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth, int reach,
                                 struct eo_error *error)
{
  size_t m = (size_t)tooth->flank, faces = 2 * (size_t)reach + 2;
  *motion = (struct eo_ring_motion){.reach = reach};
  motion->left = calloc(faces * m * (size_t)tooth->face, sizeof *motion->left);
  for (int k = 0; k < EO_RING_RIGID; k++)
    motion->part[k] = calloc(m * m, sizeof *motion->part[k]);
  if (motion->left && motion->part[0] && motion->part[1])
    return EO_OK;
  eo_ring_motion_done(motion);
  return eo_error_memory(error);
}

void eo_ring_motion_done(struct eo_ring_motion *motion)
{
  if (!motion)
    return;
  free(motion->left);
  for (int k = 0; k < EO_RING_RIGID; k++)
    free(motion->part[k]);
  *motion = (struct eo_ring_motion){0};
}

/* S_k = S_LL + S_RR + e S_LR + conj(e) S_RL, lower triangle by columns. */
static void fill_matrix(const struct eo_ring_tooth *tooth, double complex e, double complex *matrix)
{
  size_t n = (size_t)tooth->face, row = 2 * n;
  const double *s = tooth->stiffness;
  for (size_t j = 0; j < n; j++) {
    /* S is symmetric: its row j is its column j. */
    const double *left = s + j * row, *right = s + (n + j) * row;
    for (size_t i = j; i < n; i++)
      matrix[j * n + i] = left[i] + right[n + i] + e * right[i] + conj(e) * left[n + i]; /* theory (B4) */
  }
}

/* -F_k on the loaded unknowns, F_k = F_L + conj(e) F_R. */
static void fill_loads(const struct eo_ring_tooth *tooth, double complex e, double complex *load)
{
  size_t n = (size_t)tooth->face;
  const double *f = tooth->influence + (size_t)(tooth->inner - tooth->flank) * 2 * n;
  for (int j = 0; j < tooth->flank; j++, f += 2 * n, load += n)
    for (size_t i = 0; i < n; i++)
      load[i] = -f[i] - conj(e) * f[n + i];
}

/* N* w N. */
static double rigid_mass(const struct eo_ring_tooth *tooth, int k)
{
  double sum = 0;
  for (int i = 0; i < tooth->face; i++)
    sum += tooth->weight[i] * creal(conj(tooth->rigid[k][i]) * tooth->rigid[k][i]);
  return sum;
}

/* Adds s n n* to the singular matrix, n = N / |N|, s = trace / face, and balances the loads by -w N a. */
static void balance(const struct eo_ring_tooth *tooth, int k, double complex *matrix, double complex *load)
{
  size_t n = (size_t)tooth->face;
  const double complex *rigid = tooth->rigid[k];
  double trace = 0, square = 0, mass = rigid_mass(tooth, k);
  for (size_t i = 0; i < n; i++) {
    trace += creal(matrix[i * n + i]);
    square += creal(conj(rigid[i]) * rigid[i]);
  }
  double scale = trace / (double)n / square;
  for (size_t j = 0; j < n; j++)
    for (size_t i = j; i < n; i++)
      matrix[j * n + i] += scale * rigid[i] * conj(rigid[j]);
  for (int j = 0; j < tooth->flank; j++) {
    double complex a = conj(tooth->rigid_flank[k][j]) / mass;
    for (size_t i = 0; i < n; i++)
      load[(size_t)j * n + i] -= tooth->weight[i] * a * rigid[i]; /* theory (B6) */
  }
}

/* Takes the weighted mean of the rigid motion out. */
static void take_mean_out(const struct eo_ring_tooth *tooth, int k, double complex *motion)
{
  const double complex *rigid = tooth->rigid[k];
  double mass = rigid_mass(tooth, k);
  for (int j = 0; j < tooth->flank; j++, motion += tooth->face) {
    double complex mean = 0;
    for (int i = 0; i < tooth->face; i++)
      mean += tooth->weight[i] * conj(rigid[i]) * motion[i];
    mean /= mass;
    for (int i = 0; i < tooth->face; i++)
      motion[i] -= mean * rigid[i]; /* theory (B7) */
  }
}

static double complex step_of(const struct eo_ring_tooth *tooth, int k, int teeth)
{
  double angle = 2 * M_PI * (double)((long)k * teeth % tooth->teeth) / tooth->teeth;
  return cos(angle) + I * sin(angle);
}

static enum eo_code solve_harmonic(void *context, int thread, int item, struct eo_error *error)
{
  struct job *job = context;
  const struct eo_ring_tooth *tooth = job->tooth;
  int k = job->harmonic + item;
  struct room *room = &job->room[item];
  bool rigid = tooth->floating && k < EO_RING_RIGID;
  (void)thread;
  eo_threads_limit();
  fill_matrix(tooth, step_of(tooth, k, 1), room->matrix);
  fill_loads(tooth, step_of(tooth, k, 1), room->motion);
  if (rigid)
    balance(tooth, k, room->matrix, room->motion);
  if (eo_hermitian_solve(tooth->face, room->matrix, tooth->flank, room->motion))
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "The stiffness of the ring's harmonic %d is not positive definite.", k);
  if (rigid)
    take_mean_out(tooth, k, room->motion);
  return EO_OK;
}

static double share_of(const struct eo_ring_tooth *tooth, int k)
{
  return (k == 0 || 2 * k == tooth->teeth ? 1.0 : 2.0) / tooth->teeth;
}

/* part = (w_k / z) Re[G - (F_L + e F_R)' u_k] on the loaded unknowns. */
static void keep_part(const struct eo_ring_tooth *tooth, int k, const double complex *motion, double *part)
{
  size_t n = (size_t)tooth->face;
  int first = tooth->inner - tooth->flank;
  double complex e = step_of(tooth, k, 1);
  for (int j = 0; j < tooth->flank; j++)
    for (int i = 0; i < tooth->flank; i++) {
      const double *f = tooth->influence + (size_t)(first + i) * 2 * n;
      const double complex *u = motion + (size_t)j * n;
      double complex left = 0, right = 0;
      for (size_t c = 0; c < n; c++) {
        left += f[c] * u[c];
        right += f[n + c] * u[c];
      }
      part[j * tooth->flank + i] =
          share_of(tooth, k) *
          (tooth->compliance[(size_t)j * (size_t)tooth->inner + (size_t)(first + i)] - creal(left + e * right));
    }
}

static void add_harmonic(const struct job *job, int k, bool faces, const double complex *motion)
{
  const struct eo_ring_tooth *tooth = job->tooth;
  struct eo_ring_motion *sum = job->motion;
  size_t size = (size_t)tooth->flank * (size_t)tooth->face;
  for (int t = -sum->reach; t <= sum->reach + 1 && faces; t++) {
    double complex turn = share_of(tooth, k) * step_of(tooth, k, t); /* theory (B5) */
    double c = creal(turn), s = cimag(turn), *left = sum->left + (size_t)(t + sum->reach) * size;
    for (size_t i = 0; i < size; i++)
      left[i] += c * creal(motion[i]) - s * cimag(motion[i]);
  }
  if (k < EO_RING_RIGID)
    keep_part(tooth, k, motion, sum->part[k]);
}

static enum eo_code make_room(struct job *job, int rooms, struct eo_error *error)
{
  size_t n = (size_t)job->tooth->face, m = (size_t)job->tooth->flank;
  for (int i = 0; i < rooms; i++) {
    job->room[i].matrix = malloc(sizeof *job->room[i].matrix * n * n);
    job->room[i].motion = malloc(sizeof *job->room[i].motion * n * m);
    if (!job->room[i].matrix || !job->room[i].motion)
      return eo_error_memory(error);
  }
  return EO_OK;
}

enum eo_ring_method eo_ring_cheapest(const struct eo_ring_tooth *tooth, int reach, double *operations)
{
  double n = tooth->face, m = tooth->flank, chains = eo_chain_cost(tooth, reach);
  int orders = tooth->teeth / 2 + 1;
  double harmonics = orders * (4.0 / 3 * n * n * n + 8 * n * n * m);
  if (operations)
    *operations = fmin(chains, harmonics);
  return chains < harmonics ? EO_RING_CHAINS : EO_RING_HARMONICS;
}

/* Batches of one harmonic per thread: solved side by side, added in their order. With chains only the first two, for
   their parts. */
enum eo_code eo_ring_solve(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth, int threads,
                           enum eo_ring_method method, const struct eo_progress *progress, const char *what,
                           double first, double last, struct eo_error *error)
{
  static const double RIGID_SHARE = 0.1; /* of the progress, where chains leave two harmonics alone */
  struct job job = {.tooth = tooth, .motion = motion};
  bool chains = (method ? method : eo_ring_cheapest(tooth, motion->reach, NULL)) == EO_RING_CHAINS &&
                isfinite(eo_chain_cost(tooth, motion->reach));
  int count = chains ? EO_RING_RIGID : tooth->teeth / 2 + 1, rooms = threads < MOST_THREADS ? threads : MOST_THREADS;
  double end = chains ? first + RIGID_SHARE * (last - first) : last;
  rooms = rooms < count ? rooms : count;
  enum eo_code code = make_room(&job, rooms, error);
  for (; job.harmonic < count && !code; job.harmonic += rooms) {
    int items = count - job.harmonic < rooms ? count - job.harmonic : rooms;
    double from = first + (end - first) * job.harmonic / count;
    struct eo_parallel parallel = {.threads = rooms,
                                   .work = solve_harmonic,
                                   .context = &job,
                                   .progress = progress,
                                   .what = what,
                                   .first = from,
                                   .last = from + (end - first) * items / count};
    code = eo_parallel_run(&parallel, items, error);
    for (int i = 0; i < items && !code; i++)
      add_harmonic(&job, job.harmonic + i, !chains, job.room[i].motion);
  }
  for (int i = 0; i < rooms; i++) {
    free(job.room[i].matrix);
    free(job.room[i].motion);
  }
  return code || !chains ? code : eo_chain_solve(motion, tooth, progress, what, end, last, error);
}

enum eo_code eo_ring_displacement(const struct eo_ring_tooth *tooth, const struct eo_ring_motion *motion, int t,
                                  double *displacement, struct eo_error *error)
{
  size_t n = (size_t)tooth->face, m = (size_t)tooth->flank, size = m * n;
  const double *left = motion->left + (size_t)(t + motion->reach) * size;
  double *faces = malloc(sizeof *faces * 2 * size);
  if (!faces)
    return eo_error_memory(error);
  for (size_t j = 0; j < m; j++) {
    memcpy(faces + j * 2 * n, left + j * n, n * sizeof *faces);
    memcpy(faces + j * 2 * n + n, left + size + j * n, n * sizeof *faces);
  }
  if (t == 0)
    memcpy(displacement, tooth->compliance, sizeof *displacement * m * (size_t)tooth->inner);
  /* theory (B3) */
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, tooth->flank, tooth->inner, 2 * tooth->face, -1, faces,
              2 * tooth->face, tooth->influence, 2 * tooth->face, t == 0 ? 1 : 0, displacement, tooth->inner);
  free(faces);
  return EO_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ring closed: tooth 0 between both ends of the chain of all others, and every face between the teeth near it. */
#include "flexibility/chain_private.h"

#include "numerics/hermitian.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Coefficients [EO_CHAIN_PATTERNS][flank] of the balancing forces, as tooth 0 sees the patterns: c = -M^-1 N_o', and M.
 */
static void balance(const struct eo_chain_work *work, double *coefficient,
                    double mass[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS])
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, m = (size_t)tooth->flank;
  double own[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS];
  memset(mass, 0, sizeof own);
  for (int a = 0; a < EO_CHAIN_PATTERNS; a++)
    for (int b = 0; b < EO_CHAIN_PATTERNS; b++)
      own[a][b] = cblas_ddot((int)n, work->single.body[0] + (size_t)a * n, 1, work->field + (size_t)b * n, 1);
  for (int t = 0; t < tooth->teeth; t++)
    eo_chain_add_moved(tooth, t, (const double(*)[EO_CHAIN_PATTERNS])own, mass);
  for (size_t j = 0; j < m; j++) {
    /* Summed over all teeth, rotation and translations do not mix. */
    coefficient[j] = -creal(tooth->rigid_flank[0][j]) / mass[0][0];
    coefficient[m + j] = -creal(tooth->rigid_flank[1][j]) / mass[1][1];
    coefficient[2 * m + j] = cimag(tooth->rigid_flank[1][j]) / mass[2][2];
  }
}

/* The coefficients as tooth t sees the patterns. */
static void turn_coefficients(const struct eo_ring_tooth *tooth, int t, const double *coefficient, double *out)
{
  double turn[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS];
  size_t m = (size_t)tooth->flank;
  eo_chain_turn(tooth, t, turn);
  for (int a = 0; a < EO_CHAIN_PATTERNS; a++)
    for (size_t j = 0; j < m; j++)
      out[(size_t)a * m + j] = turn[a][0] * coefficient[j] + turn[a][1] * coefficient[m + j] +
                               turn[a][2] * coefficient[2 * m + j];
}

/* K of the faces [0; 1] between tooth 0 and the chain of all others; a floating body's rigid motions get springs. */
static void close_ring(const struct eo_chain_work *work, const struct eo_chain *chain, double *matrix)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, row = 2 * n;
  memcpy(matrix, tooth->stiffness, row * row * sizeof *matrix);
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++) {
      matrix[j * row + i] += chain->right[j * n + i];
      matrix[(n + j) * row + n + i] += chain->left[j * n + i];
      matrix[j * row + n + i] += chain->across[j * n + i];
      matrix[(n + j) * row + i] += chain->across[i * n + j];
    }
}

static void add_rigid_springs(const struct eo_chain_work *work, double *scratch, double *matrix)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, row = 2 * n;
  double trace = 0, *turned = scratch, *both = scratch + EO_CHAIN_PATTERNS * n;
  for (size_t i = 0; i < row; i++)
    trace += matrix[i * row + i];
  eo_chain_turn_body(tooth, 1, work->field, turned);
  for (size_t a = 0; a < EO_CHAIN_PATTERNS; a++) {
    memcpy(both, work->field + a * n, n * sizeof *both);
    memcpy(both + n, turned + a * n, n * sizeof *both);
    double square = cblas_ddot((int)row, both, 1, both, 1);
    cblas_dsyr(CblasColMajor, CblasLower, (int)row, trace / (double)row / square, both, 1, matrix, (int)row);
  }
}

/* Room of the closing step. */
struct closing {
  double *matrix;      /* [2 face][2 face] */
  double *motion;      /* [flank][2 face]: faces 0 and 1 */
  double *coefficient; /* [EO_CHAIN_PATTERNS][flank] */
  double *turned;      /* the same as tooth 1 sees them; scratch of a face */
  double *mean;        /* [EO_CHAIN_PATTERNS][flank] */
  double *scratch;     /* [5][face] */
};

static void closing_done(struct closing *closing)
{
  free(closing->matrix);
  free(closing->motion);
  free(closing->coefficient);
  free(closing->turned);
  free(closing->mean);
  free(closing->scratch);
}

static enum eo_code closing_init(struct closing *closing, size_t n, size_t m, struct eo_error *error)
{
  *closing = (struct closing){.matrix = malloc(sizeof(double) * 4 * n * n),
                              .motion = malloc(sizeof(double) * 2 * n * m),
                              .coefficient = calloc(EO_CHAIN_PATTERNS * m, sizeof(double)),
                              .turned = calloc(EO_CHAIN_PATTERNS * m, sizeof(double)),
                              .mean = calloc(EO_CHAIN_PATTERNS * m, sizeof(double)),
                              .scratch = malloc(sizeof(double) * 5 * n)};
  return closing->matrix && closing->motion && closing->coefficient && closing->turned && closing->mean &&
                 closing->scratch
             ? EO_OK
             : eo_error_memory(error);
}

/* y[columns][n at stride] += a[EO_CHAIN_PATTERNS][n] c[EO_CHAIN_PATTERNS][columns]. */
static void add_patterns(int n, int columns, const double *a, const double *c, double scale, double *y, int stride)
{
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n, columns, EO_CHAIN_PATTERNS, scale, a, n, c, columns, 1, y,
              stride);
}

/* Weighted means of the rigid motion of all faces, by reciprocity from what the balancing forces move. */
static void find_means(const struct eo_chain_work *work, const struct eo_chain *chain, struct closing *closing,
                       const double mass[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS])
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face, m = tooth->flank;
  double turn[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS];
  eo_chain_turn(tooth, 1, turn);
  for (int j = 0; j < m; j++) {
    const double *zero = closing->motion + (size_t)j * 2 * (size_t)n, *one = zero + n;
    double local[EO_CHAIN_PATTERNS], sum[EO_CHAIN_PATTERNS];
    for (int a = 0; a < EO_CHAIN_PATTERNS; a++) {
      size_t at = (size_t)a * (size_t)n;
      sum[a] = cblas_ddot(n, work->single.body[0] + at, 1, zero, 1);
      local[a] = cblas_ddot(n, chain->body[0] + at, 1, one, 1) + cblas_ddot(n, chain->body[1] + at, 1, zero, 1);
      for (int b = 0; b < EO_CHAIN_PATTERNS; b++)
        local[a] += chain->moved[a][b] * closing->turned[b * m + j];
    }
    for (int a = 0; a < EO_CHAIN_PATTERNS; a++) {
      for (int b = 0; b < EO_CHAIN_PATTERNS; b++)
        sum[a] += turn[b][a] * local[b];
      closing->mean[a * m + j] = sum[a] / mass[a][a];
    }
  }
}

static enum eo_code close_and_solve(const struct eo_chain_work *work, const struct eo_chain *chain,
                                    struct closing *closing, struct eo_error *error)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face, m = tooth->flank;
  double mass[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS] = {{0}};
  const double *f = tooth->influence + (size_t)(tooth->inner - m) * 2 * (size_t)n;
  close_ring(work, chain, closing->matrix);
  for (size_t i = 0; i < 2 * (size_t)n * (size_t)m; i++)
    closing->motion[i] = -f[i];
  if (tooth->floating) {
    add_rigid_springs(work, closing->scratch, closing->matrix);
    balance(work, closing->coefficient, mass);
    turn_coefficients(tooth, 1, closing->coefficient, closing->turned);
    add_patterns(n, m, work->single.body[0], closing->coefficient, 1, closing->motion, 2 * n);
    add_patterns(n, m, chain->body[1], closing->turned, 1, closing->motion, 2 * n);
    add_patterns(n, m, chain->body[0], closing->turned, 1, closing->motion + n, 2 * n);
  }
  if (eo_symmetric_factor(2 * n, closing->matrix))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The stiffness of the ring is not positive definite.");
  eo_symmetric_substitute(2 * n, closing->matrix, m, closing->motion);
  if (tooth->floating)
    find_means(work, chain, closing, (const double(*)[EO_CHAIN_PATTERNS])mass);
  return EO_OK;
}

static double *face_of(const struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth, int t)
{
  return motion->left + (size_t)(t + motion->reach) * (size_t)tooth->flank * (size_t)tooth->face;
}

/* The face between a chain and its added tooth: K u = f c - A_RL u_L - B_LR u_R. */
static void find_face(const struct eo_chain_work *work, const struct eo_chain_join *join, struct closing *closing,
                      const double *left, const double *right, double *face)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face, m = tooth->flank;
  const double *before = join->leading ? work->single.across : join->across;
  const double *after = join->leading ? join->across : work->single.across;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, m, n, -1, before, n, left, n, 0, face, n);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, m, n, -1, after, n, right, n, 1, face, n);
  turn_coefficients(tooth, join->first, closing->coefficient, closing->turned);
  add_patterns(n, m, join->body, closing->turned, 1, face, n);
  eo_symmetric_substitute(n, join->factor, m, face);
}

/* From faces 0 and 1 inwards, in the opposite order of the joining; at last the mean motion is taken out of all. */
static void find_faces(const struct eo_chain_work *work, struct closing *closing, struct eo_ring_motion *motion)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, m = (size_t)tooth->flank;
  for (size_t j = 0; j < m; j++) {
    memcpy(face_of(motion, tooth, 0) + j * n, closing->motion + j * 2 * n, n * sizeof(double));
    memcpy(face_of(motion, tooth, 1) + j * n, closing->motion + j * 2 * n + n, n * sizeof(double));
  }
  for (int t = 1; t <= motion->reach; t++) {
    const struct eo_chain_join *pair = &work->join[work->joins - 2 * t]; /* [0]: tooth t, [1]: tooth -t */
    find_face(work, &pair[1], closing, face_of(motion, tooth, t), face_of(motion, tooth, 1 - t),
              face_of(motion, tooth, -t));
    find_face(work, &pair[0], closing, face_of(motion, tooth, t), face_of(motion, tooth, -t),
              face_of(motion, tooth, t + 1));
  }
  for (int t = -motion->reach; t <= motion->reach + 1; t++) {
    turn_coefficients(tooth, t, closing->mean, closing->turned);
    add_patterns((int)n, (int)m, work->field, closing->turned, -1, face_of(motion, tooth, t), (int)n);
  }
}

enum eo_code eo_chain_close(const struct eo_chain_work *work, const struct eo_chain *chain,
                            struct eo_ring_motion *motion, struct eo_error *error)
{
  struct closing closing;
  enum eo_code code = closing_init(&closing, (size_t)work->tooth->face, (size_t)work->tooth->flank, error);
  if (!code)
    code = close_and_solve(work, chain, &closing, error);
  if (!code)
    find_faces(work, &closing, motion);
  closing_done(&closing);
  return code;
}

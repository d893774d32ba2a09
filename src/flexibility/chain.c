/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/chain.h"

#include "numerics/hermitian.h"
#include "numerics/threads.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PATTERNS = 3 };

/* Teeth side by side, condensed; matrices by columns. */
struct chain {
  int teeth;
  double *left, *right;             /* S_LL, S_RR: [face][face], symmetric; owned, as all */
  double *across;                   /* S_LR */
  double *body[2];                  /* [PATTERNS][face]: balancing forces on the left, the right face */
  double moved[PATTERNS][PATTERNS]; /* work of the patterns inside */
};

/* A face that was eliminated between a chain and one more tooth, and how to find it again. */
struct join {
  int first;      /* tooth at which the joined chain begins */
  bool leading;   /* the single tooth stands left of the chain */
  double *factor; /* of K */
  double *across; /* the chain's S_LR before */
  double *body;   /* [PATTERNS][face]: balancing forces on the face */
};

struct work {
  const struct eo_ring_tooth *tooth;
  const struct eo_progress *progress;
  const char *what;
  double first, last;
  int steps, step;
  double *field; /* [PATTERNS][face]: rotation, translation along x, y of a tooth's own left face */
  struct chain single;
  struct join *join; /* [2 reach] */
  int joins;
};

static void chain_done(struct chain *chain)
{
  free(chain->left);
  free(chain->right);
  free(chain->across);
  free(chain->body[0]);
  free(chain->body[1]);
  *chain = (struct chain){0};
}

static enum eo_code chain_init(struct chain *chain, size_t n, struct eo_error *error)
{
  *chain = (struct chain){.left = malloc(sizeof(double) * n * n),
                          .right = malloc(sizeof(double) * n * n),
                          .across = malloc(sizeof(double) * n * n),
                          .body = {calloc(PATTERNS * n, sizeof(double)), calloc(PATTERNS * n, sizeof(double))}};
  if (chain->left && chain->right && chain->across && chain->body[0] && chain->body[1])
    return EO_OK;
  chain_done(chain);
  return eo_error_memory(error);
}

/* The patterns of the first tooth's frame as tooth t sees them: columns of coefficients. */
static void turn_of(const struct eo_ring_tooth *tooth, int t, double turn[PATTERNS][PATTERNS])
{
  double angle = 2 * M_PI * (double)(t % tooth->teeth) / tooth->teeth, c = cos(angle), s = sin(angle);
  const double value[PATTERNS][PATTERNS] = {{1, 0, 0}, {0, c, -s}, {0, s, c}};
  memcpy(turn, value, sizeof value);
}

/* out = body turn, patterns of a chain that begins t teeth further on. */
static void turn_body(const struct eo_ring_tooth *tooth, int t, const double *body, double *out)
{
  double turn[PATTERNS][PATTERNS];
  size_t n = (size_t)tooth->face;
  turn_of(tooth, t, turn);
  for (int a = 0; a < PATTERNS; a++)
    for (size_t i = 0; i < n; i++)
      out[(size_t)a * n + i] = turn[0][a] * body[i] + turn[1][a] * body[n + i] + turn[2][a] * body[2 * n + i];
}

/* sum += turn' moved turn. */
static void add_moved(const struct eo_ring_tooth *tooth, int t, const double moved[PATTERNS][PATTERNS],
                      double sum[PATTERNS][PATTERNS])
{
  double turn[PATTERNS][PATTERNS];
  turn_of(tooth, t, turn);
  for (int a = 0; a < PATTERNS; a++)
    for (int b = 0; b < PATTERNS; b++)
      for (int c = 0; c < PATTERNS; c++)
        for (int d = 0; d < PATTERNS; d++)
          sum[a][b] += turn[c][a] * moved[c][d] * turn[d][b];
}

static void mirror(size_t n, double *matrix)
{
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < j; i++)
      matrix[j * n + i] = matrix[i * n + j];
}

static enum eo_code advance(struct work *work, struct eo_error *error)
{
  double fraction = work->first + (work->last - work->first) * ++work->step / work->steps;
  if (eo_progress_report(work->progress, work->what, fraction))
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "The preparation of the flexibility was stopped.");
  return EO_OK;
}

/* Scratch of one merge: K and its factor, A_LR L^-T, L^-1 B_LR, and the forces on the face before and after L^-1. */
struct scratch {
  double *matrix, *before, *after, *body, *solved;
};

static void scratch_done(struct scratch *scratch)
{
  free(scratch->matrix);
  free(scratch->before);
  free(scratch->after);
  free(scratch->body);
  free(scratch->solved);
}

static enum eo_code scratch_init(struct scratch *scratch, size_t n, struct eo_error *error)
{
  *scratch = (struct scratch){.matrix = malloc(sizeof(double) * n * n),
                              .before = malloc(sizeof(double) * n * n),
                              .after = malloc(sizeof(double) * n * n),
                              .body = malloc(sizeof(double) * PATTERNS * n),
                              .solved = malloc(sizeof(double) * PATTERNS * n)};
  return scratch->matrix && scratch->before && scratch->after && scratch->body && scratch->solved
             ? EO_OK
             : eo_error_memory(error);
}

/* Eliminates the face between the two chains; out: fresh. body[2][PATTERNS][face] of the second as the first sees it.
 */
static void combine(int n, const struct chain *a, const struct chain *b, double *const body[2], struct scratch *scratch,
                    struct chain *out)
{
  size_t size = (size_t)n * (size_t)n;
  memcpy(scratch->before, a->across, size * sizeof *scratch->before);
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, n, n, 1, scratch->matrix, n,
              scratch->before, n);
  memcpy(scratch->after, b->across, size * sizeof *scratch->after);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, n, 1, scratch->matrix, n,
              scratch->after, n);
  memcpy(scratch->solved, scratch->body, PATTERNS * (size_t)n * sizeof *scratch->solved);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, PATTERNS, 1, scratch->matrix, n,
              scratch->solved, n);
  memcpy(out->left, a->left, size * sizeof *out->left);
  memcpy(out->right, b->right, size * sizeof *out->right);
  memcpy(out->body[0], a->body[0], PATTERNS * (size_t)n * sizeof(double));
  memcpy(out->body[1], body[1], PATTERNS * (size_t)n * sizeof(double));
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, n, -1, scratch->before, n, 1, out->left, n); /* theory (B8) */
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, n, -1, scratch->after, n, 1, out->right, n);
  mirror((size_t)n, out->left);
  mirror((size_t)n, out->right);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, n, n, -1, scratch->before, n, scratch->after, n, 0,
              out->across, n);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, PATTERNS, n, -1, scratch->before, n, scratch->solved, n, 1,
              out->body[0], n);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, PATTERNS, n, -1, scratch->after, n, scratch->solved, n, 1,
              out->body[1], n);
}

/* a and b side by side -> out. join: NULL, or takes what finds the face again. */
static enum eo_code merge(struct work *work, const struct chain *a, const struct chain *b, struct chain *out,
                          struct join *join, struct eo_error *error)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face;
  size_t patterns = PATTERNS * (size_t)n;
  struct scratch scratch;
  double *body[2] = {malloc(sizeof(double) * patterns), malloc(sizeof(double) * patterns)};
  *out = (struct chain){0};
  enum eo_code code = scratch_init(&scratch, (size_t)n, error);
  if (!code)
    code = body[0] && body[1] ? chain_init(out, (size_t)n, error) : eo_error_memory(error);
  if (!code) {
    for (size_t i = 0; i < (size_t)n * (size_t)n; i++)
      scratch.matrix[i] = a->right[i] + b->left[i];
    for (int side = 0; side < 2; side++)
      turn_body(tooth, a->teeth, b->body[side], body[side]);
    for (size_t i = 0; i < patterns; i++)
      scratch.body[i] = a->body[1][i] + body[0][i];
    if (eo_symmetric_factor(n, scratch.matrix))
      code = eo_error_set(error, EO_ERROR_NUMERIC, "", "The stiffness of a chain of %d teeth is not positive definite.",
                          a->teeth + b->teeth);
  }
  if (!code) {
    combine(n, a, b, body, &scratch, out);
    out->teeth = a->teeth + b->teeth;
    memcpy(out->moved, a->moved, sizeof out->moved);
    add_moved(tooth, a->teeth, (const double(*)[PATTERNS])b->moved, out->moved);
    for (int p = 0; p < PATTERNS; p++)
      for (int q = 0; q < PATTERNS; q++)
        out->moved[p][q] += cblas_ddot(n, scratch.solved + (size_t)p * (size_t)n, 1,
                                       scratch.solved + (size_t)q * (size_t)n, 1);
    code = advance(work, error);
  }
  if (!code && join) {
    join->factor = scratch.matrix;
    join->body = scratch.body;
    scratch.matrix = scratch.body = NULL;
  }
  scratch_done(&scratch);
  free(body[0]);
  free(body[1]);
  return code;
}

static void fill_fields(struct work *work)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face;
  for (size_t i = 0; i < n && tooth->floating; i++) {
    work->field[i] = creal(tooth->rigid[0][i]);
    work->field[n + i] = creal(tooth->rigid[1][i]);
    work->field[2 * n + i] = -cimag(tooth->rigid[1][i]);
  }
}

static enum eo_code make_single(struct work *work, struct eo_error *error)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, row = 2 * n;
  struct chain *single = &work->single;
  enum eo_code code = chain_init(single, n, error);
  if (code)
    return code;
  single->teeth = 1;
  for (size_t j = 0; j < n; j++) {
    memcpy(single->left + j * n, tooth->stiffness + j * row, n * sizeof(double));
    memcpy(single->right + j * n, tooth->stiffness + (n + j) * row + n, n * sizeof(double));
    memcpy(single->across + j * n, tooth->stiffness + (n + j) * row, n * sizeof(double));
  }
  for (size_t a = 0; a < PATTERNS; a++)
    for (size_t i = 0; i < n; i++)
      single->body[0][a * n + i] = tooth->weight[i] * work->field[a * n + i];
  return EO_OK;
}

/* A chain of so many teeth by doubling. */
static enum eo_code make_middle(struct work *work, int teeth, struct chain *out, struct eo_error *error)
{
  struct chain power = {0}, next = {0};
  enum eo_code code = EO_OK;
  *out = (struct chain){0};
  for (int left = teeth; left && !code; left >>= 1) {
    const struct chain *chain = power.teeth ? &power : &work->single;
    if (left & 1 && out->teeth) {
      code = merge(work, out, chain, &next, NULL, error);
      chain_done(out);
      *out = next;
    } else if (left & 1) {
      size_t n = (size_t)work->tooth->face;
      code = chain_init(out, n, error);
      if (code)
        break;
      memcpy(out->left, chain->left, n * n * sizeof(double));
      memcpy(out->right, chain->right, n * n * sizeof(double));
      memcpy(out->across, chain->across, n * n * sizeof(double));
      memcpy(out->body[0], chain->body[0], PATTERNS * n * sizeof(double));
      memcpy(out->body[1], chain->body[1], PATTERNS * n * sizeof(double));
      memcpy(out->moved, chain->moved, sizeof out->moved);
      out->teeth = chain->teeth;
    }
    if (left > 1 && !code) {
      code = merge(work, chain, chain, &next, NULL, error);
      chain_done(&power);
      power = next;
    }
  }
  chain_done(&power);
  return code;
}

/* Adds teeth D .. 1 before and -D .. -1 behind, one by one, and keeps how to find the faces between them. */
static enum eo_code add_near_teeth(struct work *work, int reach, struct chain *chain, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int t = reach; t >= 1 && !code; t--)
    for (int leading = 1; leading >= 0 && !code; leading--) {
      struct join *join = &work->join[work->joins];
      struct chain next = {0};
      *join = (struct join){.first = t, .leading = leading};
      code = leading ? merge(work, &work->single, chain, &next, join, error)
                     : merge(work, chain, &work->single, &next, join, error);
      join->across = chain->across;
      chain->across = NULL;
      work->joins++;
      chain_done(chain);
      *chain = next;
    }
  return code;
}

/* Coefficients [PATTERNS][flank] of the balancing forces, as tooth 0 sees the patterns: c = -M^-1 N_o', and M. */
static void balance(const struct work *work, double *coefficient, double mass[PATTERNS][PATTERNS])
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, m = (size_t)tooth->flank;
  double own[PATTERNS][PATTERNS];
  memset(mass, 0, sizeof own);
  for (int a = 0; a < PATTERNS; a++)
    for (int b = 0; b < PATTERNS; b++)
      own[a][b] = cblas_ddot((int)n, work->single.body[0] + (size_t)a * n, 1, work->field + (size_t)b * n, 1);
  for (int t = 0; t < tooth->teeth; t++)
    add_moved(tooth, t, (const double(*)[PATTERNS])own, mass);
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
  double turn[PATTERNS][PATTERNS];
  size_t m = (size_t)tooth->flank;
  turn_of(tooth, t, turn);
  for (int a = 0; a < PATTERNS; a++)
    for (size_t j = 0; j < m; j++)
      out[(size_t)a * m + j] = turn[a][0] * coefficient[j] + turn[a][1] * coefficient[m + j] +
                               turn[a][2] * coefficient[2 * m + j];
}

/* K of the faces [0; 1] between tooth 0 and the chain of all others; a floating body's rigid motions get springs. */
static void close_ring(const struct work *work, const struct chain *chain, double *matrix)
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

static void add_rigid_springs(const struct work *work, double *scratch, double *matrix)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, row = 2 * n;
  double trace = 0, *turned = scratch, *both = scratch + PATTERNS * n;
  for (size_t i = 0; i < row; i++)
    trace += matrix[i * row + i];
  turn_body(tooth, 1, work->field, turned);
  for (size_t a = 0; a < PATTERNS; a++) {
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
  double *coefficient; /* [PATTERNS][flank] */
  double *turned;      /* the same as tooth 1 sees them; scratch of a face */
  double *mean;        /* [PATTERNS][flank] */
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
                              .coefficient = calloc(PATTERNS * m, sizeof(double)),
                              .turned = calloc(PATTERNS * m, sizeof(double)),
                              .mean = calloc(PATTERNS * m, sizeof(double)),
                              .scratch = malloc(sizeof(double) * 5 * n)};
  return closing->matrix && closing->motion && closing->coefficient && closing->turned && closing->mean &&
                 closing->scratch
             ? EO_OK
             : eo_error_memory(error);
}

/* y[columns][n at stride] += a[PATTERNS][n] c[PATTERNS][columns]. */
static void add_patterns(int n, int columns, const double *a, const double *c, double scale, double *y, int stride)
{
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n, columns, PATTERNS, scale, a, n, c, columns, 1, y, stride);
}

/* Weighted means of the rigid motion of all faces, by reciprocity from what the balancing forces move. */
static void find_means(const struct work *work, const struct chain *chain, struct closing *closing,
                       const double mass[PATTERNS][PATTERNS])
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face, m = tooth->flank;
  double turn[PATTERNS][PATTERNS];
  turn_of(tooth, 1, turn);
  for (int j = 0; j < m; j++) {
    const double *zero = closing->motion + (size_t)j * 2 * (size_t)n, *one = zero + n;
    double local[PATTERNS], sum[PATTERNS];
    for (int a = 0; a < PATTERNS; a++) {
      size_t at = (size_t)a * (size_t)n;
      sum[a] = cblas_ddot(n, work->single.body[0] + at, 1, zero, 1);
      local[a] = cblas_ddot(n, chain->body[0] + at, 1, one, 1) + cblas_ddot(n, chain->body[1] + at, 1, zero, 1);
      for (int b = 0; b < PATTERNS; b++)
        local[a] += chain->moved[a][b] * closing->turned[b * m + j];
    }
    for (int a = 0; a < PATTERNS; a++) {
      for (int b = 0; b < PATTERNS; b++)
        sum[a] += turn[b][a] * local[b];
      closing->mean[a * m + j] = sum[a] / mass[a][a];
    }
  }
}

static enum eo_code close_and_solve(const struct work *work, const struct chain *chain, struct closing *closing,
                                    struct eo_error *error)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face, m = tooth->flank;
  double mass[PATTERNS][PATTERNS] = {{0}};
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
    find_means(work, chain, closing, (const double(*)[PATTERNS])mass);
  return EO_OK;
}

static double *face_of(const struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth, int t)
{
  return motion->left + (size_t)(t + motion->reach) * (size_t)tooth->flank * (size_t)tooth->face;
}

/* The face between a chain and its added tooth: K u = f c - A_RL u_L - B_LR u_R. */
static void find_face(const struct work *work, const struct join *join, struct closing *closing, const double *left,
                      const double *right, double *face)
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
static void find_faces(const struct work *work, struct closing *closing, struct eo_ring_motion *motion)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  size_t n = (size_t)tooth->face, m = (size_t)tooth->flank;
  for (size_t j = 0; j < m; j++) {
    memcpy(face_of(motion, tooth, 0) + j * n, closing->motion + j * 2 * n, n * sizeof(double));
    memcpy(face_of(motion, tooth, 1) + j * n, closing->motion + j * 2 * n + n, n * sizeof(double));
  }
  for (int t = 1; t <= motion->reach; t++) {
    const struct join *pair = &work->join[work->joins - 2 * t]; /* [0]: tooth t, [1]: tooth -t */
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

enum eo_code eo_chain_solve(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth,
                            const struct eo_progress *progress, const char *what, double first, double last,
                            struct eo_error *error)
{
  size_t n = (size_t)tooth->face, m = (size_t)tooth->flank;
  int middle = tooth->teeth - 1 - 2 * motion->reach;
  struct work work = {.tooth = tooth, .progress = progress, .what = what, .first = first, .last = last};
  struct chain chain = {0};
  struct closing closing = {0};
  eo_threads_limit();
  work.steps = count_steps(middle, motion->reach);
  work.field = calloc(PATTERNS * n, sizeof *work.field);
  work.join = calloc(2 * (size_t)motion->reach + 1, sizeof *work.join);
  enum eo_code code = work.field && work.join ? EO_OK : eo_error_memory(error);
  if (!code) {
    fill_fields(&work);
    code = make_single(&work, error);
  }
  if (!code)
    code = make_middle(&work, middle, &chain, error);
  if (!code)
    code = add_near_teeth(&work, motion->reach, &chain, error);
  if (!code)
    code = closing_init(&closing, n, m, error);
  if (!code)
    code = close_and_solve(&work, &chain, &closing, error);
  if (!code)
    find_faces(&work, &closing, motion);
  closing_done(&closing);
  chain_done(&chain);
  chain_done(&work.single);
  for (int i = 0; i < work.joins; i++) {
    free(work.join[i].factor);
    free(work.join[i].across);
    free(work.join[i].body);
  }
  free(work.join);
  free(work.field);
  return code;
}

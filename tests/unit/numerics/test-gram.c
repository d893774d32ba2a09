/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The small dense kernel, in every version this processor has, against plain loops in long double. */
#include "base/random.h"
#include "numerics/gram.h"
#include "numerics/local_inverse.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 131, MOST_COLUMNS = 61, MOST_SIZE = 96, MOST_FLOATS = 192 };

/* Inputs of one size; a third of the weights and loads are zero. */
struct input {
  int rows, columns, stride, floats;
  float *f, *plain;
  double *x, *load, *weight;
};

static double draw(int stream, int index)
{
  return 2 * eo_random_unit(eo_random_at(7, (uint64_t)stream, 0, (uint64_t)index), 0) - 1;
}

static float *make_floats(int count)
{
  return (float *)eo_gram_allocate((count + 1) / 2);
}

static void input_init(struct input *in, int rows, int columns)
{
  *in = (struct input){.rows = rows,
                       .columns = columns,
                       .stride = (columns + EO_GRAM_LANE - 1) / EO_GRAM_LANE * EO_GRAM_LANE,
                       .floats = (rows + EO_GRAM_FLOATS - 1) / EO_GRAM_FLOATS * EO_GRAM_FLOATS};
  in->f = make_floats(rows * in->stride);
  in->x = eo_gram_allocate(in->stride);
  in->load = eo_gram_allocate(rows);
  in->weight = eo_gram_allocate(rows);
  in->plain = make_floats(rows * in->floats);
  for (int i = 0; i < rows; i++)
    for (int k = 0; k < columns; k++)
      in->f[i * in->stride + k] = (float)draw(1, i * columns + k);
  for (int k = 0; k < in->stride; k++)
    in->x[k] = draw(2, k); /* what stands behind the columns meets zeros */
  for (int i = 0; i < rows; i++) {
    in->load[i] = i % 3 == 1 ? 0 : 1000 * (1 + draw(3, i));
    in->weight[i] = i % 3 == 1 ? 0 : 1 + draw(4, i);
  }
  for (int i = 0; i < rows * in->floats; i++)
    in->plain[i] = i % in->floats < rows ? (float)draw(5, i) : 0;
}

static void input_done(struct input *in)
{
  free(in->f);
  free(in->x);
  free(in->load);
  free(in->weight);
  free(in->plain);
}

/* What one version makes of an input. */
struct output {
  double product[MOST_ROWS], gathered[MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  float matrix[MOST_SIZE * MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  float inverse[MOST_SIZE * MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  double solution[MOST_SIZE];
  float blended[MOST_FLOATS] __attribute__((aligned(EO_GRAM_ALIGN)));
  bool inverted;
};

static double right_side(int i)
{
  return draw(6, i);
}

static void run(const struct eo_gram *gram, const struct input *in, struct output *out)
{
  int n = in->columns + 1;
  float *packed = make_floats(in->rows * eo_gram_width(in->columns));
  double b[MOST_SIZE];
  memset(out, 0, sizeof *out);
  gram->apply(in->rows, in->columns, in->stride, in->f, in->x, out->product);
  memcpy(out->gathered, in->x, sizeof *in->x * (size_t)in->stride);
  gram->gather(in->rows, in->columns, in->stride, in->f, in->load, out->gathered);
  gram->blend(in->rows, in->floats, in->plain, in->load, out->blended);
  gram->assemble(in->rows, in->columns, in->stride, in->f, in->weight, packed, out->matrix);
  memcpy(out->inverse, out->matrix, sizeof out->matrix);
  out->inverted = gram->invert(n, out->inverse);
  for (int i = 0; i < MOST_SIZE; i++)
    b[i] = i < n ? right_side(i) : 1e9; /* what lies behind is not to be read */
  gram->solve(n, out->inverse, b, out->solution);
  free(packed);
}

static double check_products(const struct input *in, const struct output *out)
{
  double worst = 0;
  for (int i = 0; i < in->rows; i++) {
    long double sum = 0;
    for (int k = 0; k < in->columns; k++)
      sum += (long double)in->f[i * in->stride + k] * in->x[k];
    worst = fmax(worst, fabs((double)(out->product[i] - sum)));
  }
  for (int k = 0; k < in->stride; k++) {
    long double sum = in->x[k];
    for (int i = 0; i < in->rows; i++)
      sum -= (long double)in->load[i] * in->f[i * in->stride + k];
    worst = fmax(worst, fabs((double)(out->gathered[k] - sum)) / 1e3);
  }
  return worst;
}

static double check_blend(const struct input *in, const struct output *out)
{
  double worst = 0;
  for (int j = 0; j < in->floats; j++) {
    long double sum = 0;
    for (int i = 0; i < in->rows; i++)
      sum += (long double)in->load[i] * in->plain[i * in->floats + j];
    worst = fmax(worst, fabs((double)(out->blended[j] - sum)) / 1e3 / in->rows);
  }
  return worst;
}

/* Entry (i, j) of [I + F'WF, .; -1'WF, 1'W1]. */
static double entry(const struct input *in, int i, int j)
{
  double sum = i == j && i < in->columns;
  for (int p = 0; p < in->rows; p++) {
    double a = i < in->columns ? (double)in->f[p * in->stride + i] : -1,
           b = j < in->columns ? (double)in->f[p * in->stride + j] : -1;
    sum += in->weight[p] * a * b;
  }
  return sum;
}

/* Largest error of the assembled matrix against the root of its diagonal's entries, of its product with the inverse,
   and of the solution's residual; the matrix is at most some hundreds times as stiff one way as another. */
static void check_matrix(const struct input *in, const struct output *out, double error[3])
{
  int n = in->columns + 1, width = eo_gram_width(in->columns);
  static double wanted[MOST_SIZE][MOST_SIZE];
  error[0] = error[1] = error[2] = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      wanted[i][j] = entry(in, i, j);
  for (int i = 0; i < n; i++) {
    double residual = -right_side(i);
    for (int j = 0; j < n; j++) {
      double product = i == j;
      residual += wanted[i][j] * out->solution[j];
      for (int k = 0; k < n; k++)
        product += wanted[i][k] * (double)out->inverse[k * width + j];
      error[0] = fmax(error[0],
                      fabs((double)out->matrix[i * width + j] - wanted[i][j]) / sqrt(wanted[i][i] * wanted[j][j]));
      error[1] = fmax(error[1], fabs(product));
    }
    error[2] = fmax(error[2], fabs(residual));
  }
  for (int i = 0; i < width; i++)
    for (int j = 0; j < width; j++)
      if (i >= n || j >= n)
        error[0] = fmax(error[0], fabs((double)out->matrix[i * width + j] - (i == j)));
}

/* avx2 and avx512 round alike. */
static bool round_alike(const struct eo_gram *a, const struct eo_gram *b)
{
  return a == b || (strcmp(a->name, "plain") != 0 && strcmp(b->name, "plain") != 0);
}

static int count_differences(const struct input *in, const struct output *a, const struct output *b)
{
  int different = memcmp(a->blended, b->blended, sizeof a->blended) != 0;
  for (int i = 0; i < in->rows; i++)
    different += a->product[i] != b->product[i];
  for (int i = 0; i < MOST_SIZE; i++)
    different += a->gathered[i] != b->gathered[i] || a->solution[i] != b->solution[i];
  for (int i = 0; i < MOST_SIZE * MOST_SIZE; i++) /* zeros behind the matrix may have either sign */
    different += a->matrix[i] != b->matrix[i] || a->inverse[i] != b->inverse[i];
  return different;
}

static void test_size(int rows, int columns)
{
  static struct output first, out;
  struct input in;
  input_init(&in, rows, columns);
  for (int version = 0; eo_gram_version(version); version++) {
    const struct eo_gram *gram = eo_gram_version(version);
    double error[3];
    run(gram, &in, &out);
    check_matrix(&in, &out, error);
    ok(check_products(&in, &out) < 1e-12, "%s, %d x %d: the products are right", gram->name, rows, columns);
    ok(check_blend(&in, &out) < 2e-7, "the sums in single precision are right");
    ok(out.inverted && error[0] < 1e-6 && error[1] < 3e-4 && error[2] < 3e-4,
       "the inverted matrix is right: matrix %.1e, inverse %.1e, solution %.1e", error[0], error[1], error[2]);
    if (version == 0)
      first = out;
    if (round_alike(gram, eo_gram_version(0)))
      ok(count_differences(&in, &first, &out) == 0, "this version gives the same numbers as the fastest");
  }
  input_done(&in);
}

/* c = a b and c += a b in single precision; then every row on its own and in batches of every size: the same bytes. */
static void test_multiply(const struct eo_gram *gram, int rows, int inner, int columns)
{
  int a_stride = inner + 3;
  float *a = make_floats(rows * a_stride), *b = make_floats(inner * columns), *c = make_floats(rows * columns),
        *alone = make_floats(rows * columns);
  double worst = 0;
  int different = 0;
  for (int i = 0; i < rows * a_stride; i++)
    a[i] = (float)draw(8, i);
  for (int i = 0; i < inner * columns; i++)
    b[i] = (float)draw(9, i);
  gram->multiply(rows, inner, columns, a, a_stride, b, columns, false, c, columns);
  gram->multiply(rows, inner, columns, a, a_stride, b, columns, true, c, columns);
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) {
      long double sum = 0;
      for (int k = 0; k < inner; k++)
        sum += 2 * (long double)a[i * a_stride + k] * b[k * columns + j];
      worst = fmax(worst, fabs((double)(c[i * columns + j] - sum)));
    }
  for (int batch = 1; batch < rows; batch++) {
    for (int i = 0; i < rows; i += batch)
      for (int add = 0; add < 2; add++)
        gram->multiply(rows - i < batch ? rows - i : batch, inner, columns, a + i * a_stride, a_stride, b, columns, add,
                       alone + i * columns, columns);
    different += memcmp(c, alone, sizeof *c * (size_t)(rows * columns)) != 0;
  }
  ok(worst < 2e-7 * inner, "%s: the product of %d x %d x %d is right to %.1e", gram->name, rows, inner, columns, worst);
  ok(different == 0, "each row of a product is the same in batches of any size");
  free(a);
  free(b);
  free(c);
  free(alone);
}

/* Loads of a line contact beside the law read point by point; cells without contact, in part and whole, from gaps below
   the table to loads beyond the law, and what is not a number. */
static void test_carry(const struct eo_gram *gram, int points)
{
  struct eo_local_inverse inverse;
  struct eo_error error;
  double *vector[6];
  for (int i = 0; i < 6; i++)
    vector[i] = eo_gram_allocate(points);
  double *local = vector[0], *spread = vector[1], *load = vector[2], *rate = vector[3], *per_depth = vector[4],
         *strength = vector[5], sum = 0;
  int different = 0, in_part = 0;
  if (!ok(!eo_local_inverse_init(&inverse, &error), "the inverse of the local law is made %s", error.text))
    return;
  for (int i = 0; i < points; i++) {
    local[i] = i % 17 == 3 ? 1e-30 : draw(20, i) * pow(10, 3 * draw(21, i) - 3);
    spread[i] = i % 5 == 1 ? 0 : fabs(local[i]) * (1 + draw(22, i));
    per_depth[i] = 1 + 0.5 * draw(23, i);
    strength[i] = 10 + draw(24, i);
  }
  if (points > 20)
    local[20] = NAN;
  struct eo_line_law law = {(const double(*)[2])inverse.node, per_depth, strength};
  double whole = gram->carry(points, &law, local, spread, load, rate);
  for (int i = 0; i < points; i++) {
    double share = 1, g = local[i], p = 0, slope = 0;
    if (g < spread[i] && g > -spread[i]) {
      share = (g + spread[i]) / (2 * spread[i]);
      g = share * share * spread[i];
      in_part++;
    }
    if (!(local[i] <= -spread[i]))
      p = strength[i] * eo_local_inverse_at(law.node, g * per_depth[i], &slope);
    double its_rate = share * slope * strength[i] * per_depth[i];
    sum += p;
    different += memcmp(&p, &load[i], sizeof p) != 0 && !(isnan(p) && isnan(load[i]));
    different += memcmp(&its_rate, &rate[i], sizeof p) != 0 && !(isnan(its_rate) && isnan(rate[i]));
  }
  ok(different == 0 && (isnan(sum) ? isnan(whole) : sum == whole),
     "%s: the loads of %d points, %d in part, are right to the last bit", gram->name, points, in_part);
  for (int i = 0; i < 6; i++)
    free(vector[i]);
  eo_local_inverse_done(&inverse);
}

/* Blocks in which a principal stress may pass, against the root itself, for stresses that are certain and that are not.
   Where it comes within rounding of the largest, either answer is right. */
static void test_find_passing(const struct eo_gram *gram)
{
  enum { BLOCKS = 40, NODES = BLOCKS * EO_GRAM_COLUMNS };
  float *stress = make_floats(3 * NODES), *rest = make_floats(NODES);
  int wrong = 0, passing = 0;
  for (int i = 0; i < 3 * NODES; i++)
    stress[i] = (float)draw(30, i);
  for (int i = 0; i < NODES; i++)
    rest[i] = (float)fabs(draw(31, i));
  for (int step = 0; step < 60; step++) {
    float largest = 0.05F * (float)step, left = step % 2 ? 0.4F : 0;
    for (int block = 0; block < BLOCKS; block++) {
      double most = -INFINITY;
      for (int i = 0; i < EO_GRAM_COLUMNS; i++) {
        const float *at = stress + 3 * EO_GRAM_COLUMNS * block + i;
        double s = at[0], t = at[EO_GRAM_COLUMNS], u = at[2 * EO_GRAM_COLUMNS];
        most = fmax(most, (s + t + hypot(s - t, 2 * u)) / 2 + left * rest[block * EO_GRAM_COLUMNS + i]);
      }
      bool passes = gram->find_passing(block, block + 1, stress, left, rest, largest) == block;
      wrong += passes != (most > largest) && fabs(most - largest) > 1e-6;
      passing += passes;
    }
    int one_by_one = 0;
    while (one_by_one < BLOCKS &&
           gram->find_passing(one_by_one, one_by_one + 1, stress, left, rest, largest) > one_by_one)
      one_by_one++;
    wrong += gram->find_passing(0, BLOCKS, stress, left, rest, largest) != one_by_one;
  }
  ok(wrong == 0 && passing > 100 && passing < 60 * BLOCKS - 100, "%s: blocks that pass are told, %d of %d, %d wrong",
     gram->name, passing, 60 * BLOCKS, wrong);
  free(stress);
  free(rest);
}

/* Matrices that are not positive definite. */
static void test_refusals(void)
{
  static float matrix[MOST_SIZE * MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  static const struct {
    const char *what;
    float value;
    int row, column;
  } spoilt[] = {{"a negative pivot", -1, 8, 8},        {"a zero first pivot", 0, 0, 0},
                {"a NaN on the diagonal", NAN, 5, 5},  {"a NaN beside it", NAN, 7, 3},
                {"an infinite pivot", INFINITY, 2, 2}, {"an entry that is too large", 2, 6, 1}};
  int n = 9, width = eo_gram_width(n - 1);
  for (int version = 0; eo_gram_version(version); version++)
    for (size_t s = 0; s <= sizeof spoilt / sizeof *spoilt; s++) {
      memset(matrix, 0, sizeof matrix);
      for (int i = 0; i < width; i++)
        matrix[i * (width + 1)] = 1;
      bool sound = s == sizeof spoilt / sizeof *spoilt;
      if (!sound)
        matrix[spoilt[s].row * width + spoilt[s].column] = matrix[spoilt[s].column * width + spoilt[s].row] =
            spoilt[s].value;
      ok(eo_gram_version(version)->invert(n, matrix) == sound, "version %d judges the matrix: %s", version,
         sound ? "the sound matrix is accepted" : spoilt[s].what);
    }
}

int main(void)
{
  int last = 0;
  while (eo_gram_version(last + 1))
    last++;
  ok(strcmp(eo_gram_version(last)->name, "plain") == 0 && (strcmp(eo_gram_select()->name, "plain") == 0) == (last == 0),
     "the plain version comes last, and is selected where there is no other");
  test_size(1, 1);
  test_size(7, 8);
  test_size(40, 23);
  test_size(97, 36);
  test_size(MOST_ROWS, 48);
  test_size(MOST_ROWS, MOST_COLUMNS);
  for (int version = 0; eo_gram_version(version); version++) {
    test_multiply(eo_gram_version(version), 13, 31, 7 * EO_GRAM_COLUMNS);
    test_multiply(eo_gram_version(version), 7, 5, EO_GRAM_COLUMNS);
    test_multiply(eo_gram_version(version), 3, 16, 3 * EO_GRAM_COLUMNS);
    test_find_passing(eo_gram_version(version));
    test_carry(eo_gram_version(version), 131);
    test_carry(eo_gram_version(version), 19);
    test_carry(eo_gram_version(version), 3);
  }
  test_refusals();
  double *memory = eo_gram_allocate(3);
  ok((size_t)memory % EO_GRAM_ALIGN == 0 && memory[0] == 0 && memory[2] == 0,
     "memory of the kernel is aligned and zero");
  free(memory);
  return tap_done();
}

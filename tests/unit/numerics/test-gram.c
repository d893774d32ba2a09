/* The small dense kernel, in every version this processor has, against plain loops in long double. */
#include "base/random.h"
#include "numerics/gram.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 131, MOST_STRIDE = 40, MOST_SIZE = MOST_STRIDE + EO_GRAM_LANE, MOST_FLOATS = 192 };

/* Inputs of one size; a third of the weights and loads are zero. */
struct input {
  int rows, stride, floats;
  double *f, *x, *load, *weight;
  float *plain;
};

static double draw(int stream, int index)
{
  return 2 * eo_random_unit(eo_random_at(7, (uint64_t)stream, 0, (uint64_t)index), 0) - 1;
}

static void input_init(struct input *in, int rows, int stride)
{
  *in = (struct input){
      .rows = rows, .stride = stride, .floats = (rows + EO_GRAM_FLOATS - 1) / EO_GRAM_FLOATS * EO_GRAM_FLOATS};
  in->f = eo_gram_allocate((long)rows * stride);
  in->x = eo_gram_allocate(stride);
  in->load = eo_gram_allocate(rows);
  in->weight = eo_gram_allocate(rows);
  in->plain = (float *)eo_gram_allocate((long)rows * in->floats / 2);
  for (int i = 0; i < rows * stride; i++)
    in->f[i] = draw(1, i);
  for (int k = 0; k < stride; k++)
    in->x[k] = draw(2, k);
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
  double product[MOST_ROWS], gathered[MOST_STRIDE] __attribute__((aligned(EO_GRAM_ALIGN)));
  double matrix[MOST_SIZE * MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  double factor[MOST_SIZE * MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  double solution[MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  float blended[MOST_FLOATS] __attribute__((aligned(EO_GRAM_ALIGN)));
  bool factored;
};

static double right_side(int i)
{
  return draw(6, i);
}

static void run(const struct eo_gram *gram, const struct input *in, struct output *out)
{
  int n = in->stride + 1;
  double *packed = eo_gram_allocate(2L * in->rows * in->stride);
  memset(out, 0, sizeof *out);
  gram->apply(in->rows, in->stride, in->f, in->x, out->product);
  memcpy(out->gathered, in->x, sizeof *in->x * (size_t)in->stride);
  gram->gather(in->rows, in->stride, in->f, in->load, out->gathered);
  gram->blend(in->rows, in->floats, in->plain, in->load, out->blended);
  gram->assemble(in->rows, in->stride, in->f, in->weight, packed, out->matrix);
  memcpy(out->factor, out->matrix, sizeof out->matrix);
  out->factored = gram->factor(n, in->stride, out->factor);
  for (int i = 0; i < MOST_SIZE; i++)
    out->solution[i] = i < n ? right_side(i) : 1e9; /* what lies behind is not to be read */
  gram->solve(n, in->stride, out->factor, out->solution);
  free(packed);
}

static double check_products(const struct input *in, const struct output *out)
{
  double worst = 0;
  for (int i = 0; i < in->rows; i++) {
    long double sum = 0;
    for (int k = 0; k < in->stride; k++)
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
static long double entry(const struct input *in, int i, int j)
{
  long double sum = i == j && i < in->stride;
  for (int p = 0; p < in->rows; p++) {
    long double a = i < in->stride ? (long double)in->f[p * in->stride + i] : -1,
                b = j < in->stride ? (long double)in->f[p * in->stride + j] : -1;
    sum += in->weight[p] * a * b;
  }
  return sum;
}

/* Largest error of the assembled lower triangle, of L L' against it, and of the solution's residual. */
static void check_matrix(const struct input *in, const struct output *out, double error[3])
{
  int n = in->stride + 1, ld = in->stride + EO_GRAM_LANE;
  error[0] = error[1] = error[2] = 0;
  for (int i = 0; i < n; i++) {
    long double residual = -right_side(i);
    for (int j = 0; j < n; j++) {
      long double wanted = entry(in, i, j), product = 0;
      residual += wanted * out->solution[j];
      if (j > i)
        continue;
      for (int k = 0; k <= j; k++)
        product += (long double)out->factor[i * ld + k] * out->factor[j * ld + k];
      error[0] = fmax(error[0], fabs((double)(out->matrix[i * ld + j] - wanted)));
      error[1] = fmax(error[1], fabs((double)(product - wanted)));
    }
    error[2] = fmax(error[2], fabs((double)residual));
  }
  for (int i = n; i < ld; i++)
    error[2] = fmax(error[2], fabs(out->solution[i]));
}

static void test_size(int rows, int stride)
{
  static struct output first, out;
  struct input in;
  input_init(&in, rows, stride);
  for (int version = 0; eo_gram_version(version); version++) {
    double error[3];
    run(eo_gram_version(version), &in, &out);
    check_matrix(&in, &out, error);
    ok(check_products(&in, &out) < 1e-12, "version %d, %d x %d: products", version, rows, stride);
    ok(check_blend(&in, &out) < 2e-7, "single precision sums");
    ok(out.factored && error[0] < 1e-12 && error[1] < 1e-11 && error[2] < 1e-11,
       "matrix %.1e, factor %.1e, solution %.1e", error[0], error[1], error[2]);
    if (version == 0)
      first = out;
    ok(memcmp(&first, &out, sizeof out) == 0, "the same bytes as the fastest version");
  }
  input_done(&in);
}

/* c = a b and c += a b in single precision; then every row on its own and in batches of every size: the same bytes. */
static void test_multiply(const struct eo_gram *gram, int rows, int inner, int columns)
{
  int a_stride = inner + 3;
  float *a = (float *)eo_gram_allocate((rows * a_stride + 1) / 2), *b = (float *)eo_gram_allocate(inner * columns / 2),
        *c = (float *)eo_gram_allocate(rows * columns / 2), *alone = (float *)eo_gram_allocate(rows * columns / 2);
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
  ok(worst < 2e-7 * inner, "%s: product of %d x %d x %d, %.1e", gram->name, rows, inner, columns, worst);
  ok(different == 0, "each row the same in batches of any size");
  free(a);
  free(b);
  free(c);
  free(alone);
}

/* Matrices that have no Cholesky factor. */
static void test_refusals(void)
{
  static double matrix[MOST_SIZE * MOST_SIZE] __attribute__((aligned(EO_GRAM_ALIGN)));
  static const struct {
    const char *what;
    double value;
    int row, column;
  } spoilt[] = {{"a negative pivot", -1, 8, 8},
                {"a zero first pivot", 0, 0, 0},
                {"a NaN on the diagonal", NAN, 5, 5},
                {"a NaN beside it", NAN, 7, 3},
                {"an entry that is too large", 2, 6, 1}};
  int stride = 8, n = stride + 1, ld = stride + EO_GRAM_LANE;
  for (int version = 0; eo_gram_version(version); version++)
    for (size_t s = 0; s <= sizeof spoilt / sizeof *spoilt; s++) {
      memset(matrix, 0, sizeof matrix);
      for (int i = 0; i < n; i++)
        matrix[i * (ld + 1)] = 1;
      bool sound = s == sizeof spoilt / sizeof *spoilt;
      if (!sound)
        matrix[spoilt[s].row * ld + spoilt[s].column] = spoilt[s].value;
      ok(eo_gram_version(version)->factor(n, stride, matrix) == sound, "version %d: %s", version,
         sound ? "the sound matrix is accepted" : spoilt[s].what);
    }
}

int main(void)
{
  ok(eo_gram_select() == eo_gram_version(0), "the fastest version comes first");
  test_size(1, 8);
  test_size(7, 8);
  test_size(40, 24);
  test_size(MOST_ROWS, MOST_STRIDE);
  for (int version = 0; eo_gram_version(version); version++) {
    test_multiply(eo_gram_version(version), 13, 31, 7 * EO_GRAM_COLUMNS);
    test_multiply(eo_gram_version(version), 7, 5, EO_GRAM_COLUMNS);
  }
  test_refusals();
  double *memory = eo_gram_allocate(3);
  ok((size_t)memory % EO_GRAM_ALIGN == 0 && memory[0] == 0 && memory[2] == 0, "memory is aligned and zero");
  free(memory);
  return tap_done();
}

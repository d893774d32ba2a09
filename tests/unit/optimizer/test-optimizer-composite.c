/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surrogates made of parts: exact where the parts are, kinks included; and what a search makes of them. */
#include "base/random.h"
#include "optimizer/composite.h"
#include "optimizer/optimizer.h"
#include "support/tap.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { N = 4, SAMPLES = 8, PARTS = SAMPLES + 2, GROUPS = 2, ROWS = 30 };

static struct eo_part_group group[GROUPS] = {{EO_PART_RANGE, SAMPLES, 0.7}, {EO_PART_LARGEST, 2, 0.3}};
static const struct eo_anatomy anatomy = {.parts = PARTS, .groups = GROUPS, .group = group}, none = {0};

/* A wave whose range is to vanish, and two rivals: every part is linear in x, the value is not. */
static void fill_parts(const double *x, double *part)
{
  for (int i = 0; i < SAMPLES; i++) {
    const double phase = acos(-1) * i / (SAMPLES / 2.0);
    part[i] = (x[0] - 0.62) * cos(phase) + (x[1] - 0.31 + 0.4 * (x[2] - 0.5)) * sin(phase) +
              0.8 * (x[2] - 0.44) * cos(2 * phase);
  }
  part[SAMPLES] = 0.5 + x[3] - x[0];
  part[SAMPLES + 1] = 0.5 + 0.6 * (x[0] - x[3]) + 0.2 * (x[1] - 0.31);
}

/* The rest is what the anatomy does not know of. */
static double value_at(const double *x, double *part)
{
  fill_parts(x, part);
  return eo_anatomy_sum(&anatomy, part) + 0.05 * x[3];
}

static void test_reductions(void)
{
  const double part[PARTS] = {0, 3, -2, 1, 0, 0, 0, 0, 5, 7};
  int most, least;
  close_to(eo_anatomy_reduce(&group[0], part, &most, &least), 5, 0, "range of the parts");
  ok(most == 1 && least == 2, "the range names the parts that it takes");
  close_to(eo_anatomy_reduce(&group[1], part + SAMPLES, &most, &least), 7, 0, "largest of the parts");
  ok(most == 1 && least == -1, "the largest names its part alone");
  close_to(eo_anatomy_sum(&anatomy, part), 0.7 * 5 + 0.3 * 7, 1e-15, "sum of both by weight");
}

static double unit(int i, int k)
{
  return eo_random_unit(eo_random_at(3, 9, 0, (uint64_t)i), (uint64_t)k);
}

/* An archive of drawn rows; the last one without its parts. */
static void fill_archive(struct eo_archive *archive, int *row, double *x, double *value)
{
  struct eo_error error;
  double part[PARTS];
  eo_archive_init(archive, N, 0, &error);
  eo_archive_set_parts(archive, PARTS);
  eo_archive_reserve(archive, ROWS + 1, &error);
  for (int j = 0; j <= ROWS; j++) {
    double place[N];
    for (int k = 0; k < N; k++)
      place[k] = unit(j, k);
    const double v = value_at(place, part);
    eo_archive_add(archive, place, place, v, 0, NULL, j < ROWS ? part : NULL, 0, j);
    if (j == ROWS)
      continue;
    row[j] = j;
    value[j] = v;
    memcpy(x + (size_t)j * N, place, sizeof place);
  }
}

static void check_against(struct eo_composite *composite, const char *what, double bound)
{
  double worst = 0, worst_slope = 0, part[PARTS], gradient[N];
  for (int i = 100; i < 160; i++) {
    double x[N], up[N], down[N];
    for (int k = 0; k < N; k++)
      x[k] = up[k] = down[k] = unit(i, k);
    worst = fmax(worst,
                 fabs(eo_composite_value(composite, x) * composite->scale + composite->offset - value_at(x, part)));
    eo_composite_gradient(composite, gradient);
    for (int k = 0; k < N; k++) {
      const double step = 1e-6;
      up[k] += step;
      down[k] -= step;
      const double slope = (eo_composite_value(composite, up) - eo_composite_value(composite, down)) / (2 * step);
      worst_slope = fmax(worst_slope, fabs(slope - gradient[k]));
      up[k] = down[k] = x[k];
    }
  }
  ok(worst < bound, "%s: the composite is off by at most %.2g", what, worst);
  ok(worst_slope < 1e-6, "%s: the composite's gradient is off by %.2g", what, worst_slope);
}

static void test_composite(void)
{
  struct eo_archive archive;
  struct eo_composite composite;
  struct eo_error error;
  int row[ROWS];
  double x[ROWS * N], value[ROWS];
  fill_archive(&archive, row, x, value);
  struct eo_composite_rows rows = {&archive, ROWS, row, x, value, 0.1, 2, INFINITY};
  ok(eo_composite_init(&composite, &anatomy, N, ROWS, EO_TAIL_LINEAR, &error) == EO_OK &&
         eo_composite_fit(&composite, EO_TAIL_LINEAR, 1e-9, &rows),
     "a composite of linear parts is fitted");
  check_against(&composite, "parts", 1e-8);
  double worst = 0;
  for (int j = 0; j < ROWS; j++)
    worst = fmax(worst, composite.residual[j]);
  ok(worst < 1e-7, "every row that is left out is still known: %.2g", worst);
  ok(eo_composite_takes(&composite, &archive, 0) && !eo_composite_takes(&composite, &archive, ROWS),
     "a row without its parts cannot serve");
  rows.most_rest = -1;
  eo_composite_fit(&composite, EO_TAIL_LINEAR, 1e-9, &rows);
  ok(eo_composite_value(&composite, x) * 2 + 0.1 < value[0] - 1, "a rest is cut off where told");
  eo_composite_done(&composite);
  ok(eo_composite_init(&composite, &none, N, ROWS, EO_TAIL_LINEAR, &error) == EO_OK &&
         eo_composite_fit(&composite, EO_TAIL_LINEAR, 1e-9, &rows),
     "a composite without an anatomy is fitted");
  double most = 0, part[PARTS];
  for (int i = 100; i < 160; i++) {
    double place[N];
    for (int k = 0; k < N; k++)
      place[k] = unit(i, k);
    most = fmax(most, fabs(eo_composite_value(&composite, place) * 2 + 0.1 - value_at(place, part)));
  }
  ok(most > 1e-2, "a surrogate of the same rows rounds their kinks off by %.2g", most);
  ok(eo_composite_takes(&composite, &archive, ROWS), "every row serves a composite without an anatomy");
  eo_composite_done(&composite);
  eo_archive_done(&archive);
}

/* The best value of a search; parts: whether it is told them. */
static double search(bool parts, uint64_t seed, int budget)
{
  struct eo_optimizer_settings settings;
  struct eo_optimizer *optimizer = NULL;
  struct eo_batch batch = {.count = 1};
  struct eo_error error;
  double part[PARTS], best = NAN;
  eo_optimizer_defaults(&settings, EO_CREDIBILITY_GA, N);
  settings.seed = seed;
  settings.true_evaluations = budget;
  if (eo_optimizer_new(&settings, &optimizer, &error))
    return NAN;
  enum eo_code code = parts ? eo_optimizer_describe(optimizer, &anatomy, &error) : EO_OK;
  while (!code && batch.count > 0) {
    code = eo_optimizer_ask(optimizer, &batch, &error);
    for (int i = 0; i < batch.count && !code; i++) {
      const struct eo_outcome outcome = {.value = value_at(batch.candidates[i].x, part), .parts = part};
      code = eo_optimizer_tell(optimizer, i, &outcome, &error);
    }
  }
  if (!code)
    best = eo_optimizer_row(optimizer, eo_optimizer_best(optimizer)).value;
  eo_optimizer_free(optimizer);
  return best;
}

/* The least value: the wave flat, the rivals equal. */
static void test_search(void)
{
  const double x0 = 0.62, x2 = 0.44, x1 = 0.31 - 0.4 * (x2 - 0.5);
  double least = INFINITY, part[PARTS];
  for (int i = 0; i <= 20000; i++)
    least = fmin(least, value_at((double[]){x0, x1, x2, i / 20000.0}, part));
  double with = 0, without = 0;
  for (uint64_t seed = 1; seed <= 5; seed++) {
    with = fmax(with, search(true, seed, 64) - least);
    without += (search(false, seed, 64) - least) / 5;
  }
  ok(with < 2e-4, "64 evaluations with parts come within %.2g of the least value", with);
  ok(without > 10 * with, "64 evaluations without parts come within %.2g on the mean", without);
}

static void test_description(void)
{
  struct eo_optimizer_settings settings;
  struct eo_optimizer *optimizer = NULL;
  struct eo_error error;
  const double x[N] = {0.5, 0.5, 0.5, 0.5};
  eo_optimizer_defaults(&settings, EO_CREDIBILITY_GA, N);
  eo_optimizer_new(&settings, &optimizer, &error);
  ok(eo_optimizer_describe(optimizer, &anatomy, &error) == EO_OK, "a value is described before the first row");
  eo_optimizer_import(optimizer, x, &(struct eo_outcome){.value = 1}, &error);
  ok(eo_optimizer_describe(optimizer, &anatomy, &error) == EO_ERROR_INPUT, "a value is not described behind a row: %s",
     error.text);
  eo_optimizer_free(optimizer);
}

int main(void)
{
  test_reductions();
  test_composite();
  test_search();
  test_description();
  return tap_done();
}

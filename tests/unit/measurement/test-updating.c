/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inputs found again from measurements of a rig whose inputs are known: over many drawn rigs the stated intervals cover
   the truth as often as they say. The coarse pair of the study tests; the measurements are the prediction with noise
   and, in every second rig, an error of the model on each order. */
#include "measurement/updating.h"

#include "base/random.h"
#include "support/study-fixture.h"
#include "support/tap.h"

enum { SHORT = 4, SLOW = 200, MOST_POINTS = 6 };

static struct eo_design design;
static struct eo_geometry geometry;
static struct eo_pair *pair;
static struct eo_evaluator *evaluator;

static double between(struct eo_random random, uint64_t draw, double low, double high)
{
  return low + (high - low) * eo_random_unit(random, draw);
}

static double between_logarithmic(struct eo_random random, uint64_t draw, double low, double high)
{
  return low * pow(high / low, eo_random_unit(random, draw));
}

/* What a rig would measure: amplitudes with the noise of the encoders and the error of the model. */
static bool measure(const struct eo_design *rig, struct eo_random r, uint64_t point, double torque, double rpm,
                    double model_error, struct eo_measured *m)
{
  struct eo_rig_prediction truth;
  double speed = rpm * M_PI / 30, square = 0;
  if (eo_prediction_run(&truth, evaluator, rig, point % 2, torque, speed, EO_RIGHT, 6, &error) || !truth.valid)
    return false;
  *m = (struct eo_measured){.unmodified = point % 2, .torque = torque, .speed = speed, .end = EO_RIGHT, .harmonics = 6};
  for (int h = 0; h < 6; h++) {
    double order = (double)(h + 1) * geometry.teeth[EO_PINION], weight = pow(order * speed, 2), sigma = 2e-9;
    double off = model_error * truth.rms * eo_random_normal(r, 1000 + 20 * point + (uint64_t)h) +
                 weight * sigma * eo_random_normal(r, 2000 + 20 * point + (uint64_t)h);
    double acceleration = fabs(truth.acceleration[h] + off);
    m->order[h] = (struct eo_order_line){
        .order = order, .amplitude = acceleration / weight, .sigma = sigma, .acceleration = acceleration};
    square += acceleration * acceleration / 2;
  }
  m->rms = sqrt(square);
  return true;
}

struct tally {
  int rigs, intervals, covered, determined, several, evaluations;
};

/* One rig: one or two unknown inputs, three to six measurements at torques and speeds of its own. */
static void add_rig(struct tally *tally, uint64_t seed)
{
  struct eo_random r = eo_random_at(77, 0, 0, seed);
  struct eo_measured measured[MOST_POINTS];
  struct eo_design rig = design;
  struct eo_update u;
  int points = 3 + (int)eo_random_index(r, 0, 4);
  struct eo_update_settings settings = {
      .unknowns = 1 + (int)(seed % 2),
      .seed = seed,
      .range = {{EO_UNKNOWN_PINION_BEARING, 2e8, 3e9}, {EO_UNKNOWN_MESH_DAMPING, 0.02, 0.2}}};
  for (int i = 0; i < settings.unknowns; i++) {
    const struct eo_update_range *range = &settings.range[i];
    eo_unknown_set(&rig, range->unknown, between_logarithmic(r, 10 + (uint64_t)i, 1.2 * range->low, range->high / 1.2));
  }
  double model_error = seed / 2 % 2 ? between(r, 20, 0.01, 0.05) : 0;
  for (int i = 0; i < points; i++)
    if (!measure(&rig, r, (uint64_t)i, i < 3 ? 828 : 414, between(r, 30 + (uint64_t)i, 800, 3200), model_error,
                 &measured[i]))
      return;
  if (eo_update_run(&u, pair, &design, points, measured, &settings, NULL, NULL, &error)) {
    printf("# %llu: %s\n", (unsigned long long)seed, error.text);
    return;
  }
  bool determined = true;
  for (int i = 0; i < u.unknowns; i++) {
    const struct eo_updated *p = &u.unknown[i];
    double truth = eo_unknown_get(&rig, p->unknown);
    bool covered = p->confidence[0] <= truth && truth <= p->confidence[1];
    tally->intervals++;
    tally->covered += covered;
    determined = determined && !p->undetermined;
    if (!covered)
      printf(
          "# %llu: %s %.5g in %.5g .. %.5g, in truth %.5g; model error %.3g of %.3g, %d points, %d minima, %d within\n",
          (unsigned long long)seed, eo_unknown_name(p->unknown), p->value, p->confidence[0], p->confidence[1], truth,
          u.model_error, model_error, points, u.minima, u.within);
  }
  tally->rigs++;
  tally->determined += determined;
  tally->several += u.within > 1;
  tally->evaluations += u.evaluations;
}

/* The limits of 200 rigs are 91 to 99 %; a short run leaves its own chance beside them, three standard deviations. */
static void test_coverage(int rigs, int first)
{
  struct tally t = {0};
  for (int i = 0; i < rigs; i++)
    add_rig(&t, (uint64_t)(first + i));
  double covered = 100.0 * t.covered / t.intervals, slack = rigs < SLOW ? 300 * sqrt(0.05 * 0.95 / t.intervals) : 0;
  printf("# %d rigs, %d with several minima within reach, %d evaluations each\n", t.rigs, t.several,
         t.evaluations / (t.rigs ? t.rigs : 1));
  ok(t.rigs == rigs, "%d rigs are drawn, measured and fitted", rigs);
  ok(covered >= 91 - slack && covered <= 99 + slack, "the 95 %% intervals cover the truth in %.1f %% of %d", covered,
     t.intervals);
  ok(t.determined >= 0.9 * t.rigs, "the inputs are determined in %d of %d rigs", t.determined, t.rigs);
}

static int stop_at(void *context, const char *what, double fraction)
{
  double *furthest = context;
  (void)what;
  bool back = fraction < *furthest;
  *furthest = back ? 2 : fraction;
  return back || fraction > 0.4 ? 1 : 0;
}

static void test_cancel(void)
{
  struct eo_measured measured[3];
  struct eo_update u;
  double furthest = 0;
  const struct eo_progress progress = {.report = stop_at, .context = &furthest};
  struct eo_update_settings settings = {
      .unknowns = 1, .seed = 1, .starts = 24, .range = {{EO_UNKNOWN_PINION_BEARING, 2e8, 3e9}}};
  for (int i = 0; i < 3; i++)
    measure(&design, eo_random_at(5, 0, 0, 0), (uint64_t)i, 828, 1000 + 700 * i, 0, &measured[i]);
  enum eo_code code = eo_update_run(&u, pair, &design, 3, measured, &settings, NULL, &progress, &error);
  ok(code == EO_ERROR_CANCELLED && furthest > 0.4 && furthest <= 1,
     "a fit goes forwards and stops when it is told to, at %.2f", furthest);
}

int main(int argc, char **argv)
{
  coarse_design(&design, "ga", 1);
  for (int end = 0; end < 2; end++) {
    struct eo_flank_modification *flank = &design.modification.flank[EO_PINION][end];
    flank->tip_relief = 14e-6;
    flank->tip_relief_start = 1.6e-3;
    flank->root_relief = 17e-6;
    flank->root_relief_start = 3.5e-3;
    flank->lead_crowning = 12e-6;
  }
  pair = coarse_pair();
  if (!pair || eo_design_complete(&design, &geometry, &error) || eo_evaluator_new(&evaluator, pair, 1, &error))
    return 99;
  test_cancel();
  test_coverage(argc > 1 && strcmp(argv[1], "slow") == 0 ? SLOW
                : argc > 1                               ? atoi(argv[1])
                                                         : SHORT,
                argc > 2 ? atoi(argv[2]) : 0);
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return tap_done();
}

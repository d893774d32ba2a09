/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measured beside predicted, and inputs found again from recordings of a rig whose inputs are known. The coarse pair of
   the study tests. */
#include "measurement/comparison.h"
#include "measurement/updating.h"

#include "support/study-fixture.h"
#include "measurement/measurement.h"
#include "measurement/synthetic.h"
#include "numerics/least_squares.h"
#include "support/synthetic-recording.h"
#include "support/tap.h"

enum { POINTS = 6 };

static struct eo_design design;
static struct eo_geometry geometry;
static struct eo_pair *pair;
static struct eo_evaluator *evaluator;

/* A recording of the response of `rig`, through the whole chain; scale: of its amplitudes. */
static bool record(const struct eo_design *rig, bool unmodified, double torque, double rpm, double scale, uint64_t seed,
                   struct eo_measured *measured)
{
  struct eo_rig_prediction truth;
  struct eo_recording *recording = NULL;
  struct eo_tracks tracks;
  struct eo_measurement *m = calloc(1, sizeof *m);
  struct eo_synthetic s = {.speed = rpm * M_PI / 30,
                           .turns = 20,
                           .sample_rate = 350 * rpm / 60,
                           .eccentricity = {15e-6, 25e-6},
                           .noise = 3e-8,
                           .seed = seed};
  struct eo_measurement_settings settings = {.stated_speed = NAN, .transmission = {.harmonics = 6}};
  bool good = m && !eo_prediction_run(&truth, evaluator, rig, unmodified, torque, s.speed, EO_RIGHT, 6, &error) &&
              truth.valid;
  for (int i = 0; i < 2; i++) {
    s.teeth[i] = settings.transmission.teeth[i] = geometry.teeth[i];
    s.base_radius[i] = settings.transmission.base_radius[i] = geometry.base_radius[i];
  }
  s.pinion_share = eo_prediction_pinion_share(&rig->supports, &geometry);
  s.orders = 6;
  for (int h = 0; h < 6; h++)
    s.order[h] = scale * truth.order[h];
  synthetic_tracks(&s, &tracks);
  good = good && !synthetic_record(&s, &recording, &error) &&
         !eo_measurement_run(m, recording, &tracks, &settings, NULL, &error) && !m->refused;
  memset(measured, 0, sizeof *measured);
  if (good)
    eo_measured_take(measured, &m->transmission, &m->findings);
  snprintf(measured->name, sizeof measured->name, "%s-%g-%g", unmodified ? "plain" : "relieved", torque, rpm);
  measured->unmodified = unmodified;
  measured->torque = torque;
  measured->end = EO_RIGHT;
  eo_recording_free(recording);
  if (m)
    eo_measurement_done(m);
  free(m);
  return good;
}

static void test_share(void)
{
  /* 0.879 is the share that the reference recording states for the paper's pair. */
  close_to(eo_prediction_pinion_share(&design.supports, &geometry), 0.879, 1e-3,
           "share of the pinion in the vibration");
}

static void test_comparison(void)
{
  static const double torque[POINTS] = {414, 414, 828, 828, 828, 828},
                      rpm[POINTS] = {2000, 2000, 2000, 2000, 1500, 1500};
  struct eo_measured measured[POINTS];
  struct eo_comparison c;
  double mine[64], theirs[64], worst = 0, size = 0;
  bool good = true;
  for (int i = 0; i < POINTS; i++)
    good = record(&design, i % 2 == 0, torque[i], rpm[i], i == 5 ? 2.5 : 1, (uint64_t)i + 1, &measured[i]) && good;
  if (!ok(good && !eo_comparison_run(&c, evaluator, &design, POINTS, measured, NULL, &error),
          "six recordings are compared"))
    return;
  for (int i = 0; i < POINTS - 1; i++) {
    const struct eo_compared *p = &c.point[i];
    ok(fabs(p->ratio - 1) < 0.01 && p->likeness > 0.999 && !p->outlier,
       "%s: the vibration is %.4f times the prediction, likeness %.5f", measured[i].name, p->ratio, p->likeness);
    eo_comparison_curves(&measured[i], p, 64, mine, theirs);
    for (int k = 0; k < 64; k++) {
      worst = fmax(worst, fabs(mine[k] - theirs[k]));
      size = fmax(size, fabs(mine[k]));
    }
  }
  ok(worst < 0.03 * size, "the curves lie on each other: %.3g of %.3g um", 1e6 * worst, 1e6 * size);
  ok(c.point[5].outlier && fabs(c.point[5].ratio - 2.5) < 0.03 && *c.point[5].reason,
     "the one that is 2.5 times too large is named: %s", c.point[5].reason);
  close_to(c.ratio, 1, 0.01, "median ratio of measured to predicted");
  ok(c.reductions == 3 && c.reduction[0].unmodified == 1, "every modified recording has a reduction: %d", c.reductions);
  ok(fabs(c.reduction[1].measured - c.reduction[1].predicted) < 3 * c.reduction[1].measured_sigma &&
         c.reduction[1].measured_sigma < 0.02,
     "the modification takes %.2f +- %.2f %% at 828 N m, predicted %.2f %%", 100 * c.reduction[1].measured,
     100 * c.reduction[1].measured_sigma, 100 * c.reduction[1].predicted);
  eo_comparison_done(&c);
}

static enum eo_code bent_line(void *context, const double *x, double *residual, struct eo_error *e)
{
  (void)e;
  const double *target = context; /* y = exp(-3 a t) + b */
  for (int i = 0; i < 10; i++)
    residual[i] = exp(-3 * x[0] * i / 10) + x[1] - target[i];
  return EO_OK;
}

static void test_least_squares(void)
{
  double target[10], x[2] = {0.1, 0.9}, jacobian[20];
  struct eo_least_squares_report report;
  const struct eo_least_squares_options options = {60, 1e-6, 1e-9};
  for (int i = 0; i < 10; i++)
    target[i] = exp(-3 * 0.7 * i / 10) + 0.25;
  enum eo_code code = eo_least_squares(bent_line, target, 2, 10, &options, x, jacobian, &report, &error);
  ok(!code && report.converged, "a fit finds two unknowns in %d evaluations", report.evaluations);
  close_to(x[0], 0.7, 1e-6, "the first unknown of the fit");
  close_to(x[1], 0.25, 1e-6, "the second unknown of the fit");
  for (int i = 0; i < 10; i++)
    target[i] = exp(-3 * 0.7 * i / 10) - 0.1;
  ok(!eo_least_squares(bent_line, target, 2, 10, &options, x, jacobian, &report, &error) && x[1] == 0 && x[0] > 0.7,
     "an unknown that would have to be negative stays at its bound");
  ok(eo_least_squares(bent_line, target, 0, 10, &options, x, jacobian, &report, &error) == EO_ERROR_INPUT,
     "a fit of no unknowns is refused");
}

static bool record_some(const struct eo_design *rig, int count, struct eo_measured *measured)
{
  bool good = true;
  for (int i = 0; i < count; i++)
    good = record(rig, i % 2, i < 4 ? 828 : 414, 1200 + 400 * i, 1, (uint64_t)i + 7, &measured[i]) && good;
  return good;
}

static void test_updating(void)
{
  struct eo_measured measured[POINTS];
  struct eo_design rig = design, found;
  struct eo_update u;
  struct eo_update_settings settings = {
      .unknowns = 2,
      .model_error = 0.01,
      .seed = 1,
      .range = {{EO_UNKNOWN_PINION_BEARING, 2e8, 3e9}, {EO_UNKNOWN_MESH_DAMPING, 0.02, 0.2}}};
  rig.supports.bearing_stiffness[EO_PINION] = 4.5e8;
  rig.supports.mesh_damping_ratio = 0.11;
  if (!ok(record_some(&rig, POINTS, measured), "six recordings of a rig with other bearings and damping are made"))
    return;
  enum eo_code code = eo_update_run(&u, pair, &design, POINTS, measured, &settings, &found, NULL, &error);
  ok(code == EO_OK && u.converged && u.after < 1.5 && u.before > 5 * u.after,
     "the fit finds them: misfit %.2f -> %.3f in %d evaluations", u.before, u.after, u.evaluations);
  for (int i = 0; i < 2; i++) {
    double truth = eo_unknown_get(&rig, settings.range[i].unknown);
    ok(fabs(u.unknown[i].value / truth - 1) < 0.03 && u.unknown[i].confidence[0] < truth &&
           truth < u.unknown[i].confidence[1] && !u.unknown[i].undetermined,
       "the fit finds %s: %.4g (%.4g .. %.4g), in truth %.4g", eo_unknown_name(settings.range[i].unknown),
       u.unknown[i].value, u.unknown[i].confidence[0], u.unknown[i].confidence[1], truth);
    ok(eo_unknown_get(&found, settings.range[i].unknown) == u.unknown[i].value,
       "the design that comes with the fit has the unknown");
  }

  /* An impact patch acts nowhere when impacts are no part of the dynamics. */
  settings.range[1] = (struct eo_update_range){EO_UNKNOWN_IMPACT_PATCH, 1e-3, 1e-2};
  settings.starts = 4;
  code = eo_update_run(&u, pair, &design, 2, measured, &settings, NULL, NULL, &error);
  ok(code == EO_OK && u.unknown[1].undetermined && !u.unknown[0].undetermined,
     "the fit says what the data do not tell: %s between %.3g and %.3g mm", eo_unknown_name(u.unknown[1].unknown),
     1e3 * u.unknown[1].confidence[0], 1e3 * u.unknown[1].confidence[1]);

  settings.range[1].unknown = EO_UNKNOWN_PINION_BEARING;
  ok(eo_update_run(&u, pair, &design, 2, measured, &settings, NULL, NULL, &error) == EO_ERROR_INPUT,
     "a fit of the same unknown twice is refused: %s", error.text);
  settings.unknowns = 0;
  ok(eo_update_run(&u, pair, &design, 2, measured, &settings, NULL, NULL, &error) == EO_ERROR_INPUT,
     "a fit of no unknown of a rig is refused: %s", error.text);
}

int main(void)
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
  test_share();
  test_comparison();
  test_least_squares();
  test_updating();
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return tap_done();
}

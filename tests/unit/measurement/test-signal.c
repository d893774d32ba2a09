/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the signal chain, each against a closed form. */
#include "measurement/axis.h"
#include "measurement/beside.h"
#include "measurement/ellipse.h"
#include "measurement/orientation.h"
#include "measurement/pulse_train.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "support/tap.h"

static void test_ellipse(void)
{
  const struct eo_ellipse truth = {.offset = {0.07, -0.11}, .amplitude = {0.55, 0.43}, .skew = -0.21};
  struct eo_ellipse found = {0};
  struct eo_ellipse_sums sums;
  double worst = 0;
  eo_ellipse_start(&sums, (double[]){0, 0}, 1);
  for (int i = 0; i < 200; i++) {
    double a = 2 * M_PI * i / 200;
    eo_ellipse_add(&sums, truth.offset[0] + truth.amplitude[0] * sin(a),
                   truth.offset[1] + truth.amplitude[1] * cos(a - truth.skew));
  }
  ok(eo_ellipse_fit(&sums, &found), "an ellipse is fitted to tracks");
  close_to(found.offset[0], truth.offset[0], 1e-12, "offset of the sine, by the ellipse");
  close_to(found.offset[1], truth.offset[1], 1e-12, "offset of the cosine, by the ellipse");
  close_to(found.amplitude[0], truth.amplitude[0], 1e-12, "amplitude of the sine, by the ellipse");
  close_to(found.amplitude[1], truth.amplitude[1], 1e-12, "amplitude of the cosine, by the ellipse");
  close_to(found.skew, truth.skew, 1e-12, "phase beyond 90 degrees, by the ellipse");
  for (int i = -99; i < 100; i++) {
    double a = M_PI * i / 100;
    worst = fmax(worst, fabs(eo_ellipse_angle(&found, truth.offset[0] + truth.amplitude[0] * sin(a),
                                              truth.offset[1] + truth.amplitude[1] * cos(a - truth.skew)) -
                             a));
  }
  ok(worst < 1e-11, "the angles on the ellipse are right to %.2g rad", worst);
  eo_ellipse_start(&sums, (double[]){0, 0}, 1);
  for (int i = 0; i < 200; i++)
    eo_ellipse_add(&sums, 0.01 * i, 0.02 * i);
  ok(!eo_ellipse_fit(&sums, &found), "a line is no ellipse");
  eo_ellipse_start(&sums, (double[]){0, 0}, 1);
  for (int i = 0; i < 200; i++)
    eo_ellipse_add(&sums, 0.3, 0.2);
  ok(!eo_ellipse_fit(&sums, &found), "a point is no ellipse");
}

/* What an eccentric encoder shows leads back to the angle; what it costs an order is a Bessel function. */
static void test_axis(void)
{
  const struct eo_axis axis = {.sign = -1,
                               .ratio = {1, 17.0 / 44},
                               .share = {1, 0.8},
                               .swing = {{1e-3 * cexp(0.7 * I), 2e-4 * cexp(-2 * I), 1e-4}, {5e-4 * I}}};
  double worst = 0;
  double complex line = 0;
  enum { ROWS = 44 * 1024 }; /* over a hunting period */
  for (int i = 0; i < ROWS; i++) {
    double theta = 44 * 2 * M_PI * i / ROWS,
           swing = eo_axis_swing(&axis, EO_PINION, theta) + 0.8 * eo_axis_swing(&axis, EO_GEAR, theta);
    worst = fmax(worst, fabs(eo_axis_angle(&axis, -(theta + swing)) - theta));
    line += cexp(136 * I * swing) / ROWS;
  }
  ok(worst < 1e-8, "the angle behind a swing of 1e-3 rad is right to %.2g rad", worst);
  close_to(eo_axis_loss(&axis, 136, axis.share), cabs(line), 1e-6, "part of order 136 that is left");
  static const char *const rows[] = {"even rows", "rows that jitter", "rows whose times jitter"};
  struct eo_random random = eo_random_at(8, 0, 0, 0);
  for (int kind = 0; kind < 3; kind++) {
    struct eo_axis_noise *noise = calloc(1, sizeof *noise);
    for (int i = 0; i < 100000 && noise; i++) {
      double jitter = kind ? 0.3 * eo_random_normal(random, (uint64_t)i + 200000) : 0, t = i + (kind == 1 ? jitter : 0);
      eo_axis_noise_add(noise, 1e-4 * (i + jitter),
                        0.01 * t + 1e-7 * t * t + (i > 5000) + 3e-6 * eo_random_normal(random, (uint64_t)i));
    }
    double sigma = eo_axis_noise_sigma(noise);
    ok(fabs(sigma - 3e-6) < 1e-7, "the noise of readings, %s, with a change of speed and a gap, is %.3g", rows[kind],
       sigma);
    free(noise);
  }
}

/* What interpolation leaves of a wave is what it leaves of its samples. */
static void test_interpolation(void)
{
  struct eo_interpolation between = {.points = EO_INTERPOLATION_UNEVEN, .step = 1};
  between.share[3] = 0.5;
  between.share[EO_INTERPOLATION_PLACES] = 0.5;
  const double phase = 2.2, x = 3.5 / EO_INTERPOLATION_PLACES;
  double time[EO_INTERPOLATION_UNEVEN], weight[EO_INTERPOLATION_UNEVEN];
  double complex left = 0;
  for (int i = 0; i < EO_INTERPOLATION_UNEVEN; i++)
    time[i] = i;
  eo_interpolation_weights(EO_INTERPOLATION_UNEVEN, time, 7 + x, weight);
  for (int i = 0; i < EO_INTERPOLATION_UNEVEN; i++)
    left += weight[i] * cexp(I * phase * i) / cexp(I * phase * (7 + x));
  double complex gain = eo_interpolation_gain(&between, phase);
  ok(cabs(gain - 0.5 - 0.5 * left) < 1e-12 && creal(gain) < 0.999, "values between samples keep %.4f of a wave",
     creal(gain));
  between.points = EO_INTERPOLATION_EVEN;
  ok(cabs(eo_interpolation_gain(&between, phase) - 1) < cabs(gain - 1) / 3, "a longer polynomial keeps more of a wave");
  between.step = 0;
  ok(eo_interpolation_gain(&between, phase) == 1, "a wave is kept where nothing is interpolated");
}

static void test_nearest(void)
{
  const int teeth[2] = {17, 44};
  int found[2];
  ok(eo_orientation_nearest(17.0 / 43, 1e-5, teeth, found) && found[0] == 17 && found[1] == 43,
     "a gear of one tooth too few is told");
  ok(eo_orientation_nearest(19.0 / 44, 1e-5, teeth, found) && found[0] == 19 && found[1] == 44,
     "a pinion of two teeth too many is told");
  ok(eo_orientation_nearest(23.0 / 59, 1e-6, teeth, found) && found[0] == 23 && found[1] == 59,
     "teeth of another pair are told");
  ok(!eo_orientation_nearest(M_PI / 8, 1e-9, teeth, found), "a ratio of no teeth is told");
}

/* Noise of known size: its standard deviation per amplitude is s sqrt(2 / n). */
static void test_noise(void)
{
  enum { ROWS = 8000 };
  const int teeth[2] = {17, 44};
  struct eo_beside *beside = malloc(sizeof *beside);
  double sum = 0;
  for (int trial = 0; trial < 10 && beside; trial++) {
    eo_beside_init(beside, teeth, 8, 20);
    for (int i = 0; i < ROWS; i++)
      eo_beside_add(beside, 40 * M_PI * i / ROWS,
                    1e-7 * eo_random_normal(eo_random_at(3, 0, 0, (uint64_t)trial), (uint64_t)i));
    for (int h = 0; h < 8; h++)
      sum += eo_beside_sigma(beside, h, 1e-7) / (1e-7 * sqrt(2.0 / ROWS)) / 80;
  }
  ok(sum > 0.95 && sum < 1.1, "the band of white noise is %.3f of its standard deviation on average", sum);
  eo_beside_init(beside, teeth, 8, 20);
  for (int i = 0; i < ROWS; i++) {
    double theta = 40 * M_PI * i / ROWS;
    eo_beside_add(beside, theta, 1e-6 * cos(18 * theta - 0.4));
  }
  double complex sideband = eo_beside_sideband(beside, 0, EO_PINION, 1);
  ok(cabs(sideband - 1e-6 * cexp(-0.4 * I)) < 1e-12 && cabs(eo_beside_sideband(beside, 0, EO_PINION, -1)) < 1e-12,
     "a sideband one turn above the first mesh order is named");
  free(beside);
}

/* The RMS of noise alone, its expected part taken off. */
static void test_rms(void)
{
  int inside = 0, small_inside = 0;
  for (int trial = 0; trial < 1000; trial++) {
    struct eo_order_line line[8], weak[8];
    struct eo_random random = eo_random_at(5, 0, 0, (uint64_t)trial);
    double truth = 0, weak_truth = 0, sigma;
    for (int h = 0; h < 8; h++) {
      double complex noise =
          1e-8 * (eo_random_normal(random, (uint64_t)(2 * h)) + I * eo_random_normal(random, (uint64_t)(2 * h + 1)));
      line[h] = (struct eo_order_line){.order = 17 * (h + 1), .amplitude = 1e-7 / (h + 1) + noise, .sigma = 1e-8};
      weak[h] = (struct eo_order_line){.order = 17 * (h + 1), .amplitude = 1e-9 / (h + 1) + noise, .sigma = 1e-8};
      truth += pow(1e-7 / (h + 1) * pow(line[h].order * 200, 2), 2) / 2;
      weak_truth += pow(1e-9 / (h + 1) * pow(line[h].order * 200, 2), 2) / 2;
    }
    double rms = eo_transmission_rms(line, 8, 200, &sigma);
    inside += fabs(rms - sqrt(truth)) <= 2 * sigma;
    rms = eo_transmission_rms(weak, 8, 200, &sigma);
    small_inside += fabs(rms - sqrt(weak_truth)) <= 2 * sigma;
  }
  ok(inside >= 940, "the truth stands within two standard deviations of an RMS above the noise in %.1f %%",
     inside / 10.0);
  ok(small_inside >= 940, "the truth stands within two standard deviations of an RMS below the noise in %.1f %%",
     small_inside / 10.0);
}

static void check_train(const double *time, int count, int64_t kept, enum eo_severity worst, const char *words,
                        const char *what)
{
  struct eo_recording *recording = NULL;
  struct eo_pulse_train train = {0};
  struct eo_findings findings = {0};
  struct eo_error error;
  const struct eo_tracks tracks = {.time_scale = 1, .channel = {{.lines = 100}}};
  bool made = !eo_recording_new(&recording, 1, NULL, &error) && !eo_recording_append(recording, time, count, &error) &&
              !eo_pulse_train_make(&train, recording, &tracks, 0, NULL, &error);
  if (made)
    eo_pulse_train_judge(&train, 0, &findings);
  ok(made && train.count == kept && findings.count > 0 && findings.finding[0].severity == worst &&
         strstr(findings.finding[0].text, words),
     "%s: the train has %lld pulses, %s", what, (long long)train.count, findings.count ? findings.finding[0].text : "");
  eo_pulse_train_done(&train);
  eo_recording_free(recording);
}

/* What stands behind the pulses of the shorter column is none of them; times that go back are not taken for doubles. */
static void test_pulse_order(void)
{
  double time[400];
  for (int way = 0; way < 4; way++) {
    for (int i = 0; i < 400; i++)
      time[i] = 1 + 0.01 * (i < 300 || way > 1 ? i : 299) - (way == 3 && i >= 100 ? 2.68 : 0);
    for (int i = 300; i < 400 && way == 0; i++)
      time[i] = 0;
    if (way == 2)
      time[100] = 1.96;
    check_train(
        time, 400, (int[]){300, 300, 399, 132}[way],
        (enum eo_severity[]){EO_SEVERITY_NOTE, EO_SEVERITY_NOTE, EO_SEVERITY_REPAIRED, EO_SEVERITY_REFUSED}[way],
        way < 2    ? "From row 301 on"
        : way == 2 ? "1 pulses"
                   : "16, 24 or 32 bits",
        (const char *[]){"zeros behind the last pulse", "the last pulse again and again", "one pulse out of order",
                         "a counter that starts again"}[way]);
  }
}

/* An angle that starts again after a turn and is zeroed in between has one turn all the same. */
static void test_zeroed_turns(void)
{
  const struct eo_tracks tracks = {
      .time_column = -1, .time_scale = 1, .interval = 1e-3, .channel = {{.column = {0}}, {.column = {1}}}};
  struct eo_recording *recording = NULL;
  struct eo_scan *scan = calloc(1, sizeof *scan);
  struct eo_error error;
  bool made = scan && !eo_recording_new(&recording, 2, NULL, &error);
  for (int i = 0; i < 5000 && made; i++) {
    double row[2] = {fmod(100 + 1.5 * i, 360) - (i < 2500 ? 0 : 123.4), 0.6 * i};
    made = !eo_recording_append(recording, row, 1, &error);
  }
  made = made && !eo_scan_run(scan, recording, &tracks, NULL, &error);
  close_to(made ? eo_scan_period(&scan->column[0][0], 360) : NAN, 360, 1e-9, "turn of an angle that was zeroed");
  ok(made && isnan(eo_scan_period(&scan->column[1][0], 360)), "an angle that goes on has no turn");
  eo_recording_free(recording);
  free(scan);
}

int main(void)
{
  test_ellipse();
  test_axis();
  test_interpolation();
  test_nearest();
  test_noise();
  test_rms();
  test_pulse_order();
  test_zeroed_turns();
  return tap_done();
}

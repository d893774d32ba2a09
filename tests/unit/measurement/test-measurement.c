/* Synthetic recordings of known truth through the whole chain: the truth stands within the stated uncertainty, and
   every fault is found. */
#include "measurement/measurement.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "measurement/synthetic.h"
#include "support/tap.h"

static struct eo_error error;
static struct eo_measurement measurement;

/* The paper's pair: 17 and 44 teeth, base radii of module 6 mm, helix 24, pressure angle 20 degrees. */
static const int teeth[2] = {17, 44};
static const double radius[2] = {0.0517783, 0.134014};

static struct eo_synthetic usual(void)
{
  static const double amplitude[8] = {0.9, 0.25, 0.1, 0.05, 0.03, 0.03, 0.03, 0.01},
                      phase[8] = {0.3, 1.1, -0.7, 2, 0, -2.2, 0.9, 1.7};
  struct eo_synthetic s = {.teeth = {17, 44},
                           .base_radius = {0.0517783, 0.134014},
                           .orders = 8,
                           .pinion_share = 0.879,
                           .speed = 2000 * M_PI / 30,
                           .turns = 44.4,
                           .sample_rate = 20000,
                           .eccentricity = {20e-6, 30e-6},
                           .noise = 2e-8,
                           .lines = {18000, 18000},
                           .amplitude = 0.5,
                           .seed = 1};
  for (int h = 0; h < 8; h++)
    s.order[h] = 1e-6 * amplitude[h] * cexp(I * phase[h]);
  return s;
}

static const struct eo_measurement *measure_stated(const struct eo_synthetic *s, double stated)
{
  struct eo_recording *recording = NULL;
  struct eo_tracks tracks;
  const struct eo_measurement_settings settings = {
      .transmission = {.teeth = {teeth[0], teeth[1]}, .base_radius = {radius[0], radius[1]}}, .stated_speed = stated};
  eo_measurement_done(&measurement);
  memset(&measurement, 0, sizeof measurement);
  eo_synthetic_tracks(s, &tracks);
  if (eo_synthetic_record(s, &recording, &error) ||
      eo_measurement_run(&measurement, recording, &tracks, &settings, NULL, &error))
    printf("# %s\n", error.text);
  eo_recording_free(recording);
  return &measurement;
}

static const struct eo_measurement *measure(const struct eo_synthetic *s)
{
  return measure_stated(s, NAN);
}

static void show(const struct eo_measurement *m)
{
  for (int i = 0; i < m->findings.count && i < EO_MAX_FINDINGS; i++)
    printf("#   %s %s row %lld: %s\n", eo_severity_name(m->findings.finding[i].severity),
           eo_finding_name(m->findings.finding[i].kind), (long long)m->findings.finding[i].row,
           m->findings.finding[i].text);
}

/* ---- truth ---- */

static double between(struct eo_random random, uint64_t draw, double low, double high)
{
  return low + (high - low) * eo_random_unit(random, draw);
}

static struct eo_synthetic drawn(int seed)
{
  static const int lines[] = {1024, 2048, 5000, 9000, 18000, 36000};
  struct eo_random r = eo_random_at(2016, 0, 0, (uint64_t)seed);
  struct eo_synthetic s = usual();
  s.seed = (uint64_t)seed + 10;
  for (int h = 0; h < 8; h++)
    s.order[h] = 1e-6 * pow(10, between(r, 10 + (uint64_t)h, -1, 0.5)) / pow(h + 1, 1.5) *
                 cexp(2 * M_PI * I * between(r, 20 + (uint64_t)h, 0, 1));
  s.pinion_share = between(r, 0, 0, 1);
  s.speed = pow(10, between(r, 1, 2.5, 3.5)) * M_PI / 30;
  s.sample_rate = s.speed / (2 * M_PI) * between(r, 2, 340, 480);
  s.turns = between(r, 3, 14, 24);
  s.eccentricity[0] = 1e-6 * between(r, 4, 0, 60);
  s.eccentricity[1] = 1e-6 * between(r, 5, 0, 60);
  s.noise = pow(10, between(r, 6, -8, -6));
  if (seed % 2)
    s.drift = between(r, 7, -0.015, 0.015);
  if (seed % 3 == 0) {
    s.swing = between(r, 8, 0, 0.006);
    s.swing_turns = between(r, 9, 40, 100);
  }
  if (seed % 3 == 1)
    s.jitter = 1e-7 / s.speed * between(r, 30, 0, 300);
  if (seed % 4 == 2)
    s.skew = 1e-7 / s.speed * between(r, 31, 0, 20);
  if (seed % 5 < 3) {
    s.lines[0] = lines[eo_random_index(r, 32, 6)];
    s.lines[1] = lines[eo_random_index(r, 33, 6)];
    s.interpolation = seed % 5 == 0 ? 1024 : seed % 5 == 1 ? 64 : 4;
  }
  s.wrapped = seed % 7 == 0;
  return s;
}

static void check_truth(int seeds)
{
  int inside = 0, one = 0, refused = 0, lines = 0, lines_inside = 0;
  double squares = 0;
  for (int seed = 0; seed < seeds; seed++) {
    struct eo_synthetic s = drawn(seed);
    const struct eo_measurement *m = measure(&s);
    const struct eo_transmission *t = &m->transmission;
    double truth = eo_synthetic_rms(&s, t->harmonics), off = fabs(t->rms - truth);
    refused += m->refused || t->harmonics != 8;
    inside += !m->refused && off <= 2 * t->rms_sigma;
    one += !m->refused && off <= t->rms_sigma;
    if (m->refused || off > 2 * t->rms_sigma) {
      printf("# seed %d: RMS %.4f, truth %.4f, standard deviation %.4f; lines %d %d x %d\n", seed, t->rms, truth,
             t->rms_sigma, s.lines[0], s.lines[1], s.interpolation);
      show(m);
    }
    for (int h = 0; h < t->harmonics; h++) {
      double amplitude = cabs(t->mesh[h].amplitude), deviation = fabs(amplitude - cabs(s.order[h]));
      lines++;
      lines_inside += deviation <= 2 * t->mesh[h].sigma + 0.003 * cabs(s.order[h]);
    }
    squares += pow(off / t->rms_sigma, 2) / seeds;
  }
  printf(
      "# %d of %d within one, %d within two standard deviations, root mean square %.3f of one; %d of %d amplitudes\n",
      one, seeds, inside, sqrt(squares), lines_inside, lines);
  ok(refused == 0, "no sound recording is refused or cut short (%d of %d)", refused, seeds);
  ok(inside >= 0.95 * seeds, "the true RMS stands within twice the stated standard deviation in %d of %d recordings",
     inside, seeds);
  ok(one >= 0.6 * seeds, "within once in %d", one);
  ok(lines_inside >= 0.95 * lines,
     "%d of %d amplitudes of orders within two standard deviations of their noise and 0.3 %%", lines_inside, lines);
}

/* ---- faults ---- */

static void check_clean(const struct eo_synthetic *s, const char *what)
{
  const struct eo_measurement *m = measure(s);
  int worse = eo_findings_worst(&m->findings) > EO_SEVERITY_NOTE;
  double truth = eo_synthetic_rms(s, 8);
  ok(!worse && fabs(m->transmission.rms / truth - 1) < 2e-3, "%s: RMS %.4f, truth %.4f, nothing to complain of", what,
     m->transmission.rms, truth);
  if (worse)
    show(m);
}

static void check_fault(struct eo_synthetic s, enum eo_synthetic_fault fault, int64_t row, int64_t size,
                        enum eo_finding_kind kind, bool refuses, int64_t at, const char *what)
{
  s.fault = fault;
  s.row = row;
  s.size = size;
  const struct eo_measurement *m = measure(&s);
  const struct eo_finding *f = eo_findings_find(&m->findings, kind);
  double truth = eo_synthetic_rms(&s, 8);
  bool good = f && m->refused == refuses && (at < 0 || llabs(f->row - at) <= 1) &&
              (refuses || fabs(m->transmission.rms / truth - 1) < 3e-3);
  ok(good, "%s is found%s", what, refuses ? " and refused" : " and repaired");
  printf("#   %s\n", f ? f->text : "(not found)");
  if (!good) {
    printf("#   RMS %.4f, truth %.4f, row %lld\n", m->transmission.rms, truth, f ? (long long)f->row : -1);
    show(m);
  }
}

static void check_faults(void)
{
  struct eo_synthetic s = usual(), wrapped = s, raw = s, counts = s, pulses = s, radians = s;
  wrapped.wrapped = true;
  radians.radians = true;
  raw.output = EO_SYNTHETIC_SINE_COSINE;
  raw.lines[0] = raw.lines[1] = 250;
  raw.offset = 0.05;
  raw.gain = 0.1;
  raw.phase = 0.1;
  counts.output = EO_SYNTHETIC_COUNTS;
  counts.interpolation = 4096;
  pulses.output = EO_SYNTHETIC_PULSES;
  pulses.lines[0] = 1024;
  pulses.lines[1] = 2500;
  pulses.noise = 0;
  check_clean(&s, "angles");
  check_clean(&wrapped, "wrapped angles");
  check_clean(&radians, "radians");
  check_clean(&raw, "raw tracks with errors");
  check_clean(&counts, "counts");
  check_clean(&pulses, "pulse times");
  check_fault(s, EO_FAULT_SWAPPED, 0, 0, EO_FINDING_SWAPPED, false, -1, "an exchange of the channels");
  check_fault(raw, EO_FAULT_SWAPPED, 0, 0, EO_FINDING_SWAPPED, false, -1, "an exchange of raw channels");
  check_fault(s, EO_FAULT_REVERSED, 0, 0, EO_FINDING_REVERSED, false, -1, "a reversed sign");
  check_fault(wrapped, EO_FAULT_REVERSED, 0, 0, EO_FINDING_REVERSED, false, -1, "a reversed sign of wrapped angles");
  check_fault(s, EO_FAULT_TEETH, 0, -1, EO_FINDING_TEETH, true, -1, "a wrong number of teeth");
  check_fault(wrapped, EO_FAULT_RADIANS, 0, 0, EO_FINDING_UNITS, false, -1, "radians under degrees, wrapped,");
  check_fault(s, EO_FAULT_RADIANS, 0, 0, EO_FINDING_UNITS, false, -1, "radians under degrees, not wrapped,");
  check_fault(s, EO_FAULT_RADIANS_GEAR, 0, 0, EO_FINDING_UNITS, false, -1, "radians under degrees in one channel");
  check_fault(s, EO_FAULT_DROPPED, 10000, 37, EO_FINDING_DROPPED, false, 10000, "a gap in time");
  check_fault(s, EO_FAULT_DROPPED_SILENT, 10000, 7, EO_FINDING_DROPPED, false, 10000, "a gap that time hides");
  check_fault(wrapped, EO_FAULT_DROPPED_SILENT, 12287, 1, EO_FINDING_DROPPED, false, 12287, "one row that time hides");
  check_fault(s, EO_FAULT_SLIP, 13337, 1, EO_FINDING_SLIP, true, 13337, "a slip of one row");
  check_fault(wrapped, EO_FAULT_SLIP, 4096, 20, EO_FINDING_SLIP, true, 4096, "a slip of twenty rows");
  check_fault(s, EO_FAULT_LOST_COUNT, 13000, 1, EO_FINDING_SLIP, true, 13000, "a line lost in one channel");
  check_fault(s, EO_FAULT_CONSTANT, 0, 0, EO_FINDING_CONSTANT, true, -1, "a constant channel");
  check_fault(s, EO_FAULT_STUCK, 9000, 0, EO_FINDING_CONSTANT, true, 9000, "a channel that stops");
  check_fault(raw, EO_FAULT_CONSTANT, 0, 0, EO_FINDING_CONSTANT, true, -1, "a constant raw channel");
  check_fault(s, EO_FAULT_TIME, 9000, 10, EO_FINDING_TIME, false, 9000, "time that runs back");
  check_fault(s, EO_FAULT_NAN, 9000, 5, EO_FINDING_NAN, false, 9000, "rows without numbers");
  check_fault(s, EO_FAULT_SPIKE, 9000, 1, EO_FINDING_SPIKE, false, 9000, "a value far off");
}

static void check_limits(void)
{
  struct eo_synthetic s = usual(), raw = s;
  s.turns = 2.5;
  ok(measure(&s)->refused && eo_findings_find(&measurement.findings, EO_FINDING_TOO_SHORT), "2.5 turns are too few");
  s = usual();
  s.turns = 9;
  ok(!measure(&s)->refused && eo_findings_find(&measurement.findings, EO_FINDING_TOO_SHORT), "9 turns are few");
  s = usual();
  s.drift = 0.08;
  ok(!measure(&s)->refused && eo_findings_find(&measurement.findings, EO_FINDING_UNSTEADY),
     "8 %% of speed from start to end is not steady");
  show(&measurement);
  s = usual();
  s.sample_rate = 6000;
  ok(!measure(&s)->refused && eo_findings_find(&measurement.findings, EO_FINDING_SAMPLE_RATE) &&
         measurement.transmission.harmonics == 4,
     "6 kHz carry four mesh orders at 2000 rpm");
  s.sample_rate = 1000;
  ok(measure(&s)->refused && eo_findings_find(&measurement.findings, EO_FINDING_SAMPLE_RATE), "1 kHz carry none");
  show(&measurement);
  s = usual();
  ok(eo_findings_find(&measure_stated(&s, 1500 * M_PI / 30)->findings, EO_FINDING_SPEED) != NULL,
     "2000 rpm are not the stated 1500");
  raw.output = EO_SYNTHETIC_SINE_COSINE;
  raw.lines[0] = raw.lines[1] = 250;
  raw.phase = 0.3;
  raw.gain = 0.4;
  raw.amplitude = 0.7;
  const struct eo_measurement *m = measure(&raw);
  int tracks = 0;
  for (int i = 0; i < m->findings.count; i++)
    tracks += m->findings.finding[i].kind == EO_FINDING_TRACK && m->findings.finding[i].severity == EO_SEVERITY_WARNING;
  ok(tracks == 8 && fabs(m->transmission.rms / eo_synthetic_rms(&raw, 8) - 1) < 2e-3,
     "amplitude, ratio and phase of raw tracks beyond their limits: %d warnings, and corrected", tracks);
  close_to(m->ellipse[1].skew, 0.3, 1e-5, "phase of the tracks");
  close_to(m->ellipse[1].amplitude[0] / m->ellipse[1].amplitude[1], 1.4, 1e-5, "ratio of the tracks");
  raw = usual();
  raw.output = EO_SYNTHETIC_SINE_COSINE;
  raw.lines[0] = raw.lines[1] = 250;
  raw.fault = EO_FAULT_SATURATED;
  ok(eo_findings_find(&measure(&raw)->findings, EO_FINDING_SATURATED) != NULL, "tracks that are cut off");
}

/* (24) as printed pairs the radii the wrong way round: the signal is plausible and wrong. */
static void check_printed_radii(void)
{
  struct eo_synthetic s = usual();
  struct eo_recording *recording = NULL;
  struct eo_tracks tracks;
  const struct eo_measurement_settings settings = {
      .transmission = {.teeth = {teeth[0], teeth[1]}, .base_radius = {radius[1], radius[0]}}, .stated_speed = NAN};
  s.pinion_share = 0.879;
  eo_synthetic_tracks(&s, &tracks);
  eo_synthetic_record(&s, &recording, &error);
  eo_measurement_done(&measurement);
  eo_measurement_run(&measurement, recording, &tracks, &settings, NULL, &error);
  close_to(measurement.transmission.rms / eo_synthetic_rms(&s, 8),
           0.879 * radius[1] / radius[0] + 0.121 * radius[0] / radius[1], 2e-3,
           "times the true RMS with the radii exchanged, as their shares say");
  eo_recording_free(recording);
}

int main(void)
{
  check_faults();
  check_limits();
  check_printed_radii();
  check_truth(205);
  eo_measurement_done(&measurement);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recordings whose channels have clocks of their own, times in every unit, counters and square waves: the right angles
   on one clock, or a question. */
#include "support/known-run.h"

static void test_clocks(void)
{
  FILE *f = begin("Time Pinion [s];Pinion [deg];Time Gear [s];Gear [deg]\n");
  for (int i = 0; i < ROWS; i++) {
    double t = i / 4000.0, u = i / 3300.0;
    fprintf(f, "%.9f;%.12g;%.9f;%.12g\n", t, degrees(pinion(t)), u, degrees(gear(u)));
  }
  right(f, NULL, 2e-6, "times of their own", "two rates");
  f = begin("t1 [s];t2 [s];phi1 [deg];phi2 [deg]\n");
  for (int i = 0; i < ROWS; i++) {
    double t = i / 4000.0, u = t + 1.25e-4;
    fprintf(f, "%.9f;%.9f;%.12g;%.12g\n", t, u, degrees(pinion(t)), degrees(gear(u)));
  }
  right(f, NULL, 1e-7, "times of their own", "half a step, times before both channels");
  f = begin("timestamps,pinion_deg,gear_deg\n");
  for (int i = 0; i < ROWS; i++) {
    double t = i / 4000.0, u = t + 1e-4;
    fprintf(f, "%.9f,%.12g,\n%.9f,,%.12g\n", t, degrees(pinion(t)), u, degrees(gear(u)));
  }
  right(f, NULL, 1e-7, "times of their own", "one column of times for both rasters");
  f = begin("Rate pinion: 4 kHz\nRate gear: 3300 Hz\npinion [deg];gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.12g;%.12g\n", degrees(pinion(i / 4000.0)), degrees(gear(i / 3300.0)));
  right(f, NULL, 2e-6, "times of their own", "two rates in the heading");
}

static void table(FILE *f, double unit, double start, const char *format)
{
  for (int i = 0; i < ROWS; i++) {
    double t = i / 4000.0;
    fprintf(f, format, (start + t) / unit);
    fprintf(f, ";%.12g;%.12g\n", degrees(pinion(t)), degrees(gear(t)));
  }
}

static void test_times(void)
{
  const char *header = "Time;Pinion [deg];Gear [deg]\n";
  FILE *f = begin(header);
  table(f, 1e-3, 0, "%.2f");
  right(f, NULL, 1e-6, "read in milliseconds", "milliseconds that nobody states");
  f = begin("Time [s];Pinion [deg];Gear [deg]\n");
  table(f, 1e-3, 0, "%.2f");
  asked(f, NULL, "/time_unit", "a hundred times away", "a speed that no load case has");
  struct eo_layout_choice chosen = {.time_scale = 1e-3};
  f = begin("Time [s];Pinion [deg];Gear [deg]\n");
  table(f, 1e-3, 0, "%.2f");
  right(f, &chosen, 1e-6, "steps of 0.00025 s", "milliseconds by the answer to the question");
  f = begin("Time [s];Pinion [deg];Gear [deg]\n");
  table(f, 1, 0, "%.3f");
  right(f, NULL, 2e-3, "the rows count", "times that only tell milliseconds");
  f = begin(header);
  table(f, 86400, 45356 * 86400.0, "%.11f");
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  struct eo_recording *r = find(f, NULL, &tracks, &notes, &error);
  ok(r && fabs(tracks.interval / 2.5e-4 - 1) < 1e-6 && noted(&notes, "in days"),
     "days of a spreadsheet are read in steps of %.9g s%s", r ? tracks.interval : NAN, r ? "" : error.text);
  eo_recording_free(r);
}

/* Seconds in whole numbers: rows that are lost in one of them do not slow the others down. */
static void test_lost_rows(void)
{
  FILE *f = begin("Time [s];Pinion [deg];Gear [deg]\n");
  for (int i = 0; i < 6 * ROWS; i++)
    if (i < 9000 || i >= 9030)
      fprintf(f, "%d;%.12g;%.12g\n", (i + 700) / 2000, degrees(pinion(i / 2000.0)), degrees(gear(i / 2000.0)));
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  struct eo_recording *r = find(f, NULL, &tracks, &notes, &error);
  ok(r && fabs(tracks.interval / 5e-4 - 1) < 1e-9 && noted(&notes, "In 1 of 11 steps of the time rows were lost"),
     "seconds that stand for 2000 rows each, but one of them for 1970, tell steps of %.9g s%s",
     r ? tracks.interval : NAN, r ? "" : error.text);
  eo_recording_free(r);
}

static void test_units(void)
{
  FILE *f = begin("t [s];Pinion [foo];Gear [foo]\n");
  table(f, 1, 0, "%.6f");
  asked(f, NULL, "/unit", "\"foo\"", "a unit that is stated and not known");
  f = begin("t [s];Pinion [V];Gear [V]\n");
  table(f, 1, 0, "%.6f");
  asked(f, NULL, "/unit", "no angle", "a voltage in place of an angle");
}

static void test_columns(void)
{
  FILE *f = begin("");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%d,%.6f,%.12g,%.12g\n", i, i / 4000.0, degrees(pinion(i / 4000.0)), degrees(gear(i / 4000.0)));
  right(f, NULL, 1e-6, "column 2 is taken as time", "a column that counts the rows");
  f = begin("t;M1;M2;n1;q;phi1;phi2\n");
  for (int i = 0; i < ROWS; i++) {
    double t = i / 4000.0;
    fprintf(f, "%.6f;%.3f;%.3f;600.0;%.4f;%.12g;%.12g\n", t, 828 + t, -2143 - t, sin(300 * t), degrees(pinion(t)),
            degrees(gear(t)));
  }
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  struct eo_recording *r = find(f, NULL, &tracks, &notes, &error);
  ok(r && tracks.channel[0].column[0] == 5 && tracks.channel[1].column[0] == 6,
     "two columns that turn in the ratio of the teeth are the encoders");
  ok(r && tracks.torque[0].column == 1 && tracks.torque[0].scale == 1 && !tracks.torque[0].stated &&
         tracks.torque[1].column == 2 && tracks.speed[0].column == 3 && tracks.speed[1].scale == 0,
     "torque and speed are found beside the encoders");
  eo_recording_free(r);
}

static void test_counters(void)
{
  const double lines = 7.2e6;
  struct eo_layout_choice counts = {.unit = EO_LAYOUT_COUNT, .lines = {lines, lines}};
  FILE *f = begin("t [s];Pinion increments;Gear increments\n");
  for (int i = 0; i < ROWS; i++) {
    double t = i / 4000.0, before = t - 1 / 4000.0, k = lines / (2 * M_PI);
    fprintf(f, "%.6f;%.0f;%.0f\n", t, floor(pinion(t) * k) - floor(pinion(before) * k),
            floor(gear(t) * k) - floor(gear(before) * k));
  }
  right(f, &counts, 1e-5, "summed up", "counts since the row before");
  f = begin("Encoder resolution: 7200000 counts/rev\nt [s];Pinion [counts];Gear [counts]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.6f;%.0f;%.0f\n", i / 4000.0, floor(pinion(i / 4000.0) * lines / (2 * M_PI)),
            floor(gear(i / 4000.0) * lines / (2 * M_PI)));
  right(f, NULL, 1e-5, "of the pinion in counts", "counts per turn in the heading");
  f = begin("t [s];Pinion [counts];Gear [counts]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.6f;%.0f;%.0f\n", i / 4000.0, floor(pinion(i / 4000.0) * lines), floor(gear(i / 4000.0) * lines));
  asked(f, NULL, "/lines", "counts per turn", "counts without counts per turn");
}

static void squares_of(FILE *f, double rate, int tracks, const char *low, const char *high)
{
  for (int i = 0; i < 20000; i++) {
    double t = i / rate, phase[2] = {pinion(t) * 60 / (2 * M_PI), gear(t) * 60 / (2 * M_PI)};
    fprintf(f, "%.7f", t);
    for (int m = 0; m < 2; m++)
      for (int k = 0; k < tracks; k++) {
        double p = phase[m] - 0.25 * k;
        fprintf(f, ";%s", p - floor(p) < 0.5 ? high : low);
      }
    fputc('\n', f);
  }
}

static void squares(FILE *f, double rate, int tracks)
{
  squares_of(f, rate, tracks, "0.1", "4.9");
}

static void test_headings(void)
{
  struct eo_notes notes = {0};
  struct eo_error error = {0};
  FILE *f = begin("Channel;pinion;gear\nUnit;deg;deg\nStart time [s];0.000000;0.0123\nSample rate [Hz];4000;3990.7\n");
  for (int i = 0; i < 200; i++)
    fprintf(f, "%.9f;%.9f\n", 0.9 * i, 0.9 * 17 / 44 * (i * 4000 / 3990.7));
  fclose(f);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  struct eo_clock pinion = r ? eo_recording_clock(r, 0) : (struct eo_clock){0},
                  gear = r ? eo_recording_clock(r, 1) : (struct eo_clock){0};
  ok(r && fabs(pinion.interval * 4000 - 1) < 1e-12 && pinion.start == 0 && fabs(gear.interval * 3990.7 - 1) < 1e-12 &&
         gear.start == 0.0123 && !strcmp(eo_recording_unit(r, 1), "deg"),
     "rates and starts of channels are read from a heading with a column of keys: %.9g s from %.9g s%s", gear.interval,
     gear.start, error.text);
  eo_recording_free(r);
}

/* A separator behind the last number of a line of keys is no further cell. */
static void test_key_column(void)
{
  struct eo_notes notes = {0};
  struct eo_error error = {0};
  FILE *f = begin("key;pinion;gear\nDelta_X;0.00025;0.0005;\n");
  for (int i = 0; i < 200; i++)
    fprintf(f, "%d;%.9f;%.9f\n", i, 0.9 * i, 0.9 * 17 / 44 * i);
  fclose(f);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_clock(r, 1).interval == 0.00025 && eo_recording_clock(r, 2).interval == 0.0005,
     "numbers of a line of keys that ends with a separator stand over their columns%s", error.text);
  eo_recording_free(r);
}

/* A program that writes some rows twice, their times too, leaves times that stand as those of a coarse clock do. */
static void test_repeated_rows(void)
{
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  FILE *f = begin("t_s;pinion_deg;gear_deg\n");
  for (int i = 0; i < 4000; i++)
    for (int twice = 0; twice < 1 + (i % 49 == 0); twice++)
      fprintf(f, "%.6f;%.9f;%.9f\n", 2.5e-4 * i, 0.9 * i, 0.9 * 17 / 44 * i);
  struct eo_recording *r = find(f, NULL, &tracks, &notes, &error);
  ok(r && tracks.time_column == 0 && !noted(&notes, "only tells"), "the times of rows that are there twice count%s",
     r ? "" : error.text);
  eo_recording_free(r);
}

/* A logic analyser lists the changes of its channels: 60 lines per turn of either shaft, few rows per line. */
static void check_changes(void)
{
  struct eo_layout_choice lines = {.lines = {60, 60}};
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  double turns = SPEED / (2 * M_PI), first = 1 / (120 * turns), row[2], worst = 0;
  FILE *f = begin("Time [s],Channel 0,Channel 1\n0.000000000,0,0\n");
  for (int64_t edge[2] = {1, 1}; edge[0] < 4000;) {
    double at[2] = {(double)edge[0] * first, (double)edge[1] * first * 44 / 17};
    int next = at[1] < at[0];
    edge[next]++;
    fprintf(f, "%.9f,%d,%d\n", at[next], (int)((edge[0] - 1) % 2), (int)((edge[1] - 1) % 2));
  }
  struct eo_recording *r = find(f, &lines, &tracks, &notes, &error);
  for (int64_t i = 0; r && i < 1500; i++) {
    if (eo_recording_read(r, i, 1, row, &error))
      break;
    worst = fmax(worst, fabs(row[0] - (double)(2 * i + 1) * first));
  }
  ok(r && tracks.channel[0].track == EO_TRACK_PULSES && worst < 1e-9 && noted(&notes, "logic analysers"),
     "changes of two tracks are edges at their times, %.3g s off%s", worst, r ? "" : error.text);
  eo_recording_free(r);
}

static void test_squares(void)
{
  struct eo_layout_choice lines = {.lines = {60, 60}};
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  for (int i = 0; i < 4; i++) {
    int k = i % 2 + 1;
    FILE *f = begin(i == 0   ? "t_s;Pinion_TTL [V];Gear_TTL [V]\n"
                    : i == 1 ? "t;Pinion_A [V];Pinion_B [V];Gear_A [V];Gear_B [V]\n"
                    : i == 2 ? "t_s;Pinion_TTL;Gear_TTL\n"
                             : "t;Pinion_A;Pinion_B;Gear_A;Gear_B\n");
    if (i < 2)
      squares(f, 40000, k);
    else
      squares_of(f, 40000, k, i == 2 ? "LOW" : "False", i == 2 ? "HIGH" : "True");
    struct eo_recording *r = find(f, &lines, &tracks, &notes, &error);
    double turns = r ? (double)eo_recording_length(r, 0) / tracks.channel[0].lines : NAN;
    ok(r && tracks.channel[0].track == EO_TRACK_PULSES && tracks.channel[0].lines == (k == 1 ? 60 : 240) &&
           fabs(turns - SPEED * 0.5 / (2 * M_PI)) < 0.05,
       "square waves of %d track%s, in %s, come out to %.4g turns%s", k, k == 1 ? "" : "s", i < 2 ? "volts" : "words",
       turns, r ? "" : error.text);
    eo_recording_free(r);
  }
  check_changes();
  FILE *f = begin("t_s;Pinion_TTL [V];Gear_TTL [V]\n");
  squares(f, 40000, 1);
  asked(f, NULL, "/lines", "square wave", "square waves without their lines");
  f = begin("t_s;Pinion_TTL [V];Gear_TTL [V]\n");
  squares(f, 3000, 1);
  asked(f, &lines, "/kind", "rows per line", "square waves with few rows per line");
}

/* When pulse k of a member passes: lines at a speed that swings. */
static double pulse_time(int member, int k)
{
  double step = member ? 1.26e-4 : 1.95e-4;
  return 0.8 * step + step * k + 1e-5 * sin(0.01 * k);
}

/* The pulses come out at their times, but for one offset that both have. */
static void pulses_are_right_until(FILE *f, int count, double tolerance, const char *what)
{
  struct eo_layout_choice choice = {.kind = EO_LAYOUT_PULSES, .lines = {512, 2048}};
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  double most = 0, shift = 0;
  struct eo_recording *r = find(f, &choice, &tracks, &notes, &error);
  for (int k = 0; r && k < count; k++)
    for (int m = 0; m < 2; m++) {
      double off = cell_of(r, k, tracks.channel[m].column[0]) * tracks.time_scale - pulse_time(m, k);
      shift = k || m ? shift : off;
      most = isnan(off) ? INFINITY : fmax(most, fabs(off - shift));
    }
  ok(r && most < tolerance, "%s: the times are %.2g s off%s", what, most, r ? "" : error.text);
  eo_recording_free(r);
}

static void pulses_are_right(FILE *f, double tolerance, const char *what)
{
  pulses_are_right_until(f, ROWS, tolerance, what);
}

/* Columns of ticks alone, of a counter that starts again. */
static void test_pulse_counters(void)
{
  static const struct {
    const char *header, *what;
    double tick;
    int bits;
    int64_t start;
  } counters[] = {
      {"Timebase: 1 MHz\nPinion_ticks;Gear_ticks\n", "pulses of a counter of 16 bits", 1e-6, 16, 40000},
      {"Timer clock: 40 MHz\nPinion capture;Gear capture\n", "of 24 bits", 2.5e-8, 24, 0},
      {"Clock: 80 MHz\nPinion [ticks];Gear [ticks]\n", "of 32 bits", 1.25e-8, 32, (1LL << 32) - 100000},
  };
  for (size_t i = 0; i < sizeof counters / sizeof *counters; i++) {
    FILE *f = begin(counters[i].header);
    for (int k = 0; k < ROWS; k++)
      for (int m = 0; m < 2; m++)
        fprintf(
            f, "%lld%c",
            (long long)((counters[i].start + llround(pulse_time(m, k) / counters[i].tick)) % (1LL << counters[i].bits)),
            m ? '\n' : ';');
    pulses_are_right(f, 1.1 * counters[i].tick, counters[i].what);
  }
  FILE *f = begin("ts_pinion_ns\tts_gear_ns\n");
  for (int k = 0; k < ROWS; k++)
    fprintf(f, "1700000000%09lld\t1700000000%09lld\n", llround(pulse_time(0, k) * 1e9),
            llround(pulse_time(1, k) * 1e9));
  pulses_are_right(f, 2e-9, "pulses in nanoseconds since 1970, which doubles do not hold");
}

static void test_periods(void)
{
  static const char *const headers[] = {"Pinion period [us];Gear period [us]\n",
                                        "Clock: 80 MHz\nPinion pulse interval [ticks];Gear pulse interval [ticks]\n"};
  for (int way = 0; way < 2; way++) {
    FILE *f = begin(headers[way]);
    double unit = way ? 1.25e-8 : 1e-6, before[2] = {0, 0};
    for (int k = 0; k < ROWS; k++)
      for (int m = 0; m < 2; m++) {
        double now = way ? unit * round(pulse_time(m, k) / unit) : pulse_time(m, k);
        fprintf(f, way ? "%.0f%c" : "%.7f%c", (now - before[m]) / unit, m ? '\n' : ';');
        before[m] = now;
      }
    pulses_are_right(f, way ? 1.1 * unit : 1e-9,
                     way ? "periods in ticks add up" : "periods add up to the times of pulses");
  }
}

/* One row for each pulse of either encoder, with the edge it is; both: the other edges stand between them. */
static void events(const char *header, bool numbered, bool both)
{
  static const char *const name[2] = {"pinion", "gear"};
  FILE *f = begin(header);
  int next[2] = {0}, number = 0;
  while (next[0] < ROWS || next[1] < ROWS) {
    double at[2];
    for (int m = 0; m < 2; m++)
      at[m] = pulse_time(m, next[m] / 2) + (next[m] % 2 ? 3e-5 : 0);
    int m = at[1] < at[0];
    bool falling = next[m]++ % 2;
    if (falling && !both)
      continue;
    if (numbered)
      fprintf(f, "%d,%s,%.9f\n", number++, name[m], at[m]);
    else
      fprintf(f, "%.9f,%s,%s\n", at[m], name[m], falling ? "falling" : "rising");
  }
  pulses_are_right_until(f, ROWS / 2, 1e-8,
                         numbered ? "pulses that are numbered"
                         : both   ? "both edges of each pulse"
                                  : "pulses in rows that name their channel and edge");
}

static void test_events(void)
{
  events("time_s,channel,edge\n", false, false);
  events("time_s,Kanal,Flanke\n", false, true);
  events("pulse_no,shaft,time_s\n", true, false);
}

int main(void)
{
  fixture_open();
  test_clocks();
  test_times();
  test_lost_rows();
  test_units();
  test_columns();
  test_counters();
  test_headings();
  test_key_column();
  test_repeated_rows();
  test_squares();
  test_pulse_counters();
  test_periods();
  test_events();
  return fixture_close();
}

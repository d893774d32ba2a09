/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What columns mean: guesses from names, units and values, and what settles them when they cannot be made; two files of
   one run. */
#include "recording/layout.h"
#include "support/reader-fixture.h"

#define RATE 20000.0
#define ROWS 8000
#define PINION_SPEED 209.44 /* rad/s */
#define GEAR_SPEED (-209.44 * 17 / 44)

static double pinion(double t)
{
  return 0.3 + PINION_SPEED * t + 1e-6 * cos(17 * PINION_SPEED * t);
}

static double gear(double t)
{
  return 1.1 + GEAR_SPEED * t + 1e-6 * cos(8 * 17 * PINION_SPEED * t);
}

static double wrap(double x, double turn)
{
  return x - turn * floor(x / turn);
}

/* A table as text; cells by a function of time. */
static struct eo_recording *make(const char *header, void (*row)(FILE *, double), double rate, double start, int rows)
{
  struct eo_error error;
  FILE *file = fopen(fixture_path, "w");
  fputs(header, file);
  for (int i = 0; i < rows; i++)
    row(file, start + i / rate);
  fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  if (!r) {
    printf("# %s\n", error.text);
    exit(1);
  }
  return r;
}

static void degrees(FILE *file, double t)
{
  fprintf(file, "%.7f,%.9f,%.9f\n", t, pinion(t) * 180 / M_PI, gear(t) * 180 / M_PI);
}

static void wrapped_degrees(FILE *file, double t)
{
  fprintf(file, "%.7f,%.9f,%.9f\n", t, wrap(pinion(t) * 180 / M_PI, 360), wrap(gear(t) * 180 / M_PI, 360));
}

static void wrapped_radians(FILE *file, double t)
{
  fprintf(file, "%.7f,%.12f,%.12f\n", t, wrap(pinion(t), 2 * M_PI), wrap(gear(t), 2 * M_PI));
}

static void radians(FILE *file, double t)
{
  fprintf(file, "%.7f,%.12f,%.12f\n", t, pinion(t), gear(t));
}

static void exchanged(FILE *file, double t)
{
  fprintf(file, "%.3f,%.12f,%.2f,%.12f\n", t * 1e3, gear(t), 120 + sin(t), pinion(t));
}

static void counts(FILE *file, double t)
{
  fprintf(file, "%.7f,%.0f,%.0f\n", t, floor(wrap(pinion(t) / (2 * M_PI), 1) * 36000),
          floor(wrap(gear(t) / (2 * M_PI), 1) * 65536));
}

static void tracks(FILE *file, double t)
{
  fprintf(file, "%.7f,%.5f,%.5f,%.5f,%.5f\n", t, 0.5 * sin(1024 * pinion(t)), 0.5 * sin(1024 * gear(t)),
          0.5 * cos(1024 * pinion(t)), 0.5 * cos(1024 * gear(t)));
}

static void no_time(FILE *file, double t)
{
  fprintf(file, "%.9f;%.9f\n", pinion(t), gear(t));
}

static void check(struct eo_recording *r, const struct eo_layout_choice *choice, const struct eo_tracks *expected,
                  const char *note, const char *what)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_tracks found;
  enum eo_code code = eo_layout_find(&r, choice, NULL, NULL, &found, &notes, &error);
  int right = !code && found.time_column == expected->time_column && found.time_scale == expected->time_scale;
  for (int m = 0; right && m < 2; m++) {
    const struct eo_track_channel *a = &found.channel[m], *b = &expected->channel[m];
    right = a->track == b->track && a->column[0] == b->column[0] &&
            (a->track != EO_TRACK_SINE_COSINE || a->column[1] == b->column[1]);
    right = right && (a->track != EO_TRACK_ANGLE || fabs(a->scale / b->scale - 1) < 1e-12);
    right = right && (a->track == EO_TRACK_ANGLE ||
                      (a->lines == b->lines && a->unit == b->unit && (b->factor == 0 || a->factor == b->factor)));
  }
  for (int i = 0; i < notes.count; i++)
    printf("# %s\n", notes.text[i]);
  ok(right && noted(&notes, note), "a layout is found for %s%s%s", what, code ? ": " : "", code ? error.text : "");
  eo_recording_free(r);
}

static void unclear(struct eo_recording *r, const struct eo_layout_choice *choice, const char *pointer,
                    const char *what)
{
  struct eo_error error;
  struct eo_tracks found;
  enum eo_code code = eo_layout_find(&r, choice, NULL, NULL, &found, NULL, &error);
  ok(code == EO_ERROR_INPUT && !strcmp(error.pointer, pointer), "the layout asks about %s: %s %s", what,
     code ? error.pointer : "was found", code ? error.text : "");
  eo_recording_free(r);
}

static void test_angles(void)
{
  double degree = M_PI / 180;
  struct eo_tracks t = {.time_column = 0,
                        .time_scale = 1,
                        .channel = {{.column = {1}, .scale = degree}, {.column = {2}, .scale = degree}}};
  check(make("t_s,angle1_deg,angle2_deg\n", degrees, RATE, 0, ROWS), NULL, &t, "angle of the pinion in degrees",
        "names and units as in the reference file");
  check(make("", wrapped_degrees, RATE, 0, ROWS), NULL, &t, "starting again after 360", "no header: wrapped degrees");
  check(make("", degrees, RATE, 0, ROWS), NULL, &t, "Nothing states the unit",
        "no header, not wrapped: degrees by the speed");
  struct eo_layout_choice radian = {.unit = EO_LAYOUT_RADIAN};
  t.channel[0].scale = t.channel[1].scale = 1;
  check(make("", wrapped_radians, RATE, 0, ROWS), NULL, &t, "in radians", "no header: wrapped radians");
  check(make("", radians, RATE, 0, ROWS), NULL, &t, "Nothing states the unit",
        "no header, not wrapped: radians by the speed");
  check(make("", degrees, RATE, 0, ROWS), &radian, &t, "in radians", "the unit as chosen");
  t = (struct eo_tracks){
      .time_column = 0, .time_scale = 1e-3, .channel = {{.column = {3}, .scale = 1}, {.column = {1}, .scale = 1}}};
  check(make("Zeit [ms],Rad [rad],Drehmoment [Nm],Ritzel [rad]\n", exchanged, RATE, 0, ROWS), NULL, &t,
        "\"Ritzel\" is taken as the angle of the pinion", "German names, gear first, a torque between, milliseconds");
  struct eo_layout_choice chosen = {.column = {{"Rad"}, {"4"}}};
  t.channel[0].column[0] = 1;
  t.channel[1].column[0] = 3;
  check(make("Zeit [ms],Rad [rad],Drehmoment [Nm],Ritzel [rad]\n", exchanged, RATE, 0, ROWS), &chosen, &t,
        "\"Rad\" is taken as the angle of the pinion", "columns as chosen, by name and number");
}

static void test_counts(void)
{
  struct eo_tracks t = {
      .time_column = 0,
      .time_scale = 1,
      .channel = {{.column = {1}, .scale = 2 * M_PI / 36000}, {.column = {2}, .scale = 2 * M_PI / 65536}}};
  check(make("t,pinion,gear\n", counts, RATE, 0, ROWS), NULL, &t, "starting again after 36000",
        "counts that start again");
  struct eo_layout_choice lines = {.unit = EO_LAYOUT_COUNT, .lines = {9000, 18000}};
  t.channel[0].scale = 2 * M_PI / 9000;
  t.channel[1].scale = 2 * M_PI / 18000;
  check(make("t,pinion,gear\n", counts, RATE, 0, ROWS), &lines, &t, "in counts", "counts per turn as chosen");
  unclear(make("t [s],pinion [counts],gear [counts]\n", counts, RATE, 0, 20), NULL, "/lines", "counts without a turn");
}

static void test_tracks(void)
{
  struct eo_layout_choice lines = {.lines = {1024, 1024}};
  struct eo_tracks t = {
      .time_column = 0,
      .time_scale = 1,
      .channel = {
          {.track = EO_TRACK_SINE_COSINE, .column = {1, 3}, .lines = 1024, .unit = EO_TRACK_VOLT, .factor = 1e-3},
          {.track = EO_TRACK_SINE_COSINE, .column = {2, 4}, .lines = 1024, .unit = EO_TRACK_VOLT, .factor = 1e-3}}};
  check(make("t [s],sin1 [mV],sin2 [mV],cos1 [mV],cos2 [mV]\n", tracks, 2e6, 0, ROWS), &lines, &t,
        "sine and cosine tracks of the gear", "four raw tracks");
  unclear(make("t [s],sin1 [mV],sin2 [mV],cos1 [mV],cos2 [mV]\n", tracks, 2e6, 0, ROWS), NULL, "/lines",
          "raw tracks without lines");
  t.channel[0].unit = t.channel[1].unit = EO_TRACK_UNKNOWN;
  t.channel[0].factor = t.channel[1].factor = 1;
  t.channel[0].column[1] = 2;
  t.channel[1].column[0] = 3;
  check(make("", tracks, 2e6, 0, ROWS), &lines, &t, "sine and cosine",
        "four swinging columns without names: sine, cosine, sine, cosine");
}

static void test_time(void)
{
  unclear(make("pinion [rad];gear [rad]\n", no_time, RATE, 0, ROWS), NULL, "/sample_rate_Hz", "no time");
  struct eo_layout_choice rate = {.sample_rate = 20000};
  struct eo_tracks t = {
      .time_column = -1, .time_scale = 1, .channel = {{.column = {0}, .scale = 1}, {.column = {1}, .scale = 1}}};
  check(make("pinion [rad];gear [rad]\n", no_time, RATE, 0, ROWS), &rate, &t, "radians", "a sampling rate as chosen");
  check(make("Sample rate: 20 kHz\npinion [rad];gear [rad]\n", no_time, RATE, 0, ROWS), NULL, &t,
        "states a sampling rate of 20000 Hz", "a sampling rate in the header");
  struct eo_layout_choice wrong = {.time = "clock"};
  unclear(make("pinion [rad];gear [rad]\n", no_time, RATE, 0, ROWS), &wrong, "/time", "a column that is not there");
  struct eo_layout_choice one = {.sample_rate = 20000, .column = {{"1"}, {NULL}}};
  struct eo_error error;
  write_text("angle\n1.5\n2.5\n3.5\n4.5\n");
  unclear(read_fixture(NULL, NULL, &error), &one, "/columns", "one column only");
}

static void test_pulses(void)
{
  struct eo_error error;
  write_text("pinion [ms],gear [ms]\n0.5,0.7\n1.5,2.7\n2.5,4.7\n3.5,\n4.5,\n");
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  struct eo_layout_choice lines = {.lines = {500, 250}};
  struct eo_tracks t = {.time_column = -1,
                        .time_scale = 1e-3,
                        .channel = {{.track = EO_TRACK_PULSES, .column = {0}, .lines = 500},
                                    {.track = EO_TRACK_PULSES, .column = {1}, .lines = 250}}};
  check(r, &lines, &t, "pulses of the gear", "two columns of pulse times");
}

static void pinion_alone(FILE *file, double t)
{
  fprintf(file, "%.13f,%.10f\n", t, wrap(pinion(t) * 180 / M_PI, 360));
}

static void gear_alone(FILE *file, double t)
{
  fprintf(file, "%.13f,%.10f\n", t, wrap(gear(t) * 180 / M_PI, 360));
}

static void test_two_files(void)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_recording *a = make("t [s],angle [deg]\n", pinion_alone, RATE, 0, ROWS), *both = NULL;
  struct eo_recording *b = make("t [s],angle [deg]\n", gear_alone, RATE, 0, ROWS);
  ok(!eo_layout_combine(a, b, NULL, NULL, &both, &notes, &error) && eo_recording_rows(both) == ROWS,
     "two files with equal times are combined");
  struct eo_tracks t = {.time_column = 0,
                        .time_scale = 1,
                        .channel = {{.column = {1}, .scale = M_PI / 180}, {.column = {3}, .scale = M_PI / 180}}};
  check(both, NULL, &t, "\"angle gear\" is taken as the angle of the gear", "two files, of which one is the gear's");
  eo_recording_free(b);
  both = NULL;
  b = make("t [s],angle [deg]\n", gear_alone, 20011, -0.01, ROWS);
  struct eo_tracks found;
  ok(!eo_layout_combine(a, b, NULL, NULL, &both, &notes, &error) &&
         !eo_layout_find(&both, NULL, NULL, NULL, &found, &notes, &error) && eo_recording_rows(both) > ROWS * 9 / 10 &&
         found.time_column == 0 && found.channel[1].column[0] == 2,
     "two files sampled at different times are brought to one clock");
  double most = 0, offset = cell_of(both, 1000, 2) - gear(cell_of(both, 1000, 0)) * 180 / M_PI;
  for (int i = 0; i < eo_recording_rows(both); i++)
    most = fmax(most, fabs(cell_of(both, i, 2) - gear(cell_of(both, i, 0)) * 180 / M_PI - offset));
  double order = 1e-6 * 180 / M_PI; /* the eighth mesh order, 4.4 rows per period */
  ok(most < 5e-4 * order, "two files are interpolated to %.2g deg, %.2g of the highest order", most, most / order);
  eo_recording_free(both);
  both = NULL;
  eo_recording_free(b);
  b = make("t [s],angle [deg]\n", gear_alone, RATE, 5, ROWS);
  ok(!eo_layout_combine(a, b, NULL, NULL, &both, &notes, &error) &&
         eo_layout_find(&both, NULL, NULL, NULL, &found, &notes, &error) == EO_ERROR_INPUT &&
         strstr(error.text, "overlap"),
     "two files without overlap are refused: %s", error.text);
  eo_recording_free(both);
  both = NULL;
  eo_recording_free(b);
  eo_recording_free(a);
  write_text("0.5\n1.5\n2.5\n3.5\n");
  a = read_fixture(NULL, NULL, &error);
  write_text("0.7\n2.7\n");
  b = read_fixture(NULL, NULL, &error);
  ok(!eo_layout_combine(a, b, NULL, NULL, &both, &notes, &error) && eo_recording_length(both, 0) == 4 &&
         eo_recording_length(both, 1) == 2 && isnan(cell_of(both, 2, 1)) && cell_of(both, 3, 0) == 3.5,
     "two files of pulse times are combined");
  eo_recording_free(a);
  eo_recording_free(b);
  eo_recording_free(both);
}

/* Who is asked for columns is told which there are. */
static void test_list_of_columns(void)
{
  struct eo_error error;
  struct eo_tracks found;
  struct eo_layout_choice choice = {.column = {{"pinon"}}};
  struct eo_recording *r = make("t [s],angle 1 [deg],angle 2 [deg]\n", degrees, RATE, 0, ROWS);
  enum eo_code code = eo_layout_find(&r, &choice, NULL, NULL, &found, NULL, &error);
  ok(code && strstr(error.text, "no column \"pinon\"; it has 3 columns: t (s), angle 1 (deg), angle 2 (deg)."), "%s",
     error.text);
  eo_recording_free(r);
  write_text("t [s],torque [Nm]\n0,1.5\n1e-4,1.25\n2e-4,1\n3e-4,1.5\n");
  r = read_fixture(NULL, NULL, &error);
  code = r ? eo_layout_find(&r, NULL, NULL, NULL, &found, NULL, &error) : error.code;
  ok(code && strstr(error.text, "It has: t (s), torque (Nm)."), "%s", error.text);
  eo_recording_free(r);
}

int main(void)
{
  fixture_open();
  test_angles();
  test_counts();
  test_tracks();
  test_time();
  test_pulses();
  test_two_files();
  test_list_of_columns();
  return fixture_close();
}

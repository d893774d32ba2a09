/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many columns of which two are the encoders, torques and speeds of any shaft beside them, units that nobody or the
   file's own words state: the right column in the right unit, or a question. */
#include "support/known-run.h"

#define RATE 4000.0
#define NUMBERS 6

/* A table: the time, then what cells[] gives. */
static FILE *table(const char *header, int columns, void (*cells)(double t, double *cell))
{
  FILE *f = begin(header);
  for (int i = 0; i < ROWS; i++) {
    double cell[NUMBERS];
    cells(i / RATE, cell);
    fprintf(f, "%.9g", i / RATE);
    for (int c = 0; c < columns; c++)
      fprintf(f, ";%.13g", cell[c]);
    fputs("\n", f);
  }
  return f;
}

/* A channel that turns as the pinion does but for a coupling. */
static double coupled(double t)
{
  return pinion(t) + 2e-3 * sin(3 * SPEED * t);
}

static void wanted_first(double t, double *cell)
{
  cell[0] = degrees(SPEED * t);
  cell[1] = degrees(SPEED * 17 / 44 * t);
  cell[2] = degrees(pinion(t));
  cell[3] = degrees(gear(t));
}

static void three_shafts(double t, double *cell)
{
  cell[0] = degrees(coupled(t));
  cell[1] = degrees(pinion(t));
  cell[2] = degrees(gear(t));
}

static void two_runs(double t, double *cell)
{
  cell[0] = degrees(coupled(t));
  cell[1] = degrees(gear(t) + 3e-4 * sin(20 * t));
  cell[2] = degrees(gear(t));
  cell[3] = degrees(pinion(t));
}

static void two_units(double t, double *cell)
{
  cell[0] = degrees(pinion(t));
  cell[1] = fmod(pinion(t), 2 * M_PI);
  cell[2] = degrees(gear(t));
}

static void test_pairs(void)
{
  static const char *const wanted[] = {"Winkel_Ritzel_Soll;Winkel_Rad_Soll;Winkel_Ritzel_Ist;Winkel_Rad_Ist",
                                       "Axis1.SetPos;Axis2.SetPos;Axis1.ActPos;Axis2.ActPos",
                                       "cmd_pinion;cmd_gear;pinion;gear",
                                       "pinion_filtered;gear_filtered;pinion_raw;gear_raw"};
  char header[200];
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
    snprintf(header, sizeof header, "t [s];%s\n", wanted[i]);
    right(table(header, 4, wanted_first), NULL, 1e-7, "turn in the ratio", wanted[i]);
  }
  const char *one = "turn in the ratio of the teeth";
  right(table("t [s];motor [deg];pinion [deg];gear [deg]\n", 3, three_shafts), NULL, 1e-7, one,
        "the wheels themselves before what drives them");
  asked(table("t [s];Enc1 [deg];Enc2 [deg];Enc3 [deg]\n", 3, three_shafts), NULL, "/columns",
        "\"Enc2\" and \"Enc3\" (columns 3 and 4) as well", "two shafts that turn alike");
  struct eo_layout_choice chosen = {.column = {{"Enc2"}, {"Enc3"}}};
  right(table("t [s];Enc1 [deg];Enc2 [deg];Enc3 [deg]\n", 3, three_shafts), &chosen, 1e-7, "\"Enc2\" is taken as",
        "two shafts by the answer to the question");
  asked(table("t [s];pinion_run1;gear_run2;gear_run1;pinion_run2\n", 4, two_runs), NULL, "/columns",
        "\"pinion_run1\" and \"gear_run1\"", "two runs beside each other, each in itself");
  right(table("t [s];enc_a [deg];enc_a [rad];enc_b [deg]\n", 3, two_units), NULL, 1e-7, one,
        "one signal in two units is no question");
}

static void loaded(double t, double *cell)
{
  cell[0] = degrees(pinion(t));
  cell[1] = degrees(gear(t));
  cell[2] = 828 + t;
  cell[3] = 600;
}

/* Heads of two columns beside the angles: which of them is a torque and which a speed, of the pinion and the gear
   (columns from 0; -1: none). */
static void beside(const char *heads, int torque, int torque_of_gear, int speed, int speed_of_gear)
{
  char header[200];
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  snprintf(header, sizeof header, "t [s];pinion [deg];gear [deg];%s\n", heads);
  struct eo_recording *r = find(table(header, 4, loaded), NULL, &tracks, &notes, &error);
  const struct eo_track_beside *is[4] = {&tracks.torque[0], &tracks.torque[1], &tracks.speed[0], &tracks.speed[1]};
  const int expected[4] = {torque, torque_of_gear, speed, speed_of_gear};
  bool good = r != NULL;
  for (int i = 0; good && i < 4; i++)
    good = (is[i]->scale != 0) == (expected[i] >= 0) && (expected[i] < 0 || is[i]->column == expected[i]);
  ok(good && (torque >= 0 || torque_of_gear >= 0 || noted(&notes, "left out")),
     "%s finds torque and speed of each member%s", heads, r ? "" : error.text);
  eo_recording_free(r);
}

static void test_beside(void)
{
  beside("Torque [Nm];Speed [rpm]", 3, -1, 4, -1);
  beside("Abtriebsmoment [Nm];Abtriebsdrehzahl [1/min]", -1, 3, -1, 4);
  beside("M_ab [Nm];n_an [1/min]", -1, 3, 4, -1);
  beside("OutputTorque [Nm];InputSpeed [rpm]", -1, 3, 4, -1);
  beside("Motor torque [Nm];Pinion torque [Nm]", 4, -1, -1, -1);
  beside("M_Soll [Nm];M_Ist [Nm]", 4, -1, -1, -1);
  beside("Torque setpoint [Nm];Torque [Nm]", 4, -1, -1, -1);
  beside("Friction torque [Nm];Fan speed [rpm]", -1, -1, -1, -1);
  beside("Reibmoment [Nm];Slip [rpm]", -1, -1, -1, -1);
  beside("Brake torque [Nm];Speed limit [rpm]", -1, -1, -1, -1);
  beside("Torque [foo];Speed [km/h]", -1, -1, -1, -1);
}

/* Both channels have this scale, rad, and times are in s; noted (NULL: not looked for). */
static void scaled(FILE *file, const struct eo_layout_pair *run, double scale, const char *note, const char *what)
{
  struct eo_tracks tracks;
  struct eo_notes notes = {0};
  struct eo_error error = {0};
  fclose(file);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  enum eo_code code = r ? eo_layout_find(&r, NULL, run, NULL, &tracks, &notes, &error) : error.code;
  ok(!code && fabs(tracks.channel[0].scale / scale - 1) < 1e-9 && fabs(tracks.channel[1].scale / scale - 1) < 1e-9 &&
         tracks.time_scale == 1 && noted(&notes, note),
     "the angles come out at the scale of %s%s", what, code ? error.text : "");
  eo_recording_free(r);
}

static double turn; /* of the columns below, in their unit */

static void wrapped(double t, double *cell)
{
  cell[0] = fmod(pinion(t) / (2 * M_PI) * turn, turn);
  cell[1] = fmod(gear(t) / (2 * M_PI) * turn, turn);
}

static void test_turns(void)
{
  static const double turns[] = {400, 6400, 3600, 21600, 1296000, 1000, 360, 1};
  char what[80];
  for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
    turn = turns[i];
    snprintf(what, sizeof what, "starting again after %.6g", turn);
    scaled(table("t [s];pinion;gear\n", 2, wrapped), &pair, 2 * M_PI / turn, what, what);
  }
  turn = 400;
  scaled(table("t [s];pinion [grad];gear [grad]\n", 2, wrapped), &pair, M_PI / 200, "in gon",
         "grad that start again at 400");
}

static void in_radians(double t, double *cell)
{
  cell[0] = pinion(t);
  cell[1] = gear(t);
}

static void in_hundredths(double t, double *cell)
{
  cell[0] = 100 * degrees(pinion(t));
  cell[1] = 100 * degrees(gear(t));
}

static void in_turns(double t, double *cell)
{
  cell[0] = pinion(t) / (2 * M_PI);
  cell[1] = gear(t) / (2 * M_PI);
}

static void in_radians_gear_first(double t, double *cell)
{
  cell[0] = gear(t);
  cell[1] = pinion(t);
}

static void gear_first(double t, double *cell)
{
  cell[0] = degrees(gear(t));
  cell[1] = degrees(pinion(t));
}

static void test_units(void)
{
  const struct eo_layout_pair run = {.teeth = {17, 44}, .speed = {SPEED, SPEED}, .stated = true};
  const char *guess = "radians are a guess";
  scaled(table("time;pinion;gear\n", 2, in_radians), &pair, 1, guess, "radians and seconds that nothing states");
  scaled(table("time;a;b\n", 2, in_radians_gear_first), &pair, 1, guess,
         "the slower shaft first, as a matrix has them");
  scaled(table("time;a;b\n", 2, gear_first), &run, M_PI / 180, "degrees", "degrees by the speed that was stated");
  scaled(table("time;pinion;gear\n", 2, in_turns), &run, 2 * M_PI, "turns", "turns by the speed that was stated");
  right(table("t [s];pinion [0.01 deg];gear [1E-2 deg]\n", 2, in_hundredths), NULL, 1e-7, "taken as the angle",
        "a multiple of a unit");
}

/* Times in a unit of the file's own. */
static FILE *timed(const char *name, double unit)
{
  FILE *f = begin(name);
  fputs(";pinion [deg];gear [deg]\n", f);
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.9g;%.13g;%.13g\n", i / RATE / unit, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  return f;
}

static void test_times(void)
{
  static const struct {
    const char *name;
    double unit;
  } known[] = {{"t [10 us]", 1e-5},  {"t (x10 us)", 1e-5}, {"t / 10 us", 1e-5},     {"Zeit [0,1 ms]", 1e-4},
               {"t [1E-4 s]", 1e-4}, {"t [cs]", 1e-2},     {"t [x 10^-5 s]", 1e-5}, {"time [1/4000 s]", 2.5e-4}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    right(timed(known[i].name, known[i].unit), NULL, 1e-6, "is taken as time", known[i].name);
  asked(timed("t [frames]", 1e-3), NULL, "/time_unit", "\"frames\" as the unit of \"t\"", "a unit of time not known");
  asked(timed("t [jiffies]", 1e-3), NULL, "/time_unit", "\"jiffies\"", "a unit of time that is not guessed");
  asked(timed("timestamp (80 MHz clock)", 1 / 80e6), NULL, "/time_unit", "times away",
        "a unit that a name says and nobody knows");
}

static void test_marks(void)
{
  FILE *f = begin("t [s];pinion [deg];gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.9g;%.13g;%.13g\n", i / RATE, degrees(pinion(i / RATE)),
            i % 100 == 7 ? 9.91e37 : degrees(gear(i / RATE)));
  right(f, NULL, 1e-7, "taken as the angle", "what an instrument could not measure is no number");
}

/* Facts that a program writes beside each row; one that changes is none. */
static void test_constants(void)
{
  FILE *f = begin("Pinion [deg];Sampling rate [Hz];Gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.13g;4000;%.13g\n", degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  right(f, NULL, 1e-9, "a sampling rate of 4000 Hz", "a rate in each row");
  f = begin("t [s];Pinion [counts];Gear [counts];Pinion cpr;Gear cpr\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.9g;%.0f;%.0f;1048576;2097152\n", i / RATE, floor(pinion(i / RATE) / 2 / M_PI * 1048576),
            floor(gear(i / RATE) / 2 / M_PI * 2097152));
  right(f, NULL, 2e-5, "holds 2097152 in all rows", "counts per turn in each row");
  f = begin("Pinion [deg];Gear [deg];Sampling rate [Hz]\n");
  for (int i = 0; i < 30 * ROWS; i++)
    fprintf(f, "%.13g;%.13g;%d\n", degrees(pinion(i / RATE)), degrees(gear(i / RATE)), i < 29 * ROWS ? 4000 : 5000);
  asked(f, NULL, "/sample_rate_Hz", "states no sampling rate", "a rate that changes");
}

int main(void)
{
  fixture_open();
  test_pairs();
  test_beside();
  test_turns();
  test_units();
  test_times();
  test_marks();
  test_constants();
  return fixture_close();
}

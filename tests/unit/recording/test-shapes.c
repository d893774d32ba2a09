/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recordings in shapes other than one column for each quantity: numbers in parts and steps that add up come out right,
   and what only looks like them is left alone. */
#include "support/known-run.h"

#define RATE 4000.0
#define EPOCH 1709629199

/* Whole units of a number that is not negative, and what is left, as people print both. */
static int64_t whole(double number, int64_t parts, int64_t *rest)
{
  int64_t all = llround(number * (double)parts);
  *rest = all % parts;
  return all / parts;
}

static FILE *parts_of_time(const char *header, const char *format, int64_t epoch, double start, int64_t parts)
{
  FILE *f = begin(header);
  for (int i = 0; i < ROWS; i++) {
    double t = i / RATE;
    int64_t rest, seconds = whole(start + t, parts, &rest);
    fprintf(f, format, (long long)(epoch + seconds), (long long)rest);
    fprintf(f, ",%.12g,%.12g\n", degrees(pinion(start + t)), degrees(gear(start + t)));
  }
  return f;
}

static void test_parts_of_time(void)
{
  const char *note = "parts of one time";
  right(parts_of_time("header.stamp.secs,header.stamp.nsecs,pinion [deg],gear [deg]\n", "%lld,%lld", EPOCH, 0.8,
                      1000000000),
        NULL, 1e-7, note, "seconds and nanoseconds as robots log them");
  right(parts_of_time("tv_sec,tv_usec,pinion [deg],gear [deg]\n", "%lld,%lld", 0, 0.8, 1000000), NULL, 1e-7, note,
        "seconds and microseconds from 0");
  right(parts_of_time("", "%lld,%lld", EPOCH, 0.8, 1000000000), NULL, 1e-7, note,
        "seconds and nanoseconds without names");
  right(parts_of_time("epoch_s,fraction,pinion [deg],gear [deg]\n", "%lld,0.%06lld", EPOCH, 0.8, 1000000), NULL, 1e-7,
        note, "a fraction of a second in a column");
  for (int way = 0; way < 2; way++) {
    double start = way ? 86399.5 : 32399.5;
    FILE *f = begin(way ? "hour,minute,second,microsecond,pinion [deg],gear [deg]\n"
                        : "Date,Time,us,pinion [deg],gear [deg]\n");
    for (int i = 0; i < ROWS; i++) {
      double t = start + i / RATE;
      int64_t us, s = whole(t, 1000000, &us);
      fprintf(f, way ? "%d,%d,%d,%d" : "05/03/2024,%02d:%02d:%02d,%d", (int)(s / 3600 % 24), (int)(s / 60 % 60),
              (int)(s % 60), (int)us);
      fprintf(f, ",%.16g,%.16g\n", degrees(pinion(t)), degrees(gear(t)));
    }
    right(f, NULL, 1e-6, note, way ? "hours to microseconds in columns, over midnight" : "date, time and fraction");
  }
  FILE *f = begin("sec,latency_ms,time_us,pinion [deg],gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%d,%d,%d,%.12g,%.12g\n", i / 4000, i * 7 % 40, i * 250, degrees(pinion(i / RATE)),
            degrees(gear(i / RATE)));
  right(f, NULL, 1e-7, "\"time\" is taken as time", "milliseconds that are no part of the time");
}

static void test_steps(void)
{
  FILE *f = begin("Δt [ms];Ritzel [°];Rad [°]\n");
  double t = 0;
  for (int i = 0; i < ROWS; i++) {
    double step = i ? 0.25 + 0.02 * sin(i * 0.7) : 0;
    t += step * 1e-3;
    fprintf(f, "%.12g;%.12g;%.12g\n", step, degrees(pinion(t)), degrees(gear(t)));
  }
  right(f, NULL, 1e-7, "steps of time", "steps of time that differ");
  f = begin("micros;pinion [deg];gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%d;%.12g;%.12g\n", 250 * i, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  right(f, NULL, 1e-7, "in units of 1e-06 s", "a time that is called by its unit");
  const char *rows[2] = {"time [ms];pinion [deg];gear [deg]\n", "t_s;dt_s;pinion [deg];gear [deg]\n"};
  for (int kind = 0; kind < 2; kind++) {
    f = begin(rows[kind]);
    for (int i = 0; i < ROWS; i++) {
      if (kind)
        fprintf(f, "%.9g;", i / RATE);
      fprintf(f, "%g;%.12g;%.12g\n", kind ? 7e-3 : 0.25, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
    }
    if (kind)
      right(f, NULL, 1e-7, "\"t\" is taken as time", "steps beside times, which do not count");
    else
      asked(f, NULL, "/time", "call the column dt", "a time that stands still");
  }
}

/* Degrees, minutes and seconds of an angle in the format, the sign first. */
static void put_arc(FILE *f, const char *format, double angle)
{
  int64_t rest, minutes = whole(fabs(degrees(angle)) * 60, 60000000, &rest);
  fprintf(f, format, angle < 0 ? "-" : "", (int)(minutes / 60), (int)(minutes % 60), (int)(rest / 1000000),
          (int)(rest % 1000000));
}

static FILE *arcs(const char *header, const char *format, double sign)
{
  FILE *f = begin(header);
  for (int i = 0; i < ROWS; i++) {
    double t = i / RATE;
    fprintf(f, "%.9g;", t);
    put_arc(f, format, sign * pinion(t));
    fputc(';', f);
    put_arc(f, format, sign * gear(t));
    fputc('\n', f);
  }
  return f;
}

static void test_arcs(void)
{
  right(arcs("t_s;pinion;gear\n", "%s%d°%02d'%02d.%06d\"", 1), NULL, 1e-7, "in degrees", "angles as 12°34'56.7\"");
  right(arcs("t_s;pinion;gear\n", "%s%d\xb0 %02d' %02d.%06d''", 1), NULL, 1e-7, "in degrees",
        "angles in Latin 1, with blanks");
  right(arcs("t_s;pinion;gear\n", "%s%d° %02d′ %02d.%06d″", 1), NULL, 1e-7, "in degrees", "angles with primes");
  right(arcs("t_s;pinion;gear\n", "\"%s%d°%02d'%02d.%06d\"\"\"", 1), NULL, 1e-7, "in degrees", "angles in quotes");
  right(arcs("t_s;pinion;gear\n", "%s%dd%02dm%02d.%06ds", 1), NULL, 1e-7, "in degrees", "angles with letters");
  right(arcs("t_s;pinion [deg];gear [deg]\n", "%s%d:%02d:%02d.%06d", 1), NULL, 1e-7, "in degrees",
        "angles with colons");
  right(arcs("t_s;p_deg;p_min;p_sec;g_deg;g_min;g_sec\n", "%s%d;%d;%d.%06d", 1), NULL, 1e-7, "parts of one angle",
        "angles in columns");
  right(arcs("t;pinion;;;gear;;\ns;deg;arcmin;arcsec;deg;arcmin;arcsec\n", "%s%d;%d;%d.%06d", 1), NULL, 1e-7,
        "parts of one angle", "angles in columns with units below");
  FILE *f = begin("t_s;turn;pinion [deg];gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.9g;%d;%.12g;%.12g\n", i / RATE, (int)(degrees(pinion(i / RATE)) / 360), degrees(pinion(i / RATE)),
            degrees(gear(i / RATE)));
  right(f, NULL, 1e-7, "in degrees", "whole turns beside angles, which are no part of them");
}

/* Below 0 minutes count down from 0 with the degrees, or up from them; "-0" is a degree of its own. */
static void test_negative_arcs(void)
{
  for (int way = 0; way < 2; way++) {
    struct eo_recording *r;
    struct eo_error error;
    double most = 0;
    FILE *f = begin("p_deg;p_min;p_sec\n");
    for (int i = 0; i < 200; i++) {
      double angle = 9.97 - 0.1 * i;
      int64_t rest, minutes = whole(angle + 100, 3600000000LL, &rest), base = way ? 100 : 0;
      if (!way)
        minutes = whole(fabs(angle), 3600000000LL, &rest);
      fprintf(f, "%s%lld;%lld;%.6f\n", !way && angle < 0 ? "-" : "", (long long)(minutes - base),
              (long long)(rest / 60000000), (double)(rest % 60000000) * 1e-6);
    }
    fclose(f);
    r = read_fixture(NULL, NULL, &error);
    for (int i = 0; r && i < 200; i++)
      most = fmax(most, fabs(cell_of(r, i, 0) - (9.97 - 0.1 * i)));
    ok(r && eo_recording_columns(r) == 1 && most < 1e-9, "degrees below 0 whose minutes count %s are read to %.2g",
       way ? "up" : "down", most);
    eo_recording_free(r);
  }
}

/* One row for each value, with the name of its channel: by turns, each channel with times of its own. */
static FILE *rows_of_channels(const char *header, const char *format, const char *const name[2], double delay)
{
  FILE *f = begin(header);
  for (int i = 0; i < ROWS; i++) {
    double t = i / RATE;
    fprintf(f, format, t, name[0], degrees(pinion(t)));
    fprintf(f, format, t + delay, name[1], degrees(gear(t + delay)));
  }
  return f;
}

static void test_channels_in_rows(void)
{
  static const char *const plain[2] = {"pinion", "gear"}, *const odd[2] = {"ENC1", "ENC2"},
                           *const number[2] = {"0x101", "0x102"};
  right(rows_of_channels("time [s],channel,value [deg]\n", "%.9f,%s,%.12g\n", plain, 0), NULL, 1e-7, "side by side",
        "rows with a column of names");
  right(rows_of_channels("time [s];Kanal;Wert;Einheit\n", "%.9f;%s;%.12g;deg\n", odd, 1e-4), NULL, 1e-7,
        "times of their own", "rows with a column of names, one of units, times of their own");
  right(rows_of_channels("time [s];id;angle [deg]\n", "%.9f;%s;%.12g\n", number, 1e-4), NULL, 1e-7,
        "times of their own", "rows with a column of numbers");
  right(rows_of_channels("", "%.9f,%s,%.12g\n", plain, 0), NULL, 1e-3, "side by side",
        "rows with a column of names without a heading");
  FILE *f = begin("name;t_s;deg\n");
  for (int m = 1; m >= 0; m--)
    for (int i = 0; i < ROWS; i++) {
      double t = i / (m ? 3300 : RATE);
      fprintf(f, "%s;%.9f;%.12g\n", plain[m], t, degrees(m ? gear(t) : pinion(t)));
    }
  right(f, NULL, 2e-6, "times of their own", "one channel after the other, the gear's first");
  static const char *const melted[] = {"variable,value,time\n", "value;time;channel\n", "", ""};
  for (int way = 0; way < 4; way++) {
    f = begin(melted[way]);
    for (int i = 0; i < 2 * ROWS; i++) {
      int m = way % 2 ? i % 2 : i / ROWS;
      double t = (way % 2 ? i / 2 : i % ROWS) / RATE;
      const char *name = way % 2 ? m ? "gear [rad]" : "pinion [rad]" : m ? "gear_rad" : "pinion_rad";
      if (way == 1)
        fprintf(f, "%.12g;%.5f;%s\n", m ? gear(t) : pinion(t), t, name);
      else
        fprintf(f, "%s%c%.12g%c%.5f\n", name, way ? ';' : ',', m ? gear(t) : pinion(t), way ? ';' : ',', t);
    }
    right(f, NULL, 1e-7, "side by side", way < 2 ? "values before their times" : "the same without a heading");
  }
  f = begin("");
  for (int i = 0; i < 2 * ROWS; i++)
    fprintf(f, "%s %.6f %.12g\n", plain[i / ROWS], i % ROWS / RATE,
            degrees(i / ROWS ? gear(i % ROWS / RATE) : pinion(i % ROWS / RATE)));
  right(f, NULL, 1e-3, "side by side", "one encoder's rows after all of the other's, without a heading");
  f = begin("t_s;status;pinion_deg;gear_deg;channel\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.9f;%s;%.12g;%.12g;%d\n", i / RATE, i % 50 ? "OK" : "WARN", degrees(pinion(i / RATE)),
            degrees(gear(i / RATE)), i % 2);
  right(f, NULL, 1e-7, "in degrees", "words and numbers beside both encoders, which are no channels");
}

/* Tables one below the other; first, second: what stands above each. */
static FILE *stacked(const char *first, const char *second, const char *format, bool times, double rate)
{
  FILE *f = begin(first);
  for (int m = 0; m < 2; m++) {
    for (int i = 0; i < ROWS; i++) {
      double t = i / (m ? rate : RATE), angle = degrees(m ? gear(t) : pinion(t));
      if (times)
        fprintf(f, format, t, angle);
      else
        fprintf(f, format, angle);
    }
    fputs(m ? "" : second, f);
  }
  return f;
}

static void test_stacked(void)
{
  right(stacked("t_s,pinion_deg\n", "\nt_s,gear_deg\n", "%.9f,%.12g\n", true, 3300), NULL, 2e-6, "times of their own",
        "tables with names of their own");
  right(stacked("Channel 1: pinion\ntime_s,angle_deg\n", "Channel 2: gear\ntime_s,angle_deg\n", "%.9f,%.12g\n", true,
                RATE),
        NULL, 1e-7, "side by side", "tables with labels");
  right(stacked("# pinion\n# t [s]  angle [deg]\n", "\n\n# gear\n# t [s]  angle [deg]\n", "%.9f %.12g\n", true, RATE),
        NULL, 1e-7, "side by side", "blocks with comments above them");
  right(stacked("Signal;pinion\nUnit;deg\nRate [Hz];4000\n", "\nSignal;gear\nUnit;deg\nRate [Hz];3300\n", "%.12g\n",
                false, 3300),
        NULL, 2e-3, "times of their own", "rates instead of times");
  right(stacked("Channel: pinion_deg\nSample rate: 4000 Hz\n", "Channel: gear_deg\nSample rate: 4000 Hz\n", "%.12g\n",
                false, RATE),
        NULL, 1e-7, "in degrees", "a rate next to the rows");
  right(stacked("Sample rate: 4000 Hz\npinion_deg\n", "gear_deg\n", "%.12g\n", false, RATE), NULL, 1e-7, "side by side",
        "one rate for both blocks");
  asked(stacked("pinion_deg\n", "gear_deg\n", "%.12g\n", false, RATE), NULL, "/sample_rate_Hz", "give one",
        "blocks without a rate");
  for (int way = 0; way < 2; way++) {
    FILE *f = begin("Table: run 1\nt_s,pinion_deg,gear_deg\n");
    for (int i = 0; i < ROWS; i++) {
      if (i == ROWS / 2)
        fputs(way ? "operator: warm now\n" : "Table: run 2\nt_s,pinion_deg,gear_deg\n", f);
      fprintf(f, "%.9f,%.12g,%.12g\n", i / RATE, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
    }
    if (way)
      right(f, NULL, 1e-7, "left empty", "a remark between rows, which begins no table");
    else
      asked(f, NULL, "", "run 1 (2000 rows), run 2 (2000 rows)", "two tables with both encoders");
  }
}

/* Rows with one number in place of what a logger did not hear: in both channels, or in the gear's alone. */
static FILE *lost(const char *number, int run, bool both)
{
  FILE *f = begin("t [s];pinion [deg];gear [deg]\n");
  for (int i = 0; i < ROWS; i++) {
    double angle[2] = {degrees(pinion(i / RATE)), degrees(gear(i / RATE))};
    bool missing = i > 500 && i % 700 < run;
    fprintf(f, "%.9g", i / RATE);
    for (int c = 0; c < 2; c++)
      if (missing && (both || c))
        fprintf(f, ";%s", number);
      else
        fprintf(f, ";%.12g", angle[c]);
    fputc('\n', f);
  }
  return f;
}

static void test_lost(void)
{
  static const char *const number[] = {"-9999", "99999", "0", "-1", "65535"};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
    right(lost(number[i], 5, true), NULL, 1e-7, "stands for lost ones", "a number for five lost rows");
    right(lost(number[i], 90, false), NULL, 1e-7, "stands for lost ones", "and for ninety of one channel");
  }
  right(lost("-1.#IND00", 40, true), NULL, 1e-7, NULL, "no numbers as some runtimes print them");
  FILE *f = begin("Counts per revolution: 36000000\nt [s];pinion;gear\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.9g;16#%08llX;16#%08llX\n", i / RATE, llround(pinion(i / RATE) / (2 * M_PI) * 36e6),
            llround(gear(i / RATE) / (2 * M_PI) * 36e6));
  right(f, NULL, 1e-6, NULL, "but 16#1A of a controller is a number");
}

int main(void)
{
  fixture_open();
  test_parts_of_time();
  test_steps();
  test_arcs();
  test_negative_arcs();
  test_channels_in_rows();
  test_stacked();
  test_lost();
  return fixture_close();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recordings as microcontrollers and their monitors spell them: names in every row, counters that start again; and
   rates in sentences. */
#include "support/known-run.h"

#define RATE 4000.0

/* Every row in the format: s, degrees, degrees. */
static FILE *named(const char *header, const char *format)
{
  FILE *f = begin(header);
  for (int i = 0; i < ROWS; i++)
    fprintf(f, format, i / RATE, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  return f;
}

static void test_names(void)
{
  static const struct {
    const char *format, *what;
  } rows[] = {
      {"t=%.9g,pinion=%.12g,gear=%.12g\n", "commas"},
      {"t:%.9g pinion:%.12g gear:%.12g\n", "blanks"},
      {"t: %.9g\tpinion: %.12g\tgear: %.12g\r\n", "tabs"},
      {"t = %.9g; pinion = %.12g; gear = %.12g;\n", "blanks around the mark"},
      {"[%.9g] pinion angle: %.12g deg gear angle: %.12g deg\n", "names of two words, units, a time without a name"},
      {"%.9g -> pinion_deg=%.12g gear_deg=%.12g\n", "an arrow"},
      {"I t=%.9g s pinion=%.12g deg gear=%.12g deg level=info\n", "words beside them"},
      {"\"t\": %.9g, \"pinion\": %.12g, \"gear\": %.12g\n", "names in quotes"},
  };
  const char *note = "names of";
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    right(named("", rows[i].format), NULL, 1e-7, note, rows[i].what);
  right(named("Encoder logger 1.2\nReady: yes\nPins: 2\n", "t=%.9g,pinion=%.12g,gear=%.12g\n"), NULL, 1e-7, note,
        "rows with names behind a banner");
  FILE *f = begin("");
  for (int i = 0; i < ROWS; i++) {
    double t = i / RATE;
    fprintf(f, "Zeit=%d,%05d;Ritzel=%d,%07d\n", i / 4000, i % 4000 * 25, (int)degrees(pinion(t)),
            (int)(fmod(degrees(pinion(t)), 1) * 1e7));
  }
  fclose(f);
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && !strcmp(eo_recording_name(r, 1), "Ritzel") &&
         fabs(cell_of(r, 1000, 1) - degrees(pinion(0.25))) < 1e-6,
     "rows with names and decimal commas are read: %.9g%s", r ? cell_of(r, 1000, 1) : NAN, r ? "" : error.text);
  eo_recording_free(r);
}

/* Names say which value is which, not their places; what lacks is empty, other lines are odd. */
static void test_places(void)
{
  FILE *f = begin("");
  for (int i = 0; i < 200; i++)
    if (i == 50)
      fputs("t=0.5\n", f);
    else if (i == 60)
      fputs("restart=1\n", f);
    else if (i % 2)
      fprintf(f, "gear=%d,t=%d,pinion=%d\n", 3 * i, i, 10 * i);
    else
      fprintf(f, "gear=%d,pinion=%d,t=%d\n", 3 * i, 10 * i, i);
  fclose(f);
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  int wrong = 0;
  for (int64_t i = 0; r && i < eo_recording_rows(r); i++) {
    double gear = cell_of(r, i, 0) / 3;
    wrong += !isnan(gear) && (cell_of(r, i, 1) != 10 * gear || cell_of(r, i, 2) != gear);
  }
  ok(r && !wrong && eo_recording_rows(r) == 200 && noted(&notes, "instead of 3") && isnan(cell_of(r, 50, 0)) &&
         isnan(cell_of(r, 60, 2)),
     "names in rows tell the places, %d rows are wrong%s", wrong, r ? "" : error.text);
  eo_recording_free(r);
  write_text("Rate=4000\nRows=3\nRig=2\nTorque=400\nSpeed=600\nDate=5\n");
  refused("No table", "facts below each other are no rows");
}

/* Times in ticks that a counter of this many holds, from so many before it starts again. */
static FILE *wrapped(const char *header, double rate, double tick, double ticks, double before, double low)
{
  FILE *f = begin(header);
  for (int i = 0; i < ROWS; i++) {
    double first = low + ticks - before, t = first * tick + i / rate; /* as if it went on */
    double count = fmod(floor(i / rate / tick + 1e-6) + ticks - before, ticks) + low;
    fprintf(f, "%.0f,%.17g,%.17g\n", count, degrees(pinion(t)), degrees(gear(t)));
  }
  return f;
}

static void test_overflows(void)
{
  const char *note = "as a counter that overflows does";
  right(wrapped("micros,pinion [deg],gear [deg]\n", RATE, 1e-6, 0x1p32, 500000, 0), NULL, 1e-6, note,
        "micros() after 2^32");
  right(wrapped("micros,pinion [deg],gear [deg]\n", RATE, 1e-6, 0x1p32, 500000, -0x1p31), NULL, 1e-6, note,
        "micros() after 2^32 with a sign");
  right(wrapped("millis,pinion [deg],gear [deg]\n", 1000, 1e-3, 0x1p32, 500, 0), NULL, 1e-3, note,
        "millis() after 2^32");
  right(wrapped("time [us],pinion [deg],gear [deg]\n", RATE, 1e-6, 0x1p16, 5000, 0), NULL, 1e-7, note,
        "times of 16 bits that start again 15 times");
  right(wrapped("Timer clock: 10 MHz\nticks,pinion [deg],gear [deg]\n", RATE, 1e-7, 0x1p16, 5000, 0), NULL, 1e-7, note,
        "ticks of a stated clock");
  right(wrapped("ms,pinion [deg],gear [deg]\n", RATE, 1e-3, 0x1p16, 500, 0), NULL, 1e-3, note,
        "ms that stand for four rows");
  FILE *f = begin("t [s],pinion [deg],gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.6f,%.17g,%.17g\n", fmod(i / RATE + 0x1p32 * 1e-6 - 0.3, 0x1p32 * 1e-6),
            degrees(pinion(i / RATE + 0x1p32 * 1e-6 - 0.3)), degrees(gear(i / RATE + 0x1p32 * 1e-6 - 0.3)));
  right(f, NULL, 1e-3, note, "ms in seconds that stand for four rows");
  asked(wrapped("time [us],pinion [deg],gear [deg]\n", RATE, 1e-6, 70000, 5000, 0), NULL, "/time", "go back in",
        "times that start again as no counter does");
}

static FILE *told(const char *sentence)
{
  FILE *f = begin(sentence);
  fputs("\npinion [deg],gear [deg]\n", f);
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.12g,%.12g\n", degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  return f;
}

/* Rows with decimal commas. */
static FILE *with_commas(const char *sentence)
{
  FILE *f = begin(sentence);
  fputs("\npinion [deg];gear [deg]\n", f);
  for (int i = 0; i < ROWS; i++) {
    double angle[2] = {degrees(pinion(i / RATE)), degrees(gear(i / RATE))};
    fprintf(f, "%d,%08d;%d,%08d\n", (int)angle[0], (int)(fmod(angle[0], 1) * 1e8), (int)angle[1],
            (int)(fmod(angle[1], 1) * 1e8));
  }
  return f;
}

/* A point before three digits, beside decimal commas, may part thousands. */
static void test_thousands(void)
{
  static const char *const rates[] = {"Abtastrate;4.000,0;Hz",    "Abtastrate: 4.000 Hz",  "4.000 Hz Abtastrate",
                                      "Abtastrate: 4000.000 Hz",  "Abtastrate: 4.000 kHz", "Abtastintervall: 0.250 ms",
                                      "Abtastrate;Kanal\n4.000;2"};
  for (size_t i = 0; i < sizeof rates / sizeof *rates; i++)
    right(with_commas(rates[i]), NULL, 1e-6, "a sampling rate of 4000 Hz", rates[i]);
  asked(with_commas("Abtastrate: 60.000 Hz"), NULL, "/sample_rate_Hz", "60000 and 60 Hz",
        "a rate that may be one or in thousands");
}

/* The rate in a sentence, and sentences with numbers of something else that were taken for it. */
static void test_sentences(void)
{
  static const char *const sentences[] = {"The channels were sampled with 4 kHz on 5 March 2024.",
                                          "4 kHz sample rate, 1000 Hz filter",
                                          "4 kHz sampling rate, 17 teeth, 2 encoders, 600 rpm",
                                          "1 kHz anti-aliasing, 4 kHz sampling",
                                          "Sampled every 250 us",
                                          "Es wurde mit 4 kHz abgetastet, Filter 1 kHz.",
                                          "recording: 2.2 s at 4 kHz",
                                          "Data acquired at a rate of 4 kHz by rig 3, 2 channels.",
                                          "Sample interval 250 us (4 kHz)",
                                          "Sampling interval [10 us]: 25",
                                          "Messrate [1/s]: 4000",
                                          "Sampling rate (1/ms): 4"},
                           *const open[][2] = {{"Sampled at 40 kHz, then decimated to 4 kHz", "40000 and 4000 Hz"},
                                               {"Sampled at 40 kHz, decimated by 10", "40000 and 4000 Hz"},
                                               {"Store rate: 4 kHz, sampling 16 kHz", "4000 and 16000 Hz"},
                                               {"Aggregate sample rate: 8 kHz", "states no sampling rate"},
                                               {"Sampled with 1 kHz filter at 4 kHz", "states no sampling rate"}};
  for (size_t i = 0; i < sizeof sentences / sizeof *sentences; i++)
    right(told(sentences[i]), NULL, 1e-7, "a sampling rate of 4000 Hz", sentences[i]);
  test_thousands();
  for (size_t i = 0; i < sizeof open / sizeof *open; i++)
    asked(told(open[i][0]), NULL, "/sample_rate_Hz", open[i][1], open[i][0]);
}

/* The rate of the converter beside words for a row of four of its samples, which was taken for that of the rows. */
static void test_fewer_rows(void)
{
  static const char *const open[] = {"Sampling rate: 16 kHz\nEvery 4th sample is stored",
                                     "Every fourth sample is stored, sampling rate: 16 kHz",
                                     "Sampling rate: 16 kHz\nStore every: 4",
                                     "Sampling rate: 16 kHz\n1 of 4 samples stored",
                                     "Sampling rate: 16 kHz\naveraging: 4",
                                     "Sampling rate: 16 kHz\nEach row is the mean of 4 samples",
                                     "Sampling rate: 16 kHz\noversampling 4x",
                                     "Sampling rate: 16 kHz / 4",
                                     "Sampling rate: 16 kHz (1:4)",
                                     "Sampling rate: 16000/4 Hz",
                                     "Sampling rate: 16 kHz; stored rate = rate / 4",
                                     "Sampling rate: 16 kHz\nData reduction 4:1",
                                     "Sampling rate: 16 kHz\nCompression 4:1",
                                     "Sampling rate: 16 kHz\nCompression factor: 4",
                                     "Sampling rate: 16 kHz\nskip: 3",
                                     "Sampling rate: 16 kHz, 3 samples skipped",
                                     "Sampling rate: 16 kHz\nskip factor 4",
                                     "Sampling rate: 16 kHz\nresampled by 1/4",
                                     "Sampling rate: 16 kHz, divider: 4",
                                     "dt = 62.5 us\nDecimation = 4",
                                     "Abtastrate: 16 kHz\nUnterabtastung 1:4",
                                     "Abtastrate: 16 kHz\nMittelung \xc3\xbc"
                                     "ber 4 Werte",
                                     "Abtastrate: 16 kHz\nnur jeder 4. Abtastwert wird gespeichert",
                                     "Abtastrate: 16 kHz, 4fach dezimiert",
                                     "Fr\xc3\xa9quence d'\xc3\xa9"
                                     "chantillonnage : 16 kHz\nSous-\xc3\xa9"
                                     "chantillonnage : 4",
                                     "Cadence d'echantillonnage : 16 kHz\nUn point sur 4 est enregistre"},
                           *const clear[] = {"Sampling rate: 16 kHz\nDecimation: 4\nStored rate: 4 kHz",
                                             "Sampling rate: 16 kHz, averaging 4, output rate 4 kHz",
                                             "Sampling rate after decimation: 4 kHz\nDecimation: 4",
                                             "Decimation factor 4, resulting rate 4000 Hz",
                                             "Oversampling ratio 64, output rate 4 kHz",
                                             "Oversampling: 256 (internal)\nSampling rate: 4 kHz",
                                             "Sampling rate: 4 kHz\nDecimation: 1, averages: off",
                                             "Sampling rate: 4 kHz / 2 channels, run 1 of 4",
                                             "Sampling rate: 4 kHz\nMean temperature: 40\nMoving average: 4",
                                             "Sampling rate: 4 kHz\nDecimation filter: 4th order",
                                             "Sampling rate: 4 kHz\nCompression level: 4\nskip lines: 3",
                                             "Sampling rate: 4 kHz\nskip: 0",
                                             "Sampling rate: 4 kHz\nGear reduction: 3",
                                             "Sampling rate: 4 kHz\nDisplay update rate: 10 Hz"};
  for (size_t i = 0; i < sizeof open / sizeof *open; i++)
    asked(told(open[i]), NULL, "/sample_rate_Hz", "16000 and 4000 Hz", open[i]);
  for (size_t i = 0; i < sizeof clear / sizeof *clear; i++)
    right(told(clear[i]), NULL, 1e-7, "a sampling rate of 4000 Hz", clear[i]);
}

/* Rows with a line between them, or behind them. */
static FILE *interrupted(const char *header, int row, const char *line)
{
  FILE *f = begin(header);
  for (int i = 0; i <= ROWS; i++) {
    if (i == row)
      fputs(line, f);
    if (i < ROWS)
      fprintf(f, "%.12g,%.12g\n", degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  }
  return f;
}

/* A rate that is stated behind the first row was passed over. */
static void test_late_rates(void)
{
  static const char *const lines[] = {"# rate changed: sample rate 5000 Hz\n", "Sample interval: 200 us\n",
                                      "# Sample rate: 5 kHz\npinion [deg],gear [deg]\n"};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
    asked(interrupted("Sample rate: 4 kHz\npinion [deg],gear [deg]\n", ROWS / 2, lines[i]), NULL, "/sample_rate_Hz",
          "4000 and 5000 Hz", lines[i]);
  right(interrupted("Sample rate: 4 kHz\npinion [deg],gear [deg]\n", ROWS / 2, "# Sample rate: 4000 Hz at 828 N m\n"),
        NULL, 1e-7, "a sampling rate of 4000 Hz", "the same rate again");
  right(interrupted("pinion [deg],gear [deg]\n", ROWS, "# Sample rate: 4000 Hz\n"), NULL, 1e-7,
        "a sampling rate of 4000 Hz", "a rate behind the last row");
}

/* Times that count as many seconds each, under a heading. */
static FILE *whole_times(const char *header, double each)
{
  FILE *f = begin(header);
  fputs("\nTimestamp;pinion [deg];gear [deg]\n", f);
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.0f;%.12g;%.12g\n", i / RATE / each, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  return f;
}

/* What times resolve is what they count, where they can count nothing finer; it is no distance of rows. */
static void test_resolutions(void)
{
  static const char *const counted[] = {"timestamp resolution: 10 us", "Zeitstempelaufl\xc3\xb6sung: 10 us",
                                        "resolution of the time stamps: 10 us", "clock resolution 0.01 ms"},
                           *const none[] = {"Sampling time resolution: 10 us", "minimum sampling interval: 10 us",
                                            "sample rate limit: 10 kHz", "accelerometer sampling rate: 50 kHz"},
                           *const rates[] = {"rows per second: 4000", "time between rows: 250 us", "row rate: 4 kHz"};
  for (size_t i = 0; i < sizeof counted / sizeof *counted; i++)
    right(whole_times(counted[i], 1e-5), NULL, 1e-7, NULL, counted[i]);
  asked(whole_times("timestamp resolution: 10 us", 1e-6), NULL, "/time_unit", "may count that or units of 1e-06 s",
        "times that are multiples of what they resolve");
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    asked(told(none[i]), NULL, "/sample_rate_Hz", "states no sampling rate", none[i]);
  for (size_t i = 0; i < sizeof rates / sizeof *rates; i++)
    right(told(rates[i]), NULL, 1e-7, "a sampling rate of 4000 Hz", rates[i]);
}

/* One row for each value, with the number of its channel; what else stands there is about the value. */
static void test_channels(void)
{
  static const struct {
    const char *header, *pinion, *gear, *what;
  } files[] = {
      {"time,channel,value,quality\n", "%.9g,1,%.12g,192\n", "%.9g,2,%.12g,192\n", "quality"},
      {"timestamp;channel_id;Value;Quality;unit\n", "%.9g;7;%.12g;0;deg\n", "%.9g;9;%.12g;0;deg\n",
       "an underscore, units"},
      {"t,ch,raw,angle_deg,flags\n", "%1$.9g,0,%1$.3f,%2$.12g,3\n", "%1$.9g,1,%1$.3f,%2$.12g,3\n", "raw numbers"},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    FILE *f = begin(files[i].header);
    for (int k = 0; k < ROWS; k++) {
      double t = k / RATE;
      fprintf(f, files[i].pinion, t, degrees(pinion(t)));
      fprintf(f, files[i].gear, t, degrees(gear(t)));
    }
    right(f, NULL, 1e-7, "stands beside the values of the channels", files[i].what);
  }
  FILE *f = named("time,channel,pinion_deg,gear_deg,quality\n", "%.9g,1,%.12g,%.12g,192\n");
  right(f, NULL, 1e-7, "\"pinion\" and \"gear\"", "a wide table with the number of a channel");
}

static void put_arc(FILE *f, double angle, const char *end)
{
  double size = fabs(angle);
  int whole = (int)size, minutes = (int)((size - whole) * 60);
  fprintf(f, "%s%d:%02d:%08.5f%s", angle < 0 ? "-" : "", whole, minutes, ((size - whole) * 60 - minutes) * 60, end);
}

/* Degrees, minutes and seconds between colons, which look like times of day. */
static void test_arcs(void)
{
  static const struct {
    const char *header, *what;
    double sign, turn;
    bool timed;
  } files[] = {
      {"t_s,pinion angle,gear angle\n", "names of encoders beside a time", 1, INFINITY, true},
      {"t_s,pinion,gear\n", "behind zero", -1, INFINITY, true},
      {"time,Winkel Ritzel,Winkel Rad\n", "less than a turn", 1, 360, true},
      {"a [dms],b [dms],t\n", "units", 1, 360, true},
      {"# sample rate: 4 kHz\npinion,gear\n", "a rate", 1, 360, false},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    FILE *f = begin(files[i].header);
    bool last = files[i].header[0] == 'a';
    for (int k = 0; k < ROWS; k++) {
      double t = k / RATE, p = files[i].sign * fmod(degrees(pinion(t)), files[i].turn),
             g = files[i].sign * fmod(degrees(gear(t)), files[i].turn);
      if (files[i].timed && !last)
        fprintf(f, "%.9g,", t);
      put_arc(f, p, ",");
      put_arc(f, g, last ? "," : "\n");
      if (last)
        fprintf(f, "%.9g\n", t);
    }
    fclose(f);
    struct eo_error error;
    struct eo_recording *r = read_fixture(NULL, NULL, &error);
    int first = files[i].timed && !last;
    double expected = files[i].sign * fmod(degrees(gear(1000 / RATE)), files[i].turn);
    ok(r && strcmp(eo_recording_unit(r, first + 1), "deg") == 0 && fabs(cell_of(r, 1000, first + 1) - expected) < 1e-7,
       "%s: the value is %.9g, expected %.9g%s", files[i].what, r ? cell_of(r, 1000, first + 1) : NAN, expected,
       r ? "" : error.text);
    eo_recording_free(r);
  }
  FILE *f = begin("pinion,gear\n");
  for (int k = 0; k < ROWS; k++) {
    put_arc(f, fmod(degrees(pinion(k / RATE)), 360), ",");
    put_arc(f, fmod(degrees(gear(k / RATE)), 360), "\n");
  }
  fclose(f);
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(!r || strcmp(eo_recording_unit(r, 0), "s") == 0, "times alone may be times of pulses");
  eo_recording_free(r);
}

/* Counts of encoders with so many in a turn. */
static FILE *counted(const char *header, const char *names, double first, double second)
{
  FILE *f = begin(header);
  fprintf(f, "%s\n", names);
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.6f;%.0f;%.0f\n", i / RATE, pinion(i / RATE) / (2 * M_PI) * first,
            gear(i / RATE) / (2 * M_PI) * second);
  return f;
}

#define COUNTS "t [s];Pinion [counts];Gear [counts]"

/* Counts per turn of both encoders in one word. */
static void test_turns(void)
{
  static const struct {
    const char *header;
    double turn;
  } files[] = {
      {"CPR: 9,000,000\n", 9e6},
      {"CPR: 9.000.000\n", 9e6},
      {"CPR: 9 000 000\n", 9e6},
      {"CPR: 9'000'000\n", 9e6},
      {"CPR: 9_000_000\n", 9e6},
      {"Resolution: 9 000 000 counts/rev\n", 9e6},
      {"Sampling rate: 4 000 Hz\nCPR: 9 000 000\n", 9e6},
      {"Resolution: 2^23 counts/rev\n", 0x1p23},
      {"Resolution: 23-bit\n", 0x1p23},
      {"SSI 34 bit: 12 bit multiturn, 22 bit singleturn\n", 0x1p22},
      {"Encoder resolution: 34 bit (12 bit multiturn, 22 bit singleturn)\n", 0x1p22},
      {"ADC resolution: 16 bit\nCPR: 9000000\n", 9e6},
      {"Resolution: 0.001 deg\nCPR: 9000000\n", 9e6},
      {"Encoder scale: 1 count = 0.0001 deg\n", 3.6e6},
      {"Scale: 0.144 arcsec/count\n", 9e6},
      {"Line count: 2048\nInterpolation: 4096\n", 0x1p23},
      {"Encoder pinion: 9000 lines, interpolation 1000\nEncoder gear: 9000 lines, interpolation 1000\n", 9e6},
      {"Pinion: 2250000 PPR x4\nGear: 9000000 PPR x1\n", 9e6},
      {"Lines pinion: 2250000 (x4)\nLines gear: 9000000 (x1)\n", 9e6},
      {"CPR: 9000000, 2 channels\n", 9e6},
      {"CPR: 9000000\nDecoding: X4\n", 9e6},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    right(counted(files[i].header, COUNTS, files[i].turn, files[i].turn), NULL, 3e-6, NULL, files[i].header);
  FILE *f = counted("Strichzahl Rad: 9.000.000\nStrichzahl Ritzel: 9.000.000\n", "t;Ritzel;Rad", 9e6, 9e6);
  right(f, NULL, 3e-6, NULL, "German thousands, the wheel first");
  asked(counted("Resolution: 24 bit\n", COUNTS, 9e6, 9e6), NULL, "/lines", "give the counts per turn",
        "bits that may be those of a converter");
}

/* Counts per turn that differ: 9 and 18 million. */
static void test_two_turns(void)
{
  static const char *const files[][3] = {
      {"CPR: 9000000, 18000000\n", COUNTS, "of the pinion, then of the gear"},
      {"CPR: 9000000 / 18000000\n", COUNTS, "of the pinion, then of the gear"},
      {"CPR: 9000000 and 18000000\n", COUNTS, "of the pinion, then of the gear"},
      {"Encoders: 9000000/18000000 PPR\n", COUNTS, "of the pinion, then of the gear"},
      {"CPR (gear/pinion): 18000000, 9000000\n", COUNTS, "of the gear, then of the pinion"},
      {"CPR: 9000000, 18000000\n", "t [s];ctr0 [counts];ctr1 [counts]", "of the columns in their order"},
      {"CPR: 9000000 (pinion), 18000000 (gear)\n", COUNTS, NULL},
      {"CPR1: 9000000\nCPR2: 18000000\n", "t [s];Enc1;Enc2", NULL},
      {"CPR0: 9000000\nCPR1: 18000000\n", "t [s];ctr0;ctr1", NULL},
      {"Encoder 1 (pinion): 9000000 counts/rev\nEncoder 2 (gear): 18000000 counts/rev\n", "t [s];Encoder 1;Encoder 2",
       NULL},
      {"", "t [s];Pinion [counts, 9000000/rev];Gear [counts, 18000000/rev]", NULL},
      {"", "t [s];Pinion [counts] (9000000/rev);Gear [counts] (18000000/rev)", NULL},
      {"", "t [s];Pinion (9000000 CPR);Gear (18000000 CPR)", NULL},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    right(counted(files[i][0], files[i][1], 9e6, 18e6), NULL, 3e-6, files[i][2],
          *files[i][0] ? files[i][0] : files[i][1]);
  FILE *f = begin("CPR: 18000000, 9000000\nt [s];Gear [counts];Pinion [counts]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%.6f;%.0f;%.0f\n", i / RATE, gear(i / RATE) / (2 * M_PI) * 18e6, pinion(i / RATE) / (2 * M_PI) * 9e6);
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  struct eo_recording *r = find(f, NULL, &tracks, &notes, &error);
  ok(!r && !strcmp(error.pointer, "/lines") && noted(&notes, "\"CPR: 18000000, 9000000\" does not say which"),
     "two counts per turn over columns of gear and pinion are asked about: %s", error.text);
  eo_recording_free(r);
}

/* The name of an abscissa says nothing of whole numbers, one after the other, but that they number the rows. */
static void test_numbers_of_rows(void)
{
  FILE *f = begin("x,pinion [deg],gear [deg]\n");
  for (int i = 0; i < ROWS; i++)
    fprintf(f, "%d,%.12g,%.12g\n", i, degrees(pinion(i / RATE)), degrees(gear(i / RATE)));
  asked(f, NULL, "/sample_rate_Hz", "No column holds the time",
        "a column x that numbers the rows holds no milliseconds");
}

int main(void)
{
  fixture_open();
  test_turns();
  test_two_turns();
  test_names();
  test_places();
  test_overflows();
  test_sentences();
  test_fewer_rows();
  test_resolutions();
  test_late_rates();
  test_channels();
  test_arcs();
  test_numbers_of_rows();
  return fixture_close();
}

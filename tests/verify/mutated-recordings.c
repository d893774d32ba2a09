/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text files as people have them, drawn from synthetic recordings whose truth is kept: columns in any order and unit,
   times of every spelling, every encoding, rows lost, doubled, exchanged or empty. None may give a number that is off
   by more than three standard deviations without a finding; a refusal is a question and is counted.
   mutated-recordings [FILES [FIRST]] */
#include "document/measure_file.h"
#include "support/drawn-recordings.h"
#include "support/synthetic-recording.h"
#include "support/tap.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COLUMNS = 12, ROW = 40000 };
enum content { TIME, PINION, GEAR, NUMBER, TEMPERATURE, TORQUE, STATUS, EMPTY };
enum time_style {
  SECONDS,
  MILLISECONDS,
  MICROSECONDS,
  RATE_IN_HEADING,
  ISO,
  CLOCK,
  EXCEL_DAYS,
  UNIX,
  GERMAN_DATE,
  TIME_STYLES
};
enum row_fault {
  SOUND,
  GAP,        /* rows missing, the times tell */
  LOST,       /* rows missing, the times go on as if none were */
  DOUBLED,    /* one row twice */
  EXCHANGED,  /* two neighbours */
  MOVED,      /* a block of rows stands elsewhere */
  BACKWARDS,  /* the last row first */
  NO_NUMBERS, /* cells without a number */
  HEADING_AGAIN,
  CUT,         /* in the middle of the last row */
  LOST_IN_ONE, /* the gear's values move up by some rows */
  ON_LINES,    /* brought to another rate on straight lines */
  LAST_VALUE,  /* brought to another rate by the last value */
  ROW_FAULTS
};
static const char *const fault_names[ROW_FAULTS] = {
    "sound",      "gap",           "lost", "doubled",     "exchanged", "moved",     "backwards",
    "no numbers", "heading again", "cut",  "lost in one", "on lines",  "last value"};

struct unit {
  const char *name;
  double per_radian;
};
static const struct unit units[] = {{"deg", 180 / M_PI}, {"\xc2\xb0", 180 / M_PI}, {"rad", 1},
                                    {"rev", 0.5 / M_PI}, {"gon", 200 / M_PI},      {"arcmin", 60 * 180 / M_PI},
                                    {"mrad", 1000},      {"Grad", 180 / M_PI},     {"\xc2\xb5rad", 1e6},
                                    {"U", 0.5 / M_PI}};

/* One file to write. */
struct plan {
  struct eo_random random;
  struct eo_synthetic truth;
  int columns;
  enum content column[COLUMNS];
  enum time_style time;
  const struct unit *unit;
  enum row_fault fault;
  int64_t at, size; /* of the fault */
  double rate;      /* rows per second of the file */
  int names, separator, encoding, line_end;
  bool comma, quoted, units_below, comments, unit_stated;
  const char *point;
};

static double drawn_between(const struct plan *p, uint64_t draw, double low, double high)
{
  return between(p->random, draw, low, high);
}

static int choice(const struct plan *p, uint64_t draw, int count)
{
  return (int)eo_random_index(p->random, draw, (uint64_t)count);
}

static void plan_columns(struct plan *p)
{
  p->column[p->columns++] = PINION;
  p->column[p->columns++] = GEAR;
  if (p->time != RATE_IN_HEADING)
    p->column[p->columns++] = TIME;
  for (int c = NUMBER; c <= EMPTY; c++)
    if (choice(p, 60 + (uint64_t)c, 4) == 0)
      p->column[p->columns++] = (enum content)c;
  for (int i = p->columns - 1; i > 0; i--) { /* any order */
    int k = choice(p, 70 + (uint64_t)i, i + 1);
    enum content kept = p->column[i];
    p->column[i] = p->column[k];
    p->column[k] = kept;
  }
}

static void make_plan(struct plan *p, uint64_t seed)
{
  memset(p, 0, sizeof *p);
  p->random = eo_random_at(1999, 0, 0, seed);
  p->truth = drawn_base(eo_random_at(2016, 0, 0, 100000 + seed), seed);
  p->truth.turns = drawn_between(p, 1, 14, 24);
  p->truth.sample_rate = floor(p->truth.speed / (2 * M_PI) * drawn_between(p, 2, 340, 400));
  p->truth.noise = fmin(p->truth.noise, 2e-7);
  p->truth.wrapped = choice(p, 3, 3) == 0;
  p->time = (enum time_style)choice(p, 4, TIME_STYLES);
  p->unit = &units[choice(p, 5, sizeof units / sizeof *units)];
  p->fault = (enum row_fault)(choice(p, 6, 3) ? 1 + choice(p, 7, ROW_FAULTS - 1) : SOUND);
  p->rate = p->truth.sample_rate;
  if (p->fault == ON_LINES || p->fault == LAST_VALUE) {
    p->rate = floor(p->rate * drawn_between(p, 19, 0.7, 1.95));
    p->truth.wrapped = false;
  }
  int64_t rows = eo_synthetic_rows(&p->truth);
  p->at = (int64_t)(drawn_between(p, 8, 0.1, 0.8) * (double)rows);
  p->size = 1 + choice(p, 9, 40);
  p->names = choice(p, 10, 4);
  p->separator = choice(p, 11, 5);
  p->encoding = choice(p, 12, 6);
  p->line_end = choice(p, 13, 3);
  p->comma = choice(p, 14, 3) == 0 && p->separator != 0;
  p->quoted = choice(p, 15, 5) == 0 && p->separator < 2;
  p->unit_stated = choice(p, 16, 6) != 0 || p->unit->per_radian != 180 / M_PI;
  p->units_below = p->unit_stated && choice(p, 17, 4) == 0;
  p->comments = choice(p, 18, 3) == 0;
  plan_columns(p);
  bool blanks = p->separator == 4;
  if (blanks) /* columns of words and of nothing cannot be told apart there */
    for (int c = 0; c < p->columns; c++)
      if (p->column[c] == EMPTY || p->column[c] == STATUS)
        p->column[c] = NUMBER;
  if (blanks && (p->time == ISO || p->time == GERMAN_DATE))
    p->time = SECONDS;
}

/* The text as it grows. */
struct sheet {
  char *text;
  size_t size, room;
  const struct plan *plan;
};

__attribute__((format(printf, 2, 3))) static void put(struct sheet *s, const char *format, ...)
{
  va_list arguments;
  if (s->size + 512 > s->room) {
    s->room = s->room ? 2 * s->room : 1 << 16;
    s->text = realloc(s->text, s->room);
    if (!s->text)
      exit(99);
  }
  va_start(arguments, format);
  s->size += (size_t)vsnprintf(s->text + s->size, 512, format, arguments);
  va_end(arguments);
}

static void put_line_end(struct sheet *s)
{
  static const char *const ends[] = {"\n", "\r\n", "\r"};
  put(s, "%s", ends[s->plan->line_end]);
}

static void put_separator(struct sheet *s)
{
  static const char *const separators[] = {",", ";", "\t", "|", "  "};
  put(s, "%s", separators[s->plan->separator]);
}

/* A number with a decimal comma where the file has one. */
static void put_number(struct sheet *s, double value, int decimals)
{
  char text[64];
  snprintf(text, sizeof text, "%.*f", decimals, value);
  char *point = strchr(text, '.');
  if (point && s->plan->comma)
    *point = ',';
  put(s, s->plan->quoted ? "\"%s\"" : "%s", text);
}

static void put_time(struct sheet *s, double t)
{
  const struct plan *p = s->plan;
  double day = 36000 + 3500 + t; /* passes eleven o'clock in the recordings that last long enough */
  int hour = (int)(day / 3600), minute = (int)(day / 60) % 60;
  double second = day - 3600 * hour - 60 * minute;
  char mark = p->comma ? ',' : '.', text[64];
  snprintf(text, sizeof text, "%02d:%02d:%09.6f", hour, minute, second);
  text[8] = mark;
  switch (p->time) {
  case MILLISECONDS:
    put_number(s, 1e3 * t, 7);
    return;
  case MICROSECONDS:
    put_number(s, 1e6 * t, 4);
    return;
  case ISO:
    put(s, "2024-03-05T%s", text);
    return;
  case CLOCK:
    put(s, "%s", text);
    return;
  case GERMAN_DATE:
    put(s, "05.03.2024 %s", text);
    return;
  case EXCEL_DAYS:
    put_number(s, 45356 + day / 86400, 11);
    return;
  case UNIX:
    put_number(s, 1709632800 + t, 6);
    return;
  default:
    put_number(s, t, 9);
  }
}

static const char *name_of(const struct plan *p, enum content content)
{
  static const char *const names[4][8] = {
      {"time", "pinion", "gear", "no", "temperature", "torque", "status", "remark"},
      {"Zeit", "Winkel Ritzel", "Winkel Rad", "Nr", "Temperatur", "Drehmoment Ritzel", "Status", "Bemerkung"},
      {"t", "phi1", "phi2", "n", "T1", "M1", "flag", "x1"},
      {"Timestamp", "Encoder 1", "Encoder 2", "Sample", "Oil", "Torque 1", "State", "Note"}};
  return names[p->names][content];
}

static const char *unit_of(const struct plan *p, enum content content)
{
  bool times = p->time <= MICROSECONDS;
  switch (content) {
  case TIME:
    return !times ? "" : p->time == SECONDS ? "s" : p->time == MILLISECONDS ? "ms" : "us";
  case PINION:
  case GEAR:
    return p->unit_stated ? p->unit->name : "";
  case TEMPERATURE:
    return "\xc2\xb0"
           "C";
  case TORQUE:
    return "Nm";
  default:
    return "";
  }
}

static void put_heading(struct sheet *s)
{
  static const char *const forms[] = {"%s [%s]", "%s (%s)", "%s / %s", "%s in %s"};
  const struct plan *p = s->plan;
  char text[128];
  for (int row = 0; row < 1 + p->units_below; row++) {
    for (int c = 0; c < p->columns; c++) {
      const char *unit = unit_of(p, p->column[c]);
      if (c)
        put_separator(s);
      if (row)
        put(s, "%s", *unit ? unit : "-");
      else if (p->units_below || !*unit)
        put(s, "%s", name_of(p, p->column[c]));
      else {
        snprintf(text, sizeof text, forms[choice(p, 30, 4)], name_of(p, p->column[c]), unit);
        put(s, "%s", text);
      }
    }
    put_line_end(s);
  }
}

static void put_facts(struct sheet *s)
{
  static const char *const rates[] = {"Sampling rate: %.0f Hz", "fs = %.0f Hz", "Abtastrate [Hz]: %.0f",
                                      "Scan rate;%.0f Hz", "sample rate (Hz),%.0f"};
  const struct plan *p = s->plan;
  if (p->comments) {
    put(s, "# recorded with a test bench, run 7");
    put_line_end(s);
  }
  if (p->time == RATE_IN_HEADING) {
    char text[80];
    snprintf(text, sizeof text, rates[choice(p, 31, 5)], p->rate);
    put(s, "%s", text);
    put_line_end(s);
  }
  if (p->comments) {
    put(s, "Operator: N. N.");
    put_line_end(s);
    put_line_end(s);
  }
}

static void put_row(struct sheet *s, const double *row, double time, double gear, int64_t number)
{
  const struct plan *p = s->plan;
  double to_unit = M_PI / 180 * p->unit->per_radian;
  bool none = p->fault == NO_NUMBERS && number >= p->at && number < p->at + p->size;
  static const char *const empty[] = {"", "NaN", "-", "n/a"};
  for (int c = 0; c < p->columns; c++) {
    if (c)
      put_separator(s);
    switch (p->column[c]) {
    case TIME:
      put_time(s, time);
      break;
    case PINION:
      put_number(s, row[1] * to_unit, 10);
      break;
    case GEAR:
      if (none)
        put(s, "%s", empty[p->separator == 4 ? 1 : choice(p, 32, 4)]);
      else
        put_number(s, gear * to_unit, 10);
      break;
    case NUMBER:
      put(s, "%lld", (long long)number + 1);
      break;
    case TEMPERATURE:
      put_number(s, 61 + 0.5 * sin(1e-3 * (double)number), 2);
      break;
    case TORQUE:
      put_number(s, 500 + 3 * sin(0.07 * (double)number), 2);
      break;
    case STATUS:
      put(s, "ok");
      break;
    case EMPTY:
      break;
    }
  }
  put_line_end(s);
}

/* Which row of the recording stands at a place of the file; -1: none. */
static int64_t shown(const struct plan *p, int64_t place, int64_t rows)
{
  int64_t block = 10 * p->size;
  switch (p->fault) {
  case GAP:
  case LOST:
    place += place >= p->at ? p->size : 0;
    return place < rows ? place : -1;
  case DOUBLED:
    return place > p->at ? place - 1 : place;
  case EXCHANGED:
    return place == p->at ? place + 1 : place == p->at + 1 ? place - 1 : place;
  case MOVED: /* to the beginning */
    return place < block ? p->at + place : place < p->at + block ? place - block : place;
  case BACKWARDS:
    return rows - 1 - place;
  default:
    return place;
  }
}

static void write_sheet(struct sheet *s, const double *rows, int64_t count)
{
  const struct plan *p = s->plan;
  put_facts(s);
  put_heading(s);
  for (int64_t place = 0; place < count; place++) {
    int64_t i = shown(p, place, count), other = i;
    if (i < 0 || i >= count)
      continue;
    if (p->fault == LOST_IN_ONE && i >= p->at)
      other = i + p->size < count ? i + p->size : count - 1;
    if (p->fault == HEADING_AGAIN && place == p->at)
      put_heading(s);
    double time = p->fault == LOST ? rows[3 * place] : rows[3 * i];
    put_row(s, rows + 3 * i, time, rows[3 * other + 2], i);
  }
  if (p->fault == CUT)
    s->size -= 15;
}

/* UTF-8 as it is or with a mark, Latin 1, UTF-16 of both orders. */
static void save(const struct sheet *s, const char *path)
{
  FILE *file = fopen(path, "wb");
  int encoding = s->plan->encoding;
  if (!file)
    exit(99);
  fputs(encoding == 1 ? "\xef\xbb\xbf" : encoding == 3 ? "\xff\xfe" : encoding == 4 ? "\xfe\xff" : "", file);
  for (size_t i = 0; i < s->size; i++) {
    unsigned c = (unsigned char)s->text[i];
    bool two = c >= 0xc0 && i + 1 < s->size;
    if (two && encoding >= 2 && encoding <= 4)
      c = (c & 31) << 6 | ((unsigned char)s->text[++i] & 63);
    if (encoding == 3 || encoding == 4) {
      fputc(encoding == 3 ? (int)(c & 255) : (int)(c >> 8), file);
      fputc(encoding == 3 ? (int)(c >> 8) : (int)(c & 255), file);
    } else
      fputc((int)c, file);
  }
  fclose(file);
}

struct tally {
  int files, numbers, refused, said, wrong;
  int by_fault[ROW_FAULTS][3]; /* files, numbers, refused */
};

static bool has_finding(const json_t *document)
{
  size_t i;
  json_t *finding;
  json_array_foreach(json_object_get(document, "findings"), i,
                     finding) if (strcmp(json_string_value(json_object_get(finding, "severity")), "note") !=
                                  0) return true;
  return false;
}

static void show(const struct plan *p, const json_t *document, const char *path)
{
  size_t i;
  json_t *note;
  printf("#   %s, time %d, unit %s, separator %d, encoding %d, comma %d, names %d, units below %d, wrapped %d, %s\n",
         fault_names[p->fault], (int)p->time, p->unit_stated ? p->unit->name : "not stated", p->separator, p->encoding,
         p->comma, p->names, p->units_below, p->truth.wrapped, path);
  json_array_foreach(json_object_get(document, "notes"), i, note) printf("#     %s\n", json_string_value(note));
}

/* What the recording itself gives, before anything is written: noise may lie beyond three standard deviations, too. */
static double value_unwritten(const struct plan *p)
{
  const struct eo_measurement_settings settings = {
      .stated_speed = NAN, .transmission = {.teeth = {17, 44}, .base_radius = {0.0518616, 0.1342300}}};
  struct eo_recording *recording = NULL;
  struct eo_measurement m = {0};
  struct eo_tracks tracks;
  struct eo_error error;
  synthetic_tracks(&p->truth, &tracks);
  if (synthetic_record(&p->truth, &recording, &error) ||
      eo_measurement_run(&m, recording, &tracks, &settings, NULL, &error))
    m.transmission.rms = NAN;
  double value = m.transmission.rms;
  eo_measurement_done(&m);
  eo_recording_free(recording);
  return value;
}

static void judge(struct tally *t, uint64_t seed, const struct plan *p, const json_t *document, const char *path)
{
  const json_t *rms = json_object_get(json_object_get(document, "result"), "rms_m_per_s2");
  double value = json_number_value(json_object_get(rms, "value")),
         sigma = json_number_value(json_object_get(rms, "sigma")), truth = eo_synthetic_rms(&p->truth, 8);
  bool said = has_finding(document);
  t->by_fault[p->fault][rms ? 1 : 2]++;
  t->numbers += rms != NULL;
  t->refused += rms == NULL;
  t->said += rms && said;
  if (!rms || fabs(value - truth) <= 3 * sigma)
    return;
  bool chance = fabs(value - value_unwritten(p)) <= sigma;
  t->wrong += !said && !chance;
  printf("# %llu: RMS %.5f, truth %.5f, standard deviation %.5f, %s\n", (unsigned long long)seed, value, truth, sigma,
         said     ? "with a finding"
         : chance ? "as the recording itself gives"
                  : "WITHOUT A WORD");
  show(p, document, path);
}

/* The rows as a program brings them to its own rate; *count of them. The caller frees. */
static double *resample(const struct plan *p, const double *rows, int64_t *count)
{
  double step = p->truth.sample_rate / p->rate, *made = malloc((size_t)ROW * 3 * sizeof *made);
  int64_t n = 0;
  if (!made)
    exit(99);
  for (double at = 0; n < ROW && at + 1 < (double)*count; at = step * (double)++n) {
    const double *from = rows + 3 * (int64_t)at;
    double way = p->fault == ON_LINES ? at - floor(at) : 0;
    made[3 * n] = (double)n / p->rate;
    for (int c = 1; c < 3; c++)
      made[3 * n + c] = from[c] + way * (from[3 + c] - from[c]);
  }
  *count = n;
  return made;
}

static void try_one(struct tally *t, uint64_t seed, const char *path, bool keep)
{
  struct plan p;
  make_plan(&p, seed);
  int64_t count = eo_synthetic_rows(&p.truth);
  double *rows = malloc((size_t)count * 3 * sizeof *rows);
  struct sheet sheet = {.plan = &p};
  if (!rows || count > ROW)
    exit(99);
  eo_synthetic_fill(&p.truth, 0, count, rows);
  if (p.fault == ON_LINES || p.fault == LAST_VALUE) {
    double *made = resample(&p, rows, &count);
    free(rows);
    rows = made;
  }
  write_sheet(&sheet, rows, count);
  save(&sheet, path);
  struct eo_geometry geometry = {.teeth = {17, 44}, .base_radius = {0.0518616, 0.1342300}};
  const struct eo_measure_request request = {.path = path,
                                             .torque = NAN,
                                             .stated_speed = NAN,
                                             .speed = {1000 * M_PI / 30, 2000 * M_PI / 30},
                                             .end = 1,
                                             .geometry = &geometry,
                                             .spool_directory = "/tmp"};
  struct eo_error error = {0};
  json_t *document = NULL;
  enum eo_code code = eo_measure_file(&request, NULL, &document, NULL, NULL, &error);
  t->files++;
  t->by_fault[p.fault][0]++;
  if (code) {
    t->refused++;
    t->by_fault[p.fault][2]++;
    printf("# %llu refused: %s %s\n", (unsigned long long)seed, error.pointer, error.text);
    show(&p, NULL, path);
  } else
    judge(t, seed, &p, document, path);
  json_decref(document);
  free(rows);
  free(sheet.text);
  if (!keep)
    unlink(path);
}

int main(int argc, char **argv)
{
  int files = argc > 1 ? atoi(argv[1]) : 100, first = argc > 2 ? atoi(argv[2]) : 0;
  struct tally t = {0};
  char path[64];
  snprintf(path, sizeof path, "/tmp/easeoff-mutated-%ld.csv", (long)getpid());
  for (int i = 0; i < files; i++)
    try_one(&t, (uint64_t)(first + i), path, argc > 3);
  for (int i = 0; i < ROW_FAULTS; i++)
    printf("#   %-14s %4d files, %4d numbers, %4d refused\n", fault_names[i], t.by_fault[i][0], t.by_fault[i][1],
           t.by_fault[i][2]);
  ok(t.wrong == 0, "none of %d files gave a number off by more than three standard deviations without a finding",
     t.files);
  const int lines = t.by_fault[ON_LINES][0]; /* a question is right for these */
  ok(t.numbers - t.by_fault[ON_LINES][1] >= 0.7 * (t.files - lines),
     "%d of %d that are not on lines gave a number (%d with a finding), %d a question",
     t.numbers - t.by_fault[ON_LINES][1], t.files - lines, t.said, t.refused - t.by_fault[ON_LINES][2]);
  ok(t.by_fault[ON_LINES][2] >= 0.9 * lines, "%d of %d on lines are a question", t.by_fault[ON_LINES][2], lines);
  return tap_done();
}

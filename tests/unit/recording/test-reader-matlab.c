/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MATLAB files written by libmatio, the versions 4, 5, 7 (compressed) and 7.3. */
#include "support/reader-fixture.h"

#include <matio.h>
#include <zlib.h>

#define COUNT 70000 /* more than one piece */

static double t[COUNT], pinion[COUNT], gear[COUNT];
static int16_t counts[COUNT];

static void fill(void)
{
  for (int i = 0; i < COUNT; i++) {
    t[i] = 5e-5 * i;
    pinion[i] = 17.25 + 0.6 * i;
    gear[i] = 63.5 - 0.23 * i;
    counts[i] = (int16_t)(i % 20000 - 10000);
  }
}

static mat_t *open_file(enum mat_ft version)
{
  unlink(fixture_path);
  mat_t *file = Mat_CreateVer(fixture_path, NULL, version);
  if (!file)
    exit(97);
  return file;
}

static void put(mat_t *file, const char *name, void *data, enum matio_classes class, enum matio_types type, size_t rows,
                size_t columns, enum matio_compression compression)
{
  size_t dims[2] = {rows, columns};
  matvar_t *v = Mat_VarCreate(name, class, type, 2, dims, data, 0);
  if (!v || Mat_VarWrite(file, v, compression))
    exit(96);
  Mat_VarFree(v);
}

static void put_doubles(mat_t *file, const char *name, double *data, size_t rows, size_t columns,
                        enum matio_compression compression)
{
  put(file, name, data, MAT_C_DOUBLE, MAT_T_DOUBLE, rows, columns, compression);
}

static int wrong_values(const struct eo_recording *r, int column, const double *values)
{
  int wrong = 0;
  for (int i = 0; i < COUNT; i += i < 65000 || i > 66000 ? 997 : 7)
    wrong += cell_of(r, i, column) != values[i];
  return wrong;
}

static int column_of(const struct eo_recording *r, const char *name)
{
  for (int c = 0; r && c < eo_recording_columns(r); c++)
    if (!strcmp(eo_recording_name(r, c), name))
      return c;
  return -1;
}

/* Vectors of both orientations, an integer one, a scalar, a text; columns are found by name. */
static void test_vectors(enum mat_ft version, enum matio_compression compression, const char *what)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  double rate = 20000;
  char text[] = "rig 3";
  mat_t *file = open_file(version);
  put_doubles(file, "t", t, COUNT, 1, compression);
  put_doubles(file, "phi1", pinion, 1, COUNT, compression);
  put_doubles(file, "phi2", gear, COUNT, 1, compression);
  if (version != MAT_FT_MAT4)
    put(file, "counts", counts, MAT_C_INT16, MAT_T_INT16, COUNT, 1, compression);
  put_doubles(file, "fs", &rate, 1, 1, compression);
  if (version != MAT_FT_MAT4)
    put(file, "remark", text, MAT_C_CHAR, MAT_T_UINT8, 1, 5, compression);
  Mat_Close(file);
  struct eo_reader_options options = {.spool_directory = fixture_directory};
  struct eo_recording *r = read_fixture(&options, &notes, &error);
  int c = column_of(r, "counts");
  ok(r && eo_recording_rows(r) == COUNT && eo_recording_columns(r) == (version == MAT_FT_MAT4 ? 3 : 4), "%s is read%s",
     what, r ? "" : error.text);
  ok(r && column_of(r, "t") >= 0 && !wrong_values(r, column_of(r, "t"), t) &&
         !wrong_values(r, column_of(r, "phi1"), pinion) && !wrong_values(r, column_of(r, "phi2"), gear),
     "the values of the vectors are read");
  ok(r && (c < 0 || cell_of(r, 65999, c) == counts[65999]) && fabs(eo_recording_clock(r, 0).interval - 5e-5) < 1e-18,
     "integers and the sampling rate are read");
  eo_recording_free(r);
}

static void test_matrix(enum mat_ft version, enum matio_compression compression, const char *what)
{
  struct eo_error error;
  double *wide = malloc(3 * COUNT * sizeof *wide), *tall = malloc(3 * COUNT * sizeof *tall);
  for (int i = 0; i < COUNT; i++)
    for (int c = 0; c < 3; c++)
      wide[3 * i + c] = tall[c * COUNT + i] = c == 0 ? t[i] : c == 1 ? pinion[i] : gear[i];
  for (int k = 0; k < 2; k++) {
    mat_t *file = open_file(version);
    put_doubles(file, "data", k ? wide : tall, k ? 3 : COUNT, k ? COUNT : 3, compression);
    Mat_Close(file);
    struct eo_recording *r = read_fixture(NULL, NULL, &error);
    ok(r && eo_recording_columns(r) == 3 && !wrong_values(r, 0, t) && !wrong_values(r, 1, pinion) &&
           !wrong_values(r, 2, gear) && !strcmp(eo_recording_name(r, 2), "data 3"),
       "%s with channels in %s is read%s", what, k ? "rows" : "columns", r ? "" : error.text);
    eo_recording_free(r);
  }
  free(wide);
  free(tall);
}

static void test_struct(enum mat_ft version, enum matio_compression compression, const char *what)
{
  struct eo_error error;
  static const char *const fields[] = {"t", "phi1", "phi2"};
  double *const data[] = {t, pinion, gear};
  size_t one[2] = {1, 1}, dims[2] = {COUNT, 1};
  mat_t *file = open_file(version);
  matvar_t *s = Mat_VarCreateStruct("run", 2, one, (const char **)fields, 3);
  for (int i = 0; i < 3; i++)
    Mat_VarSetStructFieldByName(s, fields[i], 0,
                                Mat_VarCreate(fields[i], MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, data[i], 0));
  if (Mat_VarWrite(file, s, compression))
    exit(95);
  Mat_VarFree(s);
  Mat_Close(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 3 && column_of(r, "phi2") >= 0 && !wrong_values(r, column_of(r, "t"), t) &&
         !wrong_values(r, column_of(r, "phi2"), gear),
     "%s is read%s", what, r ? "" : error.text);
  eo_recording_free(r);
}

static void test_gzip(void)
{
  struct eo_error error;
  mat_t *file = open_file(MAT_FT_MAT5);
  put_doubles(file, "phi1", pinion, COUNT, 1, MAT_COMPRESSION_NONE);
  Mat_Close(file);
  FILE *plain = fopen(fixture_path, "rb");
  fseek(plain, 0, SEEK_END);
  size_t size = (size_t)ftell(plain);
  rewind(plain);
  char *bytes = malloc(size);
  if (fread(bytes, 1, size, plain) != size)
    exit(94);
  fclose(plain);
  gzFile zipped = gzopen(fixture_path, "wb1");
  gzwrite(zipped, bytes, (unsigned)size);
  gzclose(zipped);
  free(bytes);
  struct eo_reader_options options = {.spool_directory = fixture_directory};
  struct eo_recording *r = read_fixture(&options, NULL, &error);
  ok(r && !wrong_values(r, 0, pinion), "a gzip file of a struct is read");
  eo_recording_free(r);
  refused("without gzip", "a gzip file without a folder");
}

/* A file with bytes cut off or set: an error or a recording, never the end of this process. */
static void test_damage(enum mat_ft version, enum matio_compression compression, const char *what)
{
  struct eo_error error;
  mat_t *file = open_file(version);
  put_doubles(file, "t", t, 500, 1, compression);
  put_doubles(file, "phi1", pinion, 500, 1, compression);
  Mat_Close(file);
  FILE *plain = fopen(fixture_path, "rb");
  static unsigned char bytes[1 << 20];
  size_t size = fread(bytes, 1, sizeof bytes, plain);
  fclose(plain);
  int read = 0, failed = 0;
  for (size_t i = 0; i < 120; i++) {
    size_t at = 120 + i * (size - 120) / 120 * (i % 2 ? 1 : 0) + (i % 2 ? 0 : i);
    unsigned char old = bytes[at];
    bytes[at] = (unsigned char)(i % 3 ? 0xff : old ^ 1 << i % 8);
    write_bytes(bytes, i % 5 ? size : at + 1);
    bytes[at] = old;
    struct eo_recording *r = read_fixture(NULL, NULL, &error);
    read += r != NULL;
    failed += r == NULL && error.code == EO_ERROR_INPUT;
    eo_recording_free(r);
  }
  ok(read + failed == 120 && failed > 0, "every damage of %s is read or refused: %d read, %d refused", what, read,
     failed);
}

static void test_cut_off(enum matio_compression compression, const char *what)
{
  mat_t *file = open_file(MAT_FT_MAT5);
  put_doubles(file, "t", t, 500, 1, compression);
  put_doubles(file, "phi1", pinion, 500, 1, compression);
  Mat_Close(file);
  FILE *plain = fopen(fixture_path, "rb");
  fseek(plain, 0, SEEK_END);
  long size = ftell(plain);
  fclose(plain);
  ok(!truncate(fixture_path, size - 20), "a file of MATLAB is cut off");
  refused("it is cut off", what);
}

/* A fact beside a channel: a number, or a text where there is one. */
struct fact {
  const char *name, *text;
  double number;
};

static matvar_t *variable_of(const struct fact *fact)
{
  char text[64] = "";
  double number = fact->number;
  size_t one[2] = {1, 1}, letters[2] = {1, fact->text ? strlen(fact->text) : 0};
  snprintf(text, sizeof text, "%s", fact->text ? fact->text : "");
  return fact->text ? Mat_VarCreate(fact->name, MAT_C_CHAR, MAT_T_UINT8, 2, letters, text, 0)
                    : Mat_VarCreate(fact->name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one, &number, 0);
}

/* A struct with 500 values and up to three facts; those without a name are none. time: it holds its times too. */
static matvar_t *channel_of(const char *name, double *data, double *time, const struct fact facts[3])
{
  const char *fields[5] = {"Data", "Time"};
  size_t one[2] = {1, 1}, dims[2] = {500, 1};
  unsigned count = time ? 2 : 1;
  for (int i = 0; i < 3 && facts[i].name; i++)
    fields[count++] = facts[i].name;
  matvar_t *channel = Mat_VarCreateStruct(name, 2, one, fields, count);
  Mat_VarSetStructFieldByName(channel, "Data", 0, Mat_VarCreate("Data", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, data, 0));
  if (time)
    Mat_VarSetStructFieldByName(channel, "Time", 0,
                                Mat_VarCreate("Time", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, time, 0));
  for (int i = 0; i < 3 && facts[i].name; i++)
    Mat_VarSetStructFieldByName(channel, facts[i].name, 0, variable_of(&facts[i]));
  return channel;
}

static struct eo_recording *read_channels(double *time, const struct fact pinion_facts[3],
                                          const struct fact gear_facts[3], struct eo_notes *notes)
{
  struct eo_error error;
  mat_t *file = open_file(MAT_FT_MAT5);
  matvar_t *channel[2] = {channel_of("pinion", pinion, time, pinion_facts), channel_of("gear", gear, time, gear_facts)};
  for (int i = 0; i < 2; i++) {
    if (Mat_VarWrite(file, channel[i], MAT_COMPRESSION_NONE))
      exit(93);
    Mat_VarFree(channel[i]);
  }
  Mat_Close(file);
  return read_fixture(NULL, notes, &error);
}

static struct eo_clock clock_of(const struct eo_recording *r, const char *name)
{
  int c = column_of(r, name);
  return c < 0 ? (struct eo_clock){.interval = NAN} : eo_recording_clock(r, c);
}

static void interval_of(struct fact first, struct fact second, double interval, double other, const char *what)
{
  const struct fact facts[3] = {first, second};
  struct eo_recording *r = read_channels(NULL, facts, facts, NULL);
  struct eo_clock clock = clock_of(r, "pinion");
  ok(fabs(clock.interval - interval) < 1e-12 && fabs(clock.other - other) < 1e-12, "%s: the intervals are %g and %g s",
     what, clock.interval, clock.other);
  eo_recording_free(r);
}

static void test_intervals(void)
{
  const struct fact none = {0}, rate = {"fs", NULL, 4000};
  interval_of((struct fact){"fs", "4000", 0}, none, 2.5e-4, 0, "a rate that is a text");
  interval_of((struct fact){"fs", "4 kHz", 0}, none, 2.5e-4, 0, "a rate with its unit in a text");
  interval_of((struct fact){"dt", "0,25 ms", 0}, none, 2.5e-4, 0, "an interval with a decimal comma in a text");
  interval_of((struct fact){"dx", NULL, 0.25}, (struct fact){"xunit", "ms", 0}, 2.5e-4, 0,
              "an interval in the unit of its axis");
  interval_of(rate, (struct fact){"timeunit", "ms", 0}, 2.5e-4, 0, "a rate beside the unit of an axis stays a rate");
  interval_of(rate, (struct fact){"dt", NULL, 2.5e-4}, 2.5e-4, 0, "a rate and an interval that agree");
  interval_of(rate, (struct fact){"dt", NULL, 1.25e-4}, 2.5e-4, 1.25e-4, "a rate and an interval that contradict it");
  interval_of(rate, (struct fact){"decimation", NULL, 10}, 2.5e-4, 2.5e-3, "a rate before or behind a decimation");
}

/* What the start of the gear is later by than that of the pinion, s. */
static double later(struct fact pinion_start, struct fact gear_start, double *time, struct eo_notes *notes)
{
  const struct fact rate = {"fs", NULL, 4000}, one[3] = {pinion_start, rate}, two[3] = {gear_start, rate};
  struct eo_recording *r = read_channels(time, one, two, notes);
  struct eo_clock a = clock_of(r, "pinion"), b = clock_of(r, "gear");
  if (a.column >= 0 && b.column >= 0)
    a = eo_recording_clock(r, a.column), b = eo_recording_clock(r, b.column);
  eo_recording_free(r);
  return b.start - a.start + (a.epoch == EO_CLOCK_NO_EPOCH ? 0 : 1e-9 * (double)(b.epoch - a.epoch));
}

static void test_starts(void)
{
  static double since_1970[500];
  struct eo_notes notes = {0};
  const struct fact one = {"start_time", "05-Mar-2024 08:59:59.250", 0},
                    two = {"start_time", "05-Mar-2024 08:59:59.300", 0};
  for (int i = 0; i < 500; i++)
    since_1970[i] = 1709629199.25 + t[i];
  ok(fabs(later(one, two, NULL, NULL) - 0.05) < 1e-9, "starts that are texts are 50 ms apart");
  ok(fabs(later((struct fact){"t0", "08:59:59.250", 0}, (struct fact){"t0", "08:59:59.300", 0}, NULL, NULL) - 0.05) <
         1e-9,
     "starts with the time of day alone are 50 ms apart");
  ok(fabs(later(one, two, t, NULL) - 0.05) < 1e-9, "starts of times that begin with the recording are 50 ms apart");
  ok(later(one, two, since_1970, NULL) == 0, "times since 1970 are not moved by the start beside them");
  ok(later((struct fact){"created", "2024-03-05 08:59:59", 0}, (struct fact){"created", "2024-03-05 09:00:02", 0}, NULL,
           NULL) == 0,
     "when a channel was written is not when it began");
  ok(fabs(later((struct fact){"t0", NULL, 739316.375}, (struct fact){"t0", NULL, 739316.375 + 0.05 / 86400}, NULL,
                &notes) -
          0.05) < 2e-5 &&
         noted(&notes, "day numbers"),
     "starts that are MATLAB's day numbers are 50 ms apart, which is said");
}

/* A timeseries as a struct says more of its times than of its values. */
static void test_time_info(void)
{
  static double milliseconds[500];
  size_t one[2] = {1, 1};
  const char *const fields[] = {"Units"};
  const char *const names[] = {"pinion", "gear"};
  struct eo_error error;
  mat_t *file = open_file(MAT_FT_MAT5);
  for (int i = 0; i < 500; i++)
    milliseconds[i] = 1e3 * t[i];
  for (int i = 0; i < 2; i++) {
    matvar_t *info = Mat_VarCreateStruct("TimeInfo", 2, one, (const char **)fields, 1);
    Mat_VarSetStructFieldByName(info, "Units", 0, variable_of(&(struct fact){"Units", "ms", 0}));
    matvar_t *channel = channel_of(names[i], i ? gear : pinion, milliseconds, (struct fact[3]){{"TimeInfo", "", 0}});
    Mat_VarFree(Mat_VarSetStructFieldByName(channel, "TimeInfo", 0, info));
    if (Mat_VarWrite(file, channel, MAT_COMPRESSION_NONE))
      exit(92);
    Mat_VarFree(channel);
  }
  Mat_Close(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int c = column_of(r, "pinion"), time = c < 0 ? -1 : eo_recording_clock(r, c).column;
  ok(c >= 0 && !*eo_recording_unit(r, c) && time >= 0 && !strcmp(eo_recording_unit(r, time), "ms"),
     "TimeInfo.Units is the unit of the times, not of the values");
  eo_recording_free(r);
}

/* Dimensions of length 1 say nothing: Simulink writes 2 x 1 x N. */
static void test_flat(enum matio_compression compression)
{
  struct eo_error error;
  size_t dims[3] = {2, 1, COUNT / 2};
  mat_t *file = open_file(MAT_FT_MAT5);
  matvar_t *v = Mat_VarCreate("values", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, dims, pinion, 0);
  if (!v || Mat_VarWrite(file, v, compression))
    exit(91);
  Mat_VarFree(v);
  Mat_Close(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && eo_recording_rows(r) == COUNT / 2 && cell_of(r, 34000, 0) == pinion[68000] &&
         cell_of(r, 34000, 1) == pinion[68001],
     "2 x 1 x N values are two channels%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* Files of version 4 from a machine of the other byte order have no signature either. */
static void test_big_endian(void)
{
  enum { ROWS = 100 };
  static unsigned char bytes[2 * (22 + 8 * ROWS)];
  size_t size = 0;
  for (int variable = 0; variable < 2; variable++) {
    const uint32_t head[5] = {1000, ROWS, 1, 0, 2};
    for (int i = 0; i < 20; i++)
      bytes[size++] = (unsigned char)(head[i / 4] >> (24 - 8 * (i % 4)));
    bytes[size++] = variable ? 'g' : 'p';
    bytes[size++] = 0;
    for (int i = 0; i < ROWS; i++) {
      uint64_t word;
      memcpy(&word, variable ? &gear[i] : &pinion[i], sizeof word);
      for (int k = 0; k < 8; k++)
        bytes[size++] = (unsigned char)(word >> (56 - 8 * k));
    }
  }
  write_bytes(bytes, size);
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && column_of(r, "g") >= 0 && cell_of(r, 99, column_of(r, "g")) == gear[99],
     "a file of version 4 with the high byte first is read%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* What lies too deep, and variables beyond those that are looked at, are counted. */
static void test_left_out(void)
{
  enum { DEPTH = 12, MANY = 1030 };
  static const char *const field[] = {"f"};
  struct eo_error error;
  struct eo_notes notes = {0};
  size_t one[] = {1, 1}, rows[] = {COUNT, 1};
  mat_t *file = open_file(MAT_FT_MAT5);
  matvar_t *inner = Mat_VarCreate("f", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, rows, gear, 0);
  for (int i = 0; i < DEPTH; i++) {
    matvar_t *outer = Mat_VarCreateStruct(i + 1 < DEPTH ? "f" : "deep", 2, one, (const char **)field, 1);
    Mat_VarSetStructFieldByName(outer, "f", 0, inner);
    inner = outer;
  }
  Mat_VarWrite(file, inner, MAT_COMPRESSION_NONE);
  Mat_VarFree(inner);
  put_doubles(file, "pinion", pinion, COUNT, 1, MAT_COMPRESSION_NONE);
  for (int i = 0; i < MANY; i++) {
    char name[16];
    snprintf(name, sizeof name, "x%d", i);
    put_doubles(file, name, pinion, 1, 1, MAT_COMPRESSION_NONE);
  }
  Mat_Close(file);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_columns(r) == 1 && noted(&notes, "9 variables are no channel"), "what is left out is counted%s",
     r ? notes.count ? notes.text[0] : "" : error.text);
  eo_recording_free(r);
}

int main(void)
{
  fixture_open();
  fill();
  test_vectors(MAT_FT_MAT4, MAT_COMPRESSION_NONE, "version 4");
  test_vectors(MAT_FT_MAT5, MAT_COMPRESSION_NONE, "version 5");
  test_vectors(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, "version 7");
  test_vectors(MAT_FT_MAT73, MAT_COMPRESSION_NONE, "version 7.3");
  test_vectors(MAT_FT_MAT73, MAT_COMPRESSION_ZLIB, "version 7.3, compressed");
  test_matrix(MAT_FT_MAT5, MAT_COMPRESSION_NONE, "a matrix of version 5");
  test_matrix(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, "a matrix of version 7");
  test_matrix(MAT_FT_MAT73, MAT_COMPRESSION_NONE, "a matrix of version 7.3");
  test_struct(MAT_FT_MAT5, MAT_COMPRESSION_NONE, "a struct of version 5");
  test_struct(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, "a struct of version 7");
  test_struct(MAT_FT_MAT73, MAT_COMPRESSION_NONE, "a struct of version 7.3");
  test_intervals();
  test_starts();
  test_time_info();
  test_big_endian();
  test_left_out();
  test_flat(MAT_COMPRESSION_NONE);
  test_flat(MAT_COMPRESSION_ZLIB);
  test_gzip();
  test_cut_off(MAT_COMPRESSION_NONE, "version 5 that is cut off");
  test_cut_off(MAT_COMPRESSION_ZLIB, "version 7 that is cut off");
  test_damage(MAT_FT_MAT5, MAT_COMPRESSION_NONE, "version 5");
  test_damage(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, "version 7");
  test_damage(MAT_FT_MAT73, MAT_COMPRESSION_NONE, "version 7.3");
  return fixture_close();
}

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
  ok(r && eo_recording_rows(r) == COUNT && eo_recording_columns(r) == (version == MAT_FT_MAT4 ? 3 : 4), "%s%s", what,
     r ? "" : error.text);
  ok(r && column_of(r, "t") >= 0 && !wrong_values(r, column_of(r, "t"), t) &&
         !wrong_values(r, column_of(r, "phi1"), pinion) && !wrong_values(r, column_of(r, "phi2"), gear),
     "values");
  ok(r && (c < 0 || cell_of(r, 65999, c) == counts[65999]) && fabs(eo_recording_clock(r, 0).interval - 5e-5) < 1e-18,
     "integers, sampling rate");
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
       "%s, channels in %s%s", what, k ? "rows" : "columns", r ? "" : error.text);
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
     "%s%s", what, r ? "" : error.text);
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
  ok(r && !wrong_values(r, 0, pinion), "a gzip file of it");
  eo_recording_free(r);
  refused("without gzip", "but not without a folder");
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
  ok(read + failed == 120 && failed > 0, "damaged %s: %d read, %d refused", what, read, failed);
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
  ok(!truncate(fixture_path, size - 20), "cut");
  refused("it is cut off", what);
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
  test_gzip();
  test_cut_off(MAT_COMPRESSION_NONE, "version 5 that is cut off");
  test_cut_off(MAT_COMPRESSION_ZLIB, "version 7 that is cut off");
  test_damage(MAT_FT_MAT5, MAT_COMPRESSION_NONE, "version 5");
  test_damage(MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, "version 7");
  test_damage(MAT_FT_MAT73, MAT_COMPRESSION_NONE, "version 7.3");
  return fixture_close();
}

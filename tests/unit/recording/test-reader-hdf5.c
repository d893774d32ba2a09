/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 files written by the library itself: one data set per channel, tables, units, other files that must not be read.
 */
#include "support/reader-fixture.h"

#include <hdf5.h>
#include <math.h>
#include <sys/resource.h>

#define COUNT 5000

static double t[COUNT], pinion[COUNT];
static float gear[COUNT];

static hid_t open_file(void)
{
  unlink(fixture_path);
  hid_t file = H5Fcreate(fixture_path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0)
    exit(97);
  return file;
}

static hid_t put(hid_t place, const char *name, int rank, const hsize_t *dims, hid_t stored, hid_t type,
                 const void *data, hid_t list)
{
  hid_t space = H5Screate_simple(rank, dims, NULL);
  hid_t set = H5Dcreate2(place, name, stored, space, H5P_DEFAULT, list, H5P_DEFAULT);
  if (set < 0 || (data && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
    exit(96);
  H5Sclose(space);
  return set;
}

static void put_text(hid_t object, const char *name, const char *text, int variable)
{
  hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, variable ? H5T_VARIABLE : strlen(text));
  hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, variable ? (const void *)&text : text);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

static void put_double(hid_t object, const char *name, double value)
{
  hid_t space = H5Screate(H5S_SCALAR);
  hid_t attribute = H5Acreate2(object, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  H5Sclose(space);
}

static void test_channels(void)
{
  struct eo_error error;
  hsize_t count = COUNT, few = 3, chunk = 512;
  hid_t list = H5Pcreate(H5P_DATASET_CREATE), file = open_file();
  H5Pset_chunk(list, 1, &chunk);
  H5Pset_deflate(list, 6);
  hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  hid_t set = put(group, "a time", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, t, H5P_DEFAULT);
  put_text(set, "unit", "s", 0);
  H5Dclose(set);
  set = put(group, "pinion", 1, &count, H5T_IEEE_F64BE, H5T_NATIVE_DOUBLE, pinion, list);
  put_text(set, "units", "deg", 1);
  H5Dclose(set);
  H5Dclose(put(group, "rear gear", 1, &count, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, gear, list));
  H5Dclose(put(file, "settings", 1, &few, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, t, H5P_DEFAULT));
  H5Gclose(group);
  put_double(file, "sample_rate", 20000);
  H5Fclose(file);
  H5Pclose(list);
  struct eo_notes notes = {0};
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  int wrong = !r || eo_recording_columns(r) != 3 || eo_recording_rows(r) != COUNT;
  for (int i = 0; !wrong && i < COUNT; i++)
    wrong += cell_of(r, i, 0) != t[i] || cell_of(r, i, 1) != pinion[i] || cell_of(r, i, 2) != gear[i];
  ok(!wrong, "three data sets of one length are read, one compressed, one of the other byte order%s",
     r ? "" : error.text);
  ok(r && !strcmp(eo_recording_unit(r, 0), "s") && !strcmp(eo_recording_unit(r, 1), "deg") &&
         !strcmp(eo_recording_name(r, 2), "rear gear"),
     "names and units of the data sets are read");
  ok(r && eo_recording_clock(r, 0).interval == 5e-5 && noted(&notes, "\"settings\" with 3 values"),
     "the sampling rate is read, and a note says what was left out");
  eo_recording_free(r);
}

static void test_table(void)
{
  struct eo_error error;
  hsize_t dims[2] = {COUNT, 2};
  int32_t *table = malloc(2 * COUNT * sizeof *table);
  for (int i = 0; i < COUNT; i++) {
    table[2 * i] = i;
    table[2 * i + 1] = -3 * i;
  }
  hid_t file = open_file();
  H5Dclose(put(file, "counts", 2, dims, H5T_STD_I32LE, H5T_NATIVE_INT32, table, H5P_DEFAULT));
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && cell_of(r, 4321, 0) == 4321 && cell_of(r, 4321, 1) == -12963 &&
         !strcmp(eo_recording_name(r, 1), "counts 2"),
     "a table of integers is read%s", r ? "" : error.text);
  eo_recording_free(r);
  free(table);
}

/* Rates, starts and scales that are written as texts. */
static void test_texts(void)
{
  struct eo_error error;
  hsize_t count = COUNT;
  hid_t file = open_file();
  for (int c = 0; c < 2; c++) {
    hid_t set = put(file, c ? "pinion" : "gear", 1, &count, H5T_STD_I32LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT);
    put_text(set, "sample_rate", "4 kHz", c);
    put_text(set, "t0", c ? "2024-03-05T08:59:59.250Z" : "2024-03-05T08:59:59.300Z", c);
    put_text(set, "scale", "0.5 deg/count", c);
    put_text(set, "gain", "10 dB", c);
    H5Dclose(set);
  }
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && fabs(eo_recording_clock(r, 0).interval - 2.5e-4) < 1e-12, "a rate with its unit in a text is read%s",
     r ? "" : error.text);
  ok(r && eo_recording_clock(r, 0).epoch - eo_recording_clock(r, 1).epoch == 50000000,
     "starts that are texts are 50 ms apart");
  ok(r && !strcmp(eo_recording_unit(r, 0), "deg") && cell_of(r, 10, 0) == 0.5 * trunc(pinion[10]),
     "a scale that is a text is read with the unit of the product, and one in dB is not");
  eo_recording_free(r);
}

/* The start of a channel that has its own times may stand at its values. */
static void test_start_at_values(void)
{
  struct eo_error error;
  hsize_t count = COUNT;
  hid_t file = open_file();
  for (int i = 0; i < 2; i++) {
    hid_t group = H5Gcreate2(file, i ? "pinion" : "gear", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    hid_t set = put(group, "data", 1, &count, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT);
    put_text(set, "start_time", i ? "2024-03-05T08:59:59.250Z" : "2024-03-05T08:59:59.300Z", 0);
    H5Dclose(set);
    H5Dclose(put(group, "time", 1, &count, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, t, H5P_DEFAULT));
    H5Gclose(group);
  }
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int first = r ? eo_recording_clock(r, 0).column : -1, second = r ? eo_recording_clock(r, 2).column : -1;
  ok(first >= 0 && second >= 0 && eo_recording_clock(r, first).epoch - eo_recording_clock(r, second).epoch == 50000000,
     "the start that is stated at the values of a channel is that of its times%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* Times that are texts, of fixed and of variable length; in between one that is none. */
static void test_moments(int variable)
{
  enum { ROWS = 5000, WIDTH = 32 };
  static char fixed[ROWS][WIDTH];
  static const char *pointers[ROWS];
  struct eo_error error;
  hsize_t count = ROWS;
  for (int i = 0; i < ROWS; i++) {
    snprintf(fixed[i], WIDTH, "2024-03-05T23:59:%06.3fZ", 58 + 1e-3 * i);
    if (i >= 2000)
      snprintf(fixed[i], WIDTH, "2024-03-06T00:00:%06.3fZ", 1e-3 * (i - 2000));
    pointers[i] = fixed[i];
  }
  snprintf(fixed[7], WIDTH, "-");
  hid_t type = H5Tcopy(H5T_C_S1), file = open_file();
  H5Tset_size(type, variable ? H5T_VARIABLE : WIDTH);
  H5Dclose(put(file, "timestamp", 1, &count, type, type, variable ? (const void *)pointers : fixed, H5P_DEFAULT));
  H5Dclose(put(file, "value", 1, &count, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  H5Tclose(type);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && !strcmp(eo_recording_unit(r, 0), "s") &&
         eo_recording_clock(r, 1).column == 0 && fabs(cell_of(r, 4999, 0) - 86402.999) < 1e-9 &&
         isnan(cell_of(r, 7, 0)),
     "times that are texts of %s length are read as seconds, over midnight as well%s", variable ? "variable" : "fixed",
     r ? "" : error.text);
  eo_recording_free(r);
}

/* Dimensions of length 1 say nothing. */
static void test_flat(void)
{
  struct eo_error error;
  const hsize_t one[3] = {COUNT, 1, 1}, two[3] = {1, 2, 20};
  hid_t file = open_file();
  H5Dclose(put(file, "pinion", 3, one, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 1 && cell_of(r, 4321, 0) == pinion[4321], "N x 1 x 1 values are a channel%s",
     r ? "" : error.text);
  eo_recording_free(r);
  file = open_file();
  H5Dclose(put(file, "both", 3, two, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  H5Fclose(file);
  r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && cell_of(r, 3, 1) == pinion[23], "1 x 2 x N values are two channels%s",
     r ? "" : error.text);
  eo_recording_free(r);
}

/* Octave keeps each variable in a group; pandas pickles the name of an index that has none. */
static void test_habits(void)
{
  struct eo_error error;
  hsize_t count = COUNT;
  const double rate = 4000;
  hid_t file = open_file(), space = H5Screate(H5S_SCALAR), group[2];
  for (int i = 0; i < 2; i++) {
    group[i] = H5Gcreate2(file, i ? "pinion" : "fs", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    put_double(group[i], "OCTAVE_NEW_FORMAT", 1);
  }
  hid_t set = H5Dcreate2(group[0], "value", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &rate);
  H5Dclose(set);
  set = put(group[1], "value", 1, &count, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT);
  put_text(set, "name", "N.", 0);
  H5Dclose(set);
  hid_t frame = H5Gcreate2(file, "frame", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  set = put(frame, "axis1", 1, &count, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, t, H5P_DEFAULT);
  put_text(set, "name", "N.", 0);
  H5Dclose(set);
  H5Gclose(frame);
  H5Sclose(space);
  H5Gclose(group[0]);
  H5Gclose(group[1]);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && fabs(eo_recording_clock(r, 0).interval - 2.5e-4) < 1e-12,
     "a variable of Octave is what its group is called%s", r ? "" : error.text);
  ok(r && !strcmp(eo_recording_name(r, 1), "pinion") && !strcmp(eo_recording_name(r, 0), "index"),
     "a pickled None is no name, and an index has its own");
  eo_recording_free(r);
}

/* Three channels of LONG rows, in chunks of so many. */
enum { LONG = 400000 };

static void write_long(hsize_t chunk)
{
  static const char *const names[] = {"t_s", "pinion_deg", "gear_deg"};
  hsize_t count = LONG;
  hid_t list = H5Pcreate(H5P_DATASET_CREATE), file = open_file();
  double *value = malloc(sizeof *value * LONG);
  if (!value)
    exit(95);
  H5Pset_chunk(list, 1, &chunk);
  H5Pset_deflate(list, 1);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < LONG; i++)
      value[i] = k == 0 ? 1e-4 * i : 0.37 * i / k;
    H5Dclose(put(file, names[k], 1, &count, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, value, list));
  }
  free(value);
  H5Pclose(list);
  H5Fclose(file);
}

/* Seconds of a processor, in the process that reads. */
static double time_to_read(int64_t *rows)
{
  struct eo_error error;
  struct rusage before, after;
  getrusage(RUSAGE_CHILDREN, &before);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  getrusage(RUSAGE_CHILDREN, &after);
  *rows = r ? eo_recording_rows(r) : 0;
  eo_recording_free(r);
  return (double)(after.ru_utime.tv_sec - before.ru_utime.tv_sec) +
         1e-6 * (double)(after.ru_utime.tv_usec - before.ru_utime.tv_usec);
}

/* A chunk that holds everything, as other programs write without malice, was unpacked again for every piece. */
static void test_one_chunk(void)
{
  int64_t rows, same;
  write_long(10000);
  double many = time_to_read(&rows);
  write_long(LONG);
  double one = time_to_read(&same);
  ok(rows == LONG && same == LONG, "%d rows are read in chunks and in one", LONG);
  ok(one < 3 * many + 0.2, "chunks cost no time: one takes %.2f s of a processor, chunks of 10000 rows %.2f s", one,
     many);
}

static size_t pass_on(unsigned flags, size_t count, const unsigned values[], size_t bytes, size_t *room, void **data)
{
  return (void)flags, (void)count, (void)values, (void)room, (void)data, bytes;
}

/* Values packed by a filter of another library (h5py: lzf, PyTables: blosc) are refused by its name. */
static void test_packing(void)
{
  enum { FILTER = 32000 };
  hsize_t count = COUNT, chunk = 1000;
  const H5Z_class2_t packing = {H5Z_CLASS_T_VERS, FILTER, 1, 1, "packer", NULL, NULL, pass_on};
  hid_t list = H5Pcreate(H5P_DATASET_CREATE), file = open_file();
  H5Zregister(&packing);
  H5Pset_chunk(list, 1, &chunk);
  H5Pset_shuffle(list);
  H5Pset_filter(list, FILTER, 0, 0, NULL);
  H5Dclose(put(file, "pinion", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, pinion, list));
  H5Fclose(file);
  H5Pclose(list);
  H5Zunregister(FILTER);
  refused("\"pinion\" is packed in a way (packer, filter 32000) that is not read", "an unknown filter");
}

static void test_hostile(void)
{
  struct eo_error error;
  hsize_t count = COUNT, huge = (hsize_t)1 << 50, chunk = 1 << 20;
  hid_t list = H5Pcreate(H5P_DATASET_CREATE), file = open_file();
  H5Pset_external(list, "/etc/passwd", 0, COUNT * 8);
  H5Dclose(put(file, "stolen", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, NULL, list));
  H5Lcreate_external("/etc/other.h5", "/set", file, "elsewhere", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  H5Pclose(list);
  struct eo_notes notes = {0};
  ok(!read_fixture(NULL, &notes, &error) && strstr(error.text, "no channel with numbers"), "data in other files");
  ok(noted(&notes, "\"stolen\" keeps its values in another file") &&
         noted(&notes, "\"elsewhere\" keeps its values in another file"),
     "it is said which values stand in other files");
  list = H5Pcreate(H5P_DATASET_CREATE);
  file = open_file();
  H5Pset_chunk(list, 1, &chunk);
  H5Dclose(put(file, "endless", 1, &huge, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, NULL, list));
  H5Fclose(file);
  H5Pclose(list);
  refused("more than the", "a data set of 2^50 values that are nowhere");
  file = open_file();
  H5Dclose(put(file, "pinion", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  H5Fclose(file);
  ok(!truncate(fixture_path, 20000), "a file of HDF5 is cut off");
  refused("cut off at byte 20000", "a file that is cut off");
  static unsigned char bytes[1 << 17];
  file = open_file();
  H5Dclose(put(file, "pinion", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  H5Fclose(file);
  FILE *plain = fopen(fixture_path, "rb");
  size_t size = fread(bytes, 1, sizeof bytes, plain);
  fclose(plain);
  int answers = 0;
  for (size_t i = 0; i < 100; i++) {
    unsigned char old = bytes[9 + 7 * i];
    bytes[9 + 7 * i] = i % 2 ? 0xff : 0x21;
    write_bytes(bytes, size);
    bytes[9 + 7 * i] = old;
    struct eo_recording *r = read_fixture(NULL, NULL, &error);
    answers += r || error.code == EO_ERROR_INPUT;
    eo_recording_free(r);
  }
  ok(answers == 100, "a file that is damaged in 100 places is a recording or an error each time");
}

/* Every group holds every other one, and a list of references refers to itself. */
static void test_circles(void)
{
  enum { GROUPS = 8 };
  struct eo_error error;
  hsize_t count = COUNT, two = 2;
  hid_t group[GROUPS], file = open_file();
  char name[16];
  for (int g = 0; g < GROUPS; g++) {
    snprintf(name, sizeof name, "g%d", g);
    group[g] = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  }
  for (int g = 0; g < GROUPS * GROUPS; g++) {
    snprintf(name, sizeof name, "l%d", g % GROUPS);
    H5Lcreate_hard(group[g % GROUPS], ".", group[g / GROUPS], name, H5P_DEFAULT, H5P_DEFAULT);
  }
  H5Dclose(put(group[3], "pinion", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  hobj_ref_t self[2];
  hid_t references = put(file, "refers", 1, &two, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, NULL, H5P_DEFAULT);
  H5Rcreate(&self[0], file, "refers", H5R_OBJECT, -1);
  H5Rcreate(&self[1], file, "refers", H5R_OBJECT, -1);
  H5Dwrite(references, H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, self);
  H5Dclose(references);
  for (int g = 0; g < GROUPS; g++)
    H5Gclose(group[g]);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 1 && cell_of(r, 7, 0) == pinion[7], "groups in circles: each is read once%s",
     r ? "" : error.text);
  eo_recording_free(r);
}

/* A record with more fields than most: the encoders stand last. */
static void test_wide_records(void)
{
  enum { FIELDS = 100 };
  struct eo_error error;
  hsize_t count = 50;
  static double rows[50][FIELDS];
  char name[16];
  hid_t type = H5Tcreate(H5T_COMPOUND, sizeof *rows), file = open_file();
  for (int i = 0; i < FIELDS; i++) {
    snprintf(name, sizeof name, "field %d", i);
    H5Tinsert(type, name, (size_t)i * sizeof **rows, H5T_NATIVE_DOUBLE);
  }
  for (int k = 0; k < 50; k++)
    rows[k][FIELDS - 1] = pinion[k];
  H5Dclose(put(file, "log", 1, &count, type, type, rows, H5P_DEFAULT));
  H5Tclose(type);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == FIELDS && cell_of(r, 9, FIELDS - 1) == pinion[9],
     "all of a hundred fields of a record are read%s", r ? "" : error.text);
  eo_recording_free(r);
}

static void put_side(hid_t file, const char *name, const double *values)
{
  hsize_t count = COUNT;
  hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  hid_t set = put(group, "angle", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values, H5P_DEFAULT);
  put_double(set, "_FillValue", values[11]);
  H5Dclose(set);
  H5Dclose(put(group, "time", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, t, H5P_DEFAULT));
  H5Gclose(group);
}

/* Channels of one name are told apart by their groups; what a data set calls missing is no value. */
static void test_namesakes(void)
{
  struct eo_error error;
  hid_t file = open_file();
  put_side(file, "wheel", pinion);
  put_side(file, "shaft", t);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && !strcmp(eo_recording_name(r, 0), "shaft angle") && !strcmp(eo_recording_name(r, 2), "wheel angle") &&
         !strcmp(eo_recording_name(r, 3), "wheel time"),
     "channels of one name: \"%s\", \"%s\"", r ? eo_recording_name(r, 0) : error.text,
     r ? eo_recording_name(r, 2) : "");
  ok(r && isnan(cell_of(r, 11, 2)) && cell_of(r, 12, 2) == pinion[12], "a value that is stated to be missing");
  eo_recording_free(r);
}

/* Two lists of dates, one from before midnight and one from after it; a fill value that is no attribute. */
static void test_two_days(void)
{
  enum { STAMPS = 100 };
  static char stamps[2][STAMPS][24];
  struct eo_error error;
  hsize_t count = STAMPS;
  double fill = -999;
  for (int i = 0; i < STAMPS; i++) {
    snprintf(stamps[0][i], sizeof stamps[0][i], "2024-03-05T23:59:59.5%02d", i);
    snprintf(stamps[1][i], sizeof stamps[1][i], "2024-03-06T00:00:00.1%02d", i);
  }
  hid_t text = H5Tcopy(H5T_C_S1), list = H5Pcreate(H5P_DATASET_CREATE), file = open_file();
  H5Tset_size(text, 24);
  H5Dclose(put(file, "first", 1, &count, text, text, stamps[0], H5P_DEFAULT));
  H5Dclose(put(file, "second", 1, &count, text, text, stamps[1], H5P_DEFAULT));
  H5Pset_fill_value(list, H5T_NATIVE_DOUBLE, &fill);
  H5Dclose(put(file, "unwritten", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, NULL, list));
  H5Tclose(text);
  H5Pclose(list);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && fabs(cell_of(r, 1, 1) - cell_of(r, 1, 0) - 0.6) < 1e-6, "dates of two lists count from one midnight%s",
     r ? "" : error.text);
  ok(r && isnan(cell_of(r, 0, 2)), "what was never written is no value");
  eo_recording_free(r);
}

/* Facts may be too many, channels are not lost for that: the attributes of the file come before its data sets. */
static void test_many_facts(void)
{
  enum { FACTS = 2100 };
  struct eo_error error;
  struct eo_notes notes = {0};
  hsize_t count = COUNT;
  char name[16];
  hid_t file = open_file(), group = H5Gcreate2(file, "about", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  for (int i = 0; i < FACTS; i++) {
    snprintf(name, sizeof name, "x%d", i);
    put_double(group, name, i);
  }
  H5Gclose(group);
  H5Dclose(put(file, "pinion", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && cell_of(r, 7, 0) == pinion[7] && noted(&notes, "52 of them were not looked at"),
     "a channel behind more facts than are kept%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* A scale that is an array of one number, by its space or by its type. */
static void test_arrays_of_one(void)
{
  struct eo_error error;
  hsize_t count = COUNT, one = 1;
  double scale = 0.25;
  hid_t file = open_file(), type = H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &one);
  for (int typed = 0; typed < 2; typed++) {
    hid_t set = put(file, typed ? "typed" : "plain", 1, &count, H5T_STD_I32LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT);
    hid_t space = typed ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &one, NULL);
    hid_t attribute = H5Acreate2(set, "scale_factor", typed ? type : H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                                 H5P_DEFAULT);
    H5Awrite(attribute, typed ? type : H5T_NATIVE_DOUBLE, &scale);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Dclose(set);
  }
  H5Tclose(type);
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && cell_of(r, 50, 0) == 0.25 * floor(pinion[50]) && cell_of(r, 50, 1) == cell_of(r, 50, 0),
     "a scale may be an array of one number%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* Nanoseconds since 1970 in each of two groups, which doubles round to 256; they count from the first of the file. */
static void test_stamps(void)
{
  static const int64_t first = 1772614800123456789;
  static int64_t stamp[COUNT];
  struct eo_error error;
  hsize_t count = COUNT;
  hid_t file = open_file();
  for (int side = 0; side < 2; side++) {
    hid_t group = H5Gcreate2(file, side ? "pinion" : "gear", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (int i = 0; i < COUNT; i++)
      stamp[i] = first + 50001 * i + 77 * side;
    H5Dclose(put(group, "time", 1, &count, H5T_STD_I64LE, H5T_NATIVE_INT64, stamp, H5P_DEFAULT));
    H5Dclose(put(group, "angle", 1, &count, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, pinion, H5P_DEFAULT));
    H5Gclose(group);
  }
  H5Fclose(file);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int time[2] = {-1, -1};
  for (int c = 0; r && c < eo_recording_columns(r); c++)
    if (strstr(eo_recording_name(r, c), "time"))
      time[strstr(eo_recording_name(r, c), "pinion") != NULL] = c;
  int wrong = time[0] < 0 || time[1] < 0;
  for (int side = 0; side < 2 && !wrong; side++)
    wrong = eo_recording_clock(r, time[side]).epoch + (int64_t)cell_of(r, 7, time[side]) !=
                first + 7 * 50001 + 77 * side ||
            strcmp(eo_recording_unit(r, time[side]), "ns") != 0;
  ok(!wrong, "nanoseconds since 1970 of two groups are read to the last one%s", r ? "" : error.text);
  eo_recording_free(r);
}

int main(void)
{
  fixture_open();
  for (int i = 0; i < COUNT; i++) {
    t[i] = 5e-5 * i;
    pinion[i] = 17.25 + 0.6 * i;
    gear[i] = (float)(63.5 - 0.25 * i);
  }
  test_channels();
  test_table();
  test_texts();
  test_start_at_values();
  test_moments(0);
  test_moments(1);
  test_flat();
  test_habits();
  test_one_chunk();
  test_packing();
  test_circles();
  test_wide_records();
  test_namesakes();
  test_two_days();
  test_stamps();
  test_arrays_of_one();
  test_many_facts();
  test_hostile();
  return fixture_close();
}

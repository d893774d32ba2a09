/* HDF5 files, MATLAB's 7.3 among them: data sets of one dimension, or of two with one channel per column. Runs in a
   process of its own. */
#define H5_USE_110_API
#include "recording/readers.h"

#include <hdf5.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define CHANNELS EO_RECORDING_COLUMNS
#define WIDE 64 /* a data set with more columns is no table of channels */

struct channel {
  hid_t set;       /* borrowed from sets */
  int rank, along; /* dimensions; the one along which values follow each other */
  hsize_t across;  /* place in the other one */
};

struct hdf5 {
  int count, sets, left_out;
  hid_t set[CHANNELS];
  struct channel channel[CHANNELS];
  struct eo_series series[CHANNELS];
  double interval; /* s, of the file; 0: not stated */
};

/* A text attribute of fixed or variable length. */
static bool read_text_attribute(hid_t object, const char *name, char *text, size_t size)
{
  *text = '\0';
  if (H5Aexists(object, name) <= 0)
    return false;
  hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  size_t length = H5Tget_size(type);
  if (H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1) {
    char fixed[256] = "", *variable = NULL;
    if (H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, &variable) >= 0 && variable) {
      snprintf(text, size, "%s", variable);
      H5Dvlen_reclaim(type, space, H5P_DEFAULT, &variable);
    } else if (H5Tis_variable_str(type) == 0 && length < sizeof fixed && H5Aread(attribute, type, fixed) >= 0)
      snprintf(text, size, "%.*s", (int)length, fixed);
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  return *text;
}

static double read_number(hid_t attribute)
{
  double value = 0;
  hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  H5T_class_t class = H5Tget_class(type);
  if ((class == H5T_INTEGER || class == H5T_FLOAT) && H5Sget_simple_extent_npoints(space) == 1 &&
      H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0)
    value = 0;
  H5Sclose(space);
  H5Tclose(type);
  return value;
}

static herr_t visit_attribute(hid_t object, const char *name, const H5A_info_t *info, void *context)
{
  double *interval = context;
  (void)info;
  hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute >= 0 && !(*interval > 0))
    *interval = eo_series_stated_interval(name, read_number(attribute));
  if (attribute >= 0)
    H5Aclose(attribute);
  return 0;
}

/* From an attribute such as "sample_rate"; 0: none. */
static double interval_of(hid_t object)
{
  double interval = 0;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, visit_attribute, &interval);
  return interval;
}

/* Data of other files are not ours to read, whatever the file says. */
static bool reads_other_files(hid_t set)
{
  hid_t list = H5Dget_create_plist(set);
  bool other = list < 0 || H5Pget_external_count(list) != 0 || H5Pget_layout(list) == H5D_VIRTUAL;
  H5Pclose(list);
  return other;
}

static bool is_text_or_cell(hid_t set)
{
  char class[32];
  return read_text_attribute(set, "MATLAB_class", class, sizeof class) &&
         (!strcmp(class, "char") || !strcmp(class, "cell"));
}

/* The dimensions of a data set that can be channels; rank 0: none. */
static int numeric_rank(hid_t set, hsize_t *length)
{
  hid_t type = H5Dget_type(set), space = H5Dget_space(set);
  H5T_class_t class = H5Tget_class(type);
  int rank = H5Sget_simple_extent_ndims(space);
  bool usable = (class == H5T_INTEGER || class == H5T_FLOAT) && (rank == 1 || rank == 2) &&
                H5Sget_simple_extent_dims(space, length, NULL) == rank;
  H5Sclose(space);
  H5Tclose(type);
  return usable && !is_text_or_cell(set) && !reads_other_files(set) ? rank : 0;
}

/* A single number whose name says that it is the sampling rate or interval, as MATLAB users keep it. */
static void use_scalar(struct hdf5 *h, hid_t set, const char *name)
{
  double value = 0;
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) < 0)
    return;
  double interval = eo_series_stated_interval(name, value);
  if (interval > 0)
    h->interval = interval;
}

/* One channel per column, columns lying across the longer dimension. */
static bool add_channels(struct hdf5 *h, hid_t set, const char *name, int rank, const hsize_t *length)
{
  int along = rank == 2 && length[1] > length[0];
  hsize_t across = rank == 2 ? length[!along] : 1;
  if (across > WIDE || h->count + (int)across > CHANNELS)
    return false;
  struct eo_series series = {.length = (int64_t)length[along], .interval = interval_of(set)};
  static const char *const keys[] = {"unit", "units", "Unit", "Units", "unit_string"};
  for (size_t i = 0;
       i < sizeof keys / sizeof *keys && !read_text_attribute(set, keys[i], series.unit, sizeof series.unit); i++)
    ;
  for (hsize_t k = 0; k < across; k++) {
    if (across > 1)
      snprintf(series.name, sizeof series.name, "%.50s %d", name, (int)k + 1);
    else
      snprintf(series.name, sizeof series.name, "%s", name);
    h->channel[h->count] = (struct channel){set, rank, along, k};
    h->series[h->count++] = series;
  }
  return true;
}

static void add_set(struct hdf5 *h, hid_t file, const char *path)
{
  hsize_t length[2] = {0, 0};
  hid_t set = H5Dopen(file, path, H5P_DEFAULT);
  if (set < 0)
    return;
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  int rank = numeric_rank(set, length);
  if (rank && length[0] * (rank == 2 ? length[1] : 1) == 1)
    use_scalar(h, set, name);
  else if (rank && h->sets < CHANNELS && length[0] <= INT64_MAX / 2 && length[1] <= INT64_MAX / 2 &&
           add_channels(h, set, name, rank, length)) {
    h->set[h->sets++] = set;
    return;
  } else
    h->left_out++;
  H5Dclose(set);
}

/* MATLAB keeps what cells and objects refer to in groups whose names begin with '#'. */
static herr_t visit(hid_t file, const char *path, const H5O_info_t *info, void *context)
{
  struct hdf5 *h = context;
  if (info->type == H5O_TYPE_DATASET && path[0] != '#')
    add_set(h, file, path);
  return 0;
}

static enum eo_code read_values(void *context, int series, int64_t first, int64_t count, double *values,
                                struct eo_error *error)
{
  const struct hdf5 *h = context;
  const struct channel *c = &h->channel[series];
  hsize_t start[2] = {c->across, c->across}, size[2] = {1, 1}, length = (hsize_t)count;
  start[c->along] = (hsize_t)first;
  size[c->along] = length;
  hid_t space = H5Dget_space(c->set), memory = H5Screate_simple(1, &length, NULL);
  herr_t status = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL);
  if (status >= 0)
    status = H5Dread(c->set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values);
  H5Sclose(memory);
  H5Sclose(space);
  if (status < 0)
    return eo_error_set(
        error, EO_ERROR_INPUT, "",
        "HDF5: the values of \"%s\" from %lld on cannot be read; the file is damaged or uses an unknown filter.",
        h->series[series].name, (long long)first);
  return EO_OK;
}

static enum eo_code read_file(struct hdf5 *h, hid_t file, int64_t bytes, const struct eo_reader_options *options,
                              const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  h->interval = interval_of(file);
  if (H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, h, H5O_INFO_BASIC) < 0)
    return eo_error_set(error, EO_ERROR_INPUT, "", "HDF5: the groups of the file cannot be read; it is damaged.");
  if (h->left_out)
    eo_notes_add(notes, "%d data set%s %s no channel of numbers and %s left out.", h->left_out,
                 h->left_out == 1 ? "" : "s", h->left_out == 1 ? "is" : "are", h->left_out == 1 ? "was" : "were");
  for (int i = 0; i < h->count; i++)
    if (!(h->series[i].interval > 0))
      h->series[i].interval = h->interval;
  struct eo_series_file content = {h->series, h->count, bytes, options->max_bytes, read_values, h};
  return eo_series_copy(&content, sink, notes, error);
}

enum eo_code eo_hdf5_read(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                          struct eo_notes *notes, struct eo_error *error)
{
  struct stat state;
  if (stat(path, &state))
    return eo_error_set(error, EO_ERROR_FILE, "", "The file %s could not be opened.", path);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5PLset_loading_state(0); /* no code from outside, whatever filter the file asks for */
  struct hdf5 *h = calloc(1, sizeof *h);
  if (!h)
    return eo_error_memory(error);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  enum eo_code code = file < 0
                          ? eo_error_set(error, EO_ERROR_INPUT, "",
                                         "HDF5: the file cannot be opened; it is damaged or was cut off at byte %lld.",
                                         (long long)state.st_size)
                          : read_file(h, file, state.st_size, options, sink, notes, error);
  for (int i = 0; i < h->sets; i++)
    H5Dclose(h->set[i]);
  if (file >= 0)
    H5Fclose(file);
  free(h);
  return code;
}

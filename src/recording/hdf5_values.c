/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/hdf5_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CACHE ((size_t)256 << 20)    /* bytes of chunks kept for all data sets together */
#define EARLIEST 1000000000000000000 /* ns since 1970, in 2001 */
#define LATEST 2200000000000000000   /* in 2039 */
#define AHEAD ((size_t)192 << 20)    /* bytes of values that are read at once where chunks are too large to be kept */

hid_t eo_hdf5_open_cached(struct eo_hdf5 *hdf5, hid_t set)
{
  hid_t list = H5Dget_create_plist(set), type = H5Dget_type(set);
  hsize_t chunk[8];
  char name[1024];
  size_t bytes = H5Tget_size(type);
  int rank = H5Pget_layout(list) == H5D_CHUNKED ? H5Pget_chunk(list, 8, chunk) : 0;
  for (int i = 0; i < rank && i < 8; i++)
    bytes = chunk[i] < CACHE && bytes < CACHE ? bytes * chunk[i] : CACHE;
  H5Tclose(type);
  H5Pclose(list);
  hdf5->large = rank > 0 && bytes > (1 << 20) && bytes >= CACHE - hdf5->cache;
  if (rank < 1 || rank > 8 || bytes <= (1 << 20) || hdf5->large || H5Iget_name(set, name, sizeof name) <= 0)
    return set;
  hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
  H5Pset_chunk_cache(access, 521, bytes + 1024, 1);
  H5Dclose(set);
  set = H5Dopen2(hdf5->file, name, access);
  hdf5->cache += set >= 0 ? bytes : 0;
  H5Pclose(access);
  return set;
}

bool eo_hdf5_number(hid_t attribute, hid_t type, hid_t space, double *value)
{
  hsize_t one = 1;
  bool array = H5Tget_class(type) == H5T_ARRAY && H5Tget_array_ndims(type) == 1;
  hid_t element = array ? H5Tget_super(type) : H5Tcopy(type),
        memory = array ? H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &one) : H5Tcopy(H5T_NATIVE_DOUBLE);
  H5T_class_t class = H5Tget_class(element);
  bool good = (class == H5T_INTEGER || class == H5T_FLOAT) && H5Tget_size(element) == H5Tget_size(type) &&
              H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, memory, value) >= 0;
  H5Tclose(memory);
  H5Tclose(element);
  return good;
}

/* Integers in the place of doubles become such; what lies before 1970 stands for missing times. */
static void count_from(int64_t origin, int64_t count, double *values)
{
  for (int64_t i = 0; i < count; i++) {
    int64_t stamp;
    memcpy(&stamp, &values[i], sizeof stamp);
    values[i] = stamp > 0 ? (double)(stamp - origin) : NAN;
  }
}

/* Stored values from the file; false: they cannot be read, or there is no memory. */
static bool read_stored(const struct eo_hdf5_channel *channel, int64_t first, int64_t count, double *values)
{
  hsize_t start[EO_HDF5_RANK] = {0}, size[EO_HDF5_RANK], length = (hsize_t)count;
  for (int i = 0; i < EO_HDF5_RANK; i++)
    size[i] = 1;
  if (channel->other >= 0)
    start[channel->other] = channel->across;
  start[channel->along] = (hsize_t)first;
  size[channel->along] = length;
  double *all = channel->width > 1 ? malloc((size_t)count * (size_t)channel->width * sizeof *all) : values;
  if (!all)
    return false;
  hid_t space = H5Dget_space(channel->set), memory = H5Screate_simple(1, &length, NULL);
  herr_t status = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL);
  if (status >= 0)
    status = H5Dread(channel->set, channel->origin ? channel->exact : channel->type, memory, space, H5P_DEFAULT, all);
  if (status >= 0 && channel->origin)
    count_from(channel->origin, count, all);
  for (int64_t i = 0; channel->width > 1 && i < count; i++)
    values[i] = all[i * channel->width + channel->place];
  if (channel->width > 1)
    free(all);
  H5Sclose(memory);
  H5Sclose(space);
  return status >= 0;
}

/* Each piece that is read of a chunk too large to be kept unpacks all of it: many values are read at once then. */
static bool read_ahead(const struct eo_hdf5 *hdf5, struct eo_hdf5_channel *channel, int64_t first, int64_t count,
                       int64_t length, double *values)
{
  int64_t room = (int64_t)(AHEAD / sizeof *values) / hdf5->larges;
  if (count > room)
    return read_stored(channel, first, count, values);
  if (!channel->ahead && !(channel->ahead = malloc((size_t)room * sizeof *values)))
    return false;
  if (first < channel->first || first + count > channel->first + channel->count) {
    channel->first = first;
    channel->count = 0;
    int64_t wanted = length - first < room ? length - first : room;
    if (!read_stored(channel, first, wanted, channel->ahead))
      return false;
    channel->count = wanted;
  }
  memcpy(values, channel->ahead + (first - channel->first), (size_t)count * sizeof *values);
  return true;
}

void eo_hdf5_find_stamps(struct eo_hdf5 *hdf5)
{
  int64_t origin = 0;
  for (int i = 0; i < eo_tree_count(hdf5->tree); i++) {
    struct eo_hdf5_channel *channel = &hdf5->channel[i];
    struct eo_series *series = &eo_tree_series(hdf5->tree)[i];
    double first;
    if (!channel->exact || channel->width > 1 || series->length < 1 || !read_stored(channel, 0, 1, &first) ||
        first < EARLIEST || first > LATEST)
      continue;
    origin = origin ? origin : (int64_t)first;
    channel->origin = origin;
    series->clock.epoch = origin;
    if (!*series->unit && eo_tree_value(hdf5->tree, i, 1) == 1)
      snprintf(series->unit, sizeof series->unit, "ns");
  }
}

/* The first way of packing of a data set that is not built in, by its name and number; "" when there is none. */
static void find_packing(hid_t set, char *packing, size_t size)
{
  hid_t list = H5Dget_create_plist(set);
  int count = list < 0 ? 0 : H5Pget_nfilters(list);
  *packing = '\0';
  for (int i = 0; i < count && !*packing; i++) {
    char name[48] = "";
    unsigned flags;
    size_t values = 0;
    H5Z_filter_t filter = H5Pget_filter2(list, (unsigned)i, &flags, &values, NULL, sizeof name, name, NULL);
    if (filter > 0 && H5Zfilter_avail(filter) <= 0)
      snprintf(packing, size, "%.40s%sfilter %d", name, *name ? ", " : "", (int)filter);
  }
  H5Pclose(list);
}

static enum eo_code refuse_values(const struct eo_hdf5 *hdf5, int series, int64_t first, struct eo_error *error)
{
  char packing[80];
  const char *name = eo_tree_series(hdf5->tree)[series].name;
  find_packing(hdf5->channel[series].set, packing, sizeof packing);
  if (*packing)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "HDF5: \"%s\" is packed in a way (%s) that is not read; save it with gzip (zlib) or without "
                        "compression.",
                        name, packing);
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "HDF5: the values of \"%s\" from %lld on cannot be read; the file is damaged.", name,
                      (long long)first);
}

enum eo_code eo_hdf5_values(void *context, int series, int64_t first, int64_t count, double *values,
                            struct eo_error *error)
{
  struct eo_hdf5 *hdf5 = context;
  struct eo_hdf5_channel *channel = &hdf5->channel[series];
  bool good = channel->text ? eo_hdf5_moments(hdf5, channel, first, count, values)
              : channel->large
                  ? read_ahead(hdf5, channel, first, count, eo_tree_series(hdf5->tree)[series].length, values)
                  : read_stored(channel, first, count, values);
  if (!good)
    return refuse_values(hdf5, series, first, error);
  for (int64_t i = 0; i < count; i++)
    values[i] = eo_tree_value(hdf5->tree, series, values[i]);
  return EO_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of an HDF5 file, and those that describe the tables of pandas. */
#define H5_USE_110_API
#include "recording/hdf5_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXTS 64 /* texts of a list */

bool eo_hdf5_join(char *path, const char *group, const char *name)
{
  return snprintf(path, EO_TREE_PATH, "%s%s%s", group, *group ? "/" : "", name) < EO_TREE_PATH;
}

/* The texts of an attribute or data set with `count` of them, one a line; size bytes of fixed length, else variable. */
static void join_texts(const char *bytes, size_t width, char **variable, hssize_t count, char *list, size_t size)
{
  size_t used = 0;
  list[0] = '\0';
  for (hssize_t i = 0; i < count; i++) {
    const char *text = variable ? variable[i] ? variable[i] : "" : bytes + (size_t)i * width;
    size_t n = variable ? strlen(text) : strnlen(text, width);
    while (n && text[n - 1] == ' ')
      n--;
    if (used + n + 2 > size)
      return;
    used += (size_t)snprintf(list + used, size - used, "%s%.*s", i ? "\n" : "", (int)n, text);
  }
}

bool eo_hdf5_texts(hid_t object, bool set, hid_t type, hid_t space, char *list, size_t size)
{
  hssize_t count = H5Sget_simple_extent_npoints(space);
  size_t width = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || count < 1 || count > TEXTS || width > 4096)
    return false;
  bool variable = H5Tis_variable_str(type) > 0, done = false;
  char **pointers = variable ? calloc((size_t)count, sizeof(char *)) : NULL,
       *bytes = variable ? NULL : calloc((size_t)count, width + 1);
  void *to = variable ? (void *)pointers : (void *)bytes;
  if (to && (set ? H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) : H5Aread(object, type, to)) >= 0) {
    join_texts(bytes, width, pointers, count, list, size);
    if (variable)
      H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers);
    done = true;
  }
  free(pointers);
  free(bytes);
  return done;
}

/* Reads count texts of a data set from the first one on. With text of variable length `bytes` holds pointers, which the
   caller gives back by H5Dvlen_reclaim(). */
static bool read_texts(const struct eo_hdf5_channel *channel, hid_t type, hid_t memory, int64_t first, void *bytes)
{
  hsize_t start[EO_HDF5_RANK] = {0}, size[EO_HDF5_RANK];
  for (int i = 0; i < EO_HDF5_RANK; i++)
    size[i] = 1;
  start[channel->along] = (hsize_t)first;
  size[channel->along] = (hsize_t)H5Sget_simple_extent_npoints(memory);
  hid_t space = H5Dget_space(channel->set);
  bool good = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL) >= 0 &&
              H5Dread(channel->set, type, memory, space, H5P_DEFAULT, bytes) >= 0;
  H5Sclose(space);
  return good;
}

static double seconds_of(const char *text, size_t length, int64_t day)
{
  struct eo_moment moment;
  while (length && text[length - 1] == ' ')
    length--;
  if (!eo_moment_read(text, length, &moment) || !moment.has_time)
    return NAN;
  return (moment.has_day ? (double)(moment.day - day) * EO_MOMENT_DAY : 0) + moment.seconds;
}

bool eo_hdf5_moments(const struct eo_hdf5 *hdf5, const struct eo_hdf5_channel *channel, int64_t first, int64_t count,
                     double *values)
{
  hsize_t length = (hsize_t)count;
  hid_t type = H5Dget_type(channel->set), memory = H5Screate_simple(1, &length, NULL);
  size_t width = H5Tget_size(type);
  bool variable = H5Tis_variable_str(type) > 0;
  char *bytes = calloc((size_t)count, width);
  bool good = bytes && read_texts(channel, type, memory, first, bytes);
  for (int64_t i = 0; good && i < count; i++) {
    const char *text = bytes + (size_t)i * width;
    if (variable)
      memcpy(&text, bytes + (size_t)i * width, sizeof text);
    values[i] = text ? seconds_of(text, variable ? strlen(text) : strnlen(text, width), hdf5->day) : NAN;
  }
  if (good && variable)
    H5Dvlen_reclaim(type, memory, H5P_DEFAULT, bytes);
  free(bytes);
  H5Sclose(memory);
  H5Tclose(type);
  return good;
}

bool eo_hdf5_find_moments(struct eo_hdf5 *hdf5, const struct eo_hdf5_channel *channel)
{
  double first;
  if (!eo_hdf5_moments(hdf5, channel, 0, 1, &first) || !isfinite(first))
    return false;
  if (!hdf5->day_known && first >= EO_MOMENT_DAY) {
    hdf5->day = (int64_t)floor(first / EO_MOMENT_DAY);
    hdf5->day_known = true;
  }
  return true;
}

void eo_hdf5_add_texts(struct eo_hdf5 *hdf5, const char *path, const char *list)
{
  if (!strcmp(list, "N.")) { /* pandas pickles None as the name of what has none; the rows of a frame have an index */
    const char *axis = strstr(path, "/axis1/name");
    if (axis && !axis[strlen("/axis1/name")])
      eo_tree_add_text(hdf5->tree, path, "index");
    return;
  }
  if (strchr(list, '\n'))
    eo_tree_add_list(hdf5->tree, path, list);
  else if (*list)
    eo_tree_add_text(hdf5->tree, path, list);
}

/* The names in a pickled list of texts, "(lp0\nVpinion\np1\naVgear\n...", one a line. */
static void read_pickled(const char *pickled, char *list, size_t size)
{
  size_t used = 0;
  list[0] = '\0';
  for (const char *p = strchr(pickled, '\n'); p; p = strchr(p, '\n')) {
    p += 1 + (p[1] == 'a');
    size_t n = strcspn(p, "\n");
    if (*p == 'V' && used + n + 1 < size)
      used += (size_t)snprintf(list + used, size - used, "%s%.*s", used ? "\n" : "", (int)n - 1, p + 1);
  }
}

void eo_hdf5_add_frame(struct eo_hdf5 *hdf5, const char *records, const char *name, const char *text)
{
  static const char kind[] = "_kind";
  char field[64], path[EO_TREE_PATH], list[4096];
  size_t length = strlen(name), n = length > strlen(kind) ? length - strlen(kind) : 0;
  if (!n || n >= sizeof field || strcmp(name + n, kind))
    return;
  bool index = !strncmp(name, "index_", 6);
  snprintf(field, sizeof field, "%.*s", (int)n, name);
  if (!eo_hdf5_join(path, records, field) || strlen(path) + 7 > sizeof path)
    return;
  strcat(path, index ? "/name" : "/names");
  if (!index && !strncmp(text, "(lp", 3)) {
    read_pickled(text, list, sizeof list);
    eo_hdf5_add_texts(hdf5, path, list);
  } else if (index && (!strcmp(text, "float") || !strcmp(text, "datetime64") || !strcmp(text, "timedelta64")))
    eo_tree_add_text(hdf5->tree, path, "time");
}

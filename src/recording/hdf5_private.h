/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The channels of an HDF5 file: found by hdf5.c, read by hdf5_values.c. */
#ifndef EASEOFF_RECORDING_HDF5_PRIVATE_H
#define EASEOFF_RECORDING_HDF5_PRIVATE_H

#include "recording/tree.h"

#include <hdf5.h>
#include <stdbool.h>

#define EO_HDF5_CHANNELS EO_TREE_CHANNELS
#define EO_HDF5_RANK 8      /* dimensions of a data set at most */
#define EO_HDF5_VISITS 4096 /* groups and lists of references that are looked into */

struct eo_hdf5_channel {
  hid_t set, type;  /* borrowed from sets; of a value in memory: a double, or a record with one field */
  hid_t exact;      /* the same of integers of 64 bits; 0: it has none */
  int64_t origin;   /* of these, taken off before they are doubles: ns since 1970; 0: none */
  int width, place; /* values of one element in memory, and which of them is the channel's */
  int along;        /* dimension along which values follow each other */
  int other;        /* the other one that is longer than 1, -1: none */
  hsize_t across;   /* place in the other one */
  bool text;        /* its values are such texts, in s */
  bool large;       /* its chunks are too large to be kept */
  double *ahead;    /* owned: values that were read ahead, NULL: none */
  int64_t first, count;
};

struct eo_hdf5 {
  int sets, left_out;
  size_t cache; /* bytes promised so far */
  bool large;   /* the chunks of the set that is looked at are too large for it */
  int larges;   /* channels in such sets */
  int64_t day;  /* since 1970, of the first text with a date: all times of such texts count from it */
  bool day_known;
  int visits;
  haddr_t visited[EO_HDF5_VISITS]; /* where they stand in the file */
  hid_t file, set[EO_HDF5_CHANNELS];
  struct eo_hdf5_channel channel[EO_HDF5_CHANNELS];
  struct eo_tree *tree; /* owned */
  struct eo_notes *notes;
};

/* path[EO_TREE_PATH]: of a name below a group; false when it is too long. */
bool eo_hdf5_join(char *path, const char *group, const char *name);

/* Reads texts of an attribute (set: data set) into one list, one a line; false when they are none. */
bool eo_hdf5_texts(hid_t object, bool set, hid_t type, hid_t space, char *list, size_t size);

/* Dates and times of day that are texts, as seconds since the midnight before the first of the file; NaN where one is
   none. eo_hdf5_find_moments() tells whether the data set begins with one. False: they cannot be read. */
bool eo_hdf5_find_moments(struct eo_hdf5 *hdf5, const struct eo_hdf5_channel *channel);
bool eo_hdf5_moments(const struct eo_hdf5 *hdf5, const struct eo_hdf5_channel *channel, int64_t first, int64_t count,
                     double *values);

void eo_hdf5_add_texts(struct eo_hdf5 *hdf5, const char *path, const char *list);

/* Tables of pandas say at the records what their fields hold: the names of the columns in "values_block_0_kind", and in
   "index_kind" whether the index counts the rows or is the time. text: of an attribute of the records. */
void eo_hdf5_add_frame(struct eo_hdf5 *hdf5, const char *records, const char *name, const char *text);

/* The cache holds a whole chunk of each data set as long as all together stay small: without it a chunk would be
   unpacked again for every piece that is read of it. The set is opened anew for that; a set that is open keeps the
   cache it has. */
hid_t eo_hdf5_open_cached(struct eo_hdf5 *hdf5, hid_t set);

/* The number of an attribute, which may be an array of one, by its space or by its type; false: it is none. */
bool eo_hdf5_number(hid_t attribute, hid_t type, hid_t space, double *value);

/* Integers that count nanoseconds since 1970 are too long for doubles, which leave steps of 256 ns: those of all
   channels count from the first of the file. */
void eo_hdf5_find_stamps(struct eo_hdf5 *hdf5);

/* Values first .. first + count - 1 of a channel, as the file's scale has them; context: struct eo_hdf5. Errors:
   EO_ERROR_INPUT, also without memory. */
enum eo_code eo_hdf5_values(void *context, int series, int64_t first, int64_t count, double *values,
                            struct eo_error *error);

#endif

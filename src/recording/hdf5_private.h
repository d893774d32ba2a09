/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The channels of an HDF5 file: found by hdf5.c, read by hdf5_values.c. */
#ifndef EASEOFF_RECORDING_HDF5_PRIVATE_H
#define EASEOFF_RECORDING_HDF5_PRIVATE_H

#include "recording/tree.h"

#include <hdf5.h>
#include <stdbool.h>

#define EO_HDF5_CHANNELS EO_TREE_CHANNELS

struct eo_hdf5_channel {
  hid_t set, type;  /* borrowed from sets; of a value in memory: a double, or a record with one field */
  int width, place; /* values of one element in memory, and which of them is the channel's */
  int rank, along;  /* dimensions; the one along which values follow each other */
  hsize_t across;   /* place in the other one */
  bool large;       /* its chunks are too large to be kept */
  double *ahead;    /* owned: values that were read ahead, NULL: none */
  int64_t first, count;
};

struct eo_hdf5 {
  int sets, left_out;
  size_t cache; /* bytes promised so far */
  bool large;   /* the chunks of the set that is looked at are too large for it */
  int larges;   /* channels in such sets */
  hid_t file, set[EO_HDF5_CHANNELS];
  struct eo_hdf5_channel channel[EO_HDF5_CHANNELS];
  struct eo_tree *tree; /* owned */
  struct eo_notes *notes;
};

/* Values first .. first + count - 1 of a channel, as the file's scale has them; context: struct eo_hdf5. Errors:
   EO_ERROR_INPUT, also without memory. */
enum eo_code eo_hdf5_values(void *context, int series, int64_t first, int64_t count, double *values,
                            struct eo_error *error);

#endif

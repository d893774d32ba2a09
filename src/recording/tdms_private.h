/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The metadata of a segment while they are read: objects (tdms_objects.c) and their properties (tdms_properties.c). */
#ifndef EASEOFF_RECORDING_TDMS_PRIVATE_H
#define EASEOFF_RECORDING_TDMS_PRIVATE_H

#include "recording/tdms.h"

/* What is left of the metadata; at: byte of the file, for errors. */
struct eo_tdms_reader {
  const unsigned char *bytes;
  size_t left;
  int64_t at;
  bool big;
  struct eo_error *error;
};

/* Takes size bytes; NULL with an error when the metadata end before. */
const unsigned char *eo_tdms_take(struct eo_tdms_reader *reader, size_t size);
bool eo_tdms_take_32(struct eo_tdms_reader *reader, uint32_t *value);
bool eo_tdms_take_string(struct eo_tdms_reader *reader, const char **text, uint32_t *length);

/* Takes the properties of an object; channel: NULL for a group and the file. */
bool eo_tdms_take_properties(struct eo_tdms_reader *reader, struct eo_tdms_channel *channel, struct eo_series *series);

bool eo_tdms_is_named(const char *text, uint32_t length, const char *name);

#endif

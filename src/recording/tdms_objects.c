/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objects of a TDMS segment and where their raw data are. */
#include "recording/bytes.h"
#include "recording/tdms_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

int64_t eo_tdms_type_size(uint32_t type)
{
  switch (type) {
  case EO_TDMS_INT8:
  case EO_TDMS_UINT8:
  case EO_TDMS_BOOLEAN:
    return 1;
  case EO_TDMS_INT16:
  case EO_TDMS_UINT16:
    return 2;
  case EO_TDMS_INT32:
  case EO_TDMS_UINT32:
  case EO_TDMS_SINGLE:
  case EO_TDMS_SINGLE_UNIT:
    return 4;
  case EO_TDMS_INT64:
  case EO_TDMS_UINT64:
  case EO_TDMS_DOUBLE:
  case EO_TDMS_DOUBLE_UNIT:
    return 8;
  case EO_TDMS_COMPLEX_SINGLE:
    return 8;
  case EO_TDMS_TIMESTAMP:
  case EO_TDMS_COMPLEX_DOUBLE:
    return 16;
  default:
    return 0;
  }
}

/* The scaler of raw DAQmx data: type of the values, their buffer and place in a row of it. Types are numbered on their
   own; the last is a time stamp. */
static bool take_scaler(struct eo_tdms_reader *reader, bool digital, struct eo_tdms_part *part, uint32_t *buffer)
{
  static const enum eo_tdms_type types[] = {EO_TDMS_UINT8,  EO_TDMS_INT8,  EO_TDMS_UINT16, EO_TDMS_INT16,
                                            EO_TDMS_UINT32, EO_TDMS_INT32, EO_TDMS_UINT64, EO_TDMS_INT64,
                                            EO_TDMS_SINGLE, EO_TDMS_DOUBLE};
  uint32_t type, offset;
  if (!eo_tdms_take_32(reader, &type) || !eo_tdms_take_32(reader, buffer) || !eo_tdms_take_32(reader, &offset) ||
      !eo_tdms_take(reader, digital ? 5 : 8))
    return false;
  part->type = type < sizeof types / sizeof *types ? types[type] : EO_TDMS_TIMESTAMP;
  part->bit = digital ? (int)(offset % 8) : -1;
  part->offset = digital ? offset / 8 : offset;
  if (digital)
    part->type = EO_TDMS_UINT8;
  return type < sizeof types / sizeof *types || type == 0xffffffffu;
}

/* Where raw DAQmx data are: rows of one or more buffers, one after the other in the chunk. Of several scalers of a
   channel the first counts. */
static bool take_raw_index(struct eo_tdms_reader *reader, bool digital, struct eo_tdms_channel *channel, int number)
{
  int64_t at = reader->at;
  uint32_t type, dimension, scalers, widths, width, buffer = 0, other;
  struct eo_tdms_part part = {.channel = number}, ignored;
  const unsigned char *p;
  if (!channel || !eo_tdms_take_32(reader, &type) || !eo_tdms_take_32(reader, &dimension) ||
      !(p = eo_tdms_take(reader, 8)))
    goto damaged;
  uint64_t count = eo_bytes_64(p, reader->big);
  if (!eo_tdms_take_32(reader, &scalers) || !scalers || scalers > 64 || count > INT64_MAX >> 24 || dimension != 1)
    goto damaged;
  for (uint32_t i = 0; i < scalers; i++)
    if (!take_scaler(reader, digital, i ? &ignored : &part, i ? &other : &buffer))
      goto damaged;
  if (!eo_tdms_take_32(reader, &widths) || !widths || widths > 64 || buffer >= widths)
    goto damaged;
  int64_t row = 0, place = part.offset;
  part.count = (int64_t)count;
  for (uint32_t i = 0; i < widths; i++) {
    if (!eo_tdms_take_32(reader, &width) || width > 1 << 16)
      goto damaged;
    if (i == buffer)
      part.width = width, part.offset += row * part.count;
    row += width;
  }
  part.size = row * part.count;
  if (place + eo_tdms_type_size(part.type) > part.width)
    goto damaged;
  channel->index = part;
  channel->index_known = true;
  return true;
damaged:
  eo_error_set(reader->error, EO_ERROR_INPUT, "",
               "TDMS: the index of raw DAQmx data at byte %lld is damaged or of a kind that is not read; save the "
               "channels converted (as double).",
               (long long)at);
  return false;
}

/* Where the raw data of a channel are: a new index, the one it had (length 0), or none in this segment. */
static bool take_index(struct eo_tdms_reader *reader, struct eo_tdms_channel *channel, int number, bool *data)
{
  int64_t at = reader->at;
  uint32_t length, type, dimension;
  if (!eo_tdms_take_32(reader, &length))
    return false;
  *data = length != 0xffffffffu;
  if (!*data || (length == 0 && channel && channel->index_known))
    return true;
  if (length == 0x1269 || length == 0x126a)
    return take_raw_index(reader, length == 0x126a, channel, number);
  const unsigned char *p;
  if (length != 20 && length != 28) {
    eo_error_set(reader->error, EO_ERROR_INPUT, "",
                 "TDMS: the index of raw data at byte %lld has a length of %u bytes.", (long long)at, length);
    return false;
  }
  if (!eo_tdms_take_32(reader, &type) || !eo_tdms_take_32(reader, &dimension) || !(p = eo_tdms_take(reader, 8)))
    return false;
  uint64_t count = eo_bytes_64(p, reader->big);
  uint64_t size = (uint64_t)eo_tdms_type_size(type) * count;
  bool texts = type == EO_TDMS_STRING; /* their size follows; some writers leave it out of the length */
  if ((texts || length == 28) && (p = eo_tdms_take(reader, 8)))
    size = eo_bytes_64(p, reader->big);
  if (!p)
    return false;
  if (count > INT64_MAX / 32 || size > INT64_MAX / 32 || dimension != 1 ||
      (!texts && (!eo_tdms_type_size(type) || length == 28))) {
    eo_error_set(reader->error, EO_ERROR_INPUT, "",
                 "TDMS: the channel at byte %lld has %llu values of type 0x%x in %u dimensions; that is not read.",
                 (long long)at, (unsigned long long)count, type, dimension);
    return false;
  }
  if (!channel) {
    eo_error_set(reader->error, EO_ERROR_INPUT, "", "TDMS: a group at byte %lld holds values of its own.",
                 (long long)at);
    return false;
  }
  if (channel->index_known && channel->index.type != type) {
    eo_error_set(reader->error, EO_ERROR_INPUT, "", "TDMS: the channel at byte %lld changes the type of its values.",
                 (long long)at);
    return false;
  }
  channel->index = (struct eo_tdms_part){number, (enum eo_tdms_type)type, (int64_t)count, (int64_t)size, .bit = -1};
  channel->index_known = true;
  return true;
}

/* Takes 'a name' with doubled quotes from a path and returns the place behind it. */
static const char *take_name(const char *path, char *name, size_t size)
{
  size_t n = 0;
  if (*path != '\'')
    return path;
  for (path++; *path && !(*path == '\'' && path[1] != '\''); path++) {
    path += *path == '\'';
    if (n + 1 < size)
      name[n++] = *path;
  }
  name[n] = '\0';
  return *path ? path + 1 : path;
}

/* "/'group'/'channel'" (no NUL in it) becomes "channel". Whether two groups have channels of one name is no matter:
   columns may share a name. */
static void name_channel(const char *path, char *name, size_t size)
{
  char group[EO_RECORDING_NAME];
  const char *p = take_name(path + 1, group, sizeof group);
  name[0] = '\0';
  if (*p == '/')
    take_name(p + 1, name, size);
}

/* Paths of channels have two names; "/" and "/'group'" have fewer. */
static bool is_channel(const char *path, uint32_t length)
{
  int names = 0;
  bool quoted = false;
  for (uint32_t i = 0; i < length; i++) {
    quoted ^= path[i] == '\'';
    names += path[i] == '\'' && quoted && i > 0 && path[i - 1] == '/';
  }
  return names == 2;
}

/* The channel of this path, added when it is new; -1: no memory or too many. */
static int find_channel(struct eo_tdms *tdms, const char *path, uint32_t length, int hint, struct eo_error *error)
{
  for (int i = 0; i < tdms->channels; i++) {
    int c = (i + hint) % tdms->channels; /* channels mostly come in their old order */
    if (eo_tdms_is_named(path, length, tdms->channel[c].path))
      return c;
  }
  if (tdms->channels == EO_SERIES) {
    eo_error_set(error, EO_ERROR_INPUT, "", "TDMS: the file has more than %d channels.", EO_SERIES);
    return -1;
  }
  struct eo_tdms_channel *channel = &tdms->channel[tdms->channels];
  channel->path = strndup(path, length);
  if (!channel->path) {
    eo_error_memory(error);
    return -1;
  }
  eo_series_init(&tdms->series[tdms->channels], "", 0);
  name_channel(channel->path, tdms->series[tdms->channels].name, sizeof tdms->series->name);
  return tdms->channels++;
}

/* The group of this path, or the file itself; NULL when there are too many. */
static struct eo_series *find_group(struct eo_tdms *tdms, const char *path, uint32_t length)
{
  for (int i = 0; i < tdms->groups; i++)
    if (eo_tdms_is_named(path, length, tdms->group[i].path))
      return &tdms->group[i].stated;
  if (tdms->groups == EO_TDMS_GROUPS)
    return NULL;
  struct eo_tdms_group *group = &tdms->group[tdms->groups];
  group->path = strndup(path, length);
  if (!group->path)
    return NULL;
  eo_series_init(&group->stated, "", 0);
  tdms->groups++;
  return &group->stated;
}

/* Puts a channel into the list of the segment's objects, where it may already be. */
static void list_channel(struct eo_tdms *tdms, int channel, bool data)
{
  int *at = &tdms->channel[channel].listed_at;
  if (*at >= tdms->listed || tdms->list[*at].channel != channel)
    *at = tdms->listed++;
  tdms->list[*at] = (struct eo_tdms_list){channel, data};
}

/* Every path begins with "/". One with a NUL in it would be another, shorter one for whoever takes it as a C string. */
static bool take_path(struct eo_tdms_reader *reader, const char **path, uint32_t *length)
{
  if (!eo_tdms_take_string(reader, path, length))
    return false;
  if (*length && **path == '/' && !memchr(*path, '\0', *length))
    return true;
  eo_error_set(reader->error, EO_ERROR_INPUT, "", "TDMS: the object's path before byte %lld %s; the file is damaged.",
               (long long)reader->at, *length && **path == '/' ? "holds a NUL" : "does not begin with \"/\"");
  return false;
}

static bool take_object(struct eo_tdms *tdms, struct eo_tdms_reader *reader, int hint)
{
  const char *path;
  uint32_t length;
  bool data;
  if (!take_path(reader, &path, &length))
    return false;
  if (!is_channel(path, length))
    return take_index(reader, NULL, -1, &data) && eo_tdms_take_properties(reader, NULL, find_group(tdms, path, length));
  int c = find_channel(tdms, path, length, hint, reader->error);
  if (c < 0 || !take_index(reader, &tdms->channel[c], c, &data))
    return false;
  list_channel(tdms, c, data);
  return eo_tdms_take_properties(reader, &tdms->channel[c], &tdms->series[c]);
}

enum eo_code eo_tdms_read_objects(struct eo_tdms *tdms, const unsigned char *bytes, size_t size, int64_t at, bool big,
                                  bool fresh, struct eo_error *error)
{
  struct eo_error own;
  struct eo_tdms_reader reader = {bytes, size, at, big, error ? error : &own};
  uint32_t count;
  if (fresh)
    tdms->listed = 0;
  if (!eo_tdms_take_32(&reader, &count))
    return reader.error->code;
  for (uint32_t i = 0; i < count; i++)
    if (!take_object(tdms, &reader, (int)(i % EO_SERIES)))
      return reader.error->code;
  return EO_OK;
}

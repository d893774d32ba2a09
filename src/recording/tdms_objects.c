/* The metadata of a TDMS segment: objects, where their raw data are, properties. */
#include "recording/bytes.h"
#include "recording/tdms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* What is left of the metadata; at: byte of the file, for errors. */
struct reader {
  const unsigned char *bytes;
  size_t left;
  int64_t at;
  bool big;
  struct eo_error *error;
};

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
  case EO_TDMS_TIMESTAMP:
    return 16;
  default:
    return 0;
  }
}

/* Takes size bytes; NULL with an error when the metadata end before. */
static const unsigned char *take(struct reader *r, size_t size)
{
  if (size > r->left) {
    eo_error_set(r->error, EO_ERROR_INPUT, "",
                 "TDMS: the metadata at byte %lld end where %zu bytes more should follow.", (long long)r->at, size);
    return NULL;
  }
  const unsigned char *bytes = r->bytes;
  r->bytes += size;
  r->left -= size;
  r->at += (int64_t)size;
  return bytes;
}

static bool take_32(struct reader *r, uint32_t *value)
{
  const unsigned char *p = take(r, 4);
  if (p)
    *value = eo_bytes_32(p, r->big);
  return p;
}

static bool take_string(struct reader *r, const char **text, uint32_t *length)
{
  if (!take_32(r, length))
    return false;
  *text = (const char *)take(r, *length);
  return *text;
}

/* A property's value: *number for those that are numbers, else NaN; *text for strings, else NULL. */
static bool take_value(struct reader *r, double *number, const char **text, uint32_t *length)
{
  uint32_t type;
  *number = NAN;
  *text = NULL;
  if (!take_32(r, &type))
    return false;
  if (type == EO_TDMS_STRING)
    return take_string(r, text, length);
  int64_t size = eo_tdms_type_size(type);
  if (!size) {
    eo_error_set(r->error, EO_ERROR_INPUT, "", "TDMS: the property before byte %lld is of the unknown type %u.",
                 (long long)r->at, type);
    return false;
  }
  const unsigned char *p = take(r, (size_t)size);
  if (!p)
    return false;
  if (type == EO_TDMS_DOUBLE || type == EO_TDMS_DOUBLE_UNIT)
    *number = eo_bytes_double(p, r->big);
  else if (type == EO_TDMS_SINGLE || type == EO_TDMS_SINGLE_UNIT)
    *number = eo_bytes_float(p, r->big);
  else if (type == EO_TDMS_INT32)
    *number = (int32_t)eo_bytes_32(p, r->big);
  else if (type == EO_TDMS_UINT32)
    *number = eo_bytes_32(p, r->big);
  return true;
}

static bool is_named(const char *text, uint32_t length, const char *name)
{
  return strlen(name) == length && !memcmp(text, name, length);
}

static bool ends_with(const char *text, uint32_t length, const char *tail)
{
  size_t n = strlen(tail);
  return length >= n && !memcmp(text + length - n, tail, n);
}

/* What a channel's properties mean to us: its sampling and unit, and the scale of data that were stored raw. */
static void use_property(struct eo_tdms_channel *channel, struct eo_series *series, const char *name, uint32_t length,
                         double number, const char *text, uint32_t text_length)
{
  if (is_named(name, length, "wf_increment") && number > 0 && isfinite(number))
    series->interval = number;
  else if (is_named(name, length, "wf_start_offset") && isfinite(number))
    series->start = number;
  else if (is_named(name, length, "unit_string") && text)
    snprintf(series->unit, sizeof series->unit, "%.*s", (int)(text_length < 64 ? text_length : 64), text);
  else if (is_named(name, length, "NI_Scaling_Status") && text)
    channel->scaled = is_named(text, text_length, "scaled");
  else if (is_named(name, length, "NI_Number_Of_Scales") && number >= 0)
    channel->scales = (int64_t)number;
  else if (ends_with(name, length, "_Scale_Type") && text)
    channel->unknown_scale = channel->unknown_scale || !is_named(text, text_length, "Linear");
  else if (ends_with(name, length, "_Linear_Slope"))
    channel->slope = number;
  else if (ends_with(name, length, "_Linear_Y_Intercept"))
    channel->intercept = number;
}

static bool take_properties(struct reader *r, struct eo_tdms_channel *channel, struct eo_series *series)
{
  uint32_t count;
  if (!take_32(r, &count))
    return false;
  for (uint32_t i = 0; i < count; i++) {
    const char *name, *text;
    uint32_t length, text_length = 0;
    double number;
    if (!take_string(r, &name, &length) || !take_value(r, &number, &text, &text_length))
      return false;
    if (channel)
      use_property(channel, series, name, length, number, text, text_length);
  }
  return true;
}

/* Where the raw data of a channel are: a new index, the one it had (length 0), or none in this segment. */
static bool take_index(struct reader *r, struct eo_tdms_channel *channel, int number, bool *data)
{
  int64_t at = r->at;
  uint32_t length, type, dimension;
  if (!take_32(r, &length))
    return false;
  *data = length != 0xffffffffu;
  if (!*data || (length == 0 && channel && channel->index_known))
    return true;
  if (length == 0x1269 || length == 0x126a || length == 0x1369) {
    eo_error_set(r->error, EO_ERROR_INPUT, "",
                 "TDMS: the channel before byte %lld holds raw DAQmx data; save it converted (as double).",
                 (long long)at);
    return false;
  }
  const unsigned char *p;
  if (length != 20 && length != 28) {
    eo_error_set(r->error, EO_ERROR_INPUT, "", "TDMS: the index of raw data at byte %lld has a length of %u bytes.",
                 (long long)at, length);
    return false;
  }
  if (!take_32(r, &type) || !take_32(r, &dimension) || !(p = take(r, 8)))
    return false;
  uint64_t count = eo_bytes_64(p, r->big);
  uint64_t size = (uint64_t)eo_tdms_type_size(type) * count;
  if (length == 28 && (p = take(r, 8)))
    size = eo_bytes_64(p, r->big);
  if (!p)
    return false;
  if (count > INT64_MAX / 32 || size > INT64_MAX / 32 || dimension != 1 ||
      (type != EO_TDMS_STRING && !eo_tdms_type_size(type)) || (type == EO_TDMS_STRING) != (length == 28)) {
    eo_error_set(r->error, EO_ERROR_INPUT, "",
                 "TDMS: the channel at byte %lld has %llu values of type 0x%x in %u dimensions; that is not read.",
                 (long long)at, (unsigned long long)count, type, dimension);
    return false;
  }
  if (!channel) {
    eo_error_set(r->error, EO_ERROR_INPUT, "", "TDMS: a group at byte %lld holds values of its own.", (long long)at);
    return false;
  }
  if (channel->index_known && channel->index.type != type) {
    eo_error_set(r->error, EO_ERROR_INPUT, "", "TDMS: the channel at byte %lld changes the type of its values.",
                 (long long)at);
    return false;
  }
  channel->index = (struct eo_tdms_part){number, (enum eo_tdms_type)type, (int64_t)count, (int64_t)size};
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
    if (is_named(path, length, tdms->channel[c].path))
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
  channel->slope = 1;
  name_channel(channel->path, tdms->series[tdms->channels].name, sizeof tdms->series->name);
  return tdms->channels++;
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
static bool take_path(struct reader *r, const char **path, uint32_t *length)
{
  if (!take_string(r, path, length))
    return false;
  if (*length && **path == '/' && !memchr(*path, '\0', *length))
    return true;
  eo_error_set(r->error, EO_ERROR_INPUT, "", "TDMS: the object's path before byte %lld %s; the file is damaged.",
               (long long)r->at, *length && **path == '/' ? "holds a NUL" : "does not begin with \"/\"");
  return false;
}

static bool take_object(struct eo_tdms *tdms, struct reader *r, int hint)
{
  const char *path;
  uint32_t length;
  bool data;
  if (!take_path(r, &path, &length))
    return false;
  if (!is_channel(path, length))
    return take_index(r, NULL, -1, &data) && take_properties(r, NULL, NULL);
  int c = find_channel(tdms, path, length, hint, r->error);
  if (c < 0 || !take_index(r, &tdms->channel[c], c, &data))
    return false;
  list_channel(tdms, c, data);
  return take_properties(r, &tdms->channel[c], &tdms->series[c]);
}

enum eo_code eo_tdms_read_objects(struct eo_tdms *tdms, const unsigned char *bytes, size_t size, int64_t at, bool big,
                                  bool fresh, struct eo_error *error)
{
  struct eo_error own;
  struct reader r = {bytes, size, at, big, error ? error : &own};
  uint32_t count;
  if (fresh)
    tdms->listed = 0;
  if (!take_32(&r, &count))
    return r.error->code;
  for (uint32_t i = 0; i < count; i++)
    if (!take_object(tdms, &r, (int)(i % EO_SERIES)))
      return r.error->code;
  return EO_OK;
}

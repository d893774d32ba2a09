/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The metadata of a TDMS segment: objects, where their raw data are, properties. */
#include "recording/bytes.h"
#include "recording/decimal.h"
#include "recording/tdms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

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
  case EO_TDMS_COMPLEX_SINGLE:
    return 8;
  case EO_TDMS_TIMESTAMP:
  case EO_TDMS_COMPLEX_DOUBLE:
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

/* A property's value. */
struct property {
  double number;    /* NaN unless it is one */
  const char *text; /* NULL unless it is one */
  uint32_t length;
  int64_t epoch; /* of a time stamp, else EO_CLOCK_NO_EPOCH */
};

static double number_of(uint32_t type, const unsigned char *p, bool big)
{
  switch (type) {
  case EO_TDMS_INT8:
    return (int8_t)p[0];
  case EO_TDMS_INT16:
    return (int16_t)eo_bytes_16(p, big);
  case EO_TDMS_INT32:
    return (int32_t)eo_bytes_32(p, big);
  case EO_TDMS_INT64:
    return (double)(int64_t)eo_bytes_64(p, big);
  case EO_TDMS_UINT8:
    return p[0];
  case EO_TDMS_UINT16:
    return eo_bytes_16(p, big);
  case EO_TDMS_UINT32:
    return eo_bytes_32(p, big);
  case EO_TDMS_UINT64:
    return (double)eo_bytes_64(p, big);
  case EO_TDMS_SINGLE:
  case EO_TDMS_SINGLE_UNIT:
    return eo_bytes_float(p, big);
  case EO_TDMS_DOUBLE:
  case EO_TDMS_DOUBLE_UNIT:
    return eo_bytes_double(p, big);
  default:
    return NAN;
  }
}

/* Time stamps are seconds since 1904-01-01 and fractions of 2^-64 s. */
static int64_t epoch_of(const unsigned char *p, bool big)
{
  int64_t seconds = (int64_t)eo_bytes_64(big ? p : p + 8, big) - 2082844800;
  double fraction = (double)eo_bytes_64(big ? p + 8 : p, big) * 0x1p-64;
  return seconds > -4000000000 && seconds < 8000000000 ? seconds * 1000000000 + llround(fraction * 1e9)
                                                       : EO_CLOCK_NO_EPOCH;
}

static bool take_value(struct reader *r, struct property *value)
{
  uint32_t type;
  *value = (struct property){.number = NAN, .epoch = EO_CLOCK_NO_EPOCH};
  if (!take_32(r, &type))
    return false;
  if (type == EO_TDMS_STRING)
    return take_string(r, &value->text, &value->length);
  int64_t size = eo_tdms_type_size(type);
  if (!size) {
    eo_error_set(r->error, EO_ERROR_INPUT, "", "TDMS: the property before byte %lld is of the unknown type %u.",
                 (long long)r->at, type);
    return false;
  }
  const unsigned char *p = take(r, (size_t)size);
  if (!p)
    return false;
  value->number = number_of(type, p, r->big);
  if (type == EO_TDMS_TIMESTAMP)
    value->epoch = epoch_of(p, r->big);
  return true;
}

static bool is_named(const char *text, uint32_t length, const char *name)
{
  return strlen(name) == length && !memcmp(text, name, length);
}

/* The scale of a channel with this number, made when it is not there. */
static struct eo_tdms_scale *scale_at(struct eo_tdms_channel *channel, int number)
{
  if (!channel->scale) {
    channel->scale = calloc(EO_TDMS_SCALES, sizeof *channel->scale);
    for (int i = 0; channel->scale && i < EO_TDMS_SCALES; i++)
      channel->scale[i].source[0] = channel->scale[i].source[1] = -1;
  }
  return channel->scale && number >= 0 && number < EO_TDMS_SCALES ? &channel->scale[number] : NULL;
}

static enum eo_tdms_scale_kind scale_kind(const struct property *value)
{
  static const char *const names[] = {[EO_TDMS_LINEAR] = "Linear",
                                      [EO_TDMS_POLYNOMIAL] = "Polynomial",
                                      [EO_TDMS_TABLE] = "Table",
                                      [EO_TDMS_ADD] = "Add",
                                      [EO_TDMS_SUBTRACT] = "Subtract"};
  for (int i = EO_TDMS_LINEAR; i < EO_TDMS_OTHER_SCALE; i++)
    if (value->text && is_named(value->text, value->length, names[i]))
      return (enum eo_tdms_scale_kind)i;
  return EO_TDMS_OTHER_SCALE;
}

/* "Polynomial_Coefficients[2]": a place in a list of terms; more than are kept make the scale one we cannot apply. */
static void use_term(struct eo_tdms_scale *scale, enum eo_tdms_scale_kind kind, int list, const char *index,
                     double number)
{
  long at = strtol(index, NULL, 10);
  if (scale->kind == EO_TDMS_NO_SCALE) /* older files do not state the type */
    scale->kind = kind;
  if (at < 0 || at >= EO_TDMS_TERMS || !isfinite(number))
    scale->kind = EO_TDMS_OTHER_SCALE;
  else {
    scale->term[list][at] = number;
    scale->terms[list] = at + 1 > scale->terms[list] ? (int)at + 1 : scale->terms[list];
  }
}

/* "NI_Scale[1]_Linear_Slope" and the like. */
static void use_scale(struct eo_tdms_channel *channel, const char *name, const struct property *value)
{
  char *rest;
  long number = strtol(name + strlen("NI_Scale["), &rest, 10);
  struct eo_tdms_scale *scale = scale_at(channel, (int)number);
  if (!scale || strncmp(rest, "]_", 2))
    return;
  rest += 2;
  const char *bracket = strchr(rest, '[');
  if (!strcmp(rest, "Scale_Type"))
    scale->kind = scale_kind(value);
  else if (strstr(rest, "Input_Source"))
    scale->source[strstr(rest, "Right_") != NULL] = value->number < 1e9 ? (int64_t)value->number : -1;
  else if (!strcmp(rest, "Linear_Slope"))
    use_term(scale, EO_TDMS_LINEAR, 0, "1", value->number);
  else if (!strcmp(rest, "Linear_Y_Intercept"))
    use_term(scale, EO_TDMS_LINEAR, 0, "0", value->number);
  else if (bracket && strstr(rest, "Polynomial_Coefficients["))
    use_term(scale, EO_TDMS_POLYNOMIAL, 0, bracket + 1, value->number);
  else if (bracket && strstr(rest, "Table_Scaled_Values["))
    use_term(scale, EO_TDMS_TABLE, 0, bracket + 1, value->number);
  else if (bracket && strstr(rest, "Table_Pre_Scaled_Values["))
    use_term(scale, EO_TDMS_TABLE, 1, bracket + 1, value->number);
}

/* The number in a text such as "4000 Hz"; unit: what follows it. */
static double number_in_text(const struct property *value, char *unit, size_t size)
{
  char text[64], *end;
  *unit = '\0';
  if (!value->text || value->length >= sizeof text)
    return value->number;
  memcpy(text, value->text, value->length);
  text[value->length] = '\0';
  double number;
  const char *after = eo_decimal_read(text, strchr(text, ',') && !strchr(text, '.') ? ',' : '.', &number);
  end = text + (after ? after - text : 0);
  snprintf(unit, size, "%s", after ? end : "");
  return after ? number : NAN;
}

/* What a property of a channel, a group or the file says of the sampling. */
static void use_fact(struct eo_series *series, const char *name, const struct property *value)
{
  char unit[64];
  double number = number_in_text(value, unit, sizeof unit);
  struct eo_stated stated = eo_stated_read(name, number, unit);
  if (stated.kind == EO_STATED_INTERVAL && !strcmp(name, "wf_increment") && !(number > 0))
    return;
  eo_series_state(series, &stated);
  if (value->epoch != EO_CLOCK_NO_EPOCH && (!strcmp(name, "wf_start_time") || eo_stated_begin(name)))
    series->clock.epoch = value->epoch;
}

/* What a channel's properties mean to us: its sampling and unit, and the scales of data that were stored raw. */
static void use_property(struct eo_tdms_channel *channel, struct eo_series *series, const char *name,
                         const struct property *value)
{
  if (!strncmp(name, "NI_Scale[", 9))
    use_scale(channel, name, value);
  else if (!strcmp(name, "NI_Scaling_Status") && value->text)
    channel->scaled = is_named(value->text, value->length, "scaled");
  else if (!strcmp(name, "NI_Number_Of_Scales") && value->number >= 0)
    channel->scales = (int64_t)value->number;
  else if (value->text && (!strcmp(name, "unit_string") || (!*series->unit && !strcasecmp(name, "unit")) ||
                           (!*series->unit && !strcasecmp(name, "units"))))
    snprintf(series->unit, sizeof series->unit, "%.*s", (int)(value->length < 64 ? value->length : 64), value->text);
  else if (strncmp(name, "NI_", 3) != 0)
    use_fact(series, name, value);
}

static bool take_properties(struct reader *r, struct eo_tdms_channel *channel, struct eo_series *series)
{
  uint32_t count;
  if (!take_32(r, &count))
    return false;
  for (uint32_t i = 0; i < count; i++) {
    const char *text;
    char name[128];
    uint32_t length;
    struct property value;
    if (!take_string(r, &text, &length) || !take_value(r, &value))
      return false;
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : 0), text);
    if (channel)
      use_property(channel, series, name, &value);
    else if (series)
      use_fact(series, name, &value);
  }
  return true;
}

/* The scaler of raw DAQmx data: type of the values, their buffer and place in a row of it. Types are numbered on their
   own; the last is a time stamp. */
static bool take_scaler(struct reader *r, bool digital, struct eo_tdms_part *part, uint32_t *buffer)
{
  static const enum eo_tdms_type types[] = {EO_TDMS_UINT8,  EO_TDMS_INT8,  EO_TDMS_UINT16, EO_TDMS_INT16,
                                            EO_TDMS_UINT32, EO_TDMS_INT32, EO_TDMS_UINT64, EO_TDMS_INT64,
                                            EO_TDMS_SINGLE, EO_TDMS_DOUBLE};
  uint32_t type, offset;
  if (!take_32(r, &type) || !take_32(r, buffer) || !take_32(r, &offset) || !take(r, digital ? 5 : 8))
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
static bool take_raw_index(struct reader *r, bool digital, struct eo_tdms_channel *channel, int number)
{
  int64_t at = r->at;
  uint32_t type, dimension, scalers, widths, width, buffer = 0, other;
  struct eo_tdms_part part = {.channel = number}, ignored;
  const unsigned char *p;
  if (!channel || !take_32(r, &type) || !take_32(r, &dimension) || !(p = take(r, 8)))
    goto damaged;
  uint64_t count = eo_bytes_64(p, r->big);
  if (!take_32(r, &scalers) || !scalers || scalers > 64 || count > INT64_MAX >> 24 || dimension != 1)
    goto damaged;
  for (uint32_t i = 0; i < scalers; i++)
    if (!take_scaler(r, digital, i ? &ignored : &part, i ? &other : &buffer))
      goto damaged;
  if (!take_32(r, &widths) || !widths || widths > 64 || buffer >= widths)
    goto damaged;
  int64_t row = 0, place = part.offset;
  part.count = (int64_t)count;
  for (uint32_t i = 0; i < widths; i++) {
    if (!take_32(r, &width) || width > 1 << 16)
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
  eo_error_set(r->error, EO_ERROR_INPUT, "",
               "TDMS: the index of raw DAQmx data at byte %lld is damaged or of a kind that is not read; save the "
               "channels converted (as double).",
               (long long)at);
  return false;
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
  if (length == 0x1269 || length == 0x126a)
    return take_raw_index(r, length == 0x126a, channel, number);
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
  channel->index = (struct eo_tdms_part){number, (enum eo_tdms_type)type, (int64_t)count, (int64_t)size, 0, 0, -1};
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
  eo_series_init(&tdms->series[tdms->channels], "", 0);
  name_channel(channel->path, tdms->series[tdms->channels].name, sizeof tdms->series->name);
  return tdms->channels++;
}

/* The group of this path, or the file itself; NULL when there are too many. */
static struct eo_series *find_group(struct eo_tdms *tdms, const char *path, uint32_t length)
{
  for (int i = 0; i < tdms->groups; i++)
    if (is_named(path, length, tdms->group[i].path))
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
    return take_index(r, NULL, -1, &data) && take_properties(r, NULL, find_group(tdms, path, length));
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The properties of TDMS objects: sampling, units, scales of raw values. */
#include "recording/bytes.h"
#include "recording/recorded_unit.h"
#include "recording/tdms_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

const unsigned char *eo_tdms_take(struct eo_tdms_reader *reader, size_t size)
{
  if (size > reader->left) {
    eo_error_set(reader->error, EO_ERROR_INPUT, "",
                 "TDMS: the metadata at byte %lld end where %zu bytes more should follow.", (long long)reader->at,
                 size);
    return NULL;
  }
  const unsigned char *bytes = reader->bytes;
  reader->bytes += size;
  reader->left -= size;
  reader->at += (int64_t)size;
  return bytes;
}

bool eo_tdms_take_32(struct eo_tdms_reader *reader, uint32_t *value)
{
  const unsigned char *p = eo_tdms_take(reader, 4);
  if (p)
    *value = eo_bytes_32(p, reader->big);
  return p;
}

bool eo_tdms_take_string(struct eo_tdms_reader *reader, const char **text, uint32_t *length)
{
  if (!eo_tdms_take_32(reader, length))
    return false;
  *text = (const char *)eo_tdms_take(reader, *length);
  return *text;
}

/* A property's value. */
struct property {
  double number;    /* NaN unless it is one */
  const char *text; /* NULL unless it is one */
  uint32_t length;
  int64_t epoch; /* of a time stamp, else EO_CLOCK_NO_EPOCH */
};

double eo_tdms_number(uint32_t type, const unsigned char *p, bool big)
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

int64_t eo_tdms_epoch(int64_t seconds, double fraction)
{
  return seconds > -1900000000 && seconds < 10000000000 ? (seconds - 2082844800) * 1000000000 + llround(fraction * 1e9)
                                                        : EO_CLOCK_NO_EPOCH;
}

/* Time stamps are seconds since 1904-01-01 and fractions of 2^-64 s. */
static int64_t epoch_of(const unsigned char *p, bool big)
{
  return eo_tdms_epoch((int64_t)eo_bytes_64(big ? p : p + 8, big), (double)eo_bytes_64(big ? p + 8 : p, big) * 0x1p-64);
}

static bool take_value(struct eo_tdms_reader *reader, struct property *value)
{
  uint32_t type;
  *value = (struct property){.number = NAN, .epoch = EO_CLOCK_NO_EPOCH};
  if (!eo_tdms_take_32(reader, &type))
    return false;
  if (type == EO_TDMS_STRING)
    return eo_tdms_take_string(reader, &value->text, &value->length);
  int64_t size = eo_tdms_type_size(type);
  if (!size) {
    eo_error_set(reader->error, EO_ERROR_INPUT, "", "TDMS: the property before byte %lld is of the unknown type %u.",
                 (long long)reader->at, type);
    return false;
  }
  const unsigned char *p = eo_tdms_take(reader, (size_t)size);
  if (!p)
    return false;
  value->number = eo_tdms_number(type, p, reader->big);
  if (type == EO_TDMS_TIMESTAMP)
    value->epoch = epoch_of(p, reader->big);
  return true;
}

bool eo_tdms_is_named(const char *text, uint32_t length, const char *name)
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
    if (value->text && eo_tdms_is_named(value->text, value->length, names[i]))
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

/* What a property of a channel, a group or the file says of the sampling. */
static void use_fact(struct eo_series *series, const char *name, const struct property *value)
{
  char unit[64] = "", text[192] = "";
  double number = value->number;
  struct eo_moment moment;
  if (value->text)
    snprintf(text, sizeof text, "%.*s", (int)(value->length < sizeof text ? value->length : 0), value->text);
  struct eo_stated ratio = eo_stated_read_ratio(name, text);
  eo_series_state(series, &ratio);
  if (*text && eo_stated_moment(name, text, &moment))
    series->clock.epoch = eo_moment_epoch(&moment);
  else if (*text && !eo_stated_read_number(text, &number, unit, sizeof unit))
    return;
  struct eo_stated stated = eo_stated_read(name, number, unit);
  eo_series_state(series, &stated);
  if (value->epoch != EO_CLOCK_NO_EPOCH && eo_stated_begin(name))
    series->clock.epoch = value->epoch;
}

/* The steps of the values themselves, as NI writes them; they are in the unit of the abscissa, which may come later.
   False for other properties. */
static bool use_waveform(struct eo_tdms_channel *channel, const char *name, const struct property *value)
{
  char unit[32];
  double factor;
  if (!strcmp(name, "wf_increment") && value->number > 0)
    channel->increment = value->number;
  else if (!strcmp(name, "wf_start_offset") && isfinite(value->number))
    channel->start = value->number;
  else if (!strcmp(name, "wf_xunit_string") && value->text && value->length < sizeof unit) {
    snprintf(unit, sizeof unit, "%.*s", (int)value->length, value->text);
    enum eo_quantity quantity = eo_unit_find(unit, &factor);
    channel->abscissa = quantity == EO_QUANTITY_TIME ? factor : 1;
  } else
    return false;
  return true;
}

/* What a channel's properties mean to us: its sampling and unit, and the scales of data that were stored raw. */
static void use_property(struct eo_tdms_channel *channel, struct eo_series *series, const char *name,
                         const struct property *value)
{
  if (!strncmp(name, "NI_Scale[", 9))
    use_scale(channel, name, value);
  else if (!strcmp(name, "NI_Scaling_Status") && value->text)
    channel->scaled = eo_tdms_is_named(value->text, value->length, "scaled");
  else if (!strcmp(name, "NI_Number_Of_Scales") && value->number >= 0)
    channel->scales = (int64_t)value->number;
  else if (value->text && (!strcmp(name, "unit_string") || (!*series->unit && !strcasecmp(name, "unit")) ||
                           (!*series->unit && !strcasecmp(name, "units"))))
    snprintf(series->unit, sizeof series->unit, "%.*s", (int)(value->length < 64 ? value->length : 64), value->text);
  else if (strncmp(name, "NI_", 3) != 0 && !use_waveform(channel, name, value))
    use_fact(series, name, value);
}

bool eo_tdms_take_properties(struct eo_tdms_reader *reader, struct eo_tdms_channel *channel, struct eo_series *series)
{
  uint32_t count;
  if (!eo_tdms_take_32(reader, &count))
    return false;
  for (uint32_t i = 0; i < count; i++) {
    const char *text;
    char name[128];
    uint32_t length;
    struct property value;
    if (!eo_tdms_take_string(reader, &text, &length) || !take_value(reader, &value))
      return false;
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : 0), text);
    if (channel)
      use_property(channel, series, name, &value);
    else if (series)
      use_fact(series, name, &value);
  }
  return true;
}

/* The values of NI TDMS files. */
#include "recording/tdms.h"
#include "recording/bytes.h"
#include "recording/readers.h"

#include <stdlib.h>
#include <unistd.h>

#define PIECE ((size_t)64 << 10) /* bytes read at once */

static double value_at(struct eo_tdms_channel *channel, enum eo_tdms_type type, const unsigned char *p, bool big)
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
  case EO_TDMS_BOOLEAN:
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
  case EO_TDMS_TIMESTAMP:
    break;
  case EO_TDMS_STRING:
    return 0;
  }
  /* Seconds since 1904 and fractions of 2^-64 s; only the distance from the first one fits a double without loss. */
  uint64_t seconds = eo_bytes_64(big ? p : p + 8, big);
  double fraction = (double)eo_bytes_64(big ? p + 8 : p, big) * 0x1p-64;
  if (!channel->base_known) {
    channel->base_known = true;
    channel->base = (int64_t)seconds;
  }
  return (double)(int64_t)(seconds - (uint64_t)channel->base) + fraction;
}

/* Where one channel's values stand in a segment. */
struct place {
  const struct eo_tdms_part *part; /* NULL: it has none there */
  int64_t offset;                  /* of its first value in a chunk, bytes */
  int64_t stride;                  /* from value to value, bytes */
  int64_t values;                  /* in the segment */
};

static struct place find_place(const struct eo_tdms_segment *segment, int channel)
{
  struct place place = {0};
  const struct eo_tdms_layout *layout = segment->layout;
  for (int i = 0; i < layout->parts; i++) {
    const struct eo_tdms_part *part = &layout->part[i];
    if (part->channel == channel && part->count) {
      place.part = part;
      place.stride = segment->interleaved ? layout->chunk / part->count : eo_tdms_type_size(part->type);
      place.values = part->count * segment->chunks + segment->rest_rows;
      return place;
    }
    place.offset += segment->interleaved ? eo_tdms_type_size(part->type) : part->size;
  }
  return place;
}

/* Reads up to count values of a chunk from the n-th of the segment on, as many as one piece and the chunk hold. */
static enum eo_code read_piece(const struct eo_tdms *tdms, struct eo_tdms_channel *channel,
                               const struct eo_tdms_segment *segment, const struct place *place, int64_t n,
                               int64_t *count, double *values, unsigned char *bytes, struct eo_error *error)
{
  int64_t size = eo_tdms_type_size(place->part->type), chunk = n / place->part->count,
          in_chunk = n % place->part->count;
  int64_t room = ((int64_t)PIECE - size) / place->stride + 1;
  if (*count > place->part->count - in_chunk)
    *count = place->part->count - in_chunk;
  if (*count > room)
    *count = room;
  int64_t at = segment->at + chunk * segment->layout->chunk + place->offset + in_chunk * place->stride;
  enum eo_code code = eo_bytes_read(tdms->file, at, bytes, (size_t)((*count - 1) * place->stride + size), error);
  for (int64_t i = 0; !code && i < *count; i++)
    values[i] = value_at(channel, place->part->type, bytes + i * place->stride, segment->big) * channel->slope +
                channel->intercept;
  return code;
}

/* Reading goes forwards: the segment where the last call ended is remembered. */
static enum eo_code read_values(void *context, int number, int64_t first, int64_t count, double *values,
                                struct eo_error *error)
{
  struct eo_tdms *tdms = context;
  struct eo_tdms_channel *channel = &tdms->channel[number];
  unsigned char bytes[PIECE];
  while (count > 0 && channel->segment < tdms->segments) {
    const struct eo_tdms_segment *segment = &tdms->segment[channel->segment];
    struct place place = find_place(segment, number);
    int64_t n = first - channel->passed, got = count < place.values - n ? count : place.values - n;
    if (got <= 0) {
      channel->passed += place.values;
      channel->segment++;
      continue;
    }
    enum eo_code code = read_piece(tdms, channel, segment, &place, n, &got, values, bytes, error);
    if (code)
      return code;
    first += got;
    count -= got;
    values += got;
  }
  return EO_OK;
}

/* Channels of text have no values for us. Raw data with one linear scale are scaled; other scales are only noted. */
static void settle_channels(struct eo_tdms *tdms, struct eo_notes *notes)
{
  for (int c = 0; c < tdms->channels; c++) {
    struct eo_tdms_channel *channel = &tdms->channel[c];
    if (channel->index_known && channel->index.type == EO_TDMS_STRING)
      tdms->series[c].length = 0;
    if (channel->index_known && channel->index.type == EO_TDMS_TIMESTAMP)
      memcpy(tdms->series[c].unit, "s", 2);
    bool raw = channel->scales > 0 && !channel->scaled;
    if (!raw || channel->scales > 1 || channel->unknown_scale) {
      channel->slope = 1;
      channel->intercept = 0;
    }
    if (raw && (channel->scales > 1 || channel->unknown_scale))
      eo_notes_add(notes,
                   "The channel \"%s\" holds raw values with a scale that is not linear; they were left as they are.",
                   tdms->series[c].name);
  }
  if (tdms->cut)
    eo_notes_add(notes, "The TDMS file is not complete; its last, unfinished chunk was left out.");
}

enum eo_code eo_tdms_read(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                          struct eo_notes *notes, struct eo_error *error)
{
  struct eo_tdms *tdms = calloc(1, sizeof *tdms);
  if (!tdms)
    return eo_error_memory(error);
  enum eo_code code = eo_bytes_open(path, &tdms->file, &tdms->size, error);
  if (code) {
    free(tdms);
    return code;
  }
  code = eo_tdms_scan(tdms, error);
  if (!code) {
    settle_channels(tdms, notes);
    struct eo_series_file file = {tdms->series, tdms->channels, tdms->size, options->max_bytes, read_values, tdms};
    code = eo_series_copy(&file, sink, notes, error);
  }
  close(tdms->file);
  eo_tdms_done(tdms);
  free(tdms);
  return code;
}

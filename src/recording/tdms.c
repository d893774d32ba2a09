/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The values of NI TDMS files. */
#include "recording/tdms.h"
#include "recording/bytes.h"
#include "recording/namesakes.h"
#include "recording/reader_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define PIECE ((size_t)64 << 10) /* bytes read at once */

static double value_at(struct eo_tdms *tdms, const struct eo_tdms_part *part, const unsigned char *p, bool big)
{
  if (part->bit >= 0)
    return p[0] >> part->bit & 1;
  if (part->type == EO_TDMS_BOOLEAN)
    return p[0];
  if (part->type != EO_TDMS_TIMESTAMP)
    return eo_tdms_number(part->type, p, big);
  /* Seconds since 1904 and fractions of 2^-64 s; only the distance from the first one of the file fits a double without
   * loss. */
  uint64_t seconds = eo_bytes_64(big ? p : p + 8, big);
  double fraction = (double)eo_bytes_64(big ? p + 8 : p, big) * 0x1p-64;
  if (!tdms->base_known) {
    tdms->base_known = true;
    tdms->base = (int64_t)seconds;
  }
  return (double)(int64_t)(seconds - (uint64_t)tdms->base) + fraction;
}

/* Values of one chunk follow each other, lie between those of other channels, or stand in rows of a buffer. */
struct eo_tdms_place eo_tdms_place(const struct eo_tdms_segment *segment, const struct eo_tdms_part *part)
{
  struct eo_tdms_place place = {.part = part};
  if (!part || !part->count)
    return place;
  int64_t size = eo_tdms_type_size(part->type);
  place.offset = part->width ? part->offset : segment->interleaved ? part->row : part->before;
  place.stride = part->width ? part->width : segment->interleaved ? segment->layout->chunk / part->count : size;
  int64_t left = segment->rest - place.offset - size, rest = left < 0 || !place.stride ? 0 : left / place.stride + 1;
  if (segment->interleaved) /* whole rows only */
    rest = segment->rest / place.stride;
  place.values = part->count * segment->chunks + (rest < part->count ? rest : part->count);
  return place;
}

/* The part of a layout that is this channel's, mostly the one it was before; NULL: it has none there. */
static const struct eo_tdms_part *part_of(const struct eo_tdms_layout *layout, int number,
                                          struct eo_tdms_channel *channel)
{
  if (channel->part < layout->parts && layout->part[channel->part].channel == number)
    return &layout->part[channel->part];
  for (int i = 0; i < layout->parts; i++)
    if (layout->part[i].channel == number) {
      channel->part = i;
      return &layout->part[i];
    }
  return NULL;
}

/* Reads up to count values of a chunk from the n-th of the segment on, as many as one piece and the chunk hold. */
static enum eo_code read_piece(struct eo_tdms *tdms, const struct eo_tdms_channel *channel,
                               const struct eo_tdms_segment *segment, const struct eo_tdms_place *place, int64_t n,
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
    values[i] = eo_tdms_scaled(channel, value_at(tdms, place->part, bytes + i * place->stride, segment->big));
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
    struct eo_tdms_place place = eo_tdms_place(segment, part_of(segment->layout, number, channel));
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

/* Facts of the group, then of the file, for what the channel does not say itself. */
static void inherit(struct eo_tdms *tdms, int c)
{
  struct eo_series *series = &tdms->series[c];
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < tdms->groups; i++) {
      const struct eo_tdms_group *group = &tdms->group[i];
      size_t length = strlen(group->path);
      bool mine = pass ? length == 1
                       : length > 1 && !strncmp(tdms->channel[c].path, group->path, length) &&
                             tdms->channel[c].path[length] == '/';
      if (!mine)
        continue;
      if (!(series->clock.interval > 0)) {
        series->clock.interval = group->stated.clock.interval;
        series->clock.other = group->stated.clock.other;
        series->clock.told = group->stated.clock.told;
      }
      if (series->clock.epoch == EO_CLOCK_NO_EPOCH)
        series->clock.epoch = group->stated.clock.epoch;
      series->turn = series->turn > 0 ? series->turn : group->stated.turn;
      series->tick = series->tick > 0 ? series->tick : group->stated.tick;
      if (!(series->clock.thinned > 0))
        series->clock.thinned = group->stated.clock.thinned, series->clock.thins = group->stated.clock.thins;
    }
}

/* The step of a channel's own waveform is that of these values, whatever rate a property beside it states, that of the
   hardware perhaps. A step of 1 is also what LabVIEW writes of a waveform whose step nobody set. Returns the rate that
   was passed over, 0: none. */
static double settle_waveform(const struct eo_tdms_channel *channel, struct eo_series *series)
{
  double unit = channel->abscissa > 0 ? channel->abscissa : 1, step = channel->increment * unit,
         beside = series->clock.interval;
  bool contradicts = eo_series_contradicts(step, beside);
  if (channel->start != 0)
    series->clock.start = channel->start * unit;
  if (!(step > 0))
    return 0;
  series->clock.interval = step;
  series->clock.thinned = 0;
  series->clock.other = contradicts && channel->increment == 1 ? beside : 0;
  return contradicts && !(series->clock.other > 0) ? 1 / beside : 0;
}

static void settle_waveforms(struct eo_tdms *tdms, struct eo_notes *notes)
{
  bool said = false;
  for (int c = 0; c < tdms->channels; c++) {
    double beside = settle_waveform(&tdms->channel[c], &tdms->series[c]);
    if (beside > 0 && !said)
      eo_notes_add(
          notes,
          "\"%s\" states a rate of %.6g Hz beside the step of its values (wf_increment), which is %.6g Hz: the "
          "step was taken, the other rate for that of the hardware.",
          tdms->series[c].name, beside, 1 / tdms->series[c].clock.interval);
    said = said || beside > 0;
  }
}

static void tell_group(const void *context, int series, int namesake, char *group, size_t size)
{
  const char *path = ((const struct eo_tdms *)context)->channel[series].path, *end = strstr(path, "'/'");
  (void)namesake;
  if (end)
    snprintf(group, size, "%.*s", (int)(end - path - 2), path + 2);
}

/* Channels of text and of complex numbers have no values for us, nor have raw values without a scale we know. */
static void settle_channels(struct eo_tdms *tdms, struct eo_notes *notes)
{
  for (int c = 0; c < tdms->channels; c++) {
    struct eo_tdms_channel *channel = &tdms->channel[c];
    enum eo_tdms_type type = channel->index.type;
    if (channel->index_known &&
        (type == EO_TDMS_STRING || type == EO_TDMS_COMPLEX_SINGLE || type == EO_TDMS_COMPLEX_DOUBLE)) {
      if (type != EO_TDMS_STRING)
        eo_notes_add(notes, "The channel \"%s\" holds complex numbers and was left out.", tdms->series[c].name);
      tdms->series[c].length = 0;
    }
    if (channel->index_known && type == EO_TDMS_TIMESTAMP)
      memcpy(tdms->series[c].unit, "s", 2);
    if (channel->scaled || channel->scales <= 0) {
      free(channel->scale);
      channel->scale = NULL;
    } else if (!eo_tdms_can_scale(channel)) {
      tdms->series[c].length = 0;
      eo_notes_add(notes,
                   "The channel \"%s\" holds raw values with a scale that is not known here and was left out; save it "
                   "scaled (as double).",
                   tdms->series[c].name);
    }
    inherit(tdms, c);
  }
  settle_waveforms(tdms, notes);
  eo_namesakes_part(tdms->series, tdms->channels, tell_group, tdms);
  if (tdms->cut)
    eo_notes_add(notes, "The TDMS file was not closed or is cut off; what is there of its last chunk was read.");
}

/* Time stamps count from the second of the first one of the file, a moment that other files can be compared with. */
static enum eo_code settle_stamps(struct eo_tdms *tdms, struct eo_error *error)
{
  for (int c = 0; c < tdms->channels; c++) {
    struct eo_series *series = &tdms->series[c];
    double first;
    if (tdms->channel[c].index.type != EO_TDMS_TIMESTAMP || series->length < 1)
      continue;
    if (!tdms->base_known)
      EO_TRY(read_values(tdms, c, 0, 1, &first, error));
    series->clock.epoch = eo_tdms_epoch(tdms->base, 0);
  }
  return EO_OK;
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
    code = settle_stamps(tdms, error);
  }
  if (!code) {
    struct eo_series_file file = {tdms->series, tdms->channels, tdms->size, options->max_bytes, read_values, tdms};
    code = eo_series_copy(&file, sink, notes, error);
  }
  close(tdms->file);
  eo_tdms_done(tdms);
  free(tdms);
  return code;
}

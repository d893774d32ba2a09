/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The values of ASAM MDF 4 files. */
#include "recording/mdf.h"
#include "recording/reader_private.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#define CACHE ((int64_t)8 << 20) /* bytes of records that are read at once */

/* Copies bytes of the group's records, wherever they lie. */
static enum eo_code copy_bytes(const struct eo_mdf_group *group, int64_t first, int64_t size, unsigned char *bytes,
                               struct eo_error *error)
{
  int low = 0, high = group->pieces - 1;
  while (low < high) { /* the last piece that begins at or before `first` */
    int middle = low + (high - low + 1) / 2;
    low = group->piece[middle].first <= first ? middle : low;
    high = group->piece[middle].first <= first ? high : middle - 1;
  }
  for (int i = low; i < group->pieces && size > 0; i++) {
    const struct eo_mdf_piece *piece = &group->piece[i];
    int64_t in_piece = first - piece->first, n = piece->size - in_piece < size ? piece->size - in_piece : size;
    enum eo_code code = eo_bytes_read(piece->file, piece->at + in_piece, bytes, (size_t)n, error);
    if (code)
      return code;
    first += n;
    bytes += n;
    size -= n;
  }
  return size ? eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the records end before their number.") : EO_OK;
}

/* Records first .. first + count - 1 of a group stand in mdf->rows then; channels of one group ask for the same ones.
 */
static enum eo_code load_rows(struct eo_mdf *mdf, int g, int64_t first, int64_t count, struct eo_error *error)
{
  const struct eo_mdf_group *group = &mdf->group[g];
  int64_t stride = group->skip + group->record;
  if (mdf->rows && mdf->rows_group == g && mdf->rows_first == first && mdf->rows_count == count)
    return EO_OK;
  size_t size = (size_t)(count * stride);
  if (size > mdf->room) {
    unsigned char *grown = realloc(mdf->rows, size);
    if (!grown)
      return eo_error_memory(error);
    mdf->rows = grown;
    mdf->room = size;
  }
  mdf->rows_count = 0;
  enum eo_code code = copy_bytes(group, first * stride, count * stride, mdf->rows, error);
  if (code)
    return code;
  mdf->rows_group = g;
  mdf->rows_first = first;
  mdf->rows_count = count;
  return EO_OK;
}

/* Sign, 5 bits of exponent, 10 of fraction (IEEE 754 binary16). */
static double half_value(uint64_t bits)
{
  enum { FRACTION = 10, MOST = 31, BIAS = 15 };
  int exponent = (int)(bits >> FRACTION & MOST), fraction = (int)(bits & ((1 << FRACTION) - 1));
  double size = exponent == MOST ? (fraction ? NAN : INFINITY)
                : exponent       ? ldexp(1 + fraction * 0x1p-10, exponent - BIAS)
                                 : ldexp(fraction, 1 - BIAS - FRACTION);
  return bits >> 15 & 1 ? -size : size;
}

/* The bytes that hold the value are put in order, then shifted by its first bit: of 64 bits that begin in the middle of
   a byte there are nine bytes. */
static uint64_t bits_at(const struct eo_mdf_channel *channel, const unsigned char *p)
{
  int bytes = (channel->bit + channel->bits + 7) / 8;
  bool big = channel->type & 1;
  uint64_t low = 0;
  for (int i = 0; i < bytes && i < 8; i++)
    low |= (uint64_t)p[big ? bytes - 1 - i : i] << 8 * i;
  low >>= channel->bit;
  if (bytes > 8)
    low |= (uint64_t)p[big ? 0 : 8] << (64 - channel->bit);
  return channel->bits < 64 ? low & (((uint64_t)1 << channel->bits) - 1) : low;
}

static double raw_value(const struct eo_mdf_channel *channel, const unsigned char *record)
{
  enum { SIGNED = 2, FLOATING = 4 };
  uint64_t bits = bits_at(channel, record + channel->byte);
  if (channel->type >= FLOATING) {
    uint32_t half = (uint32_t)bits;
    float single;
    double full;
    memcpy(&single, &half, sizeof single);
    memcpy(&full, &bits, sizeof full);
    return channel->bits == 64 ? full : channel->bits == 32 ? (double)single : half_value(bits);
  }
  if (channel->type < SIGNED || !(bits >> (channel->bits - 1) & 1))
    return (double)bits;
  uint64_t sign = channel->bits < 64 ? ~(uint64_t)0 << channel->bits : 0;
  return (double)(int64_t)(bits | sign);
}

/* NaN where the record says that the value means nothing. */
static double value_at(const struct eo_mdf *mdf, const struct eo_mdf_channel *channel, const unsigned char *record)
{
  const struct eo_mdf_group *group = &mdf->group[channel->group];
  int64_t byte = group->data + channel->invalid / 8;
  if (channel->invalid >= 0 && byte < group->record && record[byte] >> channel->invalid % 8 & 1)
    return NAN;
  return eo_mdf_convert(channel->conversion, raw_value(channel, record), channel->type < 4);
}

static enum eo_code read_values(void *context, int number, int64_t first, int64_t count, double *values,
                                struct eo_error *error)
{
  struct eo_mdf *mdf = context;
  const struct eo_mdf_channel *channel = &mdf->channel[number];
  const struct eo_mdf_group *group = &mdf->group[channel->group];
  int64_t stride = group->skip + group->record;
  for (int64_t i = 0; channel->virtual && i < count; i++)
    values[i] = eo_mdf_convert(channel->conversion, (double)(first + i), true);
  for (int64_t most = stride ? CACHE / stride : 0; !channel->virtual && count > 0;) {
    int64_t n = count < most ? count : most;
    enum eo_code code = load_rows(mdf, channel->group, first, n, error);
    if (code)
      return code;
    for (int64_t i = 0; i < n; i++)
      *values++ = value_at(mdf, channel, mdf->rows + i * stride + group->skip);
    first += n;
    count -= n;
  }
  return EO_OK;
}

enum eo_code eo_mdf_read(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                         struct eo_notes *notes, struct eo_error *error)
{
  struct eo_mdf *mdf = calloc(1, sizeof *mdf);
  if (!mdf)
    return eo_error_memory(error);
  mdf->spool = -1;
  mdf->spool_directory = options->spool_directory;
  mdf->limit = options->max_bytes;
  mdf->notes = notes;
  enum eo_code code = eo_bytes_open(path, &mdf->file, &mdf->size, error);
  if (code) {
    free(mdf);
    return code;
  }
  code = eo_mdf_scan(mdf, error);
  if (!code) {
    struct eo_series_file file = {mdf->series, mdf->channels, mdf->size, options->max_bytes, read_values, mdf};
    code = eo_series_copy(&file, sink, notes, error);
  }
  close(mdf->file);
  eo_mdf_done(mdf);
  free(mdf);
  return code;
}

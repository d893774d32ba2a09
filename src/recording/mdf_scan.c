/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The structure of an MDF file: header -> lists of data -> groups of records -> channels. */
#include "recording/mdf.h"
#include "recording/namesakes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <unistd.h>

enum { HEADER_AT = 64, DEPTH = 4 /* channels in channels */ };

/* Time stamps of the header: ns since 1970. */
static void read_start(struct eo_mdf *mdf, const struct eo_mdf_block *header)
{
  int64_t start = (int64_t)eo_bytes_64(header->data, false);
  mdf->epoch = start > 0 ? start : EO_CLOCK_NO_EPOCH;
  mdf->comment = header->link[5];
}

/* "4.10" or the number 410; what was not finalised may lack numbers of records and the length of the last data block,
   which are found here; other gaps are for the tool that wrote the file. */
static enum eo_code check_version(struct eo_mdf *mdf, struct eo_error *error)
{
  enum { COUNTS = 1, REDUCTIONS = 2, LAST_LENGTH = 4, FOUND_HERE = COUNTS | REDUCTIONS | LAST_LENGTH };
  unsigned char id[HEADER_AT];
  enum eo_code code = eo_bytes_read(mdf->file, 0, id, sizeof id, error);
  if (code)
    return code;
  mdf->unfinished = !memcmp(id, "UnFinMF ", 8);
  if (id[8] != '4')
    return eo_error_set(
        error, EO_ERROR_INPUT, "",
        "The file is an ASAM MDF of version %.4s, and only version 4 is read; convert it to 4.1, or export "
        "the channels as text, MATLAB or HDF5 (asammdf: Convert; CANape, INCA, vSignalyzer: export).",
        (const char *)id + 8);
  int gaps = eo_bytes_16(id + 60, false);
  if (mdf->unfinished && gaps & ~FOUND_HERE)
    return eo_error_set(
        error, EO_ERROR_INPUT, "",
        "The file is an ASAM MDF 4 that was not finalised (flags %d); let the tool that wrote it finalise "
        "it, or export the channels as text, MATLAB or HDF5.",
        gaps);
  return EO_OK;
}

static struct eo_mdf_group *add_group(struct eo_mdf *mdf, struct eo_error *error)
{
  if (mdf->groups == EO_MDF_GROUPS) {
    eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the file has more than %d groups of records.", EO_MDF_GROUPS);
    return NULL;
  }
  struct eo_mdf_group *grown = realloc(mdf->group, (size_t)(mdf->groups + 1) * sizeof *grown);
  if (!grown) {
    eo_error_memory(error);
    return NULL;
  }
  mdf->group = grown;
  mdf->group[mdf->groups] = (struct eo_mdf_group){.master = -1};
  return &mdf->group[mdf->groups++];
}

/* A group of records: number, count, flags, lengths. Texts and the like have a group of their own, whose records state
   their length. */
static enum eo_code read_group(struct eo_mdf *mdf, const struct eo_mdf_block *block, struct eo_error *error)
{
  enum { VARIABLE = 1, BUS = 2 | 4, REMOTE_MASTER = 8 };
  struct eo_mdf_group *group = add_group(mdf, error);
  if (!group)
    return error->code;
  int flags = eo_bytes_16(block->data + 16, false);
  uint32_t invalidation = eo_bytes_32(block->data + 28, false);
  group->number = eo_bytes_64(block->data, false);
  group->stated = (int64_t)eo_bytes_64(block->data + 8, false);
  group->data = eo_bytes_32(block->data + 24, false);
  group->record = group->data + invalidation;
  group->variable = flags & VARIABLE;
  group->comment = block->link[5];
  group->at = block->at;
  group->master_at = flags & REMOTE_MASTER ? block->link[6] : 0;
  eo_mdf_text(mdf, block->link[2], group->name, sizeof group->name);
  mdf->frames += (flags & BUS) != 0;
  if (!group->variable && group->record > EO_MDF_RECORD)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the records of the group at byte %lld have %lld bytes.",
                        (long long)block->at, (long long)group->record);
  return EO_OK;
}

/* The numbers of a channel block: kind, way of synchronising, type, place. */
struct numbers {
  int kind, sync, type, bit;
  uint32_t byte, bits, flags, invalid;
};

enum { SYNC_TIME = 1, SYNC_ANGLE = 2, ALL_INVALID = 1, HAS_INVALID = 2, LAST_TYPE = 5 };

static struct numbers numbers_of(const struct eo_mdf_block *block)
{
  const unsigned char *p = block->data;
  return (struct numbers){.kind = p[0],
                          .sync = p[1],
                          .type = p[2],
                          .bit = p[3],
                          .byte = eo_bytes_32(p + 4, false),
                          .bits = eo_bytes_32(p + 8, false),
                          .flags = eo_bytes_32(p + 12, false),
                          .invalid = eo_bytes_32(p + 16, false)};
}

/* One number per record, within the record: integers of any width, floating values of 16, 32 or 64 bits. */
static bool is_number(const struct numbers *numbers, const struct eo_mdf_group *group)
{
  bool virtual = numbers->kind == EO_MDF_VIRTUAL_MASTER || numbers->kind == EO_MDF_VIRTUAL;
  bool floating = numbers->type >= 4;
  if (numbers->flags & ALL_INVALID)
    return false;
  if (virtual)
    return true;
  if ((numbers->kind != EO_MDF_VALUE && numbers->kind != EO_MDF_MASTER) || numbers->type > LAST_TYPE ||
      numbers->bits < 1 || numbers->bits > 64)
    return false;
  if (floating && numbers->bits != 16 && numbers->bits != 32 && numbers->bits != 64)
    return false;
  return numbers->bit < 8 && (!floating || !numbers->bit) &&
         numbers->byte + (numbers->bit + (int64_t)numbers->bits + 7) / 8 <= group->data;
}

static void name_unit(struct eo_mdf *mdf, const struct eo_mdf_block *block, const struct numbers *numbers,
                      struct eo_series *series)
{
  struct eo_mdf_block conversion;
  struct eo_error error;
  bool master = numbers->kind == EO_MDF_MASTER || numbers->kind == EO_MDF_VIRTUAL_MASTER;
  eo_mdf_text(mdf, block->link[6], series->unit, sizeof series->unit);
  if (!*series->unit && block->link[4] && !eo_mdf_open(mdf, block->link[4], "CC", &conversion, &error))
    eo_mdf_text(mdf, conversion.link[1], series->unit, sizeof series->unit);
  if (!*series->unit && master &&
      (numbers->sync == SYNC_TIME || numbers->sync == SYNC_ANGLE)) /* the format's own units */
    snprintf(series->unit, sizeof series->unit, "%s", numbers->sync == SYNC_TIME ? "s" : "rad");
}

/* Times that follow from the number of the record are a clock and no column. */
static bool take_clock(struct eo_mdf_group *group, const struct numbers *numbers,
                       const struct eo_mdf_conversion *conversion)
{
  if (numbers->kind != EO_MDF_VIRTUAL_MASTER || numbers->sync != SYNC_TIME ||
      (conversion && conversion->kind != EO_MDF_LINEAR && conversion->kind != EO_MDF_EQUAL))
    return false;
  group->start = eo_mdf_convert(conversion, 0, true);
  group->interval = eo_mdf_convert(conversion, 1, true) - group->start;
  return true;
}

static enum eo_code add_channel(struct eo_mdf *mdf, int g, const struct eo_mdf_block *block,
                                const struct numbers *numbers, struct eo_error *error)
{
  if (mdf->channels == EO_SERIES) {
    mdf->left_out++;
    return EO_OK;
  }
  struct eo_mdf_conversion *conversion;
  enum eo_code code = eo_mdf_conversion_read(mdf, block->link[4], &conversion, error);
  if (code)
    return code;
  bool clock = take_clock(&mdf->group[g], numbers, conversion);
  if (clock || !eo_mdf_is_numeric(conversion)) {
    mdf->formulas += !clock && conversion->kind == EO_MDF_FORMULA;
    mdf->texts += !clock && conversion->kind != EO_MDF_FORMULA;
    eo_mdf_conversion_free(conversion);
    return EO_OK;
  }
  int c = mdf->channels++;
  struct eo_series *series = &mdf->series[c];
  mdf->channel[c] = (struct eo_mdf_channel){.group = g,
                                            .virtual = numbers->kind == EO_MDF_VIRTUAL_MASTER ||
                                                       numbers->kind == EO_MDF_VIRTUAL,
                                            .type = numbers->type,
                                            .bit = numbers->bit,
                                            .bits = (int)numbers->bits,
                                            .byte = numbers->byte,
                                            .invalid = numbers->flags & HAS_INVALID ? (int64_t)numbers->invalid : -1,
                                            .conversion = conversion};
  eo_series_init(series, "", 0);
  eo_mdf_text(mdf, block->link[2], series->name, sizeof series->name);
  name_unit(mdf, block, numbers, series);
  eo_mdf_facts(mdf, mdf->comment, series); /* the nearest text counts, so it comes last */
  eo_mdf_facts(mdf, mdf->group[g].comment, series);
  eo_mdf_facts(mdf, block->link[7], series);
  if ((numbers->kind == EO_MDF_MASTER || numbers->kind == EO_MDF_VIRTUAL_MASTER) && numbers->sync == SYNC_TIME)
    mdf->group[g].master = c;
  return EO_OK;
}

/* The channels of a list, and those of which a channel is composed. Arrays are left out: they are no channel over
   time. */
static enum eo_code read_channels(struct eo_mdf *mdf, int g, int64_t at, int depth, struct eo_error *error)
{
  while (at) {
    struct eo_mdf_block block, parts = {0};
    enum eo_code code = eo_mdf_open(mdf, at, "CN", &block, error);
    if (!code && block.link[1])
      code = eo_mdf_open(mdf, block.link[1], NULL, &parts, error);
    if (code)
      return code;
    struct numbers numbers = numbers_of(&block);
    if (!strcmp(parts.id, "CN")) {
      if (depth < DEPTH)
        code = read_channels(mdf, g, parts.at, depth + 1, error);
    } else if (*parts.id || !is_number(&numbers, &mdf->group[g]))
      mdf->texts++;
    else
      code = add_channel(mdf, g, &block, &numbers, error);
    if (code)
      return code;
    at = block.link[0];
  }
  return EO_OK;
}

/* The groups of one list of data, then their records. */
static enum eo_code read_data_group(struct eo_mdf *mdf, const struct eo_mdf_block *data, struct eo_error *error)
{
  int first = mdf->groups, number = data->data[0];
  if (number != 0 && number != 1 && number != 2 && number != 4 && number != 8)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the data group at byte %lld states numbers of %d bytes.",
                        (long long)data->at, number);
  for (int64_t at = data->link[1]; at;) {
    struct eo_mdf_block block;
    enum eo_code code = eo_mdf_open(mdf, at, "CG", &block, error);
    if (!code)
      code = read_group(mdf, &block, error);
    int g = mdf->groups - 1;
    if (!code && !mdf->group[g].variable)
      code = read_channels(mdf, g, block.link[1], 0, error);
    if (code)
      return code;
    at = block.link[0];
  }
  return eo_mdf_find_records(mdf, data->link[2], number, first, mdf->groups - first, error);
}

/* Groups are told apart by their names, where they have some. */
static void tell_group(const void *context, int series, int namesake, char *group, size_t size)
{
  const struct eo_mdf *mdf = context;
  int own = mdf->channel[series].group;
  if (own != mdf->channel[namesake].group)
    snprintf(group, size, "%s", mdf->group[own].name);
}

/* The group that has the times of a group: itself, or (MDF 4.2, column by column) another one with as many records. */
static const struct eo_mdf_group *clock_group(const struct eo_mdf *mdf, const struct eo_mdf_group *group)
{
  for (int g = 0; group->master < 0 && !(group->interval > 0) && group->master_at && g < mdf->groups; g++)
    if (mdf->group[g].at == group->master_at && mdf->group[g].rows == group->rows)
      return &mdf->group[g];
  return group;
}

/* Each channel gets length and clock of its group. */
static void settle(struct eo_mdf *mdf)
{
  for (int c = 0; c < mdf->channels; c++) {
    struct eo_series *series = &mdf->series[c];
    const struct eo_mdf_group *group = &mdf->group[mdf->channel[c].group];
    const struct eo_mdf_group *times = clock_group(mdf, group);
    series->length = group->rows;
    series->clock.epoch = mdf->epoch;
    if (times->master >= 0 && times->master != c)
      series->clock.column = times->master;
    if (times->interval > 0) {
      series->clock.interval = times->interval, series->clock.other = 0;
      series->clock.start = times->start;
    }
  }
  eo_namesakes_part(mdf->series, mdf->channels, tell_group, mdf);
}

static void say_what_stays_out(const struct eo_mdf *mdf)
{
  if (mdf->cut)
    eo_notes_add(mdf->notes,
                 "The MDF file holds fewer records than it states: it was cut off; what is there was read.");
  if (mdf->unfinished)
    eo_notes_add(mdf->notes, "The MDF file was not finalised: its records were counted.");
  if (mdf->left_out)
    eo_notes_add(mdf->notes, "Only the first %d channels were looked at, %d more were left out.", EO_SERIES,
                 mdf->left_out);
  if (mdf->formulas)
    eo_notes_add(mdf->notes, "%d channel%s a formula as conversion and %s left out; save them converted.",
                 mdf->formulas, mdf->formulas == 1 ? " has" : "s have", mdf->formulas == 1 ? "was" : "were");
  if (mdf->texts)
    eo_notes_add(mdf->notes, "%d channel%s of texts, arrays or bytes %s left out.", mdf->texts,
                 mdf->texts == 1 ? "" : "s", mdf->texts == 1 ? "was" : "were");
  if (mdf->frames)
    eo_notes_add(mdf->notes, "%d group%s raw frames of a bus; their signals must be decoded and saved as channels.",
                 mdf->frames, mdf->frames == 1 ? " holds" : "s hold");
}

enum eo_code eo_mdf_scan(struct eo_mdf *mdf, struct eo_error *error)
{
  struct eo_mdf_block header, data;
  enum eo_code code = check_version(mdf, error);
  if (!code)
    code = eo_mdf_open(mdf, HEADER_AT, "HD", &header, error);
  if (code)
    return code;
  read_start(mdf, &header);
  for (int64_t at = header.link[0]; at; at = data.link[0]) {
    code = eo_mdf_open(mdf, at, "DG", &data, error);
    if (!code)
      code = read_data_group(mdf, &data, error);
    if (code)
      return code;
  }
  settle(mdf);
  say_what_stays_out(mdf);
  return EO_OK;
}

void eo_mdf_done(struct eo_mdf *mdf)
{
  for (int c = 0; c < mdf->channels; c++)
    eo_mdf_conversion_free(mdf->channel[c].conversion);
  for (int g = 0; g < mdf->groups; g++)
    free(mdf->group[g].piece);
  free(mdf->group);
  free(mdf->rows);
  if (mdf->spool >= 0)
    close(mdf->spool);
}

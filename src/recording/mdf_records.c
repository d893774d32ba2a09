/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The records of an MDF file. Data blocks hold them as they are (DT) or compressed (DZ), in lists (DL, HL). Where the
   records of one kind follow each other as they are, they are read from the file; what is compressed, or mixed with
   records of other kinds, is sorted into a temporary file first, one region for each kind. */
#include "recording/mdf.h"
#include "recording/source.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>
#include <zlib.h>

enum {
  PIECE = 64 << 10,  /* bytes read at once */
  BUFFER = 8 << 10,  /* bytes of records of one kind that wait to be written */
  ENTRIES = 1 << 20, /* data blocks of one list */
  MIXED = 1024       /* kinds of records in one list of data */
};

enum packing { PLAIN, DEFLATED, TRANSPOSED };

/* One data block. */
struct block {
  enum packing packing;
  int64_t at, size; /* in the file */
  int64_t length;   /* of what it holds */
  int64_t width;    /* of transposed ones: bytes of a row */
};

struct blocks {
  struct block *block; /* owned */
  int64_t count, room, length;
  bool apart; /* values (DV) without the invalidation bits, which stand in blocks of their own (DI) */
};

static enum eo_code add_block(struct eo_mdf *mdf, struct blocks *blocks, const struct block *block,
                              struct eo_error *error)
{
  if (blocks->count == ENTRIES)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: a list of data has more than %d blocks.", ENTRIES);
  if (blocks->count == blocks->room) {
    int64_t room = blocks->room ? 2 * blocks->room : 16;
    struct block *grown = realloc(blocks->block, (size_t)room * sizeof *grown);
    if (!grown)
      return eo_error_memory(error);
    blocks->block = grown;
    blocks->room = room;
  }
  mdf->stored += block->size;
  if (mdf->stored > mdf->size)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the lists of data lead to the block at byte %lld once more; the file is damaged.",
                        (long long)block->at);
  blocks->block[blocks->count++] = *block;
  blocks->length += block->length;
  return EO_OK;
}

/* A compressed block: kind of what it holds, way of packing, width of rows, length, packed length. */
static enum eo_code add_packed(struct eo_mdf *mdf, struct blocks *blocks, const struct eo_mdf_block *found,
                               struct eo_error *error)
{
  enum { PACKED_AT = 24, GROWTH = 1100 }; /* deflate packs 1032 bytes into one at most */
  int64_t length = (int64_t)eo_bytes_64(found->data + 8, false), size = (int64_t)eo_bytes_64(found->data + 16, false);
  if (found->data[2] > 1)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the data at byte %lld are packed in a way (%d) that is not read; save the file with "
                        "deflate or without compression.",
                        (long long)found->at, found->data[2]);
  if (size < 0 || size > found->size - PACKED_AT || length < 0 || length > EO_MDF_INFLATED || length / GROWTH > size)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the compressed data at byte %lld state %lld bytes in %lld; the file is damaged.",
                        (long long)found->at, (long long)length, (long long)size);
  struct block block = {found->data[2] ? TRANSPOSED : DEFLATED, found->data_at + PACKED_AT, size, length,
                        eo_bytes_32(found->data + 4, false)};
  return add_block(mdf, blocks, &block, error);
}

static enum eo_code add_blocks(struct eo_mdf *mdf, int64_t at, int depth, struct blocks *blocks,
                               struct eo_error *error);

/* How many links of a list lead to data. A list of columns (LD, MDF 4.2) states it, and behind them may stand links to
   the invalidation bits of the same records. */
static enum eo_code count_data_links(const struct eo_mdf_block *list, int64_t *count, struct eo_error *error)
{
  const uint32_t has_bits = (uint32_t)1 << 31;
  *count = list->links - 1;
  if (strcmp(list->id, "LD") != 0)
    return EO_OK;
  int64_t stated = eo_bytes_32(list->data + 4, false);
  if (eo_bytes_32(list->data, false) & has_bits)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: which values at byte %lld mean nothing is stored apart from them (MDF 4.2), which is not "
                        "read; save the file as MDF 4.1 or export the channels as text, MATLAB or HDF5.",
                        (long long)list->at);
  if (stated > *count)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the list at byte %lld states %lld blocks and has %lld links.",
                        (long long)list->at, (long long)stated, (long long)list->links);
  *count = stated;
  return EO_OK;
}

/* A list: its links lead to the next list and to data blocks. */
static enum eo_code add_list(struct eo_mdf *mdf, struct eo_mdf_block *list, struct blocks *blocks,
                             struct eo_error *error)
{
  for (;;) {
    int64_t count;
    enum eo_code code = count_data_links(list, &count, error);
    for (int64_t i = 1; i <= count && !code; i++) {
      unsigned char bytes[8];
      code = eo_bytes_read(mdf->file, list->data_at - 8 * (list->links - i), bytes, 8, error);
      int64_t at = code ? 0 : (int64_t)eo_bytes_64(bytes, false);
      if (!code && at)
        code = add_blocks(mdf, at, 1, blocks, error);
    }
    if (code || !list->link[0])
      return code;
    const char id[3] = {list->id[0], list->id[1], 0};
    code = eo_mdf_open(mdf, list->link[0], id, list, error);
    if (code)
      return code;
  }
}

/* What stands at a place where data are expected. depth: 1 in a list, where there are no other lists. */
static enum eo_code add_blocks(struct eo_mdf *mdf, int64_t at, int depth, struct blocks *blocks, struct eo_error *error)
{
  struct eo_mdf_block found;
  enum eo_code code = eo_mdf_open(mdf, at, NULL, &found, error);
  if (code)
    return code;
  if (!strcmp(found.id, "DT") || !strcmp(found.id, "DV")) {
    blocks->apart = blocks->apart || found.id[1] == 'V';
    struct block block = {PLAIN, found.data_at, found.size, found.size, 0};
    return add_block(mdf, blocks, &block, error);
  }
  if (!strcmp(found.id, "DZ")) {
    blocks->apart = blocks->apart || !memcmp(found.data, "DV", 2);
    return add_packed(mdf, blocks, &found, error);
  }
  if (!strcmp(found.id, "HL") && !depth) {
    if (!found.link[0])
      return EO_OK;
    code = eo_mdf_open(mdf, found.link[0], "DL", &found, error);
    if (code)
      return code;
  }
  if ((!strcmp(found.id, "DL") || !strcmp(found.id, "LD")) && !depth)
    return add_list(mdf, &found, blocks, error);
  return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: at byte %lld there are no data but a block %s.", (long long)at,
                      found.id);
}

/* The content of data blocks one after the other. */
struct stream {
  const struct eo_mdf *mdf;
  const struct blocks *blocks;
  int64_t next, in_next; /* block, and byte in it where it is plain, from which to go on */
  unsigned char *bytes, *packed;
  size_t at, filled, room, packed_room;
};

static bool make_room(unsigned char **bytes, size_t *room, size_t size)
{
  if (size <= *room)
    return true;
  unsigned char *grown = realloc(*bytes, size);
  if (grown) {
    *bytes = grown;
    *room = size;
  }
  return grown;
}

/* Rows of `width` bytes were stored column by column; what is left of the last row stands behind them as it is. */
static void turn_back(const unsigned char *from, size_t length, size_t width, unsigned char *to)
{
  size_t rows = width ? length / width : 0;
  for (size_t column = 0; rows && column < width; column++)
    for (size_t row = 0; row < rows; row++)
      to[row * width + column] = from[column * rows + row];
  memcpy(to + rows * width, from + rows * width, length - rows * width);
}

static enum eo_code inflate_block(struct stream *stream, const struct block *block, struct eo_error *error)
{
  size_t length = (size_t)block->length, size = (size_t)block->size;
  bool turned = block->packing == TRANSPOSED && block->width > 1;
  if (!make_room(&stream->packed, &stream->packed_room, size + (turned ? length : 0) + 1) ||
      !make_room(&stream->bytes, &stream->room, length + 1))
    return eo_error_memory(error);
  enum eo_code code = eo_bytes_read(stream->mdf->file, block->at, stream->packed, size, error);
  if (code)
    return code;
  uLongf got = (uLongf)length;
  unsigned char *to = turned ? stream->packed + size : stream->bytes;
  if (uncompress(to, &got, stream->packed, (uLong)size) != Z_OK || got != length)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: the compressed data at byte %lld are damaged.",
                        (long long)block->at);
  if (turned)
    turn_back(to, length, (size_t)block->width, stream->bytes);
  stream->filled = length;
  return EO_OK;
}

static enum eo_code refill(struct stream *stream, struct eo_error *error)
{
  stream->at = stream->filled = 0;
  while (stream->next < stream->blocks->count && !stream->filled) {
    const struct block *block = &stream->blocks->block[stream->next];
    enum eo_code code = EO_OK;
    if (block->packing == PLAIN) {
      int64_t left = block->size - stream->in_next, size = left < PIECE ? left : PIECE;
      if (!make_room(&stream->bytes, &stream->room, PIECE))
        return eo_error_memory(error);
      code = eo_bytes_read(stream->mdf->file, block->at + stream->in_next, stream->bytes, (size_t)size, error);
      stream->filled = (size_t)size;
      stream->in_next += size;
      if (stream->in_next < block->size)
        return code;
    } else
      code = inflate_block(stream, block, error);
    if (code)
      return code;
    stream->next++;
    stream->in_next = 0;
  }
  return EO_OK;
}

/* Takes size bytes, to nowhere when bytes is NULL. *got is smaller at the end only. */
static enum eo_code take(struct stream *stream, unsigned char *bytes, size_t size, size_t *got, struct eo_error *error)
{
  *got = 0;
  while (*got < size) {
    if (stream->at == stream->filled) {
      enum eo_code code = refill(stream, error);
      if (code || stream->at == stream->filled)
        return code;
    }
    size_t n = stream->filled - stream->at < size - *got ? stream->filled - stream->at : size - *got;
    if (bytes)
      memcpy(bytes + *got, stream->bytes + stream->at, n);
    stream->at += n;
    *got += n;
  }
  return EO_OK;
}

/* Records of one kind on their way into their region of the temporary file. */
struct region {
  struct eo_mdf_group *group;
  int64_t rows, at; /* records found; byte of the temporary file where the next one goes */
  size_t waiting;
  unsigned char buffer[BUFFER];
};

struct sorter {
  struct eo_mdf *mdf;
  struct stream stream;
  int number; /* bytes of the number before a record */
  int count;
  struct region *region; /* [count] */
  unsigned char *record; /* [EO_MDF_RECORD] */
};

static enum eo_code flush(const struct sorter *sorter, struct region *region, struct eo_error *error)
{
  enum eo_code code = eo_bytes_write(sorter->mdf->spool, region->at, region->buffer, region->waiting, error);
  region->at += (int64_t)region->waiting;
  region->waiting = 0;
  return code;
}

static enum eo_code put_record(const struct sorter *sorter, struct region *region, struct eo_error *error)
{
  size_t size = (size_t)region->group->record;
  enum eo_code code = region->waiting + size > BUFFER ? flush(sorter, region, error) : EO_OK;
  if (!code && size > BUFFER) {
    code = eo_bytes_write(sorter->mdf->spool, region->at, sorter->record, size, error);
    region->at += (int64_t)size;
  } else if (!code) {
    memcpy(region->buffer + region->waiting, sorter->record, size);
    region->waiting += size;
  }
  return code;
}

static int compare_regions(const void *a, const void *b)
{
  uint64_t one = ((const struct region *)a)->group->number, other = ((const struct region *)b)->group->number;
  return (one > other) - (one < other);
}

static int compare_number(const void *number, const void *region)
{
  uint64_t one = *(const uint64_t *)number, other = ((const struct region *)region)->group->number;
  return (one > other) - (one < other);
}

/* The kind of the next record; NULL at the end. */
static enum eo_code next_kind(struct sorter *sorter, struct region **region, struct eo_error *error)
{
  unsigned char bytes[8] = {0};
  size_t got;
  *region = NULL;
  if (!sorter->number) {
    *region = sorter->region;
    return EO_OK;
  }
  enum eo_code code = take(&sorter->stream, bytes, (size_t)sorter->number, &got, error);
  uint64_t number = eo_bytes_64(bytes, false);
  if (!code && got == (size_t)sorter->number)
    *region = bsearch(&number, sorter->region, (size_t)sorter->count, sizeof **region, compare_number);
  if (!code && got == (size_t)sorter->number && !*region)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: a record has the number %llu, which no group has: the data are damaged.",
                        (unsigned long long)number);
  return code;
}

/* Goes through all records; place: puts them into their regions, else only counts them. A last one that is cut off is
   left out. */
static enum eo_code pass(struct sorter *sorter, bool place, struct eo_error *error)
{
  for (;;) {
    struct region *region;
    size_t got;
    unsigned char length[4] = {0};
    enum eo_code code = next_kind(sorter, &region, error);
    if (code || !region)
      return code;
    size_t size = (size_t)region->group->record;
    if (region->group->variable) {
      code = take(&sorter->stream, length, sizeof length, &got, error);
      size = eo_bytes_32(length, false);
    }
    if (!code)
      code = take(&sorter->stream, region->group->variable || !place ? NULL : sorter->record, size, &got, error);
    if (code || got < size || (!size && !sorter->number))
      return code;
    region->rows++;
    if (place && !region->group->variable)
      code = put_record(sorter, region, error);
    if (code)
      return code;
  }
}

static enum eo_code set_piece(struct eo_mdf_group *group, int file, int64_t at, struct eo_error *error)
{
  group->piece = calloc(1, sizeof *group->piece);
  if (!group->piece)
    return eo_error_memory(error);
  *group->piece = (struct eo_mdf_piece){file, at, 0, group->rows * group->record};
  group->pieces = 1;
  group->skip = 0;
  return EO_OK;
}

/* Between the passes: each kind gets a region that holds exactly its records. */
static enum eo_code make_regions(struct sorter *sorter, struct eo_error *error)
{
  enum eo_code code = sorter->mdf->spool < 0 ? eo_bytes_spool(sorter->mdf->spool_directory, &sorter->mdf->spool, error)
                                             : EO_OK;
  for (int i = 0; !code && i < sorter->count; i++) {
    struct region *region = &sorter->region[i];
    region->at = sorter->mdf->spooled;
    region->group->rows = region->rows;
    if (region->group->variable)
      continue;
    code = set_piece(region->group, sorter->mdf->spool, region->at, error);
    sorter->mdf->spooled += region->rows * region->group->record;
  }
  return code;
}

static enum eo_code sort(struct sorter *sorter, const struct blocks *blocks, struct eo_error *error)
{
  enum eo_code code = pass(sorter, false, error);
  if (!code)
    code = make_regions(sorter, error);
  sorter->stream.next = sorter->stream.in_next = 0;
  sorter->stream.at = sorter->stream.filled = 0;
  sorter->stream.blocks = blocks;
  if (!code)
    code = pass(sorter, true, error);
  for (int i = 0; !code && i < sorter->count; i++)
    code = flush(sorter, &sorter->region[i], error);
  return code;
}

static enum eo_code sort_records(struct eo_mdf *mdf, const struct blocks *blocks, int number, int first, int count,
                                 struct eo_error *error)
{
  if (count > MIXED)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: %d kinds of records are mixed, more than %d.", count, MIXED);
  struct sorter sorter = {.mdf = mdf, .stream = {.mdf = mdf, .blocks = blocks}, .number = number, .count = count};
  sorter.region = calloc((size_t)count, sizeof *sorter.region);
  sorter.record = malloc(EO_MDF_RECORD);
  enum eo_code code = sorter.region && sorter.record ? EO_OK : eo_error_memory(error);
  for (int i = 0; !code && i < count; i++)
    sorter.region[i].group = &mdf->group[first + i];
  if (!code)
    qsort(sorter.region, (size_t)count, sizeof *sorter.region, compare_regions);
  if (!code)
    code = sort(&sorter, blocks, error);
  free(sorter.region);
  free(sorter.record);
  free(sorter.stream.bytes);
  free(sorter.stream.packed);
  return code;
}

/* Records of one kind that follow each other as they are stay where they are. */
static enum eo_code keep_records(struct eo_mdf *mdf, const struct blocks *blocks, struct eo_mdf_group *group,
                                 int number, struct eo_error *error)
{
  int64_t stride = number + group->record, first = 0;
  group->rows = stride ? blocks->length / stride : 0;
  group->skip = number;
  group->piece = calloc((size_t)blocks->count + 1, sizeof *group->piece);
  if (!group->piece)
    return eo_error_memory(error);
  for (int64_t i = 0; i < blocks->count; i++) {
    const struct block *block = &blocks->block[i];
    if (!block->length)
      continue;
    group->piece[group->pieces++] = (struct eo_mdf_piece){mdf->file, block->at, first, block->length};
    first += block->length;
  }
  return EO_OK;
}

/* Compressed data must not be far larger than the file. */
static enum eo_code check_growth(const struct eo_mdf *mdf, const struct blocks *blocks, struct eo_error *error)
{
  int64_t bytes = mdf->spooled + blocks->length;
  if (bytes > mdf->limit || (bytes > EO_SOURCE_FREE && bytes / EO_SOURCE_EXPANSION > mdf->size))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the data are %lld bytes, more than is read at most or than a file of %lld bytes holds.",
                        (long long)bytes, (long long)mdf->size);
  return EO_OK;
}

/* What is there counts; the number of records that the groups state may be larger where the file was cut off, and is 0
   where it was not closed. */
static void compare_counts(struct eo_mdf *mdf, int first, int count)
{
  for (int i = first; i < first + count; i++) {
    struct eo_mdf_group *group = &mdf->group[i];
    mdf->cut = mdf->cut || (!group->variable && group->stated > group->rows);
    if (!mdf->unfinished && group->stated < group->rows)
      group->rows = group->stated;
  }
}

static enum eo_code find_records(struct eo_mdf *mdf, int64_t at, int number, int first, int count,
                                 struct blocks *blocks, struct eo_error *error)
{
  if (at && count)
    EO_TRY(add_blocks(mdf, at, 0, blocks, error));
  EO_TRY(check_growth(mdf, blocks, error));
  if (blocks->apart)
    mdf->group[first].record = mdf->group[first].data;
  bool plain = count == 1 && !mdf->group[first].variable;
  for (int64_t i = 0; i < blocks->count; i++)
    plain = plain && blocks->block[i].packing == PLAIN;
  if (count > 1 && !number)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: records of %d kinds are mixed without a number.", count);
  if (!blocks->length)
    return EO_OK;
  return plain ? keep_records(mdf, blocks, &mdf->group[first], number, error)
               : sort_records(mdf, blocks, number, first, count, error);
}

enum eo_code eo_mdf_find_records(struct eo_mdf *mdf, int64_t at, int number, int first, int count,
                                 struct eo_error *error)
{
  struct blocks blocks = {0};
  enum eo_code code = find_records(mdf, at, number, first, count, &blocks, error);
  free(blocks.block);
  if (!code)
    compare_counts(mdf, first, count);
  return code;
}

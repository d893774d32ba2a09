/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The segments of a TDMS file: lead-ins, layouts of chunks, where each begins. */
#include "recording/bytes.h"
#include "recording/tdms.h"

#include <stdlib.h>

#define LEAD_IN 28
#define METADATA ((int64_t)64 << 20)    /* bytes of one segment's metadata at most */
#define SEGMENTS ((int64_t)1 << 22)     /* with data, at most */
#define LAYOUT_PARTS ((int64_t)1 << 22) /* in all layouts, at most */

enum { TOC_METADATA = 2, TOC_NEW_LIST = 4, TOC_DATA = 8, TOC_INTERLEAVED = 32, TOC_BIG = 64, TOC_DAQMX = 128 };

struct lead_in {
  uint32_t toc;
  int64_t data, next; /* bytes of the file: where raw data begin and where the segment ends */
};

static enum eo_code damaged(int64_t at, const char *what, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, "", "TDMS: the segment at byte %lld %s.", (long long)at, what);
}

/* A segment that was being written when the power went has no length: it reaches to the end of the file. */
static enum eo_code read_lead_in(struct eo_tdms *tdms, int64_t at, struct lead_in *lead, struct eo_error *error)
{
  unsigned char bytes[LEAD_IN];
  enum eo_code code = eo_bytes_read(tdms->file, at, bytes, LEAD_IN, error);
  if (code)
    return code;
  if (memcmp(bytes, "TDSm", 4))
    return damaged(at, "does not begin with \"TDSm\"", error);
  lead->toc = eo_bytes_32(bytes + 4, false);
  bool big = lead->toc & TOC_BIG;
  uint32_t version = eo_bytes_32(bytes + 8, big);
  if (version != 4712 && version != 4713)
    return damaged(at, "is of an unknown version, neither 4712 nor 4713", error);
  uint64_t next = eo_bytes_64(bytes + 12, big), data = eo_bytes_64(bytes + 20, big);
  uint64_t left = (uint64_t)(tdms->size - at - LEAD_IN);
  tdms->cut = next == UINT64_MAX || next > left;
  if (tdms->cut)
    next = left;
  if (data == UINT64_MAX && tdms->cut)
    data = left;
  if (data > next)
    return damaged(at, tdms->cut ? "is cut off in its metadata" : "has its data behind its end", error);
  lead->data = at + LEAD_IN + (int64_t)data;
  lead->next = at + LEAD_IN + (int64_t)next;
  return EO_OK;
}

static enum eo_code read_metadata(struct eo_tdms *tdms, int64_t at, const struct lead_in *lead, struct eo_error *error)
{
  int64_t size = lead->data - at - LEAD_IN;
  if (!(lead->toc & TOC_METADATA))
    return EO_OK;
  if (size > METADATA)
    return damaged(at, "has more than 64 MB of metadata", error);
  unsigned char *bytes = malloc(size ? (size_t)size : 1);
  if (!bytes)
    return eo_error_memory(error);
  enum eo_code code = eo_bytes_read(tdms->file, at + LEAD_IN, bytes, (size_t)size, error);
  if (!code)
    code = eo_tdms_read_objects(tdms, bytes, (size_t)size, at + LEAD_IN, lead->toc & TOC_BIG, lead->toc & TOC_NEW_LIST,
                                error);
  free(bytes);
  return code;
}

static bool is_current(const struct eo_tdms *tdms, const struct eo_tdms_layout *layout)
{
  int n = 0;
  for (int i = 0; i < tdms->listed; i++) {
    if (!tdms->list[i].data)
      continue;
    const struct eo_tdms_part *part = &tdms->channel[tdms->list[i].channel].index;
    if (n >= layout->parts || layout->part[n].channel != part->channel || layout->part[n].type != part->type ||
        layout->part[n].count != part->count || layout->part[n].size != part->size ||
        layout->part[n].width != part->width || layout->part[n].offset != part->offset)
      return false;
    n++;
  }
  return n == layout->parts;
}

/* The layout of the objects as they are listed now; the last one when nothing has changed. NULL: error. */
static const struct eo_tdms_layout *current_layout(struct eo_tdms *tdms, int64_t at, struct eo_error *error)
{
  if (tdms->layouts && is_current(tdms, tdms->layout[tdms->layouts - 1]))
    return tdms->layout[tdms->layouts - 1];
  tdms->layout_parts += tdms->listed;
  if (tdms->layout_parts > LAYOUT_PARTS || tdms->layouts >= LAYOUT_PARTS / 4) {
    damaged(at, "changes the channels once more; too many changes", error);
    return NULL;
  }
  if (tdms->layouts == tdms->layout_room) {
    int room = tdms->layout_room ? 2 * tdms->layout_room : 16;
    struct eo_tdms_layout **list = realloc(tdms->layout, (size_t)room * sizeof(struct eo_tdms_layout *));
    if (!list) {
      eo_error_memory(error);
      return NULL;
    }
    tdms->layout = list;
    tdms->layout_room = room;
  }
  struct eo_tdms_layout *layout = calloc(1, sizeof *layout + (size_t)tdms->listed * sizeof *layout->part);
  if (!layout) {
    eo_error_memory(error);
    return NULL;
  }
  int64_t row = 0;
  for (int i = 0; i < tdms->listed; i++)
    if (tdms->list[i].data) {
      struct eo_tdms_part *part = &layout->part[layout->parts++];
      *part = tdms->channel[tdms->list[i].channel].index;
      part->before = layout->chunk;
      part->row = row;
      row += eo_tdms_type_size(part->type);
      if (part->width) /* all channels share the rows */
        layout->chunk = part->size > layout->chunk ? part->size : layout->chunk;
      else
        layout->chunk += part->size; /* sizes are below 2^58: no sum of them overflows after the check below */
      if (layout->chunk > (tdms->cut ? INT64_MAX >> 3 : tdms->size)) {
        free(layout);
        damaged(at, "states more data than the file holds", error);
        return NULL;
      }
    }
  return tdms->layout[tdms->layouts++] = layout;
}

/* Interleaved channels share their rows: all of one length and of types with a size. */
static bool may_interleave(const struct eo_tdms_layout *layout)
{
  for (int i = 0; i < layout->parts; i++)
    if (layout->part[i].count != layout->part[0].count || layout->part[i].type == EO_TDMS_STRING ||
        layout->part[i].width)
      return false;
  return true;
}

static enum eo_code add_segment(struct eo_tdms *tdms, int64_t at, const struct lead_in *lead, struct eo_error *error)
{
  const struct eo_tdms_layout *layout = current_layout(tdms, at, error);
  if (!layout)
    return error->code;
  if (!layout->chunk)
    return EO_OK;
  if (tdms->segments == tdms->segment_room) {
    int64_t room = tdms->segment_room ? 2 * tdms->segment_room : 64;
    struct eo_tdms_segment *segment = room <= SEGMENTS ? realloc(tdms->segment, (size_t)room * sizeof *segment) : NULL;
    if (!segment)
      return room > SEGMENTS ? damaged(at, "is one of more than 4 million", error) : eo_error_memory(error);
    tdms->segment = segment;
    tdms->segment_room = room;
  }
  struct eo_tdms_segment tdms_segment = {
      .layout = layout, .at = lead->data, .interleaved = lead->toc & TOC_INTERLEAVED, .big = lead->toc & TOC_BIG};
  tdms_segment.interleaved = tdms_segment.interleaved && !(lead->toc & TOC_DAQMX);
  for (int i = 0; (lead->toc & TOC_DAQMX) && i < layout->parts; i++)
    if (!layout->part[i].width)
      return damaged(at, "holds raw DAQmx data without saying where; save the channels converted (as double)", error);
  if (tdms_segment.interleaved && !may_interleave(layout))
    return damaged(at, "interleaves channels of different lengths", error);
  int64_t bytes = lead->next - lead->data;
  tdms_segment.chunks = bytes / layout->chunk;
  tdms_segment.rest = bytes % layout->chunk;
  tdms->cut = tdms->cut || tdms_segment.rest;
  for (int i = 0; i < layout->parts; i++)
    if (layout->part[i].type != EO_TDMS_STRING)
      tdms->series[layout->part[i].channel].length += eo_tdms_place(&tdms_segment, &layout->part[i]).values;
  tdms->segment[tdms->segments++] = tdms_segment;
  return EO_OK;
}

enum eo_code eo_tdms_scan(struct eo_tdms *tdms, struct eo_error *error)
{
  struct eo_error own = {0};
  error = error ? error : &own;
  bool cut = false;
  for (int64_t at = 0; at + LEAD_IN <= tdms->size;) {
    struct lead_in lead = {0};
    enum eo_code code = read_lead_in(tdms, at, &lead, error);
    if (!code)
      code = read_metadata(tdms, at, &lead, error);
    if (!code && (lead.toc & TOC_DATA) && lead.next > lead.data)
      code = add_segment(tdms, at, &lead, error);
    if (code)
      return code;
    cut = cut || tdms->cut;
    at = lead.next;
  }
  tdms->cut = cut;
  return EO_OK;
}

void eo_tdms_done(struct eo_tdms *tdms)
{
  for (int i = 0; i < tdms->channels; i++) {
    free(tdms->channel[i].path);
    free(tdms->channel[i].scale);
  }
  for (int i = 0; i < tdms->groups; i++)
    free(tdms->group[i].path);
  for (int i = 0; i < tdms->layouts; i++)
    free(tdms->layout[i]);
  free(tdms->layout);
  free(tdms->segment);
}

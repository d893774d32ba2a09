/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of MDF files: "##", two letters, 4 bytes, length, number of links, the links, then data. */
#define _GNU_SOURCE /* memmem */
#include "recording/mdf.h"
#include "base/decimal.h"

#include <stdio.h>
#include <stdlib.h>

enum { HEAD = 24, TEXT = 1 << 16 };

enum eo_code eo_mdf_open(struct eo_mdf *mdf, int64_t at, const char *id, struct eo_mdf_block *block,
                         struct eo_error *error)
{
  unsigned char head[HEAD], link[8 * EO_MDF_LINKS];
  if (at <= 0 || at > mdf->size - HEAD)
    return eo_error_set(error, EO_ERROR_INPUT, "", "MDF: a link leads to byte %lld of %lld: the file is cut off.",
                        (long long)at, (long long)mdf->size);
  if (++mdf->visited > EO_MDF_BLOCKS)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the file has more than %d blocks, or its lists lead in a circle.", EO_MDF_BLOCKS);
  enum eo_code code = eo_bytes_read(mdf->file, at, head, sizeof head, error);
  if (code)
    return code;
  uint64_t length = eo_bytes_64(head + 8, false), links = eo_bytes_64(head + 16, false);
  *block = (struct eo_mdf_block){.at = at, .id = {(char)head[2], (char)head[3]}};
  if (memcmp(head, "##", 2) != 0 || (id && strcmp(id, block->id) != 0))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: at byte %lld there is no block of kind %s; the file is damaged.", (long long)at,
                        id ? id : "##");
  bool open_end = mdf->unfinished && !strcmp(block->id, "DT") && length <= HEAD; /* its length was not yet known */
  if (open_end)
    length = (uint64_t)(mdf->size - at);
  if (length < HEAD || length > (uint64_t)(mdf->size - at) || links > (length - HEAD) / 8)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "MDF: the block %s at byte %lld states %llu bytes and %llu links: the file is cut off or "
                        "damaged.",
                        id ? id : block->id, (long long)at, (unsigned long long)length, (unsigned long long)links);
  block->links = (int64_t)links;
  block->data_at = at + HEAD + 8 * block->links;
  block->size = (int64_t)length - HEAD - 8 * block->links;
  int64_t kept = block->links < EO_MDF_LINKS ? block->links : EO_MDF_LINKS;
  code = eo_bytes_read(mdf->file, at + HEAD, link, 8 * (size_t)kept, error);
  for (int64_t i = 0; !code && i < kept; i++)
    block->link[i] = (int64_t)eo_bytes_64(link + 8 * i, false);
  return code ? code
              : eo_bytes_read(mdf->file, block->data_at, block->data,
                              (size_t)(block->size < EO_MDF_DATA ? block->size : EO_MDF_DATA), error);
}

/* The text of a block, whatever is in it; NULL when there is none. The caller frees it. */
static char *read_text(struct eo_mdf *mdf, int64_t at, bool *xml)
{
  struct eo_mdf_block block;
  struct eo_error error;
  if (!at || eo_mdf_open(mdf, at, NULL, &block, &error))
    return NULL;
  *xml = !strcmp(block.id, "MD");
  if (!*xml && strcmp(block.id, "TX") != 0)
    return NULL;
  size_t size = (size_t)(block.size < TEXT ? block.size : TEXT);
  char *text = calloc(1, size + 1);
  if (text && !eo_bytes_read(mdf->file, block.data_at, text, size, &error))
    return text;
  free(text);
  return NULL;
}

/* Copies text up to its end or the mark, with the five entities of XML as what they stand for. */
static void copy_text(const char *from, const char *end, char *text, size_t size)
{
  static const struct {
    const char *entity;
    char stands_for;
  } entities[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  size_t n = 0;
  while (*from && from != end && n + 1 < size) {
    size_t i = 0, count = sizeof entities / sizeof *entities;
    while (i < count && strncmp(from, entities[i].entity, strlen(entities[i].entity)) != 0)
      i++;
    text[n++] = i < count ? entities[i].stands_for : *from;
    from += i < count ? strlen(entities[i].entity) : 1;
  }
  text[n] = '\0';
}

void eo_mdf_text(struct eo_mdf *mdf, int64_t at, char *text, size_t size)
{
  bool xml = false;
  char *all = read_text(mdf, at, &xml);
  *text = '\0';
  if (all && xml) {
    const char *begin = strstr(all, "<TX>"), *end = begin ? strstr(begin, "</TX>") : NULL;
    if (end)
      copy_text(begin + strlen("<TX>"), end, text, size);
  } else if (all)
    snprintf(text, size, "%s", all);
  free(all);
}

/* The value of an attribute of the element that begins at `element` and ends at `end`; "" when it has none. */
static void read_attribute(const char *element, const char *end, const char *name, char *value, size_t size)
{
  const char *at = memmem(element, (size_t)(end - element), name, strlen(name));
  *value = '\0';
  if (!at)
    return;
  at += strlen(name);
  const char *last = memchr(at, '"', (size_t)(end - at));
  if (last)
    copy_text(at, last, value, size);
}

/* Properties are elements <e name="KEY" unit="UNIT">NUMBER</e>. */
void eo_mdf_facts(struct eo_mdf *mdf, int64_t at, struct eo_series *series)
{
  bool xml = false;
  char *all = read_text(mdf, at, &xml), key[128], unit[32], told[192];
  const struct eo_clock outer = series->clock;
  series->clock.interval = series->clock.other =
      0; /* this text is nearer; only what it says twice contradicts itself */
  const char *content = NULL;
  for (const char *e = all && xml ? strstr(all, "<e ") : NULL; e; e = strstr(content, "<e ")) {
    content = strchr(e, '>');
    if (!content)
      break;
    double number;
    const char *after = eo_decimal_read(content + 1, '.', &number);
    read_attribute(e, content, "name=\"", key, sizeof key);
    copy_text(content + 1, strchr(content, '<'), told, sizeof told);
    struct eo_stated ratio = eo_stated_read_ratio(key, told);
    eo_series_state(series, &ratio);
    read_attribute(e, content, "unit=\"", unit, sizeof unit);
    if (after && !*unit)
      copy_text(after, strchr(after, '<'), unit, sizeof unit);
    if (after) {
      struct eo_stated stated = eo_stated_read(key, number, unit);
      eo_series_state(series, &stated);
    }
  }
  if (!(series->clock.interval > 0))
    series->clock.interval = outer.interval, series->clock.other = outer.other;
  free(all);
}

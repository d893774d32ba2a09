/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/resource.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "base/hash.h"

bool eo_pack(const char *data, size_t size, int level, struct eo_text *packed)
{
  enum { GZIP = 15 + 16 };
  z_stream stream = {0};
  if (size > UINT_MAX / 2 || deflateInit2(&stream, level, Z_DEFLATED, GZIP, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    return false;
  size_t room = deflateBound(&stream, size);
  char *out = malloc(room);
  stream.next_in = (Bytef *)data;
  stream.avail_in = (uInt)size;
  stream.next_out = (Bytef *)out;
  stream.avail_out = (uInt)room;
  bool packs = out && deflate(&stream, Z_FINISH) == Z_STREAM_END && stream.total_out < size;
  deflateEnd(&stream);
  if (packs)
    *packed = (struct eo_text){.data = out, .size = stream.total_out, .capacity = room};
  else
    free(out);
  return packs;
}

enum eo_code eo_resource_init(struct eo_resource *resource, const char *type, struct eo_text *text,
                              struct eo_error *error)
{
  char key[EO_HASH_LENGTH + 1];
  if (text->failed)
    return eo_error_memory(error);
  *resource = (struct eo_resource){.type = type, .plain = *text};
  *text = (struct eo_text){0};
  eo_hash_hex(resource->plain.data ? resource->plain.data : "", resource->plain.size, key);
  snprintf(resource->tag, sizeof resource->tag, "%.32s", key);
  if (resource->plain.size > 1024)
    eo_pack(resource->plain.data, resource->plain.size, 9, &resource->packed);
  return EO_OK;
}

void eo_resource_done(struct eo_resource *resource)
{
  eo_text_done(&resource->plain);
  eo_text_done(&resource->packed);
}

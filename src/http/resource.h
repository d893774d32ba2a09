/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Something that is served as it was made when the server started: bytes, and the same bytes compressed. */
#ifndef EASEOFF_HTTP_RESOURCE_H
#define EASEOFF_HTTP_RESOURCE_H

#include <stdbool.h>

#include "format/text.h"

struct eo_resource {
  const char *type;             /* literal */
  struct eo_text plain, packed; /* owned; packed is empty where it gains nothing */
  char tag[40];                 /* of the bytes */
  bool lasting;                 /* the name changes with the bytes: the client need never ask again */
};

/* Takes the text over. Errors: memory. */
enum eo_code eo_resource_init(struct eo_resource *resource, const char *type, struct eo_text *text,
                              struct eo_error *error);
void eo_resource_done(struct eo_resource *resource);

/* gzip (RFC 1952) at zlib's level; false: no memory, or it gains nothing. */
bool eo_pack(const char *data, size_t size, int level, struct eo_text *packed);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page of a list, as it is answered. */
#ifndef EASEOFF_FORMAT_LIST_PAGE_H
#define EASEOFF_FORMAT_LIST_PAGE_H

#include "format/outline.h"

struct eo_page {
  json_t *items;
  char next[24]; /* "" behind the last page */
};
/* The rows of its outline; what else there is of the items, as .outline = ... */
#define EO_PAGE_ROWS(help_, ...)                                                 \
  EO_KEY("items", "[object]", help_, __VA_ARGS__, EO_AT(struct eo_page, items)), \
      EO_KEY("next", "text?", "cursor of the next page", EO_AT(struct eo_page, next))

/* New; NULL without memory. items: taken over. last: number of the last of them, where there are more. */
json_t *eo_page_encode(const struct eo_outline *outline, json_t *items, bool more, int64_t last);

#endif

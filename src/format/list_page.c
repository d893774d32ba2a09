/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/list_page.h"

#include <stdio.h>

json_t *eo_page_encode(const struct eo_outline *outline, json_t *items, bool more, int64_t last)
{
  struct eo_page page = {.items = items};
  if (more)
    snprintf(page.next, sizeof page.next, "%lld", (long long)last);
  return eo_outline_encode(outline, &page);
}

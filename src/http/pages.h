/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page's files: read into memory when the server starts, served from this list and nothing else. */
#ifndef EASEOFF_HTTP_PAGES_H
#define EASEOFF_HTTP_PAGES_H

#include "http/request.h"

struct eo_pages;

/* Every regular file below the folder (links are not followed). folder NULL: an empty list. Errors: EO_ERROR_FILE,
   memory. */
enum eo_code eo_pages_new(struct eo_pages **pages, const char *folder, struct eo_error *error);
void eo_pages_free(struct eo_pages *pages);

/* A path that ends in a slash is that folder's index.html; a folder's name without the slash leads there. */
void eo_pages_reply(const struct eo_pages *pages, struct eo_request *request);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/pages.h"

#include <ctype.h>
#include <errno.h>
#include <fts.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "http/resource.h"

enum { MOST_FILES = 2000, MOST_BYTES = 64 << 20, MOST_OF_ONE = 16 << 20, LONGEST_PATH = 120 };

struct page {
  char *path; /* "/index.html", owned */
  struct eo_resource resource;
};

struct eo_pages {
  int count, capacity;
  size_t bytes;
  struct page *page; /* sorted by path */
};

static const char *type_of(const char *path)
{
  static const struct {
    const char *ending, *type;
  } types[] = {{".html", "text/html; charset=utf-8"},
               {".js", "text/javascript; charset=utf-8"},
               {".mjs", "text/javascript; charset=utf-8"},
               {".css", "text/css; charset=utf-8"},
               {".json", "application/json"},
               {".svg", "image/svg+xml"},
               {".png", "image/png"},
               {".ico", "image/x-icon"},
               {".woff2", "font/woff2"},
               {".txt", "text/plain; charset=utf-8"},
               {".map", "application/json"},
               {".webmanifest", "application/manifest+json"}};
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot && i < sizeof types / sizeof types[0]; i++)
    if (strcmp(dot, types[i].ending) == 0)
      return types[i].type;
  return "application/octet-stream";
}

/* "app-5KQ2WXYZ.js": eight or more capital letters and digits before the ending, as the bundler writes them. */
static bool has_hash(const char *path)
{
  const char *dash = strrchr(path, '-');
  size_t length = 0;
  while (dash && (isupper((unsigned char)dash[1 + length]) || isdigit((unsigned char)dash[1 + length])))
    length++;
  return length >= 8 && dash[1 + length] == '.';
}

static enum eo_code reserve(struct eo_pages *pages, struct eo_error *error)
{
  if (pages->count < pages->capacity)
    return EO_OK;
  if (pages->count == MOST_FILES)
    return eo_error_set(error, EO_ERROR_FILE, "", "The page's folder holds more than %d files.", MOST_FILES);
  int capacity = pages->capacity ? 2 * pages->capacity : 32;
  struct page *page = realloc(pages->page, sizeof *page * (size_t)capacity);
  if (!page)
    return eo_error_memory(error);
  pages->page = page;
  pages->capacity = capacity;
  return EO_OK;
}

static enum eo_code fill(struct eo_pages *pages, struct page *page, const char *file, struct eo_text *text,
                         struct eo_error *error)
{
  if (!page->path)
    return eo_error_memory(error);
  EO_TRY(reserve(pages, error));
  EO_TRY(eo_text_read(text, file, MOST_OF_ONE, error));
  pages->bytes += text->size;
  if (pages->bytes > MOST_BYTES)
    return eo_error_set(error, EO_ERROR_FILE, "", "The page's folder holds more than %d MiB.", MOST_BYTES >> 20);
  return eo_resource_init(&page->resource, type_of(page->path), text, error);
}

static enum eo_code add(struct eo_pages *pages, const char *file, const char *path, struct eo_error *error)
{
  struct eo_text text = {0};
  struct page page = {.path = strdup(path)};
  enum eo_code code = fill(pages, &page, file, &text, error);
  eo_text_done(&text);
  if (code) {
    free(page.path);
    return code;
  }
  page.resource.lasting = has_hash(path);
  pages->page[pages->count++] = page;
  return EO_OK;
}

static int compare(const void *a, const void *b)
{
  return strcmp(((const struct page *)a)->path, ((const struct page *)b)->path);
}

static enum eo_code collect(struct eo_pages *pages, const char *folder, struct eo_error *error)
{
  char *const roots[] = {(char *)folder, NULL};
  FTS *tree = fts_open(roots, FTS_PHYSICAL | FTS_NOCHDIR, NULL);
  enum eo_code code = EO_OK;
  FTSENT *entry;
  if (!tree)
    return eo_error_set(error, EO_ERROR_FILE, "", "The page's folder cannot be read: %s.", strerror(errno));
  while (!code && (entry = fts_read(tree)))
    if (entry->fts_info == FTS_F && entry->fts_name[0] != '.')
      code = add(pages, entry->fts_accpath, entry->fts_path + strlen(folder), error);
    else if (entry->fts_info == FTS_D && entry->fts_level > 0 &&
             (entry->fts_name[0] == '.' || strcmp(entry->fts_name, "node_modules") == 0))
      fts_set(tree, entry, FTS_SKIP);
    else if ((entry->fts_info == FTS_NS || entry->fts_info == FTS_DNR) && entry->fts_level == 0)
      code = eo_error_set(error, EO_ERROR_FILE, "", "The page's folder cannot be read: %s.",
                          strerror(entry->fts_errno));
  fts_close(tree);
  if (pages->count)
    qsort(pages->page, (size_t)pages->count, sizeof *pages->page, compare);
  return code;
}

enum eo_code eo_pages_new(struct eo_pages **pages, const char *folder, struct eo_error *error)
{
  struct eo_pages *made = calloc(1, sizeof *made);
  if (!made)
    return eo_error_memory(error);
  enum eo_code code = folder ? collect(made, folder, error) : EO_OK;
  if (code)
    eo_pages_free(made);
  else
    *pages = made;
  return code;
}

void eo_pages_free(struct eo_pages *pages)
{
  for (int i = 0; pages && i < pages->count; i++) {
    free(pages->page[i].path);
    eo_resource_done(&pages->page[i].resource);
  }
  if (pages)
    free(pages->page);
  free(pages);
}

static const struct page *find(const struct eo_pages *pages, const char *path)
{
  const struct page wanted = {.path = (char *)path};
  return pages->count ? bsearch(&wanted, pages->page, (size_t)pages->count, sizeof wanted, compare) : NULL;
}

/* The file at a path, or what a folder shows: its index.html, when the path has the slash behind it. */
static const struct page *shown_at(const struct eo_pages *pages, const char *path)
{
  char below[LONGEST_PATH + sizeof "index.html"];
  size_t length = strlen(path);
  if (length == 0 || length > LONGEST_PATH || path[length - 1] != '/')
    return find(pages, path);
  snprintf(below, sizeof below, "%.*sindex.html", LONGEST_PATH, path);
  return find(pages, below);
}

/* A folder without its slash: the links of its page are relative, so the browser has to know where it is. */
static bool is_folder(const struct eo_pages *pages, const char *path, char slashed[LONGEST_PATH + 2])
{
  size_t length = strlen(path);
  if (length == 0 || length > LONGEST_PATH || path[length - 1] == '/')
    return false;
  snprintf(slashed, LONGEST_PATH + 2, "%.*s/", LONGEST_PATH, path);
  return shown_at(pages, slashed);
}

void eo_pages_reply(const struct eo_pages *pages, struct eo_request *request)
{
  char slashed[LONGEST_PATH + 2];
  const struct page *page = shown_at(pages, request->path);
  if (request->method == EO_OPTIONS) {
    eo_reply_empty(&request->reply, 204);
    request->reply.allow = EO_GET | EO_OPTIONS;
  } else if (page)
    eo_request_resource(request, &page->resource);
  else if (is_folder(pages, request->path, slashed)) {
    eo_reply_empty(&request->reply, 308);
    snprintf(request->reply.location, sizeof request->reply.location, "%s", slashed);
  } else if (!pages->count && strcmp(request->path, "/") == 0)
    eo_reply_problem(&request->reply, 404, NULL,
                     "This server was started without its page; the API is at /api/v1/openapi.json.");
  else
    eo_reply_problem(&request->reply, 404, NULL, "There is no page at this address.");
}

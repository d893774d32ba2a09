/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/data.h"

#include <stdlib.h>
#include <sys/stat.h>

static bool use(struct eo_text *path, const char *base, const char *below)
{
  if (!base || !*base)
    return false;
  eo_text_print(path, "%s%s", base, below);
  return true;
}

/* Makes every directory on the way; mkdir of the rest tells the caller of the cache what went wrong. */
static void make_parents(char *path)
{
  for (char *slash = path + 1; *slash; slash++)
    if (*slash == '/') {
      *slash = '\0';
      mkdir(path, 0777);
      *slash = '/';
    }
}

enum eo_code eo_app_data_directory(const char *option, struct eo_text *path, struct eo_error *error)
{
  *path = (struct eo_text){0};
  if (!use(path, option, "") && !use(path, getenv("EASEOFF_DATA"), "") &&
      !use(path, getenv("XDG_DATA_HOME"), "/easeoff") && !use(path, getenv("HOME"), "/.local/share/easeoff"))
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no place for the history; --data names one.");
  if (path->failed)
    return eo_error_memory(error);
  make_parents(path->data);
  return EO_OK;
}

bool eo_app_cache_directory(const char *option, struct eo_text *path)
{
  *path = (struct eo_text){0};
  bool found = use(path, option, "/flexibility") || use(path, getenv("EASEOFF_DATA"), "/flexibility") ||
               use(path, getenv("XDG_CACHE_HOME"), "/easeoff/flexibility") ||
               use(path, getenv("HOME"), "/.cache/easeoff/flexibility");
  if (found && !path->failed)
    make_parents(path->data);
  return found && !path->failed;
}

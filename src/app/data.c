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

bool eo_app_cache_directory(const char *option, struct eo_text *path)
{
  *path = (struct eo_text){0};
  bool found = use(path, option, "/flexibility") || use(path, getenv("EASEOFF_DATA"), "/flexibility") ||
               use(path, getenv("XDG_CACHE_HOME"), "/easeoff/flexibility") || use(path, getenv("HOME"), "/.cache/easeoff/flexibility");
  if (found && !path->failed)
    make_parents(path->data);
  return found && !path->failed;
}

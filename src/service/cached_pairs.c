/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/cached_pairs.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"

enum { PATH = 4096 };
static const char ending[] = ".flex";

struct pair {
  char key[EO_HASH_LENGTH + 1];
  int64_t size;
  struct timespec used;
};

static bool name_file(const char *folder, const char *key, char path[PATH])
{
  int length = snprintf(path, PATH, "%s/%s%s", folder, key, ending);
  return length > 0 && length < PATH;
}

static int is_pair(const struct dirent *entry)
{
  return strspn(entry->d_name, "0123456789abcdef") == EO_HASH_LENGTH &&
         strcmp(entry->d_name + EO_HASH_LENGTH, ending) == 0;
}

/* The pairs of a folder, [*count], to be freed; NULL: none, or no memory. */
static struct pair *list(const char *folder, int *count)
{
  struct dirent **names;
  char path[PATH];
  struct stat status;
  int entries = folder ? scandir(folder, &names, is_pair, NULL) : -1;
  struct pair *pair = entries > 0 ? calloc((size_t)entries, sizeof *pair) : NULL;
  *count = 0;
  for (int i = 0; i < entries; i++) {
    char key[EO_HASH_LENGTH + 1];
    snprintf(key, sizeof key, "%.*s", EO_HASH_LENGTH, names[i]->d_name);
    if (pair && name_file(folder, key, path) && stat(path, &status) == 0) {
      struct pair *row = &pair[(*count)++];
      memcpy(row->key, key, sizeof row->key);
      row->size = status.st_size;
      row->used = status.st_mtim;
    }
    free(names[i]);
  }
  if (entries >= 0)
    free(names);
  return pair;
}

static int compare_use(const void *left, const void *right)
{
  const struct timespec *a = &((const struct pair *)left)->used, *b = &((const struct pair *)right)->used;
  if (a->tv_sec != b->tv_sec)
    return a->tv_sec < b->tv_sec ? -1 : 1;
  return (a->tv_nsec > b->tv_nsec) - (a->tv_nsec < b->tv_nsec);
}

void eo_cached_pairs_use(const char *folder, const char *key, double most)
{
  char path[PATH];
  int count;
  double sum = 0;
  if (!folder)
    return;
  if (name_file(folder, key, path))
    utimensat(AT_FDCWD, path, NULL, 0); /* one that cannot be marked goes a little earlier */
  struct pair *pair = list(folder, &count);
  if (!pair)
    return;
  qsort(pair, (size_t)count, sizeof *pair, compare_use);
  for (int i = 0; i < count; i++)
    sum += (double)pair[i].size;
  for (int i = 0; i < count && sum > most; i++)
    if (strcmp(pair[i].key, key) != 0 && name_file(folder, pair[i].key, path) && unlink(path) == 0)
      sum -= (double)pair[i].size;
  free(pair);
}

int64_t eo_cached_pairs_size(const char *folder)
{
  int count;
  int64_t sum = 0;
  struct pair *pair = list(folder, &count);
  for (int i = 0; i < count; i++)
    sum += pair[i].size;
  free(pair);
  return sum;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/cache.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Stands at the beginning of the file, in the byte order of the machine that wrote it. */
struct header {
  char magic[8];
  uint32_t format, order;
  uint64_t parts, bytes;
  char key[EO_HASH_LENGTH], checksum[EO_HASH_LENGTH];
};

static const char magic[8] = "EOFLEX\r\n";
enum { FORMAT = 1, ORDER = 0x01020304 };

__attribute__((format(printf, 2, 3))) static void note(struct eo_cache *cache, const char *format, ...)
{
  va_list arguments;
  if (cache->note[0])
    return;
  va_start(arguments, format);
  vsnprintf(cache->note, sizeof cache->note, format, arguments);
  va_end(arguments);
}

static char *join(const char *directory, const char *key, const char *ending)
{
  size_t size = strlen(directory) + strlen(key) + strlen(ending) + 2;
  char *path = malloc(size);
  if (path)
    snprintf(path, size, "%s/%s%s", directory, key, ending);
  return path;
}

/* Takes the lock of the file that stands at the path now: whoever held it before may have removed the file we opened.
 */
static int lock_file(const char *path)
{
  for (;;) {
    struct stat opened, standing;
    int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0)
      return -1;
    if (flock(file, LOCK_EX | LOCK_NB)) {
      int reason = errno;
      close(file);
      errno = reason;
      return -1;
    }
    if (!fstat(file, &opened) && !stat(path, &standing) && opened.st_ino == standing.st_ino &&
        opened.st_dev == standing.st_dev)
      return file;
    close(file);
  }
}

static enum eo_code wait_for_lock(struct eo_cache *cache, const struct eo_progress *progress, struct eo_error *error)
{
  while ((cache->lock = lock_file(cache->lock_path)) < 0 && (errno == EWOULDBLOCK || errno == EINTR)) {
    if (eo_progress_report(progress, "waiting for another process", 0))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The preparation of the flexibility was stopped.");
    nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
  }
  if (cache->lock < 0)
    note(cache, "The cache cannot be written: %s.", strerror(errno));
  return EO_OK;
}

enum eo_code eo_cache_open(struct eo_cache *cache, const char *directory, const char *key,
                           const struct eo_progress *progress, struct eo_error *error)
{
  *cache = (struct eo_cache){.lock = -1};
  snprintf(cache->key, sizeof cache->key, "%s", key);
  if (!directory)
    return EO_OK;
  cache->path = join(directory, key, ".flex");
  cache->part_path = join(directory, key, ".part");
  cache->lock_path = join(directory, key, ".lock");
  enum eo_code code = EO_OK;
  if (!cache->path || !cache->part_path || !cache->lock_path)
    code = eo_error_memory(error);
  if (!code && mkdir(directory, 0777) && errno != EEXIST)
    note(cache, "The cache directory cannot be made: %s.", strerror(errno));
  if (!code)
    code = wait_for_lock(cache, progress, error);
  if (code)
    eo_cache_close(cache);
  return code;
}

static struct header expected_header(const struct eo_cache *cache, const struct eo_cache_part *part, int parts)
{
  struct header header = {.format = FORMAT, .order = ORDER, .parts = (uint64_t)parts};
  struct eo_hash hash;
  char checksum[EO_HASH_LENGTH + 1];
  eo_hash_init(&hash);
  for (int i = 0; i < parts; i++) {
    header.bytes += part[i].count * sizeof(double);
    eo_hash_add(&hash, part[i].data, part[i].count * sizeof(double));
  }
  eo_hash_finish(&hash, checksum);
  memcpy(header.magic, magic, sizeof header.magic);
  memcpy(header.key, cache->key, sizeof header.key);
  memcpy(header.checksum, checksum, sizeof header.checksum);
  return header;
}

static bool read_all(FILE *file, struct header *header, struct eo_cache_part *part, int parts)
{
  if (fread(header, sizeof *header, 1, file) != 1)
    return false;
  for (int i = 0; i < parts; i++)
    if (fread(part[i].data, sizeof(double), part[i].count, file) != part[i].count)
      return false;
  return fgetc(file) == EOF;
}

bool eo_cache_read(struct eo_cache *cache, struct eo_cache_part *part, int parts)
{
  FILE *file = cache->path ? fopen(cache->path, "rbe") : NULL;
  struct header found, expected;
  if (!file)
    return false;
  bool good = read_all(file, &found, part, parts);
  fclose(file);
  if (good) {
    expected = expected_header(cache, part, parts);
    good = !memcmp(&found, &expected, sizeof found);
  }
  if (!good) {
    note(cache, "A damaged cache file was thrown away.");
    unlink(cache->path);
  }
  return good;
}

static bool write_all(int descriptor, const struct header *header, const struct eo_cache_part *part, int parts)
{
  FILE *file = fdopen(descriptor, "wb");
  if (!file) {
    close(descriptor);
    return false;
  }
  bool good = fwrite(header, sizeof *header, 1, file) == 1;
  for (int i = 0; i < parts && good; i++)
    good = fwrite(part[i].data, sizeof(double), part[i].count, file) == part[i].count;
  good = good && !fflush(file) && !fsync(descriptor);
  return !fclose(file) && good;
}

void eo_cache_write(struct eo_cache *cache, const struct eo_cache_part *part, int parts)
{
  if (cache->lock < 0)
    return;
  struct header header = expected_header(cache, part, parts);
  int descriptor = open(cache->part_path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor >= 0 && write_all(descriptor, &header, part, parts) && !rename(cache->part_path, cache->path))
    return;
  note(cache, "The cache file cannot be written: %s.", strerror(errno));
  if (descriptor >= 0)
    unlink(cache->part_path);
}

void eo_cache_close(struct eo_cache *cache)
{
  if (cache->lock >= 0) {
    unlink(cache->lock_path);
    close(cache->lock);
  }
  free(cache->path);
  free(cache->part_path);
  free(cache->lock_path);
  cache->path = cache->part_path = cache->lock_path = NULL;
  cache->lock = -1;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* mkostemp */
#include "recording/bytes.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum eo_code eo_bytes_open(const char *path, int *file, int64_t *size, struct eo_error *error)
{
  int opened = open(path, O_RDONLY | O_CLOEXEC);
  struct stat state;
  if (opened < 0 || fstat(opened, &state) || !S_ISREG(state.st_mode)) {
    int reason = opened < 0 ? errno : EINVAL;
    if (opened >= 0)
      close(opened);
    return eo_error_set(error, EO_ERROR_FILE, "", "The file %s could not be opened: %s.", path, strerror(reason));
  }
  *file = opened;
  *size = state.st_size;
  return EO_OK;
}

enum eo_code eo_bytes_read(int file, int64_t at, void *bytes, size_t size, struct eo_error *error)
{
  char *to = bytes;
  while (size > 0) {
    ssize_t n = pread(file, to, size, at);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return eo_error_set(error, EO_ERROR_FILE, "", "The file could not be read at byte %lld: %s.", (long long)at,
                          strerror(errno));
    if (n == 0)
      return eo_error_set(error, EO_ERROR_INPUT, "", "The file ends at byte %lld, where %zu bytes more should follow.",
                          (long long)at, size);
    to += n;
    at += n;
    size -= (size_t)n;
  }
  return EO_OK;
}

enum eo_code eo_bytes_write(int file, int64_t at, const void *bytes, size_t size, struct eo_error *error)
{
  const char *from = bytes;
  while (size > 0) {
    ssize_t n = pwrite(file, from, size, at);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return eo_error_set(error, EO_ERROR_FILE, "", "The temporary file of a recording could not be written: %s.",
                          strerror(n < 0 ? errno : ENOSPC));
    from += n;
    at += n;
    size -= (size_t)n;
  }
  return EO_OK;
}

enum eo_code eo_bytes_spool(const char *directory, int *file, struct eo_error *error)
{
  if (!directory)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no folder for a temporary file.");
  size_t size = strlen(directory) + sizeof "/recording-XXXXXX";
  char *path = malloc(size);
  if (!path)
    return eo_error_memory(error);
  snprintf(path, size, "%s/recording-XXXXXX", directory);
  *file = mkostemp(path, O_CLOEXEC);
  int reason = errno;
  if (*file >= 0)
    unlink(path);
  free(path);
  if (*file < 0)
    return eo_error_set(error, EO_ERROR_FILE, "", "No temporary file could be made in %s: %s.", directory,
                        strerror(reason));
  return EO_OK;
}

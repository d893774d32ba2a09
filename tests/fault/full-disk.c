/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded before a server (LD_PRELOAD): a disk that can be told to be full. The file that FULL_DISK names holds the
   bytes that may still be written, as text; it is read again at every write. Removing a file gives its bytes back. Only
   regular files below the folder FULL_DISK_FOLDER count. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_ours(int file)
{
  char name[64], path[4096];
  const char *folder = getenv("FULL_DISK_FOLDER");
  snprintf(name, sizeof name, "/proc/self/fd/%d", file);
  ssize_t length = readlink(name, path, sizeof path - 1);
  if (length <= 0 || !folder)
    return false;
  path[length] = '\0';
  return strncmp(path, folder, strlen(folder)) == 0;
}

/* Changes the bytes that are left; -1: there is no limit. */
static long long change_left(long long by)
{
  static ssize_t (*real)(int, const void *, size_t, off_t);
  char text[40] = "";
  const char *path = getenv("FULL_DISK");
  int control = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
  long long left = -1;
  if (!real)
    real = (ssize_t(*)(int, const void *, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  if (control >= 0 && pread(control, text, sizeof text - 1, 0) > 0 && *text >= '0' && *text <= '9') {
    left = atoll(text);
    if (by < 0 ? left >= -by : by > 0) {
      snprintf(text, sizeof text, "%020lld", left + by);
      real(control, text, strlen(text), 0);
    }
  }
  if (control >= 0)
    close(control);
  return left;
}

/* Whether a write that makes the file longer may go on. */
static bool may_grow(int file, off_t end)
{
  struct stat status;
  if (!is_ours(file) || fstat(file, &status) || !S_ISREG(status.st_mode) || end <= status.st_size)
    return true;
  long long more = (long long)(end - status.st_size), left = change_left(-more);
  if (left < 0 || left >= more)
    return true;
  errno = ENOSPC;
  return false;
}

ssize_t write(int file, const void *bytes, size_t size)
{
  ssize_t (*real)(int, const void *, size_t) = (ssize_t(*)(int, const void *, size_t))dlsym(RTLD_NEXT, "write");
  off_t at = lseek(file, 0, SEEK_CUR);
  return at >= 0 && !may_grow(file, at + (off_t)size) ? -1 : real(file, bytes, size);
}

#define PWRITE(name, type)                                                                                           \
  ssize_t name(int file, const void *bytes, size_t size, type at)                                                    \
  {                                                                                                                  \
    ssize_t (*real)(int, const void *, size_t, type) = (ssize_t(*)(int, const void *, size_t, type))dlsym(RTLD_NEXT, \
                                                                                                          #name);    \
    return may_grow(file, (off_t)at + (off_t)size) ? real(file, bytes, size, at) : -1;                               \
  }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

int posix_fallocate(int file, off_t at, off_t size)
{
  int (*real)(int, off_t, off_t) = (int (*)(int, off_t, off_t))dlsym(RTLD_NEXT, "posix_fallocate");
  return may_grow(file, at + size) ? real(file, at, size) : ENOSPC;
}

int unlink(const char *path)
{
  int (*real)(const char *) = (int (*)(const char *))dlsym(RTLD_NEXT, "unlink");
  struct stat status;
  const char *folder = getenv("FULL_DISK_FOLDER");
  bool ours = folder && strncmp(path, folder, strlen(folder)) == 0 && stat(path, &status) == 0;
  int result = real(path);
  if (result == 0 && ours)
    change_left((long long)status.st_size);
  return result;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/measurements.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/measurement_files.h"
#include "store/statement.h"

static enum eo_code fault(const char *path, struct eo_error *error)
{
  enum eo_code code = errno == ENOSPC || errno == EDQUOT || errno == EFBIG ? EO_ERROR_FULL : EO_ERROR_FILE;
  return eo_error_set(error, code, "", "%.250s: %s.", path, strerror(errno));
}

static bool fits(int length, size_t size)
{
  return length >= 0 && (size_t)length < size;
}

static bool name_root(const struct eo_store *store, char *path, size_t size)
{
  return fits(snprintf(path, size, "%s/measurements", store->directory), size);
}

bool eo_measurement_folder_path(const struct eo_store *store, const char *prefix, int64_t id, char *path, size_t size)
{
  return fits(snprintf(path, size, "%s/measurements/%s%lld", store->directory, prefix, (long long)id), size);
}

bool eo_measurement_file_path(const struct eo_store *store, int64_t id, int file, char *path, size_t size)
{
  return fits(snprintf(path, size, "%s/measurements/%lld/%d", store->directory, (long long)id, file), size);
}

static enum eo_code too_long(struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_FILE, "", "The path of the data folder is too long.");
}

static enum eo_code make_root(const struct eo_store *store, char *path, size_t size, struct eo_error *error)
{
  if (!name_root(store, path, size))
    return too_long(error);
  return mkdir(path, 0777) && errno != EEXIST ? fault(path, error) : EO_OK;
}

enum eo_code eo_measurement_folder_new(struct eo_store *store, char *path, size_t size, struct eo_error *error)
{
  char root[EO_STORE_PATH];
  enum eo_code code = make_root(store, root, sizeof root, error);
  if (code)
    return code;
  if (!fits(snprintf(path, size, "%s/" EO_MEASUREMENT_INCOMING "XXXXXX", root), size))
    return too_long(error);
  return mkdtemp(path) ? EO_OK : fault(path, error);
}

bool eo_measurement_file_is_ours(const char *name)
{
  static const char *const temporary[] = {"inflated-", "recording-"};
  if (name[0] >= '0' && name[0] < '0' + EO_MEASUREMENT_FILES && !name[1])
    return true;
  for (size_t i = 0; i < sizeof temporary / sizeof *temporary; i++) {
    size_t length = strlen(temporary[i]);
    if (strncmp(name, temporary[i], length) == 0 && strlen(name + length) == EO_MEASUREMENT_LETTERS)
      return true;
  }
  return false;
}

void eo_measurement_folder_remove(const char *path)
{
  DIR *folder = opendir(path);
  const struct dirent *entry;
  char file[EO_STORE_PATH];
  while (folder && (entry = readdir(folder)))
    if (eo_measurement_file_is_ours(entry->d_name) &&
        fits(snprintf(file, sizeof file, "%s/%s", path, entry->d_name), sizeof file))
      unlink(file);
  if (folder)
    closedir(folder);
  rmdir(path);
}

static enum eo_code flush(const char *path, int flags, struct eo_error *error)
{
  int file = open(path, flags | O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return fault(path, error);
  enum eo_code code = fsync(file) ? fault(path, error) : EO_OK;
  close(file);
  return code;
}

enum eo_code eo_measurement_folder_flush(const char *folder, int files, struct eo_error *error)
{
  char path[EO_STORE_PATH];
  enum eo_code code = EO_OK;
  for (int i = 0; i < files && !code; i++)
    code = fits(snprintf(path, sizeof path, "%s/%d", folder, i), sizeof path) ? flush(path, 0, error) : too_long(error);
  return code ? code : flush(folder, O_DIRECTORY, error);
}

bool eo_measurement_folder_is_there(const struct eo_store *store, int64_t id)
{
  char path[EO_STORE_PATH];
  struct stat status;
  return !eo_measurement_folder_path(store, "", id, path, sizeof path) || lstat(path, &status) == 0;
}

enum eo_code eo_measurement_folder_keep(const struct eo_store *store, const char *folder, int64_t id,
                                        struct eo_error *error)
{
  char root[EO_STORE_PATH], path[EO_STORE_PATH];
  if (!name_root(store, root, sizeof root) || !eo_measurement_folder_path(store, "", id, path, sizeof path))
    return too_long(error);
  if (rename(folder, path)) /* onto a folder that holds anything it fails */
    return fault(path, error);
  enum eo_code code = flush(root, O_DIRECTORY, error);
  if (code)
    rename(path, folder);
  return code;
}

void eo_measurement_folder_give_back(const struct eo_store *store, const char *folder, int64_t id)
{
  char path[EO_STORE_PATH];
  if (eo_measurement_folder_path(store, "", id, path, sizeof path))
    rename(path, folder);
}

enum eo_code eo_measurement_folder_mark(const struct eo_store *store, int64_t id, bool deleted, struct eo_error *error)
{
  char kept[EO_STORE_PATH], marked[EO_STORE_PATH];
  if (!eo_measurement_folder_path(store, "", id, kept, sizeof kept) ||
      !eo_measurement_folder_path(store, EO_MEASUREMENT_DELETED, id, marked, sizeof marked))
    return too_long(error);
  if (rename(deleted ? kept : marked, deleted ? marked : kept) && errno != ENOENT)
    return fault(kept, error);
  return EO_OK;
}

void eo_measurement_folder_drop(const struct eo_store *store, int64_t id)
{
  char path[EO_STORE_PATH];
  if (eo_measurement_folder_path(store, EO_MEASUREMENT_DELETED, id, path, sizeof path))
    eo_measurement_folder_remove(path);
}

enum eo_code eo_measurement_file_hash(const char *path, char sha256[EO_HASH_LENGTH + 1], struct eo_error *error)
{
  enum { BLOCK = 64 << 10 };
  unsigned char *block = malloc(BLOCK);
  struct eo_hash hash;
  if (!block)
    return eo_error_memory(error);
  int file = open(path, O_RDONLY | O_CLOEXEC);
  ssize_t got = -1;
  eo_hash_init(&hash);
  while (file >= 0 && (got = read(file, block, BLOCK)) > 0)
    eo_hash_add(&hash, block, (size_t)got);
  enum eo_code code = got < 0 ? fault(path, error) : EO_OK;
  eo_hash_finish(&hash, sha256);
  if (file >= 0)
    close(file);
  free(block);
  return code;
}

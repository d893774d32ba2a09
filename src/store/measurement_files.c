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

#define INCOMING "incoming-"

static enum eo_code fault(const char *path, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno));
}

static bool fits(int length, size_t size)
{
  return length >= 0 && (size_t)length < size;
}

static bool name_root(const struct eo_store *store, char *path, size_t size)
{
  return fits(snprintf(path, size, "%s/measurements", store->directory), size);
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
  if (!fits(snprintf(path, size, "%s/" INCOMING "XXXXXX", root), size))
    return too_long(error);
  return mkdtemp(path) ? EO_OK : fault(path, error);
}

/* Two levels are all there are; links are removed, not followed. */
static void remove_all(const char *path, int depth)
{
  DIR *folder = depth ? opendir(path) : NULL;
  const struct dirent *entry;
  char inner[EO_STORE_PATH];
  while (folder && (entry = readdir(folder)))
    if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
        fits(snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name), sizeof inner)) {
      if (unlink(inner) && (errno == EISDIR || errno == EPERM))
        remove_all(inner, depth - 1);
    }
  if (folder)
    closedir(folder);
  rmdir(path);
}

void eo_measurement_folder_remove(const char *path)
{
  remove_all(path, 2);
}

/* ---- tidying ---- */

static bool has_row(struct eo_store *store, const char *name, enum eo_code *code, struct eo_error *error)
{
  char *end;
  long long id = strtoll(name, &end, 10);
  if (*end || end == name || id <= 0 || *name == '0')
    return false;
  struct eo_statement s = eo_statement_begin(store, "SELECT 1 FROM measurement WHERE id = ?", "i", (int64_t)id);
  bool there = eo_statement_step(&s);
  *code = eo_statement_end(&s, error);
  return there;
}

enum eo_code eo_measurement_folder_tidy(struct eo_store *store, struct eo_error *error)
{
  char root[EO_STORE_PATH], path[EO_STORE_PATH];
  enum eo_code code = EO_OK;
  if (!name_root(store, root, sizeof root))
    return too_long(error);
  DIR *folder = opendir(root);
  if (!folder)
    return errno == ENOENT ? EO_OK : fault(root, error);
  const struct dirent *entry;
  while (!code && (entry = readdir(folder))) {
    if (*entry->d_name == '.' || has_row(store, entry->d_name, &code, error) || code)
      continue;
    if (fits(snprintf(path, sizeof path, "%s/%s", root, entry->d_name), sizeof path) && unlink(path))
      eo_measurement_folder_remove(path);
  }
  closedir(folder);
  return code;
}

/* ---- to the disk ---- */

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

enum eo_code eo_measurement_folder_keep(const struct eo_store *store, const char *folder, int64_t id,
                                        struct eo_error *error)
{
  char root[EO_STORE_PATH], path[EO_STORE_PATH + 24];
  if (!name_root(store, root, sizeof root))
    return too_long(error);
  snprintf(path, sizeof path, "%s/%lld", root, (long long)id);
  eo_measurement_folder_remove(path); /* of a transaction that was taken back: its number was never given */
  if (rename(folder, path))
    return fault(path, error);
  return flush(root, O_DIRECTORY, error);
}

void eo_measurement_folder_drop(const struct eo_store *store, int64_t id)
{
  char root[EO_STORE_PATH], path[EO_STORE_PATH + 24];
  if (!name_root(store, root, sizeof root))
    return;
  snprintf(path, sizeof path, "%s/%lld", root, (long long)id);
  eo_measurement_folder_remove(path);
}

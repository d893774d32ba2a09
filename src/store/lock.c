/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "store/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/statement.h"

static enum eo_code open_locks(struct eo_store *store, struct eo_error *error)
{
  if (store->lock >= 0)
    return EO_OK;
  char *path = malloc(strlen(store->directory) + sizeof "/easeoff.lock");
  if (!path)
    return eo_error_memory(error);
  sprintf(path, "%s/easeoff.lock", store->directory);
  store->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (store->lock < 0 && (errno == EACCES || errno == EROFS))
    store->lock = open(path, O_RDONLY | O_CLOEXEC); /* good enough to see who holds what */
  enum eo_code code = EO_OK;
  if (store->lock < 0)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.200s cannot be opened: %s.", path, strerror(errno));
  free(path);
  return code;
}

static struct flock byte_of(int64_t job, short type)
{
  return (struct flock){.l_type = type, .l_whence = SEEK_SET, .l_start = job, .l_len = 1};
}

enum eo_code eo_store_claim_job(struct eo_store *store, int64_t job, bool *taken, struct eo_error *error)
{
  enum eo_code code = open_locks(store, error);
  if (code)
    return code;
  struct flock lock = byte_of(job, F_WRLCK);
  *taken = fcntl(store->lock, F_OFD_SETLK, &lock) == 0;
  if (!*taken && errno != EAGAIN && errno != EACCES)
    return eo_error_set(error, EO_ERROR_FILE, "", "%.150s/easeoff.lock: the file system cannot lock: %s.",
                        store->directory, strerror(errno));
  return EO_OK;
}

void eo_store_release_job(struct eo_store *store, int64_t job)
{
  struct flock lock = byte_of(job, F_UNLCK);
  if (store->lock >= 0)
    fcntl(store->lock, F_OFD_SETLK, &lock);
}

bool eo_store_job_is_taken(struct eo_store *store, int64_t job)
{
  struct flock lock = byte_of(job, F_WRLCK);
  return !open_locks(store, NULL) && fcntl(store->lock, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

enum eo_code eo_store_claim_server(struct eo_store *store, bool *taken, struct eo_error *error)
{
  return eo_store_claim_job(store, 0, taken, error); /* jobs are numbered from 1 */
}

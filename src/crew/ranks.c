/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crew/ranks.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MODULE "easeoff-mpi.so"

/* Open MPI's mpirun and srun with PMIx, srun and others with PMI. */
static bool is_launched(void)
{
  static const char *const variable[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
  for (size_t i = 0; i < sizeof variable / sizeof *variable; i++)
    if (getenv(variable[i]))
      return true;
  return false;
}

/* Beside the program, where it was built; else where it was installed. Its library has parts that look for it among the
   symbols that all may see. */
static void *open_module(void)
{
  char path[PATH_MAX + sizeof MODULE + 1];
  const char *elsewhere = getenv("EASEOFF_MODULES"); /* of programs that stand elsewhere: benchmarks */
  if (elsewhere && snprintf(path, sizeof path, "%s/%s", elsewhere, MODULE) < (int)sizeof path)
    return dlopen(path, RTLD_NOW | RTLD_GLOBAL);
  ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
  if (length > 0) {
    path[length] = '\0';
    char *last = strrchr(path, '/');
    snprintf(last ? last + 1 : path, sizeof MODULE, "%s", MODULE);
    void *module = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    if (module)
      return module;
  }
  return dlopen(MODULEDIR "/" MODULE, RTLD_NOW | RTLD_GLOBAL);
}

enum eo_code eo_ranks_find(const struct eo_ranks **ranks, struct eo_error *error)
{
  *ranks = NULL;
  if (!is_launched())
    return EO_OK;
  void *module = open_module();
  if (module)
    *ranks = dlsym(module, EO_RANKS_SYMBOL);
  if (*ranks)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "This program was started by an MPI launcher, and its MPI module cannot be loaded: %.200s. It is "
                      "made by configure where Open MPI is found (libopenmpi-dev).",
                      dlerror());
}

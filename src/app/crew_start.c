/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/crew_start.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "app/number.h"
#include "base/parallel.h"
#include "study/scatter_crew.h"
#include "study/study_crew.h"
#include "variants/variant_trade.h"

/* What a rank can be asked for. */
static const struct eo_crew_trade *const trades[] = {&eo_variant_trade, &eo_study_trade, &eo_scatter_trade, NULL};

/* The last value of an option; NULL: it is not given. Whether the arguments are right is told by rank 0 alone. */
static const char *find_option(const char *name, int argc, char **argv)
{
  size_t length = strlen(name);
  const char *value = NULL;
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
    if (strncmp(argv[i], name, length) == 0 && argv[i][length] == '=')
      value = argv[i] + length + 1;
    else if (strcmp(argv[i], name) == 0 && i + 1 < argc)
      value = argv[++i];
  return value;
}

static bool has_flag(const char *name, int argc, char **argv)
{
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
    if (strcmp(argv[i], name) == 0)
      return true;
  return false;
}

/* Signals that ask for a stop, out of the way of this thread and of those it starts. before: may be NULL. */
static void block_stops(sigset_t *before)
{
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, before);
}

/* MPI starts threads of its own: a stop must not end the process through one of them, watch.h waits for it. */
static enum eo_code begin_quietly(struct eo_crew *crew, const struct eo_crew_place *place, struct eo_error *error)
{
  sigset_t before;
  block_stops(&before);
  enum eo_code code = eo_crew_begin(crew, place, error);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return code;
}

static int serve(struct eo_app_crew *crew)
{
  struct eo_error error;
  block_stops(NULL); /* a stop is rank 0's to make of it what is right; METIS's handlers must not run */
  if (!eo_crew_serve(&crew->crew, trades, &error)) {
    eo_app_crew_end(crew);
    return EO_EXIT_DONE;
  }
  int status = eo_app_fail(NULL, &error);
  crew->crew.ranks->abort(status);
  return status;
}

bool eo_app_crew_begin(struct eo_app_crew *crew, int argc, char **argv, int *status)
{
  struct eo_crew_place place = {0};
  struct eo_error error;
  const char *threads = find_option("--threads", argc, argv), *cache = find_option("--cache", argc, argv);
  *crew = (struct eo_app_crew){0};
  *status = EO_EXIT_DONE;
  bool keeps = !has_flag("--no-cache", argc, argv);
  if (keeps && cache)
    eo_text_add(&crew->cache, cache);
  else if (keeps)
    eo_app_cache_directory(find_option("--data", argc, argv), &crew->cache);
  place.cache = crew->cache.data;
  if (threads && !eo_app_read_whole(threads, "--threads", 1, EO_MAX_THREADS, &place.threads, &error)) {
    *status = eo_app_fail(NULL, &error);
    eo_app_crew_end(crew);
    return false;
  }
  bool own = !threads; /* a rank shares its machine with others, a process alone does not */
  place.threads = threads ? place.threads : 1;
  if (begin_quietly(&crew->crew, &place, &error)) {
    *status = eo_app_fail(NULL, &error);
    eo_app_crew_end(crew);
    return false;
  }
  if (eo_crew_is_led(&crew->crew)) {
    *status = serve(crew);
    return false;
  }
  if (own && crew->crew.size == 1)
    crew->crew.place.threads = eo_parallel_cores();
  return true;
}

void eo_app_crew_end(struct eo_app_crew *crew)
{
  eo_crew_end(&crew->crew);
  eo_text_done(&crew->cache);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/launcher.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"

enum { MOST_WORDS = 60, LOOK_MS = 100 };
/* How long a launcher may take to end by itself, and after it was told to; ms. */
static const double OWN_END_MS = 30e3, TOLD_END_MS = 10e3;

extern char **environ;

struct command {
  char *words;                     /* of the launcher, cut; owned */
  char *argument[MOST_WORDS + 10]; /* ends with NULL */
  char job[24];
};

static enum eo_code compose(const struct eo_launch *launch, struct command *command, struct eo_error *error)
{
  int count = 0;
  char *rest = NULL;
  command->words = strdup(launch->launcher);
  if (!command->words)
    return eo_error_memory(error);
  for (char *word = strtok_r(command->words, " ", &rest); word && count < MOST_WORDS; word = strtok_r(NULL, " ", &rest))
    command->argument[count++] = word;
  if (!count)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The launcher is empty.");
  snprintf(command->job, sizeof command->job, "%lld", (long long)launch->job);
  char *const own[] = {
      (char *)launch->program, (char *)eo_store_job_kind_name(launch->kind), "--work", command->job, "--data",
      (char *)launch->data};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    command->argument[count++] = own[i];
  return EO_OK;
}

/* In a process group of its own: a Ctrl-C that ends the server is the server's to hand on. What it says goes to the
   server's log. */
static enum eo_code spawn(const struct command *command, pid_t *process, struct eo_error *error)
{
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  int fault = posix_spawnp(process, command->argument[0], &actions, &attributes, command->argument, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return fault ? eo_error_set(error, EO_ERROR_INPUT, "", "The launcher \"%.100s\" cannot be started: %s.",
                              command->argument[0], strerror(fault))
               : EO_OK;
}

/* Tells it to end, and ends it when it does not. */
struct ending {
  double wished, told; /* ms of the clock; 0: not yet */
};

static void hasten(struct ending *ending, pid_t process, enum eo_launch_wish wish)
{
  double now = eo_clock_milliseconds();
  if (wish == EO_LAUNCH_GO_ON)
    return;
  ending->wished = ending->wished > 0 ? ending->wished : now;
  if (!(ending->told > 0) && (wish == EO_LAUNCH_END_SOON || now - ending->wished > OWN_END_MS)) {
    ending->told = now;
    kill(process, SIGTERM);
  } else if (ending->told > 0 && now - ending->told > TOLD_END_MS)
    kill(-process, SIGKILL);
}

enum eo_code eo_launch_run(const struct eo_launch *launch, eo_launch_watch *watch, void *context, int *status,
                           struct eo_error *error)
{
  struct command command = {0};
  struct ending ending = {0};
  pid_t process = 0, ended = 0;
  enum eo_code code = compose(launch, &command, error);
  if (!code)
    code = spawn(&command, &process, error);
  free(command.words);
  while (!code && ended == 0) {
    nanosleep(&(struct timespec){0, LOOK_MS * 1000000L}, NULL);
    hasten(&ending, process, watch(context));
    ended = waitpid(process, status, WNOHANG);
    if (ended < 0 && errno == EINTR)
      ended = 0;
  }
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* pipe2 */
#include "service/preparation.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "design/resolution.h"
#include "document/design_document.h"
#include "service/preparation_line.h"

enum { LOOK_MS = 50, LINE = 1024 };

extern char **environ;

/* The process and what it has said. */
struct running {
  pid_t process;
  int channel; /* its standard input and output */
  char line[LINE];
  size_t length;
  char what[80]; /* its last progress */
  double fraction;
  bool told; /* its last word is in *error, or it said that it is done */
  enum eo_code code;
};

enum eo_code eo_preparation_cost_of(const struct eo_design *design, struct eo_preparation_cost *cost,
                                    struct eo_error *error)
{
  struct eo_geometry geometry;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design->resolution);
  EO_TRY(eo_geometry_init(&geometry, &design->gear_pair, error));
  return eo_preparation_cost_find(&geometry, &design->gear_pair, &settings, cost, error);
}

enum eo_code eo_preparation_admit(const struct eo_preparation_settings *settings, const struct eo_design *design,
                                  struct eo_error *error)
{
  struct eo_preparation_cost cost;
  if (eo_preparation_cost_of(design, &cost, NULL))
    return EO_OK; /* the preparation says what is wrong with it */
  if (cost.memory <= settings->memory && cost.seconds <= settings->seconds)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "/resolution",
                      "Preparing this pair would take about %.0f MB and %.0f s of a processor; this server allows %.0f "
                      "MB and %.0f s. Fewer layers, flank_rows or fillet_elements take less.",
                      cost.memory / 1e6, cost.seconds, settings->memory / 1e6, settings->seconds);
}

static void set_arguments(const struct eo_preparation_settings *settings, char memory[40], char seconds[40])
{
  snprintf(memory, 40, "%.0f", settings->memory / 1e6 + 1);
  snprintf(seconds, 40, "%.0f", settings->seconds + 1);
}

/* A socket in place of two pipes: what is written to a process that has ended is an error and no signal. */
static enum eo_code spawn(const struct eo_preparation_settings *settings, struct running *running,
                          struct eo_error *error)
{
  int ends[2];
  char memory[40], seconds[40];
  set_arguments(settings, memory, seconds);
  char *const argument[] = {"easeoff",     "prepare", "-",         "--follow", "--cache", (char *)settings->cache,
                            "--memory-MB", memory,    "--seconds", seconds,    NULL};
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t none, all;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends))
    return eo_error_set(error, EO_ERROR_MEMORY, "", "No channel to a process could be made: %s.", strerror(errno));
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  int fault = posix_spawn(&running->process, settings->program, &actions, &attributes, argument, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  running->channel = ends[0];
  if (!fault)
    return EO_OK;
  close(ends[0]);
  return eo_error_set(error, EO_ERROR_MEMORY, "", "No process for a preparation could be made: %s.", strerror(fault));
}

static bool send_design(const struct running *running, const struct eo_design *design)
{
  struct eo_text text = {0};
  eo_design_write(design, &text);
  bool good = !text.failed;
  for (size_t at = 0; good && at < text.size;) {
    ssize_t sent = send(running->channel, text.data + at, text.size - at, MSG_NOSIGNAL);
    good = sent > 0 || (sent < 0 && errno == EINTR);
    at += sent > 0 ? (size_t)sent : 0;
  }
  eo_text_done(&text);
  shutdown(running->channel, SHUT_WR);
  return good;
}

/* One line of the process; true: the preparation shall end. */
static bool take_line(struct running *running, const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_preparation_line line;
  if (!eo_preparation_line_read(running->line, &line))
    return false;
  if (line.kind == EO_PREPARATION_PROGRESS) {
    memcpy(running->what, line.what, sizeof running->what);
    running->fraction = line.fraction;
    return eo_progress_report(progress, running->what, running->fraction) != 0;
  }
  running->told = true;
  running->code = line.kind == EO_PREPARATION_DONE ? EO_OK : line.error.code;
  if (running->code && error)
    *error = line.error;
  return false;
}

/* What has come, in lines; false: nothing comes any more. */
static bool receive(struct running *running, const struct eo_progress *progress, bool *stop, struct eo_error *error)
{
  char block[LINE];
  ssize_t got = read(running->channel, block, sizeof block);
  if (got < 0 && errno == EINTR)
    return true;
  for (ssize_t i = 0; i < got; i++)
    if (block[i] == '\n') {
      running->line[running->length] = '\0';
      running->length = 0;
      *stop = take_line(running, progress, error) || *stop;
    } else if (running->length < LINE - 1)
      running->line[running->length++] = block[i];
  return got > 0;
}

static bool follow(struct running *running, const struct eo_progress *progress, struct eo_error *error)
{
  bool stop = false, open = true;
  while (open && !stop) {
    struct pollfd ready = {.fd = running->channel, .events = POLLIN};
    if (poll(&ready, 1, LOOK_MS) > 0)
      open = receive(running, progress, &stop, error);
    else
      stop = eo_progress_report(progress, running->what, running->fraction) != 0;
  }
  return stop;
}

/* Why a process ended that said nothing. */
static enum eo_code explain(const struct eo_preparation_settings *settings, int status, struct eo_error *error)
{
  int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU)
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "The preparation took more than the %.0f s of a processor that it "
                        "may take.",
                        settings->seconds);
  if (signal == SIGKILL)
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "The system ended the preparation, as it does when memory is short; %.0f MB are allowed.",
                        settings->memory / 1e6);
  return eo_error_set(
      error, EO_ERROR_NUMERIC, "",
      "The preparation ended without a result (%s %d): it may have wanted more than the %.0f MB that it "
      "may take.",
      signal ? "signal" : "status", signal ? signal : WEXITSTATUS(status), settings->memory / 1e6);
}

enum eo_code eo_preparation_run(const struct eo_preparation_settings *settings, const struct eo_design *design,
                                const struct eo_progress *progress, struct eo_error *error)
{
  struct running running = {.channel = -1, .what = "waiting for a processor"};
  int status = 0;
  EO_TRY(spawn(settings, &running, error));
  send_design(&running, design); /* one that does not take it says why, or ends */
  bool stopped = follow(&running, progress, error);
  close(running.channel);
  if (stopped || running.told)
    kill(running.process, SIGKILL); /* it has ended, or is of no use any more */
  while (waitpid(running.process, &status, 0) < 0 && errno == EINTR)
    ;
  if (stopped)
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "The preparation was stopped.");
  if (running.told && running.code == EO_ERROR_MEMORY)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The preparation wanted more than the %.0f MB that it may take.",
                        settings->memory / 1e6);
  return running.told ? running.code : explain(settings, status, error);
}

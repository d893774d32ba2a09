/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* close_range */
#include "recording/isolate.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/sanitized.h"

#define BLOCK 4096  /* rows of one message at most */
#define WAIT_MS 200 /* between questions whether to go on */

/* From the process to its parent: kind and count, then what the kind says. */
enum {
  MESSAGE_COLUMNS = 1, /* count: columns; struct eo_series[count] */
  MESSAGE_ROWS,        /* count: rows; double[count][columns] */
  MESSAGE_DONE
}; /* struct eo_error, struct eo_notes; the last */

struct message {
  int32_t kind, count;
};

struct child {
  int pipe, columns;
};

static bool send_all(int pipe, const void *bytes, size_t size)
{
  const char *from = bytes;
  while (size > 0) {
    ssize_t n = write(pipe, from, size);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return false;
    from += n;
    size -= (size_t)n;
  }
  return true;
}

static enum eo_code send_message(const struct child *child, int kind, int count, const void *bytes, size_t size,
                                 struct eo_error *error)
{
  struct message message = {kind, count};
  if (send_all(child->pipe, &message, sizeof message) && send_all(child->pipe, bytes, size))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_CANCELLED, "", "Nobody waits for the file any more.");
}

static enum eo_code send_columns(void *context, const struct eo_series *column, int columns, struct eo_error *error)
{
  struct child *child = context;
  child->columns = columns;
  return send_message(child, MESSAGE_COLUMNS, columns, column, (size_t)columns * sizeof *column, error);
}

static enum eo_code send_rows(void *context, const double *rows, int64_t count, struct eo_error *error)
{
  const struct child *child = context;
  while (count > 0) {
    int64_t n = count < BLOCK ? count : BLOCK;
    enum eo_code code = send_message(child, MESSAGE_ROWS, (int)n, rows,
                                     (size_t)n * (size_t)child->columns * sizeof *rows, error);
    if (code)
      return code;
    rows += n * child->columns;
    count -= n;
  }
  return EO_OK;
}

static void set_limit(int resource, rlim_t limit)
{
  struct rlimit old;
  if (!getrlimit(resource, &old) && limit < old.rlim_cur)
    setrlimit(resource, &(struct rlimit){limit, old.rlim_max});
}

/* Bytes of address space this process has taken. Sanitizers take nearly all of it, so that no limit can be set beside
   them. */
static void limit_memory(void)
{
#ifndef EO_SANITIZED
  char text[64];
  int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  ssize_t n = file >= 0 ? read(file, text, sizeof text - 1) : 0;
  if (n > 0) {
    text[n] = '\0';
    set_limit(RLIMIT_AS, (rlim_t)strtoull(text, NULL, 10) * (rlim_t)sysconf(_SC_PAGESIZE) + EO_ISOLATE_MEMORY);
  }
  if (file >= 0)
    close(file);
#endif
}

/* A reader whose parent is killed would go on until its time is up. */
static void end_with(pid_t parent)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) /* it was killed before */
    _exit(2);
}

/* Gives back what the parent had open and its ways of ending, then reads. */
static void run_child(int pipe, pid_t parent, eo_series_reader *reader, const char *path,
                      const struct eo_reader_options *options)
{
  struct child child = {3, 0};
  end_with(parent);
  if (dup2(pipe, child.pipe) < 0)
    _exit(2);
  int silence = open("/dev/null", O_RDWR);
  for (int standard = 0; standard < 3; standard++)
    dup2(silence, standard);
  if (close_range(4, ~0u, 0))
    _exit(2);
  for (int number = 1; number < NSIG; number++)
    signal(number, SIG_DFL);
  signal(SIGPIPE, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  set_limit(RLIMIT_CPU, options->seconds > 0 ? (rlim_t)ceil(options->seconds) : EO_ISOLATE_SECONDS);
  set_limit(RLIMIT_CORE, 0);
  limit_memory();
  struct eo_reader_options own = *options;
  own.progress = NULL;
  struct {
    struct eo_error error;
    struct eo_notes notes;
  } last = {0};
  struct eo_series_sink sink = {send_columns, send_rows, &child};
  enum eo_code code = reader(path, &own, &sink, &last.notes, &last.error);
  last.error.code = code;
  send_message(&child, MESSAGE_DONE, 0, &last, sizeof last, NULL);
  _exit(0);
}

struct parent {
  int pipe;
  const struct eo_progress *progress;
  const struct eo_series_sink *sink;
  int columns;
  double *rows; /* [BLOCK][columns] */
};

enum { RECEIVED, ENDED, CANCELLED };

/* Receives exactly size bytes. */
static int receive(const struct parent *parent, void *bytes, size_t size)
{
  char *to = bytes;
  while (size > 0) {
    struct pollfd ready = {.fd = parent->pipe, .events = POLLIN};
    int events = poll(&ready, 1, WAIT_MS);
    if (events <= 0) {
      if (parent->columns == 0 && eo_progress_report(parent->progress, "rig file", 0))
        return CANCELLED;
      continue;
    }
    ssize_t n = read(parent->pipe, to, size);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return ENDED;
    to += n;
    size -= (size_t)n;
  }
  return RECEIVED;
}

static enum eo_code no_answer(int state, struct eo_error *error)
{
  if (state == CANCELLED)
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Reading the file was cancelled.");
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "The file is damaged or takes too much memory or time: its reader gave up without an answer.");
}

static void end_series(struct eo_series *series, int columns)
{
  series->name[sizeof series->name - 1] = '\0';
  series->unit[sizeof series->unit - 1] = '\0';
  if (series->clock.column >= columns)
    series->clock.column = -1;
}

static enum eo_code receive_columns(struct parent *parent, int count, struct eo_error *error)
{
  if (parent->columns || count < 1 || count > EO_RECORDING_COLUMNS)
    return no_answer(ENDED, error);
  struct eo_series *column = calloc((size_t)count, sizeof *column);
  parent->rows = malloc((size_t)count * BLOCK * sizeof *parent->rows);
  enum eo_code code = column && parent->rows ? EO_OK : eo_error_memory(error);
  int state = code ? RECEIVED : receive(parent, column, (size_t)count * sizeof *column);
  if (state != RECEIVED)
    code = no_answer(state, error);
  for (int c = 0; !code && c < count; c++)
    end_series(&column[c], count);
  if (!code) {
    parent->columns = count;
    code = parent->sink->begin(parent->sink->context, column, count, error);
  }
  free(column);
  return code;
}

static enum eo_code receive_rows(struct parent *parent, int count, struct eo_error *error)
{
  if (!parent->columns || count < 1 || count > BLOCK)
    return no_answer(ENDED, error);
  int state = receive(parent, parent->rows, (size_t)count * (size_t)parent->columns * sizeof *parent->rows);
  return state == RECEIVED ? parent->sink->rows(parent->sink->context, parent->rows, count, error)
                           : no_answer(state, error);
}

/* The process's own verdict and what it noted. */
static enum eo_code receive_end(const struct parent *parent, struct eo_notes *notes, struct eo_error *error)
{
  struct eo_error verdict;
  struct eo_notes noted;
  int state = receive(parent, &verdict, sizeof verdict);
  if (state == RECEIVED)
    state = receive(parent, &noted, sizeof noted);
  if (state != RECEIVED)
    return no_answer(state, error);
  verdict.text[sizeof verdict.text - 1] = '\0';
  for (int i = 0; i < noted.count && i < EO_NOTES; i++)
    eo_notes_add(notes, "%.*s", EO_NOTE_LENGTH - 1, noted.text[i]);
  if (verdict.code == EO_OK)
    return parent->columns ? EO_OK : no_answer(ENDED, error);
  return eo_error_set(error, verdict.code <= EO_ERROR_LAST ? verdict.code : EO_ERROR_INPUT, "", "%s", verdict.text);
}

static enum eo_code receive_all(struct parent *parent, struct eo_notes *notes, struct eo_error *error)
{
  for (;;) {
    struct message message;
    int state = receive(parent, &message, sizeof message);
    enum eo_code code = state == RECEIVED ? EO_OK : no_answer(state, error);
    if (!code && message.kind == MESSAGE_DONE)
      return receive_end(parent, notes, error);
    if (!code)
      code = message.kind == MESSAGE_COLUMNS ? receive_columns(parent, message.count, error)
                                             : receive_rows(parent, message.count, error);
    if (code)
      return code;
  }
}

enum eo_code eo_isolate_read(eo_series_reader *reader, const char *path, const struct eo_reader_options *options,
                             const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  int ends[2];
  if (pipe2(ends, O_CLOEXEC))
    return eo_error_set(error, EO_ERROR_FILE, "", "No pipe to a reader could be made: %s.", strerror(errno));
  pid_t own = getpid(), process = fork();
  if (process == 0)
    run_child(ends[1], own, reader, path, options);
  close(ends[1]);
  if (process < 0) {
    close(ends[0]);
    return eo_error_set(error, EO_ERROR_MEMORY, "", "No process for a reader could be made: %s.", strerror(errno));
  }
  struct parent parent = {.pipe = ends[0], .progress = options->progress, .sink = sink};
  enum eo_code code = receive_all(&parent, notes, error);
  close(ends[0]);
  kill(process, SIGKILL); /* it has ended, or is of no use any more */
  while (waitpid(process, NULL, 0) < 0 && errno == EINTR)
    ;
  free(parent.rows);
  return code;
}

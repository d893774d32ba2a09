/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* pthread_timedjoin_np */
#include "http/log.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "format/json.h"

enum {
  ROOM = 1 << 20,   /* bytes between those who log and the reader: some 4000 lines */
  LINE = 2048,      /* longest line; below PIPE_BUF, so that a pipe that is ready takes it whole */
  LOOK_MS = 100,    /* between questions whether the reader is ready */
  PARTING_MS = 1000 /* for the reader at the end */
};
_Static_assert((int)LINE <= (int)PIPE_BUF, "a line must fit into a pipe that is ready");

struct eo_log {
  enum eo_log_level level;
  pthread_t thread;
  pthread_mutex_t lock; /* of everything below */
  pthread_cond_t changed;
  char *room;         /* [ROOM], a ring of lines */
  size_t first, used; /* bytes */
  uint64_t dropped, told;
  bool ending;
};

/* A line, or a part of one that wraps, out of the ring; 0: there is none, and the log ends. With the lock held. */
static size_t next_line(struct eo_log *log, char line[LINE])
{
  size_t size = 0;
  while (!log->used && !log->ending)
    pthread_cond_wait(&log->changed, &log->lock);
  while (size < log->used && size < LINE) {
    line[size] = log->room[(log->first + size) % ROOM];
    if (line[size++] == '\n')
      break;
  }
  return size;
}

static bool wait_for_reader(struct eo_log *log, double *end)
{
  struct pollfd reader = {.fd = STDERR_FILENO, .events = POLLOUT};
  for (;;) {
    if (poll(&reader, 1, LOOK_MS) > 0)
      return true;
    pthread_mutex_lock(&log->lock);
    if (log->ending && *end == 0)
      *end = eo_clock_milliseconds() + PARTING_MS;
    pthread_mutex_unlock(&log->lock);
    if (*end > 0 && eo_clock_milliseconds() > *end)
      return false;
  }
}

/* What cannot be written is gone: there is nowhere to say so. */
static void write_line(const char *line, size_t size)
{
  while (size) {
    ssize_t written = write(STDERR_FILENO, line, size);
    if (written < 0 && errno == EINTR)
      continue;
    if (written <= 0)
      return;
    line += written;
    size -= (size_t)written;
  }
}

static void *work(void *context)
{
  struct eo_log *log = context;
  char line[LINE];
  double end = 0;
  size_t size;
  for (;;) {
    pthread_mutex_lock(&log->lock);
    size = next_line(log, line);
    uint64_t dropped = log->dropped - log->told;
    log->told = log->dropped;
    pthread_mutex_unlock(&log->lock);
    if (!size || !wait_for_reader(log, &end))
      return NULL;
    if (dropped)
      dprintf(STDERR_FILENO,
              "{\"level\":\"warning\",\"event\":\"log\",\"text\":\"%llu lines were dropped: nobody read "
              "them in time.\"}\n",
              (unsigned long long)dropped);
    write_line(line, size);
    pthread_mutex_lock(&log->lock);
    log->first = (log->first + size) % ROOM;
    log->used -= size;
    pthread_mutex_unlock(&log->lock);
  }
}

enum eo_code eo_log_new(struct eo_log **result, enum eo_log_level level, struct eo_error *error)
{
  struct eo_log *log = calloc(1, sizeof *log);
  if (!log || !(log->room = malloc(ROOM))) {
    free(log);
    return eo_error_memory(error);
  }
  log->level = level;
  pthread_mutex_init(&log->lock, NULL);
  pthread_cond_init(&log->changed, NULL);
  if (pthread_create(&log->thread, NULL, work, log) != 0) {
    free(log->room);
    free(log);
    return eo_error_set(error, EO_ERROR_MEMORY, "", "A thread cannot be started.");
  }
  *result = log;
  return EO_OK;
}

void eo_log_free(struct eo_log *log)
{
  if (!log)
    return;
  pthread_mutex_lock(&log->lock);
  log->ending = true;
  pthread_cond_signal(&log->changed);
  pthread_mutex_unlock(&log->lock);
  struct timespec limit;
  clock_gettime(CLOCK_REALTIME, &limit);
  limit.tv_sec += 2 * PARTING_MS / 1000;
  if (pthread_timedjoin_np(log->thread, NULL, &limit)) { /* another writer took the room that there was */
    pthread_cancel(log->thread);
    pthread_join(log->thread, NULL);
  }
  pthread_cond_destroy(&log->changed);
  pthread_mutex_destroy(&log->lock);
  free(log->room);
  free(log);
}

void eo_log_put(struct eo_log *log, struct eo_text *line)
{
  eo_text_add(line, "}\n");
  pthread_mutex_lock(&log->lock);
  bool fits = !line->failed && line->size <= LINE && line->size <= ROOM - log->used;
  for (size_t i = 0; fits && i < line->size; i++)
    log->room[(log->first + log->used + i) % ROOM] = line->data[i];
  log->used += fits ? line->size : 0;
  log->dropped += !fits;
  pthread_cond_signal(&log->changed);
  pthread_mutex_unlock(&log->lock);
  eo_text_done(line);
}

bool eo_log_begin(const struct eo_log *log, enum eo_log_level level, const char *event, struct eo_text *line)
{
  static const char *const names[] = {"error", "warning", "info"};
  struct timespec now;
  struct tm utc;
  char time[40];
  if (!log || level > log->level)
    return false;
  clock_gettime(CLOCK_REALTIME, &now);
  gmtime_r(&now.tv_sec, &utc);
  strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%S", &utc);
  eo_text_print(line, "{\"time\":\"%s.%03ldZ\",\"level\":\"%s\",\"event\":\"%s\"", time, now.tv_nsec / 1000000,
                names[level], event);
  return true;
}

void eo_log_add(struct eo_text *line, const char *key, const char *value, size_t most)
{
  char shown[600];
  eo_text_clean(shown, most < sizeof shown ? most : sizeof shown, value);
  json_t *string = json_string(shown);
  if (!string)
    string = json_string("?"); /* not UTF-8 */
  eo_text_print(line, ",\"%s\":", key);
  if (string)
    eo_json_write(line, string, EO_JSON_COMPACT);
  json_decref(string);
}

void eo_log_event(struct eo_log *log, enum eo_log_level level, const char *event, const char *format, ...)
{
  struct eo_text line = {0};
  char text[600];
  va_list arguments;
  if (!eo_log_begin(log, level, event, &line))
    return;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  eo_log_add(&line, "text", text, sizeof text);
  eo_log_put(log, &line);
}

uint64_t eo_log_dropped(struct eo_log *log)
{
  if (!log)
    return 0;
  pthread_mutex_lock(&log->lock);
  uint64_t dropped = log->dropped;
  pthread_mutex_unlock(&log->lock);
  return dropped;
}

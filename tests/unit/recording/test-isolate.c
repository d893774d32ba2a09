/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers in a process of their own: what they send arrives, and their end of whatever kind is an error of the file. */
#include "recording/isolate.h"
#include "support/tap.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#define ROWS 10000

static enum eo_code value_at(void *context, int series, int64_t first, int64_t count, double *values,
                             struct eo_error *error)
{
  (void)context;
  (void)error;
  for (int64_t i = 0; i < count; i++)
    values[i] = (double)(first + i) * (series + 1);
  return EO_OK;
}

static enum eo_code good(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                         struct eo_notes *notes, struct eo_error *error)
{
  struct eo_series series[2] = {{.name = "one", .unit = "s", .length = ROWS}, {.name = "two", .length = ROWS}};
  struct eo_series_file file = {series, 2, 1 << 20, options->max_bytes, value_at, NULL};
  eo_notes_add(notes, "Read from %s.", path);
  return eo_series_copy(&file, sink, notes, error);
}

static enum eo_code refuse(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                           struct eo_notes *notes, struct eo_error *error)
{
  (void)options;
  (void)sink;
  (void)notes;
  return eo_error_set(error, EO_ERROR_INPUT, "", "%s is wrong at byte 7.", path);
}

/* Ends as the path says, after half of the rows when it begins with '+'. */
static enum eo_code end_early(const char *path, const struct eo_reader_options *options,
                              const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  if (*path == '+') {
    good(path++, options, sink, notes, error);
    double rows[2] = {1, 2};
    for (int i = 0; i < 10; i++)
      sink->rows(sink->context, rows, 1, error);
  }
  if (!strcmp(path, "crash"))
    raise(SIGSEGV);
  else if (!strcmp(path, "abort"))
    abort();
  else if (!strcmp(path, "exit"))
    _exit(0);
  for (;;)
    pause();
  return EO_OK;
}

static int stop(void *context, const char *what, double fraction)
{
  (void)what;
  (void)fraction;
  return ++*(int *)context >= 2;
}

static void check_end(const char *how)
{
  struct eo_error error;
  struct eo_series_recorder recorder = {0};
  struct eo_series_sink sink = eo_series_recorder_sink(&recorder);
  struct eo_reader_options options = {.max_bytes = 1 << 30};
  enum eo_code code = eo_isolate_read(end_early, how, &options, &sink, NULL, &error);
  ok(code == EO_ERROR_INPUT && strstr(error.text, "damaged"), "a reader that ends with \"%s\" is told of: %s", how,
     error.text);
  eo_recording_free(recorder.recording);
}

/* Says its number in the file, then hangs. */
static enum eo_code hang_named(const char *path, const struct eo_reader_options *options,
                               const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  FILE *file = fopen(path, "w");
  if (file) {
    fprintf(file, "%d\n", (int)getpid());
    fclose(file);
  }
  return end_early("hang", options, sink, notes, error);
}

static int number_in(const char *path)
{
  char text[32] = "";
  FILE *file = fopen(path, "r");
  if (file && !fgets(text, sizeof text, file))
    *text = '\0';
  if (file)
    fclose(file);
  return strchr(text, '\n') ? atoi(text) : 0;
}

/* A reader whose parent is killed ends as well; it comes to this process, which waits for it. */
static void check_killed_parent(void)
{
  char path[64];
  struct eo_reader_options options = {.max_bytes = 1 << 30};
  snprintf(path, sizeof path, "/tmp/easeoff-isolate-%d", (int)getpid());
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  pid_t parent = fork();
  if (parent == 0) {
    struct eo_error error;
    struct eo_series_recorder recorder = {0};
    struct eo_series_sink sink = eo_series_recorder_sink(&recorder);
    _exit(eo_isolate_read(hang_named, path, &options, &sink, NULL, &error) != EO_OK);
  }
  int reader = 0, status = 0;
  for (int i = 0; i < 500 && !reader; i++, usleep(10000))
    reader = number_in(path);
  kill(parent, SIGKILL);
  waitpid(parent, NULL, 0);
  pid_t ended = 0;
  for (int i = 0; i < 500 && reader && !ended; i++, usleep(10000))
    ended = waitpid(reader, &status, WNOHANG);
  ok(reader && ended == reader && WIFSIGNALED(status), "a reader whose parent is killed ends");
  if (reader && !ended)
    kill(reader, SIGKILL);
  unlink(path);
}

int main(void)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_series_recorder recorder = {0};
  struct eo_series_sink sink = eo_series_recorder_sink(&recorder);
  struct eo_reader_options options = {.max_bytes = 1 << 30};
  ok(!eo_isolate_read(good, "here", &options, &sink, &notes, &error) && eo_recording_rows(recorder.recording) == ROWS,
     "the rows of a reader on its own arrive");
  double row[2];
  ok(!eo_recording_read(recorder.recording, ROWS - 1, 1, row, &error) && row[0] == ROWS - 1 &&
         row[1] == 2 * (ROWS - 1) && !strcmp(eo_recording_name(recorder.recording, 1), "two"),
     "the values and names of a reader on its own arrive");
  ok(notes.count == 1 && !strcmp(notes.text[0], "Read from here."), "the notes of a reader on its own arrive");
  eo_recording_free(recorder.recording);
  recorder.recording = NULL;
  ok(eo_isolate_read(refuse, "it", &options, &sink, NULL, &error) == EO_ERROR_INPUT &&
         !strcmp(error.text, "it is wrong at byte 7."),
     "the error of a reader on its own arrives");
  check_end("crash");
  check_end("+crash");
  check_end("abort");
  check_end("exit");
  check_end("+exit");
  int asked = 0;
  struct eo_progress progress = {stop, &asked};
  options.progress = &progress;
  ok(eo_isolate_read(end_early, "hang", &options, &sink, NULL, &error) == EO_ERROR_CANCELLED && asked == 2,
     "a reader that hangs can be cancelled");
  check_killed_parent();
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/recording.h"
#include "support/tap.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define COLUMNS 3

static double value(int64_t row, int column)
{
  return (double)row * 1.5 + 0.25 * column;
}

static enum eo_code fill(struct eo_recording *r, int64_t rows, struct eo_error *error)
{
  double block[1000 * COLUMNS];
  for (int64_t first = 0; first < rows; first += 1000) {
    int64_t n = rows - first < 1000 ? rows - first : 1000;
    for (int64_t i = 0; i < n * COLUMNS; i++)
      block[i] = value(first + i / COLUMNS, (int)(i % COLUMNS));
    enum eo_code code = eo_recording_append(r, block, n, error);
    if (code)
      return code;
  }
  return EO_OK;
}

/* Number of wrong values in a few blocks spread over all rows. */
static int wrong_values(const struct eo_recording *r)
{
  int wrong = 0;
  struct eo_error error;
  double block[777 * COLUMNS];
  int64_t rows = eo_recording_rows(r);
  for (int64_t first = 0; first < rows; first += 50021) {
    int64_t n = rows - first < 777 ? rows - first : 777;
    if (eo_recording_read(r, first, n, block, &error))
      return -1;
    for (int64_t i = 0; i < n * COLUMNS; i++)
      wrong += block[i] != value(first + i / COLUMNS, (int)(i % COLUMNS));
  }
  return wrong;
}

static void *read_in_thread(void *r)
{
  return (void *)(intptr_t)wrong_values(r);
}

static void test_small(void)
{
  struct eo_error error;
  struct eo_recording *r = NULL;
  ok(eo_recording_new(&r, COLUMNS, NULL, &error) == EO_OK, "a recording is made in memory");
  eo_recording_set_column(r, 0, "t", "s");
  eo_recording_set_column(r, 1,
                          "Winkel "
                          "\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3"
                          "\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4"
                          "\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4",
                          "deg");
  ok(!strcmp(eo_recording_name(r, 0), "t") && !strcmp(eo_recording_unit(r, 0), "s") && !*eo_recording_name(r, 2),
     "names and units of columns are kept");
  ok(strlen(eo_recording_name(r, 1)) == 63 && (unsigned char)eo_recording_name(r, 1)[62] == 0xa4,
     "a long name keeps its last character whole");
  eo_recording_set_column(r, 2, "a\xff\tb\xed\xa0\x80", "\xb5m");
  ok(!strcmp(eo_recording_name(r, 2), "a\xc3\xbf b\xc3\xad\xc2\xa0 ") && !strcmp(eo_recording_unit(r, 2), "\xc2\xb5m"),
     "bytes that are not UTF-8 become it");
  ok(fill(r, 5000, &error) == EO_OK && eo_recording_rows(r) == 5000 && eo_recording_columns(r) == COLUMNS,
     "5000 rows are appended");
  ok(wrong_values(r) == 0, "the values of 5000 rows are kept");
  double row[COLUMNS];
  ok(eo_recording_read(r, 4999, 2, row, &error) == EO_ERROR_INPUT, "rows past the end are refused: %s", error.text);
  ok(eo_recording_read(r, -1, 1, row, &error) == EO_ERROR_INPUT, "rows before the start are refused");
  ok(eo_recording_read(r, 5000, 0, row, &error) == EO_OK, "no rows at the end are read");
  ok(eo_recording_length(r, 2) == 5000, "a column is as long as the table");
  eo_recording_set_length(r, 2, 4000);
  ok(eo_recording_length(r, 2) == 4000 && eo_recording_length(r, 1) == 5000, "a column may be shorter than the table");
  eo_recording_free(r);
  ok(eo_recording_new(&r, 0, NULL, &error) == EO_ERROR_INPUT, "a recording without columns is refused: %s", error.text);
  ok(eo_recording_new(&r, EO_RECORDING_COLUMNS + 1, NULL, &error) == EO_ERROR_INPUT,
     "a recording of too many columns is refused: %s", error.text);
  eo_recording_free(NULL);
}

static void test_lines(void)
{
  struct eo_error error;
  struct eo_recording *r = NULL;
  eo_recording_new(&r, COLUMNS, NULL, &error);
  fill(r, 2, &error);
  ok(eo_recording_line(r, 1) == 0, "a row has no line before one is stated");
  eo_recording_set_line(r, 12);
  fill(r, 100, &error);
  eo_recording_set_line(r, 112);
  fill(r, 10, &error);
  eo_recording_set_line(r, 130);
  fill(r, 10, &error);
  ok(eo_recording_line(r, 2) == 12 && eo_recording_line(r, 111) == 121, "the lines of rows count on");
  ok(eo_recording_line(r, 112) == 130 && eo_recording_line(r, 121) == 139,
     "the lines of rows count on after skipped ones");
  ok(eo_recording_line(r, 122) == 0 && eo_recording_line(r, -1) == 0, "a row outside has no line");
  for (int64_t line = 1000; line < 1000 + 400000; line += 2) {
    eo_recording_set_line(r, line);
    fill(r, 1, &error);
  }
  ok(eo_recording_line(r, 122 + 1000) == 3000, "the lines of rows count on after many skipped ones");
  ok(eo_recording_line(r, 122 + 199999) == 0, "the lines of rows are unknown after too many skipped ones");
  eo_recording_free(r);
}

static void test_large(const char *directory)
{
  struct eo_error error;
  struct eo_recording *r = NULL;
  int64_t rows = (int64_t)(EO_RECORDING_MEMORY / 8 / COLUMNS) * 2 + 12345;
  eo_recording_new(&r, COLUMNS, directory, &error);
  ok(fill(r, rows, &error) == EO_OK && eo_recording_rows(r) == rows,
     "%lld rows are appended, more than fit into memory", (long long)rows);
  pthread_t threads[2];
  void *wrong[2];
  for (int i = 0; i < 2; i++)
    pthread_create(&threads[i], NULL, read_in_thread, r);
  for (int i = 0; i < 2; i++)
    pthread_join(threads[i], &wrong[i]);
  ok(!wrong[0] && !wrong[1], "two threads read the same values");
  double block[4 * COLUMNS];
  int64_t border = (int64_t)(EO_RECORDING_MEMORY / 8 / COLUMNS) * 2;
  ok(!eo_recording_read(r, border - 2, 4, block, &error) && block[0] == value(border - 2, 0) &&
         block[11] == value(border + 1, 2),
     "a block is read half from the file and half from memory");
  eo_recording_free(r);
  ok(rmdir(directory) == 0, "a recording leaves nothing in the folder");
  eo_recording_new(&r, COLUMNS, directory, &error);
  ok(fill(r, rows, &error) == EO_ERROR_FILE, "a folder that is not there is refused: %s", error.text);
  eo_recording_free(r);
  eo_recording_new(&r, COLUMNS, NULL, &error);
  ok(fill(r, rows, &error) == EO_ERROR_INPUT, "a recording beyond memory is refused without a folder: %s", error.text);
  eo_recording_free(r);
}

int main(void)
{
  char directory[] = "/tmp/easeoff-recording-XXXXXX";
  if (!mkdtemp(directory))
    return 1;
  test_small();
  test_lines();
  test_large(directory);
  return tap_done();
}

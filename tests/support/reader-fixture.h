/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files for the tests of the readers, in a temporary folder that goes when the test ends. */
#ifndef EASEOFF_TESTS_SUPPORT_READER_FIXTURE_H
#define EASEOFF_TESTS_SUPPORT_READER_FIXTURE_H

#include "recording/reader.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char fixture_directory[64], fixture_path[96];

/* Makes the folder; every test writes its one file to fixture_path. */
__attribute__((unused)) static void fixture_open(void)
{
  snprintf(fixture_directory, sizeof fixture_directory, "/tmp/easeoff-reader-XXXXXX");
  if (!mkdtemp(fixture_directory))
    exit(99);
  snprintf(fixture_path, sizeof fixture_path, "%s/file", fixture_directory);
}

/* Ends the folder; readers must have left nothing in it. */
__attribute__((unused)) static int fixture_close(void)
{
  unlink(fixture_path);
  ok(rmdir(fixture_directory) == 0, "the readers left no file behind");
  return tap_done();
}

__attribute__((unused)) static void write_bytes(const void *bytes, size_t size)
{
  unlink(fixture_path); /* some file systems write a file that is cut and filled again to the disk at once */
  FILE *file = fopen(fixture_path, "wb");
  if (!file || fwrite(bytes, 1, size, file) != size || fclose(file))
    exit(99);
}

__attribute__((unused)) static void write_text(const char *text)
{
  write_bytes(text, strlen(text));
}

/* Reads the file; NULL on failure, with *error filled. */
__attribute__((unused)) static struct eo_recording *read_fixture(const struct eo_reader_options *options,
                                                                 struct eo_notes *notes, struct eo_error *error)
{
  struct eo_recording *recording = NULL;
  memset(error, 0, sizeof *error);
  enum eo_code code = eo_reader_read(fixture_path, options, &recording, notes, error);
  if ((code != EO_OK) != (recording == NULL) || error->code != code)
    exit(98);
  return recording;
}

__attribute__((unused)) static double cell_of(const struct eo_recording *r, int64_t row, int column)
{
  double values[EO_RECORDING_COLUMNS];
  struct eo_error error;
  return eo_recording_read(r, row, 1, values, &error) ? NAN : values[column];
}

/* The file is refused as wrong input, and the sentence holds the words. */
__attribute__((unused)) static int refused(const char *words, const char *what)
{
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int right = !r && error.code == EO_ERROR_INPUT && strstr(error.text, words);
  ok(right, "the reader refuses %s: %s", what, r ? "was read" : error.text);
  eo_recording_free(r);
  return right;
}

__attribute__((unused)) static int noted(const struct eo_notes *notes, const char *words)
{
  for (int i = 0; i < notes->count; i++)
    if (strstr(notes->text[i], words))
      return 1;
  return 0;
}

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any bytes as a rig file: an error with a sentence, or a recording whose columns can be looked at. For libFuzzer, and
   replayed by replay.c. */
#define _GNU_SOURCE
#include "recording/layout.h"
#include "recording/reader.h"
#include "fuzz/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  int file = memfd_create("fuzz", 0);
  if (file < 0 || write(file, bytes, size) != (ssize_t)size)
    abort();
  char path[64];
  snprintf(path, sizeof path, "/proc/%ld/fd/%d", (long)getpid(), file);
  struct eo_reader_options options = {.max_bytes = 32 << 20, .spool_directory = P_tmpdir};
  struct eo_recording *recording = NULL;
  struct eo_notes notes = {0};
  struct eo_error error = {0};
  enum eo_code code = eo_reader_read(path, &options, &recording, &notes, &error);
  if (code) {
    if (recording || code != error.code || !*error.text || strchr(error.text, '\n'))
      abort();
  } else {
    struct eo_layout_choice choice = {.sample_rate = 20000, .lines = {1024, 1024}};
    struct eo_tracks tracks;
    eo_layout_find(&recording, NULL, NULL, NULL, &tracks, &notes, &error);
    eo_layout_find(&recording, &choice, NULL, NULL, &tracks, &notes, &error);
  }
  eo_recording_free(recording);
  close(file);
  return 0;
}

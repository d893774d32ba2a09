/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a fuzz target over every file of a folder, and over each with its end cut off: replay FOLDER. A crash ends the
   test. */
#include "fuzz/fuzz.h"
#include "support/tap.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

static void replay(const char *folder, const char *name)
{
  static uint8_t bytes[1 << 20];
  char path[8192];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "rb");
  size_t size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
  if (file)
    fclose(file);
  uint8_t *copy = malloc(size ? size : 1); /* of exactly this size, so that reading past its end is seen */
  for (int part = 1; part <= 4; part++) {
    memcpy(copy, bytes, size);
    LLVMFuzzerTestOneInput(copy, size * (size_t)part / 4);
  }
  free(copy);
  ok(file != NULL, "%s, whole and cut", name);
}

int main(void)
{
  const char *sources = getenv("SOURCES");
  char folder[4096];
  snprintf(folder, sizeof folder, "%s/tests/fuzz/" CORPUS, sources ? sources : ".");
  struct dirent **names;
  int count = scandir(folder, &names, NULL, alphasort), files = 0;
  for (int i = 0; i < count; i++) {
    if (names[i]->d_name[0] != '.') {
      replay(folder, names[i]->d_name);
      files++;
    }
    free(names[i]);
  }
  if (count >= 0)
    free(names);
  ok(files > 0, "%d files of " CORPUS, files);
  return tap_done();
}

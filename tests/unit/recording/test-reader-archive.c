/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Zip and tar files. */
#include "support/archive-fixture.h"

/* Puts the archive that is being made into a new one. */
static void nest(const char *name)
{
  static unsigned char inner[sizeof bytes];
  size_t length = end_archive();
  memcpy(inner, bytes, length);
  add_bytes(name, inner, length);
}

/* A file of a tape archive, behind what is there. */
static void add_tar(const char *name, const char *content)
{
  unsigned char *block = bytes + size;
  unsigned sum = 8 * ' ';
  memset(block, 0, 512 + (strlen(content) + 511) / 512 * 512 + 1024);
  snprintf((char *)block, 100, "%s", name);
  memcpy(block + 100, "0000644", 7);
  snprintf((char *)block + 124, 12, "%011o", (unsigned)strlen(content));
  block[156] = '0';
  memcpy(block + 257, "ustar\00000", 8);
  for (int i = 0; i < 512; i++)
    sum += block[i];
  snprintf((char *)block + 148, 8, "%06o", sum);
  memcpy(block + 512, content, strlen(content));
  size += 512 + (strlen(content) + 511) / 512 * 512;
}

static void test_zip(void)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  add("run/data.csv", "t;a\n0;1.5\n1;2.5\n2;3.5\n");
  add("__MACOSX/._data.csv", "x");
  finish();
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == 3.5 && noted(&notes, "run/data.csv"),
     "one file in a zip is read%s", r ? "" : error.text);
  eo_recording_free(r);
  add("README.txt", "Recorded on the rig in March.\n");
  add("pinion.csv", "t;deg\n0;1.5\n1;2.5\n2;3.5\n");
  add("gear.csv", "t;deg\n0.5;1\n1.5;2\n2.5;3\n3.5;4\n");
  finish();
  memset(&notes, 0, sizeof notes);
  r = take(&notes, &error);
  ok(r && eo_recording_columns(r) == 4 && eo_recording_rows(r) == 4 && isnan(cell_of(r, 3, 1)) &&
         cell_of(r, 3, 3) == 4 && strstr(eo_recording_name(r, 1), "pinion") &&
         strstr(eo_recording_name(r, 3), "gear") && eo_recording_clock(r, 3).column == 2 &&
         eo_recording_length(r, 1) == 3,
     "a file for each channel is read side by side, each with its times%s", r ? "" : error.text);
  ok(noted(&notes, "\"README.txt\" in the archive was left out") && noted(&notes, "do not all state when they began"),
     "a note says what was left out, and that each file may count from its own start");
  eo_recording_free(r);
  for (int run = 0; run < 2; run++) {
    char text[4096] = "t;pinion;gear\n", *end = text + strlen(text);
    for (int i = 0; i < 40; i++)
      end += sprintf(end, "%d;%d;%d\n", i, 44 * i + i % 3, 17 * i + i % 2);
    add(run ? "run2.csv" : "run1.csv", text);
  }
  finish();
  refuse("run1 (40 rows), run2 (40 rows)", "two recordings in a zip");
  add("t.npy", "x");
  finish();
  refuse("NumPy", "an archive of arrays");
  add("a.csv", "1;2\n3;4\n");
  finish();
  FILE *file = fopen(fixture_path, "r+");
  if (!file || fseek(file, 40, SEEK_SET) || fputc('9', file) == EOF || fclose(file))
    exit(99);
  refuse("cannot be read", "a wrong check sum");
}

static void is_run(const char *what)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == 3.5 && noted(&notes, "data.csv"),
     "the run is read from %s%s", what, r ? "" : error.text);
  eo_recording_free(r);
}

static void test_inner(void)
{
  static const char run[] = "t;a\n0;1.5\n1;2.5\n2;3.5\n";
  add("data.csv", run);
  nest("run.zip");
  finish();
  is_run("a zip in a zip");
  add("data.csv", run);
  nest("a.zip");
  nest("b.zip");
  finish();
  refuse("in an archive in an archive", "a zip in a zip in a zip");
  add_tar("folder/data.csv", run);
  write_bytes(bytes, size + 1024);
  is_run("a tar file");
  gzFile file = gzopen(fixture_path, "wb");
  if (!file || gzwrite(file, bytes, (unsigned)size + 1024) <= 0 || gzclose(file))
    exit(99);
  is_run("a tar file in gzip");
  bytes[148] ^= 1;
  write_bytes(bytes, size + 1024);
  size = 0;
  refuse("no known kind", "a tar file whose heading is damaged");
  add_tar("pinion.csv", "t;deg\n0;1.5\n1;2.5\n2;3.5\n");
  add_tar("gear.csv", "t;deg\n0;1\n1;2\n2;3\n");
  write_bytes(bytes, size + 1024);
  size = 0;
  struct eo_error error;
  struct eo_recording *r = take(NULL, &error);
  ok(r && eo_recording_columns(r) == 4 && cell_of(r, 2, 1) == 3.5 && cell_of(r, 2, 3) == 3,
     "a file for each channel in a tar file is read%s", r ? "" : error.text);
  eo_recording_free(r);
}

static void test_names(void)
{
  static const char *const kinds[][2] = {{"PAR1", "Parquet"},          {"FEA1", "Feather"},
                                         {"\x93NUMPY", "NumPy"},       {"|CF,2,1,1;", "imc FAMOS"},
                                         {"RIFF....WAVE", "WAV"},      {"SQLite format 3", "SQLite"},
                                         {"ARROW1", "Arrow"},          {"7z\xbc\xaf", "7z"},
                                         {"DEWESoft raw", "DEWESoft"}, {"DXD of version 7", "DEWESoft"}};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    write_text(kinds[i][0]);
    refuse(kinds[i][1], "a kind that is not read");
  }
}

int main(void)
{
  fixture_open();
  test_zip();
  test_inner();
  test_names();
  return fixture_close();
}

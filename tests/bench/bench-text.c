/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast and in how much memory text is read: bench-text [MB [FOLDER]]. Writes a file of that size there, reads it,
   removes it. */
#include "recording/reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

static double now(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double write_rows(const char *path, const char *format, double size)
{
  FILE *file = fopen(path, "w");
  if (!file)
    return 0;
  char block[1 << 17];
  int length = 0;
  fputs("t_s,angle1_deg,angle2_deg\n", file);
  for (long row = 0; row < 1000; row++) {
    double t = (double)row * 5e-5;
    length += snprintf(block + length, sizeof block - (size_t)length, format, t, 360 * 33.3 * t + 17.15407647,
                       360 * 12.9 * t + 63.02719913);
  }
  double written = 0;
  while (written < size && fwrite(block, 1, (size_t)length, file) == (size_t)length)
    written += length;
  return fclose(file) ? 0 : written;
}

static void measure(const char *path, const char *directory, const char *what, const char *format, double size)
{
  double written = write_rows(path, format, size);
  struct eo_reader_options options = {.spool_directory = directory};
  struct eo_recording *recording = NULL;
  struct eo_error error;
  double start = now(CLOCK_MONOTONIC), start_cpu = now(CLOCK_THREAD_CPUTIME_ID);
  if (eo_reader_read(path, &options, &recording, NULL, &error))
    printf("%s: %s\n", what, error.text);
  double wall = now(CLOCK_MONOTONIC) - start, cpu = now(CLOCK_THREAD_CPUTIME_ID) - start_cpu;
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  printf("%-28s %6.0f MB, %9lld rows: %5.0f MB/s (%5.0f MB/s of the processor), at most %4ld MB of memory\n", what,
         written * 1e-6, recording ? (long long)eo_recording_rows(recording) : 0, written * 1e-6 / wall,
         written * 1e-6 / cpu, usage.ru_maxrss / 1024);
  fflush(stdout);
  eo_recording_free(recording);
  unlink(path);
}

int main(int count, char **word)
{
  double size = (count > 1 ? atof(word[1]) : 100) * 1e6;
  const char *directory = count > 2 ? word[2] : "/tmp";
  char path[4096];
  snprintf(path, sizeof path, "%s/bench-text-%ld.csv", directory, (long)getpid());
  measure(path, directory, "8 decimals, commas", "%.6f,%.8f,%.8f\n", size);
  measure(path, directory, "19 digits, exponents, blanks", "%.18e %.18e %.18e\n", size);
  measure(path, directory, "17 digits, tabs", "%.17g\t%.17g\t%.17g\n", size);
  return 0;
}

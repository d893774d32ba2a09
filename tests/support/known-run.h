/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run of two encoders whose angles are known at every time, for tests that write it to files of many kinds. */
#ifndef EASEOFF_TESTS_SUPPORT_KNOWN_RUN_H
#define EASEOFF_TESTS_SUPPORT_KNOWN_RUN_H

#include "recording/layout.h"
#include "support/reader-fixture.h"

#define ROWS 4000
#define SPEED 62.8 /* of the pinion, rad/s */

static const struct eo_layout_pair pair = {.teeth = {17, 44}, .speed = {209.44, 209.44}};

__attribute__((unused)) static double pinion(double t)
{
  return 0.3 + SPEED * t + 1e-3 * sin(SPEED * t);
}

__attribute__((unused)) static double gear(double t)
{
  return 1.1 + SPEED * 17 / 44 * t + 1e-4 * sin(17 * SPEED * t);
}

__attribute__((unused)) static double degrees(double angle)
{
  return angle * 180 / M_PI;
}

__attribute__((unused)) static FILE *begin(const char *header)
{
  FILE *file = fopen(fixture_path, "w");
  if (!file)
    exit(99);
  fputs(header, file);
  return file;
}

/* Reads the file that was written and finds its layout; NULL on an error. */
__attribute__((unused)) static struct eo_recording *find(FILE *file, const struct eo_layout_choice *choice,
                                                         struct eo_tracks *tracks, struct eo_notes *notes,
                                                         struct eo_error *error)
{
  fclose(file);
  memset(notes, 0, sizeof *notes);
  struct eo_recording *r = read_fixture(NULL, notes, error);
  if (r && eo_layout_find(&r, choice, &pair, NULL, tracks, notes, error)) {
    eo_recording_free(r);
    return NULL;
  }
  return r;
}

/* The largest difference, in rad, between what a row gives and the two functions at its time. */
__attribute__((unused)) static double worst(const struct eo_recording *r, const struct eo_tracks *t)
{
  double most = 0, shift[2] = {0, 0};
  for (int64_t i = 0; i < eo_recording_rows(r); i++) {
    double time = t->time_column < 0 ? (double)i * t->interval : cell_of(r, i, t->time_column) * t->time_scale;
    double angle[2] = {pinion(time), gear(time)};
    for (int m = 0; m < 2; m++) {
      double value = cell_of(r, i, t->channel[m].column[0]) * t->channel[m].scale - angle[m];
      if (i == 0)
        shift[m] = value;
      most = isnan(value) ? most : fmax(most, fabs(value - shift[m]));
    }
  }
  return most;
}

/* The angles come out at their times, with this note (NULL: none is looked for). */
__attribute__((unused)) static void right(FILE *file, const struct eo_layout_choice *choice, double tolerance,
                                          const char *note, const char *what)
{
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  struct eo_recording *r = find(file, choice, &tracks, &notes, &error);
  double most = r ? worst(r, &tracks) : NAN;
  ok(r && eo_recording_rows(r) > ROWS / 2 && most < tolerance && (!note || noted(&notes, note)),
     "%s: the angles come out to %.2g rad%s%s", what, most, r ? "" : ": ", r ? "" : error.text);
  eo_recording_free(r);
}

/* Reading or laying out is refused at this key, in these words. */
__attribute__((unused)) static void asked(FILE *file, const struct eo_layout_choice *choice, const char *pointer,
                                          const char *words, const char *what)
{
  struct eo_tracks tracks;
  struct eo_notes notes;
  struct eo_error error = {0};
  struct eo_recording *r = find(file, choice, &tracks, &notes, &error);
  ok(!r && !strcmp(error.pointer, pointer) && strstr(error.text, words), "the layout asks about %s: %s %s", what,
     r ? "was found" : error.pointer, r ? "" : error.text);
  eo_recording_free(r);
}

#endif

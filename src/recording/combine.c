/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two recordings of one run are put side by side, each column with the clock of its file. */
#include "recording/layout_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 4096

static const char *const member_names[2] = {"pinion", "gear"};

struct pair {
  const struct eo_recording *side[2];
  int columns[2];
  int64_t rows[2];
  int time[2]; /* column of the times in each file; -1: none */
};

static enum eo_code look_for_time(struct eo_guess *guess, const char *chosen, int *column, struct eo_error *error)
{
  for (int c = 0; c < guess->columns; c++)
    EO_TRY(eo_column_look(guess->recording, c, &guess->look[c], error));
  if (chosen)
    return strcmp(chosen, "none") ? eo_layout_chosen(guess, chosen, "/time", column, error) : EO_OK;
  if (guess->columns <= 1 || guess->choice->sample_rate > 0)
    return EO_OK;
  eo_layout_mark_times(guess);
  *column = eo_layout_pick_time(guess, guess->columns - 1);
  if (*column < 0 && !(eo_recording_clock(guess->recording, 0).interval > 0) && guess->look[0].spread < 1e-3 &&
      guess->look[0].step > 0 && !guess->look[0].resets && !guess->number[0])
    *column = 0; /* the first of two columns */
  return EO_OK;
}

/* The column of times in one file, as chosen or found. */
static enum eo_code find_time(const struct eo_recording *recording, const struct eo_layout_choice *choice,
                              const char *chosen, int *column, struct eo_error *error)
{
  static const struct eo_layout_choice none;
  struct eo_guess *guess = calloc(1, sizeof *guess);
  *column = -1;
  if (!guess)
    return eo_error_memory(error);
  guess->recording = recording;
  guess->choice = choice ? choice : &none;
  guess->columns = eo_recording_columns(recording);
  enum eo_code code = look_for_time(guess, chosen, column, error);
  free(guess);
  return code;
}

/* Names, units, lengths and clocks of one file's columns. */
static void describe(const struct pair *pair, int side, struct eo_recording *out)
{
  const struct eo_recording *recording = pair->side[side];
  int base = side ? pair->columns[0] : 0;
  for (int c = 0; c < pair->columns[side]; c++) {
    char name[EO_RECORDING_NAME + 16];
    struct eo_clock clock = eo_recording_clock(recording, c);
    const char *unit = eo_recording_unit(recording, c);
    bool pulses = pair->columns[side] == 1 && !(clock.interval > 0);
    if (clock.column < 0 && c != pair->time[side])
      clock.column = pair->time[side];
    clock.column += clock.column < 0 ? 0 : base;
    snprintf(name, sizeof name, "%.40s%s%s", eo_recording_name(recording, c),
             *eo_recording_name(recording, c) ? " " : "", member_names[side]);
    eo_recording_set_column(out, base + c, name, pulses && !*unit ? "s" : unit);
    eo_recording_set_length(out, base + c, eo_recording_length(recording, c));
    eo_recording_set_clock(out, base + c, &clock);
    eo_recording_set_turn(out, base + c, eo_recording_turn(recording, c));
    if (eo_recording_tick(recording) > 0)
      eo_recording_set_tick(out, eo_recording_tick(recording));
  }
}

static enum eo_code copy_rows(const struct pair *pair, struct eo_recording *out, struct eo_error *error)
{
  int columns = pair->columns[0] + pair->columns[1], base = 0;
  int64_t most = pair->rows[0] > pair->rows[1] ? pair->rows[0] : pair->rows[1];
  double *rows = malloc(BLOCK * (size_t)columns * sizeof *rows),
         *block = malloc(BLOCK * (size_t)columns * sizeof *block);
  enum eo_code code = rows && block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < most; first += BLOCK) {
    int64_t n = most - first < BLOCK ? most - first : BLOCK;
    base = 0;
    for (int s = 0; s < 2 && !code; s++) {
      int64_t left = pair->rows[s] - first, got = left < 0 ? 0 : left < n ? left : n;
      if (got)
        code = eo_recording_read(pair->side[s], first, got, block, error);
      for (int64_t i = 0; i < n; i++)
        for (int c = 0; c < pair->columns[s]; c++)
          rows[i * columns + base + c] = i < got ? block[i * pair->columns[s] + c] : NAN;
      base += pair->columns[s];
    }
    if (!code)
      code = eo_recording_append(out, rows, n, error);
  }
  free(rows);
  free(block);
  return code;
}

static int64_t epoch_of(const struct pair *pair, int side)
{
  return eo_recording_clock(pair->side[side], pair->time[side] >= 0 ? pair->time[side] : 0).epoch;
}

static bool is_pulses(const struct pair *pair)
{
  return pair->columns[0] == 1 && pair->columns[1] == 1 && !(eo_recording_clock(pair->side[0], 0).interval > 0);
}

/* What the clocks of the two files have to do with each other. */
static void note_clocks(const struct pair *pair, struct eo_notes *notes)
{
  bool stated = epoch_of(pair, 0) != EO_CLOCK_NO_EPOCH && epoch_of(pair, 1) != EO_CLOCK_NO_EPOCH;
  if (stated)
    eo_notes_add(notes, "The gear's file began %.9g s after the pinion's, as the files state.",
                 (double)(epoch_of(pair, 1) - epoch_of(pair, 0)) * 1e-9);
  else
    eo_notes_add(
        notes, "The two files do not both state when they began: their times are taken for those of one clock. If each "
               "counts from its own start, the phase between the encoders is unknown and the result is wrong.");
}

enum eo_code eo_layout_combine(const struct eo_recording *pinion, const struct eo_recording *gear,
                               const struct eo_layout_choice *choice, const char *spool_directory,
                               struct eo_recording **combined, struct eo_notes *notes, struct eo_error *error)
{
  struct pair pair = {.side = {pinion, gear}};
  struct eo_recording *out = NULL;
  enum eo_code code = EO_OK;
  for (int s = 0; s < 2 && !code; s++) {
    const char *chosen = !choice ? NULL : s && choice->gear_time ? choice->gear_time : choice->time;
    pair.columns[s] = eo_recording_columns(pair.side[s]);
    pair.rows[s] = eo_recording_rows(pair.side[s]);
    code = find_time(pair.side[s], choice, chosen, &pair.time[s], error);
  }
  if (!code)
    code = eo_recording_new(&out, pair.columns[0] + pair.columns[1], spool_directory, error);
  if (!code)
    code = copy_rows(&pair, out, error);
  if (code) {
    eo_recording_free(out);
    return code;
  }
  describe(&pair, 0, out);
  describe(&pair, 1, out);
  if (!is_pulses(&pair))
    note_clocks(&pair, notes);
  *combined = out;
  return EO_OK;
}

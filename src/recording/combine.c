/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two recordings of one run are put side by side, each column with the clock of its file. */
#include "recording/layout_private.h"
#include "gear/names.h"
#include "recording/tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct pair {
  const struct eo_recording *side[2];
  int time[2]; /* column of the times in each file; -1: none */
};

static enum eo_code chosen_time(const struct eo_recording *recording, const char *chosen, int *column,
                                struct eo_error *error)
{
  struct eo_guess *guess = calloc(1, sizeof *guess);
  if (!guess)
    return eo_error_memory(error);
  guess->recording = recording;
  guess->columns = eo_recording_columns(recording);
  enum eo_code code = eo_layout_chosen(guess, chosen, "/time", column, error);
  free(guess);
  return code;
}

/* The column of times in one file, as chosen or found. */
static enum eo_code find_time(const struct eo_recording *recording, const struct eo_layout_choice *choice,
                              const char *chosen, int *column, struct eo_error *error)
{
  *column = -1;
  if (chosen)
    return strcmp(chosen, "none") ? chosen_time(recording, chosen, column, error) : EO_OK;
  if (choice && choice->sample_rate > 0)
    return EO_OK;
  return eo_tables_find_time(recording, column, error);
}

static int64_t epoch_of(const struct pair *pair, int side)
{
  return eo_recording_clock(pair->side[side], pair->time[side] >= 0 ? pair->time[side] : 0).epoch;
}

static bool is_pulses(const struct pair *pair)
{
  return eo_recording_columns(pair->side[0]) == 1 && eo_recording_columns(pair->side[1]) == 1 &&
         !(eo_recording_clock(pair->side[0], 0).interval > 0);
}

/* A file of one column without a rate holds times of pulses. */
static void name_pulses(const struct pair *pair, struct eo_recording *combined)
{
  for (int s = 0, base = 0; s < 2; base += eo_recording_columns(pair->side[s++])) {
    char name[EO_RECORDING_NAME];
    bool alone = eo_recording_columns(pair->side[s]) == 1 && !(eo_recording_clock(pair->side[s], 0).interval > 0);
    if (!alone || *eo_recording_unit(combined, base))
      continue;
    snprintf(name, sizeof name, "%s", eo_recording_name(combined, base));
    eo_recording_set_column(combined, base, name, "s");
  }
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
  for (int s = 0; s < 2; s++) {
    const char *chosen = !choice ? NULL : s && choice->gear_time ? choice->gear_time : choice->time;
    EO_TRY(find_time(pair.side[s], choice, chosen, &pair.time[s], error));
  }
  EO_TRY(eo_tables_beside(pair.side, eo_member_name, pair.time, 2, spool_directory, combined, error));
  name_pulses(&pair, *combined);
  if (!is_pulses(&pair))
    note_clocks(&pair, notes);
  return EO_OK;
}

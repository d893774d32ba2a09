/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/tables.h"
#include "recording/compound.h"
#include "recording/layout_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 4096

void eo_tables_free(struct eo_tables *tables)
{
  for (int i = 0; i < tables->count; i++)
    eo_recording_free(tables->table[i].recording);
  tables->count = 0;
}

/* Columns of one side: names, units, lengths and clocks. */
static void describe(const struct eo_recording *side, const char *label, int time, int base, struct eo_recording *out)
{
  int columns = eo_recording_columns(side);
  for (int c = 0; c < columns; c++) {
    char name[2 * EO_RECORDING_NAME];
    struct eo_clock clock = eo_recording_clock(side, c);
    const char *own = eo_recording_name(side, c);
    if (clock.column < 0 && c != time)
      clock.column = time;
    clock.column += clock.column < 0 ? 0 : base;
    snprintf(name, sizeof name, "%.40s%s%s", own, *own && *label ? " " : "", label);
    eo_recording_set_column(out, base + c, name, eo_recording_unit(side, c));
    eo_recording_set_length(out, base + c, eo_recording_length(side, c));
    eo_recording_set_clock(out, base + c, &clock);
    eo_recording_set_turn(out, base + c, eo_recording_turn(side, c));
    if (eo_recording_tick(side) > 0)
      eo_recording_set_tick(out, eo_recording_tick(side));
  }
}

struct pasting {
  const struct eo_recording *const *side;
  int count, columns;
  double *rows, *block; /* [BLOCK][columns] */
};

static enum eo_code paste_block(const struct pasting *pasting, int64_t first, int64_t n, struct eo_recording *out,
                                struct eo_error *error)
{
  for (int s = 0, base = 0; s < pasting->count; s++) {
    int own = eo_recording_columns(pasting->side[s]);
    int64_t left = eo_recording_rows(pasting->side[s]) - first, got = left < 0 ? 0 : left < n ? left : n;
    if (got)
      EO_TRY(eo_recording_read(pasting->side[s], first, got, pasting->block, error));
    for (int64_t i = 0; i < n; i++)
      for (int c = 0; c < own; c++)
        pasting->rows[i * pasting->columns + base + c] = i < got ? pasting->block[i * own + c] : NAN;
    base += own;
  }
  return eo_recording_append(out, pasting->rows, n, error);
}

static enum eo_code paste(struct pasting *pasting, struct eo_recording *out, struct eo_error *error)
{
  int64_t most = 0;
  for (int s = 0; s < pasting->count; s++)
    most = eo_recording_rows(pasting->side[s]) > most ? eo_recording_rows(pasting->side[s]) : most;
  pasting->rows = malloc(BLOCK * (size_t)pasting->columns * sizeof *pasting->rows);
  pasting->block = malloc(BLOCK * (size_t)pasting->columns * sizeof *pasting->block);
  enum eo_code code = pasting->rows && pasting->block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < most; first += BLOCK)
    code = paste_block(pasting, first, most - first < BLOCK ? most - first : BLOCK, out, error);
  free(pasting->rows);
  free(pasting->block);
  return code;
}

enum eo_code eo_tables_beside(const struct eo_recording *const *side, const char *const *label, const int *time,
                              int count, const char *spool_directory, struct eo_recording **joined,
                              struct eo_error *error)
{
  struct pasting pasting = {.side = side, .count = count};
  struct eo_recording *out = NULL;
  for (int s = 0; s < count; s++)
    pasting.columns += eo_recording_columns(side[s]);
  enum eo_code code = eo_recording_new(&out, pasting.columns, spool_directory, error);
  if (!code)
    code = paste(&pasting, out, error);
  if (code) {
    eo_recording_free(out);
    return code;
  }
  for (int s = 0, base = 0; s < count; base += eo_recording_columns(side[s++]))
    describe(side[s], label[s], time[s], base, out);
  *joined = out;
  return EO_OK;
}

/* What a table may hold of the encoders: columns that turn and are no times; time: its column of times, looked for
   where it is -1. */
static enum eo_code look_at(struct eo_guess *guess, int *time, int *turning, struct eo_error *error)
{
  *turning = 0;
  for (int c = 0; c < guess->columns; c++)
    EO_TRY(eo_column_look(guess->recording, c, &guess->look[c], error));
  if (guess->columns > 1 && *time < 0) {
    eo_layout_mark_times(guess);
    *time = eo_layout_pick_time(guess, guess->columns - 1);
    if (*time < 0 && !(eo_recording_clock(guess->recording, 0).interval > 0) && guess->look[0].spread < 1e-3 &&
        guess->look[0].step > 0 && !guess->look[0].resets && !guess->number[0])
      *time = 0; /* the first of two columns */
  }
  for (int c = 0; c < guess->columns; c++) {
    enum eo_quantity quantity = guess->look[c].quantity;
    *turning += c != *time && !guess->time[c] && !guess->number[c] && eo_layout_turns(&guess->look[c]) &&
                (quantity == EO_QUANTITY_NONE || quantity == EO_QUANTITY_ANGLE || quantity == EO_QUANTITY_COUNT);
  }
  return EO_OK;
}

static enum eo_code survey(const struct eo_recording *recording, int *time, int *turning, struct eo_error *error)
{
  static const struct eo_layout_choice none;
  struct eo_guess *guess = calloc(1, sizeof *guess);
  if (!guess)
    return eo_error_memory(error);
  guess->recording = recording;
  guess->choice = &none;
  guess->columns = eo_recording_columns(recording);
  enum eo_code code = look_at(guess, time, turning, error);
  free(guess);
  return code;
}

enum eo_code eo_tables_find_time(const struct eo_recording *recording, int *column, struct eo_error *error)
{
  int turning;
  *column = -1;
  return survey(recording, column, &turning, error);
}

/* The last column that is not called a time: times may stand before the values or behind them. */
static int value_column(const struct eo_recording *recording)
{
  double factor;
  int last = eo_recording_columns(recording) - 1, c = last;
  while (c >= 0 && (eo_column_named(eo_recording_name(recording, c), EO_CLOCK_WORDS) ||
                    eo_unit_find(eo_recording_unit(recording, c), &factor) == EO_QUANTITY_TIME))
    c--;
  return c < 0 ? last : c;
}

/* Tables of two columns without names: where the second ones go on alike and the first ones do not, the values stand
   before their times. *behind: there are such. */
static enum eo_code find_times_behind(const struct eo_tables *tables, bool *behind, struct eo_error *error)
{
  static const double ALIKE = 1e-3; /* relative; the speeds of two encoders differ by more */
  struct eo_column look[2][2];
  *behind = false;
  for (int i = 0; i < 2; i++) {
    const struct eo_recording *recording = tables->table[i].recording;
    if (tables->count != 2 || eo_recording_columns(recording) != 2 || *eo_recording_name(recording, 0) ||
        *eo_recording_name(recording, 1))
      return EO_OK;
    for (int c = 0; c < 2; c++)
      EO_TRY(eo_column_look(recording, c, &look[i][c], error));
  }
  bool alike[2];
  for (int c = 0; c < 2; c++)
    alike[c] = look[0][c].step > 0 && fabs(look[1][c].step / look[0][c].step - 1) < ALIKE && !look[0][c].resets;
  *behind = alike[1] && !alike[0];
  return EO_OK;
}

/* A unit that the table states for its values, beside them or in its own name. */
static void set_unit(struct eo_table *table, bool time_behind)
{
  char name[EO_RECORDING_NAME], unit[EO_RECORDING_UNIT];
  struct eo_recording *recording = table->recording;
  int last = time_behind ? 0 : value_column(recording);
  eo_unit_split(table->label, name, (int)sizeof name, unit, (int)sizeof unit);
  if (*eo_recording_unit(recording, last))
    return;
  snprintf(name, sizeof name, "%s", eo_recording_name(recording, last));
  if (*table->unit)
    memcpy(unit, table->unit, sizeof unit);
  eo_recording_set_column(recording, last, name, unit);
}

static enum eo_code several_pairs(const struct eo_tables *tables, const int *turning, struct eo_error *error)
{
  char list[160] = "";
  for (int i = 0; i < tables->count; i++) {
    size_t used = strlen(list);
    if (turning[i] > 1)
      snprintf(list + used, sizeof list - used, "%s%.40s (%lld rows)", used ? ", " : "",
               *tables->table[i].label ? tables->table[i].label : "one without a name",
               (long long)eo_recording_rows(tables->table[i].recording));
  }
  return eo_error_set(
      error, EO_ERROR_INPUT, "",
      "Several tables hold columns of both encoders: %s. Which of them is meant cannot be known; give a "
      "file with that one alone.",
      list);
}

/* The only table, or the only one with both encoders; -1: there is none. */
static int choose(const struct eo_tables *tables, const int *turning, int *pairs)
{
  int chosen = tables->count == 1 ? 0 : -1;
  *pairs = 0;
  for (int i = 0; i < tables->count; i++)
    if (turning[i] > 1)
      chosen = i, ++*pairs;
  return chosen;
}

static void note_join(const struct eo_tables *tables, int chosen, struct eo_notes *notes)
{
  char list[160] = "";
  for (int i = 0; i < tables->count; i++) {
    size_t used = strlen(list);
    if (i != chosen && used < sizeof list)
      snprintf(list + used, sizeof list - used, "%s\"%.40s\"", used ? ", " : "", tables->table[i].label);
  }
  if (chosen >= 0)
    eo_notes_add(notes, "Of %d tables \"%.60s\" alone has both encoders; left out: %.120s.", tables->count,
                 tables->table[chosen].label, list);
  else
    eo_notes_add(notes, "%d tables stand side by side: %.180s.", tables->count, list);
}

/* Files may each count from their own start. */
static void note_starts(const struct eo_tables *tables, const int *time, struct eo_notes *notes)
{
  for (int i = 0; i < tables->count; i++)
    if (eo_recording_clock(tables->table[i].recording, time[i] < 0 ? 0 : time[i]).epoch == EO_CLOCK_NO_EPOCH) {
      eo_notes_add(notes, "The files do not all state when they began: their times are taken for those of one clock. "
                          "If each counts from its own start, the phase between the encoders is unknown and the "
                          "result is wrong.");
      return;
    }
}

static enum eo_code join(struct eo_tables *tables, const char *spool_directory, struct eo_recording **joined,
                         struct eo_notes *notes, struct eo_error *error)
{
  int time[EO_TABLES], turning[EO_TABLES], pairs, chosen;
  const struct eo_recording *side[EO_TABLES];
  const char *label[EO_TABLES];
  bool behind = false;
  for (int i = 0; i < tables->count && tables->count > 1; i++)
    EO_TRY(eo_compound_join(&tables->table[i].recording, spool_directory, i ? NULL : notes, error));
  if (tables->count > 1)
    EO_TRY(find_times_behind(tables, &behind, error));
  for (int i = 0; i < tables->count; i++) {
    if (tables->count > 1)
      set_unit(&tables->table[i], behind);
    time[i] = behind ? 1 : -1;
    EO_TRY(survey(tables->table[i].recording, &time[i], &turning[i], error));
    side[i] = tables->table[i].recording;
    label[i] = tables->table[i].label;
  }
  chosen = choose(tables, turning, &pairs);
  if (tables->count > 1 && pairs > 1)
    return several_pairs(tables, turning, error);
  if (tables->count > 1)
    note_join(tables, chosen, notes);
  if (chosen < 0 && tables->files)
    note_starts(tables, time, notes);
  if (chosen < 0)
    return eo_tables_beside(side, label, time, tables->count, spool_directory, joined, error);
  *joined = tables->table[chosen].recording;
  tables->table[chosen].recording = NULL;
  return EO_OK;
}

enum eo_code eo_tables_join(struct eo_tables *tables, const char *spool_directory, struct eo_recording **joined,
                            struct eo_notes *notes, struct eo_error *error)
{
  enum eo_code code = join(tables, spool_directory, joined, notes, error);
  eo_tables_free(tables);
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns that hold one number in all rows: facts that a program wrote beside each row. */
#include "recording/layout_private.h"
#include "recording/series.h"
#include "recording/stated.h"

static const double SHORTEST = 1e-7, LONGEST = 0.02; /* s between rows of an encoder; others are of something else */

enum { LOOKS = 64 }; /* rows behind those that were looked at */

/* True when rows spread over all of the column hold the number, too. */
static bool stays(const struct eo_recording *recording, int column, double value)
{
  double row[EO_RECORDING_COLUMNS];
  struct eo_error error;
  int64_t last = eo_recording_length(recording, column) - 1;
  for (int i = 0; i <= LOOKS; i++)
    if (eo_recording_read(recording, last * i / LOOKS, 1, row, &error) || row[column] != value)
      return false;
  return true;
}

static void state_clock(struct eo_recording *recording, int column, const struct eo_stated *stated)
{
  struct eo_clock clock = eo_recording_clock(recording, column);
  if (clock.column >= 0 || stated->value < SHORTEST || stated->value > LONGEST)
    return;
  eo_series_tell(&clock, stated);
  eo_recording_set_clock(recording, column, &clock);
}

static void state_turn(struct eo_recording *recording, int column, const struct eo_stated *stated)
{
  int member = eo_stated_member(eo_recording_name(recording, column));
  if ((stated->member < 0 || member < 0 || stated->member == member) && !(eo_recording_turn(recording, column) > 0))
    eo_recording_set_turn(recording, column, stated->value);
}

void eo_layout_read_constants(const struct eo_guess *guess, struct eo_recording *recording)
{
  for (int c = 0; c < guess->columns; c++) {
    const struct eo_column *look = &guess->look[c];
    if (look->count < 2 || look->low != look->high)
      continue;
    struct eo_stated stated = eo_stated_read(eo_recording_name(recording, c), look->low,
                                             eo_recording_unit(recording, c));
    bool known = (stated.kind == EO_STATED_INTERVAL || (stated.kind == EO_STATED_TURN && !stated.vague)) &&
                 stays(recording, c, look->low);
    for (int k = 0; known && k < guess->columns; k++)
      if (k != c && stated.kind == EO_STATED_INTERVAL)
        state_clock(recording, k, &stated);
      else if (k != c)
        state_turn(recording, k, &stated);
    if (known)
      eo_notes_add(guess->notes, "Column \"%.40s\" holds %.9g in all rows: read as a fact about them.",
                   eo_recording_name(recording, c), look->low);
  }
}

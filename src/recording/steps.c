/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/steps.h"

#define STEP_WORDS "dt|δt|Δt|∆t"
#define DIFFERENCE_WORDS "delta|diff|difference|differenz|step|increment|interval|intervall|schritt|Δ|∆|since"
#define PERIOD_WORDS "period|periods|periode|periodendauer|periodo|abstand"
#define TIME_WORDS "t|time|times|zeit|temps|tiempo|tempo"

/* Values that neither fall below 0 nor go on. */
static bool may_be_steps(const struct eo_column *look)
{
  return look->count > 1 && look->low >= 0 && look->high > 0 && look->rises < look->count * 3 / 4;
}

static bool has_clock(const struct eo_recording *recording, int column)
{
  struct eo_clock clock = eo_recording_clock(recording, column);
  return clock.interval > 0 || clock.column >= 0;
}

/* Columns of periods or intervals and of nothing else: of the pulses of both encoders, each the time since the one
   before, in a unit of time or in ticks of a stated clock. */
static bool holds_periods(const struct eo_recording *recording, const struct eo_column *look)
{
  bool periods = eo_recording_columns(recording) == 2, ticks = eo_recording_tick(recording) > 0;
  for (int c = 0; c < 2 && periods; c++) {
    enum eo_quantity quantity = look[c].quantity;
    bool time = quantity == EO_QUANTITY_TIME ||
                (ticks && (quantity == EO_QUANTITY_COUNT || quantity == EO_QUANTITY_NONE));
    periods = time && eo_column_named(eo_recording_name(recording, c), DIFFERENCE_WORDS "|" PERIOD_WORDS) &&
              may_be_steps(&look[c]) && !has_clock(recording, c);
  }
  return periods;
}

/* Times below each other, of which each is one step after the last. */
static bool holds_steps(const char *name, const struct eo_column *look)
{
  bool time = look->quantity == EO_QUANTITY_TIME || eo_column_named(name, TIME_WORDS);
  bool named = eo_column_named(name, STEP_WORDS) || (time && eo_column_named(name, DIFFERENCE_WORDS));
  return named && (look->quantity == EO_QUANTITY_TIME || look->quantity == EO_QUANTITY_NONE) && may_be_steps(look);
}

/* Steps of time count where they are all that the file tells of it; -1: there are none, or several. */
static int find_steps(const struct eo_recording *recording, const struct eo_column *look)
{
  int steps = -1, found = 0;
  for (int c = 0; c < eo_recording_columns(recording); c++) {
    const char *name = eo_recording_name(recording, c);
    bool called = look[c].quantity == EO_QUANTITY_TIME || eo_column_named(name, TIME_WORDS "|timestamp");
    if (has_clock(recording, c))
      return -1;
    if (holds_steps(name, &look[c]))
      steps = c, found++;
    else if (called && look[c].step > 0 && look[c].falls <= look[c].rises / 10)
      return -1;
  }
  return found == 1 ? steps : -1;
}

void eo_steps_find(const struct eo_recording *recording, const struct eo_column *look, bool *steps)
{
  bool periods = holds_periods(recording, look);
  int alone = periods ? -1 : find_steps(recording, look);
  for (int c = 0; c < eo_recording_columns(recording); c++)
    steps[c] = periods || c == alone;
}

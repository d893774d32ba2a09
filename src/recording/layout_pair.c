/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which columns are the encoders, seen from the columns themselves, and which hold torque and speed beside them. */
#include "recording/layout_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CLOSE 3e-3 /* of a ratio: teeth pass with errors of micrometres, other ratios are further away */

#define PINION_WORDS EO_PINION_WORDS "|1|p|in"
#define GEAR_WORDS EO_GEAR_WORDS "|2|out"
#define TORQUE_WORDS "torque|moment|drehmoment|md|m|tq|trq|mt|couple|coppia|par"
#define SPEED_WORDS "speed|rpm|drehzahl|n|velocity|omega|rotspeed|vitesse|velocidad|velocita"

bool eo_layout_turns(const struct eo_column *look)
{
  int less = look->rises < look->falls ? look->rises : look->falls;
  return look->count > 20 && look->step != 0 && !look->levels &&
         less - look->resets <= (look->rises + look->falls) / 50 && look->rises + look->falls > look->count / 20;
}

/* Values that count up from row to row by the same number and never turn back tell nothing of a shaft. */
static bool may_turn(const struct eo_guess *guess, int column)
{
  enum eo_quantity q = guess->look[column].quantity;
  return eo_layout_turns(&guess->look[column]) && q != EO_QUANTITY_OTHER && q != EO_QUANTITY_TORQUE &&
         q != EO_QUANTITY_SPEED && q != EO_QUANTITY_FREQUENCY && q != EO_QUANTITY_TIME && !guess->number[column];
}

/* rad per unit of the column where its unit or its turn tells; 0: not known. */
static double factor_of(const struct eo_guess *guess, int column)
{
  const struct eo_column *look = &guess->look[column];
  double turn = eo_column_turn(look);
  if (look->quantity == EO_QUANTITY_ANGLE)
    return look->factor;
  if (eo_recording_turn(guess->recording, column) > 0 && look->whole)
    return EO_TURN / eo_recording_turn(guess->recording, column);
  return turn > 0 ? EO_TURN / turn : 0;
}

/* Speed by the clock of the column itself. */
static double speed_of(const struct eo_guess *guess, int column)
{
  struct eo_clock stated = eo_recording_clock(guess->recording, column);
  const struct eo_column *look = &guess->look[column];
  struct eo_layout_clock clock = {.column = stated.column, .scale = 1, .interval = stated.interval};
  double rows = (double)(look->last - look->first);
  if (clock.column < 0 && !(stated.interval > 0))
    clock.column = eo_layout_pick_time(guess, column);
  if (clock.column < 0 && !(stated.interval > 0))
    return look->pace * (double)(look->count - 1) / rows;
  if (clock.column >= 0 && guess->look[clock.column].quantity == EO_QUANTITY_TIME)
    clock.scale = guess->look[clock.column].factor;
  return eo_layout_rate(guess, column, &clock);
}

/* True when two columns turn in the ratio of the teeth, the first faster or the second. */
static bool fits_teeth(const struct eo_guess *guess, int a, int b)
{
  double fa = factor_of(guess, a), fb = factor_of(guess, b);
  if (!(fa > 0) || !(fb > 0))
    fa = fb = 1;
  double ratio = fabs(speed_of(guess, a) * fa / (speed_of(guess, b) * fb)),
         teeth = (double)guess->pair->teeth[1] / guess->pair->teeth[0];
  return fabs(ratio / teeth - 1) < CLOSE || fabs(ratio * teeth - 1) < CLOSE;
}

static int unit_points(const struct eo_guess *guess, int column)
{
  enum eo_quantity q = guess->look[column].quantity;
  return (q == EO_QUANTITY_ANGLE   ? 4
          : q == EO_QUANTITY_COUNT ? 3
                                   : 0) +
         2 * eo_column_named(eo_recording_name(guess->recording, column),
                             "phi|angle|winkel|encoder|enc|pos|position|theta|angulo|angolo");
}

bool eo_layout_find_pair(struct eo_guess *guess)
{
  int best = -1, pair[2] = {-1, -1};
  if (!guess->pair || guess->pair->teeth[0] < 1 || guess->pair->teeth[0] == guess->pair->teeth[1])
    return false;
  for (int i = 0; i < guess->candidates; i++)
    for (int k = i + 1; k < guess->candidates; k++) {
      int a = guess->candidate[i], b = guess->candidate[k];
      int points = unit_points(guess, a) + unit_points(guess, b);
      if (points <= best || !may_turn(guess, a) || !may_turn(guess, b) || !fits_teeth(guess, a, b))
        continue;
      best = points;
      pair[0] = a;
      pair[1] = b;
    }
  if (best < 0)
    return false;
  if (guess->candidates > 2) {
    char text[80], second[80];
    eo_notes_add(guess->notes, "Of %d columns %s and %s turn in the ratio of the teeth.", guess->candidates,
                 eo_layout_label(guess, pair[0], text, sizeof text),
                 eo_layout_label(guess, pair[1], second, sizeof second));
  }
  guess->candidates = 2;
  guess->candidate[0] = pair[0];
  guess->candidate[1] = pair[1];
  return true;
}

/* A column beside the encoders by its unit, else by its name. */
static void take_beside(struct eo_guess *guess, int column, enum eo_quantity quantity, const char *words, double usual,
                        struct eo_track_beside beside[2])
{
  const struct eo_column *look = &guess->look[column];
  const char *name = eo_recording_name(guess->recording, column);
  bool stated = look->quantity == quantity, named = eo_column_named(name, words) && look->quantity == EO_QUANTITY_NONE;
  bool one = eo_column_named(name, PINION_WORDS), two = eo_column_named(name, GEAR_WORDS);
  int member = two && !one;
  if ((!stated && !named) || !look->count || (beside[member].scale != 0 && beside[member].stated >= stated))
    return;
  beside[member] = (struct eo_track_beside){stated ? look->factor : usual, column, stated};
}

void eo_layout_find_beside(struct eo_guess *guess)
{
  for (int c = 0; c < guess->columns; c++) {
    bool used = guess->time[c] || guess->number[c];
    for (int member = 0; member < 2; member++)
      used = used || c == guess->clock[member].column || c == guess->tracks->channel[member].column[0] ||
             (guess->kind == EO_LAYOUT_SINE_COSINE && c == guess->tracks->channel[member].column[1]);
    if (used)
      continue;
    take_beside(guess, c, EO_QUANTITY_TORQUE, TORQUE_WORDS, 1, guess->tracks->torque);
    take_beside(guess, c, EO_QUANTITY_SPEED, SPEED_WORDS, EO_TURN / 60, guess->tracks->speed);
  }
}

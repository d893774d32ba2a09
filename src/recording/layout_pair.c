/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which columns are the encoders, seen from the columns themselves, and which hold torque and speed beside them. */
#include "recording/layout_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CLOSE 3e-3       /* of a ratio: teeth pass with errors of micrometres, other ratios are further away */
#define TIES 64          /* pairs that are compared; more are a question */
#define COMPARED 2000    /* rows */
#define SAME_SIGNAL 1e-4 /* of a step: rounding of one signal; shafts that are coupled differ by more */

#define PINION_WORDS EO_PINION_WORDS "|1|p|in|an"
#define GEAR_WORDS EO_GEAR_WORDS "|2|out|ab|mab|nab"
/* The wheels themselves, where others name what drives them or is driven. */
#define OWN_PINION_WORDS "pinion|ritzel|pignon|pinon|pignone|pinhao"
#define OWN_GEAR_WORDS "gear|wheel|rad|grossrad|roue|rueda|ruota|roda|corona"
#define MEASURED_WORDS "act|actual|ist|measured|meas|gemessen|feedback|fb|raw"
/* What was wanted or computed. */
#define WANTED_WORDS                                                                                                \
  "soll|set|setpoint|setpos|cmd|command|commanded|target|demand|demanded|desired|expected|vorgabe|consigne|wanted|" \
  "simulated|simulation|theoretical|ideal|computed|calculated|predicted|nominal|nenn|rated"
/* What took the mesh orders out of an angle; a load it leaves as it is. */
#define FILTERED_WORDS "filtered|filt|smooth|smoothed|lowpass|avg|averaged|average|gefiltert|geglattet|filtre|filtrado"
/* What is no load or speed of the pair's shafts, or a part of it alone. */
#define ASIDE_WORDS                                                                                                  \
  "friction|reib|reibung|loss|losses|verlust|bending|biege|limit|grenz|max|maximum|min|minimum|ripple|error|fehler|" \
  "slip|schlupf|fan|pump|turbine|deviation|abweichung|offset|preload|vorspann"
/* On which shaft a load acts depends on the rig. */
#define LOAD_WORDS "load|last|brake|brems|bremse|dyno|dynamometer|frein|freno"
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

bool eo_layout_is_tooth_ratio(const struct eo_guess *guess, double ratio)
{
  double teeth = guess->pair && guess->pair->teeth[0] > 0 ? (double)guess->pair->teeth[1] / guess->pair->teeth[0] : NAN;
  return fabs(fabs(ratio) / teeth - 1) < CLOSE || fabs(fabs(ratio) * teeth - 1) < CLOSE;
}

/* True when two columns turn in the ratio of the teeth, the first faster or the second. */
static bool fits_teeth(const struct eo_guess *guess, int a, int b)
{
  double fa = factor_of(guess, a), fb = factor_of(guess, b);
  if (!(fa > 0) || !(fb > 0))
    fa = fb = 1;
  return eo_layout_is_tooth_ratio(guess, speed_of(guess, a) * fa / (speed_of(guess, b) * fb));
}

static int points_of(const struct eo_guess *guess, int column)
{
  enum eo_quantity q = guess->look[column].quantity;
  const char *name = eo_recording_name(guess->recording, column);
  return (q == EO_QUANTITY_ANGLE   ? 4
          : q == EO_QUANTITY_COUNT ? 3
                                   : 0) +
         2 * eo_column_named(name, "phi|angle|winkel|encoder|enc|pos|position|theta|angulo|angolo") +
         4 * eo_column_named(name, MEASURED_WORDS) -
         8 * (eo_column_named(name, WANTED_WORDS) || eo_column_named(name, FILTERED_WORDS));
}

/* Names that tell two columns apart as those of pinion and gear. */
static int names_tell(const struct eo_guess *guess, int a, int b)
{
  const char *one = eo_recording_name(guess->recording, a), *two = eo_recording_name(guess->recording, b);
  return (eo_column_named(one, PINION_WORDS) && eo_column_named(two, GEAR_WORDS)) +
         (eo_column_named(one, OWN_PINION_WORDS) && eo_column_named(two, OWN_GEAR_WORDS));
}

/* How well two columns that turn in the ratio of the teeth stand for pinion and gear; a word that one name has alone
   speaks against the two ("run 1 pinion", "run 2 gear"). */
static int pair_points(const struct eo_guess *guess, int a, int b)
{
  const char *one = eo_recording_name(guess->recording, a), *two = eo_recording_name(guess->recording, b);
  int told = names_tell(guess, a, b), back = names_tell(guess, b, a);
  int alone = eo_column_shared_words(one, one, "") + eo_column_shared_words(two, two, "") -
              2 * eo_column_shared_words(one, two, "");
  return points_of(guess, a) + points_of(guess, b) + 16 * (told > back ? told : back) - alone;
}

/* How far b strays from a in the first rows, rad, by turns where one of them starts again; NaN: it cannot be told. */
static double stray(const struct eo_guess *guess, int a, int b)
{
  int64_t rows = eo_recording_rows(guess->recording), n = rows < COMPARED ? rows : COMPARED;
  double *row = malloc((size_t)(n * guess->columns) * sizeof *row), low = INFINITY, high = -INFINITY, first = NAN;
  double fa = factor_of(guess, a), fb = factor_of(guess, b);
  struct eo_error error;
  bool known = fa > 0 && fb > 0;
  if (row && !eo_recording_read(guess->recording, 0, n, row, &error))
    for (int64_t i = 0; i < n; i++) {
      double off = row[i * guess->columns + b] * (known ? fb : 1) - row[i * guess->columns + a] * (known ? fa : 1);
      first = isnan(first) ? off : first;
      off = known ? remainder(off - first, EO_TURN) : off - first;
      low = fmin(low, off);
      high = fmax(high, off);
    }
  free(row);
  return high >= low ? high - low : NAN;
}

/* One signal in two columns: in other units, or with turns counted in one of them alone. */
static bool are_one_signal(const struct eo_guess *guess, int a, int b)
{
  double factor = factor_of(guess, a);
  return a == b || stray(guess, a, b) < SAME_SIGNAL * fabs(guess->look[a].step) * (factor > 0 ? factor : 1);
}

bool eo_layout_find_pair(struct eo_guess *guess)
{
  int best = -1000, ties = 0, pair[2] = {-1, -1}, rival[2] = {-1, -1};
  if (!guess->pair || guess->pair->teeth[0] < 1 || guess->pair->teeth[0] == guess->pair->teeth[1])
    return false;
  for (int i = 0; i < guess->candidates; i++)
    for (int k = i + 1; k < guess->candidates; k++) {
      int a = guess->candidate[i], b = guess->candidate[k], points = pair_points(guess, a, b);
      if (points < best || !may_turn(guess, a) || !may_turn(guess, b) || !fits_teeth(guess, a, b))
        continue;
      bool other = points == best && rival[0] < 0 &&
                   (++ties > TIES || !(are_one_signal(guess, a, pair[0]) && are_one_signal(guess, b, pair[1])));
      if (points == best && !other)
        continue;
      int *to = other ? rival : pair;
      to[0] = a;
      to[1] = b;
      rival[0] = other ? rival[0] : -1;
      best = points;
    }
  if (pair[0] < 0)
    return false;
  memcpy(guess->rival, rival, sizeof rival);
  if (guess->candidates > 2 && !guess->choice->column[0][0] && !guess->choice->column[1][0]) {
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

enum eo_code eo_layout_ask_rival(const struct eo_guess *guess, struct eo_error *error)
{
  char text[4][80];
  const int column[4] = {guess->candidate[0], guess->candidate[1], guess->rival[0], guess->rival[1]};
  if (guess->rival[0] < 0 || guess->choice->column[0][0] || guess->choice->column[1][0])
    return EO_OK;
  for (int i = 0; i < 4; i++)
    eo_layout_label(guess, column[i], text[i], sizeof text[i]);
  return eo_error_set(error, EO_ERROR_INPUT, "/columns",
                      "%s and %s (columns %d and %d) turn in the ratio of the teeth, %s and %s (columns %d and %d) as "
                      "well: name the columns of pinion and gear.",
                      text[0], text[1], column[0] + 1, column[1] + 1, text[2], text[3], column[2] + 1, column[3] + 1);
}

/* Why a column that looks like a torque or a speed is none of the pinion or the gear; NULL: it may be one. */
static const char *reason_against(const struct eo_guess *guess, int column, bool shaft)
{
  const char *name = eo_recording_name(guess->recording, column);
  return guess->look[column].quantity == EO_QUANTITY_NONE && eo_layout_has_unit(guess, column)
             ? "has a unit that is not known"
         : eo_column_named(name, WANTED_WORDS)         ? "was wanted or computed, not measured"
         : eo_column_named(name, ASIDE_WORDS)          ? "is not that of the pinion or the gear"
         : !shaft && eo_column_named(name, LOAD_WORDS) ? "does not say whether it acts on the pinion or on the gear"
                                                       : NULL;
}

/* A column beside the encoders by its unit, else by its name; of several the one that tells most of itself. */
static void take_beside(struct eo_guess *guess, int column, enum eo_quantity quantity, const char *words, double usual,
                        struct eo_track_beside beside[2])
{
  const struct eo_column *look = &guess->look[column];
  const char *name = eo_recording_name(guess->recording, column);
  bool stated = look->quantity == quantity, named = eo_column_named(name, words) && look->quantity == EO_QUANTITY_NONE;
  bool one = eo_column_named(name, PINION_WORDS), two = eo_column_named(name, GEAR_WORDS);
  int member = two && !one;
  char text[80];
  if ((!stated && !named) || !look->count)
    return;
  const char *against = reason_against(guess, column, one != two);
  if (against) {
    eo_notes_add(guess->notes, "%s %s: it is left out.", eo_layout_label(guess, column, text, sizeof text), against);
    return;
  }
  int told = 1 + 8 * stated + 4 * eo_column_named(name, member ? OWN_GEAR_WORDS : OWN_PINION_WORDS) +
             2 * eo_column_named(name, MEASURED_WORDS) + (one != two);
  if (beside[member].scale != 0 && beside[member].told >= told) {
    if (beside[member].told == told)
      eo_notes_add(guess->notes, "%s stands beside \"%s\" and is left out.",
                   eo_layout_label(guess, column, text, sizeof text),
                   eo_recording_name(guess->recording, beside[member].column));
    return;
  }
  beside[member] = (struct eo_track_beside){stated ? look->factor : usual, column, stated, one != two, told};
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

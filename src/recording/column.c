/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/column.h"
#include "recording/letters.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/sort.h"

#define ROWS 20000   /* that are looked at */
#define HEIGHTS 512  /* of resets, that are kept */
#define STRETCHES 64 /* within which noise does not count as travel */

static enum eo_code read_column(const struct eo_recording *recording, int column, int64_t rows, double *values,
                                struct eo_column *look, struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  double *block = malloc(1000 * (size_t)columns * sizeof *block);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  look->count = 0;
  for (int64_t first = 0; !code && first < rows; first += 1000) {
    int64_t n = rows - first < 1000 ? rows - first : 1000;
    code = eo_recording_read(recording, first, n, block, error);
    for (int64_t i = 0; !code && i < n; i++)
      if (!isnan(block[i * columns + column])) {
        look->first = look->count ? look->first : first + i;
        look->last = first + i;
        values[look->count++] = block[i * columns + column];
      }
  }
  free(block);
  return code;
}

static void find_range(struct eo_column *look, const double *values)
{
  look->low = INFINITY;
  look->high = -INFINITY;
  look->whole = true;
  for (int64_t i = 0; i < look->count; i++) {
    look->low = fmin(look->low, values[i]);
    look->high = fmax(look->high, values[i]);
    look->whole = look->whole && values[i] == floor(values[i]);
  }
}

/* Nine tenths of the values lie within a fifth of the range of its ends, and both ends are in use; of a sine they would
   be six tenths. */
static void find_levels(struct eo_column *look, const double *values)
{
  int64_t low = 0, high = 0;
  double fifth = (look->high - look->low) / 5;
  for (int64_t i = 0; i < look->count; i++) {
    low += values[i] < look->low + fifth;
    high += values[i] > look->high - fifth;
  }
  look->levels = look->count > 20 && fifth > 0 && low + high > look->count * 9 / 10 && low > look->count / 20 &&
                 high > look->count / 20;
}

/* A reset goes against the trend of all steps, by most of the range. */
static bool is_reset(const struct eo_column *look, double step, bool up)
{
  return fabs(step) > 0.5 * (look->high - look->low) && (step < 0) == up;
}

/* The median: a reset amid lost rows is higher or lower by the way in them. Of two the mean. */
static double usual_height(double height[HEIGHTS], int resets)
{
  int kept = resets < HEIGHTS ? resets : HEIGHTS;
  eo_sort_numbers(kept, height);
  return (height[(kept - 1) / 2] + height[kept / 2]) / 2;
}

static void find_steps(struct eo_column *look, const double *values)
{
  for (int64_t i = 1; i < look->count; i++) {
    look->rises += values[i] > values[i - 1];
    look->falls += values[i] < values[i - 1];
  }
  bool up = look->rises >= look->falls;
  double sum = 0, square = 0, travel = 0, way = 0, height[HEIGHTS];
  int64_t steps = 0, stretch = 1 + look->count / STRETCHES;
  for (int64_t i = 1; i < look->count; i++) {
    double step = values[i] - values[i - 1];
    if (is_reset(look, step, up)) {
      if (look->resets < HEIGHTS)
        height[look->resets] = fabs(step);
      look->resets++;
      continue;
    }
    steps++;
    sum += step;
    travel += step;
    if (steps % stretch == 0)
      way += fabs(travel), travel = 0;
  }
  look->step = steps ? sum / (double)steps : 0;
  look->pace = steps ? (way + fabs(travel)) / (double)steps : 0;
  for (int64_t i = 1; i < look->count; i++) {
    double step = values[i] - values[i - 1];
    if (!is_reset(look, step, up))
      square += (step - look->step) * (step - look->step);
  }
  look->spread = steps && look->step != 0 ? sqrt(square / (double)steps) / fabs(look->step) : INFINITY;
  look->period = look->resets ? usual_height(height, look->resets) + fabs(look->step) : 0;
}

/* A column that is called by a unit of time alone: "ms", "millis", "seconds". Single letters name anything, and "min"
   what is least. */
static void take_name(struct eo_column *look, const char *name)
{
  double factor;
  if (strlen(name) < 2 || !strncasecmp(name, "min", 3) || eo_unit_find(name, &factor) != EO_QUANTITY_TIME)
    return;
  look->quantity = EO_QUANTITY_TIME;
  look->factor = factor;
}

enum eo_code eo_column_look(const struct eo_recording *recording, int column, struct eo_column *look,
                            struct eo_error *error)
{
  int64_t rows = eo_recording_length(recording, column);
  rows = rows < ROWS ? rows : ROWS;
  double *values = malloc((size_t)(rows ? rows : 1) * sizeof *values);
  if (!values)
    return eo_error_memory(error);
  memset(look, 0, sizeof *look);
  look->quantity = eo_unit_find_multiple(eo_recording_unit(recording, column), &look->factor);
  if (look->quantity == EO_QUANTITY_NONE)
    take_name(look, eo_recording_name(recording, column));
  enum eo_code code = read_column(recording, column, rows, values, look, error);
  if (!code) {
    find_range(look, values);
    find_steps(look, values);
    find_levels(look, values);
  }
  free(values);
  return code;
}

/* Counts run from 0 to one below the turn and pass over the last ones at speed: powers of two and whole hundreds come
   into question, those first that are as high as the resets. */
static double find_counts(const struct eo_column *look)
{
  const double near[] = {0.1 * fabs(look->step) + 1, INFINITY};
  double least = look->high - (look->low < 0 ? look->low : 0) + 1, most = least + 2 * fabs(look->step) + 1;
  for (int i = 0; i < 2; i++) {
    for (double power = 64; power <= most; power *= 2)
      if (power >= least && fabs(power - look->period) <= near[i])
        return power;
    for (double unit = 1e6; unit >= 100; unit /= 10) {
      double turn = ceil(least / unit) * unit;
      if (turn <= most && fabs(turn - look->period) <= near[i])
        return turn;
    }
  }
  return 0;
}

double eo_column_turn(const struct eo_column *look)
{
  /* degrees and their parts, radians, turns, gon, mils */
  static const double turns[] = {360, 3600, 36000, 360000, 21600, 1296000, 6.283185307179586, 6283.185307179586,
                                 1,   1000, 400,   6400};
  if (!look->resets)
    return 0;
  if (look->whole && look->high > 400)
    return find_counts(look);
  for (size_t i = 0; i < sizeof turns / sizeof *turns; i++)
    if (fabs(look->period - turns[i]) < 0.05 * turns[i] && look->high - look->low <= turns[i] * (1 + 1e-6))
      return turns[i];
  return look->whole ? find_counts(look) : 0;
}

/* What German puts behind a word without a gap ("Abtriebsmoment"), and names of channels in any case ("gearangle"). */
static const char *const tails[] = {"drehmoment", "drehzahl", "drehwinkel", "moment",   "winkel", "geber", "welle",
                                    "wert",       "position", "encoder",    "velocity", "torque", "speed", "angle"};

/* Letters of a word of `length` bytes that stand in front of such a tail; 0: it has none. */
static size_t head_of(const char *word, size_t length)
{
  for (size_t i = 0; i < sizeof tails / sizeof *tails; i++) {
    size_t n = strlen(tails[i]);
    if (length == n && !strncasecmp(word, tails[i], n))
      return 0;
    if (length >= n + 3 && !strncasecmp(word + length - n, tails[i], n))
      return length - n;
  }
  return 0;
}

/* Of "SetPos" the words are "Set" and "Pos", of "kHz" and "dT" there is one. */
static bool begins_word(const char *word, const char *at)
{
  return at - word >= 2 && islower((unsigned char)at[-1]) && isupper((unsigned char)at[0]) &&
         islower((unsigned char)at[1]);
}

/* The next word of a name: letters (bytes of UTF-8 among them) or digits, of `length` bytes; returns where to go on. */
static const char *next_word(const char *name, const char **word, size_t *length)
{
  while (*name && !isalnum((unsigned char)*name) && (unsigned char)*name < 0x80)
    name++;
  *word = name;
  bool digits = isdigit((unsigned char)*name);
  while (*name && (isalnum((unsigned char)*name) || (unsigned char)*name >= 0x80) &&
         (isdigit((unsigned char)*name) != 0) == digits && !begins_word(*word, name))
    name++;
  *length = (size_t)(name - *word);
  size_t head = head_of(*word, *length);
  if (!head)
    return name;
  name = *word + head;
  *length = head - (head > 4 && name[-1] == 's' && strchr("bg", name[-2])); /* "Eingangs" */
  return name;
}

bool eo_column_named(const char *name, const char *words)
{
  const char *word;
  size_t length;
  for (const char *end = next_word(name, &word, &length); *word; end = next_word(end, &word, &length))
    if (eo_letters_listed(word, length, words))
      return true;
  return false;
}

int eo_column_shared_words(const char *name, const char *other, const char *ignored)
{
  const char *word, *again;
  size_t length, other_length;
  int shared = 0;
  uint64_t used = 0;
  for (const char *end = next_word(name, &word, &length); *word; end = next_word(end, &word, &length)) {
    int place = 0;
    if (eo_letters_listed(word, length, ignored))
      continue;
    for (const char *stop = next_word(other, &again, &other_length); *again;
         stop = next_word(stop, &again, &other_length), place++)
      if (place < 64 && !(used >> place & 1) && other_length == length && !strncasecmp(word, again, length)) {
        used |= (uint64_t)1 << place;
        shared++;
        break;
      }
  }
  return shared;
}

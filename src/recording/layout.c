/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/layout_private.h"

#include "gear/names.h"
#include "recording/lost.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define TURN EO_TURN
#define NUMBERED_PINION "1"
#define NUMBERED_GEAR "2"
#define PINION_WORDS EO_PINION_WORDS "|p"
#define GEAR_WORDS EO_GEAR_WORDS "|g"
#define SINE_WORDS "sin|sine|sinus"
#define COSINE_WORDS "cos|cosine|kosinus|cosinus"
#define SINE_LETTER "a" /* only of names without such a word: in a_sin and a_cos it names the encoder */
#define COSINE_LETTER "b"
#define OTHER_WORDS                                                                                             \
  "torque|moment|drehmoment|speed|rpm|drehzahl|temperature|temp|temperatur|acc|acceleration|accel|force|kraft|" \
  "trigger|index|sample|count_no|status|couple|coppia|vitesse|velocidad|velocita"
#define INCREMENT_WORDS "increment|increments|inkrement|inkremente|delta|diff|difference|differenz|dcount|dcounts"

const char *eo_layout_label(const struct eo_guess *guess, int column, char *text, size_t size)
{
  const char *name = eo_recording_name(guess->recording, column);
  if (*name)
    snprintf(text, size, "\"%s\"", name);
  else
    snprintf(text, size, "column %d", column + 1);
  return text;
}

/* What may be chosen: the names with their units, numbers where there are no names. */
static void list_columns(const struct eo_guess *guess, char *list, size_t size)
{
  size_t used = 0;
  *list = '\0';
  for (int c = 0; c < guess->columns; c++) {
    char column[EO_RECORDING_NAME + EO_RECORDING_UNIT + 8];
    const char *name = eo_recording_name(guess->recording, c), *unit = eo_recording_unit(guess->recording, c);
    int n = *name ? snprintf(column, sizeof column, "%s", name) : snprintf(column, sizeof column, "%d", c + 1);
    if (*unit)
      n += snprintf(column + n, sizeof column - (size_t)n, " (%s)", unit);
    bool last = used + (size_t)n + sizeof ", ..." > size;
    used += (size_t)snprintf(list + used, size - used, "%s%s", c ? ", " : "", last ? "..." : column);
    if (last)
      return;
  }
}

enum eo_code eo_layout_chosen(const struct eo_guess *guess, const char *chosen, const char *pointer, int *column,
                              struct eo_error *error)
{
  for (int c = 0; c < guess->columns; c++)
    if (!strcmp(eo_recording_name(guess->recording, c), chosen)) {
      *column = c;
      return EO_OK;
    }
  char *end, list[240];
  long number = strtol(chosen, &end, 10);
  list_columns(guess, list, sizeof list);
  if (end == chosen || *end || number < 1 || number > guess->columns)
    return eo_error_set(error, EO_ERROR_INPUT, pointer,
                        "The recording has no column \"%.60s\"; it has %d column%s: %s.", chosen, guess->columns,
                        guess->columns == 1 ? "" : "s", list);
  *column = (int)number - 1;
  return EO_OK;
}

/* Several columns of times with different lengths, and nothing else, are pulses. */
static bool looks_like_pulses(const struct eo_guess *guess)
{
  int times = 0;
  bool uneven = false;
  for (int c = 0; c < guess->columns; c++) {
    const struct eo_column *look = &guess->look[c];
    bool ticks = look->quantity == EO_QUANTITY_COUNT && eo_recording_tick(guess->recording) > 0;
    if (look->falls || look->resets || look->rises < 2 || eo_recording_clock(guess->recording, c).column >= 0 ||
        (look->quantity != EO_QUANTITY_TIME && look->quantity != EO_QUANTITY_NONE && !ticks))
      return false;
    times++;
    uneven = uneven || eo_recording_length(guess->recording, c) != eo_recording_length(guess->recording, 0) ||
             look->quantity == EO_QUANTITY_TIME;
  }
  return times == 2 && uneven && guess->look[1].quantity == guess->look[0].quantity &&
         !(eo_recording_clock(guess->recording, 0).interval > 0);
}

/* What is neither time nor empty, constant or of another quantity. */
static void find_candidates(struct eo_guess *guess)
{
  for (int c = 0; c < guess->columns; c++) {
    const struct eo_column *look = &guess->look[c];
    enum eo_quantity q = look->quantity;
    bool pulses = guess->kind == EO_LAYOUT_PULSES;
    if (!look->count || (!pulses && (guess->time[c] || guess->number[c] || q == EO_QUANTITY_TIME)) ||
        q == EO_QUANTITY_OTHER || q == EO_QUANTITY_TORQUE || q == EO_QUANTITY_SPEED || q == EO_QUANTITY_FREQUENCY)
      continue;
    if (q != EO_QUANTITY_ANGLE && eo_column_named(eo_recording_name(guess->recording, c), OTHER_WORDS))
      continue;
    guess->candidate[guess->candidates++] = c;
  }
}

/* Raw tracks swing to and fro; an angle goes one way, but for its resets. */
static bool swings(const struct eo_column *look)
{
  int less = look->rises < look->falls ? look->rises : look->falls;
  return less - look->resets > (look->rises + look->falls) / 10;
}

/* A voltage, or nobody says what. Counts since the row before may have two values, too, but these are neighbours, and
   the lower one is not 0. */
static bool may_be_square(const struct eo_column *look)
{
  bool voltage = look->quantity == EO_QUANTITY_VOLTAGE || look->quantity == EO_QUANTITY_NONE ||
                 look->quantity == EO_QUANTITY_CURRENT;
  bool counts = look->whole && look->high - look->low <= 2 && (look->low > 0 || look->high < 0);
  return look->levels && voltage && !counts;
}

/* Two or four columns with two levels each, and no angle beside them, are square waves. */
static bool find_squares(struct eo_guess *guess)
{
  int squares = 0, square[EO_RECORDING_COLUMNS];
  if (guess->choice->unit == EO_LAYOUT_COUNT)
    return false;
  for (int i = 0; i < guess->candidates; i++)
    if (may_be_square(&guess->look[guess->candidate[i]]))
      square[squares++] = guess->candidate[i];
  if (squares != 2 && squares != 4)
    return false;
  guess->candidates = squares;
  memcpy(guess->candidate, square, (size_t)squares * sizeof *square);
  return true;
}

/* Angles where two columns turn together, whatever swings beside them; else what most columns look like. */
static void guess_kind(struct eo_guess *guess)
{
  int tracks = 0;
  bool pair = (!guess->kind || guess->kind == EO_LAYOUT_ANGLES) && eo_layout_find_pair(guess);
  if (!guess->kind && !pair && find_squares(guess)) {
    guess->square = true;
    guess->kind = guess->candidates == 4 ? EO_LAYOUT_SINE_COSINE : EO_LAYOUT_ANGLES;
    return;
  }
  for (int i = 0; i < guess->candidates; i++) {
    int c = guess->candidate[i];
    const char *name = eo_recording_name(guess->recording, c);
    bool named = eo_column_named(name, "sin|sine|sinus|cos|cosine|kosinus|cosinus");
    bool measured = guess->look[c].quantity == EO_QUANTITY_VOLTAGE || guess->look[c].quantity == EO_QUANTITY_CURRENT;
    tracks += guess->look[c].quantity != EO_QUANTITY_ANGLE && (named || measured || swings(&guess->look[c]));
  }
  if (!guess->kind)
    guess->kind = !pair && tracks >= 4 ? EO_LAYOUT_SINE_COSINE : EO_LAYOUT_ANGLES;
}

/* 1: the name says sine, -1: cosine, 0: neither. */
static int sine_or_cosine(const char *name)
{
  int word = eo_column_named(name, SINE_WORDS) - eo_column_named(name, COSINE_WORDS);
  return word ? word : eo_column_named(name, SINE_LETTER) - eo_column_named(name, COSINE_LETTER);
}

/* Numbers tell encoders apart only where one name has a 1 and another a 2: "data 2" and "data 3" are columns. */
static int number_fit(const struct eo_guess *guess, int column, int member)
{
  const char *name = eo_recording_name(guess->recording, column);
  bool one = false, two = false;
  for (int i = 0; i < guess->candidates; i++) {
    const char *other = eo_recording_name(guess->recording, guess->candidate[i]);
    one = one || (eo_column_named(other, NUMBERED_PINION) && !eo_column_named(other, NUMBERED_GEAR));
    two = two || (eo_column_named(other, NUMBERED_GEAR) && !eo_column_named(other, NUMBERED_PINION));
  }
  return !one || !two ? 0
                      : eo_column_named(name, member ? NUMBERED_GEAR : NUMBERED_PINION) -
                            eo_column_named(name, member ? NUMBERED_PINION : NUMBERED_GEAR);
}

/* How well a column's name fits a member and a track (0: sine or the only one, 1: cosine). */
static int fit_of(const struct eo_guess *guess, int column, int member, int track)
{
  const char *name = eo_recording_name(guess->recording, column);
  int fit = eo_column_named(name, member ? GEAR_WORDS : PINION_WORDS) -
            eo_column_named(name, member ? PINION_WORDS : GEAR_WORDS) + number_fit(guess, column, member);
  if (guess->kind == EO_LAYOUT_SINE_COSINE)
    fit += 2 * (track ? -1 : 1) * sine_or_cosine(name);
  if (guess->kind == EO_LAYOUT_ANGLES && !guess->square &&
      (guess->look[column].quantity == EO_QUANTITY_ANGLE || guess->look[column].quantity == EO_QUANTITY_COUNT))
    fit += 4;
  return fit;
}

/* Columns that the caller named come first; each other place then takes the best fitting column, the earlier one of
   equals. */
static enum eo_code assign(struct eo_guess *guess, struct eo_error *error)
{
  int tracks = guess->kind == EO_LAYOUT_SINE_COSINE ? 2 : 1;
  bool taken[EO_RECORDING_COLUMNS] = {false};
  for (int member = 0; member < 2; member++)
    for (int track = 0; track < tracks; track++) {
      int *column = &guess->tracks->channel[member].column[track];
      *column = -1;
      if (!guess->choice->column[member][track])
        continue;
      enum eo_code code = eo_layout_chosen(guess, guess->choice->column[member][track], "/columns", column, error);
      if (code)
        return code;
      taken[*column] = true;
    }
  for (int place = 0; place < 2 * tracks; place++) {
    int member = place / tracks, track = place % tracks, best = -1, most = -1000;
    int *column = &guess->tracks->channel[member].column[track];
    for (int i = 0; *column < 0 && i < guess->candidates; i++) {
      int fit = fit_of(guess, guess->candidate[i], member, track);
      if (!taken[guess->candidate[i]] && fit > most) {
        most = fit;
        best = guess->candidate[i];
      }
    }
    if (*column < 0 && best < 0) {
      char list[240];
      list_columns(guess, list, sizeof list);
      return eo_error_set(error, EO_ERROR_INPUT, "/columns",
                          "The recording has %d column%s that may hold an encoder's values; %d are needed. It has: %s.",
                          guess->candidates, guess->candidates == 1 ? "" : "s", 2 * tracks, list);
    }
    if (*column < 0)
      *column = best;
    taken[*column] = true;
  }
  return EO_OK;
}

/* Counts since the row before go up as often as down, and stay on one side of 0. (Where they have two values, every
   step looks like a reset.) */
static bool are_increments(const struct eo_guess *guess, int member)
{
  int column = guess->tracks->channel[member].column[0];
  const struct eo_column *look = &guess->look[column];
  bool named = eo_column_named(eo_recording_name(guess->recording, column), INCREMENT_WORDS);
  bool counts = guess->choice->unit == EO_LAYOUT_COUNT || look->quantity == EO_QUANTITY_COUNT;
  double middle = fabs(look->low + look->high) / 2;
  int less = look->rises < look->falls ? look->rises : look->falls, all = look->rises + look->falls;
  return guess->kind == EO_LAYOUT_ANGLES && !guess->square && (named || (counts && look->whole)) && 4 * less > all &&
         all > 20 && look->high - look->low < middle;
}

static void note_angle(const struct eo_guess *guess, int member)
{
  const struct eo_track_channel *channel = &guess->tracks->channel[member];
  const struct eo_column *look = &guess->look[channel->column[0]];
  char text[80], turns[48] = "not starting again";
  if (look->resets)
    snprintf(turns, sizeof turns, "starting again after %.6g",
             eo_column_turn(look) > 0 ? eo_column_turn(look) : look->period);
  eo_notes_add(guess->notes, "%s is taken as the angle of the %s in %s of %.6g rad, %s.",
               eo_layout_label(guess, channel->column[0], text, sizeof text), eo_member_name[member],
               eo_layout_scale_name(channel->scale), channel->scale, turns);
}

static enum eo_code settle_lines(struct eo_guess *guess, int member, struct eo_error *error)
{
  struct eo_track_channel *channel = &guess->tracks->channel[member];
  char text[80], second[80];
  const struct eo_column *look = &guess->look[channel->column[0]];
  channel->lines = guess->choice->lines[member] > 0 ? guess->choice->lines[member]
                                                    : eo_recording_turn(guess->recording, channel->column[0]);
  channel->factor = 1;
  if (!(channel->lines > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/lines", "Give the %s per turn of the %s's encoder.",
                        guess->kind == EO_LAYOUT_PULSES ? "pulses" : "lines (sine periods)", eo_member_name[member]);
  if (guess->kind == EO_LAYOUT_PULSES) {
    eo_notes_add(guess->notes, "%s is taken as the times of the pulses of the %s.",
                 eo_layout_label(guess, channel->column[0], text, sizeof text), eo_member_name[member]);
    return EO_OK;
  }
  if (look->quantity == EO_QUANTITY_VOLTAGE) {
    channel->unit = EO_TRACK_VOLT;
    channel->factor = look->factor;
  } else if (look->quantity == EO_QUANTITY_CURRENT) {
    channel->unit = EO_TRACK_MICROAMPERE;
    channel->factor = look->factor * 1e6;
  }
  eo_notes_add(guess->notes, "%s and %s are taken as the sine and cosine tracks of the %s.",
               eo_layout_label(guess, channel->column[0], text, sizeof text),
               eo_layout_label(guess, channel->column[1], second, sizeof second), eo_member_name[member]);
  return EO_OK;
}

/* Where the channels are in the file, before anything takes their place. */
static void note_source(struct eo_guess *guess)
{
  for (int member = 0; member < 2; member++) {
    struct eo_track_source *source = &guess->tracks->source[member];
    source->time = guess->clock[member].column;
    source->time_scale = guess->clock[member].scale;
    memcpy(source->column, guess->tracks->channel[member].column, sizeof source->column);
  }
}

static void note_time(const struct eo_guess *guess)
{
  char text[80];
  for (int member = 0; member < 2; member++) {
    const struct eo_layout_clock *clock = &guess->clock[member];
    if (member && clock->column == guess->clock[0].column && clock->interval == guess->clock[0].interval)
      continue;
    if (clock->column >= 0)
      eo_notes_add(guess->notes, "%s is taken as time in units of %g s: steps of %.6g s.",
                   eo_layout_label(guess, clock->column, text, sizeof text), clock->scale, clock->interval);
    else if (!(guess->choice->sample_rate > 0))
      eo_notes_add(guess->notes, "The file states a sampling rate of %.8g Hz.", 1 / clock->interval);
  }
}

static enum eo_code settle(struct eo_guess *guess, struct eo_error *error)
{
  static const enum eo_track tracks[] = {[EO_LAYOUT_ANGLES] = EO_TRACK_ANGLE,
                                         [EO_LAYOUT_SINE_COSINE] = EO_TRACK_SINE_COSINE,
                                         [EO_LAYOUT_PULSES] = EO_TRACK_PULSES};
  for (int member = 0; member < 2; member++) {
    guess->tracks->channel[member].track = tracks[guess->kind];
    enum eo_code code = guess->kind == EO_LAYOUT_ANGLES ? eo_layout_find_scale(guess, member, error)
                                                        : settle_lines(guess, member, error);
    if (code)
      return code;
    if (guess->kind == EO_LAYOUT_ANGLES)
      note_angle(guess, member);
  }
  return EO_OK;
}

/* Pulse times are the values themselves: of a stated clock's ticks, in the unit of the column, or in seconds. */
static enum eo_code find_pulse_time(struct eo_guess *guess, struct eo_error *error)
{
  const struct eo_column *look = &guess->look[guess->tracks->channel[0].column[0]];
  double tick = eo_recording_tick(guess->recording);
  char text[80];
  guess->tracks->time_scale = guess->choice->time_scale > 0         ? guess->choice->time_scale
                              : look->quantity == EO_QUANTITY_TIME  ? look->factor
                              : tick > 0                            ? tick
                              : look->quantity == EO_QUANTITY_COUNT ? 0
                                                                    : 1;
  for (int member = 0; member < 2; member++)
    guess->clock[member] = (struct eo_layout_clock){.column = -1, .scale = guess->tracks->time_scale};
  if (guess->tracks->time_scale > 0)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "/time_unit",
                      "%s holds ticks of a clock that the file does not state; give "
                      "the seconds of one tick.",
                      eo_layout_label(guess, guess->tracks->channel[0].column[0], text, sizeof text));
}

/* Clocks and scales of the channels that were found. */
static enum eo_code settle_channels(struct eo_guess *guess, struct eo_error *error)
{
  EO_TRY(guess->kind == EO_LAYOUT_PULSES ? find_pulse_time(guess, error) : eo_layout_find_clocks(guess, error));
  for (int member = 0; member < 2; member++)
    guess->increments[member] = are_increments(guess, member);
  note_source(guess);
  if (!guess->square) {
    EO_TRY(settle(guess, error));
    EO_TRY(eo_layout_judge_speed(guess, error));
  }
  if (guess->kind == EO_LAYOUT_PULSES)
    return EO_OK;
  note_time(guess);
  EO_TRY(eo_layout_compare(guess, error));
  if (guess->together) /* a joint column of times is uneven by its nature */
    EO_TRY(eo_layout_make_even(guess, error));
  eo_layout_find_beside(guess);
  guess->tracks->time_column = guess->clock[0].column;
  guess->tracks->time_scale = guess->clock[0].column >= 0 ? guess->clock[0].scale : 1;
  guess->tracks->interval = guess->clock[0].interval;
  return EO_OK;
}

static enum eo_code find(struct eo_guess *guess, struct eo_recording *recording, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int c = 0; !code && c < guess->columns; c++)
    code = eo_column_look(guess->recording, c, &guess->look[c], error);
  if (code)
    return code;
  eo_layout_read_constants(guess, recording);
  guess->kind = guess->choice->kind        ? guess->choice->kind
                : looks_like_pulses(guess) ? EO_LAYOUT_PULSES
                                           : EO_LAYOUT_GUESS_KIND;
  guess->tracks->time_column = -1;
  eo_layout_mark_times(guess);
  if (guess->choice->time && strcmp(guess->choice->time, "none") && guess->kind != EO_LAYOUT_PULSES) {
    int chosen;
    code = eo_layout_chosen(guess, guess->choice->time, "/time", &chosen, error);
    if (code)
      return code;
    guess->time[chosen] = true;
  }
  find_candidates(guess);
  guess->rival[0] = -1;
  guess_kind(guess);
  EO_TRY(eo_layout_ask_rival(guess, error));
  EO_TRY(assign(guess, error));
  return settle_channels(guess, error);
}

/* Brings the channels to one clock, or decodes them, where that is needed. */
static enum eo_code replace(struct eo_guess *guess, const char *spool_directory, struct eo_recording **recording,
                            struct eo_error *error)
{
  struct eo_recording *made = NULL;
  enum eo_code code = EO_OK;
  if (guess->square)
    code = eo_layout_decode_squares(guess, spool_directory, &made, error);
  else if (eo_layout_needs_align(guess))
    code = eo_layout_align(guess, spool_directory, &made, error);
  if (!code && made) {
    eo_recording_free(*recording);
    *recording = made;
  }
  return code;
}

enum eo_code eo_layout_find(struct eo_recording **recording, const struct eo_layout_choice *choice,
                            const struct eo_layout_pair *pair, const char *spool_directory, struct eo_tracks *tracks,
                            struct eo_notes *notes, struct eo_error *error)
{
  static const struct eo_layout_choice none;
  EO_TRY(eo_lost_find(*recording, notes, error));
  struct eo_guess *guess = calloc(1, sizeof *guess);
  if (!guess)
    return eo_error_memory(error);
  struct eo_tracks found = {0};
  guess->recording = *recording;
  guess->choice = choice ? choice : &none;
  guess->pair = pair;
  guess->tracks = &found;
  guess->notes = notes;
  guess->columns = eo_recording_columns(*recording);
  enum eo_code code = find(guess, *recording, error);
  if (!code)
    code = replace(guess, spool_directory, recording, error);
  if (!code)
    *tracks = found;
  free(guess);
  return code;
}

#include "recording/layout.h"
#include "recording/column.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TURN 6.283185307179586 /* rad */
#define PINION_WORDS "1|pinion|ritzel|input|driver|drive|driving|eingang|antrieb|motor|p"
#define GEAR_WORDS "2|gear|wheel|rad|grossrad|output|driven|ausgang|abtrieb|g"
#define TIME_WORDS "t|time|zeit|timestamp|elapsed|x"
#define SINE_WORDS "sin|sine|sinus"
#define COSINE_WORDS "cos|cosine|kosinus|cosinus"
#define SINE_LETTER "a" /* only of names without such a word: in a_sin and a_cos it names the encoder */
#define COSINE_LETTER "b"
#define OTHER_WORDS                                                                                             \
  "torque|moment|drehmoment|speed|rpm|drehzahl|temperature|temp|temperatur|acc|acceleration|accel|force|kraft|" \
  "trigger|index|sample|count_no|status"

static const char *const member_names[2] = {"pinion", "gear"};

struct guess {
  const struct eo_recording *recording;
  const struct eo_layout_choice *choice;
  struct eo_tracks *tracks;
  struct eo_notes *notes;
  int columns;
  struct eo_column look[EO_RECORDING_COLUMNS];
  int candidates, candidate[EO_RECORDING_COLUMNS]; /* columns that may be angles, tracks or pulses */
  enum eo_layout_kind kind;
};

/* For people: the name of a column, or its number. */
static const char *label(const struct guess *g, int column, char *text, size_t size)
{
  const char *name = eo_recording_name(g->recording, column);
  if (*name)
    snprintf(text, size, "\"%s\"", name);
  else
    snprintf(text, size, "column %d", column + 1);
  return text;
}

/* A column by its name, else by its number. */
static enum eo_code find_chosen(const struct guess *g, const char *chosen, const char *pointer, int *column,
                                struct eo_error *error)
{
  for (int c = 0; c < g->columns; c++)
    if (!strcmp(eo_recording_name(g->recording, c), chosen)) {
      *column = c;
      return EO_OK;
    }
  char *end;
  long number = strtol(chosen, &end, 10);
  if (end == chosen || *end || number < 1 || number > g->columns)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "The recording has no column \"%.60s\"; it has %d columns.",
                        chosen, g->columns);
  *column = (int)number - 1;
  return EO_OK;
}

/* Time goes up by nearly equal steps and never starts again; a unit or a name that says so counts more than the values.
 */
static double time_score(const struct guess *g, int column)
{
  const struct eo_column *look = &g->look[column];
  const char *name = eo_recording_name(g->recording, column);
  if (look->count < 2 || look->falls > look->rises / 10 || look->step <= 0)
    return 0;
  double score = look->quantity == EO_QUANTITY_TIME ? 4 : 0;
  score += eo_column_named(name, TIME_WORDS) ? 2 : 0;
  if (score > 0 || look->quantity != EO_QUANTITY_NONE || *name)
    return score;
  return !look->resets && look->spread < 1e-3 && look->step < 0.1 && !look->whole ? 1 / (1 + look->spread) : 0;
}

/* Several columns of times with different lengths, and nothing else, are pulses. */
static bool looks_like_pulses(const struct guess *g)
{
  int times = 0;
  bool uneven = false;
  for (int c = 0; c < g->columns; c++) {
    const struct eo_column *look = &g->look[c];
    if (look->falls || look->resets || look->rises < 2 ||
        (look->quantity != EO_QUANTITY_TIME && look->quantity != EO_QUANTITY_NONE))
      return false;
    times++;
    uneven = uneven || eo_recording_length(g->recording, c) != eo_recording_length(g->recording, 0) ||
             look->quantity == EO_QUANTITY_TIME;
  }
  return times == 2 && uneven && g->look[1].quantity == g->look[0].quantity &&
         !(eo_recording_clock(g->recording, 0).interval > 0);
}

/* Without a column of time the rows are even: an interval from the file or the caller. */
static enum eo_code find_interval(struct guess *g, struct eo_error *error)
{
  g->tracks->time_column = -1;
  g->tracks->interval = g->choice->sample_rate > 0 ? 1 / g->choice->sample_rate
                                                   : eo_recording_clock(g->recording, 0).interval;
  if (!(g->tracks->interval > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/sample_rate_Hz",
                        "No column holds the time and the file states no sampling rate; give one.");
  if (!(g->choice->sample_rate > 0))
    eo_notes_add(g->notes, "The file states a sampling rate of %.8g Hz.", 1 / g->tracks->interval);
  return EO_OK;
}

static enum eo_code find_time(struct guess *g, struct eo_error *error)
{
  char text[80];
  int best = -1;
  g->tracks->time_scale = g->choice->time_scale > 0 ? g->choice->time_scale : 1;
  if (g->choice->time && strcmp(g->choice->time, "none")) {
    enum eo_code code = find_chosen(g, g->choice->time, "/time", &best, error);
    if (code)
      return code;
  } else if (!g->choice->time && !(g->choice->sample_rate > 0)) {
    double most = 0;
    for (int c = 0; c < g->columns; c++)
      if (time_score(g, c) > most) {
        most = time_score(g, c);
        best = c;
      }
  }
  if (best < 0)
    return find_interval(g, error);
  g->tracks->time_column = best;
  if (g->look[best].quantity == EO_QUANTITY_TIME && !(g->choice->time_scale > 0))
    g->tracks->time_scale = g->look[best].factor;
  eo_notes_add(g->notes, "%s is taken as time in units of %g s: steps of %.6g s.", label(g, best, text, sizeof text),
               g->tracks->time_scale, g->look[best].step * g->tracks->time_scale);
  return EO_OK;
}

/* What is neither time nor empty, constant or of another quantity. */
static void find_candidates(struct guess *g)
{
  for (int c = 0; c < g->columns; c++) {
    const struct eo_column *look = &g->look[c];
    if (c == g->tracks->time_column || !look->count || look->quantity == EO_QUANTITY_OTHER ||
        (look->quantity == EO_QUANTITY_TIME && g->kind != EO_LAYOUT_PULSES))
      continue;
    if (look->quantity != EO_QUANTITY_ANGLE && eo_column_named(eo_recording_name(g->recording, c), OTHER_WORDS))
      continue;
    g->candidate[g->candidates++] = c;
  }
}

/* Raw tracks swing to and fro; an angle goes one way, but for its resets. */
static bool swings(const struct eo_column *look)
{
  int less = look->rises < look->falls ? look->rises : look->falls;
  return less - look->resets > (look->rises + look->falls) / 10;
}

static enum eo_layout_kind guess_kind(const struct guess *g)
{
  int tracks = 0;
  for (int i = 0; i < g->candidates; i++) {
    int c = g->candidate[i];
    const char *name = eo_recording_name(g->recording, c);
    bool named = eo_column_named(name, "sin|sine|sinus|cos|cosine|kosinus|cosinus");
    bool measured = g->look[c].quantity == EO_QUANTITY_VOLTAGE || g->look[c].quantity == EO_QUANTITY_CURRENT;
    tracks += g->look[c].quantity != EO_QUANTITY_ANGLE && (named || measured || swings(&g->look[c]));
  }
  return tracks >= 4 ? EO_LAYOUT_SINE_COSINE : EO_LAYOUT_ANGLES;
}

/* 1: the name says sine, -1: cosine, 0: neither. */
static int sine_or_cosine(const char *name)
{
  int word = eo_column_named(name, SINE_WORDS) - eo_column_named(name, COSINE_WORDS);
  return word ? word : eo_column_named(name, SINE_LETTER) - eo_column_named(name, COSINE_LETTER);
}

/* How well a column's name fits a member and a track (0: sine or the only one, 1: cosine). */
static int fit_of(const struct guess *g, int column, int member, int track)
{
  const char *name = eo_recording_name(g->recording, column);
  int fit = eo_column_named(name, member ? GEAR_WORDS : PINION_WORDS) -
            eo_column_named(name, member ? PINION_WORDS : GEAR_WORDS);
  if (g->kind == EO_LAYOUT_SINE_COSINE)
    fit += 2 * (track ? -1 : 1) * sine_or_cosine(name);
  if (g->kind == EO_LAYOUT_ANGLES &&
      (g->look[column].quantity == EO_QUANTITY_ANGLE || g->look[column].quantity == EO_QUANTITY_COUNT))
    fit += 4;
  return fit;
}

/* Columns that the caller named come first; each other place then takes the best fitting column, the earlier one of
   equals. */
static enum eo_code assign(struct guess *g, struct eo_error *error)
{
  int tracks = g->kind == EO_LAYOUT_SINE_COSINE ? 2 : 1;
  bool taken[EO_RECORDING_COLUMNS] = {false};
  for (int member = 0; member < 2; member++)
    for (int track = 0; track < tracks; track++) {
      int *column = &g->tracks->channel[member].column[track];
      *column = -1;
      if (!g->choice->column[member][track])
        continue;
      enum eo_code code = find_chosen(g, g->choice->column[member][track], "/columns", column, error);
      if (code)
        return code;
      taken[*column] = true;
    }
  for (int place = 0; place < 2 * tracks; place++) {
    int member = place / tracks, track = place % tracks, best = -1, most = -1000;
    int *column = &g->tracks->channel[member].column[track];
    for (int i = 0; *column < 0 && i < g->candidates; i++) {
      int fit = fit_of(g, g->candidate[i], member, track);
      if (!taken[g->candidate[i]] && fit > most) {
        most = fit;
        best = g->candidate[i];
      }
    }
    if (*column < 0 && best < 0)
      return eo_error_set(error, EO_ERROR_INPUT, "/columns",
                          "The recording has %d column%s that may hold an encoder's values; %d are needed.",
                          g->candidates, g->candidates == 1 ? "" : "s", 2 * tracks);
    if (*column < 0)
      *column = best;
    taken[*column] = true;
  }
  return EO_OK;
}

/* Without a unit and without turns: degrees unless the shaft would then crawl. */
static double scale_by_speed(const struct guess *g, const struct eo_column *look)
{
  double step = g->tracks->interval;
  if (g->tracks->time_column >= 0)
    step = g->look[g->tracks->time_column].step * g->tracks->time_scale;
  double rpm = fabs(look->step) / step / 6; /* as degrees */
  return rpm < 60 && rpm * 180 / M_PI < 30000 ? 1 : TURN / 360;
}

static const char *scale_name(double scale)
{
  return scale == 1 ? "radians" : scale == TURN ? "turns" : fabs(scale - TURN / 360) < 1e-9 ? "degrees" : "counts";
}

static enum eo_code find_scale(struct guess *g, int member, struct eo_error *error)
{
  struct eo_track_channel *channel = &g->tracks->channel[member];
  const struct eo_column *look = &g->look[channel->column[0]];
  double lines = g->choice->lines[member];
  bool counts = g->choice->unit == EO_LAYOUT_COUNT || (!g->choice->unit && look->quantity == EO_QUANTITY_COUNT);
  channel->scale = g->choice->unit == EO_LAYOUT_DEGREE   ? TURN / 360
                   : g->choice->unit == EO_LAYOUT_RADIAN ? 1
                   : g->choice->unit == EO_LAYOUT_TURN   ? TURN
                                                         : 0;
  if (!g->choice->unit && look->quantity == EO_QUANTITY_ANGLE)
    channel->scale = look->factor;
  else if (lines > 0 && (counts || (!g->choice->unit && look->whole)))
    channel->scale = TURN / lines;
  double turn = eo_column_turn(look);
  if (!(channel->scale > 0) && turn > 0)
    channel->scale = TURN / turn;
  if (channel->scale > 0)
    return EO_OK;
  char text[80];
  if (counts || look->whole)
    return eo_error_set(error, EO_ERROR_INPUT, "/lines", "%s counts; give the counts per turn of the %s's encoder.",
                        label(g, channel->column[0], text, sizeof text), member_names[member]);
  channel->scale = scale_by_speed(g, look);
  eo_notes_add(g->notes, "Nothing states the unit of %s; %s are a guess from its speed.",
               label(g, channel->column[0], text, sizeof text), scale_name(channel->scale));
  return EO_OK;
}

static void note_angle(const struct guess *g, int member)
{
  const struct eo_track_channel *channel = &g->tracks->channel[member];
  const struct eo_column *look = &g->look[channel->column[0]];
  char text[80], turns[48] = "not starting again";
  if (look->resets)
    snprintf(turns, sizeof turns, "starting again after %.6g",
             eo_column_turn(look) > 0 ? eo_column_turn(look) : look->period);
  eo_notes_add(g->notes, "%s is taken as the angle of the %s in %s of %.6g rad, %s.",
               label(g, channel->column[0], text, sizeof text), member_names[member], scale_name(channel->scale),
               channel->scale, turns);
}

static enum eo_code settle_lines(struct guess *g, int member, struct eo_error *error)
{
  struct eo_track_channel *channel = &g->tracks->channel[member];
  char text[80], second[80];
  const struct eo_column *look = &g->look[channel->column[0]];
  channel->lines = g->choice->lines[member];
  channel->factor = 1;
  if (!(channel->lines > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/lines", "Give the %s per turn of the %s's encoder.",
                        g->kind == EO_LAYOUT_PULSES ? "pulses" : "lines (sine periods)", member_names[member]);
  if (g->kind == EO_LAYOUT_PULSES) {
    eo_notes_add(g->notes, "%s is taken as the times of the pulses of the %s.",
                 label(g, channel->column[0], text, sizeof text), member_names[member]);
    return EO_OK;
  }
  if (look->quantity == EO_QUANTITY_VOLTAGE) {
    channel->unit = EO_TRACK_VOLT;
    channel->factor = look->factor;
  } else if (look->quantity == EO_QUANTITY_CURRENT) {
    channel->unit = EO_TRACK_MICROAMPERE;
    channel->factor = look->factor * 1e6;
  }
  eo_notes_add(g->notes, "%s and %s are taken as the sine and cosine tracks of the %s.",
               label(g, channel->column[0], text, sizeof text), label(g, channel->column[1], second, sizeof second),
               member_names[member]);
  return EO_OK;
}

static enum eo_code settle(struct guess *g, struct eo_error *error)
{
  static const enum eo_track tracks[] = {[EO_LAYOUT_ANGLES] = EO_TRACK_ANGLE,
                                         [EO_LAYOUT_SINE_COSINE] = EO_TRACK_SINE_COSINE,
                                         [EO_LAYOUT_PULSES] = EO_TRACK_PULSES};
  for (int member = 0; member < 2; member++) {
    g->tracks->channel[member].track = tracks[g->kind];
    enum eo_code code = g->kind == EO_LAYOUT_ANGLES ? find_scale(g, member, error) : settle_lines(g, member, error);
    if (code)
      return code;
    if (g->kind == EO_LAYOUT_ANGLES)
      note_angle(g, member);
  }
  return EO_OK;
}

static enum eo_code find(struct guess *g, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int c = 0; !code && c < g->columns; c++)
    code = eo_column_look(g->recording, c, &g->look[c], error);
  if (code)
    return code;
  g->kind = g->choice->kind ? g->choice->kind : looks_like_pulses(g) ? EO_LAYOUT_PULSES : EO_LAYOUT_GUESS_KIND;
  g->tracks->time_column = -1;
  if (g->kind == EO_LAYOUT_PULSES)
    g->tracks->time_scale = g->choice->time_scale > 0                 ? g->choice->time_scale
                            : g->look[0].quantity == EO_QUANTITY_TIME ? g->look[0].factor
                                                                      : 1;
  else
    code = find_time(g, error);
  if (code)
    return code;
  find_candidates(g);
  if (!g->kind)
    g->kind = guess_kind(g);
  code = assign(g, error);
  return code ? code : settle(g, error);
}

enum eo_code eo_layout_find(struct eo_recording **recording, const struct eo_layout_choice *choice,
                            const struct eo_layout_pair *pair, const char *spool_directory, struct eo_tracks *tracks,
                            struct eo_notes *notes, struct eo_error *error)
{
  (void)pair;
  (void)spool_directory;
  static const struct eo_layout_choice none;
  struct guess *g = calloc(1, sizeof *g);
  if (!g)
    return eo_error_memory(error);
  struct eo_tracks found = {0};
  g->recording = *recording;
  g->choice = choice ? choice : &none;
  g->tracks = &found;
  g->notes = notes;
  g->columns = eo_recording_columns(*recording);
  enum eo_code code = find(g, error);
  if (!code)
    *tracks = found;
  free(g);
  return code;
}

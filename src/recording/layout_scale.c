/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one unit of an encoder's column is in rad: by its unit, the counts per turn, where it starts again, or its
 * speed. */
#include "recording/layout_private.h"

#include "gear/names.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* How far a speed is from the load cases of the design, as the logarithm of what lies between. */
static double distance(const struct eo_guess *guess, double speed)
{
  return speed < guess->pair->speed[0]   ? log(guess->pair->speed[0] / speed)
         : speed > guess->pair->speed[1] ? log(speed / guess->pair->speed[1])
                                         : 0;
}

/* The unit of the angle that brings the pinion nearest to a load case, or to the speed that was stated, which is more:
   gon and turns come into question then, too. */
static double nearest_scale(const struct eo_guess *guess, double rate)
{
  static const double scales[] = {EO_TURN / 360, 1, EO_TURN, EO_TURN / 400};
  int best = 0;
  for (int i = 1; i < (guess->pair->stated ? 4 : 2); i++)
    best = distance(guess, rate * scales[i]) < distance(guess, rate * scales[best]) ? i : best;
  return scales[best];
}

/* Of the pinion, in the unit of both columns, whichever of them is taken for it so far. */
static double pinion_rate(const struct eo_guess *guess, double own, double other, int member)
{
  const int *teeth = guess->pair->teeth;
  if (eo_layout_is_tooth_ratio(guess, other / own))
    return teeth[1] > teeth[0] ? fmax(own, other) : fmin(own, other);
  return own * teeth[member] / fmax(teeth[0], 1);
}

/* Without a unit and without turns: degrees unless the shaft would then crawl; both shafts have one unit where they
   turn in the ratio of the teeth. */
static double scale_by_speed(const struct eo_guess *guess, int member)
{
  const struct eo_track_channel *channel = guess->tracks->channel;
  double rate = fabs(eo_layout_rate(guess, channel[member].column[0], &guess->clock[member]));
  double other = fabs(eo_layout_rate(guess, channel[!member].column[0], &guess->clock[!member]));
  if (member && channel[0].doubt == EO_DOUBT_UNIT && eo_layout_is_tooth_ratio(guess, other / rate))
    return channel[0].scale;
  if (guess->pair && guess->pair->speed[1] > 0 && rate > 0 && (guess->pair->stated || eo_layout_is_open(guess, member)))
    return nearest_scale(guess, pinion_rate(guess, rate, other, member) / eo_layout_time_factor(guess, member));

  double rpm = rate / 6; /* as degrees */
  return rpm < 60 && rpm * 180 / M_PI < 30000 ? 1 : EO_TURN / 360;
}

const char *eo_layout_scale_name(double scale)
{
  return scale == 1                           ? "radians"
         : scale == EO_TURN                   ? "turns"
         : fabs(scale - EO_TURN / 360) < 1e-9 ? "degrees"
         : fabs(scale - EO_TURN / 400) < 1e-9 ? "gon"
                                              : "counts";
}

/* Counts per turn: as chosen, as the file states, or by where they start again; 0: not known. */
static double counts_per_turn(const struct eo_guess *guess, int member)
{
  int column = guess->tracks->channel[member].column[0];
  if (guess->choice->lines[member] > 0)
    return guess->choice->lines[member];
  if (eo_recording_turn(guess->recording, column) > 0)
    return eo_recording_turn(guess->recording, column);
  return eo_column_turn(&guess->look[column]);
}

bool eo_layout_has_unit(const struct eo_guess *guess, int column)
{
  const char *unit = eo_recording_unit(guess->recording, column);
  return *unit && strcmp(unit, "-") && strcmp(unit, "1") && strcasecmp(unit, "none") && strcmp(unit, "--");
}

/* A unit that the file states must be known: a guess in its place would be a wrong speed. */
static enum eo_code check_unit(const struct eo_guess *guess, int member, struct eo_error *error)
{
  int column = guess->tracks->channel[member].column[0];
  const char *unit = eo_recording_unit(guess->recording, column);
  enum eo_quantity q = guess->look[column].quantity;
  char text[80];
  if (guess->choice->unit || !eo_layout_has_unit(guess, column) || q == EO_QUANTITY_ANGLE || q == EO_QUANTITY_COUNT)
    return EO_OK;
  if (q == EO_QUANTITY_NONE)
    return eo_error_set(error, EO_ERROR_INPUT, "/unit",
                        "The file states \"%s\" as the unit of %s, which is not known here: give the unit (deg, rad, "
                        "turn, or count with the counts per turn).",
                        unit, eo_layout_label(guess, column, text, sizeof text));
  return eo_error_set(
      error, EO_ERROR_INPUT, "/unit",
      "%s is in %s, which is no angle: choose other columns, or the kind (sine-cosine for raw tracks), or "
      "give the unit of an angle.",
      eo_layout_label(guess, column, text, sizeof text), unit);
}

/* Counters have 16, 24 or 32 bits; encoders of one turn may have as many. */
static bool is_counter_width(double turn)
{
  return turn == 65536 || turn == 16777216 || turn == 4294967296;
}

enum eo_code eo_layout_find_scale(struct eo_guess *guess, int member, struct eo_error *error)
{
  struct eo_track_channel *channel = &guess->tracks->channel[member];
  const struct eo_column *look = &guess->look[channel->column[0]];
  bool counts = guess->choice->unit == EO_LAYOUT_COUNT || (!guess->choice->unit && look->quantity == EO_QUANTITY_COUNT);
  double turn = counts_per_turn(guess, member);
  bool stated = guess->choice->lines[member] > 0 || eo_recording_turn(guess->recording, channel->column[0]) > 0;
  enum eo_code code = check_unit(guess, member, error);
  if (code)
    return code;
  channel->scale = guess->choice->unit == EO_LAYOUT_DEGREE   ? EO_TURN / 360
                   : guess->choice->unit == EO_LAYOUT_RADIAN ? 1
                   : guess->choice->unit == EO_LAYOUT_TURN   ? EO_TURN
                                                             : 0;
  if (!guess->choice->unit && look->quantity == EO_QUANTITY_ANGLE) {
    bool grad = !strcasecmp(eo_recording_unit(guess->recording, channel->column[0]), "grad");
    channel->scale = grad && eo_column_turn(look) == 400 ? EO_TURN / 400 : look->factor;
    channel->doubt = grad && !look->resets ? EO_DOUBT_GRAD : EO_DOUBT_NONE;
  } else if (turn > 0 && (counts || (!guess->choice->unit && (!stated || look->whole)))) {
    channel->scale = EO_TURN / turn;
    channel->doubt = stated ? EO_DOUBT_EDGES : is_counter_width(turn) ? EO_DOUBT_WIDTH : EO_DOUBT_NONE;
  }
  if (channel->scale > 0)
    return EO_OK;
  char text[80];
  if (counts || look->whole)
    return eo_error_set(error, EO_ERROR_INPUT, "/lines", "%s counts; give the counts per turn of the %s's encoder.",
                        eo_layout_label(guess, channel->column[0], text, sizeof text), eo_member_name[member]);
  channel->scale = scale_by_speed(guess, member);
  channel->doubt = EO_DOUBT_UNIT;
  eo_notes_add(guess->notes, "Nothing states the unit of %s; %s are a guess from its speed.",
               eo_layout_label(guess, channel->column[0], text, sizeof text), eo_layout_scale_name(channel->scale));
  return EO_OK;
}

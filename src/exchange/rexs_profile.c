/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modifications of the profile. With the rolling length rho(d) = sqrt(d^2/4 - r_b^2) and T = r_b tan(alpha_wt), the
   profile coordinate of a design is u = k_u (rho - T), k_u = sin(alpha_t)/cos(alpha_n): affine, so shapes keep their
   names. */
#include <math.h>
#include <string.h>

#include "exchange/flank_amount.h"
#include "exchange/rexs_flank.h"

static const double close = 1e-6; /* mm: profile coordinates that are one; 0.001 um of u */

double eo_rexs_roll(const struct eo_rexs_flank *flank, double diameter)
{
  double base = 1e3 * flank->import->geometry.base_radius[flank->member];
  return sqrt(diameter * diameter / 4 - base * base); /* NaN below the base circle */
}

double eo_rexs_profile(const struct eo_rexs_flank *flank, double roll)
{
  const struct eo_geometry *geometry = &flank->half;
  return geometry->rack_factor * (roll - 1e3 * geometry->tangent_length[flank->member]);
}

double eo_rexs_tip_end(const struct eo_rexs_flank *flank)
{
  const struct eo_geometry *geometry = &flank->half;
  return 1e3 * (flank->member == EO_PINION ? geometry->rack_top : -geometry->rack_bottom);
}

double eo_rexs_root_end(const struct eo_rexs_flank *flank)
{
  const struct eo_geometry *geometry = &flank->half;
  return 1e3 * (flank->member == EO_PINION ? geometry->rack_bottom : -geometry->rack_top);
}

static double first_number(double a, double b)
{
  return isnan(a) ? b : a;
}

/* Where the profile ends that lengths are measured from: form diameter, else tip or root of the geometry. */
static double tip_roll(const struct eo_rexs_flank *flank)
{
  double form = eo_rexs_value(flank->wheel->gear, "tip_form_diameter");
  return eo_rexs_roll(flank, first_number(form, 2e3 * flank->import->geometry.tip_radius[flank->member]));
}

static double root_roll(const struct eo_rexs_flank *flank)
{
  double form = eo_rexs_value(flank->wheel->gear, "root_form_diameter");
  return eo_rexs_roll(flank, first_number(form, 2e3 * flank->import->geometry.form_radius[flank->member]));
}

/* The names of a relief's attributes. */
struct relief_names {
  const char *depth, *diameter, *length, *reference, *reference_length;
  bool tip;
};

/* A rolling length that is stated as a length from the end of the profile; longer than the profile: absolute. */
static double from_end(const struct eo_rexs_flank *flank, const struct relief_names *names, double length)
{
  double tip = tip_roll(flank), root = root_roll(flank);
  if (isnan(length))
    return NAN;
  if (length > tip - root)
    return length;
  eo_import_say(flank->import->out, flank->import->out->assumed,
                names->tip ? "tip_relief_datum_length runs down from the tip"
                           : "root_relief_datum_length runs up from the root form circle");
  return names->tip ? tip - length : root + length;
}

static const char *read_relief(struct eo_rexs_flank *flank, const struct eo_rexs_component *relief,
                               const struct relief_names *names, double *amount, double *start, const char **shape)
{
  static const char *const shapes[] = {"parabolic", "linear", "circular"};
  const struct eo_rexs_attribute *word = eo_rexs_attribute(relief, "shape_of_relief");
  double depth = eo_rexs_value(relief, names->depth) * flank->amount, sign = names->tip ? 1 : -1;
  *shape = word ? NULL : "linear";
  for (int i = 0; i < 3 && word; i++)
    if (strcmp(word->text, shapes[i]) == 0)
      *shape = shapes[i];
  if (!*shape)
    return strcmp(word->text, "logarithmic") == 0 ? "shape logarithmic" : "shape exponential";
  if (!word)
    eo_import_say(flank->import->out, flank->import->out->assumed, "a relief without shape_of_relief is linear");
  if (eo_rexs_flag(relief, "specify_tangential_transition"))
    return "a rounded transition changes where the relief starts";
  if (isnan(depth))
    return "no depth";
  double from = eo_rexs_roll(flank, eo_rexs_value(relief, names->diameter));
  if (isnan(from))
    from = from_end(flank, names, eo_rexs_value(relief, names->length));
  double to = eo_rexs_roll(flank, eo_rexs_value(relief, names->reference));
  if (isnan(to) && !isnan(eo_rexs_value(relief, names->reference_length)))
    to = from_end(flank, names, eo_rexs_value(relief, names->reference_length));
  to = first_number(to, names->tip ? tip_roll(flank) : root_roll(flank));
  double u = sign * eo_rexs_profile(flank, from), reference = sign * eo_rexs_profile(flank, to);
  double end = sign * (names->tip ? eo_rexs_tip_end(flank) : eo_rexs_root_end(flank));
  if (isnan(u) || isnan(reference))
    return "its start is not stated, or below the base circle";
  if (u < -close)
    return "it starts beyond the pitch point";
  if (reference <= u + close || end <= u + close)
    return "it starts outside the active profile";
  *start = fabs(u) < close ? 0 : u;
  *amount = eo_relief_carry(*shape, depth, reference - u, end - u);
  return "";
}

const char *eo_rexs_tip_relief(struct eo_rexs_flank *flank, const struct eo_rexs_component *relief)
{
  static const struct relief_names names = {"tip_relief_depth",
                                            "tip_relief_datum_diameter",
                                            "tip_relief_datum_length",
                                            "tip_relief_evaluation_reference",
                                            "tip_relief_evaluation_reference_length",
                                            true};
  return read_relief(flank, relief, &names, &flank->tip_relief, &flank->tip_start, &flank->tip_shape);
}

const char *eo_rexs_root_relief(struct eo_rexs_flank *flank, const struct eo_rexs_component *relief)
{
  static const struct relief_names names = {"root_relief_depth",
                                            "root_relief_datum_diameter",
                                            "root_relief_datum_length",
                                            "root_relief_evaluation_reference",
                                            "root_relief_evaluation_reference_length",
                                            false};
  return read_relief(flank, relief, &names, &flank->root_relief, &flank->root_start, &flank->root_shape);
}

/* a_m = C / (u - u_h)^2 on both sides of the highest point. */
const char *eo_rexs_profile_crowning(struct eo_rexs_flank *flank, const struct eo_rexs_component *crowning)
{
  const double agree = 0.02, in_middle = 1e-3;
  double tip = eo_rexs_value(crowning, "profile_crowning_at_tip") * flank->amount,
         root = eo_rexs_value(crowning, "profile_crowning_at_root") * flank->amount;
  double at_tip = eo_rexs_roll(flank, eo_rexs_value(crowning, "diameter_where_profile_crowning_tip_is_specified")),
         at_root = eo_rexs_roll(flank, eo_rexs_value(crowning, "diameter_where_profile_crowning_root_is_specified"));
  double u_tip = eo_rexs_profile(flank, first_number(at_tip, tip_roll(flank))),
         u_root = eo_rexs_profile(flank, first_number(at_root, root_roll(flank)));
  double highest = eo_rexs_profile(flank, eo_rexs_roll(flank, eo_rexs_value(crowning, "profile_highest_point")));
  if (isnan(highest)) {
    highest = (u_tip + u_root) / 2;
    eo_import_say(flank->import->out, flank->import->out->assumed,
                  "a profile crowning without profile_highest_point is highest in the middle of its range");
  }
  double up = tip / pow(u_tip - highest, 2), down = root / pow(u_root - highest, 2), a = first_number(up, down);
  if (isnan(a))
    return "no amount";
  if (fabs(up - down) > agree * fabs(a))
    return "its parabola differs on both sides of the highest point";
  double end = eo_rexs_tip_end(flank), start = eo_rexs_root_end(flank), middle = (end + start) / 2;
  if (fabs(highest) <= close)
    flank->crowning = a;
  else if (fabs(highest - middle) <= in_middle * (end - start))
    flank->barrel = a * pow((end - start) / 2, 2);
  else
    return "its highest point is neither the pitch point nor the middle of the active profile";
  return "";
}

/* The part of a length over which an amount is stated, as the active profile needs it. */
static double over_active(const struct eo_rexs_flank *flank, const struct eo_rexs_component *modification,
                          const char *from, const char *to)
{
  double start = eo_rexs_profile(flank, eo_rexs_roll(flank, eo_rexs_value(modification, from))),
         end = eo_rexs_profile(flank, eo_rexs_roll(flank, eo_rexs_value(modification, to)));
  double active = eo_rexs_tip_end(flank) - eo_rexs_root_end(flank);
  if (isnan(start) || isnan(end) || fabs(end - start) <= close)
    return 1;
  return active / fabs(end - start);
}

const char *eo_rexs_profile_slope(struct eo_rexs_flank *flank, const struct eo_rexs_component *slope)
{
  double amount = eo_rexs_value(slope, "profile_slope") * flank->amount;
  if (isnan(amount))
    return "no amount";
  flank->profile_slope = amount * over_active(flank, slope, "profile_evaluation_start", "profile_evaluation_end");
  return "";
}

const char *eo_rexs_profile_twist(struct eo_rexs_flank *flank, const struct eo_rexs_component *twist)
{
  double amount = eo_rexs_value(twist, "profile_twist") * flank->amount;
  double from = eo_rexs_value(twist, "position_of_profile_twist_datum_face"),
         to = eo_rexs_value(twist, "position_of_profile_twist_non_datum_face");
  double along = isnan(from) || isnan(to) || fabs(to - from) <= close ? 1 : flank->width / fabs(to - from);
  if (isnan(amount))
    return "no amount";
  flank->twist = amount * along * (flank->datum == flank->leading ? -1 : 1) *
                 over_active(flank, twist, "profile_twist_evaluation_start", "profile_twist_evaluation_end");
  return "";
}

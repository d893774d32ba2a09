/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modifications of the flank line, and topographies. y: axial from the common mid face, + towards the face that meets
   first; b: common face width. */
#include <math.h>
#include <string.h>

#include "exchange/flank_amount.h"
#include "exchange/rexs_flank.h"
#include "gear/names.h"

/* Axial coordinate towards the face that meets first, from the common mid face, of a coordinate of a modification (from
   the gear's mid face, - at the datum face). */
static double axial_place(const struct eo_rexs_flank *flank, double coordinate)
{
  return (-flank->datum * coordinate + flank->shift) * flank->leading;
}

/* a (y - y_0)^2 = a y^2 - 2 a y_0 y + a y_0^2: crowning, slope and offset. */
const char *eo_rexs_helix_crowning(struct eo_rexs_flank *flank, const struct eo_rexs_component *crowning)
{
  const double agree = 0.02;
  double half = flank->width / 2;
  double at[2] = {eo_rexs_value(crowning, "coordinate_where_helix_crowning_is_specified_datum_face"),
                  eo_rexs_value(crowning, "coordinate_where_helix_crowning_is_specified_non_datum_face")};
  double amount[2] = {eo_rexs_value(crowning, "helix_crowning_amount_datum_face") * flank->amount,
                      eo_rexs_value(crowning, "helix_crowning_amount_non_datum_face") * flank->amount};
  double highest = eo_rexs_value(crowning, "helix_highest_point");
  highest = isnan(highest) ? 0 : highest;
  for (int i = 0; i < 2; i++)
    at[i] = isnan(at[i]) ? (i ? 0.5 : -0.5) * flank->wheel->face_width : at[i];
  double a[2] = {amount[0] / pow(at[0] - highest, 2), amount[1] / pow(at[1] - highest, 2)};
  double curvature = isnan(a[0]) ? a[1] : a[0];
  if (!isfinite(curvature))
    return "no amount, or none away from its highest point";
  if (fabs(a[1] - a[0]) > agree * fabs(curvature))
    return "its parabola differs on both sides of the highest point";
  double place = axial_place(flank, highest);
  if (flank->wheel->face_width > flank->width * (1 + 1e-9) && highest == 0) {
    place = 0;
    eo_import_say(flank->import->out, flank->import->out->assumed,
                  "a crowning of the %s is centred on the common face width", eo_member_name[flank->member]);
  }
  flank->lead_crowning = curvature * half * half;
  if (place != 0) {
    flank->helix_slope = (isnan(flank->helix_slope) ? 0 : flank->helix_slope) - 4 * curvature * place * half;
    flank->lead_offset = (isnan(flank->lead_offset) ? 0 : flank->lead_offset) + curvature * place * place;
  }
  return "";
}

/* Over the face width; + where the face that meets first loses more. */
const char *eo_rexs_helix_slope(struct eo_rexs_flank *flank, const struct eo_rexs_component *slope)
{
  double start = eo_rexs_value(slope, "helix_evaluation_start"), end = eo_rexs_value(slope, "helix_evaluation_end");
  double length = fabs(end - start), amount = eo_rexs_value(slope, "helix_slope") * flank->amount;
  double away = flank->import->options->reversed ? flank->datum : -flank->datum;
  if (isnan(amount))
    return "no amount";
  length = isnan(length) || length == 0 ? flank->wheel->face_width : length;
  eo_import_say(flank->import->out, flank->import->out->assumed,
                "helix_slope: positive takes material off towards the %s face",
                flank->import->options->reversed ? "datum" : "non-datum");
  flank->helix_slope = (isnan(flank->helix_slope) ? 0 : flank->helix_slope) +
                       amount * flank->width / length * (away == flank->leading ? 1 : -1);
  return "";
}

/* What is left of it at the end of the common face, where the gear's own face goes beyond. */
const char *eo_rexs_end_relief(struct eo_rexs_flank *flank, const struct eo_rexs_component *relief)
{
  bool datum = eo_rexs_is(relief, "end_relief_datum_face");
  double depth = eo_rexs_value(relief, datum ? "end_relief_depth_datum_face" : "end_relief_depth_non_datum_face"),
         length = eo_rexs_value(relief, datum ? "end_relief_length_datum_face" : "end_relief_length_non_datum_face"),
         reference = eo_rexs_value(relief, datum ? "end_relief_evaluation_reference_datum_face"
                                                 : "end_relief_evaluation_reference_non_datum_face");
  const struct eo_rexs_attribute *shape = eo_rexs_attribute(relief, "shape_of_relief");
  double towards = datum ? flank->datum : -flank->datum; /* of x */
  const char *word = shape ? shape->text : "linear";
  static const char *const shapes[] = {"parabolic", "linear", "circular"};
  int known = 0;
  if (isnan(depth) || !(length > 0))
    return "no depth or no length";
  while (known < 3 && strcmp(word, shapes[known]) != 0)
    known++;
  if (known == 3)
    return "its shape";
  if (eo_rexs_flag(relief, "specify_tangential_transition"))
    return "a rounded transition changes where the relief starts";
  double own = flank->wheel->face_width / 2, reach = isnan(reference) ? length : fabs(reference) - (own - length);
  double left = length - (own - flank->width / 2) - towards * flank->shift;
  int side = towards == flank->leading;
  if (left <= 0 || !(reach > 0)) {
    eo_import_say(flank->import->out, flank->import->out->notes,
                  "%s %d lies outside the common face width and takes nothing off in mesh.", relief->type, relief->id);
    return "";
  }
  flank->end_relief[side] = eo_relief_carry(shapes[known], depth, reach, left) * flank->amount;
  flank->end_length[side] = left;
  flank->end_shape[side] = shapes[known];
  return "";
}

static int compare_numbers(const double *value, int count)
{
  bool up = true, down = true;
  for (int i = 1; i < count; i++) {
    up = up && value[i] > value[i - 1];
    down = down && value[i] < value[i - 1];
  }
  return up ? 1 : down ? -1 : 0;
}

/* Amounts over diameters and face coordinates; diameter by diameter. */
const char *eo_rexs_topography(struct eo_rexs_flank *flank, const struct eo_rexs_component *topography)
{
  enum { MOST = 200 };
  const struct eo_rexs_attribute *over[2] = {eo_rexs_attribute(topography, "diameters_of_topographical_modification"),
                                             eo_rexs_attribute(topography,
                                                               "coordinates_of_topographical_modification")},
                                 *amounts = eo_rexs_attribute(topography, "topographical_modification_amounts");
  double u[MOST], y[MOST];
  int rows = over[0] ? over[0]->count : 0, columns = over[1] ? over[1]->count : 0;
  if (rows < 2 || columns < 2 || rows > MOST || columns > MOST || !amounts || amounts->count != rows * columns)
    return "its diameters, coordinates and amounts do not fit each other, or are fewer than 2 or more than 200";
  for (int i = 0; i < rows; i++)
    u[i] = eo_rexs_profile(flank, eo_rexs_roll(flank, over[0]->value[i]));
  for (int k = 0; k < columns; k++)
    y[k] = axial_place(flank, over[1]->value[k]);
  int up = compare_numbers(u, rows), along = compare_numbers(y, columns);
  if (!up || !along)
    return "its diameters and coordinates do not rise or fall throughout, or lie below the base circle";
  json_t *u_list = json_array(), *y_list = json_array(), *table = json_array();
  for (int k = 0; k < columns; k++)
    json_array_append_new(y_list, json_real(y[along > 0 ? k : columns - 1 - k]));
  for (int i = 0; i < rows; i++) {
    int from = up > 0 ? i : rows - 1 - i;
    json_t *row = json_array();
    json_array_append_new(u_list, json_real(u[from]));
    for (int k = 0; k < columns; k++) {
      double amount = amounts->value[from * columns + (along > 0 ? k : columns - 1 - k)];
      json_array_append_new(row, json_real(1e3 * amount * flank->amount));
    }
    json_array_append_new(table, row);
  }
  json_decref(flank->grid);
  flank->grid = json_pack("{s:o, s:o, s:o, s:s}", "u_mm", u_list, "y_mm", y_list, "delta_um", table, "kind",
                          "designed");
  eo_import_say(flank->import->out, flank->import->out->assumed,
                "amounts of a topographical modification stand diameter by diameter, and are designed, not measured");
  return "";
}

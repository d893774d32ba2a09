/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands beside the teeth: material, bores, shafts, bearings. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/rexs_import.h"

/* A shaft with its place along x. */
struct shaft {
  const struct eo_rexs_component *component;
  double forward, origin; /* of its u axis along x */
};

static struct shaft shaft_of(const struct eo_rexs_import *import, int member)
{
  const struct eo_rexs_train *train = import->train;
  int index = import->wheel[member][EO_LEFT].shaft, first = train->mesh[import->pair->mesh[0]].wheel[0].shaft;
  double x[3], axis[3], origin[3], unused[3];
  struct shaft shaft = {index < 0 ? NULL : train->shaft[index], 1, 0};
  eo_rexs_axis(first < 0 ? NULL : train->shaft[first], x, unused);
  eo_rexs_axis(shaft.component, axis, origin);
  for (int i = 0; i < 3; i++)
    shaft.origin += origin[i] * x[i];
  shaft.forward = axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2] < 0 ? -1 : 1;
  return shaft;
}

/* Number `n` of the sections of a shaft, with its interval along x; NULL after the last. */
static const struct eo_rexs_component *section_at(const struct eo_rexs_import *import, const struct shaft *shaft, int n,
                                                  double *from, double *to)
{
  const struct eo_rexs_component *part;
  for (int at = 0; (part = eo_rexs_related(import->model, "assembly", "assembly", shaft->component, "part", &at));) {
    if (!eo_rexs_is(part, "shaft_section") || n-- > 0)
      continue;
    double u = eo_rexs_value(part, "u_coordinate_on_shaft"), length = eo_rexs_value(part, "length");
    double start = shaft->origin + shaft->forward * u, end = start + shaft->forward * length;
    *from = fmin(start, end);
    *to = fmax(start, end);
    return part;
  }
  return NULL;
}

static const double edge = 1e-3; /* mm: sections that only touch an interval are not in it */

/* The smallest outer (inner) diameter of the sections within an interval; NaN: none. several: they differ. */
static double diameter_in(const struct eo_rexs_import *import, const struct shaft *shaft, double left, double right,
                          bool outer, bool *several)
{
  const struct eo_rexs_component *section;
  double from, to, smallest = NAN;
  for (int n = 0; (section = section_at(import, shaft, n, &from, &to)); n++) {
    if (!(from < right - edge && to > left + edge))
      continue;
    double begin = eo_rexs_value(section, outer ? "outer_diameter_begin" : "inner_diameter_begin"),
           end = eo_rexs_value(section, outer ? "outer_diameter_end" : "inner_diameter_end");
    double least = fmin(begin, end);
    *several = *several || begin != end || (!isnan(smallest) && smallest != least);
    smallest = isnan(smallest) ? least : fmin(smallest, least);
  }
  return smallest;
}

static void read_bore(struct eo_rexs_import *import, json_t *gear_pair, int member)
{
  static const char *const key[2] = {"pinion_bore_mm", "gear_bore_mm"};
  const struct eo_rexs_wheel *wheel = &import->wheel[member][EO_LEFT];
  const struct shaft shaft = shaft_of(import, member);
  bool several = false;
  double bore = eo_rexs_value(wheel->gear, "inner_diameter");
  if (isnan(bore))
    bore = diameter_in(import, &shaft, wheel->left, wheel->right, false, &several);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, key[member], bore);
}

static void read_groove(struct eo_rexs_import *import, json_t *gear_pair, int member)
{
  static const char *const key[2] = {"pinion_groove_diameter_mm", "gear_groove_diameter_mm"};
  const struct eo_rexs_wheel *left = &import->wheel[member][EO_LEFT], *right = &import->wheel[member][EO_RIGHT];
  const struct shaft shaft = shaft_of(import, member);
  bool several = false;
  if (import->pair->ends != 2)
    return;
  double diameter = diameter_in(import, &shaft, left->right, right->left, true, &several);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, key[member], diameter);
  if (several)
    eo_import_say(import->out, import->out->notes,
                  "The groove of shaft %d has several diameters; the smallest, %.6g mm, was taken.",
                  shaft.component->id, diameter);
}

static void read_shaft_diameter(struct eo_rexs_import *import, json_t *shafts, int member)
{
  static const char *const key[2] = {"pinion_shaft_diameter_mm", "gear_shaft_diameter_mm"};
  const struct shaft shaft = shaft_of(import, member);
  int last = import->pair->ends - 1;
  bool several = false;
  double left = import->wheel[member][EO_LEFT].left, right = import->wheel[member][last].right;
  double diameter[2] = {diameter_in(import, &shaft, left - 3 * edge, left + 2 * edge, true, &several),
                        diameter_in(import, &shaft, right - 2 * edge, right + 3 * edge, true, &several)};
  double taken = isnan(diameter[0]) ? diameter[1] : diameter[0];
  eo_rexs_put(import, &eo_shafts_table, shafts, key[member], taken);
  if (!isnan(diameter[0]) && !isnan(diameter[1]) && diameter[0] != diameter[1])
    eo_import_say(import->out, import->out->notes,
                  "Shaft %d has %.6g mm next to the left face and %.6g mm next to the right one; the left was taken.",
                  shaft.component->id, diameter[0], diameter[1]);
}

static bool is_bearing(const struct eo_rexs_component *component)
{
  static const char *const types[] = {"concept_bearing", "rolling_bearing_with_catalog_geometry",
                                      "rolling_bearing_with_detailed_geometry"};
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (eo_rexs_is(component, types[i]))
      return true;
  return false;
}

/* Of the bearings of a shaft the next one on either side of the middle. */
static void read_bearings(struct eo_rexs_import *import, json_t *shafts, int member)
{
  static const char *const key[2][2] = {{"pinion_left_bearing_mm", "pinion_right_bearing_mm"},
                                        {"gear_left_bearing_mm", "gear_right_bearing_mm"}};
  const struct shaft shaft = shaft_of(import, member);
  const struct eo_rexs_component *bearing;
  double place[2] = {NAN, NAN};
  for (int at = 0;
       (bearing = eo_rexs_related(import->model, "side", "inner_part", shaft.component, "assembly", &at));) {
    if (!is_bearing(bearing))
      continue;
    double beside = shaft.origin + shaft.forward * eo_rexs_value(bearing, "u_coordinate_on_shaft_inner_side") -
                    import->middle;
    int side = beside > 0;
    if (!isnan(beside) && !(fabs(place[side]) < fabs(beside)))
      place[side] = beside;
  }
  for (int side = 0; side < 2; side++)
    eo_rexs_put(import, &eo_shafts_table, shafts, key[member][side], place[side]);
}

/* Left or right of the teeth: where the source or the coupling stands that moves the shaft. A load that is moved says
   so in a note alone: REXS may have it anywhere on the shaft. */
static void read_drive_side(struct eo_rexs_import *import, json_t *shafts, int member)
{
  static const char *const key[2] = {"pinion_drive_side", "gear_drive_side"};
  const struct shaft shaft = shaft_of(import, member);
  const struct eo_rexs_component *part;
  double place = NAN;
  for (int at = 0;
       isnan(place) && (part = eo_rexs_related(import->model, "side", "inner_part", shaft.component, "assembly", &at));)
    if (eo_rexs_is(part, "coupling") || eo_rexs_is(part, "switchable_coupling"))
      place = shaft.origin + shaft.forward * eo_rexs_value(part, "u_coordinate_on_shaft_inner_side");
  for (int at = 0;
       isnan(place) && (part = eo_rexs_related(import->model, "assembly", "assembly", shaft.component, "part", &at));) {
    if (!eo_rexs_is(part, "external_load"))
      continue;
    double load = shaft.origin + shaft.forward * eo_rexs_value(part, "u_coordinate_on_shaft");
    if (eo_rexs_flag(part, "defines_torque") && member == EO_PINION)
      place = load;
    else if (load > import->middle)
      eo_import_say(import->out, import->out->notes,
                    "external_load %d stands to the right of the teeth; shafts.%s is left as it is.", part->id,
                    key[member]);
  }
  if (!isnan(place))
    eo_rexs_put_word(import, &eo_shafts_table, shafts, key[member], place > import->middle ? "right" : "left");
}

/* Whether the pinion of a double helical pair can move: no bearing of its shaft takes axial force. */
static void read_axial(struct eo_rexs_import *import, json_t *design)
{
  const struct shaft shaft = shaft_of(import, EO_PINION);
  const struct eo_rexs_component *bearing;
  int bearings = 0, locating = 0;
  if (import->pair->ends != 2)
    return;
  for (int at = 0;
       (bearing = eo_rexs_related(import->model, "side", "inner_part", shaft.component, "assembly", &at));) {
    const struct eo_rexs_attribute *axial = eo_rexs_attribute(bearing, "axial_force_absorption");
    if (!is_bearing(bearing) || !axial)
      continue;
    bearings++;
    locating += strcmp(axial->text, "no_direction") != 0;
  }
  if (bearings)
    eo_rexs_put_word(import, &eo_alignment_table, eo_rexs_part(import, design, "alignment"), "pinion_axial",
                     locating ? "fixed" : "floating");
}

static const struct eo_rexs_component *material_of(const struct eo_rexs_import *import, int member)
{
  const struct eo_rexs_component *from[2] = {import->wheel[member][EO_LEFT].gear, shaft_of(import, member).component};
  const struct eo_rexs_component *found;
  for (int i = 0; i < 2; i++)
    for (int at = 0; (found = eo_rexs_related(import->model, "reference", "origin", from[i], "referenced", &at));)
      if (eo_rexs_is(found, "material"))
        return found;
  return NULL;
}

static void read_material(struct eo_rexs_import *import, json_t *design)
{
  static const struct {
    const char *key, *own, *attribute;
    double factor;
    bool divide;
  } rows[] = {
      {"youngs_modulus_GPa", "gear_youngs_modulus_GPa", "elastic_modulus", 1000, true},
      {"poissons_ratio", "gear_poissons_ratio", "poisson_ratio", 1, false},
      {"density_kg_per_m3", "gear_density_kg_per_m3", "density", 1000, false},
  };
  const double same = 1e-9; /* relative */
  const struct eo_rexs_component *of[2] = {material_of(import, EO_PINION), material_of(import, EO_GEAR)};
  const struct eo_rexs_component *taken = of[0] ? of[0] : of[1];
  if (!taken) {
    eo_import_say(import->out, import->out->assumed, "material: the file states none for the pair");
    return;
  }
  json_t *material = eo_rexs_part(import, design, "material");
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double value = eo_rexs_value(taken, rows[i].attribute), other = eo_rexs_value(of[1], rows[i].attribute);
    double factor = rows[i].divide ? 1 / rows[i].factor : rows[i].factor;
    eo_rexs_put(import, &eo_material_table, material, rows[i].key, value * factor);
    if (fabs(other - value) > same * fabs(value))
      eo_rexs_put(import, &eo_material_table, material, rows[i].own, other * factor);
  }
}

static void read_rim(struct eo_rexs_import *import, json_t *gear_pair)
{
  double taken = NAN;
  for (int member = 0; member < 2; member++) {
    const struct eo_rexs_component *body;
    const struct eo_rexs_component *gear = import->wheel[member][EO_LEFT].gear;
    for (int at = 0; (body = eo_rexs_related(import->model, "reference", "origin", gear, "referenced", &at));) {
      double rim = eo_rexs_value(body, "gear_body_rim_thickness");
      if (eo_rexs_is(body, "gear_body") && !isnan(rim))
        taken = isnan(taken) ? rim : fmin(taken, rim);
    }
  }
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "rim_thickness_coefficient",
              taken / import->wheel[EO_PINION][EO_LEFT].module);
}

void eo_rexs_read_bodies(struct eo_rexs_import *import, json_t *design)
{
  json_t *gear_pair = eo_rexs_part(import, design, "gear_pair");
  json_t *shafts = eo_rexs_part(import, design, "shafts");
  for (int member = 0; member < 2; member++) {
    read_bore(import, gear_pair, member);
    read_groove(import, gear_pair, member);
    read_bearings(import, shafts, member);
    read_shaft_diameter(import, shafts, member);
    read_drive_side(import, shafts, member);
  }
  read_rim(import, gear_pair);
  read_material(import, design);
  read_axial(import, design);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_export.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "document/design_document.h"
#include "exchange/rexs_schema.h"
#include "format/json.h"

#include <config.h>

/* Ids: those of one kind stand together, as in the files of other programs. */
enum {
  UNIT = 1,
  CASING = 2,
  SHAFT = 3,  /* + member */
  GEAR = 11,  /* + 2 member + end */
  STAGE = 21, /* + end */
  DATA = 31,  /* + 2 end + member */
  FLANK = 41, /* + 4 member + 2 end + side */
  TOOL = 51,  /* + member */
  SETTINGS = 53,
  MATERIAL = 54,
  SECTION = 61, /* + 3 member + place */
  BEARING = 71, /* + 2 member + side */
  LOAD = 81,    /* + member */
  MODIFICATION = 101,
};

struct writer {
  struct eo_rexs_builder builder;
  const struct eo_design *design;
  const struct eo_geometry *geometry;
  json_t *document;
  const json_t *gear_pair, *shafts;
  int ends;
  double mirror;   /* +1: the driver turns negatively; -1: the mirror image of all */
  double overhang; /* from the outer face to the end of the shaft, mm */
};

static const char *const member_name[2] = {"pinion", "gear"}, *const end_name[2] = {"left", "right"};

/* A number of an object by the key "MEMBER_KEY", else "KEY"; NaN: absent or null. */
static double number_of(const json_t *object, int member, const char *key)
{
  char own[80];
  snprintf(own, sizeof own, "%s_%s", member_name[member], key);
  const json_t *value = json_object_get(object, own);
  if (!json_is_number(value))
    value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static double pair_number(const struct writer *w, const char *key)
{
  const json_t *value = json_object_get(w->gear_pair, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static double face_width(const struct writer *w, int end)
{
  return 1e3 * eo_gear_pair_face_width(&w->design->gear_pair, end);
}

static double groove_width(const struct writer *w)
{
  double width = pair_number(w, "groove_width_mm");
  return w->ends == 2 && !isnan(width) ? width : 0;
}

static double own_width(const struct writer *w, int member, int end)
{
  return 1e3 * eo_geometry_of_half(w->geometry, &w->design->gear_pair, end).member_width[member];
}

/* Where the left face that both members share stands on the shafts; the whole length of a shaft. */
static double face_at(const struct writer *w, int end)
{
  return w->overhang + (end == EO_RIGHT ? face_width(w, EO_LEFT) + groove_width(w) : 0);
}

/* Where a member's own left face stands. */
static double own_face_at(const struct writer *w, int member, int end)
{
  return face_at(w, end) - (own_width(w, member, end) - face_width(w, end)) / 2;
}

static double all_faces(const struct writer *w)
{
  return w->ends == 2 ? face_width(w, EO_LEFT) + face_width(w, EO_RIGHT) : face_width(w, EO_LEFT);
}

/* From the left face to the middle of the groove, or of the only face. */
static double to_middle(const struct writer *w)
{
  return w->ends == 2 ? face_width(w, EO_LEFT) + groove_width(w) / 2 : face_width(w, EO_LEFT) / 2;
}

static double shaft_length(const struct writer *w)
{
  return 2 * w->overhang + all_faces(w) + groove_width(w);
}

static void put_place(struct writer *w, double u, double distance)
{
  const double support[3] = {u, 0, distance}, along[3] = {1, 0, 0}, up[3] = {0, 0, 1};
  eo_rexs_build_whole(&w->builder, "reference_component_for_position", UNIT);
  eo_rexs_build_numbers(&w->builder, "support_vector", 3, support);
  eo_rexs_build_numbers(&w->builder, "u_axis_vector", 3, along);
  eo_rexs_build_numbers(&w->builder, "w_axis_vector", 3, up);
}

static double distance_of(const struct writer *w, int member)
{
  return member == EO_GEAR ? pair_number(w, "centre_distance_mm") : 0;
}

static void write_unit(struct writer *w, bool with_design)
{
  struct eo_text text = {0};
  eo_rexs_build(&w->builder, UNIT, "gear_unit", w->design->name);
  eo_rexs_build_whole(&w->builder, "number_of_gears", 1);
  eo_rexs_build_whole(&w->builder, "gear_shift_index", 1);
  put_place(w, 0, 0);
  if (with_design) {
    eo_json_write(&text, w->document, EO_JSON_CANONICAL);
    eo_rexs_build_word(&w->builder, "custom_easeoff_design", text.data ? text.data : "");
    w->builder.model->failed = w->builder.model->failed || text.failed;
    eo_text_done(&text);
  }
  eo_rexs_build(&w->builder, CASING, "gear_casing", "casing");
  eo_rexs_relate(&w->builder, "assembly", 0, "assembly", UNIT, "part", CASING, (char *)NULL);
}

static void write_section(struct writer *w, int member, int place, double u, double length, double outer, double inner)
{
  int id = SECTION + 3 * member + place;
  if (!(length > 0) || !(outer > 0))
    return;
  eo_rexs_build(&w->builder, id, "shaft_section", "");
  eo_rexs_build_number(&w->builder, "u_coordinate_on_shaft", u);
  eo_rexs_build_number(&w->builder, "length", length);
  eo_rexs_build_number(&w->builder, "outer_diameter_begin", outer);
  eo_rexs_build_number(&w->builder, "outer_diameter_end", outer);
  eo_rexs_build_number(&w->builder, "inner_diameter_begin", inner);
  eo_rexs_build_number(&w->builder, "inner_diameter_end", inner);
  eo_rexs_relate(&w->builder, "assembly", 0, "assembly", SHAFT + member, "part", id, (char *)NULL);
}

static void write_bearings(struct writer *w, int member)
{
  bool fixed = member == EO_GEAR || w->design->alignment.pinion_axial == EO_AXIAL_FIXED || w->ends == 1;
  for (int side = 0; side < 2; side++) {
    char key[60];
    snprintf(key, sizeof key, "%s_%s_bearing_mm", member_name[member], end_name[side]);
    const json_t *value = json_object_get(w->shafts, key);
    int id = BEARING + 2 * member + side;
    if (!json_is_number(value))
      continue;
    eo_rexs_build(&w->builder, id, "concept_bearing", "");
    eo_rexs_build_number(&w->builder, "u_coordinate_on_shaft_inner_side",
                         w->overhang + to_middle(w) + json_number_value(value));
    eo_rexs_build_flag(&w->builder, "radial_force_absorption", true);
    eo_rexs_build_word(&w->builder, "axial_force_absorption", fixed && !side ? "both_directions" : "no_direction");
    eo_rexs_relate(&w->builder, "side", 0, "assembly", id, "inner_part", SHAFT + member, "outer_part", CASING,
                   (char *)NULL);
  }
}

static void write_load(struct writer *w, int member)
{
  char key[60];
  snprintf(key, sizeof key, "%s_drive_side", member_name[member]);
  const char *side = json_string_value(json_object_get(w->shafts, key));
  eo_rexs_build(&w->builder, LOAD + member, "external_load", member == EO_PINION ? "driver" : "driven");
  eo_rexs_build_number(&w->builder, "u_coordinate_on_shaft", side && !strcmp(side, "right") ? shaft_length(w) : 0);
  eo_rexs_build_flag(&w->builder, "transmits_torque", true);
  eo_rexs_build_flag(&w->builder, "defines_torque", member == EO_PINION);
  eo_rexs_relate(&w->builder, "assembly", 0, "assembly", SHAFT + member, "part", LOAD + member, (char *)NULL);
}

static void write_shaft(struct writer *w, int member)
{
  double bore = number_of(w->gear_pair, member, "bore_mm"), outer = number_of(w->shafts, member, "shaft_diameter_mm");
  int last = w->ends - 1;
  double left = own_face_at(w, member, 0), inner = left + own_width(w, member, 0), from = own_face_at(w, member, last),
         right = from + own_width(w, member, last);
  eo_rexs_build(&w->builder, SHAFT + member, "shaft", member == EO_PINION ? "pinion shaft" : "gear shaft");
  if (member == EO_PINION)
    eo_rexs_build_flag(&w->builder, "defines_speed", true);
  put_place(w, 0, distance_of(w, member));
  eo_rexs_relate(&w->builder, "assembly", 0, "assembly", UNIT, "part", SHAFT + member, (char *)NULL);
  write_section(w, member, 0, 0, left, outer, bore);
  write_section(w, member, 1, inner, w->ends == 2 ? from - inner : 0,
                number_of(w->gear_pair, member, "groove_diameter_mm"), bore);
  write_section(w, member, 2, right, shaft_length(w) - right, outer, bore);
  write_bearings(w, member);
  write_load(w, member);
}

/* + right-handed: the pinion's left end, of one end the other hand; mates are opposite. */
static double helix_of(const struct writer *w, int member, int end)
{
  double hand = w->ends == 1 || end == EO_RIGHT ? -1 : 1;
  return w->mirror * (member == EO_GEAR ? -hand : hand) * pair_number(w, "helix_angle_deg");
}

static void write_flank(struct writer *w, int member, int end, int side, int *modification)
{
  int gear = GEAR + 2 * member + end, id = FLANK + 4 * member + 2 * end + side, tool = TOOL + member;
  const json_t *block = json_object_get(
      json_object_get(json_object_get(w->document, "modification"), member_name[member]), end_name[end]);
  bool loaded = side == (w->mirror < 0);
  double leading = helix_of(w, EO_PINION, end) * -w->mirror < 0 ? -1 : 1;
  struct eo_rexs_flank_export flank = {w->design, w->geometry, member, end, !loaded, leading};
  eo_rexs_build(&w->builder, id, "cylindrical_gear_flank", "");
  eo_rexs_build_number(&w->builder, "normal_pressure_angle", pair_number(w, "normal_pressure_angle_deg"));
  eo_rexs_build_number(&w->builder, "addendum_modification_coefficient",
                       number_of(w->gear_pair, member, "profile_shift"));
  eo_rexs_build_number(&w->builder, "addendum_coefficient_basic_profile",
                       number_of(w->gear_pair, member, "addendum_coefficient"));
  eo_rexs_build_number(&w->builder, "custom_easeoff_lead_offset",
                       loaded && json_number_value(json_object_get(block, "lead_offset_um")) != 0
                           ? json_number_value(json_object_get(block, "lead_offset_um")) * 1e-3
                           : NAN);
  eo_rexs_relate(&w->builder, "manufacturing_step", 1, "workpiece", id, "tool", tool, "manufacturing_settings",
                 SETTINGS, (char *)NULL);
  if (side == 1)
    eo_rexs_relate(&w->builder, "flank", 0, "gear", gear, "left", id - 1, "right", id, (char *)NULL);
  *modification = eo_rexs_export_flank(&w->builder, &flank, loaded ? block : json_object_get(block, "coast"), id,
                                       *modification);
}

static void write_gear(struct writer *w, int member, int end, int *modification)
{
  int id = GEAR + 2 * member + end;
  char name[40];
  snprintf(name, sizeof name, w->ends == 2 ? "%s %s" : "%s", member_name[member], end_name[end]);
  eo_rexs_build(&w->builder, id, "cylindrical_gear", name);
  eo_rexs_build_whole(&w->builder, "number_of_teeth", w->geometry->teeth[member]);
  eo_rexs_build_number(&w->builder, "normal_module", pair_number(w, "normal_module_mm"));
  eo_rexs_build_number(&w->builder, "helix_angle_reference_diameter", helix_of(w, member, end));
  eo_rexs_build_number(&w->builder, "face_width", own_width(w, member, end));
  eo_rexs_build_number(&w->builder, "u_coordinate_on_shaft", own_face_at(w, member, end));
  eo_rexs_build_number(&w->builder, "tip_diameter", number_of(w->gear_pair, member, "tip_diameter_mm"));
  eo_rexs_build_number(&w->builder, "root_diameter", 2e3 * w->geometry->root_radius[member]);
  eo_rexs_build_number(&w->builder, "inner_diameter", number_of(w->gear_pair, member, "bore_mm"));
  eo_rexs_build_word(&w->builder, "datum_face_orientation", "negative");
  put_place(w, own_face_at(w, member, end), distance_of(w, member));
  eo_rexs_relate(&w->builder, "assembly", 0, "assembly", SHAFT + member, "part", id, (char *)NULL);
  eo_rexs_relate(&w->builder, "reference", 0, "origin", id, "referenced", MATERIAL, (char *)NULL);
  for (int side = 0; side < 2; side++)
    write_flank(w, member, end, side, modification);
}

static void write_stage(struct writer *w, int end)
{
  int id = STAGE + end;
  double backlash = 1e3 * w->geometry->normal_backlash;
  eo_rexs_build(&w->builder, id, "cylindrical_stage", w->ends == 2 ? end ? "mesh right" : "mesh left" : "mesh");
  eo_rexs_build_number(&w->builder, "center_distance", pair_number(w, "centre_distance_mm"));
  eo_rexs_build_number(&w->builder, "common_face_width", face_width(w, end));
  eo_rexs_build_number(&w->builder, "minimum_normal_backlash", backlash);
  eo_rexs_build_number(&w->builder, "maximum_normal_backlash", backlash);
  eo_rexs_relate(&w->builder, "assembly", 0, "assembly", UNIT, "part", id, (char *)NULL);
  eo_rexs_relate(&w->builder, "stage", 0, "stage", id, "gear_1", GEAR + end, "gear_2", GEAR + 2 + end, (char *)NULL);
  for (int member = 0; member < 2; member++) {
    int data = DATA + 2 * end + member;
    eo_rexs_build(&w->builder, data, "cylindrical_stage_gear_data", "");
    eo_rexs_build_flag(&w->builder, "is_driving_gear", member == EO_PINION);
    eo_rexs_build_word(&w->builder, "loaded_tooth_flank", w->mirror < 0 ? "right" : "left");
    eo_rexs_relate(&w->builder, "stage_gear_data", 0, "stage", id, "gear", GEAR + 2 * member + end, "stage_gear_data",
                   data, (char *)NULL);
  }
}

static void write_tools(struct writer *w)
{
  for (int member = 0; member < 2; member++) {
    eo_rexs_build(&w->builder, TOOL + member, "rack_shaped_tool", member == EO_PINION ? "pinion rack" : "gear rack");
    eo_rexs_build_number(&w->builder, "addendum_coefficient_reference_profile",
                         number_of(w->gear_pair, member, "dedendum_coefficient"));
    eo_rexs_build_number(&w->builder, "tip_corner_radius_factor_reference_profile",
                         number_of(w->gear_pair, member, "fillet_radius_coefficient"));
  }
  eo_rexs_build(&w->builder, SETTINGS, "cylindrical_gear_manufacturing_settings", "");
  eo_rexs_build_number(&w->builder, "machining_allowance", 0);
  const json_t *object = json_object_get(w->document, "material");
  eo_rexs_build(&w->builder, MATERIAL, "material", "material");
  eo_rexs_build_number(&w->builder, "elastic_modulus",
                       1000 * json_number_value(json_object_get(object, "youngs_modulus_GPa")));
  eo_rexs_build_number(&w->builder, "poisson_ratio", json_number_value(json_object_get(object, "poissons_ratio")));
  eo_rexs_build_number(&w->builder, "density", json_number_value(json_object_get(object, "density_kg_per_m3")) / 1000);
}

static void write_load_cases(struct writer *w)
{
  const json_t *list = json_object_get(w->document, "load_cases"), *row;
  size_t i;
  json_array_foreach(list, i, row)
  {
    const char *direction = json_string_value(json_object_get(row, "direction"));
    double sign = -w->mirror * (direction && strcmp(direction, "astern") == 0 ? -1 : 1);
    eo_rexs_build_load_case(&w->builder, (int)i + 1);
    eo_rexs_vary_one(&w->builder, UNIT, "gear_unit");
    eo_rexs_build_number(&w->builder, "operating_time_fraction",
                         100 * json_number_value(json_object_get(row, "share")));
    eo_rexs_vary_one(&w->builder, SHAFT, "shaft");
    eo_rexs_build_number(&w->builder, "rotational_speed", sign * json_number_value(json_object_get(row, "speed_rpm")));
    eo_rexs_vary_one(&w->builder, LOAD, "external_load");
    eo_rexs_build_number(&w->builder, "torque_around_u_axis",
                         sign * json_number_value(json_object_get(row, "torque_Nm")));
  }
}

static const char *version_name(struct eo_rexs_model *model, int version)
{
  return version >= 200 ? "2.0.0" : eo_rexs_print(model, "1.%d", version - 100);
}

static void write_head(struct writer *w)
{
  struct eo_rexs_model *model = w->builder.model;
  char date[40];
  time_t now = time(NULL);
  struct tm utc;
  strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S+00:00", gmtime_r(&now, &utc));
  model->version = version_name(model, w->builder.version);
  model->application = "Easeoff";
  model->application_version = PACKAGE_VERSION;
  model->date = eo_rexs_text(model, date, strlen(date));
}

/* Long enough for the bearings and one face width beside the teeth. */
static double overhang(const struct writer *w)
{
  double left = to_middle(w), right = all_faces(w) + groove_width(w) - left,
         reach = fmax(left, right) + face_width(w, EO_LEFT);
  for (int i = 0; i < 4; i++) {
    char key[60];
    snprintf(key, sizeof key, "%s_%s_bearing_mm", member_name[i / 2], end_name[i % 2]);
    reach = fmax(reach, fabs(json_number_value(json_object_get(w->shafts, key))));
  }
  return reach - fmin(left, right);
}

void eo_rexs_export(const struct eo_design *design, const struct eo_geometry *geometry, int version, bool with_design,
                    struct eo_rexs_model *model)
{
  int modification = MODIFICATION;
  struct writer w = {.builder = {model, version}, .design = design, .geometry = geometry};
  w.document = eo_design_encode(design);
  if (!w.document) {
    model->failed = true;
    return;
  }
  w.gear_pair = json_object_get(w.document, "gear_pair");
  w.shafts = json_object_get(w.document, "shafts");
  w.ends = design->gear_pair.ends;
  const char *hand = json_string_value(json_object_get(w.gear_pair, "hand"));
  bool right_handed = w.ends == 2; /* the left end of a design's own frame */
  w.mirror = hand && (strcmp(hand, "right") == 0) != right_handed ? -1 : 1;
  w.overhang = overhang(&w);
  write_head(&w);
  write_unit(&w, with_design);
  for (int member = 0; member < 2; member++)
    write_shaft(&w, member);
  write_tools(&w);
  for (int end = 0; end < w.ends; end++) {
    for (int member = 0; member < 2; member++)
      write_gear(&w, member, end, &modification);
    write_stage(&w, end);
  }
  write_load_cases(&w);
  eo_rexs_index(model);
  json_decref(w.document);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_export.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "document/design_document.h"
#include "exchange/rexs_schema.h"
#include "format/json.h"
#include "gear/names.h"

#include <config.h>

/* Ids: those of one kind stand together, as in the files of other programs. */
enum {
  UNIT = 1,
  CASING = 2,
  SHAFT = 3,     /* + member */
  GEAR = 11,     /* + 2 member + end */
  STAGE = 21,    /* + end */
  DATA = 31,     /* + 2 end + member */
  FLANK = 41,    /* + 4 member + 2 end + side */
  TOOL = 51,     /* + member; of a right end with a helix of its own + 6 + member */
  SETTINGS = 53, /* + member */
  MATERIAL = 55, /* + member */
  SECTION = 61,  /* + 3 member + place */
  BEARING = 71,  /* + 2 member + side */
  LOAD = 81,     /* + member */
  MODIFICATION = 101,
};

struct writer {
  struct eo_rexs_builder builder;
  const struct eo_design *design;
  const struct eo_geometry *geometry;
  json_t *document;
  const json_t *gear_pair, *shafts;
  json_t *right; /* what gear_pair is for the right half, where its helix is another; NULL: the same */
  int ends;
  double mirror;   /* +1: the pinion turns negatively, its left flanks carry ahead; -1: the mirror image */
  double overhang; /* from the outer face to the end of the shaft, mm */
};

/* A number of an object by the key "MEMBER_KEY", else "KEY"; NaN: absent or null. */
static double number_of(const json_t *object, int member, const char *key)
{
  char own[80];
  snprintf(own, sizeof own, "%s_%s", eo_member_name[member], key);
  const json_t *value = json_object_get(object, own);
  if (!json_is_number(value))
    value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static double pair_number(const struct writer *writer, const char *key)
{
  const json_t *value = json_object_get(writer->gear_pair, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

/* gear_pair as it is for an end. */
static const json_t *pair_of(const struct writer *writer, int end)
{
  return end == EO_RIGHT && writer->right ? writer->right : writer->gear_pair;
}

/* What a member need not have: NaN where it is 0. */
static double stated(const struct writer *writer, int member, const char *key)
{
  double value = number_of(writer->gear_pair, member, key);
  return value > 0 ? value : NAN;
}

static double face_width(const struct writer *writer, int end)
{
  return 1e3 * eo_gear_pair_face_width(&writer->design->gear_pair, end);
}

static double groove_width(const struct writer *writer)
{
  double width = pair_number(writer, "groove_width_mm");
  return writer->ends == 2 && !isnan(width) ? width : 0;
}

static double own_width(const struct writer *writer, int member, int end)
{
  return 1e3 * eo_geometry_of_half(writer->geometry, &writer->design->gear_pair, end).member_width[member];
}

/* Where the left face that both members share stands on the shafts; the whole length of a shaft. */
static double face_at(const struct writer *writer, int end)
{
  return writer->overhang + (end == EO_RIGHT ? face_width(writer, EO_LEFT) + groove_width(writer) : 0);
}

/* Where a member's own left face stands. */
static double own_face_at(const struct writer *writer, int member, int end)
{
  return face_at(writer, end) - (own_width(writer, member, end) - face_width(writer, end)) / 2;
}

static double all_faces(const struct writer *writer)
{
  return writer->ends == 2 ? face_width(writer, EO_LEFT) + face_width(writer, EO_RIGHT) : face_width(writer, EO_LEFT);
}

/* From the left face to the middle of the groove, or of the only face. */
static double to_middle(const struct writer *writer)
{
  return writer->ends == 2 ? face_width(writer, EO_LEFT) + groove_width(writer) / 2 : face_width(writer, EO_LEFT) / 2;
}

static double shaft_length(const struct writer *writer)
{
  return 2 * writer->overhang + all_faces(writer) + groove_width(writer);
}

static void put_place(struct writer *writer, double u, double distance)
{
  const double support[3] = {u, 0, distance}, along[3] = {1, 0, 0}, up[3] = {0, 0, 1};
  eo_rexs_build_whole(&writer->builder, "reference_component_for_position", UNIT);
  eo_rexs_build_numbers(&writer->builder, "support_vector", 3, support);
  eo_rexs_build_numbers(&writer->builder, "u_axis_vector", 3, along);
  eo_rexs_build_numbers(&writer->builder, "w_axis_vector", 3, up);
}

static double distance_of(const struct writer *writer, int member)
{
  return member == EO_GEAR ? pair_number(writer, "centre_distance_mm") : 0;
}

static void write_unit(struct writer *writer, bool with_design)
{
  struct eo_text text = {0};
  eo_rexs_build(&writer->builder, UNIT, "gear_unit", writer->design->name);
  eo_rexs_build_whole(&writer->builder, "number_of_gears", 1);
  eo_rexs_build_whole(&writer->builder, "gear_shift_index", 1);
  put_place(writer, 0, 0);
  if (with_design) {
    eo_json_write(&text, writer->document, EO_JSON_CANONICAL);
    eo_rexs_build_word(&writer->builder, "custom_easeoff_design", text.data ? text.data : "");
    writer->builder.model->failed = writer->builder.model->failed || text.failed;
    eo_text_done(&text);
  }
  eo_rexs_build(&writer->builder, CASING, "gear_casing", "casing");
  eo_rexs_relate(&writer->builder, "assembly", 0, "assembly", UNIT, "part", CASING, (char *)NULL);
}

static void write_section(struct writer *writer, int member, int place, double u, double length, double outer,
                          double inner)
{
  int id = SECTION + 3 * member + place;
  if (!(length > 0) || !(outer > 0))
    return;
  eo_rexs_build(&writer->builder, id, "shaft_section", "");
  eo_rexs_build_number(&writer->builder, "u_coordinate_on_shaft", u);
  eo_rexs_build_number(&writer->builder, "length", length);
  eo_rexs_build_number(&writer->builder, "outer_diameter_begin", outer);
  eo_rexs_build_number(&writer->builder, "outer_diameter_end", outer);
  eo_rexs_build_number(&writer->builder, "inner_diameter_begin", inner);
  eo_rexs_build_number(&writer->builder, "inner_diameter_end", inner);
  eo_rexs_relate(&writer->builder, "assembly", 0, "assembly", SHAFT + member, "part", id, (char *)NULL);
}

static void write_bearings(struct writer *writer, int member)
{
  bool fixed = member == EO_GEAR || writer->design->alignment.pinion_axial == EO_AXIAL_FIXED || writer->ends == 1;
  for (int side = 0; side < 2; side++) {
    char key[60];
    snprintf(key, sizeof key, "%s_%s_bearing_mm", eo_member_name[member], eo_end_name[side]);
    const json_t *value = json_object_get(writer->shafts, key);
    int id = BEARING + 2 * member + side;
    if (!json_is_number(value))
      continue;
    eo_rexs_build(&writer->builder, id, "concept_bearing", "");
    eo_rexs_build_number(&writer->builder, "u_coordinate_on_shaft_inner_side",
                         writer->overhang + to_middle(writer) + json_number_value(value));
    eo_rexs_build_flag(&writer->builder, "radial_force_absorption", true);
    eo_rexs_build_word(&writer->builder, "axial_force_absorption", fixed && !side ? "both_directions" : "no_direction");
    eo_rexs_relate(&writer->builder, "side", 0, "assembly", id, "inner_part", SHAFT + member, "outer_part", CASING,
                   (char *)NULL);
  }
}

static void write_load(struct writer *writer, int member)
{
  char key[60];
  snprintf(key, sizeof key, "%s_drive_side", eo_member_name[member]);
  const char *side = json_string_value(json_object_get(writer->shafts, key));
  eo_rexs_build(&writer->builder, LOAD + member, "external_load", member == EO_PINION ? "driver" : "driven");
  eo_rexs_build_number(&writer->builder, "u_coordinate_on_shaft",
                       side && !strcmp(side, "right") ? shaft_length(writer) : 0);
  eo_rexs_build_flag(&writer->builder, "transmits_torque", true);
  eo_rexs_build_flag(&writer->builder, "defines_torque", member == EO_PINION);
  eo_rexs_relate(&writer->builder, "assembly", 0, "assembly", SHAFT + member, "part", LOAD + member, (char *)NULL);
}

static void write_shaft(struct writer *writer, int member)
{
  double bore = number_of(writer->gear_pair, member, "bore_mm"),
         outer = number_of(writer->shafts, member, "shaft_diameter_mm");
  int last = writer->ends - 1;
  double left = own_face_at(writer, member, 0), inner = left + own_width(writer, member, 0),
         from = own_face_at(writer, member, last), right = from + own_width(writer, member, last);
  eo_rexs_build(&writer->builder, SHAFT + member, "shaft", member == EO_PINION ? "pinion shaft" : "gear shaft");
  if (member == EO_PINION)
    eo_rexs_build_flag(&writer->builder, "defines_speed", true);
  put_place(writer, 0, distance_of(writer, member));
  eo_rexs_relate(&writer->builder, "assembly", 0, "assembly", UNIT, "part", SHAFT + member, (char *)NULL);
  write_section(writer, member, 0, 0, left, outer, bore);
  write_section(writer, member, 1, inner, writer->ends == 2 ? from - inner : 0,
                number_of(writer->gear_pair, member, "groove_diameter_mm"), bore);
  write_section(writer, member, 2, right, shaft_length(writer) - right, outer, bore);
  write_bearings(writer, member);
  write_load(writer, member);
}

/* + right-handed; both ends of a member, and mates, are opposite. */
static double helix_of(const struct writer *writer, int member, int end)
{
  double hand = eo_alignment_outwards(&writer->design->alignment) * writer->mirror;
  return ((member == EO_GEAR) != (end == EO_RIGHT) ? -hand : hand) *
         json_number_value(json_object_get(pair_of(writer, end), "helix_angle_deg"));
}

static void write_flank(struct writer *writer, int member, int end, int side, int *modification)
{
  int gear = GEAR + 2 * member + end, id = FLANK + 4 * member + 2 * end + side,
      tool = TOOL + member + (end == EO_RIGHT && writer->right ? 6 : 0);
  const json_t *pair = pair_of(writer, end);
  const json_t *block = json_object_get(
      json_object_get(json_object_get(writer->document, "modification"), eo_member_name[member]), eo_end_name[end]);
  bool loaded = side == (writer->mirror < 0);
  block = loaded ? block : json_object_get(block, "coast");
  double offset = json_number_value(json_object_get(block, "lead_offset_um"));
  double leading = (end == EO_LEFT ? -1 : 1) * eo_alignment_outwards(&writer->design->alignment);
  const struct eo_geometry half = eo_geometry_of_half(writer->geometry, &writer->design->gear_pair, end);
  struct eo_rexs_flank_export flank = {writer->design, &half, member, end, !loaded, leading};
  eo_rexs_build(&writer->builder, id, "cylindrical_gear_flank", "");
  eo_rexs_build_number(&writer->builder, "normal_pressure_angle",
                       json_number_value(json_object_get(pair, "normal_pressure_angle_deg")));
  eo_rexs_build_number(&writer->builder, "addendum_modification_coefficient", number_of(pair, member, "profile_shift"));
  eo_rexs_build_number(&writer->builder, "addendum_coefficient_basic_profile",
                       number_of(pair, member, "addendum_coefficient"));
  eo_rexs_build_number(&writer->builder, "tooth_tip_chamfer", stated(writer, member, "tip_chamfer_mm"));
  eo_rexs_build_number(&writer->builder, "custom_easeoff_lead_offset", offset != 0 ? offset * 1e-3 : NAN);
  eo_rexs_relate(&writer->builder, "manufacturing_step", 1, "workpiece", id, "tool", tool, "manufacturing_settings",
                 SETTINGS + member, (char *)NULL);
  if (side == 1)
    eo_rexs_relate(&writer->builder, "flank", 0, "gear", gear, "left", id - 1, "right", id, (char *)NULL);
  *modification = eo_rexs_export_flank(&writer->builder, &flank, block, id, *modification);
}

/* One material for both where they are alike. */
static bool has_own_material(const struct writer *writer)
{
  const json_t *material = json_object_get(writer->document, "material");
  return json_is_number(json_object_get(material, "gear_youngs_modulus_GPa")) ||
         json_is_number(json_object_get(material, "gear_poissons_ratio")) ||
         json_is_number(json_object_get(material, "gear_density_kg_per_m3"));
}

static void write_gear(struct writer *writer, int member, int end, int *modification)
{
  int id = GEAR + 2 * member + end;
  char name[40];
  snprintf(name, sizeof name, writer->ends == 2 ? "%s %s" : "%s", eo_member_name[member], eo_end_name[end]);
  eo_rexs_build(&writer->builder, id, "cylindrical_gear", name);
  eo_rexs_build_whole(&writer->builder, "number_of_teeth", writer->geometry->teeth[member]);
  eo_rexs_build_number(&writer->builder, "normal_module",
                       json_number_value(json_object_get(pair_of(writer, end), "normal_module_mm")));
  eo_rexs_build_number(&writer->builder, "helix_angle_reference_diameter", helix_of(writer, member, end));
  eo_rexs_build_number(&writer->builder, "face_width", own_width(writer, member, end));
  eo_rexs_build_number(&writer->builder, "u_coordinate_on_shaft", own_face_at(writer, member, end));
  eo_rexs_build_number(&writer->builder, "tip_diameter", number_of(writer->gear_pair, member, "tip_diameter_mm"));
  eo_rexs_build_number(&writer->builder, "root_diameter", 2e3 * writer->geometry->root_radius[member]);
  eo_rexs_build_number(&writer->builder, "inner_diameter", number_of(writer->gear_pair, member, "bore_mm"));
  eo_rexs_build_word(&writer->builder, "datum_face_orientation", "negative");
  put_place(writer, own_face_at(writer, member, end), distance_of(writer, member));
  eo_rexs_relate(&writer->builder, "assembly", 0, "assembly", SHAFT + member, "part", id, (char *)NULL);
  eo_rexs_relate(&writer->builder, "reference", 0, "origin", id, "referenced",
                 MATERIAL + (member == EO_GEAR && has_own_material(writer)), (char *)NULL);
  for (int side = 0; side < 2; side++)
    write_flank(writer, member, end, side, modification);
}

static void write_stage(struct writer *writer, int end)
{
  int id = STAGE + end;
  double backlash = 1e3 * eo_geometry_of_half(writer->geometry, &writer->design->gear_pair, end).normal_backlash;
  eo_rexs_build(&writer->builder, id, "cylindrical_stage",
                writer->ends == 2 ? end ? "mesh right" : "mesh left" : "mesh");
  eo_rexs_build_number(&writer->builder, "center_distance", pair_number(writer, "centre_distance_mm"));
  eo_rexs_build_number(&writer->builder, "common_face_width", face_width(writer, end));
  eo_rexs_build_number(&writer->builder, "minimum_normal_backlash", backlash);
  eo_rexs_build_number(&writer->builder, "maximum_normal_backlash", backlash);
  eo_rexs_relate(&writer->builder, "assembly", 0, "assembly", UNIT, "part", id, (char *)NULL);
  eo_rexs_relate(&writer->builder, "stage", 0, "stage", id, "gear_1", GEAR + end, "gear_2", GEAR + 2 + end,
                 (char *)NULL);
  for (int member = 0; member < 2; member++) {
    int data = DATA + 2 * end + member;
    eo_rexs_build(&writer->builder, data, "cylindrical_stage_gear_data", "");
    eo_rexs_build_flag(&writer->builder, "is_driving_gear", member == EO_PINION);
    eo_rexs_build_word(&writer->builder, "loaded_tooth_flank", writer->mirror < 0 ? "right" : "left");
    eo_rexs_relate(&writer->builder, "stage_gear_data", 0, "stage", id, "gear", GEAR + 2 * member + end,
                   "stage_gear_data", data, (char *)NULL);
  }
}

static void write_tool(struct writer *writer, int id, int member, int end, const char *name)
{
  const json_t *pair = pair_of(writer, end);
  eo_rexs_build(&writer->builder, id, "rack_shaped_tool", name);
  eo_rexs_build_number(&writer->builder, "addendum_coefficient_reference_profile",
                       number_of(pair, member, "dedendum_coefficient"));
  eo_rexs_build_number(&writer->builder, "tip_corner_radius_factor_reference_profile",
                       number_of(pair, member, "fillet_radius_coefficient"));
  eo_rexs_build_number(&writer->builder, "protuberance_amount", stated(writer, member, "protuberance_um") / 1000);
}

static void write_tools(struct writer *writer)
{
  static const char *const name[2][2] = {{"pinion rack", "gear rack"}, {"right pinion rack", "right gear rack"}};
  for (int member = 0; member < 2; member++) {
    write_tool(writer, TOOL + member, member, EO_LEFT, name[0][member]);
    if (writer->right)
      write_tool(writer, TOOL + 6 + member, member, EO_RIGHT, name[1][member]);
    eo_rexs_build(&writer->builder, SETTINGS + member, "cylindrical_gear_manufacturing_settings", "");
    eo_rexs_build_number(&writer->builder, "machining_allowance",
                         number_of(writer->gear_pair, member, "grinding_stock_um") / 1000);
    if (writer->geometry->generating_shift[member] != writer->geometry->profile_shift[member])
      eo_rexs_build_number(&writer->builder, "generated_addendum_modification_coefficient",
                           writer->geometry->generating_shift[member]);
  }
}

static void write_materials(struct writer *writer)
{
  const json_t *material = json_object_get(writer->document, "material");
  bool own = has_own_material(writer);
  for (int member = 0; member < (own ? 2 : 1); member++) {
    eo_rexs_build(&writer->builder, MATERIAL + member, "material",
                  !own                  ? "material"
                  : member == EO_PINION ? "pinion material"
                                        : "gear material");
    eo_rexs_build_number(&writer->builder, "elastic_modulus", 1000 * number_of(material, member, "youngs_modulus_GPa"));
    eo_rexs_build_number(&writer->builder, "poisson_ratio", number_of(material, member, "poissons_ratio"));
    eo_rexs_build_number(&writer->builder, "density", number_of(material, member, "density_kg_per_m3") / 1000);
  }
}

static void write_load_cases(struct writer *writer)
{
  const json_t *list = json_object_get(writer->document, "load_cases"), *row;
  size_t i;
  json_array_foreach(list, i, row)
  {
    const char *direction = json_string_value(json_object_get(row, "direction"));
    double sign = -writer->mirror * (direction && strcmp(direction, "astern") == 0 ? -1 : 1);
    eo_rexs_build_load_case(&writer->builder, (int)i + 1);
    eo_rexs_vary_one(&writer->builder, UNIT, "gear_unit");
    eo_rexs_build_number(&writer->builder, "operating_time_fraction",
                         100 * json_number_value(json_object_get(row, "share")));
    eo_rexs_vary_one(&writer->builder, SHAFT, "shaft");
    eo_rexs_build_number(&writer->builder, "rotational_speed",
                         sign * json_number_value(json_object_get(row, "speed_rpm")));
    eo_rexs_vary_one(&writer->builder, LOAD, "external_load");
    eo_rexs_build_number(&writer->builder, "torque_around_u_axis",
                         sign * json_number_value(json_object_get(row, "torque_Nm")));
  }
}

static const char *version_name(struct eo_rexs_model *model, int version)
{
  return version >= 200 ? "2.0.0" : eo_rexs_print(model, "1.%d", version - 100);
}

static void write_head(struct writer *writer)
{
  struct eo_rexs_model *model = writer->builder.model;
  char date[40];
  time_t now = time(NULL);
  struct tm utc;
  strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S+00:00", gmtime_r(&now, &utc));
  model->version = version_name(model, writer->builder.version);
  model->application = "Easeoff";
  model->application_version = PACKAGE_VERSION;
  model->date = eo_rexs_text(model, date, strlen(date));
}

/* Long enough for the bearings and one face width beside the teeth. */
static double overhang(const struct writer *writer)
{
  double left = to_middle(writer), right = all_faces(writer) + groove_width(writer) - left,
         reach = fmax(left, right) + face_width(writer, EO_LEFT);
  for (int i = 0; i < 4; i++) {
    char key[60];
    snprintf(key, sizeof key, "%s_%s_bearing_mm", eo_member_name[i / 2], eo_end_name[i % 2]);
    reach = fmax(reach, fabs(json_number_value(json_object_get(writer->shafts, key))));
  }
  return reach - fmin(left, right);
}

void eo_rexs_export(const struct eo_design *design, const struct eo_geometry *geometry, int version, bool with_design,
                    struct eo_rexs_model *model)
{
  int modification = MODIFICATION;
  struct writer writer = {.builder = {model, version}, .design = design, .geometry = geometry};
  writer.document = eo_design_encode(design);
  if (!writer.document) {
    model->failed = true;
    return;
  }
  writer.gear_pair = json_object_get(writer.document, "gear_pair");
  writer.shafts = json_object_get(writer.document, "shafts");
  if (eo_gear_pair_has_two_helices(&design->gear_pair)) {
    const struct eo_gear_pair half = eo_gear_pair_half(&design->gear_pair, EO_RIGHT);
    writer.right = eo_table_encode(&eo_gear_pair_table, &half);
    model->failed = model->failed || !writer.right;
  }
  writer.ends = design->gear_pair.ends;
  writer.mirror = -eo_design_rotation(design);
  writer.overhang = overhang(&writer);
  write_head(&writer);
  write_unit(&writer, with_design);
  for (int member = 0; member < 2; member++)
    write_shaft(&writer, member);
  write_tools(&writer);
  write_materials(&writer);
  for (int end = 0; end < writer.ends; end++) {
    for (int member = 0; member < 2; member++)
      write_gear(&writer, member, end, &modification);
    write_stage(&writer, end);
  }
  write_load_cases(&writer);
  eo_rexs_index(model);
  json_decref(writer.right);
  json_decref(writer.document);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/design_migration.h"

#include <stdlib.h>

#include "format/json.h"
#include "format/text.h"

/* What version 1 took where a document says nothing. */
static const struct {
  const char *group, *key;
  double value;
} first_defaults[] = {
    {"gear_pair", "normal_pressure_angle_deg", 20},
    {"gear_pair", "addendum_coefficient", 1},
    {"gear_pair", "dedendum_coefficient", 1.25},
    {"gear_pair", "fillet_radius_coefficient", 0.38},
    {"gear_pair", "pinion_profile_shift", 0},
    {"gear_pair", "gear_profile_shift", 0},
    {"gear_pair", "tip_alteration_coefficient", 0},
    {"gear_pair", "backlash_um", 100},
    {"alignment", "shaft_angle_error_in_plane_deg", 0.1},
    {"alignment", "pinion_axial_stiffness_N_per_um", 200},
    {"supports", "pinion_bearing_stiffness_N_per_um", 800},
    {"supports", "gear_bearing_stiffness_N_per_um", 1000},
    {"supports", "gear_axial_stiffness_left_N_per_um", 200},
    {"supports", "gear_axial_stiffness_right_N_per_um", 200},
    {"resolution", "cells_per_line", 30},
    {"resolution", "impact_patch_mm", 5},
    {"resolution", "te_harmonics", 16},
};

/* Keys that a document of version 1 has when the program wrote it. */
static const struct {
  const char *group, *key;
} first_keys[] = {
    {"gear_pair", "ends"},
    {"gear_pair", "dedendum_coefficient"},
    {"gear_pair", "pinion_tip_diameter_mm"},
    {"gear_pair", "gear_groove_diameter_mm"},
    {"gear_pair", "rim_thickness_coefficient"},
    {"gear_pair", "backlash_um"},
    {"alignment", "stagger"},
    {"supports", "pinion_bearing_stiffness_N_per_um"},
    {"supports", "gear_inertia_kg_m2"},
    {"shafts", "gear_drive_side"},
    {"objective", "penalty"},
    {"optimization", "bounds"},
    {"resolution", "te_harmonics"},
};

static bool is_first_written(const json_t *document)
{
  for (size_t i = 0; i < sizeof first_keys / sizeof *first_keys; i++)
    if (!json_object_get(json_object_get(document, first_keys[i].group), first_keys[i].key))
      return false;
  return true;
}

static int version_of(const json_t *document)
{
  const json_t *version = json_object_get(document, "version");
  if (json_is_integer(version))
    return (int)json_integer_value(version);
  return !version && is_first_written(document) ? 1 : EO_DESIGN_VERSION;
}

struct filling {
  json_t *document;
  struct eo_text said;
  bool failed;
};

/* The object under the key, made where it is absent; NULL where something else stands there, which decoding refuses. */
static json_t *group_of(struct filling *filling, json_t *parent, const char *key)
{
  json_t *group = json_object_get(parent, key);
  if (!group) {
    group = json_object();
    filling->failed = json_object_set_new(parent, key, group) != 0 || filling->failed;
  }
  return json_is_object(group) ? group : NULL;
}

static void fill(struct filling *filling, json_t *group, const char *key, json_t *value, const char *said)
{
  if (!group || json_object_get(group, key)) {
    json_decref(value);
    return;
  }
  filling->failed = json_object_set_new(group, key, value) != 0 || filling->failed;
  eo_text_print(&filling->said, "%s%s", filling->said.size ? ", " : "", said);
}

static void fill_numbers(struct filling *filling)
{
  for (size_t i = 0; i < sizeof first_defaults / sizeof *first_defaults; i++) {
    char said[80];
    snprintf(said, sizeof said, "%s %g", first_defaults[i].key, first_defaults[i].value);
    fill(filling, group_of(filling, filling->document, first_defaults[i].group), first_defaults[i].key,
         eo_json_whole(first_defaults[i].value), said);
  }
}

static void fill_bounds(struct filling *filling)
{
  json_t *bounds = group_of(filling, group_of(filling, filling->document, "optimization"), "bounds");
  fill(filling, bounds, "tip_relief_um", json_pack("[i,i]", 0, 40), "bounds of tip_relief_um 0 .. 40");
  fill(filling, bounds, "root_relief_um", json_pack("[i,i]", 0, 40), "of root_relief_um 0 .. 40");
  fill(filling, bounds, "lead_crowning_um", json_pack("[i,i]", 0, 36), "of lead_crowning_um 0 .. 36");
}

static void fill_load_cases(struct filling *filling)
{
  json_t *row;
  size_t i;
  fill(filling, filling->document, "load_cases",
       json_pack("[{s:i,s:i,s:f}, {s:i,s:i,s:f}, {s:i,s:i,s:f}]", "torque_Nm", 621, "speed_rpm", 2000, "share", 0.2,
                 "torque_Nm", 828, "speed_rpm", 2000, "share", 0.5, "torque_Nm", 1035, "speed_rpm", 2000, "share", 0.3),
       "load_cases of the paper");
  json_array_foreach(json_object_get(filling->document, "load_cases"), i, row)
  {
    if (json_is_object(row))
      fill(filling, row, "speed_rpm", json_integer(2000), "speed_rpm 2000");
  }
}

json_t *eo_design_migrate(const json_t *document, struct eo_warnings *warnings)
{
  if (version_of(document) != 1)
    return json_incref((json_t *)document);
  struct filling filling = {.document = json_deep_copy(document)};
  if (!filling.document)
    return NULL;
  fill_load_cases(&filling);
  fill_numbers(&filling);
  fill_bounds(&filling);
  filling.failed = json_object_set_new(filling.document, "version", json_integer(EO_DESIGN_VERSION)) != 0 ||
                   filling.failed;
  if (filling.said.size && !filling.said.failed)
    eo_warnings_add(warnings,
                    "The design document is of version 1, whose defaults stand for what it leaves out, so that its "
                    "numbers stay: %s.",
                    filling.said.data);
  eo_text_done(&filling.said);
  if (!filling.failed)
    return filling.document;
  json_decref(filling.document);
  return NULL;
}

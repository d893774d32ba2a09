/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The macro-geometry of a pair, and which way it turns. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gear/entry.h"
#include "document/design_document.h"
#include "exchange/rexs_import.h"
#include "gear/names.h"

static const double degree = M_PI / 180;
static const double same = 1e-9; /* relative: one number stated twice */

static bool alike(double a, double b)
{
  return isnan(a) || isnan(b) || fabs(a - b) <= same * fmax(1, fabs(a));
}

static bool is_modified(const struct eo_rexs_import *import, const struct eo_rexs_component *flank)
{
  int at = 0;
  return eo_rexs_related(import->model, "reference", "origin", flank, "referenced", &at) != NULL;
}

bool eo_rexs_find_rotation(struct eo_rexs_import *import)
{
  const struct eo_rexs_wheel *driver = &import->wheel[EO_PINION][EO_LEFT];
  const struct eo_rexs_attribute *loaded = eo_rexs_attribute(driver->data, "loaded_tooth_flank");
  struct eo_rexs_flow flow;
  double axis[3], x[3], origin[3], sign = NAN;
  if (import->options->flank)
    import->rotation = driver->along * (import->options->flank == 2 ? 1 : -1);
  else if (loaded)
    import->rotation = driver->along * (strcmp(loaded->text, "right") == 0 ? 1 : -1);
  if (import->rotation != 0)
    return true;
  eo_rexs_flow_find(import->train, import->model->load_cases ? 0 : -1, &flow);
  if (driver->shaft >= 0) {
    eo_rexs_axis(import->train->shaft[driver->shaft], axis, origin);
    int first = import->train->mesh[import->pair->mesh[0]].wheel[0].shaft;
    eo_rexs_axis(first < 0 ? NULL : import->train->shaft[first], x, origin);
    sign = isnan(flow.torque[driver->shaft]) ? flow.speed[driver->shaft] : flow.torque[driver->shaft];
    sign *= axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2] < 0 ? -1 : 1;
  }
  if (sign > 0 || sign < 0) {
    import->rotation = sign < 0 ? -1 : 1;
    return true;
  }
  /* without a direction the outer faces meet first, as in a design of its own */
  import->rotation = driver->helix > 0 ? -1 : 1;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < import->pair->ends; end++)
      for (int side = 0; side < 2; side++)
        if (is_modified(import, import->wheel[member][end].flank[side])) {
          eo_import_fault(import->out, "flank_not_stated",
                          "The file does not say which flanks carry the load: it states neither loaded_tooth_flank nor "
                          "torque nor speed. Say which flank of the driver is loaded (--flank left or right).");
          return false;
        }
  return true;
}

int eo_rexs_loaded_side(const struct eo_rexs_import *import, int member, int end)
{
  bool right = import->rotation * import->wheel[EO_PINION][end].along > 0;
  if (import->wheel[member][end].along != import->wheel[EO_PINION][end].along)
    right = !right;
  return right;
}

/* What the file does not place side by side stands in mid face of each other. */
static void place_in_middle(struct eo_rexs_import *import, int end)
{
  const struct eo_rexs_wheel *pinion = &import->wheel[EO_PINION][end];
  double middle = isnan(pinion->left) ? 0 : (pinion->left + pinion->right) / 2;
  eo_import_say(import->out, import->out->assumed,
                "both members stand in mid face of each other: the file does not place them");
  for (int member = 0; member < 2; member++) {
    struct eo_rexs_wheel *wheel = &import->wheel[member][end];
    wheel->left = middle - wheel->face_width / 2;
    wheel->right = middle + wheel->face_width / 2;
  }
}

/* The face that both members share, end by end. */
static void find_face(struct eo_rexs_import *import)
{
  struct eo_import *out = import->out;
  int last = import->pair->ends - 1;
  for (int end = 0; end <= last; end++) {
    const struct eo_rexs_wheel *pinion = &import->wheel[EO_PINION][end], *gear = &import->wheel[EO_GEAR][end];
    if (!(fmin(pinion->right, gear->right) > fmax(pinion->left, gear->left)))
      place_in_middle(import, end);
    import->left[end] = fmax(pinion->left, gear->left);
    import->right[end] = fmin(pinion->right, gear->right);
    import->width[end] = import->right[end] - import->left[end];
    double stated = eo_rexs_value(import->train->mesh[import->pair->mesh[end]].stage, "common_face_width");
    if (!isnan(stated) && !(fabs(stated - import->width[end]) <= 1e-6 * stated))
      eo_import_say(out, out->notes,
                    "common_face_width is %.9g mm; the positions of the gears give %.9g mm, which was taken.", stated,
                    import->width[end]);
  }
  import->middle = last ? (import->right[EO_LEFT] + import->left[EO_RIGHT]) / 2
                        : (import->left[EO_LEFT] + import->right[EO_LEFT]) / 2;
}

static double first_number(double a, double b)
{
  return isnan(a) ? b : a;
}

static void put_member(struct eo_rexs_import *import, json_t *gear_pair, int member)
{
  static const char *const teeth[2] = {"pinion_teeth", "gear_teeth"},
                           *const shift[2] = {"pinion_profile_shift", "gear_profile_shift"},
                           *const tip[2] = {"pinion_tip_diameter_mm", "gear_tip_diameter_mm"};
  const struct eo_rexs_wheel *wheel = &import->wheel[member][EO_LEFT];
  const struct eo_rexs_component *flank = wheel->flank[eo_rexs_loaded_side(import, member, EO_LEFT)];
  double x = first_number(eo_rexs_value(flank, "addendum_modification_coefficient"),
                          eo_rexs_value(flank, "addendum_modification") / wheel->module);
  double diameter = eo_rexs_value(wheel->gear, "tip_diameter");
  double reference = wheel->teeth * wheel->module / cos(wheel->helix * degree);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, teeth[member], wheel->teeth);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, shift[member], x);
  if (isnan(x))
    eo_import_say(import->out, import->out->assumed, "profile shift of the %s: the file states none",
                  eo_member_name[member]);
  /* less than the deepest root there can be: a placeholder */
  if (diameter < reference - 2.5 * wheel->module)
    eo_import_say(import->out, import->out->notes,
                  "tip_diameter of cylindrical_gear %d is %.6g mm, less than its root: "
                  "taken as a placeholder and left out.",
                  wheel->gear->id, diameter);
  else
    eo_rexs_put(import, &eo_gear_pair_table, gear_pair, tip[member], diameter);
}

/* Both flanks of a gear have the same pressure angle and profile shift, or a design cannot say it. */
static void demand_symmetry(struct eo_rexs_import *import, const struct eo_rexs_wheel *wheel)
{
  static const char *const what[] = {"normal_pressure_angle", "addendum_modification_coefficient"};
  for (int i = 0; i < 2; i++)
    if (!alike(eo_rexs_value(wheel->flank[0], what[i]), eo_rexs_value(wheel->flank[1], what[i])))
      eo_import_fault(import->out, "asymmetric_flanks",
                      "%s of the left and right flank of cylindrical_gear %d differ; Easeoff has symmetric teeth only.",
                      what[i], wheel->gear->id);
}

static void demand_match(struct eo_rexs_import *import)
{
  const struct eo_rexs_wheel *pinion = &import->wheel[EO_PINION][EO_LEFT], *gear = &import->wheel[EO_GEAR][EO_LEFT];
  demand_symmetry(import, pinion);
  demand_symmetry(import, gear);
  if (!(fabs(pinion->module - gear->module) <= 1e-6 * pinion->module))
    eo_import_fault(import->out, "no_mesh",
                    "The normal modules of cylindrical_gear %d and %d are %.9g and %.9g mm; gears "
                    "in mesh have one.",
                    pinion->gear->id, gear->gear->id, pinion->module, gear->module);
  if (!alike(pinion->pressure_angle, gear->pressure_angle))
    eo_import_fault(import->out, "no_mesh",
                    "The normal pressure angles of cylindrical_gear %d and %d are %.9g and %.9g "
                    "degrees; gears in mesh have one.",
                    pinion->gear->id, gear->gear->id, pinion->pressure_angle, gear->pressure_angle);
  if (!(fabs(pinion->helix + gear->helix) <= 1e-6))
    eo_import_fault(import->out, "no_mesh",
                    "The helix angles of cylindrical_gear %d and %d are %.9g and %.9g degrees; "
                    "external gears on parallel shafts have opposite ones of one size.",
                    pinion->gear->id, gear->gear->id, pinion->helix, gear->helix);
}

/* Reads gear_pair as the program will, with some backlash: what the centre distance adds to it does not depend on it.
 */
bool eo_rexs_make_geometry(struct eo_rexs_import *import, const json_t *gear_pair, struct eo_error *error)
{
  const double some_backlash = 1e-4; /* m */
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults) {
    import->out->failed = true;
    return false;
  }
  eo_table_decode(&eo_gear_pair_table, gear_pair, NULL, &import->gear_pair, faults);
  enum eo_code code = eo_faults_first(faults, error);
  free(faults);
  double distance = import->gear_pair.centre_distance; /* its digits decide those of what is converted with it */
  code = code ? code : eo_gear_pair_settle(&import->gear_pair, error);
  import->gear_pair.centre_distance = distance;
  import->gear_pair.backlash = some_backlash;
  return !code && !eo_geometry_init(&import->geometry, &import->gear_pair, error);
}

/* The backlash of the stage at its centre distance, less what the centre distance itself adds; or from the shift with
   which the teeth were made, ISO 21771: j_bn = -2 m_n sin(alpha_n) sum(x_E - x). mm; NaN: not stated. */
static double backlash_of(const struct eo_rexs_import *import)
{
  const struct eo_rexs_component *stage = import->train->mesh[import->pair->mesh[0]].stage;
  double least = eo_rexs_value(stage, "minimum_normal_backlash"),
         most = eo_rexs_value(stage, "maximum_normal_backlash");
  double mean = (first_number(least, most) + first_number(most, least)) / 2, sum = 0;
  if (!isnan(mean))
    return mean - 1e3 * (import->geometry.normal_backlash - import->geometry.stated_backlash);
  for (int member = 0; member < 2; member++)
    sum += eo_rexs_generated(import, member, false) - import->wheel[member][EO_LEFT].shift;
  return sum < 0 ? -2 * 1e3 * import->geometry.normal_module * sin(import->geometry.normal_pressure_angle) * sum : NAN;
}

static void put_backlash(struct eo_rexs_import *import, json_t *gear_pair)
{
  double backlash = backlash_of(import);
  if (isnan(backlash))
    return;
  backlash = round(backlash * 1e9) / 1e9; /* what the centre distance adds is a difference of large numbers */
  if (backlash < 0.001)
    eo_import_say(import->out, import->out->notes,
                  "The stage states %.6g mm of backlash less than its centre distance "
                  "gives: left out.",
                  -backlash);
  else
    eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "backlash_um", backlash * 1e3);
}

/* Beyond the common width nothing meshes; it matters where the modifications were laid out over all of it. */
static void name_width(struct eo_rexs_import *import)
{
  struct eo_import *out = import->out;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < import->pair->ends; end++) {
      const struct eo_rexs_wheel *wheel = &import->wheel[member][end];
      bool modified = is_modified(import, wheel->flank[0]) || is_modified(import, wheel->flank[1]);
      if (wheel->face_width > import->width[end] * (1 + same))
        eo_import_say(out, modified ? out->not_used : out->notes,
                      "face_width of cylindrical_gear %d beyond the common width", wheel->gear->id);
    }
}

static bool stands_out(const struct eo_rexs_import *import, int member)
{
  bool wider = false;
  for (int end = 0; end < import->pair->ends; end++)
    wider = wider || import->wheel[member][end].face_width > import->width[end] * (1 + same);
  return wider;
}

/* What a design cannot carry: its members stand centred on each other, and what is beyond the common face is alike on
   both ends. */
static void refuse_own_width(struct eo_rexs_import *import, int member)
{
  for (int end = 0; end < import->pair->ends; end++) {
    const struct eo_rexs_wheel *wheel = &import->wheel[member][end], *mate = &import->wheel[1 - member][end];
    double from = fmax(wheel->left, mate->left), to = fmin(wheel->right, mate->right);
    double left = fmax(0, from - wheel->left), right = fmax(0, wheel->right - to);
    if (fmax(left, right) <= same * (to - from))
      continue;
    eo_import_say(
        import->out, import->out->refused,
        "own width of cylindrical_gear %d, %.6g mm: it stands out %.6g mm to the left and %.6g mm to the right "
        "of the common %.6g mm, its mid face %.6g mm from its mate's, and a design has members centred on each "
        "other. The common width alone is read: the tooth is supported and rated without what stands out.",
        wheel->gear->id, wheel->face_width, left, right, to - from,
        fabs(wheel->left + wheel->right - mate->left - mate->right) / 2);
  }
}

/* Own widths where both members stand centred on each other and have as much beyond the common face on both ends.
 */
static void put_widths(struct eo_rexs_import *import, json_t *gear_pair)
{
  static const char *const key[2] = {"pinion_face_width_mm", "gear_face_width_mm"};
  const double *width = import->width;
  int last = import->pair->ends - 1;
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "face_width_mm", width[EO_LEFT]);
  if (fabs(width[last] - width[EO_LEFT]) > same * width[EO_LEFT])
    eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "right_face_width_mm", width[EO_RIGHT]);
  for (int member = 0; member < 2; member++) {
    bool centred = true;
    double own = import->wheel[member][EO_LEFT].face_width, beyond = own - width[EO_LEFT];
    for (int end = 0; end <= last; end++) {
      const struct eo_rexs_wheel *wheel = &import->wheel[member][end], *mate = &import->wheel[1 - member][end];
      centred = centred && fabs(wheel->left + wheel->right - mate->left - mate->right) <= same * width[end] &&
                fabs(wheel->face_width - width[end] - beyond) <= same * width[end];
    }
    if (centred && beyond > same * width[EO_LEFT])
      eo_rexs_put(import, &eo_gear_pair_table, gear_pair, key[member], own);
    else if (!centred && stands_out(import, member))
      refuse_own_width(import, member);
  }
}

/* What the tool leaves and what is taken off the tip. Where the program cannot make a tooth of it, the pair goes
   without and the file's words are named. */
static void put_finish(struct eo_rexs_import *import, json_t *gear_pair)
{
  static const struct {
    const char *key[2], *attribute;
  } rows[] = {
      {{"pinion_protuberance_um", "gear_protuberance_um"}, "protuberance_amount"},
      {{"pinion_grinding_stock_um", "gear_grinding_stock_um"}, "machining_allowance"},
      {{"pinion_tip_chamfer_mm", "gear_tip_chamfer_mm"}, "tooth_tip_chamfer"},
  };
  struct eo_import *out = import->out;
  struct eo_error error;
  char name[80];
  for (int member = 0; member < 2; member++) {
    const struct eo_rexs_component *of[3] = {
        eo_rexs_step(import, member, "tool", true), eo_rexs_step(import, member, "manufacturing_settings", true),
        import->wheel[member][EO_LEFT].flank[eo_rexs_loaded_side(import, member, EO_LEFT)]};
    json_t *before = json_copy(gear_pair);
    bool any = false;
    for (int i = 0; i < 3; i++) {
      double value = eo_rexs_value(of[i], rows[i].attribute) * (i < 2 ? 1e3 : 1);
      any = (value > 0 && eo_rexs_put(import, &eo_gear_pair_table, gear_pair, rows[i].key[member], value)) || any;
    }
    if (any && !eo_rexs_make_geometry(import, gear_pair, &error)) {
      json_object_clear(gear_pair);
      json_object_update(gear_pair, before);
      for (int i = 0; i < 3; i++)
        if (eo_rexs_value(of[i], rows[i].attribute) > 0)
          eo_import_say(out, out->not_used, "%s of %s: %s", rows[i].attribute, eo_rexs_name(of[i], name), error.text);
    }
    json_decref(before);
  }
}

/* Angles that differ by the digits of a file are one. */
static void put_right_helix(struct eo_rexs_import *import, json_t *gear_pair)
{
  const struct eo_rexs_wheel *pinion = import->wheel[EO_PINION];
  const double digits = 1e-6; /* of rexs_train.c */
  int last = import->pair->ends - 1;
  if (last && fabs(fabs(pinion[EO_RIGHT].helix) - fabs(pinion[EO_LEFT].helix)) > digits * fabs(pinion->helix))
    eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "right_helix_angle_deg", fabs(pinion[EO_RIGHT].helix));
}

bool eo_rexs_read_gear_pair(struct eo_rexs_import *import, json_t *design)
{
  struct eo_import *out = import->out;
  struct eo_error error;
  const struct eo_rexs_wheel *pinion = &import->wheel[EO_PINION][EO_LEFT];
  const struct eo_rexs_mesh *mesh = &import->train->mesh[import->pair->mesh[0]];
  json_t *gear_pair = eo_rexs_part(import, design, "gear_pair");
  demand_match(import);
  if (!gear_pair || out->faults)
    return false;
  find_face(import);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "ends", import->pair->ends);
  for (int member = 0; member < 2; member++)
    put_member(import, gear_pair, member);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "normal_module_mm", pinion->module);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "normal_pressure_angle_deg", pinion->pressure_angle);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "helix_angle_deg", fabs(pinion->helix));
  put_right_helix(import, gear_pair);
  put_widths(import, gear_pair);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "groove_width_mm",
              import->pair->ends == 2 ? import->left[EO_RIGHT] - import->right[EO_LEFT] : 0);
  eo_rexs_put(import, &eo_gear_pair_table, gear_pair, "centre_distance_mm", mesh->centre_distance);
  if (mesh->from_positions)
    eo_import_say(out, out->notes, "The centre distance, %.9g mm, is the distance of the axes of both shafts.",
                  mesh->centre_distance);
  eo_rexs_put_rack(import, gear_pair);
  name_width(import);
  if (!eo_rexs_make_geometry(import, gear_pair, &error)) {
    struct eo_import_fault *fault = eo_import_fault(out, "not_a_pair",
                                                    "The pair cannot be made as the file states it: %s", error.text);
    if (fault)
      fault->key = eo_import_text(out, error.pointer);
    return false;
  }
  eo_rexs_put_generated(import, gear_pair);
  put_finish(import, gear_pair);
  if (!eo_rexs_make_geometry(import, gear_pair, &error))
    return false;
  eo_rexs_name_root(import);
  put_backlash(import, gear_pair);
  return true;
}

/* The face at larger x meets first where hand and rotation have one sign: at the groove of the left end, or on the
   right of the only one. */
void eo_rexs_read_hand(struct eo_rexs_import *import, json_t *design)
{
  double helix = import->wheel[EO_PINION][EO_LEFT].helix;
  bool leading = helix * import->rotation > 0;
  if (helix == 0)
    return;
  eo_rexs_put_word(import, &eo_gear_pair_table, eo_rexs_part(import, design, "gear_pair"), "hand",
                   helix > 0 ? "right" : "left");
  eo_rexs_put_word(import, &eo_alignment_table, eo_rexs_part(import, design, "alignment"), "apex",
                   leading ? "leading" : "trailing");
  if (leading)
    eo_import_say(import->out, import->out->notes,
                  import->pair->ends == 2 ? "the groove side meets first: the apex leads"
                                          : "the right face meets first: alignment.apex is \"leading\"");
}

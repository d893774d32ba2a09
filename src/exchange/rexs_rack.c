/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What cuts the teeth: tools, the shift with which they cut, and the root that they leave. */
#include <math.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/rexs_import.h"
#include "gear/names.h"

static const double degree = M_PI / 180;
static const double same = 1e-9; /* relative: one number stated twice */

static bool alike(double a, double b)
{
  return isnan(a) || isnan(b) || fabs(a - b) <= same * fmax(1, fabs(a));
}

static double first_number(double a, double b)
{
  return isnan(a) ? b : a;
}

const struct eo_rexs_component *eo_rexs_step(const struct eo_rexs_import *import, int member, const char *role,
                                             bool lowest)
{
  const struct eo_rexs_wheel *wheel = &import->wheel[member][EO_LEFT];
  const struct eo_rexs_component *flank = wheel->flank[eo_rexs_loaded_side(import, member, EO_LEFT)], *found = NULL;
  int order = 0;
  for (int i = 0; i < import->model->relations && flank; i++) {
    const struct eo_rexs_relation *relation = &import->model->relation[i];
    const struct eo_rexs_component *part = eo_rexs_find(import->model, eo_rexs_role(relation, role));
    if (strcmp(relation->type, "manufacturing_step") != 0 || eo_rexs_role(relation, "workpiece") != flank->id || !part)
      continue;
    if (!found || (lowest ? relation->order < order : relation->order > order)) {
      found = part;
      order = relation->order;
    }
  }
  return found;
}

double eo_rexs_generated(const struct eo_rexs_import *import, int member, bool lowest)
{
  static const char attribute[] = "generated_addendum_modification_coefficient";
  const struct eo_rexs_wheel *wheel = &import->wheel[member][EO_LEFT];
  double generated = eo_rexs_value(eo_rexs_step(import, member, "manufacturing_settings", lowest), attribute);
  if (lowest) /* to 1.2 the flank states its own, that of the last step */
    return generated;
  return first_number(generated, eo_rexs_value(wheel->flank[eo_rexs_loaded_side(import, member, EO_LEFT)], attribute));
}

/* x_E of the one tool that cuts root and flank; NaN: not stated, or the nominal shift. Where another tool finishes the
   flank the dedendum has what the root differs by. */
static double generated_of_root(const struct eo_rexs_import *import, int member)
{
  double generated = first_number(eo_rexs_generated(import, member, true), eo_rexs_generated(import, member, false));
  bool one = eo_rexs_step(import, member, "tool", true) == eo_rexs_step(import, member, "tool", false);
  return one && fabs(generated - import->wheel[member][EO_LEFT].shift) > same ? generated : NAN;
}

/* Of one member: what its rack is. The tool of the first step makes the root. */
struct rack {
  double addendum, dedendum, fillet;
  bool by_root_diameter;
};

static struct rack rack_of(struct eo_rexs_import *import, int member)
{
  const struct eo_rexs_wheel *wheel = &import->wheel[member][EO_LEFT];
  const struct eo_rexs_component *tool = eo_rexs_step(import, member, "tool", true);
  const struct eo_rexs_component *flank = wheel->flank[eo_rexs_loaded_side(import, member, EO_LEFT)];
  double module = wheel->module;
  struct rack rack = {eo_rexs_value(flank, "addendum_coefficient_basic_profile"), NAN, NAN, false};
  rack.dedendum = first_number(eo_rexs_value(tool, "addendum_coefficient_reference_profile"),
                               eo_rexs_value(tool, "addendum_reference_profile") / module);
  rack.fillet = first_number(eo_rexs_value(tool, "tip_corner_radius_factor_reference_profile"),
                             eo_rexs_value(tool, "tip_corner_radius_reference_profile") / module);
  const struct eo_rexs_component *last = eo_rexs_step(import, member, "tool", false);
  double generated = eo_rexs_generated(import, member, true), cut = generated_of_root(import, member);
  if (!isnan(rack.dedendum) && last != tool && !isnan(generated) && fabs(generated - wheel->shift) > same) {
    rack.dedendum -= generated - wheel->shift; /* the roughing tool stands further out by so much */
    eo_import_say(import->out, import->out->notes,
                  "The %s's root is made by a tool before the finishing one, further out by %.6g of the module: the "
                  "dedendum is less by that.",
                  eo_member_name[member], generated - wheel->shift);
  }
  double root = eo_rexs_value(wheel->gear, "root_diameter");
  if (isnan(rack.dedendum) && root > 0) {
    double reference = wheel->teeth * module / cos(wheel->helix * degree);
    rack.dedendum = first_number(cut, wheel->shift) + (reference - root) / (2 * module);
    rack.by_root_diameter = true;
  }
  return rack;
}

/* One common rack, or one per member where the design has keys for it. */
void eo_rexs_put_rack(struct eo_rexs_import *import, json_t *gear_pair)
{
  static const struct {
    const char *key, *own[2], *what;
  } keys[] = {
      {"addendum_coefficient", {"pinion_addendum_coefficient", "gear_addendum_coefficient"}, "addendum"},
      {"dedendum_coefficient", {"pinion_dedendum_coefficient", "gear_dedendum_coefficient"}, "dedendum"},
      {"fillet_radius_coefficient", {"pinion_fillet_radius_coefficient", "gear_fillet_radius_coefficient"}, "fillet"},
  };
  const struct rack rack[2] = {rack_of(import, EO_PINION), rack_of(import, EO_GEAR)};
  for (int i = 0; i < 3; i++) {
    const double value[2] = {
        i == 0   ? rack[0].addendum
        : i == 1 ? rack[0].dedendum
                 : rack[0].fillet,
        i == 0   ? rack[1].addendum
        : i == 1 ? rack[1].dedendum
                 : rack[1].fillet,
    };
    eo_rexs_put(import, &eo_gear_pair_table, gear_pair, keys[i].key, first_number(value[0], value[1]));
    if (alike(value[0], value[1]))
      continue;
    if (!eo_rexs_put(import, &eo_gear_pair_table, gear_pair, keys[i].own[1], value[1]))
      eo_import_say(import->out, import->out->not_used,
                    "%s of cylindrical_gear %d: %.6g of the module; a design has one rack, the pinion's with %.6g",
                    keys[i].what, import->wheel[EO_GEAR][EO_LEFT].gear->id, value[1], value[0]);
  }
  for (int member = 0; member < 2; member++)
    if (rack[member].by_root_diameter)
      eo_import_say(import->out, import->out->assumed, "the dedendum of the %s follows from its root diameter",
                    eo_member_name[member]);
}

/* Where the program cannot make a tooth of it the pair goes without, and the reason is said. */
void eo_rexs_put_generated(struct eo_rexs_import *import, json_t *gear_pair)
{
  static const char *const key[2] = {"pinion_generating_shift", "gear_generating_shift"};
  struct eo_error error;
  for (int member = 0; member < 2; member++) {
    double generated = generated_of_root(import, member);
    if (!eo_rexs_put(import, &eo_gear_pair_table, gear_pair, key[member], generated) ||
        eo_rexs_make_geometry(import, gear_pair, &error))
      continue;
    json_object_del(gear_pair, key[member]);
    eo_import_say(import->out, import->out->not_used,
                  "generated_addendum_modification_coefficient %.6g of cylindrical_gear %d: %s", generated,
                  import->wheel[member][EO_LEFT].gear->id, error.text);
  }
}

/* The root circle that tool and shift make stands before one that is stated beside them. */
void eo_rexs_name_root(struct eo_rexs_import *import)
{
  const double digits = 1e-3; /* of the module: what is left of a number on a drawing */
  for (int member = 0; member < 2; member++) {
    const struct eo_rexs_wheel *wheel = &import->wheel[member][EO_LEFT];
    double root = eo_rexs_value(wheel->gear, "root_diameter"), made = 2e3 * import->geometry.root_radius[member];
    if (root > 0 && fabs(root - made) > digits * wheel->module)
      eo_import_say(import->out, import->out->not_used,
                    "root_diameter of cylindrical_gear %d, %.9g mm: its tool and shift make one of %.9g mm",
                    wheel->gear->id, root, made);
  }
}

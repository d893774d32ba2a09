/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keys that contradict each other: each design is refused at a key, with a sentence, and left as it was. */
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "support/tap.h"

static struct eo_design design;

/* What takes more than one key: each with the key it is reported at. */
struct contradiction {
  const char *what, *key;
  void (*apply)(struct eo_design *design);
};

static void thick_bore(struct eo_design *d)
{
  d->gear_pair.bore[EO_PINION] = 0.09;
}
static void thin_groove(struct eo_design *d)
{
  d->gear_pair.groove_diameter[EO_GEAR] = 0.08;
}
static void thick_groove(struct eo_design *d)
{
  d->gear_pair.groove_diameter[EO_PINION] = 0.1;
}
static void no_groove(struct eo_design *d)
{
  d->gear_pair.groove_width = 0;
}
static void late_tip(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_RIGHT].tip_relief_start = 5.2e-3;
}
static void late_root(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_LEFT].root_relief_start = 5.8e-3;
}
static void late_gear_tip(struct eo_design *d)
{
  d->modification.flank[EO_GEAR][EO_LEFT].tip_relief = 1e-5;
  d->modification.flank[EO_GEAR][EO_LEFT].tip_relief_start =
      5.74e-3; /* the gear's tip side ends where the pinion's root side does */
}
static void no_relief_length(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_LEFT].end_relief[1] = 1e-5;
}
static void long_end_reliefs(struct eo_design *d)
{
  for (int k = 0; k < 2; k++) {
    d->modification.flank[EO_PINION][EO_LEFT].end_relief[k] = 1e-5;
    d->modification.flank[EO_PINION][EO_LEFT].end_relief_length[k] = 0.028;
  }
}
static void even_sector(struct eo_design *d)
{
  d->resolution.elements.body = EO_BODY_SECTOR;
  d->resolution.elements.sector_teeth = 4;
}
static void many_harmonics(struct eo_design *d)
{
  d->resolution.te_harmonics = 33;
}
static void crossed_bearings(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.bearing_position[EO_GEAR][EO_LEFT] = 0.2;
}
static void bearing_inside(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.bearing_position[EO_PINION][EO_RIGHT] = 0.079;
}
static void left_bearing_inside(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.bearing_position[EO_GEAR][EO_LEFT] = -0.0799;
}
static void thin_shaft(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.shaft_diameter[EO_GEAR] = 0.09;
}
static void no_weights(struct eo_design *d)
{
  d->objective.weight[0] = d->objective.weight[1] = d->objective.weight[2] = 0;
}
static void undercut(struct eo_design *d)
{
  d->gear_pair.teeth[EO_PINION] = 8;
}
static void pointed(struct eo_design *d)
{
  d->gear_pair.tip_diameter[EO_PINION] = 0.14;
  d->gear_pair.dedendum_coefficient = 3;
  d->gear_pair.fillet_radius_coefficient = 0.02;
}
static void tip_in_fillet(struct eo_design *d)
{
  d->gear_pair.addendum_coefficient = 1.2;
}
static void narrow_face(struct eo_design *d)
{
  d->gear_pair.face_width = 5e-3;
  d->gear_pair.addendum_coefficient = 0.5;
}
static void jammed(struct eo_design *d)
{
  d->gear_pair.centre_distance = 0.2;
}

static const struct contradiction contradictions[] = {
    {"a bore that cuts the rim", "/gear_pair/pinion_bore_mm", thick_bore},
    {"a groove body thinner than the bore", "/gear_pair/gear_groove_diameter_mm", thin_groove},
    {"a groove body above the root", "/gear_pair/pinion_groove_diameter_mm", thick_groove},
    {"two ends without a groove", "/gear_pair/groove_width_mm", no_groove},
    {"tip relief beyond the active flank", "/modification/pinion/right/tip_relief_start_mm", late_tip},
    {"root relief beyond the active flank", "/modification/pinion/left/root_relief_start_mm", late_root},
    {"the gear's tip relief beyond its active flank", "/modification/gear/left/tip_relief_start_mm", late_gear_tip},
    {"end relief without a length", "/modification/pinion/left/leading_end_relief_um", no_relief_length},
    {"end reliefs that overlap", "/modification/pinion/left/leading_end_relief_length_mm", long_end_reliefs},
    {"a sector without a middle tooth", "/resolution/sector_teeth", even_sector},
    {"more harmonics than positions resolve", "/resolution/te_harmonics", many_harmonics},
    {"bearings in the wrong order", "/shafts/gear_left_bearing_mm", crossed_bearings},
    {"a right bearing inside the toothed body", "/shafts/pinion_right_bearing_mm", bearing_inside},
    {"a left bearing inside the toothed body", "/shafts/gear_left_bearing_mm", left_bearing_inside},
    {"a shaft no thicker than its bore", "/shafts/gear_shaft_diameter_mm", thin_shaft},
    {"objectives without a weight", "/objective/weights", no_weights},
    {"an undercut into the active flank", "/gear_pair/pinion_profile_shift", undercut},
    {"a pointed or interfering tip", NULL, pointed},
    {"a tip in the fillet", "/gear_pair/addendum_coefficient", tip_in_fillet},
    {"a contact that breaks off", "/gear_pair/face_width_mm", narrow_face},
    {"a negative backlash", "/gear_pair/centre_distance_mm", jammed},
};

static void test_contradictions(void)
{
  for (size_t i = 0; i < sizeof contradictions / sizeof contradictions[0]; i++) {
    struct eo_geometry geometry;
    struct eo_error error = {0};
    eo_example_build("paper-case-a", &design);
    contradictions[i].apply(&design);
    static struct eo_design before;
    before = design;
    enum eo_code code = eo_design_complete(&design, &geometry, &error);
    ok(code == EO_ERROR_INPUT && (!contradictions[i].key || strcmp(error.pointer, contradictions[i].key) == 0) &&
           error.text[0] && memcmp(&before, &design, sizeof before) == 0,
       "a design is refused for %s: %s: %s", contradictions[i].what, error.pointer, error.text);
  }
}

int main(void)
{
  test_contradictions();
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which members of a design ask for another prepared pair: each is moved by its field. */
#include <string.h>

#include "design/pair_identity.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "support/tap.h"

static struct eo_design design;

/* Moves one member of a group of the design by its field. */
static void nudge(void *group, const struct eo_field *field)
{
  char *place = (char *)group + field->offset;
  if (field->kind == EO_FIELD_NUMBER)
    *(double *)(void *)place = isnan(*(double *)(void *)place) ? 1 : nextafter(*(double *)(void *)place, INFINITY);
  else if (field->kind == EO_FIELD_FLAG)
    *(bool *)(void *)place = !*(bool *)(void *)place;
  else
    *(int *)(void *)place += 1;
}

/* How many fields of a group change the identity of the pair; those that do not are listed in `kept`, and the key says
   the same. */
static int count_identifying(const struct eo_table *table, size_t group, const char *const *kept)
{
  int count = 0;
  for (int i = 0; i < table->count; i++) {
    static struct eo_design moved;
    char key[2][EO_HASH_LENGTH + 1];
    moved = design;
    nudge((char *)&moved + group, &table->field[i]);
    struct eo_pair_identity before = eo_pair_identity_of_design(&design), after = eo_pair_identity_of_design(&moved);
    eo_pair_identity_key(&before, key[0]);
    eo_pair_identity_key(&after, key[1]);
    bool equal = eo_pair_identity_equal(&before, &after), listed = false;
    for (int k = 0; kept[k]; k++)
      listed = listed || strcmp(kept[k], table->field[i].key) == 0;
    ok(equal == listed && equal == (strcmp(key[0], key[1]) == 0), "%s %s", table->field[i].key,
       listed ? "keeps the prepared pair" : "needs another pair");
    count += !equal;
  }
  return count;
}

static void test_pair_identity(void)
{
  struct eo_geometry geometry;
  static const char *const none[] = {NULL},
                           *const entries[] = {"transverse_module_mm",
                                               "pinion_generating_shift",
                                               "gear_generating_shift",
                                               "normal_diametral_pitch_per_inch",
                                               "transverse_diametral_pitch_per_inch",
                                               "transverse_pressure_angle_deg",
                                               "pinion_profile_shift_mm",
                                               "gear_profile_shift_mm",
                                               "profile_shift_sum",
                                               "working_pressure_angle_deg",
                                               "pinion_addendum_mm",
                                               "gear_addendum_mm",
                                               "tip_alteration_coefficient",
                                               "thickness_series",
                                               "pinion_thickness_allowance_um",
                                               "gear_thickness_allowance_um",
                                               "centre_distance_allowance_um",
                                               "pinion_teeth_spanned",
                                               "gear_teeth_spanned",
                                               "pinion_measuring_ball_mm",
                                               "gear_measuring_ball_mm",
                                               "hand",
                                               NULL},
                           *const kept[] = {
                               "hub_windup", "marking_thickness_um", "mesh_law", "solver", "impact_in_dynamics",
                               "harmonics",  "te_harmonics",         NULL};
  eo_example_build("paper", &design);
  eo_design_complete(&design, &geometry, NULL);
  static const char *const aligned[] = {"shaft_angle_error_in_plane_deg",
                                        "shaft_angle_error_out_of_plane_deg",
                                        "shaft_angle_error_in_plane_um",
                                        "shaft_angle_error_out_of_plane_um",
                                        "shaft_error_grade",
                                        "pinion_axial",
                                        "pinion_axial_stiffness_N_per_um",
                                        "pinion_axial_clearance_um",
                                        "stagger",
                                        "coupling_thrust_N",
                                        "pinion_apex_offset_um",
                                        "gear_apex_offset_um",
                                        "apex",
                                        "pinion_rotation",
                                        NULL};
  int count = count_identifying(&eo_gear_pair_table, offsetof(struct eo_design, gear_pair), entries) +
              count_identifying(&eo_material_table, offsetof(struct eo_design, material), none) +
              count_identifying(&eo_resolution_table, offsetof(struct eo_design, resolution), kept) +
              count_identifying(&eo_alignment_table, offsetof(struct eo_design, alignment), aligned);
  ok(count == EO_PAIR_MEMBERS, "%d members identify a pair, and no others", count);
}

int main(void)
{
  test_pair_identity();
  return tap_done();
}

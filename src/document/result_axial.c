/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Along the axes: which way the pinion turns, which face ends meet first, where the teeth push. */
#include "document/result_private.h"

#include <math.h>

static const char *const rotations[] = {"counterclockwise", "clockwise", NULL};
static const char *const first_faces[] = {"outer", "inner", "left", "right", NULL};

struct axial_forces {
  int rotation, first; /* first: -1 without a helix */
  bool two;
  double pinion[2], sum;
};

#define OF_AXIAL(member) EO_AT(struct axial_forces, member)
static const struct eo_outline_row rows[] = {
    EO_KEY("pinion_rotation", "word", "seen from the pinion's left end", .words = rotations, OF_AXIAL(rotation)),
    EO_KEY("meets_first", "word?",
           "face ends at which contact enters: outer or inner (at the groove) of two ends, left or right of one; null "
           "without a helix",
           .words = first_faces, OF_AXIAL(first)),
    EO_KEY(
        "pinion_left_N", "number?",
        "axial force of the teeth on the pinion's left end, + to the right, mean over the mesh cycle; the gear takes "
        "the opposite one",
        .unit = &eo_unit_N, OF_AXIAL(pinion[EO_LEFT])),
    EO_KEY("pinion_right_N", "number?", "the same, right end", .unit = &eo_unit_N, .when = EO_TWO_ENDS,
           OF_AXIAL(pinion[EO_RIGHT]), EO_IF(struct axial_forces, two)),
    EO_KEY("pinion_N", "number?", "what its bearings and the coupling hold: their sum", .unit = &eo_unit_N,
           OF_AXIAL(sum)),
};
const struct eo_outline eo_outline_axial = EO_OUTLINE("AxialForces", rows);

json_t *eo_result_axial(const struct eo_result_source *source, const struct eo_case_result *case_result)
{
  const struct eo_running *running = &case_result->running;
  bool astern = case_result->load_case.direction == EO_ASTERN, two = source->ends == 2,
       helical = source->pair->geometry.helix_angle > 0;
  struct axial_forces axial = {.rotation = (eo_design_rotation(source->design) > 0) != astern,
                               .first = helical ? (two ? 0 : 2) + running->inwards : -1,
                               .two = two};
  double out = running->inwards ? -1 : 1;
  for (int end = 0; end < source->ends; end++) {
    double lean = sin(eo_pair_half(source->pair, end)->geometry.base_helix_angle);
    axial.pinion[end] = (end == EO_LEFT ? -out : out) * lean *
                        eo_result_mean_load(source, case_result, end); /* theory (F10) */
    axial.sum += axial.pinion[end];
  }
  return eo_outline_encode(&eo_outline_axial, &axial);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On coast flanks, or with the apex leading, eta runs inwards on both ends; all else is as on the drive flanks of an
   apex that trails, with shaft angle errors, offsets and thrusts of the sign that this brings (doc/theory/flank.md,
   Directions). */
#include "evaluation/meeting_field.h"

#include "contact/loaded.h"

#include <math.h>

static double outwards(const struct eo_running *running)
{
  return running->inwards ? -1 : 1;
}

/* What moves the right end's flanks apart, m, normal: an apex offset opens the gap of outer face ends that meet first.
 */
static double offset_of(const struct eo_pair *pair, const struct eo_design *design, const struct eo_running *running,
                        int end)
{
  const double *offset = design->alignment.apex_offset;
  if (end == EO_LEFT || offset[EO_PINION] == offset[EO_GEAR])
    return 0;
  /* theory (F7) */
  return outwards(running) * sin(pair->geometry.base_helix_angle) * (offset[EO_PINION] - offset[EO_GEAR]);
}

/* In y the error in the plane of the axes has the same sign on both sides of a tooth, the other one opposite signs. */
void eo_meeting_field_init(struct eo_gap_field *field, const struct eo_pair *pair, const struct eo_design *design,
                           const struct eo_flank_spline *const spline[2], const struct eo_running *running, int end)
{
  const struct eo_modification *all = &design->modification;
  bool coast = running->flank == EO_COAST_FLANK;
  double out = outwards(running), across = coast ? -out : out;
  struct eo_modification_shape shape[2];
  for (int member = 0; member < 2; member++) {
    eo_modification_init(&shape[member], &pair->geometry, member,
                         coast ? &all->coast[member][end] : &all->flank[member][end]);
    eo_modification_complete(&shape[member], spline[member], coast);
  }
  /* theory (F6) */
  eo_gap_field_init_shapes(field, &pair->geometry, shape, end, out * running->in_plane, across * running->out_of_plane,
                           out * pair->pivot[end], pair->grid->corner);
  field->offset = offset_of(pair, design, running, end);
}

struct eo_axial_hold eo_meeting_axial_hold(const struct eo_pair *pair, const struct eo_design *design,
                                           const struct eo_running *running, double load, double stiffness)
{
  const struct eo_alignment *alignment = &design->alignment;
  const struct eo_double_helix helix = eo_pair_double_helix(pair);
  double lean = eo_double_helix_lean(&helix);
  struct eo_axial_hold hold = {.stiffness = stiffness};
  if (design->gear_pair.ends == 1 || lean == 0)
    return hold;
  if (alignment->pinion_axial == EO_AXIAL_STOPS)
    hold.play = lean / 2 * alignment->pinion_axial_clearance;
  if (alignment->pinion_axial != EO_AXIAL_FIXED)
    hold.shift = outwards(running) * alignment->coupling_thrust / lean; /* theory (F8) */
  if (pair->right)
    hold.shift += load * (2 * helix.share[EO_LEFT] - 1); /* theory (F11) */
  return hold;
}

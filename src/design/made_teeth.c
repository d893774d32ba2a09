/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/made_teeth.h"

#include "design/design.h"

void eo_design_state_teeth(struct eo_design *design)
{
  const struct eo_tolerance_settings *settings = &design->tolerance;
  struct eo_pitch *pitch = &design->pitch;
  if (!settings->single_teeth)
    return;
  if (!pitch->stated && pitch->level != EO_TEETH_SKETCHED)
    pitch->positions = eo_pitch_usual_positions(design->resolution.positions);
  pitch->stated = true;
  for (int member = 0; member < 2; member++) {
    struct eo_pitch_member *own = &pitch->member[member];
    if (own->tolerance_class == 0) {
      own->tolerance_class = settings->grade;
      own->edition = (enum eo_tolerance_edition)settings->edition;
    }
    own->tolerance_share = 0;
  }
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One member as STEP (ISO 10303-21 with the schema of AP242): open shells of B-spline faces, one face per smooth piece,
   within 5 nm of what the rack leaves, also where reliefs fold a flank and the rack cuts away what it has made; a
   comment in the file names what is further off and by how much. Neighbours have common edges where their sides are one
   curve. Lengths in mm, frame as in tooth.h. */
#ifndef EASEOFF_EXCHANGE_STEP_H
#define EASEOFF_EXCHANGE_STEP_H

#include "design/design.h"
#include "format/text.h"
#include "gear/geometry.h"

/* whole: every tooth, else one of each end. Without memory, and where a surface cannot be fitted, the text has failed.
 */
void eo_step_write(const struct eo_design *design, const struct eo_geometry *geometry, int member, bool whole,
                   struct eo_text *text);

#endif

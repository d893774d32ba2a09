/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A design as a REXS model, in the design's own frame: u from left to right. The pinion turns ahead as
   eo_design_rotation() says: negatively about u its left flanks carry, positively, all mirrored, its right ones. */
#ifndef EASEOFF_EXCHANGE_REXS_EXPORT_H
#define EASEOFF_EXCHANGE_REXS_EXPORT_H

#include <jansson.h>

#include "design/design.h"
#include "exchange/rexs_build.h"
#include "gear/geometry.h"

enum { EO_REXS_EXPORT_VERSION = 107 }; /* what most programs read */

/* Fills an empty model. The design is complete; version as eo_rexs_version() gives it. with_design: the document itself
   goes along as an attribute of the gear unit, so that reading the file again gives the same design. */
void eo_rexs_export(const struct eo_design *design, const struct eo_geometry *geometry, int version, bool with_design,
                    struct eo_rexs_model *model);

/* Beside the teeth, one flank: its modifications from id on. Returns the next free id. leading: +1, -1, the face that
   meets first lies towards + u, - u. block: of the design's document; NULL: unmodified. */
struct eo_rexs_flank_export {
  const struct eo_design *design;
  const struct eo_geometry *geometry;
  int member, end;
  bool coast;
  double leading;
};
int eo_rexs_export_flank(struct eo_rexs_builder *builder, const struct eo_rexs_flank_export *flank, const json_t *block,
                         int flank_id, int id);

#endif

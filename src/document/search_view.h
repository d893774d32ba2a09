/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a search sees a flank: by the gaps that it makes between the teeth (theory (H8)). Two flanks that leave the same
   gaps are the same to the contact, whatever their numbers; gaps far deeper than the teeth bend hardly differ. */
#ifndef EASEOFF_DOCUMENT_SEARCH_VIEW_H
#define EASEOFF_DOCUMENT_SEARCH_VIEW_H

#include "document/search_space.h"
#include "optimizer/cube_warp.h"

struct eo_search_view {
  const struct eo_study_space *space; /* borrowed, as the next two */
  const struct eo_modification *base;
  const struct eo_geometry *geometry;
  int ends, sides;                     /* sides: 2 where a variable is of coast flanks alone */
  double depth;                        /* of a gap that half of all gaps are below, as they are seen, m */
  struct eo_modification modification; /* scratch */
};

/* The view of a resolved design; it borrows *search_view. Numbers of a grid are not in it. */
struct eo_view eo_search_view_init(struct eo_search_view *search_view, const struct eo_design *design,
                                   const struct eo_study_space *space, const struct eo_geometry *geometry);

#endif

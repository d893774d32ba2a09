/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One member as a closed surface of triangles, binary STL, mm: for view and print. Single precision resolves 15 nm at
   200 mm and the triangles lie some micrometres off, so flanks are not to be measured on it. */
#ifndef EASEOFF_EXCHANGE_STL_H
#define EASEOFF_EXCHANGE_STL_H

#include "design/design.h"
#include "format/text.h"
#include "gear/geometry.h"

/* Without memory the text has failed. */
void eo_stl_write(const struct eo_design *design, const struct eo_geometry *geometry, int member, struct eo_text *text);

#endif

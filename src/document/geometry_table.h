/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the macro-geometry is presented: the result's "geometry", the geometry stage. */
#ifndef EASEOFF_DOCUMENT_GEOMETRY_TABLE_H
#define EASEOFF_DOCUMENT_GEOMETRY_TABLE_H

#include "format/table.h"

extern const struct eo_table eo_geometry_table; /* struct eo_geometry */

#endif

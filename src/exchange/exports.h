/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every format a design is exported in: those of document/, and those of this room. */
#ifndef EASEOFF_EXCHANGE_EXPORTS_H
#define EASEOFF_EXCHANGE_EXPORTS_H

#include "document/design_export.h"

/* NULL after the last; NULL: there is none of this name. */
const struct eo_export *eo_exports_at(int index);
const struct eo_export *eo_exports_find(const char *name);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of designs: CSV and workbooks. */
#ifndef EASEOFF_EXCHANGE_TABLE_IMPORT_H
#define EASEOFF_EXCHANGE_TABLE_IMPORT_H

#include "exchange/import.h"

/* Reads a table as it is exported or as people fill it in: the design, what was assumed and each fault with its cell go
 *to import. workbook: bytes of a spreadsheet, else CSV. */
void eo_import_table(struct eo_import *import, const char *bytes, size_t size, bool workbook,
                     const struct eo_import_options *options);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Designs as tables that table_import.h reads back without loss. */
#ifndef EASEOFF_EXCHANGE_TABLE_EXPORT_H
#define EASEOFF_EXCHANGE_TABLE_EXPORT_H

#include <jansson.h>

#include "format/text.h"

enum eo_table_layout {
  EO_TABLE_POINT,    /* key;pinion;gear;unit, UTF-8 with byte order mark, decimal point */
  EO_TABLE_COMMA,    /* the same with decimal comma */
  EO_TABLE_WORKBOOK, /* the same as .xlsx */
  EO_TABLE_ROWS,     /* a header of keys, one design per row, decimal point */
};

/* documents: [count] of eo_design_encode(). */
void eo_table_write(const json_t *const *documents, int count, enum eo_table_layout layout, struct eo_text *text);

#endif

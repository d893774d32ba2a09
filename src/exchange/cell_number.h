/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cell of a table as a number. */
#ifndef EASEOFF_EXCHANGE_CELL_NUMBER_H
#define EASEOFF_EXCHANGE_CELL_NUMBER_H

#include <stdbool.h>

/* Digits on both sides of a sign somewhere in the cell, and nothing that makes it a text. */
bool eo_cell_has_decimal(const char *cell, char sign);

/* With the decimal sign of the table; NaN: it is no number. */
double eo_cell_number(const char *cell, bool comma);

/* 24°30'36" or 24 30 36: degrees, minutes, seconds; NaN: it is none. */
double eo_cell_sexagesimal(const char *cell);

#endif

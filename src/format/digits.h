/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Doubles as decimals. What C's printf and strtod would make of them, mostly without either: as long as the digits and
   the power of ten are integers that a double holds, one division gives the nearest double of a decimal. */
#ifndef EASEOFF_FORMAT_DIGITS_H
#define EASEOFF_FORMAT_DIGITS_H

enum { EO_DIGITS_ROOM = 40 }; /* of any of the texts below, with its NUL */

/* The double nearest to a finite value of so many significant digits. */
double eo_digits_round(double value, int digits);

/* The text of a finite value: the shortest of 15, 16 or 17 digits that reads back equal. size >= EO_DIGITS_ROOM.
   Returns its length. */
int eo_digits_write(char *text, int size, double value);

/* The text of the value rounded to so many digits, 15 at most. */
int eo_digits_write_rounded(char *text, int size, double value, int digits);

#endif

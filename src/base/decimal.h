/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decimal numbers as rig software writes them, read to the nearest double (round half to even) and quickly.
   Up to 19 significant digits are read exactly without the C library: a mantissa below 2^53 with at most 22 powers of
   ten takes one rounded operation (Clinger 1990), other ones a product or quotient of 128 bits by a power of five. What
   is left goes to strtod. */
#ifndef EASEOFF_BASE_DECIMAL_H
#define EASEOFF_BASE_DECIMAL_H

#include <stddef.h>
#include <stdint.h>

/* The mantissa's digits without leading zeros, the power of ten that goes with it. */
struct eo_decimal {
  uint64_t mantissa;
  int digits, exponent, negative;
};

extern const double eo_decimal_power[23]; /* 10^0 .. 10^22, exact */

/* The slow ways: any mantissa of up to 19 digits with any exponent, or the text itself when it has more digits. */
double eo_decimal_scale(const struct eo_decimal *decimal, const char *text, const char *end, char point);

/* Reads a number at text, sign first, with this decimal point; 'e', 'E', 'd' or 'D' starts the exponent. Returns the
   place after it, NULL when there is no number; *value is NaN when it is beyond all doubles. A point that is a comma
   must have a digit after it. The text must end with a byte that belongs to no number. */
static inline const char *eo_decimal_read(const char *text, char point, double *value)
{
  struct eo_decimal decimal = {0};
  const char *p = text;
  decimal.negative = *p == '-';
  p += *p == '-' || *p == '+';
  const char *first = p;
  unsigned digit;
  while ((digit = (unsigned)(*p - '0')) < 10) {
    decimal.mantissa = decimal.mantissa * 10 + digit;
    decimal.digits += decimal.mantissa != 0;
    p++;
  }
  long written = p - first;
  if (*p == point && (point == '.' || (unsigned)(p[1] - '0') < 10)) {
    const char *fraction = ++p;
    while ((digit = (unsigned)(*p - '0')) < 10) {
      decimal.mantissa = decimal.mantissa * 10 + digit;
      decimal.digits += decimal.mantissa != 0;
      p++;
    }
    written += p - fraction;
    decimal.exponent = (int)(fraction - p);
  }
  if (!written)
    return NULL;
  if ((*p | 0x20) == 'e' || (*p | 0x20) == 'd') {
    const char *e = p + 1;
    int sign = *e == '-' ? -1 : 1, exponent = 0;
    e += *e == '-' || *e == '+';
    if ((unsigned)(*e - '0') < 10) {
      for (; (digit = (unsigned)(*e - '0')) < 10; e++)
        exponent = exponent < 100000 ? exponent * 10 + (int)digit : exponent;
      decimal.exponent += sign * exponent;
      p = e;
    }
  }
  if (decimal.digits <= 19 && decimal.mantissa < (uint64_t)1 << 53 && decimal.exponent >= -22 &&
      decimal.exponent <= 22) {
    double m = (double)decimal.mantissa;
    m = decimal.exponent < 0 ? m / eo_decimal_power[-decimal.exponent] : m * eo_decimal_power[decimal.exponent];
    *value = decimal.negative ? -m : m;
  } else
    *value = eo_decimal_scale(&decimal, text, p, point);
  return p;
}

#endif

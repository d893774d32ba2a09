/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decimal numbers against the C library's strtod, which rounds correctly. */
#include "base/decimal.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

static uint64_t state = 88172645463325252u;

static uint64_t next_random(void)
{
  state ^= state << 13;
  state ^= state >> 7;
  return state ^= state << 17;
}

/* 1 when text is read as strtod reads it, to the last bit. */
static int same(const char *text)
{
  double value = 0, expected = strtod(text, NULL);
  const char *end = eo_decimal_read(text, '.', &value);
  if (end == text + strlen(text) && !memcmp(&value, &expected, sizeof value))
    return 1;
  printf("# %s: %.17g, expected %.17g\n", text, value, expected);
  return 0;
}

static void test_random(const char *format, const char *what)
{
  int wrong = 0;
  char text[64];
  for (int i = 0; i < 100000; i++) {
    double x = ((double)(int64_t)next_random()) * pow(10, (double)(next_random() % 60) - 45);
    snprintf(text, sizeof text, format, x);
    wrong += !same(text);
  }
  ok(wrong == 0, "100000 random numbers of %s are read as strtod reads them", what);
}

static void test_digits(void)
{
  int wrong = 0;
  char text[64];
  for (int i = 0; i < 200000; i++) {
    int exponent = (int)(next_random() % 64) - 32;
    snprintf(text, sizeof text, "%llue%d", (unsigned long long)(next_random() >> (next_random() % 60)), exponent);
    wrong += !same(text);
  }
  ok(wrong == 0, "200000 random mantissas with exponents -32 to 31 are read as strtod reads them");
}

static void test_edges(void)
{
  static const char *const texts[] = {
      "0",
      "0.0",
      "-17.15407647",
      "1e22",
      "1e23",
      "9007199254740993",
      "9007199254740992.5",
      "9007199254740993e0",
      "0.1",
      "123456789012345678901234567890",
      "2.2250738585072011e-308",
      "4.9406564584124654e-324",
      "1.7976931348623157e308",
      "8.988465674311580e307",
      "5e-324",
      "2e-324",
      "7.2057594037927933e16",
      "9223372036854775808e5",
      "18446744073709551615",
      "1844674407370955161e1",
      "0.000000000000000000000000000123456789",
      "100000000000000016777215",
      "100000000000000016777216",
      "100000000000000016777217",
      "1.00000000000000011102230246251565404236316680908203125",
      "00000000000000000000000000001.5",
      "1.",
      ".5",
      "+3.25",
      "1.5E+03",
  };
  int wrong = 0;
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
    wrong += !same(texts[i]);
  ok(wrong == 0, "ties, subnormals and long mantissas are read as strtod reads them");
}

static void test_forms(void)
{
  double value;
  const char *text = "-1,25e2;";
  ok(eo_decimal_read(text, ',', &value) == text + 7 && value == -125, "a number with a decimal comma is read");
  text = "12,\n";
  ok(eo_decimal_read(text, ',', &value) == text + 2 && value == 12,
     "a comma without a digit behind it is no decimal comma");
  text = "1.5D-3 ";
  ok(eo_decimal_read(text, '.', &value) == text + 6 && value == 1.5e-3, "an exponent of Fortran is read");
  text = "0,12345678901234567890123456789 ";
  ok(eo_decimal_read(text, ',', &value) == text + 31 && value == 0.12345678901234567890123456789,
     "a long mantissa with a comma is read");
  text = "3e ";
  ok(eo_decimal_read(text, '.', &value) == text + 1 && value == 3, "an e alone is no exponent");
  ok(!eo_decimal_read("-", '.', &value) && !eo_decimal_read(".", '.', &value) && !eo_decimal_read("e5", '.', &value) &&
         !eo_decimal_read("", '.', &value) && !eo_decimal_read("nan", '.', &value),
     "signs, points and exponents alone are no numbers");
  eo_decimal_read("1e999999999999", '.', &value);
  ok(isnan(value), "a number beyond all doubles is none");
  eo_decimal_read("-0.0", '.', &value);
  ok(value == 0, "minus zero is read as 0");
}

int main(void)
{
  test_random("%.6f", "6 decimals");
  test_random("%.9e", "10 digits");
  test_random("%.16e", "17 digits");
  test_random("%.18e", "19 digits");
  test_random("%.21e", "22 digits");
  test_digits();
  test_edges();
  test_forms();
  return tap_done();
}

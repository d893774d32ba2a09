/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Test Anything Protocol in a few lines: ok(condition, "what"), close_to(...), and tap_done() at the end. */
#ifndef EASEOFF_TESTS_SUPPORT_TAP_H
#define EASEOFF_TESTS_SUPPORT_TAP_H

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static int tap_count, tap_failed;

__attribute__((format(printf, 2, 3), unused)) static int ok(int condition, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  printf("%s %d - ", condition ? "ok" : "not ok", ++tap_count);
  vprintf(format, arguments);
  printf("\n");
  va_end(arguments);
  if (!condition)
    tap_failed++;
  return condition;
}

/* |value - expected| <= tolerance, absolute; prints all three. */
__attribute__((unused)) static int close_to(double value, double expected, double tolerance, const char *what)
{
  return ok(fabs(value - expected) <= tolerance, "%s: %.12g, expected %.12g +- %.3g", what, value, expected, tolerance);
}

/* The same with a relative tolerance. */
__attribute__((unused)) static int near(double value, double expected, double relative, const char *what)
{
  return close_to(value, expected, relative * fabs(expected), what);
}

__attribute__((unused)) static int tap_done(void)
{
  printf("1..%d\n", tap_count);
  return tap_failed != 0;
}

#endif

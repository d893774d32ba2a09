/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/thickness_allowance.h"

#include <string.h>

enum { RANGES = 11, FIRST_TOLERANCE = 21, TOLERANCES = 10 };

/* Reference diameters up to and including, mm. */
static const double diameter_limit[RANGES] = {10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10000};

/* DIN 3967 table 1: upper allowances A_sne, um. */
static const struct {
  const char *series;
  short um[RANGES];
} upper[] = {
    {"a", {-100, -135, -180, -250, -330, -450, -600, -820, -1100, -1500, -2000}},
    {"ab", {-85, -110, -150, -200, -280, -370, -500, -680, -920, -1250, -1650}},
    {"b", {-70, -95, -125, -170, -230, -310, -420, -560, -760, -1020, -1350}},
    {"bc", {-58, -75, -105, -140, -190, -260, -340, -460, -620, -840, -1150}},
    {"c", {-48, -65, -85, -115, -155, -210, -290, -390, -520, -700, -940}},
    {"cd", {-40, -54, -70, -95, -130, -175, -240, -320, -430, -580, -780}},
    {"d", {-33, -44, -60, -80, -110, -145, -200, -270, -360, -480, -640}},
    {"e", {-22, -30, -40, -56, -75, -100, -135, -180, -250, -330, -450}},
    {"f", {-10, -14, -19, -26, -35, -48, -64, -85, -115, -155, -210}},
    {"g", {-5, -7, -9, -12, -17, -22, -30, -41, -56, -75, -100}},
    {"h", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
};

/* DIN 3967 table 2: tolerances T_sn, um, of the series 21 .. 30. */
static const short width_um[TOLERANCES][RANGES] = {
    {3, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40},
    {5, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60},
    {8, 12, 16, 20, 25, 30, 40, 50, 60, 80, 100},
    {12, 20, 25, 30, 40, 50, 60, 80, 100, 130, 160},
    {20, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250},
    {30, 50, 60, 80, 100, 130, 160, 200, 250, 300, 400},
    {50, 80, 100, 130, 160, 200, 250, 300, 400, 500, 600},
    {80, 130, 160, 200, 250, 300, 400, 500, 600, 800, 1000},
    {130, 200, 250, 300, 400, 500, 600, 800, 1000, 1300, 1600},
    {200, 300, 400, 500, 600, 800, 1000, 1300, 1600, 2000, 2400},
};

enum eo_code eo_thickness_allowance(struct eo_thickness_allowance *allowance, const char *series, int tolerance,
                                    double reference_diameter, struct eo_error *error)
{
  enum { SERIES = sizeof upper / sizeof *upper };
  double d = 1e3 * reference_diameter;
  int row = 0, range = 0;
  while (row < SERIES && strcmp(series, upper[row].series) != 0)
    row++;
  if (row == SERIES)
    return eo_error_set(error, EO_ERROR_INPUT, "/series",
                        "\"%.20s\" is not a series of DIN 3967: a, ab, b, bc, c, cd, d, e, f, g or h.", series);
  if (tolerance < FIRST_TOLERANCE || tolerance >= FIRST_TOLERANCE + TOLERANCES)
    return eo_error_set(error, EO_ERROR_INPUT, "/tolerance", "%d is outside the tolerances of DIN 3967, 21 .. 30.",
                        tolerance);
  if (!(d > 0 && d <= diameter_limit[RANGES - 1]))
    return eo_error_set(error, EO_ERROR_INPUT, "/reference_diameter_mm",
                        "%.9g mm is outside the table of DIN 3967, above 0 to 10000 mm: state the allowances yourself.",
                        d);
  while (d > diameter_limit[range])
    range++;
  allowance->upper = 1e-6 * upper[row].um[range];
  allowance->lower = allowance->upper - 1e-6 * width_um[tolerance - FIRST_TOLERANCE][range];
  return EO_OK;
}

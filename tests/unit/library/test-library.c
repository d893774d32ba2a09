/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The C library: what a handle answers, what it keeps when a design is refused, and what it says then. */
#include "library/easeoff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/tap.h"

#define COARSE                                                                                                 \
  "\"resolution\": {\"body\": \"sector\", \"sector_teeth\": 3, \"neighbour_coupling\": false, \"layers\": 6, " \
  "\"flank_rows\": 4, \"fillet_elements\": 6, \"positions\": 16, \"cells_per_line\": 6, \"harmonics\": 8, "    \
  "\"te_harmonics\": 6}"
#define PAIR(face)                                                                                                \
  "{\"gear_pair\": {\"pinion_teeth\": 17, \"gear_teeth\": 44, \"normal_module_mm\": 6, \"helix_angle_deg\": 24, " \
  "\"face_width_mm\": " face "}, \"load_cases\": [{\"torque_Nm\": 621, \"speed_rpm\": 2000}, "                    \
  "{\"torque_Nm\": 828, \"speed_rpm\": 2000}], " COARSE
static const char plain[] = PAIR("55") "}", wider[] = PAIR("60") "}";
static const char relieved[] = PAIR("55") ", \"modification\": {\"pinion\": {\"left\": {\"tip_relief_um\": 14, "
                                          "\"tip_relief_start_mm\": 1.6}, \"right\": {\"tip_relief_um\": 14, "
                                          "\"tip_relief_start_mm\": 1.6}}}}";
static const char wrong[] = PAIR("55") ", \"modification\": {\"pinion\": {\"left\": {\"tip_relief_um\": -1}}}}";

static void test_refusals(void)
{
  struct easeoff *gear = (struct easeoff *)&gear;
  struct easeoff_error error;
  ok(easeoff_new(&gear, "{\"gear_pair\": {", NULL, &error) == EASEOFF_INPUT && !gear && *error.text,
     "text that is no JSON is refused: %s", error.text);
  ok(easeoff_new(&gear, "{}", NULL, &error) == EASEOFF_INPUT && !gear && *error.pointer == '/',
     "a design without a gear is refused: %s %s", error.pointer, error.text);
  ok(easeoff_new(&gear, wrong, NULL, NULL) == EASEOFF_INPUT && !gear,
     "a fault is told by its code alone where nobody asks for more");
  ok(easeoff_new(&gear, wrong, NULL, &error) == EASEOFF_INPUT &&
         !strcmp(error.pointer, "/modification/pinion/left/tip_relief_um"),
     "a fault is told at its key: %s", error.pointer);
  easeoff_free(NULL);
}

static void check_case(const struct easeoff_case *c, double torque)
{
  double low = INFINITY, high = -INFINITY, mean = 0;
  for (int j = 0; j < c->positions; j++) {
    low = fmin(low, c->transmission_error[j]);
    high = fmax(high, c->transmission_error[j]);
    mean += c->transmission_error[j] / c->positions;
  }
  ok(c->torque == torque && fabs(c->speed - 2000 * M_PI / 30) < 1e-9, "a load case has %g N m in SI", torque);
  ok(c->positions == 16 && fabs(high - low - c->peak_to_peak) < 1e-15 && fabs(mean - c->mean) < 1e-15,
     "a load case has its curve, %g um peak to peak about %g um", 1e6 * c->peak_to_peak, 1e6 * c->mean);
  ok(c->converged && c->impact > 0 && c->vibration > 0 && c->contact_pressure > 1e8 && c->root_stress > 1e7,
     "a load case has its numbers: %g N, %g m/s2, %g and %g MPa", c->impact, c->vibration, 1e-6 * c->contact_pressure,
     1e-6 * c->root_stress);
}

static void test_analyses(struct easeoff *gear)
{
  struct easeoff_error error;
  struct easeoff_case first = easeoff_case(gear, 0), second = easeoff_case(gear, 1);
  double mean = second.mean;
  ok(easeoff_cases(gear) == 2 && fabs(easeoff_objective(gear) - 1) < 1e-12,
     "a gear of two load cases has J 1 unmodified");
  check_case(&first, 621);
  check_case(&second, 828);
  ok(easeoff_analyze(gear, wrong, &error) == EASEOFF_INPUT && *error.text && easeoff_case(gear, 1).mean == mean,
     "a refused design leaves the last analysis");
  int refused = easeoff_analyze(gear, relieved, &error);
  double relieved_mean = easeoff_case(gear, 1).mean;
  ok(!refused && error.status == EASEOFF_OK && relieved_mean > mean, "tip relief deepens the deflection: %g um",
     1e6 * relieved_mean);
  double objective = easeoff_objective(gear);
  ok(objective > 0 && objective != 1, "J of the relieved gear is %g", objective);
  ok(!easeoff_analyze(gear, plain, NULL) && easeoff_case(gear, 1).mean == mean,
     "the first design gives the same numbers again, to the last bit");
  refused = easeoff_analyze(gear, wider, &error);
  double wider_mean = easeoff_case(gear, 1).mean;
  ok(!refused && wider_mean < mean, "another pair is prepared for another width: %g um", 1e6 * wider_mean);
}

int main(void)
{
  struct easeoff *gear;
  struct easeoff_error error;
  test_refusals();
  ok(!easeoff_new(&gear, plain, NULL, &error), "a gear is made of a design");
  test_analyses(gear);
  char *text = easeoff_result(gear);
  ok(text && *text == '{' && strstr(text, "\"load_cases\"") && strstr(text, easeoff_version()),
     "all of an analysis is given as JSON");
  free(text);
  easeoff_free(gear);
  return tap_done();
}

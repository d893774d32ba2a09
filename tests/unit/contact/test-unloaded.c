/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unloaded contact in its two independent forms, pair by pair: Litvin's equations on exact surfaces and the smallest
   gap. */
#include "support/contact-fixture.h"
#include "contact/unloaded.h"

enum { PHASES = 19 };

static const double degree = M_PI / 180;

struct bench {
  struct eo_geometry geometry;
  struct eo_corner_gap corner[2];
  struct eo_gap_field field;
  struct eo_shaft_errors errors;
  double phase[PHASES];
  struct eo_unloaded exact[PHASES], least[PHASES];
};

static struct bench bench;

/* The right end, tilted about its own mid face; phases over the middle part of the path. */
static void run(const struct eo_gear_pair *gears, const struct eo_flank_modification *pinion,
                const struct eo_flank_modification *gear, double kappa, double gamma, double reach)
{
  struct eo_error error;
  struct eo_geometry *g = &bench.geometry;
  ok(eo_geometry_init(g, gears, &error) == EO_OK, "a pair is made");
  eo_corner_gap_init(bench.corner, g);
  eo_gap_field_init(&bench.field, g, pinion, gear, EO_RIGHT, kappa, gamma, 0, bench.corner);
  bench.errors = (struct eo_shaft_errors){kappa, gamma, 0};
  for (int i = 0; i < PHASES; i++)
    bench.phase[i] = reach * (2.0 * i / (PHASES - 1) - 1);
  ok(eo_unloaded_exact(&bench.field, &bench.errors, PHASES, bench.phase, bench.exact, &error) == EO_OK,
     "exact contact is found");
  eo_unloaded_minimum(&bench.field, PHASES, bench.phase, bench.least);
}

/* Largest difference of the transmission errors where both touch inside the flank, constant removed (the axial float
   takes it). */
static void agree(const char *what, int fewest, double tolerance)
{
  double mean = 0, worst = 0, residual = 0;
  int points = 0;
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < PHASES; i++) {
      if (bench.exact[i].touch != EO_TOUCH_POINT || bench.least[i].touch != EO_TOUCH_POINT)
        continue;
      double difference = bench.exact[i].transmission_error - bench.least[i].transmission_error;
      if (pass == 0) {
        mean += difference;
        points++;
        residual = fmax(residual, bench.exact[i].residual);
      } else {
        worst = fmax(worst, fabs(difference - mean / points));
      }
    }
  ok(points >= fewest, "%s: %d points lie inside the flank", what, points);
  ok(residual < 1e-10, "%s: the residual of the five equations is %.1e", what, residual);
  close_to(1e6 * worst, 0, tolerance, "difference between two forms of unloaded contact, um");
}

/* Flanks that conform along lines have no point of their own: the exact form says edge, and no transmission error
   arises. */
static void test_conjugate(const struct eo_gear_pair *gears)
{
  struct eo_flank_modification none = {0};
  double worst = 0;
  bool edge = true;
  run(gears, &none, &none, 0, 0, 9e-3);
  for (int i = 0; i < PHASES; i++) {
    worst = fmax(worst, fmax(fabs(bench.exact[i].transmission_error), fabs(bench.least[i].transmission_error)));
    edge = edge && bench.least[i].touch == EO_TOUCH_EDGE;
  }
  close_to(worst, 0, 1e-15, "transmission error of conjugate flanks, m");
  ok(edge, "conjugate flanks touch over the whole line, ends included");
}

/* The way a crowned flank gives: with lead crowning alone the contact stays in mid face and moves by the phase. */
static void test_crowned(const struct eo_gear_pair *gears)
{
  struct eo_flank_modification none = {0}, lead = {.lead_crowning = 12e-6};
  double worst = 0;
  run(gears, &lead, &none, 0, 0, 9e-3);
  agree("lead crowning", PHASES, 1e-4);
  for (int i = 0; i < PHASES; i++)
    worst = fmax(worst, fmax(fabs(bench.exact[i].eta), fabs(bench.exact[i].path - bench.phase[i])));
  close_to(worst, 0, 1e-8, "contact in mid face at s = c, m");
}

static void test_outside(const struct eo_gear_pair *gears)
{
  struct eo_flank_modification none = {0}, a = case_a();
  struct eo_error error;
  double away = 60e-3;
  run(gears, &a, &none, 0, 0, 9e-3);
  ok(eo_unloaded_exact(&bench.field, &bench.errors, 1, &away, bench.exact, &error) == EO_OK &&
         bench.exact[0].touch == EO_TOUCH_NONE,
     "a pair that is not in mesh does not touch");
}

int main(void)
{
  struct eo_gear_pair paper = paper_pair(), shifted = paper_pair(), spur = paper_pair();
  struct eo_flank_modification none = {0}, a = case_a();
  shifted.profile_shift[0] = 0.4;
  shifted.profile_shift[1] = 0.1;
  spur.helix_angle = 0;
  spur.profile_shift[0] = 0.1;
  test_conjugate(&paper);
  test_conjugate(&shifted);
  test_crowned(&paper);
  test_outside(&paper);
  run(&paper, &a, &none, 0, 0, 9e-3);
  agree("case A", 10, 0.01);
  run(&paper, &none, &a, 0, 0, 9e-3);
  agree("case A on the gear", 10, 0.01);
  run(&paper, &a, &none, 0.01 * degree, 0, 9e-3);
  agree("case A, 0.01 deg in plane", 10, 0.01);
  run(&paper, &a, &none, 0, 0.1 * degree / 60, 9e-3);
  agree("case A, 0.1 arc minute out of plane", 10, 0.01);
  run(&shifted, &a, &none, 0.01 * degree, 0, 9e-3);
  agree("profile shift", 10, 0.01);
  run(&shifted, &a, &a, 0.01 * degree, 0, 9e-3);
  agree("profile shift, both members modified", 10, 0.01);
  run(&spur, &a, &none, 0.01 * degree, 0, 5e-3);
  agree("spur pair", 10, 0.01);
  /* The gap of a misalignment is linear in the angle, the exact form is not: what differs grows with its square. */
  run(&paper, &a, &none, 0.1 * degree, 0, 9e-3);
  agree("case A, 0.1 deg in plane", 10, 0.05);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh laws: values against hand calculation, slopes against differences, separation, back contact, refusals. */
#include <string.h>

#include "support/tap.h"
#include "dynamics/law.h"
#include "numerics/fourier.h"

static struct eo_mesh_force at(const struct eo_law *law, double phase, double x)
{
  double row[32];
  eo_law_rows(law, phase, row);
  return eo_law_force(law, row, x, 0);
}

/* The slope is the derivative of the force, away from kinks. */
static void check_slope(const struct eo_law *law, double phase, double x, const char *what)
{
  double step = 1e-12;
  double difference = (at(law, phase, x + step).force - at(law, phase, x - step).force) / (2 * step);
  close_to(at(law, phase, x).slope, difference, 1e-4 * (fabs(difference) + 1e6), what);
}

static void stiffness(void)
{
  struct eo_law law = {0};
  const double k[3] = {1e9, 1e8, 2e8};
  ok(!eo_law_set_stiffness(&law, 1, k, 5e-5, -5e-5, NULL), "a stiffness law is set");
  near(at(&law, 0, 6e-5).force, 1.1e9 * 1e-5, 1e-12, "force k(0) (X - tau)");
  near(at(&law, 0.25, 6e-5).force, 1.2e9 * 1e-5, 1e-12, "force k(1/4) (X - tau)");
  ok(at(&law, 0, 4e-5).force == 0 && at(&law, 0, -4e-5).force == 0, "a stiffness law has no force inside the backlash");
  near(at(&law, 0, -6e-5).force, -1.1e9 * 1e-5, 1e-12, "force on the back flanks, which push the other way");
  close_to(at(&law, 0, 4e-5).margin, -1e-5, 1e-18, "margin to the front flank");
  close_to(at(&law, 0, -6e-5).margin, 1e-5, 1e-18, "penetration of the back flank");
  ok(at(&law, 0, -6e-5).margin_slope == -1, "the margin at the back flanks grows the other way");
  check_slope(&law, 0.3, 6e-5, "slope of a stiffness law in contact");
  near(eo_law_deflection(&law, (double[]){1e9}, 8000), 5.8e-5, 1e-12, "static deflection of a stiffness law");
  ok(eo_law_is_affine(&law), "a stiffness law is affine in contact");
  eo_law_done(&law);
}

static void power(void)
{
  struct eo_law law = {0};
  const double k[1] = {3e12}, e[1] = {2e-6};
  ok(!eo_law_set_power(&law, 0, k, e, 1.5, 5e-5, NULL), "a power law is set");
  near(at(&law, 0, 5e-5 + 2e-6 + 9e-6).force, 3e12 * 9e-6 * 3e-3, 1e-12, "force K (9 um)^1.5");
  ok(at(&law, 0, 5.1e-5).force == 0 && at(&law, 0, 5.1e-5).margin < 0, "a power law has no force before contact");
  check_slope(&law, 0.1, 6.1e-5, "slope of a power law");
  const double row[2] = {3e12, 2e-6};
  near(eo_law_force(&law, row, eo_law_deflection(&law, row, 81), 0).force, 81, 1e-12,
       "force of a power law at the deflection of 81 N");
  eo_law_done(&law);
}

static void table(void)
{
  struct eo_law law = {0};
  const double load[3] = {1, 1000, 3000};
  double z[3 * 8];
  for (int j = 0; j < 8; j++) {
    double wave = cos(2 * M_PI * j / 8) + (j % 2 ? -0.25 : 0.25); /* first harmonic and the Nyquist term */
    z[j] = 1e-7 * (1 + 0.1 * wave);
    z[8 + j] = 1e-6 * (2 + 0.1 * wave);
    z[16 + j] = 1e-6 * (5 + 0.1 * wave);
  }
  ok(!eo_law_set_table(&law, 3, 8, load, z, 4, 5e-5, NULL), "a table is set");
  for (int j = 0; j < 8; j++)
    near(at(&law, j / 8.0, 5e-5 + z[8 + j]).force, 1000, 1e-9, "force of a table at its nodes");
  double between = 0.1 * (cos(2 * M_PI / 16) + 0.25 * cos(2 * M_PI * 4 / 16));
  near(at(&law, 1 / 16.0, 5e-5 + 1e-6 * (2 + between)).force, 1000, 1e-9,
       "force of a table between its nodes, by trigonometric interpolation");
  near(at(&law, 0, 5e-5 + (z[8] + z[16]) / 2).force, 2000, 1e-9, "force of a table between its loads, linear");
  near(at(&law, 0, 5e-5 + 2 * z[16] - z[8]).force, 5000, 1e-9, "force of a table beyond its last load, linear");
  ok(at(&law, 0, 5e-5 + 0.9 * z[0]).force == 0, "a table has no force below its first load");
  check_slope(&law, 0.3, 5.3e-5, "slope of a table");
  ok(at(&law, 0, -1).force == 0, "a table without back flanks never pushes back");
  ok(!eo_law_set_back(&law, -5e-5, 1e9, NULL), "back flanks are set on a table");
  near(at(&law, 0, -5.2e-5).force, -2000, 1e-9, "force of a table on its back flanks");
  ok(at(&law, 0, -4.9e-5).force == 0 && at(&law, 0, -4.9e-5).margin_slope == -1,
     "a table pushes back once its back flanks are reached");
  ok(eo_law_set_back(&law, 6e-5, 1e9, NULL) == EO_ERROR_INPUT, "a table does not push back before the front flanks do");
  const double row[3] = {1e-7, 2e-6, 5e-6};
  near(eo_law_force(&law, row, eo_law_deflection(&law, row, 4000), 0).force, 4000, 1e-12,
       "force of a table at the deflection of 4000 N");
  eo_law_done(&law);
}

static void tangent_and_secant(void)
{
  struct eo_law law = {0}, same = {0};
  double z[16], k[16];
  for (int j = 0; j < 16; j++) {
    z[j] = 1e-5 + 1e-6 * cos(2 * M_PI * j / 16) + 1e-8 * cos(2 * M_PI * 7 * j / 16);
    k[j] = 1e9 + 1e8 * sin(2 * M_PI * j / 16);
  }
  ok(!eo_law_set_tangent(&law, 16, z, k, 8000, 3, -1e-4, NULL), "a tangent law is set");
  near(at(&law, 0.25, 1e-5).force, 8000, 1e-9, "force P at X = Z, the seventh harmonic cut off");
  near(at(&law, 0.25, 1.1e-5).force, 8000 + 1.1e9 * 1e-6, 1e-9, "slope of the force beyond Z, k_tan");
  struct eo_mesh_force apart = at(&law, 0, 1.1e-5 - 9e-6);
  ok(apart.force == 0 && apart.slope == 0 && apart.margin < 0, "the teeth part where the tangent law would pull");
  near(at(&law, 0, -1.01e-4).force, -1e9 * 1e-6, 1e-9, "force on the back flanks at - 2 tau with the mean stiffness");
  check_slope(&law, 0.6, 1.1e-5, "slope of a tangent law");
  ok(!eo_law_set_tangent(&same, 16, z, k, 8000, 3, -1e-4, NULL) && eo_law_equal(&law, &same),
     "equal laws are recognised");
  z[3] *= 1.001;
  ok(!eo_law_set_tangent(&same, 16, z, k, 8000, 3, -1e-4, NULL) && !eo_law_equal(&law, &same),
     "unequal laws are told apart");
  ok(!eo_law_set_secant(&same, 16, z, 8000, 1e-6, 8, -1e-4, NULL), "a secant law is set");
  near(at(&same, 3 / 16.0, z[3] - 1e-6).force, 8000, 1e-9, "force P at Z, counted from the datum");
  eo_law_done(&law);
  eo_law_done(&same);
}

/* Refused with a sentence, and the law stays what it was. */
static void refused(enum eo_code code, const struct eo_error *error, const char *what)
{
  ok(code == EO_ERROR_INPUT && error->text[0], "%s is refused: %s", what, error->text);
}

static void refusals(void)
{
  struct eo_law law = {0};
  struct eo_error error = {0};
  const double negative[3] = {1e9, 2e9, 0}, good[1] = {1e9}, bad[1] = {NAN}, zero[1] = {0};
  const double falling[2] = {2, 1}, rising[2] = {1, 2}, z[8] = {1e-6, 1e-6, 1e-6, 1e-6, 2e-6, 2e-6, 2e-6, 2e-6},
               k[4] = {0, 0, 0, 0};
  refused(eo_law_set_stiffness(&law, 1, negative, 0, 0, &error), &error, "a stiffness that turns negative");
  refused(eo_law_set_stiffness(&law, 0, zero, 0, 0, &error), &error, "a stiffness of zero");
  refused(eo_law_set_stiffness(&law, 0, bad, 0, 0, &error), &error, "a stiffness that is not a number");
  refused(eo_law_set_stiffness(&law, 0, good, 0, 1, &error), &error, "a back flank before the front flank");
  refused(eo_law_set_power(&law, 0, good, good, 0.5, 0, &error), &error, "an exponent below one");
  refused(eo_law_set_table(&law, 2, 4, falling, z, 2, 0, &error), &error, "a table of falling loads");
  refused(eo_law_set_table(&law, 2, 4, rising, z, 3, 0, &error), &error,
          "a table of more harmonics than positions carry");
  refused(eo_law_set_table(&law, 1, 4, rising, z, 2, 0, &error), &error, "a table of a single load");
  refused(eo_law_set_tangent(&law, 4, z, k, 1000, 1, -1, &error), &error, "a tangent law without stiffness");
  refused(eo_law_set_tangent(&law, 4, z, z, 0, 1, -1, &error), &error, "a tangent law without load");
  refused(eo_law_set_secant(&law, 4, z, 1000, 2e-6, 1, -1, &error), &error,
          "a secant law whose deflection is before contact");
  ok(law.rows == 0, "a refused law stays empty");
  eo_law_done(&law);
  eo_law_done(NULL);
}

int main(void)
{
  stiffness();
  power();
  table();
  tangent_and_secant();
  refusals();
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ISO 6336 and the local contact law against tests/cases/contact.json, and Hertz's forms against FZG C14. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact/hertz.h"
#include "contact/iso6336.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "format/json.h"
#include "support/tap.h"

static struct eo_geometry geometry;
static struct eo_design design;
static json_t *cases;

static double number(const char *block, const char *key)
{
  return json_number_value(json_object_get(json_object_get(cases, block), key));
}

static void test_stiffness(void)
{
  struct eo_iso_stiffness found;
  struct eo_iso_stiffness_input input = {.teeth = {17, 44},
                                         .virtual_teeth = EO_ISO_VIRTUAL_CUBED,
                                         .normal_pressure_angle = geometry.normal_pressure_angle,
                                         .helix_angle = geometry.helix_angle,
                                         .dedendum_coefficient = 1.25,
                                         .transverse_contact_ratio = geometry.transverse_contact_ratio,
                                         .blank_factor = 1,
                                         .theory_factor = 0.8,
                                         .youngs_modulus = 206e9};
  eo_iso_stiffness(&found, &input);
  near(found.flexibility * 1e9, number("iso6336_1", "qprime"), 1e-9, "flexibility q'");
  near(found.theoretical / 1e9, number("iso6336_1", "cth"), 1e-9, "theoretical single stiffness c'_th");
  near(found.rack_factor, number("iso6336_1", "CB"), 1e-12, "basic rack factor C_B");
  near(found.single / 1e9, number("iso6336_1", "c"), 1e-9, "single stiffness c'");
  near(found.mesh_alpha / 1e9, number("iso6336_1", "cgamma"), 1e-9, "mesh stiffness c_gamma_alpha");
  near(found.mesh_beta / found.mesh_alpha, 0.85, 1e-15, "mesh stiffness c_gamma_beta over c_gamma_alpha");
  input.theory_factor = 1;
  struct eo_iso_stiffness uncorrected;
  eo_iso_stiffness(&uncorrected, &input);
  near(uncorrected.single / 1e9, number("iso6336_1", "c_noCM"), 1e-9, "single stiffness c' without C_M");
  near(uncorrected.mesh_alpha / 1e9, number("iso6336_1", "cgamma_noCM"), 1e-9,
       "mesh stiffness c_gamma_alpha without C_M");
  input.theory_factor = 0.8;
  struct eo_iso_stiffness exchanged;
  input.virtual_teeth = EO_ISO_VIRTUAL_EXACT;
  eo_iso_stiffness(&exchanged, &input);
  near(exchanged.flexibility * 1e9, 0.04723 + 0.15551 / 21.792289 + 0.25791 / 56.403572, 1e-7,
       "flexibility q' with z_n = z/(cos^2 beta_b cos beta)");
  input.virtual_teeth = EO_ISO_VIRTUAL_CUBED;
  input.teeth[0] = 44;
  input.teeth[1] = 17;
  eo_iso_stiffness(&exchanged, &input);
  near(exchanged.single, found.single, 1e-15,
       "single stiffness c' where the gear drives, as the smaller wheel is wheel 1");
  input.youngs_modulus = 103e9;
  eo_iso_stiffness(&exchanged, &input);
  near(exchanged.single, found.single / 2, 1e-15, "half the stiffness at half the modulus");
  near(eo_iso_blank_factor(0.2, 1), 0.7364607, 1e-6, "C_R of the thinnest web, 1 + ln 0.2/(5 e^0.2)");
  near(eo_iso_blank_factor(0.1, 0.5), eo_iso_blank_factor(0.2, 1), 1e-15, "C_R outside its range is taken at the edge");
  near(eo_iso_blank_factor(1, 3), 1, 1e-15, "C_R of a solid disc");
}

static void test_root(void)
{
  static const char *const block = "iso6336_3_pinion_828";
  struct eo_iso_root root;
  eo_iso_root(&root, &geometry, EO_PINION, 0, 414);
  double module = geometry.normal_module;
  near(root.virtual_teeth, number(block, "zn"), 1e-9, "virtual number of teeth z_n");
  near(root.chord / module, number(block, "sF"), 1e-9, "chord of the critical section s_Fn / m_n");
  near(root.arm / module, number(block, "hF"), 1e-9, "arm of the bending force h_Fe / m_n");
  near(root.fillet_radius / module, number(block, "rF"), 1e-9, "radius of the fillet rho_F / m_n");
  near(root.form_factor, number(block, "YF"), 1e-9, "form factor Y_F");
  near(root.stress_correction, number(block, "YS"), 1e-9, "stress correction factor Y_S");
  near(root.helix_factor, number(block, "Yb"), 1e-12, "helix factor Y_beta");
  near(root.stress / 1e6, number(block, "sigmaF0"), 1e-9, "nominal root stress sigma_F0, MPa");
  struct eo_iso_root gear, thin;
  eo_iso_root(&gear, &geometry, EO_GEAR, 0.09, 414 * 44. / 17);
  near(gear.tangential_force, root.tangential_force, 1e-12, "force on the gear's tooth against that on the pinion's");
  ok(gear.form_factor < root.form_factor && gear.rim_factor == 1,
     "more teeth have a lower form factor, and a thick rim counts 1");
  eo_iso_root(&thin, &geometry, EO_GEAR, 2 * (geometry.root_radius[EO_GEAR] - 13.5e-3), 414);
  near(thin.rim_factor, 1.6 * log(2.242), 1e-9, "rim factor Y_B of a rim as thick as the tooth is high");
}

static void test_local_law(void)
{
  const json_t *block = json_object_get(cases, "hertz"), *loads = json_object_get(block, "q"),
               *places = json_object_get(block, "s");
  double worst = 0, worst_inverse = 0, worst_slope = 0;
  for (size_t i = 0; i < json_array_size(loads); i++)
    for (size_t j = 0; j < json_array_size(places); j++) {
      double q = 1e3 * json_number_value(json_array_get(loads, i)),
             s = 1e-3 * json_number_value(json_array_get(places, j));
      double expected = 1e-6 *
                        json_number_value(json_array_get(json_array_get(json_object_get(block, "delta_um"), i), j));
      const double depth[2] = {eo_geometry_depth(&geometry, EO_PINION, s), eo_geometry_depth(&geometry, EO_GEAR, s)};
      struct eo_local_law law;
      eo_local_law_init(&law, 206e9, 0.3, eo_geometry_relative_radius(&geometry, s), depth);
      double h = 1e-4 * q, slope = (eo_local_law_approach(&law, q + h) - eo_local_law_approach(&law, q - h)) / (2 * h);
      worst = fmax(worst, fabs(eo_local_law_approach(&law, q) / expected - 1));
      worst_inverse = fmax(worst_inverse, fabs(eo_local_law_load(&law, expected) / q - 1));
      worst_slope = fmax(worst_slope, fabs(eo_local_law_derivative(&law, q) / slope - 1));
    }
  close_to(worst, 0, 1e-6, "largest relative deviation of the local approach");
  close_to(worst_inverse, 0, 2e-6, "line load from the expected approach");
  close_to(worst_slope, 0, 1e-7, "deviation of the derivative from differences");
}

static void test_inverse(void)
{
  const double depth[2] = {5e-3, 5e-3};
  struct eo_local_law law;
  eo_local_law_init(&law, 206e9, 0.3, 16e-3, depth);
  double worst = 0;
  for (double q = 1e-9; q < 1e8; q *= 3)
    worst = fmax(worst, fabs(eo_local_law_load(&law, eo_local_law_approach(&law, q)) / q - 1));
  close_to(worst, 0, 1e-12, "deviation of the inverse, from nothing to absurd loads");
  double most = exp(law.constant - 1);
  ok(eo_local_law_load(&law, 1) == most && eo_local_law_load(&law, 0) == 0 && eo_local_law_approach(&law, 0) == 0,
     "the inverse of the local law is exact at both its ends");
  close_to(eo_local_law_derivative(&law, most), 0, 1e-10 * law.slope, "derivative of the local law at its maximum");
}

static void test_hertz(void)
{
  double q = 5912.1 / 14e-3, radius = 8.382049e-3, modulus = 206e9, ratio = 0.3;
  near(eo_hertz_pressure(q, radius, modulus, ratio), 1347.3e6, 1e-4,
       "Hertz pressure of FZG C14 at the pitch point, Pa");
  double width = eo_hertz_half_width(q, radius, modulus, ratio);
  near(3.14159265358979323846 / 2 * width * eo_hertz_pressure(q, radius, modulus, ratio), q, 1e-14,
       "load that the elliptic pressure carries");
}

int main(void)
{
  struct eo_error error = {0};
  char path[1000];
  const char *folder = getenv("CASES");
  snprintf(path, sizeof path, "%s/contact.json", folder ? folder : "tests/cases");
  cases = eo_json_load(path, EO_JSON_CASES_BYTES, &error);
  eo_example_build("paper", &design);
  if (!ok(cases && eo_geometry_init(&geometry, &design.gear_pair, &error) == EO_OK,
          "the reference cases and their pair are read %s", error.text))
    return tap_done();
  test_stiffness();
  test_root();
  test_local_law();
  test_inverse();
  test_hertz();
  json_decref(cases);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rating factors: continuity, limits and worked numbers that the reference rows do not hold. */
#include <string.h>

#include "rating/load_factors.h"
#include "rating/root_rating.h"
#include "support/tap.h"

static double dynamic_at(double ratio, double eps_gamma, double load)
{
  struct eo_error error = {0};
  struct eo_dynamic_factor found = {0};
  struct eo_dynamic_input in = {.resonance_ratio = ratio,
                                .total_contact_ratio = eps_gamma,
                                .single_stiffness = 14e9,
                                .line_load = load,
                                .pitch_deviation = 16e-6,
                                .profile_deviation = 22e-6,
                                .pitch_running_in = 1.2e-6,
                                .profile_running_in = 1.6e-6,
                                .grade = 6};
  eo_dynamic_factor(&found, &in, &error);
  return found.factor;
}

/* K_V: 1 at rest, without a step where the straight line between resonance and overspeed begins and ends. */
static void test_dynamic(void)
{
  struct eo_error error = {0};
  struct eo_dynamic_factor found;
  struct eo_dynamic_input in = {.resonance_ratio = 1, .total_contact_ratio = 0.9, .line_load = 1e5};
  const double contact_ratios[] = {1.4, 2.2, 2.9};
  close_to(dynamic_at(0, 2, 8e5), 1, 1e-15, "dynamic factor K_V at rest");
  for (int i = 0; i < 3; i++) {
    double eps = contact_ratios[i];
    near(dynamic_at(1.15, eps, 8e5), dynamic_at(1.15 + 1e-9, eps, 8e5), 1e-7,
         "dynamic factor K_V at the end of resonance");
    near(dynamic_at(1.5 - 1e-9, eps, 8e5), dynamic_at(1.5, eps, 8e5), 1e-7,
         "dynamic factor K_V where overspeed begins");
  }
  /* Relief does not help at grade 6: B_k = 1; at 2.9 the profile counts 0.57/2.6, the relief 0.096/1.34. */
  double unit = 14e9 / 8e5, bp = unit * 14.8e-6, bf = unit * 20.4e-6;
  near(dynamic_at(0.4, 2.9, 8e5), 1 + 0.4 * (0.32 * bp + 0.57 / 2.6 * bf + 0.096 / 1.34), 1e-12,
       "dynamic factor K_V below resonance");
  ok(dynamic_at(0.8, 2, 40e3) != dynamic_at(0.72, 2, 40e3) && dynamic_at(0.73, 2, 40e3) == dynamic_at(0.9, 2, 40e3),
     "resonance begins at 0.5 + 0.35 sqrt(w/100) under a light load");
  ok(eo_dynamic_factor(&found, &in, &error) == EO_ERROR_INPUT && !strcmp(error.pointer, "/eps_gamma"),
     "a contact ratio that cannot be is refused: %s", error.text);
}

/* y_alpha and y_beta, um, of a material with its limit, MPa, at a pitch line speed, m/s, of a deviation, um. */
static const struct running_in {
  double (*of)(enum eo_rating_material material, double flank_limit, double velocity, double deviation);
  enum eo_rating_material material;
  double limit, speed, deviation, right;
  const char *label;
} running_ins[] = {
    {eo_pitch_running_in, EO_CASE_HARDENED, 1500, 20, 16, 1.2, "running in y_alpha, hardened, um"},
    {eo_pitch_running_in, EO_CASE_HARDENED, 1500, 20, 80, 3, "running in y_alpha, hardened, at most 3 um"},
    {eo_pitch_running_in, EO_THROUGH_HARDENED_ALLOY, 700, 3, 70, 16, "running in y_alpha, soft and slow, um"},
    {eo_pitch_running_in, EO_THROUGH_HARDENED_ALLOY, 640, 7, 100, 20, "running in y_alpha, capped at 12800/sigma, um"},
    {eo_pitch_running_in, EO_THROUGH_HARDENED_ALLOY, 640, 12, 100, 10, "running in y_alpha, capped at 6400/sigma, um"},
    {eo_helix_running_in, EO_THROUGH_HARDENED_ALLOY, 640, 12, 100, 20, "running in y_beta, soft and fast, um"},
    {eo_helix_running_in, EO_NITROCARBURISED, 650, 12, 20, 3, "running in y_beta, nitrocarburised, um"},
};

static void test_running_in(void)
{
  for (size_t i = 0; i < sizeof running_ins / sizeof *running_ins; i++) {
    const struct running_in *t = &running_ins[i];
    close_to(1e6 * t->of(t->material, 1e6 * t->limit, t->speed, 1e-6 * t->deviation), t->right, 1e-12, t->label);
  }
}

/* K_Hbeta: both branches meet where the load just covers the face; f_sh of a straddle mounted pinion in mid span. */
static void test_face(void)
{
  struct eo_error error = {0};
  double found;
  near(eo_face_load_factor(2e-5, 1e10, 1e5), 2, 1e-12, "face load factor K_Hbeta where r = 1");
  near(eo_face_load_factor(8e-5, 1e10, 1e5), 4, 1e-12, "face load factor K_Hbeta above, 2 sqrt(r)");
  struct eo_shaft_input in = {.arrangement = EO_ARRANGEMENT_A,
                              .span = 0.3,
                              .reference_diameter = 0.1,
                              .shaft_diameter = 0.05,
                              .face_width = 0.1,
                              .mean_load = 2e5,
                              .power_share = 1};
  ok(eo_shaft_deviation(&found, &in, &error) == EO_OK, "the deviation of a shaft at mid span is found");
  close_to(1e6 * found, 200 * 0.023, 1e-9, "deviation f_sh at mid span with b = d, 0.023 F_m/b");
  in.double_helical = true;
  eo_shaft_deviation(&found, &in, &error);
  close_to(1e6 * found, 200 * 0.046 * 1.5, 1e-9, "deviation f_sh of a double helical pinion with b_B = d");
  in.offset = 0.1;
  ok(eo_shaft_deviation(&found, &in, &error) == EO_ERROR_INPUT && !strcmp(error.pointer, "/offset"),
     "a pinion outside its bearings is refused: %s", error.text);
  double b1, b2;
  eo_helix_measure_factors(EO_HELIX_END_RELIEF, &b1, &b2);
  close_to(1e6 * eo_helix_deviation(10e-6, 10e-6, b1, b2, 0), 7 * 2.33, 1e-12,
           "mesh misalignment F_beta_x of end relief");
  near(eo_root_face_factor(1.5, 1), eo_root_face_factor(1.5, 3), 1e-15,
       "root face factor of b/h below 3, which counts as 3");
}

static void test_transverse(void)
{
  struct eo_transverse_input in = {1.5, 2.6, 0.82, 18e9, 16e-6, 10e-6, 1.2e-6, 1e3};
  struct eo_transverse_factor most = eo_transverse_factor(&in);
  near(most.flank, 2.6 / (1.5 * 0.82 * 0.82), 1e-12,
       "transverse load factor K_Halpha at its end, where one pair carries all");
  near(most.root, 2.6 / (0.25 * 1.5 + 0.75), 1e-12, "transverse load factor K_Falpha at its end");
  in.total_contact_ratio = 2;
  in.line_load = 1e6;
  struct eo_transverse_factor below = eo_transverse_factor(&in);
  in.total_contact_ratio = 2 + 1e-9;
  near(below.flank, eo_transverse_factor(&in).flank, 1e-7, "both branches of K_Halpha at eps_gamma = 2");
}

/* Lines of life: without steps, back and forth, falling. */
static void test_life(void)
{
  const struct eo_life_line lines[] = {
      eo_life_flank(EO_CASE_HARDENED, false, 0.85), eo_life_flank(EO_CASE_HARDENED, true, 0.85),
      eo_life_flank(EO_NITROCARBURISED, false, 0.85), eo_life_root(EO_CASE_HARDENED, 0.85),
      eo_life_root(EO_THROUGH_HARDENED_ALLOY, 0.85)};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    double worst = 0, last = INFINITY;
    int rising = 0;
    for (double n = 2e5; n < 9e9; n *= 1.3) {
      double factor = eo_life_factor(&lines[i], n);
      if (factor < lines[i].factor[0])
        worst = fmax(worst, fabs(eo_life_cycles(&lines[i], factor) / n - 1));
      rising += factor > last;
      last = factor;
    }
    ok(worst < 1e-9 && rising == 0, "line %d falls, and its cycles belong to its factors (%g)", (int)i, worst);
  }
  close_to(eo_life_factor(&lines[1], 1e7), 1.3, 1e-12, "life factor at 1e7 cycles with some pitting allowed");
  close_to(eo_life_factor(&lines[0], 1e12), 0.85, 1e-12, "life factor beyond 1e10 cycles");
  struct eo_life_line optimum = eo_life_flank(EO_CASE_HARDENED, false, 1);
  ok(isinf(eo_life_cycles(&optimum, 0.99)), "optimum conditions bring no damage below the limit");
  close_to(eo_life_share(&lines[0], 1e5), 0, 1e-15, "influence factors at the static end");
  close_to(eo_life_share(&lines[0], 5e7), 1, 1e-15, "influence factors from the knee on");
}

/* The S that makes the sum 1 is, of one class, that of its life factor; what is not loaded does no damage. */
static void test_damage(void)
{
  struct eo_life_line line = eo_life_flank(EO_CASE_HARDENED, false, 0.85);
  const double ratio[] = {eo_life_factor(&line, 3e6), 0}, cycles[] = {3e6, 1e9};
  near(eo_life_damage(&line, 1, ratio, cycles), 1, 1e-10, "sum of the damages at the safety of one class");
  near(eo_life_damage(&line, 2, ratio, cycles), 1, 1e-10, "sum of the damages with an unloaded class");
}

static void test_permissible(void)
{
  struct eo_error error = {0};
  double factor;
  near(eo_lubricant_factor(850e6, 134 / 0.8), 0.83 + 0.17, 1e-12, "lubricant factor Z_L where 1.2 + 134/nu is 2");
  near(eo_velocity_factor(1500e6, 10), 0.93 + 0.14 / 2, 1e-12, "velocity factor Z_v at 10 m/s");
  near(eo_work_hardening(130, 3e-6), 1.2, 1e-12, "work hardening factor Z_W at HB 130");
  near(eo_work_hardening(600, 6e-6), pow(0.5, 0.15), 1e-12, "work hardening factor Z_W of a rough hard pinion");
  near(eo_work_hardening_soft_pair(300, 290, 4), 1, 1e-15, "work hardening factor of equal hardness");
  ok(eo_notch_sensitivity(&factor, EO_THROUGH_HARDENED_ALLOY, 2, NAN, &error) == EO_ERROR_INPUT,
     "a notch sensitivity without proof stress is refused: %s", error.text);
  ok(eo_notch_sensitivity(&factor, EO_THROUGH_HARDENED_ALLOY, 2.5, 700e6, &error) == EO_OK,
     "the notch sensitivity with proof stress is found");
  near(factor, 1, 1e-12, "relative notch sensitivity Y_drelT at q_s = 2.5");
  ok(eo_rim_factor(&factor, 0.5, &error) == EO_ERROR_INPUT, "a rim that is too thin is refused: %s", error.text);
  eo_rim_factor(&factor, 1.2, &error);
  near(factor, 1, 1e-15, "rim factor Y_B of a thick rim");
}

static void test_materials(void)
{
  struct eo_error error = {0};
  struct eo_strength s;
  ok(eo_material_strength(&s, EO_FLAME_HARDENED, EO_QUALITY_MQ, 0, 560, &error) == EO_OK,
     "the strength of flame hardened steel is found");
  near(s.flank, (0.541 * 560 + 882) * 1e6, 1e-12, "flank strength sigma_Hlim of flame hardened steel");
  ok(eo_material_strength(&s, EO_FLAME_HARDENED, EO_QUALITY_MQ, 0, 580, &error) == EO_ERROR_INPUT,
     "a hardness above the class is refused: %s", error.text);
  ok(eo_material_strength(&s, EO_CASE_HARDENED, EO_QUALITY_MQ, EO_CORE_30HRC, 700, &error) == EO_OK &&
         fabs(s.root - 500e6) < 1,
     "a hard core gives the higher root strength");
  ok(eo_material_strength(&s, EO_STRUCTURAL, EO_QUALITY_MQ, 0, 150, &error) == EO_ERROR_INPUT,
     "a steel whose hardness is below its class is refused: %s", error.text);
}

/* 2019 shares the load of helical teeth and divides Y_beta by cos^3 beta; spur teeth below eps_alpha_n 2 stay. */
static void test_editions(void)
{
  struct eo_error error = {0};
  struct eo_rating_geometry g;
  struct eo_tooth_root old, new;
  struct eo_rating_pair pair = {{24, 95}, 14e-3, 20 * M_PI / 180, 10 * M_PI / 180, 0.36, 0.861, {0.380748, 1.395377}};
  struct eo_tooth_root_input in = {EO_ISO6336_2006, 0.48, 1.25, 0.38, 240064.4, 0, 6};
  eo_rating_geometry(&g, &pair, &error);
  ok(eo_tooth_root(&old, &pair, &g, 0, &in, &error) == EO_OK, "the root of 2006 is found %s", error.text);
  close_to(old.form_factor, 1.18, 0.006, "form factor Y_F of a report");
  in.face_width = 2 * pair.face_width;
  double nominal = old.nominal;
  ok(eo_tooth_root(&old, &pair, &g, 0, &in, &error) == EO_OK, "the root of a wider tooth is found");
  near(old.nominal, nominal / 2, 1e-12, "nominal root stress sigma_F0 of a root of its own width");
  in.edition = EO_ISO6336_2019;
  ok(eo_tooth_root(&new, &pair, &g, 0, &in, &error) == EO_OK, "the root of 2019 is found");
  near(new.form_factor, old.form_factor / sqrt(g.virtual_contact_ratio), 1e-12,
       "form factor of 2019, with f_eps = eps_alpha_n^-0.5");
  near(new.helix_factor, old.helix_factor / pow(cos(10 * M_PI / 180), 3), 1e-12, "helix factor Y_beta of 2019");
}

int main(void)
{
  test_dynamic();
  test_running_in();
  test_face();
  test_transverse();
  test_life();
  test_damage();
  test_permissible();
  test_materials();
  test_editions();
  return tap_done();
}

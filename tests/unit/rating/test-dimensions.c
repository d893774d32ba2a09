/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tolerances and drawing dimensions against published numbers, and properties that no formula shares with them. */
#include <stdio.h>
#include <string.h>

#include "gear/geometry.h"
#include "rating/backlash.h"
#include "rating/flank_tolerance.h"
#include "rating/rating_pair.h"
#include "rating/thickness_allowance.h"
#include "rating/tooth_dimensions.h"
#include "support/tap.h"

static const double degree = M_PI / 180;

static void same_um(double found, double um, const char *what)
{
  close_to(1e6 * found, um, 1e-6, what);
}

/* ISO 1328-1:1995 by the report of a 14 mm pinion, 341.183 mm, 360 mm wide, grade 6. */
static void test_tolerances(void)
{
  struct eo_error error = {0};
  struct eo_flank_tolerance t;
  struct eo_tolerance_input in = {341.183e-3, 14e-3, 360e-3, 24, 6, 2.8841, 0};
  ok(eo_flank_tolerance(&t, EO_ISO1328_1995, &in, &error) == EO_OK, "tolerances of a report's pinion are found");
  same_um(t.single_pitch, 14, "single pitch tolerance f_pt of the report");
  same_um(t.cumulative_pitch, 26, "cumulative pitch tolerance F_pk over z/8 of the report");
  same_um(t.helix_total, 25, "helix tolerance F_beta of the report");
  same_um(t.tooth_composite, 21, "tooth composite tolerance f_i' of the report");
  same_um(t.total_composite, 71, "total composite tolerance F_i' of the report");
  struct eo_flank_tolerance exact;
  eo_flank_tolerance(&exact, EO_ISO1328_1995_EXACT, &in, &error);
  ok(fabs(exact.single_pitch - t.single_pitch) <= 1.01e-6, "exact values instead of ranges move f_pt by 1 um at most");
  in.grade = 8;
  struct eo_flank_tolerance coarse;
  eo_flank_tolerance(&coarse, EO_ISO1328_1995, &in, &error);
  ok(fabs(coarse.profile_total - 2 * t.profile_total) <= 1.01e-6, "two grades double a tolerance, but for rounding");
  struct eo_tolerance_input new = {141.34e-3, 8e-3, 100e-3, 17, 5, NAN, 0};
  ok(eo_flank_tolerance(&t, EO_ISO1328_2013, &new, &error) == EO_OK, "tolerances of the edition of 2013 are found");
  same_um(t.single_pitch, 8.5, "f_pT of class 5, 0.14 + 3.2 + 5 rounded to a half");
  ok(isnan(t.tooth_composite) && isnan(t.runout), "what the edition does not state is no number");
}

/* A value on a limit belongs to the range below; outside the standard there is no number. */
static void test_ranges(void)
{
  struct eo_error error = {0};
  struct eo_flank_tolerance at, below, above;
  struct eo_tolerance_input in = {125e-3, 5e-3, 50e-3, 25, 9, NAN, 0};
  eo_flank_tolerance(&at, EO_ISO1328_1995, &in, &error);
  in.reference_diameter = 124e-3;
  eo_flank_tolerance(&below, EO_ISO1328_1995, &in, &error);
  in.reference_diameter = 126e-3;
  eo_flank_tolerance(&above, EO_ISO1328_1995, &in, &error);
  ok(at.total_pitch == below.total_pitch && above.total_pitch > at.total_pitch, "125 mm lie in the range up to 125 mm");
  in.reference_diameter = 4e-3;
  ok(eo_flank_tolerance(&at, EO_ISO1328_1995, &in, &error) == EO_ERROR_INPUT &&
         !strcmp(error.pointer, "/reference_diameter_mm") && strstr(error.text, "reference diameter, 4 mm,"),
     "4 mm is refused, and what it is of is named: %s", error.text);
  in.reference_diameter = 125e-3;
  in.grade = 12;
  ok(eo_flank_tolerance(&at, EO_ISO1328_2013, &in, &error) == EO_ERROR_INPUT &&
         !strcmp(error.pointer, "/tolerance_class"),
     "the edition of 2013 ends at class 11: %s", error.text);
  in.grade = 5;
  in.helix_angle = 45 * degree;
  ok(eo_flank_tolerance(&at, EO_ISO1328_2013, &in, &error) == EO_OK,
     "the edition of 2013 holds up to 45 degrees of helix");
  in.helix_angle = -46 * degree;
  ok(eo_flank_tolerance(&at, EO_ISO1328_2013, &in, &error) == EO_ERROR_INPUT &&
         !strcmp(error.pointer, "/helix_angle_deg"),
     "the edition of 2013 holds no further, on either hand: %s", error.text);
  close_to(1e6 * eo_tolerance_round(9.74e-6), 9.5, 1e-9, "rounding below 10 um, to halves");
  close_to(1e6 * eo_tolerance_round(10.5e-6), 11, 1e-9, "rounding from 10 um on, to whole ones");
  close_to(1e6 * eo_tolerance_round(4.96e-6), 5, 1e-9, "rounding below 5 um, to tenths");
}

static void test_allowances(void)
{
  struct eo_error error = {0};
  struct eo_thickness_allowance a;
  ok(eo_thickness_allowance(&a, "cd", 25, 341.183e-3, &error) == EO_OK, "allowances of cd25 are found");
  same_um(a.upper, -130, "upper allowance A_sne of cd at 341 mm");
  same_um(a.lower, -190, "lower allowance A_sni of cd25 at 341 mm");
  eo_thickness_allowance(&a, "cd", 25, 280e-3, &error);
  same_um(a.upper, -95, "upper allowance at 280 mm, of the range up to 280 mm");
  ok(eo_thickness_allowance(&a, "k", 25, 0.1, &error) == EO_ERROR_INPUT && !strcmp(error.pointer, "/series"),
     "a series that is none is refused: %s", error.text);
  ok(eo_thickness_allowance(&a, "c", 31, 0.1, &error) == EO_ERROR_INPUT,
     "a width of the series that is none is refused: %s", error.text);
  ok(eo_thickness_allowance(&a, "c", 25, 11, &error) == EO_ERROR_INPUT, "a diameter beyond the table is refused: %s",
     error.text);
}

/* The gear of a report: z 25, m_n 5, 20 degrees of helix, x 0.25, tip 145.522 mm. */
static struct eo_tooth helical(void)
{
  return (struct eo_tooth){25, 5e-3, 20 * degree, 20 * degree, 0.25, 0, 1.25, 0.3};
}

static void test_span_and_balls(void)
{
  struct eo_error error = {0};
  struct eo_tooth tooth = helical();
  struct eo_ball_dimension ball;
  int k = 0;
  double chosen = 0, form = eo_tooth_form_diameter(&tooth, NULL), tip = 145.522e-3;
  close_to(1e3 * eo_tooth_span(&tooth, 5), 69.368, 6e-4, "span W_5, mm");
  ok(eo_tooth_over_balls(&tooth, 10e-3, &ball, &error) == EO_OK, "the dimension over balls of 10 mm is found");
  close_to(1e3 * ball.over_two, 151.343, 6e-4, "dimension over balls M_dK of an odd number of teeth, mm");
  close_to(1e3 * ball.over_pins, 151.622, 6e-4,
           "dimension over rollers M_dR of a helical gear with an odd number of teeth, mm");
  ok(eo_tooth_span_choose(&tooth, form, tip, 50e-3, 0, &k, &error) == EO_OK && (k == 4 || k == 5),
     "the span goes over %d teeth", k);
  ok(eo_tooth_ball_choose(&tooth, form, tip, &chosen, &error) == EO_OK &&
         eo_tooth_ball_check(&tooth, chosen, form, tip, &error) == EO_OK,
     "a ball of %g mm touches the flank and stands above the tip", 1e3 * chosen);
  tooth.thickness_allowance = eo_tooth_allowance_of_span(&tooth, 5, 69.26e-3);
  close_to(eo_tooth_span(&tooth, 5), 69.26e-3, 1e-15, "span by the allowance that was measured by it, mm");
}

static void test_refusals(void)
{
  struct eo_error error = {0};
  struct eo_tooth tooth = helical();
  struct eo_ball_dimension ball;
  double form = eo_tooth_form_diameter(&tooth, NULL), tip = 145.522e-3;
  int k;
  ok(eo_tooth_span_choose(&tooth, form, tip, 15e-3, 0, &k, &error) == EO_ERROR_INPUT &&
         !strcmp(error.pointer, "/face_width_mm"),
     "a face too narrow for the anvils is refused: %s", error.text);
  ok(eo_tooth_span_check(&tooth, 9, form, tip, 50e-3, 0, &error) == EO_ERROR_INPUT,
     "a span over nine teeth is refused: %s", error.text);
  ok(eo_tooth_over_balls(&tooth, 2e-3, &ball, &error) == EO_ERROR_INPUT, "a ball that is too small is refused: %s",
     error.text);
  ok(eo_tooth_ball_check(&tooth, 30e-3, form, tip, &error) == EO_ERROR_INPUT, "a ball that is too large is refused: %s",
     error.text);
}

/* Tangents of the base circle leave the flanks over k teeth at W_k; a tooth as thick as its space touches its mate. */
static void test_thickness(void)
{
  struct eo_tooth tooth = helical();
  double base = eo_tooth_base_diameter(&tooth), base_helix = eo_tooth_base_helix_angle(&tooth);
  double pitch = M_PI * base / tooth.teeth;
  double arc = 4 * pitch + eo_tooth_transverse_thickness_at(&tooth, base);
  near(eo_tooth_span(&tooth, 5), arc * cos(base_helix), 1e-13, "span W_k against the base circle's arc over k teeth");
  near(eo_tooth_transverse_thickness_at(&tooth, eo_tooth_reference_diameter(&tooth)) * cos(tooth.helix_angle),
       eo_tooth_normal_thickness(&tooth), 1e-14, "arc on the reference cylinder against s_t");
  struct eo_tooth_chord chord = eo_tooth_chord(&tooth, 145.522e-3);
  ok(chord.thickness < eo_tooth_normal_thickness(&tooth) && chord.thickness > 0.99 * eo_tooth_normal_thickness(&tooth),
     "the chord is a little shorter than the arc");
}

/* Listings of undercut gears: 64.467 and 67.685 mm, where the formula without undercut has 67.428 and 67.749. The
   trochoid stays 2 um above the first and 6 um below the second; how the listing finds its circle is not known. */
static void test_undercut(void)
{
  const double unknown_method = 7e-3; /* mm */
  bool undercut = false;
  struct eo_tooth deep = {17, 4e-3, 20 * degree, 0, -0.8, -85e-6, 1.25, 0.25},
                  slight = {16, 4.5e-3, 20 * degree, 0, 0.1818, -85e-6, 1.39, 0.25}, none = helical();
  double found = eo_tooth_form_diameter(&deep, &undercut);
  ok(undercut, "z 17 with x -0.83 is undercut");
  close_to(1e3 * found, 64.467, unknown_method, "form circle of z 17 with x -0.83, mm");
  found = eo_tooth_form_diameter(&slight, &undercut);
  ok(undercut, "z 16 with a deep rack is undercut");
  close_to(1e3 * found, 67.685, unknown_method, "form circle of z 16 with a deep rack, mm");
  found = eo_tooth_form_diameter(&none, &undercut);
  ok(!undercut && found > eo_tooth_base_diameter(&none), "z 25 with x 0.25 is not undercut");
  /* At the border the two ways agree. */
  struct eo_tooth border = {20, 3e-3, 20 * degree, 15 * degree, 0, 0, 1.25, 0.25};
  double low = -2, high = 2;
  for (int i = 0; i < 60; i++) {
    border.profile_shift = (low + high) / 2;
    eo_tooth_form_diameter(&border, &undercut);
    if (undercut)
      low = border.profile_shift;
    else
      high = border.profile_shift;
  }
  border.profile_shift = high;
  double closed = eo_tooth_form_diameter(&border, NULL);
  border.profile_shift = low - 1e-7;
  near(eo_tooth_form_diameter(&border, NULL), closed, 1e-5,
       "circle of the trochoid against the formula's where they join");
}

static void test_backlash(void)
{
  struct eo_error error = {0};
  struct eo_backlash j;
  struct eo_backlash_input in = {{24, 95},        14e-3,  20 * degree,        10 * degree,
                                 {0.48, 0.66909}, 861e-3, {-130e-6, -240e-6}, -28e-6};
  ok(eo_backlash(&j, &in, &error) == EO_OK, "the backlash of a report's pair is found");
  close_to(1e3 * j.circumferential, 0.359, 6e-4, "least circumferential backlash j_wt, mm");
  close_to(1e3 * j.radial, 0.426, 1e-3, "least radial backlash j_r, mm");
  close_to(1e3 * j.of_reference, 0.332, 6e-4, "normal backlash j_n as the report has it, mm");
  in.centre_distance = j.tight_distance;
  in.centre_distance_allowance = 0;
  eo_backlash(&j, &in, &error);
  close_to(j.radial, 0, 1e-15, "radial backlash at the tight distance");
  close_to(j.normal, 0, 2e-6, "normal backlash at the tight distance, but for what is linear");
  in.centre_distance = 0.7;
  ok(eo_backlash(&j, &in, &error) == EO_ERROR_INPUT && !strcmp(error.pointer, "/centre_distance_mm"),
     "a centre distance at which nothing meshes is refused: %s", error.text);
}

/* The rating's numbers of a pair are those of the geometry that everything else computes with. */
static void test_pair(void)
{
  struct eo_error error = {0};
  struct eo_rating_pair pair = {{24, 95}, 14e-3, 20 * degree, 10 * degree, 360e-3, 861e-3, {0, 0}};
  struct eo_shift_split split;
  struct eo_rating_geometry g;
  struct eo_geometry full;
  ok(eo_shift_split(&split, &pair, 0.48, &error) == EO_OK, "the shift of the gear is found");
  close_to(split.gear_shift, 0.6691, 6e-5, "profile shift of the gear x_2");
  close_to(1e3 * split.tip_alteration, -0.938, 6e-4, "tip alteration k m_n, mm");
  struct eo_gear_pair drawing = {.ends = 1,
                                 .teeth = {24, 95},
                                 .normal_module = 14e-3,
                                 .normal_pressure_angle = 20 * degree,
                                 .helix_angle = 10 * degree,
                                 .face_width = 360e-3,
                                 .addendum_coefficient = 1,
                                 .dedendum_coefficient = 1.25,
                                 .fillet_radius_coefficient = 0.38,
                                 .profile_shift = {0.48, split.gear_shift},
                                 .centre_distance = 861e-3,
                                 .backlash = 1e-4};
  for (int i = 0; i < 2; i++)
    drawing.tip_diameter[i] = pair.tip_diameter[i] =
        14e-3 * pair.teeth[i] / cos(10 * degree) + 2 * ((1 + drawing.profile_shift[i]) * 14e-3 + split.tip_alteration);
  ok(eo_rating_geometry(&g, &pair, &error) == EO_OK && eo_geometry_init(&full, &drawing, &error) == EO_OK,
     "the geometry is found by its rating and in full %s", error.text);
  near(g.transverse_contact_ratio, full.transverse_contact_ratio, 1e-12,
       "transverse contact ratio of the rating against the pair's");
  near(g.overlap_ratio, full.overlap_ratio, 1e-12, "overlap ratio of the rating against the pair's");
  for (int i = 0; i < 2; i++) {
    struct eo_tooth tooth = {pair.teeth[i], 14e-3, 20 * degree, 10 * degree, drawing.profile_shift[i], 0, 1.25, 0.38};
    near(eo_active_root_diameter(&pair, &g, i), 2 * full.start_radius[i], 1e-12,
         "active root diameter d_Nf of the rating against the pair's");
    near(eo_tooth_form_diameter(&tooth, NULL), 2 * full.form_radius[i], 1e-12,
         "form diameter d_Ff of the rating against the pair's");
    near(eo_tooth_root_diameter(&tooth), 2 * full.root_radius[i], 1e-12,
         "root diameter d_f of the rating against the pair's");
    near(eo_tooth_transverse_thickness_at(&tooth, pair.tip_diameter[i]), full.tip_thickness[i], 1e-10,
         "tip thickness s_at of the rating against the pair's");
  }
}

int main(void)
{
  test_tolerances();
  test_ranges();
  test_allowances();
  test_span_and_balls();
  test_refusals();
  test_thickness();
  test_undercut();
  test_backlash();
  test_pair();
  return tap_done();
}

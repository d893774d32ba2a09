/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/flank_tolerance.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Limits of the ranges, mm (ISO 1328-1:1995, 1 and the tables of 6). */
static const double diameter_limits[] = {5, 20, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6000, 8000, 10000};
static const double module_limits[] = {0.5, 2, 3.5, 6, 10, 16, 25, 40, 70};
static const double width_limits[] = {4, 10, 20, 40, 80, 160, 250, 400, 650, 1000};

enum {
  DIAMETERS = sizeof diameter_limits / sizeof *diameter_limits,
  MODULES = sizeof module_limits / sizeof *module_limits,
  WIDTHS = sizeof width_limits / sizeof *width_limits,
};

/* Geometric mean of the range that the value lies in; a limit belongs to the range below it (5.3 of 1995). */
static double range_mean(const double *limit, int count, double value)
{
  int i = 1;
  while (i < count - 1 && value > limit[i])
    i++;
  return sqrt(limit[i - 1] * limit[i]);
}

double eo_tolerance_round(double tolerance)
{
  double um = 1e6 * tolerance, step = um >= 10 ? 1 : um >= 5 ? 0.5 : 0.1;
  const double above_rounding = 1e-9; /* a half that is one on paper stays one */
  return 1e-6 * step * floor(um / step + 0.5 + above_rounding);
}

double eo_base_pitch_tolerance(double single_pitch, double transverse_pressure_angle)
{
  return single_pitch * cos(transverse_pressure_angle);
}

/* ISO/TR 10064-3: f_Sigma_beta = 0.5 (l/b) F_beta, f_Sigma_delta = 2 f_Sigma_beta. */
struct eo_axis_tolerance eo_axis_tolerance(double helix_total, double span_over_width)
{
  double out_of_plane = 0.5 * span_over_width * helix_total;
  return (struct eo_axis_tolerance){.in_plane = 2 * out_of_plane, .out_of_plane = out_of_plane};
}

static enum eo_code check_range(const char *name, double value, double low, double high, const char *key,
                                const char *unit, struct eo_error *error)
{
  const double slack = 1e-9; /* 5 mm in m and back */
  if (value >= low * (1 - slack) && value <= high * (1 + slack))
    return EO_OK;
  return eo_error_set(
      error, EO_ERROR_INPUT, key,
      "The %s, %.9g%s, is outside the range of ISO 1328-1, %.9g .. %.9g%s: state the tolerances yourself.", name, value,
      unit, low, high, unit);
}

/* Grades 0 and 12 are those of 1995 alone. */
static enum eo_code check_class(int grade, struct eo_error *error)
{
  if (grade == 0 || grade == 12)
    return eo_error_set(
        error, EO_ERROR_INPUT, "/tolerance_class",
        "ISO 1328-1:2013 has the tolerance classes 1 .. 11. Grade %d is one of the edition of 1995, which "
        "has the grades 0 .. 12: state that edition, or one of these classes.",
        grade);
  return check_range("tolerance class", grade, 1, 11, "/tolerance_class", "", error);
}

static enum eo_code check_input(enum eo_tolerance_edition edition, const struct eo_tolerance_input *in,
                                struct eo_error *error)
{
  bool new = edition == EO_ISO1328_2013;
  EO_TRY(check_range("reference diameter", 1e3 * in->reference_diameter, 5, new ? 15000 : 10000,
                     "/reference_diameter_mm", " mm", error));
  EO_TRY(check_range("normal module", 1e3 * in->normal_module, 0.5, 70, "/normal_module_mm", " mm", error));
  EO_TRY(check_range("face width", 1e3 * in->face_width, 4, new ? 1200 : 1000, "/face_width_mm", " mm", error));
  if (new)
    EO_TRY(check_range("helix angle", fabs(in->helix_angle) * 180 / M_PI, 0, 45, "/helix_angle_deg", " deg", error));
  EO_TRY(new ? check_class(in->grade, error) : check_range("grade", in->grade, 0, 12, "/grade", "", error));
  if (in->teeth)
    EO_TRY(check_range("number of teeth", in->teeth, 5, new ? 1000 : INFINITY, "/teeth", "", error));
  return EO_OK;
}

/* ISO 1328-1:1995, 6 and annexes A (composite) and B (form and slope): grade 5, um, before the step of the grade;
   F_r by ISO 1328-2:1997. D, M, B in mm. */
static struct eo_flank_tolerance grade_five(double D, double M, double B, int teeth, double eps_gamma)
{
  struct eo_flank_tolerance tolerance;
  int k = teeth / 8;
  tolerance.single_pitch = 0.3 * (M + 0.4 * sqrt(D)) + 4;                                       /* 6: f_pt */
  tolerance.cumulative_pitch = k >= 1 ? tolerance.single_pitch + 1.6 * sqrt((k - 1) * M) : NAN; /* 6: F_pk */
  tolerance.total_pitch = 0.3 * M + 1.25 * sqrt(D) + 7;                                         /* 6: F_p */
  tolerance.profile_total = 3.2 * sqrt(M) + 0.22 * sqrt(D) + 0.7;                               /* 6: F_alpha */
  tolerance.profile_form = 2.5 * sqrt(M) + 0.17 * sqrt(D) + 0.5;                                /* B: f_falpha */
  tolerance.profile_slope = 2 * sqrt(M) + 0.14 * sqrt(D) + 0.5;                                 /* B: f_Halpha */
  tolerance.helix_total = 0.1 * sqrt(D) + 0.63 * sqrt(B) + 4.2;                                 /* 6: F_beta */
  tolerance.helix_form = tolerance.helix_slope = 0.07 * sqrt(D) + 0.45 * sqrt(B) + 3; /* B: f_fbeta = f_Hbeta */
  tolerance.runout = 0.24 * M + sqrt(D) + 5.6;                                        /* ISO 1328-2: F_r = 0.8 F_p */
  double K = eps_gamma < 4 ? 0.2 * (eps_gamma + 4) / eps_gamma : 0.4;                 /* A: K */
  tolerance.tooth_composite = isnan(eps_gamma) ? NAN : K * (9 + 0.3 * M + 3.2 * sqrt(M) + 0.34 * sqrt(D)); /* A: f_i' */
  tolerance.total_composite = tolerance.total_pitch + tolerance.tooth_composite; /* A: F_i' = F_p + f_i' */
  return tolerance;
}

/* ISO 1328-1:2013, 5.3: class 5, um, before the step of the class; d, m, b in mm. Totals are roots of squares of the
   unrounded parts. */
static struct eo_flank_tolerance class_five(double d, double m, double b)
{
  struct eo_flank_tolerance tolerance;
  tolerance.single_pitch = 0.001 * d + 0.4 * m + 5;                                 /* 5.3: f_pT */
  tolerance.total_pitch = 0.002 * d + 0.55 * sqrt(d) + 0.7 * m + 12;                /* 5.3: F_pT */
  tolerance.profile_slope = 0.4 * m + 0.001 * d + 4;                                /* 5.3: f_HalphaT */
  tolerance.profile_form = 0.55 * m + 5;                                            /* 5.3: f_falphaT */
  tolerance.profile_total = hypot(tolerance.profile_slope, tolerance.profile_form); /* 5.3: F_alphaT */
  tolerance.helix_slope = 0.05 * sqrt(d) + 0.35 * sqrt(b) + 4;                      /* 5.3: f_HbetaT */
  tolerance.helix_form = 0.07 * sqrt(d) + 0.45 * sqrt(b) + 4;                       /* 5.3: f_fbetaT */
  tolerance.helix_total = hypot(tolerance.helix_slope, tolerance.helix_form);       /* 5.3: F_betaT */
  tolerance.cumulative_pitch = tolerance.runout = tolerance.tooth_composite = tolerance.total_composite = NAN;
  return tolerance;
}

/* Step between grades and classes: sqrt 2, before rounding. */
static void step_and_round(struct eo_flank_tolerance *tolerance, int grade)
{
  double *const all[] = {&tolerance->single_pitch,  &tolerance->cumulative_pitch, &tolerance->total_pitch,
                         &tolerance->profile_total, &tolerance->profile_form,     &tolerance->profile_slope,
                         &tolerance->helix_total,   &tolerance->helix_form,       &tolerance->helix_slope,
                         &tolerance->runout,        &tolerance->tooth_composite,  &tolerance->total_composite};
  double step = exp2((grade - 5) / 2.0);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    *all[i] = eo_tolerance_round(1e-6 * step * *all[i]);
}

enum eo_code eo_flank_tolerance(struct eo_flank_tolerance *tolerance, enum eo_tolerance_edition edition,
                                const struct eo_tolerance_input *in, struct eo_error *error)
{
  enum eo_code code = check_input(edition, in, error);
  if (code)
    return code;
  double d = 1e3 * in->reference_diameter, m = 1e3 * in->normal_module, b = 1e3 * in->face_width;
  if (edition == EO_ISO1328_1995) {
    d = range_mean(diameter_limits, DIAMETERS, d);
    m = range_mean(module_limits, MODULES, m);
    b = range_mean(width_limits, WIDTHS, b);
  }
  *tolerance = edition == EO_ISO1328_2013 ? class_five(d, m, b)
                                          : grade_five(d, m, b, in->teeth, in->total_contact_ratio);
  step_and_round(tolerance, in->grade);
  return EO_OK;
}

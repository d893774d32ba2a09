/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/tooth_dimensions.h"

#include <math.h>

#include "gear/geometry.h"

double eo_tooth_transverse_pressure_angle(const struct eo_tooth *t)
{
  return atan(tan(t->normal_pressure_angle) / cos(t->helix_angle));
}

double eo_tooth_base_helix_angle(const struct eo_tooth *t)
{
  return asin(sin(t->helix_angle) * cos(t->normal_pressure_angle));
}

double eo_tooth_reference_diameter(const struct eo_tooth *t)
{
  return t->normal_module * t->teeth / cos(t->helix_angle);
}

double eo_tooth_base_diameter(const struct eo_tooth *t)
{
  return eo_tooth_reference_diameter(t) * cos(eo_tooth_transverse_pressure_angle(t));
}

/* ISO 21771: s_n = m_n (pi/2 + 2 x tan alpha_n) + A_sn. */
double eo_tooth_normal_thickness(const struct eo_tooth *t)
{
  return t->normal_module * (M_PI / 2 + 2 * t->profile_shift * tan(t->normal_pressure_angle)) + t->thickness_allowance;
}

/* ISO 21771: s_y = d_y (s_t/d + inv alpha_t - inv alpha_y). */
double eo_tooth_transverse_thickness_at(const struct eo_tooth *t, double diameter)
{
  double transverse = eo_tooth_normal_thickness(t) / cos(t->helix_angle);
  double pressure = acos(fmin(1, eo_tooth_base_diameter(t) / diameter));
  return diameter * (transverse / eo_tooth_reference_diameter(t) +
                     eo_geometry_involute_function(eo_tooth_transverse_pressure_angle(t)) -
                     eo_geometry_involute_function(pressure));
}

/* tan beta_y = tan beta d_y / d. */
double eo_tooth_normal_thickness_at(const struct eo_tooth *t, double diameter)
{
  double helix = atan(tan(t->helix_angle) * diameter / eo_tooth_reference_diameter(t));
  return eo_tooth_transverse_thickness_at(t, diameter) * cos(helix);
}

double eo_tooth_generating_shift(const struct eo_tooth *t)
{
  return t->profile_shift + t->thickness_allowance / (2 * t->normal_module * tan(t->normal_pressure_angle));
}

/* DIN 3960: in the normal section a circle of d_n = m_n z_n; s_n / d_n is half the tooth's angle. */
struct eo_tooth_chord eo_tooth_chord(const struct eo_tooth *t, double tip_diameter)
{
  double base_helix = eo_tooth_base_helix_angle(t);
  double virtual_teeth = t->teeth / (cos(base_helix) * cos(base_helix) * cos(t->helix_angle));
  double diameter = t->normal_module * virtual_teeth, half_angle = eo_tooth_normal_thickness(t) / diameter;
  return (struct eo_tooth_chord){.thickness = diameter * sin(half_angle),
                                 .height = (tip_diameter - eo_tooth_reference_diameter(t)) / 2 +
                                           diameter / 2 * (1 - cos(half_angle))};
}

/* ISO 21771: W_k = m_n cos alpha_n (pi (k - 1/2) + z inv alpha_t) + 2 x m_n sin alpha_n, without the allowance. */
static double nominal_span(const struct eo_tooth *t, int k)
{
  double m = t->normal_module, alpha = t->normal_pressure_angle;
  double inv = eo_geometry_involute_function(eo_tooth_transverse_pressure_angle(t));
  return m * cos(alpha) * (M_PI * (k - 0.5) + t->teeth * inv) + 2 * t->profile_shift * m * sin(alpha);
}

double eo_tooth_span(const struct eo_tooth *t, int k)
{
  return nominal_span(t, k) + t->thickness_allowance * cos(t->normal_pressure_angle);
}

double eo_tooth_allowance_of_span(const struct eo_tooth *t, int k, double span)
{
  return (span - nominal_span(t, k)) / cos(t->normal_pressure_angle);
}

/* d = sqrt(d_b^2 + (W_k cos beta_b)^2): the anvils touch in the middle of the measured length. */
double eo_tooth_span_contact(const struct eo_tooth *t, int k)
{
  return hypot(eo_tooth_base_diameter(t), eo_tooth_span(t, k) * cos(eo_tooth_base_helix_angle(t)));
}

enum eo_code eo_tooth_span_check(const struct eo_tooth *t, int k, double form_diameter, double tip_diameter,
                                 double face_width, double anvil, struct eo_error *error)
{
  double contact = eo_tooth_span_contact(t, k), span = eo_tooth_span(t, k);
  double needed = span * sin(eo_tooth_base_helix_angle(t)) + anvil;
  if (!(contact > form_diameter && contact < tip_diameter))
    return eo_error_set(error, EO_ERROR_INPUT, "/teeth_spanned",
                        "The anvils would touch at diameter %.6g mm over %d teeth, outside the flank %.6g .. %.6g mm: "
                        "span another number of teeth, or measure over balls.",
                        1e3 * contact, k, 1e3 * form_diameter, 1e3 * tip_diameter);
  if (t->helix_angle > 0 && face_width < needed)
    return eo_error_set(error, EO_ERROR_INPUT, "/face_width_mm",
                        "The span over %d teeth needs a face of %.6g mm and has %.6g mm: measure over balls.", k,
                        1e3 * needed, 1e3 * face_width);
  return EO_OK;
}

enum eo_code eo_tooth_span_choose(const struct eo_tooth *t, double form_diameter, double tip_diameter,
                                  double face_width, double anvil, int *teeth_spanned, struct eo_error *error)
{
  double middle = (form_diameter + tip_diameter) / 2, nearest = INFINITY;
  *teeth_spanned = 1;
  for (int k = 1; k <= t->teeth / 2 + 1; k++) {
    double away = fabs(eo_tooth_span_contact(t, k) - middle);
    if (eo_tooth_span(t, k) <= 0 || away >= nearest)
      continue;
    nearest = away;
    *teeth_spanned = k;
  }
  return eo_tooth_span_check(t, *teeth_spanned, form_diameter, tip_diameter, face_width, anvil, error);
}

/* ISO 21771: inv alpha_K = inv alpha_t + D_M/(z m_n cos alpha_n) - pi/(2 z) + (2 x tan alpha_n + A_sn/m_n)/z. */
enum eo_code eo_tooth_over_balls(const struct eo_tooth *t, double ball, struct eo_ball_dimension *dimension,
                                 struct eo_error *error)
{
  double m = t->normal_module, z = t->teeth, alpha = t->normal_pressure_angle, base = eo_tooth_base_diameter(t);
  double value = eo_geometry_involute_function(eo_tooth_transverse_pressure_angle(t)) + ball / (z * m * cos(alpha)) -
                 M_PI / 2 / z + (2 * t->profile_shift * tan(alpha) + t->thickness_allowance / m) / z;
  if (!(value > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/ball_mm",
                        "A ball of %.6g mm drops below the base circle in this tooth space: take a larger one.",
                        1e3 * ball);
  double pressure = eo_geometry_involute_inverse(value), centre = base / cos(pressure);
  double tangent = tan(pressure) - ball * cos(eo_tooth_base_helix_angle(t)) / base; /* tan alpha_c */
  bool odd = t->teeth % 2 == 1;
  dimension->centre_diameter = centre;
  dimension->contact_diameter = base * hypot(1, tangent);
  if (tangent < 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/ball_mm",
                        "A ball of %.6g mm would touch below the base circle: take a larger one.", 1e3 * ball);
  dimension->over_one = (centre + ball) / 2;
  dimension->over_two = (odd ? centre * cos(M_PI / 2 / z) : centre) + ball;
  /* Pins lie along the spaces: on a helical gear they cross opposite each other somewhere along the face. */
  dimension->over_pins = odd && t->helix_angle == 0 ? dimension->over_two : centre + ball;
  return EO_OK;
}

enum eo_code eo_tooth_ball_check(const struct eo_tooth *t, double ball, double form_diameter, double tip_diameter,
                                 struct eo_error *error)
{
  struct eo_ball_dimension found;
  enum eo_code code = eo_tooth_over_balls(t, ball, &found, error);
  if (code)
    return code;
  if (!(found.contact_diameter > form_diameter && found.contact_diameter < tip_diameter))
    return eo_error_set(error, EO_ERROR_INPUT, "/ball_mm",
                        "A ball of %.6g mm would touch at diameter %.6g mm, outside the flank %.6g .. %.6g mm.",
                        1e3 * ball, 1e3 * found.contact_diameter, 1e3 * form_diameter, 1e3 * tip_diameter);
  if (2 * found.over_one <= tip_diameter)
    return eo_error_set(error, EO_ERROR_INPUT, "/ball_mm",
                        "A ball of %.6g mm does not stand above the tip circle: take a larger one.", 1e3 * ball);
  return EO_OK;
}

/* The next size up among the usual steps. */
static double step_up(double ball)
{
  double mm = 1e3 * ball, step = mm <= 1 ? 0.05 : mm <= 5 ? 0.25 : mm <= 10 ? 0.5 : mm <= 30 ? 1 : 5;
  return 1e-3 * step * ceil(mm / step - 1e-9);
}

/* The ball that touches at d_v = d + 2 x m_n. Its centre lies where the normal of the flank at d_v, a tangent of the
   base circle, reaches the middle of the space: alpha_K = alpha_v + half the angle of the space at d_v, and D_M = d_b
   (tan alpha_K - tan alpha_v) / cos beta_b. */
static double ideal_ball(const struct eo_tooth *t)
{
  double base = eo_tooth_base_diameter(t);
  double diameter = eo_tooth_reference_diameter(t) + 2 * t->profile_shift * t->normal_module;
  double pressure = acos(fmin(1, base / fmax(diameter, base)));
  double half_space = M_PI / t->teeth -
                      eo_tooth_transverse_thickness_at(t, fmax(diameter, base)) / fmax(diameter, base);
  return (tan(pressure + half_space) - tan(pressure)) * base / cos(eo_tooth_base_helix_angle(t));
}

enum eo_code eo_tooth_ball_choose(const struct eo_tooth *t, double form_diameter, double tip_diameter, double *ball,
                                  struct eo_error *error)
{
  enum { MOST_STEPS = 40 };
  *ball = step_up(ideal_ball(t));
  enum eo_code code = EO_OK;
  /* An ideal ball below the tip circle is exchanged for the next that stands above it. */
  for (int i = 0; i < MOST_STEPS; i++) {
    struct eo_ball_dimension found;
    code = eo_tooth_over_balls(t, *ball, &found, error);
    if (!code && 2 * found.over_one > tip_diameter)
      break;
    *ball = step_up(*ball * (1 + 1e-6));
  }
  return eo_tooth_ball_check(t, *ball, form_diameter, tip_diameter, error);
}

double eo_tooth_root_diameter(const struct eo_tooth *t)
{
  double depth = (t->dedendum_coefficient - eo_tooth_generating_shift(t)) * t->normal_module;
  return eo_tooth_reference_diameter(t) - 2 * depth;
}

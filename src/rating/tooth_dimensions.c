/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/tooth_dimensions.h"

#include <math.h>

#include "gear/geometry.h"

double eo_tooth_transverse_pressure_angle(const struct eo_tooth *tooth)
{
  return atan(tan(tooth->normal_pressure_angle) / cos(tooth->helix_angle));
}

double eo_tooth_base_helix_angle(const struct eo_tooth *tooth)
{
  return asin(sin(tooth->helix_angle) * cos(tooth->normal_pressure_angle));
}

double eo_tooth_reference_diameter(const struct eo_tooth *tooth)
{
  return tooth->normal_module * tooth->teeth / cos(tooth->helix_angle);
}

double eo_tooth_base_diameter(const struct eo_tooth *tooth)
{
  return eo_tooth_reference_diameter(tooth) * cos(eo_tooth_transverse_pressure_angle(tooth));
}

/* ISO 21771: s_n = m_n (pi/2 + 2 x tan alpha_n) + A_sn. */
double eo_tooth_normal_thickness(const struct eo_tooth *tooth)
{
  return tooth->normal_module * (M_PI / 2 + 2 * tooth->profile_shift * tan(tooth->normal_pressure_angle)) +
         tooth->thickness_allowance;
}

/* ISO 21771: s_y = d_y (s_t/d + inv alpha_t - inv alpha_y). */
double eo_tooth_transverse_thickness_at(const struct eo_tooth *tooth, double diameter)
{
  double transverse = eo_tooth_normal_thickness(tooth) / cos(tooth->helix_angle);
  double pressure = acos(fmin(1, eo_tooth_base_diameter(tooth) / diameter));
  return diameter * (transverse / eo_tooth_reference_diameter(tooth) +
                     eo_geometry_involute_function(eo_tooth_transverse_pressure_angle(tooth)) -
                     eo_geometry_involute_function(pressure));
}

/* tan beta_y = tan beta d_y / d. */
double eo_tooth_normal_thickness_at(const struct eo_tooth *tooth, double diameter)
{
  double helix = atan(tan(tooth->helix_angle) * diameter / eo_tooth_reference_diameter(tooth));
  return eo_tooth_transverse_thickness_at(tooth, diameter) * cos(helix);
}

double eo_tooth_generating_shift(const struct eo_tooth *tooth)
{
  return tooth->profile_shift +
         tooth->thickness_allowance / (2 * tooth->normal_module * tan(tooth->normal_pressure_angle));
}

/* DIN 3960: in the normal section a circle of d_n = m_n z_n; s_n / d_n is half the tooth's angle. */
struct eo_tooth_chord eo_tooth_chord(const struct eo_tooth *tooth, double tip_diameter)
{
  double base_helix = eo_tooth_base_helix_angle(tooth);
  double virtual_teeth = tooth->teeth / (cos(base_helix) * cos(base_helix) * cos(tooth->helix_angle));
  double diameter = tooth->normal_module * virtual_teeth, half_angle = eo_tooth_normal_thickness(tooth) / diameter;
  return (struct eo_tooth_chord){.thickness = diameter * sin(half_angle),
                                 .height = (tip_diameter - eo_tooth_reference_diameter(tooth)) / 2 +
                                           diameter / 2 * (1 - cos(half_angle))};
}

/* ISO 21771: W_k = m_n cos alpha_n (pi (k - 1/2) + z inv alpha_t) + 2 x m_n sin alpha_n, without the allowance. */
static double nominal_span(const struct eo_tooth *tooth, int k)
{
  double m = tooth->normal_module, alpha = tooth->normal_pressure_angle;
  double inv = eo_geometry_involute_function(eo_tooth_transverse_pressure_angle(tooth));
  return m * cos(alpha) * (M_PI * (k - 0.5) + tooth->teeth * inv) + 2 * tooth->profile_shift * m * sin(alpha);
}

double eo_tooth_span(const struct eo_tooth *tooth, int k)
{
  return nominal_span(tooth, k) + tooth->thickness_allowance * cos(tooth->normal_pressure_angle);
}

double eo_tooth_allowance_of_span(const struct eo_tooth *tooth, int k, double span)
{
  return (span - nominal_span(tooth, k)) / cos(tooth->normal_pressure_angle);
}

/* d = sqrt(d_b^2 + (W_k cos beta_b)^2): the anvils touch in the middle of the measured length. */
double eo_tooth_span_contact(const struct eo_tooth *tooth, int k)
{
  return hypot(eo_tooth_base_diameter(tooth), eo_tooth_span(tooth, k) * cos(eo_tooth_base_helix_angle(tooth)));
}

enum eo_code eo_tooth_span_check(const struct eo_tooth *tooth, int k, double form_diameter, double tip_diameter,
                                 double face_width, double anvil, struct eo_error *error)
{
  double contact = eo_tooth_span_contact(tooth, k), span = eo_tooth_span(tooth, k);
  double needed = span * sin(eo_tooth_base_helix_angle(tooth)) + anvil;
  if (!(contact > form_diameter && contact < tip_diameter))
    return eo_error_set(error, EO_ERROR_INPUT, "/teeth_spanned",
                        "The anvils would touch at diameter %.6g mm over %d teeth, outside the flank %.6g .. %.6g mm: "
                        "span another number of teeth, or measure over balls.",
                        1e3 * contact, k, 1e3 * form_diameter, 1e3 * tip_diameter);
  if (tooth->helix_angle > 0 && face_width < needed)
    return eo_error_set(error, EO_ERROR_INPUT, "/face_width_mm",
                        "The span over %d teeth needs a face of %.6g mm and has %.6g mm: measure over balls.", k,
                        1e3 * needed, 1e3 * face_width);
  return EO_OK;
}

enum eo_code eo_tooth_span_choose(const struct eo_tooth *tooth, double form_diameter, double tip_diameter,
                                  double face_width, double anvil, int *teeth_spanned, struct eo_error *error)
{
  double middle = (form_diameter + tip_diameter) / 2, nearest = INFINITY;
  *teeth_spanned = 1;
  for (int k = 1; k <= tooth->teeth / 2 + 1; k++) {
    double away = fabs(eo_tooth_span_contact(tooth, k) - middle);
    if (eo_tooth_span(tooth, k) <= 0 || away >= nearest)
      continue;
    nearest = away;
    *teeth_spanned = k;
  }
  return eo_tooth_span_check(tooth, *teeth_spanned, form_diameter, tip_diameter, face_width, anvil, error);
}

/* ISO 21771: inv alpha_K = inv alpha_t + D_M/(z m_n cos alpha_n) - pi/(2 z) + (2 x tan alpha_n + A_sn/m_n)/z. */
enum eo_code eo_tooth_over_balls(const struct eo_tooth *tooth, double ball, struct eo_ball_dimension *dimension,
                                 struct eo_error *error)
{
  double m = tooth->normal_module, z = tooth->teeth, alpha = tooth->normal_pressure_angle,
         base = eo_tooth_base_diameter(tooth);
  double value = eo_geometry_involute_function(eo_tooth_transverse_pressure_angle(tooth)) +
                 ball / (z * m * cos(alpha)) - M_PI / 2 / z +
                 (2 * tooth->profile_shift * tan(alpha) + tooth->thickness_allowance / m) / z;
  if (!(value > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/ball_mm",
                        "A ball of %.6g mm drops below the base circle in this tooth space: take a larger one.",
                        1e3 * ball);
  double pressure = eo_geometry_involute_inverse(value), centre = base / cos(pressure);
  double tangent = tan(pressure) - ball * cos(eo_tooth_base_helix_angle(tooth)) / base; /* tan alpha_c */
  bool odd = tooth->teeth % 2 == 1;
  dimension->centre_diameter = centre;
  dimension->contact_diameter = base * hypot(1, tangent);
  if (tangent < 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/ball_mm",
                        "A ball of %.6g mm would touch below the base circle: take a larger one.", 1e3 * ball);
  dimension->over_one = (centre + ball) / 2;
  dimension->over_two = (odd ? centre * cos(M_PI / 2 / z) : centre) + ball;
  /* Pins lie along the spaces: on a helical gear they cross opposite each other somewhere along the face. */
  dimension->over_pins = odd && tooth->helix_angle == 0 ? dimension->over_two : centre + ball;
  return EO_OK;
}

enum eo_code eo_tooth_ball_check(const struct eo_tooth *tooth, double ball, double form_diameter, double tip_diameter,
                                 struct eo_error *error)
{
  struct eo_ball_dimension found;
  enum eo_code code = eo_tooth_over_balls(tooth, ball, &found, error);
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
static double ideal_ball(const struct eo_tooth *tooth)
{
  double base = eo_tooth_base_diameter(tooth);
  double diameter = eo_tooth_reference_diameter(tooth) + 2 * tooth->profile_shift * tooth->normal_module;
  double pressure = acos(fmin(1, base / fmax(diameter, base)));
  double half_space = M_PI / tooth->teeth -
                      eo_tooth_transverse_thickness_at(tooth, fmax(diameter, base)) / fmax(diameter, base);
  return (tan(pressure + half_space) - tan(pressure)) * base / cos(eo_tooth_base_helix_angle(tooth));
}

enum eo_code eo_tooth_ball_choose(const struct eo_tooth *tooth, double form_diameter, double tip_diameter, double *ball,
                                  struct eo_error *error)
{
  enum { MOST_STEPS = 40 };
  *ball = step_up(ideal_ball(tooth));
  enum eo_code code = EO_OK;
  /* An ideal ball below the tip circle is exchanged for the next that stands above it. */
  for (int i = 0; i < MOST_STEPS; i++) {
    struct eo_ball_dimension found;
    code = eo_tooth_over_balls(tooth, *ball, &found, error);
    if (!code && 2 * found.over_one > tip_diameter)
      break;
    *ball = step_up(*ball * (1 + 1e-6));
  }
  return eo_tooth_ball_check(tooth, *ball, form_diameter, tip_diameter, error);
}

double eo_tooth_root_diameter(const struct eo_tooth *tooth)
{
  double depth = (tooth->dedendum_coefficient - eo_tooth_generating_shift(tooth)) * tooth->normal_module;
  return eo_tooth_reference_diameter(tooth) - 2 * depth;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/load_factors.h"

#include <math.h>

/* N/m to the standard's N/mm. */
static double per_mm(double line_load)
{
  return line_load / 1e3;
}

/* (30): m_red = pi/8 (d_m1/d_b1)^2 d_m1^2 / (1/((1 - q_1^4) rho_1) + 1/((1 - q_2^4) rho_2 u^2)), q of each member with
   its own bore. */
double eo_reduced_mass(const struct eo_wheel_blank blank[2], double gear_ratio)
{
  double mean[2], resistance[2];
  for (int i = 0; i < 2; i++) {
    mean[i] = (blank[i].tip_diameter + blank[i].root_diameter) / 2;
    resistance[i] = 1 / ((1 - pow(blank[i].bore / mean[i], 4)) * blank[i].density);
  }
  double lever = mean[0] / blank[0].base_diameter;
  return M_PI / 8 * lever * lever * mean[0] * mean[0] / (resistance[0] + resistance[1] / (gear_ratio * gear_ratio));
}

/* (6): n_E1 = 30000/(pi z_1) sqrt(c_gamma_alpha/m_red), in 1/min; here 1/(2 pi z_1) sqrt(c/m) in 1/s. */
double eo_resonance_speed(int pinion_teeth, double mesh_stiffness, double reduced_mass)
{
  return sqrt(mesh_stiffness / reduced_mass) / (2 * M_PI * pinion_teeth);
}

/* Specific load below which both N_S and the stiffness of the teeth fall, N/mm. */
static const double light_load = 100;

/* ISO 6336-1 9.3.2.5. */
double eo_light_load_factor(double line_load)
{
  return fmin(1, pow(per_mm(line_load) / light_load, 0.25));
}

/* Table 8: C_v1 .. C_v7. */
struct influences {
  double pitch, profile, relief;         /* C_v1 .. C_v3, subcritical */
  double resonance;                      /* C_v4 */
  double fast_pitch, fast_profile, fast; /* C_v5 .. C_v7 */
};

static struct influences influences_of(double eps)
{
  struct influences influences = {
      .pitch = 0.32, .profile = 0.34, .relief = 0.23, .resonance = 0.90, .fast_pitch = 0.47, .fast_profile = 0.47};
  if (eps > 2) {
    influences.profile = 0.57 / (eps - 0.3);
    influences.relief = 0.096 / (eps - 1.56);
    influences.resonance = (0.57 - 0.05 * eps) / (eps - 1.44);
    influences.fast_profile = 0.12 / (eps - 1.74);
  }
  influences.fast = eps <= 1.5 ? 0.75 : eps <= 2.5 ? 0.125 * sin(M_PI * (eps - 2)) + 0.875 : 1;
  return influences;
}

/* Where the speed range begins and ends: N_S .. 1.15 main resonance, from 1.5 supercritical (6.5.3). */
static const double resonance_end = 1.15, fast_begin = 1.5;

static double subcritical_end(double line_load)
{
  const double normal = 0.85; /* N_S */
  return line_load < light_load ? 0.5 + 0.35 * sqrt(line_load / light_load) : normal;
}

/* 6.5.4 to 6.5.7. */
static void set_factor(struct eo_dynamic_factor *factor, const struct influences *influences, double ratio,
                       double lowest)
{
  double bp = factor->pitch_share, bf = factor->profile_share, bk = factor->relief_share;
  double resonant = 1 + influences->pitch * bp + influences->profile * bf + influences->resonance * bk; /* 6.5.5 */
  double fast = influences->fast_pitch * bp + influences->fast_profile * bf + influences->fast;         /* 6.5.6 */
  if (ratio <= lowest) {
    factor->range = EO_SUBCRITICAL;
    factor->factor = 1 +
                     ratio * (influences->pitch * bp + influences->profile * bf + influences->relief * bk); /* 6.5.4 */
  } else if (ratio <= resonance_end) {
    factor->range = EO_MAIN_RESONANCE;
    factor->factor = resonant;
  } else if (ratio < fast_begin) {
    factor->range = EO_BETWEEN_RANGES;
    factor->factor = fast + (resonant - fast) * (fast_begin - ratio) / (fast_begin - resonance_end); /* 6.5.7 */
  } else {
    factor->range = EO_SUPERCRITICAL;
    factor->factor = fast;
  }
}

enum eo_code eo_dynamic_factor(struct eo_dynamic_factor *dynamic, const struct eo_dynamic_input *in,
                               struct eo_error *error)
{
  enum { RELIEF_HELPS_BELOW = 6 };
  if (!(in->total_contact_ratio > 1))
    return eo_error_set(error, EO_ERROR_INPUT, "/eps_gamma",
                        "K_V of method B needs a total contact ratio above 1, not %.6g.", in->total_contact_ratio);
  if (!(in->line_load > 0 && in->resonance_ratio >= 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/load_N_per_mm",
                        "K_V of method B needs a load above 0 and a speed from 0.");
  double unit = in->single_stiffness / in->line_load; /* c'/w */
  struct influences influences = influences_of(in->total_contact_ratio);
  dynamic->pitch_share = unit * (in->pitch_deviation - in->pitch_running_in);                    /* (15) */
  dynamic->profile_share = unit * (in->profile_deviation - in->profile_running_in);              /* (16) */
  dynamic->relief_share = in->grade >= RELIEF_HELPS_BELOW ? 1 : fabs(1 - unit * in->tip_relief); /* (17) */
  set_factor(dynamic, &influences, in->resonance_ratio, subcritical_end(per_mm(in->line_load)));
  return EO_OK;
}

double eo_running_in_relief(double flank_limit)
{
  return 1e-6 * (pow(flank_limit / 1e6 / 97 - 18.45, 2) / 18 + 1.5);
}

static bool surface_hardened(enum eo_rating_material material)
{
  return material != EO_THROUGH_HARDENED_ALLOY && material != EO_THROUGH_HARDENED_CARBON && material != EO_STRUCTURAL;
}

/* factor/sigma_Hlim of the deviation; capped at twice cap for 5 < v <= 10 m/s and at cap above (N/mm2 um). */
static double soft_running_in(double flank_limit, double velocity, double deviation, double factor, double cap)
{
  double limit = flank_limit / 1e6, most = velocity <= 5 ? INFINITY : velocity <= 10 ? 2 * cap / limit : cap / limit;
  return fmin(factor / limit * deviation, 1e-6 * most);
}

double eo_pitch_running_in(enum eo_rating_material material, double flank_limit, double velocity, double deviation)
{
  return surface_hardened(material) ? fmin(0.075 * deviation, 3e-6)
                                    : soft_running_in(flank_limit, velocity, deviation, 160, 6400);
}

double eo_helix_running_in(enum eo_rating_material material, double flank_limit, double velocity, double deviation)
{
  return surface_hardened(material) ? fmin(0.15 * deviation, 6e-6)
                                    : soft_running_in(flank_limit, velocity, deviation, 320, 12800);
}

/* Figure 13: K' with a stiffening pinion body and without. */
static const double arrangement_constant[][2] = {[EO_ARRANGEMENT_A] = {0.48, 0.80},
                                                 [EO_ARRANGEMENT_B] = {-0.48, -0.80},
                                                 [EO_ARRANGEMENT_C] = {1.33, 1.33},
                                                 [EO_ARRANGEMENT_D] = {-0.36, -0.60},
                                                 [EO_ARRANGEMENT_E] = {-0.60, -1.00}};

/* 7.6.2.2: f_sh = F_m/b 0.023 (|B* + K' l s/d_1^2 (d_1/d_sh)^4 - 0.3| + 0.3)(b/d_1)^2, um; double helical 0.046 and
   b_B. B* = 1 + 2 (100 - k)/k of a power share k %, double helical 0.5 + (200 - k)/k. */
enum eo_code eo_shaft_deviation(double *deviation, const struct eo_shaft_input *in, struct eo_error *error)
{
  const double most_offset = 0.3, stiffening_from = 1.15;
  if (!(in->span > 0 && fabs(in->offset) / in->span <= most_offset))
    return eo_error_set(error, EO_ERROR_INPUT, "/offset", "Method C holds for s/l up to %.2g.", most_offset);
  if (!(in->power_share > 0 && in->power_share <= 1))
    return eo_error_set(error, EO_ERROR_INPUT, "/power_share", "A share of the power is above 0 and at most 1.");
  double share = 100 * in->power_share, d = in->reference_diameter, ratio = d / in->shaft_diameter;
  double star = in->double_helical ? 0.5 + (200 - share) / share : 1 + 2 * (100 - share) / share;
  double constant = arrangement_constant[in->arrangement][!(in->stiffened && ratio >= stiffening_from)];
  double bending = constant * in->span * in->offset / (d * d) * pow(ratio, 4);
  double bracket = fabs(star + bending - 0.3) + 0.3, slender = in->face_width / d;
  *deviation = 1e-6 * per_mm(in->mean_load) * (in->double_helical ? 0.046 : 0.023) * bracket * slender * slender;
  return EO_OK;
}

double eo_mesh_deviation(double pinion_slope, double gear_slope)
{
  return hypot(pinion_slope, gear_slope);
}

double eo_least_deviation(double mean_load, double helix_slope)
{
  return fmax(1e-6 * 0.005 * per_mm(mean_load), 0.5 * helix_slope);
}

double eo_helix_deviation(double shaft_deviation, double mesh_deviation, double b1, double b2, double least)
{
  return fmax(1.33 * b1 * shaft_deviation + b2 * mesh_deviation, least);
}

/* ISO 6336-1 clause 7, method C: B_1 and B_2 of (52). */
void eo_helix_measure_factors(enum eo_helix_measure measure, double *b1, double *b2)
{
  static const double factors[][2] = {
      [EO_HELIX_AS_IS] = {1, 1},
      [EO_HELIX_CROWNED_HALF_MESH] = {1, 0.5},
      [EO_HELIX_CROWNED_HALF_BOTH] = {0.5, 0.5},
      [EO_HELIX_CORRECTED] = {0.1, 1},
      [EO_HELIX_CORRECTED_CROWNED] = {0.1, 0.5},
      [EO_HELIX_END_RELIEF] = {0.7, 0.7},
  };
  *b1 = factors[measure][0];
  *b2 = factors[measure][1];
}

double eo_face_load_factor(double effective_deviation, double mesh_stiffness, double mean_load)
{
  double ratio = effective_deviation * mesh_stiffness / (2 * mean_load);
  return ratio < 1 ? 1 + ratio : 2 * sqrt(ratio);
}

double eo_root_face_factor(double face_load_factor, double width_over_depth)
{
  double w = fmax(width_over_depth, 3); /* (70): b/h at least 3 */
  return pow(face_load_factor, w * w / (1 + w + w * w));
}

/* (71) to (74). */
struct eo_transverse_factor eo_transverse_factor(const struct eo_transverse_input *in)
{
  double alpha = in->transverse_contact_ratio, gamma = in->total_contact_ratio;
  double deviation = fmax(in->pitch_deviation, in->profile_deviation) - in->running_in;
  double q = in->mesh_stiffness * deviation / in->line_load;
  double factor = gamma <= 2 ? gamma / 2 * (0.9 + 0.4 * q) : 0.9 + 0.4 * sqrt(2 * (gamma - 1) / gamma) * q;
  double zeps = in->contact_ratio_factor, flank_most = gamma / (alpha * zeps * zeps), /* (73) */
      root_most = gamma / (0.25 * alpha + 0.75);                                      /* (74) */
  return (struct eo_transverse_factor){.flank = fmax(1, fmin(factor, flank_most)),
                                       .root = fmax(1, fmin(factor, root_most))};
}

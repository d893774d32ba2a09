/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/iso6336.h"

#include <math.h>

static double virtual_teeth(int teeth, double normal_pressure_angle, double helix_angle)
{
  double base_helix = asin(sin(helix_angle) * cos(normal_pressure_angle));
  return teeth / (cos(base_helix) * cos(base_helix) * cos(helix_angle));
}

/* ISO 6336-1 (82): series in um mm/N; gear 1 is the one with fewer teeth. */
static double pair_flexibility(double z1, double z2, double x1, double x2)
{
  double q = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 -
             0.24188 * x2 / z2 + 0.00529 * x1 * x1 + 0.00182 * x2 * x2;
  return q * 1e-9;
}

void eo_iso_stiffness(struct eo_iso_stiffness *stiffness, const struct eo_iso_stiffness_input *input)
{
  int small = input->teeth[0] <= input->teeth[1] ? 0 : 1;
  struct eo_iso_stiffness iso_stiffness = {0};
  for (int i = 0; i < 2; i++)
    iso_stiffness.virtual_teeth[i] = input->virtual_teeth == EO_ISO_VIRTUAL_CUBED
                                         ? input->teeth[i] / pow(cos(input->helix_angle), 3)
                                         : virtual_teeth(input->teeth[i], input->normal_pressure_angle,
                                                         input->helix_angle);
  iso_stiffness.flexibility = pair_flexibility(iso_stiffness.virtual_teeth[small],
                                               iso_stiffness.virtual_teeth[1 - small], input->profile_shift[small],
                                               input->profile_shift[1 - small]);
  iso_stiffness.theoretical = 1 / iso_stiffness.flexibility;
  iso_stiffness.rack_factor = (1 + 0.5 * (1.2 - input->dedendum_coefficient)) *
                              (1 - 0.02 * (20 - input->normal_pressure_angle * 180 / M_PI));
  iso_stiffness.single = iso_stiffness.theoretical * input->theory_factor * input->blank_factor *
                         iso_stiffness.rack_factor * cos(input->helix_angle) * input->youngs_modulus / 206e9;
  iso_stiffness.mesh_alpha = iso_stiffness.single * (0.75 * input->transverse_contact_ratio + 0.25);
  iso_stiffness.mesh_beta = 0.85 * iso_stiffness.mesh_alpha;
  *stiffness = iso_stiffness;
}

double eo_iso_blank_factor(double web_ratio, double rim_ratio)
{
  double web = fmin(fmax(web_ratio, 0.2), 1.2), rim = fmax(rim_ratio, 1);
  return 1 + log(web) / (5 * exp(rim / 5));
}

/* The 30 degree tangent to the fillet: theta of ISO 6336-3 (14), by iteration. */
static double tangent_angle(double zn, double g, double h)
{
  double theta = M_PI / 6;
  for (int i = 0; i < 100; i++) {
    double next = 2 * g / zn * tan(theta) - h, step = next - theta;
    theta = next;
    if (fabs(step) < 1e-15)
      break;
  }
  return theta;
}

/* Radius, over m_n, at which the virtual spur gear is loaded at the outer point of single pair contact: d_en / 2 (ISO
   6336-3 (26)). */
static double load_radius(const struct eo_geometry *geometry, int member, double zn, double base)
{
  double module = geometry->normal_module, cos_base = cos(geometry->base_helix_angle);
  double contact_ratio = geometry->transverse_contact_ratio / (cos_base * cos_base);
  double tip = zn / 2 + (geometry->tip_form_radius[member] - geometry->reference_radius[member]) / module;
  double roll = sqrt(tip * tip - base * base) - M_PI * cos(geometry->normal_pressure_angle) * (contact_ratio - 1);
  return hypot(base, roll);
}

static double rim_factor(const struct eo_geometry *geometry, int member, double bore)
{
  double height = geometry->tip_radius[member] - geometry->root_radius[member];
  double ratio = (geometry->root_radius[member] - bore / 2) / height;
  return ratio >= 1.2 ? 1 : 1.6 * log(2.242 / ratio);
}

/* ISO 6336-3 6.2 and 7: the 30 degree tangents (9) to (14), the arm (16), Y_F (8), Y_S (32). */
void eo_iso_section(struct eo_iso_section *section, const struct eo_iso_section_input *in)
{
  double alpha = in->normal_pressure_angle, zn = in->virtual_teeth, x = in->profile_shift;
  double dedendum = in->dedendum_coefficient, fillet = in->fillet_radius_coefficient;
  double e = M_PI / 4 - dedendum * tan(alpha) - (1 - sin(alpha)) * fillet / cos(alpha);
  double g = fillet - dedendum + x;
  double h = 2 / zn * (M_PI / 2 - e) - M_PI / 3;
  double theta = tangent_angle(zn, g, h);
  section->chord = zn * sin(M_PI / 3 - theta) + sqrt(3) * (g / cos(theta) - fillet);
  section->fillet_radius = fillet + 2 * g * g / (cos(theta) * (zn * cos(theta) * cos(theta) - 2 * g));

  double pressure = acos(zn / 2 * cos(alpha) / in->load_radius);
  double gamma = (M_PI / 2 + 2 * tan(alpha) * x) / zn + eo_geometry_involute_function(alpha) -
                 eo_geometry_involute_function(pressure);
  double load_angle = pressure - gamma;
  section->load_angle = load_angle;
  section->arm = 0.5 * ((cos(gamma) - sin(gamma) * tan(load_angle)) * 2 * in->load_radius - zn * cos(M_PI / 3 - theta) -
                        (g / cos(theta) - fillet));
  section->form_factor = 6 * section->arm * cos(load_angle) / (section->chord * section->chord * cos(alpha));
  double slenderness = section->chord / section->arm, notch = section->chord / (2 * section->fillet_radius);
  section->stress_correction = (1.2 + 0.13 * slenderness) * pow(notch, 1 / (1.21 + 2.3 / slenderness));
}

void eo_iso_root(struct eo_iso_root *root, const struct eo_geometry *geometry, int member, double bore, double torque)
{
  struct eo_iso_root iso_root = {0};
  struct eo_iso_section section;
  double module = geometry->normal_module, alpha = geometry->normal_pressure_angle;
  iso_root.virtual_teeth = virtual_teeth(geometry->teeth[member], alpha, geometry->helix_angle);
  struct eo_iso_section_input input = {
      .virtual_teeth = iso_root.virtual_teeth,
      .normal_pressure_angle = alpha,
      .profile_shift = geometry->generating_shift[member],
      .dedendum_coefficient = geometry->dedendum[member] / module,
      .fillet_radius_coefficient = geometry->fillet_radius[member] / module,
      .load_radius = load_radius(geometry, member, iso_root.virtual_teeth, iso_root.virtual_teeth / 2 * cos(alpha))};
  eo_iso_section(&section, &input);
  iso_root.form_factor = section.form_factor;
  iso_root.stress_correction = section.stress_correction;
  iso_root.helix_factor = 1 - fmin(geometry->overlap_ratio, 1) * fmin(geometry->helix_angle * 180 / M_PI, 30) / 120;
  iso_root.rim_factor = rim_factor(geometry, member, bore);
  iso_root.tangential_force = torque / geometry->reference_radius[member];
  iso_root.stress = iso_root.tangential_force / (geometry->face_width * module) * iso_root.form_factor *
                    iso_root.stress_correction * iso_root.helix_factor * iso_root.rim_factor;
  iso_root.chord = section.chord * module;
  iso_root.arm = section.arm * module;
  iso_root.fillet_radius = section.fillet_radius * module;
  *root = iso_root;
}

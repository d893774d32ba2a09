#include "reference/case_pair.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "gear/modification.h"

static double either(const json_t *object, const char *a, const char *b, double fallback)
{
  double value = eo_verify_number(object, a);
  if (isnan(value))
    value = eo_verify_number(object, b);
  return isnan(value) ? fallback : value;
}

static int teeth_of(const json_t *input, int member)
{
  double z = eo_verify_element(input, "z", member);
  if (isnan(z))
    z = eo_verify_number(input, member ? "z2" : "z1");
  return z >= 1 && z < 1e5 ? (int)z : 0;
}

static double shift_of(const json_t *input, int member)
{
  double x = eo_verify_element(input, "x", member);
  if (isnan(x))
    x = eo_verify_number(input, member ? "x2" : "x1");
  if (isnan(x))
    x = eo_verify_number(input, "x");
  return isnan(x) ? 0 : x;
}

enum eo_code eo_case_design(const json_t *input, struct eo_design *design, struct eo_error *error)
{
  memset(design, 0, sizeof *design);
  eo_table_defaults(&eo_design_table, design);
  struct eo_gear_pair *pair = &design->gear_pair;
  double degree = M_PI / 180;
  design->alignment.shaft_angle_in_plane = design->alignment.shaft_angle_out_of_plane = 0;
  for (int i = 0; i < 2; i++) {
    pair->teeth[i] = teeth_of(input, i);
    pair->profile_shift[i] = shift_of(input, i);
  }
  pair->ends = 2;
  pair->normal_module = 1e-3 * eo_verify_number(input, "mn");
  pair->normal_pressure_angle = degree * either(input, "alpha_n_deg", "alpha_n", 20);
  pair->helix_angle = degree * either(input, "beta_deg", "beta", NAN);
  pair->face_width = 1e-3 * eo_verify_number(input, "b");
  pair->groove_width = 1e-3 * either(input, "groove", "groove_mm", 0);
  pair->addendum_coefficient = either(input, "ha", "ha", 1);
  pair->dedendum_coefficient = pair->addendum_coefficient + either(input, "c", "c", 0.25);
  pair->fillet_radius_coefficient = either(input, "rho_f", "rho_f", 0.38);
  pair->rim_thickness_coefficient = either(input, "rim_mn", "rim_mn", 3.5);
  design->material.youngs_modulus = 1e6 * either(input, "E", "E", 206000);
  design->material.poissons_ratio = either(input, "nu", "nu", 0.3);
  design->material.density = 1e12 * either(input, "rho_t_mm3", "rho", 7.85e-9);
  design->load_cases = 1;
  design->load_case[0] = (struct eo_load_case){.torque = 1, .speed = 1, .share = 1};
  if (pair->teeth[0] > 0 && pair->teeth[1] > 0 && pair->normal_module > 0 && pair->face_width > 0 &&
      isfinite(pair->helix_angle))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "", "A gear pair needs z, mn, beta and b.");
}

void eo_case_modification(const json_t *block, const struct eo_gear_pair *pair, struct eo_flank_modification *flank)
{
  memset(flank, 0, sizeof *flank);
  if (!block)
    return;
  double half = pair->face_width / 2 / cos(pair->helix_angle), mm = 1e-3, um = 1e-6;
  double tip = eo_verify_number(block, "d_tr"), root = eo_verify_number(block, "d_br"),
         lead = eo_verify_number(block, "a_l");
  flank->tip_relief = isnan(tip) ? um * either(block, "d_tr_um", "d_tr_um", 0) : mm * tip;
  flank->root_relief = isnan(root) ? um * either(block, "d_br_um", "d_br_um", 0) : mm * root;
  flank->tip_relief_start = mm * either(block, "u_ts", "u_ts_mm", 0);
  flank->root_relief_start = mm * either(block, "u_bs", "u_bs_mm", 0);
  flank->profile_crowning = 1e3 * either(block, "a_m", "a_m_per_mm", 0);
  flank->lead_crowning = half * half * (isnan(lead) ? 1e6 * either(block, "a_l_per_um", "a_l_per_um", 0) : 1e3 * lead);
  flank->lead_slope = half * either(block, "b_l", "b_l", 0);
  flank->lead_offset = mm * either(block, "c_l", "c_l", 0);
}

void eo_case_misalignment(const json_t *value, struct eo_alignment *alignment)
{
  const char *words = json_string_value(value);
  alignment->shaft_angle_in_plane = alignment->shaft_angle_out_of_plane = 0;
  if (words) {
    double angle = strtod(words, NULL) * M_PI / 180 * (strstr(words, "arcmin") ? 1.0 / 60 : 1);
    if (strstr(words, "in-plane") || strstr(words, "in plane"))
      alignment->shaft_angle_in_plane = angle;
    else
      alignment->shaft_angle_out_of_plane = angle;
    return;
  }
  alignment->shaft_angle_in_plane = either(value, "inplane", "in_plane", 0);
  alignment->shaft_angle_out_of_plane = either(value, "crossing", "out_of_plane", 0);
}

/* The number that follows a mark; moves *text behind it. NaN when either is missing. */
static double number_after(const char **text, const char *mark)
{
  const char *found = *text ? strstr(*text, mark) : NULL;
  char *end;
  if (!found)
    return NAN;
  double value = strtod(found + strlen(mark), &end);
  if (end == found + strlen(mark))
    return NAN;
  *text = end;
  return value;
}

bool eo_case_closed_form(const char *text, struct eo_closed_form *form)
{
  const char *at = text;
  form->compliance = 1e-3 * number_after(&at, "C(i,j) = ");
  form->length = 1e-3 * number_after(&at, "|/");
  form->linear = 1e3 * number_after(&at, "f = 1+");
  form->centre = -1e-3 * number_after(&at, "|s");
  form->quadratic = 1e6 * number_after(&at, "|+");
  return isfinite(form->compliance + form->length + form->linear + form->centre + form->quadratic) && form->length > 0;
}

int eo_case_count(const char *text, const char *phrase, int fallback)
{
  const char *found = text ? strstr(text, phrase) : NULL;
  if (!found)
    return fallback;
  while (found > text && !isdigit((unsigned char)found[-1]))
    found--;
  while (found > text && isdigit((unsigned char)found[-1]))
    found--;
  int value = atoi(found);
  return value > 0 ? value : fallback;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kind "rating": drawing dimensions and rating by ISO 6336, row by row. */
#include "reference/verify_rating.h"

#include <math.h>
#include <string.h>

double eo_row_number(struct eo_rating_row *row, const char *key)
{
  return eo_case_number(row->inputs, key);
}

double eo_row_number_or(struct eo_rating_row *row, const char *key, double missing)
{
  return eo_case_number_or(row->inputs, key, missing);
}

bool eo_row_has(struct eo_rating_row *row, const char *key)
{
  return eo_case_find(row->inputs, key) != NULL;
}

double eo_row_angle(struct eo_rating_row *row, const char *key, double missing_degrees)
{
  return eo_case_number_or(row->inputs, key, missing_degrees) * M_PI / 180;
}

void eo_row_both(struct eo_rating_row *row, const char *key, double value[2])
{
  struct eo_case *list = eo_case_need(row->inputs, key);
  if (eo_case_is_list(list) && eo_case_size(list) != 2)
    eo_case_fault(list, "Two numbers are expected here, of pinion and gear.");
  for (int i = 0; i < 2; i++)
    value[i] = eo_case_is_list(list) ? eo_case_element(list, i) : list ? eo_case_real(list) : NAN;
}

void eo_row_unused(struct eo_rating_row *row, const char *const *keys)
{
  double value[2];
  for (; *keys; keys++)
    if (eo_row_has(row, *keys))
      eo_row_both(row, *keys, value);
}

int eo_row_member(struct eo_rating_row *row)
{
  return eo_case_whole_or(row->inputs, "member", 1, 2, 1) - 1;
}

/* The formula's value as well: its inputs had more digits than the row states, and tol_abs covers that. */
void eo_row_check(struct eo_rating_row *row, const char *key, double value)
{
  eo_row_check_rounded(row, key, value, 0);
}

void eo_row_check_rounded(struct eo_rating_row *row, const char *key, double value, double rounding)
{
  struct eo_case *entry = eo_case_find(row->expected, key);
  if (!entry)
    return;
  double tolerance = eo_case_absolute_or(entry, "tol_abs", NAN);
  if (isnan(tolerance))
    eo_case_need(entry, "tol_abs");
  eo_verify_number(row->v, eo_case_need(entry, "printed"), value, 0, tolerance + rounding);
  eo_verify_number(row->v, eo_case_find(entry, "formula"), value, 0, tolerance + rounding);
}

static double tooth_number(struct eo_case *value)
{
  enum { MOST_TEETH = 1000000 };
  double teeth = eo_case_real(value);
  if (!isnan(teeth) && !(teeth >= 1 && teeth < MOST_TEETH && teeth == floor(teeth)))
    eo_case_fault(value, "Numbers of teeth are whole, from 1; internal gears are not rated.");
  return teeth;
}

void eo_row_pair(struct eo_rating_row *row, struct eo_rating_pair *pair)
{
  struct eo_case *teeth = eo_case_need(row->inputs, "teeth"), *tips = eo_case_find(row->inputs, "tip_diameter_mm");
  bool list = eo_case_is_list(teeth);
  if (list && eo_case_size(teeth) != 2)
    eo_case_fault(teeth, "Two numbers are expected here, of pinion and gear.");
  for (int i = 0; i < 2; i++) {
    double number = teeth ? tooth_number(list ? eo_case_at(teeth, i) : teeth) : NAN;
    pair->teeth[i] = number >= 1 && number < 1e6 ? (int)number : 1;
    pair->tip_diameter[i] = !tips ? NAN : (eo_case_is_list(tips) ? eo_case_element(tips, i) : eo_case_real(tips)) / 1e3;
  }
  pair->normal_module = eo_row_number(row, "normal_module_mm") / 1e3;
  pair->normal_pressure_angle = eo_row_angle(row, "normal_pressure_angle_deg", 20);
  pair->helix_angle = eo_row_angle(row, "helix_angle_deg", 0);
  pair->face_width = eo_row_number_or(row, "face_width_mm", 1000) / 1e3;
  pair->centre_distance = eo_row_number_or(row, "centre_distance_mm", NAN) / 1e3;
  if (pair->normal_module <= 0)
    eo_case_fault(eo_case_find(row->inputs, "normal_module_mm"), "A number above 0 is expected here.");
  if (fabs(pair->helix_angle) >= M_PI / 2 || pair->normal_pressure_angle <= 0)
    eo_case_fault(row->inputs, "Angles are expected in degrees: pressure above 0, helix below 90.");
}

static const struct {
  const char *quantity;
  eo_row_function *run;
} quantities[] = {
    {"pair geometry", eo_row_geometry},
    {"mesh stiffness", eo_row_stiffness},
    {"reduced mass", eo_row_mass},
    {"dynamic factor", eo_row_dynamic},
    {"transverse factor", eo_row_transverse},
    {"face load factor of the root", eo_row_root_face},
    {"face load factor", eo_row_face},
    {"contact stress", eo_row_contact},
    {"permissible contact stress", eo_row_flank_strength},
    {"root stress", eo_row_root},
    {"permissible root stress", eo_row_root_strength},
    {"life factor", eo_row_life},
    {"cumulative damage", eo_row_damage},
    {"service life", eo_row_service_life},
    {"tooth thickness", eo_row_thickness},
    {"tooth thickness allowance", eo_row_allowance},
    {"backlash", eo_row_backlash},
    {"flank tolerances", eo_row_tolerances},
    {"material class", eo_row_material},
};

static enum eo_code check_row(void *context, struct eo_case *item, struct eo_error *error)
{
  enum { COUNT = sizeof quantities / sizeof *quantities };
  struct eo_rating_row row = {.v = context};
  const char *quantity = eo_case_word(item, "quantity");
  eo_case_word(item, "id");
  row.edition = eo_case_word(item, "edition");
  row.inputs = eo_case_need(item, "inputs");
  row.expected = eo_case_need(item, "expected");
  if (eo_case_faulty(item))
    return EO_OK;
  for (int i = 0; i < COUNT; i++)
    if (strcmp(quantity, quantities[i].quantity) == 0)
      return quantities[i].run(&row, error);
  eo_case_fault(eo_case_find(item, "quantity"), "The quantity \"%.60s\" is not computed here.", quantity);
  return EO_OK;
}

static const struct eo_verify_block blocks[] = {{"rows", EO_BLOCK_EACH, check_row}, {NULL, EO_BLOCK_INPUT, NULL}};

enum eo_code eo_verify_rating(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  return eo_verify_blocks(verification, file, blocks, verification, error);
}

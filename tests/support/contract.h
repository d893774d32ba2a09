/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of the result document that others rely on (product description, "The result document"): present, of the
   right kind and length, finite. */
#ifndef EASEOFF_TESTS_SUPPORT_CONTRACT_H
#define EASEOFF_TESTS_SUPPORT_CONTRACT_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"

static int contract_faults;

static void contract_fault(const char *where, const char *what)
{
  contract_faults++;
  printf("# %s: %s\n", where, what);
}

static void contract_number(const json_t *value, const char *path)
{
  if (!json_is_number(eo_json_find(value, path)))
    contract_fault(path, "not a number");
}

static void contract_text(const json_t *value, const char *path)
{
  if (!json_is_string(eo_json_find(value, path)))
    contract_fault(path, "not a text");
}

/* An array of numbers; length 0: any but empty. */
static void contract_column(const json_t *value, const char *path, size_t length)
{
  const json_t *array = eo_json_find(value, path);
  size_t n = json_array_size(array);
  if (!n || (length && n != length))
    contract_fault(path, "not an array of the expected length");
  for (size_t i = 0; i < n; i++)
    if (!json_is_number(json_array_get(array, i))) {
      contract_fault(path, "holds something else than numbers");
      break;
    }
}

/* format: with %s for the end. The other end of a pair with one end must not be there at all. */
static void contract_end(const json_t *value, const char *format, int ends, size_t length, bool column)
{
  for (int end = 0; end < 2; end++) {
    char path[200], *mark;
    const char *word = end ? "right" : "left";
    snprintf(path, sizeof path, "%s", format);
    while ((mark = strstr(path, "%s"))) {
      char rest[200];
      snprintf(rest, sizeof rest, "%s", mark + 2);
      snprintf(mark, sizeof path - (size_t)(mark - path), "%s%s", word, rest);
    }
    if (end >= ends && eo_json_find(value, path))
      contract_fault(path, "is there although the pair has one end");
    else if (end < ends && column)
      contract_column(value, path, length);
    else if (end < ends)
      contract_number(value, path);
  }
}

static void contract_case(const json_t *load_case, int ends, bool root)
{
  size_t n = json_array_size(eo_json_find(load_case, "position"));
  static const char *const numbers[] = {"torque_Nm",
                                        "speed_rpm",
                                        "share",
                                        "lte/peak_to_peak_um",
                                        "lte/mean_um",
                                        "vibration/rms_m_per_s2/normal",
                                        "vibration/rms_m_per_s2/transverse",
                                        "vibration/rms_m_per_s2/rotational",
                                        "vibration/contact_loss",
                                        "vibration/dynamic_factor"};
  static const char *const end_numbers[] = {
      "contact/max_pressure_MPa/%s", "contact/max_line_load_N_per_mm/%s", "contact/edge_load_share/%s",
      "impact/%s/force_N",           "impact/%s/general_force_N",         "impact/%s/speed_mm_per_s",
      "impact/%s/duration_ms",       "vibration/%s/rms_m_per_s2/normal",  "vibration/%s/dynamic_factor",
      "vibration/%s/contact_loss",   "mesh_stiffness/mean/%s_N_per_um"};
  static const char *const columns[] = {"lte/%s_um", "mesh_stiffness/%s_N_per_um",
                                        "mesh_stiffness/tangent_%s_N_per_um"};
  static const char *const histories[] = {"deflection_um",       "mesh_force_N",        "normal_m_per_s2",
                                          "transverse_m_per_s2", "rotational_m_per_s2", "pinion_bearing_N",
                                          "gear_bearing_N"};
  contract_text(load_case, "outcome");
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    contract_number(load_case, numbers[i]);
  for (size_t i = 0; i < sizeof end_numbers / sizeof *end_numbers; i++)
    contract_end(load_case, end_numbers[i], ends, 0, false);
  contract_column(load_case, "lte/pair_um", n);
  contract_column(load_case, "lte/orders_um", 0);
  contract_column(load_case, "vibration/orders_normal_m_per_s2", 0);
  contract_column(load_case, "vibration/rms_band_m_per_s2/normal", 2);
  for (size_t i = 0; i < sizeof columns / sizeof *columns; i++)
    contract_end(load_case, columns[i], ends, n, true);
  for (size_t i = 0; i < sizeof histories / sizeof *histories; i++) {
    char path[100];
    snprintf(path, sizeof path, "vibration/%%s/history/%s", histories[i]);
    contract_end(load_case, path, ends, json_array_size(eo_json_find(load_case, "vibration/position")), true);
    snprintf(path, sizeof path, "vibration/%%s/orders/%s", histories[i]);
    contract_end(load_case, path, ends, 0, true);
  }
  if (json_array_size(eo_json_find(load_case, "contact/pattern/left/pressure_MPa")) !=
      json_array_size(eo_json_find(load_case, "contact/pattern/s_mm")))
    contract_fault("contact/pattern", "has not one row per s_mm");
  if (json_array_size(eo_json_find(load_case, "contact/load_share/left")) !=
      json_array_size(eo_json_find(load_case, "contact/load_share/tooth_pair")))
    contract_fault("contact/load_share", "has not one row per tooth pair");
  for (int member = 0; member < 2 && root; member++) {
    contract_number(load_case, member ? "root_stress/gear/max_MPa" : "root_stress/pinion/max_MPa");
    contract_number(load_case, member ? "root_stress/gear/max_dynamic_MPa" : "root_stress/pinion/max_dynamic_MPa");
    contract_column(load_case, member ? "root_stress/gear/history_MPa" : "root_stress/pinion/history_MPa",
                    json_array_size(eo_json_find(load_case, "root_stress/gear/position")));
  }
}

/* Returns the number of faults, each printed as a comment. root: with finite elements, so that root stresses are there.
 */
static int contract_check(const json_t *result, int ends, bool root)
{
  static const char *const numbers[] = {"geometry/transverse_contact_ratio",
                                        "geometry/overlap_ratio",
                                        "objectives/f1_um",
                                        "objectives/f2_N",
                                        "objectives/f3_m_per_s2",
                                        "objectives/J",
                                        "objectives/fitness",
                                        "objectives/violation",
                                        "objectives/unmodified/f1_um",
                                        "objectives/unmodified/f2_N",
                                        "objectives/unmodified/f3_m_per_s2",
                                        "resolution/positions",
                                        "timing_ms/preparation",
                                        "timing_ms/static",
                                        "timing_ms/dynamics"};
  const json_t *cases = eo_json_find(result, "load_cases");
  contract_faults = 0;
  contract_text(result, "program");
  contract_text(result, "design_hash");
  contract_text(result, "evaluation_hash");
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    contract_number(result, numbers[i]);
  contract_column(result, "geometry/base_radius_mm", 2);
  contract_column(result, "eigenfrequencies_Hz", 0);
  contract_column(result, "damping_ratios", json_array_size(eo_json_find(result, "eigenfrequencies_Hz")));
  contract_end(result, "modification/pinion/%s/lead_crowning_per_um", ends, 0, false);
  if (!json_is_array(eo_json_find(result, "warnings")))
    contract_fault("warnings", "not an array");
  if (!json_array_size(cases) ||
      json_array_size(cases) != json_array_size(eo_json_find(result, "objectives/unmodified/load_cases")))
    contract_fault("load_cases", "not one for each of the duty cycle");
  for (size_t k = 0; k < json_array_size(cases); k++)
    contract_case(json_array_get(cases, k), ends, root);
  return contract_faults;
}

#endif

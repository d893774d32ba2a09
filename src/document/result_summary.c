/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result for people at a terminal. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "document/result.h"
#include "format/inch_sentence.h"
#include "format/text_table.h"

static double find(const json_t *value, const char *path)
{
  return eo_json_find_number(value, path);
}

static const char *find_text(const json_t *value, const char *path)
{
  const char *text = json_string_value(eo_json_find(value, path));
  return text ? text : "";
}

/* How lengths are shown. */
struct shown_lengths {
  const char *length, *small; /* units in place of mm and um */
  double divisor;
  void (*say)(struct eo_text *text, const char *sentence);
};
static const struct shown_lengths shown[2] = {{"mm", "um", 1, eo_text_add}, {"in", "thou", 25.4, eo_inch_sentence}};

/* "2 x 55", "55 + 48", and in brackets the members' own faces where they differ from what they share. */
static void print_faces(const json_t *pair, const json_t *geometry, const struct shown_lengths *as,
                        struct eo_text *text)
{
  double face = find(pair, "face_width_mm") / as->divisor, right = find(pair, "right_face_width_mm") / as->divisor;
  const json_t *own = json_object_get(geometry, "member_face_width_mm");
  double pinion = json_number_value(json_array_get(own, 0)) / as->divisor,
         gear = json_number_value(json_array_get(own, 1)) / as->divisor;
  if (right > 0)
    eo_text_print(text, "%.6g + %.6g", face, right);
  else
    eo_text_print(text, "%s%.6g", find(pair, "ends") == 2 ? "2 x " : "", face);
  if (own && fmax(pinion, gear) > face)
    eo_text_print(text, " (%.6g/%.6g)", pinion, gear);
}

/* Of the pinion. */
static void print_hand(const json_t *pair, struct eo_text *text)
{
  const char *hand = find_text(pair, "hand");
  if (find(pair, "right_helix_angle_deg") > 0)
    eo_text_print(text, " + %.6g deg", find(pair, "right_helix_angle_deg"));
  if (*hand)
    eo_text_print(text, find(pair, "ends") == 2 ? " (left end %s-handed)" : " (%s-handed)", hand);
  eo_text_add(text, ", face ");
}

static void print_pair(const json_t *result, const struct shown_lengths *as, struct eo_text *text)
{
  const json_t *pair = eo_json_find(result, "design/gear_pair"), *geometry = json_object_get(result, "geometry");
  char name[200];
  eo_text_clean(name, sizeof name, find_text(result, "design/name"));
  eo_text_print(text, "%s%s", name, *name ? "\n" : "");
  eo_text_print(text, "  %.0f/%.0f teeth, m_n %.6g %s, beta %.6g deg", find(pair, "pinion_teeth"),
                find(pair, "gear_teeth"), find(pair, "normal_module_mm") / as->divisor, as->length,
                find(pair, "helix_angle_deg"));
  print_hand(pair, text);
  print_faces(pair, geometry, as, text);
  eo_text_print(text, " %s, a %.7g %s, eps_alpha %.4g, eps_beta %.4g\n", as->length,
                find(geometry, "centre_distance_mm") / as->divisor, as->length,
                find(geometry, "transverse_contact_ratio"), find(geometry, "overlap_ratio"));
  eo_text_print(text, "  shaft angle error %.4g deg in plane, %.4g deg out of plane; pinion axially %s\n",
                find(result, "design/alignment/shaft_angle_error_in_plane_deg"),
                find(result, "design/alignment/shaft_angle_error_out_of_plane_deg"),
                find_text(result, "design/alignment/pinion_axial"));
  eo_text_print(text, "  design %.16s, %.0f mesh positions, %.0f cells per line, mesh law %s\n\n",
                find_text(result, "design_hash"), find(result, "resolution/positions"),
                find(result, "resolution/cells_per_line"), find_text(result, "resolution/mesh_law"));
}

static void add_change(struct eo_text_table *sheet, double before, double after)
{
  char change[40] = "";
  double percent = 100 * (after / before - 1);
  if (isfinite(percent))
    snprintf(change, sizeof change, "%+.*f %%", fabs(percent) < 9.95 ? 1 : 0, percent);
  eo_text_table_string(sheet, change);
}

static void add_row(struct eo_text_table *sheet, const char *quantity, const char *unit, double before, double after,
                    double scale)
{
  eo_text_table_string(sheet, quantity);
  eo_text_table_string(sheet, unit);
  eo_text_table_number(sheet, before * scale, NULL, 4);
  eo_text_table_number(sheet, after * scale, NULL, 4);
  add_change(sheet, before, after);
}

/* What stands on the same line as a load case's vibration: where it goes within +-10 % compliance. */
static void print_band(const json_t *load_case, struct eo_text *text)
{
  const json_t *band = eo_json_find(load_case, "vibration/rms_band_m_per_s2/normal");
  double low = json_number_value(json_array_get(band, 0)), high = json_number_value(json_array_get(band, 1));
  if (json_is_number(json_array_get(band, 0)))
    eo_text_print(text,
                  "  (vibration %.4g .. %.4g m/s2 over +-10 %% compliance; rotational %.4g, transverse %.4g m/s2)\n",
                  low, high, find(load_case, "vibration/rms_m_per_s2/rotational"),
                  find(load_case, "vibration/rms_m_per_s2/transverse"));
}

static const struct quantity {
  const char *name, *unit, *key;
  double scale;
} quantities[] = {
    {"peak-to-peak loaded TE", "um", "peak_to_peak_um", 1}, {"entering impact", "N", "impact_N", 1},
    {"vibration, RMS normal", "m/s2", "rms_m_per_s2", 1},   {"contact pressure", "MPa", "contact_pressure_MPa", 1},
    {"root stress", "MPa", "root_stress_MPa", 1},           {"load on tip edges", "%", "edge_load_share", 100},
};

static void start_table(struct eo_text_table *sheet)
{
  static const char *const headings[] = {"", "", "unmodified", "design", "change"};
  eo_text_table_init(sheet, 5, headings);
}

/* Nothing without a helix, which has no axial force. */
static void print_axial(const json_t *axial, struct eo_text *text)
{
  const char *first = find_text(axial, "meets_first");
  double right = find(axial, "pinion_right_N");
  if (!*first)
    return;
  eo_text_print(text, "  the pinion turns %s seen from its left end, the %s face%s first; axial force on it ",
                find_text(axial, "pinion_rotation"), first, isnan(right) ? " meets" : " ends meet");
  if (isnan(right))
    eo_text_print(text, "%+.5g N (+ to the right)\n", find(axial, "pinion_left_N"));
  else
    eo_text_print(text, "%+.5g and %+.5g N (left, right end; + to the right)\n", find(axial, "pinion_left_N"), right);
}

static void print_case(const json_t *result, size_t k, const struct shown_lengths *as, struct eo_text *text)
{
  const json_t *load_case = json_array_get(json_object_get(result, "load_cases"), k);
  const json_t *after = json_array_get(eo_json_find(result, "objectives/load_cases"), k);
  const json_t *before = json_array_get(eo_json_find(result, "objectives/unmodified/load_cases"), k);
  struct eo_text_table sheet;
  eo_text_print(text, "%.6g N m, %.6g rpm, share %.4g: %s\n", find(load_case, "torque_Nm"),
                find(load_case, "speed_rpm"), find(load_case, "share"), find_text(load_case, "outcome"));
  print_axial(json_object_get(load_case, "axial"), text);
  start_table(&sheet);
  for (size_t i = 0; i < sizeof quantities / sizeof *quantities; i++) {
    const struct quantity *quantity = &quantities[i];
    if (isfinite(find(after, quantity->key)))
      add_row(&sheet, quantity->name, *quantity->unit == 'u' ? as->small : quantity->unit, find(before, quantity->key),
              find(after, quantity->key), *quantity->unit == 'u' ? quantity->scale / as->divisor : quantity->scale);
  }
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  print_band(load_case, text);
  eo_text_add(text, "\n");
}

static void print_objectives(const json_t *result, const struct shown_lengths *as, struct eo_text *text)
{
  const json_t *after = json_object_get(result, "objectives"), *before = json_object_get(after, "unmodified");
  double violation = find(after, "violation");
  struct eo_text_table sheet;
  eo_text_add(text, "Objectives\n");
  start_table(&sheet);
  add_row(&sheet, "f1", as->small, find(before, "f1_um"), find(after, "f1_um"), 1 / as->divisor);
  add_row(&sheet, "f2", "N", find(before, "f2_N"), find(after, "f2_N"), 1);
  add_row(&sheet, "f3", "m/s2", find(before, "f3_m_per_s2"), find(after, "f3_m_per_s2"), 1);
  add_row(&sheet, "J", "", find(before, "J"), find(after, "J"), 1);
  add_row(&sheet, "fitness", "", find(before, "fitness"), find(after, "fitness"), 1);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  if (violation > 0)
    eo_text_print(text, "  Constraints are violated by %.4g in sum.\n", violation);
  eo_text_add(text, "\n");
}

static void add_safety(struct eo_text_table *sheet, const char *name, double value, double least, double fixed)
{
  eo_text_table_string(sheet, name);
  eo_text_table_number(sheet, value, NULL, 4);
  eo_text_table_number(sheet, least, NULL, 4);
  eo_text_table_number(sheet, fixed, NULL, 4);
}

/* Nothing where no rating was asked for. */
static void print_rating(const json_t *result, const struct shown_lengths *as, struct eo_text *text)
{
  static const char *const headings[] = {"", "Miner", "required", "static"};
  const json_t *rating = json_object_get(result, "rating"), *verdict = json_object_get(rating, "verdict");
  struct eo_text_table sheet;
  if (!json_is_object(rating))
    return;
  eo_text_print(text, "Rating, ISO 6336:%s: ", find_text(rating, "settings/edition"));
  if (!json_is_boolean(json_object_get(verdict, "passes"))) {
    eo_text_add(text, "not rated. ");
    as->say(text, find_text(rating, "reason"));
    eo_text_add(text, "\n\n");
    return;
  }
  eo_text_print(text, "%s over %.6g h\n",
                json_is_true(json_object_get(verdict, "passes")) ? "every safety reaches its minimum"
                                                                 : "a safety does NOT reach its minimum",
                find(verdict, "required_life_h"));
  eo_text_table_init(&sheet, 4, headings);
  add_safety(&sheet, "flank, least S_H", find(verdict, "S_H"), find(verdict, "S_Hmin"), find(verdict, "S_H_static"));
  add_safety(&sheet, "root, least S_F", find(verdict, "S_F"), find(verdict, "S_Fmin"), find(verdict, "S_F_static"));
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_print(text, "  %zu points are unchecked; easeoff report lists them.\n\n",
                json_array_size(json_object_get(rating, "unchecked")));
}

static void print_place(const json_t *place, struct eo_text *text)
{
  eo_text_print(text, "%s end, cycle %.0f, tooth %.0f of the pinion and %.0f of the gear\n", find_text(place, "end"),
                find(place, "cycle"), find(place, "pinion_tooth"), find(place, "gear_tooth"));
}

static void print_pitch_case(const json_t *load_case, const struct shown_lengths *as, struct eo_text *text)
{
  char lte[16];
  const char *const headings[] = {"order", "per turn", lte, "normal, m/s2", "rotational, m/s2"};
  const json_t *orders = json_object_get(load_case, "orders"), *row;
  struct eo_text_table sheet;
  size_t i;
  snprintf(lte, sizeof lte, "LTE, %s", as->small);
  eo_text_print(text, "  %.6g N m: LTE mean %.5g %s, peak to peak %.5g %s, within a cycle %.3g to %.3g %s\n",
                find(load_case, "torque_Nm"), find(load_case, "lte/mean_um") / as->divisor, as->small,
                find(load_case, "lte/peak_to_peak_um") / as->divisor, as->small,
                find(load_case, "lte/peak_to_peak_of_one_cycle_um/least_um") / as->divisor,
                find(load_case, "lte/peak_to_peak_of_one_cycle_um/most_um") / as->divisor, as->small);
  eo_text_print(text, "    vibration %.4g m/s2 normal, %.4g rotational: %s\n",
                find(load_case, "vibration/rms_m_per_s2/normal"), find(load_case, "vibration/rms_m_per_s2/rotational"),
                find_text(load_case, "vibration/outcome"));
  eo_text_print(text, "    largest load %.5g N, %.3g of the end's: ", find(load_case, "largest/load/load_N"),
                find(load_case, "largest/load/share_of_end"));
  print_place(eo_json_find(load_case, "largest/load"), text);
  eo_text_print(text, "    largest pressure %.5g MPa: ", find(load_case, "largest/pressure/pressure_MPa"));
  print_place(eo_json_find(load_case, "largest/pressure"), text);
  if (json_is_object(eo_json_find(load_case, "largest/root_stress")))
    eo_text_print(text, "    largest root stress: pinion %.4g MPa on tooth %.0f, gear %.4g MPa on tooth %.0f\n",
                  find(load_case, "largest/root_stress/pinion/stress_MPa"),
                  find(load_case, "largest/root_stress/pinion/pinion_tooth"),
                  find(load_case, "largest/root_stress/gear/stress_MPa"),
                  find(load_case, "largest/root_stress/gear/gear_tooth"));
  eo_text_table_init(&sheet, 5, headings);
  json_array_foreach(orders, i, row)
  {
    const char *name = find_text(row, "name");
    if (strchr(name, '-') || strchr(name, '+'))
      continue;
    eo_text_table_string(&sheet, name);
    eo_text_table_number(&sheet, find(row, "order_per_pinion_revolution"), NULL, 5);
    eo_text_table_number(&sheet, find(row, "lte_um") / as->divisor, NULL, 4);
    eo_text_table_number(&sheet, find(row, "normal_m_per_s2"), NULL, 4);
    eo_text_table_number(&sheet, find(row, "rotational_m_per_s2"), NULL, 4);
  }
  eo_text_table_print(&sheet, 4, text);
  eo_text_table_done(&sheet);
}

/* Nothing where the design states no single teeth. */
static void print_pitch(const json_t *result, const struct shown_lengths *as, struct eo_text *text)
{
  const json_t *pitch = json_object_get(result, "pitch"), *load_case;
  size_t k;
  if (!json_is_object(pitch))
    return;
  eo_text_print(text, "Single teeth: %.0f mesh cycles, %.0f turns of the pinion, %.0f of the gear\n",
                find(pitch, "cycles"), find(pitch, "pinion_revolutions"), find(pitch, "gear_revolutions"));
  json_array_foreach(json_object_get(pitch, "load_cases"), k, load_case) print_pitch_case(load_case, as, text);
  eo_text_add(text, "\n");
}

static void print_frequencies(const json_t *result, struct eo_text *text)
{
  const json_t *frequencies = json_object_get(result, "eigenfrequencies_Hz");
  if (!json_array_size(frequencies))
    return;
  eo_text_add(text, "Eigenfrequencies, Hz:");
  for (size_t i = 0; i < json_array_size(frequencies); i++)
    eo_text_print(text, " %.5g", json_number_value(json_array_get(frequencies, i)));
  eo_text_add(text, "\n");
}

static void print_warnings(const json_t *result, const struct shown_lengths *as, struct eo_text *text)
{
  const json_t *warnings = json_object_get(result, "warnings");
  for (size_t i = 0; i < json_array_size(warnings); i++) {
    const char *sentence = json_string_value(json_array_get(warnings, i));
    eo_text_add(text, "Note: ");
    as->say(text, sentence);
    eo_text_add(text, "\n");
  }
}

static void print_timing(const json_t *result, struct eo_text *text)
{
  const json_t *timing = json_object_get(result, "timing_ms");
  const char *key;
  json_t *value;
  eo_text_add(text, "Time, ms:");
  json_object_foreach((json_t *)timing, key, value) eo_text_print(text, " %s %.3g", key, json_number_value(value));
  eo_text_add(text, "\n");
}

void eo_result_summary(const json_t *result, bool inches, struct eo_text *text)
{
  const struct shown_lengths *as = &shown[inches];
  print_pair(result, as, text);
  for (size_t k = 0; k < json_array_size(json_object_get(result, "load_cases")); k++)
    print_case(result, k, as, text);
  print_objectives(result, as, text);
  print_rating(result, as, text);
  print_pitch(result, as, text);
  print_frequencies(result, text);
  print_warnings(result, as, text);
  print_timing(result, text);
}

enum eo_code eo_result_write_csv(const struct eo_analysis *analysis, const struct eo_design *design,
                                 struct eo_text *text, struct eo_error *error)
{
  json_t *document = eo_result_encode_part(analysis, design, NULL, EO_RESULT_NO_MAPS | EO_RESULT_NO_HISTORIES);
  if (!document)
    return eo_error_memory(error);
  eo_result_summary_csv(document, text);
  json_decref(document);
  return text->failed ? eo_error_memory(error) : EO_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result's curves as files of comma-separated values. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "document/result.h"
#include "format/text_table.h"
#include "gear/names.h"

enum { MOST_COLUMNS = 64, HEADING = 64 };

/* Arrays of numbers side by side. */
struct table {
  int columns;
  char heading[MOST_COLUMNS][HEADING];
  const json_t *column[MOST_COLUMNS];
};

/* An array that is missing (the right end of a pair with one end) is left out. */
static void add_column(struct table *table, const json_t *array, const char *heading)
{
  if (!json_is_array(array) || table->columns == MOST_COLUMNS)
    return;
  snprintf(table->heading[table->columns], HEADING, "%s", heading);
  table->column[table->columns++] = array;
}

static void add_cell(struct eo_text_table *sheet, const json_t *value)
{
  if (json_is_string(value))
    eo_text_table_string(sheet, json_string_value(value));
  else
    eo_text_table_number(sheet, json_is_number(value) ? json_number_value(value) : NAN, NULL, 0);
}

static void save_table(const struct table *table, struct eo_text *text)
{
  const char *heading[MOST_COLUMNS] = {NULL};
  struct eo_text_table sheet;
  size_t rows = 0;
  if (!text || !table->columns)
    return;
  for (int j = 0; j < table->columns; j++) {
    heading[j] = table->heading[j];
    rows = json_array_size(table->column[j]) > rows ? json_array_size(table->column[j]) : rows;
  }
  eo_text_table_init(&sheet, table->columns, heading);
  for (size_t i = 0; i < rows; i++)
    for (int j = 0; j < table->columns; j++)
      add_cell(&sheet, json_array_get(table->column[j], i));
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

/* Columns of both ends: "%s" in heading and path stands for the end. */
static void add_ends(struct table *table, const json_t *value, const char *heading, const char *path)
{
  for (int end = 0; end < 2; end++) {
    char at[128], name[HEADING];
    const char *word = eo_end_name[end], *place = strstr(path, "%s"), *mark = strstr(heading, "%s");
    snprintf(at, sizeof at, "%.*s%s%s", (int)(place - path), path, word, place + 2);
    snprintf(name, sizeof name, "%.*s%s%s", (int)(mark - heading), heading, word, mark + 2);
    add_column(table, eo_json_find(value, at), name);
  }
}

static void save_curves(const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  const json_t *pairs = eo_json_find(load_case, "contact/load_share/tooth_pair");
  add_column(&table, eo_json_find(load_case, "position"), "position");
  add_column(&table, eo_json_find(load_case, "lte/pair_um"), "lte_pair_um");
  add_ends(&table, load_case, "lte_%s_um", "lte/%s_um");
  add_column(&table, eo_json_find(load_case, "lte/axial_float_um"), "axial_float_um");
  add_ends(&table, load_case, "mesh_stiffness_%s_N_per_um", "mesh_stiffness/%s_N_per_um");
  add_ends(&table, load_case, "tangent_stiffness_%s_N_per_um", "mesh_stiffness/tangent_%s_N_per_um");
  for (int end = 0; end < 2; end++)
    for (size_t i = 0; i < json_array_size(pairs); i++) {
      char heading[HEADING];
      const char *word = eo_end_name[end];
      snprintf(heading, sizeof heading, "load_share_%s_pair_%d", word,
               (int)json_integer_value(json_array_get(pairs, i)));
      add_column(&table, json_array_get(json_object_get(eo_json_find(load_case, "contact/load_share"), word), i),
                 heading);
    }
  save_table(&table, text);
}

static void save_root(const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  add_column(&table, eo_json_find(load_case, "root_stress/pinion/position"), "position");
  add_ends(&table, load_case, "pinion_%s_MPa", "root_stress/pinion/%s/history_MPa");
  add_ends(&table, load_case, "gear_%s_MPa", "root_stress/gear/%s/history_MPa");
  save_table(&table, text);
}

/* Every channel of the history or of the orders, both ends. */
static void add_channels(struct table *table, const json_t *load_case, const char *kind)
{
  const char *key;
  json_t *value;
  for (int end = 0; end < 2; end++) {
    char path[64];
    snprintf(path, sizeof path, "vibration/%s/%s", eo_end_name[end], kind);
    json_object_foreach((json_t *)eo_json_find(load_case, path), key, value)
    {
      char heading[HEADING];
      snprintf(heading, sizeof heading, "%s_%s", eo_end_name[end], key);
      add_column(table, value, heading);
    }
  }
}

static void save_vibration(const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  add_column(&table, eo_json_find(load_case, "vibration/position"), "position");
  add_channels(&table, load_case, "history");
  save_table(&table, text);
}

static void save_orders(const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  json_t *order = json_array();
  const json_t *lte = eo_json_find(load_case, "lte/orders_um"),
               *vibration = eo_json_find(load_case, "vibration/left/orders/normal_m_per_s2");
  size_t n = json_array_size(lte) > json_array_size(vibration) ? json_array_size(lte) : json_array_size(vibration);
  for (size_t i = 0; i < n && text; i++)
    text->failed = text->failed || json_array_append_new(order, json_integer((json_int_t)i)) != 0;
  add_column(&table, order, "mesh_order");
  add_column(&table, lte, "lte_pair_um");
  add_channels(&table, load_case, "orders");
  save_table(&table, text);
  json_decref(order);
}

static void save_pattern(const json_t *result, const json_t *load_case, const char *end, struct eo_text *text)
{
  static const char *const heading[] = {"s_mm", "eta_mm", "pressure_MPa", "unloaded_clearance_um"};
  const json_t *pattern = eo_json_find(load_case, "contact/pattern"), *value = json_object_get(pattern, "s_mm"),
               *eta = json_object_get(pattern, "eta_mm");
  const json_t *pressure = json_object_get(json_object_get(pattern, end), "pressure_MPa");
  const json_t *clearance = json_object_get(json_object_get(json_object_get(result, "unloaded_contact"), end),
                                            "clearance_um");
  struct eo_text_table sheet;
  if (!text)
    return;
  eo_text_table_init(&sheet, 4, heading);
  for (size_t i = 0; i < json_array_size(value); i++)
    for (size_t j = 0; j < json_array_size(eta); j++) {
      add_cell(&sheet, json_array_get(value, i));
      add_cell(&sheet, json_array_get(eta, j));
      add_cell(&sheet, json_array_get(json_array_get(pressure, i), j));
      add_cell(&sheet, json_array_get(json_array_get(clearance, i), j));
    }
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

static void save_modification(const json_t *result, struct eo_text *text)
{
  struct table table = {0};
  const json_t *modification = json_object_get(result, "modification");
  for (int i = 0; i < 2; i++) {
    char heading[HEADING], path[64];
    snprintf(heading, sizeof heading, "%s_u_mm", eo_member_name[i]);
    snprintf(path, sizeof path, "%s/u_mm", eo_member_name[i]);
    add_column(&table, eo_json_find(modification, path), heading);
    snprintf(heading, sizeof heading, "%s_%%s_profile_um", eo_member_name[i]);
    snprintf(path, sizeof path, "%s/%%s/profile_um", eo_member_name[i]);
    add_ends(&table, modification, heading, path);
  }
  add_column(&table, json_object_get(modification, "eta_mm"), "eta_mm");
  add_ends(&table, modification, "pinion_%s_lead_um", "pinion/%s/lead_um");
  add_ends(&table, modification, "gear_%s_lead_um", "gear/%s/lead_um");
  save_table(&table, text);
}

static void save_unloaded(const json_t *result, struct eo_text *text)
{
  struct table table = {0};
  const json_t *unloaded = json_object_get(result, "unloaded_contact");
  add_column(&table, json_object_get(unloaded, "position"), "position");
  add_column(&table, json_object_get(unloaded, "pair_te_um"), "te_pair_um");
  add_ends(&table, unloaded, "te_%s_um", "%s/te_um");
  save_table(&table, text);
}

/* One line per load case: what stands in "objectives", before and after, and what it is in. */
static void save_summary(const json_t *result, struct eo_text *text)
{
  static const char *const design[] = {
      "peak_to_peak_um", "impact_N",        "rms_m_per_s2",         "contact_pressure_MPa",
      "root_stress_MPa", "edge_load_share", "contact_loss",         "flank_safety",
      "root_safety",     "film_ratio",      "contact_temperature_C"};
  enum { VALUES = sizeof design / sizeof *design, COLUMNS = 5 + 2 * VALUES };
  const char *heading[COLUMNS] = {"load_case", "torque_Nm", "speed_rpm", "share", "outcome"};
  char before[VALUES][HEADING];
  const json_t *cases = json_object_get(result, "load_cases");
  struct eo_text_table sheet;
  if (!text)
    return;
  for (int i = 0; i < VALUES; i++) {
    snprintf(before[i], HEADING, "unmodified_%s", design[i]);
    heading[5 + i] = design[i];
    heading[5 + VALUES + i] = before[i];
  }
  eo_text_table_init(&sheet, COLUMNS, heading);
  for (size_t k = 0; k < json_array_size(cases); k++) {
    const json_t *load_case = json_array_get(cases, k),
                 *values = json_array_get(eo_json_find(result, "objectives/load_cases"), k);
    const json_t *unmodified = json_array_get(eo_json_find(result, "objectives/unmodified/load_cases"), k);
    eo_text_table_number(&sheet, (double)(k + 1), NULL, 0);
    for (int i = 1; i < 5; i++)
      add_cell(&sheet, json_object_get(load_case, heading[i]));
    for (int i = 0; i < 2 * VALUES; i++)
      add_cell(&sheet, json_object_get(i < VALUES ? values : unmodified, design[i % VALUES]));
  }
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

void eo_result_summary_csv(const json_t *result, struct eo_text *text)
{
  save_summary(result, text);
}

/* i times step, as many as the column has. */
static json_t *steps(size_t count, double step, struct eo_text *text)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count && text; i++)
    text->failed = text->failed || json_array_append_new(list, json_real((double)i * step)) != 0;
  return list;
}

/* The transmission error over the hunting period. */
static void save_period(const json_t *pitch, const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  const json_t *curve = eo_json_find(load_case, "lte/pair_um");
  size_t count = json_array_size(curve);
  json_t *turns = steps(count, eo_json_find_number(pitch, "pinion_revolutions") / (double)(count ? count : 1), text);
  add_column(&table, turns, "pinion_revolutions");
  add_column(&table, curve, "lte_pair_um");
  save_table(&table, text);
  json_decref(turns);
}

static void save_period_orders(const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  const json_t *spectrum = json_object_get(load_case, "spectrum"), *lines = json_object_get(spectrum, "lte_um");
  json_t *order = steps(json_array_size(lines), eo_json_find_number(spectrum, "step"), text);
  add_column(&table, order, "order_per_pinion_revolution");
  add_column(&table, lines, "lte_pair_um");
  add_column(&table, json_object_get(spectrum, "normal_m_per_s2"), "normal_m_per_s2");
  add_column(&table, json_object_get(spectrum, "rotational_m_per_s2"), "rotational_m_per_s2");
  save_table(&table, text);
  json_decref(order);
}

/* Tooth by tooth: what it is off on drive flanks, and what it carries. */
static void save_teeth(const json_t *pitch, const json_t *load_case, struct eo_text *text)
{
  struct table table = {0};
  size_t most = 0;
  for (int i = 0; i < 2; i++) {
    char path[64];
    snprintf(path, sizeof path, "teeth/%s/left/load_N", eo_member_name[i]);
    size_t own = json_array_size(eo_json_find(load_case, path));
    most = own > most ? own : most;
  }
  json_t *tooth = steps(most, 1, text);
  add_column(&table, tooth, "tooth");
  for (int i = 0; i < 2; i++) {
    char heading[HEADING], path[96];
    snprintf(heading, sizeof heading, "%s_%%s_index_um", eo_member_name[i]);
    snprintf(path, sizeof path, "deviations/%s/%%s/drive/index_um", eo_member_name[i]);
    add_ends(&table, pitch, heading, path);
    snprintf(heading, sizeof heading, "%s_%%s_load_N", eo_member_name[i]);
    snprintf(path, sizeof path, "teeth/%s/%%s/load_N", eo_member_name[i]);
    add_ends(&table, load_case, heading, path);
    snprintf(heading, sizeof heading, "%s_%%s_root_stress_MPa", eo_member_name[i]);
    snprintf(path, sizeof path, "teeth/%s/%%s/root_stress_MPa", eo_member_name[i]);
    add_ends(&table, load_case, heading, path);
  }
  save_table(&table, text);
  json_decref(tooth);
}

static void save_pitch(const json_t *result, struct eo_file_set *bundle)
{
  const json_t *pitch = json_object_get(result, "pitch"), *load_case;
  size_t k;
  json_array_foreach(json_object_get(pitch, "load_cases"), k, load_case)
  {
    save_period(pitch, load_case, eo_file_set_add(bundle, "case-%d-period.csv", (int)k + 1));
    save_period_orders(load_case, eo_file_set_add(bundle, "case-%d-period-orders.csv", (int)k + 1));
    save_teeth(pitch, load_case, eo_file_set_add(bundle, "case-%d-teeth.csv", (int)k + 1));
  }
}

void eo_result_files(const json_t *result, struct eo_file_set *bundle)
{
  const json_t *cases = json_object_get(result, "load_cases");
  save_summary(result, eo_file_set_add(bundle, "summary.csv"));
  save_modification(result, eo_file_set_add(bundle, "modification.csv"));
  save_unloaded(result, eo_file_set_add(bundle, "unloaded.csv"));
  save_pitch(result, bundle);
  for (size_t k = 0; k < json_array_size(cases); k++) {
    const json_t *load_case = json_array_get(cases, k);
    int number = (int)k + 1;
    save_curves(load_case, eo_file_set_add(bundle, "case-%d-curves.csv", number));
    save_vibration(load_case, eo_file_set_add(bundle, "case-%d-vibration.csv", number));
    save_orders(load_case, eo_file_set_add(bundle, "case-%d-orders.csv", number));
    if (json_is_object(json_object_get(load_case, "root_stress")))
      save_root(load_case, eo_file_set_add(bundle, "case-%d-root-stress.csv", number));
    for (int end = 0; end < 2; end++)
      if (json_object_get(eo_json_find(load_case, "contact/pattern"), eo_end_name[end]))
        save_pattern(result, load_case, eo_end_name[end],
                     eo_file_set_add(bundle, "case-%d-pattern-%s.csv", number, eo_end_name[end]));
  }
}

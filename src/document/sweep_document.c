/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/sweep_document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"
#include "format/text_table.h"

#include <config.h>

/* One column: its place in the document (a slash opens an object), its heading in CSV, its member. */
struct column {
  const char *path, *heading;
  size_t offset;
  const struct eo_unit *unit;
  int end; /* -1: of the pair */
};

#define AT_TORQUE(path_, heading_, member, unit_, end_)                    \
  {                                                                        \
    path_, heading_, offsetof(struct eo_sweep_torque, member), unit_, end_ \
  }
static const struct column torque_columns[] = {
    AT_TORQUE("peak_to_peak_um", "peak_to_peak_um", peak_to_peak, &eo_unit_um, -1),
    AT_TORQUE("mean_um", "mean_um", mean, &eo_unit_um, -1),
    AT_TORQUE("left/stiffness_N_per_um", "left_stiffness_N_per_um", stiffness[0], &eo_unit_N_per_um, 0),
    AT_TORQUE("left/tangent_stiffness_N_per_um", "left_tangent_stiffness_N_per_um", tangent[0], &eo_unit_N_per_um, 0),
    AT_TORQUE("left/max_pressure_MPa", "left_max_pressure_MPa", max_pressure[0], &eo_unit_MPa, 0),
    AT_TORQUE("left/max_line_load_N_per_mm", "left_max_line_load_N_per_mm", max_line_load[0], &eo_unit_N_per_mm, 0),
    AT_TORQUE("left/edge_load_share", "left_edge_load_share", edge_share[0], NULL, 0),
    AT_TORQUE("right/stiffness_N_per_um", "right_stiffness_N_per_um", stiffness[1], &eo_unit_N_per_um, 1),
    AT_TORQUE("right/tangent_stiffness_N_per_um", "right_tangent_stiffness_N_per_um", tangent[1], &eo_unit_N_per_um, 1),
    AT_TORQUE("right/max_pressure_MPa", "right_max_pressure_MPa", max_pressure[1], &eo_unit_MPa, 1),
    AT_TORQUE("right/max_line_load_N_per_mm", "right_max_line_load_N_per_mm", max_line_load[1], &eo_unit_N_per_mm, 1),
    AT_TORQUE("right/edge_load_share", "right_edge_load_share", edge_share[1], NULL, 1),
};
enum { TORQUE_COLUMNS = sizeof torque_columns / sizeof *torque_columns };

#define AT_POINT(path_, heading_, member, unit_, end_)                    \
  {                                                                       \
    path_, heading_, offsetof(struct eo_sweep_point, member), unit_, end_ \
  }
static const struct column point_columns[] = {
    AT_POINT("rms_m_per_s2/normal", "rms_normal_m_per_s2", rms_pair[EO_READING_NORMAL], &eo_unit_m_per_s2, -1),
    AT_POINT("rms_m_per_s2/transverse", "rms_transverse_m_per_s2", rms_pair[EO_READING_TRANSVERSE], &eo_unit_m_per_s2,
             -1),
    AT_POINT("rms_m_per_s2/rotational", "rms_rotational_m_per_s2", rms_pair[EO_READING_ROTATIONAL], &eo_unit_m_per_s2,
             -1),
    AT_POINT("rms_of_mean_m_per_s2/normal", "rms_of_mean_normal_m_per_s2", rms_of_mean[EO_READING_NORMAL],
             &eo_unit_m_per_s2, -1),
    AT_POINT("rms_of_mean_m_per_s2/transverse", "rms_of_mean_transverse_m_per_s2", rms_of_mean[EO_READING_TRANSVERSE],
             &eo_unit_m_per_s2, -1),
    AT_POINT("rms_of_mean_m_per_s2/rotational", "rms_of_mean_rotational_m_per_s2", rms_of_mean[EO_READING_ROTATIONAL],
             &eo_unit_m_per_s2, -1),
    AT_POINT("left/impact_force_N", "left_impact_force_N", impact[0], &eo_unit_N, 0),
    AT_POINT("left/rms_m_per_s2/normal", "left_rms_normal_m_per_s2", rms[EO_READING_NORMAL][0], &eo_unit_m_per_s2, 0),
    AT_POINT("left/rms_m_per_s2/transverse", "left_rms_transverse_m_per_s2", rms[EO_READING_TRANSVERSE][0],
             &eo_unit_m_per_s2, 0),
    AT_POINT("left/rms_m_per_s2/rotational", "left_rms_rotational_m_per_s2", rms[EO_READING_ROTATIONAL][0],
             &eo_unit_m_per_s2, 0),
    AT_POINT("left/dynamic_factor", "left_dynamic_factor", dynamic_factor[0], NULL, 0),
    AT_POINT("left/contact_loss", "left_contact_loss", contact_loss[0], NULL, 0),
    AT_POINT("right/impact_force_N", "right_impact_force_N", impact[1], &eo_unit_N, 1),
    AT_POINT("right/rms_m_per_s2/normal", "right_rms_normal_m_per_s2", rms[EO_READING_NORMAL][1], &eo_unit_m_per_s2, 1),
    AT_POINT("right/rms_m_per_s2/transverse", "right_rms_transverse_m_per_s2", rms[EO_READING_TRANSVERSE][1],
             &eo_unit_m_per_s2, 1),
    AT_POINT("right/rms_m_per_s2/rotational", "right_rms_rotational_m_per_s2", rms[EO_READING_ROTATIONAL][1],
             &eo_unit_m_per_s2, 1),
    AT_POINT("right/dynamic_factor", "right_dynamic_factor", dynamic_factor[1], NULL, 1),
    AT_POINT("right/contact_loss", "right_contact_loss", contact_loss[1], NULL, 1),
};
enum { POINT_COLUMNS = sizeof point_columns / sizeof *point_columns };

static const char *const variant_name[EO_SWEEP_VARIANTS] = {"modified", "unmodified"};

static const char *const outcome_names[] = {"converged", "contact_lost", "not_converged", NULL};

static const char *outcome_of(const struct eo_sweep_point *point)
{
  return outcome_names[point->outcome];
}

static double member_of(const void *row, const struct column *column)
{
  double value;
  memcpy(&value, (const char *)row + column->offset, sizeof value);
  return value;
}

static const struct eo_outline_row torque_end_rows[] = {
    EO_KEY("stiffness_N_per_um", "[number?]", "mean mesh stiffness, load over approach, normal",
           .unit = &eo_unit_N_per_um),
    EO_KEY("tangent_stiffness_N_per_um", "[number?]", "the same, tangent", .unit = &eo_unit_N_per_um),
    EO_KEY("max_pressure_MPa", "[number?]", "largest contact pressure", .unit = &eo_unit_MPa),
    EO_KEY("max_line_load_N_per_mm", "[number?]", "largest load per length of contact line", .unit = &eo_unit_N_per_mm),
    EO_KEY("edge_load_share", "[number?]", "largest share of the load on tip edges"),
};
static const struct eo_outline torque_end = EO_OUTLINE("SweepTorqueEnd", torque_end_rows);

static const struct eo_outline_row by_torque_rows[] = {
    EO_KEY("peak_to_peak_um", "[number?]", "of the loaded transmission error", .unit = &eo_unit_um),
    EO_KEY("mean_um", "[number?]", "of the loaded transmission error", .unit = &eo_unit_um),
    EO_KEY("left", "object", "left end", .outline = &torque_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &torque_end),
    EO_KEY("contact_failures", "[integer]", "mesh positions at which the loaded contact did not converge"),
};
static const struct eo_outline by_torque = EO_OUTLINE("SweepByTorque", by_torque_rows);

static const struct eo_outline_row reading_rows[] = {
    EO_KEY("normal", "[number?]", "relative acceleration normal to the teeth", .unit = &eo_unit_m_per_s2),
    EO_KEY("transverse", "[number?]", "in the transverse plane", .unit = &eo_unit_m_per_s2),
    EO_KEY("rotational", "[number?]", "of the rotations alone", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline reading_columns = EO_OUTLINE("SweepReadings", reading_rows);

static const struct eo_outline_row point_end_rows[] = {
    EO_KEY("impact_force_N", "[number?]", "general entering impact", .unit = &eo_unit_N),
    EO_KEY("rms_m_per_s2", "object", "RMS of the end", .outline = &reading_columns),
    EO_KEY("dynamic_factor", "[number?]", "largest over static mesh force"),
    EO_KEY("contact_loss", "[number?]", "share of the mesh cycle without contact"),
};
static const struct eo_outline point_end = EO_OUTLINE("SweepPointEnd", point_end_rows);

static const struct eo_outline_row point_rows[] = {
    EO_KEY("outcome", "[word]", "not_converged: no periodic state was found, its numbers are null",
           .words = outcome_names),
    EO_KEY("rms_m_per_s2", "object", "mean of the ends' RMS", .outline = &reading_columns),
    EO_KEY("rms_of_mean_m_per_s2", "object", "RMS of the mean of the ends", .outline = &reading_columns),
    EO_KEY("left", "object", "left end", .outline = &point_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &point_end),
    EO_KEY("back_contact", "[flag]", "the back flanks touch"),
};
static const struct eo_outline point_outline = EO_OUTLINE("SweepPoints", point_rows);

static const struct eo_outline_row variant_rows[] = {
    EO_KEY("by_torque", "object", "columns over torque_Nm", .outline = &by_torque),
    EO_KEY("points", "object",
           "columns over all points, torque by torque: entry i * (number of speeds) + j; upward in speed",
           .outline = &point_outline),
    EO_KEY("down", "object?", "the same downward in speed; null when both are the same everywhere",
           .outline = &point_outline),
};
static const struct eo_outline variant_outline = EO_OUTLINE("SweepVariant", variant_rows);

static const struct eo_outline_row mode_rows[] = {
    EO_KEY("frequency_Hz", "[[number?]]", "a row for every torque", .unit = &eo_unit_Hz),
    EO_KEY("damping_ratio", "[[number?]]", "a row for every torque"),
};
static const struct eo_outline mode_outline = EO_OUTLINE("SweepModes", mode_rows);

static const struct eo_outline_row crossing_rows[] = {
    EO_KEY("torque_Nm", "[number]", "on the pinion shaft", .unit = &eo_unit_Nm),
    EO_KEY("mode", "[integer]", "number of the mode, from 1"),
    EO_KEY("order", "[integer]", "mesh order, from 1"),
    EO_KEY("frequency_Hz", "[number]", "of the mode", .unit = &eo_unit_Hz),
    EO_KEY("speed_rpm", "[number]", "at which they meet", .unit = &eo_unit_rpm),
};
static const struct eo_outline crossing_outline = EO_OUTLINE("SweepCrossings", crossing_rows);

static const struct eo_outline_row sweep_rows[] = {
    EO_KEY("program", "text", "name and version"),
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign"),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design"),
    EO_KEY("torque_Nm", "[number]", "axis of torques", .unit = &eo_unit_Nm),
    EO_KEY("speed_rpm", "[number]", "axis of speeds", .unit = &eo_unit_rpm),
    EO_KEY("modified", "object", "the design", .outline = &variant_outline),
    EO_KEY("unmodified", "object", "without its modification", .outline = &variant_outline),
    EO_KEY("eigenfrequencies", "object", "damped modes of the design", .outline = &mode_outline),
    EO_KEY("crossings", "object", "where mesh orders meet eigenfrequencies, as columns", .outline = &crossing_outline),
    EO_KEY("warnings", "[text]", "in plain words"),
};
const struct eo_outline eo_sweep_outline = EO_OUTLINE("Sweep", sweep_rows);

/* Puts a value below the objects that the path names, which are made when missing. */
static void put_at(struct eo_object *object, const char *path, json_t *value)
{
  json_t *at = object->json;
  const char *slash;
  for (; (slash = strchr(path, '/')); path = slash + 1) {
    char key[40];
    snprintf(key, sizeof key, "%.*s", (int)(slash - path), path);
    if (!json_object_get(at, key))
      eo_json_put(at, key, json_object(), &object->failed);
    at = json_object_get(at, key);
  }
  eo_json_put(at, path, value, &object->failed);
}

static void put_columns(struct eo_object *object, const struct eo_sweep *sweep, int columns,
                        const struct column *column, int rows, const void *row, size_t size)
{
  for (int i = 0; i < columns; i++)
    if (column[i].end < sweep->ends)
      put_at(object, column[i].path,
             eo_json_reals(rows, (const double *)(const void *)((const char *)row + column[i].offset),
                           (int)(size / sizeof(double)), column[i].unit, EO_DIGITS_NUMBER));
}

static json_t *encode_torques(const struct eo_sweep *sweep, int variant)
{
  struct eo_object object = eo_object_open();
  json_t *failures = json_array();
  for (int i = 0; i < sweep->torques; i++)
    object.failed = object.failed ||
                    json_array_append_new(failures, json_integer(sweep->at_torque[variant][i].contact_failures)) != 0;
  put_columns(&object, sweep, TORQUE_COLUMNS, torque_columns, sweep->torques, sweep->at_torque[variant],
              sizeof *sweep->at_torque[variant]);
  eo_object_put(&object, "contact_failures", failures);
  return eo_object_close(&object);
}

static json_t *encode_points(const struct eo_sweep *sweep, int variant, int direction)
{
  int points = sweep->torques * sweep->speeds;
  const struct eo_sweep_point *point = sweep->point[variant][direction];
  struct eo_object object = eo_object_open();
  json_t *outcomes = json_array(), *back = json_array();
  for (int i = 0; i < points && !object.failed; i++)
    object.failed = json_array_append_new(outcomes, json_string(outcome_of(&point[i]))) != 0 ||
                    json_array_append_new(back, json_boolean(point[i].back_contact)) != 0;
  eo_object_put(&object, "outcome", outcomes);
  put_columns(&object, sweep, POINT_COLUMNS, point_columns, points, point, sizeof *point);
  eo_object_put(&object, "back_contact", back);
  return eo_object_close(&object);
}

static json_t *encode_variant(const struct eo_sweep *sweep, int variant)
{
  struct eo_object object = eo_object_open_as(&variant_outline);
  eo_object_put(&object, "by_torque", encode_torques(sweep, variant));
  eo_object_put(&object, "points", encode_points(sweep, variant, EO_SWEEP_UP));
  eo_object_put(&object, "down", sweep->branches[variant] ? encode_points(sweep, variant, EO_SWEEP_DOWN) : json_null());
  return eo_object_close(&object);
}

static json_t *encode_modes(const struct eo_sweep *sweep)
{
  struct eo_object object = eo_object_open_as(&mode_outline);
  json_t *frequencies = json_array(), *ratios = json_array();
  for (int i = 0; i < sweep->torques && !object.failed; i++) {
    const struct eo_dynamics_modes *modes = &sweep->at_torque[EO_SWEEP_DESIGN][i].modes;
    object.failed =
        json_array_append_new(frequencies,
                              eo_json_reals(modes->n, modes->frequency, 1, &eo_unit_Hz, EO_DIGITS_NUMBER)) != 0 ||
        json_array_append_new(ratios, eo_json_reals(modes->n, modes->damping_ratio, 1, NULL, EO_DIGITS_NUMBER)) != 0;
  }
  eo_object_put(&object, "frequency_Hz", frequencies);
  eo_object_put(&object, "damping_ratio", ratios);
  return eo_object_close(&object);
}

/* Modes count from 1, like orders. */
static json_t *encode_crossings(const struct eo_sweep *sweep)
{
  struct eo_object object = eo_object_open_as(&crossing_outline);
  json_t *torque = json_array(), *mode = json_array(), *order = json_array(), *frequency = json_array(),
         *speed = json_array();
  for (int i = 0; i < sweep->crossings && !object.failed; i++) {
    const struct eo_sweep_crossing *crossing = &sweep->crossing[i];
    object.failed = json_array_append_new(torque, eo_json_quantity(sweep->torque[crossing->torque], &eo_unit_Nm)) !=
                        0 ||
                    json_array_append_new(mode, json_integer(crossing->mode + 1)) != 0 ||
                    json_array_append_new(order, json_integer(crossing->order)) != 0 ||
                    json_array_append_new(frequency, eo_json_quantity(crossing->frequency, &eo_unit_Hz)) != 0 ||
                    json_array_append_new(speed, eo_json_quantity(crossing->speed, &eo_unit_rpm)) != 0;
  }
  eo_object_put(&object, "torque_Nm", torque);
  eo_object_put(&object, "mode", mode);
  eo_object_put(&object, "order", order);
  eo_object_put(&object, "frequency_Hz", frequency);
  eo_object_put(&object, "speed_rpm", speed);
  return eo_object_close(&object);
}

static json_t *encode_warnings(const struct eo_warnings *warnings)
{
  json_t *list = json_array();
  for (int i = 0; warnings && i < warnings->count && list; i++)
    if (json_array_append_new(list, json_string(warnings->text[i])) != 0) {
      json_decref(list);
      list = NULL;
    }
  return list;
}

json_t *eo_sweep_encode(const struct eo_sweep *sweep, const struct eo_design *design,
                        const struct eo_warnings *warnings)
{
  char hash[EO_HASH_LENGTH + 1];
  struct eo_object object = eo_object_open_as(&eo_sweep_outline);
  eo_object_put(&object, "program", json_string(PACKAGE_STRING));
  eo_object_put(&object, "design", eo_design_encode(design));
  eo_object_put(&object, "design_hash", eo_design_hash(design, hash, NULL) ? NULL : json_string(hash));
  eo_object_put(&object, "torque_Nm", eo_json_reals(sweep->torques, sweep->torque, 1, &eo_unit_Nm, EO_DIGITS_NUMBER));
  eo_object_put(&object, "speed_rpm", eo_json_reals(sweep->speeds, sweep->speed, 1, &eo_unit_rpm, EO_DIGITS_NUMBER));
  for (int v = 0; v < EO_SWEEP_VARIANTS; v++)
    eo_object_put(&object, variant_name[v], encode_variant(sweep, v));
  eo_object_put(&object, "eigenfrequencies", encode_modes(sweep));
  eo_object_put(&object, "crossings", encode_crossings(sweep));
  eo_object_put(&object, "warnings", encode_warnings(warnings));
  return eo_object_close(&object);
}

void eo_sweep_write(const struct eo_sweep *sweep, const struct eo_design *design, const struct eo_warnings *warnings,
                    struct eo_text *text)
{
  json_t *document = eo_sweep_encode(sweep, design, warnings);
  if (document)
    eo_json_write(text, document, EO_JSON_COMPACT);
  text->failed = text->failed || !document;
  json_decref(document);
}

static void add_headings(const struct eo_sweep *sweep, int columns, const struct column *column, const char *prefix,
                         struct eo_text_table *sheet)
{
  char heading[80];
  for (int i = 0; i < columns; i++)
    if (column[i].end < sweep->ends) {
      snprintf(heading, sizeof heading, "%s%s", prefix, column[i].heading);
      eo_text_table_string(sheet, heading);
    }
}

static void add_all_headings(const struct eo_sweep *sweep, struct eo_text_table *sheet)
{
  static const char *const prefix[EO_SWEEP_VARIANTS][EO_SWEEP_DIRECTIONS] = {{"", "down_"},
                                                                             {"unmodified_", "unmodified_down_"}};
  static const struct column outcome = {.heading = "outcome", .end = -1};
  eo_text_table_string(sheet, "torque_Nm");
  eo_text_table_string(sheet, "speed_rpm");
  for (int v = 0; v < EO_SWEEP_VARIANTS; v++) {
    add_headings(sweep, TORQUE_COLUMNS, torque_columns, prefix[v][0], sheet);
    for (int d = 0; d < (sweep->branches[v] ? 2 : 1); d++) {
      add_headings(sweep, 1, &outcome, prefix[v][d], sheet);
      add_headings(sweep, POINT_COLUMNS, point_columns, prefix[v][d], sheet);
    }
  }
  sheet->columns = sheet->cells;
}

static void add_row(const struct eo_sweep *sweep, int columns, const struct column *column, const void *row,
                    struct eo_text_table *sheet)
{
  for (int i = 0; i < columns; i++)
    if (column[i].end < sweep->ends)
      eo_text_table_number(sheet, member_of(row, &column[i]), column[i].unit, EO_DIGITS_NUMBER);
}

void eo_sweep_csv(const struct eo_sweep *sweep, struct eo_text *text)
{
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 0, NULL);
  add_all_headings(sweep, &sheet);
  for (int i = 0; i < sweep->torques * sweep->speeds; i++) {
    eo_text_table_number(&sheet, sweep->torque[i / sweep->speeds], &eo_unit_Nm, EO_DIGITS_NUMBER);
    eo_text_table_number(&sheet, sweep->speed[i % sweep->speeds], &eo_unit_rpm, EO_DIGITS_NUMBER);
    for (int v = 0; v < EO_SWEEP_VARIANTS; v++) {
      add_row(sweep, TORQUE_COLUMNS, torque_columns, &sweep->at_torque[v][i / sweep->speeds], &sheet);
      for (int d = 0; d < (sweep->branches[v] ? 2 : 1); d++) {
        eo_text_table_string(&sheet, outcome_of(&sweep->point[v][d][i]));
        add_row(sweep, POINT_COLUMNS, point_columns, &sweep->point[v][d][i], &sheet);
      }
    }
  }
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

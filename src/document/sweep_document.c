/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/sweep_document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"
#include "format/text_table.h"

#include <config.h>

/* One column of the CSV: its heading, its member. */
struct column {
  const char *heading;
  size_t offset;
  const struct eo_unit *unit;
  int end; /* -1: of the pair */
};

#define AT_TORQUE(heading_, member, unit_, end_)                    \
  {                                                                 \
    heading_, offsetof(struct eo_sweep_torque, member), unit_, end_ \
  }
static const struct column torque_columns[] = {
    AT_TORQUE("peak_to_peak_um", peak_to_peak, &eo_unit_um, -1),
    AT_TORQUE("mean_um", mean, &eo_unit_um, -1),
    AT_TORQUE("left_stiffness_N_per_um", stiffness[0], &eo_unit_N_per_um, 0),
    AT_TORQUE("left_tangent_stiffness_N_per_um", tangent[0], &eo_unit_N_per_um, 0),
    AT_TORQUE("left_max_pressure_MPa", max_pressure[0], &eo_unit_MPa, 0),
    AT_TORQUE("left_max_line_load_N_per_mm", max_line_load[0], &eo_unit_N_per_mm, 0),
    AT_TORQUE("left_edge_load_share", edge_share[0], NULL, 0),
    AT_TORQUE("right_stiffness_N_per_um", stiffness[1], &eo_unit_N_per_um, 1),
    AT_TORQUE("right_tangent_stiffness_N_per_um", tangent[1], &eo_unit_N_per_um, 1),
    AT_TORQUE("right_max_pressure_MPa", max_pressure[1], &eo_unit_MPa, 1),
    AT_TORQUE("right_max_line_load_N_per_mm", max_line_load[1], &eo_unit_N_per_mm, 1),
    AT_TORQUE("right_edge_load_share", edge_share[1], NULL, 1),
};
enum { TORQUE_COLUMNS = sizeof torque_columns / sizeof *torque_columns };

#define AT_POINT(heading_, member, unit_, end_)                    \
  {                                                                \
    heading_, offsetof(struct eo_sweep_point, member), unit_, end_ \
  }
static const struct column point_columns[] = {
    AT_POINT("rms_normal_m_per_s2", rms_pair[EO_READING_NORMAL], &eo_unit_m_per_s2, -1),
    AT_POINT("rms_transverse_m_per_s2", rms_pair[EO_READING_TRANSVERSE], &eo_unit_m_per_s2, -1),
    AT_POINT("rms_rotational_m_per_s2", rms_pair[EO_READING_ROTATIONAL], &eo_unit_m_per_s2, -1),
    AT_POINT("rms_of_mean_normal_m_per_s2", rms_of_mean[EO_READING_NORMAL], &eo_unit_m_per_s2, -1),
    AT_POINT("rms_of_mean_transverse_m_per_s2", rms_of_mean[EO_READING_TRANSVERSE], &eo_unit_m_per_s2, -1),
    AT_POINT("rms_of_mean_rotational_m_per_s2", rms_of_mean[EO_READING_ROTATIONAL], &eo_unit_m_per_s2, -1),
    AT_POINT("left_impact_force_N", impact[0], &eo_unit_N, 0),
    AT_POINT("left_rms_normal_m_per_s2", rms[EO_READING_NORMAL][0], &eo_unit_m_per_s2, 0),
    AT_POINT("left_rms_transverse_m_per_s2", rms[EO_READING_TRANSVERSE][0], &eo_unit_m_per_s2, 0),
    AT_POINT("left_rms_rotational_m_per_s2", rms[EO_READING_ROTATIONAL][0], &eo_unit_m_per_s2, 0),
    AT_POINT("left_dynamic_factor", dynamic_factor[0], NULL, 0),
    AT_POINT("left_contact_loss", contact_loss[0], NULL, 0),
    AT_POINT("right_impact_force_N", impact[1], &eo_unit_N, 1),
    AT_POINT("right_rms_normal_m_per_s2", rms[EO_READING_NORMAL][1], &eo_unit_m_per_s2, 1),
    AT_POINT("right_rms_transverse_m_per_s2", rms[EO_READING_TRANSVERSE][1], &eo_unit_m_per_s2, 1),
    AT_POINT("right_rms_rotational_m_per_s2", rms[EO_READING_ROTATIONAL][1], &eo_unit_m_per_s2, 1),
    AT_POINT("right_dynamic_factor", dynamic_factor[1], NULL, 1),
    AT_POINT("right_contact_loss", contact_loss[1], NULL, 1),
};
enum { POINT_COLUMNS = sizeof point_columns / sizeof *point_columns };

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

/* Rows of a sweep as one end has them: members that are arrays by end, moved so that the first is its own. */
struct end_rows {
  int count;
  const void *row;
};

static struct end_rows rows_of_end(int count, const void *row, int end)
{
  return (struct end_rows){count, (const char *)row + (size_t)end * sizeof(double)};
}

#define OF_TORQUE_END(name) EO_COLUMN_AT(struct end_rows, row, count, struct eo_sweep_torque, name[EO_LEFT])
static const struct eo_outline_row torque_end_rows[] = {
    EO_KEY("stiffness_N_per_um", "[number?]", "mean mesh stiffness, load over approach, normal",
           .unit = &eo_unit_N_per_um, OF_TORQUE_END(stiffness)),
    EO_KEY("tangent_stiffness_N_per_um", "[number?]", "the same, tangent", .unit = &eo_unit_N_per_um,
           OF_TORQUE_END(tangent)),
    EO_KEY("max_pressure_MPa", "[number?]", "largest contact pressure", .unit = &eo_unit_MPa,
           OF_TORQUE_END(max_pressure)),
    EO_KEY("max_line_load_N_per_mm", "[number?]", "largest load per length of contact line", .unit = &eo_unit_N_per_mm,
           OF_TORQUE_END(max_line_load)),
    EO_KEY("edge_load_share", "[number?]", "largest share of the load on tip edges", OF_TORQUE_END(edge_share)),
};
static const struct eo_outline torque_end = EO_OUTLINE("SweepTorqueEnd", torque_end_rows);

struct torques {
  bool two;
  int count;
  const struct eo_sweep_torque *row;
  struct end_rows end[2];
};

#define OF_TORQUES(name) EO_COLUMN_AT(struct torques, row, count, struct eo_sweep_torque, name)
static const struct eo_outline_row by_torque_rows[] = {
    EO_KEY("peak_to_peak_um", "[number?]", "of the loaded transmission error", .unit = &eo_unit_um,
           OF_TORQUES(peak_to_peak)),
    EO_KEY("mean_um", "[number?]", "of the loaded transmission error", .unit = &eo_unit_um, OF_TORQUES(mean)),
    EO_KEY("left", "object", "left end", .outline = &torque_end, EO_AT(struct torques, end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &torque_end,
           EO_AT(struct torques, end[EO_RIGHT]), EO_IF(struct torques, two)),
    EO_KEY("contact_failures", "[integer]", "mesh positions at which the loaded contact did not converge",
           OF_TORQUES(contact_failures)),
};
static const struct eo_outline by_torque = EO_OUTLINE("SweepByTorque", by_torque_rows);

/* Readings of every point, one behind the other; of an end, whose readings lie two apart. */
#define OF_READINGS(reading, apart)                                                                           \
  .offset = offsetof(struct end_rows, row), .count_offset = offsetof(struct end_rows, count), .column = true, \
  .stride = sizeof(struct eo_sweep_point), .column_offset = sizeof(double[apart]) * EO_READING_##reading,     \
  .member = EO_MEMBER_NUMBER
#define READING_ROWS(apart)                                                                             \
  EO_KEY("normal", "[number?]", "relative acceleration normal to the teeth", .unit = &eo_unit_m_per_s2, \
         OF_READINGS(NORMAL, apart)),                                                                   \
      EO_KEY("transverse", "[number?]", "in the transverse plane", .unit = &eo_unit_m_per_s2,           \
             OF_READINGS(TRANSVERSE, apart)),                                                           \
      EO_KEY("rotational", "[number?]", "of the rotations alone", .unit = &eo_unit_m_per_s2,            \
             OF_READINGS(ROTATIONAL, apart))
static const struct eo_outline_row reading_rows[] = {READING_ROWS(1)};
static const struct eo_outline reading_columns = EO_OUTLINE("SweepReadings", reading_rows);
static const struct eo_outline_row end_reading_rows[] = {READING_ROWS(2)};
static const struct eo_outline end_reading_columns = EO_OUTLINE("SweepReadings", end_reading_rows);

struct point_end {
  struct end_rows own, rms;
};

#define OF_POINT_END(name) EO_COLUMN_AT(struct point_end, own.row, own.count, struct eo_sweep_point, name[EO_LEFT])
static const struct eo_outline_row point_end_rows[] = {
    EO_KEY("impact_force_N", "[number?]", "general entering impact", .unit = &eo_unit_N, OF_POINT_END(impact)),
    EO_KEY("rms_m_per_s2", "object", "RMS of the end", .outline = &end_reading_columns, EO_AT(struct point_end, rms)),
    EO_KEY("dynamic_factor", "[number?]", "largest over static mesh force", OF_POINT_END(dynamic_factor)),
    EO_KEY("contact_loss", "[number?]", "share of the mesh cycle without contact", OF_POINT_END(contact_loss)),
};
static const struct eo_outline point_end = EO_OUTLINE("SweepPointEnd", point_end_rows);

struct points {
  bool two;
  int count;
  const struct eo_sweep_point *row;
  struct end_rows rms_pair, rms_of_mean;
  struct point_end end[2];
};

#define OF_POINTS(name) EO_COLUMN_AT(struct points, row, count, struct eo_sweep_point, name)
static const struct eo_outline_row point_rows[] = {
    EO_KEY("outcome", "[word]", "not_converged: no periodic state was found, its numbers are null",
           .words = outcome_names, OF_POINTS(outcome)),
    EO_KEY("rms_m_per_s2", "object", "mean of the ends' RMS", .outline = &reading_columns,
           EO_AT(struct points, rms_pair)),
    EO_KEY("rms_of_mean_m_per_s2", "object", "RMS of the mean of the ends", .outline = &reading_columns,
           EO_AT(struct points, rms_of_mean)),
    EO_KEY("left", "object", "left end", .outline = &point_end, EO_AT(struct points, end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &point_end,
           EO_AT(struct points, end[EO_RIGHT]), EO_IF(struct points, two)),
    EO_KEY("back_contact", "[flag]", "the back flanks touch", OF_POINTS(back_contact)),
};
static const struct eo_outline point_outline = EO_OUTLINE("SweepPoints", point_rows);

struct variant {
  struct torques by_torque;
  struct points up;
  json_t *down;
};

static const struct eo_outline_row variant_rows[] = {
    EO_KEY("by_torque", "object", "columns over torque_Nm", .outline = &by_torque, EO_AT(struct variant, by_torque)),
    EO_KEY("points", "object",
           "columns over all points, torque by torque: entry i * (number of speeds) + j; upward in speed",
           .outline = &point_outline, EO_AT(struct variant, up)),
    EO_KEY("down", "object?", "the same downward in speed; null when both are the same everywhere",
           .outline = &point_outline, EO_AT(struct variant, down)),
};
static const struct eo_outline variant_outline = EO_OUTLINE("SweepVariant", variant_rows);

struct modes {
  json_t *frequency, *damping;
};

static const struct eo_outline_row mode_rows[] = {
    EO_KEY("frequency_Hz", "[[number?]]", "a row for every torque", .unit = &eo_unit_Hz,
           EO_AT(struct modes, frequency)),
    EO_KEY("damping_ratio", "[[number?]]", "a row for every torque", EO_AT(struct modes, damping)),
};
static const struct eo_outline mode_outline = EO_OUTLINE("SweepModes", mode_rows);

struct crossing {
  double torque, frequency, speed;
  int mode, order; /* from 1 */
};
struct crossings {
  int count;
  struct crossing *row;
};

#define OF_CROSSING(name) EO_COLUMN_AT(struct crossings, row, count, struct crossing, name)
static const struct eo_outline_row crossing_rows[] = {
    EO_KEY("torque_Nm", "[number]", "on the pinion shaft", .unit = &eo_unit_Nm, OF_CROSSING(torque)),
    EO_KEY("mode", "[integer]", "number of the mode, from 1", OF_CROSSING(mode)),
    EO_KEY("order", "[integer]", "mesh order, from 1", OF_CROSSING(order)),
    EO_KEY("frequency_Hz", "[number]", "of the mode", .unit = &eo_unit_Hz, OF_CROSSING(frequency)),
    EO_KEY("speed_rpm", "[number]", "at which they meet", .unit = &eo_unit_rpm, OF_CROSSING(speed)),
};
static const struct eo_outline crossing_outline = EO_OUTLINE("SweepCrossings", crossing_rows);

struct vary {
  const char *key;
  struct eo_series value;
};

static const struct eo_outline_row vary_rows[] = {
    EO_KEY("key", "text", "of the design", EO_AT(struct vary, key)),
    EO_KEY("values", "[number]", "as the design states it, a step for each", EO_AT(struct vary, value)),
};
static const struct eo_outline vary_outline = EO_OUTLINE("SweepVary", vary_rows);

static json_t *encode_vary(const struct eo_sweep *sweep)
{
  const struct vary view = {sweep->key, eo_series_of(sweep->torques, sweep->value, EO_DIGITS_NUMBER)};
  return sweep->value ? eo_outline_encode(&vary_outline, &view) : json_null();
}

struct sweep {
  const char *program;
  char hash[EO_HASH_LENGTH + 1];
  struct eo_series torque, speed;
  json_t *design, *vary, *variant[EO_SWEEP_VARIANTS], *modes, *crossings, *warnings;
};

static const struct eo_outline_row sweep_rows[] = {
    EO_KEY("program", "text", "name and version", EO_AT(struct sweep, program)),
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign",
           EO_AT(struct sweep, design)),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design", EO_AT(struct sweep, hash)),
    EO_KEY("vary", "object?", "the number that varies in place of the torque, whose steps stand where torques do",
           .outline = &vary_outline, EO_AT(struct sweep, vary)),
    EO_KEY("torque_Nm", "[number]", "axis of torques; where another number varies the torque of each step",
           .unit = &eo_unit_Nm, EO_AT(struct sweep, torque)),
    EO_KEY("speed_rpm", "[number]", "axis of speeds", .unit = &eo_unit_rpm, EO_AT(struct sweep, speed)),
    EO_KEY("modified", "object", "the design", .outline = &variant_outline,
           EO_AT(struct sweep, variant[EO_SWEEP_DESIGN])),
    EO_KEY("unmodified", "object", "without its modification", .outline = &variant_outline,
           EO_AT(struct sweep, variant[EO_SWEEP_UNMODIFIED])),
    EO_KEY("eigenfrequencies", "object", "damped modes of the design", .outline = &mode_outline,
           EO_AT(struct sweep, modes)),
    EO_KEY("crossings", "object", "where mesh orders meet eigenfrequencies, as columns", .outline = &crossing_outline,
           EO_AT(struct sweep, crossings)),
    EO_KEY("warnings", "[text]", "in plain words", EO_AT(struct sweep, warnings)),
};
const struct eo_outline eo_sweep_outline = EO_OUTLINE("Sweep", sweep_rows);

static struct points find_points(const struct eo_sweep *sweep, int variant, int direction)
{
  int count = sweep->torques * sweep->speeds;
  const struct eo_sweep_point *row = sweep->point[variant][direction];
  struct points view = {
      .two = sweep->ends == 2,
      .count = count,
      .row = row,
      .rms_pair = {count, row->rms_pair},
      .rms_of_mean = {count, row->rms_of_mean},
  };
  for (int end = 0; end < sweep->ends; end++)
    view.end[end] = (struct point_end){rows_of_end(count, row, end), rows_of_end(count, row->rms, end)};
  return view;
}

static json_t *encode_variant(const struct eo_sweep *sweep, int variant)
{
  const struct eo_sweep_torque *row = sweep->at_torque[variant];
  struct variant view = {.by_torque = {.two = sweep->ends == 2, .count = sweep->torques, .row = row},
                         .up = find_points(sweep, variant, EO_SWEEP_UP),
                         .down = json_null()};
  for (int end = 0; end < sweep->ends; end++)
    view.by_torque.end[end] = rows_of_end(sweep->torques, row, end);
  if (sweep->branches[variant]) {
    const struct points down = find_points(sweep, variant, EO_SWEEP_DOWN);
    view.down = eo_outline_encode(&point_outline, &down);
  }
  return eo_outline_encode(&variant_outline, &view);
}

static json_t *encode_modes(const struct eo_sweep *sweep)
{
  struct eo_object frequencies = eo_list_open(), ratios = eo_list_open();
  for (int i = 0; i < sweep->torques; i++) {
    const struct eo_dynamics_modes *modes = &sweep->at_torque[EO_SWEEP_DESIGN][i].modes;
    eo_list_add(&frequencies, eo_json_reals(modes->n, modes->frequency, 1, &eo_unit_Hz, EO_DIGITS_NUMBER));
    eo_list_add(&ratios, eo_json_reals(modes->n, modes->damping_ratio, 1, NULL, EO_DIGITS_NUMBER));
  }
  const struct modes view = {eo_object_close(&frequencies), eo_object_close(&ratios)};
  return eo_outline_encode(&mode_outline, &view);
}

/* Modes count from 1, like orders. */
static json_t *encode_crossings(const struct eo_sweep *sweep)
{
  struct crossings view = {sweep->crossings, malloc(sizeof *view.row * ((size_t)sweep->crossings + 1))};
  for (int i = 0; i < sweep->crossings && view.row; i++) {
    const struct eo_sweep_crossing *found = &sweep->crossing[i];
    view.row[i] = (struct crossing){sweep->torque[found->torque], found->frequency, found->speed, found->mode + 1,
                                    found->order};
  }
  json_t *encoded = view.row ? eo_outline_encode(&crossing_outline, &view) : NULL;
  free(view.row);
  return encoded;
}

json_t *eo_sweep_encode(const struct eo_sweep *sweep, const struct eo_design *design,
                        const struct eo_warnings *warnings)
{
  struct sweep view = {.program = PACKAGE_STRING,
                       .torque = eo_series_of(sweep->torques, sweep->torque, EO_DIGITS_NUMBER),
                       .speed = eo_series_of(sweep->speeds, sweep->speed, EO_DIGITS_NUMBER)};
  if (eo_design_hash(design, view.hash, NULL))
    return NULL;
  for (int v = 0; v < EO_SWEEP_VARIANTS; v++)
    view.variant[v] = encode_variant(sweep, v);
  view.design = eo_design_encode(design);
  view.vary = encode_vary(sweep);
  view.modes = encode_modes(sweep);
  view.crossings = encode_crossings(sweep);
  view.warnings = eo_warnings_encode(warnings);
  return eo_outline_encode(&eo_sweep_outline, &view);
}

void eo_sweep_write(const struct eo_sweep *sweep, const struct eo_design *design, const struct eo_warnings *warnings,
                    struct eo_text *text)
{
  eo_json_write_new(text, eo_sweep_encode(sweep, design, warnings), EO_JSON_COMPACT);
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
  if (sweep->value)
    eo_text_table_string(sheet, sweep->key);
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
    if (sweep->value)
      eo_text_table_number(&sheet, sweep->value[i / sweep->speeds], NULL, EO_DIGITS_NUMBER);
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

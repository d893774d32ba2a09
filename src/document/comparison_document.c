/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measured beside predicted: JSON, tables for people, CSV. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "format/json.h"
#include "document/measurement_document.h"
#include "document/result_private.h"
#include "format/text_table.h"

enum { CURVE = 128 };
static const double CHANGING = 0.02; /* range of the speed, relative, from which the stretches are told */

static const struct eo_unit percent = {"percent", "%", 100, true};

/* One number of every measurement. */
typedef double column_function(const struct eo_measured *m, const struct eo_compared *p);

static double torque(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)p, m->torque;
}
static double speed(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)p, m->speed;
}
static double measured_rms(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)p, m->rms;
}
static double measured_sigma(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)p, m->rms_sigma;
}
static double predicted_rms(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)m, p->prediction.rms;
}
static double ratio(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)m, p->ratio;
}
static double likeness(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)m, p->likeness;
}
static double predicted_peak(const struct eo_measured *m, const struct eo_compared *p)
{
  return (void)m, p->prediction.peak_to_peak;
}

static const struct column {
  const char *key;
  column_function *value;
  const struct eo_unit *unit;
} columns[] = {{"torque_Nm", torque, &eo_unit_Nm},
               {"speed_rpm", speed, &eo_unit_rpm},
               {"measured_rms_m_per_s2", measured_rms, &eo_unit_m_per_s2},
               {"measured_sigma_m_per_s2", measured_sigma, &eo_unit_m_per_s2},
               {"predicted_rms_m_per_s2", predicted_rms, &eo_unit_m_per_s2},
               {"ratio", ratio, NULL},
               {"likeness", likeness, NULL},
               {"predicted_te_peak_to_peak_um", predicted_peak, &eo_unit_um}};
enum { COLUMNS = sizeof columns / sizeof *columns };

static const char *const labels[] = {"modified", "unmodified", NULL}, *const ends[] = {"left", "right", NULL};

static const struct eo_outline_row column_rows[] = {
    EO_KEY("file", "[text]", "as it was uploaded"),
    EO_KEY("label", "[word]", "which pair was measured", .words = labels),
    EO_KEY("end", "[word]", "where the encoders sat", .words = ends),
    EO_KEY("torque_Nm", "[number]", "on the pinion shaft", .unit = &eo_unit_Nm),
    EO_KEY("speed_rpm", "[number]", "measured mean speed of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("measured_rms_m_per_s2", "[number?]", "rotational acceleration of the mesh orders",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("measured_sigma_m_per_s2", "[number?]", "its standard deviation", .unit = &eo_unit_m_per_s2),
    EO_KEY("predicted_rms_m_per_s2", "[number?]", "of the same orders; null without a periodic vibration",
           .unit = &eo_unit_m_per_s2),
    EO_KEY("ratio", "[number?]", "measured over predicted"),
    EO_KEY("likeness", "[number?]",
           "correlation of both curves of the transmission error when they are in phase, -1..1"),
    EO_KEY("predicted_te_peak_to_peak_um", "[number?]", "of the predicted dynamic transmission error",
           .unit = &eo_unit_um),
    EO_KEY("outlier", "[flag]", "does not fit the others"),
    EO_KEY("reason", "[text?]", "why"),
};
static const struct eo_outline column_outline = EO_OUTLINE("ComparedColumns", column_rows);

static json_t *encode_columns(const struct eo_comparison *c, const struct eo_measured *m)
{
  struct eo_object o = eo_object_open_as(&column_outline);
  json_t *file = json_array(), *label = json_array(), *end = json_array(), *outlier = json_array(),
         *reason = json_array();
  double *value = malloc(sizeof *value * ((size_t)c->count + 1));
  o.failed = o.failed || !value;
  for (int i = 0; i < c->count && !o.failed; i++)
    o.failed = json_array_append_new(file, json_string(m[i].name)) ||
               json_array_append_new(label, json_string(labels[m[i].unmodified])) ||
               json_array_append_new(end, json_string(ends[m[i].end])) ||
               json_array_append_new(outlier, json_boolean(c->point[i].outlier)) ||
               json_array_append_new(reason, *c->point[i].reason ? json_string(c->point[i].reason) : json_null());
  eo_object_put(&o, "file", file);
  eo_object_put(&o, "label", label);
  eo_object_put(&o, "end", end);
  for (int k = 0; k < COLUMNS && !o.failed; k++) {
    for (int i = 0; i < c->count; i++)
      value[i] = columns[k].value(&m[i], &c->point[i]);
    eo_object_put(&o, columns[k].key, eo_json_reals(c->count, value, 1, columns[k].unit, EO_DIGITS_NUMBER));
  }
  eo_object_put(&o, "outlier", outlier);
  eo_object_put(&o, "reason", reason);
  free(value);
  return eo_object_close(&o);
}

static const struct eo_outline_row order_rows[] = {
    EO_KEY("measured_m_per_s2", "[number?]", "acceleration of mesh orders 1, 2, ...", .unit = &eo_unit_m_per_s2),
    EO_KEY("predicted_m_per_s2", "[number?]", "the same, predicted", .unit = &eo_unit_m_per_s2),
    EO_KEY("measured_um", "[number?]", "amplitude of the transmission error at these orders", .unit = &eo_unit_um),
    EO_KEY("predicted_um", "[number?]", "the same, predicted", .unit = &eo_unit_um),
};
static const struct eo_outline order_outline = EO_OUTLINE("ComparedOrders", order_rows);

static const struct eo_outline_row curve_rows[] = {
    EO_KEY("position", "[number]", "phase of the mesh cycle, 0..1"),
    EO_KEY("measured_um", "[number?]", "transmission error of the mesh, over position", .unit = &eo_unit_um),
    EO_KEY("predicted_um", "[number?]", "the same, predicted, shifted to the phase that fits best",
           .unit = &eo_unit_um),
    EO_KEY("shift", "number?", "by how much, in mesh cycles"),
};
static const struct eo_outline curve_outline = EO_OUTLINE("ComparedCurves", curve_rows);

static const struct eo_outline_row detail_rows[] = {
    EO_KEY("orders", "object", "side by side", .outline = &order_outline),
    EO_KEY("te", "object", "in phase", .outline = &curve_outline),
};
static const struct eo_outline detail_outline = EO_OUTLINE("ComparedDetail", detail_rows);

/* Orders side by side and the curves in phase, one object per measurement. */
static json_t *encode_detail(const struct eo_measured *m, const struct eo_compared *p)
{
  double measured[EO_MESH_ORDERS], amplitude[2][EO_MESH_ORDERS], curve[2][CURVE], position[CURVE];
  struct eo_object o = eo_object_open_as(&detail_outline), orders = eo_object_open_as(&order_outline),
                   curves = eo_object_open_as(&curve_outline);
  for (int h = 0; h < m->harmonics; h++) {
    measured[h] = m->order[h].acceleration;
    amplitude[0][h] = cabs(m->order[h].amplitude);
    amplitude[1][h] = cabs(p->prediction.order[h]);
  }
  for (int i = 0; i < CURVE; i++)
    position[i] = (double)i / CURVE;
  eo_comparison_curves(m, p, CURVE, curve[0], curve[1]);
  eo_object_put(&orders, "measured_m_per_s2",
                eo_json_reals(m->harmonics, measured, 1, &eo_unit_m_per_s2, EO_DIGITS_CURVE));
  eo_object_put(&orders, "predicted_m_per_s2",
                eo_json_reals(m->harmonics, p->prediction.acceleration, 1, &eo_unit_m_per_s2, EO_DIGITS_CURVE));
  eo_object_put(&orders, "measured_um", eo_json_reals(m->harmonics, amplitude[0], 1, &eo_unit_um, EO_DIGITS_CURVE));
  eo_object_put(&orders, "predicted_um", eo_json_reals(m->harmonics, amplitude[1], 1, &eo_unit_um, EO_DIGITS_CURVE));
  eo_object_put(&curves, "position", eo_json_reals(CURVE, position, 1, NULL, EO_DIGITS_CURVE));
  eo_object_put(&curves, "measured_um", eo_json_reals(CURVE, curve[0], 1, &eo_unit_um, EO_DIGITS_CURVE));
  eo_object_put(&curves, "predicted_um", eo_json_reals(CURVE, curve[1], 1, &eo_unit_um, EO_DIGITS_CURVE));
  eo_object_put_number(&curves, "shift", p->shift);
  eo_object_put(&o, "orders", eo_object_close(&orders));
  eo_object_put(&o, "te", eo_object_close(&curves));
  return eo_object_close(&o);
}

static const struct eo_outline_row reduction_rows[] = {
    EO_KEY("file", "text", "of the modified pair"),
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("unmodified_measurements", "integer", "that it is compared with"),
    EO_KEY("measured_percent", "number?", "how much less the modified pair vibrates, per cent of the unmodified one",
           .unit = &percent),
    EO_KEY("sigma_percent", "number?", "standard deviation of it", .unit = &percent),
    EO_KEY("predicted_percent", "number?", "the same, predicted", .unit = &percent),
    EO_KEY("id", "integer", "number of the measurement", .when = "of stored measurements"),
};
static const struct eo_outline reduction_outline = EO_OUTLINE("ComparedReduction", reduction_rows);

static json_t *encode_reductions(const struct eo_comparison *c, const struct eo_measured *m)
{
  json_t *list = json_array();
  bool failed = !list;
  for (int i = 0; i < c->reductions && !failed; i++) {
    const struct eo_reduction *r = &c->reduction[i];
    struct eo_object o = eo_object_open_as(&reduction_outline);
    eo_object_put(&o, "file", json_string(m[r->modified].name));
    eo_object_put_number(&o, "torque_Nm", r->torque);
    eo_object_put_number(&o, "speed_rpm", r->speed);
    eo_object_put(&o, "unmodified_measurements", json_integer(r->unmodified));
    eo_object_put_number(&o, "measured_percent", r->measured);
    eo_object_put_number(&o, "sigma_percent", r->measured_sigma);
    eo_object_put_number(&o, "predicted_percent", r->predicted);
    failed = json_array_append_new(list, eo_object_close(&o)) != 0;
  }
  return failed ? (json_decref(list), NULL) : list;
}

static const struct eo_outline_row comparison_rows[] = {
    EO_KEY("measurements", "object", "columns over the measurements", .outline = &column_outline),
    EO_KEY("details", "[object]", "one for each measurement", .outline = &detail_outline),
    EO_KEY("reductions", "[object]",
           "one for each measurement of the modified pair with one of the unmodified pair at its torque and speed",
           .outline = &reduction_outline),
    EO_KEY("ratio", "number?", "median of measured over predicted RMS"),
    EO_KEY("spread", "number?", "robust relative standard deviation about it"),
};
const struct eo_outline eo_comparison_outline = EO_OUTLINE("ComparisonOfFiles", comparison_rows);

json_t *eo_comparison_encode(const struct eo_comparison *c, const struct eo_measured *m)
{
  struct eo_object o = eo_object_open_as(&eo_comparison_outline);
  json_t *details = json_array();
  for (int i = 0; i < c->count && !o.failed; i++)
    o.failed = json_array_append_new(details, encode_detail(&m[i], &c->point[i])) != 0;
  eo_object_put(&o, "measurements", encode_columns(c, m));
  eo_object_put(&o, "details", details);
  eo_object_put(&o, "reductions", encode_reductions(c, m));
  eo_object_put_number(&o, "ratio", c->ratio);
  eo_object_put_number(&o, "spread", c->spread);
  return eo_object_close(&o);
}

/* The stretches of a recording whose speed changes. */
static void print_order_tracks(const struct eo_transmission *t, struct eo_text *text)
{
  if (t->speed_high - t->speed_low < CHANGING * t->speed || !t->tracks)
    return;
  eo_text_add(text, "  rpm and m/s2 of stretches:");
  for (int i = 0; i < t->tracks; i++)
    eo_text_print(text, " %.5g|%.4g", t->track[i].speed * 30 / M_PI, t->track[i].rms);
  eo_text_add(text, "\n");
}

void eo_measurement_summary(const struct eo_measurement *m, const struct eo_measurement_label *label,
                            struct eo_text *text)
{
  const struct eo_transmission *t = &m->transmission;
  char torque[40] = "torque not known";
  if (label->torque > 0)
    snprintf(torque, sizeof torque, "%.6g N m", label->torque);
  eo_text_print(text, "%s: %s, %s, %s end, %lld rows\n", label->file ? label->file : "recording",
                label->unmodified ? "unmodified" : "modified", torque, eo_result_end[label->end], (long long)m->rows);
  for (int i = 0; label->notes && i < label->notes->count && i < EO_NOTES; i++)
    eo_text_print(text, "  note: %s\n", label->notes->text[i]);
  for (int i = 0; i < m->findings.count && i < EO_MAX_FINDINGS; i++)
    eo_text_print(text, "  %s: %s\n", eo_severity_name(m->findings.finding[i].severity), m->findings.finding[i].text);
  if (m->refused) {
    eo_text_add(text, "  No result.\n");
    return;
  }
  eo_text_print(
      text, "  %.7g rpm, %.4g turns; RMS %.4f +- %.4f m/s2 of %d mesh orders (spectrum %.4f, with sidebands %.4f)\n",
      t->speed * 30 / M_PI, t->revolutions[EO_PINION], t->rms, t->rms_sigma, t->harmonics, t->rms_spectrum,
      t->rms_band);
  eo_text_print(
      text,
      "  TE of the mesh %.4g um peak to peak; first shaft orders %.4g um pinion, %.4g um gear; residual %.3g um\n",
      1e6 * t->mesh_peak_to_peak, 1e6 * cabs(t->shaft[EO_PINION][0].amplitude),
      1e6 * cabs(t->shaft[EO_GEAR][0].amplitude), 1e6 * t->residual);
  print_order_tracks(t, text);
}

static void fill_sheet(const struct eo_comparison *c, const struct eo_measured *m, struct eo_text_table *sheet,
                       int digits)
{
  for (int i = 0; i < c->count; i++) {
    eo_text_table_string(sheet, m[i].name);
    eo_text_table_string(sheet, m[i].unmodified ? "unmodified" : "modified");
    for (int k = 0; k < COLUMNS; k++)
      eo_text_table_number(sheet, columns[k].value(&m[i], &c->point[i]), columns[k].unit, digits);
    eo_text_table_string(sheet, c->point[i].reason);
  }
}

static void print_orders(const struct eo_comparison *c, const struct eo_measured *m, struct eo_text *text)
{
  for (int i = 0; i < c->count; i++) {
    eo_text_print(text, "  %s, orders, measured | predicted m/s2:", m[i].name);
    for (int h = 0; h < m[i].harmonics; h++)
      eo_text_print(text, "  %.3g|%.3g", m[i].order[h].acceleration, c->point[i].prediction.acceleration[h]);
    eo_text_add(text, "\n");
  }
}

void eo_comparison_summary(const struct eo_comparison *c, const struct eo_measured *m, struct eo_text *text)
{
  static const char *const headings[] = {"file",           "label", "torque N m", "speed rpm", "measured m/s2", "+-",
                                         "predicted m/s2", "ratio", "likeness",   "TE um",     "remark"};
  struct eo_text_table sheet;
  eo_text_add(text,
              "\nMeasured and predicted (rotational acceleration at the encoders' end, at the measured speed):\n");
  eo_text_table_init(&sheet, COLUMNS + 3, headings);
  fill_sheet(c, m, &sheet, 4);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  print_orders(c, m, text);
  for (int i = 0; i < c->reductions; i++) {
    const struct eo_reduction *r = &c->reduction[i];
    eo_text_print(text,
                  "  %.5g N m, %.5g rpm: the modification takes %.1f +- %.1f %% off the measured RMS, %.1f %% off the "
                  "predicted one.\n",
                  r->torque, r->speed * 30 / M_PI, 100 * r->measured, 100 * r->measured_sigma, 100 * r->predicted);
  }
}

void eo_comparison_csv(const struct eo_comparison *c, const struct eo_measured *m, struct eo_text *text)
{
  const char *headings[COLUMNS + 3] = {"file", "label"};
  struct eo_text_table sheet;
  for (int k = 0; k < COLUMNS; k++)
    headings[2 + k] = columns[k].key;
  headings[COLUMNS + 2] = "reason";
  eo_text_table_init(&sheet, COLUMNS + 3, headings);
  fill_sheet(c, m, &sheet, EO_DIGITS_NUMBER);
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

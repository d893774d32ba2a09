/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measured beside predicted: JSON, tables for people, CSV. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "format/json.h"
#include "document/measure_order.h"
#include "document/measurement_document.h"
#include "document/result_private.h"
#include "format/text_table.h"
#include "gear/names.h"

enum { CURVE = 128 };

static const struct eo_unit percent = {"percent", "%", 100, true};

/* One number of every measurement. */
typedef double column_function(const struct eo_measured *m, const struct eo_compared *p);

static double torque(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, measured->torque;
}
static double speed(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, measured->speed;
}
static double measured_rms(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, measured->rms;
}
static double measured_sigma(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, measured->rms_sigma;
}
static double predicted_rms(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)measured, compared->prediction.rms;
}
static double ratio(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)measured, compared->ratio;
}
static double likeness(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)measured, compared->likeness;
}
static double predicted_peak(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)measured, compared->prediction.peak_to_peak;
}

enum { TORQUE, SPEED, MEASURED_RMS, MEASURED_SIGMA, PREDICTED_RMS, RATIO, LIKENESS, PREDICTED_PEAK, COLUMNS };
static const struct column {
  column_function *value;
  const struct eo_unit *unit;
} columns[COLUMNS] = {
    [TORQUE] = {torque, &eo_unit_Nm},
    [SPEED] = {speed, &eo_unit_rpm},
    [MEASURED_RMS] = {measured_rms, &eo_unit_m_per_s2},
    [MEASURED_SIGMA] = {measured_sigma, &eo_unit_m_per_s2},
    [PREDICTED_RMS] = {predicted_rms, &eo_unit_m_per_s2},
    [RATIO] = {ratio, NULL},
    [LIKENESS] = {likeness, NULL},
    [PREDICTED_PEAK] = {predicted_peak, &eo_unit_um},
};

/* What a document is written from. */
struct source {
  const struct eo_comparison *comparison;
  const struct eo_measured *measured; /* [count] */
  const int64_t *id;                  /* [count] of stored ones; NULL: they are files */
};

static json_t *write_column(const void *source, int column)
{
  const struct source *this_source = source;
  double value[EO_MOST_MEASURED];
  for (int i = 0; i < this_source->comparison->count; i++)
    value[i] = columns[column].value(&this_source->measured[i], &this_source->comparison->point[i]);
  return eo_json_reals(this_source->comparison->count, value, 1, columns[column].unit, EO_DIGITS_NUMBER);
}

static json_t *write_torques(const void *source)
{
  return write_column(source, TORQUE);
}

static json_t *write_speeds(const void *source)
{
  return write_column(source, SPEED);
}

static json_t *write_measured_rms(const void *source)
{
  return write_column(source, MEASURED_RMS);
}

static json_t *write_measured_sigma(const void *source)
{
  return write_column(source, MEASURED_SIGMA);
}

static json_t *write_predicted_rms(const void *source)
{
  return write_column(source, PREDICTED_RMS);
}

static json_t *write_ratios(const void *source)
{
  return write_column(source, RATIO);
}

static json_t *write_likeness(const void *source)
{
  return write_column(source, LIKENESS);
}

static json_t *write_predicted_peaks(const void *source)
{
  return write_column(source, PREDICTED_PEAK);
}

/* A list with one value for each measurement. */
typedef json_t *word_function(const struct eo_measured *m, const struct eo_compared *p);

static json_t *write_words(const void *source, word_function *word)
{
  const struct source *this_source = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < this_source->comparison->count; i++)
    eo_list_add(&list, word(&this_source->measured[i], &this_source->comparison->point[i]));
  return eo_object_close(&list);
}

static json_t *file_of(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, json_string(measured->name);
}

static json_t *label_of(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, json_string(eo_measure_label[measured->unmodified]);
}

static json_t *end_of(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)compared, json_string(eo_end_name[measured->end]);
}

static json_t *outlier_of(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)measured, json_boolean(compared->outlier);
}

static json_t *reason_of(const struct eo_measured *measured, const struct eo_compared *compared)
{
  return (void)measured, *compared->reason ? json_string(compared->reason) : json_null();
}

static json_t *write_files(const void *source)
{
  return write_words(source, file_of);
}

static json_t *write_labels(const void *source)
{
  return write_words(source, label_of);
}

static json_t *write_ends(const void *source)
{
  return write_words(source, end_of);
}

static json_t *write_outliers(const void *source)
{
  return write_words(source, outlier_of);
}

static json_t *write_reasons(const void *source)
{
  return write_words(source, reason_of);
}

enum { FIRST_NUMBER = 3 }; /* row of the first of the numbers, which stand in the order of `columns` */
static const struct eo_outline_row column_rows[] = {
    EO_KEY("file", "[text]", "as it was uploaded", .write = write_files),
    EO_KEY("label", "[word]", "which pair was measured", .words = eo_measure_label, .write = write_labels),
    EO_KEY("end", "[word]", "where the encoders sat", .words = eo_end_name, .write = write_ends),
    EO_KEY("torque_Nm", "[number]", "on the pinion shaft", .unit = &eo_unit_Nm, .write = write_torques),
    EO_KEY("speed_rpm", "[number]", "measured mean speed of the pinion", .unit = &eo_unit_rpm, .write = write_speeds),
    EO_KEY("measured_rms_m_per_s2", "[number?]", "rotational acceleration of the mesh orders",
           .unit = &eo_unit_m_per_s2, .write = write_measured_rms),
    EO_KEY("measured_sigma_m_per_s2", "[number?]", "its standard deviation", .unit = &eo_unit_m_per_s2,
           .write = write_measured_sigma),
    EO_KEY("predicted_rms_m_per_s2", "[number?]", "of the same orders; null without a periodic vibration",
           .unit = &eo_unit_m_per_s2, .write = write_predicted_rms),
    EO_KEY("ratio", "[number?]", "measured over predicted", .write = write_ratios),
    EO_KEY("likeness", "[number?]",
           "correlation of both curves of the transmission error when they are in phase, -1..1",
           .write = write_likeness),
    EO_KEY("predicted_te_peak_to_peak_um", "[number?]", "of the predicted dynamic transmission error",
           .unit = &eo_unit_um, .write = write_predicted_peaks),
    EO_KEY("outlier", "[flag]", "does not fit the others", .write = write_outliers),
    EO_KEY("reason", "[text?]", "why", .write = write_reasons),
};
static const struct eo_outline column_outline = EO_OUTLINE("ComparedColumns", column_rows);

/* One measurement beside its prediction. */
struct detail {
  const struct eo_measured *measured;
  const struct eo_compared *compared;
  double measured_te[CURVE], predicted_te[CURVE]; /* in phase */
};

static json_t *write_measured_orders(const void *source)
{
  const struct eo_measured *measured = ((const struct detail *)source)->measured;
  double value[EO_MESH_ORDERS];
  for (int h = 0; h < measured->harmonics; h++)
    value[h] = measured->order[h].acceleration;
  return eo_json_reals(measured->harmonics, value, 1, &eo_unit_m_per_s2, EO_DIGITS_CURVE);
}

static json_t *write_predicted_orders(const void *source)
{
  const struct detail *detail = source;
  return eo_json_reals(detail->measured->harmonics, detail->compared->prediction.acceleration, 1, &eo_unit_m_per_s2,
                       EO_DIGITS_CURVE);
}

static json_t *write_measured_amplitudes(const void *source)
{
  const struct eo_measured *measured = ((const struct detail *)source)->measured;
  double value[EO_MESH_ORDERS];
  for (int h = 0; h < measured->harmonics; h++)
    value[h] = cabs(measured->order[h].amplitude);
  return eo_json_reals(measured->harmonics, value, 1, &eo_unit_um, EO_DIGITS_CURVE);
}

static json_t *write_predicted_amplitudes(const void *source)
{
  const struct detail *detail = source;
  double value[EO_MESH_ORDERS];
  for (int h = 0; h < detail->measured->harmonics; h++)
    value[h] = cabs(detail->compared->prediction.order[h]);
  return eo_json_reals(detail->measured->harmonics, value, 1, &eo_unit_um, EO_DIGITS_CURVE);
}

static const struct eo_outline_row order_rows[] = {
    EO_KEY("measured_m_per_s2", "[number?]", "acceleration of mesh orders 1, 2, ...", .unit = &eo_unit_m_per_s2,
           .write = write_measured_orders),
    EO_KEY("predicted_m_per_s2", "[number?]", "the same, predicted", .unit = &eo_unit_m_per_s2,
           .write = write_predicted_orders),
    EO_KEY("measured_um", "[number?]", "amplitude of the transmission error at these orders", .unit = &eo_unit_um,
           .write = write_measured_amplitudes),
    EO_KEY("predicted_um", "[number?]", "the same, predicted", .unit = &eo_unit_um,
           .write = write_predicted_amplitudes),
};
static const struct eo_outline order_outline = EO_OUTLINE("ComparedOrders", order_rows);

static json_t *write_positions(const void *source)
{
  double position[CURVE];
  (void)source;
  for (int i = 0; i < CURVE; i++)
    position[i] = (double)i / CURVE;
  return eo_json_reals(CURVE, position, 1, NULL, EO_DIGITS_CURVE);
}

static json_t *write_measured_te(const void *source)
{
  return eo_json_reals(CURVE, ((const struct detail *)source)->measured_te, 1, &eo_unit_um, EO_DIGITS_CURVE);
}

static json_t *write_predicted_te(const void *source)
{
  return eo_json_reals(CURVE, ((const struct detail *)source)->predicted_te, 1, &eo_unit_um, EO_DIGITS_CURVE);
}

static json_t *write_shift(const void *source)
{
  return eo_json_quantity(((const struct detail *)source)->compared->shift, NULL);
}

static const struct eo_outline_row curve_rows[] = {
    EO_KEY("position", "[number]", "phase of the mesh cycle, 0..1", .write = write_positions),
    EO_KEY("measured_um", "[number?]", "transmission error of the mesh, over position", .unit = &eo_unit_um,
           .write = write_measured_te),
    EO_KEY("predicted_um", "[number?]", "the same, predicted, shifted to the phase that fits best", .unit = &eo_unit_um,
           .write = write_predicted_te),
    EO_KEY("shift", "number?", "by how much, in mesh cycles", .write = write_shift),
};
static const struct eo_outline curve_outline = EO_OUTLINE("ComparedCurves", curve_rows);

static json_t *write_detail_orders(const void *detail)
{
  return eo_outline_encode(&order_outline, detail);
}

static json_t *write_detail_curves(const void *detail)
{
  return eo_outline_encode(&curve_outline, detail);
}

static const struct eo_outline_row detail_rows[] = {
    EO_KEY("orders", "object", "side by side", .outline = &order_outline, .write = write_detail_orders),
    EO_KEY("te", "object", "in phase", .outline = &curve_outline, .write = write_detail_curves),
};
static const struct eo_outline detail_outline = EO_OUTLINE("ComparedDetail", detail_rows);

static json_t *write_columns(const void *source)
{
  return eo_outline_encode(&column_outline, source);
}

static json_t *write_details(const void *source)
{
  const struct source *this_source = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < this_source->comparison->count; i++) {
    struct detail detail = {&this_source->measured[i], &this_source->comparison->point[i], {0}, {0}};
    eo_comparison_curves(detail.measured, detail.compared, CURVE, detail.measured_te, detail.predicted_te);
    eo_list_add(&list, eo_outline_encode(&detail_outline, &detail));
  }
  return eo_object_close(&list);
}

/* A reduction with the name of its file. */
struct named_reduction {
  struct eo_reduction reduction;
  const char *file;
  bool stored;
  int64_t id;
};

static const struct eo_outline_row reduction_rows[] = {
    EO_KEY("file", "text", "of the modified pair", EO_AT(struct named_reduction, file)),
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm,
           EO_AT(struct named_reduction, reduction.torque)),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm,
           EO_AT(struct named_reduction, reduction.speed)),
    EO_KEY("unmodified_measurements", "integer", "that it is compared with",
           EO_AT(struct named_reduction, reduction.unmodified)),
    EO_KEY("measured_percent", "number?", "how much less the modified pair vibrates, per cent of the unmodified one",
           .unit = &percent, EO_AT(struct named_reduction, reduction.measured)),
    EO_KEY("sigma_percent", "number?", "standard deviation of it", .unit = &percent,
           EO_AT(struct named_reduction, reduction.measured_sigma)),
    EO_KEY("predicted_percent", "number?", "the same, predicted", .unit = &percent,
           EO_AT(struct named_reduction, reduction.predicted)),
    EO_KEY("id", "integer", "number of the measurement", .when = "of stored measurements",
           EO_AT(struct named_reduction, id), EO_IF(struct named_reduction, stored)),
};
static const struct eo_outline reduction_outline = EO_OUTLINE("ComparedReduction", reduction_rows);

static json_t *write_reductions(const void *source)
{
  const struct source *this_source = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < this_source->comparison->reductions; i++) {
    const struct eo_reduction *reduction = &this_source->comparison->reduction[i];
    const int64_t *id = this_source->id;
    const struct named_reduction named = {*reduction, this_source->measured[reduction->modified].name, id != NULL,
                                          id ? id[reduction->modified] : 0};
    eo_list_add(&list, eo_outline_encode(&reduction_outline, &named));
  }
  return eo_object_close(&list);
}

static json_t *write_ratio(const void *source)
{
  return eo_json_quantity(((const struct source *)source)->comparison->ratio, NULL);
}

static json_t *write_spread(const void *source)
{
  return eo_json_quantity(((const struct source *)source)->comparison->spread, NULL);
}

static const struct eo_outline_row comparison_rows[] = {
    EO_KEY("measurements", "object", "columns over the measurements", .outline = &column_outline,
           .write = write_columns),
    EO_KEY("details", "[object]", "one for each measurement", .outline = &detail_outline, .write = write_details),
    EO_KEY("reductions", "[object]",
           "one for each measurement of the modified pair with one of the unmodified pair at its torque and speed",
           .outline = &reduction_outline, .write = write_reductions),
    EO_KEY("ratio", "number?", "median of measured over predicted RMS", .write = write_ratio),
    EO_KEY("spread", "number?", "robust relative standard deviation about it", .write = write_spread),
};
const struct eo_outline eo_comparison_outline = EO_OUTLINE("ComparisonOfFiles", comparison_rows);

json_t *eo_comparison_encode(const struct eo_comparison *comparison, const struct eo_measured *measured,
                             const int64_t *id)
{
  const struct source source = {comparison, measured, id};
  return eo_outline_encode(&eo_comparison_outline, &source);
}

static void fill_sheet(const struct eo_comparison *comparison, const struct eo_measured *measured,
                       struct eo_text_table *sheet, int digits)
{
  for (int i = 0; i < comparison->count; i++) {
    eo_text_table_string(sheet, measured[i].name);
    eo_text_table_string(sheet, eo_measure_label[measured[i].unmodified]);
    for (int k = 0; k < COLUMNS; k++)
      eo_text_table_number(sheet, columns[k].value(&measured[i], &comparison->point[i]), columns[k].unit, digits);
    eo_text_table_string(sheet, comparison->point[i].reason);
  }
}

static void print_orders(const struct eo_comparison *comparison, const struct eo_measured *measured,
                         struct eo_text *text)
{
  for (int i = 0; i < comparison->count; i++) {
    eo_text_print(text, "  %s, orders, measured | predicted m/s2:", measured[i].name);
    for (int h = 0; h < measured[i].harmonics; h++)
      eo_text_print(text, "  %.3g|%.3g", measured[i].order[h].acceleration,
                    comparison->point[i].prediction.acceleration[h]);
    eo_text_add(text, "\n");
  }
}

void eo_comparison_summary(const struct eo_comparison *comparison, const struct eo_measured *measured,
                           struct eo_text *text)
{
  static const char *const headings[] = {"file",           "label", "torque N m", "speed rpm", "measured m/s2", "+-",
                                         "predicted m/s2", "ratio", "likeness",   "TE um",     "remark"};
  struct eo_text_table sheet;
  eo_text_add(text,
              "\nMeasured and predicted (rotational acceleration at the encoders' end, at the measured speed):\n");
  eo_text_table_init(&sheet, COLUMNS + 3, headings);
  fill_sheet(comparison, measured, &sheet, 4);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  print_orders(comparison, measured, text);
  for (int i = 0; i < comparison->reductions; i++) {
    const struct eo_reduction *reduction = &comparison->reduction[i];
    eo_text_print(text,
                  "  %.5g N m, %.5g rpm: the modification takes %.1f +- %.1f %% off the measured RMS, %.1f %% off the "
                  "predicted one.\n",
                  reduction->torque, reduction->speed * 30 / M_PI, 100 * reduction->measured,
                  100 * reduction->measured_sigma, 100 * reduction->predicted);
  }
}

void eo_comparison_csv(const struct eo_comparison *comparison, const struct eo_measured *measured, struct eo_text *text)
{
  const char *headings[COLUMNS + 3] = {"file", "label"};
  struct eo_text_table sheet;
  for (int k = 0; k < COLUMNS; k++)
    headings[2 + k] = column_rows[FIRST_NUMBER + k].key;
  headings[COLUMNS + 2] = "reason";
  eo_text_table_init(&sheet, COLUMNS + 3, headings);
  fill_sheet(comparison, measured, &sheet, EO_DIGITS_NUMBER);
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

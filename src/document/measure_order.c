/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/measure_order.h"

#include <math.h>

#include "gear/names.h"

static const char *const run_ups[] = {"left out", "included", NULL};
const char *const eo_measure_label[3] = {"modified", "unmodified", NULL};

#define LABEL_HELP "whether the pair had its modification"

/* What all three say, in the order of the form. */
#define COMMON_ROWS                                                                                         \
  EO_NUMBER_DERIVED(struct eo_measure_order, torque, "torque_Nm", &eo_unit_Nm, 1e-3, 1e8,                   \
                    "as recorded, else asked for", "on the pinion"),                                        \
      EO_NUMBER_DERIVED(struct eo_measure_order, speed, "speed_rpm", &eo_unit_rpm, 0.1, 1e6, "as measured", \
                        "of the pinion"),                                                                   \
      EO_CHOICE(struct eo_measure_order, end, "end", eo_end_name, EO_RIGHT, "where the encoders sit"),      \
      EO_INTEGER_DERIVED(struct eo_measure_order, harmonics, "harmonics", 1, EO_MESH_ORDERS, "8",           \
                         "mesh orders that are measured"),                                                  \
      EO_INTEGER_DERIVED(struct eo_measure_order, part, "part", 1, EO_PARTS, "the one with the most turns", \
                         "which stretch without a stop is measured, as `parts` of the result counts them"), \
      EO_CHOICE(struct eo_measure_order, run_up, "run_up", run_ups, EO_RUN_UP_LEFT_OUT,                     \
                "what leads to a long steady state: left out, or measured with it"),                        \
      EO_NUMBER(struct eo_measure_order, from, "from_s", NULL, 0, 1e9, 0,                                   \
                "where what is measured begins, after the first row"),                                      \
      EO_NUMBER_DERIVED(struct eo_measure_order, to, "to_s", NULL, 0, 1e9, "the end",                       \
                        "where it ends, after the first row"),                                              \
      EO_DOCUMENT(struct eo_measure_order, layout, "layout", "AskedLayout", EO_FIELD_NULLABLE,              \
                  "what the columns are; without it they are recognised")

static const struct eo_field form_fields[] = {
    {.key = "design",
     .kind = EO_FIELD_SEED,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_measure_order, design),
     .low = 1,
     .high = 9007199254740991.0,
     .help = "number of the stored design that was measured"},
    {.key = "label",
     .kind = EO_FIELD_CHOICE,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_measure_order, label),
     .choices = eo_measure_label,
     .fallback = NAN,
     .help = LABEL_HELP},
    COMMON_ROWS,
};
const struct eo_table eo_measure_form_table = EO_TABLE("a measurement", struct eo_measure_order, form_fields);

#define OPTION_ROWS \
  EO_CHOICE(struct eo_measure_order, label, "label", eo_measure_label, EO_MEASURE_MODIFIED, LABEL_HELP), COMMON_ROWS
static const struct eo_field option_fields[] = {OPTION_ROWS};
const struct eo_table eo_measure_option_table = EO_TABLE("what is said of the recordings", struct eo_measure_order,
                                                         option_fields);

static const struct eo_field row_fields[] = {
    {.key = "file",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_measure_order, file),
     .low = 1,
     .count = sizeof((struct eo_measure_order *)0)->file,
     .help = "the recording, relative to the list"},
    OPTION_ROWS,
};
static const struct eo_table row_table = EO_TABLE("a recording", struct eo_measure_order, row_fields);

static const struct eo_field list_fields[] = {
    EO_LIST(struct eo_measure_list, row, count, "measurements", &row_table, 1, EO_MOST_MEASURED,
            "a row for each recording"),
};
const struct eo_table eo_measure_list_table = EO_TABLE("a list of recordings", struct eo_measure_list, list_fields);

void eo_measure_order_check(const struct eo_measure_order *order, const struct eo_path *path, struct eo_faults *faults)
{
  const struct eo_path place = {path, "to_s", 0};
  if (order->to > 0 && order->to <= order->from)
    eo_faults_at(faults, &place, "Must be after from_s.");
}

void eo_measure_order_take(const struct eo_measure_order *order, const struct eo_design *design,
                           struct eo_measure_request *request)
{
  request->unmodified = order->label == EO_MEASURE_UNMODIFIED;
  request->torque = order->torque;
  request->stated_speed = order->speed;
  request->end = order->end;
  request->harmonics = order->harmonics;
  request->part = (struct eo_part_choice){.part = order->part,
                                          .whole = order->run_up == EO_RUN_UP_INCLUDED,
                                          .from = order->from,
                                          .to = order->to > 0 ? order->to : 0};
  request->layout = order->layout;
  for (int i = 0; i < design->load_cases; i++) {
    double speed = design->load_case[i].speed;
    request->speed[0] = i ? fmin(request->speed[0], speed) : speed;
    request->speed[1] = i ? fmax(request->speed[1], speed) : speed;
  }
}

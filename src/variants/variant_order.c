/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_order.h"

#include "document/result_scalars.h"

const char *const eo_study_samplings[] = {"factorial", "latin", "sobol", NULL};

static const struct eo_field axis_fields[] = {
    EO_TEXT(struct eo_study_axis, key, "key",
            "path of the number, load_cases.1.torque_Nm, or a symbol of the standards; * or `both` in it: every load "
            "case, both ends; keys joined by + take the same value; a unit in brackets behind it: the values are in "
            "that"),
    EO_SERIES(struct eo_study_axis, values, "values", NULL, EO_STUDY_MOST_LEVELS, -1e12, 1e12, 0,
              "one after the other"),
    EO_TEXT_DERIVED(struct eo_study_axis, words, "words", 0, "none",
                    "in place of values for keys that are words, true or false: separated by commas"),
    EO_NUMBER_DERIVED(struct eo_study_axis, from, "from", NULL, -1e12, 1e12, "no range", "in place of values: a range"),
    EO_NUMBER_DERIVED(struct eo_study_axis, to, "to", NULL, -1e12, 1e12, "from", "its end"),
    EO_INTEGER_DERIVED(struct eo_study_axis, points, "points", 1, EO_STUDY_MOST_LEVELS, "both ends of the range",
                       "of a full factorial study: how many, equally spaced, ends included"),
};
static const struct eo_table axis_table = EO_TABLE("what varies", struct eo_study_axis, axis_fields);

static const struct eo_field order_fields[] = {
    {.key = "name",
     .kind = EO_FIELD_TEXT,
     .offset = offsetof(struct eo_study_order, name),
     .count = sizeof((struct eo_study_order *)0)->name,
     .fallback_text = "",
     .help = "for people; that of the design where there is none"},
    EO_DOCUMENT(struct eo_study_order, design, "design", "Design", EO_FIELD_REQUIRED,
                "what is varied; what it does not state follows in every variant"),
    EO_LIST(struct eo_study_order, axis, axes, "vary", &axis_table, 0, EO_STUDY_AXES, "what varies"),
    {.key = "table",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_ELSEWHERE | EO_FIELD_NULLABLE,
     .count = EO_STUDY_BYTES,
     .derived = "none",
     .help = "in place of vary: comma-separated values, a heading of keys (units in brackets) and a row for each "
             "variant"},
    EO_CHOICE(
        struct eo_study_order, sampling, "sampling", eo_study_samplings, EO_STUDY_FACTORIAL,
        "factorial: every value of one with every value of the others; latin, sobol: samples that fill the space"),
    EO_INTEGER(struct eo_study_order, samples, "samples", 1, EO_STUDY_MOST_ROWS, 64, "of a latin or sobol study"),
    {.key = "seed",
     .kind = EO_FIELD_SEED,
     .offset = offsetof(struct eo_study_order, seed),
     .low = 0,
     .high = 9007199254740991.,
     .fallback = 1,
     .help = "of a latin or sobol study"},
    {.key = "columns",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_NULLABLE,
     .offset = offsetof(struct eo_study_order, columns),
     .count = sizeof((struct eo_study_order *)0)->columns,
     .derived = "objectives, and for each load case what they are made of",
     .help = "numbers of the result to be kept, by their path; separated by commas, * for anything"},
};
const struct eo_table eo_study_order_table = EO_TABLE("a study", struct eo_study_order, order_fields);

bool eo_study_order_decode(const json_t *document, struct eo_study_order *order, const char **table,
                           struct eo_faults *faults)
{
  const json_t *text = json_object_get(document, "table");
  *order = (struct eo_study_order){0};
  *table = json_string_value(text);
  eo_table_decode(&eo_study_order_table, document, NULL, order, faults);
  if (text && !json_is_null(text) && !*table)
    eo_faults_add(faults, "/table", "A text of comma-separated values is needed.");
  if (*table && order->axes)
    eo_faults_add(faults, "/table", "A study has what varies or a table, not both.");
  if (!*table && !order->axes && !faults->count)
    eo_faults_add(faults, "/vary", "Nothing varies: name keys with values, or give a table.");
  if (!*order->columns)
    snprintf(order->columns, sizeof order->columns, "%s", eo_scalars_usual);
  return !faults->count;
}

void eo_study_order_done(struct eo_study_order *order)
{
  eo_table_done(&eo_study_order_table, order);
}

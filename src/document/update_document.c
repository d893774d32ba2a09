/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/update_document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "format/table.h"
#include "document/result_private.h"
#include "format/text_table.h"

static const double LARGE_CONDITION = 1e6;

/* The range of each input that can be fitted, as the document has it; NaN where it is not asked for. */
struct ranges {
  double range[EO_UNKNOWNS][2];
};
/* Unit, lowest and highest that may be asked for, what a form starts with, help; in the order of the inputs. */
#define STIFFNESS &eo_unit_N_per_um, 1e-3, 1e6
#define ANGLE &eo_unit_deg, -2, 2, -0.1, 0.1
#define PINION_BEARING_RANGE STIFFNESS, 100, 5000, "lowest, highest; transverse, per end of the pinion"
#define GEAR_BEARING_RANGE STIFFNESS, 100, 5000, "lowest, highest; transverse, per end of the gear"
#define MESH_DAMPING_RANGE NULL, 1e-6, 1, 0.02, 0.3, "lowest, highest; of the mesh"
#define GEAR_AXIAL_RANGE STIFFNESS, 10, 2000, "lowest, highest; at either end of the gear"
#define PINION_AXIAL_RANGE STIFFNESS, 1, 1000, "lowest, highest; from the pinion to the ground"
#define IN_PLANE_RANGE ANGLE, "lowest, highest"
#define OUT_OF_PLANE_RANGE ANGLE, "lowest, highest"
#define IMPACT_PATCH_RANGE &eo_unit_mm, 0.1, 100, 0.5, 10, "lowest, highest; length of the patch at entering impacts"
#define FIELD(number, key_, unit_, low_, high_, usual_low, usual_high, help_) \
  {.key = key_,                                                               \
   .kind = EO_FIELD_NUMBERS,                                                  \
   .flags = EO_FIELD_ASCENDING | EO_FIELD_NULLABLE,                           \
   .offset = offsetof(struct ranges, range[number]),                          \
   .unit = unit_,                                                             \
   .low = low_,                                                               \
   .high = high_,                                                             \
   .count = 2,                                                                \
   .usual = (const double[]){usual_low, usual_high},                          \
   .derived = "not fitted",                                                   \
   .help = help_},
#define FILLED(...) FIELD(__VA_ARGS__)
#define ROW(name, key) FILLED(EO_UNKNOWN_##name, key, name##_RANGE)
static const struct eo_field range_fields[] = {EO_UNKNOWN_INPUTS(ROW)};
static const struct eo_table range_table = EO_TABLE("the inputs to be fitted", struct ranges, range_fields);

static const struct eo_unit *unit_of(enum eo_unknown unknown)
{
  return range_fields[unknown].unit;
}

struct order {
  struct ranges ranges;
  double model_error;
  uint64_t seed;
};
static const struct eo_field order_fields[] = {
    EO_OBJECT(struct order, ranges, "unknowns", &range_table, "at least one input with its range"),
    EO_NUMBER_DERIVED(struct order, model_error, "model_error", NULL, 1e-4, 1, "found from the misfit",
                      "of an order's acceleration in parts of the measured RMS"),
    {.key = "seed",
     .kind = EO_FIELD_SEED,
     .offset = offsetof(struct order, seed),
     .high = 9007199254740991,
     .fallback = 1,
     .help = "of the points where the search starts"},
};
const struct eo_table eo_update_table = EO_TABLE("an order of a fit", struct order, order_fields);

static void take_range(const char *key, const struct ranges *ranges, struct eo_update_settings *settings)
{
  for (int i = 0; i < EO_UNKNOWNS; i++)
    if (strcmp(key, range_fields[i].key) == 0 && !isnan(ranges->range[i][0]))
      settings->range[settings->unknowns++] = (struct eo_update_range){(enum eo_unknown)i, ranges->range[i][0],
                                                                       ranges->range[i][1]};
}

/* Inputs are fitted in the order in which they were named. */
void eo_update_decode(const json_t *document, struct eo_update_settings *settings, struct eo_faults *faults)
{
  const char *key;
  json_t *value;
  struct order order;
  int before = faults->count;
  eo_table_decode(&eo_update_table, document, NULL, &order, faults);
  *settings = (struct eo_update_settings){.seed = order.seed,
                                          .model_error = isnan(order.model_error) ? 0 : order.model_error};
  json_object_foreach(json_object_get(document, "unknowns"), key, value) take_range(key, &order.ranges, settings);
  if (!settings->unknowns && faults->count == before)
    eo_faults_add(faults, "/unknowns", "A fit names at least one input with its range.");
}

typedef void warning_function(void *context, const char *text);

static void each_warning(const struct eo_update *update, warning_function *take, void *context)
{
  char text[320];
  for (int i = 0; i < update->unknowns; i++) {
    const struct eo_updated *updated = &update->unknown[i];
    const char *name = eo_unknown_name(updated->unknown);
    if (updated->undetermined)
      snprintf(text, sizeof text, "The measurements do not determine %s: its 95 %% interval covers most of its range.",
               name);
    else if (updated->at_bound)
      snprintf(text, sizeof text, "%s stands at an end of its range; the measurements want it beyond.", name);
    else if (updated->twin >= 0)
      snprintf(text, sizeof text,
               "%s and %s cannot be told apart (correlation %.3f): only their combination is determined.", name,
               eo_unknown_name(update->unknown[updated->twin].unknown), updated->correlation);
    else
      continue;
    take(context, text);
  }
  if (update->within > 1) {
    snprintf(
        text, sizeof text,
        "%d different sets of inputs fit the measurements about equally well; the intervals span all of them. More "
        "torques or speeds would tell them apart.",
        update->within);
    take(context, text);
  }
  if (update->poor) {
    snprintf(text, sizeof text,
             "Even the best values leave %.0f %% of the measured RMS unexplained: something else than these inputs is "
             "different, or they lie outside the ranges.",
             100 * update->model_error * fmax(1, update->after));
    take(context, text);
  }
  if (update->condition > LARGE_CONDITION) {
    snprintf(text, sizeof text, "The condition number of the fit is %.2g: not all inputs are determined together.",
             update->condition);
    take(context, text);
  }
  if (!update->converged)
    take(context, "The fit stopped before it had converged.");
}

static void append_warning(void *context, const char *text)
{
  struct eo_object *object = context;
  object->failed = json_array_append_new(object->json, json_string(text)) != 0 || object->failed;
}

/* One input with the fit that it belongs to. */
struct fitted {
  const struct eo_update *update;
  struct eo_updated input;
};

static json_t *write_key(const void *source)
{
  return json_string(eo_unknown_name(((const struct fitted *)source)->input.unknown));
}

static json_t *write_before(const void *source)
{
  const struct eo_updated *input = &((const struct fitted *)source)->input;
  return eo_json_quantity(input->before, unit_of(input->unknown));
}

static json_t *write_value(const void *source)
{
  const struct eo_updated *input = &((const struct fitted *)source)->input;
  return eo_json_quantity(input->value, unit_of(input->unknown));
}

static json_t *write_range(const void *source)
{
  const struct eo_updated *input = &((const struct fitted *)source)->input;
  return eo_json_reals(2, (double[]){input->low, input->high}, 1, unit_of(input->unknown), EO_DIGITS_NUMBER);
}

static json_t *write_confidence(const void *source)
{
  const struct eo_updated *input = &((const struct fitted *)source)->input;
  return eo_json_reals(2, input->confidence, 1, unit_of(input->unknown), EO_DIGITS_CURVE);
}

static json_t *write_twin(const void *source)
{
  const struct fitted *fitted = source;
  return fitted->input.twin < 0 ? json_null()
                                : json_string(eo_unknown_name(fitted->update->unknown[fitted->input.twin].unknown));
}

static const struct eo_outline_row unknown_rows[] = {
    EO_KEY("key", "word", "the input, with the unit of all its numbers", .words = eo_unknown_names, .write = write_key),
    EO_KEY("before", "number?", "as the design had it", .write = write_before),
    EO_KEY("value", "number?", "found", .write = write_value),
    EO_KEY("range", "[number]", "lowest, highest, as asked for", .write = write_range),
    EO_KEY("confidence_95", "[number?]", "lowest, highest: the interval of 95 %, over all minima within reach",
           .write = write_confidence),
    EO_KEY("at_bound", "flag", "stands at an end of its range", EO_AT(struct fitted, input.at_bound)),
    EO_KEY("undetermined", "flag", "the measurements do not determine it", EO_AT(struct fitted, input.undetermined)),
    EO_KEY("same_as", "word?", "an input that it cannot be told apart from", .words = eo_unknown_names,
           .write = write_twin),
    EO_KEY("correlation", "number?", "with that input, or the one nearest to that",
           EO_AT(struct fitted, input.correlation)),
};
static const struct eo_outline unknown_outline = EO_OUTLINE("FittedInput", unknown_rows);

/* One minimum with the fit that it belongs to. */
struct found {
  const struct eo_update *update;
  struct eo_update_minimum minimum;
};

static json_t *write_values(const void *source)
{
  const struct found *found = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < found->update->unknowns; i++) {
    const struct eo_unit *unit = unit_of(found->update->unknown[i].unknown);
    eo_list_add(&list, eo_json_quantity(found->minimum.value[i], unit));
  }
  return eo_object_close(&list);
}

static json_t *write_intervals(const void *source)
{
  const struct found *found = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < found->update->unknowns; i++) {
    const struct eo_unit *unit = unit_of(found->update->unknown[i].unknown);
    json_t *interval = found->minimum.within ? eo_json_reals(2, found->minimum.confidence[i], 1, unit, EO_DIGITS_CURVE)
                                             : json_null();
    eo_list_add(&list, interval);
  }
  return eo_object_close(&list);
}

static const struct eo_outline_row minimum_rows[] = {
    EO_KEY("values", "[number?]", "of the inputs, in their order and units", .write = write_values),
    EO_KEY("confidence_95", "[[number?]]", "lowest, highest of each, about this minimum alone; null: out of reach",
           .write = write_intervals),
    EO_KEY("misfit", "number?", "root mean square of measured less predicted acceleration over its standard deviation",
           EO_AT(struct found, minimum.misfit)),
    EO_KEY("within", "flag", "the measurements do not rule it out at 95 %", EO_AT(struct found, minimum.within)),
};
static const struct eo_outline minimum_outline = EO_OUTLINE("FitMinimum", minimum_rows);

static const struct eo_outline_row misfit_rows[] = {
    EO_KEY("before", "number?", "root mean square of measured less predicted acceleration over its standard deviation",
           EO_AT(struct eo_update, before)),
    EO_KEY("after", "number?", "the same with the values found", EO_AT(struct eo_update, after)),
};
static const struct eo_outline misfit_outline = EO_OUTLINE("Misfit", misfit_rows);

static json_t *write_unknowns(const void *source)
{
  const struct eo_update *update = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < update->unknowns; i++) {
    const struct fitted fitted = {update, update->unknown[i]};
    eo_list_add(&list, eo_outline_encode(&unknown_outline, &fitted));
  }
  return eo_object_close(&list);
}

static json_t *write_correlation(const void *source)
{
  const struct eo_update *update = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < update->unknowns; i++)
    list.failed = json_array_append_new(
                      list.json, eo_json_reals(update->unknowns, update->correlation[i], 1, NULL, EO_DIGITS_MAP)) ||
                  list.failed;
  return eo_object_close(&list);
}

static json_t *write_misfit(const void *update)
{
  return eo_outline_encode(&misfit_outline, update);
}

static json_t *write_minima(const void *source)
{
  const struct eo_update *update = source;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < update->minima; i++) {
    const struct found found = {update, update->minimum[i]};
    eo_list_add(&list, eo_outline_encode(&minimum_outline, &found));
  }
  return eo_object_close(&list);
}

static json_t *write_warnings(const void *update)
{
  struct eo_object list = eo_list_open();
  each_warning(update, append_warning, &list);
  return eo_object_close(&list);
}

static const struct eo_outline_row update_rows[] = {
    EO_KEY("unknowns", "[object]", "one for each input that was fitted", .outline = &unknown_outline,
           .write = write_unknowns),
    EO_KEY("correlation", "[[number?]]", "of the inputs with each other", .write = write_correlation),
    EO_KEY("condition", "number?", "of the fit: how much worse its worst direction is determined than its best",
           EO_AT(struct eo_update, condition)),
    EO_KEY("misfit", "object", "before and after", .outline = &misfit_outline, .write = write_misfit),
    EO_KEY("model_error", "number?", "of an order's acceleration in parts of the measured RMS: stated, or found",
           EO_AT(struct eo_update, model_error)),
    EO_KEY("minima", "[object]", "places where the misfit has a minimum, the lowest first", .outline = &minimum_outline,
           .write = write_minima),
    EO_KEY("measurements", "integer", "used", EO_AT(struct eo_update, used)),
    EO_KEY("orders", "integer", "compared", EO_AT(struct eo_update, residuals)),
    EO_KEY("evaluations", "integer", "of all measurements", EO_AT(struct eo_update, evaluations)),
    EO_KEY("converged", "flag", "the fit ended by itself", EO_AT(struct eo_update, converged)),
    EO_KEY("warnings", "[text]", "in plain words", .write = write_warnings),
};
const struct eo_outline eo_update_outline = EO_OUTLINE("FitOfFiles", update_rows);

json_t *eo_update_encode(const struct eo_update *update)
{
  return eo_outline_encode(&eo_update_outline, update);
}

static void print_warning(void *context, const char *text)
{
  eo_text_print(context, "  warning: %s\n", text);
}

/* The other sets of values that fit about as well. */
static void print_minima(const struct eo_update *update, struct eo_text *text)
{
  for (int k = 1; k < update->minima; k++) {
    if (!update->minimum[k].within)
      continue;
    eo_text_add(text, "  or:");
    for (int i = 0; i < update->unknowns; i++) {
      const struct eo_unit *unit = unit_of(update->unknown[i].unknown);
      eo_text_print(text, " %s %.4g", eo_unknown_name(update->unknown[i].unknown),
                    eo_unit_out(unit, update->minimum[k].value[i]));
    }
    eo_text_print(text, " (misfit %.3g)\n", update->minimum[k].misfit);
  }
}

void eo_update_summary(const struct eo_update *update, struct eo_text *text)
{
  static const char *const headings[] = {"input", "before", "found", "95 % from", "to"};
  struct eo_text_table sheet;
  eo_text_print(
      text,
      "\nInputs fitted to %d orders of %d measurements (misfit %.3g before, %.3g after, in standard deviations):\n",
      update->residuals, update->used, update->before, update->after);
  eo_text_table_init(&sheet, 5, headings);
  for (int i = 0; i < update->unknowns; i++) {
    const struct eo_updated *updated = &update->unknown[i];
    eo_text_table_string(&sheet, eo_unknown_name(updated->unknown));
    const double value[] = {updated->before, updated->value, updated->confidence[0], updated->confidence[1]};
    for (int k = 0; k < 4; k++)
      eo_text_table_number(&sheet, value[k], unit_of(updated->unknown), 4);
  }
  eo_text_table_print(&sheet, 2, text);
  print_minima(update, text);
  eo_text_table_done(&sheet);
  each_warning(update, print_warning, text);
}

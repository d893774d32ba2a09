#include "document/result.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "document/geometry_table.h"
#include "document/result_parts.h"

#include <config.h>

const char *const eo_result_end[2] = {"left", "right"};
const char *const eo_result_member[2] = {"pinion", "gear"};

json_t *eo_result_number(double value, const struct eo_unit *unit)
{
  json_t *column = eo_result_column(1, &value, 1, unit, EO_DIGITS_NUMBER), *number = json_incref(json_array_get(column, 0));
  json_decref(column);
  return number;
}

json_t *eo_result_column(int count, const double *value, double scale, const struct eo_unit *unit, int digits)
{
  double *scaled = malloc(sizeof *scaled * (size_t)(count ? count : 1));
  for (int i = 0; i < count && scaled; i++)
    scaled[i] = value[i] * scale;
  json_t *column = scaled ? eo_json_reals(count, scaled, 1, unit, digits) : NULL;
  free(scaled);
  return column;
}

json_t *eo_result_end_column(const struct eo_result_source *source, int end, const double *value, double scale, const struct eo_unit *unit)
{
  int n = source->positions, lag = end == EO_RIGHT ? source->lag : 0;
  for (int j = 0; j < n; j++)
    source->scratch[j] = value[(j + n - lag) % n];
  return eo_result_column(n, source->scratch, scale, unit, EO_DIGITS_CURVE);
}

json_t *eo_result_map(const struct eo_result_source *source, int rows, int columns, const double *value, const struct eo_unit *unit)
{
  if (source->left_out & EO_RESULT_NO_MAPS)
    return json_null();
  json_t *map = json_array();
  for (int i = 0; i < rows && map; i++)
    if (json_array_append_new(map, eo_json_reals(columns, value + i * columns, 1, unit, EO_DIGITS_MAP)) != 0) {
      json_decref(map);
      map = NULL;
    }
  return map;
}

struct eo_result_object eo_result_open(void)
{
  struct eo_result_object object = {.json = json_object()};
  object.failed = !object.json;
  return object;
}

void eo_result_put(struct eo_result_object *object, const char *key, json_t *value)
{
  eo_json_put(object->json, key, value, &object->failed);
}

void eo_result_put_number(struct eo_result_object *object, const char *key, double value, const struct eo_unit *unit)
{
  eo_result_put(object, key, eo_result_number(value, unit));
}

json_t *eo_result_close(struct eo_result_object *object)
{
  if (!object->failed)
    return object->json;
  json_decref(object->json);
  return NULL;
}

/* ---- load cases ---- */

static const char *outcome_of(const struct eo_case_result *c)
{
  if (c->contact_failures > 0 || c->vibration.outcome == EO_VIBRATION_NOT_CONVERGED)
    return "not_converged";
  return c->vibration.outcome == EO_VIBRATION_CONTACT_LOST ? "contact_lost" : "converged";
}

json_t *eo_result_position(const struct eo_result_source *source)
{
  for (int j = 0; j < source->positions; j++)
    source->scratch[j] = source->pair->grid->position[j].phase;
  return eo_result_column(source->positions, source->scratch, 1 / source->pair->geometry.transverse_base_pitch, NULL, EO_DIGITS_CURVE);
}

/* The two halves of a load case, about as long to write. */
enum { HALVES = 2 };

static json_t *encode_contact(struct eo_result_source *source, int k)
{
  const struct eo_case_result *c = &source->evaluation->load_case[k];
  struct eo_result_object o = eo_result_open();
  eo_result_put_number(&o, "torque_Nm", c->load_case.torque, &eo_unit_Nm);
  eo_result_put_number(&o, "speed_rpm", c->load_case.speed, &eo_unit_rpm);
  eo_result_put_number(&o, "share", c->load_case.share, NULL);
  eo_result_put_number(&o, "normal_force_N", c->force, &eo_unit_N);
  eo_result_put(&o, "outcome", json_string(outcome_of(c)));
  eo_result_put(&o, "position", eo_result_position(source));
  eo_result_put(&o, "lte", eo_result_lte(source, c));
  eo_result_put(&o, "mesh_stiffness", eo_result_stiffness(source, c));
  eo_result_put(&o, "contact", eo_result_contact(source, k));
  return eo_result_close(&o);
}

static json_t *encode_consequences(struct eo_result_source *source, int k)
{
  const struct eo_case_result *c = &source->evaluation->load_case[k];
  struct eo_result_object o = eo_result_open();
  if (source->design->shafts.enabled)
    eo_result_put(&o, "body_deflection", eo_result_bodies(source, c));
  eo_result_put(&o, "impact", eo_result_impact(source, c));
  eo_result_put(&o, "root_stress", eo_result_root_stress(source, c));
  eo_result_put(&o, "vibration", eo_result_vibration(source, c));
  return eo_result_close(&o);
}

/* Takes both; NULL when one is. */
static json_t *unite(json_t *first, json_t *second)
{
  bool failed = !first || !second || json_object_update(first, second) != 0;
  json_decref(second);
  if (!failed)
    return first;
  json_decref(first);
  return NULL;
}

static json_t *encode_case(struct eo_result_source *source, int k)
{
  return unite(encode_contact(source, k), encode_consequences(source, k));
}

static json_t *encode_cases(struct eo_result_source *source)
{
  json_t *cases = json_array();
  for (int k = 0; k < source->evaluation->cases && cases; k++)
    if (json_array_append_new(cases, encode_case(source, k)) != 0) {
      json_decref(cases);
      cases = NULL;
    }
  return cases;
}

/* ---- objectives ---- */

json_t *eo_result_raw_case(const struct eo_load_case *load_case, const struct eo_objective_case *raw)
{
  struct eo_result_object o = eo_result_open();
  double known = raw->failed ? NAN : 1;
  eo_result_put_number(&o, "torque_Nm", load_case->torque, &eo_unit_Nm);
  eo_result_put_number(&o, "speed_rpm", load_case->speed, &eo_unit_rpm);
  eo_result_put_number(&o, "peak_to_peak_um", known * raw->peak_to_peak, &eo_unit_um);
  eo_result_put_number(&o, "impact_N", known * raw->impact, &eo_unit_N);
  eo_result_put_number(&o, "rms_m_per_s2", known * raw->rms, &eo_unit_m_per_s2);
  eo_result_put_number(&o, "contact_pressure_MPa", known * raw->contact_pressure, &eo_unit_MPa);
  eo_result_put_number(&o, "root_stress_MPa", known * raw->root_stress, &eo_unit_MPa);
  eo_result_put_number(&o, "edge_load_share", known * raw->edge_load_share, NULL);
  eo_result_put_number(&o, "contact_loss", known * raw->contact_loss, NULL);
  return eo_result_close(&o);
}

static json_t *encode_raw(const struct eo_result_source *source, const struct eo_objective_case *raw)
{
  json_t *cases = json_array();
  for (int k = 0; k < source->evaluation->cases && cases; k++)
    if (json_array_append_new(cases, eo_result_raw_case(&source->design->load_case[k], &raw[k])) != 0) {
      json_decref(cases);
      cases = NULL;
    }
  return cases;
}

void eo_result_put_value(struct eo_result_object *o, const struct eo_objective_value *value)
{
  double known = value->sums.failed ? NAN : 1;
  eo_result_put_number(o, "f1_um", known * value->sums.f[0], &eo_unit_um);
  eo_result_put_number(o, "f2_N", known * value->sums.f[1], &eo_unit_N);
  eo_result_put_number(o, "f3_m_per_s2", known * value->sums.f[2], &eo_unit_m_per_s2);
  eo_result_put_number(o, "J", value->objective, NULL);
  eo_result_put_number(o, "fitness", value->fitness, NULL);
  eo_result_put_number(o, "violation", value->violation, NULL);
}

static json_t *encode_objectives(const struct eo_result_source *source)
{
  const struct eo_analysis *a = source->analysis;
  struct eo_result_object o = eo_result_open(), unmodified = eo_result_open();
  eo_result_put_value(&o, &a->value);
  eo_result_put_value(&unmodified, &a->unmodified_value);
  eo_result_put(&o, "load_cases", encode_raw(source, source->evaluation->objective));
  eo_result_put(&unmodified, "load_cases", encode_raw(source, a->unmodified));
  eo_result_put(&o, "unmodified", eo_result_close(&unmodified));
  eo_result_put(&o, "scenarios", json_integer(a->scenarios));
  return eo_result_close(&o);
}

/* ---- the whole ---- */

static json_t *encode_timing(const struct eo_result_source *source)
{
  const struct eo_evaluation *r = source->evaluation;
  struct eo_result_object o = eo_result_open();
  const struct { const char *key; double milliseconds; } row[] = {
      {"preparation", 1e3 * source->pair->seconds}, {"unmodified", source->analysis->unmodified_ms}, {"static", r->static_ms},
      {"impact", r->impact_ms}, {"root", r->root_ms}, {"dynamics", r->dynamics_ms}, {"evaluation", source->analysis->design_ms}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    eo_result_put(&o, row[i].key, json_real(round(1e3 * row[i].milliseconds) / 1e3));
  return eo_result_close(&o);
}

static void put_identity(struct eo_result_object *o, const struct eo_design *design)
{
  char hash[EO_HASH_LENGTH + 1];
  eo_result_put(o, "program", json_string(PACKAGE_STRING));
  eo_result_put(o, "design", eo_design_encode(design));
  eo_result_put(o, "design_hash", eo_design_hash(design, hash, NULL) ? NULL : json_string(hash));
  eo_result_put(o, "evaluation_hash", eo_design_evaluation_hash(design, hash, NULL) ? NULL : json_string(hash));
  eo_result_put(o, "resolution", eo_table_encode(&eo_resolution_table, &design->resolution));
}

/* What stands before the load cases, and what stands behind them. */
static json_t *encode_head(struct eo_result_source *source)
{
  struct eo_result_object o = eo_result_open();
  put_identity(&o, source->design);
  eo_result_put(&o, "geometry", eo_table_encode(&eo_geometry_table, &source->pair->geometry));
  eo_result_put(&o, "modification", eo_result_modification(source));
  eo_result_put(&o, "unloaded_contact", eo_result_unloaded(source));
  return eo_result_close(&o);
}

static json_t *encode_tail(const struct eo_result_source *source, const struct eo_warnings *warnings)
{
  const struct eo_dynamics_modes *modes = &source->evaluation->modes;
  bool have_modes = source->analysis->want & EO_WANT_CURVES;
  struct eo_result_object o = eo_result_open();
  eo_result_put(&o, "objectives", encode_objectives(source));
  eo_result_put(&o, "eigenfrequencies_Hz", have_modes ? eo_json_reals(modes->n, modes->frequency, 1, &eo_unit_Hz, EO_DIGITS_CURVE) : json_null());
  eo_result_put(&o, "damping_ratios", have_modes ? eo_json_reals(modes->n, modes->damping_ratio, 1, NULL, EO_DIGITS_CURVE) : json_null());
  eo_result_put(&o, "warnings", eo_result_warnings(source, warnings));
  eo_result_put(&o, "timing_ms", encode_timing(source));
  return eo_result_close(&o);
}

static json_t *encode_all(struct eo_result_source *source, const struct eo_warnings *warnings)
{
  struct eo_result_object o = {.json = encode_head(source)};
  o.failed = !o.json;
  eo_result_put(&o, "load_cases", encode_cases(source));
  return unite(eo_result_close(&o), encode_tail(source, warnings));
}

/* What one thread needs. */
static bool init_source(struct eo_result_source *source, const struct eo_analysis *analysis, const struct eo_design *design, unsigned left_out)
{
  const struct eo_evaluation *r = analysis->evaluation;
  *source = (struct eo_result_source){.analysis = analysis, .evaluation = r, .pair = analysis->pair, .design = design, .ends = r->ends,
                                      .positions = r->positions, .lag = eo_evaluator_stagger(design, r->positions),
                                      .normal = cos(analysis->pair->geometry.base_helix_angle), .left_out = left_out};
  source->pattern = malloc(sizeof *source->pattern);
  source->scratch = calloc((size_t)r->positions, sizeof *source->scratch);
  if (source->pattern)
    eo_contact_pattern_init(source->pattern, source->pair->grid);
  return source->pattern && source->scratch;
}

static void done_source(struct eo_result_source *source)
{
  free(source->pattern);
  free(source->scratch);
}

json_t *eo_result_encode(const struct eo_analysis *analysis, const struct eo_design *design, const struct eo_warnings *warnings)
{
  return eo_result_encode_part(analysis, design, warnings, 0);
}

json_t *eo_result_encode_part(const struct eo_analysis *analysis, const struct eo_design *design, const struct eo_warnings *warnings, unsigned left_out)
{
  struct eo_result_source source;
  double edge_pressure[EO_MAX_LOAD_CASES][2];
  bool good = init_source(&source, analysis, design, left_out);
  source.edge_pressure = edge_pressure;
  json_t *result = good ? encode_all(&source, warnings) : NULL;
  done_source(&source);
  return result;
}

/* ---- as text, by parts: the head, then the halves of each load case ---- */

enum { WRITERS = 2, MOST_PARTS = 1 + HALVES * EO_MAX_LOAD_CASES };

struct writing {
  struct eo_result_source source[WRITERS]; /* [thread] */
  struct eo_text part[MOST_PARTS];
};

static json_t *encode_part(struct eo_result_source *source, int part)
{
  int k = (part - 1) / HALVES;
  if (part == 0)
    return encode_head(source);
  return part % HALVES ? encode_contact(source, k) : encode_consequences(source, k);
}

static enum eo_code write_part(void *context, int thread, int item, struct eo_error *error)
{
  struct writing *w = context;
  json_t *part = encode_part(&w->source[thread], item);
  if (part)
    eo_json_write(&w->part[item], part, EO_JSON_COMPACT);
  bool good = part && !w->part[item].failed;
  json_decref(part);
  return good ? EO_OK : eo_error_memory(error);
}

/* What stands in the braces of a part. */
static void add_members(struct eo_text *text, const struct eo_text *part)
{
  eo_text_add_bytes(text, part->data + 1, part->size - 2);
}

/* The parts as one object. */
static void join(const struct writing *w, int cases, const struct eo_text *tail, struct eo_text *text)
{
  eo_text_add(text, "{");
  add_members(text, &w->part[0]);
  eo_text_add(text, ",\"load_cases\":[");
  for (int k = 0; k < cases; k++) {
    eo_text_add(text, k ? ",{" : "{");
    add_members(text, &w->part[1 + HALVES * k]);
    eo_text_add(text, ",");
    add_members(text, &w->part[2 + HALVES * k]);
    eo_text_add(text, "}");
  }
  eo_text_add(text, "],");
  add_members(text, tail);
  eo_text_add(text, "}");
}

static enum eo_code write_all(struct writing *w, const struct eo_warnings *warnings, struct eo_text *text, struct eo_error *error)
{
  const struct eo_analysis *analysis = w->source[0].analysis;
  const struct eo_parallel parallel = {.threads = analysis->threads < WRITERS ? analysis->threads : WRITERS, .work = write_part, .context = w};
  struct eo_text tail = {0};
  enum eo_code code = eo_parallel_run(&parallel, 1 + HALVES * analysis->cases, error);
  if (code)
    return code;
  json_t *last = encode_tail(&w->source[0], warnings);
  if (last)
    eo_json_write(&tail, last, EO_JSON_COMPACT);
  if (last && !tail.failed)
    join(w, analysis->cases, &tail, text);
  bool good = last && !tail.failed && !text->failed;
  json_decref(last);
  eo_text_done(&tail);
  return good ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_result_write(const struct eo_analysis *analysis, const struct eo_design *design, const struct eo_warnings *warnings, unsigned left_out,
                             struct eo_text *text, struct eo_error *error)
{
  struct writing *w = calloc(1, sizeof *w);
  double edge_pressure[EO_MAX_LOAD_CASES][2];
  bool good = w != NULL;
  for (int i = 0; i < WRITERS && good; i++) {
    good = init_source(&w->source[i], analysis, design, left_out);
    w->source[i].edge_pressure = edge_pressure;
  }
  enum eo_code code = good ? write_all(w, warnings, text, error) : eo_error_memory(error);
  for (int i = 0; i < WRITERS && w; i++)
    done_source(&w->source[i]);
  for (int i = 0; i < MOST_PARTS && w; i++)
    eo_text_done(&w->part[i]);
  free(w);
  return code;
}

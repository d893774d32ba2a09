/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measurements beside the prediction, the fit of inputs that nobody knows, and synthetic recordings.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "http/service_reply.h"
#include "http/request_body.h"
#include "http/deferred.h"
#include "http/stored_design.h"
#include "http/stored_measurement.h"
#include "http/route.h"
#include "http/http_private.h"
#include "service/rig_tasks.h"
#include "store/measurements.h"

struct collected {
  struct eo_rig_points points;
  const json_t *wanted; /* NULL: all; else an array of numbers */
  int64_t design;
};

static bool is_wanted(const json_t *wanted, int64_t id)
{
  json_t *value;
  size_t i;
  json_array_foreach(wanted, i, value) if (json_integer_value(value) == id) return true;
  return !wanted;
}

static enum eo_code collect(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct collected *collected = context;
  collected->design = row->design;
  return is_wanted(collected->wanted, row->id)
             ? eo_rig_points_add(&collected->points, row->id, row->summary, row->pair, error)
             : EO_OK;
}

/* The stored design; false: the reply is there. */
static bool find_design(struct eo_request *request, int64_t id, struct eo_design *design, json_t **document)
{
  struct eo_geometry geometry;
  bool missing;
  if (eo_request_stored_design(request, id, design, &geometry, document, &missing))
    return true;
  if (missing)
    eo_reply_problem(&request->reply, 404, NULL, "There is no design with this number.");
  return false;
}

static void compare(struct eo_request *request, const struct eo_design *design, struct eo_rig_points *points)
{
  struct eo_work work;
  struct eo_error error;
  if (eo_rig_comparison(&work, points, request->csv, &error))
    eo_reply_error(&request->reply, "", &error);
  else
    eo_request_compute(request, design, &work);
}

static void compare_all(struct eo_request *request, int64_t id, const struct eo_design *design)
{
  struct collected collected = {0};
  struct eo_error error;
  if (eo_store_list_measurements(request->store, id, 0, EO_MOST_MEASURED + 1, collect, &collected, &error))
    eo_reply_error(&request->reply, "", &error);
  else
    compare(request, design, &collected.points);
  eo_rig_points_done(&collected.points);
}

static void compare_design(struct eo_request *request)
{
  struct eo_design design;
  int64_t id;
  if (eo_request_id_at(request, 0, &id) && find_design(request, id, &design, NULL))
    compare_all(request, id, &design);
}

/* The design of the body in place of the stored one. */
static void compare_what_if(struct eo_request *request)
{
  struct eo_design stored, design;
  struct eo_geometry geometry;
  int64_t id;
  const json_t *body;
  if (eo_request_id_at(request, 0, &id) && find_design(request, id, &stored, NULL) &&
      (body = eo_request_json(request)) && eo_request_design(request, body, "", &design, &geometry, NULL))
    compare_all(request, id, &design);
}

static void compare_one(struct eo_request *request)
{
  struct collected collected = {0};
  struct eo_design design;
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_store_find_measurement(request->store, id, collect, &collected, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(&request->reply);
  else if (find_design(request, collected.design, &design, NULL))
    compare(request, &design, &collected.points);
  eo_rig_points_done(&collected.points);
}

/* What a fit works on besides its unknowns. */
struct basis {
  json_t *wanted; /* owned; NULL: all measurements */
  json_t *given;  /* owned; NULL: the stored design */
  struct eo_design design;
};

/* Takes "measurements" and "design" out of the body: the rest is what eo_update_decode() knows. */
static bool read_fit(struct eo_request *request, json_t *body, struct basis *basis, struct eo_update_settings *settings)
{
  struct eo_faults *faults = eo_request_memory(request, sizeof *faults);
  if (!faults)
    return false;
  basis->wanted = json_incref(json_object_get(body, "measurements"));
  basis->given = json_incref(json_object_get(body, "design"));
  json_object_del(body, "measurements");
  json_object_del(body, "design");
  eo_update_decode(body, settings, faults);
  if (basis->wanted && !json_is_array(basis->wanted))
    eo_faults_add(faults, "/measurements", "This must be a list of the numbers of measurements.");
  bool good = faults->count == 0;
  if (!good)
    eo_reply_faults(&request->reply, "", faults);
  free(faults);
  return good;
}

/* The design of the body, else the stored one; false: the reply is there. */
static bool find_basis(struct eo_request *request, int64_t id, struct basis *basis)
{
  struct eo_geometry geometry;
  json_t *stored = NULL;
  if (!find_design(request, id, &basis->design, &stored))
    return false;
  if (!basis->given)
    basis->given = json_incref(stored);
  json_decref(stored);
  return eo_request_design(request, basis->given, "/design", &basis->design, &geometry, NULL);
}

static void put_fit(struct eo_request *request, int64_t id, const struct basis *basis,
                    const struct eo_update_settings *settings)
{
  struct collected collected = {.wanted = basis->wanted};
  struct eo_error error;
  struct eo_work work;
  char *given = json_dumps(basis->given, JSON_COMPACT);
  enum eo_code code = given ? eo_store_list_measurements(request->store, id, 0, EO_MOST_MEASURED + 1, collect,
                                                         &collected, &error)
                            : eo_error_memory(&error);
  if (!code)
    code = eo_rig_fit(&work, &collected.points, settings, given, &error);
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else
    eo_request_compute(request, &basis->design, &work);
  eo_rig_points_done(&collected.points);
  free(given);
}

static void fit(struct eo_request *request)
{
  struct eo_update_settings settings;
  struct basis basis = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id) || !eo_request_json(request))
    return;
  if (read_fit(request, request->document, &basis, &settings) && find_basis(request, id, &basis))
    put_fit(request, id, &basis, &settings);
  json_decref(basis.wanted);
  json_decref(basis.given);
}

struct rig_order {
  const json_t *design;
  struct eo_rig_request rig;
};
static const struct eo_field rig_fields[] = {
    EO_DOCUMENT(struct rig_order, design, "design", "Design", EO_FIELD_REQUIRED, "what is recorded"),
    EO_OBJECT(struct rig_order, rig, "rig", &eo_rig_table, "the rig and its encoders"),
};
static const struct eo_table rig_table = EO_TABLE("an order of a recording", struct rig_order, rig_fields);

static void put_rig(struct eo_request *request, const struct eo_design *design, const struct eo_rig_request *rig)
{
  struct eo_work work;
  struct eo_error error;
  request->csv = true;
  snprintf(request->reply.file_name, sizeof request->reply.file_name, "rig-%.6gNm-%.6grpm.csv", rig->torque,
           rig->speed * 30 / M_PI);
  if (eo_rig_recording(&work, rig, &error))
    eo_reply_error(&request->reply, "", &error);
  else
    eo_request_compute(request, design, &work);
}

static void record(struct eo_request *request)
{
  struct rig_order order;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  if (!eo_body_read(request, &order) || !eo_request_design(request, order.design, "/design", &design, &geometry, NULL))
    return;
  if (eo_rig_complete(&order.rig, &design, &error))
    eo_reply_error(&request->reply, "/rig", &error);
  else
    put_rig(request, &design, &order.rig);
}

#define LANE "Easeoff-Lane, Prefer"
const struct eo_route eo_routes_comparison[] = {
    {.method = EO_GET,
     .pattern = "/measurements/{id}/comparison",
     .handle = compare_one,
     .name = "compareMeasurement",
     .gives = "200 Comparison, 202 Preparing",
     .headers = LANE,
     .rate = EO_RATE_QUESTION,
     .csv = true,
     .query = {EO_UNITS_QUERY},
     .summary =
         "A measurement compared with the prediction at its torque and measured speed: rotational acceleration at the "
         "encoders' end, orders, TE in phase."},
    {.method = EO_GET,
     .pattern = "/designs/{id}/comparison",
     .handle = compare_design,
     .name = "compareDesign",
     .gives = "200 Comparison, 202 Preparing",
     .headers = LANE,
     .rate = EO_RATE_START,
     .csv = true,
     .query = {EO_UNITS_QUERY},
     .summary =
         "All measurements of a design compared with the prediction, reductions by the modification, outliers with "
         "their reasons."},
    {.method = EO_POST,
     .pattern = "/designs/{id}/comparison",
     .handle = compare_what_if,
     .name = "compareWhatIf",
     .takes = "Design",
     .gives = "200 Comparison, 202 Preparing",
     .headers = LANE,
     .rate = EO_RATE_QUESTION,
     .csv = true,
     .query = {EO_UNITS_QUERY},
     .summary =
         "The same with another design in the place of the stored one: what its measurements would say about it."},
    {.method = EO_POST,
     .pattern = "/designs/{id}/fit",
     .handle = fit,
     .name = "fitDesign",
     .takes = "FitOrder",
     .gives = "200 Fit, 202 Preparing",
     .headers = LANE,
     .rate = EO_RATE_START,
     .summary =
         "Inputs that are not known, fitted to the measurements of a design (or of `design` in its place) within "
         "ranges; `design` in the answer holds them, to be put in its place."},
    {.method = EO_POST,
     .pattern = "/rig",
     .handle = record,
     .name = "recordRig",
     .takes = "RigOrder",
     .order = &rig_table,
     .design_at = "/design",
     .headers = LANE,
     .gives = "200 text/csv, 202 Preparing",
     .rate = EO_RATE_START,
     .summary = "What two encoders would record of a design: a text file with known truth, for teaching and tests, as "
                "`easeoff rig` writes it."},
    {0}};

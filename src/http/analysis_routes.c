/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Questions about a design that are answered at once: checking it, analysing it, sweeping it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "http/answers.h"
#include "document/completion.h"
#include "document/result.h"
#include "evaluation/evaluator.h"
#include "format/object.h"
#include "http/request_body.h"
#include "http/deferred.h"
#include "http/service_reply.h"
#include "http/route.h"
#include "http/http_private.h"
#include "service/preparation.h"
#include "variants/sweep_steps.h"

static const struct eo_outline_row cost_rows[] = {
    EO_KEY("memory_MB", "number", "estimated, at the most crowded moment", EO_AT(struct eo_preparation_cost, memory)),
    EO_KEY("seconds", "number", "estimated, of one processor", EO_AT(struct eo_preparation_cost, seconds)),
};
static const struct eo_outline cost_outline = EO_OUTLINE("PreparationCost", cost_rows);

struct readiness {
  bool prepared;
  struct eo_preparation_cost cost; /* memory: MB */
};
static const struct eo_outline_row readiness_rows[] = {
    EO_KEY("prepared", "flag", "an analysis would be answered at once", EO_AT(struct readiness, prepared)),
    EO_KEY("preparation", "object", "what preparing the pair takes, where it is not kept already",
           .outline = &cost_outline, EO_AT(struct readiness, cost)),
};
static const struct eo_outline readiness_outline = EO_OUTLINE(NULL, readiness_rows);

static const struct eo_outline_row check_rows[] = {
    {.outline = &eo_outline_completion},
    {.outline = &readiness_outline},
};
const struct eo_outline eo_outline_check = EO_OUTLINE("Check", check_rows);

static void check(struct eo_request *request)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  struct eo_error error;
  struct eo_preparation_cost cost;
  const json_t *body = eo_request_json(request);
  if (!body || !eo_request_design(request, body, "", &design, &geometry, &warnings))
    return;
  if (eo_preparation_cost_of(&design, &cost, &error)) {
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  const struct readiness readiness = {eo_service_is_prepared(request->http->service, &design),
                                      {.memory = round(cost.memory / 1e6), .seconds = 0.1 * ceil(10 * cost.seconds)}};
  json_t *reply = eo_completion_encode(&design, &geometry, &warnings),
         *own = eo_outline_encode(&readiness_outline, &readiness);
  json_object_update(reply, own);
  json_decref(own);
  eo_reply_json(&request->reply, 200, reply);
}

/* What the answer leaves out: the curves of parts that are not named, where any are. */
static unsigned left_out_of(const struct eo_request *request)
{
  enum { MAPS = EO_RESULT_PARTS, HISTORIES, OVERVIEW };
  bool some;
  unsigned named = eo_route_words(request, "parts", &some), left_out = 0;
  for (int i = 0; i < EO_RESULT_PARTS && some; i++)
    left_out |= named & 1u << i ? 0 : EO_RESULT_FIRST_PART << i;
  bool maps = some ? named >> MAPS & 1 : eo_route_number(request, "maps") != 0;
  bool histories = some ? named >> HISTORIES & 1 : eo_route_number(request, "histories") != 0;
  int of = (int)eo_route_number(request, "curves_of"), digits = (int)eo_route_number(request, "digits");
  left_out |= EO_RESULT_DIGITS(digits) | (some && named >> OVERVIEW & 1 ? EO_RESULT_OVERVIEW : 0);
  return left_out | (maps ? 0 : EO_RESULT_NO_MAPS) | (histories ? 0 : EO_RESULT_NO_HISTORIES) |
         (of < 0 ? 0 : EO_RESULT_CURVES_OF(of));
}

/* Whether there is the load case whose curves are asked for. */
static bool has_load_case(struct eo_request *request, const struct eo_design *design)
{
  int of = (int)eo_route_number(request, "curves_of");
  if (of >= design->load_cases)
    eo_reply_problem(&request->reply, 400, "query", "The query parameter curves_of is %d, but there are %d load cases.",
                     of, design->load_cases);
  return of < design->load_cases;
}

static void put_analysis(struct eo_request *request, const struct eo_design *design, const struct eo_warnings *warnings)
{
  enum eo_admission admission;
  struct eo_error error;
  int64_t job = 0;
  struct eo_analysis_question question = {.common = eo_request_to_question(request, design, warnings),
                                          .want = EO_WANT_CURVES |
                                                  (eo_route_number(request, "root_stress") != 0 ? EO_WANT_ROOT : 0) |
                                                  (eo_route_number(request, "rating") != 0 ? EO_WANT_RATING : 0) |
                                                  (eo_route_number(request, "pitch") != 0 ? EO_WANT_PITCH : 0) |
                                                  (eo_route_number(request, "band") != 0 ? EO_WANT_BAND : 0),
                                          .left_out = left_out_of(request)};
  if (!has_load_case(request, design) || !eo_request_lane(request, &question.common))
    return;
  eo_request_defer(request);
  enum eo_code code = eo_service_analyze(request->http->service, &question, &admission, &job, &error);
  eo_reply_unless_accepted(request, code, admission, job, &error);
}

static void analyze(struct eo_request *request)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  const json_t *body = eo_request_json(request);
  if (body && eo_request_design(request, body, "", &design, &geometry, &warnings))
    put_analysis(request, &design, &warnings);
}

struct sweep_order {
  const json_t *design;
  struct eo_sweep_request range;
  int has_torque, has_speed, has_vary;
};
static const struct eo_field sweep_fields[] = {
    EO_DOCUMENT(struct sweep_order, design, "design", "Design", EO_FIELD_REQUIRED, "what is swept"),
    {.key = "torque_Nm",
     .alias = "torque",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_NULLABLE,
     .offset = offsetof(struct sweep_order, range.torque),
     .count_offset = offsetof(struct sweep_order, has_torque),
     .table = &eo_sweep_torque_table,
     .derived = "that of the load case with the largest share",
     .help = "torques"},
    {.key = "speed_rpm",
     .alias = "speed",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_NULLABLE,
     .offset = offsetof(struct sweep_order, range.speed),
     .count_offset = offsetof(struct sweep_order, has_speed),
     .table = &eo_sweep_speed_table,
     .derived = "that of the load case with the largest share",
     .help = "speeds"},
    EO_OPTIONAL(struct sweep_order, range.vary, has_vary, "vary", &eo_sweep_vary_table, "none",
                "a number of the design in place of the torque: any that leaves the gear pair as it is"),
};
static const struct eo_table sweep_table = EO_TABLE("a sweep", struct sweep_order, sweep_fields);

enum { MOST_SWEEP_POINTS = 20000 };

static bool is_small(struct eo_request *request, const struct eo_sweep_axes *axes)
{
  long points = (long)(axes->torques ? axes->torques
                       : axes->steps ? axes->steps
                                     : 1) *
                (axes->speeds ? axes->speeds : 1);
  if (points <= MOST_SWEEP_POINTS)
    return true;
  eo_reply_problem(&request->reply, 422, "too-large", "A sweep may have %d points here, not %ld.", MOST_SWEEP_POINTS,
                   points);
  return false;
}

static void put_sweep(struct eo_request *request, const struct eo_design *design, const struct eo_warnings *warnings,
                      struct eo_sweep_axes *axes)
{
  enum eo_admission admission;
  struct eo_error error;
  int64_t job = 0;
  struct eo_question question = eo_request_to_question(request, design, warnings);
  if (!is_small(request, axes) || !eo_request_lane(request, &question))
    return;
  eo_request_defer(request);
  enum eo_code code = eo_service_sweep(request->http->service, &question, axes, &admission, &job, &error);
  eo_reply_unless_accepted(request, code, admission, job, &error);
}

static void sweep(struct eo_request *request)
{
  struct sweep_order order;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  struct eo_sweep_axes axes = {0};
  struct eo_error error;
  if (!eo_body_read(request, &order))
    return;
  if (eo_sweep_axes_init(&axes, &order.range, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (eo_request_design(request, order.design, "/design", &design, &geometry, &warnings)) {
    if (eo_sweep_steps_check(&axes, &design, &error) || eo_sweep_steps_take(&axes, order.design, &error))
      eo_reply_error(&request->reply, "", &error);
    else
      put_sweep(request, &design, &warnings, &axes);
  }
  eo_sweep_axes_done(&axes);
}

#define LANE "Easeoff-Lane, Prefer"
const struct eo_route eo_routes_analysis[] = {
    {.method = EO_POST,
     .pattern = "/check",
     .handle = check,
     .name = "checkDesign",
     .takes = "Design",
     .gives = "200 Check",
     .rate = EO_RATE_QUESTION,
     .query = {EO_UNITS_QUERY},
     .summary =
         "Reads a design, fills in every default and works out the geometry; 422 names everything that is wrong."},
    {.method = EO_POST,
     .pattern = "/analyze",
     .handle = analyze,
     .name = "analyze",
     .takes = "Design",
     .gives = "200 Result, 202 Preparing",
     .headers = LANE,
     .rate = EO_RATE_QUESTION,
     .csv = true,
     .summary = "One true evaluation of a design, everything it computed. 202 while the gear pair is being prepared.",
     .query = {{"root_stress", 0, 1, 1, NULL, "1: root stress too"},
               {"band", 0, 1, 0, NULL,
                "1: RMS at 0.9 and 1.1 times the compliance too, which takes several times as long"},
               {"maps", 0, 1, 1, NULL, "1: pressure and clearance over the flanks"},
               {"histories", 0, 1, 0, NULL, "1: vibration and root stress over time"},
               {"rating", 0, 1, 1, NULL,
                "1: rating by ISO 6336 and tribology too, with two more contact analyses; 0 answers sooner"},
               {"pitch", 0, 1, 1, NULL,
                "1: the hunting period of a design that states single teeth too, a second or two; 0 answers sooner"},
               {"parts", 0, EO_SEVERAL_WORDS, 0, EO_RESULT_PART_WORDS "|maps|histories|overview",
                "only these have their curves, maps and histories, the others null; all numbers stand in any case. "
                "overview: the transmission error, its orders and those of the pair's vibration, of every load case. "
                "Absent: all parts, with maps and histories as those parameters say"},
               {"curves_of", -1, EO_MAX_LOAD_CASES - 1, -1, NULL,
                "number of the only load case, from 0, that has curves; -1: all"},
               {"digits", EO_RESULT_LEAST_DIGITS, EO_DIGITS_CURVE, EO_DIGITS_CURVE, NULL,
                "significant digits of curves, at most; maps and histories have two fewer, at most 6"},
               EO_UNITS_QUERY}},
    {.method = EO_POST,
     .pattern = "/sweep",
     .handle = sweep,
     .name = "sweep",
     .takes = "SweepRequest",
     .order = &sweep_table,
     .design_at = "/design",
     .gives = "200 Sweep, 202 Preparing",
     .headers = LANE,
     .rate = EO_RATE_START,
     .csv = true,
     .query = {EO_UNITS_QUERY},
     .summary =
         "A design over torque or another of its numbers, over speed, or over both, compared with the unmodified "
         "pair. 202 while the gear pair is being prepared."},
    {0}};

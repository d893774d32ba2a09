/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The API as a table of commands against a real server; every reply is held against the OpenAPI document that the
   server gives, which is held against what the server does. */
#include "api/client.h"
#include "api/description.h"
#include "support/tap.h"

#include <math.h>

static const char folded[] =
    "{\"gear_pair\": {\"pinion_teeth\": 23, \"gear_teeth\": 61, \"normal_module_mm\": 5, \"helix_angle_deg\": 26, "
    "\"face_width_mm\": 60}, \"load_cases\": [{\"torque_Nm\": 500, \"speed_rpm\": 1500}], \"modification\": "
    "{\"pinion\": "
    "{\"left\": {\"root_relief_um\": 400, \"root_relief_start_mm\": 3.5, \"root_relief_shape\": \"exponent\", "
    "\"root_relief_exponent\": 1.2}}}}";
static char *coarse, *order, *named, *sweep, *vary, *vary_pair, *pairs, *many_pairs, *tolerance_order, *limited, *spur,
    *stages, *study, *once_more, *other_paper;

struct command {
  const char *what, *method, *path, *headers;
  char **body;      /* NULL: none */
  const char *text; /* a body of its own */
  int status;
  const char *header,
      *holds; /* a header field of the reply and what it holds; holds "": it is there; NULL: it is not */
  const char *pointer, *value; /* into the JSON of the reply, "a/0/b", and what stands there; value NULL: anything */
  const char *says;            /* what stands in the reply's body; NULL: anything */
};

static const json_t *find(const json_t *value, const char *pointer)
{
  while (value && *pointer) {
    char key[100];
    size_t length = strcspn(pointer, "/");
    snprintf(key, sizeof key, "%.*s", (int)length, pointer);
    for (char *c = key; (c = strchr(c, '~'));)
      *c = '/';
    value = json_is_array(value) ? json_array_get(value, strtoul(key, NULL, 10)) : json_object_get(value, key);
    pointer += length + (pointer[length] == '/');
  }
  return value;
}

static bool stands_there(const struct reply *reply, const char *pointer, const char *expected)
{
  json_t *body = json_loadb(reply->body ? reply->body : "", reply->size, 0, NULL);
  const json_t *value = find(body, pointer);
  char *text = json_is_string(value) ? strdup(json_string_value(value))
               : value               ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT)
                                     : NULL;
  bool right = value && (!expected || (text && strcmp(text, expected) == 0));
  if (!right)
    printf("# %s is %s, body %.200s\n", pointer, text ? text : "not there", reply->body ? reply->body : "");
  free(text);
  json_decref(body);
  return right;
}

static bool header_is_right(const struct reply *reply, const struct command *c)
{
  const char *value = header_of(reply, c->header);
  if (!c->holds)
    return !value;
  bool right = value && strstr(value, c->holds);
  if (!right)
    printf("# %s is %s\n", c->header, value ? value : "not there");
  return right;
}

static void run_command(const struct command *c)
{
  struct reply reply = call(c->method, c->path, c->headers, c->body ? *c->body : c->text);
  if (!ok(reply.status == c->status, "%s: %s %s is answered with %d, %d is right", c->what, c->method, c->path,
          reply.status, c->status))
    printf("# %.300s\n", reply.body ? reply.body : "");
  if (c->header)
    ok(header_is_right(&reply, c), "%s: %s of the reply %s%s", c->what, c->header, c->holds ? "holds " : "is not there",
       c->holds ? c->holds : "");
  if (c->pointer)
    ok(stands_there(&reply, c->pointer, c->value), "%s: %s of the reply is %s", c->what, c->pointer,
       c->value ? c->value : "there");
  if (c->says)
    ok(reply.body && strstr(reply.body, c->says), "%s: the reply says %s", c->what, c->says);
  free_reply(&reply);
}

static const struct command first[] = {
    {"health", "GET", API "/health", .status = 200, .header = "X-Request-Id", .holds = "", .pointer = "status",
     .value = "ok"},
    {"health by HEAD", "HEAD", API "/health", .status = 200, .header = "Content-Length", .holds = ""},
    {"metrics", "GET", API "/metrics", .status = 200, .header = "Content-Type", .holds = "text/plain"},
    {"safety headers", "GET", API "/health", .status = 200, .header = "Content-Security-Policy",
     .holds = "default-src 'none'"},
    {"no sniffing", "GET", API "/health", .status = 200, .header = "X-Content-Type-Options", .holds = "nosniff"},
    {"the page of another site", "GET", API "/health", "Origin: http://elsewhere.example\r\n", .status = 200,
     .header = "Access-Control-Allow-Origin"},
    {"a server without a token", "GET", API "/session", .status = 200, .pointer = "required", .value = "false"},
    {"a token that nobody asked for", "POST", API "/session", .text = "{\"token\":\"x\"}", .status = 204},
    {"a session with a wrong key", "POST", API "/session", .text = "{\"token\":\"x\",\"tokn\":1}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/tokn"},
    {"no rig with a wrong key", "POST", API "/rig", .text = "{\"design\":{},\"rig\":{},\"rgi\":{}}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/rgi"},
    {"the end of a session", "DELETE", API "/session", .status = 204, .header = "Set-Cookie", .holds = "Max-Age=0"},
    {"examples", "GET", API "/examples", .status = 200, .pointer = "items/0/name", .value = "paper"},
    {"an example", "GET", API "/examples/paper", .status = 200, .header = "ETag", .holds = "\"",
     .pointer = "gear_pair/pinion_teeth", .value = "17"},
    {"no example", "GET", API "/examples/nothing", .status = 404, .pointer = "status", .value = "404"},
    {"field tables", "GET", API "/schema", .status = 200, .pointer = "design/fields/1/key", .value = "name"},
    {"description", "GET", API "/openapi.json", .status = 200, .pointer = "openapi", .value = "3.1.0"},
    {"a client that takes gzip", "GET", API "/openapi.json", "Accept-Encoding: br, gzip\r\n", .status = 200,
     .header = "Content-Encoding", .holds = "gzip"},
    {"a client that refuses gzip", "GET", API "/openapi.json", "Accept-Encoding: gzip;q=0\r\n", .status = 200,
     .header = "Content-Encoding"},
    {"a small reply to a client that takes gzip", "GET", API "/health", "Accept-Encoding: gzip\r\n", .status = 200,
     .header = "Content-Encoding"},
    {"a path of nothing", "GET", API "/nothing", .status = 404, .header = "Content-Type",
     .holds = "application/problem+json"},
    {"the page of a server without one", "GET", "/", .status = 404},
    {"a page is only read", "POST", "/", .text = "{}", .status = 405, .header = "Allow", .holds = "GET, HEAD"},
    {"wrong method", "DELETE", API "/health", .status = 405, .header = "Allow", .holds = "GET, HEAD, OPTIONS"},
    {"unknown method", "BREW", API "/health", .status = 405, .header = "Allow", .holds = "GET, HEAD, OPTIONS"},
    {"options", "OPTIONS", API "/designs", .status = 204, .header = "Allow", .holds = "GET, HEAD, POST, OPTIONS"},
    {"unknown query", "GET", API "/designs?limits=3", .status = 400},
    {"query out of range", "GET", API "/designs?limit=201", .status = 400},
    {"query that is no number", "GET", API "/designs?limit=1x", .status = 400},
    {"query that is no word", "GET", API "/jobs?state=lost", .status = 400},
    {"a path that leads out", "GET", "/../../etc/passwd", .status = 400},
    {"an encoded path that leads out", "GET", "/%2e%2e/%2e%2e/etc/passwd", .status = 400},
    {"a design whose number is none", "GET", API "/designs/x", .status = 404},
    {"a design whose number is too large", "GET", API "/designs/99999999999999999999", .status = 404},
    {"check", "POST", API "/check", .body = &coarse, .status = 200, .pointer = "prepared", .value = "false"},
    {"a check of several faults", "POST", API "/check",
     .text = "{\"gear_pair\":{\"pinion_teeth\":3,\"gear_teeth\":44},\"nonsense\":1}", .status = 422,
     .pointer = "errors/4/pointer"},
    {"a check of one fault", "POST", API "/check", .text = "{\"gear_pair\":{\"pinion_teeth\":3,\"gear_teeth\":44}}",
     .status = 422, .pointer = "errors/0/pointer", .value = "/gear_pair/pinion_teeth"},
    {"a body that is no JSON", "POST", API "/check", .text = "{\"a\":", .status = 400, .pointer = "type",
     .value = "/problems/not-json"},
    {"an array in place of a design", "POST", API "/check", .text = "[1]", .status = 400},
    {"a body with a key twice", "POST", API "/check", .text = "{\"name\":\"a\",\"name\":\"b\"}", .status = 400},
    {"an empty body", "POST", API "/check", .text = "", .status = 400},
    {"a body of another type", "POST", API "/check", "Content-Type: text/xml\r\n", .text = "<a/>", .status = 415},
    {"a request from another site", "POST", API "/check", "Origin: http://elsewhere.example\r\n", .body = &coarse,
     .status = 403, .pointer = "type", .value = "/problems/cross-site"},
    {"a request from another site, as browsers say it", "POST", API "/check", "Sec-Fetch-Site: cross-site\r\n",
     .body = &coarse, .status = 403},
    {"a request whose origin is null", "POST", API "/check", "Origin: null\r\n", .body = &coarse, .status = 403},
    {"a host of another name", "GET", API "/health", "Host: rebound.example:80\r\n", .status = 421, .pointer = "type",
     .value = "/problems/wrong-host"},
    {"the host's own name", "GET", API "/health", "Host: localhost:1\r\n", .status = 200},
    {"a host by its number of version 6", "GET", API "/health", "Host: [::1]\r\n", .status = 200},
    {"a host whose name begins like ours", "GET", API "/health", "Host: 127.0.0.1.elsewhere.example\r\n",
     .status = 421},
};

static const struct command designs[] = {
    {"no designs", "GET", API "/designs", .status = 200, .pointer = "items", .value = "[]"},
    {"add a design", "POST", API "/designs", .body = &coarse, .status = 201, .header = "Location",
     .holds = API "/designs/1", .pointer = "name", .value = "paper pair"},
    {"add one with a name", "POST", API "/designs", .body = &named, .status = 201, .header = "ETag", .holds = "\"2.1\"",
     .pointer = "name", .value = "mine"},
    {"a third design", "POST", API "/designs", .body = &coarse, .status = 201, .pointer = "id", .value = "3"},
    {"a design without teeth", "POST", API "/designs", .text = "{\"name\":\"x\",\"design\":{}}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/design/gear_pair/pinion_teeth"},
    {"a name too long for its place", "POST", API "/designs",
     .text = "{\"name\":7,\"design\":{\"gear_pair\":{\"pinion_teeth\":20,\"gear_teeth\":40,"
             "\"normal_module_mm\":3,\"helix_angle_deg\":20,\"face_width_mm\":30}}}",
     .status = 422},
    {"a key that nobody knows beside the design", "POST", API "/designs",
     .text = "{\"name\":\"x\",\"design\":{},\"nmae\":\"y\"}", .status = 422, .pointer = "errors/0/pointer",
     .value = "/nmae"},
    {"a name of no letters", "POST", API "/designs", .text = "{\"name\":\"\",\"design\":{}}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/name"},
    {"the newest design", "GET", API "/designs?limit=2", .status = 200, .pointer = "items/0/id", .value = "3"},
    {"the first page of designs", "GET", API "/designs?limit=2", .status = 200, .pointer = "next", .value = "2"},
    {"the next page of designs", "GET", API "/designs?limit=2&cursor=2", .status = 200, .pointer = "items/0/id",
     .value = "1"},
    {"the last page of designs", "GET", API "/designs?limit=2&cursor=2", .status = 200, .pointer = "next",
     .value = "null"},
    {"a design", "GET", API "/designs/1", .status = 200, .header = "ETag", .holds = "\"1.1\""},
    {"a design that the client knows", "GET", API "/designs/1", "If-None-Match: \"0.0\", W/\"1.1\"\r\n", .status = 304,
     .header = "ETag", .holds = "\"1.1\""},
    {"a design that has changed since", "GET", API "/designs/1", "If-None-Match: \"1.0\"\r\n", .status = 200},
    {"a replacement without a tag", "PUT", API "/designs/1", .body = &coarse, .status = 428},
    {"a replacement of the known version", "PUT", API "/designs/1", "If-Match: \"1.1\"\r\n", .body = &named,
     .status = 200, .header = "ETag", .holds = "\"1.2\"", .pointer = "name", .value = "mine"},
    {"a replacement of an old version", "PUT", API "/designs/1", "If-Match: \"1.1\"\r\n", .body = &coarse,
     .status = 412},
    {"a replacement by a weak tag", "PUT", API "/designs/1", "If-Match: W/\"1.2\"\r\n", .body = &coarse, .status = 412},
    {"a replacement of any version", "PUT", API "/designs/1", "If-Match: *\r\n", .body = &coarse, .status = 200,
     .header = "ETag", .holds = "\"1.3\""},
    {"a replacement of no design", "PUT", API "/designs/9", "If-Match: *\r\n", .body = &coarse, .status = 404},
    {"the removal of an old version", "DELETE", API "/designs/1", "If-Match: \"1.1\"\r\n", .status = 412},
    {"the removal of a design", "DELETE", API "/designs/1", .status = 204},
    {"a removed design", "GET", API "/designs/1", .status = 404},
    {"the removal of a removed design", "DELETE", API "/designs/1", .status = 404},
};

static const struct command analyses[] = {
    {"an analysis of an unprepared pair", "POST", API "/analyze", .body = &coarse, .status = 202,
     .header = "Retry-After", .holds = "1", .pointer = "job/kind", .value = "prepare"},
    {"an analysis that waits for its pair", "POST", API "/analyze", "Prefer: wait=60\r\n", .body = &coarse,
     .status = 200, .pointer = "load_cases/0/outcome", .value = "converged"},
    {"a check of a prepared pair", "POST", API "/check", .body = &coarse, .status = 200, .pointer = "prepared",
     .value = "true"},
    {"analyze", "POST", API "/analyze?maps=0", .body = &coarse, .status = 200, .pointer = "load_cases/2/torque_Nm",
     .value = "1035"},
    {"a slider's step", "POST", API "/analyze?rating=0&curves_of=1&parts=lte,pattern,maps", .body = &coarse,
     .status = 200, .pointer = "load_cases/2/torque_Nm", .value = "1035"},
    {"a part that there is not", "POST", API "/analyze?parts=lte,sound", .body = &coarse, .status = 400},
    {"a load case that there is not", "POST", API "/analyze?curves_of=3", .body = &coarse, .status = 400},
    {"analyze without stress", "POST", API "/analyze?root_stress=0&maps=0", .body = &coarse, .status = 200,
     .pointer = "load_cases/0/root_stress"},
    {"analyze as CSV", "POST", API "/analyze", "Accept: text/csv\r\n", .body = &coarse, .status = 200,
     .header = "Content-Type", .holds = "text/csv"},
    {"analyze as CSV by suffix", "POST", API "/analyze.csv", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"analyze as CSV in inches", "POST", API "/analyze.csv?units=inch", .body = &coarse, .status = 200,
     .says = ",peak_to_peak_thou,"},
    {"an analysis for who likes JSON better", "POST", API "/analyze?maps=0",
     "Accept: text/csv;q=0.5, application/json\r\n", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "application/json"},
    {"no other suffix", "POST", API "/analyze.xml", .body = &coarse, .status = 404},
    {"no CSV of a check", "POST", API "/check.csv", .body = &coarse, .status = 404},
    {"an analysis in a lane whose name is wrong", "POST", API "/analyze", "Easeoff-Lane: a b\r\n", .body = &coarse,
     .status = 400},
    {"an analysis in a lane", "POST", API "/analyze?maps=0", "Easeoff-Lane: tab-1\r\n", .body = &coarse, .status = 200},
    {"sweep", "POST", API "/sweep", .body = &sweep, .status = 200, .pointer = "speed_rpm", .value = "[1000,1500,2000]"},
    {"sweep as CSV", "POST", API "/sweep.csv", .body = &sweep, .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"tolerance", "POST", API "/tolerance", .body = &pairs, .status = 200, .pointer = "pairs", .value = "6"},
    {"tolerance as CSV", "POST", API "/tolerance.csv", .body = &pairs, .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"sweep of another number", "POST", API "/sweep", .body = &vary, .status = 200, .pointer = "vary/values",
     .value = "[0,0.125,0.25]"},
    {"sweep of another number as CSV", "POST", API "/sweep.csv", .body = &vary, .status = 200,
     .says = "alignment.shaft_angle_error_in_plane_deg,torque_Nm"},
    {"sweep of another gear pair", "POST", API "/sweep", .body = &vary_pair, .status = 422,
     .pointer = "errors/0/pointer", .value = "/vary/key"},
    {"sweep in inches", "POST", API "/sweep.csv?units=inch", .body = &sweep, .status = 200,
     .says = "peak_to_peak_thou"},
    {"tolerance in inches", "POST", API "/tolerance.csv?units=inch", .body = &pairs, .status = 200,
     .says = ".peak_to_peak_thou"},
    {"no tolerance in inches but as CSV", "POST", API "/tolerance?units=inch", .body = &pairs, .status = 400},
    {"tolerance of too many pairs", "POST", API "/tolerance", .text = "{\"design\":{},\"pairs\":100001}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/pairs"},
    {"sweep without a design", "POST", API "/sweep", .text = "{\"speed\":{\"from\":1,\"to\":2}}", .status = 422},
    {"sweep with a wrong key", "POST", API "/sweep",
     .text = "{\"design\":{},\"spede\":1,\"speed\":{\"from\":-1,\"to\":2}}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/speed_rpm/from"},
    {"sweep with an axis under both its names", "POST", API "/sweep",
     .text = "{\"design\":{},\"speed\":{\"from\":1,\"to\":2},\"speed_rpm\":{\"from\":1,\"to\":2}}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/speed_rpm"},
    {"formats", "GET", API "/export", .status = 200, .pointer = "items/0/name", .value = "flank-points"},
    {"which of them are in inches", "GET", API "/export", .status = 200, .pointer = "items/0/inches", .value = "true"},
    {"flank points", "POST", API "/export/flank-points", .body = &coarse, .status = 200,
     .header = "Content-Disposition", .holds = "filename=\"paper-pair-flank-points.csv\""},
    {"chart", "POST", API "/export/modification-chart", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"dimensions", "POST", API "/export/dimensions", .body = &coarse, .status = 200, .header = "Content-Disposition",
     .holds = "filename=\"paper-pair-dimensions.csv\""},
    {"topography", "POST", API "/export/topography", .body = &coarse, .status = 200},
    {"topography on a grid", "POST", API "/export/topography?rows=3&columns=4", .body = &coarse, .status = 200},
    {"flank points in inches", "POST", API "/export/flank-points?units=inch", .body = &coarse, .status = 200,
     .says = "x_in,"},
    {"no dimensions in inches", "POST", API "/export/dimensions?units=inch", .body = &coarse, .status = 400},
    {"a unit that is none", "POST", API "/export/topography?units=ell", .body = &coarse, .status = 400},
    {"a grid of one row", "POST", API "/export/topography?rows=1", .body = &coarse, .status = 400},
    {"a chart on a grid", "POST", API "/export/k-chart?rows=3", .body = &coarse, .status = 422},
    {"a flank that its relief folds", "POST", API "/export/step-pinion", .text = folded, .status = 200,
     .header = "Easeoff-Notes", .holds = "drive flank of the left end, where reliefs fold it: up to "},
    {"K-charts", "POST", API "/export/k-chart-drawing", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "image/svg+xml"},
    {"report", "POST", API "/report", .body = &coarse, .status = 200, .header = "Content-Type", .holds = "text/html"},
    {"report in inches", "POST", API "/report?units=inch", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "text/html", .says = "<code>/geometry/normal_module_in</code>"},
    {"a report in ells", "POST", API "/report?units=ell", .body = &coarse, .status = 400},
    {"a report of nothing", "POST", API "/report", .text = "{}", .status = 422},
    {"an analysis without rating", "POST", API "/analyze?maps=0&rating=0", .body = &coarse, .status = 200,
     .pointer = "rating", .value = "null"},
    {"the design as a file", "POST", API "/export/design", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "application/json"},
    {"a REXS model as a file", "POST", API "/export/rexs", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "application/xml"},
    {"a tooth for CAD", "POST", API "/export/step-pinion", .body = &coarse, .status = 200, .header = "Content-Type",
     .holds = "model/step"},
    {"a model read", "POST", API "/import", "Content-Type: application/octet-stream\r\n", .body = &spur, .status = 200,
     .pointer = "design/gear_pair/pinion_teeth", .value = "18"},
    {"a model of several pairs", "POST", API "/import", "Content-Type: text/xml\r\n", .body = &stages, .status = 422,
     .pointer = "imported/pairs/1/ends", .value = "2"},
    {"one of several pairs", "POST", API "/import?pair=2", "Content-Type: text/xml\r\n", .body = &stages, .status = 200,
     .pointer = "design/gear_pair/ends", .value = "2"},
    {"no such pair", "POST", API "/import?pair=9", .body = &stages, .status = 422, .pointer = "imported/faults/0/kind",
     .value = "no_such_pair"},
    {"a flank that is none", "POST", API "/import?flank=upper", .body = &spur, .status = 400},
    {"a file in the parts of a form", "POST", API "/import", "Content-Type: multipart/form-data; boundary=x\r\n",
     .text = "--x\r\n\r\n<a>\r\n--x--\r\n", .status = 415},
    {"no model", "POST", API "/import", .text = "<a>", .status = 422, .pointer = "imported/faults/0/kind",
     .value = "not_rexs"},
    {"no such format", "POST", API "/export/picture", .body = &coarse, .status = 404},
};

static const struct command orders[] = {
    {"an order without a design", "POST", API "/jobs", .text = "{}", .status = 422, .pointer = "errors/0/pointer",
     .value = "/design"},
    {"an order with nonsense", "POST", API "/jobs",
     .text = "{\"kind\":\"cook\",\"priority\":11,\"fresh\":1,\"wish\":2,\"design\":{}}", .status = 422,
     .pointer = "errors/3/pointer", .value = "/wish"},
    {"an order under a wrong key", "POST", API "/jobs", "Idempotency-Key: a b\r\n", .body = &order, .status = 400},
    {"an order", "POST", API "/jobs", "Idempotency-Key: one\r\n", .body = &order, .status = 202, .header = "Location",
     .holds = API "/jobs/2", .pointer = "kind", .value = "optimize"},
    {"the same order again", "POST", API "/jobs", "Idempotency-Key: one\r\n", .body = &order, .status = 202,
     .pointer = "id", .value = "2"},
    {"another order under its key", "POST", API "/jobs", "Idempotency-Key: one\r\n",
     .text = "{\"kind\":\"prepare\",\"design\":{\"gear_pair\":{\"pinion_teeth\":20,\"gear_teeth\":40,\"normal_module_"
             "mm\":3,\"helix_angle_deg\":20,"
             "\"face_width_mm\":30},\"load_cases\":[{\"torque_Nm\":9,\"speed_rpm\":9}]}}",
     .status = 422, .pointer = "type", .value = "/problems/key-used"},
    {"a search", "GET", API "/jobs/2", .status = 200, .pointer = "design/gear_pair/pinion_teeth", .value = "17"},
    {"no job", "GET", API "/jobs/99", .status = 404},
    {"no job to stop", "POST", API "/jobs/99/cancel", .status = 404},
    {"no stream of no job", "GET", API "/jobs/99/events", .status = 404},
    {"no history of no job", "GET", API "/jobs/99/history", .status = 404},
    {"no result of a preparation", "GET", API "/jobs/1/result", .status = 409},
};

static const struct command after[] = {
    {"the result of a search", "GET", API "/jobs/2/result", .status = 200, .pointer = "true_evaluations",
     .value = "60"},
    {"the rows of a search", "GET", API "/jobs/2/history?limit=7", .status = 200, .pointer = "items/6/ordinal",
     .value = "6"},
    {"the next rows of a search", "GET", API "/jobs/2/history?limit=7&cursor=6", .status = 200,
     .pointer = "items/0/ordinal", .value = "7"},
    {"the last rows of a search", "GET", API "/jobs/2/history?limit=7&cursor=55", .status = 200, .pointer = "next",
     .value = "null"},
    {"the rows of a search as CSV", "GET", API "/jobs/2/history.csv", .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"the rows of a search in inches", "GET", API "/jobs/2/history.csv?units=inch", .status = 200, .says = "_thou"},
    {"no rows in inches but as CSV", "GET", API "/jobs/2/history?units=inch", .status = 400},
    {"convergence", "GET", API "/jobs/2/generations", .status = 200, .pointer = "generation/0", .value = "0"},
    {"the path of a search", "GET", API "/jobs/2/path", .status = 200, .header = "Content-Type", .holds = "text/csv"},
    {"no path of no job", "GET", API "/jobs/99/path", .status = 404},
    {"the rows of a problem", "GET", API "/history/1/rows", .status = 200, .pointer = "rows/0/outcome",
     .value = "converged"},
    {"the rows of a problem as CSV", "GET", API "/history/1/rows.csv", .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"the rows of a problem in inches", "GET", API "/history/1/rows.csv?units=inch", .status = 200, .says = "_thou"},
    {"no such problem", "GET", API "/history/99/rows", .status = 404},
    {"what a problem means", "GET", "/problems/full", .status = 200, .header = "Content-Type", .holds = "text/html"},
    {"no such problem page", "GET", "/problems/nothing", .status = 404},
    {"all problems", "GET", API "/history", .status = 200, .pointer = "problems/0/name", .value = "paper pair"},
    {"done jobs", "GET", API "/jobs?state=done&kind=optimize", .status = 200, .pointer = "items/0/id", .value = "2"},
    {"the first of the jobs", "GET", API "/jobs?limit=1", .status = 200, .pointer = "next", .value = "2"},
    {"the stop of a job that has ended", "POST", API "/jobs/2/cancel", .status = 409, .pointer = "type",
     .value = "/problems/state"},
    {"the repetition of a job that has ended", "POST", API "/jobs/2/retry", .status = 409},
    {"a copy of a job", "POST", API "/jobs/2/clone", .text = "{\"priority\":-3}", .status = 202, .pointer = "priority",
     .value = "-3"},
    {"a copy of a job as it is", "POST", API "/jobs/2/clone", .status = 202},
    {"a copy with half a priority", "POST", API "/jobs/2/clone", .text = "{\"priority\":0.5}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/priority"},
    {"a copy with a design", "POST", API "/jobs/2/clone", .text = "{\"design\":{}}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/design"},
    {"a copy with a priority in words", "POST", API "/jobs/2/clone", .text = "{\"priority\":\"high\"}", .status = 422},
    {"the removal of a job", "DELETE", API "/jobs/2", .status = 204},
    {"a removed job", "GET", API "/jobs/2", .status = 404},
};

static const struct command studies[] = {
    {"what a study takes", "POST", API "/study-cost", .body = &study, .status = 200, .pointer = "variants",
     .value = "6"},
    {"a study that varies nothing", "POST", API "/studies", .body = &named, .status = 422,
     .pointer = "errors/0/pointer", .value = "/vary"},
    {"a study as any job", "POST", API "/jobs", .text = "{\"kind\":\"study\",\"design\":{\"gear_pair\":{}}}",
     .status = 422},
    {"a study", "POST", API "/studies", "Idempotency-Key: study\r\n", .body = &study, .status = 202,
     .header = "Location", .holds = API "/jobs/5", .pointer = "kind", .value = "study"},
    {"the same study again", "POST", API "/studies", "Idempotency-Key: study\r\n", .body = &study, .status = 202,
     .pointer = "id", .value = "5"},
    {"the table of no study", "GET", API "/studies/99/table", .status = 404},
    {"the table of a preparation", "GET", API "/studies/1/table", .status = 404},
    {"what a study can keep", "GET", API "/study-columns?cases=2", .status = 200, .pointer = "items/0/name",
     .value = "geometry.pinion_teeth"},
};
static const struct command studied[] = {
    {"the table of a study", "GET", API "/studies/5/table", .status = 200, .pointer = "items/5/values/1",
     .value = "0.5"},
    {"the best rows of a study", "GET",
     API "/studies/5/table?sort=objectives.J&limit=2&filter=objectives.J%3C2,outcome=converged", .status = 200,
     .pointer = "next", .value = "2"},
    {"the worst row of a study", "GET", API "/studies/5/table?sort=objectives.J&order=descending&limit=1",
     .status = 200, .pointer = "items/0/outcome"},
    {"a table under a filter that is none", "GET", API "/studies/5/table?filter=J", .status = 422,
     .pointer = "errors/0/pointer", .value = "/filter"},
    {"the table of a study in inches", "GET", API "/studies/5/table.csv?units=inch", .status = 200, .says = "_thou"},
    {"the table of a study as CSV", "GET", API "/studies/5/table.csv", .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"a variant's design", "GET", API "/studies/5/variants/5/design", .status = 200,
     .pointer = "modification/pinion/right/tip_relief_um", .value = "20"},
    {"no such variant", "GET", API "/studies/5/variants/6/design", .status = 422},
    {"no variant at all", "GET", API "/studies/5/variants/x/design", .status = 404},
    {"studies among the jobs", "GET", API "/jobs?kind=study", .status = 200, .pointer = "items/0/progress/fraction",
     .value = "1"},
};

static const struct command tolerances[] = {
    {"too many pairs at once", "POST", API "/tolerance", .body = &many_pairs, .status = 422,
     .pointer = "errors/0/pointer", .value = "/design/tolerance/pairs"},
    {"a limit on nothing", "POST", API "/jobs", .body = &limited, .status = 422, .pointer = "errors/0/pointer",
     .value = "/design/tolerance/limits/0/output"},
    {"many pairs later", "POST", API "/tolerance", "Prefer: respond-async\r\nIdempotency-Key: pairs\r\n",
     .body = &pairs, .status = 202, .header = "Location", .holds = API "/jobs/6", .pointer = "job/kind",
     .value = "tolerance"},
    {"the same pairs again", "POST", API "/tolerance", "Prefer: wait=1, respond-async\r\nIdempotency-Key: pairs\r\n",
     .body = &pairs, .status = 202, .pointer = "job/id", .value = "6"},
    {"pairs as any job", "POST", API "/jobs", .body = &tolerance_order, .status = 202, .header = "Location",
     .holds = API "/jobs/7"},
    {"no pairs of no job", "GET", API "/jobs/99/pairs", .status = 404},
    {"no pairs of a study", "GET", API "/jobs/5/pairs", .status = 404},
};
static const struct command toleranced[] = {
    {"the result of many pairs", "GET", API "/jobs/6/result", .status = 200, .pointer = "pairs", .value = "6"},
    {"the pairs of a job", "GET", API "/jobs/6/pairs", .status = 200, .header = "Content-Type", .holds = "text/csv"},
    {"the pairs in inches", "GET", API "/jobs/6/pairs?units=inch", .status = 200, .says = "peak_to_peak_thou"},
    {"pairs that were known", "GET", API "/jobs/7", .status = 200, .pointer = "progress/reused", .value = "6"},
    {"nothing to prune", "POST", API "/history/prune", .text = "{}", .status = 200, .pointer = "rows", .value = "0"},
    {"no such thing to prune", "POST", API "/history/prune", .text = "{\"all\":true}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/all"},
    {"a tolerance analysis goes", "DELETE", API "/jobs/7", .status = 204},
    {"pairs that another job has stay", "POST", API "/history/prune", .text = "{\"unused\":true,\"outdated\":true}",
     .status = 200, .pointer = "rows", .value = "6"},
    {"the pairs of the other job", "GET", API "/jobs/6/pairs", .status = 200},
    {"tolerance analyses among the jobs", "GET", API "/jobs?kind=tolerance", .status = 200, .pointer = "items/0/state",
     .value = "done"},
};

/* A launcher that starts one process, and one that starts none. */
static const struct command launched[] = {
    {"a study for a launcher", "POST", API "/studies", .body = &study, .status = 202, .header = "Location",
     .holds = API "/jobs/8"},
    {"a search for a launcher", "POST", API "/jobs", .body = &order, .status = 202, .header = "Location",
     .holds = API "/jobs/9"},
    {"pairs for a launcher", "POST", API "/jobs", .body = &tolerance_order, .status = 202, .header = "Location",
     .holds = API "/jobs/10"},
    {"a reproduction of another design", "POST", API "/jobs", .body = &other_paper, .status = 400, .pointer = "detail",
     .value = "A reproduction takes the paper's pair, no other design: POST /reproductions orders it."},
    {"a reproduction of no pairs", "POST", API "/reproductions", .text = "{\"pairs\":0}", .status = 422,
     .pointer = "errors/0/pointer", .value = "/pairs"},
    {"a reproduction, which no launcher takes", "POST", API "/reproductions", .body = &once_more, .status = 202,
     .header = "Location", .holds = API "/jobs/11"},
    {"no files of an analysis of pairs", "GET", API "/jobs/10/files", .status = 404},
};
static const struct command after_launch[] = {
    {"the table of a launched study", "GET", API "/studies/8/table", .status = 200, .pointer = "items/5/outcome",
     .value = "converged"},
    {"the progress of a launched study", "GET", API "/jobs/8", .status = 200, .pointer = "progress/true_evaluations",
     .value = "6"},
    {"the result of a launched search", "GET", API "/jobs/9/result", .status = 200, .pointer = "true_evaluations",
     .value = "60"},
    {"the result of launched pairs", "GET", API "/jobs/10/result", .status = 200, .pointer = "pairs", .value = "12"},
    {"the result of a reproduction", "GET", API "/jobs/11/result", .status = 200, .pointer = "optimizations/5/case",
     .value = "B"},
    {"the files of a reproduction", "GET", API "/jobs/11/files", .status = 200, .pointer = "items/0",
     .value = "comparisons.csv"},
    {"the page of a reproduction", "GET", API "/jobs/11/files/reproduction.html", .status = 200,
     .header = "Content-Type", .holds = "text/html"},
    {"a table of a reproduction", "GET", API "/jobs/11/files/comparisons.csv", .status = 200, .header = "Content-Type",
     .holds = "text/csv"},
    {"a file that is none of a reproduction", "GET", API "/jobs/11/files/easeoff.db", .status = 404},
};
/* Seven searches of the reproduction are jobs too. */
static const struct command not_launched[] = {
    {"a study for no launcher", "POST", API "/studies", .body = &study, .status = 202, .header = "Location",
     .holds = API "/jobs/19"},
};
static const struct command after_no_launch[] = {
    {"a job whose launcher did nothing", "GET", API "/jobs/19", .status = 200, .pointer = "error/detail",
     .value = "The launcher ended without a result (status 1); the server's log has what it said."},
};

#define RUN(table)                                            \
  for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) \
  run_command(&table[i])

/* What OPTIONS allows at a path is what the description lists there. */
static void check_path(const char *path, const json_t *item)
{
  static const char *const methods[][2] = {{"get", "GET"}, {"post", "POST"}, {"put", "PUT"}, {"delete", "DELETE"}};
  char real[200], expected[100] = "";
  size_t length = 0;
  length += (size_t)sprintf(real, API);
  for (const char *c = path; *c && length < sizeof real - 1; c++) {
    real[length++] = *c == '{' ? '1' : *c;
    if (*c == '{')
      c += strcspn(c, "}");
  }
  real[length] = '\0';
  for (int i = 0; i < 4; i++)
    if (json_object_get(item, methods[i][0]))
      sprintf(expected + strlen(expected), "%s%s, ", methods[i][1], i ? "" : ", HEAD");
  strcat(expected, "OPTIONS");
  struct reply reply = call("OPTIONS", real, NULL, NULL);
  const char *allow = header_of(&reply, "Allow");
  ok(reply.status == 204 && allow && strcmp(allow, expected) == 0, "%s is as described: %s", path, allow ? allow : "");
  free_reply(&reply);
}

static int count_operations(void)
{
  const char *key, *method;
  json_t *item, *operation;
  int count = 0;
  json_object_foreach(json_object_get(description, "paths"), key, item) json_object_foreach(item, method, operation)
      count++;
  return count;
}

/* The table in the program, by itself. */
#include "http/routes.h"
static void check_routes(void)
{
  int count = 0;
  for (int i = 0; eo_routes[i]; i++)
    for (const struct eo_route *route = eo_routes[i]; route->pattern; route++, count++) {
      char path[200];
      snprintf(path, sizeof path, API "%s", route->pattern);
      if (!find_operation(eo_method_name(route->method), path))
        ok(0, "%s %s is described", eo_method_name(route->method), route->pattern);
    }
  ok(count == count_operations(), "%d routes, %d described", count, count_operations());
}

/* Every reference leads somewhere, every operation has a name of its own. */
static int check_references(const json_t *value)
{
  const char *key;
  json_t *inner;
  size_t i;
  int wrong = 0;
  if (json_is_array(value)) {
    json_array_foreach(value, i, inner) wrong += check_references(inner);
    return wrong;
  }
  json_object_foreach((json_t *)value, key, inner)
  {
    wrong += strcmp(key, "$ref") == 0 && !follow(description, json_string_value(inner));
    wrong += check_references(inner);
  }
  return wrong;
}

/* Every key of an example is in what came, and is of its kind or null. */
static bool is_like(const json_t *example, const json_t *value)
{
  const char *key;
  json_t *member;
  if (json_is_null(example) || json_is_null(value))
    return value;
  if (json_is_number(example) && json_is_number(value))
    return true;
  if (json_is_boolean(example) && json_is_boolean(value))
    return true;
  if (!json_is_object(example))
    return json_typeof(example) == json_typeof(value);
  json_object_foreach((json_t *)example, key, member) if (!is_like(member, json_object_get(value, key))) return false;
  return json_is_object(value);
}

/* Sends an operation's example to it; 1 in place of a number. */
static void send_example(const char *path, const char *method, const json_t *operation, int *bodies, int *answers)
{
  const json_t *body = find(operation, "requestBody/content/application~json/example"), *example;
  char real[200] = API, upper[8] = "", pointer[100];
  size_t length = strlen(API);
  for (const char *c = path; *c && length < sizeof real - 1; c++) {
    real[length++] = *c == '{' ? '1' : *c;
    if (*c == '{')
      c += strcspn(c, "}");
  }
  real[length] = '\0';
  for (int i = 0; method[i] && i < 7; i++)
    upper[i] = (char)(method[i] & ~32);
  bool reads = strcmp(method, "get") == 0 && !strstr(path, "events");
  if (!body && !reads)
    return;
  char *text = body ? json_dumps(body, JSON_COMPACT) : NULL;
  struct reply reply = call(upper, real, "If-Match: *\r\nPrefer: respond-async\r\n", text);
  json_t *document = json_loadb(reply.body ? reply.body : "", reply.size, 0, NULL);
  if (body) {
    bool taken = reply.status < 400 || (strstr(path, "/export/") && reply.status == 404) || /* format 1 */
                 (reply.status == 409 && strstr(path, "clone")) ||
                 (reply.status == 422 && strcmp(path, "/designs/{id}/fit") == 0 &&
                  stands_there(&reply, "errors/0/pointer", "/measurements/0"));
    ok(taken, "the example of %s %s is taken: %d", upper, path, reply.status);
    if (!taken)
      printf("# %.400s\n", reply.body ? reply.body : "");
    *bodies += 1;
  }
  snprintf(pointer, sizeof pointer, "responses/%d/content/application~json/example", reply.status);
  if (reply.status < 400 && (example = find(operation, pointer))) {
    ok(is_like(example, document), "what %s %s answers is like its example", upper, path);
    *answers += 1;
  }
  json_decref(document);
  free_reply(&reply);
  free(text);
}

/* On a server where design 1 and job 1 are. */
static void check_examples(void)
{
  const char *path, *method;
  json_t *item, *operation;
  int bodies = 0, answers = 0;
  json_object_foreach(json_object_get(description, "paths"), path, item) json_object_foreach(item, method, operation)
      send_example(path, method, operation, &bodies, &answers);
  ok(bodies > 15 && answers > 10, "%d examples of bodies, %d of answers", bodies, answers);
}

static void check_description(void)
{
  const char *key;
  json_t *item;
  json_object_foreach(json_object_get(description, "paths"), key, item) check_path(key, item);
  check_routes();
  ok(check_references(description) == 0, "every schema that is named is there");
}

static char *read_command(const char *command)
{
  char *text = NULL;
  size_t size = 0, got;
  char block[4096];
  FILE *in = popen(command, "r"), *out = open_memstream(&text, &size);
  while ((got = fread(block, 1, sizeof block, in)) > 0)
    fwrite(block, 1, got, out);
  fclose(out);
  pclose(in);
  return text;
}

/* What a command says about the coarse pair, beside what the server says. */
static void check_same(const char *arguments, const char *address)
{
  char command[900];
  snprintf(command, sizeof command, "%s %s %s/coarse.json", getenv("EASEOFF") ? getenv("EASEOFF") : "./easeoff",
           arguments, server.folder);
  char *told = read_command(command);
  struct reply reply = call("POST", address, NULL, coarse);
  ok(told && reply.size > 10000 && strcmp(told, reply.body) == 0, "easeoff %s: the same bytes as %s, %zu", arguments,
     address, reply.size);
  free(told);
  free_reply(&reply);
}

static void check_export(void)
{
  char file[300];
  snprintf(file, sizeof file, "%s/coarse.json", server.folder);
  FILE *stream = fopen(file, "w");
  fputs(coarse, stream);
  fclose(stream);
  check_same("export --format flank-points", API "/export/flank-points");
  check_same("report --no-cache", API "/report");
  check_same("report --no-cache --units inch", API "/report?units=inch");
}

static void check_token(void)
{
  static const struct command guarded[] = {
      {"health is open", "GET", API "/health", .status = 200},
      {"the rest is not", "GET", API "/designs", .status = 401, .header = "WWW-Authenticate", .holds = "Bearer"},
      {"a wrong token", "GET", API "/designs", "Authorization: Bearer sesame-seed-sesame-seeds\r\n", .status = 401},
      {"half a token", "GET", API "/designs", "Authorization: Bearer sesame\r\n", .status = 401},
      {"the token", "GET", API "/designs", "Authorization: Bearer sesame-seed-sesame-seed\r\n", .status = 200},
      {"any name with a token", "GET", API "/designs",
       "Host: gears.example\r\nAuthorization: Bearer sesame-seed-sesame-seed\r\n", .status = 200},
      {"a session is wanted", "GET", API "/session", .status = 200, .pointer = "required", .value = "true"},
      {"a wrong session", "POST", API "/session", .text = "{\"token\":\"x\"}", .status = 403},
      {"a session", "POST", API "/session", .text = "{\"token\":\"sesame-seed-sesame-seed\"}", .status = 204,
       .header = "Set-Cookie", .holds = "HttpOnly; SameSite=Strict"},
      {"a made-up cookie", "GET", API "/designs", "Cookie: easeoff_session=sesame-seed\r\n", .status = 401},
  };
  RUN(guarded);
  struct reply reply = call("POST", API "/session", NULL, "{\"token\":\"sesame-seed-sesame-seed\"}");
  char cookie[300];
  const char *set = header_of(&reply, "Set-Cookie");
  snprintf(cookie, sizeof cookie, "Cookie: a=b; %.*s\r\n", set ? (int)strcspn(set, ";") : 0, set ? set : "");
  free_reply(&reply);
  reply = call("GET", API "/designs", cookie, NULL);
  ok(reply.status == 200, "a session's cookie opens what the token does, answer %d", reply.status);
  free_reply(&reply);
}

static void put_file(const char *folder, const char *name, const char *text)
{
  char path[400];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *stream = fopen(path, "w");
  fputs(text, stream);
  fclose(stream);
}

static void make_pages(char folder[300])
{
  char path[400];
  snprintf(folder, 300, "%s/web", server.folder);
  mkdir(folder, 0777);
  snprintf(path, sizeof path, "%s/figures", folder);
  mkdir(path, 0777);
  put_file(folder, "index.html", "<!doctype html><title>page</title>");
  put_file(folder, "chunk-44KD4V7L.js", "export const x = 1;");
  put_file(folder, "figures/chart.css", "p { color: red }");
  snprintf(path, sizeof path, "%s/doc", folder);
  mkdir(path, 0777);
  put_file(folder, "doc/index.html", "<!doctype html><title>manuals</title>");
  put_file(folder, ".secret", "secret");
  snprintf(path, sizeof path, "%s/passwd.txt", folder);
  if (symlink("/etc/passwd", path) != 0)
    printf("# no link\n");
}

static void check_pages(void)
{
  static const struct command pages[] = {
      {"the page", "GET", "/", .status = 200, .header = "Content-Type", .holds = "text/html"},
      {"its name", "HEAD", "/index.html", .status = 200, .header = "Content-Length", .holds = "34"},
      {"it runs only its own scripts", "GET", "/", .status = 200, .header = "Content-Security-Policy",
       .holds = "script-src 'self'; style-src 'self'"},
      {"it is asked for again", "GET", "/", .status = 200, .header = "Cache-Control", .holds = "no-cache"},
      {"in no frame", "GET", "/", .status = 200, .header = "Content-Security-Policy",
       .holds = "frame-ancestors 'none'"},
      {"a file that never changes", "GET", "/chunk-44KD4V7L.js", .status = 200, .header = "Cache-Control",
       .holds = "immutable"},
      {"a file in a folder", "GET", "/figures/chart.css", .status = 200, .header = "Content-Type", .holds = "text/css"},
      {"no folder", "GET", "/figures", .status = 404},
      {"nor its inside", "GET", "/figures/", .status = 404},
      {"the manuals", "GET", "/doc/", .status = 200, .header = "Content-Type", .holds = "text/html"},
      {"no more than any page", "GET", "/doc/", .status = 200, .header = "Content-Security-Policy",
       .holds = "script-src 'self'; style-src 'self'"},
      {"without the slash", "GET", "/doc", .status = 308, .header = "Location", .holds = "/doc/"},
      {"nothing hidden", "GET", "/.secret", .status = 404},
      {"no link out", "GET", "/passwd.txt", .status = 404},
      {"no way out", "GET", "/figures/..%2f..%2f..%2fetc/passwd", .status = 400},
      {"what a page allows", "OPTIONS", "/", .status = 204, .header = "Allow", .holds = "GET, HEAD, OPTIONS"},
      {"a path of nothing", "GET", "/nothing.html", .status = 404, .header = "Content-Type",
       .holds = "application/problem+json"},
  };
  RUN(pages);
  struct reply reply = call("GET", "/", NULL, NULL);
  char known[200];
  snprintf(known, sizeof known, "If-None-Match: %s\r\n", header_of(&reply, "ETag"));
  free_reply(&reply);
  reply = call("GET", "/", known, NULL);
  ok(reply.status == 304, "a page that the browser knows is answered with %d", reply.status);
  free_reply(&reply);
}

static void check_refusals(void)
{
  ok(!start_server("--listen", "0.0.0.0:0"), "an address for others needs a token");
  waitpid(server.pid, NULL, 0);
  ok(!start_server("--listen", "elsewhere"), "an address that is none is refused");
  waitpid(server.pid, NULL, 0);
}

/* A file of the reference cases. */
static char *case_file(const char *name)
{
  char path[4096];
  const char *cases = getenv("CASES");
  snprintf(path, sizeof path, "%s/exchange/%s", cases ? cases : "tests/cases", name);
  FILE *file = fopen(path, "rb");
  char *text = calloc(1, 1 << 17);
  if (!file || !text || fread(text, 1, (1 << 17) - 1, file) == 0)
    printf("Bail out! %s cannot be read\n", path);
  if (file)
    fclose(file);
  return text;
}

int main(void)
{
  spur = case_file("spur-1.0.rexs");
  stages = case_file("two-stage-1.5.rexs");
  json_t *document = coarse_document("ga", 60);
  coarse = coarse_text();
  order = order_text("optimize", "ga", 60, 1);
  json_t *both = json_pack("{s:s, s:O}", "name", "mine", "design", document);
  named = json_dumps(both, JSON_COMPACT);
  json_t *range = json_pack("{s:O, s:n, s:{s:i, s:i, s:i}}", "design", document, "torque", "speed", "from", 1000, "to",
                            2000, "points", 3);
  sweep = json_dumps(range, JSON_COMPACT);
  json_t *number = json_pack("{s:s, s:i, s:f, s:i}", "key", "alignment.shaft_angle_error_in_plane_deg", "from", 0, "to",
                             0.25, "points", 3),
         *numbers = json_pack("{s:O, s:o}", "design", document, "vary", number);
  vary = json_dumps(numbers, JSON_COMPACT | JSON_REAL_PRECISION(6));
  json_object_set_new(number, "key", json_string("gear_pair.helix_angle_deg"));
  vary_pair = json_dumps(numbers, JSON_COMPACT);
  json_decref(numbers);
  json_t *many = json_pack("{s:O, s:i}", "design", document, "pairs", 6);
  pairs = json_dumps(many, JSON_COMPACT);
  json_object_set_new(many, "pairs", json_integer(6000));
  many_pairs = json_dumps(many, JSON_COMPACT);
  json_object_del(many, "pairs");
  json_t *own = json_deep_copy(document);
  json_object_set_new(own, "tolerance", json_pack("{s:i}", "pairs", 12));
  json_object_set_new(many, "kind", json_string("tolerance"));
  json_object_set(many, "design", own);
  tolerance_order = json_dumps(many, JSON_COMPACT);
  json_object_set_new(many, "kind", json_string("reproduce"));
  other_paper = json_dumps(many, JSON_COMPACT);
  json_object_set_new(many, "kind", json_string("tolerance"));
  json_object_set_new(own, "tolerance", json_pack("{s:[{s:s, s:i}]}", "limits", "output", "loudness", "at_most", 1));
  limited = json_dumps(many, JSON_COMPACT);
  json_decref(own);
  json_decref(many);
  json_t *paper = json_pack("{s:b, s:i, s:i, s:i, s:O}", "quick", 1, "generations", 2, "true_evaluations", 10, "pairs",
                            2, "resolution", json_object_get(document, "resolution"));
  once_more = json_dumps(paper, JSON_COMPACT);
  json_decref(paper);
  json_t *varied = json_pack("{s:O, s:[{s:s, s:[i,i,i]}, {s:s, s:[i,f]}]}", "design", document, "vary", "key",
                             "modification.pinion.*.tip_relief_um", "values", 0, 10, 20, "key",
                             "modification.pinion.*.lead_crowning_um", "values", 0, 0.5);
  study = json_dumps(varied, JSON_COMPACT);
  json_decref(varied);
  json_decref(range);
  json_decref(both);
  json_decref(document);
  if (!make_data_folder() || !ok(start_server("--threads", "2"), "the server starts"))
    return 1;
  ok(listen_to_replies(), "the server describes itself");
  check_description();
  RUN(first);
  RUN(designs);
  RUN(analyses);
  RUN(orders);
  ok(wait_for_job(2, "done", 60), "the search ends");
  RUN(after);
  RUN(studies);
  ok(wait_for_job(5, "done", 60), "the study ends");
  RUN(studied);
  RUN(tolerances);
  ok(wait_for_job(6, "done", 60) && wait_for_job(7, "done", 60), "both tolerance analyses end");
  ok(wait_for_job(3, "done", 60) && wait_for_job(4, "done", 60), "both copies of the search end");
  RUN(toleranced);
  check_export();
  ok(stop_server(SIGTERM) == 0, "the server stops when told");
  ok(start_server("--quiet", "--launcher", "env"), "a server with a launcher starts");
  RUN(launched);
  ok(wait_for_job(8, "done", 60) && wait_for_job(9, "done", 60) && wait_for_job(10, "done", 60),
     "the jobs of the launcher end");
  ok(wait_for_job(11, "done", 120), "the reproduction ends");
  RUN(after_launch);
  ok(stop_server(SIGTERM) == 0, "the server with a launcher stops when told");
  ok(start_server("--quiet", "--launcher", "false"), "a server with a launcher that does nothing starts");
  RUN(not_launched);
  ok(wait_for_job(19, "failed", 60), "the job fails whose launcher does nothing");
  RUN(after_no_launch);
  ok(stop_server(SIGTERM) == 0, "the server with a launcher that does nothing stops when told");
  setenv("EASEOFF_TOKEN", "sesame-seed-sesame-seed", 1);
  ok(start_server("--quiet"), "a server with a token starts");
  check_token();
  ok(stop_server(SIGINT) == 0, "a server with a token stops on Ctrl-C");
  unsetenv("EASEOFF_TOKEN");
  remove_data_folder();
  ok(make_data_folder() && start_server("--quiet"), "a server with nothing in it starts");
  json_decref(call_json("POST", API "/designs", NULL, coarse, NULL));
  json_decref(call_json("POST", API "/jobs", NULL, order, NULL));
  check_examples();
  ok(stop_server(SIGTERM) == 0, "a server with nothing in it stops when told");
  char folder[300];
  make_pages(folder);
  ok(start_server("--quiet", "--web", folder), "a server with a page starts");
  check_pages();
  ok(stop_server(SIGTERM) == 0, "a server with a page stops when told");
  check_refusals();
  remove_data_folder();
  tell_what_was_heard();
  free(coarse);
  free(order);
  free(named);
  free(sweep);
  free(vary);
  free(vary_pair);
  free(pairs);
  free(many_pairs);
  free(tolerance_order);
  free(once_more);
  free(other_paper);
  free(limited);
  free(spur);
  free(stages);
  free(study);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The API's description against what every kind of work really answers: nothing comes that is not described, nothing
   described stays away for ever. */
#include "api/description.h"

/* The coarse pair with what `patch` (JSON) says otherwise. */
static json_t *design_with(const char *algorithm, int budget, const char *patch)
{
  json_t *design = coarse_document(algorithm, budget), *change = json_loads(patch, 0, NULL), *group;
  const char *key;
  json_object_foreach(change, key, group) json_object_update(json_object_get(design, key), group);
  json_decref(change);
  return design;
}

static json_t *post(const char *path, json_t *body, int *status)
{
  char *text = json_dumps(body, JSON_COMPACT);
  json_t *document = call_json("POST", path, "Prefer: wait=60\r\n", text, status);
  free(text);
  json_decref(body);
  return document;
}

static void expect_answer(const char *what, const char *path, json_t *body)
{
  int status;
  json_t *answer = post(path, body, &status);
  ok(status == 200, "%s is answered with %d", what, status);
  json_decref(answer);
}

static const char
    plain[] = "{}",
    single[] = "{\"gear_pair\": {\"ends\": 1, \"groove_width_mm\": 0}}",
    uneven[] = "{\"gear_pair\": {\"right_face_width_mm\": 48}, \"shafts\": {\"enabled\": true}}",
    unlike[] = "{\"gear_pair\": {\"right_helix_angle_deg\": 26}}",
    held[] = "{\"alignment\": {\"pinion_axial\": \"fixed\"}}", shafts[] = "{\"shafts\": {\"enabled\": true}}",
    coast[] = "{\"modification\": {\"pinion\": {\"left\": {\"twist_um\": 3, \"coast\": {\"tip_relief_um\": 9, "
              "\"root_relief_um\": 9, \"twist_um\": 4}}}}}",
    fast[] =
        "{\"alignment\": {\"shaft_angle_error_in_plane_deg\": 0.2}, \"supports\": {\"mesh_damping_ratio\": 0.005}}";

static void test_analyses(void)
{
  static const struct {
    const char *what, *path, *patch;
  } row[] = {{"analysis", API "/analyze", plain},
             {"analysis with everything", API "/analyze?histories=1&band=1", plain},
             {"analysis with the least", API "/analyze?root_stress=0&maps=0", plain},
             {"analysis with one part", API "/analyze?parts=lte&curves_of=1", plain},
             {"analysis with no part", API "/analyze?parts=", plain},
             {"analysis of one end", API "/analyze?histories=1&band=1", single},
             {"analysis of halves of unequal width", API "/analyze", uneven},
             {"analysis of halves of unequal helix", API "/analyze", unlike},
             {"analysis of a pinion that is held", API "/analyze", held},
             {"analysis on elastic shafts", API "/analyze", shafts},
             {"analysis of coast flanks with twist", API "/analyze", coast},
             {"analysis of a noisy pair", API "/analyze?histories=1", fast}};
  for (size_t i = 0; i < sizeof row / sizeof row[0]; i++)
    expect_answer(row[i].what, row[i].path, design_with("ga", 10, row[i].patch));
  json_t *design = design_with("ga", 10, plain);
  json_object_del(design, "modification");
  expect_answer("analysis of an unmodified pair", API "/analyze", design);
  design = design_with("ga", 10, plain);
  json_object_set_new(
      design, "pitch",
      json_loads("{\"pinion\": {\"tolerance_class\": 5}, \"gear\": {\"axial_wobble_um\": 2}}", 0, NULL));
  json_object_set_new(json_array_get(json_object_get(design, "load_cases"), 0), "direction", json_string("astern"));
  expect_answer("analysis of single teeth on both flanks", API "/analyze", design);
}

/* What the page asks while a slider moves: the string of its source that names an overview. Owned by the caller. */
static char *stroke_path(void)
{
  char name[2000];
  snprintf(name, sizeof name, "%s/web/src/base/analyst.js", getenv("SOURCES") ? getenv("SOURCES") : "..");
  FILE *file = fopen(name, "r");
  char *text = calloc(1, 1 << 16), *path = calloc(1, 1000);
  if (file && text && path && fread(text, 1, (1 << 16) - 1, file) > 0) {
    char *named = strstr(text, ",overview'"), *from = named;
    while (from && from > text && *from != '\'')
      from--;
    if (named)
      snprintf(path, 1000, API "/%.*s,overview&curves_of=1", (int)(named - from - 1), from + 1);
  }
  if (file)
    fclose(file);
  free(text);
  return path;
}

/* Case A at 0.1 deg with as many positions, cells and harmonics as by default, on a coarse mesh. */
static json_t *design_of_stroke(void)
{
  struct eo_design design;
  eo_example_build("paper-case-a", &design);
  design.alignment.shaft_angle_in_plane = 0.1 * M_PI / 180;
  design.resolution.elements.body = EO_BODY_SECTOR;
  design.resolution.elements.sector_teeth = 3;
  design.resolution.elements.neighbour_coupling = false;
  design.resolution.elements.layers = 6;
  design.resolution.elements.flank_rows = 4;
  design.resolution.elements.fillet_elements = 6;
  return eo_design_encode(&design);
}

/* The value at a path of keys; NULL: there is none. */
static const json_t *at_path(const json_t *value, const char *path)
{
  char key[100];
  while (value && *path) {
    snprintf(key, sizeof key, "%.*s", (int)strcspn(path, "/"), path);
    value = json_object_get(value, key);
    path += strcspn(path, "/");
    path += *path == '/';
  }
  return value;
}

/* A step of the page's slider is short, and has everything that moves on the screen. */
static void test_stroke(void)
{
  enum { MOST = 60000 };
  static const char *const shown[] = {"mesh_stiffness/tangent_left_N_per_um", "contact/load_share/left",
                                      "contact/pattern/right/pressure_MPa"};
  static const char *const compared[] = {"lte/pair_um", "lte/right_um", "lte/orders_um",
                                         "vibration/orders_normal_m_per_s2"};
  char *path = stroke_path(), *text;
  json_t *design = design_of_stroke();
  text = json_dumps(design, JSON_COMPACT);
  struct reply reply = call("POST", path, "Prefer: wait=100\r\n", text);
  ok(reply.status == 200 && reply.size > 10000 && reply.size <= MOST, "a stroke's step has %zu bytes, at most %d: %s",
     reply.size, MOST, path);
  json_t *answer = json_loadb(reply.body ? reply.body : "", reply.size, 0, NULL);
  ok(json_is_object(json_object_get(answer, "design")) && json_is_object(json_object_get(answer, "modification")),
     "the answer to a stroke has the resolved design and the flanks");
  for (int k = 0; k < 3; k++) {
    const json_t *row = json_array_get(json_object_get(answer, "load_cases"), (size_t)k);
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
      ok(json_is_array(at_path(row, shown[i])) == (k == 1), "load case %d has %s if it is the one shown", k, shown[i]);
    for (size_t i = 0; i < sizeof compared / sizeof *compared; i++)
      ok(json_is_array(at_path(row, compared[i])), "load case %d has %s, which is compared", k, compared[i]);
  }
  json_decref(answer);
  json_decref(design);
  free_reply(&reply);
  free(text);
  free(path);
}

static void test_sweeps(void)
{
  static const struct {
    const char *what, *patch, *torque, *speed;
  } row[] = {{"a sweep of speeds", plain, "null", "{\"from\": 500, \"to\": 8000, \"points\": 16}"},
             {"a sweep of torques", plain, "{\"from\": 10, \"to\": 1000, \"points\": 3}", "null"},
             {"a sweep of torques and speeds", plain, "{\"from\": 400, \"to\": 1000, \"points\": 2}",
              "{\"from\": 1500, \"to\": 2000, \"points\": 2}"},
             {"a sweep of one end", single, "null", "{\"from\": 1500, \"to\": 2000, \"points\": 2}"},
             {"a sweep through lost contact", fast, "{\"from\": 60, \"to\": 60}",
              "{\"from\": 1000, \"to\": 9000, \"points\": 33}"}};
  static const char vary[] = "{\"key\": \"alignment.coupling_thrust_N\", \"from\": -500, \"to\": 500, \"points\": 3}";
  for (size_t i = 0; i < sizeof row / sizeof row[0]; i++)
    expect_answer(row[i].what, API "/sweep",
                  json_pack("{s:o, s:o, s:o}", "design", design_with("ga", 10, row[i].patch), "torque",
                            json_loads(row[i].torque, JSON_DECODE_ANY, NULL), "speed",
                            json_loads(row[i].speed, JSON_DECODE_ANY, NULL)));
  expect_answer("a sweep of another number", API "/sweep",
                json_pack("{s:o, s:o}", "design", design_with("ga", 10, plain), "vary", json_loads(vary, 0, NULL)));
}

static void look_at(int id)
{
  static const char *const what[] = {"", "/result", "/history?limit=3", "/generations"};
  char path[100];
  for (size_t i = 0; i < sizeof what / sizeof what[0]; i++) {
    snprintf(path, sizeof path, API "/jobs/%d%s", id, what[i]);
    struct reply reply = call("GET", path, NULL, NULL);
    ok(reply.status == 200, "job %d%s is answered with %d", id, what[i], reply.status);
    free_reply(&reply);
  }
}

/* As CSV: a heading and a line for each point of the result. */
static void look_at_front(int id, bool there)
{
  char path[100];
  snprintf(path, sizeof path, API "/jobs/%d/front", id);
  struct reply csv = call("GET", path, NULL, NULL);
  ok(csv.status == (there ? 200 : 404), "the front of job %d is there for two objectives alone, answer %d", id,
     csv.status);
  snprintf(path, sizeof path, API "/jobs/%d/result", id);
  struct reply result = call("GET", path, NULL, NULL);
  json_t *document = json_loadb(result.body ? result.body : "", result.size, 0, NULL);
  const json_t *axes = json_object_get(document, "front_axes");
  const char *first = json_string_value(json_array_get(axes, 0));
  size_t lines = 0;
  for (size_t i = 0; csv.body && i < csv.size; i++)
    lines += csv.body[i] == '\n';
  if (there)
    ok(lines == 1 + json_array_size(json_object_get(document, "front")) && first && strstr(csv.body, first),
       "the heading of the front has \"%s\" and %zu points follow", first ? first : "", lines - 1);
  json_decref(document);
  free_reply(&result);
  free_reply(&csv);
}

static void test_job(const char *algorithm, int budget, const char *patch)
{
  int status;
  json_t *job = post(API "/jobs",
                     json_pack("{s:s, s:o}", "kind", "optimize", "design", design_with(algorithm, budget, patch)),
                     &status);
  int id = (int)json_integer_value(json_object_get(job, "id"));
  ok(status == 202 && wait_for_job(id, "done", 60), "a search with %s ends, job %d", algorithm, id);
  json_decref(job);
  look_at(id);
  look_at_front(id, strcmp(algorithm, "nsga2") == 0);
}

static void test_jobs(void)
{
  test_job("ga", 40, plain);
  test_job("fpga", 40, "{\"optimization\": {\"variables\": \"per_end\"}}");
  test_job("credibility-ga", 40, plain);
  test_job("nsga2", 40, plain);
  test_job("ga", 25, single);
  test_job("ga", 25,
           "{\"objective\": {\"robust\": \"mean\", \"scenarios\": [{\"shaft_angle_error_in_plane_deg\": 0.05}]}}");
  test_job("nsga2", 12,
           "{\"tolerance\": {\"preset\": \"iso_class\"}, \"optimization\": {\"front\": \"nominal_and_robust\"}, "
           "\"objective\": {\"robust\": \"percentile\", \"scatter_pairs\": 3, \"check_pairs\": 4, "
           "\"terms\": [{\"output\": \"order_1_um\"}], \"limits\": [{\"output\": \"K_Hbeta\", \"at_most\": 9}]}}");
}

static void test_lists(void)
{
  static const char *const path[] = {API "/history",  API "/jobs",    API "/schema", API "/export",
                                     API "/examples", API "/designs", API "/health"};
  for (size_t i = 0; i < sizeof path / sizeof path[0]; i++) {
    struct reply reply = call("GET", path[i], NULL, NULL);
    ok(reply.status == 200, "%s is answered with %d", path[i], reply.status);
    free_reply(&reply);
  }
}

int main(void)
{
  if (!make_data_folder() || !ok(start_server("--quiet", "--threads", "2"), "the server starts"))
    return 1;
  ok(listen_to_replies(), "the server describes itself");
  test_analyses();
  test_stroke();
  test_sweeps();
  test_jobs();
  test_lists();
  ok(stop_server(SIGTERM) == 0, "the server stops when told");
  remove_data_folder();
  expect_all_of((const char *const[]){"Result", "Sweep", "OptimizationResult", "Job", "Generations", "JobHistoryRow",
                                      "History", NULL},
                "JobError");
  tell_what_was_heard();
  return tap_done();
}

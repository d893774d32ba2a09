/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/openapi_examples.h"

#include <string.h>

/* The design that all of them are about. */
#define DESIGN                                                                                            \
  "{\"name\":\"first pair\",\"gear_pair\":{\"pinion_teeth\":23,\"gear_teeth\":57,\"normal_module_mm\":4," \
  "\"helix_angle_deg\":27,\"face_width_mm\":40},\"load_cases\":[{\"torque_Nm\":400,\"speed_rpm\":1500}]}"
#define OF_DESIGN "{\"design\":" DESIGN ","

struct example {
  const char *name, *text;
};

/* By the schema that is taken; a choice is named by its first. */
static const struct example bodies[] = {
    {"Design", DESIGN},
    {"SweepRequest", OF_DESIGN "\"speed_rpm\":{\"from\":500,\"to\":3000,\"points\":6}}"},
    {"FitOrder", "{\"unknowns\":{\"mesh_damping_ratio\":[0.02,0.3]},\"measurements\":[1]}"},
    {"RigOrder", OF_DESIGN "\"rig\":{\"turns\":20,\"sample_rate_Hz\":5000}}"},
    {"PruneOrder", "{\"predictions\":true}"},
    {"JobOrder", OF_DESIGN "\"kind\":\"tolerance\",\"priority\":2}"},
    {"JobChange", "{\"priority\":5}"},
    {"Token", "{\"token\":\"the first line of the token file\"}"},
    {"StudyOrder", OF_DESIGN "\"vary\":[{\"key\":\"load_cases.1.torque_Nm\",\"values\":[200,400,600]}]}"},
    {"ReproductionOrder", "{\"quick\":true}"},
    {"ToleranceRequest", OF_DESIGN "\"pairs\":64}"},
};

#define JOB                                                                                                         \
  "{\"id\":1,\"kind\":\"tolerance\",\"name\":\"first pair\",\"algorithm\":null,\"state\":\"running\",\"stopping\":" \
  "false,\"stopped\":null,\"has_result\":false,\"priority\":2,\"fresh\":false,\"attempts\":1,\"created\":"          \
  "\"2026-12-01T03:23:19.761Z\",\"started\":\"2026-12-01T03:23:19.780Z\",\"finished\":null,\"updated\":"            \
  "\"2026-12-01T03:23:26.917Z\",\"progress\":{\"fraction\":0.21,\"what\":\"pairs as made, 210 of 1000\","           \
  "\"generation\":0,\"true_evaluations\":210,\"predicted\":0,\"reused\":0,\"individuals\":1000,\"pfc_percent\":21," \
  "\"seconds\":3.4,\"seconds_left\":12.7},\"best\":null,\"unmodified\":null,\"error\":null}"

static const struct example answers[] = {
    {"Health",
     "{\"status\":\"ok\",\"program\":\"easeoff 0.2.0\",\"uptime_s\":12.3,\"jobs\":{\"queued\":0,\"running\":1},"
     "\"database\":\"ok\",\"free_MB\":75374,\"warnings\":[]}"},
    {"Live", "{\"status\":\"ok\",\"program\":\"easeoff 0.2.0\",\"uptime_s\":12.3}"},
    {"Session", "{\"required\":true,\"authorized\":true}"},
    {"StoredDesign", "{\"id\":1,\"revision\":1,\"name\":\"first pair\",\"created\":\"2026-12-01T03:23:19.100Z\","
                     "\"updated\":\"2026-12-01T03:23:19.100Z\",\"design\":" DESIGN "}"},
    {"Job", JOB},
    {"Preparing", "{\"job\":" JOB "}"},
    {"Jobs", "{\"items\":[" JOB "],\"next\":null}"},
    {"StudyCost", "{\"variants\":3,\"pairs\":1,\"refused_pairs\":0,\"memory_bytes\":1236001826.72,\"preparation_s\":"
                  "15.84,\"evaluation_s\":null,\"kept_bytes\":1968}"},
    {"Pruned", "{\"rows\":0,\"predictions\":18240}"},
    {"Problem",
     "{\"type\":\"/problems/invalid\",\"title\":\"Unprocessable Content\",\"status\":422,\"detail\":"
     "\"One value is wrong.\",\"errors\":[{\"pointer\":\"/gear_pair/face_width_mm\",\"detail\":\"This key is "
     "required. In its place: pinion_face_width_mm, gear_face_width_mm.\"}],\"request_id\":"
     "\"010d2c530000000b\"}"},
};

static json_t *find(const struct example *list, size_t count, const char *name, size_t length)
{
  for (size_t i = 0; i < count; i++)
    if (strlen(list[i].name) == length && strncmp(list[i].name, name, length) == 0)
      return json_loads(list[i].text, 0, NULL);
  return NULL;
}

json_t *eo_openapi_body_example(const struct eo_route *route)
{
  return find(bodies, sizeof bodies / sizeof *bodies, route->takes, strcspn(route->takes, "|"));
}

json_t *eo_openapi_answer_example(const char *schema, size_t length)
{
  return find(answers, sizeof answers / sizeof *answers, schema, length);
}

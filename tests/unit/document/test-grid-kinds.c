/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a flank's grid says that it is, measured or designed: in documents, and of the pair that all objectives relate
   to. */
#include "design/design_grids.h"
#include "document/design_document.h"
#include "format/json.h"
#include "support/tap.h"

#include <string.h>

static struct eo_faults faults;
static struct eo_geometry geometry;

static bool read_text(const char *modification, struct eo_design *design)
{
  char text[2000];
  struct eo_error error;
  snprintf(text, sizeof text,
           "{\"gear_pair\":{\"pinion_teeth\":21,\"gear_teeth\":58,\"normal_module_mm\":4,\"helix_angle_deg\":27,"
           "\"face_width_mm\":40},\"modification\":%s,\"load_cases\":[{\"torque_Nm\":450,\"speed_rpm\":2800}]}",
           modification);
  json_t *document = eo_json_parse(text, strlen(text), &error);
  faults.count = 0;
  bool good = document && eo_design_decode(document, design, NULL, &faults);
  json_decref(document);
  if (good && eo_design_complete(design, &geometry, &error)) {
    eo_faults_add(&faults, error.pointer, "%s", error.text);
    good = false;
  }
  return good;
}

static void refuse(const char *what, const char *modification, const char *pointer)
{
  struct eo_design design;
  bool good = read_text(modification, &design);
  ok(!good && faults.count > 0 && strcmp(faults.fault[0].pointer, pointer) == 0, "the decoder refuses %s: %s: %s", what,
     faults.count ? faults.fault[0].pointer : "", faults.count ? faults.fault[0].text : "");
}

#define KIND_OF(more) \
  "{\"pinion\":{\"left\":{\"grid\":{\"u_mm\":[-1,1],\"y_mm\":[-2,2],\"delta_um\":[[1,2],[3,4]]" more "}}}}"

/* What a grid says that it is, and what follows where it says nothing. */
static void test_kinds(void)
{
  static const struct {
    const char *text, *word; /* word: of the complete document; NULL: none */
    enum eo_grid_kind kind;
  } stated[] = {
      {KIND_OF(""), NULL, EO_GRID_MEASURED},
      {KIND_OF(",\"kind\":null"), NULL, EO_GRID_MEASURED},
      {KIND_OF(",\"kind\":\"measured\""), "measured", EO_GRID_MEASURED},
      {KIND_OF(",\"kind\":\"designed\""), "designed", EO_GRID_DESIGNED},
      {"{\"pinion\":{\"left\":{\"grid\":{\"csv\":\"y,-2,2\\n-1,1,2\\n1,3,4\",\"kind\":\"designed\"}}}}", "designed",
       EO_GRID_DESIGNED},
      {KIND_OF("},\"grid_nodes\":[{\"row\":1,\"column\":1,\"delta_um\":5}],\"coast\":{"), "designed", EO_GRID_DESIGNED},
  };
  static struct eo_design design;
  struct eo_error error;
  char hash[6][EO_HASH_LENGTH + 1];
  struct eo_text spec = {0};
  for (int i = 0; i < 6; i++) {
    bool good = read_text(stated[i].text, &design);
    json_t *document = good ? eo_design_encode(&design) : NULL;
    const char *word = json_string_value(eo_json_find(document, "modification/pinion/left/grid/kind"));
    ok(good && design.grids.place[EO_DRIVE_FLANK][EO_PINION][EO_LEFT].kind == stated[i].kind &&
           (stated[i].word ? word && strcmp(word, stated[i].word) == 0 : !word),
       "a grid is %s %s", word ? word : "measured where nothing is said", faults.count ? faults.fault[0].text : "");
    ok(eo_design_is_unmodified(&design) == (stated[i].kind == EO_GRID_MEASURED) &&
           eo_design_unmodified(&design).flank[EO_PINION][EO_LEFT].grid_gain == -(int)stated[i].kind,
       "the unmodified pair has a measured grid alone");
    eo_design_problem(&design, &spec, hash[i], &error);
    json_decref(document);
  }
  ok(strcmp(hash[0], hash[2]) == 0 && strcmp(hash[0], hash[3]) == 0, "a search knows its rows under any name");
  eo_text_done(&spec);
  refuse("a grid of another kind", KIND_OF(",\"kind\":\"guessed\""), "/modification/pinion/left/grid/kind");
  refuse("a table beside numbers", KIND_OF(",\"csv\":\"y,-2,2\\n-1,1,2\\n1,3,4\""),
         "/modification/pinion/left/grid/csv");
  ok(read_text("{\"pinion\":{\"left\":{\"grid_gain\":0.5,\"grid\":{\"u_mm\":[-1,1],\"y_mm\":[-2,2],"
               "\"delta_um\":[[1,2],[3,4]]}}}}",
               &design) &&
         !eo_design_is_unmodified(&design),
     "a gain on a measured grid is a modification");
}

int main(void)
{
  test_kinds();
  return tap_done();
}

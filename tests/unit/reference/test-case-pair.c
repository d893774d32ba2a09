/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What reference cases say about shaft angle errors at tip corners. */
#include "reference/case_file.h"
#include "reference/case_pair.h"
#include "support/tap.h"

#include <stdlib.h>

static void test_document(json_t *document, const char *name, enum eo_tilt_rule wanted)
{
  struct eo_case *file = eo_case_open(document);
  ok(document && eo_case_tilt_rule(file) == wanted && !eo_case_faulty(file),
     "%s follows the rule of tilt that it names", name);
  eo_case_close(file);
}

static void test_rule(const char *text, enum eo_tilt_rule wanted)
{
  test_document(json_loads(text, 0, NULL), text, wanted);
}

static void test_kept(const char *name, enum eo_tilt_rule wanted)
{
  char path[1000];
  snprintf(path, sizeof path, "%s/%s", getenv("CASES"), name);
  test_document(json_load_file(path, 0, NULL), name, wanted);
}

int main(void)
{
  test_rule("{}", EO_TILT_ROTATED);
  test_rule("{\"defaults\": {\"gap\": \"exact slice gap + misalignment\"}}", EO_TILT_SLOPE);
  test_rule("{\"conventions\": {\"end\": \"-1: misalignment slope changes sign\"}}", EO_TILT_SLOPE);
  test_rule("{\"defaults\": {\"gap\": \"... (at the pinion radius of the corner) off-line\"}}", EO_TILT_AT_RADIUS);
  test_rule("{\"defaults\": {\"gap\": \"+ misalignment, at the pinion radius of the corner\", "
            "\"tip corner convention\": \"rigid rotation of the gear\"}}",
            EO_TILT_SLOPE);
  test_rule("{\"defaults\": {\"tip_corner_convention\": \"rotation\"}}", EO_TILT_ROTATED);
  test_rule("{\"conventions\": {\"tip_corner_convention\": \"at the radius of the corner\"}}", EO_TILT_AT_RADIUS);
  test_kept("contact.json", EO_TILT_SLOPE);
  test_kept("evaluation.json", EO_TILT_AT_RADIUS);
  struct eo_case *file = eo_case_open(json_pack("{s:{s:s}}", "defaults", "tip_corner_convention", "as usual"));
  eo_case_tilt_rule(file);
  ok(eo_case_faulty(file), "a convention that is none is a fault");
  eo_case_close(file);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Documents in inches and back: which keys are lengths, which are not, and that nothing else changes. */
#include <stdlib.h>
#include <string.h>

#include "format/inch.h"
#include "format/json.h"
#include "support/tap.h"

static json_t *parse(const char *text)
{
  struct eo_error error = {0};
  json_t *value = eo_json_parse(text, strlen(text), &error);
  if (!value)
    printf("# %s\n", error.text);
  return value;
}

static bool is(const json_t *value, const char *text)
{
  json_t *expected = parse(text);
  bool same = json_equal(expected, value);
  char *found = json_dumps(value, JSON_COMPACT);
  if (!same)
    printf("# %s\n", found ? found : "nothing");
  json_decref(expected);
  free(found);
  return same;
}

int main(void)
{
  static struct eo_faults faults;
  static const char *const metric =
      "{\"face_width_mm\":50.8,\"tip_relief_um\":25.4,\"bounds\":{\"tip_relief_um\":[0.0,127.0]},"
      "\"grid\":{\"delta_um\":[[2.54,5.08],[0.0,25.4]]},\"stiffness_N_per_um\":800.0,\"q_N_per_mm\":3.0,"
      "\"crowning_per_um\":2.0,\"groove_width_mm\":null,\"name\":\"a_mm\",\"teeth\":17}";
  static const char *const inches =
      "{\"face_width_in\":2.0,\"tip_relief_thou\":1.0,\"bounds\":{\"tip_relief_thou\":[0.0,5.0]},"
      "\"grid\":{\"delta_thou\":[[0.1,0.2],[0.0,1.0]]},\"stiffness_N_per_um\":800.0,\"q_N_per_mm\":3.0,"
      "\"crowning_per_um\":2.0,\"groove_width_in\":null,\"name\":\"a_mm\",\"teeth\":17}";
  json_t *document = parse(metric), *other = eo_inch_from_mm(document), *back = eo_inch_to_mm(other, &faults);
  ok(is(other, inches), "lengths alone are spelt in inches");
  ok(faults.count == 0 && is(back, metric), "and come back as they were");
  ok(eo_inch_is_used(other) && !eo_inch_is_used(document), "which of both a document is can be told");
  json_decref(document);
  json_decref(other);
  json_decref(back);

  document = parse("{\"assumed\":[{\"key\":\"/gear_pair/pinion_bore_mm\",\"value\":25.4,\"rule\":\"solid\"},"
                   "{\"key\":\"/gear_pair/pinion_teeth\",\"value\":25}]}");
  other = eo_inch_from_mm(document);
  ok(is(other, "{\"assumed\":[{\"key\":\"/gear_pair/pinion_bore_in\",\"value\":1.0,\"rule\":\"solid\"},"
               "{\"key\":\"/gear_pair/pinion_teeth\",\"value\":25}]}"),
     "rows that name a length have it in inches");
  json_decref(document);
  json_decref(other);

  document = parse("{\"gear_pair\":{\"face_width_mm\":50,\"face_width_in\":2}}");
  json_decref(eo_inch_to_mm(document, &faults));
  ok(faults.count == 1 && strstr(faults.fault[0].text, "face_width_in"), "both at once is a fault: %s",
     faults.fault[0].text);
  json_decref(document);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Documents in inches and back: which keys are lengths, which are not, and that nothing else changes. */
#include <stdlib.h>
#include <string.h>

#include "format/inch.h"
#include "format/inch_sentence.h"
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

/* What the page reads as well: tests/browser/units.mjs. */
static void test_sentences(void)
{
  static const struct {
    const char *metric, *inch;
  } pair[] = {
      {"The face, 70 mm, is wide.", "The face, 2.7559 in, is wide."},
      {"177800 is outside 0.5 .. 5000 mm.", "7000 is outside 0.019685 .. 196.85 in."},
      {"From diameter 152.4001 to 177.8 mm, roll 5 to 7 deg.", "From diameter 6.000004 to 7 in, roll 5 to 7 deg."},
      {"The gears 17 and 18 are 254 and 127 mm wide; 18 and more.",
       "The gears 17 and 18 are 10 and 5 in wide; 18 and more."},
      {"2/3 (0.06 mm + 0.0005 a + 0.03 m_n)", "2/3 (0.0023622 in + 0.0005 a + 0.03 m_n)"},
      {"-25.4 um, 1e-05 mm, 5.08 \xc2\xb5m", "-1 thou, 3.937e-07 in, 0.2 thou"},
      {"8 N/um, 3 mm/s, 7 mm2, 7 mm\xc2\xb2, 5 N mm, 600 N m", "8 N/um, 3 mm/s, 7 mm2, 7 mm\xc2\xb2, 5 N mm, 600 N m"},
      {"ISO 286-1 and 25.4 mm; A2 mm; v1.2 mm", "ISO 286-1 and 1 in; A2 mm; v1.2 mm"},
      {"State gear_pair.face_width_mm above 0, or crowning_um, not q_N_per_mm.",
       "State gear_pair.face_width_in above 0, or crowning_thou, not q_N_per_mm."},
      {"", ""},
  };
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
    struct eo_text text = {0};
    eo_inch_sentence(&text, pair[i].metric);
    const char *made = text.data ? text.data : "";
    ok(strcmp(made, pair[i].inch) == 0, "a sentence is said in inches: %s", made);
    eo_text_done(&text);
  }
}

static void test_places(void)
{
  json_t *document =
      parse("{\"gear_pair\":{\"face_width_in\":7000,\"groove_width_mm\":1},\"cases\":[{\"shift_thou\":1}]}");
  struct eo_error fault = {.pointer = "/gear_pair/face_width_mm", .text = "177800 is outside 0.5 .. 5000 mm."},
                  other = {.pointer = "/gear_pair/groove_width_mm", .text = "At least 2 mm."},
                  listed = {.pointer = "/cases/0/shift_um", .text = "At most 2.54 um."};
  eo_inch_place(document, &fault);
  eo_inch_place(document, &other);
  eo_inch_place(document, &listed);
  ok(strcmp(fault.pointer, "/gear_pair/face_width_in") == 0 &&
         strstr(fault.text, "7000 is outside 0.019685 .. 196.85 in."),
     "a fault stands at the key as it was stated: %s: %s", fault.pointer, fault.text);
  ok(strcmp(other.pointer, "/gear_pair/groove_width_mm") == 0 && strstr(other.text, "2 mm"),
     "a fault at a key in mm stays as it is");
  ok(strcmp(listed.pointer, "/cases/0/shift_thou") == 0 && strstr(listed.text, "0.1 thou"),
     "a fault at a key within a list is said in inches: %s", listed.pointer);
  json_decref(document);
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
  ok(faults.count == 0 && is(back, metric), "lengths that were spelt in inches come back as they were");
  ok(eo_inch_is_used(other) && !eo_inch_is_used(document), "a document in inches can be told from one in mm");
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

  document = parse("{\"warnings\":[\"At 25.4 mm.\"],\"findings\":[{\"text\":\"5.08 um\"}],\"name\":\"25.4 mm\","
                   "\"span_reason\":\"A face of 50.8 mm.\",\"unchecked\":[\"above 25.4 um\"]}");
  other = eo_inch_from_mm(document);
  ok(is(other, "{\"warnings\":[\"At 1 in.\"],\"findings\":[{\"text\":\"0.2 thou\"}],\"name\":\"25.4 mm\","
               "\"span_reason\":\"A face of 2 in.\",\"unchecked\":[\"above 1 thou\"]}"),
     "sentences in rows are said in inches, and names are not");
  json_decref(document);
  json_decref(other);
  document = parse("{\"least_film_um\":{\"left\":25.4,\"right\":[2.54,null]}}");
  other = eo_inch_from_mm(document);
  ok(is(other, "{\"least_film_thou\":{\"left\":1.0,\"right\":[0.1,null]}}"),
     "numbers of both ends are spelt in inches");
  json_decref(document);
  json_decref(other);
  test_sentences();
  test_places();

  document = parse("{\"gear_pair\":{\"face_width_mm\":50,\"face_width_in\":2}}");
  json_decref(eo_inch_to_mm(document, &faults));
  ok(faults.count == 1 && strstr(faults.fault[0].text, "face_width_in"), "a length stated in both units is a fault: %s",
     faults.fault[0].text);
  json_decref(document);
  return tap_done();
}

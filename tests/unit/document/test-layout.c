/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a recording as people state it: what is taken, and where what is wrong stands. */
#include <stdlib.h>
#include <string.h>

#include "document/layout_document.h"
#include "format/json.h"
#include "support/tap.h"

static const char *shown(const char *name)
{
  return name ? name : "-";
}

/* A layout in one line, in SI. */
static void show(const struct eo_layout_choice *choice, char *text, size_t size)
{
  snprintf(text, size, "%d %d, time %s %s of %g s, %g Hz, lines %g %g, pinion %s %s, gear %s %s", (int)choice->kind,
           (int)choice->unit, shown(choice->time), shown(choice->gear_time), choice->time_scale, choice->sample_rate,
           choice->lines[0], choice->lines[1], shown(choice->column[0][0]), shown(choice->column[0][1]),
           shown(choice->column[1][0]), shown(choice->column[1][1]));
}

/* The layout as it is read, or the first fault of it. */
static void read(const char *document, char *text, size_t size)
{
  struct eo_layout_request *request = malloc(sizeof *request);
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *json = json_loads(document, JSON_DECODE_ANY, NULL);
  if (!request || !faults || !json)
    exit(99);
  eo_layout_decode(json, request, faults);
  if (faults->count)
    snprintf(text, size, "%s: %s", faults->fault[0].pointer, faults->fault[0].text);
  else
    show(&request->choice, text, size);
  json_decref(json);
  free(faults);
  free(request);
}

static void check(const char *document, const char *expected)
{
  char text[800];
  read(document, text, sizeof text);
  ok(strcmp(text, expected) == 0, "%s is read as %s", document, text);
}

static void check_taken(void)
{
  static const char open[] = "0 0, time - - of 0 s, 0 Hz, lines 0 0, pinion - -, gear - -";
  check("null", open);
  check("{}", open);
  check(
      "{\"kind\":\"guess\",\"unit\":\"guess\",\"time\":null,\"time_unit\":null,\"sample_rate_Hz\":null,\"lines\":null,"
      "\"columns\":{\"pinion\":null,\"gear\":null}}",
      open);
  check("{\"kind\":\"pulses\",\"lines\":1024}", "3 0, time - - of 0 s, 0 Hz, lines 1024 1024, pinion - -, gear - -");
  check("{\"unit\":\"count\",\"lines\":[null,18000]}",
        "0 4, time - - of 0 s, 0 Hz, lines 0 18000, pinion - -, gear - -");
  check("{\"time\":2,\"time_unit\":\"min\",\"columns\":{\"pinion\":\"angle\",\"gear\":12}}",
        "0 0, time 2 - of 60 s, 0 Hz, lines 0 0, pinion angle -, gear 12 -");
  check("{\"time\":[\"t1\",null],\"time_unit\":1e-7,\"columns\":{\"pinion\":[3,\"cos\"]}}",
        "0 0, time t1 - of 1e-07 s, 0 Hz, lines 0 0, pinion 3 cos, gear - -");
  check("{\"time\":[null,5],\"kind\":\"sine-cosine\",\"sample_rate_Hz\":20000}",
        "2 0, time - 5 of 0 s, 20000 Hz, lines 0 0, pinion - -, gear - -");
  check("{\"time\":\"none\"}", "0 0, time none - of 0 s, 0 Hz, lines 0 0, pinion - -, gear - -");
}

static void check_refused(void)
{
  check("[]", ": Must be an object, not an array.");
  check("{\"kind\":\"angle\"}", "/kind: \"angle\" is none of \"guess\", \"angles\", \"sine-cosine\", \"pulses\".");
  check("{\"unit\":7}", "/unit: Must be one of \"guess\", \"deg\", \"rad\", \"turn\", \"count\", not a number.");
  check("{\"time\":0}", "/time: 0 is outside 1 .. 256.");
  check("{\"time\":1.5}", "/time: 1.5 is not a whole number.");
  check("{\"time\":true}", "/time: Must be a name or a number from 1, not true.");
  check("{\"time\":\"\"}", "/time: A string of 0 bytes is shorter than the 1 needed.");
  check("{\"time\":[1]}", "/time: Must be one name or number, or an array of 2, not of 1.");
  check("{\"time\":[1,{}]}", "/time/1: Must be a name or a number from 1, not an object.");
  check("{\"time_unit\":\"hour\"}", "/time_unit: \"hour\" is none of \"s\", \"ms\", \"us\", \"ns\", \"min\", \"d\".");
  check("{\"time_unit\":-1}", "/time_unit: -1 is outside 1e-15 .. 1000000000000.");
  check("{\"time_unit\":[1]}", "/time_unit: Must be a number, not an array.");
  check("{\"sample_rate_Hz\":0}", "/sample_rate_Hz: 0 is outside 1e-09 .. 1000000000000 Hz.");
  check("{\"lines\":0}", "/lines: 0 is outside 1e-09 .. 1000000000000.");
  check("{\"lines\":[1,2,3]}", "/lines: Must be an array of 2 numbers, not an array of another length.");
  check("{\"lines\":[1,\"2\"]}", "/lines/1: Must be a number, not a string.");
  check("{\"columns\":[1,2]}", "/columns: Must be an object, not an array.");
  check("{\"columns\":{\"wheel\":1}}", "/columns/wheel: Unknown key in the columns.");
  check("{\"columns\":{\"gear\":[1,2,3]}}", "/columns/gear: Must be one name or number, or an array of 2, not of 3.");
  check("{\"rate\":1}", "/rate: Unknown key in a layout.");
}

/* What is written of a layout that was read is read as the same again. */
static void check_round_trip(const char *document)
{
  struct eo_layout_request *request = malloc(sizeof *request);
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *json = json_loads(document, 0, NULL);
  if (!request || !faults || !json)
    exit(99);
  eo_table_decode(&eo_asked_layout_table, json, NULL, request, faults);
  json_t *written = eo_table_encode(&eo_asked_layout_table, request);
  eo_table_decode(&eo_asked_layout_table, written, NULL, request, faults);
  json_t *again = eo_table_encode(&eo_asked_layout_table, request);
  struct eo_text text = {0};
  eo_json_write(&text, again, EO_JSON_COMPACT);
  ok(faults->count == 0 && written && json_equal(written, again), "a layout is written and read again: %s", text.data);
  eo_text_done(&text);
  json_decref(json);
  json_decref(written);
  json_decref(again);
  free(faults);
  free(request);
}

int main(void)
{
  check_taken();
  check_refused();
  check_round_trip("{}");
  check_round_trip("{\"kind\":\"pulses\",\"time\":[\"t\",7],\"time_unit\":\"us\",\"lines\":[3,null],"
                   "\"columns\":{\"gear\":\"b\",\"pinion\":[null,2]}}");
  return tap_done();
}

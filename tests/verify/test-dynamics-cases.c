/* Every block of the reference file for the dynamics, through the function behind `easeoff verify`. */
#include <string.h>

#include "../cases-json.h"
#include "app/verify_dynamics.h"

static void report(const json_t *rows)
{
  size_t i;
  json_t *row;
  json_array_foreach(rows, i, row)
    ok(json_is_true(json_object_get(row, "pass")), "%s %s: %.10g, expected %.10g +- %.3g", json_string_value(json_object_get(row, "case")),
       json_string_value(json_object_get(row, "quantity")), json_number_value(json_object_get(row, "value")),
       json_number_value(json_object_get(row, "expected")), json_number_value(json_object_get(row, "tolerance")));
}

static size_t failures(const json_t *cases)
{
  json_t *rows = json_array(), *row;
  size_t i, failed = 0;
  if (eo_verify_dynamics(cases, rows, NULL))
    failed = 1000;
  json_array_foreach(rows, i, row)
    failed += !json_is_true(json_object_get(row, "pass"));
  json_decref(rows);
  return failed;
}

/* A verification that cannot fail is none: wrong expectations must be noticed. */
static void notices_wrong_numbers(json_t *cases)
{
  json_t *first = json_array_get(json_object_get(cases, "dynamics"), 0), *expected = json_object_get(first, "expected");
  json_object_set_new(expected, "rms_meanLR", json_real(18.71));
  ok(failures(cases) == 1, "an RMS that is off by 3e-4 is noticed");
  json_object_set_new(first, "law", json_string("K99"));
  struct eo_error error = {0};
  json_t *rows = json_array();
  int refused = eo_verify_dynamics(cases, rows, &error) == EO_ERROR_INPUT && strstr(error.pointer, "K99");
  ok(refused, "an unknown law is refused: %s", error.text);
  json_decref(rows);
}

int main(void)
{
  struct eo_error error = {0};
  json_t *cases = load_cases("dynamics.json"), *rows = json_array();
  int failed = eo_verify_dynamics(cases, rows, &error);
  ok(!failed, "the file is worked through %s", error.text);
  ok(json_array_size(rows) > 150, "%zu numbers are compared", json_array_size(rows));
  report(rows);
  notices_wrong_numbers(cases);
  json_decref(rows);
  json_decref(cases);
  return tap_done();
}

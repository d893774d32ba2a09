#include "app/verify_row.h"

#include <math.h>

void eo_verify_row(json_t *rows, const char *name, const char *quantity, double value, double expected, double tolerance)
{
  json_t *row = json_object();
  int pass = isfinite(value) && fabs(value - expected) <= tolerance;
  json_object_set_new(row, "case", json_string(name));
  json_object_set_new(row, "quantity", json_string(quantity));
  json_object_set_new(row, "value", isfinite(value) ? json_real(value) : json_null());
  json_object_set_new(row, "expected", json_real(expected));
  json_object_set_new(row, "tolerance", json_real(tolerance));
  json_object_set_new(row, "pass", json_boolean(pass));
  json_array_append_new(rows, row);
}

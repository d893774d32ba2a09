/* Reference cases of kind "optimizer" through the real code: the counter, prediction, redundancy, decay, clean-up,
   operators, whole runs, and the successor's latin hypercube, surrogate and credibility. */
#ifndef EASEOFF_APP_VERIFY_OPTIMIZER_H
#define EASEOFF_APP_VERIFY_OPTIMIZER_H

#include "base/error.h"

#include <jansson.h>
#include <stdbool.h>

struct eo_verify_row {
  const char *name;     /* of the case: block and index; borrowed during the call, as is the next */
  const char *quantity;
  double value, expected, tolerance; /* absolute */
  bool pass;
};

typedef void eo_verify_row_function(void *context, const struct eo_verify_row *row);

/* Calls emit for every number of the file. EO_ERROR_INPUT when the file is not of the format, with the pointer. */
enum eo_code eo_verify_optimizer(json_t *root, eo_verify_row_function *emit, void *context, struct eo_error *error);

#endif

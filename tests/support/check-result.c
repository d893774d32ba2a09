/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exit 0 when standard input is a result document with every name that is relied on: check-result ENDS. */
#include <stdlib.h>

#include "support/contract.h"

int main(int argc, char **argv)
{
  struct eo_error error;
  json_t *result = eo_json_load("-", EO_JSON_CASES_BYTES, &error);
  if (!result) {
    printf("# %s\n", error.text);
    return 1;
  }
  int faults = contract_check(result, argc > 1 ? atoi(argv[1]) : 2, true);
  json_decref(result);
  return faults != 0;
}

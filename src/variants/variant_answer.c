/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_answer.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* What stands in front; numbers, raw values and the modification follow. */
struct head {
  int32_t outcome, numbers, cases, modification; /* bytes with their NUL */
  double cost;
  char reason[EO_REASON_LENGTH];
};

void eo_variant_answer_write(const struct eo_variant_answer *answer, struct eo_text *text)
{
  struct head head;
  memset(&head, 0, sizeof head);
  head.outcome = (int32_t)answer->outcome;
  head.numbers = answer->numbers;
  head.cases = answer->cases;
  head.modification = (int32_t)strlen(answer->modification) + 1;
  head.cost = answer->cost;
  memcpy(head.reason, answer->reason, sizeof head.reason);
  eo_text_add_bytes(text, &head, sizeof head);
  eo_text_add_bytes(text, answer->number, sizeof *answer->number * (size_t)answer->numbers);
  eo_text_add_bytes(text, answer->raw, sizeof *answer->raw * (size_t)answer->cases);
  eo_text_add_bytes(text, answer->modification, (size_t)head.modification);
}

bool eo_variant_answer_read(struct eo_variant_answer *answer, const char *bytes, size_t size, void **room)
{
  struct head head;
  *room = NULL;
  if (size < sizeof head)
    return false;
  memcpy(&head, bytes, sizeof head);
  size_t numbers = sizeof(double) * (size_t)head.numbers, raw = sizeof(struct eo_objective_case) * (size_t)head.cases;
  if (head.numbers < 0 || head.cases < 0 || head.modification < 1 ||
      size != sizeof head + numbers + raw + (size_t)head.modification)
    return false;
  char *copy = malloc(size - sizeof head);
  if (!copy)
    return false;
  memcpy(copy, bytes + sizeof head, size - sizeof head);
  *answer = (struct eo_variant_answer){.outcome = (enum eo_evaluation_outcome)head.outcome,
                                       .cost = head.cost,
                                       .numbers = head.numbers,
                                       .cases = head.cases,
                                       .number = (const double *)(void *)copy,
                                       .raw = (const struct eo_objective_case *)(void *)(copy + numbers),
                                       .modification = copy + numbers + raw};
  memcpy(answer->reason, head.reason, sizeof answer->reason);
  answer->reason[sizeof answer->reason - 1] = '\0';
  *room = copy;
  return true;
}

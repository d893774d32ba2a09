/* All kinds of case files. */
#include "reference/verify.h"
#include "reference/verify_contact.h"
#include "reference/verify_evaluation.h"

static const struct eo_verify_kind kinds[] = {
    {"calculix", eo_verify_calculix},   {"contact", eo_verify_contact},       {"dynamics", eo_verify_dynamics},
    {"encoder", eo_verify_encoder},     {"evaluation", eo_verify_evaluation}, {"optimizer", eo_verify_optimizer},
    {"standards", eo_verify_standards},
};

const struct eo_verify_kind *eo_verify_kind_at(int index)
{
  return index >= 0 && index < (int)(sizeof kinds / sizeof kinds[0]) ? &kinds[index] : NULL;
}

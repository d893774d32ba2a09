/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All kinds of case files. */
#include <string.h>

#include "format/text.h"
#include "reference/verify.h"
#include "reference/verify_contact.h"
#include "reference/verify_deviations.h"
#include "reference/verify_evaluation.h"
#include "reference/verify_tolerance.h"

static const struct eo_verify_kind kinds[] = {
    {"calculix", eo_verify_calculix},   {"contact", eo_verify_contact},  {"deviations", eo_verify_deviations},
    {"dynamics", eo_verify_dynamics},   {"encoder", eo_verify_encoder},  {"evaluation", eo_verify_evaluation},
    {"exchange", eo_verify_exchange},   {"gear-public", eo_verify_gear}, {"optimizer", eo_verify_optimizer},
    {"rating", eo_verify_rating},       {"ring", eo_verify_ring},        {"standards", eo_verify_standards},
    {"tolerance", eo_verify_tolerance},
};

/* NULL after the last. */
static const struct eo_verify_kind *kind_at(int index)
{
  return index >= 0 && index < (int)(sizeof kinds / sizeof kinds[0]) ? &kinds[index] : NULL;
}

static const struct eo_verify_kind *find_kind(struct eo_case *file)
{
  const char *name = eo_case_word(file, "kind");
  struct eo_text known = {0};
  const struct eo_verify_kind *kind;
  if (!name)
    return NULL;
  for (int i = 0; (kind = kind_at(i)); i++) {
    if (strcmp(name, kind->name) == 0) {
      eo_text_done(&known);
      return kind;
    }
    eo_text_print(&known, "%s%s", i ? ", " : "", kind->name);
  }
  eo_case_fault(eo_case_find(file, "kind"), "\"%.40s\" is not a kind of case file; known: %s.", name,
                known.data ? known.data : "");
  eo_text_done(&known);
  return NULL;
}

enum eo_code eo_verify_run(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  const struct eo_verify_kind *kind = find_kind(file);
  enum eo_code code = kind ? kind->run(file, verification, error) : EO_OK;
  if (!code && verification->failed)
    code = eo_error_memory(error);
  if (code)
    return code;
  if (kind && verification->count == 0 && !eo_case_faulty(file))
    eo_case_fault(file, "Nothing in this file is checked.");
  if (kind)
    eo_case_sweep(file);
  return EO_OK;
}

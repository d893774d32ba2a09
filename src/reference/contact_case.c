/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/contact_case.h"

#include <stdio.h>
#include <string.h>

#include "gear/names.h"

enum { WORD_SIZE = 41 };

enum eo_code eo_contact_rig_prepare(struct eo_contact_rig *rig, const struct eo_pair_options *options,
                                    struct eo_error *error)
{
  enum eo_code code = eo_pair_new(&rig->pair, &rig->design, options, NULL, error);
  return code ? code : eo_evaluator_new(&rig->evaluator, rig->pair, 1, error);
}

void eo_contact_rig_done(struct eo_contact_rig *rig)
{
  eo_evaluator_free(rig->evaluator);
  eo_pair_free(rig->pair);
}

void eo_contact_case_done(struct eo_contact_case *contact_case)
{
  eo_contact_rig_done(&contact_case->sector);
}

enum eo_code eo_contact_case_init(struct eo_contact_case *contact_case, struct eo_case *file,
                                  struct eo_verification *verification, struct eo_error *error)
{
  struct eo_case *block = eo_case_find(file, "modification");
  *contact_case = (struct eo_contact_case){.file = file, .v = verification, .tilt_rule = eo_case_tilt_rule(file)};
  eo_case_design(eo_case_need(eo_case_need(file, "macro"), "input"), &contact_case->design);
  contact_case->mods = block ? eo_case_find(block, "mods") : NULL;
  for (int i = 0; i < eo_case_size(contact_case->mods) && !eo_case_faulty(file); i++) {
    struct eo_flank_modification flank;
    eo_case_modification(eo_case_at(contact_case->mods, i), &contact_case->design.gear_pair, &flank);
    eo_case_sweep(eo_case_at(contact_case->mods, i));
  }
  if (eo_case_faulty(file))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&contact_case->geometry, &contact_case->design.gear_pair, error);
  if (!code)
    eo_design_resolve(&contact_case->design, &contact_case->geometry);
  return code;
}

void eo_contact_case_modification(struct eo_contact_case *contact_case, const char *name, struct eo_case *where,
                                  struct eo_flank_modification *flank)
{
  eo_case_named_modification(contact_case->mods, name, where, &contact_case->design.gear_pair, flank);
}

void eo_contact_case_modify(struct eo_contact_case *contact_case, struct eo_case *item, struct eo_design *design)
{
  const char *both = eo_case_word_given(item, "mod"),
             *name = eo_case_word_given(item, eo_case_find(item, "case") ? "case" : "name");
  char word[WORD_SIZE] = "";
  if (name)
    snprintf(word, sizeof word, "%.*s", (int)strcspn(name, " ,"), name);
  for (int end = 0; end < 2; end++) {
    const char *own = eo_case_word_given(item, eo_end_name[end]), *use = own ? own : both ? both : word;
    eo_contact_case_modification(contact_case, use, item, &design->modification.flank[EO_PINION][end]);
  }
}

void eo_contact_case_ends(struct eo_contact_case *contact_case, struct eo_case *item, const char *key,
                          const double value[2], double relative, double absolute)
{
  struct eo_case *list = eo_case_find(item, key);
  if (list)
    eo_verify_list(contact_case->v, list, 2, value, 1, relative, absolute);
}

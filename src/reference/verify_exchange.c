/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of other programs: the pairs found, the design read from the chosen one, and what was said about the rest. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/import.h"
#include "exchange/rexs_model.h"
#include "reference/verify.h"

static const double relative = 1e-9, absolute = 1e-9; /* as the cases state it */

struct run {
  struct eo_verification *v;
};

/* Pairs: */

static bool same_ids(const json_t *expected, const json_t *found)
{
  return json_equal(expected, found);
}

static void check_pairs(struct eo_verification *verification, struct eo_case *pairs, const struct eo_import *import)
{
  if (!pairs || eo_case_is_null(pairs))
    return;
  eo_verify_derived(verification, pairs, "number of pairs", (double)import->pairs, eo_case_size(pairs), 0.5);
  for (int i = 0; i < eo_case_size(pairs); i++) {
    struct eo_case *pair = eo_case_at(pairs, i);
    const json_t *expected = eo_case_json(pair);
    json_t *found = i < import->pairs ? eo_outline_encode(&eo_import_pair_outline, &import->pair[i]) : NULL;
    static const char *const ids[] = {"pinion", "gear", "stages"};
    eo_case_remark(pair, "label");
    eo_case_remark(pair, "remark");
    for (int k = 0; k < 3; k++) {
      struct eo_case *list = eo_case_need(pair, ids[k]);
      eo_verify_fact(verification, list, ids[k],
                     same_ids(json_object_get(expected, ids[k]), json_object_get(found, ids[k])));
      eo_case_skip(list);
    }
    eo_verify_exact(verification, eo_case_need(pair, "ends"),
                    (double)json_integer_value(json_object_get(found, "ends")));
    eo_verify_exact(verification, eo_case_need(pair, "importable"), json_is_true(json_object_get(found, "importable")));
    json_decref(found);
  }
}

/* Design: */

/* What a file says of any pair, but a case written before designs had these keys says nothing of. */
static bool is_left_open(const char *path)
{
  return strcmp(path, "gear_pair.hand") == 0 || strcmp(path, "alignment.apex") == 0;
}

/* Every key the case states, and every other one that differs from what it has without being stated. */
static void compare(struct eo_verification *verification, struct eo_case *where, const json_t *stated,
                    const json_t *expected, const json_t *found, const char *path)
{
  char name[200];
  const char *key;
  json_t *value;
  size_t i;
  if (json_is_object(expected)) {
    json_object_foreach((json_t *)expected, key, value)
    {
      snprintf(name, sizeof name, "%s%s%s", path, *path ? "." : "", key);
      if (strcmp(name, "name") != 0)
        compare(verification, where, json_object_get(stated, key), value, json_object_get(found, key), name);
    }
    json_object_foreach((json_t *)found, key, value)
    {
      snprintf(name, sizeof name, "%s%s%s: not expected", path, *path ? "." : "", key);
      if (!json_object_get(expected, key))
        eo_verify_fact(verification, where, name, false);
    }
  } else if (json_is_array(expected)) {
    eo_verify_fact(verification, where, path, json_array_size(expected) == json_array_size(found));
    json_array_foreach(expected, i, value)
    {
      snprintf(name, sizeof name, "%s[%zu]", path, i);
      compare(verification, where, json_array_get(stated, i), value, json_array_get(found, i), name);
    }
  } else if (json_is_number(expected) && json_is_number(found)) {
    double wanted = json_number_value(expected), value_ = json_number_value(found);
    double tolerance = fmax(relative * fabs(wanted), absolute);
    if (stated || !(fabs(value_ - wanted) <= tolerance))
      eo_verify_derived(verification, where, path, value_, wanted, tolerance);
  } else if (!stated && is_left_open(path)) {
    if (!json_equal(expected, found))
      eo_verify_note(verification, "%s is \"%s\" and not compared: the case does not state it", path,
                     json_string_value(found));
  } else if (stated || !json_equal(expected, found))
    eo_verify_fact(verification, where, path, json_equal(expected, found));
}

static json_t *completed(const json_t *document, struct eo_case *where)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_design *design = calloc(1, sizeof *design);
  json_t *encoded = NULL;
  struct eo_geometry geometry;
  struct eo_error error;
  if (faults && design && eo_design_decode(document, design, NULL, faults)) {
    eo_design_complete(design, &geometry, &error); /* derived values beside stated ones; as it is, where it cannot be */
    encoded = eo_design_encode(design);
  } else if (faults && where)
    for (int i = 0; i < faults->count && i < EO_MAX_FAULTS; i++)
      eo_case_fault(where, "%s: %s", faults->fault[i].pointer, faults->fault[i].text);
  free(faults);
  free(design);
  return encoded;
}

static void check_design(struct eo_verification *verification, struct eo_case *design, const struct eo_import *import)
{
  if (!design || eo_case_is_null(design)) {
    if (design)
      eo_verify_fact(verification, design, "no design", import->design == NULL);
    return;
  }
  eo_verify_fact(verification, design, "a design", import->design != NULL);
  json_t *expected = completed(eo_case_json(design), design),
         *found = import->design ? completed(import->design, NULL) : NULL;
  if (import->design)
    eo_verify_fact(verification, design, "the design can be read", found != NULL);
  if (expected && found)
    compare(verification, design, eo_case_json(design), expected, found, "");
  json_decref(expected);
  json_decref(found);
  eo_case_skip(design);
}

/* Texts: */

static bool says(const json_t *list, const char *text)
{
  const json_t *entry;
  size_t i;
  json_array_foreach(list, i, entry) if (strstr(json_string_value(entry), text)) return true;
  return false;
}

/* Each expected text is said; only: nothing else is. */
static void check_texts(struct eo_verification *verification, struct eo_case *expected, const json_t *said, bool only,
                        struct eo_case *where, const char *what)
{
  int surprises = 0;
  const json_t *entry;
  size_t i;
  for (int k = 0; k < eo_case_size(expected); k++) {
    struct eo_case *text = eo_case_at(expected, k);
    eo_verify_fact(verification, text, eo_case_text(text), says(said, eo_case_text(text)));
  }
  if (!only)
    return;
  json_array_foreach(said, i, entry)
  {
    bool known = false;
    for (int k = 0; k < eo_case_size(expected); k++)
      known = known || strstr(json_string_value(entry), json_string_value(eo_case_json(eo_case_peek(expected, k))));
    surprises += !known;
    if (!known)
      eo_verify_note(verification, "not expected: %s", json_string_value(entry));
  }
  eo_verify_fact(verification, expected ? expected : where, what, surprises == 0);
}

/* Faults: */

static bool agrees(const json_t *expected, const json_t *found, const char *key)
{
  const json_t *value = json_object_get(expected, key);
  return !value || json_equal(value, json_object_get(found, key));
}

static bool is_fault(const json_t *expected, const struct eo_import_fault *fault)
{
  static const char *const keys[] = {"kind", "component", "attribute", "relation", "line"};
  json_t *found = eo_outline_encode(&eo_import_fault_outline, fault);
  bool same = true;
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    same = same && agrees(expected, found, keys[i]);
  json_decref(found);
  return same;
}

/* What an import goes on with stands in its notes: "kind: TYPE ID: ...". */
static bool is_noted(const json_t *expected, const json_t *notes)
{
  const char *kind = json_string_value(json_object_get(expected, "kind")),
             *attribute = json_string_value(json_object_get(expected, "attribute"));
  char id[20];
  const json_t *note;
  size_t i;
  snprintf(id, sizeof id, " %lld: ", (long long)json_integer_value(json_object_get(expected, "component")));
  json_array_foreach(notes, i, note)
  {
    const char *text = json_string_value(note);
    if (strncmp(text, kind, strlen(kind)) == 0 && strstr(text, id) && (!attribute || strstr(text, attribute)))
      return true;
  }
  return false;
}

static void check_faults(struct eo_verification *verification, struct eo_case *faults, const struct eo_import *import)
{
  int surprises = 0;
  for (int i = 0; i < eo_case_size(faults); i++) {
    struct eo_case *fault = eo_case_at(faults, i);
    const json_t *expected = eo_case_json(fault);
    bool known = is_noted(expected, import->notes);
    for (int n = 0; n < import->faults; n++)
      known = known || is_fault(expected, &import->fault[n]);
    eo_verify_fact(verification, fault, eo_case_word(fault, "kind"), known);
    eo_case_skip(fault);
  }
  for (int n = 0; n < import->faults; n++) {
    bool expected = false;
    for (int i = 0; i < eo_case_size(faults); i++)
      expected = expected || is_fault(eo_case_json(eo_case_peek(faults, i)), &import->fault[n]);
    surprises += !expected;
    if (!expected)
      eo_verify_note(verification, "not expected: %s", import->fault[n].text);
  }
  eo_verify_fact(verification, faults, "no other fault", surprises == 0);
}

static void check_case(struct eo_verification *verification, struct eo_case *item, const struct eo_import *import)
{
  const char *version = eo_case_word_given(item, "version");
  char format[40];
  if (version) {
    snprintf(format, sizeof format, "REXS %.20s ", version);
    eo_verify_fact(verification, item, "version", strstr(import->format, format) != NULL);
  }
  check_pairs(verification, eo_case_find(item, "pairs"), import);
  check_design(verification, eo_case_find(item, "design"), import);
  struct eo_case *not_used = eo_case_find(item, "not_used"), *refused = eo_case_find(item, "refused");
  check_texts(verification, not_used, import->not_used, not_used != NULL, item, "nothing else is not used");
  check_texts(verification, refused, import->refused, import->design != NULL, item, "nothing else is refused");
  check_texts(verification, eo_case_find(item, "assumptions"), import->assumed, false, item, "");
  eo_case_skip(eo_case_find(item, "tolerated"));
  check_faults(verification, eo_case_need(item, "faults"), import);
}

static enum eo_code run_case(void *context, struct eo_case *item, struct eo_error *error)
{
  const struct run *run = context;
  struct eo_case *choose = eo_case_given(item, "choose");
  struct eo_import_options options = {0};
  struct eo_import import;
  struct eo_text text = {0};
  const char *name = eo_case_word(item, "file");
  options.pair = choose ? (int)eo_case_real(choose) + 1 : 0;
  if (eo_case_faulty(item))
    return EO_OK;
  char *path = eo_verify_path(run->v, name);
  enum eo_code code = path ? eo_text_read(&text, path, EO_REXS_BYTES, error) : eo_error_memory(error);
  if (!code) {
    code = eo_import_read(&import, text.size ? text.data : "", text.size, &options, error);
    if (!code)
      check_case(run->v, item, &import);
    eo_import_done(&import);
  }
  eo_text_done(&text);
  free(path);
  return code;
}

static const struct eo_verify_block blocks[] = {
    {"cases", EO_BLOCK_EACH, run_case},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_exchange(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct run run = {verification};
  eo_case_need(file, "cases");
  return eo_case_faulty(file) ? EO_OK : eo_verify_blocks(verification, file, blocks, &run, error);
}

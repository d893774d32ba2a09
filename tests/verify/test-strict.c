/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `easeoff verify` cannot be fooled: every key of a case file misspelt, every number as text, as null and in brackets,
   every text as a number, and every expected number moved by three tolerances, one at a time. A file must then be
   refused or fail. The check takes the blocks that compute in milliseconds; STRICT=all takes every block. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "format/digits.h"
#include "format/json.h"
#include "reference/verify.h"
#include "support/tap.h"

enum verdict { PASSED, FAILED, REFUSED };

/* A block with what it needs beside it; stride: one of so many mutations is tried. */
struct part {
  const char *file, *block, *beside[6];
  int stride;
  bool slow;
};

static const struct part parts[] = {
    {"standards", "iso_6336_1_stiffness", {NULL}, 1, false},
    {"standards", "iso_tr_6336_30_example_1_geometry", {NULL}, 1, false},
    {"standards", "fzg_c14", {NULL}, 1, false},
    {"standards", "load_distribution_closed_form", {NULL}, 1, true},
    {"optimizer", "rng", {"conventions"}, 1, false},
    {"optimizer", "predict", {"conventions", "histories"}, 3, false},
    {"optimizer", "redundancy", {"conventions"}, 1, false},
    {"optimizer", "decay", {"conventions"}, 1, false},
    {"optimizer", "clean_up", {"conventions"}, 1, false},
    {"optimizer", "operators", {"conventions"}, 1, false},
    {"optimizer", "runs", {"conventions"}, 1, false},
    {"optimizer", "successor", {"conventions"}, 1, false},
    {"dynamics", "geometry", {NULL}, 1, false},
    {"dynamics", "eigen", {"defaults"}, 1, false},
    {"dynamics", "negative_control_literal_signs", {"defaults", "eigen"}, 3, false},
    {"dynamics", "sdof", {NULL}, 29, false},
    {"dynamics", "dynamics", {"law_K1", "table_T1"}, 97, false},
    {"contact", "macro", {NULL}, 1, false},
    {"contact", "modification", {"macro"}, 3, false},
    {"contact", "exact_surface_A", {"macro", "modification"}, 3, false},
    {"contact", "slice_gap_A", {"macro", "modification"}, 3, false},
    {"contact", "unloaded_tca", {"macro", "modification"}, 5, false},
    {"contact", "hertz", {"macro"}, 1, false},
    {"contact", "impact", {"macro"}, 1, false},
    {"contact", "iso6336_1", {"macro"}, 1, false},
    {"contact", "iso6336_3_pinion_828", {"macro"}, 1, false},
    {"contact", "ltca_synthetic", {"macro", "modification"}, 5, true},
    {"contact", "fe_bulk", {"macro"}, 31, true},
    {"contact", "ltca_table", {"macro", "modification", "impact"}, 61, true},
    {"encoder", "files", {"mesh"}, 11, false},
    {"ring", "points", {"macro", "supports", "tolerances"}, 211, true},
    {"ring", "line", {"macro", "supports", "tolerances"}, 61, true},
    {"calculix", "unmodified", {"what", "boundary"}, 61, true},
    {"deviations", "cases", {"pairs", "conventions"}, 211, true},
    {"tolerance", "cases", {"pairs", "conventions", "statistics"}, 1997, true},
    {"tolerance", "analytic", {"pairs", "conventions", "statistics"}, 997, true},
    {"evaluation", "cases", {"defaults", "pairs", "dynamics_params", "mods"}, 61, true},
    {"rating", "rows", {NULL}, 1, false},
};

/* The block and what it needs, without commentary; of long lists of cases the first. */
static json_t *reduce(const json_t *whole, const struct part *part)
{
  enum { MOST_CASES = 5 };
  json_t *root = json_object();
  json_object_set(root, "kind", json_object_get(whole, "kind"));
  for (int i = 0; i < 6 && part->beside[i]; i++)
    json_object_set_new(root, part->beside[i], json_deep_copy(json_object_get(whole, part->beside[i])));
  json_t *block = json_deep_copy(json_object_get(whole, part->block));
  while (json_is_array(block) && json_array_size(block) > MOST_CASES)
    json_array_remove(block, json_array_size(block) - 1);
  json_object_set_new(root, part->block, block);
  return root;
}

struct trial {
  json_t *root;
  const struct part *part;
  const char *folder;
  int tried, skipped, fooled;
};

static enum verdict judge(const struct trial *t, struct eo_verification *v)
{
  struct eo_error error = {0};
  enum verdict verdict = PASSED;
  struct eo_case *file = eo_case_open(json_incref(t->root));
  *v = (struct eo_verification){.folder = t->folder, .notes = json_array()};
  if (eo_verify_run(file, v, &error) || eo_case_faulty(file))
    verdict = REFUSED;
  for (int i = 0; i < v->count && verdict == PASSED; i++)
    verdict = v->check[i].pass ? PASSED : FAILED;
  if (!t->tried && verdict == REFUSED) /* as it stands */
    printf("# %s: %s\n", eo_case_faulty(file) ? eo_case_faults(file)->fault[0].pointer : error.pointer,
           eo_case_faulty(file) ? eo_case_faults(file)->fault[0].text : error.text);
  eo_case_close(file);
  return verdict;
}

static bool chosen(struct trial *t)
{
  return t->skipped++ % t->part->stride == 0;
}

static void expect_noticed(struct trial *t, const char *how, const char *where)
{
  struct eo_verification v;
  enum verdict verdict = judge(t, &v);
  eo_verification_done(&v);
  t->tried++;
  if (verdict != PASSED)
    return;
  t->fooled++;
  printf("# %s/%s: %s %s passes\n", t->part->file, t->part->block, where, how);
}

/* Puts the value in the place of a member or element, looks, and puts the old one back. */
static void try_value(struct trial *t, json_t *container, const char *key, size_t index, json_t *value, const char *how)
{
  json_t *old = json_incref(key ? json_object_get(container, key) : json_array_get(container, index));
  if (key)
    json_object_set_new(container, key, value);
  else
    json_array_set_new(container, index, value);
  expect_noticed(t, how, key ? key : "an element");
  if (key)
    json_object_set_new(container, key, old);
  else
    json_array_set_new(container, index, old);
}

/* Seeds may be text. */
static bool may_be_text(const char *key)
{
  return key && strcmp(key, "seed") == 0;
}

static void try_leaf(struct trial *t, json_t *container, const char *key, size_t index, const json_t *leaf)
{
  char text[40];
  if (json_is_number(leaf)) {
    eo_digits_write(text, sizeof text, json_number_value(leaf));
    if (!may_be_text(key) && chosen(t))
      try_value(t, container, key, index, json_string(text), "as text");
    if (chosen(t))
      try_value(t, container, key, index, json_null(), "as null");
    if (chosen(t))
      try_value(t, container, key, index, json_pack("[O]", leaf), "in brackets");
  } else if (json_is_string(leaf) && chosen(t))
    try_value(t, container, key, index, json_integer(7), "as a number");
}

static void try_key(struct trial *t, json_t *object, const char *key)
{
  char wrong[200];
  json_t *value = json_incref(json_object_get(object, key));
  snprintf(wrong, sizeof wrong, "x%s", key);
  json_object_del(object, key);
  json_object_set(object, wrong, value);
  expect_noticed(t, "misspelt", key);
  json_object_del(object, wrong);
  json_object_set_new(object, key, value);
}

static void walk(struct trial *t, json_t *container);

static void walk_object(struct trial *t, json_t *object)
{
  size_t count = json_object_size(object), i = 0;
  char(*keys)[160] = calloc(count + 1, sizeof *keys);
  const char *key;
  json_t *value;
  json_object_foreach(object, key, value) snprintf(keys[i++], sizeof *keys, "%.159s", key);
  for (i = 0; i < count; i++) {
    value = json_object_get(object, keys[i]);
    if (chosen(t))
      try_key(t, object, keys[i]);
    if (eo_case_is_commentary(keys[i]))
      continue;
    try_leaf(t, object, keys[i], 0, value);
    walk(t, value);
  }
  free(keys);
}

/* Every key, and every leaf. Of a list the first three elements stand for all. */
static void walk(struct trial *t, json_t *container)
{
  enum { ELEMENTS = 3 };
  if (json_is_object(container))
    walk_object(t, container);
  for (size_t i = 0; i < json_array_size(container) && i < ELEMENTS; i++) {
    try_leaf(t, container, NULL, i, json_array_get(container, i));
    walk(t, json_array_get(container, i));
  }
}

/* The container of what a JSON pointer names, with its last key or index. */
static json_t *locate(json_t *root, const char *pointer, char key[160], size_t *index)
{
  json_t *container = NULL, *value = root;
  for (const char *at = pointer; *at == '/' && value;) {
    size_t length = strcspn(++at, "/");
    snprintf(key, 160, "%.*s", (int)length, at);
    container = value;
    *index = strtoul(key, NULL, 10);
    value = json_is_object(container) ? json_object_get(container, key) : json_array_get(container, *index);
    at += length;
  }
  return container;
}

/* Every number and flag that a check compares, moved beyond its tolerance. */
static void move_expected(struct trial *t, const struct eo_verification *v)
{
  for (int i = 0; i < v->count; i++) {
    const struct eo_check *check = &v->check[i];
    char key[160];
    size_t index = 0;
    json_t *container = locate(t->root, check->pointer, key, &index);
    const json_t *leaf = json_is_object(container) ? json_object_get(container, key) : json_array_get(container, index);
    double step = check->tolerance > 0 ? 3 * check->tolerance : 1;
    if ((!json_is_number(leaf) && !json_is_boolean(leaf)) || !chosen(t))
      continue;
    json_t *moved = json_is_boolean(leaf)                ? json_boolean(!json_is_true(leaf))
                    : json_is_integer(leaf) && step == 1 ? json_integer(json_integer_value(leaf) + 1)
                                                         : json_real(json_number_value(leaf) + step);
    try_value(t, container, json_is_object(container) ? key : NULL, index, moved, "moved by three tolerances");
  }
}

/* What the notes call not compared is left out: numbers for information may be any. */
static void drop_uncompared(json_t *root, const struct eo_verification *v)
{
  for (size_t i = 0; i < json_array_size(v->notes); i++) {
    char pointer[300], key[160];
    size_t index = 0;
    const char *note = json_string_value(json_array_get(v->notes, i)), *end = strstr(note, " is not compared");
    if (!end)
      continue;
    snprintf(pointer, sizeof pointer, "%.*s", (int)(end - note), note);
    json_t *container = locate(root, pointer, key, &index);
    if (json_is_object(container))
      json_object_del(container, key);
  }
}

static void check_part(const json_t *whole, const struct part *part, const char *folder)
{
  struct trial t = {.root = reduce(whole, part), .part = part, .folder = folder};
  struct eo_verification v;
  enum verdict verdict = judge(&t, &v);
  struct timespec start, end;
  clock_gettime(CLOCK_MONOTONIC, &start);
  if (ok(verdict == PASSED && v.count > 0, "%s: %s passes as it stands, %d checks", part->file, part->block, v.count)) {
    drop_uncompared(t.root, &v);
    move_expected(&t, &v);
    walk(&t, t.root);
    clock_gettime(CLOCK_MONOTONIC, &end);
    ok(t.tried > 0 && t.fooled == 0, "%s: %s notices every mutation but %d of %d (%.1f s)", part->file, part->block,
       t.fooled, t.tried, (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec));
  }
  eo_verification_done(&v);
  json_decref(t.root);
}

static void refused(const char *text, const char *pointer, const char *sentence)
{
  struct eo_error error = {0};
  struct eo_verification v = {.folder = ".", .notes = json_array()};
  struct eo_case *file = eo_case_open(json_loads(text, 0, NULL));
  enum eo_code code = eo_verify_run(file, &v, &error);
  const struct eo_error *fault = &eo_case_faults(file)->fault[0];
  ok(!code && eo_case_faulty(file) && strcmp(fault->pointer, pointer) == 0 && strstr(fault->text, sentence),
     "%s is a fault: %s: %s", text, eo_case_faulty(file) ? fault->pointer : "",
     eo_case_faulty(file) ? fault->text : "accepted");
  eo_case_close(file);
  eo_verification_done(&v);
}

/* Files in which there is nothing to check, and rules that no file states by itself. */
static void check_sentences(void)
{
#define PAIR "\"macro\": {\"input\": {\"z\": [17, 44], \"mn\": 6, \"beta\": 24, \"b\": 55}}"
  static const char *const kinds[] = {"calculix",   "contact",   "deviations", "dynamics",  "encoder",
                                      "evaluation", "optimizer", "rating",     "standards", "tolerance"};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    char text[60];
    struct eo_error error = {0};
    struct eo_verification v = {.folder = ".", .notes = json_array()};
    snprintf(text, sizeof text, "{\"kind\": \"%s\"}", kinds[i]);
    struct eo_case *file = eo_case_open(json_loads(text, 0, NULL));
    ok(!eo_verify_run(file, &v, &error) && eo_case_faulty(file), "%s is refused: %s", text,
       eo_case_faulty(file) ? eo_case_faults(file)->fault[0].text : "");
    eo_case_close(file);
    eo_verification_done(&v);
  }
  refused("{}", "", "\"kind\" is missing");
  refused("{\"kind\": 7}", "/kind", "A text is expected");
  refused("{\"kind\": \"gears\"}", "/kind", "is not a kind");
  refused("{\"kind\": \"contact\", " PAIR ", \"hertzz\": {}}", "/hertzz", "not known in a file of this kind");
  refused("{\"kind\": \"contact\", " PAIR "}", "", "Nothing in this file is checked");
  refused("{\"kind\": \"contact\", " PAIR ", \"iso6336_1\": {}}", "/iso6336_1", "Nothing here is checked");
  refused("{\"kind\": \"contact\", " PAIR ", \"iso6336_1\": {\"CB\": 0}}", "/iso6336_1/CB", "An expected 0 needs");
  refused("{\"kind\": \"contact\", " PAIR ", \"hertz\": {\"tol_rel\": 2, \"q\": [1], \"s\": [0], \"delta_um\": [[1]]}}",
          "/hertz/tol_rel", "A tolerance is above 0");
  refused("{\"kind\": \"contact\", " PAIR ", \"unloaded_tca\": [{\"mod\": \"B\", \"mis\": \"none\", \"phase\": [0, 1], "
          "\"TE_exact_um\": [0, 0]}]}",
          "/unloaded_tca/0/mod", "\"B\" is no modification");
  refused("{\"kind\": \"contact\", " PAIR
          ", \"unloaded_tca\": [{\"mod\": \"unmodd\", \"mis\": \"none\", \"phase\": [0, "
          "1], \"TE_exact_um\": [0, 0]}]}",
          "/unloaded_tca/0/mod", "\"unmodd\" is no modification");
  refused("{\"kind\": \"contact\", " PAIR ", \"unloaded_tca\": [{\"mod\": \"unmod\", \"mis\": \"0.1 deg inn-plane\", "
          "\"phase\": [0, 1], \"TE_exact_um\": [0, 0]}]}",
          "/unloaded_tca/0/mis", "not understood");
  refused("{\"kind\": \"encoder\", \"files\": []}", "/files", "Cases are expected");
  refused("{\"kind\": \"optimizer\", \"rng\": 5}", "/rng", "Cases are expected");
#undef PAIR
}

int main(void)
{
  const char *folder = getenv("CASES"), *loaded = "";
  bool all = getenv("STRICT") != NULL;
  json_t *whole = NULL;
  check_sentences();
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    char path[400];
    struct eo_error error = {0};
    if (parts[i].slow && !all)
      continue;
    if (strcmp(loaded, parts[i].file) != 0) {
      json_decref(whole);
      snprintf(path, sizeof path, "%s/%s.json", folder ? folder : "tests/cases", parts[i].file);
      whole = eo_json_load(path, EO_JSON_CASES_BYTES, &error);
      loaded = parts[i].file;
    }
    if (whole)
      check_part(whole, &parts[i], folder ? folder : "tests/cases");
    else
      ok(false, "%s is read: %s", path, error.text);
  }
  json_decref(whole);
  return tap_done();
}

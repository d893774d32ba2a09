/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "format/digits.h"
#include "format/json.h"
#include "format/text.h"
#include "reference/verify.h"

enum { NAME_SIZE = 200 };

/* "rows[0].Z_um[1]": the way from above to the value. */
static void print_way(struct eo_text *text, const struct eo_case *above, const struct eo_case *value)
{
  const struct eo_case *parent = eo_case_parent(value);
  if (parent && parent != above && eo_case_parent(parent))
    print_way(text, above, parent);
  if (eo_case_key(value))
    eo_text_print(text, "%s%s", text->size ? "." : "", eo_case_key(value));
  else
    eo_text_print(text, "[%d]", eo_case_index(value));
}

/* What people call the case: its id, name or file. */
static const char *given_name(struct eo_case *value)
{
  static const char *const keys[] = {"id", "name", "file"};
  const char *name = NULL;
  for (size_t i = 0; i < sizeof keys / sizeof *keys && !name; i++)
    name = eo_case_peek_text(value, keys[i]);
  return name;
}

static struct eo_case *block_of(struct eo_case *value)
{
  while (eo_case_parent(value) && eo_case_parent(eo_case_parent(value)))
    value = eo_case_parent(value);
  return value;
}

/* The case that the value belongs to: the nearest with a name, else the nearest object in a list, else the block. */
static struct eo_case *case_of(struct eo_case *value, const char **name)
{
  struct eo_case *element = NULL;
  for (struct eo_case *up = value; eo_case_parent(up); up = eo_case_parent(up)) {
    *name = given_name(up);
    if (*name)
      return up;
    if (!element && !eo_case_key(up) && eo_case_is_object(up))
      element = up;
  }
  return element ? element : block_of(value);
}

static bool name_check(struct eo_check *check, struct eo_case *value, const char *quantity)
{
  struct eo_text label = {0}, way = {0};
  char pointer[NAME_SIZE];
  const char *name, *block = eo_case_key(block_of(value));
  struct eo_case *item = case_of(value, &name);
  if (name)
    eo_text_print(&label, "%s: %s", block ? block : "file", name);
  else
    print_way(&label, NULL, item);
  if (item != value)
    print_way(&way, item, value);
  if (quantity)
    eo_text_print(&way, "%s%s", way.size ? ": " : "", quantity);
  else if (item == value)
    eo_text_add(&way, eo_case_key(value) ? eo_case_key(value) : "value");
  eo_case_pointer(value, pointer, sizeof pointer);
  check->block = strdup(block ? block : "");
  check->pointer = strdup(pointer);
  check->label = label.data;
  check->quantity = way.data;
  return check->block && check->pointer && check->label && check->quantity && !label.failed && !way.failed;
}

static void done_check(struct eo_check *check)
{
  free(check->block);
  free(check->label);
  free(check->quantity);
  free(check->pointer);
}

static bool make_room(struct eo_verification *verification)
{
  if (verification->count < verification->capacity)
    return true;
  int capacity = verification->capacity ? 2 * verification->capacity : 64;
  struct eo_check *check = realloc(verification->check, (size_t)capacity * sizeof *check);
  if (!check)
    return false;
  verification->check = check;
  verification->capacity = capacity;
  return true;
}

static void add(struct eo_verification *verification, struct eo_case *where, const char *quantity, double value,
                double expected, double tolerance, bool pass)
{
  if (!where) /* needed and not there: a fault already */
    return;
  struct eo_check check = {.value = value, .expected = expected, .tolerance = tolerance, .pass = pass};
  if (verification->failed || !make_room(verification) || !name_check(&check, where, quantity)) {
    done_check(&check);
    verification->failed = true;
    return;
  }
  verification->check[verification->count++] = check;
}

void eo_verify_derived(struct eo_verification *verification, struct eo_case *where, const char *quantity, double value,
                       double expected, double tolerance)
{
  if (isnan(expected)) {
    if (!eo_case_faulty(where))
      eo_case_fault(where, "No number is expected here.");
  } else if (!(tolerance > 0 && isfinite(tolerance)))
    eo_case_fault(where, "An expected 0 needs an absolute tolerance or a scale, and this one has none.");
  else
    add(verification, where, quantity, value, expected, tolerance, fabs(value - expected) <= tolerance);
}

void eo_verify_number(struct eo_verification *verification, struct eo_case *expected, double value, double relative,
                      double absolute)
{
  if (!expected)
    return;
  double wanted = eo_case_real(expected);
  eo_verify_derived(verification, expected, NULL, value, wanted, fmax(relative * fabs(wanted), absolute));
}

void eo_verify_member(struct eo_verification *verification, struct eo_case *object, const char *key, double value,
                      double relative, double absolute)
{
  eo_verify_number(verification, eo_case_find(object, key), value, relative, absolute);
}

void eo_verify_exact(struct eo_verification *verification, struct eo_case *expected, double value)
{
  if (!expected)
    return;
  bool flag = json_is_boolean(eo_case_json(expected));
  double wanted = flag ? eo_case_flag(expected) : eo_case_real(expected);
  if (wanted != floor(wanted))
    eo_case_fault(expected, "A whole number is expected here.");
  else if (!isnan(wanted))
    add(verification, expected, NULL, value, wanted, 0, value == wanted);
}

void eo_verify_size(struct eo_verification *verification, struct eo_case *list, int count)
{
  int size = eo_case_size(list);
  if (list && !eo_case_is_list(list))
    eo_case_fault(list, "A list is expected here.");
  else if (list)
    add(verification, list, "length", count, size, 0, count == size);
}

void eo_verify_list(struct eo_verification *verification, struct eo_case *expected, int count, const double *value,
                    double unit, double relative, double absolute)
{
  eo_verify_size(verification, expected, count);
  for (int i = 0; i < eo_case_size(expected); i++)
    eo_verify_number(verification, eo_case_at(expected, i), i < count ? value[i] * unit : NAN, relative, absolute);
}

void eo_verify_fact(struct eo_verification *verification, struct eo_case *where, const char *quantity, bool holds)
{
  add(verification, where, quantity, holds, 1, 0, holds);
}

void eo_verify_diverged(struct eo_verification *verification, struct eo_case *where)
{
  eo_case_skip(where);
  add(verification, where, "did not converge", NAN, NAN, NAN, false);
}

/* The computation itself failed where numbers are expected: a check that fails, its reason as a note. */
static void tell_broken(struct eo_verification *verification, struct eo_case *where, const struct eo_error *error)
{
  eo_case_skip(where);
  add(verification, where, "computed at all", NAN, 1, 0, false);
  if (!verification->failed)
    eo_verify_note(verification, "%s could not be computed: %s%s%s", verification->check[verification->count - 1].label,
                   error->pointer, *error->pointer ? ": " : "", error->text);
}

void eo_verify_note(struct eo_verification *verification, const char *format, ...)
{
  char line[600], clean[300];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  eo_text_clean(clean, sizeof clean, line);
  for (size_t i = 0; i < json_array_size(verification->notes); i++)
    if (strcmp(json_string_value(json_array_get(verification->notes, i)), clean) == 0)
      return;
  if (json_array_append_new(verification->notes, json_string_nocheck(clean)) != 0)
    verification->failed = true;
}

static void refuse_text(const struct eo_case *value)
{
  if (eo_case_is_text(value))
    eo_case_fault(value, "A number is expected here.");
  for (int i = 0; i < eo_case_size(value); i++)
    refuse_text(eo_case_peek(value, i));
}

void eo_verify_uncompared(struct eo_verification *verification, struct eo_case *value, const char *why)
{
  char pointer[NAME_SIZE];
  if (!value)
    return;
  refuse_text(value);
  eo_case_skip(value);
  eo_case_pointer(value, pointer, sizeof pointer);
  eo_verify_note(verification, "%s is not compared: %s", pointer, why);
}

double eo_verify_rounding(double printed)
{
  char text[40];
  eo_digits_write(text, sizeof text, printed);
  const char *exponent = strpbrk(text, "e"), *point = strchr(text, '.');
  int decimals = point ? (int)((exponent ? (size_t)(exponent - point) : strlen(point)) - 1) : 0;
  return 0.5 * pow(10, (exponent ? atoi(exponent + 1) : 0) - decimals);
}

char *eo_verify_path(const struct eo_verification *verification, const char *name)
{
  struct eo_text text = {0};
  eo_text_print(&text, "%s%s%s", name[0] == '/' ? "" : verification->folder, name[0] == '/' ? "" : "/", name);
  if (text.failed)
    eo_text_done(&text);
  return text.data;
}

void eo_verification_done(struct eo_verification *verification)
{
  for (int i = 0; i < verification->count; i++)
    done_check(&verification->check[i]);
  free(verification->check);
  json_decref(verification->notes);
  *verification = (struct eo_verification){0};
}

static enum eo_code run_one(struct eo_verification *verification, struct eo_case *item, bool checks,
                            eo_verify_function *run, void *context, struct eo_error *error)
{
  int before = verification->count;
  enum eo_code code = run(context, item, error);
  if (code == EO_ERROR_INPUT || code == EO_ERROR_NUMERIC || code == EO_ERROR_FILE) {
    tell_broken(verification, item, error);
    code = EO_OK;
  }
  if (!code && checks && !verification->failed && verification->count == before && !eo_case_faulty(item))
    eo_case_fault(item, "Nothing here is checked.");
  return code;
}

enum eo_code eo_verify_each(struct eo_verification *verification, struct eo_case *items, eo_verify_function *run,
                            void *context, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  if (!items)
    return EO_OK;
  if (eo_case_size(items) == 0)
    eo_case_fault(items, "Cases are expected here.");
  for (int i = 0; i < eo_case_size(items) && !code && !eo_case_faulty(items); i++) {
    struct eo_case *item = eo_case_peek(items, i);
    if (eo_case_key(item) && eo_case_is_commentary(eo_case_key(item)))
      continue;
    eo_case_at(items, i);
    code = run_one(verification, item, true, run, context, error);
    eo_case_sweep(item);
  }
  return code;
}

static bool matches(const char *key, const char *pattern)
{
  size_t length = strcspn(pattern, "*");
  return pattern[length] ? strncmp(key, pattern, length) == 0 : strcmp(key, pattern) == 0;
}

static const struct eo_verify_block *block_named(const struct eo_verify_block *blocks, const char *key)
{
  for (; blocks->key; blocks++)
    if (matches(key, blocks->key))
      return blocks;
  return NULL;
}

static void refuse_unknown(struct eo_case *file, const struct eo_verify_block *blocks)
{
  for (int i = 0; i < eo_case_size(file); i++) {
    struct eo_case *member = eo_case_peek(file, i);
    const char *key = eo_case_key(member);
    if (strcmp(key, "kind") && !eo_case_is_commentary(key) && !block_named(blocks, key))
      eo_case_fault(member, "This block is not known in a file of this kind.");
  }
}

enum eo_code eo_verify_blocks(struct eo_verification *verification, struct eo_case *file,
                              const struct eo_verify_block *blocks, void *context, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  refuse_unknown(file, blocks);
  for (int i = 0; i < eo_case_size(file) && !code && !eo_case_faulty(file); i++) {
    struct eo_case *member = eo_case_peek(file, i);
    const struct eo_verify_block *block = block_named(blocks, eo_case_key(member));
    if (eo_case_is_commentary(eo_case_key(member)) || !block)
      continue;
    if (block->shape == EO_BLOCK_REMARKS)
      eo_case_remark(file, eo_case_key(member));
    else if (block->shape == EO_BLOCK_WHOLE || block->shape == EO_BLOCK_EITHER)
      code = run_one(verification, member, block->shape == EO_BLOCK_WHOLE, block->run, context, error);
    else if (block->shape == EO_BLOCK_EACH)
      code = eo_verify_each(verification, member, block->run, context, error);
  }
  return code;
}

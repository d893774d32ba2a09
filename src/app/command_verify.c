/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "format/json.h"
#include "format/text_table.h"

static char *folder_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
}

/* A case file and what came of it. */
struct verified {
  struct eo_case *file;
  struct eo_verification v;
  char *folder;
};

static void done(struct verified *verified)
{
  eo_verification_done(&verified->v);
  eo_case_close(verified->file);
  free(verified->folder);
}

static enum eo_code verify_file(const char *path, struct verified *verified, struct eo_error *error)
{
  *verified = (struct verified){.folder = folder_of(path)};
  verified->v = (struct eo_verification){.folder = verified->folder, .notes = json_array()};
  json_t *document = eo_json_load(path, EO_JSON_CASES_BYTES, error);
  if (!document)
    return error->code;
  verified->file = eo_case_open(document);
  if (!verified->file || !verified->folder || !verified->v.notes)
    return eo_error_memory(error);
  return eo_verify_run(verified->file, &verified->v, error);
}

/* How far out, in tolerances; what should be exact counts as far out as it can. */
static double severity(const struct eo_check *check)
{
  double deviation = check->value == check->expected ? 0 : fabs(check->value - check->expected);
  if (isnan(deviation))
    return INFINITY;
  return check->tolerance > 0 ? deviation / check->tolerance : (deviation > 0 ? INFINITY : 0);
}

static void add_row(struct eo_text_table *sheet, const struct eo_verification *verification, int first, int count)
{
  int worst = first, bad = 0;
  for (int i = first; i < first + count; i++) {
    bad += !verification->check[i].pass;
    if (severity(&verification->check[i]) > severity(&verification->check[worst]))
      worst = i;
  }
  const struct eo_check *check = &verification->check[worst];
  eo_text_table_string(sheet, check->label);
  eo_text_table_number(sheet, count, NULL, 9);
  eo_text_table_string(sheet, check->quantity);
  eo_text_table_number(sheet, check->value, NULL, 9);
  eo_text_table_number(sheet, check->expected, NULL, 9);
  eo_text_table_number(sheet, fabs(check->value - check->expected), NULL, 3);
  eo_text_table_number(sheet, check->tolerance, NULL, 3);
  char verdict[32] = "pass";
  if (bad)
    snprintf(verdict, sizeof verdict, "FAIL (%d)", bad);
  eo_text_table_string(sheet, verdict);
}

/* Checks of a block stand together: how many from the first on. */
static int block_size(const struct eo_verification *verification, int first)
{
  int count = 1;
  while (first + count < verification->count &&
         strcmp(verification->check[first].block, verification->check[first + count].block) == 0)
    count++;
  return count;
}

static void print_blocks(const struct eo_verification *verification, struct eo_text *text)
{
  eo_text_print(text, "  checks:");
  for (int first = 0; first < verification->count; first += block_size(verification, first))
    eo_text_print(text, "%s %s %d", first ? "," : "", verification->check[first].block,
                  block_size(verification, first));
  eo_text_add(text, "\n");
}

/* One line per case: its largest deviation, measured in tolerances. */
static void print_table(const struct eo_verification *verification, struct eo_text *text)
{
  static const char *const headings[] = {
      "case", "checks", "largest deviation in", "value", "expected", "deviation", "tolerance", "verdict"};
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 8, headings);
  for (int first = 0, count; first < verification->count; first += count) {
    for (count = 1; first + count < verification->count &&
                    strcmp(verification->check[first].label, verification->check[first + count].label) == 0;)
      count++;
    add_row(&sheet, verification, first, count);
  }
  if (verification->count)
    eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  print_blocks(verification, text);
  for (size_t i = 0; i < json_array_size(verification->notes); i++)
    eo_text_print(text, "  note: %s\n", json_string_value(json_array_get(verification->notes, i)));
}

static json_t *encode_check(const struct eo_check *check)
{
  json_t *row = json_object();
  bool failed = !row;
  eo_json_put(row, "case", json_string(check->label), &failed);
  eo_json_put(row, "quantity", json_string(check->quantity), &failed);
  eo_json_put(row, "pointer", json_string(check->pointer), &failed);
  eo_json_put(row, "value", eo_json_real(check->value, NULL), &failed);
  eo_json_put(row, "expected", eo_json_real(check->expected, NULL), &failed);
  eo_json_put(row, "tolerance", eo_json_real(check->tolerance, NULL), &failed);
  eo_json_put(row, "pass", json_boolean(check->pass), &failed);
  return failed ? (json_decref(row), NULL) : row;
}

static json_t *encode_fault(const struct eo_error *fault)
{
  json_t *row = json_object();
  bool failed = !row;
  eo_json_put(row, "pointer", json_string(fault->pointer), &failed);
  eo_json_put(row, "text", json_string(fault->text), &failed);
  return failed ? (json_decref(row), NULL) : row;
}

static json_t *encode_blocks(const struct eo_verification *verification)
{
  json_t *blocks = json_object();
  bool failed = !blocks;
  for (int first = 0; first < verification->count; first += block_size(verification, first))
    eo_json_put(blocks, verification->check[first].block, json_integer(block_size(verification, first)), &failed);
  return failed ? (json_decref(blocks), NULL) : blocks;
}

static json_t *encode_file(const char *path, const struct verified *verified)
{
  const struct eo_verification *verification = &verified->v;
  const struct eo_faults *faults = eo_case_faults(verified->file);
  json_t *file = json_object(), *rows = json_array(), *told = json_array();
  bool failed = !file || !rows || !told, pass = faults->count == 0;
  for (int i = 0; i < verification->count; i++) {
    failed = failed || json_array_append_new(rows, encode_check(&verification->check[i])) != 0;
    pass = pass && verification->check[i].pass;
  }
  for (int i = 0; i < faults->count && i < EO_MAX_FAULTS; i++)
    failed = failed || json_array_append_new(told, encode_fault(&faults->fault[i])) != 0;
  json_t *name = json_string(path);
  eo_json_put(file, "file", name ? name : json_null(), &failed);
  eo_json_put(file, "pass", json_boolean(pass), &failed);
  eo_json_put(file, "faults", told, &failed);
  eo_json_put(file, "blocks", encode_blocks(verification), &failed);
  eo_json_put(file, "checks", rows, &failed);
  eo_json_put(file, "notes", json_incref(verification->notes), &failed);
  return failed ? (json_decref(file), NULL) : file;
}

struct totals {
  struct eo_text text;
  json_t *files;
  int checks, bad;
  int refused; /* files */
  bool failed;
};

static void count_checks(struct totals *totals, const struct eo_verification *verification)
{
  totals->checks += verification->count;
  for (int i = 0; i < verification->count; i++)
    totals->bad += !verification->check[i].pass;
}

/* A file with faults is refused as a whole: nothing of it counts. */
static int verify_into(struct totals *totals, const char *path)
{
  struct verified verified;
  struct eo_error error;
  int status = EO_EXIT_DONE;
  if (verify_file(path, &verified, &error)) {
    totals->refused++;
    status = eo_app_fail(path, &error);
  } else if (eo_case_faulty(verified.file)) {
    totals->refused++;
    status = eo_app_fail_all(path, eo_case_faults(verified.file));
  } else {
    count_checks(totals, &verified.v);
    eo_text_print(&totals->text, "%s\n", path);
    print_table(&verified.v, &totals->text);
  }
  if (verified.file)
    totals->failed = totals->failed || json_array_append_new(totals->files, encode_file(path, &verified)) != 0;
  done(&verified);
  return status;
}

static int print_verdict(struct totals *totals)
{
  if (totals->bad)
    eo_text_print(&totals->text, "%d of %d checks are out of tolerance.\n", totals->bad, totals->checks);
  else if (totals->checks)
    eo_text_print(&totals->text, "All %d checks are within tolerance.\n", totals->checks);
  if (totals->refused && totals->checks)
    eo_text_print(&totals->text, "%d more %s refused.\n", totals->refused,
                  totals->refused > 1 ? "files are" : "file is");
  return eo_app_print(&totals->text);
}

static int print_totals(struct totals *totals, bool as_json)
{
  if (!as_json)
    return print_verdict(totals);
  json_t *document = json_object();
  totals->failed = totals->failed || !document;
  eo_json_put(document, "program", json_string(eo_program), &totals->failed);
  eo_json_put(document, "pass", json_boolean(totals->bad == 0 && totals->refused == 0), &totals->failed);
  eo_json_put(document, "files", json_incref(totals->files), &totals->failed);
  if (totals->failed)
    json_decref(document);
  return eo_app_print_json(totals->failed ? NULL : document, false);
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  bool as_json = false;
  const struct eo_option options[] = {{.name = "--json", .flag = &as_json}, {.name = NULL}};
  const char **path = calloc((size_t)argc, sizeof *path);
  struct totals totals = {.files = json_array()};
  int operands, status = EO_EXIT_FAILED, worst = EO_EXIT_DONE;
  if (!path || !eo_app_arguments(command, argc, argv, options, 1, argc, path, &operands, &status))
    goto out;
  for (int i = 0; i < operands; i++) {
    status = verify_into(&totals, path[i]);
    worst = status > worst ? status : worst;
  }
  status = worst;
  int printed = print_totals(&totals, as_json);
  status = printed > worst ? printed : worst;
  if (!status && totals.bad)
    status = EO_EXIT_INPUT;
out:
  json_decref(totals.files);
  eo_text_done(&totals.text);
  free(path);
  return status;
}

const struct eo_command eo_command_verify = {
    "verify", "CASES.json... [--json]", "computes reference cases and compares them with the expected numbers",
    "Each file names its kind. The program prints one line per case with its largest deviation, in tolerances, and one "
    "per\n"
    "file with the number of checks of each block; --json prints every number.\n"
    "\n"
    "A file is read in full or refused: an unknown kind, block, key or name, a number given as text, a missing number, "
    "and\n"
    "a file or case in which nothing is checked are faults. They are reported as file:pointer: sentence, and nothing "
    "of\n"
    "that file counts. These keys may hold comments anywhere: about, what, note, notes, source, remarks, units,\n"
    "conventions, uncertainty, mesh, reference_*.\n"
    "\n"
    "A number is within tolerance when |value - expected| is at most the larger of a relative part of |expected| and "
    "an\n"
    "absolute part. The relative part is what the file states (tol_rel and the like: above 0, below 1) or what the "
    "kind of\n"
    "case is known to hold. The absolute part is stated in the file's unit, or is the rounding of a printed number, or "
    "a\n"
    "part of a scale: the largest number of the same list, the mean load. An expected 0 needs it. Counts and flags "
    "must\n"
    "agree exactly. A case that did not converge fails and says so.\n"
    "\n"
    "Exit status 1 when a number is out of tolerance or a file is refused.\n",
    run};

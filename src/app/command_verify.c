#include "reference/verify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "format/json.h"
#include "format/text_table.h"

static void done(struct eo_verification *v)
{
  for (int i = 0; i < v->count; i++) {
    free(v->check[i].label);
    free(v->check[i].quantity);
  }
  free(v->check);
  json_decref(v->ignored);
  free((char *)v->folder);
  *v = (struct eo_verification){0};
}

static enum eo_code run_kind(const json_t *cases, struct eo_verification *v, struct eo_error *error)
{
  const char *kind = json_string_value(json_object_get(cases, "kind"));
  struct eo_text known = {0};
  enum eo_code code = EO_ERROR_INPUT;
  const struct eo_verify_kind *candidate;
  for (int i = 0; (candidate = eo_verify_kind_at(i)); i++) {
    if (kind && strcmp(kind, candidate->name) == 0) {
      eo_text_done(&known);
      return candidate->run(cases, v, error);
    }
    eo_text_print(&known, "%s%s", i ? ", " : "", candidate->name);
  }
  eo_error_set(error, code, "/kind", "\"%.40s\" is not a kind of case file; known: %s.", kind ? kind : "(none)",
               known.data ? known.data : "");
  eo_text_done(&known);
  return code;
}

static char *folder_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
}

static enum eo_code verify_file(const char *path, struct eo_verification *v, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  *v = (struct eo_verification){.folder = folder_of(path), .ignored = json_array()};
  json_t *cases = eo_json_load(path, EO_JSON_CASES_BYTES, error);
  if (!cases)
    code = error->code;
  else
    code = run_kind(cases, v, error);
  if (!code && (v->failed || !v->folder || !v->ignored))
    code = eo_error_memory(error);
  json_decref(cases);
  return code;
}

/* How far out, in tolerances; what should be exact counts as far out as it can. */
static double severity(const struct eo_check *check)
{
  double deviation = check->value == check->expected ? 0 : fabs(check->value - check->expected);
  if (isnan(deviation))
    return INFINITY;
  return check->tolerance > 0 ? deviation / check->tolerance : (deviation > 0 ? INFINITY : 0);
}

static void add_row(struct eo_text_table *sheet, const struct eo_verification *v, int first, int count)
{
  int worst = first, bad = 0;
  for (int i = first; i < first + count; i++) {
    bad += !v->check[i].pass;
    if (severity(&v->check[i]) > severity(&v->check[worst]))
      worst = i;
  }
  const struct eo_check *check = &v->check[worst];
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

/* One line per case: its largest deviation, measured in tolerances. */
static void print_table(const struct eo_verification *v, struct eo_text *text)
{
  static const char *const headings[] = {
      "case", "checks", "largest deviation in", "value", "expected", "deviation", "tolerance", "verdict"};
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 8, headings);
  for (int first = 0, count; first < v->count; first += count) {
    for (count = 1; first + count < v->count && strcmp(v->check[first].label, v->check[first + count].label) == 0;)
      count++;
    add_row(&sheet, v, first, count);
  }
  if (v->count)
    eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  for (size_t i = 0; i < json_array_size(v->ignored); i++)
    eo_text_print(text, "  note: %s\n", json_string_value(json_array_get(v->ignored, i)));
}

static json_t *encode_check(const struct eo_check *check)
{
  json_t *row = json_object();
  bool failed = !row;
  eo_json_put(row, "case", json_string(check->label), &failed);
  eo_json_put(row, "quantity", json_string(check->quantity), &failed);
  eo_json_put(row, "value", eo_json_real(check->value, NULL), &failed);
  eo_json_put(row, "expected", eo_json_real(check->expected, NULL), &failed);
  eo_json_put(row, "tolerance", eo_json_real(check->tolerance, NULL), &failed);
  eo_json_put(row, "pass", json_boolean(check->pass), &failed);
  return failed ? (json_decref(row), NULL) : row;
}

static json_t *encode_file(const char *path, const struct eo_verification *v)
{
  json_t *file = json_object(), *rows = json_array();
  bool failed = !file || !rows, pass = true;
  for (int i = 0; i < v->count; i++) {
    failed = failed || json_array_append_new(rows, encode_check(&v->check[i])) != 0;
    pass = pass && v->check[i].pass;
  }
  json_t *name = json_string(path);
  eo_json_put(file, "file", name ? name : json_null(), &failed);
  eo_json_put(file, "pass", json_boolean(pass), &failed);
  eo_json_put(file, "checks", rows, &failed);
  eo_json_put(file, "notes", json_incref(v->ignored), &failed);
  return failed ? (json_decref(file), NULL) : file;
}

struct totals {
  struct eo_text text;
  json_t *files;
  int checks, bad;
  bool failed;
};

static int verify_into(struct totals *totals, const char *path)
{
  struct eo_verification v;
  struct eo_error error;
  if (verify_file(path, &v, &error)) {
    done(&v);
    return eo_app_fail(path, &error);
  }
  for (int i = 0; i < v.count; i++)
    totals->bad += !v.check[i].pass;
  totals->checks += v.count;
  eo_text_print(&totals->text, "%s\n", path);
  print_table(&v, &totals->text);
  totals->failed = totals->failed || json_array_append_new(totals->files, encode_file(path, &v)) != 0;
  done(&v);
  return EO_EXIT_DONE;
}

static int print_totals(struct totals *totals, bool as_json)
{
  if (!as_json) {
    if (totals->bad)
      eo_text_print(&totals->text, "%d of %d checks are out of tolerance.\n", totals->bad, totals->checks);
    else
      eo_text_print(&totals->text, "All %d checks are within tolerance.\n", totals->checks);
    return eo_app_print(&totals->text);
  }
  json_t *document = json_object();
  totals->failed = totals->failed || !document;
  eo_json_put(document, "program", json_string(eo_program), &totals->failed);
  eo_json_put(document, "pass", json_boolean(totals->bad == 0), &totals->failed);
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
  if (totals.checks || !worst) {
    int printed = print_totals(&totals, as_json);
    status = printed > worst ? printed : worst;
  }
  if (!status && totals.bad)
    status = EO_EXIT_INPUT;
out:
  json_decref(totals.files);
  eo_text_done(&totals.text);
  free(path);
  return status;
}

const struct eo_command eo_command_verify = {"verify", "CASES.json... [--json]",
                                             "computes reference cases and compares them with what is expected",
                                             "Each file says its kind. One line per case shows its largest deviation, "
                                             "in tolerances; --json prints every number.\n"
                                             "Exit status 1 when a number is out of tolerance.\n",
                                             run};

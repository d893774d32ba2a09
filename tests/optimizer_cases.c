/* Every block of tests/cases/optimizer.json through the real code, one line per case. */
#include "app/verify_optimizer.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

struct tally {
  char name[100];
  int rows, failed;
  double worst; /* deviation over tolerance */
  int total;
};

static void report(struct tally *t)
{
  if (t->rows > 0)
    ok(t->failed == 0, "%s: %d numbers, %d out of tolerance, largest deviation %.2g of it", t->name, t->rows, t->failed, t->worst);
}

static void count_row(void *context, const struct eo_verify_row *row)
{
  struct tally *t = context;
  if (strcmp(t->name, row->name) != 0) {
    report(t);
    *t = (struct tally){.total = t->total};
    snprintf(t->name, sizeof t->name, "%s", row->name);
  }
  t->rows++;
  t->total++;
  t->failed += !row->pass;
  if (isfinite(row->expected) && row->tolerance > 0)
    t->worst = fmax(t->worst, fabs(row->value - row->expected) / row->tolerance);
  if (!row->pass)
    printf("# %s %s: %.17g, expected %.17g +- %.3g\n", row->name, row->quantity, row->value, row->expected, row->tolerance);
}

static void mark(void *context, const struct eo_verify_row *row)
{
  *(int *)context |= !row->pass;
}

int main(void)
{
  char path[1000];
  snprintf(path, sizeof path, "%s/optimizer.json", getenv("CASES"));
  json_error_t json_error;
  struct eo_error error = {0};
  struct tally tally = {0};
  json_t *root = json_load_file(path, 0, &json_error);
  if (!ok(root != NULL, "the cases are read"))
    return tap_done();
  ok(eo_verify_optimizer(root, count_row, &tally, &error) == EO_OK, "the file has the format %s", error.text);
  report(&tally);
  ok(tally.total > 250, "%d numbers were compared", tally.total);

  int failed = 0;
  json_object_set_new(json_array_get(json_object_get(root, "rng"), 0), "u01", json_real(0.5));
  eo_verify_optimizer(root, mark, &failed, &error);
  ok(failed, "a wrong reference is noticed");
  json_object_del(json_array_get(json_object_get(root, "runs"), 0), "fitness");
  ok(eo_verify_optimizer(root, mark, &failed, &error) == EO_ERROR_INPUT && strcmp(error.pointer, "/runs/0") == 0,
     "a missing key is named: %s %s", error.pointer, error.text);
  json_decref(root);
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What varies: names, values, the order of evaluation, what identifies a variant, and what is refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/result_scalars.h"
#include "format/json.h"
#include "support/tap.h"
#include "variants/variant_plan.h"

#define DESIGN                                                                                                      \
  "\"design\":{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24," \
  "\"face_width_mm\":55},\"load_cases\":[{\"torque_Nm\":828,\"speed_rpm\":2000},{\"torque_Nm\":600,\"speed_rpm\":"  \
  "1000}]"                                                                                                          \
  ",\"modification\":{\"pinion\":{\"left\":{\"tip_relief_um\":10}}}}"

static struct eo_faults faults;

static bool read(struct eo_variant_plan *plan, const char *rest)
{
  struct eo_error error;
  char text[4000];
  snprintf(text, sizeof text, "{" DESIGN ",%s}", rest);
  json_t *document = eo_json_parse(text, strlen(text), &error);
  faults.count = 0;
  bool good = document && eo_variant_plan_init(plan, document, &faults);
  json_decref(document);
  return good;
}

static bool values_are(const struct eo_variant_plan *plan, int row, const char *expected)
{
  json_t *values = eo_variant_values(plan, row);
  char *text = json_dumps(values, JSON_COMPACT | JSON_REAL_PRECISION(9));
  bool right = text && strcmp(text, expected) == 0;
  if (!right)
    printf("# %s\n", text ? text : "");
  free(text);
  json_decref(values);
  return right;
}

static void test_factorial(void)
{
  struct eo_variant_plan plan;
  ok(read(&plan, "\"vary\":[{\"key\":\"gear_pair.pinion_teeth\",\"from\":16,\"to\":18,\"points\":3},"
                 "{\"key\":\"load_cases.*.torque_Nm\",\"values\":[500.5,600.5]}]") &&
         plan.rows == 6,
     "three times two variants are read");
  ok(values_are(&plan, 0, "[16,500.5]") && values_are(&plan, 3, "[17,600.5]") && values_are(&plan, 5, "[18,600.5]"),
     "the last key of a plan varies fastest");
  ok(plan.axis[1].paths == 2 && strcmp(plan.axis[1].path[1], "load_cases.2.torque_Nm") == 0,
     "a key with * stands for every load case");
  ok(plan.axis[0].of_pair && !plan.axis[1].of_pair && !plan.of_modification,
     "teeth take another pair, and a torque does not");
  eo_variant_plan_done(&plan);
}

static void test_order(void)
{
  struct eo_variant_plan plan;
  struct eo_error error;
  int order[6], pairs;
  const int expected[6] = {0, 2, 4, 1, 3, 5};
  read(&plan, "\"vary\":[{\"key\":\"T\",\"values\":[1,2,3]},{\"key\":\"gear_pair.pinion_teeth\",\"values\":[17,16]}]");
  ok(eo_variant_sort(&plan, order, &pairs, &error) == EO_OK && pairs == 2 &&
         memcmp(order, expected, sizeof expected) == 0,
     "variants of one pair stand together, in their order");
  eo_variant_plan_done(&plan);
}

static bool hash_of(const char *rest, int row, char hash[EO_HASH_LENGTH + 1])
{
  struct eo_variant_plan plan;
  struct eo_error error;
  bool good = read(&plan, rest);
  json_t *values = good ? eo_variant_values(&plan, row) : NULL;
  good = good && eo_variant_hash(&plan, values, hash, &error) == EO_OK;
  json_decref(values);
  eo_variant_plan_done(&plan);
  return good;
}

static void test_hashes(void)
{
  char one[EO_HASH_LENGTH + 1], other[EO_HASH_LENGTH + 1], third[EO_HASH_LENGTH + 1];
  ok(hash_of("\"vary\":[{\"key\":\"T\",\"values\":[700,828]}]", 0, one) &&
         hash_of("\"vary\":[{\"key\":\"modification.pinion.left.tip_relief_um\",\"values\":[10,12]},"
                 "{\"key\":\"load_cases.1.torque_Nm\",\"values\":[650,700]}]",
                 1, other) &&
         strcmp(one, other) == 0,
     "the same design by other keys is the same row");
  ok(hash_of("\"vary\":[{\"key\":\"T [kNm]\",\"values\":[0.7,0.8]}]", 0, third) && strcmp(one, third) == 0,
     "the same design in another unit is the same row");
  ok(hash_of("\"vary\":[{\"key\":\"T\",\"values\":[700,828]}]", 1, other) && strcmp(one, other) != 0,
     "another value is another row");
}

static void test_samples(void)
{
  for (int kind = 0; kind < 2; kind++) {
    struct eo_variant_plan plan;
    char rest[300];
    int strata[16] = {0}, teeth[3] = {0};
    bool right = true;
    snprintf(rest, sizeof rest,
             "\"sampling\":\"%s\",\"samples\":16,\"vary\":[{\"key\":\"T\",\"from\":0,\"to\":16},"
             "{\"key\":\"gear_pair.pinion_teeth\",\"from\":16,\"to\":18}]",
             kind ? "latin" : "sobol");
    ok(read(&plan, rest) && plan.rows == 16, "a plan of %d samples is read", plan.rows);
    for (int row = 0; row < plan.rows; row++) {
      json_t *values = eo_variant_values(&plan, row);
      strata[(int)json_number_value(json_array_get(values, 0)) % 16]++;
      json_int_t count = json_integer_value(json_array_get(values, 1));
      right = right && count >= 16 && count <= 18;
      teeth[(count - 16) % 3]++;
      json_decref(values);
    }
    for (int i = 0; i < 16; i++)
      right = right && strata[i] == 1;
    ok(right && teeth[0] && teeth[1] && teeth[2],
       "each part of a range holds one sample, and whole numbers stay whole");
    eo_variant_plan_done(&plan);
  }
}

/* A number of a flank's grid is a key, of one place or of a whole row. */
static void test_grids(void)
{
  static const char text[] = "{" DESIGN ",\"vary\":[{\"key\":\"modification.pinion.*.grid_um.2.3\",\"values\":[1,5]},"
                             "{\"key\":\"modification.pinion.left.grid_um.4.0\",\"values\":[7]}]}";
  struct eo_variant_plan plan;
  struct eo_error error;
  struct eo_geometry geometry;
  struct eo_design *design = malloc(sizeof *design);
  json_t *document = eo_json_parse(text, strlen(text), &error), *flank[2];
  json_t *member = json_object_get(json_object_get(json_object_get(document, "design"), "modification"), "pinion");
  json_object_set_new(member, "right", json_object());
  for (int end = 0; end < 2; end++) {
    flank[end] = json_object_get(member, end ? "right" : "left");
    json_object_set_new(flank[end], "grid",
                        json_pack("{s:[i,i,i,i], s:[i,i,i,i], s:[[i,i,i,i],[i,i,i,i],[i,i,i,i],[i,i,i,i]]}", "u_mm", -4,
                                  -1, 2, 5, "y_mm", -25, -8, 8, 25, "delta_um", 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0,
                                  0, 0, 0));
  }
  faults.count = 0;
  bool good = eo_variant_plan_init(&plan, document, &faults);
  json_t *values = good ? eo_variant_values(&plan, 1) : NULL;
  good = good && eo_variant_design(plan.base, plan.axis, plan.axes, values, design, &geometry, &error) == EO_OK;
  ok(good && plan.rows == 2 && plan.axis[0].paths == 2, "numbers of the grids of both ends vary %s",
     good           ? ""
     : faults.count ? faults.fault[0].text
                    : error.text);
  if (good) {
    const struct eo_flank_grid left = eo_flank_grid_at(&design->grids, EO_DRIVE_FLANK, EO_PINION, EO_LEFT),
                               right = eo_flank_grid_at(&design->grids, EO_DRIVE_FLANK, EO_PINION, EO_RIGHT);
    close_to(1e6 * left.delta[6], 5, 1e-9, "delta at row 2, column 3, um");
    close_to(1e6 * right.delta[6], 5, 1e-9, "delta at the same place on the other end, um");
    close_to(1e6 * left.delta[12], 7, 1e-9, "delta at row 4 of all columns, first, um");
    close_to(1e6 * left.delta[15], 7, 1e-9, "delta at row 4 of all columns, last, um");
    close_to(1e6 * right.delta[15], 0, 1e-9, "delta of the other grid at row 4, um");
    ok(!plan.of_modification, "rows of a search that know nothing of these numbers are none of its rows");
    ok(left.kind == EO_GRID_DESIGNED && right.kind == EO_GRID_DESIGNED &&
           plan.design->grids.place[EO_DRIVE_FLANK][EO_PINION][EO_LEFT].kind == EO_GRID_MEASURED,
       "a grid that varies is designed, and the base is as it was");
  }
  json_decref(values);
  json_decref(document);
  eo_variant_plan_done(&plan);
  free(design);
  ok(!read(&plan, "\"vary\":[{\"key\":\"gear_pair.grid_um.1.1\",\"values\":[1]}]"),
     "a key of a grid that the pair has not is refused");
  eo_variant_plan_done(&plan);
}

static void test_table(void)
{
  struct eo_variant_plan plan;
  struct eo_error error;
  struct eo_design *design = malloc(sizeof *design);
  struct eo_geometry geometry;
  ok(read(
         &plan,
         "\"table\":\"b [inch];alignment.pinion_axial;resolution.tip_edge_contact\\n2;fixed;false\\n;floating;\\n\"") &&
         plan.rows == 2,
     "a table with units, words, flags and an empty cell is read");
  json_t *values = eo_variant_values(&plan, 0);
  ok(eo_variant_design(plan.base, plan.axis, plan.axes, values, design, &geometry, &error) == EO_OK &&
         fabs(design->gear_pair.face_width - 0.0508) < 1e-12 && design->alignment.pinion_axial == EO_AXIAL_FIXED &&
         !design->resolution.tip_edge_contact,
     "a row of a table makes a design");
  json_decref(values);
  values = eo_variant_values(&plan, 1);
  ok(eo_variant_design(plan.base, plan.axis, plan.axes, values, design, &geometry, &error) == EO_OK &&
         fabs(design->gear_pair.face_width - 0.055) < 1e-12,
     "an empty cell leaves the design as it is");
  json_decref(values);
  eo_variant_plan_done(&plan);
  free(design);
}

static void refuses(const char *rest, const char *pointer, const char *text)
{
  struct eo_variant_plan plan;
  bool refused = !read(&plan, rest) && strcmp(faults.fault[0].pointer, pointer) == 0 &&
                 strstr(faults.fault[0].text, text);
  if (!ok(refused, "the plan is refused: %s", text))
    printf("# %s: %s\n", faults.fault[0].pointer, faults.fault[0].text);
  eo_variant_plan_done(&plan);
}

static void test_refusals(void)
{
  refuses("\"vary\":[]", "/vary", "Nothing varies");
  refuses("\"vary\":[{\"key\":\"gear_pair.teeth\",\"values\":[1]}]", "/vary/0", "gear_pair.pinion_teeth");
  refuses("\"vary\":[{\"key\":\"T [mm]\",\"values\":[1]}]", "/vary/0", "unit");
  refuses("\"vary\":[{\"key\":\"T\",\"values\":[1],\"from\":2}]", "/vary/0", "one of them");
  refuses("\"vary\":[{\"key\":\"T\",\"from\":2,\"to\":1,\"points\":2}]", "/vary/0", "below its start");
  refuses("\"vary\":[{\"key\":\"alignment.pinion_axial\",\"values\":[1]}]", "/vary/0", "words");
  refuses("\"vary\":[{\"key\":\"gear_pair.*.x\",\"values\":[1]}]", "/vary/0", "stands for load cases");
  refuses("\"vary\":[{\"key\":\"T\",\"values\":[1]}],\"table\":\"T\\n1\\n\"", "/table", "not both");
  refuses("\"table\":\"T\\nmuch\\n\"", "/table", "Line 2, column 1");
  refuses("\"vary\":[{\"key\":\"T\",\"from\":1,\"to\":2,\"points\":100000},{\"key\":\"n\",\"from\":1,\"to\":2,"
          "\"points\":101}]",
          "", "are more than");
  refuses("\"vary\":[{\"key\":\"T\",\"values\":[1]}],\"sampling\":\"grid\"", "/sampling", "factorial");
}

static void test_columns(void)
{
  struct eo_scalars scalars;
  struct eo_error error;
  ok(eo_scalars_init(&scalars, eo_scalars_usual, 3, 2, &error) == EO_OK && scalars.objectives && !scalars.want &&
         scalars.count == 6 + 3 * 6,
     "the usual columns need the objectives alone");
  eo_scalars_done(&scalars);
  ok(eo_scalars_init(&scalars, "rating.*", 1, 2, &error) == EO_OK && scalars.want == EO_WANT_RATING &&
         !scalars.objectives,
     "a rating is computed when its numbers are wanted");
  eo_scalars_done(&scalars);
  ok(eo_scalars_init(&scalars, "*", 1, 1, &error) == EO_OK && scalars.want == (EO_WANT_RATING | EO_WANT_ROOT),
     "all columns need rating and root stress");
  bool right_end = false;
  for (int i = 0; i < scalars.count; i++)
    right_end = right_end || strstr(scalars.scalar[i].name, ".right.");
  ok(!right_end, "a pair with one end has no column of the right one");
  eo_scalars_done(&scalars);
  ok(eo_scalars_init(&scalars, "objectives.J,objective.K", 1, 2, &error) == EO_ERROR_INPUT &&
         strstr(error.text, "objective.K"),
     "a column that is none is refused: %s", error.text);
}

int main(void)
{
  test_factorial();
  test_order();
  test_hashes();
  test_samples();
  test_grids();
  test_table();
  test_refusals();
  test_columns();
  return tap_done();
}

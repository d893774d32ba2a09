/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_ring.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gear/names.h"
#include "reference/case_pair.h"

enum { MOST_DISTANCE = 6, MOST_POINTS = 40 };

/* The number that stands in the words of the file's mesh before a phrase, or the fallback; those of the list of pairs
   stand behind its name. */
static int mesh_count(const struct eo_ring_case *ring_case, bool pairs, const char *phrase, int fallback)
{
  static const char LIST[] = "gear pairs of the list";
  const char *text = json_string_value(json_object_get(eo_case_json(ring_case->file), "mesh"));
  const char *list = text ? strstr(text, LIST) : NULL, *from = pairs && list ? list : text;
  const char *found = from ? strstr(from, phrase) : NULL;
  if (!found || (!pairs && list && found > list))
    return fallback;
  while (found > from && (found[-1] == ' ' || (found[-1] >= '0' && found[-1] <= '9')))
    found--;
  int number = atoi(found);
  return number > 0 ? number : fallback;
}

enum eo_code eo_ring_prepare(const struct eo_ring_case *ring_case, bool pairs, int reach, struct eo_design *design,
                             struct eo_flexibility **flexibility, struct eo_error *error)
{
  struct eo_geometry geometry;
  struct eo_resolution *resolution = &design->resolution;
  enum eo_code code = eo_geometry_init(&geometry, &design->gear_pair, error);
  resolution->elements.layers = mesh_count(ring_case, pairs, " layers", resolution->elements.layers);
  resolution->elements.flank_rows = mesh_count(ring_case, pairs, " rows", resolution->elements.flank_rows);
  resolution->elements.fillet_elements = mesh_count(
      ring_case, pairs, pairs ? " root elements" : " elements along the root", resolution->elements.fillet_elements);
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(resolution);
  settings.reach = reach;
  return code ? code
              : eo_flexibility_prepare(&geometry, &design->gear_pair, &design->material, &settings, NULL, NULL,
                                       flexibility, error);
}

void eo_ring_support(const struct eo_ring_case *ring_case, const char *name, struct eo_case *where,
                     struct eo_design *design)
{
  static const struct {
    const char *name;
    enum eo_body body;
    enum eo_body_support support;
  } known[] = {{"floating", EO_BODY_RING, EO_SUPPORT_FLOATING},
               {"held", EO_BODY_RING, EO_SUPPORT_HELD},
               {"solid", EO_BODY_RING, EO_SUPPORT_HELD_AT_BORE},
               {"sector5", EO_BODY_SECTOR, EO_SUPPORT_HELD},
               {"sector5 with next pair", EO_BODY_SECTOR, EO_SUPPORT_HELD}};
  struct eo_resolution *resolution = &design->resolution;
  resolution->elements.neighbour_coupling = true;
  resolution->elements.sector_teeth = 5;
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    if (strcmp(name, known[i].name) != 0)
      continue;
    resolution->elements.body = known[i].body;
    resolution->elements.support = known[i].support;
    for (int m = 0; m < 2 && known[i].support == EO_SUPPORT_HELD_AT_BORE; m++)
      design->gear_pair.bore[m] = 2 * ring_case->held_radius[m];
    if (known[i].support == EO_SUPPORT_HELD_AT_BORE && isnan(ring_case->held_radius[0]))
      eo_case_fault(where, "The file's supports do not say at what radius \"solid\" is held.");
    return;
  }
  eo_case_fault(where, "This program does not have the support \"%.60s\"; it has floating, held, solid, sector5.",
                name);
}

/* A whole number of pairs as the key of a value; 0 and a fault when it is none. */
static int distance_of(struct eo_case *value)
{
  double d = eo_case_key_number(value);
  if (isnan(d))
    return 0;
  if (d == round(d) && d != 0 && fabs(d) <= MOST_DISTANCE)
    return (int)d;
  eo_case_fault(value, "A distance is a whole number of pairs from -%d to %d, without 0.", MOST_DISTANCE,
                MOST_DISTANCE);
  return 0;
}

/* Prepares a support, unless it is the one prepared last; a faulty file is not computed. */
static enum eo_code prepare(struct eo_ring_case *ring_case, const char *support, struct eo_case *where,
                            struct eo_error *error)
{
  struct eo_design design = ring_case->design;
  eo_ring_support(ring_case, support, where, &design);
  if (eo_case_faulty(where) || (ring_case->flexibility && strcmp(ring_case->support, support) == 0))
    return EO_OK;
  eo_flexibility_free(ring_case->flexibility);
  ring_case->flexibility = NULL;
  snprintf(ring_case->support, sizeof ring_case->support, "%s", support);
  return eo_ring_prepare(ring_case, false, MOST_DISTANCE, &design, &ring_case->flexibility, error);
}

/* D[d][i][j]: displacement at point i of pair d for 1 kN at point j of pair 0, um. */
static enum eo_code check_distance(struct eo_ring_case *ring_case, int member, int n, const double (*place)[2],
                                   struct eo_case *matrix, struct eo_error *error)
{
  struct eo_flank_point point[2 * MOST_POINTS];
  double *compliance = calloc((size_t)4 * n * n, sizeof *compliance), largest = eo_case_largest(matrix);
  int d = distance_of(matrix);
  if (!compliance)
    return eo_error_memory(error);
  for (int i = 0; i < 2 * n; i++)
    point[i] = (struct eo_flank_point){i < n ? 0 : d, {place[i % n][0], place[i % n][0]}, place[i % n][1]};
  if (ring_case->flexibility && d)
    eo_flexibility_add_compliance(ring_case->flexibility, member, 2 * n, point, compliance);
  eo_verify_size(ring_case->v, matrix, n);
  for (int i = 0; i < n && i < eo_case_size(matrix); i++) {
    double row[MOST_POINTS];
    for (int j = 0; j < n; j++)
      row[j] = compliance[(n + i) * 2 * n + j];
    eo_verify_list(ring_case->v, eo_case_at(matrix, i), n, row, 1e9, 0, ring_case->tolerance.between * largest);
  }
  free(compliance);
  return EO_OK;
}

static int read_points(struct eo_case *list, double (*place)[2])
{
  int n = eo_case_size(list);
  if (n < 1 || n > MOST_POINTS) {
    eo_case_fault(list, "There must be 1 to %d points [s, eta].", MOST_POINTS);
    return 0;
  }
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 2; k++)
      place[i][k] = 1e-3 * eo_case_element(eo_case_at(list, i), k);
  return n;
}

/* "pinion_floating": the member and the rest. */
static const char *support_of(struct eo_case *value, int *member)
{
  for (*member = 0; *member < 2; ++*member) {
    size_t length = strlen(eo_member_name[*member]);
    if (strncmp(eo_case_key(value), eo_member_name[*member], length) == 0 && eo_case_key(value)[length] == '_')
      return eo_case_key(value) + length + 1;
  }
  return NULL;
}

static enum eo_code check_points(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_ring_case *ring_case = context;
  double place[MOST_POINTS][2];
  int n = read_points(eo_case_need(block, "points"), place);
  enum eo_code code = EO_OK;
  for (int i = 0; i < eo_case_size(block) && !code && n; i++) {
    int member;
    const char *support = support_of(eo_case_peek(block, i), &member);
    struct eo_case *matrices = support ? eo_case_at(block, i) : NULL;
    if (matrices)
      code = prepare(ring_case, support, matrices, error);
    for (int k = 0; k < eo_case_size(matrices) && !code && !eo_case_faulty(block); k++)
      code = check_distance(ring_case, member, n, (const double(*)[2])place, eo_case_at(matrices, k), error);
  }
  return code;
}

/* Deflection of pair d at (s, eta), m, under 1 N/m on the row s of pair 0, by the trapezoidal rule. */
static enum eo_code deflect(const struct eo_ring_case *ring_case, int member, double s, double eta, int d,
                            double *deflection, struct eo_error *error)
{
  int layers = mesh_count(ring_case, false, " layers", ring_case->design.resolution.elements.layers), n = layers + 2;
  double width = ring_case->geometry.face_width;
  struct eo_flank_point *point = calloc((size_t)n, sizeof *point);
  double *compliance = calloc((size_t)n * n, sizeof *compliance);
  enum eo_code code = point && compliance ? EO_OK : eo_error_memory(error);
  *deflection = 0;
  if (!code) {
    for (int l = 0; l <= layers; l++)
      point[l] = (struct eo_flank_point){0, {s, s}, width * ((double)l / layers - 0.5)};
    point[n - 1] = (struct eo_flank_point){d, {s, s}, eta};
    eo_flexibility_add_compliance(ring_case->flexibility, member, n, point, compliance);
    for (int l = 0; l <= layers; l++)
      *deflection += width / layers * (l == 0 || l == layers ? 0.5 : 1) * compliance[(n - 1) * n + l];
  }
  free(point);
  free(compliance);
  return code;
}

/* The mesh's row of nodes nearest the pitch point, as the reference has it. */
static double pitch_row(const struct eo_ring_case *ring_case)
{
  const struct eo_geometry *geometry = &ring_case->geometry;
  double step = (geometry->path_end - geometry->path_start) /
                mesh_count(ring_case, false, " rows", ring_case->design.resolution.elements.flank_rows);
  return geometry->path_start + step * round(-geometry->path_start / step);
}

/* Mid face, eta = +b/2, eta = -b/2. */
static enum eo_code check_row(struct eo_ring_case *ring_case, int member, double s, struct eo_case *row,
                              struct eo_error *error)
{
  static const double place[3] = {0, 0.5, -0.5};
  enum eo_code code = EO_OK;
  if (!row)
    return EO_OK;
  eo_verify_size(ring_case->v, row, 3);
  for (int k = 0; k < 3 && k < eo_case_size(row) && !code; k++) {
    double value;
    code = deflect(ring_case, member, s, place[k] * ring_case->geometry.face_width, 0, &value, error);
    eo_verify_number(ring_case->v, eo_case_at(row, k), 1e9 * value,
                     k ? ring_case->tolerance.face_end : ring_case->tolerance.own, 0);
  }
  return code;
}

/* "The largest value of that distance": face ends included, because mid face alone may stand still. */
static enum eo_code check_coupling(struct eo_ring_case *ring_case, int member, struct eo_case *list,
                                   struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < eo_case_size(list) && !code; i++) {
    struct eo_case *wanted = eo_case_at(list, i);
    int d = distance_of(wanted);
    double value = NAN, end = 0, largest = 0, pitch = pitch_row(ring_case);
    for (int side = -1; side <= 1 && d && !code; side += 2) {
      code = deflect(ring_case, member, pitch, 0.5 * side * ring_case->geometry.face_width, d, &end, error);
      largest = fmax(largest, fabs(end));
    }
    if (d && !code)
      code = deflect(ring_case, member, pitch, 0, d, &value, error);
    eo_verify_number(ring_case->v, wanted, 1e9 * value, 0,
                     1e9 * ring_case->tolerance.between * fmax(largest, fabs(value)));
  }
  return code;
}

static enum eo_code check_line(struct eo_ring_case *ring_case, int member, struct eo_case *block,
                               struct eo_error *error)
{
  const struct eo_geometry *geometry = &ring_case->geometry;
  double tip = member == EO_PINION ? geometry->path_end : geometry->path_start;
  double start = member == EO_PINION ? geometry->path_start : geometry->path_end, part[2];
  EO_TRY(prepare(ring_case, eo_case_key(block), block, error));
  if (eo_case_faulty(block))
    return EO_OK;
  EO_TRY(check_row(ring_case, member, tip, eo_case_find(block, "tip"), error));
  EO_TRY(check_row(ring_case, member, pitch_row(ring_case), eo_case_find(block, "pitch"), error));
  EO_TRY(check_row(ring_case, member, start, eo_case_find(block, "start_of_active_profile"), error));
  EO_TRY(check_coupling(ring_case, member, eo_case_find(block, "coupling_mid_pitch"), error));
  struct eo_case *parts = eo_case_find(block, "part_of_harmonic_0_and_1_in_C_full_mid_pitch");
  eo_flexibility_parts(ring_case->flexibility, member, pitch_row(ring_case), part);
  eo_verify_member(ring_case->v, parts, "0", 1e9 * part[0], ring_case->tolerance.part, 0);
  eo_verify_member(ring_case->v, parts, "1", 1e9 * part[1], ring_case->tolerance.part, 0);
  return EO_OK;
}

static enum eo_code check_lines(void *context, struct eo_case *block, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int member = 0; member < 2 && !code; member++) {
    struct eo_case *supports = eo_case_find(block, eo_member_name[member]);
    for (int i = 0; i < eo_case_size(supports) && !code && !eo_case_faulty(block); i++)
      code = check_line(context, member, eo_case_at(supports, i), error);
  }
  return code;
}

/* "max(0.03 um, 6 %)" */
static void read_swing(struct eo_case *block, const char *key, double swing[2])
{
  const char *text = eo_case_word(block, key);
  if (text && (sscanf(text, "max(%lf um, %lf %%)", &swing[0], &swing[1]) != 2 || !(swing[0] > 0) || !(swing[1] > 0)))
    eo_case_fault(eo_case_find(block, key), "A tolerance of PPLTE is like \"max(0.03 um, 6 %%)\".");
  swing[1] *= 1e-2;
}

static void read_tolerances(struct eo_ring_case *ring_case)
{
  struct eo_ring_tolerances *tolerances = &ring_case->tolerance;
  struct eo_case *block = eo_case_need(ring_case->file, "tolerances");
  const struct {
    const char *key;
    double *value;
  } row[] = {{"line compliance of the tooth itself, mid face, rel", &tolerances->own},
             {"the same, face ends, rel", &tolerances->face_end},
             {"between teeth, rel of the largest value of that distance", &tolerances->between},
             {"harmonic parts, rel", &tolerances->part},
             {"mean LTE, k, k_tan, c, rel", &tolerances->stiffness},
             {"share", &tolerances->share},
             {"root stress, rel (9 root elements; ratios between supports 0.01)", &tolerances->root}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    *row[i].value = eo_case_number(block, row[i].key);
    if (!(*row[i].value > 0 && *row[i].value < 1) && !eo_case_faulty(block))
      eo_case_fault(eo_case_find(block, row[i].key), "A tolerance lies between 0 and 1.");
  }
  read_swing(block, "PPLTE (32 positions)", tolerances->swing);
  read_swing(block, "PPLTE of the list of pairs (16 positions)", tolerances->pairs_swing);
  eo_case_remark(block, "seen on two other meshes of the same code");
  struct eo_case *of_check = eo_case_find(block, "ring by harmonics against all teeth meshed and solved at once, same "
                                                 "mesh, rel");
  if (of_check)
    eo_verify_uncompared(ring_case->v, of_check, "it is a test of the program's own (test-ring)");
}

/* Supports are described in words; only "solid" has numbers in them. */
static void read_supports(struct eo_ring_case *ring_case)
{
  struct eo_case *block = eo_case_find(ring_case->file, "supports");
  ring_case->held_radius[0] = ring_case->held_radius[1] = NAN;
  for (int i = 0; i < eo_case_size(block); i++) {
    struct eo_case *support = eo_case_at(block, i);
    const char *text = eo_case_text(support);
    double radius[2];
    if (!text || strcmp(eo_case_key(support), "solid") != 0)
      continue;
    if (sscanf(text, "held at radius %lf mm (pinion), %lf mm (gear)", &radius[0], &radius[1]) != 2)
      eo_case_fault(support, "It must be described as \"held at radius 10 mm (pinion), 45 mm (gear)\".");
    else
      for (int m = 0; m < 2; m++)
        ring_case->held_radius[m] = 1e-3 * radius[m];
  }
}

static const struct eo_verify_block blocks[] = {
    {"macro", EO_BLOCK_INPUT, NULL},
    {"supports", EO_BLOCK_INPUT, NULL},
    {"tolerances", EO_BLOCK_INPUT, NULL},
    {"modification", EO_BLOCK_INPUT, NULL},
    {"points", EO_BLOCK_WHOLE, check_points},
    {"line", EO_BLOCK_WHOLE, check_lines},
    {"ltca", EO_BLOCK_WHOLE, eo_ring_check_ltca},
    {"pairs", EO_BLOCK_WHOLE, eo_ring_check_pairs},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_ring(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct eo_ring_case *ring_case = calloc(1, sizeof *ring_case);
  if (!ring_case)
    return eo_error_memory(error);
  ring_case->v = verification;
  ring_case->file = file;
  read_tolerances(ring_case);
  read_supports(ring_case);
  eo_case_design(eo_case_need(file, "macro"), &ring_case->design);
  enum eo_code code = eo_case_faulty(file)
                          ? EO_OK
                          : eo_geometry_init(&ring_case->geometry, &ring_case->design.gear_pair, error);
  if (!code && !eo_case_faulty(file)) {
    eo_design_resolve(&ring_case->design, &ring_case->geometry);
    code = eo_verify_blocks(verification, file, blocks, ring_case, error);
  }
  eo_flexibility_free(ring_case->flexibility);
  free(ring_case);
  return code;
}

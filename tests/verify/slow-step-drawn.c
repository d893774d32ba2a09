/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Teeth of pairs drawn at random as STEP, with reliefs of every shape, corner reliefs, twist and grids: how far the
   splines are from what the rack leaves, by the file's own words and, where gmsh is installed, by the nodes that
   OpenCASCADE makes of some of them. slow-step-drawn [FIRST [COUNT [EVERY]]]: pairs; of every EVERY-th both
   members are loaded (0: none). With DRAWN=FOLDER each design is left there. */
#include "document/design_document.h"
#include "document/examples.h"
#include "exchange/flank_pieces.h"
#include "format/object.h"
#include "support/contact-fixture.h"
#include "support/step-mesh.h"

static const double allowed = 10e-9; /* m off the exact surface */
enum { KNOTS = 15 };

static struct eo_design design;
static struct eo_geometry geometry;

static double draw(int index, int number, double low, double high)
{
  return random_between(index, 10000 + number, low, high);
}

/* One or two corners. */
static void draw_corners(struct eo_flank_modification *flank, int index, int first)
{
  double m = geometry.normal_module / 6e-3, range = geometry.rack_top - geometry.rack_bottom;
  for (int i = 0; i < 4; i++) {
    int n = first + 10 * i;
    if (draw(index, n, 0, 1) < 0.25)
      flank->triangular[i / 2][i % 2] =
          (struct eo_triangular_relief){m * draw(index, n + 1, 2e-6, 20e-6), range * draw(index, n + 2, 0.15, 0.8),
                                        geometry.face_width * draw(index, n + 3, 0.1, 0.7),
                                        draw(index, n + 4, 0, 1) < 0.6 ? 1 : draw(index, n + 5, 1, 3)};
  }
}

/* A smooth surface over part of the flank or more than all of it, with a border. */
static bool draw_grid(int side, int member, int end, int index, int first)
{
  double u[KNOTS], y[KNOTS], delta[KNOTS * KNOTS], active[2], m = geometry.normal_module / 6e-3,
                                                              size = m * draw(index, first, 1e-6, 6e-6),
                                                              share = draw(index, first + 1, 0.7, 1.1);
  const int count[2] = {4 + (int)draw(index, first + 2, 0, 6), 5 + (int)draw(index, first + 3, 0, 10)};
  struct eo_error error;
  eo_active_profile(&geometry, member, active);
  for (int i = 0; i < count[0]; i++)
    u[i] = (active[0] + active[1]) / 2 + (active[1] - active[0]) / 2 * share * (2. * i / (count[0] - 1) - 1);
  for (int i = 0; i < count[1]; i++)
    y[i] = geometry.face_width / 2 * share * (2. * i / (count[1] - 1) - 1);
  for (int i = 0; i < count[0] * count[1]; i++)
    delta[i] = size * sin(i % count[1] * 0.7 + draw(index, first + 4, 0, 6)) * cos(i / count[1] * 0.9);
  const struct eo_flank_grid grid = {.u_knots = count[0], .y_knots = count[1], .u = u, .y = y, .delta = delta};
  return !eo_flank_grids_put(&design.grids, (enum eo_flank_side)side, member, end, &grid, &error);
}

static bool draw_flanks(int index)
{
  struct eo_geometry as_pinion[2] = {geometry, geometry}; /* random_modification() takes the ends of the pinion */
  as_pinion[EO_GEAR].rack_top = -geometry.rack_bottom;
  as_pinion[EO_GEAR].rack_bottom = -geometry.rack_top;
  for (int i = 0; i < 8; i++) {
    struct eo_flank_modification *flank = i < 4 ? &design.modification.flank[i / 2][i % 2]
                                                : &design.modification.coast[i / 2 % 2][i % 2];
    int first = 100 * (i + 1);
    *flank = random_modification(&as_pinion[i / 2 % 2], index, 20000 + first);
    if (draw(index, first, 0, 1) < 0.5)
      draw_corners(flank, index, first + 20);
    if (draw(index, first + 1, 0, 1) < 0.4)
      flank->twist = geometry.normal_module / 6e-3 * draw(index, first + 2, -8e-6, 8e-6);
    for (int k = 0; k < 2; k++)
      if (draw(index, first + 3 + k, 0, 1) < 0.3) {
        flank->own_shape[k] = 1 + EO_RELIEF_EXPONENT;
        flank->exponent[k] = draw(index, first + 5 + k, 1, 4);
      }
    for (int k = 0; k < 2; k++)
      flank->end_shape[k] = (enum eo_relief_shape)(int)draw(index, first + 7 + k, 0, 2.999);
    if (i % 2 < design.gear_pair.ends && draw(index, first + 9, 0, 1) < 0.3 &&
        !draw_grid(i / 4, i / 2 % 2, i % 2, index, first + 80))
      return false;
  }
  return true;
}

static bool draw_design(int index)
{
  struct eo_error error;
  struct eo_gear_pair pair;
  if (!eo_example_build("paper", &design) || !random_pair(index, &pair, &geometry))
    return false;
  struct eo_gear_pair *own = &design.gear_pair;
  own->ends = index % 2 ? 1 : 2;
  memcpy(own->teeth, pair.teeth, sizeof own->teeth);
  memcpy(own->profile_shift, pair.profile_shift, sizeof own->profile_shift);
  own->normal_module = pair.normal_module;
  own->normal_pressure_angle = pair.normal_pressure_angle;
  own->helix_angle = pair.helix_angle;
  own->face_width = pair.face_width;
  own->groove_width = pair.groove_width;
  own->backlash = pair.backlash;
  own->addendum_coefficient = pair.addendum_coefficient;
  own->dedendum_coefficient = pair.dedendum_coefficient;
  own->fillet_radius_coefficient = pair.fillet_radius_coefficient;
  enum eo_code code = draw_flanks(index) ? eo_design_complete(&design, &geometry, &error) : EO_ERROR_MEMORY;
  if (code)
    printf("# pair %d: %s %s\n", index, error.pointer, error.text);
  return code == EO_OK;
}

/* What the file says of itself: the largest deviation, nm; 0: none is above 5 nm. A flank that a relief folds is named
   and counts as one that the file does not promise. */
static double stated_deviation(const char *text, bool *folded)
{
  double largest = 0;
  *folded = strstr(text, "where reliefs fold it") != NULL;
  for (const char *at = strstr(text, "/* "); at; at = strstr(at + 1, "/* ")) {
    const char *number = strstr(at, "up to ");
    largest = fmax(largest, number ? 1e3 * strtod(number + 6, NULL) : INFINITY);
    printf("# %.*s\n", (int)strcspn(at, "\n"), at);
  }
  return largest;
}

/* From the pieces of a flank, which the file measures against what the rack leaves: at kinks, where eo_tooth_point()
   has what each side generates, and neither what the rack's corner sweeps between them nor where they cross. */
static double distance_from_pieces(const struct eo_tooth *tooth, bool coast, const double node[3])
{
  static struct eo_flank_pieces flank;
  double nearest = INFINITY, point[3];
  eo_flank_pieces_init(&flank, tooth, coast ? EO_TOOTH_COAST : EO_TOOTH_DRIVE);
  for (int k = 0; k < flank.count; k++) {
    if (flank.piece[k].lost)
      continue;
    struct eo_flank_row row = {.b = -1};
    double at[2] = {0.5, 0.5}, best = INFINITY;
    for (double step = 0.25; step > 1e-7;) {
      double to[2] = {at[0], at[1]}, before = best;
      for (int i = 0; i < 9; i++) {
        double a = clamp(at[0] + step * (i % 3 - 1)), b = clamp(at[1] + step * (i / 3 - 1));
        eo_flank_piece_point(&flank, k, &row, a, b, point, NULL);
        if (apart(node, point) < best) {
          best = apart(node, point);
          to[0] = a;
          to[1] = b;
        }
      }
      step = best < before ? step : step / 2;
      at[0] = to[0];
      at[1] = to[1];
    }
    nearest = fmin(nearest, best);
  }
  return nearest;
}

static void check_loaded(int index, int member, bool folded)
{
  char folder[64], path[100], line[200];
  double largest = 0, node[3];
  int nodes = 0, off = 0, ends = design.gear_pair.ends;
  struct eo_tooth tooth[2];
  struct eo_error error;
  bool made = make_mesh(&design, &geometry, member, folder);
  snprintf(path, sizeof path, "%s/tooth.msh", folder);
  FILE *mesh = made ? fopen(path, "r") : NULL;
  for (int end = 0; end < ends; end++)
    if (eo_tooth_init(&tooth[end], &design, &geometry, member, end, &error))
      printf("Bail out! %s\n", error.text);
  while (mesh && fgets(line, sizeof line, mesh) && strncmp(line, "$Nodes", 6) != 0)
    continue;
  while (mesh && fgets(line, sizeof line, mesh) && *line != '$') {
    int number;
    char rest[4];
    if (sscanf(line, "%d %lf %lf %lf %3s", &number, &node[0], &node[1], &node[2], rest) != 4)
      continue;
    double nearest = 1;
    for (int c = 0; c < 3; c++)
      node[c] *= 1e-3;
    const struct eo_tooth *own = &tooth[ends == 2 && node[2] > 0];
    for (int part = 0; part < EO_TOOTH_PARTS && nearest > allowed; part++)
      nearest = fmin(nearest, distance_from(own, (enum eo_tooth_part)part, node));
    for (int coast = 0; coast < 2 && nearest > allowed; coast++)
      nearest = fmin(nearest, distance_from_pieces(own, coast, node));
    if (nearest > allowed && off++ < 5)
      printf("# node %.9g %.9g %.9g mm is %.3g nm off\n", 1e3 * node[0], 1e3 * node[1], 1e3 * node[2], 1e9 * nearest);
    largest = fmax(largest, nearest);
    nodes++;
  }
  if (mesh)
    fclose(mesh);
  remove_mesh(folder);
  for (int end = 0; end < ends; end++)
    eo_tooth_done(&tooth[end]);
  ok(nodes > 100 && largest <= allowed,
     "pair %d, %s: OpenCASCADE meshes the tooth; %d nodes within %.2g nm, %d above 10 nm%s", index,
     member ? "gear" : "pinion", nodes, 1e9 * largest, off, folded ? ", folded by a relief" : "");
}

/* What was not drawn is 0, which a document has as no number of its key. */
static void drop_zeros(json_t *object)
{
  const char *key;
  void *next;
  json_t *value;
  json_object_foreach_safe(object, next, key, value) if (json_is_object(value)) drop_zeros(value);
  else if (json_is_number(value) && json_number_value(value) == 0) json_object_del(object, key);
}

static void leave(const char *folder, int index)
{
  char path[300];
  struct eo_text text = {0};
  struct eo_error error;
  json_t *document = eo_design_encode(&design);
  drop_zeros(json_object_get(document, "modification"));
  snprintf(path, sizeof path, "%s/pair-%d.json", folder, index);
  char *dump = json_dumps(document, JSON_INDENT(1));
  eo_text_add(&text, dump ? dump : "");
  if (eo_text_save(&text, path, &error))
    printf("# %s\n", error.text);
  free(dump);
  json_decref(document);
  eo_text_done(&text);
}

int main(int argc, char **argv)
{
  int first = argc > 1 ? atoi(argv[1]) : 0, count = argc > 2 ? atoi(argv[2]) : 48, every = argc > 3 ? atoi(argv[3]) : 8;
  bool meshes = every > 0 && system("command -v gmsh >/dev/null 2>&1") == 0;
  for (int index = first; index < first + count; index++) {
    if (!draw_design(index)) /* refused: the sentence is above */
      continue;
    if (getenv("DRAWN"))
      leave(getenv("DRAWN"), index);
    bool folded[2] = {false, false};
    for (int member = 0; member < 2; member++) {
      struct eo_text text = {0};
      eo_step_write(&design, &geometry, member, false, &text);
      double stated = text.failed ? INFINITY : stated_deviation(text.data, &folded[member]);
      ok(stated <= 1e9 * allowed, "pair %d, %s: the file has %zu kB and is at most %.3g nm off%s", index,
         member ? "gear" : "pinion", text.size / 1000, fmax(5, stated), folded[member] ? ", folded by a relief" : "");
      eo_text_done(&text);
      fflush(stdout);
    }
    for (int member = 0; member < 2 && meshes && index % every == 0; member++)
      check_loaded(index, member, folded[member]);
  }
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shaft angle errors in the gap field against brute force: the exact, generated flanks and tip edges of a pair are
   placed in mesh, the gear is rotated as a rigid body (Rodrigues), and one member is turned about its own axis until
   the two touch in the slice. Nothing of the field is used for it. */
#include "support/contact-fixture.h"

static const double degree = M_PI / 180;

/* One end of a pair with a rotated gear. errors: kappa, gamma of the gear's axis in the machine (z to the right), about
   a pivot on that axis. */
struct mesh {
  struct eo_geometry geometry;
  struct eo_modification_shape shape[2];
  struct eo_corner_gap corner[2];
  int end;
  double errors[2], pivot;
};

static void turn(double v[3], double angle)
{
  double x = v[0], y = v[1];
  v[0] = cos(angle) * x - sin(angle) * y;
  v[1] = sin(angle) * x + cos(angle) * y;
}

/* The point u of a member's flank at eta, at the phase c of the pair, before any rotation; in the end's frame (pinion's
   axis at the origin, gear's at y = a, z = eta). */
static void flank_point(const struct mesh *mesh, int member, double u, double eta, double c, double point[3])
{
  const struct eo_geometry *g = &mesh->geometry;
  double v, unused, sign = member == EO_PINION ? 1 : -1,
                    offset = eo_geometry_involute_function(g->working_pressure_angle) -
                             eo_geometry_involute_function(g->transverse_pressure_angle);
  struct eo_surface_point p;
  eo_surface_coordinates(g, member, sign * u / g->rack_factor, eta, &unused, &v);
  for (int i = 0; i < 4; i++) {
    eo_surface_evaluate(g, member, &mesh->shape[member], u, v, &p);
    v += (sign * eta - p.position[2]) / cos(g->helix_angle);
  }
  eo_surface_evaluate(g, member, &mesh->shape[member], u, v, &p);
  for (int i = 0; i < 3; i++)
    point[i] = p.position[i];
  turn(point, -sign * c / g->base_radius[member] - offset);
  for (int i = 0; i < 3; i++)
    point[i] *= sign;
  point[1] += member == EO_GEAR ? g->centre_distance : 0;
}

/* Moves a point of the end's frame as the gear's axis moves (sense 1), or back (-1): rotation about the pivot, then the
   axial shift that the rotation has at the pitch point is taken back, as axial float does. */
static void move(const struct mesh *mesh, int sense, double point[3])
{
  double side = mesh->end == EO_LEFT ? -1 : 1, angle = hypot(mesh->errors[0], mesh->errors[1]),
         shift = side * mesh->errors[0] * mesh->geometry.working_radius[EO_GEAR];
  if (angle == 0)
    return;
  point[2] -= sense < 0 ? shift : 0;
  double k[2] = {sense * mesh->errors[0] / angle, sense * mesh->errors[1] / angle}, c = cos(angle), s = sin(angle);
  double r[3] = {point[0], point[1] - mesh->geometry.centre_distance, side * (point[2] + mesh->pivot)};
  double along = (k[0] * r[0] + k[1] * r[1]) * (1 - c),
         cross[3] = {k[1] * r[2], -k[0] * r[2], k[0] * r[1] - k[1] * r[0]};
  point[0] = r[0] * c + cross[0] * s + k[0] * along;
  point[1] = r[1] * c + cross[1] * s + k[1] * along + mesh->geometry.centre_distance;
  point[2] = side * (r[2] * c + cross[2] * s) - mesh->pivot + (sense > 0 ? shift : 0);
}

/* How far a flank has to turn, as a normal arc of its base circle, until it meets the point: the pinion forwards, the
   gear back. Its own point at the same radius and place is found by the secant method on u. */
static double turn_to(const struct mesh *mesh, int flank, const double point[3], double c)
{
  const struct eo_geometry *g = &mesh->geometry;
  double centre = flank == EO_PINION ? 0 : g->centre_distance, radius = hypot(point[0], point[1] - centre), p[3];
  double nominal = g->rack_factor * eo_geometry_own_path(flank, eo_geometry_path_at(g, flank, radius)), u = nominal,
         before = u + 1e-5, miss[2];
  flank_point(mesh, flank, before, point[2], c, p);
  miss[0] = hypot(p[0], p[1] - centre) - radius;
  for (int i = 0; i < 30; i++) {
    flank_point(mesh, flank, u, point[2], c, p);
    miss[1] = hypot(p[0], p[1] - centre) - radius;
    if (fabs(miss[1]) < 1e-15 || miss[1] == miss[0])
      break;
    double next = u - miss[1] * (u - before) / (miss[1] - miss[0]);
    before = u;
    miss[0] = miss[1];
    u = next;
  }
  if (fabs(miss[1]) > 1e-12 || fabs(u - nominal) > 0.1 * (g->rack_top - g->rack_bottom))
    return INFINITY;
  double angle = atan2(p[1] - centre, p[0]) - atan2(point[1] - centre, point[0]);
  return remainder(angle, 2 * M_PI) * g->base_radius[flank] * cos(g->base_helix_angle);
}

/* The turn that brings the other member's flank to the point u of the slice at eta of `member`, tip included. */
static double turn_at(const struct mesh *mesh, int member, double u, double eta, double c)
{
  double point[3];
  flank_point(mesh, member, u, eta, c, point);
  move(mesh, member == EO_GEAR ? 1 : -1, point);
  return turn_to(mesh, 1 - member, point, c);
}

/* The gap at (s, eta): the least turn over the slice of `member`, tip included, inside the generated part of its flank.
 */
static double brute_gap(const struct mesh *mesh, int member, double s, double eta)
{
  enum { SCAN = 40, STEPS = 40 };
  const struct eo_geometry *g = &mesh->geometry;
  double tip = member == EO_PINION ? g->rack_top : -g->rack_bottom, c = s - eta * tan(g->base_helix_angle);
  double middle = fmin(tip, g->rack_factor * eo_geometry_own_path(member, s)), least = INFINITY, best = tip;
  double root = member == EO_PINION ? g->rack_bottom : -g->rack_top, window = 0.12 * (tip - root),
         low = fmax(root, middle - window), high = fmin(tip, middle + window), ratio = 0.6180339887498949;
  for (int i = 0; i <= SCAN; i++) {
    double at = low + (high - low) * i / SCAN, value = turn_at(mesh, member, at, eta, c);
    best = value < least ? at : best;
    least = fmin(least, value);
  }
  double step = (high - low) / SCAN;
  low = fmax(low, best - step);
  high = fmin(high, best + step);
  for (int i = 0; i < STEPS; i++) {
    double a = high - ratio * (high - low), b = low + ratio * (high - low);
    bool left = turn_at(mesh, member, a, eta, c) < turn_at(mesh, member, b, eta, c);
    low = left ? low : a;
    high = left ? b : high;
  }
  return fmin(least, turn_at(mesh, member, (low + high) / 2, eta, c));
}

static void set_mesh(struct mesh *mesh, const struct eo_geometry *geometry, const struct eo_flank_modification flank[2])
{
  *mesh = (struct mesh){.geometry = *geometry, .end = EO_RIGHT};
  eo_corner_gap_init(mesh->corner, geometry);
  for (int member = 0; member < 2; member++)
    eo_modification_init(&mesh->shape[member], geometry, member, &flank[member]);
}

/* The share of the errors in the gap: of the field [0], by brute force [1]. */
static void set_fields(struct eo_gap_field field[2], const struct mesh *mesh,
                       const struct eo_flank_modification flank[2])
{
  for (int i = 0; i < 2; i++)
    eo_gap_field_init(&field[i], &mesh->geometry, &flank[EO_PINION], &flank[EO_GEAR], mesh->end, i * mesh->errors[0],
                      i * mesh->errors[1], mesh->pivot, mesh->corner);
}

static double brute_share(const struct mesh *mesh, int member, double s, double eta)
{
  struct mesh even = *mesh;
  even.errors[0] = even.errors[1] = 0;
  return brute_gap(mesh, member, s, eta) - brute_gap(&even, member, s, eta);
}

/* Largest departure of the field's share from the rotation's over places at distances from..to from the end of the path
   (side 0: before A, 1: beyond E; < 0 inside the path), at both face ends, um: both ends of a herringbone pair pivoted
   in its groove and about their own mid face (as a single helical pair), both kinds of error. At tip corners the tip's
   member leads, on the path the pinion. What the rotation does to second order at the pitch point is the same
   everywhere and taken off. With relief the field's slice gap is that at the pinion's phase, while here the corner is
   at the phase of its own member; the two differ by the share, the gaps by share times slope, and that much is let
   pass. */
static double departure(struct mesh *mesh, const struct eo_flank_modification flank[2], int side, double from,
                        double to)
{
  enum { STEPS = 4, KINDS = 8 };
  const struct eo_geometry *g = &mesh->geometry;
  int member = from < 0 || side == 1 ? EO_PINION : EO_GEAR;
  double worst = 0, pivot = g->face_width / 2 + 25e-3, angle = 0.1 * degree;
  for (int kind = 0; kind < KINDS; kind++) {
    static struct eo_gap_field field[2];
    mesh->end = kind & 1;
    mesh->errors[0] = kind & 2 ? angle : 0;
    mesh->errors[1] = kind & 2 ? 0 : -angle;
    mesh->pivot = kind & 4 ? pivot : 0;
    set_fields(field, mesh, flank);
    double common = eo_gap_field_at(&field[1], 0, 0, NULL, NULL) - eo_gap_field_at(&field[0], 0, 0, NULL, NULL) -
                    brute_share(mesh, member, 0, 0);
    for (int i = 0; i < 2 * STEPS; i++) {
      double d = from + (to - from) * (i / 2) / (STEPS - 1), s = side ? g->path_end + d : g->path_start - d,
             eta = g->face_width * (i % 2 - 0.5), share = brute_share(mesh, member, s, eta);
      double off = eo_gap_field_at(&field[1], s, eta, NULL, NULL) - eo_gap_field_at(&field[0], s, eta, NULL, NULL) -
                   share - common;
      double slope;
      eo_slice_gap_at(&field[1].slice, s, &slope);
      worst = fmax(worst, fabs(off) - (member == EO_PINION ? 0 : 1.3 * fabs(slope * share) / cos(g->base_helix_angle)));
    }
  }
  return 1e6 * worst;
}

/* The share of 0.1 deg at the gear's tip corner half a millimetre before A on the unmodified paper pair, worked out
   apart from this program by turned points and normals, to first order in the angle: lever from mid face, right end. */
static void test_published(const struct eo_geometry *g)
{
  static const double wanted[2][3] = {{21.5, 3.56, -14.4}, {-49.9, -9.38, 31.2}};
  static const struct eo_flank_modification none[2];
  static struct eo_gap_field field[2];
  static struct mesh mesh;
  set_mesh(&mesh, g, none);
  for (int kind = 0; kind < 2; kind++) {
    mesh.errors[kind] = 0.1 * degree;
    mesh.errors[1 - kind] = 0;
    set_fields(field, &mesh, none);
    for (int i = 0; i < 3; i++) {
      double s = g->path_start - 0.5e-3, eta = 27.5e-3 * (i - 1), even = eo_gap_field_at(&field[0], s, eta, NULL, NULL);
      close_to(1e6 * (eo_gap_field_at(&field[1], s, eta, NULL, NULL) - even), wanted[kind][i], 0.16,
               kind ? "out of plane, um" : "in plane, um");
      close_to(1e6 * even, 5.2, 0.05, "the corner's own gap without the pair's, um");
    }
  }
}

static void test_unmodified(const char *name, const struct eo_geometry *g)
{
  static const struct eo_flank_modification none[2];
  static struct mesh mesh;
  double size = g->normal_module / 6e-3;
  set_mesh(&mesh, g, none);
  for (int side = 0; side < 2; side++) {
    double near = departure(&mesh, none, side, 0, size * 0.5e-3),
           far = departure(&mesh, none, side, size * 0.5e-3, size * 2e-3),
           inside = departure(&mesh, none, side, -5e-3 * size, -1e-3 * size);
    ok(near < 0.12 && far < 0.3 && inside < 0.12,
       "%s, %s: rotation met within %.3f um up to 0.5 mm, %.3f um up to 2 mm, "
       "%.3f um inside the path",
       name, side ? "pinion's tip" : "gear's tip", near, far, inside);
  }
}

static void test_relieved(const char *name, const struct eo_geometry *g, const struct eo_flank_modification flank[2])
{
  static struct mesh mesh;
  double size = g->normal_module / 6e-3;
  set_mesh(&mesh, g, flank);
  for (int side = 0; side < 2; side++) {
    double corner = departure(&mesh, flank, side, 0, size * 1.5e-3),
           inside = departure(&mesh, flank, side, -5e-3 * size, -1e-3 * size);
    ok(corner < 0.4 && inside < 0.15, "%s, %s: rotation met within %.3f um, %.3f um inside the path", name,
       side ? "pinion's tip" : "gear's tip", corner, inside);
  }
}

int main(void)
{
  struct eo_gear_pair paper = paper_pair(), shifted = paper_pair(), fine = paper_pair(), spur = paper_pair();
  struct eo_flank_modification a = case_a(), none = {0},
                               steep = {.shape = EO_RELIEF_LINEAR, .tip_relief = 20e-6, .tip_relief_start = 3e-3};
  struct eo_geometry g[4];
  struct eo_error error;
  a.lead_crowning = 0;
  shifted.profile_shift[EO_PINION] = 0.4;
  shifted.profile_shift[EO_GEAR] = 0.1;
  fine.teeth[EO_PINION] = fine.teeth[EO_GEAR] = 30;
  fine.normal_module = 3e-3;
  fine.helix_angle = 15 * degree;
  fine.face_width = 30e-3;
  spur.helix_angle = 0;
  spur.profile_shift[EO_PINION] = 0.2;
  ok(!eo_geometry_init(&g[0], &paper, &error) && !eo_geometry_init(&g[1], &shifted, &error) &&
         !eo_geometry_init(&g[2], &fine, &error) && !eo_geometry_init(&g[3], &spur, &error),
     "four pairs are made");
  test_published(&g[0]);
  test_unmodified("paper pair", &g[0]);
  test_unmodified("profile shift", &g[1]);
  test_unmodified("30/30 teeth, module 3 mm, 15 deg", &g[2]);
  test_unmodified("spur", &g[3]);
  test_relieved("pinion relieved", &g[0], (struct eo_flank_modification[]){a, none});
  test_relieved("gear relieved", &g[0], (struct eo_flank_modification[]){none, a});
  test_relieved("both relieved, profile shift", &g[1], (struct eo_flank_modification[]){a, a});
  test_relieved("steep tip relief of both", &g[0], (struct eo_flank_modification[]){steep, steep});
  return tap_done();
}

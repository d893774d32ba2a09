/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Macro-geometry, fillet, modification, exact surface and slice gap. Numbers: tests/cases/contact.json (an independent
   computation) and closed forms. */
#include "gear/surface.h"
#include "support/tap.h"

#include <string.h>

static struct eo_gear_pair paper_pair(void)
{
  double degree = M_PI / 180;
  return (struct eo_gear_pair){.ends = 2,
                               .teeth = {17, 44},
                               .normal_module = 6e-3,
                               .normal_pressure_angle = 20 * degree,
                               .helix_angle = 24 * degree,
                               .face_width = 55e-3,
                               .groove_width = 50e-3,
                               .addendum_coefficient = 1,
                               .dedendum_coefficient = 1.25,
                               .fillet_radius_coefficient = 0.38,
                               .centre_distance = NAN,
                               .tip_diameter = {NAN, NAN},
                               .bore = {NAN, NAN},
                               .groove_diameter = {NAN, NAN},
                               .rim_thickness_coefficient = 3.5,
                               .backlash = 100e-6};
}

static struct eo_flank_modification case_a(void)
{
  return (struct eo_flank_modification){.tip_relief = 14e-6,
                                        .root_relief = 17e-6,
                                        .tip_relief_start = 1.6e-3,
                                        .root_relief_start = 3.5e-3,
                                        .lead_crowning = 1.35e-2 * pow(55e-3 / 2 / cos(24 * M_PI / 180), 2)};
}

static void test_geometry(struct eo_geometry *g)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_error error;
  ok(eo_geometry_init(g, &pair, &error) == EO_OK, "the paper's pair is accepted");
  near(g->base_radius[0], 51.861854090581396e-3, 1e-12, "base radius of the pinion, m");
  near(g->base_radius[1], 134.23068117562244e-3, 1e-12, "base radius of the gear, m");
  near(g->centre_distance, 200.3184389666066e-3, 1e-12, "centre distance of the pair, m");
  near(g->path_start, -14.564310930974557e-3, 1e-10, "start of the path of contact s_A, m");
  near(g->path_end, 12.995414714111963e-3, 1e-10, "end of the path of contact s_E, m");
  near(g->transverse_contact_ratio, 1.4377914739258402, 1e-12, "transverse contact ratio of the pair");
  near(g->overlap_ratio, 1.1867927001721548, 1e-12, "overlap ratio of the pair");
  near(g->rack_bottom, -5.736511343236966e-3, 1e-10, "lowest active place on the rack u_A, m");
  near(g->form_radius[0], 52.05260380103431e-3, 1e-10, "fillet form radius of the pinion, m");
  near(g->form_radius[1], 139.30852016026358e-3, 1e-10, "fillet form radius of the gear, m");
  near(eo_geometry_relative_radius(g, -14e-3), 6.562046708016926e-3, 1e-10, "relative radius at s = -14 mm, m");
  near(eo_geometry_depth(g, 0, -14e-3), 5.351898871772353e-3, 1e-10, "depth on the pinion at s = -14 mm, m");
  near(eo_geometry_depth(g, 1, 12e-3), 6.123306138245925e-3, 1e-10, "depth on the gear at s = 12 mm, m");
}

static void test_fillet(const struct eo_geometry *g)
{
  for (int member = 0; member < 2; member++) {
    double p[2], n[2], q[2], m[2];
    eo_geometry_fillet(g, member, 1, p, n);
    eo_geometry_involute(g, member, g->form_radius[member], q, m);
    close_to(hypot(p[0] - q[0], p[1] - q[1]), 0, 1e-12,
             "gap between the end of the trochoid and the start of the involute, m");
    close_to(hypot(n[0] - m[0], n[1] - m[1]), 0, 1e-9, "angle between both where they meet");
    eo_geometry_fillet(g, member, 0, p, n);
    close_to(atan2(p[0], p[1]), M_PI / g->teeth[member], 1e-12, "start of the root, in the middle of the tooth space");
    close_to(hypot(p[0], p[1]), g->root_radius[member], 1e-12,
             "radius of the start of the root, that of the root circle, m");
    double worst = 0, step = 1e-5;
    for (double t = 0.02; t < 0.99; t += 0.02) { /* the normal against the chord of the curve */
      double a[2], b[2], unused[2];
      eo_geometry_fillet(g, member, t, p, n);
      eo_geometry_fillet(g, member, t - step, a, unused);
      eo_geometry_fillet(g, member, t + step, b, unused);
      worst = fmax(worst, fabs((b[0] - a[0]) * n[0] + (b[1] - a[1]) * n[1]) / hypot(b[0] - a[0], b[1] - a[1]));
    }
    close_to(worst, 0, 2e-3, "slope of the normals along the curve");
  }
}

static void test_modification(const struct eo_geometry *g)
{
  static const double expected[][3] = {
      {-14.5, -27.5, 28.850266}, {-14.5, -11, 18.574407}, {-9.5, 20, 6.669158}, {0, 0, 0},
      {5, -27.5, 12.387451},     {12.9, 0, 13.702532},    {12.9, 20, 20.172966}};
  struct eo_flank_modification flank = case_a();
  struct eo_modification_shape shape;
  eo_modification_init(&shape, g, EO_PINION, &flank);
  for (int i = 0; i < 7; i++) {
    double slope[2], lead;
    double value = eo_modification_profile(&shape, g->rack_factor * expected[i][0] * 1e-3, slope) +
                   eo_modification_lead(&shape, expected[i][1] * 1e-3 / cos(g->helix_angle), &lead);
    close_to(1e6 * value, expected[i][2], 1e-6, "delta of case A, um");
  }
  struct eo_flank_modification crowned = {.profile_crowning = 0.2};
  double slopes[2];
  eo_modification_init(&shape, g, EO_PINION, &crowned);
  near(eo_modification_profile(&shape, g->rack_top, slopes), 0.2 * g->rack_top * g->rack_top, 1e-12,
       "profile crowning at the tip of a flank without relief, m");
  near(slopes[0], 0.4 * g->rack_top, 1e-12, "slope of profile crowning at the tip");
  for (int form = 0; form < 3; form++) { /* every shape reaches its depth and has the slope it says */
    flank.shape = (enum eo_relief_shape)form;
    flank.profile_crowning = 0.2;
    eo_modification_init(&shape, g, EO_PINION, &flank);
    double slope[2], unused[2], h = 1e-8, u = 3e-3;
    near(eo_modification_profile(&shape, g->rack_top, slope), flank.tip_relief, 1e-9,
         "tip relief at the end of the active profile, m");
    near(eo_modification_profile(&shape, g->rack_bottom, slope), flank.root_relief, 1e-9,
         "root relief at its start, m");
    eo_modification_profile(&shape, u, slope);
    near(slope[0],
         (eo_modification_profile(&shape, u + h, unused) - eo_modification_profile(&shape, u - h, unused)) / (2 * h),
         1e-6, "slope of the profile against differences");
  }
}

static void test_surface(const struct eo_geometry *g)
{
  static const double rows[][8] = {
      {-5.7, -25, -8.893263736, 51.639400878, -23.621835749, 0.891739086, 0.238024874, -0.384896821},
      {0, -25, -10.118885018, 54.898802917, -22.835411566, 0.782077258, 0.491721484, -0.382838275},
      {5, -25, -13.962893438, 59.997146478, -22.135048013, 0.641427875, 0.665466839, -0.381738349}};
  struct eo_flank_modification flank = case_a();
  struct eo_modification_shape shape;
  eo_modification_init(&shape, g, EO_PINION, &flank);
  for (int i = 0; i < 3; i++) {
    struct eo_surface_point p;
    eo_surface_evaluate(g, EO_PINION, &shape, rows[i][0] * 1e-3, rows[i][1] * 1e-3, &p);
    double distance = 0, turn = 0;
    for (int k = 0; k < 3; k++) {
      distance = fmax(distance, fabs(1e3 * p.position[k] - rows[i][2 + k]));
      turn = fmax(turn, fabs(p.normal[k] - rows[i][5 + k]));
    }
    close_to(distance, 0, 1e-8, "distance of the surface point of case A, mm");
    close_to(turn, 0, 1e-8, "angle of the surface normal of case A");
  }
}

static void test_slice_gap(const struct eo_geometry *g)
{
  static const double c[] = {-14.5, -13.5, -12, -10, -8, 0, 4, 6, 9, 12, 12.9};
  static const double expected[] = {13.7485, 9.3387, 4.2896, 0.5552, 0, 0, 0, 0.6449, 4.2157, 10.9683, 13.6243};
  struct eo_flank_modification flank = case_a(), none = {0};
  struct eo_modification_shape shape[2];
  struct eo_slice_gap table;
  flank.lead_crowning = 0;
  eo_modification_init(&shape[0], g, EO_PINION, &flank);
  eo_modification_init(&shape[1], g, EO_GEAR, &none);
  eo_slice_gap_init(&table, g, shape);
  for (int i = 0; i < 11; i++) {
    double slope, h = 1e-7;
    close_to(1e6 * eo_slice_gap_at(&table, c[i] * 1e-3, &slope), expected[i], 1.5e-4, "slice gap of case A, um");
    double rate = (eo_slice_gap_at(&table, c[i] * 1e-3 + h, NULL) - eo_slice_gap_at(&table, c[i] * 1e-3 - h, NULL)) /
                  (2 * h);
    close_to(slope, rate, 1e-6, "slope of the slice gap against differences");
  }
  /* The mirrored pair: the same relief on the gear of an equal pair gives the mirrored gap. */
  struct eo_gear_pair pair = paper_pair();
  struct eo_geometry equal;
  struct eo_slice_gap other;
  pair.teeth[0] = pair.teeth[1] = 30;
  ok(eo_geometry_init(&equal, &pair, NULL) == EO_OK, "a pair of equal members is made");
  eo_modification_init(&shape[0], &equal, EO_PINION, &flank);
  eo_modification_init(&shape[1], &equal, EO_GEAR, &none);
  eo_slice_gap_init(&table, &equal, shape);
  eo_modification_init(&shape[0], &equal, EO_PINION, &none);
  eo_modification_init(&shape[1], &equal, EO_GEAR, &flank);
  eo_slice_gap_init(&other, &equal, shape);
  for (double x = -13e-3; x < 13.5e-3;
       x += 3e-3) { /* there c is the phase of the unmodified member: less by the gap itself */
    double gap = eo_slice_gap_at(&table, x, NULL), shifted = x - gap / cos(equal.base_helix_angle);
    close_to(1e6 * eo_slice_gap_at(&other, -shifted, NULL), 1e6 * gap, 1e-4,
             "relief on the gear against relief on the pinion, mirrored, um");
  }
}

enum { FINE = 4000 };

struct curve {
  double radius[FINE + 1], angle[FINE + 1];
};

/* A member's slice at its own phase, polar about the gear's centre; angles grow in the sense in which the gear turns
   back. */
static void trace(struct curve *curve, const struct eo_geometry *g, int member,
                  const struct eo_modification_shape *shape, double own_phase)
{
  double offset = eo_geometry_involute_function(g->working_pressure_angle) -
                  eo_geometry_involute_function(g->transverse_pressure_angle);
  double turn = -own_phase / g->base_radius[member] - offset;
  for (int i = 0; i <= FINE; i++) {
    double u = g->rack_bottom + (g->rack_top - g->rack_bottom) * i / FINE;
    struct eo_slice_point p;
    eo_slice_point_at(g, member, shape, member == EO_PINION ? u : -u, &p);
    double x = cos(turn) * p.position[0] - sin(turn) * p.position[1],
           y = sin(turn) * p.position[0] + cos(turn) * p.position[1];
    curve->radius[i] = member == EO_PINION ? hypot(x, g->centre_distance - y) : hypot(x, y);
    curve->angle[i] = member == EO_PINION ? atan2(x, g->centre_distance - y) : atan2(-x, y);
  }
}

/* Smallest angle between gear and pinion at equal radius, as an arc of the base circle, normal. Both radii fall along
   the curves. */
static double turn_until_touch(const struct eo_geometry *g, const struct eo_modification_shape shape[2], double c)
{
  static struct curve pinion, gear;
  double smallest = INFINITY;
  trace(&pinion, g, EO_PINION, &shape[EO_PINION], c);
  trace(&gear, g, EO_GEAR, &shape[EO_GEAR], -c);
  for (int i = 0; i <= FINE; i++)
    for (int j = i > 400 ? i - 400 : 0; j < FINE && j < i + 400; j++) {
      double r = gear.radius[i], a = pinion.radius[j], b = pinion.radius[j + 1];
      if ((a - r) * (b - r) <= 0 && a != b)
        smallest = fmin(smallest,
                        gear.angle[i] - pinion.angle[j] - (pinion.angle[j + 1] - pinion.angle[j]) * (r - a) / (b - a));
    }
  return smallest * g->base_radius[EO_GEAR] * cos(g->base_helix_angle);
}

/* Reliefs of every form on either member, on both, overlapping and steep; away from the ends, where a tip may touch
   first. */
static void test_slice_gap_by_turning(const struct eo_geometry *g)
{
  static const struct eo_flank_modification flank[] = {
      {0},
      {.tip_relief = 14e-6, .root_relief = 17e-6, .tip_relief_start = 1.6e-3, .root_relief_start = 3.5e-3},
      {.shape = EO_RELIEF_LINEAR,
       .tip_relief = 30e-6,
       .root_relief = 20e-6,
       .tip_relief_start = 2e-3,
       .root_relief_start = 2.5e-3},
      {.shape = EO_RELIEF_LINEAR,
       .tip_relief = 40e-6,
       .root_relief = 25e-6,
       .tip_relief_start = 0.1e-3,
       .root_relief_start = 0.004e-3,
       .profile_crowning = 0.05},
      {.shape = EO_RELIEF_CIRCULAR,
       .tip_relief = 15e-6,
       .root_relief = 25e-6,
       .tip_relief_start = 0,
       .root_relief_start = 0,
       .profile_crowning = 0.2},
  };
  enum { FORMS = sizeof flank / sizeof *flank };
  for (int k = 1; k < FORMS * FORMS; k++) {
    struct eo_modification_shape shape[2];
    struct eo_slice_gap table;
    double worst = 0;
    for (int member = 0; member < 2; member++)
      eo_modification_init(&shape[member], g, member, &flank[member ? k / FORMS : k % FORMS]);
    eo_slice_gap_init(&table, g, shape);
    for (int i = 1; i < 7; i++) {
      double c = g->path_start + (g->path_end - g->path_start) * (i - 0.5) / 7;
      worst = fmax(worst, fabs(eo_slice_gap_at(&table, c, NULL) - turn_until_touch(g, shape, c)));
    }
    /* Where vertices of both members meet, the piece between two nodes is a little too wide for them. */
    bool vertices = shape[0].side[0].shape == EO_RELIEF_LINEAR && shape[1].side[0].shape == EO_RELIEF_LINEAR;
    close_to(1e6 * worst, 0, vertices ? 0.03 : 5e-4, "slice gap against turned slices, um");
  }
}

static void refused(struct eo_gear_pair pair, const char *pointer)
{
  struct eo_geometry g;
  struct eo_error error = {0};
  ok(eo_geometry_init(&g, &pair, &error) == EO_ERROR_INPUT && !strcmp(error.pointer, pointer),
     "the pair is refused: %s: %s", error.pointer, error.text);
}

static void test_refusals(void)
{
  struct eo_gear_pair pair = paper_pair();
  pair.teeth[0] = 9;
  refused(pair, "/gear_pair/pinion_profile_shift");
  pair = paper_pair();
  pair.teeth[0] = 12;
  pair.profile_shift[0] = 1.0;
  pair.profile_shift[1] = -0.2;
  pair.addendum_coefficient = 1.15;
  pair.dedendum_coefficient = 1.4;
  refused(pair, "/gear_pair/pinion_profile_shift");
  pair = paper_pair();
  pair.backlash = 0;
  refused(pair, "/gear_pair/backlash_um");
  pair = paper_pair();
  pair.centre_distance = 0.2;
  refused(pair, "/gear_pair/centre_distance_mm");
  pair = paper_pair();
  pair.face_width = 1e-6;
  pair.addendum_coefficient = 0.3;
  refused(pair, "/gear_pair/face_width_mm");
  pair = paper_pair();
  pair.addendum_coefficient = 1.24;
  refused(pair, "/gear_pair/addendum_coefficient");
  pair = paper_pair();
  pair.fillet_radius_coefficient = 0.6;
  refused(pair, "/gear_pair/fillet_radius_coefficient");
}

int main(void)
{
  struct eo_geometry geometry;
  test_geometry(&geometry);
  test_fillet(&geometry);
  test_modification(&geometry);
  test_surface(&geometry);
  test_slice_gap(&geometry);
  test_slice_gap_by_turning(&geometry);
  test_refusals();
  return tap_done();
}

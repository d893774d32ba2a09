/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gap field: its sum, its ends, its tip corners and its smallest values. */
#include "support/contact-fixture.h"

static const double degree = M_PI / 180;

struct pair {
  struct eo_geometry geometry;
  struct eo_corner_gap corner[2];
};

static void make_pair(struct pair *pair, const struct eo_gear_pair *gears)
{
  struct eo_error error;
  ok(eo_geometry_init(&pair->geometry, gears, &error) == EO_OK, "a pair with %d/%d teeth is made", gears->teeth[0],
     gears->teeth[1]);
  eo_corner_gap_init(pair->corner, &pair->geometry);
}

/* D = end (gamma cos(alpha) - kappa sin(alpha)) (cos(beta_b) (eta + pivot) + sin(beta_b) s), end = -1 left. */
static double misalignment(const struct eo_geometry *g, int end, double kappa, double gamma, double s, double eta,
                           double pivot)
{
  double lean = eta + pivot + s * tan(g->base_helix_angle);
  return (end == EO_LEFT ? -1 : 1) * cos(g->base_helix_angle) *
         (gamma * cos(g->working_pressure_angle) - kappa * sin(g->working_pressure_angle)) * lean;
}

/* Over the part of the path that no corner reaches. */
static void test_sum(const struct pair *pair)
{
  const struct eo_geometry *g = &pair->geometry;
  struct eo_flank_modification lead = {.lead_crowning = case_a().lead_crowning}, flank[2][2] = {{lead, {0}}};
  struct eo_gap_field field;
  double kappa = 0.1 * degree, gamma = -0.03 * degree, pivot = 52.5e-3, worst[2] = {0, 0}, most = 0;
  flank[1][EO_PINION] = case_a();
  flank[1][EO_GEAR] = random_modification(g, 1, 0);
  for (int k = 0; k < 4; k++) {
    int end = k % 2, relieved = k / 2;
    eo_gap_field_init(&field, g, &flank[relieved][EO_PINION], &flank[relieved][EO_GEAR], end, kappa, gamma, pivot,
                      pair->corner);
    for (int i = 0; i < 200; i++) {
      double s = random_between(i, 0, g->path_start + 0.4e-3, g->path_end - 0.4e-3),
             eta = random_between(i, 1, -27.5e-3, 27.5e-3), x = eta / cos(g->helix_angle), unused;
      double rest = eo_slice_gap_at(&field.slice, s, NULL) + 1.35e-2 * x * x +
                    eo_modification_lead(&field.shape[EO_GEAR], x, &unused),
             share = misalignment(g, end, kappa, gamma, s, eta, pivot),
             off = fabs(eo_gap_field_at(&field, s, eta, NULL, NULL) - rest - share);
      worst[relieved] = fmax(worst[relieved], off);
      most = fmax(most, fabs(share));
    }
  }
  close_to(worst[0], 0, 1e-16, "the gap less the sum of profile, lead and misalignment");
  ok(worst[1] > 0.05e-6 && worst[1] < 0.02 * most,
     "relief turns the common normal: misalignment's share changes by up to %.2f of %.0f um", 1e6 * worst[1],
     1e6 * most);
}

static void test_mirror(const struct pair *pair)
{
  const struct eo_geometry *g = &pair->geometry;
  struct eo_flank_modification pinion = random_modification(g, 2, 0), gear = random_modification(g, 2, 20);
  struct eo_gap_field left, right;
  bool same = true;
  eo_gap_field_init(&left, g, &pinion, &gear, EO_LEFT, 0.07 * degree, 0.02 * degree, 40e-3, pair->corner);
  eo_gap_field_init(&right, g, &pinion, &gear, EO_RIGHT, -0.07 * degree, -0.02 * degree, 40e-3, pair->corner);
  for (int i = 0; i < 200; i++) {
    double s = random_between(i, 0, g->path_start - 2e-3, g->path_end + 2e-3),
           eta = random_between(i, 1, -27.5e-3, 27.5e-3);
    same = same && eo_gap_field_at(&left, s, eta, NULL, NULL) == eo_gap_field_at(&right, s, eta, NULL, NULL);
  }
  ok(same, "the left end under the opposite shaft angles is the right end, to the last bit");
}

/* The corner gap of the unmodified pair against tests/cases/contact.json, block impact. */
static void test_corner(const struct pair *pair)
{
  static const double before[] = {0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3},
                      expected[] = {1.31077, 5.19583, 20.51085, 80.834, 320.42324};
  const struct eo_geometry *g = &pair->geometry;
  struct eo_flank_modification none = {0};
  struct eo_gap_field field;
  eo_gap_field_init(&field, g, &none, &none, EO_RIGHT, 0, 0, 0, pair->corner);
  for (int i = 0; i < 5; i++) {
    double path[2];
    close_to(1e6 * eo_gap_field_at(&field, g->path_start - before[i], 0, NULL, path), expected[i], 1e-3,
             "corner gap before A, um");
    ok(path[EO_GEAR] == g->path_start && path[EO_PINION] > g->path_start, "the gear's tip on the pinion's flank");
  }
}

/* ---- relieved flanks beyond the path of contact, by turning the pinion's slice until it touches the gear's, tip
   corner included ---- */

enum { OUTLINE = 6000 };

struct outline {
  double radius[OUTLINE + 1], angle[OUTLINE + 1];
};

/* Polar about the pinion's centre at pinion phase c, root of the pinion (tip of the gear) first. */
static void trace(struct outline *o, const struct eo_gap_field *field, int member, double c)
{
  const struct eo_geometry *g = field->geometry;
  double offset = eo_geometry_involute_function(g->working_pressure_angle) -
                  eo_geometry_involute_function(g->transverse_pressure_angle);
  double turn = -eo_geometry_own_path(member, c) / g->base_radius[member] - offset,
         low = member == EO_PINION ? 1.2 * g->rack_bottom : g->rack_bottom;
  for (int i = 0; i <= OUTLINE; i++) {
    double u = low + (g->rack_top - low) * i / OUTLINE;
    struct eo_slice_point p;
    eo_slice_point_at(g, member, &field->shape[member], member == EO_PINION ? u : -u, &p);
    double x = cos(turn) * p.position[0] - sin(turn) * p.position[1],
           y = sin(turn) * p.position[0] + cos(turn) * p.position[1];
    o->radius[i] = member == EO_PINION ? hypot(x, y) : hypot(x, g->centre_distance - y);
    o->angle[i] = member == EO_PINION ? atan2(y, x) : atan2(g->centre_distance - y, -x);
  }
}

static double turn_pinion(const struct eo_gap_field *field, double c)
{
  static struct outline pinion, gear;
  const struct eo_geometry *g = field->geometry;
  double least = INFINITY;
  trace(&pinion, field, EO_PINION, c);
  trace(&gear, field, EO_GEAR, c);
  for (int i = 0; i <= OUTLINE; i++) {
    int low = 0, high = OUTLINE;
    if (gear.radius[i] < pinion.radius[low] || gear.radius[i] > pinion.radius[high])
      continue;
    while (high - low > 1) {
      int middle = (low + high) / 2;
      *(pinion.radius[middle] <= gear.radius[i] ? &low : &high) = middle;
    }
    double t = (gear.radius[i] - pinion.radius[low]) / (pinion.radius[high] - pinion.radius[low]);
    least = fmin(least, pinion.angle[low] + t * (pinion.angle[high] - pinion.angle[low]) - gear.angle[i]);
  }
  return least * g->base_radius[EO_PINION] * cos(g->base_helix_angle);
}

/* To the last hundredths: the slice gap turns the gear, and the corner's gap is joined to it. */
static void test_relieved_corner(const struct pair *pair)
{
  const struct eo_geometry *g = &pair->geometry;
  struct eo_flank_modification none = {0}, a = case_a(),
                               strong = {.root_relief = 40e-6,
                                         .root_relief_start = 2e-3,
                                         .tip_relief = 30e-6,
                                         .tip_relief_start = 1e-3};
  const struct eo_flank_modification *flank[][2] = {{&none, &none}, {&a, &none},      {&none, &a},
                                                    {&a, &a},       {&strong, &none}, {&strong, &strong}};
  a.lead_crowning = 0;
  for (int k = 0; k < 6; k++) {
    struct eo_gap_field field;
    double worst = 0;
    eo_gap_field_init(&field, g, flank[k][0], flank[k][1], EO_RIGHT, 0, 0, 0, pair->corner);
    for (double d = 0.1e-3; d < 1.5e-3; d += 0.1e-3) {
      double exact = turn_pinion(&field, g->path_start - d);
      worst = fmax(worst, fabs(eo_gap_field_at(&field, g->path_start - d, 0, NULL, NULL) - exact) / exact);
    }
    ok(worst < (k ? 0.015 : 1e-4),
       "the gear tip before A lies where a turned pinion has it, reliefs %d, within %.2f %%", k, 100 * worst);
    ok(k == 0 ? field.corner[0].start == 0 : field.corner[0].start > 0, "the corner takes over %.3f mm before A",
       1e3 * field.corner[0].start);
  }
}

/* The two places beyond an end of the path where a corner's gap takes over from the slices at eta, as the field has it.
 */
static double takes_over(const struct eo_gap_field *field, int side, double eta)
{
  const struct eo_geometry *g = field->geometry;
  double z = eta + field->pivot, low = field->takes_over[side], high = 0.9 * field->corner[side].reach, slope;
  for (int i = 0; i < 60; i++) {
    double middle = (low + high) / 2;
    *(eo_corner_gap_at(&field->corner[side], &field->tilted[side], middle, z, &slope) > 0 ? &high : &low) = middle;
  }
  return side == 0 ? g->path_start - high : g->path_end + high;
}

/* Both sides of the ends of the path and of where the corner takes over, and slopes everywhere against differences. */
static void test_continuity(const struct pair *pair)
{
  const struct eo_geometry *g = &pair->geometry;
  double jump = 0, kink = 0, off = 0;
  for (int index = 0; index < 20; index++) {
    struct eo_flank_modification pinion = random_modification(g, index, 0), gear = random_modification(g, index, 20),
                                 none = {0};
    struct eo_gap_field field;
    eo_gap_field_init(&field, g, index == 0 ? &none : &pinion, index % 2 ? &gear : &none, index % 2,
                      random_between(index, 40, -2e-3, 2e-3), random_between(index, 41, -2e-3, 2e-3), 52.5e-3,
                      pair->corner);
    for (int k = 0; k < 4; k++) {
      int side = k % 2;
      double eta = 10e-3, s = k < 2 ? (side ? g->path_end : g->path_start) : takes_over(&field, side, eta), h = 1e-10,
             gap[2], slope[2];
      for (int i = 0; i < 2; i++)
        gap[i] = eo_gap_field_at(&field, i ? s + h : s - h, eta, &slope[i], NULL);
      jump = fmax(jump, fabs(gap[1] - gap[0] - h * (slope[0] + slope[1])));
      kink = k < 2 ? kink : fmax(kink, fabs(slope[1] - slope[0]));
    }
    for (int i = 0; i < 60; i++) {
      double s = random_between(index, 50 + i, g->path_start - 2e-3, g->path_end + 2e-3), h = 1e-8, slope;
      double rate =
          (eo_gap_field_at(&field, s + h, 5e-3, NULL, NULL) - eo_gap_field_at(&field, s - h, 5e-3, NULL, NULL)) /
          (2 * h);
      eo_gap_field_at(&field, s, 5e-3, &slope, NULL);
      off = fmax(off, fabs(slope - rate));
    }
  }
  ok(jump < 1e-13, "no step at the ends of the path and where the corner takes over: %.1e um", 1e6 * jump);
  ok(kink < 2e-5, "no kink where the corner takes over: %.1e", kink);
  ok(off < 2e-6, "slopes are derivatives, off the path too: %.1e", off);
}

static void test_line_minimum(const struct pair *pair)
{
  enum { FINE = 4000 };
  const struct eo_geometry *g = &pair->geometry;
  double tangent = tan(g->base_helix_angle), worst = 0, lower = 0;
  for (int index = 0; index < 40; index++) {
    struct eo_flank_modification pinion = random_modification(g, index, 0), none = {0};
    struct eo_gap_field field;
    bool edges = index % 2;
    double c = random_between(index, 60, g->path_start - 20e-3, g->path_end + 20e-3), brute = INFINITY, at = NAN;
    double reach = edges ? pair->corner[0].reach / 2 : 0;
    eo_gap_field_init(&field, g, &pinion, &none, EO_RIGHT, random_between(index, 61, -2e-3, 2e-3), 0, 52.5e-3,
                      pair->corner);
    for (int i = 0; i <= FINE; i++) {
      double eta = g->face_width * ((double)i / FINE - 0.5), s = c + eta * tangent;
      if (s >= g->path_start - reach && s <= g->path_end + reach)
        brute = fmin(brute, eo_gap_field_at(&field, s, eta, NULL, NULL));
    }
    double found = eo_gap_field_line_minimum(&field, c, edges, &at);
    if (isinf(brute) || isinf(found))
      continue; /* the line barely touches the corner of the flank, or misses it */
    worst = fmax(worst, found - brute);
    lower = fmin(lower, found - brute);
    ok(fabs(eo_gap_field_at(&field, c + at * tangent, at, NULL, NULL) - found) < 1e-15,
       "the minimum is where it is said to be");
  }
  ok(worst < 2e-9, "smallest gap of a line: at most %.3f nm above a fine scan", 1e9 * worst);
  ok(lower > -30e-9, "the minimum is at most %.1f nm below a fine scan", -1e9 * lower);
  struct eo_flank_modification none = {0};
  struct eo_gap_field field;
  eo_gap_field_init(&field, g, &none, &none, EO_RIGHT, 0, 0, 0, pair->corner);
  ok(isinf(eo_gap_field_line_minimum(&field, g->path_end + 30e-3, true, NULL)),
     "a line that misses the flank has no gap");
}

static void test_datum(const struct pair *pair)
{
  enum { FINE = 900 };
  const struct eo_geometry *g = &pair->geometry;
  double worst = 0;
  for (int index = 0; index < 6; index++) {
    struct eo_flank_modification pinion = random_modification(g, index, 0), none = {0};
    struct eo_gap_field field;
    double brute = INFINITY;
    eo_gap_field_init(&field, g, &pinion, &none, EO_LEFT, random_between(index, 61, -2e-3, 2e-3), 0, 52.5e-3,
                      pair->corner);
    for (int i = 0; i <= FINE; i++)
      for (int j = 0; j <= FINE; j++)
        brute = fmin(brute, eo_gap_field_at(&field, g->path_start + (g->path_end - g->path_start) * i / FINE,
                                            g->face_width * ((double)j / FINE - 0.5), NULL, NULL));
    worst = fmax(worst, fabs(eo_gap_field_datum(&field) - brute));
  }
  ok(worst < 10e-9, "datum: the smallest gap of the flank, %.3f nm from a fine scan", 1e9 * worst);
}

static void test_range(const struct pair *pair)
{
  const struct eo_geometry *g = &pair->geometry;
  double range[2], half = g->face_width / 2, lean = tan(g->base_helix_angle);
  ok(eo_gap_field_line_range(g, 0, g->path_start, g->path_end, range) && range[0] == -half && range[1] == half,
     "a line in the middle crosses the whole face");
  ok(eo_gap_field_line_range(g, -20e-3, g->path_start, g->path_end, range), "an incoming line crosses a part of it");
  close_to(-20e-3 + range[0] * lean, g->path_start, 1e-15, "an incoming line begins at the start of the path");
  close_to(range[1], half, 0, "an incoming line goes to the face end");
  ok(!eo_gap_field_line_range(g, g->path_start - half * lean - 1e-6, g->path_start, g->path_end, range),
     "a line that has not come in crosses nothing");
  struct eo_gear_pair spur = paper_pair();
  struct eo_geometry straight;
  struct eo_error error;
  spur.helix_angle = 0;
  spur.teeth[0] = 25;
  ok(eo_geometry_init(&straight, &spur, &error) == EO_OK, "a spur pair is made");
  ok(eo_gap_field_line_range(&straight, 1e-3, straight.path_start, straight.path_end, range) &&
         range[1] - range[0] == straight.face_width,
     "a line of a spur pair crosses the whole face");
  ok(!eo_gap_field_line_range(&straight, straight.path_end + 1e-9, straight.path_start, straight.path_end, range),
     "a line of a spur pair beyond the path crosses nothing");
}

int main(void)
{
  struct eo_gear_pair gears = paper_pair(), shifted = paper_pair();
  struct pair pair, other;
  make_pair(&pair, &gears);
  shifted.profile_shift[0] = 0.4;
  shifted.profile_shift[1] = 0.2;
  make_pair(&other, &shifted);
  test_sum(&pair);
  test_mirror(&pair);
  test_corner(&pair);
  test_relieved_corner(&pair);
  test_continuity(&pair);
  test_continuity(&other);
  test_line_minimum(&pair);
  test_line_minimum(&other);
  test_datum(&pair);
  test_range(&pair);
  return tap_done();
}

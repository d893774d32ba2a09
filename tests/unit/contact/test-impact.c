/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The entering impact: against tests/cases/contact.json (block impact), the half sine's closed form, and what may and
   may not move it. */
#include "support/contact-fixture.h"
#include "contact/impact.h"

enum { POSITIONS = 8 };

static struct eo_closed_form form;
static struct eo_contact_grid *grid;
static struct eo_gap_field field;
static const double rpm = 2 * M_PI / 60;

static void make_grid(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_material steel = paper_steel();
  struct eo_contact_grid_settings settings = {
      .positions = POSITIONS, .cells = 4, .tip_edges = true, .edge_cells = 2, .edge_reach = NAN};
  struct eo_geometry g;
  struct eo_error error;
  form = paper_form();
  ok(eo_geometry_init(&g, &pair, &error) == EO_OK &&
         eo_contact_grid_new(&grid, &g, &steel, &settings, NULL, (struct eo_kernel){eo_closed_form_kernel, &form}, NULL,
                             &error) == EO_OK,
     "the paper's pair has a contact grid");
}

/* Impact of a constant approach on the field as it is. */
static struct eo_impact strike_field(double approach, double speed, double patch, int stations)
{
  double z[POSITIONS];
  struct eo_impact_settings settings = {.patch = patch, .stations = stations};
  struct eo_impact impact;
  for (int j = 0; j < POSITIONS; j++)
    z[j] = approach;
  eo_impact_inertia(&grid->geometry, &grid->material, settings.inertia);
  eo_impact_find(&impact, grid, &field, (struct eo_kernel){eo_closed_form_kernel, &form}, &settings, z, speed, 1);
  return impact;
}

/* The same at the right end of the aligned pair. */
static struct eo_impact strike(const struct eo_flank_modification *pinion, const struct eo_flank_modification *gear,
                               double approach, double speed, double patch, int stations)
{
  eo_gap_field_init(&field, &grid->geometry, pinion, gear, EO_RIGHT, 0, 0, 0, grid->corner);
  return strike_field(approach, speed, patch, stations);
}

static const struct eo_flank_modification none;

static void test_reference(void)
{
  struct eo_impact i = strike(&none, &none, 7e-6, 2000 * rpm, 5e-3, 0);
  ok(i.touched && i.off_line, "the unmodified pair is struck before the path of contact");
  close_to(1e3 * i.phase, -26.51968, 0.02, "phase of the first touch, mm");
  close_to(1e3 * i.eta, 27.5, 1e-3, "place of the first touch: at the face end that meets first, mm");
  close_to(1e3 * i.pinion_radius, 52.44873, 5e-3, "radius of the first touch on the pinion, mm");
  near(1e3 * i.speed, 259.4021, 0.005, "closing speed of the first touch, mm/s");
  close_to(i.start, i.phase / grid->geometry.transverse_base_pitch + 2, 1e-12, "start of the pulse in the cycle");
  double inertia[2];
  eo_impact_inertia(&grid->geometry, &grid->material, inertia);
  near(inertia[EO_PINION], M_PI / 2 * 7850 * 55e-3 * pow(55.82645e-3, 4), 1e-6,
       "inertia of one end of the pinion, kg m2");
  near(eo_impact_mass(&grid->geometry, (double[2]){6.587e-3, 0.2956}) * pow(cos(grid->geometry.base_helix_angle), 2),
       1 / (51.861854e-3 * 51.861854e-3 / 6.587e-3 + 134.230681e-3 * 134.230681e-3 / 0.2956), 1e-6,
       "effective mass of both discs at their base circles");
}

/* F = v sqrt(m/q), T = pi sqrt(m q): the pulse turns the closing speed round, 2 F T / pi = 2 m v, and stores its
   energy, F^2 q = m v^2. */
static void test_half_sine(void)
{
  double inertia[2];
  eo_impact_inertia(&grid->geometry, &grid->material, inertia);
  double mass = eo_impact_mass(&grid->geometry, inertia);
  for (double patch = 2e-3; patch < 30e-3; patch *= 3) {
    struct eo_impact i = strike(&none, &none, 7e-6, 2000 * rpm, patch, 0);
    near(2 / M_PI * i.force * i.duration, 2 * mass * i.speed, 1e-10, "impulse of the half sine against twice m v");
    near(i.force * i.force * i.compliance, mass * i.speed * i.speed, 1e-10,
         "energy of the spring against that of the mass");
    /* Its compliance: bulk as a mean over the patch, Hertz at the force's own line load. */
    double length = patch / cos(grid->geometry.base_helix_angle),
           law = eo_contact_local_constant(&grid->geometry, &grid->material, grid->geometry.path_start);
    double bulk = i.compliance - grid->compliance_scale / length * (law - log(i.force / length));
    struct eo_flank_point p[2] = {{0, {grid->geometry.path_start, grid->geometry.path_start}, 0},
                                  {0, {grid->geometry.path_start, grid->geometry.path_start}, patch}};
    double c[4];
    eo_closed_form_kernel(&form, 2, p, c);
    ok(bulk < c[0] && bulk > c[1], "bulk compliance of %.0f mm between that of a point and that across the patch",
       1e3 * patch);
  }
  struct eo_impact shorter = strike(&none, &none, 7e-6, 2000 * rpm, 2e-3, 0),
                   longer = strike(&none, &none, 7e-6, 2000 * rpm, 20e-3, 0);
  ok(longer.force > 1.2 * shorter.force, "a longer patch is stiffer: %.0f N against %.0f N", longer.force,
     shorter.force);
}

static void test_speed(void)
{
  struct eo_impact slow = strike(&none, &none, 7e-6, 500 * rpm, 5e-3, 0),
                   fast = strike(&none, &none, 7e-6, 2000 * rpm, 5e-3, 0);
  near(fast.speed, 4 * slow.speed, 1e-12, "closing speed over that at half the running speed");
  ok(fast.force > 4 * slow.force && fast.force < 4.5 * slow.force,
     "the force grows a little more than the speed, as the Hertz contact stiffens (%.3f)", fast.force / slow.force);
  ok(fast.phase == slow.phase, "the place of the touch does not depend on the speed");
}

/* Only what lies where the gear's tip strikes: root relief of the pinion, tip relief of the gear, lead at the face end.
 */
static void test_what_moves_it(void)
{
  struct eo_flank_modification tip = {.tip_relief = 20e-6, .tip_relief_start = 1e-3},
                               root = {.root_relief = 17e-6, .root_relief_start = 3.5e-3};
  struct eo_flank_modification middle = {.end_relief = {10e-6, 0}, .end_relief_length = {10e-3, 0}};
  double speed = 2000 * rpm;
  struct eo_impact plain = strike(&none, &none, 7e-6, speed, 5e-3, 0);
  struct eo_impact by_tip = strike(&tip, &none, 7e-6, speed, 5e-3, 0),
                   by_gear_root = strike(&none, &root, 7e-6, speed, 5e-3, 0);
  struct eo_impact by_far_end = strike(&middle, &none, 7e-6, speed, 5e-3, 0);
  near(by_tip.force, plain.force, 1e-5, "force under tip relief of the pinion, which does not move it, N");
  near(by_gear_root.force, plain.force, 1e-5, "force under root relief of the gear, which does not move it, N");
  near(by_far_end.force, plain.force, 1e-12, "force under relief of the far face end, which does not move it, N");
  double last = plain.force;
  for (double depth = 1.5e-6; depth < 7e-6; depth += 1.5e-6) { /* while it is less than the approach */
    root.root_relief = depth;
    struct eo_impact i = strike(&root, &none, 7e-6, speed, 5e-3, 0);
    ok(i.force < last && i.off_line, "root relief of %.1f um softens the impact to %.0f N", 1e6 * depth, i.force);
    last = i.force;
  }
  /* Beyond, the relieved flank itself meets the gear, at the slope 2 sqrt(Z depth) / length where the relief equals the
     approach. */
  for (double depth = 10e-6; depth < 20e-6; depth += 4e-6) {
    root.root_relief = depth;
    struct eo_impact i = strike(&root, &none, 7e-6, speed, 5e-3, 0);
    double slope = 2 * sqrt(7e-6 * depth) / (-grid->geometry.rack_bottom - 3.5e-3) * grid->geometry.rack_factor;
    ok(!i.off_line && i.classical == 0, "root relief of %.0f um leaves no classical impact", 1e6 * depth);
    near(i.speed, slope * speed * grid->geometry.base_radius[EO_PINION], 0.15,
         "general speed from the slope of the parabola, m/s");
  }
  tip = (struct eo_flank_modification){.tip_relief = 17e-6, .tip_relief_start = 3.5e-3};
  struct eo_impact by_gear_tip = strike(&none, &tip, 7e-6, speed, 5e-3, 0);
  ok(by_gear_tip.force < 0.2 * plain.force, "tip relief of the gear softens the impact to %.0f N", by_gear_tip.force);
}

/* Largest relative step of the force and step of the place while the approach grows from one on the path of contact to
   one before it. */
static void sweep_approach(int steps, double *force, double *path, int *changes)
{
  struct eo_flank_modification root = {.root_relief = 17e-6, .root_relief_start = 3.5e-3};
  struct eo_impact last = {0};
  *force = *path = *changes = 0;
  for (int i = 0; i <= steps; i++) {
    struct eo_impact now = strike(&root, &none, 6e-6 + 24e-6 * i / steps, 2000 * rpm, 5e-3, 0);
    if (i > 0) {
      *force = fmax(*force, fabs(now.force - last.force) / last.force);
      *path = fmax(*path, fabs(now.path - last.path));
      *changes += now.off_line != last.off_line;
    }
    last = now;
  }
}

static void test_continuity(void)
{
  double coarse, fine, path;
  int changes;
  sweep_approach(250, &coarse, &path, &changes);
  sweep_approach(2000, &fine, &path, &changes);
  ok(changes == 1, "a deeper approach brings the touch before the path of contact");
  ok(fine < 0.03 && fine < coarse / 5,
     "nothing jumps: the force changes in steps of %.1f %%, eight times finer %.1f %%", 100 * coarse, 100 * fine);
  ok(path < 0.01e-3, "the place of the touch changes in steps of at most %.4f mm", 1e3 * path);
}

/* Where the tip corner takes over the gap has neither a step nor a kink. With crowning and a shaft angle error the
   touch passes there slowly, over a range of approaches: the force has to follow evenly. */
static void test_takeover(void)
{
  struct eo_flank_modification early = {.tip_relief = 8e-6,
                                        .tip_relief_start = 0.3e-3,
                                        .root_relief = 13e-6,
                                        .root_relief_start = 0.3e-3,
                                        .lead_crowning = 14e-6};
  enum { STEPS = 1000 };
  double step = 0, last = 0;
  eo_gap_field_init(&field, &grid->geometry, &early, &none, EO_LEFT, 0.1 * M_PI / 180, 0, 52.5e-3, grid->corner);
  int on = 0, before = 0, after = 0;
  for (int i = 0; i <= STEPS; i++) {
    struct eo_impact now = strike_field(40e-6 + 22e-6 * i / STEPS, 2000 * rpm, 5e-3, 0);
    bool there = fabs(now.path - grid->geometry.path_start) < 1e-6;
    on += there;
    before += now.off_line && !there;
    after += !now.off_line && !there;
    step = i > 0 ? fmax(step, fabs(now.force - last) / last) : 0;
    last = now.force;
  }
  ok(on > 0 && before > 0 && after > 0, "the touch is at A for %d of %d approaches", on, STEPS);
  ok(step < 0.003, "the force changes in steps of at most %.2f %%", 100 * step);
}

static void test_outcomes(void)
{
  struct eo_flank_modification a = case_a();
  struct eo_impact free_run = strike(&a, &none, -1e-3, 2000 * rpm, 5e-3, 0);
  ok(!free_run.touched && free_run.force == 0, "without load nothing touches");
  struct eo_impact fine = strike(&a, &none, 13.5e-6, 2000 * rpm, 5e-3, 0),
                   sampled = strike(&a, &none, 13.5e-6, 2000 * rpm, 5e-3, 221);
  near(sampled.force, fine.force, 0.01, "force from 221 stations over the face against the exact place, N");
  struct eo_impact still = strike(&none, &none, 7e-6, 0, 5e-3, 0);
  ok(still.touched && still.force == 0, "a touch at rest has no force");
}

int main(void)
{
  make_grid();
  test_reference();
  test_half_sine();
  test_speed();
  test_what_moves_it();
  test_continuity();
  test_takeover();
  test_outcomes();
  eo_contact_grid_free(grid);
  return tap_done();
}

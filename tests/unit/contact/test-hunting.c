/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact over the hunting period: what holds for it exactly (no deviations, constants, rigid teeth, linear
   response, hands of their own, slopes that all teeth have, threads), and how near what follows from few solutions
   comes. Closed-form compliance, the paper's pair. */
#include "contact/hunting.h"
#include "contact/tooth_courses.h"
#include "numerics/fft.h"
#include "support/contact-fixture.h"

#include <complex.h>
#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 16, CELLS = 12, PINION = 17, GEAR = 44, CYCLES = PINION * GEAR };

static struct eo_geometry geometry;
static struct eo_closed_form form;
static struct eo_contact_grid *grid;
static struct eo_loaded_workspace *workspace;
static struct eo_loaded_gaps gaps;
static struct eo_loaded_end once;
static double force, normal; /* P, N; of an index deviation to the gap */

static void stop(const struct eo_error *error)
{
  printf("Bail out! %s: %s\n", error->pointer, error->text);
  exit(1);
}

static void set_gaps(const struct eo_flank_modification *pinion)
{
  struct eo_gap_field field;
  const struct eo_flank_modification none = {0};
  eo_gap_field_init(&field, &geometry, pinion, &none, EO_RIGHT, 0, 0, 0, grid->corner);
  eo_loaded_gaps_set(&gaps, grid, &field);
}

static void open_bench(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_material steel = paper_steel();
  struct eo_contact_grid_settings settings = {.positions = POSITIONS, .cells = CELLS, .tip_edges = false};
  struct eo_flank_modification a = case_a();
  struct eo_error error;
  form = paper_form();
  if (eo_geometry_init(&geometry, &pair, &error) ||
      eo_contact_grid_new(&grid, &geometry, &steel, &settings, NULL, (struct eo_kernel){eo_closed_form_kernel, &form},
                          NULL, &error) ||
      eo_loaded_workspace_new(&workspace, grid, &error) || eo_loaded_gaps_init(&gaps, grid, &error) ||
      eo_loaded_end_init(&once, grid, &error))
    stop(&error);
  force = force_of(&geometry, 828);
  normal = cos(geometry.transverse_pressure_angle) * cos(geometry.base_helix_angle);
  set_gaps(&a);
}

static void close_bench(void)
{
  eo_loaded_end_done(&once);
  eo_loaded_gaps_done(&gaps);
  eo_loaded_workspace_free(workspace);
  eo_contact_grid_free(grid);
}

/* Both ends on the same grid and flanks, floating; tables may be put into it. */
static struct eo_hunting_input plain_input(int ends)
{
  return (struct eo_hunting_input){.ends = ends,
                                   .grid = {grid, grid},
                                   .gap = {gaps.gap, gaps.gap},
                                   .positions = POSITIONS,
                                   .compliance_factor = 1,
                                   .load = {force, force},
                                   .shared_load = force,
                                   .threads = 2};
}

static struct eo_hunting run(const struct eo_hunting_input *input)
{
  struct eo_hunting hunting;
  struct eo_error error;
  if (eo_hunting_run(&hunting, input, NULL, &error))
    stop(&error);
  return hunting;
}

static struct eo_tooth_deviation table[2][2][GEAR];

/* Run-out and scatter of both members, each end with numbers of its own. */
static void draw_tables(double runout, double scatter)
{
  for (int end = 0; end < 2; end++)
    for (int member = 0; member < 2; member++)
      for (int i = 0; i < GEAR; i++) {
        double turn = 2 * M_PI * i / geometry.teeth[member];
        table[end][member][i] =
            (struct eo_tooth_deviation){.index = runout * cos(turn + end + 2 * member) +
                                                 scatter * random_between(member + 2 * end, 500 + i, -1, 1)};
      }
}

static void put_tables(struct eo_hunting_input *input)
{
  for (int end = 0; end < 2; end++)
    for (int member = 0; member < 2; member++)
      input->tooth[end][member] = table[end][member];
}

static double apart(int n, const double *a, const double *b, double constant)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fmax(most, fabs(a[i] - b[i] - constant));
  return most;
}

/* A thousandth of a nanometre is what the contact is solved to. */
static const double SOLVED = 2e-12;

static void test_no_deviations(void)
{
  struct eo_hunting_input input = plain_input(1);
  struct eo_hunting h = run(&input);
  double most = 0, share = 0;
  eo_loaded_solve(workspace, grid, &gaps, 1, 1, &force, &once);
  for (int i = 0; i < h.instants; i++) {
    double sum = 0;
    for (int k = 0; k < h.lines; k++)
      sum += (double)h.pair_load[0][i * h.lines + k];
    most = fmax(most, fabs(h.approach[0][i] - once.approach[i % POSITIONS]));
    share = fmax(share, fabs(sum / force - 1));
  }
  ok(h.cycles == CYCLES && h.failures == 0, "all %d cycles converge", h.cycles);
  ok(most < SOLVED, "without deviations every cycle is the one cycle (%.1e m)", most);
  ok(share < 1e-6, "the loads of the pairs add up to P (%.1e)", share);
  eo_hunting_done(&h);
}

static void test_constant(void)
{
  struct eo_hunting_input input = plain_input(1);
  struct eo_hunting base = run(&input);
  static struct eo_tooth_deviation constant[2][GEAR];
  for (int i = 0; i < GEAR; i++)
    constant[0][i].index = constant[1][i].index = 10e-6;
  input.tooth[0][0] = constant[0];
  input.tooth[0][1] = constant[1];
  struct eo_hunting h = run(&input);
  double loads = 0;
  for (int i = 0; i < h.instants * h.lines; i++)
    loads = fmax(loads, (double)fabsf(h.pair_load[0][i] - base.pair_load[0][i]));
  double moved = apart(h.instants, h.approach[0], base.approach[0], -20e-6 * normal);
  ok(moved < SOLVED, "10 um on all teeth of both members move Z by -20 um cos(alpha_t) cos(beta_b) (%.1e m)", moved);
  ok(loads < 1e-4 * force, "10 um on all teeth of both members change no load (%.1e N)", loads);
  eo_hunting_done(&h);
  eo_hunting_done(&base);
}

/* Almost rigid teeth: the pair whose line has the least gap carries alone. */
static void test_rigid(void)
{
  struct eo_flank_modification none = {0}, a = case_a();
  set_gaps(&none);
  draw_tables(6e-6, 3e-6);
  struct eo_hunting_input input = plain_input(1);
  put_tables(&input);
  input.compliance_factor = 1e-5;
  struct eo_hunting h = run(&input);
  double most = 0;
  for (int i = 0; i < h.instants; i++) {
    const struct eo_contact_position *p = &grid->position[i % POSITIONS];
    double least = INFINITY;
    for (int l = 0; l < p->lines; l++) {
      int m = i / POSITIONS - p->line[l].pair + CYCLES;
      least = fmin(least, -(table[0][0][m % PINION].index + table[0][1][m % GEAR].index) * normal);
    }
    most = fmax(most, fabs(h.approach[0][i] - least));
  }
  ok(most < 5e-9, "on rigid teeth the most advanced pair alone decides (%.1e m)", most);
  eo_hunting_done(&h);
  set_gaps(&a);
}

/* | mean over j of sum_k W_jk exp(2 pi i (k + j/J)/z) |, W = dZ/dw of the pairs by the response of one cycle. */
static double averaging(int teeth)
{
  static double change[1024], load[1024];
  double complex sum = 0;
  eo_loaded_solve(workspace, grid, &gaps, 1, 1, &force, &once);
  for (int j = 0; j < POSITIONS; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    eo_loaded_resolve(workspace, grid, gaps.gap, 1, j, force, &once);
    eo_loaded_prepare_response(workspace, p);
    for (int l = 0; l < p->lines; l++) {
      memset(change, 0, sizeof change);
      for (int i = p->line[l].first; i < p->line[l].first + p->line[l].cells; i++)
        change[i] = 1;
      double answer = eo_loaded_response(workspace, p, 1, change, load);
      sum += answer * cexp(2 * M_PI * I * (p->line[l].pair + (double)j / POSITIONS) / teeth);
    }
    eo_loaded_resolve(workspace, grid, gaps.gap, 1, j, force, &once);
  }
  return cabs(sum) / POSITIONS;
}

static double amplitude(int n, const double *value, double per_turn)
{
  double complex sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i] * cexp(-2 * M_PI * I * i / per_turn);
  return 2 * cabs(sum) / n;
}

static void test_averaging(void)
{
  static const double expected[2] = {0.984, 0.998}; /* deviations.md 4 */
  for (int member = 0; member < 2; member++) {
    struct eo_hunting_input input = plain_input(1);
    int z = geometry.teeth[member];
    for (int i = 0; i < z; i++)
      table[0][member][i] = (struct eo_tooth_deviation){.index = 0.2e-6 * cos(2 * M_PI * i / z)};
    input.tooth[0][member] = table[0][member];
    struct eo_hunting h = run(&input);
    double gain = amplitude(h.instants, h.approach[0], (double)z * POSITIONS) / (0.2e-6 * normal),
           linear = averaging(z);
    close_to(gain, linear, 5e-4,
             member ? "gain of the gear's first order by linear response"
                    : "gain of the pinion's first order by linear response");
    close_to(gain, expected[member], 1.5e-3, member ? "0.998 for z = 44" : "0.984 for z = 17");
    eo_hunting_done(&h);
  }
}

static void test_hands(void)
{
  draw_tables(6e-6, 3e-6);
  struct eo_hunting_input input = plain_input(2), alone = plain_input(1);
  put_tables(&input);
  alone.tooth[0][0] = table[1][0];
  alone.tooth[0][1] = table[1][1];
  struct eo_hunting h = run(&input), right = run(&alone);
  double most = apart(h.instants, h.approach[1], right.approach[0], 0);
  ok(most < SOLVED, "the right hand of a floating pinion is what it is alone (%.1e m)", most);
  eo_hunting_done(&right);
  input.stagger = 5;
  struct eo_hunting late = run(&input);
  most = apart(h.instants - 5, late.approach[1] + 5, h.approach[1], 0);
  ok(most < SOLVED && apart(h.instants, late.approach[0], h.approach[0], 0) == 0,
     "a staggered right hand comes 5 positions later (%.1e m)", most);
  eo_hunting_done(&late);
  input.stagger = 0;
  input.hold.stiffness = INFINITY;
  struct eo_hunting held = run(&input);
  double sum = 0;
  for (int i = 0; i < held.instants; i++)
    sum = fmax(sum, fabs(held.load[0][i] + held.load[1][i] - 2 * force));
  most = apart(held.instants, held.approach[0], held.approach[1], 0);
  ok(held.failures == 0 && most < 1e-11, "both hands of a fixed pinion have one Z (%.1e m, %d failures)", most,
     held.failures);
  ok(sum < 1e-6 * force, "both hands of a fixed pinion carry 2 P together (%.1e N)", sum);
  ok(held.most_load[0].value > h.most_load[0].value,
     "a tooth of a fixed pinion carries more than one of a floating pinion");
  eo_hunting_done(&held);
  eo_hunting_done(&h);
}

static bool same_places(int n, const struct eo_hunting_place *a, const struct eo_hunting_place *b)
{
  bool same = true;
  for (int i = 0; i < n; i++)
    same = same && a[i].value == b[i].value && a[i].cycle == b[i].cycle && a[i].position == b[i].position &&
           a[i].line == b[i].line && a[i].end == b[i].end;
  return same;
}

static void test_threads(void)
{
  draw_tables(6e-6, 3e-6);
  struct eo_hunting_input input = plain_input(2);
  put_tables(&input);
  struct eo_hunting many[2];
  for (int i = 0; i < 2; i++) {
    input.threads = 1 + 2 * i;
    many[i] = run(&input);
  }
  bool same = true;
  for (int end = 0; end < 2; end++) {
    size_t n = (size_t)many[0].instants;
    same = same && memcmp(many[0].approach[end], many[1].approach[end], n * sizeof(double)) == 0 &&
           memcmp(many[0].tangent[end], many[1].tangent[end], n * sizeof(double)) == 0 &&
           memcmp(many[0].pair_load[end], many[1].pair_load[end], n * sizeof(float) * (size_t)many[0].lines) == 0;
    for (int member = 0; member < 2; member++)
      same = same &&
             same_places(geometry.teeth[member], many[0].tooth_load[end][member], many[1].tooth_load[end][member]);
  }
  same = same && same_places(2, many[0].most_load, many[1].most_load) &&
         same_places(2, many[0].most_pressure, many[1].most_pressure);
  ok(same, "one thread and three give the same bytes");
  for (int end = 0; end < 2; end++) {
    const struct eo_hunting_place *p = &many[0].most_load[end];
    double there = (double)many[0].pair_load[end][(p->cycle * POSITIONS + p->position) * many[0].lines + p->line -
                                                  many[0].first_line];
    ok(fabs(there / p->value - 1) < 1e-6 && p->tooth[0] == (p->cycle - p->line + CYCLES) % PINION &&
           p->tooth[1] == (p->cycle - p->line + CYCLES) % GEAR,
       "the largest load stands where it is said to be, %.0f N on tooth %d of the pinion, %d of the gear", p->value,
       p->tooth[0], p->tooth[1]);
  }
  for (int i = 0; i < 2; i++)
    eo_hunting_done(&many[i]);
}

/* A slope or a crowning that every tooth has is the flank's own, to first order. */
static void test_forms(void)
{
  struct eo_flank_modification a = case_a(), formed = case_a();
  for (int i = 0; i < GEAR; i++)
    table[0][0][i] = (struct eo_tooth_deviation){
        .profile_slope = 4e-6, .helix_slope = -6e-6, .profile_crowning = 3e-6, .lead_crowning = 5e-6};
  struct eo_hunting_input input = plain_input(1);
  input.tooth[0][0] = table[0][0];
  struct eo_hunting h = run(&input);
  formed.profile_slope = 4e-6;
  formed.helix_slope = -6e-6;
  formed.profile_barrel = 3e-6;
  formed.lead_crowning += 5e-6;
  set_gaps(&formed);
  struct eo_hunting_input exact = plain_input(1);
  struct eo_hunting e = run(&exact);
  double most = apart(h.instants, h.approach[0], e.approach[0], 0);
  ok(most < 40e-9, "slopes and crownings of every tooth are those of the flank, to first order (%.1f nm of 18 um)",
     1e9 * most);
  eo_hunting_done(&h);
  eo_hunting_done(&e);
  set_gaps(&a);
}

/* A tooth with less crowning than the others carries more; and Parseval over the period. */
static void test_one_full_tooth(void)
{
  enum { FULL = 5 };
  memset(table, 0, sizeof table);
  table[0][0][FULL].lead_crowning = -8e-6;
  struct eo_hunting_input input = plain_input(1);
  input.tooth[0][0] = table[0][0];
  struct eo_hunting h = run(&input);
  int most = 0;
  for (int i = 0; i < PINION; i++)
    most = h.tooth_load[0][0][i].value > h.tooth_load[0][0][most].value ? i : most;
  ok(most == FULL,
     "a tooth whose face ends are fuller than the others' carries the largest load (%.0f N, tooth %d, %.0f N)",
     h.tooth_load[0][0][FULL].value, most, h.tooth_load[0][0][most].value);
  complex double *line = malloc(sizeof *line * (size_t)(h.instants / 2 + 1));
  struct eo_error error;
  double square = 0, lines = 0;
  if (!line || eo_fft_spectrum(NULL, h.instants, h.approach[0], line, &error))
    stop(&error);
  for (int i = 0; i < h.instants; i++)
    square += h.approach[0][i] * h.approach[0][i] / h.instants;
  for (int k = 0; k <= h.instants / 2; k++)
    lines += cabs(line[k]) * cabs(line[k]) * (k == 0 || 2 * k == h.instants ? 1 : 0.5);
  ok(fabs(lines / square - 1) < 1e-9, "the orders hold all of the transmission error (Parseval, %.1e)",
     fabs(lines / square - 1));
  free(line);
  eo_hunting_done(&h);
}

/* Fewer positions of a cycle are those of the full one. */
static void test_fewer_positions(void)
{
  draw_tables(6e-6, 3e-6);
  struct eo_hunting_input input = plain_input(1);
  put_tables(&input);
  struct eo_hunting full = run(&input);
  input.positions = POSITIONS / 2;
  struct eo_hunting half = run(&input);
  double most = 0;
  for (int i = 0; i < half.instants; i++)
    most = fmax(most, fabs(half.approach[0][i] - full.approach[0][2 * i]));
  ok(most < SOLVED, "every other position has the same numbers (%.1e m)", most);
  eo_hunting_done(&full);
  eo_hunting_done(&half);
}

struct followed {
  struct eo_hunting period, stretch;
};

static struct followed follow(const struct eo_hunting_input *input, double within, int stretch)
{
  struct followed followed;
  struct eo_error error;
  if (eo_hunting_follow(&followed.period, &followed.stretch, stretch, within, input, &error))
    stop(&error);
  return followed;
}

static void followed_done(struct followed *followed)
{
  eo_hunting_done(&followed->period);
  eo_hunting_done(&followed->stretch);
}

static double swing_of(const struct eo_hunting *hunting)
{
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < hunting->instants; i++) {
    low = fmin(low, hunting->approach[0][i]);
    high = fmax(high, hunting->approach[0][i]);
  }
  return high - low;
}

static double mean_square(const struct eo_hunting *a, const struct eo_hunting *b)
{
  double sum = 0;
  for (int i = 0; i < a->instants; i++)
    sum += (a->approach[0][i] - b->approach[0][i]) * (a->approach[0][i] - b->approach[0][i]) / a->instants;
  return sum;
}

/* Teeth alike are one solution at each position, and a tooth that stands forward is followed by its own approach. */
static void test_followed_alike(void)
{
  struct eo_hunting_input input = plain_input(1);
  struct eo_hunting full = run(&input);
  struct followed alike = follow(&input, INFINITY, 3);
  double most = apart(full.instants, alike.period.approach[0], full.approach[0], 0);
  ok(most < 1e-11 && alike.period.failures == 0,
     "a period followed without deviations has the approach of the full contact (%.1e m)", most);
  close_to(alike.period.most_load[0].value / full.most_load[0].value, 1, 1e-6,
           "the largest load of a pair over that of the full contact");
  close_to(alike.period.most_pressure[0].value / full.most_pressure[0].value, 1, 1e-6,
           "the largest pressure over that of the full contact");
  ok(apart(alike.stretch.instants, alike.stretch.approach[0], alike.period.approach[0], 0) < 1e-11 &&
         alike.stretch.cycles == 3 && alike.stretch.positions == POSITIONS,
     "a stretch is the beginning of the period");
  for (int i = 0; i < GEAR; i++)
    table[0][0][i] = (struct eo_tooth_deviation){.index = 5e-6};
  input.tooth[0][0] = table[0][0];
  struct followed forward = follow(&input, INFINITY, 0);
  most = apart(full.instants, forward.period.approach[0], full.approach[0], -5e-6 * normal);
  ok(most < 1e-11, "a constant moves Z by -F cos alpha_t cos beta_b and nothing else (%.1e m)", most);
  followed_done(&forward);
  followed_done(&alike);
  eo_hunting_done(&full);
}

static double stiffness_off(const struct eo_hunting *a, const struct eo_hunting *b)
{
  double sum = 0;
  for (int i = 0; i < a->instants; i++)
    sum += pow(a->tangent[0][i] / b->tangent[0][i] - 1, 2) / a->instants;
  return sqrt(sum);
}

/* Teeth that stand apart by more than they are deflected: with more solutions what is between them comes nearer. */
static void test_followed_drawn(void)
{
  draw_tables(6e-6, 3e-6);
  struct eo_hunting_input input = plain_input(1);
  put_tables(&input);
  struct eo_hunting full = run(&input);
  struct followed rough = follow(&input, INFINITY, 0), fine = follow(&input, 2e-9, 0);
  double swing = swing_of(&full), far = sqrt(mean_square(&rough.period, &full)),
         near = sqrt(mean_square(&fine.period, &full)),
         worst = apart(full.instants, fine.period.approach[0], full.approach[0], 0);
  ok(far < 0.00075 * swing, "three solutions of each pair are %.1f nm off a swing of %.2f um (root mean square)",
     1e9 * far, 1e6 * swing);
  ok(near < 3.5e-10 && worst < 4e-9, "solutions within 2 nm are %.2f nm off, %.1f nm at most", 1e9 * near, 1e9 * worst);
  ok(stiffness_off(&fine.period, &full) < 0.006 && stiffness_off(&rough.period, &full) < 0.026,
     "the stiffness is %.3f %% off, of three solutions %.3f %%", 100 * stiffness_off(&fine.period, &full),
     100 * stiffness_off(&rough.period, &full));
  close_to(swing_of(&fine.period) / swing, 1, 5e-4, "the swing of fine solutions over that in full");
  close_to(fine.period.most_load[0].value / full.most_load[0].value, 1, 1e-6,
           "the largest load of a tooth by fine solutions over that in full");
  close_to(fine.period.most_pressure[0].value / full.most_pressure[0].value, 1, 1e-6,
           "the largest pressure of a tooth by fine solutions over that in full");
  followed_done(&rough);
  followed_done(&fine);
  eo_hunting_done(&full);
}

/* Teeth so far apart that either pair carries alone in some cycles. */
static void test_followed_alone(void)
{
  draw_tables(30e-6, 15e-6);
  struct eo_hunting_input input = plain_input(1);
  put_tables(&input);
  struct eo_hunting full = run(&input);
  struct followed rough = follow(&input, INFINITY, 0), fine = follow(&input, 2e-9, 0);
  double swing = swing_of(&full), far = sqrt(mean_square(&rough.period, &full)),
         near = sqrt(mean_square(&fine.period, &full));
  ok(far < 0.003 * swing && near < 6e-9, "teeth that carry alone are %.1f nm off a swing of %.1f um, %.2f nm in full",
     1e9 * far, 1e6 * swing, 1e9 * near);
  ok(stiffness_off(&fine.period, &full) < 0.015 && stiffness_off(&rough.period, &full) < 0.08,
     "the stiffness is %.3f %% off, of three solutions %.3f %%", 100 * stiffness_off(&fine.period, &full),
     100 * stiffness_off(&rough.period, &full));
  close_to(fine.period.most_load[0].value / full.most_load[0].value, 1, 1e-3,
           "the largest load of a tooth that carries alone over that in full");
  close_to(fine.period.most_pressure[0].value / full.most_pressure[0].value, 1, 1e-3,
           "the largest pressure of a tooth that carries alone over that in full");
  followed_done(&rough);
  followed_done(&fine);
  eo_hunting_done(&full);
}

/* The contact with teeth alike is known: where that begins changes no more than what a solution may be off, and the
   places are as they are one after the other. */
static void test_followed_known(void)
{
  static const double ROUGHLY = 1e-10; /* m, of a solution; a hundredth of it elsewhere */
  draw_tables(6e-6, 3e-6);
  struct eo_hunting_input input = plain_input(1);
  put_tables(&input);
  eo_loaded_solve(workspace, grid, &gaps, 1, 1, &force, &once);
  struct followed cold = follow(&input, INFINITY, 0), fine = follow(&input, 2e-9, 0);
  input.alike[0] = &once;
  struct followed known = follow(&input, INFINITY, 0), same = follow(&input, 2e-9, 0);
  double most = apart(cold.period.instants, known.period.approach[0], cold.period.approach[0], 0);
  ok(known.period.failures == 0 && most < 20 * ROUGHLY && most > 0, "Z from what is known is within %.2g nm",
     1e9 * most);
  ok(apart(fine.period.instants, same.period.approach[0], fine.period.approach[0], 0) == 0,
     "pairs in full begin as they did before");
  followed_done(&cold);
  followed_done(&fine);
  followed_done(&known);
  followed_done(&same);
}

/* Forms of their own on one member are taken at their mean. */
static void test_followed_forms(void)
{
  draw_tables(6e-6, 3e-6);
  for (int i = 0; i < GEAR; i++) {
    table[0][1][i].profile_slope = random_between(9, i, -3e-6, 3e-6);
    table[0][1][i].lead_crowning = random_between(10, i, -3e-6, 3e-6);
  }
  struct eo_hunting_input input = plain_input(1);
  put_tables(&input);
  struct eo_hunting full = run(&input);
  struct followed drawn = follow(&input, INFINITY, 0);
  double swing = swing_of(&full), off = sqrt(mean_square(&drawn.period, &full)),
         load = drawn.period.most_load[0].value / full.most_load[0].value,
         pressure = drawn.period.most_pressure[0].value / full.most_pressure[0].value;
  ok(drawn.period.failures == 0 && off < 0.01 * swing,
     "teeth with forms are %.3f um off a swing of %.2f um (root mean square)", 1e6 * off, 1e6 * swing);
  close_to(swing_of(&drawn.period) / swing, 1, 0.01, "the swing of teeth with forms over that in full");
  close_to(load, 1, 0.03, "the largest load of a tooth with a form over that in full");
  close_to(pressure, 1, 0.05, "the largest pressure of a tooth with a form over that in full");
  struct eo_hunting_input few = input;
  few.positions = POSITIONS / 4;
  struct followed seldom = follow(&few, INFINITY, 2);
  double most = 0;
  for (int i = 0; i < seldom.period.instants; i++)
    most = fmax(most, fabs(seldom.period.approach[0][i] - drawn.period.approach[0][4 * i]));
  ok(most < 1e-10, "fewer positions have the same numbers (%.1e m)", most);
  ok(apart(seldom.stretch.instants, seldom.stretch.approach[0], drawn.period.approach[0], 0) < 1e-10,
     "a stretch has all of the positions");
  followed_done(&seldom);
  followed_done(&drawn);
  eo_hunting_done(&full);
}

int main(void)
{
  open_bench();
  test_no_deviations();
  test_constant();
  test_rigid();
  test_averaging();
  test_hands();
  test_threads();
  test_forms();
  test_one_full_tooth();
  test_fewer_positions();
  test_followed_alike();
  test_followed_drawn();
  test_followed_alone();
  test_followed_known();
  test_followed_forms();
  close_bench();
  return tap_done();
}

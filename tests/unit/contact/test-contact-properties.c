/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What holds for every loaded contact: complementarity and equilibrium computed anew from the full compliance, the
   tangent, mirrored input, warm starts, axially held pinions, threads, and three hundred random gear pairs under any
   load. */
#include "support/contact-fixture.h"
#include "contact/load_bow.h"
#include "contact/loaded.h"

#include <pthread.h>
#include <stdlib.h>

enum { POSITIONS = 12, CELLS = 15, MOST_LOADS = 6, MOST_POINTS = 400 };

/* Both ends of a bench. */
#define HALVES(b)                                     \
  (const struct eo_loaded_half[])                     \
  {                                                   \
    {(b)->workspace, (b)->grid, &(b)->gaps[EO_LEFT]}, \
    {                                                 \
      (b)->workspace, (b)->grid, &(b)->gaps[EO_RIGHT] \
    }                                                 \
  }

static const double degree = M_PI / 180;

/* One end of a pair: geometry, grid with its kernel, gap field, gaps and results. */
struct bench {
  struct eo_geometry geometry;
  struct eo_kernel kernel;
  struct eo_contact_grid *grid;
  struct eo_loaded_workspace *workspace;
  struct eo_gap_field field;
  struct eo_loaded_gaps gaps[2];
  struct eo_loaded_end result[MOST_LOADS];
};

static struct eo_closed_form closed_form;
static double smooth_form[3] = {1.2e-9, 15e-3, 9e-3};

static void bench_open_as(struct bench *b, const struct eo_geometry *g, struct eo_kernel kernel,
                          const struct eo_contact_grid_settings *settings)
{
  struct eo_material steel = paper_steel();
  struct eo_error error = {0};
  memset(b, 0, sizeof *b);
  b->geometry = *g;
  b->kernel = kernel;
  bool made = eo_contact_grid_new(&b->grid, g, &steel, settings, NULL, kernel, NULL, &error) == EO_OK &&
              eo_loaded_workspace_new(&b->workspace, b->grid, &error) == EO_OK;
  for (int end = 0; end < 2 && made; end++)
    made = eo_loaded_gaps_init(&b->gaps[end], b->grid, &error) == EO_OK;
  for (int k = 0; k < MOST_LOADS && made; k++)
    made = eo_loaded_end_init(&b->result[k], b->grid, &error) == EO_OK;
  if (!made) {
    printf("Bail out! %s\n", error.text);
    exit(1);
  }
}

static void bench_open(struct bench *b, const struct eo_geometry *g, struct eo_kernel kernel, bool edges, int positions,
                       int cells)
{
  struct eo_contact_grid_settings settings = {
      .positions = positions, .cells = cells, .tip_edges = edges, .edge_cells = 6, .edge_reach = NAN};
  bench_open_as(b, g, kernel, &settings);
}

static void bench_close(struct bench *b)
{
  for (int k = 0; k < MOST_LOADS; k++)
    eo_loaded_end_done(&b->result[k]);
  for (int end = 0; end < 2; end++)
    eo_loaded_gaps_done(&b->gaps[end]);
  eo_loaded_workspace_free(b->workspace);
  eo_contact_grid_free(b->grid);
}

static void set_gaps(struct bench *b, int end, const struct eo_flank_modification *pinion,
                     const struct eo_flank_modification *gear, double kappa, double gamma)
{
  eo_gap_field_init(&b->field, &b->geometry, pinion, gear, end, kappa, gamma, 52.5e-3, b->grid->corner);
  eo_loaded_gaps_set(&b->gaps[end], b->grid, &b->field);
}

static struct eo_kernel kernel_of(int which)
{
  closed_form = paper_form();
  return which ? (struct eo_kernel){smooth_kernel, smooth_form}
               : (struct eo_kernel){eo_closed_form_kernel, &closed_form};
}

static struct eo_geometry paper_geometry(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_geometry g;
  struct eo_error error;
  ok(eo_geometry_init(&g, &pair, &error) == EO_OK, "the paper's pair is made");
  return g;
}

struct residuals {
  double closed;  /* largest |d| where a point carries load, m */
  double open;    /* smallest d where it does not, m */
  double balance; /* largest |sum p / P - 1| */
  bool sound;     /* loads not negative, everything finite, stiffness positive, no failures */
};

/* Local deflection at line load q; beyond the law's meaning (q above exp(L - 2)) it goes on in a straight line. */
static double local_deflection(const struct eo_contact_grid *grid, double law, double q)
{
  return grid->compliance_scale * (log(q) < law - 2 ? q * (law - log(q)) : q + exp(law - 2));
}

static void check_position(const struct bench *b, const struct eo_contact_position *p, const double *gap,
                           const struct eo_loaded_end *end, int j, double factor, struct residuals *r)
{
  static double compliance[MOST_POINTS * MOST_POINTS];
  double sum = 0;
  b->kernel.evaluate(b->kernel.context, p->points, p->point, compliance);
  for (int i = 0; i < p->points; i++) {
    double q = end->line_load[p->first + i], d = 0;
    for (int k = 0; k < p->points; k++)
      d += compliance[i * p->points + k] * end->line_load[p->first + k] * p->length[k];
    d += q > 0 ? local_deflection(b->grid, p->law[i], q) : 0;
    d = d * factor + gap[p->first + i] - end->approach[j];
    r->sound = r->sound && q >= 0 && isfinite(q) && isfinite(d);
    sum += q * p->length[i];
    if (q > 0)
      r->closed = fmax(r->closed, fabs(d));
    else
      r->open = fmin(r->open, d);
  }
  r->balance = fmax(r->balance, fabs(sum / end->load[j] - 1));
  r->sound = r->sound && isfinite(end->approach[j]) && isfinite(end->tangent[j]) && end->tangent[j] > 0;
}

static struct residuals check_end(const struct bench *b, const double *gap, const struct eo_loaded_end *end,
                                  double factor)
{
  struct residuals r = {.sound = end->failures == 0};
  for (int j = 0; j < b->grid->positions; j++)
    check_position(b, &b->grid->position[j], gap, end, j, factor, &r);
  return r;
}

static void test_complementarity(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification none = {0}, a = case_a();
  double load[3] = {force_of(&g, 621), force_of(&g, 828), force_of(&g, 1035)};
  for (int k = 0; k < 8; k++) {
    struct bench b;
    struct residuals worst = {.sound = true};
    double factor = k == 3 ? 1.1 : 1;
    bench_open(&b, &g, kernel_of(k % 2), k != 5, POSITIONS, CELLS);
    set_gaps(&b, EO_RIGHT, k & 2 ? &a : &none, k == 6 ? &a : &none, k & 4 ? 0.1 * degree : 0, 0);
    eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], factor, 3, load, b.result);
    for (int l = 0; l < 3; l++) {
      struct residuals r = check_end(&b, b.gaps[EO_RIGHT].gap, &b.result[l], factor);
      worst = (struct residuals){fmax(worst.closed, r.closed), fmin(worst.open, r.open), fmax(worst.balance, r.balance),
                                 worst.sound && r.sound};
    }
    ok(worst.sound && worst.closed < 2e-12 && worst.open > -2e-12 && worst.balance < 1e-9,
       "case %d: loaded points touch within %.1e m, free ones stay clear (%.1e m), loads add up within %.1e", k,
       worst.closed, worst.open, worst.balance);
    bench_close(&b);
  }
}

/* Largest mismatch of the local law, m: a cell carries what the mean of the positive part of its local approach asks
   for, the approach changing over the cell as it does between its neighbours on the line. */
static double partial_mismatch(const struct bench *b, const struct eo_contact_position *p, const double *gap,
                               const struct eo_loaded_end *end, int j)
{
  static double compliance[MOST_POINTS * MOST_POINTS], local[MOST_POINTS];
  double worst = 0;
  b->kernel.evaluate(b->kernel.context, p->points, p->point, compliance);
  for (int i = 0; i < p->points; i++) {
    local[i] = end->approach[j] - gap[p->first + i];
    for (int k = 0; k < p->points; k++)
      local[i] -= compliance[i * p->points + k] * end->line_load[p->first + k] * p->length[k];
  }
  for (int l = 0; l < p->lines; l++)
    for (int i = 0; i < p->line[l].cells; i++) {
      int at = p->line[l].first + i, low = i > 0 ? at - 1 : at, high = i + 1 < p->line[l].cells ? at + 1 : at,
          parts = 2000;
      double change = (local[high] - local[low]) / (high - low), mean = 0, q = end->line_load[p->first + at];
      for (int n = 0; n < parts; n++)
        mean += fmax(0, local[at] + change * ((n + 0.5) / parts - 0.5)) / parts;
      worst = fmax(worst, fabs(mean - (q > 0 ? local_deflection(b->grid, p->law[at], q) : 0)));
    }
  return worst;
}

/* Largest error of the approach with n cells a line, against the given one, constant removed. */
static double approach_noise(const struct eo_geometry *g, bool partial, int cells, double *approach, bool compare)
{
  struct eo_flank_modification a = case_a(), none = {0};
  struct eo_contact_grid_settings settings = {
      .positions = 24, .cells = cells, .partial_cells = partial, .tip_edges = false};
  struct bench b;
  double load = force_of(g, 828), mean = 0, worst = 0;
  bench_open_as(&b, g, kernel_of(1), &settings);
  set_gaps(&b, EO_RIGHT, &a, &none, 0, 0);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &load, b.result);
  for (int j = 0; j < 24; j++)
    mean += compare ? (b.result[0].approach[j] - approach[j]) / 24 : 0;
  for (int j = 0; j < 24; j++)
    worst = fmax(worst, compare ? fabs(b.result[0].approach[j] - approach[j] - mean) : 0);
  if (!compare)
    memcpy(approach, b.result[0].approach, 24 * sizeof *approach);
  bench_close(&b);
  return worst;
}

static void test_partial_cells(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification a = case_a(), none = {0};
  struct eo_contact_grid_settings settings = {.positions = POSITIONS,
                                              .cells = CELLS,
                                              .partial_cells = true,
                                              .tip_edges = true,
                                              .edge_cells = 6,
                                              .edge_reach = NAN};
  double load[2] = {force_of(&g, 300), force_of(&g, 828)}, fine[24];
  for (int k = 0; k < 2; k++) {
    struct bench b;
    double worst = 0, balance = 0;
    bench_open_as(&b, &g, kernel_of(k), &settings);
    set_gaps(&b, EO_RIGHT, k ? &a : &none, &none, 0.1 * degree, 0);
    eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 2, load, b.result);
    for (int l = 0; l < 2; l++)
      for (int j = 0; j < POSITIONS; j++) {
        worst = fmax(worst, partial_mismatch(&b, &b.grid->position[j], b.gaps[EO_RIGHT].gap, &b.result[l], j));
        struct residuals r = {0};
        check_position(&b, &b.grid->position[j], b.gaps[EO_RIGHT].gap, &b.result[l], j, 1, &r);
        balance = fmax(balance, r.balance);
      }
    ok(worst < 2e-10 && balance < 1e-9,
       "kernel %d: partial cells carry the positive part of their approach within %.1e m, loads add up within %.1e", k,
       worst, balance);
    bench_close(&b);
  }
  approach_noise(&g, true, 130, fine, false);
  double whole = approach_noise(&g, false, 30, fine, true), partial = approach_noise(&g, true, 30, fine, true);
  ok(partial < 0.5 * whole, "30 cells a line: %.2f nm of noise instead of %.2f", 1e9 * partial, 1e9 * whole);
}

/* The load at which a cell enters bends Z(P); differences that stay on one side of all bends are what the tangent has
   to equal. */
static void test_tangent(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification none = {0}, a = case_a();
  for (int k = 0; k < 4; k++) {
    struct bench b;
    double nominal = force_of(&g, 828), step = 1e-4 * nominal, load[3] = {nominal - step, nominal, nominal + step},
           worst = 0;
    int bends = 0;
    bench_open(&b, &g, kernel_of(k % 2), true, 32, 30);
    set_gaps(&b, EO_RIGHT, k & 2 ? &a : &none, &none, k & 2 ? 0.1 * degree : 0, 0);
    for (int l = 0; l < 3; l++)
      eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &load[l], &b.result[l]);
    for (int j = 0; j < b.grid->positions; j++) {
      double *z[3] = {b.result[0].approach, b.result[1].approach, b.result[2].approach};
      double below = step / (z[1][j] - z[0][j]), above = step / (z[2][j] - z[1][j]);
      if (fabs(above / below - 1) > 1e-4)
        bends++;
      else
        worst = fmax(worst, fabs(b.result[1].tangent[j] / ((above + below) / 2) - 1));
    }
    ok(bends <= 6 && worst < 2e-4,
       "case %d: tangent stiffness against differences within %.1e, %d of 32 positions at a bend", k, worst, bends);
    bench_close(&b);
  }
}

static void test_monotony(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification none = {0}, a = case_a();
  struct bench b;
  double load[MOST_LOADS];
  bool rises = true, stiffens = true, softer = true;
  for (int l = 0; l < MOST_LOADS; l++)
    load[l] = force_of(&g, 10 * pow(3, l));
  bench_open(&b, &g, kernel_of(0), true, POSITIONS, CELLS);
  set_gaps(&b, EO_RIGHT, &a, &none, 0.1 * degree, 0);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, MOST_LOADS, load, b.result);
  for (int j = 0; j < b.grid->positions; j++)
    for (int l = 0; l < MOST_LOADS; l++) {
      double before = l ? b.result[l - 1].approach[j] : b.gaps[EO_RIGHT].unloaded[j];
      rises = rises && b.result[l].approach[j] > before;
      stiffens = stiffens && (l == 0 || b.result[l].tangent[j] > b.result[l - 1].tangent[j]);
    }
  ok(rises, "the approach grows with the load, from first contact on");
  ok(stiffens, "crowned flanks stiffen with the load");
  double stiff = b.result[3].approach[0];
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1.1, 1, &load[3], b.result);
  softer = b.result[0].approach[0] > stiff;
  ok(softer, "more compliance gives more approach");
  bench_close(&b);
}

static bool same_end(const struct bench *b, const struct eo_loaded_end *x, const struct eo_loaded_end *y)
{
  size_t n = (size_t)b->grid->positions * sizeof(double);
  return memcmp(x->approach, y->approach, n) == 0 && memcmp(x->tangent, y->tangent, n) == 0 &&
         memcmp(x->load, y->load, n) == 0 &&
         memcmp(x->line_load, y->line_load, (size_t)b->grid->points * sizeof(double)) == 0;
}

static void test_mirror(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification a = case_a(), other = random_modification(&g, 3, 0), none = {0};
  struct bench b;
  double load = force_of(&g, 828), stiffness = 2e8;
  bench_open(&b, &g, kernel_of(0), true, POSITIONS, CELLS);
  set_gaps(&b, EO_LEFT, &a, &none, 0.02 * degree, 0.01 * degree);
  set_gaps(&b, EO_RIGHT, &other, &none, 0.02 * degree, 0.01 * degree);
  for (int end = 0; end < 2; end++)
    eo_loaded_solve(b.workspace, b.grid, &b.gaps[end], 1, 1, &load, &b.result[end]);
  eo_loaded_balance(HALVES(&b), 1, &(struct eo_axial_hold){.stiffness = stiffness}, 0, load, &b.result[0]);
  set_gaps(&b, EO_RIGHT, &a, &none, -0.02 * degree, -0.01 * degree);
  set_gaps(&b, EO_LEFT, &other, &none, -0.02 * degree, -0.01 * degree);
  for (int end = 0; end < 2; end++)
    eo_loaded_solve(b.workspace, b.grid, &b.gaps[end], 1, 1, &load, &b.result[2 + end]);
  eo_loaded_balance(HALVES(&b), 1, &(struct eo_axial_hold){.stiffness = stiffness}, 0, load, &b.result[2]);
  double worst = 0;
  for (int j = 0; j < b.grid->positions; j++)
    for (int end = 0; end < 2; end++)
      worst = fmax(worst, fmax(fabs(b.result[end].approach[j] - b.result[3 - end].approach[j]) / 1e-6,
                               fabs(b.result[end].load[j] / b.result[3 - end].load[j] - 1)));
  ok(b.result[0].load[0] != load, "the spring between the ends shifts load from one to the other");
  ok(worst < 1e-9, "exchanged ends under reversed shaft errors give the same within %.1e", worst);
  bench_close(&b);
}

static void test_warm_starts(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification none = {0}, a = case_a();
  struct bench b;
  double up[3] = {force_of(&g, 300), force_of(&g, 828), force_of(&g, 3000)}, down[3] = {up[2], up[1], up[0]}, worst = 0;
  bench_open(&b, &g, kernel_of(1), true, POSITIONS, CELLS);
  set_gaps(&b, EO_RIGHT, &a, &none, 0.1 * degree, 0);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 3, up, b.result);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 3, down, b.result + 3);
  for (int j = 0; j < b.grid->positions; j++)
    for (int l = 0; l < 3; l++)
      worst = fmax(worst, fabs(b.result[l].approach[j] - b.result[5 - l].approach[j]));
  ok(worst < 3e-12, "the order of the loads changes the approach by %.1e m", worst);
  /* Something else in between, and the same again. */
  set_gaps(&b, EO_LEFT, &none, &none, 0, 0);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_LEFT], 0.9, 1, up, b.result + 3);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 3, up, b.result + 3);
  ok(same_end(&b, &b.result[1], &b.result[4]) && same_end(&b, &b.result[2], &b.result[5]),
     "a workspace remembers nothing and gives the same bytes");
  bench_close(&b);
}

/* Z at the loads about P against solutions of their own, where lines come into contact between them too; what they make
   of the curve over the load; and that asking for them changes nothing. */
static void test_loads_about(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification none = {0}, a = case_a();
  struct bench b;
  double load = force_of(&g, 828), worst = 0, between = 0, bent = 0;
  bool grows = true;
  bench_open(&b, &g, kernel_of(1), true, POSITIONS, CELLS);
  set_gaps(&b, EO_RIGHT, &a, &none, 0.1 * degree, 0);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &load, &b.result[0]);
  b.result[1].around = true;
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &load, &b.result[1]);
  ok(same_end(&b, &b.result[0], &b.result[1]), "loads that are asked for about P leave the same bytes");
  for (int i = -1; i <= EO_LOADED_NEARBY; i++) {
    double share = i < 0 ? 0.96 : i == EO_LOADED_NEARBY ? 1.12 : EO_LOADED_NEARBY_SHARE[i], there = share * load;
    eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &there, &b.result[2]);
    for (int j = 0; j < b.grid->positions; j++) {
      struct eo_load_bow bow;
      eo_load_bow_init(&bow, &b.result[1], j);
      double off = fabs(eo_load_bow_at(&bow, share - 1) - b.result[2].approach[j]),
             straight = b.result[1].approach[j] + (there - load) / b.result[1].tangent[j] - b.result[2].approach[j];
      if (i < 0 || i == EO_LOADED_NEARBY)
        between = fmax(between, off);
      else
        worst = fmax(worst, off);
      bent = fmax(bent, straight);
    }
  }
  ok(worst < 1e-8, "Z at the loads about P is within %.2g nm of solutions of their own", 1e9 * worst);
  ok(between < 1e-8 && bent > 5e-8, "Z between them is within %.2g nm; the tangent is off by up to %.2g nm",
     1e9 * between, 1e9 * bent);
  for (int j = 0; j < b.grid->positions; j++) {
    struct eo_load_bow bow;
    eo_load_bow_init(&bow, &b.result[1], j);
    for (double x = -0.99; x < 1; x += 0.01)
      grows = grows && eo_load_bow_at(&bow, x) > eo_load_bow_at(&bow, x - 0.01);
  }
  ok(grows, "Z grows with the load");
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &load, &b.result[2]);
  eo_loaded_find_nearby(b.workspace, b.grid, b.gaps[EO_RIGHT].gap, 1, &b.result[2]);
  worst = 0;
  for (int i = 0; i < b.grid->positions * EO_LOADED_NEARBY; i++)
    worst = fmax(worst, fabs(b.result[2].nearby[i] - b.result[1].nearby[i]));
  ok(worst < 5e-10, "loads about a result that is there already give Z within %.2g nm of the same", 1e9 * worst);
  bench_close(&b);
}

struct worker {
  struct bench *bench;
  struct eo_loaded_workspace *workspace;
  struct eo_loaded_end *result;
  double load;
};

static void *work(void *argument)
{
  struct worker *w = argument;
  for (int i = 0; i < 20; i++)
    eo_loaded_solve(w->workspace, w->bench->grid, &w->bench->gaps[EO_RIGHT], 1, 1, &w->load, w->result);
  return NULL;
}

static void test_threads(void)
{
  struct eo_geometry g = paper_geometry();
  struct eo_flank_modification none = {0}, a = case_a();
  struct bench b;
  struct eo_error error;
  struct worker worker[2];
  pthread_t thread[2];
  bench_open(&b, &g, kernel_of(0), true, POSITIONS, CELLS);
  set_gaps(&b, EO_RIGHT, &a, &none, 0.1 * degree, 0);
  double load = force_of(&g, 828);
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[EO_RIGHT], 1, 1, &load, &b.result[0]);
  for (int i = 0; i < 2; i++) {
    worker[i] = (struct worker){&b, NULL, &b.result[1 + i], load};
    ok(eo_loaded_workspace_new(&worker[i].workspace, b.grid, &error) == EO_OK, "a workspace for thread %d is made", i);
  }
  for (int i = 0; i < 2; i++)
    pthread_create(&thread[i], NULL, work, &worker[i]);
  for (int i = 0; i < 2; i++) {
    pthread_join(thread[i], NULL);
    eo_loaded_workspace_free(worker[i].workspace);
  }
  ok(same_end(&b, &b.result[0], &b.result[1]) && same_end(&b, &b.result[0], &b.result[2]),
     "two threads at once give the same bytes");
  bench_close(&b);
}

/* Both ends of case A under a small shaft error, with an axial support. result[0], [1]: the ends. */
static void hold(struct bench *b, double angle, double stiffness, int stagger, double load)
{
  struct eo_flank_modification a = case_a(), none = {0};
  for (int end = 0; end < 2; end++) {
    set_gaps(b, end, &a, &none, angle, 0);
    eo_loaded_solve(b->workspace, b->grid, &b->gaps[end], 1, 1, &load, &b->result[end]);
  }
  eo_loaded_balance(HALVES(b), 1, &(struct eo_axial_hold){.stiffness = stiffness}, stagger, load, b->result);
}

/* Largest difference of load and approach between two pairs of ends, relative to P and 10 um. */
static double difference(const struct bench *b, const struct eo_loaded_end *x, const struct eo_loaded_end *y,
                         double load)
{
  double worst = 0;
  for (int end = 0; end < 2; end++)
    for (int j = 0; j < b->grid->positions; j++)
      worst = fmax(worst, fmax(fabs(x[end].load[j] - y[end].load[j]) / load,
                               fabs(x[end].approach[j] - y[end].approach[j]) / 1e-5));
  return worst;
}

static void copy_ends(const struct bench *b, struct eo_loaded_end *to, const struct eo_loaded_end *from)
{
  for (int end = 0; end < 2; end++) {
    memcpy(to[end].load, from[end].load, (size_t)b->grid->positions * sizeof(double));
    memcpy(to[end].approach, from[end].approach, (size_t)b->grid->positions * sizeof(double));
  }
}

static void test_axial(void)
{
  struct eo_geometry g = paper_geometry();
  struct bench b;
  double load = force_of(&g, 828), angle = 0.01 * degree, lean = sin(g.base_helix_angle), worst = 0, balance = 0;
  int stagger = 3;
  bench_open(&b, &g, kernel_of(0), true, POSITIONS, CELLS);
  hold(&b, angle, 0, 0, load);
  copy_ends(&b, &b.result[2], &b.result[0]);
  ok(b.result[0].load[5] == load && b.result[1].load[5] == load, "each end of a floating pinion carries P");
  hold(&b, angle, 1e-3, 0, load);
  ok(difference(&b, &b.result[0], &b.result[2], load) < 1e-6, "a soft spring is no support");
  hold(&b, angle, INFINITY, 0, load);
  copy_ends(&b, &b.result[2], &b.result[0]);
  for (int j = 0; j < b.grid->positions; j++)
    worst = fmax(worst, fabs(b.result[0].approach[j] - b.result[1].approach[j]));
  ok(worst < 1e-12 && fabs(b.result[0].load[0] / b.result[1].load[0] - 1) > 0.05,
     "a fixed pinion has one approach for both ends within %.1e m and unequal loads", worst);
  hold(&b, angle, 1e15, 0, load);
  ok(difference(&b, &b.result[0], &b.result[2], load) < 1e-6, "a hard spring is a fixed support");
  hold(&b, angle, 1e8, stagger, load);
  worst = 0;
  for (int j = 0; j < b.grid->positions; j++) {
    int other = (j + b.grid->positions - stagger) % b.grid->positions;
    double left = b.result[0].load[j], right = b.result[1].load[other],
           z = (b.result[0].approach[j] - b.result[1].approach[other]) / (2 * lean);
    balance = fmax(balance, fabs((left - right) * lean + 1e8 * z) / load);
    worst = fmax(worst, fabs(left + right - 2 * load) / load);
  }
  ok(balance < 1e-6 && worst < 1e-12,
     "a pinion on a spring balances axial forces within %.1e P, its loads add up to 2 P, the right end staggered",
     balance);
  bool sound = true;
  for (int end = 0; end < 2; end++)
    sound = sound && check_end(&b, b.gaps[end].gap, &b.result[end], 1).closed < 2e-12;
  ok(sound, "each end of a pinion on a spring is in contact under its own load");
  bench_close(&b);
}

/* A shaft error so large that a fixed pinion bears on one end only. */
static void test_released_end(void)
{
  struct eo_geometry g = paper_geometry();
  struct bench b;
  double load = force_of(&g, 828), twice = 2 * load, clearance = INFINITY, worst = 0;
  bool released = true;
  bench_open(&b, &g, kernel_of(0), true, POSITIONS, CELLS);
  hold(&b, 0.1 * degree, INFINITY, 0, load);
  int light = b.result[0].load[0] > b.result[1].load[0] ? EO_RIGHT : EO_LEFT, heavy = 1 - light;
  eo_loaded_solve(b.workspace, b.grid, &b.gaps[heavy], 1, 1, &twice, &b.result[2]);
  for (int j = 0; j < b.grid->positions; j++) {
    released = released && b.result[light].load[j] == 0 && b.result[light].tangent[j] == 0;
    clearance = fmin(clearance, b.gaps[light].unloaded[j] - b.result[light].approach[j]);
    worst = fmax(worst, fabs(b.result[heavy].approach[j] - b.result[2].approach[j]) +
                            fabs(b.result[light].approach[j] - b.result[heavy].approach[j]));
  }
  ok(released && clearance > 0, "an end that does not touch carries nothing and is %.1f um clear", 1e6 * clearance);
  ok(worst < 3e-12, "the end that touches carries all of the load");
  ok(b.result[0].failures == 0 && b.result[1].failures == 0, "an end that does not touch is no failure");
  bench_close(&b);
}

static void test_random(void)
{
  enum { DESIGNS = 300, LOADS = 6 };
  int sound = 0, spur = 0, wide = 0, narrow = 0;
  for (int index = 0; index < DESIGNS; index++) {
    struct eo_gear_pair pair;
    struct eo_geometry g;
    struct bench b;
    if (!random_pair(index, &pair, &g)) {
      ok(false, "random pair %d is made", index);
      continue;
    }
    /* Compliances in proportion to the size; loads from next to nothing to far beyond what the teeth could bear. */
    double size = pair.normal_module / 6e-3, nominal = 828 * size * size * g.face_width / 55e-3,
           load[LOADS] = {1, 0.01 * nominal, nominal, 3 * nominal, 1e5, 0.1 * nominal};
    closed_form = paper_form();
    closed_form = (struct eo_closed_form){closed_form.compliance / size, closed_form.length * size,
                                          closed_form.centre * size, closed_form.linear / size,
                                          closed_form.quadratic / (size * size)};
    double smooth[3] = {1.2e-9 / size, 15e-3 * size, 9e-3 * size};
    struct eo_kernel kernel = index % 2 ? (struct eo_kernel){smooth_kernel, smooth}
                                        : (struct eo_kernel){eo_closed_form_kernel, &closed_form};
    struct eo_flank_modification none = {0}, pinion = random_modification(&g, index, 0),
                                 gear = random_modification(&g, index, 20);
    bench_open(&b, &g, kernel, index % 3 != 0, 6, 10);
    set_gaps(&b, index % 2, index % 4 ? &pinion : &none, index % 4 == 3 ? &gear : &none,
             index % 7 ? random_between(index, 70, -2e-3, 2e-3) : 0,
             index % 7 ? random_between(index, 71, -1e-3, 1e-3) : 0);
    for (int l = 0; l < LOADS; l++)
      load[l] = force_of(&g, load[l]);
    eo_loaded_solve(b.workspace, b.grid, &b.gaps[index % 2], 1, LOADS, load, b.result);
    bool good = true;
    for (int l = 0; l < LOADS && good; l++) {
      struct residuals r = check_end(&b, b.gaps[index % 2].gap, &b.result[l], 1);
      double deep = fabs(b.result[l].approach[0]);
      /* The part of the compliance kept in single precision shows once deflections are millimetres. */
      good = r.sound && r.closed < 5e-12 + 1e-7 * deep && r.open > -5e-12 - 1e-7 * deep && r.balance < 1e-9;
      if (!good)
        ok(false, "random pair %d, load %d: z %d/%d, m_n %.3g mm, beta %.3g deg: %.1e m, %.1e m, sum %.1e", index, l,
           g.teeth[0], g.teeth[1], 1e3 * g.normal_module, g.helix_angle / degree, r.closed, r.open, r.balance);
    }
    sound += good;
    spur += g.helix_angle == 0;
    wide += g.overlap_ratio > 3;
    narrow += g.overlap_ratio < 0.3 && g.helix_angle > 0;
    bench_close(&b);
  }
  ok(sound == DESIGNS, "%d of %d random pairs solve for 1 N m to 1e5 N m", sound, DESIGNS);
  ok(spur > 20 && wide > 5 && narrow > 20,
     "the random pairs hold %d spur ones, %d with an overlap above 3, %d below 0.3", spur, wide, narrow);
}

int main(void)
{
  test_complementarity();
  test_partial_cells();
  test_tangent();
  test_monotony();
  test_mirror();
  test_warm_starts();
  test_loads_about();
  test_threads();
  test_axial();
  test_released_end();
  test_random();
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/elastic.h"

#include "numerics/dense.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MODES = EO_SHAFT_MODES, PART = 2 * EO_DEFLECTION_NODES };

static const double MOST_SHIFT = 0.999; /* of P: an axially held pinion may all but unload one end */
static const double ROUNDING = 1e-12;   /* m */

/* Where a point stands among the nodes of its end. */
struct place {
  int node;      /* the one below */
  double weight; /* of the one above */
  double path;   /* s; at a tip corner, too, that of the corner */
};

struct eo_elastic {
  const struct eo_contact_grid *grid[2]; /* [end] */
  struct eo_double_helix helix;
  struct eo_shaft_influence influence;
  struct place *place[2];             /* [end][most_points] of the present position */
  double *gap[2];                     /* [end][points of its grid] of the bent bodies */
  double *change, *answer;            /* [most_points] */
  struct eo_deflection deflection[2]; /* [end] at the present position, and what its loads ask for */
  struct eo_deflection asked[2], load[2];
  struct eo_deflection response[MODES][2]; /* H V: load given up per unit of a mode */
  struct eo_deflection shifted[2];         /* load taken on per N of shift */
  double shift;                            /* P'_L - P */
  double rate[2];                          /* [end] dZ'/dP', m/N */
  struct eo_deflection *history[2];        /* [end][positions] */
};

static void set_places(struct eo_elastic *el, int end, int j)
{
  const struct eo_contact_grid *grid = el->grid[end];
  const struct eo_contact_position *position = &grid->position[j];
  struct place *place = el->place[end];
  for (int i = 0; i < position->points; i++) {
    double u = (position->point[i].eta / grid->geometry.face_width + 0.5) * (EO_DEFLECTION_NODES - 1);
    place[i].node = (int)fmax(0, fmin(EO_DEFLECTION_NODES - 2, floor(u)));
    place[i].weight = u - place[i].node;
    place[i].path = position->path[i];
  }
}

static void gather(int points, const struct place *place, const double *load, struct eo_deflection *nodal)
{
  memset(nodal, 0, sizeof *nodal);
  for (int i = 0; i < points; i++) {
    double upper = load[i] * place[i].weight, lower = load[i] - upper;
    nodal->part[0][place[i].node] += lower;
    nodal->part[0][place[i].node + 1] += upper;
    nodal->part[1][place[i].node] += place[i].path * lower;
    nodal->part[1][place[i].node + 1] += place[i].path * upper;
  }
}

static void spread(int points, const struct place *place, const struct eo_deflection *deflection, double *change)
{
  for (int i = 0; i < points; i++) {
    const double *level = deflection->part[0] + place[i].node, *tilt = deflection->part[1] + place[i].node;
    change[i] = level[0] + place[i].weight * (level[1] - level[0]) +
                place[i].path * (tilt[0] + place[i].weight * (tilt[1] - tilt[0]));
  }
}

static void gather_loads(struct eo_elastic *el, int end, int j, const struct eo_loaded_end *result)
{
  const struct eo_contact_position *position = &el->grid[end]->position[j];
  for (int i = 0; i < position->points; i++)
    el->answer[i] = result->line_load[position->first + i] * position->length[i];
  gather(position->points, el->place[end], el->answer, &el->load[end]);
}

static double product(const struct eo_deflection *deflection, const double *b)
{
  const double *x = &deflection->part[0][0];
  double sum = 0;
  for (int i = 0; i < PART; i++)
    sum += x[i] * b[i];
  return sum;
}

/* Largest gap that a deflection makes anywhere between the ends of the path of contact. */
static double largest(const struct eo_elastic *el, const struct eo_deflection *a, const struct eo_deflection *b)
{
  const struct eo_geometry *geometry = &el->grid[EO_LEFT]->geometry;
  double most = 0, reach = fmax(-geometry->path_start, geometry->path_end);
  for (int i = 0; i < EO_DEFLECTION_NODES; i++)
    most = fmax(most, fabs(a->part[0][i] - b->part[0][i]) + reach * fabs(a->part[1][i] - b->part[1][i]));
  return most;
}

/* Contact of one end at the present deflection, warm: its approach moves with its gaps. */
static void resolve(struct eo_elastic *el, struct eo_loaded_workspace *ws, const struct eo_loaded_gaps *gaps,
                    double factor, int end, int j, double load, bool first, struct eo_loaded_end *result)
{
  const struct eo_contact_position *position = &el->grid[end]->position[j];
  double rise = 0, total = 0, *gap = el->gap[end] + position->first;
  const double *rigid = gaps->gap + position->first;
  spread(position->points, el->place[end], &el->deflection[end], el->change);
  for (int i = 0; i < position->points; i++) {
    double before = first ? rigid[i] : gap[i], force = result->line_load[position->first + i] * position->length[i];
    gap[i] = rigid[i] + el->change[i];
    rise += force * (gap[i] - before);
    total += force;
  }
  result->approach[j] += total > 0 ? rise / total : 0;
  eo_loaded_resolve(ws, el->grid[end], el->gap[end], factor, j, load, result);
}

/* Answer of the end solved last to every mode, and to the shift of load. */
static void respond(struct eo_elastic *el, struct eo_loaded_workspace *ws, double factor, int end, int j)
{
  const struct eo_contact_position *position = &el->grid[end]->position[j];
  eo_loaded_prepare_response(ws, position);
  for (int k = 0; k < MODES; k++) {
    struct eo_deflection mode;
    memcpy(&mode, el->influence.mode + k * el->influence.size + end * PART, sizeof mode);
    spread(position->points, el->place[end], &mode, el->change);
    eo_loaded_response(ws, position, factor, el->change, el->answer);
    for (int i = 0; i < position->points; i++)
      el->answer[i] = -el->answer[i];
    gather(position->points, el->place[end], el->answer, &el->response[k][end]);
  }
  double scale = el->helix.scale[end];
  el->rate[end] = eo_loaded_response(ws, position, factor, NULL, el->answer) * scale * scale;
  for (int i = 0; end == EO_RIGHT && i < position->points; i++)
    el->answer[i] = -el->answer[i] * scale;
  gather(position->points, el->place[end], el->answer, &el->shifted[end]);
}

/* Newton's correction of the deflection and, when the pinion is held, of the shift: [M, -V'g; g'V, rate] [c; d shift] =
   -[(HV)'r; miss + g'r] with g the load taken on per N of shift (which is also how Z'_L - Z'_R follows the gaps). */
static void correct(struct eo_elastic *el, bool held, double soft, double miss)
{
  int ends = el->influence.ends, n = el->influence.size, rows = MODES + held, pivot[MODES + 1];
  double matrix[(MODES + 1) * (MODES + 1)] = {0}, step[MODES + 1] = {0};
  const double *mode = el->influence.mode;
  for (int end = 0; end < ends; end++) {
    double residual[PART];
    for (int i = 0; i < PART; i++)
      residual[i] = (&el->asked[end].part[0][0])[i] - (&el->deflection[end].part[0][0])[i];
    for (int k = 0; k < MODES; k++) {
      step[k] -= product(&el->response[k][end], residual);
      for (int l = 0; l < MODES; l++)
        matrix[k * rows + l] += product(&el->response[l][end], mode + k * n + end * PART);
      if (held) {
        double lean = product(&el->shifted[end], mode + k * n + end * PART);
        matrix[k * rows + MODES] -= lean;
        matrix[MODES * rows + k] += lean;
      }
    }
    step[MODES] -= held ? product(&el->shifted[end], residual) : 0;
  }
  for (int k = 0; k < MODES; k++)
    matrix[k * rows + k] += 1;
  if (held) {
    matrix[MODES * rows + MODES] = el->rate[EO_LEFT] + el->rate[EO_RIGHT] + soft;
    step[MODES] -= miss;
  }
  if (eo_dense_solve(rows, matrix, pivot, 1, step))
    memset(step, 0, sizeof step);
  for (int end = 0; end < ends; end++) {
    el->deflection[end] = el->asked[end];
    for (int k = 0; k < MODES; k++)
      for (int i = 0; i < PART; i++)
        (&el->deflection[end].part[0][0])[i] += step[k] * mode[k * n + end * PART + i];
  }
  el->shift += held ? step[MODES] : 0;
}

/* How far the deflection is from what the loads ask for, m. */
static double departure(const struct eo_elastic *el)
{
  double most = 0;
  for (int end = 0; end < el->influence.ends; end++)
    most = fmax(most, largest(el, &el->asked[end], &el->deflection[end]));
  return most;
}

/* Z'_L - Z'_R against the support; 0 when the pinion floats, or when an end is already as good as unloaded and would
   let go. */
static double axial_miss(struct eo_elastic *el, const struct eo_elastic_case *elastic_case, double soft,
                         const int at[2], const struct eo_loaded_end *result, bool *held)
{
  *held = el->influence.ends == 2 && elastic_case->hold.stiffness > 0;
  if (!*held)
    return 0;
  double apart = result[EO_LEFT].approach[at[EO_LEFT]] -
                 result[EO_RIGHT].approach[at[EO_RIGHT]] * el->helix.scale[EO_RIGHT],
         stopped;
  stopped = eo_axial_beyond_play(&elastic_case->hold, apart - elastic_case->hold.rest);
  double miss = stopped + soft * (el->shift - elastic_case->hold.shift);
  if (elastic_case->hold.play > 0 && stopped == 0) { /* free between the stops: the thrust alone decides */
    *held = false;
    el->shift = elastic_case->hold.shift;
    return fabs(miss) > ROUNDING ? miss : 0;
  }
  *held = fabs(el->shift) < MOST_SHIFT * elastic_case->load || miss * el->shift > 0;
  return *held ? miss : 0;
}

/* Iterates at position j of the left end and `other` of the right one, from the present deflection; returns the number
   of iterations, 0 when they did not converge. The contact's answer is asked for once, and again when the iteration
   slows down. */
static int solve_position(struct eo_elastic *el, struct eo_loaded_workspace *const ws[2],
                          const struct eo_loaded_gaps *gaps, const struct eo_elastic_case *elastic_case, double soft,
                          const int at[2], struct eo_loaded_end *result)
{
  enum { ITERATIONS = 40 };
  static const double DONE = 1e-11, SLOW = 0.1;
  int ends = el->influence.ends;
  bool held, ask = true;
  double before = INFINITY;
  for (int end = 0; end < ends; end++)
    set_places(el, end, at[end]);
  for (int iteration = 1; iteration <= ITERATIONS; iteration++) {
    el->shift = fmax(-MOST_SHIFT * elastic_case->load, fmin(MOST_SHIFT * elastic_case->load, el->shift));
    for (int end = 0; end < ends; end++) {
      double load = (end == EO_LEFT ? elastic_case->load + el->shift : elastic_case->load - el->shift) *
                    el->helix.scale[end];
      resolve(el, ws[end], &gaps[end], elastic_case->compliance_factor, end, at[end], load, iteration == 1,
              &result[end]);
      if (ask)
        respond(el, ws[end], elastic_case->compliance_factor, end, at[end]);
      gather_loads(el, end, at[end], &result[end]);
    }
    eo_shaft_deflect(&el->influence, el->load, el->asked);
    double miss = axial_miss(el, elastic_case, soft, at, result, &held), error = fmax(departure(el), fabs(miss));
    if (error < DONE)
      return iteration;
    ask = error > SLOW * before;
    before = error;
    correct(el, held, soft, miss);
  }
  return 0;
}

static int other_position(const struct eo_elastic *el, int j, int stagger)
{
  int n = el->grid[EO_LEFT]->positions;
  return ((j - stagger) % n + n) % n;
}

static void summarise(const struct eo_elastic *el, struct eo_elastic_report *report)
{
  int n = el->grid[EO_LEFT]->positions;
  for (int end = 0; end < el->influence.ends; end++) {
    double *mean = &report->mean[end].part[0][0];
    for (int j = 0; j < n; j++)
      for (int i = 0; i < PART; i++)
        mean[i] += (&el->history[end][j].part[0][0])[i] / n;
    for (int j = 0; j < n; j++)
      report->change = fmax(report->change, largest(el, &el->history[end][j], &report->mean[end]));
  }
}

/* Start of position j: on from the two positions before. */
static void extrapolate(struct eo_elastic *el, int j, int stagger)
{
  int n = el->grid[EO_LEFT]->positions;
  for (int end = 0; end < 2; end++) {
    int behind[2] = {j - 1, j - 2};
    for (int k = 0; k < 2; k++)
      behind[k] = end == EO_LEFT ? (behind[k] + n) % n : other_position(el, behind[k], stagger);
    const double *last = &el->history[end][behind[0]].part[0][0], *earlier = &el->history[end][behind[1]].part[0][0];
    for (int i = 0; i < PART; i++)
      (&el->deflection[end].part[0][0])[i] = j < 2 ? (j == 0 ? 0 : last[i]) : 2 * last[i] - earlier[i];
  }
}

void eo_elastic_solve(struct eo_elastic *el, struct eo_loaded_workspace *const ws[2], const struct eo_loaded_gaps *gaps,
                      const struct eo_elastic_case *elastic_case, struct eo_loaded_end *result,
                      struct eo_elastic_report *report)
{
  double lean = eo_double_helix_lean(&el->helix), stiffness = elastic_case->hold.stiffness,
         soft = stiffness > 0 && isfinite(stiffness) ? lean * lean / stiffness : 0;
  *report = (struct eo_elastic_report){0};
  el->shift = elastic_case->hold.shift;
  for (int j = 0; j < el->grid[EO_LEFT]->positions; j++) {
    int at[2] = {j, other_position(el, j, elastic_case->stagger)};
    extrapolate(el, j, elastic_case->stagger);
    int count = solve_position(el, ws, gaps, elastic_case, soft, at, result);
    report->failures += count == 0;
    report->iterations += count;
    report->most_iterations = count > report->most_iterations ? count : report->most_iterations;
    for (int end = 0; end < 2; end++)
      el->history[end][at[end]] = el->deflection[end];
  }
  summarise(el, report);
}

void eo_elastic_gaps(struct eo_elastic *el, const struct eo_loaded_gaps *gaps, int stagger,
                     const struct eo_loaded_end *result, int end, double *bent)
{
  for (int j = 0; j < el->grid[EO_LEFT]->positions; j++) {
    int at[2] = {j, other_position(el, j, stagger)};
    const struct eo_contact_position *position = &el->grid[end]->position[at[end]];
    for (int e = 0; e < el->influence.ends; e++) {
      set_places(el, e, at[e]);
      gather_loads(el, e, at[e], &result[e]);
    }
    eo_shaft_deflect(&el->influence, el->load, el->asked);
    spread(position->points, el->place[end], &el->asked[end], el->change);
    for (int i = 0; i < position->points; i++)
      bent[position->first + i] = gaps[end].gap[position->first + i] + el->change[i];
  }
}

static enum eo_code allocate(struct eo_elastic *el, struct eo_error *error)
{
  int left = el->grid[EO_LEFT]->most_points, right = el->grid[EO_RIGHT]->most_points;
  size_t most = (size_t)(left > right ? left : right), positions = (size_t)el->grid[EO_LEFT]->positions;
  bool complete = (el->change = calloc(most, sizeof(double))) && (el->answer = calloc(most, sizeof(double)));
  for (int end = 0; end < 2; end++)
    complete = complete && (el->gap[end] = calloc((size_t)el->grid[end]->points, sizeof(double))) &&
               (el->place[end] = calloc(most, sizeof(struct place))) &&
               (el->history[end] = calloc(positions, sizeof(struct eo_deflection)));
  return complete ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_elastic_new(struct eo_elastic **result, const struct eo_contact_grid *const grid[2],
                            const struct eo_gear_pair *pair, const struct eo_shafts *shafts, bool inwards,
                            struct eo_error *error)
{
  struct eo_elastic *el = calloc(1, sizeof *el);
  if (!el)
    return eo_error_memory(error);
  memcpy(el->grid, grid, sizeof el->grid);
  el->helix = eo_contact_double_helix(grid[EO_LEFT], grid[EO_RIGHT]);
  enum eo_code code = eo_shaft_influence_init(&el->influence, &grid[EO_LEFT]->geometry, pair, &grid[EO_LEFT]->material,
                                              shafts, inwards, error);
  if (!code)
    code = allocate(el, error);
  if (code)
    eo_elastic_free(el);
  else
    *result = el;
  return code;
}

void eo_elastic_free(struct eo_elastic *el)
{
  if (!el)
    return;
  eo_shaft_influence_done(&el->influence);
  for (int end = 0; end < 2; end++) {
    free(el->gap[end]);
    free(el->place[end]);
    free(el->history[end]);
  }
  free(el->change);
  free(el->answer);
  free(el);
}

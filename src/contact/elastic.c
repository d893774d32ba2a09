#include "contact/elastic.h"

#include "numerics/dense.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MODES = EO_SHAFT_MODES, PART = 2 * EO_DEFLECTION_NODES };

struct eo_elastic {
  const struct eo_contact_grid *grid;
  struct eo_shaft_influence influence;
  double *gap[2];                          /* [end][grid->points] of the bent bodies */
  double *change, *answer;                 /* [most_points] */
  struct eo_deflection deflection[2];      /* [end] at the present position, and what its loads ask for */
  struct eo_deflection asked[2], load[2];
  struct eo_deflection response[MODES][2]; /* H V: load given up per unit of a mode */
  struct eo_deflection shifted[2];         /* load taken on per N of shift */
  double shift;                            /* P_L - P */
  double rate;                             /* d(Z_L - Z_R) / d shift, the support included, m/N */
  struct eo_deflection *history[2];        /* [end][positions] */
};

/* ---- between points and nodes ---- */

/* Where the gap of a point is taken: on the flank that a tip corner meets. */
static double place_of(const struct eo_contact_position *p, int i)
{
  return p->kind[i] == EO_POINT_GEAR_TIP ? p->point[i].s[EO_PINION] : p->point[i].s[EO_GEAR];
}

static void clear(struct eo_deflection *deflection)
{
  memset(deflection, 0, sizeof *deflection);
}

static void gather(const struct eo_elastic *el, const struct eo_contact_position *p, const double *load, struct eo_deflection *nodal)
{
  clear(nodal);
  for (int i = 0; i < p->points; i++)
    if (load[i] != 0)
      eo_shaft_load_add(nodal, el->grid->geometry.face_width, place_of(p, i), p->point[i].eta, load[i]);
}

static void spread(const struct eo_elastic *el, const struct eo_contact_position *p, const struct eo_deflection *deflection, double *change)
{
  for (int i = 0; i < p->points; i++)
    change[i] = eo_deflection_at(deflection, el->grid->geometry.face_width, place_of(p, i), p->point[i].eta);
}

static void gather_loads(struct eo_elastic *el, const struct eo_contact_position *p, const struct eo_loaded_end *end, struct eo_deflection *nodal)
{
  for (int i = 0; i < p->points; i++)
    el->answer[i] = end->line_load[p->first + i] * p->length[i];
  gather(el, p, el->answer, nodal);
}

static double product(const struct eo_deflection *a, const double *b)
{
  const double *x = &a->part[0][0];
  double sum = 0;
  for (int i = 0; i < PART; i++)
    sum += x[i] * b[i];
  return sum;
}

/* Largest gap that a deflection makes anywhere between the ends of the path of contact. */
static double largest(const struct eo_elastic *el, const struct eo_deflection *a, const struct eo_deflection *b)
{
  const struct eo_geometry *g = &el->grid->geometry;
  double most = 0, reach = fmax(-g->path_start, g->path_end);
  for (int i = 0; i < EO_DEFLECTION_NODES; i++)
    most = fmax(most, fabs(a->part[0][i] - b->part[0][i]) + reach * fabs(a->part[1][i] - b->part[1][i]));
  return most;
}

/* ---- one mesh position ---- */

/* Contact of one end at the present deflection, warm: its approach moves with its gaps. */
static void resolve(struct eo_elastic *el, struct eo_loaded_workspace *ws, const struct eo_loaded_gaps *gaps, double factor, int end, int j,
                    double load, bool first, struct eo_loaded_end *result)
{
  const struct eo_contact_position *p = &el->grid->position[j];
  double rise = 0, total = 0;
  spread(el, p, &el->deflection[end], el->change);
  for (int i = 0; i < p->points; i++) {
    double before = first ? gaps->gap[p->first + i] : el->gap[end][p->first + i], force = result->line_load[p->first + i] * p->length[i];
    el->gap[end][p->first + i] = gaps->gap[p->first + i] + el->change[i];
    rise += force * (el->gap[end][p->first + i] - before);
    total += force;
  }
  result->approach[j] += total > 0 ? rise / total : 0;
  eo_loaded_resolve(ws, el->grid, el->gap[end], factor, j, load, result);
}

/* Answer of the end solved last to every mode, and to the shift of load. */
static void respond(struct eo_elastic *el, struct eo_loaded_workspace *ws, double factor, int end, int j)
{
  const struct eo_contact_position *p = &el->grid->position[j];
  for (int k = 0; k < MODES; k++) {
    struct eo_deflection mode;
    memcpy(&mode, el->influence.mode + k * el->influence.size + end * PART, sizeof mode);
    spread(el, p, &mode, el->change);
    eo_loaded_response(ws, p, factor, el->change, el->answer);
    for (int i = 0; i < p->points; i++)
      el->answer[i] = -el->answer[i];
    gather(el, p, el->answer, &el->response[k][end]);
  }
  el->rate += eo_loaded_response(ws, p, factor, NULL, el->answer);
  for (int i = 0; end == EO_RIGHT && i < p->points; i++)
    el->answer[i] = -el->answer[i];
  gather(el, p, el->answer, &el->shifted[end]);
}

/* Newton's correction of the deflection and, when the pinion is held, of the shift: [M, -V'g; g'V, rate] [c; d shift] = -[(HV)'r; miss + g'r]
   with g the load taken on per N of shift (which is also how Z_L - Z_R follows the gaps). */
static void correct(struct eo_elastic *el, bool held, double miss)
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
    matrix[MODES * rows + MODES] = el->rate;
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

/* Iterates at position j of the left end and `other` of the right one, from the deflection of the position before; returns the number of
   iterations, 0 when they did not converge. */
static int solve_position(struct eo_elastic *el, struct eo_loaded_workspace *ws, const struct eo_loaded_gaps *gaps, const struct eo_elastic_case *c,
                          double soft, int j, int other, struct eo_loaded_end *result)
{
  enum { ITERATIONS = 40 };
  static const double DONE = 1e-12;
  int ends = el->influence.ends, at[2] = {j, other};
  bool held = ends == 2 && c->axial_stiffness > 0;
  for (int iteration = 1; iteration <= ITERATIONS; iteration++) {
    double error = 0, miss = 0;
    el->rate = soft;
    el->shift = fmax(-0.999 * c->load, fmin(0.999 * c->load, el->shift));
    for (int end = 0; end < ends; end++) {
      resolve(el, ws, &gaps[end], c->compliance_factor, end, at[end], end == EO_LEFT ? c->load + el->shift : c->load - el->shift, iteration == 1,
              &result[end]);
      respond(el, ws, c->compliance_factor, end, at[end]);
      gather_loads(el, &el->grid->position[at[end]], &result[end], &el->load[end]);
    }
    eo_shaft_deflect(&el->influence, el->load, el->asked);
    for (int end = 0; end < ends; end++)
      error = fmax(error, largest(el, &el->asked[end], &el->deflection[end]));
    if (held)
      miss = result[EO_LEFT].approach[j] - result[EO_RIGHT].approach[other] + soft * el->shift;
    if (error < DONE && fabs(miss) < DONE)
      return iteration;
    correct(el, held, miss);
  }
  return 0;
}

/* ---- the mesh cycle ---- */

static int other_position(const struct eo_elastic *el, int j, int stagger)
{
  int n = el->grid->positions;
  return ((j - stagger) % n + n) % n;
}

static void summarise(const struct eo_elastic *el, struct eo_elastic_report *report)
{
  int n = el->grid->positions;
  for (int end = 0; end < el->influence.ends; end++) {
    double *mean = &report->mean[end].part[0][0];
    for (int j = 0; j < n; j++)
      for (int i = 0; i < PART; i++)
        mean[i] += (&el->history[end][j].part[0][0])[i] / n;
    for (int j = 0; j < n; j++)
      report->change = fmax(report->change, largest(el, &el->history[end][j], &report->mean[end]));
  }
}

void eo_elastic_solve(struct eo_elastic *el, struct eo_loaded_workspace *ws, const struct eo_loaded_gaps *gaps, const struct eo_elastic_case *c,
                      struct eo_loaded_end *result, struct eo_elastic_report *report)
{
  double lean = sin(el->grid->geometry.base_helix_angle);
  double soft = c->axial_stiffness > 0 && isfinite(c->axial_stiffness) ? 4 * lean * lean / c->axial_stiffness : 0;
  *report = (struct eo_elastic_report){0};
  el->shift = 0;
  clear(&el->deflection[EO_LEFT]);
  clear(&el->deflection[EO_RIGHT]);
  for (int j = 0; j < el->grid->positions; j++) {
    int other = other_position(el, j, c->stagger), count = solve_position(el, ws, gaps, c, soft, j, other, result);
    report->failures += count == 0;
    report->iterations += count;
    report->most_iterations = count > report->most_iterations ? count : report->most_iterations;
    el->history[EO_LEFT][j] = el->deflection[EO_LEFT];
    el->history[EO_RIGHT][other] = el->deflection[EO_RIGHT];
  }
  summarise(el, report);
}

void eo_elastic_gaps(struct eo_elastic *el, const struct eo_loaded_gaps *gaps, int stagger, const struct eo_loaded_end *result, int end,
                     double *bent)
{
  for (int j = 0; j < el->grid->positions; j++) {
    int at[2] = {j, other_position(el, j, stagger)};
    const struct eo_contact_position *p = &el->grid->position[at[end]];
    for (int e = 0; e < el->influence.ends; e++)
      gather_loads(el, &el->grid->position[at[e]], &result[e], &el->load[e]);
    eo_shaft_deflect(&el->influence, el->load, el->asked);
    spread(el, p, &el->asked[end], el->change);
    for (int i = 0; i < p->points; i++)
      bent[p->first + i] = gaps[end].gap[p->first + i] + el->change[i];
  }
}

/* ---- storage ---- */

static enum eo_code allocate(struct eo_elastic *el, struct eo_error *error)
{
  size_t points = (size_t)el->grid->points, most = (size_t)el->grid->most_points, positions = (size_t)el->grid->positions;
  bool complete = (el->change = calloc(most, sizeof(double))) && (el->answer = calloc(most, sizeof(double)));
  for (int end = 0; end < 2; end++)
    complete = complete && (el->gap[end] = calloc(points, sizeof(double))) &&
               (el->history[end] = calloc(positions, sizeof(struct eo_deflection)));
  return complete ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_elastic_new(struct eo_elastic **result, const struct eo_contact_grid *grid, const struct eo_gear_pair *pair,
                            const struct eo_shafts *shafts, struct eo_error *error)
{
  struct eo_elastic *el = calloc(1, sizeof *el);
  if (!el)
    return eo_error_memory(error);
  el->grid = grid;
  enum eo_code code = eo_shaft_influence_init(&el->influence, &grid->geometry, pair, &grid->material, shafts, error);
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
    free(el->history[end]);
  }
  free(el->change);
  free(el->answer);
  free(el);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `nsga2`: the Pareto front of the raw objectives, after Deb, Pratap, Agarwal, Meyarivan 2002, with surrogates between
   the generations: each cycle evolves a population on one surrogate per objective (and one of the constraint
   violation), starting from the best true rows, then verifies those of its best that add most to the true front. Only
   true rows count. */
#include "optimizer/optimizer_private.h"
#include "optimizer/operators.h"
#include "optimizer/pareto.h"
#include "optimizer/surrogate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double clip_quantile =
    0.9; /* values above are cut off before the fit: far from the front only order matters */
static const double ridge = 1e-9;
static const double apart = 1e-4; /* / sqrt n: candidates nearer to a true row teach nothing */

struct nsga2 {
  int cycle, size, outputs; /* population; objectives + violation */
  bool modelled;
  struct eo_surrogate surrogate;
  int count;                      /* individuals: parents, then children */
  double *x;                      /* [2 size][n]; owned, as all below */
  double *objective;              /* [2 size][objectives] */
  double *violation;              /* [2 size] */
  double *crowding;               /* [capacity] */
  double *fitness;                /* [size] minus the place in the crowded order */
  double *kept;                   /* scratch for select_best: [size][n + objectives + 1] */
  int *rank, *order, *scratch;    /* [capacity], [capacity], [2 capacity] */
  int capacity;                   /* the larger of 2 size and the rows of the archive */
  double *row_x, *row_y, *sorted; /* [model_rows][n], [outputs][model_rows], [model_rows] */
  double *chosen;                 /* [batch][n] */
  double *reach;                  /* [2 size] distance to the true front and to what is chosen */
};

static void stop(struct eo_optimizer *o)
{
  struct nsga2 *g = o->state;
  if (!g)
    return;
  free(g->x);
  free(g->objective);
  free(g->violation);
  free(g->crowding);
  free(g->fitness);
  free(g->kept);
  free(g->rank);
  free(g->order);
  free(g->scratch);
  free(g->row_x);
  free(g->row_y);
  free(g->sorted);
  free(g->chosen);
  free(g->reach);
  eo_surrogate_done(&g->surrogate);
  free(g);
}

/* Rank and crowding are taken over the population and over the archive, which grows. */
static enum eo_code reserve(struct nsga2 *g, int capacity, struct eo_error *error)
{
  if (capacity <= g->capacity)
    return EO_OK;
  const size_t c = 2 * (size_t)capacity;
  double *crowding = realloc(g->crowding, c * sizeof *crowding);
  if (crowding)
    g->crowding = crowding;
  int *rank = realloc(g->rank, c * sizeof *rank);
  if (rank)
    g->rank = rank;
  int *order = realloc(g->order, c * sizeof *order);
  if (order)
    g->order = order;
  int *scratch = realloc(g->scratch, 2 * c * sizeof *scratch);
  if (scratch)
    g->scratch = scratch;
  if (!crowding || !rank || !order || !scratch)
    return eo_error_memory(error);
  g->capacity = 2 * capacity;
  return EO_OK;
}

static int initial_count(const struct eo_optimizer_settings *s)
{
  return 4 * s->variables > s->front_population ? 4 * s->variables : s->front_population;
}

static enum eo_code start(struct eo_optimizer *o, struct eo_error *error)
{
  const struct eo_optimizer_settings *s = &o->settings;
  struct nsga2 *g = o->state = calloc(1, sizeof *g);
  if (!g)
    return eo_error_memory(error);
  g->size = s->front_population;
  g->outputs = s->objectives + 1;
  const size_t n = (size_t)s->variables, m = (size_t)s->objectives, size = (size_t)g->size,
               rows = (size_t)s->model_rows;
  const size_t initial = (size_t)initial_count(s);
  const size_t batch = (size_t)s->front_verified > initial ? (size_t)s->front_verified : initial;
  g->x = malloc(2 * size * n * sizeof(double));
  g->objective = malloc(2 * size * m * sizeof(double));
  g->violation = malloc(2 * size * sizeof(double));
  g->fitness = malloc(size * sizeof(double));
  g->kept = malloc(size * (n + m + 1) * sizeof(double));
  g->row_x = malloc(rows * n * sizeof(double));
  g->row_y = malloc(rows * (m + 1) * sizeof(double));
  g->sorted = malloc((rows + batch) * sizeof(double));
  g->chosen = malloc(batch * n * sizeof(double));
  g->reach = malloc(2 * size * sizeof(double));
  if (!g->x || !g->objective || !g->violation || !g->fitness || !g->kept || !g->row_x || !g->row_y || !g->sorted ||
      !g->chosen || !g->reach)
    return eo_error_memory(error);
  enum eo_code code = reserve(g, 2 * g->size, error);
  if (code == EO_OK)
    code = eo_surrogate_init(&g->surrogate, s->variables, s->model_rows, g->outputs, EO_TAIL_LINEAR, error);
  return code == EO_OK ? eo_optimizer_reserve_batch(o, (int)batch, error) : code;
}

/* The true rows by rank and crowding into g->order; failed ones, infinitely violating, come last. Returns how many
   have not failed. */
static int order_archive(struct eo_optimizer *o)
{
  struct nsga2 *g = o->state;
  const struct eo_archive *a = &o->archive;
  int usable = 0;
  for (int row = 0; row < a->count; row++)
    usable += !eo_archive_failed(a, row);
  eo_pareto_rank(a->objective, a->violation, a->count, a->objectives, g->rank, g->scratch);
  eo_pareto_crowding(a->objective, g->rank, a->count, a->objectives, g->crowding, g->scratch);
  eo_pareto_order(g->rank, g->crowding, a->count, g->order);
  return usable;
}

static int compare_doubles(const void *a, const void *b)
{
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

static void clip(struct nsga2 *g, double *y, int rows)
{
  memcpy(g->sorted, y, (size_t)rows * sizeof *y);
  qsort(g->sorted, (size_t)rows, sizeof *y, compare_doubles);
  const double limit = g->sorted[(int)(clip_quantile * (rows - 1))];
  for (int j = 0; j < rows; j++)
    y[j] = fmin(y[j], limit);
}

/* One surrogate per objective and one of the violation on the best rows. */
static void fit(struct eo_optimizer *o, int usable)
{
  struct nsga2 *g = o->state;
  const struct eo_archive *a = &o->archive;
  const int n = a->variables, m = a->objectives;
  const int rows = usable < o->settings.model_rows ? usable : o->settings.model_rows;
  for (int j = 0; j < rows; j++) {
    const size_t row = (size_t)g->order[j];
    memcpy(g->row_x + (size_t)j * n, a->x + row * n, (size_t)n * sizeof(double));
    for (int k = 0; k < m; k++)
      g->row_y[k * rows + j] = a->objective[row * m + k];
    g->row_y[m * rows + j] = a->violation[row];
  }
  for (int k = 0; k < g->outputs && rows > 0; k++)
    clip(g, g->row_y + (size_t)k * rows, rows);
  g->modelled = eo_surrogate_fit(&g->surrogate, EO_TAIL_LINEAR, ridge, g->row_x, g->row_y, rows, g->outputs);
}

static void load_parents(struct eo_optimizer *o, int usable)
{
  struct nsga2 *g = o->state;
  const struct eo_archive *a = &o->archive;
  const int n = a->variables, m = a->objectives;
  g->count = usable < g->size ? usable : g->size;
  for (int i = 0; i < g->count; i++) {
    const size_t row = (size_t)g->order[i];
    memcpy(g->x + (size_t)i * n, a->x + row * n, (size_t)n * sizeof(double));
    memcpy(g->objective + (size_t)i * m, a->objective + row * m, (size_t)m * sizeof(double));
    g->violation[i] = a->violation[row];
    g->fitness[i] = -i;
  }
}

static void predict(struct eo_optimizer *o, int i)
{
  struct nsga2 *g = o->state;
  const int m = o->settings.objectives;
  eo_surrogate_visit(&g->surrogate, g->x + (size_t)i * o->settings.variables);
  for (int k = 0; k < m; k++)
    g->objective[(size_t)i * m + k] = eo_surrogate_value(&g->surrogate, k);
  g->violation[i] = fmax(0, eo_surrogate_value(&g->surrogate, m));
}

/* Orders all g->count individuals and keeps the best g->size of them, best first. */
static void select_best(struct eo_optimizer *o)
{
  struct nsga2 *g = o->state;
  const int n = o->settings.variables, m = o->settings.objectives, kept = g->count < g->size ? g->count : g->size;
  double *x = g->kept, *objective = x + (size_t)g->size * n, *violation = objective + (size_t)g->size * m;
  eo_pareto_rank(g->objective, g->violation, g->count, m, g->rank, g->scratch);
  eo_pareto_crowding(g->objective, g->rank, g->count, m, g->crowding, g->scratch);
  eo_pareto_order(g->rank, g->crowding, g->count, g->order);
  for (int i = 0; i < kept; i++) {
    const size_t from = (size_t)g->order[i];
    memcpy(x + (size_t)i * n, g->x + from * n, (size_t)n * sizeof *x);
    memcpy(objective + (size_t)i * m, g->objective + from * m, (size_t)m * sizeof *x);
    violation[i] = g->violation[from];
    g->fitness[i] = -i;
  }
  memcpy(g->x, x, (size_t)kept * (size_t)n * sizeof *x);
  memcpy(g->objective, objective, (size_t)kept * (size_t)m * sizeof *x);
  memcpy(g->violation, violation, (size_t)kept * sizeof *x);
  g->count = kept;
}

static void evolve(struct eo_optimizer *o)
{
  struct nsga2 *g = o->state;
  const int n = o->settings.variables, rounds = g->modelled ? o->settings.front_rounds : 1;
  for (int round = 0; round < rounds; round++) {
    const int parents = g->count;
    eo_breed(&o->settings, g->x, g->fitness, parents, g->cycle * o->settings.front_rounds + round, 0,
             g->x + (size_t)parents * n, g->size);
    g->count += g->size;
    if (!g->modelled)
      return;
    for (int i = parents; i < g->count; i++)
      predict(o, i);
    select_best(o);
  }
}

static bool is_near(const double *points, int count, const double *x, int n, double radius)
{
  for (int j = 0; j < count; j++) {
    double sum = 0;
    for (int k = 0; k < n; k++)
      sum += (points[(size_t)j * n + k] - x[k]) * (points[(size_t)j * n + k] - x[k]);
    if (sum <= radius * radius)
      return true;
  }
  return false;
}

/* Range of every objective over the individuals, for distances between them. */
static void measure_ranges(const struct nsga2 *g, int m, double *range)
{
  for (int k = 0; k < m; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < g->count; i++) {
      low = fmin(low, g->objective[(size_t)i * m + k]);
      high = fmax(high, g->objective[(size_t)i * m + k]);
    }
    range[k] = high > low ? high - low : 1;
  }
}

static void shorten_reach(struct nsga2 *g, int m, const double *range, const double *objective)
{
  for (int i = 0; i < g->count; i++) {
    double sum = 0;
    for (int k = 0; k < m; k++) {
      const double d = (g->objective[(size_t)i * m + k] - objective[k]) / range[k];
      sum += d * d;
    }
    g->reach[i] = fmin(g->reach[i], sum);
  }
}

/* Distance of every individual to the true front; true rows themselves and their close neighbours are ruled out. */
static void start_reach(struct eo_optimizer *o, const int *front, int front_count, const double *range)
{
  struct nsga2 *g = o->state;
  const int n = o->settings.variables, m = o->settings.objectives;
  for (int i = 0; i < g->count; i++)
    g->reach[i] = INFINITY;
  for (int f = 0; f < front_count; f++)
    shorten_reach(g, m, range, o->archive.objective + (size_t)front[f] * m);
  for (int i = 0; i < g->count; i++)
    if (is_near(o->archive.x, o->archive.count, g->x + (size_t)i * n, n, apart * sqrt(n)))
      g->reach[i] = -1;
}

/* Of the individuals whose prediction nothing dominates, those farthest from the true front and from each other; then
   of the next rank. Without surrogates the children as they come. */
static int choose(struct eo_optimizer *o, const int *front, int front_count, int parents)
{
  struct nsga2 *g = o->state;
  const int n = o->settings.variables, m = o->settings.objectives, limit = o->settings.front_verified;
  int chosen = 0;
  if (!g->modelled) {
    for (int i = parents; i < g->count && chosen < limit; i++)
      memcpy(g->chosen + (size_t)chosen++ * n, g->x + (size_t)i * n, (size_t)n * sizeof(double));
    return chosen;
  }
  double range[EO_MAX_OBJECTIVES];
  measure_ranges(g, m, range);
  start_reach(o, front, front_count, range);
  eo_pareto_rank(g->objective, g->violation, g->count, m, g->rank, g->scratch);
  while (chosen < limit) {
    int best = -1;
    for (int i = 0; i < g->count; i++)
      if (g->reach[i] >= 0 &&
          (best < 0 || g->rank[i] < g->rank[best] || (g->rank[i] == g->rank[best] && g->reach[i] > g->reach[best])))
        best = i;
    if (best < 0)
      break;
    memcpy(g->chosen + (size_t)chosen++ * n, g->x + (size_t)best * n, (size_t)n * sizeof(double));
    shorten_reach(g, m, range, g->objective + (size_t)best * m);
    g->reach[best] = -1;
    for (int i = 0; i < g->count; i++)
      if (is_near(g->chosen, chosen, g->x + (size_t)i * n, n, apart * sqrt(n)))
        g->reach[i] = -1;
  }
  return chosen;
}

static int propose_cycle(struct eo_optimizer *o, int *front)
{
  struct nsga2 *g = o->state;
  const int usable = order_archive(o);
  if (usable == 0)
    return 0;
  int front_count = 0;
  for (int i = 0; i < usable && g->rank[g->order[i]] == 0; i++)
    front[front_count++] = g->order[i];
  load_parents(o, usable);
  fit(o, usable);
  const int parents = g->count;
  evolve(o);
  return choose(o, front, front_count, parents);
}

static void request(struct eo_optimizer *o, int count)
{
  struct nsga2 *g = o->state;
  bool known;
  for (int i = 0; i < count; i++)
    if (eo_optimizer_request(o, g->chosen + (size_t)i * o->settings.variables, g->cycle, i, false, &known) < 0)
      return;
}

/* A new latin hypercube: at the start, and whenever the population has nothing new to offer. */
static void request_latin(struct eo_optimizer *o)
{
  struct nsga2 *g = o->state;
  const int count = g->cycle == 0 ? initial_count(&o->settings) : o->settings.front_verified;
  eo_latin_hypercube(g->chosen, count, o->settings.variables, o->settings.seed, g->cycle, g->sorted);
  request(o, count);
}

static enum eo_code propose(struct eo_optimizer *o, struct eo_error *error)
{
  struct nsga2 *g = o->state;
  if (eo_optimizer_left(o) <= 0) {
    o->finished = true;
    return EO_OK;
  }
  if (g->cycle > 0) {
    const enum eo_code code = reserve(g, o->archive.count, error);
    int *front = code == EO_OK ? malloc((size_t)o->archive.count * sizeof *front) : NULL;
    if (!front)
      return code == EO_OK ? eo_error_memory(error) : code;
    request(o, propose_cycle(o, front));
    free(front);
  }
  if (o->batch_count == 0)
    request_latin(o);
  o->finished = o->batch_count == 0;
  return EO_OK;
}

static enum eo_code absorb(struct eo_optimizer *o, struct eo_error *error)
{
  struct nsga2 *g = o->state;
  const struct eo_generation statistics = {.true_count = o->batch_count};
  g->cycle++;
  return eo_optimizer_close_generation(o, &statistics, error);
}

const struct eo_algorithm_functions eo_nsga2_algorithm = {start, propose, absorb, stop};

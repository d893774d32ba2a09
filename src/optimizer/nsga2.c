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

#include "base/sort.h"

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

static void stop(struct eo_optimizer *optimizer)
{
  struct nsga2 *nsga2 = optimizer->state;
  if (!nsga2)
    return;
  free(nsga2->x);
  free(nsga2->objective);
  free(nsga2->violation);
  free(nsga2->crowding);
  free(nsga2->fitness);
  free(nsga2->kept);
  free(nsga2->rank);
  free(nsga2->order);
  free(nsga2->scratch);
  free(nsga2->row_x);
  free(nsga2->row_y);
  free(nsga2->sorted);
  free(nsga2->chosen);
  free(nsga2->reach);
  eo_surrogate_done(&nsga2->surrogate);
  free(nsga2);
}

/* Rank and crowding are taken over the population and over the archive, which grows. */
static enum eo_code reserve(struct nsga2 *nsga2, int capacity, struct eo_error *error)
{
  if (capacity <= nsga2->capacity)
    return EO_OK;
  const size_t c = 2 * (size_t)capacity;
  double *crowding = realloc(nsga2->crowding, c * sizeof *crowding);
  if (crowding)
    nsga2->crowding = crowding;
  int *rank = realloc(nsga2->rank, c * sizeof *rank);
  if (rank)
    nsga2->rank = rank;
  int *order = realloc(nsga2->order, c * sizeof *order);
  if (order)
    nsga2->order = order;
  int *scratch = realloc(nsga2->scratch, 2 * c * sizeof *scratch);
  if (scratch)
    nsga2->scratch = scratch;
  if (!crowding || !rank || !order || !scratch)
    return eo_error_memory(error);
  nsga2->capacity = 2 * capacity;
  return EO_OK;
}

static int initial_count(const struct eo_optimizer_settings *settings)
{
  return 4 * settings->variables > settings->front_population ? 4 * settings->variables : settings->front_population;
}

static enum eo_code start(struct eo_optimizer *optimizer, struct eo_error *error)
{
  const struct eo_optimizer_settings *settings = &optimizer->settings;
  struct nsga2 *nsga2 = optimizer->state = calloc(1, sizeof *nsga2);
  if (!nsga2)
    return eo_error_memory(error);
  nsga2->size = settings->front_population;
  nsga2->outputs = settings->objectives + 1;
  const size_t n = (size_t)settings->variables, m = (size_t)settings->objectives, size = (size_t)nsga2->size,
               rows = (size_t)settings->model_rows;
  const size_t initial = (size_t)initial_count(settings);
  const size_t batch = (size_t)settings->front_verified > initial ? (size_t)settings->front_verified : initial;
  nsga2->x = malloc(2 * size * n * sizeof(double));
  nsga2->objective = malloc(2 * size * m * sizeof(double));
  nsga2->violation = malloc(2 * size * sizeof(double));
  nsga2->fitness = malloc(size * sizeof(double));
  nsga2->kept = malloc(size * (n + m + 1) * sizeof(double));
  nsga2->row_x = malloc(rows * n * sizeof(double));
  nsga2->row_y = malloc(rows * (m + 1) * sizeof(double));
  nsga2->sorted = malloc((rows + batch) * sizeof(double));
  nsga2->chosen = malloc(batch * n * sizeof(double));
  nsga2->reach = malloc(2 * size * sizeof(double));
  if (!nsga2->x || !nsga2->objective || !nsga2->violation || !nsga2->fitness || !nsga2->kept || !nsga2->row_x ||
      !nsga2->row_y || !nsga2->sorted || !nsga2->chosen || !nsga2->reach)
    return eo_error_memory(error);
  enum eo_code code = reserve(nsga2, 2 * nsga2->size, error);
  if (code == EO_OK)
    code = eo_surrogate_init(&nsga2->surrogate, settings->variables, settings->model_rows, nsga2->outputs,
                             EO_TAIL_LINEAR, error);
  return code == EO_OK ? eo_optimizer_reserve_batch(optimizer, (int)batch, error) : code;
}

/* The true rows by rank and crowding into g->order; failed ones, infinitely violating, come last. Returns how many
   have not failed. */
static int order_archive(struct eo_optimizer *optimizer)
{
  struct nsga2 *nsga2 = optimizer->state;
  const struct eo_archive *archive = &optimizer->archive;
  int usable = 0;
  for (int row = 0; row < archive->count; row++)
    usable += !eo_archive_failed(archive, row);
  eo_pareto_rank(archive->objective, archive->violation, archive->count, archive->objectives, nsga2->rank,
                 nsga2->scratch);
  eo_pareto_crowding(archive->objective, nsga2->rank, archive->count, archive->objectives, nsga2->crowding,
                     nsga2->scratch);
  eo_pareto_order(nsga2->rank, nsga2->crowding, archive->count, nsga2->order);
  return usable;
}

static void clip(struct nsga2 *nsga2, double *y, int rows)
{
  memcpy(nsga2->sorted, y, (size_t)rows * sizeof *y);
  eo_sort_numbers(rows, nsga2->sorted);
  const double limit = nsga2->sorted[(int)(clip_quantile * (rows - 1))];
  for (int j = 0; j < rows; j++)
    y[j] = fmin(y[j], limit);
}

/* One surrogate per objective and one of the violation on the best rows. */
static void fit(struct eo_optimizer *optimizer, int usable)
{
  struct nsga2 *nsga2 = optimizer->state;
  const struct eo_archive *archive = &optimizer->archive;
  const int n = archive->variables, m = archive->objectives;
  const int rows = usable < optimizer->settings.model_rows ? usable : optimizer->settings.model_rows;
  for (int j = 0; j < rows; j++) {
    const size_t row = (size_t)nsga2->order[j];
    memcpy(nsga2->row_x + (size_t)j * n, archive->x + row * n, (size_t)n * sizeof(double));
    for (int k = 0; k < m; k++)
      nsga2->row_y[k * rows + j] = archive->objective[row * m + k];
    nsga2->row_y[m * rows + j] = archive->violation[row];
  }
  for (int k = 0; k < nsga2->outputs && rows > 0; k++)
    clip(nsga2, nsga2->row_y + (size_t)k * rows, rows);
  nsga2->modelled = eo_surrogate_fit(&nsga2->surrogate, EO_TAIL_LINEAR, ridge, nsga2->row_x, nsga2->row_y, rows,
                                     nsga2->outputs);
}

static void load_parents(struct eo_optimizer *optimizer, int usable)
{
  struct nsga2 *nsga2 = optimizer->state;
  const struct eo_archive *archive = &optimizer->archive;
  const int n = archive->variables, m = archive->objectives;
  nsga2->count = usable < nsga2->size ? usable : nsga2->size;
  for (int i = 0; i < nsga2->count; i++) {
    const size_t row = (size_t)nsga2->order[i];
    memcpy(nsga2->x + (size_t)i * n, archive->x + row * n, (size_t)n * sizeof(double));
    memcpy(nsga2->objective + (size_t)i * m, archive->objective + row * m, (size_t)m * sizeof(double));
    nsga2->violation[i] = archive->violation[row];
    nsga2->fitness[i] = -i;
  }
}

static void predict(struct eo_optimizer *optimizer, int i)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int m = optimizer->settings.objectives;
  eo_surrogate_visit(&nsga2->surrogate, nsga2->x + (size_t)i * optimizer->settings.variables);
  for (int k = 0; k < m; k++)
    nsga2->objective[(size_t)i * m + k] = eo_surrogate_value(&nsga2->surrogate, k);
  nsga2->violation[i] = fmax(0, eo_surrogate_value(&nsga2->surrogate, m));
}

/* Orders all g->count individuals and keeps the best g->size of them, best first. */
static void select_best(struct eo_optimizer *optimizer)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int n = optimizer->settings.variables, m = optimizer->settings.objectives,
            kept = nsga2->count < nsga2->size ? nsga2->count : nsga2->size;
  double *x = nsga2->kept, *objective = x + (size_t)nsga2->size * n, *violation = objective + (size_t)nsga2->size * m;
  eo_pareto_rank(nsga2->objective, nsga2->violation, nsga2->count, m, nsga2->rank, nsga2->scratch);
  eo_pareto_crowding(nsga2->objective, nsga2->rank, nsga2->count, m, nsga2->crowding, nsga2->scratch);
  eo_pareto_order(nsga2->rank, nsga2->crowding, nsga2->count, nsga2->order);
  for (int i = 0; i < kept; i++) {
    const size_t from = (size_t)nsga2->order[i];
    memcpy(x + (size_t)i * n, nsga2->x + from * n, (size_t)n * sizeof *x);
    memcpy(objective + (size_t)i * m, nsga2->objective + from * m, (size_t)m * sizeof *x);
    violation[i] = nsga2->violation[from];
    nsga2->fitness[i] = -i;
  }
  memcpy(nsga2->x, x, (size_t)kept * (size_t)n * sizeof *x);
  memcpy(nsga2->objective, objective, (size_t)kept * (size_t)m * sizeof *x);
  memcpy(nsga2->violation, violation, (size_t)kept * sizeof *x);
  nsga2->count = kept;
}

static void evolve(struct eo_optimizer *optimizer)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int n = optimizer->settings.variables, rounds = nsga2->modelled ? optimizer->settings.front_rounds : 1;
  for (int round = 0; round < rounds; round++) {
    const int parents = nsga2->count;
    eo_breed(&optimizer->settings, nsga2->x, nsga2->fitness, parents,
             nsga2->cycle * optimizer->settings.front_rounds + round, 0, nsga2->x + (size_t)parents * n, nsga2->size);
    nsga2->count += nsga2->size;
    if (!nsga2->modelled)
      return;
    for (int i = parents; i < nsga2->count; i++)
      predict(optimizer, i);
    select_best(optimizer);
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
static void measure_ranges(const struct nsga2 *nsga2, int m, double *range)
{
  for (int k = 0; k < m; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < nsga2->count; i++) {
      low = fmin(low, nsga2->objective[(size_t)i * m + k]);
      high = fmax(high, nsga2->objective[(size_t)i * m + k]);
    }
    range[k] = high > low ? high - low : 1;
  }
}

static void shorten_reach(struct nsga2 *nsga2, int m, const double *range, const double *objective)
{
  for (int i = 0; i < nsga2->count; i++) {
    double sum = 0;
    for (int k = 0; k < m; k++) {
      const double d = (nsga2->objective[(size_t)i * m + k] - objective[k]) / range[k];
      sum += d * d;
    }
    nsga2->reach[i] = fmin(nsga2->reach[i], sum);
  }
}

/* Distance of every individual to the true front; true rows themselves and their close neighbours are ruled out. */
static void start_reach(struct eo_optimizer *optimizer, const int *front, int front_count, const double *range)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int n = optimizer->settings.variables, m = optimizer->settings.objectives;
  for (int i = 0; i < nsga2->count; i++)
    nsga2->reach[i] = INFINITY;
  for (int f = 0; f < front_count; f++)
    shorten_reach(nsga2, m, range, optimizer->archive.objective + (size_t)front[f] * m);
  for (int i = 0; i < nsga2->count; i++)
    if (is_near(optimizer->archive.x, optimizer->archive.count, nsga2->x + (size_t)i * n, n, apart * sqrt(n)))
      nsga2->reach[i] = -1;
}

/* Of the individuals whose prediction nothing dominates, those farthest from the true front and from each other; then
   of the next rank. Without surrogates the children as they come. */
static int choose(struct eo_optimizer *optimizer, const int *front, int front_count, int parents)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int n = optimizer->settings.variables, m = optimizer->settings.objectives,
            limit = optimizer->settings.front_verified;
  int chosen = 0;
  if (!nsga2->modelled) {
    for (int i = parents; i < nsga2->count && chosen < limit; i++)
      memcpy(nsga2->chosen + (size_t)chosen++ * n, nsga2->x + (size_t)i * n, (size_t)n * sizeof(double));
    return chosen;
  }
  double range[EO_MAX_OBJECTIVES];
  measure_ranges(nsga2, m, range);
  start_reach(optimizer, front, front_count, range);
  eo_pareto_rank(nsga2->objective, nsga2->violation, nsga2->count, m, nsga2->rank, nsga2->scratch);
  while (chosen < limit) {
    int best = -1;
    for (int i = 0; i < nsga2->count; i++)
      if (nsga2->reach[i] >= 0 && (best < 0 || nsga2->rank[i] < nsga2->rank[best] ||
                                   (nsga2->rank[i] == nsga2->rank[best] && nsga2->reach[i] > nsga2->reach[best])))
        best = i;
    if (best < 0)
      break;
    memcpy(nsga2->chosen + (size_t)chosen++ * n, nsga2->x + (size_t)best * n, (size_t)n * sizeof(double));
    shorten_reach(nsga2, m, range, nsga2->objective + (size_t)best * m);
    nsga2->reach[best] = -1;
    for (int i = 0; i < nsga2->count; i++)
      if (is_near(nsga2->chosen, chosen, nsga2->x + (size_t)i * n, n, apart * sqrt(n)))
        nsga2->reach[i] = -1;
  }
  return chosen;
}

static int propose_cycle(struct eo_optimizer *optimizer, int *front)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int usable = order_archive(optimizer);
  if (usable == 0)
    return 0;
  int front_count = 0;
  for (int i = 0; i < usable && nsga2->rank[nsga2->order[i]] == 0; i++)
    front[front_count++] = nsga2->order[i];
  load_parents(optimizer, usable);
  fit(optimizer, usable);
  const int parents = nsga2->count;
  evolve(optimizer);
  return choose(optimizer, front, front_count, parents);
}

static void request(struct eo_optimizer *optimizer, int count)
{
  struct nsga2 *nsga2 = optimizer->state;
  bool known;
  for (int i = 0; i < count; i++)
    if (eo_optimizer_request(optimizer, nsga2->chosen + (size_t)i * optimizer->settings.variables, nsga2->cycle, i,
                             false, &known) < 0)
      return;
}

/* A new latin hypercube: at the start, and whenever the population has nothing new to offer. */
static void request_latin(struct eo_optimizer *optimizer)
{
  struct nsga2 *nsga2 = optimizer->state;
  const int count = nsga2->cycle == 0 ? initial_count(&optimizer->settings) : optimizer->settings.front_verified;
  eo_latin_hypercube(nsga2->chosen, count, optimizer->settings.variables, optimizer->settings.seed, nsga2->cycle,
                     nsga2->sorted);
  request(optimizer, count);
}

static enum eo_code propose(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct nsga2 *nsga2 = optimizer->state;
  if (eo_optimizer_left(optimizer) <= 0) {
    optimizer->finished = true;
    return EO_OK;
  }
  if (nsga2->cycle > 0) {
    const enum eo_code code = reserve(nsga2, optimizer->archive.count, error);
    int *front = code == EO_OK ? malloc((size_t)optimizer->archive.count * sizeof *front) : NULL;
    if (!front)
      return code == EO_OK ? eo_error_memory(error) : code;
    request(optimizer, propose_cycle(optimizer, front));
    free(front);
  }
  if (optimizer->batch_count == 0)
    request_latin(optimizer);
  optimizer->finished = optimizer->batch_count == 0;
  return EO_OK;
}

static enum eo_code absorb(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct nsga2 *nsga2 = optimizer->state;
  const struct eo_generation statistics = {.true_count = optimizer->batch_count};
  nsga2->cycle++;
  return eo_optimizer_close_generation(optimizer, &statistics, error);
}

const struct eo_algorithm_functions eo_nsga2_algorithm = {start, propose, absorb, stop};

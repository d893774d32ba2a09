/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/member_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Unknowns of the sector that are wanted, in the order in which the solver keeps them. */
struct wanted {
  int *unknown; /* [count] */
  int count;
  int next[2]; /* first of the normal displacements of pair k - 1, k + 1; before them those of the root */
  int flank;   /* first of the normal displacements of the loaded flank, the last of all */
};

static enum eo_code list_wanted(const struct eo_sector *sector, struct wanted *wanted)
{
  const struct eo_section *section = sector->section;
  int across = sector->layers + 1, nodes = 3 * section->root_nodes + section->flank.count +
                                           section->next_flank[0].count + section->next_flank[1].count;
  *wanted = (struct wanted){.unknown = malloc((size_t)(nodes * across) * sizeof *wanted->unknown)};
  if (!wanted->unknown)
    return EO_ERROR_MEMORY;
  wanted->count = eo_member_list_root(sector, section->root_nodes, wanted->unknown);
  for (int k = 0; k < 2; k++) {
    wanted->next[k] = wanted->count;
    wanted->count += eo_member_list_flank(sector, &section->next_flank[k], wanted->unknown + wanted->count);
  }
  wanted->flank = wanted->count;
  wanted->count += eo_member_list_flank(sector, &section->flank, wanted->unknown + wanted->count);
  return EO_OK;
}

/* Splits the inverse, one row per load (pair k - 1, pair k + 1, the tooth itself), into the results. */
static enum eo_code split_inverse(struct eo_member_job *job, const struct wanted *wanted, const double *inverse)
{
  struct eo_member_result *member = job->result;
  const struct eo_section *section = &job->section;
  int across = member->layers + 1, flank = member->rows * across, next = member->next_rows * across;
  size_t stresses = (size_t)member->root_points * across * EO_STRESSES;
  struct eo_stress_operator operator= {0};
  double *displacement = malloc((size_t)(section->root_nodes * across * 3) * sizeof *displacement);
  enum eo_code code = eo_stress_operator_init(&operator, & job->sector, job->material, job->error);
  if (!displacement)
    code = EO_ERROR_MEMORY;
  for (int load = 0; load < wanted->count - wanted->next[0] && !code; load++) {
    const double *kept = inverse + (size_t)load * (size_t)wanted->count;
    int own = load - (wanted->flank - wanted->next[0]), side = load >= next;
    double *stress = own >= 0 ? member->stress + (size_t)own * stresses
                              : member->next_stress[side] + (size_t)(load - side * next) * stresses;
    eo_member_root_displacement(&job->sector, section->root_nodes, kept, kept + wanted->flank, displacement);
    eo_stress_operator_apply(&operator, displacement, stress);
    if (own < 0)
      continue;
    memcpy(member->full + (size_t)own * (size_t)flank, kept + wanted->flank, (size_t)flank * sizeof *kept);
    for (int k = 0; k < 2; k++)
      memcpy(member->next[k] + (size_t)own * (size_t)next, kept + wanted->next[k], (size_t)next * sizeof *kept);
  }
  eo_stress_operator_done(&operator);
  free(displacement);
  return code;
}

static enum eo_code invert(struct eo_member_job *job, struct wanted *wanted, struct eo_sparse_factor **factor,
                           double **inverse)
{
  const struct eo_sector *sector = &job->sector;
  struct eo_member_times *times = job->times;
  EO_TRY(list_wanted(sector, wanted));
  EO_TRY(eo_member_report(job, "ordering", 0.05));
  double start = eo_member_now();
  EO_TRY(eo_sparse_analyse(&sector->matrix, sector->group, sector->groups, wanted->unknown, wanted->count, factor,
                           job->error));
  times->ordering = eo_member_lap(&start);
  EO_TRY(eo_member_report(job, "factorisation", 0.15));
  EO_TRY(eo_sparse_factorise(*factor, job->error));
  times->factorisation = eo_member_lap(&start);
  EO_TRY(eo_member_report(job, "compliance", 0.85));
  times->unknowns = sector->matrix.n;
  times->entries = eo_sparse_entries(*factor);
  times->memory = (double)eo_sparse_peak_memory(*factor);
  int loaded = wanted->count - wanted->next[0];
  *inverse = malloc((size_t)loaded * (size_t)wanted->count * sizeof **inverse);
  if (!*inverse)
    return EO_ERROR_MEMORY;
  EO_TRY(eo_sparse_inverse(*factor, loaded, *inverse, job->error));
  times->compliance = eo_member_lap(&start);
  EO_TRY(split_inverse(job, wanted, *inverse));
  times->stress = eo_member_lap(&start);
  return EO_OK;
}

static enum eo_code solve_sector(struct eo_member_job *job)
{
  struct wanted wanted = {0};
  struct eo_sparse_factor *factor = NULL;
  double *inverse = NULL;
  enum eo_code code = invert(job, &wanted, &factor, &inverse);
  eo_sparse_factor_free(factor);
  free(inverse);
  free(wanted.unknown);
  return code;
}

static enum eo_code solve_whole(struct eo_member_job *job)
{
  double start = eo_member_now();
  EO_TRY(eo_sector_init(&job->sector, &job->section, job->settings->layers, job->geometry->member_width[job->member],
                        eo_sector_twist(job->geometry, job->member), job->material, EO_WHOLE_SECTOR, job->error));
  job->times->mesh += eo_member_lap(&start);
  return job->settings->section.open ? eo_member_solve_ring(job) : solve_sector(job);
}

/* Room of the half tooth. */
struct half {
  struct eo_sector sector;
  struct eo_sparse_factor *factor;
  int *keep, *place; /* unknowns of the flank, and where on it each stands: [flank] */
  double *inverse;   /* [flank][flank] */
};

static enum eo_code invert_half(struct eo_member_job *job, struct half *half)
{
  int across = job->result->layers + 1, flank = job->result->rows * across, kept = 0;
  half->keep = malloc((size_t)flank * sizeof *half->keep);
  half->place = malloc((size_t)flank * sizeof *half->place);
  half->inverse = malloc((size_t)flank * (size_t)flank * sizeof *half->inverse);
  if (!half->keep || !half->place || !half->inverse)
    return EO_ERROR_MEMORY;
  EO_TRY(eo_sector_init(&half->sector, &job->section, job->settings->layers, job->geometry->member_width[job->member],
                        eo_sector_twist(job->geometry, job->member), job->material, EO_HALF_TOOTH, job->error));
  for (int i = 0; i < flank; i++) {
    int unknown = eo_sector_unknown(&half->sector, job->section.flank.node[i / across], i % across, 0);
    half->place[kept] = i;
    if (unknown >= 0)
      half->keep[kept++] = unknown;
  }
  EO_TRY(eo_sparse_analyse(&half->sector.matrix, half->sector.group, half->sector.groups, half->keep, kept,
                           &half->factor, job->error));
  EO_TRY(eo_sparse_factorise(half->factor, job->error));
  EO_TRY(eo_sparse_inverse(half->factor, kept, half->inverse, job->error));
  for (int i = 0; i < kept; i++)
    for (int j = 0; j < kept; j++)
      job->result->half[half->place[i] * flank + half->place[j]] =
          0.5 * (half->inverse[i * kept + j] + half->inverse[j * kept + i]);
  return EO_OK;
}

/* Compliance of the half tooth; rows whose nodes it holds stay 0. */
static enum eo_code solve_half(struct eo_member_job *job)
{
  struct half half = {0};
  enum eo_code code = invert_half(job, &half);
  eo_sparse_factor_free(half.factor);
  eo_sector_done(&half.sector);
  free(half.keep);
  free(half.place);
  free(half.inverse);
  return code;
}

static void symmetrise(double *matrix, int n)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      matrix[i * n + j] = matrix[j * n + i] = 0.5 * (matrix[i * n + j] + matrix[j * n + i]);
}

/* Places of the rows and of the root's nodes. */
static void fill_places(struct eo_member_result *member, const struct eo_section *section, bool ring)
{
  const struct eo_flank_nodes *next = ring ? &section->flank : &section->next_flank[0];
  int step = ring ? eo_member_row_step(member->rows) : 1;
  memcpy(member->s, section->flank.s, (size_t)member->rows * sizeof *member->s);
  for (int row = 0; row < member->next_rows; row++)
    member->next_s[row] = next->s[row * step];
  for (int i = 0; i < member->root_points; i++) {
    const double *point = section->point + 2 * section->root[i + 1], *before = section->point + 2 * section->root[i];
    memcpy(member->root + 2 * i, point, 2 * sizeof *point);
    member->arc[i] = (i ? member->arc[i - 1] : 0) + hypot(point[0] - before[0], point[1] - before[1]);
  }
}

static enum eo_code allocate(struct eo_member_job *job)
{
  struct eo_member_result *member = job->result;
  const struct eo_section *section = &job->section;
  bool ring = job->settings->section.open;
  int rows = section->flank.count;
  size_t across = (size_t)job->settings->layers + 1;
  *member = (struct eo_member_result){.rows = rows,
                                      .coupled_rows = ring ? rows : section->next_flank[0].count,
                                      .next_rows = ring ? (rows - 1) / eo_member_row_step(rows) + 1
                                                        : section->next_flank[0].count,
                                      .layers = job->settings->layers,
                                      .root_points = section->root_nodes - 2,
                                      .reach = job->settings->reach};
  size_t flank = (size_t)rows * across, next = (size_t)member->next_rows * across, reach = (size_t)member->reach;
  size_t coupled = (size_t)member->coupled_rows * across, stresses = (size_t)member->root_points * across * EO_STRESSES;
  member->s = malloc((size_t)rows * sizeof *member->s);
  member->next_s = malloc((size_t)member->next_rows * sizeof *member->next_s + 1);
  member->root = malloc((size_t)member->root_points * 2 * sizeof *member->root);
  member->arc = malloc((size_t)member->root_points * sizeof *member->arc);
  member->full = calloc(flank * flank, sizeof *member->full);
  member->half = calloc(flank * flank, sizeof *member->half);
  member->stress = malloc(flank * stresses * sizeof *member->stress);
  int complete = member->s && member->next_s && member->root && member->arc && member->full && member->half &&
                 member->stress;
  for (int k = 0; k < 2; k++) {
    member->next[k] = malloc(reach * flank * coupled * sizeof(double) + 1);
    member->next_stress[k] = malloc(reach * next * stresses * sizeof(double) + 1);
    member->part[k] = calloc((size_t)rows, sizeof *member->part[k]);
    complete = complete && member->next[k] && member->next_stress[k] && member->part[k];
  }
  if (!complete)
    return EO_ERROR_MEMORY;
  fill_places(member, section, ring);
  return EO_OK;
}

static enum eo_code compute(struct eo_member_job *job)
{
  struct eo_member_result *result = job->result;
  double start = eo_member_now();
  EO_TRY(eo_section_init(&job->section, job->geometry, job->member, job->settings->bore_radius, &job->settings->section,
                         job->error));
  EO_TRY(allocate(job));
  job->times->mesh = eo_member_lap(&start);
  EO_TRY(solve_whole(job));
  start = eo_member_now();
  EO_TRY(eo_member_report(job, "half tooth", 0.95));
  EO_TRY(solve_half(job));
  job->times->half_tooth = eo_member_lap(&start);
  symmetrise(result->full, result->rows * (result->layers + 1));
  return EO_OK;
}

enum eo_code eo_member_compute(struct eo_member_result *result, const struct eo_geometry *geometry, int member,
                               const struct eo_material *material, const struct eo_member_settings *settings,
                               const struct eo_progress *progress, struct eo_member_times *times,
                               struct eo_error *error)
{
  struct eo_member_job job = {.result = result,
                              .geometry = geometry,
                              .material = material,
                              .settings = settings,
                              .progress = progress,
                              .times = times,
                              .error = error,
                              .member = member};
  *result = (struct eo_member_result){0};
  *times = (struct eo_member_times){0};
  enum eo_code code = compute(&job);
  eo_sector_done(&job.sector);
  eo_section_done(&job.section);
  if (code)
    eo_member_result_done(result);
  return code == EO_ERROR_MEMORY ? eo_error_memory(error) : code;
}

void eo_member_result_done(struct eo_member_result *result)
{
  if (!result)
    return;
  free(result->s);
  free(result->next_s);
  free(result->root);
  free(result->arc);
  free(result->full);
  free(result->half);
  free(result->stress);
  for (int k = 0; k < 2; k++) {
    free(result->next[k]);
    free(result->next_stress[k]);
    free(result->part[k]);
  }
  *result = (struct eo_member_result){0};
}

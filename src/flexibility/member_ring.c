/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/parallel.h"
#include "flexibility/member_private.h"
#include "flexibility/ring.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gear/names.h"

/* Unknowns of the tooth in the order in which the solver keeps them: root, flank, left face, right face. The root's
   last node lies on the right face and is not repeated. */
struct kept {
  int *unknown; /* [root + flank + 2 face] */
  int root, flank, face;
  int *direction; /* [face]: 0, 1, 2 */
  int *node;      /* [face]: place along the cut, from the root inwards */
  int *layer;     /* [face] */
};

static void kept_done(struct kept *kept)
{
  free(kept->unknown);
  free(kept->direction);
  free(kept->node);
  free(kept->layer);
}

static int list_cut(const struct eo_sector *sector, int side, int *unknown, struct kept *kept)
{
  const struct eo_section *section = sector->section;
  int count = 0;
  for (int i = 0; i < section->cut_nodes; i++)
    for (int l = 0; l <= sector->layers; l++)
      for (int c = 0; c < 3; c++) {
        int number = eo_sector_unknown(sector, section->cut[side][i], l, c);
        if (number < 0)
          continue;
        kept->direction[count] = c;
        kept->node[count] = i;
        kept->layer[count] = l;
        unknown[count++] = number;
      }
  return count;
}

static enum eo_code list_kept(const struct eo_sector *sector, struct kept *kept)
{
  const struct eo_section *section = sector->section;
  size_t across = (size_t)sector->layers + 1, face = 3 * (size_t)section->cut_nodes * across;
  size_t inner = (size_t)(3 * section->root_nodes + section->flank.count) * across;
  *kept = (struct kept){.unknown = malloc(sizeof(int) * (inner + 2 * face)),
                        .direction = malloc(sizeof(int) * face),
                        .node = malloc(sizeof(int) * face),
                        .layer = malloc(sizeof(int) * face)};
  if (!kept->unknown || !kept->direction || !kept->node || !kept->layer)
    return EO_ERROR_MEMORY;
  kept->root = eo_member_list_root(sector, section->root_nodes - 1, kept->unknown);
  kept->flank = eo_member_list_flank(sector, &section->flank, kept->unknown + kept->root);
  int *faces = kept->unknown + kept->root + kept->flank;
  kept->face = list_cut(sector, 0, faces, kept);
  list_cut(sector, 1, faces + kept->face, kept);
  return EO_OK;
}

/* The rigid motion of harmonic k at a node, in the frame of its layer: the rotation (-y, x), or the translation
   (1, -i), whose components in a frame turned clockwise by an angle are exp(i angle) times those before. */
static void rigid_motion(const struct eo_sector *sector, int k, int node, int layer, double complex motion[3])
{
  const double *point = sector->section->point + 2 * node;
  double angle = sector->twist * sector->width * ((double)layer / sector->layers - 0.5);
  double complex turned = cos(angle) - I * sin(angle);
  motion[0] = k == 0 ? -point[1] : turned;
  motion[1] = k == 0 ? point[0] : -I * turned;
  motion[2] = 0;
}

/* Weights and rigid motions of the left face and the flank. */
static enum eo_code set_rigid(const struct eo_member_job *job, const struct kept *kept, struct eo_ring_tooth *tooth)
{
  const struct eo_sector *sector = &job->sector;
  const struct eo_section *section = &job->section;
  int across = sector->layers + 1;
  double *weight = malloc(sizeof *weight * (size_t)(section->cut_nodes * across));
  double complex motion[3];
  if (!weight || eo_member_cut_weights(sector, tooth->teeth, weight)) {
    free(weight);
    return EO_ERROR_MEMORY;
  }
  for (int i = 0; i < kept->face; i++) {
    int node = kept->node[i], layer = kept->layer[i];
    tooth->weight[i] = weight[node * across + layer];
    for (int k = 0; k < EO_RING_RIGID; k++) {
      rigid_motion(sector, k, section->cut[0][node], layer, motion);
      tooth->rigid[k][i] = motion[kept->direction[i]];
    }
  }
  for (int j = 0; j < kept->flank; j++)
    for (int k = 0; k < EO_RING_RIGID; k++) {
      int node = section->flank.node[j / across];
      const double *into = sector->frame[node][0];
      rigid_motion(sector, k, node, j % across, motion);
      tooth->rigid_flank[k][j] = into[0] * motion[0] + into[1] * motion[1] + into[2] * motion[2];
    }
  free(weight);
  return EO_OK;
}

/* Factorises the tooth, springs on its faces, and condenses it. */
static enum eo_code factorise_and_condense(struct eo_member_job *job, const struct kept *kept,
                                           struct eo_ring_tooth *tooth, struct eo_sparse_factor **factor)
{
  const struct eo_sector *sector = &job->sector;
  struct eo_member_times *times = job->times;
  int inner = kept->root + kept->flank, outer = 2 * kept->face;
  double start = eo_member_now();
  EO_TRY(eo_sparse_analyse(&sector->matrix, sector->group, sector->groups, kept->unknown, inner + outer, factor,
                           job->error));
  times->ordering = eo_member_lap(&start);
  EO_TRY(eo_member_report(job, "factorisation", 0.1));
  EO_TRY(eo_sparse_factorise(*factor, job->error));
  times->factorisation = eo_member_lap(&start);
  EO_TRY(eo_member_report(job, "compliance", 0.45));
  EO_TRY(eo_ring_tooth_init(tooth, job->geometry->teeth[job->member], inner, kept->flank, kept->face,
                            job->settings->section.floating, job->error));
  EO_TRY(eo_sparse_condense(*factor, inner, kept->flank, tooth->compliance, tooth->influence, tooth->stiffness,
                            job->error));
  times->compliance = eo_member_lap(&start);
  times->unknowns = sector->matrix.n;
  times->entries = eo_sparse_entries(*factor);
  times->memory = (double)eo_sparse_peak_memory(*factor);
  return EO_OK;
}

/* The free tooth is singular: springs of E m_n, about the stiffness of its nodes, stand on the cut faces while it is
   factorised; they are taken off again exactly, because those unknowns are all kept. */
static enum eo_code condense(struct eo_member_job *job, const struct kept *kept, struct eo_ring_tooth *tooth)
{
  struct eo_sparse_factor *factor = NULL;
  int inner = kept->root + kept->flank, outer = 2 * kept->face;
  double spring = job->material->youngs_modulus * job->geometry->normal_module;
  for (int i = 0; i < outer; i++)
    eo_sector_add_spring(&job->sector, kept->unknown[inner + i], spring);
  enum eo_code code = factorise_and_condense(job, kept, tooth, &factor);
  eo_sparse_factor_free(factor);
  EO_TRY(code);
  for (int i = 0; i < outer; i++)
    tooth->stiffness[(size_t)i * (size_t)outer + (size_t)i] -= spring;
  eo_ring_tooth_turn(tooth, kept->direction);
  return EO_OK;
}

/* Room for one tooth's answers. */
struct answer {
  double *all;          /* [flank][inner]: displacement of the tooth */
  double *displacement; /* [root_nodes][layers + 1][3]: of its root, of one load */
  struct eo_stress_operator operator;
};

/* Stress in a tooth's root under the loads of every step-th row; the root's last node lies on the right face, which
   stands in the next tooth's frame. */
static void stress_of(const struct eo_member_job *job, const struct kept *kept, const struct eo_ring_motion *motion,
                      int t, int step, struct answer *answer, double *stress)
{
  const struct eo_section *section = &job->section;
  int layers = job->result->layers, inner = kept->root + kept->flank;
  size_t stresses = (size_t)job->result->root_points * (layers + 1) * EO_STRESSES;
  double alpha = 2 * M_PI / job->geometry->teeth[job->member], c = cos(alpha), sine = sin(alpha);
  const double *face = motion->left + (size_t)(t + 1 + motion->reach) * (size_t)kept->flank * (size_t)kept->face;
  for (int j = 0; j < kept->flank; j++, face += kept->face) {
    if (j / (layers + 1) % step)
      continue;
    const double *row = answer->all + (size_t)j * (size_t)inner;
    double *last = answer->displacement + (size_t)(section->root_nodes - 1) * (size_t)(layers + 1) * 3;
    eo_member_root_displacement(&job->sector, section->root_nodes - 1, row, row + kept->root, answer->displacement);
    for (int i = 0; i < kept->face && kept->node[i] == 0; i++)
      last[3 * kept->layer[i] + kept->direction[i]] = face[i];
    for (int l = 0; l <= layers; l++) {
      double x = last[3 * l], y = last[3 * l + 1];
      last[3 * l] = c * x + sine * y;
      last[3 * l + 1] = c * y - sine * x;
    }
    eo_stress_operator_apply(&answer->operator, answer->displacement, stress);
    stress += stresses;
  }
}

/* Response at tooth t, counted clockwise, to loads on tooth 0. The pinion's pair k + 1 is its next tooth clockwise, the
   gear's the one before. */
static enum eo_code answer_tooth(struct eo_member_job *job, const struct kept *kept, const struct eo_ring_tooth *tooth,
                                 const struct eo_ring_motion *motion, int t, struct answer *answer)
{
  struct eo_member_result *member = job->result;
  size_t flank = (size_t)kept->flank, inner = (size_t)tooth->inner,
         next = (size_t)member->next_rows * (member->layers + 1);
  size_t stresses = (size_t)member->root_points * (member->layers + 1) * EO_STRESSES;
  int ahead = job->member == EO_PINION ? t : -t, d = abs(t);
  enum eo_code code = eo_ring_displacement(tooth, motion, t, answer->all, job->error);
  if (code)
    return code;
  double *to = d == 0 ? member->full : member->next[ahead > 0] + (size_t)(d - 1) * flank * flank;
  for (size_t j = 0; j < flank; j++)
    memcpy(to + j * flank, answer->all + j * inner + (inner - flank), flank * sizeof *to);
  /* Seen from that tooth's root, the loads stand as far on the other side. */
  stress_of(job, kept, motion, t, d == 0 ? 1 : eo_member_row_step(member->rows), answer,
            d == 0 ? member->stress : member->next_stress[ahead < 0] + (size_t)(d - 1) * next * stresses);
  return EO_OK;
}

/* Deflection of mid face under a uniform load of 1 N/m on the row, by the trapezoidal rule. */
static void fill_parts(struct eo_member_result *member, const struct eo_ring_motion *motion, double width)
{
  int across = member->layers + 1, flank = member->rows * across;
  for (int k = 0; k < EO_RING_RIGID; k++)
    for (int row = 0; row < member->rows; row++)
      for (int l = 0; l < across; l++) {
        double load = width / member->layers * (l == 0 || l == member->layers ? 0.5 : 1);
        const double *part = motion->part[k] + (size_t)(row * across + l) * (size_t)flank + row * across;
        member->part[k][row] += load * 0.5 * (part[member->layers / 2] + part[(member->layers + 1) / 2]);
      }
}

static enum eo_code answer_all(struct eo_member_job *job, const struct kept *kept, const struct eo_ring_tooth *tooth,
                               const struct eo_ring_motion *motion)
{
  size_t nodes = (size_t)job->section.root_nodes * (size_t)(job->result->layers + 1);
  struct answer answer = {.all = malloc(sizeof(double) * (size_t)tooth->flank * (size_t)tooth->inner),
                          .displacement = calloc(3 * nodes, sizeof(double))};
  double start = eo_member_now();
  enum eo_code code = eo_stress_operator_init(&answer.operator, & job->sector, job->material, job->error);
  if (!answer.all || !answer.displacement)
    code = EO_ERROR_MEMORY;
  for (int t = -motion->reach; t <= motion->reach && !code; t++)
    code = answer_tooth(job, kept, tooth, motion, t, &answer);
  if (!code)
    fill_parts(job->result, motion, job->geometry->member_width[job->member]);
  eo_stress_operator_done(&answer.operator);
  free(answer.all);
  free(answer.displacement);
  job->times->stress = eo_member_lap(&start);
  return code;
}

/* What the progress says of the ring: how long it takes is known beforehand where it is long. */
static void describe(const struct eo_member_job *job, const struct eo_ring_tooth *tooth, size_t size, char *what)
{
  static const double OPERATIONS_PER_SECOND = 2e10, WORTH_SAYING = 5; /* of one core; s */
  double operations;
  eo_ring_cheapest(tooth, job->settings->reach, &operations);
  double estimate = operations / OPERATIONS_PER_SECOND;
  int length = snprintf(what, size, "%s: all %d teeth", eo_member_name[job->member], tooth->teeth);
  if (estimate > WORTH_SAYING)
    snprintf(what + length, size - (size_t)length, ", about %.0f s", estimate);
}

static enum eo_code solve(struct eo_member_job *job, struct kept *kept, struct eo_ring_tooth *tooth,
                          struct eo_ring_motion *motion)
{
  char what[80];
  const int threads = job->settings->threads ? job->settings->threads : eo_parallel_cores();
  EO_TRY(list_kept(&job->sector, kept));
  EO_TRY(eo_member_report(job, "ordering", 0.05));
  EO_TRY(condense(job, kept, tooth));
  EO_TRY(set_rigid(job, kept, tooth));
  EO_TRY(eo_ring_motion_init(motion, tooth, job->settings->reach, job->error));
  describe(job, tooth, sizeof what, what);
  double start = eo_member_now();
  EO_TRY(eo_ring_solve(motion, tooth, threads, job->settings->method, job->progress, what, 0.5, 0.9, job->error));
  job->times->harmonics = eo_member_lap(&start);
  return answer_all(job, kept, tooth, motion);
}

enum eo_code eo_member_solve_ring(struct eo_member_job *job)
{
  struct kept kept = {0};
  struct eo_ring_tooth tooth = {0};
  struct eo_ring_motion motion = {0};
  enum eo_code code = solve(job, &kept, &tooth, &motion);
  eo_ring_motion_done(&motion);
  eo_ring_tooth_done(&tooth);
  kept_done(&kept);
  return code;
}

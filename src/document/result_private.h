/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts the result document is put together from; see result.h. */
#ifndef EASEOFF_DOCUMENT_RESULT_PRIVATE_H
#define EASEOFF_DOCUMENT_RESULT_PRIVATE_H

#include "contact/pattern.h"
#include "format/json.h"
#include "format/object.h"
#include "format/outline.h"
#include "document/result.h"

struct eo_result_source {
  const struct eo_analysis *analysis;
  const struct eo_evaluation *evaluation;
  const struct eo_pair *pair;
  const struct eo_design *design;
  int ends, positions, lag;           /* lag: positions by which the right end's columns are shifted */
  double normal;                      /* cos(beta_b) of the left end: normal = transverse times it */
  struct eo_double_helix helix;       /* both ends on that footing */
  unsigned left_out;                  /* EO_RESULT_NO_..., EO_RESULT_CURVES_OF(), EO_RESULT_OVERVIEW */
  int digits, map_digits;             /* of curves; of maps and histories; `ready` in them */
  int ready;                          /* EO_DIGITS_READY where the result is only written, else 0 */
  struct eo_contact_pattern *pattern; /* [half] scratch: eo_result_pattern() */
  double *scratch;                    /* [positions] */
  double (*edge_pressure)[2];         /* [cases], Pa; filled with the load cases, for the warnings; of all threads */
};

/* Whether what EO_RESULT_NO_... stands for is written; of a load case (NULL: of none). */
bool eo_result_has(const struct eo_result_source *source, unsigned part, const struct eo_case_result *load_case);

/* The same for a curve of a part that belongs to the overview. */
bool eo_result_has_overview(const struct eo_result_source *source, unsigned part,
                            const struct eo_case_result *load_case);

/* cos(beta_b) of an end. */
static inline double eo_result_normal(const struct eo_result_source *source, int end)
{
  return source->normal / source->helix.scale[end];
}

/* Twice the weight with which Z of an end is part of the pair's: 1 of equal helices. */
static inline double eo_result_weight(const struct eo_result_source *source, int end)
{
  return 2 * source->helix.share[end] * source->helix.scale[end];
}

/* A curve over the mesh positions of one end, shifted so that both ends stand at the same instant; value NULL: left
   out. */
struct eo_series eo_result_curve(const struct eo_result_source *source, int end, const double *value, double scale);

/* A map over the flank [EO_PATTERN_ROWS][EO_PATTERN_COLUMNS]; left out with the maps. */
struct eo_series eo_result_map(const struct eo_result_source *source, const double *value);

/* The pattern of an end. */
struct eo_contact_pattern *eo_result_pattern(const struct eo_result_source *source, int end);

/* Places on the right end's face, m, where it has a width of its own: as many as on the left one, in proportion; place
   NULL: left out. New; null where both ends are alike, NULL without memory. */
json_t *eo_result_right_face(const struct eo_result_source *source, int count, const double *place);
#define EO_TWO_HELICES "with halves of unequal helix"
#define EO_UNEVEN "with halves of unequal width or helix"

/* What is there when the pair has two ends. */
#define EO_TWO_ENDS "with two ends"

/* The parts; each stands beside its writer. */
extern const struct eo_outline eo_outline_lte, eo_outline_stiffness, eo_outline_unloaded, eo_outline_contact,
    eo_outline_axial, eo_outline_face_load, eo_outline_bodies, eo_outline_flexibility, eo_outline_impact,
    eo_outline_root_stress, eo_outline_vibration, eo_outline_modification, eo_outline_rating, eo_outline_tribology,
    eo_outline_pitch;
extern const struct eo_outline eo_outline_value;    /* of a struct eo_objective_value */
extern const struct eo_outline eo_outline_raw_case; /* eo_result_raw_case() */

/* Normal force that one end carries, mean over the mesh cycle, N. */
double eo_result_mean_load(const struct eo_result_source *source, const struct eo_case_result *load_case, int end);

/* Wind-up of a member's hub, normal, m per N/m of face width; NaN unless the design asks for it. */
double eo_result_hub_windup(const struct eo_result_source *source, int member);

/* Each returns a new value, NULL without memory. */
json_t *eo_result_raw_case(const struct eo_load_case *load_case, const struct eo_objective_case *raw);
json_t *eo_result_position(const struct eo_result_source *source);
json_t *eo_result_flexibility(const struct eo_result_source *source);
json_t *eo_result_unloaded(struct eo_result_source *source);
json_t *eo_result_lte(struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_stiffness(struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_face_load(const struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_contact(struct eo_result_source *source, int load_case);
json_t *eo_result_axial(const struct eo_result_source *source, const struct eo_case_result *load_case);
/* Normal gap that the bodies open at the pitch point, mean over the mesh cycle. */
json_t *eo_result_bodies(struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_impact(struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_root_stress(struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_vibration(struct eo_result_source *source, const struct eo_case_result *load_case);
json_t *eo_result_modification(struct eo_result_source *source);
/* null unless the analysis was asked for the rating. */
json_t *eo_result_rating(const struct eo_result_source *source);
json_t *eo_result_objectives(const struct eo_result_source *source);
json_t *eo_result_tribology(const struct eo_result_source *source);
/* null unless the design states single teeth and the analysis was asked for them. */
json_t *eo_result_pitch(const struct eo_result_source *source);
json_t *eo_result_warnings(const struct eo_result_source *source, const struct eo_warnings *before);

/* What one thread needs to write; false without memory. done() after either. */
bool eo_result_source_init(struct eo_result_source *source, const struct eo_analysis *analysis,
                           const struct eo_design *design, unsigned left_out);
/* For who only writes what is made of it: curves and maps are text from the start (EO_DIGITS_READY). */
void eo_result_source_write_only(struct eo_result_source *source);
void eo_result_source_done(struct eo_result_source *source);

/* The result in the order of writing: what stands before the load cases, the two halves of each, about as long to
   write, and what stands behind them. New; NULL without memory. */
json_t *eo_result_head(struct eo_result_source *source);
json_t *eo_result_case_contact(struct eo_result_source *source, int load_case);
json_t *eo_result_case_consequences(struct eo_result_source *source, int load_case);
json_t *eo_result_tail(const struct eo_result_source *source, const struct eo_warnings *warnings);

#endif

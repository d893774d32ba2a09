/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What files of kind `tolerance` compute with: pairs, inputs by the names of the file, the contact of one pair as made,
   and distributions. */
#ifndef EASEOFF_REFERENCE_TOLERANCE_BENCH_H
#define EASEOFF_REFERENCE_TOLERANCE_BENCH_H

#include "contact/loaded.h"
#include "evaluation/pair.h"
#include "reference/case_pair.h"
#include "tolerance/distribution.h"

enum { EO_BENCH_INPUTS = 64 };

/* In the order of the file's names PPLTE_um, LTE_mean_um, max_pressure_MPa, their hands, and the rest. */
enum {
  EO_BENCH_PPLTE,
  EO_BENCH_MEAN,
  EO_BENCH_PRESSURE,
  EO_BENCH_PPLTE_LEFT,
  EO_BENCH_PPLTE_RIGHT,
  EO_BENCH_PRESSURE_LEFT,
  EO_BENCH_PRESSURE_RIGHT,
  EO_BENCH_FLOAT,
  EO_BENCH_UNLOADED,
  EO_BENCH_OUTPUTS
};

/* The name of an output in the files, and back (-1: none). */
const char *eo_bench_output_name(int output);
int eo_bench_output_find(const char *name);

/* An input: where it stands in the design, and how it scatters, in the file's unit. */
struct eo_bench_input {
  const char *name; /* borrowed from the file */
  size_t offset;    /* in struct eo_design; unused where index >= 0 */
  double unit;
  int index; /* member whose teeth all have this index deviation; -1: none */
  int end;   /* of a flank; -1: of the pair */
  struct eo_distribution distribution;
};

/* One pair under one load, as the file poses it. */
struct eo_tolerance_bench {
  struct eo_case *file;
  struct eo_verification *v;
  struct eo_closed_form form;
  /* the pair prepared last */
  const char *pair_name;
  int flexibility;
  struct eo_pair *pair;
  struct eo_loaded_workspace *workspace;
  /* the case */
  int ends;
  double torque; /* N m; 0: unloaded */
  struct eo_design nominal;
  enum eo_flank_side flank;
  struct eo_axial_hold hold;
  int inputs;
  struct eo_bench_input input[EO_BENCH_INPUTS];
  struct eo_loaded_gaps gaps[2];
  struct eo_loaded_end loaded[2];
};

/* Reads pair, torque, flank, hold and the nominal flanks and shaft errors (of `nominal`: an object of the case, or the
   case itself), and makes the pair ready. Faults go to the file; errors: of the preparation. */
enum eo_code eo_bench_read(struct eo_tolerance_bench *bench, struct eo_case *item, struct eo_case *nominal,
                           struct eo_error *error);
/* The list of variables with their distributions. */
void eo_bench_read_inputs(struct eo_tolerance_bench *bench, struct eo_case *variables);
void eo_bench_done(struct eo_tolerance_bench *bench);

/* The pair with these values [inputs], in the file's units; NULL: nominal. output[EO_BENCH_OUTPUTS] in the file's
   units. False where the contact did not converge. */
bool eo_bench_evaluate(struct eo_tolerance_bench *bench, const double *value, double *output);

/* Points of the inputs in scrambled Sobol points: value[points][inputs]. */
enum eo_code eo_bench_draw(const struct eo_bench_input *input, int inputs, int points, double *value,
                           struct eo_error *error);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/pitch_analysis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "contact/tooth_courses.h"
#include "dynamics/long_sketch.h"
#include "evaluation/evaluator_private.h"
#include "gear/names.h"
#include "numerics/fft.h"
#include "numerics/periodic.h"

/* How far interpolated contact may be off where it is looked at, m. */
static const double WITHIN = 5e-9;

/* What a run works with beside the result. */
struct work {
  struct eo_pitch_analysis *result;
  struct eo_evaluator *evaluator;
  const struct eo_design *design;
  struct eo_tooth_deviation *ordered[2][2]; /* [end][member] in the order of meshing, of the case at hand */
  double *gap[2];                           /* [end] of the case at hand */
  const struct eo_pitch_question *question;
};

/* Contact takes most of the time, so that what is left is told by the load cases that are done. */
struct share {
  const struct eo_progress *of;
  int load_case, load_cases;
};

static int report_share(void *context, const char *what, double fraction)
{
  const struct share *share = context;
  return eo_progress_report(share->of, what, (share->load_case + fraction) / share->load_cases);
}

/* Drive flanks carry ahead when the member drives that does so in every load case. */
static int lead_driver(const struct eo_load_case *load_case, const struct eo_running *running)
{
  bool as_made = (running->flank == EO_DRIVE_FLANK) == (load_case->direction == EO_AHEAD);
  return as_made ? load_case->driver : 1 - load_case->driver;
}

static struct eo_pitch_meeting meeting_of(const struct eo_case_result *load_case)
{
  return (struct eo_pitch_meeting){.side = load_case->running.flank,
                                   .inwards = load_case->running.inwards,
                                   .lead_driver = lead_driver(&load_case->load_case, &load_case->running)};
}

/* All teeth of the flanks of one side, once. */
static enum eo_code compose(struct work *work, const struct eo_pitch_meeting *meeting, struct eo_error *error)
{
  const struct eo_geometry *geometry = &work->evaluator->pair->geometry;
  if (work->result->used[meeting->side])
    return EO_OK;
  work->result->used[meeting->side] = true;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < work->design->gear_pair.ends; end++) {
      int teeth = geometry->teeth[member];
      struct eo_tooth_deviation *tooth = malloc(sizeof *tooth * (size_t)teeth);
      double *index = malloc(sizeof *index * (size_t)teeth);
      work->result->tooth[meeting->side][member][end] = tooth;
      enum eo_code code = tooth && index
                              ? eo_pitch_compose(&work->design->pitch, geometry, meeting, member, end, tooth, error)
                              : eo_error_memory(error);
      for (int i = 0; i < teeth && !code; i++)
        index[i] = tooth[i].index;
      if (!code)
        work->result->size[meeting->side][member][end] = eo_pitch_size_of(teeth, index);
      free(index);
      if (code)
        return code;
    }
  return EO_OK;
}

/* Tables in the order of meshing and gaps of both ends, for one load case. */
static void arrange(struct work *work, struct eo_case_result *load_case, const struct eo_pitch_case *own)
{
  struct eo_run run = {.design = work->design};
  for (int end = 0; end < work->design->gear_pair.ends; end++) {
    memcpy(work->gap[end], eo_evaluator_gaps_of(work->evaluator, &run, load_case, end)->gap,
           sizeof(double) * (size_t)eo_evaluator_grid(work->evaluator, end)->points);
    for (int member = 0; member < 2; member++)
      eo_pitch_order(&work->design->pitch, &own->meeting, member, work->evaluator->pair->geometry.teeth[member],
                     work->result->tooth[own->meeting.side][member][end], work->ordered[end][member]);
  }
}

/* The period at few positions, and a stretch of it, at all positions of the grid, by which the pair vibrates. */
static enum eo_code sketch(const struct work *work, const struct eo_hunting_input *input, struct eo_pitch_case *own,
                           struct eo_error *error)
{
  enum { TURNS = 1 }; /* of the gear */
  int cycles = EO_LONG_SKETCH_LEAD + TURNS * input->grid[EO_LEFT]->geometry.teeth[EO_GEAR];
  return eo_hunting_follow(&own->hunting, &own->stretch, work->question->vibration ? cycles : 0, INFINITY, input,
                           error);
}

/* Teeth whose flanks differ: gaps of more than one number each. */
static bool any_form(const struct eo_hunting_input *input)
{
  bool any = false;
  for (int end = 0; end < input->ends; end++)
    for (int member = 0; member < 2; member++)
      any = any || eo_tooth_any_form(input->tooth[end][member], input->grid[end]->geometry.teeth[member]);
  return any;
}

static enum eo_code hunt(struct work *work, const struct eo_case_result *load_case, struct eo_pitch_case *own,
                         struct eo_error *error)
{
  const struct eo_pair *pair = work->evaluator->pair;
  struct eo_hunting_input input = {
      .ends = work->design->gear_pair.ends,
      .grid = {pair->grid, eo_pair_half(pair, EO_RIGHT)->grid},
      .gap = {work->gap[EO_LEFT], work->gap[EO_RIGHT]},
      .alike = {&load_case->end[EO_LEFT].loaded, &load_case->end[EO_RIGHT].loaded},
      .inwards = load_case->running.inwards,
      .positions = work->design->pitch.positions,
      .stagger = eo_evaluator_stagger_of(pair, work->design, &load_case->running, work->design->pitch.positions),
      .compliance_factor = work->question->compliance_factor,
      .load = {load_case->end_force[EO_LEFT], load_case->end_force[EO_RIGHT]},
      .shared_load = load_case->force,
      .hold = eo_meeting_hold(work->evaluator, work->design, load_case),
      .workspace = {eo_evaluator_workspace(work->evaluator, 0, EO_LEFT),
                    eo_evaluator_workspace(work->evaluator, 0, EO_RIGHT)},
      .threads = work->question->threads};
  for (int i = 0; i < 4; i++)
    input.tooth[i / 2][i % 2] = work->ordered[i / 2][i % 2];
  for (int end = 0; end < 2 && work->question->root && pair->root; end++)
    input.root[end] = eo_pair_half(pair, end)->root;
  if (work->design->pitch.level == EO_TEETH_SKETCHED)
    return sketch(work, &input, own, error);
  if (work->design->pitch.level == EO_TEETH_FOLLOWED && !any_form(&input))
    return eo_hunting_follow(&own->hunting, &own->stretch, 0, WITHIN, &input, error);
  struct share share = {work->question->progress, (int)(own - work->result->load_case), work->result->cases};
  const struct eo_progress progress = {report_share, &share};
  return eo_hunting_run(&own->hunting, &input, &progress, error);
}

static double swing(int n, const double *value)
{
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < n; i++) {
    low = fmin(low, value[i]);
    high = fmax(high, value[i]);
  }
  return high - low;
}

/* Mean and swing over the period and of every cycle; what the pinion does along its axis. */
static enum eo_code read_curves(const struct work *work, struct eo_pitch_case *own, struct eo_error *error)
{
  const struct eo_hunting *hunting = &own->hunting;
  const struct eo_double_helix helix = eo_pair_double_helix(work->evaluator->pair);
  double normal = cos(work->evaluator->pair->geometry.base_helix_angle), lean = eo_double_helix_lean(&helix),
         outwards = own->meeting.inwards ? -1 : 1;
  double low = INFINITY, high = -INFINITY;
  own->transmission = malloc(sizeof(double) * (size_t)hunting->instants);
  own->cycle_mean = malloc(sizeof(double) * (size_t)hunting->cycles);
  own->cycle_swing = malloc(sizeof(double) * (size_t)hunting->cycles);
  if (!own->transmission || !own->cycle_mean || !own->cycle_swing)
    return eo_error_memory(error);
  for (int i = 0; i < hunting->instants; i++) {
    double left = hunting->approach[EO_LEFT][i],
           right = hunting->approach[hunting->ends - 1][i] * helix.scale[EO_RIGHT],
           shift = hunting->ends == 2 && lean != 0 ? outwards * (left - right) / lean : 0;
    own->transmission[i] = (2 * helix.share[EO_LEFT] * left + 2 * helix.share[EO_RIGHT] * right) / (2 * normal);
    own->float_mean += shift / hunting->instants;
    low = fmin(low, shift);
    high = fmax(high, shift);
  }
  own->float_swing = high - low;
  own->mean = 0;
  for (int cycle = 0; cycle < hunting->cycles; cycle++) {
    const double *part = own->transmission + (size_t)cycle * (size_t)hunting->positions;
    own->cycle_mean[cycle] = eo_periodic_mean(hunting->positions, part);
    own->cycle_swing[cycle] = swing(hunting->positions, part);
    own->mean += own->cycle_mean[cycle] / hunting->cycles;
  }
  own->peak_to_peak = swing(hunting->instants, own->transmission);
  own->lines = hunting->instants / 2 + 1;
  own->line = malloc(sizeof *own->line * (size_t)own->lines);
  if (!own->line)
    return eo_error_memory(error);
  return eo_fft_spectrum(work->evaluator->fft, hunting->instants, own->transmission, own->line, error);
}

/* Time-synchronous averages: of each position of a member's turn the mean over all its turns. */
static enum eo_code average_turns(struct eo_pitch_case *own, bool backwards, struct eo_error *error)
{
  const struct eo_hunting *hunting = &own->hunting;
  for (int member = 0; member < 2; member++) {
    int bins = hunting->teeth[member] * hunting->positions;
    own->turn[member] = calloc((size_t)bins, sizeof(double));
    if (!own->turn[member])
      return eo_error_memory(error);
    for (int i = 0; i < hunting->instants; i++) {
      int from = backwards ? (hunting->instants - i) % hunting->instants : i;
      own->turn[member][i % bins] += (own->transmission[from] - own->mean) * bins / hunting->instants;
    }
  }
  return EO_OK;
}

/* A member's tables of both hands are the same. */
static bool hands_alike(const struct work *work, const struct eo_pitch_case *own)
{
  bool alike = true;
  for (int member = 0; member < 2 && work->design->gear_pair.ends == 2; member++) {
    struct eo_tooth_deviation *const *of = work->result->tooth[own->meeting.side][member];
    for (int i = 0; i < work->evaluator->pair->geometry.teeth[member]; i++)
      alike = alike && of[EO_LEFT][i].index == of[EO_RIGHT][i].index &&
              of[EO_LEFT][i].profile_slope == of[EO_RIGHT][i].profile_slope &&
              of[EO_LEFT][i].helix_slope == of[EO_RIGHT][i].helix_slope &&
              of[EO_LEFT][i].profile_crowning == of[EO_RIGHT][i].profile_crowning &&
              of[EO_LEFT][i].lead_crowning == of[EO_RIGHT][i].lead_crowning;
  }
  return alike;
}

/* The contact by which the pair vibrates. */
static const struct eo_hunting *heard(const struct eo_pitch_case *own, const struct eo_design *design)
{
  return design->pitch.level == EO_TEETH_SKETCHED ? &own->stretch : &own->hunting;
}

/* Z at which an end would carry P, from the load it has; both in the order of time. */
static void order_in_time(const struct eo_pitch_case *own, const struct eo_hunting *hunting, bool backwards, int end,
                          double *deflection, double *tangent)
{
  for (int i = 0; i < hunting->instants; i++) {
    int from = backwards ? (hunting->instants - i) % hunting->instants : i;
    double k = hunting->tangent[end][from];
    tangent[i] = k;
    deflection[i] = hunting->approach[end][from] + (k > 0 ? (own->force[end] - hunting->load[end][from]) / k : 0);
  }
}

/* No more than pairs as made are asked for. */
static enum eo_code sketch_response(struct eo_long_response *response, const struct eo_long_case *load,
                                    struct eo_error *error)
{
  *response = (struct eo_long_response){.outcome = EO_LONG_IN_CONTACT};
  return eo_long_sketch_rms(load, &response->rms[EO_READING_NORMAL], error);
}

static enum eo_code respond_with(const struct work *work, const struct eo_case_result *load_case,
                                 struct eo_pitch_case *own, double *const scratch[4], struct eo_error *error)
{
  const struct eo_design *design = work->design;
  const struct eo_hunting *hunting = heard(own, design);
  struct eo_dynamics_parameters parameters;
  bool held = load_case->at_stop || design->alignment.pinion_axial != EO_AXIAL_STOPS,
       differ = design->gear_pair.ends == 2 &&
                !(!work->evaluator->pair->right && eo_reuse_same_flanks(design) && hands_alike(work, own));
  double stiffness = 0;
  for (int end = 0; end < hunting->ends; end++) {
    order_in_time(own, hunting, load_case->running.backwards, end, scratch[end], scratch[2 + end]);
    for (int i = 0; i < hunting->instants; i++)
      stiffness += scratch[2 + end][i] / (hunting->ends * hunting->instants);
  }
  EO_TRY(eo_dynamics_parameters_init(&parameters, &work->evaluator->pair->geometry, hunting->ends,
                                     held ? eo_alignment_axial_stiffness(&design->alignment) : 0, &design->supports,
                                     differ, stiffness, error));
  int most = hunting->positions / 2 - 1, harmonics = design->resolution.te_harmonics;
  const struct eo_long_case load = {.parameters = &parameters,
                                    .torque = own->load_case.torque,
                                    .speed = own->load_case.speed * work->question->speed_factor,
                                    .pinion_teeth = hunting->teeth[EO_PINION],
                                    .cycles = hunting->cycles,
                                    .positions = hunting->positions,
                                    .fft = work->evaluator->fft,
                                    .harmonics = harmonics < most ? harmonics : most,
                                    .deflection = {scratch[0], scratch[1]},
                                    .tangent = {scratch[2], scratch[3]},
                                    .back = load_case->end[EO_LEFT].deflection.part[0][EO_DEFLECTION_NODES / 2] -
                                            design->gear_pair.backlash,
                                    .levels_alone = design->pitch.level != EO_TEETH_SOLVED};
  return design->pitch.level == EO_TEETH_SKETCHED ? sketch_response(&own->response, &load, error)
                                                  : eo_long_response_find(&own->response, &load, error);
}

static void add_order(struct eo_pitch_case *own, double order, const char *name)
{
  struct eo_pitch_order *row = &own->order[own->orders];
  long k = lround(order * own->hunting.cycles / own->hunting.teeth[EO_PINION]);
  if (k <= 0 || k >= own->lines)
    return;
  *row = (struct eo_pitch_order){.order = order, .transmission = cabs(own->line[k])};
  snprintf(row->name, sizeof row->name, "%s", name);
  for (int reading = 0; reading < EO_READINGS; reading++)
    row->acceleration[reading] = own->response.acceleration[reading] && k < own->response.lines
                                     ? cabs(own->response.acceleration[reading][k])
                                     : NAN;
  own->orders++;
}

/* Orders of the shafts and of the mesh with its sidebands, by name. */
static void list_orders(struct eo_pitch_case *own)
{
  const int *z = own->hunting.teeth;
  char text[32];
  own->orders = 0;
  for (int i = 0; i < 2 * EO_PITCH_SHAFT_ORDERS; i++) {
    int member = i / EO_PITCH_SHAFT_ORDERS, j = i % EO_PITCH_SHAFT_ORDERS + 1;
    snprintf(text, sizeof text, "%s %d", eo_member_name[member], j);
    add_order(own, (double)j * z[EO_PINION] / z[member], text);
  }
  for (int h = 1; h <= EO_PITCH_MESH_ORDERS; h++) {
    snprintf(text, sizeof text, "mesh %d", h);
    add_order(own, (double)h * z[EO_PINION], text);
    for (int i = 0; i < 4 * EO_PITCH_SIDEBANDS && h <= EO_PITCH_SIDED; i++) {
      int member = i / (2 * EO_PITCH_SIDEBANDS), j = i % EO_PITCH_SIDEBANDS + 1,
          side = i / EO_PITCH_SIDEBANDS % 2 ? 1 : -1;
      snprintf(text, sizeof text, "mesh %d %c %s %d", h, side < 0 ? '-' : '+', eo_member_name[member], j);
      add_order(own, (double)h * z[EO_PINION] + side * (double)j * z[EO_PINION] / z[member], text);
    }
  }
}

/* The vibration of one load case, on any thread. */
static enum eo_code respond(void *context, int thread, int k, struct eo_error *error)
{
  const struct work *work = context;
  struct eo_pitch_case *own = &work->result->load_case[k];
  double *scratch[4] = {NULL};
  enum eo_code code = EO_OK;
  (void)thread;
  for (int i = 0; i < 4 && !code; i++) {
    scratch[i] = malloc(sizeof(double) * (size_t)heard(own, work->design)->instants);
    code = scratch[i] ? EO_OK : eo_error_memory(error);
  }
  own->response.outcome = EO_LONG_NO_LAW;
  if (!code && work->question->vibration && own->hunting.failures == 0 && own->stretch.failures == 0)
    code = respond_with(work, &work->evaluator->result.load_case[k], own, scratch, error);
  for (int i = 0; i < 4; i++)
    free(scratch[i]);
  if (!code)
    list_orders(own);
  return code;
}

static enum eo_code make_work(struct work *work, struct eo_error *error)
{
  const struct eo_contact_grid *grid = work->evaluator->pair->grid;
  struct eo_pitch_analysis *result = work->result;
  bool complete = true;
  result->cases = work->evaluator->result.cases;
  result->load_case = calloc((size_t)result->cases, sizeof *result->load_case);
  for (int end = 0; end < 2; end++) {
    work->gap[end] = malloc(sizeof(double) * (size_t)eo_evaluator_grid(work->evaluator, end)->points);
    complete = complete && work->gap[end];
    for (int member = 0; member < 2; member++) {
      work->ordered[end][member] = calloc((size_t)grid->geometry.teeth[member], sizeof *work->ordered[end][member]);
      complete = complete && work->ordered[end][member];
    }
  }
  for (int member = 0; member < 2; member++) {
    result->tolerance[member] = (struct eo_flank_tolerance){.single_pitch = NAN, .total_pitch = NAN};
    if (work->design->pitch.member[member].tolerance_class > 0)
      EO_TRY(eo_pitch_tolerance(&result->tolerance[member], &work->design->pitch.member[member], &grid->geometry,
                                member, error));
  }
  return complete && result->load_case ? EO_OK : eo_error_memory(error);
}

static enum eo_code run_cases(struct work *work, struct eo_error *error)
{
  EO_TRY(make_work(work, error));
  for (int k = 0; k < work->result->cases; k++) {
    struct eo_case_result *load_case = &work->evaluator->result.load_case[k];
    struct eo_pitch_case *own = &work->result->load_case[k];
    own->load_case = load_case->load_case;
    memcpy(own->force, load_case->even_force, sizeof own->force);
    own->meeting = meeting_of(load_case);
    EO_TRY(compose(work, &own->meeting, error));
    arrange(work, load_case, own);
    EO_TRY(hunt(work, load_case, own, error));
    EO_TRY(read_curves(work, own, error));
    EO_TRY(average_turns(own, load_case->running.backwards, error));
  }
  const struct eo_parallel parallel = {.threads = work->question->threads,
                                       .work = respond,
                                       .context = work,
                                       .progress = work->question->progress,
                                       .what = "vibration over the hunting period",
                                       .first = 1,
                                       .last = 1};
  return eo_parallel_run(&parallel, work->result->cases, error);
}

enum eo_code eo_pitch_analysis_run(struct eo_pitch_analysis *analysis, struct eo_evaluator *evaluator,
                                   const struct eo_pitch_question *question, struct eo_error *error)
{
  struct work work = {.result = analysis, .evaluator = evaluator, .design = question->design, .question = question};
  *analysis = (struct eo_pitch_analysis){0};
  EO_TIMED(analysis->milliseconds);
  enum eo_code code = run_cases(&work, error);
  for (int end = 0; end < 2; end++) {
    free(work.gap[end]);
    for (int member = 0; member < 2; member++)
      free(work.ordered[end][member]);
  }
  return code;
}

void eo_pitch_analysis_done(struct eo_pitch_analysis *analysis)
{
  for (int k = 0; k < analysis->cases && analysis->load_case; k++) {
    struct eo_pitch_case *own = &analysis->load_case[k];
    eo_hunting_done(&own->hunting);
    eo_hunting_done(&own->stretch);
    eo_long_response_done(&own->response);
    free(own->transmission);
    free(own->cycle_mean);
    free(own->cycle_swing);
    free(own->turn[EO_PINION]);
    free(own->turn[EO_GEAR]);
    free(own->line);
  }
  free(analysis->load_case);
  for (int i = 0; i < 8; i++)
    free(analysis->tooth[i / 4][i / 2 % 2][i % 2]);
  *analysis = (struct eo_pitch_analysis){0};
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/pitch_deviation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "gear/names.h"

const double *eo_tooth_table_at(const struct eo_tooth_tables *tables, enum eo_flank_side side, int member, int end,
                                enum eo_tooth_term term)
{
  const struct eo_tooth_place *place = &tables->place[side][member][end][term];
  return place->teeth ? tables->number + place->first : NULL;
}

enum eo_code eo_tooth_tables_add(struct eo_tooth_tables *tables, enum eo_flank_side side, int member, int end,
                                 enum eo_tooth_term term, int teeth, const double *value, struct eo_error *error)
{
  if (tables->used + teeth > EO_TOOTH_NUMBERS)
    return eo_error_set(error, EO_ERROR_INPUT, "/pitch",
                        "The tables of single teeth hold more than %d numbers together.", EO_TOOTH_NUMBERS);
  tables->place[side][member][end][term] = (struct eo_tooth_place){teeth, tables->used};
  memcpy(tables->number + tables->used, value, sizeof *value * (size_t)teeth);
  tables->used += teeth;
  return EO_OK;
}

struct eo_pitch_size eo_pitch_size_of(int teeth, const double *index)
{
  double low = INFINITY, high = -INFINITY, single = 0;
  for (int i = 0; i < teeth; i++) {
    low = fmin(low, index[i]);
    high = fmax(high, index[i]);
    single = fmax(single, fabs(index[i] - index[(i + teeth - 1) % teeth]));
  }
  return (struct eo_pitch_size){high - low, single};
}

/* index = size waves + scatter less its mean. */
static void add_up(int teeth, double size, const double *waves, double part, const double *scatter, double *index)
{
  double mean = 0;
  for (int i = 0; i < teeth; i++)
    mean += (index[i] = size * waves[i] + part * scatter[i]) / teeth;
  for (int i = 0; i < teeth; i++)
    index[i] -= mean;
}

/* Half of the single pitch tolerance, less where the total one is tighter, is scatter; then the waves grow until one of
   the tolerances is reached. F_p and f_p are convex in their size, so what keeps within them is one interval from 0,
   and halving finds its end. */
void eo_pitch_draw(const struct eo_flank_tolerance *tolerance, double share, int teeth, uint64_t seed, uint64_t stream,
                   double *index)
{
  enum { HALVINGS = 50, WAVES, SCATTER };
  static const double SCATTERED = 0.5, SECOND = 0.3; /* of f_pT; of the run-out, at most */
  double waves[EO_TOOTH_NUMBERS], scatter[EO_TOOTH_NUMBERS], total = share * tolerance->total_pitch,
                                                             single = share * tolerance->single_pitch;
  struct eo_random first = eo_random_at(seed, stream, WAVES, 0), each = eo_random_at(seed, stream, SCATTER, 0);
  const double phase[2] = {2 * M_PI * eo_random_unit(first, 0), 2 * M_PI * eo_random_unit(first, 1)};
  double second = SECOND * eo_random_unit(first, 2);
  for (int i = 0; i < teeth; i++) {
    double turn = 2 * M_PI * i / teeth;
    waves[i] = cos(turn - phase[0]) + second * cos(2 * turn - phase[1]);
    scatter[i] = 2 * eo_random_unit(each, (uint64_t)i) - 1;
  }
  struct eo_pitch_size rough = eo_pitch_size_of(teeth, scatter);
  double part = SCATTERED * fmin(single / rough.single, total / rough.total), low = 0, high = total;
  for (int i = 0; i < HALVINGS; i++) {
    double size = (low + high) / 2;
    add_up(teeth, size, waves, part, scatter, index);
    struct eo_pitch_size reached = eo_pitch_size_of(teeth, index);
    if (reached.total <= total && reached.single <= single)
      low = size;
    else
      high = size;
  }
  add_up(teeth, low, waves, part, scatter, index);
}

void eo_tooth_form_draw(const struct eo_flank_tolerance *tolerance, double share, enum eo_tooth_term term, int teeth,
                        uint64_t seed, uint64_t stream, double *value)
{
  enum { FORM = 8 }; /* streams of eo_pitch_draw() before */
  const double limit[EO_TOOTH_TERMS] = {[EO_TOOTH_PROFILE_SLOPE] = tolerance->profile_slope,
                                        [EO_TOOTH_HELIX_SLOPE] = tolerance->helix_slope,
                                        [EO_TOOTH_PROFILE_CROWNING] = tolerance->profile_form,
                                        [EO_TOOTH_LEAD_CROWNING] = tolerance->helix_form};
  struct eo_random random = eo_random_at(seed, stream, FORM + (uint64_t)term, 0);
  for (int i = 0; i < teeth; i++)
    value[i] = share * limit[term] * (2 * eo_random_unit(random, (uint64_t)i) - 1);
}

static enum eo_code class_tolerance(struct eo_flank_tolerance *tolerance, const struct eo_pitch_member *member,
                                    int grade, const char *key, const struct eo_geometry *geometry, int of,
                                    struct eo_error *error)
{
  const struct eo_tolerance_input input = {.reference_diameter = 2 * geometry->reference_radius[of],
                                           .normal_module = geometry->normal_module,
                                           .face_width = geometry->face_width,
                                           .teeth = geometry->teeth[of],
                                           .grade = grade,
                                           .total_contact_ratio = NAN,
                                           .helix_angle = geometry->helix_angle};
  enum eo_code code = eo_flank_tolerance(tolerance, member->edition, &input, error);
  if (code == EO_ERROR_INPUT && error)
    snprintf(error->pointer, sizeof error->pointer, "/pitch/%s/%s", eo_member_name[of], key);
  return code;
}

enum eo_code eo_pitch_tolerance(struct eo_flank_tolerance *tolerance, const struct eo_pitch_member *member,
                                const struct eo_geometry *geometry, int of, struct eo_error *error)
{
  return class_tolerance(tolerance, member, member->tolerance_class, "tolerance_class", geometry, of, error);
}

int eo_pitch_usual_positions(int resolved)
{
  int positions = 32; /* 16 change the swing of the paper's pair by 2 nm of 22 um; harmonics want twice as many */
  while (resolved % positions)
    positions--;
  return positions;
}

enum eo_code eo_pitch_check(const struct eo_pitch *pitch, const struct eo_geometry *geometry, int resolved,
                            struct eo_error *error)
{
  struct eo_flank_tolerance tolerance;
  int cycles = eo_hunting_cycles(geometry->teeth);
  if (!pitch->stated)
    return EO_OK;
  if (pitch->positions < 4 || resolved % pitch->positions)
    return eo_error_set(error, EO_ERROR_INPUT, "/pitch/positions_per_cycle",
                        "%d positions of a mesh cycle are not among the %d of the resolution: state a divisor of these "
                        "from 4.",
                        pitch->positions, resolved);
  if (pitch->gear_tooth >= geometry->teeth[EO_GEAR])
    return eo_error_set(error, EO_ERROR_INPUT, "/pitch/gear_tooth",
                        "The gear has no tooth %d: they are counted from 0 to %d.", pitch->gear_tooth,
                        geometry->teeth[EO_GEAR] - 1);
  if ((double)cycles * pitch->positions > EO_HUNTING_MOST_INSTANTS)
    return eo_error_set(error, EO_ERROR_INPUT, "/pitch/positions_per_cycle",
                        "%d and %d teeth meet again after %d mesh cycles; with %d positions in each that is more than "
                        "the %d instants that are computed: state at most %d.",
                        geometry->teeth[0], geometry->teeth[1], cycles, pitch->positions, EO_HUNTING_MOST_INSTANTS,
                        EO_HUNTING_MOST_INSTANTS / cycles);
  for (int member = 0; member < 2; member++) {
    const struct eo_pitch_member *own = &pitch->member[member];
    if (own->tolerance_class > 0)
      EO_TRY(eo_pitch_tolerance(&tolerance, own, geometry, member, error));
    if (own->flank_class > 0)
      EO_TRY(class_tolerance(&tolerance, own, own->flank_class, "flank_class", geometry, member, error));
  }
  return EO_OK;
}

static enum eo_code draw_index(const struct eo_pitch_member *member, const struct eo_geometry *geometry, int of,
                               uint64_t stream, double *index, struct eo_error *error)
{
  struct eo_flank_tolerance tolerance;
  EO_TRY(eo_pitch_tolerance(&tolerance, member, geometry, of, error));
  eo_pitch_draw(&tolerance, member->tolerance_share, geometry->teeth[of], member->seed, stream, index);
  return EO_OK;
}

/* The flank looks the way its body turns ahead: the driver's drive flank, the driven member's coast flank. */
static bool looks_ahead(const struct eo_pitch_meeting *meeting, int member)
{
  return (member == meeting->lead_driver) == (meeting->side == EO_DRIVE_FLANK);
}

/* theory (P4): what an eccentric toothing displaces tooth i towards the mate, along the line of action over
   cos(alpha_t); and what an axial displacement does, z tan(beta) on the reference circle, on the drive flank of a right
   pinion away from the mate. */
static double displaced(const struct eo_pitch_member *own, const struct eo_geometry *geometry,
                        const struct eo_pitch_meeting *meeting, int member, int end, int i)
{
  double turn = 2 * M_PI * i / geometry->teeth[member], away = turn - own->eccentricity_angle,
         along = own->eccentricity *
                 sin(geometry->working_pressure_angle + (looks_ahead(meeting, member) ? away : -away)),
         axial = own->wobble * cos(turn - own->wobble_angle),
         sense = ((end == EO_RIGHT) == (member == EO_PINION) ? -1 : 1) * (meeting->inwards ? -1 : 1);
  return along / cos(geometry->transverse_pressure_angle) + sense * axial * tan(geometry->helix_angle);
}

/* The table of a term: stated, drawn into `drawn`, or none (NULL). */
static enum eo_code table_of(const struct eo_pitch *pitch, const struct eo_geometry *geometry,
                             const struct eo_pitch_meeting *meeting, int member, int end, enum eo_tooth_term term,
                             double *drawn, const double **table, struct eo_error *error)
{
  const struct eo_pitch_member *own = &pitch->member[member];
  uint64_t stream = 4 * (uint64_t)meeting->side + 2 * (uint64_t)member + (uint64_t)end;
  struct eo_flank_tolerance tolerance;
  int teeth = geometry->teeth[member];
  *table = eo_tooth_table_at(&pitch->tables, meeting->side, member, end, term);
  if (*table || (term == EO_TOOTH_INDEX ? own->tolerance_class : own->flank_class) == 0)
    return EO_OK;
  *table = drawn;
  if (term == EO_TOOTH_INDEX)
    return draw_index(own, geometry, member, stream, drawn, error);
  EO_TRY(class_tolerance(&tolerance, own, own->flank_class, "flank_class", geometry, member, error));
  eo_tooth_form_draw(&tolerance, own->tolerance_share, term, teeth, own->seed, stream, drawn);
  return EO_OK;
}

enum eo_code eo_pitch_compose(const struct eo_pitch *pitch, const struct eo_geometry *geometry,
                              const struct eo_pitch_meeting *meeting, int member, int end,
                              struct eo_tooth_deviation *tooth, struct eo_error *error)
{
  static const double none = 0;
  const struct eo_pitch_member *own = &pitch->member[member];
  const double *table[EO_TOOTH_TERMS] = {NULL};
  int teeth = geometry->teeth[member];
  double *drawn = malloc(sizeof *drawn * EO_TOOTH_TERMS * (size_t)teeth);
  enum eo_code code = drawn ? EO_OK : eo_error_memory(error);
  for (int term = 0; term < EO_TOOTH_TERMS && !code; term++)
    code = table_of(pitch, geometry, meeting, member, end, (enum eo_tooth_term)term,
                    drawn + (size_t)term * (size_t)teeth, &table[term], error);
  for (int i = 0; i < teeth && !code; i++) {
    const double *value[EO_TOOTH_TERMS];
    for (int term = 0; term < EO_TOOTH_TERMS; term++)
      value[term] = table[term] ? &table[term][i] : &none;
    tooth[i] =
        (struct eo_tooth_deviation){.index = *value[EO_TOOTH_INDEX] + displaced(own, geometry, meeting, member, end, i),
                                    .profile_slope = *value[EO_TOOTH_PROFILE_SLOPE],
                                    .helix_slope = *value[EO_TOOTH_HELIX_SLOPE],
                                    .profile_crowning = *value[EO_TOOTH_PROFILE_CROWNING],
                                    .lead_crowning = *value[EO_TOOTH_LEAD_CROWNING]};
  }
  free(drawn);
  return code;
}

/* Ahead the teeth come in the order in which they are counted; C grows ahead on drive flanks that the pinion drives and
   on coast flanks when the gear is the one that drives ahead. On the coast flanks the pinion's tooth 0 stands in the
   next space of the gear. */
int eo_pitch_tooth(const struct eo_pitch *pitch, const struct eo_pitch_meeting *meeting, int member, int teeth,
                   int place)
{
  bool rising = (meeting->side == EO_DRIVE_FLANK) == (meeting->lead_driver == EO_PINION);
  int next = meeting->lead_driver == EO_PINION ? 1 : -1, at = rising ? place : -place;
  if (member == EO_GEAR)
    at += pitch->gear_tooth + (meeting->side == EO_COAST_FLANK ? next : 0);
  at %= teeth;
  return at < 0 ? at + teeth : at;
}

void eo_pitch_order(const struct eo_pitch *pitch, const struct eo_pitch_meeting *meeting, int member, int teeth,
                    const struct eo_tooth_deviation *tooth, struct eo_tooth_deviation *ordered)
{
  for (int i = 0; i < teeth; i++)
    ordered[i] = tooth[eo_pitch_tooth(pitch, meeting, member, teeth, i)];
}

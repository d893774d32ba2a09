/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hunting period of a result: the teeth as they were taken, and what each load case makes of them. */
#include <stdlib.h>

#include "document/result_pitch_private.h"

/* Deviations as they were taken: */

struct pitch_flank {
  struct eo_pitch_size size;
  struct eo_series index;
};
static const struct eo_outline_row flank_rows[] = {
    EO_KEY("total_um", "number", "F_p, with eccentricity and wobble", .unit = &eo_unit_um,
           EO_AT(struct pitch_flank, size.total)),
    EO_KEY("single_um", "number", "f_p, the same", .unit = &eo_unit_um, EO_AT(struct pitch_flank, size.single)),
    EO_KEY("index_um", "[number]", "F of each tooth with all that was stated or drawn", .unit = &eo_unit_um,
           EO_AT(struct pitch_flank, index)),
};
static const struct eo_outline flank_outline = EO_OUTLINE("PitchFlank", flank_rows);

struct pitch_sides {
  json_t *side[2]; /* [flank side] */
};
static const struct eo_outline_row sides_rows[] = {
    EO_KEY("drive", "object?", "null: no load case has these flanks", .outline = &flank_outline,
           EO_AT(struct pitch_sides, side[EO_DRIVE_FLANK])),
    EO_KEY("coast", "object?", "the same", .outline = &flank_outline, EO_AT(struct pitch_sides, side[EO_COAST_FLANK])),
};
static const struct eo_outline sides_outline = EO_OUTLINE("PitchSides", sides_rows);

static const struct eo_outline_row tolerance_rows[] = {
    EO_KEY("total_um", "number?", "F_pT of the tolerance class; null where none is stated", .unit = &eo_unit_um,
           EO_AT(struct eo_flank_tolerance, total_pitch)),
    EO_KEY("single_um", "number?", "f_pT", .unit = &eo_unit_um, EO_AT(struct eo_flank_tolerance, single_pitch)),
};
static const struct eo_outline tolerance_outline = EO_OUTLINE("PitchTolerance", tolerance_rows);

static const struct eo_outline_row of_ends_rows[] = {EO_PITCH_END_ROWS(&sides_outline)};
static const struct eo_outline of_ends_outline = EO_OUTLINE(NULL, of_ends_rows);

struct pitch_member {
  struct eo_flank_tolerance tolerance;
  struct eo_pitch_ends ends;
};
static const struct eo_outline_row member_rows[] = {
    EO_KEY("tolerance", "object", "what the class allows", .outline = &tolerance_outline,
           EO_AT(struct pitch_member, tolerance)),
    {.outline = &of_ends_outline, EO_AT(struct pitch_member, ends)},
};
static const struct eo_outline member_outline = EO_OUTLINE("PitchMember", member_rows);

static json_t *encode_flank(const struct eo_result_source *source, int side, int member, int end)
{
  const struct eo_pitch_analysis *analysis = &source->analysis->pitch;
  int teeth = source->pair->geometry.teeth[member];
  if (!analysis->used[side])
    return json_null();
  double *index = malloc(sizeof *index * (size_t)teeth);
  if (!index)
    return NULL;
  for (int i = 0; i < teeth; i++)
    index[i] = analysis->tooth[side][member][end][i].index;
  const struct pitch_flank flank = {analysis->size[side][member][end], eo_series_of(teeth, index, EO_DIGITS_MAP)};
  json_t *object = eo_outline_encode(&flank_outline, &flank);
  free(index);
  return object;
}

static json_t *encode_member(const struct eo_result_source *source, int member)
{
  struct pitch_member view = {.tolerance = source->analysis->pitch.tolerance[member], .ends.two = source->ends == 2};
  for (int end = 0; end < source->ends; end++) {
    struct pitch_sides sides = {
        {encode_flank(source, EO_DRIVE_FLANK, member, end), encode_flank(source, EO_COAST_FLANK, member, end)}};
    view.ends.end[end] = eo_outline_encode(&sides_outline, &sides);
  }
  return eo_outline_encode(&member_outline, &view);
}

static json_t *write_pinion(const void *source)
{
  return encode_member(source, EO_PINION);
}

static json_t *write_gear(const void *source)
{
  return encode_member(source, EO_GEAR);
}

static const struct eo_outline_row deviations_rows[] = {
    EO_KEY("pinion", "object", "teeth of the pinion", .outline = &member_outline, .write = write_pinion),
    EO_KEY("gear", "object", "teeth of the gear", .outline = &member_outline, .write = write_gear),
};
static const struct eo_outline deviations_outline = EO_OUTLINE("PitchDeviations", deviations_rows);

/* The whole: */

struct pitch {
  int cycles, positions;
  double revolutions[2]; /* [member] */
  const char *slopes;
  json_t *deviations, *cases;
};

#define OF_PITCH(member) EO_AT(struct pitch, member)
static const struct eo_outline_row pitch_rows[] = {
    EO_KEY("cycles", "integer", "mesh cycles after which the same teeth meet again", OF_PITCH(cycles)),
    EO_KEY("pinion_revolutions", "number", "in that period", OF_PITCH(revolutions[EO_PINION])),
    EO_KEY("gear_revolutions", "number", "in that period", OF_PITCH(revolutions[EO_GEAR])),
    EO_KEY("positions_per_cycle", "integer", "mesh positions that were computed", OF_PITCH(positions)),
    EO_KEY("slopes", "text", "how the flank slopes of single teeth were taken", OF_PITCH(slopes)),
    EO_KEY("deviations", "object", "of the teeth as they were taken", .outline = &deviations_outline,
           OF_PITCH(deviations)),
    EO_KEY("load_cases", "[object]", "in the order of the design", .outline = &eo_outline_pitch_case, OF_PITCH(cases)),
};
const struct eo_outline eo_outline_pitch = EO_OUTLINE("Pitch", pitch_rows);

json_t *eo_result_pitch(const struct eo_result_source *source)
{
  const struct eo_pitch_analysis *analysis = &source->analysis->pitch;
  if (analysis->cases == 0)
    return json_null();
  const struct eo_hunting *hunting = &analysis->load_case[0].hunting;
  struct eo_object cases = eo_list_open();
  for (int k = 0; k < analysis->cases; k++)
    eo_list_add(&cases, eo_result_pitch_case(source, k));
  const struct pitch view = {
      .cycles = hunting->cycles,
      .positions = hunting->positions,
      .revolutions = {(double)hunting->cycles / hunting->teeth[EO_PINION],
                      (double)hunting->cycles / hunting->teeth[EO_GEAR]},
      .slopes = "added to the gap to first order; 10 um of slope and twist are up to 0.06 um off",
      .deviations = eo_outline_encode(&deviations_outline, source),
      .cases = eo_object_close(&cases),
  };
  return eo_outline_encode(&eo_outline_pitch, &view);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Root stress of a load case: histories and largest values of both members. */
#include <math.h>

#include "document/result_private.h"

/* Largest stress of one tooth over its way through the mesh, NULL: left out. */
static struct eo_series history_of(const struct eo_result_source *source, const struct eo_root_history *history,
                                   const double *value)
{
  return eo_series_of(history->phases, value, EO_DIGITS_CURVE | source->ready);
}

struct root_end {
  double maximum, dynamic, arc, eta; /* Pa, m */
  struct eo_series history;
};

static const struct eo_outline_row root_end_rows[] = {
    EO_KEY("max_MPa", "number?", "largest static root stress of the end", .unit = &eo_unit_MPa,
           EO_AT(struct root_end, maximum)),
    EO_KEY("max_dynamic_MPa", "number?", "times the dynamic factor; null without a periodic vibration",
           .unit = &eo_unit_MPa, EO_AT(struct root_end, dynamic)),
    EO_KEY("arc_mm", "number?", "its place along the fillet", .unit = &eo_unit_mm, EO_AT(struct root_end, arc)),
    EO_KEY("eta_mm", "number?", "its place along the face", .unit = &eo_unit_mm, EO_AT(struct root_end, eta)),
    EO_KEY("history_MPa", "[number?]?",
           "largest stress of one tooth over `position` of the member; null without histories", .unit = &eo_unit_MPa,
           EO_AT(struct root_end, history)),
};
static const struct eo_outline root_end = EO_OUTLINE("RootStressEnd", root_end_rows);

static double force_factor(const struct eo_case_result *case_result, int end)
{
  return case_result->vibration.outcome == EO_VIBRATION_NOT_CONVERGED
             ? NAN
             : fmax(1, case_result->vibration.dynamic_factor[end]);
}

struct root_member {
  bool two;
  double maximum, dynamic; /* Pa, of the worse end */
  struct eo_series position, history;
  struct root_end end[2];
};

#define OF_MEMBER(member) EO_AT(struct root_member, member)
static const struct eo_outline_row root_member_rows[] = {
    EO_KEY("max_MPa", "number?", "largest static root stress, worse end", .unit = &eo_unit_MPa, OF_MEMBER(maximum)),
    EO_KEY("max_dynamic_MPa", "number?", "times the dynamic factor of its end; null without a periodic vibration",
           .unit = &eo_unit_MPa, OF_MEMBER(dynamic)),
    EO_KEY("position", "[number]?", "phase of the tooth's way through the mesh, in mesh cycles; null without histories",
           OF_MEMBER(position)),
    EO_KEY("history_MPa", "[number?]?", "of the worse end; null without histories", .unit = &eo_unit_MPa,
           OF_MEMBER(history)),
    EO_KEY("left", "object", "left end", .outline = &root_end, OF_MEMBER(end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &root_end, OF_MEMBER(end[EO_RIGHT]),
           EO_IF(struct root_member, two)),
};
static const struct eo_outline root_member = EO_OUTLINE("RootStressMember", root_member_rows);

static struct root_member find_member(const struct eo_result_source *source, const struct eo_case_result *case_result,
                                      int member)
{
  const struct eo_root_history *history[2] = {&case_result->end[0].root[member], &case_result->end[1].root[member]};
  const struct eo_root_history *worse = source->ends == 2 && history[1]->maximum > history[0]->maximum ? history[1]
                                                                                                       : history[0];
  bool wanted = eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result);
  struct root_member view = {.two = source->ends == 2,
                             .maximum = worse->maximum,
                             .position = history_of(source, history[0], wanted ? history[0]->phase : NULL),
                             .history = history_of(source, worse, wanted ? worse->stress : NULL)};
  for (int end = 0; end < source->ends; end++) {
    double factor = force_factor(case_result, end), dynamic = history[end]->maximum * factor;
    view.end[end] = (struct root_end){history[end]->maximum, dynamic, history[end]->arc, history[end]->eta,
                                      history_of(source, history[end], wanted ? history[end]->stress : NULL)};
    view.dynamic = isnan(factor) ? NAN : fmax(view.dynamic, dynamic);
  }
  return view;
}

struct root {
  struct root_member member[2];
};

static const struct eo_outline_row root_rows[] = {
    EO_KEY("pinion", "object", "pinion", .outline = &root_member, EO_AT(struct root, member[EO_PINION])),
    EO_KEY("gear", "object", "gear", .outline = &root_member, EO_AT(struct root, member[EO_GEAR])),
};
const struct eo_outline eo_outline_root_stress = EO_OUTLINE("RootStress", root_rows);

json_t *eo_result_root_stress(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  if (!source->analysis->root)
    return json_null();
  const struct root view = {{find_member(source, case_result, EO_PINION), find_member(source, case_result, EO_GEAR)}};
  return eo_outline_encode(&eo_outline_root_stress, &view);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Root stress of a load case: histories and largest values of both members. */
#include <math.h>

#include "document/result_private.h"

static json_t *encode_root_history(const struct eo_root_history *history, bool wanted)
{
  return wanted ? eo_json_reals(history->phases, history->stress, 1, &eo_unit_MPa, EO_DIGITS_CURVE) : json_null();
}

struct root_end {
  const struct eo_root_history *history;
  bool wanted;                       /* the history itself */
  double maximum, dynamic, arc, eta; /* Pa, m */
};

static json_t *write_root_history(const void *source)
{
  const struct root_end *end = source;
  return encode_root_history(end->history, end->wanted);
}

static const struct eo_outline_row root_end_rows[] = {
    EO_KEY("max_MPa", "number?", "largest static root stress of the end", .unit = &eo_unit_MPa,
           EO_AT(struct root_end, maximum)),
    EO_KEY("max_dynamic_MPa", "number?", "times the dynamic factor; null without a periodic vibration",
           .unit = &eo_unit_MPa, EO_AT(struct root_end, dynamic)),
    EO_KEY("arc_mm", "number?", "its place along the fillet", .unit = &eo_unit_mm, EO_AT(struct root_end, arc)),
    EO_KEY("eta_mm", "number?", "its place along the face", .unit = &eo_unit_mm, EO_AT(struct root_end, eta)),
    EO_KEY("history_MPa", "[number?]?",
           "largest stress of one tooth over `position` of the member; null without histories", .unit = &eo_unit_MPa,
           .write = write_root_history),
};
static const struct eo_outline root_end = EO_OUTLINE("RootStressEnd", root_end_rows);

static json_t *encode_root_end(const struct eo_root_history *history, double factor, bool wanted)
{
  const struct root_end end = {history,      wanted,      history->maximum, history->maximum * factor,
                               history->arc, history->eta};
  return eo_outline_encode(&root_end, &end);
}

static double force_factor(const struct eo_case_result *case_result, int end)
{
  return case_result->vibration.outcome == EO_VIBRATION_NOT_CONVERGED
             ? NAN
             : fmax(1, case_result->vibration.dynamic_factor[end]);
}

static const struct eo_outline_row root_member_rows[] = {
    EO_KEY("max_MPa", "number?", "largest static root stress, worse end", .unit = &eo_unit_MPa),
    EO_KEY("max_dynamic_MPa", "number?", "times the dynamic factor of its end; null without a periodic vibration",
           .unit = &eo_unit_MPa),
    EO_KEY("position", "[number]?",
           "phase of the tooth's way through the mesh, in mesh cycles; null without histories"),
    EO_KEY("history_MPa", "[number?]?", "of the worse end; null without histories", .unit = &eo_unit_MPa),
    EO_KEY("left", "object", "left end", .outline = &root_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &root_end),
};
static const struct eo_outline root_member = EO_OUTLINE("RootStressMember", root_member_rows);

static json_t *encode_root_member(const struct eo_result_source *source, const struct eo_case_result *case_result,
                                  int member)
{
  const struct eo_root_history *history[2] = {&case_result->end[0].root[member], &case_result->end[1].root[member]};
  int worst = source->ends == 2 && history[1]->maximum > history[0]->maximum ? EO_RIGHT : EO_LEFT;
  double dynamic = 0;
  bool wanted = eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result);
  struct eo_object object = eo_object_open_as(&root_member);
  for (int end = 0; end < source->ends; end++)
    dynamic = isnan(force_factor(case_result, end))
                  ? NAN
                  : fmax(dynamic, history[end]->maximum * force_factor(case_result, end));
  eo_object_put_number(&object, "max_MPa", history[worst]->maximum);
  eo_object_put_number(&object, "max_dynamic_MPa", dynamic);
  eo_object_put(&object, "position",
                wanted ? eo_json_reals(history[0]->phases, history[0]->phase, 1, NULL, EO_DIGITS_CURVE) : json_null());
  eo_object_put(&object, "history_MPa", encode_root_history(history[worst], wanted));
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_root_end(history[end], force_factor(case_result, end), wanted));
  return eo_object_close(&object);
}

static const struct eo_outline_row root_rows[] = {
    EO_KEY("pinion", "object", "pinion", .outline = &root_member),
    EO_KEY("gear", "object", "gear", .outline = &root_member),
};
const struct eo_outline eo_outline_root_stress = EO_OUTLINE("RootStress", root_rows);

json_t *eo_result_root_stress(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  if (!source->analysis->root)
    return json_null();
  struct eo_object object = eo_object_open_as(&eo_outline_root_stress);
  for (int member = 0; member < 2; member++)
    eo_object_put(&object, eo_result_member[member], encode_root_member(source, case_result, member));
  return eo_object_close(&object);
}

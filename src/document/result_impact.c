/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The entering impact of a load case. */
#include <math.h>

#include "document/result_private.h"

struct impact_end {
  struct eo_impact impact;
  double lead; /* m before the path of contact */
};

static bool has_touched(const void *source)
{
  return ((const struct impact_end *)source)->impact.touched;
}

static bool has_struck(const void *source)
{
  return has_touched(source) && ((const struct impact_end *)source)->impact.force > 0;
}

#define OF_IMPACT(member) EO_AT(struct impact_end, impact.member)
static const struct eo_outline_row impact_end_rows[] = {
    EO_KEY("force_N", "number?", "of the classical impact: 0 when first touch happens on the line of action",
           .unit = &eo_unit_N, OF_IMPACT(classical)),
    EO_KEY("general_force_N", "number?", "of the general impact, wherever first touch happens", .unit = &eo_unit_N,
           OF_IMPACT(force)),
    EO_KEY("speed_mm_per_s", "number?", "of approach along the normal", .unit = &eo_unit_mm_per_s, OF_IMPACT(speed)),
    EO_KEY("duration_ms", "number?", "of the half sine; null without a force", .unit = &eo_unit_ms, OF_IMPACT(duration),
           .known = has_struck),
    EO_KEY("off_line", "flag", "first touch happens before the line of action", OF_IMPACT(off_line)),
    EO_KEY("position", "number?", "phase of first touch (EMIP); null, as all below, when nothing touches",
           OF_IMPACT(start), .known = has_touched),
    EO_KEY("eta_mm", "number?", "its place along the face", .unit = &eo_unit_mm, OF_IMPACT(eta), .known = has_touched),
    EO_KEY("s_mm", "number?", "its roll from the pitch point", .unit = &eo_unit_mm, OF_IMPACT(path),
           .known = has_touched),
    EO_KEY("lead_before_A_mm", "number?", "how far before the path of contact", .unit = &eo_unit_mm,
           EO_AT(struct impact_end, lead), .known = has_touched),
    EO_KEY("pinion_radius_mm", "number?", "where the gear's tip meets the pinion's flank", .unit = &eo_unit_mm,
           OF_IMPACT(pinion_radius), .known = has_touched),
};
static const struct eo_outline impact_end = EO_OUTLINE("ImpactEnd", impact_end_rows);

struct impact {
  bool two;
  struct impact_end end[2];
};

static const struct eo_outline_row impact_rows[] = {
    EO_KEY("left", "object", "left end", .outline = &impact_end, EO_AT(struct impact, end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &impact_end,
           EO_AT(struct impact, end[EO_RIGHT]), EO_IF(struct impact, two)),
};
const struct eo_outline eo_outline_impact = EO_OUTLINE("Impact", impact_rows);

json_t *eo_result_impact(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  struct impact view = {.two = source->ends == 2};
  for (int end = 0; end < source->ends; end++) {
    const struct eo_impact *found = &case_result->end[end].impact;
    view.end[end] = (struct impact_end){*found, fmax(0, source->pair->geometry.path_start - found->path)};
    view.end[end].impact.off_line = found->touched && found->off_line;
  }
  return eo_outline_encode(&eo_outline_impact, &view);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage.h"
#include "document/design_document.h"
#include "document/geometry_table.h"
#include "gear/entry.h"

struct input {
  struct eo_gear_pair gear_pair;
};

static const struct eo_field input[] = {
    EO_OBJECT(struct input, gear_pair, "gear_pair", &eo_gear_pair_table, "as in a design document"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  struct eo_gear_pair pair = ((const struct input *)in)->gear_pair;
  EO_TRY(eo_gear_pair_settle(&pair, error));
  return eo_geometry_init(out, &pair, error);
}

const struct eo_stage eo_stage_geometry = {
    "geometry", "macro-geometry of a gear pair: every derived quantity", &input_table, &eo_geometry_table, false, run};

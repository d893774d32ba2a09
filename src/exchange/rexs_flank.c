/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modifications of a pair, flank by flank: one table of what REXS has, and one of the keys that take it. A key that
   a design comes to have is one more row. */
#include "exchange/rexs_flank.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "document/design_document.h"
#include "gear/names.h"

/* The table of a flank's keys. */
static const struct eo_table *flank_table(void)
{
  return eo_member_modification_table.field[EO_LEFT].table;
}

/* Kinds of modifications, in the order in which they are read: a crowning needs to know the reliefs. */
static const struct {
  const char *type;
  eo_rexs_modification *read; /* NULL: a design cannot say it */
  const char *key, *elder;    /* of a design that takes it; the reason of a refusal when it has neither */
} kinds[] = {
    {"tip_relief", eo_rexs_tip_relief, "tip_relief_um", NULL},
    {"root_relief", eo_rexs_root_relief, "root_relief_um", NULL},
    {"profile_crowning", eo_rexs_profile_crowning, "profile_crowning_per_mm", NULL},
    {"profile_slope", eo_rexs_profile_slope, "profile_slope_um", NULL},
    {"profile_twist", eo_rexs_profile_twist, "twist_um", NULL},
    {"helix_crowning", eo_rexs_helix_crowning, "lead_crowning_um", NULL},
    {"helix_slope", eo_rexs_helix_slope, "helix_slope_um", "lead_slope_um"},
    {"end_relief_datum_face", eo_rexs_end_relief, "leading_end_relief_um", NULL},
    {"end_relief_non_datum_face", eo_rexs_end_relief, "leading_end_relief_um", NULL},
    {"topographical_modification", eo_rexs_topography, "grid", NULL},
    {"triangular_tip_relief", NULL, NULL, NULL},
    {"triangular_root_relief", NULL, NULL, NULL},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

#define AT(member) offsetof(struct eo_rexs_flank, member)

/* Where what was read goes: mm or 1/mm times factor. */
static const struct {
  const char *key;
  size_t offset;
  double factor;
  const char *instead_of; /* left out where the design has this key as well */
} numbers[] = {
    {"tip_relief_um", AT(tip_relief), 1e3, NULL},
    {"tip_relief_start_mm", AT(tip_start), 1, NULL},
    {"root_relief_um", AT(root_relief), 1e3, NULL},
    {"root_relief_start_mm", AT(root_start), 1, NULL},
    {"profile_crowning_per_mm", AT(crowning), 1, NULL},
    {"profile_crowning_um", AT(barrel), 1e3, NULL},
    {"profile_slope_um", AT(profile_slope), 1e3, NULL},
    {"twist_um", AT(twist), 1e3, NULL},
    {"lead_crowning_um", AT(lead_crowning), 1e3, NULL},
    {"helix_slope_um", AT(helix_slope), 1e3, NULL},
    {"lead_slope_um", AT(helix_slope), 500, "helix_slope_um"}, /* half of it, at the face end */
    {"lead_offset_um", AT(lead_offset), 1e3, NULL},
    {"trailing_end_relief_um", AT(end_relief[0]), 1e3, NULL},
    {"trailing_end_relief_length_mm", AT(end_length[0]), 1, NULL},
    {"leading_end_relief_um", AT(end_relief[1]), 1e3, NULL},
    {"leading_end_relief_length_mm", AT(end_length[1]), 1, NULL},
};

static double *number_at(struct eo_rexs_flank *flank, size_t offset)
{
  void *at = (char *)flank + offset;
  return at;
}

static void refuse(struct eo_rexs_flank *flank, const struct eo_rexs_component *modification, const char *why)
{
  struct eo_import *out = flank->import->out;
  char name[80];
  eo_import_say(out, out->refused, "%s%s%s%s", eo_rexs_name(modification, name), flank->coast ? " (coast flank)" : "",
                *why ? ": " : "", why);
}

static bool takes(const char *key)
{
  return key && eo_import_has_key(flank_table(), key);
}

/* Whether a modification of this kind at another place of the face stands at the flank too. */
static bool is_interpolated(const struct eo_rexs_flank *flank, const struct eo_rexs_component *component,
                            const struct eo_rexs_component *modification)
{
  const struct eo_rexs_component *other;
  double place = eo_rexs_value(modification, "position_of_profile_modification");
  for (int at = 0;
       (other = eo_rexs_related(flank->import->model, "reference", "origin", component, "referenced", &at));)
    if (other != modification && eo_rexs_is(other, modification->type) &&
        eo_rexs_value(other, "position_of_profile_modification") != place && !isnan(place))
      return true;
  return false;
}

static void read_one(struct eo_rexs_flank *flank, const struct eo_rexs_component *component, int kind,
                     const struct eo_rexs_component *modification, int *seen)
{
  struct eo_import *out = flank->import->out;
  const struct eo_rexs_attribute *additive = eo_rexs_attribute(modification, "is_additive_modification");
  bool replaces = additive && strcmp(additive->text, "false") == 0;
  char name[80];
  if (!kinds[kind].read || !(takes(kinds[kind].key) || takes(kinds[kind].elder))) {
    refuse(flank, modification, kinds[kind].read ? "" : "REXS does not say how far it reaches along the face");
    return;
  }
  if (is_interpolated(flank, component, modification)) {
    refuse(flank, modification, "several positions on the face mean a profile between them, which has no key");
    return;
  }
  if (++*seen > 1 && !replaces) {
    refuse(flank, modification, "the flank has another one of its kind, and their sum has no key");
    return;
  }
  if (*seen > 1)
    eo_import_say(out, out->notes, "%s stands in place of the one before it.", eo_rexs_name(modification, name));
  const char *why = kinds[kind].read(flank, modification);
  if (*why)
    refuse(flank, modification, why);
}

/* Both reliefs have one shape where the design has one key for it: the larger one's. */
static void settle_shapes(struct eo_rexs_flank *flank)
{
  bool both = flank->tip_relief > 0 && flank->root_relief > 0;
  if (!both || strcmp(flank->tip_shape, flank->root_shape) == 0 || takes("tip_relief_shape"))
    return;
  bool tip_goes = flank->tip_relief < flank->root_relief;
  eo_import_say(flank->import->out, flank->import->out->refused,
                "%s_relief of the %s's flank: shape %s, but the larger relief has shape %s", tip_goes ? "tip" : "root",
                eo_member_name[flank->member], tip_goes ? flank->tip_shape : flank->root_shape,
                tip_goes ? flank->root_shape : flank->tip_shape);
  *(tip_goes ? &flank->tip_relief : &flank->root_relief) = NAN;
  *(tip_goes ? &flank->tip_start : &flank->root_start) = NAN;
}

/* A design states a relief with the crowning below it: exact for parabolas alone. */
static void add_crowning(struct eo_rexs_flank *flank)
{
  if (isnan(flank->crowning))
    return;
  bool other = (flank->tip_relief > 0 && strcmp(flank->tip_shape, "parabolic") != 0) ||
               (flank->root_relief > 0 && strcmp(flank->root_shape, "parabolic") != 0);
  if (other) {
    eo_import_say(flank->import->out, flank->import->out->refused,
                  "profile_crowning of the %s's flank: together with a relief that is not parabolic it has no key",
                  eo_member_name[flank->member]);
    flank->crowning = NAN;
    return;
  }
  if (!isnan(flank->tip_relief))
    flank->tip_relief += flank->crowning * pow(eo_rexs_tip_end(flank), 2);
  if (!isnan(flank->root_relief))
    flank->root_relief += flank->crowning * pow(eo_rexs_root_end(flank), 2);
}

static void put_shapes(struct eo_rexs_flank *flank, json_t *object)
{
  const struct eo_table *table = flank_table();
  static const char *const end_key[2] = {"trailing_end_relief_shape", "leading_end_relief_shape"};
  const char *tip = flank->tip_relief > 0 ? flank->tip_shape : NULL,
             *root = flank->root_relief > 0 ? flank->root_shape : NULL;
  if (tip || root)
    eo_rexs_put_word(flank->import, table, object, "relief_shape", tip ? tip : root);
  if (tip && root && strcmp(tip, root) != 0)
    eo_rexs_put_word(flank->import, table, object, "root_relief_shape", root);
  for (int i = 0; i < 2; i++) {
    bool plain = !flank->end_shape[i] || strcmp(flank->end_shape[i], "parabolic") == 0;
    if (!plain && !eo_rexs_put_word(flank->import, table, object, end_key[i], flank->end_shape[i])) {
      eo_import_say(flank->import->out, flank->import->out->refused, "end relief of the %s's flank: shape %s",
                    eo_member_name[flank->member], flank->end_shape[i]);
      flank->end_relief[i] = flank->end_length[i] = NAN;
    }
  }
}

static void put_flank(struct eo_rexs_flank *flank, json_t *object)
{
  settle_shapes(flank);
  add_crowning(flank);
  put_shapes(flank, object);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (!takes(numbers[i].instead_of))
      eo_rexs_put(flank->import, flank_table(), object, numbers[i].key,
                  *number_at(flank, numbers[i].offset) * numbers[i].factor);
  if (!isnan(flank->barrel) && !takes("profile_crowning_um"))
    eo_import_say(flank->import->out, flank->import->out->refused,
                  "profile_crowning of the %s's flank: its highest point is not the pitch point",
                  eo_member_name[flank->member]);
  if (flank->grid)
    json_object_set(object, "grid", flank->grid);
}

static void set_up(struct eo_rexs_flank *flank, struct eo_rexs_import *import, int member, int end, bool coast)
{
  const struct eo_rexs_wheel *wheel = &import->wheel[member][end];
  const struct eo_rexs_attribute *datum = eo_rexs_attribute(wheel->gear, "datum_face_orientation");
  memset(flank, 0, sizeof *flank);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    *number_at(flank, numbers[i].offset) = NAN;
  flank->import = import;
  flank->wheel = wheel;
  flank->member = member;
  flank->end = end;
  flank->coast = coast;
  flank->half = eo_geometry_of_half(&import->geometry, &import->gear_pair, end);
  flank->amount = import->options->transverse ? cos(flank->half.base_helix_angle) : 1;
  flank->leading = import->wheel[EO_PINION][end].helix * import->rotation < 0 ? -1 : 1;
  flank->datum = datum && strcmp(datum->text, "positive") == 0 ? wheel->along : -wheel->along;
  flank->width = import->width[end];
  flank->shift = (wheel->left + wheel->right - import->left[end] - import->right[end]) / 2;
  if (fabs(flank->shift) < 1e-9 * flank->width)
    flank->shift = 0;
  if (datum && strcmp(datum->text, "positive") == 0)
    eo_import_say(import->out, import->out->assumed,
                  "datum_face_orientation positive: coordinates of modifications are negative at the datum face");
}

static void read_flank(struct eo_rexs_import *import, json_t *modification, int member, int end, bool coast)
{
  struct eo_rexs_flank flank;
  int side = eo_rexs_loaded_side(import, member, end);
  const struct eo_rexs_component *component = import->wheel[member][end].flank[coast ? !side : side], *found;
  bool any = false;
  char name[80];
  set_up(&flank, import, member, end, coast);
  for (int kind = 0; kind < KINDS; kind++) {
    int seen = 0;
    for (int at = 0; (found = eo_rexs_related(import->model, "reference", "origin", component, "referenced", &at));) {
      if (!eo_rexs_is(found, kinds[kind].type))
        continue;
      any = true;
      if (coast && !takes("coast"))
        eo_import_say(import->out, import->out->not_used, "%s (coast flank)", eo_rexs_name(found, name));
      else
        read_one(&flank, component, kind, found, &seen);
    }
  }
  double offset = eo_rexs_value(component, "custom_easeoff_lead_offset");
  if (!isnan(offset))
    flank.lead_offset = (isnan(flank.lead_offset) ? 0 : flank.lead_offset) + offset * flank.amount;
  any = any || !isnan(offset);
  if (any && (!coast || takes("coast"))) {
    json_t *object = eo_rexs_part(import, eo_rexs_part(import, modification, eo_member_name[member]), eo_end_name[end]);
    put_flank(&flank, coast ? eo_rexs_part(import, object, "coast") : object);
    eo_import_say(import->out, import->out->assumed,
                  import->options->transverse ? "amounts stand in the transverse section and were turned to the normal"
                                              : "amounts are normal to the flank");
  }
  json_decref(flank.grid);
}

void eo_rexs_read_modification(struct eo_rexs_import *import, json_t *design)
{
  json_t *modification = eo_rexs_part(import, design, "modification");
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < import->pair->ends; end++)
      for (int coast = 0; coast < 2; coast++)
        read_flank(import, modification, member, end, coast);
}

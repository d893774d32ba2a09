/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/scatter_teeth.h"

#include <stdio.h>
#include <string.h>

#include "document/pitch_document.h"
#include "gear/names.h"

static size_t place_of(int member, size_t offset)
{
  return offsetof(struct eo_design, pitch.member) + (size_t)member * sizeof(struct eo_pitch_member) + offset;
}

bool eo_scatter_find_tooth_number(const char *name, int member, struct eo_tooth_number *number)
{
  size_t length = strcspn(name, "."), offset;
  bool meant = strncmp(name, "*.", 2) == 0 ||
               (strlen(eo_member_name[member]) == length && strncmp(name, eo_member_name[member], length) == 0);
  const struct eo_field *field = meant && name[length] ? eo_pitch_member_number(name + length + 1, &offset) : NULL;
  if (!field)
    return false;
  *number = (struct eo_tooth_number){.field = field, .offset = place_of(member, offset)};
  snprintf(number->key, sizeof number->key, "pitch.%s.%s", eo_member_name[member], field->key);
  return true;
}

enum eo_code eo_scatter_add_seeds(struct eo_scatter *scatter, struct eo_error *error)
{
  static const double DIFFERENT = 1e9;
  for (int member = 0; member < 2; member++) {
    if (scatter->inputs == EO_MAX_SCATTER_INPUTS)
      return eo_error_set(error, EO_ERROR_INPUT, "/tolerance/inputs",
                          "More inputs than the %d that can scatter at once with single teeth: state fewer.",
                          EO_MAX_SCATTER_INPUTS - 2);
    struct eo_scatter_input *input = &scatter->input[scatter->inputs++];
    *input = (struct eo_scatter_input){.target = EO_TARGET_SEED,
                                       .offset = place_of(member, offsetof(struct eo_pitch_member, seed)),
                                       .unit = 1,
                                       .most = DIFFERENT - 1,
                                       .deviation = {.kind = EO_DISTRIBUTION_UNIFORM, .high = DIFFERENT}};
    snprintf(input->key, sizeof input->key, "pitch.%s.seed", eo_member_name[member]);
  }
  return EO_OK;
}

enum eo_code eo_scatter_check_teeth(const struct eo_design *design, const struct eo_design *toothed,
                                    struct eo_error *error)
{
  struct eo_geometry geometry;
  EO_TRY(eo_geometry_init(&geometry, &design->gear_pair, error));
  enum eo_code code = eo_pitch_check(&toothed->pitch, &geometry, design->resolution.positions, error);
  if (!code || !error || !strstr(error->pointer, "/tolerance_class"))
    return code;
  int member = strstr(error->pointer, "/gear/") ? EO_GEAR : EO_PINION;
  if (design->pitch.member[member].tolerance_class == 0)
    snprintf(error->pointer, sizeof error->pointer, "/tolerance/class");
  return code;
}

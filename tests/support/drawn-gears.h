/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gears drawn at random as designers state them: 8 to 400 teeth, modules 0.3 to 30, helix 0 to 40 degrees, centre
   distances up to two modules off, shifts or none; lengths in mm or inches; none, one or two of hand, rotation and
   apex; torques and speeds of either sign. */
#ifndef EASEOFF_TESTS_SUPPORT_DRAWN_GEARS_H
#define EASEOFF_TESTS_SUPPORT_DRAWN_GEARS_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <jansson.h>

#include "base/error.h"
#include "base/random.h"

__attribute__((unused)) static double between(int index, int draw, double low, double high)
{
  return low + (high - low) * eo_random_unit(eo_random_at(1328, 0, 0, (uint64_t)index), (uint64_t)draw);
}

static void set_length(json_t *pair, const char *key, double mm, bool inches)
{
  char name[40];
  snprintf(name, sizeof name, "%s_%s", key, inches ? "in" : "mm");
  json_object_set_new(pair, name, json_real(inches ? mm / 25.4 : mm));
}

/* Two of the three say the third. */
static void set_turning(json_t *pair, json_t *alignment, int i)
{
  static const char *const words[3][2] = {{"right", "left"},
                                          {"clockwise", "counterclockwise"},
                                          {"trailing", "leading"}},
                           *const keys[3] = {"hand", "pinion_rotation", "apex"};
  int left_out = (int)between(i, 11, 0, 3);
  for (int k = 0; k < 3; k++)
    if (k != left_out && between(i, 12 + k, 0, 1) < 0.6)
      json_object_set_new(k == 0 ? pair : alignment, keys[k], json_string(words[k][between(i, 15 + k, 0, 1) < 0.5]));
}

/* A terse document. */
__attribute__((unused)) static json_t *drawn(int i)
{
  bool inches = between(i, 18, 0, 1) < 0.4;
  json_t *alignment = json_object();
  double module = exp(between(i, 0, log(0.3), log(30))), helix = between(i, 1, 0, 1) < 0.2 ? 0 : between(i, 2, 0, 40);
  int pinion = (int)exp(between(i, 3, log(8), log(120))), gear = (int)exp(between(i, 4, log(pinion), log(401)));
  double reference = module / cos(helix * M_PI / 180) * (pinion + gear) / 2;
  json_t *pair = json_pack("{s:i,s:i,s:i,s:f}", "ends", between(i, 5, 0, 1) < 0.5 ? 1 : 2, "pinion_teeth", pinion,
                           "gear_teeth", gear, "helix_angle_deg", helix);
  if (inches && between(i, 19, 0, 1) < 0.5)
    json_object_set_new(pair, "normal_diametral_pitch_per_inch", json_real(25.4 / module));
  else
    set_length(pair, "normal_module", module, inches);
  set_length(pair, "face_width", module * between(i, 6, 5, 25), inches);
  if (between(i, 7, 0, 1) < 0.6)
    set_length(pair, "centre_distance", reference + between(i, 8, -2, 2) * module, inches);
  if (between(i, 9, 0, 1) < 0.6)
    json_object_set_new(pair, "pinion_profile_shift", json_real(between(i, 10, -0.3, 0.8)));
  set_turning(pair, alignment, i);
  return json_pack("{s:o,s:o,s:[{s:f,s:i}]}", "gear_pair", pair, "alignment", alignment, "load_cases", "torque_Nm",
                   module * module * (between(i, 20, 0, 1) < 0.3 ? -10 : 10), "speed_rpm",
                   between(i, 21, 0, 1) < 0.3 ? -500 : 500);
}

static bool has_number(const char *text)
{
  return strpbrk(text, "0123456789") != NULL;
}

/* Refusals of what nobody states or an analysis does not use would be the program's, not the designer's. */
static bool is_own_fault(const char *pointer)
{
  static const char *const not_stated[] = {"/optimization",
                                           "/objective",
                                           "/supports",
                                           "/resolution",
                                           "/shafts",
                                           "/gear_pair/backlash_um",
                                           "/gear_pair/dedendum_coefficient",
                                           "/gear_pair/fillet_radius_coefficient",
                                           "/gear_pair/pinion_tip_diameter_mm",
                                           "/gear_pair/gear_tip_diameter_mm"};
  for (size_t i = 0; i < sizeof not_stated / sizeof *not_stated; i++)
    if (strncmp(pointer, not_stated[i], strlen(not_stated[i])) == 0)
      return true;
  return false;
}

/* Number, a key of the gear, and one that somebody may have stated. */
__attribute__((unused)) static bool is_fair_refusal(const struct eo_error *error)
{
  return has_number(error->text) && strncmp(error->pointer, "/gear_pair/", 11) == 0 && !is_own_fault(error->pointer);
}

#endif

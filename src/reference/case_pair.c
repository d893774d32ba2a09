/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/case_pair.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "gear/modification.h"

const char *const eo_case_end_name[4] = {"left", "right", "single", NULL};

/* Whichever of two spellings is there; the other then stays unread and is a fault. */
static double either(struct eo_case *object, const char *a, const char *b, double missing)
{
  return eo_case_find(object, a) ? eo_case_number(object, a) : eo_case_number_or(object, b, missing);
}

static void read_teeth(struct eo_case *input, int teeth[2])
{
  enum { MOST = 100000 };
  static const char *const key[2] = {"z1", "z2"};
  struct eo_case *both = eo_case_find(input, "z");
  double z[2] = {NAN, NAN};
  for (int i = 0; i < 2; i++) {
    if (both)
      z[i] = eo_case_element(both, i);
    else
      z[i] = eo_case_number(input, key[i]);
    bool whole = z[i] >= 1 && z[i] < MOST && z[i] == floor(z[i]);
    teeth[i] = whole ? (int)z[i] : 0;
    if (!whole && !isnan(z[i]))
      eo_case_fault(both ? both : eo_case_find(input, key[i]), "Numbers of teeth are whole, from 1.");
  }
}

static void read_shifts(struct eo_case *input, double shift[2])
{
  static const char *const key[2] = {"x1", "x2"};
  struct eo_case *both = eo_case_find(input, "x");
  for (int i = 0; i < 2; i++) {
    if (eo_case_is_list(both))
      shift[i] = eo_case_element(both, i);
    else if (both)
      shift[i] = eo_case_real(both);
    else
      shift[i] = eo_case_number_or(input, key[i], 0);
  }
}

static double positive(struct eo_case *input, const char *key, double value)
{
  if (value <= 0)
    eo_case_fault(eo_case_find(input, key), "A number above 0 is expected here.");
  return value;
}

/* What the reference computations took where a file says nothing: bearings and backlash of the paper's rig, tips that
   are not shortened. */
static void state_rig(struct eo_design *design)
{
  design->gear_pair.backlash = 100e-6;
  design->gear_pair.tip_alteration = 0;
  design->supports.bearing_stiffness[EO_PINION] = 8e8;
  design->supports.bearing_stiffness[EO_GEAR] = 1e9;
  design->supports.gear_axial_stiffness[EO_LEFT] = design->supports.gear_axial_stiffness[EO_RIGHT] = 2e8;
  design->alignment.pinion_axial_stiffness = 2e8;
  design->resolution.cells_per_line = 30;
  design->resolution.impact_patch = 5e-3;
  design->resolution.te_harmonics = 16;
}

void eo_case_design(struct eo_case *input, struct eo_design *design)
{
  memset(design, 0, sizeof *design);
  eo_table_defaults(&eo_design_table, design);
  struct eo_gear_pair *pair = &design->gear_pair;
  double degree = M_PI / 180;
  design->alignment.shaft_angle_in_plane = design->alignment.shaft_angle_out_of_plane = 0;
  state_rig(design);
  read_teeth(input, pair->teeth);
  read_shifts(input, pair->profile_shift);
  pair->ends = 2;
  pair->normal_module = 1e-3 * positive(input, "mn", eo_case_number(input, "mn"));
  pair->normal_pressure_angle = degree * either(input, "alpha_n_deg", "alpha_n", 20);
  pair->helix_angle = degree * (eo_case_find(input, "beta_deg") ? eo_case_number(input, "beta_deg")
                                                                : eo_case_number(input, "beta"));
  pair->face_width = 1e-3 * positive(input, "b", eo_case_number(input, "b"));
  pair->groove_width = 1e-3 * either(input, "groove", "groove_mm", 0);
  pair->addendum_coefficient = eo_case_number_or(input, "ha", 1);
  pair->dedendum_coefficient = pair->addendum_coefficient + eo_case_number_or(input, "c", 0.25);
  pair->fillet_radius_coefficient = eo_case_number_or(input, "rho_f", 0.38);
  pair->rim_thickness_coefficient = eo_case_number_or(input, "rim_mn", 3.5);
  design->material.youngs_modulus = 1e6 * eo_case_number_or(input, "E", 206000);
  design->material.poissons_ratio = eo_case_number_or(input, "nu", 0.3);
  design->material.density = 1e12 * either(input, "rho_t_mm3", "rho", 7.85e-9);
  design->load_cases = 1;
  design->load_case[0] = (struct eo_load_case){.torque = 1, .speed = 1, .share = 1};
}

void eo_case_check_geometry(struct eo_verification *verification, struct eo_case *output,
                            const struct eo_geometry *geometry, double scale, double relative)
{
  const struct {
    const char *key;
    double value;
  } row[] = {{"mt", scale * geometry->transverse_module},
             {"at", geometry->transverse_pressure_angle},
             {"bb", geometry->base_helix_angle},
             {"r1", scale * geometry->reference_radius[0]},
             {"r2", scale * geometry->reference_radius[1]},
             {"rb1", scale * geometry->base_radius[0]},
             {"rb2", scale * geometry->base_radius[1]},
             {"ra1", scale * geometry->tip_radius[0]},
             {"ra2", scale * geometry->tip_radius[1]},
             {"rf1", scale * geometry->root_radius[0]},
             {"rf2", scale * geometry->root_radius[1]},
             {"a", scale * geometry->centre_distance},
             {"pbt", scale * geometry->transverse_base_pitch},
             {"pbn", scale * geometry->normal_base_pitch},
             {"ga", scale * (geometry->path_end - geometry->path_start)},
             {"sA", scale * geometry->path_start},
             {"sE", scale * geometry->path_end},
             {"eps_a", geometry->transverse_contact_ratio},
             {"eps_b", geometry->overlap_ratio},
             {"ku", geometry->rack_factor},
             {"u_bot", scale * geometry->rack_bottom},
             {"u_tip", scale * geometry->rack_top},
             {"T1C", scale * geometry->tangent_length[0]},
             {"T2C", scale * geometry->tangent_length[1]},
             {"awt", geometry->working_pressure_angle}};
  for (size_t i = 0; i < sizeof row / sizeof row[0]; i++)
    eo_verify_member(verification, output, row[i].key, row[i].value, relative, 0);
}

void eo_case_modification(struct eo_case *block, const struct eo_gear_pair *pair, struct eo_flank_modification *flank)
{
  memset(flank, 0, sizeof *flank);
  if (!block)
    return;
  double half = pair->face_width / 2 / cos(pair->helix_angle), mm = 1e-3, um = 1e-6;
  bool in_um[2] = {eo_case_find(block, "d_tr_um"), eo_case_find(block, "d_br_um")};
  bool per_um = eo_case_find(block, "a_l_per_um");
  flank->tip_relief = in_um[0] ? um * eo_case_number(block, "d_tr_um") : mm * eo_case_number_or(block, "d_tr", 0);
  flank->root_relief = in_um[1] ? um * eo_case_number(block, "d_br_um") : mm * eo_case_number_or(block, "d_br", 0);
  flank->tip_relief_start = mm * either(block, "u_ts", "u_ts_mm", 0);
  flank->root_relief_start = mm * either(block, "u_bs", "u_bs_mm", 0);
  flank->profile_crowning = 1e3 * either(block, "a_m", "a_m_per_mm", 0);
  flank->lead_crowning =
      half * half * (per_um ? 1e6 * eo_case_number(block, "a_l_per_um") : 1e3 * eo_case_number_or(block, "a_l", 0));
  flank->helix_slope = 2 * half * eo_case_number_or(block, "b_l", 0);
  flank->lead_offset = mm * eo_case_number_or(block, "c_l", 0);
}

void eo_case_named_modification(struct eo_case *mods, const char *name, struct eo_case *where,
                                const struct eo_gear_pair *pair, struct eo_flank_modification *flank)
{
  static const char *const none[] = {"unmod", "unmodified", "none"};
  bool plain = false;
  struct eo_case *block = mods && name ? eo_case_find(mods, name) : NULL;
  for (size_t i = 0; name && i < sizeof none / sizeof *none; i++)
    plain = plain || strcmp(name, none[i]) == 0;
  if (!block && !plain)
    eo_case_fault(where, "\"%.40s\" is no modification of this file.", name ? name : "");
  eo_case_modification(block, pair, flank);
}

/* Moves *text behind the first of the words that stands there; its index, or -1. */
static int take_word(const char **text, const char *const *words)
{
  *text += strspn(*text, " ");
  for (int i = 0; words[i]; i++)
    if (strncmp(*text, words[i], strlen(words[i])) == 0) {
      *text += strlen(words[i]);
      return i;
    }
  return -1;
}

/* "0.1 deg in-plane": moves *text behind it. */
static bool take_angle(const char **text, struct eo_alignment *alignment)
{
  static const char *const units[] = {"degrees", "deg", "arcmin", "mrad", "rad", NULL};
  static const char *const planes[] = {"in-plane", "in plane",     "inplane",      "in the plane",
                                       "crossing", "out-of-plane", "out of plane", NULL};
  enum { IN_PLANE = 4 };
  const double unit[] = {M_PI / 180, M_PI / 180, M_PI / 180 / 60, 1e-3, 1};
  char *end;
  double angle = strtod(*text, &end);
  if (end == *text)
    return false;
  *text = end;
  int which = take_word(text, units), plane = take_word(text, planes);
  if (which < 0 || plane < 0)
    return false;
  if (plane < IN_PLANE)
    alignment->shaft_angle_in_plane = angle * unit[which];
  else
    alignment->shaft_angle_out_of_plane = angle * unit[which];
  return true;
}

static bool read_alignment(const char *text, struct eo_alignment *alignment)
{
  static const char *const nothing[] = {"none", "aligned", NULL}, *const more[] = {",", "+", "and", NULL};
  bool understood = true;
  if (take_word(&text, nothing) < 0)
    do
      understood = take_angle(&text, alignment);
    while (understood && take_word(&text, more) >= 0);
  return understood && text[strspn(text, " ")] == '\0';
}

void eo_case_misalignment(struct eo_case *value, struct eo_alignment *alignment)
{
  alignment->shaft_angle_in_plane = alignment->shaft_angle_out_of_plane = 0;
  if (eo_case_is_text(value)) {
    if (!read_alignment(eo_case_text(value), alignment))
      eo_case_fault(value, "This misalignment is not understood; it is none, or for instance \"0.1 deg in-plane\", "
                           "\"2 arcmin crossing\".");
    return;
  }
  alignment->shaft_angle_in_plane = either(value, "inplane", "in_plane", 0);
  alignment->shaft_angle_out_of_plane = either(value, "crossing", "out_of_plane", 0);
}

static bool says(struct eo_case *block, const char *words)
{
  const char *key;
  json_t *value, *object = block ? (json_t *)eo_case_json(block) : NULL;
  json_object_foreach(object, key, value)
  {
    const char *text = json_string_value(value);
    if (text && strstr(text, words))
      return true;
  }
  return false;
}

enum eo_tilt_rule eo_case_tilt_rule(struct eo_case *file)
{
  static const char *const names[] = {"tip_corner_convention", "tip corner convention"};
  struct eo_case *block[] = {eo_case_find(file, "defaults"), eo_case_find(file, "conventions")};
  bool path = false, radius = false;
  for (int i = 0; i < 2; i++) {
    path = path || says(block[i], "+ misalignment") || says(block[i], "misalignment slope");
    radius = radius || says(block[i], "at the pinion radius of the corner");
  }
  for (int i = 0; i < 4; i++) {
    const char *text = block[i / 2] ? eo_case_word_given(block[i / 2], names[i % 2]) : NULL;
    if (!text)
      continue;
    bool rotation = strstr(text, "rotation") || strstr(text, "rigid");
    if (!rotation && !strstr(text, "radius"))
      eo_case_fault(eo_case_find(block[i / 2], names[i % 2]),
                    "The convention at tip corners is \"rotation\" or \"radius\".");
    radius = !rotation;
  }
  return radius ? EO_TILT_AT_RADIUS : path ? EO_TILT_SLOPE : EO_TILT_ROTATED;
}

/* The number that follows a mark; moves *text behind it. NaN when either is missing. */
static double number_after(const char **text, const char *mark)
{
  const char *found = *text ? strstr(*text, mark) : NULL;
  char *end;
  if (!found)
    return NAN;
  double value = strtod(found + strlen(mark), &end);
  if (end == found + strlen(mark))
    return NAN;
  *text = end;
  return value;
}

void eo_case_closed_form(struct eo_case *text, struct eo_closed_form *form)
{
  const char *at = eo_case_text(text);
  form->compliance = 1e-3 * number_after(&at, "C(i,j) = ");
  form->length = 1e-3 * number_after(&at, "|/");
  form->linear = 1e3 * number_after(&at, "f = 1+");
  form->centre = -1e-3 * number_after(&at, "|s");
  form->quadratic = 1e6 * number_after(&at, "|+");
  if (!isfinite(form->compliance + form->length + form->linear + form->centre + form->quadratic) || form->length <= 0)
    eo_case_fault(text, "The closed-form compliance could not be read.");
}

int eo_case_count(struct eo_case *object, const char *key, const char *phrase, int fallback)
{
  const char *text = eo_case_word_given(object, key), *found = text ? strstr(text, phrase) : NULL;
  if (!found)
    return fallback;
  while (found > text && !isdigit((unsigned char)found[-1]))
    found--;
  while (found > text && isdigit((unsigned char)found[-1]))
    found--;
  int value = atoi(found);
  return value > 0 ? value : fallback;
}

bool eo_case_on(struct eo_case *object, const char *key, bool missing)
{
  const char *text = eo_case_word_given(object, key);
  if (!text)
    return missing;
  bool off = strncmp(text, "off", 3) == 0;
  if (!off && strncmp(text, "on", 2) != 0)
    eo_case_fault(eo_case_find(object, key), "The text begins with on or off.");
  return !off;
}

double eo_case_key_number(const struct eo_case *value)
{
  const char *key = eo_case_key(value);
  char *end;
  double number = key ? strtod(key, &end) : NAN;
  if (key && end != key && !*end && isfinite(number))
    return number;
  eo_case_fault(value, "The key must be a number.");
  return NAN;
}

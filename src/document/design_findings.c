/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What can work but should be known before anything is computed: each finding with number, limit and remedy, at its
   field. */
#include <math.h>
#include <string.h>

#include "document/design_document.h"
#include "document/flank_grid_document.h"
#include "document/search_space.h"
#include "format/object.h"
#include "gear/names.h"
#include "gear/surface.h"

static const char *const shift_key[2] = {"/gear_pair/pinion_profile_shift", "/gear_pair/gear_profile_shift"};

struct finding {
  const char *key, *text;
};

static const struct eo_outline_row finding_rows[] = {
    EO_KEY("key", "text", "JSON pointer of the field it belongs to", EO_AT(struct finding, key)),
    EO_KEY("text", "text", "in plain words: number, limit, remedy", EO_AT(struct finding, text)),
};
const struct eo_outline eo_outline_finding = EO_OUTLINE("DesignFinding", finding_rows);

json_t *eo_design_findings(const struct eo_warnings *warnings)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; warnings && i < warnings->count; i++) {
    const struct finding view = {warnings->key[i], warnings->text[i]};
    if (*view.key)
      eo_list_add(&list, eo_outline_encode(&eo_outline_finding, &view));
  }
  return eo_object_close(&list);
}

json_t *eo_warnings_encode(const struct eo_warnings *warnings)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_list_add(&list, json_string(warnings->text[i]));
  return eo_object_close(&list);
}

/* Below the active profile undercut takes nothing off where the teeth touch, but it weakens the root. */
static void note_undercut(const struct eo_geometry *geometry, int i, struct eo_warnings *warnings)
{
  if (geometry->undercut[i])
    eo_warnings_at(warnings, shift_key[i],
                   "The %s is undercut up to the radius %.6g mm; its active profile starts at %.6g mm. From a profile "
                   "shift of %.4g on there is none.",
                   eo_member_name[i], 1e3 * geometry->form_radius[i], 1e3 * geometry->start_radius[i],
                   geometry->least_shift[i]);
}

/* Stock that grinding takes from below the protuberance's reach leaves a step in the fillet. */
static void note_notch(const struct eo_design *design, int i, struct eo_warnings *warnings)
{
  static const char *const key[2] = {"/gear_pair/pinion_grinding_stock_um", "/gear_pair/gear_grinding_stock_um"};
  double beyond = design->gear_pair.grinding_stock[i] - design->gear_pair.protuberance[i];
  if (beyond > 0)
    eo_warnings_at(warnings, key[i],
                   "The stock of the %s, %.4g um, is %.4g um more than the protuberance of its tool: grinding leaves a "
                   "notch in the fillet, which is not modelled; the root is taken as cut at once. A protuberance of at "
                   "least the stock avoids it.",
                   eo_member_name[i], 1e6 * design->gear_pair.grinding_stock[i], 1e6 * beyond);
}

/* A distance far from what the shifts ask for: backlash that no thickness allowance makes. */
static void note_distance(const struct eo_geometry *geometry, struct eo_warnings *warnings)
{
  static const double MOST = 0.1; /* m_n; twice what ISO/TR 10064-2 recommends as the least */
  double added = geometry->normal_backlash - geometry->stated_backlash;
  if (added > MOST * geometry->normal_module)
    eo_warnings_at(
        warnings, "/gear_pair/centre_distance_mm",
        "The distance adds %.4g mm of normal backlash, %.3g m_n (usual: below %.3g m_n). It asks for profile "
        "shifts that sum to %.4g instead of %.4g: leave gear_profile_shift out and it follows.",
        1e3 * added, added / geometry->normal_module, MOST,
        eo_geometry_shift_sum(geometry->teeth, geometry->normal_pressure_angle, geometry->transverse_pressure_angle,
                              geometry->working_pressure_angle),
        geometry->profile_shift[0] + geometry->profile_shift[1]);
}

/* Stated allowances whose mean makes another backlash than the stated one, which is what the contact is computed with.
 */
static void note_allowances(const struct eo_design *design, struct eo_warnings *warnings)
{
  static const double NOTABLE = 0.05;
  const struct eo_gear_pair *pair = &design->gear_pair;
  double sum = 0;
  for (int i = 0; i < 2; i++)
    sum += pair->thickness_allowance[i][0] + pair->thickness_allowance[i][1];
  double mean = -sum / 2 * cos(pair->normal_pressure_angle);
  if (fabs(mean - pair->backlash) > NOTABLE * pair->backlash)
    eo_warnings_at(warnings, "/gear_pair/backlash_um",
                   "The thickness allowances make %.4g um of normal backlash in the mean, but %.4g um is stated and "
                   "used: leave one of the two out.",
                   1e6 * mean, 1e6 * pair->backlash);
}

/* Clearance of the basic rack: c = h_fP of the mate - h_aP. */
static void note_clearance(const struct eo_design *design, const struct eo_geometry *geometry, int i,
                           struct eo_warnings *warnings)
{
  static const char *const key[2] = {"/gear_pair/pinion_tip_diameter_mm", "/gear_pair/gear_tip_diameter_mm"};
  static const double LEAST = 0.1, NOTABLE = 0.02; /* m_n */
  double rack = eo_gear_pair_rack(&design->gear_pair, 1 - i).dedendum_coefficient -
                eo_gear_pair_rack(&design->gear_pair, i).addendum_coefficient;
  double clearance = geometry->tip_clearance[i] / geometry->normal_module;
  if (clearance < fmin(LEAST, rack))
    eo_warnings_at(warnings, key[i],
                   "Only %.3g m_n (%.4g mm) of clearance is left between the tip of the %s and the root of its mate; "
                   "usual is 0.25 m_n, the least %.2g m_n. A tip alteration (null: derived) keeps that of the rack.",
                   clearance, 1e3 * geometry->tip_clearance[i], eo_member_name[i], LEAST);
  else if (clearance < rack - NOTABLE)
    eo_warnings_at(warnings, key[i],
                   "The tip clearance of the %s, %.3g m_n, is below the %.3g m_n of the basic rack: the tips are not "
                   "shortened as much as the profile shifts bring the gears together. With tip_alteration_coefficient "
                   "null they are.",
                   eo_member_name[i], clearance, rack);
}

static void note_shortened(const struct eo_geometry *geometry, int i, struct eo_warnings *warnings)
{
  static const char *const key[2] = {"/gear_pair/pinion_tip_diameter_mm", "/gear_pair/gear_tip_diameter_mm"};
  if (geometry->shortened[i] > 1e-3 * geometry->normal_module)
    eo_warnings_at(
        warnings, key[i],
        "The tip diameter of the %s is taken as %.6g mm, %.4g mm less than its rack makes it, so that it clears "
        "the root of its mate and is not pointed. Profile shifts or another basic rack avoid that; a stated "
        "tip diameter is taken as it is.",
        eo_member_name[i], 2e3 * geometry->tip_radius[i], 2e3 * geometry->shortened[i]);
}

/* s_an in the normal section. */
static void note_tip(const struct eo_geometry *geometry, int i, struct eo_warnings *warnings)
{
  static const double LEAST = 0.2; /* m_n; 0.4 of surface hardened teeth */
  double helix = atan(tan(geometry->helix_angle) * geometry->tip_radius[i] / geometry->reference_radius[i]);
  double thickness = geometry->tip_thickness[i] * cos(helix) / geometry->normal_module;
  if (thickness < LEAST)
    eo_warnings_at(warnings, shift_key[i],
                   "The teeth of the %s are %.3g m_n thick at their tips; usual is at least %.2g m_n, of surface "
                   "hardened ones 0.4 m_n. Less profile shift or a smaller tip diameter thickens them.",
                   eo_member_name[i], thickness, LEAST);
}

static void note_proportions(const struct eo_design *design, const struct eo_geometry *geometry,
                             struct eo_warnings *warnings)
{
  static const double WIDEST = 2.2, STEEPEST = 45 * M_PI / 180; /* both ends of a herringbone pinion together */
  double width = design->gear_pair.ends * geometry->face_width / (2 * geometry->reference_radius[EO_PINION]);
  if (width > WIDEST)
    eo_warnings_at(warnings, "/gear_pair/face_width_mm",
                   "The face is %.3g times as wide as the pinion's reference diameter (usual: up to %.2g): bending and "
                   "wind-up of the pinion decide the load along it. See shafts.enabled.",
                   width, WIDEST);
  if (geometry->helix_angle > STEEPEST)
    eo_warnings_at(warnings, "/gear_pair/helix_angle_deg",
                   "A helix angle of %.4g deg is beyond the 45 deg of usual tools and of what ISO 6336 covers.",
                   geometry->helix_angle * 180 / M_PI);
  if (geometry->transverse_contact_ratio < 1)
    eo_warnings_at(warnings, "/gear_pair/centre_distance_mm",
                   "The transverse contact ratio, %.4g, is below 1: only the overlap of the helix keeps the teeth in "
                   "mesh. A longer addendum or a smaller working pressure angle adds to it.",
                   geometry->transverse_contact_ratio);
}

/* The vibration goes with accelerations, which are those of the highest harmonics: few positions of a mesh cycle leave
   these out. */
static void note_coarse_teeth(const struct eo_design *design, struct eo_warnings *warnings)
{
  int usual = eo_pitch_usual_positions(design->resolution.positions), positions = design->pitch.positions;
  if (design->pitch.stated && positions < usual)
    eo_warnings_at(warnings, "/pitch/positions_per_cycle",
                   "With %d positions of a mesh cycle the vibration of single teeth has %d harmonics of the mesh, with "
                   "the usual %d it has %d: its RMS can be several times too low. The transmission error needs fewer.",
                   positions, positions / 2 - 1, usual, usual / 2 - 1);
}

/* A member has tables of this flank, at either end. */
static bool has_table(const struct eo_pitch *pitch, enum eo_flank_side side, int member)
{
  bool has = false;
  for (int end = 0; end < 2; end++)
    for (int term = 0; term < EO_TOOTH_TERMS; term++)
      has = has || pitch->tables.place[side][member][end][term].teeth > 0;
  return has;
}

/* Tables of the flank that does not carry, and none of the one that does. */
static void note_other_flank(const struct eo_design *design, int k, struct eo_warnings *warnings)
{
  const struct eo_pitch *pitch = &design->pitch;
  enum eo_flank_side side = eo_design_running(design, k).flank;
  for (int i = 0; pitch->stated && i < 2; i++) {
    const struct eo_pitch_member *member = &pitch->member[i];
    char key[40];
    snprintf(key, sizeof key, "/pitch/%s", eo_member_name[i]);
    if (has_table(pitch, !side, i) && !has_table(pitch, side, i) && !member->tolerance_class && !member->flank_class)
      eo_warnings_at(
          warnings, key,
          "Load case %d runs on the %s flanks, and the %s's tables of single teeth are of its %s flanks alone: "
          "its teeth are alike there. State those of the other flank (\"coast\" of an end), or a "
          "tolerance_class.",
          k + 1, eo_flank_side_name[side], eo_member_name[i], eo_flank_side_name[!side]);
  }
}

/* A helix pushes along the axis, and only a second end takes that up within the body. */
static void note_thrust(const struct eo_design *design, struct eo_warnings *warnings)
{
  if (design->gear_pair.ends == 1 && design->gear_pair.helix_angle > 0 &&
      design->alignment.pinion_axial == EO_AXIAL_FLOATING)
    eo_warnings_at(warnings, "/alignment/pinion_axial",
                   "A single helix at %.4g deg pushes its pinion along the axis with tan beta = %.3g of the tangential "
                   "force, and a floating one has no thrust bearing: it is held like the gear. State \"fixed\" or "
                   "\"spring\".",
                   design->gear_pair.helix_angle * 180 / M_PI, tan(design->gear_pair.helix_angle));
}

/* The longest fold in mid face and at both face ends; 0 where it is too short to matter. */
static double fold_of(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                      double fold[2])
{
  static const double NOTABLE = 0.02; /* of the active profile: the sides of a kink cross within less */
  double longest = 0, end[2], at[2];
  eo_active_profile(geometry, member, end);
  for (int i = shape->varies ? -1 : 1; i <= 1; i++) { /* one slice is like the other where nothing varies */
    struct eo_modification_shape slice;
    eo_modification_slice(shape, i * geometry->face_width / 2, &slice);
    double length = eo_slice_fold(geometry, member, shape->varies ? &slice : shape, at);
    if (length > longest) {
      longest = length;
      memcpy(fold, at, sizeof at);
    }
  }
  return longest > NOTABLE * (end[1] - end[0]) ? longest : 0;
}

/* The most relief on a side with which the flank does not fold, m; 0: it folds without. */
static double most_relief(const struct eo_geometry *geometry, int member, const struct eo_flank_modification *flank,
                          const struct eo_modification_shape *shape, int side)
{
  enum { HALVINGS = 20 };
  struct eo_flank_modification tried = *flank;
  double *amount = side == EO_TIP_SIDE ? &tried.tip_relief : &tried.root_relief, low = 0, high = *amount, fold[2];
  for (int i = 0; i < HALVINGS; i++) {
    struct eo_modification_shape less;
    *amount = i ? (low + high) / 2 : 0;
    eo_modification_init(&less, geometry, member, &tried);
    eo_modification_complete(&less, shape->grid, shape->mirrored);
    bool folds = fold_of(geometry, member, &less, fold) > 0;
    if (i == 0 && folds)
      return 0;
    *(folds ? &high : &low) = *amount;
  }
  return low;
}

static void note_fold(const struct eo_design *design, const struct eo_geometry *geometry, enum eo_flank_side side,
                      int member, int end, struct eo_warnings *warnings)
{
  static const char *const relief_name[2] = {"root", "tip"};
  const struct eo_geometry half = eo_geometry_of_half(geometry, &design->gear_pair, end);
  const struct eo_flank_modification *flank = side == EO_COAST_FLANK ? &design->modification.coast[member][end]
                                                                     : &design->modification.flank[member][end];
  struct eo_modification_shape shape;
  struct eo_flank_spline *spline;
  double fold[2], place[2];
  char key[128], remedy[160] = "Less of what is taken off there avoids it.";
  if (eo_flank_shape(design, &half, side, member, end, &shape, &spline))
    return;
  if (fold_of(&half, member, &shape, fold) > 0) {
    int relief = fold[0] + fold[1] > 0 ? EO_TIP_SIDE : EO_ROOT_SIDE;
    double amount = relief == EO_TIP_SIDE ? flank->tip_relief : flank->root_relief;
    int length = snprintf(key, sizeof key, "/modification/%s/%s%s", eo_member_name[member], eo_end_name[end],
                          side == EO_COAST_FLANK ? "/coast" : "");
    double most = amount > 0 ? most_relief(&half, member, flank, &shape, relief) : 0;
    if (most > 0) {
      snprintf(key + length, sizeof key - (size_t)length, "/%s_relief_um", relief_name[relief]);
      snprintf(remedy, sizeof remedy, "Up to %.4g um in place of %.4g um, or a start further away, avoids it.",
               1e6 * most, 1e6 * amount);
    }
    for (int i = 0; i < 2; i++)
      place[i] = 1e3 * eo_profile_place_at(&half, member, fold[i]).diameter;
    eo_warnings_at(warnings, key,
                   "The flank folds between the diameters %.6g and %.6g mm: a tool with this relief cuts away there "
                   "what it has made, and no gear has such a flank. %s",
                   place[0], place[1], remedy);
  }
  eo_flank_spline_free(spline);
}

static void note_folds(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_warnings *warnings)
{
  int sides = eo_design_shows_coast(design) ? 2 : 1;
  for (int side = 0; side < sides; side++)
    for (int member = 0; member < 2; member++)
      for (int end = 0; end < design->gear_pair.ends; end++)
        note_fold(design, geometry, (enum eo_flank_side)side, member, end, warnings);
}

static void note_search(const struct eo_design *design, const struct eo_geometry *geometry,
                        struct eo_warnings *warnings)
{
  struct eo_study_space space;
  struct eo_error error;
  if (eo_study_space_init(&space, design, geometry, &error))
    eo_warnings_at(warnings, error.pointer, "An optimization would be refused: %s", error.text);
}

void eo_design_note_findings(const struct eo_design *design, const struct eo_geometry *geometry,
                             struct eo_warnings *warnings)
{
  for (int i = 0; i < 2; i++) {
    note_undercut(geometry, i, warnings);
    note_notch(design, i, warnings);
    note_clearance(design, geometry, i, warnings);
    note_shortened(geometry, i, warnings);
    note_tip(geometry, i, warnings);
  }
  note_distance(geometry, warnings);
  note_allowances(design, warnings);
  note_proportions(design, geometry, warnings);
  note_thrust(design, warnings);
  note_coarse_teeth(design, warnings);
  for (int k = 0; k < design->load_cases; k++)
    note_other_flank(design, k, warnings);
  note_folds(design, geometry, warnings);
  note_search(design, geometry, warnings);
}

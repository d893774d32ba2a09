/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a designer should know before trusting or liking a result, in plain words. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "document/result_private.h"
#include "gear/names.h"

struct list {
  json_t *array;
  bool failed;
};

static void say(struct list *list, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void say(struct list *list, const char *format, ...)
{
  char text[640];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  list->failed = list->failed || json_array_append_new(list->array, json_string(text)) != 0;
}

/* "at 828 N m and 2000 rpm" */
struct place {
  char text[80];
};

static struct place place_of(const struct eo_load_case *load_case)
{
  struct place place;
  snprintf(place.text, sizeof place.text, "at %.6g N m and %.6g rpm", load_case->torque,
           eo_unit_out(&eo_unit_rpm, load_case->speed));
  return place;
}

/* ", left end" where there are two. */
static const char *end_of(const struct eo_result_source *source, int end)
{
  return source->ends == 1 ? "" : end == EO_LEFT ? ", left end" : ", right end";
}

static void say_contact(struct list *list, const struct eo_result_source *source, int k)
{
  static const double NOTICEABLE = 1e-3;
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  struct place place = place_of(&case_result->load_case);
  if (case_result->contact_failures)
    say(list, "The loaded contact did not converge %s (%d mesh positions): the numbers of this load case mean nothing.",
        place.text, case_result->contact_failures);
  for (int end = 0; end < source->ends; end++) {
    const struct eo_end_result *end_result = &case_result->end[end];
    if (end_result->edge_share > NOTICEABLE) {
      char peak[80] = "";
      if (source->edge_pressure[k][end] >= 0.999 * end_result->max_pressure)
        snprintf(peak, sizeof peak, "; the largest pressure, %.4g MPa (nominal), is there",
                 end_result->max_pressure / 1e6);
      say(list, "Edge contact %s%s: tip edges carry up to %.3g %% of the load%s.", place.text, end_of(source, end),
          100 * end_result->edge_share, peak);
    }
    if (!end_result->impact.touched)
      say(list, "No incoming tooth touches %s%s: there is no entering impact to speak of.", place.text,
          end_of(source, end));
  }
}

/* The tangent law is straight, or bent about P only: beyond its reach the contact's stiffening counts. */
static void say_swing(struct list *list, const struct eo_result_source *source,
                      const struct eo_case_result *case_result, int end)
{
  double swing = fmax(case_result->vibration.force_max[end] / case_result->even_force[end] - 1,
                      1 - case_result->vibration.force_min[end] / case_result->even_force[end]);
  if (swing > case_result->law_reach)
    say(list,
        "The mesh force swings by %.2g %% %s%s, more than the tangent law follows well: compare mesh_law \"table\".",
        100 * swing, place_of(&case_result->load_case).text, end_of(source, end));
}

static void say_vibration(struct list *list, const struct eo_result_source *source,
                          const struct eo_case_result *case_result)
{
  const struct eo_vibration *vibration = &case_result->vibration;
  struct place place = place_of(&case_result->load_case);
  if (vibration->outcome == EO_VIBRATION_NOT_CONVERGED)
    say(list, "No stable periodic vibration was found %s: the teeth may hammer without a period.", place.text);
  else if (vibration->unstable > 0)
    say(list,
        "The periodic state that the harmonic balance finds %s is not stable (multiplier %.3g): the stable one that "
        "time "
        "integration leads to is given.",
        place.text, vibration->unstable);
  if (vibration->states > 1)
    say(list,
        "%d stable vibrations exist %s, with an RMS of %.4g to %.4g m/s2; which one the teeth take depends on how the "
        "drive "
        "came there. The loudest counts.",
        vibration->states, place.text, vibration->state[vibration->states - 1].rms[EO_READING_NORMAL],
        vibration->state[0].rms[EO_READING_NORMAL]);
  if (vibration->outcome != EO_VIBRATION_NOT_CONVERGED && vibration->repeat > 1)
    say(list, "The vibration %s repeats after %d mesh periods only.", place.text, vibration->repeat);
  for (int end = 0; end < source->ends && vibration->outcome == EO_VIBRATION_CONTACT_LOST; end++)
    if (vibration->contact_loss[end] > 0)
      say(list, "Contact is lost %s%s, for %.3g %% of the mesh cycle.", place.text, end_of(source, end),
          100 * vibration->contact_loss[end]);
  for (int end = 0; end < source->ends && vibration->outcome != EO_VIBRATION_NOT_CONVERGED; end++)
    say_swing(list, source, case_result, end);
  if (vibration->back_contact)
    say(list, "The back flanks touch %s: the vibration is larger than the backlash.", place.text);
}

static void say_limit(struct list *list, double limit, double value, const char *what, const struct eo_unit *unit,
                      const char *place)
{
  if (!(value > limit)) /* nor when it is off, NaN */
    return;
  say(list, "The limit on the %s is exceeded %s: %.4g%s%s, allowed %.4g%s%s.", what, place, eo_unit_out(unit, value),
      unit ? " " : "", unit ? unit->symbol : "", eo_unit_out(unit, limit), unit ? " " : "", unit ? unit->symbol : "");
}

/* Of the duty cycle as a whole. */
static void say_least(struct list *list, double limit, double value, const char *what)
{
  if (value < limit)
    say(list, "The limit on the %s is not reached: %.4g, at least %.4g wanted.", what, value, limit);
}

/* What no gear steel stands even once: the static limits of the best case hardened steel, 1.6 sigma_Hlim of 1650 MPa
   and 2.5 sigma_FE of 1050 MPa (ISO 6336-2, -3, -5, quality ME). */
static void say_strength(struct list *list, const struct eo_result_source *source, int k)
{
  static const double MOST_PRESSURE = 2640e6, MOST_ROOT = 2625e6;
  const struct eo_objective_case *objective_case = &source->evaluation->objective[k];
  struct place place = place_of(&source->design->load_case[k]);
  if (objective_case->contact_pressure > MOST_PRESSURE)
    say(list,
        "The contact pressure %s is %.4g MPa; the best case hardened steel stands %.4g MPa once. Less torque, a wider "
        "face or larger gears bring it down.",
        place.text, objective_case->contact_pressure / 1e6, MOST_PRESSURE / 1e6);
  if (objective_case->root_stress > MOST_ROOT)
    say(list,
        "The root stress %s is %.4g MPa; the best case hardened steel stands %.4g MPa once. Less torque, a wider face "
        "or a larger module bring it down.",
        place.text, objective_case->root_stress / 1e6, MOST_ROOT / 1e6);
}

static void say_limits(struct list *list, const struct eo_result_source *source, int k)
{
  const struct eo_objective *objective = &source->design->objective;
  const struct eo_objective_case *objective_case = &source->evaluation->objective[k],
                                 *before = &source->analysis->unmodified[k];
  struct place place = place_of(&source->design->load_case[k]);
  say_limit(list, objective->contact_pressure, objective_case->contact_pressure, "contact pressure", &eo_unit_MPa,
            place.text);
  say_limit(list, objective->root_stress, objective_case->root_stress, "root stress", &eo_unit_MPa, place.text);
  say_limit(list, objective->peak_to_peak, objective_case->peak_to_peak, "peak-to-peak transmission error", &eo_unit_um,
            place.text);
  say_limit(list, objective->edge_load_share, objective_case->edge_load_share, "load share of the tip edges", NULL,
            place.text);
  say_limit(list, objective->contact_loss, objective_case->contact_loss, "loss of contact", NULL, place.text);
  say_least(list, objective->flank_safety, objective_case->flank_safety, "flank safety S_H");
  say_least(list, objective->root_safety, objective_case->root_safety, "root safety S_F");
  say_least(list, objective->film_ratio, objective_case->film_ratio, "specific film thickness");
  say_limit(list, objective->contact_temperature, objective_case->contact_temperature, "contact temperature",
            &eo_unit_C, "over the duty cycle");
  if (objective->no_worse_than_unmodified &&
      (objective_case->peak_to_peak > before->peak_to_peak || objective_case->impact > before->impact ||
       objective_case->rms > before->rms))
    say(list, "The design is worse than the unmodified pair %s.", place.text);
}

/* An axially held pinion lets one end carry more than the other. */
static void say_held(struct list *list, const struct eo_result_source *source)
{
  static const double UNEVEN = 0.6;
  if (source->ends == 1 || source->design->alignment.pinion_axial == EO_AXIAL_FLOATING)
    return;
  for (int k = 0; k < source->evaluation->cases; k++) {
    const struct eo_case_result *case_result = &source->evaluation->load_case[k];
    double left = eo_result_mean_load(source, case_result, EO_LEFT),
           right = eo_result_mean_load(source, case_result, EO_RIGHT);
    if (fmax(left, right) > UNEVEN * (left + right))
      say(list, "The ends share the load unevenly %s: the %s end carries %.3g %% of it.",
          place_of(&case_result->load_case).text, left > right ? "left" : "right",
          100 * fmax(left, right) / (left + right));
  }
}

/* Where a key cannot mean what it says. */
static void say_supports(struct list *list, const struct eo_result_source *source)
{
  const struct eo_alignment *alignment = &source->design->alignment;
  bool floating = alignment->pinion_axial == EO_AXIAL_FLOATING;
  if (source->ends == 1 && floating && source->design->gear_pair.helix_angle != 0)
    say(list, "A single helical pinion cannot float along its axis: it is held there like the gear. See "
              "alignment.pinion_axial.");
  if (source->evaluation->torsion_left_out)
    say(list,
        "The flanks of both ends are alike, so torsional_coupling \"paper\" leaves the torsion of the groove out of "
        "the vibration, though the ends carry unlike loads: \"on\" takes it in, as for flanks that differ.");
  if (source->ends == 2 && !floating && source->design->supports.torsional_coupling == EO_COUPLING_OFF)
    say(list, "The ends are not coupled in torsion: each carries half the torque, however the pinion is held along its "
              "axis.");
}

/* A narrow disc of a single helical pair dishes under the thrust, which a body whose sections stay plane leaves out; a
   thin rim is not filled by its shaft. */
static void say_body(struct list *list, const struct eo_result_source *source)
{
  static const double NARROW = 0.5, THIN = 0.5;
  const struct eo_flexibility *flexibility = source->pair->flexibility;
  const struct eo_geometry *geometry = &source->pair->geometry;
  for (int m = 0; flexibility && m < 2; m++) {
    if (eo_flexibility_report(flexibility)->support[m] != EO_MEMBER_FLOATING)
      continue;
    double bore = source->design->gear_pair.bore[m] / 2;
    if (source->ends == 1 && geometry->helix_angle > 0 && bore > 0 &&
        geometry->member_width[m] < NARROW * geometry->root_radius[m])
      say(list,
          "The %s is a narrow disc that carries thrust: it also dishes, which the floating body leaves to the shaft "
          "and "
          "which can be as much as the teeth's own deflection.",
          eo_member_name[m]);
    if (bore > THIN * geometry->root_radius[m])
      say(list,
          "The rim of the %s is thin, but the floating body takes its bore as filled: with a web or a soft hub choose "
          "body_support \"held_at_bore\".",
          eo_member_name[m]);
  }
}

/* A rating that fails, or that could not be made. */
static void say_rating(struct list *list, const struct eo_result_source *source)
{
  const struct eo_design_rating *rating = source->analysis->rating;
  const struct eo_rating_settings *settings = &source->design->rating;
  if (!(source->analysis->want & EO_WANT_RATING))
    return;
  if (!rating->rated) {
    say(list, "Not rated by ISO 6336: %s", rating->reason.text);
    return;
  }
  double flank = fmin(rating->flank_safety, rating->flank_static),
         root = fmin(rating->root_safety, rating->root_static);
  if (flank < settings->flank_safety)
    say(list, "The flank safety S_H %.3g is below the required %.3g.", flank, settings->flank_safety);
  if (root < settings->root_safety)
    say(list, "The root safety S_F %.3g is below the required %.3g.", root, settings->root_safety);
}

/* Flanks that carry and that nobody has modified, beside others that somebody has. */
static void say_coast(struct list *list, const struct eo_result_source *source)
{
  const struct eo_modification *modification = &source->design->modification;
  bool coast = false;
  for (int i = 0; i < 8; i++)
    coast = coast || !eo_modification_is_none(&modification->coast[i / 2 % 2][i % 2]) ||
            source->design->grids.place[EO_COAST_FLANK][i / 2 % 2][i % 2].u_knots > 0;
  for (int k = 0; k < source->evaluation->cases && !coast; k++)
    if (source->evaluation->load_case[k].running.flank == EO_COAST_FLANK) {
      say(list, "Load case %d runs on the coast flanks, which are unmodified: state them in \"coast\" of each end.",
          k + 1);
      return;
    }
}

/* What the hunting period came to where it did not come to a plain answer. */
static void say_pitch(struct list *list, const struct eo_result_source *source)
{
  const struct eo_pitch_analysis *analysis = &source->analysis->pitch;
  for (int k = 0; k < analysis->cases; k++) {
    const struct eo_pitch_case *own = &analysis->load_case[k];
    const struct eo_long_response *response = &own->response;
    if (own->hunting.failures)
      say(list, "At %.6g N m the loaded contact of single teeth did not converge at %d of %d instants.",
          own->load_case.torque, own->hunting.failures, own->hunting.ends * own->hunting.instants);
    else if (response->outcome == EO_LONG_CONTACT_LOST)
      say(list,
          "With the deviations of single teeth contact is lost for %.3g %% of the time at %.6g N m: the tangent law is "
          "then a rough one.",
          100 * fmax(response->contact_loss[0], response->contact_loss[1]), own->load_case.torque);
    else if (response->outcome == EO_LONG_NOT_SETTLED)
      say(list, "At %.6g N m the vibration with single teeth does not repeat with the hunting period.",
          own->load_case.torque);
    else if (response->outcome == EO_LONG_NO_LAW)
      say(list,
          "At %.6g N m the stiffness with single teeth is too uneven for a mesh law: no vibration over the "
          "hunting period.",
          own->load_case.torque);
    else if (response->outcome == EO_LONG_TOO_LONG)
      say(list, "The hunting period of %d mesh cycles is too long for its vibration: at most %d.", own->hunting.cycles,
          EO_LONG_MOST_CYCLES);
  }
}

static void say_modelling(struct list *list, const struct eo_result_source *source)
{
  const struct eo_geometry *geometry = &source->pair->geometry;
  const char *note = source->pair->flexibility ? eo_flexibility_report(source->pair->flexibility)->note : "";
  if (*note)
    say(list, "%s", note);
  say_rating(list, source);
  say_pitch(list, source);
  say_coast(list, source);
  say_held(list, source);
  say_supports(list, source);
  say_body(list, source);
  if (source->design->objective.relief_inside_active_flank &&
      eo_objective_relief_outside(&source->design->modification, geometry->rack_bottom, geometry->rack_top))
    say(list, "A relief starts outside the active flank and takes nothing off where the teeth touch.");
  if (source->analysis->value.sums.failed)
    say(list, "J is not known because a load case has no result.");
}

json_t *eo_result_warnings(const struct eo_result_source *source, const struct eo_warnings *before)
{
  struct list list = {.array = json_array()};
  list.failed = !list.array;
  for (int i = 0; before && i < before->count; i++)
    say(&list, "%s", before->text[i]);
  for (int k = 0; k < source->evaluation->cases; k++) {
    say_contact(&list, source, k);
    say_vibration(&list, source, &source->evaluation->load_case[k]);
    say_limits(&list, source, k);
    say_strength(&list, source, k);
  }
  say_modelling(&list, source);
  if (!list.failed)
    return list.array;
  json_decref(list.array);
  return NULL;
}

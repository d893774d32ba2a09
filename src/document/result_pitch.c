/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hunting period of a result: the teeth as they were taken, and of every load case the transmission error over
   whole revolutions, its orders, the vibration it excites and the teeth that carry most. */
#include <math.h>
#include <stdlib.h>

#include "document/result_private.h"

/* One load case with what it is written from. */
struct written_case {
  const struct eo_result_source *source;
  const struct eo_pitch_case *own;
  int k;
};

static bool has_curves(const struct written_case *written_case)
{
  return eo_result_has(written_case->source, EO_RESULT_NO_PITCH,
                       &written_case->source->evaluation->load_case[written_case->k]);
}

static int body_tooth(const struct written_case *written_case, int member, int place)
{
  return eo_pitch_tooth(&written_case->source->design->pitch, &written_case->own->meeting, member,
                        written_case->own->hunting.teeth[member], place);
}

static double revolutions(const struct eo_pitch_case *own, int member)
{
  return (double)own->hunting.cycles / own->hunting.teeth[member];
}

/* ---- transmission error ---- */

static const struct eo_outline_row cycle_rows[] = {
    EO_KEY("least_um", "number", "of all cycles", .unit = &eo_unit_um),
    EO_KEY("mean_um", "number", "of all cycles", .unit = &eo_unit_um),
    EO_KEY("most_um", "number", "of all cycles", .unit = &eo_unit_um),
    EO_KEY("cycle_of_most", "integer", "counted from 0"),
};
static const struct eo_outline cycles_outline = EO_OUTLINE("PitchCycleSwing", cycle_rows);

static json_t *encode_cycle_swing(const struct eo_pitch_case *own)
{
  struct eo_object object = eo_object_open_as(&cycles_outline);
  double low = INFINITY, sum = 0, high = -INFINITY;
  int cycles = own->hunting.cycles, at = 0;
  for (int i = 0; i < cycles; i++) {
    low = fmin(low, own->cycle_swing[i]);
    sum += own->cycle_swing[i];
    at = own->cycle_swing[i] > high ? i : at;
    high = fmax(high, own->cycle_swing[i]);
  }
  eo_object_put_number(&object, "least_um", low);
  eo_object_put_number(&object, "mean_um", sum / cycles);
  eo_object_put_number(&object, "most_um", high);
  eo_object_put(&object, "cycle_of_most", json_integer(at));
  return eo_object_close(&object);
}

static const struct eo_outline_row lte_rows[] = {
    EO_KEY("mean_um", "number", "of the pair over the hunting period", .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_um", "number", "over the hunting period", .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_of_one_cycle_um", "object", "within mesh cycles", .outline = &cycles_outline),
    EO_KEY(
        "pair_um", "[number]?",
        "at equal steps of the mesh position over the whole period, positions_per_cycle to a cycle; null when curves "
        "are left out",
        .unit = &eo_unit_um),
    EO_KEY("cycle_mean_um", "[number]?", "mean of each mesh cycle; null when curves are left out", .unit = &eo_unit_um),
    EO_KEY("pinion_turn_um", "[number]?",
           "time-synchronous average over the turns of the pinion, less the mean, in the order of time; null when "
           "curves are left out",
           .unit = &eo_unit_um),
    EO_KEY("gear_turn_um", "[number]?", "the same over the turns of the gear", .unit = &eo_unit_um),
};
static const struct eo_outline lte_outline = EO_OUTLINE("PitchLte", lte_rows);

static json_t *column(bool wanted, int count, const double *value, const struct eo_unit *unit)
{
  return wanted ? eo_json_column(count, value, 1, unit, EO_DIGITS_MAP) : json_null();
}

static json_t *encode_lte(const struct written_case *written_case)
{
  const struct eo_pitch_case *own = written_case->own;
  struct eo_object object = eo_object_open_as(&lte_outline);
  eo_object_put_number(&object, "mean_um", own->mean);
  eo_object_put_number(&object, "peak_to_peak_um", own->peak_to_peak);
  eo_object_put(&object, "peak_to_peak_of_one_cycle_um", encode_cycle_swing(own));
  eo_object_put(&object, "pair_um",
                column(has_curves(written_case), own->hunting.instants, own->transmission, &eo_unit_um));
  eo_object_put(&object, "cycle_mean_um",
                column(has_curves(written_case), own->hunting.cycles, own->cycle_mean, &eo_unit_um));
  for (int member = 0; member < 2; member++)
    eo_object_put(&object, member == EO_PINION ? "pinion_turn_um" : "gear_turn_um",
                  column(has_curves(written_case), own->hunting.teeth[member] * own->hunting.positions,
                         own->turn[member], &eo_unit_um));
  return eo_object_close(&object);
}

/* ---- orders ---- */

static const struct eo_outline_row order_rows[] = {
    EO_KEY("name", "text", "of a shaft, of the mesh, or a sideband of it", EO_AT(struct eo_pitch_order, name)),
    EO_KEY("order_per_pinion_revolution", "number", "where the line stands", EO_AT(struct eo_pitch_order, order)),
    EO_KEY("lte_um", "number", "amplitude of the pair's transmission error, transverse", .unit = &eo_unit_um,
           EO_AT(struct eo_pitch_order, transmission)),
    EO_KEY("normal_m_per_s2", "number?", "amplitude of the normal acceleration, mean of the ends",
           .unit = &eo_unit_m_per_s2, EO_AT(struct eo_pitch_order, acceleration[EO_READING_NORMAL])),
    EO_KEY("rotational_m_per_s2", "number?", "of the rotational acceleration, which encoders see",
           .unit = &eo_unit_m_per_s2, EO_AT(struct eo_pitch_order, acceleration[EO_READING_ROTATIONAL])),
};
static const struct eo_outline order_outline = EO_OUTLINE("PitchOrder", order_rows);

static json_t *encode_orders(const struct eo_pitch_case *own)
{
  json_t *list = json_array();
  for (int i = 0; i < own->orders && list; i++)
    if (json_array_append_new(list, eo_outline_encode(&order_outline, &own->order[i])) != 0) {
      json_decref(list);
      list = NULL;
    }
  return list;
}

/* Lines up to a few mesh orders: what lies above is in the mesh's own orders. */
enum { SPECTRUM_MESH_ORDERS = 4 };

static const struct eo_outline_row spectrum_rows[] = {
    EO_KEY("step", "number", "order of the first line per revolution of the pinion; line i stands at i times it"),
    EO_KEY("lte_um", "[number]", "amplitudes, from order 0 on: the mean", .unit = &eo_unit_um),
    EO_KEY("normal_m_per_s2", "[number]?", "null where there is no vibration", .unit = &eo_unit_m_per_s2),
    EO_KEY("rotational_m_per_s2", "[number]?", "the same", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline spectrum_outline = EO_OUTLINE("PitchSpectrum", spectrum_rows);

static json_t *amplitudes(int count, const double complex *line, const struct eo_unit *unit)
{
  double *size = line ? malloc(sizeof *size * (size_t)count) : NULL;
  if (!line)
    return json_null();
  for (int i = 0; i < count && size; i++)
    size[i] = cabs(line[i]);
  json_t *list = size ? eo_json_column(count, size, 1, unit, EO_DIGITS_MAP) : NULL;
  free(size);
  return list;
}

static json_t *encode_spectrum(const struct written_case *written_case)
{
  const struct eo_pitch_case *own = written_case->own;
  struct eo_object object = eo_object_open_as(&spectrum_outline);
  int count = SPECTRUM_MESH_ORDERS * own->hunting.cycles + own->hunting.cycles / 2;
  count = count < own->lines ? count : own->lines;
  int moving = count < own->response.lines ? count : own->response.lines;
  eo_object_put_number(&object, "step", 1 / revolutions(own, EO_PINION));
  eo_object_put(&object, "lte_um", amplitudes(count, own->line, &eo_unit_um));
  eo_object_put(&object, "normal_m_per_s2",
                amplitudes(moving, own->response.acceleration[EO_READING_NORMAL], &eo_unit_m_per_s2));
  eo_object_put(&object, "rotational_m_per_s2",
                amplitudes(moving, own->response.acceleration[EO_READING_ROTATIONAL], &eo_unit_m_per_s2));
  return eo_object_close(&object);
}

/* ---- the largest ---- */

static const char *const ends[] = {"left", "right", NULL};

static const struct eo_outline_row place_rows[] = {
    EO_KEY("end", "word", "which end", .words = ends),
    EO_KEY("cycle", "integer", "mesh cycle of the period, from 0"),
    EO_KEY("position", "integer?", "of the cycle, from 0, positions_per_cycle to a cycle; null: of the cycle"),
    EO_KEY("pinion_tooth", "integer", "from 0, in the order in which they come into mesh ahead"),
    EO_KEY("gear_tooth", "integer", "the same"),
};
static const struct eo_outline place_outline = EO_OUTLINE(NULL, place_rows);
static const struct eo_outline_row load_rows[] = {
    EO_KEY("load_N", "number", "normal force of one pair of teeth", .unit = &eo_unit_N),
    EO_KEY("share_of_end", "number", "of the load of one end"),
    {.outline = &place_outline},
};
static const struct eo_outline load_outline = EO_OUTLINE("PitchLargestLoad", load_rows);
static const struct eo_outline_row pressure_rows[] = {
    EO_KEY("pressure_MPa", "number", "Hertz pressure, lines and tip edges", .unit = &eo_unit_MPa),
    {.outline = &place_outline},
};
static const struct eo_outline pressure_outline = EO_OUTLINE("PitchLargestPressure", pressure_rows);
static const struct eo_outline_row stress_rows[] = {
    EO_KEY("stress_MPa", "number", "root bending stress", .unit = &eo_unit_MPa),
    {.outline = &place_outline},
};
static const struct eo_outline stress_outline = EO_OUTLINE("PitchLargestStress", stress_rows);
static const struct eo_outline_row root_rows[] = {
    EO_KEY("pinion", "object", "of any tooth of the pinion", .outline = &stress_outline),
    EO_KEY("gear", "object", "of any tooth of the gear", .outline = &stress_outline),
};
static const struct eo_outline root_outline = EO_OUTLINE("PitchLargestStresses", root_rows);
static const struct eo_outline_row largest_rows[] = {
    EO_KEY("load", "object", "on a pair of teeth", .outline = &load_outline),
    EO_KEY("pressure", "object", "anywhere", .outline = &pressure_outline),
    EO_KEY("root_stress", "object?", "null when it was not asked for", .outline = &root_outline),
};
static const struct eo_outline largest_outline = EO_OUTLINE("PitchLargest", largest_rows);

static void put_place(struct eo_object *object, const struct written_case *written_case,
                      const struct eo_hunting_place *place, bool instant)
{
  eo_object_put(object, "end", json_string(ends[place->end]));
  eo_object_put(object, "cycle", json_integer(place->cycle));
  eo_object_put(object, "position", instant ? json_integer(place->position) : json_null());
  eo_object_put(object, "pinion_tooth", json_integer(body_tooth(written_case, EO_PINION, place->tooth[EO_PINION])));
  eo_object_put(object, "gear_tooth", json_integer(body_tooth(written_case, EO_GEAR, place->tooth[EO_GEAR])));
}

static const struct eo_hunting_place *larger(const struct eo_hunting_place place[2])
{
  return place[EO_RIGHT].value > place[EO_LEFT].value ? &place[EO_RIGHT] : &place[EO_LEFT];
}

static json_t *encode_stress(const struct written_case *written_case, int member)
{
  const struct eo_hunting_place *place = &written_case->own->hunting.most_stress[member];
  struct eo_object object = eo_object_open_as(&stress_outline);
  eo_object_put_number(&object, "stress_MPa", place->value);
  put_place(&object, written_case, place, false);
  return eo_object_close(&object);
}

static json_t *encode_root(const struct written_case *written_case)
{
  if (!written_case->own->hunting.tooth_stress[0])
    return json_null();
  struct eo_object object = eo_object_open_as(&root_outline);
  eo_object_put(&object, "pinion", encode_stress(written_case, EO_PINION));
  eo_object_put(&object, "gear", encode_stress(written_case, EO_GEAR));
  return eo_object_close(&object);
}

static json_t *encode_largest(const struct written_case *written_case)
{
  const struct eo_hunting_place *load = larger(written_case->own->hunting.most_load),
                                *pressure = larger(written_case->own->hunting.most_pressure);
  struct eo_object object = eo_object_open_as(&largest_outline), of_load = eo_object_open_as(&load_outline),
                   of_pressure = eo_object_open_as(&pressure_outline);
  eo_object_put_number(&of_load, "load_N", load->value);
  eo_object_put_number(&of_load, "share_of_end", load->value / written_case->own->force);
  put_place(&of_load, written_case, load, true);
  eo_object_put_number(&of_pressure, "pressure_MPa", pressure->value);
  put_place(&of_pressure, written_case, pressure, true);
  eo_object_put(&object, "load", eo_object_close(&of_load));
  eo_object_put(&object, "pressure", eo_object_close(&of_pressure));
  eo_object_put(&object, "root_stress", encode_root(written_case));
  return eo_object_close(&object);
}

/* ---- teeth ---- */

static const struct eo_outline_row tooth_rows[] = {
    EO_KEY("load_N", "[number]", "largest normal force that each tooth carries, tooth 0 first", .unit = &eo_unit_N),
    EO_KEY("root_stress_MPa", "[number]?", "largest of each tooth; null when it was not asked for",
           .unit = &eo_unit_MPa),
};
static const struct eo_outline tooth_outline = EO_OUTLINE("PitchTeethLoads", tooth_rows);
static const struct eo_outline_row of_ends_rows[] = {
    EO_KEY("left", "object", "left end", .outline = &tooth_outline),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &tooth_outline),
};
static const struct eo_outline of_ends_outline = EO_OUTLINE("PitchEndsLoads", of_ends_rows);
static const struct eo_outline_row teeth_rows[] = {
    EO_KEY("pinion", "object", "teeth of the pinion", .outline = &of_ends_outline),
    EO_KEY("gear", "object", "teeth of the gear", .outline = &of_ends_outline),
};
static const struct eo_outline teeth_outline = EO_OUTLINE("PitchTeeth", teeth_rows);

/* By the body's count of teeth. */
static json_t *encode_places(const struct written_case *written_case, int member, const struct eo_hunting_place *place,
                             const struct eo_unit *unit)
{
  int teeth = written_case->own->hunting.teeth[member];
  double *value = place ? malloc(sizeof *value * (size_t)teeth) : NULL;
  if (!place)
    return json_null();
  for (int i = 0; i < teeth && value; i++)
    value[body_tooth(written_case, member, i)] = place[i].value;
  json_t *list = value ? eo_json_column(teeth, value, 1, unit, EO_DIGITS_MAP) : NULL;
  free(value);
  return list;
}

static json_t *encode_tooth_loads(const struct written_case *written_case, int member)
{
  const struct eo_hunting *hunting = &written_case->own->hunting;
  struct eo_object object = eo_object_open_as(&of_ends_outline);
  for (int end = 0; end < hunting->ends; end++) {
    struct eo_object own = eo_object_open_as(&tooth_outline);
    const struct eo_hunting_place *stress = hunting->tooth_stress[member];
    eo_object_put(&own, "load_N", encode_places(written_case, member, hunting->tooth_load[end][member], &eo_unit_N));
    eo_object_put(&own, "root_stress_MPa",
                  encode_places(written_case, member,
                                stress ? stress + (size_t)end * (size_t)hunting->teeth[member] : NULL, &eo_unit_MPa));
    eo_object_put(&object, ends[end], eo_object_close(&own));
  }
  return eo_object_close(&object);
}

static json_t *encode_teeth_loads(const struct written_case *written_case)
{
  struct eo_object object = eo_object_open_as(&teeth_outline);
  eo_object_put(&object, "pinion", encode_tooth_loads(written_case, EO_PINION));
  eo_object_put(&object, "gear", encode_tooth_loads(written_case, EO_GEAR));
  return eo_object_close(&object);
}

/* ---- vibration ---- */

static const char *const outcomes[] = {"in_contact", "contact_lost", "not_settled", "no_law", "too_long", NULL};

static const struct eo_outline_row rms_rows[] = {
    EO_KEY("normal", "number", "along the normal", .unit = &eo_unit_m_per_s2),
    EO_KEY("transverse", "number", "in the transverse plane, with the bearings", .unit = &eo_unit_m_per_s2),
    EO_KEY("rotational", "number", "of the rotations, which encoders see", .unit = &eo_unit_m_per_s2),
};
static const struct eo_outline rms_outline = EO_OUTLINE("PitchRms", rms_rows);

static const struct eo_outline_row vibration_rows[] = {
    EO_KEY("method", "text", "how it was found"),
    EO_KEY("outcome", "word",
           "in_contact; contact_lost: teeth part somewhere in the period; not_settled: the motion has not come back "
           "after the periods that were tried, numbers are of the last; no_law, too_long: there is none",
           .words = outcomes),
    EO_KEY("rms_m_per_s2", "object?", "accelerations over the period, mean of the ends; null without one",
           .outline = &rms_outline),
    EO_KEY("contact_loss", "number?", "share of the period without contact, worse end"),
    EO_KEY("max_dynamic_force_N", "number?", "largest mesh force of an end", .unit = &eo_unit_N),
    EO_KEY("cycle_of_max", "integer?", "mesh cycle of time in which it is"),
};
static const struct eo_outline vibration_outline = EO_OUTLINE("PitchVibration", vibration_rows);

static json_t *encode_rms(const struct eo_long_response *response)
{
  struct eo_object object = eo_object_open_as(&rms_outline);
  eo_object_put_number(&object, "normal", response->rms[EO_READING_NORMAL]);
  eo_object_put_number(&object, "transverse", response->rms[EO_READING_TRANSVERSE]);
  eo_object_put_number(&object, "rotational", response->rms[EO_READING_ROTATIONAL]);
  return eo_object_close(&object);
}

static json_t *encode_vibration(const struct eo_pitch_case *own)
{
  const struct eo_long_response *response = &own->response;
  bool there = response->lines > 0;
  int worse = response->force_most[EO_RIGHT] > response->force_most[EO_LEFT];
  struct eo_object object = eo_object_open_as(&vibration_outline);
  eo_object_put(&object, "method",
                json_string("time steps over the hunting period: tangent law F = P + k_tan (X - Z) with Z and k_tan of "
                            "every tooth pair, teeth may part; without impact pulses"));
  eo_object_put(&object, "outcome", json_string(outcomes[response->outcome]));
  eo_object_put(&object, "rms_m_per_s2", there ? encode_rms(response) : json_null());
  eo_object_put(&object, "contact_loss",
                there ? json_real(fmax(response->contact_loss[0], response->contact_loss[1])) : json_null());
  eo_object_put(&object, "max_dynamic_force_N",
                there ? eo_json_quantity(response->force_most[worse], &eo_unit_N) : json_null());
  eo_object_put(&object, "cycle_of_max", there ? json_integer(response->force_cycle[worse]) : json_null());
  return eo_object_close(&object);
}

/* ---- load cases ---- */

static const struct eo_outline_row shift_rows[] = {
    EO_KEY("mean_um", "number", "over the period", .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_um", "number", "over the period", .unit = &eo_unit_um),
};
static const struct eo_outline shift_outline = EO_OUTLINE("PitchFloat", shift_rows);

static const struct eo_outline_row case_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm),
    EO_KEY("converged", "flag", "the loaded contact of every instant"),
    EO_KEY("lte", "object", "loaded transmission error of the pair, transverse", .outline = &lte_outline),
    EO_KEY("float", "object", "of the pinion along its axis, + to the right; 0 with one end",
           .outline = &shift_outline),
    EO_KEY("alone_share", "number", "of the instants of all ends at which one pair of teeth carries all"),
    EO_KEY("largest", "object", "of any tooth", .outline = &largest_outline),
    EO_KEY("orders", "[object]", "of the shafts, of the mesh and its sidebands", .outline = &order_outline),
    EO_KEY("vibration", "object", "what it excites", .outline = &vibration_outline),
    EO_KEY("spectrum", "object?", "null when curves are left out", .outline = &spectrum_outline),
    EO_KEY("teeth", "object?", "tooth by tooth; null when curves are left out", .outline = &teeth_outline),
};
static const struct eo_outline case_outline = EO_OUTLINE("PitchCase", case_rows);

static json_t *encode_float(const struct eo_pitch_case *own)
{
  struct eo_object object = eo_object_open_as(&shift_outline);
  eo_object_put_number(&object, "mean_um", own->float_mean);
  eo_object_put_number(&object, "peak_to_peak_um", own->float_swing);
  return eo_object_close(&object);
}

static json_t *encode_case(const struct eo_result_source *source, int k)
{
  const struct eo_pitch_case *own = &source->analysis->pitch.load_case[k];
  const struct written_case written_case = {source, own, k};
  const struct eo_hunting *hunting = &own->hunting;
  struct eo_object object = eo_object_open_as(&case_outline);
  eo_object_put_number(&object, "torque_Nm", own->load_case.torque);
  eo_object_put_number(&object, "speed_rpm", own->load_case.speed);
  eo_object_put(&object, "converged", json_boolean(hunting->failures == 0));
  eo_object_put(&object, "lte", encode_lte(&written_case));
  eo_object_put(&object, "float", encode_float(own));
  eo_object_put_number(&object, "alone_share", (double)hunting->alone / ((double)hunting->ends * hunting->instants));
  eo_object_put(&object, "largest", encode_largest(&written_case));
  eo_object_put(&object, "orders", encode_orders(own));
  eo_object_put(&object, "vibration", encode_vibration(own));
  eo_object_put(&object, "spectrum", has_curves(&written_case) ? encode_spectrum(&written_case) : json_null());
  eo_object_put(&object, "teeth", has_curves(&written_case) ? encode_teeth_loads(&written_case) : json_null());
  return eo_object_close(&object);
}

/* ---- deviations as they were taken ---- */

static const struct eo_outline_row flank_rows[] = {
    EO_KEY("total_um", "number", "F_p, with eccentricity and wobble", .unit = &eo_unit_um),
    EO_KEY("single_um", "number", "f_p, the same", .unit = &eo_unit_um),
    EO_KEY("index_um", "[number]", "F of each tooth with all that was stated or drawn", .unit = &eo_unit_um),
};
static const struct eo_outline flank_outline = EO_OUTLINE("PitchFlank", flank_rows);
static const struct eo_outline_row sides_rows[] = {
    EO_KEY("drive", "object?", "null: no load case has these flanks", .outline = &flank_outline),
    EO_KEY("coast", "object?", "the same", .outline = &flank_outline),
};
static const struct eo_outline sides_outline = EO_OUTLINE("PitchSides", sides_rows);
static const struct eo_outline_row tolerance_rows[] = {
    EO_KEY("total_um", "number?", "F_pT of the tolerance class; null where none is stated", .unit = &eo_unit_um),
    EO_KEY("single_um", "number?", "f_pT", .unit = &eo_unit_um),
};
static const struct eo_outline tolerance_outline = EO_OUTLINE("PitchTolerance", tolerance_rows);
static const struct eo_outline_row member_rows[] = {
    EO_KEY("tolerance", "object", "what the class allows", .outline = &tolerance_outline),
    EO_KEY("left", "object", "left end", .outline = &sides_outline),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &sides_outline),
};
static const struct eo_outline member_outline = EO_OUTLINE("PitchMember", member_rows);
static const struct eo_outline_row deviations_rows[] = {
    EO_KEY("pinion", "object", "teeth of the pinion", .outline = &member_outline),
    EO_KEY("gear", "object", "teeth of the gear", .outline = &member_outline),
};
static const struct eo_outline deviations_outline = EO_OUTLINE("PitchDeviations", deviations_rows);

static json_t *encode_flank(const struct eo_result_source *source, int side, int member, int end)
{
  const struct eo_pitch_analysis *analysis = &source->analysis->pitch;
  struct eo_object object = eo_object_open_as(&flank_outline);
  int teeth = source->pair->geometry.teeth[member];
  double *index = analysis->used[side] ? malloc(sizeof *index * (size_t)teeth) : NULL;
  if (!analysis->used[side])
    return json_null();
  for (int i = 0; i < teeth && index; i++)
    index[i] = analysis->tooth[side][member][end][i].index;
  eo_object_put_number(&object, "total_um", analysis->size[side][member][end].total);
  eo_object_put_number(&object, "single_um", analysis->size[side][member][end].single);
  eo_object_put(&object, "index_um", index ? eo_json_column(teeth, index, 1, &eo_unit_um, EO_DIGITS_MAP) : NULL);
  free(index);
  return eo_object_close(&object);
}

static json_t *encode_member(const struct eo_result_source *source, int member)
{
  const struct eo_flank_tolerance *tolerance = &source->analysis->pitch.tolerance[member];
  struct eo_object object = eo_object_open_as(&member_outline), allowed = eo_object_open_as(&tolerance_outline);
  eo_object_put_number(&allowed, "total_um", tolerance->total_pitch);
  eo_object_put_number(&allowed, "single_um", tolerance->single_pitch);
  eo_object_put(&object, "tolerance", eo_object_close(&allowed));
  for (int end = 0; end < source->ends; end++) {
    struct eo_object sides = eo_object_open_as(&sides_outline);
    eo_object_put(&sides, "drive", encode_flank(source, EO_DRIVE_FLANK, member, end));
    eo_object_put(&sides, "coast", encode_flank(source, EO_COAST_FLANK, member, end));
    eo_object_put(&object, ends[end], eo_object_close(&sides));
  }
  return eo_object_close(&object);
}

static json_t *encode_deviations(const struct eo_result_source *source)
{
  struct eo_object object = eo_object_open_as(&deviations_outline);
  eo_object_put(&object, "pinion", encode_member(source, EO_PINION));
  eo_object_put(&object, "gear", encode_member(source, EO_GEAR));
  return eo_object_close(&object);
}

static const struct eo_outline_row pitch_rows[] = {
    EO_KEY("cycles", "integer", "mesh cycles after which the same teeth meet again"),
    EO_KEY("pinion_revolutions", "number", "in that period"),
    EO_KEY("gear_revolutions", "number", "in that period"),
    EO_KEY("positions_per_cycle", "integer", "mesh positions that were computed"),
    EO_KEY("slopes", "text", "how the flank slopes of single teeth were taken"),
    EO_KEY("deviations", "object", "of the teeth as they were taken", .outline = &deviations_outline),
    EO_KEY("load_cases", "[object]", "in the order of the design", .outline = &case_outline),
};
const struct eo_outline eo_outline_pitch = EO_OUTLINE("Pitch", pitch_rows);

static json_t *encode_cases(const struct eo_result_source *source)
{
  json_t *list = json_array();
  for (int k = 0; k < source->analysis->pitch.cases && list; k++)
    if (json_array_append_new(list, encode_case(source, k)) != 0) {
      json_decref(list);
      list = NULL;
    }
  return list;
}

json_t *eo_result_pitch(const struct eo_result_source *source)
{
  const struct eo_pitch_analysis *analysis = &source->analysis->pitch;
  if (analysis->cases == 0)
    return json_null();
  struct eo_object object = eo_object_open_as(&eo_outline_pitch);
  const struct eo_hunting *hunting = &analysis->load_case[0].hunting;
  eo_object_put(&object, "cycles", json_integer(hunting->cycles));
  eo_object_put_number(&object, "pinion_revolutions", revolutions(&analysis->load_case[0], EO_PINION));
  eo_object_put_number(&object, "gear_revolutions", revolutions(&analysis->load_case[0], EO_GEAR));
  eo_object_put(&object, "positions_per_cycle", json_integer(hunting->positions));
  eo_object_put(&object, "slopes",
                json_string("added to the gap to first order; 10 um of slope and twist are up to 0.06 um off"));
  eo_object_put(&object, "deviations", encode_deviations(source));
  eo_object_put(&object, "load_cases", encode_cases(source));
  return eo_object_close(&object);
}

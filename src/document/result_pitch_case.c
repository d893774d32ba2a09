/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hunting period of a result: of every load case the transmission error over whole revolutions, its orders, the
   vibration it excites and the teeth that carry most. */
#include <math.h>
#include <stdlib.h>

#include "document/result_pitch_private.h"
#include "gear/names.h"

/* One load case. */
struct pitch_case {
  const struct eo_result_source *source;
  const struct eo_pitch_case *own;
  bool curves; /* wanted */
  struct eo_load_case load_case;
  bool converged;
  double alone_share;
};

static int body_tooth(const struct pitch_case *pitch_case, int member, int place)
{
  return eo_pitch_tooth(&pitch_case->source->design->pitch, &pitch_case->own->meeting, member,
                        pitch_case->own->hunting.teeth[member], place);
}

static const struct eo_pitch_case *own_of(const void *source)
{
  return ((const struct pitch_case *)source)->own;
}

/* Transmission error: */

struct cycle_swing {
  double least, mean, most;
  int at;
};

static const struct eo_outline_row cycle_rows[] = {
    EO_KEY("least_um", "number", "of all cycles", .unit = &eo_unit_um, EO_AT(struct cycle_swing, least)),
    EO_KEY("mean_um", "number", "of all cycles", .unit = &eo_unit_um, EO_AT(struct cycle_swing, mean)),
    EO_KEY("most_um", "number", "of all cycles", .unit = &eo_unit_um, EO_AT(struct cycle_swing, most)),
    EO_KEY("cycle_of_most", "integer", "counted from 0", EO_AT(struct cycle_swing, at)),
};
static const struct eo_outline cycles_outline = EO_OUTLINE("PitchCycleSwing", cycle_rows);

static struct cycle_swing swing_of_cycles(const struct eo_pitch_case *own)
{
  struct cycle_swing swing = {.least = INFINITY, .most = -INFINITY};
  int cycles = own->hunting.cycles;
  for (int i = 0; i < cycles; i++) {
    swing.least = fmin(swing.least, own->cycle_swing[i]);
    swing.mean += own->cycle_swing[i];
    swing.at = own->cycle_swing[i] > swing.most ? i : swing.at;
    swing.most = fmax(swing.most, own->cycle_swing[i]);
  }
  swing.mean /= cycles;
  return swing;
}

struct pitch_lte {
  double mean, peak_to_peak;
  struct cycle_swing one_cycle;
  struct eo_series pair, cycle_mean, turn[2];
};

#define OF_LTE(member) EO_AT(struct pitch_lte, member)
static const struct eo_outline_row lte_rows[] = {
    EO_KEY("mean_um", "number", "of the pair over the hunting period", .unit = &eo_unit_um, OF_LTE(mean)),
    EO_KEY("peak_to_peak_um", "number", "over the hunting period", .unit = &eo_unit_um, OF_LTE(peak_to_peak)),
    EO_KEY("peak_to_peak_of_one_cycle_um", "object", "within mesh cycles", .outline = &cycles_outline,
           OF_LTE(one_cycle)),
    EO_KEY(
        "pair_um", "[number]?",
        "at equal steps of the mesh position over the whole period, positions_per_cycle to a cycle; null when curves "
        "are left out",
        .unit = &eo_unit_um, OF_LTE(pair)),
    EO_KEY("cycle_mean_um", "[number]?", "mean of each mesh cycle; null when curves are left out", .unit = &eo_unit_um,
           OF_LTE(cycle_mean)),
    EO_KEY("pinion_turn_um", "[number]?",
           "time-synchronous average over the turns of the pinion, less the mean, in the order of time; null when "
           "curves are left out",
           .unit = &eo_unit_um, OF_LTE(turn[EO_PINION])),
    EO_KEY("gear_turn_um", "[number]?", "the same over the turns of the gear", .unit = &eo_unit_um,
           OF_LTE(turn[EO_GEAR])),
};
static const struct eo_outline lte_outline = EO_OUTLINE("PitchLte", lte_rows);

static json_t *write_lte(const void *source)
{
  const struct pitch_case *pitch_case = source;
  const struct eo_pitch_case *own = pitch_case->own;
  struct pitch_lte lte = {.mean = own->mean, .peak_to_peak = own->peak_to_peak, .one_cycle = swing_of_cycles(own)};
  if (pitch_case->curves) {
    lte.pair = eo_series_of(own->hunting.instants, own->transmission, EO_DIGITS_MAP);
    lte.cycle_mean = eo_series_of(own->hunting.cycles, own->cycle_mean, EO_DIGITS_MAP);
    for (int member = 0; member < 2; member++)
      lte.turn[member] = eo_series_of(own->hunting.teeth[member] * own->hunting.positions, own->turn[member],
                                      EO_DIGITS_MAP);
  }
  return eo_outline_encode(&lte_outline, &lte);
}

/* Orders: */

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

static json_t *write_orders(const void *source)
{
  const struct eo_pitch_case *own = own_of(source);
  struct eo_object list = eo_list_open();
  for (int i = 0; i < own->orders; i++)
    eo_list_add(&list, eo_outline_encode(&order_outline, &own->order[i]));
  return eo_object_close(&list);
}

/* Lines up to a few mesh orders: what lies above is in the mesh's own orders. */
enum { SPECTRUM_MESH_ORDERS = 4 };

struct pitch_spectrum {
  double step;
  struct eo_series transmission, normal, rotational;
};

#define OF_SPECTRUM(member) EO_AT(struct pitch_spectrum, member)
static const struct eo_outline_row spectrum_rows[] = {
    EO_KEY("step", "number", "order of the first line per revolution of the pinion; line i stands at i times it",
           OF_SPECTRUM(step)),
    EO_KEY("lte_um", "[number]", "amplitudes, from order 0 on: the mean", .unit = &eo_unit_um,
           OF_SPECTRUM(transmission)),
    EO_KEY("normal_m_per_s2", "[number]?", "null where there is no vibration", .unit = &eo_unit_m_per_s2,
           OF_SPECTRUM(normal)),
    EO_KEY("rotational_m_per_s2", "[number]?", "the same", .unit = &eo_unit_m_per_s2, OF_SPECTRUM(rotational)),
};
static const struct eo_outline spectrum_outline = EO_OUTLINE("PitchSpectrum", spectrum_rows);

/* size: [count], filled */
static struct eo_series amplitudes(int count, const double complex *line, double *size)
{
  for (int i = 0; i < count && line; i++)
    size[i] = cabs(line[i]);
  return eo_series_of(count, line ? size : NULL, EO_DIGITS_MAP);
}

static json_t *write_spectrum(const void *source)
{
  const struct eo_pitch_case *own = own_of(source);
  if (!((const struct pitch_case *)source)->curves)
    return json_null();
  int count = SPECTRUM_MESH_ORDERS * own->hunting.cycles + own->hunting.cycles / 2;
  count = count < own->lines ? count : own->lines;
  int moving = count < own->response.lines ? count : own->response.lines;
  double revolutions = (double)own->hunting.cycles / own->hunting.teeth[EO_PINION];
  double *size = malloc(sizeof *size * 3 * (size_t)count);
  if (!size)
    return NULL;
  const struct pitch_spectrum spectrum = {
      .step = 1 / revolutions,
      .transmission = amplitudes(count, own->line, size),
      .normal = amplitudes(moving, own->response.acceleration[EO_READING_NORMAL], size + count),
      .rotational = amplitudes(moving, own->response.acceleration[EO_READING_ROTATIONAL], size + 2 * (size_t)count)};
  json_t *object = eo_outline_encode(&spectrum_outline, &spectrum);
  free(size);
  return object;
}

/* The largest: */

/* The largest of something, and where it is. */
struct pitch_largest {
  double value, share;
  int end, cycle;
  double position; /* NaN: of the cycle */
  int tooth[2];    /* [member] in the body's count */
};

#define OF_LARGEST(member) EO_AT(struct pitch_largest, member)
static const struct eo_outline_row place_rows[] = {
    EO_KEY("end", "word", "which end", .words = eo_end_name, OF_LARGEST(end)),
    EO_KEY("cycle", "integer", "mesh cycle of the period, from 0", OF_LARGEST(cycle)),
    EO_KEY("position", "integer?", "of the cycle, from 0, positions_per_cycle to a cycle; null: of the cycle",
           OF_LARGEST(position)),
    EO_KEY("pinion_tooth", "integer", "from 0, in the order in which they come into mesh ahead",
           OF_LARGEST(tooth[EO_PINION])),
    EO_KEY("gear_tooth", "integer", "the same", OF_LARGEST(tooth[EO_GEAR])),
};
static const struct eo_outline place_outline = EO_OUTLINE(NULL, place_rows);
static const struct eo_outline_row load_rows[] = {
    EO_KEY("load_N", "number", "normal force of one pair of teeth", .unit = &eo_unit_N, OF_LARGEST(value)),
    EO_KEY("share_of_end", "number", "of the load of one end", OF_LARGEST(share)),
    {.outline = &place_outline},
};
static const struct eo_outline load_outline = EO_OUTLINE("PitchLargestLoad", load_rows);
static const struct eo_outline_row pressure_rows[] = {
    EO_KEY("pressure_MPa", "number", "Hertz pressure, lines and tip edges", .unit = &eo_unit_MPa, OF_LARGEST(value)),
    {.outline = &place_outline},
};
static const struct eo_outline pressure_outline = EO_OUTLINE("PitchLargestPressure", pressure_rows);
static const struct eo_outline_row stress_rows[] = {
    EO_KEY("stress_MPa", "number", "root bending stress", .unit = &eo_unit_MPa, OF_LARGEST(value)),
    {.outline = &place_outline},
};
static const struct eo_outline stress_outline = EO_OUTLINE("PitchLargestStress", stress_rows);

struct largest_stresses {
  struct pitch_largest member[2];
};
static const struct eo_outline_row root_rows[] = {
    EO_KEY("pinion", "object", "of any tooth of the pinion", .outline = &stress_outline,
           EO_AT(struct largest_stresses, member[EO_PINION])),
    EO_KEY("gear", "object", "of any tooth of the gear", .outline = &stress_outline,
           EO_AT(struct largest_stresses, member[EO_GEAR])),
};
static const struct eo_outline root_outline = EO_OUTLINE("PitchLargestStresses", root_rows);

static struct pitch_largest largest_at(const struct pitch_case *pitch_case, const struct eo_hunting_place *place,
                                       bool instant)
{
  return (struct pitch_largest){.value = place->value,
                                .share = place->value / pitch_case->own->force[place->end],
                                .end = place->end,
                                .cycle = place->cycle,
                                .position = instant ? (double)place->position : NAN,
                                .tooth = {body_tooth(pitch_case, EO_PINION, place->tooth[EO_PINION]),
                                          body_tooth(pitch_case, EO_GEAR, place->tooth[EO_GEAR])}};
}

static const struct eo_hunting_place *larger(const struct eo_hunting_place place[2])
{
  return place[EO_RIGHT].value > place[EO_LEFT].value ? &place[EO_RIGHT] : &place[EO_LEFT];
}

static json_t *write_load(const void *source)
{
  struct pitch_largest largest = largest_at(source, larger(own_of(source)->hunting.most_load), true);
  return eo_outline_encode(&load_outline, &largest);
}

static json_t *write_pressure(const void *source)
{
  struct pitch_largest largest = largest_at(source, larger(own_of(source)->hunting.most_pressure), true);
  return eo_outline_encode(&pressure_outline, &largest);
}

static json_t *write_root(const void *source)
{
  const struct eo_hunting *hunting = &own_of(source)->hunting;
  if (!hunting->tooth_stress[0])
    return json_null();
  const struct largest_stresses stresses = {{largest_at(source, &hunting->most_stress[EO_PINION], false),
                                             largest_at(source, &hunting->most_stress[EO_GEAR], false)}};
  return eo_outline_encode(&root_outline, &stresses);
}

static const struct eo_outline_row largest_rows[] = {
    EO_KEY("load", "object", "on a pair of teeth", .outline = &load_outline, .write = write_load),
    EO_KEY("pressure", "object", "anywhere", .outline = &pressure_outline, .write = write_pressure),
    EO_KEY("root_stress", "object?", "null when it was not asked for", .outline = &root_outline, .write = write_root),
};
static const struct eo_outline largest_outline = EO_OUTLINE("PitchLargest", largest_rows);

static json_t *write_largest(const void *source)
{
  return eo_outline_encode(&largest_outline, source);
}

/* Teeth: */

struct teeth_loads {
  struct eo_series load, stress;
};
static const struct eo_outline_row tooth_rows[] = {
    EO_KEY("load_N", "[number]", "largest normal force that each tooth carries, tooth 0 first", .unit = &eo_unit_N,
           EO_AT(struct teeth_loads, load)),
    EO_KEY("root_stress_MPa", "[number]?", "largest of each tooth; null when it was not asked for",
           .unit = &eo_unit_MPa, EO_AT(struct teeth_loads, stress)),
};
static const struct eo_outline tooth_outline = EO_OUTLINE("PitchTeethLoads", tooth_rows);
static const struct eo_outline_row of_ends_rows[] = {EO_PITCH_END_ROWS(&tooth_outline)};
static const struct eo_outline of_ends_outline = EO_OUTLINE("PitchEndsLoads", of_ends_rows);

/* By the body's count of teeth. value: [teeth], filled */
static struct eo_series series_of_places(const struct pitch_case *pitch_case, int member,
                                         const struct eo_hunting_place *place, double *value)
{
  int teeth = pitch_case->own->hunting.teeth[member];
  for (int i = 0; i < teeth && place; i++)
    value[body_tooth(pitch_case, member, i)] = place[i].value;
  return eo_series_of(teeth, place ? value : NULL, EO_DIGITS_MAP);
}

static json_t *encode_end_loads(const struct pitch_case *pitch_case, int member, int end)
{
  const struct eo_hunting *hunting = &pitch_case->own->hunting;
  size_t teeth = (size_t)hunting->teeth[member];
  const struct eo_hunting_place *stress = hunting->tooth_stress[member];
  double *value = malloc(sizeof *value * 2 * teeth);
  if (!value)
    return NULL;
  const struct teeth_loads loads = {
      series_of_places(pitch_case, member, hunting->tooth_load[end][member], value),
      series_of_places(pitch_case, member, stress ? stress + (size_t)end * teeth : NULL, value + teeth)};
  json_t *object = eo_outline_encode(&tooth_outline, &loads);
  free(value);
  return object;
}

static json_t *encode_member_loads(const struct pitch_case *pitch_case, int member)
{
  struct eo_pitch_ends view = {.two = pitch_case->own->hunting.ends == 2};
  for (int end = 0; end < (view.two ? 2 : 1); end++)
    view.end[end] = encode_end_loads(pitch_case, member, end);
  return eo_outline_encode(&of_ends_outline, &view);
}

static json_t *write_pinion_loads(const void *source)
{
  return encode_member_loads(source, EO_PINION);
}

static json_t *write_gear_loads(const void *source)
{
  return encode_member_loads(source, EO_GEAR);
}

static const struct eo_outline_row teeth_rows[] = {
    EO_KEY("pinion", "object", "teeth of the pinion", .outline = &of_ends_outline, .write = write_pinion_loads),
    EO_KEY("gear", "object", "teeth of the gear", .outline = &of_ends_outline, .write = write_gear_loads),
};
static const struct eo_outline teeth_outline = EO_OUTLINE("PitchTeeth", teeth_rows);

static json_t *write_teeth(const void *source)
{
  return ((const struct pitch_case *)source)->curves ? eo_outline_encode(&teeth_outline, source) : json_null();
}

/* Vibration: */

static const char *const outcomes[] = {"in_contact", "contact_lost", "not_settled", "no_law", "too_long", NULL};

#define OF_RMS(reading) EO_AT(struct eo_long_response, rms[reading])
static const struct eo_outline_row rms_rows[] = {
    EO_KEY("normal", "number", "along the normal", .unit = &eo_unit_m_per_s2, OF_RMS(EO_READING_NORMAL)),
    EO_KEY("transverse", "number", "in the transverse plane, with the bearings", .unit = &eo_unit_m_per_s2,
           OF_RMS(EO_READING_TRANSVERSE)),
    EO_KEY("rotational", "number", "of the rotations, which encoders see", .unit = &eo_unit_m_per_s2,
           OF_RMS(EO_READING_ROTATIONAL)),
};
static const struct eo_outline rms_outline = EO_OUTLINE("PitchRms", rms_rows);

/* Numbers are NaN without a response. */
struct pitch_vibration {
  const char *method;
  enum eo_long_outcome outcome;
  json_t *rms;
  double contact_loss, force, cycle;
};

#define OF_VIBRATION(member) EO_AT(struct pitch_vibration, member)
static const struct eo_outline_row vibration_rows[] = {
    EO_KEY("method", "text", "how it was found", OF_VIBRATION(method)),
    EO_KEY("outcome", "word",
           "in_contact; contact_lost: teeth part somewhere in the period; not_settled: the motion has not come back "
           "after the periods that were tried, numbers are of the last; no_law, too_long: there is none",
           .words = outcomes, OF_VIBRATION(outcome)),
    EO_KEY("rms_m_per_s2", "object?", "accelerations over the period, mean of the ends; null without one",
           .outline = &rms_outline, OF_VIBRATION(rms)),
    EO_KEY("contact_loss", "number?", "share of the period without contact, worse end", OF_VIBRATION(contact_loss)),
    EO_KEY("max_dynamic_force_N", "number?", "largest mesh force of an end", .unit = &eo_unit_N, OF_VIBRATION(force)),
    EO_KEY("cycle_of_max", "integer?", "mesh cycle of time in which it is", OF_VIBRATION(cycle)),
};
static const struct eo_outline vibration_outline = EO_OUTLINE("PitchVibration", vibration_rows);

static json_t *write_vibration(const void *source)
{
  const struct eo_long_response *response = &own_of(source)->response;
  bool there = response->lines > 0;
  int worse = response->force_most[EO_RIGHT] > response->force_most[EO_LEFT];
  const struct pitch_vibration vibration = {
      .method = "time steps over the hunting period: tangent law F = P + k_tan (X - Z) with Z and k_tan of "
                "every tooth pair, teeth may part; without impact pulses",
      .outcome = response->outcome,
      .rms = there ? eo_outline_encode(&rms_outline, response) : json_null(),
      .contact_loss = there ? fmax(response->contact_loss[0], response->contact_loss[1]) : NAN,
      .force = there ? response->force_most[worse] : NAN,
      .cycle = there ? (double)response->force_cycle[worse] : NAN};
  return eo_outline_encode(&vibration_outline, &vibration);
}

/* Load cases: */

static const struct eo_outline_row shift_rows[] = {
    EO_KEY("mean_um", "number", "over the period", .unit = &eo_unit_um, EO_AT(struct eo_pitch_case, float_mean)),
    EO_KEY("peak_to_peak_um", "number", "over the period", .unit = &eo_unit_um,
           EO_AT(struct eo_pitch_case, float_swing)),
};
static const struct eo_outline shift_outline = EO_OUTLINE("PitchFloat", shift_rows);

static json_t *write_float(const void *source)
{
  return eo_outline_encode(&shift_outline, own_of(source));
}

#define OF_CASE(member) EO_AT(struct pitch_case, member)
static const struct eo_outline_row case_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm, OF_CASE(load_case.torque)),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm, OF_CASE(load_case.speed)),
    EO_KEY("converged", "flag", "the loaded contact of every instant", OF_CASE(converged)),
    EO_KEY("lte", "object", "loaded transmission error of the pair, transverse", .outline = &lte_outline,
           .write = write_lte),
    EO_KEY("float", "object", "of the pinion along its axis, + to the right; 0 with one end", .outline = &shift_outline,
           .write = write_float),
    EO_KEY("alone_share", "number", "of the instants of all ends at which one pair of teeth carries all",
           OF_CASE(alone_share)),
    EO_KEY("largest", "object", "of any tooth", .outline = &largest_outline, .write = write_largest),
    EO_KEY("orders", "[object]", "of the shafts, of the mesh and its sidebands", .outline = &order_outline,
           .write = write_orders),
    EO_KEY("vibration", "object", "what it excites", .outline = &vibration_outline, .write = write_vibration),
    EO_KEY("spectrum", "object?", "null when curves are left out", .outline = &spectrum_outline,
           .write = write_spectrum),
    EO_KEY("teeth", "object?", "tooth by tooth; null when curves are left out", .outline = &teeth_outline,
           .write = write_teeth),
};
const struct eo_outline eo_outline_pitch_case = EO_OUTLINE("PitchCase", case_rows);

json_t *eo_result_pitch_case(const struct eo_result_source *source, int load_case)
{
  const struct eo_pitch_case *own = &source->analysis->pitch.load_case[load_case];
  const struct eo_hunting *hunting = &own->hunting;
  const struct pitch_case pitch_case = {
      .source = source,
      .own = own,
      .curves = eo_result_has(source, EO_RESULT_NO_PITCH, &source->evaluation->load_case[load_case]),
      .load_case = own->load_case,
      .converged = hunting->failures == 0,
      .alone_share = (double)hunting->alone / ((double)hunting->ends * hunting->instants)};
  return eo_outline_encode(&eo_outline_pitch_case, &pitch_case);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Single teeth of a design: what is drawn keeps within its class, eccentricities and wobble do what geometry says, the
   order of teeth on both flanks and with either member driving, Parseval, the vibration beside the harmonic balance,
   and the document with its tables. Closed-form compliance. */
#include "document/design_document.h"
#include "document/examples.h"
#include "document/pitch_document.h"
#include "evaluation/analysis.h"
#include "support/synthetic-pair.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 32, PINION = 18, GEAR = 45 }; /* meet again after 90 mesh cycles */

static struct eo_pair *pair;
static struct eo_analysis *analysis;

/* Aligned, one load case; teeth without deviations. */
static struct eo_design plain_design(void)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build("paper-case-a", &design);
  design.gear_pair.teeth[EO_PINION] = PINION;
  design.gear_pair.teeth[EO_GEAR] = GEAR;
  design.alignment.shaft_angle_in_plane = 0;
  design.resolution.positions = POSITIONS;
  design.resolution.te_harmonics = 10;
  design.resolution.cells_per_line = 12;
  design.load_cases = 1;
  design.load_case[0].torque = 828;
  design.load_case[0].share = 1;
  design.pitch = (struct eo_pitch){.stated = true, .positions = POSITIONS};
  for (int member = 0; member < 2; member++)
    design.pitch.member[member] = (struct eo_pitch_member){.edition = EO_ISO1328_2013, .tolerance_share = 1, .seed = 1};
  if (eo_design_complete(&design, &geometry, &error))
    stop(&error);
  return design;
}

static const struct eo_pitch_case *run(struct eo_design *design)
{
  struct eo_geometry geometry;
  struct eo_error error;
  if (eo_design_complete(design, &geometry, &error) || eo_analysis_run(analysis, design, EO_WANT_PITCH, &error))
    stop(&error);
  return &analysis->pitch.load_case[0];
}

static const struct eo_pitch_order *find_order(const struct eo_pitch_case *c, const char *name)
{
  for (int i = 0; i < c->orders; i++)
    if (strcmp(c->order[i].name, name) == 0)
      return &c->order[i];
  return NULL;
}

static double amplitude(const struct eo_pitch_case *c, const char *name)
{
  const struct eo_pitch_order *order = find_order(c, name);
  return order ? order->transmission : NAN;
}

static void test_drawn(void)
{
  struct eo_flank_tolerance tolerance;
  struct eo_error error;
  double index[GEAR], again[GEAR], least = 1, over = 0;
  bool differ = false;
  for (int class = 1; class <= 11; class ++) {
    struct eo_pitch_member member = {.tolerance_class = class, .edition = EO_ISO1328_2013};
    if (eo_pitch_tolerance(&tolerance, &member, &pair->geometry, EO_GEAR, &error))
      stop(&error);
    for (uint64_t seed = 0; seed < 60; seed++) {
      eo_pitch_draw(&tolerance, 1, GEAR, seed, 3, index);
      struct eo_pitch_size size = eo_pitch_size_of(GEAR, index);
      double share = fmax(size.total / tolerance.total_pitch, size.single / tolerance.single_pitch);
      least = fmin(least, share);
      over = fmax(over, share);
    }
  }
  ok(over <= 1 + 1e-12 && least > 1 - 1e-9,
     "drawn teeth reach F_p or f_p of their class and keep within both (%.9f to %.9f)", least, over);
  eo_pitch_draw(&tolerance, 0.5, GEAR, 7, 0, index);
  eo_pitch_draw(&tolerance, 0.5, GEAR, 7, 0, again);
  ok(memcmp(index, again, sizeof index) == 0 && eo_pitch_size_of(GEAR, index).total <= 0.5 * tolerance.total_pitch,
     "the same seed draws the same teeth, half of the tolerance");
  eo_pitch_draw(&tolerance, 0.5, GEAR, 7, 1, again);
  for (int i = 0; i < GEAR; i++)
    differ = differ || index[i] != again[i];
  ok(differ, "the same seed draws other teeth for the other hand");
  double most = 0, mean = 0, square = 0;
  for (uint64_t seed = 0; seed < 60; seed++) {
    eo_tooth_form_draw(&tolerance, 0.5, EO_TOOTH_LEAD_CROWNING, GEAR, seed, 1, index);
    for (int i = 0; i < GEAR; i++) {
      double part = index[i] / (0.5 * tolerance.helix_form);
      most = fmax(most, fabs(part));
      mean += part / (60 * GEAR);
      square += part * part / (60 * GEAR);
    }
  }
  ok(most <= 1 && most > 0.99 && fabs(mean) < 0.05 && fabs(square - 1.0 / 3) < 0.02,
     "drawn crownings of single teeth are uniform within the share of f_fbeta (%.3f, %.3f, %.3f)", most, mean, square);
}

struct patience {
  int asked, most;
};

static int lose_patience(void *context, const char *what, double fraction)
{
  struct patience *patience = context;
  (void)what;
  return fraction > 1 || ++patience->asked > patience->most;
}

/* Stopped in the contact and in the vibrations; what comes after it is as if nothing had been. */
static void test_stop(void)
{
  struct eo_design design = plain_design();
  struct eo_error error;
  struct patience patience = {.most = 1000000};
  const struct eo_progress progress = {lose_patience, &patience};
  design.pitch.member[EO_PINION].eccentricity = 1e-6;
  double undisturbed = amplitude(run(&design), "pinion 1");
  analysis->progress = &progress;
  run(&design);
  int asked = patience.asked;
  ok(asked > 2, "the evaluation asks %d times whether to go on", asked);
  for (int most = 1; most<asked; most += asked> 2 ? asked - 2 : 1) {
    patience = (struct patience){.most = most};
    ok(eo_analysis_run(analysis, &design, EO_WANT_PITCH, &error) == EO_ERROR_CANCELLED,
       "the evaluation is stopped when asked for the %dth of %d times", most + 1, asked);
  }
  analysis->progress = NULL;
  ok(amplitude(run(&design), "pinion 1") == undisturbed, "the evaluation is whole again after a stop");
}

/* LTE of amplitude e at the member's order, less what pairs in contact average. */
static void test_eccentricity(void)
{
  static const double averaged[2] = {0.985, 0.998}; /* deviations of 17 and 44 teeth: 0.984, 0.998 */
  for (int member = 0; member < 2; member++) {
    struct eo_design design = plain_design();
    design.pitch.member[member].eccentricity = 1e-6;
    const struct eo_pitch_case *c = run(&design);
    close_to(1e6 * amplitude(c, member ? "gear 1" : "pinion 1"), averaged[member], 3e-3,
             member ? "1 um of eccentricity of the gear" : "1 um of eccentricity of the pinion");
  }
}

/* Where both turn their high spots towards each other the effects add up, half a turn later they cancel: teeth 0 and 0
   meet with both eccentricities along the line of action. */
static void test_eccentricity_phase(void)
{
  struct eo_design design = plain_design();
  struct eo_tooth_deviation tooth[GEAR];
  struct eo_error error;
  double alpha = pair->geometry.working_pressure_angle, at = cos(pair->geometry.transverse_pressure_angle);
  design.pitch.member[0].eccentricity = design.pitch.member[1].eccentricity = 2e-6;
  for (int side = 0; side < 2; side++)
    for (int member = 0; member < 2; member++) {
      struct eo_pitch_meeting meeting = {.side = (enum eo_flank_side)side, .lead_driver = EO_PINION};
      if (eo_pitch_compose(&design.pitch, &pair->geometry, &meeting, member, EO_LEFT, tooth, &error))
        stop(&error);
      int quarter = pair->geometry.teeth[member] / 4;
      double turn = 2 * M_PI * quarter / pair->geometry.teeth[member];
      /* displaced by e (cos, sin) of the angle from the line of centres; the drive flank of the driver looks ahead */
      double sense = (side == EO_DRIVE_FLANK) == (member == EO_PINION) ? 1 : -1;
      close_to(1e6 * tooth[quarter].index * at, 2 * (cos(turn) * sin(alpha) + sense * sin(turn) * cos(alpha)), 1e-9,
               "displacement along the line of action a quarter turn on, um");
    }
}

static void test_wobble(void)
{
  struct eo_design design = plain_design();
  double lean = sin(pair->geometry.base_helix_angle);
  design.pitch.member[0].wobble = 3e-6;
  const struct eo_pitch_case *c = run(&design);
  /* the pinion floats back by what its teeth are displaced, so that nothing is left of it but the float */
  ok(c->float_swing > 5.5e-6 && c->float_swing < 6.01e-6,
     "the pinion shuttles against its teeth's axial wobble (%.3f um)", 1e6 * c->float_swing);
  ok(amplitude(c, "pinion 1") < 1e-3 * 3e-6 * lean + 2e-9,
     "the transmission error does not know of the axial wobble (%.2e m)", amplitude(c, "pinion 1"));
}

/* Any numbers of both members' teeth, the same on both hands. */
static void put_tables(struct eo_design *design, enum eo_flank_side side, bool reversed)
{
  struct eo_error error;
  for (int member = 0; member < 2; member++) {
    int z = pair->geometry.teeth[member];
    double value[GEAR];
    for (int i = 0; i < z; i++)
      value[reversed ? (z - i) % z : i] = 1e-6 * ((7 * i + 3 * i * i) % 11) / 2;
    for (int end = 0; end < 2; end++)
      if (eo_tooth_tables_add(&design->pitch.tables, side, member, end, EO_TOOTH_INDEX, z, value, &error))
        stop(&error);
  }
}

/* On the coast flanks, astern, the teeth come in reversed order: with the table reversed they do what the drive flanks
   do ahead. The gear's coast flanks stand one tooth on. */
static void test_coast(void)
{
  struct eo_design ahead = plain_design();
  put_tables(&ahead, EO_DRIVE_FLANK, false);
  const struct eo_pitch_case *c = run(&ahead);
  int n = c->hunting.instants;
  double *before = malloc(sizeof *before * (size_t)n), most = 0;
  memcpy(before, c->transmission, sizeof *before * (size_t)n);
  struct eo_design astern = plain_design();
  for (int i = 0; i < 4; i++)
    astern.modification.coast[i / 2][i % 2] = astern.modification.flank[i / 2][i % 2];
  astern.load_case[0].direction = EO_ASTERN;
  astern.pitch.gear_tooth = GEAR - 1;
  put_tables(&astern, EO_COAST_FLANK, true);
  c = run(&astern);
  for (int i = 0; i < n; i++)
    most = fmax(most, fabs(c->transmission[i] - before[i]));
  ok(c->meeting.side == EO_COAST_FLANK && most < 1e-11,
     "coast flanks with reversed tables have the same curve (%.1e m)", most);
  ok(eo_pitch_tooth(&astern.pitch, &c->meeting, EO_PINION, PINION, 1) == PINION - 1,
     "teeth are named by the body's count");
  free(before);
}

static void test_parseval(void)
{
  struct eo_design design = plain_design();
  design.pitch.member[0].tolerance_class = design.pitch.member[1].tolerance_class = 6;
  const struct eo_pitch_case *c = run(&design);
  double square = 0, lines = pow(cabs(c->line[0]), 2);
  for (int i = 0; i < c->hunting.instants; i++)
    square += pow(c->transmission[i], 2) / c->hunting.instants;
  for (int k = 1; k < c->lines; k++)
    lines += pow(cabs(c->line[k]), 2) / (k == c->hunting.instants / 2 ? 1 : 2);
  near(lines, square, 1e-12, "mean square of the lines against that of the curve (Parseval)");
  for (int member = 0; member < 2; member++) {
    double complex first = 0;
    int bins = c->hunting.teeth[member] * POSITIONS;
    for (int i = 0; i < bins; i++)
      first += 2 * c->turn[member][i] * cexp(-2 * M_PI * I * i / bins) / bins;
    near(cabs(first), amplitude(c, member ? "gear 1" : "pinion 1"), 1e-9,
         "order of a member in the average over its turns");
  }
  ok(c->hunting.cycles == 90 && c->peak_to_peak > 10e-6, "the period has %d cycles and %.1f um peak to peak",
     c->hunting.cycles, 1e6 * c->peak_to_peak);
}

static void test_vibration(void)
{
  struct eo_design design = plain_design();
  const struct eo_pitch_case *c = run(&design);
  const struct eo_vibration *v = &analysis->evaluation->load_case[0].vibration;
  ok(c->response.outcome == EO_LONG_IN_CONTACT && c->response.change < 1e-6, "the motion repeats after a period");
  near(c->response.rms[EO_READING_NORMAL], v->rms_pair[EO_READING_NORMAL], 3e-3,
       "RMS of teeth alike by the harmonic balance, normal");
  near(c->response.rms[EO_READING_ROTATIONAL], v->rms_pair[EO_READING_ROTATIONAL], 3e-3,
       "RMS of teeth alike by the harmonic balance, rotational");
  /* so slow that inertia does nothing: the relative motion is the transmission error itself */
  design.pitch.member[1].eccentricity = 5e-6;
  double normal = cos(pair->geometry.base_helix_angle);
  for (double speed = 20; speed > 0.01; speed /= 10) {
    double omega = speed * PINION / GEAR;
    char what[100];
    design.load_case[0].speed = speed;
    c = run(&design);
    snprintf(what, sizeof what, "at %.3g rpm the gear's order accelerates by omega^2 times its transmission error",
             speed * 30 / M_PI);
    const struct eo_pitch_order *order = find_order(c, "gear 1");
    ok(c->response.outcome == EO_LONG_IN_CONTACT && order, "the pair stays in contact, and the gear has its order");
    near(order ? order->acceleration[EO_READING_NORMAL] : NAN, omega * omega * normal * amplitude(c, "gear 1"), 2e-2,
         what);
  }
}

static void test_threads(void)
{
  struct eo_design design = plain_design();
  design.pitch.member[0].tolerance_class = 7;
  double *first = NULL, rms = 0;
  bool same = true;
  for (int threads = 1; threads <= 2; threads++) {
    analysis->threads = threads;
    const struct eo_pitch_case *c = run(&design);
    size_t n = (size_t)c->hunting.instants;
    if (threads == 1) {
      first = malloc(sizeof *first * n);
      memcpy(first, c->transmission, sizeof *first * n);
      rms = c->response.rms[0];
    } else
      same = memcmp(first, c->transmission, sizeof *first * n) == 0 && rms == c->response.rms[0];
  }
  analysis->threads = 1;
  free(first);
  ok(same, "one thread and two give the same bytes");
}

static bool faulty(const char *pitch, const char *pointer, const char *text)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_gear_pair teeth = pair->gear_pair;
  static struct eo_pitch read;
  json_t *object = json_loads(pitch, 0, NULL);
  eo_pitch_decode(object, &teeth, &read, faults);
  bool right = faults->count > 0 && strcmp(faults->fault[0].pointer, pointer) == 0 &&
               strstr(faults->fault[0].text, text);
  if (!right)
    printf("# %d faults, %s: %s\n", faults->count, faults->fault[0].pointer, faults->fault[0].text);
  json_decref(object);
  free(faults);
  return right;
}

static void test_document(void)
{
  static struct eo_pitch read, again;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *object = json_pack("{s:{s:i,s:{s:s}},s:{s:f,s:{s:{s:[f,f]}}}}", "pinion", "tolerance_class", 5, "left", "csv",
                             "# teeth\ntooth;single_um;helix_slope_um\n1;-3;1\n2;1,5;1\n3;-0,5;1\n4;2;1\n5;0;1\n",
                             "gear", "eccentricity_um", 3.5, "right", "coast", "index_um", 1.0, -1.0);
  struct eo_gear_pair teeth = pair->gear_pair;
  teeth.teeth[EO_PINION] = 5;
  teeth.teeth[EO_GEAR] = 2;
  eo_pitch_decode(object, &teeth, &read, faults);
  json_t *crowned = json_loads("{\"pinion\":{\"left\":{\"profile_crowning_um\":[1,2,3,4,5],"
                               "\"csv\":null},\"flank_class\":6}}",
                               0, NULL);
  eo_pitch_decode(crowned, &teeth, &again, faults);
  const double *crowning = eo_tooth_table_at(&again.tables, EO_DRIVE_FLANK, EO_PINION, EO_LEFT,
                                             EO_TOOTH_PROFILE_CROWNING);
  ok(faults->count == 0 && crowning && fabs(crowning[4] - 5e-6) < 1e-15 && again.member[EO_PINION].flank_class == 6,
     "crownings of single teeth and the class of what is not stated are read");
  json_decref(crowned);
  const double *index = eo_tooth_table_at(&read.tables, EO_DRIVE_FLANK, EO_PINION, EO_LEFT, EO_TOOTH_INDEX);
  ok(faults->count == 0 && index && fabs(index[1] - 1.5e-6) < 1e-15 && fabs(index[3] - 3e-6) < 1e-15,
     "single pitch deviations add up, decimal commas are read");
  json_t *written = eo_pitch_encode(&read, 2);
  eo_pitch_decode(written, &teeth, &again, faults);
  ok(faults->count == 0 && memcmp(&read, &again, sizeof read) == 0,
     "pitch deviations written and read again are the same");
  json_decref(written);
  json_decref(object);
  free(faults);
  ok(faulty("{\"pinion\":{\"left\":{\"index_um\":[1,2,3]}}}", "/pitch/pinion/left/index_um", "18 teeth"),
     "a fault of a table of another length names key and teeth");
  ok(faulty("{\"gear\":{\"left\":{\"csv\":\"tooth,index_um\\n0,1\\n1,x\\n\"}}}", "/pitch/gear/left/csv",
            "Line 3, column 2"),
     "a cell that is no number has its line and column");
  ok(faulty("{\"gear\":{\"left\":{\"csv\":\"tooth,index_um\\n0,1\\n0,2\\n\"}}}", "/pitch/gear/left/csv", "already"),
     "a tooth that is there twice is refused");
  ok(faulty("{\"csv\":\"member,end,flank,tooth,index_um\\ngear,left,coast,1,0\\ngear,left,coast,3,1.5\\n\"}",
            "/pitch/csv", "The table of the gear, left end, coast flank, leaves out tooth 2"),
     "a table of many flanks says whose tooth it leaves out");
  ok(faulty("{\"csv\":\"tooth,index_um\\n0,1\\n\"}", "/pitch/csv", "member"),
     "a fault in a table of the pair says whose teeth");
  ok(faulty("{\"csv\":\"member,end,flank,tooth,single_um\\ngear,left,coast,1,0\\ngear,left,coast,2,1.5\\n"
            "gear,left,coast,3,1.5\\n\"}",
            "/pitch/csv", "of the gear, left end, coast flank, add up to 3 um over 3 teeth"),
     "single pitch deviations that do not come back to the first tooth name whose they are and their sum");
  ok(faulty("{\"gear\":{\"left\":{\"csv\":\"tooth,single_um\\n1,0.4\\n2,0.4\\n3,-0.1\\n\"}}}", "/pitch/gear/left/csv",
            "index_um"),
     "the fault of such a sum asks whether they are index deviations");
  ok(faulty("{\"gear\":{\"left\":{\"csv\":\"tooth,single_um\\n1,0.4\\n2,0.3\\n3,-0.8\\n\"}}}",
            "/pitch/gear/left/single_um", "") ||
         faulty("{\"gear\":{\"left\":{\"csv\":\"tooth,single_um\\n1,0.4\\n2,0.3\\n3,-0.8\\n\"}}}",
                "/pitch/gear/left/index_um", "3"),
     "a sum that rounding to tenths leaves is no fault, and the next one is that of three teeth");
  ok(faulty("{\"csv\":\"member,end,flank,tooth,index_um\\n\"}", "/pitch/csv", "not one tooth"),
     "headings without teeth are refused");
  ok(faulty("{\"pinion\":{\"eccentricity\":1}}", "/pitch/pinion/eccentricity", ""),
     "an unknown key of the pitch is refused");
}

static void test_refusals(void)
{
  struct eo_error error;
  struct eo_geometry geometry;
  struct eo_design design = plain_design();
  design.pitch.positions = 5;
  ok(eo_design_complete(&design, &geometry, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/pitch/positions_per_cycle") == 0,
     "positions that are not among the resolution's are refused");
  design.pitch.positions = 0;
  design.pitch.member[1].tolerance_class = 12;
  ok(eo_design_complete(&design, &geometry, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/pitch/gear/tolerance_class") == 0,
     "a class that ISO 1328-1:2013 does not have is refused");
  design.pitch.member[1].tolerance_class = 0;
  design.pitch.member[1].flank_class = 12;
  ok(eo_design_complete(&design, &geometry, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/pitch/gear/flank_class") == 0,
     "a class of flanks that ISO 1328-1:2013 does not have is refused");
}

int main(void)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build("paper-case-a", &design);
  design.gear_pair.teeth[EO_PINION] = PINION;
  design.gear_pair.teeth[EO_GEAR] = GEAR;
  design.resolution.positions = POSITIONS;
  design.resolution.te_harmonics = 10;
  design.resolution.cells_per_line = 12;
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  if (eo_design_complete(&design, &geometry, &error) || eo_pair_new(&pair, &design, &options, NULL, &error) ||
      eo_analysis_new(&analysis, pair, &error))
    stop(&error);
  test_drawn();
  test_stop();
  test_eccentricity();
  test_eccentricity_phase();
  test_wobble();
  test_coast();
  test_parseval();
  test_vibration();
  test_threads();
  test_document();
  test_refusals();
  eo_analysis_free(analysis);
  eo_pair_free(pair);
  return tap_done();
}

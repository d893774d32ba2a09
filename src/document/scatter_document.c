/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/scatter_document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "design/made_teeth.h"
#include "document/scatter_distance.h"
#include "document/scatter_distribution.h"
#include "document/scatter_teeth.h"
#include "gear/names.h"
#include "rating/flank_tolerance.h"

/* Where an evaluation reads its numbers; other blocks belong to the prepared pair, the rating or the search. */
static const char *const varied[] = {"modification", "alignment", "supports", "shafts", "load_cases", NULL};

/* What a key is being looked up for. */
struct search {
  struct eo_scatter *scatter;
  const struct eo_design *design;
  const struct eo_scatter_row *row;
  bool revolutions; /* the inputs are those of an analysis that computes whole revolutions where it is asked to */
  char pointer[64]; /* of the row in the design; "" for a preset's */
  int found;
  struct eo_error *error;
};

static enum eo_code refuse(const struct search *search, const char *why)
{
  return eo_scatter_refuse_row(search->row, search->pointer, "key", why, search->error);
}

/* A key that is there already is taken anew: what is stated comes behind the preset. */
static struct eo_scatter_input *place_for(struct eo_scatter *scatter, const char *key)
{
  for (int i = 0; i < scatter->inputs; i++)
    if (strcmp(scatter->input[i].key, key) == 0)
      return &scatter->input[i];
  if (scatter->inputs == EO_MAX_SCATTER_INPUTS)
    return NULL;
  scatter->input[scatter->inputs].key[0] = '\0';
  return &scatter->input[scatter->inputs++];
}

static enum eo_code add_input(struct search *search, const char *key, const struct eo_scatter_input *where)
{
  struct eo_scatter_input *input = place_for(search->scatter, key);
  if (!input)
    return refuse(search, "more inputs than can scatter at once.");
  bool new = !*input->key;
  *input = *where;
  snprintf(input->key, sizeof input->key, "%s", key);
  search->found++;
  EO_TRY(eo_scatter_set_distribution(input, &search->design->tolerance, search->row, search->pointer, search->error));
  if (new && !eo_scatter_moves(&input->deviation))
    return refuse(search, "nothing scatters: state sigma, of a uniform distribution low and high, or leave the input "
                          "out. Without any it switches off an input of the preset, and the preset has none here.");
  return EO_OK;
}

/* A search has prepared one distance. */
static enum eo_code settle_distance(const struct search *search, const char *key)
{
  if (!search->revolutions)
    return refuse(search,
                  "a search evaluates every design at one centre distance, since each asks for a contact grid of "
                  "its own: leave it to `easeoff tolerance`, or set /objective/robust to \"off\".");
  struct eo_scatter_input *input = place_for(search->scatter, key);
  return eo_scatter_settle_distance(input, search->design, search->row, search->pointer, search->error);
}

static enum eo_code add_number(struct search *search, const char *key, const struct eo_field *field, size_t offset)
{
  const struct eo_unit *unit = field->unit;
  double si;
  memcpy(&si, (const char *)search->design + offset, sizeof si);
  if (strncmp(key, "alignment.", 10) == 0 && strstr(key, "_um") && strstr(key, "shaft_angle"))
    return refuse(search, "a shaft angle error scatters as an angle, shaft_angle_error_..._deg.");
  if (isnan(si))
    return refuse(search, "it is not stated, so there is nothing to scatter about.");
  struct eo_scatter_input input = {.offset = offset,
                                   .unit = eo_unit_in(unit, 1),
                                   .nominal = eo_unit_out(unit, si),
                                   .least = field->low,
                                   .most = field->high,
                                   .cyclic = offset == offsetof(struct eo_design, alignment.stagger)};
  EO_TRY(add_input(search, key, &input));
  return offset == EO_SCATTER_DISTANCE ? settle_distance(search, key) : EO_OK;
}

static enum eo_code walk(struct search *search, const struct eo_table *table, size_t base, const char *rest,
                         const char *before);

/* Rows of a list by number, from 1. */
static enum eo_code walk_list(struct search *search, const struct eo_field *field, size_t base, const char *rest,
                              const char *before)
{
  size_t length = strcspn(rest, ".");
  int rows;
  bool all = length == 1 && *rest == '*';
  memcpy(&rows, (const char *)search->design + base + field->count_offset, sizeof rows);
  for (int i = 0; i < rows && rest[length]; i++) {
    char key[EO_SCATTER_NAME];
    if (!all && strtol(rest, NULL, 10) != i + 1)
      continue;
    snprintf(key, sizeof key, "%.80s.%d", before, i + 1);
    EO_TRY(walk(search, field->table, base + field->offset + (size_t)i * field->table->size, rest + length + 1, key));
  }
  return EO_OK;
}

/* A coast flank is meant where its name stands, not by a star; the other end of a pair with one is not there. */
static bool is_meant(const struct search *search, const struct eo_field *field, const char *name, size_t length)
{
  bool star = length == 1 && *name == '*';
  if (search->design->gear_pair.ends == 1 && strcmp(field->key, "right") == 0)
    return false;
  if (star)
    return strcmp(field->key, "coast") != 0 && field->kind == EO_FIELD_OBJECT;
  return strlen(field->key) == length && strncmp(field->key, name, length) == 0;
}

static enum eo_code walk(struct search *search, const struct eo_table *table, size_t base, const char *rest,
                         const char *before)
{
  size_t length = strcspn(rest, ".");
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    char key[EO_SCATTER_NAME];
    if (!is_meant(search, field, rest, length) || field->flags & EO_FIELD_ELSEWHERE)
      continue;
    snprintf(key, sizeof key, "%.48s%s%.40s", before, *before ? "." : "", field->key);
    if (field->kind == EO_FIELD_OBJECT && rest[length] && !(field->flags & EO_FIELD_NULLABLE))
      EO_TRY(walk(search, field->table, base + field->offset, rest + length + 1, key));
    else if (field->kind == EO_FIELD_LIST && rest[length])
      EO_TRY(walk_list(search, field, base, rest + length + 1, key));
    else if (field->kind == EO_FIELD_NUMBER && !rest[length])
      EO_TRY(add_number(search, key, field, base + field->offset));
  }
  return EO_OK;
}

static enum eo_code add_factor(struct search *search, int target)
{
  struct eo_scatter_input input = {.target = target, .unit = 1, .nominal = 1, .least = 0.1, .most = 10};
  return add_input(search, search->row->key, &input);
}

/* Numbers of the members' teeth, rest: "pinion.eccentricity_um". A search does not turn the gears round. */
static enum eo_code add_tooth_numbers(struct search *search, const char *rest)
{
  struct eo_tooth_number number;
  if (!search->revolutions)
    return EO_OK;
  if (!search->design->tolerance.single_teeth)
    return refuse(search, "what single teeth do is computed where the block tolerance has \"single_teeth\": true.");
  search->found = 0;
  for (int member = 0; member < 2; member++)
    if (eo_scatter_find_tooth_number(rest, member, &number))
      EO_TRY(add_number(search, number.key, number.field, number.offset));
  return search->found ? EO_OK : refuse(search, "there is no such number of a member's teeth.");
}

static enum eo_code add_row(struct search *search)
{
  const char *key = search->row->key;
  bool known = false;
  if (strcmp(key, "compliance_factor") == 0)
    return add_factor(search, EO_TARGET_COMPLIANCE);
  if (strcmp(key, "speed_factor") == 0)
    return add_factor(search, EO_TARGET_SPEED);
  if (strncmp(key, "pitch.", 6) == 0)
    return add_tooth_numbers(search, key + 6);
  if (strcmp(key, "centre_distance") == 0 || strcmp(key, "gear_pair.centre_distance_mm") == 0)
    return refuse(search, "axes scatter as alignment.centre_distance_deviation_um, about the distance of the drawing.");
  for (int i = 0; varied[i]; i++)
    known |= strncmp(key, varied[i], strlen(varied[i])) == 0 && key[strlen(varied[i])] == '.';
  if (!known)
    return refuse(search, "what scatters stands in modification, alignment, supports, shafts, load_cases or pitch, or "
                          "is compliance_factor or speed_factor; another gear pair is prepared anew.");
  search->found = 0;
  EO_TRY(walk(search, &eo_design_table, 0, key, ""));
  return search->found ? EO_OK : refuse(search, "there is no such number in the design.");
}

static enum eo_code add_stated(struct eo_scatter *scatter, const struct eo_design *design, bool revolutions,
                               struct eo_error *error)
{
  const struct eo_tolerance_settings *tolerance_settings = &design->tolerance;
  for (int i = 0; i < tolerance_settings->rows; i++) {
    struct search search = {.scatter = scatter,
                            .design = design,
                            .row = &tolerance_settings->row[i],
                            .revolutions = revolutions,
                            .error = error};
    snprintf(search.pointer, sizeof search.pointer, "/tolerance/inputs/%d", i);
    if (tolerance_settings->preset == EO_SCATTER_AS_MEASURED && tolerance_settings->row[i].kind != EO_SCATTER_VALUES)
      return refuse(&search, "with the preset as_measured every input has values.");
    EO_TRY(add_row(&search));
  }
  return EO_OK;
}

/* One input of a preset. */
static enum eo_code add_preset_row(struct eo_scatter *scatter, const struct eo_design *design,
                                   const struct eo_scatter_row *row, struct eo_error *error)
{
  struct search search = {
      .scatter = scatter, .design = design, .row = row, .revolutions = true, .pointer = "/tolerance", .error = error};
  return add_row(&search);
}

/* The centre distance within its allowance, which is the tolerance of the housing. */
static enum eo_code add_distance(struct eo_scatter *scatter, const struct eo_design *design, bool revolutions,
                                 struct eo_error *error)
{
  const struct eo_scatter_row row = eo_scatter_distance_row(design);
  struct search search = {.scatter = scatter,
                          .design = design,
                          .row = &row,
                          .revolutions = revolutions,
                          .pointer = "/tolerance/centre_distance",
                          .error = error};
  return add_row(&search);
}

static enum eo_code add_normal(struct eo_scatter *scatter, const struct eo_design *design, const char *key,
                               double limit, struct eo_error *error)
{
  bool ground = design->tolerance.preset == EO_SCATTER_GROUND;
  struct eo_scatter_row row = {.kind = EO_SCATTER_NORMAL, .sigma = limit / (ground ? 3 : 2), .cut = ground ? 3 : 2.5};
  snprintf(row.key, sizeof row.key, "%s", key);
  return add_preset_row(scatter, design, &row, error);
}

static enum eo_code tolerance_of(const struct eo_design *design, int member, int end,
                                 struct eo_flank_tolerance *tolerance, struct eo_error *error)
{
  const struct eo_tolerance_settings *tolerance_settings = &design->tolerance;
  const struct eo_gear_pair *pair = &design->gear_pair;
  struct eo_error found;
  struct eo_tolerance_input in = {.reference_diameter = pair->normal_module / cos(pair->helix_angle) *
                                                        pair->teeth[member],
                                  .normal_module = pair->normal_module,
                                  .face_width = eo_gear_pair_face_width(pair, end),
                                  .teeth = pair->teeth[member],
                                  .grade = tolerance_settings->grade,
                                  .total_contact_ratio = NAN,
                                  .helix_angle = pair->helix_angle};
  if (eo_flank_tolerance(tolerance, (enum eo_tolerance_edition)tolerance_settings->edition, &in, &found))
    return eo_error_set(error, EO_ERROR_INPUT, "/tolerance/class", "%.380s", found.text);
  return EO_OK;
}

/* Reliefs and the lead crowning that a flank has, within 2 um: what a ground flank's wheel and axes keep to. */
static enum eo_code add_ground(struct eo_scatter *scatter, const struct eo_design *design, int member, int end,
                               const char *flank, struct eo_error *error)
{
  const struct eo_flank_modification *own = &design->modification.flank[member][end];
  const struct {
    const char *key;
    double amount;
  } all[] = {{"tip_relief_um", own->tip_relief}, {"root_relief_um", own->root_relief}};
  for (int i = 0; i < 2; i++) {
    struct eo_scatter_row row = {.kind = EO_SCATTER_UNIFORM, .low = -2, .high = 2, .cut = NAN};
    snprintf(row.key, sizeof row.key, "%s.%s", flank, all[i].key);
    if (all[i].amount > 0)
      EO_TRY(add_preset_row(scatter, design, &row, error));
  }
  struct eo_scatter_row crowning = {.kind = EO_SCATTER_UNIFORM, .low = -2, .high = 2, .cut = NAN};
  snprintf(crowning.key, sizeof crowning.key, "%s.lead_crowning_um", flank);
  return add_preset_row(scatter, design, &crowning, error);
}

/* Slopes by f_H, a barrel and a crowning by the form tolerances f_f: what of a form deviation a flank has as a whole.
 */
static enum eo_code add_flank(struct eo_scatter *scatter, const struct eo_design *design,
                              const struct eo_flank_tolerance *tolerance, int member, int end, struct eo_error *error)
{
  const struct {
    const char *key;
    double limit;
  } all[] = {{"profile_slope_um", tolerance->profile_slope},
             {"profile_crowning_um", tolerance->profile_form},
             {"helix_slope_um", tolerance->helix_slope},
             {"lead_crowning_um", tolerance->helix_form}};
  char flank[64], key[EO_SCATTER_KEY];
  snprintf(flank, sizeof flank, "modification.%s.%s", eo_member_name[member], eo_end_name[end]);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    snprintf(key, sizeof key, "%s.%s", flank, all[i].key);
    EO_TRY(add_normal(scatter, design, key, 1e6 * all[i].limit, error));
  }
  return design->tolerance.preset == EO_SCATTER_GROUND ? add_ground(scatter, design, member, end, flank, error) : EO_OK;
}

/* Flanks of both members, and the shafts by ISO/TR 10064-3: f_Sigma over the bearing span as an angle, whatever the
   span, with the F_beta of the gear. */
static enum eo_code add_preset(struct eo_scatter *scatter, const struct eo_design *design, struct eo_error *error)
{
  struct eo_flank_tolerance tolerance = {0};
  for (int member = 0; member < 2; member++) {
    for (int end = 0; end < design->gear_pair.ends; end++) {
      EO_TRY(tolerance_of(design, member, end, &tolerance, error));
      EO_TRY(add_flank(scatter, design, &tolerance, member, end, error));
    }
  }
  EO_TRY(tolerance_of(design, EO_GEAR, EO_LEFT, &tolerance, error));
  struct eo_axis_tolerance axis = eo_axis_tolerance(tolerance.helix_total, 1);
  double per_width = 180 / M_PI / design->gear_pair.face_width;
  EO_TRY(add_normal(scatter, design, "alignment.shaft_angle_error_in_plane_deg", axis.in_plane * per_width, error));
  return add_normal(scatter, design, "alignment.shaft_angle_error_out_of_plane_deg", axis.out_of_plane * per_width,
                    error);
}

/* Index deviations within the tolerances, as large as a half normal size of which they are two or three sigma: flanks
   that are drawn reach one of the tolerances with a share of 1, and gears beyond them are sorted out. */
static enum eo_code add_teeth(struct eo_scatter *scatter, const struct eo_design *design, struct eo_error *error)
{
  int sigmas = design->tolerance.preset == EO_SCATTER_GROUND ? 3 : 2;
  const struct eo_scatter_row row = {
      .key = "pitch.*.tolerance_share", .kind = EO_SCATTER_HALF_NORMAL, .sigma = 1. / sigmas, .cut = sigmas};
  return add_preset_row(scatter, design, &row, error);
}

static enum eo_code add_all(struct eo_scatter *scatter, const struct eo_design *design, bool preset, bool revolutions,
                            struct eo_error *error)
{
  bool teeth = revolutions && design->tolerance.single_teeth;
  scatter->inputs = 0;
  if (preset)
    EO_TRY(add_preset(scatter, design, error));
  if (design->tolerance.centre_distance)
    EO_TRY(add_distance(scatter, design, revolutions, error));
  if (teeth)
    EO_TRY(add_teeth(scatter, design, error));
  EO_TRY(add_stated(scatter, design, revolutions, error));
  if (teeth)
    EO_TRY(eo_scatter_add_seeds(scatter, error));
  return eo_scatter_settle(scatter, error);
}

/* revolutions: with single teeth, where the block asks for them. */
static enum eo_code find_inputs(struct eo_scatter *scatter, const struct eo_design *design, bool preset,
                                bool revolutions, struct eo_error *error)
{
  if (!revolutions || !design->tolerance.single_teeth)
    return add_all(scatter, design, preset, revolutions, error);
  struct eo_design *toothed = malloc(sizeof *toothed);
  if (!toothed)
    return eo_error_memory(error);
  memcpy(toothed, design, sizeof *toothed);
  eo_design_state_teeth(toothed);
  enum eo_code code = eo_scatter_check_teeth(design, toothed, error);
  if (!code)
    code = add_all(scatter, toothed, preset, true, error);
  free(toothed);
  return code;
}

/* Whether the inputs of a preset are there beside those stated. */
static bool has_preset(const struct eo_design *design, bool assume_class, bool *assumed)
{
  const struct eo_tolerance_settings *settings = &design->tolerance;
  bool nothing = settings->preset == EO_SCATTER_AS_STATED && settings->rows == 0 && !settings->centre_distance;
  if (assumed)
    *assumed = nothing && assume_class;
  return (nothing && assume_class) || settings->preset == EO_SCATTER_ISO_CLASS || settings->preset == EO_SCATTER_GROUND;
}

enum eo_code eo_scatter_of_design(struct eo_scatter *scatter, const struct eo_design *design, bool assume_class,
                                  bool *assumed, struct eo_error *error)
{
  return find_inputs(scatter, design, has_preset(design, assume_class, assumed), true, error);
}

/* Deviations alone: bounds count for the design that is tried. */
static enum eo_code draw(struct eo_design *design, struct eo_scatter *scatter, int from, int pairs, int points,
                         struct eo_error *error)
{
  struct eo_drawn_pairs *drawn = &design->drawn;
  struct eo_sampler *sampler;
  double value[EO_MAX_SCATTER_INPUTS];
  if (scatter->inputs > EO_MAX_DRAWN_INPUTS)
    return eo_error_set(error, EO_ERROR_INPUT, "/objective/scatter_pairs",
                        "%d inputs scatter, and a robust objective draws %d at most: state fewer.", scatter->inputs,
                        EO_MAX_DRAWN_INPUTS);
  for (int i = 0; i < scatter->inputs; i++) {
    struct eo_scatter_input *input = &scatter->input[i];
    drawn->input[i] = (struct eo_drawn_input){.target = input->target,
                                              .offset = input->offset,
                                              .low = input->least * input->unit,
                                              .high = input->most * input->unit};
    input->nominal = 0;
    input->least = -INFINITY;
    input->most = INFINITY;
  }
  EO_TRY(eo_sampler_new(&sampler, (enum eo_sampling)design->tolerance.sampling, scatter->dimensions, points,
                        design->tolerance.seed, error));
  for (int pair = 0; pair < pairs; pair++) {
    eo_scatter_draw(scatter, sampler, from + pair, value);
    for (int i = 0; i < scatter->inputs; i++)
      drawn->deviation[pair][i] = value[i] * scatter->input[i].unit;
  }
  eo_sampler_free(sampler);
  drawn->inputs = scatter->inputs;
  drawn->pairs = pairs;
  return EO_OK;
}

enum eo_code eo_scatter_draw_pairs(struct eo_design *design, struct eo_error *error)
{
  int pairs = design->objective.scatter_pairs;
  memset(&design->drawn, 0, sizeof design->drawn);
  if (design->objective.robust == EO_ROBUST_OFF || pairs == 0)
    return EO_OK;
  return eo_scatter_draw_range(design, 0, pairs, pairs, error);
}

enum eo_code eo_scatter_draw_range(struct eo_design *design, int first, int pairs, int points, struct eo_error *error)
{
  struct eo_scatter *scatter = malloc(sizeof *scatter);
  if (!scatter)
    return eo_error_memory(error);
  enum eo_code code = find_inputs(scatter, design, has_preset(design, true, NULL), false, error);
  if (!code)
    code = draw(design, scatter, first, pairs, points, error);
  free(scatter);
  return code;
}

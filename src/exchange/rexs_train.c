/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_train.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "numerics/dense.h"

static const double same = 1e-6;           /* relative: numbers of two ends that are one */
static const double place_tolerance = 0.1; /* mm, by which the distances of both members' ends may differ */

double eo_rexs_value(const struct eo_rexs_component *component, const char *attribute)
{
  const struct eo_rexs_attribute *rexs_attribute = eo_rexs_attribute(component, attribute);
  return rexs_attribute && rexs_attribute->shape == EO_REXS_SCALAR ? eo_rexs_number(rexs_attribute->text) : NAN;
}

bool eo_rexs_flag(const struct eo_rexs_component *component, const char *attribute)
{
  const struct eo_rexs_attribute *rexs_attribute = eo_rexs_attribute(component, attribute);
  return rexs_attribute && strcmp(rexs_attribute->text, "true") == 0;
}

const struct eo_rexs_component *eo_rexs_related(const struct eo_rexs_model *model, const char *type, const char *role,
                                                const struct eo_rexs_component *component, const char *other, int *at)
{
  while (*at < model->relations && component) {
    const struct eo_rexs_relation *relation = &model->relation[(*at)++];
    if (strcmp(relation->type, type) != 0 || eo_rexs_role(relation, role) != component->id)
      continue;
    const struct eo_rexs_component *found = eo_rexs_find(model, eo_rexs_role(relation, other));
    if (found)
      return found;
  }
  return NULL;
}

void eo_rexs_axis(const struct eo_rexs_component *component, double axis[3], double origin[3])
{
  const struct eo_rexs_attribute *attribute = eo_rexs_attribute(component, "u_axis_vector"),
                                 *support = eo_rexs_attribute(component, "support_vector");
  bool stated = attribute && attribute->count == 3;
  double length = stated ? sqrt(attribute->value[0] * attribute->value[0] + attribute->value[1] * attribute->value[1] +
                                attribute->value[2] * attribute->value[2])
                         : 0;
  for (int i = 0; i < 3; i++) {
    axis[i] = length > 0 ? attribute->value[i] / length : i == 0;
    origin[i] = support && support->count == 3 && isfinite(support->value[i]) ? support->value[i] : 0;
  }
}

static int shaft_index(const struct eo_rexs_train *train, const struct eo_rexs_component *shaft)
{
  for (int i = 0; i < train->shafts; i++)
    if (train->shaft[i] == shaft)
      return i;
  return -1;
}

/* By an assembly, or by a fit or key between shaft and gear. */
static const struct eo_rexs_component *shaft_of(const struct eo_rexs_model *model, const struct eo_rexs_component *gear)
{
  const struct eo_rexs_component *up;
  for (int at = 0; (up = eo_rexs_related(model, "assembly", "part", gear, "assembly", &at));)
    if (eo_rexs_is(up, "shaft"))
      return up;
  for (int at = 0; (up = eo_rexs_related(model, "side", "outer_part", gear, "inner_part", &at));)
    if (eo_rexs_is(up, "shaft"))
      return up;
  return NULL;
}

static double first_number(double a, double b)
{
  return isnan(a) ? b : a;
}

static void place_wheel(struct eo_rexs_wheel *wheel, const struct eo_rexs_component *shaft, const double x[3],
                        bool oldest)
{
  double axis[3], origin[3], shaft_axis[3], shaft_origin[3];
  eo_rexs_axis(wheel->gear, axis, origin);
  eo_rexs_axis(shaft, shaft_axis, shaft_origin);
  wheel->along = (eo_rexs_attribute(wheel->gear, "u_axis_vector") ? eo_dot(3, axis, x) : eo_dot(3, shaft_axis, x)) < 0
                     ? -1
                     : 1;
  double forward = eo_dot(3, shaft_axis, x) < 0 ? -1 : 1, u = eo_rexs_value(wheel->gear, "u_coordinate_on_shaft");
  double start = isnan(u) ? NAN : eo_dot(3, shaft_origin, x) + forward * u;
  double other = isnan(u) ? NAN : start + forward * wheel->face_width;
  if (isnan(u) && eo_rexs_attribute(wheel->gear, "support_vector")) { /* the face, of 1.0 its middle */
    start = eo_dot(3, origin, x) - (oldest ? wheel->along * wheel->face_width / 2 : 0);
    other = start + wheel->along * wheel->face_width;
  }
  wheel->left = fmin(start, other);
  wheel->right = fmax(start, other);
}

static void read_wheel(struct eo_rexs_train *train, struct eo_rexs_wheel *wheel, const struct eo_rexs_component *stage,
                       const struct eo_rexs_component *gear)
{
  const struct eo_rexs_model *model = train->model;
  const double degree = M_PI / 180;
  wheel->gear = gear;
  wheel->shaft = shaft_index(train, shaft_of(model, gear));
  int at[2] = {0, 0};
  wheel->flank[0] = eo_rexs_related(model, "flank", "gear", gear, "left", &at[0]);
  wheel->flank[1] = eo_rexs_related(model, "flank", "gear", gear, "right", &at[1]);
  for (int i = 0; i < model->relations && !wheel->data; i++)
    if (strcmp(model->relation[i].type, "stage_gear_data") == 0 &&
        eo_rexs_role(&model->relation[i], "stage") == stage->id &&
        eo_rexs_role(&model->relation[i], "gear") == gear->id)
      wheel->data = eo_rexs_find(model, eo_rexs_role(&model->relation[i], "stage_gear_data"));
  const struct eo_rexs_component *flank = wheel->flank[0] ? wheel->flank[0] : wheel->flank[1];
  wheel->teeth = eo_rexs_value(gear, "number_of_teeth");
  wheel->helix = eo_rexs_value(gear, "helix_angle_reference_diameter");
  wheel->module = first_number(eo_rexs_value(gear, "normal_module"),
                               eo_rexs_value(gear, "transverse_module") * cos(wheel->helix * degree));
  wheel->face_width = eo_rexs_value(gear, "face_width");
  wheel->pressure_angle = eo_rexs_value(flank, "normal_pressure_angle");
  wheel->shift = first_number(eo_rexs_value(flank, "addendum_modification_coefficient"),
                              eo_rexs_value(flank, "addendum_modification") / wheel->module);
}

/* Stated, or the distance of the axes. */
static void find_distance(const struct eo_rexs_train *train, struct eo_rexs_mesh *mesh)
{
  double axis[2][3], origin[2][3], across = 0;
  mesh->centre_distance = eo_rexs_value(mesh->stage, "center_distance");
  if (mesh->wheel[0].shaft < 0 || mesh->wheel[1].shaft < 0)
    return;
  for (int i = 0; i < 2; i++)
    eo_rexs_axis(train->shaft[mesh->wheel[i].shaft], axis[i], origin[i]);
  mesh->crossed = fabs(fabs(eo_dot(3, axis[0], axis[1])) - 1) > same;
  double apart[3] = {origin[1][0] - origin[0][0], origin[1][1] - origin[0][1], origin[1][2] - origin[0][2]};
  double along = eo_dot(3, apart, axis[0]);
  for (int i = 0; i < 3; i++)
    across += pow(apart[i] - along * axis[0][i], 2);
  if (isnan(mesh->centre_distance) && across > 0) {
    mesh->centre_distance = sqrt(across);
    mesh->from_positions = true;
  }
}

static void read_mesh(struct eo_rexs_train *train, const struct eo_rexs_relation *relation)
{
  static const char *const role[2] = {"gear_1", "gear_2"};
  struct eo_rexs_mesh *mesh = &train->mesh[train->meshes];
  memset(mesh, 0, sizeof *mesh);
  mesh->stage = eo_rexs_find(train->model, eo_rexs_role(relation, "stage"));
  const struct eo_rexs_component *gear[2];
  for (int i = 0; i < 2; i++)
    gear[i] = eo_rexs_find(train->model, eo_rexs_role(relation, role[i]));
  if (!eo_rexs_is(mesh->stage, "cylindrical_stage") || !gear[0] || !gear[1])
    return;
  for (int i = 0; i < 2; i++)
    read_wheel(train, &mesh->wheel[i], mesh->stage, gear[i]);
  double x[3], origin[3];
  int first = mesh->wheel[0].shaft;
  eo_rexs_axis(first < 0 ? NULL : train->shaft[first], x, origin);
  for (int i = 0; i < 2; i++)
    place_wheel(&mesh->wheel[i], mesh->wheel[i].shaft < 0 ? NULL : train->shaft[mesh->wheel[i].shaft], x,
                strcmp(train->model->version, "1.0") == 0);
  find_distance(train, mesh);
  train->meshes++;
}

static bool alike(double a, double b)
{
  return (isnan(a) && isnan(b)) || fabs(a - b) <= same * fmax(1, fabs(a));
}

/* A number of the wheel's normal section as the transverse one has it. */
static double transverse(const struct eo_rexs_wheel *wheel, double normal)
{
  return normal / cos(wheel->helix * M_PI / 180);
}

static double transverse_tangent(const struct eo_rexs_wheel *wheel)
{
  return transverse(wheel, tan(wheel->pressure_angle * M_PI / 180));
}

/* Spur teeth have no hand that tells two ends from two stages; a design that the model carries does. */
static bool has_spur_ends(const struct eo_rexs_model *model)
{
  struct eo_error error;
  long long ends = 0;
  for (int i = 0; i < model->components; i++) {
    const struct eo_rexs_attribute *carried = eo_rexs_attribute(&model->component[i], "custom_easeoff_design");
    json_t *design = carried ? eo_json_parse(carried->text, strlen(carried->text), &error) : NULL;
    ends = design ? json_integer_value(json_object_get(json_object_get(design, "gear_pair"), "ends")) : ends;
    json_decref(design);
  }
  return ends == 2;
}

/* Hands opposite, all else equal but the face width and the helix: halves may be unequal, on one transverse section. */
static bool is_mirrored(const struct eo_rexs_wheel *a, const struct eo_rexs_wheel *b, bool spur)
{
  bool opposite = a->helix * b->helix < 0 || (spur && a->helix == 0 && b->helix == 0);
  bool other_hand = alike(a->teeth, b->teeth) && opposite && a->along == b->along;
  if (alike(a->helix, -b->helix))
    return other_hand && alike(a->module, b->module) && alike(a->pressure_angle, b->pressure_angle) &&
           alike(a->shift, b->shift);
  return other_hand && alike(transverse(a, a->module), transverse(b, b->module)) &&
         alike(transverse_tangent(a), transverse_tangent(b)) && alike(a->shift * a->module, b->shift * b->module);
}

static double gap_between(const struct eo_rexs_wheel *a, const struct eo_rexs_wheel *b)
{
  return a->left < b->left ? b->left - a->right : a->left - b->right;
}

/* From mid face to mid face: members of unequal width stand centred on each other. */
static double distance_between(const struct eo_rexs_wheel *a, const struct eo_rexs_wheel *b)
{
  return fabs(a->left + a->right - b->left - b->right) / 2;
}

static void swap_wheels(struct eo_rexs_mesh *mesh)
{
  struct eo_rexs_wheel first = mesh->wheel[0];
  mesh->wheel[0] = mesh->wheel[1];
  mesh->wheel[1] = first;
}

static bool are_two_ends(const struct eo_rexs_mesh *a, const struct eo_rexs_mesh *b, bool spur)
{
  struct eo_rexs_mesh other = *b;
  if (other.wheel[0].shaft != a->wheel[0].shaft)
    swap_wheels(&other);
  for (int i = 0; i < 2; i++)
    if (a->wheel[i].shaft < 0 || other.wheel[i].shaft != a->wheel[i].shaft ||
        !is_mirrored(&a->wheel[i], &other.wheel[i], spur))
      return false;
  double gap[2] = {gap_between(&a->wheel[0], &other.wheel[0]), gap_between(&a->wheel[1], &other.wheel[1])};
  double distance[2] = {distance_between(&a->wheel[0], &other.wheel[0]),
                        distance_between(&a->wheel[1], &other.wheel[1])};
  return alike(a->centre_distance, b->centre_distance) && gap[0] >= 0 && gap[1] >= 0 &&
         fabs(distance[0] - distance[1]) <= place_tolerance;
}

static void judge_pair(const struct eo_rexs_train *train, struct eo_rexs_pair *pair)
{
  const struct eo_rexs_mesh *mesh = &train->mesh[pair->mesh[0]];
  for (int i = 0; i < 2; i++) {
    const struct eo_rexs_wheel *wheel = &mesh->wheel[i];
    if (!eo_rexs_is(wheel->gear, "cylindrical_gear") || wheel->teeth < 0)
      snprintf(pair->why, sizeof pair->why, "%.40s %d is internal; Easeoff has external gears only", wheel->gear->type,
               wheel->gear->id);
  }
  if (mesh->crossed)
    snprintf(pair->why, sizeof pair->why, "the axes of the shafts are not parallel");
}

static void add_pair(struct eo_rexs_train *train, int left, int right, const char *remark)
{
  struct eo_rexs_pair *pair = &train->pair[train->pairs++];
  memset(pair, 0, sizeof *pair);
  pair->ends = right < 0 ? 1 : 2;
  pair->mesh[0] = left;
  pair->mesh[1] = right;
  snprintf(pair->remark, sizeof pair->remark, "%s", remark);
  if (right >= 0 && train->mesh[right].wheel[0].shaft != train->mesh[left].wheel[0].shaft)
    swap_wheels(&train->mesh[right]);
  if (right >= 0 && train->mesh[right].wheel[0].left < train->mesh[left].wheel[0].left) {
    pair->mesh[0] = right;
    pair->mesh[1] = left;
  }
  judge_pair(train, pair);
}

static void find_pairs(struct eo_rexs_train *train)
{
  bool spur = has_spur_ends(train->model);
  bool taken[EO_REXS_MESHES] = {false};
  for (int i = 0; i < train->meshes; i++) {
    int partner = -1, partners = 0;
    for (int k = 0; k < train->meshes; k++)
      if (k != i && are_two_ends(&train->mesh[i], &train->mesh[k], spur)) {
        partners++;
        partner = k;
      }
    if (taken[i])
      continue;
    taken[i] = true;
    if (partners == 1 && !taken[partner]) {
      taken[partner] = true;
      add_pair(train, i, partner, "");
    } else
      add_pair(train, i, -1,
               partners > 1 ? "more than two meshes could be its other end, so each is listed as a single one" : "");
  }
}

/* By is_driving_gear where exactly one says so, else by where the torque comes from, else gear_1. */
static void find_driver(const struct eo_rexs_train *train, const struct eo_rexs_flow *flow, struct eo_rexs_pair *pair)
{
  const struct eo_rexs_mesh *mesh = &train->mesh[pair->mesh[0]];
  bool drives[2];
  int reached[2];
  for (int i = 0; i < 2; i++) {
    drives[i] = eo_rexs_flag(mesh->wheel[i].data, "is_driving_gear");
    reached[i] = mesh->wheel[i].shaft < 0 ? 0 : flow->reached[mesh->wheel[i].shaft];
  }
  pair->driver_stated = drives[0] != drives[1];
  if (pair->driver_stated)
    pair->driver = drives[1];
  else if (reached[0] && reached[1]) {
    pair->driver = reached[1] < reached[0];
    pair->driver_stated = true;
  }
  const struct eo_rexs_wheel *driver = &mesh->wheel[pair->driver], *driven = &mesh->wheel[!pair->driver];
  if (!*pair->remark && driver->teeth > driven->teeth)
    snprintf(pair->remark, sizeof pair->remark,
             "step-up: the gear with %.0f teeth drives, so it is the pinion of the design", driver->teeth);
}

static bool is_coupling(const struct eo_rexs_component *component)
{
  return eo_rexs_is(component, "coupling") || eo_rexs_is(component, "switchable_coupling");
}

/* What turns shafts, and what ties them together. */
static void read_loads(struct eo_rexs_train *train)
{
  const struct eo_rexs_model *model = train->model;
  for (int i = 0; i < model->relations; i++) {
    const struct eo_rexs_relation *relation = &model->relation[i];
    const struct eo_rexs_component *assembly = eo_rexs_find(model, eo_rexs_role(relation, "assembly"));
    const struct eo_rexs_component *part = eo_rexs_find(model, eo_rexs_role(relation, "part"));
    if (strcmp(relation->type, "assembly") == 0 && eo_rexs_is(part, "external_load") && train->loads < EO_REXS_LOADS) {
      int shaft = shaft_index(train, assembly);
      if (shaft >= 0)
        train->load[train->loads++] = (struct eo_rexs_load){shaft, part};
    }
    if (strcmp(relation->type, "side") == 0 && is_coupling(assembly) && train->couplings < EO_REXS_SHAFTS) {
      int *coupling = train->coupling[train->couplings];
      coupling[0] = shaft_index(train, eo_rexs_find(model, eo_rexs_role(relation, "inner_part")));
      coupling[1] = shaft_index(train, eo_rexs_find(model, eo_rexs_role(relation, "outer_part")));
      train->couplings += coupling[0] >= 0 && coupling[1] >= 0;
    }
  }
}

bool eo_rexs_train_find(struct eo_rexs_train *train, const struct eo_rexs_model *model, struct eo_error *error)
{
  static const char text[] = "The model has more than %d %s; split it.";
  memset(train, 0, sizeof *train);
  train->model = model;
  for (int i = 0; i < model->components; i++) {
    if (!eo_rexs_is(&model->component[i], "shaft"))
      continue;
    if (train->shafts == EO_REXS_SHAFTS) {
      eo_error_set(error, EO_ERROR_INPUT, "", text, EO_REXS_SHAFTS, "shafts");
      return false;
    }
    train->shaft[train->shafts++] = &model->component[i];
  }
  for (int i = 0; i < model->relations; i++) {
    if (strcmp(model->relation[i].type, "stage") != 0)
      continue;
    if (train->meshes == EO_REXS_MESHES) {
      eo_error_set(error, EO_ERROR_INPUT, "", text, EO_REXS_MESHES, "stages");
      return false;
    }
    read_mesh(train, &model->relation[i]);
  }
  read_loads(train);
  find_pairs(train);
  struct eo_rexs_flow flow;
  eo_rexs_flow_find(train, model->load_cases ? 0 : -1, &flow);
  for (int i = 0; i < train->pairs; i++)
    find_driver(train, &flow, &train->pair[i]);
  return true;
}

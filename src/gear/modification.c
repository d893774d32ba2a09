/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/modification.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Numbers that may be left out: not above 0 stands for the one that is meant. */
static bool same_stated(int count, const double *a, const double *b, double meant)
{
  for (int i = 0; i < count; i++)
    if ((a[i] > 0 ? a[i] : meant) != (b[i] > 0 ? b[i] : meant))
      return false;
  return true;
}

static bool same_places(const struct eo_relief_place *a, const struct eo_relief_place *b)
{
  return same_stated(1, &a->diameter, &b->diameter, 0) && same_stated(1, &a->roll_length, &b->roll_length, 0) &&
         same_stated(1, &a->roll_angle, &b->roll_angle, 0) && same_stated(1, &a->length, &b->length, 0);
}

static bool same_triangles(const struct eo_flank_modification *a, const struct eo_flank_modification *b)
{
  for (int i = 0; i < 4; i++) {
    const struct eo_triangular_relief *x = &a->triangular[i / 2][i % 2], *y = &b->triangular[i / 2][i % 2];
    if (x->amount != y->amount || x->profile_length != y->profile_length || x->face_length != y->face_length ||
        !same_stated(1, &x->exponent, &y->exponent, 1))
      return false;
  }
  return true;
}

static bool same_nodes(const struct eo_flank_modification *a, const struct eo_flank_modification *b)
{
  bool same = a->nodes == b->nodes;
  for (int i = 0; i < a->nodes && same; i++)
    same = a->node[i].row == b->node[i].row && a->node[i].column == b->node[i].column &&
           a->node[i].delta == b->node[i].delta;
  return same;
}

static int find_node(const struct eo_flank_modification *flank, int row, int column)
{
  int i = 0;
  while (i < flank->nodes && (flank->node[i].row != row || flank->node[i].column != column))
    i++;
  return i;
}

bool eo_modification_set_node(struct eo_flank_modification *flank, int row, int column, double delta)
{
  int i = find_node(flank, row, column);
  if (i == EO_MOST_GRID_NODES)
    return false;
  flank->nodes += i == flank->nodes;
  flank->node[i] = (struct eo_grid_node){row, column, delta};
  return true;
}

const double *eo_modification_node(const struct eo_flank_modification *flank, int row, int column)
{
  int i = find_node(flank, row, column);
  return i < flank->nodes ? &flank->node[i].delta : NULL;
}

void eo_modification_drop_node(struct eo_flank_modification *flank, int row, int column)
{
  int i = find_node(flank, row, column);
  if (i == flank->nodes)
    return;
  flank->nodes--;
  memmove(&flank->node[i], &flank->node[i + 1], sizeof flank->node[0] * (size_t)(flank->nodes - i));
  memset(&flank->node[flank->nodes], 0, sizeof flank->node[0]);
}

static const struct eo_flank_modification *flank_at(const struct eo_modification *modification, int i)
{
  return i < 4 ? &modification->flank[i / 2][i % 2] : &modification->coast[i / 2 % 2][i % 2];
}

bool eo_modification_has_nodes(const struct eo_modification *modification)
{
  bool has = false;
  for (int i = 0; i < 8; i++)
    has = has || flank_at(modification, i)->nodes > 0;
  return has;
}

bool eo_modification_lay_nodes(const struct eo_modification *modification, struct eo_flank_grids *grids)
{
  for (int i = 0; i < 8; i++) {
    const struct eo_flank_modification *flank = flank_at(modification, i);
    const struct eo_grid_place *place = &grids->place[i / 4][i / 2 % 2][i % 2];
    eo_grid_nodes_lay(flank->nodes, flank->node, place->u_knots, place->y_knots,
                      grids->number + place->first + place->u_knots + place->y_knots);
  }
  return eo_modification_has_nodes(modification);
}

bool eo_modification_equal(const struct eo_flank_modification *a, const struct eo_flank_modification *b)
{
  /* from the tip relief to the exponents there are doubles only: no padding */
  size_t from = offsetof(struct eo_flank_modification, tip_relief),
         to = offsetof(struct eo_flank_modification, end_exponent);
  return a->shape == b->shape && memcmp(a->own_shape, b->own_shape, sizeof a->own_shape) == 0 &&
         memcmp(a->end_shape, b->end_shape, sizeof a->end_shape) == 0 &&
         memcmp((const char *)a + from, (const char *)b + from, to - from) == 0 &&
         same_stated(2, a->end_exponent, b->end_exponent, 2) && same_stated(2, a->exponent, b->exponent, 2) &&
         same_places(&a->place[0], &b->place[0]) && same_places(&a->place[1], &b->place[1]) && same_triangles(a, b) &&
         same_nodes(a, b);
}

bool eo_modification_is_none(const struct eo_flank_modification *modification)
{
  bool none = modification->tip_relief == 0 && modification->root_relief == 0 && modification->profile_crowning == 0 &&
              modification->lead_crowning == 0 && modification->helix_slope == 0 && modification->lead_offset == 0 &&
              modification->end_relief[0] == 0 && modification->end_relief[1] == 0 &&
              modification->profile_slope == 0 && modification->profile_barrel == 0 && modification->twist == 0;
  none = none && modification->nodes == 0 && modification->grid_gain == 0;
  for (int i = 0; i < 4 && none; i++)
    none = modification->triangular[i / 2][i % 2].amount == 0;
  return none;
}

double eo_modification_lead_coefficient(const struct eo_geometry *geometry, double crowning)
{
  double half = geometry->face_width / 2 / cos(geometry->helix_angle);
  return crowning / (half * half);
}

void eo_active_profile(const struct eo_geometry *geometry, int member, double end[2])
{
  double bottom = geometry->rack_bottom - geometry->rack_factor * geometry->moved[EO_GEAR],
         top = geometry->rack_top + geometry->rack_factor * geometry->moved[EO_PINION];
  end[EO_ROOT_SIDE] = member == EO_PINION ? bottom : -top;
  end[EO_TIP_SIDE] = member == EO_PINION ? top : -bottom;
}

/* T C of a member as its flanks are drawn. */
static double drawn_tangent(const struct eo_geometry *geometry, int member)
{
  return geometry->tangent_length[member] - geometry->moved[member];
}

/* u = k_u sigma; roll length L = T C + sigma, radius^2 = r_b^2 + L^2. */
struct eo_profile_place eo_profile_place_at(const struct eo_geometry *geometry, int member, double u)
{
  double sigma = u / geometry->rack_factor, roll = drawn_tangent(geometry, member) + sigma,
         base = geometry->base_radius[member], end[2];
  eo_active_profile(geometry, member, end);
  return (struct eo_profile_place){
      .rack = u,
      .diameter = 2 * hypot(base, roll),
      .roll_length = roll,
      .roll_angle = roll / base,
      .length = {sigma - end[EO_ROOT_SIDE] / geometry->rack_factor, end[EO_TIP_SIDE] / geometry->rack_factor - sigma}};
}

int eo_relief_places_stated(const struct eo_relief_place *place)
{
  return (place->diameter > 0) + (place->roll_length > 0) + (place->roll_angle > 0) + (place->length > 0);
}

double eo_relief_start_at(const struct eo_geometry *geometry, int member, const struct eo_flank_modification *flank,
                          int side)
{
  const struct eo_relief_place *place = &flank->place[side];
  double roll, end[2], base = geometry->base_radius[member];
  if (eo_relief_places_stated(place) == 0)
    return side == EO_TIP_SIDE ? flank->tip_relief_start : -flank->root_relief_start;
  if (place->length > 0) {
    eo_active_profile(geometry, member, end);
    return end[side] + (side == EO_TIP_SIDE ? -1 : 1) * geometry->rack_factor * place->length;
  }
  roll = place->roll_length > 0  ? place->roll_length
         : place->roll_angle > 0 ? place->roll_angle * base
                                 : sqrt(place->diameter * place->diameter / 4 - base * base);
  return geometry->rack_factor * (roll - drawn_tangent(geometry, member));
}

static struct eo_relief relief(double start, double end, double amount, double crowning)
{
  struct eo_relief this_relief = {.start = start, .length = fmax(0, end - start)};
  this_relief.value = crowning * start * start;
  this_relief.slope = 2 * crowning * start;
  this_relief.depth = amount - this_relief.value - this_relief.slope * this_relief.length;
  if (amount == 0) /* no relief on this side: the crowning goes on */
    this_relief.length = 0;
  return this_relief;
}

static void init_reliefs(struct eo_modification_shape *shape, const struct eo_geometry *geometry, int member,
                         const struct eo_flank_modification *flank, const double end[2])
{
  for (int side = 0; side < 2; side++) {
    int outwards = side == EO_TIP_SIDE ? 1 : -1, own = flank->own_shape[side];
    double amount = side == EO_TIP_SIDE ? flank->tip_relief : flank->root_relief;
    double start = outwards * eo_relief_start_at(geometry, member, flank, side);
    shape->side[side] = relief(start, outwards * end[side], amount, flank->profile_crowning);
    shape->side[side].shape = own == EO_RELIEF_AS_SHARED ? flank->shape : (enum eo_relief_shape)(own - 1);
    shape->side[side].exponent = flank->exponent[side] > 0 ? flank->exponent[side] : 2;
  }
}

static void init_lead(struct eo_modification_shape *shape, const struct eo_geometry *geometry,
                      const struct eo_flank_modification *flank)
{
  shape->lead[0] = flank->lead_offset;
  shape->lead[1] = flank->helix_slope / 2 / shape->half_width;
  shape->lead[2] = eo_modification_lead_coefficient(geometry, flank->lead_crowning);
  for (int i = 0; i < 2; i++)
    shape->end[i] =
        (struct eo_end_relief){.shape = flank->end_shape[i],
                               .exponent = flank->end_exponent[i] > 0 ? flank->end_exponent[i] : 2,
                               .amount = flank->end_relief[i],
                               .start = shape->half_width - flank->end_relief_length[i] / cos(geometry->helix_angle)};
}

void eo_modification_init(struct eo_modification_shape *shape, const struct eo_geometry *geometry, int member,
                          const struct eo_flank_modification *flank)
{
  double end[2];
  eo_active_profile(geometry, member, end);
  *shape = (struct eo_modification_shape){.crowning = flank->profile_crowning,
                                          .half_width = geometry->face_width / 2 / cos(geometry->helix_angle),
                                          .lengthen = 1 / cos(geometry->helix_angle),
                                          .middle = (end[0] + end[1]) / 2,
                                          .half_profile = (end[1] - end[0]) / 2};
  double half = shape->half_profile;
  init_reliefs(shape, geometry, member, flank, end);
  init_lead(shape, geometry, flank);
  shape->incline = flank->profile_slope / 2 / half;
  shape->barrel = flank->profile_barrel / (half * half);
  shape->grid_share = 1 + flank->grid_gain;
  shape->twist = flank->twist / 4 / (half * geometry->face_width / 2);
  memcpy(shape->triangular, flank->triangular, sizeof shape->triangular);
  shape->varies = shape->twist != 0;
  for (int i = 0; i < 4; i++)
    shape->varies = shape->varies || flank->triangular[i / 2][i % 2].amount != 0;
  shape->has_terms = shape->incline != 0 || shape->barrel != 0;
  if (shape->varies)
    eo_modification_slice(shape, 0, shape);
}

void eo_modification_complete(struct eo_modification_shape *shape, const struct eo_flank_spline *grid, bool mirrored)
{
  shape->grid = grid;
  shape->mirrored = mirrored;
  shape->varies = shape->varies || grid;
  shape->has_terms = shape->has_terms || grid;
}

void eo_modification_move(struct eo_modification_shape *shape, const struct eo_geometry *geometry, int member)
{
  shape->moved = geometry->rack_factor * geometry->moved[member];
}

/* The line along which the plane of a triangular relief cuts the slice at distance q from the face end: at the
   profile's end 1 - q/L_y of it is left, and it starts L_u times that before. Beyond L_y that is less than nothing, and
   the plane starts as far behind the profile's end: a tip that goes on there, and the margin that slices have, meet it
   still. */
static void cut_triangles(struct eo_modification_shape *slice, double y)
{
  double half_face = slice->half_width / slice->lengthen;
  slice->wedges = 0;
  for (int side = 0; side < 2; side++)
    for (int face = 0; face < 2; face++) {
      const struct eo_triangular_relief *triangular_relief = &slice->triangular[side][face];
      int outwards = side == EO_TIP_SIDE ? 1 : -1, towards = face == EO_LEADING_SIDE ? 1 : -1;
      double left = 1 - (half_face - towards * y) / triangular_relief->face_length;
      double end = outwards * slice->middle + slice->half_profile;
      if (triangular_relief->amount != 0)
        slice->wedge[slice->wedges++] =
            (struct eo_wedge){.start = end - triangular_relief->profile_length * left,
                              .length = outwards * triangular_relief->profile_length,
                              .amount = triangular_relief->amount,
                              .exponent = triangular_relief->exponent > 0 ? triangular_relief->exponent : 1,
                              .rate = -towards * triangular_relief->profile_length / triangular_relief->face_length};
    }
}

void eo_modification_slice(const struct eo_modification_shape *shape, double eta, struct eo_modification_shape *slice)
{
  double y = shape->mirrored ? -eta : eta;
  if (slice != shape)
    *slice = *shape;
  slice->incline += shape->twist * (y - slice->y);
  slice->y = y;
  cut_triangles(slice, y);
  slice->has_terms = slice->has_terms || slice->incline != 0 || slice->wedges > 0 || slice->grid;
}

/* Relief at distance t >= 0 beyond its vertex; *slope along t. */
static double relief_value(const struct eo_relief *this_relief, double t, double *slope)
{
  double tangent = this_relief->value + this_relief->slope * t, ratio = t / this_relief->length;
  switch (this_relief->shape) {
  case EO_RELIEF_LINEAR:
    *slope = this_relief->slope + this_relief->depth / this_relief->length;
    return tangent + this_relief->depth * t / this_relief->length;
  case EO_RELIEF_CIRCULAR: {
    double depth = fabs(this_relief->depth), sign = this_relief->depth < 0 ? -1 : 1;
    if (depth == 0)
      break;
    /* theory (F3) */
    double radius = (this_relief->length * this_relief->length + depth * depth) / (2 * depth),
           root = sqrt(fmax(radius * radius - t * t, 1e-6 * radius * radius));
    *slope = this_relief->slope + sign * t / root;
    return tangent + sign * t * t / (radius + root);
  }
  case EO_RELIEF_EXPONENT:
    *slope = this_relief->slope +
             this_relief->exponent * this_relief->depth * pow(ratio, this_relief->exponent - 1) / this_relief->length;
    return tangent + this_relief->depth * pow(ratio, this_relief->exponent);
  case EO_RELIEF_PARABOLIC:
    break;
  }
  *slope = this_relief->slope + 2 * this_relief->depth * ratio / this_relief->length;
  return tangent + this_relief->depth * ratio * ratio; /* theory (F2) */
}

/* Reliefs and crowning: the parabola between the vertices. */
static double relieved_profile(const struct eo_modification_shape *shape, double u, double slope[2])
{
  double middle = 2 * shape->crowning * u, unused;
  const struct eo_relief *root = &shape->side[EO_ROOT_SIDE], *tip = &shape->side[EO_TIP_SIDE];
  int on_tip = u >= 0;
  if (tip->length > 0 && tip->start < 0) /* a relief may begin beyond the pitch point */
    on_tip = u >= tip->start;
  else if (root->length > 0 && root->start < 0)
    on_tip = -u < root->start;
  int direction = on_tip ? 1 : -1;
  const struct eo_relief *this_relief = &shape->side[on_tip];
  double beyond = direction * u - this_relief->start;
  if (this_relief->length == 0 || beyond < 0) {
    slope[0] = slope[1] = middle;
    return shape->crowning * u * u; /* theory (F1) */
  }
  double outer, value = relief_value(this_relief, beyond, &outer);
  slope[0] = slope[1] = direction * outer;
  if (beyond == 0) { /* at the vertex: the inner side belongs to the middle parabola */
    slope[on_tip ? 0 : 1] = middle;
    const struct eo_relief *other = &shape->side[1 - on_tip];
    if (other->length > 0 && other->start == -this_relief->start) {
      relief_value(other, 0, &unused);
      slope[on_tip ? 0 : 1] = -direction * unused;
    }
  }
  return value;
}

static double wedge_value(const struct eo_wedge *wedge, double u, double slope[2])
{
  int direction = wedge->length > 0 ? 1 : -1;
  double length = fabs(wedge->length), beyond = direction * u - wedge->start, ratio = beyond / length;
  if (beyond < 0 || (beyond == 0 && wedge->exponent != 1))
    return 0;
  double rate = direction * wedge->amount / length * wedge->exponent *
                (beyond > 0 ? pow(ratio, wedge->exponent - 1) : 1);
  if (beyond > 0 || direction < 0)
    slope[0] += rate;
  if (beyond > 0 || direction > 0)
    slope[1] += rate;
  return beyond > 0 ? wedge->amount * pow(ratio, wedge->exponent) : 0;
}

double eo_modification_profile(const struct eo_modification_shape *shape, double u, double slope[2])
{
  u += shape->moved;
  double value = relieved_profile(shape, u, slope);
  if (!shape->has_terms)
    return value;
  double from_middle = u - shape->middle, rate = shape->incline + 2 * shape->barrel * from_middle, by_u[2];
  value += from_middle * (shape->incline + shape->barrel * from_middle); /* theory (F5) */
  slope[0] += rate;
  slope[1] += rate;
  for (int i = 0; i < shape->wedges; i++)
    value += wedge_value(&shape->wedge[i], u, slope);
  if (shape->grid) {
    value += shape->grid_share * eo_flank_spline_at(shape->grid, u, shape->y, by_u);
    slope[0] += shape->grid_share * by_u[0];
    slope[1] += shape->grid_share * by_u[1];
  }
  return value;
}

static double wedge_across(const struct eo_wedge *wedge, double u)
{
  double length = fabs(wedge->length), beyond = (wedge->length > 0 ? u : -u) - wedge->start,
         rate = -wedge->rate * wedge->amount / length * wedge->exponent;
  if (beyond == 0)
    return wedge->exponent == 1 ? rate / 2 : 0;
  return beyond > 0 ? rate * pow(beyond / length, wedge->exponent - 1) : 0;
}

double eo_modification_across(const struct eo_modification_shape *slice, double u)
{
  u += slice->moved;
  double rate = slice->twist * (u - slice->middle);
  for (int i = 0; i < slice->wedges; i++)
    rate += wedge_across(&slice->wedge[i], u);
  return slice->grid ? rate + slice->grid_share * eo_flank_spline_across(slice->grid, u, slice->y) : rate;
}

bool eo_modification_has_profile(const struct eo_modification_shape *slice)
{
  return slice->crowning != 0 || slice->side[0].length > 0 || slice->side[1].length > 0 || slice->has_terms;
}

static int add_vertex(double vertex[EO_MOST_VERTICES], int count, double u)
{
  int at = count;
  while (at > 0 && vertex[at - 1] >= u) {
    if (vertex[at - 1] == u)
      return count;
    at--;
  }
  if (count == EO_MOST_VERTICES)
    return count;
  memmove(vertex + at + 1, vertex + at, sizeof *vertex * (size_t)(count - at));
  vertex[at] = u;
  return count + 1;
}

int eo_modification_vertices(const struct eo_modification_shape *slice, double vertex[EO_MOST_VERTICES])
{
  int count = 0;
  for (int side = 0; side < 2; side++)
    if (slice->side[side].length > 0)
      count = add_vertex(vertex, count, (side ? 1 : -1) * slice->side[side].start);
  for (int i = 0; i < slice->wedges; i++)
    count = add_vertex(vertex, count, (slice->wedge[i].length > 0 ? 1 : -1) * slice->wedge[i].start);
  for (int border = 0; slice->grid && border < 2; border++)
    count = add_vertex(vertex, count, slice->grid->u[border * (slice->grid->u_knots - 1)]);
  for (int i = 0; i < count; i++)
    vertex[i] -= slice->moved;
  return count;
}

/* End relief at the part t > 0 of its length; *slope by t. The arc is tangent where it starts. */
static double end_relief_value(const struct eo_end_relief *relief, double length, double t, double *slope)
{
  double depth = fabs(relief->amount), sign = relief->amount < 0 ? -1 : 1;
  switch (relief->shape) {
  case EO_RELIEF_LINEAR:
    *slope = relief->amount;
    return relief->amount * t;
  case EO_RELIEF_EXPONENT:
    *slope = relief->amount * relief->exponent * pow(t, relief->exponent - 1);
    return relief->amount * pow(t, relief->exponent);
  case EO_RELIEF_CIRCULAR: {
    double radius = (length * length + depth * depth) / (2 * depth), at = t * length,
           root = sqrt(fmax(radius * radius - at * at, 1e-6 * radius * radius));
    *slope = sign * at / root * length;
    return sign * at * at / (radius + root);
  }
  case EO_RELIEF_PARABOLIC:
    break;
  }
  *slope = 2 * relief->amount * t;
  return relief->amount * t * t;
}

double eo_modification_lead(const struct eo_modification_shape *shape, double x, double *slope)
{
  double place = shape->mirrored ? -x : x;
  int side = place > 0;
  const struct eo_end_relief *end = &shape->end[side];
  double value = shape->lead[0] + place * (shape->lead[1] + place * shape->lead[2]); /* theory (F4) */
  double derivative = shape->lead[1] + 2 * place * shape->lead[2];
  double beyond = fabs(place) - end->start, length = shape->half_width - end->start;
  if (end->amount != 0 && beyond > 0 && length > 0) {
    double rate;
    value += end_relief_value(end, length, beyond / length, &rate);
    derivative += (side ? 1 : -1) * rate / length;
  }
  *slope = shape->mirrored ? -derivative : derivative;
  return value;
}

double eo_modification_at(const struct eo_modification_shape *shape, double u, double eta)
{
  struct eo_modification_shape slice;
  double unused, slopes[2], lead = eo_modification_lead(shape, eta * shape->lengthen, &unused);
  if (!shape->varies)
    return lead + eo_modification_profile(shape, u, slopes);
  eo_modification_slice(shape, eta, &slice);
  return lead + eo_modification_profile(&slice, u, slopes);
}

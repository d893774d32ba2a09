/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/export.h"

#include <math.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

struct output {
  const struct eo_sector *sector;
  eo_writer_function *writer;
  void *context;
  int stopped;
  int teeth; /* of a ring; 1: a sector */
  int edges; /* of the section */
  int *edge; /* [quads][4]: number of the edge from corner k to corner k + 1 */
  int *ends; /* [edges][2] */
  /* The right cut of a ring's tooth is the left cut of the next one. */
  int own_nodes, own_edges; /* of a tooth */
  int *node_place;          /* [nodes]: number among the tooth's own, or -1 - node of the left cut */
  int *edge_place;          /* [edges]: likewise */
  bool floating;
  double *weight; /* [cut_nodes][layers + 1], m3: see eo_member_cut_weights() */
};

__attribute__((format(printf, 2, 3))) static void put(struct output *out, const char *format, ...)
{
  char line[400];
  va_list arguments;
  if (out->stopped)
    return;
  va_start(arguments, format);
  int length = vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out->stopped = out->writer(out->context, line, (size_t)length);
}

/* Numbers: corners tooth by tooth and layer by layer, then the middles of the section's edges likewise, then the
   middles between layers. */
static int corner_number(const struct output *out, int tooth, int layer, int node)
{
  int place = out->node_place[node];
  if (place < 0)
    return corner_number(out, (tooth + 1) % out->teeth, layer, -1 - place);
  return (tooth * (out->sector->layers + 1) + layer) * out->own_nodes + place + 1;
}

static int edge_number(const struct output *out, int tooth, int layer, int edge)
{
  int place = out->edge_place[edge], layers = out->sector->layers + 1;
  if (place < 0)
    return edge_number(out, (tooth + 1) % out->teeth, layer, -1 - place);
  return out->teeth * layers * out->own_nodes + (tooth * layers + layer) * out->own_edges + place + 1;
}

static int upright_number(const struct output *out, int tooth, int layer, int node)
{
  int place = out->node_place[node], layers = out->sector->layers + 1;
  if (place < 0)
    return upright_number(out, (tooth + 1) % out->teeth, layer, -1 - place);
  return out->teeth * layers * (out->own_nodes + out->own_edges) +
         (tooth * out->sector->layers + layer) * out->own_nodes + place + 1;
}

/* Position of a node of a tooth; teeth are counted clockwise. */
static void place_node(const struct output *out, int tooth, int layer, int node, double p[3])
{
  double angle = 2 * M_PI * tooth / out->teeth, c = cos(angle), s = sin(angle);
  eo_sector_position(out->sector, node, layer, p);
  double x = p[0];
  p[0] = c * x + s * p[1];
  p[1] = c * p[1] - s * x;
}

static void put_node(struct output *out, int number, const double p[3])
{
  put(out, "%d, %.12e, %.12e, %.12e\n", number, p[0], p[1], p[2]);
}

/* In the middle between two nodes, so that both elements fill the same body. */
static void put_middle(struct output *out, int number, int tooth, int node, int layer, int other, int other_layer)
{
  double p[3], q[3];
  place_node(out, tooth, layer, node, p);
  place_node(out, tooth, other_layer, other, q);
  for (int c = 0; c < 3; c++)
    p[c] = 0.5 * (p[c] + q[c]);
  put_node(out, number, p);
}

static void put_corners(struct output *out, int tooth)
{
  for (int l = 0; l <= out->sector->layers; l++)
    for (int a = 0; a < out->sector->section->nodes; a++) {
      double p[3];
      if (out->node_place[a] < 0)
        continue;
      place_node(out, tooth, l, a, p);
      put_node(out, corner_number(out, tooth, l, a), p);
    }
}

static void put_middles(struct output *out, int tooth)
{
  int layers = out->sector->layers, nodes = out->sector->section->nodes;
  for (int l = 0; l <= layers; l++) {
    for (int e = 0; e < out->edges; e++)
      if (out->edge_place[e] >= 0)
        put_middle(out, edge_number(out, tooth, l, e), tooth, out->ends[2 * e], l, out->ends[2 * e + 1], l);
    for (int a = 0; a < nodes && l < layers; a++)
      if (out->node_place[a] >= 0)
        put_middle(out, upright_number(out, tooth, l, a), tooth, a, l, a, l + 1);
  }
}

static void put_nodes(struct output *out, enum eo_mesh_element element)
{
  put(out, "*NODE, NSET=ALL\n");
  for (int t = 0; t < out->teeth; t++)
    put_corners(out, t);
  for (int t = 0; t < out->teeth && element == EO_MESH_C3D20R; t++)
    put_middles(out, t);
}

static void put_element(struct output *out, enum eo_mesh_element element, int number, int tooth, int l, int q)
{
  const struct eo_section *section = out->sector->section;
  put(out, "%d", number);
  for (int k = 0; k < 8; k++)
    put(out, ", %d", corner_number(out, tooth, l + k / 4, section->quad[4 * q + k % 4]));
  for (int k = 0; k < 8 && element == EO_MESH_C3D20R; k++)
    put(out, "%s%d", k == 2 ? ",\n" : ", ", edge_number(out, tooth, l + k / 4, out->edge[4 * q + k % 4]));
  for (int k = 0; k < 4 && element == EO_MESH_C3D20R; k++)
    put(out, ", %d", upright_number(out, tooth, l, section->quad[4 * q + k]));
  put(out, "\n");
}

static void put_elements(struct output *out, enum eo_mesh_element element)
{
  int number = 1;
  put(out, "*ELEMENT, TYPE=%s, ELSET=SECTOR\n", element == EO_MESH_C3D8I ? "C3D8I" : "C3D20R");
  for (int t = 0; t < out->teeth; t++)
    for (int l = 0; l < out->sector->layers; l++)
      for (int q = 0; q < out->sector->section->quads; q++, number++)
        put_element(out, element, number, t, l, q);
}

/* An edge's middle is fixed when both ends are: the fixed surfaces meet no free edge. */
static void put_fixed(struct output *out, enum eo_mesh_element element, int tooth)
{
  const struct eo_section *section = out->sector->section;
  unsigned char held = out->floating ? EO_HELD_AXIAL : EO_HELD_ALL;
  for (int l = 0; l <= out->sector->layers; l++) {
    for (int a = 0; a < section->nodes; a++)
      if (section->fixed[a] == held && out->node_place[a] >= 0)
        put(out, "%d,\n", corner_number(out, tooth, l, a));
    for (int e = 0; e < out->edges && element == EO_MESH_C3D20R; e++)
      if (section->fixed[out->ends[2 * e]] && section->fixed[out->ends[2 * e + 1]] && out->edge_place[e] >= 0)
        put(out, "%d,\n", edge_number(out, tooth, l, e));
    for (int a = 0; a < section->nodes && element == EO_MESH_C3D20R && l < out->sector->layers; a++)
      if (section->fixed[a] == held && out->node_place[a] >= 0)
        put(out, "%d,\n", upright_number(out, tooth, l, a));
  }
}

/* Calls for every node of every cut. */
typedef void cut_function(struct output *out, int number, const double p[3], double weight, void *context);
static void each_cut_node(struct output *out, cut_function *call, void *context)
{
  const struct eo_section *section = out->sector->section;
  int across = out->sector->layers + 1;
  for (int t = 0; t < out->teeth; t++)
    for (int i = 0; i < section->cut_nodes; i++)
      for (int l = 0; l < across; l++) {
        double p[3];
        place_node(out, t, l, section->cut[0][i], p);
        call(out, corner_number(out, t, l, section->cut[0][i]), p, out->weight[i * across + l], context);
      }
}

/* Force and moment in the plane, mass and its moment of inertia about the axis. */
struct balance {
  double force[2], moment, mass, inertia;
};

static void add_mass(struct output *out, int number, const double p[3], double weight, void *context)
{
  struct balance *balance = context;
  (void)out;
  (void)number;
  balance->mass += weight;
  balance->inertia += weight * (p[0] * p[0] + p[1] * p[1]);
}

static void put_balance(struct output *out, int number, const double p[3], double weight, void *context)
{
  const struct balance *balance = context;
  double turn = balance->moment / balance->inertia;
  put(out, "%d, 1, %.12e\n%d, 2, %.12e\n", number, -weight * (balance->force[0] / balance->mass - turn * p[1]), number,
      -weight * (balance->force[1] / balance->mass + turn * p[0]));
}

/* Forces in proportion to mass against what the loads pull in the plane. */
static void put_balances(struct output *out, const struct eo_mesh_case *load_case)
{
  struct balance balance = {0};
  for (int i = 0; i < load_case->loads; i++) {
    const struct eo_mesh_load *load = &load_case->load[i];
    int node = out->sector->section->flank.node[load->row];
    double normal[3], p[3];
    eo_sector_direction(out->sector, node, load->layer, 0, normal);
    eo_sector_position(out->sector, node, load->layer, p);
    balance.force[0] += load->force * normal[0];
    balance.force[1] += load->force * normal[1];
    balance.moment += load->force * (p[0] * normal[1] - p[1] * normal[0]);
  }
  each_cut_node(out, add_mass, &balance);
  each_cut_node(out, put_balance, &balance);
}

static void put_number(struct output *out, int number, const double p[3], double weight, void *context)
{
  (void)p;
  (void)weight;
  (void)context;
  put(out, "%d,\n", number);
}

/* Two nodes of the innermost ring, half a turn apart, hold what the balanced body does not pull at: the first both
   ways, the second across the line between them. */
static void put_pins(struct output *out)
{
  const struct eo_section *section = out->sector->section;
  int node = section->cut[0][section->cut_nodes - 1], other = out->teeth / 2;
  double p[3], q[3];
  place_node(out, 0, 0, node, p);
  place_node(out, other, 0, node, q);
  int across = fabs(q[0] - p[0]) > fabs(q[1] - p[1]) ? 2 : 1;
  put(out, "*BOUNDARY\nAXIAL, 3, 3, 0\n%d, 1, 2, 0\n%d, %d, %d, 0\n", corner_number(out, 0, 0, node),
      corner_number(out, other, 0, node), across, across);
}

static void put_step(struct output *out, const struct eo_mesh_case *load_case)
{
  const struct eo_flank_nodes *flank = &out->sector->section->flank;
  put(out, "*STEP\n*STATIC\n*CLOAD, OP=NEW\n");
  for (int i = 0; i < load_case->loads; i++) {
    const struct eo_mesh_load *load = &load_case->load[i];
    double normal[3];
    eo_sector_direction(out->sector, flank->node[load->row], load->layer, 0, normal);
    for (int c = 0; c < 3; c++)
      put(out, "%d, %d, %.12e\n", corner_number(out, 0, load->layer, flank->node[load->row]), c + 1,
          load->force * normal[c]);
  }
  if (out->floating)
    put_balances(out, load_case);
  put(out, "*NODE PRINT, NSET=FLANK\nU\n%s*END STEP\n", out->floating ? "*NODE PRINT, NSET=CUTS\nU\n" : "");
}

static void put_model(struct output *out, const struct eo_material *material, enum eo_mesh_element element, int cases,
                      const struct eo_mesh_case *load_case)
{
  const struct eo_flank_nodes *flank = &out->sector->section->flank;
  put(out, out->teeth > 1 ? "*HEADING\nall teeth of a gear, loaded flank of the first\n"
                          : "*HEADING\nsector of a gear, loaded flank of the middle tooth\n");
  put_nodes(out, element);
  put_elements(out, element);
  put(out, "*NSET, NSET=%s\n", out->floating ? "AXIAL" : "FIXED");
  for (int t = 0; t < out->teeth; t++)
    put_fixed(out, element, t);
  if (out->floating) {
    put(out, "*NSET, NSET=CUTS, UNSORTED\n");
    each_cut_node(out, put_number, NULL);
  }
  put(out, "*NSET, NSET=FLANK, UNSORTED\n");
  for (int row = 0; row < flank->count; row++)
    for (int l = 0; l <= out->sector->layers; l++)
      put(out, "%d,\n", corner_number(out, 0, l, flank->node[row]));
  put(out, "*MATERIAL, NAME=STEEL\n*ELASTIC\n%.12e, %.12e\n*SOLID SECTION, ELSET=SECTOR, MATERIAL=STEEL\n",
      material->youngs_modulus, material->poissons_ratio);
  if (out->floating)
    put_pins(out);
  else
    put(out, "*BOUNDARY\nFIXED, 1, 3, 0\n");
  for (int i = 0; i < cases; i++)
    put_step(out, &load_case[i]);
}

/* Numbers the section's edges; each is met by at most two quadrilaterals. */
static enum eo_code find_edges(struct output *out, const struct eo_section *section)
{
  int *first = malloc((size_t)section->nodes * sizeof *first),
      *next = malloc((size_t)(4 * section->quads) * sizeof *next);
  out->edge = malloc((size_t)(4 * section->quads) * sizeof *out->edge);
  out->ends = malloc((size_t)(8 * section->quads) * sizeof *out->ends);
  enum eo_code code = first && next && out->edge && out->ends ? EO_OK : EO_ERROR_MEMORY;
  for (int a = 0; a < section->nodes && !code; a++)
    first[a] = -1;
  for (int i = 0; i < 4 * section->quads && !code; i++) {
    int a = section->quad[i], b = section->quad[i % 4 == 3 ? i - 3 : i + 1], low = a < b ? a : b, high = a < b ? b : a,
        e = first[low];
    while (e >= 0 && out->ends[2 * e + 1] != high)
      e = next[e];
    if (e < 0) {
      e = out->edges++;
      out->ends[2 * e] = low;
      out->ends[2 * e + 1] = high;
      next[e] = first[low];
      first[low] = e;
    }
    out->edge[i] = e;
  }
  free(first);
  free(next);
  return code;
}

/* Node of the left cut that is the same as this one of the right cut in the next tooth; -1: not on the right cut. */
static int left_of(const struct eo_section *section, int node)
{
  for (int i = 0; i < section->cut_nodes; i++)
    if (section->cut[1][i] == node)
      return section->cut[0][i];
  return -1;
}

static int find_edge(const struct output *out, int a, int b)
{
  int e = 0;
  while (e < out->edges - 1 && !((out->ends[2 * e] == a && out->ends[2 * e + 1] == b) ||
                                 (out->ends[2 * e] == b && out->ends[2 * e + 1] == a)))
    e++;
  return e;
}

static enum eo_code number_own(struct output *out, const struct eo_section *section)
{
  out->node_place = malloc((size_t)section->nodes * sizeof *out->node_place);
  out->edge_place = malloc((size_t)out->edges * sizeof *out->edge_place);
  if (!out->node_place || !out->edge_place)
    return EO_ERROR_MEMORY;
  for (int a = 0; a < section->nodes; a++) {
    int left = left_of(section, a);
    out->node_place[a] = left < 0 ? out->own_nodes++ : -1 - left;
  }
  for (int e = 0; e < out->edges; e++) {
    int a = left_of(section, out->ends[2 * e]), b = left_of(section, out->ends[2 * e + 1]);
    out->edge_place[e] = a < 0 || b < 0 ? out->own_edges++ : -1 - find_edge(out, a, b);
  }
  return EO_OK;
}

static enum eo_code weigh_cuts(struct output *out, const struct eo_section *section)
{
  size_t count = (size_t)section->cut_nodes * (size_t)(out->sector->layers + 1);
  out->weight = malloc((count + 1) * sizeof *out->weight);
  return out->weight ? eo_member_cut_weights(out->sector, out->teeth, out->weight) : EO_ERROR_MEMORY;
}

static enum eo_code lay_out(struct output *out, struct eo_section *section, struct eo_sector *sector,
                            const struct eo_geometry *geometry, int member, const struct eo_material *material,
                            const struct eo_member_settings *settings, struct eo_error *error)
{
  EO_TRY(eo_section_init(section, geometry, member, settings->bore_radius, &settings->section, error));
  EO_TRY(eo_sector_init(sector, section, settings->layers, geometry->member_width[member],
                        eo_sector_twist(geometry, member), material, EO_WHOLE_SECTOR, error));
  return find_edges(out, section) || number_own(out, section) || weigh_cuts(out, section) ? eo_error_memory(error)
                                                                                          : EO_OK;
}

enum eo_code eo_mesh_export(const struct eo_geometry *geometry, int member, const struct eo_material *material,
                            const struct eo_member_settings *settings, enum eo_mesh_element element, int cases,
                            const struct eo_mesh_case *load_case, eo_writer_function *writer, void *context,
                            struct eo_error *error)
{
  struct eo_section section = {0};
  struct eo_sector sector = {0};
  struct output out = {.sector = &sector, .writer = writer, .context = context};
  out.teeth = settings->section.open ? geometry->teeth[member] : 1;
  out.floating = settings->section.floating;
  enum eo_code code = lay_out(&out, &section, &sector, geometry, member, material, settings, error);
  if (!code)
    put_model(&out, material, element, cases, load_case);
  if (out.stopped)
    code = eo_error_set(error, EO_ERROR_FILE, "", "The finite-element mesh could not be written.");
  free(out.edge);
  free(out.ends);
  free(out.node_place);
  free(out.edge_place);
  free(out.weight);
  eo_sector_done(&sector);
  eo_section_done(&section);
  return code;
}

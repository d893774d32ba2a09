/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/export.h"

#include <math.h>
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
  const struct eo_section *s = out->sector->section;
  put(out, "%d", number);
  for (int k = 0; k < 8; k++)
    put(out, ", %d", corner_number(out, tooth, l + k / 4, s->quad[4 * q + k % 4]));
  for (int k = 0; k < 8 && element == EO_MESH_C3D20R; k++)
    put(out, "%s%d", k == 2 ? ",\n" : ", ", edge_number(out, tooth, l + k / 4, out->edge[4 * q + k % 4]));
  for (int k = 0; k < 4 && element == EO_MESH_C3D20R; k++)
    put(out, ", %d", upright_number(out, tooth, l, s->quad[4 * q + k]));
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
  const struct eo_section *s = out->sector->section;
  for (int l = 0; l <= out->sector->layers; l++) {
    for (int a = 0; a < s->nodes; a++)
      if (s->fixed[a] == EO_HELD_ALL && out->node_place[a] >= 0)
        put(out, "%d,\n", corner_number(out, tooth, l, a));
    for (int e = 0; e < out->edges && element == EO_MESH_C3D20R; e++)
      if (s->fixed[out->ends[2 * e]] && s->fixed[out->ends[2 * e + 1]] && out->edge_place[e] >= 0)
        put(out, "%d,\n", edge_number(out, tooth, l, e));
    for (int a = 0; a < s->nodes && element == EO_MESH_C3D20R && l < out->sector->layers; a++)
      if (s->fixed[a] == EO_HELD_ALL && out->node_place[a] >= 0)
        put(out, "%d,\n", upright_number(out, tooth, l, a));
  }
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
  put(out, "*NODE PRINT, NSET=FLANK\nU\n*END STEP\n");
}

static void put_model(struct output *out, const struct eo_material *material, enum eo_mesh_element element, int cases,
                      const struct eo_mesh_case *load_case)
{
  const struct eo_flank_nodes *flank = &out->sector->section->flank;
  put(out, out->teeth > 1 ? "*HEADING\nall teeth of a gear, loaded flank of the first\n"
                          : "*HEADING\nsector of a gear, loaded flank of the middle tooth\n");
  put_nodes(out, element);
  put_elements(out, element);
  put(out, "*NSET, NSET=FIXED\n");
  for (int t = 0; t < out->teeth; t++)
    put_fixed(out, element, t);
  put(out, "*NSET, NSET=FLANK, UNSORTED\n");
  for (int row = 0; row < flank->count; row++)
    for (int l = 0; l <= out->sector->layers; l++)
      put(out, "%d,\n", corner_number(out, 0, l, flank->node[row]));
  put(out, "*MATERIAL, NAME=STEEL\n*ELASTIC\n%.12e, %.12e\n*SOLID SECTION, ELSET=SECTOR, MATERIAL=STEEL\n",
      material->youngs_modulus, material->poissons_ratio);
  put(out, "*BOUNDARY\nFIXED, 1, 3, 0\n");
  for (int i = 0; i < cases; i++)
    put_step(out, &load_case[i]);
}

/* Numbers the section's edges; each is met by at most two quadrilaterals. */
static enum eo_code find_edges(struct output *out, const struct eo_section *s)
{
  int *first = malloc((size_t)s->nodes * sizeof *first), *next = malloc((size_t)(4 * s->quads) * sizeof *next);
  out->edge = malloc((size_t)(4 * s->quads) * sizeof *out->edge);
  out->ends = malloc((size_t)(8 * s->quads) * sizeof *out->ends);
  enum eo_code code = first && next && out->edge && out->ends ? EO_OK : EO_ERROR_MEMORY;
  for (int a = 0; a < s->nodes && !code; a++)
    first[a] = -1;
  for (int i = 0; i < 4 * s->quads && !code; i++) {
    int a = s->quad[i], b = s->quad[i % 4 == 3 ? i - 3 : i + 1], low = a < b ? a : b, high = a < b ? b : a,
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
static int left_of(const struct eo_section *s, int node)
{
  for (int i = 0; i < s->cut_nodes; i++)
    if (s->cut[1][i] == node)
      return s->cut[0][i];
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

static enum eo_code number_own(struct output *out, const struct eo_section *s)
{
  out->node_place = malloc((size_t)s->nodes * sizeof *out->node_place);
  out->edge_place = malloc((size_t)out->edges * sizeof *out->edge_place);
  if (!out->node_place || !out->edge_place)
    return EO_ERROR_MEMORY;
  for (int a = 0; a < s->nodes; a++) {
    int left = left_of(s, a);
    out->node_place[a] = left < 0 ? out->own_nodes++ : -1 - left;
  }
  for (int e = 0; e < out->edges; e++) {
    int a = left_of(s, out->ends[2 * e]), b = left_of(s, out->ends[2 * e + 1]);
    out->edge_place[e] = a < 0 || b < 0 ? out->own_edges++ : -1 - find_edge(out, a, b);
  }
  return EO_OK;
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
  if (settings->section.floating)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/body_support",
                        "A floating body is balanced by inertia, which the mesh's file cannot say: choose body_support "
                        "\"held\" for all teeth, or body \"sector\".");
  enum eo_code code = eo_section_init(&section, geometry, member, settings->bore_radius, &settings->section, error);
  if (!code)
    code = eo_sector_init(&sector, &section, settings->layers, geometry->face_width, eo_sector_twist(geometry, member),
                          material, EO_WHOLE_SECTOR, error);
  if (!code && (find_edges(&out, &section) || number_own(&out, &section)))
    code = eo_error_memory(error);
  if (!code) {
    put_model(&out, material, element, cases, load_case);
    if (out.stopped)
      code = eo_error_set(error, EO_ERROR_FILE, "", "The finite-element mesh could not be written.");
  }
  free(out.edge);
  free(out.ends);
  free(out.node_place);
  free(out.edge_place);
  eo_sector_done(&sector);
  eo_section_done(&section);
  return code;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our solver against CalculiX on our own mesh: same nodes, same loads, C3D8I. The two elements are the same for
   parallelepipeds (see test-element); elsewhere CalculiX leaves the ratio of the Jacobians out of the incompatible
   modes, which ours has so that it passes the patch test. That is the whole of the difference seen here. */
#include "flexibility/export.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CASES_COUNT = 3, LAYERS = 12, ROWS = 8 };

static int write_text(void *context, const char *text, size_t length)
{
  return fwrite(text, 1, length, context) != length;
}

/* A point load inside the flank, a load spread over a corner, and a line load along a row. */
static const struct eo_mesh_load inside[] = {{3, 4, 1000}}, corner[] = {{8, 0, 250}, {8, 1, 500},  {8, 2, 250},
                                                                        {7, 0, 500}, {7, 1, 1000}, {7, 2, 500}},
                                 line[] = {{1, 0, 500},   {1, 1, 1000},  {1, 2, 1000}, {1, 3, 1000}, {1, 4, 1000},
                                           {1, 5, 1000},  {1, 6, 1000},  {1, 7, 1000}, {1, 8, 1000}, {1, 9, 1000},
                                           {1, 10, 1000}, {1, 11, 1000}, {1, 12, 500}};
static const struct eo_mesh_case load_case[CASES_COUNT] = {{1, inside}, {6, corner}, {13, line}};

/* What is modelled. */
struct body {
  enum eo_body body;
  enum eo_body_support support;
};

static struct eo_member_settings coarse(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member,
                                        const struct body *body)
{
  struct eo_flexibility_settings settings = {.body = body->body,
                                             .support = body->support,
                                             .sector_teeth = 3,
                                             .layers = LAYERS,
                                             .flank_rows = ROWS,
                                             .fillet_elements = 8,
                                             .columns = 4,
                                             .rim_elements = 4};
  return eo_flexibility_member_settings(&settings, g, pair, member);
}

/* Displacements, m. */
struct found {
  int nodes, cuts; /* of the flank; of all cuts of a floating ring, else 0 */
  double *flank;   /* [case][nodes][3] */
  double *cut;     /* [case][cuts][3] */
};

/* Each set of nodes of each step has a head of its own. Returns 0 when all numbers were read. */
static int read_displacements(FILE *file, const struct found *found)
{
  char text[300];
  int flank = 0, cuts = 0, number;
  bool in_cuts = false;
  while (fgets(text, sizeof text, file)) {
    double u[3];
    if (strstr(text, "set "))
      in_cuts = strstr(text, "CUTS") != NULL;
    if (sscanf(text, "%d %lf %lf %lf", &number, &u[0], &u[1], &u[2]) != 4)
      continue;
    if (in_cuts && cuts < CASES_COUNT * found->cuts)
      memcpy(found->cut + (size_t)(3 * cuts++), u, sizeof u);
    else if (!in_cuts && flank < CASES_COUNT * found->nodes)
      memcpy(found->flank + (size_t)(3 * flank++), u, sizeof u);
  }
  return flank == CASES_COUNT * found->nodes && cuts == CASES_COUNT * found->cuts ? 0 : -1;
}

/* Runs CalculiX on the exported mesh. Returns 0 when all numbers were read. */
static int run_calculix(const struct eo_geometry *g, int member, const struct eo_material *material,
                        const struct eo_member_settings *settings, const char *directory, const struct found *found)
{
  char path[300], command[400];
  snprintf(path, sizeof path, "%s/sector.inp", directory);
  FILE *file = fopen(path, "w");
  if (!file)
    return -1;
  struct eo_error error;
  enum eo_code code = eo_mesh_export(g, member, material, settings, EO_MESH_C3D8I, CASES_COUNT, load_case, write_text,
                                     file, &error);
  fclose(file);
  snprintf(command, sizeof command, "cd '%s' && OMP_NUM_THREADS=1 ccx -i sector >ccx.txt 2>&1", directory);
  if (code || system(command))
    return -1;
  snprintf(path, sizeof path, "%s/sector.dat", directory);
  file = fopen(path, "r");
  if (!file)
    return -1;
  int missing = read_displacements(file, found);
  fclose(file);
  return missing;
}

/* Takes the weighted mean rigid motion in the plane of the cuts out of the flank's displacements. */
static void take_mean_out(const struct eo_sector *sector, int teeth, const struct found *found, double *flank,
                          const double *cut)
{
  const struct eo_section *s = sector->section;
  int across = LAYERS + 1, each = s->cut_nodes * across;
  double *weight = calloc((size_t)each, sizeof *weight), sum[3] = {0}, mass = 0, inertia = 0;
  ok(weight && !eo_member_cut_weights(sector, teeth, weight), "the cuts of the sector have weights");
  for (int i = 0; i < found->cuts && weight; i++) {
    double p[3], w = weight[i % each], angle = 2 * M_PI * (i / each) / teeth;
    eo_sector_position(sector, s->cut[0][i % each / across], i % across, p);
    double x = cos(angle) * p[0] + sin(angle) * p[1], y = cos(angle) * p[1] - sin(angle) * p[0];
    sum[0] += w * cut[3 * i];
    sum[1] += w * cut[3 * i + 1];
    sum[2] += w * (x * cut[3 * i + 1] - y * cut[3 * i]);
    mass += w;
    inertia += w * (x * x + y * y);
  }
  for (int i = 0; i < found->nodes; i++) {
    double p[3];
    eo_sector_position(sector, s->flank.node[i / across], i % across, p);
    flank[3 * i] -= sum[0] / mass - p[1] * sum[2] / inertia;
    flank[3 * i + 1] -= sum[1] / mass + p[0] * sum[2] / inertia;
  }
  free(weight);
}

static void compare(int member, const struct eo_member_result *result, const struct eo_sector *sector,
                    const double *displacement)
{
  int across = LAYERS + 1, nodes = (ROWS + 1) * across;
  for (int k = 0; k < CASES_COUNT; k++) {
    double largest = 0, worst = 0;
    for (int i = 0; i < nodes; i++) {
      double normal[3], ours = 0, theirs = 0;
      const double *u = displacement + 3 * (k * nodes + i);
      eo_sector_direction(sector, sector->section->flank.node[i / across], i % across, 0, normal);
      for (int c = 0; c < 3; c++)
        theirs += normal[c] * u[c];
      for (int l = 0; l < load_case[k].loads; l++) {
        const struct eo_mesh_load *load = &load_case[k].load[l];
        ours += load->force * result->full[(load->row * across + load->layer) * nodes + i];
      }
      largest = fmax(largest, fabs(theirs));
      worst = fmax(worst, fabs(ours - theirs));
    }
    ok(largest > 1e-7 && worst < 0.01 * largest,
       "%s, load case %d: deflections are within 1 %% of the largest displacement (%.4g um): %.4f %%",
       member ? "gear" : "pinion", k + 1, 1e6 * largest, 100 * worst / largest);
  }
}

static void check_member(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member,
                         const struct body *body, const char *directory)
{
  struct eo_material material = paper_steel();
  struct eo_member_settings settings = coarse(g, pair, member, body);
  struct eo_member_result result = {0};
  struct eo_member_times times;
  struct eo_section section = {0};
  struct eo_sector sector = {0};
  struct eo_error error = {0};
  struct found found = {.nodes = (ROWS + 1) * (LAYERS + 1)};
  enum eo_code code = eo_member_compute(&result, g, member, &material, &settings, NULL, &times, &error);
  if (!code)
    code = eo_section_init(&section, g, member, settings.bore_radius, &settings.section, &error);
  if (!code)
    code = eo_sector_init(&sector, &section, LAYERS, g->face_width, eo_sector_twist(g, member), &material,
                          EO_WHOLE_SECTOR, &error);
  bool floating = settings.section.floating;
  found.cuts = floating ? g->teeth[member] * section.cut_nodes * (LAYERS + 1) : 0;
  found.flank = calloc((size_t)(3 * CASES_COUNT * found.nodes), sizeof(double));
  found.cut = calloc((size_t)(3 * CASES_COUNT * found.cuts + 1), sizeof(double));
  if (ok(!code && found.flank && found.cut, "the coarse model is computed %s", error.text) &&
      ok(!run_calculix(g, member, &material, &settings, directory, &found), "CalculiX runs")) {
    for (int k = 0; k < CASES_COUNT && floating; k++)
      take_mean_out(&sector, g->teeth[member], &found, found.flank + 3 * k * found.nodes,
                    found.cut + 3 * k * found.cuts);
    compare(member, &result, &sector, found.flank);
  }
  free(found.flank);
  free(found.cut);
  eo_sector_done(&sector);
  eo_section_done(&section);
  eo_member_result_done(&result);
}

/* With "ring" all teeth of a held ring, with "floating" of one that floats: minutes. */
int main(int argc, char **argv)
{
  bool ring = argc > 1, floating = ring && strcmp(argv[1], "floating") == 0;
  const struct body body = {ring ? EO_BODY_RING : EO_BODY_SECTOR, floating ? EO_SUPPORT_FLOATING : EO_SUPPORT_HELD};
  char directory[] = "/tmp/easeoff-ccx-XXXXXX", command[100];
  struct eo_gear_pair pair = paper_pair();
  struct eo_geometry geometry;
  struct eo_error error;
  if (system("command -v ccx >/dev/null 2>&1")) {
    printf("1..0 # SKIP CalculiX (ccx) is not installed\n");
    return 0;
  }
  ok(!eo_geometry_init(&geometry, &pair, &error), "the paper's pair is accepted");
  if (!ok(mkdtemp(directory) != NULL, "a working directory is made"))
    return tap_done();
  check_member(&geometry, &pair, EO_PINION, &body, directory);
  if (!ring)
    check_member(&geometry, &pair, EO_GEAR, &body, directory);
  snprintf(command, sizeof command, "rm -r '%s'", directory);
  ok(!system(command), "the working directory is removed");
  return tap_done();
}

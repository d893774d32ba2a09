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

static struct eo_member_settings coarse(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member,
                                        enum eo_body body)
{
  struct eo_flexibility_settings settings = {.body = body,
                                             .support = EO_SUPPORT_HELD,
                                             .sector_teeth = 3,
                                             .layers = LAYERS,
                                             .flank_rows = ROWS,
                                             .fillet_elements = 8,
                                             .columns = 4,
                                             .rim_elements = 4};
  return eo_flexibility_member_settings(&settings, g, pair, member);
}

/* Runs CalculiX on the exported mesh; displacement[case][flank node][3], m. Returns 0 when all numbers were read. */
static int run_calculix(const struct eo_geometry *g, int member, const struct eo_material *material,
                        const struct eo_member_settings *settings, const char *directory, int nodes,
                        double *displacement)
{
  char path[300], command[400], text[300];
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
  int found = 0, number;
  while (fgets(text, sizeof text, file) && found < CASES_COUNT * nodes) {
    double *u = displacement + 3 * found;
    if (sscanf(text, "%d %lf %lf %lf", &number, &u[0], &u[1], &u[2]) == 4)
      found++;
  }
  fclose(file);
  return found == CASES_COUNT * nodes ? 0 : -1;
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
       "%s, load case %d: within 1 %% of the largest displacement (%.4g um): %.4f %%", member ? "gear" : "pinion",
       k + 1, 1e6 * largest, 100 * worst / largest);
  }
}

static void check_member(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member, enum eo_body body,
                         const char *directory)
{
  struct eo_material material = paper_steel();
  struct eo_member_settings settings = coarse(g, pair, member, body);
  struct eo_member_result result = {0};
  struct eo_member_times times;
  struct eo_section section = {0};
  struct eo_sector sector = {0};
  struct eo_error error = {0};
  static double displacement[CASES_COUNT * (ROWS + 1) * (LAYERS + 1) * 3];
  enum eo_code code = eo_member_compute(&result, g, member, &material, &settings, NULL, &times, &error);
  if (!code)
    code = eo_section_init(&section, g, member, settings.bore_radius, &settings.section, &error);
  if (!code)
    code = eo_sector_init(&sector, &section, LAYERS, g->face_width, eo_sector_twist(g, member), &material,
                          EO_WHOLE_SECTOR, &error);
  if (ok(!code, "the coarse model is computed %s", error.text) &&
      ok(!run_calculix(g, member, &material, &settings, directory, (ROWS + 1) * (LAYERS + 1), displacement),
         "CalculiX runs"))
    compare(member, &result, &sector, displacement);
  eo_sector_done(&sector);
  eo_section_done(&section);
  eo_member_result_done(&result);
}

/* With an argument, all teeth of a held ring: minutes. */
int main(int argc, char **argv)
{
  enum eo_body body = argc > 1 && argv[1] ? EO_BODY_RING : EO_BODY_SECTOR;
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
  check_member(&geometry, &pair, EO_PINION, body, directory);
  if (body == EO_BODY_SECTOR)
    check_member(&geometry, &pair, EO_GEAR, body, directory);
  snprintf(command, sizeof command, "rm -r '%s'", directory);
  ok(!system(command), "the working directory is removed");
  return tap_done();
}

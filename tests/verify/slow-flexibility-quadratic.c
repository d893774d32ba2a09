/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear bricks with incompatible modes (ours) against quadratic bricks with reduced integration (C3D20R of CalculiX)
   on the same meshes, refined step by step: which of the two moves, and where both go. A line load along one row, the
   mean normal deflection of another row: so no dent under a point load comes in. For `make check-slow`. */
#include "flexibility/export.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <stdlib.h>
#include <unistd.h>

enum { MAX_LAYERS = 20, ROWS = 8, LOADED = 7, OBSERVED = 3 };

static int write_text(void *context, const char *text, size_t length)
{
  return fwrite(text, 1, length, context) != length;
}

static double share(int layer, int layers)
{
  return (layer == 0 || layer == layers ? 0.5 : 1) / layers;
}

static double ours(const struct eo_geometry *g, int member, const struct eo_member_settings *settings)
{
  struct eo_member_result result;
  struct eo_member_times times;
  struct eo_material material = paper_steel();
  int across = settings->layers + 1, n = (ROWS + 1) * across;
  double sum = 0;
  if (eo_member_compute(&result, g, member, &material, settings, NULL, &times, NULL))
    return NAN;
  for (int i = 0; i < across; i++)
    for (int j = 0; j < across; j++)
      sum += 1e3 * share(i, settings->layers) * share(j, settings->layers) *
             result.full[(LOADED * across + i) * n + OBSERVED * across + j];
  eo_member_result_done(&result);
  return sum;
}

/* The same from CalculiX; element: on the same bricks. */
static double theirs(const struct eo_geometry *g, int member, const struct eo_member_settings *settings,
                     enum eo_mesh_element element, const char *directory)
{
  char path[300], command[400], text[300];
  struct eo_material material = paper_steel();
  struct eo_mesh_load load[MAX_LAYERS + 1];
  int layers = settings->layers, across = layers + 1, found = 0, number;
  for (int l = 0; l <= layers; l++)
    load[l] = (struct eo_mesh_load){.row = LOADED, .layer = l, .force = 1e3 * share(l, layers)};
  struct eo_mesh_case load_case = {.loads = across, .load = load};
  snprintf(path, sizeof path, "%s/sector.inp", directory);
  FILE *file = fopen(path, "w");
  if (!file)
    return NAN;
  enum eo_code code = eo_mesh_export(g, member, &material, settings, element, 1, &load_case, write_text, file, NULL);
  fclose(file);
  snprintf(command, sizeof command, "cd '%s' && OMP_NUM_THREADS=1 ccx -i sector >ccx.txt 2>&1", directory);
  if (code || system(command))
    return NAN;
  snprintf(path, sizeof path, "%s/sector.dat", directory);
  file = fopen(path, "r");
  double sum = 0, u[3];
  struct eo_section section = {0};
  struct eo_sector sector = {0};
  if (eo_section_init(&section, g, member, settings->bore_radius, &settings->section, NULL) ||
      eo_sector_init(&sector, &section, layers, g->face_width, eo_sector_twist(g, member), &material, EO_WHOLE_SECTOR,
                     NULL))
    sum = NAN;
  while (file && fgets(text, sizeof text, file) && isfinite(sum)) {
    if (sscanf(text, "%d %lf %lf %lf", &number, &u[0], &u[1], &u[2]) != 4)
      continue;
    int row = found / across, layer = found % across;
    double normal[3];
    found++;
    eo_sector_direction(&sector, section.flank.node[row], layer, 0, normal);
    if (row == OBSERVED)
      sum += share(layer, layers) * (normal[0] * u[0] + normal[1] * u[1] + normal[2] * u[2]);
  }
  if (file)
    fclose(file);
  eo_sector_done(&sector);
  eo_section_done(&section);
  return found == (ROWS + 1) * across ? sum : NAN;
}

static void study(const struct eo_geometry *g, const struct eo_gear_pair *pair, int member, const char *directory)
{
  static const struct eo_flexibility_settings step[] = {{.body = EO_BODY_SECTOR,
                                                         .sector_teeth = 3,
                                                         .layers = 5,
                                                         .flank_rows = ROWS,
                                                         .fillet_elements = 6,
                                                         .columns = 4,
                                                         .rim_elements = 4},
                                                        {.body = EO_BODY_SECTOR,
                                                         .sector_teeth = 3,
                                                         .layers = 10,
                                                         .flank_rows = ROWS,
                                                         .fillet_elements = 8,
                                                         .columns = 4,
                                                         .rim_elements = 5},
                                                        {.body = EO_BODY_SECTOR,
                                                         .sector_teeth = 3,
                                                         .layers = 20,
                                                         .flank_rows = ROWS,
                                                         .fillet_elements = 12,
                                                         .columns = 6,
                                                         .rim_elements = 7}};
  enum { STEPS = sizeof step / sizeof *step };
  double linear[STEPS], quadratic[STEPS];
  for (int i = 0; i < STEPS; i++) {
    struct eo_member_settings settings = eo_flexibility_member_settings(&step[i], g, pair, member);
    linear[i] = ours(g, member, &settings);
    quadratic[i] = theirs(g, member, &settings, EO_MESH_C3D20R, directory);
    printf("# %s, %2d layers: ours %.5f um, C3D20R %.5f um (ours %+.2f %%)\n", member ? "gear" : "pinion",
           step[i].layers, 1e6 * linear[i], 1e6 * quadratic[i], 100 * (linear[i] / quadratic[i] - 1));
  }
  ok(fabs(linear[STEPS - 1] / quadratic[STEPS - 1] - 1) < 0.025, "%s: the finest mesh is within 2.5 %%",
     member ? "gear" : "pinion");
  for (int i = 1; i < STEPS; i++) {
    ok(fabs(linear[i] - quadratic[i]) < 0.6 * fabs(linear[i - 1] - quadratic[i - 1]),
       "refinement %d shrinks the difference below 60 %%", i);
    ok(linear[i] > linear[i - 1] && quadratic[i] < quadratic[i - 1],
       "ours comes from the stiff side, the quadratic bricks from the soft");
  }
}

int main(void)
{
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
  study(&geometry, &pair, EO_PINION, directory);
  study(&geometry, &pair, EO_GEAR, directory);
  snprintf(command, sizeof command, "rm -r '%s'", directory);
  ok(!system(command), "the working directory is removed");
  return tap_done();
}

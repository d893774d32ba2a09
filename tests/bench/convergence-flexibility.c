/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far the compliance and the root stress depend on the mesh: one property changed at a time, for `make
   convergence`. Last, what the micro-geometry changes when it is put into the mesh. */
#include "flexibility/flexibility.h"
#include "numerics/sparse.h"
#include "support/paper-pair.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 57 };

/* Deflection in the middle of the face, nm, and largest root stress, MPa, under a line load of 1 N and 100 N per mm of
   face width. */
static void press_row(const struct eo_flexibility *flexibility, const struct eo_geometry *g, int member, double s,
                      double *deflection, double *stress)
{
  static double compliance[POINTS * POINTS];
  struct eo_flank_point point[POINTS];
  double force[POINTS];
  struct eo_root root = eo_flexibility_root(flexibility, member);
  size_t across = (size_t)root.layers + 1, count = (size_t)(root.points - root.first) * across;
  double *state = malloc(count * EO_STRESSES * sizeof *state);
  memset(compliance, 0, sizeof compliance);
  for (int i = 0; i < POINTS; i++) {
    point[i] = (struct eo_flank_point){.s = {s, s}, .eta = g->face_width * ((double)i / (POINTS - 1) - 0.5)};
    force[i] = 1e5 * g->face_width / (POINTS - 1) * (i == 0 || i == POINTS - 1 ? 0.5 : 1);
  }
  eo_flexibility_add_compliance(flexibility, member, POINTS, point, compliance);
  eo_flexibility_root_stress(flexibility, member, 0, POINTS, point, force, root.first, root.points, state);
  *deflection = *stress = 0;
  for (int i = 0; i < POINTS; i++)
    *deflection += 1e9 * 0.01 * force[i] * compliance[POINTS / 2 * POINTS + i];
  for (size_t i = 0; i < count; i++)
    *stress = fmax(*stress, 1e-6 * eo_stress_principal(state + EO_STRESSES * i));
  free(state);
}

static void print_row(const char *what, const struct eo_geometry *g, const struct eo_gear_pair *pair,
                      const struct eo_flexibility_settings *settings)
{
  struct eo_material material = paper_steel();
  struct eo_flexibility *flexibility = NULL;
  struct eo_error error;
  if (eo_flexibility_prepare(g, pair, &material, settings, NULL, NULL, &flexibility, &error)) {
    printf("%-28s %s\n", what, error.text);
    return;
  }
  printf("%-28s", what);
  for (int member = 0; member < 2; member++) {
    double place[3] = {g->path_start, 0, g->path_end}, deflection, stress = 0;
    for (int k = 0; k < 3; k++) {
      press_row(flexibility, g, member, place[k], &deflection, &stress);
      printf(" %7.3f", deflection);
    }
    press_row(flexibility, g, member, 0, &deflection, &stress);
    printf("  %7.3f ", stress);
  }
  printf(" %6.1f s\n", eo_flexibility_report(flexibility)->seconds);
  fflush(stdout);
  eo_flexibility_free(flexibility);
}

static void vary(const struct eo_geometry *g, const struct eo_gear_pair *pair, const char *name, size_t offset,
                 const int *value, int values)
{
  for (int i = 0; i < values; i++) {
    struct eo_flexibility_settings settings = default_settings();
    char what[60];
    memcpy((char *)&settings + offset, &value[i], sizeof *value);
    snprintf(what, sizeof what, "%s %d", name, value[i]);
    print_row(what, g, pair, &settings);
  }
}

/* Compliance of the pinion's flank nodes, with tip and root relief of 20 um (parabolas over the outer quarters) cut off
   or not. */
static double *flank_compliance(const struct eo_geometry *g, const struct eo_gear_pair *pair, double relief, int *count)
{
  struct eo_flexibility_settings settings = {.body = EO_BODY_SECTOR,
                                             .sector_teeth = 3,
                                             .layers = 14,
                                             .flank_rows = 10,
                                             .fillet_elements = 16,
                                             .columns = 8,
                                             .rim_elements = 6};
  struct eo_member_settings member = eo_flexibility_member_settings(&settings, g, pair, EO_PINION);
  struct eo_material material = paper_steel();
  struct eo_section section = {0};
  struct eo_sector sector = {0};
  struct eo_sparse_factor *factor = NULL;
  struct eo_error error;
  double *inverse = NULL;
  if (eo_section_init(&section, g, EO_PINION, member.bore_radius, &member.section, &error))
    return NULL;
  for (int k = 0; k < section.flank.count; k++) {
    double share = 2.0 * k / (section.flank.count - 1) - 1, part = fmax(0, fabs(share) - 0.5) / 0.5;
    for (int c = 0; c < 2; c++)
      section.point[2 * section.flank.node[k] + c] -= relief * part * part * section.flank.normal[2 * k + c];
  }
  int across = settings.layers + 1, n = section.flank.count * across, *keep = malloc((size_t)n * sizeof *keep);
  if (!eo_sector_init(&sector, &section, settings.layers, g->face_width, eo_sector_twist(g, EO_PINION), &material,
                      EO_WHOLE_SECTOR, &error)) {
    for (int i = 0; i < n; i++)
      keep[i] = eo_sector_unknown(&sector, section.flank.node[i / across], i % across, 0);
    inverse = malloc((size_t)(n * n) * sizeof *inverse);
    if (eo_sparse_analyse(&sector.matrix, sector.group, sector.groups, keep, n, &factor, &error) ||
        eo_sparse_factorise(factor, &error) || eo_sparse_inverse(factor, n, inverse, &error)) {
      free(inverse);
      inverse = NULL;
    }
  }
  *count = n;
  free(keep);
  eo_sparse_factor_free(factor);
  eo_sector_done(&sector);
  eo_section_done(&section);
  return inverse;
}

static void print_modification(const struct eo_geometry *g, const struct eo_gear_pair *pair)
{
  int n = 0;
  double *plain = flank_compliance(g, pair, 0, &n), *modified = flank_compliance(g, pair, 20e-6, &n), worst = 0,
         largest = 0;
  for (int i = 0; i < n * n && plain && modified; i++) {
    worst = fmax(worst, fabs(modified[i] - plain[i]));
    largest = fmax(largest, fabs(plain[i]));
  }
  printf("\nrelief of 20 um at tip and root in the mesh: compliance changes by at most %.3f %% of its largest entry\n",
         100 * worst / largest);
  free(plain);
  free(modified);
}

#define VARY(name, member, ...)                                                                              \
  vary(&geometry, &pair, name, offsetof(struct eo_flexibility_settings, member), (const int[]){__VA_ARGS__}, \
       (int)(sizeof(const int[]){__VA_ARGS__} / sizeof(int)))

int main(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_geometry geometry;
  struct eo_error error;
  if (eo_geometry_init(&geometry, &pair, &error))
    return 1;
  printf("Paper pair. Line load along a row at s_A, 0, s_E: deflection in mid face, nm per N/mm; root stress for 100 "
         "N/mm at s = 0, MPa\n");
  printf("%-28s %24s %8s %24s %8s\n", "", "pinion", "stress", "gear", "stress");
  struct eo_flexibility_settings settings = default_settings();
  print_row("default", &geometry, &pair, &settings);
  VARY("layers", layers, 14, 20, 40, 56);
  VARY("flank rows", flank_rows, 5, 15, 20);
  VARY("fillet elements", fillet_elements, 10, 14, 28, 40);
  VARY("columns", columns, 4, 12, 16);
  VARY("rim elements", rim_elements, 4, 6, 12);
  VARY("teeth in the sector", sector_teeth, 3);
  print_modification(&geometry, &pair);
  return 0;
}

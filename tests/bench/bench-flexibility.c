/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times the preparation of the paper pair by step and the evaluation of the kernel and of the root stress. */
#include "flexibility/flexibility.h"
#include "support/paper-pair.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

enum { POINTS = 90, REPEATS = 21 };

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void place_points(const struct eo_geometry *g, struct eo_flank_point *point)
{
  for (int i = 0; i < POINTS; i++) {
    int pair = i / 30 - 1;
    double eta = g->face_width * ((i % 30 + 0.5) / 30 - 0.5),
           s = pair * g->transverse_base_pitch + eta * tan(g->base_helix_angle);
    s = fmin(fmax(s, g->path_start), g->path_end);
    point[i] = (struct eo_flank_point){.pair = pair, .s = {s, s}, .eta = eta};
  }
}

static void time_evaluation(const struct eo_flexibility *flexibility, const struct eo_geometry *g)
{
  static double matrix[POINTS * POINTS], kernel_time[REPEATS], stress_time[REPEATS], force[POINTS];
  struct eo_flank_point point[POINTS];
  struct eo_root root = eo_flexibility_root(flexibility, EO_PINION);
  double *stress = malloc((size_t)root.points * (size_t)(root.layers + 1) * EO_STRESSES * sizeof *stress);
  struct eo_kernel kernel = eo_flexibility_kernel(flexibility);
  place_points(g, point);
  for (int i = 0; i < POINTS; i++)
    force[i] = 100;
  for (int i = 0; i < REPEATS; i++) {
    double start = now();
    kernel.evaluate(kernel.context, POINTS, point, matrix);
    kernel_time[i] = now() - start;
    start = now();
    eo_flexibility_root_stress(flexibility, EO_PINION, 0, POINTS, point, force, 0, root.points, stress);
    stress_time[i] = now() - start;
  }
  qsort(kernel_time, REPEATS, sizeof *kernel_time, compare);
  qsort(stress_time, REPEATS, sizeof *stress_time, compare);
  printf("kernel, %d points of three pairs      %8.3f ms\n", POINTS, 1e3 * kernel_time[REPEATS / 2]);
  printf("root stress of one tooth, all points  %8.3f ms\n", 1e3 * stress_time[REPEATS / 2]);
  free(stress);
}

static void print_report(const struct eo_flexibility_report *report)
{
  static const char *const name[2] = {"pinion", "gear"};
  for (int m = 0; m < 2; m++) {
    const struct eo_member_times *t = &report->times[m];
    printf("%-6s unknowns %.0f, factor %.3g entries, %.0f MB\n", name[m], t->unknowns, t->entries, 1e-6 * t->memory);
    printf("  mesh and assembly %.3f s, ordering %.3f s, factorisation %.3f s, compliance %.3f s, stress %.3f s, half "
           "tooth %.3f s\n",
           t->mesh, t->ordering, t->factorisation, t->compliance, t->stress, t->half_tooth);
    printf("  smallest eigenvalue over largest %.2e\n", report->smallest_eigenvalue[m]);
  }
}

int main(int argc, char **argv)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_material material = paper_steel();
  struct eo_flexibility_settings settings = default_settings();
  struct eo_flexibility *flexibility = NULL;
  struct eo_geometry geometry;
  struct eo_error error;
  int repeats = argc > 1 ? atoi(argv[1]) : 3;
  if (eo_geometry_init(&geometry, &pair, &error))
    return 1;
  for (int i = 0; i < repeats; i++) {
    if (eo_flexibility_prepare(&geometry, &pair, &material, &settings, argc > 2 ? argv[2] : NULL, NULL, &flexibility,
                               &error)) {
      printf("%s\n", error.text);
      return 1;
    }
    const struct eo_flexibility_report *report = eo_flexibility_report(flexibility);
    printf("preparation of both members%s %.3f s\n", report->from_cache ? " (read from the cache)" : "",
           report->seconds);
    if (i == repeats - 1) {
      print_report(report);
      time_evaluation(flexibility, &geometry);
    }
    eo_flexibility_free(flexibility);
  }
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  printf("peak resident memory %.0f MB\n", (double)usage.ru_maxrss / 1024);
  return 0;
}

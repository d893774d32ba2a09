/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bulk compliance against an independent computation (tests/cases/contact.json, fe_bulk: deflection under a line load
   along a row). One tooth pair pressed together by 7.2 um: load and root stress against the three-dimensional contact
   analysis of CalculiX (tests/cases/calculix.json: unmodified pair, 3-tooth sectors, no neighbour coupling). The
   contact is solved here in a few lines, so that this test stands on the flexibility alone. */
#include "flexibility/flexibility.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <jansson.h>
#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 40, MOST = 2 * CELLS };

struct line {
  int n;
  struct eo_flank_point point[MOST];
  double length[MOST]; /* of a cell along the line, m */
  double load[MOST];
};

/* Adds the cells of the line s = c + eta tan(beta_b) inside the field of contact. */
static void place_line(const struct eo_geometry *g, double c, int pair, struct line *line)
{
  double slope = tan(g->base_helix_angle), half = g->face_width / 2;
  double from = fmax(-half, (g->path_start - c) / slope), to = fmin(half, (g->path_end - c) / slope);
  for (int i = 0; i < CELLS; i++, line->n++) {
    double eta = from + (i + 0.5) / CELLS * (to - from), s = c + eta * slope;
    line->point[line->n] = (struct eo_flank_point){.pair = pair, .s = {s, s}, .eta = eta};
    line->length[line->n] = (to - from) / CELLS / cos(g->base_helix_angle);
  }
}

/* Weber and Banaschek's local approach under the load p of a cell, and its derivative. */
static double local_approach(const struct eo_geometry *g, const struct eo_material *m, double s, double length,
                             double p, double *slope)
{
  double nu = m->poissons_ratio, factor = 2 * (1 - nu * nu) / (M_PI * m->youngs_modulus), q = fmax(p, 1e-3) / length;
  double width = 4 * factor * q * eo_geometry_relative_radius(g, s);
  double depth = eo_geometry_depth(g, EO_PINION, s) * eo_geometry_depth(g, EO_GEAR, s);
  double bracket = log(4 * depth / width) - nu / (1 - nu);
  *slope = factor * (bracket - 1) / length;
  return factor * q * bracket;
}

/* Loads of the cells under a normal approach z: Newton's method on the cells that carry load. Returns the sum. */
static double press(const struct eo_geometry *g, const struct eo_material *m, const struct eo_kernel *kernel, double z,
                    struct line *line)
{
  static double c[MOST * MOST], a[MOST * MOST], r[MOST];
  int active[MOST], pivot[MOST], count = line->n;
  kernel->evaluate(kernel->context, line->n, line->point, c);
  for (int i = 0; i < line->n; i++) {
    active[i] = i;
    line->load[i] = 100;
  }
  for (int iteration = 0; iteration < 30; iteration++) {
    for (int i = 0; i < count; i++) {
      double slope;
      r[i] = z -
             local_approach(g, m, line->point[active[i]].s[0], line->length[active[i]], line->load[active[i]], &slope);
      for (int j = 0; j < count; j++) {
        a[i * count + j] = c[active[i] * line->n + active[j]];
        r[i] -= a[i * count + j] * line->load[active[j]];
      }
      a[i * count + i] += slope;
    }
    LAPACKE_dgesv(LAPACK_ROW_MAJOR, count, 1, a, count, pivot, r, 1);
    int kept = 0;
    for (int i = 0; i < count; i++) {
      line->load[active[i]] = fmax(0, line->load[active[i]] + r[i]);
      if (line->load[active[i]] > 0)
        active[kept++] = active[i];
    }
    count = kept;
  }
  double sum = 0;
  for (int i = 0; i < line->n; i++)
    sum += line->load[i];
  return sum;
}

/* Largest principal stress on the root below the start of the involute, Pa, and where, m. */
static double root_stress(const struct eo_flexibility *flexibility, int member, const struct line *line, double *eta)
{
  struct eo_root root = eo_flexibility_root(flexibility, member);
  size_t across = (size_t)root.layers + 1;
  double *stress = malloc((size_t)root.points * across * EO_STRESSES * sizeof *stress), largest = 0;
  eo_flexibility_root_stress(flexibility, member, 0, line->n, line->point, line->load, 0, root.points, stress);
  for (int i = root.first; i < root.points; i++)
    for (size_t l = 0; l < across; l++) {
      double value = eo_stress_principal(stress + EO_STRESSES * ((size_t)i * across + l));
      if (value > largest) {
        largest = value;
        *eta = root.width * ((double)l / root.layers - 0.5);
      }
    }
  free(stress);
  return largest;
}

static void compare_pairs(const struct eo_flexibility *flexibility, const struct eo_geometry *g,
                          const struct eo_material *m, json_t *reference)
{
  static const char *const table[2] = {"root_pinion_MPa_at_prescribed_Z", "root_gear_MPa_at_prescribed_Z"};
  struct eo_kernel kernel = eo_flexibility_kernel(flexibility);
  double z = 1e-6 * json_number_value(json_object_get(reference, "Z_prescribed_um")) * cos(g->base_helix_angle);
  double load_difference = 0, stress_difference[2][2] = {{0}}, largest[2][2] = {{0}};
  const char *key;
  json_t *value;
  int compared = 0;
  json_object_foreach(json_object_get(reference, "pair_load_N"), key, value)
  {
    struct line line = {0};
    double c = 1e-3 * atof(key), expected = json_number_value(value), stress[2], eta[2];
    if (fabs(c) > 20e-3)
      continue; /* pairs that only just touch */
    place_line(g, c, 0, &line);
    double load = press(g, m, &kernel, z, &line);
    load_difference = fmax(load_difference, fabs(load / expected - 1));
    printf("# c %8.3f mm: %7.1f N, CalculiX %7.1f N (%+.1f %%)", 1e3 * c, load, expected, 100 * (load / expected - 1));
    char short_key[32];
    snprintf(short_key, sizeof short_key, "%.4f", 1e3 * c);
    for (int member = 0; member < 2; member++) {
      stress[member] = 1e-6 * root_stress(flexibility, member, &line, &eta[member]);
      double close = 1e9, other = 0, other_eta = 0;
      const char *phase;
      json_t *row;
      json_object_foreach(json_object_get(reference, table[member]), phase,
                          row) if (fabs(atof(phase) - 1e3 * c) < close)
      {
        close = fabs(atof(phase) - 1e3 * c);
        other = json_number_value(json_array_get(row, 0));
        other_eta = json_number_value(json_array_get(row, 1));
      }
      printf("; root %.2f at %.1f, CalculiX %.2f MPa at %.1f mm", stress[member], 1e3 * eta[member], other, other_eta);
      int corner = fabs(c) > 15e-3; /* the line of contact crosses only a corner of the flank */
      stress_difference[member][corner] = fmax(stress_difference[member][corner], fabs(stress[member] / other - 1));
      largest[member][0] = fmax(largest[member][0], stress[member]);
      largest[member][1] = fmax(largest[member][1], other);
    }
    printf("\n");
    compared++;
  }
  ok(compared == 17, "%d positions are compared", compared);
  ok(load_difference < 0.03, "the load of a pair is within 3 %% of CalculiX everywhere: %.2f %%",
     100 * load_difference);
  near(largest[0][0], largest[0][1], 0.05, "largest root stress of the pinion, MPa");
  near(largest[1][0], largest[1][1], 0.05, "largest root stress of the gear, MPa");
  for (int member = 0; member < 2; member++) {
    ok(stress_difference[member][0] < 0.05, "the root stress of the %s is within 5 %%: %.2f %%",
       member ? "gear" : "pinion", 100 * stress_difference[member][0]);
    ok(stress_difference[member][1] < 0.15,
       "the root stress is within 15 %% where only a corner of the flank touches: %.2f %%",
       100 * stress_difference[member][1]);
  }
}

/* Deflection at both ends and the middle of a row under a uniform line load of 1 N per mm of face width, um. The table
   is not symmetric in eta, so it tells the hand of the helix and the side that meets first. */
static void compare_bulk(const struct eo_flexibility *flexibility, const struct eo_geometry *g, json_t *reference)
{
  static const char *const name[2] = {"pinion", "gear"};
  enum { N = 28 + 1 };
  double tolerance = json_number_value(json_object_get(reference, "tol_rel"));
  for (int member = 0; member < 2; member++) {
    size_t index;
    json_t *row;
    json_array_foreach(json_object_get(reference, name[member]), index, row)
    {
      struct eo_flank_point point[N];
      double compliance[N * N] = {0}, s = 1e-3 * json_number_value(json_object_get(row, "s"));
      for (int i = 0; i < N; i++)
        point[i] = (struct eo_flank_point){.s = {s, s}, .eta = g->face_width * ((double)i / (N - 1) - 0.5)};
      eo_flexibility_add_compliance(flexibility, member, N, point, compliance);
      for (int k = 0; k < 3; k++) {
        double deflection = 0, at = json_number_value(json_array_get(json_object_get(row, "d"), (size_t)k));
        for (int j = 0; j < N; j++)
          deflection += (j == 0 || j == N - 1 ? 0.5 : 1) * compliance[k * (N - 1) / 2 * N + j];
        char what[100];
        snprintf(what, sizeof what, "%s, s %.4f mm, eta %+.1f b: deflection, um", name[member], 1e3 * s, 0.5 * (k - 1));
        near(1e6 * 1e3 * g->face_width / (N - 1) * deflection, at, tolerance, what);
      }
    }
  }
}

/* Transverse loaded transmission error, um, with two pairs in contact, at a phase where no third touches: P = 8638.6 N.
 */
static double two_pairs(const struct eo_flexibility *flexibility, const struct eo_geometry *g,
                        const struct eo_material *m)
{
  struct eo_kernel kernel = eo_flexibility_kernel(flexibility);
  struct line line = {0};
  double z = 7e-6;
  place_line(g, 7.188036e-3, 0, &line);
  place_line(g, 7.188036e-3 - g->transverse_base_pitch, -1, &line);
  for (int i = 0; i < 6; i++) {
    double load = press(g, m, &kernel, z, &line), more = press(g, m, &kernel, 1.001 * z, &line);
    z += (8638.6 - load) * 0.001 * z / (more - load);
  }
  return 1e6 * z / cos(g->base_helix_angle);
}

/* Two pairs at once: CalculiX with each pair in its own sectors (calculix.json), and with both in one sector, where
   each tooth bends the other's ground: 8.16 um [an independent contact analysis of the pair, quoted in the project's
   model notes]. */
static void compare_coupling(const struct eo_flexibility *uncoupled, const struct eo_geometry *g,
                             const struct eo_gear_pair *pair, const struct eo_material *m, json_t *reference)
{
  struct eo_flexibility_settings settings = default_settings();
  struct eo_flexibility *coupled = NULL;
  double apart = json_number_value(json_array_get(json_object_get(reference, "LTE_um"), 3));
  near(two_pairs(uncoupled, g, m), apart, 0.02, "transmission error, each pair in its own sector, um");
  ok(!eo_flexibility_prepare(g, pair, m, &settings, NULL, NULL, &coupled, NULL),
     "the pair is prepared with five teeth and coupling");
  if (coupled)
    near(two_pairs(coupled, g, m), 8.16, 0.02, "transmission error, both pairs in one sector, um");
  eo_flexibility_free(coupled);
}

static json_t *load_cases(const char *name)
{
  char path[1000];
  snprintf(path, sizeof path, "%s/%s", getenv("CASES") ? getenv("CASES") : "tests/cases", name);
  return json_load_file(path, 0, NULL);
}

int main(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_material material = paper_steel();
  struct eo_flexibility_settings settings = default_settings();
  struct eo_flexibility *flexibility = NULL;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  json_t *calculix = load_cases("calculix.json"), *contact = load_cases("contact.json");
  settings.sector_teeth = 3;
  settings.neighbour_coupling = false;
  ok(calculix && contact, "the cases can be read");
  ok(!eo_geometry_init(&geometry, &pair, &error) &&
         !eo_flexibility_prepare(&geometry, &pair, &material, &settings, NULL, NULL, &flexibility, &error),
     "the paper's pair is prepared %s", error.text);
  if (calculix && contact && flexibility) {
    compare_bulk(flexibility, &geometry, json_object_get(contact, "fe_bulk"));
    compare_pairs(flexibility, &geometry, &material, json_object_get(calculix, "unmodified"));
    compare_coupling(flexibility, &geometry, &pair, &material, json_object_get(calculix, "unmodified"));
  }
  json_decref(calculix);
  json_decref(contact);
  eo_flexibility_free(flexibility);
  return tap_done();
}

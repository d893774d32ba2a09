/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Load over the face of a spur pair whose teeth yield like springs side by side, against what ISO 6336-1 (39) to (42)
   have in closed form for just such teeth: w runs straight over the face, K_Hbeta = 1 + r, and 2 sqrt(r) where one side
   is off. What the factors must be where nothing is uneven. */
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/analysis.h"
#include "flexibility/closed_form.h"
#include "rating/load_factors.h"
#include "support/tap.h"

enum { CELLS = 40 };

struct subject {
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_closed_form form;
  struct eo_pair *pair;
  struct eo_analysis *analysis;
};

/* A spur pair without modification; springs of 15 N/(mm um) on each pair of teeth. */
static struct subject *start(void)
{
  struct subject *s = calloc(1, sizeof *s);
  struct eo_error error;
  eo_example_build("single", &s->design);
  memset(&s->design.modification, 0, sizeof s->design.modification);
  s->design.gear_pair.helix_angle = 0;
  s->design.gear_pair.centre_distance = NAN;
  s->design.resolution.tip_edge_contact = false;
  s->design.resolution.positions = 32;
  s->design.resolution.te_harmonics = 8;
  s->design.resolution.cells_per_line = CELLS;
  s->design.load_cases = 1;
  s->design.load_case[0].share = 1;
  s->form = (struct eo_closed_form){.compliance = CELLS / (15e9 * s->design.gear_pair.face_width), .length = 1e-9};
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &s->form}};
  if (eo_design_complete(&s->design, &s->geometry, &error) ||
      eo_pair_new(&s->pair, &s->design, &options, NULL, &error) || eo_analysis_new(&s->analysis, s->pair, &error))
    printf("Bail out! %s: %s\n", error.pointer, error.text);
  return s;
}

static const struct eo_case_result *run(struct subject *s, double deviation)
{
  struct eo_error error;
  const struct eo_geometry *g = &s->geometry;
  s->design.alignment.shaft_angle_in_plane = deviation / (g->face_width * sin(g->working_pressure_angle));
  s->design.alignment.shaft_angle_out_of_plane = 0;
  if (eo_analysis_run(s->analysis, &s->design, 0, &error))
    printf("Bail out! %s\n", error.text);
  return &s->analysis->evaluation->load_case[0];
}

static double mean(int n, const double *value)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i] / n;
  return sum;
}

int main(void)
{
  struct subject *s = start();
  const struct eo_case_result *c = run(s, 0);
  const struct eo_face_load *face = &c->end[0].face;
  double b = s->geometry.face_width, load = c->force / b;
  near(mean(EO_FACE_SLICES, face->load), load, 1e-9, "the load over the face sums to the normal force");
  near(face->face_factor, 1, 1e-6, "K_Hbeta of an aligned spur pair");
  near(face->share_factor, 1, 1e-6, "K_Halpha where one pair carries everything for a while");
  double stiffness = mean(s->pair->grid->positions, c->end[0].loaded.tangent) / b;
  double best = face->line_factor;
  static const double ratio[] = {0.3, 0.8, 1.6, 3}; /* r of the standard */
  for (size_t i = 0; i < sizeof ratio / sizeof ratio[0]; i++) {
    double deviation = ratio[i] * 2 * load / stiffness;
    c = run(s, deviation);
    face = &c->end[0].face;
    double expected = eo_face_load_factor(deviation, stiffness, load);
    char what[80];
    snprintf(what, sizeof what, "K_Hbeta at %.3g um over the face, r = %.2g", 1e6 * deviation, ratio[i]);
    /* the slices at the ends average over 1/32 of the face; the local deformation is not straight */
    near(face->face_factor, expected, 0.04, what);
    near(mean(EO_FACE_SLICES, face->load), load, 1e-9, " the sum of the load over the face");
    ok(face->line_factor > best, "  the largest line load grows");
    best = face->line_factor;
  }
  eo_analysis_free(s->analysis);
  eo_pair_free(s->pair);
  free(s);
  return tap_done();
}

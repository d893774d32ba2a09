/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of a section and of a sector: where its nodes lie, on which side the neighbours are, and that no brick folds
   on gears of very different shape. */
#include "flexibility/sector.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <stdlib.h>

static const struct eo_section_settings division = {
    .teeth = 5, .loaded = {8, 10, {8, 20}}, .next = {6, 5, {6, 6}}, .outer = {4, 3, {4, 4}}, .rim = 8};

static double quad_area(const struct eo_section *s, int q)
{
  double area = 0;
  for (int k = 0; k < 4; k++) {
    const double *a = s->point + 2 * s->quad[4 * q + k], *b = s->point + 2 * s->quad[4 * q + (k + 1) % 4];
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return area;
}

/* Area of a sector of `teeth` teeth from the bore to the tips, by integration of the tooth and the space between. */
static double expected_area(const struct eo_geometry *g, int member, double bore, int teeth)
{
  enum { STEPS = 4000 };
  double point[2], normal[2], last[2], area = 0;
  double tip = g->tip_radius[member], form = g->form_radius[member];
  /* Twice the triangle between the centre and each piece of the half profile, from the tooth's centre at the tip to mid
     space. */
  last[0] = 0;
  last[1] = tip;
  for (int i = 0; i <= 3 * STEPS; i++) {
    double t = (double)(i % STEPS) / STEPS;
    if (i < STEPS) {
      eo_geometry_involute(g, member, tip, point, normal);
      double angle = t * atan2(point[0], point[1]);
      point[0] = tip * sin(angle);
      point[1] = tip * cos(angle);
    } else if (i < 2 * STEPS) {
      eo_geometry_involute(g, member, tip + t * (form - tip), point, normal);
    } else {
      eo_geometry_fillet(g, member, i == 3 * STEPS ? 0 : 1 - t, point, normal);
    }
    area += point[0] * last[1] - point[1] * last[0];
    last[0] = point[0];
    last[1] = point[1];
  }
  return teeth * (area - M_PI / g->teeth[member] * bore * bore);
}

static void check_paper(const struct eo_geometry *g, int member)
{
  const char *name = member ? "gear" : "pinion";
  double bore = g->root_radius[member] - 3.5 * g->normal_module, area = 0, smallest = INFINITY;
  struct eo_section s;
  struct eo_error error = {0};
  if (!ok(!eo_section_init(&s, g, member, bore, &division, &error), "%s: a section is made %s", name, error.text))
    return;
  for (int q = 0; q < s.quads; q++) {
    area += quad_area(&s, q);
    smallest = fmin(smallest, quad_area(&s, q));
  }
  ok(smallest > 0, "%s: no quadrilateral is turned over", name);
  near(area, expected_area(g, member, bore, 5), 2e-3, "area of the section, m2");
  double off = 0, slant = 0;
  for (int k = 0; k < s.flank.count; k++) {
    const double *p = s.point + 2 * s.flank.node[k], *n = s.flank.normal + 2 * k;
    off = fmax(off, fabs(hypot(p[0], p[1]) - eo_geometry_radius_at(g, member, s.flank.s[k])));
    /* The normal of an involute touches the base circle. */
    slant = fmax(slant, fabs(fabs(n[0] * p[1] - n[1] * p[0]) - g->base_radius[member]));
  }
  ok(off < 1e-12 && slant < 1e-12, "%s: the flank's nodes and normals are those of the involute: %.1e, %.1e m", name,
     off, slant);
  near(s.flank.s[0], g->path_start, 1e-12, "place of the first row, at the start of contact, m");
  near(s.flank.s[s.flank.count - 1], g->path_end, 1e-12, "place of the last row, at the end of contact, m");
  /* The loaded flank leads the pinion's motion and trails the gear's; pair k + 1 is ahead in the motion. */
  double ahead = s.point[2 * s.next_flank[1].node[0]], behind = s.point[2 * s.next_flank[0].node[0]];
  ok(member ? ahead < 0 && behind > 0 : ahead > 0 && behind < 0, "%s: pair k + 1 is ahead of pair k", name);
  int held = 1, ends = 0;
  for (int a = 0; a < s.nodes; a++) {
    double r = hypot(s.point[2 * a], s.point[2 * a + 1]), angle = fabs(atan2(s.point[2 * a], s.point[2 * a + 1]));
    int edge = fabs(r - bore) < 1e-9 || fabs(angle - 5 * M_PI / g->teeth[member]) < 1e-9;
    held = held && (edge ? EO_HELD_ALL : 0) == s.fixed[a];
    ends += edge;
  }
  ok(held && ends > 20, "%s: the bore and the two outer cuts are held, and nothing else", name);
  eo_section_done(&s);
}

static const struct eo_flexibility_settings held = {.body = EO_BODY_SECTOR};

static void check_shape(const char *what, struct eo_gear_pair pair)
{
  struct eo_geometry g;
  struct eo_error error = {0};
  struct eo_material material = paper_steel();
  if (!ok(!eo_geometry_init(&g, &pair, &error), "%s: the pair is accepted %s", what, error.text))
    return;
  for (int member = 0; member < 2; member++) {
    struct eo_section section;
    struct eo_sector sector;
    double bore = eo_flexibility_bore_radius(&held, &g, &pair, member);
    enum eo_code code = eo_section_init(&section, &g, member, bore, &division, &error);
    if (!code) {
      code = eo_sector_init(&sector, &section, 4, g.face_width, eo_sector_twist(&g, member), &material, EO_WHOLE_SECTOR,
                            &error);
      if (!code)
        eo_sector_done(&sector);
      eo_section_done(&section);
    }
    ok(!code, "%s: the section of the %s has no folds %s", what, member ? "gear" : "pinion", error.text);
  }
}

static void check_shapes(void)
{
  struct eo_gear_pair spur = paper_pair(), small = spur, large = spur, shifted = spur, sharp = spur, thin = spur,
                      steep = spur;
  spur.helix_angle = 0;
  spur.teeth[0] = 20;
  check_shape("spur gears", spur);
  small.teeth[0] = 9;
  small.profile_shift[0] = 0.5;
  check_shape("nine teeth", small);
  large.teeth[0] = 40;
  large.teeth[1] = 300;
  check_shape("a large wheel", large);
  shifted.profile_shift[0] = shifted.profile_shift[1] = 0.6;
  check_shape("strong profile shift", shifted);
  sharp.fillet_radius_coefficient = 0.1;
  check_shape("a sharp fillet", sharp);
  thin.rim_thickness_coefficient = 1;
  check_shape("a thin rim", thin);
  steep.helix_angle = 40 * M_PI / 180;
  check_shape("a steep helix", steep);
}

int main(void)
{
  struct eo_gear_pair pair = paper_pair();
  struct eo_geometry geometry;
  struct eo_section section;
  struct eo_error error = {0};
  ok(!eo_geometry_init(&geometry, &pair, &error), "the paper's pair is accepted");
  check_paper(&geometry, EO_PINION);
  check_paper(&geometry, EO_GEAR);
  check_shapes();
  geometry.teeth[0] = 5;
  ok(eo_section_init(&section, &geometry, EO_PINION, 20e-3, &division, &error) == EO_ERROR_INPUT,
     "five of five teeth are refused: %s", error.text);
  return tap_done();
}

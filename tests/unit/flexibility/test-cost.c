/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is said beforehand of a preparation, beside what CHOLMOD then held and what it held of the factor. */
#include "design/resolution.h"
#include "document/examples.h"
#include "flexibility/preparation_cost.h"
#include "support/tap.h"

#include <stdlib.h>

static struct eo_error error;

static void make(struct eo_design *design, enum eo_body body, int layers, int rows, int fillet)
{
  eo_example_build("paper", design);
  design->resolution.elements.body = body;
  design->resolution.elements.sector_teeth = 3;
  design->resolution.elements.layers = layers;
  design->resolution.elements.flank_rows = rows;
  design->resolution.elements.fillet_elements = fillet;
}

static void compare(const char *what, struct eo_design *design)
{
  struct eo_geometry geometry;
  struct eo_flexibility *flexibility = NULL;
  struct eo_preparation_cost cost;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design->resolution);
  if (eo_geometry_init(&geometry, &design->gear_pair, &error) ||
      eo_preparation_cost_find(&geometry, &design->gear_pair, &settings, &cost, &error) ||
      eo_flexibility_prepare(&geometry, &design->gear_pair, &design->material, &settings, NULL, NULL, &flexibility,
                             &error)) {
    ok(0, "%s is priced: %s", what, error.text);
    return;
  }
  const struct eo_flexibility_report *report = eo_flexibility_report(flexibility);
  double held = report->times[0].memory + report->times[1].memory;
  ok(cost.memory > held && cost.memory < 100e6 + 1.6 * held,
     "%s: the solver holds as much as was said, %.0f MB said, %.0f MB held", what, cost.memory / 1e6, held / 1e6);
  eo_flexibility_free(flexibility);
}

static double memory_of(int layers, int rows, int fillet)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_preparation_cost cost = {0};
  make(&design, EO_BODY_RING, layers, rows, fillet);
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design.resolution);
  if (!eo_geometry_init(&geometry, &design.gear_pair, &error))
    eo_preparation_cost_find(&geometry, &design.gear_pair, &settings, &cost, &error);
  return cost.memory;
}

static struct eo_preparation_cost cost_of(double right_helix, double right_width)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_preparation_cost cost = {0};
  make(&design, EO_BODY_RING, 12, 7, 10);
  design.gear_pair.right_helix_angle = right_helix * M_PI / 180;
  design.gear_pair.right_face_width = right_width;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design.resolution);
  ok(!eo_geometry_init(&geometry, &design.gear_pair, &error) &&
         !eo_preparation_cost_find(&geometry, &design.gear_pair, &settings, &cost, &error),
     "the cost of a preparation is found %s", error.text);
  return cost;
}

/* Halves that differ are prepared one after the other. */
static void test_halves(void)
{
  struct eo_preparation_cost even = cost_of(NAN, NAN), helix = cost_of(30, NAN), width = cost_of(NAN, 40e-3);
  ok(helix.seconds > 1.6 * even.seconds && helix.seconds < 2.4 * even.seconds,
     "a pair of two helices takes the time of both halves: %.3g s, not %.3g", helix.seconds, even.seconds);
  ok(width.seconds > 1.6 * even.seconds && width.seconds < 2.4 * even.seconds,
     "a pair of two widths takes the time of both halves: %.3g s", width.seconds);
  ok(helix.memory > 0.7 * even.memory && helix.memory < 1.4 * even.memory,
     "a pair of two helices takes the memory of one half: %.0f MB, %.0f alike", helix.memory / 1e6, even.memory / 1e6);
}

int main(void)
{
  struct eo_design design;
  make(&design, EO_BODY_SECTOR, 14, 8, 10);
  compare("three teeth", &design);
  make(&design, EO_BODY_RING, 12, 7, 10);
  compare("a ring", &design);
  /* 2,214 MB of memory were measured at the second of these */
  ok(memory_of(28, 10, 18) < 1.3e9 && memory_of(40, 16, 24) > 2.2e9 && memory_of(60, 30, 40) > 7.6e9,
     "a finer mesh costs more: %.0f, %.0f, %.0f MB", memory_of(28, 10, 18) / 1e6, memory_of(40, 16, 24) / 1e6,
     memory_of(60, 30, 40) / 1e6);
  test_halves();
  return tap_done();
}

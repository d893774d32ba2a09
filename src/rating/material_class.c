/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/material_class.h"

#include <math.h>

/* sigma = A x + B over a range of hardness x, HV; N/mm2 (ISO 6336-5:2016 table 1). */
struct line {
  double slope, constant, low, high;
};

struct row {
  enum eo_rating_material material;
  struct line flank[3], root[3]; /* [ML, MQ, ME] */
};

static const struct row rows[] = {
    {EO_CASE_HARDENED,
     {{0, 1300, 600, 800}, {0, 1500, 660, 800}, {0, 1650, 660, 800}},
     {{0, 312, 600, 800}, {0, 425, 660, 800}, {0, 525, 660, 800}}},
    {EO_THROUGH_HARDENED_ALLOY,
     {{1.313, 188, 200, 360}, {1.313, 373, 200, 360}, {2.213, 260, 200, 390}},
     {{0.423, 104, 200, 360}, {0.425, 187, 200, 360}, {0.358, 231, 200, 390}}},
    {EO_THROUGH_HARDENED_CARBON,
     {{0.963, 283, 135, 210}, {0.925, 360, 135, 210}, {0.838, 432, 135, 210}},
     {{0.250, 108, 135, 210}, {0.240, 163, 135, 210}, {0.283, 202, 135, 210}}},
    {EO_FLAME_HARDENED,
     {{0.740, 602, 485, 615}, {0.541, 882, 500, 615}, {0.505, 1013, 500, 615}},
     {{0.305, 76, 485, 615}, {0.138, 290, 500, 570}, {0.271, 237, 500, 615}}},
    {EO_NITRIDED_NITRIDING_STEEL,
     {{0, 1125, 650, 900}, {0, 1250, 650, 900}, {0, 1450, 650, 900}},
     {{0, 270, 650, 900}, {0, 420, 650, 900}, {0, 468, 650, 900}}},
    {EO_NITRIDED_THROUGH_STEEL,
     {{0, 788, 450, 650}, {0, 998, 450, 650}, {0, 1217, 450, 650}},
     {{0, 258, 450, 650}, {0, 363, 450, 650}, {0, 432, 450, 650}}},
    {EO_NITROCARBURISED,
     {{0, 650, 300, 650}, {1.167, 425, 300, 450}, {1.167, 425, 300, 450}},
     {{0, 224, 300, 650}, {0.653, 94, 300, 450}, {0.653, 94, 300, 450}}},
};

static const double core_bonus[] = {[EO_CORE_25HRC_LOW] = 0, [EO_CORE_25HRC] = 461 - 425, [EO_CORE_30HRC] = 500 - 425};

enum eo_code eo_material_strength(struct eo_strength *strength, enum eo_rating_material material,
                                  enum eo_material_quality quality, enum eo_core core, double hardness,
                                  struct eo_error *error)
{
  enum { ROWS = sizeof rows / sizeof *rows };
  int i = 0;
  while (i < ROWS && rows[i].material != material)
    i++;
  if (i == ROWS)
    return eo_error_set(error, EO_ERROR_INPUT, "/material",
                        "ISO 6336-5 table 1 is not kept for structural steel here: state sigma_Hlim and sigma_Flim.");
  const struct line *flank = &rows[i].flank[quality], *root = &rows[i].root[quality];
  double low = fmax(flank->low, root->low), high = fmin(flank->high, root->high);
  if (!(hardness >= low && hardness <= high))
    return eo_error_set(error, EO_ERROR_INPUT, "/hardness_HV",
                        "%.6g HV is outside the range of this material, %.6g .. %.6g: state sigma_Hlim and sigma_Flim.",
                        hardness, low, high);
  strength->flank = 1e6 * (flank->slope * hardness + flank->constant);
  strength->root = 1e6 * (root->slope * hardness + root->constant);
  if (material == EO_CASE_HARDENED && quality == EO_QUALITY_MQ)
    strength->root += 1e6 * core_bonus[core];
  return EO_OK;
}

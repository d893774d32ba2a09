/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Materials: what the rating formulae distinguish, and the strengths of ISO 6336-5:2016 table 1 (unchecked: one source,
   no report). Stresses in Pa. */
#ifndef EASEOFF_RATING_MATERIAL_CLASS_H
#define EASEOFF_RATING_MATERIAL_CLASS_H

#include "base/error.h"

enum eo_rating_material {
  EO_CASE_HARDENED,            /* Eh */
  EO_FLAME_HARDENED,           /* IF: flame or induction hardened */
  EO_THROUGH_HARDENED_ALLOY,   /* V */
  EO_THROUGH_HARDENED_CARBON,  /* V */
  EO_STRUCTURAL,               /* St */
  EO_NITRIDED_NITRIDING_STEEL, /* NT */
  EO_NITRIDED_THROUGH_STEEL,   /* NV, nitrided */
  EO_NITROCARBURISED,          /* NV, nitrocarburised */
};

enum eo_material_quality { EO_QUALITY_ML, EO_QUALITY_MQ, EO_QUALITY_ME };

/* Core of case hardened gears of quality MQ: bending strengths 425, 461 and 500. */
enum eo_core { EO_CORE_25HRC_LOW, EO_CORE_25HRC, EO_CORE_30HRC };

struct eo_strength {
  double flank; /* sigma_Hlim */
  double root;  /* sigma_Flim */
};

/* hardness: HV. EO_ERROR_INPUT outside the table's hardness, or for structural steel, which has no row. */
enum eo_code eo_material_strength(struct eo_strength *strength, enum eo_rating_material material,
                                  enum eo_material_quality quality, enum eo_core core, double hardness,
                                  struct eo_error *error);

#endif

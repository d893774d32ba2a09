/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flank tolerances of both members by ISO 1328-1 as a table for a drawing. */
#include <math.h>

#include "document/flank_chart.h"
#include "document/tolerance_export.h"

/* A quantity by its symbols in both editions. */
struct quantity {
  const char *name, *symbol_1995, *symbol_2013;
  size_t offset;
};

#define QUANTITY(name, old, new, member)                        \
  {                                                             \
    name, old, new, offsetof(struct eo_flank_tolerance, member) \
  }
static const struct quantity quantities[] = {
    QUANTITY("single pitch", "f_pt", "f_pT", single_pitch),
    QUANTITY("cumulative pitch over z/8", "F_pk", "F_pkT", cumulative_pitch),
    QUANTITY("total pitch", "F_p", "F_pT", total_pitch),
    QUANTITY("profile, total", "F_alpha", "F_alphaT", profile_total),
    QUANTITY("profile form", "f_falpha", "f_falphaT", profile_form),
    QUANTITY("profile slope", "f_Halpha", "f_HalphaT", profile_slope),
    QUANTITY("helix, total", "F_beta", "F_betaT", helix_total),
    QUANTITY("helix form", "f_fbeta", "f_fbetaT", helix_form),
    QUANTITY("helix slope", "f_Hbeta", "f_HbetaT", helix_slope),
    QUANTITY("runout", "F_r", "F_rT", runout),
    QUANTITY("tooth to tooth composite", "f_i'", "f_isT", tooth_composite),
    QUANTITY("total composite", "F_i'", "F_isT", total_composite),
};

void eo_tolerances_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  static const char *const members[2] = {"pinion", "gear"};
  const struct eo_rating_settings *r = &design->rating;
  bool new = r->edition == EO_ISO6336_2019;
  eo_text_add(text, "member,standard,grade,quantity,symbol,tolerance_um,note\r\n");
  for (int member = 0; member < 2; member++) {
    struct eo_flank_tolerance tolerance;
    char note[400];
    eo_flank_tolerance_of(design, geometry, member, &tolerance, note, sizeof note);
    for (size_t i = 0; i < sizeof quantities / sizeof quantities[0]; i++) {
      double value = *(const double *)((const char *)&tolerance + quantities[i].offset);
      eo_text_print(text, "%s,ISO 1328-1:%s,%d,\"%s\",%s,", members[member], new ? "2013" : "1995", r->accuracy_grade,
                    quantities[i].name, new ? quantities[i].symbol_2013 : quantities[i].symbol_1995);
      if (isfinite(value))
        eo_text_print(text, "%.10g,\r\n", 1e6 * value);
      else
        eo_text_print(text, ",\"%s\"\r\n", *note ? note : "not in this edition");
    }
  }
}

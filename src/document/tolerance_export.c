/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flank tolerances of both members by ISO 1328-1 as a table for a drawing. */
#include <math.h>
#include <string.h>

#include "document/flank_chart.h"
#include "document/tolerance_export.h"
#include "gear/names.h"

/* A quantity by its symbols in both editions. */
struct quantity {
  const char *name, *symbol_1995, *symbol_2013;
  double value; /* m */
};

enum { QUANTITIES = 12 };

static void list_quantities(const struct eo_flank_tolerance *tolerance, struct quantity list[QUANTITIES])
{
  const struct quantity all[QUANTITIES] = {{"single pitch", "f_pt", "f_pT", tolerance->single_pitch},
                                           {"cumulative pitch over z/8", "F_pk", "F_pkT", tolerance->cumulative_pitch},
                                           {"total pitch", "F_p", "F_pT", tolerance->total_pitch},
                                           {"profile, total", "F_alpha", "F_alphaT", tolerance->profile_total},
                                           {"profile form", "f_falpha", "f_falphaT", tolerance->profile_form},
                                           {"profile slope", "f_Halpha", "f_HalphaT", tolerance->profile_slope},
                                           {"helix, total", "F_beta", "F_betaT", tolerance->helix_total},
                                           {"helix form", "f_fbeta", "f_fbetaT", tolerance->helix_form},
                                           {"helix slope", "f_Hbeta", "f_HbetaT", tolerance->helix_slope},
                                           {"runout", "F_r", "F_rT", tolerance->runout},
                                           {"tooth to tooth composite", "f_i'", "f_isT", tolerance->tooth_composite},
                                           {"total composite", "F_i'", "F_isT", tolerance->total_composite}};
  memcpy(list, all, sizeof all);
}

void eo_tolerances_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  const struct eo_rating_settings *settings = &design->rating;
  bool new = settings->edition == EO_ISO6336_2019;
  eo_text_add(text, "member,standard,grade,quantity,symbol,tolerance_um,note\r\n");
  for (int member = 0; member < 2; member++) {
    struct eo_flank_tolerance tolerance;
    struct quantity list[QUANTITIES];
    char note[400];
    eo_flank_tolerance_of(design, geometry, member, &tolerance, note, sizeof note);
    list_quantities(&tolerance, list);
    for (int i = 0; i < QUANTITIES; i++) {
      eo_text_print(text, "%s,ISO 1328-1:%s,%d,\"%s\",%s,", eo_member_name[member], new ? "2013" : "1995",
                    settings->accuracy_grade, list[i].name, new ? list[i].symbol_2013 : list[i].symbol_1995);
      if (isfinite(list[i].value))
        eo_text_print(text, "%.10g,\r\n", 1e6 * list[i].value);
      else
        eo_text_print(text, ",\"%s\"\r\n", *note ? note : "not in this edition");
    }
  }
}

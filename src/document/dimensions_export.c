/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dimensions of a pair as a table for a drawing: symbols of ISO 21771, DIN 3960 and DIN 3967. */
#include "document/dimensions_export.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "format/unit.h"
#include "rating/pair_dimensions.h"

enum reason { NO_REASON, SPAN_REASON, BALL_REASON };

/* A quantity of a member. */
struct quantity {
  const char *name, *symbol;
  const struct eo_unit *unit;
  size_t offset; /* in struct eo_member_dimensions, m */
  size_t stride; /* from one limit of the thickness to the next; 0: the same at all */
  enum reason reason;
};

#define AT(member) .offset = offsetof(struct eo_member_dimensions, member)
#define EACH .stride = sizeof(double)
static const struct quantity quantities[] = {
    {"reference diameter", "d", &eo_unit_mm, AT(reference_diameter)},
    {"base diameter", "d_b", &eo_unit_mm, AT(base_diameter)},
    {"tip diameter", "d_a", &eo_unit_mm, AT(tip_diameter)},
    {"root diameter", "d_f", &eo_unit_mm, AT(root_diameter), EACH},
    {"root form diameter", "d_Ff", &eo_unit_mm, AT(form_diameter), EACH},
    {"start of active profile diameter", "d_Nf", &eo_unit_mm, AT(active_start_diameter)},
    {"tooth thickness allowance", "A_sn", &eo_unit_um, AT(allowance), EACH},
    {"generating profile shift coefficient", "x_E", NULL, AT(generating_shift), EACH},
    {"normal tooth thickness", "s_n", &eo_unit_mm, AT(normal_thickness), EACH},
    {"normal chordal tooth thickness", "s_c", &eo_unit_mm, AT(chord[0].thickness),
     .stride = sizeof(struct eo_tooth_chord)},
    {"height of the tip above the chord", "h_c", &eo_unit_mm, AT(chord[0].height),
     .stride = sizeof(struct eo_tooth_chord)},
    {"normal tooth thickness at the tip", "s_an", &eo_unit_mm, AT(tip_thickness)},
    {"span", "W_k", &eo_unit_mm, AT(span), EACH, .reason = SPAN_REASON},
    {"measuring ball or pin diameter", "D_M", &eo_unit_mm, AT(ball), .reason = BALL_REASON},
    {"radius over one ball", "M_rK", &eo_unit_mm, AT(over_one_ball), EACH, .reason = BALL_REASON},
    {"dimension over two balls", "M_dK", &eo_unit_mm, AT(over_two_balls), EACH, .reason = BALL_REASON},
    {"dimension over two pins", "M_dR", &eo_unit_mm, AT(over_pins), EACH, .reason = BALL_REASON},
};

static const char *const limits[EO_MEASURED] = {"nominal", "upper allowance", "lower allowance"},
                         *const gaps[EO_MEASURED] = {"smallest", "mean", "largest"};

/* One row from its quantity on. at: "" where there is but one value; NaN: the note stands for it. */
static void put_row(struct eo_text *text, const char *name, const char *symbol, const struct eo_unit *unit,
                    const char *at, double value, const char *note)
{
  eo_text_print(text, "%s,%s,%s,%s,", name, symbol, unit ? unit->suffix : "", at);
  if (isfinite(value))
    eo_text_print(text, "%.10g,\r\n", eo_unit_out(unit, value) + 0.0); /* + 0.0: no -0 */
  else
    eo_text_print(text, ",\"%s\"\r\n", *note ? note : "not with this allowance");
}

static void put_member(struct eo_text *text, const char *member, const struct eo_member_dimensions *dimensions)
{
  const char *const notes[] = {"", dimensions->span_reason, dimensions->ball_reason};
  for (size_t i = 0; i < sizeof quantities / sizeof *quantities; i++) {
    const struct quantity *row = &quantities[i];
    for (int k = 0; k < (row->stride ? EO_MEASURED : 1); k++) {
      const double *value = (const void *)((const char *)dimensions + row->offset + (size_t)k * row->stride);
      eo_text_print(text, "%s,", member);
      put_row(text, row->name, row->symbol, row->unit, row->stride ? limits[k] : "", *value, notes[row->reason]);
    }
  }
  eo_text_print(text, "%s,", member);
  put_row(text, "teeth spanned", "k", NULL, "",
          dimensions->teeth_spanned ? (double)dimensions->teeth_spanned : (double)NAN, dimensions->span_reason);
}

static void put_backlash(struct eo_text *text, const struct eo_pair_dimensions *dimensions)
{
  static const struct {
    const char *name, *symbol;
    size_t offset;
  } rows[] = {{"normal backlash", "j_bn", offsetof(struct eo_backlash, normal)},
              {"circumferential backlash", "j_wt", offsetof(struct eo_backlash, circumferential)},
              {"radial backlash", "j_r", offsetof(struct eo_backlash, radial)}};
  const struct eo_backlash *const range[EO_MEASURED] = {&dimensions->smallest, &dimensions->mean, &dimensions->largest};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int k = 0; k < EO_MEASURED; k++) {
      const double *value = (const void *)((const char *)range[k] + rows[i].offset);
      eo_text_add(text, "pair,");
      put_row(text, rows[i].name, rows[i].symbol, &eo_unit_um, gaps[k], *value,
              "teeth as thin as these never touch on both flanks");
    }
}

void eo_dimensions_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  struct eo_pair_dimensions *dimensions = calloc(1, sizeof *dimensions);
  if (!dimensions) {
    text->failed = true;
    return;
  }
  eo_pair_dimensions_init(dimensions, &design->gear_pair, geometry);
  eo_text_add(text, "member,quantity,symbol,unit,at,value,note\r\n");
  put_member(text, "pinion", &dimensions->member[EO_PINION]);
  put_member(text, "gear", &dimensions->member[EO_GEAR]);
  eo_text_add(text, "pair,");
  put_row(text, "centre distance", "a", &eo_unit_mm, "", geometry->centre_distance, "");
  eo_text_add(text, "pair,");
  put_row(text, "centre distance allowance both ways", "A_a", &eo_unit_um, "", dimensions->centre_distance_allowance,
          "");
  put_backlash(text, dimensions);
  if (eo_gear_pair_has_two_helices(&design->gear_pair)) {
    const struct eo_gear_pair right = eo_gear_pair_half(&design->gear_pair, EO_RIGHT);
    const struct eo_geometry half = eo_geometry_of_half(geometry, &design->gear_pair, EO_RIGHT);
    eo_pair_dimensions_init(dimensions, &right, &half);
    put_member(text, "pinion, right end", &dimensions->member[EO_PINION]);
    put_member(text, "gear, right end", &dimensions->member[EO_GEAR]);
    put_backlash(text, dimensions);
  }
  free(dimensions);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the load of a load case lies over the face: curves and load distribution factors of both ends. */
#include "document/result_private.h"

/* One number per end. */
struct factor_of_ends {
  double end[2];
  bool two;
};

static bool has_right(const void *source)
{
  return ((const struct factor_of_ends *)source)->two;
}

static const struct eo_outline_row factor_rows[] = {
    EO_KEY("left", "number?", "left end; null when it carries nothing", EO_AT(struct factor_of_ends, end[EO_LEFT])),
    EO_KEY("right", "number?", "right end", .when = EO_TWO_ENDS, EO_AT(struct factor_of_ends, end[EO_RIGHT]),
           .there = has_right),
};
static const struct eo_outline factor_of_ends = EO_OUTLINE("FactorOfEnds", factor_rows);

static const struct eo_outline_row face_rows[] = {
    EO_KEY("eta_mm", "[number]?", "middles of slices of the face, from its middle, + on the side that meets first",
           .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]?", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
    EO_KEY("left_N_per_mm", "[number?]?",
           "normal force per face width, all tooth pairs together, mean over the mesh cycle, over eta_mm, left end",
           .unit = &eo_unit_N_per_mm),
    EO_KEY("right_N_per_mm", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_mm, .when = EO_TWO_ENDS),
    EO_KEY("K_Hbeta", "object",
           "face load factor: the largest of these over their mean; of the flanks as designed, without tolerances",
           .outline = &factor_of_ends),
    EO_KEY("K_Halpha", "object",
           "transverse load factor: the largest load of a tooth pair over the one it has where the load lies evenly "
           "along all contact lines; without pitch deviations",
           .outline = &factor_of_ends),
    EO_KEY("line_load_factor", "object",
           "the largest line load over the mean line load of the mesh cycle: over the face and among the pairs at once",
           .outline = &factor_of_ends),
};
const struct eo_outline eo_outline_face_load = EO_OUTLINE("FaceLoad", face_rows);

json_t *eo_result_face_load(const struct eo_result_source *source, const struct eo_case_result *case_result)
{
  struct eo_object object = eo_object_open_as(&eo_outline_face_load);
  struct factor_of_ends face = {.two = source->ends == 2}, share = face, line = face;
  bool curves = eo_result_has(source, EO_RESULT_NO_FACE_LOAD, case_result);
  eo_object_put(&object, "eta_mm",
                curves ? eo_json_reals(EO_FACE_SLICES, case_result->end[0].face.eta, 1, &eo_unit_mm, EO_DIGITS_CURVE)
                       : json_null());
  eo_result_put_right_face(&object, "right_eta_mm", source, EO_FACE_SLICES, case_result->end[0].face.eta, curves);
  for (int end = 0; end < source->ends; end++) {
    const struct eo_face_load *found = &case_result->end[end].face;
    face.end[end] = found->face_factor;
    share.end[end] = found->share_factor;
    line.end[end] = found->line_factor;
    eo_object_put(&object, end ? "right_N_per_mm" : "left_N_per_mm",
                  curves ? eo_json_reals(EO_FACE_SLICES, found->load, 1, &eo_unit_N_per_mm, EO_DIGITS_CURVE)
                         : json_null());
  }
  eo_object_put(&object, "K_Hbeta", eo_outline_encode(&factor_of_ends, &face));
  eo_object_put(&object, "K_Halpha", eo_outline_encode(&factor_of_ends, &share));
  eo_object_put(&object, "line_load_factor", eo_outline_encode(&factor_of_ends, &line));
  return eo_object_close(&object);
}

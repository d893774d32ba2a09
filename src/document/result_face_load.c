/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the load of a load case lies over the face: curves and load distribution factors of both ends. */
#include "document/result_private.h"

/* One number per end. */
struct factor_of_ends {
  double end[2];
  bool two;
};

static const struct eo_outline_row factor_rows[] = {
    EO_KEY("left", "number?", "left end; null when it carries nothing", EO_AT(struct factor_of_ends, end[EO_LEFT])),
    EO_KEY("right", "number?", "right end", .when = EO_TWO_ENDS, EO_AT(struct factor_of_ends, end[EO_RIGHT]),
           EO_IF(struct factor_of_ends, two)),
};
static const struct eo_outline factor_of_ends = EO_OUTLINE("FactorOfEnds", factor_rows);

/* How the load lies over the face. */
struct face {
  bool two, uneven;
  struct eo_series eta, load[2];
  json_t *right_eta;
  struct factor_of_ends face, share, line;
};

#define OF_FACE(member) EO_AT(struct face, member)
static const struct eo_outline_row face_rows[] = {
    EO_KEY("eta_mm", "[number]?", "middles of slices of the face, from its middle, + on the side that meets first",
           .unit = &eo_unit_mm, OF_FACE(eta)),
    EO_KEY("right_eta_mm", "[number]?", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN,
           OF_FACE(right_eta), EO_IF(struct face, uneven)),
    EO_KEY("left_N_per_mm", "[number?]?",
           "normal force per face width, all tooth pairs together, mean over the mesh cycle, over eta_mm, left end",
           .unit = &eo_unit_N_per_mm, OF_FACE(load[EO_LEFT])),
    EO_KEY("right_N_per_mm", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_mm, .when = EO_TWO_ENDS,
           OF_FACE(load[EO_RIGHT]), EO_IF(struct face, two)),
    EO_KEY("K_Hbeta", "object",
           "face load factor: the largest of these over their mean; of the flanks as designed, without tolerances",
           .outline = &factor_of_ends, OF_FACE(face)),
    EO_KEY("K_Halpha", "object",
           "transverse load factor: the largest load of a tooth pair over the one it has where the load lies evenly "
           "along all contact lines; without pitch deviations",
           .outline = &factor_of_ends, OF_FACE(share)),
    EO_KEY("line_load_factor", "object",
           "the largest line load over the mean line load of the mesh cycle: over the face and among the pairs at once",
           .outline = &factor_of_ends, OF_FACE(line)),
};
const struct eo_outline eo_outline_face_load = EO_OUTLINE("FaceLoad", face_rows);

json_t *eo_result_face_load(const struct eo_result_source *source, const struct eo_case_result *case_result)
{
  bool curves = eo_result_has(source, EO_RESULT_NO_FACE_LOAD, case_result), two = source->ends == 2;
  const double *eta = curves ? case_result->end[0].face.eta : NULL;
  struct face view = {.two = two,
                      .uneven = source->pair->right,
                      .eta = eo_series_of(EO_FACE_SLICES, eta, EO_DIGITS_CURVE | source->ready),
                      .right_eta = eo_result_right_face(source, EO_FACE_SLICES, eta),
                      .face.two = two,
                      .share.two = two,
                      .line.two = two};
  for (int end = 0; end < source->ends; end++) {
    const struct eo_face_load *found = &case_result->end[end].face;
    view.face.end[end] = found->face_factor;
    view.share.end[end] = found->share_factor;
    view.line.end[end] = found->line_factor;
    view.load[end] = eo_series_of(EO_FACE_SLICES, curves ? found->load : NULL, EO_DIGITS_CURVE | source->ready);
  }
  return eo_outline_encode(&eo_outline_face_load, &view);
}

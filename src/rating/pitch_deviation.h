/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Deviations of single teeth as a design states them: index deviations and flank slopes tooth by tooth, drawn from a
   tolerance class, eccentricity and axial wobble of a member; and what they come to in the order of meshing
   (doc/theory/ single-teeth.md). */
#ifndef EASEOFF_RATING_PITCH_DEVIATION_H
#define EASEOFF_RATING_PITCH_DEVIATION_H

#include <stdbool.h>
#include <stdint.h>

#include "contact/hunting.h"
#include "gear/flank_grid.h"
#include "rating/flank_tolerance.h"

enum eo_tooth_term {
  EO_TOOTH_INDEX,
  EO_TOOTH_PROFILE_SLOPE,
  EO_TOOTH_HELIX_SLOPE,
  EO_TOOTH_PROFILE_CROWNING,
  EO_TOOTH_LEAD_CROWNING,
  EO_TOOTH_TERMS
};

/* All tables of a design, as plain values: copies need no care. */
enum { EO_TOOTH_NUMBERS = 8192 };
struct eo_tooth_tables {
  struct eo_tooth_place {
    int teeth; /* 0: no table */
    int first;
  } place[2][2][2][EO_TOOTH_TERMS]; /* [flank side][member][end] */
  int used;
  double number[EO_TOOTH_NUMBERS]; /* m, as in struct eo_tooth_deviation; tooth 0 .. z-1 in the order in which they come
                                      into mesh ahead */
};

/* NULL: there is none. */
const double *eo_tooth_table_at(const struct eo_tooth_tables *tables, enum eo_flank_side side, int member, int end,
                                enum eo_tooth_term term);

/* Adds a table where there is none. EO_ERROR_INPUT: the tables together do not fit. */
enum eo_code eo_tooth_tables_add(struct eo_tooth_tables *tables, enum eo_flank_side side, int member, int end,
                                 enum eo_tooth_term term, int teeth, const double *value, struct eo_error *error);

/* How the contact over the hunting period is found: every instant solved; what comes between few solutions
   (contact/tooth_courses.h); the same at fewer positions of a coarse grid. */
enum eo_teeth_level { EO_TEETH_SOLVED, EO_TEETH_FOLLOWED, EO_TEETH_SKETCHED };

/* What a design says of single teeth. */
struct eo_pitch {
  bool stated;               /* false: teeth are alike, and the hunting period is not computed */
  enum eo_teeth_level level; /* no document says so */
  int positions;             /* of a mesh cycle; 0: derived */
  int gear_tooth;            /* whose drive flank meets that of the pinion's tooth 0 */
  struct eo_pitch_member {
    int tolerance_class; /* of ISO 1328-1, from which flanks without a table of index deviations are drawn; 0: none */
    int flank_class;     /* from which the slopes and crownings without a table are drawn, tooth by tooth; 0: none */
    enum eo_tolerance_edition edition;
    double tolerance_share; /* how much of the tolerances the drawn flanks take, 0 .. 1 */
    uint64_t seed;
    double eccentricity;       /* of the toothing against its axis, m */
    double eccentricity_angle; /* from tooth 0 in the order of the teeth, rad */
    double wobble;             /* axial displacement of the toothing once per turn, amplitude, m */
    double wobble_angle;       /* tooth at which it is farthest to the right, rad */
  } member[2];
  struct eo_tooth_tables tables;
};

/* F_p = max F - min F and f_p = max |F_i - F_i-1|, round the gear (ISO 1328-1:2013, 3.2), m. */
struct eo_pitch_size {
  double total, single;
};
struct eo_pitch_size eo_pitch_size_of(int teeth, const double *index);

/* Index deviations with mean 0 that keep within the share of both tolerances and reach one of them, by construction:
   a run-out, its second order and scatter, of which the run-out is as large as the tolerances allow. stream: number of
   the flank. index[teeth], m. */
void eo_pitch_draw(const struct eo_flank_tolerance *tolerance, double share, int teeth, uint64_t seed, uint64_t stream,
                   double *index);

/* One form term of every tooth: uniform within the share of its tolerance, on either side, as the scatter of the index
   deviations is. f_Halpha, f_Hbeta are for the slopes, f_falpha, f_fbeta for the crownings: what of a
   form deviation a flank has as a whole. value[teeth], m. */
void eo_tooth_form_draw(const struct eo_flank_tolerance *tolerance, double share, enum eo_tooth_term term, int teeth,
                        uint64_t seed, uint64_t stream, double *value);

/* How the flanks of one side meet. */
struct eo_pitch_meeting {
  enum eo_flank_side side;
  bool inwards;    /* eta runs against y */
  int lead_driver; /* member that drives on the drive flanks ahead */
};

/* Each tooth of a flank with all that it is off, in the body's own count: tooth[teeth]. Errors: EO_ERROR_INPUT where
   ISO 1328-1 has no such class or size; memory. */
enum eo_code eo_pitch_compose(const struct eo_pitch *pitch, const struct eo_geometry *geometry,
                              const struct eo_pitch_meeting *meeting, int member, int end,
                              struct eo_tooth_deviation *tooth, struct eo_error *error);

/* The body's tooth that stands at `place` of the order of meshing as C grows, and the table in that order. */
int eo_pitch_tooth(const struct eo_pitch *pitch, const struct eo_pitch_meeting *meeting, int member, int teeth,
                   int place);
void eo_pitch_order(const struct eo_pitch *pitch, const struct eo_pitch_meeting *meeting, int member, int teeth,
                    const struct eo_tooth_deviation *tooth, struct eo_tooth_deviation *ordered);

/* What a class allows the teeth of a member. Errors: as eo_flank_tolerance(). */
enum eo_code eo_pitch_tolerance(struct eo_flank_tolerance *tolerance, const struct eo_pitch_member *member,
                                const struct eo_geometry *geometry, int of, struct eo_error *error);

/* Positions of a mesh cycle where none are stated: the largest divisor of those of the resolution up to 32. */
int eo_pitch_usual_positions(int resolved);

/* Whether the hunting period of a pair can be computed so. resolved: positions of the resolution. EO_ERROR_INPUT with
   the key. */
enum eo_code eo_pitch_check(const struct eo_pitch *pitch, const struct eo_geometry *geometry, int resolved,
                            struct eo_error *error);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The design: everything a user may say about a gear pair, its duty cycle and what to do with it, as plain structs in
   SI units. The JSON document and its units live in document/; defaults and ranges are stated once, in its field
   tables. */
#ifndef EASEOFF_DESIGN_DESIGN_H
#define EASEOFF_DESIGN_DESIGN_H

#include <stdbool.h>
#include <stdint.h>

#include "contact/shaft.h"
#include "design/drawn_pairs.h"
#include "dynamics/parameters.h"
#include "flexibility/flexibility.h"
#include "gear/gear_pair.h"
#include "gear/modification.h"
#include "optimizer/settings.h"
#include "rating/pitch_deviation.h"
#include "rating/rating_settings.h"
#include "tolerance/tolerance_settings.h"

#include "base/error.h"

enum { EO_MAX_LOAD_CASES = 64, EO_NAME_LENGTH = 200, EO_MAX_SCENARIOS = 64 };

enum eo_axial { EO_AXIAL_FLOATING, EO_AXIAL_FIXED, EO_AXIAL_SPRING, EO_AXIAL_STOPS };

/* Which face ends of the drive flanks meet first: with the apex trailing the outer ones, with the apex leading those at
   the groove. */
enum eo_apex { EO_APEX_TRAILING, EO_APEX_LEADING };

struct eo_alignment {
  double shaft_angle_in_plane;     /* kappa, rad, in the plane of the axes */
  double shaft_angle_out_of_plane; /* gamma, rad */
  enum eo_axial pinion_axial;
  double pinion_axial_stiffness; /* N/m, used with EO_AXIAL_SPRING and, at a stop, with EO_AXIAL_STOPS; NaN: that of the
                                    gear's left end */
  double stagger;                /* right end behind the left, in transverse base pitches, 0..1 */
  double deviation_in_plane;     /* f_Sigma_delta over the face width of one end, m; NaN: the angle is stated */
  double deviation_out_of_plane; /* f_Sigma_beta over the face width of one end, m */
  double pinion_axial_clearance; /* between the stops, m, used with EO_AXIAL_STOPS */
  double coupling_thrust;        /* on the pinion, + to the right, N */
  double centre_distance_deviation; /* of the axes from the centre distance that the pair is drawn for, m */
  double apex_offset[2]; /* [member] of the right end away from the left one beyond the nominal distance, m */
  enum eo_apex apex;
  char pinion_rotation[20]; /* entry alone: "clockwise" or "counterclockwise", seen from the left end, running ahead;
                               with a stated hand it states the apex, else the hand; "": not stated */
  int error_grade; /* of ISO 1328-1, from which the shaft angle errors follow: eo_design_settle(); 0: they are stated */
};

/* Stiffness with which the pinion is held along its axis, at a stop where it has play, N/m: 0 floating, INFINITY
   fixed. */
double eo_alignment_axial_stiffness(const struct eo_alignment *alignment);

/* Which way the shafts turn, against each other's: ahead is what the design is made for. */
enum eo_direction { EO_AHEAD, EO_ASTERN };

struct eo_load_case {
  double torque;            /* total on the pinion shaft, N m, > 0 */
  double speed;             /* pinion, rad/s, > 0 */
  double share;             /* of operating time; they sum to 1 */
  double power;             /* W, entry alone: the torque is power over speed; NaN: the torque is stated */
  enum eo_flank_side flank; /* that carries; from direction and driver by eo_design_resolve() */
  double hours;             /* of operating time, h; not above 0 (or NaN): shares are stated */
  enum eo_direction direction;
  int driver; /* member */
  int has_alignment;
  struct eo_case_alignment {
    double in_plane, out_of_plane;                     /* rad; NaN: as the design's */
    double deviation_in_plane, deviation_out_of_plane; /* over the face width, m; NaN: the angle is stated */
  } alignment;
  char name[64];
};

/* Axes run from left to right. +1: the outer face ends of the drive flanks meet first (of one end: its left face), -1:
   the other ones. */
double eo_alignment_outwards(const struct eo_alignment *alignment);
/* Sense in which the pinion turns about its axis when the design runs ahead, +1: clockwise seen from the left end. The
   pinion's left half is right-handed where that is not the sense of eo_alignment_outwards(). */
double eo_design_rotation(const struct eo_design *design);
/* A stated rotation states the apex of a stated hand, else the hand that belongs to the apex; it is not stated then. */
void eo_design_settle_rotation(struct eo_gear_pair *pair, struct eo_alignment *alignment);

/* How the teeth of a load case meet. */
struct eo_running {
  enum eo_flank_side flank;      /* that carries */
  bool backwards;                /* the gear drives: contact runs from the pinion's tip to its root */
  bool inwards;                  /* the face ends at the groove meet first: eta runs inwards on both ends */
  double in_plane, out_of_plane; /* shaft angle errors, rad */
};

/* What a search minimises or keeps to beside f1, f2, f3: one of the numbers of a load case by name. */
enum { EO_MAX_OBJECTIVE_TERMS = 8, EO_MAX_OBJECTIVE_LIMITS = 16 };
struct eo_objective_term {
  int output;     /* index of eo_scalar_keys in evaluation/scalar.h */
  int load_case;  /* 1 ..; 0: the mean over the duty cycle, by share */
  double weight;  /* in J */
  double scale;   /* what it is divided by, in the unit of its key; NaN: as `normalise` says */
  double percent; /* of its values over the states of a robust objective; NaN: as J is taken */
};
struct eo_objective_limit {
  int output, load_case; /* load_case 0: every one */
  double most;           /* in the unit of its key */
  double percent;        /* the percentile over the states that keeps to it; NaN: every state does */
};

enum eo_normalise { EO_NORMALISE_UNMODIFIED, EO_NORMALISE_NONE };
enum eo_robust { EO_ROBUST_OFF, EO_ROBUST_MEAN, EO_ROBUST_WORST, EO_ROBUST_PERCENTILE, EO_ROBUST_SIGMAS };
struct eo_objective {
  double weight[3];
  enum eo_normalise normalise;
  /* Limits; NaN: off. */
  double contact_pressure;          /* Pa */
  double root_stress;               /* Pa */
  double peak_to_peak;              /* PPLTE, m */
  double edge_load_share;           /* static load on tip-edge points, share of P */
  double contact_loss;              /* fraction of the mesh cycle out of contact */
  double flank_safety, root_safety; /* least S_H, S_F of the duty cycle */
  double film_ratio;                /* least specific film thickness */
  double contact_temperature;       /* degrees Celsius */
  bool relief_inside_active_flank;
  bool no_worse_than_unmodified;
  double penalty; /* factor on every violated constraint */
  enum eo_robust robust;
  double robust_percent, robust_sigmas; /* of the last two */
  int scatter_pairs;                    /* drawn from the block tolerance instead of the rows below; 0: none */
  int first_pairs; /* of them, with which every flank is looked at; a few of each batch are with all; 0: all */
  int check_pairs; /* others, over which what was found is compared with the unmodified pair; 0: none */
  int terms, limits;
  struct eo_objective_term term[EO_MAX_OBJECTIVE_TERMS];
  struct eo_objective_limit limit[EO_MAX_OBJECTIVE_LIMITS];
  int scenarios; /* number of rows below */
  struct eo_scenario {
    double in_plane, out_of_plane, compliance, speed;
  } scenario[EO_MAX_SCENARIOS]; /* rad, rad (NaN: nominal), factor, factor */
};

/* What a Pareto front is over. */
enum eo_front_axes { EO_FRONT_OBJECTIVES, EO_FRONT_NOMINAL_AND_ROBUST, EO_FRONT_TERMS };

enum eo_variable_set { EO_VARIABLES_SHARED, EO_VARIABLES_PER_END, EO_VARIABLES_LISTED };
enum { EO_BOTH_ENDS = 2, EO_MAX_LISTED = 48 };
struct eo_range {
  double low, high;
};

/* A modification parameter to be optimized, chosen by its key, on one end or alike on both. */
enum { EO_BOTH_FLANKS = 2 };
struct eo_listed_variable {
  int member, end;        /* end: EO_LEFT, EO_RIGHT, EO_BOTH_ENDS */
  int parameter;          /* index of eo_variable_parameters in document/design_document.h */
  struct eo_range bounds; /* in the unit of the parameter's key; NaN: the bounds of the optimization */
  int flank;              /* EO_DRIVE_FLANK, EO_COAST_FLANK, EO_BOTH_FLANKS */
  int row, column;        /* of the flank's grid, from 1 on; 0: all; of its numbers alone */
  bool of_grid;           /* the parameter is numbers of the grid; who sets the parameter says so */
};

struct eo_optimization {
  enum eo_variable_set variables;
  int listed; /* rows below, with EO_VARIABLES_LISTED */
  struct eo_listed_variable list[EO_MAX_LISTED];
  struct eo_range tip_relief, root_relief, tip_relief_start, root_relief_start, lead_crowning; /* m; NaN: derived */
  enum eo_front_axes front;
  struct eo_optimizer_settings search; /* its variables and objectives follow from the above: eo_design_resolve() */
};

enum eo_mesh_law { EO_LAW_TANGENT, EO_LAW_SECANT, EO_LAW_TABLE };
enum eo_solver { EO_SOLVER_HARMONIC_BALANCE, EO_SOLVER_TIME_INTEGRATION };
/* Equal cells of a contact line: what may be stated, and what is taken where nothing is and the face is not so wide
   that its contact lines would be too many points together. */
enum { EO_CELLS_LEAST = 4, EO_CELLS_USUAL = 30, EO_CELLS_MOST = 400 };

struct eo_resolution {
  int positions;      /* mesh positions over one base pitch */
  int cells_per_line; /* EO_CELLS_LEAST .. EO_CELLS_MOST; 0: derived */
  bool tip_edge_contact;
  struct eo_flexibility_settings elements; /* of the finite-element model; used by eo_flexibility_settings_of() */
  bool hub_windup;                         /* state the wind-up of hubs that take their torque through a bore */
  double impact_patch;                     /* length of the impact patch, m; NaN: derived */
  double marking_thickness;                /* of the contact pattern, m */
  enum eo_mesh_law mesh_law;
  enum eo_solver solver;
  enum eo_impact_in_dynamics impact_in_dynamics;
  int harmonics;    /* of the harmonic balance */
  int te_harmonics; /* mesh harmonics kept of Z and k_tan; 0: derived */
};

enum { EO_STATED_WORDS = 8 };

struct eo_design {
  int version; /* of the document it was read from */
  char name[EO_NAME_LENGTH];
  struct eo_gear_pair gear_pair;
  struct eo_material material;
  struct eo_alignment alignment;
  struct eo_supports supports;
  struct eo_shafts shafts;
  int load_cases;
  struct eo_load_case load_case[EO_MAX_LOAD_CASES];
  struct eo_modification modification;
  struct eo_rating_settings rating;
  struct eo_flank_grids grids; /* beside it: what a search varies stays small */
  struct eo_pitch pitch;       /* of single teeth: over the hunting period alone */
  struct eo_tolerance_settings tolerance;
  struct eo_objective objective;
  struct eo_optimization optimization;
  struct eo_resolution resolution;
  struct eo_drawn_pairs drawn;      /* for objective.scatter_pairs */
  uint64_t stated[EO_STATED_WORDS]; /* a bit for each key that the user stated: document/assumption.h */
};

struct eo_geometry;

/* Pitches by which the mid face of the right half is behind that of the left one on the drive flanks: the stagger, less
   what halves of unequal width or helix bring. geometry: of the left half. */
double eo_design_right_lag(const struct eo_design *design, const struct eo_geometry *geometry);

/* Before there is a geometry: what was entered in another way becomes the members themselves (gear/entry.h), allowances
   come from their series, the backlash from stated allowances, shaft angle errors from a stated grade, apex or hand
   from a stated rotation. EO_ERROR_INPUT
   with the key: statements that contradict each other, no such series or grade. */
enum eo_code eo_design_settle(struct eo_design *design, struct eo_error *error);
/* The drive flanks carry ahead with the member driving that drives in every load case, or with the pinion driving when
   both do; turning round either of torque or rotation brings the coast flanks into contact. */
struct eo_running eo_design_running(const struct eo_design *design, int load_case);

/* Puts the derived default in place of every NaN whose rule does not need the loaded contact (mesh_damping_stiffness
   stays NaN: it is the mean mesh stiffness of each load case). geometry: of design->gear_pair. Idempotent; cannot fail.
 */
void eo_design_resolve(struct eo_design *design, const struct eo_geometry *geometry);

#endif

/* The design: everything a user may say about a gear pair, its duty cycle and what to do with it, as plain structs in
   SI units. The JSON document and its units live in document/; defaults and ranges are stated once, in its field
   tables. */
#ifndef EASEOFF_GEAR_DESIGN_H
#define EASEOFF_GEAR_DESIGN_H

#include <stdbool.h>
#include <stdint.h>

enum { EO_PINION = 0, EO_GEAR = 1 };
enum { EO_LEFT = 0, EO_RIGHT = 1 };
enum { EO_MAX_LOAD_CASES = 64, EO_NAME_LENGTH = 200, EO_MAX_SCENARIOS = 64 };

/* A number the user may leave out (JSON null) is NaN here until eo_design_resolve() puts the derived default in its
   place. */
struct eo_gear_pair {
  int ends;                     /* 2: herringbone; 1: single helical or spur */
  int teeth[2];                 /* [member]: pinion, gear */
  double normal_module;         /* m_n, m */
  double normal_pressure_angle; /* alpha_n, rad */
  double helix_angle;           /* beta at the pitch cylinder, rad, >= 0 (right end; the left end has the other hand) */
  double face_width;            /* b of one end, m */
  double groove_width;          /* tool withdrawal groove between the ends, m; NaN: 8 m_n with two ends, 0 with one */
  double addendum_coefficient;  /* h_aP* */
  double dedendum_coefficient;  /* h_fP* = h_aP* + c* */
  double fillet_radius_coefficient; /* rho_fP* of the basic rack */
  double profile_shift[2];          /* x */
  double centre_distance; /* working centre distance a_w, m; NaN: without backlash for the given profile shift */
  double tip_diameter[2]; /* d_a, m; NaN: from addendum, profile shift and centre distance */
  double bore[2]; /* bore diameter, m, 0: solid; NaN: pinion solid, gear 15 m_n (at most half its root diameter) */
  double groove_diameter[2];        /* body diameter between the ends, m; NaN: root diameter - 2 mm */
  double rim_thickness_coefficient; /* rim below the root that flexes, times m_n; a larger bore cuts it shorter */
  double backlash;                  /* 2 tau, normal, m */
};

struct eo_material {
  double youngs_modulus; /* Pa */
  double poissons_ratio;
  double density; /* kg/m3 */
};

enum eo_axial { EO_AXIAL_FLOATING, EO_AXIAL_FIXED, EO_AXIAL_SPRING };

struct eo_alignment {
  double shaft_angle_in_plane;     /* kappa, rad, in the plane of the axes */
  double shaft_angle_out_of_plane; /* gamma, rad */
  enum eo_axial pinion_axial;
  double pinion_axial_stiffness; /* N/m, used with EO_AXIAL_SPRING */
  double stagger;                /* right end behind the left, in transverse base pitches, 0..1 */
};

enum eo_torsional_coupling { EO_COUPLING_PAPER, EO_COUPLING_OFF, EO_COUPLING_ON };
enum eo_impact_in_dynamics { EO_IMPACT_NONE, EO_IMPACT_PAPER, EO_IMPACT_CONSISTENT };

struct eo_supports {
  double bearing_stiffness[2];                   /* k_py, k_gy per end, N/m */
  double gear_axial_stiffness[2];                /* k_g1z, k_g2z [end], N/m */
  double groove_axial_stiffness[2];              /* k_pz, k_gz, N/m; NaN: E A / L of the groove body */
  double groove_torsional_stiffness[2];          /* N m/rad; NaN: G J / L of the groove body */
  enum eo_torsional_coupling torsional_coupling; /* paper: off for equal ends, on when they differ */
  double mass[2];    /* of one end with half the groove, kg; NaN: solid of the pitch cylinder */
  double inertia[2]; /* likewise, kg m2 */
  double bearing_damping_ratio;
  double groove_damping_ratio;
  double mesh_damping_ratio;
  double mesh_damping_stiffness; /* k in c_m = 2 zeta sqrt(k m_e)/cos b, N/m; NaN: the mean mesh stiffness of the load
                                    case */
};

/* Torsional wind-up and bending of the two bodies in their bearings (off by default; contact/shaft.h says how).
   Positions are measured from the middle of the groove (of the face, with one end), + to the right. The bore runs
   through. */
enum eo_drive_side { EO_DRIVE_LEFT, EO_DRIVE_RIGHT };
struct eo_shafts {
  bool enabled;
  double bearing_position[2][2]; /* [member][left, right], m; NaN: face end + half a face width outside */
  double shaft_diameter[2]; /* outside the toothed body, m; NaN: 0.8 of the groove diameter, at least midway from the
                               bore to it */
  enum eo_drive_side drive_side[2]; /* where torque enters the pinion and leaves the gear */
};

struct eo_load_case {
  double torque; /* total on the pinion shaft, N m, > 0 */
  double speed;  /* pinion, rad/s, > 0 */
  double share;  /* of operating time; they sum to 1 */
};

/* What is taken off one flank, normal to it; positive removes material. u: rack coordinate, x = eta / cos(beta). */
enum eo_relief_shape { EO_RELIEF_PARABOLIC, EO_RELIEF_LINEAR, EO_RELIEF_CIRCULAR };
struct eo_flank_modification {
  enum eo_relief_shape shape;
  double tip_relief;           /* d_tr at the end of the active profile, m */
  double tip_relief_start;     /* u_ts, distance from the pitch line along the rack profile, m, >= 0 */
  double root_relief;          /* d_br, m */
  double root_relief_start;    /* u_bs, m, >= 0 */
  double profile_crowning;     /* a_m, 1/m: a_m u^2 over the middle part */
  double lead_crowning;        /* a_l (b / (2 cos beta))^2: at the face ends, m */
  double lead_slope;           /* b_l x at x = + b / (2 cos beta), m */
  double lead_offset;          /* c_l, m */
  double end_relief[2];        /* [at eta = -b/2, at eta = +b/2], parabolic, m */
  double end_relief_length[2]; /* from the face end, axial, m */
};

struct eo_modification {
  struct eo_flank_modification flank[2][2]; /* [member][end] */
};

struct eo_constraint {
  bool enabled;
  double limit;
};

enum eo_normalise { EO_NORMALISE_UNMODIFIED, EO_NORMALISE_NONE };
enum eo_robust { EO_ROBUST_OFF, EO_ROBUST_MEAN, EO_ROBUST_WORST };
struct eo_objective {
  double weight[3];
  enum eo_normalise normalise;
  struct eo_constraint contact_pressure; /* Pa */
  struct eo_constraint root_stress;      /* Pa */
  struct eo_constraint peak_to_peak;     /* PPLTE, m */
  struct eo_constraint edge_load_share;  /* static load on tip-edge points, share of P */
  struct eo_constraint contact_loss;     /* fraction of the mesh cycle out of contact */
  bool relief_inside_active_flank;
  bool no_worse_than_unmodified;
  double penalty; /* factor on every violated constraint */
  enum eo_robust robust;
  int scenarios; /* number of rows below */
  struct eo_scenario {
    double in_plane, out_of_plane, compliance, speed;
  } scenario[EO_MAX_SCENARIOS]; /* rad, rad (NaN: nominal), factor, factor */
};

enum eo_variable_set { EO_VARIABLES_SHARED, EO_VARIABLES_PER_END, EO_VARIABLES_LISTED };
enum { EO_BOTH_ENDS = 2, EO_MAX_LISTED = 48 };
struct eo_range {
  double low, high;
};

/* A modification parameter to be optimized, chosen by its key, on one end or alike on both. */
struct eo_listed_variable {
  int member, end;        /* end: EO_LEFT, EO_RIGHT, EO_BOTH_ENDS */
  int parameter;          /* index of eo_variable_parameters in document/design_document.h */
  struct eo_range bounds; /* in the unit of the parameter's key; NaN: the bounds of the optimization */
};

struct eo_optimization {
  enum eo_variable_set variables;
  int listed; /* rows below, with EO_VARIABLES_LISTED */
  struct eo_listed_variable list[EO_MAX_LISTED];
  char algorithm[32];
  struct eo_range tip_relief, root_relief, tip_relief_start, root_relief_start, lead_crowning; /* m; NaN: derived */

  /* What the optimizer can be told, member by member as in its own table (optimizer/settings.h), which also explains
     it. Choices are indices there. */
  int true_evaluations; /* budget; 0: none stated */
  double crossover, crossover_index, mutation, mutation_index;
  int mutation_mode;
  int population, generations, elite, fitness_form;
  double trust_threshold, redundancy_threshold; /* R*, I_r* */
  double share_radius;                          /* r_share; NaN: 0.03 (n/5)^1.9 for n variables */
  double weight_decay, credibility_loss;        /* alpha of (15), beta of (18) */
  double removal_threshold;                     /* R_0 < R* */
  int verify, distance_norm, weight_sum, decision_order;
  bool store_predicted, literal_redundancy, reuse;
  int batch, initial_factor, model_rows, children;
  double exploration, credibility_length, taboo_radius;
  int stall_batches;
  double stall_gain, polish_share, local_share, local_radius, sampling_step, evolution_step;
  int sampling_stall, evolution_samples, evolution_stall;
  int front_population, front_verified, front_rounds;
  uint64_t seed;
};

enum eo_mesh_law { EO_LAW_TANGENT, EO_LAW_SECANT, EO_LAW_TABLE };
enum eo_solver { EO_SOLVER_HARMONIC_BALANCE, EO_SOLVER_TIME_INTEGRATION };
struct eo_resolution {
  int positions; /* mesh positions over one base pitch */
  int cells_per_line;
  bool tip_edge_contact;
  int sector_teeth; /* 3 or 5 */
  bool neighbour_coupling;
  int layers;               /* of the finite-element mesh over the face width */
  int flank_rows;           /* elements over the active profile */
  int fillet_elements;      /* along the loaded fillet */
  double impact_patch;      /* length of the impact patch, m */
  double marking_thickness; /* of the contact pattern, m */
  enum eo_mesh_law mesh_law;
  enum eo_solver solver;
  enum eo_impact_in_dynamics impact_in_dynamics;
  int harmonics;    /* of the harmonic balance */
  int te_harmonics; /* mesh harmonics kept of Z and k_tan */
};

struct eo_design {
  char name[EO_NAME_LENGTH];
  struct eo_gear_pair gear_pair;
  struct eo_material material;
  struct eo_alignment alignment;
  struct eo_supports supports;
  struct eo_shafts shafts;
  int load_cases;
  struct eo_load_case load_case[EO_MAX_LOAD_CASES];
  struct eo_modification modification;
  struct eo_objective objective;
  struct eo_optimization optimization;
  struct eo_resolution resolution;
};

struct eo_geometry;

/* Puts the derived default in place of every NaN whose rule does not need the loaded contact (mesh_damping_stiffness
   stays NaN: it is the mean mesh stiffness of each load case). geometry: of design->gear_pair. Idempotent; cannot fail.
 */
void eo_design_resolve(struct eo_design *design, const struct eo_geometry *geometry);

#endif

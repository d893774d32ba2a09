/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables of the duty cycle, the objective, the optimization and the resolution, and of the whole design. */
#include "document/design_document.h"
#include "document/design_migration.h"
#include "document/pitch_document.h"
#include "document/search_space.h"
#include "evaluation/scalar.h"
#include "flexibility/flexibility.h"
#include "gear/names.h"

/* clang-format off */
#define NUMBERS(...) (const double[]){__VA_ARGS__}
/* clang-format on */

static const char *const power[] = {"power_kW", NULL};
static const char *const directions[] = {"ahead", "astern", NULL};

static const struct eo_field case_alignment[] = {
    EO_NUMBER_DERIVED(struct eo_case_alignment, in_plane, "shaft_angle_error_in_plane_deg", &eo_unit_deg, -2, 2,
                      "as the design's alignment", "shaft angle error in the plane of the axes"),
    EO_NUMBER_DERIVED(struct eo_case_alignment, out_of_plane, "shaft_angle_error_out_of_plane_deg", &eo_unit_deg, -2, 2,
                      "as the design's alignment", "shaft angle error out of the plane of the axes"),
    EO_NUMBER_DERIVED(struct eo_case_alignment, deviation_in_plane, "shaft_angle_error_in_plane_um", &eo_unit_um, -1e5,
                      1e5, "as shaft_angle_error_in_plane_deg says", "the same over the face width of one end"),
    EO_NUMBER_DERIVED(struct eo_case_alignment, deviation_out_of_plane, "shaft_angle_error_out_of_plane_um",
                      &eo_unit_um, -1e5, 1e5, "as shaft_angle_error_out_of_plane_deg says",
                      "the same over the face width of one end"),
};
static const struct eo_table case_alignment_table = EO_TABLE("a load case's alignment", struct eo_case_alignment,
                                                             case_alignment);

static const struct eo_field load_case[] = {
    {.key = "torque_Nm",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_load_case, torque),
     .unit = &eo_unit_Nm,
     .low = -1e8,
     .high = 1e8,
     .fallback = NAN,
     .instead = power,
     .help = "total on the pinion shaft, half of it per end; 0.001 or more; of another sign than the speed: the gear "
             "drives"},
    EO_NUMBER_ENTRY(struct eo_load_case, power, "power_kW", "torque_Nm", &eo_unit_kW, -1e6, 1e6,
                    "of the pinion shaft: the torque is power over speed; below 0: the gear drives"),
    EO_NUMBER_REQUIRED(struct eo_load_case, speed, "speed_rpm", &eo_unit_rpm, -1e6, 1e6,
                       "of the pinion, 0.1 or more; below 0: astern"),
    EO_NUMBER_DERIVED(struct eo_load_case, share, "share", NULL, 0, 1e6, "equal, when no load case states its share",
                      "of operating time; shares that do not sum to 1 are scaled, with a warning"),
    EO_NUMBER_DERIVED(struct eo_load_case, hours, "hours", NULL, 0, 1e7, "shares are stated",
                      "of operating time, in all load cases or in none; shares follow from them"),
    EO_TEXT(struct eo_load_case, name, "name", "for people"),
    EO_CHOICE(struct eo_load_case, direction, "direction", directions, EO_AHEAD,
              "of rotation; astern the coast flanks carry"),
    EO_CHOICE(
        struct eo_load_case, driver, "driver", eo_member_name, EO_PINION,
        "which member drives; a gear that drives only here, as in overrun, does so with the coast flanks, one that "
        "drives in every load case, as in a speed increaser, with the drive flanks"),
    EO_OPTIONAL(struct eo_load_case, alignment, has_alignment, "alignment", &case_alignment_table,
                "as the design's alignment", "shaft angle errors of this load case"),
};

static const char *const normalise[] = {"unmodified", "none", NULL};
static const char *const robust[] = {"off", "mean", "worst", "percentile", "mean_plus_sigmas", NULL};

static const struct eo_field constraints[] = {
    EO_NUMBER_DERIVED(struct eo_objective, contact_pressure, "contact_pressure_MPa", &eo_unit_MPa, 1, 1e5, "off",
                      "largest Hertz pressure"),
    EO_NUMBER_DERIVED(struct eo_objective, root_stress, "root_stress_MPa", &eo_unit_MPa, 1, 1e5, "off",
                      "largest root bending stress"),
    EO_NUMBER_DERIVED(struct eo_objective, peak_to_peak, "peak_to_peak_um", &eo_unit_um, 1e-3, 1e4, "off",
                      "peak-to-peak loaded transmission error of any load case"),
    EO_NUMBER_DERIVED(struct eo_objective, edge_load_share, "edge_load_share", NULL, 0, 1, "off",
                      "static load carried by tip edges, share of the end's load"),
    EO_NUMBER_DERIVED(struct eo_objective, contact_loss, "contact_loss", NULL, 0, 1, "off",
                      "part of the mesh cycle out of contact"),
    EO_NUMBER_DERIVED(struct eo_objective, flank_safety, "flank_safety", NULL, 0.01, 100, "off",
                      "least S_H over members and ends, Miner over the required life and static; by the block rating"),
    EO_NUMBER_DERIVED(struct eo_objective, root_safety, "root_safety", NULL, 0.01, 100, "off", "least S_F, the same"),
    EO_NUMBER_DERIVED(struct eo_objective, film_ratio, "film_ratio", NULL, 1e-3, 100, "off",
                      "least specific film thickness"),
    EO_NUMBER_DERIVED(struct eo_objective, contact_temperature, "contact_temperature_C", &eo_unit_C, -40, 2000, "off",
                      "largest temperature of teeth and flash"),
    EO_FLAG(struct eo_objective, relief_inside_active_flank, "relief_inside_active_flank", 1,
            "reliefs must start inside the active flank"),
    EO_FLAG(struct eo_objective, no_worse_than_unmodified, "no_worse_than_unmodified", 0,
            "no objective may be worse than unmodified at any load case"),
};
static const struct eo_table constraints_table = EO_TABLE("constraints", struct eo_objective, constraints);

static const struct eo_field scenario[] = {
    EO_NUMBER_DERIVED(struct eo_scenario, in_plane, "shaft_angle_error_in_plane_deg", &eo_unit_deg, -2, 2,
                      "as in alignment", "shaft angle error in the plane of the axes"),
    EO_NUMBER_DERIVED(struct eo_scenario, out_of_plane, "shaft_angle_error_out_of_plane_deg", &eo_unit_deg, -2, 2,
                      "as in alignment", "shaft angle error out of the plane of the axes"),
    EO_NUMBER(struct eo_scenario, compliance, "compliance_factor", NULL, 0.1, 10, 1, "on the flexibility of the teeth"),
    EO_NUMBER(struct eo_scenario, speed, "speed_factor", NULL, 0.01, 100, 1, "on the speed of every load case"),
};
const struct eo_table eo_scenario_table = EO_TABLE("a scenario", struct eo_scenario, scenario);

#define PERCENT(type, fallback_)                                        \
  EO_NUMBER_DERIVED(type, percent, "percent", NULL, 50, 100, fallback_, \
                    "percentile of its values over the states of a robust objective: pairs as made, or scenarios")
#define LOAD_CASE(type, fallback_) \
  EO_INTEGER_DERIVED(type, load_case, "load_case", 1, EO_MAX_LOAD_CASES, fallback_, "which load case, from 1")
#define OUTPUT(type, help_)                                                                                 \
  {                                                                                                         \
    .key = "output", .kind = EO_FIELD_CHOICE, .flags = EO_FIELD_REQUIRED, .offset = offsetof(type, output), \
    .choices = eo_scalar_keys, .fallback = NAN, .help = help_                                               \
  }
static const struct eo_field term[] = {
    OUTPUT(struct eo_objective_term, "a number of the load cases, as tolerance.limits name them"),
    LOAD_CASE(struct eo_objective_term, "the mean over the duty cycle, by share of time"),
    EO_NUMBER(struct eo_objective_term, weight, "weight", NULL, 0, 1e6, 1,
              "in the sum J, in addition to f1, f2 and f3"),
    EO_NUMBER_DERIVED(struct eo_objective_term, scale, "scale", NULL, 1e-9, 1e9,
                      "the unmodified pair's, or 1 with normalise none",
                      "what it is divided by, in the unit of the output"),
    PERCENT(struct eo_objective_term, "part of J in every state, as f1, f2 and f3"),
};
static const struct eo_table term_table = EO_TABLE("a term of the objective", struct eo_objective_term, term);

static const struct eo_field limit[] = {
    OUTPUT(struct eo_objective_limit, "a number of the load cases, as tolerance.limits name them"),
    LOAD_CASE(struct eo_objective_limit, "every one"),
    EO_NUMBER_REQUIRED(struct eo_objective_limit, most, "at_most", NULL, -1e9, 1e9, "in the unit of the output"),
    PERCENT(struct eo_objective_limit, "every state keeps to it"),
};
static const struct eo_table limit_table = EO_TABLE("a limit of the objective", struct eo_objective_limit, limit);

static const struct eo_field objective[] = {
    EO_NUMBERS(struct eo_objective, weight, "weights", 3, NULL, 0, 1e6, 0, NUMBERS(0.4, 0.15, 0.45), NULL,
               "of peak-to-peak transmission error, impact force and vibration"),
    EO_CHOICE(struct eo_objective, normalise, "normalise", normalise, EO_NORMALISE_UNMODIFIED,
              "what each objective is divided by"),
    EO_GROUP("constraints", &constraints_table, "limits; null: off"),
    EO_NUMBER(struct eo_objective, penalty, "penalty", NULL, 0, 1e9, 10,
              "factor on the relative excess over each limit"),
    EO_CHOICE(struct eo_objective, robust, "robust", robust, EO_ROBUST_OFF,
              "objective over the scenarios: their mean, the worst, a percentile, the mean and a number of standard "
              "deviations, or the nominal one alone; limits hold in every scenario"),
    EO_NUMBER(struct eo_objective, robust_percent, "robust_percent", NULL, 50, 99, 95,
              "with robust percentile: which one of J over the scenarios, as of f1, f2, f3 each"),
    EO_NUMBER(struct eo_objective, robust_sigmas, "robust_sigmas", NULL, 0, 10, 2,
              "with robust mean_plus_sigmas: how many standard deviations"),
    EO_INTEGER_DERIVED(
        struct eo_objective, scatter_pairs, "scatter_pairs", 2, EO_MAX_DRAWN_PAIRS, "none: the scenarios count",
        "pairs as made, drawn from the block tolerance, that stand in place of the scenarios when robust is not "
        "off: the same deviations for every flank that is tried; each costs an evaluation"),
    EO_INTEGER_DERIVED(
        struct eo_objective, first_pairs, "first_pairs", 2, EO_MAX_DRAWN_PAIRS,
        "2 of more than 4 scatter_pairs, all of them where a front is sought",
        "of scatter_pairs: every flank is looked at with these; of each batch the best go on to all, so many that "
        "this costs less than the first look; as many as scatter_pairs: every flank with all"),
    EO_INTEGER(
        struct eo_objective, check_pairs, "check_pairs", 0, 10000, 200,
        "other pairs as made, on which a search with scatter_pairs ends: what it found compared with the unmodified "
        "pair, with intervals; 0: none"),
    EO_LIST(struct eo_objective, term, terms, "terms", &term_table, 0, EO_MAX_OBJECTIVE_TERMS,
            "further numbers in the sum J, or on the axes of a front"),
    EO_LIST(struct eo_objective, limit, limits, "limits", &limit_table, 0, EO_MAX_OBJECTIVE_LIMITS,
            "what further numbers keep to"),
    {.key = "scenarios",
     .kind = EO_FIELD_LIST,
     .offset = offsetof(struct eo_objective, scenario),
     .low = 0,
     .high = EO_MAX_SCENARIOS,
     .count = EO_MAX_SCENARIOS,
     .count_offset = offsetof(struct eo_objective, scenarios),
     .table = &eo_scenario_table,
     .derived =
         "nominal; shaft error +-20 % (at least 0.01 deg); compliance +-10 %; speed +-5 %, when robust is not off",
     .help = "alignments, compliances and speeds around the nominal ones"},
};

static const char *const fronts[] = {"objectives", "nominal_and_robust", "terms", NULL};
static const char *const variables[] = {"shared", "per_end", "listed", NULL};
static const char *const variable_flanks[] = {"drive", "coast", "both", NULL};
/* clang-format off */
/* What a row of EO_OPTIMIZER_SETTINGS (optimizer/settings.h) becomes here. */
#define SEED(member, fallback_, help_)                                                                     \
  {.key = #member, .kind = EO_FIELD_SEED, .offset = offsetof(struct eo_optimization, search.member), .low = 0, \
   .high = 9007199254740991., .fallback = fallback_, .help = help_},
#define BUDGET(member, low_, high_, derived_, help_)                                                           \
  EO_INTEGER_DERIVED(struct eo_optimization, search.member, #member, low_, high_, derived_, help_),
#define PARAMETER(member, low, high, fallback, help) \
  EO_NUMBER(struct eo_optimization, search.member, #member, NULL, low, high, fallback, help),
#define DERIVED(member, low, high, derived, help) \
  EO_NUMBER_DERIVED(struct eo_optimization, search.member, #member, NULL, low, high, derived, help),
#define COUNT(member, low, high, fallback, help) \
  EO_INTEGER(struct eo_optimization, search.member, #member, low, high, fallback, help),
#define FLAG(member, fallback, help) EO_FLAG(struct eo_optimization, search.member, #member, fallback, help),
#define CHOICE(member, choices, fallback, help) \
  EO_CHOICE(struct eo_optimization, search.member, #member, choices, fallback, help),
/* clang-format on */

#define MOST_RELIEF "0 .. 0.02 m_n, the largest tip relief of BS 436-2"

static const struct eo_field bounds[] = {
    EO_NUMBERS(struct eo_optimization, tip_relief, "tip_relief_um", 2, &eo_unit_um, 0, 1000,
               EO_FIELD_ASCENDING | EO_FIELD_NULLABLE, NULL, MOST_RELIEF, "d_tr"),
    EO_NUMBERS(struct eo_optimization, root_relief, "root_relief_um", 2, &eo_unit_um, 0, 1000,
               EO_FIELD_ASCENDING | EO_FIELD_NULLABLE, NULL, MOST_RELIEF, "d_br"),
    EO_NUMBERS(struct eo_optimization, tip_relief_start, "tip_relief_start_mm", 2, &eo_unit_mm, 0, 200,
               EO_FIELD_ASCENDING | EO_FIELD_NULLABLE, NULL, "0.05 m_n .. nine tenths of the active profile", "u_ts"),
    EO_NUMBERS(struct eo_optimization, root_relief_start, "root_relief_start_mm", 2, &eo_unit_mm, 0, 200,
               EO_FIELD_ASCENDING | EO_FIELD_NULLABLE, NULL, "0.05 m_n .. nine tenths of the active profile", "u_bs"),
    EO_NUMBERS(struct eo_optimization, lead_crowning, "lead_crowning_um", 2, &eo_unit_um, 0, 1000,
               EO_FIELD_ASCENDING | EO_FIELD_NULLABLE, NULL, "0 .. 40 um, the largest crowning of ISO 6336-1 annex B",
               "at the face ends"),
};
static const struct eo_table bounds_table = EO_TABLE("bounds", struct eo_optimization, bounds);

static const struct eo_field listed_variable[] = {
    EO_CHOICE(struct eo_listed_variable, member, "member", eo_member_name, EO_PINION, "whose flank"),
    EO_CHOICE(struct eo_listed_variable, end, "end", eo_variable_end_name, EO_BOTH_ENDS,
              "which end; both: one variable for both ends"),
    EO_CHOICE(struct eo_listed_variable, flank, "flank", variable_flanks, EO_DRIVE_FLANK,
              "which flank; both: one variable for the drive and the coast flank"),
    {.key = "parameter",
     .kind = EO_FIELD_CHOICE,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_listed_variable, parameter),
     .choices = eo_variable_parameters,
     .fallback = NAN,
     .help = "key of the flank's modification; " EO_GRID_PARAMETER
             ": numbers of its grid, one for all the knots that row and column name"},
    EO_INTEGER(struct eo_listed_variable, row, "row", 0, EO_GRID_KNOTS, 0,
               "of " EO_GRID_PARAMETER ": row of the grid (place u), from 1 at the root; 0: all"),
    EO_INTEGER(struct eo_listed_variable, column, "column", 0, EO_GRID_KNOTS, 0,
               "of " EO_GRID_PARAMETER ": column of the grid (place y), from 1 on the side that meets last; 0: all"),
    EO_NUMBERS(struct eo_listed_variable, bounds, "bounds", 2, NULL, -10000, 1e6,
               EO_FIELD_ASCENDING | EO_FIELD_NULLABLE, NULL, "those of the same key in bounds",
               "lowest and highest value in the unit of the parameter's key"),
};
static const struct eo_table listed_variable_table = EO_TABLE("a variable", struct eo_listed_variable, listed_variable);

static const struct eo_field optimization[] = {
    EO_CHOICE(struct eo_optimization, variables, "variables", variables, EO_VARIABLES_SHARED,
              "5 of the pinion shared by both ends (case A), 10, 5 per end (case B), or those in variable_list"),
    EO_LIST(struct eo_optimization, list, listed, "variable_list", &listed_variable_table, 0, EO_MAX_LISTED,
            "the variables, when variables is listed"),
    EO_CHOICE(struct eo_optimization, search.algorithm, "algorithm", eo_algorithm_names, EO_CREDIBILITY_GA,
              "optimizer"),
    EO_CHOICE(struct eo_optimization, front, "front", fronts, EO_FRONT_OBJECTIVES,
              "what the front is over: f1, f2 and f3; J of the nominal pair against the robust J; or the terms of the "
              "objective (nsga2)"),
    EO_GROUP("bounds", &bounds_table, "lowest and highest value of each variable"),
    EO_OPTIMIZER_SETTINGS(SEED, BUDGET, PARAMETER, DERIVED, COUNT, FLAG, CHOICE)};

static const char *const mesh_laws[] = {"tangent", "secant", "table", NULL};
static const char *const solvers[] = {"harmonic_balance", "time_integration", NULL};
static const char *const impacts[] = {"none", "paper", "consistent", NULL};

static const char *const bodies[] = {"ring", "sector", NULL};
static const char *const body_supports[] = {"floating", "held", "held_at_bore", NULL};

static const struct eo_field resolution[] = {
    EO_INTEGER(struct eo_resolution, positions, "positions", 8, 1024, 64, "mesh positions over one base pitch"),
    EO_INTEGER_DERIVED(struct eo_resolution, cells_per_line, "cells_per_line", EO_CELLS_LEAST, EO_CELLS_MOST,
                       "30, fewer where so many contact lines lie on a wide face that they would be too many together",
                       "equal cells of a contact line"),
    EO_FLAG(struct eo_resolution, tip_edge_contact, "tip_edge_contact", 1,
            "contact of the tip edges outside the path of contact"),
    {.key = "body",
     .kind = EO_FIELD_CHOICE,
     .offset = offsetof(struct eo_resolution, elements.body),
     .choices = bodies,
     .fallback = EO_BODY_RING,
     .elder_key = "sector_teeth",
     .elder_choice = EO_BODY_SECTOR,
     .help = "of the finite elements: the ring of all teeth, or a sector of sector_teeth teeth with held cut faces; a "
             "document that names sector_teeth but no body, as older ones do, means the sector"},
    EO_CHOICE(struct eo_resolution, elements.support, "body_support", body_supports, EO_SUPPORT_FLOATING,
              "of the ring: floating = deflection relative to the mean rigid motion of the body in its plane; held at "
              "the depth of rim_thickness_coefficient; or at the bore, where members without one float"),
    EO_FLAG(struct eo_resolution, hub_windup, "hub_windup", 0,
            "state the wind-up of hubs that take their torque through a bore, as a line of its own"),
    EO_INTEGER(struct eo_resolution, elements.sector_teeth, "sector_teeth", EO_SECTOR_TEETH_LEAST, EO_SECTOR_TEETH_MOST,
               EO_SECTOR_TEETH_MOST, "teeth of the sector, odd: the loaded one is in its middle; with body \"sector\""),
    EO_FLAG(struct eo_resolution, elements.neighbour_coupling, "neighbour_coupling", 1,
            "compliance between tooth pairs: of a sector the next ones, of a ring all in contact at once"),
    EO_INTEGER(struct eo_resolution, elements.layers, "layers", EO_LAYERS_LEAST, EO_LAYERS_MOST, 28,
               "finite elements over the face width"),
    EO_INTEGER(struct eo_resolution, elements.flank_rows, "flank_rows", EO_FLANK_ROWS_LEAST, EO_FLANK_ROWS_MOST, 10,
               "finite elements over the active profile"),
    EO_INTEGER(struct eo_resolution, elements.fillet_elements, "fillet_elements", EO_FILLET_ELEMENTS_LEAST,
               EO_FILLET_ELEMENTS_MOST, 18, "finite elements along the loaded fillet"),
    EO_NUMBER_DERIVED(struct eo_resolution, impact_patch, "impact_patch_mm", &eo_unit_mm, 0.01, 100,
                      "5/6 m_n, at most the face width", "length of the patch that an entering impact loads"),
    EO_NUMBER(struct eo_resolution, marking_thickness, "marking_thickness_um", &eo_unit_um, 0.1, 100, 6.35,
              "marking compound of the contact pattern"),
    EO_CHOICE(struct eo_resolution, mesh_law, "mesh_law", mesh_laws, EO_LAW_TANGENT, "mesh force in the dynamics"),
    EO_CHOICE(struct eo_resolution, solver, "solver", solvers, EO_SOLVER_HARMONIC_BALANCE,
              "of the equations of motion"),
    EO_CHOICE(struct eo_resolution, impact_in_dynamics, "impact_in_dynamics", impacts, EO_IMPACT_NONE,
              "impact pulses in the equations of motion"),
    EO_INTEGER(struct eo_resolution, harmonics, "harmonics", 1, 256, 24, "mesh harmonics of the response"),
    EO_INTEGER_DERIVED(struct eo_resolution, te_harmonics, "te_harmonics", 1, 128, "16, at most half the positions",
                       "mesh harmonics kept of transmission error and stiffness"),
};

const struct eo_table eo_load_case_table = EO_TABLE("a load case", struct eo_load_case, load_case);
const struct eo_table eo_objective_table = EO_TABLE("objective", struct eo_objective, objective);
static const struct eo_table optimization_table = EO_TABLE("optimization", struct eo_optimization, optimization);
const struct eo_table eo_resolution_table = EO_TABLE("resolution", struct eo_resolution, resolution);

static const struct eo_field design[] = {
    {.key = "version",
     .kind = EO_FIELD_INTEGER,
     .offset = offsetof(struct eo_design, version),
     .low = 1,
     .high = EO_DESIGN_VERSION,
     .fallback = EO_DESIGN_VERSION,
     .help = "of the document: which defaults stand for what it leaves out; an older one is migrated, with a note"},
    {.key = "name",
     .kind = EO_FIELD_TEXT,
     .offset = offsetof(struct eo_design, name),
     .count = EO_NAME_LENGTH,
     .help = "for people"},
    EO_OBJECT(struct eo_design, gear_pair, "gear_pair", &eo_gear_pair_table, "macro-geometry"),
    EO_OBJECT(struct eo_design, material, "material", &eo_material_table, "of both members"),
    EO_OBJECT(struct eo_design, alignment, "alignment", &eo_alignment_table, "errors and axial freedom of the shafts"),
    EO_OBJECT(struct eo_design, supports, "supports", &eo_supports_table,
              "bearings, groove and masses for the dynamics"),
    EO_OBJECT(struct eo_design, shafts, "shafts", &eo_shafts_table, "elastic bodies, off by default"),
    EO_LIST(struct eo_design, load_case, load_cases, "load_cases", &eo_load_case_table, 1, EO_MAX_LOAD_CASES,
            "the duty cycle; none is assumed"),
    EO_OBJECT(struct eo_design, modification, "modification", &eo_modification_table, "material taken off the flanks"),
    {.key = "rating",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_OMIT,
     .offset = offsetof(struct eo_design, rating),
     .table = &eo_rating_table,
     .help = "what the rating by ISO 6336 goes by; absent: the defaults"},
    {.key = "pitch",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_ELSEWHERE | EO_FIELD_NULLABLE,
     .table = &eo_pitch_table,
     .derived = "teeth are alike",
     .help = "deviations of single teeth: what they do over the hunting period stands in the result's pitch"},
    {.key = "tolerance",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_OMIT,
     .offset = offsetof(struct eo_design, tolerance),
     .table = &eo_tolerance_table,
     .help = "how the gears as made scatter; absent: as drawn"},
    EO_OBJECT(struct eo_design, objective, "objective", &eo_objective_table, "what is good"),
    EO_OBJECT(struct eo_design, optimization, "optimization", &optimization_table, "how the best is searched for"),
    EO_OBJECT(struct eo_design, resolution, "resolution", &eo_resolution_table, "how finely it is computed"),
};
const struct eo_table eo_design_table = EO_TABLE("the design", struct eo_design, design);

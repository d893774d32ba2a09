/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables of the flank modifications: terms by name after ISO 21771, in the drawing's words. */
#include "document/design_document.h"

#include "document/flank_grid_document.h"

enum { TO_MM = 1000000 };

static const char *const relief_shape[] = {"parabolic", "linear", "circular", "exponent", NULL};
static const char *const own_shape[] = {"as_relief_shape", "parabolic", "linear", "circular", "exponent", NULL};

/* Shapes, and ways to state a start that stand in place of the rack coordinate. */
#define SHAPE(member, key, choices, fallback, help) \
  EO_CHOICE(struct eo_flank_modification, member, key, choices, fallback, help),
#define FLANK_SHAPES                                                                                        \
  SHAPE(shape, "relief_shape", relief_shape, EO_RELIEF_PARABOLIC, "of tip and root relief")                 \
  SHAPE(own_shape[EO_TIP_SIDE], "tip_relief_shape", own_shape, EO_RELIEF_AS_SHARED,                         \
        "of the tip relief; circular: an arc that is tangent at the start")                                 \
  SHAPE(own_shape[EO_ROOT_SIDE], "root_relief_shape", own_shape, EO_RELIEF_AS_SHARED, "of the root relief") \
  SHAPE(end_shape[EO_LEADING_SIDE], "leading_end_relief_shape", relief_shape, EO_RELIEF_PARABOLIC,          \
        "of the relief at the face end that meets first")                                                   \
  SHAPE(end_shape[EO_TRAILING_SIDE], "trailing_end_relief_shape", relief_shape, EO_RELIEF_PARABOLIC,        \
        "of the relief at the face end that meets last")

/* The four ways to state where a relief starts. */
#define FLANK_START(PLACE, side, name, end)                                                                            \
  PLACE(place[side].diameter, name "_relief_diameter_mm", &eo_unit_mm, TO_MM, "as " name "_relief_start_mm says",      \
        "diameter at which the " name " relief starts")                                                                \
  PLACE(place[side].roll_length, name "_relief_roll_length_mm", &eo_unit_mm, TO_MM,                                    \
        "as " name "_relief_start_mm says",                                                                            \
        "length of roll, from the base circle, at which the " name " relief starts")                                   \
  PLACE(place[side].roll_angle, name "_relief_roll_angle_deg", &eo_unit_deg, 3600, "as " name "_relief_start_mm says", \
        "roll angle, from the base circle, at which the " name " relief starts")                                       \
  PLACE(place[side].length, name "_relief_length_mm", &eo_unit_mm, TO_MM, "as " name "_relief_start_mm says",          \
        "length of the " name " relief along the path of contact, from the " end " end of the active profile")

#define FLANK_TRIANGLE(NUMBER, side, face, name, where)                                                       \
  NUMBER(triangular[side][face].amount, name "_triangular_relief_um", &eo_unit_um, 0, 1000, 0,                \
         "triangular relief, normal, at the corner: " where)                                                  \
  NUMBER(triangular[side][face].profile_length, name "_triangular_profile_length_mm", &eo_unit_mm, 0, 200, 0, \
         "from that corner along the rack profile (u)")                                                       \
  NUMBER(triangular[side][face].face_length, name "_triangular_face_length_mm", &eo_unit_mm, 0, 5000, 0,      \
         "from that corner along the face")                                                                   \
  NUMBER(triangular[side][face].exponent, name "_triangular_exponent", NULL, 1, 10, 1,                        \
         "of the relief over the distance: 1 flat, 2 parabolic")

/* Every number of a flank: once for the table, once for what an optimization may vary. The paper's five first. */
#define FLANK_NUMBERS(NUMBER, PLACE)                                                                               \
  NUMBER(tip_relief, "tip_relief_um", &eo_unit_um, 0, 1000, 0,                                                     \
         "at the tip end of the active profile, normal (C_alphaa, d_tr)")                                          \
  NUMBER(root_relief, "root_relief_um", &eo_unit_um, 0, 1000, 0,                                                   \
         "at the root end of the active profile, normal (C_alphaf, d_br)")                                         \
  NUMBER(tip_relief_start, "tip_relief_start_mm", &eo_unit_mm, 0, 200, 0,                                          \
         "distance of its start from the pitch point along the rack profile (u_ts); 0 where another way is taken") \
  NUMBER(root_relief_start, "root_relief_start_mm", &eo_unit_mm, 0, 200, 0,                                        \
         "distance of its start from the pitch point along the rack profile (u_bs); 0 where another way is taken") \
  NUMBER(lead_crowning, "lead_crowning_um", &eo_unit_um, -1000, 1000, 0,                                           \
         "at the face ends (C_beta): a_l (b/(2 cos beta))^2")                                                      \
  NUMBER(lead_offset, "lead_offset_um", &eo_unit_um, -1000, 1000, 0, "over the whole flank (c_l)")                 \
  NUMBER(profile_crowning, "profile_crowning_per_mm", &eo_unit_per_mm, -1, 1, 0,                                   \
         "coefficient a_m of the parabola a_m u^2 between the starts")                                             \
  NUMBER(end_relief[EO_LEADING_SIDE], "leading_end_relief_um", &eo_unit_um, 0, 1000, 0,                            \
         "at the face end that meets first (C_beta I, II)")                                                        \
  NUMBER(end_relief_length[EO_LEADING_SIDE], "leading_end_relief_length_mm", &eo_unit_mm, 0, 5000, 0,              \
         "axial, from that face end")                                                                              \
  NUMBER(end_relief[EO_TRAILING_SIDE], "trailing_end_relief_um", &eo_unit_um, 0, 1000, 0,                          \
         "at the face end that meets last")                                                                        \
  NUMBER(end_relief_length[EO_TRAILING_SIDE], "trailing_end_relief_length_mm", &eo_unit_mm, 0, 5000, 0,            \
         "axial, from that face end")                                                                              \
  NUMBER(profile_slope, "profile_slope_um", &eo_unit_um, -1000, 1000, 0,                                           \
         "C_Halpha: from end to end of the active profile, + takes more off at the tip")                           \
  NUMBER(profile_barrel, "profile_crowning_um", &eo_unit_um, -1000, 1000, 0,                                       \
         "C_alpha: at both ends of the active profile, 0 in its middle")                                           \
  NUMBER(twist, "twist_um", &eo_unit_um, -1000, 1000, 0,                                                           \
         "S_alpha: change of the profile slope from one face end to the other; a quarter of it at the corners")    \
  FLANK_START(PLACE, EO_TIP_SIDE, "tip", "tip")                                                                    \
  FLANK_START(PLACE, EO_ROOT_SIDE, "root", "root")                                                                 \
  NUMBER(exponent[EO_TIP_SIDE], "tip_relief_exponent", NULL, 1, 10, 2, "of the tip relief with shape exponent")    \
  NUMBER(exponent[EO_ROOT_SIDE], "root_relief_exponent", NULL, 1, 10, 2, "of the root relief with shape exponent") \
  NUMBER(end_exponent[EO_LEADING_SIDE], "leading_end_relief_exponent", NULL, 1, 10, 2, "with shape exponent")      \
  NUMBER(end_exponent[EO_TRAILING_SIDE], "trailing_end_relief_exponent", NULL, 1, 10, 2, "with shape exponent")    \
  FLANK_TRIANGLE(NUMBER, EO_TIP_SIDE, EO_LEADING_SIDE, "tip_leading", "tip, face end that meets first")            \
  FLANK_TRIANGLE(NUMBER, EO_TIP_SIDE, EO_TRAILING_SIDE, "tip_trailing", "tip, face end that meets last")           \
  FLANK_TRIANGLE(NUMBER, EO_ROOT_SIDE, EO_LEADING_SIDE, "root_leading", "root, face end that meets first")         \
  FLANK_TRIANGLE(NUMBER, EO_ROOT_SIDE, EO_TRAILING_SIDE, "root_trailing", "root, face end that meets last")        \
  NUMBER(                                                                                                          \
      grid_gain, "grid_gain", NULL, -2, 10, 0,                                                                     \
      "what of the grid is laid on beyond it, as a share: 0 as it stands, -1 none, 1 twice; of a flank with a grid")

/* What earlier documents called lead_slope_um was half of it. */
#define HELIX_SLOPE                                                                                                 \
  {                                                                                                                 \
    .key = "helix_slope_um", .alias = "lead_slope_um", .alias_factor = 2, .kind = EO_FIELD_NUMBER,                  \
    .offset = offsetof(struct eo_flank_modification, helix_slope), .unit = &eo_unit_um, .low = -2000, .high = 2000, \
    .fallback = 0,                                                                                                  \
    .help = "C_Hbeta: over the face width, 0 at mid face, + takes more off at the face end that meets first"        \
  }

static const struct eo_field grid_node[] = {
    EO_INTEGER(struct eo_grid_node, row, "row", 0, EO_GRID_KNOTS, 0, "of u, from 1 at the root; 0: every one"),
    EO_INTEGER(struct eo_grid_node, column, "column", 0, EO_GRID_KNOTS, 0,
               "of y, from 1 at the face end that meets last; 0: every one"),
    EO_NUMBER(struct eo_grid_node, delta, "delta_um", &eo_unit_um, -1000, 1000, 0, "what is taken off there, normal"),
};
static const struct eo_table grid_node_table = EO_TABLE("a knot of a grid", struct eo_grid_node, grid_node);
const struct eo_field eo_grid_number_field = EO_NUMBER(struct eo_grid_node, delta, EO_GRID_PARAMETER, &eo_unit_um,
                                                       -1000, 1000, 0, "number of a flank's grid at some of its knots");

/* clang-format off */
#define NUMBER_ROW(member, key, unit, low, high, fallback, help) \
  EO_NUMBER(struct eo_flank_modification, member, key, unit, low, high, fallback, help),
#define PLACE_ROW(member, key, unit, high, derived, help) \
  EO_NUMBER_DERIVED(struct eo_flank_modification, member, key, unit, 1e-6, high, derived, help),
#define NUMBER_KEY(member, key, unit, low, high, fallback, help) key,
#define PLACE_KEY(member, key, unit, high, derived, help) key,
#define NODES_ROW \
  {.key = "grid_nodes", .kind = EO_FIELD_LIST, .flags = EO_FIELD_OMIT, \
   .offset = offsetof(struct eo_flank_modification, node), \
   .count_offset = offsetof(struct eo_flank_modification, nodes), .count = EO_MOST_GRID_NODES, \
   .high = EO_MOST_GRID_NODES, .table = &grid_node_table, \
   .help = "numbers in place of what the flank's grid has at some of its knots; a complete design has them in its grid"}
#define FLANK_ROWS FLANK_SHAPES FLANK_NUMBERS(NUMBER_ROW, PLACE_ROW) HELIX_SLOPE, NODES_ROW
#define GRID_ROW \
  {.key = "grid", .kind = EO_FIELD_OBJECT, .flags = EO_FIELD_ELSEWHERE | EO_FIELD_NULLABLE, \
   .table = &eo_flank_grid_table, .derived = "none", \
   .help = "free deviation delta(u, y), measured or designed, which adds to the terms by name"}
/* clang-format on */

/* The last key is the earlier name of the helix slope. */
const char *const eo_variable_parameters[] = {FLANK_NUMBERS(NUMBER_KEY, PLACE_KEY) EO_GRID_PARAMETER, "helix_slope_um",
                                              "lead_slope_um", NULL};

static const struct eo_field flank[] = {FLANK_ROWS, GRID_ROW};
enum { TERMS = sizeof flank / sizeof *flank - 1 };
const struct eo_table eo_flank_modification_table = {
    .name = "a flank's modification", .size = sizeof(struct eo_flank_modification), .count = TERMS, .field = flank};
static const struct eo_table coast_table = EO_TABLE("a coast flank's modification", struct eo_flank_modification,
                                                    flank);

/* An end: its drive flank, and in it the coast flank, which stands as far behind in struct eo_modification whatever the
   member and the end. So these tables are as large as all of it. */
#define COAST_ROW(table_)                                                                          \
  {                                                                                                \
    .key = "coast", .kind = EO_FIELD_OBJECT, .flags = EO_FIELD_OMIT,                               \
    .offset = sizeof(struct eo_flank_modification[2][2]), .table = table_,                         \
    .help = "the other flanks, which carry when torque or rotation turn round; absent: unmodified" \
  }
_Static_assert(offsetof(struct eo_modification, coast) == sizeof(struct eo_flank_modification[2][2]),
               "coast flanks stand right behind the drive flanks");

static const struct eo_field end_terms[] = {FLANK_ROWS, COAST_ROW(&eo_flank_modification_table)};
static const struct eo_field end_flanks[] = {FLANK_ROWS, GRID_ROW, COAST_ROW(&coast_table)};
static const struct eo_table end_terms_table = EO_TABLE("an end's modification", struct eo_modification, end_terms);
static const struct eo_table end_table = EO_TABLE("an end's modification", struct eo_modification, end_flanks);

#define MEMBER_ROWS(table_)                                                                                  \
  {.key = "left", .kind = EO_FIELD_OBJECT, .table = table_, .help = "left end; absent: unmodified"},         \
  {                                                                                                          \
    .key = "right", .kind = EO_FIELD_OBJECT, .flags = EO_FIELD_SOMETIMES,                                    \
    .offset = sizeof(struct eo_flank_modification), .table = table_, .help = "right end; absent: unmodified" \
  }
static const struct eo_field member_terms[] = {MEMBER_ROWS(&end_terms_table)};
static const struct eo_field member_flanks[] = {MEMBER_ROWS(&end_table)};
static const struct eo_table member_terms_table = EO_TABLE("a member's modification", struct eo_modification,
                                                           member_terms);
const struct eo_table eo_member_modification_table = EO_TABLE("a member's modification", struct eo_modification,
                                                              member_flanks);

#define MODIFICATION_ROWS(table_)                                                             \
  {.key = "pinion", .kind = EO_FIELD_OBJECT, .table = table_, .help = "the pinion's flanks"}, \
  {                                                                                           \
    .key = "gear", .kind = EO_FIELD_OBJECT, .flags = EO_FIELD_OMIT,                           \
    .offset = offsetof(struct eo_modification, flank[EO_GEAR]), .table = table_,              \
    .help = "the gear's flanks; absent: unmodified"                                           \
  }
static const struct eo_field terms[] = {MODIFICATION_ROWS(&member_terms_table)};
static const struct eo_field modification[] = {MODIFICATION_ROWS(&eo_member_modification_table)};
const struct eo_table eo_modification_terms_table = EO_TABLE("modification", struct eo_modification, terms);
const struct eo_table eo_modification_table = EO_TABLE("modification", struct eo_modification, modification);

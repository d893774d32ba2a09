/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exported flanks against what is known of involute helicoids, and against each other: turned into mesh, pinion and
   gear touch. */
#include "document/design_export.h"

#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "document/flank_chart.h"
#include "support/tap.h"

struct point {
  int member, end, profile, face;
  double position[3], normal[3], removed;
};
enum { MOST_POINTS = 4 * 21 * 31 };

static struct eo_design design;
static struct eo_geometry geometry;
static struct point plain[MOST_POINTS], modified[MOST_POINTS];

static int read_points(struct point *point)
{
  struct eo_text text = {0};
  int count = 0;
  eo_export_find("flank-points")->write(&design, &geometry, &text);
  for (char *line = strchr(text.data, '\n') + 1; *line && count < MOST_POINTS; line = strchr(line, '\n') + 1) {
    struct point *p = &point[count++];
    char member[10], end[10];
    if (sscanf(line, "%9[^,],%9[^,],%d,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf", member, end, &p->profile, &p->face,
               &p->position[0], &p->position[1], &p->position[2], &p->normal[0], &p->normal[1], &p->normal[2],
               &p->removed) != 11)
      break;
    p->member = strcmp(member, "gear") == 0;
    p->end = strcmp(end, "right") == 0;
  }
  eo_text_done(&text);
  return count;
}

static bool load(const char *name, bool bare)
{
  struct eo_error error;
  bool built = eo_example_build(name, &design);
  if (bare)
    eo_table_defaults(&eo_modification_table, &design.modification);
  return built && eo_design_complete(&design, &geometry, &error) == EO_OK;
}

/* The normals of an involute helicoid are tangents of its base cylinder, inclined by the base helix angle. */
static void test_involute(int count)
{
  double arm = 0, tilt = 0, length = 0, inside = 0;
  for (int i = 0; i < count; i++) {
    const double *p = plain[i].position, *n = plain[i].normal, radius = hypot(p[0], p[1]) * 1e-3;
    double found = fabs(p[0] * n[1] - p[1] * n[0]) / hypot(n[0], n[1]);
    arm = fmax(arm, fabs(found * 1e-3 - geometry.base_radius[plain[i].member]));
    tilt = fmax(tilt, fabs(fabs(n[2]) - sin(geometry.base_helix_angle)));
    length = fmax(length, fabs(sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1));
    inside = fmax(inside,
                  fmax(radius - geometry.tip_radius[plain[i].member], geometry.start_radius[plain[i].member] - radius));
  }
  ok(arm < 1e-10, "normals touch the base cylinder: %.2g m", arm);
  ok(tilt < 1e-9 && length < 1e-9, "the normals' inclination is the base helix angle and their length one");
  ok(inside < 1e-10, "the points go from the start of the active profile to the tip, within %.2g m", inside);
}

static void turn(const double position[3], double angle, double turned[3])
{
  turned[0] = position[0] * cos(angle) + position[1] * sin(angle);
  turned[1] = -position[0] * sin(angle) + position[1] * cos(angle);
  turned[2] = position[2];
}

/* Where the point lies on the path of contact when it touches, and when that is. */
static double phase_of(const struct point *p, double s)
{
  double eta = geometry.face_width * (p->face / 30. - 0.5);
  double late = p->end == EO_RIGHT ? design.alignment.stagger * geometry.transverse_base_pitch : 0;
  return s - eta * tan(geometry.base_helix_angle) + late;
}

/* Every point of the pinion, rolled to its phase, is the point of the gear with the same place on the path. */
static void test_mesh(int count)
{
  double apart = 0, opposed = 0;
  for (int i = 0; i < count / 2; i++) {
    const struct point *p = &plain[i], *g = NULL;
    for (int j = count / 2; j < count && !g; j++)
      if (plain[j].end == p->end && plain[j].face == p->face && plain[j].profile == 20 - p->profile)
        g = &plain[j];
    double s = geometry.path_start + (geometry.path_end - geometry.path_start) * p->profile / 20., c = phase_of(p, s);
    double at[3], other[3], normal[3], against[3];
    turn(p->position, c / geometry.base_radius[EO_PINION], at);
    turn(g->position, -c / geometry.base_radius[EO_GEAR], other);
    turn(p->normal, c / geometry.base_radius[EO_PINION], normal);
    turn(g->normal, -c / geometry.base_radius[EO_GEAR], against);
    const double gear_at[3] = {-other[0], 1e3 * geometry.centre_distance - other[1], other[2]},
                 gear_normal[3] = {-against[0], -against[1], against[2]};
    for (int k = 0; k < 3; k++) {
      apart = fmax(apart, fabs(at[k] - gear_at[k]));
      opposed = fmax(opposed, fabs(normal[k] + gear_normal[k]));
    }
  }
  ok(apart < 1e-6, "pinion and gear touch at every point: %.2g mm apart", apart);
  ok(opposed < 1e-8, "pinion and gear touch with opposite normals, off by %.2g", opposed);
}

/* Angle of the unmodified flank of a herringbone pair at a radius and the place of a point on the face, from +y towards
   +x: involute and lead. */
static double angle_of(const struct point *p, double radius)
{
  double base = geometry.base_radius[p->member],
         eta = 1e-3 * fabs(p->position[2]) - (design.gear_pair.groove_width + geometry.face_width) / 2;
  double involute = eo_geometry_involute_function(acos(base / radius)) -
                    eo_geometry_involute_function(acos(base / geometry.working_radius[p->member]));
  double lead = eta * tan(geometry.base_helix_angle) / base;
  return (p->member == EO_PINION ? lead : -lead) - involute;
}

/* What is taken off lies between the surface and the unmodified one at the same place, normal to the flank: to the last
   digit where the profile is plain; where it slopes, less by what the slope moves the point along the flank, which is
   of the second order. */
static void test_modified(int count)
{
  double plain_part = 0, most = 0, excess = 0, lack = 0;
  for (int i = 0; i < count; i++) {
    const double *p = modified[i].position;
    double radius = hypot(p[0], p[1]) * 1e-3, behind = angle_of(&modified[i], radius) - atan2(p[0], p[1]);
    double missing = behind * geometry.base_radius[modified[i].member] * cos(geometry.base_helix_angle) * 1e6,
           difference = modified[i].removed - missing;
    bool sloped = modified[i].member == EO_PINION && (modified[i].profile < 5 || modified[i].profile > 13);
    if (!sloped)
      plain_part = fmax(plain_part, fabs(difference));
    excess = fmax(excess, -difference);
    lack = fmax(lack, difference / (modified[i].removed + 1));
    most = fmax(most, modified[i].removed);
  }
  ok(most > 20 && plain_part < 2e-3, "%.1f um are taken off at most; crowning is there to %.2g um", most, plain_part);
  ok(excess < 2e-3 && lack < 0.3, "the relief is there but for the second order, which lacks %.0f %% at most",
     100 * lack);
}

static int count_lines(const char *format)
{
  struct eo_text text = {0};
  int lines = 0;
  eo_export_find(format)->write(&design, &geometry, &text);
  for (const char *c = text.data; (c = strchr(c, '\n')); c++)
    lines++;
  eo_text_done(&text);
  return lines;
}

static void test_name(const char *given, const char *expected)
{
  char name[60];
  snprintf(design.name, sizeof design.name, "%s", given);
  eo_export_file_name(eo_export_find("topography"), &design, name, sizeof name);
  ok(strcmp(name, expected) == 0, "\"%s\" is saved as %s", given, name);
}

/* The value of a chart's nominal curve at a place, between its points. */
static double nominal_at(const struct eo_flank_chart *c, double x)
{
  int i = 0;
  while (i < EO_FLANK_CHART_POINTS - 2 && c->x[i + 1] < x)
    i++;
  return c->nominal[i] + (x - c->x[i]) / (c->x[i + 1] - c->x[i]) * (c->nominal[i + 1] - c->nominal[i]);
}

/* The numbers of the paper's case A, Table 3, and of ISO 1328-1:1995, grade 6, where an inspector looks for them. */
static void test_charts(void)
{
  struct eo_flank_chart c;
  load("paper-case-a", false);
  eo_flank_chart_find(&c, &design, &geometry, EO_DRIVE_FLANK, EO_PINION, EO_LEFT, false);
  close_to(nominal_at(&c, c.active[0]), -17e-6, 0.02e-6, "root relief at d_Nf, m");
  close_to(nominal_at(&c, c.active[1]), -14e-6, 1e-12, "tip relief at the tip, m");
  close_to(nominal_at(&c, c.relief[1]), 0, 0.02e-6, "relief where the tip relief begins, m");
  close_to(hypot(c.active[1], geometry.base_radius[EO_PINION]), geometry.tip_radius[EO_PINION], 1e-12,
           "the roll length at the tip");
  close_to(hypot(c.active[0], geometry.base_radius[EO_PINION]), geometry.start_radius[EO_PINION], 1e-12,
           "the roll length where the active profile begins");
  double low = INFINITY, high = -INFINITY, wide = 0;
  bool rising = true;
  for (int i = 0; i < EO_FLANK_CHART_POINTS; i++) {
    rising = rising && (i == 0 || c.x[i] > c.x[i - 1]);
    if (isnan(c.band[i][0]))
      continue;
    low = fmin(low, c.x[i]);
    high = fmax(high, c.x[i]);
    wide = fmax(wide, c.band[i][0] - c.band[i][1]);
  }
  ok(rising && low == c.range[0] && high == c.range[1], "the band covers the evaluation range and nothing else");
  close_to(high - low, 0.92 * (c.active[1] - c.active[0]), 1e-12,
           "length of the evaluation range, 92 % of the active one");
  close_to(wide, 13e-6, 1e-12, "F_alpha of d 111.65 mm, m_n 6 mm, grade 6");
  eo_flank_chart_find(&c, &design, &geometry, EO_DRIVE_FLANK, EO_GEAR, EO_RIGHT, true);
  close_to(c.band[60][0] - c.band[60][1], 15e-6, 1e-12, "F_beta of the gear, m");
  close_to(c.range[1] - c.range[0], 49.5e-3, 1e-12, "length of the band over the face, less 5 % at each end");
  design.gear_pair.face_width = 1e-3;
  eo_flank_chart_find(&c, &design, &geometry, EO_DRIVE_FLANK, EO_GEAR, EO_RIGHT, true);
  ok(isnan(c.band[60][0]) && *c.note, "a face that ISO 1328-1 does not cover has no band: %s", c.note);
}

/* The row of a symbol of the pinion. */
static double tolerance(const char *symbol)
{
  struct eo_text text = {0};
  struct eo_error error;
  char key[40];
  eo_export_write(eo_export_find("tolerances"), &design, &geometry, 0, 0, &text, &error);
  snprintf(key, sizeof key, ",%s,", symbol);
  const char *row = text.data ? strstr(text.data, key) : NULL;
  double value = row ? strtod(row + strlen(key), NULL) : NAN;
  eo_text_done(&text);
  return value;
}

static void test_tolerances(void)
{
  load("paper", true);
  design.rating.accuracy_grade = 6;
  close_to(tolerance("F_alpha"), 13, 1e-9, "F_alpha of the other edition, um");
  close_to(tolerance("f_Hbeta"), 10, 1e-9, "f_Hbeta of the other edition, um");
  design.rating.edition = EO_ISO6336_2019;
  ok(isnan(tolerance("F_alpha")) && tolerance("F_alphaT") > 5, "the other edition has symbols of its own");
}

/* The value of a quantity of a member, and its note where it has none. */
static double dimension(const char *member, const char *symbol, const char *unit, const char *at, char note[200])
{
  struct eo_text text = {0};
  struct eo_error error;
  char key[80];
  double value = NAN;
  eo_export_write(eo_export_find("dimensions"), &design, &geometry, 0, 0, &text, &error);
  snprintf(key, sizeof key, ",%s,%s,%s,", symbol, unit, at);
  const char *row = text.data ? strstr(text.data, member) : NULL;
  row = row ? strstr(row, key) : NULL;
  *note = 0;
  if (row && sscanf(row + strlen(key), "%lf", &value) != 1 && sscanf(row + strlen(key), ",\"%199[^\"]", note) != 1)
    snprintf(note, 200, "neither a number nor a reason");
  eo_text_done(&text);
  return value;
}

/* Against the closed forms of ISO 21771 and DIN 3967, written here another way. */
static void test_dimensions(void)
{
  char note[200];
  load("shifted", true);
  double *allowance = design.gear_pair.thickness_allowance[EO_PINION];
  allowance[0] = -60e-6;
  allowance[1] = -95e-6;
  double module = 1e3 * geometry.normal_module, alpha = geometry.normal_pressure_angle,
         shift = geometry.profile_shift[EO_PINION], z = geometry.teeth[EO_PINION];
  double transverse = atan(tan(alpha) / cos(geometry.helix_angle));
  double nominal = dimension("pinion", "s_n", "mm", "nominal", note);
  close_to(dimension("pinion", "d", "mm", "", note), z * module / cos(geometry.helix_angle), 1e-7,
           "reference diameter d, mm");
  close_to(nominal, module * (M_PI / 2 + 2 * shift * tan(alpha)), 1e-8, "tooth thickness s_n, mm");
  close_to(dimension("pinion", "s_n", "mm", "lower allowance", note), nominal + 1e3 * allowance[1], 1e-8,
           "tooth thickness s_n with A_sni, mm");
  double k = dimension("pinion", "k", "", "", note);
  double span = module * cos(alpha) * (M_PI * (k - 0.5) + z * (tan(transverse) - transverse)) +
                2 * shift * module * sin(alpha) + 1e3 * allowance[0] * cos(alpha);
  close_to(dimension("pinion", "W_k", "mm", "upper allowance", note), span, 1e-7, "span W_k with A_sne, mm");
  double smallest = dimension("pair", "j_bn", "um", "smallest", note),
         largest = dimension("pair", "j_bn", "um", "largest", note), sum = 0;
  for (int i = 0; i < 2; i++)
    sum += design.gear_pair.thickness_allowance[i][0] - design.gear_pair.thickness_allowance[i][1];
  double apart = 4 * design.gear_pair.centre_distance_allowance * sin(geometry.working_pressure_angle) *
                 cos(geometry.base_helix_angle);
  close_to(largest - smallest, 1e6 * (sum * cos(alpha) + apart), 1e-6, "range of the backlash j_bn, um");
  geometry.member_width[EO_GEAR] = 1e-3;
  ok(isnan(dimension("gear", "W_k", "mm", "nominal", note)) && strstr(note, "face"),
     "a gear without a span says why: %s", note);
}

static void test_grid(void)
{
  struct eo_text text = {0};
  struct eo_error error;
  int lines = 0;
  load("single", false);
  ok(!eo_export_write(eo_export_find("topography"), &design, &geometry, 5, 7, &text, &error),
     "a grid of 5 by 7 is exported");
  for (const char *c = text.data; (c = strchr(c, '\n')); c++)
    lines++;
  ok(lines == 1 + 2 * 5 * 7, "the exported grid has a row for each of its points on each flank: %d", lines - 1);
  ok(eo_export_write(eo_export_find("k-chart"), &design, &geometry, 5, 7, &text, &error) == EO_ERROR_INPUT,
     "a format without a grid refuses one: %s", error.text);
  eo_text_done(&text);
}

int main(void)
{
  ok(load("paper", true), "the paper's pair is loaded");
  int count = read_points(plain);
  ok(count == MOST_POINTS, "the paper's pair has %d points", count);
  test_involute(count);
  test_mesh(count);
  ok(load("paper-case-a", false) && read_points(modified) == count,
     "the paper's optimum is loaded and has as many points");
  test_modified(count);
  ok(count_lines("modification-chart") == 1 + 4 * 2 * 61 && count_lines("topography") == 1 + count,
     "the charts of the optimum have all of their lines");
  test_name("Paper pair, Case \"A\"/../x", "paper-pair-case-a-x-topography.csv");
  test_name("\xc3\xa4\xc3\xb6", "topography.csv");
  test_name("", "topography.csv");
  test_name("a name that is much longer than any file's name ought to be, really",
            "a-name-that-is-much-longer-than-any-file-s-n-topography.csv");
  ok(load("paper", true), "the pair with one end behind the other is loaded");
  design.alignment.stagger = 0.5;
  test_mesh(read_points(plain));
  ok(load("shifted", true), "a pair with profile shift is loaded");
  count = read_points(plain);
  test_involute(count);
  test_mesh(count);
  ok(load("single", true), "a pair with one end is loaded");
  ok(read_points(plain) == MOST_POINTS / 2, "a pair with one end has half the points");
  test_mesh(MOST_POINTS / 2);
  ok(!eo_export_find("picture") && !eo_export_at(9) && eo_export_at(0),
     "the formats are found by name and number, and no others");
  test_charts();
  test_grid();
  test_tolerances();
  test_dimensions();
  return tap_done();
}

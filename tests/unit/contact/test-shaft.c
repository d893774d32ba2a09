/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The influence of twisting and bending bodies, against textbook beams.

   Uniform bars: simply supported Timoshenko beam of length L, unit force at z (b = L - z), x <= z, from the left
   bearing (Timoshenko 1955; shear after Cowper 1966): v = b x (L^2 - b^2 - x^2) / (6 L E I) + x b / (L kappa G A), psi
   = b (L^2 - b^2 - 3 x^2) / (6 L E I), and for a unit moment at z the rotations are the derivatives of these along z,
   with 1 / (L kappa G A) more from the shear.

   Twist of a double helical bar under even loads. Torque T enters at the left face; each end takes T/2 evenly over its
   width b, the groove of width g carries T/2. From the left face, x along the left end, y along the right one: G J
   theta = T x - (T/2) x^2 / (2 b),   T b (3/4) + (T/2) g over left end and groove,   then (T/2) (y - y^2 / (2 b)). Each
   end winds up along its chord by r_b (3/4) T b / (G J) on the side of the drive and a third of that on the other; one
   end alone, with its T entering at one side, by r_b (T/2) b / (G J), which is the slope of f(b) = r_b (T/2) / (G J) (b
   - b_mid). For the same load per end the driven side of a double helical bar winds up three times as far as a single
   one: the factor 2 * 1.5 of ISO 6336-1's f_sh0. */
#include "contact/shaft.h"
#include "numerics/dense.h"
#include "support/paper-pair.h"
#include "support/shaft-load.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { NODES = EO_DEFLECTION_NODES, VECTOR = 2 * NODES };

static struct eo_geometry geometry;
static struct eo_gear_pair pair;
static struct eo_material steel;
static struct eo_shafts shafts;
static struct eo_shaft_influence influence;

static void set_pair(int ends, double helix_deg)
{
  struct eo_error error;
  pair = paper_pair();
  pair.ends = ends;
  pair.helix_angle = helix_deg * M_PI / 180;
  pair.groove_width = ends == 2 ? 0.05 : 0;
  if (helix_deg == 0)
    pair.profile_shift[EO_PINION] = 0.1; /* no undercut */
  if (eo_geometry_init(&geometry, &pair, &error))
    printf("# %s\n", error.text);
  steel = paper_steel();
}

/* The same diameter from bearing to bearing. */
static void set_uniform_bars(double bearing)
{
  shafts = (struct eo_shafts){.enabled = true};
  for (int i = 0; i < 2; i++) {
    pair.bore[i] = 0;
    pair.groove_diameter[i] = shafts.shaft_diameter[i] = eo_shaft_effective_diameter(&geometry, i);
    shafts.bearing_position[i][EO_LEFT] = -bearing;
    shafts.bearing_position[i][EO_RIGHT] = bearing;
    shafts.drive_side[i] = EO_DRIVE_LEFT;
  }
}

static void set_stepped_bodies(void)
{
  shafts = (struct eo_shafts){.enabled = true,
                              .shaft_diameter = {0.07, 0.15},
                              .bearing_position = {{-0.11, 0.16}, {-0.2, 0.125}},
                              .drive_side = {EO_DRIVE_LEFT, EO_DRIVE_RIGHT}};
  pair.bore[EO_PINION] = 0.03;
  pair.bore[EO_GEAR] = 0.09;
  pair.groove_diameter[EO_PINION] = 0.09;
  pair.groove_diameter[EO_GEAR] = 0.25;
}

static void make(void)
{
  struct eo_error error = {0};
  eo_shaft_influence_done(&influence);
  if (eo_shaft_influence_init(&influence, &geometry, &pair, &steel, &shafts, false, &error))
    printf("# %s\n", error.text);
}

static double entry(int i, int j)
{
  return influence.matrix[i * influence.size + j];
}

static double place(int end, int node)
{
  double offset = pair.ends == 2 ? (geometry.face_width + pair.groove_width) / 2 : 0,
         eta = geometry.face_width * ((double)node / (NODES - 1) - 0.5);
  return end == EO_LEFT ? -(offset + eta) : offset + eta;
}

static void test_sections(void)
{
  struct eo_material m = {.youngs_modulus = 2.6e11, .poissons_ratio = 0.3}; /* G = 1e11 */
  struct eo_shaft_section solid = eo_shaft_section_of(&m, 0.1, 0), tube = eo_shaft_section_of(&m, 0.1, 0.09999);
  near(solid.bending, 2.6e11 * M_PI * 1e-4 / 64, 1e-14, "E I of a solid shaft");
  near(solid.torsion, 1e11 * M_PI * 1e-4 / 32, 1e-14, "G J of a solid shaft");
  near(solid.shear / (1e11 * M_PI * 1e-2 / 4), 6 * 1.3 / (7 + 6 * 0.3), 1e-14,
       "Cowper's coefficient of a solid shaft: 6 (1 + nu) / (7 + 6 nu)");
  near(tube.shear / (1e11 * M_PI / 4 * (1e-2 - 0.09999 * 0.09999)), 2 * 1.3 / (4 + 3 * 0.3), 1e-7,
       "Cowper's coefficient of a thin tube: 2 (1 + nu) / (4 + 3 nu)");
}

struct bar {
  double length, left;
  struct eo_shaft_section section;
};

/* Deflection, rotation by force and by moment at x from either side of z. */
static double bar_deflection(const struct bar *bar, double x, double z)
{
  double l = bar->length, at = fmin(x, z) - bar->left, b = bar->left + l - fmax(x, z);
  return b * at * (l * l - b * b - at * at) / (6 * l * bar->section.bending) + at * b / (l * bar->section.shear);
}

static double bar_rotation(const struct bar *bar, double x, double z)
{
  double l = bar->length, at = x - bar->left, b = bar->left + l - z, sign = 1;
  if (x > z) {
    at = l - at;
    b = l - b;
    sign = -1;
  }
  return sign * b * (l * l - b * b - 3 * at * at) / (6 * l * bar->section.bending);
}

static double bar_rotation_by_moment(const struct bar *bar, double x, double z)
{
  double l = bar->length, at = x - bar->left, b = bar->left + l - z;
  if (x > z) {
    at = l - at;
    b = l - b;
  }
  return -(l * l - 3 * b * b - 3 * at * at) / (6 * l * bar->section.bending) + 1 / (l * bar->section.shear);
}

static double bar_twist(double clamp, double x, double z, double stiffness)
{
  return (x - clamp) * (z - clamp) < 0 ? 0 : fmin(fabs(x - clamp), fabs(z - clamp)) / stiffness;
}

/* What a section's motion (v, psi, chi, theta) does along the flank normal at the point (s, z) of the plane of action,
   by vectors: axes along the line of action, normal to the plane of action, and along the shaft. */
static void normal_motion(int member, int end, double s, double coefficient[4])
{
  double b = geometry.base_helix_angle, lean = end == EO_LEFT ? tan(b) : -tan(b);
  double n[3] = {cos(b), 0, cos(b) * lean}; /* flank s - c - eta tan(b) = 0, eta to the left on the left end */
  double axis = member == EO_PINION ? -geometry.tangent_length[EO_PINION] : geometry.tangent_length[EO_GEAR];
  double arm[3] = {s - axis, geometry.base_radius[member], 0};
  /* rotations: psi turns z towards the line of action, chi turns z against the second axis, theta moves +second towards
     the line of action */
  double turn[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  coefficient[0] = n[0];
  for (int k = 0; k < 3; k++) {
    const double *w = turn[k];
    double move[3] = {w[1] * arm[2] - w[2] * arm[1], w[2] * arm[0] - w[0] * arm[2], w[0] * arm[1] - w[1] * arm[0]};
    coefficient[k + 1] = move[0] * n[0] + move[1] * n[1] + move[2] * n[2];
  }
}

static double bar_entry(int end, int node, double s, int other_end, int other_node, double other_s)
{
  double sum = 0, half = -place(EO_LEFT, NODES - 1);
  for (int member = 0; member < 2; member++) {
    double x = place(end, node), z = place(other_end, other_node), c[4], d[4];
    struct bar bar = {2 * shafts.bearing_position[member][EO_RIGHT], shafts.bearing_position[member][EO_LEFT],
                      eo_shaft_section_of(&steel, shafts.shaft_diameter[member], 0)};
    normal_motion(member, end, s, c);
    normal_motion(member, other_end, other_s, d);
    /* at one and the same section the moment's rotation is the mean of both sides' limits, which agree */
    sum += c[0] * d[0] * bar_deflection(&bar, x, z) + c[1] * d[0] * bar_rotation(&bar, x, z) +
           c[0] * d[1] * bar_rotation(&bar, z, x);
    sum += (c[1] * d[1] + c[2] * d[2]) * bar_rotation_by_moment(&bar, x, z);
    sum += c[3] * d[3] * bar_twist(-half, x, z, bar.section.torsion);
  }
  return sum;
}

static double deflection_at(int end, int node, double s, int other_end, int other_node, double other_s)
{
  int i = end * VECTOR + node, j = other_end * VECTOR + other_node;
  return entry(i, j) + s * entry(i + NODES, j) + other_s * entry(i, j + NODES) +
         s * other_s * entry(i + NODES, j + NODES);
}

static void test_uniform_bars(int ends, double helix_deg)
{
  double worst = 0, scale = 0;
  set_pair(ends, helix_deg);
  set_uniform_bars(ends == 2 ? 0.13 : 0.06);
  make();
  for (int k = 0; k < 2000; k++) {
    int end = k % ends, other = k / 2 % ends, node = k * 7 % NODES, far = k * 11 % NODES;
    double s = 1e-3 * (k % 27 - 14), t = 1e-3 * (k % 23 - 11);
    double expected = bar_entry(end, node, s, other, far, t);
    worst = fmax(worst, fabs(deflection_at(end, node, s, other, far, t) - expected));
    scale = fmax(scale, fabs(expected));
  }
  ok(worst < 1e-11 * scale, "%d end(s), helix %g deg: point loads on uniform bars, off by %.2g of %.3g m/N", ends,
     helix_deg, worst / scale, scale);
}

/* Even load over the whole span: 5 w L^4 / (384 E I) + w L^2 / (8 kappa G A) in the middle. */
static void test_even_load(void)
{
  set_pair(1, 0);
  set_uniform_bars(geometry.face_width / 2);
  make();
  struct eo_deflection load = {{{0}}}, deflection;
  double b = geometry.face_width, w = 1 / b, expected = 0, twist = 0;
  for (int i = 0; i < 4000; i++)
    shaft_load_add(&load, b, 0, b * ((i + 0.5) / 4000 - 0.5), 1. / 4000);
  eo_shaft_deflect(&influence, &load, &deflection);
  for (int member = 0; member < 2; member++) {
    struct eo_shaft_section section = eo_shaft_section_of(&steel, shafts.shaft_diameter[member], 0);
    expected += 5 * w * pow(b, 4) / (384 * section.bending) + w * b * b / (8 * section.shear);
    twist += pow(geometry.base_radius[member], 2) / section.torsion * (b / 2 - b / 8); /* T b/2 (1 - 1/4) */
  }
  near(deflection.part[0][NODES / 2], expected + twist, 2e-4,
       "deflection in the middle of a simply supported span under even load");
}

/* Wind-up of the double helical bar as derived above; the bending of uniform bars, checked above, is taken off. */
static void test_double_helical_twist(void)
{
  set_pair(2, 0);
  set_uniform_bars(0.13);
  make();
  double b = geometry.face_width, g = pair.groove_width, worst = 0, most = 0, chord[2], single = 0, stiffness[2];
  struct eo_deflection load[2] = {{{{0}}}, {{{0}}}}, deflection[2];
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < NODES; i++)
      load[end].part[0][i] = (i == 0 || i == NODES - 1 ? 0.5 : 1) / (NODES - 1);
  eo_shaft_deflect(&influence, load, deflection);
  for (int member = 0; member < 2; member++)
    stiffness[member] = eo_shaft_section_of(&steel, shafts.shaft_diameter[member], 0).torsion;
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < NODES; i++) {
      double bending = 0, expected = 0, x = place(end, i) + g / 2 + b, y = x - b - g;
      for (int member = 0; member < 2; member++) {
        struct bar bar = {0.26, -0.13, eo_shaft_section_of(&steel, shafts.shaft_diameter[member], 0)};
        double radius = geometry.base_radius[member], torque = 2 * radius; /* unit force on each end */
        for (int j = 0; j < 2 * NODES; j++)
          bending += load[j / NODES].part[0][j % NODES] *
                     bar_deflection(&bar, place(end, i), place(j / NODES, j % NODES));
        double theta = end == EO_LEFT ? torque * x - torque / 2 * x * x / (2 * b)
                                      : torque * b * 3 / 4 + torque / 2 * g + torque / 2 * (y - y * y / (2 * b));
        expected += radius * theta / stiffness[member];
      }
      deflection[end].part[0][i] -= bending;
      worst = fmax(worst, fabs(deflection[end].part[0][i] - expected));
      most = fmax(most, expected);
    }
  ok(worst < 1e-12 * most, "the wind-up of a double helical bar under even loads is off by %.2g of %.3g m/N",
     worst / most, most);
  for (int end = 0; end < 2; end++)
    chord[end] = fabs(deflection[end].part[0][NODES - 1] - deflection[end].part[0][0]);
  for (int member = 0; member < 2; member++)
    single += pow(geometry.base_radius[member], 2) / 2 * b / stiffness[member];
  near(chord[EO_LEFT] / single, 3, 1e-10, "chord at the drive's end over that of a single end under the same load");
  near(chord[EO_RIGHT] / single, 1, 1e-10, "chord at the far end over that of a single end under the same load");
}

static double diameter_at(int member, double x)
{
  double half = pair.groove_width / 2, end = half + geometry.face_width;
  return fabs(x) > end    ? shafts.shaft_diameter[member]
         : fabs(x) > half ? eo_shaft_effective_diameter(&geometry, member)
                          : pair.groove_diameter[member];
}

/* Mohr's integral of a unit normal force at s = 0 on node i and one on node j, by brute force. */
static double mohr(int end, int node, int other_end, int other_node)
{
  enum { STEPS = 60000 };
  double sum = 0;
  for (int member = 0; member < 2; member++) {
    double left = shafts.bearing_position[member][EO_LEFT], right = shafts.bearing_position[member][EO_RIGHT],
           l = right - left;
    double step = l / STEPS,
           clamp = shafts.drive_side[member] == EO_DRIVE_LEFT ? place(EO_LEFT, NODES - 1) : place(EO_RIGHT, NODES - 1);
    for (int k = 0; k < STEPS; k++) {
      double x = left + (k + 0.5) * step, moment[2][2], shear[2][2], torque[2],
             z[2] = {place(end, node), place(other_end, other_node)};
      struct eo_shaft_section section = eo_shaft_section_of(&steel, diameter_at(member, x), pair.bore[member]);
      for (int i = 0; i < 2; i++) {
        double c[4];
        normal_motion(member, i ? other_end : end, 0, c);
        double force = c[0] * (right - z[i]) / l - c[1] / l, side = -c[2] / l; /* reactions at the left bearing */
        moment[i][0] = force * (x - left) + (x > z[i] ? c[1] - c[0] * (x - z[i]) : 0);
        shear[i][0] = force - (x > z[i] ? c[0] : 0);
        moment[i][1] = side * (x - left) + (x > z[i] ? c[2] : 0);
        shear[i][1] = side;
        torque[i] = (x - clamp) * (x - z[i]) < 0 ? c[3] : 0;
      }
      for (int plane = 0; plane < 2; plane++)
        sum += step * (moment[0][plane] * moment[1][plane] / section.bending +
                       shear[0][plane] * shear[1][plane] / section.shear);
      sum += step * torque[0] * torque[1] / section.torsion;
    }
  }
  return sum;
}

static void test_stepped_bodies(void)
{
  static const int where[][4] = {{0, 3, 0, 20}, {0, 31, 1, 4}, {1, 17, 1, 17}, {1, 32, 0, 0}, {0, 9, 1, 30}};
  set_pair(2, 24);
  set_stepped_bodies();
  make();
  for (size_t k = 0; k < sizeof where / sizeof *where; k++) {
    double expected = mohr(where[k][0], where[k][1], where[k][2], where[k][3]);
    near(entry(where[k][0] * VECTOR + where[k][1], where[k][2] * VECTOR + where[k][3]), expected, 2e-4,
         "influence of stepped hollow bodies against Mohr's integral");
  }
}

static void test_semidefinite(void)
{
  int n = influence.size, asymmetric = 0;
  double *matrix = malloc(sizeof *matrix * (size_t)(n * n)), *value = malloc(sizeof *value * (size_t)n), largest = 0,
         missed = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double scale = (i % VECTOR < NODES ? 1 : 0.014) * (j % VECTOR < NODES ? 1 : 0.014), modes = 0;
      matrix[i * n + j] = scale * entry(i, j);
      asymmetric += entry(i, j) != entry(j, i);
      for (int k = 0; k < EO_SHAFT_MODES; k++)
        modes += influence.mode[k * n + i] * influence.mode[k * n + j];
      largest = fmax(largest, fabs(matrix[i * n + j]));
      missed = fmax(missed, fabs(matrix[i * n + j] - scale * modes));
    }
  ok(asymmetric == 0, "the influence is symmetric, bit for bit (Maxwell)");
  eo_dense_symmetric_eigen(n, matrix, value);
  ok(value[0] > -1e-14 * value[n - 1], "the influence is positive semi-definite: eigenvalues from %.2g to %.2g m/N",
     value[0], value[n - 1]);
  ok(missed < 0.02 * largest, "the modes of the influence leave %.2g of it", missed / largest);
  free(matrix);
  free(value);
}

/* Bodies seen from the other side: what is left becomes right. */
static void test_mirror(void)
{
  set_pair(2, 24);
  set_stepped_bodies();
  make();
  int n = influence.size;
  double *first = malloc(sizeof *first * (size_t)(n * n)), worst = 0, largest = 0;
  memcpy(first, influence.matrix, sizeof *first * (size_t)(n * n));
  for (int i = 0; i < 2; i++) {
    double left = shafts.bearing_position[i][EO_LEFT];
    shafts.bearing_position[i][EO_LEFT] = -shafts.bearing_position[i][EO_RIGHT];
    shafts.bearing_position[i][EO_RIGHT] = -left;
    shafts.drive_side[i] = shafts.drive_side[i] == EO_DRIVE_LEFT ? EO_DRIVE_RIGHT : EO_DRIVE_LEFT;
  }
  make();
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      worst = fmax(worst, fabs(entry((i + VECTOR) % n, (j + VECTOR) % n) - first[i * n + j]));
      largest = fmax(largest, fabs(first[i * n + j]));
    }
  ok(worst < 1e-12 * largest, "mirrored bearings and drive sides exchange the ends, off by %.2g", worst / largest);
  free(first);
}

enum { CELLS = 260 };

/* Half the angle that the material takes at a radius, from the middle of a tooth. */
static double half_angle(int member, const double (*outline)[2], int points, double radius)
{
  if (radius <= outline[0][0])
    return M_PI / geometry.teeth[member];
  if (radius > outline[points - 1][0])
    return -1;
  int i = 1;
  while (i < points - 1 && outline[i][0] < radius)
    i++;
  double t = (radius - outline[i - 1][0]) / (outline[i][0] - outline[i - 1][0]);
  return outline[i - 1][1] + t * (outline[i][1] - outline[i - 1][1]);
}

static int trace(int member, double (*outline)[2])
{
  int points = 0;
  for (int i = 0; i <= 80; i++) {
    double point[2], normal[2], t = i / 40.;
    if (i <= 40)
      eo_geometry_fillet(&geometry, member, t, point, normal);
    else
      eo_geometry_involute(&geometry, member,
                           geometry.form_radius[member] +
                               (t - 1) * (geometry.tip_radius[member] - geometry.form_radius[member]),
                           point, normal);
    double radius = hypot(point[0], point[1]);
    if (points && radius <= outline[points - 1][0] + 1e-9)
      points--; /* the bottom land: one radius */
    outline[points][0] = radius;
    outline[points++][1] = atan2(point[0], point[1]);
  }
  return points;
}

/* A u for the five-point Laplacian of the cells inside; an edge lies three quarters of a cell from the last middle. */
static void apply_laplacian(const char *inside, const double *u, double *product)
{
  static const int step[4] = {1, -1, CELLS, -CELLS};
  for (int i = CELLS; i < CELLS * (CELLS - 1); i++) {
    product[i] = 0;
    for (int k = 0; inside[i] && k < 4; k++)
      product[i] += inside[i + step[k]] ? u[i] - u[i + step[k]] : 1.5 * u[i];
  }
}

/* Torsion constant by Prandtl's stress function, conjugate gradients. */
static double torsion_constant(int member)
{
  enum { N = CELLS * CELLS };
  static double u[N], r[N], p[N], q[N];
  static char inside[N];
  double outline[81][2], pitch = 2 * M_PI / geometry.teeth[member], width = 2.04 * geometry.tip_radius[member] / CELLS,
                         rr = 0, volume = 0;
  int points = trace(member, outline);
  for (int i = 0; i < N; i++) {
    double x = (i % CELLS + 0.5 - CELLS / 2.) * width, y = (i / CELLS + 0.5 - CELLS / 2.) * width, angle = atan2(x, y);
    angle = fabs(angle - pitch * round(angle / pitch));
    inside[i] = angle <= half_angle(member, (const double(*)[2])outline, points, hypot(x, y));
    u[i] = q[i] = 0;
    r[i] = p[i] = inside[i] ? 2 * width * width : 0;
    rr += r[i] * r[i];
  }
  for (double start = rr; rr > 1e-14 * start;) {
    double pq = 0, before = rr;
    apply_laplacian(inside, p, q);
    for (int i = 0; i < N; i++)
      pq += p[i] * q[i];
    rr = 0;
    for (int i = 0; i < N; i++) {
      u[i] += before / pq * p[i];
      r[i] -= before / pq * q[i];
      rr += r[i] * r[i];
    }
    for (int i = 0; i < N; i++)
      p[i] = r[i] + rr / before * p[i];
  }
  for (int i = 0; i < N; i++)
    volume += u[i];
  return 2 * volume * width * width;
}

static void test_effective_diameter(void)
{
  set_pair(2, 24);
  for (int member = 0; member < 2; member++) {
    double diameter = 2 * pow(2 * torsion_constant(member) / M_PI, 0.25);
    close_to(eo_shaft_effective_diameter(&geometry, member), diameter, 0.06 * geometry.normal_module,
             member ? "effective diameter of the gear against Saint-Venant's torsion constant"
                    : "effective diameter of the pinion");
  }
}

int main(void)
{
  test_sections();
  test_uniform_bars(2, 0);
  test_uniform_bars(2, 24);
  test_uniform_bars(1, 17);
  test_even_load();
  test_double_helical_twist();
  test_stepped_bodies();
  test_semidefinite();
  test_mirror();
  test_effective_diameter();
  eo_shaft_influence_done(&influence);
  return tap_done();
}

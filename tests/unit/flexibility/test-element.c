/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The brick with incompatible modes: rigid motions, the patch test, bending without locking, and one element against
   CalculiX. */
#include "flexibility/element.h"
#include "support/tap.h"

#include <lapacke.h>
#include <string.h>

static const struct eo_material steel = {.youngs_modulus = 210e9, .poissons_ratio = 0.3};

enum { MAX_NODES = 64, MAX_BRICKS = 40 };

struct mesh {
  int nodes, bricks;
  double point[MAX_NODES][3];
  int brick[MAX_BRICKS][8];
};

/* A block of nx x ny x nz bricks. */
static void make_block(struct mesh *mesh, const int count[3], const double size[3])
{
  *mesh = (struct mesh){0};
  int nx = count[0] + 1, ny = count[1] + 1;
  for (int k = 0; k <= count[2]; k++)
    for (int j = 0; j <= count[1]; j++)
      for (int i = 0; i <= count[0]; i++) {
        double *p = mesh->point[mesh->nodes++];
        p[0] = size[0] * i / count[0];
        p[1] = size[1] * j / count[1];
        p[2] = size[2] * k / count[2];
      }
  for (int k = 0; k < count[2]; k++)
    for (int j = 0; j < count[1]; j++)
      for (int i = 0; i < count[0]; i++) {
        int a = i + nx * (j + ny * k), up = nx * ny;
        int corner[8] = {a, a + 1, a + 1 + nx, a + nx, a + up, a + 1 + up, a + 1 + nx + up, a + nx + up};
        memcpy(mesh->brick[mesh->bricks++], corner, sizeof corner);
      }
}

/* Displacements under forces with some unknowns prescribed (their values stand in displacement already). */
static void solve(const struct mesh *mesh, const unsigned char *fixed, const double *force, double *displacement)
{
  static double k[9 * MAX_NODES * MAX_NODES], right[3 * MAX_NODES];
  int n = 3 * mesh->nodes, pivot[3 * MAX_NODES];
  memset(k, 0, sizeof k);
  memcpy(right, force, (size_t)n * sizeof *right);
  for (int e = 0; e < mesh->bricks; e++) {
    double node[8][3], stiffness[24][24];
    for (int a = 0; a < 8; a++)
      memcpy(node[a], mesh->point[mesh->brick[e][a]], sizeof node[a]);
    eo_brick_stiffness((const double(*)[3])node, &steel, stiffness);
    for (int i = 0; i < 24; i++)
      for (int j = 0; j < 24; j++)
        k[(3 * mesh->brick[e][i / 3] + i % 3) * n + 3 * mesh->brick[e][j / 3] + j % 3] += stiffness[i][j];
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n && !fixed[i]; j++)
      if (fixed[j])
        right[i] -= k[i * n + j] * displacement[j];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      if (fixed[i] || fixed[j])
        k[i * n + j] = i == j ? 1 : 0;
  for (int i = 0; i < n; i++)
    if (fixed[i])
      right[i] = displacement[i];
  LAPACKE_dgesv(LAPACK_ROW_MAJOR, n, 1, k, n, pivot, right, 1);
  memcpy(displacement, right, (size_t)n * sizeof *right);
}

static void linear_field(const double p[3], double u[3])
{
  u[0] = 1e-3 * (p[0] + 0.5 * p[1] - 0.3 * p[2]);
  u[1] = 1e-3 * (0.2 * p[0] - 0.4 * p[1] + 0.7 * p[2]);
  u[2] = 1e-3 * (-0.6 * p[0] + 0.1 * p[1] + 0.9 * p[2]);
}

/* A block whose inner node is moved: any linear field on its surface must come out inside. */
static void check_patch(void)
{
  struct mesh mesh;
  static double displacement[3 * MAX_NODES], force[3 * MAX_NODES];
  static unsigned char fixed[3 * MAX_NODES];
  make_block(&mesh, (const int[3]){2, 2, 2}, (const double[3]){1, 1.2, 0.8});
  const int inner = 13;
  mesh.point[inner][0] += 0.11;
  mesh.point[inner][1] -= 0.14;
  mesh.point[inner][2] += 0.09;
  for (int a = 0; a < mesh.nodes; a++)
    for (int c = 0; c < 3; c++) {
      double u[3];
      linear_field(mesh.point[a], u);
      fixed[3 * a + c] = a != inner;
      displacement[3 * a + c] = a == inner ? 0 : u[c];
    }
  solve(&mesh, fixed, force, displacement);
  double expected[3];
  linear_field(mesh.point[inner], expected);
  for (int c = 0; c < 3; c++)
    close_to(displacement[3 * inner + c], expected[c], 1e-15, "displacement of the inner node in the patch test, m");
}

/* A slender bar of eight bricks, clamped at x = 0. */
static double tip_deflection(int direction, double total)
{
  struct mesh mesh;
  static double displacement[3 * MAX_NODES], force[3 * MAX_NODES];
  static unsigned char fixed[3 * MAX_NODES];
  make_block(&mesh, (const int[3]){8, 1, 1}, (const double[3]){1, 0.1, 0.1});
  memset(force, 0, sizeof force);
  memset(fixed, 0, sizeof fixed);
  memset(displacement, 0, sizeof displacement);
  double sum = 0;
  for (int a = 0; a < mesh.nodes; a++) {
    if (mesh.point[a][0] == 1)
      force[3 * a + direction] = total / 4;
    for (int c = 0; c < 3 && mesh.point[a][0] == 0; c++) /* free to contract across */
      fixed[3 * a + c] = c == 0 || (mesh.point[a][1] == 0 && c == 1) || (mesh.point[a][2] == 0 && c == 2);
  }
  solve(&mesh, fixed, force, displacement);
  for (int a = 0; a < mesh.nodes; a++)
    sum += mesh.point[a][0] == 1 ? displacement[3 * a + direction] / 4 : 0;
  return sum;
}

static void check_bar(void)
{
  double e = steel.youngs_modulus, inertia = pow(0.1, 4) / 12, shear = e / 2.6, area = 0.01;
  near(tip_deflection(0, 1e3), 1e3 / (e * area), 1e-9, "stretch of a bar in tension, F L / (E A)");
  /* Timoshenko: F L^3 / (3 E I) + F L / (k G A), k = 10 (1 + nu) / (12 + 11 nu) (Cowper 1966); the bricks are 1.25 high
   */
  double k = 10 * 1.3 / (12 + 11 * 0.3), beam = 1e3 / (3 * e * inertia) + 1e3 / (k * shear * area);
  near(tip_deflection(1, 1e3), beam, 0.01, "deflection of a cantilever of one brick's height");
  near(tip_deflection(2, 1e3), beam, 0.01, "deflection of the cantilever in the other direction");
}

/* A sheared brick held at its lower face; displacements of the upper face printed by CalculiX 2.20 for C3D8I. */
static void check_calculix(void)
{
  static const double expected[12] = {1.784312e-04,  6.518052e-05,  7.330906e-05,  1.656667e-04,
                                      2.351459e-04,  9.373642e-06,  -2.571413e-05, 2.592321e-04,
                                      -1.439053e-04, -3.954953e-05, 9.665823e-05,  -4.804570e-05};
  struct eo_material material = {.youngs_modulus = 210e3, .poissons_ratio = 0.3};
  double node[8][3], k[24][24], a[144], u[12] = {1, 0, 0, 0, 2, 0, 0, 0, -0.5, -0.3, 0, 0.7};
  int pivot[12];
  for (int i = 0; i < 8; i++) {
    double x = i % 4 == 1 || i % 4 == 2, y = i % 4 >= 2, z = i / 4;
    node[i][0] = x + 0.4 * z + 0.2 * y;
    node[i][1] = 1.3 * y + 0.3 * z;
    node[i][2] = 2 * z;
  }
  ok(!eo_brick_stiffness((const double(*)[3])node, &material, k), "the sheared brick is accepted");
  for (int i = 0; i < 12; i++)
    for (int j = 0; j < 12; j++)
      a[12 * i + j] = k[12 + i][12 + j];
  LAPACKE_dgesv(LAPACK_ROW_MAJOR, 12, 1, a, 12, pivot, u, 1);
  double worst = 0;
  for (int i = 0; i < 12; i++)
    worst = fmax(worst, fabs(u[i] - expected[i]));
  ok(worst < 6e-11, "every displacement of the sheared brick is CalculiX's to the printed digits: %.1e", worst);
}

static void check_rigid(void)
{
  double node[8][3], k[24][24], worst = 0, asymmetry = 0;
  for (int i = 0; i < 8; i++) {
    double x = i % 4 == 1 || i % 4 == 2, y = i % 4 >= 2, z = i / 4;
    node[i][0] = x * (1 - 0.3 * z) + 0.1 * y;
    node[i][1] = y * (1 + 0.2 * x);
    node[i][2] = z + 0.1 * x * y;
  }
  eo_brick_stiffness((const double(*)[3])node, &steel, k);
  for (int motion = 0; motion < 6; motion++)
    for (int i = 0; i < 24; i++) {
      double force = 0;
      for (int j = 0; j < 24; j++) {
        int c = j % 3, axis = motion - 3;
        const double *p = node[j / 3];
        double u = motion < 3            ? c == motion
                   : c == (axis + 1) % 3 ? -p[(axis + 2) % 3]
                   : c == (axis + 2) % 3 ? p[(axis + 1) % 3]
                                         : 0;
        force += k[i][j] * u;
        asymmetry = fmax(asymmetry, fabs(k[i][j] - k[j][i]));
      }
      worst = fmax(worst, fabs(force));
    }
  ok(worst < 1e-12 * 210e9, "rigid motions of a distorted brick need no force: %.1e N", worst);
  ok(asymmetry == 0, "the stiffness is symmetric to the last bit");
  memcpy(node[4], (double[]){0, 0, -1}, sizeof node[4]);
  ok(eo_brick_stiffness((const double(*)[3])node, &steel, k) == -1, "a brick turned inside out is refused");
}

int main(void)
{
  check_rigid();
  check_patch();
  check_bar();
  check_calculix();
  return tap_done();
}

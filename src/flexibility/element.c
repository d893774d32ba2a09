/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/element.h"

#include <math.h>
#include <string.h>

enum { MODES = 9 };

static const double corner[EO_BRICK_NODES][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                                 {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

/* Derivatives of the trilinear shape functions with respect to the three natural coordinates. */
static void shape_gradient(const double at[3], double gradient[EO_BRICK_NODES][3])
{
  for (int a = 0; a < EO_BRICK_NODES; a++) {
    double f[3];
    for (int d = 0; d < 3; d++)
      f[d] = 1 + corner[a][d] * at[d];
    for (int d = 0; d < 3; d++)
      gradient[a][d] = 0.125 * corner[a][d] * f[(d + 1) % 3] * f[(d + 2) % 3];
  }
}

/* inverse[d][i] = d(natural d)/d(x i); returns the determinant of d(x)/d(natural). */
static double invert_jacobian(const double node[EO_BRICK_NODES][3], const double gradient[EO_BRICK_NODES][3],
                              double inverse[3][3])
{
  double j[3][3] = {{0}};
  for (int a = 0; a < EO_BRICK_NODES; a++)
    for (int i = 0; i < 3; i++)
      for (int d = 0; d < 3; d++)
        j[i][d] += node[a][i] * gradient[a][d];
  double cofactor[3][3];
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 3; d++) {
      int i1 = (i + 1) % 3, i2 = (i + 2) % 3, d1 = (d + 1) % 3, d2 = (d + 2) % 3;
      cofactor[i][d] = j[i1][d1] * j[i2][d2] - j[i1][d2] * j[i2][d1];
    }
  double determinant = j[0][0] * cofactor[0][0] + j[0][1] * cofactor[0][1] + j[0][2] * cofactor[0][2];
  for (int d = 0; d < 3; d++)
    for (int i = 0; i < 3; i++)
      inverse[d][i] = cofactor[i][d] / determinant;
  return determinant;
}

/* Column of the strain-displacement matrix: strains xx yy zz xy yz zx of displacement `direction` with this gradient.
 */
static void strain_column(const double gradient[3], int direction, double strain[6])
{
  static const int shear[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}; /* place of strain (i, j) */
  memset(strain, 0, 6 * sizeof *strain);
  for (int i = 0; i < 3; i++)
    strain[shear[direction][i]] += gradient[i];
}

static void apply_elasticity(double lambda, double mu, const double strain[6], double stress[6])
{
  double volume = lambda * (strain[0] + strain[1] + strain[2]);
  for (int i = 0; i < 3; i++) {
    stress[i] = volume + 2 * mu * strain[i];
    stress[3 + i] = mu * strain[3 + i];
  }
}

/* All 33 strain columns at one Gauss point; returns the determinant of its Jacobian. */
static double strain_columns(const double node[EO_BRICK_NODES][3], const double at[3], double centre_inverse[3][3],
                             double centre_determinant, double strain[EO_BRICK_UNKNOWNS + MODES][6])
{
  double gradient[EO_BRICK_NODES][3], inverse[3][3];
  shape_gradient(at, gradient);
  double determinant = invert_jacobian(node, gradient, inverse);
  for (int a = 0; a < EO_BRICK_NODES; a++) {
    double physical[3] = {0};
    for (int d = 0; d < 3; d++)
      for (int i = 0; i < 3; i++)
        physical[i] += gradient[a][d] * inverse[d][i];
    for (int i = 0; i < 3; i++)
      strain_column(physical, i, strain[3 * a + i]);
  }
  for (int mode = 0; mode < 3; mode++) {
    double physical[3], slope = -2 * at[mode] * centre_determinant / determinant;
    for (int i = 0; i < 3; i++)
      physical[i] = slope * centre_inverse[mode][i];
    for (int i = 0; i < 3; i++)
      strain_column(physical, i, strain[EO_BRICK_UNKNOWNS + 3 * mode + i]);
  }
  return determinant;
}

/* Eliminates the last MODES unknowns of the symmetric matrix by Gauss steps, one at a time. */
static void condense(double k[EO_BRICK_UNKNOWNS + MODES][EO_BRICK_UNKNOWNS + MODES])
{
  for (int m = EO_BRICK_UNKNOWNS + MODES - 1; m >= EO_BRICK_UNKNOWNS; m--)
    for (int i = 0; i < m; i++) {
      double factor = k[i][m] / k[m][m]; /* theory (B1) */
      for (int j = 0; j < m; j++)
        k[i][j] -= factor * k[m][j];
    }
}

int eo_brick_stiffness(const double node[EO_BRICK_NODES][3], const struct eo_material *material,
                       double stiffness[EO_BRICK_UNKNOWNS][EO_BRICK_UNKNOWNS])
{
  enum { ALL = EO_BRICK_UNKNOWNS + MODES };
  double nu = material->poissons_ratio, mu = material->youngs_modulus / (2 * (1 + nu));
  double lambda = 2 * mu * nu / (1 - 2 * nu), place = 1 / sqrt(3.0);
  double gradient[EO_BRICK_NODES][3], centre_inverse[3][3], k[ALL][ALL] = {{0}};
  shape_gradient((const double[3]){0, 0, 0}, gradient);
  double centre_determinant = invert_jacobian(node, gradient, centre_inverse);
  for (int g = 0; g < EO_BRICK_NODES; g++) {
    double at[3] = {place * corner[g][0], place * corner[g][1], place * corner[g][2]}, strain[ALL][6];
    double determinant = strain_columns(node, at, centre_inverse, centre_determinant, strain);
    if (!(determinant > 0))
      return -1;
    for (int i = 0; i < ALL; i++) {
      double stress[6];
      apply_elasticity(lambda, mu, strain[i], stress);
      for (int j = 0; j < ALL; j++)
        for (int c = 0; c < 6; c++)
          k[i][j] += determinant * stress[c] * strain[j][c];
    }
  }
  condense(k);
  for (int i = 0; i < EO_BRICK_UNKNOWNS; i++)
    for (int j = 0; j < EO_BRICK_UNKNOWNS; j++)
      stiffness[i][j] = 0.5 * (k[i][j] + k[j][i]);
  return 0;
}

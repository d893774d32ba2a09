/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest principal stress found by part of the sums, beside that of all nodes in full, in every version of the
   kernel: shapes and coefficients that fall off fast, slowly and not at all, and rows whose largest hangs on the last
   shape. */
#include "base/random.h"
#include "flexibility/root_field.h"
#include "flexibility/stress.h"
#include "support/tap.h"

#include <stdlib.h>

enum { ROWS = 70 };

static double draw(int stream, int index)
{
  return 2 * eo_random_unit(eo_random_at(11, (uint64_t)stream, 0, (uint64_t)index), 0) - 1;
}

/* In double precision, from the shapes as they were given. */
static double find_plainly(int rank, int nodes, const double *shape, const float *coefficient, int *where)
{
  double largest = 0;
  *where = 0;
  for (int node = 0; node < nodes; node++) {
    double stress[EO_STRESSES] = {0};
    for (int k = 0; k < rank; k++)
      for (int part = 0; part < EO_STRESSES; part++)
        stress[part] += (double)coefficient[k] * shape[(k * nodes + node) * EO_STRESSES + part];
    double principal = (stress[0] + stress[1] + hypot(stress[0] - stress[1], 2 * stress[2])) / 2;
    if (principal > largest) {
      largest = principal;
      *where = node;
    }
  }
  return largest;
}

/* fall: of the coefficients, from one shape to the next. */
static void test_field(const struct eo_gram *gram, int rank, int nodes, double fall)
{
  struct eo_root_field field;
  struct eo_error error;
  int stride = (rank + EO_GRAM_COLUMNS - 1) / EO_GRAM_COLUMNS * EO_GRAM_COLUMNS, node[ROWS], wrong = 0, elsewhere = 0,
      in_tension = 0;
  double *shape = malloc(sizeof *shape * (size_t)(rank * nodes * EO_STRESSES)), largest[ROWS];
  float *coefficient = eo_gram_allocate(ROWS * stride / 2);
  for (int i = 0; i < rank * nodes * EO_STRESSES; i++)
    shape[i] = draw(1, i) + sin(0.3 * i / EO_STRESSES);
  for (int j = 0; j < ROWS; j++)
    for (int k = 0; k < rank; k++)
      coefficient[j * stride + k] = (float)(j == 3 ? 0 : draw(2, j * rank + k) * pow(fall, k));
  for (int j = 5; j < ROWS; j += 7)
    coefficient[j * stride + rank - 1] = 100;
  ok(eo_root_field_init(&field, rank, nodes, shape, &error) == EO_OK, "%s: a field of %d shapes on %d nodes is made",
     gram->name, rank, nodes);
  float *room = eo_gram_allocate((long)ROWS * field.columns / 2 + 1);
  eo_root_field_find_largest(&field, gram, ROWS, coefficient, stride, room, largest, node);
  for (int j = 0; j < ROWS; j++) {
    int where;
    double plain = find_plainly(rank, nodes, shape, coefficient + j * stride, &where);
    wrong += fabs(largest[j] - plain) > 3e-6 * plain;
    elsewhere += node[j] != where;
    in_tension += plain > 0;
  }
  ok(in_tension > ROWS / 2 && largest[3] == 0, "most rows are in tension, and one carries nothing");
  ok(wrong == 0, "a field falling by %g: %d of %d rows have another largest stress", fall, wrong, ROWS);
  ok(elsewhere == 0, "no row has its largest stress elsewhere, but %d", elsewhere);
  eo_root_field_done(&field);
  free(shape);
  free(coefficient);
  free(room);
}

int main(void)
{
  static const double fall[] = {0.7, 0.95, 1};
  for (int version = 0; eo_gram_version(version); version++)
    for (int i = 0; i < 3; i++) {
      test_field(eo_gram_version(version), 3, 40, fall[i]);
      test_field(eo_gram_version(version), 16, 16, fall[i]);
      test_field(eo_gram_version(version), 97, 319, fall[i]);
    }
  return tap_done();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/sobol_sequence.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"

enum { STREAM_STARTS = 901, STREAM_SCRAMBLE = 902 };    /* of the counter generator, apart from the optimizers' */
enum { CANDIDATES = 24, NEIGHBOURS = 16, JUDGED = 10 }; /* starts tried, dimensions before, bits of a projection */

/* x is primitive modulo the polynomial (with its leading and last term) when its powers run through all 2^degree - 1
   nonzero remainders. */
static int is_primitive(uint32_t polynomial, int degree)
{
  uint32_t power = 1, top = 1u << degree;
  for (uint32_t i = 1; i < top; i++) {
    power <<= 1;
    if (power & top)
      power ^= polynomial;
    if (power == 1)
      return i == top - 1;
  }
  return 0;
}

static int degree_of(uint32_t polynomial)
{
  int degree = 0;
  while (polynomial >> (degree + 1))
    degree++;
  return degree;
}

/* The next primitive polynomial above the given one. */
static uint32_t next_polynomial(uint32_t polynomial)
{
  do {
    polynomial += 2;
  } while (!is_primitive(polynomial, degree_of(polynomial)));
  return polynomial;
}

/* The recurrence of Bratley and Fox (1988): m_k = 2 a_1 m_(k-1) + .. + 2^s m_(k-s) + m_(k-s), in exclusive sums;
   direction k is m_k / 2^(k+1) in 32 bits. start: odd numbers, m_k < 2^(k+1). */
static void set_directions(uint32_t polynomial, const uint32_t *start, uint32_t direction[EO_SOBOL_BITS])
{
  int degree = degree_of(polynomial);
  for (int k = 0; k < EO_SOBOL_BITS; k++) {
    if (k < degree) {
      direction[k] = start[k] << (EO_SOBOL_BITS - 1 - k);
      continue;
    }
    direction[k] = direction[k - degree] ^ (direction[k - degree] >> degree);
    for (int i = 1; i < degree; i++)
      if (polynomial >> (degree - i) & 1)
        direction[k] ^= direction[k - i];
  }
}

/* Bit `row` of the digits of a point is the parity of its index with this row of the generator matrix. */
static uint32_t matrix_row(const uint32_t direction[EO_SOBOL_BITS], int row)
{
  uint32_t bits = 0;
  for (int k = 0; k < JUDGED; k++)
    bits |= (direction[k] >> (EO_SOBOL_BITS - 1 - row) & 1) << k;
  return bits;
}

static int rank_of(uint32_t row[JUDGED])
{
  int rank = 0;
  for (int bit = 0; bit < JUDGED; bit++) {
    int pivot = rank;
    while (pivot < JUDGED && !(row[pivot] >> bit & 1))
      pivot++;
    if (pivot == JUDGED)
      continue;
    uint32_t with = row[pivot];
    row[pivot] = row[rank];
    row[rank++] = with;
    for (int i = rank; i < JUDGED; i++)
      if (row[i] >> bit & 1)
        row[i] ^= with;
  }
  return rank;
}

/* How uneven 2^JUDGED points are in a plane: digits that the boxes 2^-q by 2^-(JUDGED - q) lack in sum over q. */
static int unevenness(const uint32_t a[EO_SOBOL_BITS], const uint32_t b[EO_SOBOL_BITS])
{
  uint32_t first[JUDGED], second[JUDGED];
  int lacking = 0;
  for (int row = 0; row < JUDGED; row++) {
    first[row] = matrix_row(a, row);
    second[row] = matrix_row(b, row);
  }
  for (int q = 1; q < JUDGED; q++) {
    uint32_t both[JUDGED];
    for (int row = 0; row < JUDGED; row++)
      both[row] = row < q ? first[row] : second[row - q];
    lacking += JUDGED - rank_of(both);
  }
  return lacking;
}

static int judge(const struct eo_sobol_sequence *sequence, int dimension, const uint32_t direction[EO_SOBOL_BITS])
{
  int sum = 0;
  for (int d = dimension > NEIGHBOURS ? dimension - NEIGHBOURS : 0; d < dimension; d++)
    sum += unevenness(sequence->direction[d], direction);
  return sum;
}

/* Of the starts that are drawn the most even one; of equal ones the first. */
static void choose_directions(struct eo_sobol_sequence *sequence, int dimension, uint32_t polynomial)
{
  int least = 0;
  for (int candidate = 0; candidate < CANDIDATES; candidate++) {
    struct eo_random random = eo_random_at(0, STREAM_STARTS, (uint64_t)dimension, (uint64_t)candidate);
    uint32_t start[EO_SOBOL_BITS], direction[EO_SOBOL_BITS];
    for (int k = 0; k < degree_of(polynomial); k++)
      start[k] = ((uint32_t)eo_random_bits(random, (uint64_t)k) | 1) & ((2u << k) - 1);
    set_directions(polynomial, start, direction);
    int lacking = judge(sequence, dimension, direction);
    if (candidate == 0 || lacking < least) {
      least = lacking;
      memcpy(sequence->direction[dimension], direction, sizeof direction);
    }
  }
}

enum eo_code eo_sobol_sequence_init(struct eo_sobol_sequence *sequence, int dimensions, struct eo_error *error)
{
  *sequence = (struct eo_sobol_sequence){.dimensions = dimensions};
  if (dimensions < 1 || dimensions > EO_SOBOL_DIMENSIONS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A Sobol sequence has 1 to %d dimensions, not %d.",
                        EO_SOBOL_DIMENSIONS, dimensions);
  sequence->direction = malloc(sizeof *sequence->direction * (size_t)dimensions);
  if (!sequence->direction)
    return eo_error_memory(error);
  for (int k = 0; k < EO_SOBOL_BITS; k++)
    sequence->direction[0][k] = 1u << (EO_SOBOL_BITS - 1 - k);
  uint32_t polynomial = 1;
  for (int d = 1; d < dimensions; d++) {
    polynomial = next_polynomial(polynomial);
    choose_directions(sequence, d, polynomial);
  }
  return EO_OK;
}

void eo_sobol_sequence_done(struct eo_sobol_sequence *sequence)
{
  if (sequence)
    free(sequence->direction);
}

/* Owen's scrambling: each binary digit is turned or not by a random bit that belongs to the digits before it; below the
   last digit comes a random remainder. */
static double scramble(uint64_t seed, int dimension, uint32_t digits)
{
  uint64_t scrambled = 0;
  for (int bit = 0; bit < EO_SOBOL_BITS; bit++) {
    uint64_t before = bit ? digits >> (EO_SOBOL_BITS - bit) : 0;
    struct eo_random random = eo_random_at(seed, STREAM_SCRAMBLE, (uint64_t)dimension, (uint64_t)bit);
    uint64_t turned = (digits >> (EO_SOBOL_BITS - 1 - bit) & 1) ^ (eo_random_bits(random, before) >> 63);
    scrambled = scrambled << 1 | turned;
  }
  struct eo_random random = eo_random_at(seed, STREAM_SCRAMBLE, (uint64_t)dimension, EO_SOBOL_BITS);
  uint64_t rest = eo_random_bits(random, digits) >> (64 - 20);
  return ((double)(scrambled << 20 | rest) + 0.5) * 0x1p-52;
}

double eo_sobol_sequence_at(const struct eo_sobol_sequence *sequence, uint64_t seed, uint32_t point, int dimension)
{
  uint32_t digits = 0;
  for (int k = 0; k < EO_SOBOL_BITS; k++)
    if (point >> k & 1)
      digits ^= sequence->direction[dimension][k];
  return scramble(seed, dimension, digits);
}

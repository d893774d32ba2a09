/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/pair_sampler.h"

#include <stdlib.h>

#include "base/random.h"
#include "tolerance/sobol_sequence.h"

enum { STREAM_LATIN = 903, STREAM_RANDOM = 904 }; /* of the counter generator */

struct eo_sampler {
  enum eo_sampling sampling;
  int dimensions, points;
  uint64_t seed;
  struct eo_sobol_sequence sequence;
  int *cell; /* [dimensions][points], Latin: the n-th that a point lies in */
};

static double unit(const struct eo_sampler *sampler, int stream, int dimension, int point)
{
  const double inside = 0x1p-54; /* never 0 */
  return eo_random_unit(eo_random_at(sampler->seed, (uint64_t)stream, (uint64_t)dimension, (uint64_t)point), 0) +
         inside;
}

/* A random permutation in each dimension (Fisher and Yates). */
static enum eo_code make_cells(struct eo_sampler *sampler, struct eo_error *error)
{
  int n = sampler->points;
  sampler->cell = malloc(sizeof *sampler->cell * (size_t)n * (size_t)sampler->dimensions);
  if (!sampler->cell)
    return eo_error_memory(error);
  for (int d = 0; d < sampler->dimensions; d++) {
    int *cell = sampler->cell + (size_t)d * (size_t)n;
    struct eo_random random = eo_random_at(sampler->seed, STREAM_LATIN, (uint64_t)d, (uint64_t)n);
    for (int i = 0; i < n; i++) {
      int j = eo_random_index(random, (uint64_t)i, i + 1);
      cell[i] = i;
      cell[i] = cell[j];
      cell[j] = i;
    }
  }
  return EO_OK;
}

enum eo_code eo_sampler_new(struct eo_sampler **result, enum eo_sampling sampling, int dimensions, int points,
                            uint64_t seed, struct eo_error *error)
{
  struct eo_sampler *sampler;
  if (points < 1 || dimensions < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is nothing to draw: at least one point and one input.");
  sampler = calloc(1, sizeof *sampler);
  if (!sampler)
    return eo_error_memory(error);
  sampler->sampling = sampling;
  sampler->dimensions = dimensions;
  sampler->points = points;
  sampler->seed = seed;
  enum eo_code code = EO_OK;
  if (sampling == EO_SAMPLING_SOBOL)
    code = eo_sobol_sequence_init(&sampler->sequence, dimensions, error);
  else if (sampling == EO_SAMPLING_LATIN)
    code = make_cells(sampler, error);
  if (code)
    eo_sampler_free(sampler);
  else
    *result = sampler;
  return code;
}

void eo_sampler_free(struct eo_sampler *sampler)
{
  if (!sampler)
    return;
  eo_sobol_sequence_done(&sampler->sequence);
  free(sampler->cell);
  free(sampler);
}

void eo_sampler_at(const struct eo_sampler *sampler, int point, double *u)
{
  for (int d = 0; d < sampler->dimensions; d++) {
    if (sampler->sampling == EO_SAMPLING_SOBOL)
      u[d] = eo_sobol_sequence_at(&sampler->sequence, sampler->seed, (uint32_t)point, d);
    else if (sampler->sampling == EO_SAMPLING_LATIN)
      u[d] = (sampler->cell[(size_t)d * (size_t)sampler->points + (size_t)point] +
              unit(sampler, STREAM_LATIN, d, sampler->points + 1 + point)) /
             sampler->points;
    else
      u[d] = unit(sampler, STREAM_RANDOM, d, point);
  }
}

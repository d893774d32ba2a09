/* SPDX-License-Identifier: GPL-3.0-or-later */
// pagmo's optimizers in the contest; built where pagmo is installed. One generation per call, so that the budget is
// watched.
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include <cmath>
#include <cstddef>

extern "C" {
#include "contest.h"
}

namespace
{

const double worst = 1e3; // of an evaluation that fails

struct contest_function {
  struct trace *trace = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double &x) const
  {
    if (trace->front) {
      pagmo::vector_double f(CONTEST_OBJECTIVES);
      trace_evaluate_front(trace, x.data(), f.data());
      for (double &value : f)
        value = std::isfinite(value) ? value : worst;
      return f;
    }
    const double value = trace_evaluate(trace, x.data());
    return {std::isfinite(value) ? value : worst};
  }
  pagmo::vector_double::size_type get_nobj() const
  {
    return trace && trace->front ? CONTEST_OBJECTIVES : 1;
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const
  {
    const std::size_t n = trace ? static_cast<std::size_t>(trace->n) : 1;
    return {pagmo::vector_double(n, 0), pagmo::vector_double(n, 1)};
  }
};

pagmo::algorithm make(int algorithm, unsigned seed)
{
  switch (algorithm) {
  case PAGMO_CMAES:
    return pagmo::algorithm{pagmo::cmaes{1, -1, -1, -1, -1, 0.3, 0, 0, true, true, seed}};
  case PAGMO_SADE:
    return pagmo::algorithm{pagmo::sade{1, 2, 1, 0, 0, true, seed}};
  case PAGMO_DE:
    return pagmo::algorithm{pagmo::de{1, 0.8, 0.9, 2, 0, 0, seed}};
  case PAGMO_NSGA2:
    return pagmo::algorithm{pagmo::nsga2{1, 0.95, 10, 0.1, 20, seed}};
  default:
    return pagmo::algorithm{pagmo::sga{1, 0.8, 10, 0.3, 20, 2, "sbx", "polynomial", "tournament", seed}};
  }
}

} // namespace

extern "C" void pagmo_run(struct trace *trace, int algorithm, unsigned population, unsigned seed)
{
  contest_function function;
  function.trace = trace;
  pagmo::population individuals{pagmo::problem{function}, population, seed};
  pagmo::algorithm evolution = make(algorithm, seed);
  while (trace->count < trace->budget)
    individuals = evolution.evolve(individuals);
}

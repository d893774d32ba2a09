// pagmo's optimizers on the test problems of bench-optimizer, in the same table. Built by `make bench-pagmo` only.
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

extern "C" {
#include "problems.h"
}

static const int marks[] = {100, 200, 400, 1000};
static const int budget = 1000, seeds = 11;

struct trace {
  struct problem problem;
  int count = 0;
  double best = std::numeric_limits<double>::infinity();
  double at[4];
};

static struct trace *current;

struct bench_problem {
  pagmo::vector_double fitness(const pagmo::vector_double &x) const
  {
    const double value = problem_value(&current->problem, x.data());
    if (current->count < budget)
      current->best = std::min(current->best, value);
    current->count++;
    for (int m = 0; m < 4; m++)
      if (current->count <= marks[m])
        current->at[m] = current->best;
    return {value};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const
  {
    const std::size_t n = static_cast<std::size_t>(current->problem.n);
    return {pagmo::vector_double(n, 0), pagmo::vector_double(n, 1)};
  }
};

struct contestant {
  const char *name;
  unsigned population;
  std::function<pagmo::algorithm(unsigned)> make; // one generation per call, so that the budget can be watched
};

static void run(const contestant &c, trace &t, unsigned seed)
{
  current = &t;
  pagmo::population population{pagmo::problem{bench_problem{}}, c.population, seed};
  pagmo::algorithm algorithm = c.make(seed);
  while (t.count < budget)
    population = algorithm.evolve(population);
}

static void print_line(const contestant &c, int kind, int n)
{
  std::vector<double> at[4];
  for (int s = 1; s <= seeds; s++) {
    trace t;
    problem_init(&t.problem, kind, n, static_cast<uint64_t>(s));
    run(c, t, static_cast<unsigned>(s));
    for (int m = 0; m < 4; m++)
      at[m].push_back(t.at[m]);
  }
  std::printf("%-13s %2d  %-15s", problem_name(kind), n, c.name);
  for (auto &values : at) {
    std::sort(values.begin(), values.end());
    std::printf("  %8.2e (%7.1e %7.1e)", values[seeds / 2], values[seeds / 4], values[seeds - 1 - seeds / 4]);
  }
  std::printf("\n");
}

int main()
{
  const contestant contestants[] = {
      {"pagmo-cmaes", 10, [](unsigned seed) {
         pagmo::cmaes c{1, -1, -1, -1, -1, 0.3, 0, 0, true, true};
         c.set_seed(seed);
         return pagmo::algorithm{c};
       }},
      {"pagmo-sade", 20, [](unsigned seed) { return pagmo::algorithm{pagmo::sade{1, 2, 1, 0, 0, true, seed}}; }},
      {"pagmo-de", 20, [](unsigned seed) { return pagmo::algorithm{pagmo::de{1, 0.8, 0.9, 2, 0, 0, seed}}; }},
      {"pagmo-sga", 50, [](unsigned seed) { return pagmo::algorithm{pagmo::sga{1, 0.8, 10, 0.3, 20, 2, "sbx", "polynomial", "tournament", seed}}; }},
  };
  for (int n : {5, 10})
    for (int kind = 0; kind < PROBLEMS; kind++)
      for (const contestant &c : contestants)
        print_line(c, kind, n);
  return 0;
}

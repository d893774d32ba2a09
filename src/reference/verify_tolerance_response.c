/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Responses that are written out, as a text or as c0 + b x + x Q x. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/known_law.h"
#include "tolerance/influence.h"
#include "tolerance/response_surface.h"
#include "tolerance/statistics.h"

enum { FUNCTION_POINTS = 4096, SURFACE_POINTS = 512, INDEX_POINTS = 4096 };

struct response {
  const char *text;    /* NULL: c0 + b x + x Q x */
  int inputs, squares; /* squares: the sum of so many, where the text says no more */
  double constant, linear[EO_BENCH_INPUTS], square[EO_BENCH_INPUTS][EO_BENCH_INPUTS];
  struct eo_distribution of[EO_BENCH_INPUTS];
};

static double response_at(const struct response *response, const double *x)
{
  double y = response->constant;
  if (response->text)
    return eo_response_value(response->text, x, NULL);
  for (int i = 0; i < response->inputs; i++) {
    y += response->linear[i] * x[i] + (response->squares ? x[i] * x[i] : 0);
    for (int j = 0; j < response->inputs && !response->squares; j++)
      y += x[i] * response->square[i][j] * x[j];
  }
  return y;
}

static double response_of_unit(void *context, const double *u)
{
  const struct response *response = context;
  double x[EO_BENCH_INPUTS];
  for (int i = 0; i < response->inputs; i++)
    x[i] = eo_distribution_quantile(&response->of[i], u[i]);
  return response_at(response, x);
}

/* "x normal with sigma 1, 2, 3", "x standard normal", "x uniform in +-pi". */
static bool read_inputs_text(const char *text, struct response *response)
{
  const char *sigma = strstr(text, "normal with sigma"), *uniform = strstr(text, "uniform in +-");
  bool good = sigma || uniform || strstr(text, "standard normal");
  for (int i = 0; i < response->inputs; i++) {
    response->of[i] = (struct eo_distribution){.kind = EO_DISTRIBUTION_NORMAL, .sigma = 1, .cut = INFINITY};
    if (sigma) {
      char *end;
      sigma += i == 0 ? strlen("normal with sigma") : strspn(sigma, ", ");
      response->of[i].sigma = strtod(sigma, &end);
      good = good && end != sigma;
      sigma = end;
    }
    if (uniform) {
      const char *half = uniform + strlen("uniform in +-");
      double width = strncmp(half, "pi", 2) == 0 ? M_PI : strtod(half, NULL);
      response->of[i] = (struct eo_distribution){.kind = EO_DISTRIBUTION_UNIFORM, .low = -width, .high = width};
    }
  }
  return good;
}

/* "chi-square, 1 degree: x1^2", or "3 degrees": as many squares. */
static bool read_response_text(const char *text, struct response *response)
{
  const char *colon = strchr(text, ':'), *formula = strstr(text, "y = ");
  double one[EO_BENCH_INPUTS];
  for (int i = 0; i < EO_BENCH_INPUTS; i++)
    one[i] = 1;
  response->text = formula ? formula + 4 : colon ? colon + 1 : NULL;
  if (response->text)
    return !isnan(eo_response_value(response->text, one, &response->inputs)) && response->inputs > 0;
  response->inputs = response->squares = (int)strtol(text, NULL, 10);
  return response->inputs > 0 && response->inputs <= EO_BENCH_INPUTS;
}

static bool read_quadratic(struct eo_case *item, struct response *response)
{
  struct eo_case *this_case = eo_case_find(item, "b"), *the_case = eo_case_find(item, "Q");
  if (!this_case || !the_case)
    return false;
  response->constant = eo_case_number(item, "c0");
  response->inputs = eo_case_numbers(this_case, -1, EO_BENCH_INPUTS, response->linear);
  for (int i = 0; i < response->inputs; i++)
    eo_case_numbers(eo_case_at(the_case, i), response->inputs, EO_BENCH_INPUTS, response->square[i]);
  return true;
}

/* Draws the response. value[FUNCTION_POINTS], input[FUNCTION_POINTS][inputs]. */
static enum eo_code draw_response(const struct response *response, double *input, double *value, struct eo_error *error)
{
  struct eo_bench_input column[EO_BENCH_INPUTS];
  for (int i = 0; i < response->inputs; i++)
    column[i] = (struct eo_bench_input){.distribution = response->of[i]};
  EO_TRY(eo_bench_draw(column, response->inputs, FUNCTION_POINTS, input, error));
  for (size_t i = 0; i < FUNCTION_POINTS; i++)
    value[i] = response_at(response, input + i * (size_t)response->inputs);
  return EO_OK;
}

static void check_indices(struct eo_verification *verification, struct eo_case *expected,
                          const struct response *response, const double first[], const double total[], double within)
{
  if (eo_case_find(expected, "sobol_first"))
    eo_verify_list(verification, eo_case_find(expected, "sobol_first"), response->inputs, first, 1, 0, within);
  if (eo_case_find(expected, "sobol_total"))
    eo_verify_list(verification, eo_case_find(expected, "sobol_total"), response->inputs, total, 1, 0, within);
}

/* Indices of the quadratic surface where it carries, of the response itself where it says that it does not. */
static enum eo_code check_response_indices(struct eo_verification *verification, struct eo_case *item,
                                           struct eo_case *expected, struct response *response, const double *input,
                                           const double *value, struct eo_error *error)
{
  double first[EO_BENCH_INPUTS], total[EO_BENCH_INPUTS];
  struct eo_moments moments[EO_BENCH_INPUTS];
  struct eo_surface surface;
  struct eo_case *tolerance = eo_case_find(item, "tolerance"), *sampled = eo_case_find(tolerance, "sobol");
  for (int i = 0; i < response->inputs; i++)
    moments[i] = eo_distribution_moments(&response->of[i]);
  enum eo_code code = eo_surface_fit(&surface, SURFACE_POINTS, response->inputs, moments, input, value, error);
  bool carries = !code && surface.q2 > 0.99;
  if (carries)
    eo_surface_indices(&surface, first, total);
  eo_surface_done(&surface);
  if (!code && !carries)
    code = eo_sobol_indices(response_of_unit, response, response->inputs, INDEX_POINTS, 1, first, total, error);
  if (code)
    return code;
  bool number = sampled && !eo_case_is_text(sampled);
  eo_verify_fact(verification, item, "a quadratic surface says whether it carries", carries != number);
  check_indices(verification, expected, response, first, total, number ? eo_case_real(sampled) : eo_index_tolerance);
  return EO_OK;
}

/* Room of a response: what is drawn, and what comes of it. */
struct drawn {
  double *input; /* [FUNCTION_POINTS][inputs] */
  double *value; /* [FUNCTION_POINTS] */
};

static enum eo_code check_drawn(struct eo_verification *verification, struct eo_case *item, struct eo_case *expected,
                                struct eo_case *law, struct response *response, const struct drawn *drawn,
                                struct eo_error *error)
{
  double coefficient[EO_BENCH_INPUTS];
  struct eo_regression regression = {.coefficient = coefficient};
  struct eo_case *standardised = eo_case_find(expected, "standardised_regression");
  EO_TRY(draw_response(response, drawn->input, drawn->value, error));
  struct eo_known_law known = {verification, FUNCTION_POINTS, drawn->value, 0};
  EO_TRY(eo_verify_law(&known, law, error));
  if (standardised) {
    EO_TRY(eo_regression_run(&regression, FUNCTION_POINTS, response->inputs, drawn->input, drawn->value, error));
    eo_verify_list(verification, standardised, response->inputs, coefficient, 1, 0, eo_index_tolerance);
  }
  return eo_case_find(expected, "sobol_first")
             ? check_response_indices(verification, item, expected, response, drawn->input, drawn->value, error)
             : EO_OK;
}

static enum eo_code check_response(struct eo_verification *verification, struct eo_case *item, struct eo_case *expected,
                                   struct eo_case *law, struct response *response, struct eo_error *error)
{
  struct drawn drawn = {.input = malloc(sizeof(double) * FUNCTION_POINTS * (size_t)(response->inputs + 1))};
  if (!drawn.input)
    return eo_error_memory(error);
  drawn.value = drawn.input + (size_t)FUNCTION_POINTS * (size_t)response->inputs;
  enum eo_code code = check_drawn(verification, item, expected, law, response, &drawn, error);
  free(drawn.input);
  return code;
}

enum eo_code eo_verify_tolerance_response(struct eo_verification *verification, struct eo_case *item,
                                          struct eo_error *error)
{
  struct eo_case *expected = eo_case_need(item, "expected");
  const char *what = eo_case_peek_text(item, "what");
  bool many = eo_case_is_list(expected);
  if (!many)
    eo_case_remark(expected, "sobol_note");
  for (int i = 0; i < (many ? eo_case_size(expected) : 1) && !eo_case_faulty(item); i++) {
    struct eo_case *own = many ? eo_case_at(expected, i) : expected, *law = many ? own : eo_case_need(own, "y");
    struct response response = {0};
    const char *text = many ? eo_case_word(own, "y") : what;
    if (!read_quadratic(item, &response) && !(text && read_response_text(text, &response)))
      eo_case_fault(own, "The response cannot be read.");
    if (!what || !read_inputs_text(what, &response))
      eo_case_fault(item, "\"what\" says how x is distributed.");
    if (!eo_case_faulty(item))
      EO_TRY(check_response(verification, item, own, law, &response, error));
  }
  return EO_OK;
}

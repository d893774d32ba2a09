/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/formula.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A number (size 1) or a vector. */
struct value {
  int size;
  double element[EO_FORMULA_VARIABLES];
};

struct reader {
  const char *at, *start;
  const double *x;
  int n, depth;
  const char *fault; /* what went wrong first */
  const char *fault_at;
};

enum { DEEPEST = 40 };

static struct value read_sum(struct reader *r);

static struct value number(double v)
{
  return (struct value){.size = 1, .element = {v}};
}

static struct value fail(struct reader *r, const char *fault)
{
  if (!r->fault) {
    r->fault = fault;
    r->fault_at = r->at;
  }
  return number(NAN);
}

static bool take(struct reader *r, char c)
{
  while (isspace((unsigned char)*r->at))
    r->at++;
  if (*r->at != c)
    return false;
  r->at++;
  return true;
}

static double apply_operator(char op, double a, double b)
{
  switch (op) {
  case '+':
    return a + b;
  case '-':
    return a - b;
  case '*':
    return a * b;
  case '/':
    return a / b;
  default:
    return b == 2 ? a * a : pow(a, b);
  }
}

static struct value combine(struct reader *r, char op, const struct value *a, const struct value *b)
{
  if (a->size != b->size && a->size != 1 && b->size != 1)
    return fail(r, "vectors of different length meet");
  struct value result = {.size = a->size > b->size ? a->size : b->size};
  for (int i = 0; i < result.size; i++)
    result.element[i] = apply_operator(op, a->element[a->size == 1 ? 0 : i], b->element[b->size == 1 ? 0 : i]);
  return result;
}

static double reduce(const char *name, const struct value *v, bool *known)
{
  double sum = 0, product = 1, squares = 0, low = INFINITY, high = -INFINITY;
  for (int i = 0; i < v->size; i++) {
    sum += v->element[i];
    product *= v->element[i];
    squares += v->element[i] * v->element[i];
    low = fmin(low, v->element[i]);
    high = fmax(high, v->element[i]);
  }
  const struct {
    const char *name;
    double value;
  } all[] = {{"sum", sum}, {"mean", sum / v->size}, {"prod", product},
             {"min", low}, {"max", high},           {"norm", sqrt(squares)}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (strcmp(name, all[i].name) == 0)
      return all[i].value;
  *known = false;
  return NAN;
}

static struct value apply_function(struct reader *r, const char *name, const struct value *argument)
{
  static const struct {
    const char *name;
    double (*function)(double);
  } all[] = {{"exp", exp}, {"log", log}, {"sqrt", sqrt}, {"abs", fabs}, {"sin", sin}, {"cos", cos}, {"tanh", tanh}};
  for (size_t f = 0; f < sizeof all / sizeof *all; f++) {
    if (strcmp(name, all[f].name) != 0)
      continue;
    struct value result = {.size = argument->size};
    for (int i = 0; i < result.size; i++)
      result.element[i] = all[f].function(argument->element[i]);
    return result;
  }
  bool known = true;
  const double reduced = reduce(name, argument, &known);
  return known ? number(reduced) : fail(r, "there is no such function");
}

static struct value read_vector(struct reader *r)
{
  struct value result = {0};
  do {
    const struct value element = read_sum(r);
    if (result.size == EO_FORMULA_VARIABLES || element.size != 1)
      return fail(r, "a vector holds up to 64 numbers");
    result.element[result.size++] = element.element[0];
  } while (take(r, ','));
  return take(r, ']') ? result : fail(r, "a ] is missing");
}

/* Where "name = ..." is defined after the expression, or NULL. */
static const char *find_definition(const struct reader *r, const char *name)
{
  for (const char *p = r->start; (p = strchr(p, '=')); p++) {
    const char *end = p;
    while (end > r->start && isspace((unsigned char)end[-1]))
      end--;
    const char *begin = end;
    while (begin > r->start && (isalnum((unsigned char)begin[-1]) || begin[-1] == '_'))
      begin--;
    if ((size_t)(end - begin) == strlen(name) && strncmp(begin, name, strlen(name)) == 0)
      return p + 1;
  }
  return NULL;
}

static struct value read_constant(struct reader *r, const char *name)
{
  struct value result = {.size = r->n};
  if (strcmp(name, "pi") == 0)
    return number(M_PI);
  if (strcmp(name, "n") == 0)
    return number(r->n);
  for (int i = 0; i < r->n; i++)
    result.element[i] = strcmp(name, "x") == 0 ? r->x[i] : i + 1;
  if (strcmp(name, "x") == 0 || strcmp(name, "k") == 0)
    return result;
  struct reader definition = *r;
  definition.at = find_definition(r, name);
  if (!definition.at)
    return fail(r, "a name is not defined");
  result = read_sum(&definition);
  return definition.fault ? fail(r, definition.fault) : result;
}

static struct value read_name(struct reader *r)
{
  char name[32];
  size_t length = 0;
  while ((isalnum((unsigned char)*r->at) || *r->at == '_') && length + 1 < sizeof name)
    name[length++] = *r->at++;
  name[length] = '\0';
  if (!take(r, '('))
    return read_constant(r, name);
  const struct value argument = read_sum(r);
  return take(r, ')') ? apply_function(r, name, &argument) : fail(r, "a ) is missing");
}

static struct value read_atom(struct reader *r)
{
  if (take(r, '(')) {
    const struct value inner = read_sum(r);
    return take(r, ')') ? inner : fail(r, "a ) is missing");
  }
  if (take(r, '['))
    return read_vector(r);
  if (isalpha((unsigned char)*r->at))
    return read_name(r);
  if (!isdigit((unsigned char)*r->at) && *r->at != '.')
    return fail(r, "a number, a name or a bracket is missing");
  char *end;
  const double v = strtod(r->at, &end);
  r->at = end;
  return number(v);
}

static struct value read_power(struct reader *r)
{
  const bool negative = take(r, '-');
  struct value result = read_atom(r);
  if (take(r, '^')) {
    const struct value exponent = read_power(r);
    result = combine(r, '^', &result, &exponent);
  }
  const struct value minus_one = number(-1);
  return negative ? combine(r, '*', &minus_one, &result) : result;
}

static struct value read_product(struct reader *r)
{
  struct value result = read_power(r);
  for (;;) {
    const char op = take(r, '*') ? '*' : take(r, '/') ? '/' : '\0';
    if (!op)
      return result;
    const struct value right = read_power(r);
    result = combine(r, op, &result, &right);
  }
}

static struct value read_sum(struct reader *r)
{
  if (++r->depth > DEEPEST)
    return fail(r, "it is nested too deeply");
  struct value result = read_product(r);
  for (;;) {
    const char op = take(r, '+') ? '+' : take(r, '-') ? '-' : '\0';
    if (!op || r->fault)
      break;
    const struct value right = read_product(r);
    result = combine(r, op, &result, &right);
  }
  r->depth--;
  return result;
}

enum eo_code eo_formula_evaluate(const char *text, const double *x, int n, double *value, struct eo_error *error)
{
  if (n < 1 || n > EO_FORMULA_VARIABLES)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A formula takes 1 to %d variables, not %d.", EO_FORMULA_VARIABLES,
                        n);
  struct reader r = {.at = text, .start = text, .x = x, .n = n};
  const struct value result = read_sum(&r);
  if (!r.fault && result.size != 1)
    fail(&r, "it is a vector, not a number");
  if (!r.fault && !take(&r, ',') && !take(&r, ';') && *r.at != '\0')
    fail(&r, "something is left over");
  if (r.fault)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The formula \"%.200s\" cannot be read: %s, at character %d.", text,
                        r.fault, (int)(r.fault_at - text) + 1);
  *value = result.element[0];
  return EO_OK;
}

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

static struct value read_sum(struct reader *reader);

static struct value number(double v)
{
  return (struct value){.size = 1, .element = {v}};
}

static struct value fail(struct reader *reader, const char *fault)
{
  if (!reader->fault) {
    reader->fault = fault;
    reader->fault_at = reader->at;
  }
  return number(NAN);
}

static bool take(struct reader *reader, char c)
{
  while (isspace((unsigned char)*reader->at))
    reader->at++;
  if (*reader->at != c)
    return false;
  reader->at++;
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

static struct value combine(struct reader *reader, char op, const struct value *a, const struct value *b)
{
  if (a->size != b->size && a->size != 1 && b->size != 1)
    return fail(reader, "vectors of different length meet");
  struct value result = {.size = a->size > b->size ? a->size : b->size};
  for (int i = 0; i < result.size; i++)
    result.element[i] = apply_operator(op, a->element[a->size == 1 ? 0 : i], b->element[b->size == 1 ? 0 : i]);
  return result;
}

static double reduce(const char *name, const struct value *this_value, bool *known)
{
  double sum = 0, product = 1, squares = 0, low = INFINITY, high = -INFINITY;
  for (int i = 0; i < this_value->size; i++) {
    sum += this_value->element[i];
    product *= this_value->element[i];
    squares += this_value->element[i] * this_value->element[i];
    low = fmin(low, this_value->element[i]);
    high = fmax(high, this_value->element[i]);
  }
  const struct {
    const char *name;
    double value;
  } all[] = {{"sum", sum},  {"mean", sum / this_value->size}, {"prod", product}, {"min", low},
             {"max", high}, {"norm", sqrt(squares)}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (strcmp(name, all[i].name) == 0)
      return all[i].value;
  *known = false;
  return NAN;
}

static struct value apply_function(struct reader *reader, const char *name, const struct value *argument)
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
  return known ? number(reduced) : fail(reader, "there is no such function");
}

static struct value read_vector(struct reader *reader)
{
  struct value result = {0};
  do {
    const struct value element = read_sum(reader);
    if (result.size == EO_FORMULA_VARIABLES || element.size != 1)
      return fail(reader, "a vector holds up to 64 numbers");
    result.element[result.size++] = element.element[0];
  } while (take(reader, ','));
  return take(reader, ']') ? result : fail(reader, "a ] is missing");
}

/* Where "name = ..." is defined after the expression, or NULL. */
static const char *find_definition(const struct reader *reader, const char *name)
{
  for (const char *p = reader->start; (p = strchr(p, '=')); p++) {
    const char *end = p;
    while (end > reader->start && isspace((unsigned char)end[-1]))
      end--;
    const char *begin = end;
    while (begin > reader->start && (isalnum((unsigned char)begin[-1]) || begin[-1] == '_'))
      begin--;
    if ((size_t)(end - begin) == strlen(name) && strncmp(begin, name, strlen(name)) == 0)
      return p + 1;
  }
  return NULL;
}

static struct value read_constant(struct reader *reader, const char *name)
{
  struct value result = {.size = reader->n};
  if (strcmp(name, "pi") == 0)
    return number(M_PI);
  if (strcmp(name, "n") == 0)
    return number(reader->n);
  for (int i = 0; i < reader->n; i++)
    result.element[i] = strcmp(name, "x") == 0 ? reader->x[i] : i + 1;
  if (strcmp(name, "x") == 0 || strcmp(name, "k") == 0)
    return result;
  struct reader definition = *reader;
  definition.at = find_definition(reader, name);
  if (!definition.at)
    return fail(reader, "a name is not defined");
  result = read_sum(&definition);
  return definition.fault ? fail(reader, definition.fault) : result;
}

static struct value read_name(struct reader *reader)
{
  char name[32];
  size_t length = 0;
  while ((isalnum((unsigned char)*reader->at) || *reader->at == '_') && length + 1 < sizeof name)
    name[length++] = *reader->at++;
  name[length] = '\0';
  if (!take(reader, '('))
    return read_constant(reader, name);
  const struct value argument = read_sum(reader);
  return take(reader, ')') ? apply_function(reader, name, &argument) : fail(reader, "a ) is missing");
}

static struct value read_atom(struct reader *reader)
{
  if (take(reader, '(')) {
    const struct value inner = read_sum(reader);
    return take(reader, ')') ? inner : fail(reader, "a ) is missing");
  }
  if (take(reader, '['))
    return read_vector(reader);
  if (isalpha((unsigned char)*reader->at))
    return read_name(reader);
  if (!isdigit((unsigned char)*reader->at) && *reader->at != '.')
    return fail(reader, "a number, a name or a bracket is missing");
  char *end;
  const double v = strtod(reader->at, &end);
  reader->at = end;
  return number(v);
}

static struct value read_power(struct reader *reader)
{
  const bool negative = take(reader, '-');
  struct value result = read_atom(reader);
  if (take(reader, '^')) {
    const struct value exponent = read_power(reader);
    result = combine(reader, '^', &result, &exponent);
  }
  const struct value minus_one = number(-1);
  return negative ? combine(reader, '*', &minus_one, &result) : result;
}

static struct value read_product(struct reader *reader)
{
  struct value result = read_power(reader);
  for (;;) {
    const char op = take(reader, '*') ? '*' : take(reader, '/') ? '/' : '\0';
    if (!op)
      return result;
    const struct value right = read_power(reader);
    result = combine(reader, op, &result, &right);
  }
}

static struct value read_sum(struct reader *reader)
{
  if (++reader->depth > DEEPEST)
    return fail(reader, "it is nested too deeply");
  struct value result = read_product(reader);
  for (;;) {
    const char op = take(reader, '+') ? '+' : take(reader, '-') ? '-' : '\0';
    if (!op || reader->fault)
      break;
    const struct value right = read_product(reader);
    result = combine(reader, op, &result, &right);
  }
  reader->depth--;
  return result;
}

enum eo_code eo_formula_evaluate(const char *text, const double *x, int n, double *value, struct eo_error *error)
{
  if (n < 1 || n > EO_FORMULA_VARIABLES)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A formula takes 1 to %d variables, not %d.", EO_FORMULA_VARIABLES,
                        n);
  struct reader reader = {.at = text, .start = text, .x = x, .n = n};
  const struct value result = read_sum(&reader);
  if (!reader.fault && result.size != 1)
    fail(&reader, "it is a vector, not a number");
  if (!reader.fault && !take(&reader, ',') && !take(&reader, ';') && *reader.at != '\0')
    fail(&reader, "something is left over");
  if (reader.fault)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The formula \"%.200s\" cannot be read: %s, at character %d.", text,
                        reader.fault, (int)(reader.fault_at - text) + 1);
  *value = result.element[0];
  return EO_OK;
}

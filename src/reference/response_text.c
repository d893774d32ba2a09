/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Responses as people write them: products without a sign, sin^2 x. */
#include "reference/verify_tolerance.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct text_reader {
  const char *at;
  const double *x;
  int inputs;
  bool failed;
};

static double read_terms(struct text_reader *reader);

static void skip_spaces(struct text_reader *reader)
{
  while (*reader->at == ' ')
    reader->at++;
}

static bool take(struct text_reader *reader, const char *word)
{
  skip_spaces(reader);
  if (strncmp(reader->at, word, strlen(word)) != 0)
    return false;
  reader->at += strlen(word);
  return true;
}

/* "^2" behind a factor, or 1. */
static double exponent(struct text_reader *reader)
{
  char *end;
  if (*reader->at != '^')
    return 1;
  double e = strtod(reader->at + 1, &end);
  reader->at = end;
  return e;
}

/* "x3" */
static double read_input(struct text_reader *reader)
{
  char *end;
  long index = strtol(reader->at + 1, &end, 10);
  if (end == reader->at + 1 || index < 1 || index > EO_BENCH_INPUTS) {
    reader->failed = true;
    return NAN;
  }
  reader->at = end;
  reader->inputs = index > reader->inputs ? (int)index : reader->inputs;
  double value = reader->x[index - 1];
  return pow(value, exponent(reader));
}

static bool starts_factor(struct text_reader *reader)
{
  skip_spaces(reader);
  const char *at = reader->at;
  return isdigit((unsigned char)*at) || *at == '.' || (*at == 'x' && isdigit((unsigned char)at[1])) ||
         strncmp(at, "sin", 3) == 0 || strncmp(at, "cos", 3) == 0 || (*at == '(' && at[1] == 'x');
}

static double read_factor(struct text_reader *reader)
{
  bool sine = take(reader, "sin"), cosine = !sine && take(reader, "cos");
  if (sine || cosine) {
    double power = exponent(reader), argument = read_factor(reader);
    return pow(sine ? sin(argument) : cos(argument), power);
  }
  if (take(reader, "(")) {
    double inner = read_terms(reader);
    reader->failed |= !take(reader, ")");
    return pow(inner, exponent(reader));
  }
  skip_spaces(reader);
  if (*reader->at == 'x')
    return read_input(reader);
  char *end;
  double number = strtod(reader->at, &end);
  reader->failed |= end == reader->at;
  reader->at = end;
  return number;
}

static double read_product(struct text_reader *reader)
{
  double value = read_factor(reader);
  while (!reader->failed && starts_factor(reader))
    value *= read_factor(reader);
  return value;
}

static double read_terms(struct text_reader *reader)
{
  double sum = take(reader, "-") ? -read_product(reader) : read_product(reader);
  while (!reader->failed) {
    if (take(reader, "+"))
      sum += read_product(reader);
    else if (take(reader, "-"))
      sum -= read_product(reader);
    else
      break;
  }
  return sum;
}

double eo_response_value(const char *text, const double *x, int *inputs)
{
  struct text_reader reader = {.at = text, .x = x};
  double value = read_terms(&reader);
  if (inputs)
    *inputs = reader.inputs;
  return reader.failed ? NAN : value;
}

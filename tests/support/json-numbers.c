/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers in JSON files, for the shell's tests.
     json-numbers FILE PLACE                                        prints them as an array
     json-numbers FILE PLACE FILE PLACE TOLERANCE [KIND [FACTOR]]   compares: the second times FACTOR is expected
   PLACE: a JSON pointer in which * stands for every entry. KIND: absolute; relative; level: absolute, less the mean
   difference. Exit status 0: as expected; 1: not. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 100000 };
struct numbers {
  int count;
  double value[MOST];
};

static void gather(const json_t *node, const char *place, struct numbers *out);

static void gather_key(const json_t *node, const char *key, size_t length, const char *rest, struct numbers *out)
{
  char text[100];
  size_t i;
  const char *name;
  json_t *child;
  snprintf(text, sizeof text, "%.*s", (int)length, key);
  if (strcmp(text, "*") == 0 && json_is_array(node))
    json_array_foreach(node, i, child) gather(child, rest, out);
  else if (strcmp(text, "*") == 0)
    json_object_foreach((json_t *)node, name, child) gather(child, rest, out);
  else
    gather(json_is_array(node) ? json_array_get(node, strtoul(text, NULL, 10)) : json_object_get(node, text), rest,
           out);
}

static void gather(const json_t *node, const char *place, struct numbers *out)
{
  if (*place == '/') {
    size_t length = strcspn(place + 1, "/");
    gather_key(node, place + 1, length, place + 1 + length, out);
  } else if (json_is_array(node))
    gather(node, "/*", out);
  else if (out->count < MOST)
    out->value[out->count++] = json_is_number(node) ? json_number_value(node) : NAN;
}

static struct numbers *read_numbers(const char *file, const char *place)
{
  json_error_t error;
  json_t *root = json_load_file(file, 0, &error);
  struct numbers *out = calloc(1, sizeof *out);
  if (!root || !out) {
    printf("%s: %s\n", file, root ? "no memory" : error.text);
    exit(1);
  }
  gather(root, place, out);
  json_decref(root);
  return out;
}

static int compare(const struct numbers *is, const struct numbers *expected, double tolerance, const char *kind,
                   double factor)
{
  double mean = 0, largest = 0;
  if (is->count != expected->count || !is->count) {
    printf("%d numbers, expected %d\n", is->count, expected->count);
    return 1;
  }
  for (int i = 0; i < is->count && strcmp(kind, "level") == 0; i++)
    mean += (is->value[i] - factor * expected->value[i]) / is->count;
  for (int i = 0; i < is->count; i++) {
    double goal = factor * expected->value[i], difference = fabs(is->value[i] - mean - goal);
    difference = strcmp(kind, "relative") == 0 ? difference / fabs(goal) : difference;
    largest = difference <= largest ? largest : difference; /* a NaN stays */
  }
  printf("%d numbers, largest %s difference %.3g, tolerance %g\n", is->count, kind, largest, tolerance);
  return !(largest <= tolerance);
}

int main(int argc, char **argv)
{
  if (argc != 3 && (argc < 6 || argc > 8))
    return 2;
  struct numbers *first = read_numbers(argv[1], argv[2]), *second = argc > 3 ? read_numbers(argv[3], argv[4]) : NULL;
  int status = 0;
  if (second)
    status = compare(first, second, atof(argv[5]), argc > 6 ? argv[6] : "absolute", argc > 7 ? atof(argv[7]) : 1);
  for (int i = 0; i < first->count && !second; i++)
    printf("%s%.17g%s", i ? "," : "[", first->value[i], i == first->count - 1 ? "]\n" : "");
  free(first);
  free(second);
  return status;
}

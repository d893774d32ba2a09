/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/key_faults.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Levenshtein's distance between two keys, at most 63 bytes of each. */
static int key_distance(const char *a, const char *b)
{
  int row[64], m = (int)strnlen(a, 63), n = (int)strnlen(b, 63);
  for (int j = 0; j <= n; j++)
    row[j] = j;
  for (int i = 1; i <= m; i++) {
    int diagonal = row[0];
    row[0] = i;
    for (int j = 1; j <= n; j++) {
      int change = diagonal + (a[i - 1] != b[j - 1]), gap = 1 + (row[j] < row[j - 1] ? row[j] : row[j - 1]);
      diagonal = row[j];
      row[j] = change < gap ? change : gap;
    }
  }
  return row[n];
}

/* The way down from a table to a key of one of its objects, for instance "pinion/left/"; false: there is none. */
static bool find_below(const struct eo_table *table, const char *key, int levels, char *way, size_t size)
{
  for (int i = 0; i < table->count && levels > 0; i++) {
    const struct eo_table *inner = table->field[i].table;
    bool here = false;
    int length = inner ? snprintf(way, size, "%s/", table->field[i].key) : 0;
    for (int k = 0; inner && k < inner->count && !here; k++)
      here = strcmp(inner->field[k].key, key) == 0;
    if (here || (inner && (size_t)length < size && find_below(inner, key, levels - 1, way + length, size - length)))
      return true;
  }
  return false;
}

void eo_key_unknown(const struct eo_table *table, const char *key, const struct eo_path *path, struct eo_faults *faults)
{
  for (const struct eo_refused_key *refused = table->refused; refused && refused->key; refused++)
    if (strcmp(refused->key, key) == 0) {
      eo_faults_at(faults, path, "%s", refused->text);
      return;
    }
  enum { LEVELS = 4 }; /* of objects in each other; a design has three */
  char way[200];
  if (find_below(table, key, LEVELS, way, sizeof way)) {
    eo_faults_at(faults, path, "Unknown key in %s; it stands at %s%s.", table->name, way, key);
    return;
  }
  const char *nearest = NULL;
  int best = (int)strnlen(key, 63) / 3 + 1;
  for (int i = 0; i < table->count; i++) {
    int distance = key_distance(key, table->field[i].key);
    if (distance <= best) {
      best = distance - 1;
      nearest = table->field[i].key;
    }
  }
  if (nearest)
    eo_faults_at(faults, path, "Unknown key; did you mean \"%s\"?", nearest);
  else
    eo_faults_at(faults, path, "Unknown key in %s.", table->name);
}

void eo_key_missing(const struct eo_field *field, const struct eo_path *path, struct eo_faults *faults)
{
  char keys[400] = "";
  size_t length = 0;
  for (int i = 0; field->instead && field->instead[i] && length < sizeof keys; i++)
    length += (size_t)snprintf(keys + length, sizeof keys - length, "%s%s",
                               i ? ", " : " In its place: ", field->instead[i]);
  eo_faults_at(faults, path, "This key is required.%s%s", keys, *keys ? "." : "");
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/key_faults.h"

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

void eo_key_unknown(const struct eo_table *table, const char *key, const struct eo_path *path, struct eo_faults *faults)
{
  for (const struct eo_refused_key *refused = table->refused; refused && refused->key; refused++)
    if (strcmp(refused->key, key) == 0) {
      eo_faults_at(faults, path, "%s", refused->text);
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

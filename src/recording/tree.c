/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/tree.h"
#include "recording/column.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define LEAVES 4000 /* series and facts that are kept */
#define TIME_NAMES "t|time|times|zeit|timestamp|timestamps|tout|axis1|elapsed"
#define GENERIC_NAMES "data|value|values|y|samples|signal|raw|yvalues|ydata|wave|waveform|x|dset|dataset"
#define X_NAMES "x|xvalues|xaxis|xdata|abscissa|time|t|timevector"

enum kind { SERIES, NUMBER, TEXT, LIST };

struct leaf {
  enum kind kind;
  char *path; /* owned */
  double number;
  char *text; /* owned; of texts and lists */
  int first, channels;
};

/* What one channel has got, and from how near. */
struct own {
  const struct leaf *leaf;
  bool whole;
  double scale, offset;
  int depth[EO_STATED_OFFSET + 1]; /* of the fact that was taken, by kind; -1: none */
  int name_depth, unit_depth;
};

struct eo_tree {
  int leaves, room, count;
  struct leaf *leaf;
  int sets, set[EO_TREE_CHANNELS]; /* leaves that are series */
  struct eo_series series[EO_TREE_CHANNELS];
  struct own own[EO_TREE_CHANNELS];
};

enum eo_code eo_tree_new(struct eo_tree **tree, struct eo_error *error)
{
  *tree = calloc(1, sizeof **tree);
  return *tree ? EO_OK : eo_error_memory(error);
}

void eo_tree_free(struct eo_tree *tree)
{
  for (int i = 0; tree && i < tree->leaves; i++) {
    free(tree->leaf[i].path);
    free(tree->leaf[i].text);
  }
  if (tree)
    free(tree->leaf);
  free(tree);
}

static struct leaf *add_leaf(struct eo_tree *t, enum kind kind, const char *path, const char *text)
{
  if (t->leaves == t->room) {
    int room = t->room ? 2 * t->room : 64;
    struct leaf *leaf = room <= LEAVES ? realloc(t->leaf, (size_t)room * sizeof *leaf) : NULL;
    if (!leaf)
      return NULL;
    t->leaf = leaf;
    t->room = room;
  }
  struct leaf *leaf = &t->leaf[t->leaves];
  *leaf = (struct leaf){.kind = kind, .path = strndup(path, EO_TREE_PATH - 1), .text = text ? strdup(text) : NULL};
  if (!leaf->path || (text && !leaf->text)) {
    free(leaf->path);
    free(leaf->text);
    return NULL;
  }
  t->leaves++;
  return leaf;
}

int eo_tree_add_series(struct eo_tree *t, const char *path, int channels, int64_t length, bool whole)
{
  if (t->count + channels > EO_TREE_CHANNELS)
    return -1;
  struct leaf *leaf = add_leaf(t, SERIES, path, NULL);
  if (!leaf)
    return -1;
  leaf->first = t->count;
  t->set[t->sets++] = t->leaves - 1;
  leaf->channels = channels;
  for (int c = 0; c < channels; c++) {
    struct own *own = &t->own[t->count];
    *own = (struct own){.whole = whole, .scale = 1, .name_depth = -1, .unit_depth = -1};
    for (int k = 0; k <= EO_STATED_OFFSET; k++)
      own->depth[k] = -1;
    eo_series_init(&t->series[t->count++], "", length);
  }
  return leaf->first;
}

void eo_tree_add_number(struct eo_tree *tree, const char *path, double number)
{
  struct leaf *leaf = add_leaf(tree, NUMBER, path, NULL);
  if (leaf)
    leaf->number = number;
}

void eo_tree_add_text(struct eo_tree *tree, const char *path, const char *text)
{
  add_leaf(tree, TEXT, path, text);
}

void eo_tree_add_list(struct eo_tree *tree, const char *path, const char *texts)
{
  add_leaf(tree, LIST, path, texts);
}

static const char *base_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

/* Bytes of the path of the group that the thing at path is in. */
static size_t group_size(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? (size_t)(slash - path) : 0;
}

/* The group of that size holds the path, at any depth. */
static bool holds(const char *group, size_t size, const char *path)
{
  return !size || (!strncmp(group, path, size) && path[size] == '/');
}

static int depth_of(const char *path, size_t size)
{
  int depth = size > 0;
  for (size_t i = 0; i < size; i++)
    depth += path[i] == '/';
  return depth;
}

static bool has_series(const struct eo_tree *t, const char *group, size_t size)
{
  for (int i = 0; i < t->sets; i++) {
    const char *path = t->leaf[t->set[i]].path;
    if (holds(group, size, path) || (strlen(path) == size && !strncmp(group, path, size)))
      return true;
  }
  return false;
}

/* Letters and digits of a word in lower case. */
static void fold(const char *word, size_t length, char *folded, size_t size)
{
  size_t n = 0;
  for (size_t i = 0; i < length && n + 1 < size; i++)
    if (isalnum((unsigned char)word[i]))
      folded[n++] = (char)tolower((unsigned char)word[i]);
  folded[n] = '\0';
}

static bool is_one_of(const char *word, size_t length, const char *words)
{
  char folded[64];
  fold(word, length, folded, sizeof folded);
  size_t n = strlen(folded);
  for (const char *p = words; *p && n;) {
    size_t m = strcspn(p, "|");
    if (m == n && !memcmp(p, folded, n))
      return true;
    p += m + (p[m] == '|');
  }
  return false;
}

/* The part of the path behind the group of that size, up to the next slash. */
static size_t part_behind(const char *path, size_t size, const char **part)
{
  *part = path + size + (size > 0);
  return strcspn(*part, "/");
}

/* "Channel_1_" of "Channel_1_Header"; 0 when there is no such beginning. */
static size_t prefix_of(const char *word, size_t length)
{
  while (length > 1 && word[length - 1] != '_' && word[length - 1] != '.')
    length--;
  return length > 1 ? length : 0;
}

/* A group without channels speaks for the channel that begins like it, when there is one in the same group. */
static bool prefix_admits(const struct eo_tree *t, const struct leaf *fact, size_t outer, const struct leaf *series)
{
  const char *part, *other;
  size_t length = part_behind(fact->path, outer, &part), prefix = prefix_of(part, length);
  if (!prefix)
    return true;
  bool any = false, mine = false;
  for (int i = 0; i < t->sets; i++) {
    const struct leaf *l = &t->leaf[t->set[i]];
    if (!holds(fact->path, outer, l->path))
      continue;
    size_t n = part_behind(l->path, outer, &other);
    bool same = n > prefix && !strncmp(part, other, prefix);
    any = any || same;
    mine = mine || (same && l == series);
  }
  return mine || !any;
}

/* How near a fact is to a series: the depth of the group it speaks for, one more for an attribute; -1: it says nothing
   about the series. *outer: size of the path of that group. */
static int nearness(const struct eo_tree *t, const struct leaf *fact, const struct leaf *series, size_t *outer)
{
  size_t group = group_size(fact->path), length = strlen(series->path);
  if (group == length && !strncmp(fact->path, series->path, length)) {
    *outer = group;
    return 100;
  }
  *outer = group;
  while (*outer && !holds(fact->path, *outer, series->path)) {
    if (has_series(t, fact->path, *outer))
      return -1;
    while (*outer && fact->path[*outer - 1] != '/')
      --*outer;
    *outer -= *outer > 0;
  }
  if (*outer < group && !prefix_admits(t, fact, *outer, series))
    return -1;
  return depth_of(fact->path, *outer);
}

/* True when a fact stands in a part that describes the abscissa: its unit and name are not those of the values. */
static bool about_abscissa(const struct leaf *fact, size_t outer)
{
  const char *part;
  size_t group = group_size(fact->path);
  for (size_t at = outer; at < group;) {
    size_t length = part_behind(fact->path, at, &part);
    if (is_one_of(part, length, X_NAMES))
      return true;
    at = (size_t)(part - fact->path) + length;
  }
  return false;
}

/* "scale" of "pinion_scale" and "scale_pinion" beside "pinion"; false when the key does not hold the name. */
static bool strip_name(const char *key, const char *name, char *rest, size_t size)
{
  size_t n = strlen(name), length = strlen(key);
  if (n < 1 || length <= n + 1)
    return false;
  if (!strncasecmp(key, name, n) && !isalnum((unsigned char)key[n]))
    snprintf(rest, size, "%s", key + n + 1);
  else if (!strcasecmp(key + length - n, name) && !isalnum((unsigned char)key[length - n - 1]))
    snprintf(rest, size, "%.*s", (int)(length - n - 1), key);
  else
    return false;
  return true;
}

/* The key belongs to another channel by its name. */
static bool names_other(const struct eo_tree *t, const struct leaf *fact, const struct leaf *series)
{
  char rest[64];
  size_t group = group_size(fact->path);
  for (int i = 0; i < t->sets; i++) {
    const struct leaf *l = &t->leaf[t->set[i]];
    if (l != series && group_size(l->path) == group && holds(fact->path, group, l->path) &&
        strip_name(base_of(fact->path), base_of(l->path), rest, sizeof rest))
      return true;
  }
  return false;
}

/* "ms" under "SampleIntervalUnit" beside "SampleInterval"; "" when there is none. */
static const char *unit_named_after(const struct eo_tree *t, const struct leaf *number)
{
  char key[64], other[64];
  size_t group = group_size(number->path);
  fold(base_of(number->path), strlen(base_of(number->path)), key, sizeof key);
  for (int i = 0; i < t->leaves; i++) {
    const struct leaf *l = &t->leaf[i];
    if (l->kind != TEXT || group_size(l->path) != group || strncmp(l->path, number->path, group))
      continue;
    fold(base_of(l->path), strlen(base_of(l->path)), other, sizeof other);
    size_t length = strlen(key);
    if (!strncmp(key, other, length) && (!strcmp(other + length, "unit") || !strcmp(other + length, "units")))
      return l->text;
  }
  return "";
}

/* The unit of a number: a text beside it that is a unit of time or frequency, or one below its group. */
static const char *unit_beside(const struct eo_tree *t, const struct leaf *number)
{
  size_t group = group_size(number->path);
  double factor;
  for (int i = 0; group && i < t->leaves; i++) {
    const struct leaf *l = &t->leaf[i];
    if (l->kind != TEXT || !holds(number->path, group, l->path))
      continue;
    enum eo_quantity quantity = eo_unit_find(l->text, &factor);
    if (quantity == EO_QUANTITY_TIME)
      return l->text;
  }
  return "";
}

static void use_number(struct eo_tree *t, const struct leaf *fact, const struct leaf *series)
{
  char key[64];
  size_t outer;
  int depth = nearness(t, fact, series, &outer);
  if (depth < 0)
    return;
  bool mine = strip_name(base_of(fact->path), base_of(series->path), key, sizeof key);
  if (!mine && names_other(t, fact, series))
    return;
  if (!mine)
    snprintf(key, sizeof key, "%s", base_of(fact->path));
  depth += mine ? 50 : 0;
  const char *unit = unit_named_after(t, fact);
  struct eo_stated s = eo_stated_read(key, fact->number,
                                      !*unit && about_abscissa(fact, outer) ? unit_beside(t, fact) : unit);
  int member = eo_stated_member(base_of(series->path));
  if (!s.kind || (s.member >= 0 && member >= 0 && s.member != member))
    return;
  for (int c = series->first; c < series->first + series->channels; c++) {
    struct own *own = &t->own[c];
    if (depth <= own->depth[s.kind])
      continue;
    bool direct = depth >= 50 || own->whole;
    if (s.kind == EO_STATED_SCALE && direct)
      own->scale = s.value;
    else if (s.kind == EO_STATED_OFFSET && direct)
      own->offset = s.value;
    else if (!eo_series_state(&t->series[c], &s))
      continue;
    own->depth[s.kind] = depth;
  }
}

/* A vector named like a time, or the only one of a group named like an abscissa. */
static bool is_time(const struct leaf *l)
{
  const char *base = base_of(l->path), *part;
  size_t group = group_size(l->path), at = group;
  if (l->channels != 1)
    return false;
  if (is_one_of(base, strlen(base), TIME_NAMES))
    return true;
  while (at && l->path[at - 1] != '/')
    at--;
  part = l->path + at;
  return group && is_one_of(base, strlen(base), GENERIC_NAMES) && is_one_of(part, group - at, X_NAMES);
}

/* A name is that of the only channel, beside its times, that the fact speaks for. */
static bool speaks_for_one(const struct eo_tree *t, const struct leaf *fact)
{
  int count = 0;
  size_t outer;
  for (int i = 0; i < t->sets; i++) {
    const struct leaf *l = &t->leaf[t->set[i]];
    count += nearness(t, fact, l, &outer) >= 0 && !is_time(l);
  }
  return count <= 1;
}

static void use_text(struct eo_tree *t, const struct leaf *fact, const struct leaf *series)
{
  static const char unit_keys[] = "unit|units|unitstring|engunit|engineeringunit|engunits|engineeringunits|einheit|"
                                  "yunit|yunits|unitsy|unitname|physicalunit|dimension";
  static const char name_keys[] = "name|signalname|channelname|longname|label|title|signal|channel|displayname|"
                                  "kanalname|varname|tag|variablename|desc|description|functionname";
  size_t outer;
  const char *key = base_of(fact->path);
  int depth = nearness(t, fact, series, &outer);
  char rest[64];
  double factor;
  if (depth < 0 || about_abscissa(fact, outer) ||
      (outer < group_size(fact->path) && depth == 0 && !strchr(key, '_') &&
       !prefix_of(fact->path, strcspn(fact->path, "/"))))
    return;
  bool mine = strip_name(key, base_of(series->path), rest, sizeof rest);
  key = mine ? rest : key;
  if (!mine && names_other(t, fact, series))
    return;
  depth += mine ? 50 : 0;
  size_t length = strlen(key);
  bool quantity = strstr(fact->path, "quantity/") != NULL;
  bool unit = is_one_of(key, length, unit_keys) || (quantity && is_one_of(key, length, "label"));
  bool name = !unit && is_one_of(key, length, name_keys) && eo_unit_find(fact->text, &factor) == EO_QUANTITY_NONE;
  for (int c = series->first; c < series->first + series->channels; c++) {
    struct own *own = &t->own[c];
    if (unit && depth > own->unit_depth) {
      snprintf(t->series[c].unit, sizeof t->series[c].unit, "%.*s", EO_RECORDING_UNIT - 1, fact->text);
      own->unit_depth = depth;
    }
    if (name && depth > own->name_depth && series->channels == 1 && (depth >= 50 || speaks_for_one(t, fact))) {
      snprintf(t->series[c].name, sizeof t->series[c].name, "%.*s", EO_RECORDING_NAME - 1, fact->text);
      own->name_depth = depth;
    }
  }
}

static int count_lines(const char *texts)
{
  int count = *texts != '\0';
  for (; *texts; texts++)
    count += *texts == '\n';
  return count;
}

/* A list with a text for each channel of a table holds their names, or their units. */
static void use_list(struct eo_tree *t, const struct leaf *fact, const struct leaf *series)
{
  size_t outer;
  int depth = nearness(t, fact, series, &outer);
  if (depth < 0 || about_abscissa(fact, outer) || series->channels < 2 || count_lines(fact->text) != series->channels)
    return;
  const char *key = base_of(fact->path), *base = base_of(series->path);
  size_t block = strcspn(key, "_");
  if (key[block] == '_' && is_one_of(key + block + 1, strlen(key) - block - 1, "items") &&
      strncmp(key, base, block + 1))
    return;
  const char *p = fact->text;
  for (int c = series->first; c < series->first + series->channels; c++) {
    char word[EO_RECORDING_NAME];
    double factor;
    size_t n = strcspn(p, "\n");
    snprintf(word, sizeof word, "%.*s", (int)(n < sizeof word ? n : sizeof word - 1), p);
    bool unit = is_one_of(key, strlen(key), "unit|units|einheiten") ||
                (eo_unit_find(word, &factor) != EO_QUANTITY_NONE && strlen(word) > 1);
    if (unit && depth > t->own[c].unit_depth)
      snprintf(t->series[c].unit, sizeof t->series[c].unit, "%.*s", EO_RECORDING_UNIT - 1, word);
    else if (!unit && depth > t->own[c].name_depth) {
      snprintf(t->series[c].name, sizeof t->series[c].name, "%s", word);
      t->own[c].name_depth = depth;
    }
    p += n + (p[n] == '\n');
  }
}

/* A name that says nothing gives way to that of its group; channels of one table are numbered. */
static void name_series(struct eo_tree *t, const struct leaf *series)
{
  const char *base = base_of(series->path), *part = base;
  size_t length = strlen(base), group = group_size(series->path);
  if (group && is_one_of(base, length, GENERIC_NAMES)) {
    part = series->path + group;
    while (part > series->path && part[-1] != '/')
      part--;
    length = (size_t)(series->path + group - part);
  }
  for (int c = 0; c < series->channels; c++) {
    struct eo_series *s = &t->series[series->first + c];
    char label[EO_RECORDING_NAME], unit[EO_RECORDING_UNIT];
    if (*s->name)
      snprintf(label, sizeof label, "%s", s->name);
    else if (series->channels > 1)
      snprintf(label, sizeof label, "%.*s %d", length < 50 ? (int)length : 50, part, c + 1);
    else
      snprintf(label, sizeof label, "%.*s", length < 63 ? (int)length : 63, part);
    if (*s->unit)
      memcpy(s->name, label, sizeof label);
    else if (series->channels == 1 || t->own[series->first + c].name_depth >= 0) {
      eo_unit_split(label, s->name, (int)sizeof s->name, unit, (int)sizeof unit);
      memcpy(s->unit, unit, sizeof unit);
    } else
      memcpy(s->name, label, sizeof label);
  }
}

/* The times of the group that the series is in, or of the groups around it; of equally near ones the last before it. */
static void find_times(struct eo_tree *t, const struct leaf *series)
{
  int best = -1;
  for (int i = 0; i < t->sets; i++) {
    const struct leaf *time = &t->leaf[t->set[i]];
    size_t outer;
    if (time == series || !is_time(time) || t->series[time->first].length != t->series[series->first].length)
      continue;
    outer = group_size(time->path);
    if (!is_one_of(base_of(time->path), strlen(base_of(time->path)), TIME_NAMES)) {
      while (outer && time->path[outer - 1] != '/')
        outer--;
      outer -= outer > 0;
    }
    int depth = holds(time->path, outer, series->path) ? depth_of(time->path, outer) : -1;
    if (depth <= best)
      continue;
    best = depth;
    for (int c = series->first; c < series->first + series->channels; c++)
      t->series[c].clock.column = time->first;
  }
}

void eo_tree_settle(struct eo_tree *t, struct eo_notes *notes)
{
  for (int s = 0; s < t->sets; s++) {
    const struct leaf *series = &t->leaf[t->set[s]];
    for (int i = 0; i < t->leaves; i++)
      if (t->leaf[i].kind == NUMBER)
        use_number(t, &t->leaf[i], series);
      else if (t->leaf[i].kind == TEXT)
        use_text(t, &t->leaf[i], series);
      else if (t->leaf[i].kind == LIST)
        use_list(t, &t->leaf[i], series);
    name_series(t, series);
    if (!is_time(series))
      find_times(t, series);
    const struct own *own = &t->own[series->first];
    if (own->scale != 1 || own->offset != 0)
      eo_notes_add(notes, "The values of \"%s\" were multiplied by %.9g and %.9g was added, as the file states.",
                   t->series[series->first].name, own->scale, own->offset);
  }
}

int eo_tree_count(const struct eo_tree *tree)
{
  return tree->count;
}

struct eo_series *eo_tree_series(struct eo_tree *tree)
{
  return tree->series;
}

double eo_tree_value(const struct eo_tree *tree, int series, double stored)
{
  return stored * tree->own[series].scale + tree->own[series].offset;
}

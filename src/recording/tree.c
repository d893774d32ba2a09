/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/tree_private.h"
#include "recording/namesakes.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FACTS 2048 /* that are kept; what they cost goes with their square */
#define LEAVES (FACTS + EO_TREE_CHANNELS)
#define SINCE_START 1000 /* s: times that begin later do not count from the start of the recording */

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

static struct eo_leaf *add_leaf(struct eo_tree *tree, enum eo_leaf_kind kind, const char *path, const char *text)
{
  if (kind != EO_LEAF_SERIES &&
      tree->leaves - tree->sets == FACTS) { /* series find room however many facts there are */
    tree->dropped++;
    return NULL;
  }
  if (tree->leaves == tree->room) {
    int room = !tree->room ? 64 : tree->room < LEAVES / 2 ? 2 * tree->room : LEAVES;
    struct eo_leaf *leaf = realloc(tree->leaf, (size_t)room * sizeof *leaf);
    if (!leaf)
      return NULL;
    tree->leaf = leaf;
    tree->room = room;
  }
  struct eo_leaf *leaf = &tree->leaf[tree->leaves];
  *leaf = (struct eo_leaf){
      .kind = kind, .path = strndup(path, EO_TREE_PATH - 1), .text = text ? strdup(text) : NULL, .unit = ""};
  if (!leaf->path || (text && !leaf->text)) {
    free(leaf->path);
    free(leaf->text);
    return NULL;
  }
  const char *base = eo_tree_base_of(leaf->path);
  eo_tree_fold(base, strlen(base), leaf->key, sizeof leaf->key);
  tree->leaves++;
  return leaf;
}

int eo_tree_add_series(struct eo_tree *tree, const char *path, int channels, int64_t length, bool whole)
{
  if (tree->count + channels > EO_TREE_CHANNELS)
    return -1;
  struct eo_leaf *leaf = add_leaf(tree, EO_LEAF_SERIES, path, NULL);
  if (!leaf)
    return -1;
  leaf->first = tree->count;
  tree->set[tree->sets++] = tree->leaves - 1;
  leaf->channels = channels;
  for (int c = 0; c < channels; c++) {
    struct eo_own *own = &tree->own[tree->count];
    *own = (struct eo_own){.whole = whole,
                           .scale = 1,
                           .missing = NAN,
                           .name_depth = -1,
                           .unit_depth = -1,
                           .day_depth = -1,
                           .hour_depth = -1};
    for (int k = 0; k < EO_STATED_KINDS; k++)
      own->depth[k] = -1;
    eo_series_init(&tree->series[tree->count++], "", length);
  }
  return leaf->first;
}

void eo_tree_add_number(struct eo_tree *tree, const char *path, double number)
{
  struct eo_leaf *leaf = add_leaf(tree, EO_LEAF_NUMBER, path, NULL);
  if (leaf)
    leaf->number = number;
}

void eo_tree_add_text(struct eo_tree *tree, const char *path, const char *text)
{
  add_leaf(tree, EO_LEAF_TEXT, path, text);
}

void eo_tree_add_list(struct eo_tree *tree, const char *path, const char *texts)
{
  add_leaf(tree, EO_LEAF_LIST, path, texts);
}

const char *eo_tree_base_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

/* Bytes of the path of the group that the thing at path is in. */
size_t eo_tree_group_size(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? (size_t)(slash - path) : 0;
}

/* The group of that size holds the path, at any depth. */
bool eo_tree_holds(const char *group, size_t size, const char *path)
{
  return !size || (!strncmp(group, path, size) && path[size] == '/');
}

int eo_tree_depth_of(const char *path, size_t size)
{
  int depth = size > 0;
  for (size_t i = 0; i < size; i++)
    depth += path[i] == '/';
  return depth;
}

bool eo_tree_has_series(const struct eo_tree *tree, const char *group, size_t size)
{
  for (int i = 0; i < tree->sets; i++) {
    const char *path = tree->leaf[tree->set[i]].path;
    if (eo_tree_holds(group, size, path) || (strlen(path) == size && !strncmp(group, path, size)))
      return true;
  }
  return false;
}

/* Letters and digits of a word in lower case. */
void eo_tree_fold(const char *word, size_t length, char *folded, size_t size)
{
  size_t n = 0;
  for (size_t i = 0; i < length && n + 1 < size; i++)
    if (isalnum((unsigned char)word[i]))
      folded[n++] = (char)tolower((unsigned char)word[i]);
  folded[n] = '\0';
}

bool eo_tree_is_one_of(const char *word, size_t length, const char *words)
{
  char folded[64];
  eo_tree_fold(word, length, folded, sizeof folded);
  size_t n = strlen(folded);
  for (const char *p = words; *p && n;) {
    size_t m = strcspn(p, "|");
    if (m == n && !memcmp(p, folded, n))
      return true;
    p += m + (p[m] == '|');
  }
  return false;
}

/* A vector named like a time, or the only one of a group named like an abscissa. */
bool eo_tree_is_time(const struct eo_leaf *leaf)
{
  const char *base = eo_tree_base_of(leaf->path), *part;
  size_t group = eo_tree_group_size(leaf->path), at = group;
  if (leaf->channels != 1)
    return false;
  if (eo_tree_is_one_of(base, strlen(base), EO_TREE_TIME_NAMES))
    return true;
  while (at && leaf->path[at - 1] != '/')
    at--;
  part = leaf->path + at;
  return group && eo_tree_is_one_of(base, strlen(base), EO_TREE_GENERIC_NAMES) &&
         eo_tree_is_one_of(part, group - at, EO_TREE_X_NAMES);
}

/* A name that says nothing gives way to that of its group; channels of one table are numbered. */
static void name_series(struct eo_tree *tree, const struct eo_leaf *series)
{
  const char *base = eo_tree_base_of(series->path), *part = base;
  size_t length = strlen(base), group = eo_tree_group_size(series->path);
  if (group && eo_tree_is_one_of(base, length, EO_TREE_GENERIC_NAMES)) {
    part = series->path + group;
    while (part > series->path && part[-1] != '/')
      part--;
    length = (size_t)(series->path + group - part);
  }
  for (int c = 0; c < series->channels; c++) {
    struct eo_series *this_series = &tree->series[series->first + c];
    char label[EO_RECORDING_NAME], unit[EO_RECORDING_UNIT];
    if (*this_series->name)
      snprintf(label, sizeof label, "%s", this_series->name);
    else if (series->channels > 1)
      snprintf(label, sizeof label, "%.*s %d", length < 50 ? (int)length : 50, part, c + 1);
    else
      snprintf(label, sizeof label, "%.*s", length < 63 ? (int)length : 63, part);
    if (*this_series->unit)
      memcpy(this_series->name, label, sizeof label);
    else if (series->channels == 1 || tree->own[series->first + c].name_depth >= 0) {
      eo_unit_split(label, this_series->name, (int)sizeof this_series->name, unit, (int)sizeof unit);
      memcpy(this_series->unit, unit, sizeof unit);
    } else
      memcpy(this_series->name, label, sizeof label);
  }
}

/* The times of the group that the series is in, or of the groups around it; of equally near ones the last before it. */
static void find_times(struct eo_tree *tree, const struct eo_leaf *series)
{
  int best = -1;
  for (int i = 0; i < tree->sets; i++) {
    const struct eo_leaf *time = &tree->leaf[tree->set[i]];
    size_t outer;
    if (time == series || !eo_tree_is_time(time) ||
        tree->series[time->first].length != tree->series[series->first].length)
      continue;
    outer = eo_tree_group_size(time->path);
    if (!eo_tree_is_one_of(eo_tree_base_of(time->path), strlen(eo_tree_base_of(time->path)), EO_TREE_TIME_NAMES)) {
      while (outer && time->path[outer - 1] != '/')
        outer--;
      outer -= outer > 0;
    }
    int depth = eo_tree_holds(time->path, outer, series->path) ? eo_tree_depth_of(time->path, outer) : -1;
    if (depth <= best)
      continue;
    best = depth;
    for (int c = series->first; c < series->first + series->channels; c++)
      tree->series[c].clock.column = time->first;
  }
  struct eo_clock *times = best >= 0 ? &tree->series[tree->series[series->first].clock.column].clock : NULL;
  if (times && times->epoch == EO_CLOCK_NO_EPOCH) /* what is said of the values holds for their times */
    times->epoch = tree->series[series->first].clock.epoch;
}

/* MATLAB counts days since the year 0 ("t0 = 739316.375"). Starts that lie between 1971 and 2108 in such days and
   differ by less than 86 s in them are days: in seconds they would differ by less than a millisecond. */
static void read_day_numbers(struct eo_tree *tree, struct eo_notes *notes)
{
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < tree->count; i++)
    if (tree->own[i].depth[EO_STATED_START] >= 0) {
      low = fmin(low, tree->series[i].clock.start);
      high = fmax(high, tree->series[i].clock.start);
    }
  if (!(low > 720000 && high < 770000 && high > low && high - low < 1e-3))
    return;
  for (int i = 0; i < tree->count; i++)
    if (tree->own[i].depth[EO_STATED_START] >= 0)
      tree->series[i].clock.start = (tree->series[i].clock.start - low) * EO_MOMENT_DAY;
  eo_notes_add(notes,
               "The starts of the channels, %.9g and up, were read as MATLAB's day numbers: they are %.6g s apart.",
               low, (high - low) * EO_MOMENT_DAY);
}

/* A moment at which the times begin says nothing of times that count from another one (since 1970, since midnight):
   those do not begin near 0. */
enum eo_code eo_tree_check_begins(struct eo_tree *tree, const struct eo_series_file *file, struct eo_error *error)
{
  for (int i = 0; i < tree->sets; i++) {
    const struct eo_leaf *leaf = &tree->leaf[tree->set[i]];
    struct eo_clock *clock = &tree->series[leaf->first].clock;
    double first, factor = 1;
    if (!eo_tree_is_time(leaf) || clock->epoch == EO_CLOCK_NO_EPOCH || tree->series[leaf->first].length < 1)
      continue;
    EO_TRY(file->read(file->context, leaf->first, 0, 1, &first, error));
    if (eo_unit_find(tree->series[leaf->first].unit, &factor) != EO_QUANTITY_TIME)
      factor = 1;
    if (!(fabs(first * factor) < SINCE_START))
      clock->epoch = EO_CLOCK_NO_EPOCH;
  }
  return EO_OK;
}

static const struct eo_leaf *leaf_of(const struct eo_tree *tree, int series)
{
  int s = tree->sets - 1;
  while (s > 0 && tree->leaf[tree->set[s]].first > series)
    s--;
  return &tree->leaf[tree->set[s]];
}

/* The part of the path of its group in which a series differs from its namesake first. */
static void tell_group(const void *context, int series, int namesake, char *group, size_t size)
{
  const char *own = leaf_of(context, series)->path, *other = leaf_of(context, namesake)->path, *part = own;
  for (; *own && *own == *other; own++, other++)
    if (*own == '/')
      part = own + 1;
  if (strchr(part, '/'))
    snprintf(group, size, "%.*s", (int)strcspn(part, "/"), part);
}

/* What stands in the place of a value that is missing, stated at the series itself (netCDF: _FillValue). */
static void take_missing(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  const char *base = eo_tree_base_of(fact->path);
  size_t group = eo_tree_group_size(fact->path);
  if (fact->kind != EO_LEAF_NUMBER || group != strlen(series->path) || strncmp(fact->path, series->path, group) != 0 ||
      !eo_tree_is_one_of(base, strlen(base), "fillvalue|missingvalue|missing|nodata|nodatavalue|invalidvalue"))
    return;
  for (int c = series->first; c < series->first + series->channels; c++)
    tree->own[c].missing = fact->number;
}

static void note_scales(const struct eo_tree *tree, struct eo_notes *notes)
{
  for (int s = 0; s < tree->sets; s++) {
    int first = tree->leaf[tree->set[s]].first;
    const struct eo_own *own = &tree->own[first];
    if (own->scale != 1 || own->offset != 0)
      eo_notes_add(notes, "The values of \"%s\" were multiplied by %.9g and %.9g was added, as the file states.",
                   tree->series[first].name, own->scale, own->offset);
  }
}

void eo_tree_settle(struct eo_tree *tree, struct eo_notes *notes)
{
  eo_tree_read_facts(tree);
  for (int s = 0; s < tree->sets; s++) {
    const struct eo_leaf *series = &tree->leaf[tree->set[s]];
    for (int i = 0; i < tree->leaves; i++) {
      eo_tree_use(tree, &tree->leaf[i], series);
      take_missing(tree, &tree->leaf[i], series);
    }
    name_series(tree, series);
    if (!eo_tree_is_time(series))
      find_times(tree, series);
  }
  eo_namesakes_part(tree->series, tree->count, tell_group, tree);
  note_scales(tree, notes);
  if (tree->dropped)
    eo_notes_add(notes, "The file states more than %d things beside its channels; %d of them were not looked at.",
                 FACTS, tree->dropped);
  read_day_numbers(tree, notes);
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
  const struct eo_own *own = &tree->own[series];
  return stored == own->missing ? NAN : stored * own->scale + own->offset;
}

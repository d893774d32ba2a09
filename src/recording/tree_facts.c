/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which facts belong to which series, and what they mean for it. */
#include "recording/tree_private.h"
#include "recording/column.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

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
static bool prefix_admits(const struct eo_tree *tree, const struct eo_leaf *fact, size_t outer,
                          const struct eo_leaf *series)
{
  const char *part, *other;
  size_t length = part_behind(fact->path, outer, &part), prefix = prefix_of(part, length);
  if (!prefix)
    return true;
  bool any = false, mine = false;
  for (int i = 0; i < tree->sets; i++) {
    const struct eo_leaf *leaf = &tree->leaf[tree->set[i]];
    if (!eo_tree_holds(fact->path, outer, leaf->path))
      continue;
    size_t n = part_behind(leaf->path, outer, &other);
    bool same = n > prefix && !strncmp(part, other, prefix);
    any = any || same;
    mine = mine || (same && leaf == series);
  }
  return mine || !any;
}

/* How near a fact is to a series: the depth of the group it speaks for, one more for an attribute; -1: it says nothing
   about the series. *outer: size of the path of that group. */
static int nearness(const struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series, size_t *outer)
{
  size_t group = eo_tree_group_size(fact->path), length = strlen(series->path);
  if (group == length && !strncmp(fact->path, series->path, length)) {
    *outer = group;
    return 100;
  }
  *outer = group;
  while (*outer && !eo_tree_holds(fact->path, *outer, series->path)) {
    if (eo_tree_has_series(tree, fact->path, *outer))
      return -1;
    while (*outer && fact->path[*outer - 1] != '/')
      --*outer;
    *outer -= *outer > 0;
  }
  if (*outer < group && !prefix_admits(tree, fact, *outer, series))
    return -1;
  return eo_tree_depth_of(fact->path, *outer);
}

/* True when a fact stands in a part that describes the abscissa: its unit and name are not those of the values. */
static bool about_abscissa(const struct eo_leaf *fact, size_t outer)
{
  const char *part;
  size_t group = eo_tree_group_size(fact->path);
  for (size_t at = outer; at < group;) {
    size_t length = part_behind(fact->path, at, &part);
    if (eo_tree_is_one_of(part, length, EO_TREE_X_NAMES))
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
static bool names_other(const struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  char rest[64];
  const char *base = eo_tree_base_of(fact->path);
  for (int i = 0; i < tree->sets; i++) {
    const struct eo_leaf *leaf = &tree->leaf[tree->set[i]];
    if (leaf != series && leaf->group == fact->group && eo_tree_holds(fact->path, fact->group, leaf->path) &&
        strip_name(base, leaf->path + leaf->group + (leaf->group > 0), rest, sizeof rest))
      return true;
  }
  return false;
}

/* "ms" under "SampleIntervalUnit" beside "SampleInterval"; "" when there is none. */
static const char *unit_named_after(const struct eo_tree *tree, const struct eo_leaf *number)
{
  size_t length = strlen(number->key);
  for (int i = 0; i < tree->leaves; i++) {
    const struct eo_leaf *leaf = &tree->leaf[i];
    if (leaf->kind == EO_LEAF_TEXT && !strncmp(leaf->key, number->key, length) &&
        (!strcmp(leaf->key + length, "unit") || !strcmp(leaf->key + length, "units")) && leaf->group == number->group &&
        !strncmp(leaf->path, number->path, leaf->group))
      return leaf->text;
  }
  return "";
}

/* The unit of a number: a text beside it that is a unit of time or frequency, or one below its group. */
static const char *unit_beside(const struct eo_tree *tree, const struct eo_leaf *number)
{
  size_t group = eo_tree_group_size(number->path);
  double factor;
  for (int i = 0; group && i < tree->leaves; i++) {
    const struct eo_leaf *leaf = &tree->leaf[i];
    if (leaf->kind != EO_LEAF_TEXT || !eo_tree_holds(number->path, group, leaf->path))
      continue;
    enum eo_quantity quantity = eo_unit_find(leaf->text, &factor);
    if (quantity == EO_QUANTITY_TIME)
      return leaf->text;
  }
  return "";
}

/* The unit of the abscissa beside a number ("xunit" beside "dx"); "" when there is none. */
static const char *unit_of_axis(const struct eo_tree *tree, const struct eo_leaf *number)
{
  size_t group = eo_tree_group_size(number->path);
  double factor;
  for (int i = 0; i < tree->leaves; i++) {
    const struct eo_leaf *leaf = &tree->leaf[i];
    const char *key = eo_tree_base_of(leaf->path);
    if (leaf->kind == EO_LEAF_TEXT && eo_tree_group_size(leaf->path) == group &&
        !strncmp(leaf->path, number->path, group) &&
        eo_tree_is_one_of(key, strlen(key),
                          "xunit|xunits|unitx|unitsx|xunitstring|wfxunitstring|xaxisunit|timeunit|timeunits") &&
        eo_unit_find(leaf->text, &factor) == EO_QUANTITY_TIME)
      return leaf->text;
  }
  return "";
}

/* How near a fact is to a series by its place and its name, and what the key is without the name of the series; -1: it
   says nothing about the series. */
static int claim(const struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series, char *key,
                 size_t size, size_t *outer)
{
  int depth = nearness(tree, fact, series, outer);
  if (depth < 0)
    return -1;
  if (strip_name(eo_tree_base_of(fact->path), eo_tree_base_of(series->path), key, size))
    return depth + 50;
  snprintf(key, size, "%s", eo_tree_base_of(fact->path));
  return names_other(tree, fact, series) ? -1 : depth;
}

/* The key shares a word with the name of another channel and none with that of this one: "torque_rate" beside
   "torque_Nm". */
static bool hints_at_other(const struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  const char *key = eo_tree_base_of(fact->path);
  bool other = false;
  for (int i = 0; i < tree->sets; i++) {
    const struct eo_leaf *leaf = &tree->leaf[tree->set[i]];
    bool shared = eo_column_shared_words(key, eo_tree_base_of(leaf->path), "") > 0;
    if (shared && leaf == series)
      return false;
    other = other || shared;
  }
  return other;
}

/* The nearest interval counts; of equally near ones a second that contradicts the first is kept beside it. */
static void take_interval(const struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series,
                          const struct eo_stated *stated, bool nearer, struct eo_clock *clock)
{
  if (nearer)
    clock->interval = stated->value, clock->other = 0, clock->told = (int)stated->strength;
  else if (eo_series_contradicts(clock->interval, stated->value) && !hints_at_other(tree, fact, series))
    eo_series_tell(clock, stated);
}

/* What a fact of that depth states, for all channels of a series. */
static void use_stated(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series,
                       const struct eo_stated *stated, int depth)
{
  for (int c = series->first; c < series->first + series->channels; c++) {
    struct eo_own *own = &tree->own[c];
    if (depth < own->depth[stated->kind] || (depth == own->depth[stated->kind] && stated->kind != EO_STATED_INTERVAL))
      continue;
    bool direct = depth >= 50 || own->whole, nearer = depth > own->depth[stated->kind];
    if (stated->kind == EO_STATED_INTERVAL)
      take_interval(tree, fact, series, stated, nearer, &tree->series[c].clock);
    else if (stated->kind == EO_STATED_SCALE && direct)
      own->scale = stated->value;
    else if (stated->kind == EO_STATED_OFFSET && direct)
      own->offset = stated->value;
    else if (!eo_series_state(&tree->series[c], stated))
      continue;
    own->depth[stated->kind] = depth;
  }
}

/* A number that says nothing of its unit is one in s: of an interval, not of a rate, whose unit is no time. */
static bool takes_seconds(const char *key)
{
  struct eo_stated stated = eo_stated_read(key, 2, "");
  return (stated.kind == EO_STATED_INTERVAL || stated.kind == EO_STATED_START) && stated.value == 2;
}

void eo_tree_read_facts(struct eo_tree *tree)
{
  for (int i = 0; i < tree->leaves; i++) {
    struct eo_leaf *leaf = &tree->leaf[i];
    const char *base = eo_tree_base_of(leaf->path);
    if (leaf->kind == EO_LEAF_NUMBER || leaf->kind == EO_LEAF_TEXT)
      leaf->unit = unit_named_after(tree, leaf);
    if (leaf->kind != EO_LEAF_NUMBER)
      continue;
    leaf->stated = eo_stated_read(base, leaf->number, leaf->unit);
    leaf->seconds = takes_seconds(base);
  }
}

/* unit: of the number itself, "" when it has none. */
static void use_number(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series, double number,
                       const char *unit)
{
  char key[64];
  size_t outer;
  int depth = claim(tree, fact, series, key, sizeof key, &outer);
  if (depth < 0)
    return;
  if (!*unit)
    unit = fact->unit;
  if (!*unit && about_abscissa(fact, outer))
    unit = unit_beside(tree, fact);
  bool whole = fact->kind == EO_LEAF_NUMBER && !strcmp(key, eo_tree_base_of(fact->path)); /* nothing taken off */
  if (!*unit && (whole ? fact->seconds : takes_seconds(key)))
    unit = unit_of_axis(tree, fact);
  struct eo_stated stated = whole && !strcmp(unit, fact->unit) ? fact->stated : eo_stated_read(key, number, unit);
  int member = eo_stated_member(eo_tree_base_of(series->path));
  if (stated.kind && (stated.member < 0 || member < 0 || stated.member == member))
    use_stated(tree, fact, series, &stated, depth);
}

/* A name is that of the only channel, beside its times, that the fact speaks for. */
static bool speaks_for_one(const struct eo_tree *tree, const struct eo_leaf *fact)
{
  int count = 0;
  size_t outer;
  for (int i = 0; i < tree->sets; i++) {
    const struct eo_leaf *leaf = &tree->leaf[tree->set[i]];
    count += nearness(tree, fact, leaf, &outer) >= 0 && !eo_tree_is_time(leaf);
  }
  return count <= 1;
}

static void use_text(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  static const char unit_keys[] = "unit|units|unitstring|engunit|engineeringunit|engunits|engineeringunits|einheit|"
                                  "yunit|yunits|unitsy|unitname|physicalunit|dimension";
  static const char name_keys[] = "name|signalname|channelname|longname|label|title|signal|channel|displayname|"
                                  "kanalname|varname|tag|variablename|desc|description|functionname";
  size_t outer;
  const char *key = eo_tree_base_of(fact->path);
  int depth = nearness(tree, fact, series, &outer);
  char rest[64];
  double factor;
  bool abscissa = depth >= 0 && about_abscissa(fact, outer), time = eo_tree_is_time(series);
  if (depth < 0 || (abscissa && !time) ||
      (outer < eo_tree_group_size(fact->path) && depth == 0 && !strchr(key, '_') &&
       !prefix_of(fact->path, strcspn(fact->path, "/"))))
    return;
  bool mine = strip_name(key, eo_tree_base_of(series->path), rest, sizeof rest);
  key = mine ? rest : key;
  if (!mine && names_other(tree, fact, series))
    return;
  depth += (mine ? 50 : 0) + abscissa; /* the unit of the times, before that of the values beside them */
  size_t length = strlen(key);
  bool quantity = strstr(fact->path, "quantity/") != NULL;
  bool unit = eo_tree_is_one_of(key, length, unit_keys) || (quantity && eo_tree_is_one_of(key, length, "label"));
  bool name = !unit && !abscissa && eo_tree_is_one_of(key, length, name_keys) &&
              eo_unit_find(fact->text, &factor) == EO_QUANTITY_NONE;
  for (int c = series->first; c < series->first + series->channels; c++) {
    struct eo_own *own = &tree->own[c];
    if (unit && depth > own->unit_depth) {
      snprintf(tree->series[c].unit, sizeof tree->series[c].unit, "%.*s", EO_RECORDING_UNIT - 1, fact->text);
      own->unit_depth = depth;
    }
    if (name && depth > own->name_depth && series->channels == 1 &&
        (depth >= 50 || (!time && speaks_for_one(tree, fact)))) {
      snprintf(tree->series[c].name, sizeof tree->series[c].name, "%.*s", EO_RECORDING_NAME - 1, fact->text);
      own->name_depth = depth;
    }
  }
}

/* Day and time of day may stand under two keys. */
static void use_moment(struct eo_tree *tree, const struct eo_leaf *series, const struct eo_moment *moment, int depth)
{
  for (int c = series->first; c < series->first + series->channels; c++) {
    struct eo_own *own = &tree->own[c];
    if (moment->has_day && depth > own->day_depth)
      own->begin.day = moment->day, own->day_depth = depth;
    if (moment->has_time && depth > own->hour_depth)
      own->begin.seconds = moment->seconds, own->hour_depth = depth;
    if (own->hour_depth >= 0)
      tree->series[c].clock.epoch = eo_moment_epoch(&own->begin);
  }
}

/* A factor in "deg/count" tells the unit of its product; with a unit that does not ("10 dB") it is none of the values.
 */
static bool settle_factor(struct eo_tree *tree, const struct eo_leaf *series, const char *unit)
{
  char product[EO_RECORDING_UNIT];
  double factor;
  snprintf(product, sizeof product, "%.*s", (int)strcspn(unit, "/ "), unit);
  if (strlen(product) == strlen(unit) || eo_unit_find(product, &factor) == EO_QUANTITY_NONE)
    return !*unit;
  for (int c = series->first; c < series->first + series->channels; c++)
    if (tree->own[c].unit_depth < 0)
      snprintf(tree->series[c].unit, sizeof tree->series[c].unit, "%s", product);
  return true;
}

/* Numbers and moments that are written as texts. */
static void use_told(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  char key[64], unit[32];
  size_t outer;
  double number;
  struct eo_moment moment;
  int depth = claim(tree, fact, series, key, sizeof key, &outer);
  if (depth < 0)
    return;
  if (eo_stated_moment(key, fact->text, &moment))
    use_moment(tree, series, &moment, depth);
  else if (eo_stated_read_number(fact->text, &number, unit, sizeof unit)) {
    enum eo_stated_kind kind = eo_stated_read(key, number, unit).kind;
    if ((kind != EO_STATED_SCALE && kind != EO_STATED_OFFSET) || settle_factor(tree, series, unit))
      use_number(tree, fact, series, number, unit);
  }
  struct eo_stated ratio = eo_stated_read_ratio(key, fact->text);
  if (ratio.kind)
    use_stated(tree, fact, series, &ratio, depth);
}

static int count_lines(const char *texts)
{
  int count = *texts != '\0';
  for (; *texts; texts++)
    count += *texts == '\n';
  return count;
}

/* A list with a text for each channel of a table holds their names, or their units. */
static void use_list(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  size_t outer;
  int depth = nearness(tree, fact, series, &outer);
  if (depth < 0 || about_abscissa(fact, outer) || series->channels < 2 || count_lines(fact->text) != series->channels)
    return;
  const char *key = eo_tree_base_of(fact->path), *base = eo_tree_base_of(series->path);
  size_t block = strcspn(key, "_");
  if (key[block] == '_' && eo_tree_is_one_of(key + block + 1, strlen(key) - block - 1, "items") &&
      strncmp(key, base, block + 1))
    return;
  const char *p = fact->text;
  for (int c = series->first; c < series->first + series->channels; c++) {
    char word[EO_RECORDING_NAME];
    double factor;
    size_t n = strcspn(p, "\n");
    snprintf(word, sizeof word, "%.*s", (int)(n < sizeof word ? n : sizeof word - 1), p);
    bool unit = eo_tree_is_one_of(key, strlen(key), "unit|units|einheiten") ||
                (eo_unit_find(word, &factor) != EO_QUANTITY_NONE && strlen(word) > 1);
    if (unit && depth > tree->own[c].unit_depth)
      snprintf(tree->series[c].unit, sizeof tree->series[c].unit, "%.*s", EO_RECORDING_UNIT - 1, word);
    else if (!unit && depth > tree->own[c].name_depth) {
      snprintf(tree->series[c].name, sizeof tree->series[c].name, "%s", word);
      tree->own[c].name_depth = depth;
    }
    p += n + (p[n] == '\n');
  }
}

void eo_tree_use(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series)
{
  if (fact->kind == EO_LEAF_NUMBER)
    use_number(tree, fact, series, fact->number, "");
  else if (fact->kind == EO_LEAF_TEXT) {
    use_text(tree, fact, series);
    use_told(tree, fact, series);
  } else if (fact->kind == EO_LEAF_LIST)
    use_list(tree, fact, series);
}

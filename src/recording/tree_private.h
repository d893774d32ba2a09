/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a tree holds, and its paths: what belongs to what (tree.c), what a fact means for a series (tree_facts.c). */
#ifndef EASEOFF_RECORDING_TREE_PRIVATE_H
#define EASEOFF_RECORDING_TREE_PRIVATE_H

#include "recording/tree.h"

#include <stdbool.h>
#include <stddef.h>

#define EO_TREE_TIME_NAMES "t|time|times|zeit|timestamp|timestamps|tout|axis1|elapsed"
#define EO_TREE_GENERIC_NAMES "data|value|values|y|samples|signal|raw|yvalues|ydata|wave|waveform|x|dset|dataset"
#define EO_TREE_X_NAMES "x|xvalues|xaxis|xdata|abscissa|time|t|timevector|timeinfo|xinfo|timeaxis"

enum eo_leaf_kind { EO_LEAF_SERIES, EO_LEAF_NUMBER, EO_LEAF_TEXT, EO_LEAF_LIST };

struct eo_leaf {
  enum eo_leaf_kind kind;
  char *path; /* owned */
  double number;
  char *text;              /* owned; of texts and lists */
  size_t group;            /* bytes of the path of its group */
  char key[64];            /* the last part of the path, folded */
  const char *unit;        /* text under the key with "unit" behind; "": none */
  struct eo_stated stated; /* by a number under its own key, in that unit */
  bool seconds;            /* without a unit it would be in s */
  int first, channels;
};

/* What one channel has got, and from how near. */
struct eo_own {
  bool whole;
  double scale, offset;
  double missing;             /* stored where there is no value; NaN: not stated */
  int depth[EO_STATED_KINDS]; /* of the fact that was taken, by kind; -1: none */
  int name_depth, unit_depth;
  int day_depth, hour_depth; /* of what begin holds */
  struct eo_moment begin;
};

struct eo_tree {
  int leaves, room, count;
  int dropped; /* facts beyond those that are kept */
  struct eo_leaf *leaf;
  int sets, set[EO_TREE_CHANNELS]; /* leaves that are series */
  struct eo_series series[EO_TREE_CHANNELS];
  struct eo_own own[EO_TREE_CHANNELS];
};

/* The last part of a path; bytes of the path of the group that the thing at a path is in. */
const char *eo_tree_base_of(const char *path);
size_t eo_tree_group_size(const char *path);
/* The group of that size holds the path, at any depth. */
bool eo_tree_holds(const char *group, size_t size, const char *path);
int eo_tree_depth_of(const char *path, size_t size);
bool eo_tree_has_series(const struct eo_tree *tree, const char *group, size_t size);

/* Letters and digits of a word in lower case; whether they are one of the words, which bars separate. */
void eo_tree_fold(const char *word, size_t length, char *folded, size_t size);
bool eo_tree_is_one_of(const char *word, size_t length, const char *words);

bool eo_tree_is_time(const struct eo_leaf *leaf);

/* What facts say whatever the series, once for all: units under their keys with "unit" behind, what numbers state. */
void eo_tree_read_facts(struct eo_tree *tree);

/* Gives a series what a fact says of it, where that is nearer than what it has. */
void eo_tree_use(struct eo_tree *tree, const struct eo_leaf *fact, const struct eo_leaf *series);

#endif

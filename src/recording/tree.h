/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that keep channels in groups or structs with facts beside them (HDF5, MATLAB, Octave): which name, unit, rate,
   scale and times belong to which channel. Readers add what they find under its path, parts separated by '/', then
   settle. Internal to the readers. */
#ifndef EASEOFF_RECORDING_TREE_H
#define EASEOFF_RECORDING_TREE_H

#include "recording/series.h"

#define EO_TREE_CHANNELS EO_RECORDING_COLUMNS
#define EO_TREE_PATH 192

struct eo_tree; /* opaque */

enum eo_code eo_tree_new(struct eo_tree **tree, struct eo_error *error);
void eo_tree_free(struct eo_tree *tree); /* NULL is fine */

/* Channels of one variable or data set: `channels` series of this length. whole: the values are integers. Returns the
   number of the first, -1 when there are too many. */
int eo_tree_add_series(struct eo_tree *tree, const char *path, int channels, int64_t length, bool whole);

/* Facts: a single number, a text, a list of texts (separated by line ends). Those beyond memory or 2048 are dropped,
   with a word when the tree is settled. */
void eo_tree_add_number(struct eo_tree *tree, const char *path, double number);
void eo_tree_add_text(struct eo_tree *tree, const char *path, const char *text);
void eo_tree_add_list(struct eo_tree *tree, const char *path, const char *texts);

/* Gives each series what belongs to it. A fact belongs to the channels of its own group and those below; a group
   without channels speaks for the one it is in, or only for the channel whose name begins like its own
   ("Channel_1_Header" for "Channel_1_Data"); "pinion_scale" speaks for "pinion". The nearest fact wins. */
void eo_tree_settle(struct eo_tree *tree, struct eo_notes *notes);

/* Takes the stated moment of the start from times that do not count from it. file: the series of the tree. */
enum eo_code eo_tree_check_begins(struct eo_tree *tree, const struct eo_series_file *file, struct eo_error *error);

int eo_tree_count(const struct eo_tree *tree);
struct eo_series *eo_tree_series(struct eo_tree *tree); /* [eo_tree_count()] */

/* A stored value of a series as it was measured: by the scale and offset that the file states; NaN where it is what the
   file has in the place of missing ones. */
double eo_tree_value(const struct eo_tree *tree, int series, double stored);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Channels of one name in several groups of a file ("angle" of the group "pinion" and of the group "gear"). Internal to
   the readers. */
#ifndef EASEOFF_RECORDING_NAMESAKES_H
#define EASEOFF_RECORDING_NAMESAKES_H

#include "recording/series.h"

/* Writes what tells the group of a series from that of its namesake; "" where nothing does. */
typedef void eo_namesake_group(const void *context, int series, int namesake, char *group, size_t size);

/* Puts the group before the name of each series that has a namesake in another one: "pinion angle". */
void eo_namesakes_part(struct eo_series *series, int count, eo_namesake_group *group_of, const void *context);

#endif

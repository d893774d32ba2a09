/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/namesakes.h"

#include <stdio.h>
#include <string.h>

void eo_namesakes_part(struct eo_series *series, int count, eo_namesake_group *group_of, const void *context)
{
  char group[EO_SERIES][EO_RECORDING_NAME], name[EO_RECORDING_NAME];
  for (int c = 0; c < count && c < EO_SERIES; c++) { /* all groups before the first new name */
    *group[c] = '\0';
    for (int i = 0; i < count && !*group[c]; i++)
      if (i != c && !strcmp(series[i].name, series[c].name))
        group_of(context, c, i, group[c], sizeof group[c]);
  }
  for (int c = 0; c < count && c < EO_SERIES; c++)
    if (*group[c]) {
      snprintf(name, sizeof name, "%.30s %.30s", group[c], series[c].name);
      memcpy(series[c].name, name, sizeof name);
    }
}

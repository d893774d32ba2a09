/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/names.h"

#include <stddef.h>

const char *const eo_member_name[3] = {"pinion", "gear", NULL};
const char *const eo_end_name[3] = {"left", "right", NULL};
const char *const eo_flank_side_name[3] = {"drive", "coast", NULL};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The inside of a prepared flexibility, shared by the files that make it and read it. */
#ifndef EASEOFF_FLEXIBILITY_FLEXIBILITY_PRIVATE_H
#define EASEOFF_FLEXIBILITY_FLEXIBILITY_PRIVATE_H

#include "flexibility/flexibility.h"
#include "flexibility/member_table.h"

struct eo_flexibility {
  struct eo_flexibility_settings settings;
  struct eo_flexibility_report report;
  struct eo_flank_table table[2]; /* [member] */
  double width[2];                /* [member] of its own face, m */
  double twist[2];                /* [member], rad/m */
};

#endif

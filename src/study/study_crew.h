/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a search computed by a crew (crew/crew.h): on threads of this process or on the ranks of an MPI run. */
#ifndef EASEOFF_STUDY_STUDY_CREW_H
#define EASEOFF_STUDY_STUDY_CREW_H

#include "crew/crew.h"
#include "study/study_private.h"

/* The order is the complete design, an item a modification as the history has it behind the numbers of states that
   it has and gets, an answer what is new of the row but its number. */
extern const struct eo_crew_trade eo_study_trade;

/* Computes the missing rows of the pending batch; they come back in its order. Errors: of the crew. */
enum eo_code eo_study_compute_on_crew(struct study *study, struct eo_error *error);

#endif

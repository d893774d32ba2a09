/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The prepared pairs that the threads of one process work with at present. */
#ifndef EASEOFF_VARIANTS_PAIR_RACK_H
#define EASEOFF_VARIANTS_PAIR_RACK_H

#include "crew/trade.h"
#include "evaluation/pair.h"

struct eo_pair_rack;
struct eo_racked_pair;

/* place: its folder of prepared pairs and its bounds; borrowed, as progress, which is called from any thread. Errors:
   memory. */
enum eo_code eo_pair_rack_new(struct eo_pair_rack **rack, const struct eo_crew_place *place,
                              const struct eo_progress *progress, struct eo_error *error);
void eo_pair_rack_free(struct eo_pair_rack *rack); /* everything was put back; NULL is fine */

/* The pair that serves a complete design, prepared when nobody has it; others who ask meanwhile wait. Those that nobody
   holds any more make room for it. Errors: EO_ERROR_INPUT beyond
   the bounds, of eo_pair_new(); the same for all who asked. */
enum eo_code eo_pair_rack_take(struct eo_pair_rack *rack, const struct eo_design *design, struct eo_racked_pair **held,
                               struct eo_error *error);
void eo_pair_rack_put(struct eo_pair_rack *rack, struct eo_racked_pair *held); /* NULL is fine */

/* The pair itself, until it is put back. */
const struct eo_pair *eo_racked_pair(const struct eo_racked_pair *held);

#endif

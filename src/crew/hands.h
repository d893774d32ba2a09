/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The threads of one process at a bench: items in, answers out, in any order. One thread gives and collects. */
#ifndef EASEOFF_CREW_HANDS_H
#define EASEOFF_CREW_HANDS_H

#include "crew/trade.h"

/* An item on its way. */
struct eo_crew_parcel {
  int item;
  int order;           /* between ranks: number of the order it belongs to */
  struct eo_text text; /* the item, then its answer; owned by whoever has the parcel */
  struct eo_error error;
};

struct eo_hands;

/* Opens the bench and starts place->threads threads. order is copied. Errors: of the trade's open; memory. */
enum eo_code eo_hands_new(struct eo_hands **hands, const struct eo_crew_trade *trade, const char *order, size_t size,
                          const struct eo_crew_place *place, struct eo_error *error);

/* Asks what is being worked on to end early. */
void eo_hands_stop(struct eo_hands *hands);

/* Waits for the threads and closes the bench. What was not collected is dropped. NULL is fine. */
void eo_hands_free(struct eo_hands *hands);

/* Takes the parcel over. False without memory: it is still the caller's. */
bool eo_hands_give(struct eo_hands *hands, struct eo_crew_parcel *parcel);

/* A parcel that is done, waiting for one up to so many milliseconds (0: not at all). False: none is. */
bool eo_hands_collect(struct eo_hands *hands, int milliseconds, struct eo_crew_parcel *parcel);

#endif

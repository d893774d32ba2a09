/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Messages between rank 0 and the others, shared by both sides. */
#ifndef EASEOFF_CREW_MESSAGE_H
#define EASEOFF_CREW_MESSAGE_H

#include <stdint.h>

#include "crew/crew.h"
#include "crew/hands.h"

enum eo_crew_tag {
  EO_CREW_HELLO = 1, /* to rank 0: struct eo_crew_member */
  EO_CREW_ORDER,     /* struct eo_crew_head, name of the trade, NUL, the order */
  EO_CREW_ITEM,      /* struct eo_crew_head, the item */
  EO_CREW_ANSWER,    /* to rank 0: struct eo_crew_head, the answer or a struct eo_error */
  EO_CREW_STOP,      /* end early what is being worked on */
  EO_CREW_CLOSE,     /* the order is done */
  EO_CREW_HOME,      /* the run is over */
};

struct eo_crew_head {
  int32_t order;      /* its number: an answer to an earlier one may still be on its way */
  int32_t item, code; /* item -1: the order itself failed */
};

/* A message as it came. */
struct eo_crew_letter {
  int from, tag;
  struct eo_text text; /* owned */
};

/* A message of the tag to a rank. text: NULL for one without words; one that has failed is not sent. Errors: memory,
   EO_ERROR_FILE of the ranks. */
enum eo_code eo_crew_send(const struct eo_crew *crew, int to, enum eo_crew_tag tag, const struct eo_text *text,
                          struct eo_error *error);

/* An item or an answer with its head. */
enum eo_code eo_crew_send_parcel(const struct eo_crew *crew, int to, enum eo_crew_tag tag,
                                 const struct eo_crew_parcel *parcel, struct eo_error *error);

/* The way back; false: it is no such letter. */
bool eo_crew_open_parcel(const struct eo_crew_letter *letter, struct eo_crew_parcel *parcel);

/* *there false: nothing came. */
enum eo_code eo_crew_receive(const struct eo_crew *crew, bool *there, struct eo_crew_letter *letter,
                             struct eo_error *error);

/* Rests between two looks for messages: MPI would wait at full load. idle: looks without a message so far. */
void eo_crew_rest(int idle);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prepared gear pairs, shared: each is prepared once however many threads ask for it, kept as long as somebody uses it,
   and a few beyond that. With a pair go the analyses made on it, so that a user who changes one thing after another
   finds what the last request left. Any thread may call. */
#ifndef EASEOFF_SERVICE_PAIRS_H
#define EASEOFF_SERVICE_PAIRS_H

#include "base/hash.h"
#include "evaluation/analysis.h"
#include "service/preparation.h"

struct eo_pairs;
struct eo_held_pair; /* a reference: eo_pairs_release() gives it back */

struct eo_pairs_settings {
  struct eo_preparation_settings preparation; /* strings borrowed for as long as the pairs live; cache NULL: none */
  int most;                                   /* kept in memory; more only while they are used */
  double cache_bytes;                         /* of all pairs that are kept on disk */
};

/* Empty. Errors: memory. */
enum eo_code eo_pairs_new(struct eo_pairs **pairs, const struct eo_pairs_settings *settings, struct eo_error *error);
void eo_pairs_free(struct eo_pairs *pairs); /* nothing may be held any more; NULL is fine */

/* The key of the pair that a complete design needs (design/pair_identity.h). */
void eo_pairs_key(const struct eo_design *design, char key[EO_HASH_LENGTH + 1]);

/* The pair that serves a complete design, NULL when it is not in memory. Does not wait. */
struct eo_held_pair *eo_pairs_find(struct eo_pairs *pairs, const struct eo_design *design);

/* The same, prepared when it is not there; while another thread prepares it, waits for that. Errors: of eo_pair_new(),
   EO_ERROR_CANCELLED. */
enum eo_code eo_pairs_obtain(struct eo_pairs *pairs, const struct eo_design *design, const struct eo_progress *progress,
                             struct eo_held_pair **held, struct eo_error *error);
void eo_pairs_release(struct eo_pairs *pairs, struct eo_held_pair *held); /* NULL is fine */

/* The pair itself, until it is released. */
const struct eo_pair *eo_held_pair(const struct eo_held_pair *held);

/* An analysis on the pair for one thread: the one that last served this user (a number that tells users apart, 0:
   nobody), or another idle one, or a new one. To be given back before the pair. */
enum eo_code eo_pairs_borrow(struct eo_pairs *pairs, struct eo_held_pair *held, uint64_t user,
                             struct eo_analysis **analysis, struct eo_error *error);
void eo_pairs_give_back(struct eo_pairs *pairs, struct eo_held_pair *held, uint64_t user, struct eo_analysis *analysis);

/* Pairs that are in memory and ready. */
int eo_pairs_count(struct eo_pairs *pairs);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rank that works for rank 0. */
#include <string.h>

#include "crew/message.h"

struct serving {
  const struct eo_crew *crew;
  const struct eo_crew_trade *const *trades;
  int order;              /* number of the last order */
  struct eo_hands *hands; /* of the order that is being worked on; NULL: none */
  bool home;
};

/* What does not go well here is said to rank 0, which ends the run. */
static enum eo_code complain(struct serving *serving, const struct eo_error *why, struct eo_error *error)
{
  const struct eo_crew_parcel parcel = {.order = serving->order, .item = -1, .error = *why};
  return eo_crew_send_parcel(serving->crew, 0, EO_CREW_ANSWER, &parcel, error);
}

static enum eo_code begin_order(struct serving *serving, const struct eo_text *text, struct eo_error *why)
{
  const char *name = text->data ? text->data : "";
  size_t length = strlen(name) + 1;
  for (int i = 0; serving->trades[i]; i++)
    if (strcmp(serving->trades[i]->name, name) == 0)
      return eo_hands_new(&serving->hands, serving->trades[i], text->data + length, text->size - length,
                          &serving->crew->place, why);
  return eo_error_set(why, EO_ERROR_INPUT, "", "Rank %d does not know the work \"%.40s\".", serving->crew->rank, name);
}

static enum eo_code take_order(struct serving *serving, const struct eo_crew_letter *letter, struct eo_error *error)
{
  struct eo_error why;
  struct eo_crew_parcel parcel;
  if (!eo_crew_open_parcel(letter, &parcel))
    return eo_error_memory(error);
  serving->order = parcel.order;
  enum eo_code code = begin_order(serving, &parcel.text, &why);
  eo_text_done(&parcel.text);
  return code ? complain(serving, &why, error) : EO_OK;
}

static enum eo_code take_item(struct serving *serving, const struct eo_crew_letter *letter, struct eo_error *error)
{
  struct eo_crew_parcel parcel;
  enum eo_code code = eo_crew_open_parcel(letter, &parcel) ? EO_OK : eo_error_memory(error);
  if (!code && !serving->hands) { /* rank 0 has heard why, and waits for its items */
    eo_error_set(&parcel.error, EO_ERROR_CANCELLED, "", "The work was cancelled.");
    code = eo_crew_send_parcel(serving->crew, 0, EO_CREW_ANSWER, &parcel, error);
  } else if (!code && !eo_hands_give(serving->hands, &parcel))
    code = eo_error_memory(error);
  eo_text_done(&parcel.text);
  return code;
}

static void close_order(struct serving *serving)
{
  eo_hands_free(serving->hands);
  serving->hands = NULL;
}

static enum eo_code take_letter(struct serving *serving, const struct eo_crew_letter *letter, struct eo_error *error)
{
  switch (letter->tag) {
  case EO_CREW_ORDER:
    return take_order(serving, letter, error);
  case EO_CREW_ITEM:
    return take_item(serving, letter, error);
  case EO_CREW_STOP:
    if (serving->hands)
      eo_hands_stop(serving->hands);
    return EO_OK;
  case EO_CREW_CLOSE:
    close_order(serving);
    return EO_OK;
  default:
    serving->home = true;
    return EO_OK;
  }
}

static enum eo_code answer(struct serving *serving, bool *busy, struct eo_error *error)
{
  struct eo_crew_parcel parcel;
  while (serving->hands && eo_hands_collect(serving->hands, 0, &parcel)) {
    parcel.order = serving->order;
    enum eo_code code = eo_crew_send_parcel(serving->crew, 0, EO_CREW_ANSWER, &parcel, error);
    eo_text_done(&parcel.text);
    EO_TRY(code);
    *busy = true;
  }
  return EO_OK;
}

/* One letter, if there is one, and the answers that are ready. */
static enum eo_code serve_once(struct serving *serving, bool *busy, struct eo_error *error)
{
  struct eo_crew_letter letter;
  enum eo_code code = eo_crew_receive(serving->crew, busy, &letter, error);
  if (!code && *busy)
    code = take_letter(serving, &letter, error);
  eo_text_done(&letter.text);
  return code ? code : answer(serving, busy, error);
}

enum eo_code eo_crew_serve(const struct eo_crew *crew, const struct eo_crew_trade *const *trades,
                           struct eo_error *error)
{
  struct serving serving = {.crew = crew, .trades = trades};
  enum eo_code code = EO_OK;
  for (int idle = 0; !code && !serving.home;) {
    bool busy = false;
    code = serve_once(&serving, &busy, error);
    idle = busy ? 0 : idle + 1;
    if (!code && !busy)
      eo_crew_rest(idle);
  }
  close_order(&serving);
  return code;
}

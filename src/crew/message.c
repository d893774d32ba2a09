/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crew/message.h"

#include <math.h>
#include <string.h>
#include <time.h>

static enum eo_code fault(const struct eo_crew *crew, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_FILE, "", "MPI: %.300s.", crew->ranks->message());
}

enum eo_code eo_crew_send(const struct eo_crew *crew, int to, enum eo_crew_tag tag, const struct eo_text *text,
                          struct eo_error *error)
{
  static const struct eo_text nothing;
  const struct eo_text *sent = text ? text : &nothing;
  if (sent->failed)
    return eo_error_memory(error);
  return crew->ranks->send(to, (int)tag, sent->data ? sent->data : "", sent->size) ? fault(crew, error) : EO_OK;
}

enum eo_code eo_crew_send_parcel(const struct eo_crew *crew, int to, enum eo_crew_tag tag,
                                 const struct eo_crew_parcel *parcel, struct eo_error *error)
{
  const struct eo_crew_head head = {parcel->order, parcel->item, parcel->error.code};
  struct eo_text text = {0};
  eo_text_add_bytes(&text, &head, sizeof head);
  if (head.code)
    eo_text_add_bytes(&text, &parcel->error, sizeof parcel->error);
  else
    eo_text_add_bytes(&text, parcel->text.data ? parcel->text.data : "", parcel->text.size);
  enum eo_code code = eo_crew_send(crew, to, tag, &text, error);
  eo_text_done(&text);
  return code;
}

bool eo_crew_open_parcel(const struct eo_crew_letter *letter, struct eo_crew_parcel *parcel)
{
  struct eo_crew_head head;
  *parcel = (struct eo_crew_parcel){0};
  if (letter->text.size < sizeof head)
    return false;
  memcpy(&head, letter->text.data, sizeof head);
  const char *rest = letter->text.data + sizeof head;
  size_t size = letter->text.size - sizeof head;
  parcel->order = head.order;
  parcel->item = head.item;
  if (head.code && size == sizeof parcel->error)
    memcpy(&parcel->error, rest, size);
  else if (head.code)
    return false;
  else
    eo_text_add_bytes(&parcel->text, rest, size);
  return !parcel->text.failed;
}

enum eo_code eo_crew_receive(const struct eo_crew *crew, bool *there, struct eo_crew_letter *letter,
                             struct eo_error *error)
{
  size_t size = 0;
  *letter = (struct eo_crew_letter){0};
  if (crew->ranks->probe(there, &letter->from, &letter->tag, &size))
    return fault(crew, error);
  if (!*there)
    return EO_OK;
  char *room = eo_text_room(&letter->text, size);
  if (!room)
    return eo_error_memory(error);
  if (crew->ranks->receive(letter->from, letter->tag, room, size))
    return fault(crew, error);
  room[size] = '\0';
  letter->text.size = size;
  return EO_OK;
}

/* Each rest is an eighth longer than the one before, so that a message waits for at most an eighth of the time that
   nothing came, and hundreds of ranks on one machine do not keep it busy with looking. */
void eo_crew_rest(int idle)
{
  static const double FIRST = 50e-6, LONGEST = 20e-3, GROWTH = 1.125; /* s */
  double rest = fmin(FIRST * pow(GROWTH, idle), LONGEST);
  nanosleep(&(struct timespec){0, (long)(1e9 * rest)}, NULL);
}

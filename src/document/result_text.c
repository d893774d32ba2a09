/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A result as text without the whole of it as JSON before: the head, the halves of each load case and the tail, written
   side by side. */
#include "document/result.h"

#include <stdlib.h>

#include "document/result_private.h"

enum { WRITERS = EO_TEAM_THREADS, HALVES = 2, MOST_PARTS = 1 + HALVES * EO_MAX_LOAD_CASES };

struct writing {
  struct eo_result_source source[WRITERS]; /* [thread] */
  struct eo_text part[MOST_PARTS];
};

static json_t *encode_part(struct eo_result_source *source, int part)
{
  int k = (part - 1) / HALVES;
  if (part == 0)
    return eo_result_head(source);
  return part % HALVES ? eo_result_case_contact(source, k) : eo_result_case_consequences(source, k);
}

/* The largest first, so that both writers end together: the head, the consequences of each load case, its contact. */
static int part_of(const struct writing *writing, int item)
{
  int cases = writing->source[0].analysis->cases;
  return item <= cases ? HALVES * item : HALVES * (item - cases) - 1;
}

/* What cannot be made stays empty. */
static void write_part(void *context, int thread, int item)
{
  struct writing *writing = context;
  int number = part_of(writing, item);
  json_t *part = encode_part(&writing->source[thread], number);
  if (part)
    eo_json_write(&writing->part[number], part, EO_JSON_COMPACT);
  json_decref(part);
}

/* What stands in the braces of a part. */
static void add_members(struct eo_text *text, const struct eo_text *part)
{
  eo_text_add_bytes(text, part->data + 1, part->size - 2);
}

/* The parts as one object. */
static void join(const struct writing *writing, int cases, const struct eo_text *tail, struct eo_text *text)
{
  eo_text_add(text, "{");
  add_members(text, &writing->part[0]);
  eo_text_add(text, ",\"load_cases\":[");
  for (int k = 0; k < cases; k++) {
    eo_text_add(text, k ? ",{" : "{");
    add_members(text, &writing->part[1 + HALVES * k]);
    eo_text_add(text, ",");
    add_members(text, &writing->part[2 + HALVES * k]);
    eo_text_add(text, "}");
  }
  eo_text_add(text, "],");
  add_members(text, tail);
  eo_text_add(text, "}");
}

static enum eo_code write_all(struct writing *writing, const struct eo_warnings *warnings, struct eo_text *text,
                              struct eo_error *error)
{
  const struct eo_analysis *analysis = writing->source[0].analysis;
  int parts = 1 + HALVES * analysis->cases;
  struct eo_text tail = {0};
  eo_team_do(eo_evaluator_team(analysis->evaluator), &(struct eo_work_list){write_part, writing, .pieces = parts});
  for (int i = 0; i < parts; i++)
    if (!writing->part[i].size || writing->part[i].failed)
      return eo_error_memory(error);
  json_t *last = eo_result_tail(&writing->source[0], warnings);
  if (last)
    eo_json_write(&tail, last, EO_JSON_COMPACT);
  if (last && !tail.failed)
    join(writing, analysis->cases, &tail, text);
  bool good = last && !tail.failed && !text->failed;
  json_decref(last);
  eo_text_done(&tail);
  return good ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_result_write(const struct eo_analysis *analysis, const struct eo_design *design,
                             const struct eo_warnings *warnings, unsigned left_out, struct eo_text *text,
                             struct eo_error *error)
{
  struct writing *writing = calloc(1, sizeof *writing);
  double edge_pressure[EO_MAX_LOAD_CASES][2];
  bool good = writing != NULL;
  for (int i = 0; i < WRITERS && good; i++) {
    good = eo_result_source_init(&writing->source[i], analysis, design, left_out);
    eo_result_source_write_only(&writing->source[i]);
    writing->source[i].edge_pressure = edge_pressure;
  }
  enum eo_code code = good ? write_all(writing, warnings, text, error) : eo_error_memory(error);
  for (int i = 0; i < WRITERS && writing; i++)
    eo_result_source_done(&writing->source[i]);
  for (int i = 0; i < MOST_PARTS && writing; i++)
    eo_text_done(&writing->part[i]);
  free(writing);
  return code;
}

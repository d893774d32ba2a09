/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include "base/parallel.h"

struct ends {
  struct eo_evaluator *evaluator;
  const struct eo_run *run;
  eo_end_step *step;
};

static enum eo_code take_end(void *context, int thread, int end, struct eo_error *error)
{
  const struct ends *ends = context;
  (void)thread;
  (void)error;
  ends->step(ends->evaluator, ends->run, end);
  return EO_OK;
}

enum eo_code eo_evaluator_each_end(struct eo_evaluator *evaluator, const struct eo_run *run, eo_end_step *step,
                                   struct eo_error *error)
{
  EO_TIMED(evaluator->result.static_ms);
  struct ends ends = {.evaluator = evaluator, .run = run, .step = step};
  const struct eo_parallel parallel = {.threads = evaluator->threads, .work = take_end, .context = &ends};
  return eo_parallel_run(&parallel, evaluator->result.ends, error);
}

static void *run_beside(void *argument)
{
  const struct eo_beside *beside = argument;
  beside->work(beside->context, 1);
  return NULL;
}

/* Where no thread can be made, the calling one does all of the work at the end. */
void eo_beside_start(struct eo_beside *beside, int threads)
{
  beside->started = threads > 1 && pthread_create(&beside->thread, NULL, run_beside, beside) == 0;
}

void eo_beside_finish(struct eo_beside *beside)
{
  beside->work(beside->context, 0);
  if (beside->started)
    pthread_join(beside->thread, NULL);
}

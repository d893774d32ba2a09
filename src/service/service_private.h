/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The inside of the service, shared by the files it is made of; see service.h. Where two mutexes are held, the one that
   stands first below was taken first. */
#ifndef EASEOFF_SERVICE_SERVICE_PRIVATE_H
#define EASEOFF_SERVICE_SERVICE_PRIVATE_H

#include <pthread.h>
#include <stdatomic.h>

#include "service/lane.h"
#include "service/pairs.h"
#include "service/service.h"

enum { EO_SERVICE_BUCKETS = 12 };

/* A job whose end could not be written down yet. */
struct eo_unended_job {
  int64_t id; /* 0: there is none */
  enum eo_job_state state;
  struct eo_text fault, progress; /* owned */
};

/* A thread that works off one kind of job. */
struct eo_service_worker {
  struct eo_service *service;
  enum eo_job_kind kind;
  struct eo_store *store; /* owned; of this thread */
  pthread_t thread;
  bool running;            /* the thread was made */
  struct eo_job_live live; /* guarded by live_mutex */
  struct eo_unended_job unended;
  bool recorded;           /* its end stands in the table already */
  bool launched;           /* guarded by live_mutex: its job is another process's, the table says how far it is */
  atomic_bool cancelled;   /* the job it works on shall end */
  double published, noted; /* ms of the clock, of the last event and the last note in the table */
};

struct eo_service {
  struct eo_service_settings settings; /* resolved; strings owned */
  int cores;                           /* an analysis uses a second one where there is one */
  struct eo_pairs *pairs;
  struct eo_events *events;
  struct eo_lane *analyses, *sweeps, *works;
  struct eo_service_worker worker[EO_JOB_KINDS];
  atomic_bool stopping;

  pthread_mutex_t preparing_mutex; /* from looking for a pair until somebody waits for its job; from the end of such a
                                      job until he is woken */
  pthread_mutex_t
      publish_mutex; /* from reading a job until its event is out, so that events come in the order of the states */
  pthread_mutex_t store_mutex; /* guards store */
  struct eo_store *store;
  pthread_mutex_t live_mutex; /* guards the workers' live */
  pthread_mutex_t note_mutex; /* guards note; held while it is called */
  eo_service_note *note;
  void *note_context;
  pthread_mutex_t work_mutex; /* guards calls */
  pthread_cond_t work;        /* calls has grown, or stopping */
  uint64_t calls;             /* how often somebody said that there is work */

  atomic_llong analyses_done, overtaken, sweeps_done, refused, true_evaluations, reused_evaluations;
  pthread_mutex_t timing_mutex; /* guards what follows */
  double total_ms, most_ms;
  int64_t bucket[EO_SERVICE_BUCKETS];
};

/* How gear pairs are prepared here. */
struct eo_preparation_settings eo_service_preparation(const struct eo_service *service);

/* The workers' thread. */
void *eo_service_work(void *worker);

/* There is work to claim. */
void eo_service_wake(struct eo_service *service);

/* Puts the present state of a job into the stream of events. */
void eo_service_publish(struct eo_service *service, int64_t id);

/* What the lanes call, and how they release a task. */
void eo_service_run_task(void *service, struct eo_lane_task *task, enum eo_lane_fate fate);
void eo_service_release_task(struct eo_lane_task *task);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of src/http/ share of the running server. */
#ifndef EASEOFF_HTTP_HTTP_PRIVATE_H
#define EASEOFF_HTTP_HTTP_PRIVATE_H

#include <pthread.h>
#include <stdint.h>

#include <microhttpd.h>

#include "http/client.h"
#include "http/http.h"

enum {
  EO_IDLE_SECONDS = 30,         /* between requests, for all header fields of one, for a pause in a body */
  EO_BODY_SECONDS = 120,        /* for a whole body, and for the client to take a reply */
  EO_SLOWEST_READER = 64 << 10, /* bytes per second: a long reply has more time */
  EO_PARTING_SECONDS = 3,       /* at a stop, for clients to take what they are owed */
  EO_HEARTBEAT_SECONDS = 10,
  EO_LOCK_MS = 250,           /* that this thread waits while another program writes */
  EO_MOST_BODIES = 128 << 20, /* bytes of all bodies at once */
  EO_DRAINED = 64 << 10,      /* bytes of a refused body that are read so that the connection can go on */
};

struct eo_background;
struct eo_connection;
struct eo_documents;
struct eo_guard;
struct eo_log;
struct eo_pages;
struct eo_route;
struct eo_storage_watch;
struct eo_store;
struct eo_stream;

struct eo_http {
  struct eo_http_settings settings; /* strings borrowed for as long as the server lives */
  struct MHD_Daemon *daemon;
  int socket;
  char url[120];
  char notice[400]; /* what the start found, "": nothing */
  double started;   /* ms */
  uint64_t run;     /* first half of request ids */
  struct eo_service *service;
  struct eo_store *store; /* of the HTTP thread */
  struct eo_guard *guard; /* of the HTTP thread but for its constants */
  struct eo_log *log;
  struct eo_proxies proxies;
  struct eo_storage_watch *storage;
  const struct eo_route *const *routes; /* NULL after the last table */
  struct eo_background *aside;
  struct eo_background *readings; /* reads the rig files that were uploaded */
  struct eo_upload *uploads;      /* on their way; HTTP thread */
  struct eo_pages *pages;
  struct eo_documents *documents; /* made once: OpenAPI, field tables, examples */
  size_t bodies;                  /* bytes of bodies in memory; HTTP thread */
  uint64_t requests;              /* HTTP thread */
  uint64_t replies[6];            /* by hundreds of the status; HTTP thread */

  pthread_mutex_t lock; /* of everything below; never held while the service is called */
  pthread_cond_t changed;
  struct eo_connection *connections;
  struct eo_stream *streams;
  int connection_count, stream_count;
  size_t backlog; /* bytes that streams keep for their clients */
  int deferred;   /* requests that somebody still has to finish, and one while a handler runs */
  int active;     /* requests from their first byte to the last of their reply */
  bool closing;
  pthread_t ticker;
};

#endif

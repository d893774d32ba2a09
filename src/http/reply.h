/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A reply while it is made: what it says and the header fields beside. It knows no request; send.h hands it to the
   connection. This header is for src/http/ alone. */
#ifndef EASEOFF_HTTP_REPLY_H
#define EASEOFF_HTTP_REPLY_H

#include <stdbool.h>

#include <jansson.h>

#include "format/faults.h"
#include "format/outline.h"
#include "format/text.h"

struct MHD_Response;
struct eo_log;
struct eo_storage_watch;
struct eo_resource;

enum { EO_TAG = 70 };

/* A fault of the body; all borrowed. */
struct eo_problem_fault {
  const char *path, *pointer; /* the key's JSON pointer is one behind the other */
  const char *detail;
};

/* What stands in a problem beside what every one has. */
struct eo_problem_more {
  int faults;
  const struct eo_problem_fault *fault; /* [faults], borrowed */
  bool of_recording;                    /* the next line is there */
  json_t *findings, *notes, *layout, *signal;
  bool of_import; /* the next line is there */
  json_t *imported;
};
extern const struct eo_outline eo_outline_problem;

struct eo_reply {
  const char *request;                            /* its id, borrowed; it stands in problems */
  struct eo_log *log;                             /* borrowed; NULL: none */
  struct eo_storage_watch *storage;               /* the same: hears of what cannot be kept */
  unsigned status;                                /* 0: there is no reply yet */
  const char *type;                               /* literal */
  struct eo_text body;                            /* owned */
  const struct eo_resource *resource;             /* in place of the body: borrowed from the server */
  struct MHD_Response *stream;                    /* in place of the body: owned until it is queued */
  char tag[EO_TAG];                               /* ETag without quotes; "": none */
  char location[240], file_name[80], cookie[320]; /* "": none */
  char notes[600];               /* what a reader of the body has to know, "; " between sentences; "": nothing */
  int retry_after;               /* s; 0: none */
  unsigned allow;                /* methods; 0: no Allow */
  bool authenticate, revalidate; /* WWW-Authenticate; the client may keep a copy and ask whether it still holds */
  bool close;                    /* the connection ends with this reply */
  bool inches; /* asked for by ?units=inch, of a route that has it: documents and problems are spelt so */
};

/* Takes the document over; NULL: no memory, 500. */
void eo_reply_json(struct eo_reply *reply, unsigned status, json_t *document);

/* Takes the text over. type: a literal. */
void eo_reply_text(struct eo_reply *reply, unsigned status, const char *type, struct eo_text *text);
void eo_reply_empty(struct eo_reply *reply, unsigned status);

/* A problem document (RFC 9457). name: the last part of "/problems/NAME", or NULL for a status that says enough by
   itself. */
void eo_reply_problem(struct eo_reply *reply, unsigned status, const char *name, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same with what else a program can read about the problem; its documents are taken over. */
void eo_reply_problem_with(struct eo_reply *reply, unsigned status, const char *name,
                           const struct eo_problem_more *more, const char *detail);

/* 422 with every fault and its pointer below path. */
void eo_reply_faults(struct eo_reply *reply, const char *path, const struct eo_faults *faults);

/* An error of the core: 422 when the input is wrong, else 500. */
void eo_reply_error(struct eo_reply *reply, const char *path, const struct eo_error *error);
/* 503: an allocation failed. */
void eo_reply_no_memory(struct eo_reply *reply);

void eo_reply_done(struct eo_reply *reply);

#endif

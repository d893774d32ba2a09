/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/connection.h"
#include "http/http_private.h"
#include "http/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct eo_stream {
  struct eo_http *http;
  struct MHD_Connection *connection;
  struct eo_connection *place;
  int64_t subscription;
  struct eo_stream *before, *after;
  struct eo_text waiting; /* what the client has not taken, from `taken` on */
  size_t taken;
  bool opened; /* what was missed is there, from here on the backlog counts */
  bool suspended, ended;
};

static void wake(struct eo_stream *stream)
{
  if (!stream->suspended)
    return;
  stream->suspended = false;
  MHD_resume_connection(stream->connection);
}

/* A client that does not read is cut off; it comes back with the number of the last event it has. */
static void append(struct eo_stream *stream, const char *text, size_t size)
{
  if (stream->ended)
    return;
  size_t left = stream->waiting.size - stream->taken;
  bool fits = stream->http->backlog + size <= EO_MOST_BACKLOG &&
              (!stream->opened || left + size <= EO_STREAM_BACKLOG || left == 0);
  if (fits) {
    eo_text_add_bytes(&stream->waiting, text, size);
    stream->http->backlog += size;
  }
  if (!fits || stream->waiting.failed) {
    stream->ended = true;
    stream->place->deadline = 1;
  }
  wake(stream);
}

void eo_streams_beat(struct eo_http *http)
{
  static const char beat[] = ": still here\n\n";
  for (struct eo_stream *stream = http->streams; stream; stream = stream->after)
    if (stream->waiting.size == stream->taken)
      append(stream, beat, sizeof beat - 1);
}

void eo_streams_end(struct eo_http *http)
{
  for (struct eo_stream *stream = http->streams; stream; stream = stream->after) {
    stream->ended = true;
    wake(stream);
  }
}

/* What was taken leaves the buffer, once it is worth moving the rest. */
static void forget_taken(struct eo_stream *stream)
{
  enum { WORTH_MOVING = 64 << 10 };
  size_t left = stream->waiting.size - stream->taken;
  if (left && stream->taken < WORTH_MOVING)
    return;
  if (left)
    memmove(stream->waiting.data, stream->waiting.data + stream->taken, left);
  stream->waiting.size = left;
  stream->taken = 0;
}

static ssize_t read_stream(void *context, uint64_t position, char *buffer, size_t most)
{
  struct eo_stream *stream = context;
  ssize_t given = 0;
  (void)position;
  pthread_mutex_lock(&stream->http->lock);
  size_t left = stream->waiting.size - stream->taken;
  if (left) {
    given = (ssize_t)(left < most ? left : most);
    memcpy(buffer, stream->waiting.data + stream->taken, (size_t)given);
    stream->taken += (size_t)given;
    stream->http->backlog -= (size_t)given;
    forget_taken(stream);
  } else if (stream->ended)
    given = MHD_CONTENT_READER_END_OF_STREAM;
  else {
    stream->suspended = true;
    MHD_suspend_connection(stream->connection);
  }
  pthread_mutex_unlock(&stream->http->lock);
  return given;
}

static void free_stream(void *context)
{
  struct eo_stream *stream = context;
  struct eo_http *http = stream->http;
  if (stream->subscription)
    eo_service_unsubscribe(http->service, stream->subscription);
  pthread_mutex_lock(&http->lock);
  if (stream->before)
    stream->before->after = stream->after;
  else
    http->streams = stream->after;
  if (stream->after)
    stream->after->before = stream->before;
  http->stream_count--;
  http->backlog -= stream->waiting.size - stream->taken;
  if (http->closing)
    pthread_cond_broadcast(&http->changed);
  pthread_mutex_unlock(&http->lock);
  eo_text_done(&stream->waiting);
  free(stream);
}

static void take_event(void *context, const struct eo_service_event *event)
{
  struct eo_stream *stream = context;
  struct eo_text text = {0};
  eo_text_print(&text, "id: %lld\nevent: job\ndata: ", (long long)event->number);
  eo_text_add_bytes(&text, event->text, event->size);
  eo_text_add(&text, "\n\n");
  pthread_mutex_lock(&stream->http->lock);
  if (!text.failed)
    append(stream, text.data, text.size);
  pthread_mutex_unlock(&stream->http->lock);
  eo_text_done(&text);
}

static const char hello[] = "retry: 2000\n\n"; /* ms until a client comes back */

/* From here on who does not read is cut off. */
static void open_stream(struct eo_stream *stream)
{
  pthread_mutex_lock(&stream->http->lock);
  stream->opened = true;
  pthread_mutex_unlock(&stream->http->lock);
}

static bool enlist(struct eo_http *http, struct eo_stream *stream)
{
  pthread_mutex_lock(&http->lock);
  bool room = !http->closing && http->stream_count < http->settings.limits.streams;
  if (room) {
    stream->after = http->streams;
    if (stream->after)
      stream->after->before = stream;
    http->streams = stream;
    http->stream_count++;
    append(stream, hello, sizeof hello - 1);
  }
  pthread_mutex_unlock(&http->lock);
  return room;
}

void eo_stream_open(struct eo_request *request, int64_t job, int64_t after)
{
  struct eo_error error;
  struct eo_stream *stream = calloc(1, sizeof *stream);
  if (!stream) {
    eo_reply_no_memory(&request->reply);
    return;
  }
  *stream = (struct eo_stream){.http = request->http, .connection = request->connection, .place = request->place};
  if (!enlist(request->http, stream)) {
    free(stream);
    eo_reply_problem(&request->reply, 503, NULL, "There are too many event streams.");
    request->reply.retry_after = EO_HEARTBEAT_SECONDS;
    return;
  }
  struct MHD_Response *response = MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, 16384, read_stream, stream,
                                                                    free_stream);
  if (!response) {
    free_stream(stream);
    eo_reply_no_memory(&request->reply);
    return;
  }
  if (eo_service_subscribe(request->http->service, job, after, take_event, stream, &stream->subscription, &error)) {
    MHD_destroy_response(response);
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  open_stream(stream);
  MHD_set_connection_option(request->connection, MHD_CONNECTION_OPTION_TIMEOUT, 0u);
  request->reply.status = 200;
  request->reply.type = "text/event-stream";
  request->reply.stream = response;
}

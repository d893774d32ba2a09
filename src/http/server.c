/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/http_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "format/json.h"
#include "http/address.h"
#include "http/background.h"
#include "http/connection.h"
#include "http/deferred.h"
#include "http/documents.h"
#include "http/framing.h"
#include "http/guard.h"
#include "http/log.h"
#include "http/request_log.h"
#include "http/pages.h"
#include "http/problem_page.h"
#include "http/routes.h"
#include "http/send.h"
#include "http/storage_watch.h"
#include "http/stream.h"
#include "http/ticker.h"
#include "http/upload.h"
#include "store/measurements.h"

#include <config.h>

static bool is_for_api(const char *path)
{
  size_t length = strlen(EO_API);
  return strncmp(path, EO_API, length) == 0 && (path[length] == '/' || !path[length]);
}

/* What can be said before the body is read; a reply is made when the answer is no. */
static void look_at(struct eo_request *request)
{
  if (!eo_framing_is_sound(request))
    return;
  if (!eo_field_path_is_plain(request->path))
    eo_reply_problem(&request->reply, 400, NULL, "The address is malformed.");
  else if (!is_for_api(request->path) && !(request->method & (EO_GET | EO_OPTIONS))) {
    eo_reply_problem(&request->reply, 405, NULL, "Pages can only be read.");
    request->reply.allow = EO_GET | EO_OPTIONS;
  } else if ((!is_for_api(request->path) || eo_route_find(request)) && eo_guard_admits(request) && request->route)
    eo_route_check_query(request);
}

static void look_at_body(struct eo_request *request)
{
  const char *length = eo_request_header(request, "Content-Length"), *type = eo_request_header(request, "Content-Type");
  const struct eo_route *route = request->route;
  int64_t size = 0;
  if (length && !eo_field_integer(length, &size))
    size = INT64_MAX;
  bool has_body = size > 0 || eo_request_header(request, "Transfer-Encoding");
  request->body_limit = !route        ? 0
                        : route->form ? (size_t)(1e6 * request->http->settings.limits.upload_MB)
                        : route->body ? route->body
                                      : EO_JSON_DESIGN_BYTES;
  if (has_body)
    eo_connection_allow(request->http, request->place, route && route->form ? EO_IDLE_SECONDS : EO_BODY_SECONDS);
  const char *expected = route && route->form ? "multipart/form-data" : "application/json";
  bool any = route && route->takes && strchr(route->takes, '/');
  if (!request->reply.status && has_body && route && route->takes && !any && type &&
      strncasecmp(type, expected, strlen(expected)) != 0)
    eo_reply_problem(&request->reply, 415, NULL, "The body must be %s.", expected);
  if (!request->reply.status && has_body && any && type && strncasecmp(type, "multipart/", 10) == 0)
    eo_reply_problem(&request->reply, 415, NULL, "The body must be the file itself, not the parts of a form.");
  if (!request->reply.status && (uint64_t)size > request->body_limit)
    eo_reply_problem(&request->reply, 413, NULL, "The body may have %zu bytes here.", request->body_limit);
  if (!request->reply.status && route && route->form)
    eo_upload_begin(request, size);
  /* A reply before the body costs the connection; a small body is read and thrown away instead. */
  request->reply.close = request->reply.close || (request->reply.status && size > EO_DRAINED);
}

static void count_active(struct eo_http *http, int change)
{
  pthread_mutex_lock(&http->lock);
  http->active += change;
  if (http->closing)
    pthread_cond_broadcast(&http->changed);
  pthread_mutex_unlock(&http->lock);
}

static enum MHD_Result begin(struct eo_http *http, struct MHD_Connection *connection, const char *path,
                             const char *method, void **context)
{
  struct eo_request *request = eo_request_new(http, connection, path, method);
  if (!request)
    return MHD_NO;
  *context = request;
  count_active(http, 1);
  eo_connection_allow(http, request->place, EO_IDLE_SECONDS);
  look_at(request);
  look_at_body(request);
  return request->reply.close ? eo_send_reply(request) : MHD_YES;
}

/* A body without a stated length is only known to be too long when it is; the library takes a reply then at its end and
   not before. */
static enum MHD_Result take(struct eo_request *request, const char *data, size_t size)
{
  request->received += size;
  if (request->received > request->body_limit + EO_DRAINED)
    return MHD_NO;
  if (request->upload) {
    eo_connection_allow(request->http, request->place, eo_upload_patience(request));
    if (request->reply.status && (request->refused += size) > EO_UPLOAD_DRAINED)
      return MHD_NO;
  }
  if (!request->reply.status && request->received > request->body_limit)
    eo_reply_problem(&request->reply, 413, NULL, "The body may have %zu bytes here.", request->body_limit);
  if (!request->reply.status && !request->upload && request->http->bodies + size > EO_MOST_BODIES)
    eo_reply_problem(&request->reply, 503, "busy", "Too much is being sent at once.");
  if (request->reply.status)
    return MHD_YES;
  if (request->upload)
    eo_upload_take(request, data, size);
  else {
    eo_text_add_bytes(&request->body, data, size);
    request->http->bodies += size;
    request->held += size;
  }
  return MHD_YES;
}

static void run_handler(struct eo_request *request)
{
  if (!eo_http_enter(request->http)) {
    eo_reply_problem(&request->reply, 503, "stopping", "The server is stopping.");
    request->reply.retry_after = 5;
    return;
  }
  if (!request->route) {
    if (!eo_problem_page_reply(request))
      eo_pages_reply(request->http->pages, request);
  } else if (eo_guard_spends(request, request->route->rate)) {
    if (request->route->aside || request->route->form)
      eo_background_take(request->route->form ? request->http->readings : request->http->aside, request);
    else
      eo_route_run(request);
  }
  eo_http_leave(request->http);
}

static void dispatch(struct eo_request *request)
{
  request->dispatched = true;
  eo_connection_allow(request->http, request->place, 0);
  if (!request->reply.status && (!request->upload || eo_upload_end(request)))
    run_handler(request);
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *path, const char *method,
                              const char *version, const char *data, size_t *size, void **place)
{
  struct eo_request *request = *place;
  (void)version;
  if (!request)
    return begin(context, connection, path, method, place);
  if (*size) {
    enum MHD_Result result = take(request, data, *size);
    *size = 0;
    return result;
  }
  if (!request->dispatched)
    dispatch(request);
  return eo_request_sleep(request) ? MHD_YES : eo_send_reply(request);
}

static void complete(void *context, struct MHD_Connection *connection, void **place,
                     enum MHD_RequestTerminationCode code)
{
  struct eo_http *http = context;
  struct eo_request *request = *place;
  (void)connection;
  (void)code;
  if (!request)
    return;
  eo_connection_allow(http, request->place, EO_IDLE_SECONDS);
  eo_log_request(request);
  http->bodies -= request->held;
  count_active(http, -1);
  eo_upload_free(request);
  eo_request_free(request);
  *place = NULL;
}

static enum eo_code check_access(const struct eo_http_settings *settings, struct eo_error *error)
{
  bool loopback;
  enum eo_code code = eo_listen_is_loopback(settings->listen, &loopback, error);
  bool token = settings->token && *settings->token;
  if (!code && token &&
      (!eo_field_is_visible(settings->token, EO_TOKEN_BYTES) || strlen(settings->token) < EO_LEAST_TOKEN))
    code = eo_error_set(error, EO_ERROR_INPUT, "",
                        "The token must be %d to %d printable characters without blanks, for instance what `openssl "
                        "rand -hex 20` prints.",
                        EO_LEAST_TOKEN, EO_TOKEN_BYTES - 1);
  if (!code && !loopback && !token && !settings->allow_anyone)
    code = eo_error_set(
        error, EO_ERROR_INPUT, "",
        "Others can reach %.60s: give a token (--token-file FILE or EASEOFF_TOKEN), or say --allow-anyone.",
        settings->listen);
  return code;
}

/* As many connections as there are descriptors for, with some left for files. */
static unsigned allow_descriptors(void)
{
  enum { FOR_FILES = 128 };
  struct rlimit limit;
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
    return 256;
  rlim_t wanted = EO_MOST_CONNECTIONS + FOR_FILES;
  if (limit.rlim_cur < wanted) {
    limit.rlim_cur = limit.rlim_max < wanted ? limit.rlim_max : wanted;
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  return limit.rlim_cur > 2 * FOR_FILES
             ? (unsigned)(limit.rlim_cur < wanted ? limit.rlim_cur - FOR_FILES : EO_MOST_CONNECTIONS)
             : FOR_FILES;
}

static void ignore_messages(void *context, const char *format, va_list arguments)
{
  (void)context; /* the library complains about every client that breaks off */
  (void)format;
  (void)arguments;
}

/* A proxy is one address for the library: how many connections it may have is for the proxy to say. */
static unsigned find_most_of_one(const struct eo_http *http, unsigned most)
{
  unsigned of_one = (unsigned)http->settings.limits.connections_per_client;
  return http->proxies.count || most < of_one ? most : of_one;
}

static enum eo_code start_daemon(struct eo_http *http, bool version6, struct eo_error *error)
{
  unsigned most = allow_descriptors();
  http->daemon = MHD_start_daemon(
      MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ERROR_LOG | (version6 ? MHD_USE_IPv6 : 0u), 0,
      NULL, NULL, handle, http, MHD_OPTION_EXTERNAL_LOGGER, ignore_messages, NULL, MHD_OPTION_LISTEN_SOCKET,
      http->socket, MHD_OPTION_NOTIFY_COMPLETED, complete, http, MHD_OPTION_NOTIFY_CONNECTION, eo_connection_notify,
      http, MHD_OPTION_CONNECTION_LIMIT, most, MHD_OPTION_PER_IP_CONNECTION_LIMIT, find_most_of_one(http, most),
      MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)EO_IDLE_SECONDS, MHD_OPTION_STRICT_FOR_CLIENT, 1,
      MHD_OPTION_UNESCAPE_CALLBACK, eo_framing_unescape, NULL, MHD_OPTION_END);
  if (!http->daemon)
    return eo_error_set(error, EO_ERROR_MEMORY, "", "The HTTP server cannot be started.");
  return EO_OK;
}

static void init(struct eo_http *http, const struct eo_http_settings *settings)
{
  pthread_condattr_t attributes;
  *http = (struct eo_http){.settings = *settings,
                           .routes = eo_routes,
                           .socket = -1,
                           .service = settings->service,
                           .started = eo_clock_milliseconds()};
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_mutex_init(&http->lock, NULL);
  pthread_cond_init(&http->changed, &attributes);
  pthread_condattr_destroy(&attributes);
  if (getrandom(&http->run, sizeof http->run, 0) != sizeof http->run)
    http->run = (uint64_t)time(NULL);
}

static void done(struct eo_http *http)
{
  eo_service_tell(http->service, NULL, NULL);
  eo_background_free(http->aside);
  eo_background_free(http->readings);
  eo_storage_watch_free(http->storage);
  eo_pages_free(http->pages);
  eo_documents_free(http->documents);
  eo_store_close(http->store);
  eo_log_free(http->log);
  if (http->socket >= 0)
    close(http->socket);
  pthread_cond_destroy(&http->changed);
  pthread_mutex_destroy(&http->lock);
  free(http->guard);
  free(http);
}

static enum eo_code tidy(struct eo_http *http, struct eo_error *error)
{
  int aside = 0;
  enum eo_code code = eo_measurement_folder_tidy(http->store, &aside, error);
  if (!code && aside)
    snprintf(http->notice, sizeof http->notice,
             "%d recording%s without a row in the database %s set aside in %.200s/measurements/lost+found.", aside,
             aside == 1 ? "" : "s", aside == 1 ? "was" : "were", http->settings.data);
  return code;
}

static enum eo_code open_all(struct eo_http *http, struct eo_error *error)
{
  const struct eo_http_settings *settings = &http->settings;
  EO_TRY(check_access(settings, error));
  EO_TRY(eo_log_new(&http->log, settings->quiet ? EO_LOG_ERROR : (enum eo_log_level)settings->limits.log_level, error));
  EO_TRY(eo_proxies_read(&http->proxies, settings->limits.trusted_proxies, error));
  EO_TRY(eo_guard_new(&http->guard, settings, error));
  EO_TRY(eo_store_open(&http->store, settings->data, EO_STORE_WRITE, error));
  eo_store_wait(http->store, EO_LOCK_MS);
  EO_TRY(tidy(http, error));
  EO_TRY(eo_storage_watch_new(&http->storage, settings->data, 1e6 * settings->limits.spare_MB, error));
  EO_TRY(eo_background_new(&http->aside, settings->data, 1, error));
  EO_TRY(eo_background_new(&http->readings, settings->data, EO_READERS, error));
  EO_TRY(eo_pages_new(&http->pages, settings->pages, error));
  return eo_documents_new(&http->documents, http->routes, &http->settings.limits, eo_service_limits_of(http->service),
                          error);
}

static void log_job(void *context, int64_t job, const char *kind, const char *what, const char *detail)
{
  struct eo_http *http = context;
  enum eo_log_level level = strcmp(what, "failed") == 0 ? EO_LOG_WARNING : EO_LOG_INFO;
  eo_log_event(http->log, level, "job", "%s %lld: %s%s%s", kind, (long long)job, what, *detail ? ": " : "", detail);
}

static enum eo_code start(struct eo_http *http, struct eo_error *error)
{
  struct eo_listening listening;
  EO_TRY(open_all(http, error));
  EO_TRY(eo_listen(&listening, http->settings.listen, error));
  http->socket = listening.socket;
  snprintf(http->url, sizeof http->url, "%s", listening.url);
  EO_TRY(eo_ticker_start(http, error));
  eo_service_tell(http->service, log_job, http);
  eo_log_event(http->log, EO_LOG_INFO, "start", "%s at %s, data in %.300s", PACKAGE_STRING, http->url,
               http->settings.data);
  enum eo_code code = start_daemon(http, listening.version6, error);
  if (code) {
    eo_http_quiesce(http);
    eo_ticker_stop(http);
  }
  return code;
}

enum eo_code eo_http_start(struct eo_http **http, const struct eo_http_settings *settings, struct eo_error *error)
{
  struct eo_http *made = malloc(sizeof *made);
  if (!made)
    return eo_error_memory(error);
  init(made, settings);
  enum eo_code code = start(made, error);
  if (code)
    done(made);
  else
    *http = made;
  return code;
}

const char *eo_http_url(const struct eo_http *http)
{
  return http->url;
}

const char *eo_http_notice(const struct eo_http *http)
{
  return http->notice;
}

void eo_http_quiesce(struct eo_http *http)
{
  if (http->daemon)
    MHD_quiesce_daemon(http->daemon);
  pthread_mutex_lock(&http->lock);
  http->closing = true;
  eo_streams_end(http);
  pthread_cond_broadcast(&http->changed);
  pthread_mutex_unlock(&http->lock);
}

/* Everything that was asked has its reply; now it has to get there. */
static void let_replies_go(struct eo_http *http)
{
  struct timespec limit;
  clock_gettime(CLOCK_MONOTONIC, &limit);
  limit.tv_sec += EO_PARTING_SECONDS;
  while (http->active > 0 && pthread_cond_timedwait(&http->changed, &http->lock, &limit) == 0)
    ;
}

/* The library aborts the process when it stops while a connection sleeps: every request has to be finished and every
   stream ended first. */
void eo_http_stop(struct eo_http *http)
{
  if (!http)
    return;
  pthread_mutex_lock(&http->lock);
  while (http->deferred > 0)
    pthread_cond_wait(&http->changed, &http->lock);
  let_replies_go(http);
  pthread_mutex_unlock(&http->lock);
  eo_ticker_stop(http);
  eo_log_event(http->log, EO_LOG_INFO, "stop", "every request has its answer");
  MHD_stop_daemon(http->daemon);
  done(http);
}

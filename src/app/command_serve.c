/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "app/app.h"
#include "app/data.h"
#include "app/serve_settings.h"
#include "http/http.h"

#include <config.h>

struct request {
  struct eo_serve_settings settings;
  struct eo_text token, directory, cache;
};

/* NULL in the place of what was not said. */
static const char *or_null(const char *text)
{
  return *text ? text : NULL;
}

static enum eo_code read_token(struct request *request, struct eo_error *error)
{
  enum { LIMIT = 4096 };
  char *variable = getenv("EASEOFF_TOKEN");
  if (!*request->settings.token_file) {
    eo_text_add(&request->token, variable ? variable : "");
    if (variable)
      explicit_bzero(variable, strlen(variable)); /* /proc/PID/environ shows what stands there */
    return request->token.failed ? eo_error_memory(error) : EO_OK;
  }
  enum eo_code code = eo_text_read(&request->token, request->settings.token_file, LIMIT, error);
  if (!code && request->token.data)
    request->token.data[strcspn(request->token.data, "\r\n")] = '\0';
  if (!code && (!request->token.data || !*request->token.data))
    code = eo_error_set(error, EO_ERROR_INPUT, "", "The token file is empty.");
  return code;
}

static bool is_folder(const char *path)
{
  struct stat status;
  return path && *path && stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* --web, $EASEOFF_WEB, or where the page is installed; NULL: the API alone. */
static const char *find_pages(const struct request *request)
{
  const char *variable = getenv("EASEOFF_WEB");
  if (*request->settings.web)
    return request->settings.web;
  if (variable && *variable)
    return variable;
  return is_folder(PKGDATADIR "/web") ? PKGDATADIR "/web" : NULL;
}

/* Those that end the server are blocked in every thread from here on and taken by sigwait() alone: SIGHUP too, which is
   a terminal that was closed. Those that mean nothing here would end it at once; a file that grows beyond a limit
   (SIGXFSZ) is an error of whoever writes it. */
static void block_signals(sigset_t *signals)
{
  static const int ends[] = {SIGINT, SIGTERM, SIGHUP},
                   means_nothing[] = {SIGPIPE, SIGUSR1, SIGUSR2, SIGXFSZ, SIGALRM, SIGVTALRM, SIGPROF, SIGIO};
  sigemptyset(signals);
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    struct sigaction action;
    if (ends[i] != SIGHUP || sigaction(SIGHUP, NULL, &action) || action.sa_handler != SIG_IGN) /* nohup */
      sigaddset(signals, ends[i]);
  }
  pthread_sigmask(SIG_BLOCK, signals, NULL);
  for (size_t i = 0; i < sizeof means_nothing / sizeof means_nothing[0]; i++)
    signal(means_nothing[i], SIG_IGN);
}

/* Tells a service manager that waits for it that requests are answered (sd_notify(3): a datagram to $NOTIFY_SOCKET);
   without one, or when it does not listen, nothing is lost. */
static void tell_manager(void)
{
  static const char ready[] = "READY=1";
  const char *path = getenv("NOTIFY_SOCKET");
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  size_t length = path ? strlen(path) : 0;
  if (length < 2 || length >= sizeof address.sun_path || (path[0] != '/' && path[0] != '@'))
    return;
  memcpy(address.sun_path, path, length);
  if (path[0] == '@')
    address.sun_path[0] = '\0'; /* no file: a name of the kernel's */
  int manager = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (manager < 0)
    return;
  sendto(manager, ready, sizeof ready - 1, MSG_NOSIGNAL, (struct sockaddr *)&address,
         (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length));
  close(manager);
}

static void serve_until_told(struct eo_http *http, struct eo_service *service, const sigset_t *signals)
{
  int signal;
  printf("%s: %s\n", PACKAGE_NAME, eo_http_url(http));
  fflush(stdout);
  if (*eo_http_notice(http))
    fprintf(stderr, "%s: %s\n", PACKAGE_NAME, eo_http_notice(http));
  tell_manager();
  sigwait(signals, &signal);
  eo_http_quiesce(http);
  eo_service_stop(service);
  eo_http_stop(http);
}

static enum eo_code serve(struct request *request, struct eo_error *error)
{
  sigset_t signals;
  struct eo_service *service = NULL;
  struct eo_http *http = NULL;
  const struct eo_serve_settings *own = &request->settings;
  struct eo_service_settings settings = {.data = request->directory.data,
                                         .cache = request->cache.data,
                                         .program = "/proc/self/exe",
                                         .launcher = own->launcher,
                                         .threads = own->threads,
                                         .limits = own->work};
  block_signals(&signals);
  enum eo_code code = eo_service_new(&service, &settings, error);
  struct eo_http_settings web = {.listen = own->listen,
                                 .token = request->token.data,
                                 .allow_anyone = own->allow_anyone,
                                 .host = {or_null(own->host)},
                                 .pages = find_pages(request),
                                 .data = request->directory.data,
                                 .quiet = own->quiet,
                                 .limits = own->limits,
                                 .service = service};
  if (!code)
    code = eo_http_start(&http, &web, error);
  if (request->token.data) /* its hash is all that is needed from here on */
    explicit_bzero(request->token.data, request->token.size);
  if (!code)
    serve_until_told(http, service, &signals);
  eo_service_free(service);
  return code;
}

static int run_request(struct request *request)
{
  struct eo_error error;
  enum eo_code code = read_token(request, &error);
  if (!code)
    code = eo_app_data_directory(or_null(request->settings.data), &request->directory, &error);
  if (!code) {
    if (!eo_app_cache_directory(or_null(request->settings.data), &request->cache))
      eo_text_print(&request->cache, "%s/flexibility", request->directory.data);
    code = serve(request, &error);
  }
  eo_text_done(&request->token);
  eo_text_done(&request->directory);
  eo_text_done(&request->cache);
  return code ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  if (eo_serve_settings_read(command, argc, argv, &request->settings, &status))
    status = run_request(request);
  free(request);
  return status;
}

const struct eo_command eo_command_serve = {
    "serve",
    "[--config FILE] [--listen ADDRESS:PORT] [--data DIR] [--token-file FILE | "
    "--allow-anyone] [--host NAME] [--web DIR] [--threads N] [--launcher COMMAND] [--quiet] [--KEY VALUE ...]",
    "the page and the API, until SIGTERM or Ctrl-C",
    "Prints its address on standard output; requests, jobs and errors go to standard error as JSON lines (with "
    "--quiet\n"
    "errors only). The page's files are read from --web DIR, else from $EASEOFF_WEB, else from where they were "
    "installed.\n"
    "\n"
    "An address that others can reach needs a token, which every client has to give: the first line of --token-file, "
    "or\n"
    "$EASEOFF_TOKEN. With --allow-anyone the server asks for none. --host names the server as clients call it; it is\n"
    "needed when there is no token and that name is neither localhost nor a plain address.\n"
    "\n" EO_APP_HISTORY_HELP EO_APP_DATA_HELP "\n"
    "--launcher \"mpirun -n 64 --hostfile F\" (or srun, or a script) runs all jobs except preparations: the server "
    "starts\n"
    "that command with easeoff optimize|study|tolerance --work N --data DIR behind it, on the same data folder.\n"
    "\n"
    "Where systemd starts the server as a service of Type=notify, the server tells it (through $NOTIFY_SOCKET) when "
    "it\n"
    "answers requests. SIGTERM, SIGHUP and Ctrl-C stop running jobs; they go on when the server starts again.\n"
    "\n"
    "Keys of --config FILE (JSON). Each is an option too, with dashes in place of underscores: \"queued_jobs\" is\n"
    "--queued-jobs N.\n",
    run};

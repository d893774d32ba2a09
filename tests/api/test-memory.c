/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A server with less memory than it wants: it says so and does not start, or it answers whatever it is asked and stops
   when told. OpenBLAS asks for its room again and again when there is none, so nothing may be left for it to ask. */
#include "api/client.h"
#include "base/sanitized.h"
#include "support/tap.h"

#include <sys/resource.h>

#ifdef EO_SANITIZED
static const bool shadowed = true; /* a sanitizer takes terabytes of addresses */
#else
static const bool shadowed = false;
#endif

static char *coarse;

static void allow(rlim_t megabytes)
{
  struct rlimit limit;
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = megabytes ? megabytes << 20 : limit.rlim_max;
  setrlimit(RLIMIT_AS, &limit);
}

/* Every status is an answer; 0 is none. */
static void ask(rlim_t megabytes)
{
  struct reply reply = call("POST", API "/analyze", "Prefer: wait=20\r\n", coarse);
  ok(reply.status == 200 || reply.status == 202 || reply.status == 503, "%ld MB: an analysis is answered with %d",
     (long)megabytes, reply.status);
  free_reply(&reply);
  reply = call("POST", API "/measurements", "Content-Type: multipart/form-data; boundary=xx\r\n",
               "--xx\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a.csv\"\r\n\r\n"
               "t_s,a_deg,b_deg\r\n0,0,0\r\n1,10,4\r\n2,20,8\r\n\r\n--xx--\r\n");
  ok(reply.status >= 400, "%ld MB: an upload of nothing is refused with %d", (long)megabytes, reply.status);
  free_reply(&reply);
}

/* Whether it has started. */
static bool try_with(rlim_t megabytes)
{
  int status = 0;
  double begun = seconds_now();
  allow(megabytes);
  bool started = start_server("--quiet", "--threads", "2");
  allow(0);
  if (!started) {
    waitpid(server.pid, &status, 0);
    ok(WIFEXITED(status) && WEXITSTATUS(status) && WEXITSTATUS(status) < 100 && seconds_now() - begun < 60,
       "%ld MB are refused: %d", (long)megabytes, status);
    return false;
  }
  ask(megabytes);
  ok(stop_server(SIGTERM) == 0, "%ld MB: the server stops when told", (long)megabytes);
  return true;
}

int main(void)
{
  static const rlim_t tried[] = {200, 1000, 2000, 2800, 3600, 8000};
  bool started = false;
  if (shadowed) {
    printf("1..0 # SKIP a sanitizer's addresses\n");
    return 0;
  }
  coarse = coarse_text();
  if (!make_data_folder() || !ok(start_server("--quiet", "--threads", "2"), "the server starts"))
    return 1;
  struct reply reply = call("POST", API "/analyze", "Prefer: wait=60\r\n", coarse);
  ok(reply.status == 200, "a pair is prepared, answer %d", reply.status);
  free_reply(&reply);
  ok(stop_server(SIGTERM) == 0, "the server stops when told");
  for (size_t i = 0; i < sizeof tried / sizeof tried[0]; i++)
    started = try_with(tried[i]);
  ok(started, "8 GB of addresses are enough for two threads");
  remove_data_folder();
  free(coarse);
  return tap_done();
}

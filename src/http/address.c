/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/address.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "http/header_field.h"

struct place {
  struct sockaddr_storage address;
  socklen_t size;
  bool loopback, version6;
};

static bool read_host(const char *host, int port, struct place *place)
{
  struct sockaddr_in *four = (struct sockaddr_in *)&place->address;
  struct sockaddr_in6 *six = (struct sockaddr_in6 *)&place->address;
  memset(place, 0, sizeof *place);
  if (strcmp(host, "localhost") == 0)
    host = "127.0.0.1";
  if (inet_pton(AF_INET, host, &four->sin_addr) == 1) {
    four->sin_family = AF_INET;
    four->sin_port = htons((uint16_t)port);
    place->size = sizeof *four;
    place->loopback = ntohl(four->sin_addr.s_addr) >> 24 == 127;
  } else if (inet_pton(AF_INET6, host, &six->sin6_addr) == 1) {
    six->sin6_family = AF_INET6;
    six->sin6_port = htons((uint16_t)port);
    place->size = sizeof *six;
    place->loopback = IN6_IS_ADDR_LOOPBACK(&six->sin6_addr);
    place->version6 = true;
  }
  return place->size > 0;
}

static enum eo_code read_address(const char *text, struct place *place, struct eo_error *error)
{
  char host[64];
  const char *colon = strrchr(text, ':');
  int64_t port;
  if (colon && eo_field_host(text, host, sizeof host) && eo_field_integer(colon + 1, &port) && port >= 0 &&
      port <= 65535 && read_host(host, (int)port, place))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "--listen %.60s is not an address with a port, for instance 127.0.0.1:8080 or [::1]:8080.", text);
}

enum eo_code eo_listen_is_loopback(const char *address, bool *loopback, struct eo_error *error)
{
  struct place place;
  enum eo_code code = read_address(address, &place, error);
  *loopback = !code && place.loopback;
  return code;
}

static void write_url(const struct place *place, int taken, struct eo_listening *listening)
{
  struct sockaddr_storage address;
  socklen_t size = sizeof address;
  char host[INET6_ADDRSTRLEN] = "";
  getsockname(taken, (struct sockaddr *)&address, &size);
  const struct sockaddr_in *four = (const struct sockaddr_in *)&address;
  const struct sockaddr_in6 *six = (const struct sockaddr_in6 *)&address;
  inet_ntop(address.ss_family, place->version6 ? (const void *)&six->sin6_addr : (const void *)&four->sin_addr, host,
            sizeof host);
  snprintf(listening->url, sizeof listening->url, place->version6 ? "http://[%s]:%d/" : "http://%s:%d/", host,
           ntohs(place->version6 ? six->sin6_port : four->sin_port));
}

enum eo_code eo_listen(struct eo_listening *listening, const char *address, struct eo_error *error)
{
  enum { BACKLOG = 1024 };
  struct place place;
  const int on = 1;
  enum eo_code code = read_address(address, &place, error);
  if (code)
    return code;
  int taken = socket(place.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (taken >= 0)
    setsockopt(taken, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (taken < 0 || bind(taken, (struct sockaddr *)&place.address, place.size) != 0 || listen(taken, BACKLOG) != 0) {
    code = eo_error_set(error, EO_ERROR_FILE, "", "Nothing can listen at %.60s: %s.", address, strerror(errno));
    if (taken >= 0)
      close(taken);
    return code;
  }
  *listening = (struct eo_listening){.socket = taken, .loopback = place.loopback, .version6 = place.version6};
  write_url(&place, taken, listening);
  return EO_OK;
}

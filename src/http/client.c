/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "http/header_field.h"

enum { ADDRESS_BITS = 128, BEFORE_V4 = 96 /* bits of ::ffff:0:0 */ };

static void map_v4(const struct in_addr *from, unsigned char address[16])
{
  memset(address, 0, 10);
  memset(address + 10, 0xff, 2);
  memcpy(address + 12, from, 4);
}

static bool is_v4(const unsigned char address[16])
{
  static const unsigned char before[12] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
  return memcmp(address, before, sizeof before) == 0;
}

/* "1.2.3.4", "::1", with a port or brackets as proxies write them. */
static bool read_address(const char *text, unsigned char address[16])
{
  char host[64];
  struct in_addr four;
  if (inet_pton(AF_INET6, text, address) == 1)
    return true;
  if (!eo_field_host(text, host, sizeof host))
    return false;
  if (inet_pton(AF_INET, host, &four) == 1) {
    map_v4(&four, address);
    return true;
  }
  return inet_pton(AF_INET6, host, address) == 1;
}

static bool read_network(char *text, struct eo_network *network)
{
  char *slash = strchr(text, '/');
  int64_t bits = -1;
  if (slash)
    *slash = '\0';
  if (!read_address(text, network->address) || (slash && !eo_field_integer(slash + 1, &bits)))
    return false;
  int before = is_v4(network->address) ? BEFORE_V4 : 0;
  if (slash && (bits < 0 || bits > ADDRESS_BITS - before))
    return false;
  network->bits = slash ? before + (int)bits : ADDRESS_BITS;
  return true;
}

/* Copies the next entry of a list without the blanks around it; false at the end, or when it is too long to be one. */
static bool next_entry(const char **list, char *entry, size_t size)
{
  *list += strspn(*list, ", \t");
  size_t length = strcspn(*list, ", \t");
  if (!length || length >= size)
    return false;
  memcpy(entry, *list, length);
  entry[length] = '\0';
  *list += length;
  return true;
}

enum eo_code eo_proxies_read(struct eo_proxies *proxies, const char *list, struct eo_error *error)
{
  char entry[64];
  *proxies = (struct eo_proxies){0};
  while (next_entry(&list, entry, sizeof entry)) {
    char shown[64];
    snprintf(shown, sizeof shown, "%s", entry);
    if (proxies->count == EO_PROXIES || !read_network(entry, &proxies->network[proxies->count]))
      return eo_error_set(error, EO_ERROR_INPUT, "/trusted_proxies",
                          "%s is no address and no network, or there are more than %d.", shown, EO_PROXIES);
    proxies->count++;
  }
  return *list ? eo_error_set(error, EO_ERROR_INPUT, "/trusted_proxies", "An entry is too long to be an address.")
               : EO_OK;
}

static bool is_in(const struct eo_network *network, const unsigned char address[16])
{
  int whole = network->bits / 8, rest = network->bits % 8;
  unsigned mask = rest ? 0xffu << (8 - rest) & 0xffu : 0;
  return memcmp(network->address, address, (size_t)whole) == 0 &&
         (!rest || ((network->address[whole] ^ address[whole]) & mask) == 0);
}

static bool is_trusted(const struct eo_proxies *proxies, const unsigned char address[16])
{
  for (int i = 0; i < proxies->count; i++)
    if (is_in(&proxies->network[i], address))
      return true;
  return false;
}

static void peer_address(const struct sockaddr_storage *peer, unsigned char address[16])
{
  memset(address, 0, 16);
  if (peer->ss_family == AF_INET)
    map_v4(&((const struct sockaddr_in *)peer)->sin_addr, address);
  else if (peer->ss_family == AF_INET6)
    memcpy(address, &((const struct sockaddr_in6 *)peer)->sin6_addr, 16);
}

/* The last entry of list[0..*length), which is then shorter; false: there is none, or it is no address. */
static bool last_address(const char *list, size_t *length, unsigned char address[16])
{
  char entry[64];
  size_t end = *length;
  while (end && strchr(", \t", list[end - 1]))
    end--;
  size_t start = end;
  while (start && !strchr(", \t", list[start - 1]))
    start--;
  *length = start;
  if (end == start || end - start >= sizeof entry)
    return false;
  memcpy(entry, list + start, end - start);
  entry[end - start] = '\0';
  return read_address(entry, address);
}

struct eo_client eo_client_of(const struct eo_proxies *proxies, const struct sockaddr_storage *peer,
                              const char *forwarded, const char *protocol)
{
  struct eo_client client = {0};
  unsigned char address[16], further[16];
  size_t length = forwarded ? strlen(forwarded) : 0;
  peer_address(peer, address);
  if (is_trusted(proxies, address)) {
    client.secure = protocol && strcasecmp(protocol, "https") == 0;
    while (is_trusted(proxies, address) && last_address(forwarded ? forwarded : "", &length, further))
      memcpy(address, further, sizeof address);
  }
  bool four = is_v4(address);
  inet_ntop(four ? AF_INET : AF_INET6, four ? address + 12 : address, client.text, sizeof client.text);
  memcpy(client.key, address, four ? 16 : 8);
  return client;
}

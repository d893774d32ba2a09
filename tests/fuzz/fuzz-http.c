/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a client sends, piece by piece: the first byte says which reader gets the rest. For libFuzzer, and replayed by
   replay.c. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "format/json.h"
#include "document/sweep_document.h"
#include "fuzz/fuzz.h"
#include "http/client.h"
#include "http/framing.h"
#include "http/header_field.h"
#include "service/preparation_line.h"

static void read_design(const char *text, size_t size)
{
  static struct eo_faults faults;
  static struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings = {0};
  struct eo_error error;
  json_t *document = eo_json_parse(text, size, &error);
  faults.count = 0;
  if (document && eo_design_decode(document, &design, &warnings, &faults) &&
      eo_design_complete(&design, &geometry, &error) == EO_OK) {
    json_t *back = eo_design_encode(&design);
    if (!back)
      abort();
    json_decref(back);
  }
  json_decref(document);
}

static void read_sweep(const char *text, size_t size)
{
  static struct eo_faults faults;
  struct eo_sweep_request request;
  struct eo_sweep_axes axes = {0};
  struct eo_error error;
  json_t *document = eo_json_parse(text, size, &error);
  faults.count = 0;
  if (document)
    eo_table_decode(&eo_sweep_request_table, document, NULL, &request, &faults);
  if (document && !faults.count && eo_sweep_axes_init(&axes, &request, &error) == EO_OK)
    eo_sweep_axes_done(&axes);
  json_decref(document);
}

static void read_fields(const char *text)
{
  char host[80], cookie[80], argument[2][64];
  int64_t whole;
  double real;
  eo_field_integer(text, &whole);
  eo_field_real(text, &real);
  eo_field_is_visible(text, 65);
  eo_field_accepts_coding(text, "gzip");
  eo_field_prefers_type(text, "text/csv");
  eo_field_lists_tag(text, "1.1", true);
  eo_field_lists_tag(text, "1.1", false);
  eo_field_equal_secret(text, "sesame");
  eo_field_path_is_plain(text);
  if (eo_field_wait(text) < 0 || eo_field_wait(text) > 60)
    abort();
  if (eo_field_host(text, host, sizeof host))
    eo_field_host_is_address(host);
  if (eo_field_cookie(text, "easeoff_session", cookie, sizeof cookie) && strlen(cookie) >= sizeof cookie)
    abort();
  eo_field_match("/jobs/{id}/events", text, sizeof argument[0], argument, 2);
  eo_field_match("/export/{format}.csv", text, sizeof argument[0], argument, 2);
}

/* Lists of proxies, what they say of clients, paths with %XX, lines of a process. */
static void read_lists(char *text)
{
  struct eo_proxies proxies;
  struct eo_preparation_line line;
  const struct sockaddr_storage peer = {.ss_family = AF_INET};
  if (eo_proxies_read(&proxies, text, NULL) == EO_OK && proxies.count > EO_PROXIES)
    abort();
  eo_proxies_read(&proxies, "0.0.0.0/0, ::/0", NULL);
  struct eo_client client = eo_client_of(&proxies, &peer, text, text);
  if (strlen(client.text) >= sizeof client.text)
    abort();
  eo_preparation_line_read(text, &line);
  size_t length = strlen(text);
  if (eo_framing_unescape(NULL, NULL, text) > length || strlen(text) > length)
    abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  if (!size)
    return 0;
  char *text = malloc(size);
  if (!text)
    return 0;
  memcpy(text, data + 1, size - 1);
  text[size - 1] = '\0';
  if (data[0] == 'd')
    read_design(text, size - 1);
  else if (data[0] == 's')
    read_sweep(text, size - 1);
  else if (data[0] == 'l')
    read_lists(text);
  else
    read_fields(text);
  free(text);
  return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page.h"

#include <string.h>

#include "format/inch_sentence.h"
#include "format/json.h"
#include "format/plot.h"

static const char style[] =
    "body{font:13px/1.45 sans-serif;color:#111;max-width:1000px;margin:2em auto;padding:0 1em}"
    "h1{font-size:22px;margin-bottom:0}h2{font-size:17px;margin-top:2em;border-bottom:1px solid #999}"
    "h3{font-size:14px;margin:1.4em 0 .3em}h4{font-size:13px;margin:1em 0 .2em}"
    "table{border-collapse:collapse;margin:.4em 0 1em;width:100%}"
    "th,td{border-bottom:1px solid #ddd;padding:2px 8px 2px 0;text-align:left;vertical-align:top}"
    "td.n,th.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}"
    "td:first-child,th:first-child{width:30%}code{font:11px monospace}"
    ".yes{color:#06603a;font-weight:bold}.no{color:#a11212;font-weight:bold}"
    ".hash{font:11px monospace;color:#444;overflow-wrap:anywhere}.assumed{color:#8a4b00}"
    "svg{width:100%;max-width:760px;height:auto;display:block;margin:.6em 0}"
    "@page{margin:15mm}@media print{body{margin:0;max-width:none}h2,h3,h4{break-after:avoid}"
    "svg,tr{break-inside:avoid}}";

void eo_page_begin(const struct eo_page *page, const char *title)
{
  eo_text_add(page->text, "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                          "<meta name=\"viewport\" content=\"width=device-width\"><title>");
  eo_text_add_escaped(page->text, title);
  eo_text_print(page->text, "</title><style>%s</style></head><body>\n", style);
}

void eo_page_end(const struct eo_page *page)
{
  eo_text_add(page->text, "</body></html>\n");
}

const char *eo_page_key(const struct eo_page *page, const char *key, char spelt[EO_INCH_KEY])
{
  return page->inches && eo_inch_key(key, strlen(key), spelt) ? spelt : key;
}

const char *eo_page_unit(const struct eo_page *page, const struct eo_unit *unit)
{
  if (page->inches && (unit == &eo_unit_mm || unit == &eo_unit_um))
    return unit == &eo_unit_mm ? "in" : "thou";
  return unit ? unit->symbol : "";
}

const json_t *eo_page_member(const struct eo_page *page, const json_t *object, const char *key)
{
  char spelt[EO_INCH_KEY];
  return json_object_get(object, eo_page_key(page, key, spelt));
}

const json_t *eo_page_find(const struct eo_page *page, const json_t *value, const char *path)
{
  char spelt[EO_INCH_KEY];
  return eo_json_find(value, eo_page_key(page, path, spelt));
}

void eo_page_say(const struct eo_page *page, const char *sentence)
{
  struct eo_text spelt = {0};
  if (page->inches)
    eo_inch_sentence(&spelt, sentence);
  page->text->failed = page->text->failed || spelt.failed;
  eo_text_add_escaped(page->text, spelt.data ? spelt.data : sentence);
  eo_text_done(&spelt);
}

void eo_page_heading(const struct eo_page *page, int level, const char *heading)
{
  eo_text_print(page->text, "<h%d>", level);
  eo_page_say(page, heading);
  eo_text_print(page->text, "</h%d>\n", level);
}

void eo_page_paragraph(const struct eo_page *page, const char *paragraph)
{
  eo_text_add(page->text, "<p>");
  eo_page_say(page, paragraph);
  eo_text_add(page->text, "</p>\n");
}

void eo_page_list(const struct eo_page *page, const json_t *array)
{
  if (!json_array_size(array))
    return;
  eo_text_add(page->text, "<ul>");
  for (size_t i = 0; i < json_array_size(array); i++) {
    eo_text_add(page->text, "<li>");
    const char *sentence = json_string_value(json_array_get(array, i));
    eo_page_say(page, sentence ? sentence : "");
    eo_text_add(page->text, "</li>");
  }
  eo_text_add(page->text, "</ul>\n");
}

void eo_page_value(const struct eo_page *page, const json_t *value)
{
  switch (value ? json_typeof(value) : JSON_NULL) {
  case JSON_STRING:
    eo_text_add_escaped(page->text, json_string_value(value));
    break;
  case JSON_INTEGER:
  case JSON_REAL:
    eo_text_print(page->text, "%.6g", json_number_value(value));
    break;
  case JSON_TRUE:
    eo_text_add(page->text, "yes");
    break;
  case JSON_FALSE:
    eo_text_add(page->text, "no");
    break;
  case JSON_ARRAY:
    for (size_t i = 0; i < json_array_size(value); i++) {
      eo_text_add(page->text, i ? ", " : "");
      eo_page_value(page, json_array_get(value, i));
    }
    break;
  default:
    eo_text_add(page->text, "&ndash;");
    break;
  }
}

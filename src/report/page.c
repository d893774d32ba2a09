/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page.h"

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

void eo_page_begin(struct eo_text *text, const char *title)
{
  eo_text_add(text, "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                    "<meta name=\"viewport\" content=\"width=device-width\"><title>");
  eo_plot_escape(text, title);
  eo_text_print(text, "</title><style>%s</style></head><body>\n", style);
}

void eo_page_end(struct eo_text *text)
{
  eo_text_add(text, "</body></html>\n");
}

void eo_page_heading(struct eo_text *text, int level, const char *heading)
{
  eo_text_print(text, "<h%d>", level);
  eo_plot_escape(text, heading);
  eo_text_print(text, "</h%d>\n", level);
}

void eo_page_paragraph(struct eo_text *text, const char *paragraph)
{
  eo_text_add(text, "<p>");
  eo_plot_escape(text, paragraph);
  eo_text_add(text, "</p>\n");
}

void eo_page_list(struct eo_text *text, const json_t *array)
{
  if (!json_array_size(array))
    return;
  eo_text_add(text, "<ul>");
  for (size_t i = 0; i < json_array_size(array); i++) {
    eo_text_add(text, "<li>");
    eo_page_value(text, json_array_get(array, i));
    eo_text_add(text, "</li>");
  }
  eo_text_add(text, "</ul>\n");
}

void eo_page_value(struct eo_text *text, const json_t *value)
{
  switch (value ? json_typeof(value) : JSON_NULL) {
  case JSON_STRING:
    eo_plot_escape(text, json_string_value(value));
    break;
  case JSON_INTEGER:
  case JSON_REAL:
    eo_text_print(text, "%.6g", json_number_value(value));
    break;
  case JSON_TRUE:
    eo_text_add(text, "yes");
    break;
  case JSON_FALSE:
    eo_text_add(text, "no");
    break;
  case JSON_ARRAY:
    for (size_t i = 0; i < json_array_size(value); i++) {
      eo_text_add(text, i ? ", " : "");
      eo_page_value(text, json_array_get(value, i));
    }
    break;
  default:
    eo_text_add(text, "&ndash;");
    break;
  }
}

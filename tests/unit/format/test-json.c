/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON in and out, texts, sheets: hostile bytes, exact numbers, files that are never half-written. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "document/design_document.h"
#include "format/digits.h"
#include "format/json.h"
#include "format/text_table.h"
#include "support/tap.h"

static struct eo_error error;

static bool refused(const char *data, size_t size, const char *says)
{
  memset(&error, 0, sizeof error);
  json_t *value = eo_json_parse(data, size, &error);
  bool good = !value && error.code == EO_ERROR_INPUT && strstr(error.text, says) && !strchr(error.text, '\n');
  json_decref(value);
  return good;
}

static void test_syntax(void)
{
  static const struct {
    const char *what, *text, *says;
  } bad[] = {
      {"nothing", "", "Line 1"},
      {"blanks", " \n\n ", "Line "},
      {"an array", "[1]", "must be a JSON object"},
      {"a bare number", "3", "Line 1"},
      {"an open object", "{\"a\": 1", "Line 1"},
      {"a comma too many", "{\"a\": 1,\n \"b\": [1, 2,]}", "Line 2, column 13"},
      {"a duplicate key", "{\"a\": 1, \"b\": {\"c\": 1,\n \"c\": 2}}", "duplicate object key"},
      {"NaN", "{\"a\": NaN}", "Line 1"},
      {"Infinity", "{\"a\": -Infinity}", "Line 1"},
      {"1e999", "{\"a\": 1e999}", "overflow"},
      {"a whole number of 400 digits",
       "{\"a\": "
       "100000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
       "0000000000000000000000000000000000000000"
       "000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
       "0000000000000000000000000000000000000000"
       "000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
       "0000000000000000000000000000000000000000}",
       "too big integer"},
      {"text after the end", "{}x", "Line 1"},
      {"a truncated UTF-8 character", "{\"a\": \"\xe2\x82\"}", "Line 1"},
      {"an overlong UTF-8 character", "{\"a\": \"\xc0\xaf\"}", "Line 1"},
      {"a lone surrogate", "{\"a\": \"\\ud800\"}", "Line 1"},
      {"a NUL escape", "{\"a\\u0000b\": 1}", "Line 1"},
      {"a line break in a string", "{\"a\": \"x\ny\"}", "Line 1"},
      {"a leading zero", "{\"a\": 017}", "Line 1"},
      {"a comment", "{/* a */}", "Line 1"},
      {"single quotes", "{'a': 1}", "Line 1"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
    ok(refused(bad[i].text, strlen(bad[i].text), bad[i].says), "%s is refused: %.80s", bad[i].what, error.text);
  ok(refused("{\"a\": \"x\0y\"}", 12, "Line 1"), "a NUL byte is refused: %.80s", error.text);
}

static char *repeat(const char *piece, size_t count, const char *before, const char *after)
{
  size_t length = strlen(piece), start = strlen(before);
  char *text = malloc(start + length * count + strlen(after) + 1);
  strcpy(text, before);
  for (size_t i = 0; i < count; i++)
    memcpy(text + start + i * length, piece, length);
  strcpy(text + start + length * count, after);
  return text;
}

static void test_depth(void)
{
  char *text = repeat("[", 10 << 20, "", "");
  ok(refused(text, 10 << 20, "brackets within brackets"), "10 MB of brackets are refused: %s", error.text);
  free(text);
  text = repeat("{\"a\":", 2 << 20, "", "");
  ok(refused(text, strlen(text), "column 161"), "10 MB of objects are refused: %s", error.text);
  free(text);
  text = repeat("[", 5000, "{\"a\": \"\\\"", "\"}");
  json_t *value = eo_json_parse(text, strlen(text), &error);
  ok(json_is_object(value), "brackets in a string are only characters");
  json_decref(value);
  free(text);
  text = repeat("]", 100000, "{\"a\":", "}");
  ok(refused(text, strlen(text), "Line 1"), "closing brackets without opening ones are refused");
  free(text);
}

/* Every prefix and every single damaged byte of a real document ends in a fault or a design, never in anything else. */
static void test_damage(void)
{
  static struct eo_design design;
  static struct eo_faults faults;
  struct eo_text text = {0};
  memset(&design, 0, sizeof design);
  eo_table_defaults(&eo_design_table, &design);
  json_t *document = eo_design_encode(&design);
  eo_json_write(&text, document, EO_JSON_COMPACT);
  json_decref(document);
  int prefixes = 0, survived = 0, said = 0;
  for (size_t i = 0; i < text.size; i++)
    prefixes += refused(text.data, i, "Line");
  ok(prefixes == (int)text.size, "all %zu truncations are refused", text.size);
  static const char damage[] = {'{', '"', '9', '\xff', ',', 'e', '\0', '-'};
  for (size_t i = 0; i < text.size; i++) {
    char kept = text.data[i];
    text.data[i] = damage[i % sizeof damage];
    json_t *value = eo_json_parse(text.data, text.size, &error);
    faults.count = 0;
    if (value && !eo_design_decode(value, &design, NULL, &faults))
      said += faults.count > 0;
    else if (value)
      survived++;
    else
      said += error.code == EO_ERROR_INPUT;
    json_decref(value);
    text.data[i] = kept;
  }
  ok(said + survived == (int)text.size && said > 100,
     "%d of %zu single damages are reported, and the rest are documents", said, text.size);
  eo_text_done(&text);
}

static bool writes(const char *text, enum eo_json_style style, const char *expected)
{
  struct eo_text out = {0};
  json_t *value = eo_json_parse(text, strlen(text), &error);
  eo_json_write(&out, value, style);
  bool good = out.data && strcmp(out.data, expected) == 0;
  if (!good)
    printf("# %s\n", out.data);
  json_decref(value);
  eo_text_done(&out);
  return good;
}

/* An exponent as JSON wants it is shorter than printf's. */
static void shorten_exponent(char *text)
{
  char *sign = strchr(text, 'e'), *digits = sign ? sign + 2 : NULL;
  if (!sign)
    return;
  while (*digits == '0')
    digits++;
  memmove(sign[1] == '-' ? sign + 2 : sign + 1, digits, strlen(digits) + 1);
}

/* The text that printf gives with the fewest digits that read back equal, exponents as JSON has them. */
static void write_by_printf(char *text, size_t size, double value)
{
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, size, "%.*g", digits, value);
    if (strtod(text, NULL) == value)
      break;
  }
  shorten_exponent(text);
}

/* As compact text; releases the second one. */
static bool written_alike(const json_t *a, json_t *b)
{
  struct eo_text one = {0}, other = {0};
  eo_json_write(&one, a, EO_JSON_COMPACT);
  eo_json_write(&other, b, EO_JSON_COMPACT);
  bool alike = one.data && other.data && strcmp(one.data, other.data) == 0;
  eo_text_done(&one);
  eo_text_done(&other);
  json_decref(b);
  return alike;
}

static bool is_written_as_by_printf(double value)
{
  char text[EO_DIGITS_ROOM], expected[EO_DIGITS_ROOM];
  int length = eo_digits_write(text, sizeof text, value);
  write_by_printf(expected, sizeof expected, value);
  return strcmp(text, expected) == 0 && length == (int)strlen(expected);
}

/* Numbers of few digits and of all of every size, ties, powers of two: what is made of integers is the same text. */
static void check_short_numbers(void)
{
  static const int kept[] = {6, 9, 12, 15};
  int written = 0, rounded = 0, ready = 0;
  uint64_t bits = 7;
  for (int i = 0; i < 60000; i++) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    int digits = kept[i % 4], exponent = (int)(bits >> 40) % 36 - 18;
    double value = (double)(bits >> 11) / 9007199254740992. * pow(10, exponent) * (i & 8 ? -1 : 1),
           half = floor(1e6 * value) / 1e6 + 0.5e-6, back;
    char expected[40];
    json_t *array = eo_json_reals(1, i & 16 ? &value : &half, 1, NULL, digits),
           *text_of_it = eo_json_reals(1, i & 16 ? &value : &half, 1, NULL, digits | EO_DIGITS_READY);
    ready += !written_alike(array, text_of_it);
    back = json_real_value(json_array_get(array, 0));
    json_decref(array);
    snprintf(expected, sizeof expected, "%.*g", digits, i & 16 ? value : half);
    rounded += back != strtod(expected, NULL);
    written += !is_written_as_by_printf(back) + !is_written_as_by_printf(value) +
               !is_written_as_by_printf(ldexp(1, (int)(bits >> 40) % 120 - 60));
  }
  ok(rounded == 0, "60000 numbers of every size, ties among them, are rounded as printf rounds them");
  ok(written == 0, "numbers are written as printf writes them");
  ok(ready == 0, "arrays that are text from the start are the same text");
}

static void test_writer(void)
{
  ok(writes("{\"b\": [1, 2.5, null], \"a\": {\"z\": true, \"y\": \"\\u00e4\\n\\\"\\\\\"}}", EO_JSON_CANONICAL,
            "{\"a\":{\"y\":\"\xc3\xa4\\u000a\\\"\\\\\",\"z\":true},\"b\":[1,2.5,null]}"),
     "canonical JSON is sorted and has no blanks");
  ok(writes("{\"b\": 1, \"a\": []}", EO_JSON_PRETTY, "{ \"b\": 1, \"a\": [] }\n"),
     "pretty JSON is in order, with short values on one line");
  ok(writes("{}", EO_JSON_COMPACT, "{}"), "an empty object is written as one");
  static const struct {
    double value;
    const char *text;
  } numbers[] = {{0.1, "0.1"},
                 {1. / 3, "0.3333333333333333"},
                 {0.1 + 0.2, "0.30000000000000004"},
                 {1e-7, "1e-7"},
                 {1e22, "1e22"},
                 {6, "6"},
                 {5e-324, "4.94065645841247e-324"},
                 {-1.7976931348623157e308, "-1.7976931348623157e308"},
                 {1e100, "1e100"},
                 {2.5e-15, "2.5e-15"},
                 {0, "0"},
                 {-1e-5, "-1e-5"},
                 {1.25e-10, "1.25e-10"},
                 {1e-13, "1e-13"}};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
    char text[40];
    eo_digits_write(text, sizeof text, numbers[i].value);
    ok(strcmp(text, numbers[i].text) == 0 && strtod(text, NULL) == numbers[i].value, "%s is written %s",
       numbers[i].text, text);
  }
  int lost = 0;
  uint64_t bits = 1;
  for (int i = 0; i < 100000; i++) {
    double value, back;
    char text[40];
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    memcpy(&value, &bits, sizeof value);
    if (!isfinite(value))
      continue;
    eo_digits_write(text, sizeof text, value);
    back = strtod(text, NULL);
    lost += memcmp(&back, &value, sizeof back) != 0;
  }
  ok(lost == 0, "100000 random doubles read back equal");
  check_short_numbers();
  const double column[] = {1, NAN, 2.0000000000001, INFINITY};
  json_t *array = eo_json_reals(4, column, 1, &eo_unit_mm, 9);
  ok(written_alike(array, eo_json_reals(4, column, 1, &eo_unit_mm, 9 | EO_DIGITS_READY)),
     "numbers that are text from the start read back equal, with their unit and nulls");
  char *dumped = json_dumps(array, JSON_COMPACT | JSON_REAL_PRECISION(9));
  ok(strcmp(dumped, "[1000.0,null,2000.0,null]") == 0, "not finite numbers are null, curves are rounded: %s", dumped);
  free(dumped);
  json_decref(array);
}

static void test_text(void)
{
  char clean[16];
  eo_text_clean(clean, sizeof clean, "a\nb\x7f");
  ok(strcmp(clean, "a?b?") == 0, "control characters of a text are replaced");
  eo_text_clean(clean, sizeof clean, "0123456789\xe2\x82\xac\xe2\x82\xac\xe2\x82\xac");
  ok(strcmp(clean, "0123456789...") == 0, "a text that is cut has no character in two: %s", clean);
  eo_text_clean(clean, sizeof clean, "012345678901234");
  ok(strcmp(clean, "012345678901234") == 0, "a text that fits stays as it is");
  struct eo_text escaped = {0};
  eo_text_add_escaped(&escaped, "a<b> & \"c\"\t\n\x01\x1f\xc3\xa4");
  ok(!strcmp(escaped.data, "a&lt;b&gt; &amp; &quot;c&quot;\t\n  \xc3\xa4"),
     "what XML and HTML keep for themselves is escaped, controls are blanks: %s", escaped.data);
  eo_text_done(&escaped);
}

static void test_sheet(void)
{
  static const char *const headings[] = {"name", "speed_rpm", "note"};
  struct eo_text_table sheet;
  struct eo_text text = {0}, csv = {0};
  eo_text_table_init(&sheet, 3, headings);
  eo_text_table_string(&sheet, "\xc3\xa4, \"x\"");
  eo_text_table_number(&sheet, 2000 * (M_PI / 30), &eo_unit_rpm, 0);
  eo_text_table_string(&sheet, "");
  eo_text_table_string(&sheet, "b");
  eo_text_table_number(&sheet, NAN, NULL, 0);
  eo_text_table_string(&sheet, "two\nlines");
  eo_text_table_csv(&sheet, &csv);
  eo_text_table_print(&sheet, 1, &text);
  ok(strcmp(csv.data, "name,speed_rpm,note\r\n\"\xc3\xa4, \"\"x\"\"\",2000,\r\nb,,\"two\nlines\"\r\n") == 0,
     "CSV is written as RFC 4180 wants it");
  const char *aligned = " name    speed_rpm  note\n \xc3\xa4, \"x\"       2000  \n";
  ok(strncmp(text.data, aligned, strlen(aligned)) == 0, "columns of a table are aligned");
  eo_text_table_done(&sheet);
  eo_text_done(&text);
  eo_text_done(&csv);
}

static void test_files(void)
{
  char folder[] = "eo-test-XXXXXX", path[64];
  struct eo_text text = {0}, back = {0};
  if (!mkdtemp(folder)) {
    ok(0, "a temporary folder is made");
    return;
  }
  snprintf(path, sizeof path, "%s/file", folder);
  eo_text_add(&text, "first");
  ok(eo_text_save(&text, path, &error) == EO_OK && eo_text_read(&back, path, 100, &error) == EO_OK &&
         strcmp(back.data, "first") == 0,
     "a text is saved and read again");
  ok(eo_text_read(&back, path, 4, &error) == EO_ERROR_INPUT && strstr(error.text, "larger than the limit"),
     "a file larger than the limit is refused: %s", error.text);
  ok(strcmp(back.data, "first") == 0, "a failed reading leaves the text alone");
  text.failed = true;
  ok(eo_text_save(&text, path, &error) == EO_ERROR_MEMORY, "an incomplete text is not written");
  text.failed = false;
  FILE *full = fopen("/dev/full", "w");
  if (full) {
    ok(eo_text_write(&text, full, "Output", &error) == EO_ERROR_FILE && strstr(error.text, "Output"),
       "a full disk is noticed: %s", error.text);
    fclose(full);
  }
  snprintf(path, sizeof path, "%s/none/file", folder);
  ok(eo_text_save(&text, path, &error) == EO_ERROR_FILE, "a text in no folder is not saved: %s", error.text);
  ok(eo_text_read(&back, path, 100, &error) == EO_ERROR_INPUT, "a file that is not there is not read: %s", error.text);
  ok(eo_text_read(&back, folder, 100, &error) == EO_ERROR_INPUT, "a folder is not read as a file: %s", error.text);
  snprintf(path, sizeof path, "%s/file", folder);
  unlink(path);
  ok(rmdir(folder) == 0, "no temporary file is left behind");
  eo_text_done(&text);
  eo_text_done(&back);
}

static void test_whole(void)
{
  static const struct {
    double value;
    bool whole;
  } number[] = {{17, true},     {-3, true}, {17.5, false}, {9007199254740991, true}, {9007199254740992, false},
                {1.3e62, false}};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
    json_t *value = eo_json_whole(number[i].value);
    ok(json_is_integer(value) == number[i].whole && json_number_value(value) == number[i].value,
       "%.17g stays what it is", number[i].value);
    json_decref(value);
  }
  ok(!eo_json_whole(NAN), "a value that is not a number has no document");
}

int main(void)
{
  test_syntax();
  test_depth();
  test_damage();
  test_writer();
  test_text();
  test_sheet();
  test_files();
  test_whole();
  return tap_done();
}

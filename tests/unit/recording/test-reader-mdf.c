/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ASAM MDF 4: blocks written here byte by byte after the public description of the format. Files of two other writers
   were read beside these by hand: sorted, unsorted and compressed ones of the same channels agree. */
#include "recording/layout.h"
#include "support/byte-writer.h"
#include "support/reader-fixture.h"

#include <math.h>
#include <time.h>
#include <zlib.h>

enum { UNSIGNED, SIGNED = 2, FLOATING = 4, BIG = 1, TEXT = 7 };
enum { VALUE, TEXTS, MASTER, VIRTUAL_MASTER };
enum { ROWS = 3000 };

static struct writer w;
static const struct eo_reader_options spooled = {.spool_directory = "/tmp"};

/* Blocks are written from the leaves to the root, so that all links are known; only the header comes first. */
static uint64_t begin_block(const char *id, int links, const uint64_t *link)
{
  while (w.size % 8)
    put_number(&w, 0, 1);
  uint64_t at = w.size;
  put_bytes(&w, "##", 2);
  put_bytes(&w, id, 2);
  put_number(&w, 0, 4);
  put_number(&w, 0, 8);
  put_number(&w, (uint64_t)links, 8);
  for (int i = 0; i < links; i++)
    put_number(&w, link[i], 8);
  return at;
}

static void set_at(uint64_t at, uint64_t value, int bytes)
{
  size_t size = w.size;
  w.size = at;
  put_number(&w, value, bytes);
  w.size = size;
}

static uint64_t end_block(uint64_t at)
{
  set_at(at + 8, w.size - at, 8);
  return at;
}

static uint64_t put_text(const char *id, const char *text)
{
  uint64_t at = begin_block(id, 0, NULL);
  put_bytes(&w, text, strlen(text) + 1);
  return end_block(at);
}

static uint64_t put_conversion(int kind, int terms, const double *term, int branches, const uint64_t *branch)
{
  uint64_t link[16] = {0};
  for (int i = 0; i < branches; i++)
    link[4 + i] = branch[i];
  uint64_t at = begin_block("CC", 4 + branches, link);
  put_number(&w, (uint64_t)kind, 1);
  put_number(&w, 0, 3);
  put_number(&w, (uint64_t)branches, 2);
  put_number(&w, (uint64_t)terms, 2);
  put_double(&w, 0);
  put_double(&w, 0);
  for (int i = 0; i < terms; i++)
    put_double(&w, term[i]);
  return end_block(at);
}

struct channel {
  const char *name, *unit;
  int kind, type, byte, bit, bits;
  uint64_t conversion, comment, composition;
  int invalid; /* bit from 1; 0: none */
};

/* next: the channel behind this one. */
static uint64_t put_channel(const struct channel *c, uint64_t next)
{
  uint64_t name = put_text("TX", c->name), unit = c->unit ? put_text("TX", c->unit) : 0;
  uint64_t link[8] = {next, c->composition, name, 0, c->conversion, 0, unit, c->comment};
  uint64_t at = begin_block("CN", 8, link);
  put_number(&w, (uint64_t)c->kind, 1);
  put_number(&w, c->kind == MASTER || c->kind == VIRTUAL_MASTER, 1);
  put_number(&w, (uint64_t)c->type, 1);
  put_number(&w, (uint64_t)c->bit, 1);
  put_number(&w, (uint64_t)c->byte, 4);
  put_number(&w, (uint64_t)c->bits, 4);
  put_number(&w, c->invalid ? 2 : 0, 4);
  put_number(&w, c->invalid ? (uint64_t)c->invalid - 1 : 0, 4);
  put_number(&w, 0, 4);
  for (int i = 0; i < 6; i++)
    put_double(&w, 0);
  return end_block(at);
}

static uint64_t put_channels(const struct channel *c, int count)
{
  uint64_t at = 0;
  while (count-- > 0)
    at = put_channel(&c[count], at);
  return at;
}

static uint64_t put_group(uint64_t next, uint64_t channels, const char *name, uint64_t number, uint64_t rows, int flags,
                          int data, int invalidation)
{
  uint64_t link[6] = {next, channels, name ? put_text("TX", name) : 0, 0, 0, 0};
  uint64_t at = begin_block("CG", 6, link);
  put_number(&w, number, 8);
  put_number(&w, rows, 8);
  put_number(&w, (uint64_t)flags, 2);
  put_number(&w, 0, 6);
  put_number(&w, (uint64_t)data, 4);
  put_number(&w, (uint64_t)invalidation, 4);
  return end_block(at);
}

static uint64_t put_data_group(uint64_t next, uint64_t group, uint64_t data, int number)
{
  uint64_t link[4] = {next, group, data, 0};
  uint64_t at = begin_block("DG", 4, link);
  put_number(&w, (uint64_t)number, 1);
  put_number(&w, 0, 7);
  return end_block(at);
}

static void begin_file(const char *id, const char *version, int gaps)
{
  static const uint64_t none[6];
  memset(&w, 0, sizeof w);
  put_bytes(&w, id, 8);
  put_bytes(&w, version, 8);
  put_bytes(&w, "easeoff ", 8);
  put_number(&w, 0, 4);
  put_number(&w, 410, 2);
  put_number(&w, 0, 30);
  put_number(&w, (uint64_t)gaps, 2);
  put_number(&w, 0, 2);
  uint64_t at = begin_block("HD", 6, none);
  put_number(&w, 1700000000000000000u, 8);
  put_number(&w, 0, 24);
  end_block(at);
}

static void end_file(uint64_t data_group)
{
  set_at(64 + 24, data_group, 8);
  write_bytes(w.bytes, w.size);
}

static const char *data_id = "DT"; /* DV: values without invalidation bits, of MDF 4.2 */

/* Data in one block, packed or not. */
static uint64_t put_data(const unsigned char *bytes, size_t size, int packing, int width)
{
  static unsigned char turned[1 << 19], packed[1 << 19];
  if (!packing) {
    uint64_t at = begin_block(data_id, 0, NULL);
    put_bytes(&w, bytes, size);
    return end_block(at);
  }
  size_t rows = size / (size_t)width;
  memcpy(turned, bytes, size);
  for (size_t r = 0; packing == 2 && r < rows; r++)
    for (size_t c = 0; c < (size_t)width; c++)
      turned[c * rows + r] = bytes[r * (size_t)width + c];
  uLongf length = sizeof packed;
  compress(packed, &length, turned, size);
  uint64_t at = begin_block("DZ", 0, NULL);
  put_bytes(&w, data_id, 2);
  put_number(&w, (uint64_t)packing - 1, 1);
  put_number(&w, 0, 1);
  put_number(&w, packing == 2 ? (uint64_t)width : 0, 4);
  put_number(&w, size, 8);
  put_number(&w, length, 8);
  put_bytes(&w, packed, length);
  return end_block(at);
}

static uint64_t put_list(int count, const uint64_t *data, uint64_t next)
{
  uint64_t link[16] = {next};
  memcpy(link + 1, data, (size_t)count * sizeof *data);
  uint64_t at = begin_block("DL", count + 1, link);
  put_number(&w, 0, 4);
  put_number(&w, (uint64_t)count, 4);
  for (int i = 0; i < count; i++)
    put_number(&w, 0, 8);
  return end_block(at);
}

/* Sets bit after bit of an integer: bit i of the value is bit `bit` + i of the bytes, which stand in turned order where
   the high one comes first. */
static void set_bits(unsigned char *record, const struct channel *c, uint64_t value)
{
  int bytes = (c->bit + c->bits + 7) / 8;
  for (int i = 0; i < c->bits; i++) {
    int at = (c->bit + i) / 8;
    if (value >> i & 1)
      record[c->byte + (c->type & BIG ? bytes - 1 - at : at)] |= (unsigned char)(1 << (c->bit + i) % 8);
  }
}

static uint64_t bits_of(double value, int bits)
{
  uint64_t whole = 0;
  float narrow = (float)value;
  uint32_t half;
  memcpy(&half, &narrow, 4);
  memcpy(&whole, &value, 8);
  return bits == 64 ? whole : half;
}

static double time_of(int i)
{
  return 0.25 + 1e-4 * i;
}

static int raw_pinion(int i)
{
  return (int)((29LL * i + 5) % 131072) - 65536;
}

static double gear(int i)
{
  return 11.5 + 0.375 * i;
}

/* Record: time, 3 bits of something, pinion of 17 bits with its high byte first, gear. */
enum { RECORD = 15 };
static const struct channel plain[] = {{"t", NULL, MASTER, FLOATING, 0, 0, 64, 0, 0, 0, 0},
                                       {"pinion", "deg", VALUE, SIGNED | BIG, 8, 3, 17, 0, 0, 0, 0},
                                       {"gear", "deg", VALUE, FLOATING, 11, 0, 32, 0, 0, 0, 0}};

static void put_record(unsigned char *to, int i)
{
  memset(to, 0, RECORD);
  set_bits(to, &plain[0], bits_of(time_of(i), 64));
  set_bits(to, &plain[1], (uint64_t)raw_pinion(i));
  to[10] |= 5; /* bits of another channel, which the reader must not see */
  set_bits(to, &plain[2], bits_of(gear(i), 32));
}

static unsigned char records[ROWS * RECORD + 64];

static uint64_t put_plain_channels(void)
{
  static const double line[] = {100, 0.5};
  struct channel c[3];
  memcpy(c, plain, sizeof c);
  c[1].conversion = put_conversion(1, 2, line, 0, NULL);
  return put_channels(c, 3);
}

static int holds_plain(const struct eo_recording *r, int rows)
{
  int right = r && eo_recording_columns(r) == 3 && eo_recording_rows(r) == rows;
  for (int i = 0; right && i < rows; i += 7)
    right = cell_of(r, i, 0) == time_of(i) && cell_of(r, i, 1) == 100 + 0.5 * raw_pinion(i) &&
            cell_of(r, i, 2) == gear(i);
  return right && eo_recording_clock(r, 1).column == 0 && eo_recording_clock(r, 0).epoch == 1700000000000000000 &&
         !strcmp(eo_recording_name(r, 2), "gear") && !strcmp(eo_recording_unit(r, 2), "deg") &&
         !strcmp(eo_recording_unit(r, 0), "s");
}

/* The same records in every way of storing them. */
static void test_storage(const char *what, const int *packing, const size_t *part, int parts, bool header)
{
  begin_file("MDF     ", "4.10    ", 0);
  uint64_t data[8];
  size_t at = 0;
  for (int i = 0; i < parts; i++) {
    data[i] = put_data(records + at, part[i], packing[i], RECORD);
    at += part[i];
  }
  uint64_t root = data[0];
  if (parts > 1)
    root = put_list(1, data, put_list(parts - 1, data + 1, 0));
  if (header) {
    root = parts > 1 ? root : put_list(1, data, 0);
    uint64_t block = begin_block("HL", 1, &root);
    put_number(&w, 0, 8);
    root = end_block(block);
  }
  uint64_t group = put_group(0, put_plain_channels(), "g", 0, ROWS, 0, RECORD, 0);
  end_file(put_data_group(0, group, root, 0));
  struct eo_error error;
  struct eo_recording *r = read_fixture(&spooled, NULL, &error);
  ok(holds_plain(r, ROWS), "data in %s give all of it: %s", what,
     r ? "times, values, names, units, clocks" : error.text);
  eo_recording_free(r);
}

static void test_storages(void)
{
  for (int i = 0; i < ROWS; i++)
    put_record(records + (size_t)i * RECORD, i);
  size_t all = (size_t)ROWS * RECORD, odd[3] = {1000 * RECORD + 7, 1, all - 1000 * RECORD - 8};
  test_storage("one block", (int[]){0}, &all, 1, false);
  test_storage("a list of lists, records across blocks", (int[]){0, 0, 0}, odd, 3, false);
  test_storage("compressed", (int[]){1}, &all, 1, false);
  test_storage("compressed column by column", (int[]){2}, &all, 1, true);
  test_storage("plain and compressed in one list", (int[]){2, 0, 1}, odd, 3, true);
}

/* MDF 4.2, column by column: each channel has a group of its own, whose times are those of the first; values stand in
   lists (LD) of blocks DV, the flag for invalidation bits of the last one as given. */
static void put_columns(uint32_t flags)
{
  static unsigned char column[ROWS * 8];
  uint64_t group[3], root[3], data_group = 0;
  static const double line[] = {100, 0.5};
  begin_file("MDF     ", "4.20    ", 0);
  data_id = "DV";
  for (int c = 0; c < 3; c++) {
    struct channel own = plain[c];
    int size = (own.bit + own.bits + 7) / 8;
    for (int i = 0; i < ROWS; i++)
      memcpy(column + (size_t)i * size, records + (size_t)i * RECORD + own.byte, size);
    size_t half = (size_t)size * 1000 + 1, all = (size_t)size * ROWS;
    uint64_t link[3] = {0, put_data(column, half, 0, 0), put_data(column + half, all - half, 2, size)};
    root[c] = begin_block("LD", 3, link);
    put_number(&w, c == 2 ? flags : 0, 4);
    put_number(&w, 2, 4);
    put_number(&w, 0, 16);
    end_block(root[c]);
    own.byte = 0;
    own.conversion = c == 1 ? put_conversion(1, 2, line, 0, NULL) : 0;
    uint64_t links[7] = {0, put_channels(&own, 1), 0, 0, 0, 0, c ? group[0] : 0};
    group[c] = begin_block("CG", c ? 7 : 6, links);
    put_number(&w, 0, 8);
    put_number(&w, ROWS, 8);
    put_number(&w, c ? 8 : 0, 2);
    put_number(&w, 0, 6);
    put_number(&w, (uint64_t)size, 4);
    put_number(&w, 1, 4); /* a byte of invalidation bits, which values have beside them */
    end_block(group[c]);
  }
  for (int c = 2; c >= 0; c--)
    data_group = put_data_group(data_group, group[c], root[c], 0);
  end_file(data_group);
  data_id = "DT";
}

static void test_columns(void)
{
  struct eo_error error;
  put_columns(1);
  struct eo_recording *r = read_fixture(&spooled, NULL, &error);
  ok(holds_plain(r, ROWS), "values that stand column by column give all of it: %s",
     r ? "times of another group" : error.text);
  eo_recording_free(r);
  put_columns(1u << 31);
  r = read_fixture(&spooled, NULL, &error);
  ok(!r && strstr(error.text, "save the file as MDF 4.1"), "invalidation bits that stand apart are refused: %s",
     r ? "read" : error.text);
  eo_recording_free(r);
}

/* Two groups and texts between their records, behind numbers of 1 to 8 bytes. */
static void test_unsorted(int number)
{
  static unsigned char mixed[2 * (sizeof records + 16 * ROWS)];
  size_t n = 0;
  int texts = 0;
  for (int i = 0; i < ROWS; i++) {
    unsigned char second[8];
    double slow = 5 * i;
    memset(mixed + n, 0, 8);
    mixed[n] = 7;
    memcpy(mixed + n + number, records + (size_t)i * RECORD, RECORD);
    n += (size_t)number + RECORD;
    if (i % 3 == 0) {
      memset(mixed + n, 0, 8);
      mixed[n] = 9;
      memcpy(second, &slow, 8);
      memcpy(mixed + n + number, second, 8);
      n += (size_t)number + 8;
    }
    if (i % 50 == 0) { /* length 3, then "abc" */
      memset(mixed + n, 0, 12);
      mixed[n] = 2;
      memcpy(mixed + n + number, "\3\0\0\0abc", 7);
      n += (size_t)number + 7;
      texts++;
    }
  }
  begin_file("MDF     ", "4.11    ", 0);
  struct channel slow = {"slow", "rpm", VALUE, FLOATING, 0, 0, 64, 0, 0, 0, 0};
  uint64_t data = put_data(mixed, n, 0, 0);
  uint64_t group = put_group(0, 0, NULL, 2, (uint64_t)texts, 1, 0, 0);
  group = put_group(group, put_channels(&slow, 1), NULL, 9, ROWS / 3, 0, 8, 0);
  group = put_group(group, put_plain_channels(), NULL, 7, ROWS, 0, RECORD, 0);
  end_file(put_data_group(0, group, data, number));
  struct eo_error error;
  struct eo_recording *r = read_fixture(&spooled, NULL, &error);
  int right = r && eo_recording_columns(r) == 4 && eo_recording_length(r, 3) == ROWS / 3;
  for (int i = 0; right && i < ROWS / 3; i++)
    right = cell_of(r, i, 3) == 15 * i && cell_of(r, i, 1) == 100 + 0.5 * raw_pinion(i) && cell_of(r, i, 2) == gear(i);
  ok(right, "unsorted records behind numbers of %d bytes are sorted: %s", number, r ? "sorted" : error.text);
  eo_recording_free(r);
}

/* One channel whose two records hold these raw bits comes out as these values. */
static int reads_as(const struct channel *c, const uint64_t *raw, const double *value)
{
  unsigned char bytes[2][24] = {{0}};
  begin_file("MDF     ", "4.10    ", 0);
  for (int i = 0; i < 2; i++)
    set_bits(bytes[i], c, raw[i]);
  uint64_t data = put_data(bytes[0], sizeof bytes, 0, 0), channels = put_channels(c, 1);
  end_file(put_data_group(0, put_group(0, channels, NULL, 0, 2, 0, 24, 0), data, 0));
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int right = r && cell_of(r, 0, 0) == value[0] && cell_of(r, 1, 0) == value[1];
  if (!right)
    printf("# %s: %.17g %.17g instead of %.17g %.17g\n", r ? "values" : error.text, r ? cell_of(r, 0, 0) : 0,
           r ? cell_of(r, 1, 0) : 0, value[0], value[1]);
  eo_recording_free(r);
  return right;
}

static void test_integers(void)
{
  int right = 1, tried = 0;
  for (int bits = 1; bits <= 64; bits++)
    for (int bit = 0; bit < 8; bit += 1 + (bits + 2 * bit) % 5)
      for (int type = UNSIGNED; type < FLOATING; type++) {
        struct channel c = {"c", NULL, VALUE, type, 5, bit, bits, 0, 0, 0, 0};
        uint64_t low = (uint64_t)1 << (bits - 1), raw[2] = {low, low - 1}; /* the least and the most signed value */
        double most = ldexp(1, bits - 1), value[2] = {type >= SIGNED ? -most : most, (double)(low - 1)};
        right = right && reads_as(&c, raw, value);
        tried++;
      }
  ok(right, "integers of 1 to 64 bits are read from any bit, in both signs and byte orders: %d", tried);
}

static void test_floats(void)
{
  const double value[2] = {-617.5, 0.0078125};
  for (int big = 0; big < 2; big++) {
    struct channel half = {"c", NULL, VALUE, FLOATING | big, 3, 0, 16, 0, 0, 0, 0}, single = half, full = half;
    single.bits = 32;
    full.bits = 64;
    const uint64_t half_bits[2] = {0xe0d3, 0x2000}, single_bits[2] = {bits_of(value[0], 32), bits_of(value[1], 32)},
                   full_bits[2] = {bits_of(value[0], 64), bits_of(value[1], 64)};
    ok(reads_as(&half, half_bits, value) && reads_as(&single, single_bits, value) && reads_as(&full, full_bits, value),
       "floating values of 16, 32 and 64 bits are read, %s byte first", big ? "high" : "low");
  }
}

/* Signed values x of a channel with this conversion come out as y. */
static void test_conversion(const char *what, int kind, int terms, const double *term, const double *x, const double *y)
{
  unsigned char bytes[2][4] = {{0}};
  struct channel c = {"c", "deg", VALUE, SIGNED, 0, 0, 32, 0, 0, 0, 0};
  begin_file("MDF     ", "4.10    ", 0);
  for (int i = 0; i < 2; i++)
    set_bits(bytes[i], &c, (uint64_t)(int64_t)x[i]);
  uint64_t branch[3] = {0};
  static const double line[] = {1, 2};
  if (kind >= 7) { /* a text, a line, a text for all else */
    branch[0] = branch[2] = put_text("TX", "off");
    branch[1] = put_conversion(1, 2, line, 0, NULL);
  }
  c.conversion = put_conversion(kind, terms, term, kind >= 7 ? 3 : 0, branch);
  uint64_t data = put_data(bytes[0], sizeof bytes, 0, 0), channels = put_channels(&c, 1);
  end_file(put_data_group(0, put_group(0, channels, NULL, 0, 2, 0, 4, 0), data, 0));
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int right = r != NULL;
  for (int i = 0; right && i < 2; i++)
    right = isnan(y[i]) ? isnan(cell_of(r, i, 0)) : fabs(cell_of(r, i, 0) - y[i]) < 1e-12;
  ok(right, "a conversion is made, %s: %s", what, r ? "converted" : error.text);
  eo_recording_free(r);
}

static void test_conversions(void)
{
#define PAIR(a, b) ((const double[]){a, b})
  test_conversion("equal", 0, 0, NULL, PAIR(-3, 4), PAIR(-3, 4));
  test_conversion("linear", 1, 2, PAIR(0.5, -2), PAIR(-3, 4), PAIR(6.5, -7.5));
  test_conversion("rational", 2, 6, (const double[]){1, 2, 3, 0, 4, 5}, PAIR(2, -1), PAIR(11.0 / 13, 2));
  static const double table[] = {-10, 1, 0, 2, 10, 7};
  test_conversion("table with lines between", 4, 6, table, PAIR(-5, 5), PAIR(1.5, 4.5));
  test_conversion("beyond the ends of the table", 4, 6, table, PAIR(-50, 50), PAIR(1, 7));
  test_conversion("table without lines: the nearest", 5, 6, table, PAIR(-4, 6), PAIR(2, 7));
  test_conversion("of two equally near the lower", 5, 6, table, PAIR(-5, 5), PAIR(1, 2));
  static const double ranges[] = {0, 4, 1.5, 5, 9, 2.5, -1};
  test_conversion("ranges, their ends included", 6, 7, ranges, PAIR(4, 5), PAIR(1.5, 2.5));
  test_conversion("beside all ranges", 6, 7, ranges, PAIR(10, -1), PAIR(-1, -1));
  test_conversion("a text is no number, a line in a table of texts is one", 7, 2, PAIR(3, 4), PAIR(3, 4), PAIR(NAN, 9));
  test_conversion("by ranges", 8, 4, (const double[]){0, 1, 2, 8}, PAIR(1, 8), PAIR(NAN, 17));
}

/* Times that are counted, values that mean nothing, what the comment states, two names made one by their groups. */
static void test_facts(void)
{
  static const double line[] = {0.5, 2e-4};
  unsigned char bytes[4][3] = {{1, 2, 0}, {3, 4, 2}, {5, 6, 0}, {7, 8, 0}};
  begin_file("MDF     ", "4.10    ", 0);
  uint64_t comment = put_text("MD", "<CNcomment><TX>an encoder</TX><common_properties>"
                                    "<e name=\"counts per turn\">3600</e></common_properties></CNcomment>");
  uint64_t unit = put_text("MD", "<CNunit><TX>&lt;counts&gt;</TX></CNunit>");
  struct channel c[] = {{"t", "s", VIRTUAL_MASTER, UNSIGNED, 0, 0, 0, put_conversion(1, 2, line, 0, NULL), 0, 0, 0},
                        {"angle", NULL, VALUE, UNSIGNED, 0, 0, 8, 0, comment, 0, 0},
                        {"other", NULL, VALUE, UNSIGNED, 1, 0, 8, 0, 0, 0, 2}};
  uint64_t other = put_channel(&c[2], 0), angle = put_channel(&c[1], other), time = put_channel(&c[0], angle);
  set_at(angle + 24 + 6 * 8, unit, 8);
  uint64_t data = put_data(bytes[0], sizeof bytes, 0, 0), second = put_data(bytes[0], sizeof bytes, 0, 0);
  uint64_t one = put_group(0, time, "pinion", 0, 4, 0, 2, 1),
           two = put_group(0, put_channel(&c[1], 0), "gear", 0, 4, 0, 2, 1);
  end_file(put_data_group(put_data_group(0, two, second, 0), one, data, 0));
  struct eo_error error;
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int right = r && eo_recording_columns(r) == 3;
  ok(right, "times that are counted are no column: %s", r ? "three columns" : error.text);
  if (!right)
    return;
  struct eo_clock clock = eo_recording_clock(r, 0);
  ok(clock.column == -1 && fabs(clock.interval - 2e-4) < 1e-15 && clock.start == 0.5,
     "times that are counted are a clock");
  ok(isnan(cell_of(r, 1, 1)) && cell_of(r, 2, 1) == 6, "an invalidation bit takes its own value away alone");
  ok(eo_recording_turn(r, 0) == 3600, "counts per turn are read from the comment");
  ok(!strcmp(eo_recording_unit(r, 0), "<counts>"), "a unit is read from XML");
  ok(!strcmp(eo_recording_name(r, 0), "pinion angle") && !strcmp(eo_recording_name(r, 2), "gear angle"),
     "channels of one name are told apart by their groups");
  eo_recording_free(r);
}

/* A recorder that lost power left no numbers of records, and no length of the last block. */
static void test_unfinished(void)
{
  for (int gaps = 0; gaps < 16; gaps += 5) {
    begin_file("UnFinMF ", "4.10    ", gaps);
    uint64_t group = put_group(0, put_plain_channels(), "g", 0, 0, 0, RECORD, 0);
    uint64_t data_group = put_data_group(0, group, 0, 0), data = put_data(records, 500 * RECORD + 4, 0, 0);
    set_at(data_group + 24 + 2 * 8, data, 8);
    if (gaps & 4)
      set_at(data + 8, 24, 8);
    end_file(data_group);
    struct eo_error error;
    struct eo_notes notes = {0};
    struct eo_recording *r = gaps & 8 ? NULL : read_fixture(NULL, &notes, &error);
    if (gaps & 8)
      refused("was not finalised", "gaps that only the writer can close");
    else
      ok(holds_plain(r, 500) && noted(&notes, "not finalised"),
         "a file that was not finalised, with gaps %d, is read: %s", gaps, r ? "records are counted" : error.text);
    eo_recording_free(r);
  }
}

/* Lets one number of a good file say something else. */
static void put_changed(const char *id, int which, uint64_t behind, uint64_t value, int bytes, int packing)
{
  begin_file("MDF     ", "4.10    ", 0);
  uint64_t data = put_data(records, 500 * RECORD, packing, RECORD);
  uint64_t group = put_group(0, put_plain_channels(), NULL, 0, 500, 0, RECORD, 0);
  uint64_t root = put_data_group(0, group, data, 0);
  for (size_t at = 64; at + 4 < w.size && which >= 0; at += 8)
    if (w.bytes[at] == '#' && w.bytes[at + 1] == '#' && !memcmp(w.bytes + at + 2, id, 2) && which-- == 0)
      set_at(at + behind, value, bytes);
  end_file(root);
}

static void test_damage(void)
{
  put_changed("DZ", 0, 24 + 2, 2, 1, 1);
  refused("packed in a way (2)", "a packing of later versions");
  put_changed("DZ", 0, 24 + 8, 1 << 25, 8, 1);
  refused("the file is damaged", "a block that grows beyond what deflate can");
  put_changed("DZ", 0, 24 + 8, 500 * RECORD + 1, 8, 1);
  refused("compressed data at byte", "a block that holds less than it states");
  put_changed("DT", 0, 8, 1 << 30, 8, 0);
  refused("cut off or damaged", "a block beyond the end of the file");
  put_changed("CG", 0, 24, 64, 8, 0);
  refused("no block of kind CG", "a link to something else");
  put_changed("CN", 0, 24, (uint64_t)-8, 8, 0);
  refused("a link leads to byte", "a link to nowhere");
  put_changed("DG", 0, 24 + 4 * 8, 3, 1, 0);
  refused("numbers of 3 bytes", "a width of numbers that does not exist");
  put_changed("CC", 0, 24 + 4 * 8 + 6, 9000, 2, 0);
  refused("more than its block holds", "a conversion with too many numbers");
  begin_file("MDF     ", "3.30    ", 0);
  end_file(0);
  refused("version 3.30", "an older version");
  begin_file("MDF     ", "4.10    ", 0);
  end_file(0);
  refused("no channel with numbers", "a file without channels");
  put_changed("CG", 0, 24 + 6 * 8 + 8, 9999, 8, 0);
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(holds_plain(r, 500) && noted(&notes, "cut off"), "a file of fewer records than stated is read with a note");
  eo_recording_free(r);
}

/* A channel whose next one is itself: the list leads in a circle. */
static void test_circle(void)
{
  begin_file("MDF     ", "4.10    ", 0);
  uint64_t channels = put_plain_channels(), data = put_data(records, 500 * RECORD, 0, 0);
  set_at(channels + 24, channels, 8);
  end_file(put_data_group(0, put_group(0, channels, NULL, 0, 500, 0, RECORD, 0), data, 0));
  refused("in a circle", "a list that leads in a circle");
}

/* What may cost a reader far more than its bytes: one block in many lists, rows wider than their block, texts of
   properties without an end. */
static void test_costly(void)
{
  enum { MANY = 1000 };
  static char xml[60000];
  static uint64_t data[2];
  clock_t begin = clock();
  struct eo_error error;
  begin_file("MDF     ", "4.10    ", 0);
  data[0] = data[1] = put_data(records, ROWS * RECORD, 0, 0);
  uint64_t at = put_list(2, data, 0);
  end_file(put_data_group(0, put_group(0, put_plain_channels(), NULL, 0, ROWS, 0, RECORD, 0), at, 0));
  refused("once more", "one block twice in the lists of data");
  begin_file("MDF     ", "4.10    ", 0);
  at = 0;
  for (int i = 0; i < 6; i++) {
    data[0] = put_data(records, 20 * RECORD, 2, RECORD);
    set_at(data[0] + 24 + 4, UINT32_MAX, 4);
    at = put_data_group(at, put_group(0, put_plain_channels(), NULL, 0, 20, 0, RECORD, 0), data[0], 0);
  }
  end_file(at);
  struct eo_recording *r = read_fixture(&spooled, NULL, &error);
  ok(r && eo_recording_rows(r) == 20, "rows that are wider than their block stand as they are%s", r ? "" : error.text);
  eo_recording_free(r);
  for (size_t i = 0; i + 3 < sizeof xml; i += 3)
    memcpy(xml + i, "<e ", 3);
  xml[sizeof xml - 3] = '>';
  begin_file("MDF     ", "4.10    ", 0);
  uint64_t comment = put_text("MD", xml), channels = 0;
  for (int i = 0; i < MANY; i++)
    channels = put_channel(&(struct channel){"c", NULL, VALUE, UNSIGNED, 0, 0, 8, 0, comment, 0, 0}, channels);
  end_file(put_data_group(0, put_group(0, channels, NULL, 0, 20, 0, 1, 0), put_data(records, 20, 0, 0), 0));
  r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_rows(r) == 20, "texts of properties without an end%s", r ? "" : error.text);
  eo_recording_free(r);
  double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
  ok(seconds < 10, "and that takes no longer than files of this size do: %.3g s", seconds);
}

/* Each encoder with its own group and times: the layout brings them together. */
static void test_layout(void)
{
  static unsigned char bytes[2][ROWS][16];
  begin_file("MDF     ", "4.10    ", 0);
  struct channel c[] = {{"t", NULL, MASTER, FLOATING, 0, 0, 64, 0, 0, 0, 0},
                        {"", "deg", VALUE, FLOATING, 8, 0, 64, 0, 0, 0, 0}};
  uint64_t root = 0;
  for (int g = 1; g >= 0; g--) {
    for (int i = 0; i < ROWS; i++) {
      double t = (g ? 3e-4 : 2.5e-4) * i + (g ? 1e-4 : 0), angle = 3600 * t * (g ? -17.0 / 44 : 1);
      memcpy(bytes[g][i], &t, 8);
      memcpy(bytes[g][i] + 8, &angle, 8);
    }
    c[1].name = g ? "gear" : "pinion";
    uint64_t data = put_data(bytes[g][0], sizeof bytes[g], 2, 16);
    root = put_data_group(root, put_group(0, put_channels(c, 2), NULL, 0, ROWS, 0, 16, 0), data, 0);
  }
  end_file(root);
  struct eo_error error;
  struct eo_tracks tracks;
  struct eo_layout_pair pair = {.teeth = {17, 44}};
  struct eo_recording *r = read_fixture(&spooled, NULL, &error);
  enum eo_code code = r ? eo_layout_find(&r, NULL, &pair, NULL, &tracks, NULL, &error) : error.code;
  int right = !code;
  for (int i = 10; right && i < 2000; i += 13)
    right = fabs(cell_of(r, i, 2) + cell_of(r, i, 1) * 17 / 44) < 1e-7 * 360;
  ok(right, "two encoders with times of their own come onto one clock: %s", code ? error.text : "on one clock");
  eo_recording_free(r);
}

/* Every byte of a small file is set to other values: an error or a recording, and nothing else (sanitizers watch). */
static void test_every_byte(void)
{
  static const unsigned char values[] = {0, 1, 0x7f, 0x80, 0xff};
  int read = 0, failed = 0;
  for (int packing = 0; packing < 3; packing++) {
    begin_file("MDF     ", "4.10    ", 0);
    uint64_t data = put_data(records, 20 * RECORD, packing, RECORD);
    data = put_list(1, &data, 0);
    end_file(put_data_group(0, put_group(0, put_plain_channels(), "g", 0, 20, 0, RECORD, 0), data, packing ? 0 : 1));
    for (size_t i = 0; i < w.size; i += i % 5 ? 9 : 1)
      for (size_t k = 0; k < sizeof values; k++) {
        unsigned char old = w.bytes[i];
        w.bytes[i] = values[k];
        write_bytes(w.bytes, w.size);
        w.bytes[i] = old;
        struct eo_error error;
        struct eo_recording *r = read_fixture(packing ? &spooled : NULL, NULL, &error);
        read += r != NULL;
        failed += r == NULL;
        eo_recording_free(r);
      }
  }
  ok(read > 0 && failed > 0, "bytes set at random leave a recording or an error: %d files read, %d refused", read,
     failed);
}

int main(void)
{
  fixture_open();
  test_storages();
  test_columns();
  for (int number = 1; number <= 8; number *= 2)
    test_unsorted(number);
  test_integers();
  test_floats();
  test_conversions();
  test_facts();
  test_unfinished();
  test_damage();
  test_circle();
  test_costly();
  test_layout();
  test_every_byte();
  return fixture_close();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* memmem */
/* Universal files, data sets 58 and 58b: written here after the public description of the format. */
#include "support/byte-writer.h"
#include "support/reader-fixture.h"

#define COUNT 1000

static struct writer w;

__attribute__((format(printf, 1, 2))) static void put_line(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  w.size += (size_t)vsnprintf((char *)w.bytes + w.size, 200, format, arguments);
  va_end(arguments);
  put_bytes(&w, "\n", 1);
}

static double pinion(int i)
{
  return 17.5 + 0.625 * i;
}

static double gear(int i)
{
  return 63.25 - 0.25 * i;
}

/* The eleven lines behind the number of a data set. */
static void put_header(const char *title, int function, int type, int even)
{
  put_line("%s", title);
  put_line("NONE");
  put_line("06-May-24 10:00:00");
  put_line("NONE");
  put_line("NONE");
  put_line("%5d%10d%5d%10d %-10s%10d%4d %-10s%10d%4d", function, 0, 0, 0, "NONE", 12, 3, "NONE", 0, 0);
  put_line("%10d%10d%10d%13.5E%13.5E%13.5E", type, COUNT, even, even ? 0.5 : 0.0, even ? 5e-5 : 0.0, 0.0);
  put_line("%10d%5d%5d%5d %-20s %-20s", 17, 0, 0, 0, "Time", "s");
  put_line("%10d%5d%5d%5d %-20s %-20s", 0, 0, 0, 0, "Angle", "deg");
  put_line("%10d%5d%5d%5d %-20s %-20s", 0, 0, 0, 0, "NONE", "NONE");
  put_line("%10d%5d%5d%5d %-20s %-20s", 0, 0, 0, 0, "NONE", "NONE");
}

static double abscissa(int i)
{
  return 1e-4 * i + 1e-8 * i * i;
}

/* One data set of text; double precision with 4E20.12, single with 6E13.5, pairs when uneven. */
static void put_text_set(const char *title, double (*value)(int), int type, int even)
{
  put_line("    -1");
  put_line("    58");
  put_header(title, 1, type, even);
  int per_line = even ? (type == 4 ? 4 : 6) : (type == 4 ? 2 : 3);
  for (int i = 0; i < COUNT; i++) {
    if (!even)
      w.size += (size_t)sprintf((char *)w.bytes + w.size, "%13.5E", abscissa(i));
    w.size += (size_t)sprintf((char *)w.bytes + w.size, type == 4 ? "%20.12E" : "%13.5E", value(i));
    if ((i + 1) % per_line == 0 || i + 1 == COUNT)
      put_bytes(&w, "\n", 1);
  }
  put_line("    -1");
}

static void put_binary_set(const char *title, double (*value)(int), int type, int even, int big)
{
  int size = (type == 4 ? 8 : 4) + (even ? 0 : 4);
  put_line("    -1");
  put_line("%6d%c%6d%6d%12d%12d%6d%6d%12d%12d", 58, 'b', big ? 2 : 1, 2, 11, size * COUNT, 0, 0, 0, 0);
  put_header(title, 1, type, even);
  w.big = big;
  for (int i = 0; i < COUNT; i++) {
    if (!even)
      put_float(&w, abscissa(i));
    if (type == 4)
      put_double(&w, value(i));
    else
      put_float(&w, value(i));
  }
  put_line("    -1");
}

static struct eo_recording *read_back(struct eo_notes *notes, const char *what)
{
  struct eo_error error;
  write_bytes(w.bytes, w.size);
  struct eo_recording *r = read_fixture(NULL, notes, &error);
  ok(r != NULL, "records are read, %s%s%s", what, r ? "" : ": ", r ? "" : error.text);
  return r;
}

static void check_even(const char *what)
{
  struct eo_recording *r = read_back(NULL, what);
  int wrong = !r || eo_recording_columns(r) != 2 || eo_recording_rows(r) != COUNT;
  for (int i = 0; !wrong && i < COUNT; i++)
    wrong += cell_of(r, i, 0) != pinion(i) || cell_of(r, i, 1) != gear(i);
  ok(!wrong, "the values of the records are read");
  ok(r && eo_recording_clock(r, 0).interval == 5e-5 && eo_recording_clock(r, 0).start == 0.5 &&
         !strcmp(eo_recording_name(r, 0), "Pinion 12:3") && !strcmp(eo_recording_unit(r, 1), "deg"),
     "interval, start, name and unit of a record are read");
  eo_recording_free(r);
}

static void check_uneven(const char *what)
{
  struct eo_recording *r = read_back(NULL, what);
  int wrong = !r || eo_recording_columns(r) != 4 || eo_recording_rows(r) != COUNT;
  for (int i = 0; !wrong && i < COUNT; i++)
    wrong += fabs(cell_of(r, i, 0) - abscissa(i)) > 1e-5 * abscissa(i) || cell_of(r, i, 1) != pinion(i) ||
             cell_of(r, i, 3) != gear(i);
  ok(!wrong && eo_recording_clock(r, 1).column == 0 && eo_recording_clock(r, 3).column == 2 &&
         !strcmp(eo_recording_name(r, 0), "time") && !strcmp(eo_recording_unit(r, 0), "s"),
     "each uneven set has a column of time and its values");
  eo_recording_free(r);
}

static void test_text(void)
{
  w.size = 0;
  put_line("    -1");
  put_line("   151");
  put_line("a header of the file, passed over");
  put_line("    -1");
  put_text_set("Pinion", pinion, 4, 1);
  put_text_set("Gear", gear, 4, 1);
  check_even("text, double, even");
  w.size = 0;
  put_text_set("Pinion", pinion, 2, 1);
  put_text_set("Gear", gear, 2, 1);
  check_even("text, single, even");
  w.size = 0;
  put_text_set("Pinion", pinion, 4, 0);
  put_text_set("Gear", gear, 4, 0);
  check_uneven("text, double, uneven");
  w.size = 0;
  put_text_set("Pinion", pinion, 2, 0);
  put_text_set("Gear", gear, 2, 0);
  check_uneven("text, single, uneven");
}

static void test_binary(void)
{
  for (int big = 0; big < 2; big++)
    for (int type = 2; type <= 4; type += 2) {
      w.size = 0;
      put_binary_set("Pinion", pinion, type, 1, big);
      put_binary_set("Gear", gear, type, 1, big);
      check_even(big ? "binary, even, big-endian" : "binary, even, little-endian");
      w.size = 0;
      put_binary_set("Pinion", pinion, type, 0, big);
      put_binary_set("Gear", gear, type, 0, big);
      check_uneven(big ? "binary, uneven, big-endian" : "binary, uneven, little-endian");
    }
  w.size = 0;
  put_text_set("Pinion", pinion, 4, 1);
  put_binary_set("Gear", gear, 4, 1, 0);
  check_even("text and binary in one file");
}

static void replace(const char *from, const char *to)
{
  unsigned char *at = memmem(w.bytes, w.size, from, strlen(from));
  if (!at || strlen(from) != strlen(to))
    exit(97);
  memcpy(at, to, strlen(to));
  write_bytes(w.bytes, w.size);
}

/* Writers state no number of bytes, or forget those of the abscissa: the number of values and the end tell. */
static void test_miscounted(int even, int counted)
{
  char stated[16], miscounted[16];
  snprintf(stated, sizeof stated, "%12d", (even ? 8 : 12) * COUNT);
  snprintf(miscounted, sizeof miscounted, "%12d", counted);
  w.size = 0;
  put_binary_set("Pinion", pinion, 4, even, 0);
  put_binary_set("Gear", gear, 4, even, 0);
  replace(stated, miscounted);
  replace(stated, miscounted);
  if (even)
    check_even("binary, even, bytes miscounted");
  else
    check_uneven("binary, uneven, bytes miscounted");
}

static void test_faults(void)
{
  struct eo_notes notes = {0};
  w.size = 0;
  put_text_set("Pinion", pinion, 4, 1);
  put_text_set("Spectrum", gear, 4, 1);
  unsigned char *at = memmem(w.bytes, w.size, "Spectrum", 8);
  memcpy(memmem(at, w.size - (size_t)(at - w.bytes), "    1         0    0", 20), "   12", 5);
  struct eo_recording *r = read_back(&notes, "a spectrum beside a record");
  ok(r && eo_recording_columns(r) == 1 && noted(&notes, "1 data set that is no real record"),
     "a spectrum beside a record is left out");
  eo_recording_free(r);
  w.size = 0;
  put_text_set("Pinion", pinion, 4, 1);
  size_t whole = w.size;
  write_bytes(w.bytes, whole / 2);
  refused("ends in line", "a data set that is cut off");
  write_bytes(w.bytes, 300);
  refused("in the header of a data set", "a header that is cut off");
  replace(" 1.750000000000E+01", " 1.75OOOOOOOOOOE+01");
  refused("UFF: line 14, column 7: there is no number", "letters for digits");
  w.size = 0;
  put_text_set("Pinion", pinion, 4, 1);
  replace("      1000", "9999999999");
  refused("states 9999999999 values", "more values than bytes");
  w.size = 0;
  put_text_set("Pinion", pinion, 4, 1);
  replace("      1000", "      1001");
  refused("after 1000 of 1001 values", "one value too few");
  w.size = 0;
  put_binary_set("Pinion", pinion, 4, 1, 0);
  replace("        8000", "999999999999");
  refused("states 999999999999 bytes", "more bytes than the file has");
  w.size = 0;
  put_binary_set("Pinion", pinion, 4, 1, 0);
  replace("        8000", "        7000");
  replace("      1000", "      1001");
  refused("has 7000 bytes for 1001 values", "too few bytes for the values");
  w.size = 0;
  put_binary_set("Pinion", pinion, 4, 1, 0);
  replace("58b     1     2", "58b     1     3");
  refused("only IEEE is read", "numbers of another machine");
  w.size = 0;
  put_line("    -1");
  put_line("    15");
  put_line("    -1");
  write_bytes(w.bytes, w.size);
  refused("no channel with numbers", "a file without data set 58");
  w.size = 0;
  put_line("    -1");
  put_line("    58");
  memset(w.bytes + w.size, 'x', 5000);
  write_bytes(w.bytes, w.size + 5000);
  refused("line 3 is longer", "a line without end");
}

int main(void)
{
  fixture_open();
  test_text();
  test_binary();
  test_miscounted(1, 0);
  test_miscounted(0, 0);
  test_miscounted(1, 4 * COUNT);
  test_miscounted(0, 8 * COUNT);
  test_faults();
  return fixture_close();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Delimited text of the kinds rigs write: every way of separating, headers, gaps, faults with their place, gzip,
   limits. */
#include "support/reader-fixture.h"

#include <stdbool.h>
#include <zlib.h>

static const double expected[4][3] = {{0, 17.15407647, 63.02719913},
                                      {5e-5, 17.7542265, 63.25901205},
                                      {1e-4, 18.35439856, 63.49082088},
                                      {1.5e-4, 18.95457267, -63.72262965}};

/* Reads text that holds the table above and checks all of it. */
static struct eo_recording *table(const char *text, const char *what)
{
  struct eo_error error;
  write_text(text);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  int wrong = !r || eo_recording_columns(r) != 3 || eo_recording_rows(r) != 4;
  for (int row = 0; !wrong && row < 4; row++)
    for (int c = 0; c < 3; c++)
      wrong += cell_of(r, row, c) != expected[row][c];
  ok(!wrong, "a table is read, %s%s%s", what, r ? "" : ": ", r ? "" : error.text);
  return r;
}

static int named(const struct eo_recording *r, int column, const char *name, const char *unit)
{
  if (r && !strcmp(eo_recording_name(r, column), name) && !strcmp(eo_recording_unit(r, column), unit))
    return 1;
  if (r)
    printf("# column %d is \"%s\" in \"%s\"\n", column, eo_recording_name(r, column), eo_recording_unit(r, column));
  return 0;
}

static void test_ways(void)
{
  struct eo_recording *r =
      table("t_s,angle1_deg,angle2_deg\n0.000000,17.15407647,63.02719913\n0.000050,17.75422650,63.25901205\n"
            "0.000100,18.35439856,63.49082088\n0.000150,18.95457267,-63.72262965\n",
            "commas");
  ok(named(r, 0, "t", "s") && named(r, 1, "angle1", "deg") && named(r, 2, "angle2", "deg"),
     "names are read with units behind underscores");
  ok(r && eo_recording_line(r, 0) == 2 && eo_recording_line(r, 3) == 5, "the rows know their lines");
  eo_recording_free(r);
  r = table("Zeit;Winkel Ritzel;Winkel "
            "Rad\r\ns;\xb0;\xb0\r\n0,000000;17,15407647;63,02719913\r\n0,000050;17,75422650;63,25901205\r\n"
            "0,000100;18,35439856;63,49082088\r\n0,000150;18,95457267;-63,72262965\r\n",
            "semicolons, decimal comma, CRLF");
  ok(named(r, 1, "Winkel Ritzel", "\xc2\xb0"), "a row of units in Latin 1 is read");
  eo_recording_free(r);
  r = table("\xef\xbb\xbf\"Time [s]\"\t\"Pinion (deg)\"\t\"Gear "
            "(deg)\"\n0,0\t17,15407647\t63,02719913\n5e-5\t1,775422650E+01\t63,25901205\n"
            "1E-04\t18,35439856\t63,49082088\n1,5e-004\t18,95457267\t-63,72262965",
            "tabs, decimal comma, exponents, byte order mark, no last line end");
  ok(named(r, 0, "Time", "s") && named(r, 2, "Gear", "deg"), "quoted names with units in brackets are read");
  eo_recording_free(r);
  r = table("# rig 3, run 12\n# t   phi1   phi2\n# [s] [rad] [rad]\n   0.0  17.15407647   63.02719913 \n\n  5e-5 "
            "17.75422650 63.25901205\n"
            "% pause\n  1e-4\t18.35439856\t63.49082088\n// end\n  1.5e-4 18.95457267  -63.72262965\n",
            "blanks, comments, blank lines");
  ok(named(r, 0, "t", "s") && named(r, 1, "phi1", "rad"), "names and units are read from comments");
  ok(r && eo_recording_line(r, 0) == 4 && eo_recording_line(r, 1) == 6 && eo_recording_line(r, 2) == 8 &&
         eo_recording_line(r, 3) == 10,
     "rows between gaps know their lines");
  eo_recording_free(r);
  r = table("t,a,b\r0,17.15407647,63.02719913\r5e-5,17.75422650,63.25901205\r1e-4,18.35439856,63.49082088\r1.5e-4,18."
            "95457267,-63.72262965\r",
            "lines that end with CR alone");
  ok(r && eo_recording_line(r, 3) == 5, "lines that end with CR alone are counted");
  eo_recording_free(r);
  eo_recording_free(table("\"0\",\"17,15407647\",\"63,02719913\"\n\"0,00005\",\"17,7542265\",\"63,25901205\"\n"
                          "\"0,0001\",\"18,35439856\",\"63,49082088\"\n\"0,00015\",\"18,95457267\",\"-63,72262965\"\n",
                          "quoted cells with decimal commas"));
  eo_recording_free(
      table("t;a;b;\n0;17.15407647;63.02719913;\n5e-5;17.7542265;63.25901205;\n1e-4;18.35439856;63.49082088;\n"
            "1.5e-4;18.95457267;-63.72262965;;;\n",
            "separators behind the last cell"));
  eo_recording_free(table("0, 17.15407647, 63.02719913\n5e-5, 17.7542265, 63.25901205\n1e-4, 18.35439856, "
                          "63.49082088\n1.5e-4, 18.95457267, -63.72262965\n",
                          "no header, commas and blanks"));
  r = table("Device;Rig 7\nChannels;3\nSample rate "
            "[Hz];20000\nDate;2024-05-06\n1;2;3\n\nt;date;a;b\n0;run 1;17.15407647;63.02719913\n"
            "5e-5;run 2;17.7542265;63.25901205\n1e-4;run 3;18.35439856;63.49082088\n1.5e-4;run 4;18."
            "95457267;-63.72262965\n",
            "a block of header, a column of text");
  ok(named(r, 1, "a", "") && r && fabs(eo_recording_clock(r, 0).interval - 5e-5) < 1e-18,
     "the sampling rate of the header is read");
  eo_recording_free(r);
}

static void test_one_column(void)
{
  struct eo_error error;
  write_text("pulse times\n0,0012\n0,0112\n0,0212\n0,0313\n");
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 1 && cell_of(r, 3, 0) == 0.0313, "one column with decimal commas is read");
  eo_recording_free(r);
  write_text("1,2\n3,4\n5,6\n");
  struct eo_reader_options options = {.text = {.point = ',', .separator = ';'}};
  r = read_fixture(&options, NULL, &error);
  ok(r && eo_recording_columns(r) == 1 && cell_of(r, 2, 0) == 5.6, "separator and point are taken as chosen");
  eo_recording_free(r);
  options = (struct eo_reader_options){.text = {.first_line = 3}};
  r = read_fixture(&options, NULL, &error);
  ok(r && eo_recording_rows(r) == 1 && cell_of(r, 0, 1) == 6, "the first row is taken as chosen");
  eo_recording_free(r);
  options.text.first_line = 30;
  ok(!read_fixture(&options, NULL, &error) && strstr(error.text, "line 30"), "a first row past the end is refused: %s",
     error.text);
}

/* rows lines of a table, the one at `odd` replaced. */
static void write_rows(int rows, int odd, const char *line)
{
  FILE *file = fopen(fixture_path, "w");
  fputs("t,a,b\n", file);
  for (int i = 0; i < rows; i++)
    if (i == odd)
      fprintf(file, "%s\n", line);
    else
      fprintf(file, "%d,%d.5,%d.25\n", i, i, 2 * i);
  fclose(file);
}

static void test_odd_row(const char *line, const char *words, int missing)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  write_rows(10000, 6000, line);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  int found = 0;
  for (int c = 0; r && c < 3; c++)
    found += isnan(cell_of(r, 6000, c)) != 0;
  ok(r && eo_recording_rows(r) == 10000 && found == missing && cell_of(r, 6001, 2) == 12002.25 &&
         eo_recording_line(r, 6001) == 6003,
     "the row \"%s\" misses %d cells, and the rows around it none", line, missing);
  if (words)
    ok(noted(&notes, words), "the notes say \"%s\"", words);
  eo_recording_free(r);
}

static void test_faults(void)
{
  test_odd_row("6000,,12000.25", "1 cell is without a number, the first in line 6002, column 2", 1);
  test_odd_row("6000,NaN,n/a", "2 cells are without a number, the first in line 6002, column 2", 2);
  test_odd_row("6000,6000.5,", "line 6002, column 3", 1);
  test_odd_row("6000,ERR,12000.25", "Line 6002, column 2: \"ERR\" is not a number", 1);
  test_odd_row("6000,6000.5", "Line 6002, column 3: the row has 2 cells instead of 3", 3);
  test_odd_row("6000,6000.5,12000.25,7", "Line 6002, column 4: the row has at least 4 cells instead of 3", 3);
  test_odd_row("6000,1e999,12000.25", NULL, 1);
  struct eo_error error;
  struct eo_notes notes = {0};
  write_rows(10000, 20, "20,x,40.25");
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_rows(r) == 10000 && noted(&notes, "Line 22, column 2"),
     "an odd row near the start does not hide the rows before it");
  eo_recording_free(r);
  write_text("t,a\n0,1\n1,2\n2,3\n3,4\n4");
  notes.count = 0;
  r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_rows(r) == 4 && noted(&notes, "line 6, is cut off"), "a last row that is cut off is left out");
  eo_recording_free(r);
  FILE *file = fopen(fixture_path, "w");
  for (int i = 0; i < 5000; i++)
    fprintf(file, i < 4000 || i % 2 ? "%d,%d\n" : "%d,overflow\n", i, i);
  fclose(file);
  refused("Line 4103, column 2: \"overflow\" is not a number; that makes 52 such rows", "too many odd rows");
}

/* What spreadsheets call Unicode text: two bytes a character. */
static void test_wide(void)
{
  static const char text[] = "t\ta\n0\t1.5\n1\t2.5\n2\t-3.5\n";
  struct eo_error error;
  for (int way = 0; way < 4; way++) {
    char wide[2 * sizeof text + 2];
    size_t n = 0;
    bool big = way & 1, mark = way < 2;
    if (mark) {
      wide[n++] = (char)(big ? 0xfe : 0xff);
      wide[n++] = (char)(big ? 0xff : 0xfe);
    }
    for (size_t i = 0; i + 1 < sizeof text; i++) {
      wide[n++] = (char)(big ? 0 : text[i]);
      wide[n++] = (char)(big ? text[i] : 0);
    }
    write_bytes(wide, n);
    struct eo_recording *r = read_fixture(NULL, NULL, &error);
    ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == -3.5 && named(r, 1, "a", ""),
       "UTF-16 is read, %s byte first, %s mark%s%s", big ? "high" : "low", mark ? "with" : "without", r ? "" : ": ",
       r ? "" : error.text);
    eo_recording_free(r);
  }
}

/* A pair of UTF-16 whose halves stand on both sides of the 4096 bytes that are taken at once, then the widest letters
   that there are. */
static void test_wide_pair(void)
{
  static const char table[] = "\nt\ta\n0\t1.5\n1\t2.5\n2\t-3.5\n";
  static unsigned char wide[3 * 4096];
  struct eo_error error;
  size_t n = 0, units = 4096;
  for (size_t i = 0; i < units; i++) {
    unsigned letter = i == 0 ? 0xfeff : i == 1 ? '#' : i < units / 2 - 1 ? ' ' : i == units / 2 - 1 ? 0xd83d : 0x20ac;
    letter = i == units / 2 ? 0xde00 : letter;
    wide[n++] = (unsigned char)letter;
    wide[n++] = (unsigned char)(letter >> 8);
  }
  for (size_t i = 0; i + 1 < sizeof table; i++) {
    wide[n++] = (unsigned char)table[i];
    wide[n++] = 0;
  }
  write_bytes(wide, n);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == -3.5, "UTF-16 with a pair between two blocks%s",
     r ? "" : error.text);
  eo_recording_free(r);
}

static void test_refusals(void)
{
  write_text("");
  refused("empty", "an empty file");
  write_text("Dear colleague,\nplease find attached the measurement.\n");
  refused("No table of numbers", "a letter");
  write_bytes("\x01\x02\x03\0\0\0\0\0\0\0\0\0", 12);
  refused("byte 3 is 0", "a binary file of no kind");
  write_text("PAR1 and more");
  refused("Parquet", "a table of another kind");
  FILE *file = fopen(fixture_path, "w");
  for (int i = 0; i < 1000; i++)
    fprintf(file, "%d,%d\n", i, i);
  for (int i = 0; i < 1500000; i++)
    fputc('1', file);
  fclose(file);
  refused("Line 1001 is longer than the 1024 kB", "an endless line");
  file = fopen(fixture_path, "w");
  for (int row = 0; row < 10; row++)
    for (int i = 0; i < 300; i++)
      fprintf(file, "%d%s", i, i < 299 ? "," : "\n");
  fclose(file);
  refused("300 cells", "too many columns");
  struct eo_error error;
  struct eo_recording *r = NULL;
  ok(eo_reader_read("/nonexistent/file", NULL, &r, NULL, &error) == EO_ERROR_FILE && !r,
     "a file that is not there is refused: %s", error.text);
  ok(eo_reader_read(fixture_directory, NULL, &r, NULL, &error) == EO_ERROR_FILE && !r, "a folder is refused: %s",
     error.text);
  struct eo_reader_options options = {.max_bytes = 1000000};
  write_rows(200000, -1, "");
  ok(!read_fixture(&options, NULL, &error) && strstr(error.text, "more than the 0 MB"),
     "a file beyond the limit is refused: %s", error.text);
}

static int stop(void *context, const char *what, double fraction)
{
  double *last = context;
  (void)what;
  ok(fraction >= *last && fraction <= 1, "the progress ascends to %.2f", fraction);
  *last = fraction;
  return fraction > 0.5;
}

static void test_progress(void)
{
  struct eo_error error;
  double last = 0;
  struct eo_progress progress = {stop, &last};
  struct eo_reader_options options = {.progress = &progress};
  write_rows(200000, -1, "");
  ok(!read_fixture(&options, NULL, &error) && error.code == EO_ERROR_CANCELLED && last > 0.5,
     "a reading that is cancelled ends so: %s", error.text);
}

static void write_gzip(const char *text, int times)
{
  gzFile file = gzopen(fixture_path, "wb9");
  for (int i = 0; i < times; i++)
    gzputs(file, text);
  gzclose(file);
}

static void test_gzip(void)
{
  struct eo_error error;
  write_gzip("0.5,1.25\n1.5,2.25\n", 100000);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_rows(r) == 200000 && cell_of(r, 199999, 1) == 2.25, "a gzip file is read");
  eo_recording_free(r);
  FILE *file = fopen(fixture_path, "ab");
  gzFile more = gzdopen(dup(fileno(file)), "ab");
  gzputs(more, "7,8\n");
  gzclose(more);
  fclose(file);
  r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_rows(r) == 200001 && cell_of(r, 200000, 1) == 8, "two gzip members after each other are read");
  eo_recording_free(r);
  ok(truncate(fixture_path, 1000) == 0 && refused("cut off", "a gzip file that is cut off"),
     "the gzip file is cut off and refused");
  unsigned char bytes[1000];
  file = fopen(fixture_path, "rb");
  size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  memset(bytes + 40, 0xff, 200);
  write_bytes(bytes, size);
  refused("damaged near byte", "a damaged gzip file");
  write_gzip("0000000,0000000\n0000000,0000000\n0000000,0000000\n0000000,0000000\n0000000,0000000\n0000000,0000000\n",
             1000000);
  refused("grows more than 200 times", "a gzip file that grows too much");
}

/* What Octave saves as text: its own sizes before each variable. */
static void test_octave(void)
{
  static const char first[] = "# Created by Octave 8.4.0, Tue Mar 05 08:59:59 2024 UTC <rig@lab>\n";
  struct eo_error error;
  char text[2000];
  snprintf(text, sizeof text,
           "%s# name: run\n# type: scalar struct\n# ndims: 2\n 1 1\n# length: 4\n"
           "# name: fs\n# type: scalar\n4000\n\n\n"
           "# name: unit\n# type: string\n# elements: 1\n# length: 3\ndeg\n\n\n"
           "# name: pinion\n# type: matrix\n# rows: 1\n# columns: 4\n 1 2 NaN 4\n\n\n"
           "# name: gear\n# type: cell\n# rows: 1\n# columns: 1\n"
           "# name: <cell-element>\n# type: int32 matrix\n# ndims: 3\n 1 4 1\n  5\n  6\n  7\n  8\n\n\n\n\n\n\n"
           "# name: t\n# type: range\n# base, limit, increment\n0 0.75 0.25\n\n\n"
           "# name: z\n# type: complex matrix\n# rows: 1\n# columns: 2\n (1,2) (3,4)\n\n\n",
           first);
  write_text(text);
  struct eo_notes notes = {0};
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_columns(r) == 3 && eo_recording_rows(r) == 4 && named(r, 0, "pinion", "deg") &&
         named(r, 1, "gear 1", "deg") && cell_of(r, 3, 0) == 4 && isnan(cell_of(r, 2, 0)) && cell_of(r, 3, 1) == 8,
     "the members of a struct of Octave are read with their unit%s", r ? "" : error.text);
  ok(r && fabs(eo_recording_clock(r, 0).interval - 2.5e-4) < 1e-12 && cell_of(r, 3, 2) == 0.75 &&
         eo_recording_clock(r, 0).column == 2 && noted(&notes, "1 variable is no channel"),
     "its rate and a range are read, and a note says what was left out");
  eo_recording_free(r);
  snprintf(text, sizeof text, "%s# name: both\n# type: matrix\n# rows: 3\n# columns: 2\n 1 4\n 2 5\n 3 6\n\n\n", first);
  write_text(text);
  r = read_fixture(NULL, NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && cell_of(r, 2, 0) == 3 && cell_of(r, 0, 1) == 4,
     "a matrix of Octave is read%s", r ? "" : error.text);
  eo_recording_free(r);
  text[strlen(text) - 7] = '\0';
  write_text(text);
  refused("\"both\" end early", "a matrix of Octave that is cut off");
  snprintf(text, sizeof text, "%s# name: t\n# type: range\n# base, limit, increment\n0 1e9 1e-9\n", first);
  write_text(text);
  refused("no channel", "a range without end");
  static char many[20000];
  size_t n = (size_t)sprintf(many, "%s", first);
  for (int i = 0; i < 200; i++)
    n += (size_t)sprintf(many + n, "# name: t%d\n# type: range\n# base, limit, increment\n0 9000 1\n", i);
  write_text(many);
  struct eo_notes left_out = {0};
  r = read_fixture(NULL, &left_out, &error);
  ok(r && eo_recording_columns(r) < 20 && noted(&left_out, "variables are no channel"),
     "ranges that are far longer than the file together%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* Seconds and nanoseconds count from the date that the seconds begin with, where 64 bits hold it in nanoseconds. */
static void test_dates_in_parts(void)
{
  static const double begins[] = {1.7e9, 9.5e9, 1e15};
  for (int k = 0; k < 3; k++) {
    char text[400];
    size_t n = (size_t)sprintf(text, "secs,nsecs,a\n");
    for (int i = 0; i < 8; i++)
      n += (size_t)sprintf(text + n, "%.0f,%d,%d\n", begins[k], 100000000 * i + 150000000, i);
    struct eo_error error;
    write_text(text);
    struct eo_recording *r = read_fixture(NULL, NULL, &error);
    int64_t epoch = r ? eo_recording_clock(r, 0).epoch : 0;
    ok(r && eo_recording_columns(r) == 2 && epoch == (k ? EO_CLOCK_NO_EPOCH : 1700000000000000000) &&
           fabs(cell_of(r, 7, 0) - (k ? begins[k] : 0) - 0.85) < 0.1,
       "seconds from %.3g on beside nanoseconds%s", begins[k], r ? "" : error.text);
    eo_recording_free(r);
  }
}

int main(void)
{
  fixture_open();
  test_ways();
  test_one_column();
  test_faults();
  test_wide();
  test_wide_pair();
  test_octave();
  test_dates_in_parts();
  test_refusals();
  test_progress();
  test_gzip();
  return fixture_close();
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Zip files and spreadsheets, made here byte by byte without compression. */
#include "support/reader-fixture.h"

#include <stdbool.h>
#include <zlib.h>

static unsigned char bytes[1 << 16];
static size_t size, directory_size;
static unsigned char directory[4096];
static int entries;

static void put(unsigned char *to, size_t *at, uint64_t value, int count)
{
  for (int i = 0; i < count; i++)
    to[(*at)++] = i < 8 ? (unsigned char)(value >> 8 * i) : 0;
}

/* A stored file: local header, name, content; and its line in the directory. */
static void add_bytes(const char *name, const void *content, size_t length)
{
  size_t at = size;
  uint32_t sum = (uint32_t)crc32(0, content, (unsigned)length);
  put(bytes, &size, 0x04034b50, 4);
  put(directory, &directory_size, 0x02014b50, 4);
  put(directory, &directory_size, 20, 2);
  for (int side = 0; side < 2; side++) {
    unsigned char *to = side ? directory : bytes;
    size_t *end = side ? &directory_size : &size;
    put(to, end, 20, 2);
    put(to, end, 0, 8); /* flags, method, time, date */
    put(to, end, sum, 4);
    put(to, end, length, 4);
    put(to, end, length, 4);
    put(to, end, strlen(name), 2);
    put(to, end, 0, 2);
  }
  put(directory, &directory_size, 0, 2 + 2 + 2 + 4);
  put(directory, &directory_size, at, 4);
  memcpy(directory + directory_size, name, strlen(name));
  directory_size += strlen(name);
  memcpy(bytes + size, name, strlen(name));
  size += strlen(name);
  memcpy(bytes + size, content, length);
  size += length;
  entries++;
}

static void add(const char *name, const char *content)
{
  add_bytes(name, content, strlen(content));
}

/* Ends the archive, whose bytes stay where they are until the next one begins. */
static size_t end_archive(void)
{
  size_t at = size;
  memcpy(bytes + size, directory, directory_size);
  size += directory_size;
  put(bytes, &size, 0x06054b50, 4);
  put(bytes, &size, 0, 4);
  put(bytes, &size, (uint64_t)entries, 2);
  put(bytes, &size, (uint64_t)entries, 2);
  put(bytes, &size, directory_size, 4);
  put(bytes, &size, at, 4);
  put(bytes, &size, 0, 2);
  size_t length = size;
  size = directory_size = 0;
  entries = 0;
  return length;
}

static void finish(void)
{
  write_bytes(bytes, end_archive());
}

/* Puts the archive that is being made into a new one. */
static void nest(const char *name)
{
  static unsigned char inner[sizeof bytes];
  size_t length = end_archive();
  memcpy(inner, bytes, length);
  add_bytes(name, inner, length);
}

/* A file of a tape archive, behind what is there. */
static void add_tar(const char *name, const char *content)
{
  unsigned char *block = bytes + size;
  unsigned sum = 8 * ' ';
  memset(block, 0, 512 + (strlen(content) + 511) / 512 * 512 + 1024);
  snprintf((char *)block, 100, "%s", name);
  memcpy(block + 100, "0000644", 7);
  snprintf((char *)block + 124, 12, "%011o", (unsigned)strlen(content));
  block[156] = '0';
  memcpy(block + 257, "ustar\00000", 8);
  for (int i = 0; i < 512; i++)
    sum += block[i];
  snprintf((char *)block + 148, 8, "%06o", sum);
  memcpy(block + 512, content, strlen(content));
  size += 512 + (strlen(content) + 511) / 512 * 512;
}

static struct eo_recording *take(struct eo_notes *notes, struct eo_error *error)
{
  struct eo_reader_options options = {.spool_directory = fixture_directory};
  return read_fixture(&options, notes, error);
}

static void refuse(const char *words, const char *what)
{
  struct eo_error error;
  struct eo_recording *r = take(NULL, &error);
  ok(!r && strstr(error.text, words), "%s: %s", what, r ? "was read" : error.text);
  eo_recording_free(r);
}

static void test_zip(void)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  add("run/data.csv", "t;a\n0;1.5\n1;2.5\n2;3.5\n");
  add("__MACOSX/._data.csv", "x");
  finish();
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == 3.5 && noted(&notes, "run/data.csv"), "one file in a zip%s",
     r ? "" : error.text);
  eo_recording_free(r);
  add("README.txt", "Recorded on the rig in March.\n");
  add("pinion.csv", "t;deg\n0;1.5\n1;2.5\n2;3.5\n");
  add("gear.csv", "t;deg\n0.5;1\n1.5;2\n2.5;3\n3.5;4\n");
  finish();
  memset(&notes, 0, sizeof notes);
  r = take(&notes, &error);
  ok(r && eo_recording_columns(r) == 4 && eo_recording_rows(r) == 4 && isnan(cell_of(r, 3, 1)) &&
         cell_of(r, 3, 3) == 4 && strstr(eo_recording_name(r, 1), "pinion") &&
         strstr(eo_recording_name(r, 3), "gear") && eo_recording_clock(r, 3).column == 2 &&
         eo_recording_length(r, 1) == 3,
     "a file for each channel: side by side, each with its times%s", r ? "" : error.text);
  ok(noted(&notes, "\"README.txt\" in the archive was left out") && noted(&notes, "do not all state when they began"),
     "what was left out is said, and that each file may count from its own start");
  eo_recording_free(r);
  for (int run = 0; run < 2; run++) {
    char text[4096] = "t;pinion;gear\n", *end = text + strlen(text);
    for (int i = 0; i < 40; i++)
      end += sprintf(end, "%d;%d;%d\n", i, 44 * i + i % 3, 17 * i + i % 2);
    add(run ? "run2.csv" : "run1.csv", text);
  }
  finish();
  refuse("run1 (40 rows), run2 (40 rows)", "two recordings in a zip");
  add("t.npy", "x");
  finish();
  refuse("NumPy", "an archive of arrays");
  add("a.csv", "1;2\n3;4\n");
  finish();
  FILE *file = fopen(fixture_path, "r+");
  if (!file || fseek(file, 40, SEEK_SET) || fputc('9', file) == EOF || fclose(file))
    exit(99);
  refuse("cannot be read", "a wrong check sum");
}

static void is_run(const char *what)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == 3.5 && noted(&notes, "data.csv"), "%s%s", what,
     r ? "" : error.text);
  eo_recording_free(r);
}

static void test_inner(void)
{
  static const char run[] = "t;a\n0;1.5\n1;2.5\n2;3.5\n";
  add("data.csv", run);
  nest("run.zip");
  finish();
  is_run("a zip in a zip");
  add("data.csv", run);
  nest("a.zip");
  nest("b.zip");
  finish();
  refuse("in an archive in an archive", "and in another one");
  add_tar("folder/data.csv", run);
  write_bytes(bytes, size + 1024);
  is_run("a tar file");
  gzFile file = gzopen(fixture_path, "wb");
  if (!file || gzwrite(file, bytes, (unsigned)size + 1024) <= 0 || gzclose(file))
    exit(99);
  is_run("in gzip");
  bytes[148] ^= 1;
  write_bytes(bytes, size + 1024);
  size = 0;
  refuse("no known kind", "a tar file whose heading is damaged");
  add_tar("pinion.csv", "t;deg\n0;1.5\n1;2.5\n2;3.5\n");
  add_tar("gear.csv", "t;deg\n0;1\n1;2\n2;3\n");
  write_bytes(bytes, size + 1024);
  size = 0;
  struct eo_error error;
  struct eo_recording *r = take(NULL, &error);
  ok(r && eo_recording_columns(r) == 4 && cell_of(r, 2, 1) == 3.5 && cell_of(r, 2, 3) == 3,
     "a file for each channel in a tar file%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* What a small sheet states holds for the table on another one, before it or behind. */
static void test_facts_beside(int first)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  add("xl/workbook.xml", "<workbook><workbookPr/></workbook>");
  for (int i = 1; i <= 2; i++) {
    char name[40];
    snprintf(name, sizeof name, "xl/worksheets/sheet%d.xml", i);
    add(name, i == first
                  ? "<worksheet><sheetData><row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>Abtastrate</t></is></c>"
                    "<c r=\"B1\"><v>4</v></c><c r=\"C1\" t=\"inlineStr\"><is><t>kHz</t></is></c></row></sheetData>"
                    "</worksheet>"
                  : "<worksheet><sheetData><row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>Pinion [deg]</t></is></c>"
                    "<c r=\"B1\" t=\"inlineStr\"><is><t>Gear [deg]</t></is></c></row>"
                    "<row r=\"2\"><c r=\"A2\"><v>1</v></c><c r=\"B2\"><v>2</v></c></row>"
                    "<row r=\"3\"><c r=\"A3\"><v>3</v></c><c r=\"B3\"><v>4</v></c></row>"
                    "<row r=\"4\"><c r=\"A4\"><v>5</v></c><c r=\"B4\"><v>7</v></c></row></sheetData></worksheet>");
  }
  finish();
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == 7 && !strcmp(eo_recording_name(r, 1), "Gear"),
     "a sheet of facts %s the table: its rows%s", first == 1 ? "before" : "behind", r ? "" : error.text);
  ok(r && fabs(eo_recording_clock(r, 0).interval - 2.5e-4) < 1e-15, "and its rate");
  eo_recording_free(r);
}

static void test_workbook(void)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  add("xl/workbook.xml", "<workbook><workbookPr/></workbook>");
  add("xl/styles.xml",
      "<styleSheet><numFmts><numFmt numFmtId=\"170\" formatCode=\"yyyy-mm-dd hh:mm:ss.000\"/></numFmts>"
      "<cellStyleXfs><xf numFmtId=\"0\"/></cellStyleXfs><cellXfs><xf numFmtId=\"0\"/>"
      "<xf numFmtId=\"170\"/></cellXfs></styleSheet>");
  add("xl/sharedStrings.xml", "<sst><si><t>Zeit</t></si><si><r><t>Pinion </t></r><r><t>[deg]</t></r></si></sst>");
  add("xl/worksheets/sheet1.xml",
      "<worksheet><sheetData><row r=\"1\"><c r=\"A1\"><v>1</v></c></row></sheetData></worksheet>");
  add("xl/worksheets/sheet2.xml",
      "<worksheet><sheetData><row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c><c r=\"C1\" t=\"s\"><v>1</v></c></row>"
      "<row r=\"2\"><c r=\"A2\" s=\"1\"><v>45356.5</v></c><c r=\"C2\"><v>73.5</v></c></row>"
      "<row r=\"3\"><c r=\"A3\" s=\"1\"><v>45356.500005787</v></c><c r=\"C3\"><v>74.5</v></c></row>"
      "<row r=\"4\"><c r=\"A4\" s=\"1\"><v>45356.500011574</v></c><c r=\"B4\" t=\"e\"><v>#N/A</v></c>"
      "<c r=\"C4\"><v>7.55e1</v></c></row></sheetData></worksheet>");
  finish();
  struct eo_recording *r = take(&notes, &error);
  int last = r ? eo_recording_columns(r) - 1 : 0;
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, last) == 75.5 && fabs(cell_of(r, 1, 0) - 43200.5) < 1e-3 &&
         eo_recording_clock(r, 0).epoch == 1709596800000000000,
     "a workbook: the larger sheet, dates as dates%s", r ? "" : error.text);
  ok(r && !strcmp(eo_recording_name(r, last), "Pinion") && !strcmp(eo_recording_unit(r, last), "deg"),
     "and its heading");
  eo_recording_free(r);
}

static void test_opendocument(void)
{
  struct eo_error error;
  add("mimetype", "application/vnd.oasis.opendocument.spreadsheet");
  add("content.xml",
      "<office:document-content xmlns:office=\"o\" xmlns:table=\"t\" xmlns:text=\"x\"><table:table "
      "table:name=\"Daten\">"
      "<table:table-row><table:table-cell office:value-type=\"string\"><text:p>t [s]</text:p></table:table-cell>"
      "<table:table-cell office:value-type=\"string\"><text:p>a</text:p></table:table-cell></table:table-row>"
      "<table:table-row><table:table-cell office:value-type=\"float\" office:value=\"0\"><text:p>0,0</text:p>"
      "</table:table-cell><table:table-cell office:value-type=\"float\" office:value=\"1.25\"/></table:table-row>"
      "<table:table-row><table:table-cell table:number-columns-repeated=\"2\" office:value-type=\"float\" "
      "office:value=\"2.5\"/></table:table-row><table:table-row table:number-rows-repeated=\"1048000\">"
      "<table:table-cell table:number-columns-repeated=\"16384\"/></table:table-row></table:table>"
      "</office:document-content>");
  finish();
  struct eo_recording *r = take(NULL, &error);
  ok(r && eo_recording_rows(r) == 2 && cell_of(r, 0, 1) == 1.25 && cell_of(r, 1, 0) == 2.5 && cell_of(r, 1, 1) == 2.5,
     "an OpenDocument spreadsheet%s", r ? "" : error.text);
  eo_recording_free(r);
}

static void test_names(void)
{
  static const char *const kinds[][2] = {{"PAR1", "Parquet"},          {"FEA1", "Feather"},
                                         {"\x93NUMPY", "NumPy"},       {"|CF,2,1,1;", "imc FAMOS"},
                                         {"RIFF....WAVE", "WAV"},      {"SQLite format 3", "SQLite"},
                                         {"ARROW1", "Arrow"},          {"7z\xbc\xaf", "7z"},
                                         {"DEWESoft raw", "DEWESoft"}, {"DXD of version 7", "DEWESoft"}};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    write_text(kinds[i][0]);
    refuse(kinds[i][1], "a kind that is not read is called by its name");
  }
}

/* A sheet for each channel, called in the book as the files with the sheets are not: they come out side by side. */
static void test_sheets(bool workbook)
{
  static char content[60000];
  struct eo_error error;
  struct eo_notes notes = {0};
  char *end = content;
  if (workbook) {
    add("xl/workbook.xml", "<workbook><sheets><sheet name=\"pinion\" r:id=\"a\"/><sheet name=\"gear\" r:id=\"b\"/>"
                           "</sheets></workbook>");
    add("xl/_rels/workbook.xml.rels", "<Relationships><Relationship Id=\"b\" Target=\"worksheets/sheet1.xml\"/>"
                                      "<Relationship Id=\"a\" Target=\"worksheets/sheet2.xml\"/></Relationships>");
  } else
    add("mimetype", "application/vnd.oasis.opendocument.spreadsheet");
  for (int sheet = 1; sheet <= 2; sheet++) {
    end = workbook ? content : end;
    end += sprintf(end, workbook ? "<worksheet><sheetData>" : "<table:table table:name=\"%s\">",
                   sheet == 1 ? "gear" : "pinion");
    for (int i = 0; i < 110; i++)
      end += sprintf(end,
                     workbook ? "<row><c><v>%d.5</v></c><c><v>%d</v></c></row>"
                              : "<table:table-row><table:table-cell office:value-type=\"float\" office:value=\"%d.5\"/>"
                                "<table:table-cell office:value-type=\"float\" office:value=\"%d\"/></table:table-row>",
                     i, (sheet == 1 ? 17 : 44) * i + i % 3);
    end += sprintf(end, workbook ? "</sheetData></worksheet>" : "</table:table>");
    if (workbook)
      add(sheet == 1 ? "xl/worksheets/sheet1.xml" : "xl/worksheets/sheet2.xml", content);
  }
  if (!workbook) {
    memmove(content + 5, content, (size_t)(end - content));
    memcpy(content, "<doc>", 5);
    snprintf(end + 5, 8, "</doc>");
    add("content.xml", content);
  }
  finish();
  struct eo_recording *r = take(&notes, &error);
  bool right = r && eo_recording_columns(r) == 4 && eo_recording_rows(r) == 110;
  for (int c = 1; right && c < 4; c += 2)
    right = cell_of(r, 109, c) == 109 * (strstr(eo_recording_name(r, c), "pinion") ? 44 : 17) + 1 &&
            eo_recording_clock(r, c).column == c - 1;
  ok(right && strcmp(eo_recording_name(r, 1), eo_recording_name(r, 3)) != 0, "a sheet for each channel, %s%s%s",
     workbook ? "in a workbook" : "in an OpenDocument spreadsheet", r ? "" : ": ", r ? "" : error.text);
  eo_recording_free(r);
}

int main(void)
{
  fixture_open();
  test_zip();
  test_inner();
  test_workbook();
  test_facts_beside(1);
  test_facts_beside(2);
  test_opendocument();
  test_sheets(true);
  test_sheets(false);
  test_names();
  return fixture_close();
}

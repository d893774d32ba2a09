/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Workbooks and OpenDocument spreadsheets, made here cell by cell. */
#include "support/archive-fixture.h"

static const char *const book_kind[] = {"a workbook", "an OpenDocument spreadsheet"};

/* A cell of either kind: a number, a text, or a formula that was never computed. */
static char *put_cell(char *to, bool workbook, int column, const char *cell, int length)
{
  bool formula = *cell == '=', number = strspn(cell, "0123456789.-") >= (size_t)length;
  const char *form = workbook  ? number    ? "<c r=\"%c1\"><v>%.*s</v></c>"
                                 : formula ? "<c r=\"%c1\"><f>%.*s</f><v/></c>"
                                           : "<c r=\"%c1\" t=\"inlineStr\"><is><t>%.*s</t></is></c>"
                     : !length ? "<table:table-cell table:style-name=\"%c\"/>"
                     : number  ? "<table:table-cell x=\"%c\" office:value-type=\"float\" office:value=\"%.*s\"/>"
                     : formula ? "<table:table-cell x=\"%c\" table:formula=\"of:%.*s\"/>"
                               : "<table:table-cell x=\"%c\" office:value-type=\"string\"><text:p>%.*s</text:p>"
                                 "</table:table-cell>";
  return workbook && !length ? to : to + sprintf(to, form, 'A' + column, length, cell);
}

/* Rows as lines, cells parted by semicolons. */
static char *put_rows(char *to, bool workbook, const char *rows)
{
  while (*rows) {
    to += sprintf(to, workbook ? "<row>" : "<table:table-row>");
    for (int column = 0; *rows && *rows != '\n'; column++) {
      int length = (int)strcspn(rows, ";\n");
      to = put_cell(to, workbook, column, rows, length);
      rows += length + (rows[length] == ';');
    }
    rows += *rows == '\n';
    to += sprintf(to, workbook ? "</row>" : "</table:table-row>");
  }
  return to;
}

/* Two sheets, or one: the second has no rows. They are called "one" and "two". */
static const char *book_content(bool workbook, const char *one, const char *two)
{
  static char content[30000];
  const char *const rows[] = {one, two};
  char *end = content + sprintf(content, workbook ? "" : "<?xml version=\"1.0\"?>\n<office:document >");
  if (workbook) {
    add("xl/workbook.xml", "<workbook><sheets><sheet name=\"one\" r:id=\"a\"/><sheet name=\"two\" r:id=\"b\"/>"
                           "</sheets></workbook>");
    add("xl/_rels/workbook.xml.rels", "<Relationships><Relationship Id=\"a\" Target=\"worksheets/sheet1.xml\"/>"
                                      "<Relationship Id=\"b\" Target=\"worksheets/sheet2.xml\"/></Relationships>");
  }
  for (int i = 0; i < 2; i++) {
    end = workbook ? content : end + sprintf(end, "<table:table table:name=\"%s\">", i ? "two" : "one");
    end += workbook ? sprintf(end, "<worksheet><sheetData>") : 0;
    end = put_rows(end, workbook, rows[i]);
    end += sprintf(end, workbook ? "</sheetData></worksheet>" : "</table:table>");
    if (workbook)
      add(i ? "xl/worksheets/sheet2.xml" : "xl/worksheets/sheet1.xml", content);
  }
  sprintf(end, workbook ? "" : "</office:document>");
  return content;
}

static void write_book(bool workbook, const char *one, const char *two)
{
  const char *content = book_content(workbook, one, two);
  if (!workbook)
    add("content.xml", content);
  finish();
}

/* What a small sheet states holds for the table on another one, before it or behind. */
static void test_facts_beside(bool workbook, bool first)
{
  static const char facts[] = "Abtastrate;4;kHz\n", table[] = "Pinion [deg];Gear [deg]\n1;2\n3;4\n5;7\n";
  const char *kind = book_kind[!workbook], *where = first ? "before" : "behind";
  struct eo_error error;
  struct eo_notes notes = {0};
  write_book(workbook, first ? facts : table, first ? table : facts);
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 3 && cell_of(r, 2, 1) == 7 && !strcmp(eo_recording_name(r, 1), "Gear"),
     "%s with a sheet of facts %s the table gives its rows%s", kind, where, r ? "" : error.text);
  ok(r && fabs(eo_recording_clock(r, 0).interval - 2.5e-4) < 1e-15,
     "the sampling rate is read from the sheet of facts");
  ok(noted(&notes, first ? "\"two\"" : "\"one\""), "the sheet is called by its name");
  eo_recording_free(r);
}

/* Spreadsheets do not store the empty cells behind the last one of a row. */
static void test_short_rows(bool workbook)
{
  char rows[2000] = "t1;pinion;t2;gear\n", *end = rows + strlen(rows);
  struct eo_error error;
  struct eo_notes notes = {0};
  for (int i = 0; i < 60; i++)
    end += i < 30 ? sprintf(end, "%d;%d;%d;%d\n", i, 44 * i + i % 3, i, 17 * i + i % 2)
                  : sprintf(end, "%d;%d\n", i, 44 * i + i % 3);
  write_book(workbook, rows, "");
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 60 && eo_recording_columns(r) == 4 && cell_of(r, 59, 1) == 2598 &&
         cell_of(r, 29, 3) == 494 && isnan(cell_of(r, 30, 3)) && !noted(&notes, "instead of 4"),
     "%s with a shorter table beside the first gives all rows of both%s", book_kind[!workbook], r ? "" : error.text);
  eo_recording_free(r);
  write_book(workbook, "Note;a;b;c;d\nx;1;2;3;4\ny;1;2;3;4\nt;deg\n0;1\n1;2\n2;4\n3;8\n4;16\n5;32\n6;64\n", "");
  r = take(NULL, &error);
  ok(r && eo_recording_rows(r) == 7 && eo_recording_columns(r) == 2, "a table below a wider one keeps its width%s",
     r ? "" : error.text);
  eo_recording_free(r);
  write_book(workbook, "Report;;;;;page 3\nt;pinion\ns;rad\n0;1\n1;2\n2;4\n3;8\n", "");
  r = take(NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && !strcmp(eo_recording_unit(r, 1), "rad"),
     "a title that stands far apart does not widen the table%s", r ? "" : error.text);
  eo_recording_free(r);
  write_book(workbook, "t;pinion;remark\ns;deg\n0;1\n1;2;knock\n2;4\n3;8;knock\n", "");
  r = take(NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && cell_of(r, 1, 1) == 2, "names without a unit below them widen the table%s",
     r ? "" : error.text);
  eo_recording_free(r);
}

/* Beside cells that are numbers, texts with a decimal comma are numbers, too; those with marks of thousands are not
   taken for them. */
static void test_comma_texts(bool workbook)
{
  struct eo_error error;
  write_book(workbook, "Zeit;Ritzel\n0;0,25\n0.5;1,5\n1;12,125\n1.5;3,75\n", "");
  struct eo_recording *r = take(NULL, &error);
  ok(r && eo_recording_columns(r) == 2 && cell_of(r, 1, 0) == 0.5 && cell_of(r, 0, 1) == 0.25 &&
         cell_of(r, 2, 1) == 12.125,
     "%s with numbers beside texts with a decimal comma is read%s", book_kind[!workbook], r ? "" : error.text);
  eo_recording_free(r);
  write_book(workbook, "t;Pinion\n0;1,250\n0.5;1,500\n1;12,125\n1.5;13,750\n", "");
  r = take(NULL, &error);
  ok(r && cell_of(r, 1, 0) == 0.5 && cell_of(r, 2, 1) == 12125, "texts with marks of thousands are read%s",
     r ? "" : error.text);
  eo_recording_free(r);
}

static void test_formulas(bool workbook)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  write_book(workbook, "i;deg;t\n0;1;=A2/4\n1;2;=A3/4\n2;3;=A4/4\n3;4;=A5/4\n", "");
  struct eo_recording *r = take(&notes, &error);
  ok(r && eo_recording_rows(r) == 4 &&
         noted(&notes, "4 cells of the sheet \"one\" hold formulas that were never computed") &&
         noted(&notes, "save it once"),
     "formulas without a value in %s are noted, with the remedy%s", book_kind[!workbook], r ? "" : error.text);
  eo_recording_free(r);
  write_book(workbook, "", "");
  refuse("No sheet of the spreadsheet holds anything", book_kind[!workbook]);
}

static void test_flat(void)
{
  struct eo_error error;
  write_text(book_content(false, "t;deg\n0;1\n1;2\n2;4\n3;8\n", ""));
  struct eo_recording *r = take(NULL, &error);
  ok(r && eo_recording_rows(r) == 4 && cell_of(r, 3, 1) == 8, "a flat OpenDocument spreadsheet is read%s",
     r ? "" : error.text);
  eo_recording_free(r);
  write_text("<?xml version=\"1.0\"?>\n<other/>\n");
  refuse("The file is XML", "another file of XML");
  add("[Content_Types].xml", "<Types/>");
  add("xl/workbook.bin", "x");
  finish();
  refuse("(.xlsb); open it", "a binary workbook");
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
     "a workbook is read: the larger sheet, dates as dates%s", r ? "" : error.text);
  ok(r && !strcmp(eo_recording_name(r, last), "Pinion") && !strcmp(eo_recording_unit(r, last), "deg"),
     "the heading of the larger sheet is read");
  eo_recording_free(r);
}

/* A cell's text is its paragraphs, not what somebody noted at it. */
static void test_noted_cells(void)
{
  struct eo_error error;
  add("content.xml",
      "<office:document-content xmlns:office=\"o\" xmlns:table=\"t\" xmlns:text=\"x\"><table:table table:name=\"one\">"
      "<table:table-row><table:table-cell office:value-type=\"string\"><text:p>time</text:p><text:p>[s]</text:p>"
      "</table:table-cell><table:table-cell office:value-type=\"string\"><office:annotation><text:p>of the "
      "gear?</text:p>"
      "</office:annotation><text:p>pinion<text:line-break/>angle</text:p></table:table-cell></table:table-row>"
      "<table:table-row><table:table-cell table:number-columns-repeated=\"2\" office:value-type=\"float\" "
      "office:value=\"2.5\"/></table:table-row></table:table></office:document-content>");
  finish();
  struct eo_recording *r = take(NULL, &error);
  ok(r && !strcmp(eo_recording_name(r, 0), "time") && !strcmp(eo_recording_name(r, 1), "pinion angle"),
     "headings with a note and of two lines: \"%s\", \"%s\"", r ? eo_recording_name(r, 0) : error.text,
     r ? eo_recording_name(r, 1) : "");
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
     "an OpenDocument spreadsheet is read%s", r ? "" : error.text);
  eo_recording_free(r);
}

/* A counter at rest: one row stands for many. */
static void test_repeated_rows(void)
{
  static const char *const times[] = {"3", "2000000000"};
  struct eo_error error;
  for (int hostile = 0; hostile < 2; hostile++) {
    char content[1000];
    snprintf(content, sizeof content,
             "<doc><table:table table:name=\"S\"><table:table-row><table:table-cell office:value-type=\"float\" "
             "office:value=\"7\"/></table:table-row><table:table-row table:number-rows-repeated=\"%s\">"
             "<table:table-cell office:value-type=\"float\" office:value=\"8\"/></table:table-row>"
             "<table:table-row><table:table-cell office:value-type=\"float\" office:value=\"9\"/></table:table-row>"
             "<table:table-row table:number-rows-repeated=\"1048000\"><table:table-cell/></table:table-row>"
             "</table:table></doc>",
             times[hostile]);
    add("content.xml", content);
    finish();
    if (hostile) {
      refuse("by being repeated", "a row that is repeated too often");
      continue;
    }
    struct eo_recording *r = take(NULL, &error);
    ok(r && eo_recording_rows(r) == 5 && cell_of(r, 3, 0) == 8 && cell_of(r, 4, 0) == 9,
       "a repeated row of an OpenDocument spreadsheet is as many rows%s", r ? "" : error.text);
    eo_recording_free(r);
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
  ok(right && strcmp(eo_recording_name(r, 1), eo_recording_name(r, 3)) != 0, "a sheet for each channel is read, %s%s%s",
     workbook ? "in a workbook" : "in an OpenDocument spreadsheet", r ? "" : ": ", r ? "" : error.text);
  eo_recording_free(r);
}

int main(void)
{
  fixture_open();
  test_workbook();
  test_opendocument();
  test_noted_cells();
  test_repeated_rows();
  test_sheets(true);
  test_sheets(false);
  for (int workbook = 0; workbook < 2; workbook++) {
    test_facts_beside(workbook, true);
    test_facts_beside(workbook, false);
    test_short_rows(workbook);
    test_comma_texts(workbook);
    test_formulas(workbook);
  }
  test_flat();
  return fixture_close();
}

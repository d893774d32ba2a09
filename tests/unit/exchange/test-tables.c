/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of designs: out and in again without loss, symbols, units, and what is asked instead of guessed. */
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "exchange/import.h"
#include "exchange/table_export.h"
#include "format/json.h"
#include "support/tap.h"

static struct eo_import read_table(const char *bytes, size_t size, int pair)
{
  const struct eo_import_options options = {.pair = pair};
  struct eo_import import;
  struct eo_error error;
  eo_import_read(&import, bytes, size, &options, &error);
  return import;
}

static json_t *example(const char *name)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  if (!eo_example_build(name, &design) || eo_design_complete(&design, &geometry, &error))
    printf("Bail out! example %s\n", name);
  return eo_design_encode(&design);
}

static json_t *decoded(const json_t *document)
{
  static struct eo_design design;
  static struct eo_faults faults;
  memset(&faults, 0, sizeof faults);
  if (!document || !eo_design_decode(document, &design, NULL, &faults))
    return NULL;
  return eo_design_encode(&design);
}

/* Two designs of different kinds in one file, each chosen. */
static void check_round_trip(enum eo_table_layout layout, const char *what)
{
  json_t *made[2] = {example("paper-case-b"), example("single")};
  struct eo_text text = {0};
  eo_table_write((const json_t *const *)made, 2, layout, &text);
  struct eo_import import = read_table(text.data, text.size, 0);
  ok(import.pairs == 2 && !import.design, "%s: the file has two designs, and a choice is asked for", what);
  eo_import_done(&import);
  for (int i = 0; i < 2; i++) {
    import = read_table(text.data, text.size, i + 1);
    json_t *found = decoded(import.design);
    ok(found && json_equal(found, made[i]), "%s: design %d comes back the same", what, i + 1);
    json_decref(found);
    eo_import_done(&import);
    json_decref(made[i]);
  }
  eo_text_done(&text);
}

static double number_in(const char *table, const char *path)
{
  struct eo_import import = read_table(table, strlen(table), 0);
  double value = eo_json_find_number(import.design, path);
  eo_import_done(&import);
  return value;
}

static bool is_faulty(const char *table, const char *kind, int line)
{
  struct eo_import import = read_table(table, strlen(table), 0);
  const struct eo_import_fault *fault = import.faults ? &import.fault[0] : NULL;
  bool right = !import.design && fault && strcmp(fault->kind, kind) == 0 && fault->line == line;
  if (!right)
    printf("# %s\n", fault ? fault->text : "no fault");
  eo_import_done(&import);
  return right;
}

#define HEAD "key;pinion;gear;unit\n"

static void check_symbols(void)
{
  static const char table[] = HEAD
      "z;17;44;\nm_n;6;;mm\nbeta;24;;°\nb;5,5;;m\nx;0,1;-0,1;\nC_a;14;9;um\nC_b;0,012;;mm\n"
      "a;8;;inch\nT;0,8;;kNm\nd;103;;mm\n";
  close_to(number_in(table, "gear_pair/gear_teeth"), 44, 0, "z of the gear, read from a table");
  close_to(number_in(table, "gear_pair/face_width_mm"), 5500, 0, "b in m with a decimal comma, mm");
  close_to(number_in(table, "gear_pair/gear_profile_shift"), -0.1, 0, "x of the gear, read from a table");
  close_to(number_in(table, "modification/pinion/right/tip_relief_um"), 14, 0,
           "C_a of the pinion, that of both ends, um");
  close_to(number_in(table, "modification/gear/left/tip_relief_um"), 9, 0, "C_a of the gear, read from a table, um");
  close_to(number_in(table, "modification/pinion/left/lead_crowning_um"), 12, 1e-12,
           "C_b in mm, read from a table, um");
  close_to(number_in(table, "gear_pair/centre_distance_mm"), 203.2, 1e-12, "a in inch, read from a table, mm");
  static const char spelt[] = HEAD "beta;24°30'36\";;\nC_a [um];14;;\nmodification.left.root_relief_um;0.5;;\n";
  close_to(number_in(spelt, "gear_pair/helix_angle_deg"), 24.51, 1e-12,
           "helix angle in degrees, minutes and seconds, deg");
  close_to(number_in(spelt, "modification/pinion/left/root_relief_um"), 0.5, 0,
           "value under a key that says its own unit");
  close_to(number_in("quantity;pinion;gear;unit\nz;21;86;\n", "gear_pair/gear_teeth"), 86, 0,
           "value beside a column of names with a head of its own");
  close_to(number_in("Sheet 7\nParameter;Value\nm_n [mm];4\n", "gear_pair/normal_module_mm"), 4, 0,
           "value under a head below a title, one column of values");
  close_to(number_in(";pinion;gear;unit\n\nz;21;86;\n", "gear_pair/gear_teeth"), 86, 0,
           "value of a table without a title");
  close_to(number_in("name;load_cases.1.driver;m_n [mm]\nvalue;pinion;4\n", "gear_pair/normal_module_mm"), 4, 0,
           "value of a table with a word of a head among its designs");
  static const char tabs[] = "key\tpinion\tunit\nz\t17\t\n";
  close_to(number_in(tabs, "gear_pair/pinion_teeth"), 17, 0, "value of a table between tabs");
  static const char wide[] = "name,gear_pair.pinion_teeth,m_n [mm],C_a\n\"a, b\",19,4,\n";
  close_to(number_in(wide, "gear_pair/normal_module_mm"), 4, 0, "value of a design as a row, between commas");
}

static void check_questions(void)
{
  ok(is_faulty(HEAD "z;17;44;\nC_a;0.1;;\n", "unit_needed", 3), "a relief of 0.1 that could be mm or um is refused");
  ok(is_faulty(HEAD "load_cases;\"[1, 2]\";;\nload_cases.1.torque_Nm;5;;\n", "contradiction", 3),
     "a number within a list of numbers is refused");
  ok(is_faulty(HEAD "load_cases;null;;\nload_cases.1.torque_Nm;5;;\n", "contradiction", 3),
     "a number within what is null is refused");
  ok(is_faulty(HEAD "optimization.bounds.root_relief_um.;\"[0, 5]\";;\n", "unknown_key", 2),
     "a key that ends in a point is refused");
  ok(is_faulty(HEAD "load_cases.+1.torque_Nm;5;;\n", "unknown_key", 2), "a row whose number has a sign is refused");
  ok(is_faulty(HEAD "C_a;14;;deg\n", "wrong_unit", 2), "a relief in degrees is refused");
  ok(is_faulty(HEAD "x;2;;mm\n", "wrong_unit", 2), "a profile shift in mm is refused");
  ok(is_faulty(HEAD "m_n;4.5;;\nb;40,5;;\n", "two_decimal_signs", 2), "points and commas in one table are refused");
  ok(is_faulty(HEAD "m_n;1.234,5;;\n", "two_decimal_signs", 2) || is_faulty(HEAD "m_n;1.234,5;;\n", "not_a_number", 2),
     "a point for thousands is refused");
  ok(is_faulty(HEAD "zz;17;;\n", "unknown_key", 2), "a symbol that is none is refused");
  ok(is_faulty(HEAD "m_n;6;5;mm\n", "one_value", 2), "a row of two modules is refused");
  ok(is_faulty(HEAD "z;21;86;\nm_n;4;;\nz;22;86;\n", "given_twice", 4),
     "a row that stands twice with different values is refused");
  ok(is_faulty(HEAD "a;200;;\na_w;201;;\n", "given_twice", 3), "a key under two symbols is refused");
  ok(is_faulty(HEAD "load_cases.1.torque_Nm;5;;\nload_cases;\"[]\";;\n", "given_twice", 3),
     "a list that would overrule what an earlier row put into it is refused");
  ok(is_faulty(HEAD "name;one;;\nz;17;44;\nname;two;;\n", "given_twice", 4), "a design of two names is refused");
  ok(is_faulty("m_n,m_n [mm]\n4,5\n", "given_twice", 2), "a column that stands twice with different values is refused");
  close_to(number_in(HEAD "z;21;86;\nz;21;86;\n", "gear_pair/gear_teeth"), 86, 0,
           "value of a row that stands twice alike");
  ok(is_faulty("key;pinion;wheel\nz;1;2\n", "unknown_column", 1), "a column that is none is refused");
  ok(is_faulty("Parameter;pinion;gear\nz;1;2\nHelix angle;28;\n", "unknown_key", 3),
     "a name that is no key is refused at its line");
  ok(is_faulty("m_n [mm];Helix angle\n4;28\n", "unknown_key", 1),
     "a head that is no key is refused at the line of heads");
  ok(is_faulty("Teeth;21;86\nModule;4;4\n", "no_design", 0), "a table without heads is refused once, not at each row");
  ok(is_faulty("m_n,C_a\n4,3\n", "member_needed", 2), "a row that does not say whose relief it is is refused");
  ok(is_faulty(HEAD "gear_pair.ends;two;;\n", "not_a_number", 2), "a number in words is refused");
}

static struct eo_import read_bytes(const char *bytes, size_t size)
{
  const struct eo_import_options options = {0};
  struct eo_import import;
  struct eo_error error;
  ok(eo_import_read(&import, bytes, size, &options, &error) == EO_OK, "a table of %zu bytes has an answer", size);
  return import;
}

/* What spreadsheets write that is no UTF-8: Latin 1 (CSV in Europe) and two bytes a character ("Unicode text"). */
static void check_encodings(void)
{
  static const char latin[] = HEAD "z;17;44;\nname;M\xFCller;;\nC_a;14;;\xB5m\n";
  char wide[2 * sizeof latin], big[2 * sizeof latin];
  size_t size = 0;
  for (const char *c = "\xFF" HEAD "z;17;44;\nname;M\xFCller;;\nC_a;14;;\xB5m\n"; *c; c++) {
    wide[size] = big[size + 1] = *c;
    wide[size + 1] = big[size] = 0;
    size += 2;
  }
  wide[1] = big[0] = (char)0xFE;
  wide[0] = big[1] = (char)0xFF;
  const struct {
    const char *bytes;
    size_t size;
  } files[] = {{latin, sizeof latin - 1}, {wide, size}, {big, size}};
  for (int i = 0; i < 3; i++) {
    struct eo_import import = read_bytes(files[i].bytes, files[i].size);
    const char *name = json_string_value(json_object_get(import.design, "name"));
    ok(name && strcmp(name, "M\xC3\xBCller") == 0, "a name with an umlaut is read from file %d", i + 1);
    ok(import.faults == 0, "micrometres with their sign are read from file %d", i + 1);
    eo_import_done(&import);
  }
  for (int i = 0; i < 2; i++) { /* bytes of no kind, below a heading and alone */
    static const char *const junk[] = {HEAD "\xFF\x80\xC3;1;2;\xE2\x82\n", "\x1F\x8B\x08\xED\xC1\x31"};
    struct eo_import import = read_bytes(junk[i], strlen(junk[i]));
    ok(!import.design && import.faults > 0, "bytes of no kind are refused with a sentence");
    eo_import_done(&import);
  }
  ok(is_faulty(HEAD "z;17;44;\n\"m_n;6;;\n", "not_readable", 0), "a quotation mark without its other is refused");
}

int main(void)
{
  check_encodings();
  check_round_trip(EO_TABLE_POINT, "points");
  check_round_trip(EO_TABLE_COMMA, "commas");
  check_round_trip(EO_TABLE_WORKBOOK, "workbook");
  check_round_trip(EO_TABLE_ROWS, "rows");
  check_symbols();
  check_questions();
  return tap_done();
}

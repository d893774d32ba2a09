/* SPDX-License-Identifier: GPL-3.0-or-later */
/* REXS out and in again: every example in every form and version, by the schema and without loss; the design that a
   file carries; hostile archives. What other programs' files mean is checked by the reference cases (verify). */
#include <archive.h>
#include <archive_entry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "exchange/import.h"
#include "exchange/rexs_export.h"
#include "exchange/rexs_read.h"
#include "exchange/rexs_schema.h"
#include "format/json.h"
#include "support/tap.h"

static struct eo_design design;
static struct eo_geometry geometry;

static void build(const char *name)
{
  struct eo_error error;
  if (!eo_example_build(name, &design) || eo_design_complete(&design, &geometry, &error))
    printf("Bail out! example %s\n", name);
}

/* Schema: */

static int faults;

static void count_fault(void *context, const struct eo_rexs_fault *fault)
{
  (void)context;
  faults++;
  printf("# %s: %s\n", fault->kind, fault->text);
}

/* Faults of the model, attributes that do not belong to their component or version, roles that no relation has. */
static int check_model(const struct eo_rexs_model *model, int version)
{
  faults = 0;
  eo_rexs_check(model, count_fault, NULL);
  for (int i = 0; i < model->components; i++)
    for (int k = 0; k < model->component[i].count; k++) {
      const struct eo_rexs_attribute *a = &model->component[i].attribute[k];
      const struct eo_rexs_rule *rule = eo_rexs_rule_of(a->id);
      bool right = rule && eo_rexs_rule_on(rule, model->component[i].type) &&
                   strcmp(a->unit, eo_rexs_unit_in(rule->unit, version)) == 0 &&
                   (rule->since <= version || strcmp(eo_rexs_attribute_today(a->id), a->id) != 0);
      faults += !right;
      if (!right)
        printf("# %s on %s\n", a->id, model->component[i].type);
    }
  for (int i = 0; i < model->relations; i++)
    for (int k = 0; k < model->relation[i].count; k++) {
      const struct eo_rexs_reference *r = &model->relation[i].reference[k];
      const struct eo_rexs_component *component = eo_rexs_find(model, r->id);
      const char *types;
      bool right = component &&
                   eo_rexs_role_judge(model->relation[i].type, r->role, component->type, &types) == EO_REXS_ROLE_RIGHT;
      faults += !right;
      if (!right)
        printf("# %s as %s of %s\n", component ? component->type : "nothing", r->role, model->relation[i].type);
    }
  return faults;
}

/* Round trip: */

static struct eo_text write_file(int version, enum eo_rexs_form form, bool with_design)
{
  struct eo_rexs_model model = {0};
  struct eo_text text = {0};
  eo_rexs_export(&design, &geometry, version, with_design, &model);
  eo_rexs_write(&model, form, &text);
  eo_rexs_done(&model);
  return text;
}

static struct eo_import read_file(const struct eo_text *text)
{
  const struct eo_import_options options = {0};
  struct eo_import import;
  struct eo_error error;
  eo_import_read(&import, text->data, text->size, &options, &error);
  return import;
}

/* Largest difference of two documents, relative above 1; what one has and the other not counts as 1. */
static double difference(const json_t *a, const json_t *b)
{
  const char *key;
  json_t *value;
  size_t i;
  double largest = 0;
  if (json_is_number(a) && json_is_number(b))
    return fabs(json_number_value(a) - json_number_value(b)) / fmax(1, fabs(json_number_value(a)));
  if (json_typeof(a) != json_typeof(b) || json_array_size(a) != json_array_size(b))
    return 1;
  json_object_foreach((json_t *)a, key, value)
  {
    const json_t *other = json_object_get(b, key);
    largest = fmax(largest, other ? difference(value, other) : 1);
  }
  json_array_foreach(a, i, value) largest = fmax(largest, difference(value, json_array_get(b, i)));
  return json_is_object(a) || json_is_array(a) || json_equal(a, b) ? largest : 1;
}

/* The import completed, as the document of a design; NULL: it is none. */
static json_t *complete(const json_t *document)
{
  static struct eo_design read;
  static struct eo_faults found;
  struct eo_geometry unused;
  struct eo_error error;
  memset(&found, 0, sizeof found);
  if (!document || !eo_design_decode(document, &read, NULL, &found) || eo_design_complete(&read, &unused, &error))
    return NULL;
  return eo_design_encode(&read);
}

static void check_round_trip(const char *name, int version, enum eo_rexs_form form)
{
  static const char *const forms[] = {"XML", "JSON", "zip"};
  struct eo_text text = write_file(version, form, true);
  struct eo_import import = read_file(&text);
  json_t *expected = eo_design_encode(&design), *found = complete(import.design);
  ok(found && json_equal(expected, found), "%s in REXS, %d, %s comes back as the same design", name, version,
     forms[form]);
  ok(import.faults == 0 && json_array_size(import.refused) == 0, "%s: no word of it is refused", name);
  json_decref(expected);
  json_decref(found);
  eo_import_done(&import);
  eo_text_done(&text);
}

/* As another program's file: what REXS has words for, without the design that the file carries. */
static void check_plain(const char *name, int version)
{
  static const char *const parts[] = {"gear_pair", "material", "shafts", "modification", "load_cases"};
  struct eo_text text = write_file(version, EO_REXS_XML, false);
  struct eo_import import = read_file(&text);
  json_t *expected = eo_design_encode(&design), *found = complete(import.design);
  json_object_del(json_object_get(expected, "shafts"), "enabled");
  json_object_del(json_object_get(expected, "gear_pair"), "rim_thickness_coefficient");
  json_object_del(json_object_get(expected, "gear_pair"), "tip_alteration_coefficient"); /* the tip diameters say it */
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    close_to(found ? difference(json_object_get(expected, parts[i]), json_object_get(found, parts[i])) : 1, 0, 1e-9,
             parts[i]);
  ok(strstr(text.data, "custom_easeoff_design") == NULL, "%s is written in REXS's own words", name);
  json_decref(expected);
  json_decref(found);
  eo_import_done(&import);
  eo_text_done(&text);
}

static void check_design(const char *name)
{
  static const int versions[] = {100, 102, 104, 107, 200};
  for (size_t i = 0; i < sizeof versions / sizeof *versions; i++) {
    struct eo_rexs_model model = {0};
    eo_rexs_export(&design, &geometry, versions[i], true, &model);
    ok(check_model(&model, versions[i]) == 0,
       "%s in REXS %s keeps to types, units, ranges, words and roles of the schema", name, model.version);
    eo_rexs_done(&model);
  }
  for (int form = 0; form < 3; form++) {
    check_round_trip(name, EO_REXS_EXPORT_VERSION, (enum eo_rexs_form)form);
    check_round_trip(name, 200, (enum eo_rexs_form)form);
  }
  check_plain(name, EO_REXS_EXPORT_VERSION);
}

/* Hand and apex in REXS's own words, shafts that are no mirror image of themselves beside them. */
static void check_hands(void)
{
  static const char *const hands[2] = {"left", "right"}, *const names[2] = {"paper-case-b", "single"};
  for (int i = 0; i < 8; i++) {
    struct eo_error error;
    if (!eo_example_build(names[i & 1], &design))
      printf("Bail out! example\n");
    snprintf(design.gear_pair.hand, sizeof design.gear_pair.hand, "%s", hands[i >> 1 & 1]);
    design.alignment.apex = (enum eo_apex)(i >> 2);
    design.shafts.bearing_position[EO_PINION][EO_LEFT] = -0.17;
    design.shafts.bearing_position[EO_PINION][EO_RIGHT] = 0.21;
    design.modification.flank[EO_PINION][EO_LEFT].helix_slope = 9e-6;
    if (eo_design_complete(&design, &geometry, &error))
      printf("Bail out! %s\n", error.text);
    struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, false);
    struct eo_import import = read_file(&text);
    json_t *found = complete(import.design), *expected = eo_design_encode(&design);
    ok(found && json_equal(eo_json_find(found, "gear_pair/hand"), eo_json_find(expected, "gear_pair/hand")) &&
           json_equal(eo_json_find(found, "alignment/apex"), eo_json_find(expected, "alignment/apex")),
       "%s with %s hand and apex %d comes back as it was", names[i & 1], hands[i >> 1 & 1], i >> 2);
    static const char *const parts[] = {"shafts/pinion_left_bearing_mm", "shafts/pinion_right_bearing_mm",
                                        "modification/pinion/left/helix_slope_um"};
    for (int k = 0; k < 3; k++)
      close_to(eo_json_find_number(found, parts[k]), eo_json_find_number(expected, parts[k]), 1e-9, parts[k]);
    json_decref(found);
    json_decref(expected);
    eo_import_done(&import);
    eo_text_done(&text);
  }
}

static bool says(const json_t *list, const char *text)
{
  const json_t *entry;
  size_t i;
  json_array_foreach(list, i, entry) if (strstr(json_string_value(entry), text)) return true;
  return false;
}

/* Another program has changed the model: what the file carries no longer holds. */
static void check_edited(void)
{
  build("paper-case-b");
  struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, true);
  char *depth = strstr(text.data, ">0.013");
  if (!ok(depth != NULL, "the relief of 13 um is written to the file"))
    return;
  memcpy(depth, ">0.015", 6);
  struct eo_import import = read_file(&text);
  const json_t *flank = json_object_get(
      json_object_get(json_object_get(json_object_get(import.design, "modification"), "pinion"), "left"),
      "tip_relief_um");
  ok(says(import.notes, "says something else by now"),
     "the design inside a file is not taken once the file was edited");
  close_to(json_number_value(flank), 15, 1e-9, "relief of an edited file, um");
  eo_import_done(&import);
  eo_text_done(&text);
}

/* Every pair that another program can state: unequal halves, own widths and materials, protuberance, stock, chamfer,
   end reliefs of every shape on a member that is wider than the common face. */
static void build_stranger(int ends)
{
  static const enum eo_relief_shape shapes[] = {EO_RELIEF_LINEAR, EO_RELIEF_PARABOLIC, EO_RELIEF_CIRCULAR};
  struct eo_error error;
  eo_example_build(ends == 2 ? "narrow" : "single", &design);
  struct eo_gear_pair *pair = &design.gear_pair;
  pair->member_width[EO_PINION] = pair->face_width + 5e-3;
  pair->right_face_width = ends == 2 ? 0.75 * pair->face_width : NAN;
  pair->right_helix_angle = ends == 2 ? 1.1 * pair->helix_angle : NAN;
  pair->tip_chamfer[EO_GEAR] = 0.1e-3;
  pair->protuberance[EO_PINION] = 60e-6;
  pair->grinding_stock[EO_PINION] = 65e-6;
  design.material.gear_youngs_modulus = 175e9;
  for (int end = 0; end < ends; end++)
    for (int member = 0; member < 2; member++) {
      struct eo_flank_modification *flank = &design.modification.flank[member][end];
      flank->end_relief[0] = 9e-6;
      flank->end_relief_length[0] = 3e-3;
      flank->end_shape[0] = shapes[member + end];
      flank->lead_offset = 2e-6;
    }
  if (eo_design_complete(&design, &geometry, &error))
    printf("Bail out! a pair of a stranger: %s\n", error.text);
}

/* A program that writes every attribute leaves empty what its model does not state. */
static void check_empty(void)
{
  build("single");
  struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, false);
  char *value = strstr(text.data, "\"minimum_normal_backlash\"");
  value = value ? strchr(value, '>') : NULL;
  if (!ok(value != NULL, "the backlash is written to the file"))
    return;
  char *end = strchr(value, '<');
  memmove(value + 1, end, strlen(end) + 1);
  text.size -= (size_t)(end - value - 1);
  struct eo_import import = read_file(&text);
  ok(import.design && import.faults == 0, "an attribute without a value is not stated");
  ok(says(import.notes, "minimum_normal_backlash has no value"), "an attribute without a value is named");
  eo_import_done(&import);
  eo_text_done(&text);
}

/* The file of a design with one text of it replaced; false: it is not there. */
static bool replace(struct eo_text *text, const char *old, const char *new)
{
  char *at = strstr(text->data, old);
  if (!ok(at != NULL, "the file holds the text to be edited: %s", old))
    return false;
  struct eo_text made = {0};
  eo_text_print(&made, "%.*s%s%s", (int)(at - text->data), text->data, new, at + strlen(old));
  eo_text_done(text);
  *text = made;
  return true;
}

/* A name of any length stands in the list of pairs, cut between its characters. */
static void check_name(void)
{
  char name[200] = "cylindrical_stage\" name=\"x";
  build("single");
  struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, false);
  for (int i = 0; i < 40; i++)
    strcat(name, "\xC3\xA4");
  if (replace(&text, "cylindrical_stage\" name=\"mesh", name)) {
    struct eo_import import = read_file(&text);
    json_t *answer = eo_import_encode(&import);
    ok(import.pairs == 1 && answer && strstr(import.pair[0].label, "\xC3\xA4..."),
       "a long name of a stage is shortened: %s", import.pairs ? import.pair[0].label : "no pair");
    json_decref(answer);
    eo_import_done(&import);
  }
  eo_text_done(&text);
}

/* Where the pair cannot be made the fault says which key of a design is to blame, and nothing of a place. */
static void check_impossible(void)
{
  build("single");
  struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, false);
  if (replace(&text, "\"center_distance\" unit=\"mm\">1", "\"center_distance\" unit=\"mm\">9")) {
    struct eo_import import = read_file(&text);
    json_t *answer = eo_import_encode(&import), *fault = json_array_get(json_object_get(answer, "faults"), 0);
    ok(import.faults == 1 && strcmp(import.fault[0].kind, "not_a_pair") == 0 && json_object_size(fault) == 3 &&
           json_is_string(json_object_get(fault, "key")),
       "a pair that cannot be made is refused: %s", import.faults ? import.fault[0].text : "no fault");
    json_decref(answer);
    eo_import_done(&import);
  }
  eo_text_done(&text);
}

/* The shift that cuts the root goes out and in; a root circle that is none of the tool's is named. */
static void check_generated(void)
{
  struct eo_error error;
  build("single");
  const double shift[2] = {design.gear_pair.profile_shift[0] - 0.05, design.gear_pair.profile_shift[1] + 0.03};
  design.gear_pair.generating_offset[0] = -0.05;
  design.gear_pair.generating_offset[1] = 0.03;
  ok(!eo_design_complete(&design, &geometry, &error), "a pair with roots of their own shift is completed");
  struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, false);
  struct eo_import import = read_file(&text);
  close_to(eo_json_find_number(import.design, "gear_pair/pinion_generating_shift"), shift[0], 1e-9,
           "generating shift x_E of the pinion");
  close_to(eo_json_find_number(import.design, "gear_pair/gear_generating_shift"), shift[1], 1e-9,
           "generating shift x_E of the gear");
  ok(!says(import.not_used, "root_diameter"), "the root circles are those of the file");
  eo_import_done(&import);
  if (replace(&text, "\"root_diameter\" unit=\"mm\">", "\"root_diameter\" unit=\"mm\">1")) {
    import = read_file(&text);
    ok(import.design && says(import.not_used, "root_diameter of cylindrical_gear"),
       "a root circle that contradicts is named and not used");
    eo_import_done(&import);
  }
  eo_text_done(&text);
}

/* The right unit in another spelling is taken and said, another unit is a fault. */
static void check_units(void)
{
  static const struct {
    const char *written, *given;
    const char *fault; /* NULL: taken */
  } rows[] = {
      {"N m", "N*m", NULL},
      {"N m", "N·m", NULL},
      {"N m", "N mm", "unknown_unit"},
      {"1 / min", "1 /min", NULL},
      {"1 / min", "min^-1", NULL},
      {"1 / min", "min⁻¹", NULL},
      {"1 / min", "1 / s", "wrong_unit"},
      {"kg / dm^3", "kg/dm^3", NULL},
      {"kg / dm^3", "kg/dm³", NULL},
      {"kg / dm^3", "kg / m^3", "unknown_unit"},
      {"N / mm^2", "N/mm^2", NULL},
      {"N / mm^2", "N/mm²", NULL},
      {"N / mm^2", "GPa", "wrong_unit"},
  };
  build("single");
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char old[60], new[60];
    struct eo_text text = write_file(EO_REXS_EXPORT_VERSION, EO_REXS_XML, false);
    snprintf(old, sizeof old, "unit=\"%s\"", rows[i].written);
    snprintf(new, sizeof new, "unit=\"%s\"", rows[i].given);
    if (replace(&text, old, new)) {
      struct eo_import import = read_file(&text);
      ok(rows[i].fault ? import.faults && strcmp(import.fault[0].kind, rows[i].fault) == 0
                       : import.design && says(import.notes, "It was taken as that"),
         "%s for %s is read as %s %s", rows[i].given, rows[i].written, rows[i].fault ? "a fault," : "taken and said",
         import.faults ? import.fault[0].kind : "");
      eo_import_done(&import);
    }
    eo_text_done(&text);
  }
}

/* Both of one shape or none: a circular relief with a crowning has no words, so the whole flank goes as a topography.
 */
static void check_topography(void)
{
  struct eo_flank_modification *flank = &design.modification.flank[EO_PINION][EO_LEFT];
  build("paper-case-b");
  flank->profile_crowning = 1e-1;
  flank->shape = EO_RELIEF_CIRCULAR;
  struct eo_rexs_model model = {0};
  eo_rexs_export(&design, &geometry, EO_REXS_EXPORT_VERSION, false, &model);
  int grids = 0, reliefs = 0;
  for (int i = 0; i < model.components; i++) {
    grids += eo_rexs_is(&model.component[i], "topographical_modification");
    reliefs += eo_rexs_is(&model.component[i], "tip_relief");
  }
  ok(grids == 1 && reliefs == 1, "the file holds %d topography beside %d relief of the other end", grids, reliefs);
  ok(check_model(&model, EO_REXS_EXPORT_VERSION) == 0, "a topography keeps to the schema");
  eo_rexs_done(&model);
}

/* Files: */

static bool refuses(const char *bytes, size_t size, const char *kind)
{
  struct eo_rexs_model model = {0};
  struct eo_rexs_problem problem;
  bool read = eo_rexs_read(&model, bytes, size, &problem);
  bool right = !read && problem.kind && strcmp(problem.kind, kind) == 0 && *problem.error.text;
  if (!right)
    printf("# %s\n", read ? "read" : problem.error.text);
  eo_rexs_done(&model);
  return right;
}

/* An archive with one file of blanks. */
static struct eo_text make_bomb(size_t size)
{
  enum { PIECE = 1 << 20 };
  struct eo_text bomb = {0};
  size_t used = 0;
  char *room = malloc(PIECE), *blanks = malloc(PIECE);
  struct archive *archive = archive_write_new();
  struct archive_entry *entry = archive_entry_new();
  memset(blanks, ' ', PIECE);
  archive_write_set_format_zip(archive);
  archive_write_set_bytes_in_last_block(archive, 1);
  archive_write_open_memory(archive, room, PIECE, &used);
  archive_entry_set_pathname(entry, "folder/model.rexs");
  archive_entry_set_size(entry, (la_int64_t)size);
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_write_header(archive, entry);
  for (size_t at = 0; at < size; at += PIECE)
    archive_write_data(archive, blanks, PIECE);
  archive_entry_free(entry);
  archive_write_free(archive);
  eo_text_add_bytes(&bomb, room, used);
  free(room);
  free(blanks);
  return bomb;
}

static void check_hostile(void)
{
  struct eo_text bomb = make_bomb((size_t)200 << 20);
  ok(bomb.size < 1 << 20, "200 MB of blanks in an archive of %zu KB are refused", bomb.size >> 10);
  ok(refuses(bomb.data, bomb.size, "too_large"), "an archive that grows without measure is refused");
  eo_text_done(&bomb);
  static const char entity[] = "<?xml version=\"1.0\"?><!DOCTYPE model SYSTEM \"file:///etc/passwd\"><model/>";
  ok(refuses(entity, sizeof entity - 1, "document_type"), "a document type of another file is refused");
  static const char other[] = "<html><body/></html>";
  ok(refuses(other, sizeof other - 1, "not_rexs"), "XML of another kind is refused");
  static const char huge[] = "<model version=\"1.7\"><components><component id=\"99999999999\" type=\"shaft\"/>";
  ok(refuses(huge, sizeof huge - 1, "wrong_id"), "an id beyond all numbers is refused");
  ok(refuses("PK\003\004", 4, "not_well_formed") || refuses("PK\003\004xx", 6, "damaged_archive"),
     "half an archive is refused");
}

/* Numbers in Base64, in both forms. */
static void check_coded(void)
{
  static const char xml[] = "<model version=\"1.7\"><components><component id=\"1\" type=\"shaft\"><attribute "
                            "id=\"support_vector\" unit=\"mm\"><array code=\"float64\">AAAAAAAA8D8AAAAAAAAAwA==</array>"
                            "</attribute></component></components></model>";
  static const char json[] =
      "{\"model\":{\"version\":\"1.7\",\"components\":[{\"id\":1,\"type\":\"shaft\",\"attributes\":["
      "{\"id\":\"support_vector\",\"floating_point_array_coded\":{\"code\":\"float32\",\"value\":"
      "\"AACAPwAAAMA=\"}}]}]}}";
  static const char *const text[2] = {xml, json};
  for (int i = 0; i < 2; i++) {
    struct eo_rexs_model model = {0};
    struct eo_rexs_problem problem;
    bool read = eo_rexs_read(&model, text[i], strlen(text[i]), &problem);
    const struct eo_rexs_attribute *a = read ? eo_rexs_attribute(&model.component[0], "support_vector") : NULL;
    ok(a && a->count == 2 && a->value[0] == 1 && a->value[1] == -2, "numbers in Base64 are read as 1 and -2");
    eo_rexs_done(&model);
  }
}

int main(void)
{
  for (int i = 0; eo_example_at(i); i++) {
    build(eo_example_at(i)->name);
    check_design(eo_example_at(i)->name);
  }
  build_stranger(1);
  check_design("a stranger's single helical pair");
  build_stranger(2);
  check_design("a stranger's herringbone pair with unequal halves");
  check_empty();
  check_name();
  check_impossible();
  check_generated();
  check_units();
  check_hands();
  check_edited();
  check_topography();
  check_hostile();
  check_coded();
  return tap_done();
}

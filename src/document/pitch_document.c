/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/pitch_document.h"

#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "gear/names.h"

enum { MOST_TEETH = 2000, MOST_TEXT = 1 << 20 };

/* The object as it stands in the document. */
struct flank_document {
  struct eo_numbers term[EO_TOOTH_TERMS];
};
struct end_document {
  struct flank_document side[2]; /* [flank side]: the coast flank stands in the other one's `coast` */
};
struct member_document {
  struct eo_pitch_member own;
  struct end_document end[2];
};
struct pitch_document {
  int positions, gear_tooth;
  struct member_document member[2];
};

static const char *const term_key[EO_TOOTH_TERMS] = {"index_um", "profile_slope_um", "helix_slope_um",
                                                     "profile_crowning_um", "lead_crowning_um"};

#define FLANK_ROWS(side)                                                                                              \
  EO_SERIES(struct end_document, side.term[EO_TOOTH_INDEX], "index_um", &eo_unit_um, MOST_TEETH, -1000, 1000, 0,      \
            "individual index deviation F of each tooth (ISO 1328-1), transverse arc of the reference circle, + "     \
            "displaced towards the mate; teeth in the order in which they come into mesh ahead; [] : drawn from the " \
            "member's tolerance class, or none"),                                                                     \
      EO_SERIES(struct end_document, side.term[EO_TOOTH_PROFILE_SLOPE], "profile_slope_um", &eo_unit_um, MOST_TEETH,  \
                -1000, 1000, 0,                                                                                       \
                "C_Halpha of each tooth in addition to the flank's own, + takes more off at the tip; [] : none"),     \
      EO_SERIES(                                                                                                      \
          struct end_document, side.term[EO_TOOTH_HELIX_SLOPE], "helix_slope_um", &eo_unit_um, MOST_TEETH, -1000,     \
          1000, 0,                                                                                                    \
          "C_Hbeta of each tooth in addition to the flank's own, + takes more off at the face end that meets first "  \
          "on the drive flank; [] : none"),                                                                           \
      EO_SERIES(struct end_document, side.term[EO_TOOTH_PROFILE_CROWNING], "profile_crowning_um", &eo_unit_um,        \
                MOST_TEETH, -1000, 1000, 0,                                                                           \
                "C_alpha of each tooth in addition to the flank's own, as a barrel, + takes off at root and tip; [] " \
                ": none"),                                                                                            \
      EO_SERIES(struct end_document, side.term[EO_TOOTH_LEAD_CROWNING], "lead_crowning_um", &eo_unit_um, MOST_TEETH,  \
                -1000, 1000, 0,                                                                                       \
                "C_beta of each tooth in addition to the flank's own, + takes off at both face ends; [] : none")
#define TEXT_ROW(help_)                                                                                 \
  {                                                                                                     \
    .key = "csv", .kind = EO_FIELD_TEXT, .flags = EO_FIELD_ELSEWHERE, .count = MOST_TEXT, .help = help_ \
  }

static const struct eo_field coast_fields[] = {FLANK_ROWS(side[EO_COAST_FLANK]),
                                               TEXT_ROW("in place of the arrays: a table as text")};
static const struct eo_table coast_table = EO_TABLE("the teeth's coast flanks", struct end_document, coast_fields);

static const struct eo_field end_fields[] = {
    FLANK_ROWS(side[EO_DRIVE_FLANK]),
    TEXT_ROW("in place of the arrays: a table as text, with headings tooth and index_um or single_um, and further ones "
             "named like the arrays"),
    {.key = "coast",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_OMIT,
     .table = &coast_table,
     .help = "the other flanks of the same teeth"},
};
static const struct eo_table end_table = EO_TABLE("the teeth of one end", struct end_document, end_fields);

static const char *const editions[] = {"1995", "1995_exact", "2013", NULL};

static const struct eo_field member_fields[] = {
    EO_INTEGER(struct member_document, own.tolerance_class, "tolerance_class", 0, 12, 0,
               "class of ISO 1328-1 from which the flanks without index_um are drawn; 0: not drawn"),
    EO_INTEGER(struct member_document, own.flank_class, "flank_class", 0, 12, 0,
               "class of ISO 1328-1 from which slopes and crownings of single teeth are drawn where no array states "
               "them: slopes within f_Halpha and f_Hbeta, crownings within f_falpha and f_fbeta; 0: not drawn"),
    EO_CHOICE(struct member_document, own.edition, "tolerance_edition", editions, EO_ISO1328_2013,
              "of ISO 1328-1: classes of 2013, grades of 1995"),
    EO_NUMBER(struct member_document, own.tolerance_share, "tolerance_share", NULL, 0, 1, 1,
              "how much of both tolerances, total and single pitch, drawn flanks take: they reach one of them and keep "
              "within the other"),
    {.key = "seed",
     .kind = EO_FIELD_SEED,
     .offset = offsetof(struct member_document, own.seed),
     .low = 0,
     .high = 9007199254740991.,
     .fallback = 1,
     .help = "of what is drawn: the same seed, the same teeth"},
    EO_NUMBER(struct member_document, own.eccentricity, "eccentricity_um", &eo_unit_um, 0, 1000, 0,
              "of the toothing against its axis of rotation; the run-out F_r is about twice as large"),
    EO_NUMBER(struct member_document, own.eccentricity_angle, "eccentricity_angle_deg", &eo_unit_deg, -360, 360, 0,
              "from tooth 0 to where it is farthest out, in the order of the teeth"),
    EO_NUMBER(struct member_document, own.wobble, "axial_wobble_um", &eo_unit_um, 0, 1000, 0,
              "axial displacement of the toothing (of the apex) once per turn, amplitude"),
    EO_NUMBER(struct member_document, own.wobble_angle, "axial_wobble_angle_deg", &eo_unit_deg, -360, 360, 0,
              "from tooth 0 to where it is farthest to the right, in the order of the teeth"),
    EO_OBJECT(struct member_document, end[EO_LEFT], "left", &end_table, "left end"),
    {.key = "right",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_SOMETIMES,
     .offset = offsetof(struct member_document, end[EO_RIGHT]),
     .table = &end_table,
     .help = "right end"},
};
static const struct eo_table member_table = EO_TABLE("a member's teeth", struct member_document, member_fields);

const struct eo_field *eo_pitch_member_number(const char *key, size_t *offset)
{
  for (int i = 0; i < member_table.count; i++) {
    const struct eo_field *field = &member_table.field[i];
    *offset = field->offset - offsetof(struct member_document, own);
    if (field->kind == EO_FIELD_NUMBER && strcmp(field->key, key) == 0)
      return field;
  }
  return NULL;
}

static const struct eo_field pitch_fields[] = {
    EO_INTEGER_DERIVED(struct pitch_document, positions, "positions_per_cycle", 4, 1024,
                       "the largest divisor of the resolution's positions up to 32",
                       "mesh positions of each cycle of the hunting period: a divisor of the resolution's positions"),
    EO_INTEGER(struct pitch_document, gear_tooth, "gear_tooth", 0, MOST_TEETH, 0,
               "tooth of the gear that meets the pinion's tooth 0; where the numbers of teeth have a common divisor "
               "it decides which teeth ever meet"),
    EO_OBJECT(struct pitch_document, member[EO_PINION], "pinion", &member_table, "teeth of the pinion"),
    EO_OBJECT(struct pitch_document, member[EO_GEAR], "gear", &member_table, "teeth of the gear"),
    TEXT_ROW("a table of several flanks as text, with headings member, end, flank and tooth and as in an end's own"),
};
const struct eo_table eo_pitch_table = EO_TABLE("deviations of single teeth", struct pitch_document, pitch_fields);

/* The text of a table becomes arrays beside it; an empty one, and arrays that are null, are not there. */
static void expand_text(json_t *object, bool whole, const struct eo_path *path, struct eo_faults *faults)
{
  json_t *text = json_incref(json_object_get(object, "csv"));
  struct eo_path place = {path, "csv", 0};
  struct eo_error error;
  for (int term = 0; term < EO_TOOTH_TERMS; term++)
    if (json_is_null(json_object_get(object, term_key[term])))
      json_object_del(object, term_key[term]);
  json_object_del(object, "csv");
  if (!text || json_is_null(text) || (json_is_string(text) && json_string_length(text) == 0)) {
    json_decref(text);
    return;
  }
  if (!json_is_string(text) || json_string_length(text) >= MOST_TEXT)
    eo_faults_at(faults, &place, "A table is a text of at most %d bytes.", MOST_TEXT - 1);
  else if (eo_pitch_from_text(json_string_value(text), whole, object, &error))
    eo_faults_at(faults, &place, "%s", error.text);
  json_decref(text);
}

static json_t *expand(const json_t *object, const struct eo_path *path, struct eo_faults *faults)
{
  json_t *copy = json_deep_copy(object);
  expand_text(copy, true, path, faults);
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < 2; end++) {
      struct eo_path of_member = {path, eo_member_name[member], 0}, of_end = {&of_member, eo_end_name[end], 0},
                     of_coast = {&of_end, "coast", 0};
      json_t *flank = json_object_get(json_object_get(copy, eo_member_name[member]), eo_end_name[end]);
      expand_text(flank, false, &of_end, faults);
      expand_text(json_object_get(flank, "coast"), false, &of_coast, faults);
    }
  return copy;
}

static void add_table(const struct eo_numbers *series, const struct eo_path *path, enum eo_flank_side side, int member,
                      int end, int term, int teeth, struct eo_pitch *pitch, struct eo_faults *faults)
{
  struct eo_path coast = {path, "coast", 0}, place = {side == EO_COAST_FLANK ? &coast : path, term_key[term], 0};
  struct eo_error error;
  if (series->count == 0)
    return;
  if (series->count != teeth)
    eo_faults_at(faults, &place, "There are %d numbers, but the %s has %d teeth: state one for each.", series->count,
                 eo_member_name[member], teeth);
  else if (eo_tooth_tables_add(&pitch->tables, side, member, end, (enum eo_tooth_term)term, teeth, series->value,
                               &error))
    eo_faults_at(faults, &place, "%s", error.text);
}

static void take(const struct pitch_document *document, const struct eo_path *path, const struct eo_gear_pair *pair,
                 struct eo_pitch *pitch, struct eo_faults *faults)
{
  pitch->stated = true;
  pitch->positions = document->positions;
  pitch->gear_tooth = document->gear_tooth;
  for (int member = 0; member < 2; member++) {
    pitch->member[member] = document->member[member].own;
    for (int i = 0; i < 2 * pair->ends * EO_TOOTH_TERMS; i++) {
      int term = i % EO_TOOTH_TERMS, end = i / EO_TOOTH_TERMS / 2, side = i / EO_TOOTH_TERMS % 2;
      struct eo_path of_member = {path, eo_member_name[member], 0}, of_end = {&of_member, eo_end_name[end], 0};
      add_table(&document->member[member].end[end].side[side].term[term], &of_end, (enum eo_flank_side)side, member,
                end, term, pair->teeth[member], pitch, faults);
    }
  }
}

void eo_pitch_decode(const json_t *object, const struct eo_gear_pair *pair, struct eo_pitch *pitch,
                     struct eo_faults *faults)
{
  struct eo_path path = {NULL, "pitch", 0};
  struct pitch_document document = {0};
  int before = faults->count;
  memset(pitch, 0, sizeof *pitch);
  if (!object || json_is_null(object))
    return;
  if (!json_is_object(object)) {
    eo_faults_at(faults, &path, "Deviations of single teeth are an object, or null.");
    return;
  }
  json_t *whole = expand(object, &path, faults);
  if (faults->count == before)
    eo_table_decode(&eo_pitch_table, whole, &path, &document, faults);
  if (faults->count == before) {
    eo_table_round_to_document(&eo_pitch_table, &document);
    take(&document, &path, pair, pitch, faults);
  }
  eo_table_done(&eo_pitch_table, &document);
  json_decref(whole);
}

json_t *eo_pitch_encode(const struct eo_pitch *pitch, int ends)
{
  struct pitch_document document = {.positions = pitch->positions, .gear_tooth = pitch->gear_tooth};
  if (!pitch->stated)
    return json_null();
  for (int member = 0; member < 2; member++) {
    document.member[member].own = pitch->member[member];
    for (int i = 0; i < 2 * ends * EO_TOOTH_TERMS; i++) {
      int term = i % EO_TOOTH_TERMS, end = i / EO_TOOTH_TERMS / 2, side = i / EO_TOOTH_TERMS % 2;
      /* encoding reads alone */
      document.member[member].end[end].side[side].term[term] = (struct eo_numbers){
          pitch->tables.place[side][member][end][term].teeth,
          (double *)eo_tooth_table_at(&pitch->tables, (enum eo_flank_side)side, member, end, (enum eo_tooth_term)term)};
    }
  }
  json_t *object = eo_table_encode(&eo_pitch_table, &document);
  for (int member = 0; member < 2 && ends == 1; member++)
    json_object_del(json_object_get(object, eo_member_name[member]), "right");
  return object;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_tables.h"
#include "recording/column.h"
#include "recording/letters.h"
#include "recording/text_facts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_ROWS 20 /* of a table */
#define FEW 16        /* numbers of channels at most that tell a column of them from one of values */
#define NEAR 40       /* lines of a heading between tables at most */
#define LOOKED 2000   /* rows */

/* Whole names of columns, and keys of a line that calls a table by its name. */
#define CHANNEL_NAMES                                                                                                  \
  "channel|channel name|channelname|channel id|kanal|kanalname|kanalnummer|signal|signal name|signalname|name|sensor|" \
  "sensor name|sensor id|sensorid|variable|tag|tag name|tagname|parameter|messstelle|messgroesse|topic|metric|field|"  \
  "_field|source|id|can id|canid|voie|canal|canale|quantity|item|series|node|device|ch"
#define TABLE_KEYS CHANNEL_NAMES "|trace|curve|table|tabelle|sheet|blatt|group|gruppe|data set|dataset|kurve|encoder"
/* Of the one column that all channels share. */
#define VALUE_NAMES                                                                                                   \
  "value|val|values|wert|messwert|istwert|reading|measurement|measured value|data|result|amplitude|scaled|eng value|" \
  "angle|winkel|position|pos|valeur|mesure|valore|misura|valor|medida|_value|y"
#define UNIT_NAMES "unit|units|einheit|einheiten|unite|unita|unidad"
/* Of a column that says which edge of a pulse the time of a row is. */
#define EDGE_NAMES \
  "edge|edges|edge type|slope|polarity|transition|flanke|flankenart|flankentyp|front|fronte|flanc|flanco|fianco"

/* The different texts of one place in the rows of the head. */
struct words {
  int count;
  struct eo_cell word[FEW + 1];
  bool whole, pinion, gear; /* they are whole numbers; name an encoder */
  bool counting;            /* they count the rows */
  double before;            /* in the row before */
};

static void add_word(struct words *words, const struct eo_cell *cell, char point)
{
  char text[EO_RECORDING_NAME];
  double value;
  enum eo_cell_kind kind = eo_text_cell_value(cell, point, &value);
  words->counting = words->counting && kind == EO_CELL_NUMBER && (!words->count || value == words->before + 1);
  words->before = value;
  for (int i = 0; i < words->count; i++)
    if (words->word[i].length == cell->length && !memcmp(words->word[i].text, cell->text, cell->length))
      return;
  if (!cell->length || words->count > FEW)
    return;
  bool number = kind == EO_CELL_NUMBER || kind == EO_CELL_HEX;
  words->whole = words->whole && (kind == EO_CELL_HEX || (number && value == floor(value)));
  eo_text_cell_copy(text, sizeof text, cell);
  words->pinion = words->pinion || eo_column_named(text, EO_PINION_WORDS);
  words->gear = words->gear || eo_column_named(text, EO_GEAR_WORDS);
  words->word[words->count++] = *cell;
}

static struct words words_of(const struct eo_text_format *format, const char *head, size_t size, int place)
{
  struct words words = {.whole = true, .counting = true};
  const char *at = head + format->first_byte, *last = head + size;
  for (int row = 0; row < LOOKED && at < last; row++) {
    const char *end = memchr(at, format->line_end, (size_t)(last - at)), *next = at;
    struct eo_cell cell = {0};
    if (!end)
      break;
    bool there = !eo_text_empty(at, end) && !eo_text_comment(at, end, format->separator);
    for (int c = 0; there && c <= place; c++)
      there = eo_text_next_cell(&next, end, format->separator, &cell);
    if (there)
      add_word(&words, &cell, format->point);
    at = end + 1;
  }
  return words;
}

/* Marks between the words of a name are blanks: channel_id, channel-id. */
static bool is_listed(const char *name, const char *names)
{
  char plain[EO_RECORDING_NAME];
  size_t length = strlen(name);
  for (size_t i = 0; i <= length; i++)
    plain[i] = i && name[i] && strchr("_-./", name[i]) ? ' ' : name[i];
  return eo_letters_listed(plain, length, names);
}

/* No column but a time and a value, and none is called by an encoder. */
static bool holds_one_value(const struct eo_text_format *format)
{
  for (int c = 0; c < format->cells; c++)
    if (eo_text_is_column(format, c) && eo_column_named(format->name[c], EO_PINION_WORDS "|" EO_GEAR_WORDS))
      return false;
  return format->columns <= 2;
}

/* A cell that names the channel of its row: called so, with few different words or numbers; or words for both
   encoders, the second of which may come when all rows of the first are over. */
static bool names_channels(const struct eo_text_format *format, const char *head, size_t size, int place)
{
  enum eo_text_content content = format->content[place];
  bool called = is_listed(format->name[place], CHANNEL_NAMES),
       number = content == EO_TEXT_NUMBER || content == EO_TEXT_HEX;
  if ((content != EO_TEXT_WORDS && !number) || (number && !called) || *format->unit[place])
    return false;
  struct words words = words_of(format, head, size, place);
  if (number)
    return words.whole && words.count <= FEW;
  return (called && words.count <= FEW) || (words.pinion && words.gear) ||
         (words.count == 1 && (words.pinion || words.gear) && holds_one_value(format));
}

/* A row with the number of its channel among more numbers than a time and a value: the place of the value that all
   channels share, -1 where it is a wide table with a number that seldom changes. */
static int find_value(const struct eo_text_format *format)
{
  int value = -1;
  for (int c = 0; c < format->cells; c++) {
    if (eo_column_named(format->name[c], EO_PINION_WORDS) || eo_column_named(format->name[c], EO_GEAR_WORDS))
      return -1;
    if (!is_listed(format->name[c], VALUE_NAMES))
      continue;
    if (value >= 0)
      return -1;
    value = c;
  }
  return value;
}

/* What is neither time nor value is about the value: its quality, a status, the number before it was scaled. */
static void leave_out_beside(struct eo_text_format *format, int value)
{
  for (int c = 0; c < format->cells; c++)
    if (eo_text_is_column(format, c) && c != value && format->content[c] != EO_TEXT_MOMENT &&
        !eo_text_is_called_time(format, c)) {
      format->content[c] = EO_TEXT_BESIDE;
      format->columns--;
    }
}

static void leave_out(struct eo_text_format *format, int place, enum eo_text_content content)
{
  format->columns -= eo_text_is_column(format, place);
  format->content[place] = content;
}

/* Beside the name of its channel a row may tell the unit of its value, which edge of a pulse it is, and its number
   among all rows. */
static void look_beside(struct eo_text_format *format, const char *head, size_t size, struct eo_text_channels *channels)
{
  bool several = words_of(format, head, size, channels->cell).count > 1; /* whose values together count nothing */
  for (int c = 0; c < format->cells; c++) {
    bool column = eo_text_is_column(format, c) && format->columns > 1;
    if (c == channels->cell)
      continue;
    if (format->content[c] == EO_TEXT_WORDS && is_listed(format->name[c], UNIT_NAMES))
      channels->unit = c;
    else if ((column || format->content[c] == EO_TEXT_WORDS) && is_listed(format->name[c], EDGE_NAMES) &&
             words_of(format, head, size, c).count <= 2) {
      leave_out(format, c, EO_TEXT_WORDS);
      channels->edge = c;
    } else if (several && column && !eo_text_is_called_time(format, c) && words_of(format, head, size, c).counting)
      leave_out(format, c, EO_TEXT_BESIDE);
  }
}

struct eo_text_channels eo_text_find_channels(struct eo_text_format *format, const char *head, size_t size)
{
  struct eo_text_channels channels = {.cell = -1, .unit = -1, .edge = -1}, none = channels;
  for (int c = 0; c < format->cells && channels.cell < 0; c++)
    if (names_channels(format, head, size, c))
      channels.cell = c;
  if (channels.cell < 0)
    return channels;
  bool number = format->content[channels.cell] != EO_TEXT_WORDS, more = number && format->columns > 3;
  int value = more ? find_value(format) : -1;
  if (format->columns - number < 1 || (more && value < 0))
    return none;
  format->content[channels.cell] = EO_TEXT_WORDS;
  format->columns -= number;
  format->plain = false;
  if (more)
    leave_out_beside(format, value);
  look_beside(format, head, size, &channels);
  return channels;
}

bool eo_text_takes_edge(struct eo_text_channels *channels, struct eo_table *table, const struct eo_cell *cell)
{
  char edge[EO_RECORDING_UNIT];
  eo_text_cell_copy(edge, sizeof edge, cell);
  if (!*table->edge)
    memcpy(table->edge, edge, sizeof edge);
  bool takes = !strcmp(table->edge, edge);
  channels->other_edges += !takes;
  return takes;
}

enum eo_code eo_text_channel_table(struct eo_tables *tables, const struct eo_text_format *format,
                                   const struct eo_cell *channel, const struct eo_cell *unit,
                                   const char *spool_directory, struct eo_table **table, struct eo_error *error)
{
  char label[EO_RECORDING_NAME];
  eo_text_cell_copy(label, sizeof label, channel);
  for (int i = 0; i < tables->count; i++)
    if (!strcmp(tables->table[i].label, label)) {
      *table = &tables->table[i];
      return EO_OK;
    }
  if (tables->count == EO_TABLES)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The rows are of more than %d channels (\"%.40s\" is one more); export those of the encoders.",
                        EO_TABLES, label);
  struct eo_table *made = &tables->table[tables->count];
  memset(made, 0, sizeof *made);
  EO_TRY(eo_recording_new(&made->recording, format->columns, spool_directory, error));
  tables->count++;
  memcpy(made->label, label, sizeof label);
  if (unit)
    eo_text_cell_copy(made->unit, sizeof made->unit, unit);
  eo_text_name_columns(format, made->recording);
  *table = made;
  return EO_OK;
}

/* Copies text without the marks that surround a heading: "[gear]", "--- gear ---". */
static void copy_plain(char label[EO_RECORDING_NAME], const char *text, const char *end)
{
  while (text < end && strchr(" \t\"[<=-*#:", *text))
    text++;
  while (end > text && strchr(" \t\r\"]>=-*#:;,", end[-1]))
    end--;
  snprintf(label, EO_RECORDING_NAME, "%.*s", (int)(end - text), text);
}

/* "Channel: gear", "Kanal;Rad", or a line of its own that names an encoder. */
static bool read_label(const struct eo_text_format *format, const struct eo_header_line *line,
                       char label[EO_RECORDING_NAME])
{
  const char *key = line->start, *mark;
  while (key < line->end && (*key == '"' || *key == ' '))
    key++;
  for (mark = key; mark < line->end && !strchr(format->cells == 1 ? ":=;,\t" : ":=\t", *mark);)
    if (*mark++ == format->separator) {
      mark--;
      break;
    }
  const char *end = mark;
  while (end > key && strchr("\" #0123456789", end[-1])) /* "Channel 1: pinion" */
    end--;
  if (mark < line->end && eo_letters_listed(key, (size_t)(end - key), TABLE_KEYS)) {
    copy_plain(label, mark, line->end);
    return *label && eo_header_cells(line, format->separator) <= 2;
  }
  if (mark < line->end || format->cells == 1 || line->end - line->start > 40)
    return false;
  copy_plain(label, line->start, line->end);
  return eo_column_named(label, EO_PINION_WORDS) != eo_column_named(label, EO_GEAR_WORDS);
}

void eo_text_table_label(struct eo_text_format *format, const char *head, char label[EO_RECORDING_NAME])
{
  struct eo_header *header = malloc(sizeof *header);
  bool found = false;
  *label = '\0';
  if (!header)
    return;
  eo_header_split(header, format, head);
  for (int i = 0; i < header->lines && !found; i++)
    found = read_label(format, &header->line[i], label);
  if (!found)
    *label = '\0';
  else if (format->cells == 1 && strpbrk(format->name[0], ":=;"))
    *format->name[0] = *format->unit[0] = '\0'; /* it is one of the facts */
  free(header);
}

bool eo_text_may_begin_table(const struct eo_text_format *format, const char *line, const char *end)
{
  const char *at = line, *comment = eo_text_comment(line, end, format->separator);
  struct eo_cell cell;
  int cells = 0, numbers = 0;
  double value;
  if (comment || eo_text_empty(line, end))
    return comment && !eo_text_empty(comment, end);
  for (; eo_text_next_cell(&at, end, format->separator, &cell); cells++) {
    enum eo_cell_kind kind = eo_text_cell_value(&cell, format->point, &value);
    if (!cells && kind != EO_CELL_TEXT)
      return false;
    numbers += kind != EO_CELL_TEXT && kind != EO_CELL_MISSING;
  }
  return !numbers || cells != format->cells;
}

/* Names that differ, of which one says more than a remark between rows could. */
static bool has_other_names(const struct eo_text_format *now, const struct eo_text_format *next)
{
  double factor;
  bool differ = now->cells != next->cells, telling = false;
  for (int c = 0; c < next->cells; c++) {
    if (c < now->cells && strcmp(now->name[c], next->name[c]) != 0)
      differ = true;
    telling = telling || eo_unit_find(next->unit[c], &factor) != EO_QUANTITY_NONE ||
              eo_column_named(next->name[c], EO_PINION_WORDS "|" EO_GEAR_WORDS);
  }
  return differ && telling;
}

bool eo_text_is_other_table(const struct eo_text_format *now, const char *label, const struct eo_text_format *next,
                            const char *next_label)
{
  if (next->rows < LEAST_ROWS || next->first_line > NEAR)
    return false;
  return has_other_names(now, next) || (*next_label && strcmp(label, next_label) != 0);
}

void eo_text_inherit_rate(const struct eo_text_format *now, struct eo_text_format *next)
{
  for (int c = 1; c < now->cells; c++)
    if (now->clock[c].interval != now->clock[0].interval)
      return;
  for (int c = 0; c < next->cells; c++)
    if (!(next->clock[c].interval > 0))
      next->clock[c].interval = now->clock[0].interval;
}

void eo_text_name_columns(const struct eo_text_format *format, struct eo_recording *recording)
{
  for (int c = 0, column = 0; c < format->cells; c++)
    if (eo_text_is_column(format, c))
      eo_recording_set_column(recording, column++, format->name[c],
                              format->content[c] == EO_TEXT_MOMENT ? "s"
                              : format->content[c] == EO_TEXT_ARC  ? "deg"
                                                                   : format->unit[c]);
}

void eo_text_state_columns(const struct eo_text_format *format, struct eo_recording *recording)
{
  for (int c = 0, column = 0; c < format->cells; c++)
    if (eo_text_is_column(format, c)) {
      eo_recording_set_clock(recording, column, &format->clock[c]);
      eo_recording_set_turn(recording, column++, format->turn[c]);
    }
  eo_recording_set_tick(recording, format->tick);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NI TDMS: segments written here byte by byte after NI's public description of the format. */
#include "support/byte-writer.h"
#include "support/reader-fixture.h"

enum { METADATA = 2, NEW_LIST = 4, DATA = 8, INTERLEAVED = 32, BIG = 64, DAQMX = 128 };
enum { INT16 = 2, INT32 = 3, INT64 = 4, UINT8 = 5, SINGLE = 9, DOUBLE = 10, STRING = 0x20, TIMESTAMP = 0x44 };

static struct writer w;
static size_t lead_in, metadata_end;

static void begin_segment(int toc)
{
  lead_in = w.size;
  w.big = (toc & BIG) != 0;
  put_bytes(&w, "TDSm", 4);
  int big = w.big;
  w.big = 0; /* the mask of contents is always little-endian */
  put_number(&w, (uint64_t)toc, 4);
  w.big = big;
  put_number(&w, 4713, 4);
  put_number(&w, 0, 8);
  put_number(&w, 0, 8);
}

static void set_at(size_t at, uint64_t value)
{
  size_t size = w.size;
  w.size = at;
  put_number(&w, value, 8);
  w.size = size;
}

static void end_metadata(void)
{
  metadata_end = w.size;
  set_at(lead_in + 20, w.size - lead_in - 28);
}

static void end_segment(void)
{
  set_at(lead_in + 12, w.size - lead_in - 28);
}

static void put_index(int type, uint64_t count)
{
  put_number(&w, 20, 4);
  put_number(&w, (uint64_t)type, 4);
  put_number(&w, 1, 4);
  put_number(&w, count, 8);
}

static void put_double_property(const char *name, double value)
{
  put_string(&w, name);
  put_number(&w, DOUBLE, 4);
  put_double(&w, value);
}

static void put_string_property(const char *name, const char *value)
{
  put_string(&w, name);
  put_number(&w, STRING, 4);
  put_string(&w, value);
}

/* Root, group, and two channels of doubles with waveform properties; `chunk` values of each per chunk. */
static void put_objects(uint64_t chunk)
{
  put_number(&w, 4, 4);
  put_string(&w, "/");
  put_number(&w, 0xffffffff, 4);
  put_number(&w, 1, 4);
  put_string_property("name", "rig run");
  put_string(&w, "/'Encoders'");
  put_number(&w, 0xffffffff, 4);
  put_number(&w, 0, 4);
  put_string(&w, "/'Encoders'/'Pinion''s angle'");
  put_index(DOUBLE, chunk);
  put_number(&w, 3, 4);
  put_double_property("wf_increment", 5e-5);
  put_double_property("wf_start_offset", 0.25);
  put_string_property("unit_string", "deg");
  put_string(&w, "/'Encoders'/'Gear angle'");
  put_index(DOUBLE, chunk);
  put_number(&w, 2, 4);
  put_double_property("wf_increment", 5e-5);
  put_string_property("unit_string", "deg");
}

static double pinion(int i)
{
  return 17.154 + 0.6 * i;
}

static double gear(int i)
{
  return 63.027 - 0.23 * i;
}

static void put_chunk(int first, int count, int interleaved)
{
  for (int i = 0; interleaved && i < count; i++) {
    put_double(&w, pinion(first + i));
    put_double(&w, gear(first + i));
  }
  for (int i = 0; !interleaved && i < count; i++)
    put_double(&w, pinion(first + i));
  for (int i = 0; !interleaved && i < count; i++)
    put_double(&w, gear(first + i));
}

/* Segment 1 with metadata and two chunks, segment 2 without metadata, segment 3 whose list is kept and one index is
   stated anew. */
static void put_file(int toc)
{
  w.size = 0;
  begin_segment(toc | METADATA | NEW_LIST | DATA);
  put_objects(100);
  end_metadata();
  put_chunk(0, 100, toc & INTERLEAVED);
  put_chunk(100, 100, toc & INTERLEAVED);
  end_segment();
  begin_segment(toc | DATA);
  end_metadata();
  put_chunk(200, 100, toc & INTERLEAVED);
  end_segment();
  begin_segment(toc | METADATA | DATA);
  put_number(&w, 2, 4);
  put_string(&w, "/'Encoders'/'Gear angle'");
  put_index(DOUBLE, 50);
  put_number(&w, 0, 4);
  put_string(&w, "/'Encoders'/'Pinion''s angle'");
  put_index(DOUBLE, 50);
  put_number(&w, 0, 4);
  end_metadata();
  put_chunk(300, 50, toc & INTERLEAVED);
  end_segment();
}

static int wrong_rows(const struct eo_recording *r, int rows)
{
  int wrong = eo_recording_rows(r) != rows || eo_recording_columns(r) != 2;
  for (int i = 0; !wrong && i < rows; i++)
    wrong += cell_of(r, i, 0) != pinion(i) || cell_of(r, i, 1) != gear(i);
  return wrong;
}

static void test_kind(int toc, const char *what)
{
  struct eo_error error;
  put_file(toc);
  write_bytes(w.bytes, w.size);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && !wrong_rows(r, 350), "a file is read, %s%s", what, r ? "" : error.text);
  ok(r && !strcmp(eo_recording_name(r, 0), "Pinion's angle") && !strcmp(eo_recording_unit(r, 1), "deg"),
     "name and unit of a channel are read");
  ok(r && eo_recording_clock(r, 0).interval == 5e-5 && eo_recording_clock(r, 0).start == 0.25 &&
         eo_recording_line(r, 3) == 0,
     "sampling interval and start of a channel are read");
  eo_recording_free(r);
}

/* One segment with one channel of this type, `values` of `bytes` each already at data. */
static void put_typed(int type, int big, uint64_t count)
{
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA | (big ? BIG : 0));
  put_number(&w, 1, 4);
  put_string(&w, "/'g'/'c'");
  put_index(type, count);
  put_number(&w, 0, 4);
  end_metadata();
}

static void check_typed(double first, double second, const char *what)
{
  struct eo_error error;
  end_segment();
  write_bytes(w.bytes, w.size);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && cell_of(r, 0, 0) == first && cell_of(r, 1, 0) == second, "values are read: %s%s", what, r ? "" : error.text);
  eo_recording_free(r);
}

static void test_types(void)
{
  for (int big = 0; big < 2; big++) {
    put_typed(INT16, big, 2);
    put_number(&w, (uint64_t)-1234, 2);
    put_number(&w, 567, 2);
    check_typed(-1234, 567, big ? "int16, big-endian" : "int16");
    put_typed(INT32, big, 2);
    put_number(&w, (uint64_t)-123456, 4);
    put_number(&w, 567890, 4);
    check_typed(-123456, 567890, big ? "int32, big-endian" : "int32");
    put_typed(INT64, big, 2);
    put_number(&w, (uint64_t)-123456789012, 8);
    put_number(&w, 5, 8);
    check_typed(-123456789012.0, 5, big ? "int64, big-endian" : "int64");
    put_typed(UINT8, big, 2);
    put_number(&w, 200, 1);
    put_number(&w, 7, 1);
    check_typed(200, 7, "uint8");
    put_typed(SINGLE, big, 2);
    put_float(&w, 1.25);
    put_float(&w, -3.5);
    check_typed(1.25, -3.5, big ? "single, big-endian" : "single");
    put_typed(TIMESTAMP, big, 2);
    for (int i = 0; i < 2; i++) {
      uint64_t seconds = 3600000000u + (uint64_t)i, fraction = i ? (uint64_t)3 << 62 : (uint64_t)1 << 62;
      put_number(&w, big ? seconds : fraction, 8);
      put_number(&w, big ? fraction : seconds, 8);
    }
    check_typed(0.25, 1.75, big ? "timestamp, big-endian" : "timestamp: seconds since the first one's second");
  }
}

/* A channel of texts before one of numbers. Their size follows their count; some writers do not count it in the length
   of the index. */
static void test_texts(uint64_t length)
{
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 2, 4);
  put_string(&w, "/'g'/'state'");
  put_index(STRING, 2);
  size_t end = w.size;
  w.size -= 20;
  put_number(&w, length, 4);
  w.size = end;
  put_number(&w, 11, 8); /* two ends of texts, three characters */
  put_number(&w, 0, 4);
  put_string(&w, "/'g'/'c'");
  put_index(DOUBLE, 2);
  put_number(&w, 0, 4);
  end_metadata();
  put_number(&w, 2, 4);
  put_number(&w, 3, 4);
  put_bytes(&w, "abc", 3);
  put_double(&w, 1.5);
  put_double(&w, -2.5);
  check_typed(1.5, -2.5, length == 28 ? "texts beside numbers" : "texts whose size the index does not count");
}

static void test_scaled(void)
{
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 1, 4);
  put_string(&w, "/'g'/'sine'");
  put_index(INT16, 2);
  put_number(&w, 4, 4);
  put_string_property("NI_Scaling_Status", "unscaled");
  put_string(&w, "NI_Number_Of_Scales");
  put_number(&w, 7, 4);
  put_number(&w, 1, 4);
  put_double_property("NI_Scale[0]_Linear_Slope", 0.5);
  put_double_property("NI_Scale[0]_Linear_Y_Intercept", 10);
  end_metadata();
  put_number(&w, 4, 2);
  put_number(&w, 6, 2);
  check_typed(12, 13, "raw values with a linear scale");
}

/* Encoders of 400 values in 0.02 s; torque that lasts as long or not, and a temperature, which nobody asks for. */
static void test_slow(double interval, int taken)
{
  static const char *const name[] = {"pinion", "gear", "torque", "oil"}, *const unit[] = {"deg", "deg", "N m", "degC"};
  struct eo_error error;
  struct eo_notes notes = {0};
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 4, 4);
  for (int c = 0; c < 4; c++) {
    char path[32];
    snprintf(path, sizeof path, "/'g'/'%s'", name[c]);
    put_string(&w, path);
    put_index(DOUBLE, c < 2 ? 400 : 10);
    put_number(&w, 2, 4);
    put_double_property("wf_increment", c < 2 ? 5e-5 : c == 2 ? interval : 2e-3);
    put_string_property("unit_string", unit[c]);
  }
  end_metadata();
  put_chunk(0, 400, 0);
  for (int i = 0; i < 20; i++)
    put_double(&w, 828);
  end_segment();
  write_bytes(w.bytes, w.size);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_columns(r) == 2 + taken && (!taken || eo_recording_length(r, 2) == 10) &&
         noted(&notes, taken ? "1 channel with far fewer" : "2 channels with far fewer"),
     "a torque of 10 values, %g s each, beside 400 values of 50 us is %s%s", interval, taken ? "taken" : "left out",
     r ? "" : error.text);
  eo_recording_free(r);
}

static void test_damage(void)
{
  struct eo_error error;
  struct eo_notes notes = {0};
  put_file(0);
  size_t whole = w.size;
  write_bytes(w.bytes, whole - 40);
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(r && eo_recording_rows(r) >= 300 && noted(&notes, "was not closed or is cut off"),
     "the values that are there of a last chunk that is cut off are kept");
  eo_recording_free(r);
  put_file(INTERLEAVED);
  write_bytes(w.bytes, w.size - 40);
  r = read_fixture(NULL, NULL, &error);
  ok(r && !wrong_rows(r, 347), "whole rows of an interleaved chunk that is cut off are kept");
  eo_recording_free(r);
  write_bytes(w.bytes, 100);
  refused("cut off in its metadata", "metadata that are cut off");
  put_file(0);
  set_at(20, 100);
  write_bytes(w.bytes, w.size);
  refused("TDMS: the metadata at byte", "metadata shorter than their content");
  put_file(0);
  w.bytes[4] |= DAQMX;
  write_bytes(w.bytes, w.size);
  refused("DAQmx", "raw DAQmx data");
  put_file(0);
  memset(w.bytes + 8, 9, 4);
  write_bytes(w.bytes, w.size);
  refused("unknown version", "another version");
  put_file(0);
  w.bytes[lead_in] = 'X';
  write_bytes(w.bytes, w.size);
  refused("does not begin with", "a lead-in that is none");
  put_file(0);
  memset(w.bytes + lead_in + 20, 0x7f, 8);
  write_bytes(w.bytes, w.size);
  refused("data behind its end", "data behind the segment's end");
  put_typed(DOUBLE, 0, (uint64_t)1 << 40);
  put_double(&w, 1);
  end_segment();
  write_bytes(w.bytes, w.size);
  refused("more data than the file holds", "more values than the file holds");
  put_typed(DOUBLE, 0, (uint64_t)1 << 62);
  end_segment();
  write_bytes(w.bytes, w.size);
  refused("values of type 0xa", "a number of values beyond reason");
  put_typed(11, 0, 2);
  end_segment();
  write_bytes(w.bytes, w.size);
  refused("of type 0xb", "an unknown type");
  w.size = 0;
  begin_segment(METADATA | NEW_LIST);
  put_number(&w, 0, 4);
  end_metadata();
  end_segment();
  write_bytes(w.bytes, w.size);
  refused("no channel with numbers", "a file without a channel");
}

/* Two channels, the first with this path of size bytes. */
static void put_paths(const char *path, uint32_t size)
{
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 2, 4);
  put_number(&w, size, 4);
  put_bytes(&w, path, size);
  put_index(DOUBLE, 2);
  put_number(&w, 0, 4);
  put_string(&w, "/'g'/'other'");
  put_index(DOUBLE, 2);
  put_number(&w, 0, 4);
  end_metadata();
  for (int i = 0; i < 4; i++)
    put_double(&w, i);
  end_segment();
  write_bytes(w.bytes, w.size);
}

/* The whole path counts, not what a C string would show of it: the first of these was read beyond its copy's end. */
static void test_paths(void)
{
  put_paths("\0/'g'/'c'", 9);
  refused("path before byte 45 does not begin with \"/\"", "a path that begins with a NUL");
  put_paths("/\0'g'/'c'", 9);
  refused("path before byte 45 holds a NUL", "a path with a NUL behind its slash");
  put_paths("/'g'/'c\0'", 9);
  refused("path before byte 45 holds a NUL", "a path with a NUL in a name");
  put_paths("/'g\0'", 5);
  refused("path before byte 41 holds a NUL", "a group's path with a NUL");
  put_paths("x/'g'/'c'", 9);
  refused("path before byte 45 does not begin with \"/\"", "a path without its slash");
  put_paths("", 0);
  refused("path before byte 36 does not begin with \"/\"", "an empty path");
}

/* Every byte of a small file is set to other values: an error or a recording, and nothing else (sanitizers watch). */
static void test_every_byte(void)
{
  static const unsigned char values[] = {0, 1, 0x7f, 0x80, 0xff};
  put_file(INTERLEAVED);
  int read = 0, failed = 0;
  for (size_t i = 0; i < metadata_end; i += i < 500 ? 1 : 97)
    for (size_t k = 0; k < sizeof values; k++) {
      unsigned char old = w.bytes[i];
      w.bytes[i] = values[k];
      write_bytes(w.bytes, w.size);
      w.bytes[i] = old;
      struct eo_error error;
      struct eo_recording *r = read_fixture(NULL, NULL, &error);
      read += r != NULL;
      failed += r == NULL;
      eo_recording_free(r);
    }
  ok(read > 0 && failed > 0, "bytes set at random leave a recording or an error: %d files read, %d refused", read,
     failed);
}

/* Two channels of 100 values with up to three properties, the texts among them as texts. */
struct fact {
  const char *name, *text;
  double number;
};

static struct eo_recording *read_facts(const struct fact pinion_facts[3], const struct fact gear_facts[3],
                                       struct eo_notes *notes)
{
  const struct fact *facts[2] = {pinion_facts, gear_facts};
  struct eo_error error;
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 2, 4);
  for (int c = 0; c < 2; c++) {
    unsigned count = 0;
    while (count < 3 && facts[c][count].name)
      count++;
    put_string(&w, c ? "/'g'/'gear'" : "/'g'/'pinion'");
    put_index(DOUBLE, 100);
    put_number(&w, count, 4);
    for (unsigned i = 0; i < count; i++)
      if (facts[c][i].text)
        put_string_property(facts[c][i].name, facts[c][i].text);
      else
        put_double_property(facts[c][i].name, facts[c][i].number);
  }
  end_metadata();
  put_chunk(0, 100, 0);
  end_segment();
  write_bytes(w.bytes, w.size);
  return read_fixture(NULL, notes, &error);
}

static void interval_of(struct fact first, struct fact second, double interval, double other, const char *words,
                        const char *what)
{
  const struct fact facts[3] = {first, second};
  struct eo_notes notes = {0};
  struct eo_recording *r = read_facts(facts, facts, &notes);
  struct eo_clock clock = r ? eo_recording_clock(r, 0) : (struct eo_clock){.interval = NAN};
  ok(fabs(clock.interval - interval) < 1e-12 && fabs(clock.other - other) < 1e-12 && (!words || noted(&notes, words)),
     "%s: the intervals are %g and %g s", what, clock.interval, clock.other);
  eo_recording_free(r);
}

static void test_facts(void)
{
  const struct fact step = {"wf_increment", NULL, 2.5e-4}, rate = {"SampleRate", NULL, 8000};
  static const char said[] = "states a rate of 8000 Hz beside the step of its values (wf_increment), which is 4000 Hz";
  interval_of(step, rate, 2.5e-4, 0, said, "the step of the values before a rate of the hardware");
  interval_of(rate, step, 2.5e-4, 0, said, "a rate of the hardware before the step of the values");
  interval_of(step, (struct fact){"decimation", NULL, 10}, 2.5e-4, 0, NULL,
              "the step of the values is that after a decimation");
  interval_of((struct fact){"wf_increment", NULL, 1}, rate, 1, 1.25e-4, NULL, "a step that nobody set is no better");
  interval_of((struct fact){"dt", NULL, 2.5e-4}, rate, 2.5e-4, 1.25e-4, NULL, "two rates that contradict each other");
  interval_of((struct fact){"wf_increment", NULL, 0.25}, (struct fact){"wf_xunit_string", "ms", 0}, 2.5e-4, 0, NULL,
              "a step in the unit of its axis");
  interval_of((struct fact){"SampleRate", "4 kHz", 0}, (struct fact){0}, 2.5e-4, 0, NULL, "a rate that is a text");
  const struct fact one[3] = {step, {"wf_start_time", "2024-03-05T08:59:59.250", 0}},
                    two[3] = {step, {"wf_start_time", "2024-03-05T08:59:59.263", 0}};
  struct eo_recording *r = read_facts(one, two, NULL);
  ok(r && eo_recording_clock(r, 1).epoch - eo_recording_clock(r, 0).epoch == 13000000,
     "starts that are texts are 13 ms apart");
  eo_recording_free(r);
}

/* Two groups with time stamps and values of their own, which begin on either side of a full second. */
static void test_time_stamps(void)
{
  enum { COUNT = 40 };
  const double begin[2] = {0.9, 1.1};
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 4, 4);
  for (int g = 0; g < 2; g++) {
    put_string(&w, g ? "/'gear'/'time'" : "/'pinion'/'time'");
    put_index(TIMESTAMP, COUNT);
    put_number(&w, 0, 4);
    put_string(&w, g ? "/'gear'/'angle'" : "/'pinion'/'angle'");
    put_index(DOUBLE, COUNT);
    put_number(&w, 0, 4);
  }
  end_metadata();
  for (int g = 0; g < 2; g++) {
    for (int i = 0; i < COUNT; i++) {
      double at = begin[g] + 0.001 * i;
      put_number(&w, (uint64_t)((at - floor(at)) * 0x1p64), 8);
      put_number(&w, 3792474000 + (uint64_t)at, 8);
    }
    for (int i = 0; i < COUNT; i++)
      put_double(&w, i);
  }
  end_segment();
  struct eo_error error;
  write_bytes(w.bytes, w.size);
  struct eo_recording *r = read_fixture(NULL, NULL, &error);
  ok(r && fabs(cell_of(r, 0, 2) - cell_of(r, 0, 0) - 0.2) < 1e-9, "time stamps of all channels count from one moment%s",
     r ? "" : error.text);
  ok(r && eo_recording_clock(r, 2).epoch == (3792474000 - 2082844800) * (int64_t)1000000000,
     "which is known, for other files to be compared with");
  ok(r && !strcmp(eo_recording_name(r, 1), "pinion angle") && !strcmp(eo_recording_name(r, 3), "gear angle"),
     "every channel of one name gets that of its group");
  eo_recording_free(r);
}

/* Sums whose parts are sums again: each scale doubles what one value costs, and it is said that they are not applied.
 */
static void test_sums_of_sums(void)
{
  struct eo_error error;
  char name[64];
  w.size = 0;
  begin_segment(METADATA | NEW_LIST | DATA);
  put_number(&w, 1, 4);
  put_string(&w, "/'g'/'sine'");
  put_index(UINT8, 60000);
  put_number(&w, 2 + 3 * 16, 4);
  put_string_property("NI_Scaling_Status", "unscaled");
  put_string(&w, "NI_Number_Of_Scales");
  put_number(&w, 7, 4);
  put_number(&w, 16, 4);
  for (int i = 0; i < 16; i++) {
    snprintf(name, sizeof name, "NI_Scale[%d]_Scale_Type", i);
    put_string_property(name, "Add");
    snprintf(name, sizeof name, "NI_Scale[%d]_Add_Left_Operand_Input_Source", i);
    put_double_property(name, i - 1);
    snprintf(name, sizeof name, "NI_Scale[%d]_Add_Right_Operand_Input_Source", i);
    put_double_property(name, i - 1);
  }
  end_metadata();
  for (int i = 0; i < 60000; i++)
    put_number(&w, 1, 1);
  end_segment();
  write_bytes(w.bytes, w.size);
  struct eo_notes notes = {0};
  struct eo_recording *r = read_fixture(NULL, &notes, &error);
  ok(!r && noted(&notes, "a scale that is not known here"), "scales that lead to each other again and again%s",
     r ? " were applied" : "");
  eo_recording_free(r);
}

int main(void)
{
  fixture_open();
  test_facts();
  test_kind(0, "contiguous, three segments");
  test_kind(INTERLEAVED, "interleaved, three segments");
  test_kind(BIG, "big-endian, contiguous");
  test_kind(BIG | INTERLEAVED, "big-endian, interleaved");
  test_types();
  test_texts(28);
  test_texts(20);
  test_scaled();
  test_time_stamps();
  test_sums_of_sums();
  test_slow(2e-3, 1);
  test_slow(5e-5, 0);
  test_damage();
  test_paths();
  test_every_byte();
  return fixture_close();
}

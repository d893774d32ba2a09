/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rig files over the API: uploads that are whole, broken, too large or cut off, a server that dies in the middle, and
   what the recordings say beside the prediction. The recordings come from the API itself, with known faults. */
#include "api/description.h"

#include <dirent.h>
#include <math.h>
#include <poll.h>
#include <zlib.h>

#define EDGE "----edge"
static const char form_type[] = "Content-Type: multipart/form-data; boundary=" EDGE "\r\n";

struct form {
  char *text;
  size_t size;
};

static void add_part(struct form *form, const char *name, const char *file, const void *data, size_t size)
{
  char head[400];
  int length = snprintf(head, sizeof head, "--" EDGE "\r\nContent-Disposition: form-data; name=\"%s\"%s%s%s\r\n\r\n",
                        name, file ? "; filename=\"" : "", file ? file : "", file ? "\"" : "");
  form->text = realloc(form->text, form->size + (size_t)length + size + 3);
  memcpy(form->text + form->size, head, (size_t)length);
  if (size)
    memcpy(form->text + form->size + length, data, size);
  memcpy(form->text + form->size + (size_t)length + size, "\r\n", 3);
  form->size += (size_t)length + size + 2;
}

static void add_text(struct form *form, const char *name, const char *value)
{
  if (value)
    add_part(form, name, NULL, value, strlen(value));
}

static void end_form(struct form *form)
{
  static const char last[] = "--" EDGE "--\r\n";
  form->text = realloc(form->text, form->size + sizeof last);
  memcpy(form->text + form->size, last, sizeof last);
  form->size += sizeof last - 1;
}

struct upload {
  const char *design, *label, *torque, *speed, *layout, *name;
  const struct reply *file, *gear;
};

static struct form make_form(const struct upload *u)
{
  struct form form = {0};
  add_text(&form, "design", u->design);
  add_text(&form, "label", u->label);
  add_text(&form, "torque_Nm", u->torque);
  add_text(&form, "speed_rpm", u->speed);
  add_text(&form, "layout", u->layout);
  if (u->file)
    add_part(&form, "file", u->name ? u->name : "run.csv", u->file->body, u->file->size);
  if (u->gear)
    add_part(&form, "file", "gear.csv", u->gear->body, u->gear->size);
  end_form(&form);
  return form;
}

static const char *target = API "/measurements";

/* size: bytes of the form that are sent; length: what is said of it. */
static struct reply post_bytes(const struct form *form, size_t size, size_t length)
{
  struct reply reply = {0};
  char head[300];
  int connection = open_connection();
  snprintf(head, sizeof head, "POST %s HTTP/1.1\r\nHost: localhost\r\n%sContent-Length: %zu\r\n\r\n", target, form_type,
           length);
  send_text(connection, head);
  send_bytes(connection, form->text, size);
  bool whole = size == length || size == 0; /* else the client goes away in the middle */
  for (int i = 0; !whole && i < 10; i++)
    wait_a_little();
  if (!whole || !read_reply(connection, &reply, false))
    reply.status = 0;
  close(connection);
  hear("POST", target, &reply);
  return reply;
}

static struct reply post(const struct upload *u)
{
  struct form form = make_form(u);
  struct reply reply = post_bytes(&form, form.size, form.size);
  free(form.text);
  return reply;
}

static json_t *body_of(const struct reply *reply)
{
  return reply->size ? json_loadb(reply->body, reply->size, 0, NULL) : NULL;
}

static int count_kept(void)
{
  json_t *list = call_json("GET", API "/measurements", NULL, NULL, NULL);
  int count = json_is_array(json_object_get(list, "items")) ? (int)json_array_size(json_object_get(list, "items")) : -1;
  json_decref(list);
  return count;
}

static int count_folders(void)
{
  char path[300];
  snprintf(path, sizeof path, "%s/measurements", server.folder);
  DIR *directory = opendir(path);
  int count = 0;
  for (const struct dirent *entry; directory && (entry = readdir(directory));)
    count += *entry->d_name != '.';
  if (directory)
    closedir(directory);
  return count;
}

/* Folders of refused uploads go once the reply is out; those of a client that went away at the latest with the time a
   pause may last. */
static bool folders_become(int count)
{
  for (double end = seconds_now() + 40; seconds_now() < end; wait_a_little())
    if (count_folders() == count)
      return true;
  printf("# %d folders, not %d\n", count_folders(), count);
  return false;
}

/* Nothing the server says names a place of its machine. */
static bool is_discreet(const struct reply *reply)
{
  return !reply->body || (!strstr(reply->body, server.folder) && !strstr(reply->body, "incoming"));
}

static json_t *design;

/* settings: JSON of the synthetic rig. */
static struct reply record(const char *settings)
{
  json_t *order = json_pack("{s:O, s:o}", "design", design, "rig", json_loads(settings, 0, NULL));
  char *text = json_dumps(order, JSON_COMPACT);
  struct reply reply = call("POST", API "/rig", "Prefer: wait=60\r\n", text);
  free(text);
  json_decref(order);
  return reply;
}

#define POINT "\"torque_Nm\":828,\"speed_rpm\":2000,\"turns\":20"
static struct reply modified, unmodified;

static void test_rig(void)
{
  modified = record("{" POINT "}");
  unmodified = record("{" POINT ",\"unmodified\":true,\"torque_column\":true,\"speed_column\":true}");
  ok(modified.status == 200 && strncmp(modified.body, "t_s,angle1_deg", 14) == 0,
     "a synthetic recording is made, answer %d", modified.status);
  const char *header = header_of(&modified, "Content-Disposition");
  ok(header && strstr(header, "rig-828Nm-2000rpm.csv"), "a synthetic recording comes as a file with a name");
  struct reply again = record("{" POINT "}");
  ok(again.size == modified.size && memcmp(again.body, modified.body, again.size) == 0,
     "a synthetic recording is the same each time");
  free_reply(&again);
  again = record("{\"turns\":1e6}");
  ok(again.status == 422 && !header_of(&again, "Content-Disposition"),
     "a synthetic recording that is too long is refused with %d", again.status);
  free_reply(&again);
  again = record("{\"turn\":1}");
  ok(again.status == 422 && strstr(again.body, "/rig/turn"), "a synthetic recording with a misspelt key is refused");
  free_reply(&again);
}

static double number_of(const json_t *document, const char *a, const char *b)
{
  return json_number_value(json_object_get(json_object_get(json_object_get(document, "result"), a), b));
}

/* What the terminal measures without keeping anything. */
static void test_trial(void)
{
  const struct upload u = {"1", "modified", "828", "2000", NULL, "run.csv", &modified, NULL};
  target = API "/measure";
  struct reply reply = post(&u);
  target = API "/measurements";
  json_t *document = body_of(&reply);
  ok(reply.status == 200 && fabs(number_of(document, "speed_rpm", "mean") - 2000) < 0.1,
     "a recording is measured without being kept: %d", reply.status);
  ok(count_kept() == 0 && folders_become(0), "nothing stays of a recording that was not to be kept");
  json_decref(document);
  free_reply(&reply);
}

static void test_upload(void)
{
  const struct upload u = {"1", "modified", "828", "2000", NULL, "../../etc/r\xff\"un.csv", &modified, NULL};
  struct reply reply = post(&u), other;
  json_t *document = body_of(&reply);
  ok(reply.status == 201 && strcmp(header_of(&reply, "Location"), API "/measurements/1") == 0,
     "an upload is kept: %d %.200s", reply.status, reply.status == 201 ? "" : reply.body);
  ok(fabs(number_of(document, "speed_rpm", "mean") - 2000) < 0.1, "the speed of the upload is %.4f rpm",
     number_of(document, "speed_rpm", "mean"));
  ok(number_of(document, "rms_m_per_s2", "value") > 1 && number_of(document, "rms_m_per_s2", "sigma") > 0,
     "the RMS of the upload is %.4g +- %.2g m/s2", number_of(document, "rms_m_per_s2", "value"),
     number_of(document, "rms_m_per_s2", "sigma"));
  ok(json_array_size(json_object_get(document, "notes")) > 2, "the answer to an upload says what was guessed");
  const char *name = json_string_value(json_object_get(document, "file"));
  ok(name && !strchr(name, '/') && !strchr(name, '\\') && is_discreet(&reply), "a hostile name becomes \"%s\"",
     name ? name : "");
  free_reply(&reply);
  reply = post(&u);
  json_t *same = body_of(&reply);
  ok(reply.status == 200 && json_equal(same, document) && count_kept() == 1 && folders_become(1),
     "an upload that is sent again is the same measurement, answer %d", reply.status);
  free_reply(&reply);
  other = call("GET", API "/measurements/1", NULL, NULL);
  json_decref(same);
  same = body_of(&other);
  ok(other.status == 200 && json_equal(same, document), "a measurement is got as the upload was answered");
  char tag[200];
  snprintf(tag, sizeof tag, "If-None-Match: %s\r\n", header_of(&other, "ETag"));
  free_reply(&other);
  other = call("GET", API "/measurements/1", tag, NULL);
  ok(other.status == 304, "a measurement that the client knows is not sent again");
  free_reply(&other);
  other = call("GET", API "/measurements/1/file", NULL, NULL);
  ok(other.status == 200 && other.size == modified.size && memcmp(other.body, modified.body, other.size) == 0,
     "the file of a measurement comes back as it went");
  const char *file_hash =
      json_string_value(json_object_get(json_array_get(json_object_get(document, "files"), 0), "sha256"));
  ok(strstr(header_of(&other, "ETag"), file_hash) && strncmp(header_of(&other, "Repr-Digest"), "sha-256=:", 9) == 0,
     "the file of a measurement comes with its check sum");
  free_reply(&other);
  other = call("HEAD", API "/measurements/1/file", NULL, NULL);
  ok(other.status == 200 && (size_t)atol(header_of(&other, "Content-Length")) == modified.size,
     "HEAD tells the size of a measurement's file");
  free_reply(&other);
  other = call("GET", API "/measurements/1/file?part=2", NULL, NULL);
  ok(other.status == 404, "a measurement of one file has no second one");
  free_reply(&other);
  json_decref(same);
  json_decref(document);
}

/* Columns of the recording as two files: time and one angle each. */
static void split(const struct reply *whole, struct reply *pinion, struct reply *gear)
{
  size_t sizes[2];
  FILE *stream[2] = {open_memstream(&pinion->body, &sizes[0]), open_memstream(&gear->body, &sizes[1])};
  char t[40], a[40], b[40];
  for (const char *line = whole->body; sscanf(line, "%39[^,],%39[^,],%39[^\n]", t, a, b) == 3;
       line = strchr(line, '\n') + 1) {
    fprintf(stream[0], "%s,%s\n", t, a);
    fprintf(stream[1], "%s,%s\n", t, b);
  }
  fclose(stream[0]);
  fclose(stream[1]);
  pinion->size = sizes[0];
  gear->size = sizes[1];
}

static void test_two_files(void)
{
  struct reply pinion = {0}, gear = {0};
  split(&modified, &pinion, &gear);
  struct reply reply = post(&(struct upload){"1", "modified", "828", NULL, NULL, "pinion.csv", &pinion, &gear});
  json_t *document = body_of(&reply), *first = call_json("GET", API "/measurements/1", NULL, NULL, NULL);
  ok(reply.status == 201 && json_array_size(json_object_get(document, "files")) == 2,
     "an upload of one file for each encoder is kept: %d %.300s", reply.status, reply.status == 201 ? "" : reply.body);
  ok(fabs(number_of(document, "rms_m_per_s2", "value") / number_of(first, "rms_m_per_s2", "value") - 1) < 1e-6,
     "one file for each encoder gives the same RMS as both in one");
  free_reply(&reply);
  reply = call("DELETE", API "/measurements/5", NULL, NULL);
  ok(reply.status == 204 && count_kept() == 1 && folders_become(1), "a measurement is deleted with its files");
  free_reply(&reply);
  json_decref(first);
  json_decref(document);
  free_reply(&pinion);
  free_reply(&gear);
}

/* The recording with a line beside the first mesh order, one turn of the pinion away. */
static void add_sideband(const struct reply *whole, struct reply *changed)
{
  FILE *stream = open_memstream(&changed->body, &changed->size);
  double t, a, b;
  const char *line = strchr(whole->body, '\n') + 1;
  fprintf(stream, "%.*s", (int)(line - whole->body), whole->body);
  for (; sscanf(line, "%lf,%lf,%lf", &t, &a, &b) == 3; line = strchr(line, '\n') + 1)
    fprintf(stream, "%.9f,%.9f,%.9f\n", t, a, b + 2e-3 * sin(18 * a * M_PI / 180));
  fclose(stream);
}

/* Raw tracks, a recording without its time, sidebands: each has keys of its own in the answer. */
static void test_kinds(void)
{
  static const char untimed[] = "{\"time\":\"none\",\"sample_rate_Hz\":20000,\"columns\":{\"pinion\":2,\"gear\":3},"
                                "\"kind\":\"angles\",\"unit\":\"deg\"}";
  struct reply beside = {0},
               tracks = record("{" POINT ",\"output\":\"sine-cosine\",\"pinion_lines\":100,\"gear_lines\":100}"), reply;
  add_sideband(&modified, &beside);
  reply = post(&(struct upload){"1", "modified", "828", "2000", "{\"lines\":100}", "tracks.csv", &tracks, NULL});
  ok(reply.status == 201 && strstr(reply.body, "\"amplitude\""), "raw tracks of the encoders are measured: %d %.200s",
     reply.status, reply.status == 201 ? "" : reply.body);
  free_reply(&reply);
  reply = post(&(struct upload){"1", "modified", "828", "2000", untimed, "untimed.csv", &modified, NULL});
  ok(reply.status == 201 && strstr(reply.body, "\"sample_rate_Hz\""),
     "rows without a time are measured by their rate: %d %.200s", reply.status, reply.status == 201 ? "" : reply.body);
  free_reply(&reply);
  reply = post(&(struct upload){"1", "modified", "828", "2000", NULL, "beside.csv", &beside, NULL});
  json_t *document = body_of(&reply);
  const json_t *first = json_array_get(json_object_get(json_object_get(document, "result"), "sidebands"), 0);
  ok(json_integer_value(json_object_get(first, "mesh_order")) == 1 &&
         json_integer_value(json_object_get(first, "turns")) == 1,
     "the first sideband is one of the first mesh order at one turn");
  json_decref(document);
  free_reply(&reply);
  free_reply(&beside);
  free_reply(&tracks);
  for (int id = 2; id <= 4; id++) {
    char path[60];
    snprintf(path, sizeof path, API "/measurements/%d", id);
    reply = call("DELETE", path, NULL, NULL);
    free_reply(&reply);
  }
  ok(count_kept() == 1, "the measurements of this test are deleted");
}

static const struct refusal {
  const char *what, *settings;
  int status;
  const char *kind;
} refusals[] = {
    {"a recording with a slip", "{" POINT ",\"fault\":\"slip\",\"fault_row\":5000,\"fault_size\":3}", 422, "slip"},
    {"a recording of other teeth", "{" POINT ",\"fault\":\"teeth\",\"fault_size\":1}", 422, "teeth"},
    {"a recording with a channel that stands still", "{" POINT ",\"fault\":\"constant\"}", 422, "constant"},
    {"a recording that is too short", "{\"torque_Nm\":828,\"speed_rpm\":2000,\"turns\":0.5}", 422, NULL},
    {"a recording with swapped channels", "{" POINT ",\"fault\":\"swapped\"}", 201, "swapped"},
    {"a recording with a reversed sign", "{" POINT ",\"fault\":\"reversed\"}", 201, "reversed"},
    {"a recording with dropped rows", "{" POINT ",\"fault\":\"dropped\",\"fault_row\":5000,\"fault_size\":5}", 201,
     "dropped"},
    {"a recording with a decimal comma",
     "{" POINT ",\"decimal_comma\":true,\"separator\":\"semicolon\",\"byte_order_mark\":true,\"carriage_return\":true}",
     201, NULL},
};

static bool has_finding(const json_t *document, const char *kind)
{
  json_t *finding;
  size_t i;
  json_array_foreach(json_object_get(document, "findings"), i,
                     finding) if (strcmp(json_string_value(json_object_get(finding, "kind")), kind) == 0) return true;
  return false;
}

static void test_faults(void)
{
  for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
    const struct refusal *r = &refusals[i];
    int before = count_kept();
    struct reply file = record(r->settings),
                 reply = post(&(struct upload){"1", "modified", "828", NULL, NULL, NULL, &file, NULL});
    json_t *document = body_of(&reply);
    if (!ok(reply.status == r->status && (!r->kind || has_finding(document, r->kind)),
            "%s: answered with %d, %d is right", r->what, reply.status, r->status))
      printf("# %.600s\n", reply.body ? reply.body : "");
    ok(count_kept() == before + (r->status == 201) && is_discreet(&reply), "%s: %s", r->what,
       r->status == 201 ? "one measurement more is kept" : "nothing is kept");
    json_decref(document);
    free_reply(&file);
    free_reply(&reply);
  }
  ok(folders_become(count_kept()), "no files are left of what was refused");
}

static void refuse(const char *what, const struct upload *u, int status, const char *holds)
{
  struct reply reply = post(u);
  if (!ok(reply.status == status && (!holds || (reply.body && strstr(reply.body, holds))) && is_discreet(&reply),
          "%s: answered with %d", what, reply.status))
    printf("# %.400s\n", reply.body ? reply.body : "");
  free_reply(&reply);
}

static void test_words(void)
{
  struct reply cake = {.body = (char *)"no numbers at all\nin this file\n", .size = 31},
               none = {.body = (char *)"", .size = 0};
  struct reply half = {.body = modified.body, .size = 40};
  int before = count_kept();
  refuse("an upload for no design", &(struct upload){"77", "modified", "828", NULL, NULL, NULL, &modified, NULL}, 422,
         "/design");
  refuse("an upload without a label", &(struct upload){"1", NULL, "828", NULL, NULL, NULL, &modified, NULL}, 422,
         "/label");
  refuse("an upload with an unknown label", &(struct upload){"1", "new", "828", NULL, NULL, NULL, &modified, NULL}, 422,
         "/label");
  refuse("an upload without a torque", &(struct upload){"1", "modified", NULL, NULL, NULL, NULL, &modified, NULL}, 422,
         "/torque_Nm");
  refuse("a torque that is none", &(struct upload){"1", "modified", "1e400", NULL, NULL, NULL, &modified, NULL}, 422,
         "/torque_Nm");
  refuse("an upload with five faults", &(struct upload){NULL, "x", "-1", "fast", "{", NULL, &modified, NULL}, 422,
         "\"5 values are wrong.\"");
  refuse("a layout with an unknown key",
         &(struct upload){"1", "modified", "828", NULL, "{\"colums\":{}}", NULL, &modified, NULL}, 422,
         "/layout/colums");
  refuse("a column that is not there",
         &(struct upload){"1", "modified", "828", NULL, "{\"columns\":{\"pinion\":9}}", NULL, &modified, NULL}, 422,
         "/layout/columns");
  refuse("an upload without a file", &(struct upload){"1", "modified", "828", NULL, NULL, NULL, NULL, NULL}, 422,
         "file");
  refuse("an empty file", &(struct upload){"1", "modified", "828", NULL, NULL, NULL, &none, NULL}, 422, "empty");
  refuse("a file without a table", &(struct upload){"1", "modified", "828", NULL, NULL, NULL, &cake, NULL}, 422, NULL);
  refuse("the beginning of a file", &(struct upload){"1", "modified", "828", NULL, NULL, NULL, &half, NULL}, 422, NULL);
  refuse("a recording at another speed than said",
         &(struct upload){"1", "modified", "828", "3000", NULL, NULL, &modified, NULL}, 201, "\"speed\"");
  ok(count_kept() == before + 1 && folders_become(before + 1), "the last one of these uploads is kept, and no other");
}

static void expect(const char *what, struct reply reply, int status)
{
  if (!ok(reply.status == status, "%s: answered with %d", what, reply.status))
    printf("# %.300s\n", reply.body ? reply.body : "");
  free_reply(&reply);
}

static void test_bodies(void)
{
  const struct upload u = {"1", "unmodified", "828", NULL, NULL, NULL, &unmodified, NULL};
  struct form form = make_form(&u), twice = {0};
  int before = count_kept();
  expect("JSON in place of a form", call("POST", API "/measurements", NULL, "{}"), 415);
  expect("a form of another kind",
         call("POST", API "/measurements", "Content-Type: application/x-www-form-urlencoded\r\n", "design=1"), 415);
  expect("a form without a boundary", call("POST", API "/measurements", "Content-Type: multipart/form-data\r\n", "x"),
         415);
  expect("a form without a body", call("POST", API "/measurements", form_type, ""), 422);
  expect("a body that ends before its form", post_bytes(&form, form.size / 2, form.size / 2), 400);
  expect("a connection that ends before its body", post_bytes(&form, form.size / 2, form.size), 0);
  expect("a body above the limit", post_bytes(&form, 0, (size_t)3 << 30), 413);
  add_text(&twice, "design", "1");
  add_text(&twice, "design", "2");
  end_form(&twice);
  expect("a part that comes twice", post_bytes(&twice, twice.size, twice.size), 422);
  free(twice.text);
  twice = (struct form){0};
  add_text(&twice, "colour", "red");
  end_form(&twice);
  expect("a part that nobody knows", post_bytes(&twice, twice.size, twice.size), 422);
  free(twice.text);
  twice = (struct form){0};
  add_text(&twice, "", "1");
  twice.text = realloc(twice.text, twice.size + form.size);
  memcpy(twice.text + twice.size, form.text, form.size);
  twice.size += form.size;
  expect("a part with an empty name before all that is known", post_bytes(&twice, twice.size, twice.size), 422);
  free(twice.text);
  twice = (struct form){0};
  add_part(&twice, "layout", NULL, "null\0{", 6);
  twice.text = realloc(twice.text, twice.size + form.size);
  memcpy(twice.text + twice.size, form.text, form.size);
  twice.size += form.size;
  expect("a part with a NUL, behind which nobody would look", post_bytes(&twice, twice.size, twice.size), 422);
  free(twice.text);
  twice = (struct form){0};
  char *long_text = calloc(1, 100001);
  memset(long_text, 'x', 100000);
  add_text(&twice, "layout", long_text);
  end_form(&twice);
  expect("a part that is too long", post_bytes(&twice, twice.size, twice.size), 413);
  free(long_text);
  free(twice.text);
  static const struct {
    const char *what, *text;
    int status;
  } odd[] = {
      {"a part without a name", "--" EDGE "\r\nContent-Disposition: form-data\r\n\r\n1\r\n--" EDGE "--\r\n", 400},
      {"a part that is no part", "--" EDGE "\r\nnothing\r\n\r\n1\r\n--" EDGE "--\r\n", 400},
      {"a part in base64",
       "--" EDGE "\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a\"\r\nContent-Transfer-Encoding: "
       "base64\r\n\r\nMQ==\r\n--" EDGE "--\r\n",
       415},
      {"a form of other bytes", "\x1f\x8b\x08 nonsense", 422}};
  for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
    expect(
        odd[i].what,
        post_bytes(&(struct form){(char *)odd[i].text, strlen(odd[i].text)}, strlen(odd[i].text), strlen(odd[i].text)),
        odd[i].status);
  ok(count_kept() == before && folders_become(before), "nothing is kept of any wrong form");
  expect("an upload from another site",
         call("POST", API "/measurements",
              "Origin: http://elsewhere.example\r\nContent-Type: multipart/form-data; boundary=x\r\n", "x"),
         403);
  free(form.text);
}

/* A recording that takes a while to read and to measure. */
static struct form make_slow_form(void)
{
  enum { ROWS = 600000 };
  struct form form = {0};
  char path[300];
  static char bytes[16 << 20];
  snprintf(path, sizeof path, "%s/slow.csv.gz", server.folder);
  gzFile file = gzopen(path, "wb1");
  gzputs(file, "t_s,angle1_deg,angle2_deg\n");
  for (int i = 0; i < ROWS; i++)
    gzprintf(file, "%.5f,%.4f,%.4f\n", 5e-5 * i, 0.6 * i, 0.6 * i * 23 / 57); /* of another pair: nothing is kept */
  gzclose(file);
  FILE *packed = fopen(path, "rb");
  size_t size = packed ? fread(bytes, 1, sizeof bytes, packed) : 0;
  if (packed)
    fclose(packed);
  remove(path);
  add_text(&form, "design", "1");
  add_text(&form, "label", "modified");
  add_text(&form, "torque_Nm", "828");
  add_text(&form, "speed_rpm", "2000");
  add_part(&form, "file", "slow.csv.gz", bytes, size);
  end_form(&form);
  return form;
}

static int begin_post(uint32_t source, const struct form *form)
{
  char head[300];
  int connection = open_connection_from(source);
  snprintf(head, sizeof head, "POST %s HTTP/1.1\r\nHost: localhost\r\n%sContent-Length: %zu\r\n\r\n", target, form_type,
           form->size);
  send_text(connection, head);
  send_bytes(connection, form->text, form->size);
  return connection;
}

/* One client's slow files leave a reader to others. */
static void test_slow_files(void)
{
  enum { SLOW = 3 };
  struct form slow = make_slow_form(), quick = {0};
  struct reply reply = {0};
  int connection[SLOW], unanswered = 0, before = count_folders();
  add_part(&quick, "file", "quick.csv", "t,a,b\n1,2,3\n", 12);
  end_form(&quick);
  for (int i = 0; i < SLOW; i++)
    connection[i] = begin_post(INADDR_LOOPBACK, &slow);
  for (int i = 0; i < 10; i++)
    wait_a_little(); /* they are being read */
  int other = begin_post(INADDR_LOOPBACK + 1, &quick);
  read_reply(other, &reply, false);
  for (int i = 0; i < SLOW; i++) {
    unanswered += poll(&(struct pollfd){.fd = connection[i], .events = POLLIN}, 1, 0) == 0;
    close(connection[i]);
  }
  close(other);
  ok(reply.status == 422 && unanswered == SLOW, "the recording of another client is answered (%d) before %d slow ones",
     reply.status, unanswered);
  for (int i = 0; i < 10 && !folders_become(before); i++)
    continue;
  ok(count_folders() == before, "nothing is kept of uploads that broke off");
  free_reply(&reply);
  free(slow.text);
  free(quick.text);
}

/* The server dies while a file comes in: the next one knows nothing of it. */
static void test_kill(void)
{
  const struct upload u = {"1", "unmodified", NULL, NULL, NULL, NULL, &unmodified, NULL};
  struct form form = make_form(&u);
  char head[300];
  int before = count_kept(), connection = open_connection();
  snprintf(head, sizeof head, "POST " API "/measurements HTTP/1.1\r\nHost: localhost\r\n%sContent-Length: %zu\r\n\r\n",
           form_type, form.size);
  send_text(connection, head);
  send_bytes(connection, form.text, form.size - 1000);
  ok(folders_become(before + 1), "a file is on its way to the server");
  stop_server(SIGKILL);
  close(connection);
  ok(count_folders() == before + 1, "the server dies and leaves a file half stored");
  ok(start_server("--quiet", "--threads", "2"), "another server starts after one that died");
  ok(count_folders() == before && count_kept() == before, "nothing half-stored is there after the start");
  struct reply reply = post(&u);
  json_t *document = body_of(&reply);
  ok(reply.status == 201, "a file whose upload died is taken when it is sent again, answer %d", reply.status);
  ok(fabs(json_number_value(json_object_get(document, "torque_Nm")) - 828) < 0.5,
     "the column of torque stands for a torque that was not stated");
  json_decref(document);
  free_reply(&reply);
  free(form.text);
}

static void test_comparison(void)
{
  struct reply reply = call("GET", API "/measurements/1/comparison", "Prefer: wait=60\r\n", NULL);
  json_t *document = body_of(&reply);
  double ratio = json_number_value(json_object_get(document, "ratio"));
  ok(reply.status == 200 && fabs(ratio - 1) < 0.02, "a recording of the model lies beside the model: %.4f times",
     ratio);
  free_reply(&reply);
  json_decref(document);
  document = call_json("GET", API "/designs/1/comparison", "Prefer: wait=60\r\n", NULL, NULL);
  ok((int)json_array_size(json_object_get(document, "id")) == count_kept(),
     "all measurements of the design are in its comparison");
  ok(json_array_size(json_object_get(document, "reductions")) > 0,
     "the comparison has modified recordings beside the unmodified one");
  json_decref(document);
  json_t *softer = json_deep_copy(design);
  json_object_set_new(json_object_get(softer, "supports"), "mesh_damping_ratio", json_real(0.2));
  char *text = json_dumps(softer, JSON_COMPACT);
  document = call_json("POST", API "/designs/1/comparison", "Prefer: wait=60\r\n", text, NULL);
  ok(fabs(json_number_value(json_object_get(document, "ratio")) - 1) > 0.02,
     "recordings of the design lie elsewhere beside one with more damping");
  json_decref(document);
  json_decref(softer);
  free(text);
  reply = call("GET", API "/designs/1/comparison.csv", NULL, NULL);
  ok(reply.status == 200 && strncmp(reply.body, "file,label,torque_Nm", 20) == 0,
     "the comparison comes as a table too");
  free_reply(&reply);
  expect("a comparison of nothing", call("GET", API "/measurements/99/comparison", NULL, NULL), 404);
  expect("a comparison of no design", call("GET", API "/designs/99/comparison", NULL, NULL), 404);
}

/* The recordings were made with the design's own damping, 0.07: the fit has to find it in its range. */
static void test_fit(void)
{
  struct reply reply = call("POST", API "/designs/1/fit", NULL,
                            "{\"unknowns\":{\"mesh_damping_ratio\":[0.02,0.3]},\"measurements\":[1]}");
  json_t *document = body_of(&reply), *unknown = json_array_get(json_object_get(document, "unknowns"), 0);
  double value = json_number_value(json_object_get(unknown, "value"));
  ok(reply.status == 200 && fabs(value - 0.07) < 0.004, "the fit finds the damping, %.4f", value);
  json_t *applied = json_object_get(json_object_get(json_object_get(document, "design"), "supports"),
                                    "mesh_damping_ratio");
  ok(fabs(json_number_value(applied) - value) < 1e-9 && json_array_size(json_object_get(document, "id")) == 1,
     "the damping stands in the design that comes with the fit");
  json_decref(document);
  free_reply(&reply);
  expect("a fit of nothing", call("POST", API "/designs/1/fit", NULL, "{\"unknowns\":{}}"), 422);
  expect("a fit of what is not known", call("POST", API "/designs/1/fit", NULL, "{\"unknowns\":{\"colour\":[0,1]}}"),
         422);
  expect("a fit without measurements",
         call("POST", API "/designs/1/fit", NULL,
              "{\"unknowns\":{\"mesh_damping_ratio\":[0.02,0.3]},\"measurements\":[]}"),
         422);
}

/* The design becomes another pair: its measurements stay, and are left out with the reason. */
static void test_other_pair(void)
{
  json_t *other = json_deep_copy(design);
  json_object_set_new(json_object_get(other, "gear_pair"), "gear_teeth", json_integer(45));
  char *text = json_dumps(other, JSON_COMPACT);
  expect("another pair in the place of the design", call("PUT", API "/designs/1", "If-Match: *\r\n", text), 200);
  json_t *document = call_json("GET", API "/designs/1/comparison", "Prefer: wait=60\r\n", NULL, NULL);
  ok(json_array_size(json_object_get(document, "id")) == 0 &&
         (int)json_array_size(json_object_get(document, "left_out")) == count_kept(),
     "another pair under the number of the design leaves its measurements out of the comparison");
  expect("a deletion of a design with measurements", call("DELETE", API "/designs/1", NULL, NULL), 409);
  json_decref(document);
  json_decref(other);
  free(text);
}

static void name_in_folder(char *path, size_t size, const char *name)
{
  snprintf(path, size, "%s/%s", server.folder, name);
}

/* A recording that the database does not know, as after an older one was put back, and a folder of somebody's. */
static void test_set_aside(void)
{
  char path[300];
  name_in_folder(path, sizeof path, "measurements/700");
  mkdir(path, 0777);
  name_in_folder(path, sizeof path, "measurements/700/0");
  FILE *file = fopen(path, "w");
  ok(file && fputs("1,2,3", file) >= 0 && fclose(file) == 0, "a recording without a row is laid into the folder");
  name_in_folder(path, sizeof path, "measurements/backup");
  mkdir(path, 0777);
  int kept = count_kept();
  ok(stop_server(SIGTERM) == 0 && start_server("--quiet"), "the next server starts");
  json_t *health = call_json("GET", API "/health", NULL, NULL, NULL);
  const char *warning = json_string_value(json_array_get(json_object_get(health, "warnings"), 0));
  ok(warning && strstr(warning, "1 recording ") && strstr(warning, "lost+found"),
     "the next server says that a recording was moved: %s", warning);
  json_decref(health);
  ok(access(path, F_OK) == 0 && count_kept() == kept, "what is not its own stays, and so do all recordings with a row");
  name_in_folder(path, sizeof path, "measurements/lost+found/700/0");
  ok(access(path, F_OK) == 0, "a recording without a row lies where the server says");
}

/* The recordings beside a database that is not theirs. */
static void test_new_database(void)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm"};
  char path[300];
  int status = 0;
  for (int i = 0; i < 3; i++) {
    name_in_folder(path, sizeof path, names[i]);
    unlink(path);
  }
  bool started = start_server("--quiet");
  waitpid(server.pid, &status, started ? WNOHANG : 0);
  name_in_folder(path, sizeof path, "measurements/1/0");
  ok(!started && WIFEXITED(status) && WEXITSTATUS(status) == 2 && access(path, F_OK) == 0,
     "beside a new database no server starts, and the recordings stay");
  if (started)
    stop_server(SIGTERM);
}

int main(void)
{
  signal(SIGPIPE, SIG_IGN);
  if (!make_data_folder() || !ok(start_server("--quiet", "--threads", "2"), "the server starts"))
    return 1;
  ok(listen_to_replies(), "the server describes itself");
  design = coarse_document("ga", 10);
  char *text = json_dumps(design, JSON_COMPACT);
  expect("a design to measure", call("POST", API "/designs", NULL, text), 201);
  test_rig();
  test_trial();
  test_upload();
  test_kinds();
  test_two_files();
  test_faults();
  test_words();
  test_bodies();
  test_slow_files();
  test_kill();
  test_comparison();
  test_fit();
  test_other_pair();
  test_set_aside();
  free(text);
  json_decref(design);
  free_reply(&modified);
  free_reply(&unmodified);
  ok(stop_server(SIGTERM) == 0, "the server stops when told");
  test_new_database();
  remove_data_folder();
  expect_all_of((const char *const[]){"Measurement", "ListedMeasurement", "Comparison", "Fit", NULL}, NULL);
  tell_what_was_heard();
  return tap_done();
}

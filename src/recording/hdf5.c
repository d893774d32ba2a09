/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 files, MATLAB's 7.3 among them: data sets of one dimension, of two with one channel per column, of records with
   one channel per field, and references to such. Runs in a process of its own. */
#define H5_USE_110_API
#include "recording/reader_private.h"
#include "recording/hdf5_private.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define WIDE 64         /* a data set with more columns is no table of channels */
#define TEXT 64         /* bytes of a text that may be a date */
#define DEPTH 64        /* groups in each other; paths end before */
#define REFERENCES 4096 /* elements of an array of structs or a cell that are looked at */
#define PATH EO_TREE_PATH

struct attributes {
  struct eo_hdf5 *h;
  const char *path;
};

static herr_t visit_attribute(hid_t object, const char *name, const H5A_info_t *info, void *context)
{
  const struct attributes *attributes = context;
  char path[PATH], list[4096];
  double value = 0;
  (void)info;
  hid_t attribute = eo_hdf5_join(path, attributes->path, name) ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  if (attribute < 0)
    return 0;
  hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  if (eo_hdf5_texts(attribute, false, type, space, list, sizeof list)) {
    eo_hdf5_add_texts(attributes->h, path, list);
    eo_hdf5_add_frame(attributes->h, attributes->path, name, list);
  } else if (eo_hdf5_number(attribute, type, space, &value))
    eo_tree_add_number(attributes->h->tree, path, value);
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  return 0;
}

static void add_attributes(struct eo_hdf5 *hdf5, hid_t object, const char *path)
{
  struct attributes attributes = {hdf5, path};
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, visit_attribute, &attributes);
}

/* Data of other files are not ours to read, whatever the file says. */
static bool reads_other_files(hid_t set)
{
  hid_t list = H5Dget_create_plist(set);
  bool other = list < 0 || H5Pget_external_count(list) != 0 || H5Pget_layout(list) == H5D_VIRTUAL;
  H5Pclose(list);
  return other;
}

static void note_elsewhere(const struct eo_hdf5 *hdf5, const char *path)
{
  eo_notes_add(hdf5->notes,
               "\"%.60s\" keeps its values in another file, and other files are not read: save all channels in one "
               "file (h5py: new[name] = old[name][...]).",
               path);
}

/* Links may lead in circles, and references to what refers back: what was visited once is not visited again. */
static bool was_visited(struct eo_hdf5 *hdf5, hid_t object)
{
  H5O_info_t info;
  if (H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0)
    return true;
  for (int i = 0; i < hdf5->visits; i++)
    if (hdf5->visited[i] == info.addr)
      return true;
  if (hdf5->visits == EO_HDF5_VISITS) {
    hdf5->left_out++;
    return true;
  }
  hdf5->visited[hdf5->visits++] = info.addr;
  return false;
}

static void matlab_class(hid_t set, char *class, size_t size)
{
  *class = '\0';
  if (H5Aexists(set, "MATLAB_class") <= 0)
    return;
  hid_t attribute = H5Aopen(set, "MATLAB_class", H5P_DEFAULT), type = H5Aget_type(attribute),
        space = H5Aget_space(attribute);
  if (!eo_hdf5_texts(attribute, false, type, space, class, size))
    *class = '\0';
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
}

/* MATLAB's texts are numbers of two bytes. */
static void add_characters(struct eo_hdf5 *hdf5, hid_t set, hsize_t count, const char *path)
{
  uint16_t wide[128];
  char text[129];
  if (count > 128 || H5Dread(set, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, wide) < 0)
    return;
  for (hsize_t i = 0; i < count; i++)
    text[i] = (char)(wide[i] < 256 ? wide[i] : '?');
  text[count] = '\0';
  eo_tree_add_text(hdf5->tree, path, text);
}

static void add_number(struct eo_hdf5 *hdf5, hid_t set, const char *path)
{
  double value = 0;
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0)
    eo_tree_add_number(hdf5->tree, path, value);
}

static void keep_channel(struct eo_hdf5 *hdf5, int number, struct eo_hdf5_channel channel)
{
  channel.large = hdf5->large;
  hdf5->larges += hdf5->large;
  hdf5->channel[number] = channel;
}

/* What the data set itself has in the place of values that were never written, where somebody chose it: as if it were
   an attribute. */
static void add_fill_value(struct eo_hdf5 *hdf5, hid_t set, const char *path)
{
  char below[PATH];
  double value = 0;
  H5D_fill_value_t state;
  hid_t list = H5Dget_create_plist(set);
  if (H5Pfill_value_defined(list, &state) >= 0 && state == H5D_FILL_VALUE_USER_DEFINED &&
      H5Pget_fill_value(list, H5T_NATIVE_DOUBLE, &value) >= 0 && value != 0 && eo_hdf5_join(below, path, "_FillValue"))
    eo_tree_add_number(hdf5->tree, below, value);
  H5Pclose(list);
}

/* The dimensions of a data set that are longer than 1 (of "1 x 2 x N" the last two), two at most. */
struct sides {
  int count, place[2];
  hsize_t length[2];
};

static bool find_sides(hid_t space, struct sides *sides)
{
  hsize_t length[EO_HDF5_RANK];
  int rank = H5Sget_simple_extent_ndims(space);
  *sides = (struct sides){.length = {1, 1}};
  if (rank < 0 || rank > EO_HDF5_RANK || H5Sget_simple_extent_dims(space, length, NULL) != rank)
    return false;
  for (int i = 0; i < rank; i++)
    if (length[i] != 1 && sides->count++ < 2) {
      sides->place[sides->count - 1] = i;
      sides->length[sides->count - 1] = length[i];
    }
  return sides->count <= 2;
}

/* One channel per column, columns lying across the longer dimension. type: of a value in memory. */
static bool add_channels(struct eo_hdf5 *hdf5, hid_t set, hid_t type, bool whole, const char *path,
                         const struct sides *sides)
{
  int along = sides->length[1] > sides->length[0], other = sides->count == 2 ? sides->place[!along] : -1;
  hsize_t across = sides->length[!along], length = sides->length[along];
  int base = across > WIDE || length > INT64_MAX / 16
                 ? -1
                 : eo_tree_add_series(hdf5->tree, path, (int)across, (int64_t)length, whole);
  for (hsize_t k = 0; base >= 0 && k < across; k++)
    keep_channel(hdf5, base + (int)k,
                 (struct eo_hdf5_channel){.set = set,
                                          .type = type,
                                          .exact = whole ? H5T_NATIVE_INT64 : 0,
                                          .width = 1,
                                          .along = sides->place[along],
                                          .other = other,
                                          .across = k});
  return base >= 0;
}

/* Texts that are dates and times of day, a channel of seconds. */
static bool add_moments(struct eo_hdf5 *hdf5, hid_t set, hid_t type, const char *path, const struct sides *sides)
{
  struct eo_hdf5_channel channel = {.set = set, .text = true, .along = sides->place[0], .other = -1};
  if (sides->count != 1 || H5Tget_class(type) != H5T_STRING || H5Tget_size(type) > TEXT ||
      sides->length[0] > INT64_MAX / 16 || !eo_hdf5_find_moments(hdf5, &channel))
    return false;
  int number = eo_tree_add_series(hdf5->tree, path, 1, (int64_t)sides->length[0], false);
  if (number < 0)
    return false;
  snprintf(eo_tree_series(hdf5->tree)[number].unit, EO_RECORDING_UNIT, "s");
  hdf5->channel[number] = channel;
  return true;
}

/* A record with nothing but one field, which is of this type in memory. */
static hid_t field_type(const char *name, hid_t field)
{
  hid_t memory = H5Tcreate(H5T_COMPOUND, H5Tget_size(field));
  H5Tinsert(memory, name, 0, field);
  return memory;
}

/* A field that is an array: one channel per element. */
static bool add_array(struct eo_hdf5 *hdf5, hid_t set, hid_t memory, hid_t exact, int width, const char *path,
                      hsize_t length)
{
  int base = width > WIDE || length > INT64_MAX / 16
                 ? -1
                 : eo_tree_add_series(hdf5->tree, path, width, (int64_t)length, exact > 0);
  for (int k = 0; base >= 0 && k < width; k++)
    keep_channel(
        hdf5, base + k,
        (struct eo_hdf5_channel){.set = set, .type = memory, .exact = exact, .width = width, .place = k, .other = -1});
  return base >= 0;
}

/* Names of the records around a field, the outermost first. */
struct nest {
  const struct nest *outer;
  const char *name;
};

static hid_t nested_type(const struct nest *nest, hid_t inner)
{
  hid_t memory = H5Tcopy(inner);
  for (; nest; nest = nest->outer) {
    hid_t record = field_type(nest->name, memory);
    H5Tclose(memory);
    memory = record;
  }
  return memory;
}

static bool add_records(struct eo_hdf5 *hdf5, hid_t set, hid_t type, const struct nest *outer, const char *path,
                        hsize_t length, int depth);

/* A field that is a number, an array of numbers, or a record. */
static bool add_field(struct eo_hdf5 *hdf5, hid_t set, hid_t field, const struct nest *nest, const char *path,
                      hsize_t length, int depth)
{
  H5T_class_t class = H5Tget_class(field);
  hsize_t width = 1;
  hid_t inner = H5Tcopy(H5T_NATIVE_DOUBLE), element = -1;
  if (class == H5T_COMPOUND && depth < 4) {
    H5Tclose(inner);
    return add_records(hdf5, set, field, nest, path, length, depth + 1);
  }
  if (class == H5T_ARRAY && H5Tget_array_ndims(field) == 1 && H5Tget_array_dims2(field, &width) == 1) {
    element = H5Tget_super(field);
    class = H5Tget_class(element);
    H5Tclose(inner);
    inner = H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &width);
    H5Tclose(element);
  }
  hid_t memory = nested_type(nest, inner),
        exact = class == H5T_INTEGER && element < 0 ? nested_type(nest, H5T_NATIVE_INT64) : 0;
  H5Tclose(inner);
  bool added = (class == H5T_INTEGER || class == H5T_FLOAT) && width >= 1 &&
               add_array(hdf5, set, memory, exact, width <= WIDE ? (int)width : WIDE + 1, path, length);
  if (!added)
    H5Tclose(memory);
  if (!added && exact > 0)
    H5Tclose(exact);
  return added;
}

/* Records: each field that is a number is a channel. */
static bool add_records(struct eo_hdf5 *hdf5, hid_t set, hid_t type, const struct nest *outer, const char *path,
                        hsize_t length, int depth)
{
  bool any = false;
  int fields = H5Tget_nmembers(type);
  for (int i = 0; i < fields && i < EO_HDF5_CHANNELS; i++) {
    char *name = H5Tget_member_name(type, (unsigned)i), below[PATH];
    hid_t field = H5Tget_member_type(type, (unsigned)i);
    struct nest nest = {outer, name};
    if (name && eo_hdf5_join(below, path, name))
      any = add_field(hdf5, set, field, &nest, below, length, depth) || any;
    H5Tclose(field);
    H5free_memory(name);
  }
  return any;
}

static void add_object(struct eo_hdf5 *hdf5, hid_t object, const char *path, int depth);

/* What MATLAB refers to: the elements of a cell, or one field of all elements of an array of structs, "ch(2)/y". */
static void add_references(struct eo_hdf5 *hdf5, hid_t set, hsize_t count, bool cell, const char *path, int depth)
{
  hobj_ref_t *reference = count && count <= REFERENCES ? malloc(count * sizeof *reference) : NULL;
  const char *slash = strrchr(path, '/');
  if (!reference || H5Dread(set, H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, reference) < 0)
    count = 0;
  for (hsize_t i = 0; i < count; i++) {
    char below[PATH];
    int n = cell || !slash
                ? snprintf(below, sizeof below, "%s %d", path, (int)i + 1)
                : snprintf(below, sizeof below, "%.*s(%d)/%s", (int)(slash - path), path, (int)i + 1, slash + 1);
    hid_t object = H5Rdereference2(set, H5P_DEFAULT, H5R_OBJECT, &reference[i]);
    if (object >= 0 && n < (int)sizeof below)
      add_object(hdf5, object, below, depth + 1);
    else if (object >= 0)
      H5Oclose(object);
  }
  free(reference);
}

static bool keep_set(struct eo_hdf5 *hdf5, hid_t set)
{
  if (hdf5->sets < EO_HDF5_CHANNELS)
    hdf5->set[hdf5->sets++] = set;
  return hdf5->sets <= EO_HDF5_CHANNELS;
}

/* A data set with numbers, texts or references; it is closed unless channels read it. */
static void add_set(struct eo_hdf5 *hdf5, hid_t set, const char *path, int depth)
{
  struct sides sides;
  char class_name[32], list[4096];
  if ((set = eo_hdf5_open_cached(hdf5, set)) < 0)
    return;
  hid_t type = H5Dget_type(set), space = H5Dget_space(set);
  H5T_class_t class = H5Tget_class(type);
  int rank = H5Sget_simple_extent_ndims(space);
  hssize_t count = H5Sget_simple_extent_npoints(space);
  bool elsewhere = reads_other_files(set), plain = find_sides(space, &sides) && !elsewhere && count > 0;
  bool number = class == H5T_INTEGER || class == H5T_FLOAT, kept = false;
  matlab_class(set, class_name, sizeof class_name);
  bool object = H5Aexists(set, "MATLAB_object_decode") > 0;
  if (number)
    add_fill_value(hdf5, set, path);
  add_attributes(hdf5, set, path);
  if (elsewhere)
    note_elsewhere(hdf5, path);
  else if (!plain || object)
    hdf5->left_out++;
  else if (!strcmp(class_name, "char"))
    add_characters(hdf5, set, (hsize_t)count, path);
  else if (class == H5T_REFERENCE && depth < DEPTH && !was_visited(hdf5, set))
    add_references(hdf5, set, (hsize_t)count, !strcmp(class_name, "cell"), path, depth);
  else if (eo_hdf5_texts(set, true, type, space, list, sizeof list))
    eo_hdf5_add_texts(hdf5, path, list);
  else if (number && count == 1)
    add_number(hdf5, set, path);
  else if (hdf5->sets < EO_HDF5_CHANNELS &&
           (add_moments(hdf5, set, type, path, &sides) ||
            (number && add_channels(hdf5, set, H5T_NATIVE_DOUBLE, class == H5T_INTEGER, path, &sides)) ||
            (class == H5T_COMPOUND && rank == 1 && add_records(hdf5, set, type, NULL, path, sides.length[0], 0))))
    kept = keep_set(hdf5, set);
  else
    hdf5->left_out++;
  if (object)
    eo_notes_add(hdf5->notes,
                 "\"%.60s\" is an object (a table, timetable, timeseries or the like) whose numbers only MATLAB reads; "
                 "save s = table2struct(T, 'ToScalar', true) with the times in seconds instead.",
                 path);
  H5Sclose(space);
  H5Tclose(type);
  if (!kept)
    H5Dclose(set);
}

struct group {
  struct eo_hdf5 *h;
  const char *path;
  int depth;
};

static herr_t visit_link(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  const struct group *this_group = context;
  char path[PATH];
  bool index = !strncmp(name, "_i_", 3);                   /* PyTables keeps the sorted index of a table there */
  bool octave = H5Aexists(group, "OCTAVE_NEW_FORMAT") > 0; /* its variables are groups of "type" and "value" */
  if (index || (octave && !strcmp(name, "type")))
    return 0;
  if (!eo_hdf5_join(path, this_group->path, name)) {
    this_group->h->left_out++;
    return 0;
  }
  if (info->type == H5L_TYPE_EXTERNAL) {
    note_elsewhere(this_group->h, path);
    return 0;
  }
  if (octave && !strcmp(name, "value"))
    snprintf(path, sizeof path, "%s", this_group->path);
  hid_t object = H5Oopen(group, name, H5P_DEFAULT);
  if (object >= 0)
    add_object(this_group->h, object, path, this_group->depth + 1);
  return 0;
}

/* A group or data set; closes it. */
static void add_object(struct eo_hdf5 *hdf5, hid_t object, const char *path, int depth)
{
  H5I_type_t kind = H5Iget_type(object);
  if (kind == H5I_DATASET) {
    add_set(hdf5, object, path, depth);
    return;
  }
  if (kind == H5I_GROUP && depth < DEPTH && !was_visited(hdf5, object)) {
    struct group group = {hdf5, path, depth};
    add_attributes(hdf5, object, path);
    H5Literate(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, visit_link, &group);
  }
  H5Oclose(object);
}

/* MATLAB keeps what cells and objects refer to in groups whose names begin with '#'. */
static herr_t visit_root(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  return *name == '#' ? 0 : visit_link(group, name, info, context);
}

static enum eo_code read_file(struct eo_hdf5 *hdf5, hid_t file, int64_t bytes, const struct eo_reader_options *options,
                              const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  struct group root = {hdf5, "", 0};
  hdf5->file = file;
  hdf5->notes = notes;
  enum eo_code code = eo_tree_new(&hdf5->tree, error);
  if (code)
    return code;
  add_attributes(hdf5, file, "");
  if (H5Literate(file, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, visit_root, &root) < 0)
    return eo_error_set(error, EO_ERROR_INPUT, "", "HDF5: the groups of the file cannot be read; it is damaged.");
  eo_tree_settle(hdf5->tree, notes);
  if (hdf5->left_out)
    eo_notes_add(notes, "%d data set%s %s no channel of numbers and %s left out.", hdf5->left_out,
                 hdf5->left_out == 1 ? "" : "s", hdf5->left_out == 1 ? "is" : "are",
                 hdf5->left_out == 1 ? "was" : "were");
  struct eo_series_file content = {
      eo_tree_series(hdf5->tree), eo_tree_count(hdf5->tree), bytes, options->max_bytes, eo_hdf5_values, hdf5};
  code = eo_tree_check_begins(hdf5->tree, &content, error);
  eo_hdf5_find_stamps(hdf5);
  return code ? code : eo_series_copy(&content, sink, notes, error);
}

enum eo_code eo_hdf5_read(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                          struct eo_notes *notes, struct eo_error *error)
{
  struct stat state;
  if (stat(path, &state))
    return eo_error_set(error, EO_ERROR_FILE, "", "The file %s could not be opened.", path);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5PLset_loading_state(0); /* no code from outside, whatever filter the file asks for */
  struct eo_hdf5 *hdf5 = calloc(1, sizeof *hdf5);
  if (!hdf5)
    return eo_error_memory(error);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  enum eo_code code = file < 0
                          ? eo_error_set(error, EO_ERROR_INPUT, "",
                                         "HDF5: the file cannot be opened; it is damaged or was cut off at byte %lld.",
                                         (long long)state.st_size)
                          : read_file(hdf5, file, state.st_size, options, sink, notes, error);
  for (int i = 0; i < hdf5->sets; i++)
    H5Dclose(hdf5->set[i]);
  for (int i = 0; i < EO_HDF5_CHANNELS; i++)
    free(hdf5->channel[i].ahead);
  eo_tree_free(hdf5->tree);
  if (file >= 0)
    H5Fclose(file);
  free(hdf5);
  return code;
}

/* The structure of an NI TDMS file: segments, the channels in them and where their values are.
   Source: NI, "TDMS File Format Internal Structure" (public description of versions 4712 and 4713). Internal to the
   reader. */
#ifndef EASEOFF_RECORDING_TDMS_H
#define EASEOFF_RECORDING_TDMS_H

#include "recording/series.h"

#include <stdbool.h>

enum eo_tdms_type {
  EO_TDMS_INT8 = 1,
  EO_TDMS_INT16,
  EO_TDMS_INT32,
  EO_TDMS_INT64,
  EO_TDMS_UINT8,
  EO_TDMS_UINT16,
  EO_TDMS_UINT32,
  EO_TDMS_UINT64,
  EO_TDMS_SINGLE,
  EO_TDMS_DOUBLE,
  EO_TDMS_SINGLE_UNIT = 0x19,
  EO_TDMS_DOUBLE_UNIT = 0x1a,
  EO_TDMS_STRING = 0x20,
  EO_TDMS_BOOLEAN = 0x21,
  EO_TDMS_TIMESTAMP = 0x44,
};

/* One channel's values in one chunk. */
struct eo_tdms_part {
  int channel;
  enum eo_tdms_type type;
  int64_t count; /* values per chunk */
  int64_t size;  /* bytes of them */
};

struct eo_tdms_layout {
  int parts;
  int64_t chunk; /* bytes */
  struct eo_tdms_part part[];
};

struct eo_tdms_segment {
  const struct eo_tdms_layout *layout; /* borrowed from the list of layouts */
  int64_t at, chunks;                  /* byte of the first chunk, whole chunks */
  int64_t rest_rows;                   /* rows of an interleaved chunk that is cut off */
  bool interleaved, big;
};

struct eo_tdms_channel {
  char *path;    /* owned, as in the file */
  int listed_at; /* place in the list of objects when it is there */
  bool index_known;
  struct eo_tdms_part index; /* as last stated */
  double slope, intercept;   /* of the one linear scale of unscaled data */
  int64_t scales;            /* stated in NI_Number_Of_Scales */
  bool scaled, unknown_scale;
  int64_t base; /* s, whole seconds of the first timestamp */
  bool base_known;
  int64_t segment, passed; /* where reading has come to: segment, values before it */
};

struct eo_tdms {
  int file;
  int64_t size;
  bool cut; /* the last segment is not complete */
  int channels;
  struct eo_tdms_channel channel[EO_SERIES];
  struct eo_series series[EO_SERIES]; /* name, unit, length, interval of each channel */
  int64_t segments, segment_room;
  struct eo_tdms_segment *segment; /* owned */
  int layouts, layout_room;
  struct eo_tdms_layout **layout; /* owned */
  int64_t layout_parts;
  int listed; /* the objects of the current segment, in order */
  struct eo_tdms_list {
    int channel;
    bool data;
  } list[EO_SERIES];
};

int64_t eo_tdms_type_size(uint32_t type); /* bytes of a value, 0 when it has no fixed size or is not read */

/* Reads all metadata of an open file. tdms is zeroed but for file and size. Errors: EO_ERROR_INPUT with the byte,
   EO_ERROR_FILE, EO_ERROR_MEMORY. */
enum eo_code eo_tdms_scan(struct eo_tdms *tdms, struct eo_error *error);
void eo_tdms_done(struct eo_tdms *tdms); /* what eo_tdms_scan allocated */

/* Reads the objects and properties of one segment's metadata. at: byte of the file where it begins. fresh: forget the
   list of objects. */
enum eo_code eo_tdms_read_objects(struct eo_tdms *tdms, const unsigned char *bytes, size_t size, int64_t at, bool big,
                                  bool fresh, struct eo_error *error);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
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
  EO_TDMS_COMPLEX_SINGLE = 0x08000c,
  EO_TDMS_COMPLEX_DOUBLE = 0x10000d,
};

/* One channel's values in one chunk. */
struct eo_tdms_part {
  int channel;
  enum eo_tdms_type type;
  int64_t count;  /* values per chunk */
  int64_t size;   /* bytes of them; of raw data of DAQmx those of all channels */
  int64_t width;  /* of raw data of DAQmx: bytes of a row of the channel's buffer; else 0 */
  int64_t offset; /* of raw data of DAQmx: byte of the first value in the chunk */
  int64_t before; /* bytes of the chunk before this part; of a row before its value where parts are interleaved: */
  int64_t row;
  int bit; /* of a digital line: its place in the byte; -1: no digital line */
};

/* How a raw value becomes one with a unit. */
enum eo_tdms_scale_kind {
  EO_TDMS_NO_SCALE,
  EO_TDMS_LINEAR,
  EO_TDMS_POLYNOMIAL,
  EO_TDMS_TABLE,
  EO_TDMS_ADD,
  EO_TDMS_SUBTRACT,
  EO_TDMS_OTHER_SCALE
};

enum { EO_TDMS_SCALES = 16, EO_TDMS_TERMS = 64 };

struct eo_tdms_scale {
  enum eo_tdms_scale_kind kind;
  int64_t source[2];             /* number of the scale whose result it takes; one that does not exist: the raw value */
  int terms[2];                  /* of term; coefficients, or scaled values and values before */
  double term[2][EO_TDMS_TERMS]; /* slope and intercept of a linear one */
};

struct eo_tdms_layout {
  int parts;
  int64_t chunk; /* bytes */
  struct eo_tdms_part part[];
};

struct eo_tdms_segment {
  const struct eo_tdms_layout *layout; /* borrowed from the list of layouts */
  int64_t at, chunks;                  /* byte of the first chunk, whole chunks */
  int64_t rest;                        /* bytes of a last chunk that is cut off */
  bool interleaved, big;
};

struct eo_tdms_channel {
  char *path;    /* owned, as in the file */
  int listed_at; /* place in the list of objects when it is there */
  bool index_known;
  struct eo_tdms_part index;   /* as last stated */
  int64_t scales;              /* stated in NI_Number_Of_Scales */
  struct eo_tdms_scale *scale; /* owned, [EO_TDMS_SCALES]; NULL: none */
  bool scaled;
  double increment, start, abscissa; /* waveform: step, first place, s per unit of both; 0: not stated */
  int64_t segment, passed;           /* where reading has come to: segment, values before it */
  int part;                          /* of the layout that was looked at last */
};

/* What the properties of the file or of a group say of the channels in it. */
struct eo_tdms_group {
  char *path; /* owned; "/" for the file */
  struct eo_series stated;
};

enum { EO_TDMS_GROUPS = 256 };

struct eo_tdms {
  int file;
  int groups;
  struct eo_tdms_group group[EO_TDMS_GROUPS];
  int64_t size;
  int64_t base; /* s, whole seconds of the first time stamp that was read: all count from it */
  bool base_known;
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

/* Where one channel's values stand in a segment. */
struct eo_tdms_place {
  const struct eo_tdms_part *part; /* NULL: it has none there */
  int64_t offset;                  /* of its first value in a chunk, bytes */
  int64_t stride;                  /* from value to value, bytes */
  int64_t values;                  /* in the segment, with those of a chunk that is cut off */
};
struct eo_tdms_place eo_tdms_place(const struct eo_tdms_segment *segment, const struct eo_tdms_part *part);

/* A raw value through the channel's scales. */
double eo_tdms_scaled(const struct eo_tdms_channel *channel, double raw);
/* False when one of the scales is of a kind that is not known. */
bool eo_tdms_can_scale(const struct eo_tdms_channel *channel);

/* Seconds since 1904-01-01 and a part of one as ns since 1970; EO_CLOCK_NO_EPOCH where that is no date. */
int64_t eo_tdms_epoch(int64_t seconds, double fraction);

/* A number of this type; NaN for other types. */
double eo_tdms_number(uint32_t type, const unsigned char *p, bool big);
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

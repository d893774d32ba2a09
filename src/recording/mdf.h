/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The structure of an ASAM MDF 4 file: blocks, groups of records, the channels in a record, their conversions.
   Source: ASAM MDF, version 4.1, "Measurement Data Format" (public description of the blocks). Internal to the reader.
   Everything in the file but the raw values of channels is little-endian. */
#ifndef EASEOFF_RECORDING_MDF_H
#define EASEOFF_RECORDING_MDF_H

#include "recording/bytes.h"
#include "recording/series.h"

enum {
  EO_MDF_LINKS = 16,          /* of a block that are looked at here */
  EO_MDF_DATA = 136,          /* bytes behind them that are looked at here */
  EO_MDF_GROUPS = 4096,       /* groups of records of a file */
  EO_MDF_BLOCKS = 1 << 20,    /* blocks that are visited at most: lists may lead in a circle */
  EO_MDF_RECORD = 1 << 20,    /* bytes of a record */
  EO_MDF_TERMS = 1 << 16,     /* numbers of a conversion */
  EO_MDF_ALL_TERMS = 1 << 22, /* of all conversions */
  EO_MDF_NESTED = 4,          /* conversions in conversions */
  EO_MDF_INFLATED = 64 << 20  /* bytes of one compressed block; 4 MB are usual */
};

/* A block: its links (places of other blocks, 0: none) and the beginning of its data, zeros where it is shorter. */
struct eo_mdf_block {
  char id[3]; /* "CN" of "##CN" */
  int64_t at; /* byte of the file */
  int64_t links, link[EO_MDF_LINKS];
  int64_t data_at, size; /* of all its data, bytes */
  unsigned char data[EO_MDF_DATA];
};

enum eo_mdf_conversion_kind {
  EO_MDF_EQUAL,
  EO_MDF_LINEAR,
  EO_MDF_RATIONAL,
  EO_MDF_FORMULA,
  EO_MDF_INTERPOLATED,
  EO_MDF_TABLE,
  EO_MDF_RANGES,
  EO_MDF_TEXTS,      /* value to text or to another conversion */
  EO_MDF_TEXT_RANGES /* the same by ranges of values */
};

/* How a raw value becomes one with a unit. */
struct eo_mdf_conversion {
  enum eo_mdf_conversion_kind kind;
  int terms, branches;
  double *term;                      /* owned, [terms] */
  struct eo_mdf_conversion **branch; /* owned, [branches]; NULL: a text, which is no number */
};

/* Bytes of records, one after the other, at a place of a file. */
struct eo_mdf_piece {
  int file;      /* the recording itself, or the temporary one */
  int64_t at;    /* byte of that file */
  int64_t first; /* byte of the group's records */
  int64_t size;
};

/* Records of one kind, one after the other. */
struct eo_mdf_group {
  uint64_t number; /* stands before each record where kinds are mixed */
  char name[EO_RECORDING_NAME];
  bool variable;          /* records state their length: texts and the like */
  int64_t skip;           /* bytes of the number before a record */
  int64_t data, record;   /* bytes of values, and of them with the invalidation bits */
  int64_t comment;        /* place of a text about it; 0: none */
  int64_t at, master_at;  /* its own place, and that of the group whose master counts here too; 0: none */
  int64_t stated, rows;   /* records as stated, and as found */
  int master;             /* series with the times; -1: none */
  double interval, start; /* of times that are counted, s; interval 0: they are not */
  int pieces;
  struct eo_mdf_piece *piece; /* owned, [pieces] */
};

enum eo_mdf_channel_kind { EO_MDF_VALUE = 0, EO_MDF_MASTER = 2, EO_MDF_VIRTUAL_MASTER = 3, EO_MDF_VIRTUAL = 6 };

/* Where the values of a channel stand in a record. */
struct eo_mdf_channel {
  int group;
  bool virtual; /* no bytes: the number of the record, converted */
  int type;     /* 0, 1 unsigned, 2, 3 signed, 4, 5 floating; odd ones have their high byte first */
  int bit, bits;
  int64_t byte;
  int64_t invalid;                      /* bit behind the values that is 1 where the value means nothing; -1: none */
  struct eo_mdf_conversion *conversion; /* owned; NULL: none */
};

struct eo_mdf {
  int file, spool; /* spool: temporary file without a name, -1: not made */
  const char *spool_directory;
  int64_t size, limit, spooled, visited, epoch;
  int64_t stored;  /* bytes of all data blocks so far: no two lists share one */
  int64_t terms;   /* numbers and branches of all conversions so far */
  int64_t comment; /* place of a text about the file; 0: none */
  bool unfinished; /* the file was not closed: numbers of records and the last length are not stated */
  bool cut;        /* fewer records than stated */
  struct eo_notes *notes;
  int groups, channels, left_out, texts, formulas, frames;
  struct eo_mdf_group *group; /* owned, [groups] */
  struct eo_mdf_channel channel[EO_SERIES];
  struct eo_series series[EO_SERIES];
  unsigned char *rows; /* owned: records of a group that were read last */
  size_t room;
  int rows_group;
  int64_t rows_first, rows_count;
};

/* Reads a block at a place; id: what it must be ("CN"), NULL: any. Errors: EO_ERROR_INPUT with the byte. */
enum eo_code eo_mdf_open(struct eo_mdf *mdf, int64_t at, const char *id, struct eo_mdf_block *block,
                         struct eo_error *error);
/* The text of a TX block, or of the first <TX> of an MD block; "" when there is none at this place. */
void eo_mdf_text(struct eo_mdf *mdf, int64_t at, char *text, size_t size);
/* What the properties in the comment at this place say of the sampling. */
void eo_mdf_facts(struct eo_mdf *mdf, int64_t at, struct eo_series *series);

/* Reads a conversion; at 0: none, NULL. Errors: EO_ERROR_INPUT, EO_ERROR_MEMORY. */
enum eo_code eo_mdf_conversion_read(struct eo_mdf *mdf, int64_t at, struct eo_mdf_conversion **conversion,
                                    struct eo_error *error);
void eo_mdf_conversion_free(struct eo_mdf_conversion *conversion); /* NULL is fine */
/* False for formulas and for tables of texts alone. */
bool eo_mdf_is_numeric(const struct eo_mdf_conversion *conversion);
/* whole: the raw value is an integer. NaN where a text stands for the value. */
double eo_mdf_convert(const struct eo_mdf_conversion *conversion, double raw, bool whole);

/* Finds the records of the groups first .. first + count - 1, which one list of data blocks holds, behind numbers of
   `number` bytes, and counts them. What is compressed or mixed goes to the temporary file first. at: the list, 0: no
   data. Errors: EO_ERROR_INPUT, EO_ERROR_FILE, EO_ERROR_MEMORY. */
enum eo_code eo_mdf_find_records(struct eo_mdf *mdf, int64_t at, int number, int first, int count,
                                 struct eo_error *error);

/* Reads all groups and channels of an open file. mdf is zeroed but for file, size, limit, spool (-1), spool_directory
   and notes. */
enum eo_code eo_mdf_scan(struct eo_mdf *mdf, struct eo_error *error);
void eo_mdf_done(struct eo_mdf *mdf); /* what eo_mdf_scan allocated */

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A multipart/form-data body (RFC 7578) on its way to the disk: its files go to a folder of their own as they come, its
   other parts are kept as texts. Nothing of it counts until the store takes the folder over; it goes away with the
   request otherwise. */
#ifndef EASEOFF_HTTP_UPLOAD_H
#define EASEOFF_HTTP_UPLOAD_H

#include "format/table.h"
#include "http/request.h"
#include "store/measurements.h"

enum {
  EO_UPLOAD_FIELDS = 12,
  EO_UPLOAD_PATH = 4096,
  EO_UPLOAD_FIELD_BYTES = 64 << 10,
  EO_UPLOAD_DRAINED = 256 << 20, /* bytes of a refused upload that are read so that its sender hears why */
};

struct eo_upload {
  struct MHD_PostProcessor *processor;
  char folder[EO_UPLOAD_PATH - 16];                      /* "": none */
  int files;                                             /* complete but for the last one */
  struct eo_measurement_file file[EO_MEASUREMENT_FILES]; /* names and sizes */
  int output;                                            /* descriptor of the last file, -1: none */
  int fields;
  struct eo_upload_field {
    char name[24];
    struct eo_text value;
  } field[EO_UPLOAD_FIELDS];
  bool in_part, in_file; /* in_part: one has begun */
  char part[24];         /* name of the part that comes */
  size_t part_size;
  int64_t promised;       /* bytes that the disk has to have room for */
  struct eo_upload *next; /* of those on their way */
  unsigned char client[16];
};

/* Before the body. A reply is made when it cannot be taken. size: what the client said, 0: nothing. */
void eo_upload_begin(struct eo_request *request, int64_t size);

/* Bytes of the body; a reply is made when something is wrong with them. */
void eo_upload_take(struct eo_request *request, const char *data, size_t size);

/* After the body; false: it was cut off or held no file, and the reply says so. */
bool eo_upload_end(struct eo_request *request);

/* Where a file of the upload lies; path[EO_UPLOAD_PATH]. */
void eo_upload_path(const struct eo_upload *upload, int file, char *path);

/* Seconds that the rest of a body may take: who sends less than a few kB a second does not stay. */
int eo_upload_patience(const struct eo_request *request);

/* The parts that are no files as an object that the table can read: numbers and objects out of their texts, empty parts
   left out. What is no JSON where an object is wanted is a fault. New; NULL without memory. */
json_t *eo_upload_document(const struct eo_upload *upload, const struct eo_table *table, struct eo_faults *faults);

void eo_upload_free(struct eo_request *request);

/* On their way; HTTP thread. */
int eo_uploads_count(const struct eo_http *http);

#endif

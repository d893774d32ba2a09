/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/page_sums.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <zlib.h>

const char eo_page_sums_vfs[] = "easeoff-sums";

/* Places in the first page of a database, and in a journal ("Database File Format", 1.3 and 4.1). */
enum {
  HEADER = 100,      /* bytes at the beginning of the first page */
  AT_PAGE_SIZE = 16, /* two bytes, big endian; 1: 65536 */
  AT_RESERVED = 20,  /* bytes at the end of every page that SQLite leaves alone */
  LEAST_PAGE = 512,
  WAL_HEADER = 32,   /* of the journal, its sum in the last 8 bytes */
  FRAME_HEADER = 24, /* of each page in it, the sum in the last 8 bytes */
  AT_SUM = 16,       /* in a frame's header */
  SUMMED = 8         /* bytes of a frame's header that count */
};
static const uint32_t WAL_MAGIC = 0x377f0682; /* with 1 in its last bit: sums of big-endian words */
enum { COMPARE = 0x45415331 };                /* our own file control: whether pages are compared */

struct file {
  sqlite3_file base;
  struct file *database; /* of a journal: its database; NULL: not known, nothing is compared */
  bool is_journal, sums, trusted;
  size_t page_size;
  unsigned char *room; /* [page_size] for a page with its sum; owned */
  /* the system's file follows */
};

static sqlite3_vfs *system_vfs;

static sqlite3_file *below(sqlite3_file *file)
{
  return (sqlite3_file *)((struct file *)file + 1);
}

static void find_sum(const unsigned char *page, size_t size, unsigned number, unsigned char sum[EO_PAGE_SUM])
{
  uint32_t part[2];
  const unsigned char first[4] = {(unsigned char)(number >> 24), (unsigned char)(number >> 16),
                                  (unsigned char)(number >> 8), (unsigned char)number};
  part[0] = (uint32_t)crc32(crc32(0, first, sizeof first), page, (uInt)(size - EO_PAGE_SUM));
  part[1] = (uint32_t)adler32(adler32(1, first, sizeof first), page, (uInt)(size - EO_PAGE_SUM));
  for (int i = 0; i < EO_PAGE_SUM; i++)
    sum[i] = (unsigned char)(part[i / 4] >> 8 * (i % 4));
}

static bool is_zero(const unsigned char *page, size_t size)
{
  for (size_t i = 0; i < size; i++)
    if (page[i])
      return false;
  return true;
}

bool eo_page_sum_holds(const unsigned char *page, size_t size, unsigned number)
{
  unsigned char sum[EO_PAGE_SUM];
  find_sum(page, size, number, sum);
  return memcmp(sum, page + size - EO_PAGE_SUM, EO_PAGE_SUM) == 0 || is_zero(page, size);
}

/* What the first page says of all others. */
static void look_at_header(struct file *file, const unsigned char *header)
{
  size_t size = (size_t)header[AT_PAGE_SIZE] << 8 | header[AT_PAGE_SIZE + 1];
  size = size == 1 ? 65536 : size;
  bool known = memcmp(header, "SQLite format 3", 16) == 0 && size >= LEAST_PAGE && !(size & (size - 1));
  if (known && size != file->page_size) {
    free(file->room);
    file->room = NULL;
    file->page_size = size;
  }
  file->sums = known && header[AT_RESERVED] == EO_PAGE_SUM;
}

/* The journal's own sum (wal.c, walChecksumBytes): pairs of words, in the order of its magic number. */
static void add_words(const unsigned char *bytes, size_t size, bool big_endian, uint32_t sum[2])
{
  for (size_t i = 0; i + 8 <= size; i += 8) {
    uint32_t word[2];
    for (int k = 0; k < 2; k++) {
      const unsigned char *b = bytes + i + 4 * (size_t)k;
      word[k] = big_endian ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]
                           : (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
    }
    sum[0] += word[0] + sum[1];
    sum[1] += word[1] + sum[0];
  }
}

static uint32_t read_big(const unsigned char *b)
{
  return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

/* A page in the journal: its frame's sum goes on from that of the frame before, or of the journal's header. */
static int compare_frame(struct file *file, const unsigned char *page, size_t size, sqlite3_int64 at)
{
  unsigned char magic[4], before[8], header[FRAME_HEADER];
  sqlite3_int64 start = at - FRAME_HEADER;
  sqlite3_int64 last = start == WAL_HEADER ? WAL_HEADER - 8 : start - (sqlite3_int64)size - FRAME_HEADER + AT_SUM;
  sqlite3_file *real = below(&file->base);
  int code = real->pMethods->xRead(real, magic, sizeof magic, 0);
  if (!code)
    code = real->pMethods->xRead(real, before, sizeof before, last);
  if (!code)
    code = real->pMethods->xRead(real, header, sizeof header, start);
  if (code)
    return code;
  uint32_t sum[2] = {read_big(before), read_big(before + 4)};
  bool big_endian = read_big(magic) & 1;
  if ((read_big(magic) & ~1u) != WAL_MAGIC)
    return SQLITE_IOERR_DATA;
  add_words(header, SUMMED, big_endian, sum);
  add_words(page, size, big_endian, sum);
  return sum[0] == read_big(header + AT_SUM) && sum[1] == read_big(header + AT_SUM + 4) ? SQLITE_OK : SQLITE_IOERR_DATA;
}

static int compare(struct file *file, const unsigned char *bytes, int amount, sqlite3_int64 at)
{
  const struct file *database = file->is_journal ? file->database : file;
  size_t size = database ? database->page_size : 0;
  if (!size || (size_t)amount != size || !database->sums || database->trusted)
    return SQLITE_OK;
  if (file->is_journal)
    return at >= WAL_HEADER + FRAME_HEADER && (at - WAL_HEADER) % ((sqlite3_int64)size + FRAME_HEADER) == FRAME_HEADER
               ? compare_frame(file, bytes, size, at)
               : SQLITE_OK;
  unsigned number = (unsigned)(at / (sqlite3_int64)size) + 1;
  if (at % (sqlite3_int64)size || eo_page_sum_holds(bytes, size, number))
    return SQLITE_OK;
  sqlite3_log(SQLITE_IOERR_DATA, "page %u is not what was written", number);
  return SQLITE_IOERR_DATA;
}

static int file_read(sqlite3_file *base, void *bytes, int amount, sqlite3_int64 at)
{
  struct file *file = (struct file *)base;
  sqlite3_file *real = below(base);
  int code = real->pMethods->xRead(real, bytes, amount, at);
  if (code)
    return code;
  if (!file->is_journal && at == 0 && amount >= HEADER)
    look_at_header(file, bytes);
  return compare(file, bytes, amount, at);
}

/* Another connection may have begun with sums since this one looked. */
static void find_header(struct file *file)
{
  unsigned char header[HEADER];
  sqlite3_file *real = below(&file->base);
  if (real->pMethods->xRead(real, header, HEADER, 0) == SQLITE_OK)
    look_at_header(file, header);
}

static int file_write(sqlite3_file *base, const void *bytes, int amount, sqlite3_int64 at)
{
  struct file *file = (struct file *)base;
  sqlite3_file *real = below(base);
  if (!file->is_journal && at == 0 && amount >= HEADER)
    look_at_header(file, bytes);
  else if (!file->is_journal && !file->sums)
    find_header(file);
  bool page = !file->is_journal && file->sums && (size_t)amount == file->page_size && at % amount == 0;
  if (!page)
    return real->pMethods->xWrite(real, bytes, amount, at);
  if (!file->room && !(file->room = malloc(file->page_size)))
    return SQLITE_NOMEM;
  memcpy(file->room, bytes, file->page_size);
  find_sum(file->room, file->page_size, (unsigned)(at / amount) + 1, file->room + file->page_size - EO_PAGE_SUM);
  return real->pMethods->xWrite(real, file->room, amount, at);
}

static int file_close(sqlite3_file *base)
{
  struct file *file = (struct file *)base;
  sqlite3_file *real = below(base);
  int code = real->pMethods ? real->pMethods->xClose(real) : SQLITE_OK;
  free(file->room);
  file->room = NULL;
  return code;
}

static int file_control(sqlite3_file *base, int operation, void *argument)
{
  sqlite3_file *real = below(base);
  if (operation == COMPARE) {
    ((struct file *)base)->trusted = !*(const bool *)argument;
    return SQLITE_OK;
  }
  return real->pMethods->xFileControl(real, operation, argument);
}

/* The rest as it is. */
#define HAND_ON(name, parameters, ...)  \
  static int name parameters            \
  {                                     \
    sqlite3_file *real = below(file);   \
    return real->pMethods->__VA_ARGS__; \
  }
HAND_ON(file_truncate, (sqlite3_file * file, sqlite3_int64 size), xTruncate(real, size))
HAND_ON(file_sync, (sqlite3_file * file, int flags), xSync(real, flags))
HAND_ON(file_size, (sqlite3_file * file, sqlite3_int64 *size), xFileSize(real, size))
HAND_ON(file_lock, (sqlite3_file * file, int level), xLock(real, level))
HAND_ON(file_unlock, (sqlite3_file * file, int level), xUnlock(real, level))
HAND_ON(file_reserved, (sqlite3_file * file, int *result), xCheckReservedLock(real, result))
HAND_ON(file_sector, (sqlite3_file * file), xSectorSize(real))
HAND_ON(file_shm_map, (sqlite3_file * file, int region, int size, int extend, void volatile **map),
        xShmMap(real, region, size, extend, map))
HAND_ON(file_shm_lock, (sqlite3_file * file, int offset, int n, int flags), xShmLock(real, offset, n, flags))
HAND_ON(file_shm_unmap, (sqlite3_file * file, int remove), xShmUnmap(real, remove))

/* Pages are written whole and at once by no device that is asked here: what a device promises of a sector does not hold
   for a page with another sum. */
static int file_characteristics(sqlite3_file *file)
{
  sqlite3_file *real = below(file);
  return real->pMethods->xDeviceCharacteristics(real);
}

static void file_shm_barrier(sqlite3_file *file)
{
  sqlite3_file *real = below(file);
  real->pMethods->xShmBarrier(real);
}

/* Version 2: pages are not mapped into memory, where nobody would compare them. */
static const sqlite3_io_methods methods = {.iVersion = 2,
                                           .xClose = file_close,
                                           .xRead = file_read,
                                           .xWrite = file_write,
                                           .xTruncate = file_truncate,
                                           .xSync = file_sync,
                                           .xFileSize = file_size,
                                           .xLock = file_lock,
                                           .xUnlock = file_unlock,
                                           .xCheckReservedLock = file_reserved,
                                           .xFileControl = file_control,
                                           .xSectorSize = file_sector,
                                           .xDeviceCharacteristics = file_characteristics,
                                           .xShmMap = file_shm_map,
                                           .xShmLock = file_shm_lock,
                                           .xShmBarrier = file_shm_barrier,
                                           .xShmUnmap = file_shm_unmap};

static int open_file(sqlite3_vfs *vfs, const char *name, sqlite3_file *base, int flags, int *result)
{
  struct file *file = (struct file *)base;
  (void)vfs;
  if (!(flags & (SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_WAL))) /* nothing that lasts */
    return system_vfs->xOpen(system_vfs, name, base, flags, result);
  memset(file, 0, sizeof *file);
  int code = system_vfs->xOpen(system_vfs, name, below(base), flags, result);
  if (code)
    return code;
  base->pMethods = &methods;
  file->is_journal = flags & SQLITE_OPEN_WAL;
  if (file->is_journal)
    file->database = (struct file *)sqlite3_database_file_object(name);
  return SQLITE_OK;
}

static void register_once(void)
{
  static sqlite3_vfs vfs;
  system_vfs = sqlite3_vfs_find(NULL);
  if (!system_vfs)
    return;
  vfs = *system_vfs; /* everything but opening is the system's own */
  vfs.zName = eo_page_sums_vfs;
  vfs.szOsFile = (int)sizeof(struct file) + system_vfs->szOsFile;
  vfs.pNext = NULL;
  vfs.xOpen = open_file;
  if (sqlite3_vfs_register(&vfs, 0))
    system_vfs = NULL;
}

int eo_page_sums_register(void)
{
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, register_once);
  return system_vfs ? SQLITE_OK : SQLITE_ERROR;
}

void eo_page_sums_compare(sqlite3 *handle, bool compared)
{
  sqlite3_file_control(handle, "main", COMPARE, &compared);
}

static int64_t renew(int file, struct file *known)
{
  unsigned char *page = malloc(known->page_size);
  int64_t changed = 0;
  if (!page)
    return -1;
  for (unsigned number = 1; changed >= 0; number++) {
    off_t at = (off_t)(number - 1) * (off_t)known->page_size;
    if (pread(file, page, known->page_size, at) != (ssize_t)known->page_size)
      break;
    if (eo_page_sum_holds(page, known->page_size, number))
      continue;
    find_sum(page, known->page_size, number, page + known->page_size - EO_PAGE_SUM);
    changed = pwrite(file, page, known->page_size, at) == (ssize_t)known->page_size ? changed + 1 : -1;
  }
  free(page);
  return changed;
}

int64_t eo_page_sums_renew(const char *path)
{
  struct file known = {.page_size = 0};
  unsigned char header[HEADER];
  int64_t changed = -1;
  int file = open(path, O_RDWR | O_CLOEXEC);
  if (file < 0)
    return -1;
  errno = 0;
  if (pread(file, header, HEADER, 0) == HEADER)
    look_at_header(&known, header);
  if (known.sums)
    changed = renew(file, &known);
  if (changed > 0 && fsync(file))
    changed = -1;
  close(file);
  return changed;
}

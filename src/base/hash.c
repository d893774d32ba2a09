#include "base/hash.h"

#include <sys/types.h>

#include <sha2.h>

void eo_hash_hex(const void *data, size_t size, char hex[EO_HASH_HEX])
{
  SHA256Data(data, size, hex);
}

/* For any processor: 16-byte vectors, which every x86-64 and every 64-bit ARM has. */
#define VERSION eo_gram_plain
#define NAME "plain"
#define TARGET
#define WIDTH 2
#define TILE_ROWS 4
#define TILE_LANES 2
#define FUSED(a, b, c) ((a) * (b) + (c))
#define FUSED_FLOAT(a, b, c) ((a) * (b) + (c))
#include "numerics/gram_body.h"

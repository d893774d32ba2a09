/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EASEOFF_TESTS_FUZZ_H
#define EASEOFF_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* EO_SANITIZED is defined where gcc or clang builds with the address or the thread sanitizer: they take nearly all of
   the address space, so that no limit on it can be set. */
#ifndef EASEOFF_BASE_SANITIZED_H
#define EASEOFF_BASE_SANITIZED_H

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define EO_SANITIZED 1
#elif defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define EO_SANITIZED 1
#endif
#endif

#endif

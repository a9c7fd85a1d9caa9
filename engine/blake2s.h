/* BLAKE2s (RFC 7693), unkeyed, with a digest of 16 bytes: the hash behind a run's identity. Not for secrets. */
#pragma once

#include <stddef.h>
#include <stdint.h>

void blake2s(const void *bytes, size_t size, uint8_t digest[16]);

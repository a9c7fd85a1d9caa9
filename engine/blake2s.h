/* BLAKE2s (RFC 7693), unkeyed, with a digest of 16 bytes: the hash behind a run's identity. Not for secrets. */
#ifndef CLAST_ENGINE_BLAKE2S_H
#define CLAST_ENGINE_BLAKE2S_H

#include <stddef.h>
#include <stdint.h>

void blake2s(const void *bytes, size_t size, uint8_t digest[16]);

#endif

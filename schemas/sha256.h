/* SHA-256 (FIPS 180-4) of files that campaigns name, so that `sha256sum FILE` gives the same text. Not for secrets. */
#ifndef CLAST_SCHEMAS_SHA256_H
#define CLAST_SCHEMAS_SHA256_H

#include <stddef.h>

/* The hash of `size` bytes, as 64 hexadecimal digits and a NUL. */
void sha256_text(const void *bytes, size_t size, char text[65]);

#endif

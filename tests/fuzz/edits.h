/* A file for fuzz targets: a complete one, changed by a list of edits. A reader would refuse random bytes at the first
 * check. An edit is 6 bytes: where (3), whether at the beginning of a block of 4096 bytes (1), the change (1), how many
 * bytes (1). The count 255 cuts the file off there. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EDITS_BLOCK = 4096, EDITS_SIZE = 6, EDITS_MOST = 64 };

struct edits_file {
  uint8_t *bytes;
  size_t size;
};

static inline struct edits_file edits_read(const char *path) {
  struct edits_file file = {0};
  FILE *in = fopen(path, "rb");
  if (!in || fseek(in, 0, SEEK_END) != 0)
    abort();
  file.size = (size_t)ftell(in);
  file.bytes = malloc(file.size + 1);
  rewind(in);
  if (!file.bytes || file.size == 0 || fread(file.bytes, 1, file.size, in) != file.size)
    abort();
  fclose(in);
  return file;
}

/* Writes the file with the edits to `path`. Returns false if the edits change nothing. */
static inline bool edits_write(const struct edits_file *whole, const uint8_t *edits, size_t size, const char *path) {
  size_t length = whole->size;
  uint8_t *bytes = malloc(length);
  if (!bytes)
    abort();
  memcpy(bytes, whole->bytes, length);
  for (size_t k = 0; (k + 1) * EDITS_SIZE <= size && k < EDITS_MOST && length > 0; k++) {
    const uint8_t *edit = edits + k * EDITS_SIZE;
    size_t at = ((size_t)edit[0] << 16 | (size_t)edit[1] << 8 | edit[2]) % length;
    if (edit[3] & 1)
      at = at / EDITS_BLOCK * EDITS_BLOCK + at % 128;
    if (edit[5] == 255)
      length = at;
    for (size_t i = 0; edit[5] != 255 && i <= edit[5] % 16u && at + i < length; i++)
      bytes[at + i] ^= edit[4];
  }
  const bool changed = length != whole->size || memcmp(bytes, whole->bytes, length) != 0;
  FILE *out = fopen(path, "wb");
  if (!out || fwrite(bytes, 1, length, out) != length || fclose(out) != 0)
    abort();
  free(bytes);
  return changed;
}

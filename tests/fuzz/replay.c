/* Gives the files of the folders named on the command line to a fuzz target, in any build: the seed corpus and every
 * input that once caused a failure. With a number as first argument, also that many variations of each file. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static uint64_t word = 88172645463325252u; /* xorshift64, Marsaglia 2003: the same variations every time */

static uint64_t next(void) {
  word ^= word << 13;
  word ^= word >> 7;
  return word ^= word << 17;
}

static void vary(const uint8_t *bytes, size_t size, int variations) {
  static const char *const pieces[] = {": ",  "\n", "- ", "[", "]",        "{",     "}",  "\"", "'",    "&a ",
                                       "*a",  "!!", "|",  ">", "#",        "---\n", "  ", "\t", "1e30", "km/s",
                                       "off", "~",  "? ", ",", "\xC2\xB5", "\xFF",  "(",  ")",  "^",    "/"};
  uint8_t *copy = malloc(2 * size + 64);
  if (!copy)
    return;
  for (int v = 0; v < variations; v++) {
    memcpy(copy, bytes, size);
    size_t length = size;
    for (uint64_t edits = 1 + next() % 3; edits-- > 0;) {
      size_t at = length ? next() % (length + 1) : 0;
      uint64_t choice = next() % 4;
      if (choice == 0 && at < length) {
        copy[at] = (uint8_t)next();
      } else if (choice == 1 && at < length) {
        size_t cut = 1 + next() % 8;
        if (cut > length - at)
          cut = length - at;
        memmove(copy + at, copy + at + cut, length - at - cut);
        length -= cut;
      } else if (length + 8 < 2 * size + 64) {
        const char *piece = pieces[next() % (sizeof pieces / sizeof pieces[0])];
        size_t added = strlen(piece);
        memmove(copy + at + added, copy + at, length - at);
        memcpy(copy + at, piece, added);
        length += added;
      }
    }
    /* a block of exactly this length: the address sanitizer then detects a read one byte beyond it */
    uint8_t *exact = malloc(length + 1);
    if (!exact)
      break;
    memcpy(exact, copy, length);
    LLVMFuzzerTestOneInput(exact, length);
    free(exact);
  }
  free(copy);
}

int main(int count, char **arguments) {
  int files = 0, variations = 0;
  for (int i = 1; i < count; i++) {
    if (i == 1 && (variations = atoi(arguments[i])) > 0)
      continue;
    DIR *folder = opendir(arguments[i]);
    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
      char path[4096];
      if (entry->d_name[0] == '.')
        continue;
      snprintf(path, sizeof path, "%s/%s", arguments[i], entry->d_name);
      FILE *file = fopen(path, "rb");
      if (!file)
        continue;
      enum { LARGEST = 1 << 20 };
      uint8_t *bytes = malloc(LARGEST);
      size_t size = bytes ? fread(bytes, 1, LARGEST, file) : 0;
      fclose(file);
      uint8_t *exact = malloc(size + 1);
      if (bytes && exact) {
        memcpy(exact, bytes, size);
        LLVMFuzzerTestOneInput(exact, size);
        vary(bytes, size, variations);
        files++;
      }
      free(exact);
      free(bytes);
    }
    if (folder)
      closedir(folder);
  }
  fprintf(stderr, "%d files\n", files);
  return files == 0;
}

/* The page of `clast report`: one HTML file that holds its program and its data. The build makes the empty page
 * (share/clast/report.html) from the other files of this folder; these functions add the data. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* Reads the empty page of this program: share/clast/report.html beside the program or beside its folder. The caller
 * frees *html. STATUS_MISSING when the program was built without npm: the message says what to install. */
status page_empty(unsigned char **html, size_t *size, struct error *error);

struct page_data { /* a small SQLite file (db/ask/page.h) */
  unsigned char *bytes;
  size_t size;
};
/* Writes the page with its data, compressed and as base64, so that no data is read as HTML. of: which store it is of,
 * for page_is_of_other(). *written: bytes of the file. STATUS_CONTENT: the empty page has no mark for the data. */
status page_write(const char *path, const unsigned char *html, size_t html_size, uint64_t of, size_t count,
                  const struct page_data *data, size_t *written, struct error *error);
/* Is there a page with another `of`? False also of an older page, which has none. */
bool page_is_of_other(const char *path, uint64_t of);

/* Writes data into the empty page. */
#include "analysis/report/page.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/text.h"

/* Mark that the data replaces. */
static const char mark[] = "<!-- data -->";
/* The number `of` follows it. */
static const char of_mark[] = "data-of=\"";

status page_empty(unsigned char **html, size_t *size, struct error *error) {
  static const char *const places[] = {"share/clast/report.html", "../share/clast/report.html"};
  char program[PATH_MAX], path[PATH_MAX + 64];
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  *html = NULL;
  program[length > 0 ? length : 0] = '\0';
  char *slash = strrchr(program, '/');
  if (slash)
    slash[1] = '\0';
  for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
    snprintf(path, sizeof path, "%s%s", program, places[i]);
    if (access(path, F_OK) != 0)
      continue;
    TRY(file_input(path, error));
    return file_read(path, "page", html, size, error);
  }
  return status_fail(
      error, STATUS_MISSING,
      "%sshare/clast/report.html: the empty page is missing. npm makes it (`apt-get install nodejs npm`) when "
      "all of clast is built: `./setup.sh build` in the folder with the sources of clast",
      program);
}

/* Compresses with gzip's best level and without a time: the same data gives the same bytes. */
static status compress_data(const struct page_data *data, unsigned char **packed, size_t *size, struct error *error) {
  z_stream stream = {.next_in = data->bytes, .avail_in = (uInt)data->size};
  if (data->size > UINT_MAX)
    return status_fail(error, STATUS_CONTENT, "the data of a page cannot have more than 4 GB");
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    return status_fail(error, STATUS_MEMORY, "no memory to compress the page");
  const uLong bound = deflateBound(&stream, (uLong)data->size);
  *packed = malloc(bound);
  stream.next_out = *packed;
  stream.avail_out = (uInt)bound;
  const bool whole = *packed && deflate(&stream, Z_FINISH) == Z_STREAM_END;
  *size = stream.total_out;
  deflateEnd(&stream);
  return whole ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory to compress the page");
}

/* RFC 4648, section 4. */
static void write_base64(const unsigned char *bytes, size_t size, FILE *out) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < size; i += 3) {
    const unsigned group = (unsigned)bytes[i] << 16 | (i + 1 < size ? (unsigned)bytes[i + 1] << 8 : 0) |
                           (i + 2 < size ? bytes[i + 2] : 0);
    putc(digits[group >> 18], out);
    putc(digits[group >> 12 & 63], out);
    putc(i + 1 < size ? digits[group >> 6 & 63] : '=', out);
    putc(i + 2 < size ? digits[group & 63] : '=', out);
  }
}

status page_write(const char *path, const unsigned char *html, size_t html_size, uint64_t of, size_t count,
                  const struct page_data *data, size_t *written, struct error *error) {
  OWNED char *text = NULL;
  const unsigned char *place = memmem(html, html_size, mark, sizeof mark - 1);
  if (!place)
    return status_fail(error, STATUS_CONTENT, "share/clast/report.html is damaged: build clast again");
  FILE *out = text_open_sized(&text, written);
  fwrite(html, 1, (size_t)(place - html), out);
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < count; i++) {
    OWNED unsigned char *packed = NULL;
    size_t size = 0;
    code = compress_data(&data[i], &packed, &size, error);
    fprintf(out, "<script type=\"application/octet-stream\" %s%016" PRIx64 "\" class=\"store\">", of_mark, of);
    write_base64(packed, code ? 0 : size, out);
    fputs("</script>\n", out);
  }
  const unsigned char *rest = place + sizeof mark - 1;
  fwrite(rest, 1, html_size - (size_t)(rest - html), out);
  if (!text_close(out, &text))
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  TRY(code);
  return file_write(path, "page", text, *written, error);
}

bool page_is_of_other(const char *path, uint64_t of) {
  OWNED unsigned char *html = NULL;
  size_t size = 0;
  struct error unread;
  char number[17] = "";
  struct stat there;
  if (stat(path, &there) != 0 || !S_ISREG(there.st_mode) || file_read(path, "page", &html, &size, &unread))
    return false;
  const unsigned char *at = memmem(html, size, of_mark, sizeof of_mark - 1);
  if (!at || (size_t)(html + size - at) < sizeof of_mark - 1 + sizeof number)
    return false;
  memcpy(number, at + sizeof of_mark - 1, sizeof number - 1);
  return strtoull(number, NULL, 16) != of;
}

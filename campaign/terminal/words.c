/* Sentences in lines that a terminal shows whole. */
#include "campaign/terminal/words.h"

#include <stdarg.h>
#include <stdbool.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "schemas/text.h"

#define ERROR ": error: "
enum { WIDTH = 100, PARAGRAPH = 4096, PIECE = 1024 };

void words_print(FILE *out, const char *head, const char *format, ...) {
  char text[PARAGRAPH];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  fputs(head, out);
  text_wrap(text, strlen(head), strlen(head), WIDTH, out);
}

static bool are_apart, was_table; /* words_wrap_stderr(); the last output was a table */

/* Before output on the other stream than the last one. */
static void turn(bool table) {
  if (are_apart && table != was_table)
    nanosleep(&(struct timespec){.tv_nsec = 200000000}, NULL);
  was_table = table;
}

void words_before_table(void) {
  turn(true);
}

struct line {
  size_t column;
  bool quoted;  /* in a command */
  bool blank;   /* a blank at the end of the last piece waits for the next word */
  bool excerpt; /* of a document, below its error: a marker stands under its place */
  int joined;   /* blanks of ERROR that are still to come */
  bool located; /* an error of a document: indented lines below it are an excerpt */
};

static size_t columns_of_stderr(void) {
  struct winsize size;
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known && size.ws_col < WIDTH ? size.ws_col : WIDTH;
}

/* Makes line ends of blanks. */
static void wrap_piece(struct line *line, char *text, size_t size) {
  const size_t room = columns_of_stderr();
  char *blank = NULL;
  size_t after = 0; /* column behind it */
  for (char *at = text; at < text + size; at++) {
    if (*at == '\n' || *at == '\r') {
      *line = (struct line){.located = line->located, .excerpt = line->excerpt, .blank = line->blank};
      blank = NULL;
      continue;
    }
    if (line->column == 0)
      line->excerpt = line->located && *at == ' ';
    if (line->column == 0 && !line->excerpt)
      line->located = false;
    if (strncmp(at, ERROR, strlen(ERROR)) == 0) { /* what is before it stays on the first line */
      line->located = true;
      line->joined = 2;
      blank = NULL;
    }
    if (*at == '\033') { /* a colour */
      while (at + 1 < text + size && *at != 'm' && *at != 'K')
        at++;
      continue;
    }
    line->quoted ^= *at == '`';
    if (((unsigned char)*at & 0xC0) != 0x80)
      line->column++;
    if (*at == ' ' && line->joined) {
      line->joined--;
    } else if (*at == ' ' && !line->quoted) {
      blank = at;
      after = line->column;
    }
    if (line->column > room + (blank == at) && blank && !line->excerpt) {
      *blank = '\n';
      blank = NULL;
      line->column -= after;
    }
  }
}

static ssize_t write_wrapped(void *of, const char *text, size_t size) {
  struct line *line = of;
  char piece[PIECE + 2];
  turn(false);
  for (size_t done = 0; done < size;) {
    const size_t taken = size - done < PIECE ? size - done : PIECE;
    size_t length = 0;
    if (line->blank)
      piece[length++] = ' ';
    memcpy(piece + length, text + done, taken);
    length += taken;
    done += taken;
    piece[length] = '\0';
    line->blank = piece[length - 1] == ' ';
    length -= line->blank;
    wrap_piece(line, piece, length);
    for (size_t written = 0; written < length;) {
      const ssize_t n = write(STDERR_FILENO, piece + written, length - written);
      if (n <= 0)
        return -1;
      written += (size_t)n;
    }
  }
  return (ssize_t)size;
}

void words_wrap_stderr(bool apart) {
  static struct line line;
  are_apart = apart;
  FILE *wrapped = fopencookie(&line, "w", (cookie_io_functions_t){.write = write_wrapped});
  if (wrapped && setvbuf(wrapped, NULL, _IONBF, 0) == 0)
    stderr = wrapped;
}

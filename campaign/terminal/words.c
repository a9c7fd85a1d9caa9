/* Sentences in lines that a terminal shows whole. */
#include "campaign/terminal/words.h"

#include <stdarg.h>
#include <stdbool.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "schemas/text.h"

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

struct line {
  size_t column;
  bool quoted; /* in a command */
  bool blank;  /* a blank at the end of the last piece waits for the next word */
  bool whole;  /* an error that a program may read, and the indented lines below it */
};

static size_t columns_of_stderr(void) {
  struct winsize size;
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known && size.ws_col < WIDTH ? size.ws_col : WIDTH;
}

/* Makes line ends of blanks. */
static void wrap_piece(struct line *line, char *text, size_t size) {
  const size_t room = columns_of_stderr();
  const bool terminal = isatty(STDERR_FILENO);
  char *blank = NULL;
  size_t after = 0; /* column behind it */
  for (char *at = text; at < text + size; at++) {
    if (*at == '\n' || *at == '\r') {
      *line = (struct line){.whole = line->whole};
      blank = NULL;
      continue;
    }
    if (line->column == 0)
      line->whole &= *at == ' ';
    line->whole |= !terminal && strncmp(at, ": error: ", strlen(": error: ")) == 0;
    if (*at == '\033') { /* a colour */
      while (at + 1 < text + size && *at != 'm' && *at != 'K')
        at++;
      continue;
    }
    line->quoted ^= *at == '`';
    if (((unsigned char)*at & 0xC0) != 0x80)
      line->column++;
    if (*at == ' ' && !line->quoted && line->column <= room + 1) {
      blank = at;
      after = line->column;
    } else if (line->column > room && blank && !line->whole) {
      *blank = '\n';
      blank = NULL;
      line->column -= after;
    }
  }
}

static ssize_t write_wrapped(void *of, const char *text, size_t size) {
  struct line *line = of;
  char piece[PIECE + 2];
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

void words_wrap_stderr(void) {
  static struct line line;
  FILE *wrapped = fopencookie(&line, "w", (cookie_io_functions_t){.write = write_wrapped});
  if (wrapped && setvbuf(wrapped, NULL, _IONBF, 0) == 0)
    stderr = wrapped;
}

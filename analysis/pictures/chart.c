/* Writes the script and the data of a chart, and runs gnuplot on them in a folder of their own beside the picture. */
#include "analysis/pictures/chart.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "analysis/pictures/picture_canvas.h"
#include "schemas/memory.h"
#include "schemas/text.h"

extern char **environ;

enum { LETTER = 8, LINE = 19, LINES = 7 }; /* pixels: width of a letter, height of a line; maximum lines of a text */
enum { TURNED = 50 };                      /* letters in a line of a name of a bar that is written upwards */
enum { STEM = 256 };

struct chart {
  const char *template;
  const struct picture_page *page;
  char *variables_text, *data_text;
  size_t variables_size, data_size;
  FILE *variables, *data;
  char folder[LIMITS_PATH], stem[STEM]; /* where gnuplot runs; the picture's name without folder and ending */
};

/* In single quotes gnuplot interprets no escapes and no `commands`, but it does expand a macro such as @x, so the text
 * is split after each @. A single quote and a line end cannot be inside single quotes: they are added in double quotes
 * ('' for a quote is misread at the start of a text, gnuplot 5.4). */
static void write_quoted(FILE *out, const char *text) {
  const char *end = text ? text + strlen(text) : text;
  fputc('\'', out);
  while (text && *text) {
    const size_t length = text_utf8_length(text, (size_t)(end - text));
    if (length == 0)
      fputc('?', out);
    else if (length > 1)
      fwrite(text, 1, length, out);
    else if (*text == '\n')
      fputs("'.\"\\n\".'", out);
    else if (*text == '\'')
      fputs("'.\"'\".'", out);
    else if (*text == '@')
      fputs("@'.'", out);
    else
      fputc((unsigned char)*text < ' ' || *text == 127 ? ' ' : *text, out);
    text += length ? length : 1;
  }
  fputc('\'', out);
}

void chart_text(struct chart *chart, const char *name, const char *text) {
  fprintf(chart->variables, "%s = ", name);
  write_quoted(chart->variables, text);
  fputc('\n', chart->variables);
}

void chart_number(struct chart *chart, const char *name, double value) {
  if (isfinite(value))
    fprintf(chart->variables, "%s = %.17g\n", name, value);
  else
    fprintf(chart->variables, "%s = NaN\n", name);
}

void chart_texts(struct chart *chart, const char *name, size_t count, const char *const *texts) {
  fprintf(chart->variables, "array %s[%zu]\n", name, count ? count : 1);
  for (size_t i = 0; i < count; i++) {
    fprintf(chart->variables, "%s[%zu] = ", name, i + 1);
    write_quoted(chart->variables, texts[i]);
    fputc('\n', chart->variables);
  }
}

void chart_numbers(struct chart *chart, const char *name, size_t count, const double *values) {
  fprintf(chart->variables, "array %s[%zu]\n", name, count ? count : 1);
  if (count == 0) /* gnuplot evaluates a line of a template even when its loop is empty */
    fprintf(chart->variables, "%s[1] = 1\n", name);
  for (size_t i = 0; i < count; i++)
    fprintf(chart->variables, "%s[%zu] = %.17g\n", name, i + 1, isfinite(values[i]) ? values[i] : 0);
}

size_t chart_letters(const char *text) {
  return text ? text_characters(text, SIZE_MAX) : 0;
}

/* Breaks a text at blanks into lines of at most `most` letters. Text beyond LINES lines is cut and ends in "...".
 * Returns the number of lines. */
static size_t fold(const char *text, size_t most, char *folded, size_t size) {
  size_t lines = 1, column = 0, used = 0;
  folded[0] = '\0';
  if (!text || !*text)
    return 0;
  while (*text && used + 8 < size) {
    const size_t bytes = strcspn(text, " \n");
    const size_t wide = text_characters(text, bytes);
    if (column > 0 && column + 1 + wide > most) {
      if (lines == LINES) {
        text_append(folded, size, " ...");
        break;
      }
      folded[used++] = '\n';
      column = 0;
      lines++;
    } else if (column > 0) {
      folded[used++] = ' ';
      column++;
    }
    const size_t taken = bytes < size - used - 8 ? bytes : size - used - 8;
    memcpy(folded + used, text, taken);
    used += taken;
    column += wide;
    text += bytes + strspn(text + bytes, " \n");
    folded[used] = '\0';
  }
  return lines;
}

/* Sets a text cut into lines of at most `most` letters; returns the number of lines. */
static double folded_text(struct chart *chart, const char *name, const char *text, double most) {
  char folded[2000], raised[2000];
  text_raise(text ? text : "", raised, sizeof raised);
  const size_t lines = fold(raised, (size_t)most, folded, sizeof folded);
  chart_text(chart, name, folded);
  return (double)lines;
}

struct chart *chart_new(const char *template, const struct picture_page *page, const struct picture_words *words) {
  struct chart *chart = memory_small(1, sizeof *chart);
  chart->template = template;
  chart->page = page;
  chart->variables = text_open_sized(&chart->variables_text, &chart->variables_size);
  chart->data = text_open_sized(&chart->data_text, &chart->data_size);
  const double room = page->width - 40;
  chart_number(chart, "title_lines", folded_text(chart, "title_text", words->title, room / (1.2 * LETTER)));
  chart_number(chart, "caption_lines", folded_text(chart, "caption_text", words->caption, room / (0.88 * LETTER)));
  folded_text(chart, "x_label", words->x, 0.85 * room / LETTER);
  folded_text(chart, "y_label", words->y, 0.5 * room / LETTER); /* runs upwards: the height of the frame limits it */
  return chart;
}

static size_t longest_line(const char *text) {
  size_t longest = 0;
  for (; *text; text += strcspn(text, "\n") + (text[strcspn(text, "\n")] != '\0')) {
    const size_t wide = text_characters(text, strcspn(text, "\n"));
    longest = wide > longest ? wide : longest;
  }
  return longest;
}

/* Sets an array of texts cut into lines of at most `most` letters. Returns the largest number of lines of one text. */
static size_t folded_texts(struct chart *chart, const char *name, size_t count, const char *const *texts, double most,
                           size_t *longest, size_t *shown) {
  size_t tall = 1;
  OWNED char(*folded)[500] = memory_small(count, sizeof *folded); /* at most PICTURE_SERIES labels or places */
  OWNED const char **label = memory_small(count, sizeof *label);
  *longest = *shown = 0;
  for (size_t i = 0; i < count; i++) {
    char raised[400];
    text_raise(texts[i] ? texts[i] : "", raised, sizeof raised);
    const size_t lines = fold(raised, (size_t)fmax(most, 1), folded[i], sizeof folded[i]);
    const size_t wide = longest_line(folded[i]);
    label[i] = folded[i];
    tall = lines > tall ? lines : tall;
    *longest = wide > *longest ? wide : *longest;
    *shown += wide > 0;
  }
  chart_texts(chart, name, count, label);
  return tall;
}

double chart_legend(struct chart *chart, size_t count, const char *const *labels) {
  size_t longest, shown;
  const double room = (chart->page->width - 125) / LETTER;
  const size_t tall = folded_texts(chart, "label", count, labels, room, &longest, &shown);
  size_t columns = (size_t)(room / ((double)longest + 7));
  columns = columns < 1 ? 1 : columns > 4 ? 4 : columns;
  chart_number(chart, "legend_columns", (double)columns);
  chart_number(chart, "legend_lines", (double)tall);
  return (double)(LINE * tall * ((shown + columns - 1) / columns));
}

double chart_places(struct chart *chart, size_t count, const char *const *places) {
  size_t longest, shown;
  const double room = (chart->page->width - 110) / LETTER / (double)(count ? count : 1) - 1;
  size_t widest = 0; /* word */
  for (size_t i = 0; i < count; i++)
    for (const char *word = places[i]; *word; word += strcspn(word, " ") + strspn(word + strcspn(word, " "), " ")) {
      const size_t wide = text_characters(word, strcspn(word, " "));
      widest = wide > widest ? wide : widest;
    }
  const bool turned = (double)widest > room;
  const size_t tall = folded_texts(chart, "place", count, places, turned ? TURNED : room, &longest, &shown);
  chart_number(chart, "place_turned", turned);
  chart_number(chart, "place_lines", turned ? 1 : (double)tall);
  return turned ? LETTER * (double)longest : (double)(LINE * (tall - 1));
}

void chart_columns(struct chart *chart, const char *names) {
  fprintf(chart->data, "# %s\n", names);
}

void chart_row(struct chart *chart, size_t count, const double *values) {
  for (size_t i = 0; i < count; i++) {
    if (isfinite(values[i]))
      fprintf(chart->data, "%s%.9g", i ? " " : "", values[i]);
    else
      fprintf(chart->data, "%sNaN", i ? " " : "");
  }
  fputc('\n', chart->data);
}

void chart_block_end(struct chart *chart) {
  fputs("\n\n", chart->data);
}

/* ---- the script ---- */

static const char *template_of(const char *name) {
  const struct chart_template *t = chart_templates;
  while (strcmp(t->name, name) != 0)
    t++;
  return t->text;
}

/* Writes variables, frame.gp and the template. */
static status write_script(struct chart *chart, double height, char **script, size_t *size, struct error *error) {
  const struct picture_page *page = chart->page;
  const char *ending = strrchr(page->path, '.') + 1;
  char file[STEM + 40];
  snprintf(file, sizeof file, "./%s.%s", chart->stem, ending);
  chart_text(chart, "output_file", file);
  chart_text(chart, "ending", ending);
  snprintf(file, sizeof file, "./%s.dat", chart->stem);
  chart_text(chart, "data", file);
  chart_number(chart, "page_width", page->width);
  chart_number(chart, "page_height", height);
  fflush(chart->variables);
  fflush(chart->data);
  FILE *out = text_open_sized(script, size);
  fprintf(out,
          "# A chart of clast for gnuplot 5.4. Change what you like, then run gnuplot on this file in its folder.\n\n"
          "# What this chart shows. The numbers are in the data file.\n%s\n%s\n%s",
          chart->variables_text, template_of("frame"), template_of(chart->template));
  if (!text_close(out, script) || ferror(chart->data) || ferror(chart->variables))
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  return STATUS_OK;
}

/* ---- gnuplot as a child process ---- */

struct in_folder {
  char path[LIMITS_PATH + STEM + 32];
};

/* The file of the chart with this ending in its folder. */
static struct in_folder in_folder(const struct chart *chart, const char *ending) {
  struct in_folder file;
  snprintf(file.path, sizeof file.path, "%s/%s.%s", chart->folder, chart->stem, ending);
  return file;
}

/* *end: gnuplot's exit code; -1: it was killed. STATUS_MISSING: gnuplot is not installed. */
static status run_gnuplot(const struct chart *chart, int *end, struct error *error) {
  posix_spawn_file_actions_t actions;
  char script[STEM + 8], messages[STEM + 16]; /* a name may begin with a dash */
  snprintf(script, sizeof script, "./%s.gp", chart->stem);
  snprintf(messages, sizeof messages, "./%s.messages", chart->stem);
  char *arguments[] = {"gnuplot", "-d", script, NULL}; /* -d: without start-up files */
  pid_t child;
  int state;
  if (posix_spawn_file_actions_init(&actions))
    return status_fail(error, STATUS_MEMORY, "no memory to start gnuplot");
  posix_spawn_file_actions_addchdir_np(&actions, chart->folder);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, messages, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int code = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (code == ENOENT)
    return status_fail(error, STATUS_MISSING,
                       "gnuplot draws the charts of clast, and this machine has none: `apt-get install gnuplot-nox`. "
                       "Tables do not need it");
  if (code)
    return status_fail(error, STATUS_MEMORY, "gnuplot does not start: %s", strerror(code));
  while (waitpid(child, &state, 0) < 0)
    if (errno != EINTR)
      return status_fail(error, STATUS_INTERNAL, "gnuplot was lost: %s", strerror(errno));
  *end = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  return STATUS_OK;
}

/* gnuplot drew nothing: says why in its own words, joined on one line. */
static status refuse(const struct chart *chart, int end, struct error *error) {
  char text[2000];
  FILE *in = fopen(in_folder(chart, "messages").path, "r");
  const size_t count = in ? fread(text, 1, sizeof text - 1, in) : 0;
  if (in)
    fclose(in);
  text[count] = '\0';
  for (size_t i = 0; i < count; i++)
    if ((unsigned char)text[i] < ' ')
      text[i] = ' ';
  return status_fail(error, STATUS_IO, "%s: gnuplot drew nothing (exit %d): %s", chart->page->path, end,
                     *text ? text : "it does not say why; is the disk full?");
}

/* Puts the picture in place, and with page->keep_script NAME.gp and NAME.dat beside it. */
static status keep(const struct chart *chart, const char *script, size_t size, const char *drawn, struct error *error) {
  const struct picture_page *page = chart->page;
  const int stem = (int)(strrchr(page->path, '.') - page->path);
  char beside[2][LIMITS_PATH + 8];
  OWNED unsigned char *bytes = NULL;
  snprintf(beside[0], sizeof beside[0], "%.*s.gp", stem, page->path);
  snprintf(beside[1], sizeof beside[1], "%.*s.dat", stem, page->path);
  if (page->keep_script) {
    TRY(file_may_replace(beside[0], "script", error));
    TRY(file_may_replace(beside[1], "data of the chart", error));
    TRY(file_write(beside[0], "script", script, size, error));
    TRY(file_write(beside[1], "data of the chart", chart->data_text, chart->data_size, error));
  }
  TRY(file_read(drawn, "picture", &bytes, &size, error));
  return file_write(page->path, "picture", bytes, size, error);
}

/* Writes script and data into the folder, runs gnuplot there and takes the picture out of it. */
static status draw(const struct chart *chart, const char *script, size_t size, struct error *error) {
  struct stat about;
  int end = 0;
  const struct in_folder picture = in_folder(chart, strrchr(chart->page->path, '.') + 1);
  TRY(file_write(in_folder(chart, "gp").path, "chart", script, size, error));
  TRY(file_write(in_folder(chart, "dat").path, "chart", chart->data_text, chart->data_size, error));
  TRY(run_gnuplot(chart, &end, error));
  if (end == 0 && stat(picture.path, &about) == 0 && about.st_size > 0)
    return keep(chart, script, size, picture.path, error);
  return refuse(chart, end, error);
}

static status draw_in_folder(struct chart *chart, double height, struct error *error) {
  const struct picture_page *page = chart->page;
  if (strcmp(chart->template, "movie") != 0) /* a GIF */
    TRY(picture_canvas_named(page->path, error));
  if (!(page->width >= 200 && page->width <= 8000 && height >= 50 && height <= 16000))
    return status_fail(error, STATUS_USAGE, "%s: a picture is 200 to 8000 wide, not %g x %g", page->path, page->width,
                       height);
  const char *ending = strrchr(page->path, '.') + 1, *slash = strrchr(page->path, '/'),
             *base = slash ? slash + 1 : page->path;
  if (strlen(page->path) + 16 > LIMITS_PATH)
    return status_fail(error, STATUS_USAGE, "the name of the picture is too long");
  snprintf(chart->stem, sizeof chart->stem, "%.*s", (int)(ending - 1 - base), base);
  OWNED char *script = NULL;
  size_t size = 0;
  TRY(write_script(chart, height, &script, &size, error));
  TRY(file_may_replace(page->path, "picture", error));
  snprintf(chart->folder, sizeof chart->folder, "%s.XXXXXX", page->path);
  if (!mkdtemp(chart->folder))
    return status_fail(error, STATUS_IO, "cannot write the picture '%s': %s", page->path, strerror(errno));
  const status code = draw(chart, script, size, error);
  const char *const endings[] = {"gp", "dat", "messages", ending};
  for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
    unlink(in_folder(chart, endings[i]).path);
  rmdir(chart->folder);
  return code;
}

status chart_draw(struct chart *chart, double height, struct error *error) {
  const status code = draw_in_folder(chart, height, error);
  fclose(chart->variables);
  fclose(chart->data);
  free(chart->variables_text);
  free(chart->data_text);
  free(chart);
  return code;
}

/* Writes the script and the data of a chart. */
#include "analysis/pictures/chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/chart_run.h"
#include "analysis/pictures/picture_canvas.h"
#include "schemas/file.h"
#include "schemas/text.h"

enum { LETTER = 8, LINE = 19, LINES = 4 }; /* pixels: width of a letter, height of a line; maximum lines of a text */

struct chart {
  const char *template;
  char *variables_text, *data_text;
  size_t variables_size, data_size;
  FILE *variables, *data;
};

static void release(struct chart *chart) {
  if (!chart)
    return;
  if (chart->variables)
    fclose(chart->variables);
  if (chart->data)
    fclose(chart->data);
  free(chart->variables_text);
  free(chart->data_text);
  free(chart);
}

struct chart *chart_new(const char *template) {
  struct chart *chart = calloc(1, sizeof *chart);
  if (!chart)
    return NULL;
  chart->template = template;
  chart->variables = text_open(&chart->variables_text, &chart->variables_size);
  chart->data = text_open(&chart->data_text, &chart->data_size);
  if (chart->variables && chart->data)
    return chart;
  release(chart);
  return NULL;
}

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
  size_t count = 0;
  for (; text && *text; text++)
    count += (*text & 0xC0) != 0x80;
  return count;
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
    size_t wide = 0;
    for (size_t i = 0; i < bytes; i++)
      wide += (text[i] & 0xC0) != 0x80;
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

void chart_words(struct chart *chart, const struct picture_page *page, const struct picture_words *words) {
  char folded[2000];
  const double room = page->width - 40;
  chart_number(chart, "title_lines",
               (double)fold(words->title, (size_t)(room / (1.2 * LETTER)), folded, sizeof folded));
  chart_text(chart, "title_text", folded);
  chart_number(chart, "caption_lines",
               (double)fold(words->caption, (size_t)(room / (0.88 * LETTER)), folded, sizeof folded));
  chart_text(chart, "caption_text", folded);
  fold(words->x, (size_t)(0.85 * room / LETTER), folded, sizeof folded);
  chart_text(chart, "x_label", folded);
  fold(words->y, (size_t)(0.5 * room / LETTER), folded,
       sizeof folded); /* the y label runs upwards: its length is limited by the height of the frame */
  chart_text(chart, "y_label", folded);
}

double chart_legend(struct chart *chart, const struct picture_page *page, size_t count, const char *const *labels) {
  size_t longest = 0, shown = 0;
  for (size_t i = 0; i < count; i++) {
    const size_t wide = chart_letters(labels[i]);
    longest = wide > longest ? wide : longest;
    shown += wide > 0;
  }
  size_t columns = (size_t)((page->width - 60) / (LETTER * ((double)longest + 6)));
  columns = columns < 1 ? 1 : columns > 4 ? 4 : columns;
  chart_number(chart, "legend_columns", (double)columns);
  return (double)(LINE * ((shown + columns - 1) / columns));
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

/* The text of a template, from page->templates if given, else the compiled-in one. The caller frees it. */
static status read_template(const struct picture_page *page, const char *name, char **text, struct error *error) {
  *text = NULL;
  if (!page->templates) {
    for (const struct chart_template *t = chart_templates; t->name; t++)
      if (strcmp(t->name, name) == 0)
        *text = strdup(t->text);
    return *text ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the template %s", name);
  }
  char path[4096];
  enum { MOST = 1 << 20 };
  snprintf(path, sizeof path, "%s/%s.gp", page->templates, name);
  TRY(file_input(path, error));
  FILE *in = fopen(path, "r");
  if (!in)
    return status_fail(error, STATUS_MISSING,
                       "%s: there is no such template. Copy all templates from share/clast/templates of the "
                       "installation, or from analysis/pictures/templates of the source, and change the copies",
                       path);
  *text = calloc(MOST + 1, 1);
  if (*text)
    (*text)[fread(*text, 1, MOST, in)] = '\0';
  fclose(in);
  return *text ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the template %s", path);
}

/* Writes variables, frame.gp and the template. */
static status write_script(struct chart *chart, const struct picture_page *page, double height, char **script,
                           size_t *size, struct error *error) {
  char *frame = NULL, *template = NULL, stem[256];
  status code = read_template(page, "frame", &frame, error);
  if (code == STATUS_OK)
    code = read_template(page, chart->template, &template, error);
  FILE *out = code == STATUS_OK ? text_open(script, size) : NULL;
  if (code == STATUS_OK && !out)
    code = status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  if (out) {
    chart_run_stem(page->path, stem, sizeof stem);
    const char *ending = strrchr(page->path, '.') + 1;
    char file[300];
    snprintf(file, sizeof file, "./%s.%s", stem, ending);
    chart_text(chart, "output_file", file);
    chart_text(chart, "ending", ending);
    snprintf(file, sizeof file, "./%s.dat", stem);
    chart_text(chart, "data", file);
    chart_number(chart, "page_width", page->width);
    chart_number(chart, "page_height", height);
    const bool whole = fflush(chart->variables) == 0;
    fputs("# A chart of clast for gnuplot 5.4. Change what you like, then run gnuplot on this file in its folder.\n\n"
          "# What this chart shows. The numbers are in the data file.\n",
          out);
    fwrite(chart->variables_text, 1, chart->variables_size, out);
    fprintf(out, "\n%s\n%s", frame, template);
    if (!text_close(out, script) || !whole)
      code = status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  }
  free(frame);
  free(template);
  return code;
}

status chart_draw(struct chart *chart, const struct picture_page *page, double height, struct error *error) {
  char *script = NULL;
  size_t size = 0;
  status code = picture_canvas_named(page->path, error);
  if (code == STATUS_OK && !(page->width >= 200 && page->width <= 8000 && height >= 50 && height <= 16000))
    code = status_fail(error, STATUS_USAGE, "%s: a picture is 200 to 8000 wide, not %g x %g", page->path, page->width,
                       height);
  if (code == STATUS_OK)
    code = write_script(chart, page, height, &script, &size, error);
  fflush(chart->data);
  if (code == STATUS_OK && (ferror(chart->data) || ferror(chart->variables)))
    code = status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  if (code == STATUS_OK)
    code = chart_run(page, &(struct chart_run_files){script, chart->data_text, size, chart->data_size}, error);
  free(script);
  release(chart);
  return code;
}

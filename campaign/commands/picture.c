/* `clast picture FIELDS PICTURE`: draws a body in pieces. */
#include "campaign/commands/picture.h"

#include "analysis/picture.h"
#include "campaign/commands/commands.h"
#include "engine/body.h"

enum { WIDTH = 900 };

struct options {
  const char *caption;
};

status picture_draw(const char *fields, const char *picture, const char *caption, struct error *error) {
  struct body body;
  status code = body_read(fields, &body, error);
  if (code)
    return code;
  struct picture_panel panel = {
      .body = {.cells = body.cells, .first_vertex = body.first_vertex, .vertex = (const double(*)[2])body.vertex,
               .fragment = body.fragment, .cracks = body.cracks, .crack = (const uint32_t(*)[2])body.crack}};
  char numbers[160];
  picture_fragments_numbers(&panel.body, "grains", numbers, sizeof numbers);
  code = picture_fragments(picture, WIDTH, caption, numbers, 1, &panel, error);
  body_clear(&body);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  return picture_draw(line->arguments[0], line->arguments[1], options->caption, error);
}

static const struct option_row rows[] = {
    {"caption", 0, OPTION_TEXT, "TEXT", offsetof(struct options, caption), 0, 0, NULL, "Title over it."},
};

const struct command picture_command = {
    .name = "picture",
    .group = "results",
    .arguments = "FIELDS.h5 PICTURE.png",
    .summary = "draw the body of a fields file, fragments in colours",
    .doc = "Draws the body as it is in a fields file (of simulate, replay, or a campaign that keeps fields): every fragment\n"
           "in a colour of its own, cracks inside fragments as lines. The ending chooses the format, .png or .svg.",
    .examples = "clast picture disc.h5 disc.png\nclast picture disc.h5 disc.svg --caption \"seed 7\"",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};

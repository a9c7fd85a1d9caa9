/* `clast picture FIELDS PICTURE`: draws the body of a fields file, whichever engine wrote it. */
#include "campaign/commands/commands.h"

static status run(const struct command_line *line, struct error *error) {
  return picture_draw(line->arguments[0], line->arguments[1], line->options, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("caption", 0, "TEXT", struct picture_choice, caption, NULL),
    OPTION_ROW_TEXT("what", 0, "QUANTITY", struct picture_choice, what, NULL),
    OPTION_ROW_TEXT("view", 0, "VIEW", struct picture_choice, view, NULL),
    OPTION_ROW_TEXT("axis", 0, "x|y|z", struct picture_choice, axis, NULL),
    OPTION_ROW_TEXT("at", 0, "LENGTH", struct picture_choice, at, NULL),
    CHART_OPTIONS(struct picture_choice, chart),
};

COMMAND(picture, "results", "FIELDS.hdf[.series] PICTURE.png", COMMAND_OPTIONS(struct picture_choice, rows),
        .run = run);

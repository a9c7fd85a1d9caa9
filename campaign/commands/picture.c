/* `clast picture FIELDS PICTURE`: draws the body of a fields file, whichever engine wrote it. */
#include "campaign/charts/charts.h"
#include "campaign/commands/commands.h"

static status run(const struct command_line *line, struct error *error) {
  return picture_draw(line->arguments[0], line->arguments[1], line->options, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("caption", 0, "TEXT", struct picture_choice, caption, NULL, "Title of the picture."),
    OPTION_ROW_TEXT("what", 0, "QUANTITY", struct picture_choice, what, NULL,
                    "Particles: quantity that the colour shows: damage (or pressure if nothing can crack), pressure, "
                    "density, energy, distention, flaws..., or fragments."),
    OPTION_ROW_TEXT(
        "view", 0, "VIEW", struct picture_choice, view, NULL,
        "Particles: cut (through a plane; the default), outside, apart (fragments side by side; the "
        "default "
        "for fragments), or profile (distention and damage, or --what, against depth along the axis of an impact or a "
        "plate)."),
    OPTION_ROW_TEXT(
        "axis", 0, "x|y|z", struct picture_choice, axis, NULL,
        "Particles: direction of view, at right angles to a cut (y; from outside the one that shows the heaviest "
        "fragments best)."),
    OPTION_ROW_TEXT("at", 0, "LENGTH", struct picture_choice, at, NULL,
                    "Particles: position of the cut on that axis (the middle of the heaviest fragment)."),
    CHART_OPTIONS(struct picture_choice, chart),
};

const struct command picture_command = {
    .name = "picture",
    .group = "results",
    .arguments = "FIELDS.hdf PICTURE.png",
    .text = picture_text,
    COMMAND_OPTIONS(struct picture_choice, rows),
    .run = run,
};

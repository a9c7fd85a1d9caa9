#ifndef CLAST_CAMPAIGN_COMMANDS_PICTURE_H
#define CLAST_CAMPAIGN_COMMANDS_PICTURE_H

#include "schemas/status.h"

/* Draws the body of a fields file, fragments in colours, as PNG or SVG. caption may be NULL. */
status picture_draw(const char *fields, const char *picture, const char *caption, struct error *error);

#endif

/* Pictures in rows on one page. For the picture_*.c files only. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_SHEET_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_SHEET_H

#include "analysis/pictures/picture_canvas.h"

struct picture_sheet {
  struct picture_canvas canvas;
  size_t count, columns, drawn;
  double view[4], gap, top, wide, tall, font; /* top: of the first row; wide, tall: of one picture */
  double right, below;                        /* places of the legend, and of scale bar and note */
};
/* Begins the next picture: its caption, and the title before the first. Then as picture_canvas_place(). */
double picture_sheet_next(struct picture_sheet *sheet, const char *title, const char *caption);

#endif

/* Pictures in rows on one page: as many columns as rows, or a few more. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"
#include "schemas/memory.h"

status picture_sheet_open(const char *path, size_t count, const struct picture_frame *frame, struct picture_sheet **out,
                          struct error *error) {
  enum { ONE_ROW = 5, WIDE = 260 };
  OWNED struct picture_sheet *sheet = memory_small(1, sizeof *sheet);
  const double aspect = (frame->view[3] - frame->view[1]) / (frame->view[2] - frame->view[0]);
  if (!isfinite(aspect))
    return status_fail(error, STATUS_USAGE, "%s: the body has no extent to draw", path);
  sheet->columns = count <= ONE_ROW ? count : (size_t)ceil(sqrt(1.6 * (double)count));
  sheet->count = count;
  sheet->font = 14;
  sheet->gap = 16;
  sheet->wide = count > 2 ? WIDE : 2 * WIDE;
  sheet->tall = sheet->wide * fmin(fmax(aspect, 0.3), 1.6);
  sheet->top = 3.6 * sheet->font;
  memcpy(sheet->view, frame->view, sizeof sheet->view);
  const size_t rows = (count + sheet->columns - 1) / sheet->columns;
  sheet->right = sheet->gap + (sheet->wide + sheet->gap) * (double)sheet->columns;
  sheet->below = sheet->top + (sheet->tall + 2.4 * sheet->font) * (double)rows;
  TRY(picture_canvas_open(&sheet->canvas, path, sheet->right + 8 * sheet->font, sheet->below + 7 * sheet->font, error));
  *out = sheet;
  sheet = NULL;
  return STATUS_OK;
}

double picture_sheet_next(struct picture_sheet *sheet, const char *title, const char *caption) {
  cairo_t *cairo = sheet->canvas.cairo;
  const size_t column = sheet->drawn % sheet->columns, row = sheet->drawn / sheet->columns;
  const double left = sheet->gap + (sheet->wide + sheet->gap) * (double)column;
  const double top = sheet->top + (sheet->tall + 2.4 * sheet->font) * (double)row;
  if (sheet->drawn++ == 0)
    picture_canvas_head(cairo, sheet->gap, sheet->right, sheet->font, title, 0, NULL);
  cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
  picture_canvas_text(cairo, left + sheet->wide / 2, top + sheet->tall + 1.4 * sheet->font, sheet->font, PICTURE_CENTRE,
                      false, caption);
  return picture_canvas_place(cairo, sheet->view, left, top, sheet->wide, sheet->tall);
}

status picture_sheet_close(struct picture_sheet *sheet, status code, struct error *error) {
  code = picture_canvas_close(&sheet->canvas, code, error);
  free(sheet);
  return code;
}

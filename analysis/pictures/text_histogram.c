/* Histograms as text. */
#include "analysis/pictures/picture.h"

enum { FRONT = 20, LEAST_COLUMNS = 40 };

void text_histogram_print(FILE *out, int columns, bool unicode, const struct scatter_histogram *histogram) {
  size_t most = 1;
  for (size_t b = 0; b < histogram->bins; b++)
    if (histogram->count[b] > most)
      most = histogram->count[b];
  const size_t room = (size_t)(columns > LEAST_COLUMNS ? columns : LEAST_COLUMNS) - FRONT;
  if (histogram->bins)
    fprintf(out, "%10s %8s\n", "from", "runs");
  for (size_t b = 0; b < histogram->bins; b++) {
    const size_t bar = histogram->count[b] ? 1 + (room - 1) * histogram->count[b] / most : 0;
    fprintf(out, "%10.4g %8zu%s", histogram->from + (double)b * histogram->width, histogram->count[b], bar ? " " : "");
    for (size_t i = 0; i < bar; i++)
      fputs(unicode ? "\xe2\x96\x88" : "#", out);
    fputc('\n', out);
  }
}

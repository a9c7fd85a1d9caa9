/* Named values with intervals as bars, in groups side by side. */
#include <math.h>

#include "analysis/pictures/chart.h"

enum { MOST_NAMES = 100 };
static const double none = NAN;

status picture_bars(const struct picture_page *page, const struct picture_words *words, size_t names,
                    const char *const *name, size_t groups, const char *const *group, const struct picture_bar *value,
                    struct error *error) {
  if (names < 1 || names > MOST_NAMES || groups < 1 || groups > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: 1 to %d bars in 1 to %d groups can be read, not %zu in %zu",
                       page->path, MOST_NAMES, PICTURE_SERIES, names, groups);
  struct chart *chart = chart_new("bars");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  chart_number(chart, "bars", (double)names);
  chart_number(chart, "series", (double)groups);
  chart_texts(chart, "name", names, name);
  size_t longest = 0;
  for (size_t i = 0; i < names; i++)
    longest = chart_letters(name[i]) > longest ? chart_letters(name[i]) : longest;
  chart_number(chart, "name_letters", (double)longest);
  chart_texts(chart, "label", groups, group);
  for (size_t g = 0; g < groups; g++) {
    chart_columns(chart, "bar value low high");
    for (size_t i = 0; i < names; i++) {
      const struct picture_bar *b = &value[g * names + i];
      const bool bar = isfinite(b->low) && isfinite(b->high);
      chart_row(chart, 4, (double[]){(double)i, b->value, bar ? b->low : none, bar ? b->high : none});
    }
    chart_block_end(chart);
  }
  const double legend = chart_legend(chart, page, groups, group);
  return chart_draw(chart, page, 110 + 34 * (double)(names > 6 ? names : 6) + legend, error);
}

/* The curves of spectra that `clast spectrum` draws and prints, with their fits and a measured spectrum. */
#ifndef CLAST_CAMPAIGN_CHARTS_SPECTRUM_CURVES_H
#define CLAST_CAMPAIGN_CHARTS_SPECTRUM_CURVES_H

#include "analysis/pictures/picture.h"
#include "analysis/statistics/measured.h"
#include "campaign/terminal/table.h"
#include "db/ask/pool.h"

struct spectrum_choice {
  struct ask_pool_choice pool;
  bool cumulative, runs;           /* runs: also every single run */
  double density;                  /* kg/m^3: sizes are shown instead of masses; 0: masses */
  const struct measured *measured; /* NULL: none */
};

/* Reads a measured spectrum for the choice. The choice's density and the store's dimensions relate sizes and masses. */
status spectrum_curves_measured(struct store *store, const char *path, struct spectrum_choice *choice,
                                struct measured *measured, struct error *error);

/* A pool's spectrum with its headline fit, which only a pool of one point has. */
struct spectrum_curve {
  char label[ASK_POOL_LABEL + 64], fit_label[96];
  struct pooled_form form;
  struct pooled_bin *bins; /* owned */
  size_t count;
  double complete_mass; /* kg; NaN: not known */
  struct picture_fit fit;
  struct pooled_rivals rivals; /* n 0: not requested */
  struct picture_thin *thin;   /* one for each run; owned with their bins */
  size_t thin_count;
};
/* with_rivals: also computes likelihood ratios of the pure power law against other laws. */
status spectrum_curves_make(const struct spectrum_choice *choice, bool with_rivals, const struct ask_pool *pool,
                            struct spectrum_curve *curve, struct error *error);
void spectrum_curves_release(struct spectrum_curve *curve);                       /* a zeroed one is fine */
struct picture_series spectrum_curves_series(const struct spectrum_curve *curve); /* borrows the curve */

/* The first eight pools, with the measured spectrum. page NULL: no picture. text: a plot on stdout. */
struct spectrum_drawing {
  const struct picture_page *page;
  bool text, ascii;
};
status spectrum_curves_draw(struct store *store, const struct spectrum_choice *choice,
                            const struct spectrum_drawing *drawing, struct error *error);

#endif

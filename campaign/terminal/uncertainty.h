/* The two errors of a mean in words: the possible changes by other seeds and by a finer resolution. */
#ifndef CLAST_CAMPAIGN_TERMINAL_UNCERTAINTY_H
#define CLAST_CAMPAIGN_TERMINAL_UNCERTAINTY_H

#include <stddef.h>
#include <stdio.h>

#include "db/ask/ask.h"

enum { UNCERTAINTY_TEXT = 256 };

/* "0.349 +- 0.003": the error has one digit, or two after a leading 1; the value has as many decimals. Without a half
 * width above 0: "0.349". */
void uncertainty_number(double value, double half_width, char text[UNCERTAINTY_TEXT]);

/* The same as a cell of a table: "0.349 ± 0.003". */
void uncertainty_cell(double value, double half_width, char text[UNCERTAINTY_TEXT]);

/* "0.03 +- 0.02 below its limit", of a mean less its limit. */
void uncertainty_distance(double distance, double half_width, char text[UNCERTAINTY_TEXT]);

/* "0.349 +- 0.003 (seeds, 95 %)", or "(seeds, 95 %, weak)"; "1 (all 30 runs; 0.905 to 1)" when all values of a share
 * are equal; "0.349" without an interval. */
void uncertainty_seeds(const struct sample_summary *mean, char text[UNCERTAINTY_TEXT]);

/* "0.03 +- 0.02 below its limit (resolution: particles)", "+- 0.06 (resolution: particles)", "up to +- 0.06
 * (resolution: particles); studied at 2 of 9 points, `clast converge SCENE` studies others", "+- 0.06 or more
 * (resolution: particles)", "resolution: not studied; `clast converge SCENE` measures it", or "resolution: does not
 * converge (`clast converge SCENE`)". The knobs are those that were studied. */
void uncertainty_resolution(const struct ask_resolution *resolution, char text[UNCERTAINTY_TEXT]);

/* The same for the cell of a table: "0.06", ">= 0.06", "diverges", or "not studied". */
void uncertainty_resolution_cell(enum ask_resolution_verdict verdict, double half_width, char text[UNCERTAINTY_TEXT]);

#define UNCERTAINTY_MARK " !"
/* Behind a number: nothing, " !" when it rests on runs in doubt, " (17) !" when the values of others are withheld. */
void uncertainty_mark(const struct ask_doubts *doubts, char text[UNCERTAINTY_TEXT]);

/* A line for each condition that runs break: how many of how many, what it says, and what to do. */
void uncertainty_doubts(const struct ask_doubts *doubts, FILE *out);

#endif

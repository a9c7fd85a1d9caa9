/* Words for the errors of a mean. */
#include "campaign/terminal/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/terminal/words.h"

enum { MOST_DECIMALS = 15 };
static const double MOST_DIGITS = 1e15; /* a double has no more digits than that */
static const double SMALL = 1e-3;       /* below it a common power of ten is shorter than zeros */
static const double LARGE = 1e6;        /* from it on, too, if the error leaves THOUSANDS zeros or more */
enum { THOUSANDS = 3 };
static const double ONE_LEADS = 1.95; /* times its decade: from here on two digits begin with a 2 */

/* Decade of the last digit that an error allows: one digit of the error, two after a leading 1. Rounding moves it by at
 * most a quarter. */
static double last_decade(double half_width) {
  const double leading = floor(log10(half_width));
  return half_width < ONE_LEADS * pow(10, leading) ? leading - 1 : leading;
}

static void write_number(const char *format, double value, char text[UNCERTAINTY_TEXT]) {
  snprintf(text, UNCERTAINTY_TEXT, format, value);
  text_powers(text, UNCERTAINTY_TEXT);
}

void uncertainty_number(double value, double half_width, char text[UNCERTAINTY_TEXT]) {
  if (!(half_width > 0)) {
    write_number("%.4g", value, text);
    return;
  }
  const double size = fmax(fabs(value), half_width);
  if (size < SMALL || (size >= LARGE && last_decade(half_width) >= THOUSANDS)) { /* (3.3 +- 0.2)×10^-5 */
    double decade = floor(log10(size));
    char digits[UNCERTAINTY_TEXT];
    uncertainty_number(value / pow(10, decade), half_width / pow(10, decade), digits);
    if (fabs(strtod(digits, NULL)) >= 10) { /* 9.7 +- 2 became 10 +- 2 */
      decade++;
      uncertainty_number(value / pow(10, decade), half_width / pow(10, decade), digits);
    }
    snprintf(text, UNCERTAINTY_TEXT,
             "(%.40s)\xc3\x97"
             "10^%d",
             digits, (int)decade);
    return;
  }
  double leading = last_decade(half_width);
  if (value != 0 && fabs(value) < 0.5 * pow(10, leading)) /* 0.3 +- 2.7, not 0 +- 3 */
    leading--;
  if (leading < -MOST_DECIMALS || leading > MOST_DECIMALS || fabs(value) >= MOST_DIGITS) {
    snprintf(text, UNCERTAINTY_TEXT, "%.4g \xc2\xb1 %.2g", value, half_width);
    text_powers(text, UNCERTAINTY_TEXT);
    return;
  }
  const int decimals = leading < 0 ? (int)-leading : 0;
  const double step = leading > 0 ? pow(10, leading) : 0; /* 58 500 +- 1900 */
  snprintf(text, UNCERTAINTY_TEXT, "%.*f \xc2\xb1 %.*f", decimals, step > 0 ? step * round(value / step) : value,
           decimals, step > 0 ? step * round(half_width / step) : half_width);
}

/* "0.27", or "270" where the last digit is in the tens. */
static void write_to(double last, double number, char text[32]) {
  const double step = pow(10, last);
  snprintf(text, 32, "%.*f", last < 0 ? (int)-last : 0, last > 0 ? step * round(number / step) : number);
}

/* The same of an end of a range, which is exact: "0" or "1". */
static void write_end(double last, double end, char text[32]) {
  write_to(end == 0 || end == 1 ? 0 : last, end, text);
}

/* The same with a power of ten: "3e+07" where the last digit is the leading one. */
static void write_power(double last, double number, char text[32]) {
  const double leading = number > 0 ? floor(log10(number)) : last;
  snprintf(text, 32, "%.*g", leading > last ? (int)(leading - last) + 1 : 1, number);
}

/* "0.11 (0 to 0.27)". One end: "0.11 (to 0.27)", "0.11 (0.05 on)". */
static void write_interval(double value, double low, double high, char text[UNCERTAINTY_TEXT]) {
  const double size = fmax(fabs(low), fabs(high));
  double last = last_decade(fmax(high - value, value - low));
  if (fmin(high - value, value - low) < ONE_LEADS * pow(10, last)) /* 0.14 (0 to 1), not 0.1 */
    last--;
  char parts[3][32];
  const double number[3] = {value, low, high};
  const bool large = size >= LARGE && last >= THOUSANDS; /* 3e+07 (0 to 5e+07) */
  const bool short_form = !(last >= -MOST_DECIMALS && last <= MOST_DECIMALS) || size < SMALL || size >= MOST_DIGITS;
  for (int i = 0; i < 3; i++)
    if (short_form)
      snprintf(parts[i], sizeof parts[i], "%.2g", number[i]);
    else
      (large ? write_power : i == 0 ? write_to : write_end)(last, number[i], parts[i]);
  snprintf(text, UNCERTAINTY_TEXT,
           isnan(low)    ? "%s (%sto %s)"
           : isnan(high) ? "%s (%s on)"
                         : "%s (%s to %s)",
           parts[0], isnan(low) ? "" : parts[1], parts[2]);
  text_powers(text, UNCERTAINTY_TEXT);
}

void uncertainty_interval(double value, double low, double high, char text[UNCERTAINTY_TEXT]) {
  const double below = value - low, above = high - value;
  if (isnan(value) || (isnan(low) && isnan(high)))
    write_number(value == rint(value) && fabs(value) < LARGE ? "%.0f" : "%.3g", value, text);
  else if (fabs(above - below) <= 1e-6 * (above + below))
    uncertainty_number(value, (above + below) / 2, text);
  else
    write_interval(value, low, high, text);
}

void uncertainty_cell(double value, double half_width, const struct sample_range *range, char text[UNCERTAINTY_TEXT]) {
  const bool cut = value - half_width < range->least || value + half_width > range->most;
  if (!(half_width > 0) || !cut || !(value >= range->least && value <= range->most))
    uncertainty_number(value, half_width, text);
  else
    write_interval(value, fmax(value - half_width, range->least), fmin(value + half_width, range->most), text);
}

bool uncertainty_all_one(double value, double half_width, double low, const struct sample_range *range,
                         char text[UNCERTAINTY_TEXT]) {
  if (range->most != 1 || !(value >= 1) || !isnan(half_width) || !isfinite(low))
    return false;
  snprintf(text, UNCERTAINTY_TEXT, "%.3f \xe2\x89\xa5 %.3f", value, low);
  return true;
}

void uncertainty_excluded(int64_t count, const char *store) {
  char word[TEXT_WORD];
  if (count > 0)
    fprintf(stderr, "clast: %" PRId64 " run%s excluded and left out (`clast exclude %s` lists %s)\n", count,
            count == 1 ? " is" : "s are", text_word(store, word), count == 1 ? "it" : "them");
}

void uncertainty_missing(int64_t missing, int64_t wanted, const char *store) {
  char word[TEXT_WORD], of[32] = "";
  if (wanted > 0)
    snprintf(of, sizeof of, " of %" PRId64, wanted);
  if (missing > 0)
    words_print(stderr, "",
                "clast: %" PRId64 "%s run%s gave no result (`clast query %s --named failures`): if they fail for a "
                "reason that depends on the result, means are biased",
                missing, of, missing == 1 && !*of ? "" : "s", text_word(store, word));
}

void uncertainty_namesakes(const char *numbers, const char *campaign, const char *path) {
  char word[TEXT_WORD];
  if (*numbers)
    fprintf(stderr, "clast: campaigns %s of %s are called %s: `%s --campaign %.*s` takes one alone\n", numbers, path,
            campaign, text_word(path, word), (int)strcspn(numbers, ","), numbers);
}

void uncertainty_left_out(int64_t points) {
  if (points > 0)
    fprintf(stderr,
            "clast: left out: %" PRId64 " point%s that only studies and searches have; --studies counts %s, --campaign "
            "NAME takes those of one (`clast status` lists them)\n",
            points, points == 1 ? "" : "s", points == 1 ? "it" : "them");
}

void uncertainty_seeds(const struct sample_summary *mean, char text[UNCERTAINTY_TEXT]) {
  const double half_width = mean->half_width;
  const char *weak = mean->weak ? ", weak" : "";
  if (!isfinite(half_width)) {
    snprintf(text, UNCERTAINTY_TEXT, "%.4g", mean->mean);
    if (isfinite(mean->low))
      text_append(text, UNCERTAINTY_TEXT, " (all %zu runs; %.3g to %.3g)", mean->n, mean->low, mean->high);
    return;
  }
  if (mean->high > mean->low && (mean->low > mean->mean - half_width || mean->high < mean->mean + half_width)) {
    uncertainty_cell(mean->mean, half_width, &(struct sample_range){mean->low, mean->high, false}, text);
    char *end = strchr(text, ')');
    if (end) {
      *end = '\0';
      text_append(text, UNCERTAINTY_TEXT, "; seeds, 95 %%%s)", weak);
      return;
    }
  }
  uncertainty_number(mean->mean, half_width, text);
  text_append(text, UNCERTAINTY_TEXT, " (seeds, 95 %%%s)", weak);
}

void uncertainty_resolution(const struct ask_resolution *resolution, char text[UNCERTAINTY_TEXT]) {
  char converge[sizeof resolution->command + 40] = "`clast converge` with a campaign's file";
  if (*resolution->command)
    snprintf(converge, sizeof converge, "`clast converge %s`", resolution->command);
  text[0] = '\0';
  switch (resolution->verdict) {
  case ASK_RESOLUTION_NOT_STUDIED:
    snprintf(text, UNCERTAINTY_TEXT, "resolution: not studied; %s measures it", converge);
    return;
  case ASK_RESOLUTION_DIVERGES:
    if (resolution->diverging >= resolution->points) {
      snprintf(text, UNCERTAINTY_TEXT, "resolution: does not converge (%s)", converge);
      return;
    }
    text_append(text, UNCERTAINTY_TEXT, "resolution: does not converge at %" PRId64 " of %" PRId64 " points",
                resolution->diverging, resolution->points);
    if (resolution->at_least)
      text_append(text, UNCERTAINTY_TEXT, ", no limit is seen at %" PRId64, resolution->at_least);
    if (resolution->studied > resolution->diverging)
      text_append(text, UNCERTAINTY_TEXT, "; the largest error of the others is %s%.2g (%s)",
                  resolution->at_least ? "at least " : "", resolution->half_width, resolution->knobs);
    break;
  case ASK_RESOLUTION_NO_DIFFERENCE:
    text_append(text, UNCERTAINTY_TEXT, "no difference seen (resolution: %s)", resolution->knobs);
    break;
  case ASK_RESOLUTION_KNOWN:
    text_append(text, UNCERTAINTY_TEXT, "%s\xc2\xb1 %.2g (resolution: %s)", resolution->points > 1 ? "up to " : "",
                resolution->half_width, resolution->knobs);
    break;
  case ASK_RESOLUTION_AT_LEAST:
    if (resolution->points <= 1) {
      text_append(text, UNCERTAINTY_TEXT, ">= %.2g (resolution: %s)", resolution->half_width, resolution->knobs);
      break;
    }
    text_append(text, UNCERTAINTY_TEXT,
                "no limit is seen at %" PRId64 " of %" PRId64
                " points; the largest error is at least %.2g (resolution: "
                "%s)",
                resolution->at_least, resolution->points, resolution->half_width, resolution->knobs);
  }
  if (resolution->studied < resolution->points)
    text_append(text, UNCERTAINTY_TEXT, "; studied at %" PRId64 " of %" PRId64 " points, %s studies others",
                resolution->studied, resolution->points, converge);
}

void uncertainty_resolution_cell(enum ask_resolution_verdict verdict, double half_width, char text[UNCERTAINTY_TEXT]) {
  switch (verdict) {
  case ASK_RESOLUTION_KNOWN: snprintf(text, UNCERTAINTY_TEXT, "%.2g", half_width); return;
  case ASK_RESOLUTION_NO_DIFFERENCE: snprintf(text, UNCERTAINTY_TEXT, "none seen"); return;
  case ASK_RESOLUTION_AT_LEAST:
  case ASK_RESOLUTION_DIVERGES: snprintf(text, UNCERTAINTY_TEXT, ">= %.2g", half_width); return;
  case ASK_RESOLUTION_NOT_STUDIED: snprintf(text, UNCERTAINTY_TEXT, "not studied"); return;
  }
}

void uncertainty_mark(const struct ask_doubts *doubts, char text[UNCERTAINTY_TEXT]) {
  const int64_t values = (int64_t)((uint64_t)doubts->runs - (uint64_t)doubts->withheld); /* of any store */
  text[0] = 0;
  if (doubts->withheld > 0)
    snprintf(text, UNCERTAINTY_TEXT, " (%" PRId64 ")", values);
  if (doubts->doubtful > 0)
    text_append(text, UNCERTAINTY_TEXT, UNCERTAINTY_MARK);
}

void uncertainty_doubts(const struct ask_doubts *doubts, FILE *out) {
  for (size_t k = 0; k < sizeof doubts->absent / sizeof *doubts->absent; k++)
    if (doubts->absent[k].runs > 0)
      fprintf(out,
              "clast: %s: %" PRId64 " of %" PRId64
              " runs have no value and are not in its numbers (`clast explain %s`)\n",
              doubts->absent[k].name, doubts->absent[k].runs, doubts->absent[k].of, doubts->absent[k].name);
  for (size_t k = 0; k < doubts->count; k++) {
    const struct ask_doubt *doubt = &doubts->word[k];
    fprintf(out, "clast: %s, %" PRId64 " of %" PRId64 " runs: %s: ",
            doubt->row && doubt->row->withheld ? "withheld" : "marked (!)", doubt->runs, doubts->runs, doubt->word);
    if (doubt->row)
      condition_sentence(doubt->row, out);
    else
      fputs("a word of another version of clast\n", out);
  }
}

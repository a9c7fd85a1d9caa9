/* The table of settings and seeds that reach an accuracy. */
#include "campaign/converge/accuracy_print.h"

#include <stdio.h>

#include "campaign/converge/accuracy.h"
#include "campaign/terminal/table.h"
#include "schemas/text.h"

/* One row per way to run the campaign: cost of a point against that of the most accurate one. */
static status print_alternatives(const struct accuracy *accuracy, enum table_format format, FILE *out,
                                 struct error *error) {
  const struct accuracy_option *reference = &accuracy->options[accuracy->reference];
  struct table *table = table_new(format, out);
  table_columns(table, (const char *const[]){"choice", "knob", "setting", "error", "known", "seeds", NULL});
  table_column(table, "run_cpu", "s");
  table_column(table, "point_cpu", "s");
  table_column(table, "run_cost", NULL);
  for (size_t i = 0; i < accuracy->count; i++) {
    const struct accuracy_option *option = &accuracy->options[i];
    table_text(table, i == accuracy->chosen ? "chosen" : "");
    table_text(table, option->own ? "" : option->knob);
    table_text(table, option->own ? "the scene's own" : option->setting);
    table_real(table, option->error);
    table_text(table, option->open ? "at least" : "yes");
    if (option->seeds)
      table_integer(table, option->seeds);
    else
      table_missing(table);
    table_real(table, option->run_s);
    table_real(table, option->cpu_s);
    table_real(table, option->run_s / reference->run_s);
  }
  return table_end(table, error);
}

static status alternatives_json(const struct accuracy *accuracy, char **text, struct error *error) {
  size_t size = 0;
  FILE *out = text_open(text, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  status code = print_alternatives(accuracy, TABLE_JSON, out, error);
  if (!text_close(out, text) && code == STATUS_OK)
    code = status_fail(error, STATUS_MEMORY, "out of memory");
  return code;
}

status accuracy_print_settle(struct campaign *campaign, const char *path, const char *store, char **json,
                             struct error *error) {
  struct accuracy accuracy;
  if (field_is_off(campaign->accuracy_within))
    return STATUS_OK;
  status code = accuracy_find(campaign, path, store, &accuracy, error);
  if (code != STATUS_OK)
    return code;
  if (json) {
    code = alternatives_json(&accuracy, json, error);
  } else {
    printf("accuracy  %s within %g: error of resolution and 95 %% interval together. run_cost: against the smallest "
           "error\n",
           campaign->accuracy_quantity, campaign->accuracy_within);
    code = print_alternatives(&accuracy, TABLE_TEXT, stdout, error);
    putchar('\n');
  }
  if (code == STATUS_OK)
    code = accuracy_apply(&accuracy, campaign, error);
  accuracy_clear(&accuracy);
  return code;
}

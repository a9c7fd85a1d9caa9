/* Names of quantities that a study knows. */
#include "campaign/converge/study_quantity.h"

#include <stdio.h>

#include "campaign/document/campaign.h"

status study_quantity_find(const struct engine_kind *kind, const char *name, struct study_quantity *quantity,
                           struct error *error) {
  *quantity = (struct study_quantity){0};
  bool exponent;
  TRY(estimates_named(name, &exponent, &quantity->method, &quantity->window, error));

  if (exponent) {
    snprintf(quantity->name, sizeof quantity->name, "%s", estimates_short_name(name));
    snprintf(quantity->column, sizeof quantity->column, "%s", quantity->name);
    return STATUS_OK;
  }
  quantity->row = campaign_quantity(kind, name, &quantity->of_outcome, error);
  if (!quantity->row)
    return STATUS_CONTENT;
  snprintf(quantity->name, sizeof quantity->name, "%s", quantity->row->path);
  field_column_name(quantity->row->path, quantity->column, sizeof quantity->column);
  return STATUS_OK;
}

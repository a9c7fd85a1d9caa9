/* Writes campaigns of lists. JSON values are YAML. */
#include "campaign/document/campaign_write.h"

#include <stdio.h>

#include "schemas/text.h"

static void write_value(const struct field *row, const struct field_value *value, FILE *out) {
  fputc(' ', out);
  if (!field_needs_unit(row)) {
    field_json_value(row, value, out);
    return;
  }
  char text[FIELD_TEXT_SIZE];
  field_print(row, value, text, sizeof text);
  text_json_string(text, out);
}

static void write_set(const struct scene *scene, FILE *out) {
  const char *before = "\nset:";
  for (size_t i = 0; i < scene->kind->inputs->count; i++) {
    const struct field *row = &scene->kind->inputs->rows[i];
    struct field_value value;
    if (!scene->overridden[i])
      continue;
    field_get(row, scene->inputs, &value);
    fprintf(out, "%s\n  %s:", before, row->path);
    write_value(row, &value, out);
    before = "";
  }
}

static void write_axes(const struct campaign *campaign, FILE *out) {
  fputs("\ndesign: list\nvary:", out);
  for (size_t i = 0; i < campaign->axis_count; i++) {
    const struct design_axis *axis = &campaign->axes[i];
    fprintf(out, "\n  %s: [", axis->row->path);
    for (size_t l = 0; l < axis->level_count; l++) {
      fputs(l ? "," : "", out);
      write_value(axis->row, &axis->levels[l], out);
    }
    fputs("]", out);
  }
}

char *campaign_write_list(const struct campaign *campaign, const char *scene_reference, const char *comment) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    return NULL;
  fprintf(out, "# %s\nname: ", comment);
  text_json_string(campaign->name, out);
  fputs("\nscene: ", out);
  text_json_string(scene_reference, out);
  write_set(campaign->scene, out);
  write_axes(campaign, out);
  fprintf(out, "\nquantity: %s\nseeds: {first: %lld, per_point: %lld%s}\nstore: ", campaign->quantity,
          (long long)campaign->first_seed, (long long)campaign->per_point,
          campaign->independent ? ", independent: true" : "");
  text_json_string(campaign->store, out);
  fputs("\n", out);
  return text_close(out, &text);
}

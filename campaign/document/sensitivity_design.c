/* Writes the design for sensitivity indices, and finds it again. */
#include "campaign/document/campaign.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "schemas/file.h"

static status check_axes(const char *path, const struct campaign *campaign, struct error *error) {
  if (campaign->axis_count == 0 || *campaign->design.file)
    return status_fail(error, STATUS_CONTENT, "%s: expected the key vary, with the ranges of the inputs", path);
  for (size_t a = 0; a < campaign->axis_count; a++)
    if (campaign->axes[a].kind == DESIGN_AXIS_LINKED)
      return status_fail(error, STATUS_CONTENT,
                         "%s: vary.%s is linked to another input: it has no index of its own; leave it out or give it "
                         "a range",
                         path, campaign->axes[a].row->path);
  return STATUS_OK;
}

/* The paths of the inputs, and a line for each point. Numbers have their units and read back as the same bits. */
static void write_points(FILE *out, const struct campaign *campaign, const struct design_sensitivity *design) {
  double u[64];
  for (size_t a = 0; a < campaign->axis_count; a++)
    fprintf(out, "%s%s", a ? "," : "", campaign->axes[a].row->path);
  fputc('\n', out);
  for (size_t i = 0; i < design_sensitivity_rows(design); i++) {
    design_sensitivity_row(design, i, u);
    for (size_t a = 0; a < campaign->axis_count; a++) {
      struct field_value value;
      char text[FIELD_TEXT_SIZE];
      design_axis_quantile(&campaign->axes[a], u[a], &value);
      field_print(campaign->axes[a].row, &value, text, sizeof text);
      fprintf(out, "%s%s", a ? "," : "", text);
    }
    fputc('\n', out);
  }
}

/* The document with the name of its file, and so a store of its own, and without its keys `vary` and `design`. Keys
 * begin a line; their values are indented, or on that line. */
static void write_document(FILE *out, const char *text, const char *points) {
  static const char *const keys[] = {"name:", "store:", "vary:", "design:"};
  bool dropped = false;
  char name[LIMITS_PATH];
  snprintf(name, sizeof name, "%.*s", (int)(strlen(points) - strlen(".csv")), points);
  fputs("name: ", out);
  text_json_string(name, out);
  fputc('\n', out);
  while (*text) {
    const size_t length = strcspn(text, "\n") + (strchr(text, '\n') != NULL);
    if (!strchr(" \t\r\n#-}", *text)) {
      dropped = false;
      for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        dropped = dropped || strncmp(text, keys[k], strlen(keys[k])) == 0;
    }
    if (!dropped)
      fwrite(text, 1, length, out);
    text += length;
  }
  fputs("design: {file: ", out);
  text_json_string(points, out);
  fputs("}\n", out);
}

/* Begins a file that must not exist. */
static status begin(struct file_output *file, const char *path, const char *what, struct error *error) {
  if (access(path, F_OK) == 0)
    return status_fail(error, STATUS_USAGE, "%s exists already: name another file", path);
  return file_begin(file, path, what, error);
}

static status write_files(const struct campaign *campaign, const struct design_sensitivity *design,
                          const char *document, const char *points, struct error *error) {
  struct file_output text, rows;
  const char *folder = strrchr(points, '/');
  TRY(begin(&text, document, "campaign", error));
  status code = begin(&rows, points, "points", error);
  if (code == STATUS_OK) {
    write_points(rows.out, campaign, design);
    code = file_end(&rows, code, error);
  }
  write_document(text.out, campaign->text, folder ? folder + 1 : points);
  const status ended = file_end(&text, code, error);
  if (code == STATUS_OK && ended)
    remove(points);
  return ended;
}

status sensitivity_design_write(const char *path, const char *output, size_t blocks, uint64_t seed,
                                struct error *error) {
  CAMPAIGN campaign = NULL;
  CAMPAIGN written = NULL;
  struct design_sensitivity *design = NULL;
  char points[LIMITS_PATH];
  const size_t length = strlen(output);
  if (length < 6 || strcmp(output + length - 5, ".yaml") != 0 || length >= sizeof points)
    return status_fail(error, STATUS_USAGE, "'%s' is to be written: its name must end in .yaml", output);
  snprintf(points, sizeof points, "%.*s.csv", (int)(length - 5), output);
  TRY(campaign_load(path, &campaign, error));
  TRY(check_axes(path, campaign, error));
  TRY(design_sensitivity_create(campaign->axis_count, blocks, seed, &design, error));
  status code = write_files(campaign, design, output, points, error);
  design_sensitivity_free(design);
  TRY(code);
  code = campaign_load(output, &written, error); /* the file must be the campaign that runs */
  if (code) {
    remove(output);
    remove(points);
  }
  return code;
}

static bool same(const struct campaign *campaign, size_t a, size_t i, size_t j) {
  const struct design_axis *axis = &campaign->axes[a];
  return field_same_value(axis->row, &axis->levels[i], &axis->levels[j]);
}

static bool is_saltelli(const struct campaign *campaign, size_t rows) {
  const size_t n = campaign->axis_count;
  for (size_t i = 0; i < rows; i++) {
    const size_t first = i - i % (n + 2), point = i % (n + 2);
    for (size_t a = 0; point >= 2 && a < n; a++)
      if (!same(campaign, a, i, first + (point == 2 + a)))
        return false;
  }
  return true;
}

status sensitivity_design_find(const struct campaign *campaign, size_t *blocks, struct error *error) {
  const size_t n = campaign->axis_count, rows = *campaign->design.file ? (size_t)campaign->design.points : 0;
  *blocks = rows / (n + 2);
  if (rows > 0 && rows % (n + 2) == 0 && is_saltelli(campaign, rows))
    return STATUS_OK;
  return status_fail(
      error, STATUS_USAGE,
      "the points of this campaign are no design for sensitivity indices: `clast sensitivity "
      "CAMPAIGN.yaml NEW.yaml --design saltelli` writes one, `clast run NEW.yaml` fills its store NEW.db, "
      "and `clast sensitivity NEW.db NEW.yaml` prints them");
}

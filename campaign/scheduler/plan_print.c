/* Prints a plan as text or JSON. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign_warn.h"
#include "campaign/scheduler/plan.h"
#include "campaign/terminal/progress.h"
#include "schemas/text.h"

static const char *bytes(double count, char *buffer, size_t size) {
  static const char *const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  int unit = 0;
  if (isnan(count))
    return "?";
  for (; count >= 999.5 && unit < 5; unit++)
    count /= 1000;
  snprintf(buffer, size, unit ? "%.3g %s" : "%.0f %s", count, units[unit]);
  return buffer;
}

/* Where the times of a run come from. */
static const char *how_timed(const struct plan *plan) {
  if (!plan->trial_made)
    return isnan(plan->run_s_mean) ? " (no trial run)" : " (from runs in the store)";
  if (plan->trial_finished)
    return " (whole runs timed)";
  if (plan->trial_whole)
    return " (the first steps timed; a coarse run tells when it ends)";
  return " (extrapolated to the hard end; runs stop earlier when fracture has ceased)";
}

static void print_design(const struct campaign *campaign, const struct plan *plan, FILE *out) {
  static FIELD_WORDS(designs,
                     CAMPAIGN_DESIGNS, [CAMPAIGN_GRID] = "grid", [CAMPAIGN_LIST] = "list", [CAMPAIGN_RANDOM] = "random",
                     [CAMPAIGN_LATIN_HYPERCUBE] = "latin hypercube", [CAMPAIGN_SOBOL] = "Sobol");
  fprintf(out, "campaign  %s, scene %s\n", campaign->name, campaign->scene_reference);
  fprintf(out, "design    %s, %llu point%s", designs[campaign->design.kind], (unsigned long long)plan->points,
          plan->points == 1 ? "" : "s");
  for (size_t i = 0; i < campaign->axis_count; i++) {
    fprintf(out, "\n%-8s  %s: ", i ? "" : "over", campaign->axes[i].row->path);
    design_axis_describe(campaign->axes, i, out);
  }
  fputc('\n', out);
}

static void print_runs(const struct campaign *campaign, const struct plan *plan, FILE *out) {
  fprintf(out, "runs      %llu", (unsigned long long)plan->runs_least);
  if (plan->runs_most != plan->runs_least)
    fprintf(out, " to %llu (%s to ±%g)", (unsigned long long)plan->runs_most, campaign->until_quantity,
            campaign->until_half_width);
  fprintf(out, ", %llu of them in the store%s\n", (unsigned long long)plan->runs_there,
          plan->store_exists ? "" : " (there is none yet)");
}

static void print_times(const struct plan *plan, int slots, FILE *out) {
  char a[64], b[64];
  progress_duration(plan->run_s_mean, a, sizeof a);
  progress_duration(plan->run_s_most, b, sizeof b);
  fprintf(out, "a run     %s%s on average, %s for the most expensive%s\n",
          plan->trial_made && !plan->trial_whole ? "at most " : "", a, b, how_timed(plan));
  progress_duration(plan->wall_s_least, a, sizeof a);
  progress_duration(plan->wall_s_most, b, sizeof b);
  fprintf(out, "time      %s", a);
  if (plan->runs_most != plan->runs_least)
    fprintf(out, " to %s", b);
  progress_duration(plan->cpu_s_most, a, sizeof a);
  fprintf(out, " on %d slot%s", slots, slots == 1 ? "" : "s");
  if (plan->threads > 1)
    fprintf(out, " of %.0f threads", plan->threads);
  fprintf(out, " (%s of processor time)\n", a);
}

static void print_bytes(const struct campaign *campaign, const struct plan *plan, int slots, FILE *out) {
  char a[64], b[64];
  fprintf(out, "memory    %s per run, %s on all slots\n", bytes(plan->memory_most, a, sizeof a),
          bytes(plan->memory_most * slots, b, sizeof b));
  fprintf(out, "disk      %s for the store %s", bytes(plan->disk_bytes, a, sizeof a), campaign->store);
  if (campaign->keep != CAMPAIGN_KEEP_NONE)
    fprintf(out, ", at most %s for fields", bytes(plan->fields_bytes, b, sizeof b));
  fputc('\n', out);
}

void plan_print(const struct campaign *campaign, const struct plan *plan, int slots, FILE *out) {
  print_design(campaign, plan, out);
  campaign_warn(campaign, "warning   ", out);
  print_runs(campaign, plan, out);
  print_times(plan, slots, out);
  print_bytes(campaign, plan, slots, out);
  if (plan->points_looked_at < plan->points)
    fprintf(out, "          (averages over %llu of the points)\n", (unsigned long long)plan->points_looked_at);
  if (plan->model)
    fprintf(out, "\n%s%s", plan->model, plan->model[0] && plan->model[strlen(plan->model) - 1] == '\n' ? "" : "\n");
}

static void number(FILE *out, const char *name, double value) {
  if (isfinite(value))
    fprintf(out, ", \"%s\": %.17g", name, value);
  else
    fprintf(out, ", \"%s\": null", name);
}

static void axis_json(const struct campaign *campaign, size_t index, FILE *out) {
  char *values = NULL;
  size_t size = 0;
  FILE *text = text_open(&values, &size);
  if (!text)
    return;
  design_axis_describe(campaign->axes, index, text);
  const struct field *row = campaign->axes[index].row;
  fputs(index ? ", {\"path\": " : "{\"path\": ", out);
  text_json_string(row->path, out);
  fputs(", \"unit\": ", out);
  text_json_string(row->unit ? row->unit : "", out);
  fputs(", \"values\": ", out);
  text_json_string(text_close(text, &values) ? values : "", out);
  fputc('}', out);
  free(values);
}

char *plan_print_json(const struct campaign *campaign, const struct plan *plan, int slots) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    return NULL;
  fputs("{\"campaign\": ", out);
  text_json_string(campaign->name, out);
  fputs(", \"scene\": ", out);
  text_json_string(campaign->scene_reference, out);
  fputs(", \"store\": ", out);
  text_json_string(campaign->store, out);
  fputs(", \"axes\": [", out);
  for (size_t i = 0; i < campaign->axis_count; i++)
    axis_json(campaign, i, out);
  fprintf(out,
          "], \"points\": %llu, \"points_looked_at\": %llu, \"runs_least\": %llu, \"runs_most\": %llu, \"runs_there\": "
          "%llu",
          (unsigned long long)plan->points, (unsigned long long)plan->points_looked_at,
          (unsigned long long)plan->runs_least, (unsigned long long)plan->runs_most,
          (unsigned long long)plan->runs_there);
  fprintf(out, ", \"store_exists\": %s, \"trial_made\": %s, \"trial_finished\": %s, \"slots\": %d",
          plan->store_exists ? "true" : "false", plan->trial_made ? "true" : "false",
          plan->trial_finished ? "true" : "false", slots);
  number(out, "run_s_mean", plan->run_s_mean);
  number(out, "run_s_most", plan->run_s_most);
  number(out, "cpu_s_least", plan->cpu_s_least);
  number(out, "cpu_s_most", plan->cpu_s_most);
  number(out, "wall_s_least", plan->wall_s_least);
  number(out, "wall_s_most", plan->wall_s_most);
  number(out, "memory_most_bytes", plan->memory_most);
  number(out, "disk_bytes", plan->disk_bytes);
  number(out, "fields_bytes", plan->fields_bytes);
  if (plan->alternatives)
    fprintf(out, ", \"alternatives\": %s", plan->alternatives);
  fputs(", \"model\": ", out);
  text_json_string(plan->model ? plan->model : "", out);
  fputs("}\n", out);
  return text_close(out, &text);
}

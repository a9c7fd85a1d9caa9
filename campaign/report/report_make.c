/* Makes the content of a page: the stores' data, the names of their columns, and pictures of runs whose fields are
 * kept. */
#include "campaign/report/report_make.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "analysis/report/page.h"
#include "campaign/build_facts.h"
#include "campaign/charts/charts.h"
#include "db/ask/ask.h"
#include "engine/outcome.h"
#include "schemas/file.h"
#include "schemas/limits.h"
#include "schemas/memory.h"

enum { PICTURES = 24, PICTURE_WIDTH = 400, PICTURE_BYTES = 330000 /* most pictures of one page */ };

struct making {
  const struct report_choice *choice;
  struct store *store;
  struct ask_page *page;
  size_t picture_bytes, not_drawn;
};

static status add_facts(struct making *making, const char *name, struct error *error) {
  char now[32], refresh[32];
  const time_t seconds = time(NULL);
  strftime(now, sizeof now, "%Y-%m-%d %H:%M:%S UTC", gmtime(&seconds));
  snprintf(refresh, sizeof refresh, "%lld", (long long)making->choice->refresh);
  const char *facts[][2] = {{"store", name},
                            {"made_at", now},
                            {"program", "clast " BUILD_VERSION ", commit " BUILD_COMMIT},
                            {"default_quantity", OUTCOME_DEFAULT},
                            {"refresh", refresh}};
  for (size_t i = 0; i < sizeof facts / sizeof facts[0]; i++)
    TRY(ask_page_fact(making->page, facts[i][0], facts[i][1], error));
  return STATUS_OK;
}

static status add_label(struct making *making, const char *column, struct error *error) {
  struct ask_column written;
  char label[CHARTS_LABEL], unit[96];
  TRY(ask_columns_written(making->store, column, &written, error));
  charts_label(column, label);
  field_label_unit(written.unit, unit, sizeof unit);
  return ask_page_label(making->page, column, label, unit, written.factor, error);
}

/* The main results less those of the first store, as `clast compare` has them. Stores without common points have no
 * differences. */
static status add_differences(struct making *making, const char *name, struct error *error) {
  const char *first = making->choice->stores[0];
  for (size_t i = 0; name != first && outcome_main(i); i++) {
    ASK_PAIRS pairs = NULL;
    const char *quantity = outcome_main(i)->path;
    const status code = ask_pairs_read(first, name, quantity, &pairs, error);
    if (code)
      return code == STATUS_USAGE ? STATUS_OK : code;
    for (struct ask_pairs_row row; ask_pairs_next(pairs, &row);)
      TRY(ask_page_difference(making->page, quantity, row.point[0], row.point[1], &row.difference, error));
    TRY(ask_pairs_end(pairs, error));
  }
  return STATUS_OK;
}

/* Draws into a file beside the page. For a missing or damaged fields file the page reports that there is no picture. */
static status add_picture(struct making *making, const struct answer *kept, struct error *error) {
  OWNED unsigned char *png = NULL;
  size_t size = 0;
  char path[LIMITS_PATH];
  if (making->picture_bytes >= PICTURE_BYTES)
    return STATUS_OK;
  snprintf(path, sizeof path, "%s.%ld.png", making->choice->output, (long)getpid());
  OWNED char *fields = ask_run_fields(kept, 3);
  if (!fields)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  status code = picture_draw(fields, path, &(struct picture_choice){.width = PICTURE_WIDTH}, NULL);
  if (code) {
    making->not_drawn++;
    return STATUS_OK;
  }
  code = file_read(path, "picture", &png, &size, error);
  unlink(path);
  if (code || making->picture_bytes + size > PICTURE_BYTES)
    return code;
  making->picture_bytes += size;
  return ask_page_picture(making->page, kept, png, size, error);
}

static status fill_page(struct making *making, const char *name, struct page_data *data, struct error *error) {
  char not_drawn[32];
  TRY(add_facts(making, name, error));
  ANSWER columns = ask_page_columns(making->page, error);
  while (answer_next(&columns))
    TRY(add_label(making, answer_text(&columns, 0), error));
  TRY(answer_end(&columns));
  TRY(add_differences(making, name, error));
  ANSWER kept = ask_page_kept(making->store, PICTURES, error);
  while (answer_next(&kept))
    TRY(add_picture(making, &kept, error));
  TRY(answer_end(&kept));
  snprintf(not_drawn, sizeof not_drawn, "%zu", making->not_drawn);
  TRY(ask_page_fact(making->page, "pictures_not_drawn", not_drawn, error));
  return ask_page_file(making->page, &data->bytes, &data->size, error);
}

static status add_store(const struct report_choice *choice, const char *name, struct page_data *data,
                        struct error *error) {
  STORE store = NULL;
  TRY(store_open_reader(name, &store, error));
  struct making making = {.choice = choice, .store = store};
  status code = ask_page_make(store, &making.page, error);
  if (code == STATUS_OK)
    code = fill_page(&making, name, data, error);
  ask_page_free(making.page);
  return code;
}

status report_make(const struct report_choice *choice, size_t *size, struct error *error) {
  struct page_data data[REPORT_STORES] = {{0}};
  OWNED unsigned char *html = NULL;
  size_t html_size = 0;
  status code = page_empty(&html, &html_size, error);
  for (size_t i = 0; code == STATUS_OK && i < choice->count; i++)
    code = add_store(choice, choice->stores[i], &data[i], error);
  if (code == STATUS_OK)
    code = page_write(choice->output, html, html_size, choice->count, data, size, error);
  for (size_t i = 0; i < choice->count; i++)
    free(data[i].bytes);
  return code;
}

bool report_make_running(const struct report_choice *choice) {
  bool running = false;
  for (size_t i = 0; i < choice->count; i++)
    running = running || store_is_being_written(choice->stores[i]);
  return running;
}

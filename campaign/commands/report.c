/* `clast report STORE...`: a page for a browser, in one file: the stores' data, the names of their columns, and
 * pictures of runs whose fields are kept. */
#include <time.h>
#include <unistd.h>

#include "analysis/report/page.h"
#include "campaign/build_facts.h"
#include "campaign/commands/commands.h"
#include "schemas/file.h"

enum { STORES = 8, EVERY_MOST = 86400 };
enum { PICTURES = 24, PICTURE_WIDTH = 400, PICTURE_BYTES = 330000 /* most pictures of one page */ };

struct options {
  const char *output;
  bool watch;
  int64_t every;
};

struct report_choice {
  size_t count;        /* paths of stores, at most STORES */
  char *const *stores; /* operands: ask_choose_operand() */
  const char *output;
  struct ask_choice runs; /* of each store */
  int64_t refresh;        /* s, after which an open page loads itself again; 0: never */
};

struct making {
  const struct report_choice *choice;
  const struct ask_choice *runs; /* of this store */
  struct store *store;
  struct ask_column input[LIMITS_AXES_OF_TABLE]; /* read_inputs() */
  size_t input_count;
  struct ask_page *page;
  size_t tried, picture_bytes, left_out, not_drawn; /* of pictures */
  char left_out_of[80];                             /* numbers of runs */
  bool full;                                        /* the next picture would be too much */
};

static status add_facts(struct making *making, const char *name, const char *path, struct error *error) {
  char now[32], refresh[32], name_of_main[ASK_GROUP_NAME];
  const char *quantity = NULL;
  TRY(ask_quantity_main(making->store, name_of_main, &quantity, error));
  const time_t seconds = time(NULL);
  strftime(now, sizeof now, "%Y-%m-%d %H:%M:%S UTC", gmtime(&seconds));
  snprintf(refresh, sizeof refresh, "%lld", (long long)making->choice->refresh);
  char kg[64];
  TRY(ask_columns_unit(making->store, OUTCOME_NAME(mean_fragment_mass), kg, sizeof kg, error));
  const char *facts[][2] = {{"store", name},
                            {"file", path},
                            {"mass_unit", *kg ? kg : "kg or kg/m"},
                            {"made_at", now},
                            {"program", "clast " BUILD_VERSION ", commit " BUILD_COMMIT},
                            {"default_quantity", quantity},
                            {"pictures_by", OUTCOME_DEFAULT},
                            {"refresh", refresh},
                            {"chosen", ask_chosen(making->store)},
                            {"campaign", making->runs->campaign},
                            {"where", making->runs->where},
                            {"studies", making->runs->campaigns_alone ? NULL : "1"}};
  for (size_t i = 0; i < sizeof facts / sizeof facts[0]; i++)
    TRY(ask_page_fact(making->page, facts[i][0], facts[i][1], error));
  return STATUS_OK;
}

static status add_count(struct making *making, const char *name, size_t count, struct error *error) {
  char text[32];
  snprintf(text, sizeof text, "%zu", count);
  return ask_page_fact(making->page, name, text, error);
}

static status add_label(struct making *making, const char *column, struct error *error) {
  struct ask_column written;
  char label[CHARTS_LABEL], unit[96];
  TRY(ask_columns_written(making->store, column, &written, error));
  charts_label(column, label);
  field_label_unit(written.unit, unit, sizeof unit);
  return ask_page_label(making->page, column, label, unit, written.factor, error);
}

/* How the store differs from the first one: inputs that none varies, or why there is no pair of points. */
static status add_apart(struct making *making, const struct ask_pairs *pairs, struct error *error) {
  OWNED char *apart = NULL;
  struct error no_pair;
  TRY(ask_pairs_apart(pairs, &apart, error));
  TRY(ask_page_fact(making->page, "apart", apart, error));
  return ask_pairs_end(pairs, &no_pair) ? ask_page_fact(making->page, "no_pair", no_pair.message, error) : STATUS_OK;
}

/* The main results less those of the first store, as `clast compare` has them. Stores without common points have no
 * differences. */
static status add_differences(struct making *making, const char *name, struct error *error) {
  const char *first = making->choice->stores[0];
  bool told = false;
  for (size_t i = 0; name != first && outcome_main(i); i++) {
    ASK_PAIRS pairs = NULL;
    const char *quantity = outcome_main(i)->path;
    const status code = ask_pairs_read(first, name, quantity, &making->choice->runs, &pairs, error);
    if (code && code != STATUS_USAGE)
      return code;
    if (code)
      continue; /* no run has a value */
    for (struct ask_pairs_row row; ask_pairs_next(pairs, &row);)
      TRY(ask_page_difference(making->page, quantity, row.point[0], row.point[1], &row.difference, error));
    if (!told)
      TRY(add_apart(making, pairs, error));
    told = true;
  }
  return STATUS_OK;
}

static void leave_out(struct making *making, const struct answer *kept) {
  enum { NAMED = 5 };
  if (making->left_out < NAMED)
    text_append(making->left_out_of, sizeof making->left_out_of, "%s%lld", making->left_out ? ", " : "",
                (long long)answer_integer(kept, 0));
  if (making->left_out++ == NAMED)
    text_append(making->left_out_of, sizeof making->left_out_of, ", ...");
}

/* Draws into a file beside the page. For a missing or damaged fields file the page reports that there is no picture. */
static status add_picture(struct making *making, const struct answer *kept, struct error *error) {
  OWNED unsigned char *png = NULL;
  size_t size = 0;
  char path[LIMITS_PATH];
  if (making->full || making->tried == PICTURES) {
    leave_out(making, kept);
    return STATUS_OK;
  }
  making->tried++;
  snprintf(path, sizeof path, "%s.%ld.png", making->choice->output, (long)getpid());
  OWNED char *fields = ask_run_fields(kept, 3);
  if (!fields)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  status code = picture_draw(fields, path, &(struct picture_choice){.width = PICTURE_WIDTH, .quiet = true}, NULL);
  if (code) {
    making->not_drawn++;
    return STATUS_OK;
  }
  code = file_read(path, "picture", &png, &size, error);
  unlink(path);
  making->full = making->picture_bytes + size > PICTURE_BYTES;
  if (making->full)
    leave_out(making, kept);
  if (code || making->full)
    return code;
  making->picture_bytes += size;
  return ask_page_picture(making->page, kept, png, size, error);
}

static status fill_page(struct making *making, const char *name, const char *path, struct page_data *data,
                        struct error *error) {
  TRY(add_facts(making, name, path, error));
  for (size_t i = 0; i < making->input_count; i++)
    TRY(add_label(making, making->input[i].name, error));
  if (making->input_count)
    TRY(ask_page_fixed(making->page, making->store, making->input_count, making->input, error));
  ANSWER columns = ask_page_columns(making->page, error);
  while (answer_next(&columns))
    TRY(add_label(making, answer_text(&columns, 0), error));
  TRY(answer_end(&columns));
  TRY(add_differences(making, name, error));
  ANSWER kept = ask_page_kept(making->store, error);
  while (answer_next(&kept))
    TRY(add_picture(making, &kept, error));
  TRY(answer_end(&kept));
  char room[64];
  snprintf(room, sizeof room, "a page has at most %d pictures and %d kB of them", PICTURES, PICTURE_BYTES / 1000);
  TRY(add_count(making, "pictures_left_out", making->left_out, error));
  TRY(ask_page_fact(making->page, "pictures_left_out_of", making->left_out_of, error));
  TRY(ask_page_fact(making->page, "pictures_room", room, error));
  TRY(add_count(making, "pictures_not_drawn", making->not_drawn, error));
  return ask_page_file(making->page, &data->bytes, &data->size, error);
}

/* STORE:POINT and STORE:CAMPAIGN of a page with others: the inputs that tell the points of the whole file apart, as two
 * parts may differ in an input that neither varies. */
static status read_inputs(struct making *making, struct error *error) {
  const struct ask_choice *part = making->runs;
  if (making->choice->count == 1 || (part->point == 0 && !part->campaign))
    return STATUS_OK;
  TRY(ask_choose(making->store, &(struct ask_choice){.campaigns_alone = part->campaigns_alone, .axes = true}, error));
  return ask_columns_axes(making->store, false, LIMITS_AXES_OF_TABLE, making->input, &making->input_count, error);
}

static status add_store(const struct report_choice *choice, const char *name, struct page_data *data,
                        struct error *error) {
  STORE store = NULL;
  int64_t excluded = 0, missing, wanted;
  char path[LIMITS_PATH];
  struct ask_choice runs = choice->runs;
  ask_choose_operand(name, path, sizeof path, &runs);
  TRY(store_open_reader(path, &store, error));
  struct making making = {.choice = choice, .runs = &runs, .store = store};
  TRY(read_inputs(&making, error));
  TRY(ask_choose(store, &runs, error));
  TRY(ask_choose_estimates(store, error));
  TRY(ask_run_excluded_count(store, &excluded, error));
  TRY(ask_run_missing(store, &missing, &wanted, error));
  char numbers[ASK_CAMPAIGN_NUMBERS] = "";
  if (runs.campaign)
    TRY(ask_campaign_namesakes(store, runs.campaign, numbers, sizeof numbers, error));
  uncertainty_namesakes(numbers, runs.campaign, path);
  uncertainty_excluded(excluded, path);
  uncertainty_missing(missing, wanted, path);
  uncertainty_left_out(ask_choice_left_out(store));
  status code = ask_page_make(store, &making.page, error);
  if (code == STATUS_OK)
    code = fill_page(&making, name, path, data, error);
  ask_page_free(making.page);
  return code;
}

/* A number for the store, and the part of it, that an operand names. A store beside or below the page has its path from
 * there, so that both can move. */
static uint64_t number_of(const char *operand, const char *page) {
  char store[LIMITS_PATH];
  ask_choose_operand(operand, store, sizeof store, &(struct ask_choice){0});
  const char *slash = strrchr(page, '/'), *part = operand + strnlen(store, strlen(operand));
  OWNED char *folder = slash ? strndup(page, (size_t)(slash - page) + 1) : strdup(".");
  OWNED char *there = folder ? realpath(folder, NULL) : NULL;
  OWNED char *real = realpath(store, NULL);
  const char *path = real ? real : store;
  const size_t length = there ? strlen(there) : 0;
  if (length > 0 && strncmp(path, there, length) == 0 && path[length] == '/')
    path += length + 1;
  return text_hash(text_hash(TEXT_HASH_START, path, strlen(path) + 1), part, strlen(part));
}

/* Makes the page. *size: its bytes. */
static status make(const struct report_choice *choice, size_t *size, struct error *error) {
  struct page_data data[STORES] = {{0}};
  OWNED unsigned char *html = NULL;
  size_t html_size = 0;
  status code = page_empty(&html, &html_size, error);
  for (size_t i = 0; code == STATUS_OK && i < choice->count; i++)
    code = add_store(choice, choice->stores[i], &data[i], error);
  if (code == STATUS_OK)
    code = page_write(choice->output, html, html_size, number_of(choice->stores[0], choice->output), choice->count,
                      data, size, error);
  for (size_t i = 0; i < choice->count; i++)
    free(data[i].bytes);
  return code;
}

/* True while a campaign writes one of the stores. */
static bool is_running(const struct report_choice *choice) {
  bool running = false;
  for (size_t i = 0; i < choice->count; i++) {
    char path[LIMITS_PATH];
    ask_choose_operand(choice->stores[i], path, sizeof path, &(struct ask_choice){0});
    running = running || store_is_being_written(path);
  }
  return running;
}

/* demo.html in the current folder for the store folder/demo.db, demo@1.html for folder/demo.db:1: demo-1.html is the
 * page of demo-1.db. */
static void name_page(const char *operand, char *name, size_t size) {
  char store[LIMITS_PATH];
  ask_choose_operand(operand, store, sizeof store, &(struct ask_choice){0});
  const char *slash = strrchr(store, '/'), *base = slash ? slash + 1 : store;
  const char *dot = strrchr(base, '.'), *part = operand + strnlen(store, strlen(operand));
  snprintf(name, size, "%.*s%s%s.html", (int)(dot && dot > base ? (size_t)(dot - base) : strlen(base)), base,
           *part ? "@" : "", *part ? part + 1 : "");
  for (char *at = name; (at = strchr(at, '/'));)
    *at = '-'; /* in the name of a campaign */
}

/* Makes the page again and again while a campaign writes one of the stores, and once more at its end. */
static status watch(struct report_choice *choice, int64_t every, size_t *size, struct error *error) {
  bool running;
  do {
    running = is_running(choice);
    choice->refresh = running ? every : 0;
    TRY(make(choice, size, error));
    if (running) {
      fprintf(stderr, "%s written; again in %lld s, while the campaign runs\n", choice->output, (long long)every);
      sleep((unsigned)every);
    }
  } while (running);
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char name[LIMITS_PATH];
  size_t size = 0;
  if (line->count > STORES)
    return status_fail(error, STATUS_USAGE, "a page shows at most %d stores", STORES);
  const char *dot = options->output ? strrchr(options->output, '.') : ".html";
  if (options->output && strncmp(options->output, "/dev/", 5) == 0)
    dot = ".html";
  if (!dot || (strcasecmp(dot, ".html") != 0 && strcasecmp(dot, ".htm") != 0))
    return status_fail(error, STATUS_USAGE, "%s: the page is HTML, which a browser can print: name it PAGE.html",
                       options->output);
  name_page(line->arguments[0], name, sizeof name);
  struct report_choice choice = {.runs = line->choice,
                                 .count = line->count,
                                 .stores = line->arguments,
                                 .output = options->output ? options->output : name};
  if (!options->output && page_is_of_other(name, number_of(line->arguments[0], name)))
    return status_fail(error, STATUS_IO, "%s is the page of another store: name this one with -o", name);
  if (!options->output)
    TRY(file_claim(name, "page", error));
  const status code = options->watch ? watch(&choice, options->every, &size, error) : make(&choice, &size, error);
  if (code == STATUS_OK)
    fprintf(stderr, "%s written (%.2f MB); open it in a browser\n", choice.output, 1e-6 * (double)size);
  return code;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_OUTPUT(OPTION_OUTPUT, "output", 'o', "PAGE.html", struct options, output),
    OPTION_ROW_FLAG("watch", 0, struct options, watch),
    OPTION_ROW_INTEGER("every", 0, "S", struct options, every, 1, EVERY_MOST, "10"),
};

COMMAND(report, "results", "STORE...", .chooses_runs = true, COMMAND_OPTIONS(struct options, option_rows), .run = run);

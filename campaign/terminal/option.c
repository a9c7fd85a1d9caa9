/* Parses the command line by getopt_long. */
#include "campaign/terminal/option.h"

#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture_canvas.h"
#include "schemas/file.h"

enum { HELP_VALUE = 1000, ROW_VALUE = 1001, WORD_MAXIMUM = 63 };

/* Options of several commands, whose values are in struct command_line. */
struct shared_options {
  struct ask_choice choice;
  bool studies, json, csv, all, allow_commands;
};
static const struct option_row choice_rows[] = {
    OPTION_ROW_INTEGER("point", 'p', "N", struct shared_options, choice.point, 0, INT64_MAX, "0",
                       .doc = "Only this point (point_id in the view points); 0: all."),
    OPTION_ROW_TEXT("campaign", 0, "CAMPAIGN", struct shared_options, choice.campaign, NULL,
                    .doc = "Only the points of this campaign, with all their runs, also those that other campaigns "
                           "computed: its number or its name (`clast status` lists them)."),
    OPTION_ROW_TEXT("where", 'w', "SQL", struct shared_options, choice.where, NULL,
                    .doc = "Only runs that meet this SQL condition on the view runs, in SI units: \"strain > 0.02\"."),
    OPTION_ROW_FLAG("studies", 0, struct shared_options, studies,
                    .doc = "Also the points that only a study or a search (converge, find, fit) has."),
};
static const struct option_row table_rows[] = {
    OPTION_ROW_FLAG("json", 0, struct shared_options, json, .doc = "Print JSON: one array of objects, SI units."),
    OPTION_ROW_FLAG("csv", 0, struct shared_options, csv,
                    .doc = "Print CSV with a header line, SI units; lines end with LF."),
    OPTION_ROW_FLAG("all", 'a', struct shared_options, all,
                    .doc = "Print all columns or lines, also those that are rarely wanted."),
};

static const struct option_row allow_row = OPTION_ROW_FLAG(
    "allow-commands", 0, struct shared_options, allow_commands,
    .doc = "Let a scene of engine command run its program on this machine. Only for scenes that you trust.");

const struct option_row *option_row(const struct command *command, size_t index) {
  if (index < command->option_count)
    return &command->options[index];
  index -= command->option_count;
  const size_t choices = command->chooses_runs ? sizeof choice_rows / sizeof choice_rows[0] - command->lists_campaigns
                                               : 0;
  if (index < choices)
    return &choice_rows[index];
  index -= choices;
  if (command->computes && index == 0)
    return &allow_row;
  index -= command->computes;
  return command->has_table && index < sizeof table_rows / sizeof table_rows[0] ? &table_rows[index] : NULL;
}

const char *option_part(const struct command *command, enum option_part part, int *length) {
  static const char *const marks[] =
      {[OPTION_ABOUT] = "\n\n", [OPTION_ROWS] = "\n\noptions:\n", [OPTION_EXAMPLES] = "\n\nexamples:\n"};
  const char *from = command->text, *end = NULL;
  if (part != OPTION_SUMMARY) {
    from = strstr(from, marks[part]);
    from += from ? strlen(marks[part]) : 0;
  }
  for (int next = (int)part + 1; from && next <= OPTION_EXAMPLES && !end; next++)
    end = strstr(from, marks[next]);
  *length = end ? (int)(end - from) : from ? (int)strlen(from) - 1 : 0;
  return from ? from : "";
}

void option_doc(const struct command *command, const struct option_row *row, char doc[OPTION_DOC]) {
  char mark[WORD_MAXIMUM + 4];
  int length;
  size_t size = 0;
  const char *rows = option_part(command, OPTION_ROWS, &length), *end = rows + length;
  snprintf(mark, sizeof mark, "\n%s: ", row->name);
  const char *at = length ? strstr(rows - 1, mark) : NULL;
  at += at ? strlen(mark) : 0;
  for (; at && at < end && (*at != '\n' || strncmp(at, "\n  ", 3) == 0) && size + 1 < OPTION_DOC; at++) {
    doc[size++] = *at == '\n' ? ' ' : *at;
    at += *at == '\n' ? 2 : 0;
  }
  doc[size] = '\0';
  if (row->doc)
    snprintf(doc, OPTION_DOC, "%s", row->doc);
  if (row->kind == OPTION_INTEGER && row->minimum > 1 && row->maximum > row->minimum)
    text_append(doc, OPTION_DOC, " From %" PRId64 " to %" PRId64 ".", row->minimum, row->maximum);
}

const char *option_nearest(const char *typed, size_t count, const char *const *names) {
  struct text_guess guess = text_guess(typed);
  for (size_t i = 0; i < count; i++)
    text_guess_offer(&guess, names[i]);
  return guess.nearest;
}

static status take_integer(const struct command *command, const struct option_row *row, const char *text, int64_t *out,
                           struct error *error) {
  char *end = NULL, range[64];
  errno = 0;
  const long long number = strtoll(text, &end, 10);
  const bool whole = end != text && *end == '\0' && errno != ERANGE;
  if (whole && number >= row->minimum && number <= row->maximum) {
    *out = number;
    return STATUS_OK;
  }
  if (row->maximum == row->minimum)
    snprintf(range, sizeof range, "that is %" PRId64, row->minimum);
  else if (row->maximum == INT64_MAX)
    snprintf(range, sizeof range, "from %" PRId64 " up", row->minimum);
  else
    snprintf(range, sizeof range, "from %" PRId64 " to %" PRId64, row->minimum, row->maximum);
  return status_fail(error, STATUS_USAGE, "--%s expects a whole number %s, got \"%.64s\" (clast %s --help)", row->name,
                     range, text, command->name);
}

/* The parts of a parse. */
struct parse {
  const struct command *command;
  void *options; /* the command's struct */
  struct shared_options shared;
  bool given[LIMITS_OPTIONS + 2];
  struct option names[LIMITS_OPTIONS + 2]; /* for getopt_long */
  char letters[2 * LIMITS_OPTIONS + 4];
};

/* An option, or a NAME=VALUE of a list, given twice. One of several names takes those of both; of any other, one would
 * be lost. */
static status take_again(const struct option_row *row, const char **slot, const char *text, struct error *error) {
  static char both[4][1000]; /* the options of a command line live as long as the program */
  static size_t used;
  const bool names = row->kind == OPTION_TEXT &&
                     (strcmp(row->argument, "NAMES") == 0 || strcmp(row->argument, "AXES") == 0);
  if (!names || used == sizeof both / sizeof both[0] || strlen(*slot) + strlen(text) + 2 > sizeof both[0])
    return status_fail(error, STATUS_USAGE, "--%s is given twice, as \"%.64s\" and \"%.64s\": leave one of them out",
                       row->name, *slot, text);
  both[used][0] = '\0';
  text_append(both[used], sizeof both[0], "%s,%s", *slot, text);
  *slot = both[used++];
  return STATUS_OK;
}

static status take_value(struct parse *parse, size_t index, const char *text, struct error *error) {
  const struct option_row *row = option_row(parse->command, index);
  char *base = index < parse->command->option_count ? parse->options : (char *)&parse->shared;
  void *slot = base + row->offset;
  const bool again = parse->given[index];
  switch (row->kind) {
  case OPTION_FLAG: *(bool *)slot = true; return STATUS_OK;
  case OPTION_TEXT:
  case OPTION_OUTPUT:
  case OPTION_PICTURE:
    if (again && strcmp(*(const char **)slot, text) != 0)
      return take_again(row, slot, text, error);
    *(const char **)slot = text;
    return STATUS_OK;
  case OPTION_LIST: {
    struct option_list *list = slot;
    const size_t name = strcspn(text, "=") + 1; /* of NAME=VALUE: one name has one value */
    for (size_t i = 0; strchr(text, '=') && i < list->count; i++) {
      if (strncmp(list->items[i], text, name) == 0)
        return strcmp(list->items[i], text) == 0 ? STATUS_OK : take_again(row, &list->items[i], text, error);
    }
    if (list->count == sizeof list->items / sizeof list->items[0])
      return status_fail(error, STATUS_USAGE, "--%s is given more than %zu times", row->name, list->count);
    list->items[list->count++] = text;
    return STATUS_OK;
  }
  case OPTION_INTEGER: {
    const int64_t before = *(int64_t *)slot;
    TRY(take_integer(parse->command, row, text, slot, error));
    if (again && *(int64_t *)slot != before)
      return status_fail(error, STATUS_USAGE,
                         "--%s is given twice, as %" PRId64 " and %" PRId64 ": leave one of them out", row->name,
                         before, *(int64_t *)slot);
    return STATUS_OK;
  }
  }
  return status_fail(error, STATUS_INTERNAL, "option --%s has no kind", row->name);
}

status option_claim_outputs(const struct command *command, const void *options, struct error *error) {
  for (size_t i = 0; i < command->option_count; i++) {
    const struct option_row *row = &command->options[i];
    char what[WORD_MAXIMUM + 1];
    if (row->kind != OPTION_OUTPUT && row->kind != OPTION_PICTURE)
      continue;
    const char *path = *(const char *const *)((const char *)options + row->offset);
    snprintf(what, sizeof what, "file of --%s", row->name);
    if (path && row->kind == OPTION_PICTURE)
      TRY(picture_canvas_named(path, error));
    if (path)
      TRY(file_claim(path, what, error));
  }
  return STATUS_OK;
}

static status unknown_option(const struct command *command, const char *typed, int letter, struct error *error) {
  const char *names[LIMITS_OPTIONS + 1];
  size_t count = 0;
  for (const struct option_row *row; (row = option_row(command, count));)
    names[count++] = row->name;
  names[count++] = "help";
  if (letter)
    return status_fail(error, STATUS_USAGE, "clast %s has no option -%c; `clast %s --help` lists them", command->name,
                       letter, command->name);
  char word[WORD_MAXIMUM + 1];
  snprintf(word, sizeof word, "%.*s", (int)strcspn(typed + 2, "="), typed + 2);
  const char *nearest = option_nearest(word, count, names);
  return status_fail(error, STATUS_USAGE, "clast %s has no option --%s%s%s%s `clast %s --help` lists them",
                     command->name, word, nearest ? "; did you mean --" : ";", nearest ? nearest : "",
                     nearest ? "?" : "", command->name);
}

/* Fills the tables of getopt_long and sets every option to its default. */
static status prepare(struct parse *parse, struct error *error) {
  const struct command *command = parse->command;
  if (command->option_count + 6 > LIMITS_OPTIONS || command->options_size > OPTION_STRUCT_MAXIMUM)
    return status_fail(error, STATUS_INTERNAL, "the option table of %s is too large", command->name);
  memset(parse->options, 0, command->options_size);
  char *letter = parse->letters;
  *letter++ = ':'; /* distinguishes a missing value from an unknown option */
  *letter++ = 'h';
  size_t count = 0;
  for (const struct option_row *row; (row = option_row(command, count)); count++) {
    const int takes = row->kind == OPTION_FLAG ? no_argument : required_argument;
    parse->names[count] = (struct option){.name = row->name, .has_arg = takes, .val = ROW_VALUE + (int)count};
    if (row->letter)
      *letter++ = row->letter;
    if (row->letter && takes == required_argument)
      *letter++ = ':';
    if (row->initial && take_value(parse, count, row->initial, error))
      return status_fail(error, STATUS_INTERNAL, "the default of --%s is wrong", row->name);
  }
  *letter = '\0';
  parse->names[count] = (struct option){.name = "help", .has_arg = no_argument, .val = HELP_VALUE};
  parse->names[count + 1] = (struct option){0};
  return STATUS_OK;
}

/* One option that getopt_long found; `word` is how it was typed. */
static status take_option(struct parse *parse, int given, const char *word, struct error *error) {
  const struct command *command = parse->command;
  if (given == '?' && optopt == HELP_VALUE)
    return status_fail(error, STATUS_USAGE, "--help takes no value");
  const int value = given == '?' || given == ':' ? optopt : given; /* a letter, or a row's number */
  size_t index = value >= ROW_VALUE ? (size_t)(value - ROW_VALUE) : 0;
  const struct option_row *row;
  while ((row = option_row(command, index)) && value < ROW_VALUE && (!row->letter || row->letter != value))
    index++;
  if (given == '?' && row && optopt >= ROW_VALUE)
    return status_fail(error, STATUS_USAGE, "--%s takes no value", row->name);
  if (given == '?')
    return unknown_option(command, word, optopt, error); /* optopt is 0 for a long name */
  if (!row)
    return status_fail(error, STATUS_INTERNAL, "option table of %s", command->name);
  if (row == &allow_row && strcmp(word + 2, row->name) != 0) /* who types --all does not allow commands */
    return unknown_option(command, word, 0, error);
  if (given == ':')
    return status_fail(error, STATUS_USAGE, "--%s needs a value: --%s %s", row->name, row->name, row->argument);
  const status code = take_value(parse, index, optarg, error);
  parse->given[index] = true;
  return code;
}

/* Counts the words of the command's arguments: see `arguments` of struct command. */
static status check_arguments(const struct command *command, size_t count, char *const *arguments,
                              struct error *error) {
  size_t least = 0, most = 0;
  for (const char *word = command->arguments; *word; word += strcspn(word, " "), word += strspn(word, " ")) {
    least += *word != '[';
    most++;
  }
  if (strstr(command->arguments, "..."))
    most = SIZE_MAX;
  if (count < least) {
    const bool one = count > 0 && least - count == 1;
    return status_fail(error, STATUS_USAGE, "clast %s needs %s; usage: clast %s %s", command->name,
                       one ? "one more argument" : command->arguments, command->name, command->arguments);
  }
  if (count > most)
    return status_fail(error, STATUS_USAGE, "clast %s does not know what to do with \"%.64s\"; usage: clast %s %s",
                       command->name, arguments[most], command->name, command->arguments);
  return STATUS_OK;
}

status option_parse(const struct command *command, int argc, char **argv, void *options, struct command_line *line,
                    struct error *error) {
  struct parse parse = {.command = command, .options = options};
  TRY(prepare(&parse, error));
  optind = 0; /* glibc: start over, also after another parse */
  opterr = 0;
  line->options = options;
  line->help = false;
  for (int given; (given = getopt_long(argc, argv, parse.letters, parse.names, NULL)) != -1;) {
    line->help = given == HELP_VALUE || given == 'h';
    if (line->help)
      return STATUS_OK;
    TRY(take_option(&parse, given, argv[optind - 1], error));
  }
  line->count = (size_t)(argc - optind);
  line->arguments = argv + optind;
  TRY(check_arguments(command, line->count, line->arguments, error));
  line->chooses_runs = command->chooses_runs;
  line->lists_campaigns = command->lists_campaigns;
  if (parse.shared.allow_commands)
    engine_allow_commands();
  line->choice = parse.shared.choice;
  line->choice.axes = command->chooses_runs;
  line->choice.campaigns_alone = command->chooses_runs && !command->lists_campaigns && !parse.shared.studies;
  if (parse.shared.json && parse.shared.csv)
    return status_fail(error, STATUS_USAGE, "--json and --csv exclude each other");
  line->format = parse.shared.json  ? TABLE_JSON
                 : parse.shared.csv ? TABLE_CSV
                 : parse.shared.all ? TABLE_ALL
                                    : TABLE_TEXT;
  return STATUS_OK;
}

/* Sets one PATH=VALUE. */
static status set_input(struct scene *scene, const char *text, char path[FIELD_TEXT_SIZE], struct error *error) {
  const char *value = NULL;
  TRY(campaign_change_split(text, path, &value, error));
  const status code = scene_set_text(scene, path, value, error);
  return code == STATUS_CONTENT ? STATUS_USAGE : code; /* the wrong content is on the command line */
}

/* Two names of one input are a mistake, as in a campaign. */
status option_set_inputs(struct scene *scene, const struct option_list *set, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  for (size_t i = 0; i < set->count; i++) {
    char path[FIELD_TEXT_SIZE], before[FIELD_TEXT_SIZE];
    TRY(set_input(scene, set->items[i], path, error));
    for (size_t k = 0; k < i; k++) {
      snprintf(before, sizeof before, "%.*s", (int)strcspn(set->items[k], "="), set->items[k]);
      if (strcmp(path, before) != 0 &&
          field_find_in(inputs, path, scene->inputs, NULL) == field_find_in(inputs, before, scene->inputs, NULL))
        return status_fail(error, STATUS_USAGE, "--set %s: the same input as --set %s; leave one of them out", path,
                           before);
    }
  }
  return scene_check(scene, error);
}

status option_load_scene(const char *name, const struct option_list *set, struct scene **scene, struct error *error) {
  TRY(scene_load(name, NULL, scene, error));
  return option_set_inputs(*scene, set, error);
}

void option_words(const char *file, const struct option_list *set, const char *store, char *text, size_t size) {
  char word[TEXT_WORD];
  snprintf(text, size, "%s", text_word(file, word));
  for (size_t i = 0; i < set->count; i++) {
    text_append(text, size, " --set");
    text_append_word(text, size, set->items[i]);
  }
  if (store) {
    text_append(text, size, " --store");
    text_append_word(text, size, store);
  }
}

status option_load_campaign(const char *path, const struct campaign_option *option, int slots,
                            struct campaign **campaign, struct error *error) {
  struct campaign_changes changes = {option->set.count, option->set.items, option->seeds, 0};
  if (option->within) {
    const struct field *row = field_find(&campaign_table, "accuracy.processor_time", error);
    struct field_value time = {0};
    if (!row)
      return STATUS_INTERNAL;
    if (field_parse(row, option->within, &time, error) != STATUS_OK || field_is_off(time.number))
      return status_fail(
          error, STATUS_USAGE,
          "--within %s: expected a time above 0, such as 2h or 30min; the error that you allow stands in "
          "the campaign: `accuracy: {within: %s}`",
          option->within, option->within);
    changes.processor_time = time.number * slots;
  }
  return campaign_load_changed(path, &changes, campaign, error);
}

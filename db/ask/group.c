/* Statistics grouped by any varied inputs, pooled over the others (`--by m,k`). */
#include <string.h>

#include "db/ask/ask.h"
#include "db/store/internal.h"
#include "db/store/views.h"
#include "schemas/memory.h"

enum { NAME = 128, NAMED = 6 };

struct names {
  char name[LIMITS_NAMES][NAME];
  size_t count;
};

/* Is it a section of the path: "porosity" of target.material.porosity.fraction? */
static bool is_section(const char *path, const char *wanted) {
  const size_t length = strlen(wanted);
  for (const char *at = path; length && (at = strstr(at, wanted)); at++)
    if ((at == path || at[-1] == '.') && at[length] == '.')
      return true;
  return false;
}

struct choice { /* possible meanings of a word */
  const char *wanted;
  bool sections;           /* a word is a section of a path, too */
  struct text_guess guess; /* guess.nearest points to `near` */
  char found[NAME];
  size_t matches;
  bool exact;
  char near[NAME], known[4096], matching[1024];
  char alike[512]; /* names with most words of it, of many the first ones */
  int similar, alike_words;
};

static void append(char *list, size_t size, const char *name) {
  text_append(list, size, "%s%s", *list ? ", " : "", name);
}

/* How many of the words of `wanted` has `name`, such as "mass" of mass_largest? */
static int words_alike(const char *name, const char *wanted) {
  char words[NAME], *rest = words;
  int count = 0;
  snprintf(words, sizeof words, "%s", wanted);
  for (const char *word; (word = strsep(&rest, "._ "));)
    count += strlen(word) > 2 && strstr(name, word);
  return count;
}

/* Keeps the names that have most words of it. */
static void keep_alike(struct choice *choice, const char *name) {
  const int words = words_alike(name, choice->wanted);
  if (words > choice->alike_words) {
    choice->alike_words = words;
    choice->similar = 0;
    choice->alike[0] = '\0';
  }
  if (words > 0 && words == choice->alike_words && choice->similar++ < NAMED)
    append(choice->alike, sizeof choice->alike, name);
}

static void consider(struct choice *choice, const char *column, const char *path) {
  const char *name = path ? path : column;
  text_guess_offer(&choice->guess, name);
  if (choice->guess.nearest == name) { /* the row owns the name: keep a copy */
    snprintf(choice->near, sizeof choice->near, "%s", name);
    choice->guess.nearest = choice->near;
  }
  append(choice->known, sizeof choice->known, name);
  keep_alike(choice, name);
  bool exact = strcmp(column, choice->wanted) == 0 || (path && strcmp(path, choice->wanted) == 0);
  if (choice->exact || !(exact || text_ends_in_words(column, choice->wanted, "_.") ||
                         (path && text_ends_in_words(path, choice->wanted, "_.")) ||
                         (path && choice->sections && is_section(path, choice->wanted))))
    return;
  choice->matches = exact ? 1 : choice->matches + 1;
  choice->exact = exact;
  append(choice->matching, sizeof choice->matching, name);
  snprintf(choice->found, sizeof choice->found, "%s", column);
}

/* "energy_kinetic" for "result_dem_energy_kinetic", its name in a store with two engines; else `column`. */
static const char *without_engine(const char *column) {
  for (size_t i = 0; i < engine_count(); i++) {
    char prefix[NAME];
    snprintf(prefix, sizeof prefix, "result_%s_", engine_at(i)->name);
    if (strncmp(column, prefix, strlen(prefix)) == 0)
      return column + strlen(prefix);
  }
  return column;
}

/* Does the name of the result on axes begin with the word, as "strength: largest mean stress"? */
static bool is_labelled(const char *column, const char *word) {
  const size_t length = strlen(word);
  for (size_t i = 0; i < engine_count(); i++) {
    const struct field *row = field_of_column(engine_at(i)->results, without_engine(column));
    if (row && row->label && strncmp(row->label, word, length) == 0 && row->label[length] == ':')
      return true;
  }
  return false;
}

/* Looks for the name as written, as a column name, as a column name without its engine's prefix or its last word
 * "name", and as a section of a path. */
static status look_for(struct store *store, const char *columns_sql, const char *name, struct choice *choice,
                       struct error *error) {
  char column[NAME], named[NAME]; /* named: "material" of "target_material_name" */
  char labelled[NAME] = "";
  field_column_name(name, column, sizeof column);
  snprintf(named, sizeof named, "%.*s_name", NAME - 6, column);
  const char *const forms[] = {name, column, without_engine(column), named, name};
  *choice = (struct choice){.guess = text_guess(name)};
  if (strcmp(name, "M_1/M") == 0 || strcmp(name, "M_2/M") == 0)
    snprintf(choice->near, sizeof choice->near, "%s",
             name[2] == '1' ? OUTCOME_NAME(largest_fraction) : OUTCOME_NAME(second_fraction));
  for (size_t i = 0; choice->matches == 0 && i < sizeof forms / sizeof forms[0]; i++) {
    choice->wanted = forms[i];
    choice->sections = i + 1 == sizeof forms / sizeof forms[0];
    choice->known[0] = choice->alike[0] = '\0';
    choice->similar = choice->alike_words = 0;
    ANSWER answer = answer_to(store, error, "%s", columns_sql);
    while (answer_next(&answer)) {
      const char *known = answer_text(&answer, 0);
      consider(choice, known, answer_count(&answer) > 1 ? answer_text(&answer, 1) : NULL);
      if (is_labelled(known, name))
        snprintf(labelled, sizeof labelled, "%s", known);
    }
    TRY(answer_end(&answer));
  }
  if (*labelled)
    snprintf(choice->near, sizeof choice->near, "%s", labelled);
  return STATUS_OK;
}

static status judge(const struct choice *choice, const char *what, const char *name, struct error *error) {
  if (choice->matches == 1)
    return STATUS_OK;
  if (choice->matches > 1)
    return status_fail(error, STATUS_USAGE, "%s '%s' is ambiguous: it may be %s.", what, name, choice->matching);
  enum exponent_method method;
  enum estimates_window window;
  struct error other;
  bool exponent = false;
  if (strcmp(what, "Quantity") == 0 && !estimates_named(name, &exponent, &method, &window, &other) && exponent)
    return status_fail(error, STATUS_USAGE,
                       "'%s' is an exponent of all runs of a point together: no run has a value of it, so this command "
                       "cannot use it. `clast estimates` has it, `clast plot` and `clast map` draw it",
                       name);
  if (choice->near[0])
    return status_fail(error, STATUS_USAGE, "%s '%s' is unknown; did you mean '%s'?", what, name, choice->near);
  if (strcmp(what, "Quantity") == 0) /* of a hundred */
    return status_fail(error, STATUS_USAGE, "Quantity '%s' is unknown%s%s; `clast explain results` lists all.", name,
                       *choice->alike ? ". Similar are: " : "", choice->alike);
  return status_fail(error, STATUS_USAGE, "%s '%s' is unknown. Known are: %s.", what, name,
                     choice->known[0] ? choice->known : "none");
}

/* An input of the points with runs that is no axis: says why. */
static status judge_input(struct store *store, const char *name, const struct choice *choice, struct error *error) {
  char path[NAME] = "";
  ANSWER found = answer_to(
      store, error,
      "SELECT path, count(DISTINCT value) AS kinds FROM point p JOIN point_input USING (point_id) WHERE (path = %Q OR "
      "path LIKE '%%.' || %Q) AND EXISTS (SELECT 1 FROM run WHERE run.point_id = p.point_id) GROUP BY path ORDER BY "
      "kinds > 1 DESC, path LIMIT 1",
      name, name);
  const bool is_input = answer_next(&found);
  if (is_input)
    snprintf(path, sizeof path, "%s", answer_text(&found, 0));
  const bool differs = is_input && answer_integer(&found, 1) > 1;
  TRY(answer_end(&found));
  if (!is_input)
    return STATUS_OK;
  if (!differs)
    return status_fail(error, STATUS_USAGE, "%s has one value in all points%s. Known are: %s.", path,
                       store->left_out ? " (--studies: also in those of studies and searches)" : "",
                       choice->known[0] ? choice->known : "none");
  ANSWER from = answer_to(store, error,
                          "SELECT i.path FROM axis JOIN point_input i USING (path) JOIN point_input o ON o.point_id = "
                          "i.point_id AND o.path = %Q GROUP BY i.path HAVING count(DISTINCT o.value) > 1 AND "
                          "count(DISTINCT i.value) = count(DISTINCT "
                          "o.value) AND count(DISTINCT quote(i.value) || quote(o.value)) = count(DISTINCT o.value) "
                          "ORDER BY i.path LIMIT 1",
                          path);
  if (answer_next(&from))
    return status_fail(error, STATUS_USAGE, "%s follows from %s, which a campaign varies: take that", path,
                       answer_text(&from, 0));
  TRY(answer_end(&from));
  return status_fail(error, STATUS_USAGE, "%s is no axis of this store: no campaign varies it. Known are: %s.", path,
                     choice->known[0] ? choice->known : "none");
}

static status resolve(struct store *store, const char *list, const char *what, const char *columns_sql,
                      struct names *out, struct error *error) {
  while (*list) {
    char word[NAME];
    struct choice choice;
    list = text_next_item(list, word, sizeof word);
    if (!*word)
      continue;
    TRY(look_for(store, columns_sql, word, &choice, error));
    if (choice.matches == 0 && strcmp(what, "Axis") == 0)
      TRY(judge_input(store, word, &choice, error));
    TRY(judge(&choice, what, word, error));
    if (out->count == LIMITS_NAMES)
      return status_fail(error, STATUS_USAGE, "More than %d of them: %s", LIMITS_NAMES, what);
    snprintf(out->name[out->count++], NAME, "%s", choice.found);
  }
  return STATUS_OK;
}

static void write_names(FILE *out, const struct names *names) {
  for (size_t i = 0; i < names->count; i++) {
    sql_write_name(names->name[i], out);
    fputs(", ", out);
  }
}

/* A row for the runs of each point that died, in the columns that write_points() reads. Where the point has no run,
 * they are of its engine's newest results_version. LIMIT -1: SQLite counts them once, not for each use. */
static void write_died(FILE *out, const struct names *axes, size_t quantities) {
  fputs(" UNION ALL SELECT ", out);
  for (size_t i = 0; i < axes->count; i++) {
    SQL_TEXT value = sql_format("iif(%Q = 'scene', p.scene_name, (SELECT value FROM axis JOIN point_input i USING "
                                "(path) WHERE i.point_id = p.point_id AND column_name = %Q)), ",
                                axes->name[i], axes->name[i]);
    fputs(value, out);
  }
  for (size_t i = 0; i < quantities; i++)
    fputs("NULL, NULL, ", out);
  fputs("p.engine, ifnull((SELECT max(results_version) FROM point_total t WHERE t.point_id = p.point_id), newest), "
        "p.point_id, 0, died, '', 0, NULL, NULL FROM (SELECT *, " POINT_DIED(
            POINT_RUNS_ARE_ALL) " AS died FROM point p WHERE point_id IN (SELECT point_id FROM attempt) LIMIT -1) p "
                                "LEFT JOIN (SELECT engine, max(results_version) AS newest FROM point JOIN point_total "
                                "USING (point_id) GROUP BY engine) USING (engine) WHERE died > 0",
        out);
}

/* One row per point of a group: its number of runs and, for quantity N, the number of values rN, mean pN, standard
 * deviation oN and values with seeds sN. Rows are ordered so that the sums have the same bits for any order in which
 * the runs finished. */
static void write_points(FILE *out, const struct names *axes, const struct names *quantities) {
  fputs("\nFROM (SELECT ", out);
  write_names(out, axes);
  fputs("engine, results_version, point_id, sum(counts) AS n, sum(failed) AS failed, sum(counts AND state = "
        "'end-time') AS censored, sum(surplus > 1) AS excluded",
        out);
  for (size_t i = 0; i < quantities->count; i++) {
    const char *q = quantities->name[i];
    fprintf(out,
            ",\n  count(iif(counts, \"%1$s\", NULL)) AS r%2$zu, mean(iif(counts, \"%1$s\", NULL)) AS p%2$zu, "
            "stdev(iif(counts, \"%1$s\", NULL)) AS o%2$zu, seeds(seed, iif(counts, \"%1$s\", NULL)) AS s%2$zu, "
            "count(iif(counts, w%2$zu, NULL)) AS b%2$zu, words(iif(counts, w%2$zu, NULL)) AS w%2$zu",
            q, i);
  }
  fputs("\nFROM (SELECT * FROM (SELECT ", out); /* only the needed columns, because the rows are sorted */
  write_names(out, axes);
  for (size_t i = 0; i < quantities->count; i++)
    fprintf(out, "\"%1$s\", doubts(engine, warnings, '%1$s') AS w%2$zu, ", quantities->name[i], i);
  fputs("engine, results_version, point_id, counts, counts = 0 AND surplus = 0 AS failed, state, surplus, replicate, "
        "seed FROM runs WHERE surplus <> 1",
        out);
  write_died(out, axes, quantities->count);
  fputs(") ORDER BY point_id, results_version, replicate, seed)\nGROUP BY ", out);
  write_names(out, axes);
  fputs("engine, results_version, point_id) LEFT JOIN ", out);
  const char *list[LIMITS_NAMES];
  for (size_t i = 0; i < quantities->count; i++)
    list[i] = quantities->name[i];
  views_statistics_resolution(quantities->count, list, out);
  fputs(" USING (point_id, results_version)\nGROUP BY ", out);
}

/* The units of a group are the runs of its only point, or the means of its points (sample_crossed()). The resolution
 * error of a group is the largest one among its points. */
static char *group_sql(const struct names *axes, const struct names *quantities) {
  char *sql = NULL, units[32], quantile[32];
  FILE *out = text_open(&sql);
  fputs("SELECT ", out);
  write_names(out, axes);
  fputs("engine, results_version, points, n, failed, censored, excluded", out);
  for (size_t i = 0; i < quantities->count; i++) {
    snprintf(units, sizeof units, "u%zu", i);
    const struct sample_range range = views_range(quantities->name[i]);
    views_statistics_columns(i, quantities->name[i], "o", units, &range, out);
  }
  for (size_t i = 0; i < quantities->count; i++)
    fprintf(out, ",\n  r%1$zu AS \"%2$s_n\", b%1$zu AS \"%2$s_doubtful\"", i, quantities->name[i]);
  fputs(",\n  doubts", out);
  fputs("\nFROM (SELECT *", out);
  for (size_t i = 0; i < quantities->count; i++) {
    snprintf(units, sizeof units, "u%zu", i);
    snprintf(quantile, sizeof quantile, "t%zu", i);
    fputs(",\n  ", out);
    const struct sample_range range = views_range(quantities->name[i]);
    views_statistics_half_width(i, units, quantile, &range, out);
  }
  fputs("\nFROM (SELECT *", out);
  for (size_t i = 0; i < quantities->count; i++) {
    snprintf(units, sizeof units, "(u%zu - 1)", i);
    fputs(",\n  ifnull(", out);
    views_statistics_student(units, out); /* whole degrees of freedom: the bits of the view `points` */
    fprintf(out, ", student(u%1$zu)) AS t%1$zu", i);
  }
  fputs("\nFROM (SELECT ", out);
  write_names(out, axes);
  fputs("engine, results_version, sum(n > 0) AS points, sum(n) AS n, sum(failed) AS failed, sum(censored) AS censored, "
        "sum(excluded) AS excluded",
        out);
  for (size_t i = 0; i < quantities->count; i++) { /* in parts, as in views_statistics_columns() */
    fprintf(out,
            ",\n  mean(p%1$zu) AS m%1$zu, iif(count(p%1$zu) > 1, crossed_units(s%1$zu), sum(r%1$zu)) AS u%1$zu, "
            "iif(count(p%1$zu) > 1, crossed_sd(s%1$zu), max(o%1$zu)) AS d%1$zu, "
            "iif(count(p%1$zu) > 1, stdev(p%1$zu), max(o%1$zu)) AS o%1$zu,\n  ",
            i);
    fprintf(out,
            "iif(count(e%1$zu) = count(*), max(e%1$zu), NULL) AS e%1$zu, CASE WHEN count(e%1$zu) < count(*) THEN "
            "'not-studied' WHEN max(v%1$zu = 'diverges') THEN 'diverges' WHEN max(v%1$zu = 'at-least') THEN 'at-least' "
            "WHEN max(v%1$zu = 'known') THEN 'known' ELSE 'no-difference' END AS v%1$zu, sum(r%1$zu) AS r%1$zu, "
            "sum(b%1$zu) AS b%1$zu",
            i);
  }
  fputs(",\n  words(", out);
  for (size_t i = 0; i < quantities->count; i++)
    fprintf(out, "%sw%zu", i ? " || ', ' || " : "", i);
  fputs(quantities->count ? ") AS doubts" : "'') AS doubts", out);
  write_points(out, axes, quantities);
  write_names(out, axes);
  fputs("engine, results_version))) ORDER BY ", out);
  write_names(out, axes);
  fputs("engine, results_version", out);
  return text_close_small(out, &sql);
}

/* The points with runs, and the number `grp` of the group that each belongs to. The caller frees it. */
static char *grouped_sql(const struct names *axes) {
  char *sql = NULL;
  FILE *out = text_open(&sql);
  fputs("WITH grouped AS (SELECT point_id, dense_rank() OVER (ORDER BY ", out);
  write_names(out, axes);
  fputs("engine, results_version) AS grp FROM points WHERE n > 0)", out);
  return text_close_small(out, &sql);
}

/* The first NAMED of the answer's names. */
static status take_first_names(struct answer *answer, char list[ASK_GROUP_POOLED]) {
  size_t count = 0;
  for (list[0] = '\0'; answer_next(answer); count++)
    if (count < NAMED)
      append(list, ASK_GROUP_POOLED, answer_text(answer, 0));
  if (count > NAMED)
    text_append(list, ASK_GROUP_POOLED, " and %zu more inputs", count - NAMED);
  return answer_end(answer);
}

/* What differs within a group: `scene`, and the varied inputs or, when the points of a group differ in none of them,
 * all others. The first NAMED are named. means: the quantities of means over points (sample_crossed()), which lack the
 * seeds of points of one value alone; NULL: of numbers that every run has. */
static status find_pooled(struct store *store, const struct names *axes, const struct names *means,
                          struct ask_group_pooled *pooled, struct error *error) {
  OWNED char *grouped = grouped_sql(axes);
  ANSWER answer = answer_to(
      store, error,
      "%s,\n"
      "differing AS (SELECT path FROM (SELECT grp, a.path, count(*) AS points, count(i.value) AS given, "
      "count(DISTINCT i.value) AS kinds FROM grouped g CROSS JOIN axis a LEFT JOIN point_input i ON i.point_id = "
      "g.point_id AND i.path = a.path GROUP BY grp, a.path) WHERE kinds > 1 OR (kinds = 1 AND given < points))\n"
      "SELECT 'scene' WHERE EXISTS (SELECT 1 FROM grouped JOIN point USING (point_id) GROUP BY grp HAVING "
      "count(DISTINCT scene_name) > 1)\n"
      "UNION ALL SELECT DISTINCT path FROM differing\n"
      "UNION ALL SELECT DISTINCT i.path FROM grouped g JOIN point_input i USING (point_id) WHERE NOT EXISTS (SELECT 1 "
      "FROM differing) GROUP BY grp, i.path HAVING count(DISTINCT i.value) > 1 OR count(*) < (SELECT count(*) FROM "
      "grouped h WHERE h.grp = g.grp)",
      grouped);
  TRY(take_first_names(&answer, pooled->inputs));
  sqlite3_str *lone = sqlite3_str_new(NULL); /* has the point one value of a quantity? */
  for (size_t i = 0; means && i < means->count; i++)
    sqlite3_str_appendf(lone, "%scount(\"%w\") = 1", i ? " OR " : "", means->name[i]);
  if (!means)
    sqlite3_str_appendall(lone, "count(*) = 1");
  char *is_lone = sqlite3_str_finish(lone);
  ANSWER kinds = answer_to(store, error,
                           "%s SELECT total(points = 1), total(shared) FROM (SELECT count(*) AS points, count(seed) > "
                           "count(DISTINCT seed) AND max(lone) AS shared FROM (SELECT grp, (SELECT seed FROM run r "
                           "WHERE r.point_id = grouped.point_id AND replicate = 0 LIMIT 1) AS seed, (SELECT %s FROM "
                           "runs r WHERE r.point_id = grouped.point_id AND counts) AS lone FROM grouped) GROUP BY grp)",
                           grouped, is_lone ? is_lone : "1");
  sqlite3_free(is_lone);
  if (answer_next(&kinds)) {
    pooled->single = answer_real(&kinds, 0) > 0;
    pooled->lacks_seeds = answer_real(&kinds, 1) > 0;
  }
  return answer_end(&kinds);
}

static const char
    axes_sql[] = "SELECT column_name, path FROM axis UNION ALL SELECT 'scene', 'scene' WHERE " STORE_HAS_SCENES
                 " ORDER BY path";
static const char quantities_sql[] =
    "SELECT c.name FROM pragma_table_info('runs') c WHERE c.type IN ('REAL', 'INTEGER') AND c.name NOT IN "
    "('run_id', 'point_id', 'session_id', 'replicate', 'seed', 'results_version', 'surplus', 'counts', "
    "'rank', 'attempt', 'finished_at') AND c.name NOT IN (SELECT column_name FROM main.axis)";

struct answer ask_group_quantities(struct store *store, struct error *error) {
  return answer_to(store, error, "%s", quantities_sql);
}

status ask_group_quantity(struct store *store, const char *quantity, char name[ASK_GROUP_NAME], struct error *error) {
  struct names names = {.count = 0};
  status code = resolve(store, quantity, "Quantity", quantities_sql, &names, error);
  if (code == STATUS_OK && names.count != 1)
    code = status_fail(error, STATUS_USAGE, "one quantity, not '%.128s'", quantity);
  snprintf(name, ASK_GROUP_NAME, "%s", names.name[0]);
  return code;
}

status ask_group_columns(struct store *store, const char *by, size_t most, char (*columns)[ASK_GROUP_NAME],
                         size_t *count, struct error *error) {
  struct names names = {.count = 0};
  *count = 0;
  TRY(resolve(store, by, "Axis", axes_sql, &names, error));
  if (names.count > most)
    return status_fail(error, STATUS_USAGE, "at most %zu inputs, not %zu", most, names.count);
  for (; *count < names.count; ++*count)
    snprintf(columns[*count], ASK_GROUP_NAME, "%s", names.name[*count]);
  return STATUS_OK;
}

status ask_group_pooled(struct store *store, const char *by, struct ask_group_pooled *pooled, struct error *error) {
  struct names axes = {.count = 0};
  *pooled = (struct ask_group_pooled){.inputs = ""};
  if (!by)
    return STATUS_OK;
  TRY(resolve(store, by, "Axis", axes_sql, &axes, error));
  return find_pooled(store, &axes, NULL, pooled, error);
}

static status find_names(struct store *store, const char *by, const char *quantities, struct names *axes,
                         struct names *results, struct ask_group_pooled *pooled, struct error *error) {
  TRY(ask_register_functions(store, error));
  TRY(resolve(store, by, "Axis", axes_sql, axes, error));
  if (quantities)
    TRY(resolve(store, quantities, "Quantity", quantities_sql, results, error));
  const char *names[VIEWS_STATISTICS_MAIN];
  for (size_t i = 0; !quantities && i < views_statistics_main(names); i++)
    snprintf(results->name[results->count++], NAME, "%s", names[i]);
  return find_pooled(store, axes, results, pooled, error);
}

struct answer ask_group(struct store *store, const char *by, const char *quantities, struct ask_group_pooled *pooled,
                        struct error *error) {
  struct names axes = {.count = 0}, results = {.count = 0};
  const status code = find_names(store, by, quantities, &axes, &results, pooled, error);
  if (code)
    return answer_failed(code, error);
  OWNED char *sql = group_sql(&axes, &results);
  return answer_to(store, error, "%s", sql);
}

/* The axes of `by` are constant within a group, too: they are left out by their columns' names. */
status ask_group_changing(struct store *store, const char *by, char changing[ASK_GROUP_POOLED], struct error *error) {
  struct names axes = {.count = 0};
  TRY(resolve(store, by, "Axis", axes_sql, &axes, error));
  OWNED char *grouped = grouped_sql(&axes);
  sqlite3_str *shown = sqlite3_str_new(NULL);
  for (size_t i = 0; i < axes.count; i++)
    sqlite3_str_appendf(shown, "%s%Q", i ? ", " : "", axes.name[i]);
  char *columns = sqlite3_str_finish(shown);
  ANSWER answer = answer_to(
      store, error,
      "%s\nSELECT path FROM (SELECT a.path AS path, grp, count(*) AS points, count(i.value) AS given, count(DISTINCT "
      "i.value) AS kinds, min(i.value) AS value FROM grouped g CROSS JOIN axis a LEFT JOIN point_input i ON i.point_id "
      "= g.point_id AND i.path = a.path WHERE a.column_name NOT IN (%s) GROUP BY a.path, grp) GROUP BY path HAVING "
      "max(kinds) = 1 AND max(given > 0 AND given < points) = 0 AND (count(DISTINCT value) > 1 OR count(value) < "
      "count(*))",
      grouped, columns ? columns : "");
  sqlite3_free(columns);
  return take_first_names(&answer, changing);
}

status ask_group_values(struct store *store, const char *input, struct ask_group_values *values, struct error *error) {
  ANSWER answer = answer_to(store, error,
                            "SELECT count(*), count(a), total(typeof(a) IN ('real', 'integer')), count(DISTINCT "
                            "quote(a)) FROM (SELECT DISTINCT point_id, \"%w\" AS a FROM points WHERE n > 0)",
                            input);
  *values = (struct ask_group_values){.points = 0};
  if (answer_next(&answer))
    *values = (struct ask_group_values){answer_integer(&answer, 0), answer_integer(&answer, 1),
                                        (int64_t)answer_real(&answer, 2), answer_integer(&answer, 3)};
  return answer_end(&answer);
}

/* Points are compared input by input only where their varied inputs agree; other points differ anyway. */
status ask_group_twins(struct store *store, struct ask_group_twins *twins, struct error *error) {
  *twins = (struct ask_group_twins){.pairs = 0};
  ANSWER answer = answer_to(
      store, error,
      "WITH varied AS MATERIALIZED (SELECT point_id, engine || ifnull((SELECT group_concat(v) FROM (SELECT path || '=' "
      "|| quote(value) AS v FROM axis JOIN point_input i USING (path) WHERE i.point_id = p.point_id ORDER BY path)), "
      "'') AS inputs FROM point p), twin AS (SELECT a.point_id AS a, b.point_id AS b FROM varied a JOIN varied b USING "
      "(inputs) WHERE a.point_id < b.point_id AND NOT EXISTS (SELECT 1 FROM point_input i JOIN point_input j USING "
      "(path) WHERE i.point_id = a.point_id AND j.point_id = b.point_id AND i.value IS NOT j.value) AND EXISTS (SELECT "
      "1 FROM run r JOIN run s USING (seed, results_version) WHERE r.point_id = a.point_id AND s.point_id = b.point_id "
      "AND r.surplus = 0 AND s.surplus = 0)) SELECT count(*) OVER (), a, b, (SELECT path FROM point_input WHERE "
      "point_id IN (a, b) GROUP BY path HAVING count(*) = 1 LIMIT 1) FROM twin ORDER BY a, b LIMIT 1");
  if (answer_next(&answer)) {
    twins->pairs = answer_integer(&answer, 0);
    twins->point[0] = answer_integer(&answer, 1);
    twins->point[1] = answer_integer(&answer, 2);
    snprintf(twins->input, sizeof twins->input, "%s", answer_text(&answer, 3));
  }
  return answer_end(&answer);
}

status ask_group_idle(struct store *store, char idle[ASK_GROUP_POOLED], struct error *error) {
  struct ask_column axes[LIMITS_AXES_OF_POOL];
  size_t count;
  idle[0] = '\0';
  TRY(ask_columns_axes(store, true, LIMITS_AXES_OF_POOL, axes, &count, error));
  /* Lists, because an expression of hundreds of terms is too deep for SQLite. A result that some of the runs lack is
   * not the same. */
  char *lists[2] = {NULL, NULL};
  FILE *out[2] = {text_open(&lists[0]), text_open(&lists[1])};
  ANSWER
  results = answer_to(store, error,
                      "%s AND c.name NOT IN (SELECT column_name FROM column_doc WHERE table_name = 'run' AND NOT "
                      "deterministic)",
                      quantities_sql);
  for (const char *before = ""; answer_next(&results); before = ", ") {
    fprintf(out[0], "%1$smin(\"%2$s\"), count(\"%2$s\") %% count(*)", before, answer_text(&results, 0));
    fprintf(out[1], "%1$smax(\"%2$s\"), 0", before, answer_text(&results, 0));
  }
  OWNED char *least = text_close_small(out[0], &lists[0]), *most = text_close_small(out[1], &lists[1]);
  TRY(answer_end(&results));
  for (size_t i = 0; i < count; i++) {
    bool idle_so_far = true; /* the first seeds show most effects; only without one all seeds are read */
    for (int all = 0; all <= 1 && idle_so_far; all++) {
      sqlite3_str *others = sqlite3_str_new(NULL);
      for (size_t j = 0; j < count; j++)
        if (j != i)
          sqlite3_str_appendf(others, "\"%w\", ", axes[j].name);
      ANSWER answer = answer_to(
          store, error,
          "SELECT ifnull(min(same), %d) FROM (SELECT count(DISTINCT \"%w\") AS kinds, (%s) IS (%s) AS same FROM "
          "runs WHERE counts AND (%d OR replicate = 0) GROUP BY %zengine, results_version, seed "
          "HAVING kinds > 1)",
          !all, axes[i].name, least, most, all, sqlite3_str_finish(others));
      idle_so_far = answer_next(&answer) && answer_integer(&answer, 0);
      TRY(answer_end(&answer));
    }
    if (idle_so_far)
      append(idle, ASK_GROUP_POOLED, axes[i].word);
  }
  return STATUS_OK;
}

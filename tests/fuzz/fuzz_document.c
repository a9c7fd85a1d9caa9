/* Fuzz target: any bytes as a document, read through a table of every kind of row, walked and reported; the values read
 * are converted to JSON, identity and bytes. Invariants that must hold for every input are checked; a failed check
 * aborts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/document.h"
#include "schemas/rows.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* libfyaml 0.7.12 loses the buffer of an unfinished quoted text with many escapes when the document then turns out to
 * be no YAML (quotes-leak.yaml): 1 kB per refused document. test_document checks that our own use of it does not leak.
 */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libfyaml\n";
}

struct thing {
  double length, limit;
  int64_t count, memory;
  bool broken;
  int law;
  char name[FIELD_TEXT_SIZE];
  double needed;
};
static const char *const laws[] = {"weak", "strong", "off", NULL};
static const struct field rows[] = {
    REAL_OF(thing, a.length, length, "m", 0, 0, 10),
    REAL_OF(thing, a.limit, limit, "1", (double)NAN, -1, 1, .flags = FIELD_MAY_BE_OFF),
    ROW_OF(thing, a.b.count, count, FIELD_INTEGER, "1", .minimum = 0, .maximum = 99, .when = "law=weak|strong"),
    ROW_OF(thing, m, memory, FIELD_INTEGER, "B", .minimum = -HUGE_VAL, .maximum = HUGE_VAL),
    ROW_OF(thing, broken, broken, FIELD_BOOLEAN, NULL),
    ROW_OF(thing, law, law, FIELD_CHOICE, NULL, .choices = laws),
    ROW_OF(thing, name, name, FIELD_TEXT, NULL, .when = "broken=true"),
    REAL_OF(thing, s, needed, "m/s", 0, -HUGE_VAL, HUGE_VAL, .flags = FIELD_REQUIRED),
};
static const struct field_table table = FIELD_TABLE(rows, struct thing, "thing", "");

static void must(bool truth) {
  if (!truth)
    abort();
}

static size_t walk(document_node *node, int depth) {
  const char *key;
  size_t count = 1;
  must(depth < 40);
  must(document_kind(node) != DOCUMENT_SCALAR || document_count(node) == 0);
  document_scalar(node);
  for (size_t i = 0; i < document_count(node); i++)
    count += walk(document_item(node, i, &key), depth + 1);
  return count;
}

static void judge_report(const char *report) {
  struct error error;
  must(report && *report && strlen(report) < sizeof error.message);
  for (const char *at = report; *at; at++)
    must((unsigned char)*at >= 0x20 || *at == '\n' || *at == '\t');
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  struct document *document;
  struct error error = {.status = STATUS_OK};
  struct thing thing, back;
  const char *report;
  status code = document_parse("f", (const char *)bytes, size, &document, &error);
  if (code) {
    must(code == STATUS_CONTENT && !document);
    judge_report(error.message);
    return 0;
  }
  walk(document_root(document), 0);
  field_defaults(&table, &thing);
  bool good = document_read(document_root(document), &table, (const char *const[]){"also", NULL}, &thing);
  code = document_finish(document, &report);
  must((code == STATUS_OK) == (report == NULL) && (good || code));
  if (report)
    judge_report(report);
  if (!code) {
    must(isfinite(thing.needed) && thing.length >= 0 && thing.length <= 10 && thing.law >= 0 && thing.law < 3);
    uint8_t buffer[1024];
    size_t length = field_encode(&table, &thing, buffer);
    must(field_decode(&table, buffer, length, &back) == length && strcmp(back.name, thing.name) == 0);
    char *first = field_identity(&table, &thing), *second = field_identity(&table, &back),
         *json = field_json(&table, &thing);
    must(first && second && json && strcmp(first, second) == 0);
    /* A document written as JSON after reading is itself a document (YAML 1.2 includes JSON), in SI, with the same
     * values. */
    struct document *again;
    must(document_parse("json", json, strlen(json), &again, &error) == STATUS_OK);
    document_take_si(again);
    field_defaults(&table, &back);
    must(document_read(document_root(again), &table, NULL, &back));
    char *third = field_identity(&table, &back);
    must(strcmp(first, third) == 0);
    document_free(again);
    free(first), free(second), free(third), free(json);
  }
  document_free(document);
  return 0;
}

/* A table of a few rows of all kinds, and the report of a document that is read with it. */
#pragma once

#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "schemas/document.h"
#include "schemas/rows.h"
#include "tests/support/check.h"

struct thing {
  double length, limit, speed;
  int64_t count, memory;
  bool broken;
  int law, shape;
  char name[FIELD_TEXT_SIZE];
  double needed;
};

static const char *const laws[] = {"weak", "strong", "off", NULL};
static const char *const shapes[] = {"disc", "block", NULL};
static const struct field rows[] = {
    ROW_OF(thing, shape, shape, FIELD_CHOICE, NULL, .choices = shapes, .doc = "Shape."),
    REAL_OF(thing, body.length, length, "m", 1, 0, 10, .doc = "Length."),
    REAL_OF(thing, body.limit, limit, "1", NAN, -HUGE_VAL, HUGE_VAL, .flags = FIELD_MAY_BE_OFF, .doc = "Limit."),
    ROW_OF(thing, body.count, count, FIELD_INTEGER, "1", .number = 7, .minimum = 1, .maximum = 99, .doc = "Count."),
    ROW_OF(thing, memory, memory, FIELD_INTEGER, "B", .number = 1, .minimum = -HUGE_VAL, .maximum = HUGE_VAL,
           .doc = "Memory."),
    ROW_OF(thing, broken, broken, FIELD_BOOLEAN, NULL, .number = 1, .doc = "Broken."),
    ROW_OF(thing, contact.law, law, FIELD_CHOICE, NULL, .choices = laws, .doc = "Law."),
    REAL_OF(thing, contact.speed, speed, "m/s", 0, -HUGE_VAL, HUGE_VAL, .when = "contact.law=weak|strong",
            .doc = "Speed."),
    ROW_OF(thing, name, name, FIELD_TEXT, NULL, .text = "", .doc = "Name."),
    REAL_OF(thing, block.height, needed, "m", 0, -HUGE_VAL, HUGE_VAL, .flags = FIELD_REQUIRED, .when = "shape=block",
            .doc = "Height of the block."),
};
static const struct field_table table = FIELD_TABLE(rows, struct thing, "thing", "A thing for tests.");

/* Reads a text. Returns the report (malloc'd), or NULL if the text was good. */
static char *report_of(const char *text, size_t size, struct thing *thing) {
  struct document *document;
  static const char *const also[] = {"note", NULL};
  field_defaults(&table, thing);
  status code = document_parse("a.yaml", text, size, &document, &error);
  if (code) {
    assert_int_equal(code, STATUS_CONTENT);
    assert_null(document);
    return strdup(error.message);
  }
  bool good = document_read(document_root(document), &table, also, thing);
  const char *report;
  code = document_finish(document, &report);
  assert_int_equal(code, report ? STATUS_CONTENT : STATUS_OK);
  if (!report)
    assert_true(good);
  char *copy = report ? strdup(report) : NULL;
  document_free(document);
  return copy;
}

static char *report_text(const char *text, struct thing *thing) {
  return report_of(text, strlen(text), thing);
}

/* A table of a few rows of all kinds, and the report of a document that is read with it. */
#pragma once

#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "schemas/document.h"
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
#define AT(member) .offset = offsetof(struct thing, member)
#define FINITE     .minimum = -HUGE_VAL, .maximum = HUGE_VAL
static const struct field rows[] = {
    {.path = "shape", .kind = FIELD_CHOICE, AT(shape), .choices = shapes, .doc = "Shape."},
    {.path = "body.length",
     .kind = FIELD_REAL,
     .unit = "m",
     AT(length),
     .minimum = 0,
     .maximum = 10,
     .number = 1,
     .doc = "Length."},
    {.path = "body.limit",
     .kind = FIELD_REAL,
     .unit = "1",
     AT(limit),
     FINITE,
     .number = NAN,
     .flags = FIELD_MAY_BE_OFF,
     .doc = "Limit."},
    {.path = "body.count",
     .kind = FIELD_INTEGER,
     .unit = "1",
     AT(count),
     .minimum = 1,
     .maximum = 99,
     .number = 7,
     .doc = "Count."},
    {.path = "memory", .kind = FIELD_INTEGER, .unit = "B", AT(memory), FINITE, .number = 1, .doc = "Memory."},
    {.path = "broken", .kind = FIELD_BOOLEAN, AT(broken), .number = 1, .doc = "Broken."},
    {.path = "contact.law", .kind = FIELD_CHOICE, AT(law), .choices = laws, .doc = "Law."},
    {.path = "contact.speed",
     .kind = FIELD_REAL,
     .unit = "m/s",
     AT(speed),
     FINITE,
     .when = "contact.law=weak|strong",
     .doc = "Speed."},
    {.path = "name", .kind = FIELD_TEXT, AT(name), .text = "", .doc = "Name."},
    {.path = "block.height",
     .kind = FIELD_REAL,
     .unit = "m",
     AT(needed),
     FINITE,
     .flags = FIELD_REQUIRED,
     .when = "shape=block",
     .doc = "Height of the block."},
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

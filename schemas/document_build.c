/* Builds the tree of a document from libfyaml's events. libfyaml's own document type is not used: here limits on depth,
 * size and aliases apply while the tree grows, and one report contains every duplicate key, tag and undefined alias of
 * a file. */
#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/memory.h"

/* ---- bytes that must not reach libfyaml or a terminal ---- */

/* YAML 1.2.2, 5.1: characters that are not printable there are refused. Also refused are the line ends of YAML 1.1 and
 * byte order marks inside the text, which tools treat differently. */
static const struct {
  uint32_t first, last;
} refused[] = {
    {0x00, 0x08},     {0x0B, 0x0C},     {0x0E, 0x1F}, /* all but tab, line feed and carriage return */
    {0x7F, 0x9F},     {0x2028, 0x2029},               /* U+0085, U+2028, U+2029: line ends of YAML 1.1 */
    {0xFEFF, 0xFEFF}, {0xFFFE, 0xFFFF},               /* byte order mark; noncharacters */
};

static bool is_refused(uint32_t character) {
  for (size_t k = 0; k < sizeof refused / sizeof refused[0]; k++)
    if (character >= refused[k].first && character <= refused[k].last)
      return true;
  return false;
}

size_t document_guard_text(const char *text, size_t size) {
  size_t i = 0;
  while (i < size) {
    size_t length = text_utf8_length(text + i, size - i);
    if (length == 0 || is_refused(text_utf8_character(text + i, length)))
      return i;
    i += length;
  }
  return size;
}

static void report_byte(struct document *document, size_t at) {
  const char *text = document->text + at;
  const unsigned char byte = (unsigned char)*text;
  if (byte == 0 && strncmp(document->text, "SQLite format 3", 15) == 0)
    document_report_at(document, 0, 15, NULL,
                       "this is a store (an SQLite database); a document is expected, such as a campaign");
  else if (byte == 0)
    document_report_at(document, at, at + 1, NULL, "a NUL byte: this is not text; save the file as UTF-8");
  else if (text_utf8_length(text, document->size - at) == 0)
    document_report_at(document, at, at + 1, NULL, "invalid UTF-8 (byte 0x%02x); save the file as UTF-8", byte);
  else
    document_report_at(document, at, at + 1, NULL, "a control character (first byte 0x%02x); remove it", byte);
}

/* False: an error was reported. Tabs as indentation are refused, too. */
static bool guard(struct document *document) {
  const char *text = document->text;
  const size_t size = document->size, bad = document_guard_text(text, size);
  if (bad < size) {
    report_byte(document, bad);
    return false;
  }
  bool good = true, margin = true; /* margin: only spaces since the start of the line */
  for (size_t i = 0; i < size; i++) {
    if (margin && text[i] == '\t') {
      document_report_at(document, i, i + 1, NULL, "a tab as indentation; YAML wants spaces");
      good = false;
      margin = false;
    }
    margin = text[i] == '\n' || (margin && text[i] == ' ');
  }
  return good;
}

/* ---- keys that one mapping contains twice ---- */

static int by_text(const void *a, const void *b) {
  const document_node *const *left = a, *const *right = b;
  int order = strcmp((*left)->text, (*right)->text);
  if (order)
    return order;
  return ((*left)->start > (*right)->start) - ((*left)->start < (*right)->start);
}

static void report_duplicate(document_node *key, const char *path, const document_node *first) {
  struct document *document = key->document;
  if (document->error_count >= DOCUMENT_MOST_ERRORS) {
    document->error_count++; /* only counted */
    return;
  }
  char whole[400];
  snprintf(whole, sizeof whole, "%.200s%s%.150s", path, *path ? "." : "", key->text);
  document_report(key, whole, "given twice; the first is in line %zu; remove one",
                  document_report_line(document, first->start));
}

/* Keys are sorted, not compared pairwise: a file of a hundred thousand keys must not take minutes. False: no memory. */
static bool report_duplicates(const document_node *mapping, const char *path) {
  OWNED document_node **keys = malloc((mapping->count + 1) * sizeof(document_node *));
  if (!keys)
    return false;
  for (size_t i = 0; i < mapping->count; i++)
    keys[i] = mapping->pairs[i].key;
  qsort(keys, mapping->count, sizeof *keys, by_text);
  for (size_t i = 1, first = 0; i < mapping->count; i++) {
    if (strcmp(keys[first]->text, keys[i]->text) != 0 || keys[i]->faulty || keys[first]->faulty)
      first = i;
    else
      report_duplicate(keys[i], path, keys[first]);
  }
  return true;
}

/* ---- the tree ---- */

enum { PATH_SIZE = 200 };

struct anchor {
  char *name; /* owned */
  document_node *node;
};

struct builder {
  struct document *document;
  document_node *open[DOCUMENT_DEEPEST]; /* collections being filled, outermost first */
  document_node *key[DOCUMENT_DEEPEST];  /* per level: the key whose value comes next */
  size_t depth;
  struct anchor *anchors;
  size_t anchor_count, documents;
  bool failed; /* out of memory or a limit: stop */
};

static document_node *create(struct builder *b, enum document_kind kind, const char *text, size_t length, size_t start,
                             size_t end) {
  struct document *document = b->document;
  if (document->node_count >= DOCUMENT_MOST_NODES) {
    if (!b->failed)
      document_report_at(document, start, end, NULL, "more than %d values, aliases counted as often as used; use less",
                         DOCUMENT_MOST_NODES);
    b->failed = true;
    return NULL;
  }
  document_node *node = document_node_make(document, kind, text, length);
  if (!node) {
    b->failed = true;
    return NULL;
  }
  node->start = start;
  node->end = kind == DOCUMENT_SCALAR && end > start ? end : start + 1;
  return node;
}

/* The path of the node that is being read, such as "vary.grain.density[2]". */
static const char *where(const struct builder *b, char path[PATH_SIZE]) {
  *path = 0;
  for (size_t i = 0; i < b->depth; i++) {
    if (b->open[i]->kind == DOCUMENT_SEQUENCE)
      text_append(path, PATH_SIZE, "[%zu]", b->open[i]->count);
    else if (b->key[i])
      text_append(path, PATH_SIZE, "%s%s", *path ? "." : "", b->key[i]->text);
  }
  return path;
}

/* Puts a finished node into its place: root, item, key or value. */
static void attach(struct builder *b, document_node *node) {
  if (!node)
    return;
  if (b->depth == 0) {
    b->document->root = node;
    return;
  }
  document_node *parent = b->open[b->depth - 1], **key = &b->key[b->depth - 1];
  if (parent->kind == DOCUMENT_SEQUENCE) {
    b->failed |= !document_node_append(parent, NULL, node);
    return;
  }
  if (!*key) {
    if (node->kind != DOCUMENT_SCALAR && !node->faulty) {
      document_report(node, where(b, (char[PATH_SIZE]){0}), "expected a word as key, got %s",
                      document_value_what(node));
      node->faulty = true;
    }
    *key = node;
    return;
  }
  if (node->end == node->start + 1 && node->plain && !node->text[0]) { /* empty value: mark its key */
    node->start = (*key)->start;
    node->end = (*key)->end;
  }
  b->failed |= !document_node_append(parent, *key, node);
  *key = NULL;
}

static document_node *copy(struct builder *b, const document_node *from, size_t depth) {
  if (depth >= DOCUMENT_DEEPEST) {
    document_report_at(b->document, from->start, from->end, NULL, "nested more than %d deep", DOCUMENT_DEEPEST);
    b->failed = true;
    return NULL;
  }
  document_node *node = create(b, from->kind, from->text, strlen(from->text), from->start, from->end);
  if (!node)
    return NULL;
  node->plain = from->plain;
  node->faulty = from->faulty;
  for (size_t i = 0; i < from->count && !b->failed; i++) {
    document_node *key = from->pairs[i].key ? copy(b, from->pairs[i].key, depth + 1) : NULL;
    document_node *value = copy(b, from->pairs[i].value, depth + 1);
    if (value && (key || !from->pairs[i].key))
      b->failed |= !document_node_append(node, key, value);
  }
  return node;
}

static void remember(struct builder *b, struct fy_token *token, document_node *node) {
  if (!token || !node)
    return;
  size_t length = 0;
  const char *name = fy_token_get_text(token, &length);
  const struct fy_mark *mark = fy_token_start_mark(token);
  if (!name)
    return;
  if (b->anchor_count == DOCUMENT_MOST_ANCHORS) {
    document_report_at(b->document, mark ? mark->input_pos : 0, 0, NULL, "more than %d anchors", DOCUMENT_MOST_ANCHORS);
    b->failed = true;
    return;
  }
  char *kept = strndup(name, length);
  if (!kept) {
    b->failed = true;
    return;
  }
  b->anchors[b->anchor_count++] = (struct anchor){kept, node};
}

/* The last earlier node with this anchor, or NULL. */
static document_node *anchored(const struct builder *b, const char *name, size_t length) {
  for (size_t i = b->anchor_count; i-- > 0;)
    if (strncmp(b->anchors[i].name, name, length) == 0 && !b->anchors[i].name[length])
      return b->anchors[i].node;
  return NULL;
}

static document_node *alias(struct builder *b, struct fy_token *token, size_t start, size_t end) {
  size_t length = 0;
  const char *name = fy_token_get_text(token, &length);
  const document_node *target = name ? anchored(b, name, length) : NULL;
  bool inside = false;
  for (size_t i = 0; target && i < b->depth; i++)
    inside |= b->open[i] == target;
  if (target && !inside)
    return copy(b, target, b->depth);

  char path[PATH_SIZE];
  const int shown = length < 60 ? (int)length : 60;
  where(b, path);
  if (inside)
    document_report_at(b->document, start, end, path, "alias '*%.*s' is inside what it refers to", shown, name);
  else
    document_report_at(b->document, start, end, path, "alias '*%.*s' has no anchor '&%.*s' before it", shown,
                       name ? name : "", shown, name ? name : "");
  document_node *node = create(b, DOCUMENT_SCALAR, "", 0, start, end);
  if (node)
    node->faulty = true;
  return node;
}

static document_node *scalar(struct builder *b, struct fy_token *token, size_t start, size_t end) {
  size_t length = 0;
  const char *text = token ? fy_token_get_text(token, &length) : NULL;
  if (!text)
    text = ""; /* and length is 0 */
  size_t bad = document_guard_text(text, length);
  document_node *node = create(b, DOCUMENT_SCALAR, text, bad, start, end);
  if (!node)
    return NULL;
  node->plain = !token || fy_token_scalar_style(token) == FYSS_PLAIN;
  if (bad < length) {
    document_report(node, where(b, (char[PATH_SIZE]){0}), "text with an escaped control character (0x%02x); remove it",
                    (unsigned char)text[bad]);
    node->faulty = true;
  }
  return node;
}

static void open_collection(struct builder *b, document_node *node) {
  if (!node)
    return;
  if (b->depth == DOCUMENT_DEEPEST) {
    document_report(node, NULL, "nested more than %d deep", DOCUMENT_DEEPEST);
    b->failed = true;
    return;
  }
  b->open[b->depth] = node;
  b->key[b->depth++] = NULL;
}

static void close_collection(struct builder *b, size_t end) {
  if (b->depth == 0)
    return;
  document_node *node = b->open[--b->depth];
  char first = b->document->text[node->start];
  if (end > node->start && (first == '{' || first == '['))
    node->end = end; /* for other nodes the first character is marked */
  char path[PATH_SIZE];
  if (node->kind == DOCUMENT_MAPPING && node->count > 1 && !report_duplicates(node, where(b, path)))
    b->failed = true;
  attach(b, node);
}

static void report_tag(struct builder *b, document_node *node) {
  document_report(node, where(b, (char[PATH_SIZE]){0}), "a tag; write the value without '!'");
}

/* False: this is a second document. */
static bool take_document(struct builder *b, const struct fy_event *event, size_t start, size_t end) {
  if (++b->documents > 1) {
    document_report_at(b->document, start, end, NULL, "a second document starts here; one file holds one document");
    b->failed = true;
    return false;
  }
  struct fy_document_state *state = event->document_start.document_state;
  const struct fy_version *version = fy_document_state_version_explicit(state) ? fy_document_state_version(state)
                                                                               : NULL;
  if (version && (version->major != 1 || version->minor != 2))
    document_report_at(b->document, 0, 0, NULL, "expected YAML 1.2, got a %%YAML %d.%d line; remove it", version->major,
                       version->minor);
  return true;
}

static void take_collection(struct builder *b, enum document_kind kind, struct fy_token *anchor,
                            const struct fy_token *tag, size_t start, size_t end) {
  document_node *node = create(b, kind, "", 0, start, end);
  remember(b, anchor, node);
  if (tag && node)
    report_tag(b, node);
  open_collection(b, node);
}

static void take_scalar(struct builder *b, const struct fy_event *event, size_t start, size_t end) {
  const char *text = b->document->text;
  const char before = start ? text[start - 1] : 0;
  if ((before == '"' || before == '\'') && end >= start && end < b->document->size && text[end] == before) {
    start--; /* libfyaml's marks leave out the quotes */
    end++;
  }
  document_node *node = scalar(b, event->scalar.value, start, end);
  remember(b, event->scalar.anchor, node);
  if (event->scalar.tag && node) {
    report_tag(b, node);
    node->faulty = true; /* the tag's meaning is unknown: readers skip the value */
  }
  attach(b, node);
}

/* Adds one event to the tree. False: the end of the document. */
static bool take(struct builder *b, struct fy_event *event) {
  const struct fy_mark *from = fy_event_start_mark(event), *to = fy_event_end_mark(event);
  size_t start = from ? from->input_pos : 0, end = to ? to->input_pos : start;
  switch (event->type) {
  case FYET_STREAM_END: return false;
  case FYET_DOCUMENT_START: return take_document(b, event, start, end);
  case FYET_MAPPING_START:
    take_collection(b, DOCUMENT_MAPPING, event->mapping_start.anchor, event->mapping_start.tag, start, end);
    return true;
  case FYET_SEQUENCE_START:
    take_collection(b, DOCUMENT_SEQUENCE, event->sequence_start.anchor, event->sequence_start.tag, start, end);
    return true;
  case FYET_MAPPING_END:
  case FYET_SEQUENCE_END: close_collection(b, end); return true;
  case FYET_SCALAR: take_scalar(b, event, start, end); return true;
  case FYET_ALIAS:
    if (start && b->document->text[start - 1] == '*')
      start--; /* libfyaml's mark leaves out the star */
    attach(b, alias(b, event->alias.anchor, start, end));
    return true;
  default: return true;
  }
}

static void silence(struct fy_diag *diag, void *user, const char *text, size_t length) {
  (void)diag, (void)user, (void)text, (void)length; /* libfyaml would write to stderr */
}

/* What libfyaml's commonest messages mean for an author. */
static const char *plain_words(const char *message) {
  static const char *const words[][2] =
      {{"missing comma in flow mapping", "a '{' without its '}', or a missing comma"},
       {"missing comma in flow sequence", "a '[' without its ']', or a missing comma"},
       {"flow sequence without a closing bracket", "a '[' without its ']'"},
       {"flow mapping without a closing brace", "a '{' without its '}'"},
       {"could not find expected ':'", "a key has ': ' behind it, as in 'scene: disc-explosion'"},
       {"invalid nested block mapping on the same line", "a value with ': ' in it needs quotes"},
       {"invalid multiline plain key", "wrong indentation: the keys of one level begin in the same column"},
       {"wrongly indented double-quoted scalar", "a '\"' without its second '\"'"},
       {"double-quoted scalar without closing quote", "a '\"' without its second '\"'"},
       {NULL, NULL}};
  size_t k = 0;
  while (words[k][0] && strcmp(words[k][0], message) != 0)
    k++;
  return words[k][0] ? words[k][1] : message;
}

/* Reports libfyaml's message about the first thing it could not read. */
static void report_syntax(struct document *document, struct fy_diag *diag) {
  void *previous = NULL;
  const struct fy_diag_error *error = fy_diag_errors_iterate(diag, &previous);
  if (!error) {
    document_report_at(document, 0, 0, NULL, "no valid YAML");
    return;
  }
  size_t offset = 0;
  for (int line = 1; line < error->line && offset < document->size; offset++)
    line += document->text[offset] == '\n';
  for (int column = 1; column < error->column && offset < document->size && document->text[offset] != '\n'; column++)
    do
      offset++;
    while (offset < document->size && ((unsigned char)document->text[offset] & 0xC0) == 0x80);
  document_report_at(document, offset, 0, NULL, "no valid YAML: %s", plain_words(error->msg));
}

static status take_all(struct builder *b, struct fy_parser *parser, struct fy_diag *diag) {
  for (bool more = true; more && !b->failed;) {
    struct fy_event *event = fy_parser_parse(parser);
    if (!event) {
      report_syntax(b->document, diag);
      return STATUS_CONTENT;
    }
    more = take(b, event);
    fy_parser_event_free(parser, event);
  }
  if (!b->failed)
    return STATUS_OK;
  return b->document->error_count ? STATUS_CONTENT : STATUS_MEMORY;
}

static status check_root(struct document *document) {
  const document_node *root = document->root;
  if (root && root->kind == DOCUMENT_MAPPING)
    return STATUS_OK;
  if (!root || (root->kind == DOCUMENT_SCALAR && root->plain && !root->text[0]))
    document_report_at(document, 0, 0, NULL, "the document is empty; expected keys and values, such as 'name: first'");
  else
    document_report_at(document, root->start, root->end, NULL,
                       "expected keys and values, such as 'name: first', got %s", document_value_what(root));
  return STATUS_CONTENT;
}

status document_build(struct document *document) {
  if (!guard(document))
    return STATUS_CONTENT;
  status code = STATUS_MEMORY;
  struct builder b = {.document = document};
  struct fy_diag_cfg quiet;
  struct fy_parser *parser = NULL;
  fy_diag_cfg_default(&quiet);
  quiet.fp = NULL;
  quiet.output_fn = silence;
  struct fy_diag *diag = fy_diag_create(&quiet);
  if (diag)
    fy_diag_set_collect_errors(diag, true);
  b.anchors = memory_small(DOCUMENT_MOST_ANCHORS, sizeof *b.anchors);
  if (diag)
    parser = fy_parser_create(
        &(struct fy_parse_cfg){.flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG | FYPCF_JSON_NONE | FYPCF_DEFAULT_VERSION_1_2,
                               .diag = diag});
  if (!parser || fy_parser_set_string(parser, document->text, document->size) != 0)
    goto cleanup;

  code = take_all(&b, parser, diag);
  if (!code)
    code = check_root(document);
cleanup:
  for (size_t i = 0; i < b.anchor_count; i++)
    free(b.anchors[i].name);
  free(b.anchors);
  fy_parser_destroy(parser);
  fy_diag_destroy(diag);
  return code;
}

/* Names and units of quantities for the axes of charts. */
#include "schemas/field.h"
#include "schemas/text.h"

#include <string.h>

void field_label_path(const char *path, char *label, size_t size) {
  const char *from = strrchr(path, '.'); /* the last two parts of the path */
  while (from && from > path && from[-1] != '.')
    from--;
  if (!from)
    from = path;
  size_t used = 0;
  for (; *from && used + 1 < size; from++)
    label[used++] = *from == '.' || *from == '_' ? ' ' : *from;
  if (size)
    label[used] = '\0';
}

void field_label(const struct field *row, char *label, size_t size) {
  if (row->label)
    snprintf(label, size, "%s", row->label);
  else
    field_label_path(row->path, label, size);
}

void field_label_unit(const char *unit, char *text, size_t size) {
  static const char *const raised[] = {"\xe2\x81\xb0", "\xc2\xb9",     "\xc2\xb2",     "\xc2\xb3",     "\xe2\x81\xb4",
                                       "\xe2\x81\xb5", "\xe2\x81\xb6", "\xe2\x81\xb7", "\xe2\x81\xb8", "\xe2\x81\xb9"};
  text[0] = '\0';
  if (!unit || strcmp(unit, "1") == 0)
    return;
  while (*unit) {
    const size_t plain = strcspn(unit, "^");
    if (plain == 0 && unit[1] >= '0' && unit[1] <= '9') {
      text_append(text, size, "%s", raised[unit[1] - '0']);
      unit += 2;
    } else {
      text_append(text, size, "%.*s", plain ? (int)plain : 1, unit);
      unit += plain ? plain : 1;
    }
  }
}

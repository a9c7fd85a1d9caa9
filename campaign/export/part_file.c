/* Writes a file under another name first. */
#include "campaign/export/part_file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static status cannot_write(const char *path, struct error *error) {
  return status_fail(error, STATUS_IO, "cannot write %s: %s", path, strerror(errno));
}

status part_file_open(struct part_file *file, const char *path, struct error *error) {
  struct stat there;
  file->in_place = stat(path, &there) == 0 && !S_ISREG(there.st_mode) && !S_ISDIR(there.st_mode);
  if (snprintf(file->path, sizeof file->path, "%s", path) >= (int)sizeof file->path)
    return status_fail(error, STATUS_USAGE, "the target's name is too long");
  snprintf(file->temporary, sizeof file->temporary, "%s%s", file->path, file->in_place ? "" : ".part");
  file->out = fopen(file->temporary, "w");
  return file->out ? STATUS_OK : cannot_write(file->temporary, error);
}

/* Puts the file's name before the message. */
static void name_file(const struct part_file *file, struct error *error) {
  struct error why = *error;
  status_fail(error, STATUS_IO, "%s: %s", file->path, why.message);
}

status part_file_close(struct part_file *file, status code, struct error *error) {
  if (code == STATUS_IO && error)
    name_file(file, error);
  const bool closed = fclose(file->out) == 0;
  if (!code && !closed)
    code = cannot_write(file->temporary, error);
  if (file->in_place)
    return code;
  if (!code && rename(file->temporary, file->path))
    code = cannot_write(file->path, error);
  if (code)
    remove(file->temporary);
  return code;
}

status part_file_folder(const char *folder, struct error *error) {
  if (mkdir(folder, 0777) == 0 || errno == EEXIST)
    return STATUS_OK;
  return status_fail(error, STATUS_IO, "cannot make the folder %s: %s", folder, strerror(errno));
}

/* Finds the shared memory of Open MPI that no process uses. */
#include "campaign/farm/leftovers.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define SHARED_MEMORY "/dev/shm"

enum { MOST = 512, NAME = 256, LEAST_AGE_S = 60 };

struct leftovers {
  char names[MOST][NAME];
  bool mapped[MOST];
  size_t count;
};

/* Names are vader_segment.HOST.USER.JOB.RANK (Open MPI 4) or sm_segment.HOST... (5). */
static bool is_segment_of(const char *name, const char *host) {
  static const char *const heads[] = {"vader_segment.", "sm_segment."};
  for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
    const size_t head = strlen(heads[i]), length = strlen(host);
    if (strncmp(name, heads[i], head) == 0 && strncmp(name + head, host, length) == 0 && name[head + length] == '.')
      return true;
  }
  return false;
}

/* A segment that is young may belong to a rank that is just starting. */
static bool is_old_and_own(int folder, const char *name) {
  struct stat file;
  return fstatat(folder, name, &file, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(file.st_mode) && file.st_uid == geteuid() &&
         time(NULL) - file.st_mtime >= LEAST_AGE_S;
}

static void find_segments(DIR *folder, struct leftovers *found) {
  char host[HOST_NAME_MAX + 1] = "";
  if (gethostname(host, sizeof host - 1) != 0)
    return;
  for (const struct dirent *entry; found->count < MOST && (entry = readdir(folder));) {
    if (strlen(entry->d_name) < NAME && is_segment_of(entry->d_name, host) &&
        is_old_and_own(dirfd(folder), entry->d_name))
      snprintf(found->names[found->count++], NAME, "%s", entry->d_name);
  }
}

static void mark_mapped(struct leftovers *found, const char *path) {
  for (size_t i = 0; i < found->count; i++)
    found->mapped[i] = found->mapped[i] || strcmp(found->names[i], path) == 0;
}

/* A process whose mappings are not readable has other rights than this one: it is not one of our ranks. */
static void look_into(const char *process, struct leftovers *found) {
  char path[300], line[4096 + 200];
  snprintf(path, sizeof path, "/proc/%s/maps", process);
  FILE *maps = fopen(path, "r");
  if (!maps)
    return;
  while (fgets(line, sizeof line, maps)) {
    const char *file = strstr(line, SHARED_MEMORY "/");
    line[strcspn(line, "\n")] = '\0';
    if (file)
      mark_mapped(found, file + sizeof SHARED_MEMORY);
  }
  fclose(maps);
}

static bool look_into_all(struct leftovers *found) {
  DIR *processes = opendir("/proc");
  if (!processes)
    return false;
  for (const struct dirent *entry; (entry = readdir(processes));)
    if (entry->d_name[0] >= '1' && entry->d_name[0] <= '9')
      look_into(entry->d_name, found);
  closedir(processes);
  return true;
}

void farm_leftovers_remove(void) {
  DIR *folder = opendir(SHARED_MEMORY);
  struct leftovers *found = folder ? calloc(1, sizeof *found) : NULL;
  if (found)
    find_segments(folder, found);
  if (found && found->count > 0 && look_into_all(found))
    for (size_t i = 0; i < found->count; i++)
      if (!found->mapped[i])
        unlinkat(dirfd(folder), found->names[i], 0);
  free(found);
  if (folder)
    closedir(folder);
}

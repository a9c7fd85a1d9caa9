/* Non-blocking messages between ranks: collects frames, sends, receives, finalizes MPI. */
#include "campaign/farm/farm_private.h"
#include "schemas/limits.h"
#include "schemas/memory.h"

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <glob.h>
#include <limits.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define TAG             1
#define LARGEST_MESSAGE ((size_t)1 << 24) /* frames are collected up to this; a larger frame goes alone */

struct message {
  struct message *next;
  MPI_Request request;
  int rank;
  struct farm_bytes bytes;
};

struct farm_link {
  int rank, ranks;
  struct farm_bytes *out;                    /* per rank, not yet sent */
  struct message *sending;                   /* in flight, any order */
  struct message *arriving, **arriving_last; /* in the order of arrival */
};

#ifdef OPEN_MPI
/* True when a folder has Open MPI components for PMIx, but none for PMI-1 (s1) or PMI-2 (s2). */
static bool lacks_pmi(const char *folder) {
  char pmix[LIMITS_PATH], s1[LIMITS_PATH + 104], s2[LIMITS_PATH + 104];
  glob_t found;
  snprintf(pmix, sizeof pmix, "%s/mca_pmix_*.so", folder);
  snprintf(s1, sizeof s1, "%s/mca_pmix_s1.so", folder);
  snprintf(s2, sizeof s2, "%s/mca_pmix_s2.so", folder);
  const bool any = glob(pmix, 0, NULL, &found) == 0;
  if (any)
    globfree(&found);
  return any && access(s1, F_OK) != 0 && access(s2, F_OK) != 0;
}

bool farm_link_knows_pmi(void) {
  static const char *const folders[] = {"openmpi", "openmpi3", "openmpi/lib/openmpi3"}; /* beside the library */
  char folder[4000];
  Dl_info library;
  if (!dladdr((void *)MPI_Init_thread, &library) || !strchr(library.dli_fname, '/'))
    return true;
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
    snprintf(folder, sizeof folder, "%.*s/%s", (int)(strrchr(library.dli_fname, '/') - library.dli_fname),
             library.dli_fname, folders[i]);
    if (lacks_pmi(folder))
      return false;
  }
  return true; /* if the components are in one file, this is not known */
}
#else
bool farm_link_knows_pmi(void) {
  return true;
}
#endif

status farm_link_open(struct farm_link **out, int *rank, int *ranks, struct error *error) {
  int provided, initialised = 0;
  MPI_Initialized(&initialised);
  if (!initialised && MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS)
    return status_fail(error, STATUS_MEMORY, "MPI_Init failed: start with mpirun or srun --mpi=pmix");
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  struct farm_link *link = memory_small(1, sizeof *link);
  MPI_Comm_rank(MPI_COMM_WORLD, &link->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &link->ranks);
  link->arriving_last = &link->arriving;
  link->out = calloc((size_t)link->ranks, sizeof *link->out);
  if (!link->out) {
    free(link);
    return status_fail(error, STATUS_MEMORY, "no memory for the farm");
  }
  *rank = link->rank;
  *ranks = link->ranks;
  *out = link;
  return STATUS_OK;
}

static status post(struct farm_link *link, int rank, struct error *error) {
  struct farm_bytes *const out = &link->out[rank];
  if (out->begin == out->end)
    return STATUS_OK;
  struct message *message = calloc(1, sizeof *message);
  if (!message)
    return status_fail(error, STATUS_MEMORY, "no memory for a message to rank %d", rank);
  message->bytes = *out;
  message->rank = rank;
  *out = (struct farm_bytes){0};
  if (MPI_Isend(message->bytes.data + message->bytes.begin, (int)(message->bytes.end - message->bytes.begin), MPI_BYTE,
                rank, TAG, MPI_COMM_WORLD, &message->request) != MPI_SUCCESS) {
    farm_frame_free(&message->bytes);
    free(message);
    return status_fail(error, STATUS_INTERNAL, "MPI cannot send to rank %d", rank);
  }
  message->next = link->sending;
  link->sending = message;
  return STATUS_OK;
}

status farm_link_send(struct farm_link *link, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                      const struct iovec *part, struct error *error) {
  struct farm_bytes *const out = &link->out[rank];
  size_t size = 0;
  for (int i = 0; i < parts; i++)
    size += part[i].iov_len;
  if (out->end - out->begin + size > LARGEST_MESSAGE) {
    const status posted = post(link, rank, error);
    if (posted != STATUS_OK)
      return posted;
  }
  if (farm_frame_append(out, kind, 0, handle, parts, part))
    return STATUS_OK;
  return status_fail(error, STATUS_MEMORY, "no memory for a message of %zu bytes to rank %d", size, rank);
}

status farm_link_flush(struct farm_link *link, struct error *error) {
  for (int rank = 0; rank < link->ranks; rank++) {
    const status posted = post(link, rank, error);
    if (posted != STATUS_OK)
      return posted;
  }
  return STATUS_OK;
}

static bool done(struct message *message) {
  int flag = 0;
  return MPI_Test(&message->request, &flag, MPI_STATUS_IGNORE) == MPI_SUCCESS && flag;
}

static status receive(struct farm_link *link, bool *any, struct error *error) {
  int flag = 0, size = 0;
  MPI_Status from;
  *any = false;
  if (MPI_Iprobe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &flag, &from) != MPI_SUCCESS)
    return status_fail(error, STATUS_INTERNAL, "MPI_Iprobe failed");
  if (!flag)
    return STATUS_OK;
  MPI_Get_count(&from, MPI_BYTE, &size);
  struct message *message = calloc(1, sizeof *message);
  if (!message || size < 0 || !farm_frame_reserve(&message->bytes, (size_t)size + 1)) {
    free(message);
    return status_fail(error, STATUS_MEMORY, "no memory for a message of %d bytes from rank %d", size, from.MPI_SOURCE);
  }
  message->rank = from.MPI_SOURCE;
  message->bytes.end = (size_t)size;
  if (MPI_Irecv(message->bytes.data, size, MPI_BYTE, from.MPI_SOURCE, TAG, MPI_COMM_WORLD, &message->request) !=
      MPI_SUCCESS) {
    farm_frame_free(&message->bytes);
    free(message);
    return status_fail(error, STATUS_INTERNAL, "MPI cannot receive from rank %d", from.MPI_SOURCE);
  }
  *link->arriving_last = message;
  link->arriving_last = &message->next;
  *any = true;
  return STATUS_OK;
}

/* an earlier message of this rank has not arrived completely */
static bool overtakes(const struct farm_link *link, const struct message *message) {
  for (const struct message *before = link->arriving; before != message; before = before->next)
    if (before->rank == message->rank)
      return true;
  return false;
}

static int drop_sent(struct farm_link *link) {
  int count = 0;
  for (struct message **at = &link->sending; *at;) {
    struct message *message = *at;
    if (!done(message)) {
      at = &message->next;
      continue;
    }
    *at = message->next;
    farm_frame_free(&message->bytes);
    free(message);
    count++;
  }
  return count;
}

/* Hands out the frames of a message that has arrived. */
static status give(struct message *message, farm_link_take take, void *context, struct error *error) {
  struct farm_frame frame;
  const uint8_t *payload;
  int got = 0;
  while ((got = farm_frame_next(&message->bytes, &frame, &payload)) == 1) {
    const status result = take(context, message->rank, &frame, payload, error);
    if (result != STATUS_OK)
      return result;
  }
  if (got == 0 && message->bytes.begin == message->bytes.end)
    return STATUS_OK;
  return status_fail(error, STATUS_INTERNAL,
                     "rank %d sent a message this rank cannot read: do all ranks run the same version of clast?",
                     message->rank);
}

/* Takes the message at *at out of the list. */
static struct message *take_out(struct farm_link *link, struct message **at) {
  struct message *message = *at;
  *at = message->next;
  if (link->arriving_last == &message->next)
    link->arriving_last = at;
  return message;
}

static status receive_all(struct farm_link *link, struct error *error) {
  status result = STATUS_OK;
  for (bool any = true; any && result == STATUS_OK;)
    result = receive(link, &any, error);
  return result;
}

status farm_link_drain(struct farm_link *link, farm_link_take take, void *context, int *count, struct error *error) {
  *count = drop_sent(link);
  status result = receive_all(link, error);
  for (struct message **at = &link->arriving; result == STATUS_OK && *at;) {
    if (overtakes(link, *at) || !done(*at)) {
      at = &(*at)->next;
      continue;
    }
    struct message *message = take_out(link, at);
    ++*count;
    result = give(message, take, context, error);
    farm_frame_free(&message->bytes);
    free(message);
  }
  return result;
}

void farm_link_close(struct farm_link *link, bool together, int exit_code) {
  if (!link)
    return;
  if (!together) {
    fflush(NULL);
    MPI_Abort(MPI_COMM_WORLD, exit_code);
  }
  MPI_Finalize();
  for (int rank = 0; rank < link->ranks; rank++)
    farm_frame_free(&link->out[rank]);
  while (link->sending) {
    struct message *message = link->sending;
    link->sending = message->next;
    farm_frame_free(&message->bytes);
    free(message);
  }
  while (link->arriving) {
    struct message *message = link->arriving;
    link->arriving = message->next;
    farm_frame_free(&message->bytes);
    free(message);
  }
  free(link->out);
  free(link);
}

/* ---- Finds the shared memory of Open MPI that no process uses ---- */

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
  char path[300], line[LIMITS_PATH + 200];
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

/* Non-blocking messages between ranks: collects frames, sends, receives, finalizes MPI. */
#include "campaign/farm/farm_private.h"
#include "schemas/memory.h"

#include <dlfcn.h>
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
#include <utlist.h>

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
  struct farm_bytes *out;   /* per rank, not yet sent */
  struct message *sending;  /* in flight, any order */
  struct message *arriving; /* in the order of arrival */
};

#ifdef OPEN_MPI
static bool has_files(const char *folder, const char *pattern) {
  char path[LIMITS_PATH];
  glob_t found;
  snprintf(path, sizeof path, "%s/%s", folder, pattern);
  const bool any = glob(path, 0, NULL, &found) == 0;
  if (any)
    globfree(&found);
  return any;
}

bool farm_link_knows_pmi(void) {
  static const char *const folders[] = {"openmpi", "openmpi3", "openmpi/lib/openmpi3"}; /* beside the library */
  char folder[LIMITS_PATH - 20];
  Dl_info library;
  if (!dladdr((void *)MPI_Init_thread, &library) || !strchr(library.dli_fname, '/'))
    return true;
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
    snprintf(folder, sizeof folder, "%.*s/%s", (int)(strrchr(library.dli_fname, '/') - library.dli_fname),
             library.dli_fname, folders[i]);
    if (has_files(folder, "mca_pmix_*.so") && !has_files(folder, "mca_pmix_s[12].so"))
      return false; /* components for PMIx, but none for PMI-1 (s1) or PMI-2 (s2) */
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

static void free_message(struct message *message) {
  farm_frame_free(&message->bytes);
  free(message);
}

static status post(struct farm_link *link, int rank, struct error *error) {
  struct farm_bytes *const out = &link->out[rank];
  if (out->begin == out->end)
    return STATUS_OK;
  struct message *message = memory_small(1, sizeof *message);
  message->bytes = *out;
  message->rank = rank;
  *out = (struct farm_bytes){0};
  if (MPI_Isend(message->bytes.data + message->bytes.begin, (int)(message->bytes.end - message->bytes.begin), MPI_BYTE,
                rank, TAG, MPI_COMM_WORLD, &message->request) != MPI_SUCCESS) {
    free_message(message);
    return status_fail(error, STATUS_INTERNAL, "MPI cannot send to rank %d", rank);
  }
  LL_PREPEND(link->sending, message);
  return STATUS_OK;
}

status farm_link_send(struct farm_link *link, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                      const struct iovec *part, struct error *error) {
  struct farm_bytes *const out = &link->out[rank];
  size_t size = 0;
  for (int i = 0; i < parts; i++)
    size += part[i].iov_len;
  if (out->end - out->begin + size > LARGEST_MESSAGE)
    TRY(post(link, rank, error));
  if (farm_frame_append(out, kind, 0, handle, parts, part))
    return STATUS_OK;
  return status_fail(error, STATUS_MEMORY, "no memory for a message of %zu bytes to rank %d", size, rank);
}

status farm_link_flush(struct farm_link *link, struct error *error) {
  for (int rank = 0; rank < link->ranks; rank++)
    TRY(post(link, rank, error));
  return STATUS_OK;
}

static bool done(struct message *message) {
  int flag = 0;
  return MPI_Test(&message->request, &flag, MPI_STATUS_IGNORE) == MPI_SUCCESS && flag;
}

/* Begins to receive every message that has been announced. */
static status receive_all(struct farm_link *link, struct error *error) {
  for (;;) {
    int flag = 0, size = 0;
    MPI_Status from;
    if (MPI_Iprobe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &flag, &from) != MPI_SUCCESS)
      return status_fail(error, STATUS_INTERNAL, "MPI_Iprobe failed");
    if (!flag)
      return STATUS_OK;
    MPI_Get_count(&from, MPI_BYTE, &size);
    struct message *message = memory_small(1, sizeof *message);
    if (size < 0 || !farm_frame_reserve(&message->bytes, (size_t)size + 1)) {
      free(message);
      return status_fail(error, STATUS_MEMORY, "no memory for a message of %d bytes from rank %d", size,
                         from.MPI_SOURCE);
    }
    message->rank = from.MPI_SOURCE;
    message->bytes.end = (size_t)size;
    if (MPI_Irecv(message->bytes.data, size, MPI_BYTE, from.MPI_SOURCE, TAG, MPI_COMM_WORLD, &message->request) !=
        MPI_SUCCESS) {
      free_message(message);
      return status_fail(error, STATUS_INTERNAL, "MPI cannot receive from rank %d", from.MPI_SOURCE);
    }
    LL_APPEND(link->arriving, message);
  }
}

/* an earlier message of this rank has not arrived completely */
static bool overtakes(const struct farm_link *link, const struct message *message) {
  for (const struct message *before = link->arriving; before != message; before = before->next)
    if (before->rank == message->rank)
      return true;
  return false;
}

/* Hands out the frames of a message that has arrived. */
static status give(struct message *message, farm_link_take take, void *context, struct error *error) {
  struct farm_frame frame;
  const uint8_t *payload;
  int got = 0;
  while ((got = farm_frame_next(&message->bytes, &frame, &payload)) == 1)
    TRY(take(context, message->rank, &frame, payload, error));
  if (got == 0 && message->bytes.begin == message->bytes.end)
    return STATUS_OK;
  return status_fail(error, STATUS_INTERNAL,
                     "rank %d sent a message this rank cannot read: do all ranks run the same version of clast?",
                     message->rank);
}

status farm_link_drain(struct farm_link *link, farm_link_take take, void *context, int *count, struct error *error) {
  struct message *message, *next;
  *count = 0;
  LL_FOREACH_SAFE(link->sending, message, next) {
    if (!done(message))
      continue;
    LL_DELETE(link->sending, message);
    free_message(message);
    ++*count;
  }
  status result = receive_all(link, error);
  LL_FOREACH_SAFE(link->arriving, message, next) {
    if (result != STATUS_OK || overtakes(link, message) || !done(message))
      continue;
    LL_DELETE(link->arriving, message);
    ++*count;
    result = give(message, take, context, error);
    free_message(message);
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
  struct message *message, *next;
  LL_CONCAT(link->sending, link->arriving);
  LL_FOREACH_SAFE(link->sending, message, next) {
    free_message(message);
  }
  free(link->out);
  free(link);
}

/* ---- Finds the shared memory of Open MPI that no process uses ---- */

#define SHARED_MEMORY "/dev/shm/"

enum { LEAST_AGE_S = 60 };

/* A segment that is young may belong to a rank that is just starting. */
static bool is_old_and_own(const char *path) {
  struct stat file;
  return lstat(path, &file) == 0 && S_ISREG(file.st_mode) && file.st_uid == geteuid() &&
         time(NULL) - file.st_mtime >= LEAST_AGE_S;
}

/* Makes the names of the segments that a process has mapped empty. A process whose mappings are not readable has other
 * rights than this one: it is not one of our ranks. */
static void leave_mapped(const char *mappings, glob_t *segments) {
  char line[LIMITS_PATH + 200];
  FILE *maps = fopen(mappings, "r");
  while (maps && fgets(line, sizeof line, maps)) {
    const char *file = strstr(line, SHARED_MEMORY);
    line[strcspn(line, "\n")] = '\0';
    for (size_t i = 0; file && i < segments->gl_pathc; i++)
      if (strcmp(segments->gl_pathv[i], file) == 0)
        segments->gl_pathv[i][0] = '\0';
  }
  if (maps)
    fclose(maps);
}

/* Names are vader_segment.HOST.USER.JOB.RANK (Open MPI 4) or sm_segment.HOST... (5). */
void farm_leftovers_remove(void) {
  char host[HOST_NAME_MAX + 1] = "", names[HOST_NAME_MAX + 60];
  glob_t segments, processes;
  if (gethostname(host, sizeof host - 1) != 0)
    return;
  snprintf(names, sizeof names, SHARED_MEMORY "{vader,sm}_segment.%s.*", host);
  if (glob(names, GLOB_BRACE, NULL, &segments) != 0)
    return;
  if (glob("/proc/[1-9]*/maps", 0, NULL, &processes) == 0) {
    for (size_t i = 0; i < processes.gl_pathc; i++)
      leave_mapped(processes.gl_pathv[i], &segments);
    for (size_t i = 0; i < segments.gl_pathc; i++)
      if (segments.gl_pathv[i][0] && is_old_and_own(segments.gl_pathv[i]))
        unlink(segments.gl_pathv[i]);
    globfree(&processes);
  }
  globfree(&segments);
}

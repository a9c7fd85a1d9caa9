/* A store as a file: its place and lock, opening and closing, upgrades, copies, batches and sessions. */
#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <time.h>
#include <unistd.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "schemas/clock.h"
#include "schemas/file.h"
#include "schemas/memory.h"

#define ENDS_S  4.0  /* an opening for writing waits so long for another clast to end */
#define ALONE_S 10.0 /* SQLite waits so long for another program where no function was given to store_on_wait() */
#define TOLD_S  1.0

/* ---- the place: names that are no files, a file that is moved while it is written, a copy without its -wal file ----
 */

/* Of the writer's lock. SQLite locks bytes 0x40000000 to 0x400001ff, for any size of the file. */
static const off_t LOCK_BYTE = (off_t)1 << 62;

const char *store_name_refused(const char *path) {
  if (!*path)
    return "a store needs a file name";
  if (strcmp(path, ":memory:") == 0 || strncmp(path, "file:", 5) == 0)
    return "SQLite takes this name for memory or a URI, and the results would be lost: name a plain file "
           "(./ before the name makes it one)";
  if (file_is_companion(path))
    return "SQLite keeps its journals under names with this ending: give the store another name";
  return NULL;
}

/* Does the journal name a super-journal? It ends with the sum and length of that name and these 8 bytes (SQLite's file
 * format, 3.0). clast writes none. SQLite deletes the file of that name when it rolls the journal back. */
static bool names_another_file(const char *journal) {
  static const unsigned char magic[8] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
  unsigned char tail[sizeof magic] = {0};
  const int file = open(journal, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0)
    return false;
  const bool whole = lseek(file, -(off_t)sizeof tail, SEEK_END) > 0 &&
                     read(file, tail, sizeof tail) == (ssize_t)sizeof tail;
  close(file);
  return whole && memcmp(tail, magic, sizeof magic) == 0;
}

static status check_beside(const char *name, struct error *error) {
  struct stat file;
  if (lstat(name, &file) != 0)
    return STATUS_OK;
  if (!S_ISREG(file.st_mode))
    return status_fail(error, STATUS_IO, "%s is a folder, link, pipe, socket or device: remove it.", name);
  if (!names_another_file(name))
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "%s is no journal of clast: it names a file, which SQLite would delete. Remove it, and do not "
                     "trust the store beside it.",
                     name);
}

/* Checks the files that SQLite opens beside the store. */
static status check_companions(const char *path, struct error *error) {
  char *real = realpath(path, NULL), *name = NULL; /* SQLite follows links to the store */
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && file_companions[i]; i++) {
    if (asprintf(&name, "%s%s", real ? real : path, file_companions[i]) < 0)
      break;
    result = check_beside(name, error);
    free(name);
  }
  free(real);
  return result;
}

/* SQLite opens no file whose path, from / on and with its journal's ending, is longer than its limit (512 bytes on
 * Unix), and does not say so. Nor does a folder take a name that is too long with that ending. */
static status check_length(const char *path, struct error *error) {
  sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
  char full[LIMITS_PATH] = "";
  const size_t ending = strlen("-journal"), most = (size_t)vfs->mxPathname - ending, longest = NAME_MAX - ending;
  if ((vfs->xFullPathname(vfs, path, LIMITS_PATH, full) & 0xff) != SQLITE_OK)
    return STATUS_OK; /* opening it reports other faults */
  const char *slash = strrchr(full, '/'), *name = slash ? slash + 1 : full;
  if (strlen(name) > longest)
    return status_fail(error, STATUS_IO,
                       "%s: its name has %zu bytes, and with the endings of SQLite's journals at most %zu fit. Name "
                       "a store with a shorter name (`--store FILE`).",
                       path, strlen(name), longest);
  if (strlen(full) <= most)
    return STATUS_OK;
  return status_fail(
      error, STATUS_IO,
      "%s: its path from / on has %zu bytes, and SQLite opens files with at most %zu. Name a store in a folder "
      "with a shorter path (`--store FILE`), or move the folder.",
      path, strlen(full), most);
}

/* Locks of SQLite's kind. Without them SQLite waits, then says that another program holds the file. */
static status check_locks(const char *path, struct error *error) {
  struct flock lock = {.l_type = F_RDLCK, .l_whence = SEEK_SET, .l_start = LOCK_BYTE + 1, .l_len = 1};
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (file < 0)
    return STATUS_OK;
  const int why = fcntl(file, F_SETLK, &lock) == 0 ? 0 : errno;
  close(file);
  if (why == 0 || why == EACCES || why == EAGAIN || why == EINTR)
    return STATUS_OK;
  return status_fail(error, STATUS_IO,
                     "%s: the file system of the store has no locks: %s. Copy the store to a local disk, with its -wal "
                     "file if it has one, and use it there.",
                     path, strerror(why));
}

/* A second name of a store in use. SQLite finds the journals by the name that the store was opened with. */
static status check_second_name(const char *path, bool lacks_wal, struct error *error) {
  struct stat file;
  if (!lacks_wal || stat(path, &file) != 0 || file.st_nlink < 2)
    return STATUS_OK;
  return status_fail(error, STATUS_IO,
                     "%s has another name (a hard link), and is in use under that one, or a program was stopped there: "
                     "use that name. Nothing was changed.",
                     path);
}

status store_check_folder(const struct store *store, struct error *error) {
  struct stat file;
  STATEMENT rows = NULL;
  bool any = false, here = false;
  if (stat(store->path, &file) != 0 || file.st_nlink < 2)
    return STATUS_OK;
  status result = sql_prepare(store->db, "SELECT fields_path FROM run WHERE fields_path IS NOT NULL", &rows, "opening",
                              error);
  for (; !here && sql_next(rows, &result, "opening", error); any = true)
    here = paths_readable(store->path, sql_text(rows, 0));
  if (result != STATUS_OK || here || !any)
    return result;
  return status_fail(error, STATUS_IO,
                     "%s has another name (a hard link), and none of its fields files is found from this folder: use "
                     "the name in the folder of its fields (a symbolic link may lead there). Nothing was changed.",
                     store->path);
}

/* A file or a free path? Opening a pipe would block. */
static status check_file(const char *path, struct error *error) {
  struct stat file;
  TRY(check_length(path, error));
  if (stat(path, &file) != 0)
    return check_companions(path, error);
  if (S_ISREG(file.st_mode)) {
    TRY(check_companions(path, error));
    return check_locks(path, error);
  }
  return status_fail(error, STATUS_IO, "%s is a %s: name the store's file.", path,
                     S_ISDIR(file.st_mode) ? "folder" : "pipe, socket or device");
}

/* Is the open file still at its path? Data written elsewhere would be lost. */
static status check_place(sqlite3 *db, const char *path, struct error *error) {
  int moved = 0;
  if (sqlite3_file_control(db, "main", SQLITE_FCNTL_HAS_MOVED, &moved) != SQLITE_OK || !moved)
    return STATUS_OK;
  return status_fail(error, STATUS_IO,
                     "%s was moved, removed or replaced while clast wrote it: clast stores nothing more. The original "
                     "file has all committed runs. Put it back, and give the same command again.",
                     path);
}

/* Bytes 18 and 19 of a database are its write and read version: 2 is WAL mode (SQLite's file format, 1.3.3). */
static bool in_wal_mode(const char *path) {
  unsigned char head[20] = {0};
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return false;
  const bool whole = read(file, head, sizeof head) == (ssize_t)sizeof head;
  close(file);
  return whole && memcmp(head, "SQLite format 3", 16) == 0 && head[18] == 2 && head[19] == 2;
}

/* Is the file in WAL mode, with no or an empty FILE-wal beside it? Asked before SQLite opens the file, which may create
 * one. This is the state of a store that was copied without its FILE-wal while it was being written. */
static bool lacks_wal(const char *path) {
  struct stat wal;
  char *name = NULL;
  if (!in_wal_mode(path) || asprintf(&name, "%s-wal", path) < 0)
    return false;
  const bool lacks = stat(name, &wal) != 0 || wal.st_size == 0;
  free(name);
  return lacks;
}

/* ---- the writer's lock: an open-file-description lock (fcntl(2), F_OFD_SETLK) on a byte of the store far beyond those
 * that SQLite locks. It ends with the process, leaves no file, and does not affect readers. A traditional record lock
 * would not work: when SQLite unlocks the file, all record locks of the process on it are dropped ---- */

static const char *remedy_of(int code) {
  switch (code) {
  case ENOENT: return "Make its folder first.";
  case EISDIR: return "It is a folder: name a file.";
  case ENOTDIR: return "Part of the path is a file, not a folder.";
  case ENOSPC: return "Free some space.";
  case EROFS: return "The file system is read-only: copy the store elsewhere, or name another file.";
  default: return "Give yourself write permission on the file and its folder, or name another file.";
  }
}

/* Opens the file (created when absent) and locks it. Close *descriptor after SQLite has closed the file: closing any
 * descriptor of a file drops SQLite's record locks on it. *held: another process holds the lock. */
static status take_lock(const char *path, int *descriptor, bool *held, struct error *error) {
  *held = false;
  *descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (*descriptor < 0)
    return status_fail(error, STATUS_IO, "%s: cannot open the store for writing: %s. %s", path, strerror(errno),
                       remedy_of(errno));
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCK_BYTE, .l_len = 1};
  if (fcntl(*descriptor, F_OFD_SETLK, &lock) == 0)
    return STATUS_OK;
  *held = errno == EACCES || errno == EAGAIN;
  status result = *held ? status_fail(error, STATUS_IO, "%s: another process is writing this store.", path)
                        : status_fail(error, STATUS_IO, "%s: cannot lock the store: %s. Put it on a local disk.", path,
                                      strerror(errno));
  close(*descriptor);
  *descriptor = -1;
  return result;
}

bool store_is_being_written(const char *path) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (descriptor < 0)
    return false;
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCK_BYTE, .l_len = 1};
  const bool held = fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  close(descriptor);
  return held;
}

/* The name of the file's network file system, on which locks and shared memory are not reliable; NULL: none. */
static const char *network_file_system(int descriptor) {
  struct statfs file_system;
  if (fstatfs(descriptor, &file_system) != 0)
    return NULL;
  switch ((unsigned long)file_system.f_type & 0xffffffff) { /* man 2 statfs */
  case 0x6969: return "NFS";
  case 0x517b:
  case 0xff534d42:
  case 0xfe534d42: return "SMB/CIFS";
  case 0x0bd00bd0: return "Lustre";
  case 0x47504653: return "GPFS";
  case 0x00c36400: return "CephFS";
  case 0x65735546: return "FUSE";
  case 0x5346414f: return "AFS";
  case 0x01021997: return "9p";
  case 0x19830326: return "BeeGFS";
  default: return NULL;
  }
}

/* ---- is this file a store of clast, and of which version? ---- */

/* The file's application id, version, how many tables, indexes and views it has, and whether its texts are UTF-8. */
struct header {
  int64_t application, version, things, utf8;
};

static status read_header(sqlite3 *db, struct header *header, struct error *error) {
  TRY(sql_integer(db, "PRAGMA application_id", 0, &header->application, error));
  TRY(sql_integer(db, "PRAGMA user_version", 0, &header->version, error));
  TRY(sql_integer(db, "SELECT encoding = 'UTF-8' FROM pragma_encoding", 0, &header->utf8, error));
  return sql_integer(db, "SELECT count(*) FROM sqlite_schema", 0, &header->things, error);
}

/* version: the store's user_version, -1 when the file is new (empty). STATUS_CONTENT: not SQLite, not a store, newer or
 * too old for this program, damaged, or with unexpected objects. */
static status inspect(sqlite3 *db, const char *path, int *version, struct error *error) {
  struct header header;
  const status result = read_header(db, &header, error);
  if (result == STATUS_CONTENT && (sqlite3_errcode(db) & 0xff) == SQLITE_NOTADB)
    return status_fail(
        error, STATUS_CONTENT,
        "%s is no SQLite database, so it is no store of clast. Name another file; this file did not change.", path);
  if (result == STATUS_CONTENT) /* SQLite compares the file's length with the length in its header */
    return status_fail(error, STATUS_CONTENT,
                       "%s is damaged, perhaps cut short: %s. Restore a copy, or recover a part with `sqlite3 FILE "
                       ".recover`.",
                       path, sqlite3_errmsg(db));
  TRY(result);
  if (header.application == 0 && header.version == 0 && header.things == 0) {
    *version = -1;
    return STATUS_OK;
  }
  if (header.application != SCHEMA_APPLICATION_ID)
    return status_fail(error, STATUS_CONTENT,
                       "%s is a database of another program (application id 0x%08llx), not a store of clast. Name "
                       "another file; this file did not change.",
                       path, (unsigned long long)header.application);
  if (header.version > SCHEMA_VERSION)
    return status_fail(error, STATUS_CONTENT,
                       "%s was written by a newer clast (store version %lld; this program knows up to %d). Use that "
                       "newer program; the file did not change.",
                       path, (long long)header.version, SCHEMA_VERSION);
  if (header.version < SCHEMA_OLDEST)
    return status_fail(error, STATUS_CONTENT,
                       "%s was written by an older clast (store version %lld), from before the first release; this "
                       "program brings version %d and later forward. Run its campaign in a new store: "
                       "`sqlite3 FILE 'SELECT document FROM campaign'` prints the document. The file did not change.",
                       path, (long long)header.version, SCHEMA_OLDEST);
  if (!header.utf8)
    return status_fail(
        error, STATUS_CONTENT,
        "%s keeps its texts in UTF-16, but stores of clast are in UTF-8: another program made or changed "
        "this file. It did not change now.",
        path);
  *version = (int)header.version;
  return guard_schema(db, path, error);
}

/* ---- upgrades ---- */

/* Within a transaction. version: -1 for a new file. */
static status bring_forward(sqlite3 *db, int version, struct error *error) {
  TRY(schema_complete_all(db, error));
  if (version < SCHEMA_DIGESTS)
    TRY(digest_tables_fill(db, error));
  TRY(views_regenerate(db, error));
  return sql_executef(db, "opening for writing", error, "PRAGMA application_id = %d; PRAGMA user_version = %d; COMMIT",
                      SCHEMA_APPLICATION_ID, SCHEMA_VERSION);
}

/* Creates everything in an empty file; else adds tables and columns that the store lacks, and makes the views again. */
static status upgrade(sqlite3 *db, int version, struct error *error) {
  TRY(sql_execute(db, "BEGIN IMMEDIATE", "opening for writing", error));
  const status result = bring_forward(db, version, error);
  if (result != STATUS_OK)
    sqlite3_exec(db, "ROLLBACK", NULL, NULL, NULL);
  return result;
}

/* ---- opening and closing ---- */

static const char lacks_wal_text[] =
    "has no -wal file, or an empty one. If it is a copy, it was copied while it was being written, and its last runs "
    "are missing: copy both files, or make a copy with `clast export`. If clast was killed here when it had just "
    "begun, nothing is missing. `clast run`, or `clast merge` into this store, goes on with what is there.";

enum { EMPTY_STORE = 4096 }; /* bytes: SQLite's first page, without any table */

static struct store *allocate(const char *path) {
  struct store *store = memory_small(1, sizeof *store);
  store->lock = -1;
  store->wait_until = INFINITY;
  store->lowest_bin = 1;
  store->path = paths_followed(path);
  return store;
}

static void release(struct store *store) {
  sqlite3_stmt *const statements[] = {
      store->run,         store->attempt,           store->estimate,   store->mass_row,
      store->spectrum,    store->spectrum_together, store->point_find, store->point,
      store->point_input, store->campaign_point,    store->axis_find,  store->ejecta,
  };
  for (size_t i = 0; i < sizeof statements / sizeof statements[0]; i++)
    sqlite3_finalize(statements[i]);
  for (size_t i = 0; i < LIMITS_ENGINES; i++) {
    sqlite3_finalize(store->kinds[i].insert);
    free(store->kinds[i].names);
  }
  free(store->outcome_names);
  free(store->estimate_names);
  sums_clear(&store->sums);
  identities_clear(&store->identities);
  assert(!store->db || !sqlite3_next_stmt(store->db, NULL)); /* every statement and answer was ended */
  sqlite3_close(store->db);
  if (store->lock >= 0)
    close(store->lock); /* after SQLite has closed the file (take_lock) */
  free(store->masses);
  free(store->bins);
  free(store->path);
  free(store);
}

static bool (*on_wait)(const char *path, bool tell);

void store_on_wait(bool (*wait)(const char *path, bool tell)) {
  on_wait = wait;
}

/* SQLite calls it again and again while another program holds the file; 0 ends the wait. */
static int wait_for_others(void *context, int count) {
  struct store *store = context;
  const double now = clock_s();
  (void)count; /* SQLite does not begin at 0 in every wait */
  if (now - store->waited_at > 1)
    store->waits_since = now;
  const double waited = now - store->waits_since;
  const bool tell = waited >= TOLD_S && store->waited_at - store->waits_since < TOLD_S;
  store->waited_at = now;
  if (now >= store->wait_until || !(on_wait ? on_wait(store->path, tell) : waited < ALONE_S))
    return 0;
  nanosleep(&(struct timespec){.tv_nsec = waited < 0.1 ? 1000000 : 50000000}, NULL);
  return 1;
}

static status open_database(struct store *store, int flags, struct error *error) {
  int code = sqlite3_open_v2(store->path, &store->db,
                             flags | SQLITE_OPEN_URI | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_NOMUTEX, NULL);
  if (code != SQLITE_OK)
    return sql_fail(store->db, code, "opening", error);
  sqlite3_busy_handler(store->db, wait_for_others, store);
  guard_connection(store->db);
  digest_function(store->db);
  return sql_execute(store->db, "PRAGMA cell_size_check = ON", "opening", error);
}

/* Ranks live some 2 s longer than a killed mpirun: the same command, given at once, must not fail for that. */
static void wait_for_writer(const char *path) {
  const double begin = clock_s();
  while (store_is_being_written(path) && clock_s() < begin + ENDS_S)
    nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
}

/* Refuses the store. The message names the lock's holder if its row is already written. */
static status refuse_held(const char *path, struct error *error) {
  struct store *store = NULL;
  char holder[512] = "";
  if (store_open_reader(path, &store, NULL) == STATUS_OK) {
    STATEMENT row = NULL;
    if (sqlite3_prepare_v2(store->db, "SELECT host, pid, since FROM holder", -1, &row, NULL) == SQLITE_OK &&
        sqlite3_step(row) == SQLITE_ROW)
      snprintf(holder, sizeof holder, " on host %s, process %lld, since %s", sql_text(row, 0),
               (long long)sqlite3_column_int64(row, 1), sql_text(row, 2));
  }
  store_close(store, NULL);
  return status_fail(
      error, STATUS_IO,
      "%s: the store is being written by another clast%s. This one waited %g s for it. Wait until it ends, or "
      "stop it; or name another store.",
      path, holder, ENDS_S);
}

static status write_holder(struct store *store, struct error *error) {
  char host[256] = "unknown";
  gethostname(host, sizeof host - 1);
  return sql_executef(store->db, "writing who holds the store", error,
                      "INSERT OR REPLACE INTO holder VALUES (1, %Q, %lld, strftime('%%Y-%%m-%%dT%%H:%%M:%%SZ', 'now'))",
                      host, (long long)getpid());
}

/* A copy of a store that was being written contains its writer's row in table holder. Stores that an older clast began
 * have no tables at first. */
static bool is_partial_copy(const struct store *store, int version) {
  int64_t holders = 0;
  if (!store->lacks_wal || version < 0)
    return store->lacks_wal;
  /* a journal that was rolled back has taken the file out of WAL mode */
  return sql_integer(store->db, "SELECT count(*) FROM holder, pragma_journal_mode WHERE journal_mode = 'wal'", 0,
                     &holders, NULL) == STATUS_OK &&
         holders > 0;
}

/* With the file locked: opens it, upgrades it and reads the data that a writer needs. The tables and the holder are
 * written before WAL mode: until then, the file of a killed program does not look like a copy without its -wal file,
 * and afterwards every copy shows its holder. */
static status open_locked(struct store *store, struct error *error) {
  int version = -1;
  TRY(open_database(store, SQLITE_OPEN_READWRITE, error));
  TRY(inspect(store->db, store->path, &version, error));
  store->lacks_wal = is_partial_copy(store, version);
  TRY(sql_execute(store->db,
                  "PRAGMA synchronous = FULL; PRAGMA foreign_keys = OFF; PRAGMA temp_store = MEMORY; "
                  "PRAGMA cache_size = -32768; PRAGMA wal_autocheckpoint = 4000",
                  "opening for writing", error));
  if (version >= 0)
    TRY(store_check_folder(store, error));
  TRY(upgrade(store->db, version, error));
  TRY(digest_tables_follow(store->db, &store->tables, error));
  TRY(write_holder(store, error));
  TRY(sql_execute(store->db, "PRAGMA journal_mode = WAL", "opening for writing", error));
  TRY(write_holder(store, error)); /* the first page of the -wal file */
  return identities_load(store, error);
}

/* Undoes a failed call that made no table: leaves no file or an empty one, as before. `before`: bytes of the
 * file, -1 if there was none. */
static void leave_empty(const char *path, off_t before) {
  struct stat file;
  if (before > 0 || stat(path, &file) != 0 || file.st_size > EMPTY_STORE)
    return;
  if (before < 0 || truncate(path, 0) != 0)
    unlink(path);
}

/* Writes a warning about a store that could be opened; "" if there is none. */
static void write_warning(const struct store *store, char *warning, size_t size) {
  const char *network = network_file_system(store->lock);
  if (size == 0)
    return;
  if (store->lacks_wal)
    snprintf(warning, size, "warning: %s %s", store->path, lacks_wal_text);
  else if (network)
    snprintf(warning, size,
             "warning: %s is on a network file system (%s), where locks and shared memory may fail and damage a store: "
             "write to a local disk and copy the file when it is done.",
             store->path, network);
  else
    warning[0] = '\0';
}

status store_open_writer(const char *path, struct store **out, char *warning, size_t warning_size,
                         struct error *error) {
  bool held = false;
  *out = NULL;
  if (warning_size)
    warning[0] = '\0';
  if (store_name_refused(path))
    return status_fail(error, STATUS_USAGE, "%s: %s", path, store_name_refused(path));
  TRY(file_input(path, error));
  TRY(check_file(path, error));
  wait_for_writer(path);
  struct store *store = allocate(path);
  store->writer = true;
  struct stat file;
  const off_t before = stat(path, &file) == 0 ? file.st_size : -1;
  store->lacks_wal = lacks_wal(store->path);
  status result = take_lock(path, &store->lock, &held, error);
  if (result == STATUS_OK && before < 0) { /* a link to a free path: now there is a file */
    free(store->path);
    store->path = paths_followed(path);
  }
  if (result == STATUS_OK)
    result = check_second_name(path, store->lacks_wal, error);
  if (result != STATUS_OK) {
    const bool locked = store->lock >= 0;
    release(store);
    if (locked)
      leave_empty(path, before);
    return held ? refuse_held(path, error) : result;
  }

  result = open_locked(store, error);
  write_warning(store, warning, warning_size);
  if (result != STATUS_OK) {
    release(store);
    leave_empty(path, before);
    return result;
  }
  *out = store;
  return STATUS_OK;
}

/* Is it a store that this program can read? */
static status check_version(const struct store *store, int version, struct error *error) {
  if (store->lacks_wal)
    return status_fail(error, STATUS_CONTENT, "%s %s", store->path, lacks_wal_text);
  if (version < 0)
    return status_fail(error, STATUS_CONTENT, "%s is empty: no campaign was stored in it yet.", store->path);
  if (schema_is_complete(store->db))
    return STATUS_OK;
  return status_fail(
      error, STATUS_CONTENT,
      "%s was written by an older clast and lacks columns. Run its campaign once more (`clast converge`, if it "
      "asks for an accuracy), or merge another store into it (`clast merge FILE OTHER`): opening for writing adds "
      "them.",
      store->path);
}

static status open_readable(struct store *store, struct error *error) {
  int version = -1;
  TRY(open_database(store, SQLITE_OPEN_READONLY, error));
  TRY(inspect(store->db, store->path, &version, error));
  store->lacks_wal = is_partial_copy(store, version);
  TRY(check_version(store, version, error));
  TRY(sql_execute(store->db, "PRAGMA temp_store = MEMORY", "opening", error));
  TRY(views_make_temporary(store->db, error));
  return sql_execute(store->db, "PRAGMA query_only = ON", "opening", error);
}

status store_open_reader(const char *path, struct store **out, struct error *error) {
  *out = NULL;
  if (access(path, F_OK) != 0)
    return status_fail(error, STATUS_MISSING, "%s: there is no such store. Check the name and the current folder.",
                       path);
  TRY(file_input(path, error));
  TRY(check_file(path, error));
  struct store *store = allocate(path);
  store->lacks_wal = lacks_wal(store->path);
  status result = check_second_name(path, store->lacks_wal, error);
  if (result == STATUS_OK)
    result = open_readable(store, error);
  if (result == STATUS_OK)
    *out = store;
  else
    release(store);
  return result;
}

const char *store_path(const struct store *store) {
  return store->path;
}

status store_close(struct store *store, struct error *error) {
  if (!store)
    return STATUS_OK;
  status result = STATUS_OK;
  if (store->writer) {
    result = store_flush(store, error);
    if (result == STATUS_OK)
      result = sql_execute(store->db, "DELETE FROM holder", "closing", error);
    /* If a reader is in the middle of a query, the file stays in WAL mode, complete and readable. */
    store_hurry(store, 1);
    sqlite3_exec(store->db, "PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE", NULL, NULL, NULL);
  }
  release(store);
  return result;
}

void store_drop(struct store **store) {
  (void)store_close(*store, NULL);
}

/* ---- batches and sessions ---- */

/* Undoes the open batch. */
static void roll_back(struct store *store) {
  sqlite3_exec(store->db, "ROLLBACK", NULL, NULL, NULL); /* SQLite may have done so already */
  for (size_t i = 0; i < store->batch_identity_count; i++) {
    struct identities_state *entry = identities_find(&store->identities, store->batch_identities[i]);
    if (entry)
      entry->stored = false;
  }
  sums_forget(&store->sums);
  digest_tables_end(&store->tables, false);
  store->in_batch = false;
  store->batch_identity_count = 0;
  store->broken = true;
}

/* What an open batch counts. */
static void batch_begun(struct store *store) {
  store->in_batch = true;
  store->batch_rows = 0;
  store->batch_identity_count = 0;
  store->batch_started = clock_s();
}

status store_begin(struct store *store, struct error *error) {
  if (!store->writer)
    return status_fail(error, STATUS_INTERNAL, "%s is open for reading only", store->path);
  if (store->broken)
    return status_fail(error, STATUS_IO,
                       "%s: an earlier write failed, so clast writes nothing more. Committed runs are safe; give the "
                       "same command again to compute the rest.",
                       store->path);
  if (store->in_batch)
    return STATUS_OK;
  status result = sql_execute(store->db, "BEGIN IMMEDIATE", "beginning to write", error);
  if (result == STATUS_OK)
    batch_begun(store);
  else
    store->broken = true;
  return result;
}

bool store_begin_within(struct store *store, double seconds) {
  if (store->in_batch || store->broken)
    return true;
  const double until = store->wait_until;
  store_hurry(store, seconds);
  const int code = sqlite3_exec(store->db, "BEGIN IMMEDIATE", NULL, NULL, NULL);
  store->wait_until = until;
  if (code == SQLITE_OK)
    batch_begun(store);
  return (code & 0xff) != SQLITE_BUSY;
}

void store_hurry(struct store *store, double seconds) {
  store->wait_until = fmin(store->wait_until, clock_s() + seconds);
}

status store_end(struct store *store, status result, int rows, struct error *error) {
  if (result != STATUS_OK) {
    if (store->in_batch)
      roll_back(store);
    return result;
  }
  store->batch_rows += rows;
  return store->batch_rows >= STORE_BATCH_ROWS ? store_flush(store, error) : store_tick(store, error);
}

static status commit(struct store *store, struct error *error) {
  TRY(check_place(store->db, store->path, error));
  TRY(sums_write(&store->sums, store->db, error));
  TRY(digest_tables_write(store->db, &store->tables, error));
  return sql_execute(store->db, "COMMIT", "committing", error);
}

status store_flush(struct store *store, struct error *error) {
  if (!store->in_batch)
    return STATUS_OK;
  const status result = commit(store, error);
  if (result != STATUS_OK) {
    roll_back(store);
    return result;
  }
  digest_tables_end(&store->tables, true);
  store->in_batch = false;
  store->batch_identity_count = 0;
  return STATUS_OK;
}

status store_tick(struct store *store, struct error *error) {
  if (!store->in_batch)
    return check_place(store->db, store->path, error);
  return clock_s() - store->batch_started >= STORE_BATCH_SECONDS ? store_flush(store, error) : STATUS_OK;
}

status store_begin_session(struct store *store, const char *facts_json, int64_t *session_id, struct error *error) {
  char host[256] = "unknown";
  gethostname(host, sizeof host - 1);
  TRY(store_begin(store, error));
  const status result =
      sql_executef(store->db, "beginning a session", error,
                   "INSERT INTO session (started_at, host, pid, facts) VALUES (strftime('%%Y-%%m-%%dT%%H:%%M:%%fZ', "
                   "'now'), %Q, %lld, %Q)",
                   host, (long long)getpid(), facts_json ? facts_json : "{}");
  *session_id = sqlite3_last_insert_rowid(store->db);
  TRY(store_end(store, result, 1, error));
  return store_flush(store, error);
}

/* `change`: SQL of what is set. */
static status set_session(struct store *store, int64_t session_id, const char *change, struct error *error) {
  TRY(store_begin(store, error));
  const status result = sql_executef(store->db, "noting a session", error,
                                     "UPDATE session SET %s WHERE session_id = %lld", change, (long long)session_id);
  return store_end(store, result, 1, error);
}

status store_set_session(struct store *store, int64_t session_id, int64_t campaign_id, struct error *error) {
  SQL_TEXT change = sql_format("campaign_id = %lld", (long long)campaign_id);
  return set_session(store, session_id, change, error);
}

status store_set_session_unmet(struct store *store, int64_t session_id, int64_t points, struct error *error) {
  SQL_TEXT change = sql_format("facts = json_set(facts, '$.points_unmet', %lld)", (long long)points);
  return set_session(store, session_id, change, error);
}

status store_end_session(struct store *store, int64_t session_id, const char *outcome, struct error *error) {
  SQL_TEXT change = sql_format("ended_at = strftime('%%Y-%%m-%%dT%%H:%%M:%%fZ', 'now'), outcome = %Q", outcome);
  TRY(set_session(store, session_id, change, error));
  return store_flush(store, error);
}

bool store_has_run(struct store *store, const uint8_t identity[16]) {
  if (!store->identities_loaded && identities_load(store, NULL) != STATUS_OK)
    return false;
  const struct identities_state *entry = identities_find(&store->identities, identity);
  return entry && entry->stored;
}

int store_attempts(struct store *store, const uint8_t identity[16], double time_limit, double memory_limit) {
  if (!store->identities_loaded && identities_load(store, NULL) != STATUS_OK)
    return 0;
  const struct identities_state *entry = identities_find(&store->identities, identity);
  if (!entry || entry->attempts == 0)
    return 0; /* the usual case needs no query */
  STATEMENT statement = NULL;
  int count = (int)entry->attempts;
  if (sql_prepare(store->db,
                  "SELECT count(*) FROM attempt WHERE identity = ?1 AND reason <> 'lost' AND NOT (reason = "
                  "'time_limit' AND (?2 = 0 OR "
                  "limited_to < ?2)) AND NOT (reason = 'memory_limit' AND (?3 = 0 OR limited_to < ?3))",
                  &statement, "counting attempts", NULL) == STATUS_OK) {
    SQL_BIND(statement, sql_of_bytes(identity, 16), sql_of_real(time_limit), sql_of_real(memory_limit));
    if (sqlite3_step(statement) == SQLITE_ROW)
      count = sqlite3_column_int(statement, 0);
  }
  return count;
}

/* ---- copies ---- */

/* Fields files are not moved: the paths in the copy `db` get the way to them as a prefix. */
static status prefix_paths(sqlite3 *db, const char *way, struct error *error) {
  struct digest_tables tables;
  guard_connection(db);
  TRY(digest_tables_follow(db, &tables, error));
  TRY(sql_executef(db, "writing the hand-over file", error,
                   "UPDATE run SET fields_path = %Q || fields_path WHERE fields_path NOT LIKE '/%%'", way));
  return digest_tables_write(db, &tables, error);
}

static status keep_paths(const struct store *store, const char *copy, struct error *error) {
  sqlite3 *db = NULL;
  OWNED char *way = paths_between(copy, store->path);
  if (!way)
    return status_fail(error, STATUS_IO, "%s: the path of its folder cannot be resolved", copy);
  if (!*way)
    return STATUS_OK;
  const int code = sqlite3_open_v2(copy, &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_EXRESCODE, NULL);
  const status result = code == SQLITE_OK ? prefix_paths(db, way, error)
                                          : sql_fail(db, code, "writing the hand-over file", error);
  sqlite3_close(db);
  return result;
}

status store_export(struct store *store, const char *path, struct error *error) {
  struct file_output file;
  if (store_name_refused(path))
    return status_fail(error, STATUS_USAGE, "%s: %s", path, store_name_refused(path));
  if (access(path, F_OK) == 0)
    return status_fail(error, STATUS_IO, "%s exists already: name another file, or remove it first.", path);
  TRY(store_flush(store, error));
  TRY(file_begin(&file, path, "copy of the store", error));
  if (check_length(file.temporary, error) != STATUS_OK)
    return file_end(&file, STATUS_IO, error);
  /* query_only refuses VACUUM INTO, although VACUUM INTO writes another file. */
  sqlite3_exec(store->db, "PRAGMA query_only = OFF", NULL, NULL, NULL);
  status result = guard_vacuum_into(store->db, file.temporary, "writing the hand-over file", error);
  if (!store->writer)
    sqlite3_exec(store->db, "PRAGMA query_only = ON", NULL, NULL, NULL);
  if (result == STATUS_OK)
    result = keep_paths(store, file.temporary, error);
  return file_end(&file, result, error);
}

status store_export_digests(struct store *store, FILE *out, struct error *error) {
  TRY(digest_rows_print(store->db, DIGEST_POINTS, out, error));
  return digest_rows_print(store->db, DIGEST_RUNS, out, error);
}

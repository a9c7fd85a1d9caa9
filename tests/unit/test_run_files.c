/* Files of a run of either engine: a restart file gives the same bits; a damaged one, or one of another scene or CPU
 * class, is refused. Files are complete or absent, on a full disk and after a kill. */
#define CHECK_OWN_MAIN
#include "tests/support/run_case.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "engine/cpu_class.h"
#include "engine/restart.h"
#include "schemas/file.h"
#include "tests/support/folder.h"

static struct dem_inputs disc(bool gear) {
  return DEM_CASE("disc-explosion", "body.diameter=12 cm", "charge.energy=4 kJ/m", "stop.end_time=1 ms",
                  "contact.normal_damping=1e3 1/s", "contact.tangential_damping=1e3 1/s", "contact.friction=0.5",
                  gear ? "fidelity.integrator=gear" : "fidelity.integrator=verlet", "threshold.modulus=10");
}

static struct sph_inputs sphere(void) {
  return SPH_CASE("basalt-sphere", "fidelity.particles=700", "stop.end_time=25 us");
}

static void *stepped(const struct engine_kind *kind, const void *inputs, uint64_t seed, uint64_t steps) {
  void *run;
  bool finished = false;
  if (kind->prepare(inputs, seed, &run, &error) || kind->step(run, steps, &finished, &error))
    fail_msg("%s: %s", kind->name, error.message);
  assert_false(finished);
  return run;
}

static void continues(const struct engine_kind *kind, const void *inputs) {
  struct ran straight = run_case_run(kind, inputs, 11);
  const uint64_t half = (uint64_t)straight.outcome.steps / 2 + 3; /* between two list rebuilds */
  assert_true(straight.outcome.steps >= 40);
  void *run = stepped(kind, inputs, 11, half), *again;
  const double time = kind->time(run);
  OK(restart_save(kind, run, in_folder("run.restart"), &error));
  kind->free(run);
  OK(restart_load(kind, inputs, in_folder("run.restart"), &again, &error));
  assert_true(kind->time(again) == time && time > 0);
  run_case_same(kind, &straight, run_case_end(kind, again, 37));
  kind->free(again);
  free(straight.fragments);
  unlink(in_folder("run.restart"));
}

TEST(restart_continues_with_the_same_bits) {
  const struct dem_inputs dem[] = {disc(false), disc(true),
                                   DEM_CASE("compression", "body.columns=8", "body.rows=10", "loading.rate=20 1/s",
                                            "loading.ramp=0.5 ms", "loading.strain_end=3 %")};
  const struct sph_inputs sph[] = {
      sphere(),
      SPH_CASE("basalt-sphere", "fidelity.particles=500", "stop.end_time=8 us", "fidelity.precision=float",
               "fidelity.threads=2"),
      SPH_CASE("tensile-rod", "fidelity.particles=600", "stop.end_time=8 us"),
      SPH_CASE("elastic-bar", "fidelity.particles=600", "stop.end_time=12 us"),
      SPH_CASE("porous-ice", "fidelity.particles=800", "fidelity.projectile_spacing=0.5", "impact.mass=1 g",
               "stop.end_time=15 us"),
  };
  for (size_t c = 0; c < sizeof dem / sizeof *dem; c++)
    continues(&dem_engine, &dem[c]);
  for (size_t c = 0; c < sizeof sph / sizeof *sph; c++)
    continues(&sph_engine, &sph[c]);
}

/* Fails unless `path` is refused as bad content with a message that contains `why`. */
static void refused(const struct engine_kind *kind, const void *inputs, const char *path, const char *why) {
  void *run;
  assert_int_equal(restart_load(kind, inputs, path, &run, &error), STATUS_CONTENT);
  assert_null(run);
  if (!strstr(error.message, why) || !strstr(error.message, path))
    fail_msg("no \"%s\" in: %s", why, error.message);
}

/* Positions of words in a restart file (engine/restart.h). */
enum { AT_VERSION = 8, AT_BUILD = 32 };

/* Adds `more` to a word of a restart file and corrects its checksum (FNV-1a of all but the last 8 bytes). */
static void change_word(const char *path, size_t at, uint64_t more) {
  OWNED unsigned char *bytes = NULL;
  size_t size = 0;
  uint64_t word;
  assert_int_equal(file_read(path, "restart file", &bytes, &size, NULL), STATUS_OK);
  memcpy(&word, bytes + at, sizeof word);
  word += more;
  memcpy(bytes + at, &word, sizeof word);
  uint64_t sum = 0xcbf29ce484222325U;
  for (size_t k = 0; k + 8 < size; k++)
    sum = (sum ^ bytes[k]) * 0x100000001b3U;
  memcpy(bytes + size - 8, &sum, sizeof sum);
  assert_int_equal(file_write(path, "restart file", bytes, size, NULL), STATUS_OK);
}

static void damaged_is_refused(const struct engine_kind *kind, const void *inputs, const void *other,
                               const struct engine_kind *foreign, const void *foreign_inputs) {
  char path[200];
  snprintf(path, sizeof path, "%s", in_folder("a.restart"));
  void *run = stepped(kind, inputs, 1, 5);
  assert_int_equal(restart_save(kind, run, path, NULL), STATUS_OK);
  kind->free(run);
  refused(kind, other, path, "another scene");
  refused(foreign, foreign_inputs, path, "another scene");
  struct stat info;
  assert_int_equal(stat(path, &info), 0);
  for (int k = 0; k < 40; k++) { /* one byte changed anywhere */
    off_t at = info.st_size * k / 40;
    FILE *file = fopen(path, "r+b");
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 0x40, file);
    fclose(file);
    refused(kind, inputs, path, k ? "damaged" : "no restart file");
    file = fopen(path, "r+b");
    fseek(file, at, SEEK_SET);
    fputc(byte, file);
    fclose(file);
  }
  OK(restart_load(kind, inputs, path, &run, &error));
  kind->free(run);
  /* Another build may keep the same arrays in another order: its file would be read as plausible but wrong numbers. */
  for (size_t at = AT_VERSION; at <= AT_BUILD; at += AT_BUILD - AT_VERSION) {
    change_word(path, at, UINT64_MAX);
    refused(kind, inputs, path, "another build");
    change_word(path, at, 1);
  }
  OK(restart_load(kind, inputs, path, &run, &error));
  kind->free(run);
  assert_int_equal(truncate(path, info.st_size / 2), 0);
  refused(kind, inputs, path, "cut short");
  assert_int_equal(truncate(path, 0), 0);
  refused(kind, inputs, path, "no restart file");
  unlink(path);
  assert_int_equal(restart_load(kind, inputs, path, &run, &error), STATUS_MISSING);
}

TEST(damaged_or_foreign_restart_is_refused) {
  struct dem_inputs dem = disc(false), other_dem = dem;
  struct sph_inputs sph = sphere(), other_sph = sph;
  other_dem.threshold.strain *= 1 + 1e-15;
  other_sph.impact.speed *= 1 + 1e-15;
  damaged_is_refused(&dem_engine, &dem, &other_dem, &sph_engine, &sph);
  damaged_is_refused(&sph_engine, &sph, &other_sph, &dem_engine, &dem);
}

/* Bits differ from class to class (FMA): a run continued in another class would match neither. */
TEST(restart_of_another_cpu_class_is_refused) {
  if (cpu_class_choose() == CPU_BASELINE) {
    print_message("this machine has the baseline class only: nothing to compare\n");
    skip();
  }
  const struct dem_inputs dem = disc(false);
  const struct sph_inputs sph = sphere();
  const struct engine_kind *const kind[] = {&dem_engine, &sph_engine};
  const void *const inputs[] = {&dem, &sph};
  char path[200];
  snprintf(path, sizeof path, "%s", in_folder("a.restart"));
  const char *asked = getenv("CLAST_CPU");
  char before[20];
  snprintf(before, sizeof before, "%s", asked ? asked : "");
  for (int k = 0; k < 2; k++) {
    setenv("CLAST_CPU", "baseline", 1);
    void *run = stepped(kind[k], inputs[k], 1, 5);
    assert_int_equal(restart_save(kind[k], run, path, NULL), STATUS_OK);
    kind[k]->free(run);
    if (asked)
      setenv("CLAST_CPU", before, 1);
    else
      unsetenv("CLAST_CPU");
    refused(kind[k], inputs[k], path, "CLAST_CPU=baseline");
  }
  unlink(path);
}

static void failed_writes_leave_nothing(const struct engine_kind *kind, const void *inputs) {
  void *run;
  OK(kind->prepare(inputs, 5, &run, &error));
  assert_int_equal(kind->write_snapshot(run, in_folder("no/such/folder.hdf"), &error), STATUS_IO);
  assert_non_null(strstr(error.message, "No such file"));
  assert_int_equal(kind->write_snapshot(run, "/dev/full/fields.hdf", &error), STATUS_IO);
  assert_int_equal(restart_save(kind, run, in_folder("no/such/folder.restart"), &error), STATUS_IO);
  signal(SIGXFSZ, SIG_IGN); /* a disk that fills up: a limit on file size gives the same error at the same place */
  struct rlimit before, limit;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  limit = before;
  limit.rlim_cur = 10000;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
  status fields = kind->write_snapshot(run, in_folder("full.hdf"), &error);
  status restart = restart_save(kind, run, in_folder("full.restart"), &error);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(fields, STATUS_IO);
  assert_int_equal(restart, STATUS_IO);
  assert_non_null(strstr(error.message, "too large"));
  kind->free(run); /* remove_folder checks that no file is left in the folder */
}

TEST(failed_writes_are_one_error_and_leave_nothing) {
  const struct dem_inputs dem = disc(false);
  const struct sph_inputs sph = sphere();
  failed_writes_leave_nothing(&dem_engine, &dem);
  failed_writes_leave_nothing(&sph_engine, &sph);
}

/* Number of files in the folder beside a.restart; *temporary: whether it is the one temporary file of that name. */
static int beside(bool *temporary) {
  int count = 0;
  *temporary = false;
  DIR *list = opendir(folder);
  for (const struct dirent *entry; (entry = readdir(list));) {
    if (entry->d_name[0] == '.' || strcmp(entry->d_name, "a.restart") == 0)
      continue;
    *temporary |= strcmp(entry->d_name, "a.restart.unfinished") == 0;
    count++;
  }
  closedir(list);
  return count;
}

/* A process that only writes is killed at twenty moments: the file is always complete and of the right run. A kill may
 * leave one temporary file beside it. The next write removes this file, but not one that another process is writing. */
TEST(killed_amid_a_write_the_file_is_whole) {
  const struct sph_inputs inputs = sphere();
  char path[200];
  snprintf(path, sizeof path, "%s", in_folder("a.restart"));
  void *run = stepped(&sph_engine, &inputs, 1, 5), *again;
  assert_int_equal(restart_save(&sph_engine, run, path, NULL), STATUS_OK);
  for (int k = 0; k < 20; k++) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
      for (;;)
        if (restart_save(&sph_engine, run, path, NULL))
          _exit(1);
    nanosleep(&(struct timespec){.tv_nsec = 1000000 + k * 173000}, NULL);
    kill(child, SIGKILL);
    int ended;
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_true(WIFSIGNALED(ended));
    OK(restart_load(&sph_engine, &inputs, path, &again, &error));
    assert_true(sph_engine.time(again) == sph_engine.time(run));
    sph_engine.free(again);
  }
  bool temporary;
  assert_true(beside(&temporary) == (temporary ? 1 : 0));       /* twenty kills leave at most one file */
  FILE *stale = fopen(in_folder("a.restart.unfinished"), "wb"); /* of a process that has ended */
  fputs("of a write that was never finished", stale);
  fclose(stale);
  assert_int_equal(restart_save(&sph_engine, run, path, NULL), STATUS_OK);
  assert_int_equal(beside(&temporary), 0);
  FILE *other = fopen(in_folder("a.restart.unfinished"), "wb"); /* of a process that is still writing */
  fputs("half", other);
  fflush(other);
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = (off_t)1 << 62, .l_len = 1};
  assert_int_equal(fcntl(fileno(other), F_OFD_SETLK, &lock), 0);
  assert_int_equal(restart_save(&sph_engine, run, path, NULL), STATUS_OK);
  assert_true(beside(&temporary) == 1 && temporary);
  struct stat there;
  assert_true(stat(in_folder("a.restart.unfinished"), &there) == 0 && there.st_size == 4);
  fclose(other);
  const pid_t rival = fork(); /* two processes write the same file: neither write fails */
  assert_true(rival >= 0);
  for (int k = 0; k < 100; k++)
    if (restart_save(&sph_engine, run, path, NULL)) {
      if (rival == 0)
        _exit(1);
      fail();
    }
  if (rival == 0)
    _exit(0);
  int ended;
  assert_int_equal(waitpid(rival, &ended, 0), rival);
  assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
  assert_int_equal(beside(&temporary), 0);
  assert_int_equal(restart_load(&sph_engine, &inputs, path, &again, NULL), STATUS_OK);
  sph_engine.free(again);
  sph_engine.free(run);
  unlink(path);
}

int main(void) {
  return check_run(make_folder, remove_folder);
}

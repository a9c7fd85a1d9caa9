/* Share of the machine that reaches the runs under the farm, beside other drivers doing the same work.
 *
 * Utilisation = sum of the tasks' nominal CPU seconds over slots x wall from first dispatch to last report (others:
 * their whole wall). A task burns CPU time of its thread, so other load does not change the work; but on a shared
 * machine the wall time grows and every utilisation falls. Two more figures separate this effect from losses in the
 * farm: `..._of_given` leaves out of slots x wall the time for which a task was ready and the kernel ran something else
 * (schedstat); and `ideal` is the same work in equal halves in two plain processes.
 *
 *     bench_farm [rounds [farm]]     best of so many (default 1); `farm`: without the other drivers */
#include <math.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "schemas/clock.h"
#include "tests/bench/farm_store.h"

#define SLOTS      2
#define TASKS      400
#define LONG_TASKS 30
#define NOTHINGS   10000

static char burn_program[128];
static double costs[TASKS], cost_sum, long_costs[LONG_TASKS], long_sum;

static void print(const char *name, double value, const char *unit) {
  printf("%-44s %12.5g %s\n", name, value, unit);
  fflush(stdout);
}

static int costliest_first(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? 1 : x > y ? -1 : 0;
}

/* The same list every time: lognormal with this mean and sigma 1 (Box and Muller). */
static double fill(double *list, int count, double mean, uint64_t seed) {
  double sum = 0;
  for (int i = 0; i < count; i++) {
    const double u = 1 - fixture_random(seed, 2 * (uint64_t)i), v = fixture_random(seed, 2 * (uint64_t)i + 1);
    list[i] = mean * exp(sqrt(-2 * log(u)) * cos(2 * M_PI * v) - 0.5);
    sum += list[i];
  }
  return sum;
}

static void tasks_from(struct task_list *list, const double *cost, int count) {
  task_list_new(list, (size_t)count);
  for (int i = 0; i < count; i++)
    list->tasks[i] = (struct task){.id = (uint64_t)i,
                                   .kind = cost ? TASK_BURN : TASK_ECHO,
                                   .amount = cost ? cost[i] : 0};
}

static double since(int64_t start_ns) {
  return 1e-9 * (double)(clock_ns() - start_ns);
}

/* Two plain processes with half of the work each: the capacity of the machine at this moment. */
static double ideal(double sum) {
  const int64_t start = clock_ns();
  pid_t pids[SLOTS];
  for (int i = 0; i < SLOTS; i++) {
    pids[i] = fork();
    if (pids[i] == 0) {
      task_burn(sum / SLOTS);
      _exit(0);
    }
  }
  for (int i = 0; i < SLOTS; i++)
    waitpid(pids[i], NULL, 0);
  return sum / (SLOTS * since(start));
}

struct timing {
  struct farm_usage usage;
  double utilisation, of_given;
};

static struct timing farm_over(const double *cost, int count, bool in_process, struct farm_manager *manager) {
  struct task_list list;
  struct error error = {0};
  struct farm *farm = NULL;
  struct timing measured = {0};
  double sum = 0;
  tasks_from(&list, cost, count);
  for (int i = 0; i < count; i++)
    sum += list.tasks[i].amount;
  struct farm_manager own = task_list_manager(&list);
  if (manager) {
    own.report = manager->report;
    own.tick = manager->tick;
    own.context = manager->context;
    *(struct task_list **)manager->context = &list; /* report() of the store's bench needs this first */
    own.next = manager->next;
  }
  status code = farm_start(&(struct farm_options){.slots = SLOTS, .in_process = in_process}, task_work, &farm, &error);
  if (code == STATUS_OK)
    code = farm_run(farm, &own, &error);
  if (code == STATUS_OK)
    measured.usage = farm_usage(farm);
  farm_stop(farm);
  if (code != STATUS_OK) { /* a signal or a fault: figures of the remaining parts would be meaningless */
    fprintf(stderr, "bench_farm: %s\n", error.message);
    unlink(burn_program);
    exit((int)code);
  }
  measured.utilisation = sum / (SLOTS * measured.usage.wall_s);
  measured.of_given = sum / (SLOTS * measured.usage.wall_s - list.kept_waiting_s);
  task_list_free(&list);
  return measured;
}

/* ---- other drivers ---- */

static bool have(const char *program) {
  char command[256];
  snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", program);
  return system(command) == 0;
}

static double piped(const char *command, const double *cost, int count) {
  const int64_t start = clock_ns();
  FILE *pipe = popen(command, "w");
  if (!pipe)
    return NAN;
  for (int i = 0; i < count; i++)
    fprintf(pipe, "%.6f\n", cost ? cost[i] : 0);
  return pclose(pipe) == 0 ? since(start) : (double)NAN;
}

static const char python[] = "import sys, time\n"
                             "from mpi4py.futures import MPIPoolExecutor\n"
                             "def burn(s):\n"
                             "    end = time.thread_time() + s\n"
                             "    while time.thread_time() < end: pass\n"
                             "if __name__ == '__main__':\n"
                             "    costs = [float(l) for l in open(sys.argv[1])]\n"
                             "    with MPIPoolExecutor() as pool:\n"
                             "        list(pool.map(burn, [0] * 8))\n"
                             "        start = time.monotonic()\n"
                             "        list(pool.map(burn, costs))\n"
                             "        print(time.monotonic() - start)\n";

/* Wall time without start-up, as for the farm. */
static double mpi4py(const double *cost, int count) {
  char path[] = "/tmp/bench_farm_XXXXXX", costs_path[64], command[256];
  const int file = mkstemp(path);
  double wall = NAN;
  if (file < 0 || write(file, python, sizeof python - 1) < 0)
    return NAN;
  close(file);
  snprintf(costs_path, sizeof costs_path, "%s.costs", path);
  FILE *list = fopen(costs_path, "w");
  for (int i = 0; list && i < count; i++)
    fprintf(list, "%.6f\n", cost[i]);
  if (list)
    fclose(list);
  snprintf(command, sizeof command, "mpirun --oversubscribe -n 3 /usr/bin/python3 -m mpi4py.futures %s %s 2>/dev/null",
           path, costs_path);
  FILE *pipe = popen(command, "r");
  if (pipe && fscanf(pipe, "%lf", &wall) != 1)
    wall = NAN;
  if (pipe)
    pclose(pipe);
  unlink(path);
  unlink(costs_path);
  return wall;
}

/* ---- under mpirun: this program again as `bench_farm rank in_process count mean` ---- */

static int rank_main(char **argv) {
  struct task_list list;
  struct error error = {0};
  struct farm *farm = NULL;
  const int count = atoi(argv[3]);
  if (farm_start(&(struct farm_options){.slots = 1, .in_process = atoi(argv[2]), .use_mpi = farm_under_mpi()},
                 task_work, &farm, &error) != STATUS_OK)
    return 1;
  fill(costs, TASKS, 0.05, 1);
  tasks_from(&list, count > 1 ? costs : NULL, count);
  if (count == 1)
    list.tasks[0] = (struct task){.kind = TASK_SLEEP, .amount = 3};
  const struct farm_manager manager = task_list_manager(&list);
  const status result = farm_run(farm, &manager, &error);
  if (farm_rank(farm) == 0) {
    const struct farm_usage usage = farm_usage(farm);
    double sum = 0;
    for (int i = 0; i < count; i++)
      sum += list.tasks[i].amount;
    printf("%g %g %g %g %g\n", sum, usage.wall_s, usage.manager_cpu_s, usage.waiting_cpu_s, usage.start_up_s);
  }
  farm_stop(farm);
  task_list_free(&list);
  return (int)result;
}

static void best(double *so_far, double now) {
  if (isnan(*so_far) || now > *so_far)
    *so_far = now;
}

/* ---- farm and store ---- */

static double stored_per_s(bool in_process, size_t fragments) {
  struct error error = {0};
  struct storing s = {0};
  double rate = NAN;
  if (storing_begin(&s, fragments, &error) == STATUS_OK) {
    const int64_t start = clock_ns();
    struct farm_manager manager = {.context = &s, .next = store_next, .report = store_report, .tick = store_ticking};
    const struct farm_usage usage = farm_over(NULL, NOTHINGS, in_process, &manager).usage;
    if (store_flush(s.store, &error) == STATUS_OK && usage.tasks == NOTHINGS)
      rate = NOTHINGS / (since(start) - usage.start_up_s); /* to the last commit */
  }
  if (isnan(rate))
    fprintf(stderr, "bench_farm: %s\n", error.message);
  storing_end(&s);
  return rate;
}

struct ranks_usage {
  double sum, wall, manager, waiting, start_up;
};

static struct ranks_usage over_ranks(const char *self, int ranks, bool in_process, int count) {
  struct ranks_usage u = {NAN, NAN, NAN, NAN, NAN};
  char command[512];
  snprintf(command, sizeof command, "mpirun --oversubscribe -n %d %s rank %d %d 2>/dev/null", ranks, self, in_process,
           count);
  FILE *pipe = popen(command, "r");
  if (pipe && fscanf(pipe, "%lf %lf %lf %lf %lf", &u.sum, &u.wall, &u.manager, &u.waiting, &u.start_up) != 5)
    u.sum = NAN;
  if (pipe)
    pclose(pipe);
  return u;
}

int main(int argc, char **argv) {
  if (argc == 4 && strcmp(argv[1], "rank") == 0)
    return rank_main(argv);
  const int rounds = argc > 1 && atoi(argv[1]) > 0 ? atoi(argv[1]) : 1;
  char command[1024], self[512] = "";
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  if (readlink("/proc/self/exe", self, sizeof self - 1) < 0)
    return 1;
  cost_sum = fill(costs, TASKS, 0.05, 1);
  long_sum = fill(long_costs, LONG_TASKS, 1, 2);
  qsort(long_costs, LONG_TASKS, sizeof *long_costs, costliest_first);
  snprintf(burn_program, sizeof burn_program, "/tmp/bench_farm_burn_%d", (int)getpid());
  snprintf(command, sizeof command, "cc -O2 -o %s %.*s/farm_burn.c", burn_program,
           (int)(strrchr(__FILE__, '/') - __FILE__), __FILE__);
  const bool others = argc < 3 || strcmp(argv[2], "farm") != 0;
  const bool burner = others && system(command) == 0;
  printf("# %d tasks, lognormal, %.3f CPU s; %d tasks most expensive first, %.3f CPU s; %d slots; best of %d\n", TASKS,
         cost_sum, LONG_TASKS, long_sum, SLOTS, rounds);

  double in_process = NAN, isolated = NAN, xargs = NAN, parallel = NAN, python_mpi = NAN, two = NAN, three = NAN;
  double best_ideal = NAN, given_in = NAN, given_isolated = NAN, given_1s = NAN, manager = NAN, start_up = NAN,
         one_s = NAN, waiting = NAN;
  for (int round = 0; round < rounds; round++) {
    best(&best_ideal, ideal(cost_sum));
    struct timing it = farm_over(costs, TASKS, true, NULL);
    best(&in_process, it.utilisation);
    best(&given_in, it.of_given);
    best(&manager, -it.usage.manager_cpu_s / it.usage.wall_s);
    best(&start_up, -it.usage.start_up_s);
    it = farm_over(costs, TASKS, false, NULL);
    best(&isolated, it.utilisation);
    best(&given_isolated, it.of_given);
    it = farm_over(long_costs, LONG_TASKS, true, NULL);
    best(&one_s, it.utilisation);
    best(&given_1s, it.of_given);
    if (burner && have("xargs")) {
      snprintf(command, sizeof command, "xargs -P%d -n1 %s", SLOTS, burn_program);
      best(&xargs, cost_sum / (SLOTS * piped(command, costs, TASKS)));
    }
    if (burner && have("parallel")) {
      snprintf(command, sizeof command, "parallel --will-cite -j%d %s 2>/dev/null", SLOTS, burn_program);
      best(&parallel, cost_sum / (SLOTS * piped(command, costs, TASKS)));
    }
    if (others && have("mpirun") && system("/usr/bin/python3 -c 'import mpi4py.futures' 2>/dev/null") == 0)
      best(&python_mpi, cost_sum / (SLOTS * mpi4py(costs, TASKS)));
    struct ranks_usage u = over_ranks(self, 2, true, TASKS);
    best(&two, u.sum / (2 * u.wall));
    u = over_ranks(self, 3, true, TASKS);
    best(&three, u.sum / (2 * u.wall)); /* three slots on two cores: of the cores */
    u = over_ranks(self, 3, true, 1);
    best(&waiting, -u.waiting / 2 / u.wall);
  }
  print("farm_utilisation_inprocess_50ms", in_process, "1");
  print("farm_utilisation_isolated_50ms", isolated, "1");
  print("farm_utilisation_1s", one_s, "1");
  print("farm_utilisation_ideal", best_ideal, "1");
  print("farm_utilisation_inprocess_50ms_of_given", given_in, "1");
  print("farm_utilisation_isolated_50ms_of_given", given_isolated, "1");
  print("farm_utilisation_1s_of_given", given_1s, "1");
  print("farm_utilisation_mpi_2_ranks", two, "1");
  print("farm_utilisation_mpi_3_ranks_of_cores", three, "1");
  if (isnan(xargs))
    printf("# xargs or cc missing: not compared\n");
  else
    print("xargs_utilisation_50ms", xargs, "1"), print("farm_isolated_over_xargs", isolated / xargs, "1");
  if (isnan(parallel))
    printf("# GNU parallel missing: not compared\n");
  else
    print("gnu_parallel_utilisation_50ms", parallel, "1"),
        print("farm_isolated_over_gnu_parallel", isolated / parallel, "1");
  if (isnan(python_mpi))
    printf("# mpi4py missing: not compared\n");
  else
    print("mpi4py_futures_utilisation_50ms", python_mpi, "1"),
        print("farm_inprocess_over_mpi4py", in_process / python_mpi, "1");
  print("farm_manager_cpu_share", -manager, "core");
  print("farm_waiting_cpu_share", -waiting, "core");
  print("farm_start_up_ms", -1e3 * start_up, "ms");

  double rate_in = NAN, rate_isolated = NAN, stored_in = NAN, stored_isolated = NAN, stored_60 = NAN, xargs_rate = NAN;
  for (int round = 0; round < (rounds > 3 ? rounds : 3); round++) {
    best(&rate_in, NOTHINGS / farm_over(NULL, NOTHINGS, true, NULL).usage.wall_s);
    best(&rate_isolated, NOTHINGS / farm_over(NULL, NOTHINGS, false, NULL).usage.wall_s);
    best(&stored_in, stored_per_s(true, 0));
    best(&stored_60, stored_per_s(true, FIXTURE_FRAGMENTS));
    best(&stored_isolated, stored_per_s(false, 0));
    if (burner && have("xargs")) {
      snprintf(command, sizeof command, "xargs -P%d -n1 %s", SLOTS, burn_program);
      best(&xargs_rate, 2000 / piped(command, NULL, 2000));
    }
  }
  print("farm_runs_per_s_inprocess", stored_in, "1/s (through the store)");
  print("farm_runs_per_s_isolated", stored_isolated, "1/s (through the store)");
  print("farm_runs_per_s_inprocess_60_fragments", stored_60, "1/s (through the store, spectra too)");
  print("farm_runs_per_s_inprocess_no_store", rate_in, "1/s");
  print("farm_runs_per_s_isolated_no_store", rate_isolated, "1/s");
  if (!isnan(xargs_rate))
    print("xargs_runs_per_s", xargs_rate, "1/s (no store)"),
        print("farm_isolated_over_xargs_runs", stored_isolated / xargs_rate, "1");
  unlink(burn_program);
  return 0;
}

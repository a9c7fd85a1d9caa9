/* Share of the machine that reaches the runs under the farm, beside other drivers doing the same work.
 *
 * Utilisation = sum of the tasks' nominal CPU seconds over slots x wall from first dispatch to last report (others:
 * their whole wall). A task burns CPU time of its thread, so other load does not change the work; but on a shared
 * machine the wall time grows and every utilisation falls. `ideal` shows that: it is the same work in equal halves in
 * two plain processes.
 *
 *     bench_farm [rounds [farm]]     best of so many (default 1); `farm`: without the other drivers */
#include <math.h>
#include <sys/wait.h>

#include "schemas/clock.h"
#include "tests/bench/farm_store.h"

#define SLOTS    2
#define TASKS    400
#define NOTHINGS 10000

static char burn_program[128];
static double costs[TASKS], cost_sum;

static void print(const char *name, double value, const char *unit) {
  printf("%-44s %12.5g %s\n", name, value, unit);
  fflush(stdout);
}

/* The same list every time: lognormal with mean 50 ms and sigma 1 (Box and Muller). */
static void fill_costs(void) {
  for (uint64_t i = 0; i < TASKS; i++) {
    const double u = 1 - fixture_random(1, 2 * i), v = fixture_random(1, 2 * i + 1);
    costs[i] = 0.05 * exp(sqrt(-2 * log(u)) * cos(2 * M_PI * v) - 0.5);
    cost_sum += costs[i];
  }
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
static double ideal(void) {
  const int64_t start = clock_ns();
  pid_t pids[SLOTS];
  for (int i = 0; i < SLOTS; i++) {
    pids[i] = fork();
    if (pids[i] == 0) {
      task_burn(cost_sum / SLOTS);
      _exit(0);
    }
  }
  for (int i = 0; i < SLOTS; i++)
    waitpid(pids[i], NULL, 0);
  return cost_sum / (SLOTS * since(start));
}

static struct farm_usage farm_over(const double *cost, int count, bool in_process, struct farm_manager *manager) {
  struct task_list list;
  struct error error = {0};
  struct farm *farm = NULL;
  struct farm_usage usage = {0};
  tasks_from(&list, cost, count);
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
    usage = farm_usage(farm);
  farm_stop(farm);
  if (code != STATUS_OK) { /* a signal or a fault: figures of the remaining parts would be meaningless */
    fprintf(stderr, "bench_farm: %s\n", error.message);
    unlink(burn_program);
    exit((int)code);
  }
  task_list_free(&list);
  return usage;
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

static void best(double *so_far, double now) {
  if (isnan(*so_far) || now > *so_far)
    *so_far = now;
}

/* ---- farm and store ---- */

static double stored_per_s(bool in_process) {
  struct error error = {0};
  struct storing s = {0};
  double rate = NAN;
  if (storing_begin(&s, 0, &error) == STATUS_OK) {
    const int64_t start = clock_ns();
    struct farm_manager manager = {.context = &s, .next = store_next, .report = store_report, .tick = store_ticking};
    const struct farm_usage usage = farm_over(NULL, NOTHINGS, in_process, &manager);
    if (store_flush(s.store, &error) == STATUS_OK && usage.tasks == NOTHINGS)
      rate = NOTHINGS / (since(start) - usage.start_up_s); /* to the last commit */
  }
  if (isnan(rate))
    fprintf(stderr, "bench_farm: %s\n", error.message);
  storing_end(&s);
  return rate;
}

int main(int argc, char **argv) {
  const int rounds = argc > 1 && atoi(argv[1]) > 0 ? atoi(argv[1]) : 1;
  char command[1024];
  fill_costs();
  snprintf(burn_program, sizeof burn_program, "/tmp/bench_farm_burn_%d", (int)getpid());
  snprintf(command, sizeof command, "cc -O2 -o %s %.*s/farm_burn.c", burn_program,
           (int)(strrchr(__FILE__, '/') - __FILE__), __FILE__);
  const bool others = argc < 3 || strcmp(argv[2], "farm") != 0;
  const bool burner = others && system(command) == 0;
  printf("# %d tasks, lognormal, %.3f CPU s; %d slots; best of %d\n", TASKS, cost_sum, SLOTS, rounds);

  double in_process = NAN, isolated = NAN, xargs = NAN, parallel = NAN, best_ideal = NAN;
  for (int round = 0; round < rounds; round++) {
    best(&best_ideal, ideal());
    best(&in_process, cost_sum / (SLOTS * farm_over(costs, TASKS, true, NULL).wall_s));
    best(&isolated, cost_sum / (SLOTS * farm_over(costs, TASKS, false, NULL).wall_s));
    if (burner && have("xargs")) {
      snprintf(command, sizeof command, "xargs -P%d -n1 %s", SLOTS, burn_program);
      best(&xargs, cost_sum / (SLOTS * piped(command, costs, TASKS)));
    }
    if (burner && have("parallel")) {
      snprintf(command, sizeof command, "parallel --will-cite -j%d %s 2>/dev/null", SLOTS, burn_program);
      best(&parallel, cost_sum / (SLOTS * piped(command, costs, TASKS)));
    }
  }
  print("farm_utilisation_inprocess_50ms", in_process, "1");
  print("farm_utilisation_isolated_50ms", isolated, "1");
  print("farm_utilisation_ideal", best_ideal, "1");
  if (isnan(xargs))
    printf("# xargs or cc missing: not compared\n");
  else
    print("xargs_utilisation_50ms", xargs, "1");
  if (isnan(parallel))
    printf("# GNU parallel missing: not compared\n");
  else
    print("gnu_parallel_utilisation_50ms", parallel, "1");

  double stored_in = NAN, stored_isolated = NAN, xargs_rate = NAN;
  for (int round = 0; round < (rounds > 3 ? rounds : 3); round++) {
    best(&stored_in, stored_per_s(true));
    best(&stored_isolated, stored_per_s(false));
    if (burner && have("xargs")) {
      snprintf(command, sizeof command, "xargs -P%d -n1 %s", SLOTS, burn_program);
      best(&xargs_rate, 2000 / piped(command, NULL, 2000));
    }
  }
  print("farm_runs_per_s_inprocess", stored_in, "1/s (through the store)");
  print("farm_runs_per_s_isolated", stored_isolated, "1/s (through the store)");
  if (!isnan(xargs_rate))
    print("xargs_runs_per_s", xargs_rate, "1/s (no store)");
  unlink(burn_program);
  return 0;
}

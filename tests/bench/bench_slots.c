/* How many slots one manager can supply with runs of a given length. The slots sleep, so that two cores are enough for
 * 1024 of them. For each case: the share of slots that were busy, and the processor time of rank 0 per run. The share
 * falls when other programs use the machine, the processor time hardly changes.
 *
 *     bench_slots [rounds]     best of so many (default 1) */
#include <math.h>

#include "schemas/clock.h"
#include "tests/bench/farm_store.h"

static void best(double *so_far, double now) {
  if (isnan(*so_far) || now > *so_far)
    *so_far = now;
}

/* Under mpirun: this program again as `bench_slots sleepers slots tasks seconds store`; store: 1, or 0 for none. The
 * sleepers are threads: 1024 processes would load the kernel, not the manager. */
static int sleepers_main(char **argv) {
  struct task_list list;
  struct error error = {0};
  struct farm *farm = NULL;
  struct storing s = {.list = &list};
  const int count = atoi(argv[3]);
  if (farm_start(&(struct farm_options){.slots = atoi(argv[2]), .in_process = true, .use_mpi = farm_under_mpi()},
                 task_work, &farm, &error) != STATUS_OK)
    return 1;
  task_list_new(&list, (size_t)count);
  for (int i = 0; i < count; i++)
    list.tasks[i] = (struct task){.id = (uint64_t)i, .kind = TASK_SLEEP, .amount = atof(argv[4])};
  struct farm_manager manager = task_list_manager(&list);
  const bool store = atoi(argv[5]) && farm_rank(farm) == 0;
  status result = store ? storing_begin(&s, FIXTURE_FRAGMENTS, &error) : STATUS_OK;
  if (store)
    manager = (struct farm_manager){.context = &s, .next = store_next, .report = store_report, .tick = store_ticking};
  if (!result)
    result = farm_run(farm, &manager, &error);
  if (farm_rank(farm) == 0) {
    const struct farm_usage usage = farm_usage(farm);
    printf("%g %g\n", usage.wall_s, usage.manager_cpu_s);
  }
  farm_stop(farm);
  if (store)
    storing_end(&s);
  task_list_free(&list);
  return (int)result;
}

struct many {
  int ranks, slots, runs; /* ranks, slots of each rank, runs of each slot */
  double seconds;
  bool store;
};

/* Prints the share of the slots that were busy, and the processor time of rank 0 per run. */
static void print_many(const char *self, const struct many *m, int rounds) {
  const int slots = m->ranks * m->slots, tasks = slots * m->runs;
  double utilisation = NAN, manager = NAN;
  char command[1024], name[64];
  snprintf(command, sizeof command, "mpirun --oversubscribe --bind-to none -n %d %s sleepers %d %d %g %d 2>/dev/null",
           m->ranks, self, m->slots, tasks, m->seconds, m->store);
  for (int round = 0; round < rounds; round++) {
    double wall, cpu;
    FILE *pipe = popen(command, "r");
    const bool read = pipe && fscanf(pipe, "%lf %lf", &wall, &cpu) == 2;
    if (pipe)
      pclose(pipe);
    if (!read)
      continue;
    best(&utilisation, tasks * m->seconds / (slots * wall));
    best(&manager, -1e6 * cpu / tasks);
  }
  snprintf(name, sizeof name, "farm_%d_slots_%gms%s", slots, 1e3 * m->seconds, m->store ? "_stored" : "");
  printf("%-32s %8.4g of the slots busy, %8.4g us of the manager for a run\n", name, utilisation, -manager);
  fflush(stdout);
}

static void print_many_slots(const char *self, int rounds) {
  static const struct many cells[] = {
      {64, 16, 10, 1, false},    {64, 16, 10, 1, true},     {64, 16, 50, 0.1, true},
      {10, 10, 500, 0.01, true}, {2, 5, 5000, 0.001, true},
  };
  for (size_t i = 0; i < sizeof cells / sizeof cells[0]; i++)
    print_many(self, &cells[i], rounds);
}

int main(int argc, char **argv) {
  if (argc == 6 && strcmp(argv[1], "sleepers") == 0)
    return sleepers_main(argv);
  char self[512] = "";
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  if (readlink("/proc/self/exe", self, sizeof self - 1) < 0)
    return 1;
  print_many_slots(self, argc > 1 && atoi(argv[1]) > 0 ? atoi(argv[1]) : 1);
  return 0;
}

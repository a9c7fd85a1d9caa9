/* One run of a program: its folder, its process and all processes that it starts. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

struct child_end {
  int exit_code, signal; /* signal 0: it exited */
  int refused;           /* errno of exec: the program did not start; 0: it did */
  int64_t peak_memory;   /* B */
  bool late;             /* ended at its time limit */
};

struct child {
  char folder[256]; /* of the run; removed by child_close() */
  int life, report; /* pipes to the keeper */
  int keeper;       /* its process */
};

/* Makes the folder. STATUS_IO. */
status child_open(struct child *child, struct error *error);
/* Writes a file of the folder. STATUS_IO. */
status child_put(const struct child *child, const char *name, const char *text, size_t size, struct error *error);

/* Runs the program in the folder to its end, with "stdout" and "stderr" as files there. Only the listed variables of
 * the environment are set (engine/command/README.md). time_limit in s; memory (address space of a process; 0: no limit)
 * and output (size of a file) in bytes. STATUS_MEMORY: the system refused a process. */
struct child_limits {
  double time;
  size_t memory, output;
};
status child_run(struct child *child, const char *program, char *const *words, const struct child_limits *limits,
                 struct child_end *end, struct error *error);

/* Ends all processes that are left and removes the folder. The same happens when this process dies in any way. */
void child_close(struct child *child);

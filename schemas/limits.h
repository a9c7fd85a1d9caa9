/* Fixed limits that files of several folders share, with the reason of each. A limit of one file stands in that file.
 */
#pragma once

enum {
  /* Bytes of a path with its NUL: PATH_MAX of Linux, whose calls refuse a longer one. */
  LIMITS_PATH = 4096,
  /* Bytes of an error's message: the report of a document with a few dozen errors fits. Errors lie on the stack. */
  LIMITS_MESSAGE = 8192,

  /* Varied inputs (axes) of a store. A view has a column for each, and SQLite's views have at most 2000 columns. */
  LIMITS_AXES_OF_STORE = 1000,
  /* Axes that one table or chart shows in the campaign's units: about as many columns as anybody reads. */
  LIMITS_AXES_OF_TABLE = 64,
  /* Inputs that tell points or pools of runs apart (--by), and those of a sensitivity analysis: their values lie in
   * each pool. Campaigns vary a few. */
  LIMITS_AXES_OF_POOL = 16,

  /* Names in one list of an option (--by, --quantity). The SQL of a group has some columns for each. */
  LIMITS_NAMES = 32,
  /* Options of a command, --help included: more than any has; their table for getopt lies on the stack. */
  LIMITS_OPTIONS = 30,
  /* Engines whose results one store holds. The program has two. */
  LIMITS_ENGINES = 16,
  /* Quantities of one convergence study, and knobs of one scene: a study keeps the values of all pairs. */
  LIMITS_STUDY_QUANTITIES = 8,
  LIMITS_STUDY_KNOBS = 32,
};

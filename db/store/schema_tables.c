/* The tables of db/store/schema.h that are not results of one engine. */
#include "db/store/schema.h"

#include "analysis/statistics/convergence.h"
#include "analysis/statistics/estimates.h"
#include "engine/outcome.h"

static const struct schema_column campaign[] = {
    {"campaign_id", "INTEGER PRIMARY KEY", NULL, "number of the campaign in this store"},
    {"name", "TEXT NOT NULL", NULL, "its name"},
    {"document", "TEXT NOT NULL", NULL, "the campaign file as it was read"},
    {"plan", "TEXT", NULL, "the resolved plan, JSON"},
    {"added_at", "TEXT NOT NULL", NULL, "when it was first run, UTC, ISO 8601"},
};

static const struct schema_column session[] = {
    {"session_id", "INTEGER PRIMARY KEY", NULL, "number of the invocation that computed"},
    {"campaign_id", "INTEGER", NULL,
     "the campaign it computed; NULL in sessions of older programs that computed nothing"},
    {"started_at", "TEXT NOT NULL", NULL, "UTC, ISO 8601, to the millisecond"},
    {"ended_at", "TEXT", NULL, "UTC, ISO 8601; NULL while running or when it was killed"},
    {"outcome", "TEXT", NULL, "how it ended: a status name; NULL while running or when it was killed"},
    {"host", "TEXT NOT NULL", NULL, "machine of the manager"},
    {"pid", "INTEGER NOT NULL", NULL, "process of the manager"},
    {"facts", "TEXT NOT NULL CHECK (json_valid(facts))", NULL,
     "provenance, JSON: version, commit, compiler, flags, processor class, libraries, ranks, slots, command line"},
};

static const struct schema_column point[] = {
    {"point_id", "INTEGER PRIMARY KEY", NULL, "number of the point: one set of input values"},
    {"hash", "BLOB NOT NULL UNIQUE CHECK (length(hash) = 16)", NULL,
     "128-bit hash of engine and active inputs, without seed and results_version"},
    {"digest", "BLOB CHECK (length(digest) = 16)", NULL, "changes when any bit of the point or its inputs changes"},
    {"engine", "TEXT NOT NULL", NULL, "name of the engine"},
    {"scene_name", "TEXT NOT NULL", NULL, "name of the scene the inputs started from"},
    {"scene", "TEXT NOT NULL CHECK (json_valid(scene))", NULL,
     "the resolved scene, JSON, SI units: every active input, defaults too"},
};

static const struct schema_column campaign_point[] = {
    {"campaign_id", "INTEGER NOT NULL REFERENCES campaign (campaign_id)", NULL, "a campaign with this point"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "a point of it; campaigns may share points"},
};

static const struct schema_column point_input[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"path", "TEXT NOT NULL", NULL, "path of an active input in the scene"},
    {"value", "ANY NOT NULL", NULL, "its value in SI units; choices by name, booleans 0 or 1, the keyword off as text"},
};

static const struct schema_column shape_file[] = {
    {"hash", "TEXT NOT NULL UNIQUE", NULL, "SHA-256 of the file, the value of inputs that name one (target.mesh.file)"},
    {"bytes", "BLOB NOT NULL", NULL, "the file as it was read, STL or OBJ"},
};

static const struct schema_column axis[] = {
    {"path", "TEXT NOT NULL PRIMARY KEY", NULL, "path of an input that some campaign varied"},
    {"column_name", "TEXT NOT NULL UNIQUE", NULL, "its column in the views"},
    {"unit", "TEXT", NULL, "SI unit of the input"},
    {"written_unit", "TEXT", NULL, "unit of its values in the campaign: that of tables for people; NULL: SI"},
    {"meaning", "TEXT NOT NULL", NULL, "what the input means"},
};

static const struct schema_column run[] = {
    {"run_id", "INTEGER PRIMARY KEY", NULL, "number of the run in this store"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point it belongs to"},
    {"session_id", "INTEGER REFERENCES session (session_id)", NULL, "the session that computed it"},
    {"identity", "BLOB NOT NULL UNIQUE CHECK (length(identity) = 16)", NULL,
     "128-bit hash of engine, results_version, active inputs and seed: the same run is never stored twice"},
    {"replicate", "INTEGER NOT NULL", NULL, "which seed of the point, from 0"},
    {"seed", "INTEGER NOT NULL", NULL, "the seed (64 bits, shown as a signed number)"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results; statistics never mix two"},
    {"surplus", "INTEGER NOT NULL", NULL, "1: beyond the prefix a stopping rule decided on; left out of statistics"},
    {"attempt", "INTEGER NOT NULL", NULL, "which attempt succeeded, from 1"},
    {"wall_time", "REAL NOT NULL", "s", "elapsed time of the successful attempt"},
    {"cpu_time", "REAL NOT NULL", "s", "processor time of the successful attempt"},
    {"peak_memory", "INTEGER NOT NULL", "B", "largest resident memory of the successful attempt"},
    {"host", "TEXT", NULL, "machine that computed it"},
    {"rank", "INTEGER NOT NULL", NULL, "MPI rank that computed it"},
    {"finished_at", "REAL NOT NULL", "s", "when it was stored, seconds since 1970-01-01 UTC"},
    {"fields_path", "TEXT", NULL, "HDF5 file with its fields, relative to the store's folder; NULL when none was kept"},
    {"counts", "INTEGER NOT NULL", NULL,
     "1: part of the statistics (not surplus, completed or ended at its time, the main results are numbers)"},
    {"digest", "BLOB CHECK (length(digest) = 16)", NULL,
     "changes when any bit changes of what the run determined: results, masses, estimates, seed, identity"},
};

static const struct schema_column fragment_mass[] = {
    {"run_id", "INTEGER PRIMARY KEY REFERENCES run (run_id)", NULL, "the run"},
    {"masses", "BLOB NOT NULL", "kg", "mass of every fragment, descending: little-endian float64, 8 bytes each"},
};

static const struct schema_column bin[] = {
    {"bin", "INTEGER PRIMARY KEY", NULL, "number of a mass bin: ten per decade, bin 0 starts at 1 kg"},
    {"lower", "REAL NOT NULL", "kg", "lower edge, inside the bin"},
    {"upper", "REAL NOT NULL", "kg", "upper edge, outside the bin"},
};

static const struct schema_column spectrum[] = {
    {"run_id", "INTEGER NOT NULL REFERENCES run (run_id)", NULL, "the run"},
    {"bin", "INTEGER NOT NULL", NULL, "mass bin (table bin); only bins that hold something"},
    {"count", "INTEGER NOT NULL", "1", "fragments in the bin"},
    {"mass", "REAL NOT NULL", "kg", "their mass"},
};

static const struct schema_column point_total[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
    {"runs", "INTEGER NOT NULL", "1", "runs that count: completed, or ended at their time, and not surplus"},
    {"censored", "INTEGER NOT NULL", "1",
     "runs that count and ended at their time: fragments may still have been breaking"},
    {"failed", "INTEGER NOT NULL", "1", "runs that gave no usable result (NaN, time step, energy, invalid)"},
    {"surplus", "INTEGER NOT NULL", "1", "runs left out because a stopping rule decided without them"},
    {"fragments", "INTEGER NOT NULL", "1", "fragments of the runs that count"},
    {"mass", "REAL NOT NULL", "kg", "mass of these fragments"},
};

static const struct schema_column point_spectrum[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
    {"bin", "INTEGER NOT NULL", NULL, "mass bin (table bin)"},
    {"runs", "INTEGER NOT NULL", "1", "runs that count and have a fragment in the bin"},
    {"count", "INTEGER NOT NULL", "1", "sum of their counts"},
    {"count_squared", "INTEGER NOT NULL", "1", "sum of the squares of their counts, for the scatter between runs"},
    {"mass", "REAL NOT NULL", "kg", "sum of their masses"},
};

static const struct schema_column estimate[] = {
    {"run_id", "INTEGER NOT NULL REFERENCES run (run_id)", NULL, "the run"},
    {"ordinal", "INTEGER NOT NULL", NULL, "number among the estimates of the run"},
};

static const struct schema_column point_estimate[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results it was made from"},
    {"ordinal", "INTEGER NOT NULL", NULL, "number among the estimates of the point"},
};

static const struct schema_column attempt[] = {
    {"attempt_id", "INTEGER PRIMARY KEY", NULL, "number of the failed attempt"},
    {"identity", "BLOB NOT NULL CHECK (length(identity) = 16)", NULL, "identity of the run that was tried"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "its point"},
    {"replicate", "INTEGER NOT NULL", NULL, "which seed of the point, from 0"},
    {"seed", "INTEGER NOT NULL", NULL, "the seed (64 bits, shown as a signed number)"},
    {"session_id", "INTEGER REFERENCES session (session_id)", NULL, "the session that tried"},
    {"number", "INTEGER NOT NULL", NULL, "which attempt, from 1"},
    {"reason", "TEXT NOT NULL", NULL, "time_limit, memory_limit, crash, lost or exit"},
    {"exit_code", "INTEGER NOT NULL", NULL, "exit code of the process"},
    {"signal", "INTEGER NOT NULL", NULL, "signal that ended it, 0 for none"},
    {"wall_time", "REAL NOT NULL", "s", "elapsed time"},
    {"peak_memory", "INTEGER NOT NULL", "B", "largest resident memory"},
    {"limited_to", "REAL NOT NULL", NULL, "the limit that ended it: seconds or bytes, 0 for the other reasons"},
    {"message", "TEXT NOT NULL", NULL, "its message"},
    {"host", "TEXT", NULL, "machine"},
    {"rank", "INTEGER NOT NULL", NULL, "MPI rank"},
    {"failed_at", "REAL NOT NULL", "s", "when, seconds since 1970-01-01 UTC"},
};

static const struct schema_column convergence[] = {
    {"base_point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the scene studied, as a point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
    {"level", "INTEGER NOT NULL", NULL, "number of the level, from 0, coarse to fine"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the level, as a point: its runs are in run"},
};

static const struct schema_column convergence_limit[] = {
    {"base_point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the scene studied, as a point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
};

static const struct schema_column holder[] = {
    {"holder_id", "INTEGER PRIMARY KEY CHECK (holder_id = 1)", NULL, "always 1"},
    {"host", "TEXT NOT NULL", NULL, "machine of the process that last opened the store for writing"},
    {"pid", "INTEGER NOT NULL", NULL,
     "its process number; the row only names the holder, the store is held by an OS lock"},
    {"since", "TEXT NOT NULL", NULL, "when it did, UTC, ISO 8601"},
};

static const struct schema_column column_doc[] = {
    {"table_name", "TEXT NOT NULL", NULL, "table or view"},
    {"column_name", "TEXT NOT NULL", NULL, "column of it"},
    {"unit", "TEXT", NULL, "SI unit; NULL where there is none"},
    {"meaning", "TEXT NOT NULL", NULL, "what the column holds"},
    {"deterministic", "INTEGER NOT NULL DEFAULT 0", NULL,
     "1: a result that depends on inputs, seed and results_version alone (not a time, a host...)"},
};

#define TABLE(table_, meaning_, ...)                                                                                   \
  { .name = #table_, .meaning = meaning_, .columns = table_, .count = sizeof table_ / sizeof table_[0], __VA_ARGS__ }
#define ROWID           .options = "STRICT"
#define CLUSTERED(key_) .options = "STRICT, WITHOUT ROWID", .tail = "PRIMARY KEY (" key_ ")"

const struct schema_table schema_tables[] = {
    TABLE(column_doc, "Meaning and unit of every column.", CLUSTERED("table_name, column_name")),
    TABLE(campaign, "Campaigns, as their files were read.", ROWID),
    TABLE(session, "Provenance: one row per invocation that wrote to the store.", ROWID),
    TABLE(point, "Points: sets of input values. The resolved scene is the truth.", ROWID),
    TABLE(campaign_point, "Which campaign has which point.", CLUSTERED("campaign_id, point_id")),
    TABLE(point_input, "Every active input of every point.", CLUSTERED("point_id, path")),
    TABLE(shape_file, "Shape files of bodies, each once.", ROWID),
    TABLE(axis, "Inputs that some campaign varied: columns of the views.", .options = "STRICT, WITHOUT ROWID"),
    TABLE(run, "Runs: one simulation of a point with a seed, and what every engine reports of it.", ROWID,
          .fields = &outcome_table),
    TABLE(fragment_mass, "Fragment masses: any spectrum can be made from them without a new run.", ROWID),
    TABLE(bin, "Edges of the mass bins in use.", ROWID),
    TABLE(spectrum, "Fragment mass spectrum of each run.", CLUSTERED("run_id, bin")),
    TABLE(point_total, "Running totals of each point, kept in the transaction that adds the runs.",
          CLUSTERED("point_id, results_version")),
    TABLE(point_spectrum, "Running pooled spectrum of each point, kept in the transaction that adds the runs.",
          CLUSTERED("point_id, results_version, bin")),
    TABLE(estimate, "Estimates made from the fragments of one run; they can be made again at any time.",
          CLUSTERED("run_id, ordinal"), .fields = &estimates_table),
    TABLE(point_estimate, "Estimates pooled over the runs of a point that count.",
          CLUSTERED("point_id, results_version, ordinal"), .fields = &estimates_table),
    TABLE(attempt, "Attempts that failed: limits, crashes, lost workers.", ROWID),
    TABLE(convergence, "Studies of convergence (clast converge): the levels of each knob, for each quantity.",
          CLUSTERED("base_point_id, results_version, knob, quantity, level"), .fields = &convergence_table),
    TABLE(convergence_limit, "Order and limit of each knob of a study, for each quantity.",
          CLUSTERED("base_point_id, results_version, knob, quantity"), .fields = &convergence_limit_table),
    TABLE(holder, "The process that holds the store for writing, for the message of a refusal.", ROWID),
};
const size_t schema_tables_count = sizeof schema_tables / sizeof schema_tables[0];

/* run_statistics covers the means and scatters of the view `points`. Its order does not depend on which run finished
 * first, so the sums have the same bits for any number of workers. */
const struct schema_index schema_tables_indexes[] = {
    {"run", "run_statistics", "point_id, results_version, counts, replicate, seed, state", true},
    {"attempt", "attempt_identity", "identity", false},
    {"attempt", "attempt_point", "point_id", false},
};
const size_t schema_tables_indexes_count = sizeof schema_tables_indexes / sizeof schema_tables_indexes[0];

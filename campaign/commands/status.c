/* `clast status STORE`: how far each campaign of a store is. */
#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"

struct options {
  struct table_options table;
};

static const char sql[] =
    "with done as (select campaign_id, count(*) as runs, sum(counts) as counted,"
    "   sum(counts and state = 'end-time') as censored,"
    "   sum(state not in ('completed', 'end-time')) as failed, sum(surplus) as surplus, sum(cpu_time) as cpu_time"
    "   from campaign_point join run using (point_id) group by campaign_id),"
    " tried as (select campaign_id, count(*) as failed_attempts"
    "   from campaign_point join attempt using (point_id) group by campaign_id),"
    " given_up as (select campaign_id, count(distinct attempt.identity) as without_result"
    "   from campaign_point join attempt using (point_id)"
    "   where not exists (select 1 from run where run.identity = attempt.identity) group by campaign_id),"
    " last as (select started_at, ended_at, outcome, host, pid from session order by session_id desc limit 1)"
    " select campaign_id as campaign, name,"
    "   (select count(*) from campaign_point as p where p.campaign_id = campaign.campaign_id) as points,"
    "   coalesce(runs, 0) as runs, coalesce(counted, 0) as counted, coalesce(censored, 0) as censored,"
    "   coalesce(failed, 0) as failed, coalesce(surplus, 0) as surplus,"
    "   coalesce(failed_attempts, 0) as failed_attempts, coalesce(without_result, 0) as without_result,"
    "   coalesce(cpu_time, 0.0) as cpu_time,"
    "   last.started_at as last_started, last.ended_at as last_ended,"
    "   coalesce(last.outcome, 'running or killed') as last_outcome"
    " from campaign left join done using (campaign_id) left join tried using (campaign_id)"
    " left join given_up using (campaign_id) left join last on true order by campaign_id";

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  status code = table_choose(&options->table, &format, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = rows_print(store, sql, 0, NULL, format, stdout, error);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {TABLE_OPTIONS(struct options, table)};

const struct command status_command = {
    .name = "status",
    .group = "results",
    .arguments = "STORE",
    .summary = "how far the campaigns of a store are, and what failed",
    .doc =
        "One row per campaign: points, runs stored, those that count in statistics, censored (ended at the hard end\n"
        "time), failed, surplus; failed attempts, runs given up without a result; and how the last session ended.\n"
        "Works while a campaign is running.",
    .examples = "clast status out.db\nclast status out.db --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};

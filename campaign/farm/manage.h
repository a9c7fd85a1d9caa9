/* The manager of a farm, shared by manage.c (the loop), manage_send.c (tasks out) and manage_take.c (results in). */
#ifndef CLAST_CAMPAIGN_FARM_MANAGE_H
#define CLAST_CAMPAIGN_FARM_MANAGE_H

#include "campaign/farm/private.h"

struct manager {
  struct farm *farm;
  const struct farm_manager *calls;
  struct error *error;            /* error of the first reason to end */
  struct error later;             /* later errors */
  struct farm_job_table table;    /* all jobs that were taken and not yet reported */
  struct farm_job_queue returned; /* jobs that came back from their rank and wait for another rank */
  bool dry;                       /* the last call of next() gave no task */
  bool draining;                  /* no more tasks go out */
  bool dropping;                  /* running tasks are killed */
  bool silent;                    /* nothing more is reported to the caller */
  status final;
  int64_t drop_ns;           /* time at which draining becomes dropping */
  int64_t signal_ns;         /* time of the first stop signal; 0: none came */
  int64_t first_ns, last_ns; /* times of the first task sent and the last result taken */
  int64_t ticked_ns, looped_ns, sleep_ns;
  int watched; /* readable when a signal or an order has come */
  struct farm_usage usage;
};

/* The error to write to: only the first reason to end is kept. */
static inline struct error *farm_manage_error(struct manager *m) {
  return m->final == STATUS_OK ? m->error : &m->later;
}

/* Stops sending tasks. Kills the tasks that still run after grace_s. */
void farm_manage_drain(struct manager *m, status reason, double grace_s);
/* Ends the farm immediately, unless the reason is STATUS_OK. */
void farm_manage_fail(struct manager *m, status reason);
/* Handles the status of a callback: STATUS_STOPPED drains the farm, another error ends it immediately. */
void farm_manage_obey(struct manager *m, status said);
/* Handles a stop signal: drains the farm for the time that this signal grants. */
void farm_manage_stop(struct manager *m, int signal);

/* Sends the caller's tasks to the ranks. */
void farm_manage_send(struct manager *m);
/* Moves jobs that wait at one rank to idle slots of another, at the end of a campaign. */
void farm_manage_send_balance(struct manager *m);
/* Handles a job that has left its rank: it waits for another rank, or is dropped when no more tasks are sent. */
void farm_manage_send_back(struct manager *m, struct farm_job *job);
/* Asks a rank for all jobs that it has not begun; asks all ranks. */
void farm_manage_send_recall(struct manager *m, int rank);
void farm_manage_send_recall_all(struct manager *m);

/* Takes a message of a rank; takes a job that the manager's own pool has ended. `context` is the manager. */
status farm_manage_take(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                        struct error *error);
void farm_manage_take_own(void *context, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                          const char *message, size_t message_size);
/* Handles a rank that no longer answers. */
void farm_manage_take_loss(struct manager *m, int rank);

#endif

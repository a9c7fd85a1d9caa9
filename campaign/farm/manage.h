/* The manager of a farm, shared by manage.c (the loop), manage_send.c (tasks out) and manage_take.c (results in). */
#ifndef CLAST_CAMPAIGN_FARM_MANAGE_H
#define CLAST_CAMPAIGN_FARM_MANAGE_H

#include "campaign/farm/private.h"

struct manager {
  struct farm *farm;
  const struct farm_manager *calls;
  struct error *error;            /* of the first reason to end */
  struct error later;             /* errors after that one */
  struct farm_job_table table;    /* all jobs that were taken and not reported */
  struct farm_job_queue returned; /* jobs that came back from their rank and wait for another */
  bool dry;                       /* the caller had no task when asked last */
  bool draining;                  /* no more tasks go out */
  bool dropping;                  /* what still computes is killed */
  bool silent;                    /* nothing more is reported to the caller */
  status final;
  int64_t drop_ns;           /* draining becomes dropping */
  int64_t signal_ns;         /* the first stop signal; 0: none came */
  int64_t first_ns, last_ns; /* of tasks sent and results taken */
  int64_t ticked_ns, looped_ns, sleep_ns;
  int watched; /* readable when a signal or an order has come */
  struct farm_usage usage;
};

/* Where an error is written: only the first reason to end is kept. */
static inline struct error *farm_manage_error(struct manager *m) {
  return m->final == STATUS_OK ? m->error : &m->later;
}

/* No more tasks go out. What still computes after grace_s is killed. */
void farm_manage_drain(struct manager *m, status reason, double grace_s);
/* Ends the farm at once, unless the reason is STATUS_OK. */
void farm_manage_fail(struct manager *m, status reason);
/* What a call of the caller returned: STATUS_STOPPED drains the farm, another error ends it at once. */
void farm_manage_obey(struct manager *m, status said);
/* A stop signal has come: drains the farm for the time that it grants. */
void farm_manage_stop(struct manager *m, int signal);

/* Fills the ranks with the caller's tasks. */
void farm_manage_send(struct manager *m);
/* At the end of a campaign: jobs that wait at one rank go to idle slots of another. */
void farm_manage_send_balance(struct manager *m);
/* The job is at no rank now: it waits for another one, or is dropped when nothing more goes out. */
void farm_manage_send_back(struct manager *m, struct farm_job *job);
/* Asks a rank for its jobs that it has not begun; of all ranks. */
void farm_manage_send_recall(struct manager *m, int rank);
void farm_manage_send_recall_all(struct manager *m);

/* A message of a rank, and a job that the manager's own pool has ended. `context` is the manager. */
status farm_manage_take(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                        struct error *error);
void farm_manage_take_own(void *context, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                          const char *message, size_t message_size);
/* The rank does not answer any more. */
void farm_manage_take_loss(struct manager *m, int rank);

#endif

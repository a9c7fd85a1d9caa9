/* HTTP on one port, without a thread of its own: the farm's manager calls it when a message has arrived. */
#ifndef CLAST_CAMPAIGN_SERVE_HTTP_H
#define CLAST_CAMPAIGN_SERVE_HTTP_H

#include "campaign/serve/jobs.h"

enum {
  SERVE_HTTP_BODY = 1 << 20,    /* most bytes of a request */
  SERVE_HTTP_CONNECTIONS = 512, /* most connections at a time */
  SERVE_HTTP_IDLE_S = 60,       /* a connection that sends nothing is closed */
};

struct serve_http;

/* Listens at `address` ("127.0.0.1", "::1", "0.0.0.0") and `port` (0: any free one). STATUS_USAGE: no such address;
 * STATUS_IO: it is taken. */
status serve_http_open(const struct serve_model *model, const char *address, int port, struct serve_http **out,
                       struct error *error);
/* Must be called before the first serve_http_run. */
void serve_http_jobs(struct serve_http *http, struct serve_jobs *jobs);
int serve_http_port(const struct serve_http *http);
int serve_http_file(const struct serve_http *http); /* readable when there is something to do */
bool serve_http_loopback(const struct serve_http *http);

void serve_http_run(struct serve_http *http); /* reads and writes without waiting */
/* For serve_jobs_options.answered; context: the struct serve_http. */
void serve_http_answered(void *context, void *ticket, struct serve_answer answer);

/* All evaluations must have been answered. Sends the remaining answers for at most a second. NULL is fine. */
void serve_http_close(struct serve_http *http);

#endif

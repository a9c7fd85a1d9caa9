/* Connections of libmicrohttpd. An evaluation under way suspends its connection. */
#include "campaign/serve/serve.h"

#include <arpa/inet.h>
#include <errno.h>
#include <microhttpd.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "engine/grow.h"
#include "schemas/clock.h"
#include "schemas/memory.h"

struct serve_http {
  struct MHD_Daemon *daemon;
  const struct serve_model *model;
  struct serve *serve;
  const char *token;
  size_t exchanges; /* requests whose answers are not completely sent */
  uint64_t events;  /* counts pieces of requests received and answers sent */
  bool loopback;
};

struct exchange { /* one request */
  struct serve_http *http;
  struct MHD_Connection *connection;
  char *body;
  size_t size, capacity;
  struct serve_answer answer;
};

static enum MHD_Result send_answer(struct exchange *exchange) {
  struct serve_answer *answer = &exchange->answer;
  if (!answer->body)
    return MHD_NO; /* no memory: the connection is closed */
  struct MHD_Response *response = MHD_create_response_from_buffer(strlen(answer->body), answer->body,
                                                                  MHD_RESPMEM_MUST_FREE);
  if (!response)
    return MHD_NO;
  answer->body = NULL;
  MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, "application/json");
  if (answer->http == 405)
    MHD_add_response_header(response, MHD_HTTP_HEADER_ALLOW, "GET, HEAD, POST");
  if (answer->http == MHD_HTTP_UNAUTHORIZED)
    MHD_add_response_header(response, MHD_HTTP_HEADER_WWW_AUTHENTICATE, "Basic realm=\"clast\"");
  const enum MHD_Result queued = MHD_queue_response(exchange->connection, answer->http, response);
  MHD_destroy_response(response);
  return queued;
}

static struct serve_answer too_large(void) {
  return serve_request_error(MHD_HTTP_CONTENT_TOO_LARGE, "InvalidInput", "the body is larger than 1 MiB");
}

/* Is the Host of a request an address or localhost, with a port or without? A web page can make the name of its own
 * server lead to this machine (DNS rebinding), but its browser then sends that name. */
static bool is_address(const char *host) {
  char name[INET6_ADDRSTRLEN] = "";
  unsigned char bytes[sizeof(struct in6_addr)];
  const bool bracket = *host == '[';
  const size_t length = strcspn(host + bracket, bracket ? "]" : ":");
  if (length >= sizeof name)
    return false;
  memcpy(name, host + bracket, length);
  return bracket ? inet_pton(AF_INET6, name, bytes) == 1
                 : strcasecmp(name, "localhost") == 0 || inet_pton(AF_INET, name, bytes) == 1;
}

static bool same_word(const char *a, const char *b) { /* its time does not tell where they differ */
  const size_t size = strlen(b);
  unsigned char other = strlen(a) != size;
  for (size_t i = 0; i < size && a[i]; i++)
    other |= (unsigned char)(a[i] ^ b[i]);
  return other == 0;
}

/* The token as `Authorization: Bearer TOKEN`, or as password of a URL: http://clast:TOKEN@localhost:4242. */
static bool has_token(const char *token, struct MHD_Connection *connection) {
  static const char bearer[] = "Bearer ";
  const char *given = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_AUTHORIZATION);
  char *password = NULL;
  if (given && strncasecmp(given, bearer, strlen(bearer)) == 0)
    return same_word(given + strlen(bearer), token);
  char *user = MHD_basic_auth_get_username_password(connection, &password);
  const bool right = password && same_word(password, token);
  MHD_free(user);
  MHD_free(password);
  return right;
}

/* A web page in a browser on this machine could also send requests to a loopback port. Browsers send the origin of the
 * page, other clients do not. */
static struct serve_answer refused_at_once(const struct serve_http *server, struct MHD_Connection *connection) {
  const char *length = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_CONTENT_LENGTH);
  const char *host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_HOST);
  if (server->token && !has_token(server->token, connection))
    return serve_request_error(MHD_HTTP_UNAUTHORIZED, "InvalidInput",
                               "the request needs the token of the server, as bearer token or as password");
  if (MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_ORIGIN))
    return serve_request_error(MHD_HTTP_FORBIDDEN, "InvalidInput",
                               "requests of web pages (with an Origin) are refused");
  if (server->loopback && host && !is_address(host))
    return serve_request_error(MHD_HTTP_FORBIDDEN, "InvalidInput",
                               "the server is for this machine alone: call it localhost or by its address");
  if (length && strtoull(length, NULL, 10) > SERVE_HTTP_BODY)
    return too_large();
  return (struct serve_answer){0};
}

static enum MHD_Result begin(struct serve_http *http, struct MHD_Connection *connection, void **context) {
  struct exchange *exchange = *context = memory_small(1, sizeof *exchange);
  *exchange = (struct exchange){.http = http, .connection = connection};
  http->exchanges++;
  exchange->answer = refused_at_once(http, connection);
  return exchange->answer.http ? send_answer(exchange) : MHD_YES;
}

/* Answers a complete request, or suspends the connection. */
static enum MHD_Result judge(struct exchange *exchange, const char *method, const char *url) {
  struct serve_request request;
  if (serve_request_read(exchange->http->model, method, url, exchange->body ? exchange->body : "", exchange->size,
                         &request, &exchange->answer))
    exchange->answer = serve_submit(exchange->http->serve, &request, exchange);
  if (exchange->answer.http)
    return send_answer(exchange);
  MHD_suspend_connection(exchange->connection);
  return MHD_YES;
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                              const char *version, const char *upload, size_t *upload_size, void **own) {
  struct exchange *exchange = *own;
  (void)version;
  ((struct serve_http *)context)->events++;
  if (!exchange)
    return begin(context, connection, own);
  if (*upload_size > 0) {
    const size_t size = *upload_size, whole = exchange->size + size;
    *upload_size = 0;
    if (whole > SERVE_HTTP_BODY) /* sent without a length: the rest is read and discarded */
      exchange->answer.http = MHD_HTTP_CONTENT_TOO_LARGE;
    if (exchange->answer.http)
      return MHD_YES;
    if (!grow_room(&exchange->body, &exchange->capacity, whole, sizeof *exchange->body))
      return MHD_NO;
    memcpy(exchange->body + exchange->size, upload, size);
    exchange->size = whole;
    return MHD_YES;
  }
  if (exchange->answer.http == MHD_HTTP_CONTENT_TOO_LARGE && !exchange->answer.body)
    exchange->answer = too_large();
  return exchange->answer.http ? send_answer(exchange) : judge(exchange, method, url);
}

static void completed(void *context, struct MHD_Connection *connection, void **own,
                      enum MHD_RequestTerminationCode code) {
  struct serve_http *http = context;
  struct exchange *exchange = *own;
  (void)connection, (void)code;
  if (!exchange)
    return;
  http->exchanges--;
  http->events++;
  free(exchange->body);
  free(exchange->answer.body);
  free(exchange);
  *own = NULL;
}

void serve_http_answer(void *ticket, struct serve_answer answer) {
  struct exchange *exchange = ticket;
  exchange->answer = answer;
  MHD_resume_connection(exchange->connection);
}

/* ---- the port ---- */

static bool read_address(const char *text, int port, struct sockaddr_storage *address, bool *loopback) {
  struct sockaddr_in *four = (struct sockaddr_in *)address;
  struct sockaddr_in6 *six = (struct sockaddr_in6 *)address;
  memset(address, 0, sizeof *address);
  if (inet_pton(AF_INET, text, &four->sin_addr) == 1) {
    four->sin_family = AF_INET;
    four->sin_port = htons((uint16_t)port);
    *loopback = ntohl(four->sin_addr.s_addr) >> 24 == 127;
    return true;
  }
  if (inet_pton(AF_INET6, text, &six->sin6_addr) != 1)
    return false;
  six->sin6_family = AF_INET6;
  six->sin6_port = htons((uint16_t)port);
  *loopback = IN6_IS_ADDR_LOOPBACK(&six->sin6_addr);
  return true;
}

status serve_http_open(const struct serve_model *model, struct serve *serve, const struct serve_options *options,
                       struct serve_http **out, struct error *error) {
  const char *address = options->address;
  const int port = options->port;
  struct sockaddr_storage place;
  bool loopback;
  if (!read_address(address, port, &place, &loopback))
    return status_fail(error, STATUS_USAGE,
                       "--listen expects an address such as 127.0.0.1, ::1 or 0.0.0.0, got \"%.64s\"", address);
  struct serve_http *http = *out = memory_small(1, sizeof *http);
  *http = (struct serve_http){.model = model, .serve = serve, .token = options->token, .loopback = loopback};
  const unsigned flags = MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME | (place.ss_family == AF_INET6 ? MHD_USE_IPv6 : 0);
  errno = 0;
  http->daemon = MHD_start_daemon(flags, (uint16_t)port, NULL, NULL, handle, http, MHD_OPTION_SOCK_ADDR, &place,
                                  MHD_OPTION_CONNECTION_LIMIT, (unsigned)SERVE_HTTP_CONNECTIONS,
                                  MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)SERVE_HTTP_IDLE_S,
                                  MHD_OPTION_NOTIFY_COMPLETED, completed, http, MHD_OPTION_END);
  if (http->daemon)
    return STATUS_OK;
  const int why = errno;
  return status_fail(error, STATUS_IO, "cannot listen at %s, port %d: %s", address, port,
                     why ? strerror(why) : "it may be in use; name another --port");
}

int serve_http_port(const struct serve_http *http) {
  return MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
}

int serve_http_file(const struct serve_http *http) {
  return MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_EPOLL_FD)->epoll_fd;
}

bool serve_http_open_to_all(const struct serve_http *http) {
  return !http->loopback && !http->token;
}

/* Repeats while the library has work: it takes a request in pieces, also one that it received together with an earlier
 * one, but its file descriptor is readable only for the first piece. */
void serve_http_run(struct serve_http *http) {
  const int64_t until = clock_ns() + CLOCK_S / 20; /* then the farm gets its turn */
  uint64_t before;
  MHD_UNSIGNED_LONG_LONG wait_ms = 0;
  do {
    before = http->events;
    MHD_run(http->daemon);
  } while ((http->events != before || (MHD_get_timeout(http->daemon, &wait_ms) == MHD_YES && wait_ms == 0)) &&
           clock_ns() < until);
}

void serve_http_close(struct serve_http *http) {
  if (!http)
    return;
  const int64_t until = clock_ns() + CLOCK_S;
  while (http->daemon && http->exchanges > 0 && clock_ns() < until) {
    struct pollfd file = {.fd = serve_http_file(http), .events = POLLIN};
    MHD_run(http->daemon);
    poll(&file, 1, 10);
  }
  if (http->daemon)
    MHD_stop_daemon(http->daemon);
  free(http);
}

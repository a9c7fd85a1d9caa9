/* The message format between manager, slots, children (pipes and sockets) and ranks (MPI).
 *
 * A frame is a 32-byte head and a payload padded to 16 bytes, so that payloads stay aligned in a buffer of frames. The
 * head's magic number holds the version. The check covers head and payload, so that a damaged or foreign frame is
 * reported and never crashes the program. Byte order is the machine's: all ranks run the same program on the same kind
 * of machine. */
#ifndef CLAST_CAMPAIGN_FARM_FRAME_H
#define CLAST_CAMPAIGN_FARM_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/uio.h>

/* "CLF1"; the digit is the version: raise it when any payload changes. */
#define FARM_FRAME_MAGIC UINT32_C(0x31464c43)
/* Most bytes of payload, because MPI counts are int. A larger size means a damaged frame. */
#define FARM_FRAME_LARGEST ((size_t)1 << 30)

enum farm_frame_kind {
  FARM_FRAME_TASK = 1, /* manager -> slot or rank: the task's bytes */
  FARM_FRAME_RESULT,   /* slot or rank -> manager: struct farm_result, result bytes, message */
  FARM_FRAME_ANSWER,   /* child -> its slot: int64 status, result bytes or message */
  FARM_FRAME_HELLO,    /* rank -> manager: struct farm_hello */
  FARM_FRAME_ALIVE,    /* rank -> manager: heartbeat; handle = slots alive */
  FARM_FRAME_SIGNAL,   /* rank -> manager: handle = signal number */
  FARM_FRAME_RECALL,   /* manager -> rank: give back up to `handle` tasks that have not begun */
  FARM_FRAME_RETURNED, /* rank -> manager: this task had not begun and is given back */
  FARM_FRAME_RECALLED, /* rank -> manager: the recall is answered */
  FARM_FRAME_END,      /* manager -> rank: struct farm_end, message */
  FARM_FRAME_BYE,      /* rank -> manager: double, CPU seconds of the rank's main process in this run */
  FARM_FRAME_FINALIZE, /* manager -> rank: call MPI_Finalize now */
};

struct farm_frame {
  uint32_t magic;
  uint16_t kind, ticket; /* ticket: see slot.h */
  uint64_t handle;       /* identifies the task; other meanings above */
  uint64_t size;         /* of the payload without padding */
  uint64_t check;
};

/* Head of a RESULT payload; `size` result bytes follow, then the message. */
struct farm_result {
  int32_t ending, exit_code, signal, slot;
  double wall_s, cpu_s;
  int64_t peak_memory;
  uint64_t size;
};

/* A growing byte queue. data[begin..end) is its content; `begin` moves by whole frames, so that it stays aligned. */
struct farm_bytes {
  uint8_t *data;
  size_t begin, end, capacity;
};

/* Makes space for `more` bytes at data+end. May move the content. False when memory is refused; nothing has changed
 * then. */
bool farm_frame_reserve(struct farm_bytes *bytes, size_t more);
void farm_frame_free(struct farm_bytes *bytes); /* leaves the queue empty and ready for use */
/* For an empty queue: keeps a small buffer for the next use and frees a large one. */
void farm_frame_trim(struct farm_bytes *bytes);

/* Appends a frame. Its payload is the parts one after the other. False when memory is refused or the payload is too
 * large. */
bool farm_frame_append(struct farm_bytes *bytes, enum farm_frame_kind kind, uint16_t ticket, uint64_t handle, int parts,
                       const struct iovec *part);
/* Takes the first frame out of the queue. 1: found; its payload is borrowed until the next reserve or append. 0: the
 * frame is incomplete. -1: damaged. */
int farm_frame_next(struct farm_bytes *bytes, struct farm_frame *frame, const uint8_t **payload);
/* Bytes to reserve before reading: the missing bytes of the first, incomplete frame, at least `minimum`. */
size_t farm_frame_missing(const struct farm_bytes *bytes, size_t minimum);

#endif

/* Frames: complete ones are received unchanged however the stream is cut; incomplete and foreign bytes are detected.
 * Jobs: handles. */

#include "campaign/farm/farm_private.h"
#include "tests/support/check.h"

static void append(struct farm_bytes *bytes, uint64_t handle, size_t size) {
  OWNED uint8_t *payload = malloc(size + 1);
  memset(payload, (int)(handle & 0xff), size + 1);
  struct iovec part[2] = {{payload, size / 3}, {payload + size / 3, size - size / 3}};
  assert_true(farm_frame_append(bytes, FARM_FRAME_TASK, 7, handle, 2, part));
}

/* Delivered in pieces of every small size: the same frames, payloads aligned. */
TEST(any_cut) {
  OWNED_BY(farm_frame_free) struct farm_bytes whole = {0};
  for (uint64_t i = 0; i < 40; i++)
    append(&whole, i, (size_t)(i * i * 7));
  for (size_t piece = 1; piece < 200; piece += 13) {
    OWNED_BY(farm_frame_free) struct farm_bytes in = {0};
    uint64_t expected = 0;
    for (size_t at = 0; at < whole.end; at += piece) {
      const size_t n = whole.end - at < piece ? whole.end - at : piece;
      assert_true(farm_frame_reserve(&in, farm_frame_missing(&in, n)));
      memcpy(in.data + in.end, whole.data + at, n);
      in.end += n;
      struct farm_frame frame;
      const uint8_t *payload;
      int got;
      while ((got = farm_frame_next(&in, &frame, &payload)) == 1) {
        assert_int_equal(frame.handle, expected);
        assert_int_equal(frame.size, expected * expected * 7);
        assert_int_equal(frame.kind, FARM_FRAME_TASK);
        assert_int_equal(frame.ticket, 7);
        assert_int_equal((uintptr_t)payload % 16, 0);
        for (size_t i = 0; i < frame.size; i++)
          assert_int_equal(payload[i], expected & 0xff);
        expected++;
      }
      assert_int_equal(got, 0);
    }
    assert_int_equal(expected, 40);
  }
}

/* A change of any single bit of a frame is detected, except in padding, which carries no data. */
TEST(any_flipped_bit) {
  OWNED_BY(farm_frame_free) struct farm_bytes bytes = {0};
  append(&bytes, 5, 100);
  for (size_t bit = 0; bit < 8 * (sizeof(struct farm_frame) + 100); bit++) {
    struct farm_frame frame;
    const uint8_t *payload;
    bytes.data[bit / 8] ^= (uint8_t)(1u << (bit % 8));
    const int got = farm_frame_next(&bytes, &frame, &payload);
    assert_true(got < 1); /* 0: the changed size is larger, so the reader waits for more */
    bytes.data[bit / 8] ^= (uint8_t)(1u << (bit % 8));
  }
  struct farm_frame frame;
  const uint8_t *payload;
  assert_int_equal(farm_frame_next(&bytes, &frame, &payload), 1);
  assert_int_equal(farm_frame_next(&bytes, &frame, &payload), 0);
}

TEST(foreign_and_oversized) {
  struct farm_bytes bytes = {0};
  struct farm_frame frame = {.magic = FARM_FRAME_MAGIC + (1u << 24), .kind = FARM_FRAME_TASK}; /* version 2 */
  const uint8_t *payload;
  assert_true(farm_frame_reserve(&bytes, 1000));
  memcpy(bytes.data, &frame, sizeof frame);
  bytes.end = 1000;
  assert_int_equal(farm_frame_next(&bytes, &frame, &payload), -1);
  frame = (struct farm_frame){.magic = FARM_FRAME_MAGIC, .size = UINT64_MAX - 5};
  memcpy(bytes.data, &frame, sizeof frame);
  assert_int_equal(farm_frame_next(&bytes, &frame, &payload), -1);
  farm_frame_free(&bytes);
  uint8_t byte = 0;
  assert_false(farm_frame_append(&bytes, FARM_FRAME_TASK, 0, 1, 1, &(struct iovec){&byte, FARM_FRAME_LARGEST + 1}));
}

TEST(handles_are_never_used_twice) {
  OWNED_BY(farm_job_table_free) struct farm_job_table table = {0};
  uint64_t old = 0;
  struct farm_job *kept[200];
  for (int i = 0; i < 200; i++) {
    kept[i] = farm_job_new(0, (const uint8_t *)"x", 1);
    assert_true(farm_job_table_add(&table, kept[i]));
    assert_true(kept[i]->handle != 0);
  }
  for (int i = 0; i < 1000; i++) {
    OWNED struct farm_job *job = farm_job_new(0, NULL, 0);
    assert_true(farm_job_table_add(&table, job));
    assert_true(job->handle != old);
    assert_null(farm_job_table_find(&table, old));
    assert_ptr_equal(farm_job_table_find(&table, job->handle), job);
    old = job->handle;
    farm_job_table_remove(&table, old);
    assert_null(farm_job_table_find(&table, old));
  }
  for (int i = 0; i < 200; i++)
    assert_ptr_equal(farm_job_table_find(&table, kept[i]->handle), kept[i]);
  assert_int_equal(table.count, 200);
  assert_int_equal(HASH_COUNT(table.jobs), 200); /* none of the removed jobs is left */
}

TEST(queues_keep_order) {
  struct farm_job_queue queue = {0};
  for (uint64_t i = 1; i <= 5; i++)
    farm_job_push(&queue, farm_job_new(i, NULL, 0));
  farm_job_push_front(&queue, farm_job_new(9, NULL, 0));
  free(farm_job_take(&queue, 5)); /* the last job: `last` must move */
  farm_job_push(&queue, farm_job_new(6, NULL, 0));
  free(farm_job_take(&queue, 3));
  assert_null(farm_job_take(&queue, 3));
  const uint64_t expected[] = {9, 1, 2, 4, 6};
  assert_int_equal(queue.count, 5);
  for (int i = 0; i < 5; i++) {
    OWNED struct farm_job *job = farm_job_pop(&queue);
    assert_int_equal(job->handle, expected[i]);
  }
  assert_null(farm_job_pop(&queue));
}

/* A rank that waits sleeps twice as long each time, up to 5 ms, and within half a second up to 10 ms. */
TEST(sleeps_grow_to_their_end) {
  int64_t sleep = FARM_SLEEP_LEAST_NS, slept = 0;
  for (; sleep < FARM_SLEEP_USUAL_NS; sleep = farm_sleep_longer(sleep), slept += sleep)
    assert_int_equal(farm_sleep_longer(sleep), 2 * sleep);
  for (; sleep < FARM_SLEEP_MOST_NS; sleep = farm_sleep_longer(sleep), slept += sleep) {
    assert_true(farm_sleep_longer(sleep) > sleep);
    assert_true(slept < 500 * INT64_C(1000000));
  }
  assert_int_equal(sleep, FARM_SLEEP_MOST_NS);
  assert_int_equal(farm_sleep_longer(sleep), FARM_SLEEP_MOST_NS);
}

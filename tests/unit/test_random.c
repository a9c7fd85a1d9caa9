/* The generator's published known-answer vectors, our mapping of (seed, purpose, item, draw) onto it (pinned, because
 * it is part of the meaning of a seed) and the range of the uniforms. */
#include "engine/random.h"
#include "tests/support/check.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

/* Random123's kat_vectors, philox4x64 with 10 rounds: counter, key, answer. */
static const uint64_t known[3][10] =
    {{0, 0, 0, 0, 0, 0, 0x16554d9eca36314cU, 0xdb20fe9d672d0fdcU, 0xd7e772cee186176bU, 0x7e68b68aec7ba23bU},
     {UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX, 0x87b092c3013fe90bU, 0x438c3c67be8d0224U,
      0x9cc7d7c69cd777b6U, 0xa09caebf594f0ba0U},
     {0x243f6a8885a308d3U, 0x13198a2e03707344U, 0xa4093822299f31d0U, 0x082efa98ec4e6c89U, 0x452821e638d01377U,
      0xbe5466cf34e90c6cU, 0xa528f45403e61d95U, 0x38c72dbd566e9788U, 0xa5a1610e72fd18b5U, 0x57bd43b5e52b7fe6U}};

TEST(known_answers) {
  for (int t = 0; t < 3; t++) {
    philox4x64_ctr_t counter = {{known[t][0], known[t][1], known[t][2], known[t][3]}};
    philox4x64_key_t key = {{known[t][4], known[t][5]}};
    philox4x64_ctr_t out = philox4x64(counter, key);
    for (int i = 0; i < 4; i++)
      assert_true(out.v[i] == known[t][6 + i]);
  }
  uint64_t bits[4];
  random_bits(0, 0, 0, 0, bits);
  for (int i = 0; i < 4; i++)
    assert_true(bits[i] == known[0][6 + i]);
}

TEST(mapping_is_pinned) {
  uint64_t bits[4];
  random_bits(7, 2, 3, 4, bits);
  philox4x64_ctr_t counter = {{4, 3, 2, 0}};
  philox4x64_key_t key = {{7, 0}};
  philox4x64_ctr_t out = philox4x64(counter, key);
  for (int i = 0; i < 4; i++)
    assert_true(bits[i] == out.v[i]);
  assert_true(random_draw(7, 2, 3, 4) == random_uniform(bits[0]));
}

TEST(uniforms_are_half_open) {
  assert_true(random_uniform(0) == 0);
  assert_true(random_uniform(UINT64_MAX) < 1);
  assert_true(random_uniform(UINT64_MAX) == 1 - 0x1p-53);
  double sum = 0;
  for (uint64_t i = 0; i < 10000; i++)
    sum += random_draw(1, RANDOM_LATTICE, i, 0);
  /* standard deviation of the mean is 1/sqrt(12 n) = 0.0029: five of them */
  assert_true(sum / 10000 > 0.5 - 0.0145 && sum / 10000 < 0.5 + 0.0145);
}

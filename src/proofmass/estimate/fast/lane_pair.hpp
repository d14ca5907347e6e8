#pragma once

#include <cstring>

#include "proofmass/estimate/fast/uniform_lanes.hpp"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace proofmass::estimate::packed {

/// Two doubles in one register.
using Pair = double __attribute__((vector_size(16)));

[[nodiscard]] inline Pair pair_at(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

/// How results are written: cached, or bypassing the caches for data too large for them, which
/// avoids reading memory before it is overwritten.
enum class Write { cached, streamed };

/// `to` is a multiple of 16 bytes if streamed.
template <Write write>
[[gnu::always_inline]] inline void write_pair(const Pair& pair, double* to) {
#if defined(__SSE2__)
  if constexpr (write == Write::streamed) {
    _mm_stream_pd(to, pair);
    return;
  }
#endif
  std::memcpy(to, &pair, sizeof pair);
}

/// Call after the last streamed write, before the results are published.
inline void finish_streaming() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

/// Count numbers of two neighbouring lanes; each lane's are contiguous.
template <int Count, Write write>
[[gnu::always_inline]] inline void part(const LaneNumbers* numbers,
                                        int lane,
                                        double* first,
                                        double* second) {
  for (int i = 0; i + 2 <= Count; i += 2) {
    const Pair a = pair_at(&numbers[i][lane]), b = pair_at(&numbers[i + 1][lane]);
    write_pair<write>(__builtin_shufflevector(a, b, 0, 2), first + i);
    write_pair<write>(__builtin_shufflevector(a, b, 1, 3), second + i);
  }
  if constexpr (Count % 2 == 1) {
    first[Count - 1] = numbers[Count - 1][lane];
    second[Count - 1] = numbers[Count - 1][lane + 1];
  }
}

}  // namespace proofmass::estimate::packed

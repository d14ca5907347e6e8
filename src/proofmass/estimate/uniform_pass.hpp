#pragma once

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "proofmass/estimate/filter_leap.hpp"
#include "proofmass/estimate/log_product.hpp"
#include "proofmass/estimate/packed_filter.hpp"
#include "proofmass/estimate/steady_state.hpp"
#include "proofmass/estimate/uniform_lanes.hpp"
#include "proofmass/estimate/uniform_smoother.hpp"

// The three passes of run_uniform(), a chunk of the recording at a time.
namespace proofmass::estimate::packed {

/// Instants that one lane's numbers are moved at a time, of a lane, and of all lanes. A lane's is not
/// a power of two, or lanes would share sets of the cache.
inline constexpr std::size_t together = 8, blocks = 31, lane_length = blocks * together;
inline constexpr std::size_t chunk_length = lane_length * lanes;

enum class Pass { one_by_one, side_by_side, constant_gain };

/// A stretch of the recording, and the filter after the instant before it.
template <int N>
struct Chunk {
  std::size_t first = 0, count = 0;
  State<N> start{};
  Pass pass = Pass::one_by_one;
};

/// What the steady state gives to a pass of constant gain.
template <int N>
struct Steady {
  SteadyState<N, 1> limit;
  ConstantGain<N> gain;
  Mat<N, N> lane_decay;  ///< of the filter's error, over a lane
  double tolerance;      ///< rounding's share in gains that have settled
};

/// Sums over the readings of a run.
struct Score {
  double nis = 0.0;
  LogProduct R_S;  ///< Π R / S
  std::size_t readings = 0;
};

/// A run: what is given, what is known beforehand, where results go, and room to work in.
template <int N>
struct Work {
  StepModel<N> model{};
  std::span<const double> z;
  UniformOptions<N> options;
  UniformOutput<N> output;
  const PlainKernels<N>* plain = nullptr;
  const LaneKernels<N>* side_by_side = nullptr;
  FilterLeap<N> lane_leap{};
  std::optional<Steady<N>> steady;

  Score score;
  CovarianceRuns<N> covariances;

  std::vector<Row<N>> rows;            // of a chunk, one by one
  std::vector<LaneRow<N>> lane_rows;   // of a chunk, side by side
  std::vector<LaneMean<N>> lane_means;  // of a chunk, at constant gain
  std::vector<double> lane_z;           // of a chunk, the lanes' readings of an instant together
};

/// Where lane l's instant t stands.
[[nodiscard]] inline std::size_t instant(std::size_t first, int lane, std::size_t t) {
  return first + static_cast<std::size_t>(lane) * lane_length + t;
}

/// The lanes' readings of `together` instants from t on into lane_z. Says whether all are there.
template <int N>
[[nodiscard]] bool lay_out(Work<N>& work, const Chunk<N>& chunk, std::size_t t);

using Pair = double __attribute__((vector_size(16)));

/// Numbers of two neighbouring lanes, each lane's together.
template <int Count>
[[gnu::always_inline]] inline void part(const LaneNumbers* numbers,
                                        int lane,
                                        double* first,
                                        double* second) {
  for (int i = 0; i + 2 <= Count; i += 2) {
    Pair a, b;
    std::memcpy(&a, &numbers[i][lane], sizeof a);
    std::memcpy(&b, &numbers[i + 1][lane], sizeof b);
    const Pair low = __builtin_shufflevector(a, b, 0, 2), high = __builtin_shufflevector(a, b, 1, 3);
    std::memcpy(first + i, &low, sizeof low);
    std::memcpy(second + i, &high, sizeof high);
  }
  if constexpr (Count % 2 == 1) {
    first[Count - 1] = numbers[Count - 1][lane];
    second[Count - 1] = numbers[Count - 1][lane + 1];
  }
}

template <int N>
[[nodiscard]] double* numbers_of(Mat<N>& x) {
  return x.data();
}
template <int N>
[[nodiscard]] double* numbers_of(Symmetric<N>& P) {
  return P.lower.data();
}

/// The lanes' numbers of `together` instants from t on into `out`, one T an instant; `numbers(t)`
/// are the lanes'. Memory is asked for the next so many: these are more places at once than a
/// processor sees coming by itself.
template <int Count, class T, class Numbers>
void write_lanes(std::size_t first, std::size_t t, std::span<T> out, Numbers&& numbers) {
  for (int lane = 0; lane < lanes; lane += 2) {
    T* one = &out[instant(first, lane, t)];
    T* other = one + lane_length;
    for (std::size_t ahead = together * Count; ahead < 2 * together * Count; ahead += 8) {
      __builtin_prefetch(numbers_of(*one) + ahead, 1);
      __builtin_prefetch(numbers_of(*other) + ahead, 1);
    }
    for (std::size_t u = 0; u < together; ++u)
      part<Count>(numbers(t + u), lane, numbers_of(one[u]), numbers_of(other[u]));
  }
}

template <int N>
[[nodiscard]] Mat<N, N> dense(const double (&P)[Symmetric<N>::entries]) {
  Mat<N, N> out;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) out(i, j) = P[Symmetric<N>::index(i, j)];
  return out;
}

template <int N>
[[nodiscard]] Mat<N> column(const double (&x)[N]) {
  return Eigen::Map<const Mat<N>>(x);
}

template <int N>
[[nodiscard]] Mat<N> lane_of(const LaneNumbers* numbers, int lane) {
  Mat<N> out;
  for (int i = 0; i < N; ++i) out(i) = numbers[i][lane];
  return out;
}

template <int N>
void set_lane(const Mat<N>& from, int lane, LaneNumbers* to) {
  for (int i = 0; i < N; ++i) to[i][lane] = from(i);
}

/// Each pass's filter takes `state` from before the chunk to its end; where no smoother follows,
/// it writes the results. filter_side_by_side() and filter_constant_gain() say false, and leave all
/// as it was, where readings are missing or lanes do not end where the next begins. The smoothers take `later` from the chunk's end to before it,
/// running the filter again, and write the results.
template <int N>
void filter_one_by_one(Work<N>& work, const Chunk<N>& chunk, State<N>& state);
template <int N>
void smooth_one_by_one(Work<N>& work, const Chunk<N>& chunk, Later<N>& later);
template <int N>
[[nodiscard]] bool filter_side_by_side(Work<N>& work, const Chunk<N>& chunk, State<N>& state);
template <int N>
void smooth_side_by_side(Work<N>& work, const Chunk<N>& chunk, Later<N>& later);
template <int N>
[[nodiscard]] bool filter_constant_gain(Work<N>& work, const Chunk<N>& chunk, State<N>& state);
template <int N>
void smooth_constant_gain(Work<N>& work, const Chunk<N>& chunk, Later<N>& later);

}  // namespace proofmass::estimate::packed

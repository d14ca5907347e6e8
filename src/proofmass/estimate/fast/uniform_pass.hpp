#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "proofmass/estimate/fast/constant_gain_lanes.hpp"
#include "proofmass/estimate/fast/filter_composition.hpp"
#include "proofmass/estimate/fast/lane_pair.hpp"
#include "proofmass/estimate/fast/log_product.hpp"
#include "proofmass/estimate/fast/packed_filter.hpp"
#include "proofmass/estimate/fast/steady_state.hpp"
#include "proofmass/estimate/fast/uniform_lanes.hpp"
#include "proofmass/estimate/fast/uniform_smoother.hpp"

// The three passes of run_uniform(), a chunk of the recording at a time.
namespace proofmass::estimate::packed {

/// Epochs of one lane moved at a time, epochs in a lane, and in all lanes. A lane's length is not a
/// power of two, to avoid cache-set conflicts between lanes.
inline constexpr std::size_t together = 8, blocks = 31, lane_length = blocks * together;
inline constexpr std::size_t chunk_length = lane_length * lanes;
/// Consecutive epochs of a lane written together.
inline constexpr std::size_t run_length = 62;
static_assert(lane_length % run_length == 0);
/// Length of the first chunk, in which a filter forgets a wide start.
inline constexpr std::size_t head_length = 1024;

enum class Pass { one_by_one, side_by_side, constant_gain };

/// A stretch of the recording, and the filter's state at the epoch before it.
template <int N>
struct Chunk {
  std::size_t first = 0, count = 0;
  State<N> start{};
  Pass pass = Pass::one_by_one;
};

/// Steady-state data of a constant-gain pass.
template <int N>
struct Steady {
  SteadyState<N, 1> limit;
  ConstantGain<N> gain;
  Mat<N, N> lane_decay;  ///< of the filter's error, over a lane
  double tolerance;      ///< rounding's share in gains that have settled
};

/// Sums over the measurements of a run.
struct Score {
  double nis = 0.0;
  LogProduct R_S;  ///< Π R / S
  std::size_t readings = 0;
};

/// A run: its input, precomputed data, output and workspace.
template <int N>
struct Work {
  StepModel<N> model{};
  std::span<const double> z;
  UniformOptions<N> options;
  UniformOutput<N> output;
  const PlainKernels<N>* plain = nullptr;
  const LaneKernels<N>* side_by_side = nullptr;
  const ConstantGainKernels<N>* constant_gain = nullptr;
  ComposedFilter<N> lane_leap{};
  std::optional<Steady<N>> steady;

  Score score;
  RunLengthCovariances<N> covariances;

  std::vector<Row<N>> rows;             // of a chunk, one by one
  std::vector<LaneRow<N>> lane_rows;    // of a chunk, side by side
  std::vector<LaneMean<N>> lane_means;  // of a chunk, at constant gain
  std::vector<double> lane_z;           // of a chunk, the lanes' measurements of an epoch together
};

/// Where lane l's epoch t stands.
[[nodiscard]] inline std::size_t epoch(std::size_t first, int lane, std::size_t t) {
  return first + static_cast<std::size_t>(lane) * lane_length + t;
}

/// What is known of the model's limit, if it has one.
template <int N>
[[nodiscard]] std::optional<Steady<N>> settle(const LinearModel<N, 1>& model);

/// Whether what the measurements see of P, and so every gain from here on, has come to its limit.
/// Each entry is judged by itself and relatively; steps from one epoch to the next would say
/// nothing, since a slow mode's are always small.
template <int N>
[[nodiscard]] bool gains_settled(const Steady<N>& steady, const Mat<N, N>& P);

/// Whether all of P has.
template <int N>
[[nodiscard]] bool settled(const Symmetric<N>& limit, const Mat<N, N>& P, double tolerance);

/// The lanes' measurements of `together` epochs from t on into lane_z. Says whether all are there.
template <int N>
[[nodiscard]] bool lay_out(Work<N>& work, const Chunk<N>& chunk, std::size_t t);

template <int N>
[[nodiscard]] double* numbers_of(Mat<N>& x) {
  return x.data();
}
template <int N>
[[nodiscard]] double* numbers_of(Symmetric<N>& P) {
  return P.lower.data();
}

template <int Count, Write write, class T, class Numbers>
void write_pairs(std::size_t first, std::span<T> out, const Numbers& numbers) {
  for (std::size_t t = 0; t < lane_length; t += run_length)
    for (int lane = 0; lane < lanes; lane += 2) {
      T* one = &out[epoch(first, lane, t)];
      T* other = one + lane_length;
      for (std::size_t u = 0; u < run_length; ++u)
        part<Count, write>(numbers(t + u), lane, numbers_of(one[u]), numbers_of(other[u]));
    }
}

/// The lanes' numbers of a chunk into `out`, one T of Count numbers an epoch; `numbers(t)` are the
/// lanes'.
template <int Count, class T, class Numbers>
void write_lanes(std::size_t first, std::span<T> out, const Numbers& numbers) {
  constexpr std::size_t too_much_bytes = std::size_t{8} << 20U;
  const bool aligned = Count % 2 == 0 && reinterpret_cast<std::uintptr_t>(out.data()) % 16 == 0;
  if (aligned && out.size_bytes() > too_much_bytes)
    write_pairs<Count, Write::streamed>(first, out, numbers);
  else
    write_pairs<Count, Write::cached>(first, out, numbers);
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

/// Each pass's filter takes `state` from before the chunk to its end; where no smoother follows, it
/// writes the results. filter_side_by_side() and filter_constant_gain() say false, and leave all as
/// it was, where measurements are missing or lanes do not end where the next begins. The smoothers
/// take `later` from the chunk's end to before it, running the filter again, and write the results.
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

#pragma once

#include <cstddef>

#include "proofmass/estimate/fast/packed_model.hpp"

// fast/packed_kalman.hpp's equations on many stretches of one recording side by side: lane l runs
// through the epochs of its own stretch, all lanes at once in the processor's vector units.
namespace proofmass::estimate::packed {

inline constexpr int lanes = 16;
using LaneNumbers = double[lanes];

/// A filter's state in each lane, after an epoch.
template <int N>
struct alignas(64) LaneState {
  LaneNumbers P[Symmetric<N>::entries];
  LaneNumbers x[N];
};

/// Row of each lane.
template <int N>
struct alignas(64) LaneRow {
  LaneNumbers P[Symmetric<N>::entries];
  LaneNumbers x[N];
  LaneNumbers K[N];
  LaneNumbers y_S, per_S;
};

/// Later of each lane.
template <int N>
struct alignas(64) LaneLater {
  LaneNumbers L[Symmetric<N>::entries];
  LaneNumbers l[N];
};

/// Sums over the measurements of each lane: y² / S and the product of R / S.
struct alignas(64) LaneScore {
  LaneNumbers nis, R_S;
};

/// The loops, `count` epochs each; z holds the lanes' measurements of an epoch contiguously. Rows
/// and means are those of each epoch, in rising order.
template <int N>
struct LaneKernels {
  using Model = StepModel<N>;
  /// Filters from `state`; without rows only its end is stored.
  void (*filter)(const Model&, const double* z, int count, LaneState<N>& state, LaneRow<N>* rows);
  /// The means with the rows' gains, from other means before the first epoch.
  void (*filter_means)(const Model&, const double* z, int count, LaneNumbers* x, LaneRow<N>* rows);
  /// λ alone, from after the last epoch to before the first.
  void (*look_back)(const Model&, const LaneRow<N>* rows, int count, LaneNumbers* l);
  /// λ and Λ; x and P of the rows become those given all measurements.
  void (*smooth)(const Model&, LaneRow<N>* rows, int count, LaneLater<N>& later);
  /// λ and the means alone.
  void (*smooth_means)(const Model&, LaneRow<N>* rows, int count, LaneNumbers* l);
  /// Product of R / S and sum of y² / S; count ≤ 8, so that the product stays finite.
  void (*score)(const Model&, const LaneRow<N>* rows, int count, LaneScore& score);
};

/// The loops compiled for the narrowest pattern that fits the model. For N = 1 to 4.
template <int N>
[[nodiscard]] const LaneKernels<N>& lane_kernels(const StepModel<N>& model);

}  // namespace proofmass::estimate::packed

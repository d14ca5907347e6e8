#pragma once

#include "proofmass/estimate/fast/uniform_lanes.hpp"

// fast/uniform_lanes.hpp's loops at the steady-state gain: means alone.
namespace proofmass::estimate::packed {

/// A mean and y / S of each lane, with a known, constant gain.
template <int N>
struct alignas(64) LaneMean {
  LaneNumbers x[N];
  LaneNumbers y_S;
};

/// Data of a constant-gain filter and smoother in addition to the model.
template <int N>
struct ConstantGain {
  double K[N];
  double seen[N][N];  ///< P⁺ Π of fast/steady_state.hpp
  double per_S;
};

/// The loops, as LaneKernels.
template <int N>
struct ConstantGainKernels {
  using Model = StepModel<N>;
  /// `x` is the mean of each lane, updated. If means are stored, (y / S)² is added to `squares`.
  void (*filter)(const Model&,
                 const ConstantGain<N>&,
                 const double* z,
                 int count,
                 LaneNumbers* x,
                 LaneMean<N>* means,
                 LaneNumbers& squares);
  /// λ alone.
  void (*look_back)(
      const Model&, const ConstantGain<N>&, const LaneMean<N>* means, int count, LaneNumbers* l);
  /// λ; the means become those given all measurements.
  void (*smooth)(
      const Model&, const ConstantGain<N>&, LaneMean<N>* means, int count, LaneNumbers* l);
};

/// The loops compiled for the narrowest pattern that fits the model. For N = 1 to 4.
template <int N>
[[nodiscard]] const ConstantGainKernels<N>& constant_gain_kernels(const StepModel<N>& model);

}  // namespace proofmass::estimate::packed

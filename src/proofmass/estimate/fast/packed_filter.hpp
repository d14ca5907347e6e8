#pragma once

#include <cstddef>

#include "proofmass/estimate/fast/packed_model.hpp"

// fast/packed_kalman.hpp's equations, one epoch after another.
namespace proofmass::estimate::packed {

/// x̂ and P after an epoch.
template <int N>
struct State {
  double P[Symmetric<N>::entries];
  double x[N];
};

template <int N>
struct PlainKernels {
  /// Filters from `state` over z[0] … z[count − 1], NaN without a measurement; rows, if given,
  /// receive each epoch. `moves`: a step leads to the first epoch.
  void (*filter)(const StepModel<N>&,
                 const double* z,
                 std::size_t count,
                 bool moves,
                 State<N>& state,
                 Row<N>* rows);
  /// Takes `later` from after the last row to before the first; x and P of the rows become those
  /// given all measurements.
  void (*smooth)(const StepModel<N>&, Row<N>* rows, std::size_t count, Later<N>& later);
  /// λ and the means alone.
  void (*smooth_means)(const StepModel<N>&, Row<N>* rows, std::size_t count, Later<N>& later);
};

/// The loops compiled for the narrowest pattern that fits the model. For N = 1 to 4.
template <int N>
[[nodiscard]] const PlainKernels<N>& plain_kernels(const StepModel<N>& model);

}  // namespace proofmass::estimate::packed

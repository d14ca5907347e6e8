#pragma once

#include <array>

#include "proofmass/estimate/models/bias_models.hpp"
#include "proofmass/estimate/motion_models.hpp"

// A model measured by several accelerometers at once.
namespace proofmass::estimate {

/// Indices of each quantity in the state of fusion_model(): axis i of (x1, y1, x2, y2) has its
/// position, velocity and acceleration at 3 i, 3 i + 1, 3 i + 2.
namespace fusion {
inline constexpr int axes = 4;
inline constexpr int bias_x_mps2 = 12;
inline constexpr int bias_y_mps2 = 13;
}  // namespace fusion

struct FusionModelOptions {
  std::array<PvaOptions, fusion::axes> axes = {};  ///< x1, y1, x2, y2; one dt_s for all
  BiasOptions bias_x = {}, bias_y = {};            ///< shared by x1 and x2, by y1 and y2
};

/// Two two-axis sensors in one filter of 14 states: position, velocity and acceleration of each
/// axis, one bias of the x axes and one of the y axes. The levels to which the biases settle are
/// the known input u.
///
///     z = (x1, y1, x2, y2),   z_i = a_i + ε_x or ε_y:   H has a row for each axis.
///
/// Source: M. A. Lele (2010), appendix A.1, whose H adds the four axes into one row. Expects the
/// same dt_s in every part.
[[nodiscard]] LinearModel<14, 4, 2> fusion_model(const FusionModelOptions& options);

extern template LinearRun<14, 4> filter_linear(LinearSeries<14, 4, 2>,
                                               const Start<14>&,
                                               const LinearOptions&);
extern template LinearRun<14, 4> smooth_linear(LinearSeries<14, 4, 2>,
                                               const Start<14>&,
                                               const LinearOptions&);

}  // namespace proofmass::estimate

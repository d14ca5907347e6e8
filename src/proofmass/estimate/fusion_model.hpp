#pragma once

#include <array>

#include "proofmass/estimate/bias_models.hpp"
#include "proofmass/estimate/motion_models.hpp"

// Models that several accelerometers read at once.
namespace proofmass::estimate {

/// Where each quantity sits in the state of fusion_model(): axis i of (x1, y1, x2, y2) has its
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
/// axis, and a bias of the x axes and one of the y axes, whose levels are the known input u,
///
///     z = (x1, y1, x2, y2),   z_i = a_i + ε_x or ε_y:   H has a row for each axis.
///
/// Source: M. A. Lele (2010), appendix A.1, whose H adds the four axes into one row. Expects the
/// same dt_s in every part.
[[nodiscard]] LinearModel<14, 4, 2> fusion_model(const FusionModelOptions& options);

/// One axis that n sensors read: [p v a b₁ … bₙ], z_i = a + b_i, then a reading of the velocity and
/// one of the position. The biases' levels are the known input.
template <int Sensors>
[[nodiscard]] LinearModel<3 + Sensors, Sensors + 2, Sensors> common_axis_model(
    const PvaOptions& motion,
    const std::array<BiasStep, static_cast<std::size_t>(Sensors)>& biases,
    const Mat<Sensors + 2>& variances) {
  LinearModel<3 + Sensors, Sensors + 2, Sensors> model;
  const LinearModel<3, 1> pva = pva_model(motion);
  model.F.setIdentity();
  model.Q.setZero();
  model.H.setZero();
  model.F.template topLeftCorner<3, 3>() = pva.F;
  model.Q.template topLeftCorner<3, 3>() = pva.Q;
  for (int i = 0; i < Sensors; ++i) {
    const BiasStep& bias = biases[static_cast<std::size_t>(i)];
    model.F(3 + i, 3 + i) = bias.phi;
    model.Q(3 + i, 3 + i) = bias.variance_m2ps4;
    model.B(3 + i, i) = bias.settled;
    model.H(i, pva::accel_mps2) = model.H(i, 3 + i) = 1.0;
  }
  model.H(Sensors, pva::velocity_mps) = 1.0;
  model.H(Sensors + 1, pva::position_m) = 1.0;
  model.R = variances;
  return model;
}

extern template LinearRun<14, 4> filter_linear(LinearSeries<14, 4, 2>,
                                               const Start<14>&,
                                               const LinearOptions&);
extern template LinearRun<14, 4> smooth_linear(LinearSeries<14, 4, 2>,
                                               const Start<14>&,
                                               const LinearOptions&);

}  // namespace proofmass::estimate

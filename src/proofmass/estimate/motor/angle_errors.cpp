#include "proofmass/estimate/motor/angle_errors.hpp"

#include <array>
#include <cmath>

namespace proofmass::estimate::motor {

AngleErrors::AngleErrors(const Series& series, const Motion& motion)
    : series_(series),
      motion_(motion),
      accel_radps2_(slopes(motion.speed_radps, series.step_s, 4)) {}

void AngleErrors::set_priors(Eigen::Ref<Eigen::VectorXd> std) const {
  // An accelerometer's filter of 20 Hz delays by 8 ms; an encoder's card by a sample.
  std(0) = series_.from_gravity ? 0.004 : 0.001;
  constexpr std::array<double, orders> of_order{0.05, 0.02, 0.003, 0.003};
  for (Eigen::Index n = 0; n < orders; ++n)
    std.segment<2>(1 + 2 * n).setConstant(of_order[static_cast<std::size_t>(n)]);
  if (series_.from_gravity) std(1 + 2 * orders) = 0.15;  // m
}

void AngleErrors::write(std::size_t k, Eigen::Ref<Eigen::VectorXd> row) const {
  const double angle = motion_.angle_rad[k], w = motion_.speed_radps[k];
  row(0) = -w;
  for (Eigen::Index n = 0; n < orders; ++n) {
    const double turned = static_cast<double>(n + 1) * angle;
    row.segment<2>(1 + 2 * n) << std::cos(turned), std::sin(turned);
  }
  if (series_.from_gravity)
    row(1 + 2 * orders) =
        -(w * w * std::cos(angle) + accel_radps2_[k] * std::sin(angle)) / series_.gravity_mps2;
}

}  // namespace proofmass::estimate::motor

#include "proofmass/sensor/calibration_check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/linalg.hpp"

namespace proofmass::sensor {
namespace {

Status check(const Uncertain& figure) {
  if (!std::isfinite(figure.value) || !std::isfinite(figure.std))
    return Error{Errc::not_finite, "must be a finite number with a finite standard deviation"};
  if (figure.std < 0.0)
    return Error{Errc::invalid_argument, "its standard deviation must not be negative"};
  return Done{};
}

Status check_figures(const MeasuredCalibration& measured) {
  const auto figures = nine_measured(measured);
  if (std::ranges::none_of(figures, [](const auto& f) { return f.has_value(); }))
    return Error{Errc::invalid_argument, "nothing of the calibration was measured"};
  for (std::size_t k = 0; k < 9; ++k) {
    if (!figures[k]) continue;
    if (const Status fits = check(*figures[k]); !fits)
      return fits.error().at(fmt::format("calibration.{}", nine_names[k]));
  }
  if (measured.gravity_mps2)
    if (const Status fits = check(*measured.gravity_mps2); !fits)
      return fits.error().at("calibration.gravity");
  if (!measured.std_known && measured.covariance)
    return Error{Errc::invalid_argument,
                 "calibration.covariance: given, but the standard deviations are not known"};
  if (measured.dof && !(std::isfinite(*measured.dof) && *measured.dof > 0.0))
    return Error{Errc::invalid_argument, "calibration.dof: must be positive and finite"};
  if (measured.temperature_k && !std::isfinite(*measured.temperature_k))
    return Error{Errc::not_finite, "calibration.temperature: must be a finite number"};
  return Done{};
}

/// Checks that it is symmetric, has no negative variance in any direction, and agrees with the
/// stds.
Status check_covariance(const MeasuredCalibration& measured) {
  const auto& C = *measured.covariance;
  const auto figures = nine_measured(measured);
  Eigen::MatrixXd correlation(9, 9);
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j) {
      if (!std::isfinite(C[i][j]))
        return Error{Errc::not_finite, "calibration.covariance: must be of finite numbers"};
      const double size = std::sqrt(std::abs(C[i][i]) * std::abs(C[j][j]));
      if (std::abs(C[i][j] - C[j][i]) > 1e-9 * size)
        return Error{Errc::invalid_argument, "calibration.covariance: must be symmetric"};
      correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          size > 0.0 ? C[i][j] / size : C[i][j];
    }
  if (symmetric_eigen(correlation).values(0) < -1e-6)
    return Error{Errc::invalid_argument,
                 "calibration.covariance: has a negative variance in some direction"};
  for (std::size_t k = 0; k < 9; ++k) {
    const double std = std::sqrt(std::max(C[k][k], 0.0));
    if (figures[k] && std::abs(std - figures[k]->std) > 1e-3 * std::max(std, figures[k]->std))
      return Error{Errc::invalid_argument,
                   fmt::format("calibration.covariance: gives {} a standard deviation of {:.4g}, "
                               "which is stated as {:.4g} with its value",
                               nine_names[k], std, figures[k]->std)};
  }
  return Done{};
}

}  // namespace

std::array<std::optional<Uncertain>, 9> nine_measured(const MeasuredCalibration& m) {
  return {m.bias[0],  m.bias[1],         m.bias[2],         m.scale[0],       m.scale[1],
          m.scale[2], m.misalignment[0], m.misalignment[1], m.misalignment[2]};
}

Status check_measured(const MeasuredCalibration& measured) {
  if (const Status fits = check_figures(measured); !fits) return fits;
  return measured.covariance ? check_covariance(measured) : Status(Done{});
}

}  // namespace proofmass::sensor

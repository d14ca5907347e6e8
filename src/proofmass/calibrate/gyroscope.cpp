#include "proofmass/calibrate/gyroscope.hpp"

#include <Eigen/LU>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/gyroscope/results.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Vector3d;

constexpr std::size_t least_motions = 3;  // two residuals each, for nine elements of the matrix
constexpr double unchanged = 1e-9;        // relative change of the matrix between passes
constexpr int most_passes = 3;            // G moves the matrix by less than its own uncertainty

// Contribution of the vertical component of Earth's rotation to each mean at rest, in readings.
std::vector<Vector3d> earth_at_rest(const GyroscopeData& data,
                                    const Eigen::Matrix3d& A,
                                    const std::optional<double>& latitude_rad) {
  const double vertical = latitude_rad ? earth_rate_radps * std::sin(*latitude_rad) : 0.0;
  const Eigen::Matrix3d per_reading = A.inverse();
  std::vector<Vector3d> out;
  out.reserve(data.rests.size());
  for (const GyroscopeRest& rest : data.rests) out.emplace_back(vertical * (per_reading * rest.up));
  return out;
}

// The horizontal component has an unknown direction.
Vector3d earth_variance(const Eigen::Matrix3d& A) {
  const Eigen::Matrix3d per_reading = A.inverse();
  return (earth_rate_radps * earth_rate_radps / 3.0) * per_reading.rowwise().squaredNorm();
}

Error too_few_motions(const GyroscopeData& data) {
  const auto unused = std::ranges::find_if(
      data.residuals, [](const MotionResidual& motion) { return !motion.why_unused.empty(); });
  return {Errc::too_few_samples,
          fmt::format("gyroscope: {} of {} motions between rests can be used{}; at least {} are "
                      "needed, and 18 about all axes are sensible",
                      data.motions.size(), data.residuals.size(),
                      unused == data.residuals.end() ? "" : " (" + unused->why_unused + ")",
                      least_motions)};
}

}  // namespace

const std::array<std::string, gyroscope_parameters>& gyroscope_parameter_names() {
  static const std::array<std::string, gyroscope_parameters> names = [] {
    std::array<std::string, gyroscope_parameters> out{
        "bias x",          "bias y",      "bias z",          "scale x",
        "scale y",         "scale z",     "misalignment yz", "misalignment zy",
        "misalignment zx", "alignment x", "alignment y",     "alignment z"};
    for (std::size_t k = 0; k < 9; ++k)
      out[12 + k] = fmt::format("g-sensitivity {}{}", "xyz"[k / 3], "xyz"[k % 3]);
    return out;
  }();
  return names;
}

std::optional<Uncertain> GyroscopeCalibration::parameter(std::size_t k) const {
  if (!why_absent[k].empty()) return std::nullopt;
  const auto at = static_cast<Eigen::Index>(k);
  return Uncertain{estimate(at), std::sqrt(covariance(at, at))};
}

Result<GyroscopeCalibration> calibrate_gyroscope(View<GyroscopeSession> sessions,
                                                 const MultiPosition& accelerometer,
                                                 const GyroscopeOptions& options) {
  const Result<GyroscopeData> data = gyroscope_data(sessions, accelerometer, options.table);
  if (!data) return data.error();
  if (data->motions.size() < least_motions && data->rates.empty()) return too_few_motions(*data);
  const Result<Eigen::Matrix3d> start = starting_matrix(*data, options.in_radps);
  if (!start) return start.error();
  GyroscopeFit fit{.rests = {}, .matrix = {}, .latitude_known = options.latitude_rad.has_value()};
  fit.matrix.A = *start;
  for (int pass = 0; pass < most_passes; ++pass) {
    fit.rests = regress_rests(*data, earth_at_rest(*data, fit.matrix.A, options.latitude_rad),
                              earth_variance(fit.matrix.A));
    const Eigen::Matrix3d before = fit.matrix.A;
    const int iterations = fit.matrix.iterations;
    fit.matrix = fit_matrix(*data, fit.rests, before);
    fit.matrix.iterations += iterations;
    if ((fit.matrix.A - before).norm() < unchanged * before.norm()) break;
  }
  return gyroscope_results(*data, fit, accelerometer);
}

}  // namespace proofmass::calibrate

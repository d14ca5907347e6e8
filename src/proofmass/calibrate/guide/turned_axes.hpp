#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace proofmass::calibrate {

/// Dependence of a sensor's output on the angle of the table that rotates it about a horizontal
/// axis: mean = c + a sin θ + b cos θ, axis by axis, by least squares over the positions so far.
class TurnedAxes {
 public:
  /// one_g: output of the axes at 1 g, if known.
  TurnedAxes(std::size_t axes, std::optional<double> one_g) : axes_(axes), given_one_g_(one_g) {}

  void add(double angle_rad, const Eigen::Vector3d& mean);
  /// Angle of the table for this output; nullopt if the positions do not determine it yet, or with
  /// one axis alone.
  [[nodiscard]] std::optional<double> angle_rad(const Eigen::Vector3d& mean) const;
  [[nodiscard]] std::optional<double> one_g() const;

 private:
  void fit();

  std::size_t axes_;
  std::optional<double> given_one_g_;
  std::vector<double> angles_rad_;
  std::vector<Eigen::Vector3d> means_;
  /// Columns c, a, b; absent while unknown.
  std::optional<Eigen::Matrix3d> follows_;
};

}  // namespace proofmass::calibrate

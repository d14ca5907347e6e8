#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace proofmass::calibrate {

/// How the readings of a sensor follow the angle of the table that turns it about a horizontal
/// axis: mean = c + a sin θ + b cos θ, axis by axis, by least squares over the positions so far.
class TurnedAxes {
 public:
  /// one_g: what the axes read at 1 g, where that is known.
  TurnedAxes(std::size_t axes, std::optional<double> one_g) : axes_(axes), given_one_g_(one_g) {}

  void add(double angle_rad, const Eigen::Vector3d& mean);
  /// The angle at which the table gives this reading; nullopt where the positions do not tell yet,
  /// or of one axis alone.
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

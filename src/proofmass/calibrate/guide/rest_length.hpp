#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position/dwell_noise.hpp"
#include "proofmass/signal/running_rests.hpp"

// Required length of a rest.
namespace proofmass::calibrate {

struct RestVerdict {
  bool enough = false;
  double seconds_left = 0.0;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();  ///< of the mean
  double dof = 0.0;                                    ///< of these; 0: unknown
};

/// Evaluates rests by the noise common to all of them (fit_dwell_noise).
class RestLength {
 public:
  RestLength(std::size_t axes, double shortest_s, double longest_s)
      : axes_(axes), shortest_s_(shortest_s), longest_s_(longest_s) {}

  /// A rest is long enough if the mean's standard deviation is target_std on every axis, or would
  /// not fall by a twentieth in twice the time, as far as the rests determine that with ten degrees
  /// of freedom; without a target, the shortest rest.
  [[nodiscard]] RestVerdict judge(const signal::RunningRests& rests,
                                  std::optional<double> target_std) const;
  /// Adds the current rest to those used for the noise.
  void keep(const signal::RunningRests& rests);

 private:
  std::size_t axes_;
  double shortest_s_, longest_s_;
  std::array<std::vector<signal::AllanLevel>, 3> pooled_;
};

}  // namespace proofmass::calibrate

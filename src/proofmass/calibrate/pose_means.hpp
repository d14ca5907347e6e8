#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose.hpp"
#include "proofmass/calibrate/slow_noise.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/dyadic_allan.hpp"

namespace proofmass::calibrate {

/// A static interval of a recording, both samples inside.
struct Dwell {
  std::size_t first, last;
  std::string label = {};
  std::optional<Eigen::Vector3d> up = {};  ///< as Pose::up
};

/// Noise statistics from the rests of one recording.
struct RestSession {
  std::size_t rests = 0;
  std::array<std::vector<signal::AllanLevel>, 3> levels;  ///< of x, y, z
  std::array<double, 3> rounding{};                       ///< DwellNoise::rounding
  std::vector<Span> spans;                                ///< of the rests, in samples
};

struct PoseMeans {
  std::vector<Pose> poses;  ///< without times
  /// Degrees of freedom of the common factor of all covariances; 0: the noise is unknown.
  double noise_dof = 0.0;
  RestSession session;
  std::array<double, 3> sample_std{};  ///< of one sample at rest, per axis
  std::size_t rejected = 0;            ///< samples ignored: not a number, or a spike
};

/// The mean of each rest and its uncertainty from the noise common to all rests (see
/// fit_dwell_noise), axis by axis. Non-numbers and spikes, further than 8 robust standard
/// deviations from the rest's median, are ignored. `lsb`: the quantisation step in the axes' unit,
/// 0 if none. Errors: invalid_argument (axes of different length), too_few_samples (a rest with
/// fewer than two numbers; the message names it). Cost: O(N).
[[nodiscard]] Result<PoseMeans> pose_means(const std::array<View<double>, 3>& axes,
                                           View<Dwell> rests,
                                           const std::array<double, 3>& lsb = {});

}  // namespace proofmass::calibrate

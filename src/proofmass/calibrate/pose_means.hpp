#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/calibrate/bias_wander.hpp"
#include "proofmass/calibrate/pose.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/dyadic_ladder.hpp"

namespace proofmass::calibrate {

/// Where a recording lies still, both samples inside.
struct Dwell {
  std::size_t first, last;
  std::string label = {};
  std::optional<Eigen::Vector3d> up = {};  ///< as Pose::up
};

/// What the rests of one recording say of the noise.
struct RestSession {
  std::size_t rests = 0;
  std::array<std::vector<signal::AllanLevel>, 3> levels;  ///< of x, y, z
  std::array<double, 3> rounding{};                       ///< DwellNoise::rounding
  std::vector<Span> spans;                                ///< of the rests, in samples
};

struct PoseMeans {
  std::vector<Pose> poses;  ///< without times
  /// Of all covariances' common factor; 0: the noise is not known.
  double noise_dof = 0.0;
  RestSession session;
  std::array<double, 3> sample_std{};  ///< of one sample at rest, per axis
  std::size_t rejected = 0;            ///< samples passed over: no number, or a spike
};

/// The mean of each rest and its uncertainty by the noise that all rests have in common (see
/// fit_dwell_noise), axis by axis. Values that are no number and spikes, further than 8 robust
/// standard deviations from the rest's median, are passed over. `lsb`: the converter's steps in the
/// axes' unit, 0 if there are none.
/// Errors: invalid_argument (axes of different length), too_few_samples (a rest without two
/// numbers; the message names it). Cost: O(N).
[[nodiscard]] Result<PoseMeans> pose_means(const std::array<View<double>, 3>& axes,
                                           View<Dwell> rests,
                                           const std::array<double, 3>& lsb = {});

}  // namespace proofmass::calibrate

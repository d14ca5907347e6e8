#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/estimate/attitude.hpp"

// The recording prepared for the attitude filter: stretches without gaps, rests, noise.
namespace proofmass::estimate {

/// One sample of a stretch, measured or interpolated.
struct InertialSample {
  std::size_t row = 0;  ///< in the recording
  double dt_s = 0.0;    ///< since the previous sample; 0 at the start of a stretch
  bool starts = false;  ///< a stretch starts here
  int rest = -1;        ///< index of its rest
  bool enters_rest = false;
  Mat<3> rate = Mat<3>::Zero(), force = Mat<3>::Zero();
  /// Densities of the interpolation error over the step that ends here.
  double rate_doubt = 0.0, force_doubt = 0.0;
};

struct PreparedSeries {
  std::vector<InertialSample> samples;
  std::vector<AttitudeStretch> stretches;  ///< in rows
  std::size_t interpolated = 0;
  double rate_noise = 0.0, accel_noise = 0.0;  ///< densities, as used
  bool noise_from_rests = false;
};

/// Errors: those of estimate_attitude().
[[nodiscard]] Result<PreparedSeries> prepare(const InertialSeries& series,
                                             const std::vector<signal::Rest>& rests,
                                             const AttitudeOptions& options);

}  // namespace proofmass::estimate

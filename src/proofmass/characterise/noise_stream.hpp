#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/characterise/noise_accumulator.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/characterise/record_overview.hpp"
#include "proofmass/characterise/stationarity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// What is only known of a stream once it has ended.
struct StreamEnd {
  double rate_hz = 0.0;            ///< over the whole duration; 0: as in the options
  std::optional<double> lsb = {};  ///< step of the converter, in the series' unit, where known
};

/// analyse_noise of a series that does not fit into memory, in one pass: the same figures, notes
/// and refusals, but that knocks and steps are not looked for and lines not tested for being
/// steady, which a note says, and that noise which is not stationary is not analysed by parts.
/// Where the length
/// is not known beforehand, segments and overlap are those of a long record. Memory: ten bytes for
/// every 128 samples, and some megabytes.
class NoiseStream {
 public:
  /// expected_samples: 0 if not known.
  /// Errors: invalid_argument (as of analyse_noise; and what a whole record is needed for: the
  /// statistics that are no overlapping differences, every τ, noise types by lag 1, leaving out
  /// events, phase data), one line that says what to do instead.
  [[nodiscard]] static Result<NoiseStream> start(const NoiseOptions& options,
                                                 std::size_t expected_samples = 0);

  /// The samples behind those added before, on an even grid; NaN is missing.
  void add(View<double> samples);

  /// Errors: as of analyse_noise.
  [[nodiscard]] Result<NoiseAnalysis> finish(const StreamEnd& end = {});

 private:
  NoiseStream(const NoiseOptions& options, std::size_t expected_samples);

  NoiseOptions options_;
  NoiseAccumulator accumulator_;
  RecordOverview overview_;
  StationarityTest stationarity_;
};

}  // namespace proofmass::characterise

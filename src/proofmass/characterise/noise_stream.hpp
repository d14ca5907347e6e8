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

/// Properties of a stream that are known only at its end.
struct StreamEnd {
  double rate_hz = 0.0;            ///< over the whole duration; 0: as in the options
  std::optional<double> lsb = {};  ///< quantisation step, in the series' unit, if known
};

/// analyse_noise() in one pass, for a series that does not fit into memory. Same results, notes and
/// errors, with these differences:
///
/// - shocks and steps are not detected and lines not tested for stationarity; a note reports it;
/// - nonstationary noise is not analysed by parts;
/// - if the length is unknown beforehand, segments and overlap are those of a long record.
///
/// Memory: ten bytes for every 128 samples, and some megabytes.
class NoiseStream {
 public:
  /// expected_samples: 0 if unknown. Errors: invalid_argument (as in analyse_noise; and options
  /// that need the whole record: statistics other than overlapping differences, every τ, noise
  /// types by lag 1, event exclusion, phase data), one line that states the alternative.
  [[nodiscard]] static Result<NoiseStream> start(const NoiseOptions& options,
                                                 std::size_t expected_samples = 0);

  /// A part of a longer series: samples before and after it are in other streams, which append()
  /// joins in the order of time, in any grouping. The first part is at place.first = 0; what all
  /// parts together say is what start() says of the whole series, if that is longer than
  /// decimate_above. Errors: as above.
  [[nodiscard]] static Result<NoiseStream> start_part(const NoiseOptions& options,
                                                      const PartPlace& place);

  /// Adds the part that follows: its place begins where this one ends.
  void append(NoiseStream part);

  /// The sums of a part; an hour at 1 kHz has less than a megabyte, of which the first part of a
  /// series has two. Fails where the state read is not that of a part at this place.
  void exchange(StateBytes& bytes);

  /// Samples so far, with missing ones.
  [[nodiscard]] std::size_t samples() const { return overview_.samples(); }

  /// Adds the next samples, on an even grid; NaN is missing.
  void add(View<double> samples);

  /// Errors: as in analyse_noise.
  [[nodiscard]] Result<NoiseAnalysis> finish(const StreamEnd& end = {});

 private:
  NoiseStream(const NoiseOptions& options, std::size_t expected_samples);
  NoiseStream(const NoiseOptions& options, const PartPlace& place);

  NoiseOptions options_;
  NoiseAccumulator accumulator_;
  RecordOverview overview_;
  StationarityTest stationarity_;
};

}  // namespace proofmass::characterise

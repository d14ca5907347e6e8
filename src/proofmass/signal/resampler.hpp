#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/resample.hpp"

namespace proofmass::signal {

/// Even times: from_s + j / rate_hz for j < count, in seconds since a recording's first sample.
struct TimeGrid {
  double from_s = 0.0;
  double rate_hz = 1.0;
  std::size_t count = 0;

  [[nodiscard]] double at(std::size_t j) const { return from_s + static_cast<double>(j) / rate_hz; }
};

/// Brings channels of one time base onto another grid. Where they were taken is worked out once.
/// sinc: Σ x_k h(t − t_k) / Σ h(t − t_k) with h(d) = sinc(c d r) · Kaiser(d), r the rate of the
/// recording, 32 zeros of the sinc to either side, c = 1 to higher rates and 0.92 · target / r to
/// lower ones. A sine up to 0.8 of the lower rate's half comes back within 6e-5 of its amplitude,
/// one above the lower rate's half is less than 4e-5 of it, 32 / c samples away from ends and gaps.
/// Uneven stamps (by more than a thousandth of a step) are first brought to the even grid by cubic.
/// Source: J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function",
/// IEEE Int. Symp. Circuits and Systems (1974); A. V. Oppenheim and R. W. Schafer, Discrete-Time
/// Signal Processing, 3rd ed. (2010), section 7.6.
class Resampler {
 public:
  /// Errors: as resample().
  [[nodiscard]] static Result<Resampler> make(const TimeBase& time,
                                              std::size_t samples,
                                              ResampleMethod method,
                                              const TimeGrid& to);

  /// The values at the grid's times. Expects as many as there are samples.
  [[nodiscard]] std::vector<double> apply(View<double> values) const;
  /// The nearest sample at each of them, whatever the method: for counts.
  [[nodiscard]] std::vector<double> nearest(View<double> values) const;

 private:
  struct Place {
    std::size_t before = 0;  ///< the sample before, or at, the time
    double fraction = 0.0;   ///< of the way to the next; NaN: no value here
  };

  [[nodiscard]] std::vector<Place> places_of(const TimeGrid& grid) const;
  [[nodiscard]] std::vector<double> linear(View<double> values) const;
  [[nodiscard]] std::vector<double> cubic(View<double> values,
                                          const std::vector<Place>& places) const;
  [[nodiscard]] std::vector<double> sinc(View<double> values) const;
  [[nodiscard]] std::vector<double> mean(View<double> values) const;
  [[nodiscard]] std::vector<double> on_own_grid(View<double> values) const;

  ResampleMethod method_ = ResampleMethod::sinc;
  TimeGrid to_;
  EvenGrid own_;                           ///< of the recording
  std::vector<double> times_;              ///< of the samples
  std::vector<std::size_t> first_behind_;  ///< samples in front of which something is missing
  bool is_even_ = true;                    ///< the samples stand on their own grid
  std::vector<Place> places_;              ///< of the new times among the samples
  std::vector<Place> own_places_;  ///< of the own grid's times, where the samples are not even
};

}  // namespace proofmass::signal

#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/resample.hpp"

namespace proofmass::signal {

/// Even times: from_s + j / rate_hz for j < count, in seconds from a recording's first sample.
struct TimeGrid {
  double from_s = 0.0;
  double rate_hz = 1.0;
  std::size_t count = 0;

  [[nodiscard]] double at(std::size_t j) const { return from_s + static_cast<double>(j) / rate_hz; }
};

/// Resamples channels of one time base onto another grid; the grid positions are computed once.
///
///     sinc: Σ x_k h(t − t_k) / Σ h(t − t_k),   h(d) = sinc(c d r) · Kaiser(d),
///
/// r the rate of the recording, 32 zeros of the sinc on either side, c = 1 to higher rates and 0.92
/// · target / r to lower ones.
///
/// - A sine up to 0.8 of half the lower rate is reproduced within 6e-5 of its amplitude; one above
///   half the lower rate is attenuated to less than 4e-5. Both hold 32 / c samples away from ends
///   and gaps.
/// - Uneven stamps (by more than a thousandth of a period) are first interpolated to the even grid
///   by cubic.
///
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

  /// The values at the grid's times. Expects one value per sample.
  [[nodiscard]] std::vector<double> apply(View<double> values) const;
  /// The nearest sample at each grid time, independent of the method: for counters.
  [[nodiscard]] std::vector<double> nearest(View<double> values) const;

 private:
  struct Place {
    std::size_t before = 0;  ///< the last sample at or before the time
    double fraction = 0.0;   ///< fraction of the interval to the next; NaN: no value here
  };

  [[nodiscard]] std::vector<Place> places_of(const TimeGrid& grid) const;
  [[nodiscard]] std::vector<double> linear(View<double> values) const;
  [[nodiscard]] std::vector<double> cubic(View<double> values,
                                          const std::vector<Place>& places) const;
  [[nodiscard]] double curved(View<double> values,
                              const Place& place,
                              std::size_t begin,
                              std::size_t end) const;
  [[nodiscard]] std::vector<double> sinc(View<double> values) const;
  [[nodiscard]] std::vector<double> mean(View<double> values) const;
  [[nodiscard]] std::vector<double> on_own_grid(View<double> values) const;

  ResampleMethod method_ = ResampleMethod::sinc;
  TimeGrid to_;
  EvenGrid own_;                          ///< grid of the recording
  std::vector<double> times_;             ///< times of the samples
  std::vector<std::size_t> first_after_;  ///< samples preceded by missing ones
  bool is_even_ = true;                   ///< the samples lie on their own grid
  std::vector<Place> places_;             ///< positions of the new times among the samples
  std::vector<Place> own_places_;  ///< positions of the own grid's times, if the samples are uneven
};

}  // namespace proofmass::signal

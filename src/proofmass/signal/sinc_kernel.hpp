#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace proofmass::signal {

/// c · sinc(c d) · Kaiser window, d in samples: what a band-limited series is interpolated with.
/// Zero from 32 zeros of the sinc on to either side; β = 8. Kept as a table that is read linearly,
/// good to 1e-7 of the peak.
class SincKernel {
 public:
  static constexpr std::size_t zeros = 32;

  /// `cutoff` in (0, 1]: the highest frequency that is let through, in halves of the sample rate.
  explicit SincKernel(double cutoff);

  [[nodiscard]] double half_width() const { return half_width_; }  ///< samples
  [[nodiscard]] double at(double d) const {
    const double place = std::abs(d) * per_sample_;
    const auto below = static_cast<std::size_t>(place);
    if (below + 1 >= table_.size()) return 0.0;
    const double fraction = place - static_cast<double>(below);
    return table_[below] + fraction * (table_[below + 1] - table_[below]);
  }

 private:
  double half_width_;
  double per_sample_;
  std::vector<double> table_;
};

}  // namespace proofmass::signal

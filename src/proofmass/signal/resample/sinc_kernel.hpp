#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace proofmass::signal {

/// c · sinc(c d) · Kaiser window, d in samples: the kernel of band-limited interpolation. Zero
/// beyond 32 zeros of the sinc on either side; β = 8. Stored as a table with linear interpolation,
/// accurate to 1e-7 of the peak.
class SincKernel {
 public:
  static constexpr std::size_t zeros = 32;

  /// `cutoff` in (0, 1]: the highest frequency passed, relative to half the sample rate.
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

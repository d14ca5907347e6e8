#include "proofmass/characterise/allan/total_variance.hpp"

#include <algorithm>
#include <vector>

#include "proofmass/characterise/allan/difference_kernels.hpp"
#include "proofmass/characterise/allan/phase_record.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

/// C[k] = Σ_{i<k} v[i], k = 0 … v.size(), of the values minus the line through the first and the
/// last, which would otherwise dominate the sums although the statistic is invariant to it.
void accumulate_less_line(View<double> v, std::vector<double>& C) {
  const double slope = (v.back() - v[0]) / static_cast<double>(v.size() - 1);
  C.resize(v.size() + 1);
  C[0] = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i)
    C[i + 1] = C[i] + ((v[i] - v[0]) - slope * static_cast<double>(i));
}

/// A stretch of 3m values, minus its slope, between its mirror images: w[−1−k] = w[k] and w[3m+k] =
/// w[3m−1−k].
class MirroredStretch {
 public:
  explicit MirroredStretch(std::size_t m)
      : m_(m), side_(3 * m / 2), triangle_(3 * m + 1), sums_(3 * m + 2 * side_ + 1) {
    for (std::size_t k = 0; k < triangle_.size(); ++k)
      triangle_[k] = 0.5 * static_cast<double>(k) * (static_cast<double>(k) - 1.0);
  }

  /// Σ (W[j+2m] − 2 W[j+m] + W[j])² over j = −3m … 3m − 1, where W[j] is the sum of m values from
  /// w[j] on; C: the 3m + 1 cumulative sums of the stretch, from any origin.
  ///
  /// By symmetry j and 3m − j, and j and −3m − j, give the same: j = −3m/2 … 3m/2 suffices.
  double sum_of_squares(const double* C) {
    mirror(C);
    const std::size_t count = 2 * side_ + 1;
    double sum = 2.0 * squared_third_differences(sums_.data(), m_, count);
    if (m_ % 2 == 0)  // only then do both ends fall on the axes and have no other half
      sum -= squared_third_differences(sums_.data(), m_, 1) +
             squared_third_differences(sums_.data() + count - 1, m_, 1);
    return sum;
  }

 private:
  /// Slope between the means of the two halves, without the middle value where there is one.
  [[nodiscard]] double slope(const double* C) const {
    const std::size_t length = 3 * m_;
    const double first = C[side_] - C[0];
    const double second = C[length] - C[length - side_];
    return (second - first) / (static_cast<double>(side_) * static_cast<double>(length - side_));
  }

  void mirror(const double* C) {
    const std::size_t length = 3 * m_;
    const double slope = this->slope(C);
    double* inside = sums_.data() + side_;
    for (std::size_t k = 0; k <= length; ++k) inside[k] = (C[k] - C[0]) - slope * triangle_[k];
    for (std::size_t k = 1; k <= side_; ++k) sums_[side_ - k] = -inside[k];
    const double twice_all = 2.0 * inside[length];
    for (std::size_t k = 1; k <= side_; ++k) inside[length + k] = twice_all - inside[length - k];
  }

  std::size_t m_;
  std::size_t side_;              ///< how far of either mirror image is needed
  std::vector<double> triangle_;  ///< cumulative sums of 0, 1, 2 …
  std::vector<double> sums_;      ///< cumulative sums of w[−side] … w[3m−1+side]
};

/// Mean square of the second differences of means of m values, over all positions in each mirrored
/// stretch of 3m and over the stretches.
PhaseVariance mirrored_mean_square(View<double> values, std::size_t m) {
  const std::size_t places = values.size() - 3 * m + 1;
  const std::size_t stride = affordable_stride(values.size(), m);
  const std::size_t batch = std::max<std::size_t>(m / stride, 1);
  MirroredStretch stretch(m);
  std::vector<double> C;
  PhaseVariance result;
  double sum = 0.0;
  for (std::size_t begin = 0; begin < places; begin += batch * stride) {
    const std::size_t count = std::min(batch, (places - 1 - begin) / stride + 1);
    accumulate_less_line(values.subspan(begin, (count - 1) * stride + 3 * m), C);
    for (std::size_t k = 0; k < count; ++k) sum += stretch.sum_of_squares(C.data() + k * stride);
    result.terms += count;
  }
  const double length = static_cast<double>(m);
  result.variance = sum / (6.0 * length * length * length * static_cast<double>(result.terms));
  return result;
}

}  // namespace

PhaseVariance total_variance(View<double> phase, double tau0_s, std::size_t m) {
  PM_EXPECTS(tau0_s > 0.0 && m > 0 && phase.size() > 2 && m < phase.size());
  const std::vector<double> x = without_mean_rate(phase);
  const std::size_t last = x.size() - 1;
  const auto before = [&](std::size_t i) { return i >= m ? x[i - m] : 2.0 * x[0] - x[m - i]; };
  const auto after = [&](std::size_t i) {
    return i + m <= last ? x[i + m] : 2.0 * x[last] - x[2 * last - i - m];
  };
  double sum = 0.0;
  for (std::size_t i = 1; i < last; ++i) {
    const double z = before(i) - 2.0 * x[i] + after(i);
    sum += z * z;
  }
  const double tau_s = static_cast<double>(m) * tau0_s;
  return {sum / (2.0 * tau_s * tau_s * static_cast<double>(last - 1)), last - 1};
}

PhaseVariance modified_total_variance(View<double> phase, double tau0_s, std::size_t m) {
  PM_EXPECTS(tau0_s > 0.0 && m > 0 && 3 * m <= phase.size());
  PhaseVariance result = mirrored_mean_square(phase, m);
  const double tau_s = static_cast<double>(m) * tau0_s;
  result.variance /= 2.0 * tau_s * tau_s;
  return result;
}

PhaseVariance hadamard_total_variance(View<double> phase, double tau0_s, std::size_t m) {
  PM_EXPECTS(tau0_s > 0.0 && m > 0 && 3 * m < phase.size());
  std::vector<double> rates(phase.size() - 1);
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (phase[i + 1] - phase[i]) / tau0_s;
  if (m == 1) {
    const std::size_t terms = rates.size() - 2;
    return {squared_second_differences(rates.data(), 1, terms) / (6.0 * static_cast<double>(terms)),
            terms};
  }
  PhaseVariance result = mirrored_mean_square(rates, m);
  result.variance /= 6.0;
  return result;
}

}  // namespace proofmass::characterise

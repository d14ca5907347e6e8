#include "proofmass/fleet/family.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "proofmass/core/random.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::fleet {
namespace {

struct Centre {
  double location = 0.0, scale = 0.0;
};

// Weighted by (1 − u²)² with u in units of 6 (location) and 9 (scale) median deviations.
Centre biweight(const std::vector<double>& values) {
  const double middle = median(values).value_or(0.0);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - middle));
  const double mad = median(distances).value_or(0.0);
  if (!(mad > 0.0)) return {middle, 0.0};
  double weights = 0.0, sum = 0.0, above = 0.0, below = 0.0;
  for (const double value : values) {
    const double near = square((value - middle) / (6.0 * mad));
    if (near < 1.0) {
      weights += square(1.0 - near);
      sum += square(1.0 - near) * (value - middle);
    }
    const double far = square((value - middle) / (9.0 * mad));
    if (far < 1.0) {
      above += square(value - middle) * square(square(1.0 - far));
      below += (1.0 - far) * (1.0 - 5.0 * far);
    }
  }
  const auto n = static_cast<double>(values.size());
  return {middle + sum / weights, std::sqrt(n * above) / std::abs(below)};
}

std::vector<double> scores(const std::vector<double>& values) {
  const Centre centre = biweight(values);
  std::vector<double> z;
  if (!(centre.scale > 0.0)) return z;
  for (const double value : values) z.push_back((value - centre.location) / centre.scale);
  return z;
}

// With equal variances these are the means themselves, but for a factor.
std::vector<double> weighed(const std::vector<SensorMean>& means) {
  std::vector<double> values;
  double within = 0.0;
  for (const SensorMean& mean : means) {
    values.push_back(mean.value);
    within += mean.within_variance / static_cast<double>(means.size());
  }
  const Centre centre = biweight(values);
  const double between = std::max(0.0, square(centre.scale) - within);
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double variance = between + means[k].within_variance;
    if (variance > 0.0) values[k] = (means[k].value - centre.location) / std::sqrt(variance);
  }
  return values;
}

}  // namespace

/// What |z| is like in normal families of one size.
class FamilyTest::NullScores {
 public:
  explicit NullScores(std::size_t size) {
    constexpr std::size_t draws = 400000;
    Random random(1, "family", size);
    std::vector<double> values(size);
    while (sorted_.size() < draws) {
      for (double& value : values) value = random.normal();
      for (const double z : scores(values)) sorted_.push_back(std::abs(z));
    }
    std::ranges::sort(sorted_);
    fit_tail();
  }
  [[nodiscard]] double p(double z) const {
    const auto n = static_cast<double>(sorted_.size());
    const double far = std::abs(z);
    if (far > tail_from_) return tail_p_ * std::pow(far / tail_from_, -tail_power_);
    const auto above = sorted_.end() - std::ranges::lower_bound(sorted_, far);
    return (static_cast<double>(above) + 1.0) / (n + 1.0);
  }

 private:
  // Source: B. M. Hill, Annals of Statistics 3 (1975) 1163.
  void fit_tail() {
    constexpr std::size_t count = 400;
    const std::size_t first = sorted_.size() - count;
    tail_from_ = sorted_[first];
    tail_p_ = static_cast<double>(count) / static_cast<double>(sorted_.size());
    double sum = 0.0;
    for (std::size_t k = first + 1; k < sorted_.size(); ++k)
      sum += std::log(sorted_[k] / tail_from_);
    tail_power_ = static_cast<double>(count - 1) / sum;
  }

  std::vector<double> sorted_;
  double tail_from_ = 0.0, tail_p_ = 1.0, tail_power_ = 1.0;
};

FamilyTest::FamilyTest() = default;
FamilyTest::~FamilyTest() = default;

std::vector<Distance> FamilyTest::distances(const std::vector<SensorMean>& means) {
  std::vector<Distance> found;
  if (means.size() < least_family) return found;
  const std::vector<double> z = scores(weighed(means));
  if (z.empty()) return found;
  auto& null = known_[means.size()];
  if (!null) null = std::make_unique<NullScores>(means.size());
  for (const double one : z) found.push_back({one, null->p(one)});
  return found;
}

std::vector<double> adjusted_p(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return p[a] > p[b]; });
  std::vector<double> adjusted(p.size());
  double least = 1.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto rank = static_cast<double>(p.size() - k);
    least = std::min(least, p[order[k]] * static_cast<double>(p.size()) / rank);
    adjusted[order[k]] = least;
  }
  return adjusted;
}

}  // namespace proofmass::fleet

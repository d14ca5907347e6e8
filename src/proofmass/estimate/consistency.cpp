#include "proofmass/estimate/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/consistency_verdict.hpp"

namespace proofmass::estimate {
namespace {

/// Minimum number of stretches for a scatter.
constexpr std::size_t fewest_stretches = 16;
/// Innovations are clipped here; the square must stay finite.
constexpr double furthest = 1e9;

bool disagree(const std::vector<ChannelConsistency>& channels, Verdict all) {
  return std::ranges::any_of(channels, [&](const ChannelConsistency& one) {
    return one.verdict != all && one.verdict != Verdict::undetermined;
  });
}

double size_of(const ChannelConsistency& one) {
  return std::abs(std::log(std::max(one.remedy_factor, 1e-9)));
}

/// The channels together if they agree, else the most severe.
void conclude(Consistency& result) {
  const auto& channels = result.channels;
  const auto graver = [](const ChannelConsistency& a, const ChannelConsistency& b) {
    return a.verdict != b.verdict ? a.verdict < b.verdict : size_of(a) < size_of(b);
  };
  const ChannelConsistency* worst = &result.all;
  if (channels.size() > 1 && disagree(channels, result.all.verdict)) {
    const auto found = std::ranges::max_element(channels, graver);
    if (found->verdict >= result.all.verdict) {
      worst = &*found;
      result.worst_channel = static_cast<std::size_t>(found - channels.begin());
    }
  }
  result.verdict = worst->verdict;
  result.remedy = worst->remedy;
  result.remedy_factor = worst->remedy_factor;
}

}  // namespace

void InnovationTally::add(double innovation, double variance, bool used) {
  if (!std::isfinite(innovation) || !std::isfinite(variance) || variance <= 0.0) return miss();
  if (!used) {
    ++gated_;
    return miss();
  }
  const double nu = std::clamp(innovation / std::sqrt(variance), -furthest, furthest);
  ++used_;
  squares_ += nu * nu;
  if (std::abs(nu) <= 1.96) ++inside_;
  if (has_last_) {
    ++pairs_;
    products_ += last_ * nu;
  }
  last_ = nu;
  has_last_ = true;
  add_to_stretches(nu);
}

// A carry that runs up the levels, as in a binary counter: two steps a value on average.
void InnovationTally::add_to_stretches(double nu) {
  double sum = nu;
  for (Level& level : levels_) {
    if (!level.has_half) {
      level.half = sum;
      level.has_half = true;
      return;
    }
    sum += level.half;
    level.has_half = false;
    ++level.count;
    level.squares += sum * sum;
  }
}

void InnovationTally::add_nis(double nis, std::size_t degrees) {
  if (!std::isfinite(nis) || nis < 0.0) return;
  unsigned_ += degrees;
  unsigned_squares_ += std::min(nis, furthest * furthest);
}

void InnovationTally::join(const InnovationTally& other) {
  used_ += other.used_;
  gated_ += other.gated_;
  inside_ += other.inside_;
  pairs_ += other.pairs_;
  unsigned_ += other.unsigned_;
  squares_ += other.squares_;
  unsigned_squares_ += other.unsigned_squares_;
  products_ += other.products_;
  for (std::size_t i = 0; i < levels; ++i) {
    levels_[i].count += other.levels_[i].count;
    levels_[i].squares += other.levels_[i].squares;
  }
  miss();
}

std::vector<StretchScatter> InnovationTally::scatter(double rate_hz) const {
  std::vector<StretchScatter> stretches;
  if (!(squares_ > 0.0)) return stretches;
  const auto n = static_cast<double>(used_);
  double length = 1.0;
  for (const Level& level : levels_) {
    length *= 2.0;
    if (level.count < fewest_stretches) break;
    const auto count = static_cast<double>(level.count);
    // ⟨ν²⟩ uses the same values: the remaining variance is 1/count − 1/n.
    const double dof = count * n / (n - count);
    stretches.push_back({.length_s = length / rate_hz,
                         .stretches = level.count,
                         .factor = std::sqrt(level.squares / (count * length) / (squares_ / n)),
                         .lower = std::sqrt(chi_square_quantile(0.025, dof) / dof),
                         .upper = std::sqrt(chi_square_quantile(0.975, dof) / dof)});
  }
  return stretches;
}

ChannelConsistency InnovationTally::judge(const ConsistencyOptions& options,
                                          std::size_t judged) const {
  ChannelConsistency figures;
  figures.innovations = used_ + unsigned_;
  figures.gated = gated_;
  if (figures.innovations > 0) {
    figures.nis = (squares_ + unsigned_squares_) / static_cast<double>(figures.innovations);
    const Bounds bounds = mean_chi_square_95(figures.innovations);
    figures.nis_lower = bounds.lower;
    figures.nis_upper = bounds.upper;
    // The gate of a channel does not apply to a sum over channels.
    const double gate = unsigned_ > 0 ? std::numeric_limits<double>::infinity() : options.gate;
    figures.std_factor = ungated_std(figures.nis, gate);
  }
  if (used_ + gated_ > 0)
    figures.inside_95 = static_cast<double>(inside_) / static_cast<double>(used_ + gated_);
  if (pairs_ > 0 && squares_ > 0.0) {
    const auto pairs = static_cast<double>(pairs_);
    figures.lag_one = products_ / pairs / (squares_ / static_cast<double>(used_));
    figures.lag_one_bound = 1.96 / std::sqrt(pairs);
  }
  figures.stretches = scatter(options.rate_hz);
  decide(figures, options.gate, judged);
  return figures;
}

ConsistencyCheck::ConsistencyCheck(ConsistencyOptions options)
    : options_(std::move(options)), channels_(options_.channels.size()) {
  PM_EXPECTS(options_.rate_hz > 0.0 && options_.gate > 0.0);
}

void ConsistencyCheck::add(std::size_t channel, double innovation, double variance, bool used) {
  PM_EXPECTS(channel < channels_.size());
  channels_[channel].add(innovation, variance, used);
}

void ConsistencyCheck::miss(std::size_t channel) {
  PM_EXPECTS(channel < channels_.size());
  channels_[channel].miss();
}

void ConsistencyCheck::add_nis(double nis, std::size_t degrees) {
  epochs_.add_nis(nis, degrees);
}

Consistency ConsistencyCheck::judge() const {
  Consistency result;
  InnovationTally together = epochs_;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    together.join(channels_[i]);
    result.channels.push_back(channels_[i].judge(options_, channels_.size()));
    result.channels.back().name = options_.channels[i];
  }
  result.all = together.judge(options_);
  result.nis = result.all.nis;
  result.nis_lower = result.all.nis_lower;
  result.nis_upper = result.all.nis_upper;
  result.innovations = result.all.innovations;
  result.gated = result.all.gated;
  if (result.all.std_factor) result.nis_ungated = std::pow(*result.all.std_factor, 2);
  conclude(result);
  return result;
}

Consistency check_consistency(const std::vector<InnovationSeries>& channels,
                              const ConsistencyOptions& options) {
  PM_EXPECTS(channels.size() == options.channels.size());
  ConsistencyCheck check(options);
  std::vector<std::vector<signal::WhitenessTest>> whiteness;
  std::vector<double> normalised;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto& [innovation, variance, used] = channels[i];
    PM_EXPECTS(innovation.size() == variance.size());
    PM_EXPECTS(used.empty() || used.size() == innovation.size());
    normalised.assign(innovation.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < innovation.size(); ++k) {
      const bool is_used = used.empty() || used[k] != 0;
      check.add(i, innovation[k], variance[k], is_used);
      if (is_used && variance[k] > 0.0) normalised[k] = innovation[k] / std::sqrt(variance[k]);
    }
    whiteness.push_back(signal::test_whiteness_at_scales(normalised, options.rate_hz));
  }
  Consistency result = check.judge();
  result.whiteness = std::move(whiteness);
  return result;
}

}  // namespace proofmass::estimate

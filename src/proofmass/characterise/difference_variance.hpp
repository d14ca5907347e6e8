#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "proofmass/characterise/phase_variance.hpp"
#include "proofmass/characterise/statistic.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// The variances that are mean squares of differences of an integral of the series: Allan,
/// modified, time and Hadamard, at many averaging factors in one pass. With θ[k] the sum of the
/// first k samples, Θ[k] the sum of the first k of those, and Δ_m the difference over m places,
///
///     adev, oadev  σ² = mean (Δ_m² θ)² / (2 m²)        hdev, ohdev  σ² = mean (Δ_m³ θ)² / (6 m²)
///     mdev, tdev   σ² = mean (Δ_m³ Θ)² / (2 m⁴)        (tdev: that of mdev)
///
/// θ and Θ decimate exactly, so a factor m = q·2^k, q odd or in 16 … 31, is served from every
/// 2^k-th of them: terms then start every 2^k samples, 16 or more to a τ, which leaves 99 % of the
/// degrees of freedom of a start at every sample; every term is itself exact. Source: W. J. Riley,
/// NIST SP 1065 (2008), sections 5.2.2–5.2.9; C. A. Greenhall, W. Riley, Uncertainty of stability
/// variances based on finite differences, PTTI 2003, for the free stride.
///
/// A missing sample (NaN) stands on the straight line between its neighbours, and a term is counted
/// if at most one in sixteen of its samples is missing: none below 16.
///
/// Cost: O(N) for all factors together where these are spread evenly in log τ; memory
/// O(chunk + longest factor of each level), independent of N.
class DifferenceVariances {
 public:
  /// factors: ascending, distinct, above 0. least_overlap: terms to a τ that decimation must leave;
  /// full_overlap starts one at every sample, at O(N) for each factor.
  DifferenceVariances(Statistic statistic,
                      View<std::size_t> factors,
                      std::size_t least_overlap = 16);

  void add(View<double> samples);

  /// In the order of the factors; terms = 0 and variance 0 where the series was too short. May be
  /// asked at any time.
  [[nodiscard]] std::vector<PhaseVariance> finish() const;

  /// Samples added, those missing at the end included.
  [[nodiscard]] std::size_t samples() const { return samples_; }

  /// Samples between the starts of terms at factor m.
  [[nodiscard]] static std::size_t stride(Statistic statistic,
                                          std::size_t m,
                                          std::size_t least_overlap);

  static constexpr std::size_t full_overlap = std::numeric_limits<std::size_t>::max();

 private:
  struct Factor {
    std::size_t at;       ///< place in the caller's list
    std::size_t spacing;  ///< m in units of the level's stride
    double sum = 0.0;
    std::size_t terms = 0;
  };
  struct Level {
    std::vector<Factor> factors;
    std::vector<double> points;          ///< of the integral, the newest last
    std::vector<std::uint32_t> missing;  ///< running count of missing samples at each point
    std::size_t fresh = 0;               ///< points not yet taken into any term
    std::size_t newest = 0;              ///< number of the newest point at this level
    std::size_t span = 0;                ///< points of the longest term, less one
  };

  void begin();
  void add_complete(View<double> samples);
  void add_one(double y);
  void add_sample(double y);
  void close_gap(double next);
  void append_point();
  void process(std::size_t worth);
  void take(const Level& level, Factor& factor, std::size_t stride) const;
  [[nodiscard]] double squared_differences(const double* x,
                                           const Factor& factor,
                                           std::size_t n) const;
  void decimate(const Level& from, Level& to) const;
  void forget(Level& level);
  void rebase();

  std::vector<Level> levels_;
  Statistic statistic_;
  std::size_t factor_count_ = 0;
  std::size_t samples_ = 0;  ///< given
  std::size_t points_ = 0;   ///< of the integral, so far
  std::size_t since_rebase_ = 0;
  double offset_ = 0.0;  ///< taken off each sample, lest the integral grow
  double theta_ = 0.0, big_theta_ = 0.0;
  double last_ = 0.0;    ///< the last sample that was there
  std::size_t gap_ = 0;  ///< samples missing since
  std::uint32_t missing_ = 0;
  bool started_ = false;
};

}  // namespace proofmass::characterise

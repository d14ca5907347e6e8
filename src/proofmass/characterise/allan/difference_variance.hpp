#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "proofmass/characterise/allan/phase_variance.hpp"
#include "proofmass/characterise/allan/statistic.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// Variances that are mean squares of differences of an integral of the series: Allan, modified,
/// time and Hadamard, at many averaging factors in one pass. With θ[k] the sum of the first k
/// samples, Θ[k] the sum of the first k of those, and Δ_m the difference over m steps,
///
///     adev, oadev  σ² = mean (Δ_m² θ)² / (2 m²)        hdev, ohdev  σ² = mean (Δ_m³ θ)² / (6 m²)
///     mdev, tdev   σ² = mean (Δ_m³ Θ)² / (2 m⁴)        (tdev: that of mdev)
///
/// - θ and Θ decimate exactly, so a factor m = q·2^k, q odd or in 16 … 31, uses every 2^k-th of
///   them. Terms then start every 2^k samples, 16 or more to a τ, which retains 99 % of the degrees
///   of freedom of full overlap; every term is itself exact.
/// - A missing sample (NaN) is interpolated linearly, and a term counts if at most one in sixteen
///   of its samples is missing: none below 16.
///
/// Source: W. J. Riley, NIST SP 1065 (2008), sections 5.2.2–5.2.9; C. A. Greenhall, W. Riley,
/// Uncertainty of stability variances based on finite differences, PTTI 2003, for the free stride.
///
/// Cost: O(N) for all factors together if these are evenly spaced in log τ; memory O(chunk +
/// longest factor of each level), independent of N.
class DifferenceVariances {
 public:
  /// factors: ascending, distinct, above 0. least_overlap: minimum terms per τ after decimation;
  /// full_overlap starts a term at every sample, at O(N) for each factor.
  DifferenceVariances(Statistic statistic,
                      View<std::size_t> factors,
                      std::size_t least_overlap = 16);

  void add(View<double> samples);

  /// Variances in the order of the factors; terms = 0 and variance 0 if the series is too short.
  /// May be called at any time.
  [[nodiscard]] std::vector<PhaseVariance> finish() const;

  /// Number of samples added, including those missing at the end.
  [[nodiscard]] std::size_t samples() const { return samples_; }

  /// Samples between the starts of terms at factor m.
  [[nodiscard]] static std::size_t stride(Statistic statistic,
                                          std::size_t m,
                                          std::size_t least_overlap);

  static constexpr std::size_t full_overlap = std::numeric_limits<std::size_t>::max();

 private:
  struct Factor {
    std::size_t at;       ///< index in the caller's list
    std::size_t spacing;  ///< m in units of the level's stride
    double sum = 0.0;
    std::size_t terms = 0;
  };
  struct Level {
    std::vector<Factor> factors;
    std::vector<double> points;          ///< of the integral, the newest last
    std::vector<std::uint32_t> missing;  ///< running count of missing samples at each point
    std::size_t fresh = 0;               ///< points not yet used in a term
    std::size_t newest = 0;              ///< index of the newest point at this level
    std::size_t span = 0;                ///< points of the longest term, minus one
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
  std::size_t samples_ = 0;  ///< number added
  std::size_t points_ = 0;   ///< of the integral, so far
  std::size_t since_rebase_ = 0;
  double offset_ = 0.0;  ///< subtracted from each sample to bound the integral
  double theta_ = 0.0, big_theta_ = 0.0;
  double last_ = 0.0;    ///< the last valid sample
  std::size_t gap_ = 0;  ///< samples missing since
  std::uint32_t missing_ = 0;
  bool started_ = false;
};

}  // namespace proofmass::characterise

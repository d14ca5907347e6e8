#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "proofmass/characterise/allan/phase_variance.hpp"
#include "proofmass/characterise/allan/statistic.hpp"
#include "proofmass/core/state_bytes.hpp"
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
/// - A part of a series can be accumulated by itself: its terms start where those of the whole do,
///   and the points at its two ends are kept for the terms that reach beyond it.
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

  /// For a part of a series of an overlapping statistic. first: index of its first sample, counted
  /// from the first valid sample of the whole series; negative before that.
  DifferenceVariances(Statistic statistic,
                      View<std::size_t> factors,
                      std::size_t least_overlap,
                      std::ptrdiff_t first);

  void add(View<double> samples);

  /// Adds the part that follows, made with the same options. The terms across the border are exact;
  /// the integrals of the two are brought together by the polynomials that differences do not see.
  void append(DifferenceVariances part);

  /// Fails where the state read is not that of such a part with `samples` samples.
  void exchange(StateBytes& bytes, std::size_t samples);

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
    /// The first `span` points of a part, in the frame of its beginning.
    std::vector<double> head;
    std::vector<std::uint32_t> head_missing;
  };
  /// Difference between two integrals of one series: a polynomial of the points since `at`, that
  /// of offsets, and of values of θ and Θ, which differ.
  struct Frame {
    double offset = 0.0, theta = 0.0, big_theta = 0.0;
    std::size_t at = 0;
  };

  void begin();
  void add_complete(View<double> samples);
  void add_one(double y);
  void add_sample(double y);
  void close_gap(double next);
  void append_point();
  void process(std::size_t worth);
  void take(const Level& level, Factor& factor, std::size_t stride) const;
  void take_all(const Level& level,
                Factor& factor,
                std::size_t begin,
                std::size_t end,
                std::size_t stride) const;
  void settle();
  void fill_head(Level& level, std::size_t stride) const;
  [[nodiscard]] double in_frame(const Frame& frame, double t) const;
  [[nodiscard]] static Frame moved(Frame frame, std::size_t at);
  [[nodiscard]] static Frame sum(const Frame& a, const Frame& b, std::size_t at);
  void join(Level& level,
            const Level& part,
            std::size_t k,
            const Frame& step,
            const DifferenceVariances& other);
  void begin_with(DifferenceVariances part);
  [[nodiscard]] std::size_t points_of_level(std::size_t k) const;
  void exchange_level(StateBytes& bytes, std::size_t k);
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
  std::optional<std::ptrdiff_t> first_;  ///< of a part
  std::size_t lead_ = 0;                 ///< samples missing before its first valid one
  double first_valid_ = 0.0;
  std::size_t start_ = 0;     ///< number of its first point
  double head_offset_ = 0.0;  ///< offset of the frame of its beginning
  Frame frame_;               ///< the frame of its beginning minus the present one
};

}  // namespace proofmass::characterise

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/whiteness.hpp"

// Tests whether a filter's errors match its stated covariance, from its innovations. If the model
// and its noise parameters are correct they are independent, ν = y/√S ~ N(0, 1).
//
//   ConsistencyCheck check({.channels = {"acc_x", "acc_y"}, .rate_hz = 100.0});
//   … in the filter's loop …  check.add(channel, innovation, variance, used);
//   const Consistency verdict = check.judge();
namespace proofmass::estimate {

enum class Verdict {
  undetermined,   ///< too few innovations for a decision
  consistent,     ///< within chance, or off by less than matters
  cautious,       ///< the errors are smaller than stated
  coloured,       ///< as large as stated, but correlated: their sums deviate too much, or too
                  /// little
  overconfident,  ///< the errors are larger than stated
};

/// Which parameter to change. Each has a factor: of the standard deviation, or of the root of the
/// power spectral density.
enum class Remedy {
  none,
  measurement_noise,  ///< R; factor above 1: increase it, below: decrease it
  process_noise,      ///< Q of the motion
  both_noises,        ///< R and Q alike: their ratio, hence the estimate, is correct
  /// Slow error not visible between neighbours: the random walk of the bias, an unmodelled bias, or
  /// Q of a slow motion.
  slow_noise,
  outliers,  ///< a gate, or removal of the disturbance: few measurements are far off
};

struct ConsistencyOptions {
  std::vector<std::string> channels{};  ///< names, one for each channel
  double rate_hz = 1.0;                 ///< epochs per second, for the lengths of stretches in s
  /// Innovations beyond this many standard deviations were not used.
  double gate = std::numeric_limits<double>::infinity();
};

/// Growth of the sum of innovations over successive stretches: 1 if they are independent.
struct StretchScatter {
  double length_s = 0.0;
  std::size_t stretches = 0;
  double factor = 0.0;              ///< √(L ⟨mean over L²⟩ / ⟨ν²⟩)
  double lower = 0.0, upper = 0.0;  ///< 95 % limits for white innovations
};

/// Innovation statistics of one channel, or of all together.
struct ChannelConsistency {
  std::string name;
  double nis = 0.0;  ///< ⟨ν²⟩ over the innovations used
  double nis_lower = 0.0, nis_upper = 0.0;
  std::size_t innovations = 0;  ///< number used
  std::size_t gated = 0;        ///< number rejected by the gate
  /// Ratio of the true standard deviation of an innovation to the stated one: √nis without a gate.
  /// Absent if the gate leaves it undetermined.
  std::optional<double> std_factor;
  /// Share of all innovations, including the gated ones, with |ν| ≤ 1.96; absent if only sums were
  /// added.
  std::optional<double> inside_95;
  /// ⟨ν[k] ν[k+1]⟩ / ⟨ν²⟩ over neighbours; absent if there are none.
  std::optional<double> lag_one;
  double lag_one_bound = 0.0;  ///< 95 % limit of |lag_one| for white innovations
  std::vector<StretchScatter> stretches;
  Verdict verdict = Verdict::undetermined;
  Remedy remedy = Remedy::none;
  double remedy_factor = 1.0;
};

/// Normalised innovations squared of the filter, mean per channel, with its 95 % limits for correct
/// noise parameters; and the resulting verdict.
struct Consistency {
  double nis = 0.0, nis_lower = 0.0, nis_upper = 0.0;
  std::size_t innovations = 0;  ///< accepted, of the channels present
  std::size_t gated = 0;
  std::optional<double> nis_ungated{};      ///< estimate corrected for the truncation by the gate
  Verdict verdict = Verdict::undetermined;  ///< the most severe of any channel and of all together
  Remedy remedy = Remedy::none;
  double remedy_factor = 1.0;
  std::optional<std::size_t> worst_channel{};  ///< channel of the verdict; absent: all together
  ChannelConsistency all{};                    ///< the channels taken together
  std::vector<ChannelConsistency> channels{};
  /// Tests of each channel whose series was kept: at the sample and at 1, 10, 100 … s.
  std::vector<std::vector<signal::WhitenessTest>> whiteness{};
  /// Mean squares of the smoother's residuals, 1 expected: see smoother_consistency.hpp. Absent
  /// without a smoother.
  std::optional<Uncertain> smoothed_readings{}, smoothed_motion{};
};

/// Sums over one channel's normalised innovations. Fixed memory, some tens of ns per value.
class InnovationTally {
 public:
  /// `used` is false for an innovation rejected by the gate.
  void add(double innovation, double variance, bool used = true);
  /// Marks a missing measurement: the innovations on both sides are not neighbours.
  void miss() { has_last_ = false; }

  /// Adds another channel's sums.
  void join(const InnovationTally& other);
  /// Adds a NIS with its degrees of freedom, without the individual innovations.
  void add_nis(double nis, std::size_t degrees);

  /// Statistics and verdict; `judged` channels share the 5 % significance level.
  [[nodiscard]] ChannelConsistency judge(const ConsistencyOptions& options,
                                         std::size_t judged = 1) const;

 private:
  void add_to_stretches(double nu);
  [[nodiscard]] std::vector<StretchScatter> scatter(double rate_hz) const;

  /// Stretches of 2^(i+1) innovations.
  struct Level {
    double half = 0.0;  ///< sum over the first half of a stretch
    bool has_half = false;
    std::size_t count = 0;
    double squares = 0.0;  ///< of the sums over stretches, squared
  };
  static constexpr std::size_t levels = 32;
  std::size_t used_ = 0, gated_ = 0, inside_ = 0, pairs_ = 0;
  std::size_t unsigned_ = 0;  ///< degrees of freedom in used_ without an innovation
  double squares_ = 0.0, unsigned_squares_ = 0.0, products_ = 0.0, last_ = 0.0;
  bool has_last_ = false;
  std::array<Level, levels> levels_{};
};

/// Checks a running filter. add() does not allocate.
class ConsistencyCheck {
 public:
  explicit ConsistencyCheck(ConsistencyOptions options);

  /// Innovation y of one channel at one epoch and its variance S = h P hᵀ + R as stated by the
  /// filter. Non-finite values count as missing.
  void add(std::size_t channel, double innovation, double variance, bool used = true);
  void miss(std::size_t channel);
  /// For a filter that keeps only yᵀ S⁻¹ y over `degrees` channels: enters the mean only.
  void add_nis(double nis, std::size_t degrees);

  [[nodiscard]] Consistency judge() const;

 private:
  ConsistencyOptions options_;
  std::vector<InnovationTally> channels_;
  InnovationTally epochs_;
};

/// One channel's innovations over a recording; NaN where a measurement is missing.
struct InnovationSeries {
  View<double> innovation, variance;
  View<unsigned char> used = {};  ///< empty: all
};

/// Batch form of ConsistencyCheck, with the tests of signal/whiteness.
[[nodiscard]] Consistency check_consistency(const std::vector<InnovationSeries>& channels,
                                            const ConsistencyOptions& options);

}  // namespace proofmass::estimate

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

// Whether a filter errs as far as it says: judged by its innovations, which of a filter whose model
// and noise figures are true are independent, ν = y/√S ~ N(0, 1).
//
//   ConsistencyCheck check({.channels = {"acc_x", "acc_y"}, .rate_hz = 100.0});
//   … in the filter's loop …  check.add(channel, innovation, variance, used);
//   const Consistency verdict = check.judge();
namespace proofmass::estimate {

enum class Verdict {
  undetermined,   ///< too few innovations to say anything
  consistent,     ///< within what chance does, or off by less than matters
  cautious,       ///< the errors are smaller than stated
  coloured,       ///< as large as stated, but they hang together: their sums go too far, or not far
  overconfident,  ///< the errors are larger than stated
};

/// What to move. Each has a factor: that of the standard deviation, or of the root of the power
/// spectral density.
enum class Remedy {
  none,
  measurement_noise,  ///< R, factor above 1: raise it, below: lower it
  process_noise,      ///< Q of the motion
  both_noises,        ///< R and Q alike: their ratio, hence the estimate, is right
  /// What wanders more slowly than neighbours show: the walk of the bias, a bias that is not
  /// modelled, or Q of a motion that is slow itself.
  slow_noise,
  outliers,  ///< a gate, or what disturbs the readings: few of them are far off
};

struct ConsistencyOptions {
  std::vector<std::string> channels{};  ///< names, one for each channel
  double rate_hz = 1.0;                 ///< of the instants, for the lengths of stretches in s
  /// Beyond so many standard deviations an innovation was not used.
  double gate = std::numeric_limits<double>::infinity();
};

/// How far the innovations of successive stretches add up: 1 where they are independent.
struct StretchScatter {
  double length_s = 0.0;
  std::size_t stretches = 0;
  double factor = 0.0;              ///< √(L ⟨mean over L²⟩ / ⟨ν²⟩)
  double lower = 0.0, upper = 0.0;  ///< between these in 95 % of runs of white innovations
};

/// What the innovations of one channel say, or of all together.
struct ChannelConsistency {
  std::string name;
  double nis = 0.0;  ///< ⟨ν²⟩ over the innovations used
  double nis_lower = 0.0, nis_upper = 0.0;
  std::size_t innovations = 0;  ///< used
  std::size_t gated = 0;        ///< left out
  /// By which the true standard deviation of an innovation exceeds the stated one: √nis where no
  /// gate has cut it off. Absent where even the gate leaves it open.
  std::optional<double> std_factor;
  /// Share of all innovations, the gated too, with |ν| ≤ 1.96; absent where only sums came.
  std::optional<double> inside_95;
  /// ⟨ν[k] ν[k+1]⟩ / ⟨ν²⟩ over neighbours; absent without any.
  std::optional<double> lag_one;
  double lag_one_bound = 0.0;  ///< of |lag_one| in 95 % of runs of white innovations
  std::vector<StretchScatter> stretches;
  Verdict verdict = Verdict::undetermined;
  Remedy remedy = Remedy::none;
  double remedy_factor = 1.0;
};

/// Normalised innovations squared of the filter, mean per channel, with the bounds between which
/// it lies in 95 % of runs of a filter whose noise figures are true; and what follows.
struct Consistency {
  double nis = 0.0, nis_lower = 0.0, nis_upper = 0.0;
  std::size_t innovations = 0;  ///< accepted, of channels that were there
  std::size_t gated = 0;
  std::optional<double> nis_ungated{};      ///< what it would be without the gate's cutting
  Verdict verdict = Verdict::undetermined;  ///< the gravest of any channel and of all together
  Remedy remedy = Remedy::none;
  double remedy_factor = 1.0;
  std::optional<std::size_t> worst_channel{};  ///< whose verdict it is; absent: of all together
  ChannelConsistency all{};                    ///< the channels taken together
  std::vector<ChannelConsistency> channels{};
  /// Of each channel, where its series was kept: tests at the sample and at 1, 10, 100 … s.
  std::vector<std::vector<signal::WhitenessTest>> whiteness{};
  /// Mean squares of the smoother's residuals, 1 expected: see smoother_consistency.hpp. Absent
  /// where there was no smoother.
  std::optional<Uncertain> smoothed_readings{}, smoothed_motion{};
};

/// Sums over one channel's normalised innovations: memory of fixed size, some tens of ns a value.
class InnovationTally {
 public:
  /// `used` is false for an innovation that the gate left out.
  void add(double innovation, double variance, bool used = true);
  /// The channel has no reading at this instant: its neighbours are none.
  void miss() { has_last_ = false; }

  /// Another channel's sums beside its own.
  void join(const InnovationTally& other);
  /// Of so many degrees of freedom that came without their innovations.
  void add_nis(double nis, std::size_t degrees);

  /// Figures and verdict; `judged` channels share the level of 5 %.
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
    double squares = 0.0;  ///< of the sums over stretches
  };
  static constexpr std::size_t levels = 32;
  std::size_t used_ = 0, gated_ = 0, inside_ = 0, pairs_ = 0;
  std::size_t unsigned_ = 0;  ///< of used_, degrees of freedom without an innovation
  double squares_ = 0.0, unsigned_squares_ = 0.0, products_ = 0.0, last_ = 0.0;
  bool has_last_ = false;
  std::array<Level, levels> levels_{};
};

/// Judges a filter while it runs. add() allocates nothing.
class ConsistencyCheck {
 public:
  explicit ConsistencyCheck(ConsistencyOptions options);

  /// The innovation y of one channel at one instant and its variance S = h P hᵀ + R as the filter
  /// states them. What is not finite counts as missing.
  void add(std::size_t channel, double innovation, double variance, bool used = true);
  void miss(std::size_t channel);
  /// For a filter that keeps only yᵀ S⁻¹ y over `degrees` channels: counts in the mean alone.
  void add_nis(double nis, std::size_t degrees);

  [[nodiscard]] Consistency judge() const;

 private:
  ConsistencyOptions options_;
  std::vector<InnovationTally> channels_;
  InnovationTally instants_;
};

/// One channel's innovations over a whole recording; NaN where there is no reading.
struct InnovationSeries {
  View<double> innovation, variance;
  View<unsigned char> used = {};  ///< empty: all
};

/// The same from series, with the tests of signal/whiteness beside it.
[[nodiscard]] Consistency check_consistency(const std::vector<InnovationSeries>& channels,
                                            const ConsistencyOptions& options);

}  // namespace proofmass::estimate

#include "proofmass/estimate/track/fixes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t fewest_fixes = 3;
constexpr double clear = 8.0;  // difference of log densities

/// Log density of the fixes, each given the measurements before it. A single wrong one weighs as
/// much as one of ten standard deviations.
double log_density_of_fixes(const AlongAxis& along) {
  constexpr double most_nis = 100.0;
  const auto knots = join_epochs(along.run.made.epochs, along.run.made.knots);
  const InertialAxis model{knots, along.run.noise};
  FilterState<3> state = inertial_start(along.run.start);
  double sum = 0.0;
  filter(model, {0, model.size()}, Gate{}, state,
         [&](std::size_t k, const StepOf<InertialAxis>& step) {
           if (std::isnan(knots[k].position_m)) return;
           const auto& fix = step.updates[static_cast<std::size_t>(step.count - 1)];
           sum -= 0.5 * (std::min(fix.nis(), most_nis) + std::log(fix.expected));
         });
  return sum;
}

class FixComparison {
 public:
  FixComparison(TrackSignal& signal, TrackOptions& options, AlongAxis& solved)
      : signal_(signal),
        options_(options),
        solved_(solved),
        log_density_(log_density_of_fixes(solved)) {}

  /// Removes rests, one after the other or all, and returns how many.
  std::size_t drop_rests() {
    constexpr std::size_t most = 16;
    const std::size_t before = signal_.stops.rests.size();
    if (before > most) return 0;
    while (drop_a_rest()) continue;
    return before - signal_.stops.rests.size();
  }

  /// Subtracts the delay of the fixes, if it is clear. Its uncertainty is added to theirs.
  std::optional<Uncertain> remove_delay() {
    constexpr double clear_delay = 5.0;
    const auto found = most_likely_delay();
    if (!found) return std::nullopt;
    TrackOptions moved = delayed(found->value);
    if (log_density(signal_, moved) < log_density_ + clear_delay) return std::nullopt;
    const auto there = solve(signal_, moved);
    if (!there) return std::nullopt;
    for (PositionFix& fix : moved.fixes)
      fix.std_m = std::hypot(fix.std_m,
                             found->std * state_at(*there, fix).mean(inertial_axis::velocity_mps));
    take(std::move(moved));
    return found;
  }

  /// Removes the fixes that are wrong, a quarter of them at most, and returns them.
  std::vector<PositionFix> drop_wrong() {
    constexpr std::size_t most_fixes = 100;  // each is left out once
    std::vector<PositionFix> wrong;
    if (options_.fixes.size() > most_fixes) return wrong;
    const std::size_t most = options_.fixes.size() / 4;
    while (wrong.size() < most) {
      const std::vector<PositionFix> fixes = drop_the_worst(most - wrong.size());
      if (fixes.empty()) break;
      wrong.insert(wrong.end(), fixes.begin(), fixes.end());
    }
    return wrong;
  }

  /// Uses these fixes instead. Returns whether they have a solution.
  bool use(std::vector<PositionFix> fixes) {
    TrackOptions options = options_;
    options.fixes = std::move(fixes);
    return take(std::move(options));
  }

 private:
  bool drop_a_rest() {
    const std::vector<signal::Rest>& all = signal_.stops.rests;
    TrackSignal trial = signal_;
    double best = log_density_ + clear;
    std::optional<std::vector<signal::Rest>> kept;
    for (std::size_t i = 0; i <= all.size() && !all.empty(); ++i) {
      trial.stops.rests = all;
      if (i < all.size())
        trial.stops.rests.erase(trial.stops.rests.begin() + static_cast<std::ptrdiff_t>(i));
      else
        trial.stops.rests.clear();
      const double value = log_density(trial, options_);
      if (!(value >= best)) continue;
      best = value;
      kept = trial.stops.rests;
    }
    if (!kept) return false;
    signal_.stops.rests = *std::move(kept);
    take(options_);
    return true;
  }

  /// Fixes [first, end).
  struct FixRange {
    std::size_t first = 0, end = 0;
  };

  /// Those that may be wrong together: each alone, and the repetitions of one position, as of a
  /// tracker that is stuck.
  [[nodiscard]] std::vector<FixRange> suspects(std::size_t most) const {
    const std::vector<PositionFix>& all = options_.fixes;
    std::vector<FixRange> out;
    for (std::size_t i = 0; i < all.size(); ++i) {
      out.push_back({i, i + 1});
      std::size_t end = i + 1;
      while (end < all.size() && all[end].position_m == all[i].position_m) ++end;
      const bool begins = i == 0 || all[i - 1].position_m != all[i].position_m;
      if (begins && end > i + 2 && end - i - 1 <= most) out.push_back({i + 1, end});
    }
    return out;
  }

  /// Removes the fix, or the repetitions of one, without which the others have the highest density,
  /// if that is higher than with them and one of them is far from the position without them.
  /// Returns those removed, `most` or fewer.
  std::vector<PositionFix> drop_the_worst(std::size_t most) {
    constexpr double far = 6.0, higher = 2.0;
    double best = -std::numeric_limits<double>::infinity();
    FixRange worst;
    for (const FixRange& range : suspects(most)) {
      const double value = log_density(signal_, without_fixes(range));
      if (!(value > best)) continue;
      best = value;
      worst = range;
    }
    std::vector<PositionFix> fixes(
        options_.fixes.begin() + static_cast<std::ptrdiff_t>(worst.first),
        options_.fixes.begin() + static_cast<std::ptrdiff_t>(worst.end));
    const auto without = solve(signal_, without_fixes(worst));
    const auto is_far = [&](const PositionFix& fix) { return deviation(*without, fix) >= far; };
    if (!without || best < log_density_ + higher || std::ranges::none_of(fixes, is_far)) return {};
    take(without_fixes(worst));
    return fixes;
  }

  [[nodiscard]] TrackOptions without_fixes(const FixRange& range) const {
    TrackOptions without = options_;
    without.fixes.erase(without.fixes.begin() + static_cast<std::ptrdiff_t>(range.first),
                        without.fixes.begin() + static_cast<std::ptrdiff_t>(range.end));
    return without;
  }

  [[nodiscard]] TrackOptions delayed(double delay_s) const {
    TrackOptions moved = options_;
    for (PositionFix& fix : moved.fixes) fix.time_s -= delay_s;
    return moved;
  }

  bool take(TrackOptions options) {
    auto solved = solve(signal_, options);
    if (!solved) return false;
    options_ = std::move(options);
    solved_ = std::move(solved).value();
    log_density_ = log_density_of_fixes(solved_);
    return true;
  }

  [[nodiscard]] double log_density(const TrackSignal& signal, TrackOptions options) const {
    options.axis = solved_.axis.direction;
    const auto one = solve_errors(signal, options);
    return one ? log_density_of_fixes(*one) : -std::numeric_limits<double>::infinity();
  }

  /// The most likely delay of a logarithmic grid over ± 1 s; 0 for none.
  [[nodiscard]] double rough_delay_s() const {
    constexpr std::array<double, 6> grid_s{0.01, 0.03, 0.1, 0.2, 0.5, 1.0};
    double best_s = 0.0, best = log_density_;
    for (const double size_s : grid_s)
      for (const double delay_s : {size_s, -size_s}) {
        const double value = log_density(signal_, delayed(delay_s));
        if (!(value > best)) continue;
        best = value;
        best_s = delay_s;
      }
    return best_s;
  }

  /// Refined by parabolas; the standard deviation is that of the last.
  [[nodiscard]] std::optional<Uncertain> most_likely_delay() const {
    double best_s = rough_delay_s(), step_s = 0.3 * std::abs(best_s), curvature = 0.0;
    if (best_s == 0.0) return std::nullopt;
    double best = log_density(signal_, delayed(best_s));
    constexpr int rounds = 6;
    for (int round = 0; round < rounds; ++round) {
      const double below = log_density(signal_, delayed(best_s - step_s)),
                   above = log_density(signal_, delayed(best_s + step_s));
      curvature = (2.0 * best - below - above) / square(step_s);
      const double move_s = 0.5 * (above - below) / (curvature * step_s);
      if (!(curvature > 0.0) || std::abs(move_s) > step_s) {
        best_s += above > below ? step_s : -step_s;
      } else {
        best_s += move_s;
        step_s = std::min(0.5 * step_s, 2.0 / std::sqrt(curvature));
      }
      best = log_density(signal_, delayed(best_s));
    }
    return Uncertain{best_s, curvature > 0.0 ? 1.0 / std::sqrt(curvature) : step_s};
  }

  /// Distance of a fix from a solution without it, in standard deviations of their difference.
  [[nodiscard]] double deviation(const AlongAxis& without, const PositionFix& fix) const {
    const Gaussian<3>& at = state_at(without, fix);
    const double after_s = fix.time_s - signal_.time_s[sample_at(signal_.time_s, fix.time_s)];
    const double position_m =
        at.mean(inertial_axis::position_m) + after_s * at.mean(inertial_axis::velocity_mps);
    return std::abs(fix.position_m - position_m) / std::sqrt(square(fix.std_m) + at.cov(0, 0));
  }

  [[nodiscard]] const Gaussian<3>& state_at(const AlongAxis& along, const PositionFix& fix) const {
    return along.pass.smoothed[along.run.made.of_sample[sample_at(signal_.time_s, fix.time_s)]];
  }

  TrackSignal& signal_;
  TrackOptions& options_;
  AlongAxis& solved_;
  double log_density_;
};

}  // namespace

FixReview review_fixes(TrackSignal& signal,
                       TrackOptions& options,
                       bool rests_in_doubt,
                       AlongAxis& solved) {
  FixReview review;
  if (options.fixes.size() < fewest_fixes) return review;
  std::vector<PositionFix> given = options.fixes;
  FixComparison fixes(signal, options, solved);
  if (rests_in_doubt) review.false_rests = fixes.drop_rests();
  review.delay_s = fixes.remove_delay();
  review.wrong = fixes.drop_wrong();
  if (review.wrong.empty()) return review;
  // A wrong fix may have looked like a delay of all.
  const double delay_s = review.delay_s ? review.delay_s->value : 0.0;
  std::erase_if(given, [&](const PositionFix& fix) {
    return std::ranges::any_of(review.wrong, [&](const PositionFix& wrong) {
      return wrong.time_s == fix.time_s - delay_s;
    });
  });
  if (review.delay_s && !fixes.use(std::move(given))) return review;
  review.delay_s = fixes.remove_delay();
  for (PositionFix& wrong : review.wrong) wrong.time_s += delay_s;
  if (rests_in_doubt) review.false_rests += fixes.drop_rests();
  return review;
}

}  // namespace proofmass::estimate

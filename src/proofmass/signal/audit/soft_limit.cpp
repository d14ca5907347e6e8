#include <algorithm>
#include <array>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/range_limit.hpp"
#include "proofmass/signal/audit/range_limit_crests.hpp"

namespace proofmass::signal {
namespace {

// Heights that are evaluated, relative to the highest crest above the median.
constexpr std::array<double, 8> heights{0.0, 0.15, 0.3, 0.45, 0.6, 0.7, 0.8, 0.9};
constexpr std::size_t at_half = 4, near_top = 6, at_top = 7;
// Minimum number of crossings for a slope estimate.
constexpr std::size_t fewest_crossings = 16;

/// Crossings of one height by the series.
struct Crossing {
  double level = 0.0;
  double square = 0.0;                 ///< mean square of the slope, noise removed
  double rising = 0.0, falling = 0.0;  ///< mean square of the slopes of either sign
  double count = 0.0;
  double above = 0.0;  ///< samples above the height
};

double mean_square(const std::vector<double>& slopes, bool rising) {
  Moments squares;
  for (const double slope : slopes)
    if ((slope > 0.0) == rising) squares.add(square(slope));
  return squares.mean;
}

Crossing crossing_at(View<double> series, double level, double noise) {
  const std::vector<double> slopes = slopes_at(series, level);
  Crossing out{.level = level};
  out.count = static_cast<double>(slopes.size());
  Moments squares;
  for (const double slope : slopes) squares.add(square(slope));
  out.square = squares.mean - 2.0 * square(noise / 3.0);
  out.rising = mean_square(slopes, true);
  out.falling = mean_square(slopes, false);
  out.above =
      static_cast<double>(std::ranges::count_if(series, [level](double x) { return x > level; }));
  return out;
}

/// White noise of the series, from its second differences; from the lower half of them if others
/// are larger.
double noise_of(View<double> series) {
  std::vector<double> squares;
  for (std::size_t k = 2; k < series.size(); ++k)
    if (const double bend = series[k] - 2.0 * series[k - 1] + series[k - 2]; std::isfinite(bend))
      squares.push_back(square(bend));
  constexpr double variance_of_bend = 6.0, median_of_square = 0.455;  // χ² of one degree
  const double by_mean = moments(squares).mean,
               by_half = median_or_zero(squares) / median_of_square;
  return std::sqrt(std::min(by_mean, by_half) / variance_of_bend);
}

using Profile = std::array<Crossing, heights.size()>;

/// The mean square of the slope at each height, relative to that of one oscillation; the largest of
/// the lower heights is 1.
std::array<double, heights.size()> steepness_of(const Profile& profile) {
  std::array<double, heights.size()> out{};
  for (std::size_t k = 0; k < heights.size(); ++k)
    out[k] = profile[k].square / (1.0 - square(heights[k]));
  const double most = *std::max_element(out.begin(), out.begin() + at_half + 1);
  for (double& one : out) one = most > 0.0 ? one / most : 0.0;
  return out;
}

/// Height of a parabola with the slopes at this height and the width of the excursions, relative to
/// the crests: 1 for an oscillation, more for flat crests.
double fullness(const Crossing& at, double left) {
  const double duration = at.above / (0.5 * at.count);
  return duration * std::sqrt(std::max(0.0, at.square)) / (4.0 * left);
}

bool are_crests_bent(const Profile& profile, double height, double noise) {
  const Crossing &half = profile[at_half], &top = profile[at_top], &near = profile[near_top];
  const auto is_known = [](const Crossing& one) { return one.count >= double{fewest_crossings}; };
  if (!std::ranges::all_of(profile, is_known)) return false;
  // Many of the crests reach this height; more crossings are due to noise about a level.
  if (top.count < 0.25 * half.count || top.count > 1.3 * half.count) return false;
  if (top.square < square(2.0 * noise / 3.0)) return false;
  const auto steepness = steepness_of(profile);
  const bool is_bent = steepness[at_top] < 0.5 && steepness[near_top] < 0.75 &&
                       steepness[at_half] > steepness[near_top] &&
                       steepness[near_top] > steepness[at_top];
  // A held level is flatter than any compressed crest.
  const auto is_crest = [](double full) { return full > 1.0 && full < 4.0; };
  return is_bent && is_crest(fullness(half, height * (1.0 - heights[at_half]))) &&
         is_crest(fullness(near, height * (1.0 - heights[near_top]))) &&
         near.rising > 0.5 * near.falling && near.rising < 2.0 * near.falling;
}

}  // namespace

std::optional<RangeLimit> find_soft_limit(View<double> series, const Extent& extent) {
  constexpr double outermost = 8.0;    // number of values that may be outliers
  constexpr double most_noise = 0.02;  // of the height
  const double middle = extent.median;
  const double noise = noise_of(series);
  if (noise > most_noise * (extent.high - middle)) return std::nullopt;
  const double share =
      1.0 - outermost / static_cast<double>(std::max<std::size_t>(series.size(), 9));
  const double height = quantile(series, share).value_or(middle) - middle;
  if (!(height > 0.0) || noise > most_noise * height) return std::nullopt;
  Profile profile;
  for (std::size_t k = 0; k < heights.size(); ++k)
    profile[k] = crossing_at(series, middle + heights[k] * height, noise);
  if (!are_crests_bent(profile, height, noise)) return std::nullopt;
  const auto steepness = steepness_of(profile);
  std::size_t bent = at_half;
  while (steepness[bent] > 0.6) ++bent;
  const Crossing& half = profile[at_half];
  const double by_noise = noise / std::sqrt(half.square) / (half.above / (0.5 * half.count));
  const bool alike =
      spread_of_durations(excursions_above(series, half.level)) < std::max(0.01, 3.0 * by_noise);
  return RangeLimit{alike ? RangeLimit::Kind::flat : RangeLimit::Kind::soft, profile[bent].level,
                    static_cast<std::size_t>(profile[bent].above)};
}

}  // namespace proofmass::signal

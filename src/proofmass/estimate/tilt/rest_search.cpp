#include "proofmass/estimate/tilt/rest_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/rest.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t fewest_to_fit = 16;

// Legendre's polynomials up to the fourth, which are orthogonal on [−1, 1].
Mat<5> legendre(double t) {
  const double s = t * t;
  return (Mat<5>() << 1.0, t, 1.5 * s - 0.5, (2.5 * s - 1.5) * t, (4.375 * s - 3.75) * s + 0.375)
      .finished();
}

// Mean square residual of one axis about a fourth-degree polynomial, over an interval extended by
// half its length at either end.
double left_of_polynomial(View<double> axis, const signal::Rest& rest) {
  const std::size_t half = (rest.last - rest.first + 1) / 2;
  const std::size_t from = rest.first - std::min(rest.first, half),
                    to = std::min(rest.last + half, axis.size() - 1);
  const auto at = [&](std::size_t k) {
    return legendre(2.0 * static_cast<double>(k - from) / static_cast<double>(to - from) - 1.0);
  };
  Mat<5, 5> normal = Mat<5, 5>::Zero();
  Mat<5> sums = Mat<5>::Zero();
  std::optional<double> offset;  // subtracted to keep the squares precise
  double count = 0.0, squares = 0.0;
  for (std::size_t k = from; k <= to; ++k)
    if (std::isfinite(axis[k])) {
      if (!offset) offset = axis[k];
      const double value = axis[k] - *offset;
      const Mat<5> shape = at(k);
      normal += shape * shape.transpose();
      sums += value * shape;
      squares += value * value;
      count += 1.0;
    }
  if (count < static_cast<double>(fewest_to_fit)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, squares - sums.dot(positive_inverse(normal) * sums)) / count;
}

// Drift of the level of a sensor at rest: 2 mg, that of a poor MEMS accelerometer over minutes.
// `sure`: additional standard deviations of a block's mean.
constexpr double bias_change_mps2 = 2e-3 * standard_gravity_mps2, sure = 4.0;

// The level of one axis over a rest, block by block; NaN for a block without measurements.
struct BlockLevels {
  std::vector<double> means;
  double room = 0.0;  // allowed departure of a block from the mean of the previous ones
  double sum = 0.0, count = 0.0;

  void begin() { sum = count = 0.0; }
  [[nodiscard]] bool stands(std::size_t b) const {
    return count == 0.0 || !std::isfinite(means[b]) || std::abs(means[b] - sum / count) <= room;
  }
  void take(std::size_t b) {
    if (!std::isfinite(means[b])) return;
    sum += means[b];
    count += 1.0;
  }
};

// Noise of a block's mean from second differences, which eliminate a steady change, or that of
// white measurements if larger. The means of a sensor whose filter or flicker correlates its noise
// scatter by more than white ones, but if it is much more they are those of a swing.
double noise_of_means(const std::vector<double>& means, double white) {
  constexpr double most_of_white = 1.5, most_of_a_sensor_mps2 = 5e-3 * standard_gravity_mps2;
  std::vector<double> bends;
  for (std::size_t b = 2; b < means.size(); ++b)
    bends.push_back((means[b] - 2.0 * means[b - 1] + means[b - 2]) / std::sqrt(6.0));
  return std::clamp(robust_std(bends).value_or(0.0), white,
                    std::max(most_of_white * white, most_of_a_sensor_mps2));
}

std::vector<double> block_means(View<double> axis, const signal::Rest& rest, std::size_t block) {
  std::vector<double> out;
  for (std::size_t k = rest.first; k + block <= rest.last + 1; k += block) {
    const Moments here = moments(axis.subspan(k, block));
    out.push_back(here.count > 0 ? here.mean : no_value);
  }
  return out;
}

BlockLevels levels_of(
    View<double> axis, const signal::Rest& rest, std::size_t block, double noise, double step) {
  BlockLevels out{.means = block_means(axis, rest, block)};
  const double white = noise / std::sqrt(static_cast<double>(block));
  out.room = sure * noise_of_means(out.means, white) + bias_change_mps2 + step;
  return out;
}

// The parts of a rest with constant levels. A block is lost at either side of a cut.
void add_standing(const signal::Rest& rest,
                  std::size_t block,
                  std::size_t shortest,
                  std::vector<BlockLevels>& axes,
                  std::vector<signal::Rest>& out) {
  const std::size_t blocks = axes.front().means.size();
  std::size_t first = rest.first;
  // The level changes without an edge: what is short beside it may be slow motion, too.
  const auto add = [&](std::size_t last) {
    const bool is_whole = first == rest.first && last == rest.last;
    if (last + 1 >= first + shortest * (is_whole ? 1 : 4)) out.push_back({first, last});
  };
  for (std::size_t b = 0; b < blocks; ++b) {
    if (std::ranges::all_of(axes, [b](const BlockLevels& axis) { return axis.stands(b); })) {
      for (BlockLevels& axis : axes) axis.take(b);
      continue;
    }
    const std::size_t cut = rest.first + b * block;
    if (cut >= first + block) add(cut - block - 1);
    first = cut + block;
    for (BlockLevels& axis : axes) axis.begin();
  }
  add(rest.last);
}

// True if the level of a rest of this duration changes by more than a sensor's drift in that time,
// and clearly by more than noise: a slow motion or acceleration.
bool creeps(View<double> axis,
            const signal::Rest& rest,
            std::size_t block,
            double noise,
            double duration_s) {
  constexpr double sure = 6.0, drift_time_s = 60.0;
  const std::vector<double> means = block_means(axis, rest, block);
  const Moments all = moments(means);
  if (all.count < 3) return false;
  const double white = noise / std::sqrt(static_cast<double>(block));
  const double by_noise = square(noise_of_means(means, white));
  const auto count = static_cast<double>(all.count);
  const double drift = bias_change_mps2 * std::sqrt(std::min(1.0, duration_s / drift_time_s));
  return all.squares > (count + sure * std::sqrt(2.0 * count)) * by_noise &&
         square(all.std()) - by_noise > square(drift);
}

double usual_rate_hz(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < time_s.size(); ++k) steps.push_back(time_s[k] - time_s[k - 1]);
  const double step = median(steps).value_or(0.0);
  return step > 0.0 ? 1.0 / step : 0.0;
}

// The shortest rest, in samples.
std::size_t shortest_rest(const TiltOptions& options, double rate_hz) {
  constexpr double usual_s = 0.5;
  return std::max<std::size_t>(
      2, static_cast<std::size_t>(options.shortest_rest_s.value_or(usual_s) * rate_hz));
}

// The same on any axis.
bool level_creeps(const TiltRecord& record,
                  const signal::RestSearch& found,
                  const signal::Rest& rest,
                  std::size_t block) {
  const double duration_s =
      static_cast<double>(rest.last - rest.first + 1) / usual_rate_hz(record.time_s);
  std::size_t row = 0;
  return std::ranges::any_of(record.accel_mps2, [&](const std::vector<double>& axis) {
    return !axis.empty() && creeps(axis, rest, block, found.noise_std[row++], duration_s);
  });
}

// The rate of one axis over a rest.
struct RestRate {
  double median = 0.0, std = 0.0;  // of one measurement

  RestRate(const std::vector<double>& rate, const signal::Rest& rest) {
    std::vector<double> values;
    for (std::size_t k = rest.first; k <= rest.last; ++k)
      if (std::isfinite(rate[k])) values.push_back(rate[k]);
    median = proofmass::median(values).value_or(0.0);
    std = robust_std(values).value_or(0.0);
    if (std == 0.0) std = moments(values).std();  // most have one code of a converter
  }
  // Whether the mean rate of these samples departs from the median by more than noise and the drift
  // of a bias.
  [[nodiscard]] bool turns(View<double> rate) const {
    constexpr double clear = 6.0, drift_radps = 2e-3;
    Moments part;
    for (const double one : rate)
      if (std::isfinite(one)) part.add(one);
    return part.count > 0 &&
           std::abs(part.mean - median) >
               drift_radps + clear * std / std::sqrt(static_cast<double>(part.count));
  }
};

// Whether the base turns in each block of a rest.
std::vector<bool> turning_blocks(const TiltRecord& record,
                                 const signal::Rest& rest,
                                 std::size_t block) {
  std::vector<bool> turning((rest.last - rest.first) / block + 1, false);
  for (const std::vector<double>& axis : record.rate_radps) {
    const RestRate rate(axis, rest);
    for (std::size_t b = 0; b < turning.size(); ++b) {
      const std::size_t first = rest.first + b * block;
      const std::size_t count = std::min(block, rest.last + 1 - first);
      turning[b] = turning[b] || rate.turns(View<double>(axis).subspan(first, count));
    }
  }
  return turning;
}

}  // namespace

signal::RestSearch rests_of(const TiltRecord& record, const TiltOptions& options) {
  std::vector<View<double>> axes;
  std::vector<double> steps;
  const auto converter = converter_steps(record);
  for (std::size_t i = 0; i < 3; ++i) {
    if (record.accel_mps2[i].empty()) continue;
    axes.emplace_back(record.accel_mps2[i]);
    steps.push_back(converter ? (*converter)[i] : 0.0);
  }
  signal::RestSearch found = signal::find_rests(
      axes, {.rate_hz = usual_rate_hz(record.time_s), .shortest_s = options.shortest_rest_s});
  const std::size_t block = std::max<std::size_t>(1, found.window / 2);
  std::vector<signal::Rest> standing;
  for (const signal::Rest& rest : found.rests) {
    std::vector<BlockLevels> levels;
    for (std::size_t i = 0; i < axes.size(); ++i)
      levels.push_back(levels_of(axes[i], rest, block, found.noise_std[i], steps[i]));
    std::vector<signal::Rest> parts;
    add_standing(rest, block, found.window, levels, parts);
    // A slow motion is cut into parts in which the level moves on.
    if (parts.size() > 1)
      std::erase_if(parts, [&](const signal::Rest& part) {
        return level_creeps(record, found, part, block);
      });
    standing.insert(standing.end(), parts.begin(), parts.end());
  }
  if (!found.rests.empty() && standing.empty())
    found.why_none = "wherever it is quiet the level changes";
  found.rests = std::move(standing);
  return found;
}

void drop_slow_motion(const TiltRecord& record, signal::RestSearch& found) {
  constexpr double edge = 1.5;  // times the noise
  const std::size_t block = std::max<std::size_t>(1, found.window / 2);
  std::erase_if(found.rests, [&](const signal::Rest& rest) {
    if (level_creeps(record, found, rest, block)) return true;
    std::size_t row = 0;
    return std::ranges::all_of(record.accel_mps2, [&](const std::vector<double>& axis) {
      return axis.empty() ||
             left_of_polynomial(axis, rest) <= square(edge * found.noise_std[row++]);
    });
  });
}

void leave_out_rotations(const TiltRecord& record,
                         const TiltOptions& options,
                         signal::RestSearch& found) {
  constexpr double block_s = 0.1;
  const double rate_hz = usual_rate_hz(record.time_s);
  const auto block = static_cast<std::size_t>(std::max(1.0, std::round(block_s * rate_hz)));
  const std::size_t shortest = shortest_rest(options, rate_hz);
  std::vector<signal::Rest> kept;
  for (const signal::Rest& rest : found.rests) {
    const std::vector<bool> turning = turning_blocks(record, rest, block);
    std::size_t first = rest.first;
    const auto keep_until = [&](std::size_t end) {
      if (end > first && end - first >= shortest) kept.push_back({first, end - 1});
    };
    for (std::size_t b = 0; b < turning.size(); ++b) {
      if (!turning[b]) continue;
      keep_until(rest.first + b * block);
      first = rest.first + (b + 1) * block;
    }
    keep_until(rest.last + 1);
  }
  found.rests = std::move(kept);
}

void leave_out_hidden_onsets(const TiltRecord& record,
                             const TiltOptions& options,
                             signal::RestSearch& found) {
  constexpr double hidden_s = 0.4;
  const double rate_hz = usual_rate_hz(record.time_s);
  const auto hidden = static_cast<std::size_t>(hidden_s * rate_hz);
  const std::size_t shortest = shortest_rest(options, rate_hz);
  std::erase_if(found.rests, [&](signal::Rest& rest) {
    const bool begins = rest.first == 0, ends = rest.last + 1 == record.time_s.size();
    const std::size_t most = std::min(hidden, (rest.last - rest.first + 1) / 4);
    if (!begins) rest.first += most;
    if (!ends) rest.last -= most;
    return !begins && !ends && rest.last - rest.first + 1 < shortest;
  });
}

}  // namespace proofmass::estimate

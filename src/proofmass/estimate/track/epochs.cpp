#include "proofmass/estimate/track/epochs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

struct BlockMeans {
  std::vector<double> means;
  double within = 0.0;  // sum of squares about the means
  std::size_t samples = 0, blocks = 0;
};

void add_blocks(View<double> accel, const signal::Rest& rest, std::size_t block, BlockMeans& out) {
  out.means.clear();
  for (std::size_t first = rest.first; first + block <= rest.last + 1; first += block) {
    double sum = 0.0;
    std::size_t n = 0;
    for (std::size_t k = first; k < first + block; ++k)
      if (!std::isnan(accel[k])) sum += accel[k], ++n;
    if (2 * n < block || n == 0) continue;
    const double mean = sum / static_cast<double>(n);
    out.means.push_back(mean);
    ++out.blocks;
    out.samples += n;
    for (std::size_t k = first; k < first + block; ++k)
      if (!std::isnan(accel[k])) out.within += (accel[k] - mean) * (accel[k] - mean);
  }
}

struct AllanSum {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double difference) {
    sum += 0.5 * difference * difference;
    ++count;
  }
  [[nodiscard]] double variance() const { return sum / static_cast<double>(count); }
};

void add_differences(const std::vector<double>& means, std::size_t m, AllanSum& sum) {
  for (std::size_t i = 0; i + 2 * m <= means.size(); ++i) {
    double difference = 0.0;
    for (std::size_t j = 0; j < m; ++j) difference += means[i + m + j] - means[i + j];
    sum.add(difference / static_cast<double>(m));
  }
}

constexpr double block_length_s = 0.5;

// Smallest nonzero difference between measurements; 0 if there is none.
double smallest_step(View<double> accel) {
  double step = 0.0;
  for (std::size_t k = 1; k < accel.size(); ++k) {
    const double difference = std::abs(accel[k] - accel[k - 1]);
    if (difference > 0.0 && (step == 0.0 || difference < step)) step = difference;
  }
  return step;
}

}  // namespace

LevelNoise level_noise(View<double> accel, const std::vector<signal::Rest>& rests, double rate_hz) {
  LevelNoise noise;
  noise.block =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(block_length_s * rate_hz)));
  noise.block_s = static_cast<double>(noise.block) / rate_hz;
  BlockMeans blocks;
  AllanSum one, four;
  for (const signal::Rest& rest : rests) {
    add_blocks(accel, rest, noise.block, blocks);
    add_differences(blocks.means, 1, one);
    add_differences(blocks.means, 4, four);
  }
  const double freedom = static_cast<double>(blocks.samples - blocks.blocks);
  if (freedom > 0.0) noise.sample_std_mps2 = std::sqrt(blocks.within / freedom);
  const double white = noise.sample_std_mps2 * noise.sample_std_mps2 /
                       static_cast<double>(std::max<std::size_t>(noise.block, 1));
  if (!(noise.sample_std_mps2 > 0.0)) {
    // The error of constant measurements at rest is their step, however many there are.
    const double step = smallest_step(accel);
    noise.variance_m2ps4 = std::max(step * step / 12.0, 1e-18);
    return noise;
  }
  // With fewer differences, the scatter of the samples is used.
  constexpr std::size_t enough = 8;
  const double n = static_cast<double>(std::min(one.count, enough)) / enough;
  noise.variance_m2ps4 =
      std::max(white, one.count > 0 ? n * one.variance() + (1.0 - n) * white : 2.0 * white);
  if (four.count >= enough)
    noise.walk_m2ps5 = 3.0 * std::max(0.0, four.variance() - one.variance() / 4.0) /
                       (noise.block_s * (4.0 - 0.25));
  return noise;
}

namespace {

class EpochBuilder {
 public:
  EpochBuilder(const AxisSignal& signal, const TrackReadings& readings, const LevelNoise& noise)
      : signal_(signal), readings_(readings), noise_(noise) {
    out_.of_sample.resize(signal.time_s.size());
  }

  AxisEpochs build() && {
    std::size_t next = 0;
    for (const signal::Rest& rest : readings_.rests) {
      for (; next < rest.first; ++next) move_to(next);
      rest_over(rest);
      next = rest.last + 1;
    }
    for (; next < signal_.time_s.size(); ++next) move_to(next);
    if (!out_.epochs.empty()) knot();
    return std::move(out_);
  }

 private:
  void knot() {
    const std::size_t last = out_.epochs.size() - 1;
    if (out_.knots.empty() || out_.knots.back() != last) out_.knots.push_back(last);
  }

  // In a longer gap the measurements at its ends fade within this time, and the unknown
  // acceleration is white: a constant one would be determined by the next stop, together with the
  // displacement.
  static constexpr double longest_constant_s = 1.0;

  // By trapezoids: the acceleration is linear between measurements. Samples without one are
  // skipped, unless `must`: another quantity is measured there.
  void move_to(std::size_t k, bool must = false) {
    const bool known = !std::isnan(signal_.accel_mps2[k]);
    const bool end = k == 0 || k + 1 == signal_.time_s.size();
    if (!known && !must && !end && !reading_due(k)) {
      ++skipped_;
      return;
    }
    InertialEpoch epoch;
    epoch.leaves_rest = !out_.epochs.empty() && out_.epochs.back().resting;
    const double h = k > 0 ? signal_.time_s[k] - signal_.time_s[k - 1 - skipped_] : 0.0;
    const bool lasts = h < longest_constant_s;
    const double a1 = known ? signal_.accel_mps2[k] : lasts ? last_accel_.value_or(0.0) : 0.0;
    if (k > 0) {
      const double a0 = last_accel_.value_or(a1);
      const double T = std::min(h, longest_constant_s);
      epoch.dt_s = h;
      epoch.velocity_step_mps = 0.5 * T * (a0 + a1);
      epoch.position_step_m = T * T * (a0 / 3.0 + a1 / 6.0) + 0.5 * T * a0 * (h - T);
      if (skipped_ > 0 && known && lasts) bend(k, h, epoch);
      if (skipped_ > 0 || !known || h > signal_.longest_step_s) {
        epoch.unknown_accel_m2ps3 = square(signal_.missing_std_mps2) * T;
        knot();
      }
    }
    if (known || !lasts) last_accel_ = a1;
    const std::size_t skipped = skipped_;
    skipped_ = 0;
    push(k, epoch);
    for (std::size_t i = k - skipped; i < k; ++i) out_.of_sample[i] = out_.epochs.size() - 1;
    if (skipped > 0)
      out_.gaps.push_back({k - skipped, k - 1, std::sqrt(epoch.unknown_accel_m2ps3 / epoch.dt_s)});
    if (epoch.unknown_accel_m2ps3 > 0.0) knot();
  }

  // Adds what a cubic with the slopes on both sides of a gap, which ends at k, encloses beyond the
  // straight line: at the limit of a range it is all on one side. Not if that is more than the
  // measurements at the ends: such a gap is longer than the motion is smooth.
  void bend(std::size_t k, double step_s, InertialEpoch& epoch) const {
    const std::size_t most = std::max<std::size_t>(3, skipped_ / 2), last = k - 1 - skipped_;
    if (last + 1 < most || k + most > signal_.time_s.size()) return;
    const double before = slope(last + 1 - most, most), after = slope(k, most);
    const double excess = step_s * (before - after) / 8.0;  // in the middle
    const double ends =
        std::min(std::abs(signal_.accel_mps2[last]), std::abs(signal_.accel_mps2[k]));
    if (!(std::abs(excess) < ends)) return;
    epoch.velocity_step_mps += square(step_s) * (before - after) / 12.0;
    epoch.position_step_m += step_s * square(step_s) * (before / 20.0 - after / 30.0);
  }

  // Regression slope of consecutive measurements, NaN if one is missing.
  [[nodiscard]] double slope(std::size_t first, std::size_t count) const {
    const View<double> t = signal_.time_s.subspan(first, count);
    const double middle = moments(t).mean;
    double ta = 0.0, tt = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      ta += (t[i] - middle) * signal_.accel_mps2[first + i];
      tt += square(t[i] - middle);
    }
    return ta / tt;
  }

  bool reading_due(std::size_t k) const {
    return (turn_ < readings_.turns.size() && readings_.turns[turn_] <= k) ||
           (fix_ < readings_.fixes.size() && readings_.fixes[fix_].sample <= k);
  }

  void push(std::size_t sample, const InertialEpoch& epoch) {
    out_.epochs.push_back(epoch);
    out_.of_sample[sample] = out_.epochs.size() - 1;
    read_at(sample);
  }

  void read_at(std::size_t sample) {
    InertialEpoch& epoch = out_.epochs.back();
    bool reads = false;
    if (turn_ < readings_.turns.size() && readings_.turns[turn_] <= sample) {
      // The turning point is within a sample of the stated time.
      const double slip_mps = std::abs(last_accel_.value_or(0.0)) * epoch.dt_s;
      epoch.velocity_std_mps = std::hypot(readings_.rest_speed_std_mps, slip_mps);
      while (turn_ < readings_.turns.size() && readings_.turns[turn_] <= sample) ++turn_;
      reads = true;
    }
    if (fix_ < readings_.fixes.size() && readings_.fixes[fix_].sample <= sample) {
      read_position(sample, readings_.fixes[fix_++], epoch);
      reads = true;
    }
    if (reads) knot();
  }

  void read_position(std::size_t sample, const TrackReadings::Fix& fix, InertialEpoch& epoch) {
    const double t = epoch.position_after_s =
        fix.after_s + signal_.time_s[fix.sample] - signal_.time_s[sample];
    const double moved_m = epoch.resting ? 0.0 : 0.5 * t * t * last_accel_.value_or(0.0);
    epoch.position_m = fix.position_m - moved_m;
    epoch.position_variance = fix.variance_m2;
    // Farther from a sample than usual: in a gap.
    if (std::abs(t) > signal_.longest_step_s)
      epoch.position_variance += square(0.5 * t * t * signal_.missing_std_mps2);
  }

  void rest_over(const signal::Rest& rest) {
    move_to(rest.first, true);
    out_.epochs.back().velocity_std_mps = readings_.rest_speed_std_mps;
    out_.epochs.back().arrives_at_rest = out_.epochs.size() > 1;
    knot();
    for (std::size_t first = rest.first; first < rest.last;) {
      // The remainder after the last whole block is added to it.
      std::size_t last = std::min(first + noise_.block, rest.last);
      if (rest.last - last < noise_.block) last = rest.last;
      push_block(first, last);
      first = last;
    }
    last_accel_.reset();
    if (!std::isnan(signal_.accel_mps2[rest.last])) last_accel_ = signal_.accel_mps2[rest.last];
  }

  // The block (first, last]; its first sample is the one before's last.
  void push_block(std::size_t first, std::size_t last) {
    InertialEpoch epoch;
    epoch.resting = true;
    epoch.dt_s = signal_.time_s[last] - signal_.time_s[first];
    double sum = 0.0;
    std::size_t n = 0;
    for (std::size_t k = first + 1; k <= last; ++k)
      if (!std::isnan(signal_.accel_mps2[k])) sum += signal_.accel_mps2[k], ++n;
    if (n > 0) {
      epoch.level_mps2 = sum / static_cast<double>(n);
      epoch.level_variance =
          noise_.variance_m2ps4 * static_cast<double>(noise_.block) / static_cast<double>(n);
    }
    push(last, epoch);
    knot();
    for (std::size_t k = first + 1; k < last; ++k) out_.of_sample[k] = out_.epochs.size() - 1;
  }

  const AxisSignal& signal_;
  const TrackReadings& readings_;
  const LevelNoise& noise_;
  AxisEpochs out_;
  std::optional<double> last_accel_;
  std::size_t skipped_ = 0;
  std::size_t fix_ = 0, turn_ = 0;
};

}  // namespace

AxisEpochs axis_epochs(const AxisSignal& signal,
                       const TrackReadings& readings,
                       const LevelNoise& noise) {
  return EpochBuilder(signal, readings, noise).build();
}

}  // namespace proofmass::estimate

#include "proofmass/estimate/wheel/encoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/gravity_fit.hpp"

namespace proofmass::estimate {
namespace {

constexpr double no_angle = std::numeric_limits<double>::quiet_NaN();

/// Weighted mean of fixes.
struct MeanFix {
  double weight = 0.0, time_s = 0.0, angle_rad = 0.0;

  void add(double at_s, double rad, double variance) {
    weight += 1.0 / variance;
    time_s += (at_s - time_s) / (variance * weight);
    angle_rad += (rad - angle_rad) / (variance * weight);
  }
  void append_to(EncoderReadings& out, double epoch_s) const {
    out.angle_rad.push_back(weight > 0.0 ? angle_rad : no_angle);
    out.age_s.push_back(epoch_s - time_s);
    out.variance_rad2.push_back(1.0 / weight);
  }
};

/// Direction and zero of the encoder, and gravity's amplitude.
struct Alignment {
  double direction = 1.0, zero_rad = 0.0, gravity_mps2 = 0.0;
};

/// With θ = d ψ − o: u = g sin θ, v = g cos θ.
Alignment alignment_of(const GravityFit& fit) {
  const double us = fit.figure(0).value, uc = fit.figure(1).value;
  const double vs = fit.figure(GravityFit::linear).value,
               vc = fit.figure(GravityFit::linear + 1).value;
  Alignment best;
  for (const double d : {1.0, -1.0}) {
    const double cosine = 0.5 * (vc + d * us), sine = 0.5 * (d * vs - uc);
    const double size = std::hypot(cosine, sine);
    if (size > best.gravity_mps2) best = {d, std::atan2(sine, cosine), size};
  }
  return best;
}

/// The direction in which the encoder's angle differs least from the path's, up to a constant;
/// nullopt if it differs by too much.
std::optional<Alignment> alignment_with(const WheelPath& path,
                                        const std::vector<EncoderMotion>& motion) {
  constexpr double largest_std_rad = 0.3;
  std::optional<Alignment> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double d : {1.0, -1.0}) {
    Moments off;
    for (std::size_t k = 0; k < motion.size(); ++k)
      off.add(d * motion[k](0) - path.moving[k](wheel::angle));
    if (!(off.std() < std::min(least, largest_std_rad))) continue;
    least = off.std();
    best = Alignment{d, off.mean, 0.0};
  }
  return best;
}

/// The encoder less gravity's direction after a fit, in sixteenths of a turn; NaN where the speed
/// changes by more than a tenth in a turn: there lever arm, hub and delay leave more than
/// elsewhere.
struct EncoderOffsets {
  std::vector<double> time_s, offset_rad;
};

EncoderOffsets offsets_of(const WheelReadings& readings,
                          const std::vector<EncoderMotion>& motion,
                          const GravityFit& fit) {
  constexpr double bin_rad = rad_per_turn / 16.0, largest_change = 0.1;
  EncoderOffsets out;
  double bin = no_angle, count = 0.0, time_s = 0.0, offset = 0.0, change = 0.0;
  const auto close = [&] {
    if (count > 0.0) {
      out.time_s.push_back(time_s / count);
      const bool even = std::abs(change) / count <= largest_change;
      out.offset_rad.push_back(even ? offset / count : no_angle);
    }
    count = time_s = offset = change = 0.0;
  };
  GravityFit::for_each_reading(readings, motion, [&](std::size_t k, const Mat<2>& reading) {
    if (const double own = std::floor(motion[k](0) / bin_rad); own != bin) {
      close();
      bin = own;
    }
    const auto [off, by_rotation, by_parameters] = fit.residual_of(reading, motion[k]);
    time_s += readings.time_s[k];
    offset -= off.dot(by_rotation) / by_rotation.squaredNorm();
    change += motion[k](2) * rad_per_turn / square(motion[k](1));
    count += 1.0;
  });
  close();
  // At the ends the encoder's parabolas are one-sided.
  constexpr std::size_t ends = 8;
  for (std::size_t i = 0; i < std::min(ends, out.offset_rad.size()); ++i)
    out.offset_rad[i] = out.offset_rad[out.offset_rad.size() - 1 - i] = no_angle;
  return out;
}

/// Leaves out blocks of four turns whose offsets scatter by three times as much as the median block
/// does, as at high speed: a step there is no sign of missed counts.
void keep_quiet(EncoderOffsets& offsets) {
  constexpr std::size_t block = 64;
  constexpr double loud = 3.0;
  std::vector<double> scatter;
  std::vector<double>& values = offsets.offset_rad;
  for (std::size_t first = 0; first < values.size(); first += block) {
    std::vector<double> steps;
    for (std::size_t i = first + 1; i < std::min(first + block, values.size()); ++i)
      if (!std::isnan(values[i]) && !std::isnan(values[i - 1]))
        steps.push_back(std::abs(values[i] - values[i - 1]));
    scatter.push_back(median(steps).value_or(no_angle));
  }
  const auto usual = median(scatter);
  for (std::size_t i = 0; i < values.size() && usual; ++i)
    if (!(scatter[i / block] <= loud * *usual)) values[i] = no_angle;
}

/// Bins beside a missed count in which the encoder's parabolas still see it.
constexpr std::ptrdiff_t smeared = 3;

std::ptrdiff_t bin_of(const EncoderOffsets& offsets, double time_s) {
  return std::ranges::lower_bound(offsets.time_s, time_s) - offsets.time_s.begin();
}

/// Further missed counts than those known, next to which the offsets are left out.
std::vector<signal::CountSlip> further_missed(EncoderOffsets offsets,
                                              const std::vector<signal::CountSlip>& known,
                                              double step_rad) {
  const auto size = static_cast<std::ptrdiff_t>(offsets.offset_rad.size());
  for (const signal::CountSlip& slip : known) {
    const std::ptrdiff_t at = bin_of(offsets, slip.time_s);
    for (auto i = std::max<std::ptrdiff_t>(at - smeared, 0); i < std::min(at + smeared, size); ++i)
      offsets.offset_rad[static_cast<std::size_t>(i)] = no_angle;
  }
  return signal::find_count_slips(offsets.time_s, offsets.offset_rad, step_rad);
}

/// Those within a few bins of each other become one, with the time of the largest.
void join_missed(const EncoderOffsets& offsets, std::vector<signal::CountSlip>& missed) {
  std::ranges::sort(missed, {}, &signal::CountSlip::time_s);
  std::vector<signal::CountSlip> joined;
  for (const signal::CountSlip& slip : missed) {
    if (joined.empty() ||
        bin_of(offsets, slip.time_s) - bin_of(offsets, joined.back().time_s) > smeared + 1) {
      joined.push_back(slip);
      continue;
    }
    const int counts = joined.back().counts + slip.counts;
    if (std::abs(slip.counts) > std::abs(joined.back().counts)) joined.back() = slip;
    joined.back().counts = counts;
  }
  std::erase_if(joined, [](const signal::CountSlip& slip) { return slip.counts == 0; });
  missed = std::move(joined);
}

/// Removes missed counts from an encoder's fixes. More steps than turns, or some whose removal does
/// not improve the fit, are not missed counts; then none is removed.
class MissedCounts {
 public:
  explicit MissedCounts(EncoderTrack& track)
      : track_(track),
        step_rad_(track.encoder.step_rad),
        as_recorded_(track.encoder.fixes),
        removes_(step_rad_ > 0.0) {}

  /// Looks for missed counts in the residuals of a fit. Returns whether those removed changed.
  bool update(const WheelReadings& readings,
              const std::vector<EncoderMotion>& motion,
              GravityFit& fit) {
    if (!with_all_) with_all_ = fit;
    if (!removes_) return false;
    const bool changed = look(offsets_of(readings, motion, fit));
    removes_ = static_cast<double>(track_.missed.size()) <= range_of(motion) / rad_per_turn;
    if (!removes_) {
      track_.missed.clear();
      fit = *with_all_;
    }
    track_.encoder.fixes = as_recorded_;
    signal::remove_slips(track_.missed, step_rad_, track_.encoder.fixes);
    return changed;
  }

  /// The better of the fit without the missed counts and the first one.
  GravityFit better(const GravityFit& fit) {
    if (track_.missed.empty() || fit.variance_m2ps4() < with_all_->variance_m2ps4()) return fit;
    track_.missed.clear();
    track_.encoder.fixes = as_recorded_;
    return *with_all_;
  }

 private:
  bool look(EncoderOffsets offsets) {
    std::vector<signal::CountSlip>& missed = track_.missed;
    keep_quiet(offsets);
    join_missed(offsets, missed);
    const bool relocated =
        signal::relocate_slips(offsets.time_s, offsets.offset_rad, step_rad_, missed);
    const auto found = further_missed(offsets, missed, step_rad_);
    missed.insert(missed.end(), found.begin(), found.end());
    join_missed(offsets, missed);
    return relocated || !found.empty();
  }

  EncoderTrack& track_;
  double step_rad_;
  signal::AngleFixes as_recorded_;
  bool removes_;
  std::optional<GravityFit> with_all_{};
};

/// Removes missed counts from out.encoder and fits it to gravity, until nothing changes.
GravityFit compare_with_gravity(const WheelReadings& readings, EncoderTrack& out) {
  // Parabolas of other fixes may move the fit forth and back by half a standard deviation for ever.
  constexpr int fewest_rounds = 3, enough_rounds = 8, most_rounds = 16;
  constexpr double small_move = 0.1;
  GravityFit fit(readings.delay_s, out.encoder.errors_rad.value_or(uncalibrated_errors_rad),
                 readings.one_speed, readings.gravity_mps2);
  MissedCounts missed(out);
  bool settled = false;
  int rounds_since_change = 0;
  for (int round = 1; round <= most_rounds; ++round) {
    const auto motion = motion_of(fit.corrected(out.encoder.fixes), readings.time_s,
                                  fit.figure(GravityFit::delay).value);
    fit.step(readings, motion);
    const bool has_converged = fit.last_move() < small_move;
    // Missed counts are looked for when the delay is known, which would resemble them.
    settled = settled || (round >= fewest_rounds && has_converged) || round >= enough_rounds;
    if (!settled) continue;
    rounds_since_change = missed.update(readings, motion, fit) ? 0 : rounds_since_change + 1;
    if (rounds_since_change >= fewest_rounds && has_converged) break;
  }
  return missed.better(fit);
}

/// Uncertainty of the delay from counts that repeat in step with the samples: at some speeds the
/// error of a fix is not white, but one of up to half of its standard deviation.
double beat_s(double step_rad, const std::vector<EncoderMotion>& motion) {
  Moments speed;
  for (const EncoderMotion& at : motion) speed.add(at(1));
  return 0.5 * step_rad / std::sqrt(12.0) / std::max(2.0 * speed.std(), 1e-9);
}

Error not_of_this_wheel(const WheelEncoder& encoder) {
  return {Errc::not_observable,
          encoder.name +
              ": gravity in the accelerometer does not rotate with the encoder's angle; the counts "
              "of a turn may be wrong, or the encoder is not on this wheel",
          {Advice{"counts-per-turn"}}};
}

void align(const WheelEncoder& encoder, const Alignment& to, WheelReadings& readings) {
  readings.encoder = encoder_readings(encoder, readings.time_s);
  readings.encoder->direction = to.direction;
  readings.encoder->zero_rad = to.zero_rad;
}

/// The encoder's own errors that fixes rounded to whole counts would show at several positions of
/// the counts, beyond those of white rounding errors.
class CoherentRounding {
 public:
  explicit CoherentRounding(double step_rad) : step_rad_(step_rad) {
    sums_.fill(Mat<count>::Zero());
  }

  /// A fix at the angle psi, `half` after one sample and before the next. Stamped edges are not
  /// rounded.
  void add(double psi, double half, double variance_rad2) {
    const double widest_rad = std::min(2.0 * std::abs(half), step_rad_);
    if (variance_rad2 < 0.25 * square(widest_rad) / 12.0) return;
    Mat<count> x = Mat<count>::Ones();
    for (int n = 1; n <= wheel::encoder_orders; ++n) {
      x(2 * n - 1) = std::cos(n * psi);
      x(2 * n) = std::sin(n * psi);
    }
    const double weight = 1.0 / variance_rad2;
    normal_ += weight * x * x.transpose();
    for (std::size_t i = 0; i < positions; ++i) {
      double shift = static_cast<double>(i) / positions;
      for (int at = 1; at < count; ++at)
        shift += own_error * signs[i][static_cast<std::size_t>(at - 1)] * x(at);
      const double before = std::floor((psi - half) / step_rad_ - shift);
      const double after = std::floor((psi + half) / step_rad_ - shift);
      // As signal::fixes_of_samples(): the boundary, or the mean of the counts' middles.
      const double fix =
          std::abs(after - before) == 1.0 ? std::max(before, after) : 0.5 * (before + after) + 0.5;
      sums_[i] += weight * ((fix + shift) * step_rad_ - psi) * x;
    }
  }

  [[nodiscard]] std::array<double, wheel::encoder_states - 1> std_rad() const {
    std::array<double, count - 1> out{};
    if (!(normal_(0, 0) > 0.0)) return out;
    const Mat<count, count> white = positive_inverse(normal_);
    for (int at = 1; at < count; ++at) {
      double squares = 0.0;
      for (const Mat<count>& sum : sums_) squares += square(white.row(at).dot(sum));
      out[static_cast<std::size_t>(at - 1)] =
          std::sqrt(std::max(squares / positions - white(at, at), 0.0));
    }
    return out;
  }

 private:
  static constexpr int count = wheel::encoder_states;
  static constexpr std::size_t positions = 8;
  // The estimated angle follows a part of the rounding: its errors may differ by a twentieth of a
  // count, with these signs.
  static constexpr double own_error = 0.05;
  static constexpr std::array<std::array<int, count - 1>, positions> signs{{{1, 1, 1, 1},
                                                                            {1, -1, 1, -1},
                                                                            {1, 1, -1, -1},
                                                                            {1, -1, -1, 1},
                                                                            {-1, -1, -1, -1},
                                                                            {-1, 1, -1, 1},
                                                                            {-1, -1, 1, 1},
                                                                            {-1, 1, 1, -1}}};
  double step_rad_;
  Mat<count, count> normal_ = Mat<count, count>::Zero();
  std::array<Mat<count>, positions> sums_;
};

}  // namespace

EncoderReadings encoder_readings(const WheelEncoder& encoder, const std::vector<double>& time_s) {
  PM_EXPECTS(!time_s.empty());
  EncoderReadings out;
  // One count in a hundred seconds; a milliradian without visible counts.
  out.walk_psd = square(encoder.step_rad > 0.0 ? encoder.step_rad : 1e-3) / 100.0;
  if (encoder.errors_rad) out.errors_rad = *encoder.errors_rad;
  out.nonlinearity = encoder.nonlinearity;
  out.step_rad = encoder.step_rad;
  const signal::AngleFixes& fixes = encoder.fixes;
  const double step_s = (time_s.back() - time_s.front()) /
                        static_cast<double>(std::max<std::size_t>(time_s.size(), 2) - 1);
  std::size_t next = 0;
  for (const double t : time_s) {
    MeanFix mean;
    for (; next < fixes.time_s.size() && fixes.time_s[next] <= t; ++next)
      if (fixes.time_s[next] > t - 2.0 * step_s)
        mean.add(fixes.time_s[next], fixes.angle_rad[next], square(fixes.std_rad[next]));
    mean.append_to(out, t);
  }
  return out;
}

EncoderReadings averaged(const EncoderReadings& encoder,
                         const std::vector<double>& time_s,
                         std::size_t each) {
  EncoderReadings out = encoder;
  for (std::vector<double>* column : {&out.angle_rad, &out.age_s, &out.variance_rad2})
    column->clear();
  for (std::size_t first = 0; first < time_s.size(); first += each) {
    const std::size_t last = std::min(first + each, time_s.size());
    MeanFix mean;
    double middle_s = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      middle_s += time_s[k] / static_cast<double>(last - first);
      if (encoder.has(k))
        mean.add(time_s[k] - encoder.age_s[k], encoder.angle_rad[k], encoder.variance_rad2[k]);
    }
    mean.append_to(out, middle_s);
  }
  return out;
}

std::array<double, wheel::encoder_states - 1> coherent_rounding_rad(
    const EncoderReadings& encoder,
    const std::vector<double>& time_s,
    const std::vector<double>& own_rad) {
  if (!(encoder.step_rad > 0.0)) return {};
  CoherentRounding rounding(encoder.step_rad);
  double last_rad = no_angle, last_s = 0.0;
  for (std::size_t k = 0; k < own_rad.size(); ++k) {
    const double psi = own_rad[k];
    if (!encoder.has(k) || std::isnan(psi)) continue;
    const double at_s = time_s[k] - encoder.age_s[k];
    // Half of the angle between the samples on either side: a fix is at the middle of an interval,
    // as is the one before.
    const double half = 0.5 * (psi - last_rad);
    const bool is_next = k > 0 && at_s - last_s < 1.5 * (time_s[k] - time_s[k - 1]);
    last_rad = psi;
    last_s = at_s;
    if (is_next && !std::isnan(half)) rounding.add(psi, half, encoder.variance_rad2[k]);
  }
  return rounding.std_rad();
}

Result<EncoderTrack> encoder_track(const WheelEncoder& encoder, WheelReadings& readings) {
  PM_EXPECTS(readings.sensors.size() == 1 && readings.epochs.size() >= 2);
  EncoderTrack out{{}, encoder, {}};
  std::vector<EncoderMotion> motion = motion_of(encoder.fixes, readings.time_s, 0.0);
  if (range_of(motion) < rad_per_turn) {
    readings.encoder.reset();
    out.track = find_track(readings);
    const auto found = alignment_with(out.track.path, motion);
    if (!found) return not_of_this_wheel(encoder);
    align(encoder, *found, readings);
    return out;
  }
  readings.one_speed = has_one_speed(motion);
  const GravityFit fit = compare_with_gravity(readings, out);
  Alignment found = alignment_of(fit);
  if (!(std::abs(found.gravity_mps2 / readings.gravity_mps2 - 1.0) < 0.3))
    return not_of_this_wheel(encoder);
  motion = motion_of(fit.corrected(out.encoder.fixes), readings.time_s, 0.0);
  // The first angle within half a turn.
  found.zero_rad +=
      rad_per_turn *
      std::round((found.direction * motion.front()(0) - found.zero_rad) / rad_per_turn);
  align(out.encoder, found, readings);
  PlanarReadings& sensor = readings.sensors[0];
  sensor.variance_m2ps4.assign(sensor.u_mps2.size(), fit.variance_m2ps4());
  if (!readings.one_speed) {
    readings.delay_s = fit.figure(GravityFit::delay);
    readings.delay_s.std = std::hypot(readings.delay_s.std, beat_s(encoder.step_rad, motion));
    // Averaged over a quarter of a turn, a short push is too small by up to a tenth.
    const Uncertain radius_m = fit.figure(GravityFit::radius);
    readings.found_rolling_radius_m = {radius_m.value,
                                       std::hypot(radius_m.std, 0.1 * radius_m.value)};
  }
  WheelTrack& track = out.track;
  track.noise = {20.0, 0.0, 1e-7};
  track.lost = fit.lost();
  for (const EncoderMotion& at : motion)
    track.path.moving.emplace_back(found.direction * at(0) - found.zero_rad,
                                   found.direction * at(1), found.direction * at(2), 0.0);
  track.path.standing = Eigen::VectorXd::Zero(wheel::standing(1));
  track.beginning = {track.path.moving.front()(wheel::angle), 0.2,
                     track.path.moving.front()(wheel::speed), 1.0};
  return out;
}

}  // namespace proofmass::estimate

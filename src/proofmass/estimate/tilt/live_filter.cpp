#include "proofmass/estimate/tilt/live_filter.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/so3.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/epochs.hpp"
#include "proofmass/estimate/tilt/motion.hpp"

namespace proofmass::estimate {
namespace {

/// Averaging times of the force's scatter, the base's acceleration: the largest counts, so that a
/// slow acceleration is not forgotten while it passes through zero, and with gyroscope one that
/// begins after a rest is not taken for tilt.
constexpr double memory_s = 6.0, long_memory_s = 30.0, short_memory_s = 1.0;
/// Initial acceleration of the base, in m/s², and its decay time.
constexpr double unknown_accel_mps2 = 1.0, unknown_fade_s = 2.0;
/// Averaging time of the reference force, with gyroscope for the 6 s and for the others, and
/// without.
constexpr double short_mean_memory_s = 2.0, long_mean_memory_s = 10.0, free_mean_memory_s = 20.0;
/// Lower limits of the acceleration, relative to gravity, and of its correlation time.
constexpr double least_accel = 2e-3, least_time_s = 0.05, longest_time_s = 2.0;
/// Longest correlation time with gyroscope, from the low-frequency density.
constexpr double longest_density_s = 0.4 * long_mean_memory_s;
/// Blocks of the density; the first of them, each twice as long as the one before.
constexpr double first_block_s = 0.25;
/// Degrees of freedom of the scatter, as in base_accel().
constexpr double effective_dof = 10.0;
/// Initial angular acceleration of a base without gyroscope, rad/s²/√Hz: that of a hand.
constexpr double free_drive = 1.0;
/// Interval over which the parallel filters are compared.
constexpr double predicted_s = 5.0;
constexpr double apart_s = 0.1;

Mat<3, 3> least_cov(double gravity_mps2) {
  return square(least_accel * gravity_mps2) * Mat<3, 3>::Identity();
}

double step_of(const std::vector<LiveEpoch>& epochs) {
  return (epochs.back().time_s - epochs.front().time_s) / static_cast<double>(epochs.size() - 1);
}

/// White noise of one measurement, from the differences of neighbours.
double difference_std(const std::vector<LiveEpoch>& epochs, std::size_t vector) {
  std::vector<double> differences;
  for (std::size_t k = 1; k < epochs.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const double step = epochs[k].vectors[vector](i) - epochs[k - 1].vectors[vector](i);
      if (std::isfinite(step)) differences.push_back(step);
    }
  return robust_std(differences).value_or(0.0) / std::numbers::sqrt2;
}

/// Norm of these measurements, if it can be that of gravity.
double norm_of(const std::vector<LiveEpoch>& epochs, double gravity_mps2) {
  std::vector<double> norms;
  for (const LiveEpoch& epoch : epochs)
    if (epoch.has(0)) norms.push_back(epoch.vectors[0].norm());
  const double usual = median(norms).value_or(gravity_mps2);
  return std::abs(usual - gravity_mps2) < 0.03 * gravity_mps2 ? usual : gravity_mps2;
}

std::vector<BaseScatter> scatters(bool gyroscope) {
  if (!gyroscope)
    return {{memory_s, free_mean_memory_s, false}, {long_memory_s, free_mean_memory_s, false}};
  return {{memory_s, short_mean_memory_s, true},
          {long_memory_s, long_mean_memory_s, true},
          {short_memory_s, long_mean_memory_s, true}};
}

std::size_t epochs_in(double time_s, double step_s) {
  return static_cast<std::size_t>(std::max(1L, std::lround(time_s / step_s)));
}

}  // namespace

void RunningCorrelation::add(const Mat<3>& departure, double weight) {
  Mat<3>& before = ring_[added_ % ring_.size()];
  if (added_ >= ring_.size()) {
    product_ += weight * (departure.dot(before) - product_);
    square_ += weight * (0.5 * (departure.squaredNorm() + before.squaredNorm()) - square_);
  }
  before = departure;
  ++added_;
}

double RunningCorrelation::time() const {
  const double r = square_ > 0.0 ? product_ / square_ : 0.0;
  return -1.0 / std::log(std::clamp(r, std::exp(-2.0), 0.999));
}

RunningDensity::RunningDensity(double step_s, double memory_s)
    : step_s_(step_s), memory_s_(memory_s) {
  double length_s = first_block_s;
  for (Block& block : blocks_) {
    block.length = epochs_in(length_s, step_s);
    length_s *= 2.0;
  }
}

void RunningDensity::turn(const Mat<3, 3>& R) {
  for (Block& block : blocks_) block.sum = R * block.sum;
}

void RunningDensity::add(const Mat<3>& departure) {
  const double fade = std::exp(-step_s_ / memory_s_);
  square_ = fade * square_ + departure.squaredNorm();
  weight_ = fade * weight_ + 1.0;
  for (Block& block : blocks_) {
    block.sum += departure;
    if (++block.count < block.length) continue;
    const auto length = static_cast<double>(block.length);
    const double fade_block = std::exp(-length * step_s_ / memory_s_);
    block.square = fade_block * block.square + block.sum.squaredNorm() / length;
    block.weight = fade_block * block.weight + 1.0;
    block.sum.setZero();
    block.count = 0;
  }
}

double RunningDensity::time_s() const {
  double most = 0.0;
  for (const Block& block : blocks_)
    if (block.weight > 0.0 && square_ > 0.0)
      most = std::max(most, block.square / block.weight / (square_ / weight_));
  return 0.5 * step_s_ * most;
}

RunningNoise::RunningNoise(double step_s, double std_mps2)
    : short_weight_(1.0 - std::exp(-step_s / short_memory_s)),
      long_weight_(1.0 - std::exp(-step_s / memory_s)),
      short_(square(std_mps2)),
      long_(short_) {
  before_.fill(Mat<3>::Constant(no_value));
}

void RunningNoise::add(const Mat<3>& force) {
  const Mat<3> bend = force - 2.0 * before_[0] + before_[1];
  before_ = {force, before_[0]};
  if (!bend.allFinite()) return;
  const double variance = bend.squaredNorm() / 18.0;  // three axes, six times each
  short_ += short_weight_ * (variance - short_);
  long_ += long_weight_ * (variance - long_);
}

LiveTiltFilter::LiveTiltFilter(const std::vector<LiveEpoch>& first, const LiveTiltOptions& options)
    : gyroscope_(options.gyroscope.has_value()),
      usual_step_s_(step_of(first)),
      scatters_(scatters(gyroscope_)),
      correlation_(epochs_in(apart_s, usual_step_s_)),
      density_(usual_step_s_, long_memory_s),
      noise_(usual_step_s_, difference_std(first, 0)),
      apart_s_(static_cast<double>(epochs_in(apart_s, usual_step_s_)) * usual_step_s_),
      window_(epochs_in(options.lag_s, usual_step_s_)),
      times_s_(window_.lag() + 1) {
  known_.gravity_mps2 = norm_of(first, options.tilt.gravity_mps2.value);
  known_.rate_bias_std_radps = options.tilt.rate_bias_std_radps;
  known_.rate_bias_walk_radps_rts = options.tilt.rate_bias_walk_radps_rts;
  known_.rate_scale_std = options.tilt.rate_scale_std;
  motion_.gyroscope = gyroscope_;
  motion_.reading_std_mps2 = std::max(1e-4 * known_.gravity_mps2, noise_.std_mps2());
  motion_.accel_time_s = least_time_s;
  motion_.drive = gyroscope_
                      ? std::clamp(difference_std(first, 1) * std::sqrt(usual_step_s_), 1e-5, 1e-2)
                      : free_drive;
  known_.rest_std_mps2.setConstant(motion_.reading_std_mps2);
  now_.step_s.assign(2, 0.0);
  now_.force_mps2.assign(2, Mat<3>::Zero());
  now_.resting.assign(2, 0);
  now_.accel_cov_m2ps4.assign(2, least_cov(known_.gravity_mps2));
  if (gyroscope_) now_.rate_radps.assign(2, Mat<3>::Zero());
  now_.rate_at_radps = now_.rate_radps;
}

void LiveTiltFilter::read(const LiveEpoch& epoch) {
  const double step_s = epochs_ == 0 ? 0.0 : epoch.time_s - time_s_;
  time_s_ = epoch.time_s;
  now_.step_s[1] = step_s;
  now_.force_mps2[1] = epoch.vectors[0];
  if (!gyroscope_) return;
  const Mat<3>& rate = epoch.vectors[1];
  const Mat<3> before = epochs_ == 0 ? rate : now_.rate_at_radps[1];
  now_.rate_at_radps[1] = rate;
  now_.rate_radps[1] = rate_over(before, rate, step_s, longest_bridge_s(usual_step_s_));
}

/// Estimates the base's acceleration from the force up to now.
void LiveTiltFilter::follow_motion() {
  const Mat<3> bias = gyroscope_ ? Mat<3>(state_.x.mean.tail<3>()) : Mat<3>::Zero();
  const Mat<3> rate = gyroscope_ ? Mat<3>(now_.rate_radps[1] - bias) : bias;
  for (BaseScatter& scatter : scatters_) scatter.turn(now_.step_s[1], rate);
  if (gyroscope_ && rate.allFinite()) density_.turn(rotation_by(Mat<3>(-now_.step_s[1] * rate)));
  unknown_ *= std::exp(-now_.step_s[1] / unknown_fade_s);
  const Mat<3>& f = now_.force_mps2[1];
  noise_.add(f);
  motion_.reading_std_mps2 = std::max(1e-4 * known_.gravity_mps2, noise_.std_mps2());
  if (!f.allFinite()) return;
  Mat<3, 3> accel_cov = Mat<3, 3>::Zero();
  for (std::size_t i = 0; i < scatters_.size(); ++i) {
    const Mat<3> departure = scatters_[i].add(f, known_.gravity_mps2).mps2;
    if (i == 0) correlation_.add(departure, usual_step_s_ / memory_s);
    if (i == 1 && gyroscope_) density_.add(departure);
    const Mat<3, 3> cov = scatters_[i].covariance(known_.gravity_mps2, known_.norm_std_mps2);
    if (cov.trace() > accel_cov.trace()) accel_cov = cov;
  }
  double time_s = std::clamp(correlation_.time() * apart_s_, least_time_s, longest_time_s);
  if (gyroscope_) time_s = std::max(time_s, std::min(density_.time_s(), longest_density_s));
  // As in base_accel(): the statistical uncertainty, and the part removed by the running mean.
  const double taken = 1.0 + time_s / (gyroscope_ ? short_mean_memory_s : free_mean_memory_s);
  const double wider = student_t_quantile(0.975, effective_dof) / 1.959964;
  motion_.accel_time_s = time_s * taken;
  now_.accel_cov_m2ps4[1] = wider * wider * taken * accel_cov +
                            square(unknown_accel_mps2) * unknown_ * Mat<3, 3>::Identity() +
                            least_cov(known_.gravity_mps2);
}

/// Angular acceleration, rad/s²/√Hz, of a base without gyroscope where nothing is measured: its
/// rate of rotation may change as it does otherwise. White angular acceleration of density 2 σ²/τ,
/// as of rates of variance σ² with a correlation time τ.
double LiveTiltFilter::unseen_drive() const {
  constexpr double correlation_s = 1.0;
  return std::sqrt(square(motion_.drive) + 2.0 * rate2_ / correlation_s);
}

/// The mean square of the rate of rotation over some 20 s, less what is uncertain of it.
void LiveTiltFilter::learn_rate() {
  constexpr double memory_s = 20.0;
  const double square_now =
      state_.x.mean.tail<3>().squaredNorm() - state_.x.cov.diagonal().tail<3>().sum();
  const double share = 1.0 - std::exp(-now_.step_s[1] / memory_s);
  rate2_ += (std::max(square_now, 0.0) / square(known_.gravity_mps2) - rate2_) * share;
}

bool LiveTiltFilter::is_unseen(const LiveEpoch& epoch) const {
  constexpr double longest_seen_s = 0.1;
  return !gyroscope_ && epochs_ > 0 &&
         (!epoch.has(0) || epoch.time_s - measured_s_ > longest_seen_s);
}

/// Whether the base may have turned so far by this epoch that a linear update would miss the
/// direction of gravity.
bool LiveTiltFilter::has_lost_gravity(const LiveEpoch& epoch) const {
  constexpr double most_rad = 0.3;
  const double step_s = epoch.time_s - time_s_;
  const Mat<9> variance = state_.x.cov.diagonal() / (2.0 * square(known_.gravity_mps2));
  const double turned_rad2 = variance.head<3>().sum() + variance.tail<3>().sum() * square(step_s) +
                             square(unseen_drive()) * step_s * step_s * step_s / 3.0;
  return turned_rad2 > square(most_rad);
}

/// Begins anew with the next epoch.
void LiveTiltFilter::restart() {
  epochs_ = 0;
  unknown_ = 1.0;
  window_ = FixedLag<9, 3>(window_.lag());
}

void LiveTiltFilter::step(const LiveEpoch& epoch) {
  const bool unseen = is_unseen(epoch);
  if (epoch.has(0)) {
    if (unseen && has_lost_gravity(epoch)) restart();
    measured_s_ = epoch.time_s;
  }
  read(epoch);
  follow_motion();
  if (epochs_ == 0) {
    now_.force_mps2[0] = now_.force_mps2[1];
    now_.accel_cov_m2ps4[0] = now_.accel_cov_m2ps4[1];
  }
  TiltMotion motion = motion_;
  if (unseen) motion.drive = unseen_drive();
  const TiltModel model(now_, known_, motion);
  if (epochs_ == 0) state_ = model.start();
  advance(model, epochs_ == 0 ? 0 : 1, tilt_gate, state_, step_);
  const double fade = std::exp(-now_.step_s[1] / predicted_s);
  predicted_ = fade * predicted_ + tilt_log_likelihood(step_, model.accel_readings(1));
  if (epoch.has(0) && !gyroscope_) learn_rate();
  window_.push(step_);
  times_s_[epochs_ % times_s_.size()] = time_s_;
  ++epochs_;
  nis_ = step_.count == 0 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  for (int i = 0; i < step_.count; ++i)
    nis_ += step_.updates[static_cast<std::size_t>(i)].nis() / step_.count;
}

LiveTiltBank::LiveTiltBank(const std::vector<LiveEpoch>& first, const LiveTiltOptions& options) {
  const auto add = [&](double factor) {
    filters_.push_back(std::make_unique<LiveTiltFilter>(first, options));
    filters_.back()->turn_more(factor);
  };
  add(1.0);
  if (options.gyroscope) return;
  add(apart);
  add(1.0 / apart);
}

void LiveTiltBank::step(const LiveEpoch& epoch) {
  for (const auto& filter : filters_) filter->step(epoch);
  if (filters_.size() == 1 || epoch.time_s < next_s_) return;
  constexpr double every_s = 0.25;
  next_s_ = epoch.time_s + every_s;
  choose();
}

void LiveTiltBank::choose() {
  constexpr double clear = 1.0, least = 0.02, most = 5.0;
  const auto gain = [this](std::size_t k) {
    return filters_[k]->predicted() - filters_[0]->predicted();
  };
  const double drive = filters_[0]->drive();
  const bool up = gain(1) > clear && drive < most;
  if (!up && !(gain(2) > clear && drive > least)) return;
  // The better filter becomes the middle one, with the two others beside it.
  const std::size_t better = up ? 1 : 2, other = up ? 2 : 1;
  const double factor = up ? apart : 1.0 / apart;
  std::swap(filters_[0], filters_[better]);
  filters_[better]->turn_more(factor * factor);
  filters_[other]->turn_more(factor);
}

}  // namespace proofmass::estimate

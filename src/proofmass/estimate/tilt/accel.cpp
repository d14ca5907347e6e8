#include "proofmass/estimate/tilt/accel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/so3.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

// Averaging time of the force's scatter, in correlation times: long enough that few weights depend
// on the measurements to which they apply.
constexpr double memory_times = 60.0, least_memory_s = 2.0, most_memory_s = 20.0;
// Degrees of freedom of the scatter: the three axes share the error of the running mean and of τ.
constexpr double effective_dof = 10.0;
// Lower limit of the acceleration in motion, relative to gravity.
constexpr double least_accel = 2e-3;
// Longest correlation time, and the same relative to the memory of the mean, which removes what is
// slower.
constexpr double usual_longest_s = 2.0, longest_of_memory = 0.4;

// Departures across the mean force, against those that the norm explains by acceleration: from this
// ratio of their variances on, they may be rotation.
constexpr double plainly_more = 1.25;

// Lag at which the pooled autocorrelation has fallen to 1/e.
double correlation_time(const std::vector<Mat<3>>& departures, double step_s, double longest_s) {
  const std::size_t size = departures.size();
  double zero = 0.0;
  for (const Mat<3>& v : departures) zero += v.squaredNorm();
  if (size < 3 || !(zero > 0.0)) return step_s;
  zero /= static_cast<double>(size);
  double last = 1.0;
  const auto most = static_cast<std::size_t>(std::min(longest_s / step_s, 2000.0));
  for (std::size_t lag = 1; lag <= most && lag < size / 2; ++lag) {
    double sum = 0.0;
    for (std::size_t k = lag; k < size; ++k) sum += departures[k].dot(departures[k - lag]);
    const double r = sum / (static_cast<double>(size - lag) * zero);
    constexpr double target = 0.36787944117144233;
    if (r <= target)
      return step_s * (static_cast<double>(lag) - (target - r) / std::max(last - r, 1e-12));
    last = r;
  }
  return longest_s;
}

// The largest density at low frequencies of the departures' means over 1, 2, 4 … of them, divided
// by twice the variance: the correlation time of a first-order process whose density is as large.
// It is the one that counts where vibration dominates the variance, and the autocorrelation falls
// to 1/e within a sample.
// `bias_m2ps4`: variance that the gyroscope's bias contributes, which hardly changes in a mean.
double time_of_density(std::vector<Mat<3>> sums,
                       double step_s,
                       double longest_s,
                       double bias_m2ps4) {
  constexpr std::size_t fewest = 8;
  const auto size = static_cast<double>(sums.size());
  double variance = 0.0, time_s = 0.0;
  for (const Mat<3>& v : sums) variance += v.squaredNorm() / size;
  for (std::size_t length = 1; sums.size() >= fewest && variance > 0.0; length *= 2) {
    const double span = static_cast<double>(length);
    if (span * step_s > longest_s) break;
    double squares = 0.0;
    for (const Mat<3>& sum : sums) squares += sum.squaredNorm() / static_cast<double>(sums.size());
    const double density = squares / span - span * bias_m2ps4;
    time_s = std::max(time_s, 0.5 * step_s * density / variance);
    for (std::size_t k = 0; 2 * k + 1 < sums.size(); ++k) sums[k] = sums[2 * k] + sums[2 * k + 1];
    sums.resize(sums.size() / 2);
  }
  return time_s;
}

// (tr S⁸)^(1/8): the largest eigenvalue if it dominates, 3^(1/8) times that if all are equal.
double largest_eigenvalue(const Mat<3, 3>& S) {
  const double size = S.trace();
  if (!(size > 0.0)) return 0.0;
  const Mat<3, 3> once = S / size, twice = once * once, four = twice * twice;
  return size * std::pow(four.squaredNorm(), 0.125);
}

// The running mean m, to which departures are relative.
struct RunningMean {
  double memory_s;
  bool gyroscope = false;
  Mat<3> rate_bias_radps = Mat<3>::Zero();
  double bias_m2ps4 = 0.0;  ///< variance of departures by the uncertainty of that bias, all axes
};

RunningMean running_mean(const TiltEpochs& epochs,
                         const std::optional<RateBias>& rate_bias,
                         double gravity_mps2) {
  constexpr double free_s = 20.0, unknown_bias_s = 2.0, known_bias_s = 10.0;
  if (epochs.rate_radps.empty()) return {.memory_s = free_s};
  if (!rate_bias) return {.memory_s = unknown_bias_s, .gyroscope = true};
  // Gravity, rotated for as long as m remembers, along the two axes across it.
  const double departs_mps2 = gravity_mps2 * rate_bias->tilting_std_radps * known_bias_s;
  return {.memory_s = known_bias_s,
          .gyroscope = true,
          .rate_bias_radps = rate_bias->mean_radps,
          .bias_m2ps4 = 2.0 * square(departs_mps2)};
}

// What the epochs in motion show.
class MotionEvidence {
 public:
  /// The force of epoch k with its departure; `back` rotates it to a static frame, common to all.
  void add(std::size_t k,
           const Mat<3>& force,
           const BaseScatter::Departure& departure,
           const Mat<3, 3>& back) {
    if (departure.since_s) steps_s_.push_back(*departure.since_s);
    const auto axis = static_cast<Eigen::Index>(k % 3);
    if (last_) differences_.push_back(force(axis) - (*last_)(axis));
    departures_.emplace_back(back * departure.mps2);
  }
  /// The force of every epoch, at rest too.
  void set_last(const Mat<3>& force) { last_ = force; }
  void add(const BaseScatter::Across& across) {
    found_ += across.found;
    explained_ += across.explained;
    epochs_ += 1.0;
  }

  [[nodiscard]] double perhaps_rotation_mps2() const {
    return found_ > plainly_more * explained_ ? std::sqrt((found_ - explained_) / (2.0 * epochs_))
                                              : 0.0;
  }
  [[nodiscard]] double time_s(const RunningMean& mean) const {
    const double step_s = median(steps_s_).value_or(0.01);
    const double longest_s = std::max(usual_longest_s, longest_of_memory * mean.memory_s);
    const double correlated_s =
        std::max(correlation_time(departures_, step_s, longest_s), 0.5 * step_s);
    if (!mean.gyroscope) return correlated_s;
    return std::max(correlated_s, time_of_density(departures_, step_s, longest_s, mean.bias_m2ps4));
  }
  [[nodiscard]] double reading_std_mps2() const {
    return std::numbers::sqrt2 / 2.0 * robust_std(differences_).value_or(0.0);
  }

 private:
  std::vector<Mat<3>> departures_;
  std::vector<double> steps_s_, differences_;
  std::optional<Mat<3>> last_;
  double found_ = 0.0, explained_ = 0.0, epochs_ = 0.0;
};

// The rotation of an epoch's step without the gyroscope's bias; zero without gyroscope.
Mat<3> rate_of(const TiltEpochs& epochs, const RunningMean& mean, std::size_t k) {
  return mean.gyroscope ? Mat<3>(epochs.rate_radps[k] - mean.rate_bias_radps) : Mat<3>::Zero();
}

// The scatter of the first seconds, which applies from the start on.
BaseScatter first_scatter(const TiltEpochs& epochs,
                          const RunningMean& mean,
                          double gravity_mps2,
                          double memory_s) {
  BaseScatter scatter(memory_s, mean.memory_s, mean.gyroscope);
  double early_s = 0.0;
  for (std::size_t k = 0; k < epochs.step_s.size() && early_s < memory_s; ++k) {
    early_s += epochs.step_s[k];
    scatter.turn(epochs.step_s[k], rate_of(epochs, mean, k));
    const Mat<3>& f = epochs.force_mps2[k];
    if (f.allFinite()) scatter.add(f, gravity_mps2);
  }
  scatter.restart();
  return scatter;
}

BaseAccel base_accel_over(const TiltEpochs& epochs,
                          const RunningMean& mean,
                          const TiltKnown& known,
                          double memory_s) {
  const double G = known.gravity_mps2;
  const Mat<3, 3> least = square(least_accel * G) * Mat<3, 3>::Identity();
  BaseScatter scatter = first_scatter(epochs, mean, G, memory_s);
  MotionEvidence motion;
  Mat<3, 3> back = Mat<3, 3>::Identity();
  BaseAccel out;
  for (std::size_t k = 0; k < epochs.step_s.size(); ++k) {
    const Mat<3> rate = rate_of(epochs, mean, k);
    if (rate.allFinite()) back = back * rotation_by(Mat<3>(-epochs.step_s[k] * rate)).transpose();
    scatter.turn(epochs.step_s[k], rate);
    const bool rests = epochs.resting[k] != 0;
    const Mat<3>& f = epochs.force_mps2[k];
    if (f.allFinite()) {
      const auto departure = scatter.add(f, G);
      if (!rests) motion.add(k, f, departure, back);
      motion.set_last(f);
    }
    if (!mean.gyroscope && !rests) motion.add(scatter.across(G, known.norm_std_mps2));
    out.cov_m2ps4.push_back(scatter.covariance(G, known.norm_std_mps2) + least);
  }
  out.perhaps_rotation_mps2 = motion.perhaps_rotation_mps2();
  out.time_s = motion.time_s(mean);
  out.reading_std_mps2 = std::max(1e-4 * G, motion.reading_std_mps2());
  return out;
}

}  // namespace

void BaseScatter::turn(double step_s, const Mat<3>& rate_radps) {
  since_s_ += step_s;
  if (!gyroscope_) return;
  if (rate_radps.allFinite()) {
    const Mat<3, 3> R = rotation_by(Mat<3>(-step_s * rate_radps));
    mean_ = R * mean_;
    scatter_.sum = R * scatter_.sum * R.transpose();
  } else {
    begun_ = false;  // no mean is carried over the gap
  }
}

BaseScatter::Departure BaseScatter::add(const Mat<3>& force, double gravity_mps2) {
  if (!begun_) mean_ = force;
  mean_ += (1.0 - std::exp(-since_s_ / mean_memory_s_)) * (force - mean_);
  Departure departure{force - mean_, std::nullopt};
  const double fade = std::exp(-since_s_ / memory_s_);
  if (begun_) {
    scatter_.add(departure.mps2 * departure.mps2.transpose(), fade);
    departure.since_s = since_s_;
  }
  const double off = force.norm() - gravity_mps2;
  norm_.add(square(off), fade);
  excess_.add(off, fade);
  begun_ = true;
  since_s_ = 0.0;
  return departure;
}

Mat<3, 3> BaseScatter::covariance(double gravity_mps2, double norm_std_mps2) const {
  const Mat<3, 3> one = Mat<3, 3>::Identity(), departed = scatter_.mean();
  const double along = norm_.mean();
  if (gyroscope_) return std::max(along, largest_eigenvalue(departed)) * one;
  if (!(mean_.norm() > 0.0)) return along * one;
  const Mat<3> up = mean_.normalized();
  const Mat<3, 3> level = one - up * up.transpose();
  const Mat<3, 3> across = level * departed * level;
  const double most = 2.0 * gravity_mps2 * (std::abs(excess_.mean()) + norm_std_mps2);
  return along * one + std::min(1.0, most / std::max(across.trace(), 1e-12)) * across;
}

BaseScatter::Across BaseScatter::across(double gravity_mps2, double norm_std_mps2) const {
  const double along = norm_.mean();
  if (!(mean_.norm() > 0.0)) return {};
  const Mat<3> up = mean_.normalized();
  const Mat<3, 3> departed = scatter_.mean();
  const double found = departed.trace() - up.dot(departed * up);
  const double shown = 2.0 * gravity_mps2 * (std::abs(excess_.mean()) - norm_std_mps2);
  return {found, std::max(2.0 * along, shown)};
}

BaseAccel base_accel(const TiltEpochs& epochs,
                     const std::optional<RateBias>& rate_bias,
                     const TiltKnown& known) {
  const RunningMean mean = running_mean(epochs, rate_bias, known.gravity_mps2);
  const BaseAccel first = base_accel_over(epochs, mean, known, least_memory_s);
  const double memory_s = std::clamp(memory_times * first.time_s, least_memory_s, most_memory_s);
  BaseAccel out = base_accel_over(epochs, mean, known, memory_s);
  // The running mean has removed part of the slow component: M/(M + τ) is left.
  const double taken = 1.0 + out.time_s / mean.memory_s;
  out.time_s *= taken;
  // A scatter over so few correlation times follows Student's t; with gyroscope the largest
  // eigenvalue in all directions is wide enough.
  const double wider = mean.gyroscope ? 1.0 : student_t_quantile(0.975, effective_dof) / 1.959964;
  for (Mat<3, 3>& cov : out.cov_m2ps4) cov *= wider * wider * taken;
  return out;
}

}  // namespace proofmass::estimate

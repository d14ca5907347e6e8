#include "proofmass/estimate/tilt_accel.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/rotation.hpp"

namespace proofmass::estimate {
namespace {

// Over how long a time the force tells what the base does at present: so many correlation times,
// that few enough weights hang on the very readings that they are for.
constexpr double memory_times = 60.0, least_memory_s = 2.0, most_memory_s = 20.0;
// Degrees of freedom of the scatter: the three axes share the error of the running mean and of τ.
constexpr double effective_dof = 10.0;
// What no base is quieter than while it moves, relative to gravity.
constexpr double least_accel = 2e-3;
constexpr double longest_s = 1.0;

// Departures of the force, turned back into one frame that stands still: what autocorrelates.
struct Departures {
  std::vector<Mat<3>> vectors;
  std::vector<double> time_s;
};

// Lag at which the pooled autocorrelation has fallen to 1/e.
double correlation_time(const Departures& found, double step_s) {
  const std::size_t size = found.vectors.size();
  double zero = 0.0;
  for (const Mat<3>& v : found.vectors) zero += v.squaredNorm();
  if (size < 3 || !(zero > 0.0)) return step_s;
  zero /= static_cast<double>(size);
  double last = 1.0;
  const auto most = static_cast<std::size_t>(std::min(longest_s / step_s, 2000.0));
  for (std::size_t lag = 1; lag <= most && lag < size / 2; ++lag) {
    double sum = 0.0;
    for (std::size_t k = lag; k < size; ++k) sum += found.vectors[k].dot(found.vectors[k - lag]);
    const double r = sum / (static_cast<double>(size - lag) * zero);
    constexpr double target = 0.36787944117144233;
    if (r <= target)
      return step_s * (static_cast<double>(lag) - (target - r) / std::max(last - r, 1e-12));
    last = r;
  }
  return longest_s;
}

BaseAccel base_accel_over(const TiltInstants& instants,
                          const Mat<3>& rate_bias,
                          double gravity_mps2,
                          double memory_s) {
  BaseAccel out;
  const bool gyroscope = !instants.rate_radps.empty();
  BaseScatter scatter(memory_s, gyroscope);
  Departures departures;
  Mat<3, 3> back = Mat<3, 3>::Identity();
  std::vector<double> steps, differences;
  const Mat<3>* last = nullptr;
  for (std::size_t k = 0; k < instants.step_s.size(); ++k) {
    const double h = instants.step_s[k];
    if (gyroscope) {
      const Mat<3> rate = instants.rate_radps[k] - rate_bias;
      if (rate.allFinite()) back = back * rotation_by(Mat<3>(-h * rate)).transpose();
      scatter.turn(h, rate);
    } else {
      scatter.turn(h, Mat<3>::Zero());
    }
    const Mat<3>& f = instants.force_mps2[k];
    if (f.allFinite()) {
      const auto departure = scatter.add(f, gravity_mps2);
      if (instants.resting[k] == 0) {
        if (departure.since_s) steps.push_back(*departure.since_s);
        if (last) differences.push_back((f - *last)(static_cast<Eigen::Index>(k % 3)));
        departures.vectors.push_back(gyroscope ? Mat<3>(back * departure.mps2)
                                               : Mat<3>(f.norm() - gravity_mps2, 0.0, 0.0));
      }
      last = &f;
    }
    out.std_mps2.push_back(std::sqrt(scatter.variance()));
  }
  for (double& std : out.std_mps2) std = std::max(std, least_accel * gravity_mps2);
  const double step_s = median(steps).value_or(0.01);
  out.time_s = std::max(correlation_time(departures, step_s), 0.5 * step_s);
  out.reading_std_mps2 = std::max(1e-4 * gravity_mps2, 0.3 * robust_std(differences).value_or(0.0));
  return out;
}

}  // namespace

void BaseScatter::Fading::add(double value, double fade) {
  sum_ = fade * sum_ + value;
  weight_ = fade * weight_ + 1.0;
}

void BaseScatter::turn(double step_s, const Mat<3>& rate_radps) {
  since_s_ += step_s;
  if (!gyroscope_) return;
  if (rate_radps.allFinite())
    mean_ = rotation_by(Mat<3>(-step_s * rate_radps)) * mean_;
  else
    begun_ = false;  // nothing carries the mean over
}

BaseScatter::Departure BaseScatter::add(const Mat<3>& force, double gravity_mps2) {
  if (!begun_) mean_ = force;
  mean_ += (1.0 - std::exp(-since_s_ / mean_memory_s)) * (force - mean_);
  Departure departure{force - mean_, std::nullopt};
  const double fade = std::exp(-since_s_ / memory_s_);
  if (begun_) {
    scatter_.add(departure.mps2.squaredNorm() / 3.0, fade);
    departure.since_s = since_s_;
  }
  norm_.add(square(force.norm() - gravity_mps2), fade);
  begun_ = true;
  since_s_ = 0.0;
  return departure;
}

double BaseScatter::variance() const {
  return gyroscope_ ? std::max(scatter_.mean(), norm_.mean()) : norm_.mean();
}

BaseAccel base_accel(const TiltInstants& instants, const Mat<3>& rate_bias, double gravity_mps2) {
  const BaseAccel first = base_accel_over(instants, rate_bias, gravity_mps2, least_memory_s);
  const double memory_s = std::clamp(memory_times * first.time_s, least_memory_s, most_memory_s);
  BaseAccel out = base_accel_over(instants, rate_bias, gravity_mps2, memory_s);
  if (instants.rate_radps.empty()) return out;
  // The running mean has taken its share of the slow part: M/(M + τ) is left.
  const double taken = 1.0 + out.time_s / BaseScatter::mean_memory_s;
  // A scatter over so few correlation times is Student's, not Gauss's.
  const double wider = student_t_quantile(0.975, effective_dof) / 1.959964;
  out.time_s *= taken;
  for (double& std : out.std_mps2) std *= wider * std::sqrt(taken);
  return out;
}

}  // namespace proofmass::estimate

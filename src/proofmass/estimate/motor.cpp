#include "proofmass/estimate/motor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/estimate/motor/conclude.hpp"
#include "proofmass/estimate/motor/contact_bank.hpp"
#include "proofmass/estimate/motor/prepare.hpp"
#include "proofmass/estimate/motor/scoring.hpp"
#include "proofmass/estimate/motor/start.hpp"

namespace proofmass::estimate {
namespace {

using motor::Fit;
using motor::Regimes;
using motor::Series;

constexpr int rounds = 3;
constexpr double sure = 0.98;  // probability of a flank on which a sample is used

std::size_t count_reversals(const Regimes& regimes) {
  std::size_t count = 0;
  double last = 0.0;
  for (const double w : regimes.speed_radps) {
    if (std::abs(w) < regimes.rest_radps) continue;
    if (w * last < 0.0) ++count;
    last = w;
  }
  return count;
}

bool shows_backlash(const Regimes& regimes, const Fit& fit) {
  const auto i = static_cast<Eigen::Index>(motor::half_backlash);
  return motor::saw_both_flanks(regimes) &&
         fit.parameters.value[motor::half_backlash] > 3.0 * std::sqrt(fit.covariance(i, i));
}

// Alternates parameters, speed and contact.
Fit settle(const Series& series, Regimes& regimes, const Progress& progress) {
  const motor::Parameters start = motor::start(series, regimes);
  regimes.dry_torque = std::abs(start.value[motor::coulomb]);
  Fit fit = motor::maximise(series, regimes, start, 25);
  for (int round = 0; round < rounds; ++round) {
    if (progress) progress("identification", static_cast<double>(round) / rounds);
    motor::Smoothed smoothed = motor::smooth(series, regimes, fit.parameters);
    motor::set_motion(series, std::move(smoothed.angle_rad), std::move(smoothed.speed_radps),
                      1, regimes);
    regimes.dry_torque = std::abs(fit.parameters.value[motor::coulomb]) +
                         std::abs(fit.parameters.value[motor::stribeck]);
    if (shows_backlash(regimes, fit))
      regimes.contact = motor::certain_contacts(
          motor::contact_probabilities(series, regimes, fit.parameters), regimes.speed_radps,
          sure);
    const int iterations = fit.iterations;
    fit = motor::maximise(series, regimes, fit.parameters, 10);
    fit.iterations += iterations;
  }
  return fit;
}

void judge(const Series& series, const Regimes& regimes, const Fit& fit, MotorSolution& out) {
  motor::Innovations innovations;
  motor::filter(series, regimes, fit.parameters, innovations);
  for (std::size_t channel = 0; channel < 2; ++channel) {
    double squares = 0.0, products = 0.0, last = 0.0;
    std::size_t count = 0;
    for (std::size_t i = channel; i < innovations.value.size(); i += 3) {
      if (!(innovations.variance[i] > 0.0)) continue;
      const double z = innovations.value[i] / std::sqrt(innovations.variance[i]);
      squares += z * z;
      products += z * last;
      last = z;
      ++count;
    }
    if (count == 0) continue;
    out.nis[channel] = squares / static_cast<double>(count);
    out.correlation[channel] = products / squares;
  }
}

MotorSeries series_of(const Series& series, const Regimes& regimes, const Fit& fit) {
  const motor::Smoothed smoothed = motor::smooth(series, regimes, fit.parameters);
  MotorSeries out{.time_s = {},
                  .voltage_v = series.voltage_v,
                  .current_a = series.current_a,
                  .load_angle_rad = series.angle_rad,
                  .motor_angle_rad = smoothed.angle_rad,
                  .speed_radps = smoothed.speed_radps,
                  .speed_std_radps = smoothed.speed_std_radps,
                  .friction = {},
                  .contact = regimes.contact};
  for (std::size_t k = 0; k < series.size(); ++k) {
    const double w = smoothed.speed_radps[k];
    out.time_s.push_back(static_cast<double>(k) * series.step_s);
    out.friction.push_back(motor::dry_friction_nm(fit.parameters, w) +
                           (series.has_current() ? fit.parameters.value[motor::viscous] * w : 0.0));
  }
  return out;
}

}  // namespace

const MotorParameter* MotorSolution::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &MotorParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

Result<MotorSolution> estimate_motor(const MotorRecord& record, const MotorOptions& options) {
  const Result<Series> prepared = motor::prepare(record, options);
  if (!prepared) return prepared.error();
  const Series& series = *prepared;
  Regimes regimes = motor::first_regimes(series);
  const auto at_rest = static_cast<double>(std::ranges::count(regimes.rests, std::uint8_t{1}));
  MotorSolution out;
  out.has_current = series.has_current();
  out.rate_hz = 1.0 / series.step_s;
  out.moving_share = 1.0 - at_rest / static_cast<double>(series.size());
  double travel = 0.0;
  for (const double w : regimes.speed_radps)
    if (std::abs(w) > regimes.rest_radps) travel += std::abs(w) * series.step_s;
  if (travel < 0.1 || out.moving_share < 0.05)
    return Error{Errc::not_observable, "the load hardly moves: nothing shows the drive"};
  const Fit fit = settle(series, regimes, options.progress);
  out.parameters = motor::conclude(series, regimes, fit);
  out.friction = motor::friction_curve(series, regimes, fit);
  out.angle_noise_rad = fit.parameters.si(motor::angle_noise);
  out.torque_noise = fit.parameters.si(motor::torque_noise);
  out.reversals = count_reversals(regimes);
  out.iterations = fit.iterations;
  out.converged = fit.converged;
  judge(series, regimes, fit, out);
  out.series = series_of(series, regimes, fit);
  return out;
}

}  // namespace proofmass::estimate

#include "proofmass/estimate/motor/conclude.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::estimate::motor {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double normal_95 = 1.959964;
// A parameter is determined if the record reduces its prior uncertainty to this share.
constexpr double determined_share = 0.3;

const char* const no_current =
    "no current was recorded: only ratios to the torque constant and the resistance show";
const char* const no_reversal =
    "the gear bore on one flank throughout: the recording needs a reversal of the load";
const char* const one_speed =
    "the recorded speeds do not separate it from the other friction terms: record several speeds";
const char* const no_slow_motion =
    "no slow motion near a rest shows the rise of friction: record slow reversals";

double variance(const Fit& fit, std::size_t i) {
  return fit.covariance(static_cast<Index>(i), static_cast<Index>(i));
}

bool is_determined(const Fit& fit, std::size_t i) {
  return fit.parameters.active[i] && std::isfinite(variance(fit, i)) &&
         std::sqrt(variance(fit, i)) < determined_share * fit.parameters.prior_std[i];
}

MotorParameter absent(std::string name, std::string unit, std::string meaning, const char* why) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .meaning = std::move(meaning),
          .reason = why};
}

MotorParameter plain(std::string name,
                     std::string unit,
                     std::string meaning,
                     const Uncertain& found) {
  MotorParameter out{.name = std::move(name), .unit = std::move(unit),
                     .meaning = std::move(meaning), .value = found};
  out.interval_95 = {found.value - normal_95 * found.std, found.value + normal_95 * found.std};
  return out;
}

// Of a positive value whose logarithm has the standard deviation `relative`.
MotorParameter positive(std::string name,
                        std::string unit,
                        std::string meaning,
                        double value,
                        double relative) {
  MotorParameter out{.name = std::move(name), .unit = std::move(unit),
                     .meaning = std::move(meaning), .value = Uncertain{value, value * relative}};
  out.interval_95 = {value * std::exp(-normal_95 * relative),
                     value * std::exp(normal_95 * relative)};
  return out;
}

MotorParameter one_of(const Fit& fit,
                      std::size_t i,
                      std::array<std::string, 3> words,
                      const char* why) {
  auto& [name, unit, meaning] = words;
  if (!is_determined(fit, i)) return absent(name, unit, meaning, why);
  const double std = std::sqrt(variance(fit, i));
  return is_log(i) ? positive(name, unit, meaning, fit.parameters.si(i), std)
                   : plain(name, unit, meaning, {fit.parameters.value[i], std});
}

// Tc + Fs.
MotorParameter breakaway(const Fit& fit, const std::string& name, const std::string& unit) {
  const std::string meaning = "friction at the onset of motion, by the curve's limit at speed zero";
  if (!is_determined(fit, stribeck) || !is_determined(fit, stribeck_speed))
    return absent(name, unit, meaning, no_slow_motion);
  const double var = variance(fit, coulomb) + variance(fit, stribeck) +
                     2.0 * fit.covariance(coulomb, stribeck);
  return plain(name, unit, meaning,
               {fit.parameters.value[coulomb] + fit.parameters.value[stribeck], std::sqrt(var)});
}

MotorParameter backlash(const Regimes& regimes, const Fit& fit) {
  const std::array<std::string, 3> words{"backlash", "rad", "free play of the load's shaft"};
  if (!saw_both_flanks(regimes) || !is_determined(fit, half_backlash))
    return absent(words[0], words[1], words[2], no_reversal);
  MotorParameter out = plain(words[0], words[1], words[2],
                             {2.0 * fit.parameters.value[half_backlash],
                              2.0 * std::sqrt(variance(fit, half_backlash))});
  for (double& end : *out.interval_95) end = std::max(end, 0.0);
  return out;
}

MotorParameter unbalance(const Fit& fit, const std::string& unit) {
  const std::array<std::string, 3> words{"unbalance", unit, "largest torque of an unbalanced load"};
  if (!is_determined(fit, unbalance_cos) || !is_determined(fit, unbalance_sin))
    return absent(words[0], words[1], words[2], "the load did not turn far enough");
  const double c = fit.parameters.value[unbalance_cos], s = fit.parameters.value[unbalance_sin];
  const double size = std::hypot(c, s);
  const double var = (c * c * variance(fit, unbalance_cos) + s * s * variance(fit, unbalance_sin) +
                      2.0 * c * s * fit.covariance(unbalance_cos, unbalance_sin)) /
                     (size * size);
  if (!(size > 3.0 * std::sqrt(var)))
    return absent(words[0], words[1], words[2], "not distinguishable from zero");
  return plain(words[0], words[1], words[2], {size, std::sqrt(var)});
}

std::vector<MotorParameter> with_current(const Regimes& regimes, const Fit& fit) {
  const char* const no_motion = "the speed changes too little";
  return {one_of(fit, resistance, {"resistance", "ohm", "of the armature, with its leads"},
                 "the current changes too little"),
          one_of(fit, torque_constant,
                 {"torque_constant", "N*m/A", "at the load's shaft; equal to the back-EMF constant"},
                 no_motion),
          one_of(fit, inertia,
                 {"inertia", "kg*m^2", "of motor, gear and load, at the load's shaft"}, no_motion),
          one_of(fit, viscous, {"viscous_friction", "N*m*s/rad", "friction per speed"}, one_speed),
          one_of(fit, coulomb, {"coulomb_friction", "N*m", "dry friction well above speed zero"},
                 one_speed),
          breakaway(fit, "breakaway_friction", "N*m"),
          one_of(fit, stribeck_speed,
                 {"stribeck_speed", "rad/s", "speed over which friction falls from breakaway"},
                 no_slow_motion),
          unbalance(fit, "N*m"), backlash(regimes, fit)};
}

std::vector<MotorParameter> without_current(const Regimes& regimes, const Fit& fit) {
  const Parameters& p = fit.parameters;
  std::vector<MotorParameter> out;
  const double B = p.value[viscous], relative_B = std::sqrt(variance(fit, viscous)) / B;
  if (is_determined(fit, viscous) && B > 0.0) {
    out.push_back(positive("gain", "rad/s/V", "speed per volt above friction", 1.0 / B, relative_B));
    const double var = variance(fit, inertia) + relative_B * relative_B -
                       2.0 * fit.covariance(inertia, viscous) / B;
    out.push_back(positive("time_constant", "s", "of the speed after a step of the voltage",
                           p.si(inertia) / B, std::sqrt(std::max(var, 0.0))));
  } else {
    out.push_back(absent("gain", "rad/s/V", "speed per volt above friction", one_speed));
    out.push_back(absent("time_constant", "s", "of the speed after a step of the voltage",
                         "the speed changes too little"));
  }
  out.push_back(one_of(fit, coulomb, {"friction_voltage", "V", "voltage that dry friction costs"},
                       one_speed));
  out.push_back(breakaway(fit, "breakaway_voltage", "V"));
  out.push_back(backlash(regimes, fit));
  for (const auto& [name, unit] :
       {std::pair{"resistance", "ohm"}, std::pair{"torque_constant", "N*m/A"},
        std::pair{"inertia", "kg*m^2"}, std::pair{"viscous_friction", "N*m*s/rad"},
        std::pair{"coulomb_friction", "N*m"}, std::pair{"breakaway_friction", "N*m"}})
    out.push_back(absent(name, unit, "", no_current));
  return out;
}

}  // namespace

bool saw_both_flanks(const Regimes& regimes) {
  return std::ranges::count(regimes.contact, std::int8_t{1}) > 0 &&
         std::ranges::count(regimes.contact, std::int8_t{-1}) > 0;
}

std::vector<MotorParameter> conclude(const Series& series, const Regimes& regimes, const Fit& fit) {
  return series.has_current() ? with_current(regimes, fit) : without_current(regimes, fit);
}

std::vector<FrictionPoint> friction_curve(const Series& series,
                                          const Regimes& regimes,
                                          const Fit& fit) {
  constexpr int points = 60;
  const Parameters& p = fit.parameters;
  double top = 0.0;
  for (const double w : regimes.speed_radps) top = std::max(top, std::abs(w));
  std::vector<FrictionPoint> out;
  for (int k = 0; k <= points; ++k) {
    const double w = regimes.rest_radps + (top - regimes.rest_radps) * k / points;
    const double ratio = w / p.si(stribeck_speed), fall = std::exp(-ratio * ratio);
    VectorXd slope = VectorXd::Zero(parameter_count);
    slope(coulomb) = 1.0;
    slope(stribeck) = fall;
    slope(stribeck_speed) = p.value[stribeck] * fall * 2.0 * ratio * ratio;
    double torque = dry_friction_nm(p, w);
    if (series.has_current()) {
      torque += p.value[viscous] * w;
      slope(viscous) = w;
    }
    out.push_back({.speed_radps = w, .torque = torque,
                   .std = std::sqrt(slope.dot(fit.covariance * slope))});
  }
  return out;
}

}  // namespace proofmass::estimate::motor
